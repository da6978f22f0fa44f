"""Sun, panel and battery: against pvlib, the flown rovers' published power, symmetries and bookkeeping."""

import dataclasses

import numpy as np
import pvlib
import pytest
import scalar_transcription as scalar
from hypothesis import given, settings
from hypothesis import strategies as st

import rdk
from rdk import catalog, power

CONSTANTS = {row["name"]: float(row["value"]) for row in catalog.rows("constants.csv")}
TARGETS = {row["id"]: row["accept"] for row in catalog.rows("paper_targets.csv")}
FLOWN = {row["rover"]: row for row in catalog.rows("flown.csv")}
latitudes, hours, declinations = st.floats(-90, 90), st.floats(-180, 180), st.floats(-1.6, 1.6)
quick = settings(max_examples=200, deadline=None, derandomize=True)


def band(target):
    return tuple(map(float, TARGETS[target].split("..")))


# ---- the flown rovers --------------------------------------------------------------------------------------

def noon_power(rover, cell_efficiency=CONSTANTS["flown_cell_efficiency"], clean=1.0):
    """Peak power of a flat panel at the landing latitude, with the flown-rover stack of efficiencies."""
    stack = cell_efficiency * np.prod([CONSTANTS[f"flown_{name}"] for name in
                                       ("packing_factor", "electrical_efficiency", "temperature_derate")])
    row = FLOWN[rover]
    incidence = power.incidence_factor(float(row["landing_latitude_deg"]), 0.0, tilt_deg=0.0)
    return power.panel_power(float(row["panel_area_m2"]), incidence, efficiency=stack, dust_factor=clean)


def test_pragyans_peak_power():
    clean = CONSTANTS["flown_clean_array_factor"]        # part of the published figure of Pragyan only
    low, high = band("solar_pragyan_w")
    assert low <= noon_power("Pragyan", clean=clean) <= high
    low, high = band("solar_pragyan_band_w")
    for name in "flown_cell_efficiency_low", "flown_cell_efficiency_high":
        assert low <= noon_power("Pragyan", CONSTANTS[name], clean) <= high
    low, high = (float(FLOWN["Pragyan"][f"peak_solar_{end}_w"]) for end in ("low", "high"))
    assert low < noon_power("Pragyan", clean=clean) < high                          # the published band


def test_yutu_2s_peak_power_and_the_derate_it_implies():
    low, high = band("solar_yutu2_w")
    assert low <= noon_power("Yutu-2") <= high
    low, high = band("derate_yutu2")
    assert low <= float(FLOWN["Yutu-2"]["peak_solar_w"]) / noon_power("Yutu-2") <= high


def test_evaluate_sees_the_same_noon():
    design = dataclasses.replace(rdk.rover("Pragyan"), solar_area_m2=0.5)
    scenario = dataclasses.replace(rdk.scenario("chandrayaan3_pragyan"), panel_tilt_deg=0.0,
                                   duration_earth_days=29.0)
    log = rdk.evaluate(design, scenario,
                       model=rdk.Model(panel_efficiency=0.3, dust_factor=0.9 * 0.92 * 0.9 * 0.98)).log
    # the hourly samples miss noon by up to half an hour: 0.25 deg of hour angle, 1e-5 of the power
    assert log.solar_w.max() == pytest.approx(noon_power("Pragyan", clean=0.98), rel=1e-5)


# ---- the sun -----------------------------------------------------------------------------------------------

@quick
@given(latitudes, st.floats(0, 180), declinations)
def test_the_suns_path_is_symmetric_about_noon(latitude, hour, declination):
    (morning, evening), azimuth = power.sun_position(latitude, np.array([-hour, hour]), declination)
    assert morning == pytest.approx(evening, abs=1e-9)
    if abs(morning) < 89.9:                              # near the zenith the azimuth means nothing
        assert np.cos(np.radians(azimuth.sum())) == pytest.approx(1, abs=1e-6)      # mirrored at the meridian


@quick
@given(latitudes, hours, declinations)
def test_the_suns_path_is_mirrored_between_hemispheres(latitude, hour, declination):
    north, north_azimuth = power.sun_position(latitude, hour, declination)
    south, south_azimuth = power.sun_position(-latitude, hour, -declination)
    assert north == pytest.approx(south, abs=1e-9)       # arcsin loses half the digits near 90 deg
    if abs(north) < 89.9:
        turned = np.radians(north_azimuth + south_azimuth - 180)
        assert np.cos(turned) == pytest.approx(1, abs=1e-9)


@quick
@given(latitudes, hours, declinations, st.floats(0, 90), st.floats(0, 360))
def test_incidence_agrees_with_pvlib(latitude, hour, declination, tilt, azimuth):
    elevation, sun_azimuth = power.sun_position(latitude, hour, declination)
    expected = max(pvlib.irradiance.aoi_projection(tilt, azimuth, 90 - elevation, sun_azimuth), 0.0)
    found = power.incidence_factor(latitude, hour, tilt, azimuth, declination)
    if elevation > 1e-9:
        assert found == pytest.approx(expected, abs=1e-7)  # elevation through arcsin: 1e-8 near the zenith
    elif elevation < -1e-9:
        assert found == 0


def test_the_sun_by_hand():
    elevation, azimuth = power.sun_position(np.array([0.0, 20.0, -20.0, 90.0]), 0.0)
    np.testing.assert_allclose(elevation, [90, 70, 70, 0], atol=1e-6)    # arcsin near its end
    np.testing.assert_allclose(azimuth[1:3], [180, 0], atol=1e-9)        # noon sun in the south, in the north
    elevation, azimuth = power.sun_position(0.0, np.array([-90.0, -45.0, 45.0, 90.0]))
    np.testing.assert_allclose(elevation, [0, 45, 45, 0], atol=1e-9)     # rises in the east, sets in the west
    np.testing.assert_allclose(azimuth, [90, 90, 270, 270], atol=1e-9)
    # at the pole it circles at its declination
    assert power.sun_position(90.0, 30.0, 1.5)[0] == pytest.approx(1.5)
    month = 708.734136
    np.testing.assert_allclose(power.hour_angle_deg(np.array([0, 0.25, 0.5, 1]) * month), [-90, 0, 90, 270],
                               rtol=1e-15)


def test_panel_facing_the_sun_takes_all_of_it():
    for latitude, azimuth in (20.0, 180.0), (-85.0, 0.0):
        assert power.incidence_factor(latitude, 0.0, abs(latitude), azimuth) == pytest.approx(1, abs=1e-15)
        assert power.incidence_factor(latitude, 0.0, 90 - 1e-9, azimuth + 180) == 0     # from behind
    # horizon and night
    assert power.incidence_factor(0.0, np.array([-90.0, 90.0, 180.0])).tolist() == [0, 0, 0]


@pytest.mark.parametrize("sign", [-1, 1])
def test_a_pole_is_lit_as_the_ground_beside_it(sign):
    """There the sun circles on the horizon; a limit that is not reached would be a jump."""
    hours = np.linspace(-180, 180, 97)
    for tilt in 0.0, 60.0, 80.0:
        at, beside = (power.incidence_factor(sign * latitude, hours, tilt, 90.0 * (1 + sign))
                      for latitude in (90.0, 90 - 1e-7))
        np.testing.assert_allclose(at, beside, atol=1e-8)           # 1e-7 degrees move the sun by 2e-9 rad
    assert at.max() == pytest.approx(np.sin(np.radians(80)), rel=1e-12)
    assert (at == 0).mean() == pytest.approx(0.5, abs=0.02)
    mission = rdk.scenario("polar_prospecting").replace(panel_tilt_deg=80.0, panel_azimuth_deg=90.0 * (1 + sign))
    both = mission.replace(latitude_deg=sign * np.array([90.0, 90 - 1e-5]))
    ranges = rdk.evaluate(rdk.rover("Rashid-1"), both).range_km
    assert ranges[0] == pytest.approx(ranges[1], rel=1e-5) and ranges[0] > 10


@quick
@given(st.floats(0.01, 3), latitudes, hours, st.floats(0, 180), st.floats(-360, 360), st.floats(0, 1),
       st.floats(0, 1))
def test_panel_power_is_no_more_than_falls_on_it(area, latitude, hour, tilt, azimuth, efficiency, dust):
    incidence = power.incidence_factor(latitude, hour, tilt, azimuth)
    found = power.panel_power(area, incidence, efficiency=efficiency, dust_factor=dust)
    assert 0 <= found <= 1361.0 * area * efficiency * dust * (1 + 1e-12)            # rounding of cos(i) = 1


def test_panel_power_agrees_with_the_transcription():
    time_h = np.linspace(0, 720, 200)
    for name in rdk.scenario_names():
        scenario = rdk.scenario(name)
        incidence = power.incidence_factor(scenario.latitude_deg, power.hour_angle_deg(time_h),
                                           scenario.panel_tilt_deg, scenario.panel_azimuth_deg)
        expected = [scalar.panel_power_w(t, {"solar_area_m2": 0.4}, vars(scenario)) for t in time_h]
        # azimuth and elevation against vectors: rounding
        np.testing.assert_allclose(power.panel_power(0.4, incidence), expected, rtol=1e-10, atol=1e-9)


# ---- the battery -------------------------------------------------------------------------------------------

def test_battery_by_hand():
    # 100 Wh: drawn at 9.5 W for 2 h (20 Wh), charged at 10 W for 1 h (9.5 Wh), filled, emptied to the floor
    net = np.array([-9.5, 10.0, 500.0, -500.0, 0.0])
    stored = power.march_battery(net[:, None], np.array([2.0, 1, 1, 1, 1])[:, None], 100.0)[:, 0]
    np.testing.assert_allclose(stored, [80, 89.5, 100, 15, 15], rtol=1e-15)


@quick
@given(st.lists(st.floats(-200, 200), min_size=1, max_size=60), st.floats(1, 500), st.floats(0.1, 1),
       st.floats(0.1, 1), st.floats(0, 1), st.floats(0, 1), st.floats(0.05, 3))
def test_battery_agrees_with_the_transcription_between_floor_and_full(
        net, capacity, charge, discharge, floor, initial, step):
    model = scalar.MODEL | {"charge_efficiency": charge, "discharge_efficiency": discharge,
                            "soc_floor": floor}
    expected, stored = [], min(max(initial, floor), 1) * capacity
    for power_w in net:
        stored = scalar.battery_step(stored, power_w, step, capacity, model)
        expected.append(stored)
    options = dict(soc_initial=initial, soc_floor=floor, charge_efficiency=charge,
                   discharge_efficiency=discharge)
    alone = power.march_battery(np.array(net)[:, None], step, capacity, **options)[:, 0]
    np.testing.assert_allclose(alone, expected, rtol=1e-9, atol=1e-9)  # products in another order
    assert np.all(alone >= floor * capacity) and np.all(alone <= capacity)
    # one lane is marched in plain floats, several in arrays: the same operations
    several = power.march_battery(np.tile(np.array(net)[:, None], 3), step, capacity, **options)
    np.testing.assert_array_equal(several, np.tile(alone[:, None], 3))


def test_a_round_trip_costs_both_efficiencies():
    net = np.array([-19.0, 20.0])[:, None]
    stored = power.march_battery(net, 1.0, 1000.0, soc_initial=0.5)[:, 0]
    assert stored[0] == 500 - 19 / 0.95 and stored[1] == stored[0] + 0.95 * 20


# ---- forms of input ----------------------------------------------------------------------------------------

def test_scalar_array_and_broadcast_forms_agree():
    latitude, hour, tilt = np.array([-80.0, 0.0, 45.0]), np.array([[-60.0], [0.0]]), np.array(30.0)
    elevation, azimuth = power.sun_position(latitude, hour)
    incidence = power.incidence_factor(latitude, hour, tilt, 180.0)
    watts = power.panel_power(np.array([0.2, 0.4, 0.8]), incidence)
    assert elevation.shape == azimuth.shape == incidence.shape == watts.shape == (2, 3)
    for i in range(2):
        for j in range(3):
            place = float(latitude[j]), float(hour[i, 0])
            one = (*power.sun_position(*place), power.incidence_factor(*place, 30.0, 180.0))
            assert all(np.ndim(value) == 0 for value in one)
            # rounding
            np.testing.assert_allclose((elevation[i, j], azimuth[i, j], incidence[i, j]), one, rtol=1e-13)
    for shape in (0,), (1,), (2, 0):
        assert power.sun_position(np.zeros(shape), 0.0)[0].shape == shape
        assert power.hour_angle_deg(np.zeros(shape)).shape == shape
        assert power.incidence_factor(np.zeros(shape), 0.0).shape == shape
        assert power.march_battery(np.ones((4, *shape)), 1.0, 10.0).shape == (4, *shape)


def test_battery_marches_lanes_of_any_shape():
    rng = np.random.default_rng(1)
    net = rng.normal(0, 30, (50, 2, 3))
    capacity, floor = np.array([20.0, 50.0, 200.0]), np.array([[0.1], [0.3]])
    found = power.march_battery(net.copy(), 1.0, capacity, soc_floor=floor)
    for i in range(2):
        for j in range(3):
            alone = power.march_battery(net[:, i, j, None].copy(), 1.0, capacity[j],
                                        soc_floor=floor[i, 0])[:, 0]
            np.testing.assert_array_equal(found[:, i, j], alone)                    # the same operations
