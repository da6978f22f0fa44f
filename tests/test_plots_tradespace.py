"""The figures of the Pareto notebook draw the numbers they were given, and read without colour."""

import matplotlib
import numpy as np
import pytest

matplotlib.use("Agg")

import drawings  # noqa: E402
import matplotlib.pyplot as plt  # noqa: E402
from numpy.testing import assert_array_equal  # noqa: E402


@pytest.fixture(autouse=True)
def closed():
    yield
    plt.close("all")


def by_label(axes):
    """The labelled lines of an axes, as (x, y) by label; lines that differ in colour must differ in style, too."""
    lines = [line for line in axes.get_lines() if not line.get_label().startswith("_")]
    assert len({(line.get_marker(), line.get_linestyle()) for line in lines}) == len(lines)
    return {line.get_label(): line.get_data() for line in lines}


def test_dominated_designs_shade_the_corner_of_what_is_better():
    mass, slope = np.array([3.0, 1.0, 2.0, 2.5]), np.array([5.0, 1.0, 4.0, 3.0])
    axes = drawings.dominated_designs(mass, slope, np.array([False, False, False, True]), 3).axes[0]
    drawn = by_label(axes)
    assert_array_equal(drawn["dominated"], [[2.5], [3.0]])
    assert_array_equal(drawn["not dominated: the front"], [[1, 2, 3], [1, 4, 5]])
    corner = axes.collections[0].get_paths()[0].get_extents()
    assert corner.x1 == 2.5 and corner.y0 == 3.0 and corner.x0 < 1 and corner.y1 > 5


def test_weighted_sums_mark_what_is_picked_and_how_often():
    mass, height, wheels = np.arange(1.0, 5), np.array([0.1, 0.2, 0.3, 0.4]), np.array([4, 4, 6, 6])
    left, right = drawings.weighted_sums(mass, height, wheels, np.linspace(0, 1, 5), np.array([0, 0, 0, 3, 3])).axes
    assert_array_equal(left.collections[0].get_offsets(), [[1, 0.1], [4, 0.4]])
    sizes = left.collections[0].get_sizes()
    assert sizes[0] > sizes[1], "the point that more weights pick is the larger"
    assert_array_equal(right.get_lines()[0].get_ydata(), [0.1, 0.1, 0.1, 0.4, 0.4])
    assert_array_equal(by_label(left)["6 wheels"], [[3, 4], [0.3, 0.4]])


def test_ranks_and_crowding_draw_the_box_between_the_neighbours():
    mass, slope = np.array([1.0, 2, 4, 3]), np.array([1.0, 3, 4, 1])
    rank, crowding = np.array([1, 1, 1, 2]), np.array([np.inf, 1.0, np.inf])
    left, right = drawings.ranks_and_crowding(mass, slope, rank, crowding, 1).axes
    assert_array_equal(by_label(left)["rank 2"], [[3], [1]])
    (box,) = right.patches
    assert box.get_bbox().bounds == (1, 1, 3, 3)
    assert sorted(text.get_text() for text in right.texts) == ["1.00", "∞", "∞"]
