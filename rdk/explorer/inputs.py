"""The explorer's inputs: one table of fields with sliders, what people type into them, the state as a short text."""
from __future__ import annotations

import difflib
import math
import re
from dataclasses import fields
from typing import NamedTuple
from urllib.parse import parse_qsl, urlencode

import numpy as np

from .. import catalog, pictures
from ..design import DESIGN_SPACE, Model, Scenario
from ..sky import julian_date

STEPS = 120                                              # positions of a logarithmic slider


class Field(NamedTuple):
    """A number with a slider: spans in the unit of the record, steps in the unit shown; a step of 0 is logarithmic."""
    label: str
    unit: str
    low: float
    high: float
    step: float
    help: str
    factor: float = 1.0                                  # of the unit shown
    endless: bool = False                                # the slider's upper end means no limit

    @property
    def positions(self):
        """Number of the slider's last position."""
        return STEPS if not self.step else round((self.high - self.low) * self.factor / self.step)

    def at(self, position):
        """The value at a position of the slider, a round number where the slider is logarithmic."""
        if position >= self.positions:
            return math.inf if self.endless else self.high
        if self.step:
            return round((self.low * self.factor + position * self.step) / self.factor, 9)
        value = self.low * (self.high / self.low) ** (position / STEPS)
        return min(max(float(f"{value:.2g}" if value < 10 else f"{value:.3g}"), self.low), self.high)

    def position(self, value):
        """The position nearest to a value."""
        if math.isinf(value):
            return self.positions
        if self.step:
            found = (value - self.low) * self.factor / self.step
        else:
            found = STEPS * math.log(max(value, self.low) / self.low) / math.log(self.high / self.low)
        return min(max(round(found), 0), self.positions)

    def words(self, value):
        """The value as its box shows it."""
        return "none" if math.isinf(value) else f"{value * self.factor:.5g}"

    def read(self, text):
        """A typed text as (value, what was done to it); a decimal comma is understood.

        Raises
        ------
        ValueError
            If it is no number; the message says what is allowed.
        """
        typed = text.strip().lower().replace("−", "-")
        unit = f" {self.unit}".rstrip()
        if self.endless and typed in ("none", "inf", "no limit", ""):
            return math.inf, ""
        try:
            if not re.fullmatch(r"[+-]?(\d+[.,]?\d*|[.,]\d+)(e[+-]?\d+)?", typed):
                raise ValueError
            value = float(typed.replace(",", ".")) / self.factor
        except ValueError:
            raise ValueError(f"{self.label}: “{text.strip()[:40]}” is no number; allowed are {self.words(self.low)} to "
                             f"{self.words(self.high)}{unit}") from None
        return self.cut(round(value, 12), text.strip())

    def cut(self, value, text=None):
        """The value within the slider's span, whole where it must be, and a sentence if that changed it."""
        near = min(max(value, self.low), math.inf if self.endless and math.isinf(value) else self.high)
        near = round(near) if self.label == "grousers" else near
        text = self.words(value) if text is None else text
        done = "cut" if not self.low <= value <= self.high else "rounded"
        return near, "" if near == value else (f"{self.label} {text} {done} to {self.words(near)} {self.unit}".rstrip())


def _own(name, label, unit, step, words, factor=1.0):
    """A design variable, with the span of the design space and what the published rovers have."""
    v = DESIGN_SPACE[name]
    known = [getattr(catalog.rover(rover), name) * factor for rover in catalog.rover_names()]
    return Field(label, unit, v.low, v.high, step, f"{words} Published rovers: {min(known):g} to {max(known):g} {unit}."
                 .replace(" .", "."), factor)


DESIGN = {
    "wheel_radius_m": _own("wheel_radius_m", "radius", "mm", 1, "Half the wheel's height. A larger wheel sinks less, "
                           "climbs "
                           "more, turns faster over ground and weighs more.", 1000),
    "wheel_width_m": _own("wheel_width_m", "width", "mm", 1, "A wider wheel sinks less and weighs more.", 1000),
    "grouser_height_m": _own("grouser_height_m", "grouser height", "mm", 0.5, "Ribs across the wheel that grip soil.",
                             1000),
    "grouser_count": _own("grouser_count", "grousers", "", 1, "Ribs on each wheel."),
    "chassis_mass_kg": _own("chassis_mass_kg", "chassis", "kg", 0, "Mass of the structure. A heavier one loses less "
                            "heat "
                            "for its size."),
    "wheelbase_m": _own("wheelbase_m", "wheelbase", "m", 0.01, "From the first axle to the last."),
    "solar_area_m2": _own("solar_area_m2", "solar array", "m²", 0, "Area of the cells."),
    "battery_capacity_wh": _own("battery_capacity_wh", "battery", "Wh", 0, "Energy of the full pack."),
    "avionics_power_w": _own("avionics_power_w", "avionics", "W", 0.5, "Computer, radio and sensors, at all hours."),
    "peak_wheel_torque_nm": _own("peak_wheel_torque_nm", "hub torque", "N m", 0, "The most that each hub can give.")}
COEFFICIENTS = {
    "hub_no_load_speed_rad_s": Field("hub speed", "rad/s", 0.5, 50, 0, "Fastest turn of a hub without load; it caps "
                                     "the "
                                     "cruise speed. The original release has 5.", endless=True),
    "drivetrain_efficiency": Field("drive efficiency", "%", 0.3, 1, 1, "From electrical power to power at the wheel. "
                                   "The paper has 80 %.", 100),
    "panel_efficiency": Field("cell efficiency", "%", 0.1, 0.4, 0.5, "Of sunlight into power. The paper has 28 %.",
                              100),
    "growth_fraction": Field("mass margin", "%", 0, 0.5, 1, "Allowance on the dry mass for what is not yet known. The "
                             "paper has 20 %.", 100)}
MISSION = {
    "latitude_deg": Field("latitude", "°", -90, 90, 0.5, "South negative. The sun of the model stands over the "
                          "equator."),
    "duration_earth_days": Field("duration", "days", 0.5, 60, 0.5, "Earth days from sunrise. A lunar day has 14.8 of "
                                 "light."),
    "slope_deg": Field("slope", "°", 0, 35, 0.5, "Climbed all the way. Maria have 0 to 10, crater rims 15 to 25."),
    "duty_cycle": Field("driving time", "%", 0, 1, 0.5, "Share of the time spent driving. Flown rovers have under 2 %.",
                        100),
    "traverse_limit_km": Field("route", "km", 0, 200, 1, "Length of the route: the rover stops there. Type “none” for "
                               "no "
                               "limit.", endless=True),
    "payload_mass_kg": Field("payload", "kg", 0, 30, 0.1, "Instruments, beside the rover's own parts."),
    "payload_power_w": Field("payload power", "W", 0, 40, 0.5, "Drawn at all hours."),
    "required_obstacle_height_m": Field("obstacle", "mm", 0, 0.3, 5, "Highest step that must be climbed.", 1000),
    "panel_tilt_deg": Field("array tilt", "°", 0, 90, 1, "From flat. At high latitude a steep array sees more sun."),
    "panel_azimuth_deg": Field("array faces", "°", 0, 359, 1, "Clockwise from north; 180 is south."),
    "maximum_speed_m_s": Field("speed limit", "m/s", 0.01, 10, 0, "Set by sensing and operators.", endless=True)}
MISSION = {name: field for name, field in MISSION.items() if name in {f.name for f in fields(Scenario)}}
SOIL = {
    "sinkage_exponent": Field("exponent n", "", 0.5, 1.6, 0.01, "Bekker's law: how fast pressure grows with depth."),
    "cohesive_modulus_kn_m_n1": Field("modulus k_c", "kN/mⁿ⁺¹", -60, 60, 0.1, "Stiffness that counts for narrow "
                                      "wheels."),
    "frictional_modulus_kn_m_n2": Field("modulus k_φ", "kN/mⁿ⁺²", 1, 10000, 0, "Stiffness of the soil. Lunar: 400 to "
                                        "1200."),
    "cohesion_kpa": Field("cohesion", "kPa", 0, 5, 0.01, "Strength without load. Lunar: 0.1 to 1."),
    "friction_angle_deg": Field("friction angle", "°", 10, 60, 0.5, "Strength that grows with load. Lunar: 30 to 50."),
    "shear_modulus_mm": Field("shear modulus K", "mm", 1, 50, 0.5, "Slip distance that brings out the strength. 10 to "
                              "20.")}
DEMANDS = {
    "minimum_range_km": ("range_km", ">=", Field("range at least", "km", 0, 200, 0.1, "0 asks for nothing.")),
    "minimum_slope_deg": ("slope_capability_deg", ">=", Field("climb at least", "°", 0, 35, 0.5,
                                                              "Slope capability; 0 asks "
                                                              "for nothing.")),
    "maximum_mass_kg": ("total_mass_kg", "<=", Field("mass at most", "kg", 1, 200, 0,
                                                     "With payload. Type “none” for no "
                                                     "limit.", endless=True)),
    "minimum_charge": ("minimum_soc", ">=", Field("charge at least", "%", 0, 1, 1,
                                                  "Lowest charge of the pack; it is never "
                                                  "drawn below its floor, 15 % in the paper.", 100)),
    "survive": ("thermal_survival", ">=", None)}
GOALS = {"range_goal": "range_km", "mass_goal": "total_mass_kg", "slope_goal": "slope_capability_deg"}
SEARCH = {"population": Field("population", "", 4, 400, 1, "Designs in each generation of a search."),
          "generations": Field("generations", "", 1, 1000, 1, "The paper has 60."),
          "seed": Field("seed", "", 0, 1e6, 1, "The same seed gives the same front.")}
NUMBERS = DESIGN | COEFFICIENTS | MISSION | SOIL | {name: field for name, (*_, field) in DEMANDS.items()
                                                    if field} | SEARCH
"""Every number of the explorer by its name."""
METRICS = ("range_km", "total_mass_kg", "slope_capability_deg", "energy_balance_pct", "cruise_speed_m_s", "slip",
           "sinkage_m", "wheel_torque_nm", "minimum_soc", "average_solar_power_w", "cold_temperature_c",
           "obstacle_capability_m")
VIEWS = {"log": "Mission log", "mass": "Mass", "wheel": "Wheel", "fleet": "Fleet", "why": "Why", "sweep": "Sweep",
         "optimise": "Optimise"}
OWN, START, NONE = "your own", "the design at the start", "none"
SKY = "site", "site_height_m", "start_utc"
SCRIPTS = ("the readings", "why", "the sweep", "the front")
RESTORED = (*DESIGN, "wheel_count", *COEFFICIENTS, "preset", *MISSION, *SKY, *SOIL, *DEMANDS, *GOALS)
"""What undo brings back and a link carries."""


def title(name):
    """A mission's name in human words."""
    return name if name == OWN else name.replace("_",
                                                 " ").capitalize() + f", {place(catalog.scenario(name).latitude_deg)}"


def place(latitude_deg):
    """A latitude in words."""
    return "equator" if latitude_deg == 0 else f"{abs(latitude_deg):.4g}° {'S' if latitude_deg < 0 else 'N'}"


def choices():
    """The menus: name -> value -> words."""
    swept = {name: f.label for name, f in (DESIGN | MISSION | SOIL | COEFFICIENTS).items()
             if name != "duration_earth_days"}
    metrics = {name: label(name)[0] for name in METRICS}
    goals = {goal: goal for goal in ("max", "min", "ignore")}
    plane = {name: words for name, words in metrics.items() if name != "sinkage_m"}
    presets = {"paper": "as in the paper"} | ({"engineering": "engineering"} if hasattr(Model, "engineering") else {})
    return {"rover": {name: name for name in (*catalog.rover_names(), OWN)},
            "mission": {name: title(name) for name in (*catalog.scenario_names(), OWN)},
            "soil": {name: name for name in (*catalog.soil_names(), OWN)},
            "site": {NONE: "none: level horizon", OWN: OWN,
                     **{name: name.replace("_", " ") for name in catalog.skyline_sites()}},
            "site_height_m": {1: "1 m up", 2: "2 m up", 10: "10 m up"},
            "wheel_count": {4: "4 wheels", 6: "6 wheels"}, "survive": {0: "may freeze", 1: "must survive"},
            "preset": presets, "view": VIEWS,
            "baseline": {name: name for name in (START, *catalog.rover_names())}, "why_metric": metrics,
            "sweep_first": swept, "sweep_second": {"": "nothing else"} | swept, "sweep_metric": metrics,
            "front_x": plane, "front_y": plane, "front_colour": plane, "live": {False: "off", True: "on"},
            "solve_variable": {name: f.label for name, f in DESIGN.items()},
            **dict.fromkeys(GOALS, goals), "script": {name: name for name in SCRIPTS}}


def label(name):
    """Words and unit of a metric or an input, such as ("range", "km")."""
    if name in NUMBERS:
        return {"wheel_radius_m": "wheel radius", "wheel_width_m": "wheel width"}.get(name, NUMBERS[name].label), \
            NUMBERS[name].unit
    return pictures.label(name)


def check(name, value, menus):
    """The value of an input set from Python, or a ValueError that says what is allowed."""
    if name in menus:
        if isinstance(value, (np.integer, np.bool_)):
            value = value.item()
        if not isinstance(value, (str, int, float)) or value not in menus[name]:
            raise ValueError(f"{name} must be one of {', '.join(map(str, menus[name]))}; got {value!r}")
        return value
    if name == "start_utc":
        text = str(value).strip()
        if text.lower() in ("", NONE):
            return NONE
        try:
            julian_date(text)
        except ValueError:
            raise ValueError("the start must be an ISO date and time in UTC, such as 2026-11-26T12:00, or “none”; got "
                             f"“{text[:40]}”") from None
        return text
    if name not in NUMBERS:
        near = difflib.get_close_matches(str(name), [*NUMBERS, *menus], 1)
        raise ValueError(f"no input {name!r}" + (f"; did you mean {near[0]!r}?" if near else "")
                         + f" Choose from {', '.join([*NUMBERS, *menus, 'start_utc'])}")
    field = NUMBERS[name]
    whole = field.step == 1 and field.unit == ""
    good = isinstance(value, (int, float, np.number)) and not isinstance(value, bool)
    if not good or not (field.low <= value <= field.high or field.endless and value == math.inf) or (
            whole and value != int(value)):
        kind = "a whole number" if whole else "a number"
        raise ValueError(f"{name} must be {kind} from {field.low:g} to {field.high:g}"
                         f"{', or infinity' * field.endless}; got {value!r}")
    return int(value) if whole else float(value)


def to_text(state, base):
    """What differs from `base`, as the query of a link."""
    return urlencode({name: state[name] for name in base if state[name] != base[name]})


def from_text(text):
    """Names and values of a link's query, unchecked; numbers are read where the input is one."""
    found = {}
    for name, value in parse_qsl(text.strip().lstrip("?")):
        try:
            kind = float if name in NUMBERS else int if name in ("wheel_count", "survive", "site_height_m") else str
            found[name] = kind(value)
        except ValueError:
            raise ValueError(f"the link says {name}={value[:40]!r}, which is no number") from None
    return found
