"""Enclosure temperature: one node in steady state that gains heat inside and from the sun and loses it by radiation.

Gilmore (2002). No conduction, no internal gradient, no time constant; the lunar surface and the sky act through one
effective sink temperature. Good for a survival flag, not for a thermal design.
"""
import numpy as np

from ._fields import Real

STEFAN_BOLTZMANN = 5.670374419e-8                        # W m-2 K-4, exact; scipy.constants is slow to load
ZERO_CELSIUS = 273.15


def enclosure_area(chassis_mass_kg: Real, base_m2: Real = 0.05, coefficient_m2: Real = 0.02) -> Real:
    """Radiating area of the warm enclosure in m2: base + coefficient * m_c^(2/3), with the chassis mass in kg."""
    return base_m2 + coefficient_m2 * np.cbrt(chassis_mass_kg) ** 2


def absorbed_sunlight(latitude_deg: Real, area_m2: Real, *, absorptivity: Real = 0.3, sunlit_fraction: Real = 0.25,
                      solar_constant_w_m2: Real = 1361.0) -> Real:
    """Sunlight that the enclosure absorbs at noon: alpha S_0 cos(latitude) times the sunlit part of its area, in W."""
    return (absorptivity * solar_constant_w_m2 * np.maximum(np.cos(np.radians(latitude_deg)), 0.0) * sunlit_fraction
            * area_m2)


def node_temperature(heat_w: Real, area_m2: Real, sink_temperature_k: Real, *, emissivity: Real = 0.85) -> Real:
    """Temperature in degrees Celsius at which the node radiates what it gains, eq. thermal-node.

    (T_sink^4 + Q / (eps sigma A))^(1/4), with Q the absorbed sunlight, dissipation and heaters, zero or more; the
    infrared of the surroundings is in their effective temperature.
    """
    fourth_power = np.asarray(sink_temperature_k, float) ** 4 + heat_w / (emissivity * STEFAN_BOLTZMANN * area_m2)
    return np.sqrt(np.sqrt(fourth_power)) - ZERO_CELSIUS
