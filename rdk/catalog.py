"""The collection's data: soils, scenarios, rovers and measurements from `data/`, read strictly.

`data/README.md` is the dictionary of every column; each row names its source.
"""
from __future__ import annotations

import csv
import dataclasses
import functools
from pathlib import Path

from ._fields import unknown
from .design import Design, Scenario, Problem
from .sky import Skyline
from .terramechanics import Soil

DATA = Path(__file__).resolve().parent.parent / "data"
_SOIL = ("sinkage_exponent", "cohesive_modulus_kn_m_n1", "frictional_modulus_kn_m_n2", "cohesion_kpa",
         "friction_angle_deg", "shear_modulus_mm")
_SCENARIO = ("latitude_deg", "duration_earth_days", "slope_deg", "duty_cycle", "traverse_limit_km", "payload_mass_kg",
             "payload_power_w")
_DESIGN = ("wheel_radius_m", "wheel_width_m", "grouser_height_m", "grouser_count", "wheel_count", "chassis_mass_kg",
           "wheelbase_m", "solar_area_m2", "battery_capacity_wh", "avionics_power_w", "peak_wheel_torque_nm")
_KEYS = {"soils.csv": ("soil",), "scenarios.csv": ("scenario", "kind", "soil"),
         "rovers.csv": ("rover", "use"), "studies.csv": ("scenario",)}


@functools.cache
def _rows(file_name, folder):
    path = folder / file_name
    try:
        with open(path, encoding="utf-8", newline="") as file:
            lines = list(csv.reader(file, strict=True))
    except FileNotFoundError:
        raise FileNotFoundError(f"{file_name} is missing from {folder}; the data folder comes with the repository: "
                                "install from a clone with 'pip install -e .'") from None
    except (UnicodeDecodeError, csv.Error) as error:
        raise ValueError(f"{file_name} is damaged: {error}") from None
    if len(lines) < 2:
        raise ValueError(f"{file_name} is damaged: it needs a header and at least one row, has {len(lines)} lines")
    for key in _KEYS.get(file_name, ()):
        if key not in lines[0]:
            first = ",".join(lines[0])[:60]
            raise ValueError(f"{file_name} is damaged: no column {key!r}; its first line is {first!r}")
    for i, line in enumerate(lines[1:], 2):
        if len(line) != len(lines[0]):
            raise ValueError(f"{file_name} is damaged: line {i} has {len(line)} values, the header {len(lines[0])}")
    return tuple(dict(zip(lines[0], line)) for line in lines[1:])


def rows(file_name):
    """The rows of a file in `data/`, as dictionaries of strings.

    Raises
    ------
    FileNotFoundError, ValueError
        If the file is missing or damaged; the message names it.
    """
    return [dict(row) for row in _rows(file_name, DATA)]


def table(file_name):
    """A file in `data/` as a pandas DataFrame, numbers and booleans converted."""
    import pandas as pd
    rows(file_name)                                      # its errors are clearer than pandas'
    return pd.read_csv(DATA / file_name, keep_default_na=False, na_values=[""])


def _read(kind, row, names, file_name, label, **more):
    """A `kind` (Soil, Scenario or Design) from the named numbers of a row; errors name file and row."""
    values = {}
    for name in names:
        try:
            values[name] = float(row[name])
        except KeyError:
            raise ValueError(f"{file_name} is damaged: no column {name!r}") from None
        except ValueError:
            raise ValueError(f"{file_name} is damaged: {name} of {label!r} is {row[name]!r}, not a number") from None
    try:
        return kind(**values, **more)
    except ValueError as error:
        raise ValueError(f"{file_name} is damaged: row of {label!r}: {error}") from None


def _pick(file_name, kind, key, name):
    found = {row[key]: row for row in _rows(file_name, DATA)}
    if name not in found:
        raise ValueError(f"no {kind} {name!r}; choose from {', '.join(found)}")
    return found[name]


def _names(file_name, key):
    return tuple(dict.fromkeys(row[key] for row in _rows(file_name, DATA)))


def soil_names():
    """Names that `soil` knows."""
    return _names("soils.csv", "soil")


def scenario_names(kind=None):
    """Names that `scenario` knows; `kind` is "canonical", "class-generic" or "rover mission"."""
    kinds = _names("scenarios.csv", "kind")
    if kind is not None and kind not in kinds:
        raise ValueError(f"no kind {kind!r} of scenario; choose from {', '.join(kinds)}")
    return tuple(row["scenario"] for row in _rows("scenarios.csv", DATA) if kind in (None, row["kind"]))


def rover_names():
    """Names that `rover` knows: the rovers with a full design vector."""
    return tuple(row["rover"] for row in _rows("rovers.csv", DATA) if row["use"] == "design vector")


def soil(name):
    """A catalogued Soil.

    Parameters
    ----------
    name : str
        One of `soil_names()`.

    Raises
    ------
    ValueError
        If there is no such soil; the message lists them.

    Examples
    --------
    >>> soil("apollo-loose").friction_angle_deg
    30.0
    """
    return _read(Soil, _pick("soils.csv", "soil", "soil", name), _SOIL, "soils.csv", name, name=name)


def scenario(name):
    """A catalogued Scenario, its panel tilted by min(80, |latitude|) degrees towards the noon sun.

    Parameters
    ----------
    name : str
        One of `scenario_names()`.

    Raises
    ------
    ValueError
        If there is no such scenario; the message lists them.

    Examples
    --------
    >>> scenario("polar_prospecting").panel_tilt_deg
    80.0
    """
    row = _pick("scenarios.csv", "scenario", "scenario", name)
    if row["soil"] not in soil_names():
        raise ValueError(f"scenarios.csv is damaged: row of {name!r}: no soil {row['soil']!r} in soils.csv")
    flat = _read(Scenario, row, _SCENARIO, "scenarios.csv", name, name=name, soil=soil(row["soil"]),
                 problem=problem(name))
    return dataclasses.replace(flat, panel_tilt_deg=min(80.0, abs(flat.latitude_deg)),
                               panel_azimuth_deg=0.0 if flat.latitude_deg < 0 else 180.0)


def problem(name):
    """How the paper poses a scenario to the optimiser, from `data/studies.csv`; the defaults where it does not."""
    for row in _rows("studies.csv", DATA):
        if row["scenario"] == name:
            break
    else:
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


def rover(name):
    """The design of a published rover; fields that its sources leave open are imputed (see `data/rovers.csv`).

    Parameters
    ----------
    name : str
        One of `rover_names()`.

    Raises
    ------
    ValueError
        If there is no such rover; the message lists them.

    Examples
    --------
    >>> rover("Rashid-1").wheel_radius_m
    0.1
    """
    return _read(Design, rover_row(name), _DESIGN, "rovers.csv", name)


def rover_row(name):
    """The full row of a published rover's design vector: published mass, payload, sources."""
    vectors = {row["rover"]: row for row in _rows("rovers.csv", DATA) if row["use"] == "design vector"}
    if name not in vectors:
        raise ValueError(f"no rover {name!r}; choose from {', '.join(vectors)}")
    return dict(vectors[name])


@functools.cache
def skyline_sites():
    """The sites that `skyline` knows, with what is known of each.

    Returns
    -------
    dict of str to dict
        Site -> label, latitude_deg, longitude_deg, ground_height_m, map_step_m, heights_m (above ground).
    """
    found = {}
    for row in _rows("skyline_sites.csv", DATA):
        numbers = ("latitude_deg", "longitude_deg", "ground_height_m", "map_step_m")
        site = found.setdefault(row["site"], dict(label=row["label"], **{name: float(row[name]) for name in numbers},
                                                  heights_m=()))
        site["heights_m"] += (float(row["height_m"]),)
    return found


def skyline(site, height_m=2):
    """The skyline of a site near the south pole, seen from a height above its ground.

    Parameters
    ----------
    site : str
        One of `skyline_sites()`.
    height_m : float
        1, 2 or 10: heights in between are refused, not interpolated.

    Examples
    --------
    >>> skyline("connecting_ridge_spot_1", 10)
    <Skyline connecting_ridge_spot_1, 10 m: -3.9 to -0.9 deg>
    """
    sites = skyline_sites()
    if site not in sites:
        raise unknown("no site", site, sites)
    if isinstance(height_m, str) or height_m not in sites[site]["heights_m"]:
        heights = ", ".join(f"{height:g}" for height in sites[site]["heights_m"])
        raise ValueError(f"height_m of a tabulated skyline must be one of {heights}; got {height_m!r}")
    rows = _rows("skylines.csv", DATA)
    return Skyline([float(row["azimuth_deg"]) for row in rows], [float(row[f"{site}_{height_m:g}m"]) for row in rows],
                   sites[site]["latitude_deg"], sites[site]["longitude_deg"], float(height_m),
                   f"{site}, {height_m:g} m")
