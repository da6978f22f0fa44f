"""Chosen points of the trade space: random designs, sweeps, Monte-Carlo intervals and Shapley attribution."""
from __future__ import annotations

import dataclasses
import itertools
import math
from collections.abc import Mapping, Sequence

import numpy as np

from ._fields import Shown, check, generator, in_rows, limits_of, require, unknown, whole
from .design import DESIGN_SPACE, Demand, Design, Model, Scenario, single
from .mission import Performance, evaluate
from .terramechanics import Soil
from .uncertainty import DRAWS, uncertain_inputs

METRICS = tuple(f.name for f in dataclasses.fields(Performance) if f.name not in ("mass", "log"))
"""The Performance fields that a study can use as objective, constraint or read-out."""
READINGS = ("range_km", "total_mass_kg", "slope_capability_deg", "slip", "energy_balance_pct")   # of a short table


def demands(wanted, argument: str = "constraints", scenario: Scenario | None = None,
            may_contradict: bool = False) -> tuple[Demand, ...]:
    """Demands from triples like ("range_km", ">=", 30), checked; an obstacle that the scenario has is one more."""
    found = Demand.all(wanted, argument)
    for name, *_ in found:
        if name not in METRICS:
            raise unknown(f"{argument}: no Performance field", name, METRICS)
    for least, most in itertools.product([] if may_contradict else found, repeat=2):
        if (least.field, least.sign, most.sign) == (most.field, ">=", "<=") and least.limit > most.limit:
            raise ValueError(f"{argument} contradict each other: {least} and <= {most.limit:g}")
    if scenario is not None and scenario.required_obstacle_height_m > 0:
        found += (Demand("obstacle_capability_m", ">=", scenario.required_obstacle_height_m),)
    return found


def holds(performance: Performance, demand: tuple) -> bool | np.ndarray:
    """Whether a demand such as ("range_km", ">=", 30) holds; not where the field is NaN."""
    name, sign, limit = demand
    value = np.asarray(getattr(performance, name), float)
    return value >= limit if sign == ">=" else value <= limit


# ---- designs and genes ----------------------------------------------------------------------------------------

def random_designs(count: int, seed: int | None = None, bounds: dict | None = None) -> Design:
    """Designs drawn uniformly from the design space; grouser counts whole, 4 or 6 wheels with equal chance.

    `bounds` has limits (low, high) of some variables in place of those in DESIGN_SPACE; same seed, same designs.
    """
    count = whole("count", count, 1)
    return decode(generator(seed).random((count, len(DESIGN_SPACE))), bounds)


def _limits(bounds):
    """Lower and upper limits of the eleven variables."""
    limits = {name: (v.low, v.high) for name, v in DESIGN_SPACE.items()}
    if bounds is not None and not isinstance(bounds, dict):
        raise ValueError(f"bounds must be a dictionary of variables with pairs (low, high); got {bounds!r}")
    for name, pair in (bounds or {}).items():
        if name not in limits:
            raise unknown("bounds: no design variable", name, list(limits))
        if np.shape(pair) != (2,):
            raise ValueError(f"bounds of {name} must be a pair (low, high); got {pair!r}")
        low, high = (check(f"bounds of {name}", x, **limits_of(Design)[name]) for x in pair)
        if low > high:
            raise ValueError(f"bounds of {name} must rise; got {pair!r}")
        limits[name] = low, high
    return np.array(list(limits.values()), float).T


def decode(genes: np.ndarray, bounds: dict | None = None) -> Design:
    """Designs from genes in the unit cube, shape (n, 11): scaled, grouser count rounded, wheel count thresholded."""
    genes, values = check("genes", genes), {}
    for (name, variable), gene, a, b in zip(DESIGN_SPACE.items(), genes.T, *_limits(bounds)):
        value = np.clip(a + gene * (b - a), a, b)
        if variable.kind == "choice":
            value = np.where(value < (variable.low + variable.high) / 2, variable.low, variable.high)
        values[name] = value if variable.kind == "continuous" else np.rint(value).astype(int)
    return Design.trusted(genes.shape[:-1], values)


def encode(designs: Design, bounds: dict | None = None) -> np.ndarray:
    """Genes of designs, shape (n, 11), clipped to the unit cube; the inverse of `decode` up to rounding."""
    low, high = _limits(bounds)
    columns = in_rows([getattr(designs, name) for name in DESIGN_SPACE], designs.shape).T
    return np.clip((columns - low) / np.where(high > low, high - low, 1), 0, 1)


def light_corner(genes: np.ndarray) -> None:
    """Move genes, shape (..., 11), in place to where light designs lie: some at their least, others mostly little."""
    names = list(DESIGN_SPACE)
    least = "wheel_width_m", "avionics_power_w", "wheel_count"
    little = "chassis_mass_kg", "solar_area_m2", "battery_capacity_wh", "peak_wheel_torque_nm"
    genes[..., [names.index(name) for name in least]] = 0
    genes[..., [names.index(name) for name in little]] **= 3


# ---- sweeps ---------------------------------------------------------------------------------------------------

@dataclasses.dataclass(frozen=True, eq=False, repr=False)
class Sweep(Shown):
    """A sweep over one or two fields: shape (n,) or (n, m), the first field runs down, the second across."""
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


def replaced(design: Design, scenario: Scenario, model: Model, changes: dict) -> tuple[Design, Scenario, Model]:
    """Design, scenario and model with fields changed, each found by its name in Design, Scenario, Soil or Model."""
    groups = {Design: {}, Scenario: {}, Soil: {}, Model: {}}
    names = {kind: limits_of(kind) for kind in groups}
    for name, value in changes.items():
        kind = next((kind for kind, known in names.items() if name in known), None)
        if kind is None:
            raise unknown("Design, Scenario, Soil and Model have no field", name, sorted(set().union(*names.values())))
        groups[kind][name] = value
    soil = dataclasses.replace(scenario.soil, **groups[Soil])
    return (dataclasses.replace(design, **groups[Design]), dataclasses.replace(scenario, soil=soil, **groups[Scenario]),
            dataclasses.replace(model, **groups[Model]))


def sweep(design: Design, scenario: Scenario, over: dict, *, model: Model = Model()) -> Sweep:
    """Performance of a single design on a single mission along one field or over a grid of two, in one evaluation.

    `over` has one or two fields of Design, Scenario, Soil or Model with their values; names cannot be swept, nor the
    mission's duration, which sets the time steps.

    Examples
    --------
    >>> import rdk
    >>> mare = rdk.scenario("equatorial_mare_traverse")
    >>> s = sweep(rdk.rover("Rashid-1"), mare, {"slope_deg": [0, 10, 20]})
    >>> s.performance.slip.round(2)
    array([0.09, 0.26, 0.5 ])
    """
    single(design=design, scenario=scenario, model=model)
    if not isinstance(over, dict) or not 1 <= len(over) <= 2:
        raise ValueError(f"over must be a dictionary of one or two fields with their values; got {over!r}")
    for name, v in over.items():
        if any(name in limits_of(kind) for kind in (Design, Scenario, Soil, Model)):
            check(f"over: {name}", v, infinite=True)     # what is masked or no number, before it becomes an array
        if np.ndim(v) != 1 or not np.size(v):
            raise ValueError(f"over: {name} needs a one-dimensional list of values; got shape {np.shape(v)}")
    values = tuple(np.asarray(v) for v in over.values())
    axes = np.meshgrid(*values, indexing="ij", sparse=True)
    *swept, model = replaced(design, scenario, model, dict(zip(over, axes)))
    return Sweep(tuple(over), values, evaluate(*swept, model=model))


# ---- uncertainty ----------------------------------------------------------------------------------------------

ATOM = 0.01                                              # share of draws with one value that makes it an atom


class _Read(Mapping):
    """One read-out of every metric of some Intervals, computed when first asked for."""

    def __init__(self, intervals, which):
        self.intervals, self.which = intervals, which

    def __getitem__(self, name):
        return self.intervals.ends(name)[self.which]

    def __iter__(self):
        return iter(METRICS)

    def __len__(self):
        return len(METRICS)


@dataclasses.dataclass(frozen=True, eq=False, repr=False)
class Intervals(Shown):
    """Monte-Carlo intervals of every metric, each computed when first asked for.

    `nominal`, `low`, `median` and `high` map metrics to numbers with the shape of the design, true/false ones to the
    share of draws in which they hold; `level` is the probability between low and high. `performance` is that of the
    nominal inputs, `draws` has all draws, shape (draws, ...). `clamped` maps a metric to two flags: whether its low and
    its high end are a clamp or stand beside an atom, a value that 1 % of the draws share (a limit of the model or of
    the mission, a stall at 0). A share of draws then says more than the end.
    """
    level: float
    performance: Performance
    draws: Performance
    _found: dict = dataclasses.field(default_factory=dict)

    nominal = property(lambda self: _Read(self, 0))
    low = property(lambda self: _Read(self, 1))
    median = property(lambda self: _Read(self, 2))
    high = property(lambda self: _Read(self, 3))
    clamped = property(lambda self: _Read(self, 4))

    @property
    def error(self) -> float:
        """Monte-Carlo error: standard deviation of the share of draws beyond an end, at most (independent draws)."""
        tail = (1 - self.level) / 2
        return math.sqrt(tail * (1 - tail) / len(self.draws))

    def ends(self, name: str) -> tuple:
        """Nominal, low end, median, high end of a metric, and which of the ends are clamps."""
        if name not in METRICS:
            raise KeyError(str(unknown("no Performance field", name, METRICS)))
        if name not in self._found:
            self._found[name] = getattr(self.performance, name), *self._quantiles(getattr(self.draws, name))
        return self._found[name]

    def _quantiles(self, values):
        tail, missing = (1 - self.level) / 2, np.isnan(values)
        if values.dtype == bool:
            return *[values.mean(0)[()]] * 3, (False, False)
        if missing.all():
            return *[np.full(values.shape[1:], np.nan)[()]] * 3, (False, False)
        # no interpolation between infinities: a speed without a limit, downhill
        method = "closest_observation" if np.isinf(values).any() else "linear"
        quantile = np.nanquantile if missing.any() else np.quantile
        low, median, high = quantile(values, [tail, 0.5, 1 - tail], axis=0, method=method)

        def atom(value):                                 # clamps differ by rounding; infinities equal each other
            return np.isclose(values, value, rtol=1e-9, atol=0).mean(0) >= ATOM

        least, most = np.where(missing, np.inf, values).min(0), np.where(missing, -np.inf, values).max(0)
        return low, median, high, tuple(((low < high) & (atom(end) | atom(extreme)))[()]
                                        for end, extreme in ((low, least), (high, most)))

    def share(self, wanted) -> float | np.ndarray:
        """Joint share of draws in which *all* demands hold, such as [("range_km", ">=", 30)]; by design."""
        met = np.ones(self.draws.shape, bool)
        for demand in demands(wanted, "demands"):
            met &= holds(self.draws, demand)
        return met.mean(0)[()]

    def to_frame(self):
        """A pandas DataFrame: one row a metric (one design only); `clamped` names the ends that are."""
        import pandas as pd
        ends = np.array(["low", "high"])
        rows = [(*self.ends(name)[:4], " ".join(ends[list(self.clamped[name])])) for name in METRICS]
        return pd.DataFrame(rows, METRICS, ["nominal", "low", "median", "high", "clamped"])

    def _summary(self):
        import pandas as pd
        heading = (f"{100 * self.level:g} % intervals of {len(self.draws)} draws; the share beyond an end is known to "
                   f"{100 * self.error:.1f} points")
        if self.draws.shape[1:]:
            return heading, pd.DataFrame({f"{name} {end}": getattr(self, end)[name] for name in READINGS[:3]
                                          for end in ("low", "high")})
        return heading, self.to_frame().loc[list(READINGS)]


def intervals(design: Design, scenario: Scenario, *, draws: int = DRAWS, seed: int = 0, level: float = 0.9,
              model: Model = Model(), table: list | None = None) -> Intervals:
    """Intervals of every metric by Monte-Carlo through the physics: soil, wheel model, hub, mass, power.

    The inputs are independent, and they are what the table names: not what the models leave out. Metrics that are NaN
    in a draw (a buried wheel) are left out of its percentiles. One design or a flat population; every design sees the
    same draws, and the same seed gives the same bits. `level` is the probability inside the interval; the `table` takes
    the place of `data/uncertainties.csv`.
    """
    require(design=(design, Design))
    single(scenario=scenario, model=model)
    level = check("level", level, above=0, below=1, scalar=True)
    if len(design.shape) > 1:
        raise ValueError(f"design must be a single one or a flat population; got arrays of shape {design.shape}")
    changes = uncertain_inputs(scenario, draws=draws, seed=seed, model=model, table=table)
    if not changes:
        raise ValueError("table must hold at least one row; got none")
    across = {name: value.reshape(-1, *(1 for _ in design.shape)) for name, value in changes.items()}
    *changed, drawn = replaced(design, scenario, model, across)
    return Intervals(level, evaluate(design, scenario, model=model), evaluate(*changed, model=drawn))


# ---- attribution ----------------------------------------------------------------------------------------------

@dataclasses.dataclass(frozen=True, eq=False, repr=False)
class Attribution(Shown):
    """Shapley values: what each design variable contributes to the difference of two designs.

    `contributions` has, by metric, one value a design variable in the order of DESIGN_SPACE; they add up to
    `performance - baseline_performance`.
    """
    contributions: dict
    performance: Performance
    baseline_performance: Performance
    mixtures: tuple = ()                                 # of what, and the metrics' values: `known` of a later call

    def to_frame(self):
        """A pandas DataFrame: one row a design variable, one column a metric."""
        import pandas as pd
        return pd.DataFrame(self.contributions, index=list(DESIGN_SPACE))

    def _summary(self):
        frame = self.to_frame()
        return "Attribution: what each variable adds to the baseline", frame[[n for n in READINGS if n in frame]]


def attribution(design: Design, baseline: Design, scenario: Scenario, *, model: Model = Model(),
                metrics: Sequence = METRICS, known: Attribution | None = None) -> Attribution:
    """Exact Shapley values of each metric's difference between two single designs, over the eleven design variables.

    Every mixture of the two designs is evaluated, 2^k of them in one call where k variables differ, and each variable
    is credited with its mean marginal effect over all orders in which the variables could change (Shapley 1953).
    Metrics that are not finite in all mixtures are left out; true/false ones count as 1 and 0. Mixtures that a `known`
    attribution has, of the same baseline, mission, model and metrics, are not evaluated again.
    """
    single(design=design, baseline=baseline, scenario=scenario, model=model)
    require(**{} if known is None else {"known": (known, Attribution)})
    differ = np.array([getattr(design, name) != getattr(baseline, name) for name in DESIGN_SPACE])
    count = int(differ.sum())
    takes = np.zeros((2**count, len(differ)), bool)                  # (mixtures, variables): from the design?
    takes[:, differ] = np.arange(2**count)[:, None] >> np.arange(count) & 1
    task, old, fresh = (baseline, scenario, model, tuple(metrics), differ.tolist()), {}, np.ones(len(takes), bool)
    if known is not None and known.mixtures[1] == task:              # without a variable that moved: the same mixture
        moved = [getattr(design, name) != getattr(known.mixtures[0], name) for name in DESIGN_SPACE]
        old, fresh = known.mixtures[2], takes[:, moved].any(1)
        fresh[[0, -1]] = True
    result = evaluate(Design(**{name: np.where(takes[fresh, i], getattr(design, name), getattr(baseline, name))
                                for i, name in enumerate(DESIGN_SPACE)}), scenario, model=model)
    size = takes.sum(1)
    share = np.array([math.factorial(k) * math.factorial(count - 1 - k) / math.factorial(count) for k in range(count)])
    # phi_i = sum over mixtures without i of share(size) * (with i - without i), as one matrix
    weights = np.zeros(takes.T.shape)
    if count:
        weights[differ] = np.where(takes.T[differ], share[size - 1], -share[np.minimum(size, count - 1)])
    values = {name: old[name].copy() if old else np.empty(len(takes)) for name in metrics}
    for name in metrics:
        values[name][fresh] = getattr(result, name)
    contributions = {name: weights @ each for name, each in values.items() if np.isfinite(each).all()}
    return Attribution(contributions, result[-1], result[0], (design, task, values))
