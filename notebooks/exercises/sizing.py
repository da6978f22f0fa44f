"""Exercises of notebook 12: from demands to a rover."""
from __future__ import annotations

from functools import cache

from scipy.optimize import brentq

from rdk import catalog, terramechanics
from rdk.design import Model
from rdk.mission import evaluate
from rdk.sizing import size
from rdk.terramechanics import Wheel

from .judging import Exercise
from .shared import mare, rashid

EXERCISES = {}
"""The exercises of this notebook by number."""


def _speed_cm_s(duty=0.3, day_h=24.0):
    """Speed while driving (cm/s) that takes a rover 45 km in ten days."""
    return 45e5 / (10 * day_h * 3600 * duty)


def _radius_m(kg=9.0, wheels=4, gravity_m_s2=1.625, slope_deg=23.0):
    """Radius of a narrow wheel with 16 grousers of 12 mm that climbs a slope on the mare."""
    def short(radius_m):
        wheel = Wheel(radius_m, 0.03, 0.012, 16)
        return terramechanics.slope_capability(wheel, mare().soil, kg * gravity_m_s2 / wheels) - slope_deg
    return brentq(short, 0.03, 0.6)


@cache
def _highland(*more):
    """Mass of the lightest rover that drives 15 km and climbs 15 deg in the highland, and meets more."""
    mission = catalog.scenario("highland_slope_capability")
    return size(mission, (("range_km", ">=", 15), ("slope_capability_deg", ">=", 15), *more)).performance.total_mass_kg


_STRUCTURE, _SERVED = ("structure_share", ">=", 0.2), ("unserved_h", "<=", 0)
_TASK = (("range_km", ">=", 30), ("slope_capability_deg", ">=", 20), _SERVED, _STRUCTURE)


@cache
def _workshop(*, task=_TASK, radius_m=0.10):
    wheels = {"wheel_radius_m": (radius_m, radius_m), "wheel_width_m": (0.06, 0.06)}
    return size(mare(), task, model=Model.engineering(), bounds=wheels).design


def _from_the_workshop(design):
    if abs(design.wheel_radius_m - 0.10) > 1e-4 or abs(design.wheel_width_m - 0.06) > 1e-4:
        return "Those are not the wheels of the workshop."
    result = evaluate(design, mare(), model=Model.engineering())
    if result.total_mass_kg > 15.6:
        return "It is heavier than 15.6 kg."
    if result.range_km < 30:
        return "It drives less than 30 km under the engineering model."
    if result.slope_capability_deg < 20:
        return "It does not climb 20 degrees."
    if result.unserved_h > 0:
        return "There are hours in which avionics or payload are not supplied."
    return "Its structure is less than a fifth of its mass." if result.structure_share < 0.2 else ""


EXERCISES["12.1"] = Exercise(
    "number", _speed_cm_s, "Distance over the time spent driving; in centimetres a second.",
    {"It does not drive all the time: the duty cycle is a share of the time.": lambda: _speed_cm_s(duty=1.0),
     "Driving part of the time, it must be faster and not slower.": lambda: _speed_cm_s(duty=1 / 0.3)},
    within=0.005)

EXERCISES["12.2"] = Exercise(
    "number", _radius_m, "One root: slope capability of the wheel less the slope, with its share of the weight.",
    {"That wheel carries the whole rover; it has three neighbours.": lambda: _radius_m(wheels=1),
     "That is the weight on the Earth.": lambda: _radius_m(gravity_m_s2=9.81)}, within=0.005)

EXERCISES["12.3"] = Exercise(
    "2 numbers", lambda: [_highland(), _highland(_STRUCTURE) - _highland()],
    "Two calls of the same function, the second with one demand more; then the difference.",
    {"The second number is how much it costs, not what the rover then weighs.":
        lambda: [_highland(), _highland(_STRUCTURE)],
     "That is the price of a served bus.": lambda: [_highland(), _highland(_SERVED) - _highland()],
     "First the mass, then what is added.": lambda: [_highland(_STRUCTURE) - _highland(), _highland()]}, within=0.02)

EXERCISES["12.4"] = Exercise(
    "Design", _workshop, "",
    {"not the wheels of the workshop": rashid,
     "heavier than 15.6 kg": lambda: _workshop().replace(chassis_mass_kg=_workshop().chassis_mass_kg + 1),
     "not supplied": lambda: _workshop(task=_TASK[:2] + _TASK[3:]),
     "less than a fifth": lambda: _workshop(task=_TASK[:3]),
     "does not climb": lambda: _workshop().replace(grouser_count=0, peak_wheel_torque_nm=0.5),
     "less than 30 km": lambda: _workshop().replace(peak_wheel_torque_nm=0.05)},
    judge=_from_the_workshop)
