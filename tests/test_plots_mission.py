"""Figures of notebooks 00 and 05: they draw what they are given, and the diagram is what the code does."""
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import pytest
from dataclasses import replace

import rdk
import drawings as plots
from rdk import figures

RASHID = rdk.rover("Rashid-1")
MARE, POLAR = rdk.scenario("equatorial_mare_traverse"), rdk.scenario("polar_prospecting")


@pytest.fixture(autouse=True)
def close_figures():
    yield
    plt.close("all")


def data(line):
    return np.asarray(line.get_xdata(), float), np.asarray(line.get_ydata(), float)


def texts(axes):
    return [text.get_text() for text in axes.texts]


# ---- the system diagram ------------------------------------------------------------------------------------

ONE_COEFFICIENT = {"mass": "growth_fraction", "terramechanics": "shear_scale", "power": "panel_efficiency",
                   "cruise speed": "drivetrain_efficiency", "march": "soc_floor",
                   "thermal": "enclosure_emissivity"}


def downstream(part):
    """The part and everything that the drawn arrows lead to from it."""
    reached = {part}
    while True:
        more = {end for start, end, _ in plots.EVALUATION_FLOW if start in reached} - reached
        if not more:
            return reached
        reached |= more


@pytest.mark.parametrize("part", plots.EVALUATION_RESULTS)
def test_a_change_in_one_part_reaches_just_the_parts_downstream(part):
    # a long polar drive, limited by the sun and not by the hub or the mission, in which every part matters
    mission, model = replace(POLAR, traverse_limit_km=np.inf), rdk.Model(hub_no_load_speed_rad_s=np.inf)
    name = ONE_COEFFICIENT[part]
    before = rdk.evaluate(RASHID, mission, model)
    after = rdk.evaluate(RASHID, mission, replace(model, **{name: 0.9 * getattr(model, name)}))
    changed = {where for where, results in plots.EVALUATION_RESULTS.items()
               if any(getattr(before, result) != getattr(after, result) for result in results)}
    assert changed == downstream(part)


def test_the_march_sees_the_sun_even_where_the_hub_sets_the_speed():
    before = rdk.evaluate(RASHID, POLAR)
    after = rdk.evaluate(RASHID, POLAR, rdk.Model(panel_efficiency=0.25))
    assert before.hub_speed_limited and before.cruise_speed_m_s == after.cruise_speed_m_s
    assert before.range_km > after.range_km and before.energy_balance_pct > after.energy_balance_pct
    assert ("power", "march") in {(start, end) for start, end, _ in plots.EVALUATION_FLOW}


def test_diagram_draws_every_part_flow_and_result():
    axes = plots.system_diagram().axes[0]
    drawn = texts(axes)
    assert set(plots.EVALUATION_RESULTS) <= set(drawn)
    assert {text for _, _, text in plots.EVALUATION_FLOW} <= set(drawn)
    listed = "\n".join(drawn).split()
    results = {name for names in plots.EVALUATION_RESULTS.values() for name in names}
    assert results <= set(listed) and results <= set(rdk.Performance.__dataclass_fields__)
    users = next(text for text in drawn if text.startswith("tradespace"))
    assert set(users.split(", ")) <= set(rdk.__all__)


# ---- 00 start here -----------------------------------------------------------------------------------------

def test_growth_draws_values_and_proportion():
    mass, sinkage = np.array([10.0, 15.0, 20.0]), np.array([4.0, 5.0, 5.5])
    first, second = plots.growth(mass, {"sinkage (mm)": sinkage, "power (W)": mass**2}).axes
    np.testing.assert_array_equal(data(first.lines[0]), (mass, sinkage))
    np.testing.assert_array_equal(data(second.lines[0])[1], mass**2)
    np.testing.assert_allclose(data(first.lines[1])[1], [4.0, 6.0, 8.0], rtol=1e-12)   # rounding only
    assert (first.get_title(), first.get_xlabel()) == ("sinkage (mm)", "total mass (kg)")


def test_rovers_on_missions_draws_ranges_limits_and_reasons():
    range_km = np.array([[10.0, 0.0], [80.0, 3.0]])
    words = np.array([["drives", "no grip"], ["to the limit", "drives"]])
    figure = plots.rovers_on_missions(range_km, [80, 30], words, ["A", "B"], ["mare", "polar"])
    for column, (axes, limit) in enumerate(zip(figure.axes, (80, 30))):
        np.testing.assert_array_equal([bar.get_width() for bar in axes.patches], range_km[:, column])
        assert data(axes.lines[0])[0].tolist() == [limit, limit]
    assert texts(figure.axes[0]) == ["10 km, drives", "80 km, to the limit"]
    assert texts(figure.axes[1]) == ["no grip", "3 km, drives"]
    assert [line.get_marker() for line in figure.axes[1].lines[1:]] == ["X"]       # one rover goes nowhere
    assert [label.get_text() for label in figure.axes[0].get_yticklabels()] == ["A", "B"]


@pytest.mark.parametrize("slope_deg", [0.0, 15.0])
def test_sunk_wheel_stands_as_deep_as_the_evaluator_says(slope_deg):
    result = rdk.evaluate(RASHID, replace(MARE, slope_deg=slope_deg))
    figure = plots.sunk_wheel(RASHID, result, slope_deg)
    soil, rim = (patch.get_xy() for patch in figure.axes[0].patches)
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


def test_live_picture_follows_its_sliders_and_has_words():
    def draw(figure, a, b):
        figure.add_axes((0.1, 0.1, 0.8, 0.8)).plot([0, a], [0, b])
        return f'a < {a:g} and "b" is {b:g}'

    box = figures.live(draw, a=(0, 10, 1, 2, "a (kg)"), b=(0, 1, 0.1, 0.5, "b (deg)"))
    before = box.picture.value
    assert 'alt="a &lt; 2 and &quot;b&quot; is 0.5"' in before and "data:image/png;base64," in before
    box.sliders["a"].value = 7
    assert box.sentence == 'a < 7 and "b" is 0.5' and box.picture.value != before
    shown = box._repr_mimebundle_()
    assert shown["text/plain"] == box.sentence and shown["image/png"] == box.png
    panel = box.children[0].children
    numbers = [child for child in panel if type(child).__name__ == "BoundedFloatText"]
    assert [n.description for n in numbers] == ["a (kg)", "b (deg)"] and numbers[0].value == 7
    assert 'role="status"' in panel[-1].value
    assert plt.get_fignums() == []                       # no pyplot in a callback


# ---- 05 mission --------------------------------------------------------------------------------------------

def test_pull_and_demand_marks_the_crossing():
    slip, load, demand = np.linspace(0, 0.9, 10), 6.0, 1.5
    pull = rdk.terramechanics.wheel_forces(RASHID.wheel, MARE.soil, load, slip).drawbar_pull_n
    root = rdk.terramechanics.slip_balance(RASHID.wheel, MARE.soil, load, demand).slip
    axes = plots.pull_and_demand(slip, {"a": pull}, {"a": demand}, {"a": root}).axes[0]
    curve, level, mark = axes.lines[:3]
    np.testing.assert_array_equal(data(curve), (slip, pull))
    assert set(data(level)[1]) == {demand} and [v.item() for v in data(mark)] == [root, demand]
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("slip", "drawbar pull of one wheel (N)")


def test_stall_ends_each_line_at_the_first_stall():
    slope, rovers = np.linspace(0, 35, 36), ["Rashid-1", "Tenacious"]
    runs = [rdk.evaluate(rdk.rover(name), replace(MARE, slope_deg=slope)) for name in rovers]
    slip, torque, stalled = (np.stack([getattr(run, name) for run in runs])
                             for name in ("slip", "wheel_torque_nm", "stalled"))
    upper, lower = plots.stall(slope, slip, torque, [0.5, 0.1], stalled, rovers).axes
    for row, peak in enumerate((0.5, 0.1)):
        end = stalled[row].argmax() + 1
        np.testing.assert_array_equal(data(upper.lines[2 * row]), (slope[:end], slip[row, :end]))
        np.testing.assert_allclose(data(lower.lines[2 * row])[1], torque[row, :end] / peak, rtol=1e-12)
        assert upper.lines[2 * row + 1].get_marker() == "X"
    assert len({line.get_linestyle() for line in upper.lines[:4:2]}) == 2          # told apart without colour


def test_a_rover_that_never_stalls_has_no_cross():
    slope, slip = np.array([0.0, 1.0]), np.array([[0.1, 0.2]])
    upper = plots.stall(slope, slip, slip, [1.0], np.array([[False, False]]), ["a"]).axes[0]
    np.testing.assert_array_equal(data(upper.lines[0]), (slope, slip[0]))
    assert "X" not in [line.get_marker() for line in upper.lines]


def test_speed_limits_draws_three_speeds_on_a_logarithmic_axis():
    slope = np.array([0.0, 10.0, 20.0])
    speeds = np.array([20.0, 10.0, 5.0]), np.array([0.5, 0.4, 0.3]), np.array([0.5, 0.4, 0.3])
    axes = plots.speed_limits(slope, *speeds).axes[0]
    for line, speed in zip(axes.lines, speeds):
        np.testing.assert_array_equal(data(line), (slope, speed))
    assert axes.get_yscale() == "log" and axes.get_ylabel() == "speed (m/s)"


def test_mission_logs_draw_the_logs_and_shade_the_throttled_hours():
    logs = {"mare": rdk.evaluate(RASHID, MARE).log, "polar": rdk.evaluate(RASHID, POLAR).log}
    figure = plots.mission_logs(logs)
    for column, log in enumerate(logs.values()):
        power, charge, distance = figure.axes[column::2]
        for line, values in ((power.lines[0], log.solar_w), (power.lines[1], log.load_w),
                             (charge.lines[0], log.soc), (distance.lines[0], log.distance_km)):
            np.testing.assert_array_equal(data(line), (log.time_h / 24, values))
        shaded = np.concatenate([path.vertices[:, 0] for path in power.collections[0].get_paths()])
        days = log.time_h[log.throttled] / 24
        np.testing.assert_allclose([shaded.min(), shaded.max()], [days.min(), days.max()], rtol=1e-12)
    assert [axes.get_title() for axes in figure.axes[:2]] == ["mare", "polar"]


def test_step_convergence_draws_errors_and_a_line_of_first_order():
    step, error = np.array([4.0, 2.0, 1.0]), np.array([0.4, 0.1, 0.02])
    axes = plots.step_convergence(step, {"range": error}).axes[0]
    np.testing.assert_array_equal(data(axes.lines[0]), (step, error))
    np.testing.assert_allclose(data(axes.lines[1])[1], [0.4, 0.2, 0.1], rtol=1e-12)    # rounding only
    assert axes.get_xscale() == axes.get_yscale() == "log"


def test_load_transfer_draws_changes_and_the_papers_band():
    ratio = np.linspace(0, 0.4, 5)
    axes = plots.load_transfer(ratio, {"a": -10 * ratio, "b": ratio}, band_pct=2.0).axes[0]
    np.testing.assert_array_equal(data(axes.lines[0]), (ratio, -10 * ratio))
    np.testing.assert_array_equal(data(axes.lines[1]), (ratio, ratio))
    band = axes.patches[0].get_extents().transformed(axes.transData.inverted())
    np.testing.assert_allclose([band.y0, band.y1], [-2, 2], atol=1e-9)     # through pixels and back
    assert axes.lines[0].get_linestyle() != axes.lines[1].get_linestyle()
    assert axes.lines[0].get_marker() != axes.lines[1].get_marker()
