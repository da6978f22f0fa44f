"""The catalogue: what it holds, what it says of unknown names, and of data that are missing or damaged."""

import csv
import io
import json
import math
from pathlib import Path

import pytest
from folders import writable_copy

import rdk
from rdk import catalog
from rdk.catalog import DATA

READERS = {"soils.csv": lambda: rdk.soil("apollo-nominal"),
           "scenarios.csv": lambda: rdk.scenario("mare_micro"),
           "rovers.csv": lambda: rdk.rover("Rashid-1")}


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A copy of the data folder that the catalogue reads instead."""
    copy = tmp_path / "data"
    writable_copy(DATA, copy)
    monkeypatch.setattr(catalog, "DATA", copy)
    yield copy
    catalog._rows.cache_clear()


# ---- what it holds -----------------------------------------------------------------------------------------

def test_every_name_can_be_read():
    assert len(rdk.soil_names()) == len(catalog.rows("soils.csv")) > 10
    assert len(rdk.scenario_names()) == len(catalog.rows("scenarios.csv")) > 13
    assert [rdk.soil(name).name for name in rdk.soil_names()] == list(rdk.soil_names())
    assert [rdk.scenario(name).name for name in rdk.scenario_names()] == list(rdk.scenario_names())
    assert all(isinstance(rdk.rover(name), rdk.Design) for name in rdk.rover_names())
    assert rdk.scenario_names("canonical") == ("equatorial_mare_traverse", "polar_prospecting",
                                               "highland_slope_capability", "crater_rim_survey")
    assert set(rdk.rover_names()) >= {"Pragyan", "Yutu-2", "MoonRanger", "Rashid-1", "Tenacious",
                                      "CADRE-unit"}


def test_values_are_those_of_the_files():
    with open(DATA / "soils.csv", encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            soil = rdk.soil(row["soil"])
            assert all(value == float(row[name]) for name, value in soil.numbers().items())
    with open(DATA / "scenarios.csv", encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            scenario = rdk.scenario(row["scenario"])
            assert all(getattr(scenario, name) == float(row[name]) for name in catalog._SCENARIO)
            assert scenario.soil == rdk.soil(row["soil"]) and scenario.required_obstacle_height_m == 0
    row, = (row for row in catalog.rows("rovers.csv") if row["rover"] == "CADRE-unit" and row["use"] == "design vector")
    assert all(getattr(rdk.rover("CADRE-unit"), name) == float(row[name]) for name in rdk.DESIGN_SPACE)


def test_panels_are_tilted_towards_the_noon_sun():
    for name, tilt, azimuth in (("equatorial_mare_traverse", 20.2, 180), ("polar_prospecting", 80, 0),
                                ("crater_rim_survey", 0, 180), ("chandrayaan3_pragyan", 69.4, 0)):
        assert rdk.scenario(name).panel_tilt_deg == tilt and rdk.scenario(name).panel_azimuth_deg == azimuth


def test_table_is_the_file_as_a_frame():
    frame = catalog.table("rovers.csv")
    assert len(frame) == len(catalog.rows("rovers.csv")) > 12
    assert frame.published_mass_kg.dtype == float and frame.in_class.dtype == bool
    assert (frame.wheelbase_m.isna() == (frame.use == "mass check")).all()   # which needs no wheelbase
    rows = catalog.rows("rovers.csv")
    rows[0]["rover"] = "changed"
    assert catalog.rows("rovers.csv")[0]["rover"] != "changed"


@pytest.mark.parametrize("call, message", [
    (lambda: rdk.soil("apollo"), "no soil 'apollo'; nearest are .*apollo-loose"),
    (lambda: rdk.soil(""), "no soil ''; choose from fjs-1"),
    (lambda: rdk.soil(None), "no soil None; choose from fjs-1"),
    (lambda: rdk.scenario("mare"), "no scenario 'mare'; nearest are .*mare_micro"),
    (lambda: rdk.rover("Sojourner"),
     "no rover 'Sojourner'; .*Rashid-1|no rover 'Sojourner'; nearest"),     # mass check only
    (lambda: rdk.rover("rashid-1"), "no rover 'rashid-1'; nearest are .*Rashid-1"),
    (lambda: rdk.scenario_names("arctic"),
     "no kind of scenario 'arctic'; choose from canonical, class-generic, "),
], ids=range(7))
def test_unknown_names_are_answered_with_the_known_ones(call, message):
    with pytest.raises(ValueError, match=message):
        call()


# ---- missing and damaged files -----------------------------------------------------------------------------

@pytest.mark.parametrize("name", READERS)
def test_a_missing_file_is_named_with_its_folder_and_a_remedy(folder, name):
    (folder / name).unlink()
    with pytest.raises(FileNotFoundError) as refused:
        READERS[name]()
    message = str(refused.value)
    assert message.startswith(f"{name} is missing from {folder}") and "pip install -e ." in message


def test_a_missing_folder_is_named_too(monkeypatch, tmp_path):
    monkeypatch.setattr(catalog, "DATA", tmp_path / "nowhere")
    for read in READERS.values():
        with pytest.raises(FileNotFoundError, match="is missing from .*nowhere; the data folder comes with"):
            read()


def edited(name, change):
    """The text of a data file with `change` applied to its table of rows."""
    with open(DATA / name, encoding="utf-8", newline="") as file:
        rows = list(csv.reader(file))
    change(rows)
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(rows)
    return text.getvalue()


def cell(row, column, value):
    def change(rows):
        line = next(line for line in rows[1:] if line[0] == row and line[1] != "mass check")
        line[rows[0].index(column)] = value
    return change


def renamed(column):
    def change(rows):
        rows[0][rows[0].index(column)] = "other"
    return change


DAMAGE = [
    ("soils.csv", b"", "soils.csv is damaged: it needs a header and at least one row, has 0 lines"),
    ("soils.csv", b"soil,sinkage_exponent\n", "soils.csv is damaged: it needs .* has 1 lines"),
    ("soils.csv", b"\xff\xfe\x00s", "soils.csv is damaged: .*utf-8"),
    ("soils.csv", b"<html><body>404: not found</body></html>\nx\n", "soils.csv is damaged: no column 'soil'"),
    ("soils.csv", b"version https://git-lfs\noid sha256:0\n", "soils.csv is damaged: no column 'soil'"),
    ("soils.csv", b'soil,"n\na,b\n', "soils.csv is damaged: unexpected end of data"),
    ("rovers.csv", lambda rows: rows[5].pop(), "rovers.csv is damaged: line 6 has 21 values, the header 22"),
    ("scenarios.csv", lambda rows: rows[3].append("1"),
     "scenarios.csv is damaged: line 4 has 19 values, the header 18"),
    ("soils.csv", renamed("soil"), "soils.csv is damaged: no column 'soil'; its first line is 'other,"),
    ("scenarios.csv", renamed("kind"), "scenarios.csv is damaged: no column 'kind'"),
    ("rovers.csv", renamed("use"), "rovers.csv is damaged: no column 'use'"),
    ("soils.csv", renamed("cohesion_kpa"), "soils.csv is damaged: no column 'cohesion_kpa'"),
    ("soils.csv", cell("apollo-nominal", "cohesion_kpa", "0,17"),
     "soils.csv is damaged: cohesion_kpa of 'apollo-nominal' is '0,17', not a number"),
    ("soils.csv", cell("apollo-nominal", "friction_angle_deg", ""),
     "soils.csv is damaged: friction_angle_deg of 'apollo-nominal' is '', not a number"),
    ("soils.csv", cell("apollo-nominal", "friction_angle_deg", "460"),
     "soils.csv is damaged: row of 'apollo-nominal': friction_angle_deg must be .* below 90.*; got 460"),
    ("soils.csv", cell("apollo-nominal", "shear_modulus_mm", "nan"),
     "soils.csv is damaged: shear_modulus_mm of 'apollo-nominal' is 'nan', not a number"),
    ("soils.csv", cell("apollo-nominal", "shear_modulus_mm", "1_8"),
     "soils.csv is damaged: shear_modulus_mm of 'apollo-nominal' is '1_8', not a number"),
    ("scenarios.csv", cell("mare_micro", "duty_cycle", "10"),
     "scenarios.csv is damaged: row of 'mare_micro': duty_cycle must be .* at most 1 and finite; got 10"),
    ("scenarios.csv", cell("mare_micro", "soil", "moondust"),
     "scenarios.csv is damaged: row of 'mare_micro': no soil 'moondust' in soils.csv"),
    ("rovers.csv", cell("Rashid-1", "wheel_count", "5"),
     "rovers.csv is damaged: row of 'Rashid-1': wheel_count must be one of 4, 6; got 5"),
    ("rovers.csv", cell("Rashid-1", "wheelbase_m", ""),
     "rovers.csv is damaged: wheelbase_m of 'Rashid-1' is '', not a number"),
]


@pytest.mark.parametrize("name, damage, message", DAMAGE, ids=[message[:60] for *_, message in DAMAGE])
def test_a_damaged_file_is_named_with_what_is_wrong(folder, name, damage, message):
    if callable(damage):
        damage = edited(name, damage).encode()
    (folder / name).write_bytes(damage)
    with pytest.raises(ValueError, match=message):
        READERS[name]()


def test_a_repaired_copy_reads_again(folder):
    assert READERS["soils.csv"]() == rdk.soil("apollo-nominal")
    assert catalog.table("soils.csv").soil.tolist() == list(rdk.soil_names())
    (folder / "flown.csv").unlink()
    with pytest.raises(FileNotFoundError, match="flown.csv is missing"):
        catalog.table("flown.csv")


# ---- designs and missions as files -------------------------------------------------------------------------

RASHID, MARE = rdk.rover("Rashid-1"), rdk.scenario("equatorial_mare_traverse")
FLEET = rdk.random_designs(3, seed=1)
TEXT = catalog.to_csv(RASHID)
HEADER, ROW = TEXT.splitlines()
EUROPEAN = TEXT.replace(",", ";").replace(".", ",")


@pytest.mark.parametrize("text", [
    TEXT, "\ufeff" + TEXT, TEXT.replace("\n", "\r\n"), TEXT.replace(",", ", "), TEXT.replace(",", " , "),
    EUROPEAN, "\ufeff" + EUROPEAN, TEXT.replace(",", ";"), TEXT.replace(",", "\t"), "sep=;\n" + EUROPEAN,
    EUROPEAN.replace(";", "\t"), TEXT + "\n,,\n", "\n" + TEXT, TEXT.replace("wheel_count", "n_wheels"),
    TEXT.replace("0.1,", "1e-1,", 1), TEXT.replace("0.1,", "+.1,", 1), TEXT.replace("0.1,", '"0.1",', 1),
    HEADER + ",rover\n" + ROW + ',"a, ""b""\nc"\n', "sep=;\n\n" + EUROPEAN, '"sep=;"\n' + EUROPEAN,
    "\t" + HEADER.replace(",", "\t") + "\n0\t" + ROW.replace(",", "\t"),
    HEADER + ",rover\n" + ROW + ",a\u2028b\x0bc\n"],
    ids=range(22))
def test_a_table_is_read_as_it_is_written_elsewhere(text):
    assert catalog.from_csv(text) == RASHID


REFUSED_TABLES = [
    (HEADER + "\n" + ROW.replace(".", ","), "decimal comma needs another separator"),
    (TEXT.replace("0.1,", '"0,1",', 1), "wheel_radius_m must be a number .*decimal separator"),
    (TEXT.replace(",", "|"), "lacks the columns .*is its separator a comma, a semicolon or a tab"),
    (EUROPEAN.replace("0,08", "0.08"), "decimal commas and points"),
    (HEADER + ",wheel_radius_m\n" + ROW + ",0.19\n", "has the column 'wheel_radius_m' twice"),
    (HEADER + ",n_wheels\n" + ROW + ",6\n", "has the column 'wheel_count' twice"),
    (HEADER + ",range_km, range_km\n" + ROW + ",6,7\n", "has the column 'range_km' twice"),
    (TEXT.replace("wheelbase_m", "wheelbase"), "lacks the columns wheelbase_m"),
    (TEXT + "0.1,0.2\n", "row 2 of the CSV file has 2 values, its header 11"),
    ("", "needs a header"), (HEADER, "needs a header"), ("\ufeff", "needs a header"),
    (TEXT.replace("0.1,", "-0.1,", 1), "wheel_radius_m must be positive and finite; got -0.1")]
REFUSED_TABLES += [(TEXT.replace("50.0,", f"{number},", 1), "battery_capacity_wh must be a number in every row")
                   for number in ("5_0.0", "nan", "inf", "-Infinity", "0x32",
                                      "\u0665\u0660", "5 0", "True", "", "1e", ".")]


@pytest.mark.parametrize("text, message", REFUSED_TABLES, ids=range(len(REFUSED_TABLES)))
def test_a_table_that_could_be_misread_is_refused(text, message):
    with pytest.raises(ValueError, match=message):
        catalog.from_csv(text)


def test_a_table_has_one_row_a_lane():
    grid = RASHID.replace(wheel_radius_m=[[0.1], [0.2]], wheel_width_m=[0.05, 0.06, 0.07])
    again = catalog.from_csv(catalog.to_csv(grid, rdk.evaluate(grid, MARE)))
    assert again.shape == (6,) and again.wheel_width_m.tolist() == [0.05, 0.06, 0.07] * 2
    assert catalog.from_csv(catalog.to_csv(FLEET)) == FLEET
    missions = rdk.evaluate(RASHID, MARE.replace(slope_deg=[0.0, 10.0]))              # one design, two missions
    text = catalog.to_csv(RASHID, missions)
    assert catalog.from_csv(text).wheel_radius_m.tolist() == [0.1, 0.1]
    column = text.splitlines()[0].split(",").index("range_km")
    assert [float(row.split(",")[column]) for row in text.splitlines()[1:]] == missions.range_km.tolist()
    with pytest.raises(ValueError, match=r"design \(3,\), performance \(2,\)"):
        catalog.to_csv(FLEET, missions)
    with pytest.raises(TypeError, match=r"design must be a Design, such as rdk.rover\('Rashid-1'\); got 'Rashid-1'"):
        catalog.to_csv("Rashid-1")


def strict(text):
    """JSON as any program reads it: no bare Infinity or NaN."""
    def refuse(word):
        raise AssertionError(word)
    return json.loads(text, parse_constant=refuse)


ODD = "it's=inf, \"Ba$$in\"\n<b>\u00e9\u0665</b> {x} \\"
MISSIONS = [MARE, rdk.scenario("highland_slope_capability"), MARE.replace(traverse_limit_km=math.inf),
            MARE.replace(name=ODD, soil=MARE.soil.replace(name=ODD)), MARE.replace(maximum_speed_m_s=0.05),
            MARE.replace(start_utc="2026-11-26T12:00", longitude_deg=12.5,
            skyline=rdk.skyline("connecting_ridge_spot_1")),
            MARE.replace(skyline=[0.0, 1.0, -2.0]),
            MARE.replace(problem=rdk.Problem({"range_km": "max", "total_mass_kg": "min"},
                                             (("slope_capability_deg", ">=", 20.0), ("arrival_h", "<=", math.inf)),
                                             math.inf, 7))]


@pytest.mark.parametrize("scenario", MISSIONS, ids=range(len(MISSIONS)))
def test_a_mission_survives_its_file(scenario):
    text = catalog.to_json(RASHID, scenario)
    strict(text)
    design, again = catalog.from_json("\ufeff" + text)
    assert design == RASHID and again == scenario and again.problem == scenario.problem
    assert rdk.evaluate(design, again).range_km == rdk.evaluate(RASHID, scenario).range_km


def test_designs_of_a_front_survive_their_file():
    assert catalog.from_json(catalog.to_json(FLEET)) == (FLEET, None)
    assert catalog.from_json(catalog.to_json(FLEET).replace("wheel_count", "n_wheels"))[0] == FLEET
    with pytest.raises(ValueError, match=r"got shapes \(1, 3\)"):
        catalog.to_json(rdk.Design.stack([FLEET]))
    with pytest.raises(ValueError, match="a single scenario"):
        catalog.to_json(RASHID, MARE.replace(slope_deg=[1.0, 2.0]))


def test_a_file_from_before_the_newer_fields_is_read():
    kept = json.loads(catalog.to_json(RASHID, MARE))
    for name in ("problem", "maximum_speed_m_s", "start_utc", "longitude_deg", "skyline"):
        del kept["scenario"][name]
    assert catalog.from_json(json.dumps(kept))[1] == MARE.replace(problem=rdk.Problem())
    kept["scenario"]["traverse_limit_km"] = math.inf     # once written bare
    assert catalog.from_json(json.dumps(kept))[1].traverse_limit_km == math.inf


GOOD = catalog.to_json(RASHID, MARE)
REFUSED_FILES = [
    (GOOD.replace('"wheel_width_m"', '"wheel_radius_m"'), "'wheel_radius_m' stands there twice"),
    (GOOD.replace('"latitude_deg"', '"slope_deg"'), "'slope_deg' stands there twice"),
    (GOOD.replace('"wheelbase_m"', '"n_wheels"'), "both 'n_wheels' and 'wheel_count'"),
    (GOOD.replace('"panel_tilt_deg"', '"panel_tild_deg"'),
     "scenario has an unknown field 'panel_tild_deg'; nearest are panel_tilt"),
    (GOOD.replace('"cohesion_kpa"', '"cohesion"'), "soil has an unknown field 'cohesion'; nearest are .*cohesion_kpa"),
    (GOOD.replace('"wheel_radius_m": 0.1', '"wheel_radius_m": NaN'),
     "wheel_radius_m must be positive and finite; got nan"),
    (GOOD.replace('"wheel_radius_m": 0.1', '"wheel_radius_m": "Infinity"'), "wheel_radius_m must be positive"),
    (GOOD.replace('"wheel_radius_m": 0.1', '"wheel_radius_m": "0.1"'),
     "wheel_radius_m must be positive and finite; got '0.1'"),
    (GOOD.replace('"wheel_radius_m": 0.1', '"wheel_radius_m": [[1], [2, 3]]'), "wheel_radius_m must be positive"),
    (GOOD.replace('"duty_cycle": 0.3', '"duty_cycle": "Infinity"'), "duty_cycle must be"),
    (GOOD.replace('"duty_cycle": 0.3', '"duty_cycle": [0.3, 0.4]'), "must hold single numbers"),
    (GOOD.replace('"range_km": "max"', '"range_km": "most"'), "objectives must be"),
    (GOOD.replace('">="', '">"'), "constraints must be like"),
    (GOOD[:-20], "not a JSON file"), ("[1]", "not a design kept by rdk"), ("[" * 10**5, "not a JSON file"),
    ('{"format": "rdk-design-1", "design": {"wheel_radius_m": 1}}', "lacks wheel_width_m"),
    ('{"format": "rdk-design-1", "design": {}, "scenario": 3}', "lacks")]


@pytest.mark.parametrize("text, message", REFUSED_FILES, ids=range(len(REFUSED_FILES)))
def test_a_damaged_design_file_is_refused_in_words(text, message):
    with pytest.raises(ValueError, match=message):
        catalog.from_json(text)


@pytest.mark.parametrize("read", [catalog.from_json, catalog.from_csv])
def test_what_is_no_text_is_refused(read):
    for text in (GOOD.encode(), None, Path("rover.json")):
        with pytest.raises(TypeError, match="text must be a str; got"):
            read(text)


@pytest.mark.parametrize("read", [rdk.rover, rdk.scenario, rdk.soil, rdk.skyline])
def test_a_list_of_names_is_no_name(read):
    with pytest.raises(ValueError, match=r"no (rover|scenario|soil|site) \['a'\]"):
        read(["a"])
