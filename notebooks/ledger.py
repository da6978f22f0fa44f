"""The paper's ledger: every number that it reports beside ours, computed afresh.

Each study behind the rows runs once in a ledger, when the first row asks for it. About 150 searches make the whole.
"""
from __future__ import annotations

import dataclasses
import functools
import re
import time
from functools import cached_property

import numpy as np
import pandas as pd

from rdk import _contact as contact
from rdk import catalog, rediscovery, rules
from rdk.mission import evaluate
from rdk.sampling import random_designs
from rdk.studies import fronts
from rdk.tradespace import pareto_front
from rdk.validation import (
    EXPERIMENTS, flown_rovers, load_transfer, published_masses, published_masses_summary, pull_shift, single_wheel,
    single_wheel_summary)


ROWS = {}
"""How each row is computed, by its id."""


def ledger_row(*ids):
    """Register a function of the evidence as the computation of ledger rows; with several ids it also gets the id."""
    def register(function):
        for name in ids:
            ROWS[name] = functools.partial(function, id=name) if len(ids) > 1 else function
        return function
    return register


class Evidence:
    """The tables behind the ledger, each computed once when first needed."""

    def __init__(self, searches=None):
        self.searches = searches

    @functools.cached_property
    def single_wheel(self):
        return single_wheel_summary().set_index(["experiment", "quantity"])

    @functools.cached_property
    def masses(self):
        return published_masses()

    @functools.cached_property
    def mass_summary(self):
        return published_masses_summary(self.masses).set_index("rovers_included").loc["in class"]

    @functools.cached_property
    def flown(self):
        return flown_rovers().set_index("rover")


_ROVERS = {"tenacious": "Tenacious", "cadre": "CADRE-unit", "rashid": "Rashid-1", "sojourner": "Sojourner",
           "pragyan": "Pragyan", "yutu2": "Yutu-2", "marsokhod": "MARSOKHOD"}


@ledger_row("dp_ding", "dp_hurrell", "dp_wang", "z_ding", "z_hurrell", "z_wang")
def _wheel_median(evidence, id):
    quantity, source = id.split("_")
    row = evidence.single_wheel.loc[EXPERIMENTS[source], {"dp": "drawbar_pull", "z": "sinkage"}[quantity]]
    note = ""
    if quantity == "z" and row.over_predicted * 2 >= row.points:
        note = f"the sign matters: the kernel sinks too far at {row.over_predicted} of {row.points} points"
    return row.median_abs_error_pct, note


@ledger_row("z_kls1_mm")
def _kls1_sinkage(evidence):
    solved = single_wheel().query("soil == 'kls-1'").model_sinkage_mm
    return solved.median(), f"median over the points; they span {solved.min():.1f} to {solved.max():.1f} mm"


@ledger_row(*(f"mass_{name}" for name in _ROVERS))
def _mass(evidence, id):
    return evidence.masses.set_index("rover").predicted_mass_kg[_ROVERS[id.removeprefix("mass_")]]


@ledger_row("mass_median", "mass_mean")
def _mass_error(evidence, id):
    return evidence.mass_summary[id.removeprefix("mass_") + "_abs_error_pct"]


@ledger_row("solar_pragyan_w")
def _solar_pragyan(evidence):
    return evidence.flown.clean_peak_w["Pragyan"], "with the 0.98 of a clean array"


@ledger_row("solar_pragyan_band_w")
def _solar_pragyan_band(evidence):
    row = evidence.flown.loc["Pragyan"]
    return (row.clean_peak_low_w, row.clean_peak_high_w), "with the 0.98 of a clean array"


@ledger_row("solar_yutu2_w")
def _solar_yutu2(evidence):
    row = evidence.flown.loc["Yutu-2"]
    return row.peak_w, f"without the 0.98 that Pragyan's figure has; with it {row.clean_peak_w:.1f} W"


@ledger_row("derate_yutu2")
def _derate_yutu2(evidence):
    row = evidence.flown.loc["Yutu-2"]
    with_loss = row.published_peak_w / row.clean_peak_w
    return row.implied_derate, f"{with_loss:.3f} against an array that counts the 0.98, as Pragyan's does"


@ledger_row("night_pragyan", "night_yutu2")
def _night(evidence, id):
    return bool(evidence.flown.survives[_ROVERS[id.removeprefix("night_")]])


@ledger_row("range_pragyan_m", "range_yutu2_m")
def _range(evidence, id):
    row = evidence.flown.loc[_ROVERS[id.split("_")[1]]]
    return row.range_m, f"the scenario's traverse limit; without it the envelope is {row.unlimited_range_km:.1f} km"


@ledger_row("shear_shift_15", "shear_shift_30")
def _shear_shift(evidence, id):
    change = int(id[-2:]) / 100
    down, up = pull_shift([1 - change, 1 + change]).median_shift_pct
    return (down + up) / 2, (f"mean of the two sides: {down:.1f} % at {1 - change:.2f}, {up:.1f} % at "
                             f"{1 + change:.2f}; the paper's figure is the upper side")


@ledger_row("load_transfer_pct")
def _load_transfer(evidence):
    canonical = evidence.searches.canonical.values()
    largest = max(abs(load_transfer(front.designs, front.scenario)).max() for front in canonical)
    tenacious = load_transfer(catalog.rover("Tenacious"), catalog.scenario("highland_slope_capability"))
    return largest, (f"largest change over the four fronts; where the pull is nearly used up it is far more: "
                     f"{tenacious:.0f} % for Tenacious on apollo-loose")


# ---- searches -------------------------------------------------------------------------------------------------

TRAVERSE = ("equatorial_mare_traverse", "polar_prospecting", "crater_rim_survey")
"""The scenarios whose fronts trade range, mass and slope capability."""
SHORT = {"mare": "equatorial_mare_traverse", "polar": "polar_prospecting", "crater": "crater_rim_survey",
         "highland": "highland_slope_capability"}
BUDGET_SEEDS, BUDGET_GENERATIONS = (12, 112), (30, 60, 90)


class Searches:
    """The studies behind the rows, each computed once.

    Parameters
    ----------
    executor : concurrent.futures.Executor, optional
        Runs the fronts in parallel, with the same result.
    seed_offset : int
        Added to the paper's seeds, to see what chance does to a row.
    """

    def __init__(self, executor=None, seed_offset=0):
        self.executor, self.seed_offset = executor, seed_offset

    def run(self):
        """Compute all studies now, one after the other; yields the name of each as it is done."""
        for name in ("canonical", "scaled", "crossover", "budget", "rediscovery", "baselines"):
            getattr(self, name)
            yield name

    def _study(self, **options):
        """Fronts of the four canonical scenarios, each with its own seed."""
        found = {}
        for scenario in map(catalog.scenario, catalog.scenario_names("canonical")):
            shifted = dataclasses.replace(scenario.problem, seed=scenario.problem.seed + self.seed_offset)
            found |= fronts([dataclasses.replace(scenario, problem=shifted)], executor=self.executor, **options)
        return found

    @cached_property
    def canonical(self):
        """The four fronts, by scenario name."""
        return {case.scenario.name: front for case, front in self._study().items()}

    @cached_property
    def statistics(self):
        return rules.front_statistics(self.canonical.values()).set_index("scenario")

    @cached_property
    def scaled(self):
        """Fronts by scenario name and shear scale; the nominal ones are the canonical ones."""
        others = self._study(shear_scales=[scale for scale in rules.SHEAR_SCALES if scale != 1])
        return ({(case.scenario.name, case.shear_scale): front for case, front in others.items()}
                | {(name, 1.0): front for name, front in self.canonical.items()})

    @cached_property
    def scale_statistics(self):
        return rules.front_statistics(self.scaled.values()).set_index(["scenario", "shear_scale"])

    @cached_property
    def crossover(self):
        cases = self._study(obstacle_heights_m=[height for height in rules.OBSTACLE_HEIGHTS_M if height > 0])
        return rules.crossover(rules.front_statistics([*self.canonical.values(), *cases.values()]))

    @cached_property
    def budget(self):
        """Fronts of 90 generations: their statistics, and the hypervolume at 30, 60 and 90; a row a seed."""
        scenarios = [catalog.scenario(name) for name in catalog.scenario_names("canonical")]
        cases = fronts(scenarios, seeds=[seed + self.seed_offset for seed in BUDGET_SEEDS],
                       generations=max(BUDGET_GENERATIONS), executor=self.executor)
        found = rules.front_statistics(cases.values())
        return found.assign(**{str(g): [front.history[g - 1] for front in cases.values()]
                               for g in BUDGET_GENERATIONS})

    @cached_property
    def rediscovery(self):
        return rediscovery.rediscover(seeds=[seed + self.seed_offset for seed in range(5)], executor=self.executor)

    @cached_property
    def baselines(self):
        return rediscovery.baselines(self.rediscovery, count=8000, seed=self.seed_offset)


# ---- fronts ------------------------------------------------------------------------------------------------

@ledger_row("hv60_crater", "hv60_mare", "hv60_highland", "hv60_polar")
def _hypervolume(evidence, id):
    scenario = SHORT[id.removeprefix("hv60_")]
    found = evidence.searches.budget.query("scenario == @scenario")
    one, other = found["60"]
    return found["60"].mean(), (f"mean of two seeds, {one:.3f} and {other:.3f}; 30 more generations bring "
                                f"{(found['90'] - found['60']).mean():.3f} on average")


@ledger_row("hv_ratio")
def _hypervolume_ratio(evidence):
    mean = evidence.searches.budget.groupby("scenario")[["60", "90"]].mean()
    ratio = mean["60"] / mean["90"]
    return (ratio.min(), ratio.max()), ("a ratio near 1 says that the hypervolume hardly grows, not that the "
                                        "designs have settled: see the battery rows")


@ledger_row(*(f"front_{name}_{what}" for name in ("mare", "crater", "polar")
              for what in ("range_km", "mass_kg")))
def _span(evidence, id):
    _, name, what, unit = id.split("_")
    columns = [f"{what}_{end}_{unit}" for end in ("min", "max")]
    searches, scenario = evidence.searches, SHORT[name]
    lows = searches.budget.query("scenario == @scenario")[columns[0]]
    return tuple(searches.statistics.loc[scenario, columns]), (
        f"the low end is chance while the search is unfinished: {lows.min():.1f} and {lows.max():.1f} {unit} "
        "in the two searches of 90 generations")


@ledger_row("front_highland_km_at_8kg")
def _highland_light(evidence):
    row = evidence.searches.statistics.loc[SHORT["highland"]]
    again = pareto_front(catalog.scenario(SHORT["highland"]), seed=int(row.seed), generations=300)
    mass, distance = again.performance.total_mass_kg, again.performance.range_km
    return row.range_lightest_km, (
        f"this front ends at {row.mass_min_kg:.1f} kg; after 300 generations it ends at {mass[0]:.1f} kg, "
        f"and designs of up to 8 kg reach {distance[mass <= 8].max(initial=0):.1f} km")


@ledger_row("front_highland_plateau_km")
def _highland_plateau(evidence):
    front = evidence.searches.canonical[SHORT["highland"]]
    return front.performance.range_km.max(), (
        f"the hub's no-load speed, not the energy, limits {front.performance.hub_speed_limited.mean():.0%} "
        "of the front; the paper's text does not mention it")


@ledger_row("front_highland_slope_deg")
def _highland_slope(evidence):
    columns, searches = ["slope_min_deg", "slope_max_deg"], evidence.searches
    longer = searches.budget.query("scenario == @SHORT['highland']")[columns].to_numpy().round(1).tolist()
    return tuple(searches.statistics.loc[SHORT["highland"], columns]), (
        "no objective of this front; {}..{} and {}..{} deg in the two searches of 90 generations".format(*sum(longer, [])))


@ledger_row("highland_slope_ceiling_deg")
def _slope_ceiling(evidence):
    scenario = catalog.scenario(SHORT["highland"])
    front = pareto_front(scenario, seed=scenario.problem.seed + evidence.searches.seed_offset, constraints=(),
                         objectives={"slope_capability_deg": "max", "total_mass_kg": "min"})
    return front.performance.slope_capability_deg.max(), "from a search for slope capability and mass alone"


@ledger_row("slope_saturation_deg")
def _saturation(evidence):
    found = evidence.searches.statistics.loc[list(TRAVERSE)]
    return (found.slope_max_deg.min(), found.slope_max_deg.max()), (
        f"steepest design of each front; the medians are {found.slope_median_deg.min():.1f} to "
        f"{found.slope_median_deg.max():.1f} deg")


# ---- design rules ------------------------------------------------------------------------------------------

@ledger_row("four_wheels_pct")
def _four_wheels(evidence):
    return 100 * evidence.searches.statistics.four_wheels.min()


@ledger_row("width_lowest_5pct")
def _width_low(evidence):
    front = evidence.searches.canonical[SHORT["highland"]]
    share, count = (evidence.searches.statistics[name] for name in ("width_lowest_5pct", "designs"))
    wide = front.designs.wheel_width_m > 0.0385
    words = "all of them are"
    if wide.any():
        lost = rules.swapped(front, wheel_width_m=0.03).range_change_km[wide]
        words = (f"{wide.sum()} points of the highland front are wider, all above "
                 f"{front.performance.total_mass_kg[wide].min():.0f} kg: narrowed to 30 mm at equal mass "
                 f"their range changes by {lost.min():.1f} to {lost.max():.1f} km, so on loose soil a heavy "
                 "rover uses its width")
    return 100 * (share * count).sum() / count.sum(), words


@ledger_row("width_floor_pct")
def _width_floor(evidence):
    shares = {limit: [100 * np.mean(front.designs.wheel_width_m <= limit) for front in
                      evidence.searches.canonical.values()] for limit in (0.03, 0.0305)}
    floor = 100 * evidence.searches.statistics.width_at_floor
    return (floor.min(), floor.max()), (
        f"within 1 % of the searched range, as the paper names no width of its floor: exactly 30 mm are "
        f"{max(shares[0.03]):.0f} %, within half a millimetre {min(shares[0.0305]):.0f} to "
        f"{max(shares[0.0305]):.0f} %")


@ledger_row("polar_battery_wh", "mare_battery_wh", "polar_array_m2")
def _storage(evidence, id):
    name, what, _ = id.split("_")
    column = {"battery": "battery_median_wh", "array": "array_median_m2"}[what]
    searches, scenario = evidence.searches, SHORT[name]
    others = searches.budget.query("scenario == @scenario")[column]
    note = f"{others.min():.3g} and {others.max():.3g} in the two searches of 90 generations"
    if what == "battery":
        change = rules.swapped(searches.canonical[scenario], battery_capacity_wh=5.0).range_change_km
        note = (f"not settled by the objectives: {note}; with 5 Wh and the mass made up in the chassis the "
                f"range of half the designs changes by less than {abs(change).median():.2f} km")
    return searches.statistics.loc[scenario, column], note


# ---- robustness and architecture ---------------------------------------------------------------------------

@ledger_row("highland_085_km", "highland_115_km", "highland_070")
def _highland_scaled(evidence, id):
    front = evidence.searches.scaled[SHORT["highland"], int(id.split("_")[1]) / 100]
    if not len(front):
        return "infeasible", front.message
    return front.performance.range_km.max()


@ledger_row("slope_band_deg", "slope_070_deg")
def _slope_scaled(evidence, id):
    scales = (0.70,) if id == "slope_070_deg" else (0.85, 1.0, 1.15)
    found = evidence.searches.scale_statistics.loc[(list(TRAVERSE), list(scales)), :]
    return (found.slope_max_deg.min(), found.slope_max_deg.max()), (
        f"steepest design of each front; the medians are {found.slope_median_deg.min():.1f} to "
        f"{found.slope_median_deg.max():.1f} deg"
        + ("; where traction is plentiful, light rovers with small wheels join the front"
           if len(scales) > 1 else ""))


@ledger_row("four_wheels_all_scales")
def _four_wheels_scaled(evidence):
    share = evidence.searches.scale_statistics.four_wheels.dropna()
    worst = share.idxmin()
    if share[worst] == 1:
        return 100.0, "every front that is not empty"
    front = evidence.searches.scaled[worst]
    rival = pareto_front(front.scenario, seed=front.problem.seed, model=front.model,
                         bounds={"wheel_count": (4, 4)})
    beaten = rules.dominated(front, [rival]).mean()
    return 100 * share[worst], (
        f"{(share == 1).sum()} of {len(share)} fronts are; the search of {worst[0]} at {worst[1]:g} was "
        f"caught among six-wheeled designs, and {beaten:.0%} of them are dominated by four-wheeled ones of a "
        "search without that choice")


@ledger_row("obstacle_crossover_m")
def _crossover(evidence):
    found = evidence.searches.crossover.crossover_m
    return (found.min(), found.max()), ("set by the search bound of the wheel radius, half of 0.20 m: at "
                                        "0.10 m only a radius of exactly 0.20 m would do")


# ---- rediscovery -------------------------------------------------------------------------------------------

@ledger_row("random_pair", "feasible_pair", "feasible_fraction")
def _baseline(evidence, id):
    found = evidence.searches.baselines[id]
    return found.mean() if id == "random_pair" else (found.min(), found.max())


_FOUND = {"tenacious": "Tenacious", "cadre": "CADRE-unit", "rashid": "Rashid-1", "pragyan": "Pragyan",
          "moonranger": "MoonRanger", "yutu2": "Yutu-2"}


@ledger_row(*(f"rediscover_{name}" for name in _FOUND))
def _distance(evidence, id):
    rover = _FOUND[id.removeprefix("rediscover_")]
    found, chance = (table.set_index("rover").loc[rover] for table in
                     (evidence.searches.rediscovery, evidence.searches.baselines))
    return found.distance, (f"{chance.nearest_capped:.2f} to the nearest of {found.front_designs} random "
                            "feasible designs under the same mass ceiling")


@ledger_row("rediscover_dominated")
def _dominated(evidence):
    return int(evidence.searches.rediscovery.dominated.sum())


# ---- cost --------------------------------------------------------------------------------------------------

@ledger_row("solves_per_evaluation")
def _solves(evidence):
    designs, scenario = random_designs(400, seed=0), catalog.scenario(SHORT["mare"])
    return f"{stress_integrals(designs, scenario):.0f} stress integrals", (
        "two entry angles and one balance of slip and entry angle, each by Newton; each of the original's 19 "
        "solves holds a root search of its own")


@ledger_row("front_seconds")
def _front_seconds(evidence):
    start = time.perf_counter()
    pareto_front(catalog.scenario(SHORT["mare"]))
    return f"{time.perf_counter() - start:.2g} s", "on this machine; pymoo's own share included"


@ledger_row("fixed_plus_hourly")
def _cost(evidence):
    scenario, designs = catalog.scenario(SHORT["mare"]), random_designs(400, seed=0)
    words = []
    for population in (designs[0], designs):
        day, year = (_seconds(population, dataclasses.replace(scenario, duration_earth_days=days))
                     / max(np.size(population.wheel_radius_m), 1) for days in (1, 365))
        hourly = (year - day) / (364 * 24)
        words.append(f"{1e3 * (day - 24 * hourly):.2g} ms + {1e6 * hourly:.2g} us")
    return f"{words[0]}; in 400: {words[1]}", ("fixed cost and cost per simulated hour, of a single design "
                                               "and of one in a population of 400")


def _seconds(designs, scenario):
    """Shortest of five timings of an evaluation."""
    times = []
    for _ in range(5):
        start = time.perf_counter()
        evaluate(designs, scenario)
        times.append(time.perf_counter() - start)
    return min(times)


def stress_integrals(designs, scenario):
    """How often an evaluation integrates the stresses around a contact arc, mean over the designs."""
    count, arcs = 0, contact.Arcs

    def counted(theta_1, *arguments, **options):
        nonlocal count
        count += np.size(theta_1)
        return arcs(theta_1, *arguments, **options)

    contact.Arcs = counted
    try:
        evaluate(designs, scenario)
    finally:
        contact.Arcs = arcs
    return count / len(designs)


# ---- the table ------------------------------------------------------------------------------------------------

_BOUND = re.compile(r"(>=|<=|<|>)?\s*(-?[\d.]+?)(?:\.\.(-?[\d.]+))?$")
_COMPARE = {">=": np.greater_equal, "<=": np.less_equal, "<": np.less, ">": np.greater}


def accepts(accept, value):
    """Whether a value is inside a band of `paper_targets.csv`.

    Parameters
    ----------
    accept : str
        "low..high"; a bound such as "<= 0.20"; a number or a word, to be met exactly; several parts joined by ";",
        each starting with "max" or "min", for the largest and smallest value; "report ours ...", which nothing can
        fail. What follows " or " is not a bound.
    value : float, bool, str or sequence of float
        All of a sequence must be inside, unless a part says max or min.

    Returns
    -------
    bool or None
        None where nothing is asked but to report.

    Raises
    ------
    ValueError
        If `accept` cannot be read.

    Examples
    --------
    >>> accepts("26.5..27.7", 27.1), accepts("max 80; min < 8", (0.9, 80.0)), accepts("False", True)
    (True, True, False)
    """
    text = accept.partition(" or ")[0].strip()
    if text.startswith("report ours"):
        return None
    if ";" in text:
        return all(accepts(part, value) for part in text.split(";"))
    if text in ("True", "False") or isinstance(value, (bool, np.bool_)):
        return isinstance(value, (bool, np.bool_)) and str(bool(value)) == text
    if text.isalpha() or isinstance(value, str):
        return value == text
    values = np.asarray(value, float)
    which, _, rest = text.partition(" ")
    if which in ("max", "min"):
        text, values = rest, getattr(values, which)()
    bound = _BOUND.match(text)
    if not bound or (bound[1] and bound[3]):
        raise ValueError(f"accept must be a range, a bound or a word; got {accept!r}")
    low = float(bound[2])
    if bound[3]:
        inside = (values >= low) & (values <= float(bound[3]))
    elif bound[1]:
        inside = _COMPARE[bound[1]](values, low)
    else:
        inside = np.isclose(values, low, rtol=1e-6, atol=0)
    return bool(np.all(inside))


def paper_ledger(kinds=("deterministic", "stochastic", "cost"), searches=None, sections=None):
    """Every number that the paper reports beside ours, computed afresh.

    Parameters
    ----------
    kinds : sequence of str
        Which rows of `paper_targets.csv`: "deterministic", "stochastic" (numbers that a search's seed moves) or
        "cost" (timings: they differ from run to run).
    searches : Searches, optional
        The studies behind the stochastic rows: with an executor, with other seeds, or computed already.
    sections : sequence of str, optional
        Only rows of these sections of the paper.

    Returns
    -------
    pandas.DataFrame
        One row a number: id, section, quantity, paper (as printed), ours (a number, flag, word or (low, high)), agrees
        (NA where the row asks only for our value), why (a sentence where they disagree, or where agreement hides
        something).

    Raises
    ------
    ValueError
        If a kind or a section is unknown.
    NotImplementedError
        If a row has no computation.
    """
    targets = catalog.table("paper_targets.csv")
    known = list(dict.fromkeys(targets.kind))
    for kind in kinds:
        if kind not in known:
            raise ValueError(f"kinds must be among {', '.join(known)}; got {kind!r}")
    known = list(dict.fromkeys(targets.paper_section))
    for section in sections or ():
        if section not in known:
            raise ValueError(f"sections must be among {', '.join(known)}; got {section!r}")
    targets = targets[targets.kind.isin(list(kinds)) & targets.paper_section.isin(list(sections or known))]
    missing = [name for name in targets.id if name not in ROWS]
    if missing:
        raise NotImplementedError("no computation for the ledger rows " + ", ".join(missing))
    evidence, rows = Evidence(Searches() if searches is None else searches), []
    for target in targets.itertuples():
        found = ROWS[target.id](evidence)
        ours, why = found if isinstance(found, tuple) and isinstance(found[-1], str) else (found, "")
        rows.append(dict(id=target.id, section=target.paper_section, quantity=target.quantity,
                         paper=str(target.paper_value), ours=ours, agrees=accepts(str(target.accept), ours), why=why))
    return pd.DataFrame(rows).astype({"agrees": "boolean", "ours": object})
