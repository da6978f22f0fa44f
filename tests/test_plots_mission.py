"""Pictures of the evaluator and of missions draw what they are given, and the diagram is what the code does."""
import re

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest
from dataclasses import replace

import rdk
import drawings as plots
import validation
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
    before = rdk.evaluate(RASHID, mission, model=model)
    after = rdk.evaluate(RASHID, mission, model=replace(model, **{name: 0.9 * getattr(model, name)}))
    changed = {where for where, results in plots.EVALUATION_RESULTS.items()
               if any(getattr(before, result) != getattr(after, result) for result in results)}
    assert changed == downstream(part)


def test_the_march_sees_the_sun_even_where_the_hub_sets_the_speed():
    before = rdk.evaluate(RASHID, POLAR)
    after = rdk.evaluate(RASHID, POLAR, model=rdk.Model(panel_efficiency=0.25))
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


def test_power_flows_stack_up_to_array_and_load():
    log = rdk.evaluate(RASHID, MARE).log
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


def test_mass_shares_are_bars_that_add_up():
    shares = pd.DataFrame({"a": [30.0, 3.0], "b": [70.0, 97.0]}, index=["one", "two"])
    axes = plots.mass_shares(shares).axes[0]
    widths = [patch.get_width() for patch in axes.patches]
    assert widths == [30.0, 3.0, 70.0, 97.0]
    assert [patch.get_x() for patch in axes.patches] == [0.0, 0.0, 30.0, 3.0]
    assert texts(axes) == ["30", "70", "97"], "a segment too narrow for its number carries none"
    assert "%" in axes.get_xlabel()


def test_mass_errors_are_points_with_their_names():
    masses = validation.published_masses()
    axes = plots.mass_errors(masses, 10.5).axes[0]
    points = [[line.get_xdata()[0], line.get_ydata()[0]] for line in axes.get_lines() if len(line.get_xdata()) == 1]
    np.testing.assert_array_equal(points, masses[["published_mass_kg", "error_pct"]])
    assert texts(axes) == list(masses.rover)
    drawn = [line for line in axes.get_lines() if len(line.get_xdata()) == 1]
    for line, row in zip(drawn, masses.itertuples()):
        assert line.get_marker() == ("o" if row.wheel_count == 4 else "s")
        assert (line.get_markerfacecolor() != "white") == row.in_class
    band = axes.patches[0].get_extents().transformed(axes.transData.inverted())
    # there and back through pixels
    np.testing.assert_allclose([band.y0, band.y1], [-10.5, 10.5], rtol=1e-9)


def test_peak_solar_shows_prediction_sweep_and_record():
    flown = validation.flown_rovers()
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


# ---- sketches ----------------------------------------------------------------------------------------------

@pytest.mark.parametrize("name", ["heat_box", "rover_on_slope", "rover_parts", "single_wheel_rig", "sky_and_panel",
                                  "wheel_in_soil"])
@pytest.mark.filterwarnings("error")                     # a letter that the font lacks
def test_nothing_written_on_a_sketch_is_cut_off(name):
    figure = getattr(plots, name)()
    figure.canvas.draw()
    width, height = figure.canvas.get_width_height()
    for axes in figure.axes:
        for text in [*axes.texts, axes.title]:
            box = text.get_window_extent()
            inside = box.x0 > -1 and box.y0 > -1 and box.x1 < width + 1 and box.y1 < height + 1
            assert inside or not text.get_text(), text


# ---- rovers side by side -----------------------------------------------------------------------------------

def test_rovers_side_by_side_are_on_one_scale_and_have_words():
    large = RASHID.replace(wheel_radius_m=0.15)          # too large for its hubs on the polar slope
    drawn = plots.rovers({"small": (RASHID, rdk.evaluate(RASHID, POLAR)), "large": (large, rdk.evaluate(large, POLAR))},
                         POLAR)
    radius = [float(r) for r in re.findall(r'<circle class="o" [^>]* r="([^"]*)"', drawn.data)]
    assert radius == [0.1, 0.1, 0.15, 0.15]              # in metres
    assert len(set(re.findall(r"scale\(([\d.]+) -", drawn.data))) == 1
    assert re.search("small: .* 100 mm radius.* large: .*Marked: hubs too weak", repr(drawn))


def test_rovers_side_by_side_stand_three_a_row_on_level_ground_without_a_mission():
    rovers = {name: (rdk.rover(name), None) for name in rdk.rover_names()}
    places = re.findall(r'translate\((\d+) ([\d.]+)\)"><text class="b"', plots.rovers(rovers, None).data)
    assert [int(x) for x, _ in places] == 2 * [0, 276, 552]
    assert len({y for _, y in places[:3]}) == len({y for _, y in places[3:]}) == 1 and float(places[3][1]) > 100
