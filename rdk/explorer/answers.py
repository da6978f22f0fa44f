"""What the explorer shows of one state: readings, the verdict, pictures and words. Functions of records, no widgets."""
from __future__ import annotations

import numpy as np

from .. import explain, pictures
from ..design import DESIGN_SPACE
from ..mission import evaluate
from ..report import published
from ..sampling import attribution, replaced, sweep, uncertain_inputs
from ..uncertainty import DRAWS
from .inputs import NUMBERS, label
from .page import card, details, verdict

BAND_DRAWS, CURVE, MAP = 256, 61, 25                     # of the readings' draws the first; points of a sweep
ROWS = (("range_km", 2), ("total_mass_kg", 2), ("slope_capability_deg", 1), ("energy_balance_pct", 0),
        ("cold_temperature_c", 0), ("hot_temperature_c", 0), ("wheel_torque_nm", 2), ("slip", 2), ("sinkage_m", 4),
        ("cruise_speed_m_s", 3), ("obstacle_capability_m", 3), ("minimum_soc", 2), ("average_solar_power_w", 1))


def words(value, digits, unit=""):
    """A number for people."""
    return "none" if np.isnan(value) else f"{value:.{digits}f} {unit}".rstrip().replace("-", "−")


def judged(limit):
    """A limit, and whether it is met."""
    return ("✓ met: " if limit.met else "✗ missed: ") + limit.words


def meets(performance, constraints):
    """Whether a design, or each of a population, drives and meets every demand."""
    met = np.asarray(performance.feasible)
    for metric, sign, limit in constraints:
        value = np.asarray(getattr(performance, metric), float)
        met = met & (value >= limit if sign == ">=" else value <= limit)
    return met


def readings(design, scenario, result, spans, before, model, old):
    """The five cards and the table of all readings; `spans` are the intervals, old ones or None."""
    wanted = {(metric, sign): limit for metric, sign, limit in scenario.problem.constraints}
    needed = {limit.metric: limit for limit in explain.limits(design, scenario, result, model=model)}
    route, cards = scenario.traverse_limit_km, []
    slope = max(scenario.slope_deg, wanted.get(("slope_capability_deg", ">="), 0.0))
    asked = wanted.get(("range_km", ">="), 0.0)
    low, high = model.operating_temperature_min_c, model.operating_temperature_max_c
    rows = (  # title, field, digits, requirement, its sign, what it says
        ("Range", "range_km", 1, asked if asked > 0.1 else None if np.isinf(route) else route, ">=",
         f"asked: {asked:g} km" if asked > 0.1 else f"route of {route:g} km" if np.isfinite(route)
         else "no end of the route"),
        ("Mass", "total_mass_kg", 1, wanted.get(("total_mass_kg", "<=")), "<=",
         f"at most {wanted['total_mass_kg', '<=']:.3g} kg" if ("total_mass_kg", "<=") in wanted else "with payload"),
        ("Slope", "slope_capability_deg", 1, slope, ">=", f"needs {slope:g}°"),
        ("Energy", "energy_balance_pct", 0, 0.0, ">=", "needs 0 % or more"),
        ("Night", "cold_temperature_c", 0, low, ">=", f"noon {result.hot_temperature_c:.0f} °C; allowed {low:g} to "
         f"{high:g}".replace("-", "−")))
    for title, name, digits, need, sign, note in rows:
        value, unit = float(getattr(result, name)), label(name)[1]
        span = None if spans is None else (float(spans.low[name]), float(spans.high[name]))
        met = need is None or (value >= need if sign == ">=" else value <= need)
        if name == "slope_capability_deg":
            met = not result.stalled and not result.buried and met | (need == scenario.slope_deg)
        elif name == "cold_temperature_c":
            met = bool(result.thermal_survival)
        risky = met and need is not None and span is not None and (span[0] < need if sign == ">=" else span[1] > need)
        plain = need is None or name == "range_km" and asked <= 0.1 and result.range_km > 0
        status = "none" if plain else "risk" if risky else "met" if met else "missed"
        if span is not None and name != "cold_temperature_c":
            low_end, high_end = ("|" * bool(clamp) for clamp in spans.clamped[name])         # the end is a limit
            note = f"{low_end}{words(span[0], digits)} – {words(span[1], digits)}{high_end} (90 %); {note}"
        if name == "slope_capability_deg" and spans is not None and 0 < spans.low["stalled"] < 1:
            note = f"{note}; {100 * spans.low['stalled']:.0f} % of draws stall"
        change = None if before is None else value - float(getattr(before, name))
        still = change is None or not np.isfinite(change) or abs(change) < 0.5 * 10.0**-digits
        moved = "" if still else f"{change:+.{digits}f}"
        cards.append(card(title, words(value, digits), unit, status, note, moved.replace("-", "−"), value, span, need,
                          old))
    table = []
    for name, digits in ROWS:
        value, unit = float(getattr(result, name)), label(name)[1]
        span = "" if spans is None else f"{words(spans.low[name], digits)} to {words(spans.high[name], digits)}"
        limit = needed.get(name)
        table.append((label(name)[0], words(value, digits, unit), span, "" if limit is None else judged(limit)))
    for name, title in (("stalled", "drives the slope"), ("thermal_survival", "survives heat and cold")):
        share = np.nan if spans is None else float(spans.low[name])
        share, holds = (1 - share, not result.stalled) if name == "stalled" else (share, result.thermal_survival)
        table.append((title, "yes" if holds else "no", f"in {100 * share:.0f} % of draws" if share == share else "",
                      judged(needed[name])))
    return f'<div class="rdk-cards">{"".join(cards)}</div>', table


def answer(design, scenario, result, binding, spans, before, model, old=False):
    """HTML of the verdict with its readings, and the rows of the table."""
    met, sentence = explain.verdict(design, scenario, result, model=model)
    cards, table = readings(design, scenario, result, spans, before, model, old)
    status = "missed" if not met else "risk" if "! at risk" in cards else "met"
    odds = ""
    if spans is not None:
        share = 100 * float(spans.share([("feasible", ">=", 1), *scenario.problem.constraints]))
        asked = [limit for metric, _, limit in scenario.problem.constraints if (metric, limit) != ("range_km", 0.1)]
        odds = f"{'Meets all demands' if asked else 'Drives'} in {share:.0f} % of {DRAWS:,} draws."
    said = explain.levers(design, scenario, result, binding.key, model=model)
    buttons = [(f"lever:{lever[0]}", "{1} +10 %: {2:+.2g} {3}".format(*lever)) for lever in said[:3] if lever[2] > 0]
    head = binding.sentence
    if buttons:
        head = binding.sentence.split(":")[0] + ". Try" if binding.key not in ("soil", "traction") else "Try"
    header = ("reading", "value", "90 % interval", "needed")
    return verdict(status, sentence, head, buttons, odds) + cards + details(header, table), table


def span_of(name, count):
    """Values across an input's slider: whole where it must be, evenly in ratio where the slider is logarithmic."""
    f = NUMBERS[name]
    if name == "grouser_count":
        return np.arange(f.low, f.high + 1)
    return np.linspace(f.low, f.high, count) if f.step else np.geomspace(f.low, f.high, count).round(9)


def swept(design, scenario, model, fields, metric, size):
    """The picture of a sweep over one field or two."""
    f, factors = [NUMBERS[name] for name in fields], [NUMBERS[name].factor for name in fields]
    now = {**design.numbers(), **scenario.numbers(), **scenario.soil.numbers(), **model.numbers()}
    axes = [label(name)[0] + (f" ({label(name)[1]})" if label(name)[1] else "") for name in fields]
    here = [now[name] * factor for name, factor in zip(fields, factors)]
    over = {name: span_of(name, MAP if len(fields) == 2 else CURVE) for name in fields}
    found = sweep(design, scenario, over, model=model).performance
    grid = np.asarray(getattr(found, metric), float)
    blocked = np.asarray(found.stalled | found.buried)
    shown = [over[name] * factor for name, factor in zip(fields, factors)]
    if len(fields) == 2:
        return pictures.contour(*axes, metric, *shown, grid, blocked, here, size)
    name, values = fields[0], over[fields[0]]
    jump = int(np.abs(np.diff(np.nan_to_num(grid))).argmax())                # a cliff is drawn as one, not as a ramp
    if name != "grouser_count":
        values = np.sort(np.concatenate([values, np.linspace(values[jump], values[jump + 1], 12)[1:-1]]))
    line = sweep(design, scenario, {name: values}, model=model).performance
    knots = values[::6]
    draws = {n: v[:BAND_DRAWS, None] for n, v in uncertain_inputs(scenario, draws=DRAWS, model=model).items()}
    *changed, coefficients = replaced(design, scenario, model, {**draws, name: knots})
    cloud = evaluate(*changed, model=coefficients)
    band = np.quantile(np.nan_to_num(np.asarray(getattr(cloud, metric), float)), [0.05, 0.95], axis=0)
    rovers = None
    if name in DESIGN_SPACE:                             # a mission's field is not the rovers' own
        names, fleet = published()
        others = evaluate(fleet, scenario, model=model)
        rovers = getattr(fleet, name) * factors[0], np.asarray(getattr(others, metric), float), names
    own = float(getattr(evaluate(design, scenario, model=model), metric))
    return pictures.curve(axes[0], metric, values * factors[0], np.asarray(getattr(line, metric), float),
                          line.stalled | line.buried,
                          (knots * factors[0], *band), (here[0], own), rovers, size, log=not f[0].step)


def explained(design, reference, name, scenario, model, metric, size):
    """The picture of what each variable contributes to the difference from a reference."""
    found = attribution(design, reference, scenario, model=model)
    if metric not in found.contributions:
        return pictures.message(size, f"{label(metric)[0]} has no value in some mixture of the two designs (a buried "
                                "wheel), so that its difference cannot be shared out. Choose another metric.")
    names = [label(n)[0] if n in NUMBERS else "wheels" for n in DESIGN_SPACE]
    return pictures.why(metric, names, found.contributions[metric], float(getattr(found.baseline_performance, metric)),
                        float(getattr(found.performance, metric)), name, size)


def solved(design, scenario, model, name):
    """The nearest value of one variable at which a design drives and meets every demand, and a sentence.

    The value is None where no value does, in which case the sentence says which demands stand in the way.
    """
    f = NUMBERS[name]
    values = np.unique(np.concatenate([span_of(name, 400), [getattr(design, name)]]))
    *changed, _ = replaced(design, scenario, model, {name: values})
    found = evaluate(*changed, model=model)
    met = meets(found, scenario.problem.constraints)
    if met.any():
        best = values[met][np.abs(np.log((values[met] + 1e-3) / (getattr(design, name) + 1e-3))).argmin()]
        return float(best), f"{f.label} of {f.words(float(f'{best:.4g}'))} {f.unit} meets the demands"
    apart = [f"{label(metric)[0]} {'≥' if sign == '>=' else '≤'} {limit:g}" for metric, sign,
             limit in scenario.problem.constraints
             if not meets(found, [(metric, sign, limit)]).any()]
    return None, (f"no {f.label} from {f.words(f.low)} to {f.words(f.high)} {f.unit} meets the demands" +
                  (": " + ", ".join(apart) if apart else ""))
