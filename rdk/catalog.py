"""The collection's data from `data/`, and designs and missions as files, both read strictly.

`data/README.md` is the dictionary of every column; each row names its source.
"""
import contextlib
import csv
import dataclasses
import functools
import io
import json
import math
import os
import re
from pathlib import Path

import numpy as np

from ._fields import Record, limits_of, require, together, unknown
from .design import DESIGN_SPACE, Design, Problem, Scenario
from .sky import Skyline
from .terramechanics import Soil

_HERE = Path(__file__).resolve().parent
DATA = _HERE / "data" if (_HERE / "data").is_dir() else _HERE.parent / "data"     # in a built wheel, in a clone
_SCENARIO = ("latitude_deg", "duration_earth_days", "slope_deg", "duty_cycle", "traverse_limit_km", "payload_mass_kg",
             "payload_power_w")
_ALIASES = {"n_wheels": "wheel_count"}                   # in the front files of the original release
_PARTS = {"soil": Soil, "problem": Problem, "skyline": Skyline}                    # of a Scenario
_NUMBER = re.compile(r"[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?")
_COLUMNS = {"soils.csv": ("soil", *limits_of(Soil)), "scenarios.csv": ("scenario", "kind", "soil", *_SCENARIO),
            "rovers.csv": ("rover", "use", *DESIGN_SPACE), "studies.csv": ("scenario",)}


@functools.cache
def _rows(file_name, folder):
    path = folder / file_name
    try:
        with open(path, encoding="utf-8", newline="") as file:
            lines = list(csv.reader(file, strict=True))
    except FileNotFoundError:
        raise FileNotFoundError(f"{file_name} is missing from {folder}; the data folder comes with the package "
                                "and with its repository: install rdk anew, or from a clone with 'pip install -e .'"
                                ) from None
    except (UnicodeDecodeError, csv.Error) as error:
        raise ValueError(f"{file_name} is damaged: {error}") from None
    if len(lines) < 2:
        raise ValueError(f"{file_name} is damaged: it needs a header and at least one row, has {len(lines)} lines")
    for name in _COLUMNS.get(file_name, ()):
        if name not in lines[0]:
            first = ",".join(lines[0])[:60]
            raise ValueError(f"{file_name} is damaged: no column {name!r}; its first line is {first!r}")
    for i, line in enumerate(lines[1:], 2):
        if len(line) != len(lines[0]):
            raise ValueError(f"{file_name} is damaged: line {i} has {len(line)} values, the header {len(lines[0])}")
    return tuple(dict(zip(lines[0], line)) for line in lines[1:])


def rows(file_name: str) -> list[dict]:
    """The rows of a file in `data/`, as dictionaries of strings; an error names a file that is missing or damaged."""
    return [dict(row) for row in _rows(file_name, DATA)]


def table(file_name: str):
    """A file in `data/` as a pandas DataFrame, numbers and booleans converted."""
    import pandas as pd
    rows(file_name)                                      # its errors are clearer than pandas'
    return pd.read_csv(DATA / file_name, keep_default_na=False, na_values=[""])


def _float(text):
    """A plain decimal number; what else Python takes for one (5_0, nan, digits of other scripts) is refused."""
    if not _NUMBER.fullmatch(text.strip()):
        raise ValueError(f"{text!r} is not a number")
    return float(text)


def _read(kind, row, names, file_name, label, **more):
    """A `kind` (Soil, Scenario or Design) from the named numbers of a row; errors name file and row."""
    values = {}
    for name in names:
        try:
            values[name] = _float(row[name])
        except ValueError:
            raise ValueError(f"{file_name} is damaged: {name} of {label!r} is {row[name]!r}, not a number") from None
    try:
        return kind(**values, **more)
    except ValueError as error:
        raise ValueError(f"{file_name} is damaged: row of {label!r}: {error}") from None


def _named(file_name, key, **where):
    """The rows of a file that have these values, by their names in the column `key`."""
    return {row[key]: row for row in _rows(file_name, DATA) if where.items() <= row.items()}


def _pick(kind, name, found):
    if not isinstance(name, str) or name not in found:
        raise unknown(f"no {kind}", name, found)
    return found[name]


def soil_names() -> tuple[str, ...]:
    """Names that `soil` knows."""
    return tuple(_named("soils.csv", "soil"))


def scenario_names(kind: str | None = None) -> tuple[str, ...]:
    """Names that `scenario` knows; `kind` is "canonical", "class-generic" or "rover mission"."""
    if kind is None:
        return tuple(_named("scenarios.csv", "scenario"))
    _pick("kind of scenario", kind, _named("scenarios.csv", "kind"))
    return tuple(_named("scenarios.csv", "scenario", kind=kind))


def rover_names() -> tuple[str, ...]:
    """Names that `rover` knows: the rovers with a full design vector."""
    return tuple(_named("rovers.csv", "rover", use="design vector"))


def soil(name: str) -> Soil:
    """A catalogued Soil, one of `soil_names()`."""
    return _read(Soil, _pick("soil", name, _named("soils.csv", "soil")), limits_of(Soil), "soils.csv", name, name=name)


def scenario(name: str) -> Scenario:
    """A catalogued Scenario, one of `scenario_names()`, its panel tilted towards the noon sun."""
    row = _pick("scenario", name, _named("scenarios.csv", "scenario"))
    if row["soil"] not in soil_names():
        raise ValueError(f"scenarios.csv is damaged: row of {name!r}: no soil {row['soil']!r} in soils.csv")
    flat = _read(Scenario, row, _SCENARIO, "scenarios.csv", name, name=name, soil=soil(row["soil"]),
                 problem=problem(name))
    return at_latitude(flat, flat.latitude_deg)


def at_latitude(scenario: Scenario, latitude_deg: float) -> Scenario:
    """A scenario moved to a latitude, its panel tilted by min(80, |latitude|) degrees towards the noon sun."""
    require(scenario=(scenario, Scenario))
    return dataclasses.replace(scenario, latitude_deg=latitude_deg, panel_tilt_deg=min(80.0, abs(latitude_deg)),
                               panel_azimuth_deg=0.0 if latitude_deg < 0 else 180.0)


def problem(name: str) -> Problem:
    """How the paper poses a scenario to the optimiser, from `data/studies.csv`; the defaults where it does not."""
    row = _named("studies.csv", "scenario").get(name)
    if row is None:
        return Problem()
    try:
        return Problem(
            objectives=dict(item.split(":") for item in row["objectives"].split(";")),
            constraints=tuple((field, sign, float(limit)) for field, sign, limit in
                              (item.split(" ") for item in row["constraints"].split(";"))),
            traverse_limit_km=float(row["traverse_limit_km"]) if row["traverse_limit_km"] else None,
            seed=int(row["seed"]))
    except (KeyError, ValueError) as error:
        raise ValueError(f"studies.csv is damaged: row of {name!r}: {error}") from None


def rover(name: str) -> Design:
    """The design of a published rover, one of `rover_names()`; `data/rovers.csv` says what its sources leave open."""
    row = _pick("rover", name, _named("rovers.csv", "rover", use="design vector"))
    return _read(Design, row, tuple(DESIGN_SPACE), "rovers.csv", name)


@functools.cache
def skyline_sites() -> dict[str, dict]:
    """The sites of `skyline`, each with label, latitude_deg, longitude_deg, ground_height_m, map_step_m, heights_m."""
    found = {}
    for row in _rows("skyline_sites.csv", DATA):
        numbers = ("latitude_deg", "longitude_deg", "ground_height_m", "map_step_m")
        site = found.setdefault(row["site"], dict(label=row["label"], **{name: float(row[name]) for name in numbers},
                                                  heights_m=()))
        site["heights_m"] += (float(row["height_m"]),)
    return found


def skyline(site: str, height_m: float = 2) -> Skyline:
    """The skyline of a site near the south pole, seen from a height above its ground.

    Heights are 1, 2 or 10 m: those in between are refused, not interpolated.

    Examples
    --------
    >>> skyline("connecting_ridge_spot_1", 10)
    <Skyline connecting_ridge_spot_1, 10 m: -3.9 to -0.9 deg>
    """
    known = _pick("site", site, skyline_sites())
    if not np.isscalar(height_m) or height_m not in known["heights_m"]:
        heights = ", ".join(f"{height:g}" for height in known["heights_m"])
        raise ValueError(f"height_m of a tabulated skyline must be one of {heights}; got {height_m!r}")
    rows = _rows("skylines.csv", DATA)
    return Skyline([float(row["azimuth_deg"]) for row in rows], [float(row[f"{site}_{height_m:g}m"]) for row in rows],
                   known["latitude_deg"], known["longitude_deg"], float(height_m), f"{site}, {height_m:g} m")


# ---- designs and missions as files ------------------------------------------------------------------------------

def to_json(design: Design, scenario: Scenario | None = None) -> str:
    """JSON text of a design or a flat population and, if given, its (single) mission and how that is posed."""
    require(design=(design, Design), **{} if scenario is None else {"scenario": (scenario, Scenario)})
    if len(design.shape) > 1 or scenario is not None and scenario.shape:
        raise ValueError("to_json keeps one design or a flat population, and a single scenario; got shapes "
                         f"{design.shape} and {scenario and scenario.shape}")
    kept = {"format": "rdk-design-1", "design": plain(design)}
    return json.dumps(kept | ({} if scenario is None else {"scenario": plain(scenario)}), indent=1, allow_nan=False)


def write(text: str, path: str | Path) -> Path:
    """Write a text to a file in one step: readers see the old file or the new one, never half of it."""
    path = Path(path)
    if path.is_dir() or not path.name:
        raise IsADirectoryError(f"path must name a file, such as 'rover.html'; got the folder {str(path)!r}")
    part = path.with_name(f".{path.name[:100]}.{os.urandom(4).hex()}.part")
    try:
        part.write_text(text, encoding="utf-8", newline="\n")
        os.replace(part, path)
    except OSError as error:
        raise type(error)(error.errno, f"cannot write {path.name} there ({error.strerror or error}); give a path in a "
                          "folder that you may write to", str(path.parent)) from None
    finally:
        with contextlib.suppress(OSError):               # gone, unless writing failed half-way
            part.unlink()
    return path


def plain(value):
    """What JSON can hold: infinity as a word, unknown numbers left out."""
    if dataclasses.is_dataclass(value):
        fields = {f.name: getattr(value, f.name) for f in dataclasses.fields(value)}
        return {name: plain(v) for name, v in fields.items() if not (isinstance(v, float) and v != v)}
    if isinstance(value, dict):
        return {name: plain(v) for name, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(v) for v in value]
    if isinstance(value, (np.ndarray, np.generic)):
        return plain(value.tolist())
    return ("Infinity" if value > 0 else "-Infinity") if isinstance(value, float) and math.isinf(value) else value


def from_json(text: str) -> tuple[Design, Scenario | None]:
    """Design and Scenario (or None) from the text of `to_json`.

    ValueError if the text is not such a file, a name stands there twice or is unknown, or a value is not allowed.
    """
    kept = read_json(text)
    if not isinstance(kept, dict) or kept.get("format") != "rdk-design-1" or not isinstance(kept.get("design"), dict):
        raise ValueError("not a design kept by rdk: it needs 'format': 'rdk-design-1' and a 'design'")
    for old, name in _ALIASES.items():
        if old in kept["design"]:
            if name in kept["design"]:
                raise ValueError(f"the file's design has both {old!r} and {name!r}")
            kept["design"][name] = kept["design"].pop(old)
    design = built(Design, kept["design"])
    if len(design.shape) > 1 or 0 in design.shape:
        raise ValueError(f"the file must hold one design or a list of some; got shape {design.shape}")
    if kept.get("scenario") is None:
        return design, None
    try:
        scenario = built(Scenario, kept["scenario"])
    except TypeError as error:
        raise ValueError(f"the file's scenario is damaged: {error!r}") from None
    if scenario.shape:
        raise ValueError("the file's scenario must hold single numbers")
    return design, scenario


def read_json(text: str):
    """What a JSON text holds, with or without a byte-order mark; ValueError where a name stands there twice."""
    def once(pairs):
        for name, _ in pairs:
            if sum(name == other for other, _ in pairs) > 1:
                raise ValueError(f"{name!r} stands there twice")
        return dict(pairs)

    require(text=(text, str))
    try:
        return json.loads(text.lstrip("\ufeff"), object_pairs_hook=once)
    except (ValueError, RecursionError) as error:
        raise ValueError(f"not a JSON file: {error}") from None


def _number(value):
    return float(value) if value in ("Infinity", "-Infinity", "inf") else value


def built(kind, values):
    """A record from a JSON object; unknown fields are refused, and missing ones."""
    where = kind.__name__.lower()
    if not isinstance(values, dict):
        raise ValueError(f"the file's {where} is damaged: it must be an object; got {values!r:.40}")
    known, fields = {f.name: f for f in dataclasses.fields(kind)}, {}
    for name, value in values.items():
        if name not in known:
            raise unknown(f"the file's {where} has an unknown field", name, known)
        if name in _PARTS and value is not None:
            value = built(_PARTS[name], value)
        elif name == "constraints":
            value = [[_number(part) for part in demand] for demand in value]
        elif known[name].metadata.get("infinite"):
            value = _number(value)
        fields[name] = value
    missing = [name for name, f in known.items() if name not in fields
               and f.default is dataclasses.MISSING and f.default_factory is dataclasses.MISSING]
    if missing:
        raise ValueError(f"the file's {where} lacks {', '.join(missing)}")
    return kind(**fields)


def to_csv(design: Design, performance: Record | None = None) -> str:
    """CSV text: one row a lane, the design's variables first, then its performance, perhaps on several missions."""
    require(design=(design, Design), **{} if performance is None else {"performance": (performance, Record)})
    columns = design.numbers() | ({} if performance is None else performance.numbers())
    shape = together(design=design.shape, performance=() if performance is None else performance.shape)
    file = io.StringIO()
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow(name.replace(".", "_") for name in columns)
    writer.writerows(zip(*(np.broadcast_to(v, shape).ravel().tolist() for v in columns.values())))
    return file.getvalue()


def from_csv(text: str) -> Design:
    """Design (a flat population; a single design for one row) from CSV text with the eleven variables as columns.

    Columns are separated by commas, or by semicolons or tabs: then decimal commas are read, too. More columns may
    stand there. ValueError if a column is missing or stands there twice, or a value is not a number or not allowed.
    """
    require(text=(text, str))
    lines = [line for line in io.StringIO(text.lstrip("\ufeff"), newline=None) if line.strip(" ,;\t\n")]
    if lines and re.fullmatch(r'"?sep=."?\s*', lines[0], re.IGNORECASE):
        lines = lines[1:]                                # a spreadsheet's hint
    separator = max(",;\t", key=lines[0].count) if lines else ","
    try:
        rows = [row for row in csv.reader(lines, delimiter=separator, skipinitialspace=True, strict=True)
                if any(cell.strip() for cell in row)]
    except csv.Error as error:
        raise ValueError(f"not a CSV file: {error}") from None
    if len(rows) < 2:
        raise ValueError("the CSV file needs a header and at least one row")
    header = [_ALIASES.get(name.strip(), name.strip()) for name in rows.pop(0)]
    missing = [n for n in DESIGN_SPACE if n not in header]
    if missing:
        hint = f"; is its separator a comma, a semicolon or a tab? It begins {lines[0].strip()[:40]!r}"
        raise ValueError(f"the CSV file lacks the columns {', '.join(missing)}" + hint * (len(header) < 11))
    for name in header:
        if name and header.count(name) > 1:
            raise ValueError(f"the CSV file has the column {name!r} twice")
    for i, row in enumerate(rows, 1):
        if len(row) != len(header):
            raise ValueError(f"row {i} of the CSV file has {len(row)} values, its header {len(header)}"
                             + "; a decimal comma needs another separator of columns, such as a semicolon"
                             * (separator == "," and len(row) > len(header)))
    columns = {name: column for name, column in zip(header, zip(*rows)) if name in DESIGN_SPACE}
    marks = set("".join(cell for column in columns.values() for cell in column)) & set(",.")
    if separator != "," and len(marks) > 1:
        raise ValueError("the CSV file has decimal commas and points: use one decimal separator")
    values = {}
    for name, column in columns.items():
        try:
            values[name] = [_float(cell if separator == "," else cell.replace(",", ".", 1)) for cell in column]
        except ValueError as error:
            hint = "; the decimal separator of this file must be a point" * ("," in str(error))
            raise ValueError(f"{name} must be a number in every row; {error}{hint}") from None
    return Design(**values if len(rows) > 1 else {name: v[0] for name, v in values.items()})
