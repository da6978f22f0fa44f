"""The explorer without a browser: every input and view, threads, files and the optimiser, through Python objects."""

import base64
import dataclasses
import gc
import html
import io
import itertools
import json
import random
import re
import subprocess
import sys
import threading
import tracemalloc
from datetime import datetime

import ipywidgets
import matplotlib.image
import matplotlib.legend
import numpy as np
import pytest

import rdk
from rdk import catalog, explain
from rdk.explorer import app as explorer_module, pictures
from rdk.explorer.controls import MISSION_SPACE, OWN, SCRIPTS, VIEWS, Refresher
from rdk.explorer import Explorer
from rdk.tradespace import Problem

MARE = "equatorial_mare_traverse"
CANONICAL = rdk.scenario_names("canonical")
CONTINUOUS = [name for name in (*rdk.DESIGN_SPACE, *MISSION_SPACE) if name != "wheel_count"]


@pytest.fixture
def explorer():
    return Explorer()


def drawn(explorer):
    """Pixels of the picture on the screen, and the words of its alt text."""
    found = re.search(r'alt="([^"]*)" src="data:image/png;base64,([^"]+)"', explorer.controls.picture.value)
    assert found, explorer.controls.picture.value[:300]
    return matplotlib.image.imread(io.BytesIO(base64.b64decode(found[2]))), found[1]


def assert_current(explorer):
    """What is shown is what `evaluate` says about the design and the mission that the inputs show."""
    explorer.settle()
    assert not explorer.error
    wanted = rdk.evaluate(explorer.design, explorer.scenario, model=explorer.model)
    for name, value in wanted.numbers().items():
        np.testing.assert_array_equal(explorer.result.numbers()[name], value, err_msg=name)
    words = html.unescape(explorer.controls.readout.value)
    assert explain.binding(explorer.design, explorer.scenario, wanted, explorer.model).sentence in words
    assert f"<b>{wanted.range_km:.2f} km</b>" in words and f"<b>{wanted.total_mass_kg:.2f} kg</b>" in words
    assert f"<b>{wanted.slope_capability_deg:.1f} deg</b>" in words
    for name in "range_km", "total_mass_kg":
        assert explorer.intervals.low[name] <= explorer.intervals.high[name]


# ---- views and inputs -----------------------------------------------------------------------------------------

@pytest.mark.parametrize("view", VIEWS)
def test_every_view_shows_a_picture_or_says_why_not(view):
    explorer = Explorer("Pragyan", "polar_prospecting", view)
    for mission in CANONICAL:
        explorer.set(mission=mission)
        assert_current(explorer)
        if view == "optimise":
            assert "No front yet" in explorer.controls.picture.value
        elif view == "keep":
            assert explorer.controls.picture.value == "" and "design.json" in explorer.controls.links.value
        else:
            pixels, words = drawn(explorer)
            assert np.ptp(pixels[..., :3]) == 1 and (pixels[..., :3] < 0.9).any(2).mean() > 0.004      # not blank
            assert len(words) > 40 and "nan" not in words


def test_the_panel_of_the_view_is_the_one_that_shows(explorer):
    for view in VIEWS:
        explorer.set(view=view)
        explorer.settle()
        shown = [name for name, panel in explorer.controls.panels.items() if panel.layout.display is None]
        assert shown == [name for name in explorer.controls.panels if name == view]
        assert "rdk-waiting" not in explorer.controls.picture._dom_classes
    explorer.set(view="optimise")
    assert explorer.inputs["page"].value == "search"
    explorer.set(page="mission")
    assert [name for name, page in explorer.controls.pages.items() if page.layout.display is None] == ["mission"]


MENUS = [(name, view) for name, view in (
    *((n, "log") for n in ("rover", "mission", "soil", "wheel_count", "page", "view", "range_goal", "mass_goal",
                           "slope_goal")),
    ("baseline", "why"), ("why_metric", "why"), ("sweep_first", "sweep"), ("sweep_second", "sweep"),
    ("sweep_metric", "sweep"), ("script", "keep"))]


def test_the_list_of_menus_is_complete(explorer):
    kinds = ipywidgets.Dropdown, ipywidgets.ToggleButtons
    assert {n for n, w in explorer.inputs.items() if isinstance(w, kinds)} == {name for name, _ in MENUS}


@pytest.mark.parametrize("name, view", MENUS)
def test_every_choice_of_every_menu(explorer, name, view):
    explorer.set(view=view, peak_wheel_torque_nm=2.0)                # differs from its baseline
    for choice in explorer.inputs[name]._options_values:
        explorer.set(**{name: choice})
        assert_current(explorer)
        assert explorer.inputs[name].value == choice


def test_choosing_a_rover_or_a_mission_shows_its_values_and_its_study(explorer):
    for name in rdk.rover_names():
        explorer.set(rover=name)
        assert explorer.design == rdk.rover(name)
    for name in rdk.scenario_names():
        explorer.set(mission=name)
        assert explorer.scenario == rdk.scenario(name)
    for name in CANONICAL:
        explorer.set(mission=name)
        problem, study = explorer._problem(), rdk.scenario(name).problem
        assert problem["objectives"] == study.objectives and problem["seed"] == study.seed
        assert tuple(problem["constraints"]) == study.constraints


def test_menus_never_name_what_is_not_shown(explorer):
    explorer.set(wheel_radius_m=0.12)
    assert explorer.inputs["rover"].value == OWN and explorer.inputs["mission"].value == MARE
    explorer.set(soil="fjs-1")
    assert explorer.inputs["mission"].value == OWN == explorer.scenario.name
    explorer.set(rover="Rashid-1", mission=MARE)         # back, in one choice each
    assert explorer.design == rdk.rover("Rashid-1") and explorer.scenario == rdk.scenario(MARE)


@pytest.mark.parametrize("name", CONTINUOUS)
def test_both_ends_of_every_slider(explorer, name):
    control = explorer.controls._numbers[name]
    for end in control.slider.min, control.slider.max:
        control.slider.value = end                       # as a browser does
        assert control.box.value == end
        assert_current(explorer)
        assert explorer.scenario.numbers().get(name, end) == end == explorer.design.numbers().get(name, end)


def test_a_slider_that_a_browser_snaps_to_its_steps_does_not_move_the_box(explorer):
    control = explorer.controls._numbers["wheel_radius_m"]
    explorer.set(wheel_radius_m=0.1234)
    control.slider.value = 0.125                         # the step beside it
    assert control.box.value == 0.1234
    control.slider.value = 0.13                          # one press of a key
    assert control.box.value == 0.13
    control.slider.value = 0.13 + 0.05 + 1e-16           # binary dust of a browser
    assert control.box.value == 0.18


@pytest.mark.parametrize("values, words", [
    (dict(wheel=1), "no input 'wheel'; choose from wheel_radius_m"),
    (dict(slope_deg=36), "slope_deg must be a number from 0 to 35; got 36"),
    (dict(slope_deg=np.nan), "slope_deg must be a number from 0 to 35; got nan"),
    (dict(slope_deg="5"), "slope_deg must be a number from 0 to 35; got '5'"),
    (dict(grouser_count=2.5), "grouser_count must be a whole number from 0 to 24; got 2.5"),
    (dict(soil="mud"), "soil must be one of fjs-1, "), (dict(wheel_count=5), "wheel_count must be one of 4, 6"),
    (dict(view="x"), "view must be one of log, "), (dict(point=3), "point must be one of")])
def test_set_names_what_is_wrong_and_what_is_allowed(explorer, values, words):
    before = explorer.design, explorer.scenario
    with pytest.raises(ValueError, match=re.escape(words)):
        explorer.set(**values)
    assert (explorer.design, explorer.scenario) == before
    assert_current(explorer)


def test_wrong_arguments():
    with pytest.raises(ValueError, match="no view 'logs'; choose from log, mass"):
        Explorer(view="logs")
    with pytest.raises(ValueError, match="no rover 'X'; choose from"):
        Explorer("X")
    with pytest.raises(ValueError, match="model must hold single numbers; got arrays of shape"):
        Explorer(model=rdk.Model(drivetrain_efficiency=[0.7, 0.8]))


def test_a_design_and_a_mission_of_ones_own_beyond_the_sliders_are_cut_and_said():
    design = dataclasses.replace(rdk.rover("Rashid-1"), wheel_radius_m=0.3, battery_capacity_wh=1.0)
    soil = dataclasses.replace(rdk.soil("fjs-1"), friction_angle_deg=33.0)
    mission = rdk.Scenario(name=MARE, latitude_deg=5, soil=soil, duration_earth_days=3.5, slope_deg=4, duty_cycle=0.1,
                           panel_azimuth_deg=90)
    explorer = Explorer(design, mission)
    said = explorer.controls.notice.value
    for words in ("wheel radius 0.3 cut to 0.2", "battery capacity 1 cut to 5", "range limit inf cut to 200",
                  "panel turned from 90 deg"):
        assert words in said
    assert explorer.design == dataclasses.replace(design, wheel_radius_m=0.2, battery_capacity_wh=5.0)
    assert explorer.scenario.soil == soil and explorer.scenario.name == OWN
    assert explorer.scenario.duration_earth_days == 3.5
    assert_current(explorer)


# ---- words ----------------------------------------------------------------------------------------------------

def sound(text):
    return not re.search(r"\bnan\b|\binf\b", text)


def test_all_corners_of_the_design_box_have_an_answer():
    ends = [(v.low, v.high) for v in rdk.DESIGN_SPACE.values()]
    corners = np.array(list(itertools.product(*ends)))
    designs = rdk.Design(**dict(zip(rdk.DESIGN_SPACE, corners.T)))
    assert designs.shape == (2**11,)
    chosen = np.random.default_rng(5).choice(2**11, 48, replace=False)
    for mission in map(rdk.scenario, CANONICAL):
        result = rdk.evaluate(designs, mission)
        for name in "range_km", "total_mass_kg", "slope_capability_deg", "energy_balance_pct", "final_soc":
            assert np.isfinite(getattr(result, name)).all(), name
        for i in chosen:
            explained(designs[i], mission)


def explained(design, mission):
    """Words for one design on one mission, checked against the numbers."""
    result = rdk.evaluate(design, mission)
    key, sentence, detail = explain.binding(design, mission, result)
    assert sound(sentence + detail) and sentence.endswith(".")
    assert result.stalled == (key in ("torque", "traction", "soil"))
    assert (result.range_km >= mission.traverse_limit_km > 0) <= (key == "range limit")
    assert bool(detail) == (key in ("hub speed", "battery") or key == "sun" and result.range_km > 0)
    limits = {limit.metric: limit for limit in explain.limits(design, mission, result)}
    assert all(sound(limit.words) for limit in limits.values())
    assert limits["stalled"].met != result.stalled and limits["thermal_survival"].met == result.thermal_survival
    assert limits["range_km"].met == (result.range_km > 0)
    met = all(limits[n].met for n in ("stalled", "range_km", "energy_balance_pct", "obstacle_capability_m"))
    assert met == result.feasible
    return key


@pytest.mark.parametrize("mission", rdk.scenario_names())
def test_single_extremes_on_every_mission_are_explained(mission):
    base, mission = rdk.rover("Rashid-1"), rdk.scenario(mission)
    for name, variable in rdk.DESIGN_SPACE.items():
        for end in variable.low, variable.high:
            explained(dataclasses.replace(base, **{name: end}), mission)


def test_all_corners_of_the_mission_box_are_explained():
    design, soil = rdk.rover("MoonRanger"), rdk.soil("apollo-loose")
    for values in itertools.product(*((v.low, v.high) for v in MISSION_SPACE.values())):
        explained(design, rdk.Scenario(name="corner", soil=soil, **dict(zip(MISSION_SPACE, values))))


def test_binding_finds_each_cause():
    rover, mare = rdk.rover("Rashid-1"), rdk.scenario(MARE)
    d, m = dataclasses.replace, dataclasses.replace
    far = m(mare, traverse_limit_km=1e4)
    cases = {"range limit": (rover, mare), "torque": (d(rover, peak_wheel_torque_nm=0.05), mare),
             "traction": (rover, m(mare, slope_deg=30)), "duty": (rover, m(mare, duty_cycle=0)),
             "sun": (d(rover, solar_area_m2=0.1), m(far, duty_cycle=1)), "hub speed": (rover, far),
             "soil": (rover, m(mare, soil=d(mare.soil, frictional_modulus_kn_m_n2=1e-3, cohesive_modulus_kn_m_n1=1e-3)))}
    for key, (design, mission) in cases.items():
        result = rdk.evaluate(design, mission)
        found = explain.binding(design, mission, result)
        assert found.key == key, found


def test_the_binding_lever_is_the_one_that_gains_most():
    rover, polar = rdk.rover("Rashid-1"), rdk.scenario("polar_prospecting")
    for design in (rover, dataclasses.replace(rover, battery_capacity_wh=500, solar_area_m2=1.5, peak_wheel_torque_nm=2)):
        base = rdk.evaluate(design, polar)
        found = explain.binding(design, polar, base)
        scale = {500: 1 / 1.1, 1.5: 1 / 1.1}             # no more of it inside the design space: 9 % less
        gains = []
        for name in "solar_area_m2", "battery_capacity_wh":
            value = getattr(design, name)
            factor = scale.get(value, 1.1)
            ratio = rdk.evaluate(dataclasses.replace(design, **{name: value * factor}), polar).range_km / base.range_km
            gains.append(100 * (ratio if factor > 1 else 1 / ratio) - 100)
        fast = rdk.evaluate(design, dataclasses.replace(polar, traverse_limit_km=99),
                            model=rdk.Model(hub_no_load_speed_rad_s=5.5))
        gains.insert(0, 100 * fast.range_km / base.range_km - 100)
        assert found.detail.startswith("10 % more hub speed gives {:.1f} % more range, array {:.1f} %, battery {:.1f} %"
                                       .format(*gains))
        assert found.key == "hub speed" and max(gains) == gains[0]


def test_a_buried_rover_is_said_to_be_so():
    mud = dataclasses.replace(rdk.soil("apollo-loose"), frictional_modulus_kn_m_n2=1e-3, cohesive_modulus_kn_m_n1=1e-3)
    explorer = Explorer(scenario=dataclasses.replace(rdk.scenario(MARE), soil=mud))
    for view in VIEWS:
        explorer.set(view=view, sweep_metric="slip", why_metric="slip")
        assert_current(explorer)
        assert explorer.binding.key == "soil" and "none to none" in explorer.controls.readout.value
        assert sound(explorer.text())


def test_texts_for_readers_without_a_kernel(explorer):
    bundle = explorer._repr_mimebundle_()
    assert bundle["application/vnd.jupyter.widget-view+json"]["model_id"] == explorer.controls.widget.model_id
    assert bundle["text/plain"].startswith("The range limit binds") and "✗ missed" in bundle["text/plain"]
    assert base64.b64decode(bundle["image/png"]).startswith(b"\x89PNG")
    again = Explorer()._repr_mimebundle_()
    assert {k: again[k] for k in ("text/plain", "image/png")} == {k: bundle[k] for k in ("text/plain", "image/png")}
    explorer.set(view="keep")
    explorer.settle()
    assert "image/png" not in explorer._repr_mimebundle_()


def test_an_error_becomes_words_and_goes_away(explorer, monkeypatch):
    def broken(*args, **kwargs):
        raise RuntimeError("<no sun>")
    monkeypatch.setattr(explorer_module, "evaluate", broken)
    explorer.set(slope_deg=3)
    explorer.settle()
    assert explorer.error == explorer.text() == "RuntimeError: <no sun>"
    assert explorer.controls.readout.value == "" and "&lt;no sun&gt;" in explorer.controls.picture.value
    monkeypatch.undo()
    explorer.set(slope_deg=4)
    assert_current(explorer)


# ---- one answer for the newest state --------------------------------------------------------------------------

def test_refresher_answers_a_burst_with_the_newest_state():
    seen, begun, go = [], threading.Event(), threading.Event()
    state = [0]

    def work():
        seen.append(state[0])
        begun.set()
        assert go.wait(10)

    refresher = Refresher(work)
    refresher.poke()
    assert begun.wait(10)
    for i in range(1, 51):
        state[0] = i
        refresher.poke()
    with pytest.raises(TimeoutError, match="did not settle within 0.01 s"):
        refresher.settle(0.01)
    go.set()
    refresher.settle(10)
    assert seen == [0, 50]
    refresher.settle(0)                                  # nothing to do


def test_refresher_survives_an_error_and_reports_it():
    fails = [True]

    def work():
        if fails[0]:
            raise KeyError("lost")

    refresher = Refresher(work)
    refresher.settle(0)
    refresher.poke()
    with pytest.raises(KeyError, match="lost"):
        refresher.settle(10)
    fails[0] = False
    refresher.poke()
    refresher.settle(10)
    assert refresher.error is None


def test_refresher_loses_no_poke_from_many_threads():
    state, shown = itertools.count(), []
    refresher = Refresher(lambda: shown.append(next(state)))
    latest = []

    def poke():
        for _ in range(200):
            refresher.poke()
    threads = [threading.Thread(target=poke) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    refresher.settle(10)
    latest = len(shown)
    assert 1 <= latest <= 800 and refresher._done == refresher._wanted == 800


@pytest.mark.parametrize("view", ["log", "sweep", "why"])
def test_a_burst_leaves_nothing_stale(explorer, view):
    explorer.set(view=view)
    for i in range(20):
        explorer.set(wheel_radius_m=0.06 + 0.005 * i, slope_deg=i)
    assert_current(explorer)
    shown = explorer.controls.picture.value
    explorer._changed()
    explorer.settle()
    assert explorer.controls.picture.value == shown      # the picture, too, is that of the state shown


def test_callbacks_from_several_threads(explorer):
    """Since JupyterLab 4.4 a callback may run in a thread of its own."""
    errors = []

    def move(names, seed):
        try:
            chance = random.Random(seed)
            for _ in range(40):
                name = chance.choice(names)
                if name == "mission":
                    explorer.set(mission=chance.choice(CANONICAL))
                else:
                    slider = explorer.controls._numbers[name].slider
                    slider.value = chance.randrange(11) / 10 * (slider.max - slider.min) + slider.min
        except Exception as error:
            errors.append(error)

    groups = [CONTINUOUS[:6], CONTINUOUS[4:12], CONTINUOUS[10:], ["mission"]]
    threads = [threading.Thread(target=move, args=(names, i)) for i, names in enumerate(groups)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not errors
    assert_current(explorer)
    for name, control in explorer.controls._numbers.items():
        assert abs(control.box.value - control.slider.value) <= 0.5001 * control.slider.step, name


def test_two_explorers_do_not_disturb_each_other():
    first, second = Explorer("Yutu-2", "polar_prospecting", "mass"), Explorer("Tenacious", MARE, "stress")
    still = second.controls.readout.value, second.controls.picture.value
    first.set(generations=3, population=8)
    first.optimise()
    for i in range(10):
        first.set(wheel_radius_m=0.1 + 0.005 * i, view=VIEWS[i % 4])
    first.optimise(wait=True)
    first.settle()
    assert (second.controls.readout.value, second.controls.picture.value) == still
    assert second.front is None and second.design == rdk.rover("Tenacious")
    moves = [threading.Thread(target=lambda e=e: [e.set(slope_deg=i) for i in range(15)]) for e in (first, second)]
    for thread in moves:
        thread.start()
    for thread in moves:
        thread.join()
    assert_current(first)
    assert_current(second)


def test_a_random_walk_of_300_moves_keeps_working_and_keeps_no_memory(explorer):
    chance = random.Random(1)
    menus = {name: explorer.inputs[name]._options_values for name in
             ("rover", "mission", "soil", "wheel_count", "why_metric", "sweep_first", "sweep_metric")}

    def walk(moves, views):
        for _ in range(moves):
            if chance.random() < 0.25:
                name = chance.choice(list(menus))
                explorer.set(**{name: chance.choice(menus[name])})
            else:
                slider = explorer.controls._numbers[chance.choice(CONTINUOUS)].slider
                low, high = (slider.value + way * slider.step for way in (-1, 1))
                slider.value = min(max(chance.choice([low, high]), slider.min), slider.max)
            if chance.random() < 0.3:
                explorer.set(view=chance.choice(views))
            if chance.random() < 0.25:
                assert_current(explorer)
        assert_current(explorer)

    def artists():
        explorer.set(rover="Rashid-1", mission=MARE, why_metric="range_km", sweep_first="slope_deg", baseline="Yutu-2")
        for view in ("log", "mass", "stress", "rovers", "why", "sweep"):
            explorer.set(view=view)
            assert_current(explorer)
        gc.collect()
        kinds = matplotlib.patches.Patch, matplotlib.text.Annotation, matplotlib.legend.Legend
        return sum(isinstance(thing, kinds) for thing in gc.get_objects())

    before = artists()
    walk(240, ["log", "mass", "stress", "rovers", "why", "sweep", "keep"])
    assert artists() == before
    tracemalloc.start()                                  # slows the walk down fivefold: only for its end
    try:
        walk(10, ["log", "keep"])
        before = tracemalloc.get_traced_memory()[0]
        walk(50, ["log", "keep"])
        grown = tracemalloc.get_traced_memory()[0] - before
    finally:
        tracemalloc.stop()
    assert grown < 1e6                                   # a picture kept per move would be 2.5 MB


# ---- fronts ---------------------------------------------------------------------------------------------------

def test_the_search_of_a_mission_is_that_of_pareto_front(explorer):
    explorer.set(population=20, generations=6, view="optimise")
    explorer.optimise(wait=True)
    wanted = rdk.pareto_front(rdk.scenario(MARE), population=20, generations=6)
    for name in rdk.DESIGN_SPACE:
        np.testing.assert_array_equal(getattr(explorer.front.designs, name), getattr(wanted.designs, name))
    see = explorer.controls
    assert f"done: {len(wanted)} designs after 6 generations" in see.status.value
    assert (see.run.disabled, see.cancel.disabled, see.progress.value) == (False, True, 6)
    assert len(see.points.options) == len(wanted) and see.points.value is None
    _, words = drawn(explorer)
    assert words.startswith(f"Front of {len(wanted)} designs: total mass (kg) from")


def test_a_point_of_the_front_becomes_the_design(explorer):
    explorer.set(population=12, generations=4, view="optimise")
    explorer.optimise(wait=True)
    for i in (len(explorer.front) - 1, 0):
        explorer.set(point=i)
        assert explorer.design == explorer.front.designs[i]
        assert_current(explorer)
        assert explorer.result.total_mass_kg == pytest.approx(explorer.front.performance.total_mass_kg[i], rel=1e-12)
    assert explorer.inputs["rover"].value == OWN and explorer.controls.points.value == 0
    spots = json.loads(re.search(r'data-points="([^"]*)"', explorer.controls.picture.value)[1])
    assert len(spots) == 2 * len(explorer.front)         # in both panels
    assert all(0 < right < 1 and 0 < down < 1 for _, right, down in spots)
    assert [i for i, _, _ in spots] == 2 * list(range(len(explorer.front)))
    masses = explorer.front.performance.total_mass_kg
    across = np.array([right for _, right, _ in spots[:len(masses)]])
    # a straight scale from mass to place; rounded to four digits
    np.testing.assert_allclose(np.interp(masses, masses[[0, -1]], across[[0, -1]]), across, atol=2e-4)


def test_cancel_ends_the_search_and_keeps_what_it_found(explorer):
    explorer.set(population=20, generations=1000, view="optimise")
    third = threading.Event()
    explorer.controls.progress.observe(lambda change: change.new >= 3 and third.set(), "value")
    explorer.controls.run.click()
    assert third.wait(60) and explorer.controls.run.disabled and not explorer.controls.cancel.disabled
    explorer.controls.run.click()                        # a second press starts nothing
    explorer.set(slope_deg=10)                           # nor do moves disturb the search
    explorer.controls.cancel.click()
    explorer.optimise(wait=True) if explorer._thread is None else explorer._thread.join(60)
    explorer.settle()
    found = re.search(r"stopped after generation (\d+) of 1000", explorer.controls.status.value)
    assert found and explorer.front.scenario.slope_deg == 15
    assert not explorer.controls.run.disabled and explorer.controls.cancel.disabled
    assert_current(explorer)
    space = {}
    explorer.set(script="the front")
    exec(explorer.python(), space)                       # as many generations as were run
    np.testing.assert_array_equal(space["front"].designs.wheel_radius_m, explorer.front.designs.wheel_radius_m)


def test_a_slope_beyond_the_capability_may_be_climbed_at_a_higher_slip():
    rover, highland = rdk.rover("Rashid-1"), rdk.scenario("highland_slope_capability")

    def row(slope_deg):
        mission = dataclasses.replace(highland, slope_deg=slope_deg)
        result = rdk.evaluate(rover, mission)
        return result, next(limit for limit in explain.limits(rover, mission, result) if "slope" in limit.metric)

    (gentle, met), (steep, missed), (wall, stalled) = row(5.0), row(15.0), row(30.0)
    assert met.met and met.words == "5 deg at slip 0.6" and gentle.slip < 0.6
    assert not missed.met and missed.words == f"15 deg at slip 0.6 (climbed at slip {steep.slip:.2f})"
    assert not stalled.met and stalled.words == "30 deg at slip 0.6" and wall.stalled


def test_the_front_grows_on_the_screen(explorer, monkeypatch):
    def unhurried(*args, on_generation, **problem):
        """The search, waiting for each picture: a fast one would be over before the second is drawn."""
        def follow(progress):
            stop = on_generation(progress)
            explorer.settle()
            return stop
        return search(*args, on_generation=follow, **problem)

    search, clock = explorer_module.pareto_front, itertools.count()
    monkeypatch.setattr(explorer_module, "pareto_front", unhurried)
    monkeypatch.setattr(explorer_module.time, "monotonic", lambda: next(clock))      # every generation is due
    seen = []
    explorer.controls.picture.observe(lambda change: seen.append(change.new), "value")
    explorer.set(population=20, generations=12, view="optimise")
    explorer.optimise(wait=True)
    assert len({text for text in seen if "front of the search" in text or "Front of" in text}) >= 8
    assert_current(explorer)


@pytest.mark.parametrize("values, words", [
    (dict(range_goal="ignore", mass_goal="ignore", slope_goal="ignore"), "ValueError: objectives must name at least one"),
    (dict(minimum_range_km=1000.0), "no design of 2 generations met the constraints range_km &gt;= 1000"),
    (dict(maximum_mass_kg=1.0), "no design of 2 generations met the constraints")])
def test_a_search_without_a_result_says_why(explorer, values, words):
    explorer.set(population=8, generations=2, view="optimise", **values)
    explorer.optimise(wait=True)
    assert words in explorer.controls.status.value and explorer.controls.points.options == ()
    assert not explorer.error and not explorer.controls.run.disabled
    explorer.set(view="keep")
    assert_current(explorer)
    assert "front.csv" not in explorer.controls.links.value


def test_the_live_front_follows_the_mission(explorer):
    explorer.set(view="live front")
    assert explorer.inputs["page"].value == "mission"
    explorer.settle()
    fronts = [explorer.front]
    for values in dict(latitude_deg=-60), dict(slope_deg=5), dict(soil="apollo-loose"), dict(payload_mass_kg=12):
        explorer.set(**values)
        assert_current(explorer)
        fronts.append(explorer.front)
        assert fronts[-1] is not fronts[-2] and len(fronts[-1])
        assert fronts[-1].scenario == dataclasses.replace(explorer.scenario, problem=Problem())
        assert len(fronts[-1].objective_history) == 12   # half of the first: it starts from the last front
    assert len(fronts[0].objective_history) == 24
    explorer.set(wheel_radius_m=0.15)                    # the design is no part of the mission
    explorer.settle()
    assert explorer.front is fronts[-1]
    explorer.set(point=0)
    assert explorer.design == fronts[-1].designs[0]
    assert_current(explorer)


def test_a_live_front_without_a_design_says_so_and_recovers(explorer):
    explorer.set(view="live front", required_obstacle_height_m=0.3)
    explorer.settle()
    assert "no design of" in explorer.controls.picture.value and len(explorer.front) == 0 and not explorer.error
    explorer.set(required_obstacle_height_m=0.1)
    explorer.settle()
    assert len(explorer.front) and explorer.front.performance.obstacle_capability_m.min() >= 0.1


def test_the_program_ends_while_a_search_runs():
    code = ("import rdk; e = rdk.explorer.Explorer(); e.set(generations=1000, population=400, view='optimise');"
            "e.optimise(); e.set(slope_deg=3); print('end')")
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120)
    assert (done.returncode, done.stdout, done.stderr) == (0, "end\n", "")


# ---- files and Python -----------------------------------------------------------------------------------------

def files(explorer):
    """Contents of the download links."""
    explorer.set(view="keep")
    explorer.settle()
    found = re.findall(r'download="([^"]+)" href="data:text/plain;base64,([^"]+)"', explorer.controls.links.value)
    return {name: base64.b64decode(text) for name, text in found}


def upload(explorer, name, content):
    explorer.controls.upload.value = (dict(name=name, type="", size=len(content), content=memoryview(content),
                                           last_modified=datetime(2026, 1, 1)),)


@pytest.mark.parametrize("name", ["design.json", "design.csv"])
def test_a_kept_design_comes_back(explorer, name):
    explorer.set(mission="polar_prospecting", wheel_radius_m=0.123, wheel_count=6, soil="fjs-1", latitude_deg=-70.5)
    kept, design, mission = files(explorer), explorer.design, explorer.scenario
    for _ in range(2):                                   # the same file twice
        explorer.set(rover="Yutu-2", mission=MARE)
        upload(explorer, name, kept[name])
        assert explorer.design == design and explorer.controls.upload.value == ()
        assert f"{name} loaded" in explorer.controls.notice.value
        assert_current(explorer)
    if name == "design.json":
        assert explorer.scenario == dataclasses.replace(mission, problem=Problem())


@pytest.mark.parametrize("name", ["front.json", "front.csv"])
def test_a_kept_front_comes_back(explorer, name):
    explorer.set(population=12, generations=3)
    explorer.optimise(wait=True)
    kept, front = files(explorer), explorer.front
    other = Explorer("Yutu-2")
    other.load(name, kept[name])
    other.set(view="optimise")
    assert_current(other)
    assert other.design == front.designs[0] and len(other.front) == len(front)
    np.testing.assert_allclose(other.front.performance.range_km, front.performance.range_km, rtol=1e-12)
    other.set(point=1)
    assert other.design == front.designs[1]
    assert files(other)[name] == kept[name]
    other.set(script="the front")
    assert other.python().startswith("# No front of a finished search")


def test_a_front_beyond_the_sliders_is_cut(explorer):
    wide = rdk.random_designs(3, seed=1, bounds={"wheel_radius_m": (0.25, 0.3)})
    explorer.load("front.csv", catalog.to_csv(wide).encode())
    assert (explorer.front.designs.wheel_radius_m == 0.2).all() and explorer.design.wheel_radius_m == 0.2
    assert_current(explorer)


GOOD = json.loads(catalog.to_json(rdk.rover("Rashid-1"), rdk.scenario(MARE)))


def damaged(**changes):
    return json.dumps({**GOOD, **changes}).encode()


@pytest.mark.parametrize("name, content, words", [
    ("a.json", b"", "not a JSON file"), ("a.json", b"\xff\xfe\x00", "was not loaded"), ("a.json", b"[1]", "not a design kept"),
    ("a.json", b"[" * 100_000, "not a JSON file"), ("a.json", damaged(format="x"), "not a design kept"),
    ("a.json", damaged(design={}), "lacks wheel_radius_m"), ("a.json", damaged(design=[1]), "not a design kept"),
    ("a.json", damaged(design={**GOOD["design"], "wheel_count": 5}), "wheel_count must be one of 4, 6"),
    ("a.json", damaged(design={**GOOD["design"], "wheel_radius_m": "wide"}), "wheel_radius_m must be"),
    ("a.json", damaged(design={**GOOD["design"], "wheel_radius_m": None}), "wheel_radius_m must be"),
    ("a.json", damaged(design={**GOOD["design"], "wheel_radius_m": float("nan")}), "wheel_radius_m must be"),
    ("a.json", damaged(design={**GOOD["design"], "wheel_radius_m": [[0.1, 0.1]]}), "one design or a list"),
    ("a.json", damaged(design={n: [] for n in GOOD["design"]}), "one design or a list"),
    ("a.json", damaged(scenario=3), "scenario is damaged"), ("a.json", damaged(scenario={}), "scenario is damaged"),
    ("a.json", damaged(scenario={**GOOD["scenario"], "soil": "mud"}), "soil is damaged"),
    ("a.json", damaged(scenario={**GOOD["scenario"], "latitude_deg": 100}), "latitude_deg must be"),
    ("a.json", damaged(scenario={**GOOD["scenario"], "latitude_deg": [1, 2]}), "must hold single numbers"),
    ("a.csv", b"", "needs a header and at least one row"), ("a.csv", b"a,b\n1,2\n", "lacks the columns wheel_radius_m"),
    ("a.csv", catalog.to_csv(rdk.rover("Rashid-1")).encode().replace(b"0.1,", b"x,", 1), "wheel_radius_m must be a number"),
    ("a.csv", catalog.to_csv(rdk.rover("Rashid-1")).encode() + b"0.1,0.2\n", "row 2 of the CSV file has 2 values"),
    ("a.CSV", b'"' + b"x" * 200_000, "not a CSV file"), ("<b>.json", b"{", "&lt;b&gt;.json was not loaded")])
def test_a_damaged_file_is_refused_in_words(explorer, name, content, words):
    before = explorer.design, explorer.scenario
    explorer.load(name, content)
    assert words in explorer.controls.notice.value.replace("&#x27;", "'")
    assert 'role="alert"' in explorer.controls.notice.value
    assert (explorer.design, explorer.scenario) == before
    assert_current(explorer)


@pytest.mark.parametrize("model", [rdk.Model(), rdk.Model(drivetrain_efficiency=0.7, hub_no_load_speed_rad_s=np.inf)])
@pytest.mark.parametrize("script", SCRIPTS)
def test_the_python_reproduces_what_is_shown(model, script):
    explorer = Explorer("Pragyan", "highland_slope_capability", model=model)
    explorer.set(wheel_radius_m=0.1234, slope_deg=12, payload_mass_kg=4, baseline="CADRE-unit", sweep_first="grouser_count",
                 sweep_second="slope_deg", population=12, generations=3, script=script, view="keep")
    explorer.optimise(wait=True)
    explorer.set(latitude_deg=33)                        # the front is still that of the mission before
    explorer.settle()
    code, space = explorer.controls.code.value, {}
    assert code == explorer.python() and max(map(len, code.splitlines())) < 1200
    exec(code, space)
    result = rdk.evaluate(explorer.design, explorer.scenario, model=model)
    if script == "the read-outs":
        assert space["result"].numbers() == result.numbers() == explorer.result.numbers()
        for name in "range_km", "slip":
            assert space["intervals"].low[name] == explorer.intervals.low[name]
            assert space["intervals"].high[name] == explorer.intervals.high[name]
    elif script == "why":
        wanted = rdk.attribution(explorer.design, rdk.rover("CADRE-unit"), explorer.scenario, model=model)
        np.testing.assert_array_equal(space["why"].contributions["range_km"], wanted.contributions["range_km"])
    elif script == "the sweep":
        assert space["curve"].fields == ("grouser_count", "slope_deg")
        assert space["curve"].performance.shape == (25, 25)
        at = space["curve"].values[0] == explorer.design.grouser_count
        assert at.any()
    else:
        for name in rdk.DESIGN_SPACE:
            np.testing.assert_array_equal(getattr(space["front"].designs, name), getattr(explorer.front.designs, name))
        assert space["mission"].latitude_deg == rdk.scenario("highland_slope_capability").latitude_deg


def test_python_without_a_front_says_how_to_get_one(explorer):
    explorer.set(script="the front")
    assert "press Run" in explorer.python()


# ---- pictures -------------------------------------------------------------------------------------------------

def test_why_adds_up_and_says_when_there_is_no_difference():
    figure = pictures.blank()
    shares = np.array([3.0, -1.0, 0.5, 0, 0, 0, 0, 0, 0, 0, 1e-17])
    words = pictures.why(figure, "range_km", shares, 10.0, 12.5, "a baseline")
    bars = figure.axes[0].patches
    assert len(bars) == 3
    np.testing.assert_allclose([bar.get_width() for bar in bars], [3.0, -1.0, 0.5])
    np.testing.assert_allclose(bars[-1].get_x() + bars[-1].get_width(), 12.5)        # ends at this design
    assert words.endswith("wheel radius (m) +3; wheel width (m) -1; grouser height (m) +0.5.")
    assert pictures.why(figure, "range_km", shares * 1e-17, 10.0, 10.0, "a baseline").startswith("No difference")


def test_the_log_starts_at_sunrise_with_a_full_pack(explorer):
    figure = pictures.blank()
    pictures.log(figure, explorer.result, explorer.scenario)
    charge = figure.axes[1].lines[0]
    assert (charge.get_xdata()[0], charge.get_ydata()[0]) == (0, 100)
    np.testing.assert_array_equal(charge.get_ydata()[1:], 100 * explorer.result.log.soc)
    distance = figure.axes[2].lines[0].get_ydata()
    assert distance[0] == 0 and distance[-1] == explorer.result.range_km


def test_the_sweep_marks_this_design_on_its_curve(explorer):
    explorer.set(view="sweep", sweep_first="slope_deg", sweep_metric="slip")
    explorer.settle()
    curve, here = explorer._figures["sweep"].axes[0].lines[:2]
    at = np.interp(here.get_xdata(), curve.get_xdata(), curve.get_ydata())
    np.testing.assert_allclose(at, here.get_ydata(), atol=0.01)      # between points of the curve, 1.5 deg apart
    assert here.get_ydata()[0] == explorer.result.slip
