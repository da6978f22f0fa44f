"""Evaluate designs on missions: mass, wheel on slope, cruise speed, hour-by-hour traverse, survival.

The chain couples the physics modules as the paper does: total mass sets the wheel loads, the wheel sets slip and
torque, torque and sunlight set the speed, and the march through the mission sets charge and range. Slope and soil
are constant, so the wheel is solved once, outside the march.

Limits: constant slope, homogeneous soil, sunrise at the start, a sun on the equator, equal wheel loads. The range
is what the energy allows under the duty cycle, not an operational estimate.
"""
from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from . import power, terramechanics, thermal
from ._fields import Record, together
from .design import Design, Model, Scenario, warn_outside
from .mass import MassBreakdown, mass_breakdown

MEAN_SAMPLES = 200                                       # samples of the mission-average solar power
MARCH_ELEMENTS = 2**17                                   # steps x lanes marched at once: 1 MB arrays stay in cache

MASS_COEFFICIENTS = (
    "wheel_areal_density_kg_m2", "grouser_thickness_m", "grouser_density_kg_m3", "motor_base_mass_kg",
    "motor_mass_per_torque_kg_nm", "solar_areal_density_kg_m2", "battery_specific_energy_wh_kg",
    "avionics_base_mass_kg", "avionics_mass_per_power_kg_w", "linkage_base_mass_kg", "linkage_chassis_fraction",
    "harness_fraction", "thermal_control_fraction", "growth_fraction")
_MARCHED = (                                             # what the march reads of design, scenario and model
    ("wheel_radius_m", "wheel_count", "solar_area_m2", "battery_capacity_wh", "avionics_power_w"),
    ("latitude_deg", "duty_cycle", "traverse_limit_km", "payload_power_w", "panel_tilt_deg", "panel_azimuth_deg"),
    ("solar_constant_w_m2", "panel_efficiency", "dust_factor", "synodic_day_h", "drivetrain_efficiency",
     "hub_no_load_speed_rad_s", "soc_initial", "soc_floor", "charge_efficiency", "discharge_efficiency"))


@dataclass(frozen=True)
class TraverseLog:
    """The march of one design through its mission: one row a time step, powers as averages over the step.

    `discarded_w` is sunlight that a full pack could not take, `unserved_w` demand that an empty one could not meet,
    `battery_loss_w` what charging and discharging cost: solar + unserved = load + discarded + battery loss + rate
    of change of the stored energy.
    """
    time_h: np.ndarray
    step_h: np.ndarray
    sun_elevation_deg: np.ndarray
    solar_w: np.ndarray
    load_w: np.ndarray
    mobility_w: np.ndarray
    stored_wh: np.ndarray
    soc: np.ndarray
    throttled: np.ndarray
    discarded_w: np.ndarray
    unserved_w: np.ndarray
    battery_loss_w: np.ndarray
    distance_km: np.ndarray

    def to_frame(self):
        """The log as a pandas DataFrame."""
        import pandas as pd
        return pd.DataFrame(vars(self))


@dataclass(frozen=True)
class Performance(Record):
    """What a design does on a mission; floats and bools for one design, arrays for a population.

    Attributes
    ----------
    range_km : float or ndarray
        Distance driven, at most the scenario's limit; 0 for stalled or buried designs.
    total_mass_kg : float or ndarray
        With payload.
    slope_capability_deg : float or ndarray
        Steepest slope climbed at the capability slip, cut at the search limit.
    energy_balance_pct : float or ndarray
        (generated - consumed) / consumed in percent, by the trapezoidal rule over the hourly samples; as in the
        original release nothing is recorded at t = 0, so the last sample counts half.
    stalled : bool or ndarray
        No slip develops the required pull, or the torque exceeds the peak hub torque.
    thermal_survival : bool or ndarray
        Hot and cold case inside the operating limits. A flag only: `feasible` leaves it out, as the paper does.
    feasible : bool or ndarray
        Neither stalled nor buried, energy balance not negative, range above 0, required obstacle climbed.
    buried : bool or ndarray
        No entry angle carries the load: slip, sinkage and torque are NaN.
    slip, sinkage_m, wheel_torque_nm : float or ndarray
        At the slip balance on the scenario slope.
    cruise_speed_m_s : float or ndarray
        While driving: the lower of the energy-balance speed and the hub's no-load speed; 0 if stalled.
    energy_balance_speed_m_s : float or ndarray
        The paper's energy-balance speed, before the hub caps it; 0 if stalled or without surplus power.
    hub_speed_limited : bool or ndarray
        The hub, not the energy, sets the cruise speed.
    average_solar_power_w : float or ndarray
        Mission mean.
    final_soc, minimum_soc : float or ndarray
        State of charge at the end, and its lowest value.
    hot_temperature_c, cold_temperature_c : float or ndarray
        Enclosure at noon and in the lunar night.
    obstacle_capability_m : float or ndarray
        0.5 r rigid, 1.25 r rocker-bogie (by default).
    ground_pressure_kpa : float or ndarray
        Mean vertical pressure under a wheel at the slip balance, in kPa: its load over the wheel's width times the
        length of its contact, sqrt(z (2 r - z)) at sinkage z. The paper has no such figure; a constraint on it is one
        remedy for the wheels that shrink to the search bound.
    mass : MassBreakdown
    log : TraverseLog or None
        Hour by hour, for one design only.
    """
    range_km: float
    total_mass_kg: float
    slope_capability_deg: float
    energy_balance_pct: float
    stalled: bool
    thermal_survival: bool
    feasible: bool
    buried: bool
    slip: float
    sinkage_m: float
    wheel_torque_nm: float
    cruise_speed_m_s: float
    energy_balance_speed_m_s: float
    hub_speed_limited: bool
    average_solar_power_w: float
    final_soc: float
    minimum_soc: float
    hot_temperature_c: float
    cold_temperature_c: float
    obstacle_capability_m: float
    ground_pressure_kpa: float
    mass: MassBreakdown
    log: TraverseLog | None = field(default=None, repr=False, compare=False)


def evaluate(design, scenario, model=Model()):
    """Performance of a design, or of a population, on a mission.

    Parameters
    ----------
    design : Design
        One design, or arrays of them.
    scenario : Scenario
        Any field but the duration may be an array; it broadcasts with the design.
    model : Model
        Coefficients; any field but the time step may be an array.

    Returns
    -------
    Performance
        With the broadcast shape of all inputs. Inside a population nothing raises: a lane without a solution is
        infeasible.

    Raises
    ------
    TypeError
        If an argument is not a Design, Scenario or Model.
    ValueError
        If array lengths disagree.

    Warns
    -----
    UserWarning
        Once, naming the variables, where a design lies outside DESIGN_SPACE.

    Examples
    --------
    >>> import rdk
    >>> result = evaluate(rdk.rover("Rashid-1"), rdk.scenario("equatorial_mare_traverse"))
    >>> f"{result.total_mass_kg:.1f} kg, {result.slope_capability_deg:.0f} deg"
    '16.4 kg, 23 deg'
    """
    for name, value, kind in ("design", design, Design), ("scenario", scenario, Scenario), ("model", model, Model):
        if not isinstance(value, kind):
            raise TypeError(f"{name} must be a {kind.__name__}; got {type(value).__name__}")
    shape = together(design=design.shape, scenario=scenario.shape, model=model.shape)
    warn_outside(design)
    with np.errstate(all="ignore"):                      # a lane without a solution is infeasible, not a warning
        mass = mass_of(design, scenario, model)
        weight = mass.total_kg * model.gravity_m_s2 / design.wheel_count         # load and pull shared equally
        balance, capability = terramechanics.climb(
            design.wheel, scenario.soil, weight, scenario.slope_deg, slip_min=model.slip_min, slip_max=model.slip_max,
            capability_slip=model.slope_capability_slip, capability_limit_deg=model.slope_capability_limit_deg,
            transition_c1=model.transition_c1, transition_c2=model.transition_c2,
            grouser_lift_cap=model.grouser_lift_cap, shear_scale=model.shear_scale)
        stalled = balance.stalled | (balance.torque_nm > design.peak_wheel_torque_nm)
        traverse, log = _traverse(design, scenario, model, balance, stalled, shape)
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
        survives = thermal.survives(hot, cold, model.operating_temperature_min_c, model.operating_temperature_max_c)
        obstacle = design.wheel_radius_m * np.where(np.equal(design.wheel_count, 6), model.rocker_bogie_obstacle_ratio,
                                                    model.rigid_obstacle_ratio)
        contact_m2 = design.wheel_width_m * np.sqrt(balance.sinkage_m * (2 * design.wheel_radius_m - balance.sinkage_m))
        pressure = weight * np.cos(np.radians(scenario.slope_deg)) / contact_m2 / 1000
        feasible = (~np.asarray(stalled) & (traverse["energy_balance_pct"] >= 0) & (traverse["range_km"] > 0)
                    & (obstacle >= scenario.required_obstacle_height_m))
    fields = dict(
        traverse, total_mass_kg=mass.total_kg, slope_capability_deg=capability, stalled=stalled,
        thermal_survival=survives, feasible=feasible, buried=balance.buried, slip=balance.slip,
        sinkage_m=balance.sinkage_m, wheel_torque_nm=balance.torque_nm, hot_temperature_c=hot, cold_temperature_c=cold,
        obstacle_capability_m=obstacle, ground_pressure_kpa=pressure)
    return Performance(**{name: _shaped(value, shape) for name, value in fields.items()}, log=log,
                       mass=MassBreakdown(**{name: _shaped(value, shape) for name, value in mass.numbers().items()}))


def _shaped(value, shape):
    """An array of the common shape, or a plain number."""
    if not shape:
        return np.asarray(value).item()
    return value if np.shape(value) == shape else np.broadcast_to(value, shape)


def mass_of(design, scenario, model):
    """Mass breakdown of a design with the scenario's payload; raises nothing."""
    sizes = design.numbers()
    del sizes["wheelbase_m"]
    return mass_breakdown(**sizes, payload_mass_kg=scenario.payload_mass_kg,
                          **{name: getattr(model, name) for name in MASS_COEFFICIENTS})


def cruise_speed(average_solar_power_w, base_load_w, wheel_count, wheel_torque_nm, slip, wheel_radius_m, duty_cycle,
                 drivetrain_efficiency=0.8, hub_no_load_speed_rad_s=5.0):
    """Cruise speed: what the average sunlight pays for, capped by the hub's no-load speed.

    The energy-balance speed alone, (P_solar - P_a - P_payload) r (1 - s) eta_m / (delta N_w T), reaches tens of m/s
    on easy ground. The cap omega_0 r (1 - s) is not in the paper's text but shapes its highland plateau.

    Parameters
    ----------
    average_solar_power_w, base_load_w : float or ndarray
        Mission-average solar power; avionics and payload power, in W.
    wheel_count : int or ndarray
    wheel_torque_nm : float or ndarray
        Driving torque of one wheel; where it is not positive, driving costs nothing and the hub sets the speed.
    slip, wheel_radius_m, duty_cycle, drivetrain_efficiency : float or ndarray
    hub_no_load_speed_rad_s : float or ndarray
        omega_0; infinity lifts the cap.

    Returns
    -------
    speed_m_s, energy_balance_speed_m_s, mobility_power_w : float or ndarray
        Cruise speed; the speed without the cap; electrical power of all hubs while driving at cruise speed.
    """
    rolling_radius = wheel_radius_m * (1 - slip)
    torque = np.maximum(wheel_torque_nm, 0.0) * wheel_count
    surplus = np.maximum(np.asarray(average_solar_power_w) - base_load_w, 0.0)
    with np.errstate(all="ignore"):
        free = np.where(surplus > 0, np.inf, 0.0)        # no torque or no driving: nothing limits but the hub
        paid_for = np.asarray(duty_cycle) * torque       # eq. energy-balance-speed
        energy_speed = np.where(paid_for > 0, surplus * rolling_radius * drivetrain_efficiency / paid_for, free)
        speed = np.minimum(energy_speed, hub_no_load_speed_rad_s * rolling_radius)
        power_w = np.where(np.isfinite(speed), torque * speed / rolling_radius / drivetrain_efficiency, 0.0)
    return speed, energy_speed, power_w


def _step_times(scenario, model):
    """Time at the end of each step and its length, in hours; the last step ends with the mission."""
    duration, step = scenario.duration_earth_days * 24.0, model.time_step_h
    count = max(int(np.ceil(duration / step - 1e-9)), 1)
    times = np.minimum(np.arange(1, count + 1) * step, duration)
    return times, np.diff(times, prepend=0.0)


def _incidence(time_h, lane):
    """cos(i) at times (down) for lanes (across); one column where the lanes share sun and panel."""
    hour_angle = power.hour_angle_deg(time_h[:, None], lane["synodic_day_h"])
    return power.incidence_factor(lane["latitude_deg"], hour_angle, lane["panel_tilt_deg"], lane["panel_azimuth_deg"])


def _traverse(design, scenario, model, balance, stalled, shape):
    """March all lanes, in blocks that stay in cache; the results by name, and the log of a single design."""
    size = int(np.prod(shape))
    lanes = {name: getattr(record, name) for record, names in zip((design, scenario, model), _MARCHED) for name in names}
    lanes |= dict(slip=balance.slip, torque=balance.torque_nm, stalled=stalled)
    lanes = {name: _shaped(value, shape).ravel() if np.ndim(value) else value for name, value in lanes.items()}
    times, steps = _step_times(scenario, model)
    block = max(MARCH_ELEMENTS // len(times), 32)
    results = {}
    for start in range(0, max(size, 1), block):
        part = {name: value[start:start + block] if np.ndim(value) else value for name, value in lanes.items()}
        found, log = _march(part, times, steps, shape == ())
        for name, value in found.items():
            results.setdefault(name, np.empty(size, np.result_type(value)))[start:start + block] = value
    return {name: value.reshape(shape) for name, value in results.items()}, log


def _march(lane, times, steps, with_log):
    """March a block of lanes: every value of `lane` is a number or an array with one entry a lane."""
    sun = lane["solar_constant_w_m2"] * lane["panel_efficiency"] * lane["dust_factor"] * lane["solar_area_m2"]
    duty = lane["duty_cycle"]
    base_load = lane["avionics_power_w"] + np.asarray(lane["payload_power_w"])
    average = sun * _incidence(np.linspace(0, times[-1], MEAN_SAMPLES), lane).mean(0)
    moving = ~np.asarray(lane["stalled"])
    speed, energy_speed, mobility = cruise_speed(
        average, base_load, lane["wheel_count"], lane["torque"], lane["slip"], lane["wheel_radius_m"], duty,
        lane["drivetrain_efficiency"], lane["hub_no_load_speed_rad_s"])
    speed, energy_speed, mobility = (np.where(moving, x, 0.0) for x in (speed, energy_speed, mobility))
    load = base_load + duty * mobility
    incidence = _incidence(times, lane)
    solar = incidence * sun                              # (steps, lanes)
    net = np.empty((len(times), *np.broadcast_shapes((1,), *map(np.shape, lane.values()))))
    np.subtract(solar, load, out=net)                    # for all lanes, also those that differ in the battery only
    deficit = net < 0
    capacity = lane["battery_capacity_wh"]
    stored = power.march_battery(
        net, steps[:, None], capacity, soc_initial=lane["soc_initial"], soc_floor=lane["soc_floor"],
        charge_efficiency=lane["charge_efficiency"], discharge_efficiency=lane["discharge_efficiency"])
    floor = lane["soc_floor"] * np.asarray(capacity)
    initial = np.maximum(lane["soc_initial"] * np.asarray(capacity), floor)
    # a step that starts on the floor with too little sun drives on what the sun leaves above the base load
    throttled = deficit
    throttled[1:] &= stored[:-1] <= floor
    throttled[0] &= initial <= floor
    # energies by the trapezoidal rule over the samples, nothing recorded at the start: the last one counts half
    samples = (steps + np.append(steps[1:], 0.0)) / 2
    driven_h, mobility_h = duty * steps.sum(), duty * samples.sum()
    if throttled.any():
        lost = np.where(throttled, duty - _solar_duty(solar, base_load, mobility, duty), 0.0)
        driven_h, mobility_h = driven_h - steps @ lost, mobility_h - samples @ lost
    generated = sun * (samples @ incidence)
    consumed = base_load * samples.sum() + mobility * mobility_h
    found = dict(range_km=np.minimum(np.where(driven_h > 0, 3.6 * speed * driven_h, 0.0), lane["traverse_limit_km"]),
                 energy_balance_pct=100 * (generated - consumed) / consumed, cruise_speed_m_s=speed,
                 energy_balance_speed_m_s=energy_speed, hub_speed_limited=moving & (speed < energy_speed),
                 average_solar_power_w=average, final_soc=stored[-1] / capacity,
                 minimum_soc=np.minimum(stored.min(0), initial) / capacity)
    if not with_log:
        return found, None
    driving = np.where(throttled, _solar_duty(solar, base_load, mobility, duty), duty)
    return found, _log(lane, times, steps, solar, base_load, driving * mobility, stored, initial, throttled,
                       np.where(driving > 0, 3.6 * speed * driving, 0.0))


def _solar_duty(solar, base_load, mobility, duty):
    """Duty that the sun alone carries above avionics and payload."""
    return np.clip((solar - base_load) / np.where(mobility > 0, mobility, np.inf), 0.0, duty)


def _above_rounding(power_w):
    """Power in W, 0 where it is negative or a rounding error of a difference of watts."""
    return np.where(power_w > 1e-9, power_w, 0.0)


def _log(lane, times, steps, solar, base_load, mobility, stored, initial, throttled, speed_km_h):
    """The march of one design as a TraverseLog."""
    solar, mobility, stored, throttled, speed_km_h = (
        np.broadcast_to(x, (len(times), 1))[:, 0] for x in (solar, mobility, stored, throttled, speed_km_h))
    change = np.diff(stored, prepend=initial.item()) / steps
    load = np.asarray(base_load).item() + mobility
    net = solar - load
    accepted = np.maximum(change, 0) / lane["charge_efficiency"]
    delivered = np.maximum(-change, 0) * lane["discharge_efficiency"]
    elevation, _ = power.sun_position(lane["latitude_deg"], power.hour_angle_deg(times, lane["synodic_day_h"]))
    return TraverseLog(
        time_h=times, step_h=steps, sun_elevation_deg=elevation, solar_w=solar, load_w=load, mobility_w=mobility,
        stored_wh=stored, soc=stored / lane["battery_capacity_wh"], throttled=throttled,
        discarded_w=_above_rounding(net - accepted), unserved_w=_above_rounding(-net - delivered),
        battery_loss_w=accepted - np.maximum(change, 0) + np.maximum(-change, 0) - delivered,
        distance_km=np.minimum(np.cumsum(speed_km_h * steps), lane["traverse_limit_km"]))
