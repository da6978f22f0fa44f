"""Every value in data/ against the dictionary in data/README.md, which is read here as the schema."""

import csv
import dataclasses
import fnmatch
import re
from pathlib import Path

import pytest

import rdk
from rdk import stability

DATA = Path(__file__).parents[1] / "data"
ROWS = {"soils.csv": 11, "scenarios.csv": 14, "rovers.csv": 13, "flown.csv": 2, "single_wheel.csv": 27,
        "rovers_more.csv": 65, "constants.csv": 70, "paper_targets.csv": 69, "studies.csv": 4,
        "single_wheel_more.csv": 71, "uncertainties.csv": 22, "skyline_sites.csv": 48, "skylines.csv": 360,
        "published_light.csv": 6,
        "subsolar_points.csv": 21, "sun_horizons_2024.csv": 96, "ridge_route.csv": 136,
        "ridge_route_skylines.csv": 180, "ridge_light_2026.csv": 61, "slope_histograms.csv": 45,
        "explorer_inputs.csv": 38}
UNITS = {"_deg": "deg", "_kn_m_n1": "kN/m^(n+1)", "_kn_m_n2": "kN/m^(n+2)", "_kpa": "kPa", "_mm": "mm",
         "_kg_m3": "kg/m3", "_kg": "kg", "_km": "km", "_days": "Earth days", "_w": "W", "_wh": "Wh",
         "_nm": "N m", "_m2": "m2", "_n": "N", "_m": "m", "_c": "degC", "_pct": "%", "_date": "days"}
NUMBERS = {"number": r"-?\d+(\.\d+)?", "integer": r"\d+"}


def dictionary():
    """{file: {column: (unit, type, optional, allowed)}} from the tables of data/README.md."""
    found = {}
    for section in (DATA / "README.md").read_text(encoding="utf-8").split("\n## ")[1:]:
        name, _, body = section.partition("\n")
        cells = [[cell.strip() for cell in line.strip("| ").split(" |")] for line in body.splitlines()
                 if line.startswith("| `")]
        if cells:
            found[name] = {column.strip("`"): (unit, kind.partition(",")[0], "optional" in kind, rule)
                           for column, unit, kind, rule, _ in cells}
    return found


def read(name):
    """Header and rows of a file, read with nothing but the csv module."""
    text = (DATA / name).read_bytes().decode("utf-8")
    assert "\r" not in text and text.endswith("\n") and not text.startswith("\ufeff")
    header, *rows = csv.reader(text.splitlines(), strict=True)
    assert all(len(row) == len(header) for row in rows)
    return header, [dict(zip(header, row)) for row in rows]


def spread(columns, header):
    """The dictionary's columns with those of a pattern, such as `*_pct`, in its place, in the order of the header."""
    found = {name: (pattern, *rule) for pattern, rule in columns.items() for name in fnmatch.filter(header, pattern)}
    missing = {name: (name, *rule) for name, rule in columns.items() if "*" not in name and name not in found}
    plain = list(columns) if not any("*" in name for name in columns) else header
    return {name: (found | missing)[name] for name in plain if name in found | missing}


SCHEMA = dictionary()
TABLES = {name: read(name)[1] for name in ROWS}
PATTERNS = {name for name in ROWS if any("*" in column for column in SCHEMA[name])}
SPREAD = {name: spread(SCHEMA[name], read(name)[0]) for name in ROWS}
CELLS = [(name, column) for name in ROWS for column in SCHEMA[name]]
BIBLIOGRAPHY = re.findall(r"^@\w+\{([^,\s]+),", (DATA / "references.bib").read_text(encoding="utf-8"), re.M)


def allowed(text, value):
    """Whether `value` is in the interval `text`, such as "(0, 5]"."""
    opening, low, high, closing = re.fullmatch(r"([\[(])(\S+), (\S+)([\])])", text).groups()
    above = value >= float(low) if opening == "[" else value > float(low)
    return above and (value <= float(high) if closing == "]" else value < float(high))


def entries(cell):
    return cell.split(";") if cell else []


def test_the_dictionary_names_every_file_and_the_reader_rejects():
    assert set(SCHEMA) == set(ROWS) == {path.name for path in DATA.glob("*.csv")}
    # the two helpers above decide what passes below: they must be able to say no
    assert allowed("(0, 5]", 5) and allowed("[-1, 1)", -1)
    assert not allowed("(0, 5]", 0) and not allowed("[0, 5)", 5)
    assert not any(re.fullmatch(NUMBERS["number"], text) for text in ("", "nan", "inf", " 1", "1,5"))


@pytest.mark.parametrize("name", ROWS)
def test_header_and_length(name):
    header, rows = read(name)
    assert header == list(SPREAD[name])
    assert len(rows) == ROWS[name]


@pytest.mark.parametrize("name, column", CELLS)
def test_unit_is_the_suffix_of_the_name(name, column):
    unit, kind, _, _ = SCHEMA[name][column]
    if column.endswith("*") or re.search(r"\*_?\d*m$", column):
        return                                           # the name says where, not what
    suffix = next((s for s in sorted(UNITS, key=len, reverse=True) if column.endswith(s)), None)
    if kind not in ("number", "integer", "range"):
        assert unit == ""
    elif "`" not in unit:  # `...` names the column that tells the unit
        assert unit == (UNITS[suffix] if suffix else "1")


@pytest.mark.parametrize("name, column", CELLS)
def test_every_value_has_its_type_and_is_allowed(name, column):
    _, kind, optional, rule = SCHEMA[name][column]
    columns = [spread for spread, (pattern, *_) in SPREAD[name].items() if pattern == column]
    values = [row[spread] for row in TABLES[name] for spread in columns]
    assert optional or all(values), "an empty cell"
    assert not all(values) or not optional or kind == "list" or column == "note", "optional, but never empty"
    for value in filter(None, values):
        assert value == value.strip() and "  " not in value
        if kind in NUMBERS:
            assert re.fullmatch(NUMBERS[kind], value), value
            assert value in rule.split("; ") if ";" in rule else allowed(rule, float(value)), value
        elif kind == "range":
            low, high = map(float, value.split(".."))
            assert low < high and allowed(rule, low) and allowed(rule, high), value
        elif kind == "flag":
            assert value in ("True", "False")
        elif kind == "name":
            key, file = re.fullmatch(r"an? (\w+) of `(\S+)`", rule).groups()
            assert value in {row[key] for row in TABLES[file]}, value
        elif kind == "list":
            assert len(set(entries(value))) == len(entries(value)) and all(entries(value))
        else:
            assert kind in ("text", "key") and (not rule or value in rule.split("; ")), value
    assert kind != "key" or len(set(values)) == len(values)


def test_every_source_is_in_the_bibliography():
    assert len(set(BIBLIOGRAPHY)) == len(BIBLIOGRAPHY) == 110
    for name in PATTERNS:                                # their sources stand above their columns
        section = (DATA / "README.md").read_text(encoding="utf-8").partition(f"\n## {name}\n")[2].partition("\n|")[0]
        named = re.findall(r"`(\w+)`", section.partition("Sources")[2])
        assert named and set(named) <= set(BIBLIOGRAPHY), name
    for name, rows in TABLES.items():
        for row in [] if name in PATTERNS or name == "explorer_inputs.csv" else rows:         # words and spans are ours
            if row.get("origin") == "collection" and not row["source"]:                # assumed here, and says so
                assert row["status"] == "imputed" and row["note"]
                continue
            if name == "rovers_more.csv" and not row["source"]:                        # says in words where it was read
                assert row["read_in"]
                continue
            assert row["source"] and set(entries(row["source"])) <= set(BIBLIOGRAPHY), (name, row["source"])


@pytest.mark.parametrize("name", ["soils.csv", "scenarios.csv", "rovers.csv", "flown.csv"])
def test_every_number_is_published_derived_or_imputed(name):
    kinds = ("number", "integer", "flag")
    numeric = {column for column, (_, kind, *_) in SCHEMA[name].items() if kind in kinds}
    for row in TABLES[name]:
        shares = [entries(row[f"{status}_fields"]) for status in ("published", "derived", "imputed")]
        listed = sum(shares, [])
        assert len(listed) == len(set(listed)), "a field in two lists"
        # in_class is our own classification; an empty cell has no origin
        assert set(listed) == {column for column in numeric - {"in_class"} if row[column]}


def test_rows_agree_with_themselves():
    assert len({(row["rover"], row["use"]) for row in TABLES["rovers.csv"]}) == ROWS["rovers.csv"]
    for row in TABLES["rovers.csv"]:
        assert row["architecture"] == {"4": "rigid_4wheel", "6": "rocker_bogie_6wheel"}[row["wheel_count"]]
        assert (row["in_class"] == "True") == (5 <= float(row["published_mass_kg"]) <= 50)
        if row["use"] == "design vector":
            assert row["wheelbase_m"] and row["peak_wheel_torque_nm"]
    for row in TABLES["rovers.csv"] + TABLES["single_wheel.csv"] + TABLES["single_wheel_more.csv"]:
        height = row.get("grouser_height_m") or row["grouser_height_mm"]
        assert (float(height) == 0) == (row["grouser_count"] == "0")
    for row in TABLES["single_wheel.csv"] + TABLES["single_wheel_more.csv"]:
        assert (row["wheel"] == "smooth") == (row["grouser_count"] == "0")
    for row in TABLES["flown.csv"]:
        for value in ("traverse_{}_m", "peak_solar_{}_w"):
            low, high = (float(row[value.format(end)]) for end in ("low", "high"))
            assert low <= float(row.get(value.format("published")) or row["peak_solar_w"]) <= high
    for row in TABLES["scenarios.csv"]:
        assert (row["kind"] == "canonical") == bool(row["family_latitude_deg"])
        for point, family in ("latitude_deg", "latitude_deg"), ("duration_earth_days", "duration_days"):
            if band := row["family_" + family]:
                low, high = map(float, band.split(".."))
                assert low <= float(row[point]) <= high


def test_facts_of_further_rovers_have_one_value_each_and_the_unit_of_their_name():
    rows = TABLES["rovers_more.csv"]
    assert len({(row["rover"], row["field"]) for row in rows}) == len(rows)
    suffixes = {"_kg": "kg", "_m": "m", "_deg": "deg", "_m_s": "m/s", "_kpa": "kPa", "_nm": "N m",
                "_wh_per_km": "Wh/km", "_count": "1", "_fraction": "1"}
    own = {row["rover"]: row for row in TABLES["rovers.csv"]}
    for row in rows:
        end = max((s for s in suffixes if row["field"].endswith(s)), key=len)
        assert row["unit"] == suffixes[end], row
        of = own.get(row["rover"])
        assert not of or row["architecture"] == of["architecture"] and row["field"] != "wheel_count"
        if row["field"] == "total_mass_kg":
            assert (row["in_class"] == "True") == (5 <= float(row["value"]) <= 50)
    # the one rover of both tables that grew, and whose later mass says why
    assert {row["rover"] for row in rows if row["field"] == "total_mass_kg"} & set(own) == {"MoonRanger"}
    assert sum(bool(row["drawbar_pull_n"]) != bool(row["sinkage_relative_mm"])
               for row in TABLES["single_wheel_more.csv"]) == ROWS["single_wheel_more.csv"]


def test_the_derived_torque_follows_the_anchor_rule():
    value = {row["name"]: float(row["value"]) for row in TABLES["constants.csv"]}
    (row,) = [row for row in TABLES["rovers.csv"] if "peak_wheel_torque_nm" in entries(row["derived_fields"])]
    load = float(row["published_mass_kg"]) * value["gravity_m_s2"] / float(row["wheel_count"])
    anchor = value["torque_anchor_margin"] * value["torque_anchor_coefficient"]
    torque = anchor * load * float(row["wheel_radius_m"])
    assert round(torque, 3) == float(row["peak_wheel_torque_nm"])  # the table prints three decimals


def test_sourcebook_soil_differs_from_apollo_nominal_in_the_friction_angle_only():
    rows = {row["soil"]: row for row in TABLES["soils.csv"]}
    numeric = [column for column, (unit, *_) in SCHEMA["soils.csv"].items() if unit]
    differ = [c for c in numeric if rows["apollo-nominal"][c] != rows["sourcebook-trafficability"][c]]
    assert differ == ["friction_angle_deg"]


def test_paper_values_lie_in_their_own_bands():
    checked = 0
    for row in TABLES["paper_targets.csv"]:
        band = re.fullmatch(r"(-?[\d.]+?)\.\.(-?[\d.]+)", row["accept"])
        if band and re.fullmatch(NUMBERS["number"], row["paper_value"]):
            assert float(band[1]) <= float(row["paper_value"]) <= float(band[2]), row["id"]
            checked += 1
    assert checked > 30


def test_studies_and_uncertainties_speak_of_what_exists():
    metrics = {field.name for field in dataclasses.fields(rdk.Performance)}
    for row in TABLES["studies.csv"]:
        goals = [re.fullmatch(r"(\w+):(max|min)", goal)[1] for goal in entries(row["objectives"])]
        limits = [re.fullmatch(r"(\w+) [<>]= [\d.]+", limit)[1] for limit in entries(row["constraints"])]
        assert set(goals + limits) <= metrics and len(goals) >= 2
    canonical = [row["scenario"] for row in TABLES["scenarios.csv"] if row["kind"] == "canonical"]
    assert sorted(row["scenario"] for row in TABLES["studies.csv"]) == sorted(canonical)
    for row in TABLES["uncertainties.csv"]:
        record = getattr(rdk, row["record"].title())
        assert row["name"] in {field.name for field in dataclasses.fields(record)}
        low, high, unchanged = float(row["low"]), float(row["high"]), {"factor": 1, "offset": 0}.get(row["kind"], 0)
        assert low < high and (low <= unchanged <= high or row["kind"] == "value")
        # a cut at the nominal value of any soil would move the middle of the interval
        cut = [float(row[end] or fallback) for end, fallback in (("minimum", "-inf"), ("maximum", "inf"))]
        records = map(rdk.soil, rdk.soil_names()) if row["record"] == "soil" else [rdk.Model()]
        assert all(cut[0] <= getattr(record, row["name"]) < cut[1] for record in records)
        assert row["note"], "says where the bounds come from, or that they are judgement"
    for name in {row["name"] for row in TABLES["uncertainties.csv"]}:
        rows = [row for row in TABLES["uncertainties.csv"] if row["name"] == name]
        for condition in {row["when"] for row in rows if row["when"]} or {""}:       # alternatives
            assert sum(float(row["weight"] or 1) for row in rows if row["when"] in ("", condition)) == 1, name


def test_model_defaults_are_the_constants_of_the_table():
    fields = {field.name: field.default for field in dataclasses.fields(rdk.Model)} | dict(zip(
        ("transition_c1", "transition_c2"), rdk.Model().transition))
    assert fields.pop("kernel") == "paper"
    table = {row["name"]: float(row["value"]) for row in TABLES["constants.csv"] if row["kind"] == "model"}
    assert fields == table
    changed = {row["name"]: float(row["engineering"]) for row in TABLES["constants.csv"] if row["engineering"]}
    assert rdk.Model.engineering() == rdk.Model(**changed) and all(table[name] != changed[name] for name in changed)
    study = {row["name"]: float(row["value"]) for row in TABLES["constants.csv"] if row["kind"] == "study"}
    assert (study["rigid_belly_ratio"], study["rocker_bogie_belly_ratio"], study["least_body_height_m"]) == (
        stability.RIGID_BELLY_RADII, stability.ROCKER_BELLY_RADII, stability.LEAST_BODY_HEIGHT_M)
    defaults = {field.name: field.default for field in dataclasses.fields(rdk.Soil)}
    for row in TABLES["constants.csv"]:
        if row["kind"] == "soil default":
            assert defaults[row["name"]] == float(row["value"])


def test_skylines_belong_to_their_sites():
    seen = {f"{row['site']}_{row['height_m']}m" for row in TABLES["skyline_sites.csv"]}
    assert set(TABLES["skylines.csv"][0]) == {"azimuth_deg"} | seen and len(seen) == ROWS["skyline_sites.csv"]
    assert [float(row["azimuth_deg"]) for row in TABLES["skylines.csv"]] == list(range(360))
    for row in TABLES["skyline_sites.csv"]:              # some hours are lit in part
        assert float(row["lit_pct"]) + float(row["dark_pct"]) <= 100
    length = max(float(row["distance_m"]) for row in TABLES["ridge_route.csv"])
    places = [float(column[3:-1]) for column in TABLES["ridge_route_skylines.csv"][0] if column != "azimuth_deg"]
    assert places == sorted(places) and places[0] == 0 and abs(places[-1] - length) < 1


def test_slope_classes_hold_every_cell():
    for column in set(TABLES["slope_histograms.csv"][0]) - {"slope_from_deg", "slope_to_deg"}:
        total = sum(float(row[column]) for row in TABLES["slope_histograms.csv"])
        assert abs(total - 100) < 0.05, column               # printed with three decimals, 45 classes
