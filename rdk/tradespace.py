"""Pareto fronts by NSGA-II: pymoo's, with the paper's settings, on the evaluator itself."""
from __future__ import annotations

import dataclasses
import json
import math
import warnings
from collections.abc import Callable, Sequence
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

import numpy as np

from . import catalog
from ._fields import Shown, unknown, whole
from .design import DESIGN_SPACE, Design, Model, Problem, Scenario, single
from .mission import Performance, evaluate
from .sampling import METRICS, decode, demands, encode, light_corner

FAILED = 1e9                                             # objective and violation of a lane without a solution
RANKED_DECIMALS = 8                                      # objectives are compared no finer: see `nsga2`
HYPERVOLUME_SCALES = {"range_km": None, "total_mass_kg": 80.0, "slope_capability_deg": 45.0}    # None: the limit
HYPERVOLUME_REFERENCE = 1.05                             # in every scaled objective
MOST_GENERATIONS, PATIENCE, LEAST_GAIN = 1000, 20, 1e-4  # of a search that stops when it has converged


@dataclasses.dataclass(frozen=True, eq=False, repr=False)
class Front(Shown):
    """Non-dominated designs of a search, by rising mass, shape (n,); of designs alike in every objective, one.

    The `scenario` is as searched, with the problem's traverse limit; the `problem` has objectives, constraints and seed
    of the search; `objective_history` has the non-dominated feasible objectives after each generation, all to be
    minimised. The `message` is empty or says what to know: where no design met the constraints n is 0, and it says so.
    """
    designs: Design
    performance: Performance
    scenario: Scenario
    model: Model
    problem: Problem
    objective_history: tuple = ()
    message: str = ""

    def __len__(self) -> int:
        return len(self.designs)

    @cached_property
    def history(self) -> np.ndarray:
        """Normalised hypervolume after each generation."""
        return np.array([hypervolume(F, self.problem.objectives, self.scenario) for F in self.objective_history])

    def hypervolume(self) -> float:
        """Normalised hypervolume of the designs; NaN where an objective has no published scale."""
        objectives = self.problem.objectives
        return hypervolume(minimised(self.performance, objectives), objectives, self.scenario)

    def to_frame(self):
        """A pandas DataFrame: one row a design, its variables first, then its performance."""
        import pandas as pd
        return pd.concat([self.designs.to_frame(), self.performance.to_frame()], axis=1)

    def save(self, path: str | Path) -> None:
        """Write the front to a JSON file, complete or not at all; `rdk.catalog.from_json` reads its designs too."""
        kept = json.loads(catalog.to_json(self.designs, self.scenario)) | catalog.plain({
            "model": self.model, "problem": self.problem, "message": self.message,
            "objective_history": self.objective_history})
        catalog.write(json.dumps(kept, allow_nan=False), path)

    @classmethod
    def load(cls, path: str | Path) -> Front:
        """The front in a file of `save`, its performance evaluated anew; ValueError where the file is damaged."""
        try:
            kept = catalog.read_json(Path(path).read_text(encoding="utf-8"))
            designs, scenario, model, problem = (
                catalog.built(kind, kept[kind.__name__.lower()]) for kind in (Design, Scenario, Model, Problem))
            single(scenario=scenario, model=model)
            if kept["format"] != "rdk-design-1" or len(designs.shape) != 1:
                raise ValueError("it needs 'format': 'rdk-design-1' and a flat list of designs")
            history = tuple(np.array(F, float).reshape(len(F), len(problem.objectives))
                            for F in kept["objective_history"])
            return cls(designs, evaluate(designs, scenario, model=model), scenario, model, problem, history,
                       str(kept["message"]))
        except (KeyError, TypeError, AttributeError, ValueError) as error:
            raise ValueError(f"{path} holds no sound front: {error}") from None

    def _summary(self):
        fields = dict.fromkeys([*self.problem.objectives, "wheel_count", "wheel_radius_m", "battery_capacity_wh"])
        message = f"; {self.message}" if self.message else ""
        return f"Front: {len(self)} designs on {self.scenario.name}{message}", self.to_frame()[list(fields)]


class Progress(NamedTuple):
    """What `on_generation` receives: the generation just finished, of how many, and the front so far on demand."""
    generation: int
    generations: int
    front: Callable[[], Front]


def minimised(performance: Performance, objectives: dict) -> np.ndarray:
    """Objectives as columns, shape (n, m), each with the sign that makes less better."""
    return np.stack([np.atleast_1d(getattr(performance, name)) * (-1.0 if way == "max" else 1.0)
                     for name, way in objectives.items()], axis=1)


def beaten(mine: np.ndarray, theirs: np.ndarray) -> np.ndarray:
    """Which points (rows, all objectives minimised) some point of theirs dominates."""
    return ((theirs[:, None] <= mine).all(-1) & (theirs[:, None] < mine).any(-1)).any(0)


def hypervolume(minimised: np.ndarray, objectives: dict, scenario: Scenario) -> float:
    """Normalised hypervolume of objective vectors, shape (n, m), in the order of `objectives`, all to be minimised.

    Each objective is scaled to [0, 1] - range by the traverse limit, mass by 80 kg, slope capability by 45 deg, as in
    the paper's release - and clipped; the reference point is 1.05 in every objective. NaN where an objective has no
    published scale, or range no limit.
    """
    scales = np.array([HYPERVOLUME_SCALES.get(name, math.nan) or scenario.traverse_limit_km for name in objectives])
    if not ((scales > 0) & (scales < math.inf)).all():
        return math.nan
    return _volume(np.asarray(minimised) / scales - [-1.0 if d == "max" else 0.0 for d in objectives.values()])


def _volume(scaled):
    """Hypervolume of points in the unit cube, below the reference."""
    if not len(scaled):
        return 0.0
    from pymoo.indicators.hv import HV
    return float(HV(ref_point=np.full(scaled.shape[1], HYPERVOLUME_REFERENCE))(np.clip(scaled, 0, 1)))


def _gain(old, new, objectives, scenario):
    """Hypervolume that `new` has more than `old`; objectives without a published scale span the unit cube."""
    if len(old) and math.isnan(hypervolume(old, objectives, scenario)):
        span = np.ptp(new, axis=0)
        span[span == 0] = abs(new[0])[span == 0]         # a single point: its own size
        scale = np.where(span > 0, span, 1.0)
        return _volume((new - new.min(0)) / scale) - _volume((old - new.min(0)) / scale)
    return hypervolume(new, objectives, scenario) - hypervolume(old, objectives, scenario)


def posed(scenario: Scenario, objectives=None, constraints=None, seed=None) -> tuple[Scenario, Problem]:
    """The scenario and the Problem that a search uses: the scenario's own problem, with what the caller changes."""
    single(scenario=scenario)
    problem = scenario.problem
    constraints = demands(problem.constraints if constraints is None else constraints, scenario=scenario)
    problem = Problem(problem.objectives if objectives is None else objectives, constraints, problem.traverse_limit_km,
                      problem.seed if seed is None else seed)
    if not problem.objectives:
        raise ValueError("objectives must name at least one Performance field; got none")
    for name in problem.objectives:
        if name not in METRICS:
            raise unknown("objectives: no Performance field", name, METRICS)
    if problem.traverse_limit_km is not None:
        scenario = dataclasses.replace(scenario, traverse_limit_km=problem.traverse_limit_km)
    return scenario, problem


def pareto_front(scenario: Scenario, *, population: int | None = None, generations: int | str = 60,
                 seed: int | None = None, objectives: dict | None = None, constraints: Sequence | None = None,
                 model: Model = Model(), start: Front | Design | str | None = None,
                 on_generation: Callable[[Progress], object] | None = None, bounds: dict | None = None,
                 warn: bool = True) -> Front:
    """Pareto front of a mission by NSGA-II on the evaluator itself.

    pymoo's NSGA-II (Deb et al. 2002, doi:10.1109/4235.996017; Blank & Deb 2020, doi:10.1109/ACCESS.2020.2990567) with
    the paper's operators: simulated binary crossover (0.9, eta 15), polynomial mutation (0.9
    per individual, 1/11 per gene, eta 20), binary tournament, duplicates removed. Where no design meets the
    constraints the front is empty, with a message and, if `warn`, a UserWarning.

    Parameters
    ----------
    scenario : Scenario
        A single mission. Its `problem` gives objectives, constraints, seed and traverse limit unless told otherwise. A
        required obstacle height above 0 becomes a constraint.
    population : int, optional
        Designs in each generation, 4 or more. Default: the paper's 50; 100 where the search is to converge.
    generations : int or "converged"
        How many, 1 or more. "converged" stops when 20 generations add less than 1e-4 to the normalised hypervolume
        (objectives without a published scale are scaled by the front's own span), and the front is that of *all*
        designs evaluated: some hundreds or thousands.
    seed, objectives, constraints : optional
        In place of the problem's, such as {"range_km": "max"} and [("slope_capability_deg", ">=", 15)]. Same seed, same
        bits; without one, each run differs.
    start : "light", Front or Design, optional
        "light": half of the first generation lies where light designs do (`sampling.light_corner`). Designs join the
        first generation, filled up with random ones; of more than `population`, that many from lightest to heaviest.
    on_generation : callable, optional
        Called with a `Progress` after each generation; when it returns True the search stops with the front so far.
    bounds : dict, optional
        As for `sampling.random_designs`.
    """
    population, generations, until = budget(population, generations)
    scenario, problem = posed(scenario, objectives, constraints, seed)
    algorithm = nsga2(scenario, problem, population, generations, model=model, start=start, bounds=bounds)
    mission, history, misses, stopped = algorithm.problem, [], [], False
    archive = np.empty((0, len(problem.objectives))), np.empty((0, len(DESIGN_SPACE)))

    def so_far(message=""):
        genes = archive[1]
        if not until:
            best = [i for i in algorithm.opt if np.all(i.feas)] if algorithm.opt is not None else []
            # of designs alike in every objective keep one: the last bits would let it dominate its twins
            F = np.array([i.F for i in best]).reshape(-1, len(problem.objectives))
            genes = np.array([best[i].X for i in np.sort(np.unique(F, axis=0, return_index=True)[1])])
        designs = decode(genes.reshape(-1, len(DESIGN_SPACE)), bounds)
        performance = evaluate(designs, scenario, model=model)
        designs = designs[np.lexsort((performance.range_km, performance.total_mass_kg))]
        # evaluated in their final order: the last bits can depend on a lane's place in the batch
        performance = evaluate(designs, scenario, model=model)
        return Front(designs, performance, scenario, model, problem, tuple(history), message)

    def converged():
        if len(history) <= PATIENCE:
            return False
        if not len(history[-1]):                         # nothing feasible: does the nearest miss come nearer?
            return misses[-1] >= misses[-1 - PATIENCE] * (1 - LEAST_GAIN)
        return _gain(history[-1 - PATIENCE], history[-1], problem.objectives, scenario) < LEAST_GAIN

    while algorithm.has_next() and not stopped:
        algorithm.next()
        if until:
            archive = _merged(archive, mission.latest)
            history.append(archive[0])
            misses.append(mission.least)
        else:
            opt = algorithm.opt                          # where nothing is feasible, the one that comes nearest
            history.append(opt.get("F")[:len(opt) * np.all(opt[0].feas)])
        if on_generation is not None:
            stopped = bool(on_generation(Progress(len(history), generations, so_far)))
        if until and converged():
            break
    front = so_far(f"stopped after generation {len(history)} of {generations}" if stopped else "")
    if not len(front):
        message = f"no design of {len(history)} generations has a solution: the wheels are buried"
        if math.isfinite(mission.least):
            words = ", ".join(map(str, problem.constraints))
            message = f"no design of {len(history)} generations met the constraints {words}; {mission.nearest_miss}"
        front = dataclasses.replace(front, message=message)
        if warn:
            warnings.warn(message, UserWarning, stacklevel=2)
    return front


def _merged(found, latest):
    """Non-dominated designs of two sets, pairs of objectives and genes; of designs alike in every objective one."""
    F, first = np.unique(latest[0], axis=0, return_index=True)
    fresh = ~(found[0][:, None] <= F).all(-1).any(0) & ~beaten(F, F)
    kept = ~beaten(found[0], F[fresh])
    return np.concatenate([found[0][kept], F[fresh]]), np.concatenate([found[1][kept], latest[1][first[fresh]]])


def budget(population, generations):
    """Population, generations, and whether the search runs until it has converged."""
    until = isinstance(generations, str)
    if until and generations != "converged":
        raise ValueError(f"generations must be a whole number, at least 1, or 'converged'; got {generations!r}")
    generations = MOST_GENERATIONS if until else whole("generations", generations, 1)
    population = (100 if until else 50) if population is None else population
    return whole("population", population, 4), generations, until


def _first_generation(start, bounds):
    """pymoo's sampling: uniform; half in the light corner; or known designs filled up with uniform ones."""
    from pymoo.operators.sampling.rnd import FloatRandomSampling
    designs = getattr(start, "designs", start)
    if designs is None:
        return FloatRandomSampling()
    if not isinstance(designs, Design) and not (isinstance(start, str) and start == "light"):
        raise TypeError(f"start must be 'light', a Front or a Design; got {start!r}")

    def sampling(mission, count, **kwargs):
        found = FloatRandomSampling()(mission, count, **kwargs)
        genes = found.get("X")
        if isinstance(start, str):
            light_corner(genes[:count // 2])             # a view
        else:
            known = encode(designs, bounds)
            taken = np.linspace(0, len(known) - 1, min(len(known), count)).round().astype(int)
            genes[:len(taken)] = known[taken]
        return found.new("X", genes)

    return sampling


def nsga2(scenario: Scenario, problem: Problem, population: int = 50, generations: int = 60, *, model: Model = Model(),
          start=None, bounds: dict | None = None):
    """pymoo's algorithm, ready for ask and tell, on a mission as `posed` returns it; its `problem` is the mission."""
    from pymoo.algorithms.moo.nsga2 import NSGA2
    from pymoo.config import Config
    from pymoo.core.problem import Problem as Pymoo
    from pymoo.operators.crossover.sbx import SBX
    from pymoo.operators.mutation.pm import PM
    from pymoo.operators.survival.rank_and_crowding.metrics import get_crowding_function
    from pymoo.core.survival import Survival
    from pymoo.util.nds.non_dominated_sorting import NonDominatedSorting
    single(model=model)
    Config.warnings["not_compiled"] = False

    class Mission(Pymoo):
        nearest_miss, least, latest = "", math.inf, None

        def __init__(self):
            # one constraint more: that the design has a solution at all
            super().__init__(n_var=len(DESIGN_SPACE), n_obj=len(problem.objectives), xl=0.0, xu=1.0,
                             n_ieq_constr=len(problem.constraints) + 1)

        def _evaluate(self, x, out, *args, **kwargs):
            result = evaluate(decode(x, bounds), scenario, model=model)
            # designs that differ in a variable which no objective feels tie in theory; the last bits, which differ
            # from one processor to the next, must not rank them
            F = np.round(minimised(result, problem.objectives), RANKED_DECIMALS)
            G = np.stack([*(-demand.slack(result) for demand in problem.constraints), np.zeros(len(x))], axis=1)
            failed = result.buried | ~np.isfinite(F).all(1) | ~np.isfinite(G).all(1)
            F[failed], G[failed] = FAILED, FAILED
            out["F"], out["G"] = F, G
            missed = np.where(failed, math.inf, np.maximum(G, 0).sum(1))
            self.latest = F[missed == 0], x[missed == 0]             # what is feasible
            if len(x) and missed.min() < self.least:
                self.least = missed.min()
                self.nearest_miss = "the nearest missed them by " + ", ".join(
                    f"{value:.3g} in {name}" for value, (name, *_) in zip(G[missed.argmin()], problem.constraints)
                    if value > 0)

    class StableSurvival(Survival):
        """Rank and crowding, as pymoo's, whose sorts leave ties in an order that differs between processors."""

        def _do(self, mission, pop, *args, n_survive=None, **kwargs):
            F, violation, kept = pop.get("F"), pop.get("CV")[:, 0], []
            feasible, infeasible = np.flatnonzero(violation <= 0), np.flatnonzero(violation > 0)
            ranks = NonDominatedSorting().do(F[feasible], n_stop_if_ranked=n_survive) if feasible.size else []
            for rank, front in enumerate(feasible[members] for members in ranks):
                crowding = crowding_distance(F[front])
                for i, distance in zip(front, crowding):
                    pop[i].set_by_dict(rank=rank, crowding=distance)
                if len(kept) + len(front) > n_survive:
                    front = front[np.argsort(-crowding, kind="stable")]
                kept.extend(front[:n_survive - len(kept)])
            nearest = infeasible[np.argsort(violation[infeasible], kind="stable")]
            return pop[kept + list(nearest[:n_survive - len(kept)])]

    crowding_distance = get_crowding_function("cd").do
    algorithm = NSGA2(pop_size=population, sampling=_first_generation(start, bounds), crossover=SBX(prob=0.9, eta=15),
                      mutation=PM(prob=0.9, eta=20), survival=StableSurvival(filter_infeasible=False),
                      eliminate_duplicates=True)
    algorithm.setup(Mission(), termination=("n_gen", generations), seed=problem.seed, verbose=False)
    return algorithm
