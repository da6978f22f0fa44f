"""The catalogue: what it holds, what it says of unknown names, and of data that are missing or damaged."""

import csv
import io
import shutil

import pytest

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
    shutil.copytree(DATA, copy)
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
            assert all(getattr(rdk.soil(row["soil"]), name) == float(row[name]) for name in catalog._SOIL)
    with open(DATA / "scenarios.csv", encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            scenario = rdk.scenario(row["scenario"])
            assert all(getattr(scenario, name) == float(row[name]) for name in catalog._SCENARIO)
            assert scenario.soil == rdk.soil(row["soil"]) and scenario.required_obstacle_height_m == 0
    row = catalog.rover_row("CADRE-unit")
    assert all(getattr(rdk.rover("CADRE-unit"), name) == float(row[name]) for name in catalog._DESIGN)
    assert row["use"] == "design vector" and float(row["published_mass_kg"]) == 8.6


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
    (lambda: rdk.soil("apollo"), "no soil 'apollo'; choose from fjs-1, jsc-1a, "),
    (lambda: rdk.soil(""), "no soil ''; choose from fjs-1"),
    (lambda: rdk.soil(None), "no soil None; choose from fjs-1"),
    (lambda: rdk.scenario("mare"), "no scenario 'mare'; choose from equatorial_mare_traverse, "),
    (lambda: rdk.rover("Sojourner"), "no rover 'Sojourner'; choose from Pragyan, "),     # mass check only
    (lambda: rdk.rover("rashid-1"), "no rover 'rashid-1'; choose from .*Rashid-1"),
    (lambda: rdk.scenario_names("arctic"),
     "no kind 'arctic' of scenario; choose from canonical, class-generic, "),
], ids=str)
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
     "soils.csv is damaged: row of 'apollo-nominal': shear_modulus_mm must be positive and finite; got nan"),
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
