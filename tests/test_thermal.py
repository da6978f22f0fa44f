"""The enclosure: its balance, its limits, and the lunar night of two flown rovers."""

import dataclasses
import warnings

import numpy as np
import pytest
import scalar_transcription as scalar
import scipy.constants
from hypothesis import given, settings
from hypothesis import strategies as st

import rdk
from rdk import catalog, thermal

quick = settings(max_examples=200, deadline=None, derandomize=True)


def flown(name):
    """A flown rover's performance on its own mission, with its own enclosure, array and flat panel."""
    row = next(row for row in catalog.rows("flown.csv") if row["rover"] == name)
    model = rdk.Model(
        enclosure_area_base_m2=float(row["enclosure_area_m2"]), enclosure_area_coefficient_m2=0.0,
        enclosure_absorptivity=float(row["absorptivity"]),
        hibernation_power_w=float(row["hibernation_power_w"]),
        radioisotope_heater_power_w=float(row["rhu_power_w"]),
        operating_temperature_max_c=float(row["max_operating_temp_c"]))
    scenario = dataclasses.replace(rdk.scenario(row["mission"]), panel_tilt_deg=0.0)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)     # Yutu-2 is outside the design space, and known to be
        return rdk.evaluate(rdk.rover(name), scenario, model=model), row


@pytest.mark.parametrize("target, name", [("night_pragyan", "Pragyan"), ("night_yutu2", "Yutu-2")])
def test_flown_rovers_meet_the_lunar_night_as_published(target, name):
    accepted = next(row["accept"] for row in catalog.rows("paper_targets.csv") if row["id"] == target)
    result, row = flown(name)
    assert str(result.thermal_survival) == accepted == row["survives_lunar_night"]
    # it is the night that decides, not the noon
    assert result.hot_temperature_c < float(row["max_operating_temp_c"])
    assert (result.cold_temperature_c > -30) == result.thermal_survival


@quick
@given(st.floats(0, 500), st.floats(0.01, 2), st.just(0.0) | st.floats(1, 400), st.floats(0.05, 1))
def test_the_node_radiates_what_it_gains(heat, area, sink, emissivity):
    kelvin = thermal.node_temperature(heat, area, sink, emissivity=emissivity) + 273.15
    radiated = emissivity * thermal.STEFAN_BOLTZMANN * area * (kelvin**4 - sink**4)
    exchanged = emissivity * thermal.STEFAN_BOLTZMANN * area * (kelvin**4 + sink**4)
    # to 1e-12 of what is exchanged: passing through degrees Celsius costs 273 K * 1e-16
    assert radiated == pytest.approx(heat, abs=1e-12 * exchanged + 1e-12)
    assert kelvin >= sink * (1 - 1e-12)


def test_constants():
    # written with the ten digits of the CODATA table; scipy may carry more
    assert thermal.STEFAN_BOLTZMANN == pytest.approx(scipy.constants.Stefan_Boltzmann, rel=1e-10)
    assert thermal.ZERO_CELSIUS == scipy.constants.zero_Celsius


@quick
@given(st.floats(1, 100), st.floats(0.02, 1), st.floats(1.01, 3))
def test_heat_warms_and_area_cools(heat, area, factor):
    base = thermal.node_temperature(heat, area, 100.0)
    assert thermal.node_temperature(heat * factor, area, 100.0) > base
    assert thermal.node_temperature(heat, area * factor, 100.0) < base
    assert thermal.node_temperature(heat, area, 150.0) > base
    assert thermal.node_temperature(heat, area, 100.0, emissivity=1.0) < base


def test_limits():
    # no heat: the sink's own temperature; much heat: the fourth root of Q / (eps sigma A)
    assert thermal.node_temperature(0.0, 0.3, 250.0) == pytest.approx(-23.15, abs=1e-12)
    hot = 273.15 + thermal.node_temperature(1e6, 0.3, 100.0, emissivity=0.5)
    assert hot == pytest.approx((1e6 / (0.5 * scipy.constants.Stefan_Boltzmann * 0.3)) ** 0.25, rel=1e-5)
    assert thermal.enclosure_area(0.0) == 0.05
    assert thermal.enclosure_area(8.0) == pytest.approx(0.13, rel=1e-15)
    noon = thermal.absorbed_sunlight(np.array([-90.0, -60.0, 0.0, 60.0, 90.0]), 0.2)
    np.testing.assert_allclose(noon, 0.3 * 1361 * 0.25 * 0.2 * np.array([0, 0.5, 1, 0.5, 0]), atol=1e-12)
    assert np.all(noon >= 0)


def test_evaluate_agrees_with_the_transcription():
    designs = rdk.random_designs(50, seed=2)
    for name in rdk.scenario_names("canonical"):
        scenario = rdk.scenario(name)
        model = rdk.Model(radioisotope_heater_power_w=7.0)
        found = rdk.evaluate(designs, scenario, model=model)
        constants = scalar.MODEL | {"rhu_w": 7.0}
        expected = [scalar.enclosure_temperatures_c(d.numbers(), vars(scenario), constants) for d in designs]
        # the fourth root taken in two ways: rounding of 300 K
        found = [found.hot_temperature_c, found.cold_temperature_c]
        np.testing.assert_allclose(np.transpose(expected), found, rtol=1e-11, atol=1e-9)


def test_scalar_array_and_broadcast_forms_agree():
    heat, area, sink = np.array([0.0, 5.0, 20.0]), np.array([[0.1], [0.3]]), np.array(100.0)
    found = thermal.node_temperature(heat, area, sink)
    assert found.shape == (2, 3)
    for i in range(2):
        for j in range(3):
            one = thermal.node_temperature(float(heat[j]), float(area[i, 0]), 100.0)
            assert np.ndim(one) == 0
            np.testing.assert_allclose(found[i, j], one, rtol=1e-14)                # rounding
    for shape in (0,), (1,), (2, 0):
        assert thermal.node_temperature(np.ones(shape), 0.1, 100.0).shape == shape
        assert thermal.absorbed_sunlight(np.zeros(shape), 0.1).shape == shape
        assert thermal.enclosure_area(np.ones(shape)).shape == shape
