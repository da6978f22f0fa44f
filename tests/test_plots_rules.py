"""The figures of notebooks 08 to 11: what they draw is what they were given, and they read without colour."""

import matplotlib
import numpy as np
import pandas as pd
import pytest
from numpy.testing import assert_array_equal

matplotlib.use("Agg")
from matplotlib import pyplot as plt  # noqa: E402

import drawings as plots  # noqa: E402


@pytest.fixture(autouse=True)
def close_figures():
    yield
    plt.close("all")


def labels(figure):
    """Axis labels of every panel that carries data, as a reader sees them: shared axes count once."""
    x = {ax.get_xlabel() for ax in figure.axes} - {""}
    y = {ax.get_ylabel() for ax in figure.axes} - {""}
    return x, y


def drawn(ax):
    """The lines with markers or dashes of a panel, by label."""
    return {line.get_label(): line for line in ax.lines if not line.get_label().startswith("_")}


def legend_words(figure):
    legends = [*figure.legends, *(ax.get_legend() for ax in figure.axes if ax.get_legend())]
    return {text.get_text() for legend in legends for text in legend.get_texts()}


def tells_apart(lines):
    """Lines that differ in dashes or markers, not in colour alone."""
    return len({(line.get_linestyle(), line.get_marker()) for line in lines}) == len(lines)


# ---- design rules ------------------------------------------------------------------------------------------

def test_variables_on_fronts_draws_quantiles():
    places = {front: {"radius": np.linspace(0, 1, 11), "width": np.full(11, share)}
              for front, share in (("mare", 0.0), ("polar", 0.5))}
    figure = plots.variables_on_fronts(places)
    ax, lines = figure.axes[0], drawn(figure.axes[0])
    assert_array_equal(lines["mare"].get_xdata(), [0.5, 0.0])
    assert_array_equal(lines["polar"].get_xdata(), [0.5, 0.5])
    bars = [segment for c in ax.collections for segment in c.get_segments()]
    assert any(np.allclose(bar[:, 0], [0.1, 0.9]) for bar in bars), "the middle 80 %"
    assert [t.get_text() for t in ax.get_yticklabels()] == ["radius", "width"]
    assert tells_apart(lines.values()) and legend_words(figure) == {"mare", "polar"}


def test_capability_against_width_draws_every_case():
    width = np.array([30.0, 80.0])
    panels = {"5 N": {"K = 18 mm": np.array([33.0, 30.0]), "K = 2 mm": np.array([49.0, 54.0])},
              "16 N": {"K = 18 mm": np.array([34.0, 33.0]), "K = 2 mm": np.array([45.0, 49.0])}}
    figure = plots.capability_against_width(width, panels)
    for ax, (title, series) in zip(figure.axes, panels.items()):
        assert ax.get_title() == title
        for label, values in series.items():
            assert_array_equal(drawn(ax)[label].get_xydata(), np.column_stack([width, values]))
        assert tells_apart(drawn(ax).values())
    assert labels(figure) == ({"wheel width (mm)"}, {"slope capability (deg)"})


@pytest.mark.parametrize("count", [1, 2, 3, 4])
def test_front_points_holds_any_number_of_missions(count):
    panels = {f"mission {i}": {"a": (np.array([1.0 + i]), np.array([2.0])),
                               "b": (np.array([3.0]), np.array([4.0 + i]))} for i in range(count)}
    figure = plots.front_points(panels, "total mass (kg)", "wheel width (mm)", {"bound": 3})
    for ax, (title, cases) in zip(figure.axes, panels.items()):
        assert ax.get_title() == title and "bound" in [t.get_text() for t in ax.texts]
        for label, (x, y) in cases.items():
            assert_array_equal(drawn(ax)[label].get_xydata(), np.column_stack([x, y]))
        assert tells_apart(drawn(ax).values())
    assert labels(figure) == ({"total mass (kg)"}, {"wheel width (mm)"})


def test_battery_by_patience_draws_one_line_a_seed():
    rows = [dict(scenario=name, seed=seed, generations=g, battery_median_wh=10.0 * seed + g)
            for name in ("polar", "mare") for seed in (1, 2) for g in (60, 180)]
    figure = plots.battery_by_patience(pd.DataFrame(rows), {"polar": 150, "mare": 15})
    for ax, published in zip(figure.axes, (150, 15)):
        seeds = [line for line in ax.lines if len(line.get_xdata()) == 2 and line.get_marker() in plots.MARKERS]
        assert sorted(tuple(line.get_ydata()) for line in seeds) == [(70.0, 190.0), (80.0, 200.0)]
        assert tells_apart(seeds)
        assert drawn(ax)["paper, one seed"].get_ydata()[0] == published
    assert labels(figure) == ({"generations"}, {"median battery of the front (Wh)"})


def test_battery_worth_draws_ranges_and_mass():
    capacity = np.array([5.0, 500.0])
    figure = plots.battery_worth(capacity, {"small": np.array([20.0, 18.0]), "large": np.array([35.0, 42.0])},
                                 np.array([11.0, 17.0]))
    left, right = figure.axes
    assert_array_equal(drawn(left)["large"].get_ydata(), [35.0, 42.0])
    assert_array_equal(right.lines[0].get_ydata(), [11.0, 17.0])
    assert labels(figure) == ({"battery capacity (Wh)"}, {"range (km)", "total mass (kg)"})


def test_rocker_bogie_share_is_in_percent_and_sorted():
    table = pd.DataFrame(dict(scenario=["a", "a", "b", "b"], obstacle_height_m=[0.1, 0.0, 0.0, 0.1],
                              four_wheels=[0.25, 1.0, 1.0, 0.0]))
    ax = plots.rocker_bogie_share(table, 0.1).axes[0]
    assert_array_equal(drawn(ax)["a"].get_xydata(), [[0, 0], [10, 75]])
    assert_array_equal(drawn(ax)["b"].get_ydata(), [0, 100])
    assert tells_apart(drawn(ax).values())


# ---- sensitivity -------------------------------------------------------------------------------------------

def test_frontiers_are_the_longest_range_up_to_a_mass():
    case = np.array([20.0, 10.0, 15.0]), np.array([30.0, 10.0, 5.0])
    empty = np.array([]), np.array([])
    frontiers = {f"mission {i}": {0.7: empty, 0.85: case, 1.0: case, 1.15: case, 1.3: case} for i in range(4)}
    figure = plots.frontiers_by_scale(frontiers)
    ax = figure.axes[0]
    assert_array_equal(drawn(ax)["1"].get_xydata(), [[10, 10], [15, 10], [20, 30], [80, 30]])
    assert any("no feasible design" in t.get_text() for t in ax.texts)
    same_colour = {}
    for line in drawn(ax).values():
        same_colour.setdefault(line.get_color(), []).append(line.get_linestyle())
    assert all(len(set(styles)) == len(styles) for styles in same_colour.values())
    assert len({(line.get_linestyle(), line.get_color()) for line in drawn(ax).values()}) == 4


def test_sobol_bars_show_the_largest_and_their_interval():
    rows = [dict(metric=m, input=f"input_{i}", first_order=0.1 * i, total_order=0.2 * i,
                 total_low=0.2 * i - 0.05, total_high=0.2 * i + 0.05)
            for m in ("range_km", "total_mass_kg") for i in range(5)]
    figure = plots.sobol_bars(pd.DataFrame(rows), {"range_km": "range"}, most=3)
    ax = figure.axes[0]
    assert [t.get_text() for t in ax.get_yticklabels()] == ["input 2", "input 3", "input 4"]
    widths = sorted(patch.get_width() for patch in ax.patches)
    assert np.allclose(widths, [0.2, 0.3, 0.4, 0.4, 0.6, 0.8])
    assert [ax.get_title() for ax in figure.axes] == ["range", "total_mass_kg"]
    assert labels(figure)[0] == {"share of the variance"}


def test_pull_intervals_draw_each_point_once():
    points = pd.DataFrame(dict(experiment="ding-2011", wheel=["smooth", "grousered"], slip=[0.1, 0.2],
                               measured_n=[5.0, 9.0], nominal_n=[4.0, 8.0], low_n=[1.0, 2.0],
                               high_n=[7.0, 12.0]))
    ax = plots.pull_intervals(points).axes[0]
    found = drawn(ax)
    assert_array_equal(found["smooth, measured"].get_ydata(), [5.0])
    assert_array_equal(found["grousered, measured"].get_ydata(), [9.0])
    spans = sorted(tuple(segment[:, 1]) for c in ax.collections for segment in c.get_segments())
    assert spans == [(1.0, 7.0), (2.0, 12.0)] and tells_apart(found.values())


def test_family_rules_count_the_empty_ones():
    table = pd.DataFrame(dict(family=["a", "a", "b", "b"], designs=[50, 50, 0, 50],
                              share=[100.0, 50.0, np.nan, 0.0]))
    figure = plots.family_rules(table, {"share": "share (%)"})
    ax = figure.axes[0]
    assert [t.get_text() for t in ax.get_yticklabels()] == ["a", "b\n(1 of 2 empty)"]
    assert_array_equal(ax.lines[0].get_xdata(), [100.0, 50.0])
    assert tells_apart(ax.lines) and labels(figure)[0] == {"share (%)"}


# ---- rediscovery -------------------------------------------------------------------------------------------

FOUND = pd.DataFrame(dict(rover=["A", "B"], distance=[0.1, 0.9], in_class=[True, False]))
CHANCE = pd.DataFrame(dict(rover=["A", "B"], random_pair=[1.1, 1.2], feasible_pair=1.0, centroid=[0.8, 0.7],
                           nearest_capped=[0.2, 0.5], nearest_capped_low=[0.15, 0.3]))


def test_rediscovery_distances_draw_front_centroid_and_chance():
    ax = plots.rediscovery_distances(FOUND, CHANCE).axes[0]
    bars = [p for p in ax.patches if p.get_height() > 0]
    assert [p.get_height() for p in bars] == [0.1, 0.9]
    assert [bool(p.get_hatch()) for p in bars] == [False, True]
    assert_array_equal(drawn(ax)["centroid of the feasible designs"].get_ydata(), [0.8, 0.7])
    assert_array_equal(drawn(ax)["random pair"].get_ydata(), [1.15, 1.15])
    squares = [container.lines[0] for container in ax.containers if hasattr(container, "lines")]
    assert_array_equal(squares[0].get_ydata(), [0.2, 0.5])
    assert [t.get_text() for t in ax.get_xticklabels()] == ["A", "B"]


def test_distance_by_patience_draws_every_rover_on_one_scale():
    rows = pd.DataFrame([dict(rover=rover, generations=g, distance=distance) for rover, distance in
                         (("A", 0.1), ("B", 1.2), ("C", 0.3)) for g in (8, 16)])
    chances = pd.DataFrame(dict(rover=["A", "B", "C"], nearest_capped=[0.2, 0.4, 0.6]))
    figure = plots.distance_by_patience(rows, chances)
    for ax, name, chance in zip(figure.axes, "ABC", (0.2, 0.4, 0.6)):
        assert ax.get_title() == name and ax.get_ylim()[1] > 1.2
        assert_array_equal(ax.lines[0].get_xdata(), [8, 16])
        assert_array_equal(ax.lines[1].get_ydata(), [chance, chance])


# ---- the ledger --------------------------------------------------------------------------------------------

LEDGER = pd.DataFrame(dict(
    id=["a", "b", "c"], section=["one", "one", "two"], quantity=["x < y", "q", "time"],
    paper=["1..2", "3", "37"], ours=pd.Series([(1.23456, 2.0), False, "0.5 s"], dtype=object),
    agrees=pd.array([True, False, pd.NA], "boolean"), why=["", "because <b>", "here"]))


@pytest.mark.parametrize("agrees, symbol, word", [
    (True, "✓", "agrees"), (np.True_, "✓", "agrees"), (False, "✗", "differs"), (pd.NA, "–", "reported"),
    (None, "–", "reported"), (float("nan"), "–", "reported")])
def test_verdict_has_a_symbol_and_a_word(agrees, symbol, word):
    assert plots.verdict(agrees) == (symbol, word)


@pytest.mark.parametrize("value, text", [
    ((1.23456, 2.0), "1.235..2"), (False, "False"), ("0.5 s", "0.5 s"), (3, "3"),
    (np.float64(0.1234567), "0.1235"), ([10, 20.5], "10..20.5")])
def test_ledger_text(value, text):
    assert plots.ledger_text(value) == text


def test_ledger_verdicts_add_up_to_the_rows():
    ax = plots.ledger_verdicts(LEDGER).axes[0]
    assert sum(p.get_width() for p in ax.patches) == len(LEDGER)
    hatched = [p for p in ax.patches if p.get_hatch() and p.get_width()]
    assert len(hatched) == 1 and hatched[0].get_width() == 1, "told apart without colour"


def test_ledger_html_is_escaped_and_reads_without_colour():
    text = plots.ledger_html(LEDGER)
    assert "x &lt; y" in text and "<b>" not in text and "because &lt;b&gt;" in text
    assert [text.count(mark) for mark in ("✓ agrees", "✗ differs", "– reported")] == [1, 1, 1]
    assert text.count("<tr") == 1 + len(LEDGER) and 'scope="col"' in text and "1.235..2" in text


def test_ledger_filter_leaves_what_the_menus_say():
    box = plots.ledger_filter(LEDGER)
    assert len(box.shown) == 3 and "3 numbers" in box.table.value
    box.verdict.value = "differs"
    assert list(box.shown.id) == ["b"] and "time" not in box.table.value
    box.section.value = "two"
    assert box.shown.empty and "0 numbers" in box.table.value
    box.verdict.value = "reported"
    assert list(box.shown.id) == ["c"]
    assert box.section.options == ("all", "one", "two")


def test_ledger_filter_without_widgets_is_the_whole_table():
    bundle = plots.ledger_filter(LEDGER)._repr_mimebundle_()
    assert bundle["text/html"] == plots.ledger_html(LEDGER)
    assert bundle["text/plain"] == "3 numbers of the paper"


def test_two_filters_do_not_disturb_each_other():
    one, other = plots.ledger_filter(LEDGER), plots.ledger_filter(LEDGER)
    one.verdict.value = "agrees"
    assert len(one.shown) == 1 and len(other.shown) == 3
