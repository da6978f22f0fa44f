"""The ledger of the paper's numbers: every row computed, none typed in; its searches at small budgets."""

import math
from concurrent.futures import Executor, Future

import numpy as np
import pytest
from numpy.testing import assert_allclose

import ledger as paper
import rdk
from rdk import catalog

TARGETS = catalog.table("paper_targets.csv").set_index("id")
DETERMINISTIC = TARGETS.index[TARGETS.kind == "deterministic"]
COST = TARGETS.index[TARGETS.kind == "cost"]


class Recorder(Executor):
    """Runs everything at once, here, and keeps what it was given."""

    def __init__(self):
        self.cases = []

    def submit(self, function, *arguments, **options):
        self.cases += arguments
        future = Future()
        future.set_result(function(*arguments, **options))
        return future


def small_searches(**options):
    """A tenth of the paper's budget."""
    return paper.Searches(population=10, generations=4, **options)


@pytest.fixture(scope="module")
def ledger():
    return paper.paper_ledger(("deterministic",), small_searches()).set_index("id")


@pytest.mark.parametrize("name", DETERMINISTIC)
def test_every_deterministic_number_is_inside_its_band(ledger, name):
    assert ledger.agrees[name] == True, ledger.loc[name].to_dict()          # noqa: E712, NA is not True


def test_ledger_has_one_row_for_every_target(ledger):
    assert list(ledger.index) == list(DETERMINISTIC)
    assert list(ledger.reset_index().columns) == ["id", "section", "quantity", "paper", "ours", "agrees",
                                                  "why"]
    assert (ledger.section == TARGETS.paper_section[DETERMINISTIC]).all()
    assert all(isinstance(why, str) for why in ledger.why)


def test_our_numbers_do_not_come_from_the_bands(monkeypatch, ledger):
    """With the paper's values and bands replaced, ours stay and every row but the reports disagrees."""
    real = catalog.table

    def other(name):
        table = real(name)
        return table.assign(accept="-9..-8", paper_value="?") if name == "paper_targets.csv" else table

    monkeypatch.setattr(catalog, "table", other)
    again = paper.paper_ledger(("deterministic",), small_searches()).set_index("id")
    assert not again.agrees.any()
    assert [str(x) for x in again.ours] == [str(x) for x in ledger.ours]


def test_a_changed_measurement_changes_its_row(monkeypatch):
    real = catalog.table

    def other(name):
        table = real(name)
        return table.assign(drawbar_pull_n=table.drawbar_pull_n * 2) if name == "single_wheel.csv" else table

    monkeypatch.setattr(catalog, "table", other)
    table = paper.paper_ledger(sections=["terramechanics validation"]).set_index("id")
    assert not table.agrees["dp_ding"]


def test_ledger_refuses_an_unknown_kind():
    with pytest.raises(ValueError, match="deterministic, stochastic, cost; got 'guessed'"):
        paper.paper_ledger(kinds=("guessed",))
    with pytest.raises(ValueError, match=r"kinds must be a list such as \['deterministic'\]; got 'cost'"):
        paper.paper_ledger(kinds="cost")
    with pytest.raises(ValueError, match="sections must be among terramechanics validation, .*; got 'weather'"):
        paper.paper_ledger(sections=["weather"])


def test_ledger_of_one_section():
    table = paper.paper_ledger(("deterministic",), sections=["flown rovers"])
    assert set(table.section) == {"flown rovers"} and len(table) == 8


def test_a_wrong_model_changes_the_rows_that_rest_on_it_and_no_other(ledger):
    searches = small_searches(model=rdk.Model(motor_base_mass_kg=0.3))
    wrong = paper.paper_ledger(("deterministic",), searches).set_index("id")
    lost = wrong.index[ledger.agrees & ~wrong.agrees]
    assert len(lost) > 5 and all(name.startswith("mass_") for name in lost)


@pytest.mark.parametrize("accept, inside, outside", [
    ("26.5..27.7", [26.5, 27.0, 27.7, (26.6, 27.6)], [26.4, 27.8, (26.0, 27.0), math.nan]),
    ("max 80; min < 8", [(0.9, 80.0), [7.9, 80]], [(0.9, 79.0), (8.0, 80.0)]),
    ("max 25; min 8.4..10.0", [(9.0, 25.0)], [(8.0, 25.0), (10.1, 25.0)]),
    ("min 9.0..10.6", [(9.6, 55.0), 9.6], [(8.0, 55.0)]),
    (">= 98", [98, 100.0, (98, 99)], [97.9, (97, 99)]),
    ("<= 0.20", [0.2, 0.11], [0.21]),
    ("< 2 or a stated disagreement", [1.3], [2.0, 3.0]),
    ("100", [100, 100.0], [99.5]),
    ("False", [False, np.False_], [True, 0.0, "False"]),
    ("True", [True], [False, 1.0]),
    ("infeasible", ["infeasible"], ["feasible", 3.0]),
    ("-9..-8", [-8.5], [8.5, True]),
])
def test_bands_are_read(accept, inside, outside):
    assert all(paper.accepts(accept, value) is True for value in inside)
    assert not any(paper.accepts(accept, value) for value in outside)


def test_bands_that_ask_only_for_a_report_and_bands_that_cannot_be_read():
    assert paper.accepts("report ours beside the original's", 1.0) is None
    for damaged in "26.5 to 27.7", "", ">= 3..4", "about 5":
        with pytest.raises(ValueError, match="accept must be"):
            paper.accepts(damaged, 27.0)


@pytest.mark.parametrize("accept", TARGETS.accept.unique())
def test_every_band_of_the_file_can_be_read(accept):
    assert paper.accepts(accept, (1.0, 2.0)) in (True, False, None)


# ---- load transfer -----------------------------------------------------------------------------------------

def test_load_transfer_by_moments_written_out():
    """Axle loads from the balance of moments, pulls wheel by wheel."""
    scenario = rdk.scenario("equatorial_mare_traverse")
    for name, axles in ("Rashid-1", [-0.5, 0.5]), ("Pragyan", [-0.5, 0.0, 0.5]):
        rover = rdk.rover(name)
        weight = rdk.evaluate(rover, scenario).total_mass_kg * 1.625
        slope, height = math.radians(25), 0.4
        # loads linear in position, n = a + b x: sum n = W cos, sum n x = W sin h (lengths in wheelbases)
        a = weight * math.cos(slope) / len(axles)
        b = weight * math.sin(slope) * height / sum(x * x for x in axles)
        pull = [2 * rdk.terramechanics.wheel_forces(rover.wheel, scenario.soil, n / 2, 0.6).drawbar_pull_n
                for n in [a] + [a + b * x for x in axles]]
        expected = 100 * (sum(pull[1:]) / (len(axles) * pull[0]) - 1)
        # a difference of nearly equal pulls, each solved to about 1e-9
        assert_allclose(paper.load_transfer(rover, scenario), expected, rtol=1e-4)


def test_load_transfer_broadcasts_and_knows_its_limits():
    scenario, rover = rdk.scenario("equatorial_mare_traverse"), rdk.rover("Rashid-1")
    change = paper.load_transfer(rover, scenario, height_to_wheelbase=[0.0, 0.2, 0.4, 1.2])
    assert change[0] == 0 and np.isnan(change[3]), "at 1.2 the upper axle lifts off"
    assert abs(change[1]) < abs(change[2])
    with pytest.raises(ValueError, match="height_to_wheelbase"):
        paper.load_transfer(rover, scenario, height_to_wheelbase=-0.1)


# ---- rows that rest on searches ------------------------------------------------------------------------------

@pytest.fixture(scope="module")
def small():
    """The rows of searches and timings at a tenth of the budget, and what the searches ran."""
    recorder = Recorder()
    return paper.paper_ledger(("stochastic", "cost"), small_searches(executor=recorder)).set_index("id"), recorder.cases


def test_every_row_is_computed(small):
    table, _ = small
    assert list(table.index) == list(TARGETS.index[TARGETS.kind != "deterministic"])
    assert table.why.map(type).eq(str).all()
    assert table.agrees[COST].isna().all() and table.agrees.drop(COST).notna().all()


def test_a_row_that_disagrees_says_why(small):
    table, _ = small
    # counts, what chance alone gives, and a plateau of its own need no reason
    bare = {"four_wheels_pct", "random_pair", "feasible_pair", "feasible_fraction", "rediscover_dominated",
            "highland_085_km", "highland_115_km", "highland_070"}
    differs = ~table.agrees.fillna(True).astype(bool)
    assert (table.why[differs & ~table.index.isin(bare)].str.len() > 20).all()


def test_stochastic_rows_are_computed_and_not_typed(small):
    """At a tiny budget the searches fall short, and the rows say so."""
    table, _ = small
    assert not table.agrees[["hv60_polar", "hv60_mare"]].any()
    assert table.ours["highland_070"] == "infeasible" and table.ours["random_pair"] > 1


def test_every_study_runs_once(small):
    _, cases = small
    fronts = [case for case in cases if hasattr(case, "obstacle_height_m")]
    keys = {(case.scenario.name, case.seed, case.shear_scale, case.obstacle_height_m, case.generations)
            for case in fronts}
    assert len(keys) == len(fronts) == 4 * (1 + 4 + 6) + 8
    assert {case.generations for case in fronts} == {4, 6} and {case.population for case in fronts} == {10}


def test_the_papers_budget_is_the_default():
    assert paper.Searches().size == {"population": 50, "generations": 60}


def test_seed_offset_moves_the_searches():
    recorder = Recorder()
    paper.Searches(recorder, seed_offset=100, population=4, generations=2).canonical      # noqa: B018
    assert sorted(case.seed for case in recorder.cases) == [112, 113, 114, 115]


def test_without_reasons_only_the_rows_themselves_are_searched_for(small):
    recorder = Recorder()
    table = paper.paper_ledger(("stochastic",), small_searches(executor=recorder), ["Pareto fronts", "design rules"],
                               reasons=False).set_index("id")
    assert len(recorder.cases) == 4, "the canonical fronts, and not those of 90 generations"
    assert table.why["front_mare_mass_kg"] == "" and list(table.ours) == list(small[0].ours[table.index])
