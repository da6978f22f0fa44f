"""What searches say about designs: rules read off fronts, and how far to trust them, as tables.

A rule is a statistic of a front. Each function takes fronts, or runs the searches it needs, and returns a
tidy pandas table: one row a front, a design or an input. A single search is one draw from a noisy
process, so the tables keep the seed; and a search that is not finished leaves variables that no objective
feels where chance put them.
"""
from __future__ import annotations

import dataclasses
import warnings
from collections.abc import Iterable

import numpy as np
import pandas as pd

from . import catalog
from ._fields import check, require, unknown
from .design import DESIGN_SPACE, Design, Model, Scenario
from .mission import evaluate, mass_of
from .sampling import METRICS, decode, replaced
from .tradespace import Front, beaten, minimised, pareto_front
from .uncertainty import inputs_at, uncertain_names

SHEAR_SCALES = (0.70, 0.85, 1.00, 1.15, 1.30)
"""Factors on the shear stress in the paper's robustness study."""
OBSTACLE_HEIGHTS_M = tuple(round(0.02 * i, 2) for i in range(12))
"""Required obstacle heights of the paper's architecture study, 0 to 0.22 m."""
CEILING_SHARE = 0.01
"""A variable is at a bound when within this share of its searched range from it; the paper names no share."""


# ---- statistics of fronts ----------------------------------------------------------------------------------

def front_statistics(fronts: Iterable[Front]) -> pd.DataFrame:
    """What the designs of each front have in common, one row a front; NaN where it is empty.

    scenario, seed, shear_scale, obstacle_height_m, generations, designs; smallest and largest range, mass and slope
    capability (`range_min_km` ...), median slope capability and the slope capability of the designs at the largest
    range (median, `slope_at_cap_deg`); range of the lightest design; share with four wheels; shares at a bound: wheel
    radius, grouser height and grouser count at their ceilings, wheel width at its floor (all within 1 % of the searched
    range) and in the lowest 5 % of it; medians of battery, array, radius and width; hypervolume.
    """
    def at_ceiling(name):
        return np.mean(place(front.designs, name) >= 1 - CEILING_SHARE)

    rows = []
    for front in fronts:
        d, p = front.designs, front.performance
        row = {"scenario": front.scenario.name, "seed": front.problem.seed, "shear_scale": front.model.shear_scale,
               "obstacle_height_m": front.scenario.required_obstacle_height_m,
               "generations": len(front.objective_history), "designs": len(front)}
        if len(front):
            width, slope = place(d, "wheel_width_m"), p.slope_capability_deg
            row |= {"range_min_km": p.range_km.min(), "range_max_km": p.range_km.max(),
                    "range_lightest_km": p.range_km[0],
                    "mass_min_kg": p.total_mass_kg.min(), "mass_max_kg": p.total_mass_kg.max(),
                    "slope_min_deg": slope.min(), "slope_median_deg": np.median(slope), "slope_max_deg": slope.max(),
                    "slope_at_cap_deg": np.median(slope[p.range_km >= p.range_km.max() * (1 - 1e-6)]),
                    "four_wheels": np.mean(d.wheel_count == 4),
                    "radius_at_ceiling": at_ceiling("wheel_radius_m"),
                    "grouser_height_at_ceiling": at_ceiling("grouser_height_m"),
                    "grouser_count_at_ceiling": at_ceiling("grouser_count"),
                    "width_at_floor": np.mean(width <= CEILING_SHARE), "width_lowest_5pct": np.mean(width <= 0.05),
                    "radius_median_m": np.median(d.wheel_radius_m), "width_median_m": np.median(d.wheel_width_m),
                    "battery_median_wh": np.median(d.battery_capacity_wh),
                    "array_median_m2": np.median(d.solar_area_m2), "hypervolume": front.history[-1]}
        rows.append(row)
    return pd.DataFrame(rows)


def place(designs: Design, name: str) -> np.ndarray:
    """Where a variable lies in its searched range, 0 to 1."""
    if name not in DESIGN_SPACE:
        raise unknown("no design variable", name, list(DESIGN_SPACE))
    variable = DESIGN_SPACE[name]
    return (getattr(designs, name) - variable.low) / (variable.high - variable.low)


def over_generations(scenarios: Iterable[Scenario], seeds: Iterable[int], generations: Iterable[int], *, executor=None,
                     **options) -> pd.DataFrame:
    """Front statistics of searches (one a scenario and seed) at several generations of each.

    Each search runs to the last of `generations`; its front at generation g is that of a search of g generations.
    `executor`, of concurrent.futures, runs the searches in parallel, with the same result. `options` are passed to
    `pareto_front`, such as `population`.
    """
    jobs = [(scenario, dict(options, seed=seed)) for scenario in scenarios for seed in seeds]
    return front_statistics(sum(searched(jobs, generations, executor), []))


def searched(jobs: list, generations: Iterable[int], executor=None) -> list[list[Front]]:
    """The fronts of each search, a scenario with options of `pareto_front`, at generations in rising order."""
    wanted = sorted({int(check("generations", g, 1, whole=True, scalar=True)) for g in generations})
    run = map if executor is None else executor.map
    return list(run(fronts_at, *zip(*((scenario, wanted, options) for scenario, options in jobs))))


def fronts_at(scenario: Scenario, generations: list, options: dict) -> list[Front]:
    """The fronts of one search at some generations; runs in any process."""
    fronts = []

    def look(progress):
        if progress.generation in generations:
            fronts.append(progress.front())

    pareto_front(scenario, generations=generations[-1], on_generation=look, warn=False, **options)
    return fronts


def crossover(statistics: pd.DataFrame) -> pd.DataFrame:
    """Lowest required obstacle height at which rocker-bogie designs enter, from `front_statistics` at several heights.

    One row a scenario: scenario, crossover_m (NaN if they never do), highest_rigid_m, the largest height at which a
    four-wheel design is still on the front.
    """
    rows = []
    for name, group in statistics.groupby("scenario", sort=False):
        height = group.obstacle_height_m
        rows.append(dict(scenario=name, crossover_m=height[group.four_wheels < 1].min(),
                         highest_rigid_m=height[group.four_wheels > 0].max()))
    return pd.DataFrame(rows)


# ---- what a variable is worth ------------------------------------------------------------------------------

def ballasted(designs: Design, scenario: Scenario, total_mass_kg, *, model: Model = Model()) -> Design:
    """Designs brought to a total mass by their chassis alone, so that a variable can be judged at equal mass.

    Where even the lightest chassis of the design space is too heavy, that chassis is taken and the design stays heavier
    than wanted. The scenario gives the payload.
    """
    require(designs=(designs, Design), scenario=(scenario, Scenario), model=(model, Model))
    light = dataclasses.replace(designs, chassis_mass_kg=DESIGN_SPACE["chassis_mass_kg"].low)
    heavy = dataclasses.replace(designs, chassis_mass_kg=DESIGN_SPACE["chassis_mass_kg"].low + 1)
    lightest = mass_of(light, scenario, model).total_kg
    gain = mass_of(heavy, scenario, model).total_kg - lightest           # total mass is linear in the chassis
    extra = np.maximum((np.asarray(total_mass_kg) - lightest) / gain, 0)
    return dataclasses.replace(designs, chassis_mass_kg=light.chassis_mass_kg + extra)


def swapped(front: Front, **changes: float) -> pd.DataFrame:
    """Every design of a front with some variables changed to new values and the mass made up in the chassis.

    If no objective moves, nothing in the search holds that variable where it is. One row a design: its mass, the old
    values (`old_...`), and by how much range, mass and slope capability change (`range_change_km`, `mass_change_kg`,
    `slope_change_deg`).
    """
    require(front=(front, Front))
    old = front.performance
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)     # the ballast may be a chassis outside the class
        changed = front.designs.replace(**changes)
        new = evaluate(ballasted(changed, front.scenario, old.total_mass_kg, model=front.model), front.scenario,
                       model=front.model)
    return pd.DataFrame(dict(
        total_mass_kg=old.total_mass_kg, **{f"old_{name}": getattr(front.designs, name) for name in changes},
        range_change_km=new.range_km - old.range_km, mass_change_kg=new.total_mass_kg - old.total_mass_kg,
        slope_change_deg=new.slope_capability_deg - old.slope_capability_deg))


def dominated(front: Front, others: Iterable[Front]) -> np.ndarray:
    """Which designs of a front, shape (n,), a design of other fronts dominates in the front's own objectives."""
    mine = minimised(front.performance, front.problem.objectives)
    theirs = np.concatenate([minimised(other.performance, front.problem.objectives) for other in others])
    return beaten(mine, theirs)


# ---- scenario families -------------------------------------------------------------------------------------

def family(name: str, count: int, seed: int = 0) -> list[Scenario]:
    """Scenarios spread over a canonical scenario's family: latitude, duration and slope vary together.

    A Latin hypercube over the ranges of the paper's Table 1; everything else stays as catalogued, the panel
    is tilted anew for each latitude. Same seed, same scenarios.
    """
    from scipy.stats import qmc
    scenario = catalog.scenario(name)
    row = next(row for row in catalog.rows("scenarios.csv") if row["scenario"] == name)
    ranges = [row[f"family_{field}"] for field in ("latitude_deg", "duration_days", "slope_deg")]
    if not all(ranges):
        known = ", ".join(catalog.scenario_names("canonical"))
        raise ValueError(f"scenario {name!r} has no family; choose from {known}")
    count = int(check("count", count, 1, whole=True, scalar=True))
    low, high = np.array([text.split("..") for text in ranges], float).T
    points = qmc.scale(qmc.LatinHypercube(3, rng=np.random.default_rng(seed)).random(count), low, high)
    return [dataclasses.replace(catalog.at_latitude(scenario, latitude), name=f"{name} {i}",
                                duration_earth_days=duration, slope_deg=slope)
            for i, (latitude, duration, slope) in enumerate(points.tolist(), 1)]


# ---- what drives a result ----------------------------------------------------------------------------------

def sobol(scenario: Scenario, *, metrics=("range_km", "total_mass_kg", "slope_capability_deg"),
          design: Design | None = None, count: int = 1024, seed: int = 0, bounds: dict | None = None,
          model: Model = Model()) -> pd.DataFrame:
    """Sobol indices of metrics: the share of their variance that each input explains, by scipy.stats.sobol_indices.

    Over the design variables, uniform in the design space or in narrower `bounds`; or, when a single design is given,
    over the uncertain inputs of `data/uncertainties.csv` for that design. All count * (inputs + 2) points, with count a
    power of 2, are evaluated in one call. Saltelli et al. (2010), doi:10.1016/j.cpc.2009.09.018.

    One row a metric and input: metric, input, first_order, total_order, and the 90 % bootstrap interval of the total
    order, total_low and total_high.
    """
    from scipy.stats import qmc, sobol_indices
    count = int(check("count", count, 2, whole=True, scalar=True))
    if count & (count - 1):
        raise ValueError(f"count must be a power of 2; got {count}")
    for name in metrics:
        if name not in METRICS:
            raise unknown("metrics: no Performance field", name, METRICS)
    names = list(DESIGN_SPACE) if design is None else uncertain_names()
    random = np.random.default_rng(seed)
    # two samples of the unit cube, and the first with one column after the other taken from the second
    A, B = np.hsplit(qmc.Sobol(2 * len(names), rng=random).random(count), 2)
    mixed = [np.where(np.arange(len(names)) == i, B, A) for i in range(len(names))]
    cube = np.concatenate([A, B, *mixed])
    if design is None:
        result = evaluate(decode(cube, bounds), scenario, model=model)
    else:
        *changed, model = replaced(design, scenario, model, inputs_at(cube, scenario, model=model))
        result = evaluate(*changed, model=model)
    values = np.stack([np.asarray(getattr(result, name), float) for name in metrics])
    f_A, f_B, *f_AB = np.split(values, len(names) + 2, axis=1)
    f_AB = np.stack(f_AB)                                # (inputs, metrics, count)

    def indices(lanes):
        found = sobol_indices(n=count, func=dict(f_A=f_A[:, lanes], f_B=f_B[:, lanes], f_AB=f_AB[..., lanes]))
        return np.atleast_2d(found.first_order), np.atleast_2d(found.total_order)

    first, total = indices(np.arange(count))
    again = [indices(random.integers(count, size=count))[1] for _ in range(100)]
    low, high = np.quantile(again, [0.05, 0.95], axis=0)
    return pd.DataFrame([
        dict(metric=metric, input=name, first_order=first[m, i], total_order=total[m, i], total_low=low[m, i],
             total_high=high[m, i])
        for m, metric in enumerate(metrics) for i, name in enumerate(names)])
