"""Words for a result: what binds a design, which limits it meets, and the Python call that reproduces it."""
from __future__ import annotations

import dataclasses
from typing import NamedTuple

import numpy as np

from . import catalog
from ._fields import require
from .design import DESIGN_SPACE, Design, Model, Scenario
from .mission import evaluate
from .pictures import label
from .sampling import replaced
from .sky import Skyline
from .terramechanics import Soil


LEVERS = {"hub speed": "hub_no_load_speed_rad_s", "sun": "solar_area_m2", "battery": "battery_capacity_wh"}


class Binding(NamedTuple):
    """What limits a design: a key, one sentence, and what more of each lever would bring."""
    key: str
    sentence: str
    detail: str = ""


class Limit(NamedTuple):
    """What a mission needs of one Performance field, whether it is met, and the need in words."""
    metric: str
    met: bool
    words: str


def binding(design, scenario, performance, *, model=Model()):
    """What binds a single design on its mission.

    A design that drives, but not to the range limit, is bound by the lever of which 10 % more gains most range: hub
    speed, array or battery, each with its effect on mass.

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
        says it with numbers, `detail` compares the levers.
    """
    p, base = performance, design.avionics_power_w + scenario.payload_power_w
    if p.buried:
        return Binding("soil", "The soil cannot carry the wheels at any sinkage: the rover is buried. Widen or enlarge "
                               "the wheels, or shed mass.")
    if p.stalled and p.wheel_torque_nm > design.peak_wheel_torque_nm:
        also = " Traction fails as well." if p.slip >= model.slip_max else ""
        return Binding("torque", f"Torque binds: climbing {scenario.slope_deg:g} deg takes {p.wheel_torque_nm:.2f} N m "
                                 f"at each wheel, the hub gives {design.peak_wheel_torque_nm:.2f} N m.{also}")
    if p.stalled:
        return Binding("traction", f"Traction binds: no slip develops the pull that {scenario.slope_deg:g} deg "
                                   f"demands; this rover climbs {p.slope_capability_deg:.1f} deg.")
    if p.average_solar_power_w <= base:
        return Binding("sun", f"Sunlight binds: the array averages {p.average_solar_power_w:.1f} W, avionics and "
                              f"payload draw {base:.1f} W, and nothing is left for driving.")
    if scenario.duty_cycle == 0:
        return Binding("duty", "The duty cycle is 0: the rover never drives.")
    if p.range_km >= scenario.traverse_limit_km:
        return Binding("range limit", f"The range limit binds: the rover reaches the mission's "
                                      f"{scenario.traverse_limit_km:g} km before the time is up.")
    gains = _gains(design, scenario, performance, model)
    key = max(gains, key=gains.get)
    detail = "10 % more hub speed gives {:.1f} % more range, array {:.1f} %, battery {:.1f} %".format(*gains.values())
    if p.log is not None and p.log.throttled.any():
        detail += f"; in {100 * p.log.throttled.mean():.0f} % of the hours the pack is empty and sunlight alone decides"
    return Binding(key, {
        "hub speed": "Hub speed binds: sunlight would pay for " + (
            f"{p.energy_balance_speed_m_s:.1f} m/s" if p.energy_balance_speed_m_s < 10 else "far more")
            + f", the hub turns for {100 * p.cruise_speed_m_s:.1f} cm/s at most.",
        "sun": f"Sunlight binds: what the array yields above avionics and payload pays for "
               f"{100 * p.cruise_speed_m_s:.1f} cm/s.",
        "battery": f"The battery binds: it falls to {100 * p.minimum_soc:.0f} %, and driving stops."}[key], detail
                   + ".")


def _gains(design, scenario, performance, model):
    """Percent more range from 10 % more of each lever; from 9 % less where more would leave the design space."""
    now = {**design.numbers(), **model.numbers()}
    factors = np.array([1.1 if name not in DESIGN_SPACE or now[name] * 1.1 <= DESIGN_SPACE[name].high else 1 / 1.1
                        for name in LEVERS.values()])
    lanes = {name: np.where(np.arange(len(LEVERS)) == i, factors[i], 1) * now[name]
             for i, name in enumerate(LEVERS.values())}
    *changed, model = replaced(design, dataclasses.replace(scenario, traverse_limit_km=np.inf), model, lanes)
    ratio = np.maximum(evaluate(*changed, model=model).range_km, 1e-9) / max(performance.range_km, 1e-9)
    return dict(zip(LEVERS, np.minimum(100 * (np.where(factors > 1, ratio, 1 / ratio) - 1), 999.0).tolist()))


def verdict(design, scenario, performance, *, model=Model()):
    """Whether a single design does its mission, in one sentence, and whether it does.

    Parameters
    ----------
    design, scenario, performance, model
        As for `binding`; the scenario's constraints count as well.

    Returns
    -------
    met : bool
    sentence : str
    """
    p, limit = performance, scenario.traverse_limit_km
    if p.buried:
        drive = "Sinks: the soil cannot carry it"
    elif p.stalled and p.wheel_torque_nm > design.peak_wheel_torque_nm:
        drive = f"Does not drive: {scenario.slope_deg:g}° is too steep for its hubs"
    elif p.stalled:
        drive = f"Does not drive: its wheels slip on {scenario.slope_deg:g}°"
    elif p.range_km <= 0:
        drive = "Does not drive: no power or no time for it"
    elif p.range_km >= limit:
        days = scenario.duration_earth_days
        hour = np.inf if p.log is None else p.log.time_h[np.argmax(p.log.distance_km >= limit * (1 - 1e-12))]
        spare = f" on day {hour / 24:.1f} of {days:g}" if np.isfinite(hour) else ""
        drive = f"Drives the whole route of {limit:g} km{spare}"
    else:
        drive = f"Drives {p.range_km:.3g} km" if np.isinf(limit) else f"Drives {p.range_km:.3g} of {limit:g} km"
    bad = [words for words, holds in (
        ("freezes at night", p.cold_temperature_c >= model.operating_temperature_min_c),
        ("overheats at noon", p.hot_temperature_c <= model.operating_temperature_max_c),
        ("spends more energy than it gains", p.energy_balance_pct >= 0 or p.range_km <= 0),
        (f"cannot climb a step of {1000 * scenario.required_obstacle_height_m:.0f} mm",
         p.obstacle_capability_m >= scenario.required_obstacle_height_m)) if not holds]
    missed = [words for metric, sign, least in scenario.problem.constraints for words, value in
              [(f"misses {label(metric)[0]} {sign} {least:g} {label(metric)[1]}".rstrip(), float(getattr(p, metric)))]
              if not (value >= least if sign == ">=" else value <= least) and not (metric == "range_km" and value <= 0)]
    words = [drive, *bad, *missed]
    sentence = ", ".join(words[:-1]) + ", and " * (len(words) > 1) + words[-1] + "."
    return bool(p.range_km > 0 and not bad and not missed), sentence


def levers(design, scenario, performance, key, *, model=Model()):
    """What 10 % more of each lever brings against what binds: (field, words, gain, unit) by falling gain.

    `key` is that of `binding`. The gain is in range, in slope capability where traction binds, in torque to spare
    where torque does, in mean sunlight where the array does not feed the avionics.
    """
    if key in ("duty", "range limit"):
        return []
    names, metric, unit = {
        "traction": (("wheel_radius_m", "wheel_width_m", "grouser_height_m"), "slope_capability_deg", "°"),
        "soil": (("wheel_radius_m", "wheel_width_m"), "slope_capability_deg", "°"),
        "torque": (("peak_wheel_torque_nm", "wheel_radius_m"), "wheel_torque_nm", "N m")}.get(
            key, ((*LEVERS.values(), "wheel_radius_m"), "range_km", "km"))
    if key == "sun" and performance.range_km <= 0:
        names, metric, unit = ("solar_area_m2",), "average_solar_power_w", "W"
    now = {**design.numbers(), **model.numbers()}
    spans = [DESIGN_SPACE[name].high if name in DESIGN_SPACE else np.inf for name in names]
    more = [min(1.1 * now[name], high) for name, high in zip(names, spans)]
    lanes = {name: np.where(np.arange(len(names)) == i, more[i], now[name]) for i, name in enumerate(names)}
    free = dataclasses.replace(scenario, traverse_limit_km=np.inf)
    *changed, model = replaced(design, free, model, lanes)
    found = getattr(evaluate(*changed, model=model), metric) - getattr(performance, metric)
    if key == "torque":                                  # to spare: what the hub gives less what the wheel takes
        found = np.array([m - now[n] if n == "peak_wheel_torque_nm" else 0.0 for n, m in zip(names, more)]) - found
    words = {**{f: w for w, f in LEVERS.items()}, "solar_area_m2": "array", "wheel_radius_m": "wheel radius",
             "wheel_width_m": "wheel width", "grouser_height_m": "grouser height", "peak_wheel_torque_nm": "hub torque"}
    rows = [(name, words[name], float(np.nan_to_num(gain)), unit) for name, gain, m in zip(names, found, more)
            if m > now[name]]
    return sorted(rows, key=lambda lever: -lever[2])


def limits(design, scenario, performance, *, model=Model()):
    """The mission's requirements, each met or missed by what the design does.

    Parameters
    ----------
    design, scenario, performance, model
        As for `binding`.

    Returns
    -------
    list of Limit
        Range, slope, torque, energy balance, obstacle, stall, and the temperatures at noon and in the night.
    """
    p, s = performance, scenario
    slope = f"{s.slope_deg:g} deg at slip {model.slope_capability_slip:g}"
    if p.slope_capability_deg < s.slope_deg and not p.stalled:       # some wheels pull more at a higher slip
        slope += f" (climbed at slip {p.slip:.2f})"
    return [
        Limit("range_km", bool(p.range_km > 0), f"above 0, limit {s.traverse_limit_km:g} km"),
        Limit("slope_capability_deg", bool(p.slope_capability_deg >= s.slope_deg), slope),
        Limit("wheel_torque_nm", bool(p.wheel_torque_nm <= design.peak_wheel_torque_nm),
              f"at most {design.peak_wheel_torque_nm:.3g} N m"),
        Limit("energy_balance_pct", bool(p.energy_balance_pct >= 0), "0 % or more"),
        Limit("obstacle_capability_m", bool(p.obstacle_capability_m >= s.required_obstacle_height_m),
              f"{s.required_obstacle_height_m:g} m"),
        Limit("stalled", not p.stalled and not p.buried, "must drive the slope"),
        Limit("thermal_survival", bool(p.thermal_survival),
              f"{p.cold_temperature_c:.0f} to {p.hot_temperature_c:.0f} °C, allowed "
              f"{model.operating_temperature_min_c:g} "
              f"to {model.operating_temperature_max_c:g}")]


def as_python(design, scenario, model, *calls, baseline=None):
    """Python that rebuilds a design, a mission and a model, and makes calls with them.

    Parameters
    ----------
    design : Design
    scenario : Scenario
    model : Model
        Single ones.
    calls : str
        Lines that use `design`, `mission` and `model`.
    baseline : Design, optional
        A second design, for the calls to use as `baseline`.

    Returns
    -------
    str
        Source text that runs as it stands.
    """
    require(design=(design, Design), scenario=(scenario, Scenario), model=(model, Model))
    changed = {f.name: getattr(model, f.name) for f in dataclasses.fields(Model) if getattr(model, f.name) != f.default}
    mission = {f.name: getattr(scenario, f.name) for f in dataclasses.fields(Scenario)
               if f.name not in ("soil", "problem") and getattr(scenario, f.name) != f.default}
    soil = {f.name: getattr(scenario.soil, f.name) for f in dataclasses.fields(Soil)}
    rovers = {"design": design} | ({} if baseline is None else {"baseline": baseline})
    parts = [_built(name, "Design", {n: getattr(rover, n) for n in DESIGN_SPACE}) for name, rover in rovers.items()]
    parts += [_built("soil", "Soil", soil), _built("mission", "Scenario", mission, "    soil=soil,"),
              _built("model", "Model", changed)]
    return "\n".join(["import rdk", "", *parts, *calls, ""])


def site_of(skyline):
    """Name and height (m) of the tabulated site whose skyline this is; None where it is no such site's."""
    site, height = skyline.name.partition(",")[0], skyline.height_m
    known = site in (sites := catalog.skyline_sites()) and height in sites[site]["heights_m"]
    return (site, int(height)) if known and skyline == catalog.skyline(site, height) else None


def _built(name, kind, values, *more):
    """Source of `name = rdk.kind(...)`; infinity has no literal in Python, nor has a skyline."""
    def literal(value):
        if isinstance(value, Skyline):
            if site := site_of(value):
                return "rdk.skyline({!r}, {})".format(*site)
            return f"rdk.sky.Skyline({value.azimuth_deg.tolist()}, {value.elevation_deg.tolist()})"
        return f"float({str(value)!r})" if value in (np.inf, -np.inf) else repr(value)

    lines = [f"    {field}={literal(value)}," for field, value in values.items()]
    return "\n".join([f"{name} = rdk.{kind}(", *lines, *more, ")"]) if lines else f"{name} = rdk.{kind}()"
