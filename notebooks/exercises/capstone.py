"""Exercises of notebook 16, design your rover, with the brief that they judge by."""
from __future__ import annotations

from dataclasses import replace
from functools import cache

from rdk import catalog
from rdk.design import Model, Problem, Scenario
from rdk.mission import evaluate
from rdk.report import joint_odds, requirements

from .judging import Exercise

EXERCISES = {}
"""The exercises of these notebooks by number."""


# ---- 16 design your rover ----------------------------------------------------------------------------------

SWIRL = Scenario(
    name="reiner_gamma_swirl", latitude_deg=7.5, soil=catalog.soil("apollo-nominal"), duration_earth_days=13,
    slope_deg=12, duty_cycle=0.1, traverse_limit_km=20, payload_mass_kg=4, payload_power_w=12,
    required_obstacle_height_m=0.06, panel_tilt_deg=0,
    problem=Problem(constraints=(("range_km", ">=", 10), ("slope_capability_deg", ">=", 18),
                             ("minimum_soc", ">=", 0.2),
                             ("total_mass_kg", "<=", 19))))
"""The mission brief of notebook 16."""
SWIRL_LIMITS = {"wheel_radius_m": (0.05, 0.15), "wheel_width_m": (0.05, 0.20),
                "grouser_height_m": (0.0, 0.015),
                "chassis_mass_kg": (3.0, 12.0), "solar_area_m2": (0.1, 0.5), "avionics_power_w": (10.0, 10.0)}
"""Limits that the brief sets on the design."""
JOINT_SHARE, TOLERANCE, DRAWS = 0.7, 0.01, 8192          # 8,192 draws know a share to half a point


@cache
def swirl_guess():
    """The first guess of notebook 16: Rashid-1 with larger wheels, array and battery."""
    return replace(catalog.rover("Rashid-1"), wheel_radius_m=0.12, avionics_power_w=10, solar_area_m2=0.4,
                   battery_capacity_wh=200)


@cache
def _first_morning():
    """Hour by hour on the swirl, standing still, with 0.45 m2 of array and a battery that never runs low."""
    standing = replace(SWIRL, duty_cycle=0.0)
    return evaluate(replace(swirl_guess(), solar_area_m2=0.45, battery_capacity_wh=500), standing).log


def _drained_wh():
    return 500 - _first_morning().stored_wh.min()


def _accepts(design):
    """What the brief of notebook 16 still misses in a design, or ""."""
    limits = {name: getattr(design, name) for name in SWIRL_LIMITS}
    if not all(low <= limits[name] <= high for name, (low, high) in SWIRL_LIMITS.items()):
        return "A variable is outside the limits of the brief: hold each one against `limits`."
    demands = requirements(design, SWIRL, draws=DRAWS)
    for demand in demands:
        if not demand.met:
            return f"A demand is missed before any uncertainty comes in: {demand.words}."
    joint = joint_odds(design, SWIRL, draws=DRAWS)
    if joint < JOINT_SHARE - TOLERANCE:
        weakest = min(demands, key=lambda demand: demand.share)
        return (f"Too little margin: all demands together hold in {joint:.0%} of the draws. The one that fails most "
                f"often: “{weakest.words}”.")
    if not evaluate(design, replace(SWIRL, soil=catalog.soil("sourcebook-trafficability"))).feasible:
        return "On the soil with the Sourcebook's friction angle the rover does not drive the mission."
    return ""


EXERCISES["16.1"] = Exercise(
    "number", lambda: SWIRL.required_obstacle_height_m / Model().rigid_obstacle_ratio,
    "The obstacle that a rover climbs is a multiple of its wheel radius; the suspension decides which.",
    {"That is the radius for six wheels on a rocker-bogie; the question asks for four on a rigid chassis.":
        lambda: SWIRL.required_obstacle_height_m / Model().rocker_bogie_obstacle_ratio,
     "A rigid chassis does not climb an obstacle as high as its wheel's radius.": lambda: 0.06,
     "The ratio is height over radius, not radius over height: divide.": lambda: 0.06 * 0.5,
     "In metres, please, and the radius rather than the diameter.": lambda: 0.24}, within=0.005)

EXERCISES["16.2"] = Exercise(
    "number", lambda: _drained_wh() / (1 - 0.2),
    "Read `stored_wh` of the log with a battery large enough never to run low, at duty cycle 0.",
    {"That is the energy which leaves the battery. One fifth of it must still be there in the end.":
        _drained_wh,
     "That adds a fifth of the drained energy; a fifth of the whole battery must remain.":
        lambda: _drained_wh() * 1.2,
     "The discharge loses a part: the battery gives up more than the load receives.":
        lambda: _drained_wh() * Model().discharge_efficiency / (1 - 0.2),
     "The array helps before it carries the whole load: the drain is not constant all morning.":
        lambda: 22 * (_first_morning().solar_w < 22).sum() / Model().discharge_efficiency / (1 - 0.2)},
        within=0.004)

EXERCISES["16.3"] = Exercise(
    "number", lambda: evaluate(swirl_guess(), replace(
        SWIRL, soil=catalog.soil("sourcebook-trafficability"))).slope_capability_deg,
    "Replace the soil of the mission, evaluate the first guess on it, and read slope_capability_deg.",
    {"That is the capability in the mission's own soil: replace the soil first.":
        lambda: evaluate(swirl_guess(), SWIRL).slope_capability_deg,
     "That is the loss, or gain, and not the capability itself.":
        lambda: evaluate(swirl_guess(), SWIRL).slope_capability_deg - evaluate(swirl_guess(), replace(
            SWIRL, soil=catalog.soil("sourcebook-trafficability"))).slope_capability_deg,
     "apollo-loose is another soil: looser, and not only weaker in friction.":
        lambda: evaluate(swirl_guess(), replace(SWIRL,
                                                soil=catalog.soil("apollo-loose"))).slope_capability_deg})


def _accepted():
    return replace(swirl_guess(), wheel_radius_m=0.125, wheel_width_m=0.05, grouser_height_m=0.015, grouser_count=24,
                   chassis_mass_kg=3.0, solar_area_m2=0.47, battery_capacity_wh=285, peak_wheel_torque_nm=0.5)


EXERCISES["16.4"] = Exercise(
    "Design", _accepted, "",
    {"outside the limits of the brief": lambda: replace(_accepted(), wheel_radius_m=0.16),
     "before any uncertainty comes in: lowest charge": swirl_guess,
     "fails most often: “lowest charge": lambda: replace(_accepted(), battery_capacity_wh=230),
     "fails most often: “mass": lambda: replace(_accepted(), battery_capacity_wh=400),
     "fails most often: “slope capability": lambda: replace(_accepted(), grouser_count=8)}, judge=_accepts)
