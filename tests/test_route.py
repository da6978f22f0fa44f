"""What a metre costs, the cheapest way over a map, rocks in it, and the march along it."""

import csv
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad

import rdk
from rdk import route, sky, terrain
from rdk.route import Way
from rdk.terrain import Terrain

SHARED = Path(__file__).parents[2] / "shared" / "facts" / "terrain"
real_maps = pytest.mark.skipif(not SHARED.exists(), reason="needs NASA's height maps in a folder beside the checkout")
ROVER, POLAR = rdk.rover("MoonRanger"), replace(rdk.scenario("polar_prospecting"), maximum_speed_m_s=0.05)
GROUND = terrain.synthetic(2, cells=48)
FREE = dict(tilt_limit_deg=90, edge_limit_deg=90)


def climbing(slope):
    """The cost of the given cases: ten joules a metre, and more uphill."""
    return 10 + 0.3 * np.maximum(slope, 0) ** 2


# ---- what a metre costs ------------------------------------------------------------------------------------

def test_a_metre_on_level_ground_by_hand():
    wheel, second = route.per_metre(ROVER, POLAR, 0.0)
    level = rdk.evaluate(ROVER, replace(POLAR, slope_deg=0.0))
    rolling = ROVER.wheel_radius_m * (1 - level.slip)
    np.testing.assert_allclose(wheel, ROVER.wheel_count * level.wheel_torque_nm / rolling / 0.8, rtol=1e-12)
    assert second == 1 / 0.05
    assert route.per_metre(ROVER, replace(POLAR, maximum_speed_m_s=np.inf), 0.0)[1] == 1 / (5 * rolling)    # the hub's


@given(st.floats(1, 20))
@settings(max_examples=20)
def test_a_climb_costs_at_least_its_height_and_a_descent_less(slope):
    (up, down), _ = route.per_metre(ROVER, POLAR, np.array([slope, -slope]))
    weight = rdk.evaluate(ROVER, POLAR).total_mass_kg * rdk.Model().gravity_m_s2
    assert up > weight * np.sin(np.radians(slope)) / 0.8 and 0 <= down < up


def test_where_the_rover_stalls_a_metre_costs_everything():
    wheel, second = route.per_metre(ROVER, POLAR, np.array([10.0, 34.0]))
    assert np.isfinite([wheel[0], second[0]]).all() and np.isinf([wheel[1], second[1]]).all()
    joule = route.cost(ROVER, POLAR)
    assert np.isinf(joule(34.0)) and np.isinf(joule(60.0)) and np.isinf(joule(-60.0))
    standing = ROVER.avionics_power_w + POLAR.payload_power_w
    np.testing.assert_allclose(joule(10.0), wheel[0] + standing * second[0], rtol=1e-12)
    with pytest.raises(ValueError, match="design must be a single one"):
        route.cost(rdk.random_designs(2, seed=1), POLAR)


def test_costs_broadcast():
    designs, slopes = rdk.random_designs(3, seed=1), np.array([[-5.0], [12.0]])
    wheel, second = route.per_metre(designs, POLAR, slopes)
    assert wheel.shape == second.shape == (2, 3)
    np.testing.assert_allclose([wheel[1, 2], second[1, 2]], route.per_metre(designs[2], POLAR, 12.0), rtol=1e-9)


# ---- rocks -------------------------------------------------------------------------------------------------

@pytest.mark.parametrize("diameter, k", [(0.1, 0.005), (0.2, 0.1), (0.5, 0.02)])
def test_rocks_are_counted_by_the_integral_of_their_area(diameter, k):
    q = 1.79 + 0.152 / k
    count = quad(lambda x: 4 * k * q * np.exp(-q * x) / (np.pi * x * x), diameter, np.inf, epsabs=0)[0]
    np.testing.assert_allclose(route.rocks_per_m2(diameter, k), count, rtol=1e-7)


def test_rocks_and_detours_in_their_limits():
    assert route.rocks_per_m2(0.1, 0.0) == 0 and route.detour_factor(0.05, 0.5, 0.0) == 1
    counts = route.rocks_per_m2(np.array([[0.1], [0.2]]), np.array([0.005, 0.02, 0.1]))
    assert counts.shape == (2, 3) and np.all(np.diff(counts, axis=1) > 0) and np.all(counts[1] < counts[0])
    four, six = (route.detour_factor(ratio * 0.1, 0.5, 0.02) for ratio in (0.5, 1.25))
    assert four > six > 1                                # six wheels climb taller rocks
    rocks = route.rocks_per_m2(0.1, 0.02)                # a swath of 0.5 m and the rock's 0.1, each costing as much
    np.testing.assert_allclose(four, 1 + rocks * 0.6 * 0.6, rtol=1e-12)


# ---- the cheapest way --------------------------------------------------------------------------------------

def level(shape=(6, 8)):
    return Terrain(np.zeros(shape), 10.0)


def test_the_cheapest_way_on_level_ground_is_the_shortest():
    way = route.cheapest(level(), lambda slope: 2.0 + 0 * slope, (1, 0), (3, 7), **FREE)
    length = 5 * 10 + 2 * 10 * np.sqrt(2)
    np.testing.assert_allclose([way.length_m, way.energy_j], [length, 2 * length], rtol=1e-12)
    assert way.cells[0].tolist() == [1, 0] and way.cells[-1].tolist() == [3, 7] and way.message == ""
    assert np.abs(np.diff(way.cells, axis=0)).max() == 1
    nothing = route.cheapest(level(), lambda slope: 2.0 + 0 * slope, (1, 0), (1, 0), **FREE)
    assert (nothing.energy_j, nothing.length_m, len(nothing.cells)) == (0, 0, 1)


def relaxed(ground, start, tilt, edge):
    """Least energy to every cell by relaxing all edges until nothing changes: slow, plain, and another way."""
    rows, columns = ground.height_m.shape
    safe, best = ground.slope() <= tilt, np.full((rows, columns), np.inf)
    best[start] = 0
    while True:
        new = best.copy()
        for i in range(rows):
            for k in range(columns):
                for a in range(max(i - 1, 0), min(i + 2, rows)):
                    for b in range(max(k - 1, 0), min(k + 2, columns)):
                        run = ground.step_m * np.hypot(a - i, b - k)
                        if run and safe[i, k] and safe[a, b]:
                            rise = ground.height_m[i, k] - ground.height_m[a, b]
                            slope = np.degrees(np.arctan(rise / run))
                            if abs(slope) <= edge:
                                new[i, k] = min(new[i, k], new[a, b] + climbing(slope) * np.hypot(run, rise))
        if np.array_equal(new, best):
            return best
        best = new


def test_against_a_plain_relaxation():
    ground = Terrain(GROUND.height_m[:12, :12], 10.0)
    tilt = float(np.quantile(ground.slope(), 0.8))
    start = tuple(int(i) for i in np.argwhere(ground.slope() <= tilt)[0])
    expected = relaxed(ground, start, tilt, 15.0)
    way = route.cheapest(ground, climbing, start, start, tilt_limit_deg=tilt, edge_limit_deg=15.0)
    np.testing.assert_allclose(way.reach_j, expected, rtol=1e-9)
    assert 20 < np.isfinite(expected).sum() < 144        # some cells are shut


def test_uphill_and_downhill_cost_differ():
    height = np.outer(np.ones(5), np.arange(9.0))
    up = route.cheapest(Terrain(height, 10.0), climbing, (2, 0), (2, 8), **FREE)
    down = route.cheapest(Terrain(height, 10.0), climbing, (2, 8), (2, 0), **FREE)
    slope = np.degrees(np.arctan(0.1))
    np.testing.assert_allclose(up.energy_j, 8 * np.hypot(10, 1) * (10 + 0.3 * slope**2), rtol=1e-12)
    np.testing.assert_allclose(down.energy_j, 8 * np.hypot(10, 1) * 10, rtol=1e-12)
    np.testing.assert_allclose(up.length_m, down.length_m, rtol=1e-12)


@given(st.integers(0, 47), st.integers(0, 47), st.integers(0, 47), st.integers(0, 47))
@settings(max_examples=15)
def test_no_way_is_cheaper_than_the_cheapest(a, b, c, d):
    way = route.cheapest(GROUND, climbing, (a, b), (c, d), **FREE)
    legs = route.along(GROUND, way.cells)
    np.testing.assert_allclose((climbing(legs.slope_deg) * legs.ground_m).sum(), way.energy_j, rtol=1e-9, atol=1e-9)
    turn = (int((a + c) / 2), int((b + d) / 2))          # by way of the middle is never cheaper
    onward = route.cheapest(GROUND, climbing, turn, (c, d), **FREE)
    assert way.energy_j <= (way.reach_j[turn] + onward.energy_j) * (1 + 1e-9)
    assert way.energy_j >= 10 * 10 * max(abs(a - c), abs(b - d)) * (1 - 1e-12)


def test_detours_lengthen():
    plain = route.cheapest(GROUND, climbing, (3, 3), (40, 30), **FREE)
    longer = route.cheapest(GROUND, climbing, (3, 3), (40, 30), detour=1.5, **FREE)
    np.testing.assert_allclose(longer.energy_j, 1.5 * plain.energy_j, rtol=1e-9)
    rocky = np.ones((48, 48))
    rocky[10:38, :40] = 5.0
    around = route.cheapest(GROUND, climbing, (3, 3), (40, 3), detour=rocky, **FREE)
    assert plain.energy_j < np.inf and (around.cells[:, 1] >= 38).any()          # it takes the open side


def test_a_map_without_a_way_says_so():
    height = np.zeros((7, 9))
    height[:, 4] = 50.0                                  # a wall from top to bottom
    wall = Terrain(height, 10.0)
    way = route.cheapest(wall, climbing, (3, 0), (3, 8), tilt_limit_deg=20, edge_limit_deg=30)
    assert way.energy_j == way.length_m == np.inf and way.cells.shape == (0, 2)
    assert "no way within 20 deg of tilt" in way.message and "33.3% of the map can be reached" in way.message
    assert np.isfinite(way.reach_j).sum() == 7 * 3
    steep = route.cheapest(wall, climbing, (3, 3), (3, 8), tilt_limit_deg=20, edge_limit_deg=30)
    assert "the start (3, 3) tilts 68.2 deg" in steep.message
    stalls = route.cheapest(level(), lambda slope: slope + np.inf, (0, 0), (5, 5), **FREE)
    assert stalls.energy_j == np.inf and stalls.message
    hole = np.zeros((7, 9))
    hole[:, 4] = np.nan
    assert route.cheapest(Terrain(hole, 10.0), climbing, (3, 0), (3, 8), **FREE).energy_j == np.inf


@pytest.mark.parametrize("change, words", [
    (dict(start=(6, 0)), "start must be a cell .* of the 6 x 8 map"), (dict(goal=(0, -1)), "goal must be a cell"),
    (dict(start=(0.5, 0)), "start must be a cell"), (dict(goal=3), "goal must be a cell"),
    (dict(start=((1, 2), 3)), "start must be a cell"),
    (dict(detour=np.ones((2, 2))), r"detour must .* have the map's shape \(6, 8\)"),
    (dict(tilt_limit_deg=-1), "tilt_limit_deg"), (dict(edge_limit_deg="steep"), "edge_limit_deg"),
    (dict(detour=0.5), "detour must be at least 1"), (dict(joule_per_m=lambda s: s - 1), "must not be negative"),
    (dict(joule_per_m=3.0), "joule_per_m must be a function, such as rdk.route.cost"), (dict(start=None), "start must"),
    (dict(terrain=np.zeros((6, 8))), "terrain must be a Terrain; got ndarray")])
def test_bad_requests_are_refused(change, words):
    request = dict(terrain=level(), joule_per_m=climbing, start=(0, 0), goal=(5, 7), **FREE) | change
    with pytest.raises((ValueError, TypeError), match=words):
        route.cheapest(**request)


@pytest.mark.parametrize("call, words", [
    (lambda: route.per_metre("x", POLAR, 0.0), "design must be a Design"),
    (lambda: route.per_metre(ROVER, POLAR, "steep"), "slope_deg must be .*'steep'"),
    (lambda: route.cost(ROVER, "polar"), "scenario must be a Scenario"),
    (lambda: route.rocks_per_m2(0.0, 0.1), "diameter_m must be positive"),
    (lambda: route.rocks_per_m2(0.1, 1.5), "area_fraction must be at least 0 and at most 1"),
    (lambda: route.detour_factor("x", 0.5, 0.1), "obstacle_m must be positive"),
    (lambda: route.detour_factor(0.1, np.nan, 0.1), "width_m must be positive"),
    (lambda: route.along("x", [[0, 0]]), "terrain must be a Terrain"),
    (lambda: route.along(level(), []), "cells must be rows"),
    (lambda: route.along(level(), [[0, 0], [6, 0]]), "cells must be rows and columns of the map"),
    (lambda: route.along(level(), [[0, 0], [1, 1]], skyline_every_m=0), "skyline_every_m must be positive"),
    (lambda: Way([0.0, 1.0], [0.0, 0.0], [0.0, 0.0], [0.0, 0.0]), "one slope_deg fewer"),
    (lambda: Way([1.0, 0.0], [0.0], [0.0, 0.0], [0.0, 0.0]), "rising distance_m"),
    (lambda: Way([0.0, 1.0], [0.0], [0.0, 0.0], [0.0, 0.0], [0.0]), "as many skylines as skyline_m"),
    (lambda: Way([0.0, 1.0], [0.0], [0.0, 0.0], [0.0, 0.0], [0.0], ["x"]), r"skylines\[0\] must be a Skyline"),
    (lambda: Way([0.0, np.nan], [0.0], [0.0, 0.0], [0.0, 0.0]), "distance_m must be finite; got nan")])
def test_what_is_no_record_number_or_way_is_refused_by_name(call, words):
    with pytest.raises((ValueError, TypeError), match=words):
        call()


@real_maps
def test_routes_on_the_real_ridge():
    ridge = terrain.read(SHARED / "connecting_ridge_10m.png")
    with open(SHARED / "terrain_targets.csv", encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(file) if row["kind"] == "route on connecting_ridge_10m"]
    for row in rows:
        cells = [int(word.strip("(),")) for word in row["name"].split() if word.strip("(),").isdigit()]
        way = route.cheapest(ridge, climbing, cells[:2], cells[2:], tilt_limit_deg=20, edge_limit_deg=30)
        ours = dict(least_energy=way.energy_j, length=way.length_m / 1000)[row["quantity"]]
        np.testing.assert_allclose(ours, float(row["value"]), atol=float(row["tolerance"]))
    assert len(rows) >= 4


@real_maps
def test_the_tabulated_way_is_the_real_ridges():
    ridge, *wide = (terrain.read(SHARED / f"{name}.png") for name in ("connecting_ridge_10m", "connecting_ridge_20m",
                                                                      "south_pole_240m", "south_pole_480m"))
    way = route.ridge()
    for at, seen in list(zip(way.skyline_m, way.skylines))[::6]:
        point = np.argmin(abs(way.distance_m - at))
        x, y = ridge.to_xy(way.latitude_deg[point], way.longitude_deg[point])
        ours = ridge.skyline(float(x), float(y), 1.0, beyond=wide)
        # places are printed to a metre: near the ground the skyline of a slope of 10 deg moves by tenths of a degree
        assert np.abs(ours.at(seen.azimuth_deg) - seen.elevation_deg).mean() < 0.1


# ---- the march ---------------------------------------------------------------------------------------------

SUNNY = replace(POLAR, start_utc="2026-12-01", duration_earth_days=10)


def straight(length_m=500.0, slope_deg=0.0, legs=50, skylines=()):
    here = rdk.skyline("connecting_ridge_spot_1")
    return Way(np.linspace(0, length_m, legs + 1), np.full(legs, slope_deg), np.full(legs + 1, here.latitude_deg),
               np.full(legs + 1, here.longitude_deg), tuple(np.linspace(0, length_m, len(skylines))), tuple(skylines))


def hours(march, mode):
    """Hours that a march spends in a mode."""
    return (march.mode == route.MODES.index(mode)).sum() * march.time_h[0]


def books(march, design, model=rdk.Model()):
    """Sunlight, load, and what the battery took, over the march, in Wh; none may be discarded."""
    change = np.diff(march.stored_wh, axis=0, prepend=design.battery_capacity_wh)
    taken = np.where(change > 0, change / model.charge_efficiency, change * model.discharge_efficiency)
    return march.solar_w * march.time_h[0], march.load_w * march.time_h[0], taken


def test_a_march_in_the_sun_by_hand():
    march = route.march(straight(), ROVER, SUNNY, follow_sun=True)
    hours = 500 / 0.05 / 3600                            # 2.78 h: arrives within the twelfth quarter of an hour
    assert march.arrival_h == 3.0 > hours > 2.75 and march.message == "arrives after 3.0 h"
    wheel, _ = route.per_metre(ROVER, SUNNY, 0.0)
    spent = ((march.load_w - ROVER.avionics_power_w) * 0.25).sum() * 3600
    np.testing.assert_allclose(spent, wheel * 500, rtol=1e-9)
    assert np.all(march.mode == route.DRIVE) and march.stranded_m == np.inf
    np.testing.assert_allclose(march.distance_m[:4], np.arange(1, 5) * 45.0, rtol=1e-9)


@pytest.mark.parametrize("start", ["2026-06-01", "2026-10-05", "2026-12-01"])
def test_energy_is_accounted_for(start):
    design = replace(ROVER, battery_capacity_wh=200.0)
    march = route.march(route.ridge(), design, replace(SUNNY, start_utc=start))
    solar, load, taken = books(march, design)
    full, empty = march.stored_wh >= 200 - 1e-9, march.stored_wh <= 30 + 1e-9
    between = ~full & ~empty
    np.testing.assert_allclose((solar - load)[between], taken[between], atol=1e-9)
    assert np.all((solar - load)[full] >= taken[full] - 1e-9) and np.all(march.stored_wh >= 30)
    assert between.sum() > 10


def test_in_the_dark_the_pack_lasts_as_long_as_its_energy():
    wall = sky.Skyline([0, 90, 180, 270], [30.0] * 4)
    march = route.march(straight(skylines=(wall, wall), length_m=5000), ROVER, SUNNY)
    assert march.solar_w.max() == 0 and march.arrival_h == np.inf and "pack empty" in march.message
    # quarters of an hour from full to half a charge, then asleep, at 2 W, to the floor
    step_wh = march.load_w[0] * 0.25 / 0.95
    driven = int(np.ceil(0.5 * ROVER.battery_capacity_wh / step_wh))
    left_wh = 0.85 * ROVER.battery_capacity_wh - driven * step_wh
    np.testing.assert_allclose(march.time_h[-1], 0.25 * driven + left_wh * 0.95 / 2.0, atol=0.25)
    assert march.stranded_m == march.distance_m[-1] < 5000


def test_a_slope_that_the_wheels_do_not_hold_strands():
    way = replace(straight(legs=50), slope_deg=[0.0] * 30 + [34.0] * 20)
    march = route.march(way, ROVER, SUNNY, follow_sun=True)
    assert march.stranded_m == 300.0 and march.message.startswith("stranded at 300 m")
    assert "do not hold the slope of 34.0 deg" in march.message and hours(march, "stalled") == 0.25
    both = route.march(way, ROVER, replace(SUNNY, maximum_speed_m_s=[0.05, 0.01]), follow_sun=True)
    assert both.message[0] == march.message              # however long the other takes


def test_science_takes_its_time_and_power():
    plain = route.march(straight(), ROVER, SUNNY, follow_sun=True)
    busy = route.march(straight(), ROVER, SUNNY, follow_sun=True, science_every_m=100.0, science_h=1.5)
    assert hours(busy, "science") == 4 * 1.5 and hours(plain, "science") == 0      # the fifth stop is the goal
    working = busy.mode == route.MODES.index("science")
    np.testing.assert_allclose(busy.load_w[working], ROVER.avionics_power_w + SUNNY.payload_power_w, rtol=1e-12)
    assert busy.arrival_h > plain.arrival_h + 6 - 1e-9


def test_rocks_and_speed_set_the_time():
    slow = route.march(straight(), ROVER, SUNNY, follow_sun=True, detour=1.5, step_h=0.05)
    np.testing.assert_allclose(slow.arrival_h, 1.5 * 500 / 0.05 / 3600, atol=0.05)
    tired = route.march(straight(5000.0), replace(ROVER, solar_area_m2=0.1), SUNNY)
    assert hours(tired, "charge") + hours(tired, "sleep") > 0


def test_lanes_march_as_they_do_alone():
    designs = rdk.random_designs(5, seed=4)
    delays = np.arange(5) * 300.0
    scenario = replace(SUNNY, duration_earth_days=4)
    many = route.march(route.ridge(), designs, scenario, delay_h=delays)
    for i in range(5):
        one = route.march(route.ridge(), designs[i], scenario, delay_h=delays[i])
        assert one.message == many.message[i] and one.arrival_h == many.arrival_h[i]
        shared = min(len(one.time_h), len(many.time_h))
        np.testing.assert_allclose(many.distance_m[:shared, i], one.distance_m[:shared], rtol=1e-9)
        np.testing.assert_allclose(many.stored_wh[:shared, i], one.stored_wh[:shared], rtol=1e-9)
    assert many.distance_m.shape == many.mode.shape == (len(many.time_h), 5) and len(set(many.message)) > 1


def test_the_step_of_time_does_not_decide():
    coarse, fine = (route.march(route.ridge(), ROVER, SUNNY, follow_sun=True, step_h=step) for step in (0.25, 0.05))
    np.testing.assert_allclose(coarse.arrival_h, fine.arrival_h, atol=0.25)
    np.testing.assert_allclose(coarse.stored_wh[-1], fine.stored_wh[-1], atol=4.0)       # a quarter of an hour at 16 W


def test_summer_and_winter_on_the_ridge():
    summer, winter = (route.march(route.ridge(), ROVER, replace(SUNNY, start_utc=start), follow_sun=True)
                      for start in ("2026-12-01", "2026-06-01"))
    assert np.isfinite(summer.arrival_h) and winter.stranded_m < 1000 and "pack empty" in winter.message


@pytest.mark.parametrize("change, words", [
    (dict(scenario=replace(SUNNY, start_utc=None)), "start_utc"), (dict(rest_soc=0.95), "rest_soc must be"),
    (dict(rest_soc=0.1), "rest_soc must be at least 0.15"), (dict(go_soc=1.5), "go_soc"), (dict(detour=0.9), "detour"),
    (dict(science_every_m=0), "science_every_m"), (dict(science_h=-1), "science_h"),
    (dict(delay_h=np.zeros((2, 2))), "one row of lanes"), (dict(delay_h="soon"), "delay_h must be"),
    (dict(way=route.along(level(), np.empty((0, 2), int))), "a way of two points"),
    (dict(delay_h=[]), "one row of lanes; got shape"), (dict(step_h=0), "step_h"),
    (dict(science_h=[1.0, 2.0]), "science_h must be one number"), (dict(way="x"), "way must be a Way; got 'x'")])
def test_bad_marches_are_refused(change, words):
    with pytest.raises((ValueError, TypeError), match=words):
        route.march(**dict(way=straight(), design=ROVER, scenario=SUNNY) | change)


def test_a_way_looks_around():
    cells = route.cheapest(GROUND, climbing, (3, 3), (40, 30), **FREE).cells
    way = route.along(GROUND, cells, skyline_every_m=150.0)
    assert way.skyline_m[0] == 0 and way.skyline_m[-1] == way.distance_m[-1] and np.all(np.diff(way.skyline_m) > 0)
    x, y = GROUND.place(3, 3)
    assert way.skylines[0] == GROUND.skyline(float(x), float(y), 1.0)
    np.testing.assert_allclose(np.tan(np.radians(way.slope_deg)) @ np.diff(way.distance_m),
                               GROUND.height_m[40, 30] - GROUND.height_m[3, 3], rtol=1e-9)
    assert route.along(GROUND, cells).skylines == ()
