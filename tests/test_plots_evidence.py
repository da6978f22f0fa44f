"""The figures of notebooks 03 and 04 draw the numbers they were given, in the units on their axes."""

import matplotlib
import numpy as np
import pandas as pd
import pytest

matplotlib.use("Agg")

import matplotlib.pyplot as plt  # noqa: E402

import rdk  # noqa: E402
import drawings as plots  # noqa: E402
from rdk import validation  # noqa: E402

X = np.linspace(0.0, 10.0, 11)


@pytest.fixture(autouse=True)
def closed():
    yield
    plt.close("all")


@pytest.fixture(scope="module")
def masses():
    return validation.published_masses()


@pytest.fixture(scope="module")
def flown():
    return validation.flown_rovers()


@pytest.fixture(scope="module")
def log():
    mission = rdk.scenario("equatorial_mare_traverse")
    return rdk.evaluate(rdk.rover("Rashid-1"), mission).log


def curves(axes):
    """The labelled lines of an axes, as (x, y) by label."""
    return {line.get_label(): (line.get_xdata(), line.get_ydata()) for line in axes.get_lines()
            if not line.get_label().startswith("_")}


def marks(axes):
    """The first point of every unlabelled line that is a marker only."""
    return [(line.get_xdata()[0], line.get_ydata()[0]) for line in axes.get_lines()
            if line.get_linestyle() == "None" and len(line.get_xdata()) == 1]


def texts(axes):
    return [text.get_text() for text in axes.texts]


def test_mass_shares_are_bars_that_add_up():
    shares = pd.DataFrame({"a": [30.0, 3.0], "b": [70.0, 97.0]}, index=["one", "two"])
    axes = plots.mass_shares(shares).axes[0]
    widths = [patch.get_width() for patch in axes.patches]
    assert widths == [30.0, 3.0, 70.0, 97.0]
    assert [patch.get_x() for patch in axes.patches] == [0.0, 0.0, 30.0, 3.0]
    assert texts(axes) == ["30", "70", "97"], "a segment too narrow for its number carries none"
    assert "%" in axes.get_xlabel()


def test_mass_errors_are_points_with_their_names(masses):
    axes = plots.mass_errors(masses, 10.5).axes[0]
    np.testing.assert_array_equal(marks(axes), masses[["published_mass_kg", "error_pct"]])
    assert texts(axes) == list(masses.rover)
    drawn = [line for line in axes.get_lines() if len(line.get_xdata()) == 1]
    for line, row in zip(drawn, masses.itertuples()):
        assert line.get_marker() == ("o" if row.wheel_count == 4 else "s")
        assert (line.get_markerfacecolor() != "white") == row.in_class
    band = axes.patches[0].get_extents().transformed(axes.transData.inverted())
    # there and back through pixels
    np.testing.assert_allclose([band.y0, band.y1], [-10.5, 10.5], rtol=1e-9)


def test_fixed_overheads_draw_points_and_curves(masses):
    shares = {"4 wheels": 120 / (X + 5), "6 wheels": 230 / (X + 5)}
    axes = plots.fixed_overheads(masses, X + 5, shares).axes[0]
    np.testing.assert_array_equal(marks(axes), masses[["published_mass_kg", "fixed_overhead_pct"]])
    for label, (x, y) in curves(axes).items():
        np.testing.assert_array_equal(y, shares[label])
        np.testing.assert_array_equal(x, X + 5)


def test_mass_sensitivity_is_a_row_a_coefficient():
    changes = pd.DataFrame({"A": [1.0, 2.0, -3.0], "B": [0.5, 0.0, 4.0]}, index=["p", "q", "r"])
    axes = plots.mass_sensitivity(changes, "10 %").axes[0]
    for rover, (x, y) in curves(axes).items():
        np.testing.assert_array_equal(x, changes[rover])
        np.testing.assert_array_equal(y, [0, 1, 2])
    assert [label.get_text() for label in axes.get_yticklabels()] == ["p", "q", "r"]
    assert "10 %" in axes.get_xlabel()


def test_sun_paths():
    paths = {"here": 9 * X, "there": -9 * X}
    axes = plots.sun_paths(X, paths).axes[0]
    drawn = curves(axes)
    assert list(drawn) == list(paths)
    for label, y in paths.items():
        np.testing.assert_array_equal(drawn[label][1], y)
    assert "deg" in axes.get_ylabel() and "days" in axes.get_xlabel()


def test_panel_incidence_draws_both_with_and_without_horizon():
    seen, free = {"a": X / 10, "b": X / 20}, {"a": X / 9, "b": X / 19}
    axes = plots.panel_incidence(36 * X - 180, seen, free).axes[0]
    for label, (x, y) in curves(axes).items():
        np.testing.assert_array_equal(y, seen[label])
    dotted = [line.get_ydata() for line in axes.get_lines() if line.get_linestyle() == ":"]
    np.testing.assert_array_equal(dotted, list(free.values()))


def test_day_of_power_is_a_panel_a_site():
    power = {site: {"flat": X * k, "tilted": X * k + 1} for k, site in enumerate("abcd")}
    figure = plots.day_of_power(X, power)
    for axes, (site, series) in zip(figure.axes, power.items()):
        assert axes.get_title() == site
        for label, (x, y) in curves(axes).items():
            np.testing.assert_array_equal(y, series[label])
        assert axes.patches[0].get_x() == 5.0, "night begins in the middle"
    assert "(W)" in figure.get_supylabel()


def test_power_flows_stack_up_to_array_and_load(log):
    figure = plots.power_flows(log)
    for axes, total in zip(figure.axes, (log.solar_w, log.load_w)):
        parts = axes.collections
        assert len(parts) == 3
        tops = [part.get_paths()[0].vertices[:, 1].max() for part in parts]
        assert tops == sorted(tops)
        # what the three parts come to at every hour is what the array gave, or the load took
        top = parts[-1].get_paths()[0].vertices
        for k in (5, 100, 250):
            drawn = top[np.isclose(top[:, 0], log.time_h[k] / 24), 1]
            assert np.isclose(drawn, total[k], rtol=1e-9, atol=1e-9).any()        # the same numbers, stacked
    served = log.load_w - log.unserved_w
    from_battery = np.maximum(log.load_w - log.solar_w, 0) - log.unserved_w
    assert (from_battery > -1e-9).all() and (served <= log.load_w + 1e-9).all()   # rounding of a difference


def test_efficiency_stack_is_a_running_product():
    axes = plots.efficiency_stack({"a": 0.5, "b": 0.4, "c": 0.5}, {"other": 0.25}).axes[0]
    # rounding
    np.testing.assert_allclose([bar.get_height() for bar in axes.patches], [0.5, 0.2, 0.1], rtol=1e-12)
    assert [label.get_text() for label in axes.get_xticklabels()] == ["a", "b", "c"]
    assert curves(axes)["other: 0.250"][1][0] == 0.25


def test_peak_solar_shows_prediction_sweep_and_record(flown):
    figure = plots.peak_solar(flown)
    for axes, row in zip(figure.axes, flown.itertuples()):
        assert axes.get_title() == row.rover
        point, caps, bars = axes.containers[0]
        assert point.get_ydata()[0] == row.clean_peak_w
        # ends computed as value minus and plus a difference
        np.testing.assert_allclose(bars[0].get_segments()[0][:, 1],
                                   [row.clean_peak_low_w, row.clean_peak_high_w],
                                   rtol=1e-12)
        low, high = axes.get_ylim()
        assert low == 0 and high > max(row.clean_peak_high_w, row.published_high_w)
        band = axes.collections[0].get_paths()[0].vertices[:, 1]
        assert (band.min(), band.max()) == (row.published_low_w, row.published_high_w)


def test_node_temperatures_draw_curves_marks_and_limits():
    axes = plots.node_temperatures(X, {"day": 5 * X, "night": 5 * X - 100}, (-30, 50),
                                   {"here": (2.0, 10.0)}).axes[0]
    drawn = curves(axes)
    np.testing.assert_array_equal(drawn["night"][1], 5 * X - 100)
    assert (drawn["here"][0][0], drawn["here"][1][0]) == (2.0, 10.0)
    assert "degC" in axes.get_ylabel() and "(W)" in axes.get_xlabel()
