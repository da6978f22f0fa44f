"""What the explorer shows of one state: readings, the verdict, pictures and words. Functions of records, no widgets."""
from collections import namedtuple

import numpy as np

from .. import explain, pictures
from ..design import DESIGN_SPACE
from ..mission import evaluate
from ..report import published
from ..sampling import attribution, holds, replaced, sweep, uncertain_inputs
from ..uncertainty import DRAWS
from .inputs import METRICS, NUMBERS, label
from .page import button, card, verdict

BAND_DRAWS, CURVE, MAP = 256, 61, 25                     # of the readings' draws the first; points of a sweep
Answer = namedtuple("Answer", "now design scenario model result binding levers before ghosts reference spans sure "
                    "front kept")
"""What the page shows of one state: inputs `now`, the result `before` the last change, `ghosts` as (letter, class,
result) of pinned designs, the `reference` of "why"; `spans` are intervals, older ones unless `sure`. Earlier answers
have `kept` the mixtures of "why", and as pairs of what they are of and of their values "odds" and "band"."""


def words(value, digits, unit="", sign=""):
    """A number for people."""
    if np.isnan(value):
        return "none"
    return f"{round(float(value), digits) + 0.0:{sign}.{digits}f} {unit}".rstrip().replace("-", "−")     # no minus 0


def asked(scenario):
    """The demands of a mission; that the rover drives it comes first."""
    return [("feasible", ">=", 1), *scenario.problem.constraints]


def meets(performance, demands):
    """Whether a design, or each of a population, meets every demand."""
    return np.all([holds(performance, demand) for demand in demands], axis=0)


def fits(front, scenario, model):
    """Whether a front belongs to the mission and the model."""
    return front is not None and front.model == model and (
        front.scenario.replace(name="") == scenario.replace(name="", problem=front.scenario.problem))


def cards(a):
    result, spans, drawn = a.result, a.spans, []
    far, route, heaviest = (a.now[name] for name in ("minimum_range_km", "traverse_limit_km", "maximum_mass_kg"))
    slope = max(a.scenario.slope_deg, a.now["minimum_slope_deg"])
    steep = slope > a.scenario.slope_deg and result.slope_capability_deg < slope
    low, high = a.model.operating_temperature_min_c, a.model.operating_temperature_max_c
    rows = (  # field, title, digits, requirement, its sign, words; whether it is met where the value does not say
        ("range_km", "Range", 1, far, ">=", f"asked: {far:g} km") if far > 0.1 else
        ("range_km", "Range", 1, route, ">=", "no end of the route") if np.isinf(route) else
        ("range_km", "Range", 1, route, ">=", f"route of {route:g} km", "none" if result.range_km > 0 else False),
        ("total_mass_kg", "Mass", 1, heaviest, "<=",
         "with payload" if np.isinf(heaviest) else f"at most {heaviest:.3g} kg"),
        ("slope_capability_deg", "Slope", 1, slope, ">=", f"needs {slope:g}°", not (result.stalled or steep)),
        ("energy_balance_pct", "Energy", 0, 0.0, ">=", "needs 0 % or more"),
        ("cold_temperature_c", "Night", 0, low, ">=", f"noon {result.hot_temperature_c:.0f} °C; allowed {low:g} to "
         f"{high:g}".replace("-", "−"), bool(result.thermal_survival)))
    for name, title, digits, need, sign, note, *met in rows:
        value, span = float(getattr(result, name)), (float(spans.low[name]), float(spans.high[name]))
        met = met[0] if met else "none" if np.isinf(need) else bool(holds(result, (name, sign, need)))
        risky = met is True and (span[0] < need if sign == ">=" else span[1] > need)
        status = "none" if met == "none" else "risk" if risky else "met" if met else "missed"
        if name != "cold_temperature_c":
            left, right = ("|" * bool(clamp) for clamp in spans.clamped[name])       # the end is a limit
            note = f"{left}{words(span[0], digits)} – {words(span[1], digits)}{right} (90 %); {note}"
        if name == "slope_capability_deg" and 0 < spans.low["stalled"] < 1:
            note += f"; {100 * spans.low['stalled']:.0f} % of draws stall"
        change = value - float(getattr(a.before or result, name))
        moved = words(change, digits, sign="+") if np.isfinite(change) and round(change, digits) else ""
        drawn.append(card(title, words(value, digits), label(name)[1], status, note, moved, value, span, need,
                          not a.sure))
    return f'<div class="rdk-cards">{"".join(drawn)}</div>'


def readings(a):
    """Rows of the table of all readings: name, value, interval, limit."""
    limits = explain.limits(a.design, a.scenario, a.result, model=a.model)
    needed = {name: ("✓ met: " if met else "✗ missed: ") + need for name, (met, need) in limits.items()}
    rows = []
    for name, digits in METRICS.items():
        span = " to ".join(words(end[name], digits) for end in (a.spans.low, a.spans.high))
        rows.append((label(name)[0], words(float(getattr(a.result, name)), digits, label(name)[1]), span,
                     needed.get(name, "")))
    for title, name, other in (("drives the slope", "stalled", True),
                               ("survives heat and cold", "thermal_survival", False)):
        rows.append((title, "yes" if getattr(a.result, name) != other else "no",
                     f"in {100 * abs(other - a.spans.low[name]):.0f} % of draws", needed[name]))
    return rows


def answer(a):
    """HTML of the verdict with its readings, and the rows of the table."""
    met, sentence = explain.verdict(a.design, a.scenario, a.result)
    shown, table = cards(a), readings(a)
    share = 100 * float(a.spans.share(asked(a.scenario)))
    more = any((metric, limit) != ("range_km", 0.1) for metric, _, limit in a.scenario.problem.constraints)
    odds = f"{'Meets all demands' if more else 'Drives'} in {share:.0f} % of {DRAWS:,} draws."
    buttons = [(f"lever:{field}", f"{name} +10 %: {gain:+.2g} {unit}") for field, name, gain, unit in a.levers[:3]
               if gain > 0]
    head = a.binding.sentence
    if buttons:
        head = head.split(":")[0] + ". Try" if a.binding.key not in ("soil", "traction") else "Try"
    status = "missed" if not met else "risk" if "! at risk" in shown else "met"
    return verdict(status, sentence, head, buttons, odds, shown, table, not a.sure), table


def against(a):
    """What each pinned design has more or less than the present one."""
    return [" · ".join(words(getattr(other, metric) - getattr(a.result, metric), 1, label(metric)[1], "+")
                       for metric in ("total_mass_kg", "range_km", "slope_capability_deg")) for *_, other in a.ghosts]


def spans(a, *names):
    """The intervals of some metrics; None while they are not those of this state."""
    return [(a.spans.low[name], a.spans.high[name]) for name in names] if a.sure else None


def rovers(a, *names):
    """Metrics of the published rovers on this mission, and their names."""
    known, designs = published()
    found = evaluate(designs, a.scenario, model=a.model)
    return *(np.asarray(getattr(found, name), float) for name in names), known


def why(a, size):
    metric = a.now["why_metric"]
    found = a.kept["why"] = attribution(a.design, a.reference, a.scenario, model=a.model, metrics=(metric,),
                                        known=a.kept["why"])
    if metric not in found.contributions:
        return pictures.message(size, f"{label(metric)[0]} has no value in some mixture of the two designs (a buried "
                                "wheel), so that its difference cannot be shared out. Choose another metric.")
    names = [label(n)[0] if n in NUMBERS else "wheels" for n in DESIGN_SPACE]
    return pictures.why(metric, names, found, a.now["baseline"], size)


def span_of(name, count):
    """Values across an input's slider: whole where it must be, evenly in ratio where the slider is logarithmic."""
    f = NUMBERS[name]
    if f.whole:
        return np.arange(f.low, f.high + 1)
    return np.linspace(f.low, f.high, count) if f.step else np.geomspace(f.low, f.high, count).round(9)


def swept_over(now):
    """The fields of a sweep, one or two, with their values."""
    names = dict.fromkeys(filter(None, (now["sweep_first"], now["sweep_second"])))
    return {name: span_of(name, MAP if len(names) == 2 else CURVE) for name in names}


def band_of(a, stop):
    """The 90 % interval along a sweep: what it is of, and (values, low, high); the old one at a `stop`."""
    name, metric = of = a.now["sweep_first"], a.now["sweep_metric"]
    knots = span_of(name, CURVE)[::5]
    draws = {n: v[:BAND_DRAWS, None] for n, v in uncertain_inputs(a.scenario, draws=DRAWS, model=a.model).items()}
    ends = []
    for some in np.array_split(knots, 4):
        if stop():
            return a.kept["band"]
        *changed, model = replaced(a.design, a.scenario, a.model, draws | {name: some})
        values = np.asarray(getattr(evaluate(*changed, model=model), metric), float)
        ends.append(np.quantile(np.nan_to_num(values), [0.05, 0.95], axis=0))
    return of, (knots * NUMBERS[name].factor, *np.concatenate(ends, axis=1))


def swept(a, size):
    over, metric = swept_over(a.now), a.now["sweep_metric"]
    fields = {name: NUMBERS[name] for name in over}
    axes = [f.label + (f" ({f.unit})" if f.unit else "") for f in fields.values()]
    here = [min(a.now[name], f.high) * f.factor for name, f in fields.items()]           # no limit: at the end

    def found(over):
        p = sweep(a.design, a.scenario, over, model=a.model).performance
        return np.asarray(getattr(p, metric), float), np.asarray(p.stalled | p.buried)

    values, stalled = found(over)
    if len(over) == 2:
        shown = [over[name] * f.factor for name, f in fields.items()]
        return pictures.contour(*axes, metric, *shown, values, stalled, here, size)
    (name, points), (f,) = *over.items(), fields.values()
    jump = int(np.abs(np.diff(np.nan_to_num(values))).argmax())              # a cliff is drawn as one, not as a ramp
    if not f.whole:
        more = np.linspace(points[jump], points[jump + 1], 12)[1:-1]
        points, values, stalled = (np.insert(old, jump + 1, new) for old, new in zip(
            (points, values, stalled), (more, *found({name: more}))))
    others = ()
    if name in DESIGN_SPACE:                             # a mission's field is not the rovers' own
        others = getattr(published()[1], name) * f.factor, *rovers(a, metric)
    of, band = a.kept["band"]
    band = band if of == (name, metric) else None
    here = here[0], float(getattr(a.result, metric))
    return pictures.curve(axes[0], metric, points * f.factor, values, stalled, band, here, others, size,
                          log=not f.step, old=not a.sure)


def front(a, size):
    front = a.front
    if front is None:
        return (f'<div style="padding:60px 20px;text-align:center;width:{size[0] - 60}px">No front yet: designs that '
                'no other beats in every goal.<br><br>' + button("run", "Run search", 'class="rdk-main"') + "</div>")
    names = [a.now["front_" + key] for key in ("x", "y", "colour")]
    of, odds = a.kept["odds"]
    rated = odds if of == (front, asked(a.scenario)) else np.full(len(front), np.nan)
    where = front.scenario.name.replace("_", " ")
    stale = "" if fits(front, a.scenario, a.model) else f"searched for {where} as it was: run again"
    same = np.all([np.equal(getattr(front.designs, name), a.now[name]) for name in DESIGN_SPACE], axis=0)
    picked = int(same.argmax()) if same.any() else None
    title = f"{'Live front' if a.now['live'] else 'Front'} of {where}: {len(front)} designs"
    return pictures.front(front.performance, front.designs, names, a.result, size, rated, picked,
                          ~meets(front.performance, asked(a.scenario)), title, stale or front.message, a.ghosts)


PICTURES = {
    "log": lambda a, size: pictures.log(a.result, a.scenario, a.model.soc_initial, size,
                                        [(letter, cls, found.log) for letter, cls, found in a.ghosts]),
    "mass": lambda a, size: pictures.mass(a.result, size, (spans(a, "total_mass_kg") or [None])[0], a.ghosts),
    "wheel": lambda a, size: pictures.wheel(a.result, a.design, a.scenario, a.model, size),
    "fleet": lambda a, size: pictures.fleet(a.result, rovers(a, "total_mass_kg", "range_km"), size,
                                            spans(a, "total_mass_kg", "range_km"), a.ghosts),
    "why": why, "sweep": swept, "optimise": front}


def solved(design, scenario, model, name):
    """The nearest value of one variable that meets every demand; a ValueError says which stand in the way of all."""
    f = NUMBERS[name]
    values = np.unique(np.append(span_of(name, 400), getattr(design, name)))
    *changed, _ = replaced(design, scenario, model, {name: values})
    found = evaluate(*changed, model=model)
    met = meets(found, asked(scenario))
    if met.any():
        far = np.abs(np.log((values[met] + 1e-3) / (getattr(design, name) + 1e-3)))
        return float(values[met][far.argmin()])
    apart = [f"{label(metric)[0]} {'≥' if sign == '>=' else '≤'} {limit:g}"
             for metric, sign, limit in scenario.problem.constraints
             if not (found.feasible & holds(found, (metric, sign, limit))).any()]
    raise ValueError(f"no {f.label} from {f.words(f.low)} to {f.words(f.high)} {f.unit} meets the demands"
                     + ": " * bool(apart) + ", ".join(apart))
