"""The mass model: the paper's rovers, line items that add up, forms of input."""

import dataclasses

import numpy as np
import pytest
import scalar_transcription as scalar
from hypothesis import given, settings
from hypothesis import strategies as st

import rdk
from rdk import catalog
from rdk.mass import MassCoefficients, mass_breakdown

CONSTANTS = {row["name"]: float(row["value"]) for row in catalog.rows("constants.csv")}
TARGETS = {row["id"]: tuple(map(float, row["accept"].split("..")))
           for row in catalog.rows("paper_targets.csv") if row["id"].startswith("mass_")}
CHECKED = {row["rover"]: row for row in catalog.rows("rovers.csv") if row["use"] == "mass check"}
ROVERS = {"mass_tenacious": "Tenacious", "mass_cadre": "CADRE-unit", "mass_rashid": "Rashid-1",
          "mass_sojourner": "Sojourner", "mass_pragyan": "Pragyan", "mass_yutu2": "Yutu-2",
          "mass_marsokhod": "MARSOKHOD"}
FIELDS = ("wheel_radius_m", "wheel_width_m", "grouser_height_m", "grouser_count", "wheel_count",
          "chassis_mass_kg", "solar_area_m2", "battery_capacity_wh", "avionics_power_w")
RASHID = dict(wheel_radius_m=0.1, wheel_width_m=0.08, grouser_height_m=0.015, grouser_count=14, wheel_count=4,
              chassis_mass_kg=3.5, solar_area_m2=0.25, battery_capacity_wh=50, avionics_power_w=15,
              peak_wheel_torque_nm=0.5, payload_mass_kg=1.5)


def anchored(row):
    """Sizes of a rover of the mass check; its hub torque follows the anchor rule, with the published mass."""
    sizes = {name: float(row[name]) for name in FIELDS}
    anchor = CONSTANTS["torque_anchor_margin"] * CONSTANTS["torque_anchor_coefficient"]
    load = float(row["published_mass_kg"]) * CONSTANTS["gravity_m_s2"] / sizes["wheel_count"]
    return sizes | {"peak_wheel_torque_nm": anchor * load * sizes["wheel_radius_m"]}


def predicted(row):
    return mass_breakdown(**anchored(row), payload_mass_kg=float(row["payload_mass_kg"])).total_kg


@pytest.mark.parametrize("target", ROVERS)
def test_rover_of_the_paper(target):
    low, high = TARGETS[target]
    assert low <= predicted(CHECKED[ROVERS[target]]) <= high


def test_errors_of_the_paper_over_the_in_class_rovers():
    assert set(TARGETS) == set(ROVERS) | {"mass_median", "mass_mean"}
    errors = [100 * abs(predicted(row) / float(row["published_mass_kg"]) - 1) for row in CHECKED.values()
              if row["in_class"] == "True"]
    assert len(errors) == 5
    for statistic in "median", "mean":
        low, high = TARGETS[f"mass_{statistic}"]
        assert low <= getattr(np, statistic)(errors) <= high


def test_evaluate_predicts_the_same_mass():
    row = CHECKED["Pragyan"]
    design = rdk.Design(**anchored(row), wheelbase_m=0.5)
    scenario = dataclasses.replace(rdk.scenario("polar_micro"), payload_mass_kg=float(row["payload_mass_kg"]))
    # the same formula on the same numbers
    assert rdk.evaluate(design, scenario).total_mass_kg == pytest.approx(predicted(row), rel=1e-15)


def test_line_items_by_hand():
    """The paper's equations with the figures of a 4-wheel rover, worked out on paper."""
    found = mass_breakdown(**RASHID).numbers()
    wheel = 8 * 2 * np.pi * 0.1 * 0.08 + 14 * 0.08 * 0.015 * 0.002 * 2700           # 0.40212 + 0.09072 kg
    expected = {"chassis_kg": 3.5, "wheels_kg": 4 * wheel, "motors_kg": 4 * (0.15 + 0.05),
                "solar_array_kg": 0.625, "battery_kg": 50 / 120, "avionics_kg": 0.3 + 0.75,
                "linkage_kg": 0.0, "payload_kg": 1.5}
    subsystems = sum(expected.values()) - 1.5
    expected |= {"harness_kg": 0.08 * subsystems, "thermal_control_kg": 0.05 * 1.08 * subsystems,
                 "growth_kg": 0.2 * 1.05 * 1.08 * subsystems,
                 "total_kg": 1.2 * 1.05 * 1.08 * subsystems + 1.5}
    assert found.keys() == expected.keys()
    for name, value in expected.items():
        assert found[name] == pytest.approx(value, rel=1e-14), name                 # rounding


def test_six_wheels_carry_a_linkage():
    rigid, rocker = mass_breakdown(**RASHID), mass_breakdown(**RASHID | {"wheel_count": 6})
    assert rigid.linkage_kg == 0 and rocker.linkage_kg == pytest.approx(0.5 + 0.08 * 3.5, rel=1e-15)
    assert rocker.wheels_kg == pytest.approx(1.5 * rigid.wheels_kg, rel=1e-15)
    assert rocker.motors_kg == pytest.approx(1.5 * rigid.motors_kg, rel=1e-15)


@settings(max_examples=100, deadline=None, derandomize=True)
@given(st.integers(0, 10**6), st.floats(0, 30), st.floats(0, 0.3), st.floats(0, 0.3), st.floats(0, 0.5))
def test_line_items_add_up_and_agree_with_the_transcription(seed, payload, harness, control, growth):
    design = rdk.random_designs(4, seed=seed)
    sizes = design.numbers()
    del sizes["wheelbase_m"]
    shares = MassCoefficients(harness_fraction=harness, thermal_control_fraction=control, growth_fraction=growth)
    found = mass_breakdown(**sizes, payload_mass_kg=payload, coefficients=shares)
    np.testing.assert_allclose(sum(found.items.values()), found.total_kg, rtol=1e-13)       # rounding
    model = scalar.MODEL | {"harness_fraction": harness, "thermal_fraction": control,
                            "growth_fraction": growth}
    expected = [scalar.total_mass_kg(one.numbers(), {"payload_mass_kg": payload}, model) for one in design]
    np.testing.assert_allclose(found.total_kg, expected, rtol=1e-13)
    assert all(np.all(item >= 0) for item in found.items.values())


@pytest.mark.parametrize("name", [name for name in RASHID if name != "wheel_count"])
def test_every_size_adds_mass(name):
    total = mass_breakdown(**RASHID | {name: np.array([1.0, 1.5]) * RASHID[name]}).total_kg
    assert total[1] > total[0]


def test_scalar_array_and_broadcast_forms_agree():
    radius, count, growth = np.array([0.06, 0.1, 0.2]), np.array([[4], [6]]), np.array(0.1)
    found = mass_breakdown(**RASHID | {"wheel_radius_m": radius, "wheel_count": count},
                           coefficients=MassCoefficients(growth_fraction=growth))
    assert found.shape == found.total_kg.shape == (2, 3) and found.motors_kg.shape == (2, 1)
    for i in range(2):
        for j in range(3):
            sizes = RASHID | {"wheel_radius_m": float(radius[j]), "wheel_count": int(count[i, 0])}
            one = mass_breakdown(**sizes, coefficients=MassCoefficients(growth_fraction=0.1))
            assert np.ndim(one.total_kg) == 0
            np.testing.assert_allclose(found.total_kg[i, j], one.total_kg, rtol=1e-15)  # the same operations
            np.testing.assert_allclose(found[i].total_kg[j], one.total_kg, rtol=1e-15)
    for shape in (0,), (1,), (2, 0):
        assert mass_breakdown(**RASHID | {"wheel_radius_m": np.full(shape, 0.1)}).total_kg.shape == shape
    frame = mass_breakdown(**RASHID | {"wheel_radius_m": radius}).to_frame()
    assert len(frame) == 3 and list(frame.columns) == list(found.numbers())
