"""Trade-space studies: Pareto fronts by NSGA-II, and many of them at once.

The optimiser is pymoo's with the paper's settings, on the evaluator itself. What needs no optimiser - random designs,
sweeps, intervals, attribution - comes from `sampling` and is offered here too.
"""
from __future__ import annotations

import dataclasses
import hashlib
import json
import math
import os
import queue
import re
import warnings
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ._fields import check
from .design import DESIGN_SPACE, Design, Model, Scenario, Problem
from .mission import Performance, evaluate
from .sampling import METRICS, attribution, decode, encode, intervals, random_designs, sweep

__all__ = ["Front", "Progress", "attribution", "decode", "encode", "fronts", "hypervolume", "intervals", "pareto_front",
           "random_designs", "sweep"]

FAILED = 1e9                                             # objective and violation of a lane without a solution
RANKED_DECIMALS = 8                                      # objectives are compared no finer: see `_nsga2`
HYPERVOLUME_SCALES = {"range_km": None, "total_mass_kg": 80.0, "slope_capability_deg": 45.0}    # None: the limit
HYPERVOLUME_REFERENCE = 1.05                             # in every scaled objective


@dataclasses.dataclass(frozen=True)
class Front:
    """Non-dominated designs of a search, by rising mass; of designs alike in every objective, one.

    Attributes
    ----------
    designs : Design
    performance : Performance
        Both with shape (n,); n is 0 where no design met the constraints, and `message` says so.
    scenario : Scenario
        As searched: with the problem's traverse limit.
    model : Model
    problem : Problem
        Objectives, constraints and seed of the search.
    objective_history : tuple of ndarray
        The non-dominated feasible objectives after each generation, all to be minimised.
    message : str
        Empty, or what to know about the result.
    """
    designs: Design
    performance: Performance
    scenario: Scenario
    model: Model
    problem: Problem
    objective_history: tuple = dataclasses.field(repr=False, default=())
    message: str = ""

    def __len__(self):
        return len(self.designs)

    @cached_property
    def history(self):
        """Normalised hypervolume after each generation."""
        return np.array([hypervolume(F, self.problem.objectives, self.scenario) for F in self.objective_history])

    def to_frame(self):
        """A pandas DataFrame: one row a design, its variables first, then its performance."""
        import pandas as pd
        return pd.concat([self.designs.to_frame(), self.performance.to_frame()], axis=1)


class Progress(NamedTuple):
    """What `on_generation` receives: the generation just finished, of how many, and the front so far on demand."""
    generation: int
    generations: int
    front: object


def hypervolume(minimised, objectives, scenario):
    """Normalised hypervolume of objective vectors.

    Each objective is scaled to [0, 1] - range by the traverse limit, mass by 80 kg, slope capability by 45 deg, as in
    the paper's release - and clipped; the reference point is 1.05 in every objective.

    Parameters
    ----------
    minimised : ndarray, shape (n, m)
        Objectives, those to be maximised with the sign changed.
    objectives : dict of str to str
        Their names and directions, in order.
    scenario : Scenario

    Returns
    -------
    float
        NaN where an objective has no published scale, or range no limit.
    """
    scales = [HYPERVOLUME_SCALES.get(name, math.nan) or scenario.traverse_limit_km for name in objectives]
    if not all(0 < scale < math.inf for scale in scales):
        return math.nan
    if not len(minimised):
        return 0.0
    from pymoo.indicators.hv import HV
    best = np.array([-1.0 if d == "max" else 0.0 for d in objectives.values()])
    scaled = np.clip(np.asarray(minimised) / np.array(scales) - best, 0, 1)
    return float(HV(ref_point=np.full(len(scales), HYPERVOLUME_REFERENCE))(scaled))


def posed(scenario, objectives=None, constraints=None, seed=None):
    """The scenario and the Problem that a search uses: the scenario's own problem, with what the caller changes."""
    problem = scenario.problem
    if objectives is not None and not isinstance(objectives, dict):
        raise ValueError(f"objectives must be a dictionary like {{'range_km': 'max'}}; got {objectives!r}")
    if constraints is not None and not (isinstance(constraints, (list, tuple))
                                        and all(isinstance(c, (list, tuple)) for c in constraints)):
        raise ValueError(f"constraints must be a list of (field, '>=' or '<=', limit); got {constraints!r}")
    objectives = problem.objectives if objectives is None else dict(objectives)
    constraints = problem.constraints if constraints is None else tuple(tuple(c) for c in constraints)
    if not objectives:
        raise ValueError("objectives must name at least one Performance field; got none")
    for name, direction in objectives.items():
        if name not in METRICS:
            raise ValueError(f"objectives: no Performance field {name!r}; choose from {', '.join(METRICS)}")
        if direction not in ("max", "min"):
            raise ValueError(f"objectives: direction of {name} must be 'max' or 'min'; got {direction!r}")
    limits = {}
    for constraint in constraints:
        if len(constraint) != 3 or constraint[1] not in (">=", "<="):
            raise ValueError(f"constraints must be like ('range_km', '>=', 0.1); got {constraint!r}")
        name, sign, limit = constraint
        if name not in METRICS:
            raise ValueError(f"constraints: no Performance field {name!r}; choose from {', '.join(METRICS)}")
        limits.setdefault(name, {">=": -math.inf, "<=": math.inf})
        tighter = max if sign == ">=" else min
        limits[name][sign] = tighter(limits[name][sign], check(f"constraints: limit of {name}", limit, scalar=True))
    for name, both in limits.items():
        if both[">="] > both["<="]:
            raise ValueError(f"constraints contradict each other: {name} >= {both['>=']:g} and <= {both['<=']:g}")
    if scenario.shape:
        raise ValueError(f"scenario must be a single mission for a search; got arrays of shape {scenario.shape}")
    if scenario.required_obstacle_height_m > 0:
        constraints += (("obstacle_capability_m", ">=", scenario.required_obstacle_height_m),)
    if problem.traverse_limit_km is not None:
        scenario = dataclasses.replace(scenario, traverse_limit_km=problem.traverse_limit_km)
    return scenario, Problem(objectives, constraints, problem.traverse_limit_km, problem.seed if seed is None else seed)


def pareto_front(scenario, population=50, generations=60, seed=None, objectives=None, constraints=None, model=Model(),
                 start=None, on_generation=None, bounds=None):
    """Pareto front of a mission by NSGA-II on the evaluator itself.

    pymoo's NSGA-II with the paper's operators: simulated binary crossover (0.9, eta 15), polynomial mutation (0.9
    per individual, 1/11 per gene, eta 20), binary tournament, duplicates removed. Genes are decoded before evaluation;
    a whole generation is one call of `evaluate`. Lanes without a solution count as strongly infeasible.

    Parameters
    ----------
    scenario : Scenario
        A single mission. Its `problem` gives objectives, constraints, seed and traverse limit unless told otherwise. A
        required obstacle height above 0 becomes a constraint.
    population, generations : int
        Designs in each generation (4 or more), and how many generations (1 or more).
    seed : int, optional
        Same seed, same bits. Default: the problem's; without one, each run differs.
    objectives : dict of str to str, optional
        Performance fields with "max" or "min".
    constraints : sequence of (str, str, float), optional
        Such as ("slope_capability_deg", ">=", 15).
    model : Model
        Scalars only.
    start : Front or Design, optional
        Warm start: its designs join the first generation, filled up with random ones; of more than `population`
        designs, that many from its lightest to its heaviest.
    on_generation : callable, optional
        Called with a `Progress` after each generation; when it returns True the search stops and the front so far is
        returned.
    bounds : dict of str to (float, float), optional
        Limits of some variables in place of those in DESIGN_SPACE.

    Returns
    -------
    Front
        Empty, with a message and a UserWarning, where no design met the constraints.

    Raises
    ------
    ValueError
        If an argument is unknown, contradictory or out of range.

    References
    ----------
    Deb et al. (2002), doi:10.1109/4235.996017; Blank & Deb (2020), doi:10.1109/ACCESS.2020.2990567.
    """
    front = search(scenario, population, generations, seed, objectives, constraints, model, start, on_generation, bounds)
    if not len(front):
        warnings.warn(front.message, UserWarning, stacklevel=2)
    return front


def search(scenario, population=50, generations=60, seed=None, objectives=None, constraints=None, model=Model(),
           start=None, on_generation=None, bounds=None):
    """`pareto_front` without its warning: for threads, where warnings go astray. An empty front has its message."""
    if not isinstance(scenario, Scenario):
        raise TypeError(f"scenario must be a Scenario; got {type(scenario).__name__}")
    population = int(check("population", population, 4, whole=True, scalar=True))
    generations = int(check("generations", generations, 1, whole=True, scalar=True))
    if seed is not None:
        seed = int(check("seed", seed, 0, whole=True, scalar=True))
    if not isinstance(model, Model):
        raise TypeError(f"model must be a Model; got {type(model).__name__}")
    if model.shape:
        raise ValueError(f"model must hold single numbers for a search; got arrays of shape {model.shape}")
    scenario, problem = posed(scenario, objectives, constraints, seed)
    first = _first_generation(start, population, bounds)
    algorithm, mission = _nsga2(scenario, problem, model, population, generations, first, bounds)
    history, stopped = [], False

    def so_far(message=""):
        best = [i for i in algorithm.opt if np.all(i.feas)] if algorithm.opt is not None else []
        # of designs alike in every objective keep one: the last bits would let it dominate its twins
        _, first = np.unique(np.array([i.F for i in best]).reshape(-1, len(problem.objectives)), axis=0, return_index=True)
        genes = np.array([best[i].X for i in np.sort(first)]).reshape(-1, len(DESIGN_SPACE))
        designs = decode(genes, bounds)
        performance = evaluate(designs, scenario, model)
        designs = designs[np.lexsort((performance.range_km, performance.total_mass_kg))]
        # evaluated in their final order: the last bits can depend on a lane's place in the batch
        return Front(designs, evaluate(designs, scenario, model), scenario, model, problem, tuple(history), message)

    while algorithm.has_next() and not stopped:
        algorithm.next()
        opt = algorithm.opt
        history.append(opt.get("F")[opt.get("feas").ravel()])
        if on_generation is not None:
            stopped = bool(on_generation(Progress(len(history), generations, so_far)))
    front = so_far(f"stopped after generation {len(history)} of {generations}" if stopped else "")
    if not len(front):
        words = ", ".join(f"{name} {sign} {limit:g}" for name, sign, limit in problem.constraints)
        message = (f"no design of {len(history)} generations met the constraints {words}; {mission.nearest_miss}"
                   if math.isfinite(mission.least) else
                   f"no design of {len(history)} generations has a solution: the wheels are buried")
        front = dataclasses.replace(front, message=message)
    return front


def _first_generation(start, population, bounds):
    """pymoo's sampling: uniform, or the warm start's designs filled up with uniform ones."""
    from pymoo.operators.sampling.rnd import FloatRandomSampling
    designs = getattr(start, "designs", start)
    if designs is None or (isinstance(designs, Design) and designs.shape == (0,)):
        return FloatRandomSampling()
    if not isinstance(designs, Design):
        raise TypeError(f"start must be a Front or a Design; got {type(start).__name__}")

    class WarmStart(FloatRandomSampling):
        def _do(self, mission, n_samples, *args, **kwargs):
            genes = super()._do(mission, n_samples, *args, **kwargs)
            known = encode(designs, bounds)
            if len(known) > n_samples:
                known = known[np.linspace(0, len(known) - 1, n_samples).round().astype(int)]
            genes[:len(known)] = known
            return genes

    return WarmStart()


def _nsga2(scenario, problem, model, population, generations, first, bounds):
    """pymoo's algorithm, ready for ask and tell, and the mission that it solves."""
    from pymoo.algorithms.moo.nsga2 import NSGA2
    from pymoo.config import Config
    from pymoo.core.problem import Problem as Pymoo
    from pymoo.operators.crossover.sbx import SBX
    from pymoo.operators.mutation.pm import PM
    from pymoo.operators.survival.rank_and_crowding.metrics import get_crowding_function
    from pymoo.core.survival import Survival
    from pymoo.util.nds.non_dominated_sorting import NonDominatedSorting
    Config.warnings["not_compiled"] = False
    signs = np.array([-1.0 if d == "max" else 1.0 for d in problem.objectives.values()])

    class Mission(Pymoo):
        nearest_miss, least = "", math.inf

        def __init__(self):
            # one constraint more: that the design has a solution at all
            super().__init__(n_var=len(DESIGN_SPACE), n_obj=len(signs), n_ieq_constr=len(problem.constraints) + 1, xl=0.0,
                             xu=1.0)

        def _evaluate(self, x, out, *args, **kwargs):
            result = evaluate(decode(x, bounds), scenario, model)
            # designs that differ in a variable which no objective feels tie in theory; the last bits, which differ
            # from one processor to the next, must not rank them
            F = np.round(np.stack([getattr(result, name) for name in problem.objectives], axis=1) * signs,
                         RANKED_DECIMALS)
            G = np.stack([(getattr(result, name) - limit) * (-1 if sign == ">=" else 1)
                          for name, sign, limit in problem.constraints] + [np.zeros(len(x))], axis=1)
            failed = result.buried | ~np.isfinite(F).all(1) | ~np.isfinite(G).all(1)
            F[failed], G[failed] = FAILED, FAILED
            out["F"], out["G"] = F, G
            missed = np.where(failed, math.inf, np.maximum(G, 0).sum(1))
            if len(x) and missed.min() < self.least:
                self.least = missed.min()
                self.nearest_miss = "the nearest missed them by " + ", ".join(
                    f"{value:.3g} in {name}" for value, (name, *_) in zip(G[missed.argmin()], problem.constraints)
                    if value > 0)

    class StableSurvival(Survival):
        """Rank and crowding, as pymoo's. Its sorts leave ties in an order that differs from processor to processor."""

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
    algorithm = NSGA2(pop_size=population, sampling=first, crossover=SBX(prob=0.9, eta=15),
                      mutation=PM(prob=0.9, eta=20), survival=StableSurvival(filter_infeasible=False),
                      eliminate_duplicates=True)
    mission = Mission()
    algorithm.setup(mission, termination=("n_gen", generations), seed=problem.seed, verbose=False)
    return algorithm, mission


# ---- many fronts ----------------------------------------------------------------------------------------------

@dataclasses.dataclass(frozen=True, eq=False)
class Case:
    """One front of a study: everything that `pareto_front` needs, so that it can run anywhere."""
    scenario: Scenario
    seed: int
    shear_scale: float
    obstacle_height_m: float
    population: int
    generations: int
    model: Model

    def run(self):
        """The front of this case; the same bits wherever it runs."""
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)             # an empty front carries its message
            return pareto_front(
                dataclasses.replace(self.scenario, required_obstacle_height_m=self.obstacle_height_m),
                self.population, self.generations, self.seed,
                model=dataclasses.replace(self.model, shear_scale=self.shear_scale))

    @property
    def key(self):
        """Hash of everything that determines the front."""
        return hashlib.sha256(repr(dataclasses.astuple(self)).encode()).hexdigest()[:16]

    @property
    def label(self):
        """A readable name, also of the case's file."""
        name = re.sub(r"[^\w.-]+", "-", self.scenario.name)         # a name is free text, a file's is not
        return (f"{name}_seed{self.seed}_shear{self.shear_scale:g}_obstacle{self.obstacle_height_m:g}"
                f"_{self.population}x{self.generations}_{self.key}")


def fronts(scenarios, seeds=None, shear_scales=(1.0,), obstacle_heights_m=(0.0,), population=50, generations=60,
          model=Model(), executor=None, folder=None, on_front=None):
    """Fronts for every combination of scenario, seed, shear scale and obstacle height.

    Parameters
    ----------
    scenarios : sequence of Scenario
    seeds : sequence of int, optional
        Default: each scenario's own seed, 0 where it has none.
    shear_scales, obstacle_heights_m : sequence of float
    population, generations : int
    model : Model
        Its `shear_scale` is replaced.
    executor : concurrent.futures.Executor, optional
        Runs the fronts in parallel: a ProcessPoolExecutor, or a Dask client's `get_executor()`. The result is the
        same. Default: one after the other, here.
    folder : path-like, optional
        Keeps each finished front in a file of its own, written atomically. A study that is run again with the same
        folder loads what is there and computes only the rest; a damaged file is computed anew.
    on_front : callable, optional
        Called with (finished, total, case, front) as each front finishes.

    Returns
    -------
    dict of Case to Front
        In the order of the combinations.

    Raises
    ------
    ValueError
        If a list is empty or a value is out of range.
    """
    if isinstance(scenarios, Scenario):
        raise ValueError(f"scenarios must be a list of Scenario; got the single {scenarios.name!r}")
    lists = {name: list(values) for name, values in dict(
        scenarios=scenarios, seeds=(None,) if seeds is None else seeds, shear_scales=shear_scales,
        obstacle_heights_m=obstacle_heights_m).items()}
    for name, values in lists.items():
        if not values:
            raise ValueError(f"{name} must not be empty")
    # refuse a bad value now, not after an hour: plain numbers, too, give one key for one case
    seeds = [s if s is None else int(check("seeds", s, 0, whole=True, scalar=True)) for s in lists["seeds"]]
    scales = [check("shear_scales", s, above=0, scalar=True) for s in lists["shear_scales"]]
    heights = [check("obstacle_heights_m", h, 0, scalar=True) for h in lists["obstacle_heights_m"]]
    cases = [Case(scenario, (scenario.problem.seed or 0) if seed is None else seed, scale, height, population,
                  generations, model)
             for scenario in lists["scenarios"] for seed in seeds for scale in scales for height in heights]
    folder = Path(folder) if folder is not None else None
    if folder is not None:
        folder.mkdir(parents=True, exist_ok=True)
    done = {case: front for case in cases if (front := _load(folder, case)) is not None}
    finished = 0

    def keep(case, front):
        nonlocal finished
        done[case] = front
        finished += 1
        if on_front is not None:
            on_front(finished, len(cases), case, front)

    for case, front in list(done.items()):
        keep(case, front)
    waiting = [case for case in cases if case not in done]
    if executor is None:
        for case in waiting:
            front = case.run()
            _save(folder, case, front)
            keep(case, front)
    else:
        futures = {executor.submit(Case.run, case): case for case in waiting}
        try:
            for future in _as_completed(futures):
                front = future.result()
                _save(folder, futures[future], front)
                keep(futures[future], front)
        finally:                                         # an interrupted study starts nothing more
            for future in futures:
                future.cancel()
    return {case: done[case] for case in cases}


def _as_completed(futures):
    """Futures as they finish; a Dask executor's are not those of concurrent.futures, but have the same methods."""
    finished = queue.SimpleQueue()
    for future in futures:
        future.add_done_callback(finished.put)
    for _ in futures:
        yield finished.get()


def _save(folder, case, front):
    """Write a front's designs to its own file: complete or not at all."""
    if folder is None:
        return
    values = {name: np.broadcast_to(getattr(front.designs, name), front.designs.shape).tolist() for name in DESIGN_SPACE}
    text = json.dumps({"case": case.label, "message": front.message, "designs": values,
                       "objective_history": [F.tolist() for F in front.objective_history]})
    part = folder / f".{case.label}.{os.getpid()}.part"
    part.write_text(text, encoding="utf-8")
    os.replace(part, folder / f"{case.label}.json")


def _load(folder, case):
    """A front from its file, its performance evaluated anew; None where there is no sound file."""
    if folder is None or not (folder / f"{case.label}.json").exists():
        return None
    try:
        kept = json.loads((folder / f"{case.label}.json").read_text(encoding="utf-8"))
        designs = Design(**{name: np.array(kept["designs"][name], float) for name in DESIGN_SPACE})
        history = tuple(np.array(F, float).reshape(len(F), len(case.scenario.problem.objectives))
                        for F in kept["objective_history"])
        message = str(kept["message"])
    except (ValueError, KeyError, TypeError) as error:
        warnings.warn(f"{case.label}.json in {folder} is damaged and computed anew: {error}", UserWarning, stacklevel=3)
        return None
    model = dataclasses.replace(case.model, shear_scale=case.shear_scale)
    scenario, problem = posed(dataclasses.replace(case.scenario, required_obstacle_height_m=case.obstacle_height_m),
                            seed=case.seed)
    return Front(designs, evaluate(designs, scenario, model), scenario, model, problem, history, message)
