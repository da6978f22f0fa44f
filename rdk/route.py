"""Ways over a height map: what a metre costs, the cheapest way, rocks in it, and the march along it.

Energy and time come from the wheel model at each slope, the way from SciPy's Dijkstra on the eight neighbours of each
cell. Slopes shorter than a cell, turning, and braking that would charge the battery are left out.
"""
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from . import catalog, mission, power, sky
from ._fields import Real, brief, check, listed, require
from .design import Design, Model, Scenario
from .sampling import single
from .terrain import Terrain

MODES = ("drive", "science", "charge", "sleep", "arrived", "empty", "stalled")
DRIVE, SCIENCE, CHARGE, SLEEP, ARRIVED, EMPTY, STALLED = range(7)


def per_metre(design: Design, scenario: Scenario, slope_deg: Real, *, model: Model = Model()) -> tuple[Real, Real]:
    """Energy of the wheels (J/m) and time (s/m) for a metre of ground, at the hub's or the allowed speed.

    The slope, uphill positive, broadcasts with the design; soil, payload and `maximum_speed_m_s` of the scenario count.
    Both are infinite where the rover stalls or slides.
    """
    require(design=(design, Design), scenario=(scenario, Scenario), model=(model, Model))
    short = scenario.replace(slope_deg=slope_deg, duration_earth_days=model.time_step_h / 24)    # one step to march
    now = mission.evaluate(design, short, model=model)
    droop = 1 - model.motor_droop * np.clip(now.wheel_torque_nm / np.asarray(design.peak_wheel_torque_nm), 0, 1)
    speed, _, hub_w = mission.cruise_speed(
        np.inf, 0.0, design.wheel_count, now.wheel_torque_nm, now.slip, design.wheel_radius_m, 1.0,
        model.drivetrain_efficiency, model.hub_no_load_speed_rad_s * droop, scenario.maximum_speed_m_s)
    with np.errstate(all="ignore"):
        second = np.where(now.stalled | now.buried | ~(speed > 0), np.inf, 1 / speed)
        return np.where(np.isfinite(second), hub_w * second, np.inf)[()], second[()]


def cost(design: Design, scenario: Scenario, *, model: Model = Model()) -> Callable:
    """Joules for a metre of ground as a function of the slope (deg), for `cheapest`: wheels, avionics and payload.

    One design; the function interpolates a table in steps of 0.5 deg and is infinite beyond 34.5 deg.
    """
    single(design=design, scenario=scenario, model=model)
    slope = np.arange(-34.5, 34.75, 0.5)
    wheel, second = per_metre(design, scenario, slope, model=model)
    joule = wheel + (design.avionics_power_w + scenario.payload_power_w) * second
    return lambda slope_deg: np.interp(slope_deg, slope, joule, left=np.inf, right=np.inf)


def rocks_per_m2(diameter_m: Real, area_fraction: Real) -> Real:
    """Rocks wider than `diameter_m` on a square metre, where rocks cover `area_fraction` of the ground.

    Golombek & Rapp (1997): those wider than D cover k exp(-q D), q = 1.79 + 0.152 / k. One covers pi D^2 / 4, so
    N(> D) is the integral of 4 k q exp(-q x) / (pi x^2) from D on.
    """
    from scipy.special import exp1
    k, diameter = check("area_fraction", area_fraction, 0, 1), check("diameter_m", diameter_m, above=0)
    with np.errstate(all="ignore"):
        q = 1.79 + np.divide(0.152, k)
        return np.where(k > 0, 4 * k * q / np.pi * (np.exp(-q * diameter) / diameter - q * exp1(q * diameter)), 0.0)[()]


def detour_factor(obstacle_m: Real, width_m: Real, area_fraction: Real) -> Real:
    """Length driven over length gained, where rocks too tall to climb are driven around one by one.

    A rover of this width climbs rocks as tall as `obstacle_m` (`Performance.obstacle_capability_m`), half as tall as
    they are wide. A metre of its swath meets those whose middle lies within its width and their diameter, and passing
    one costs about that length.
    """
    diameter = 2 * check("obstacle_m", obstacle_m, above=0)
    return 1 + rocks_per_m2(diameter, area_fraction) * (check("width_m", width_m, above=0) + diameter) ** 2


@dataclass(frozen=True, eq=False)
class Route:
    """A way over a map: energy (J), length over ground (m), cells (k, 2) as (row, column) from start to goal.

    Without a way the energy and length are infinite, there are no cells, and `message` says why; else it is "".
    `reach_j` is the least energy from the start to every cell of the map, infinity where none leads.
    """
    energy_j: float
    length_m: float
    cells: np.ndarray = field(repr=False)
    reach_j: np.ndarray = field(repr=False)
    message: str = ""


def cheapest(terrain: Terrain, joule_per_m: Callable, start: tuple[int, int], goal: tuple[int, int], *,
             tilt_limit_deg: float, edge_limit_deg: float, detour: Real = 1.0) -> Route:
    """The way of least energy between two cells (row, column; row 0 at the top), over the eight neighbours of each.

    `joule_per_m` gives the energy of a metre of ground at slopes along the way (deg, uphill positive), as `cost`
    returns it: infinity where the rover cannot go, never negative. No cell is entered that is steeper than
    `tilt_limit_deg` in its steepest direction; no step between cells is steeper than `edge_limit_deg`, up or down.
    `detour`, length driven over length gained, is at least 1: one number, or one a cell.
    """
    require(terrain=(terrain, Terrain))
    from scipy.sparse import csgraph, csr_array
    height, (rows, columns) = terrain.height_m, terrain.height_m.shape
    if not callable(joule_per_m):
        raise TypeError(f"joule_per_m must be a function, such as rdk.route.cost(rover, mission); got {joule_per_m!r}")
    for name, value in (("tilt_limit_deg", tilt_limit_deg), ("edge_limit_deg", edge_limit_deg)):
        check(name, value, 0, 90, scalar=True)
    if np.shape(check("detour", detour, 1)) not in ((), height.shape):
        raise ValueError(f"detour must be one number or have the map's shape {height.shape}; got {np.shape(detour)}")
    detour = np.broadcast_to(detour, height.shape)
    for name, end in (("start", start), ("goal", goal)):
        if not isinstance(end, (tuple, list, np.ndarray)) or len(end) != 2 or not all(
                i in range(n) for i, n in zip(end, height.shape)):
            raise ValueError(f"{name} must be a cell (row, column) of the {rows} x {columns} map; got {end!r}")
    tilt, index = terrain.slope(), np.arange(rows * columns, dtype=np.int32).reshape(rows, columns)
    safe, edges = tilt <= tilt_limit_deg, []
    for down, right in ((0, 1), (1, 0), (1, 1), (1, -1)):            # each pair of neighbours once, driven both ways
        here = np.s_[:rows - down, max(-right, 0):columns - max(right, 0)]
        there = np.s_[down:, max(right, 0):columns - max(-right, 0)]
        run, rise = terrain.step_m * np.hypot(down, right), height[there] - height[here]
        slope, length = np.degrees(np.arctan2(rise, run)), np.hypot(run, rise) * (detour[here] + detour[there]) / 2
        ok = safe[here] & safe[there] & (np.abs(slope) <= edge_limit_deg)
        a, b, slope, length = index[here][ok], index[there][ok], slope[ok], length[ok]
        edges += [(a, b, joule_per_m(slope) * length), (b, a, joule_per_m(-slope) * length)]
    source, target, joule = (np.concatenate(part) for part in zip(*edges))
    if np.any(joule < 0):
        raise ValueError(f"joule_per_m must not be negative: braking gives nothing back; got {joule.min():g} J an edge")
    real = np.isfinite(joule)
    graph = csr_array((joule[real], (source[real], target[real])), shape=(index.size, index.size))
    first, last = index[tuple(start)].item(), index[tuple(goal)].item()
    energy, before = csgraph.dijkstra(graph, indices=first, return_predecessors=True)
    reach = energy.reshape(rows, columns)
    if not np.isfinite(energy[last]):
        steep = [f"the {name} ({row}, {column}) tilts {tilt[row, column]:.1f} deg"
                 for name, (row, column) in (("start", start), ("goal", goal)) if not safe[row, column]]
        why = " and ".join(steep) or f"{np.isfinite(energy).mean():.1%} of the map can be reached from the start"
        return Route(np.inf, np.inf, np.empty((0, 2), int), reach,
                     f"no way within {tilt_limit_deg:g} deg of tilt and {edge_limit_deg:g} deg along the way: {why}")
    path = [last]
    while path[-1] != first:
        path.append(int(before[path[-1]]))
    cells = np.array(np.unravel_index(path[::-1], (rows, columns))).T
    return Route(float(energy[last]), float(along(terrain, cells).ground_m.sum()), cells, reach)


@dataclass(frozen=True, eq=False, repr=False)
class Way:
    """What a march needs of a way: the map's distance of its points from the start, their places, the slope between.

    The slope of each leg is positive uphill. The sun is seen from the distances `skyline_m`, over `skylines`; without
    any, over a level horizon.
    """
    distance_m: np.ndarray
    slope_deg: np.ndarray
    latitude_deg: np.ndarray
    longitude_deg: np.ndarray
    skyline_m: tuple = ()
    skylines: tuple = ()

    __repr__ = brief

    def __post_init__(self):
        skylines = tuple(listed("skylines", self.skylines, sky.Skyline))
        arrays = {name: check(name, value) for name, value in vars(self).items() if name != "skylines"}
        points = np.size(self.distance_m)
        shapes = [(points,), (max(points - 1, 0),), (points,), (points,), (len(skylines),)]
        if [np.shape(array) for array in arrays.values()] != shapes or np.any(np.diff(arrays["distance_m"]) <= 0):
            raise ValueError("a way needs rising distance_m, latitude_deg and longitude_deg of one length, one "
                             "slope_deg fewer, and as many skylines as skyline_m")
        vars(self).update(arrays, skylines=skylines)

    @property
    def ground_m(self) -> np.ndarray:
        """Length of each leg over the ground."""
        return np.diff(self.distance_m) / np.cos(np.radians(self.slope_deg))


def along(terrain: Terrain, cells: np.ndarray, *, skyline_every_m: float | None = None, height_m: float = 1.0,
          beyond: tuple[Terrain, ...] = ()) -> Way:
    """The Way through cells of a map; with `skyline_every_m` it looks around at that spacing and at the end."""
    require(terrain=(terrain, Terrain))
    cells = check("cells", cells, 0, whole=True)
    if np.shape(cells) != (np.size(cells) // 2, 2) or np.any(cells >= terrain.height_m.shape):
        raise ValueError(f"cells must be rows and columns of the map, shape (k, 2); got {cells!r:.80}")
    x, y = terrain.place(*cells.T)
    run = np.hypot(np.diff(x), np.diff(y))
    distance, rise = np.r_[0.0, np.cumsum(run)][:len(x)], np.diff(terrain.height_m[*cells.T])
    stops = [] if skyline_every_m is None else np.unique(np.r_[np.searchsorted(distance, np.arange(
        0, distance[-1], check("skyline_every_m", skyline_every_m, above=0, scalar=True))), len(distance) - 1])
    return Way(distance, np.degrees(np.arctan2(rise, run)), *terrain.to_latlon(x, y), tuple(distance[i] for i in stops),
               tuple(terrain.skyline(x[i], y[i], height_m, beyond=beyond) for i in stops))


def ridge() -> Way:
    """The tabulated Way along Connecting Ridge, 1.9 km near the south pole, with its skylines 1 m above ground."""
    way, seen = catalog.table("ridge_route.csv"), catalog.table("ridge_route_skylines.csv").set_index("azimuth_deg")
    slope = np.degrees(np.arctan2(np.diff(way.height_m), np.diff(way.distance_m)))
    return Way(way.distance_m, slope, way.latitude_deg, way.longitude_deg, [float(name[3:-1]) for name in seen],
               [sky.Skyline(seen.index, seen[name]) for name in seen])


@dataclass(frozen=True, eq=False, repr=False)
class March:
    """What became of a rover on its way, step by step; arrays with one column a lane, or none for one lane.

    `mode` is an index of `MODES`. `arrival_h` is infinite where the rover does not arrive; `stranded_m` is then how
    far it came, else infinite. `message` says which it was, and why: one sentence a lane.
    """
    time_h: np.ndarray
    distance_m: np.ndarray
    stored_wh: np.ndarray
    solar_w: np.ndarray
    load_w: np.ndarray
    mode: np.ndarray
    arrival_h: float
    stranded_m: float
    message: str

    __repr__ = brief


def march(way: Way, design: Design, scenario: Scenario, *, model: Model = Model(), delay_h: Real = 0.0,
          follow_sun: bool = False, rest_soc: float = 0.5, go_soc: float = 0.9, science_every_m: float = np.inf,
          science_h: float = 0.0, detour: float = 1.0, step_h: float = 0.25) -> March:
    """Drive along a way under the real sun: drive, do science, charge, sleep, until arrival, an empty pack or a stall.

    The rover drives until its state of charge falls to `rest_soc`, then stands with the avionics on while the sun pays
    for them and asleep otherwise (`Model.hibernation_power_w`), and goes on at `go_soc`. It is lost when its pack
    reaches the floor. The payload runs during the stops for science only. Of the scenario its `start_utc`, soil,
    payload, panel, speed and duration count. `delay_h`, the hours after `start_utc` at which to set out, broadcasts
    with the designs, so that one call tries many dates. To `follow_sun` the panel turns; else it keeps the scenario's
    azimuth. `detour` is the length driven over that of the way, as from `detour_factor`.
    """
    require(way=(way, Way), design=(design, Design), scenario=(scenario, Scenario), model=(model, Model))
    if scenario.start_utc is None:
        raise ValueError("a march needs the real sun: give the scenario a start_utc, such as '2026-10-01'")
    if not len(way.slope_deg):
        raise ValueError("a march needs a way of two points or more; where there is none, Route.message says why")
    check("go_soc", go_soc, 0, 1, scalar=True)
    check("rest_soc", rest_soc, np.max(model.soc_floor), go_soc, scalar=True)
    check("science_every_m", science_every_m, above=0, infinite=True, scalar=True)
    for name, value, low in (("science_h", science_h, 0), ("detour", detour, 1), ("step_h", step_h, 1e-6)):
        check(name, value, low, scalar=True)
    lanes = np.broadcast_shapes(design.shape, scenario.shape, model.shape, np.shape(check("delay_h", delay_h)))
    if len(lanes) > 1 or 0 in lanes:
        raise ValueError(f"a march takes one row of lanes; got shape {lanes}")
    count, goal = lanes[0] if lanes else 1, way.distance_m[-1]
    wheel, second = (np.broadcast_to(x, (count, len(way.slope_deg))) for x in per_metre(*(
        record[:, None] if record.shape else record for record in (design, scenario)), way.slope_deg,
        model=model[:, None] if model.shape else model))
    stuck, points = np.isinf(second), np.broadcast_to(way.distance_m, (count, len(way.distance_m)))
    end = np.where(stuck.any(1), way.distance_m[np.argmax(stuck, 1)], goal)
    clock, joules = (np.cumsum(np.c_[np.zeros(count), np.where(stuck, 1e6, x * (way.ground_m * detour))], axis=1)
                     for x in (second, wheel))

    def along_lane(x, xs, ys):
        """Interpolation lane by lane: the lanes' rising tables end to end."""
        shift = np.arange(count) * 2 * xs.max()
        return np.interp(np.minimum(x, xs[:, -1]) + shift, (xs + shift[:, None]).ravel(), ys.ravel())

    steps = int(np.ceil(24 * scenario.duration_earth_days / step_h))
    time = np.arange(1, steps + 1) * step_h
    date = sky.julian_date(scenario.start_utc) + (time[:, None] - step_h / 2 + np.atleast_1d(delay_h)) / 24
    declination, noon = sky.subsolar_point(date)
    places = way.latitude_deg, np.unwrap(way.longitude_deg, period=360)
    seen_m, light = np.r_[way.skyline_m if way.skylines else 0.0, np.inf], []
    for at, seen in zip(seen_m, way.skylines or [None]):
        lat, lon = (np.interp(at, way.distance_m, values) for values in places)
        elevation, azimuth = power.sun_position(lat, lon - noon, declination)
        light.append(power.incidence_factor(
            lat, lon - noon, scenario.panel_tilt_deg, azimuth if follow_sun else scenario.panel_azimuth_deg,
            declination, sky.lit_fraction(elevation, azimuth, seen)))
    light = np.broadcast_to([*light, light[-1]], (len(seen_m), steps, count))    # beyond the last skyline, the last
    panel = power.panel_power(design.solar_area_m2, 1.0, efficiency=model.panel_efficiency,
                              dust_factor=model.dust_factor, solar_constant_w_m2=model.solar_constant_w_m2)
    avionics, capacity = design.avionics_power_w, design.battery_capacity_wh
    floor = model.soc_floor * capacity
    distance, stored = np.zeros(count), np.maximum(model.soc_initial * capacity, floor)
    resting, lost, work_h, stop = False, False, 0.0, science_every_m
    log, lane = [], np.arange(count)
    for step in range(steps):
        k = np.maximum(np.searchsorted(seen_m, distance, "right") - 1, 0)
        share = np.clip((distance - seen_m[k]) / np.diff(seen_m)[k], 0, 1)
        solar = panel * ((1 - share) * light[k, step, lane] + share * light[k + 1, step, lane])
        resting = np.where(resting, stored < go_soc * capacity, stored <= rest_soc * capacity)
        mode = np.select([lost, distance >= goal, distance >= end, resting & (solar > avionics), resting, work_h > 0],
                         [EMPTY, ARRIVED, STALLED, CHARGE, SLEEP, SCIENCE], DRIVE)
        ahead = along_lane(along_lane(distance, points, clock) + 3600 * step_h, clock, points)
        ahead = np.where(mode == DRIVE, np.minimum(np.minimum(ahead, end), stop), distance)
        hub = (along_lane(ahead, points, joules) - along_lane(distance, points, joules)) / (3600 * step_h)
        load = np.where(mode == SLEEP, model.hibernation_power_w, avionics) + hub
        load = load + np.where(mode == SCIENCE, scenario.payload_power_w, 0)
        load, net = np.where(lost, 0.0, [load, solar - load])
        change = np.where(net > 0, net * model.charge_efficiency, net / model.discharge_efficiency)
        stored = np.minimum(stored + step_h * change, capacity)
        lost = lost | (stored <= floor) & (mode < ARRIVED)
        stored = np.maximum(stored, floor)
        there = (ahead >= stop) & (mode == DRIVE)
        work_h = np.where(mode == SCIENCE, work_h - step_h, np.where(there, science_h, work_h))
        stop, distance = np.where(there, stop + science_every_m, stop), ahead
        log.append((distance, stored, solar, load, mode))
        if np.all(lost | (distance >= goal) | (mode == STALLED)):
            break
    distances, stored, solar, load, modes = log = [np.array(values) for values in zip(*log)]
    time, arrived = time[:len(modes)], distance >= goal
    arrival = np.where(arrived, time[np.argmax(distances >= end, axis=0)], np.inf)
    messages = [_sentence(way, time, *of_lane) for of_lane in zip(distances.T, solar.T, modes.T, end, lost)]
    return March(time, *(values.reshape(-1, *lanes) for values in log), arrival.reshape(lanes)[()],
                 np.where(arrived, np.inf, distance).reshape(lanes)[()], messages if lanes else messages[0])


def _sentence(way, time, distance, solar, mode, end_m, lost):
    """Where one lane of a march ended, and why."""
    goal, ended = way.distance_m[-1], time[distance >= end_m]
    if distance[-1] >= goal:
        return f"arrives after {ended[0]:.1f} h"
    until = f"stranded at {distance[-1]:.0f} m after "
    if lost:
        alive = mode != EMPTY
        last, sunny = time[alive][-1], time[alive & (solar > 0)]
        return f"{until}{last:.1f} h: pack empty, {last - max(sunny, default=0.0):.1f} h after the last sun"
    if len(ended):
        slope = way.slope_deg[np.searchsorted(way.distance_m, end_m, "right") - 1]
        return f"{until}{ended[0]:.1f} h: the wheels do not hold the slope of {slope:.1f} deg ahead"
    return f"still at {distance[-1]:.0f} m of {goal:.0f} m after {time[-1]:.1f} h"
