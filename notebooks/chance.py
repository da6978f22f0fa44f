"""What chance finds: distances of published rovers to random designs, beside those to fronts (notebook 10)."""
from __future__ import annotations

import numpy as np
import pandas as pd

from rdk._fields import generator, whole
from rdk.design import DESIGN_SPACE, Design, Model
from rdk.mission import evaluate, mass_of
from rdk.rediscovery import Target, unit_cube
from rdk.rules import require_table
from rdk.sampling import random_designs


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
        designs = random_designs(100_000, (seed, block), bounds)
        found.append(designs[is_light(designs)])
        block += 1
    joined = {name: np.concatenate([getattr(designs, name) for designs in found]) for name in DESIGN_SPACE}
    return Design(**joined)[:count]
