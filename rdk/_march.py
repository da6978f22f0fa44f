"""The march of a mission hour by hour: sunlight, charge, driving; behind `rdk.mission`."""
from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np

from . import power, sky
from ._fields import Real, Record

MEAN_SAMPLES = 200                                       # samples of the mission-average solar power
MARCH_ELEMENTS = 2**17                                   # steps x lanes marched at once: 1 MB arrays stay in cache


@dataclass(frozen=True)
class TraverseLog(Record):
    """The march of one design through its mission: one row a time step, powers as averages over the step.

    `discarded_w` is sunlight that a full pack could not take, `unserved_w` demand that an empty one could not meet,
    `battery_loss_w` what charging and discharging cost: solar + unserved = load + discarded + battery loss + rate
    of change of the stored energy. `lit_fraction` is the share of the sun's disc above horizon or skyline.
    """
    time_h: np.ndarray
    step_h: np.ndarray
    sun_elevation_deg: np.ndarray
    lit_fraction: np.ndarray
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


def cruise_speed(average_solar_power_w: Real, base_load_w: Real, wheel_count: Real, wheel_torque_nm: Real, slip: Real,
                 wheel_radius_m: Real, duty_cycle: Real, drivetrain_efficiency: Real = 0.8,
                 hub_no_load_speed_rad_s: Real = 5.0, maximum_speed_m_s: Real = np.inf) -> tuple[Real, Real, Real]:
    """Cruise speed: what the average sunlight pays for, capped by the hub's no-load speed and by operations.

    The energy-balance speed alone, (P_solar - P_a - P_payload) r (1 - s) eta_m / (delta N_w T), reaches tens of m/s
    on easy ground. The cap omega_0 r (1 - s) is not in the paper's text but shapes its highland plateau. Where the
    torque of a wheel is not positive, driving costs nothing and the hub sets the speed. Returns the cruise speed, the
    speed without the caps, and the electrical power of all hubs while driving at cruise speed.
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


def shaped(value, shape):
    """An array of the common shape, or a plain number."""
    if not shape:
        return np.asarray(value).item()
    return value if np.shape(value) == shape else np.broadcast_to(value, shape)


def _step_times(scenario, model):
    """Time at the end of each step and its length, in hours; the last step ends with the mission."""
    duration, step = scenario.duration_earth_days * 24.0, model.time_step_h
    count = max(int(np.ceil(duration / step - 1e-9)), 1)
    times = np.minimum(np.arange(1, count + 1) * step, duration)
    steps = times.copy()
    steps[1:] -= times[:-1]
    return times, steps


def _sun(time_h, lane):
    """Hour angle and declination at times (down): of the paper's sun, or of the real one since `start_utc`."""
    if lane.start_utc is None:
        return power.hour_angle_deg(time_h[:, None], lane.synodic_day_h), 0.0
    declination, noon = sky.subsolar_point(sky.julian_date(lane.start_utc) + time_h[:, None] / 24)
    return (lane.longitude_deg - noon + 180) % 360 - 180, declination


def _incidence(time_h, lane):
    """cos(i) at times (down) for lanes (across) or, where they share sun and panel, one column; 0 behind a skyline."""
    hour_angle, declination = _sun(time_h, lane)
    lit = None
    if lane.skyline is not None:
        lit = sky.lit_fraction(*power.sun_position(lane.latitude_deg, hour_angle, declination), lane.skyline)
    return power.incidence_factor(lane.latitude_deg, hour_angle, lane.panel_tilt_deg, lane.panel_azimuth_deg,
                                  declination, lit)


def traverse(design, scenario, model, slip, torque_nm, stalled, shape, with_arrival=False):
    """March all lanes, in blocks that stay in cache; the results by name, and the log of a single design."""
    size = int(np.prod(shape))
    lanes = vars(design) | vars(scenario) | vars(model) | dict(slip=slip, torque_nm=torque_nm, stalled=stalled)
    lanes = {name: shaped(value, shape).ravel() if isinstance(value, np.ndarray) else value
             for name, value in lanes.items()}
    times, steps = _step_times(scenario, model)
    block = max(MARCH_ELEMENTS // len(times), 32)
    work = np.empty((4, len(times) * max(min(block, size), 1)))      # new arrays for each block would cost more to get
    results = {}
    for start in range(0, max(size, 1), block):
        lane = SimpleNamespace(**{name: value[start:start + block] if isinstance(value, np.ndarray) else value
                                  for name, value in lanes.items()})
        exact = np.asarray(lane.exact_floor) == 1
        width = min(block, size - start) if shape else 1
        arrays = work[:, :len(times) * width].reshape(4, len(times), width)
        found, log = _march(lane, arrays, times, steps, exact.any(), shape == (), with_arrival)
        if exact.any() and not exact.all():
            paper, _ = _march(lane, arrays, times, steps, False, False, with_arrival)
            found = {name: np.where(exact, value, paper[name]) for name, value in found.items()}
        for name, value in found.items():
            results.setdefault(name, np.empty(size, np.result_type(value)))[start:start + block] = value
    return {name: value.reshape(shape) for name, value in results.items()}, log


def _march(lane, work, times, steps, exact, with_log, with_arrival):
    """March a block of lanes in `work`, shape (4, steps, lanes); attributes of `lane` are numbers or have its lanes.

    The paper takes the sun at the end of each step and drives a step that reaches the floor to its end; `exact` takes
    the sun in the middle of the step and throttles from where the floor is reached, so that the step's length hardly
    matters.
    """
    sun = lane.solar_constant_w_m2 * lane.panel_efficiency * lane.dust_factor * lane.solar_area_m2
    duty, limit, capacity = lane.duty_cycle, np.asarray(lane.traverse_limit_km), np.asarray(lane.battery_capacity_wh)
    base_load = lane.avionics_power_w + np.asarray(lane.payload_power_w)
    seen = np.concatenate([times - steps / 2 if exact else times, np.linspace(0, times[-1], MEAN_SAMPLES)])
    incidence, sampled = np.split(_incidence(seen, lane), [len(times)])
    average = sun * sampled.mean(0)
    # a motor's line: its no-load speed falls with the torque, by the droop at the peak
    hub_speed = lane.hub_no_load_speed_rad_s * (
        1 - lane.motor_droop * np.minimum(np.maximum(lane.torque_nm / lane.peak_wheel_torque_nm, 0), 1))
    moving = ~np.asarray(lane.stalled)
    speed, energy_speed, mobility = (np.where(moving, x, 0.0) for x in cruise_speed(
        average, base_load, lane.wheel_count, lane.torque_nm, lane.slip, lane.wheel_radius_m, duty,
        lane.drivetrain_efficiency, hub_speed, lane.maximum_speed_m_s))
    solar, net, driving, lost = work
    np.multiply(incidence, sun, out=solar)
    floor = lane.soc_floor * capacity
    initial = np.maximum(lane.soc_initial * capacity, floor)

    def charge(load):
        """Stored energy at the end of each step, and the share of the step spent on the floor, short of power."""
        np.subtract(solar, load, out=net)
        deficit = net < 0
        stored = power.march_battery(net, steps[:, None], capacity, soc_initial=lane.soc_initial,
                                     soc_floor=lane.soc_floor, charge_efficiency=lane.charge_efficiency,
                                     discharge_efficiency=lane.discharge_efficiency)
        on_floor = stored <= floor
        # a step that starts on the floor with too little sun drives on what the sun leaves above the base load
        started = np.concatenate([np.broadcast_to(initial <= floor, (1, on_floor.shape[1])), on_floor[:-1]])
        share = deficit & started
        if exact:                                        # so does one that reaches the floor, from there on
            before = np.concatenate([np.broadcast_to(initial, (1, on_floor.shape[1])), stored[:-1]])
            hours = (before - floor) * lane.discharge_efficiency / (load - solar)
            share = np.where(deficit & on_floor, 1 - hours / steps[:, None], share)
        return stored, on_floor, share

    stored, on_floor, share = charge(base_load + duty * mobility)
    throttled = share > 0 if exact else share
    # energies by the trapezoidal rule over the samples, nothing recorded at the start: the last one counts half
    samples = steps.copy()
    if not exact:
        samples[:-1] += steps[1:]
        samples /= 2
    driven_h, mobility_h = duty * steps.sum(), duty * samples.sum()
    sunless = solar < base_load
    if throttled.any():
        # what the sun alone carries above avionics and payload: nothing but in a few steps, at dusk and dawn
        driving.fill(0.0)
        row = np.flatnonzero((throttled > sunless).any(1))
        driving[row] = np.clip((solar[row] - base_load) / np.where(mobility > 0, mobility, np.inf), 0.0, duty)
        if exact:
            np.subtract(duty, share * (duty - driving), out=driving)
        else:
            np.copyto(driving, duty, where=~share)
        np.subtract(duty, driving, out=lost)
        driven_h, mobility_h = driven_h - steps @ lost, mobility_h - samples @ lost
    else:
        driving = np.asarray(duty)                       # of each step
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
        dark = np.logical_and(on_floor, sunless, out=lost)
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
        found["arrival_h"] = arrival
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


def _log(lane, times, steps, solar, base_load, mobility, stored, soc, initial, throttled, speed_km_h):
    """The march of one design as a TraverseLog."""
    solar, mobility, stored, soc, throttled, speed_km_h = (
        np.broadcast_to(x, (len(times), 1))[:, 0] for x in (solar, mobility, stored, soc, throttled, speed_km_h))
    change = np.diff(stored, prepend=initial.item()) / steps
    load = np.asarray(base_load).item() + mobility
    net = solar - load
    accepted = np.maximum(change, 0) / lane.charge_efficiency
    delivered = np.maximum(-change, 0) * lane.discharge_efficiency
    # differences of watts: below that they are rounding errors
    discarded, unserved = (np.where(w > 1e-9, w, 0.0) for w in (net - accepted, -net - delivered))
    elevation, azimuth = power.sun_position(lane.latitude_deg, *(np.ravel(angle) for angle in _sun(times, lane)))
    lit = 1.0 * (elevation > 0) if lane.skyline is None else sky.lit_fraction(elevation, azimuth, lane.skyline)
    return TraverseLog(
        time_h=times, step_h=steps, sun_elevation_deg=elevation, lit_fraction=lit, solar_w=solar,
        load_w=load, mobility_w=mobility, stored_wh=stored, soc=soc, throttled=throttled,
        discarded_w=discarded, unserved_w=unserved,
        battery_loss_w=accepted - np.maximum(change, 0) + np.maximum(-change, 0) - delivered,
        distance_km=np.minimum(np.cumsum(speed_km_h * steps), lane.traverse_limit_km))
