"""The explorer's inputs: their table, their menus, what people type into them."""
import math
import re
from typing import NamedTuple

import numpy as np

from .. import _fields, catalog, pictures
from ..design import DESIGN_SPACE
from ..sky import julian_date

STEPS = 120                                              # positions of a logarithmic slider


class Field(NamedTuple):
    """A number with a slider, a row of `data/explorer_inputs.csv`; `low` and `high` are in the unit of the record."""
    label: str
    heading: str
    unit: str
    low: float
    high: float
    step: float                                          # in the unit shown; 0 is logarithmic
    factor: float                                        # of the unit shown
    whole: bool                                          # it counts something
    endless: bool                                        # the slider's upper end means no limit
    help: str

    @classmethod
    def of(cls, row):
        """The Field of a row; a design variable has the span of the design space."""
        name, unit, factor, words = row["name"], row["unit"], float(row["factor"]), row["help"]
        if name in DESIGN_SPACE:
            low, high, *_ = DESIGN_SPACE[name]
            known = [getattr(catalog.rover(rover), name) * factor for rover in catalog.rover_names()]
            words += f" Published rovers: {min(known):g} to {max(known):g} {unit}".rstrip() + "."
        else:
            low, high = float(row["low"]), float(row["high"])
        return cls(row["label"], row["heading"], unit, low, high, float(row["step"]), factor,
                   row["whole"] == "True", row["endless"] == "True", words)

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
        """A typed text as (value, what was done to it), or a ValueError; a decimal comma is understood."""
        typed = text.strip().lower().replace("−", "-")
        if self.endless and typed in ("none", "inf", "no limit", ""):
            return math.inf, ""
        if not re.fullmatch(r"[+-]?(\d+[.,]?\d*|[.,]\d+)(e[+-]?\d+)?", typed):
            raise ValueError(f"{self.label}: “{text.strip()[:40]}” is no number; allowed are {self.words(self.low)} to "
                             f"{self.words(self.high)} {self.unit}".rstrip())
        return self.cut(round(float(typed.replace(",", ".")) / self.factor, 12), text.strip())

    def cut(self, value, text=None):
        """The value within the slider's span, whole where it must be, and a sentence if that changed it."""
        near = min(max(value, self.low), math.inf if self.endless else self.high)
        near = round(near) if self.whole else near
        text = self.words(value) if text is None else text
        done = "rounded" if self.low <= value <= self.high else "cut"
        return near, "" if near == value else f"{self.label} {text} {done} to {self.words(near)} {self.unit}".rstrip()


_ROWS = catalog.rows("explorer_inputs.csv")
NUMBERS = {row["name"]: Field.of(row) for row in _ROWS}
DESIGN, COEFFICIENTS, MISSION, SOIL = (
    {row["name"]: NUMBERS[row["name"]] for row in _ROWS if row["group"] == group}
    for group in ("design", "model", "mission", "soil"))
DEMANDS = {"minimum_range_km": ("range_km", ">="), "minimum_slope_deg": ("slope_capability_deg", ">="),
           "maximum_mass_kg": ("total_mass_kg", "<="), "minimum_charge": ("minimum_soc", ">="),
           "survive": ("thermal_survival", ">=")}
GOALS = {"range_goal": "range_km", "mass_goal": "total_mass_kg", "slope_goal": "slope_capability_deg"}
METRICS = {"range_km": 2, "total_mass_kg": 2, "slope_capability_deg": 1, "energy_balance_pct": 0,
           "cold_temperature_c": 0, "hot_temperature_c": 0, "wheel_torque_nm": 2, "slip": 2, "sinkage_m": 4,
           "cruise_speed_m_s": 3, "obstacle_capability_m": 3, "minimum_soc": 2, "average_solar_power_w": 1}    # digits
VIEWS = {"log": "Mission log", "mass": "Mass", "wheel": "Wheel", "fleet": "Fleet", "why": "Why", "sweep": "Sweep",
         "optimise": "Optimise"}
OWN, START, NONE, ODDS = "your own", "the design at the start", "none", "odds"
SKY = "site", "site_height_m", "start_utc"


def title(name):
    """The name of a mission in human words, where it is of the catalogue."""
    if name not in catalog.scenario_names():
        return name
    return f"{name.replace('_', ' ').capitalize()}, {place(catalog.scenario(name).latitude_deg)}"


def place(latitude_deg):
    return "equator" if latitude_deg == 0 else f"{abs(latitude_deg):.4g}° {'S' if latitude_deg < 0 else 'N'}"


def label(name):
    """Words and unit of a metric or an input, such as ("range", "km")."""
    return (NUMBERS[name].label, NUMBERS[name].unit) if name in NUMBERS else pictures.label(name)


def same(*names):
    return {name: name for name in names}


_METRICS = {name: label(name)[0] for name in METRICS}
_SWEPT = {name: NUMBERS[name].label for name in (*DESIGN, *MISSION, *SOIL, *COEFFICIENTS)
          if name != "duration_earth_days"}
MENUS = {  # name -> value -> words
    "rover": same(*catalog.rover_names(), OWN),
    "mission": {name: title(name) for name in (*catalog.scenario_names(), OWN)},
    "soil": same(*catalog.soil_names(), OWN),
    "site": {NONE: "none: level horizon", OWN: OWN} | {n: n.replace("_", " ") for n in catalog.skyline_sites()},
    "site_height_m": {1: "1 m up", 2: "2 m up", 10: "10 m up"},
    "wheel_count": {4: "4 wheels", 6: "6 wheels"}, "survive": {0: "may freeze", 1: "must survive"},
    "preset": {"paper": "as in the paper", "engineering": "engineering"}, "view": VIEWS,
    "baseline": same(START, *catalog.rover_names()), "why_metric": _METRICS,
    "sweep_first": _SWEPT, "sweep_second": {"": "nothing else"} | _SWEPT, "sweep_metric": _METRICS,
    "front_x": _METRICS, "front_y": _METRICS, "front_colour": _METRICS | {ODDS: label(ODDS)[0]},
    "live": {False: "once", True: "live"}, "solve_variable": {name: field.label for name, field in DESIGN.items()},
    **dict.fromkeys(GOALS, same("max", "min", "ignore"))}


def check(name, value):
    """The value of an input set from Python, or a ValueError that says what is allowed."""
    if name in MENUS:
        known = {key: choice for choice in MENUS[name] for key in (choice, str(choice))}
        if not isinstance(value, (str, int, float, np.generic)) or value not in known:
            raise ValueError(f"{name} must be one of {', '.join(map(str, MENUS[name]))}; got {value!r}")
        return known[value]
    if name == "start_utc":
        text = str(value).strip()
        if text.lower() in ("", NONE):
            return NONE
        julian_date(text)                                # raises where it is no date
        return text
    if name not in NUMBERS:
        raise _fields.unknown("no input", name, [*NUMBERS, *MENUS, "start_utc"])
    field = NUMBERS[name]
    return _fields.check(name, value, field.low, math.inf if field.endless else field.high, whole=field.whole,
                         infinite=field.endless, scalar=True)
