"""What is not known: random soils and model coefficients from the table of uncertainties, `data/uncertainties.csv`."""
from __future__ import annotations

import math

import numpy as np

from . import catalog
from ._fields import check, generator, unknown, whole
from .design import Model, Scenario, single

DRAWS = 1024
"""Draws of an interval by default: the share beyond its ends then hardly depends on the seed."""


def uncertain_inputs(scenario: Scenario, *, draws: int = DRAWS, seed: int = 0, model: Model = Model(),
                     table: list | None = None) -> dict[str, np.ndarray]:
    """Random soils and model coefficients around a scenario's and a model's, by field name; to pass to `replaced`.

    The first `draws` points of a scrambled Sobol sequence, its columns shuffled among the inputs, through `inputs_at`.
    """
    from scipy.stats import qmc
    draws = whole("draws", draws, 1)
    random = generator(seed)
    names = uncertain_names(table)
    points = qmc.Sobol(max(len(names), 1), rng=random).random_base2(math.ceil(math.log2(draws)))[:draws]
    # the sequence's late columns are its worst: shuffled, no input always has them
    return inputs_at(points[:, random.permutation(points.shape[1])], scenario, model=model, table=table)


def uncertain_names(table: list | None = None) -> list[str]:
    """The inputs that a table of uncertainties names, in order."""
    table = catalog.rows("uncertainties.csv") if table is None else table
    if not isinstance(table, (list, tuple)) or not all(isinstance(row, dict) and "name" in row for row in table):
        raise ValueError(f"table must be a list of rows, each a dictionary with a name; got {table!r:.80}")
    return list(dict.fromkeys(row["name"] for row in table))


def inputs_at(points: np.ndarray, scenario: Scenario, *, model: Model = Model(), table: list | None = None) -> dict:
    """Uncertain inputs at points of the unit cube, each coordinate taken through the distribution of one input.

    The points have shape (n, k), one column for each of `uncertain_names(table)`. A table has rows like those of
    `data/uncertainties.csv`: `data/README.md` says what each of its columns does.
    """
    single(scenario=scenario, model=model)
    nominal, changes, names = {**model.numbers(), **scenario.soil.numbers()}, {}, uncertain_names(table)
    table = catalog.rows("uncertainties.csv") if table is None else table
    if np.shape(points)[1:] != (len(names),) and names:
        raise ValueError(f"points must have one column for each of {', '.join(names)}; got shape {np.shape(points)}")
    for name, u in zip(names, np.asarray(points, float).T):
        if name not in nominal:
            raise unknown("table: Soil and Model have no field", name, list(nominal))
        rows = [row for row in table if row["name"] == name and _counts(row, nominal[name], model)]
        weight = check(f"table: weight of {name}", [_entry(row, "weight", 1.0) for row in rows], above=0)
        edges = np.cumsum(weight) / weight.sum() if rows else weight
        which, value = np.searchsorted(edges[:-1], u, side="right"), np.full(len(u), float(nominal[name]))
        for i, row in enumerate(rows):
            own = which == i
            value[own] = _quantile(row, (u[own] - edges[i]) * weight.sum() / weight[i] + 1, nominal[name])
        changes[name] = value
    return changes


def _counts(row, nominal, model):
    """Whether a row's condition holds."""
    what, _, limit = (row.get("when") or "").partition("=")
    if what not in ("", "from", "below", "kernel"):
        raise ValueError(f"table: when of {row['name']} must be empty or from=, below= or kernel=; got {row['when']!r}")
    return (not what or what == "from" and nominal >= float(limit) or what == "below" and nominal < float(limit)
            or what == "kernel" and model.kernel == limit)


def _quantile(row, u, nominal):
    """Values of a row at the shares u of its distribution."""
    from scipy.special import ndtri
    kind, shape = row["kind"], row["distribution"]
    if kind not in ("factor", "offset", "value") or shape not in ("normal", "lognormal", "uniform"):
        raise ValueError(f"table: {row['name']} must be a factor, offset or value, normal, lognormal or uniform; got "
                         f"{kind!r}, {shape!r}")
    ends = np.array([_entry(row, "low"), _entry(row, "high")])
    if not ends[0] <= ends[1]:
        raise ValueError(f"table: low of {row['name']} must be at most high; got {row['low']!r} and {row['high']!r}")
    if shape == "lognormal":
        check(f"table: low and high of {row['name']}", ends, above=0)
        ends = np.log(ends)
    u = np.clip(u, 2.0**-32, 1 - 2.0**-32)               # a scrambled sequence can hold 0
    drawn = ends[0] + np.diff(ends) * (u if shape == "uniform" else 0.5 + ndtri(u) / ndtri(0.95) / 2)
    drawn = np.exp(drawn) if shape == "lognormal" else drawn
    value = {"factor": nominal * drawn, "offset": nominal + drawn, "value": drawn}[kind]
    return np.clip(value, _entry(row, "minimum", -math.inf), _entry(row, "maximum", math.inf))


def _entry(row, key, default=None):
    """A number of a row; the default where it has none."""
    value = row.get(key)
    try:
        return float(default if value in (None, "") else value)
    except (TypeError, ValueError):
        raise ValueError(f"table: {key} of {row['name']} must be a number; got {value!r}") from None
