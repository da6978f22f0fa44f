"""Words for a result: what binds a design, which limits it meets, and the Python call that reproduces it."""
from __future__ import annotations

import dataclasses
from typing import NamedTuple

import numpy as np

from .design import DESIGN_SPACE, Model, Scenario
from .terramechanics import Soil


class Binding(NamedTuple):
    """What limits a design: a key and one sentence."""
    key: str
    sentence: str


class Limit(NamedTuple):
    """A requirement, whether it is met, and the numbers in words."""
    name: str
    met: bool
    words: str


def binding(design, scenario, performance, model=Model()):
    """What binds a single design on its mission.

    Parameters
    ----------
    design, scenario, model
        Single ones, as given to `evaluate`.
    performance : Performance
        What `evaluate` returned for them, with its log.

    Returns
    -------
    Binding
        `key` is one of "soil", "traction", "torque", "duty", "sun", "range limit", "battery", "hub speed"; `sentence`
        says it with numbers.
    """
    p, base = performance, design.avionics_power_w + scenario.payload_power_w
    if p.buried:
        return Binding("soil", "The soil cannot carry the wheels at any sinkage: the rover is buried. Widen or enlarge "
                               "the wheels, or shed mass.")
    if p.stalled and p.wheel_torque_nm > design.peak_wheel_torque_nm:
        also = " Traction fails as well." if p.slip >= model.slip_max else ""
        return Binding("torque", f"Torque binds: climbing {scenario.slope_deg:g} deg takes {p.wheel_torque_nm:.2f} N m at "
                                 f"each wheel, the hub gives {design.peak_wheel_torque_nm:.2f} N m.{also}")
    if p.stalled:
        return Binding("traction", f"Traction binds: no slip develops the pull that {scenario.slope_deg:g} deg demands; "
                                   f"this rover climbs {p.slope_capability_deg:.1f} deg.")
    if p.average_solar_power_w <= base:
        return Binding("sun", f"Sunlight binds: the array averages {p.average_solar_power_w:.1f} W, avionics and payload "
                              f"draw {base:.1f} W, and nothing is left for driving.")
    if scenario.duty_cycle == 0:
        return Binding("duty", "The duty cycle is 0: the rover never drives.")
    if p.range_km >= scenario.traverse_limit_km:
        return Binding("range limit", f"The range limit binds: the rover reaches the mission's "
                                      f"{scenario.traverse_limit_km:g} km before the time is up.")
    throttled = p.log.throttled.mean() if p.log is not None else 0.0
    if throttled > 0.02:
        return Binding("battery", f"The battery binds: it stands on its {100 * model.soc_floor:.0f} % floor and cuts "
                                  f"driving in {100 * throttled:.0f} % of the hours; "
                                  f"cruise speed is {100 * p.cruise_speed_m_s:.1f} cm/s.")
    if p.hub_speed_limited:
        return Binding("hub speed", f"Hub speed binds: sunlight would pay for {p.energy_balance_speed_m_s:.1f} m/s, the "
                                    f"hub turns for {100 * p.cruise_speed_m_s:.1f} cm/s at most.")
    return Binding("sun", f"Sunlight binds: what the array yields above avionics and payload pays for "
                          f"{100 * p.cruise_speed_m_s:.1f} cm/s.")


def limits(design, scenario, performance):
    """The mission's requirements beside what the design does.

    Returns
    -------
    list of Limit
        Slope, torque, energy balance, range, obstacle, lunar night: each met or missed, in words.
    """
    p = performance
    torque = "no solution" if np.isnan(p.wheel_torque_nm) else f"{p.wheel_torque_nm:.2f} N m needed"
    return [
        Limit("slope", bool(p.slope_capability_deg >= scenario.slope_deg),
              f"climbs {p.slope_capability_deg:.1f} deg, mission {scenario.slope_deg:g} deg"),
        Limit("torque", bool(p.wheel_torque_nm <= design.peak_wheel_torque_nm),
              f"{torque}, hub gives {design.peak_wheel_torque_nm:g} N m"),
        Limit("energy", bool(p.energy_balance_pct >= 0), f"balance {p.energy_balance_pct:+.0f} %, at least 0 %"),
        Limit("range", bool(p.range_km > 0), f"{p.range_km:.2f} km of {scenario.traverse_limit_km:g} km"),
        Limit("obstacle", bool(p.obstacle_capability_m >= scenario.required_obstacle_height_m),
              f"climbs {100 * p.obstacle_capability_m:.1f} cm, mission {100 * scenario.required_obstacle_height_m:g} cm"),
        Limit("lunar night", bool(p.thermal_survival),
              f"{p.hot_temperature_c:.0f} degC at noon, {p.cold_temperature_c:.0f} degC at night"),
    ]


def as_python(design, scenario, call="rdk.evaluate(design, mission)"):
    """Python that rebuilds a design and a mission and makes a call with them.

    Parameters
    ----------
    design : Design
    scenario : Scenario
        Single ones.
    call : str
        Expression in `design` and `mission`, assigned to `result`.

    Returns
    -------
    str
        Source text that runs as it stands.
    """
    soil_fields = [f.name for f in dataclasses.fields(Soil)]
    fields = [f.name for f in dataclasses.fields(Scenario) if f.name not in ("soil", "study")]
    lines = ["import rdk", "", "design = rdk.Design("]
    lines += [f"    {name}={getattr(design, name)!r}," for name in DESIGN_SPACE]
    lines += [")", "soil = rdk.Soil("]
    lines += [f"    {name}={getattr(scenario.soil, name)!r}," for name in soil_fields]
    lines += [")", "mission = rdk.Scenario(", "    soil=soil,"]
    lines += [f"    {name}={_source(getattr(scenario, name))}," for name in fields]
    return "\n".join([*lines, ")", f"result = {call}", ""])


def _source(value):
    """repr, but for infinity, which is no Python name."""
    return 'float("inf")' if isinstance(value, float) and value == float("inf") else repr(value)
