"""Sun, panel and enclosure by other means: pvlib, rotation matrices, the Stefan-Boltzmann law."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from pvlib.irradiance import aoi_projection

from rdk import power, thermal

RNG = np.random.default_rng(7)
N = 2000
LATITUDE, HOUR, DECLINATION = RNG.uniform(-90, 90, N), RNG.uniform(-180, 180, N), RNG.uniform(-1.6, 1.6, N)
TILT, AZIMUTH = RNG.uniform(0, 180, N), RNG.uniform(0, 360, N)


def test_incidence_agrees_with_pvlib():
    elevation, sun_azimuth = power.sun_position(LATITUDE, HOUR, DECLINATION)
    theirs = aoi_projection(TILT, AZIMUTH, 90 - elevation, sun_azimuth)
    expected = np.where(elevation > 0, np.maximum(theirs, 0), 0)
    ours = power.incidence_factor(LATITUDE, HOUR, TILT, AZIMUTH, DECLINATION)
    # pvlib goes through angles in degrees: a few rounding errors of the arc sine near the zenith
    assert_allclose(ours, expected, rtol=0, atol=1e-12)
    assert 0.1 < np.mean(ours > 0) < 0.5, "both branches are met"


def turned(axis, angle):
    """Rotation matrix about an axis, by Rodrigues' formula."""
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def test_sun_position_agrees_with_turning_a_ball():
    """Stand under the noon sun, walk to the latitude, let the ball turn: no spherical trigonometry."""
    for latitude, hour, declination in zip(*np.radians([LATITUDE[:300], HOUR[:300], DECLINATION[:300]])):
        walk = turned([0, 0, 1], hour) @ turned([0, 1, 0], -latitude)        # z is the Moon's axis
        up, east, north = walk @ [1, 0, 0], walk @ [0, 1, 0], walk @ [0, 0, 1]
        sun = np.array([np.cos(declination), 0, np.sin(declination)])
        ours = power.sun_position(*np.degrees([latitude, hour, declination]))
        elevation, azimuth = np.radians(ours)
        level = np.cos(elevation)
        # rounding, enlarged where the arc sine is steep (near the zenith)
        assert_allclose([level * np.sin(azimuth), level * np.cos(azimuth), np.sin(elevation)],
                        [sun @ east, sun @ north, sun @ up], rtol=0, atol=1e-12)


def test_nothing_comes_through_the_ground_or_the_back():
    below = power.sun_position(LATITUDE, HOUR)[0] < -1e-6
    assert below.any() and not power.incidence_factor(LATITUDE, HOUR, TILT, AZIMUTH)[below].any()
    # sun in the south, panel's back to it
    noon = power.incidence_factor(40.0, 0.0, 90.0, [180.0, 0.0])
    assert noon[0] > 0 and noon[1] == 0


@given(heat_w=st.floats(0, 1000), area_m2=st.floats(0.01, 2), sink_k=st.floats(50, 400),
       emissivity=st.floats(0.05, 1))
def test_stefan_boltzmann_balance_closes(heat_w, area_m2, sink_k, emissivity):
    kelvin = thermal.node_temperature(heat_w, area_m2, sink_k, emissivity=emissivity) + 273.15
    conductance = emissivity * 5.670374419e-8 * area_m2
    out, back = conductance * kelvin**4, conductance * sink_k**4
    # to 1e-12 of what the node emits; 273.15 taken off and put back costs a few units in the last place of a
    # temperature, four times that in its fourth power
    assert abs(out - back - heat_w) <= 1e-12 * out
    assert kelvin >= sink_k - 1e-9                       # heat never cools; the 273.15 again


def test_temperature_takes_arrays_and_scalars_alike():
    heat, sink = np.array([0.0, 2.0, 30.0]), np.array([[100.0], [250.0]])
    table = thermal.node_temperature(heat, 0.1, sink)
    one = [[float(thermal.node_temperature(q, 0.1, s)) for q in heat] for s in sink.ravel()]
    # vector and scalar square roots may differ in the last bit
    assert_allclose(table, one, rtol=1e-13)
    assert (np.diff(table, axis=1) > 0).all() and (np.diff(table, axis=0) > 0).all()
