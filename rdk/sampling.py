"""Chosen points of the trade space: random designs, sweeps, Monte-Carlo intervals and Shapley attribution.

Each study is one call of `evaluate` on a population built for it.
"""
from __future__ import annotations

import dataclasses
import math

import numpy as np

from . import catalog
from ._fields import Shown, check, unknown
from .design import DESIGN_SPACE, Design, Model, Scenario
from .mission import Performance, evaluate
from .terramechanics import Soil

_NORMAL_95 = 1.6448536269514722                          # 95 % point of the standard normal
METRICS = tuple(f.name for f in dataclasses.fields(Performance) if f.name not in ("mass", "log"))
"""The Performance fields that a study can use as objective, constraint or read-out."""
READINGS = ("range_km", "total_mass_kg", "slope_capability_deg", "slip", "energy_balance_pct")   # of a short table


def demands(wanted, argument: str = "constraints") -> tuple:
    """Demands like ("range_km", ">=", 30), checked: fields of Performance, limits that do not contradict each other."""
    if not isinstance(wanted, (list, tuple)) or not all(isinstance(c, (list, tuple)) for c in wanted):
        raise ValueError(f"{argument} must be a list of (field, '>=' or '<=', limit); got {wanted!r}")
    limits = {}
    for demand in wanted:
        if len(demand) != 3 or demand[1] not in (">=", "<="):
            raise ValueError(f"{argument} must be like ('range_km', '>=', 0.1); got {demand!r}")
        name, sign, limit = demand
        if name not in METRICS:
            raise unknown(f"{argument}: no Performance field", name, METRICS)
        both = limits.setdefault(name, {">=": -math.inf, "<=": math.inf})
        limit = check(f"{argument}: limit of {name}", limit, scalar=True)
        both[sign] = max(both[sign], limit) if sign == ">=" else min(both[sign], limit)
    for name, both in limits.items():
        if both[">="] > both["<="]:
            raise ValueError(f"{argument} contradict each other: {name} >= {both['>=']:g} and <= {both['<=']:g}")
    return tuple(tuple(demand) for demand in wanted)


# ---- designs and genes ----------------------------------------------------------------------------------------

def random_designs(count: int, seed: int | None = None, bounds: dict | None = None) -> Design:
    """Designs drawn uniformly from the design space; grouser counts whole, 4 or 6 wheels with equal chance.

    Parameters
    ----------
    count : int
        How many, 1 or more.
    seed : int, optional
        Same seed, same designs.
    bounds : dict of str to (float, float), optional
        Narrower or wider limits of some variables, in place of those in DESIGN_SPACE.

    Returns
    -------
    Design
        Arrays of length `count`.

    Raises
    ------
    ValueError
        If `count` is not a whole number of 1 or more, or a bound is not sensible.

    Examples
    --------
    >>> random_designs(3, seed=1).shape
    (3,)
    """
    count = int(check("count", count, 1, whole=True, scalar=True))
    return decode(np.random.default_rng(seed).random((count, len(DESIGN_SPACE))), bounds)


def _limits(bounds):
    """Lower and upper limits of the eleven variables."""
    limits = {name: (v.low, v.high) for name, v in DESIGN_SPACE.items()}
    if bounds is not None and not isinstance(bounds, dict):
        raise ValueError(f"bounds must be a dictionary of variables with pairs (low, high); got {bounds!r}")
    rules = {f.name: f.metadata for f in dataclasses.fields(Design)}
    for name, pair in (bounds or {}).items():
        if name not in limits:
            raise unknown("bounds: no design variable", name, list(limits))
        if np.shape(pair) != (2,):
            raise ValueError(f"bounds of {name} must be a pair (low, high); got {pair!r}")
        low, high = (check(f"bounds of {name}", x, **rules[name]) for x in pair)
        if low > high:
            raise ValueError(f"bounds of {name} must rise; got {pair!r}")
        limits[name] = low, high
    return np.array(list(limits.values()), float).T


def decode(genes: np.ndarray, bounds: dict | None = None) -> Design:
    """Designs from genes in the unit cube, shape (n, 11): scaled, grouser count rounded, wheel count thresholded.

    Every design that the optimiser sees can be built: 4 or 6 wheels, a whole number of grousers.
    """
    low, high = _limits(bounds)
    values = {}
    for (name, variable), gene, a, b in zip(DESIGN_SPACE.items(), np.asarray(genes, float).T, low, high):
        if variable.kind == "choice":
            values[name] = np.where(a + gene * (b - a) < (variable.low + variable.high) / 2, variable.low, variable.high)
        else:
            value = np.clip(a + gene * (b - a), a, b)
            values[name] = np.rint(value) if variable.kind == "whole" else value
    return Design(**values)


def encode(designs: Design, bounds: dict | None = None) -> np.ndarray:
    """Genes of designs, shape (n, 11), clipped to the unit cube; the inverse of `decode` up to rounding."""
    low, high = _limits(bounds)
    columns = np.broadcast_arrays(*(np.atleast_1d(getattr(designs, name)) for name in DESIGN_SPACE))
    genes = (np.stack(columns, axis=1) - low) / np.where(high > low, high - low, 1)
    return np.clip(genes, 0, 1)


# ---- sweeps ---------------------------------------------------------------------------------------------------

@dataclasses.dataclass(frozen=True, eq=False, repr=False)
class Sweep(Shown):
    """A sweep over one or two fields.

    Attributes
    ----------
    fields : tuple of str
    values : tuple of ndarray
    performance : Performance
        Shape (n,) or (n, m): the first field runs down, the second across.
    """
    fields: tuple
    values: tuple
    performance: Performance

    def to_frame(self):
        """A pandas DataFrame: one row a point, the swept fields first."""
        grids = np.meshgrid(*self.values, indexing="ij")
        frame = self.performance.to_frame()
        for i, (name, grid) in enumerate(zip(self.fields, grids)):
            frame.insert(i, name, grid.ravel(), allow_duplicates=True)
        return frame

    def _summary(self):
        frame = self.to_frame()
        shown = [*range(len(self.fields)), *map(list(frame.columns).index, READINGS)]
        return f"Sweep of {len(frame)} points over {' and '.join(self.fields)}", frame.iloc[:, shown]


def _single(**records):
    """Refuse records that hold arrays."""
    for name, record in records.items():
        if record.shape:
            raise ValueError(f"{name} must be a single one; got arrays of shape {record.shape}")


def replaced(design: Design, scenario: Scenario, model: Model, changes: dict) -> tuple[Design, Scenario, Model]:
    """Design, scenario and model with fields changed, each found by its name in Design, Scenario, Soil or Model."""
    groups = {Design: {}, Scenario: {}, Soil: {}, Model: {}}
    names = {kind: {f.name for f in dataclasses.fields(kind) if f.metadata} for kind in groups}
    for name, value in changes.items():
        kind = next((kind for kind, known in names.items() if name in known), None)
        if kind is None:
            raise unknown("Design, Scenario, Soil and Model have no field", name, sorted(set().union(*names.values())))
        groups[kind][name] = value
    soil = dataclasses.replace(scenario.soil, **groups[Soil])
    return (dataclasses.replace(design, **groups[Design]), dataclasses.replace(scenario, soil=soil, **groups[Scenario]),
            dataclasses.replace(model, **groups[Model]))


def sweep(design: Design, scenario: Scenario, over: dict, *, model: Model = Model()) -> Sweep:
    """Performance along one field or over a grid of two, in one evaluation.

    Parameters
    ----------
    design : Design
        A single design.
    scenario : Scenario
        A single mission.
    over : dict of str to array_like
        One or two fields of Design, Scenario, Soil or Model with their values; the mission duration and names cannot
        be swept, since they set the time steps.
    model : Model
        A single one.

    Returns
    -------
    Sweep

    Raises
    ------
    ValueError
        If a field is unknown, its values are not one-dimensional, their number is not one or two, or design, scenario
        or model holds arrays.

    Examples
    --------
    >>> import rdk
    >>> mare = rdk.scenario("equatorial_mare_traverse")
    >>> s = sweep(rdk.rover("Rashid-1"), mare, {"slope_deg": [0, 10, 20]})
    >>> s.performance.slip.round(2)
    array([0.09, 0.26, 0.5 ])
    """
    _single(design=design, scenario=scenario, model=model)
    if not isinstance(over, dict) or not 1 <= len(over) <= 2:
        raise ValueError(f"over must be a dictionary of one or two fields with their values; got {over!r}")
    if "duration_earth_days" in over:
        raise ValueError("over: duration_earth_days sets the number of time steps and cannot be an array; evaluate "
                         "one scenario a duration")
    values = tuple(np.asarray(v) for v in over.values())
    for name, v in zip(over, values):
        if v.ndim != 1 or not v.size:
            raise ValueError(f"over: {name} needs a one-dimensional list of values; got shape {v.shape}")
    axes = (values[0],) if len(values) == 1 else (values[0][:, None], values[1][None, :])
    *swept, model = replaced(design, scenario, model, dict(zip(over, axes)))
    return Sweep(tuple(over), values, evaluate(*swept, model=model))


# ---- uncertainty ----------------------------------------------------------------------------------------------

@dataclasses.dataclass(frozen=True)
class Intervals:
    """Monte-Carlo intervals of every metric.

    Attributes
    ----------
    level : float
        Probability between `low` and `high`.
    nominal, low, median, high : dict of str to float or ndarray
        By metric, with the shape of the design; true/false metrics as the share of draws in which they hold.
    draws : Performance
        All draws, shape (draws, ...).
    """
    level: float
    nominal: dict
    low: dict
    median: dict
    high: dict
    draws: Performance = dataclasses.field(repr=False)

    def to_frame(self):
        """A pandas DataFrame: one row a metric (one design only)."""
        import pandas as pd
        return pd.DataFrame({"nominal": self.nominal, "low": self.low, "median": self.median, "high": self.high})


def uncertain_inputs(scenario, draws=500, seed=0, model=Model(), table=None):
    """Random soils and model coefficients from the table of uncertainties.

    Parameters
    ----------
    scenario : Scenario
        Its soil is perturbed.
    draws : int
    seed : int
    model : Model
        Its coefficients are perturbed.
    table : list of dict, optional
        Rows like those of `data/uncertainties.csv`: field name; kind, "factor" (times the nominal value) or "offset"
        (added to it); distribution, "normal" with `low` and `high` its 5 % and 95 % points, or "uniform" between them;
        `minimum` and `maximum`, where a normal's tail is cut to stay physical.

    Returns
    -------
    dict of str to ndarray
        Field names of Soil and Model with `draws` values each, to pass to `replaced`.

    Raises
    ------
    ValueError
        If `draws` is not a whole number of 1 or more, or a row of the table names what does not exist.
    """
    draws = int(check("draws", draws, 1, whole=True, scalar=True))
    random = np.random.default_rng(seed)
    changes = {}
    for row in catalog.rows("uncertainties.csv") if table is None else table:
        name = row["name"]
        if row["kind"] not in ("factor", "offset") or row["distribution"] not in ("normal", "uniform"):
            raise ValueError(f"table: {name} must be a factor or offset, normal or uniform; got {row['kind']!r}, "
                             f"{row['distribution']!r}")
        if name not in scenario.soil.numbers() and name not in model.numbers():
            raise ValueError(f"table: no field {name!r} in Soil or Model")
        changes[row["name"]] = perturbed(row, scenario, model, drawn(row, draws, random))
    return changes


def drawn(row, draws, random):
    """Raw draws of one row of the table: factors, or offsets in the unit of the field."""
    low, high = float(row["low"]), float(row["high"])
    if row["distribution"] == "uniform":
        return random.uniform(low, high, draws)
    return (low + high) / 2 + (high - low) / 2 / _NORMAL_95 * random.standard_normal(draws)


def perturbed(row, scenario, model, drawn):
    """Values of the uncertain field that a row of the table names, from raw draws: applied to the nominal, then cut."""
    nominal = {**model.numbers(), **scenario.soil.numbers()}[row["name"]]
    value = nominal * drawn if row["kind"] == "factor" else nominal + drawn
    return np.clip(value, float(row["minimum"] or -math.inf), float(row["maximum"] or math.inf))


def intervals(design, scenario, draws=500, seed=0, level=0.9, model=Model(), table=None):
    """Intervals of every metric by Monte-Carlo through the physics: soil, shear scale, mass and power coefficients.

    Parameters
    ----------
    design : Design
        One design or a population of shape (n,).
    scenario : Scenario
        A single mission.
    draws : int
        Samples, 1 or more.
    seed : int
        Same seed, same bits; every design sees the same draws.
    level : float
        Probability inside the interval, between 0 and 1.
    model : Model
        Nominal coefficients.
    table : list of dict, optional
        In place of `data/uncertainties.csv`; see `uncertain_inputs`.

    Returns
    -------
    Intervals

    Notes
    -----
    The draws are independent and cover the inputs only, not what the models leave out. Metrics that are NaN in a draw
    (a buried wheel) are left out of its percentiles.

    Examples
    --------
    >>> import rdk
    >>> found = intervals(rdk.rover("Rashid-1"), rdk.scenario("equatorial_mare_traverse"))
    >>> bool(found.low["total_mass_kg"] < found.nominal["total_mass_kg"] < found.high["total_mass_kg"])
    True
    """
    level = check("level", level, above=0, below=1, scalar=True)
    if scenario.shape or model.shape or len(design.shape) > 1:
        raise ValueError("intervals takes one design or a flat population, a single scenario and a single model; got "
                         f"shapes {design.shape}, {scenario.shape} and {model.shape}")
    changes = uncertain_inputs(scenario, draws, seed, model, table)
    if not changes:
        raise ValueError("table must hold at least one row; got none")
    across = {name: value.reshape(-1, *(1 for _ in design.shape)) for name, value in changes.items()}
    *drawn_records, drawn_model = replaced(design, scenario, model, across)
    cloud, nominal = evaluate(*drawn_records, model=drawn_model), evaluate(design, scenario, model=model)
    tail = (1 - level) / 2
    low, median, high = {}, {}, {}
    for name in METRICS:
        values = getattr(cloud, name)
        if values.dtype == bool:
            low[name] = median[name] = high[name] = values.mean(0)[()]
        elif np.isnan(values).all():
            low[name] = median[name] = high[name] = np.full(design.shape, np.nan)[()]
        else:
            quantile = np.nanquantile if np.isnan(values).any() else np.quantile
            # no interpolation between infinities: a speed without a limit, downhill
            method = "closest_observation" if np.isinf(values).any() else "linear"
            low[name], median[name], high[name] = quantile(values, [tail, 0.5, 1 - tail], axis=0, method=method)
    return Intervals(level, {name: getattr(nominal, name) for name in METRICS}, low, median, high, cloud)


# ---- attribution ----------------------------------------------------------------------------------------------

@dataclasses.dataclass(frozen=True, eq=False, repr=False)
class Attribution(Shown):
    """Shapley values: what each design variable contributes to the difference of two designs.

    Attributes
    ----------
    contributions : dict of str to ndarray
        By metric, one value a design variable in the order of DESIGN_SPACE; they add up to
        `performance - baseline_performance`.
    performance, baseline_performance : Performance
    """
    contributions: dict
    performance: Performance
    baseline_performance: Performance

    def to_frame(self):
        """A pandas DataFrame: one row a design variable, one column a metric."""
        import pandas as pd
        return pd.DataFrame(self.contributions, index=list(DESIGN_SPACE))

    def _summary(self):
        frame = self.to_frame()
        return "Attribution: what each variable adds to the baseline", frame[[n for n in READINGS if n in frame]]


def attribution(design: Design, baseline: Design, scenario: Scenario, *, model: Model = Model()) -> Attribution:
    """Exact Shapley values of each metric's difference between two designs, over the eleven design variables.

    Every mixture of the two designs is evaluated, 2^k of them in one call where k variables differ, and each variable is
    credited with its mean marginal effect over all orders in which the variables could change (Shapley 1953). A variable
    with one value in both designs has no effect and no share.

    Parameters
    ----------
    design, baseline : Design
        Single designs.
    scenario : Scenario
        A single mission.
    model : Model

    Returns
    -------
    Attribution
        For every metric that is a number in all mixtures; true/false metrics count as 1 and 0.

    Raises
    ------
    ValueError
        If an input holds arrays.

    Examples
    --------
    >>> import rdk
    >>> why = attribution(rdk.rover("Rashid-1"), rdk.rover("Tenacious"), rdk.scenario("equatorial_mare_traverse"))
    >>> difference = why.performance.total_mass_kg - why.baseline_performance.total_mass_kg
    >>> bool(np.isclose(why.contributions["total_mass_kg"].sum(), difference))
    True
    """
    _single(design=design, baseline=baseline, scenario=scenario, model=model)
    differ = np.array([getattr(design, name) != getattr(baseline, name) for name in DESIGN_SPACE])
    count = int(differ.sum())
    takes = np.zeros((2**count, len(differ)), bool)                  # (mixtures, variables): from the design?
    takes[:, differ] = np.arange(2**count)[:, None] >> np.arange(count) & 1
    result = evaluate(Design(**{name: np.where(takes[:, i], getattr(design, name), getattr(baseline, name))
                                for i, name in enumerate(DESIGN_SPACE)}), scenario, model=model)
    size = takes.sum(1)
    share = np.array([math.factorial(k) * math.factorial(count - 1 - k) / math.factorial(count) for k in range(count)])
    # phi_i = sum over mixtures without i of share(size) * (with i - without i), as one matrix
    weights = np.zeros(takes.T.shape)
    if count:
        weights[differ] = np.where(takes.T[differ], share[size - 1], -share[np.minimum(size, count - 1)])
    contributions = {}
    for name in METRICS:
        values = np.asarray(getattr(result, name), float)
        if np.isfinite(values).all():
            contributions[name] = weights @ values
    return Attribution(contributions, result[-1], result[0])
