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
