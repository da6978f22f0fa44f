"""Exercises of notebook 16, design your rover: briefs as data, and a judge for any of them."""
from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache
from typing import NamedTuple

import numpy as np

from rdk import catalog
from rdk.design import DESIGN_SPACE, Design, Model, Problem, Scenario
from rdk.mission import evaluate
from rdk.sampling import demands, intervals

from .judging import Exercise

EXERCISES = {}
"""The exercises of these notebooks by number."""
DRAWS, SEED = 8192, 16                                   # 8,192 draws know a share to half a percentage point


# ---- briefs and their judge ------------------------------------------------------------------------------------

@dataclass(frozen=True)
class Brief:
    """What a rover must do, and how surely.

    Attributes
    ----------
    scenario : Scenario
    demands : tuple of (str, str, float)
        Such as ("range_km", ">=", 10), on fields of Performance; that it drives the mission is demanded as well.
    confidence : float
        Joint share of draws of the uncertain inputs in which all demands must hold.
    limits : dict of str to (float, float)
        What the project allows of design variables.
    guess : Design
        Where to start; no answer.
    """
    scenario: Scenario
    demands: tuple
    confidence: float
    limits: Mapping = field(default_factory=dict)
    guess: Design = field(default_factory=lambda: catalog.rover("Rashid-1"))

    def __post_init__(self):
        demands(self.demands, "demands")

    @property
    def mission(self):
        """The scenario with the demands in its `problem`, as the explorer and the report read them."""
        return self.scenario.replace(problem=Problem(constraints=self.demands))

    @property
    def judged(self):
        """All that is judged: first that it climbs the obstacle of the scenario and drives the mission."""
        height = self.scenario.required_obstacle_height_m
        return *([("obstacle_capability_m", ">=", height)] if height > 0 else []), ("feasible", ">=", 1), *self.demands

    @property
    def tolerance(self):
        """Two standard errors of a share of that many draws."""
        return 2 * np.sqrt(self.confidence * (1 - self.confidence) / DRAWS)


class Judged(NamedTuple):
    """How a design does on a brief: nominal value and share of draws by demand, joint share, what is missing or ""."""
    values: tuple
    shares: tuple
    joint: float
    missing: str


def words(demand):
    """A demand as a student wrote it."""
    name, sign, limit = demand
    return f"{name} {sign} {limit:g}"


def _holds(demand, value):
    return value >= demand[2] if demand[1] == ">=" else value <= demand[2]


def judged(design, brief, draws=DRAWS, seed=SEED):
    """Judge one design by a brief: its limits, each demand at the nominal values, all demands together in the draws."""
    found = intervals(design, brief.scenario, draws=draws, seed=seed)
    values = tuple(float(found.nominal[demand[0]]) for demand in brief.judged)
    shares = tuple(float(found.share([demand])) for demand in brief.judged)
    joint = float(found.share(brief.judged))
    outside = [name for name, (low, high) in brief.limits.items() if not low <= getattr(design, name) <= high]
    failed = [demand for demand, value in zip(brief.judged, values) if not _holds(demand, value)]
    missing = ""
    if outside:
        low, high = brief.limits[outside[0]]
        missing = (f"{outside[0]} is {getattr(design, outside[0]):g}, outside the limits of the brief, {low:g} to "
                   f"{high:g}.")
    elif failed:
        value = values[brief.judged.index(failed[0])]
        missing = f"Missed before any uncertainty comes in: {words(failed[0])}; it is {value:.4g}."
    elif joint < brief.confidence - brief.tolerance:
        weakest = brief.judged[int(np.argmin(shares))]
        missing = (f"All demands together hold in {100 * joint:.1f} % of the draws, asked for are "
                   f"{100 * brief.confidence:g} %. The one that fails most often: {words(weakest)}.")
    return Judged(values, shares, joint, missing)


def compare(designs, brief, draws=DRAWS):
    """Candidates side by side, a pandas DataFrame of text: values, shares of draws, joint share, mass to spare.

    `designs` is a dictionary of name to Design. The rows are those of `brief.judged`: obstacle and `feasible` first.
    """
    import pandas as pd
    columns = {}
    for name, design in designs.items():
        found = judged(design, brief, draws)
        rows = {words(demand): f"{value:.4g} ({100 * share:.0f} %)"
                for demand, value, share in zip(brief.judged, found.values, found.shares)}
        rows["all together"] = f"{100 * found.joint:.1f} %"
        mass = float(evaluate(design, brief.scenario).total_mass_kg)
        allowed = [limit for what, sign, limit in brief.demands if (what, sign) == ("total_mass_kg", "<=")]
        rows["mass"] = f"{mass:.2f} kg"
        rows["mass to spare"] = f"{min(allowed) - mass:.2f} kg" if allowed else "no limit"
        rows["verdict"] = "accepted" if not found.missing else "not yet"
        columns[name] = rows
    return pd.DataFrame(columns)


def trade(design, brief, step=0.1, draws=2048):
    """What a step of each variable does to mass, joint share and hub torque to spare; a pandas DataFrame.

    Each grows by `step` of its value, grousers by two and 2 mm at least, none beyond the limits of the brief; wheel
    count and wheelbase stay.
    """
    import pandas as pd
    names = [name for name in DESIGN_SPACE if name not in ("wheel_count", "wheelbase_m", "grouser_count")]
    values = {name: np.full(len(names) + 1, float(getattr(design, name))) for name in DESIGN_SPACE}

    def grow(name, row, least=0.0):
        low, high = brief.limits.get(name, (DESIGN_SPACE[name].low, DESIGN_SPACE[name].high))
        values[name][row] = np.clip(values[name][0] + max(step * values[name][0], least), low, high)

    for row, name in enumerate(names, 1):
        grow(name, row, 0.002 if name == "grouser_height_m" else 0.0)
    grow("grouser_count", names.index("grouser_height_m") + 1, 2)            # neither does anything without the other
    values["grouser_count"] = np.rint(values["grouser_count"])
    designs = Design(**values)
    share = 100 * intervals(designs, brief.scenario, draws=draws, seed=SEED).share(brief.judged)
    found = evaluate(designs, brief.scenario)
    mass, spare = found.total_mass_kg, designs.peak_wheel_torque_nm - found.wheel_torque_nm
    table = pd.DataFrame({"to": [values[name][row] for row, name in enumerate(names, 1)],
                          "mass (kg)": mass[1:] - mass[0], "all together (points)": share[1:] - share[0]}, names)
    table["points for a kg"] = table["all together (points)"] / table["mass (kg)"].where(table["mass (kg)"] > 1e-9)
    table["torque to spare (N m)"] = spare[1:]
    return table.rename(index={"grouser_height_m": "grousers (height, count)"})


def _rashid(**changes):
    return catalog.rover("Rashid-1").replace(**changes)


_RIM = catalog.skyline("shackleton_rim")
BRIEFS = {
    "swirl": Brief(
        Scenario(name="reiner_gamma_swirl", latitude_deg=7.5, soil=catalog.soil("apollo-nominal"),
                 duration_earth_days=13, slope_deg=12, duty_cycle=0.1, traverse_limit_km=20, payload_mass_kg=4,
                 payload_power_w=12, required_obstacle_height_m=0.06, panel_tilt_deg=0),
        (("range_km", ">=", 10), ("slope_capability_deg", ">=", 18), ("minimum_soc", ">=", 0.2),
         ("total_mass_kg", "<=", 19)), 0.70,
        {"wheel_radius_m": (0.05, 0.15), "wheel_width_m": (0.05, 0.20), "grouser_height_m": (0.0, 0.015),
         "chassis_mass_kg": (3.0, 12.0), "solar_area_m2": (0.1, 0.5), "avionics_power_w": (10.0, 10.0)},
        _rashid(wheel_radius_m=0.12, avionics_power_w=10, solar_area_m2=0.4, battery_capacity_wh=200)),
    "rim": Brief(
        Scenario(name="shackleton_rim_survey", latitude_deg=_RIM.latitude_deg, longitude_deg=_RIM.longitude_deg,
                 skyline=_RIM, start_utc="2027-01-03", soil=catalog.soil("apollo-nominal"), duration_earth_days=12,
                 slope_deg=8, duty_cycle=0.1, traverse_limit_km=8, maximum_speed_m_s=0.05, payload_mass_kg=3,
                 payload_power_w=4, required_obstacle_height_m=0.05, panel_tilt_deg=88, panel_azimuth_deg=305),
        (("range_km", ">=", 4), ("slope_capability_deg", ">=", 12), ("unserved_h", "<=", 0),
         ("total_mass_kg", "<=", 14.5)), 0.80,
        {"wheel_radius_m": (0.05, 0.14), "wheel_width_m": (0.05, 0.15), "grouser_height_m": (0.0, 0.015),
         "chassis_mass_kg": (2.5, 12.0), "solar_area_m2": (0.1, 0.6), "avionics_power_w": (5.0, 5.0)},
        _rashid(avionics_power_w=5, chassis_mass_kg=4, battery_capacity_wh=100, solar_area_m2=0.3)),
    "scout": Brief(
        Scenario(name="highland_scout", latitude_deg=-9, soil=catalog.soil("apollo-loose"), duration_earth_days=6,
                 slope_deg=3, duty_cycle=0.1, traverse_limit_km=5, maximum_speed_m_s=0.1, payload_mass_kg=1,
                 payload_power_w=3, required_obstacle_height_m=0.05, panel_tilt_deg=0),
        (("range_km", ">=", 2), ("slope_capability_deg", ">=", 5), ("minimum_soc", ">=", 0.2),
         ("structure_share", ">=", 0.2), ("wheel_gap_m", ">=", 0), ("total_mass_kg", "<=", 10.5)), 0.75,
        {"wheel_radius_m": (0.05, 0.10), "wheel_width_m": (0.05, 0.12), "grouser_height_m": (0.0, 0.015),
         "chassis_mass_kg": (1.0, 8.0), "solar_area_m2": (0.1, 0.4), "avionics_power_w": (5.0, 5.0)},
        _rashid(avionics_power_w=5, chassis_mass_kg=2, wheel_radius_m=0.08, battery_capacity_wh=60,
                solar_area_m2=0.15, peak_wheel_torque_nm=0.4))}
"""The briefs of the notebook: a sunlit plain, a polar rim with thirty hours of night, loose soil at low mass."""


# ---- 16 design your rover --------------------------------------------------------------------------------------

SWIRL = BRIEFS["swirl"]


def _swirl_slope(soil):
    return evaluate(SWIRL.guess, SWIRL.scenario.replace(soil=catalog.soil(soil))).slope_capability_deg


@cache
def _first_morning():
    """Hour by hour on the swirl, standing still, with 0.45 m2 of array and a battery that never runs low."""
    rover = SWIRL.guess.replace(solar_area_m2=0.45, battery_capacity_wh=500)
    return evaluate(rover, SWIRL.scenario.replace(duty_cycle=0.0)).log


def _drained_wh():
    return 500 - _first_morning().stored_wh.min()


EXERCISES["16.1"] = Exercise(
    "number", lambda: SWIRL.scenario.required_obstacle_height_m / Model().rigid_obstacle_ratio,
    "The obstacle that a rover climbs is a multiple of its wheel radius; the suspension decides which.",
    {"That is the radius for six wheels on a rocker-bogie; the question asks for four on a rigid chassis.":
        lambda: SWIRL.scenario.required_obstacle_height_m / Model().rocker_bogie_obstacle_ratio,
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
    "number", lambda: _swirl_slope("sourcebook-trafficability"),
    "Replace the soil of the mission, evaluate the first guess on it, and read slope_capability_deg.",
    {"That is the capability in the mission's own soil: replace the soil first.":
        lambda: _swirl_slope("apollo-nominal"),
     "That is the loss, or gain, and not the capability itself.":
        lambda: _swirl_slope("sourcebook-trafficability") - _swirl_slope("apollo-nominal"),
     "apollo-loose is another soil: looser, and not only weaker in friction.": lambda: _swirl_slope("apollo-loose")})


# open: many answers are right, and none is stored
for _number, _name in ("16.4", "swirl"), ("16.5", "rim"), ("16.6", "scout"):
    EXERCISES[_number] = Exercise("Design", None, "", judge=lambda design, name=_name: judged(
        design, BRIEFS[name]).missing)
