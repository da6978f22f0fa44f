"""Exercises of notebooks 09 to 11: sensitivity, rediscovery, and the paper's ledger."""
from __future__ import annotations

from dataclasses import replace
from functools import cache

import ledger
import numpy as np

from rdk import catalog
from rdk.design import Design
from rdk.mission import evaluate
from rdk.rediscovery import unit_cube
from rdk.sampling import intervals
from rdk.tradespace import pareto_front

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
     "Degrees went into a function that takes radians.": lambda: np.tan(35) / np.tan(46),
     "The tangent, not the sine.": lambda: np.sin(np.radians(35)) / np.sin(np.radians(46))}, within=0.01)

EXERCISES["09.2"] = Exercise(
    "number", lambda: 0.9**17, "All of them must be inside: multiply.",
    {"That is the chance of one.": lambda: 0.9,
     "That is the chance that at least one is outside.": lambda: 1 - 0.9**17,
     "That is the chance that all are outside.": lambda: 0.1**17}, within=0.02)


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
    low = intervals(design, scenario, level=0.8).low["slope_capability_deg"]
    return "" if low >= 13 else f"Nine of ten draws climb {low:.1f} degrees only: too little margin."


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
     "too little margin": lambda: replace(_climber(), grouser_count=20)}, judge=_climbs_on_35)


# ---- 10 rediscovery ----------------------------------------------------------------------------------------

EXERCISES["10.1"] = Exercise(
    "number", lambda: np.sqrt(8 / 6),
    "Mean of (x - y)^2 for uniform x and y, times the dimensions; then the root.",
    {"That is the mean square; take the root.": lambda: 8 / 6,
     "That is the variance of one number; the difference of two has twice as much.": lambda: np.sqrt(8 / 12),
     "That is the diagonal, the largest distance there is.": lambda: np.sqrt(8.0),
     "That is the mean distance, from a simulation; the root mean square has a closed form.": lambda: 1.128},
    within=0.005)

EXERCISES["10.2"] = Exercise(
    "number", lambda: 0.28**2 * 6,
    "Each dimension is worth one sixth; how many sixths are in the square of the distance?",
    {"The square of the distance, not the distance.": lambda: 0.28 * 6,
     "Divide by 1/6, do not multiply.": lambda: 0.28**2 / 6,
     "That is the share of the eight dimensions, not their number.": lambda: 0.28**2 * 6 / 8}, within=0.01)


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
    "number", lambda: 100 * (0.792 - 0.764) / 0.778, "Width over value, in percent.",
    {"That is half of the width, the distance from the middle.": lambda: 100 * 0.014 / 0.778,
     "In percent of the value, not in units of the hypervolume.": lambda: 0.028,
     "In percent: times one hundred.": lambda: 0.028 / 0.778}, within=0.01)

EXERCISES["11.2"] = Exercise(
    "2 numbers", lambda: [39 * 0.1, 0.9**39], "First the mean number of failures, then the chance of none.",
    {"The first is the number that should agree; the question asks for those that differ.":
        lambda: [39 * 0.9, 0.9**39],
     "The second is the chance that at least one differs.": lambda: [39 * 0.1, 1 - 0.9**39],
     "All of them must hold, so the chances multiply.": lambda: [39 * 0.1, 0.9]}, within=0.03)

EXERCISES["11.3"] = Exercise(
    "True or False", lambda: all(
        ledger.accepts(catalog.table("paper_targets.csv").set_index("id").accept[row], pair)
        for row, pair in (("front_mare_range_km", (0.2, 80.0)), ("front_mare_mass_kg", (9.9, 61.0)))),
    "Read both bands: what do they ask of the smallest value, what of the largest, and what not at all?")


@cache
def _polar_batteries():
    """Median battery of the polar front at three shifts of its seed."""
    polar = catalog.scenario("polar_prospecting")
    return [float(np.median(pareto_front(polar, seed=polar.problem.seed + shift).designs.battery_capacity_wh))
            for shift in (0, 100, 200)]


EXERCISES["11.4"] = Exercise(
    "2 numbers", lambda: [100 * int(np.argmax(_polar_batteries())), max(_polar_batteries())],
    "One search for each shift; the median battery of its designs; the largest of the three.",
    {"That is the smallest of the three.":
        lambda: [100 * int(np.argmin(_polar_batteries())), min(_polar_batteries())],
     "First the shift, then the battery.": lambda: [max(_polar_batteries()),
                                                    100 * int(np.argmax(_polar_batteries()))],
     "That is the paper's own figure, of one seed.": lambda: [0, 150.0]}, within=0.02)
