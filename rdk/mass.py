"""Bottom-up mass of a rover: line items from the design variables, then fractions, growth and payload.

The rollup follows SMAD (2011) and AIAA S-120A: harness and thermal control are fractions of the subsystem mass,
the growth allowance is applied to the dry bus, the payload is added last. Checked against five published totals of
5 to 50 kg only: a matching total does not confirm the line items. No item covers steering actuators, deployment
mechanisms, telecom or radioisotope heaters, so rovers above the class come out light.
"""
from dataclasses import dataclass

import numpy as np

from ._fields import Real, Record, number


@dataclass(frozen=True)
class MassCoefficients(Record):
    """The coefficients of the line items, and part of `Model`; the defaults are those of the paper's release."""
    wheel_areal_density_kg_m2: float = number(0, default=8.0)
    grouser_thickness_m: float = number(0, default=0.002)
    grouser_density_kg_m3: float = number(0, default=2700.0)
    motor_base_mass_kg: float = number(0, default=0.15)
    motor_mass_per_torque_kg_nm: float = number(0, default=0.1)
    solar_areal_density_kg_m2: float = number(0, default=2.5)
    battery_specific_energy_wh_kg: float = number(above=0, default=120.0)
    avionics_base_mass_kg: float = number(0, default=0.3)
    avionics_mass_per_power_kg_w: float = number(0, default=0.05)
    linkage_base_mass_kg: float = number(0, default=0.5)
    linkage_chassis_fraction: float = number(0, default=0.08)
    harness_fraction: float = number(0, default=0.08)
    thermal_control_fraction: float = number(0, default=0.05)
    growth_fraction: float = number(0, default=0.2)
    wheel_web_factor: float = number(0, default=0.0)
    track_ratio: float = number(above=0, default=0.9)
    frame_mass_kg_m2: float = number(0, default=0.0)


@dataclass(frozen=True)
class MassBreakdown(Record):
    """Line items in kg, each a number or an array; they add up to `total_kg`. A rigid layout has no linkage."""
    chassis_kg: float
    wheels_kg: float
    motors_kg: float
    solar_array_kg: float
    battery_kg: float
    avionics_kg: float
    linkage_kg: float
    harness_kg: float
    thermal_control_kg: float
    growth_kg: float
    payload_kg: float
    total_kg: float

    @property
    def items(self):
        """Name and mass of every line item, the total left out."""
        return {name: value for name, value in self.numbers().items() if name != "total_kg"}


def mass_breakdown(
        *, wheel_radius_m: Real, wheel_width_m: Real, grouser_height_m: Real, grouser_count: Real, wheel_count: Real,
        chassis_mass_kg: Real, solar_area_m2: Real, battery_capacity_wh: Real, avionics_power_w: Real,
        peak_wheel_torque_nm: Real, wheelbase_m: Real = 0.0, payload_mass_kg: Real = 0.0,
        coefficients: MassCoefficients = MassCoefficients()) -> MassBreakdown:
    """Mass line items and total of a rover, for arguments of any shapes that broadcast.

    Sizes as in `Design`, the hub torque and the grousers those of one wheel. Nothing is checked here.
    """
    c = coefficients
    per_wheel = (c.wheel_areal_density_kg_m2 * 2 * np.pi * wheel_radius_m * wheel_width_m        # rim, hub, spokes
                 + grouser_count * wheel_width_m * grouser_height_m * c.grouser_thickness_m * c.grouser_density_kg_m3
                 + c.wheel_web_factor * c.wheel_areal_density_kg_m2 * np.pi * wheel_radius_m ** 2)   # not the paper's
    wheels = wheel_count * per_wheel                                                             # eq. mass-wheels
    # eq. mass-motors
    motors = wheel_count * (c.motor_base_mass_kg + c.motor_mass_per_torque_kg_nm * peak_wheel_torque_nm)
    array = c.solar_areal_density_kg_m2 * solar_area_m2
    battery = battery_capacity_wh / c.battery_specific_energy_wh_kg
    avionics = c.avionics_base_mass_kg + c.avionics_mass_per_power_kg_w * avionics_power_w   # eq. mass-power-avionics
    rocker_bogie = np.equal(wheel_count, 6)
    linkage = (c.linkage_base_mass_kg + c.linkage_chassis_fraction * chassis_mass_kg) * rocker_bogie
    chassis = chassis_mass_kg + c.frame_mass_kg_m2 * c.track_ratio * np.square(wheelbase_m)     # not the paper's
    subsystems = chassis + wheels + motors + array + battery + avionics + linkage        # eq. mass-subsystems
    harness = c.harness_fraction * subsystems
    thermal = c.thermal_control_fraction * (subsystems + harness)
    dry = subsystems + harness + thermal                                                         # eq. mass-dry
    growth = c.growth_fraction * dry
    return MassBreakdown(chassis, wheels, motors, array, battery, avionics, linkage, harness, thermal, growth,
                         payload_mass_kg, dry + growth + payload_mass_kg)                        # eq. mass-total
