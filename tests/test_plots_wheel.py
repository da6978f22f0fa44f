"""The pictures of wheels draw the numbers they were given, to scale, in the units on their axes."""

from dataclasses import replace

import matplotlib
import numpy as np
import pytest

matplotlib.use("Agg")

import matplotlib.pyplot as plt  # noqa: E402

import rdk  # noqa: E402
import drawings as plots  # noqa: E402
import validation  # noqa: E402
from rdk import terramechanics  # noqa: E402
from wheel_doubts import bootstrap_medians  # noqa: E402

WHEEL, SOIL = rdk.Wheel(0.10, 0.08, 0.015, 14), rdk.soil("apollo-nominal")
RASHID, MARE = rdk.rover("Rashid-1"), rdk.scenario("equatorial_mare_traverse")


@pytest.fixture(autouse=True)
def closed():
    yield
    plt.close("all")


def lines(axes):
    """The labelled lines of an axes, as (x, y) by label."""
    return {line.get_label(): (line.get_xdata(), line.get_ydata()) for line in axes.get_lines()
            if not line.get_label().startswith("_")}


def assert_units(figure):
    """Every axis that carries a label names a unit, or a pure number."""
    pure = ("slip s", "drawbar pull over load", "evaluations of the stress", "relative error")
    labels = [label for axes in figure.axes for label in (axes.get_xlabel(), axes.get_ylabel()) if label]
    assert labels and all("(" in label or label in pure for label in labels), labels


def test_stress_on_rim_is_to_scale():
    angle = np.linspace(0, 0.35, 101)
    cases = {f"slip {s}": (angle, terramechanics.contact_stress(WHEEL, SOIL, 0.35, s, angle))
             for s in (-0.2, 0.6)}
    figure = plots.stress_on_rim(WHEEL.radius_m, cases)
    assert_units(figure)
    scales = []
    for axes, (label, (_, stress)) in zip(figure.axes, cases.items()):
        assert axes.get_title() == label and axes.get_aspect() == 1
        normal, shear, rim = (np.hypot(*line.get_data()) for line in axes.get_lines()[:3])
        np.testing.assert_allclose(rim, 100, rtol=1e-12)                 # rounding of sin and cos
        peak = stress.normal_stress_pa.argmax()
        scale = (normal[peak] - 100) / (stress.normal_stress_pa[peak] / 1000)
        scales.append(scale)
        # the same mm a kPa for both stresses, in every panel, up to rounding
        np.testing.assert_allclose(normal - 100, stress.normal_stress_pa / 1000 * scale, atol=1e-9)
        np.testing.assert_allclose(100 - shear, abs(stress.shear_stress_pa) / 1000 * scale, atol=1e-9)
        arrows = axes.collections[-1]
        assert (np.sign(arrows.U) == (1 if label == "slip 0.6" else -1)).all()
        marks = [line.get_data() for line in axes.get_lines()[4:7]]
        found = [np.arctan2(x[0], -y[0]) for x, y in marks]
        np.testing.assert_allclose(found, [0.35, stress.transition_angle_rad[0], 0], atol=1e-12)   # rounding
    np.testing.assert_allclose(scales, scales[0], rtol=1e-12)
    bar = figure.axes[0].get_lines()[-1].get_xdata()
    written = float(figure.axes[0].texts[-1].get_text().split()[0])
    np.testing.assert_allclose(np.ptp(bar), written * scales[0], rtol=1e-12)


def test_load_and_pull_marks_the_slope_on_the_circle():
    slope = terramechanics.slope_capability(WHEEL, SOIL, 6.0)
    load = np.linspace(0.1, 7, 200)
    pull = terramechanics.wheel_forces(WHEEL, SOIL, load, 0.6).drawbar_pull_n
    figure = plots.load_and_pull({"a": (load, pull)}, 6.0, {"a": slope})
    assert_units(figure)
    drawn = lines(figure.axes[0])
    np.testing.assert_array_equal(drawn["a"], [load, pull])
    x, y = drawn[f"slope {slope:.1f}°"]
    np.testing.assert_allclose(np.hypot(x, y), 6.0, rtol=1e-12)
    np.testing.assert_allclose(np.interp(x, load, pull), y, rtol=1e-4)   # a curve of 200 points
    np.testing.assert_allclose(np.hypot(*drawn["weight on the wheel"]), 6.0, rtol=1e-12)


@pytest.mark.parametrize("slope_deg", [0.0, 15.0])
def test_sunk_wheel_stands_as_deep_as_the_evaluator_says(slope_deg):
    result = rdk.evaluate(RASHID, replace(MARE, slope_deg=slope_deg))
    figure = plots.sunk_wheel(RASHID, result, slope_deg)
    soil, rim = (patch.get_xy() for patch in figure.axes[0].patches[:2])
    up = np.array([-np.sin(np.radians(slope_deg)), np.cos(np.radians(slope_deg))])     # away from the ground
    # the rim is drawn with 200 points, so its lowest one may miss the bottom by r (pi / 200)^2 / 2 = 1e-5 m
    np.testing.assert_allclose((rim @ up).min(), -result.sinkage_m, atol=2e-5)
    np.testing.assert_allclose((rim @ up).max(), 2 * RASHID.wheel_radius_m - result.sinkage_m, atol=2e-5)
    surface = soil[:32] @ up                             # rut, contact arc, undisturbed surface
    np.testing.assert_allclose([surface[0], surface.max()], [-result.sinkage_m, 0], atol=1e-12)  # rounding
    assert f"sinks {1000 * result.sinkage_m:.1f} mm" in figure.get_suptitle()


def test_sunk_wheel_says_when_it_stalls_and_draws_smooth_wheels():
    smooth = replace(RASHID, grouser_count=0, grouser_height_m=0.0)
    steep = rdk.evaluate(smooth, replace(MARE, slope_deg=34))
    assert steep.stalled and plots.sunk_wheel(smooth, steep, 34).get_suptitle().endswith("stalls")


def test_comparison_draws_every_point_and_curve():
    points, curves = validation.single_wheel(), validation.single_wheel_curves(np.linspace(0, 0.6, 7))
    figure = plots.single_wheel_comparison(points, curves)
    assert_units(figure)
    grid = np.array(figure.axes).reshape(3, -1)
    seen = 0
    for column, test in enumerate(points.experiment.unique()):
        for axes, quantity in zip(grid[:, column], validation.QUANTITIES):
            for label, (x, y) in lines(axes).items():
                wheel, kind = label.split(", ")
                table, name = (points, quantity) if kind == "measured" else (curves, "model_" + quantity)
                rows = table[(table.experiment == test) & (table.wheel == wheel)].dropna(subset=name)
                np.testing.assert_array_equal([x, y], [rows.slip, rows[name]])
                seen += len(x) * (kind == "measured")
    assert seen == points[list(validation.QUANTITIES)].notna().to_numpy().sum()


def test_errors_are_signed_and_in_the_units_of_the_axes():
    points = validation.single_wheel()
    pull, sinkage = plots.single_wheel_errors(points).axes
    assert_units(pull.figure)
    drawn = [np.concatenate([line.get_ydata() for line in axes.get_lines() if line.get_linestyle() == ":"])
             for axes in (pull, sinkage)]
    expected = [100 * (points.model_drawbar_pull_n - points.drawbar_pull_n) / points.vertical_load_n,
                points.model_sinkage_mm - points.sinkage_mm]
    for ours, theirs in zip(drawn, expected):
        np.testing.assert_allclose(np.sort(ours), np.sort(theirs), rtol=1e-12)       # the same arithmetic
    low = lines(pull)["Hurrell 2025, grousered"][1]
    assert low[0] < 0 < low[-1]                          # too little pull at small slip, too much at large


def test_median_spread_puts_each_row_beside_its_name():
    table = bootstrap_medians(samples=50)
    axes = plots.median_spread({"a": table, "b": table.assign(low_pct=table.low_pct / 2)}).axes[0]
    names = [text.get_text() for text in axes.get_yticklabels()]
    assert names[0] == "Ding 2011, drawbar pull" and "Wang & Han 2016, torque" in names
    assert len(names) == len(table)
    for bars, points, factor in zip(axes.collections, axes.get_lines(), (1.0, 0.5)):
        ends = np.array([segment[:, 0] for segment in bars.get_segments()])
        np.testing.assert_allclose(ends, np.c_[factor * table.low_pct, table.high_pct], rtol=1e-12)
        np.testing.assert_array_equal(points.get_xdata(), table.median_abs_error_pct)
        np.testing.assert_allclose(points.get_ydata() - axes.get_yticks(), 0, atol=0.2)      # beside its name
