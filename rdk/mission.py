"""Evaluate designs on missions: mass, wheel on slope, cruise speed, hour-by-hour traverse, survival.

The chain couples the physics modules as the paper does: total mass sets the wheel loads, the wheel sets slip and
torque, torque and sunlight set the speed, and the march through the mission sets charge and range. Slope and soil
are constant, so the wheel is solved once, outside the march.

Limits: constant slope, homogeneous soil, equal wheel loads; without `Scenario.start_utc` sunrise at the start and a
sun on the equator, without `skyline` a level horizon. The thermal cases know neither: they are the paper's noon and
night at the latitude. The range is what the energy allows under the duty cycle, not an operational estimate.
"""
from dataclasses import dataclass, field
from functools import partial
from types import SimpleNamespace

import numpy as np

from . import power, sky, terramechanics, thermal
from ._fields import Later, Record, require, together
from .design import Design, Model, Scenario, warn_outside
from .mass import MassBreakdown, mass_breakdown

MEAN_SAMPLES = 200                                       # samples of the mission-average solar power
MARCH_ELEMENTS = 2**17                                   # steps x lanes marched at once: 1 MB arrays stay in cache

MASS_COEFFICIENTS = (
    "wheel_areal_density_kg_m2", "grouser_thickness_m", "grouser_density_kg_m3", "motor_base_mass_kg",
    "motor_mass_per_torque_kg_nm", "solar_areal_density_kg_m2", "battery_specific_energy_wh_kg",
    "avionics_base_mass_kg", "avionics_mass_per_power_kg_w", "linkage_base_mass_kg", "linkage_chassis_fraction",
    "harness_fraction", "thermal_control_fraction", "growth_fraction", "wheel_web_factor", "frame_mass_kg_m2",
    "track_ratio")
_MARCHED = (                                             # what the march reads of design, scenario and model
    ("wheel_radius_m", "wheel_count", "solar_area_m2", "battery_capacity_wh", "avionics_power_w",
     "peak_wheel_torque_nm"),
    ("latitude_deg", "duty_cycle", "traverse_limit_km", "payload_power_w", "panel_tilt_deg", "panel_azimuth_deg",
     "maximum_speed_m_s", "start_utc", "longitude_deg", "skyline"),
    ("solar_constant_w_m2", "panel_efficiency", "dust_factor", "synodic_day_h", "drivetrain_efficiency",
     "hub_no_load_speed_rad_s", "motor_droop", "soc_initial", "soc_floor", "charge_efficiency",
     "discharge_efficiency", "stop_at_limit", "exact_floor"))
_WAITING = (("model", "axle_torque", 0),)


@dataclass(frozen=True)
class TraverseLog(Record):
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
    sliding : bool or ndarray
        On a descent the wheels cannot brake: the pull at the lowest slip exceeds the demand. Then `stalled`.
    unserved_h : float or ndarray
        Hours in which avionics or payload are not fully supplied: an empty pack and too little sun. Whole time steps;
        to the minute with `Model.exact_floor`.
    arrival_h : float or ndarray
        Hour at which the traverse limit is reached; infinity if never.
    hot_survival, cold_survival : bool or ndarray
        The two halves of `thermal_survival`: noon below the upper limit, night above the lower one.
    structure_share : float or ndarray
        Chassis mass over total mass.
    wheel_gap_m : float or ndarray
        Wheelbase less the length that the wheels of one side take up: 2 (r + h_g) on four, 4 (r + h_g) on six.
        Negative where they overlap, which no model forbids.
    mass : MassBreakdown
    log : TraverseLog or None
        Hour by hour, for one design only.
    """
    example = "rdk.evaluate(design, scenario)"
    apart = ("log",)                                     # its arrays run over time

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
    sliding: bool
    unserved_h: float
    arrival_h: float = Later()
    hot_survival: bool
    cold_survival: bool
    structure_share: float
    wheel_gap_m: float
    mass: MassBreakdown
    log: TraverseLog | None = field(default=None, compare=False)


def evaluate(design: Design, scenario: Scenario, *, model: Model = Model()) -> Performance:
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
    require(design=(design, Design), scenario=(scenario, Scenario), model=(model, Model))
    for kind, name, paper in _WAITING:
        if np.any(getattr({"scenario": scenario, "model": model}[kind], name) != paper):
            raise NotImplementedError(f"{name} of the {kind} is not built yet")
    shape = together(design=design.shape, scenario=scenario.shape, model=model.shape)
    warn_outside(design)
    with np.errstate(all="ignore"):                      # a lane without a solution is infeasible, not a warning
        mass = mass_of(design, scenario, model)
        weight = mass.total_kg * model.gravity_m_s2 / design.wheel_count         # load and pull shared equally
        balance, capability = terramechanics.climb(
            design.wheel, scenario.soil, weight, scenario.slope_deg, slip_min=model.slip_min, slip_max=model.slip_max,
            capability_slip=model.slope_capability_slip, capability_limit_deg=model.slope_capability_limit_deg,
            **{name: getattr(model, name) for name in terramechanics.OPTIONS})
        stalled = balance.stalled | (balance.torque_nm > design.peak_wheel_torque_nm)
        march = partial(_traverse, design, scenario, model, balance.slip, balance.torque_nm, stalled, shape)
        traverse, log = march()
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
        obstacle = design.wheel_radius_m * np.where(np.equal(design.wheel_count, 6), model.rocker_bogie_obstacle_ratio,
                                                    model.rigid_obstacle_ratio)
        contact_m2 = design.wheel_width_m * np.sqrt(balance.sinkage_m * (2 * design.wheel_radius_m - balance.sinkage_m))
        pressure = weight * np.cos(np.radians(scenario.slope_deg)) / contact_m2 / 1000
        along = np.where(np.equal(design.wheel_count, 6), 4, 2) * (design.wheel_radius_m + design.grouser_height_m)
        feasible = (~np.asarray(stalled) & (traverse["energy_balance_pct"] >= 0) & (traverse["range_km"] > 0)
                    & (obstacle >= scenario.required_obstacle_height_m))
    fields = dict(
        traverse, total_mass_kg=mass.total_kg, slope_capability_deg=capability, stalled=stalled,
        thermal_survival=hot_survival & cold_survival, feasible=feasible, buried=balance.buried, slip=balance.slip,
        sinkage_m=balance.sinkage_m, wheel_torque_nm=balance.torque_nm, hot_temperature_c=hot, cold_temperature_c=cold,
        obstacle_capability_m=obstacle, ground_pressure_kpa=pressure, sliding=balance.sliding,
        hot_survival=hot_survival, cold_survival=cold_survival, structure_share=mass.chassis_kg / mass.total_kg,
        wheel_gap_m=design.wheelbase_m - along)
    return Performance(**{name: _shaped(value, shape) for name, value in fields.items()}, log=log,
                       arrival_h=partial(_arrival_h, march, shape),
                       mass=MassBreakdown(**{name: _shaped(value, shape) for name, value in mass.numbers().items()}))


def _shaped(value, shape):
    """An array of the common shape, or a plain number."""
    if not shape:
        return np.asarray(value).item()
    return value if np.shape(value) == shape else np.broadcast_to(value, shape)


def mass_of(design, scenario, model):
    """Mass breakdown of a design with the scenario's payload; raises nothing."""
    return mass_breakdown(**design.numbers(), payload_mass_kg=scenario.payload_mass_kg,
                          **{name: getattr(model, name) for name in MASS_COEFFICIENTS})


def cruise_speed(average_solar_power_w, base_load_w, wheel_count, wheel_torque_nm, slip, wheel_radius_m, duty_cycle,
                 drivetrain_efficiency=0.8, hub_no_load_speed_rad_s=5.0, maximum_speed_m_s=np.inf):
    """Cruise speed: what the average sunlight pays for, capped by the hub's no-load speed and by operations.

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
    maximum_speed_m_s : float or ndarray
        What operations allow.

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
        speed = np.minimum(np.minimum(energy_speed, hub_no_load_speed_rad_s * rolling_radius), maximum_speed_m_s)
        power_w = np.where(np.isfinite(speed), torque * speed / rolling_radius / drivetrain_efficiency, 0.0)
    return speed, energy_speed, power_w


def _step_times(scenario, model):
    """Time at the end of each step and its length, in hours; the last step ends with the mission."""
    duration, step = scenario.duration_earth_days * 24.0, model.time_step_h
    count = max(int(np.ceil(duration / step - 1e-9)), 1)
    times = np.minimum(np.arange(1, count + 1) * step, duration)
    return times, np.diff(times, prepend=0.0)


def _sun(time_h, lane):
    """Hour angle and declination at times (down): of the paper's sun, or of the real one since `start_utc`."""
    if lane.start_utc is None:
        return power.hour_angle_deg(time_h[:, None], lane.synodic_day_h), 0.0
    declination, noon = sky.subsolar_point(sky.julian_date(lane.start_utc) + time_h[:, None] / 24)
    return (lane.longitude_deg - noon + 180) % 360 - 180, declination


def _incidence(time_h, lane):
    """cos(i) at times (down) for lanes (across), times the share of the disc above the skyline where there is one.

    One column where the lanes share sun and panel.
    """
    hour_angle, declination = _sun(time_h, lane)
    lit = None
    if lane.skyline is not None:
        lit = sky.lit_fraction(*power.sun_position(lane.latitude_deg, hour_angle, declination), lane.skyline)
    return power.incidence_factor(lane.latitude_deg, hour_angle, lane.panel_tilt_deg, lane.panel_azimuth_deg,
                                  declination, lit)


def _arrival_h(march, shape):
    """The march again, for the read-out that not every evaluation pays for."""
    with np.errstate(all="ignore"):
        return _shaped(march(with_arrival=True)[0]["arrival_h"], shape)


def _traverse(design, scenario, model, slip, torque_nm, stalled, shape, with_arrival=False):
    """March all lanes, in blocks that stay in cache; the results by name, and the log of a single design."""
    size = int(np.prod(shape))
    records = zip((design, scenario, model), _MARCHED)
    lanes = {name: getattr(record, name) for record, names in records for name in names}
    lanes |= dict(slip=slip, torque_nm=torque_nm, stalled=stalled)
    lanes = {name: _shaped(value, shape).ravel() if np.ndim(value) else value for name, value in lanes.items()}
    times, steps = _step_times(scenario, model)
    block = max(MARCH_ELEMENTS // len(times), 32)
    results = {}
    for start in range(0, max(size, 1), block):
        lane = SimpleNamespace(**{name: value[start:start + block] if np.ndim(value) else value
                                  for name, value in lanes.items()})
        exact = np.asarray(lane.exact_floor) == 1
        found, log = _march(lane, times, steps, exact.any(), shape == (), with_arrival)
        if exact.any() and not exact.all():
            paper, _ = _march(lane, times, steps, False, False, with_arrival)
            found = {name: np.where(exact, value, paper[name]) for name, value in found.items()}
        for name, value in found.items():
            results.setdefault(name, np.empty(size, np.result_type(value)))[start:start + block] = value
    return {name: value.reshape(shape) for name, value in results.items()}, log


def _march(lane, times, steps, exact, with_log, with_arrival):
    """March a block of lanes: every attribute of `lane` is a number or an array with one entry a lane.

    The paper takes the sun at the end of each step and drives a step that reaches the floor to its end; `exact` takes
    the sun in the middle of the step and throttles from where the floor is reached, so that the step's length hardly
    matters.
    """
    sun = lane.solar_constant_w_m2 * lane.panel_efficiency * lane.dust_factor * lane.solar_area_m2
    duty, limit, capacity = lane.duty_cycle, np.asarray(lane.traverse_limit_km), np.asarray(lane.battery_capacity_wh)
    base_load = lane.avionics_power_w + np.asarray(lane.payload_power_w)
    average = sun * _incidence(np.linspace(0, times[-1], MEAN_SAMPLES), lane).mean(0)
    # a motor's line: its no-load speed falls with the torque, by the droop at the peak
    hub_speed = lane.hub_no_load_speed_rad_s * (
        1 - lane.motor_droop * np.clip(lane.torque_nm / lane.peak_wheel_torque_nm, 0, 1))
    moving = ~np.asarray(lane.stalled)
    speed, energy_speed, mobility = (np.where(moving, x, 0.0) for x in cruise_speed(
        average, base_load, lane.wheel_count, lane.torque_nm, lane.slip, lane.wheel_radius_m, duty,
        lane.drivetrain_efficiency, hub_speed, lane.maximum_speed_m_s))
    incidence = _incidence(times - steps / 2 if exact else times, lane)
    solar = incidence * sun                              # (steps, lanes)
    floor = lane.soc_floor * capacity
    initial = np.maximum(lane.soc_initial * capacity, floor)

    def charge(load):
        """Stored energy at the end of each step, and the share of the step spent on the floor, short of power."""
        net = np.empty((len(times), *np.broadcast_shapes((1,), *map(np.shape, vars(lane).values()))))
        np.subtract(solar, load, out=net)                # for all lanes, also those that differ in the battery only
        deficit = net < 0
        stored = power.march_battery(net, steps[:, None], capacity, soc_initial=lane.soc_initial,
                                     soc_floor=lane.soc_floor, charge_efficiency=lane.charge_efficiency,
                                     discharge_efficiency=lane.discharge_efficiency)
        on_floor = stored <= floor
        # a step that starts on the floor with too little sun drives on what the sun leaves above the base load
        share = deficit & np.concatenate([np.broadcast_to(initial <= floor, (1, on_floor.shape[1])), on_floor[:-1]])
        if exact:                                        # so does one that reaches the floor, from there on
            before = np.concatenate([np.broadcast_to(initial, (1, on_floor.shape[1])), stored[:-1]])
            hours = (before - floor) * lane.discharge_efficiency / (load - solar)
            share = np.where(deficit & on_floor, 1 - hours / steps[:, None], share)
        return stored, on_floor, share

    stored, on_floor, share = charge(base_load + duty * mobility)
    throttled = share > 0
    # energies by the trapezoidal rule over the samples, nothing recorded at the start: the last one counts half
    samples = steps if exact else (steps + np.append(steps[1:], 0.0)) / 2
    driven_h, mobility_h = duty * steps.sum(), duty * samples.sum()
    driving = np.asarray(duty)                           # duty of each step
    if throttled.any():
        sunlit = _solar_duty(solar, base_load, mobility, duty)
        driving = duty - share * (duty - sunlit) if exact else np.where(share, sunlit, duty)
        lost = duty - driving
        driven_h, mobility_h = driven_h - steps @ lost, mobility_h - samples @ lost
    distance = np.where(driven_h > 0, 3.6 * speed * driven_h, 0.0)
    stops = np.asarray(lane.stop_at_limit) == 1
    arrival = _arrival(limit, distance, 3.6 * speed, driving, times, steps) if with_arrival or stops.any() else None
    if stops.any():                                      # the motors stop on arrival: the march again, with that load
        share_h = np.clip(arrival - (times - steps)[:, None], 0, steps[:, None])
        until = np.where(stops, share_h / steps[:, None], 1.0)
        stored, on_floor, share = charge(base_load + duty * mobility * until)
        driving = driving * until
        mobility_h = samples @ np.broadcast_to(driving, stored.shape)
    unserved_h = 0.0
    if on_floor.any():
        dark = on_floor & (solar < base_load)
        unserved_h = steps @ (dark * share if exact else dark)
    generated = sun * (samples @ incidence)
    consumed = base_load * samples.sum() + mobility * mobility_h

    def soc(stored):
        """State of charge; on the floor exactly that, whatever multiplying and dividing back leaves."""
        return np.where(stored <= floor, lane.soc_floor, stored / capacity)

    found = dict(range_km=np.minimum(distance, limit), energy_balance_pct=100 * (generated - consumed) / consumed,
                 cruise_speed_m_s=speed, energy_balance_speed_m_s=energy_speed,
                 hub_speed_limited=moving & (speed < np.minimum(energy_speed, lane.maximum_speed_m_s)),
                 average_solar_power_w=average, final_soc=soc(stored[-1]),
                 minimum_soc=soc(np.minimum(stored.min(0), initial)), unserved_h=unserved_h)
    if with_arrival:
        return {"arrival_h": arrival}, None
    if not with_log:
        return found, None
    return found, _log(lane, times, steps, solar, base_load, driving * mobility, stored, soc(stored), initial,
                       throttled, np.where(driving > 0, 3.6 * speed * driving, 0.0))


def _arrival(limit_km, distance_km, speed_km_h, driving, times, steps):
    """Hour at which each lane reaches its limit, infinity where it does not."""
    reached = (distance_km >= limit_km) & (distance_km > 0)
    if not np.any(reached):
        return np.full(np.shape(reached), np.inf)
    if driving.ndim == 0 or driving.shape[0] == 1:
        return np.where(reached, limit_km / (speed_km_h * driving), np.inf)
    driven_h = np.cumsum(driving * steps[:, None], axis=0)
    need_h = limit_km / speed_km_h
    last = np.minimum((driven_h < need_h).sum(0), len(steps) - 1)
    column = np.arange(driven_h.shape[1])
    over = driven_h[last, column] - need_h
    rate = np.broadcast_to(driving, driven_h.shape)[last, column]
    return np.where(reached, times[last] - over / rate, np.inf)


def _solar_duty(solar, base_load, mobility, duty):
    """Duty that the sun alone carries above avionics and payload."""
    return np.clip((solar - base_load) / np.where(mobility > 0, mobility, np.inf), 0.0, duty)


def _above_rounding(power_w):
    """Power in W, 0 where it is negative or a rounding error of a difference of watts."""
    return np.where(power_w > 1e-9, power_w, 0.0)


def _log(lane, times, steps, solar, base_load, mobility, stored, soc, initial, throttled, speed_km_h):
    """The march of one design as a TraverseLog."""
    solar, mobility, stored, soc, throttled, speed_km_h = (
        np.broadcast_to(x, (len(times), 1))[:, 0] for x in (solar, mobility, stored, soc, throttled, speed_km_h))
    change = np.diff(stored, prepend=initial.item()) / steps
    load = np.asarray(base_load).item() + mobility
    net = solar - load
    accepted = np.maximum(change, 0) / lane.charge_efficiency
    delivered = np.maximum(-change, 0) * lane.discharge_efficiency
    elevation, _ = power.sun_position(lane.latitude_deg, *(np.ravel(angle) for angle in _sun(times, lane)))
    return TraverseLog(
        time_h=times, step_h=steps, sun_elevation_deg=elevation, solar_w=solar, load_w=load, mobility_w=mobility,
        stored_wh=stored, soc=soc, throttled=throttled,
        discarded_w=_above_rounding(net - accepted), unserved_w=_above_rounding(-net - delivered),
        battery_loss_w=accepted - np.maximum(change, 0) + np.maximum(-change, 0) - delivered,
        distance_km=np.minimum(np.cumsum(speed_km_h * steps), lane.traverse_limit_km))
