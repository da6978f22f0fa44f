"""The one-page report: what it says against the functions that say it, its HTML, its picture, its page."""

import base64
import json
import os
import re
import shutil
import subprocess
import sys
from dataclasses import replace
from html.parser import HTMLParser

import numpy as np
import pytest

import rdk
from rdk import catalog, pictures, sky
from exercises.capstone import SWIRL
from rdk.design import Problem
from rdk.report import report, requirements, write

MARE = rdk.scenario("equatorial_mare_traverse")
RASHID = rdk.rover("Rashid-1")
CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)


class Page(HTMLParser):
    """Elements, text and table rows of a page; every element that needs closing is closed in order."""

    def __init__(self, text):
        super().__init__()
        self.open, self.pictures, self.links, self.rows, self.words = [], [], [], [], []
        self.feed(text)
        assert not self.open, f"left open: {self.open}"

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        if "aria-label" in attributes and tag == "svg":
            self.pictures.append(attributes["aria-label"])
        elif tag == "a":
            self.links.append(attributes)
        elif tag == "tr":
            self.rows.append((attributes.get("class", ""), []))
        if tag != "meta":
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        if self.open[-1:] == ["td"]:
            self.rows[-1][1].append(data)
        if "style" not in self.open:
            self.words.append(data)


@pytest.fixture(scope="module")
def text():
    return report(RASHID, MARE, "Rashid-1 <on> a mare & back", "First, 5 < 6.\n\nSecond.", draws=100)


@pytest.fixture(scope="module")
def page(text):
    return Page(text)


def test_the_page_is_sound_and_needs_nothing_else(text, page):
    assert text.startswith("<!DOCTYPE html>\n<html lang=\"en\">") and 'charset="utf-8"' in text
    assert not re.search(r'(?<!xmlns=")https?:|<script|<link|url\(', text)
    words = " ".join(page.words)
    assert "Rashid-1 <on> a mare & back" in words and "First, 5 < 6." in words
    assert "<h1>Rashid-1 &lt;on&gt;" in text
    assert text.count("<p>First, 5 &lt; 6.</p>") == text.count("<p>Second.</p>") == 1


def test_five_pictures_with_words_for_those_who_do_not_see_them(page):
    assert len(page.pictures) == len(set(page.pictures)) == 5 and min(map(len, page.pictures)) > 60
    assert page.pictures[0].startswith("Rover to scale")


def test_joint_odds_and_candidates_side_by_side():
    asked = replace(MARE, problem=Problem(constraints=(("total_mass_kg", "<=", 16.5), ("range_km", ">=", 70))))
    draws = rdk.intervals(RASHID, asked, draws=200).draws
    odds = np.mean(draws.feasible & (draws.total_mass_kg <= 16.5) & (draws.range_km >= 70))
    assert 0 < odds < 1
    text = report(RASHID, asked, "x", candidates={"B <lighter>": replace(RASHID, chassis_mass_kg=2.0)}, draws=200)
    assert f"All hold at once in {100 * odds:.0f} % of the draws." in text
    rows = {cells[0]: cells for _, cells in Page(text).rows if cells and cells[0] in ("this design", "B <lighter>")}
    assert rows["this design"][-1] == f"{100 * odds:.0f} %" and len(rows) == 2


def test_the_design_is_listed_and_travels_with_the_page(page):
    listed = {cells[0]: cells[1] for _, cells in page.rows if len(cells) == 3}  # the demands have four
    assert listed["wheel radius"] == "0.1 m" and listed["grouser count"] == "14" and len(listed) == 11
    link = next(link for link in page.links if link["download"] == "design.json")
    design, mission = catalog.from_json(base64.b64decode(link["href"].split(",")[1]).decode())
    assert design == RASHID and replace(mission, problem=MARE.problem) == MARE
    json.loads(base64.b64decode(link["href"].split(",")[1]))


def test_limits_of_the_project_are_shown_and_a_variable_outside_is_marked():
    page = Page(report(RASHID, MARE, "x", bounds={"wheel_radius_m": (0.05, 0.09)}, draws=20))
    (mark, cells), = [(mark, cells) for mark, cells in page.rows if cells[:1] == ["wheel radius"]]
    assert mark == "missed" and cells[2] == "0.05 to 0.09, outside"
    assert [mark for mark, cells in page.rows if cells[:1] == ["wheel width"]] == [""]


def test_demands_are_those_of_the_scenario_with_the_drive_itself_first():
    asked = replace(MARE, required_obstacle_height_m=0.04, problem=Problem(
        constraints=(("range_km", ">=", 50), ("total_mass_kg", "<=", 16))))
    found = requirements(RASHID, asked, draws=200)
    assert [d.demand for d in found] == [
        ("feasible", ">=", 1.0), ("range_km", ">=", 50), ("total_mass_kg", "<=", 16),
        ("obstacle_capability_m", ">=", 0.04)]
    assert [d.words for d in found] == ["drives the mission", "range ≥ 50 km", "mass ≤ 16 kg",
                                        "obstacle capability ≥ 0.04 m"]
    nominal, spans = rdk.evaluate(RASHID, asked), rdk.intervals(RASHID, asked, draws=200)
    mass = found[2]
    assert mass.nominal == nominal.total_mass_kg > 16 and not mass.met
    assert (mass.low, mass.high) == (spans.low["total_mass_kg"], spans.high["total_mass_kg"])
    assert mass.share == np.mean(spans.draws.total_mass_kg <= 16)
    assert found[0].share == spans.draws.feasible.mean() and found[3].met and found[3].share == 1


def test_the_driver_of_a_demand_is_the_input_that_moves_it_most():
    asked = replace(MARE, problem=Problem(constraints=(("total_mass_kg", "<=", 16), ("obstacle_capability_m",
                                                                                 ">=", 0.01))))
    mass, obstacle = requirements(RASHID, asked, draws=300)[1:]
    assert obstacle.driver == ""                         # the wheel's radius is not uncertain
    alone = {row["name"]: rdk.intervals(RASHID, asked, draws=300, table=[row]).draws.total_mass_kg.std()
             for row in rdk.catalog.rows("uncertainties.csv")}
    assert mass.driver == max(alone, key=alone.get)


def test_verdict_and_risks_say_what_the_table_says():
    asked = replace(MARE, problem=Problem(constraints=(("total_mass_kg", "<=", 16), ("range_km", ">=", 1))))
    text = report(RASHID, asked, "x", draws=100)
    share = requirements(RASHID, asked, draws=100)[1].share
    assert "<b>Misses 1 of 3 demands: mass ≤ 16 kg. All hold" in text and 'class="verdict missed"' in text
    assert f"“mass ≤ 16 kg” fails in {100 * (1 - share):.0f} % of the draws" in text
    assert rdk.explain.binding(RASHID, asked, rdk.evaluate(RASHID, asked)).sentence in text
    assert [mark for mark, cells in Page(text).rows if cells[:1] == ["mass ≤ 16 kg"]] == ["missed"]
    easy = report(RASHID, replace(MARE, slope_deg=0.0, problem=Problem(constraints=(("total_mass_kg", "<=", 99),
                                                                                ))), "x",
                  draws=100)
    assert "<b>Meets all 2 demands of the mission. All hold" in easy
    assert "Every demand holds in all draws of the uncertain inputs." in easy


def test_front_baseline_and_changed_coefficients_show():
    front = rdk.pareto_front(MARE, population=20, generations=3, seed=1, constraints=[])
    assert len(front) > 2
    text = report(RASHID, MARE, "x", front=front, baseline=rdk.rover("Tenacious"), baseline_name="Tenacious",
                  model=rdk.Model(drivetrain_efficiency=0.7), draws=20)
    alts = Page(text).pictures
    assert alts[1].startswith(f"Front of {len(front)} designs") and "(Tenacious)" in alts[4]
    assert "mass (kg)" in alts[4] and "Model: drivetrain_efficiency = 0.7." in text
    assert "Model: the paper's coefficients." in report(RASHID, MARE, "x", draws=20)


def test_a_rover_that_stalls_or_sinks_still_has_a_page():
    stalled = report(RASHID, replace(MARE, slope_deg=34.0), "x", draws=20)
    assert "Misses" in stalled and "Traction binds" in stalled
    with pytest.warns(UserWarning, match="design outside the class"):
        sunk = report(replace(RASHID, chassis_mass_kg=900.0), replace(MARE, soil=rdk.soil("apollo-loose")),
                      "x", draws=20)
    assert "the rover is buried" in sunk and "NaN" not in " ".join(Page(sunk).words)


@pytest.mark.parametrize("change, words", [
    ({"design": rdk.random_designs(3, seed=1)}, "design must be a single one"),
    ({"scenario": replace(MARE, slope_deg=[1.0, 2.0])}, "scenario must be a single one"),
    ({"model": rdk.Model(shear_scale=[0.9, 1.0])}, "model must be a single one")])
def test_bad_arguments_are_named(change, words):
    with pytest.raises(ValueError, match=words):
        report(**{"design": RASHID, "scenario": MARE, "title": "x", "draws": 20, **change})


def test_candidates_may_be_named_by_anything():
    page = report(RASHID, MARE, "x", draws=20, candidates={4: RASHID, 6: RASHID.replace(wheel_count=6)})
    assert "<td>4</td>" in page and "<td>6</td>" in page


def test_same_inputs_same_page():
    assert report(RASHID, MARE, "x", draws=20) == report(RASHID, MARE, "x", draws=20)


def test_requirement_words_keep_units():
    demands = ("minimum_soc", ">=", 0.2), ("sinkage_m", "<=", 0.2)
    found = requirements(RASHID, replace(MARE, problem=Problem(constraints=demands)), draws=20)
    assert [d.words for d in found[1:]] == ["lowest charge ≥ 0.2", "sinkage ≤ 0.2 m"]


def test_writing_replaces_the_file_in_one_step(tmp_path, monkeypatch):
    path = write("old é", tmp_path / "page.html")
    assert path.read_text(encoding="utf-8") == "old é"
    assert write("new", str(path)) == path and path.read_text() == "new"
    with pytest.raises(UnicodeEncodeError):
        write("bad \ud800",
              path)                        # fails half-way: the old page stays, nothing else does
    assert path.read_text() == "new" and list(tmp_path.iterdir()) == [path]
    with pytest.raises(FileNotFoundError):
        write("x", tmp_path / "no folder" / "page.html")


def test_write_report_writes_the_page_of_report_and_names_a_folder_it_cannot_write(tmp_path):
    path = rdk.write_report(RASHID, MARE, tmp_path / "page.html", " ", draws=20)
    assert path.read_text(encoding="utf-8") == report(RASHID, MARE, "A rover for equatorial_mare_traverse", draws=20)
    (tmp_path / "file").write_text("")
    for folder in "file", "missing":
        with pytest.raises(OSError, match="cannot write page.html there .*; give a path in a folder"):
            write("x", tmp_path / folder / "page.html")


def test_any_name_survives_in_python_that_was_written():
    for name in "it's=inf, sieved", 'a"b\\', "$x_1$ =-inf,", "line\nbreak":
        mission = replace(MARE, name=name, soil=replace(MARE.soil, name=name), traverse_limit_km=np.inf)
        space = {}
        exec(rdk.explain.as_python(RASHID, mission, rdk.Model(hub_no_load_speed_rad_s=np.inf)), space)
        assert replace(space["mission"], problem=MARE.problem) == replace(mission, problem=MARE.problem)
        assert space["model"].hub_no_load_speed_rad_s == np.inf


def test_a_persons_matplotlibrc_does_not_reach_a_live_picture(tmp_path):
    (tmp_path / "matplotlibrc").write_text("text.usetex: True\nfigure.constrained_layout.use: True\nsavefig.dpi: 300\n"
                                           "savefig.bbox: tight\n")
    code = ("import base64, rdk\n"
            "def draw(figure, x):\n    figure.subplots().set_title('a title')\n    return 'x'\n"
            "print(base64.b64decode(rdk.figures.live(draw, x=(0, 1, 1, 0, 'x')).png)[16:24].hex())")
    done = subprocess.run([sys.executable, "-W", "error", "-c", code], capture_output=True, text=True, timeout=120,
                          env={**os.environ, "MATPLOTLIBRC": str(tmp_path), "MPLBACKEND": "agg"})
    assert done.stdout.strip() == f"{520:08x}{360:08x}", done.stderr


@pytest.mark.skipif(CHROMIUM is None, reason="no Chromium")
def test_it_prints_on_one_page_of_a4_with_a_full_page_of_notes(tmp_path):
    from playwright.sync_api import sync_playwright
    notes = "\n\n".join(["A choice, and what was given up for it: " + "some sixty words of text, " * 10] * 4)
    text = report(RASHID, SWIRL.mission, "Rashid-1 at Reiner Gamma", notes, draws=50,
                  bounds=SWIRL.limits)
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox", "--disable-gpu"])
        tab = browser.new_page(viewport={"width": 1000, "height": 1300})
        tab.goto(write(text, tmp_path / "page.html").as_uri())
        assert tab.evaluate("[...document.querySelectorAll(\"svg[aria-label]\")].every(svg => svg.clientWidth > 100)")
        assert tab.evaluate("document.documentElement.scrollWidth") <= 1000
        pdf = tab.pdf(format="A4", prefer_css_page_size=True)
        browser.close()
    assert len(re.findall(rb"/Type\s*/Page\b", pdf)) == 1


@pytest.mark.parametrize("changed, words", [
    (dict(design=rdk.random_designs(3, seed=1)), "design must be a single one"),
    (dict(baseline=rdk.random_designs(3, seed=1)), "baseline must be a single one"),
    (dict(scenario=replace(MARE, slope_deg=[1.0, 2.0])), "scenario must be a single one"),
    (dict(model=rdk.Model(shear_scale=[0.9, 1.0])), "model must be a single one")])
def test_python_is_written_for_single_records_only(changed, words):
    records = {"design": RASHID, "scenario": MARE, "model": rdk.Model(), "baseline": RASHID} | changed
    baseline = records.pop("baseline")
    with pytest.raises(ValueError, match=words):
        rdk.explain.as_python(*records.values(), "x", baseline=baseline)


@pytest.mark.parametrize("call", [
    lambda: rdk.write_report("Rashid-1", MARE, "x.html"), lambda: report("Rashid-1", MARE, "x"),
    lambda: rdk.explain.as_python("Rashid-1", MARE, rdk.Model()), lambda: rdk.Explorer(3)], ids=range(4))
def test_what_is_no_rover_is_refused_with_how_to_get_one(call):
    with pytest.raises(TypeError, match=r"must be a Design, such as rdk.rover\('Rashid-1'\); got"):
        call()


def test_a_folder_in_place_of_a_file_is_refused(tmp_path):
    with pytest.raises(IsADirectoryError, match="path must name a file"):
        rdk.write_report(RASHID, MARE, tmp_path, draws=20)


# ---- pictures ---------------------------------------------------------------------------------------------------

def shaded(picture):
    """Share of the width of a log's panels that is shaded."""
    found = [float(width) for width in re.findall(r'<rect class="f3" x="[^"]*" y="[^"]*" width="([^"]*)"', picture)]
    return sum(found) / 3 / (pictures.SIZE[0] - 106)     # three panels, 44 pixels on their left, 62 on their right


def test_the_log_shades_the_hours_in_which_hills_hide_the_sun():
    site, start = catalog.skyline_sites()["shackleton_rim"], "2026-11-26T12:00"
    hills = catalog.at_latitude(MARE, site["latitude_deg"]).replace(
        skyline=rdk.skyline("shackleton_rim"), longitude_deg=site["longitude_deg"], start_utc=start,
        duration_earth_days=28.0)
    result = rdk.evaluate(RASHID, hills)
    where = sky.sun_position(hills.latitude_deg, hills.longitude_deg, sky.julian_date(start) + result.log.time_h / 24)
    lit = sky.lit_fraction(*where, hills.skyline)
    np.testing.assert_allclose(result.log.lit_fraction, lit, atol=1e-9)      # the same formulas in another order
    hidden = (lit < 0.5) & (result.log.sun_elevation_deg > 0)
    assert hidden.any() and (result.log.solar_w[lit == 0] == 0).all()
    picture = pictures.log(result, hills)
    np.testing.assert_allclose(shaded(picture), np.mean(lit < 0.5), atol=1e-3)         # five digits are written
    assert "shaded: sun hidden" in picture and f"Sun hidden in {100 * np.mean(lit < 0.5):.0f} %" in picture


def test_the_log_of_a_level_horizon_shades_the_night_and_says_so():
    polar = rdk.evaluate(RASHID, rdk.scenario("polar_prospecting"))
    picture = pictures.log(polar, rdk.scenario("polar_prospecting"))
    np.testing.assert_allclose(shaded(picture), np.mean(polar.log.sun_elevation_deg <= 0), atol=1e-3)
    assert 0.3 < shaded(picture) < 0.6 and "shaded: night" in picture
    day = pictures.log(rdk.evaluate(RASHID, MARE.replace(duration_earth_days=7.0)), MARE)
    assert shaded(day) == 0 and "shaded" not in day


def test_each_dot_of_a_front_tells_its_design_and_odds_have_a_scale_from_0_to_1():
    designs = rdk.random_designs(5, seed=2)
    found = rdk.evaluate(designs, MARE)
    odds = np.linspace(0.4, 0.6, 5)
    picture = pictures.front(found, designs, ("total_mass_kg", "range_km", "odds"), rdk.evaluate(RASHID, MARE),
                             odds=odds)
    titles = re.findall(r"<title>([^<]*)</title>", picture)
    for i, told in enumerate(titles):
        assert f"mass {found.total_mass_kg[i]:.4g} kg" in told and f"odds of the demands {odds[i]:.4g}" in told
        assert all(f"{v.label} {getattr(designs, name)[i]:.4g}" in told for name, v in rdk.DESIGN_SPACE.items())
    assert len(titles) == 5 and f'fill="{pictures.shade(0.4)}"' in picture and ">0.2<" in picture and ">0.8<" in picture


def test_names_cover_neither_marks_nor_each_other():
    axes = pictures.Axes((600, 380), (0, 1), (0, 1), 50, 20, 50)
    points = np.random.default_rng(3).random((12, 2)) * 0.9
    for point in points:
        axes.mark(*point)
    for i, point in enumerate(points):
        axes.name(*point, f"rover {i}")
    boxes = np.array(axes.taken)
    assert len(boxes) == 24 and (boxes[:, 0] >= 45).all()
    for a in boxes[12:]:
        over = (boxes[:, 0] < a[2]) & (boxes[:, 2] > a[0]) & (boxes[:, 1] < a[3]) & (boxes[:, 3] > a[1])
        assert over.sum() == 1                           # itself


def test_labels_split_unit_from_words():
    for name, words in {"range_km": ("range", "km"), "cruise_speed_m_s": ("cruise speed", "m/s"), "slip": ("slip", ""),
                        "wheel_torque_nm": ("wheel torque", "N m"), "minimum_soc": ("lowest charge", ""),
                        "ground_pressure_kpa": ("ground pressure", "kPa"), "unserved_h": ("unserved", "h")}.items():
        assert rdk.explain.label(name) == words
    assert rdk.explain.label("cohesive_modulus_kn_m_n1")[0] == "cohesive modulus"
