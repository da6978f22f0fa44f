"""The exercises of the notebooks: how each is answered, which mistakes are typical, and what to say to them.

One block an exercise, grouped by notebook. Answers are computed here, independently of the notebooks; nothing is
stored. A hint names what went wrong and does not give the answer away.
"""
from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
from scipy.integrate import trapezoid

from . import catalog, terramechanics
from .course import exercise
from .design import Design, Model, Scenario, Study
from .mission import evaluate
from .report import requirements


@cache
def _mare():
    return catalog.scenario("equatorial_mare_traverse")


@cache
def _rashid():
    return catalog.rover("Rashid-1")


def _first(values, flags):
    """The first of `values` at which `flags` holds."""
    return values[np.argmax(flags)]


# ---- 00 start here --------------------------------------------------------------------------------------------

def _drive_highland(**changes):
    """How many of the six rovers drive the highland mission, with some of it changed."""
    mission = replace(catalog.scenario("highland_slope_capability"), **changes)
    return sum(evaluate(catalog.rover(name), mission).range_km > 0 for name in catalog.rover_names())


@cache
def _loaded():
    payload_kg = np.linspace(0, 30, 3001)
    return payload_kg, evaluate(_rashid(), replace(_mare(), payload_mass_kg=payload_kg))


def _stall_payload():
    payload_kg, result = _loaded()
    return _first(payload_kg, result.stalled)


def _bus_factor():
    model = Model()
    return (1 + model.harness_fraction) * (1 + model.thermal_control_fraction) * (1 + model.growth_fraction)


def _structure_share():
    return _rashid().chassis_mass_kg / evaluate(_rashid(), _mare()).total_mass_kg


def _climbs_highland(design):
    cadre = catalog.rover("CADRE-unit")
    wheels = {"wheel_radius_m", "wheel_width_m", "grouser_height_m", "grouser_count", "peak_wheel_torque_nm"}
    kept = {n: getattr(design, n) == getattr(cadre, n) for n in cadre.numbers() if n not in wheels}
    if not all(kept.values()):
        return f"Only wheels and hubs may change; {next(n for n in kept if not kept[n])} did."
    result = evaluate(design, catalog.scenario("highland_slope_capability"))
    if result.stalled and result.wheel_torque_nm > design.peak_wheel_torque_nm:
        return "It stalls: the hub is too weak for the torque that this wheel needs."
    if result.stalled:
        return "It stalls for want of grip: more radius, width or grousers."
    if result.range_km < 10:
        return "It drives, but less than 10 km: the hub turns at a fixed rate, so the radius sets the speed."
    return "" if result.total_mass_kg < 15 else "It drives far enough, but weighs 15 kg or more."


exercise(
    "00.1", lambda: [_drive_highland(soil=_mare().soil), _drive_highland(slope_deg=0.0)],
    "Count the designs whose range is above 0: once with the soil replaced, once with the slope replaced.",
    {"That is the mission as it stands: replace the soil for the first number, the slope for the second.":
        lambda: [_drive_highland(), _drive_highland()],
     "The other way round: firm soil first, then flat ground.":
        lambda: [_drive_highland(slope_deg=0.0), _drive_highland(soil=_mare().soil)],
     "Firm soil does not save them all: one has another trouble.": lambda: [6, 6]}, within=0)

exercise(
    "00.2", _stall_payload, "Evaluate an array of payloads and take the first that stalls.",
    {"That is what must be added to the payload that the mission has already.":
        lambda: _stall_payload() - _mare().payload_mass_kg,
     "That is the mass of the whole rover there; the question asks for its payload.":
        lambda: _first(_loaded()[1].total_mass_kg, _loaded()[1].stalled)}, within=0.01)

exercise(
    "00.3", lambda: 1 / (1 - _structure_share() * _bus_factor()),
    "Close the loop by repetition, as in section 3, until the mass no longer changes.",
    {"That is the payload alone. The chassis grows too.": lambda: 1.0,
     "One round of the loop is not enough: the chassis grows again for what it has grown.":
        lambda: 1 + _structure_share() * _bus_factor(),
     "A kilogram of chassis makes more than a kilogram of rover: harness, thermal control and growth come on top.":
        lambda: 1 / (1 - _structure_share())}, within=0.005)

exercise(
    "00.4", lambda: replace(catalog.rover("CADRE-unit"), wheel_radius_m=0.12, wheel_width_m=0.10, grouser_count=20,
                            grouser_height_m=0.015, peak_wheel_torque_nm=0.4), "",
    {"for want of grip": lambda: replace(catalog.rover("CADRE-unit"), peak_wheel_torque_nm=5.0),
     "the hub is too weak": lambda: replace(catalog.rover("CADRE-unit"), wheel_radius_m=0.12, wheel_width_m=0.10,
                                            grouser_count=20, peak_wheel_torque_nm=0.1),
     "Only wheels and hubs may change; chassis_mass_kg did": lambda: replace(catalog.rover("CADRE-unit"),
                                                                             chassis_mass_kg=1.0),
     "weighs 15 kg or more": lambda: replace(catalog.rover("CADRE-unit"), wheel_radius_m=0.18, wheel_width_m=0.20,
                                             grouser_count=20, grouser_height_m=0.015, peak_wheel_torque_nm=2.0)},
    judge=_climbs_highland)


# ---- 01 wheel on soil -----------------------------------------------------------------------------------------

_LOAD_N = 16 * 1.625 / 4                                 # on one wheel of the notebook's rover


def _ribbed(count=14, radius_m=0.10, height_m=0.015):
    return terramechanics.Wheel(radius_m, 0.08, height_m, count)


def _efficiency(slip, ideal=False):
    """Tractive efficiency of the notebook's wheel; `ideal` forgets that the slip takes speed away."""
    forces = terramechanics.wheel_forces(_ribbed(), catalog.soil("apollo-nominal"), _LOAD_N, slip)
    return forces.drawbar_pull_n * 0.10 * (1 - slip * (not ideal)) / forces.torque_nm


@cache
def _best(ideal=False):
    slip = np.linspace(0.1, 0.9, 801)
    efficiency = _efficiency(slip, ideal)
    return [slip[efficiency.argmax()], efficiency.max()]


def _pull_error_ppm(points=100, n=1.1):
    """Relative error of the trapezoidal rule's pull at an entry angle of 0.35 rad and slip 0.2, in millionths."""
    soil = replace(catalog.soil("apollo-nominal"), sinkage_exponent=n)

    def pull(angle):
        stress = terramechanics.contact_stress(_ribbed(), soil, 0.35, 0.2, angle)
        return trapezoid(stress.shear_stress_pa * np.cos(angle) - stress.normal_stress_pa * np.sin(angle), angle)

    middle = (0.4 + 0.2 * 0.2) * 0.35
    exact = sum(pull(np.linspace(a, b, 200_001)) for a, b in ((0, middle), (middle, 0.35)))
    return 1e6 * abs(pull(np.linspace(0, 0.35, points)) / exact - 1)


@cache
def _radius_mm(height_m, count, soil):
    """The smallest radius that climbs 16 deg."""
    radius_m = np.linspace(0.03, 0.2, 3401)
    slope = terramechanics.slope_capability(_ribbed(count, radius_m, height_m), catalog.soil(soil), _LOAD_N)
    return 1000 * _first(radius_m, slope >= 16)


exercise(
    "01.1", lambda: 2 ** (2 / 3), "Section 10 has the power law: how does the sinkage depend on the load?",
    {"That would be proportion: twice the load, twice the rut. Sinkage is a weaker power of the load.": lambda: 2.0,
     "The exponent is upside down.": lambda: 2 ** (3 / 2),
     "That is the exponent; raise the ratio of the loads to it.": lambda: 2 / 3,
     "By so much it stands deeper; the question asks for the ratio.": lambda: 2 ** (2 / 3) - 1}, within=0.005)

exercise(
    "01.2", lambda: np.ceil(0.6 * 2 * np.pi * 0.10 / 0.015),
    "The gain is height times number over the circumference. At which number does it reach its cap?",
    {"At that number the cap is not quite reached: one more still helps.":
        lambda: np.floor(0.6 * 2 * np.pi * 0.10 / 0.015),
     "That fills the whole circumference; the cap comes earlier.": lambda: np.ceil(2 * np.pi * 0.10 / 0.015),
     "The circumference is 2 π r, with the radius and not the diameter.":
        lambda: np.ceil(0.6 * 2 * np.pi * 0.20 / 0.015)}, within=0)

exercise(
    "01.3", _best, "Multiply pull and speed, divide by torque and angular speed: ω cancels, slip does not.",
    {"That is where the pull is largest. A wheel that pulls hard there hardly moves.":
        lambda: [0.9, float(_efficiency(0.9))],
     "The speed is ω r (1 - s): you left the slip out of it.": lambda: _best(True)}, within=0.04)

exercise(
    "01.4", _pull_error_ppm,
    "Take the pull with the trapezoid and 100 points, and with 200 Gauss points on each arc; n is 1.1 in both.",
    {"That is the error with the exponent of the notebook's soil: set n to 1.1 for both rules.":
        lambda: _pull_error_ppm(n=1.0),
     "That is the trapezoid with 101 points, that is with 100 intervals; the paper's has 100 points.":
        lambda: _pull_error_ppm(101)}, within=0.005)

exercise(
    "01.5", lambda: [_radius_mm(0.015, 14, "sourcebook-trafficability"), _radius_mm(0.020, 24, "sourcebook-trafficability"),
                     _radius_mm(0.015, 14, "apollo-nominal")],
    "Evaluate the slope capability for an array of radii and take the first that reaches 16 deg; change one thing at a time.",
    {"The first two are with the friction angle of 46 deg; the question asks for the Sourcebook's there.":
        lambda: [_radius_mm(0.015, 14, "apollo-nominal"), _radius_mm(0.020, 24, "apollo-nominal"),
                 _radius_mm(0.015, 14, "apollo-nominal")],
     "The other way round: first 14 grousers of 15 mm, then 24 of 20 mm.":
        lambda: [_radius_mm(0.020, 24, "sourcebook-trafficability"), _radius_mm(0.015, 14, "sourcebook-trafficability"),
                 _radius_mm(0.015, 14, "apollo-nominal")]},
    within=0.02)


# ---- 08 design rules ------------------------------------------------------------------------------------------

_NIGHT_WH = 13.0 * Model().synodic_day_h / 2             # avionics and payload through half a lunar day

exercise(
    "08.1", lambda: 0.15 * Model().rigid_obstacle_ratio,
    "Obstacle height is the wheel radius times a ratio that depends on the suspension.",
    {"That is for a rocker-bogie; the question is about a rigid chassis on four wheels.":
        lambda: 0.15 * Model().rocker_bogie_obstacle_ratio,
     "A rigid rover does not climb as high as its wheel's radius.": lambda: 0.15,
     "That takes the diameter for the radius, or the largest wheel of the search.": lambda: 0.1}, within=0.005)

exercise(
    "08.2", lambda: _NIGHT_WH / (1 - Model().soc_floor) / Model().discharge_efficiency,
    "Energy is power times hours; then allow for what may not be used and for what is lost on the way out.",
    {"That is the energy that the rover uses. The battery may not be emptied, and loses a part in discharging.":
        lambda: _NIGHT_WH,
     "The discharge loses a part, too.": lambda: _NIGHT_WH / (1 - Model().soc_floor),
     "Only the part above the floor may be used.": lambda: _NIGHT_WH / Model().discharge_efficiency,
     "The night is half of the lunar day.":
        lambda: 2 * _NIGHT_WH / (1 - Model().soc_floor) / Model().discharge_efficiency,
     "Losses and floor make the battery larger than the energy used, not smaller: divide.":
        lambda: _NIGHT_WH * (1 - Model().soc_floor) * Model().discharge_efficiency}, within=0.01)


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


exercise(
    "08.3", _indifferent_k_mm,
    "Compute both slope capabilities over shear moduli from 2 to 18 mm and look for the sign change.",
    {"In millimetres, please.": lambda: _indifferent_k_mm() / 1000,
     "That is the modulus of the mare soil itself, where narrow wins.": lambda: 18.0,
     "That soil's modulus was measured, but it is not where the two wheels are equal.": lambda: 11.0})


def _presses_softly(design):
    """What the design of exercise 08.4 still misses, or ""."""
    p = evaluate(design, catalog.scenario("equatorial_mare_traverse"))
    if p.stalled or p.range_km < 80 - 1e-9:
        return f"It drives {p.range_km:.1f} km" + (" because it stalls." if p.stalled else ", short of the limit.")
    if p.ground_pressure_kpa > 2:
        return f"It presses too hard, {p.ground_pressure_kpa:.2f} kPa: wider or larger wheels, or less mass."
    if p.slope_capability_deg < 30:
        return f"It climbs {p.slope_capability_deg:.1f} degrees only: grousers and radius are the cheapest traction."
    return "" if p.total_mass_kg <= 15 else f"It weighs {p.total_mass_kg:.1f} kg: look at the mass breakdown."


def _soft():
    return Design(wheel_radius_m=0.2, wheel_width_m=0.055, grouser_height_m=0.02, grouser_count=24, wheel_count=4,
                  chassis_mass_kg=0.5, wheelbase_m=0.6, solar_area_m2=0.12, battery_capacity_wh=10,
                  avionics_power_w=6, peak_wheel_torque_nm=1.0)


exercise(
    "08.4", _soft, "",
    {"It presses too hard": lambda: replace(_soft(), wheel_width_m=0.03),
     "It climbs": lambda: replace(_soft(), grouser_height_m=0.01),
     "because it stalls": lambda: replace(_soft(), peak_wheel_torque_nm=0.1),
     "short of the limit": lambda: replace(_soft(), avionics_power_w=40.0),
     "look at the mass breakdown": lambda: replace(_soft(), wheel_width_m=0.09, chassis_mass_kg=3.0)},
    judge=_presses_softly)


# ---- 12 design your rover -------------------------------------------------------------------------------------

SWIRL = Scenario(
    name="reiner_gamma_swirl", latitude_deg=7.5, soil=catalog.soil("apollo-nominal"), duration_earth_days=13,
    slope_deg=12, duty_cycle=0.1, traverse_limit_km=20, payload_mass_kg=4, payload_power_w=12,
    required_obstacle_height_m=0.06, panel_tilt_deg=0,
    study=Study(constraints=(("range_km", ">=", 10), ("slope_capability_deg", ">=", 18), ("minimum_soc", ">=", 0.2),
                             ("total_mass_kg", "<=", 19))))
"""The mission brief of notebook 12."""
SWIRL_LIMITS = {"wheel_radius_m": (0.05, 0.15), "wheel_width_m": (0.05, 0.20), "grouser_height_m": (0.0, 0.015),
                "chassis_mass_kg": (3.0, 12.0), "solar_area_m2": (0.1, 0.5), "avionics_power_w": (10.0, 10.0)}
"""Limits that the brief sets on the design."""


@cache
def swirl_guess():
    """The first guess of notebook 12: Rashid-1 with larger wheels, array and battery."""
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
    """What the brief of notebook 12 still misses in a design, or ""."""
    limits = {name: getattr(design, name) for name in SWIRL_LIMITS}
    if not all(low <= limits[name] <= high for name, (low, high) in SWIRL_LIMITS.items()):
        return "A variable is outside the limits of the brief: hold each one against `limits`."
    demands = requirements(design, SWIRL)
    for demand in demands:
        if not demand.met:
            return f"A demand is missed before any uncertainty comes in: {demand.words}."
    weakest = min(demands, key=lambda demand: demand.share)
    if weakest.share < 0.9:
        return f"Too little margin: “{weakest.words}” holds in fewer than 90 % of the draws."
    if not evaluate(design, replace(SWIRL, soil=catalog.soil("sourcebook-trafficability"))).feasible:
        return "On the soil with the Sourcebook's friction angle the rover does not drive the mission."
    return ""


exercise(
    "12.1", lambda: SWIRL.required_obstacle_height_m / Model().rigid_obstacle_ratio,
    "The obstacle that a rover climbs is a multiple of its wheel radius; the multiple depends on the suspension.",
    {"That is the radius for six wheels on a rocker-bogie; the question asks for four on a rigid chassis.":
        lambda: SWIRL.required_obstacle_height_m / Model().rocker_bogie_obstacle_ratio,
     "A rigid chassis does not climb an obstacle as high as its wheel's radius.": lambda: 0.06,
     "The ratio is height over radius, not radius over height: divide.": lambda: 0.06 * 0.5,
     "In metres, please, and the radius rather than the diameter.": lambda: 0.24}, within=0.005)

exercise(
    "12.2", lambda: _drained_wh() / (1 - 0.2),
    "Read `stored_wh` of the log with a battery large enough never to run low, at duty cycle 0.",
    {"That is the energy which leaves the battery. One fifth of it must still be there in the end.": _drained_wh,
     "That fills the battery by the fifth that must remain, but of the drained energy and not of the whole battery.":
        lambda: _drained_wh() * 1.2,
     "The discharge loses a part: the battery gives up more than the load receives.":
        lambda: _drained_wh() * Model().discharge_efficiency / (1 - 0.2),
     "The array helps before it carries the whole load: the drain is not constant all morning.":
        lambda: 22 * (_first_morning().solar_w < 22).sum() / Model().discharge_efficiency / (1 - 0.2)}, within=0.004)

exercise(
    "12.3", lambda: evaluate(swirl_guess(), replace(
        SWIRL, soil=catalog.soil("sourcebook-trafficability"))).slope_capability_deg,
    "Replace the soil of the mission, evaluate the first guess on it, and read slope_capability_deg.",
    {"That is the capability in the mission's own soil: replace the soil first.":
        lambda: evaluate(swirl_guess(), SWIRL).slope_capability_deg,
     "That is the loss, or gain, and not the capability itself.":
        lambda: evaluate(swirl_guess(), SWIRL).slope_capability_deg - evaluate(swirl_guess(), replace(
            SWIRL, soil=catalog.soil("sourcebook-trafficability"))).slope_capability_deg,
     "apollo-loose is another soil: looser, and not only weaker in friction.":
        lambda: evaluate(swirl_guess(), replace(SWIRL, soil=catalog.soil("apollo-loose"))).slope_capability_deg})


def _accepted():
    return replace(swirl_guess(), wheel_radius_m=0.14, wheel_width_m=0.05, grouser_count=22, chassis_mass_kg=3.0,
                   solar_area_m2=0.45, battery_capacity_wh=270, peak_wheel_torque_nm=0.8)


exercise(
    "12.4", _accepted, "",
    {"outside the limits of the brief": lambda: replace(_accepted(), wheel_radius_m=0.16),
     "before any uncertainty comes in: lowest state of charge": swirl_guess,
     "Too little margin: “lowest state of charge": lambda: replace(_accepted(), battery_capacity_wh=240),
     "Too little margin: “total mass": lambda: replace(_accepted(), battery_capacity_wh=340),
     "Too little margin: “slope capability": lambda: replace(_accepted(), grouser_count=10)}, judge=_accepts)
