"""What searches say about designs: rules read off fronts, and how far to trust them, as tables.

A rule is a statistic of a front; a table has one row a front, a design or an input. A single search is one draw from a
noisy process, so the tables keep the seed; and a search that is not finished leaves variables that no objective feels
where chance put them.
"""
from __future__ import annotations

import warnings
from collections.abc import Iterable

import numpy as np
import pandas as pd

from rdk._fields import check, listed, require, unknown
from rdk.design import DESIGN_SPACE, Design, Model, Scenario
from rdk.mission import evaluate, mass_of
from rdk.tradespace import Front, beaten, minimised

SHEAR_SCALES = (0.70, 0.85, 1.00, 1.15, 1.30)
"""Factors on the shear stress in the paper's robustness study."""
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
    rows, fronts = [], listed("fronts", fronts, Front)
    if not fronts:
        raise ValueError("fronts must hold at least one Front; got none")
    for front in fronts:
        d, p = front.designs, front.performance
        row = {"scenario": front.scenario.name, "seed": front.problem.seed, "shear_scale": front.model.shear_scale,
               "obstacle_height_m": front.scenario.required_obstacle_height_m,
               "generations": len(front.objective_history), "designs": len(front)}
        if len(front):
            width, slope = place(d, "wheel_width_m"), p.slope_capability_deg
            at_ceiling = {name: np.mean(place(d, name) >= 1 - CEILING_SHARE) for name in DESIGN_SPACE}
            row |= {"range_min_km": p.range_km.min(), "range_max_km": p.range_km.max(),
                    "range_lightest_km": p.range_km[0],
                    "mass_min_kg": p.total_mass_kg.min(), "mass_max_kg": p.total_mass_kg.max(),
                    "slope_min_deg": slope.min(), "slope_median_deg": np.median(slope), "slope_max_deg": slope.max(),
                    "slope_at_cap_deg": np.median(slope[p.range_km >= p.range_km.max() * (1 - 1e-6)]),
                    "four_wheels": np.mean(d.wheel_count == 4), "radius_at_ceiling": at_ceiling["wheel_radius_m"],
                    "grouser_height_at_ceiling": at_ceiling["grouser_height_m"],
                    "grouser_count_at_ceiling": at_ceiling["grouser_count"],
                    "width_at_floor": np.mean(width <= CEILING_SHARE), "width_lowest_5pct": np.mean(width <= 0.05),
                    "radius_median_m": np.median(d.wheel_radius_m), "width_median_m": np.median(d.wheel_width_m),
                    "battery_median_wh": np.median(d.battery_capacity_wh),
                    "array_median_m2": np.median(d.solar_area_m2), "hypervolume": front.history[-1]}
        rows.append(row)
    return pd.DataFrame(rows)


def require_table(name: str, table: pd.DataFrame, source: str, *columns: str) -> None:
    """Refuse what is no table with these columns, as `source` makes it."""
    missing = [column for column in columns if column not in getattr(table, "columns", ())]
    if missing:
        raise ValueError(f"{name} must be a table of {source}; it has no column {', '.join(missing)}")


def place(designs: Design, name: str) -> np.ndarray:
    """Where a variable lies in its searched range, 0 to 1."""
    require(designs=(designs, Design))
    if name not in list(DESIGN_SPACE):
        raise unknown("no design variable", name, list(DESIGN_SPACE))
    variable = DESIGN_SPACE[name]
    return (getattr(designs, name) - variable.low) / (variable.high - variable.low)


def crossover(statistics: pd.DataFrame) -> pd.DataFrame:
    """Lowest required obstacle height at which rocker-bogie designs enter, from `front_statistics` at several heights.

    One row a scenario: scenario, crossover_m (NaN if they never do), highest_rigid_m, the largest height at which a
    four-wheel design is still on the front.
    """
    require_table("statistics", statistics, "front_statistics", "scenario", "obstacle_height_m", "four_wheels")
    height, four = statistics.obstacle_height_m, statistics.four_wheels
    heights = pd.DataFrame(dict(crossover_m=height.where(four < 1), highest_rigid_m=height.where(four > 0)))
    by_scenario = heights.groupby(statistics.scenario, sort=False)
    return by_scenario.agg(dict(crossover_m="min", highest_rigid_m="max")).reset_index()


def dominated(front: Front, others: Iterable[Front]) -> np.ndarray:
    """Which designs of a front, shape (n,), a design of other fronts dominates in the front's own objectives."""
    require(front=(front, Front))
    mine, *theirs = (minimised(one.performance, front.problem.objectives)
                     for one in (front, *listed("others", others, Front)))
    return beaten(mine, np.concatenate([mine[:0], *theirs]))


# ---- what a variable is worth ------------------------------------------------------------------------------

def ballasted(designs: Design, scenario: Scenario, total_mass_kg, *, model: Model = Model()) -> Design:
    """Designs brought to a total mass by their chassis alone, so that a variable can be judged at equal mass.

    Where even the lightest chassis of the design space is too heavy, that chassis is taken and the design stays heavier
    than wanted. The scenario gives the payload.
    """
    require(designs=(designs, Design), scenario=(scenario, Scenario), model=(model, Model))
    chassis_kg = DESIGN_SPACE["chassis_mass_kg"].low
    lightest, heavier = (mass_of(designs.replace(chassis_mass_kg=kg), scenario, model).total_kg
                         for kg in (chassis_kg, chassis_kg + 1))
    # total mass is linear in the chassis
    extra = np.maximum((check("total_mass_kg", total_mass_kg, above=0) - lightest) / (heavier - lightest), 0)
    return designs.replace(chassis_mass_kg=chassis_kg + extra)


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
        designs = ballasted(front.designs.replace(**changes), front.scenario, old.total_mass_kg, model=front.model)
        new = evaluate(designs, front.scenario, model=front.model)
    return pd.DataFrame(dict(
        total_mass_kg=old.total_mass_kg, **{f"old_{name}": getattr(front.designs, name) for name in changes},
        range_change_km=new.range_km - old.range_km, mass_change_kg=new.total_mass_kg - old.total_mass_kg,
        slope_change_deg=new.slope_capability_deg - old.slope_capability_deg))
