"""Exercises of notebook 13: standing on a slope, sinking, and what a rover weighs of which little is known."""
from __future__ import annotations

from functools import cache

import numpy as np

import registry
from rdk import stability, terramechanics
from rdk.design import Model
from rdk.mission import evaluate

from .judging import Exercise
from .shared import mare, rashid

EXERCISES = {}
"""The exercises of this notebook by number."""

_TRACK_M, _WHEELBASE_M = 0.42, 0.50


def _deeper_pct(quantity="sinkage_m", kernel="imposed-arc", over="front_n"):
    """How much more of something a rear wheel of Rashid-1 has than another, on 25 deg."""
    loads = stability.axle_loads(10.0, rashid().wheelbase_m, 0.2, 25.0, wheel_count=4)
    other = (loads.front_n + loads.rear_n) / 2 if over == "mean" else loads.front_n
    if quantity == "load":
        return 100 * (loads.rear_n / other - 1)
    forces = terramechanics.wheel_forces(rashid().wheel, mare().soil, np.array([loads.rear_n, other]) / 2, 0.4,
                                         kernel=kernel)
    return 100 * (np.divide(*getattr(forces, quantity)) - 1)


@cache
def _shortest(direction="least", bus=True):
    """Shortest wheelbase (m) at which Rashid-1 stands on 45 deg, and the kilograms that it costs over 0.3 m."""
    base = np.linspace(0.3, 0.6, 3001)
    model = Model(frame_mass_kg_m2=2.0)
    result = evaluate(rashid(wheelbase_m=base), mare(), model=model)
    tip = result.tip_over_deg
    if direction == "uphill":
        stand = stability.stance(result.total_mass_kg, result.mass.wheels_kg, rashid().wheel_radius_m,
                                 rashid().wheel_width_m, base, 4)
        tip = stability.tip_over(base, stand.track_m, stand.centre_height_m).uphill_deg
    i = np.argmax(tip >= 45)
    frame = 2.0 * model.track_ratio * (base[i]**2 - base[0]**2)
    return [base[i], result.total_mass_kg[i] - result.total_mass_kg[0] if bus else frame]


def _inside(level=0.5, in_class=True):
    masses = registry.mass_intervals(level=level)
    return masses[masses.in_class] if in_class else masses


EXERCISES["13.1"] = Exercise(
    "number", lambda: _TRACK_M / 2, "At 45 degrees the tangent is one. Which of the two lengths decides?",
    {"That holds it uphill and downhill; across the slope it tips earlier.": lambda: _WHEELBASE_M / 2,
     "The plumb line starts in the middle of the track, not at its edge.": lambda: _TRACK_M}, within=0.005)

EXERCISES["13.2"] = Exercise(
    "number", _deeper_pct, "A pair's load is shared by two wheels; then one call of the wheel model for both loads.",
    {"That is how much more load it carries; how much deeper does it sink?": lambda: _deeper_pct("load"),
     "That is its torque.": lambda: _deeper_pct("torque_nm"),
     "Over a front wheel, please, not over the mean.": lambda: _deeper_pct(over="mean"),
     "The other wheel model, please.": lambda: _deeper_pct(kernel="paper")}, within=0.01)

EXERCISES["13.3"] = Exercise(
    "2 numbers", _shortest, "An array of wheelbases, one evaluation; the first angle that reaches the limit.",
    {"That is enough facing uphill; across the slope it tips earlier.": lambda: _shortest("uphill"),
     "The frame alone: harness, thermal control and growth come on top of it.": lambda: _shortest(bus=False),
     "First the wheelbase, then the kilograms.": lambda: _shortest()[::-1]}, within=0.01)

EXERCISES["13.4"] = Exercise(
    "2 numbers", lambda: [_inside().inside.sum(), 0.5 * len(_inside())],
    "The level is a keyword of the function; the second number is a share of those in class.",
    {"Those are all rovers, also those out of class.":
        lambda: [_inside(in_class=False).inside.sum(), 0.5 * len(_inside(in_class=False))],
     "Those are the wider intervals of the text.": lambda: [_inside(0.9).inside.sum(), 0.9 * len(_inside())],
     "First those that lie inside, then those expected.":
        lambda: [0.5 * len(_inside()), _inside().inside.sum()]}, within=0.001)
