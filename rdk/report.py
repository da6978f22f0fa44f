"""One page on one design: what it must do, what it does, how sure that is, and why; as an HTML file.

The page embeds its pictures, needs no network and prints on one A4 page.
"""
import base64
import functools
import html
from collections import namedtuple
from string import Template

import numpy as np

from . import catalog, explain, pictures
from .catalog import write
from .design import DESIGN_SPACE, Design, Model
from .mission import evaluate
from .rover_picture import rover_picture
from .sampling import attribution, holds, intervals, single, uncertain_inputs
from .tradespace import posed
from .uncertainty import DRAWS

PAGE = Template("""<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8">
<title>$title</title>
<style>
@page { size: A4; margin: 11mm }
body { font: 8.5pt/1.32 "Liberation Sans", Arial, Helvetica, sans-serif; color: #000; background: #fff;
       max-width: 188mm; margin: 0 auto }
h1 { font-size: 15pt; margin: 0 0 1mm } h2 { font-size: 10pt; margin: 2.5mm 0 1mm } p { margin: 0 0 1.2mm }
table { border-collapse: collapse; width: 100% } td, th { padding: 0.25mm 1.5mm; text-align: right }
td:first-child, th:first-child { text-align: left } th { border-bottom: 0.3mm solid #000 }
tr.missed td { font-weight: bold } .verdict { border-left: 1.2mm solid #0072B2; padding-left: 2mm }
.verdict.missed { border-color: #D55E00 } .small { font-size: 7.5pt }
.columns { display: grid; grid-template-columns: 1fr 1fr; gap: 1mm 5mm }
.columns svg { width: 100%; height: auto } .wide { grid-template-columns: 24fr 34fr 42fr }
@media screen { body { padding: 6mm } }
@media print { .screen { display: none } }
</style></head><body>
<h1>$title</h1>
<p>$mission</p>
<p class="verdict$mark"><b>$verdict</b> $binds</p>
<div class="columns wide"><div>$rover</div><div><h2>Design</h2>$design</div>
<div><h2>Demands</h2>$demands<h2>Risks</h2>$risks</div></div>
$candidates<div class="columns">$drawn</div>
$notes<p class="small">Intervals: $draws draws from data/uncertainties.csv, 5 % to 95 %; they cover soil and
coefficients, not what the models leave out: tip-over, load transfer, terrain shadows, multi-pass, and structure that
must grow with its load. Model: $model.</p>
<p class="screen"><a download="design.json" href="data:application/json;base64,$data">design.json</a>: open it in the
explorer.</p>
</body></html>
""")
SIZE = 470, 215                                          # of a picture, in pixels of its own
Requirement = namedtuple("Requirement", "demand words nominal low high met share driver")
"""A demand such as ("range_km", ">=", 30), and how surely a design meets it.

`low` and `high` span the 90 % interval, `share` is the share of draws in which the demand holds, `driver` the uncertain
input with the strongest rank correlation to the metric ("" where the metric does not vary).
"""


def requirements(design, scenario, *, draws=DRAWS, model=Model()):
    """The demands of a mission's problem on a single design as Requirements; that it drives the mission comes first.

    A share covers the table of uncertainties and nothing that the models leave out.
    """
    from scipy.stats import rankdata                     # slow to load
    single(design=design, scenario=scenario, model=model)
    found, rows = intervals(design, scenario, draws=draws, model=model), []
    ranks = {name: rankdata(values) for name, values in uncertain_inputs(scenario, draws=draws, model=model).items()
             if np.ptp(values) > 0}
    for demand in [("feasible", ">=", 1.0), *posed(scenario)[1].constraints]:
        metric, sign, limit = demand
        name, unit = explain.label(metric)
        words = name if metric == "feasible" else f"{name} {'≥' if sign == '>=' else '≤'} {limit:g} {unit}".rstrip()
        values, driver = np.nan_to_num(np.asarray(getattr(found.draws, metric), float)), ""
        if np.ptp(values) > 0:
            strength = np.corrcoef([*ranks.values(), rankdata(values)])[-1, :-1]
            driver = list(ranks)[np.abs(strength).argmax()]
        ends = (float(read[metric]) for read in (found.nominal, found.low, found.high))
        rows.append(Requirement(demand, words, *ends, bool(holds(found.performance, demand)),
                                float(holds(found.draws, demand).mean()), driver))
    return rows


@functools.cache
def published():
    """Names of the published rovers, and their designs as one population."""
    return catalog.rover_names(), Design.stack(map(catalog.rover, catalog.rover_names()))


def report(design, scenario, title="", notes="", *, front=None, baseline=None, baseline_name="the baseline",
           bounds=None, candidates=None, model=Model(), draws=DRAWS):
    """A one-page report on a single design and the demands of a single mission's problem, as the text of an HTML file.

    `notes` say what to know beyond the tables: choices, risks, doubts; an empty line starts a paragraph. A `front` is
    shown with the design on it, in place of the published rovers. The difference to `baseline` in mass is attributed to
    the variables; by default it is another rover, published and nearest in mass. `bounds` has limits (low, high) of
    variables in place of those in DESIGN_SPACE; `candidates` are other designs by name, for a table.

    Examples
    --------
    >>> import rdk
    >>> page = report(rdk.rover("Rashid-1"), rdk.scenario("equatorial_mare_traverse"), "Rashid-1 on a mare")
    >>> "<h1>Rashid-1 on a mare</h1>" in page
    True
    """
    demands = requirements(design, scenario, draws=draws, model=model)
    result = evaluate(design, scenario, model=model)
    names, fleet = published()
    rovers = evaluate(fleet, scenario, model=model)
    if baseline is None:
        order = np.abs(np.log(rovers.total_mass_kg / result.total_mass_kg)).argsort()
        baseline, baseline_name = next((fleet[i], names[i]) for i in order.tolist() if fleet[i] != design)
    shares = attribution(design, baseline, scenario, model=model, metrics=("total_mass_kg",))
    drawn = [_on_front(front, result) if front is not None and len(front) else
             pictures.fleet(result, (rovers.total_mass_kg, rovers.range_km, names), SIZE),
             pictures.mass(result, SIZE), pictures.log(result, scenario, model.soc_initial, SIZE),
             pictures.why("total_mass_kg", [v.label for v in DESIGN_SPACE.values()], shares, baseline_name, SIZE)]
    designs = {"this design": design, **(candidates or {})}
    found = intervals(Design.stack(designs.values()), scenario, draws=draws, model=model)
    odds = found.share([d.demand for d in demands])
    missed = [d.words for d in demands if not d.met]
    verdict = f"Misses {len(missed)} of {len(demands)} demands: {'; '.join(missed)}." if missed else (
        f"Meets all {len(demands)} demands of the mission.")
    risks = [f"“{d.words}” fails in {100 * (1 - d.share):.0f} % of the draws"
             + (f"; it moves most with the {explain.label(d.driver)[0]}." if d.driver else ".")
             for d in sorted(demands, key=lambda d: d.share)[:3] if d.share < 0.995]
    limits = {name: (v.low, v.high) for name, v in DESIGN_SPACE.items()} | (bounds or {})
    outside = {name: not low * (1 - 1e-12) <= getattr(design, name) <= high * (1 + 1e-12)
               for name, (low, high) in limits.items()}
    changed = [f"{name} = {value:g}" for name, value in model.numbers().items() if value != getattr(Model(), name)]
    notes = [part for part in notes.split("\n\n") if part.strip()]
    return PAGE.substitute(
        title=_text(str(title or "").strip() or f"A rover for {scenario.name}"), mark=" missed" * bool(missed),
        verdict=_text(f"{verdict} All hold at once in {100 * odds[0]:.0f} % of the draws."),
        binds=_text(explain.binding(design, scenario, result, model=model).sentence),
        mission=_text(_mission_words(scenario)), rover=rover_picture(design, result, scenario, width=250),
        design=_table("variable;value;allowed", [
            (outside[name], v.label, f"{getattr(design, name):.4g} {v.unit if v.unit != '1' else ''}".rstrip(),
             f"{limits[name][0]:g} to {limits[name][1]:g}" + ", outside" * outside[name])
            for name, v in DESIGN_SPACE.items()]),
        demands=_table("demand;design;90 % interval;holds in", [
            (not d.met, d.words, *(("yes" if d.met else "no", "–") if d.demand[0] == "feasible" else
                                   (f"{d.nominal:.3g}", f"{d.low:.3g} to {d.high:.3g}")), f"{100 * d.share:.0f} %")
            for d in demands]),
        risks=_paragraphs(risks or ["Every demand holds in all draws of the uncertain inputs."]),
        candidates="" if not candidates else "<h2>Candidates</h2>" + _table(
            "design;mass;range;slope capability;all demands hold in", [
                (False, name, f"{p.total_mass_kg:.2f} kg", f"{p.range_km:.3g} km", f"{p.slope_capability_deg:.1f}°",
                 f"{100 * share:.0f} %") for name, p, share in zip(designs, found.performance, odds)]),
        drawn="\n".join(drawn), notes="<h2>Notes</h2>" * bool(notes) + _paragraphs(notes),
        draws=draws, model=_text(", ".join(changed) or "the paper's coefficients"),
        data=base64.b64encode(catalog.to_json(design, scenario).encode()).decode())


def write_report(design, scenario, path, title="", notes="", **options):
    """Write the page of `report` to an HTML file; `options` go to `report`. Returns the path."""
    return write(report(design, scenario, title, notes, **options), path)


def _text(words):
    return html.escape(str(words), quote=False)


def _paragraphs(words):
    return "".join(f"<p>{_text(part)}</p>" for part in words)


def _table(header, rows):
    """A table; the cells of a row follow whether it misses its demand."""
    head, mark = "".join(f"<th>{_text(cell)}</th>" for cell in header.split(";")), ' class="missed"'
    body = "".join(f"<tr{mark * bool(missed)}>" + "".join(f"<td>{_text(cell)}</td>" for cell in cells) + "</tr>"
                   for missed, *cells in rows)
    return f"<table><tr>{head}</tr>{body}</table>"


def _on_front(front, result):
    """The design on the front: mass against the other objective that spreads most, coloured by the next."""
    def spread(name):
        values = np.asarray(getattr(front.performance, name), float)
        return np.ptp(values) / max(np.abs(values).max(), 1e-12)

    others = sorted((name for name in front.problem.objectives if name != "total_mass_kg"), key=spread, reverse=True)
    names = ["total_mass_kg", *others, "range_km", "slope_capability_deg"][:3]
    return pictures.front(front.performance, front.designs, names, result, SIZE, title=f"Front of {len(front)} designs")


def _mission_words(scenario):
    return (f"Mission: {scenario.name.replace('_', ' ')}, latitude {scenario.latitude_deg:g} deg, "
            f"{scenario.duration_earth_days:g} Earth days from {scenario.start_utc or 'sunrise'}, slopes of "
            f"{scenario.slope_deg:g} deg in {scenario.soil.name or 'some soil'}, driving "
            f"{100 * scenario.duty_cycle:g} % of the time, payload {scenario.payload_mass_kg:g} kg, "
            f"{scenario.payload_power_w:g} W, panel tilt {scenario.panel_tilt_deg:g} deg, range limit "
            f"{scenario.traverse_limit_km:g} km.")
