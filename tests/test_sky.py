"""The sun over the Moon at a date, skylines, and published light."""

import csv
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import rdk
from rdk import catalog, explain, power, sky
from rdk.sky import Skyline

DATA = Path(__file__).parents[1] / "data"
HOURS = sky.julian_date(np.arange("2015-12-24", "2034-12-24", dtype="datetime64[h]"))
DECLINATION, NOON = sky.subsolar_point(HOURS)
LIGHT = {}                                               # site and height -> light of 19 years, computed once


def table(name):
    return list(csv.DictReader((DATA / name).open(encoding="utf-8")))


def column(name, key):
    return np.array([float(row[key]) for row in table(name)])


def apart(a, b):
    """Difference of two directions in degrees."""
    return (np.asarray(a) - b + 180) % 360 - 180


def light(site, height_m):
    """Share of the disc in each hour of 19 years."""
    if (site, height_m) not in LIGHT:
        seen = rdk.skyline(site, height_m)
        sun = power.sun_position(seen.latitude_deg, seen.longitude_deg - NOON, DECLINATION)
        LIGHT[site, height_m] = sky.lit_fraction(*sun, seen)
    return LIGHT[site, height_m]


def figures(lit):
    return dict(lit_pct=100 * lit.mean(), dark_pct=100 * (lit <= 0).mean(),
                longest_dark_days=sky.longest_run(lit <= 0) / 24, longest_light_days=sky.longest_run(lit > 0) / 24)


# ---- the sun -----------------------------------------------------------------------------------------------

def test_subsolar_point_against_the_ephemeris():
    latitude, longitude = sky.subsolar_point(column("subsolar_points.csv", "julian_date"))
    # the docstring's claim, seven times tighter in longitude than what a skyline in steps of 1 deg needs
    np.testing.assert_allclose(latitude, column("subsolar_points.csv", "latitude_deg"), atol=0.01)
    np.testing.assert_allclose(apart(longitude, column("subsolar_points.csv", "longitude_deg")), 0, atol=0.06)


def test_sun_position_against_horizons():
    rows = table("sun_horizons_2024.csv")
    elevation, azimuth = sky.sun_position(-87.2, 62.8, sky.julian_date(np.array([row["utc"] for row in rows],
                                                                                "datetime64[m]")))
    # parallax of the place and light time are not modelled: 0.005 deg
    np.testing.assert_allclose(elevation, [float(row["elevation_deg"]) for row in rows], atol=0.02)
    np.testing.assert_allclose(apart(azimuth, [float(row["azimuth_deg"]) for row in rows]), 0, atol=0.06)


def test_the_sun_keeps_the_moons_calendar():
    latitude, longitude = sky.subsolar_point(HOURS)
    assert 1.5 < latitude.max() < 1.6 and -1.6 < latitude.min() < -1.5           # 1.54 deg of tilt, and libration
    turns = -np.unwrap(np.radians(longitude))[[0, -1]] @ [1, -1] / 2 / np.pi
    days = (HOURS[-1] - HOURS[0]) / abs(turns)
    np.testing.assert_allclose(24 * days, rdk.Model().synodic_day_h, rtol=1e-4)  # the mean over 19 years: 0.1 h
    north = np.flatnonzero(np.diff(np.sign(np.convolve(latitude, np.ones(720) / 720, "valid"))) > 0)
    # from one northern spring to the next, the draconic year: the node goes round once in 18.6 years
    np.testing.assert_allclose(np.diff(north).mean() / 24, 346.62, atol=0.5)


@given(st.floats(-90, 90), st.floats(-360, 360), st.floats(2440000, 2480000))
def test_the_real_sun_is_the_papers_sun_with_its_hour_angle_and_declination(latitude, longitude, date):
    declination, noon = sky.subsolar_point(date)
    elevation, azimuth = sky.sun_position(latitude, longitude, date)
    expected = power.sun_position(latitude, longitude - noon, declination)
    assert (elevation, azimuth) == expected and -90 <= elevation <= 90 and 0 <= azimuth <= 360
    # the angle between the place and the point under the sun is what the elevation lacks to 90 deg
    a, b, c = np.radians(latitude), np.radians(declination), np.radians(longitude - noon)
    np.testing.assert_allclose(np.sin(np.radians(elevation)), np.sin(a) * np.sin(b) + np.cos(a) * np.cos(b) * np.cos(c),
                               atol=1e-12)


def test_sun_broadcasts():
    dates, places = HOURS[:5], np.array([[-85.0], [0.0], [89.0]])
    elevation, azimuth = sky.sun_position(places, 10.0, dates)
    assert elevation.shape == azimuth.shape == (3, 5)
    for i in range(3):
        for k in range(5):
            assert sky.sun_position(places[i, 0], 10.0, dates[k]) == (elevation[i, k], azimuth[i, k])


def test_dates_are_terrestrial_time():
    assert sky.julian_date("2000-01-01T12:00") == 2451545 + 69.184 / 86400
    assert sky.julian_date("2026-07-01") == sky.julian_date("2026-07-01T00:00Z")
    days = sky.julian_date(np.arange("2026-01-01", "2026-01-04", dtype="datetime64[D]"))
    np.testing.assert_allclose(np.diff(days), 1, rtol=0, atol=1e-9)              # the last bit of a Julian date
    for wrong in ("yesterday", "2026-13-01", None, 5.0, np.datetime64("NaT"), [["2026-01-01"], 3]):
        with pytest.raises(ValueError, match="a date must"):
            sky.julian_date(wrong)


# ---- skylines ----------------------------------------------------------------------------------------------

def test_sites_and_heights():
    sites = rdk.skyline_sites()
    assert len(sites) == 16 and sites["shackleton_floor"]["heights_m"] == (1, 2, 10)
    for site, about in sites.items():
        seen = rdk.skyline(site)
        assert seen.height_m == 2
        assert (seen.latitude_deg, seen.longitude_deg) == (about["latitude_deg"], about["longitude_deg"])
        assert len(seen.azimuth_deg) == len(seen.elevation_deg) == 360
    with pytest.raises(ValueError, match="'shackleton_rimm'.*shackleton_rim"):
        rdk.skyline("shackleton_rimm")
    for height_m in (0, 5, 1.5, "2", None):
        with pytest.raises(ValueError, match="height_m .* one of 1, 2, 10; got"):
            rdk.skyline("shackleton_rim", height_m)


def test_a_skyline_is_a_value():
    one, other = rdk.skyline("shackleton_rim"), rdk.skyline("shackleton_rim")
    assert one == other and hash(one) == hash(other) and one is not other
    assert one != rdk.skyline("shackleton_rim", 10) and one != "a skyline"
    assert Skyline.of(one) is one and Skyline.of(one.elevation_deg) == one
    with pytest.raises(ValueError, match="read-only"):
        one.elevation_deg[0] = 5.0


@pytest.mark.parametrize("azimuth, elevation, words", [
    ([0], [0], "two values"), ([0, 90], [0], "of one length"), ([0, 90, 80], [0, 0, 0], "must rise"),
    ([0, 360], [0, 0], "within one turn"), ([0, 90], [0, 91], "at least -90 and at most 90 and finite; got 91"),
    ([0, 90], [0, np.nan], "got nan")])
def test_bad_skylines_are_refused(azimuth, elevation, words):
    with pytest.raises(ValueError, match=words):
        Skyline(azimuth, elevation)


@pytest.mark.parametrize("wrong", ["shackleton_rim", 0.0, [], [[1, 2], [3, 4]], {"a": 1}])
def test_what_is_no_skyline_is_refused(wrong):
    with pytest.raises(ValueError, match="skyline must be a Skyline"):
        sky.lit_fraction(1.0, 0.0, wrong)


@pytest.mark.parametrize("call, words", [
    (lambda: sky.subsolar_point("2026-01-01"), "julian_date must be finite; got '2026-01-01'"),
    (lambda: sky.subsolar_point([HOURS[0], np.nan]), "julian_date must be finite; got nan at index 1"),
    (lambda: sky.sun_position(95.0, 0.0, HOURS[0]), "latitude_deg must be at least -90"),
    (lambda: sky.sun_position(-85.0, None, HOURS[0]), "longitude_deg must be"),
    (lambda: sky.lit_fraction("high", 0.0), "elevation_deg must be numbers; got 'high'"),
    (lambda: sky.lit_fraction(1.0, {}, [1.0, 2.0]), "azimuth_deg must be numbers"),
    (lambda: sky.longest_run([[True, False]]), "flags must have one dimension")])
def test_what_is_no_number_is_refused_by_name(call, words):
    with pytest.raises(ValueError, match=words):
        call()


def test_a_skyline_closes_at_north():
    seen = Skyline([10, 100, 190, 280], [1.0, 2.0, 3.0, 4.0])
    np.testing.assert_allclose(seen.at([10, 55, 325, 370, -35]), [1, 1.5, 2.5, 1, 2.5], rtol=1e-12)


# ---- light -------------------------------------------------------------------------------------------------

def test_share_of_the_disc():
    r = sky.SUN_RADIUS_DEG
    edges = sky.lit_fraction(np.array([-1.01, -1, 0, 1, 1.01]) * r, 0.0)
    np.testing.assert_allclose(edges, [0, 0, 0.5, 1, 1], atol=1e-15)
    # the area of a circular segment, summed strip by strip
    x = np.linspace(-1, 0.3, 200_001)
    area = np.trapezoid(2 * np.sqrt(1 - x**2), x) / np.pi
    np.testing.assert_allclose(sky.lit_fraction(2 + 0.3 * r, 77.0, np.full(360, 2.0)), area, rtol=1e-6)


@given(st.floats(-5, 5), st.floats(0, 360), st.floats(-3, 3), st.floats(0, 2))
def test_light_grows_with_the_sun_and_shrinks_with_the_terrain(elevation, azimuth, level, rise):
    here, above = np.full(8, level), np.full(8, level + rise)
    lit = sky.lit_fraction(elevation, azimuth, here)
    assert 0 <= lit <= 1 and sky.lit_fraction(elevation, azimuth, above) <= lit
    # only the difference counts
    np.testing.assert_allclose(sky.lit_fraction(elevation + rise, azimuth, above), lit, atol=1e-6)


def test_light_broadcasts():
    elevation, azimuth = sky.sun_position(np.array([[-89.0], [-85.0]]), 0.0, HOURS[:7])
    lit = sky.lit_fraction(elevation, azimuth, rdk.skyline("shackleton_rim"))
    assert lit.shape == (2, 7)
    assert lit[1, 3] == sky.lit_fraction(elevation[1, 3], azimuth[1, 3], rdk.skyline("shackleton_rim"))


def test_no_light_on_the_floor_of_shackleton():
    assert light("shackleton_floor", 1).max() == light("shackleton_floor", 10).max() == 0


@pytest.mark.parametrize("site", rdk.skyline_sites())
def test_light_never_falls_with_height(site):
    # hour by hour: the table rounds to 0.01 deg, 2 % of the disc
    assert np.all(light(site, 2) >= light(site, 1) - 0.03)
    shares = [light(site, height).mean() for height in (1, 2, 10)]
    assert shares == sorted(shares)


@pytest.mark.parametrize("row", table("skyline_sites.csv"), ids=lambda row: f"{row['site']}_{row['height_m']}m")
def test_the_tables_light_comes_out_again(row):
    ours = figures(light(row["site"], float(row["height_m"])))
    # the table was computed from skylines in steps of 0.5 deg
    np.testing.assert_allclose(ours["lit_pct"], float(row["lit_pct"]), atol=0.05)
    np.testing.assert_allclose(ours["dark_pct"], float(row["dark_pct"]), atol=0.15)


@pytest.mark.parametrize("row", [row for row in table("published_light.csv") if float(row["height_m"]) in (1, 2, 10)],
                         ids=lambda row: f"{row['site']}_{row['quantity']}")
def test_published_light(row):
    ours = figures(light(row["site"], float(row["height_m"])))[row["quantity"]]
    np.testing.assert_allclose(ours, float(row["value"]), atol=float(row["tolerance"]))


def test_a_level_skyline_gives_the_papers_light():
    hour_angle = power.hour_angle_deg(np.arange(0, 708.734, 0.05))
    for latitude, change in ((-85.0, 0.001), (-89.45, 0.02)):
        panel = (80.0, 0.0)
        paper = power.incidence_factor(latitude, hour_angle, *panel).mean()
        elevation, azimuth = power.sun_position(latitude, hour_angle)
        lit = sky.lit_fraction(elevation, azimuth, np.zeros(360))
        # the cosine without the cut at the horizon; its disc sets gradually, half of it above when the centre is level
        facing = np.maximum(np.cos(np.radians(80)) * np.sin(np.radians(elevation))
                            + np.sin(np.radians(80)) * np.cos(np.radians(elevation)) * np.cos(np.radians(azimuth)), 0)
        np.testing.assert_allclose((lit * facing).mean(), paper, rtol=change)


def test_longest_run():
    assert sky.longest_run([True, True, False, True], 2.0) == 4.0 and sky.longest_run([False]) == 0
    assert sky.longest_run(np.ones(5)) == 5 and sky.longest_run([]) == 0


# ---- missions ----------------------------------------------------------------------------------------------

POLAR, ROVER = rdk.scenario("polar_prospecting"), rdk.rover("MoonRanger")


def at_site(site, height_m=2, **more):
    seen = rdk.skyline(site, height_m)
    return replace(POLAR, latitude_deg=seen.latitude_deg, longitude_deg=seen.longitude_deg, skyline=seen, **more)


def test_a_mission_marches_under_the_real_sun():
    mission = at_site("connecting_ridge_spot_1", start_utc="2026-06-01T06:00")
    log = rdk.evaluate(ROVER, mission).log
    dates = sky.julian_date("2026-06-01T06:00") + log.time_h / 24
    elevation, azimuth = sky.sun_position(mission.latitude_deg, mission.longitude_deg, dates)
    np.testing.assert_allclose(log.sun_elevation_deg, elevation, atol=1e-9)
    tilt, towards = np.radians([mission.panel_tilt_deg, mission.panel_azimuth_deg])
    e, a = np.radians([elevation, azimuth])
    facing = np.sin(e) * np.cos(tilt) + np.cos(e) * np.sin(tilt) * np.cos(a - towards)
    lit = sky.lit_fraction(elevation, azimuth, mission.skyline)
    expected_w = power.panel_power(ROVER.solar_area_m2, np.maximum(facing, 0) * lit)
    np.testing.assert_allclose(log.solar_w, expected_w, atol=1e-9)
    assert (log.solar_w[elevation < -0.5] > 0).any(), "a ridge sees the sun below the level horizon"
    change = np.diff(log.stored_wh, prepend=ROVER.battery_capacity_wh) / log.step_h
    np.testing.assert_allclose(log.solar_w + log.unserved_w, log.load_w + log.discarded_w + log.battery_loss_w + change,
                               atol=1e-6)


def test_a_season_without_a_skyline_keeps_the_level_cut():
    log = rdk.evaluate(ROVER, replace(POLAR, start_utc="2026-06-01")).log
    assert np.all(log.solar_w[log.sun_elevation_deg < 0] == 0) and log.solar_w.max() > 0


def test_a_skyline_without_a_date_shades_the_papers_sun():
    shaded = rdk.evaluate(ROVER, replace(POLAR, skyline=np.full(36, 3.0))).log
    plain = rdk.evaluate(ROVER, POLAR).log
    assert np.array_equal(shaded.sun_elevation_deg, plain.sun_elevation_deg)
    low = plain.sun_elevation_deg < 3 - sky.SUN_RADIUS_DEG
    assert np.all(shaded.solar_w[low] == 0) and plain.solar_w[low].any()
    high = plain.sun_elevation_deg > 3 + sky.SUN_RADIUS_DEG
    np.testing.assert_allclose(shaded.solar_w[high], plain.solar_w[high], rtol=1e-12)


@pytest.mark.parametrize("latitude, change", [(-85.0, 0.001), (-89.45, 0.02)])
def test_a_level_skyline_gives_a_mission_the_papers_energy(latitude, change):
    mission = replace(POLAR, latitude_deg=latitude)
    level = rdk.evaluate(ROVER, replace(mission, skyline=np.zeros(360)))
    paper = rdk.evaluate(ROVER, mission)
    np.testing.assert_allclose(level.average_solar_power_w, paper.average_solar_power_w, rtol=change)


def test_no_power_on_the_floor_of_shackleton():
    dark = rdk.evaluate(rdk.random_designs(20, seed=1), at_site("shackleton_floor", start_utc="2026-12-01"))
    assert np.all(dark.average_solar_power_w == 0) and np.all(dark.range_km == 0) and not dark.feasible.any()


def test_sites_broadcast():
    designs = rdk.random_designs(400, seed=2)            # more than one block of lanes
    mission = at_site("shackleton_rim", start_utc="2026-10-01")
    many = rdk.evaluate(designs, mission)
    for i in (0, 199, 399):
        one = rdk.evaluate(designs[i], mission)
        np.testing.assert_allclose([many.range_km[i], many.final_soc[i], many.energy_balance_pct[i]],
                                   [one.range_km, one.final_soc, one.energy_balance_pct], rtol=1e-9)
    longitudes = np.array([0.0, 90.0, 205.0])
    spread = rdk.evaluate(ROVER, replace(mission, longitude_deg=longitudes))
    for longitude, average in zip(longitudes, spread.average_solar_power_w):
        single = rdk.evaluate(ROVER, replace(mission, longitude_deg=longitude))
        np.testing.assert_allclose(average, single.average_solar_power_w, rtol=1e-12)
    assert spread.average_solar_power_w[0] != spread.average_solar_power_w[1]


def test_the_heat_of_a_mission_knows_no_site():
    here, paper = rdk.evaluate(ROVER, at_site("shackleton_floor", start_utc="2026-10-01")), rdk.evaluate(
        ROVER, replace(POLAR, latitude_deg=rdk.skyline("shackleton_floor").latitude_deg))
    assert (here.hot_temperature_c, here.cold_temperature_c) == (paper.hot_temperature_c, paper.cold_temperature_c)


def test_scenarios_take_dates_and_skylines():
    mission = replace(POLAR, start_utc="2026-06-01", skyline=rdk.skyline("shackleton_rim"))
    assert mission == replace(mission) and mission != replace(mission, skyline=None)
    assert replace(POLAR, skyline=list(np.zeros(12))).skyline == Skyline(np.arange(12) * 30, np.zeros(12))
    for wrong in ("tomorrow", 2026, np.datetime64("2026-01-01")):
        with pytest.raises(ValueError, match="start_utc must be an ISO date"):
            replace(POLAR, start_utc=wrong)
    with pytest.raises(ValueError, match="skyline must be a Skyline"):
        replace(POLAR, skyline="shackleton_rim")


def test_a_mission_at_a_site_can_be_kept_and_written_as_python():
    mission = at_site("shackleton_rim", start_utc="2026-10-01")
    assert catalog.from_json(catalog.to_json(ROVER, mission)) == (ROVER, mission)
    found = {}
    exec(explain.as_python(ROVER, mission, rdk.Model(), ""), found)
    assert found["mission"].replace(problem=mission.problem) == mission
