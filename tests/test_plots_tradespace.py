"""The figures of the Pareto notebook draw the numbers they were given, and read without colour."""

import matplotlib
import numpy as np
import pytest

matplotlib.use("Agg")

import matplotlib.pyplot as plt  # noqa: E402

import rdk  # noqa: E402
import drawings as plots  # noqa: E402

RISING = np.linspace(0.0, 1.0, 7)


@pytest.fixture(autouse=True)
def closed():
    yield
    plt.close("all")


@pytest.fixture(scope="module")
def front():
    return rdk.pareto_front(rdk.scenario("equatorial_mare_traverse"), population=16, generations=6, seed=2)


def by_label(axes):
    """The labelled lines of an axes, as (x, y) by label."""
    return {line.get_label(): (np.asarray(line.get_xdata()), np.asarray(line.get_ydata()))
            for line in axes.get_lines() if not line.get_label().startswith("_")}


def assert_units(figure):
    """Every label of an axis names a unit, or a pure number."""
    pure = ("generation", "normalised hypervolume", "evaluations (designs)")
    labels = [label for ax in figure.axes for label in (ax.get_xlabel(), ax.get_ylabel()) if label]
    assert labels and all("(" in label or label in pure for label in labels), labels


def assert_tellable(lines):
    """Lines that differ in colour differ in marker or dashes, too."""
    styles = [(line.get_marker(), line.get_linestyle()) for line in lines]
    assert len(set(styles)) == len(styles), styles


def test_dominated_designs():
    mass, slope = np.array([3.0, 1.0, 2.0, 2.5]), np.array([5.0, 1.0, 4.0, 3.0])
    beaten = np.array([False, False, False, True])
    figure = plots.dominated_designs(mass, slope, beaten, 3)
    assert_units(figure)
    drawn = by_label(figure.axes[0])
    np.testing.assert_array_equal(drawn["dominated"], [[2.5], [3.0]])
    np.testing.assert_array_equal(drawn["not dominated: the front"], [[1, 2, 3], [1, 4, 5]])
    corner = figure.axes[0].collections[0].get_paths()[0].get_extents()
    # the corner of what is lighter and steeper than the chosen design, and nothing else
    assert corner.x1 == 2.5 and corner.y0 == 3.0 and corner.x0 < 1 and corner.y1 > 5
    assert_tellable([line for line in figure.axes[0].get_lines() if not line.get_label().startswith("_")])


def test_weighted_sums():
    mass, height, wheels = np.array([1.0, 2, 3, 4]), np.array([0.1, 0.2, 0.3, 0.4]), np.array([4, 4, 6, 6])
    weight, pick = np.linspace(0, 1, 5), np.array([0, 0, 0, 3, 3])
    figure = plots.weighted_sums(mass, height, wheels, weight, pick)
    assert_units(figure)
    left, right = figure.axes
    np.testing.assert_array_equal(by_label(left)["4 wheels"], [[1, 2], [0.1, 0.2]])
    np.testing.assert_array_equal(by_label(left)["6 wheels"], [[3, 4], [0.3, 0.4]])
    squares = left.collections[0]
    np.testing.assert_array_equal(squares.get_offsets(), [[1, 0.1], [4, 0.4]])
    assert np.diff(squares.get_sizes())[0] < 0                  # three weights pick the first, two the last
    np.testing.assert_array_equal(right.get_lines()[0].get_data(), [weight, height[pick]])
    assert_tellable(left.get_lines()[:2])


def test_ranks_and_crowding():
    mass, slope = np.array([2.0, 1, 3, 2, 3]), np.array([3.0, 2, 4, 1, 2])
    rank, crowding = np.array([1, 1, 1, 2, 2]), np.array([1.0, np.inf, np.inf])
    figure = plots.ranks_and_crowding(mass, slope, rank, crowding, 0)
    assert_units(figure)
    left, right = figure.axes
    np.testing.assert_array_equal(by_label(left)["rank 1"], [[1, 2, 3], [2, 3, 4]])
    np.testing.assert_array_equal(by_label(left)["rank 2"], [[2, 3], [1, 2]])
    assert_tellable(left.get_lines())
    assert [text.get_text() for text in right.texts] == ["∞", "1.00", "∞"]
    assert [text.xy for text in right.texts] == [(1, 2), (2, 3), (3, 4)]
    (box,) = right.patches                                      # from one neighbour to the other
    assert box.get_xy() == (1, 2) and (box.get_width(), box.get_height()) == (2, 2)


def test_variation_operators():
    children = np.array([0.2, 0.2, 0.3])
    figure = plots.variation_operators({"one": (children, (0.2, 0.3), RISING, 2 * RISING),
                                        "two": (children, (0.2,), RISING, RISING)})
    assert_units(figure)
    assert [ax.get_title() for ax in figure.axes] == ["one", "two"]
    np.testing.assert_array_equal(by_label(figure.axes[0])["formula"], [RISING, 2 * RISING])
    marks = [line.get_xdata()[0] for line in figure.axes[0].get_lines() if line.get_linestyle() == "--"]
    assert marks == [0.2, 0.3]
    area = sum(p.get_width() * p.get_height() for p in figure.axes[0].patches)
    np.testing.assert_allclose(area, 1, rtol=1e-9)              # a density, up to rounding


def test_front_history():
    snapshots = {"generation 1": (RISING[:2], RISING[:2]), "generation 9": (RISING, RISING**2)}
    figure = plots.front_history(snapshots)
    assert_units(figure)
    titles = [ax.get_title() for ax in figure.axes]
    assert titles == ["generation 1: 2 on the front", "generation 9: 7 on the front"]
    np.testing.assert_array_equal(figure.axes[1].get_lines()[0].get_data(), [RISING, RISING**2])


def test_pareto_fronts_show_every_design_once_in_the_band_of_its_slope(front):
    figure = plots.pareto_fronts({"a": front, "b": front, "c": front, "d": front}, {"a": (1, 2, 3, 4)})
    assert_units(figure)
    p = front.performance
    for title, ax in zip("abcd", figure.axes):
        assert ax.get_title() == title
        drawn = np.concatenate([c.get_offsets() for c in ax.collections])
        expected = np.stack([p.total_mass_kg, p.range_km], axis=1)
        np.testing.assert_array_equal(drawn[np.lexsort(drawn.T)], expected[np.lexsort(expected.T)])
        for band, (low, high, _, size) in zip(ax.collections, plots.SLOPE_BANDS):
            slopes = np.asarray(band.get_array())
            assert np.all((slopes >= low) & (slopes < high)) and np.all(band.get_sizes() == size)
    (box,) = figure.axes[0].patches
    assert box.get_bbox().bounds == (1, 3, 1, 1) and not figure.axes[1].patches
    assert len({marker for _, _, marker, _ in plots.SLOPE_BANDS}) == 4      # markers tell what colours tell
    words = [text.get_text() for text in figure.legends[0].get_texts()]
    assert words == ["below 20°", "20° to 30°", "30° to 34°", "above 34°", "span in the paper"]


def test_slope_bands_leave_no_gap():
    edges = [(low, high) for low, high, _, _ in plots.SLOPE_BANDS]
    assert edges[0][0] == -np.inf and edges[-1][1] == np.inf
    assert all(a[1] == b[0] for a, b in zip(edges, edges[1:]))


def test_along_a_front(front):
    figure = plots.along_a_front(front)
    assert_units(figure)
    p = front.performance
    for ax, y in zip(figure.axes, (p.slope_capability_deg, p.range_km, front.designs.chassis_mass_kg)):
        np.testing.assert_array_equal(ax.get_lines()[0].get_data(), [p.total_mass_kg, y])


def test_generation_budget():
    histories = {t: {"seed 1": k + RISING, "seed 2": k + RISING**2} for k, t in enumerate("abcd")}
    published = {t: {3: k + 0.5, 6: k + 0.9} for k, t in enumerate("abcd")}
    figure = plots.generation_budget(histories, published)
    assert_units(figure)
    for k, (title, ax) in enumerate(zip("abcd", figure.axes)):
        drawn = by_label(ax)
        assert ax.get_title() == title
        np.testing.assert_array_equal(drawn["seed 1"], [np.arange(1, 8), k + RISING])
        np.testing.assert_array_equal(drawn["seed 2"], [np.arange(1, 8), k + RISING**2])
        np.testing.assert_array_equal(drawn["paper, mean of two"], [[3, 6], [k + 0.5, k + 0.9]])
        assert_tellable(ax.get_lines())


def test_decoded_genes():
    figure = plots.decoded_genes(RISING, 2 * RISING, 3 * RISING)
    assert_units(figure)
    for ax, factor in zip(figure.axes, (2, 3)):
        np.testing.assert_array_equal(ax.get_lines()[0].get_data(), [RISING, factor * RISING])


def test_searches_draw_mean_and_span():
    evaluations = np.arange(1, 8) * 50
    histories = {"a": np.stack([RISING, 3 * RISING]), "b": np.stack([RISING + 1])}
    figure = plots.searches(evaluations, histories)
    assert_units(figure)
    (ax,) = figure.axes
    np.testing.assert_array_equal(by_label(ax)["a"], [evaluations, 2 * RISING])
    np.testing.assert_array_equal(by_label(ax)["b"], [evaluations, RISING + 1])
    top = ax.collections[0].get_paths()[0].get_extents().y1
    assert top == 3.0
    assert_tellable(ax.get_lines())


def test_seed_scatter():
    panels = {"lightest (kg)": {"a": np.array([1.0, 2]), "b": np.array([3.0])},
              "battery (Wh)": {"a": np.array([10.0, 20]), "b": np.array([30.0])}}
    figure = plots.seed_scatter(panels, {"lightest (kg)": {"b": 2.5}})
    left, right = figure.axes
    assert (left.get_xscale(), right.get_xscale()) == ("linear", "log")
    assert [t.get_text() for t in left.get_yticklabels()] == ["a", "b"] and left.yaxis_inverted()
    drawn = [(line.get_marker(), *map(list, line.get_data())) for line in left.get_lines()]
    assert drawn == [("o", [1, 2], [0, 0]), ("o", [3], [1]), ("X", [2.5], [1])]
    assert len(right.get_lines()) == 2                          # no published value, no cross


def test_hub_speed_plateau():
    figure = plots.hub_speed_plateau(RISING, 10 * RISING, {2.5: 25.0, 5.0: 50.0}, 120.0)
    assert_units(figure)
    drawn = by_label(figure.axes[0])
    np.testing.assert_array_equal(drawn["the longest-range design, hub replaced"], [RISING, 10 * RISING])
    np.testing.assert_array_equal(drawn["longest range of a new front"], [[2.5, 5], [25, 50]])
    np.testing.assert_array_equal(drawn["traverse limit of the study"][1], 120)
    assert_tellable(figure.axes[0].get_lines())


def test_every_figure_of_fronts_says_what_it_takes_and_returns():
    for function in (plots.dominated_designs, plots.weighted_sums, plots.ranks_and_crowding, plots.searches,
                     plots.variation_operators, plots.front_history, plots.pareto_fronts,
                     plots.along_a_front, plots.generation_budget, plots.decoded_genes, plots.seed_scatter,
                     plots.hub_speed_plateau):
        words = function.__doc__
        assert "Parameters\n" in words and "Returns\n" in words and "matplotlib.figure.Figure" in words
        names = function.__code__.co_varnames[:function.__code__.co_argcount]
        assert all(name in words for name in names), function.__name__
