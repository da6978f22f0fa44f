"""Many Pareto fronts at once: in parallel, kept in files, resumed after an interruption."""
from __future__ import annotations

import dataclasses
import hashlib
import queue
import re
import sys
import warnings
from collections.abc import Callable, Iterable
from pathlib import Path

import numpy as np

from ._fields import check
from .design import Model, Scenario
from .tradespace import Front, budget, pareto_front


@dataclasses.dataclass(frozen=True, eq=False)
class Case:
    """One front of `fronts`: everything that `pareto_front` needs, so that it can run anywhere."""
    scenario: Scenario
    seed: int
    shear_scale: float
    obstacle_height_m: float
    population: int
    generations: int | str
    start: str | None
    model: Model

    def run(self) -> Front:
        """The front of this case; the same bits wherever it runs."""
        scenario = dataclasses.replace(self.scenario, required_obstacle_height_m=self.obstacle_height_m)
        model = dataclasses.replace(self.model, shear_scale=self.shear_scale)
        return pareto_front(scenario, population=self.population, generations=self.generations, seed=self.seed,
                            start=self.start, model=model, warn=False)

    @property
    def label(self) -> str:
        """A readable name, also of the case's file, with a hash of everything that determines the front."""
        with np.printoptions(threshold=sys.maxsize):
            key = hashlib.sha256(repr(dataclasses.astuple(self)).encode()).hexdigest()[:16]
        name = re.sub(r"[^A-Za-z0-9_.-]+", "-", self.scenario.name)[:60]     # a name is free text, a file's is not
        return (f"{name}_seed{self.seed}_shear{self.shear_scale:g}_obstacle{self.obstacle_height_m:g}"
                f"_{self.population}x{self.generations}_{key}")

    def load(self, folder: Path) -> Front | None:
        """The front from its file, its performance evaluated anew; None where there is no sound file."""
        path = folder / f"{self.label}.json"
        try:
            return Front.load(path) if path.exists() else None
        except ValueError as error:
            warnings.warn(f"{path.name} in {folder} is damaged and computed anew: {error}", UserWarning, stacklevel=3)
            return None


def fronts(scenarios: Iterable[Scenario], *, seeds: Iterable[int] | None = None, shear_scales: Iterable[float] = (1.0,),
           obstacle_heights_m: Iterable[float] = (0.0,), population: int | None = None, generations: int | str = 60,
           start: str | None = None, model: Model = Model(), executor=None, folder: str | Path | None = None,
           on_front: Callable | None = None) -> dict[Case, Front]:
    """Fronts for every combination of scenario, seed, shear scale and obstacle height, in that order.

    Parameters
    ----------
    seeds : sequence of int, optional
        Default: each scenario's own seed, 0 where it has none.
    population, generations, start
        As in `pareto_front`; `start` is "light" or None.
    model : Model
        Its `shear_scale` is replaced.
    executor : concurrent.futures.Executor, optional
        Runs the fronts in parallel: a ProcessPoolExecutor, or a Dask client's `get_executor()`. The result is the
        same. Default: one after the other, here.
    folder : path-like, optional
        Keeps each finished front in a file of its own, written atomically. Run again with the same folder, what is
        there is loaded and only the rest computed; a damaged file is computed anew.
    on_front : callable, optional
        Called with (finished, total, case, front) as each front finishes.
    """
    if isinstance(scenarios, Scenario):
        raise ValueError(f"scenarios must be a list of Scenario; got the single {scenarios.name!r}")
    if not (start is None or isinstance(start, str) and start == "light"):
        raise ValueError(f"start must be 'light' or None; got {start!r}")
    population = budget(population, generations)[0]
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
                  generations, start, model)
             for scenario in lists["scenarios"] for seed in seeds for scale in scales for height in heights]
    done, finished = {}, 0

    def keep(case, front, new=True):
        nonlocal finished
        if new and folder is not None:
            front.save(folder / f"{case.label}.json")
        done[case] = front
        finished += 1
        if on_front is not None:
            on_front(finished, len(cases), case, front)

    if folder is not None:
        folder = Path(folder)
        folder.mkdir(parents=True, exist_ok=True)
        for case in cases:
            front = case.load(folder)
            if front is not None:
                keep(case, front, new=False)
    waiting = [case for case in cases if case not in done]
    if executor is None:
        for case in waiting:
            keep(case, case.run())
    else:
        futures = {executor.submit(Case.run, case): case for case in waiting}
        finished_ones = queue.SimpleQueue()              # a Dask executor's futures share only this with the others
        for future in futures:
            future.add_done_callback(finished_ones.put)
        try:
            for _ in futures:
                future = finished_ones.get()
                keep(futures[future], future.result())
        finally:                                         # an interrupted run starts nothing more
            for future in futures:
                future.cancel()
    return {case: done[case] for case in cases}
