"""One page on one design: what it must do, what it does, how sure that is, and why; as an HTML file.

The page embeds its pictures, needs no network and prints on one A4 page.
"""
from __future__ import annotations

import base64
import functools
import html as html_module
import re
from typing import NamedTuple

import numpy as np

from . import catalog, explain, pictures
from ._fields import require
from .catalog import write as write
from .design import DESIGN_SPACE, Design, Model, Scenario
from .mission import evaluate
from .rover_picture import rover_picture
from .sampling import attribution, intervals, uncertain_inputs
from .tradespace import posed
from .uncertainty import DRAWS

STYLE = """
@page { size: A4; margin: 11mm }
body { font: 8.5pt/1.32 "Liberation Sans", Arial, Helvetica, sans-serif; color: #000; background: #fff;
       max-width: 188mm; margin: 0 auto }
h1 { font-size: 15pt; margin: 0 0 1mm } h2 { font-size: 10pt; margin: 2.5mm 0 1mm } p { margin: 0 0 1.2mm }
table { border-collapse: collapse; width: 100% } td, th { padding: 0.25mm 1.5mm; text-align: right }
td:first-child, th:first-child { text-align: left } th { border-bottom: 0.3mm solid #000; text-align: right }
tr.missed td { font-weight: bold } .verdict { border-left: 1.2mm solid #0072B2; padding-left: 2mm }
.verdict.missed { border-color: #D55E00 } .small { font-size: 7.5pt }
.columns { display: grid; grid-template-columns: 1fr 1fr; gap: 1mm 5mm }
.columns svg { width: 100%; height: auto } .wide { grid-template-columns: 24fr 34fr 42fr }
@media screen { body { padding: 6mm } }
@media print { .screen { display: none } }
"""
_UNITS = re.compile("(_(kg|kn|m|m2|n1|n2|nm|w|wh|mm|deg|kpa))+$")
SIZE = 470, 215                                         # of a picture, in pixels of its own


class Requirement(NamedTuple):
    """A demand on one metric, and how surely a design meets it.

    `low` and `high` span the 90 % interval, `share` is the share of draws in which the demand holds, `driver`
    the uncertain input with the strongest rank correlation to the metric ("" where the metric does not vary).
    """
    metric: str
    sign: str
    limit: float
    nominal: float
    low: float
    high: float
    met: bool
    share: float
    driver: str

    @property
    def words(self):
        """The demand, in words."""
        if self.metric == "feasible":
            return "drives the mission"
        name, unit = pictures.label(self.metric)
        return f"{name} {'≥' if self.sign == '>=' else '≤'} {self.limit:g} {unit}".rstrip()


def requirements(design, scenario, *, draws=DRAWS, seed=0, model=Model()):
    """The demands of a mission's problem on a single design, each with its chance to hold.

    Parameters
    ----------
    design : Design
    scenario : Scenario
        Single ones. Its `problem.constraints` are the demands; that the rover drives the mission comes first.
    draws, seed : int
        Of the Monte-Carlo intervals.
    model : Model

    Returns
    -------
    list of Requirement

    Notes
    -----
    A share covers the table of uncertainties and nothing that the models leave out.
    """
    require(design=(design, Design), scenario=(scenario, Scenario), model=(model, Model))
    for name, record in ("design", design), ("scenario", scenario), ("model", model):
        if record.shape:
            raise ValueError(f"{name} must be a single one; got arrays of shape {record.shape}")
    found = intervals(design, scenario, draws=draws, seed=seed, model=model)
    inputs = uncertain_inputs(scenario, draws=draws, seed=seed, model=model)
    demands = [("feasible", ">=", 1.0), *posed(scenario)[1].constraints]
    return [_requirement(metric, sign, limit, found, inputs) for metric, sign, limit in demands]


def joint_odds(design, scenario, *, draws=DRAWS, seed=0, model=Model()):
    """Share of the Monte-Carlo draws in which a single design drives and meets every demand of the mission at once."""
    wanted = [("feasible", ">=", 1), *posed(scenario)[1].constraints]
    return float(intervals(design, scenario, draws=draws, seed=seed, model=model).share(wanted))


@functools.cache
def published():
    """Names of the published rovers, and their designs as one population."""
    names = catalog.rover_names()
    rovers = [catalog.rover(name) for name in names]
    return names, Design(**{name: np.array([getattr(rover, name) for rover in rovers]) for name in DESIGN_SPACE})


def _requirement(metric, sign, limit, found, inputs):
    from scipy.stats import rankdata                     # slow to load
    values = np.asarray(getattr(found.draws, metric), float)
    nominal = float(found.nominal[metric])
    holds = values >= limit if sign == ">=" else values <= limit             # false where NaN
    met = nominal >= limit if sign == ">=" else nominal <= limit
    values = np.nan_to_num(values)
    strength = {name: abs(np.corrcoef(rankdata(draw), rankdata(values))[0, 1])
                for name, draw in inputs.items()
                if np.ptp(draw) > 0 and np.ptp(values) > 0}
    driver = max(strength, key=strength.get, default="")
    return Requirement(metric, sign, float(limit), nominal, float(found.low[metric]),
                       float(found.high[metric]),
                       bool(met), float(holds.mean()), driver)


def report(design, scenario, title, notes="", *, front=None, baseline=None, baseline_name="the baseline",
           why="total_mass_kg", bounds=None, candidates=None, model=Model(), draws=DRAWS):
    """A one-page report on a design, as the text of an HTML file.

    Parameters
    ----------
    design : Design
    scenario : Scenario
        Single ones; the scenario's problem gives the demands.
    title : str
    notes : str
        What to know beyond the tables: choices, risks, doubts. An empty line starts a paragraph.
    front : Front, optional
        Shown with the design on it; without one, the published rovers are shown on this mission.
    baseline : Design, optional
        Whose difference to the design is attributed to the variables; by default the published rover that is
        nearest in mass on this mission.
    baseline_name : str
    why : str
        The metric whose difference is attributed.
    bounds : dict of str to (float, float), optional
        Limits of design variables that the project sets, in place of those in DESIGN_SPACE.
    candidates : dict of str to Design, optional
        Other designs, shown beside this one.
    model : Model
    draws : int
        Of the Monte-Carlo intervals.

    Returns
    -------
    str

    Raises
    ------
    ValueError
        If an input holds arrays, the title is empty or `why` is no metric.

    Examples
    --------
    >>> import rdk
    >>> page = report(rdk.rover("Rashid-1"), rdk.scenario("equatorial_mare_traverse"), "Rashid-1 on a mare")
    >>> "<h1>Rashid-1 on a mare</h1>" in page
    True
    """
    if not isinstance(title, str) or not title.strip():
        raise ValueError(f"title must be a text; got {title!r}")
    demands = requirements(design, scenario, draws=draws, model=model)
    result = evaluate(design, scenario, model=model)
    names, fleet = published()
    rovers = evaluate(fleet, scenario, model=model)
    if baseline is None:
        nearest = int(np.abs(np.log(rovers.total_mass_kg / result.total_mass_kg)).argmin())
        baseline, baseline_name = fleet[nearest], names[nearest]
    shares = attribution(design, baseline, scenario, model=model)
    if why not in shares.contributions:
        raise ValueError(f"why: no metric {why!r}; choose from {', '.join(shares.contributions)}")
    drawn = [
        _on_front(front, result) if front is not None and len(front) else
        pictures.fleet(result, (rovers.total_mass_kg, rovers.range_km, names), SIZE),
        pictures.mass(result, SIZE), pictures.log(result, scenario, model.soc_initial, SIZE),
        pictures.why(why, [variable.label for variable in DESIGN_SPACE.values()], shares.contributions[why],
                     getattr(shares.baseline_performance, why), getattr(shares.performance, why), baseline_name, SIZE)]
    odds = joint_odds(design, scenario, draws=draws, model=model)
    missed = [d.words for d in demands if not d.met]
    verdict = f"Misses {len(missed)} of {len(demands)} demands: {'; '.join(missed)}." if missed else (
        f"Meets all {len(demands)} demands of the mission.")
    verdict += f" All hold at once in {100 * odds:.0f} % of the draws."
    binds = explain.binding(design, scenario, result, model=model).sentence
    return "\n".join([
        "<!DOCTYPE html>", '<html lang="en"><head><meta charset="utf-8">', f"<title>{_text(title)}</title>",
        f"<style>{STYLE}</style></head><body>", f"<h1>{_text(title)}</h1>",
        f"<p>{_text(_mission_words(scenario))}</p>",
        f'<p class="verdict{" missed" * bool(missed)}"><b>{_text(verdict)}</b> {_text(binds)}</p>',
        '<div class="columns wide"><div>', rover_picture(design, result, scenario, width=250), "</div><div>",
        "<h2>Design</h2>", _design_table(design, bounds),
        "</div><div>", "<h2>Demands</h2>", _demand_table(demands),
        "<h2>Risks</h2>", *(f"<p>{_text(words)}</p>" for words in _risks(demands)), "</div></div>",
        *_side_by_side({"this design": design, **(candidates or {})}, scenario, draws, model),
        '<div class="columns">', *drawn, "</div>",
        *(["<h2>Notes</h2>"] if notes.strip() else []),
        *(f"<p>{_text(part)}</p>" for part in notes.split("\n\n") if part.strip()),
        f'<p class="small">{_text(_small_print(model, draws))}</p>', _download(design, scenario),
        "</body></html>", ""])


def write_report(design, scenario, path, title=None, notes="", **options):
    """Write the page of `report` to an HTML file; `options` go to `report`. Returns the path.

    Examples
    --------
    >>> import rdk, tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     page = write_report(rdk.rover("Rashid-1"), rdk.scenario("polar_prospecting"), folder + "/rover.html")
    >>> page.name
    'rover.html'
    """
    require(design=(design, Design), scenario=(scenario, Scenario))
    return write(report(design, scenario, f"A rover for {scenario.name}" if title is None else title, notes, **options),
                 path)


def _text(words):
    return html_module.escape(str(words), quote=False)


def _on_front(front, result):
    """The design on the front: mass against the other objective that spreads most, coloured by the next."""
    def spread(name):
        values = np.asarray(getattr(front.performance, name), float)
        return np.ptp(values) / max(np.abs(values).max(), 1e-12)

    others = sorted((name for name in front.problem.objectives if name != "total_mass_kg"), key=spread, reverse=True)
    names = ["total_mass_kg", *others, "range_km", "slope_capability_deg"][:3]
    return pictures.front(*(np.asarray(getattr(front.performance, name), float) for name in names), names,
                          [float(getattr(result, name)) for name in names], SIZE,
                          title=f"Front of {len(front)} designs")


def _side_by_side(designs, scenario, draws, model):
    """A table of candidates, where there is more than one."""
    if len(designs) < 2:
        return []
    rows = []
    for name, design in designs.items():
        p = evaluate(design, scenario, model=model)
        rows.append((False, name, f"{p.total_mass_kg:.2f} kg", f"{p.range_km:.3g} km", f"{p.slope_capability_deg:.1f}°",
                     f"{100 * joint_odds(design, scenario, draws=draws, model=model):.0f} %"))
    return ["<h2>Candidates</h2>", _rows(("design", "mass", "range", "slope capability", "all demands hold in"), rows)]


def _mission_words(scenario):
    name = scenario.name.replace("_", " ")
    return (f"Mission: {name}, latitude {scenario.latitude_deg:g} deg, {scenario.duration_earth_days:g} Earth "
            f"days from {scenario.start_utc or 'sunrise'}, slopes of {scenario.slope_deg:g} deg in "
            f"{scenario.soil.name or 'some soil'}, "
            f"driving {100 * scenario.duty_cycle:g} % of the time, payload {scenario.payload_mass_kg:g} kg, "
            f"{scenario.payload_power_w:g} W, panel tilt {scenario.panel_tilt_deg:g} deg, range limit "
            f"{scenario.traverse_limit_km:g} km.")


def _rows(header, rows):
    """A table from cells; a row that starts with True is one that misses its demand."""
    marked = ' class="missed"'
    head = "".join(f"<th>{_text(cell)}</th>" for cell in header)
    body = "".join(f"<tr{marked * missed}>" + "".join(f"<td>{_text(cell)}</td>" for cell in cells) + "</tr>"
                   for missed, *cells in rows)
    return f"<table><tr>{head}</tr>{body}</table>"


def _design_table(design, bounds):
    rows = []
    for name, variable in DESIGN_SPACE.items():
        value = getattr(design, name)
        low, high = (bounds or {}).get(name, (variable.low, variable.high))
        outside = not low * (1 - 1e-12) <= value <= high * (1 + 1e-12)
        unit = f" {variable.unit}" if variable.unit != "1" else ""
        rows.append((outside, variable.label, f"{value:.4g}{unit}",
                     f"{low:g} to {high:g}" + ", outside" * outside))
    return _rows(("variable", "value", "allowed"), rows)


def _demand_table(demands):
    rows = []
    for d in demands:
        if d.metric == "feasible":
            cells = ("yes" if d.met else "no", "–")
        else:
            cells = (f"{d.nominal:.3g}", f"{d.low:.3g} to {d.high:.3g}")
        rows.append((not d.met, d.words, *cells, f"{100 * d.share:.0f} %"))
    return _rows(("demand", "design", "90 % interval", "holds in"), rows)


def _risks(demands):
    """Sentences on the demands that hold least often, and what moves them."""
    at_risk = sorted((d for d in demands if d.share < 0.995), key=lambda d: d.share)[:3]
    if not at_risk:
        return ["Every demand holds in all draws of the uncertain inputs."]
    return [f"“{d.words}” fails in {100 * (1 - d.share):.0f} % of the draws"
            + (f"; it moves most with the {_UNITS.sub('', d.driver).replace('_', ' ')}." if d.driver else ".")
            for d in at_risk]


def _small_print(model, draws):
    changed = {name: value for name, value in model.numbers().items() if value != getattr(Model(), name)}
    words = ", ".join(f"{name} = {value:g}" for name, value in changed.items()) or "the paper's coefficients"
    return (f"Intervals: {draws} draws from data/uncertainties.csv, 5 % to 95 %; they cover soil and "
            "coefficients, not what the models leave out: tip-over, load transfer, terrain shadows, multi-pass, "
            f"and structure that must grow with its load. Model: {words}.")


def _download(design, scenario):
    data = base64.b64encode(catalog.to_json(design, scenario).encode()).decode()
    return ('<p class="screen"><a download="design.json" href="data:application/json;base64,' + data
            + '">design.json</a>: open it in the explorer.</p>')
