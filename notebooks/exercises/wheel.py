"""Exercises of notebooks 00 to 02: a first rover, the wheel on soil, and its measurements."""
from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
from scipy.optimize import least_squares

import validation
from rdk import catalog, terramechanics
from rdk.mission import evaluate
from wheel_doubts import bootstrap_medians

from .judging import Exercise
from .shared import bus_factor, first, mare, rashid

EXERCISES = {}
"""The exercises of these notebooks by number."""


# ---- 00 start here -----------------------------------------------------------------------------------------

def _drive_highland(**changes):
    """How many of the six rovers drive the highland mission, with some of it changed."""
    mission = replace(catalog.scenario("highland_slope_capability"), **changes)
    return sum(evaluate(catalog.rover(name), mission).range_km > 0 for name in catalog.rover_names())


@cache
def _loaded():
    payload_kg = np.linspace(0, 30, 3001)
    return payload_kg, evaluate(rashid(), mare(payload_mass_kg=payload_kg))


def _stall_payload():
    payload_kg, result = _loaded()
    return first(payload_kg, result.stalled)


def _structure_share():
    return rashid().chassis_mass_kg / evaluate(rashid(), mare()).total_mass_kg


def _climbs_highland(design):
    cadre = catalog.rover("CADRE-unit")
    wheels = {"wheel_radius_m", "wheel_width_m", "grouser_height_m", "grouser_count", "peak_wheel_torque_nm"}
    kept = {n: getattr(design, n) == getattr(cadre, n) for n in cadre.numbers() if n not in wheels}
    if not all(kept.values()):
        return f"Only wheels and hubs may change; {next(n for n in kept if not kept[n])} did."
    if 2 * (design.wheel_radius_m + design.grouser_height_m) > design.wheelbase_m:
        return "Front and rear wheels touch: with their grousers they are longer than the wheelbase."
    result = evaluate(design, catalog.scenario("highland_slope_capability"))
    if result.stalled and result.wheel_torque_nm > design.peak_wheel_torque_nm:
        return "It stalls: the hub is too weak for the torque that this wheel needs."
    if result.stalled:
        return "It stalls for want of grip: more radius, width or grousers."
    if result.range_km < 10:
        return "It drives, but less than 10 km: the hub turns at a fixed rate, so the radius sets the speed."
    return "" if result.total_mass_kg < 15 else "It drives far enough, but weighs 15 kg or more."


EXERCISES["00.1"] = Exercise(
    "2 numbers", lambda: [_drive_highland(soil=mare().soil), _drive_highland(slope_deg=0.0)],
    "Count the designs whose range is above 0: once with the soil replaced, once with the slope replaced.",
    {"That is the mission as it stands: replace the soil for the first number, the slope for the second.":
        lambda: [_drive_highland(), _drive_highland()],
     "The other way round: firm soil first, then flat ground.":
        lambda: [_drive_highland(slope_deg=0.0), _drive_highland(soil=mare().soil)],
     "Firm soil does not save them all: one has another trouble.": lambda: [6, 6]}, within=0)

EXERCISES["00.2"] = Exercise(
    "number", _stall_payload, "Evaluate an array of payloads and take the first that stalls.",
    {"That is what must be added to the payload that the mission has already.":
        lambda: _stall_payload() - mare().payload_mass_kg,
     "That is the mass of the whole rover there; the question asks for its payload.":
        lambda: first(_loaded()[1].total_mass_kg, _loaded()[1].stalled)}, within=0.01)

EXERCISES["00.3"] = Exercise(
    "number", lambda: 1 / (1 - _structure_share() * bus_factor()),
    "Close the loop by repetition, as in section 3, until the mass no longer changes.",
    {"That is the payload alone. The chassis grows too.": lambda: 1.0,
     "That is what comes on top of the payload's own kilogram; both make the rover heavier.":
        lambda: 1 / (1 - _structure_share() * bus_factor()) - 1,
     "One round of the loop is not enough: the chassis grows again for what it has grown.":
        lambda: 1 + _structure_share() * bus_factor(),
     "A kilogram of chassis makes more than a kilogram of rover: overheads and growth come on top.":
        lambda: 1 / (1 - _structure_share())}, within=0.008)

def _cadre(**changes):
    return replace(catalog.rover("CADRE-unit"), **changes)


EXERCISES["00.4"] = Exercise(
    "Design", lambda: _cadre(wheel_radius_m=0.12, wheel_width_m=0.10, grouser_count=20, grouser_height_m=0.015,
                             peak_wheel_torque_nm=0.4), "",
    {"for want of grip": lambda: _cadre(peak_wheel_torque_nm=5.0),
     "the hub is too weak": lambda: _cadre(wheel_radius_m=0.12, wheel_width_m=0.10, grouser_count=20,
                                           peak_wheel_torque_nm=0.1),
     "Only wheels and hubs may change; chassis_mass_kg did": lambda: _cadre(chassis_mass_kg=1.0),
     "wheels touch": lambda: _cadre(wheel_radius_m=0.18),
     "weighs 15 kg or more": lambda: _cadre(wheel_radius_m=0.13, wheel_width_m=0.20, grouser_count=20,
                                            grouser_height_m=0.015, peak_wheel_torque_nm=2.0)},
    judge=_climbs_highland)


# ---- 01 wheel on soil --------------------------------------------------------------------------------------

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


_DEPTH_M, _PLATES_M = np.array([5, 10, 20, 40]) / 1000, np.array([0.03, 0.06])
_READINGS_KPA = np.array([[8.21, 15.33, 28.60, 53.37], [7.08, 13.21, 24.64, 45.99]])


def _plate_test(depth=_DEPTH_M, plates=_PLATES_M):
    """n, k_c and k_phi (kN, m) of the plate test in 01.4."""
    power = np.polyfit(np.log(depth), np.log(_READINGS_KPA).mean(axis=0), 1)[0]
    stiffness = np.exp(np.log(_READINGS_KPA / depth**power).mean(axis=1))
    return [power, *np.linalg.solve(np.c_[1 / plates, [1, 1]], stiffness)]


@cache
def _radius_mm(height_m, count, soil):
    """The smallest radius that climbs 16 deg."""
    radius_m = np.linspace(0.03, 0.2, 3401)
    slope = terramechanics.slope_capability(_ribbed(count, radius_m, height_m), catalog.soil(soil), _LOAD_N)
    return 1000 * first(radius_m, slope >= 16)


_WHEELS = ((0.015, 14, "sourcebook-trafficability"), (0.020, 24, "sourcebook-trafficability"),
           (0.015, 14, "apollo-nominal"))                # height, count and soil in 01.5

EXERCISES["01.1"] = Exercise(
    "number", lambda: 2 ** (2 / 3), "Section 7 has the power law: how does the sinkage depend on the load?",
    {"That would be proportion: twice the load, twice the rut. Sinkage is a weaker power of the load.":
        lambda: 2.0,
     "The exponent is upside down.": lambda: 2 ** (3 / 2),
     "That is the exponent; raise the ratio of the loads to it.": lambda: 2 / 3,
     "By so much it stands deeper; the question asks for the ratio.": lambda: 2 ** (2 / 3) - 1}, within=0.01)

EXERCISES["01.2"] = Exercise(
    "number", lambda: np.ceil(0.6 * 2 * np.pi * 0.10 / 0.015),
    "The gain is height times number over the circumference. At which whole number does it reach its cap?",
    {"At that number the cap is not quite reached: one more still helps.":
        lambda: np.floor(0.6 * 2 * np.pi * 0.10 / 0.015),
     "Grousers come whole: round up.": lambda: 0.6 * 2 * np.pi * 0.10 / 0.015,
     "That fills the whole circumference; the cap comes earlier.": lambda: np.ceil(2 * np.pi * 0.10 / 0.015),
     "The circumference is 2 π r, with the radius and not the diameter.":
        lambda: np.ceil(0.6 * 2 * np.pi * 0.20 / 0.015)}, within=0)

EXERCISES["01.3"] = Exercise(
    "2 numbers", _best, "Multiply pull and speed, divide by torque and angular speed: ω cancels, slip does not. "
    "Is the grid fine enough?",
    {"That is where the pull is largest. A wheel that pulls hard there hardly moves.":
        lambda: [0.9, float(_efficiency(0.9))],
     "First the slip, then the efficiency.": lambda: _best()[::-1],
     "The efficiency as a share, not in percent.": lambda: [_best()[0], 100 * _best()[1]],
     "The speed is ω r (1 - s): you left the slip out of it.": lambda: _best(True)}, within=0.04)

EXERCISES["01.4"] = Exercise(
    "3 numbers", _plate_test,
    "The slope of the logarithms is n; readings over depth to the power n are k_c / b + k_phi, one for each plate.",
    {"The moduli with depths in metres, please: in millimetres they are other numbers.":
        lambda: _plate_test(1000 * _DEPTH_M, 1000 * _PLATES_M),
     "First k_c, then k_phi.": lambda: [_plate_test()[i] for i in (0, 2, 1)],
     "That takes the plates the other way round: the narrow one met more pressure.":
        lambda: _plate_test(plates=_PLATES_M[::-1]),
     "The moduli in kN, please, not in N.": lambda: _plate_test() * np.array([1, 1000, 1000])}, within=0.03)

EXERCISES["01.5"] = Exercise(
    "3 numbers", lambda: [_radius_mm(*wheel) for wheel in _WHEELS],
    "Evaluate the slope capability for an array of radii and take the first that reaches 16 deg.",
    {"The first two are with the friction angle of 46 deg; the question asks for the Sourcebook's there.":
        lambda: [_radius_mm(0.015, 14, "apollo-nominal"), _radius_mm(0.020, 24, "apollo-nominal"),
                 _radius_mm(0.015, 14, "apollo-nominal")],
     "In mm, please, and the radius.": lambda: [_radius_mm(*wheel) / 1000 for wheel in _WHEELS],
     "The radius, not the diameter.": lambda: [2 * _radius_mm(*wheel) for wheel in _WHEELS],
     "The other way round: first 14 grousers of 15 mm, then 24 of 20 mm.":
        lambda: [_radius_mm(0.020, 24, "sourcebook-trafficability"),
                 _radius_mm(0.015, 14, "sourcebook-trafficability"),
                 _radius_mm(0.015, 14, "apollo-nominal")]},
    within=0.02)


# ---- 02 wheel measurements ---------------------------------------------------------------------------------

@cache
def _factor_of_shift(shift_pct, low, high):
    """The factor on the shear stress between two limits that moves the median pull by `shift_pct`."""
    scale = np.linspace(low, high, 401)
    shift = validation.pull_shift(scale).median_shift_pct.to_numpy()
    return scale[np.abs(shift - shift_pct).argmin()]


@cache
def _reading_interval(reading_error_n):
    """5 % and 95 % point of Ding's median pull error, in percent."""
    row = bootstrap_medians(reading_error_n, 0.0, 0.0).iloc[0]
    return row.low_pct, row.high_pct


@cache
def _digging(wheel):
    """n_0 and n_1 of a sinkage exponent n_0 + n_1 s, fitted to Ding's sinkage of one wheel, or of both."""
    points = catalog.table("single_wheel.csv").query("experiment == 'ding-2011'").reset_index(drop=True)
    wheels, soil, load, slip = validation.single_wheel_conditions(points)
    used = points.wheel.str.contains(wheel).to_numpy()

    def misses(n):
        softer = replace(soil, sinkage_exponent=n[0] + n[1] * slip)
        sinkage_mm = 1000 * terramechanics.wheel_forces(wheels, softer, load, slip).sinkage_m
        return (sinkage_mm - points.sinkage_mm)[used]

    return least_squares(misses, (1.0, 0.2)).x


EXERCISES["02.1"] = Exercise(
    "4 numbers", lambda: [25.0, 10.0, 1.0, 4.0],
    "An error is model less measured; divide it by the measured pull, or by the load.",
    {"You divided by the model's pull; divide by the measured one.": lambda: [20.0, 100 / 11, 1.0, 4.0],
     "The last two are the errors in newtons of a load of 100 N; the load is 50 N.":
        lambda: [25.0, 10.0, 0.5, 2.0]})

EXERCISES["02.2"] = Exercise(
    "number", lambda: _factor_of_shift(27.0, 0.80, 0.95), "A finer list of factors between 0.85 and 0.9.",
    {"That is the factor above 1; the question asks for the one below.":
        lambda: _factor_of_shift(27.0, 1.05, 1.20),
     "Pull is grip less resistance: it does not shrink in proportion to the shear stress, but faster.":
        lambda: 0.73,
     "That is the paper's factor. It moves the pull by a little more than the error.": lambda: 0.85},
    within=0.004)

EXERCISES["02.3"] = Exercise(
    "number", lambda: float(np.subtract(*_reading_interval(1.0)[::-1])),
    "`high_pct` less `low_pct` of Ding's row.",
    {"That is the upper end of the interval; its width is asked for.": lambda: _reading_interval(1.0)[1],
     "That is the interval for a reading error of 0.5 N.":
        lambda: float(np.subtract(*_reading_interval(0.5)[::-1])),
     "That is the interval for a reading error of 2 N.":
        lambda: float(np.subtract(*_reading_interval(2.0)[::-1]))},
    within=0.03)

EXERCISES["02.4"] = Exercise(
    "2 numbers", lambda: _digging("smooth"), "Fit the sinkage, in mm, at the points of the smooth wheel only.",
    {"That fits both wheels at once. Fit the smooth one, then predict the other.":
        lambda: _digging("smooth|grousered"),
     "That fits the grousered wheel. Fit the smooth one.": lambda: _digging("grousered"),
     "First the exponent at slip 0, then its growth with slip.": lambda: _digging("smooth")[::-1]},
    within=0.03)
