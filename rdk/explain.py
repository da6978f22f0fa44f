"""Words for a result: names and units, what binds a design, which limits it meets, the Python that reproduces it."""
import dataclasses
from collections import namedtuple

import numpy as np

from . import catalog
from .design import DESIGN_SPACE, Model
from .mission import evaluate
from .sampling import holds, replaced, single
from .sky import Skyline
from .terramechanics import Soil

LEVERS = {"hub speed": "hub_no_load_speed_rad_s", "sun": "solar_area_m2", "battery": "battery_capacity_wh"}
UNITS = {"kn_m_n1": "kN/mⁿ⁺¹", "kn_m_n2": "kN/mⁿ⁺²", "kg_m2": "kg/m²", "kg_nm": "kg/N m", "kg_w": "kg/W",
         "wh_kg": "Wh/kg", "rad_s": "rad/s", "m_s": "m/s", "km": "km", "kg": "kg", "nm": "N m", "mm": "mm", "m2": "m²",
         "wh": "Wh", "kpa": "kPa", "deg": "°", "pct": "%", "m": "m", "w": "W", "c": "°C", "k": "K", "h": "h"}
WORDS = {"total_mass": "mass", "average_solar_power": "mean sunlight", "final_soc": "charge at the end",
         "minimum_soc": "lowest charge", "hot_temperature": "noon temperature", "cold_temperature": "night temperature",
         "thermal_survival": "survival of heat and cold", "energy_balance_speed": "energy-balance speed",
         "feasible": "drives the mission", "odds": "odds of the demands", "growth": "margin", "solar_area": "array",
         "hub_no_load_speed": "hub speed", "peak_wheel_torque": "hub torque"}
Binding = namedtuple("Binding", "key sentence detail", defaults=[""])
"""What limits a design: a key, one sentence, and what more of each lever would bring."""


def label(name):
    """Words and unit of a field by its name, such as ("range", "km") of "range_km"."""
    unit = next((unit for unit in UNITS if name.endswith("_" + unit)), "")
    bare = name.removesuffix("_" + unit)
    return WORDS.get(bare, bare.replace("_", " ")), UNITS.get(unit, "")


def named(name):
    """A field's words with its unit, such as "range (km)"."""
    words, unit = label(name)
    return f"{words} ({unit})" if unit else words


def stuck(design, performance):
    """Why a single design does not drive: "soil", "torque", "traction", or "" where it does."""
    if not performance.stalled:
        return ""
    weak = performance.wheel_torque_nm > design.peak_wheel_torque_nm
    return "soil" if performance.buried else "torque" if weak else "traction"


def binding(design, scenario, performance, *, model=Model()):
    """What binds a single design on its mission; `performance` is what `evaluate` returned, with its log.

    A design that drives, but not to the range limit, is bound by the lever of which 10 % more gains most range: hub
    speed, array or battery. The key is one of "soil", "traction", "torque", "duty", "sun", "range limit", "battery",
    "hub speed"; the detail compares the levers.
    """
    p, s, base = performance, scenario, design.avionics_power_w + scenario.payload_power_w
    key = stuck(design, p) or (
        "sun" if p.average_solar_power_w <= base else "duty" if s.duty_cycle == 0
        else "range limit" if p.range_km >= s.traverse_limit_km else "")
    also = " Traction fails as well." if p.slip >= model.slip_max else ""
    sentences = {
        "soil": "The soil cannot carry the wheels at any sinkage: the rover is buried. Widen or enlarge the wheels, or "
                "shed mass.",
        "torque": f"Torque binds: climbing {s.slope_deg:g} deg takes {p.wheel_torque_nm:.2f} N m at each wheel, the "
                  f"hub gives {design.peak_wheel_torque_nm:.2f} N m.{also}",
        "traction": f"Traction binds: no slip develops the pull that {s.slope_deg:g} deg demands; this rover climbs "
                    f"{p.slope_capability_deg:.1f} deg.",
        "sun": f"Sunlight binds: the array averages {p.average_solar_power_w:.1f} W, avionics and payload draw "
               f"{base:.1f} W, and nothing is left for driving.",
        "duty": "The duty cycle is 0: the rover never drives.",
        "range limit": f"The range limit binds: the rover reaches the mission's {s.traverse_limit_km:g} km before the "
                       "time is up."}
    if key:
        return Binding(key, sentences[key])
    gains = _gains(design, scenario, p, model)
    detail = "10 % more hub speed gives {:.1f} % more range, array {:.1f} %, battery {:.1f} %".format(*gains.values())
    if p.log is not None and p.log.throttled.any():
        detail += f"; in {100 * p.log.throttled.mean():.0f} % of the hours the pack is empty and sunlight alone decides"
    paid = f"{p.energy_balance_speed_m_s:.1f} m/s" if p.energy_balance_speed_m_s < 10 else "far more"
    speed, key = f"{100 * p.cruise_speed_m_s:.1f} cm/s", max(gains, key=gains.get)
    sentences = {"hub speed": f"Hub speed binds: sunlight would pay for {paid}, the hub turns for {speed} at most.",
                 "sun": f"Sunlight binds: what the array yields above avionics and payload pays for {speed}.",
                 "battery": f"The battery binds: it falls to {100 * p.minimum_soc:.0f} %, and driving stops."}
    return Binding(key, sentences[key], detail + ".")


def _each_alone(design, scenario, model, values):
    """Performance, without a range limit, of each change in `values` (field -> value) made alone."""
    now = {**design.numbers(), **model.numbers()}
    lanes = {name: np.where(np.arange(len(values)) == i, value, now[name])
             for i, (name, value) in enumerate(values.items())}
    *changed, model = replaced(design, dataclasses.replace(scenario, traverse_limit_km=np.inf), model, lanes)
    return evaluate(*changed, model=model)


def _gains(design, scenario, performance, model):
    """Percent more range from 10 % more of each lever; from 9 % less where more would leave the design space."""
    now = {**design.numbers(), **model.numbers()}
    factors = np.array([1.1 if name not in DESIGN_SPACE or now[name] * 1.1 <= DESIGN_SPACE[name].high else 1 / 1.1
                        for name in LEVERS.values()])
    changed = _each_alone(design, scenario, model, {n: f * now[n] for n, f in zip(LEVERS.values(), factors)})
    ratio = np.maximum(changed.range_km, 1e-9) / max(performance.range_km, 1e-9)
    return dict(zip(LEVERS, np.minimum(100 * (np.where(factors > 1, ratio, 1 / ratio) - 1), 999.0).tolist()))


def levers(design, scenario, performance, key, *, model=Model()):
    """What 10 % more of each lever brings against what binds: (field, words, gain, unit) by falling gain.

    `key` is that of `binding`. The gain is in range, in slope capability where traction binds, in torque to spare
    where torque does, in mean sunlight where the array does not feed the avionics.
    """
    if key in ("duty", "range limit"):
        return []
    names, metric = {
        "traction": (("wheel_radius_m", "wheel_width_m", "grouser_height_m"), "slope_capability_deg"),
        "soil": (("wheel_radius_m", "wheel_width_m"), "slope_capability_deg"),
        "torque": (("peak_wheel_torque_nm", "wheel_radius_m"), "wheel_torque_nm")}.get(
            key, ((*LEVERS.values(), "wheel_radius_m"), "range_km"))
    if key == "sun" and performance.range_km <= 0:
        names, metric = ("solar_area_m2",), "average_solar_power_w"
    now = {**design.numbers(), **model.numbers()}
    more = {name: min(1.1 * now[name], DESIGN_SPACE[name].high if name in DESIGN_SPACE else np.inf) for name in names}
    gains = getattr(_each_alone(design, scenario, model, more), metric) - getattr(performance, metric)
    if key == "torque":                                  # to spare: what the hub gives less what the wheel takes
        gains = np.array([more[n] - now[n] if n == "peak_wheel_torque_nm" else 0.0 for n in names]) - gains
    rows = [(name, label(name)[0], float(np.nan_to_num(gain)), label(metric)[1])
            for name, gain in zip(names, gains) if more[name] > now[name]]
    return sorted(rows, key=lambda lever: -lever[2])


def verdict(design, scenario, performance):
    """Whether a single design does its mission, the demands of its problem included, and that in one sentence."""
    p, limit = performance, scenario.traverse_limit_km
    slope = f"{scenario.slope_deg:g}°"
    drive = {"soil": "Sinks: the soil cannot carry it", "torque": f"Does not drive: {slope} is too steep for its hubs",
             "traction": f"Does not drive: its wheels slip on {slope}", "": ""}[stuck(design, p)]
    if not drive and p.range_km <= 0:
        drive = "Does not drive: no power or no time for it"
    elif not drive and p.range_km >= limit:
        drive = f"Drives the whole route of {limit:g} km"
        if p.log is not None:                            # a lane of a population has none
            hour = p.log.time_h[np.argmax(p.log.distance_km >= limit * (1 - 1e-12))]
            drive += f" on day {hour / 24:.1f} of {scenario.duration_earth_days:g}"
    elif not drive:
        drive = f"Drives {p.range_km:.3g} km" if np.isinf(limit) else f"Drives {p.range_km:.3g} of {limit:g} km"
    bad = [words for words, good in (
        ("freezes at night", p.cold_survival), ("overheats at noon", p.hot_survival),
        ("spends more energy than it gains", p.energy_balance_pct >= 0 or p.range_km <= 0),
        (f"cannot climb a step of {1000 * scenario.required_obstacle_height_m:.0f} mm",
         p.obstacle_capability_m >= scenario.required_obstacle_height_m)) if not good]
    bad += [f"misses {label(metric)[0]} {sign} {least:g} {label(metric)[1]}".rstrip()
            for metric, sign, least in scenario.problem.constraints
            if not holds(p, (metric, sign, least)) and not (metric == "range_km" and p.range_km <= 0)]
    words = [drive, *bad]
    return bool(p.range_km > 0 and not bad), ", ".join(words[:-1]) + ", and " * bool(bad) + words[-1] + "."


def limits(design, scenario, performance, *, model=Model()):
    """What a mission needs: Performance field -> whether the design meets that, and the need in words."""
    p, s = performance, scenario
    slope = f"{s.slope_deg:g} deg at slip {model.slope_capability_slip:g}"
    if p.slope_capability_deg < s.slope_deg and not p.stalled:       # some wheels pull more at a higher slip
        slope += f" (climbed at slip {p.slip:.2f})"
    return {
        "range_km": (p.range_km > 0, f"above 0, limit {s.traverse_limit_km:g} km"),
        "slope_capability_deg": (p.slope_capability_deg >= s.slope_deg, slope),
        "wheel_torque_nm": (p.wheel_torque_nm <= design.peak_wheel_torque_nm,
                            f"at most {design.peak_wheel_torque_nm:.3g} N m"),
        "energy_balance_pct": (p.energy_balance_pct >= 0, "0 % or more"),
        "obstacle_capability_m": (p.obstacle_capability_m >= s.required_obstacle_height_m,
                                  f"{s.required_obstacle_height_m:g} m"),
        "stalled": (not p.stalled, "must drive the slope"),
        "thermal_survival": (p.thermal_survival, f"{p.cold_temperature_c:.0f} to {p.hot_temperature_c:.0f} °C, allowed "
                             f"{model.operating_temperature_min_c:g} to {model.operating_temperature_max_c:g}")}


def failing(design, performance, scenario):
    """Parts that fail, each with a few words: "wheels", "hubs", "array", "body", "obstacle"."""
    p = performance
    bad = {"soil": {"wheels": "wheels buried"}, "torque": {"hubs": "hubs too weak"},
           "traction": {"wheels": "wheels slip"}, "": {}}[stuck(design, p)]
    if p.average_solar_power_w <= design.avionics_power_w + scenario.payload_power_w:
        bad["array"] = "array too small"
    if not p.thermal_survival:
        bad["body"] = "too hot at noon" if p.cold_survival else "too cold at night"
    if p.obstacle_capability_m < scenario.required_obstacle_height_m:
        bad["obstacle"] = "obstacle too high"
    return bad


def as_python(design, scenario, model, *calls, **others):
    """Python that rebuilds single records and runs as it stands.

    `calls` are lines that use `design`, `mission`, `model` and the names of `others`, which are designs too.
    """
    single(design=design, **others, scenario=scenario, model=model)
    records = {"design": design, **others, "soil": scenario.soil, "mission": scenario, "model": model}
    return "\n".join(["import rdk", "", *(_built(*pair) for pair in records.items()), *calls, ""])


def site_of(skyline):
    """Name and height (m) of the tabulated site whose skyline this is; None where it is no such site's."""
    site, height = skyline.name.partition(",")[0], skyline.height_m
    known = site in (sites := catalog.skyline_sites()) and height in sites[site]["heights_m"]
    return (site, int(height)) if known and skyline == catalog.skyline(site, height) else None


def _built(name, record):
    """Source of a record, without its defaults; infinity has no literal in Python, nor has a skyline."""
    def literal(value):
        if isinstance(value, Soil):
            return "soil"
        if isinstance(value, Skyline):
            if site := site_of(value):
                return "rdk.skyline({!r}, {})".format(*site)
            return f"rdk.sky.Skyline({value.azimuth_deg.tolist()}, {value.elevation_deg.tolist()})"
        return f"float({str(value)!r})" if value in (np.inf, -np.inf) else repr(value)

    lines = [f"\n    {f.name}={literal(getattr(record, f.name))}," for f in dataclasses.fields(record)
             if f.name != "problem" and getattr(record, f.name) != f.default]
    return f"{name} = rdk.{type(record).__name__}({''.join(lines)}" + "\n" * bool(lines) + ")"
