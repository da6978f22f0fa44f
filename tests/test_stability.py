"""Loads on a slope balance forces and moments; tip-over is where a pair's load vanishes."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

import rdk
from rdk.stability import axle_loads, stance, static_pressure_kpa, tip_over

RANDOM = np.random.default_rng(5)
N = 400
VEHICLE = dict(mass_kg=RANDOM.uniform(1, 60, N), wheelbase_m=RANDOM.uniform(0.2, 1.5, N),
               centre_height_m=RANDOM.uniform(0.02, 0.5, N), slope_deg=RANDOM.uniform(-40, 40, N),
               centre_offset_m=RANDOM.uniform(-0.08, 0.08, N), pivot_height_m=RANDOM.uniform(0, 0.3, N))


def balance(loads, x, pivot=None, *, mass_kg, wheelbase_m, centre_height_m, slope_deg, centre_offset_m, **_):
    """Residual moment about the origin over weight times wheelbase, from first principles: forces as vectors."""
    slope = np.radians(slope_deg)
    weight = mass_kg * 1.625
    moment = -weight * (np.cos(slope) * centre_offset_m - np.sin(slope) * centre_height_m)   # gravity, tilted frame
    for load, position in zip(loads, x):                 # normal force at (position, 0); traction has no arm there
        moment = moment + load * position
    return moment / (weight * wheelbase_m)


def test_loads_of_random_vehicles_balance():
    length = VEHICLE["wheelbase_m"]
    normal = VEHICLE["mass_kg"] * 1.625 * np.cos(np.radians(VEHICLE["slope_deg"]))
    four = axle_loads(**VEHICLE, wheel_count=4)
    assert np.isnan(four.middle_n).all()
    six = axle_loads(**VEHICLE, wheel_count=6)
    for loads, places in ((four[::2], (length / 2, -length / 2)), (six, (length / 2, 0 * length, -length / 2))):
        # rounding of sums of some ten terms
        assert_allclose(sum(loads), normal, rtol=1e-12)
        assert_allclose(balance(loads, places, **VEHICLE), 0, atol=1e-12)


def test_the_bogie_turns_freely_about_its_pivot():
    """The two wheels' forces, normal and traction, have no moment about the pivot."""
    length, height, slope = VEHICLE["wheelbase_m"], VEHICLE["pivot_height_m"], np.radians(VEHICLE["slope_deg"])
    six = axle_loads(**VEHICLE, wheel_count=6)
    traction = (six.front_n + six.middle_n) * np.tan(slope)          # each pulls N tan(slope), uphill, at the ground
    moment = six.front_n * length / 4 - six.middle_n * length / 4 + traction * height
    assert_allclose(moment / (VEHICLE["mass_kg"] * length), 0, atol=1e-12)


def test_loads_on_the_flat_and_of_a_low_centre():
    four = axle_loads(10.0, 0.5, 0.2, 0.0, wheel_count=4)
    assert_allclose([four.front_n, four.rear_n], 10 * 1.625 / 2, rtol=1e-15)
    six = axle_loads(10.0, 0.5, 0.2, 0.0, wheel_count=6)             # lever rule: 2/3 on the bogie, 1/3 behind
    assert_allclose(six, np.array([1, 1, 1]) * 16.25 / 3, rtol=1e-14)
    low = axle_loads(10.0, 0.5, 0.0, 30.0, wheel_count=4)            # no height, no transfer
    assert_allclose(low.front_n, low.rear_n, rtol=1e-14)


@given(st.floats(0.2, 1.5), st.floats(0.05, 0.6), st.floats(-0.4, 0.4), st.floats(0, 1))
def test_tip_over_is_where_the_uphill_load_vanishes(length, height, share, pivot_share):
    offset = share * length / 2
    found = tip_over(length, 0.9 * length, height, centre_offset_m=offset)
    four = axle_loads(10.0, length, height, found.uphill_deg, wheel_count=4, centre_offset_m=offset)
    assert_allclose(four.front_n, 0, atol=1e-12 * 16.25)
    six = axle_loads(10.0, length, height, found.uphill_deg, wheel_count=6, centre_offset_m=offset,
                     pivot_height_m=pivot_share * height / 2)
    # the lever of a high pivot can be short, which magnifies rounding
    assert_allclose(six.front_n + six.middle_n, 0, atol=1e-11 * 16.25)
    down = axle_loads(10.0, length, height, -found.downhill_deg, wheel_count=4, centre_offset_m=offset)
    assert_allclose(down.rear_n, 0, atol=1e-12 * 16.25)


def test_a_bogies_front_wheel_lifts_before_it_tips_where_the_pivot_is_high():
    length, height = 0.6, 0.25
    for pivot, first in ((0.2, True), (0.1, False)):
        lifts = np.degrees(np.arctan(length / 4 / pivot))
        assert_allclose(axle_loads(10.0, length, height, lifts, wheel_count=6, pivot_height_m=pivot).front_n, 0,
                        atol=1e-12)
        assert (lifts < tip_over(length, 0.5, height).uphill_deg) == first


def test_scalars_arrays_and_broadcasting_agree():
    one = axle_loads(12.0, 0.5, 0.2, 15.0, wheel_count=6, pivot_height_m=0.1)
    grid = axle_loads(12.0, 0.5, 0.2, np.array([[0.0], [15.0]]), wheel_count=np.array([4, 6]), pivot_height_m=0.1)
    assert grid.front_n.shape == (2, 2) and np.ndim(one.front_n) == 0
    assert_allclose([loads[1, 1] for loads in grid], one, rtol=1e-15)
    assert np.isnan(grid.middle_n[:, 0]).all() and not np.isnan(grid.middle_n[:, 1]).any()
    assert tip_over(np.array([0.5, 1.0]), 0.4, 0.2).uphill_deg.shape == (2,)


@pytest.mark.parametrize("change, words", [
    (dict(wheel_count=5), "wheel_count must be one of 4, 6; got 5"), (dict(slope_deg=90), "slope_deg must be"),
    (dict(mass_kg=-1), "mass_kg must be"), (dict(mass_kg=[1, 2], wheelbase_m=[1, 2, 3]), "mass_kg .2,., wheelbase_m")])
def test_bad_loads_are_named(change, words):
    with pytest.raises(ValueError, match=words):
        axle_loads(**{**dict(mass_kg=10, wheelbase_m=0.5, centre_height_m=0.2, slope_deg=0, wheel_count=4), **change})


def test_a_centre_outside_the_wheelbase_is_refused():
    with pytest.raises(ValueError, match="centre_offset_m must lie inside the wheelbase"):
        tip_over(0.5, 0.4, 0.2, centre_offset_m=0.25)


def test_stance_of_published_sizes():
    # MoonRanger's flight model: 18 kg on 0.444 m by 0.584 m, wheels of 85 mm and 238 g, reference point at 0.256 m
    found = stance(18.0, 4 * 0.238, 0.085, 0.06, 0.444, 4, track_ratio=0.584 / 0.444)
    assert_allclose(found.track_m, 0.584, rtol=1e-12)
    assert 0.75 * 0.256 < found.centre_height_m < 1.25 * 0.256       # the model's own claim: within a quarter
    heavy = stance(np.array([5.0, 20.0, 60.0]), 1.0, 0.1, 0.08, 0.5, 4)
    assert np.all(np.diff(heavy.centre_height_m) > 0)
    flat = stance(1.0, 0.5, 0.2, 0.1, 1.2, 6)                        # far too light for its envelope: the least body
    assert_allclose(flat.centre_height_m, 0.5 * 0.2 + 0.5 * (0.4 + 0.025), rtol=1e-12)


def test_static_pressure_of_rovers():
    """Lunar loads on apollo-nominal, from the published masses: figures found by independent code."""
    found = {name: static_pressure_kpa(rdk.rover(name).wheel, rdk.soil("apollo-nominal"), kg * 1.625 / count)
             for name, kg, count in (("Rashid-1", 10, 4), ("Tenacious", 5, 4), ("Pragyan", 26, 6), ("Yutu-2", 135, 6))}
    flight = rdk.Wheel(0.085, 0.06, 0.01, 12)            # MoonRanger's
    found["MoonRanger"] = static_pressure_kpa(flight, rdk.soil("apollo-nominal"), 18 * 1.625 / 4)
    assert {name: round(float(p), 1) for name, p in found.items()} == {
        "Rashid-1": 1.2, "Tenacious": 1.5, "Pragyan": 2.0, "Yutu-2": 3.0, "MoonRanger": 2.3}


def test_static_pressure_is_the_load_over_the_arc_that_carries_it():
    wheel, soil, load = rdk.Wheel(0.1, [0.08, 0.16], 0, 0), rdk.soil("apollo-nominal"), np.array([[2.0], [8.0]])
    pressure = static_pressure_kpa(wheel, soil, load)
    assert pressure.shape == (2, 2) and np.all(np.diff(pressure, axis=0) > 0) and np.all(np.diff(pressure, axis=1) < 0)
    # Bekker's plate is the limit of a shallow arc: n = 1, load = 2 b r^2 k int (cos t - cos theta) cos t dt
    angle = np.arcsin(2.0 / (2000 * 0.08 * 0.1 * pressure[0, 0]))
    stiff = 1000 * (soil.cohesive_modulus_kn_m_n1 / 0.08 + soil.frictional_modulus_kn_m_n2)
    integral = angle / 2 - np.sin(2 * angle) / 4
    assert_allclose(2 * 0.08 * 0.1**2 * stiff * integral, 2.0, rtol=1e-6)        # n = 1: the integral is elementary
