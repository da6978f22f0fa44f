"""Does a search find rovers that exist? Distances of published rovers to fronts, and to what chance would find."""
from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Sequence

import numpy as np
import pandas as pd

from rdk import catalog
from rdk._fields import check, generator, listed, unknown, whole
from rdk.design import DESIGN_SPACE, Design, Model, Scenario
from rdk.mission import Performance, evaluate, mass_of
from rdk.sampling import decode, random_designs
from rdk.tradespace import beaten, minimised, pareto_front
from rules import place, require_table

REDISCOVERED = {"Tenacious": "mare_micro", "CADRE-unit": "polar_micro", "Rashid-1": "mare_micro",
                "Pragyan": "polar_micro", "MoonRanger": "polar_micro", "Yutu-2": "mare_micro"}
"""Class-generic scenario of each rover of the rediscovery check."""
CUBE = tuple(name for name, v in DESIGN_SPACE.items() if v.kind == "continuous" and name != "wheelbase_m")
"""The eight variables of the rediscovery distance: continuous, and read by some sub-model."""


def rover_row(name: str) -> dict[str, str]:
    """The row of a rover's design vector in `rovers.csv`, as text: published mass, payload, sources."""
    rows = {row["rover"]: row for row in catalog.rows("rovers.csv") if row["use"] == "design vector"}
    if name not in rows:
        raise unknown("no rover", name, rows)
    return rows[name]


def unit_cube(designs: Design) -> np.ndarray:
    """Designs as points of the eight-dimensional unit cube of `CUBE`, shape (n, 8)."""
    return np.stack(np.broadcast_arrays(*(np.atleast_1d(place(designs, name)) for name in CUBE)), axis=1)


@dataclasses.dataclass(frozen=True)
class Target:
    """A published rover on its class-generic mission with its own payload, and its search's mass ceiling."""
    name: str
    scenario: Scenario
    design: Design
    performance: Performance
    ceiling_kg: float

    @classmethod
    def of(cls, name):
        if name not in list(REDISCOVERED):
            raise unknown("the check has no rover", name, list(REDISCOVERED))
        design, payload = catalog.rover(name), float(rover_row(name)["payload_mass_kg"])
        scenario = catalog.scenario(REDISCOVERED[name]).replace(payload_mass_kg=payload)
        performance = evaluate(design, scenario)
        return cls(name, scenario, design, performance, 1.10 * performance.total_mass_kg)

    @property
    def constraints(self):
        return self.scenario.problem.constraints + (("total_mass_kg", "<=", self.ceiling_kg),)

    def distances(self, designs):
        return np.linalg.norm(unit_cube(designs) - unit_cube(self.design), axis=1)


def rediscover(rovers: Iterable[str] = tuple(REDISCOVERED), *, population: int = 60, generations: Sequence[int] = (16,),
               seeds: Sequence[int] = range(5), executor=None) -> pd.DataFrame:
    """Distance of published rovers to the fronts of their missions, under a ceiling of 1.10 times their mass.

    One search a seed, run in parallel by an `executor` of concurrent.futures with the same result; the fronts are
    merged. The paper's figure is at generation 16.

    One row a rover and generation: rover, scenario, in_class, generations, mass_kg, ceiling_kg, feasible (the rover
    itself on that mission), front_designs, distance (to the nearest design of the merged fronts), distance_worst_seed
    (to the nearest of the worst single search), dominated (some front design is no worse in range, mass and slope
    capability and better in one), and `nearest`, the design.
    """
    targets = [Target.of(name) for name in listed("rovers", rovers, str)]
    generations, seeds = (np.unique(check(name, values, low, whole=True)).tolist() for name, values, low in (
        ("generations", generations, 1), ("seeds", seeds, 0)))
    for name, values in dict(rovers=targets, generations=generations, seeds=seeds).items():
        if not values:
            raise ValueError(f"{name} must not be empty")
    jobs = [(target.scenario, generations, dict(population=population, seed=seed, constraints=target.constraints))
            for target in targets for seed in seeds]
    searches = list((map if executor is None else executor.map)(_search, jobs))
    return pd.DataFrame([
        _found(target, fronts) for i, target in enumerate(targets)
        for fronts in zip(*searches[i * len(seeds):(i + 1) * len(seeds)])])


def _search(job):
    """The fronts of one search at generations in rising order; runs in any process."""
    (scenario, wanted, options), fronts = job, []

    def look(progress):
        if progress.generation in wanted:
            fronts.append(progress.front())

    pareto_front(scenario, generations=wanted[-1], on_generation=look, warn=False, **options)
    return fronts


def _found(target, fronts):
    """The row of one rover at one generation."""
    generation, own_row = len(fronts[0].objective_history), rover_row(target.name)
    fronts = [front for front in fronts if len(front)]
    row = dict(rover=target.name, scenario=target.scenario.name, in_class=own_row["in_class"] == "True",
               generations=generation, mass_kg=target.performance.total_mass_kg, ceiling_kg=target.ceiling_kg,
               feasible=target.performance.feasible, front_designs=sum(map(len, fronts)), distance=np.nan,
               distance_worst_seed=np.nan, dominated=False, nearest=None)
    if fronts:
        nearest = [target.distances(front.designs).min() for front in fronts]
        best = fronts[int(np.argmin(nearest))].designs
        own = minimised(target.performance, fronts[0].problem.objectives)
        theirs = np.concatenate([minimised(front.performance, front.problem.objectives) for front in fronts])
        row |= dict(distance=min(nearest), distance_worst_seed=max(nearest),
                    dominated=beaten(own, theirs).item(),
                    nearest=best[int(np.argmin(target.distances(best)))])
    return row


def baselines(found: pd.DataFrame, *, count: int = 20000, seed: int = 0) -> pd.DataFrame:
    """What distances chance gives, for the rovers of a rediscovery check: one row of `rediscover` a rover.

    Its number of front designs sets how many chances chance gets, of `count` random designs. One row a rover: rover,
    random_pair (mean distance of two random points), feasible_fraction (share of random designs that are feasible on
    its mission), feasible_pair (mean distance of two of those), centroid (distance of the rover to their centroid),
    nearest_feasible (mean distance of the nearest of as many random feasible designs as the front has), nearest_capped
    and nearest_capped_low (the same under the rover's mass ceiling, and its 5 % quantile), capped_designs (how many
    random designs met it).
    """
    require_table("found", found, "rediscover", "rover", "front_designs")
    count, seed = whole("count", count, 100), whole("seed", seed)
    random, points, rows = generator(seed), random_designs(count, seed=seed), []
    cube = unit_cube(points)
    for row in found.itertuples():
        target = Target.of(row.rover)
        feasible, light = evaluate(points, target.scenario).feasible, lighter_than(target, count, seed + 1)
        capped = light[evaluate(light, target.scenario).feasible]
        near, near_capped = (_nearest(target.distances(designs), max(row.front_designs, 1), random)
                             for designs in (points[feasible], capped))
        rows.append(dict(
            rover=row.rover, random_pair=_pair(cube, random), feasible_fraction=feasible.mean(),
            feasible_pair=_pair(cube[feasible], random),
            centroid=np.linalg.norm(cube[feasible].mean(0) - unit_cube(target.design)[0]),
            nearest_feasible=near.mean(), nearest_capped=near_capped.mean(),
            nearest_capped_low=np.quantile(near_capped, 0.05), capped_designs=len(capped)))
    return pd.DataFrame(rows)


def _pair(cube, random, pairs=200_000):
    """Mean distance of two different random points of a set."""
    i = random.integers(len(cube), size=pairs)
    j = (i + random.integers(1, len(cube), size=pairs)) % len(cube)
    return np.linalg.norm(cube[i] - cube[j], axis=1).mean()


def _nearest(distances, chances, random, trials=2000):
    """Distance of the nearest of `chances` random picks, in many trials."""
    return distances[random.integers(len(distances), size=(trials, chances))].min(1)


def lighter_than(target: Target, count: int, seed: int) -> Design:
    """Uniform random designs below a rover's mass ceiling, in the box of what each variable may reach alone.

    Total mass rises with every variable: what is light enough lies in that box, so it is uniform in the whole space.
    """
    def is_light(designs):
        return mass_of(designs, target.scenario, Model()).total_kg <= target.ceiling_kg

    low, bounds = {name: v.low for name, v in DESIGN_SPACE.items()}, {}
    for name in ("wheel_radius_m", "wheel_width_m", "chassis_mass_kg", "solar_area_m2", "battery_capacity_wh",
                 "avionics_power_w", "peak_wheel_torque_nm"):
        values = np.linspace(low[name], DESIGN_SPACE[name].high, 1001)
        light = np.flatnonzero(is_light(Design(**low | {name: values})))
        bounds[name] = (low[name], values[min(light[-1] + 1, 1000)] if light.size else low[name])
    bounds["wheel_count"] = (4, 6 if is_light(Design(**low | {"wheel_count": 6})) else 4)
    found, block = [], 0
    while sum(map(len, found)) < count and block < 50:   # few designs are as light as the lightest rovers
        designs = decode(np.random.default_rng((seed, block)).random((100_000, len(DESIGN_SPACE))), bounds)
        found.append(designs[is_light(designs)])
        block += 1
    joined = {name: np.concatenate([getattr(designs, name) for designs in found]) for name in DESIGN_SPACE}
    return Design(**joined)[:count]
