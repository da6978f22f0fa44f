"""Random designs, genes, sweeps, Monte-Carlo intervals, Shapley values: each against a plainer way to it."""

import dataclasses
import itertools
import math
import warnings
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

import rdk
import searches
from rdk import catalog, sampling
from rdk.uncertainty import inputs_at, uncertain_inputs, uncertain_names
from validation import single_wheel
from wheel_doubts import interval_coverage

MARE = rdk.scenario("equatorial_mare_traverse")
RASHID, TENACIOUS = rdk.rover("Rashid-1"), rdk.rover("Tenacious")
PARTS = {"design": RASHID, "scenario": MARE, "soil": MARE.soil, "model": rdk.Model()}
RECORDS = {"design": rdk.Design, "scenario": rdk.Scenario, "soil": rdk.Soil, "model": rdk.Model}
# Newton stops within 1e-10; the order of a batch moves the last bits
SAME = dict(rtol=1e-8, atol=1e-10)


def metrics(performance):
    return {name: np.asarray(getattr(performance, name), float) for name in sampling.METRICS}


def assert_same_metrics(performance, expected, **tolerance):
    for name, value in metrics(performance).items():
        np.testing.assert_allclose(value, getattr(expected, name), err_msg=name, **(tolerance or SAME))


# ---- demands --------------------------------------------------------------------------------------------

def test_a_demand_holds_at_its_limit_even_where_both_are_infinite_and_not_where_there_is_no_value():
    late = rdk.evaluate(RASHID, MARE.replace(duty_cycle=[0.0, 1.0]))
    assert np.isinf(late.arrival_h[0]) and np.isfinite(late.arrival_h[1])
    assert sampling.holds(late, ("arrival_h", "<=", math.inf)).tolist() == [True, True]
    assert sampling.holds(late, ("range_km", ">=", late.range_km[1])).tolist() == [False, True]
    buried = rdk.evaluate(RASHID, MARE.replace(payload_mass_kg=1e5))
    assert buried.buried and not any(sampling.holds(buried, ("sinkage_m", sign, 0.0)) for sign in ("<=", ">="))


# ---- designs and genes ----------------------------------------------------------------------------------

def assert_buildable(designs, bounds=None):
    for name, variable in rdk.DESIGN_SPACE.items():
        low, high = (bounds or {}).get(name, (variable.low, variable.high))
        values = getattr(designs, name)
        assert np.all((values >= low) & (values <= high)), name
    assert np.isin(designs.wheel_count, (4, 6)).all()
    assert designs.grouser_count.dtype.kind == designs.wheel_count.dtype.kind == "i"


@pytest.mark.parametrize("seed", [-1, 1.5, "one", True, [1, 2]])
@pytest.mark.parametrize("call", [lambda seed: rdk.random_designs(2, seed=seed),
                                  lambda seed: rdk.intervals(RASHID, MARE, draws=2, seed=seed),
                                  lambda seed: rdk.pareto_front(MARE, population=4, generations=1, seed=seed),
                                  lambda seed: searches.fronts([MARE], seeds=[seed], population=4, generations=1),
                                  lambda seed: rdk.terrain.synthetic(seed, cells=32)])
def test_a_seed_is_a_whole_number_everywhere(call, seed):
    with pytest.raises(ValueError, match="seeds? must be (a whole number, zero or more|one number)"):
        call(seed)


def test_random_designs_fill_the_space_and_follow_the_seed():
    designs = rdk.random_designs(2000, seed=1)
    assert_buildable(designs)
    for name, variable in rdk.DESIGN_SPACE.items():
        values = np.asarray(getattr(designs, name), float)
        # mean and spread of a uniform variable, or of a fair coin: five standard errors of 2,000 draws
        spread = (variable.high - variable.low) * (0.5 if variable.kind == "choice" else 1 / math.sqrt(12))
        assert abs(values.mean() - (variable.low + variable.high) / 2) < 5 * spread / math.sqrt(2000), name
        assert abs(values.std() / spread - 1) < 0.1, name
    again, other = rdk.random_designs(2000, seed=1), rdk.random_designs(2000, seed=2)
    for name in rdk.DESIGN_SPACE:
        np.testing.assert_array_equal(getattr(designs, name), getattr(again, name))
        assert (getattr(designs, name) != getattr(other, name)).any()


def test_random_designs_keep_bounds():
    bounds = {"wheel_width_m": (0.06, 0.08), "wheel_count": (6, 6), "grouser_count": (3, 5),
              "chassis_mass_kg": (2, 2)}
    designs = rdk.random_designs(300, seed=1, bounds=bounds)
    assert_buildable(designs, bounds)
    assert set(designs.grouser_count) == {3, 4, 5} and np.ptp(designs.wheel_width_m) > 0.019
    assert set(designs.chassis_mass_kg) == {2.0}


GENES = arrays(float, st.tuples(st.integers(1, 5), st.just(11)), elements=st.floats(0, 1))
OTHER_BOUNDS = {"wheel_width_m": (0.05, 0.3), "grouser_count": (2, 30), "wheel_count": (4, 4)}


@settings(deadline=None, max_examples=60)
@given(GENES, st.sampled_from([None, OTHER_BOUNDS]))
def test_any_genes_decode_to_a_design_that_can_be_built(genes, bounds):
    designs = sampling.decode(genes, bounds)
    assert_buildable(designs, bounds)
    back = sampling.encode(designs, bounds)
    assert back.shape == genes.shape and np.all((back >= 0) & (back <= 1))
    kept = sampling.decode(back, bounds)
    for name, variable in rdk.DESIGN_SPACE.items():
        # scaling there and back costs the last bits; counts come back exactly
        np.testing.assert_allclose(getattr(kept, name), getattr(designs, name), rtol=1e-13, err_msg=name)
        if variable.kind != "continuous":
            np.testing.assert_array_equal(getattr(kept, name), getattr(designs, name))
    continuous = [v.kind == "continuous" for v in rdk.DESIGN_SPACE.values()]
    # genes near 0 are rounded with the bound that they are added to
    np.testing.assert_allclose(back[:, continuous], genes[:, continuous], atol=1e-13)


def test_decode_rounds_grousers_and_splits_wheels_at_the_middle():
    genes = np.full((4, 11), 0.5)
    genes[:, 3] = np.array([0.0, 7.49, 7.51, 24]) / 24
    genes[:, 4] = [0.0, 0.4999, 0.5, 1.0]
    designs = sampling.decode(genes)
    assert designs.grouser_count.tolist() == [0, 7, 8, 24]
    assert designs.wheel_count.tolist() == [4, 4, 6, 6]


def test_encode_takes_one_design_and_clips_what_lies_outside():
    genes = sampling.encode(RASHID)
    assert genes.shape == (1, 11)
    back = sampling.decode(genes)[0]
    for name in rdk.DESIGN_SPACE:
        np.testing.assert_allclose(getattr(back, name), getattr(RASHID, name), rtol=1e-13)
    wide = replace(RASHID, wheel_radius_m=0.5, chassis_mass_kg=0.1)
    assert sampling.encode(wide)[0, [0, 5]].tolist() == [1, 0]


@pytest.mark.parametrize("bounds, words", [
    ({"wheels": (4, 6)}, "no design variable 'wheels'; nearest are .*wheel"),
    ({"wheel_radius_m": (0.2, 0.1)}, "wheel_radius_m must rise"),
    ({"wheel_radius_m": 0.1}, r"wheel_radius_m must be a pair \(low, high\); got 0.1"),
    ({"wheel_radius_m": (0.1, 0.2, 0.3)}, "must be a pair"),
    ({"wheel_radius_m": (-0.1, 0.2)}, "wheel_radius_m must be positive and finite; got -0.1"),
    ({"wheel_radius_m": (0.1, math.nan)}, "got nan"),
    ({"wheel_count": (4, 5)}, "wheel_count must be one of 4, 6; got 5"),
    ({"grouser_count": (0.5, 3)}, "grouser_count must be a whole number, zero or more; got 0.5"),
    ([("wheel_radius_m", (0.1, 0.2))], "bounds must be a dictionary")])
def test_bad_bounds_are_named(bounds, words):
    with pytest.raises(ValueError, match=words):
        rdk.random_designs(2, seed=1, bounds=bounds)


@pytest.mark.parametrize("count", [0, -1, 2.5, "3", None, True, [3]])
def test_count_of_random_designs_is_checked(count):
    with pytest.raises(ValueError, match="count"):
        rdk.random_designs(count)


# ---- sweeps ---------------------------------------------------------------------------------------------

def sweepable():
    for owner, kind in RECORDS.items():
        for f in dataclasses.fields(kind):
            if "minimum" in f.metadata and not f.metadata.get("scalar"):
                yield owner, f.name


def two_values(owner, name):
    """The nominal value of a field and one near it."""
    nominal = getattr(PARTS[owner], name)
    if name == "wheel_count":
        return [4, 6]
    if name == "grouser_count":
        return [14, 9]
    if name in ("stop_at_limit", "exact_floor", "axle_torque"):
        return [0, 1]
    if name in ("transition_c1", "transition_c2"):       # None: the kernel's own
        nominal = PARTS["model"].transition[name == "transition_c2"]
    return [nominal, 0.97 * nominal or 0.01]


def evaluated(*changes):
    """Evaluation with fields replaced in the plain way."""
    parts = dict(PARTS)
    for owner, name, value in changes:
        parts[owner] = replace(parts[owner], **{name: value})
    scenario = replace(parts["scenario"], soil=parts["soil"])
    return rdk.evaluate(parts["design"], scenario, model=parts["model"])


def test_field_names_are_unique_so_that_a_name_finds_one_field():
    names = [f.name for kind in RECORDS.values() for f in dataclasses.fields(kind) if "minimum" in f.metadata]
    assert len(names) == len(set(names)) > 70


@pytest.mark.parametrize("owner, name", list(sweepable()))
def test_sweep_of_any_field_equals_separate_evaluations(owner, name):
    values = two_values(owner, name)
    swept = rdk.sweep(RASHID, MARE, {name: values})
    assert swept.fields == (name,) and swept.performance.shape == (2,)
    for i, value in enumerate(values):
        assert_same_metrics(swept.performance[i], evaluated((owner, name, value)))


@pytest.mark.parametrize("first, second", [
    (("design", "wheel_radius_m", [0.08, 0.12, 0.2]), ("scenario", "slope_deg", [0, 25])),
    (("soil", "friction_angle_deg", [30, 46]), ("model", "hub_no_load_speed_rad_s", [2.5, 5, math.inf])),
    (("design", "wheel_count", [6, 4]), ("design", "grouser_count", [0, 12, 24]))])
def test_sweep_over_a_grid_equals_separate_evaluations(first, second):
    swept = rdk.sweep(RASHID, MARE, {first[1]: first[2], second[1]: second[2]})
    assert swept.performance.shape == (len(first[2]), len(second[2]))
    frame = swept.to_frame()
    assert list(frame.columns[:2]) == [first[1], second[1]] and len(frame) == swept.performance.range_km.size
    for row, ((i, a), (j, b)) in enumerate(itertools.product(enumerate(first[2]), enumerate(second[2]))):
        expected = evaluated((*first[:2], a), (*second[:2], b))
        assert_same_metrics(swept.performance[i, j], expected)
        assert frame.iloc[row, 0] == a and frame.iloc[row, 1] == b
        np.testing.assert_allclose(frame.total_mass_kg[row], expected.total_mass_kg, rtol=1e-12)


def test_sweep_changes_nothing_but_what_is_swept():
    model = rdk.Model(shear_scale=0.85)
    swept = rdk.sweep(RASHID, MARE, {"slope_deg": np.array([5.0, 10.0])}, model=model)
    assert_same_metrics(swept.performance[1], rdk.evaluate(RASHID, replace(MARE, slope_deg=10), model=model))
    assert MARE.slope_deg == 15 and not MARE.shape


@pytest.mark.parametrize("over, words", [
    ({}, "one or two fields"), (["slope_deg"], "over must be a dictionary"),
    ({"slope_deg": [1], "duty_cycle": [0.1], "shear_scale": [1]}, "one or two fields"),
    ({"slope": [1, 2]}, "Design, Scenario, Soil and Model have no field 'slope'; nearest are slope_deg"),
    ({"name": ["a", "b"]}, "no field 'name'"), ({"duration_earth_days": [7, 14]}, "duration_earth_days must be one"),
    ({"time_step_h": [0.5, 1]}, "time_step_h must be one number"), ({"slope_deg": 5.0}, "one-dimensional"),
    ({"slope_deg": [[1, 2], [3, 4]]}, "one-dimensional"), ({"slope_deg": []}, "one-dimensional"),
    ({"slope_deg": [0, 95]}, "slope_deg must be .*below 90.* at index 1"),
    ({"slope_deg": [0, math.nan]}, "nan"),
    ({"slope_deg": ["a"]}, "slope_deg")])
def test_bad_sweeps_are_named(over, words):
    with pytest.raises(ValueError, match=words):
        rdk.sweep(RASHID, MARE, over)


def test_sweep_refuses_populations_which_would_pair_up_in_silence():
    for bad in (dict(design=rdk.random_designs(2, seed=1)), dict(model=rdk.Model(shear_scale=[0.7, 1])),
                dict(scenario=replace(MARE, slope_deg=[1, 2]))):
        with pytest.raises(ValueError, match=f"{next(iter(bad))} must be a single one; got arrays of shape"):
            rdk.sweep(**(dict(design=RASHID, scenario=MARE) | bad), over={"duty_cycle": [0.1, 0.2]})


# ---- uncertainty ----------------------------------------------------------------------------------------

def row(name, low, high, kind="factor", distribution="uniform", minimum="", maximum=""):
    return dict(name=name, low=low, high=high, kind=kind, distribution=distribution, minimum=minimum,
                maximum=maximum)


def assert_same_bits(one, other):
    for name in ("nominal", "low", "median", "high"):
        for metric, value in getattr(one, name).items():
            np.testing.assert_array_equal(value, getattr(other, name)[metric], err_msg=metric)


def test_intervals_follow_the_seed_and_hold_their_order():
    found = rdk.intervals(RASHID, MARE, draws=200, seed=5)
    assert_same_bits(found, rdk.intervals(RASHID, MARE, draws=200, seed=5))
    other = rdk.intervals(RASHID, MARE, draws=200, seed=6)
    assert found.low["total_mass_kg"] != other.low["total_mass_kg"]
    inner = rdk.intervals(RASHID, MARE, draws=200, seed=5, level=0.5)
    for name in sampling.METRICS:
        nested = [end[name] for end in (found.low, inner.low, found.median, inner.high, found.high)]
        assert np.all(np.array(nested[1:]) >= nested[:-1]), name                    # an arrival may be at infinity
    assert_same_metrics(rdk.evaluate(RASHID, MARE), type("Nominal", (), dict(found.nominal)))
    assert found.draws.shape == (200,)
    frame = found.to_frame()
    assert list(frame.columns) == ["nominal", "low", "median", "high", "clamped"]
    assert set(frame.index) == set(sampling.METRICS)


def test_the_stated_share_of_draws_lies_inside():
    found = rdk.intervals(RASHID, MARE, draws=500, seed=1, level=0.8)
    inside = [(found.draws.total_mass_kg >= found.low["total_mass_kg"])
              & (found.draws.total_mass_kg <= found.high["total_mass_kg"])]
    assert abs(np.mean(inside) - 0.8) <= 1 / 500 + 1e-12        # a quantile of 500 draws splits one of them


def test_true_or_false_becomes_the_share_of_draws():
    weak = replace(RASHID, peak_wheel_torque_nm=0.45)
    found = rdk.intervals(weak, replace(MARE, slope_deg=18.0), draws=200)
    share = found.draws.stalled.mean()
    assert 0.05 < share < 0.95
    assert found.low["stalled"] == found.median["stalled"] == found.high["stalled"] == share


def test_intervals_of_a_population_are_those_of_its_designs():
    designs = rdk.random_designs(3, seed=4)
    found = rdk.intervals(designs, MARE, draws=40, seed=2)
    assert found.draws.shape == (40, 3)
    for i in range(3):
        alone = rdk.intervals(designs[i], MARE, draws=40, seed=2)
        for name in sampling.METRICS:
            np.testing.assert_allclose(found.low[name][i], alone.low[name], err_msg=name, **SAME)
            np.testing.assert_allclose(found.high[name][i], alone.high[name], err_msg=name, **SAME)


def test_a_linear_metric_has_the_interval_that_algebra_gives():
    # total mass is linear in the areal density of the array, whose factor is uniform on 0.5..1.5 here
    table = [row("solar_areal_density_kg_m2", 0.5, 1.5)]
    found = rdk.intervals(RASHID, MARE, draws=4000, seed=3, table=table)
    half, double = (rdk.evaluate(RASHID, MARE, model=rdk.Model(solar_areal_density_kg_m2=2.5 * f)).total_mass_kg
                    for f in (0.5, 1.5))
    width = double - half
    for value, share in ((found.low, 0.05), (found.median, 0.5), (found.high, 0.95)):
        # four standard errors of a quantile of 4,000 uniform draws
        tolerance = 4 * width * math.sqrt(share * (1 - share) / 4000)
        np.testing.assert_allclose(value["total_mass_kg"], half + share * width, atol=tolerance)
    assert found.low["range_km"] == found.high["range_km"] == found.nominal["range_km"]


def test_drawn_inputs_have_the_distribution_of_their_row():
    table = [row("shear_scale", 0.65, 1.35, distribution="normal", minimum="0.5"),
             row("friction_angle_deg", -3, 3, kind="offset", distribution="normal"),
             row("cohesion_kpa", 0.5, 1.5, maximum="0.2")]
    drawn = uncertain_inputs(MARE, draws=40_000, seed=1, table=table)
    assert list(drawn) == ["shear_scale", "friction_angle_deg", "cohesion_kpa"]
    # a normal row gives its 5 % and 95 % points; 40,000 draws settle them within 2 % of the half width
    np.testing.assert_allclose(np.quantile(drawn["shear_scale"], [0.05, 0.95]), [0.65, 1.35], atol=0.02)
    np.testing.assert_allclose(np.quantile(drawn["friction_angle_deg"], [0.05, 0.95]), [43, 49], atol=0.1)
    assert drawn["shear_scale"].min() == 0.5 and drawn["cohesion_kpa"].max() == 0.2
    uncut = drawn["cohesion_kpa"] < 0.2
    np.testing.assert_allclose(uncut.mean(), (0.2 / 0.17 - 0.5), atol=0.02)     # uniform on 0.085..0.255
    assert drawn["cohesion_kpa"].min() >= 0.085


def test_a_table_without_doubt_gives_the_nominal_value():
    table = [row("shear_scale", 1, 1), row("cohesion_kpa", 0, 0, "offset")]
    found = rdk.intervals(RASHID, MARE, draws=10, table=table)
    for end in (found.low, found.median, found.high):
        for name in sampling.METRICS:
            np.testing.assert_allclose(end[name], found.nominal[name], err_msg=name, **SAME)


def test_the_collections_own_table_draws_valid_inputs_for_every_soil():
    rows = catalog.rows("uncertainties.csv")
    for name in rdk.soil_names():
        scenario = replace(MARE, soil=rdk.soil(name))
        drawn = uncertain_inputs(scenario, draws=5000, seed=0)
        assert set(drawn) == {r["name"] for r in rows}
        # raises where a draw is not valid
        _, changed, model = sampling.replaced(RASHID, scenario, rdk.Model(), drawn)
        assert changed.shape == model.shape == (5000,)
        for r in rows:
            record = changed.soil if r["record"] == "soil" else model
            assert np.ptp(getattr(record, r["name"])) > 0


def test_buried_draws_are_left_out_of_percentiles():
    soil = replace(MARE.soil, frictional_modulus_kn_m_n2=2.0, cohesive_modulus_kn_m_n1=0.0)
    table = [row("frictional_modulus_kn_m_n2", 0.05, 20)]
    found = rdk.intervals(RASHID, replace(MARE, soil=soil), draws=100, table=table)
    share = found.draws.buried.mean()
    assert 0 < share < 1
    held = found.draws.sinkage_m[~found.draws.buried]
    np.testing.assert_allclose(found.median["sinkage_m"], np.median(held), rtol=1e-12)
    lost = replace(soil, frictional_modulus_kn_m_n2=0.01)
    table = [row("cohesion_kpa", 1, 1.1)]
    found = rdk.intervals(RASHID, replace(MARE, soil=lost), draws=20, table=table)
    assert np.isnan(found.high["sinkage_m"]) and found.high["range_km"] == 0 and found.low["buried"] == 1


def test_a_speed_without_limit_stays_infinite_downhill():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = rdk.intervals(RASHID, replace(MARE, slope_deg=-30.0), draws=50)
    assert found.nominal["energy_balance_speed_m_s"] == found.high["energy_balance_speed_m_s"] == math.inf
    assert found.median["range_km"] == 80


@pytest.mark.parametrize("changed, words", [
    (dict(draws=0), "draws must be a whole number, at least 1; got 0"), (dict(draws=2.5), "draws"),
    (dict(level=0), "level must be above 0 and below 1"), (dict(level=1), "level"),
    (dict(level=math.nan), "level"),
    (dict(table=[]), "table must hold at least one row"), (dict(seed=-1), "seed must be a whole number"),
    (dict(table="shear_scale"), "table must be a list of rows, each a dictionary with a name; got 'shear_scale'"),
    (dict(table=[row("albedo", 0.9, 1.1)]), "Soil and Model have no field 'albedo'"),
    (dict(table=[row("shear_scale", 0.9, 1.1, kind="percent")]), "shear_scale must be a factor, offset or value"),
    (dict(table=[row("shear_scale", 0.9, 1.1, distribution="beta")]), "got 'factor', 'beta'"),
    (dict(table=[row("shear_scale", -2, -1)]), "shear_scale must be positive"),
    (dict(table=[row("shear_scale", 1, 2) | {"weight": 0}]), "weight of shear_scale must be positive"),
    (dict(table=[row("shear_scale", 2, 1)]), "low of shear_scale must be at most high"),
    (dict(table=[row("shear_scale", "some", 1)]), "low of shear_scale must be a number; got 'some'"),
    (dict(model=rdk.Model(shear_scale=[1, 2])), r"model must be a single one; got arrays of shape \(2,\)"),
    (dict(scenario=replace(MARE, slope_deg=[1, 2])), "scenario must be a single one")])
def test_bad_intervals_are_named(changed, words):
    with pytest.raises(ValueError, match=words):
        rdk.intervals(**(dict(design=RASHID, scenario=MARE, draws=5) | changed))


# ---- odds ------------------------------------------------------------------------------------------------

def test_the_joint_share_is_that_of_draws_which_meet_all_demands():
    found = rdk.intervals(RASHID, MARE)
    wanted = [("range_km", ">=", 30), ("total_mass_kg", "<=", 16.5), ("feasible", ">=", 1)]
    holds = (found.draws.range_km >= 30) & (found.draws.total_mass_kg <= 16.5) & found.draws.feasible
    assert found.share(wanted) == holds.mean() and found.share([]) == 1
    each = [found.share([demand]) for demand in wanted]
    assert 0 < sum(each) - len(each) + 1 <= found.share(wanted) < min(each)      # Frechet's bounds
    designs = rdk.random_designs(4, seed=2)
    many = rdk.intervals(designs, MARE, draws=64)
    assert many.share(wanted).shape == (4,)
    assert many.share(wanted)[2] == rdk.intervals(designs[2], MARE, draws=64).share(wanted)
    for bad, words in ((("range", ">=", 3),), "nearest are range_km"), ((("slip", ">", 3),), "demands must be like"), \
            ((("slip", ">=", 1), ("slip", "<=", 0)), "demands contradict each other"):
        with pytest.raises(ValueError, match=words):
            found.share(bad)


def test_ends_that_are_clamps_or_stand_beside_an_atom_are_marked():
    found = rdk.intervals(RASHID, MARE)
    ranges, slopes = found.draws.range_km, found.draws.slope_capability_deg
    assert np.mean(ranges == 0) > 0.01 < np.mean(ranges == 80) and found.clamped["range_km"] == (True, True)
    assert np.mean(slopes >= 35) > 0.01 and found.clamped["slope_capability_deg"] == (False, True)
    for name in ("total_mass_kg", "wheel_torque_nm", "average_solar_power_w", "feasible", "obstacle_capability_m"):
        assert found.clamped[name] == (False, False), name
    frame = found.to_frame()
    assert frame.clamped["range_km"] == "low high" and frame.clamped["total_mass_kg"] == ""
    endless = rdk.intervals(RASHID, replace(MARE, traverse_limit_km=math.inf))
    assert endless.clamped["range_km"] == (True, False)
    many = rdk.intervals(rdk.random_designs(3, seed=1), MARE, draws=128)
    for i in range(3):
        alone = rdk.intervals(rdk.random_designs(3, seed=1)[i], MARE, draws=128)
        assert [bool(end[i]) for end in many.clamped["range_km"]] == [bool(end) for end in alone.clamped["range_km"]]


def test_ends_hardly_depend_on_the_seed():
    """The level that an end reaches scatters by at most 0.6 points, less than independent draws and than stated."""
    reached = {}
    settled = rdk.intervals(RASHID, MARE, draws=2**15, seed=99).draws
    for seed in range(20):
        found = rdk.intervals(RASHID, MARE, seed=seed)
        for name in ("total_mass_kg", "slope_capability_deg", "slip", "energy_balance_pct", "wheel_torque_nm"):
            for end, clamp in zip((found.low[name], found.high[name]), found.clamped[name]):
                if not clamp:
                    reached.setdefault((name, end > found.nominal[name]), []).append(
                        100 * np.mean(getattr(settled, name) <= end))
    assert len(reached) >= 7 and all(len(levels) == 20 for levels in reached.values())
    # a standard deviation of 20 is itself known to 16 %
    assert max(np.std(levels, ddof=1) for levels in reached.values()) < 0.7
    assert np.mean([np.std(levels, ddof=1) for levels in reached.values()]) < 0.5
    np.testing.assert_allclose(100 * found.error, 100 * math.sqrt(0.05 * 0.95 / 1024), rtol=1e-12)


def test_intervals_show_themselves_in_a_few_lines():
    found = rdk.intervals(RASHID, MARE, draws=64)
    assert len(repr(found)) < 1000 and "90 % intervals of 64 draws" in repr(found) and "2.7 points" in repr(found)
    assert "<table" in rdk.intervals(rdk.random_designs(60, seed=1), MARE, draws=8)._repr_html_()
    for result in rdk.sweep(RASHID, MARE, {"slope_deg": [0, 5]}), rdk.attribution(RASHID, TENACIOUS, MARE):
        assert len(repr(result)) < 2000 and "range_km" in repr(result) and "<table" in result._repr_html_()


# ---- the table of uncertainties --------------------------------------------------------------------------

def test_the_friction_angle_is_a_mixture_of_two_doubts():
    for soil, other in ("apollo-nominal", 35), ("apollo-loose", 27), ("sourcebook-trafficability", 35):
        own = rdk.soil(soil).friction_angle_deg
        drawn = uncertain_inputs(replace(MARE, soil=rdk.soil(soil)), draws=4096)["friction_angle_deg"]
        spread = 3 / 1.6448536
        # of a low-discrepancy sample of 4,096: some thousandths
        np.testing.assert_allclose(drawn.mean(), 0.75 * own + 0.25 * other, atol=0.02)
        np.testing.assert_allclose(drawn.var(), spread**2 + 0.75 * 0.25 * (own - other) ** 2, rtol=0.02)
    nominal = uncertain_inputs(MARE, draws=4096)["friction_angle_deg"]
    np.testing.assert_allclose(np.mean(nominal < 40.5), 0.25, atol=0.003)      # the gap between 35 and 46 deg


def test_a_mixture_and_a_condition_by_hand():
    table = [row("cohesion_kpa", 1, 2, "value") | {"weight": "0.2", "when": "from=0.1"},
             row("cohesion_kpa", 5, 6, "value") | {"weight": "0.2", "when": "below=0.1"},
             row("cohesion_kpa", 3, 4, "value") | {"weight": "0.6", "when": ""}]
    assert uncertain_names(table) == ["cohesion_kpa"]
    u = np.array([[0.0], [0.125], [0.2499], [0.25], [0.625], [1.0]])
    found = inputs_at(u, MARE, table=table)["cohesion_kpa"]
    np.testing.assert_allclose(found, [1, 1.5, 2, 3, 3.5, 4], atol=1e-3)       # weights 0.2 and 0.6: 1/4 and 3/4
    weak = replace(MARE, soil=replace(MARE.soil, cohesion_kpa=0.05))
    np.testing.assert_allclose(inputs_at(u, weak, table=table)["cohesion_kpa"][:3], [5, 5.5, 6], atol=1e-3)
    none = [row("cohesion_kpa", 1, 2, "value") | {"when": "from=9"}]
    assert (inputs_at(u, MARE, table=none)["cohesion_kpa"] == MARE.soil.cohesion_kpa).all()
    other = [row("cohesion_kpa", 1, 2, "value") | {"when": "kernel=imposed-arc"}]
    assert (inputs_at(u, MARE, table=other)["cohesion_kpa"] == MARE.soil.cohesion_kpa).all()
    assert inputs_at(u, MARE, model=rdk.Model(kernel="imposed-arc"), table=other)["cohesion_kpa"][-1] > 1.99
    with pytest.raises(ValueError, match="when of cohesion_kpa must be empty or from="):
        inputs_at(u, MARE, table=[row("cohesion_kpa", 1, 2) | {"when": "weekend"}])


def test_a_row_may_hold_numbers_and_leave_out_what_it_does_not_need():
    plain = dict(name="cohesion_kpa", kind="value", distribution="uniform", low=-1, high=1)
    u = np.array([[0.0], [0.25], [1.0]])
    np.testing.assert_allclose(inputs_at(u, MARE, table=[plain])["cohesion_kpa"], [-1, -0.5, 1], atol=1e-8)  # 2^-32
    cut = inputs_at(u, MARE, table=[plain | {"minimum": 0, "maximum": None}])
    np.testing.assert_allclose(cut["cohesion_kpa"], [0, 0, 1], atol=1e-8)


def test_a_lognormal_row_gives_its_5_and_95_percent_points():
    table = [row("shear_scale", 0.61, 1.64, distribution="lognormal")]
    drawn = uncertain_inputs(MARE, draws=4096, table=table)["shear_scale"]
    np.testing.assert_allclose(np.quantile(drawn, [0.05, 0.95]), [0.61, 1.64], rtol=0.01)
    np.testing.assert_allclose(np.log(drawn).std(), 0.30, rtol=0.01)
    with pytest.raises(ValueError, match="low and high of shear_scale must be positive"):
        uncertain_inputs(MARE, table=[row("shear_scale", 0, 1, distribution="lognormal")])


def test_draws_follow_the_seed_and_fill_every_input_evenly():
    drawn, again, other = (uncertain_inputs(MARE, seed=seed) for seed in (1, 1, 2))
    for name, values in drawn.items():
        np.testing.assert_array_equal(values, again[name])
        assert (values != other[name]).any() and values.shape == (1024,)
    with pytest.raises(ValueError, match="one column for each of shear_scale, .*; got shape .3, 2."):
        inputs_at(np.zeros((3, 2)), MARE)
    with pytest.raises(ValueError, match="scenario must be a single one"):
        uncertain_inputs(replace(MARE, soil=replace(MARE.soil, cohesion_kpa=[1, 2])))
    one = uncertain_inputs(MARE, draws=1)
    assert all(value.shape == (1,) for value in one.values())
    modulus = np.sort(drawn["frictional_modulus_kn_m_n2"]) / MARE.soil.frictional_modulus_kn_m_n2
    # uniform on 0.7 to 1.3: one in each of 1,024 equal steps
    np.testing.assert_allclose(modulus, 0.7 + 0.6 * (np.arange(1024) + 0.5) / 1024, atol=0.6 / 1024)


# ---- coverage of measured wheels -------------------------------------------------------------------------

def by_source(table, column):
    return table[column].groupby(table.experiment, sort=False).mean()


def test_the_spread_of_the_shear_scale_is_that_of_five_sources():
    points = interval_coverage()
    assert points.experiment.value_counts().to_dict() == {
        "yoshida-2003": 24, "ishigami-2005": 23, "ding-2011": 10, "wang-han-2016": 10, "hurrell-2025": 5}
    error = by_source(points.assign(square=np.log(points.shear_scale) ** 2), "square")
    np.testing.assert_allclose(np.sqrt(error.mean()), 0.30, atol=0.005)        # the table's, to two digits
    (own,) = [r for r in catalog.rows("uncertainties.csv") if r["name"] == "shear_scale"]
    np.testing.assert_allclose(np.log([float(own["low"]), float(own["high"])]) / 1.6448536, [-0.30, 0.30], atol=0.002)


def test_intervals_from_the_shear_scale_cover_sources_that_did_not_set_it():
    """Set on four sources and asked for the fifth: 86 % are covered in the mean, by 45 % of the load."""
    points = interval_coverage()
    error = by_source(points.assign(square=np.log(points.shear_scale) ** 2), "square")
    covered, width = {}, {}
    for source in error.index:
        left = interval_coverage(spread=np.sqrt(error.drop(source).mean()), experiments=(source,))
        covered[source] = left.inside.mean()
        width[source] = np.mean((left.high_n - left.low_n) / left.load_n)
    assert np.mean(list(covered.values())) >= 0.85 and np.mean(list(width.values())) <= 0.5
    # the doubt: four sources are covered whole, the fifth, whose soil values contradict its own plate tests, by 7 of 24
    assert min(covered, key=covered.get) == "yoshida-2003" and round(24 * covered["yoshida-2003"]) == 7
    assert sum(value == 1 for value in covered.values()) == 4
    # what the table prints
    assert by_source(points, "inside").mean() >= 0.9
    assert by_source(points.assign(width=(points.high_n - points.low_n) / points.load_n), "width").mean() <= 0.5


@pytest.mark.parametrize("kernel, factor", [("paper", 2.3), ("imposed-arc", 1.5)])
def test_the_interval_of_sinkage_is_wide_enough_on_soft_soil(kernel, factor):
    """14 of the 15 driven points of two tests, each test with the same weight; on dense soil it is far too narrow."""
    points = single_wheel(kernel=kernel).query("slip > 0 and sinkage_mm > 0")
    mission = replace(MARE, slope_deg=5.0)               # of another soil: the factor is on the model
    scale = uncertain_inputs(mission, model=rdk.Model(kernel=kernel))["sinkage_scale"]
    low, high = np.quantile(scale, [0.05, 0.95])
    np.testing.assert_allclose([low, high], [1 / factor, factor], rtol=0.01)
    inside = (points.sinkage_mm / points.model_sinkage_mm).between(low, high).groupby(points.experiment).mean()
    assert inside[["ding-2011", "hurrell-2025"]].mean() >= 0.9 and inside["wang-han-2016"] < 0.5
    one = [r for r in catalog.rows("uncertainties.csv") if r["name"] == "sinkage_scale"]
    found = rdk.intervals(RASHID, mission, model=rdk.Model(kernel=kernel), table=one)
    np.testing.assert_allclose(np.array([found.low["sinkage_m"], found.high["sinkage_m"]]) / found.nominal["sinkage_m"],
                               [1 / factor, factor], rtol=0.01)
    assert found.low["range_km"] == found.high["range_km"] == found.nominal["range_km"]


def test_coverage_counts_points_inside_and_widens_with_the_level():
    wide, narrow = interval_coverage(level=0.9), interval_coverage(level=0.2)
    by_hand = (wide.measured_n >= wide.low_n) & (wide.measured_n <= wide.high_n)
    assert wide.inside.equals(by_hand) and narrow.inside.sum() < wide.inside.sum()
    assert (wide.high_n - wide.low_n > narrow.high_n - narrow.low_n).all()
    points = single_wheel().query("slip > 0")
    known = wide[wide.experiment.isin(points.experiment.unique())]
    # the same kernel, in batches of another length: last bits may differ; the order is that of the file
    np.testing.assert_allclose(known.nominal_n, points.model_drawbar_pull_n, rtol=1e-9)
    one = interval_coverage(draws=1)
    assert np.array_equal(one.low_n, one.high_n) and not one.inside.any(), "one draw has no width"
    lane = wide.iloc[3]
    (found,) = interval_coverage(spread=abs(np.log(lane.shear_scale)) / 1.6448536 * 1.02, experiments=[
        lane.experiment]).query("measured_n == @lane.measured_n and slip == @lane.slip").inside
    assert found, "the scale that meets a point is the end of the interval that just holds it"
    with pytest.raises(ValueError, match="experiments: no single-wheel test 'ding'; nearest are ding-2011"):
        interval_coverage(experiments=("ding",))


# ---- attribution ----------------------------------------------------------------------------------------

@pytest.fixture(scope="module")
def why():
    return rdk.attribution(RASHID, TENACIOUS, MARE)


def size(why, name):
    """How large a metric is, to judge what is left by rounding."""
    return max(abs(float(getattr(p, name))) for p in (why.performance, why.baseline_performance)) or 1.0


def test_attribution_adds_up_for_every_metric(why):
    assert set(why.contributions) == set(sampling.METRICS) - {"arrival_h"}          # some mixtures never arrive
    for name, shares in why.contributions.items():
        difference = float(getattr(why.performance, name)) - float(getattr(why.baseline_performance, name))
        # 2,048 roundings of values of this size
        np.testing.assert_allclose(shares.sum(), difference, atol=1e-13 * size(why, name), err_msg=name)
    assert_same_metrics(why.performance, rdk.evaluate(RASHID, MARE))
    assert_same_metrics(why.baseline_performance, rdk.evaluate(TENACIOUS, MARE))
    assert list(why.to_frame().index) == list(rdk.DESIGN_SPACE)


def test_a_variable_that_nothing_reads_gets_nothing(why):
    assert RASHID.wheelbase_m != TENACIOUS.wheelbase_m
    same = [name for name in rdk.DESIGN_SPACE if getattr(RASHID, name) == getattr(TENACIOUS, name)]
    assert "wheel_count" in same
    for metric, shares in why.to_frame().loc[["wheelbase_m", *same]].items():
        if metric in ("wheel_gap_m", "tip_over_deg"):    # they do read the wheelbase
            continue
        # what is left is what a lane's place in a batch moves
        np.testing.assert_allclose(shares, 0, atol=1e-9 * size(why, metric), err_msg=metric)


def test_exchanging_the_designs_changes_the_sign(why):
    back = rdk.attribution(TENACIOUS, RASHID, MARE)
    for name, shares in why.contributions.items():
        tolerance = 1e-9 * size(why, name)
        np.testing.assert_allclose(back.contributions[name], -shares, atol=tolerance, err_msg=name)


def test_a_design_against_itself_has_no_contributions():
    for name, shares in rdk.attribution(RASHID, RASHID, MARE).contributions.items():
        value = getattr(rdk.evaluate(RASHID, MARE), name)
        np.testing.assert_allclose(shares, 0, atol=1e-12 * max(abs(value), 1), err_msg=name)


def test_variables_that_do_the_same_get_the_same():
    # 12 Wh of battery at 120 Wh/kg weigh 0.1 kg, as do 0.04 m2 of array and 2 W of avionics
    heavier = replace(RASHID, battery_capacity_wh=RASHID.battery_capacity_wh + 12,
                                  solar_area_m2=RASHID.solar_area_m2 + 0.04,
                                  avionics_power_w=RASHID.avionics_power_w + 2)
    shares = rdk.attribution(heavier, RASHID, MARE).to_frame().total_mass_kg
    expected = (rdk.evaluate(heavier, MARE).total_mass_kg - rdk.evaluate(RASHID, MARE).total_mass_kg) / 3
    for name in ("battery_capacity_wh", "solar_area_m2", "avionics_power_w"):
        np.testing.assert_allclose(shares[name], expected, rtol=1e-10)         # rounding of 2,048 terms


def test_a_known_attribution_saves_the_mixtures_that_both_have(why, monkeypatch):
    counts, real = [], sampling.evaluate

    def counted(design, *given, **options):
        counts.append(len(design))
        return real(design, *given, **options)

    monkeypatch.setattr(sampling, "evaluate", counted)
    wider = RASHID.replace(wheel_width_m=0.11)
    near, alone = (rdk.attribution(wider, TENACIOUS, MARE, known=known) for known in (why, None))
    assert counts[0] == counts[1] // 2 + 1               # the half with the moved variable, and the baseline itself
    for name, shares in alone.contributions.items():     # to the rounding of sums and of a lane's place in its block
        np.testing.assert_allclose(near.contributions[name], shares, rtol=1e-12, atol=1e-12)
    assert near.performance.range_km == alone.performance.range_km
    # of another mission, or where other variables differ, nothing is taken over
    for design, mission in (wider, MARE.replace(slope_deg=3.0)), (TENACIOUS.replace(wheel_width_m=0.11), MARE):
        again, plain = (rdk.attribution(design, TENACIOUS, mission, known=known) for known in (why, None))
        np.testing.assert_allclose(again.contributions["range_km"], plain.contributions["range_km"], rtol=1e-12)
    with pytest.raises(TypeError, match="known must be an? Attribution"):
        rdk.attribution(wider, TENACIOUS, MARE, known="x")


def test_attribution_equals_the_mean_over_all_orders():
    names = ["wheel_radius_m", "grouser_count", "chassis_mass_kg", "solar_area_m2"]
    far = dict(wheel_radius_m=0.05, grouser_count=2, chassis_mass_kg=20.0, solar_area_m2=0.12)
    design = replace(RASHID, **far)
    steep = replace(MARE, slope_deg=8.0)
    value = {}
    for number in range(5):
        for chosen in itertools.combinations(names, number):
            mixed = replace(RASHID, **{name: far[name] for name in chosen})
            value[frozenset(chosen)] = metrics(rdk.evaluate(mixed, steep))
    orders = list(itertools.permutations(names))
    expected = {(name, metric): 0.0 for name in names for metric in sampling.METRICS}
    for order in orders:
        for i, name in enumerate(order):
            before, after = value[frozenset(order[:i])], value[frozenset(order[:i + 1])]
            for metric in set(sampling.METRICS) - {"arrival_h"}:       # infinite: it has no differences
                expected[name, metric] += (after[metric] - before[metric]) / len(orders)
    why = rdk.attribution(design, RASHID, steep)
    frame = why.to_frame()
    for (name, metric), share in expected.items():
        if metric == "arrival_h":
            continue
        tolerance = 1e-9 * size(why, metric)
        np.testing.assert_allclose(frame[metric][name], share, atol=tolerance, err_msg=f"{name} {metric}")
    assert abs(frame.slope_capability_deg[names]).min() > 0.01      # the game is not a trivial one
    alone, before = (value[frozenset(names)]["slope_capability_deg"] for names in (["grouser_count"], []))
    assert abs(frame.slope_capability_deg["grouser_count"] - (alone - before)) > 0.01


@pytest.mark.parametrize("baseline, differ", [
    (replace(TENACIOUS, wheel_count=6), 11), (TENACIOUS, 10), (replace(RASHID, wheel_radius_m=0.12), 1), (RASHID, 0)])
def test_attribution_is_one_call_of_all_mixtures_of_what_differs(monkeypatch, baseline, differ):
    sizes = []

    def counted(design, *rest, **options):
        sizes.append(design.shape)
        return rdk.evaluate(design, *rest, **options)

    monkeypatch.setattr(sampling, "evaluate", counted)
    shares = sampling.attribution(RASHID, baseline, MARE).contributions["total_mass_kg"]
    assert sizes == [(2**differ,)] and shares.shape == (11,)


def test_attribution_leaves_out_a_metric_that_is_no_number():
    soft = replace(MARE.soil, frictional_modulus_kn_m_n2=30.0, cohesive_modulus_kn_m_n1=0.0)
    heavy = replace(RASHID, chassis_mass_kg=45.0, wheel_width_m=0.04)
    why = rdk.attribution(heavy, RASHID, replace(MARE, soil=soft))
    assert why.performance.buried and not why.baseline_performance.buried
    assert "sinkage_m" not in why.contributions and why.contributions["buried"].sum() == pytest.approx(1)


@pytest.mark.parametrize("name", ["design", "baseline", "scenario", "model"])
def test_attribution_refuses_populations(name):
    many = dict(design=rdk.random_designs(2, seed=1), baseline=rdk.random_designs(2, seed=1),
                scenario=replace(MARE, slope_deg=[1, 2]), model=rdk.Model(shear_scale=[0.7, 1]))
    arguments = dict(design=RASHID, baseline=TENACIOUS, scenario=MARE) | {name: many[name]}
    with pytest.raises(ValueError, match=rf"{name} must be a single one; got arrays of shape \(2,\)"):
        rdk.attribution(**arguments)
