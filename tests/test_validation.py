"""The evidence tables: computed in one call, recomputed by other means, held to the paper's bands."""

import dataclasses
import math

import numpy as np
import pandas as pd
import pytest
from numpy.testing import assert_allclose

import rdk
import scalar_transcription as scalar
import validation
from rdk import catalog
from ledger import accepts
from wheel_doubts import bootstrap_medians, drawn as picked

TARGETS = catalog.table("paper_targets.csv").set_index("id")


@pytest.fixture(scope="module")
def points():
    return validation.single_wheel()


@pytest.fixture(scope="module")
def masses():
    return validation.published_masses().set_index("rover")


# ---- single wheels -----------------------------------------------------------------------------------------

def test_one_call_of_the_kernel_solves_every_point(monkeypatch):
    calls, solve = [], validation.wheel_forces

    def counted(*args, **options):
        calls.append(args[3].shape)
        return solve(*args, **options)

    monkeypatch.setattr(validation, "wheel_forces", counted)
    table = validation.single_wheel()
    assert calls == [(len(table),)] and len(table) == len(catalog.rows("single_wheel.csv")) > 26
    bootstrap_medians(samples=3)              # reading errors move the measurements, not the model
    assert len(calls) == 2


@pytest.mark.parametrize("row", [2, 11, 14, 17, 26])
def test_points_agree_with_a_plain_scalar_transcription(points, row):
    raw = catalog.table("single_wheel.csv").loc[row]
    wheel = dict(radius_m=raw.wheel_radius_mm / 1000, width_m=raw.wheel_width_mm / 1000,
                 grouser_height_m=raw.grouser_height_mm / 1000, grouser_count=raw.grouser_count)
    soil = {name: float(value) for name, value in rdk.soil(raw.soil).numbers().items()}
    forces = scalar.wheel_forces(wheel, soil, raw.vertical_load_n, raw.slip, quadrature="gauss")
    # two quadratures; a few Gauss nodes see the root of a fractional sinkage exponent to about 1e-5
    assert_allclose(points.model_drawbar_pull_n[row], forces["drawbar_pull_n"], rtol=1e-4)
    assert_allclose(points.model_sinkage_mm[row], 1000 * forces["sinkage_m"], rtol=1e-4)
    assert_allclose(points.model_torque_nm[row], forces["torque_nm"], rtol=1e-4)


def test_errors_are_signed_and_missing_where_there_is_nothing_to_divide_by(points):
    braking = points.loc[0]                              # measured -6.5 N, model -9.0 N: the model is below
    assert braking.drawbar_pull_n == -6.5 and braking.model_drawbar_pull_n < -6.5
    # plain arithmetic in floating point
    assert_allclose(braking.drawbar_pull_error_pct, 100 * (braking.model_drawbar_pull_n + 6.5) / 6.5,
                    rtol=1e-12)
    assert np.isnan(braking.torque_error_pct) and braking.torque_nm == 0
    assert points[points.experiment == "hurrell-2025"].torque_error_pct.isna().all()
    assert points[["drawbar_pull_error_pct", "sinkage_error_pct"]].notna().all(axis=None)


def test_summary_takes_all_points_and_the_paper_leaves_no_other_choice(points):
    summary = validation.single_wheel_summary(points).set_index(["experiment", "quantity"])
    assert summary.points[("ding-2011", "drawbar_pull")] == 12
    assert ("hurrell-2025", "torque") not in summary.index
    by_hand = sorted(abs(points.query("experiment == 'hurrell-2025'").drawbar_pull_error_pct))[2]
    assert summary.median_abs_error_pct[("hurrell-2025", "drawbar_pull")] == by_hand
    # without the points at zero slip, or of negative pull, the paper's medians do not come out
    moving = validation.single_wheel_summary(points.query("slip > 0")).set_index(["experiment", "quantity"])
    pulling = validation.single_wheel_summary(points.query("drawbar_pull_n > 0"))
    pulling = pulling.set_index(["experiment", "quantity"])
    assert not accepts(TARGETS.accept["z_ding"],
                                  moving.median_abs_error_pct[("ding-2011", "sinkage")])
    assert not accepts(TARGETS.accept["dp_wang"],
                                  pulling.median_abs_error_pct[("wang-han-2016", "drawbar_pull")])


def test_curves_pass_through_the_points(points):
    curves = validation.single_wheel_curves(np.unique(points.slip))
    assert len(curves) == len(points.groupby(["experiment", "wheel"])) * points.slip.nunique()
    both = points.merge(curves, on=["experiment", "wheel", "slip"], suffixes=("", "_curve"))
    assert len(both) == len(points)
    for quantity in validation.QUANTITIES:
        # the same solver on another batch
        assert_allclose(both[f"model_{quantity}_curve"], both["model_" + quantity], rtol=1e-7, atol=1e-9)


def test_bootstrap_is_seeded_and_vanishes_with_the_reading_error():
    table = bootstrap_medians(samples=200, seed=3)
    pd.testing.assert_frame_equal(table, bootstrap_medians(samples=200, seed=3))
    assert not table.equals(bootstrap_medians(samples=200, seed=4))
    assert (table.low_pct < table.high_pct).all()
    still = bootstrap_medians(0, 0, 0, samples=5)
    for column in "low_pct", "median_pct", "high_pct":
        # a percentile of equal numbers, interpolated
        assert_allclose(still[column], still.median_abs_error_pct, rtol=1e-12)


def test_bootstrap_against_a_loop_written_out():
    """One experiment again, sample by sample with Python's own arithmetic and another random stream."""
    table = bootstrap_medians(samples=4000, seed=1).set_index(["experiment", "quantity"])
    group = validation.single_wheel().query("experiment == 'hurrell-2025'")
    rng, medians = np.random.default_rng(99), []
    for _ in range(4000):
        read = [d + rng.normal(0, 0.5) for d in group.drawbar_pull_n]
        medians.append(sorted(100 * abs(m - d) / d for m, d in zip(group.model_drawbar_pull_n, read))[2])
    row = table.loc[("hurrell-2025", "drawbar_pull")]
    # percentiles of two samples of 4,000 with a spread of about a fifth: well below 3 %
    assert_allclose([row.low_pct, row.high_pct], np.percentile(medians, [5, 95]), rtol=0.04)
    wider = bootstrap_medians(resample_points=True).set_index(["experiment", "quantity"])
    assert (wider.high_pct - wider.low_pct > table.high_pct - table.low_pct).all()


def test_points_of_a_curve_are_drawn_with_their_curve():
    curve = np.array(["a"] * 3 + ["b"] * 2)
    drawn = picked(curve, 4000, np.random.default_rng(5))
    halves = curve[drawn].reshape(4000, 2, 3)
    assert np.all(halves == halves[..., :1]), "three points of one curve, then three of one curve"
    # a share of 0.5 over 8,000 draws: 0.6 % standard error
    assert np.mean(halves == "a") == pytest.approx(0.5, abs=0.03)
    assert set(drawn.ravel()) == set(range(5))


def test_the_imposed_arc_halves_the_error_of_sinkage_and_not_that_of_pull():
    summary = validation.single_wheel_summary(kernel="imposed-arc").set_index(["experiment", "quantity"])
    sinkage = summary.median_abs_error_pct.xs("sinkage", level="quantity")
    # half a point on either side of independent code
    assert sinkage["ding-2011"] == pytest.approx(20.6, abs=0.5)
    assert sinkage["hurrell-2025"] == pytest.approx(20.4, abs=0.5)
    driving = validation.single_wheel(kernel="imposed-arc").query("slip > 0")
    pull = validation.single_wheel_summary(driving).set_index(["experiment", "quantity"]).median_abs_error_of_load_pct
    assert pull["ding-2011", "drawbar_pull"] == pytest.approx(8.0, abs=0.5)
    assert pull["hurrell-2025", "drawbar_pull"] == pytest.approx(12.3, abs=0.5)
    paper_s = validation.single_wheel_summary().set_index(["experiment", "quantity"])
    assert paper_s.median_abs_error_pct["ding-2011", "sinkage"] > 2 * sinkage["ding-2011"]
    curves = validation.single_wheel_curves([0.2], kernel="imposed-arc")
    wider = bootstrap_medians(0, 0, 0, samples=2, kernel="imposed-arc")
    assert np.allclose(wider.median_pct, summary.median_abs_error_pct) and curves.notna().all(axis=None)


def test_the_height_of_rashids_grousers_moves_the_median_of_pull():
    rashid = catalog.table("single_wheel.csv").query("experiment == 'hurrell-2025'")
    for height, expected in (20, [24.3, 27.5]), (15, [19.1, 28.3]):  # pull and sinkage, by independent code
        summary = validation.single_wheel_summary(validation.single_wheel(rashid.assign(grouser_height_mm=height)))
        assert_allclose(summary.median_abs_error_pct, expected, atol=0.06)


def test_further_wheel_tests_bring_their_soil():
    further = catalog.table("single_wheel_more.csv")
    points = validation.single_wheel(further)
    assert points.drawbar_pull_n.notna().sum() == 47 and len(points) == 71
    assert points.sinkage_error_pct.isna().all() and points.torque_nm.isna().all()
    row, raw = points.loc[3], further.loc[3]
    wheel = dict(radius_m=0.09, width_m=0.10, grouser_height_m=0.01, grouser_count=36)
    soil = {name: float(raw[name]) for name in rdk.soil("grc-1").numbers()}
    forces = scalar.wheel_forces(wheel, soil, 24.5, 0.483, quadrature="gauss")
    assert_allclose(row.model_drawbar_pull_n, forces["drawbar_pull_n"], rtol=1e-4)       # two quadratures
    assert row.drawbar_pull_n == 9.79


@pytest.mark.parametrize("options",
                         [dict(reading_error_n=-1), dict(reading_error_m=math.nan), dict(samples=0),
                                     dict(samples=1.5)])
def test_bootstrap_refuses_nonsense(options):
    with pytest.raises(ValueError, match=next(iter(options))):
        bootstrap_medians(**options)


def test_pull_shift_is_that_of_the_paper_and_none_at_scale_one():
    table = validation.pull_shift([1.0, 1.30])
    assert table.median_shift_pct[0] == 0 and table.points[0] == 24
    # one point again with the scalar transcription: Ding, grousered, slip 0.2
    wheel = dict(radius_m=0.15735, width_m=0.165, grouser_height_m=0.010, grouser_count=30)
    soil = {name: float(value) for name, value in rdk.soil("hit-2011").numbers().items()}
    plain, scaled = (scalar.wheel_forces(wheel, soil, 80.0, 0.2, dict(scalar.MODEL, shear_scale=s), "gauss")
                     ["drawbar_pull_n"] for s in (1.0, 1.3))
    ours = validation.single_wheel(shear_scale=1.3).model_drawbar_pull_n[8]
    assert_allclose(ours, scaled, rtol=1e-4)             # two quadratures, as above
    assert scaled > 1.2 * plain


# ---- masses ------------------------------------------------------------------------------------------------

def test_tenacious_by_hand(masses):
    wheels = 4 * (8.0 * 2 * math.pi * 0.06 * 0.04 + 12 * 0.04 * 0.005 * 0.002 * 2700)
    torque = 2 * 0.7 * (5.0 * 1.625 / 4) * 0.06
    motors = 4 * (0.15 + 0.1 * torque)
    subsystems = 1.7 + wheels + motors + 2.5 * 0.15 + 25 / 120 + 0.3 + 0.05 * 8
    total = subsystems * 1.08 * 1.05 * 1.2 + 0.3
    row = masses.loc["Tenacious"]
    # the same arithmetic in another order
    assert_allclose([row.peak_wheel_torque_nm, row.wheels_kg, row.predicted_mass_kg], [torque, wheels, total],
                    rtol=1e-12)
    assert_allclose(row.fixed_overhead_pct, 100 * (4 * 0.15 + 0.3) * 1.08 * 1.05 * 1.2 / 5.0, rtol=1e-12)
    assert 24 < row.fixed_overhead_pct < 26, "the paper's quarter"


def test_items_add_up_and_summary_is_that_of_the_five(masses):
    # sums in another order
    assert_allclose(masses[list(validation.MASS_ITEMS)].sum(axis=1), masses.predicted_mass_kg, rtol=1e-12)
    inside = masses[masses.in_class.astype(bool)]
    assert len(inside) == 5 and ((inside.published_mass_kg >= 5) & (inside.published_mass_kg <= 50)).all()
    row = validation.published_masses_summary().iloc[0]
    errors = sorted(abs(inside.predicted_mass_kg / inside.published_mass_kg - 1) * 100)
    assert_allclose([row.median_abs_error_pct, row.mean_abs_error_pct], [errors[2], sum(errors) / 5],
                    rtol=1e-12)


def test_a_changed_coefficient_moves_every_rover(masses):
    changed = validation.published_masses(rdk.Model(growth_fraction=0.22)).set_index("rover")
    bus, payload = masses.predicted_mass_kg - masses.payload_kg, masses.payload_kg
    # growth multiplies all but the payload; the same arithmetic in another order
    assert_allclose(changed.predicted_mass_kg, bus * 1.22 / 1.2 + payload, rtol=1e-12)
    heavier = validation.published_masses(rdk.Model(linkage_base_mass_kg=0.6)).set_index("rover").predicted_mass_kg
    assert heavier["Tenacious"] == masses.predicted_mass_kg["Tenacious"], "a rigid rover has no linkage"
    assert heavier["Pragyan"] > masses.predicted_mass_kg["Pragyan"]


@pytest.mark.parametrize("call, error, words", [
    (lambda: validation.published_masses("x"), TypeError, "model must be a Model, such as rdk.Model.*got 'x'"),
    (lambda: validation.published_masses(rdk.Model(growth_fraction=[0.1, 0.2])), ValueError, "model must be a single"),
    (lambda: validation.single_wheel("x"), TypeError, "points must be a DataFrame; got 'x'"),
    (lambda: validation.single_wheel_summary("x"), TypeError, "points must be a DataFrame"),
    (lambda: validation.published_masses_summary(3), TypeError, "masses must be a DataFrame; got int"),
    (lambda: validation.constant("flown_packing"), ValueError, "no constant 'flown_packing'; nearest are flown_pack")])
def test_what_is_no_record_or_table_is_refused_by_name(call, error, words):
    with pytest.raises(error, match=words):
        call()


# ---- flown rovers ------------------------------------------------------------------------------------------

def test_peak_power_by_hand():
    pragyan = 1361 * 0.5 * math.cos(math.radians(69.4)) * 0.30 * 0.90 * 0.92 * 0.90 * 0.98
    yutu2 = 1361 * 1.3 * math.cos(math.radians(45.5)) * 0.30 * 0.90 * 0.92 * 0.90
    flown = validation.flown_rovers().set_index("rover")
    # the same products, the sine and cosine of the sun apart
    assert_allclose([flown.clean_peak_w["Pragyan"], flown.peak_w["Yutu-2"]], [pragyan, yutu2], rtol=1e-12)
    assert_allclose(flown.implied_derate["Yutu-2"], 135 / yutu2, rtol=1e-12)
    sweep = validation.peak_solar_power_w(0.5, -69.4, np.array([0.28, 0.32]))
    assert_allclose(sweep, [flown.clean_peak_low_w["Pragyan"], flown.clean_peak_high_w["Pragyan"]],
                    rtol=1e-12)


def test_night_temperatures_by_hand():
    flown = validation.flown_rovers().set_index("rover")
    radiated = 0.85 * 5.670374419e-8 * np.array([0.25, 0.1])             # W per K^4
    kelvin = (100.0**4 + np.array([2.0, 5.0 + 15.0]) / radiated) ** 0.25
    # same arithmetic
    assert_allclose(flown.cold_temperature_c[["Pragyan", "Yutu-2"]], kelvin - 273.15, rtol=1e-12)
    assert (flown.survives == flown.survived).all()


def test_range_envelope_is_the_limit_of_the_scenario():
    flown = validation.flown_rovers().set_index("rover")
    for rover, mission in ("Pragyan", "chandrayaan3_pragyan"), ("Yutu-2", "change4_yutu2_per_lunar_day"):
        limit = rdk.scenario(mission).traverse_limit_km
        assert_allclose(flown.range_m[rover], 1000 * limit, rtol=1e-12)      # clipped there
        assert flown.unlimited_range_km[rover] > limit
        assert flown.range_m[rover] > flown.published_traverse_m[rover]


# ---- constants and conditions ------------------------------------------------------------------------------

def test_constants_of_studies_are_found_by_name():
    assert validation.constant("flown_packing_factor") == 0.90
    with pytest.raises(ValueError, match="no constant 'flown'"):
        validation.constant("flown")


def test_conditions_carry_the_units_of_the_kernel():
    wheel, soil, load, slip = validation.single_wheel_conditions()
    assert wheel.shape == soil.shape == load.shape == slip.shape == (len(catalog.rows("single_wheel.csv")),)
    assert wheel.radius_m.max() < 0.2 and dataclasses.asdict(soil[0])["shear_modulus_mm"] == 11
