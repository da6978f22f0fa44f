"""What an evaluation takes: a design, a mission scenario, and the coefficients of the models.

All three are frozen dataclasses of numbers. A population is the same dataclass holding arrays;
`design.replace(wheel_radius_m=0.12)` is a changed copy.
"""
import math
import warnings
from collections import namedtuple
from dataclasses import dataclass, field, fields
from typing import NamedTuple

import numpy as np

from ._fields import Record, check, described, in_rows, number, require, together
from .mass import MassCoefficients
from .sky import Skyline, julian_date
from .terramechanics import KernelOptions, Soil, Wheel


class Variable(NamedTuple):
    """One axis of the design space."""
    low: float
    high: float
    unit: str
    symbol: str
    label: str
    kind: str = "continuous"


def _variable(low, high, unit, symbol, label, **limits):
    """A field of `Design`: one axis of the design space."""
    kind = "choice" if "choices" in limits else "whole" if "whole" in limits else "continuous"
    span = f"{symbol}, {label}; {low:g} to {high:g}{'' if unit == '1' else ' ' + unit} in the design space."
    return number(doc=span, axis=Variable(low, high, unit, symbol, label, kind), **limits)


@dataclass(frozen=True)
class Design(Record):
    """A rover design, or a population of them: the paper's eleven design variables.

    Four wheels are a rigid layout, six a rocker-bogie. The paper's model does not read the wheelbase;
    `Model.frame_mass_kg_m2` gives it a price.
    """
    example = "rdk.rover('Rashid-1')"

    wheel_radius_m: float = _variable(0.05, 0.20, "m", "r", "wheel radius", above=0)
    wheel_width_m: float = _variable(0.03, 0.20, "m", "b", "wheel width", above=0)
    grouser_height_m: float = _variable(0.0, 0.020, "m", "h_g", "grouser height", minimum=0)
    grouser_count: int = _variable(0, 24, "1", "N_g", "grouser count", minimum=0, whole=True)
    wheel_count: int = _variable(4, 6, "1", "N_w", "wheel count", choices=(4, 6))
    chassis_mass_kg: float = _variable(0.5, 50.0, "kg", "m_c", "chassis mass", above=0)
    wheelbase_m: float = _variable(0.3, 1.2, "m", "L_wb", "wheelbase", above=0)
    solar_area_m2: float = _variable(0.1, 1.5, "m2", "A_s", "solar array area", above=0)
    battery_capacity_wh: float = _variable(5.0, 500.0, "Wh", "C_b", "battery capacity", above=0)
    avionics_power_w: float = _variable(5.0, 40.0, "W", "P_a", "avionics power", above=0)
    peak_wheel_torque_nm: float = _variable(0.05, 20.0, "N m", "T_hub", "peak hub torque", above=0)

    @property
    def wheel(self):
        """The wheel of this design, for `rdk.terramechanics`."""
        values = dict(radius_m=self.wheel_radius_m, width_m=self.wheel_width_m, grouser_height_m=self.grouser_height_m,
                      grouser_count=self.grouser_count)
        return Wheel.trusted(together(**{name: np.shape(value) for name, value in values.items()}), values)


DESIGN_SPACE = {f.name: f.metadata["axis"] for f in fields(Design)}
"""The eleven design variables with their search range (the paper's Table 1), unit, symbol and label."""
_LOW = np.array([[v.low * (1 - 1e-12)] for v in DESIGN_SPACE.values()])
_HIGH = np.array([[v.high * (1 + 1e-12)] for v in DESIGN_SPACE.values()])


class Demand(namedtuple("Demand", "field sign limit")):
    """A Performance field, ">=" or "<=", and its limit; `why` says what it is good for."""
    __repr__ = tuple.__repr__

    def __new__(cls, field: str, sign: str, limit: float, why: str = ""):
        demand = super().__new__(cls, field, sign, limit)
        demand.why = why
        return demand

    @classmethod
    def all(cls, wanted, argument: str, infinite: bool = False) -> tuple:
        """Demands from a list of such triples; the limit of a flag may be True or False."""
        if not isinstance(wanted, (list, tuple)) or not all(isinstance(one, (list, tuple)) for one in wanted):
            raise ValueError(f"{argument} must be a list of (field, '>=' or '<=', limit); got {wanted!r:.80}")
        found = []
        for one in wanted:
            if len(one) != 3 or one[1] not in (">=", "<="):
                raise ValueError(f"{argument} must be like ('range_km', '>=', 0.1); got {one!r:.80}")
            limit = float(one[2]) if isinstance(one[2], (bool, np.bool_)) else one[2]
            limit = check(f"{argument}: limit of {one[0]}", limit, infinite=infinite, scalar=True)
            found.append(cls(*one[:2], limit, getattr(one, "why", "")))
        return tuple(found)

    def __str__(self):
        return f"{self.field} {self.sign} {self.limit:g}"

    def slack(self, performance: Record) -> np.ndarray:
        """How far a performance is inside the limit, in the field's unit; below 0 where the demand fails."""
        value = np.asarray(getattr(performance, self.field), float)
        slack = value - self.limit if self.sign == ">=" else self.limit - value
        return np.where(np.isnan(slack), -np.inf, slack)


@dataclass(frozen=True)
class Problem(Record):
    """How a scenario is posed to the optimiser; the defaults are the paper's for its traverse missions.

    `objectives` has Performance fields with a direction, "max" or "min"; `constraints` triples of Performance field,
    ">=" or "<=", and limit; `traverse_limit_km` replaces the scenario's own limit during the search; `seed` is that of
    the paper's run.
    """
    example = "rdk.Problem()"
    objectives: dict = field(default_factory=lambda: {"range_km": "max", "total_mass_kg": "min",
                                                      "slope_capability_deg": "max"})
    constraints: tuple = (("range_km", ">=", 0.1),)
    traverse_limit_km: float | None = number(0, infinite=True, scalar=True, optional=True, default=None)
    seed: int | None = number(0, whole=True, scalar=True, optional=True, default=None)

    def __post_init__(self):
        if not isinstance(self.objectives, dict):        # an empty one is for a search to refuse
            raise ValueError(f"objectives must be a dictionary like {{'range_km': 'max'}}; got {self.objectives!r:.80}")
        for name, way in self.objectives.items():
            if way not in ("max", "min"):
                raise ValueError(f"objectives must be ways: {name} must be 'max' or 'min'; got {way!r:.80}")
        object.__setattr__(self, "constraints", Demand.all(self.constraints, "constraints", infinite=True))
        super().__post_init__()

    def _summary(self):
        import pandas as pd
        words = [*(f"{way} {name}" for name, way in self.objectives.items()), *map(str, self.constraints)]
        return f"Problem: limit {self.traverse_limit_km} km, seed {self.seed}", pd.DataFrame({"asked": words})


@dataclass(frozen=True)
class Scenario(Record):
    """Where a rover drives, for how long, and what it must carry."""
    example = "rdk.scenario('polar_prospecting')"
    apart = ("problem",)

    name: str = described("A label; nothing is computed from it.")
    latitude_deg: float = number(-90, 90, doc="North positive.")
    soil: Soil = described("Everywhere the same.")
    duration_earth_days: float = number(above=0, maximum=3660, scalar=True, doc="One number: it sets the time steps.")
    slope_deg: float = number(above=-90, below=90, doc="Climbed throughout.")
    duty_cycle: float = number(0, 1, doc="Share of the time spent driving.")
    traverse_limit_km: float = number(0, infinite=True, default=math.inf, doc="The rover stops there.")
    payload_mass_kg: float = number(0, default=0.0)
    payload_power_w: float = number(0, default=0.0)
    required_obstacle_height_m: float = number(0, default=0.0, doc="Obstacle that the rover must climb.")
    panel_tilt_deg: float = number(0, 180, default=0.0, doc="From the horizontal.")
    panel_azimuth_deg: float = number(-360, 360, default=180.0, doc="Where the panel faces, clockwise from north.")
    maximum_speed_m_s: float = number(above=0, infinite=True, default=math.inf, doc="Speed that operations allow.")
    start_utc: str | None = described("ISO date and time of the start, for the real sun; None for the paper's, on the "
                                      "equator, rising at the start.", default=None)
    longitude_deg: float = number(-180, 360, default=0.0, doc="East positive; matters with `start_utc` only.")
    skyline: Skyline | None = described(
        "What hides the sun, such as `rdk.skyline('shackleton_rim')`, or elevations (deg) evenly spaced from north "
        "clockwise; the share of the solar disc above it multiplies the power. None for the paper's level cut.",
        default=None, repr=False)
    problem: Problem = described("How `pareto_front` poses the mission when it is told nothing else.",
                                 default_factory=Problem, repr=False)

    def __post_init__(self):
        if self.start_utc is not None:
            try:
                julian_date(self.start_utc if isinstance(self.start_utc, str) else "")
            except ValueError:
                raise ValueError("start_utc must be an ISO date and time, such as '2026-11-26T12:00', or None; "
                                 f"got {self.start_utc!r}") from None
        if self.skyline is not None:
            object.__setattr__(self, "skyline", Skyline.of(self.skyline))
        if not isinstance(self.soil, Soil):
            raise ValueError(f"soil must be a Soil, such as {Soil.example}; got {self.soil!r:.80}")
        require(problem=(self.problem, Problem))
        super().__post_init__()


@dataclass(frozen=True)
class Model(MassCoefficients, KernelOptions):
    """Every coefficient of the models, with the paper's values as defaults; each a number or an array.

    `data/constants.csv` gives unit, origin and source of each, those of `terramechanics.KernelOptions` and
    `mass.MassCoefficients` included. Pass a changed copy to `evaluate`, as `model=Model(drivetrain_efficiency=0.7)`.
    """
    example = "rdk.Model()"

    # terramechanics
    slip_min: float = number(-1, 1, default=-0.9)
    slip_max: float = number(-1, below=1, default=0.95)
    slope_capability_slip: float = number(-1, 1, default=0.6)
    slope_capability_limit_deg: float = number(0, below=90, default=35.0)
    gravity_m_s2: float = number(above=0, default=1.625)
    # mobility
    envelope_density_kg_m3: float = number(above=0, default=145.0)
    rigid_obstacle_ratio: float = number(0, default=0.5)
    rocker_bogie_obstacle_ratio: float = number(0, default=1.25)
    drivetrain_efficiency: float = number(above=0, maximum=1, default=0.8)
    hub_no_load_speed_rad_s: float = number(above=0, infinite=True, default=5.0)
    motor_droop: float = number(0, 1, default=0.0)
    axle_torque: int = number(choices=(0, 1), default=0)
    # power
    solar_constant_w_m2: float = number(0, default=1361.0)
    synodic_day_h: float = number(above=0, default=708.734136)
    panel_efficiency: float = number(0, 1, default=0.28)
    dust_factor: float = number(0, 1, default=0.9)
    charge_efficiency: float = number(above=0, maximum=1, default=0.95)
    discharge_efficiency: float = number(above=0, maximum=1, default=0.95)
    soc_floor: float = number(0, 1, default=0.15)
    soc_initial: float = number(0, 1, default=1.0)
    time_step_h: float = number(above=0, default=1.0, scalar=True)
    stop_at_limit: int = number(choices=(0, 1), default=0)
    exact_floor: int = number(choices=(0, 1), default=0)
    # thermal
    enclosure_emissivity: float = number(above=0, maximum=1, default=0.85)
    enclosure_absorptivity: float = number(0, 1, default=0.3)
    enclosure_sunlit_fraction: float = number(0, 1, default=0.25)
    enclosure_area_base_m2: float = number(0, default=0.05)
    enclosure_area_coefficient_m2: float = number(0, default=0.02)
    hibernation_power_w: float = number(0, default=2.0)
    radioisotope_heater_power_w: float = number(0, default=0.0)
    sink_temperature_hot_k: float = number(0, default=250.0)
    sink_temperature_cold_k: float = number(0, default=100.0)
    operating_temperature_min_c: float = number(default=-30.0)
    operating_temperature_max_c: float = number(default=50.0)

    def __post_init__(self):
        super().__post_init__()
        if np.any(np.asarray(self.slip_min) >= self.slip_max):
            raise ValueError(f"slip_min must be below slip_max; got {self.slip_min} and {self.slip_max}")
        if np.any(np.asarray(self.enclosure_area_base_m2) + self.enclosure_area_coefficient_m2 <= 0):
            raise ValueError("enclosure_area_base_m2 and enclosure_area_coefficient_m2 must not both be 0")

    @classmethod
    def engineering(cls, **changes):
        """What a careful engineer would switch on (column `engineering` of `data/constants.csv`), with `changes`."""
        return cls(**dict(wheel_web_factor=0.5, frame_mass_kg_m2=2.0, motor_droop=1.0, stop_at_limit=1, exact_floor=1)
                   | changes)


def single(**records) -> None:
    """Refuse what is no record, and records that hold arrays; by name: scenario, model, and any name for a design."""
    kinds = {"scenario": Scenario, "model": Model}
    require(**{name: (record, kinds.get(name, Design)) for name, record in records.items()})
    for name, record in records.items():
        if record.shape:
            raise ValueError(f"{name} must be a single one; got arrays of shape {record.shape}")


def warn_outside(design, stacklevel=3):
    """One UserWarning that names the variables of `design` outside DESIGN_SPACE, where the models are unchecked."""
    rows = in_rows([getattr(design, name) for name in DESIGN_SPACE], design.shape)
    beyond = ((rows < _LOW) | (rows > _HIGH)).any(1)
    if beyond.any():
        outside = [f"{name} ({v.low:g} to {v.high:g} {v.unit})"
                   for (name, v), out in zip(DESIGN_SPACE.items(), beyond) if out]
        warnings.warn("design outside the class that the models were checked on: " + ", ".join(outside),
                      UserWarning, stacklevel=stacklevel)
