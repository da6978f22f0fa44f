"""Sizing: the lightest rover that meets a list of demands, what holds it back, what a demand costs, and its odds.

The search is a differential evolution on the evaluator itself; four and six wheels are searched side by side and never
mixed.
"""
from __future__ import annotations

import dataclasses
import math
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ._evolution import ELITE, evolve
from ._fields import Shown, check, unknown, whole
from .design import DESIGN_SPACE, Demand, Design, Model, Scenario, single
from .mission import Performance, evaluate
from .sampling import METRICS, decode, demands as checked, encode, light_corner, random_designs, replaced
from .uncertainty import uncertain_inputs

POPULATION, GENERATIONS = 40, 130                        # designs of each wheel count
# with confidence: draws, designs, generations, margin (a share of 1 - confidence), lanes after which to go on
STAGES = {"light": (64, 32, 40, -0.4, 90_000), "more": (512, 20, 45, 0.08, 135_000), "sure": (64, 20, 30, 1, 60_000),
          "again": (512, 20, 45, 0.08, 100_000), "last": (2048, 12, 30, 0, 110_000)}
PATIENCE = 0.85                                          # times these lanes, while a stage has met nothing
HOPELESS, NEARLY = 0.05, 0.01                            # shares missing: no last stage; as good as the best
FIRST_LOOK = 4                                           # a quarter of the draws comes first, the hardest
FRESH_DRAWS, FRESH_SEED = 20_480, 7_919                  # of the odds; the seed is added to that of the search
LANES = 2**15                                            # designs x draws evaluated at once
TIGHT = 0.005                                            # a demand holds the design within this share of its limit
PRICE_STEP = 0.05                                        # share of its limit by which a demand is moved for its price
WORST = 1e3                                              # shortfall of a demand, in units of its limit, at most
VARIABLES = list(DESIGN_SPACE)
WHEELS = VARIABLES.index("wheel_count")                  # the gene that no trial changes


class Progress(NamedTuple):
    """What `on_generation` receives: the generation just finished, of how many, and the best design so far."""
    generation: int
    generations: int
    design: Design


@dataclasses.dataclass(frozen=True)
class _Search:
    """What is asked of `size`, and how a population of genes does on it."""
    scenario: Scenario
    demands: tuple
    minimise: str
    confidence: float | None
    model: Model
    bounds: dict | None
    seed: int

    @cached_property
    def scales(self):
        """What one unit of shortfall is: the limit of each demand; the usual spread of the field where that is 0."""
        usual = evaluate(random_designs(64, seed=0, bounds=self.bounds), self.scenario, model=self.model)

        def spread(field):
            value = np.asarray(getattr(usual, field), float)
            value = value[np.isfinite(value)]
            return np.subtract(*np.quantile(value, [0.75, 0.25])) if value.size else 0

        return np.array([abs(demand.limit) or spread(demand.field) or 1.0 for demand in self.demands])

    @cached_property
    def flags(self):
        """Which demands are on a field that is true or false."""
        return np.array([Performance.__annotations__[demand.field] is bool for demand in self.demands], bool)

    def slacks(self, found):
        """How far inside its limit each demand is, in units of its scale: (demands, ...)."""
        slacks = [demand.slack(found) / scale for demand, scale in zip(self.demands, self.scales)]
        return np.reshape(slacks, (len(slacks), *found.shape))

    def first(self, random, known=None):
        """First generations: half in the light corner, half known or anywhere; one population a wheel count."""
        genes, corner = random.random((2, POPULATION, len(VARIABLES))), POPULATION // 2
        light_corner(genes[:, :corner])
        if known is not None:
            genes[:, corner:corner + len(known)] = known[:POPULATION - corner]
        genes[..., WHEELS] = [[0], [1]]
        both = decode(genes[:, 0], self.bounds).wheel_count
        return genes if both[0] != both[1] else genes[:1]

    def score(self, genes, *parents):
        """Objective and summed relative shortfall of genes (populations, designs, 11) at the nominal values."""
        found = evaluate(decode(genes.reshape(-1, genes.shape[2]), self.bounds), self.scenario, model=self.model)
        objective = np.array(getattr(found, self.minimise), float)
        violation = np.clip(-self.slacks(found), 0, WORST).sum(0)
        failed = found.buried | ~np.isfinite(objective)  # a lane without a solution
        return tuple(np.where(failed, np.inf, x).reshape(genes.shape[:2]) for x in (objective, violation))

    def margins(self, genes, changes):
        """The slacks of designs in draws of the inputs, flags as inf or -1: (demands, draws, designs)."""
        designs, draws = decode(genes, self.bounds), len(next(iter(changes.values())))
        margins = np.empty((len(self.demands), draws, len(genes)))
        step = max(LANES // max(len(genes), 1), 1)       # bounded memory
        for start in range(0, draws, step):
            part = {name: value[start:start + step, None] for name, value in changes.items()}
            *drawn, model = replaced(designs, self.scenario, self.model, part)
            found = evaluate(*drawn, model=model)
            margins[:, start:start + step] = np.where(found.buried, -np.inf, self.slacks(found))
        return np.where(self.flags[:, None, None] & (margins >= 0), np.inf, margins)

    def held(self, genes):
        """Whether each demand holds in each fresh draw of the inputs: (demands, draws, designs)."""
        changes = uncertain_inputs(self.scenario, draws=FRESH_DRAWS, seed=self.seed + FRESH_SEED, model=self.model)
        return self.margins(genes, changes) >= 0

    def stages(self, known=None):
        """Yield (genes, objective, violation), each by population, after every generation."""
        random = np.random.default_rng(self.seed)
        genes = self.first(random, known)
        for state in evolve(self.score, genes, random, GENERATIONS, WHEELS):
            yield state
            if self.confidence and state[2].min() == 0:
                break
        else:                                            # no odds asked for, or not even met at the nominal values
            return
        light = (yield from self._stage("light", genes, random))[0]
        state = yield from self._stage("more", light, random)
        if state[2].min() > 0:                           # too light to recover: breed with those that fail least
            sure, light = random.random(state[0].shape), state[0]
            sure[..., WHEELS] = light[..., WHEELS]
            sure = (yield from self._stage("sure", sure, random))[0]
            light = light[np.isin(light[:, 0, WHEELS], sure[:, 0, WHEELS])]
            half = light.shape[1] // 2
            state = yield from self._stage("again", np.concatenate([light[:, :half], sure[:, :half]], 1), random)
        if state[2].min() < HOPELESS:
            yield from self._stage("last", state[0], random)

    def _stage(self, name, genes, random):
        """Evolve where the joint share of a stage's draws is a constraint, too; returns the last state."""
        draws, designs, generations, margin, budget = STAGES[name]
        confidence = self.confidence + margin * (1 - self.confidence)
        allowed = min(math.floor((1 - confidence) * draws + 1e-9), draws - 1)        # draws that may fail
        genes, lanes = genes[:, :designs], 0
        changes = uncertain_inputs(self.scenario, draws=draws, seed=self.seed, model=self.model)
        # a look at the hardest draws comes first
        hardest = np.argsort(self.margins(genes[0, :ELITE], changes).min((0, 2), initial=np.inf), kind="stable")
        look = max(draws // FIRST_LOOK, allowed + 1)
        first, rest = ({name: value[part] for name, value in changes.items()}
                       for part in (hardest[:look], hardest[look:]))

        def score(trials, objective=np.inf, violation=np.inf):
            nonlocal lanes
            new, short = self.score(trials)
            # who cannot replace the parent need not be drawn
            open_ = (short < violation) | (short == violation) & (new < objective)
            asked, added = trials[open_], np.full(np.count_nonzero(open_), np.inf)
            worst = self.margins(asked, first).min(0, initial=np.inf)
            # of a parent that holds, one failing draw too many settles it
            stays = ((worst < 0).sum(0) <= allowed) | np.broadcast_to(violation != 0, short.shape)[open_]
            more = self.margins(asked[stays], rest).min(0, initial=np.inf)
            lanes += worst.size + more.size
            worst = np.concatenate([worst[:, stays], more])
            failing, decides = (worst < 0).sum(0), np.partition(worst, allowed, axis=0)[allowed]
            # share of draws missing, and a little of how far the draw that decides fails: a slope to walk down
            added[stays] = np.where(failing > allowed, (failing - allowed) / draws + 0.1 * np.clip(-decides, 0, 1), 0)
            total = np.full(short.shape, np.inf)
            total[open_] = short[open_] + added
            return new, total

        for state in evolve(score, genes, random, generations, WHEELS):
            yield state
            if lanes > budget * (PATIENCE if state[2].min() > 0 else 1):
                break
        return state

    def met(self, demands):
        """Whether some design meets these of the demands at the nominal values."""
        search = dataclasses.replace(self, demands=tuple(demands), confidence=None)
        return any(violation.min() == 0 for *_, violation in search.stages())

    def best(self, known):
        """Least objective that is found, inf where nothing meets the demands, and the population that has it."""
        *_, (genes, objective, violation) = self.stages(known)
        least = np.where(violation[:, 0] > 0, np.inf, objective[:, 0])
        return least.min(), genes[least.argmin()]


@dataclasses.dataclass(frozen=True, eq=False, repr=False)
class Sizing(Shown):
    """The rover that `size` found; where nothing meets the demands (or the confidence), the nearest miss.

    The `message` is empty or says which demands conflict, each of which could be met without one of the others, which
    confidence is out of reach, or that the search was stopped. `binding` names the demands met with no more than 0.5 %
    to spare (of a flag: that a step to a better objective turns), and the variables at a bound where a step inward,
    alone, worsens the objective or such a demand.
    """
    design: Design
    performance: Performance
    message: str
    search: _Search
    population: np.ndarray

    @cached_property
    def _holds(self):
        """Whether each demand (down) holds in each fresh draw (across)."""
        return self.search.held(encode(self.design, self.search.bounds))[..., 0]

    @property
    def odds(self) -> float:
        """Share of 20,480 fresh draws of the uncertain inputs in which all demands hold."""
        return float(self._holds.all(0).mean())

    @property
    def demands(self):
        """A DataFrame: each demand, the value reached, the slack left, the share of fresh draws in which it holds."""
        import pandas as pd
        asked = self.search.demands
        frame = pd.DataFrame({"demand": list(map(str, asked)),
                              "value": [float(getattr(self.performance, demand.field)) for demand in asked],
                              "slack": [float(demand.slack(self.performance)) for demand in asked],
                              "share": self._holds.mean(1)})
        object.__setattr__(frame, "prices", self.prices)             # reads well: sizing.demands.prices()
        return frame

    def prices(self):
        """The demands with what one unit more of each costs, in units of the objective: found by sizing again.

        Each demand in turn is made harder by 5 % of its limit (of the field's usual spread where that is 0), at the
        nominal values. inf: then nothing meets the demands any more. NaN: a flag, which has no unit.
        """
        search = dataclasses.replace(self.search, confidence=None)
        steps = PRICE_STEP * search.scales
        base, known = search.best(self.population)       # as long a search as each that it is compared with
        found = np.full(len(steps), np.inf)
        for i in np.flatnonzero(~search.flags):
            demand = search.demands[i]
            limit = demand.limit + steps[i] * (1 if demand.sign == ">=" else -1)
            harder = (*search.demands[:i], demand._replace(limit=limit), *search.demands[i + 1:])
            found[i], _ = dataclasses.replace(search, demands=harder).best(known)
        least = min([base, *found])                      # what meets more meets this too
        costs = found - least if least < math.inf else found
        frame, unit = self.demands, "kg" if search.minimise.endswith("_kg") else search.minimise
        frame[f"{unit}_per_unit"] = np.where(search.flags, np.nan, costs / steps)
        return frame

    @cached_property
    def binding(self) -> tuple:
        search, here = self.search, self.performance
        gene = encode(self.design, search.bounds)[0]
        steps = np.full(len(gene), 0.01)
        steps[VARIABLES.index("grouser_count")] = 0.05   # more than one of 24
        nearby = np.clip(np.concatenate([gene + np.diag(steps), gene - np.diag(steps)]), 0, 1)
        moved = evaluate(decode(nearby, search.bounds), search.scenario, model=search.model)
        change = np.asarray(getattr(moved, search.minimise), float) - getattr(here, search.minimise)
        slack, after = search.slacks(here), search.slacks(moved)
        turns = (slack < 0) | ((after < 0) & (change < 0)).any(1)
        tight = np.where(search.flags, turns, slack <= TIGHT)
        breaks = (after < slack[:, None] - 1e-9)[tight].any(0)
        hurts = (breaks | (change > 1e-9)).reshape(2, -1)
        held = ((gene < 0.001) & hurts[0] | (gene > 0.999) & hurts[1]) & (np.arange(len(gene)) != WHEELS)
        names = dict.fromkeys(demand.field for demand, holds in zip(search.demands, tight) if holds)
        return (*names, *np.array(VARIABLES)[held].tolist())

    def _summary(self):
        import pandas as pd
        goal = f"{self.search.minimise} {getattr(self.performance, self.search.minimise):.4g}"
        heading = f"Sizing: {goal}; held by {', '.join(self.binding) or 'nothing'}. {self.message}".strip()
        return heading, pd.DataFrame([self.design.numbers()], [""]).T


def size(scenario: Scenario, demands, *, minimise: str = "total_mass_kg", confidence: float | None = None,
         model: Model = Model(), bounds: dict | None = None, seed: int = 0, on_generation=None) -> Sizing:
    """The lightest rover that meets a list of demands on a mission; same seed, same rover.

    Demands that nothing meets raise nothing: the `message` of the Sizing says so.

    Parameters
    ----------
    scenario : Scenario
        A single mission; its `problem` is not read. A required obstacle height above 0 is one demand more.
    demands : sequence of (str, str, float)
        Such as ("range_km", ">=", 30), on any Performance field; a flag is 1 (or True) or 0.
    minimise : str
        The Performance field to make least.
    confidence : float, optional
        Joint share of draws of the uncertain inputs in which all demands must hold, between 0 and 1; they hold at the
        nominal values too.
    bounds : dict, optional
        As for `random_designs`.
    on_generation : callable, optional
        Called with a `Progress` after each generation; when it returns True the search stops there.

    Examples
    --------
    >>> import rdk
    >>> mare = rdk.scenario("equatorial_mare_traverse")
    >>> found = size(mare, [("range_km", ">=", 30), ("slope_capability_deg", ">=", 20)])
    >>> f"{found.performance.total_mass_kg:.2f} kg"
    '8.35 kg'
    """
    single(scenario=scenario, model=model)
    if minimise not in METRICS:
        raise unknown("minimise: no Performance field", minimise, METRICS)
    confidence = check("confidence", confidence, above=0, below=1, scalar=True, optional=True)
    seed = whole("seed", seed)
    asked = checked(demands, "demands", scenario, may_contradict=True)
    search = _Search(scenario, asked, minimise, confidence, model, bounds, seed)
    most = GENERATIONS + (sum(stage[2] for stage in STAGES.values()) if confidence else 0)
    for done, (genes, objective, violation) in enumerate(search.stages(), 1):
        near = violation <= violation.min() + (NEARLY if confidence and violation.min() > 0 else 0)
        best, which = np.unravel_index(np.where(near, objective, np.inf).argmin(), near.shape)
        design = decode(genes[best, [which]], bounds)[0]
        stopped = on_generation is not None and on_generation(Progress(done, most, design))
        if stopped:
            break
    found = Sizing(design, evaluate(design, scenario, model=model), "", search, genes[best])
    message = (f"stopped after generation {done} of {most}" if stopped
               else _conflict(found) if violation.min() > 0 else "")
    return dataclasses.replace(found, message=message)


def _conflict(found):
    """Which demands conflict, or which confidence is out of reach."""
    search, performance = found.search, found.performance
    if performance.buried:
        return "no design has a solution: the wheels are buried"
    missed = [demand for demand in search.demands if demand.slack(performance) < 0]
    if not missed:
        frame = found.demands
        weakest = frame.loc[frame["share"].idxmin()]
        best = max(found.odds, search.held(found.population[:1]).all(0).mean())
        return (f"a confidence of {search.confidence:g} is not reachable: the search found no design with a joint "
                f"share above {best:.3f}. The nearest miss, the lightest within {NEARLY} of it, fails most often: "
                f"{weakest['demand']}, which holds in {weakest['share']:.3f} of the draws")
    by = ", ".join(f"{demand.field} by {-demand.slack(performance):.3g}" for demand in missed)
    tight = [demand for demand, slack in zip(search.demands, search.slacks(performance)) if slack <= 10 * TIGHT]
    conflict = tight if len(tight) < len(search.demands) and not search.met(tight) else list(search.demands)
    for demand in [d for d in conflict if d not in missed] + missed:
        rest = [other for other in conflict if other is not demand]
        if rest and not search.met(rest):
            conflict = rest                              # it conflicts without this one
    together = " together, though it could without any one of them" if len(conflict) > 1 else ""
    return f"no design within the bounds meets {' and '.join(map(str, conflict))}{together}; the nearest misses {by}"


def prudent_demands(scenario: Scenario) -> tuple[Demand, ...]:
    """The demands that a careful engineer starts from, each with its reason as `why`; add what the mission asks for.

    They can have no solution: a served bus at the pole needs more battery than DESIGN_SPACE holds. That is the answer.
    """
    single(scenario=scenario)
    return (
        Demand("feasible", ">=", 1, "it drives at all, and gathers the energy that it spends"),
        Demand("slip", "<=", 0.4, "beyond a slip of 0.4 at the mission's slope, measured wheels dig in"),
        Demand("slope_capability_deg", ">=", max(scenario.slope_deg, 0.0), "it climbs what the mission crosses"),
        Demand("unserved_h", "<=", 0, "avionics and payload are supplied at every hour"),
        Demand("hot_survival", ">=", 1, "the enclosure stays below its upper limit at noon"),
        Demand("structure_share", ">=", 0.2, "published chassis are 17 to 34 % of the mass"),
        Demand("wheel_gap_m", ">=", 0, "wheels of one side must not overlap, which no model forbids"))
