"""Evaluate designs on missions: mass, wheel on slope, cruise speed, hour-by-hour traverse, survival.

The chain couples the physics modules as the paper does: total mass sets the wheel loads, the wheel sets slip and
torque, torque and sunlight set the speed, and the march through the mission sets charge and range. Slope and soil
are constant, so the wheel is solved once, outside the march.

Limits: constant slope, homogeneous soil, equal wheel loads; without `Scenario.start_utc` sunrise at the start and a
sun on the equator, without `skyline` a level horizon. The thermal cases know neither: they are the paper's noon and
night at the latitude. The range is what the energy allows under the duty cycle, not an operational estimate.
"""
from dataclasses import dataclass
from functools import partial

import numpy as np

from . import stability, terramechanics, thermal
from ._fields import Later, Record, described, limits_of, require, together
from ._march import TraverseLog, cruise_speed, shaped, traverse
from .design import Design, Model, Scenario, warn_outside
from .mass import MassBreakdown, MassCoefficients, mass_breakdown

__all__ = ["MASS_COEFFICIENTS", "Performance", "TraverseLog", "cruise_speed", "evaluate", "mass_of"]

MASS_COEFFICIENTS = tuple(limits_of(MassCoefficients))

@dataclass(frozen=True)
class Performance(Record):
    """What a design does on a mission; floats and bools for one design, arrays for a population."""
    example = "rdk.evaluate(design, scenario)"
    apart = ("log",)                                     # its arrays run over time

    range_km: float = described("Distance driven, at most the scenario's limit; 0 for stalled or buried designs.")
    total_mass_kg: float = described("With payload.")
    slope_capability_deg: float = described("Steepest slope climbed at the capability slip, cut at the search limit.")
    energy_balance_pct: float = described("(generated - consumed) / consumed, by the trapezoidal rule over the hourly "
                                          "samples; nothing is recorded at t = 0, so the last one counts half.")
    stalled: bool = described("No slip develops the required pull, or the torque exceeds the peak hub torque.")
    thermal_survival: bool = described("Hot and cold case inside the operating limits; no part of `feasible`.")
    feasible: bool = described("Neither stalled nor buried, energy balance not negative, range above 0, obstacle met.")
    buried: bool = described("No entry angle carries the load: slip, sinkage and torque are NaN.")
    slip: float = described("At the slip balance on the scenario slope, as are sinkage and torque.")
    sinkage_m: float
    wheel_torque_nm: float
    cruise_speed_m_s: float = described("The lower of the energy-balance and the hub's no-load speed; 0 if stalled.")
    energy_balance_speed_m_s: float = described("Before the hub caps it; 0 if stalled or without surplus power.")
    hub_speed_limited: bool = described("The hub, not the energy, sets the cruise speed.")
    average_solar_power_w: float = described("Mission mean.")
    final_soc: float = described("State of charge at the end.")
    minimum_soc: float
    hot_temperature_c: float = described("Enclosure at noon.")
    cold_temperature_c: float = described("Enclosure in the lunar night.")
    obstacle_capability_m: float = described("0.5 r rigid, 1.25 r rocker-bogie (by default).")
    ground_pressure_kpa: float = described(
        "Mean vertical pressure under a wheel at the slip balance: its load over the wheel's width times the length of "
        "its contact, sqrt(z (2 r - z)) at sinkage z. Not in the paper.")
    sliding: bool = described("On a descent the wheels cannot brake: too much pull at the lowest slip. Then `stalled`.")
    unserved_h: float = described("Time in which an empty pack and too little sun do not fully supply avionics or "
                                  "payload; in whole time steps, without `Model.exact_floor`.")
    arrival_h: float = Later("When the traverse limit is reached; infinity if never.")
    hot_survival: bool = described("Noon below the upper limit: half of `thermal_survival`.")
    cold_survival: bool = described("Night above the lower limit: its other half.")
    structure_share: float = described("Chassis mass over total mass.")
    wheel_gap_m: float = described("Wheelbase less the length of one side's wheels, 2 (r + h_g) on four, 4 (r + h_g) "
                                   "on six: negative where they overlap, which no model forbids.")
    tip_over_deg: float = Later("Least slope in any direction at which the standing rover tips; see `rdk.stability`.")
    mass: MassBreakdown = Later("Its items.")
    log: TraverseLog | None = described("Hour by hour, for one design only.", default=None, compare=False)


def evaluate(design: Design, scenario: Scenario, *, model: Model = Model()) -> Performance:
    """Performance of a design, or of a population, on a mission.

    Any field but the mission's duration and the model's time step may be an array; all broadcast, and so does the
    result. Inside a population nothing raises: a lane without a solution is infeasible. One UserWarning names the
    variables where a design lies outside DESIGN_SPACE.

    Examples
    --------
    >>> import rdk
    >>> result = evaluate(rdk.rover("Rashid-1"), rdk.scenario("equatorial_mare_traverse"))
    >>> f"{result.total_mass_kg:.1f} kg, {result.slope_capability_deg:.0f} deg"
    '16.4 kg, 23 deg'
    """
    require(design=(design, Design), scenario=(scenario, Scenario), model=(model, Model))
    shape = together(design=design.shape, scenario=scenario.shape, model=model.shape)
    warn_outside(design)
    with np.errstate(all="ignore"):                      # a lane without a solution is infeasible, not a warning
        mass = mass_of(design, scenario, model)
        # load and pull are shared equally; a mass beyond all floats is buried, no error
        weight = np.fmin(mass.total_kg * model.gravity_m_s2 / design.wheel_count, 1e300)
        balance, capability = terramechanics.climbed(
            design.wheel, scenario.soil, model, weight_n=weight, slope_deg=scenario.slope_deg, slip_min=model.slip_min,
            slip_max=model.slip_max, capability_slip=model.slope_capability_slip,
            capability_limit_deg=model.slope_capability_limit_deg)
        torque = balance.torque_nm
        if np.any(model.axle_torque):
            loaded = _axle_torque(design, scenario, model, mass, balance.slip)
            torque = np.where(model.axle_torque, loaded, torque)
        stalled = balance.stalled | (torque > design.peak_wheel_torque_nm)
        march = partial(traverse, design, scenario, model, balance.slip, balance.torque_nm, stalled, shape)
        travelled, log = march()
        area = thermal.enclosure_area(design.chassis_mass_kg, model.enclosure_area_base_m2,
                                      model.enclosure_area_coefficient_m2)
        sunlight = thermal.absorbed_sunlight(
            scenario.latitude_deg, area, absorptivity=model.enclosure_absorptivity,
            sunlit_fraction=model.enclosure_sunlit_fraction, solar_constant_w_m2=model.solar_constant_w_m2)
        hot = thermal.node_temperature(
            sunlight + design.avionics_power_w + scenario.payload_power_w + model.radioisotope_heater_power_w, area,
            model.sink_temperature_hot_k, emissivity=model.enclosure_emissivity)
        cold = thermal.node_temperature(model.hibernation_power_w + model.radioisotope_heater_power_w, area,
                                        model.sink_temperature_cold_k, emissivity=model.enclosure_emissivity)
        hot_survival = hot <= model.operating_temperature_max_c
        cold_survival = cold >= model.operating_temperature_min_c
        r, z, six = design.wheel_radius_m, balance.sinkage_m, np.equal(design.wheel_count, 6)
        obstacle = r * np.where(six, model.rocker_bogie_obstacle_ratio, model.rigid_obstacle_ratio)
        contact_m2 = design.wheel_width_m * np.sqrt(z * (2 * r - z))
        pressure = weight * np.cos(np.radians(scenario.slope_deg)) / contact_m2 / 1000
        along = np.where(six, 4, 2) * (r + design.grouser_height_m)
        feasible = (~np.asarray(stalled) & (travelled["energy_balance_pct"] >= 0) & (travelled["range_km"] > 0)
                    & (obstacle >= scenario.required_obstacle_height_m))
    found = dict(
        travelled, total_mass_kg=mass.total_kg, slope_capability_deg=capability, stalled=stalled,
        thermal_survival=hot_survival & cold_survival, feasible=feasible, buried=balance.buried, slip=balance.slip,
        sinkage_m=balance.sinkage_m, wheel_torque_nm=balance.torque_nm, hot_temperature_c=hot, cold_temperature_c=cold,
        obstacle_capability_m=obstacle, ground_pressure_kpa=pressure, sliding=balance.sliding,
        hot_survival=hot_survival, cold_survival=cold_survival, structure_share=mass.chassis_kg / mass.total_kg,
        wheel_gap_m=design.wheelbase_m - along)
    return Performance.trusted(shape, dict(
        {name: shaped(value, shape) for name, value in found.items()},
        log=log, mass=partial(_items, mass, shape), arrival_h=partial(_arrival_h, march, shape),
        tip_over_deg=partial(_tip_over, design, mass, model, shape)))


def mass_of(design, scenario, model):
    """Mass breakdown of a design with the scenario's payload; raises nothing."""
    return mass_breakdown(**design.numbers(), payload_mass_kg=scenario.payload_mass_kg, coefficients=model)


def _stance(design, mass, model):
    """Track and centre of mass, as `rdk.stability` guesses them from the sizes."""
    return stability.stance(mass.total_kg, mass.wheels_kg, design.wheel_radius_m, design.wheel_width_m,
                            design.wheelbase_m, design.wheel_count, track_ratio=model.track_ratio,
                            envelope_density_kg_m3=model.envelope_density_kg_m3)


def _axle_torque(design, scenario, model, mass, slip):
    """Torque of the most loaded wheel at the slip that all wheels share; infinite where it is buried or airborne."""
    loads = stability.axle_loads(
        mass.total_kg, design.wheelbase_m, _stance(design, mass, model).centre_height_m, scenario.slope_deg,
        wheel_count=design.wheel_count, pivot_height_m=design.wheel_radius_m, gravity_m_s2=model.gravity_m_s2)
    load = np.fmax(np.fmax(loads.front_n, loads.middle_n), loads.rear_n) / 2
    sound = np.isfinite(load) & (load > 0) & np.isfinite(slip)
    forces = terramechanics.wheel_forces(design.wheel, scenario.soil, np.where(sound, load, 1.0),
                                         np.where(sound, slip, 0.0),
                                         **{name: getattr(model, name) for name in terramechanics.OPTIONS})
    return np.where(sound & np.isfinite(forces.torque_nm), forces.torque_nm, np.inf)


def _items(mass, shape):
    return MassBreakdown.trusted(shape, {name: shaped(value, shape) for name, value in mass.numbers().items()})


def _tip_over(design, mass, model, shape):
    stand = _stance(design, mass, model)
    tips = stability.tip_over(design.wheelbase_m, stand.track_m, stand.centre_height_m)
    return shaped(np.minimum(np.minimum(tips.uphill_deg, tips.downhill_deg), tips.sideways_deg), shape)


def _arrival_h(march, shape):
    """The march again, for the read-out that not every evaluation pays for."""
    with np.errstate(all="ignore"):
        return shaped(march(with_arrival=True)[0]["arrival_h"], shape)
