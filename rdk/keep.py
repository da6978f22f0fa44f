"""Keep designs and fronts in files, and read them back strictly."""
from __future__ import annotations

import csv
import io
import json
from dataclasses import fields

import numpy as np

from .design import DESIGN_SPACE, Design, Scenario
from .terramechanics import Soil

_MISSION = tuple(f.name for f in fields(Scenario) if f.metadata)
_SOIL = tuple(f.name for f in fields(Soil) if f.metadata)


def to_json(design, scenario=None):
    """JSON text of a design (or of the designs of a front) and, if given, its mission.

    Parameters
    ----------
    design : Design
        One, or a flat population.
    scenario : Scenario, optional
        A single one.

    Returns
    -------
    str
    """
    kept = {"format": "rdk-design-1", "design": {n: np.asarray(getattr(design, n)).tolist() for n in DESIGN_SPACE}}
    if scenario is not None:
        kept["scenario"] = {"name": scenario.name, **{n: getattr(scenario, n) for n in _MISSION},
                            "soil": {"name": scenario.soil.name, **{n: getattr(scenario.soil, n) for n in _SOIL}}}
    return json.dumps(kept, indent=1)


def from_json(text):
    """Design and Scenario (or None) from the text of `to_json`.

    Raises
    ------
    ValueError
        If the text is not such a file, or a value is not allowed; the message says which.
    """
    try:
        kept = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise ValueError(f"not a JSON file: {error}") from None
    if not isinstance(kept, dict) or kept.get("format") != "rdk-design-1" or not isinstance(kept.get("design"), dict):
        raise ValueError("not a design kept by rdk: it needs 'format': 'rdk-design-1' and a 'design'")
    design = _design(kept["design"])
    if "scenario" not in kept:
        return design, None
    values = kept["scenario"]
    try:
        soil = Soil(name=str(values["soil"]["name"]), **{n: values["soil"][n] for n in _SOIL})
        scenario = Scenario(name=str(values["name"]), soil=soil, **{n: values[n] for n in _MISSION})
    except (KeyError, TypeError) as error:
        raise ValueError(f"the file's scenario is damaged: {error!r}") from None
    if scenario.shape:
        raise ValueError("the file's scenario must hold single numbers")
    return design, scenario


def to_csv(design, performance=None):
    """CSV text: one row a design, its variables first, then its performance if given."""
    columns = design.numbers() | ({} if performance is None else performance.numbers())
    file = io.StringIO()
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow(name.replace(".", "_") for name in columns)
    writer.writerows(zip(*(np.broadcast_to(v, design.shape or 1).tolist() for v in columns.values())))
    return file.getvalue()


def from_csv(text):
    """Design (a flat population; a single design for one row) from CSV text with the eleven variables as columns.

    Raises
    ------
    ValueError
        If a column is missing or a value is not a number or not allowed; the message says which.
    """
    try:
        rows = list(csv.DictReader(io.StringIO(text), strict=True))
    except csv.Error as error:
        raise ValueError(f"not a CSV file: {error}") from None
    if not rows:
        raise ValueError("the CSV file needs a header and at least one row")
    missing = [n for n in DESIGN_SPACE if n not in rows[0]]
    if missing:
        raise ValueError(f"the CSV file lacks the columns {', '.join(missing)}")
    values = {}
    for name in DESIGN_SPACE:
        try:
            values[name] = [float(row[name]) for row in rows]
        except (TypeError, ValueError):
            raise ValueError(f"{name} must be a number in every row") from None
    return _design(values if len(rows) > 1 else {name: v[0] for name, v in values.items()})


def _design(values):
    missing = [n for n in DESIGN_SPACE if n not in values]
    if missing:
        raise ValueError(f"the file's design lacks {', '.join(missing)}")
    design = Design(**{n: np.array(values[n]) if isinstance(values[n], list) else values[n] for n in DESIGN_SPACE})
    if len(design.shape) > 1 or 0 in design.shape:
        raise ValueError(f"the file must hold one design or a list of some; got shape {design.shape}")
    return design
