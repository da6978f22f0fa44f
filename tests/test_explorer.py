"""The explorer without a browser: inputs, events of the page, history, pins, threads, files and the optimiser."""

import dataclasses
import html
import itertools
import json
import math
import random
import re
import subprocess
import sys
import threading
import tracemalloc
import xml.etree.ElementTree

import numpy as np
import pytest

import rdk
from rdk import catalog, explain, pictures
from rdk.design import Problem
from rdk.explorer import Explorer, answers, page
from rdk.explorer import app as explorer_module
from rdk.explorer.inputs import DESIGN, MENUS, METRICS, MISSION, NUMBERS, OWN, SOIL, VIEWS
from rdk.rover_picture import contact, failing, rover_picture, wheel_picture
from rdk.sampling import Attribution

MARE, POLAR = "equatorial_mare_traverse", "polar_prospecting"
CANONICAL = rdk.scenario_names("canonical")


@pytest.fixture(scope="module")
def made():
    draws, answers.DRAWS = answers.DRAWS, 64             # one test uses them all
    yield Explorer()
    answers.DRAWS = draws


@pytest.fixture
def explorer(made):
    """The one explorer of this module, as it starts."""
    made.front, made._recipe, made._pins = None, None, []
    made._notice, made._drawer, made._reading = ("", ""), ("", ""), ""
    made.set(rover="Rashid-1", mission=MARE, preset="paper", view="log", live=False, population=50, generations=60,
             why_metric="range_km", baseline="MoonRanger", sweep_first="wheel_radius_m", sweep_second="",
             sweep_metric="range_km",
             hub_no_load_speed_rad_s=5.0, drivetrain_efficiency=0.8, growth_fraction=0.2,
             front_x="total_mass_kg", front_y="slope_capability_deg", front_colour="range_km")
    made._past.clear()
    made._future.clear()
    made._drag = ("", 0)
    made.settle()
    return made


def events(explorer, *found):
    """What the page would send."""
    number = explorer._heard
    explorer.bridge.value = json.dumps([[number + 1 + i, *event] for i, event in enumerate(found)])
    explorer.settle()


def shown(explorer, part="verdict"):
    return html.unescape(re.sub(r"<[^>]*>", " ", explorer.parts[part].value))


def told(explorer):
    """The values that the page was sent."""
    return json.loads(html.unescape(re.search(r'data-state="([^"]*)"', explorer.parts["data"].value)[1]))


def sound(picture):
    """A picture is well-formed and holds no number that is none."""
    xml.etree.ElementTree.fromstring(picture)
    assert not re.search(r"\b(nan|inf)\b", picture), re.search(r".{60}\b(nan|inf)\b.{20}", picture)[0]
    return pictures.alt(picture)


def assert_current(explorer):
    """What is shown is what `evaluate` says about the design and the mission that the inputs show."""
    explorer.settle()
    assert not explorer.error
    wanted = rdk.evaluate(explorer.design, explorer.scenario, model=explorer.model)
    for name, value in wanted.numbers().items():
        np.testing.assert_array_equal(explorer.result.numbers()[name], value, err_msg=name)
    words = shown(explorer)
    assert explain.verdict(explorer.design, explorer.scenario, wanted)[1] in words
    assert answers.words(wanted.total_mass_kg, 2, "kg") in words and answers.words(wanted.slope_capability_deg, 1,
                                                                                   "°") in words
    assert "rdk-old" not in explorer.parts["verdict"].value
    data = told(explorer)
    assert data["ack"] == explorer._heard and not data["busy"]
    for name, (at, text, *_) in data["v"].items():
        field = NUMBERS[name]
        assert text == field.words(explorer.state[name]) and at == field.position(explorer.state[name])


# ---- inputs ---------------------------------------------------------------------------------------------------

@pytest.mark.parametrize("view", VIEWS)
def test_every_view_shows_a_picture_or_says_why_not(explorer, view):
    explorer.set(view=view)
    for mission in CANONICAL:
        explorer.set(mission=mission)
        assert_current(explorer)
        if view == "optimise":
            assert "No front yet" in explorer.parts["picture"].value and explorer.image() is None
        else:
            assert len(sound(explorer._picture)) > 40 and explorer._picture in explorer.parts["picture"].value
        assert "to scale" in sound(explorer.parts["side"].value)


@pytest.mark.parametrize("name, view", [
    *((n, "mass") for n in ("rover", "mission", "soil", "wheel_count", "survive", "preset")), ("baseline", "why"),
    ("why_metric", "why"),
    ("sweep_first", "sweep"), ("sweep_second", "sweep"), ("sweep_metric", "sweep")])
def test_every_choice_of_a_menu(explorer, name, view):
    explorer.set(view=view)
    for choice in MENUS[name]:
        events(explorer, ["set", name, str(choice)])
        assert_current(explorer)
        assert explorer.state[name] == choice or choice == OWN
        assert told(explorer)["c"][name] == str(explorer.state[name])


def test_rovers_and_missions_come_as_they_are_catalogued(explorer):
    for name in rdk.rover_names():
        explorer.set(rover=name)
        assert explorer.design == rdk.rover(name)
    for name in rdk.scenario_names():
        explorer.set(mission=name)
        assert explorer.scenario == rdk.scenario(name) and explorer.state["mission"] == name


def test_menus_name_what_is_shown_also_after_a_way_back(explorer):
    explorer.set(wheel_radius_m=0.12)
    assert explorer.state["rover"] == OWN and explorer.state["mission"] == MARE
    explorer.set(wheel_radius_m=0.1)
    assert explorer.state["rover"] == "Rashid-1"
    explorer.set(soil="fjs-1")
    assert explorer.state["mission"] == OWN == explorer.scenario.name and explorer.scenario.soil == rdk.soil("fjs-1")
    explorer.set(friction_angle_deg=rdk.soil("fjs-1").friction_angle_deg - 1)
    assert explorer.state["soil"] == OWN
    explorer.set(soil="apollo-nominal")
    assert explorer.state["mission"] == MARE


@pytest.mark.parametrize("name", [*DESIGN, *MISSION, *SOIL])
def test_both_ends_of_every_slider(explorer, name):
    for position, end in (0, NUMBERS[name].low), (NUMBERS[name].positions, math.inf if NUMBERS[name].endless
                                                  else NUMBERS[name].high):
        events(explorer, ["slide", name, position])
        assert explorer.state[name] == end
        assert_current(explorer)


def test_positions_and_values_of_sliders_agree():
    for name, field in NUMBERS.items():
        if name == "seed":
            continue                                     # a million positions
        values = [field.at(i) for i in range(field.positions + 1)]
        assert values[0] == field.low and (values[-1] == field.high or field.endless) and values == sorted(values), name
        if field.step:                                   # rounding to two digits may merge neighbours of a ratio
            assert [field.position(value) for value in values] == list(range(field.positions + 1)), name
    torque = NUMBERS["peak_wheel_torque_nm"]
    assert max(torque.at(i + 1) / torque.at(i) for i in range(torque.positions)) < 1.13


@pytest.mark.parametrize("name, text, value, said", [
    ("wheel_radius_m", "120", 0.12, ""), ("wheel_radius_m", "120,5", 0.1205, ""), ("wheel_radius_m", " 1.2e2 ", 0.12,
                                                                                   ""),
    ("wheel_radius_m", "300", 0.2, "radius 300 cut to 200 mm"), ("wheel_radius_m", "9", 0.05, "radius 9 cut to 50 mm"),
    ("battery_capacity_wh", "62,5", 62.5, ""), ("grouser_count", "3,7", 4, "grousers 3,7 rounded to 4"),
    ("duration_earth_days", "365", 60, "duration 365 cut to 60 days"), ("latitude_deg", "−85", -85, ""),
    ("traverse_limit_km", "none", math.inf, ""), ("traverse_limit_km", "500", 500, ""),
    ("duty_cycle", "12,5", 0.125, "")])
def test_typed_numbers_are_understood_and_what_is_done_to_them_is_said(explorer, name, text, value, said):
    events(explorer, ["set", name, text])
    assert explorer.state[name] == pytest.approx(value, rel=1e-12)
    assert said in shown(explorer, "drawer") and 'role="alert"' not in explorer.parts["drawer"].value
    assert_current(explorer)


@pytest.mark.parametrize("text", ["", "wide", "1.2.3", "1,234,567", "5_0", "nan", "0x10", "<b>"])
def test_a_typed_text_that_is_no_number_is_refused_in_words(explorer, text):
    before = explorer.design
    events(explorer, ["set", "wheel_radius_m", text])
    assert "is no number; allowed are 50 to 200 mm" in shown(explorer, "drawer")
    assert 'role="alert"' in explorer.parts["drawer"].value
    assert explorer.design == before
    assert_current(explorer)


@pytest.mark.parametrize("values, words", [
    ({"wheel": 1}, "no input 'wheel'"), ({"slope_dag": 1}, "nearest are slope_deg"),
    ({"slope_deg": 36}, "slope_deg must be at least 0 and at most 35 and finite; got 36"),
    ({"slope_deg": np.nan}, "slope_deg must be at least 0 and at most 35 and finite; got nan"),
    ({"slope_deg": "5"}, "slope_deg must be at least 0 and at most 35 and finite; got '5'"),
    ({"grouser_count": 2.5}, "grouser_count must be a whole number, at least 0 and at most 24; got 2.5"),
    ({"soil": "mud"}, "soil must be one of fjs-1, "), ({"wheel_count": 5}, "wheel_count must be one of 4, 6"),
    ({"wheel_count": [4, 6]}, "wheel_count must be one of 4, 6; got [4, 6]"),
    ({"view": {}}, "view must be one of log, "),
    ({"view": "x"}, "view must be one of log, "), ({"traverse_limit_km": -1}, "km must be zero or more; got -1")])
def test_set_names_what_is_wrong_and_what_is_allowed(explorer, values, words):
    before = dict(explorer.state)
    with pytest.raises(ValueError, match=re.escape(words)):
        explorer.set(payload_mass_kg=1, **values)
    assert explorer.state == before


def test_wrong_arguments():
    with pytest.raises(ValueError, match="view must be one of log, mass"):
        Explorer(view="logs")
    with pytest.raises(ValueError, match="'X'"):
        Explorer("X")
    with pytest.raises(ValueError, match=r"rover must be a single one; got arrays of shape \(3,\)"):
        Explorer(rdk.random_designs(3, seed=1))
    with pytest.raises(ValueError, match="scenario must be a single one"):
        Explorer(scenario=dataclasses.replace(rdk.scenario(MARE), slope_deg=[1.0, 2.0]))
    with pytest.raises(ValueError, match="model must be a single one"):
        Explorer(model=rdk.Model(drivetrain_efficiency=[0.7, 0.8]))
    with pytest.raises(TypeError, match="rover must be a Design"):
        Explorer(3)


def test_what_lies_beyond_the_sliders_is_cut_and_said():
    design = dataclasses.replace(rdk.rover("Rashid-1"), wheel_radius_m=0.3, battery_capacity_wh=1.0)
    soil = dataclasses.replace(rdk.soil("fjs-1"), friction_angle_deg=33.0)
    mission = rdk.Scenario(name="Ba$$in <1>", latitude_deg=5, soil=soil, duration_earth_days=3.25, slope_deg=4,
                           duty_cycle=0.1,
                           panel_azimuth_deg=90, problem=Problem(constraints=(
                               ("sinkage_m", "<=", 0.05), ("range_km", ">=", 3), ("energy_balance_pct", ">=", 0))))
    explorer = Explorer(design, mission)
    said = shown(explorer, "drawer")
    assert "radius 300 cut to 200 mm" in said and "battery 1 cut to 5 Wh" in said
    assert explorer.design == dataclasses.replace(design, wheel_radius_m=0.2, battery_capacity_wh=5.0)
    assert explorer.scenario == mission                  # name, azimuth, no limit, demands: all as they came
    for view in VIEWS:
        explorer.set(view=view)
        assert_current(explorer)
    space = {}
    exec(explorer.python(), space)
    assert space["mission"].name == "Ba$$in <1>"
    page = explorer.file("report.html")
    assert "Ba$$in &lt;1&gt;" in page and "<1>" not in page
    explorer.set(minimum_range_km=7)
    kept = ("sinkage_m", "<=", 0.05), ("energy_balance_pct", ">=", 0)
    assert explorer.scenario.problem.constraints == (("range_km", ">=", 7), *kept)
    explorer.set(minimum_range_km=0)
    assert explorer.scenario.problem.constraints == kept


def test_the_array_follows_the_noon_sun_until_it_is_turned(explorer):
    explorer.set(latitude_deg=-30)
    assert explorer.scenario.panel_azimuth_deg == 0
    explorer.set(panel_azimuth_deg=90)
    explorer.set(latitude_deg=30)
    assert explorer.scenario.panel_azimuth_deg == 90


def test_events_that_were_heard_are_not_acted_on_again(explorer):
    events(explorer, ["slide", "wheel_radius_m", 70])
    heard = explorer._heard
    explorer.bridge.value = json.dumps([[heard, "do", "undo"], [heard + 1, "set", "wheel_width_m", "90"]])
    explorer.settle()
    assert (explorer.design.wheel_radius_m, explorer.design.wheel_width_m) == (0.12, 0.09)
    events(explorer, ["size", 390, 320])
    assert 'width="390"' in explorer._picture
    events(explorer, ["size", 600, 380])
    assert_current(explorer)


# ---- undo, pins, links ----------------------------------------------------------------------------------------

def test_undo_redo_and_reset(explorer):
    states = [dict(explorer.state)]
    for values in {"wheel_radius_m": 0.12}, {"mission": POLAR}, {"peak_wheel_torque_nm": 2.0}, {"rover": "Pragyan"}:
        explorer.set(**values)
        states.append({**explorer.state, "seed": 13})
    explorer.set(seed=13)                                # of the search: no part of it
    for state in states[-2::-1]:
        explorer.undo()
        assert explorer.state == state
    explorer.undo()                                      # nothing before the start
    assert explorer.state == states[0] and not explorer._past
    for state in states[1:]:
        explorer.redo()
        assert explorer.state == state
    explorer.undo()
    explorer.set(wheel_width_m=0.1)
    assert not explorer._future                          # a new way
    explorer.set(rover="Yutu-2", mission=MARE)
    explorer.set(wheel_radius_m=0.06, slope_deg=3)
    events(explorer, ["do", "reset:slope_deg"])
    assert explorer.scenario == rdk.scenario(MARE) and explorer.design.wheel_radius_m == 0.06
    events(explorer, ["do", "reset"])
    assert explorer.design == rdk.rover("Yutu-2")
    assert_current(explorer)


def test_what_changes_nothing_is_no_step(explorer):
    events(explorer, ["set", "wheel_radius_m", "130"])
    events(explorer, ["set", "wheel_radius_m", "130"])  # a box that is left says its number again
    explorer.set(mission=MARE, wheel_count=4.0, survive=False, live="False")     # numbers and flags, however written
    gain = explorer.result.total_mass_kg - rdk.evaluate(rdk.rover("Rashid-1"), explorer.scenario).total_mass_kg
    assert len(explorer._past) == 1 and f"{gain:+.1f}" in shown(explorer)
    explorer.undo()
    assert explorer.design == rdk.rover("Rashid-1")


def test_a_drag_is_one_step_back(explorer):
    for position in range(40, 70):
        events(explorer, ["slide", "wheel_radius_m", position])
    assert len(explorer._past) == 1
    mass = explorer.result.total_mass_kg - rdk.evaluate(rdk.rover("Rashid-1"), explorer.scenario).total_mass_kg
    assert f"{mass:+.1f}".replace("-", "−") in shown(explorer)                # the change since the drag began
    dragged = explorer.design
    explorer._heard += 2000                              # events count milliseconds
    events(explorer, ["slide", "wheel_radius_m", 20])
    events(explorer, ["do", "undo"])
    assert explorer.design == dragged
    events(explorer, ["do", "undo"])
    assert explorer.design == rdk.rover("Rashid-1")


def test_pins_compare_and_come_back(explorer):
    explorer.set(mission=POLAR)
    kept = []
    for radius in 0.1, 0.12, 0.14, 0.16:
        explorer.set(wheel_radius_m=radius)
        explorer.settle()
        events(explorer, ["do", "pin"])
        kept.append(explorer.design)
    assert len(explorer._pins) == 3                      # at most
    for view in VIEWS:
        explorer.set(view=view)
        assert_current(explorer)
    events(explorer, ["do", "differences"])
    first = rdk.evaluate(kept[0], explorer.scenario)
    assert answers.words(first.range_km, 2, "km") in shown(explorer, "drawer")
    difference = first.total_mass_kg - explorer.result.total_mass_kg
    assert f"{difference:+.1f} kg".replace("-", "−") in shown(explorer, "tray")
    events(explorer, ["do", "use:1"])
    assert explorer.design == kept[1]
    events(explorer, ["do", "unpin:0"], ["do", "close"])
    assert [design for _, design in explorer._pins] == kept[1:3] and "Differences" not in shown(explorer, "drawer")


def test_a_link_brings_everything_back(explorer):
    chance = random.Random(4)
    for _ in range(5):
        names = chance.sample([*DESIGN, *MISSION, *SOIL, "minimum_range_km", "hub_no_load_speed_rad_s"], 4)
        explorer.set(rover=chance.choice(rdk.rover_names()), mission=chance.choice(rdk.scenario_names()),
                     wheel_count=chance.choice([4, 6]), view=chance.choice(list(VIEWS)),
                     sweep_first=chance.choice([*DESIGN, *SOIL]), why_metric=chance.choice(list(METRICS)))
        explorer.set(**{n: NUMBERS[n].at(chance.randrange(NUMBERS[n].positions + 1)) for n in names})
        explorer.settle()
        other = Explorer(state=explorer.link)
        assert other.state == explorer.state             # what is asked of the views, too
        assert (other.design, other.model, other.scenario) == (explorer.design, explorer.model, explorer.scenario)
    explorer.set(mission=POLAR, slope_deg=12.5, minimum_slope_deg=21.0, minimum_charge=0.3, survive=1,
                 slope_goal="ignore", population=24, generations=7, seed=5)
    for start in MARE, "highland_slope_capability":      # the same search, whatever stood there before
        other = Explorer(scenario=start, state=explorer.link)
        assert [other.state[n] for n in ("population", "generations", "seed")] == [24, 7, 5]
        assert other.scenario == explorer.scenario
    explorer.set(rover="Rashid-1", mission=POLAR, view="log", population=50, generations=60)
    explorer.set(hub_no_load_speed_rad_s=5.0)
    assert "wheel" not in explorer.link and "mission=polar_prospecting" in explorer.link
    explorer.set(mission="highland_slope_capability")
    explorer.undo()                                      # another mission's base, and its seed
    assert Explorer(state=explorer.link).state == explorer.state and "slope_deg" not in explorer.link
    explorer.set(mission=MARE, site="connecting_ridge_spot_1", panel_azimuth_deg=180.0)      # away from the noon sun
    assert Explorer(state=explorer.link).scenario == explorer.scenario
    explorer.set(site="none", start_utc="2026-12-01")    # with the site goes its longitude
    assert Explorer(state=explorer.link).scenario == explorer.scenario and explorer.scenario.longitude_deg == 0
    wrong = Explorer(state="wheel_radius_m=0.12&wheel_width_m=7&soil=mud&nonsense=1")
    assert (wrong.design.wheel_radius_m, wrong.design.wheel_width_m) == (0.12, 0.08)
    assert "wheel_width_m must be" in shown(wrong, "drawer")


def test_site_and_date_bring_the_real_sun_and_go_everywhere(explorer):
    explorer.set(mission=POLAR)
    events(explorer, ["set", "site", "shackleton_rim"], ["set", "site_height_m", "10"],
           ["set", "start_utc", " 2026-11-26T12:00 "])
    assert_current(explorer)
    place = catalog.skyline_sites()["shackleton_rim"]
    wanted = rdk.scenario(POLAR).replace(
        name=OWN, skyline=rdk.skyline("shackleton_rim", 10), start_utc="2026-11-26T12:00",
        latitude_deg=place["latitude_deg"], longitude_deg=place["longitude_deg"])
    assert explorer.scenario == wanted and "from 2026-11-26T12:00" in told(explorer)["t"]["summary"]
    assert "after 2026-11-26T12:00" in explorer.parts["picture"].value
    again = Explorer(state=explorer.link)
    assert again.scenario.replace(problem=wanted.problem) == wanted and again.state["site_height_m"] == 10
    kept, space = explorer.file("design.json"), {}
    exec(explorer.python(), space)
    assert space["result"].range_km == explorer.result.range_km and "skyline('shackleton_rim', 10)" in explorer.python()
    assert space["mission"].skyline == wanted.skyline
    events(explorer, ["set", "start_utc", "next week"])
    assert "date must be UTC in ISO form" in shown(explorer, "drawer") and explorer.scenario == wanted
    events(explorer, ["set", "latitude_deg", "-80"])
    assert explorer.state["site"] == "none" and "site set to none" in shown(explorer, "drawer")
    explorer.undo()
    assert explorer.scenario == wanted
    for _ in range(3):
        explorer.undo()
    assert explorer.scenario == rdk.scenario(POLAR)
    explorer.load("design.json", kept)
    assert explorer.scenario == wanted and explorer.state["site"] == "shackleton_rim"
    own = wanted.replace(skyline=[1.0, 2.0, 3.0], name="own hills")
    assert Explorer(scenario=own).scenario == own and Explorer(scenario=own).state["site"] == OWN
    explorer.set(site="none", start_utc="none")
    assert explorer.scenario.skyline is None and explorer.scenario.start_utc is None


# ---- words ----------------------------------------------------------------------------------------------------

def explained(design, mission):
    """Words for one design on one mission, checked against the numbers."""
    result = rdk.evaluate(design, mission)
    key, sentence, detail = explain.binding(design, mission, result)
    met, verdict = explain.verdict(design, mission, result)
    lane = rdk.evaluate(rdk.Design.stack([design, design]), mission)[0]              # it has no log
    assert explain.binding(design, mission, lane)[:2] == (key, sentence)
    assert verdict.startswith(explain.verdict(design, mission, lane)[1].split(",")[0].rstrip("."))
    found = explain.levers(design, mission, result, key)
    assert not re.search(r"\bnan\b|\binf\b", sentence + detail + verdict + repr(found)) and sentence.endswith(".")
    assert result.stalled == (key in ("torque", "traction", "soil"))
    assert (result.range_km >= mission.traverse_limit_km > 0) <= (key == "range limit")
    assert verdict.startswith("Drives") == (result.range_km > 0) and met <= (result.thermal_survival
                                                                             and result.range_km > 0)
    assert ("freezes" in verdict or "overheats" in verdict) != result.thermal_survival
    limits = explain.limits(design, mission, result)
    assert all(not re.search(r"\bnan\b|\binf\b", words) for _, words in limits.values())
    met = all(limits[n][0] for n in ("stalled", "range_km", "energy_balance_pct", "obstacle_capability_m"))
    assert met == result.feasible
    sound(rover_picture(design, result, mission))
    sound(wheel_picture(design, result, mission))
    return key


@pytest.mark.parametrize("mission", rdk.scenario_names())
def test_single_extremes_on_every_mission_are_explained(mission):
    base, mission = rdk.rover("Rashid-1"), rdk.scenario(mission)
    for name, variable in rdk.DESIGN_SPACE.items():
        for end in variable.low, variable.high:
            explained(dataclasses.replace(base, **{name: end}), mission)


def test_corners_of_the_design_and_of_the_mission_box_are_explained():
    chance = np.random.default_rng(5)
    ends = np.array([(v.low, v.high) for v in rdk.DESIGN_SPACE.values()])
    for corner in chance.integers(0, 2, (60, len(ends))):
        design = rdk.Design(**{n: ends[i, c] for i, (n, c) in enumerate(zip(rdk.DESIGN_SPACE, corner))})
        values = {n: (f.low, f.high)[chance.integers(2)] for n, f in MISSION.items()}
        explained(design, rdk.Scenario(name="corner", soil=rdk.soil(chance.choice(rdk.soil_names())), **values))


def test_a_missed_demand_is_named_in_full():
    """`minimum_soc` ends in no unit: nothing may be cut off it."""
    rover, mare = rdk.rover("Rashid-1"), rdk.scenario(MARE)
    demands = ("minimum_soc", ">=", 2), ("total_mass_kg", "<=", 1)
    mission = mare.replace(problem=rdk.Problem(constraints=demands))
    met, sentence = explain.verdict(rover, mission, rdk.evaluate(rover, mission))
    assert not met and sentence.endswith("misses lowest charge >= 2, and misses mass <= 1 kg.")


def test_binding_finds_each_cause_and_levers_what_helps():
    rover, mare = rdk.rover("Rashid-1"), rdk.scenario(MARE)
    d = dataclasses.replace
    far = d(mare, traverse_limit_km=1e4)
    cases = {"range limit": (rover, mare), "torque": (d(rover, peak_wheel_torque_nm=0.05), mare),
             "traction": (rover, d(mare, slope_deg=30)),
             "duty": (rover, d(mare, duty_cycle=0)), "sun": (d(rover, solar_area_m2=0.1), d(far, duty_cycle=1)),
             "hub speed": (rover, far),
             "soil": (rover, d(mare, soil=d(mare.soil, frictional_modulus_kn_m_n2=1e-3,
                                            cohesive_modulus_kn_m_n1=1e-3)))}
    for key, (design, mission) in cases.items():
        result = rdk.evaluate(design, mission)
        assert explain.binding(design, mission, result).key == key
        for name, words, gain, unit in explain.levers(design, mission, result, key):
            if unit == "km" and name in rdk.DESIGN_SPACE:
                more = d(design, **{name: 1.1 * getattr(design, name)})
                longer = rdk.evaluate(more, d(mission, traverse_limit_km=np.inf)).range_km
                assert gain == pytest.approx(longer - result.range_km, rel=1e-9)


def test_the_binding_lever_is_the_one_that_gains_most():
    rover, polar = rdk.rover("Rashid-1"), rdk.scenario(POLAR)
    base = rdk.evaluate(rover, polar)
    gains = [100 * rdk.evaluate(dataclasses.replace(rover, **{name: 1.1 * getattr(rover, name)}),
                                polar).range_km / base.range_km - 100
             for name in ("solar_area_m2", "battery_capacity_wh")]
    fast = rdk.evaluate(rover, polar, model=rdk.Model(hub_no_load_speed_rad_s=5.5)).range_km
    gains.insert(0, 100 * fast / base.range_km - 100)
    found = explain.binding(rover, polar, base)
    assert found.key == "hub speed" and max(gains) == gains[0]
    words = "10 % more hub speed gives {:.1f} % more range, array {:.1f} %, battery {:.1f} %"
    assert found.detail.startswith(words.format(*gains))


def test_a_lever_of_the_verdict_moves_its_slider(explorer):
    explorer.set(mission=POLAR)
    explorer.settle()
    actions = re.findall(r'data-do="(lever:[^"]+)"', explorer.parts["verdict"].value)
    assert "lever:hub_no_load_speed_rad_s" in actions and 0 < len(actions) <= 3
    before = explorer.result.range_km
    events(explorer, ["do", "lever:hub_no_load_speed_rad_s"])
    assert explorer.model.hub_no_load_speed_rad_s == 5.5 and explorer.result.range_km > before
    assert_current(explorer)


def test_status_follows_requirement_and_interval(explorer):
    explorer.set(mission=POLAR)
    explorer.settle()
    low, value = explorer.intervals.low["total_mass_kg"], explorer.result.total_mass_kg
    high = explorer.intervals.high["total_mass_kg"]
    cases = ((high + 1, "met"), ((value + high) / 2, "risk"), ((low + value) / 2, "missed"), (math.inf, "none"))
    for limit, status in cases:
        explorer.set(maximum_mass_kg=limit)
        explorer.settle()
        cards = re.findall(r'class="rdk-card rdk-(\w+)"><div class="h"><span>(\w+)', explorer.parts["verdict"].value)
        assert ("Mass", status) in [(title, found) for found, title in cards]
    share = np.mean(answers.meets(explorer.intervals.draws, answers.asked(explorer.scenario)))
    assert f"Drives in {100 * share:.0f} % of {answers.DRAWS:,} draws" in shown(explorer)


def test_a_buried_rover_is_said_to_be_so():
    mud = dataclasses.replace(rdk.soil("apollo-loose"), frictional_modulus_kn_m_n2=1.0, cohesive_modulus_kn_m_n1=1e-3)
    explorer = Explorer(scenario=dataclasses.replace(rdk.scenario(MARE), soil=mud))
    for view in VIEWS:
        explorer.set(view=view, sweep_metric="slip", why_metric="slip")
        assert_current(explorer)
        assert explorer.binding.key == "soil" and "none to none" in shown(explorer) and "Sinks" in explorer.text()
        if view != "optimise":
            sound(explorer._picture)
    explorer.set(view="sweep", sweep_first="avionics_power_w", sweep_second="hub_no_load_speed_rad_s")
    explorer.settle()
    assert "the wheel is buried" in sound(explorer._picture)


def test_what_fails_is_marked_on_the_drawing():
    rover, mare, d = rdk.rover("Rashid-1"), rdk.scenario(MARE), dataclasses.replace
    cases = {"hubs": (d(rover, peak_wheel_torque_nm=0.05), mare), "wheels": (rover, d(mare, slope_deg=33)),
             "body": (rover, mare),
             "array": (d(rover, solar_area_m2=0.1), d(mare, payload_power_w=40)),
             "obstacle": (rover, d(mare, required_obstacle_height_m=0.2))}
    for part, (design, mission) in cases.items():
        result = rdk.evaluate(design, mission)
        found = failing(design, result, mission)
        picture = rover_picture(design, result, mission)
        assert part in found and found[part] in sound(picture)
        assert (' bad"' in picture) == bool(found)
    plain = rover_picture(rover)
    assert ' bad"' not in plain and "100 mm radius" in sound(plain)


@pytest.mark.parametrize("kernel", ["paper", "imposed-arc"])
@pytest.mark.parametrize("slope_deg", [0, 20])
def test_the_stresses_drawn_carry_and_turn_the_wheel(kernel, slope_deg):
    design, mission, model = rdk.rover("Rashid-1"), rdk.scenario(MARE).replace(slope_deg=slope_deg), rdk.Model(
        kernel=kernel)
    result = rdk.evaluate(design, mission, model=model)
    angle, normal, shear = contact(design, result, mission, model, 2001)
    area = 1000 * design.wheel_radius_m * design.wheel_width_m
    load = result.total_mass_kg * model.gravity_m_s2 * np.cos(np.radians(slope_deg)) / design.wheel_count
    found = area * np.array([np.trapezoid(normal * np.cos(angle) + shear * np.sin(angle), angle),
                             np.trapezoid(shear, angle) * design.wheel_radius_m])
    np.testing.assert_allclose(found, [load, result.wheel_torque_nm], rtol=1e-5)       # trapezoids, kink at theta_m
    assert f"over {np.degrees(angle[-1]):.0f} degrees" in sound(wheel_picture(design, result, mission, model=model))


def test_the_drawing_is_to_scale():
    def circles(picture):
        return [float(r) for r in re.findall(r'<circle class="o" cx="[^"]*" cy="[^"]*" r="([^"]*)"', picture)]

    rover = rdk.rover("Rashid-1")
    picture = rover_picture(rover)
    xs = [float(x) for x in re.findall(r'<circle class="o" cx="([^"]*)"', picture)]
    radius = circles(picture)
    assert len(radius) == 2 and len(circles(rover_picture(rdk.rover("Pragyan")))) == 3
    np.testing.assert_allclose((xs[1] - xs[0]) / radius[0], rover.wheelbase_m / rover.wheel_radius_m,
                               rtol=5e-3)      # drawn to 0.1 px
    sheet = re.search(r'<rect class="n a" x="[^"]*" y="[^"]*" width="([^"]*)" height="([^"]*)"', picture)
    np.testing.assert_allclose([float(v) / radius[0] for v in sheet.groups()],
                               np.array([0.21, 0.297]) / rover.wheel_radius_m, rtol=1e-2)


def test_texts_for_readers_without_a_kernel(explorer):
    bundle = explorer._repr_mimebundle_()
    assert bundle["application/vnd.jupyter.widget-view+json"]["model_id"] == explorer.widget.model_id
    assert bundle["text/plain"].startswith("Drives the whole route of 80 km on day")
    assert "✗ missed" in bundle["text/plain"]
    assert bundle["image/svg+xml"] == explorer.image().data and sound(explorer.image().data) == sound(explorer._picture)
    explorer.set(view="optimise")
    explorer.settle()
    assert "image/svg+xml" not in explorer._repr_mimebundle_()


def test_an_error_becomes_words_and_goes_away(explorer, monkeypatch):
    def broken(*args, **kwargs):
        raise RuntimeError("<no sun>")
    monkeypatch.setattr(explorer_module, "evaluate", broken)
    explorer.set(slope_deg=3)
    explorer.settle()
    assert explorer.error == explorer.text() == "RuntimeError: <no sun>"
    assert "&lt;no sun&gt;" in explorer.parts["picture"].value
    monkeypatch.undo()
    explorer.set(slope_deg=4)
    assert_current(explorer)


# ---- one answer for the newest state --------------------------------------------------------------------------

def test_a_burst_is_answered_once_and_with_the_newest_state(explorer, monkeypatch):
    seen, begun, go, evaluate = [], threading.Event(), threading.Event(), explorer_module.evaluate

    def slow(design, *given, **more):
        seen.append((design.wheel_radius_m, explorer._overtaken))
        begun.set()
        assert go.wait(60)
        return evaluate(design, *given, **more)

    monkeypatch.setattr(explorer_module, "evaluate", slow)
    explorer.set(wheel_radius_m=0.06)
    assert begun.wait(60)
    for i in range(50):
        explorer.set(wheel_radius_m=0.07 + 0.001 * i)
    assert explorer._overtaken
    with pytest.raises(TimeoutError):
        explorer.settle(0.01)
    go.set()
    assert_current(explorer)
    assert seen == [(0.06, False), (0.07 + 0.001 * 49, False)]
    explorer.settle(0)                                   # nothing to do


@pytest.mark.parametrize("view", ["log", "sweep", "why"])
def test_a_burst_leaves_nothing_stale(explorer, view):
    explorer.set(view=view)
    for i in range(20):
        explorer.set(wheel_radius_m=0.06 + 0.005 * i, slope_deg=i)
    assert_current(explorer)
    picture = explorer.parts["picture"].value
    explorer._poke()
    explorer.settle()
    assert explorer.parts["picture"].value == picture    # the picture, too, is that of the state shown


def test_readings_come_before_intervals_and_old_intervals_are_dimmed(explorer):
    seen = []
    watch = lambda change: seen.append("rdk-old" in change.new)              # noqa: E731
    explorer.parts["verdict"].observe(watch, "value")
    explorer.set(wheel_radius_m=0.13)
    explorer.settle()
    explorer.parts["verdict"].unobserve(watch, "value")
    assert seen == [True, False]


def test_callbacks_from_several_threads(explorer):
    """Since JupyterLab 4.4 a callback may run in a thread of its own."""
    errors = []

    def move(names, seed):
        try:
            chance = random.Random(seed)
            for _ in range(40):
                name = chance.choice(names)
                explorer.set(**{name: chance.choice(CANONICAL) if name == "mission"
                                else NUMBERS[name].at(chance.randrange(NUMBERS[name].positions))})
                if chance.random() < 0.2:
                    chance.choice([explorer.undo, explorer.redo, explorer.reset])()
        except Exception as error:
            errors.append(error)

    names = [*DESIGN, *MISSION]
    threads = [threading.Thread(target=move, args=(part, i)) for i,
               part in enumerate((names[:6], names[4:12], names[10:], ["mission"]))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not errors
    assert_current(explorer)


def test_two_explorers_do_not_disturb_each_other(explorer):
    other = Explorer("Tenacious", MARE, view="wheel")
    still = {name: part.value for name, part in other.parts.items()}
    explorer.set(generations=3, population=8)
    explorer.optimise()
    for i in range(6):
        explorer.set(wheel_radius_m=0.1 + 0.005 * i, view=list(VIEWS)[i % 4])
    explorer.optimise(wait=True)
    explorer.settle()
    assert {name: part.value for name, part in other.parts.items()} == still
    assert other.front is None and other.design == rdk.rover("Tenacious")


def test_a_random_walk_keeps_working_and_keeps_no_memory(explorer):
    chance = random.Random(1)
    names = [name for name in NUMBERS if name not in ("population", "generations", "seed")]
    menus = [name for name in MENUS if name not in ("view", "live")]
    texts = ["12", "0,5", "1e3", "1e999", "none", "wide", "", "-4", "−3", "<b>", "nan", "2026-11-26T12:00"]

    def walk(moves, views):
        for _ in range(moves):
            kind = chance.random()
            if kind < 0.25:
                name = chance.choice(menus)
                event = ["set", name, str(chance.choice(list(MENUS[name])))]
            elif kind < 0.35:
                event = ["do", chance.choice(["undo", "redo", "reset", "reset:slope_deg", "pin", "unpin:0", "use:2",
                                              "differences", "python", "solve", "point:1", "save:design.csv"])]
            elif kind < 0.45:
                event = ["set", chance.choice([*names, "start_utc"]), chance.choice(texts)]
            elif kind < 0.48:
                event = ["size", chance.choice([300, 640, 1400]), 420]
            else:
                name = chance.choice(names)
                event = ["slide", name, chance.randrange(NUMBERS[name].positions + 1)]
            events(explorer, event, *([["set", "view", chance.choice(views)]] if chance.random() < 0.3 else []))
            if chance.random() < 0.2:
                assert_current(explorer)
        assert_current(explorer)

    walk(60, list(VIEWS))
    explorer._past.clear()
    tracemalloc.start()                                  # slows the walk down: only for its end
    try:
        walk(3, ["log", "mass"])
        before = tracemalloc.get_traced_memory()[0]
        walk(8, ["log", "mass"])
        grown = tracemalloc.get_traced_memory()[0] - before
    finally:
        tracemalloc.stop()
    assert grown < 2e5                                   # a picture kept a move would be 0.33 MB


# ---- fronts and solutions -------------------------------------------------------------------------------------

def dots(explorer):
    """Centre and words of each dot that can be picked."""
    return [(int(i), float(x), float(y)) for x, y, i in re.findall(
        r'<circle class="rdk-pick" cx="([^"]*)" cy="([^"]*)"[^>]*data-do="point:(\d+)"', explorer._picture)]


def test_the_search_of_a_mission_is_that_of_pareto_front(explorer):
    explorer.set(population=20, generations=6, view="optimise")
    explorer.optimise(wait=True)
    wanted = rdk.pareto_front(rdk.scenario(MARE), population=20, generations=6)
    for name in rdk.DESIGN_SPACE:
        np.testing.assert_array_equal(getattr(explorer.front.designs, name), getattr(wanted.designs, name))
    assert f"done: {len(wanted)} designs after 6 generations" in told(explorer)["t"]["status"]
    assert sound(explorer._picture).startswith(f"Front of equatorial mare traverse: {len(wanted)} designs")


@pytest.mark.parametrize("axes", [("total_mass_kg", "slope_capability_deg"), ("range_km", "total_mass_kg"),
                                  ("slip", "minimum_soc")])
def test_every_dot_of_the_first_picture_lies_where_its_design_is(explorer, axes):
    explorer.load("front.csv", catalog.to_csv(rdk.random_designs(30, seed=3)))
    explorer.set(view="optimise", front_x=axes[0], front_y=axes[1])
    explorer.settle()
    found = dots(explorer)
    assert [i for i, *_ in found] == list(range(30))
    for column, name in ((1, axes[0]), (2, axes[1])):
        values, pixels = np.asarray(getattr(explorer.front.performance, name),
                                    float), np.array([dot[column] for dot in found])
        slope, offset = np.polyfit(values, pixels, 1) if np.ptp(values) > 0 else (0, pixels[0])
        np.testing.assert_allclose(slope * values + offset, pixels, atol=0.11)       # a straight scale, drawn to 0.1 px
        assert (slope >= 0 if column == 1 else slope <= 0)


def test_a_dot_becomes_the_design_and_is_marked(explorer):
    explorer.set(population=12, generations=4, view="optimise")
    explorer.optimise(wait=True)
    for i in (len(explorer.front) - 1, 0):
        events(explorer, ["do", f"point:{i}"])
        assert explorer.design == explorer.front.designs[i]
        assert_current(explorer)
        assert re.search(rf'stroke-width="2.6"[^>]*tabindex="0"[^>]*data-do="point:{i}"', explorer._picture)
    events(explorer, ["do", "undo"])
    assert explorer.design == explorer.front.designs[len(explorer.front) - 1]


def test_a_front_of_another_mission_says_so(explorer):
    explorer.set(mission=POLAR, population=12, generations=3, view="optimise")
    explorer.optimise(wait=True)
    assert "run again" not in explorer._picture
    explorer.set(mission=MARE)
    explorer.settle()
    assert "searched for polar prospecting as it was: run again" in explorer._picture
    assert 'opacity="0.45"' in explorer._picture
    explorer.set(mission=POLAR)
    explorer.settle()
    assert "run again" not in explorer._picture


def test_dots_that_miss_a_demand_fade(explorer):
    explorer.set(population=16, generations=5, view="optimise")
    explorer.optimise(wait=True)
    explorer.set(maximum_mass_kg=float(np.median(explorer.front.performance.total_mass_kg)))
    explorer.settle()
    faded = [int(i) for i in re.findall(r'opacity="0.25"[^>]*data-do="point:(\d+)"', explorer._picture)]
    assert faded == list(np.flatnonzero(explorer.front.performance.total_mass_kg > explorer.state["maximum_mass_kg"]))


def test_a_front_is_coloured_by_the_odds_of_the_demands(explorer, monkeypatch):
    monkeypatch.setattr(explorer_module, "RATED", 4)
    explorer.set(mission=POLAR, population=16, generations=4, view="optimise", front_colour="odds")
    explorer.optimise(wait=True)
    front, calls, sample = explorer.front, [], explorer_module.intervals
    assert len(front) > 4
    explorer.set(minimum_slope_deg=23.0, minimum_range_km=12.0)
    assert_current(explorer)
    demands = [("feasible", ">=", 1), *explorer.scenario.problem.constraints]
    wanted = [rdk.intervals(design, rdk.scenario(POLAR), draws=answers.DRAWS).share(demands)
              for design in front.designs]
    np.testing.assert_array_equal(explorer._kept["odds"][1], wanted)                 # the same draws for every design
    assert len(set(wanted)) > 2
    said = re.findall(r'data-do="point:\d+" aria-label="([^"]*)"', explorer._picture)
    assert [f"odds of the demands {share:.4g}" in words for share, words in zip(wanted, said)] == [True] * len(front)
    monkeypatch.setattr(explorer_module, "intervals",
                        lambda design, *given, **more: calls.append(design.shape) or sample(design, *given, **more))
    explorer.set(wheel_radius_m=0.12)                    # the rover on the sliders is no part of it
    explorer.settle()
    assert calls == [()]
    explorer.set(maximum_mass_kg=float(np.median(front.performance.total_mass_kg)))
    explorer.settle()
    assert sum(shape[0] for shape in calls if shape) == len(front)
    assert np.flatnonzero(explorer._kept["odds"][1] > 0.9).size < len(front)


def test_cancel_ends_the_search_and_keeps_what_it_found(explorer, monkeypatch):
    third, search = threading.Event(), explorer_module.pareto_front

    def watched(*args, on_generation, **options):
        def follow(progress):
            if progress.generation >= 3:
                third.set()
            return on_generation(progress)
        return search(*args, on_generation=follow, **options)

    monkeypatch.setattr(explorer_module, "pareto_front", watched)
    explorer.set(population=20, generations=1000, view="optimise")
    events(explorer, ["do", "run"])
    assert third.wait(60)
    explorer.optimise()                                  # a second press starts nothing
    explorer.set(slope_deg=10)                           # nor do moves disturb the search
    explorer.settle()
    assert told(explorer)["off"]["run"] and not told(explorer)["off"]["cancel"]
    thread = explorer._thread
    events(explorer, ["do", "cancel"])
    thread.join(60)
    explorer.settle()
    assert re.search(r"stopped after generation \d+ of 1000", explorer._status)
    assert explorer.front.scenario.slope_deg == 15 and not told(explorer)["off"]["run"]
    space = {}
    explorer.set(slope_deg=15)
    exec(explorer.python(), space)                       # as many generations as were run
    np.testing.assert_array_equal(space["front"].designs.wheel_radius_m, explorer.front.designs.wheel_radius_m)


def test_the_front_grows_on_the_screen(explorer, monkeypatch):
    search, clock, seen = explorer_module.pareto_front, itertools.count(), []

    def unhurried(*args, on_generation, **problem):
        """The search, waiting for each picture: a fast one would be over before the second is drawn."""
        def follow(progress):
            stop = on_generation(progress)
            explorer.settle()
            return stop
        return search(*args, on_generation=follow, **problem)

    explorer.set(population=20, generations=12, view="optimise")
    explorer.settle()
    monkeypatch.setattr(explorer_module, "pareto_front", unhurried)
    monkeypatch.setattr(explorer_module.time, "monotonic", lambda: next(clock))      # every generation is due
    explorer.parts["picture"].observe(lambda change: seen.append(change.new), "value")
    explorer.optimise(wait=True)
    explorer.parts["picture"].unobserve_all()
    assert len(set(seen)) >= 8
    assert_current(explorer)


@pytest.mark.parametrize("values, words", [
    ({"range_goal": "ignore", "mass_goal": "ignore", "slope_goal": "ignore"}, "objectives must name at least one"),
    ({"minimum_range_km": 200.0}, "no design of 2 generations met the constraints range_km >= 200")])
def test_a_search_without_a_result_says_why(explorer, values, words):
    explorer.set(population=8, generations=2, view="optimise", **values)
    explorer.optimise(wait=True)
    assert words in told(explorer)["t"]["status"] and "ValueError" not in explorer._status and not dots(explorer)
    with pytest.raises(ValueError, match="there is no front yet"):
        explorer.file("front.csv")
    assert_current(explorer)


def test_the_live_front_follows_the_mission(explorer):
    explorer.set(view="optimise", live=True)
    explorer.settle()
    fronts = [explorer.front]
    for values in {"latitude_deg": -60}, {"slope_deg": 5, "soil": "apollo-loose"}:
        explorer.set(**values)
        assert_current(explorer)
        fronts.append(explorer.front)
        assert fronts[-1] is not fronts[-2] and len(fronts[-1])
        assert fronts[-1].scenario == dataclasses.replace(explorer.scenario, problem=Problem())
    assert [len(front.objective_history) for front in fronts] == [24, 12, 12]    # half: each starts from the last
    explorer.set(wheel_radius_m=0.15)                    # the design is no part of the mission
    explorer.settle()
    assert explorer.front is fronts[-1]
    explorer.set(required_obstacle_height_m=0.3)
    explorer.settle()
    assert "no design" in explorer._picture and len(explorer.front) == 0 and not explorer.error
    explorer.set(required_obstacle_height_m=0.1)
    explorer.settle()
    assert len(explorer.front) and explorer.front.performance.obstacle_capability_m.min() >= 0.1


def test_solve_finds_the_nearest_value_that_meets_the_demands(explorer):
    explorer.set(mission=POLAR, peak_wheel_torque_nm=0.1)
    explorer.settle()
    assert not answers.meets(explorer.result, answers.asked(explorer.scenario))
    explorer.solve("peak_wheel_torque_nm")
    assert_current(explorer)
    assert answers.meets(explorer.result, answers.asked(explorer.scenario))
    assert "meets the demands" in shown(explorer, "drawer")
    weaker = dataclasses.replace(explorer.design, peak_wheel_torque_nm=0.96 * explorer.design.peak_wheel_torque_nm)
    assert not rdk.evaluate(weaker, explorer.scenario).feasible              # two steps of the search further down
    explorer.set(maximum_mass_kg=2.0)
    before = explorer.design
    events(explorer, ["do", "solve"])
    assert explorer.design == before and "mass ≤ 2" in shown(explorer, "drawer")
    with pytest.raises(ValueError, match="solve_variable must be one of wheel_radius_m"):
        explorer.solve("slope_deg")


def test_the_lightest_rover_for_the_demands_comes_onto_the_sliders(explorer, monkeypatch):
    calls, size = [], rdk.size
    monkeypatch.setattr(explorer_module, "size", lambda *given, **more: calls.append(
        (given, size(*given, **more))) or calls[-1][1])
    explorer.set(mission=POLAR, minimum_range_km=8.0, minimum_slope_deg=22.0, view="mass")
    explorer.lightest(wait=True)
    ((asked, demands), wanted), = calls
    assert asked.replace(problem=explorer.scenario.problem) == explorer.scenario
    assert demands == [("feasible", ">=", 1), *explorer.scenario.problem.constraints]
    assert explorer.design == wanted.design and explorer.result.range_km >= 8
    assert f"lightest: {wanted.performance.total_mass_kg:.2f} kg" in shown(explorer, "drawer")
    assert "all demands hold in" in told(explorer)["t"]["status"]
    assert_current(explorer)
    events(explorer, ["do", "undo"])
    assert explorer.design == rdk.rover("Rashid-1")
    missed = dataclasses.replace(wanted, message="the demands conflict")
    monkeypatch.setattr(explorer_module, "size", lambda *given, **more: missed)      # tests of `size` bring that about
    explorer.lightest(wait=True)
    assert "the demands conflict" in shown(explorer, "drawer")
    assert 'role="alert"' in explorer.parts["drawer"].value


def test_the_program_ends_while_a_search_runs():
    code = ("import rdk; e = rdk.Explorer(); e.set(generations=1000, population=60, view='optimise');"
            "e.optimise(); e.set(slope_deg=3); print('end')")
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120)
    assert (done.returncode, done.stdout, done.stderr) == (0, "end\n", "")


# ---- files and Python -----------------------------------------------------------------------------------------

@pytest.mark.parametrize("name", ["design.json", "design.csv"])
def test_a_kept_design_comes_back(explorer, name):
    explorer.set(mission=POLAR, wheel_radius_m=0.123, wheel_count=6, soil="fjs-1", latitude_deg=-70.5)
    explorer.settle()
    kept, design, mission = explorer.file(name), explorer.design, explorer.scenario
    for _ in range(2):                                   # the same file twice
        explorer.set(rover="Yutu-2", mission=MARE)
        events(explorer, ["do", "load", name, "\ufeff" + kept])
        assert explorer.design == design and f"{name} loaded" in shown(explorer, "drawer")
        assert_current(explorer)
    if name == "design.json":
        assert dataclasses.replace(explorer.scenario,
                                   problem=Problem()) == dataclasses.replace(mission, problem=Problem())
    events(explorer, ["do", "undo"])
    assert explorer.design == rdk.rover("Yutu-2")


@pytest.mark.parametrize("name", ["front.json", "front.csv"])
def test_a_kept_front_comes_back(explorer, name):
    explorer.set(population=12, generations=3)
    explorer.optimise(wait=True)
    kept, front = explorer.file(name), explorer.front
    explorer.front = explorer._recipe = None
    explorer.load(name, kept)
    explorer.set(view="optimise")
    assert_current(explorer)
    assert explorer.design == front.designs[0] and len(explorer.front) == len(front) == len(dots(explorer))
    np.testing.assert_allclose(explorer.front.performance.range_km, front.performance.range_km, rtol=1e-12)
    assert explorer.file(name) == kept and "pareto_front" not in explorer.python()


def test_a_front_from_beyond_the_sliders_is_shown_as_it_is_and_cut_when_picked(explorer):
    designs = rdk.random_designs(3, seed=1).replace(wheel_radius_m=[0.3, 0.1, 0.25])
    with pytest.warns(UserWarning, match="wheel_radius_m"):
        explorer.load("front.csv", catalog.to_csv(designs))
        explorer.settle()
    assert explorer.front.designs == designs and explorer.design.wheel_radius_m == 0.2
    assert "3 designs" in shown(explorer, "drawer") and "radius 300 cut to 200 mm" in shown(explorer, "drawer")
    events(explorer, ["do", "point:2"])
    assert explorer.design.wheel_radius_m == 0.2 and "radius 250 cut to 200 mm" in shown(explorer, "drawer")
    assert_current(explorer)


def test_files_are_delivered_to_the_page(explorer):
    for name in "design.json", "picture.svg", "report.html":
        events(explorer, ["do", f"save:{name}"])
        assert f'data-deliver download="{name}"' in explorer.parts["drawer"].value
    assert "there is no front yet" in (events(explorer, ["do", "save:front.csv"]) or shown(explorer, "drawer"))
    assert sound(explorer.file("picture.svg"))


GOOD = json.loads(catalog.to_json(rdk.rover("Rashid-1"), rdk.scenario(MARE)))


def damaged(**changes):
    return json.dumps({**GOOD, **changes})


@pytest.mark.parametrize("name, content, words", [
    ("a.json", "", "not a JSON file"), ("a.json", "\ufffd\x00", "was not loaded"),
    ("a.json", "[" * 100_000, "not a JSON file"),
    ("a.json", damaged(design={}), "lacks wheel_radius_m"),
    ("a.json", damaged(design={**GOOD["design"], "wheel_count": 5}), "wheel_count must be one of 4, 6"),
    ("a.json", damaged(design={**GOOD["design"], "wheel_radius_m": [[0.1, 0.1]]}), "one design or a list"),
    ("a.json", damaged(scenario={**GOOD["scenario"], "latitude_deg": [1, 2]}), "must hold single numbers"),
    ("a.csv", "a,b\n1,2\n", "wheel_radius_m"), ("<b>.json", "{", "<b>.json was not loaded")])
def test_a_damaged_file_is_refused_in_words(explorer, name, content, words):
    before = explorer.design, explorer.scenario
    explorer.load(name, content)
    explorer.settle()
    assert words in shown(explorer, "drawer") and 'role="alert"' in explorer.parts["drawer"].value
    assert "<b>.json" not in explorer.parts["drawer"].value
    assert (explorer.design, explorer.scenario) == before


@pytest.mark.parametrize("view", ["log", "why", "sweep", "optimise"])
def test_the_python_reproduces_what_is_shown(explorer, view):
    explorer.set(rover="Pragyan", mission="highland_slope_capability", wheel_radius_m=0.1234, slope_deg=12,
                 payload_mass_kg=4, baseline="CADRE-unit", sweep_first="grouser_count", sweep_second="slope_deg",
                 population=12, generations=3, drivetrain_efficiency=0.7, hub_no_load_speed_rad_s=np.inf, view=view)
    events(explorer, ["do", "python"])
    explorer.set(payload_power_w=3.5)                    # what is open follows the state
    if view == "optimise":
        explorer.optimise(wait=True)
    explorer.settle()
    code, space = explorer.python(), {}
    assert html.escape(code) in explorer.parts["drawer"].value
    exec(code, space)
    assert space["result"].numbers() == explorer.result.numbers()
    for name in "range_km", "slip":
        assert space["intervals"].low[name] == explorer.intervals.low[name]
    assert len(space.keys() & {"why", "curve", "front"}) == (view != "log")
    if view == "why":
        wanted = rdk.attribution(explorer.design, rdk.rover("CADRE-unit"), explorer.scenario, model=explorer.model)
        np.testing.assert_array_equal(space["why"].contributions["range_km"], wanted.contributions["range_km"])
    elif view == "sweep":
        assert space["curve"].fields == ("grouser_count", "slope_deg") and space["curve"].performance.shape == (25, 25)
    elif view == "optimise":
        for name in rdk.DESIGN_SPACE:
            np.testing.assert_array_equal(getattr(space["front"].designs, name), getattr(explorer.front.designs, name))
        explorer.set(latitude_deg=33)                    # the front is still that of the mission before
        assert "pareto_front" not in explorer.python()


# ---- pictures -------------------------------------------------------------------------------------------------

def test_why_adds_up_and_says_when_there_is_no_difference():
    def drawn(shares, after):
        ends = rdk.evaluate(rdk.random_designs(2, seed=1), rdk.scenario(MARE)).replace(range_km=np.array([10.0, after]))
        return pictures.why("range_km", list("abcdefghijk"), Attribution({"range_km": shares}, ends[1], ends[0]),
                            "a baseline")

    shares = np.array([3.0, -1.0, 0.5, 0, 0, 0, 0, 0, 0, 0, 1e-17])
    picture = drawn(shares, 12.5)
    assert sound(picture).endswith("a +3; b -1; c +0.5.")
    bars = re.findall(r'<rect class="bar ([^"]*)" x="([^"]*)" y="[^"]*" width="([^"]*)"', picture)
    assert [look for look, *_ in bars] == ["f0", "f0", "l c1", "f0", "f0"]         # open where it falls; both ends
    x, width = np.array([[float(v) for v in bar[1:]] for bar in bars]).T
    np.testing.assert_allclose(width[1:4] / width[1], [1, 1 / 3, 1 / 6], rtol=1e-3)    # five digits are written
    np.testing.assert_allclose([x[1], x[2] + width[2], x[3]], [x[0], x[1] + width[1], x[2]], rtol=1e-4)    # a staircase
    same = sound(drawn(shares * 1e-17, 10.0))
    assert same.startswith("The same range as a baseline")


def test_axes_have_round_ticks_and_survive_single_values():
    assert pictures.ticks(0, 31, 4) == [0, 10, 20, 30] and pictures.ticks(0.8, 130,
                                                                          log=True) == [1, 2, 5, 10, 20, 50, 100]
    for values in ([0.0], [5.0, 5.0], [1e-17, -1e-17], [np.nan], [np.inf, 3.0], []):
        low, high = pictures.span(values)
        assert low < high and 1 <= len(pictures.ticks(low, high)) <= 12


def test_a_line_keeps_its_ends_its_cliffs_and_breaks_where_there_is_no_value():
    axes = pictures.Axes((600, 100), (0, 1), (0, 1), 0, 0, 0, 0)
    x = np.linspace(0, 1, 1001)
    axes.line(x, np.where(x < 0.5003, 1.0, 0.0))
    points = np.array(re.findall(r"[ML]([\d.]+) ([\d.]+)", axes.parts[0]), float)
    assert len(points) < 260 and points[0].tolist() == [0, 0] and points[-1].tolist() == [600, 100]
    fall = np.flatnonzero(np.diff(points[:, 1]))
    assert len(fall) == 1 and np.diff(points[fall[0]:fall[0] + 2, 0]) < 1
    axes.line(x, np.where(abs(x - 0.5) < 0.1, np.nan, 0.5))
    assert axes.parts[1].count("M") == 2


def test_a_sweep_draws_a_cliff_as_one(explorer):
    explorer.set(mission=POLAR, view="sweep", sweep_first="wheel_radius_m")
    explorer.settle()
    line = re.search(r'class="l c0" d="([^"]*)"', explorer._picture)[1]
    points = np.array(re.findall(r"[ML]([\d.]+) ([\d.]+)", line), float)
    steepest = np.abs(np.diff(points[:, 1])).argmax()
    assert np.diff(points[steepest:steepest + 2, 0]) < 2 and "cannot drive" in explorer._picture


def test_a_front_shows_what_has_a_place_on_its_axes(explorer):
    """A buried wheel has no slip: its pin, its dot and its cross are left out."""
    mud = {"frictional_modulus_kn_m_n2": 20.0, "cohesive_modulus_kn_m_n1": 0.0, "sinkage_exponent": 1.0}
    explorer.set(view="optimise", front_x="slip", wheel_width_m=0.03, chassis_mass_kg=40.0, **mud)
    explorer.load("front.csv", catalog.to_csv(rdk.random_designs(30, seed=3)))
    explorer.pin()
    explorer.settle()
    buried = explorer.front.performance.buried
    assert 0 < buried.sum() < 30 and len(dots(explorer)) == 30 - buried.sum()
    explorer.pick(int(buried.argmax()))
    explorer.pin()
    explorer.settle()
    assert np.isnan(explorer.result.slip)
    sound(explorer._picture)


@pytest.mark.parametrize("second", ["", "slope_deg"])
def test_a_sweep_marks_a_design_without_a_limit_at_the_end(explorer, second):
    explorer.set(view="sweep", sweep_first="maximum_speed_m_s", sweep_second=second, maximum_speed_m_s=np.inf)
    explorer.settle()
    sound(explorer._picture)


def test_styles_and_script_are_whole():
    for text in page.STYLE, page.SCRIPT:
        bare = re.sub(r"'[^'\n]*'|\"[^\"\n]*\"|/\*.*?\*/", "", text, flags=re.S)
        for left, right in ("{", "}"), ("(", ")"), ("[", "]"):
            assert bare.count(left) == bare.count(right) > 0 or left == "[" and right not in bare
        assert "{ {" not in re.sub(r"\s+", " ", bare) and max(map(len, text.splitlines())) <= 120
