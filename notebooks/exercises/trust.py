"""Exercises of notebooks 09 to 11: sensitivity, rediscovery, and the paper's ledger."""
from __future__ import annotations

from dataclasses import replace
from functools import cache

import ledger
import numpy as np
import pandas as pd
import validation
from rediscovery import baselines, unit_cube

from rdk import catalog
from rdk.design import Design, Model
from rdk.mission import evaluate
from rdk.sampling import intervals

from .judging import Exercise
from .shared import mare, rashid

EXERCISES = {}
"""The exercises of these notebooks by number."""


# ---- 09 sensitivity ----------------------------------------------------------------------------------------

EXERCISES["09.1"] = Exercise(
    "number", lambda: np.tan(np.radians(35)) / np.tan(np.radians(46)),
    "The normal stress is the same; only the tangent of the friction angle changes.",
    {"Strength goes with the tangent of the angle, not with the angle.": lambda: 35 / 46,
     "The other way round: from the larger angle to the smaller.":
        lambda: np.tan(np.radians(46)) / np.tan(np.radians(35)),
     "That is the loss; the factor is what is left.": lambda: 1 - np.tan(np.radians(35)) / np.tan(np.radians(46)),
     "Degrees went into a function that takes radians.": lambda: np.tan(35) / np.tan(46),
     "The tangent, not the sine.": lambda: np.sin(np.radians(35)) / np.sin(np.radians(46))}, within=0.01)

@cache
def _stalls_pct(*without):
    """Share of draws, in percent, that stall Rashid-1 on the mare, some inputs held at their nominal values."""
    table = [row for row in catalog.rows("uncertainties.csv") if row["name"] not in without]
    return 100 * intervals(rashid(), mare(), table=table).low["stalled"]


EXERCISES["09.2"] = Exercise(
    "number", lambda: _stalls_pct("friction_angle_deg"), "`low[\"stalled\"]` is the share of draws; times 100.",
    {"That is with every row of the table.": _stalls_pct,
     "As a share; the question asks for percent.": lambda: _stalls_pct("friction_angle_deg") / 100,
     "That holds the shear scale instead.": lambda: _stalls_pct("shear_scale")}, within=0.1)


def _capabilities(*angles_deg):
    """Slope capability of Rashid-1 on the mare at friction angles."""
    soil = replace(mare().soil, friction_angle_deg=np.array(angles_deg, float))
    return evaluate(rashid(), mare(soil=soil)).slope_capability_deg


EXERCISES["09.3"] = Exercise(
    "3 numbers", lambda: _capabilities(46, 35, 41),
    "Replace the friction angle in the scenario's soil and read slope_capability_deg.",
    {"In the order of the question, not by size.": lambda: _capabilities(35, 41, 46),
     "Not in proportion to the angle, nor to its tangent: pull is grip less resistance.":
        lambda: _capabilities(46) * np.tan(np.radians([46, 35, 41])) / np.tan(np.radians(46))}, within=0.01)


def _climbs_on_35(design):
    """What the design of exercise 09.4 still misses, or ""."""
    scenario = mare(soil=catalog.soil("sourcebook-trafficability"))
    p = evaluate(design, scenario)
    if p.total_mass_kg > 15:
        return f"It weighs {p.total_mass_kg:.1f} kg."
    if not p.feasible:
        return "It does not drive the mission itself on that soil: " + ("it stalls." if p.stalled
                                                                        else "too little sun.")
    share = intervals(design, scenario, draws=4096).share([("slope_capability_deg", ">=", 12)])
    # 4,096 draws know the share to half a point
    return "" if share >= 0.895 else f"12 degrees hold in {share:.1%} of the draws only: too little margin."


def _climber():
    return Design(wheel_radius_m=0.2, wheel_width_m=0.035, grouser_height_m=0.02, grouser_count=24,
                  wheel_count=4,
                  chassis_mass_kg=1.5, wheelbase_m=0.6, solar_area_m2=0.15, battery_capacity_wh=20,
                  avionics_power_w=6, peak_wheel_torque_nm=2.0)


EXERCISES["09.4"] = Exercise(
    "Design", _climber, "",
    {"It weighs": lambda: replace(_climber(), chassis_mass_kg=5.0),
     "it stalls": lambda: replace(_climber(), peak_wheel_torque_nm=0.1),
     "too little sun": lambda: replace(_climber(), avionics_power_w=32.0),
     "too little margin": lambda: replace(_climber(), grouser_count=12)}, judge=_climbs_on_35)


# ---- 10 rediscovery ----------------------------------------------------------------------------------------

EXERCISES["10.1"] = Exercise(
    "number", lambda: np.sqrt(8 / 6),
    "Mean of (x - y)^2 for uniform x and y, times the dimensions; then the root.",
    {"That is the mean square; take the root.": lambda: 8 / 6,
     "That is the variance of one number; the difference of two has twice as much.": lambda: np.sqrt(8 / 12),
     "That is the diagonal, the largest distance there is.": lambda: np.sqrt(8.0),
     "That is the mean distance, from a simulation; the root mean square has a closed form.": lambda: 1.128},
    within=0.005)

@cache
def _nearest_of(chances, column="nearest_capped"):
    """Mean distance of the nearest of some random designs to Rashid-1."""
    one = pd.DataFrame(dict(rover=["Rashid-1"], front_designs=[chances]))
    return baselines(one, count=8000)[column][0]


EXERCISES["10.2"] = Exercise(
    "number", lambda: _nearest_of(22), "`nearest_capped` of Rashid-1, with 22 in the column `front_designs`.",
    {"That is with 109 chances, those of the five merged fronts.": lambda: _nearest_of(109),
     "That is without the ceiling.": lambda: _nearest_of(22, "nearest_feasible"),
     "That is the 5 % quantile; the mean is asked for.": lambda: _nearest_of(22, "nearest_capped_low")}, within=0.04)


@cache
def _steepest(payload_kg=0.5):
    """The steepest slope that the CADRE unit drives on its polar mission, in degrees."""
    slope_deg = np.arange(0, 20, 0.01)
    mission = replace(catalog.scenario("polar_micro"), payload_mass_kg=payload_kg, slope_deg=slope_deg)
    return slope_deg[~evaluate(catalog.rover("CADRE-unit"), mission).stalled].max()


EXERCISES["10.3"] = Exercise(
    "number", _steepest, "Evaluate over an array of slopes; the last one that is not stalled.",
    {"That is the slope capability, taken at a slip of 0.6. A rover may drive on until it stalls.":
        lambda: evaluate(catalog.rover("CADRE-unit"), replace(
            catalog.scenario("polar_micro"), payload_mass_kg=0.5)).slope_capability_deg,
     "That is the slope of the mission, where it stalls.": lambda: 20.0}, within=0.01)


def _pragyans_neighbour(design):
    """What the design of exercise 10.4 still misses, or ""."""
    pragyan, mission = catalog.rover("Pragyan"), replace(catalog.scenario("polar_micro"), payload_mass_kg=3.5)
    old, new = evaluate(pragyan, mission), evaluate(design, mission)
    if np.linalg.norm(unit_cube(design) - unit_cube(pragyan)) > 0.25:
        return "It is further than 0.25 from Pragyan."
    if new.total_mass_kg > old.total_mass_kg:
        return f"It is heavier by {new.total_mass_kg - old.total_mass_kg:.2f} kg."
    if new.range_km < old.range_km or new.slope_capability_deg < old.slope_capability_deg:
        return "It loses range or slope capability."
    same = (new.range_km, new.total_mass_kg, new.slope_capability_deg) == (
        old.range_km, old.total_mass_kg, old.slope_capability_deg)
    return "It is no better in any of the three." if same else ""


def _better_pragyan(**changes):
    return replace(catalog.rover("Pragyan"), **changes)


EXERCISES["10.4"] = Exercise(
    "Design", lambda: _better_pragyan(grouser_height_m=0.011, grouser_count=18, chassis_mass_kg=9.5), "",
    {"It is further than": lambda: _better_pragyan(wheel_radius_m=0.15),
     "It is heavier by": lambda: _better_pragyan(grouser_height_m=0.011, grouser_count=18),
     "It loses range": lambda: _better_pragyan(grouser_count=10),
     "no better in any": lambda: _better_pragyan(wheelbase_m=0.6)}, judge=_pragyans_neighbour)


# ---- 11 the paper's ledger ---------------------------------------------------------------------------------

EXERCISES["11.1"] = Exercise(
    "2 numbers", lambda: [39 * 0.1, 0.9**39], "First the mean number of failures, then the chance of none.",
    {"The first is the number that should agree; the question asks for those that differ.":
        lambda: [39 * 0.9, 0.9**39],
     "The second is the chance that at least one differs.": lambda: [39 * 0.1, 1 - 0.9**39],
     "All of them must hold, so the chances multiply.": lambda: [39 * 0.1, 0.9]}, within=0.03)


@cache
def _ticks(sections=("terramechanics validation", "mass validation"), **broken):
    """How many deterministic rows of some sections agree with a broken model."""
    return int(ledger.paper_ledger(("deterministic",), ledger.Searches(model=Model(**broken)), sections).agrees.sum())


EXERCISES["11.2"] = Exercise(
    "number", lambda: _ticks(avionics_mass_per_power_kg_w=0.1),
    "Give `Searches` the broken model, `paper_ledger` those searches and the two sections; add up `agrees`.",
    {"That is the number of rows.": lambda: 16.0,
     "That is the number that no longer agree.": lambda: 16 - _ticks(avionics_mass_per_power_kg_w=0.1)}, within=0.001)

EXERCISES["11.3"] = Exercise(
    "True or False", lambda: all(
        ledger.accepts(catalog.table("paper_targets.csv").set_index("id").accept[row], pair)
        for row, pair in (("front_mare_range_km", (0.2, 80.0)), ("front_mare_mass_kg", (9.9, 61.0)))),
    "Read both bands: what do they ask of the smallest value, what of the largest, and what not at all?")


@cache
def _array_densities(every=True):
    """Least and largest areal density of the array, in kg/m2, with which all seven masses (or their median) agree."""
    accept = catalog.table("paper_targets.csv").set_index("id").accept
    rows = dict(tenacious="Tenacious", cadre="CADRE-unit", rashid="Rashid-1", sojourner="Sojourner", pragyan="Pragyan",
                yutu2="Yutu-2", marsokhod="MARSOKHOD")

    def fits(density):
        table = validation.published_masses(Model(solar_areal_density_kg_m2=density)).set_index("rover")
        return np.mean([ledger.accepts(accept["mass_" + name], table.predicted_mass_kg[rover])
                        for name, rover in rows.items()])

    shares = {density: fits(density) for density in np.arange(2.3, 2.701, 0.01).round(2)}
    kept = [density for density, share in shares.items() if share >= (1 if every else 0.5)]
    return [min(kept), max(kept)]


EXERCISES["11.4"] = Exercise(
    "2 numbers", _array_densities, "One call of `published_masses` for each value; keep those with seven agreements.",
    {"With these, half of the rovers agree; the question asks for all seven.": lambda: _array_densities(False),
     "First the lower, then the upper value.": lambda: _array_densities()[::-1]}, within=0.003)
