"""Many searches: one call for every combination of scenario, seed, shear scale and obstacle height, two at a time."""
from __future__ import annotations

import dataclasses
from collections.abc import Iterable
from concurrent.futures import BrokenExecutor, Executor, ProcessPoolExecutor

from rdk._fields import check, require, whole
from rdk.design import Model, Scenario
from rdk.tradespace import Front, budget, pareto_front


@dataclasses.dataclass(frozen=True, eq=False, repr=False)
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

    def __repr__(self):
        return (f"Case({self.scenario.name!r}, seed={self.seed}, shear_scale={self.shear_scale:g}, "
                f"obstacle_height_m={self.obstacle_height_m:g})")

    def run(self) -> Front:
        """The front of this case; the same bits wherever it runs."""
        scenario = dataclasses.replace(self.scenario, required_obstacle_height_m=self.obstacle_height_m)
        model = dataclasses.replace(self.model, shear_scale=self.shear_scale)
        return pareto_front(scenario, population=self.population, generations=self.generations, seed=self.seed,
                            start=self.start, model=model, warn=False)


def fronts(scenarios: Iterable[Scenario], *, seeds: Iterable[int] | None = None, shear_scales: Iterable[float] = (1.0,),
           obstacle_heights_m: Iterable[float] = (0.0,), population: int | None = None, generations: int | str = 60,
           start: str | None = None, model: Model = Model(), executor=None) -> dict[Case, Front]:
    """Fronts for every combination of scenario, seed, shear scale and obstacle height, in that order.

    The seeds are each scenario's own by default, 0 where it has none; `start` is "light" or None; the shear scales
    replace the model's. An `executor` runs the fronts in parallel, with the same result: `two_at_a_time`, or a Dask
    client's `get_executor()`. `Front.save` keeps one front in a file.
    """
    if isinstance(scenarios, (Scenario, str)):
        single = getattr(scenarios, "name", scenarios)
        raise ValueError(f"scenarios must be a list of Scenario; got the single {single!r}")
    if not (start is None or isinstance(start, str) and start == "light"):
        raise ValueError(f"start must be 'light' or None; got {start!r}")
    population = budget(population, generations)[0]
    lists = {name: list(values) for name, values in dict(
        scenarios=scenarios, seeds=(None,) if seeds is None else seeds, shear_scales=shear_scales,
        obstacle_heights_m=obstacle_heights_m).items()}
    for name, values in lists.items():
        if not values:
            raise ValueError(f"{name} must not be empty")
    require(model=(model, Model), **{f"scenarios[{i}]": (s, Scenario) for i, s in enumerate(lists["scenarios"])})
    # refuse a bad value now, not after an hour
    seeds = [whole("seeds", s, optional=True) for s in lists["seeds"]]
    scales = [check("shear_scales", s, above=0, scalar=True) for s in lists["shear_scales"]]
    heights = [check("obstacle_heights_m", h, 0, scalar=True) for h in lists["obstacle_heights_m"]]
    cases = [Case(scenario, (scenario.problem.seed or 0) if seed is None else seed, scale, height, population,
                  generations, start, model)
             for scenario in lists["scenarios"] for seed in seeds for scale in scales for height in heights]
    return dict(zip(cases, (map if executor is None else executor.map)(Case.run, cases)))


class TwoAtATime(Executor):
    """Two processes that start with the first search and end with the kernel; new ones after an interruption."""

    def __init__(self):
        self.pool = ProcessPoolExecutor(2)

    def submit(self, function, /, *arguments, **options):
        try:
            return self.pool.submit(function, *arguments, **options)
        except BrokenExecutor:
            self.pool = ProcessPoolExecutor(2)
            return self.pool.submit(function, *arguments, **options)

    def shutdown(self, wait=True, *, cancel_futures=False):
        self.pool.shutdown(wait, cancel_futures=cancel_futures)


two_at_a_time = TwoAtATime()
