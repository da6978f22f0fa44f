"""Rules read off fronts, families, sensitivities and rediscovery, at small budgets."""

import dataclasses
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose

import rediscovery
import rules
import searches
import sensitivity

import rdk
from rdk import catalog, tradespace

MARE, HIGHLAND = rdk.scenario("equatorial_mare_traverse"), rdk.scenario("highland_slope_capability")
NAMES = rdk.scenario_names("canonical")
CUBE_PAIR = 1.128                                        # mean distance of two points of the 8-D unit cube


@pytest.fixture(scope="module")
def front():
    return tradespace.pareto_front(MARE, population=20, generations=10, seed=3)


def search(designs, scenario=MARE, history=()):
    """A Front of given designs, without a search."""
    performance = rdk.evaluate(designs, scenario)
    return tradespace.Front(designs, performance, scenario, rdk.Model(), scenario.problem, history)


# ---- statistics of fronts ----------------------------------------------------------------------------------

def test_statistics_by_hand():
    """Three designs whose shares and medians can be counted."""
    designs = dataclasses.replace(
        rdk.random_designs(3, seed=1), wheel_radius_m=[0.20, 0.1986, 0.10],
        wheel_width_m=[0.03, 0.0316, 0.0380], wheel_count=[4, 4, 6], battery_capacity_wh=[5, 50, 500],
        grouser_count=[24, 23, 24],
        grouser_height_m=[0.02, 0.0197, 0.0199])
    row = rules.front_statistics([search(designs, history=(np.zeros((0, 3)),))]).iloc[0]
    performance = rdk.evaluate(designs, MARE)
    assert_allclose([row.four_wheels, row.radius_at_ceiling, row.width_at_floor], 2 / 3, rtol=1e-12)
    assert row.width_lowest_5pct == 1 and row.battery_median_wh == 50
    assert_allclose([row.grouser_count_at_ceiling, row.grouser_height_at_ceiling], 2 / 3, rtol=1e-12)
    mass = rdk.evaluate(designs, MARE).total_mass_kg
    assert (row.mass_min_kg, row.mass_max_kg) == (mass.min(), mass.max())
    assert row.slope_median_deg == np.median(performance.slope_capability_deg)
    assert (row.designs, row.generations, row.seed, row.scenario) == (3, 1, 13, MARE.name)


def test_an_empty_front_has_a_row_without_numbers(front):
    empty = dataclasses.replace(front, designs=front.designs[:0], performance=front.performance[:0])
    table = rules.front_statistics([front, empty])
    assert list(table.designs) == [len(front), 0] and np.isnan(table.four_wheels[1])


@pytest.mark.parametrize("call, words", [
    (lambda f: rules.front_statistics("x"), r"fronts\[0\] must be a Front; got 'x'"),
    (lambda f: rules.front_statistics([f, f.designs]), r"fronts\[1\] must be a Front; got Design"),
    (lambda f: rules.front_statistics([]), "fronts must hold at least one Front"),
    (lambda f: rules.front_statistics({"mare": f}), r"fronts\[0\] must be a Front; got 'mare'"),
    (lambda f: rules.crossover("x"), "statistics must be a table of front_statistics; it has no column scenario, obst"),
    (lambda f: rules.dominated("x", [f]), "front must be a Front"), (lambda f: rules.dominated(f, "x"), r"others\[0\]"),
    (lambda f: rules.place("x", "wheelbase_m"), "designs must be a Design"),
    (lambda f: rules.place(f.designs, "wheel_base"), "no design variable 'wheel_base'; nearest are wheelbase_m"),
    (lambda f: rules.place(f.designs, []), "no design variable"),
    (lambda f: rules.ballasted(f.designs, MARE, "heavy"), "total_mass_kg must be positive .*'heavy'"),
    (lambda f: rules.ballasted(f.designs, MARE, np.nan), "total_mass_kg"),
    (lambda f: rules.swapped(f.designs, wheelbase_m=0.7), "front must be a Front"),
    (lambda f: rules.swapped(f, wheel_base=0.7), "Design has no field 'wheel_base'; nearest are wheelbase_m"),
    (lambda f: rediscovery.unit_cube("x"), "designs must be a Design"),
    (lambda f: rediscovery.rediscover([]), "rovers must not be empty"),
    (lambda f: rediscovery.rediscover(3), r"rovers\[0\] must be a str; got int"),
    (lambda f: rediscovery.rediscover("Pragyan", generations=()), "generations must not be empty"),
    (lambda f: rediscovery.rediscover("Pragyan", generations=(0,)), "generations must be a whole number, at least 1"),
    (lambda f: rediscovery.rediscover("Pragyan", seeds=["a"]), "seeds must be a whole number"),
    (lambda f: rediscovery.baselines("x"), "found must be a table of rediscover; it has no column rover, front_"),
    (lambda f: sensitivity.sobol(MARE, metrics=[]), "metrics: no Performance field"),
    (lambda f: sensitivity.sobol(MARE, design=rdk.random_designs(3, seed=1)), "design must be a single one"),
    (lambda f: sensitivity.sobol("mare"), "scenario must be a Scenario"),
    (lambda f: sensitivity.family(NAMES[0], 2, seed="x"), "seed must be a whole number")])
def test_what_is_no_front_design_or_table_is_refused_by_name(front, call, words):
    with pytest.raises((ValueError, TypeError), match=words):
        call(front)


def test_one_front_alone_will_do_and_none_beats_nobody(front):
    assert rules.front_statistics(front).equals(rules.front_statistics([front]))
    assert not rules.dominated(front, []).any()


def test_generations_of_one_search_are_those_of_shorter_searches():
    both = rediscovery.rediscover("Pragyan", population=20, seeds=[3], generations=[4, 10])
    short = rediscovery.rediscover(["Pragyan"], population=20, seeds=[3], generations=[4])
    assert list(both.generations) == [4, 10]
    # the same bits: the search does not know how long it will last
    assert both.iloc[0].to_dict() == short.iloc[0].to_dict()


def test_crossover_is_the_lowest_height_with_six_wheels():
    fronts = searches.fronts([MARE], obstacle_heights_m=(0, 0.08, 0.12), population=20, generations=5)
    found = rules.crossover(rules.front_statistics(fronts.values())).iloc[0]
    assert found.crossover_m == 0.12, "a rigid wheel of at most 0.20 m climbs 0.10 m"
    assert found.highest_rigid_m == 0.08


# ---- what a variable is worth ------------------------------------------------------------------------------

@settings(max_examples=25, deadline=None)
@given(st.floats(25, 150), st.integers(0, 10_000))
def test_ballast_reaches_the_mass_and_touches_the_chassis_alone(mass_kg, seed):
    designs = rdk.random_designs(20, seed=seed)
    found = rules.ballasted(designs, MARE, mass_kg)
    masses = rules.mass_of(found, MARE, rdk.Model()).total_kg
    light = found.chassis_mass_kg == rdk.DESIGN_SPACE["chassis_mass_kg"].low
    # a linear equation solved in floating point
    assert_allclose(masses[~light], mass_kg, rtol=1e-12)
    assert (masses[light] >= mass_kg * (1 - 1e-12)).all()
    for name in rdk.DESIGN_SPACE:
        if name != "chassis_mass_kg":
            assert np.array_equal(getattr(found, name), getattr(designs, name))


def test_ballast_of_one_design_is_that_of_the_population():
    designs = rdk.random_designs(5, seed=2)
    one, many = rules.ballasted(designs[3], MARE, 60.0), rules.ballasted(designs, MARE, 60.0)
    assert one.chassis_mass_kg == many.chassis_mass_kg[3]


def test_swapping_a_variable_for_itself_changes_nothing(front):
    table = rules.swapped(front, wheelbase_m=0.7)        # no sub-model reads the wheelbase
    # the chassis is solved for anew: rounding
    assert_allclose(table[["range_change_km", "mass_change_kg", "slope_change_deg"]], 0, atol=1e-9)
    assert np.array_equal(table.old_wheelbase_m, front.designs.wheelbase_m)


def test_swapping_moves_what_the_variable_moves(front):
    small = rules.swapped(front, wheel_radius_m=0.05)
    assert small.slope_change_deg.max() < 0, "a small wheel climbs less at equal mass"


@pytest.mark.filterwarnings("error")
def test_swapping_is_quiet_where_the_ballast_leaves_the_class():
    heavy = dataclasses.replace(rdk.random_designs(1, seed=3), chassis_mass_kg=50.0, battery_capacity_wh=500.0)
    table = rules.swapped(search(heavy), battery_capacity_wh=5.0)
    assert abs(table.mass_change_kg[0]) < 1e-9


def test_dominated_by_hand():
    designs = rdk.random_designs(1, seed=5)
    lighter = dataclasses.replace(designs, wheelbase_m=[0.5], chassis_mass_kg=designs.chassis_mass_kg)
    mine, other = search(designs), search(lighter)
    assert not rules.dominated(mine, [other]).any(), "equal objectives do not dominate"
    better = dataclasses.replace(other, performance=dataclasses.replace(
        other.performance, total_mass_kg=other.performance.total_mass_kg - 1))
    assert rules.dominated(mine, [other, better]).all() and not rules.dominated(better, [mine]).any()
    worse = dataclasses.replace(better, performance=dataclasses.replace(
        better.performance, range_km=better.performance.range_km - 1, total_mass_kg=[0.0]))
    assert not rules.dominated(mine, [worse]).any(), "better in one objective, worse in another"


@pytest.mark.parametrize("name", NAMES)
def test_a_front_does_not_hang_on_the_last_bits(monkeypatch, name):
    """Processors round differently, which must not decide between designs that differ only in the wheelbase."""
    random, evaluate = np.random.default_rng(1), tradespace.evaluate

    def on_another_machine(*arguments, **options):
        result = evaluate(*arguments, **options)
        blur = {field: np.asarray(getattr(result, field)) * (1 + 1e-15 * random.standard_normal(result.shape))
                for field in ("range_km", "total_mass_kg", "slope_capability_deg")}
        return dataclasses.replace(result, **blur)

    here = tradespace.pareto_front(rdk.scenario(name), generations=40)
    monkeypatch.setattr(tradespace, "evaluate", on_another_machine)
    there = tradespace.pareto_front(rdk.scenario(name), generations=40)
    assert len(here) == len(there)
    for variable in rdk.DESIGN_SPACE:
        # the front is in the order of mass, and equal masses may change places: compare the sets
        one, other = (np.sort(getattr(front.designs, variable)) for front in (here, there))
        assert_allclose(one, other, rtol=1e-12)


# ---- families ----------------------------------------------------------------------------------------------

@pytest.mark.parametrize("name", NAMES)
def test_family_spans_its_ranges(name):
    found = sensitivity.family(name, 8, seed=4)
    row = next(row for row in catalog.rows("scenarios.csv") if row["scenario"] == name)
    columns = dict(latitude_deg="latitude_deg", duration_earth_days="duration_days", slope_deg="slope_deg")
    for field, column in columns.items():
        low, high = map(float, row["family_" + column].split(".."))
        values = np.sort([getattr(s, field) for s in found])
        edges = np.linspace(low, high, 9)
        assert ((values >= edges[:-1]) & (values <= edges[1:])).all(), "one in each eighth: a Latin hypercube"
    assert all(s.panel_tilt_deg == min(80, abs(s.latitude_deg)) for s in found)
    assert all(s.panel_azimuth_deg == (0 if s.latitude_deg < 0 else 180) for s in found)
    base = rdk.scenario(name)
    assert all(s.soil == base.soil and s.problem == base.problem for s in found)
    assert len({s.name for s in found}) == 8 and sensitivity.family(name, 8, seed=4) == found


def test_family_refuses_what_has_none():
    with pytest.raises(ValueError, match="'mare_micro' has no family; choose from equatorial_mare_traverse"):
        sensitivity.family("mare_micro", 3)
    with pytest.raises(ValueError, match="count must be"):
        sensitivity.family(NAMES[0], 0)


# ---- sensitivities -----------------------------------------------------------------------------------------

def test_sobol_indices_of_mass_are_those_of_a_sum():
    """The dry mass is nearly a sum over the variables: first and total order agree and add up to 1."""
    table = sensitivity.sobol(MARE, metrics=("total_mass_kg",), count=512).set_index("input")
    # 512 points of a quasi-random sequence: indices are good to some hundredths
    assert_allclose(table.first_order.sum(), 1, atol=0.05)
    assert_allclose(table.total_order, table.first_order, atol=0.05)
    assert table.total_order.idxmax() == "chassis_mass_kg"
    assert table.total_order["wheelbase_m"] == 0, "no sub-model reads the wheelbase"
    assert (table.total_low <= table.total_high).all()
    # a bootstrap of the estimate: it holds the estimate itself in all but a freak case
    assert (table.total_low <= table.total_order * 1.02).all()
    assert (table.total_high * 1.02 >= table.total_order).all()


def test_sobol_index_of_the_chassis_against_the_variance_itself():
    """S_1 = Var(E[m | m_c]) / Var(m): the mass is linear in the chassis, so that variance is known."""
    table = sensitivity.sobol(MARE, metrics=("total_mass_kg",), count=1024).set_index("input")
    designs = rdk.random_designs(100_000, seed=1)
    mass = rules.mass_of(designs, MARE, rdk.Model()).total_kg
    slope = 1.2 * 1.05 * 1.08 * (1 + 0.08 / 2)           # half of the designs pay for a linkage
    expected = (slope * 49.5) ** 2 / 12 / mass.var()
    assert_allclose(table.first_order["chassis_mass_kg"], expected, atol=0.02)      # sampling error


def test_sobol_over_uncertainties_knows_what_moves_what():
    table = sensitivity.sobol(MARE, design=rdk.rover("Rashid-1"), count=256)
    names = [row["name"] for row in catalog.rows("uncertainties.csv")]
    assert set(table.input) == set(names) and len(table) == 3 * len(set(names))
    slope = table.query("metric == 'slope_capability_deg'").set_index("input").total_order
    # the array does not touch the wheel: what is left is rounding
    assert slope.idxmax() == "shear_scale" and abs(slope["dust_factor"]) < 1e-12
    again = sensitivity.sobol(MARE, design=rdk.rover("Rashid-1"), count=256)
    assert again.equals(table), "same seed, same bits"


def test_sobol_refuses_nonsense():
    with pytest.raises(ValueError, match="count must be a power of 2; got 100"):
        sensitivity.sobol(MARE, count=100)
    with pytest.raises(ValueError, match="no Performance field 'speed'; nearest are"):
        sensitivity.sobol(MARE, metrics=("speed",))


# ---- rediscovery -------------------------------------------------------------------------------------------

@pytest.fixture(scope="module")
def found():
    return rediscovery.rediscover(["Rashid-1", "Pragyan"], population=12, generations=(3, 6), seeds=(0, 1))


def test_distance_by_hand(found):
    """Eight coordinates, each over its range."""
    row = found.iloc[1]
    assert (row.rover, row.generations, row.scenario) == ("Rashid-1", 6, "mare_micro")
    rover, squares = rdk.rover("Rashid-1"), 0.0
    for name in ("wheel_radius_m", "wheel_width_m", "grouser_height_m", "chassis_mass_kg", "solar_area_m2",
                 "battery_capacity_wh", "avionics_power_w", "peak_wheel_torque_nm"):
        low, high = rdk.DESIGN_SPACE[name][:2]
        squares += ((getattr(rover, name) - getattr(row.nearest, name)) / (high - low)) ** 2
    assert_allclose(row.distance, squares**0.5, rtol=1e-12)      # the same arithmetic
    assert row.distance <= row.distance_worst_seed
    assert_allclose(row.ceiling_kg, 1.1 * row.mass_kg, rtol=1e-12)


def test_ceiling_holds_and_the_payload_is_the_rovers_own(found):
    for row in found[found.front_designs > 0].itertuples():
        scenario = dataclasses.replace(rdk.scenario(row.scenario), payload_mass_kg=float(
            rediscovery.rover_row(row.rover)["payload_mass_kg"]))
        assert rdk.evaluate(rdk.rover(row.rover), scenario).total_mass_kg == row.mass_kg
        assert rdk.evaluate(row.nearest, scenario).total_mass_kg <= row.ceiling_kg * (1 + 1e-12)


def test_search_is_the_same_in_parallel_and_in_one_go(found):
    with ThreadPoolExecutor(2) as executor:
        again = rediscovery.rediscover(["Rashid-1", "Pragyan"], population=12, generations=(6,), seeds=(0, 1),
                                  executor=executor)
    assert list(again.distance) == list(found.query("generations == 6").distance)


def test_a_front_without_designs_is_a_row_without_a_distance():
    row = rediscovery.rediscover(["Tenacious"], population=4, generations=(1,), seeds=(0,)).iloc[0]
    assert row.front_designs == 0 and np.isnan(row.distance) and not row.dominated


def test_rediscovery_refuses_an_unknown_rover():
    with pytest.raises(ValueError, match="the check has no rover 'Spirit'; choose from Tenacious"):
        rediscovery.rediscover(["Spirit"])


def test_baselines(found):
    table = rediscovery.baselines(found.query("generations == 6"), count=1000).set_index("rover")
    # the mean of 200,000 pairs of 1,000 points: the points' own scatter is a percent
    assert_allclose(table.random_pair, CUBE_PAIR, rtol=0.02)
    assert table.feasible_fraction.between(0.7, 0.95).all()
    assert (table.feasible_pair < table.random_pair).all()
    assert (table.nearest_capped_low <= table.nearest_capped).all()
    # more chances, nearer
    more = found.query("generations == 6").assign(front_designs=500)
    assert (rediscovery.baselines(more, count=1000).nearest_feasible.to_numpy()
            < table.nearest_feasible.to_numpy()).all()


@pytest.mark.parametrize("name", ["Tenacious", "Rashid-1", "Yutu-2"])
def test_light_designs_are_uniform_in_the_light_part_of_the_space(name):
    """Against plain rejection: drawn from the whole box, kept where light enough, the means are the same."""
    target = rediscovery.Target.of(name)
    found = rediscovery.lighter_than(target, 500, seed=1)
    assert (rules.mass_of(found, target.scenario, rdk.Model()).total_kg <= target.ceiling_kg).all()
    designs = rdk.random_designs(400_000, seed=2)
    plain = designs[rules.mass_of(designs, target.scenario, rdk.Model()).total_kg <= target.ceiling_kg]
    if len(plain) > 300:
        one, other = rediscovery.unit_cube(found), rediscovery.unit_cube(plain)
        error = np.sqrt(one.var(0) / len(one) + other.var(0) / len(other))
        assert (abs(one.mean(0) - other.mean(0)) < 4 * error).all()        # four standard errors
    else:
        assert len(found) > len(plain), "the smaller box finds light designs where plain rejection starves"
