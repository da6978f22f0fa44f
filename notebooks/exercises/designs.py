"""Exercises of notebooks 06 to 08: one design, Pareto fronts, and design rules."""
from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np

import rules
from rdk import catalog, terramechanics
from rdk.design import DESIGN_SPACE, Design, Model
from rdk.mission import evaluate
from rdk.sampling import attribution, intervals
from rdk.tradespace import pareto_front

from .judging import Exercise
from .shared import first, mare, rashid

EXERCISES = {}
"""The exercises of these notebooks by number."""


# ---- 06 point design ---------------------------------------------------------------------------------------

_BINDS = ("soil", "traction", "torque", "hub speed", "sun", "battery", "range limit")


@cache
def _polar_slopes():
    slopes_deg = np.arange(36.0)
    return slopes_deg, evaluate(rashid(), replace(catalog.scenario("polar_prospecting"),
                                                   slope_deg=slopes_deg))


@cache
def _missed_pct():
    """Share of draws, in percent, in which the slope capability of Rashid-1 misses the mare mission's slope."""
    return 100 * np.mean(intervals(rashid(), mare()).draws.slope_capability_deg < 15)


@cache
def _torque_shares(swapped=False):
    """What the torque of Yutu-2 gets in its difference to Rashid-1 at the pole, and what it brings alone."""
    polar, pair = catalog.scenario("polar_prospecting"), (catalog.rover("Yutu-2"), rashid())
    large, small = pair[::-1] if swapped else pair
    shares = attribution(large, small, polar).contributions["range_km"]
    alone = evaluate(replace(small, peak_wheel_torque_nm=large.peak_wheel_torque_nm), polar)
    return [shares[list(DESIGN_SPACE).index("peak_wheel_torque_nm")],
            alone.range_km - evaluate(small, polar).range_km]


def _tenacious_mended(design):
    tenacious = catalog.rover("Tenacious")
    changed = [name for name in DESIGN_SPACE if getattr(design, name) != getattr(tenacious, name)]
    if len(changed) > 2:
        return "You changed " + ", ".join(changed) + "."
    result = evaluate(design, mare())
    if result.stalled:
        return "It stalls: " + ("the hub is too weak."
                                if result.wheel_torque_nm > design.peak_wheel_torque_nm else "no grip.")
    if result.total_mass_kg > 11.5:
        return f"It weighs {result.total_mass_kg:.2f} kg, {1000 * (result.total_mass_kg - 11.5):.0f} g too much."
    return "" if result.range_km >= 50 else f"It drives {result.range_km:.0f} km: what binds now?"


EXERCISES["06.1"] = Exercise(
    "word", lambda: "sun", "The bold line at the top of the answers names it.",
    {"The pack is empty for hours, but more of it would not help: there is nothing to fill it.":
        lambda: "battery",
     "It stands still, yet its wheels could climb: look at 'stalled'.": lambda: "traction",
     "The read-outs show that the hub gives enough.": lambda: "torque"}, choices=_BINDS)

EXERCISES["06.2"] = Exercise(
    "number", lambda: first(_polar_slopes()[0], _polar_slopes()[1].stalled),
    "Move the slope until 'stalled' says yes.",
    {"That is the slope capability, rounded up; it is taken at slip 0.6, and the rover may slip more.":
        lambda: np.ceil(_polar_slopes()[1].slope_capability_deg[0]),
     "There it still drives, if slowly.": lambda: first(_polar_slopes()[0], _polar_slopes()[1].stalled) - 1},
    within=0.005)

EXERCISES["06.3"] = Exercise(
    "number", _missed_pct, "The share of draws below the limit, times 100.",
    {"That is the tail of the interval, not the share below the limit.": lambda: 5.0,
     "Those that make it; the question is about those that miss.": lambda: 100 - _missed_pct(),
     "As a share; the question asks for percent.": lambda: _missed_pct() / 100,
     "Those that stall; slope capability is judged at slip 0.6.":
        lambda: 100 * intervals(rashid(), mare()).low["stalled"]}, within=0.03)

EXERCISES["06.4"] = Exercise(
    "2 numbers", _torque_shares,
    "The bar of the view 'why', then the change of range when torque alone is changed.",
    {"From Rashid-1 to Yutu-2, not back: Rashid-1 is the baseline.": lambda: _torque_shares(True),
     "First the share, then the gain alone.": lambda: _torque_shares()[::-1]}, within=0.05)

EXERCISES["06.5"] = Exercise(
    "Design", lambda: replace(catalog.rover("Tenacious"), wheel_radius_m=0.08, peak_wheel_torque_nm=0.2), "",
    {"the hub is too weak": lambda: replace(catalog.rover("Tenacious"), wheel_radius_m=0.1),
     "what binds now": lambda: replace(catalog.rover("Tenacious"), peak_wheel_torque_nm=0.3),
     "It weighs": lambda: replace(catalog.rover("Tenacious"), wheel_radius_m=0.12, peak_wheel_torque_nm=0.4),
     "no grip": lambda: replace(catalog.rover("Tenacious"), grouser_height_m=0.0, peak_wheel_torque_nm=0.4),
     "You changed": lambda: rashid(wheel_radius_m=0.08)}, judge=_tenacious_mended)


# ---- 07 Pareto fronts --------------------------------------------------------------------------------------

@cache
def _front(scenario="equatorial_mare_traverse", seed=13, six=False, goals=None, least_slope_deg=None):
    """A front of the notebook's budget."""
    return pareto_front(
        catalog.scenario(scenario), seed=seed, bounds={"wheel_count": (6, 6)} if six else None,
        objectives=dict(goals) if goals else None,
        constraints=[("slope_capability_deg", ">=", least_slope_deg)] if least_slope_deg else None)


def _mass_at(front, slope_deg=32):
    p = front.performance
    order = np.argsort(p.slope_capability_deg)
    return np.interp(slope_deg, p.slope_capability_deg[order], p.total_mass_kg[order])


@cache
def _late_polar():
    """Lightest mass and median battery when five polar fronts are merged and searched on."""
    five = [_front("polar_prospecting", seed).designs for seed in (12, 13, 14, 15, 112)]
    merged = Design(**{name: np.concatenate([getattr(design, name) for design in five])
                       for name in DESIGN_SPACE})
    late = pareto_front(catalog.scenario("polar_prospecting"), population=80, seed=1, start=merged)
    return [late.performance.total_mass_kg.min(), np.median(late.designs.battery_capacity_wh)]


def _settled(answer):
    lightest_kg, battery_wh = answer
    if not 8 < lightest_kg < 10.5:
        return "The first number should be the mass of the lightest design, in kg, after the merged search."
    return "" if 5 <= battery_wh < 75 else (
        "The second number should be the median battery after the long search; it has not come down yet.")


_FLOAT = (("range_km", "max"), ("total_mass_kg", "min"), ("sinkage_m", "min"))


def _floaters(goals=_FLOAT):
    """Mass of the heaviest design, in kg, and width of the widest wheel, in mm."""
    front = _front(goals=goals, least_slope_deg=25)
    return [front.performance.total_mass_kg.max(), 1000 * front.designs.wheel_width_m.max()]


EXERCISES["07.1"] = Exercise(
    "number", lambda: 85 - mare().traverse_limit_km,
    "Read the message: it says how close the nearest design came.",
    {"So far the nearest design came; by how much did it miss?": lambda: mare().traverse_limit_km,
     "That is what you asked for.": lambda: 85.0,
     "No design meets the demand; the question is by how much the nearest missed it.": lambda: 0.0},
    within=0.001)

EXERCISES["07.2"] = Exercise(
    "number", lambda: _front().history[-1],
    "The share of the darts that land in the dominated part, times the box.",
    {"That is the share of the darts; the box is larger than 1.": lambda: _front().history[-1] / 1.05**3,
     "That is the part of the box that is not dominated.": lambda: 1.05**3 - _front().history[-1]},
    within=0.03)

EXERCISES["07.3"] = Exercise(
    "2 numbers", lambda: [_mass_at(_front()), _mass_at(_front(six=True))],
    "Sort each front by slope capability and interpolate its mass at 32 deg.",
    {"Those are the lightest of each front; they do not climb alike.":
        lambda: [_front().performance.total_mass_kg.min(), _front(six=True).performance.total_mass_kg.min()],
     "The other way round: first four wheels, then six.":
        lambda: [_mass_at(_front(six=True)), _mass_at(_front())]}, within=0.1)

EXERCISES["07.4"] = Exercise(
    "2 numbers", _late_polar, "",
    {"the mass of the lightest design": lambda: [12.0, 6.0],
     "it has not come down yet": lambda: [9.5, 150.0]}, judge=_settled)

EXERCISES["07.5"] = Exercise(
    "2 numbers", _floaters, "Objectives range, mass and sinkage; the slope is a constraint now.",
    {"That is the front with slope capability as an objective: ballast buys slope there.":
        lambda: _floaters((("range_km", "max"), ("total_mass_kg", "min"), ("slope_capability_deg", "max"))),
     "First the mass, then the width.": lambda: _floaters()[::-1]}, within=0.15)


# ---- 08 design rules ---------------------------------------------------------------------------------------

EXERCISES["08.1"] = Exercise(
    "number", lambda: 0.15 * Model().rigid_obstacle_ratio,
    "Obstacle height is the wheel radius times a ratio that depends on the suspension.",
    {"That is for a rocker-bogie; the question is about a rigid chassis on four wheels.":
        lambda: 0.15 * Model().rocker_bogie_obstacle_ratio,
     "A rigid rover does not climb as high as its wheel's radius.": lambda: 0.15,
     "That is for the largest wheel of the search; this lander leaves room for a smaller one.": lambda: 0.1},
    within=0.005)

@cache
def _wasteful_pct(gain_km=1e-6):
    """Share of the mare front, in percent, that drives further with less avionics and more chassis."""
    return 100 * np.mean(rules.swapped(_front(), avionics_power_w=5.0).range_change_km > gain_km)


EXERCISES["08.2"] = Exercise(
    "number", _wasteful_pct,
    "A row of `swapped` is a design of the front; the share of rows with a longer range, times 100.",
    {"Those drive no further: they are at the limit already.": lambda: 100 - _wasteful_pct(),
     "As a share; the question asks for percent.": lambda: _wasteful_pct() / 100,
     "That many gain more than a kilometre; any gain counts.": lambda: _wasteful_pct(1.0)}, within=0.01)


@cache
def _indifferent_k_mm():
    """The shear modulus at which wheels of 30 and 80 mm climb the same slope."""
    from scipy.optimize import brentq
    wheel = terramechanics.Wheel(0.2, [0.03, 0.08], 0.02, 24)

    def lead(k_mm):
        soil = replace(catalog.soil("apollo-nominal"), shear_modulus_mm=k_mm)
        narrow, wide = terramechanics.slope_capability(wheel, soil, 5.0, capability_limit_deg=80)
        return narrow - wide

    return brentq(lead, 2, 18)


EXERCISES["08.3"] = Exercise(
    "number", _indifferent_k_mm,
    "Compute both slope capabilities over shear moduli from 2 to 18 mm and look for the sign change.",
    {"In millimetres, please.": lambda: _indifferent_k_mm() / 1000,
     "That is the modulus of the mare soil itself, where narrow wins.": lambda: 18.0,
     "That soil's modulus was measured, but it is not where the two wheels are equal.": lambda: 11.0})


def _presses_softly(design):
    """What the design of exercise 08.4 still misses, or ""."""
    p = evaluate(design, catalog.scenario("equatorial_mare_traverse"))
    if p.stalled or p.range_km < 80 - 1e-9:
        return f"It drives {p.range_km:.1f} km" + (" because it stalls." if p.stalled
                                                   else ", short of the limit.")
    if p.ground_pressure_kpa > 2:
        return f"It presses too hard, {p.ground_pressure_kpa:.2f} kPa: wider or larger wheels, or less mass."
    if p.slope_capability_deg < 30:
        return f"It climbs {p.slope_capability_deg:.1f} deg only: grousers and radius are cheap traction."
    return "" if p.total_mass_kg <= 15 else f"It weighs {p.total_mass_kg:.1f} kg: look at the mass breakdown."


def _soft():
    return Design(wheel_radius_m=0.2, wheel_width_m=0.055, grouser_height_m=0.02, grouser_count=24,
                  wheel_count=4,
                  chassis_mass_kg=0.5, wheelbase_m=0.6, solar_area_m2=0.12, battery_capacity_wh=10,
                  avionics_power_w=6, peak_wheel_torque_nm=1.0)


EXERCISES["08.4"] = Exercise(
    "Design", _soft, "",
    {"It presses too hard": lambda: replace(_soft(), wheel_width_m=0.03),
     "It climbs": lambda: replace(_soft(), grouser_height_m=0.01),
     "because it stalls": lambda: replace(_soft(), peak_wheel_torque_nm=0.1),
     "short of the limit": lambda: replace(_soft(), avionics_power_w=40.0),
     "look at the mass breakdown": lambda: replace(_soft(), wheel_width_m=0.09, chassis_mass_kg=3.0)},
    judge=_presses_softly)
