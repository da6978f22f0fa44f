"""The paper's ledger: every number of `data/paper_targets.csv` beside ours, computed afresh.

A row that is a cell of some table stands in `LOOKUPS`; a row that takes more has a function; `ROWS` lists all. The
studies behind them run once each, in `Searches`, when the first row asks for them.
"""
from __future__ import annotations

import dataclasses
import re
import time
import warnings
from functools import cached_property, partial

import numpy as np
import pandas as pd

import rediscovery
import rules
import validation
from rdk import catalog
from rdk._fields import check
from rdk.design import Model
from rdk.mission import evaluate
from rdk.sampling import random_designs
from rdk.terramechanics import OPTIONS, wheel_forces
from rdk.tradespace import pareto_front
from searches import fronts

SHORT = {"mare": "equatorial_mare_traverse", "polar": "polar_prospecting", "crater": "crater_rim_survey",
         "highland": "highland_slope_capability"}
TRAVERSE = [name for short, name in SHORT.items() if short != "highland"]
"""The missions whose fronts trade range, mass and slope capability."""
BUDGET_SEEDS = (12, 112)


# ---- what the rows are read from ----------------------------------------------------------------------------------

class Searches:
    """The tables and studies behind the rows, each computed once, when first asked for.

    Parameters
    ----------
    executor : concurrent.futures.Executor, optional
        Runs the fronts in parallel, with the same result.
    seed_offset : int
        Added to the paper's seeds, to see what chance does to a row.
    model : Model
        Coefficients of the wheel tests, masses, fronts and load transfer; the flown rovers, the shifts of pull and the
        rediscovery always use the paper's.
    population, generations : int
        Of a front; the paper's by default. The other studies keep their proportion to it.
    """

    def __init__(self, executor=None, seed_offset=0, model=Model(), population=50, generations=60):
        self.executor, self.seed_offset, self.model = executor, seed_offset, model
        self.size = dict(population=population, generations=generations)

    # tables that need no search

    @cached_property
    def points(self):
        c1, c2 = self.model.transition
        return validation.single_wheel(transition_c1=c1, transition_c2=c2, shear_scale=self.model.shear_scale,
                                       grouser_lift_cap=self.model.grouser_lift_cap)

    @cached_property
    def wheels(self):
        return validation.single_wheel_summary(self.points).set_index(["experiment", "quantity"])

    @cached_property
    def masses(self):
        return validation.published_masses(self.model).set_index("rover")

    @cached_property
    def mass_errors(self):
        return validation.published_masses_summary(self.masses.reset_index()).set_index("rovers_included")

    @cached_property
    def flown(self):
        return validation.flown_rovers().set_index("rover")

    # fronts

    def _fronts(self, **options):
        """Fronts of the four canonical scenarios, each with its own seed."""
        found = {}
        for scenario in map(catalog.scenario, catalog.scenario_names("canonical")):
            seed = scenario.problem.seed + self.seed_offset
            found |= fronts([scenario], seeds=[seed], model=self.model, executor=self.executor, **self.size, **options)
        return found

    @cached_property
    def canonical(self):
        """The four fronts, by scenario name."""
        return {case.scenario.name: front for case, front in self._fronts().items()}

    @cached_property
    def statistics(self):
        return rules.front_statistics(self.canonical.values()).set_index("scenario")

    @cached_property
    def scaled(self):
        """Fronts by scenario name and shear scale; the nominal ones are the canonical ones."""
        others = self._fronts(shear_scales=[scale for scale in rules.SHEAR_SCALES if scale != 1])
        return ({(case.scenario.name, case.shear_scale): front for case, front in others.items()}
                | {(name, 1.0): front for name, front in self.canonical.items()})

    @cached_property
    def scale_statistics(self):
        return rules.front_statistics(self.scaled.values()).set_index(["scenario", "shear_scale"])

    @cached_property
    def crossover(self):
        """Where six wheels come in. Heights end at 0.12 m, which no wheel of the search climbs on a rigid chassis."""
        taller = self._fronts(obstacle_heights_m=(0.02, 0.04, 0.06, 0.08, 0.10, 0.12))
        return rules.crossover(rules.front_statistics([*self.canonical.values(), *taller.values()]))

    @cached_property
    def budget(self):
        """Fronts of 90 generations: their statistics, and the hypervolume at 30, 60 and 90; a row a seed."""
        scenarios = [catalog.scenario(name) for name in catalog.scenario_names("canonical")]
        at = {str(30 * k): k * self.size["generations"] // 2 for k in (1, 2, 3)}
        cases = fronts(scenarios, seeds=[seed + self.seed_offset for seed in BUDGET_SEEDS], model=self.model,
                       executor=self.executor, **self.size | {"generations": at["90"]})
        return rules.front_statistics(cases.values()).assign(**{
            name: [front.history[g - 1] for front in cases.values()] for name, g in at.items()})

    def longer(self, name, column):
        """A statistic of one mission's fronts in the searches of 90 generations, a value a seed."""
        return self.budget.loc[self.budget.scenario == name, column].to_numpy()

    # rediscovery

    @cached_property
    def found(self):
        population, generations = 6 * self.size["population"] // 5, 4 * self.size["generations"] // 15
        return rediscovery.rediscover(seeds=[seed + self.seed_offset for seed in range(5)], executor=self.executor,
                                      population=population, generations=[generations])          # 60 and 16

    @cached_property
    def chance(self):
        return rediscovery.baselines(self.found, count=160 * self.size["population"], seed=self.seed_offset)

    @cached_property
    def distances(self):
        return self.found.merge(self.chance, on="rover").set_index("rover")


# ---- rows that are a cell of a table --------------------------------------------------------------------------------

_SINKS = "the sign matters: the kernel sinks too far at {over_predicted} of {points} points"
_LIMIT = "the scenario's traverse limit; without it the envelope is {unlimited_range_km:.1f} km"
_CLEAN = "with the 0.98 of a clean array"
_CHANCE = "{nearest_capped:.2f} to the nearest of {front_designs} random feasible designs under the same mass ceiling"
_IN_CLASS = ("mass_errors", "in class")

LOOKUPS = (  # id, table of `Searches`, row, column (or the two ends), why; braces hold other columns of the row
    *((f"{quantity}_{name}", "wheels", (experiment, column), "median_abs_error_pct", why)
      for quantity, column, why in (("dp", "drawbar_pull", ""), ("z", "sinkage", _SINKS))
      for name, experiment in validation.EXPERIMENTS.items()),
    *((f"mass_{name}", "masses", rover, "predicted_mass_kg", "") for name, rover in (
        ("tenacious", "Tenacious"), ("cadre", "CADRE-unit"), ("rashid", "Rashid-1"), ("sojourner", "Sojourner"),
        ("pragyan", "Pragyan"), ("yutu2", "Yutu-2"), ("marsokhod", "MARSOKHOD"))),
    ("mass_median", *_IN_CLASS, "median_abs_error_pct", ""),
    ("mass_mean", *_IN_CLASS, "mean_abs_error_pct", ""),
    ("solar_pragyan_w", "flown", "Pragyan", "clean_peak_w", _CLEAN),
    ("solar_pragyan_band_w", "flown", "Pragyan", ("clean_peak_low_w", "clean_peak_high_w"), _CLEAN),
    ("solar_yutu2_w", "flown", "Yutu-2", "peak_w",
     "without the 0.98 that Pragyan's figure has; with it {clean_peak_w:.1f} W"),
    ("derate_yutu2", "flown", "Yutu-2", "implied_derate", "against an array that does not count the 0.98"),
    *((f"night_{name}", "flown", rover, "survives", "") for name, rover in
      (("pragyan", "Pragyan"), ("yutu2", "Yutu-2"))),
    *((f"range_{name}_m", "flown", rover, "range_m", _LIMIT) for name, rover in
      (("pragyan", "Pragyan"), ("yutu2", "Yutu-2"))),
    *((f"rediscover_{name}", "distances", rover, "distance", _CHANCE) for name, rover in (
        ("tenacious", "Tenacious"), ("cadre", "CADRE-unit"), ("rashid", "Rashid-1"), ("pragyan", "Pragyan"),
        ("moonranger", "MoonRanger"), ("yutu2", "Yutu-2"))),
)


def _look_up(searches, table, row, column, why):
    row = getattr(searches, table).loc[row]
    value = tuple(row[list(column)]) if isinstance(column, tuple) else row[column]
    return value, why.format_map(row.to_dict())


# ---- wheels and load transfer ---------------------------------------------------------------------------------------

def _kls1_sinkage(searches):
    solved = searches.points.query("soil == 'kls-1'").model_sinkage_mm
    return solved.median(), f"median over the points; they span {solved.min():.1f} to {solved.max():.1f} mm"


def _shear_shift(searches, change):
    down, up = validation.pull_shift([1 - change, 1 + change]).median_shift_pct
    return (down + up) / 2, (f"mean of the two sides: {down:.1f} % at {1 - change:.2f}, {up:.1f} % at "
                             f"{1 + change:.2f}; the paper's figure is the upper side")


def load_transfer(design, scenario, *, height_to_wheelbase=0.4, slope_deg=25.0, slip=0.6, model=Model()):
    """Change of a rover's total pull (%) when a slope shifts weight to the lower axle at fixed total mass.

    Axles are evenly spaced on a stiff frame; `rdk.stability.axle_loads` has the rocker-bogie. On two axles the loads
    are w (1 +- 2 (h/L) tan(slope)) with w the mean wheel load, on three w (1 +- 3 (h/L) tan(slope)) at the ends and w
    in the middle; all wheels turn at the same slip. NaN where the pull with equal loads is not positive or an axle
    lifts off. The scenario gives soil and payload.
    """
    ratio = check("height_to_wheelbase", height_to_wheelbase, 0)
    slope = np.radians(check("slope_deg", slope_deg, 0, below=90))
    six = np.equal(design.wheel_count, 6)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)     # designs outside the class are the caller's choice
        mass = evaluate(design, scenario, model=model).total_mass_kg
    load = mass * model.gravity_m_s2 * np.cos(slope) / design.wheel_count
    shift = np.where(six, 3.0, 2.0) * ratio * np.tan(slope)
    factors = [np.ones_like(shift), 1 + shift, np.where(shift < 1, 1 - shift, 1.0)]
    options = {name: getattr(model, name) for name in OPTIONS}
    even, lower, upper = (wheel_forces(design.wheel, scenario.soil, load * f, slip, **options).drawbar_pull_n
                          for f in factors)
    ends = np.where(six, 1 / 3, 1 / 2)                   # share of the wheels on each end axle
    change = 100 * (ends * (lower + upper - 2 * even)) / even
    return np.where((even > 0) & (shift < 1), change, np.nan)[()]


def _load_transfer(searches):
    largest = max(abs(load_transfer(front.designs, front.scenario, model=searches.model)).max()
                  for front in searches.canonical.values() if len(front))
    tenacious = load_transfer(catalog.rover("Tenacious"), catalog.scenario(SHORT["highland"]))
    return largest, (f"largest change over the four fronts; where the pull is nearly used up it is far more: "
                     f"{tenacious:.0f} % for Tenacious on apollo-loose")


# ---- fronts ---------------------------------------------------------------------------------------------------------

def _hypervolume(searches, mission):
    one, other = searches.longer(SHORT[mission], "60")
    more = (searches.longer(SHORT[mission], "90") - [one, other]).mean()
    return (one + other) / 2, (f"mean of two seeds, {one:.3f} and {other:.3f}; 30 more generations bring "
                               f"{more:.3f} on average")


def _hypervolume_ratio(searches):
    mean = searches.budget.groupby("scenario")[["60", "90"]].mean()
    ratio = mean["60"] / mean["90"]
    return (ratio.min(), ratio.max()), ("a ratio near 1 says that the hypervolume hardly grows, not that the "
                                        "designs have settled: see the battery rows")


def _span(searches, mission, what, unit):
    columns = [f"{what}_{end}_{unit}" for end in ("min", "max")]
    return tuple(searches.statistics.loc[SHORT[mission], columns]), lambda: (
        "the low end is chance while the search is unfinished: {:.1f} and {:.1f} {} in the two searches of 90 "
        "generations".format(*sorted(searches.longer(SHORT[mission], columns[0])), unit))


def _highland_light(searches):
    row = searches.statistics.loc[SHORT["highland"]]

    def why():
        again = pareto_front(catalog.scenario(SHORT["highland"]), seed=int(row.seed), model=searches.model,
                             **searches.size | {"generations": 5 * searches.size["generations"]})
        mass, distance = again.performance.total_mass_kg, again.performance.range_km
        return (f"this front ends at {row.mass_min_kg:.1f} kg; after 300 generations it ends at "
                f"{mass.min(initial=np.inf):.1f} kg, and designs of up to 8 kg reach "
                f"{distance[mass <= 8].max(initial=0):.1f} km")

    return row.range_lightest_km, why


def _highland_plateau(searches):
    result = searches.canonical[SHORT["highland"]].performance
    return result.range_km.max(initial=0), (
        f"the hub's no-load speed, not the energy, limits {result.hub_speed_limited.mean():.0%} "
        "of the front; the paper's text does not mention it")


def _highland_slope(searches):
    ends = ["slope_min_deg", "slope_max_deg"]
    return tuple(searches.statistics.loc[SHORT["highland"], ends]), lambda: (
        "no objective of this front; {0[0]:.1f}..{1[0]:.1f} and {0[1]:.1f}..{1[1]:.1f} deg in the two searches of 90 "
        "generations".format(*(searches.longer(SHORT["highland"], end) for end in ends)))


def _slope_ceiling(searches):
    scenario = catalog.scenario(SHORT["highland"])
    front = pareto_front(scenario, seed=scenario.problem.seed + searches.seed_offset, constraints=(),
                         objectives={"slope_capability_deg": "max", "total_mass_kg": "min"}, model=searches.model,
                         **searches.size)
    return front.performance.slope_capability_deg.max(initial=0), "from a search for slope capability and mass alone"


def _steepest(searches, *scales):
    table = searches.scale_statistics.loc[(TRAVERSE, list(scales)), :] if scales else searches.statistics.loc[TRAVERSE]
    return (table.slope_max_deg.min(), table.slope_max_deg.max()), (
        f"steepest design of each front; the medians are {table.slope_median_deg.min():.1f} to "
        f"{table.slope_median_deg.max():.1f} deg; where traction is plentiful, light rovers with small wheels join")


# ---- design rules ---------------------------------------------------------------------------------------------------

def _width_low(searches):
    front = searches.canonical[SHORT["highland"]]
    share, count = (searches.statistics[name].fillna(0) for name in ("width_lowest_5pct", "designs"))
    wide, words = front.designs.wheel_width_m > 0.0385, "all of them are"
    if wide.any():
        lost = rules.swapped(front, wheel_width_m=0.03).range_change_km[wide]
        words = (f"{wide.sum()} points of the highland front are wider, all above "
                 f"{front.performance.total_mass_kg[wide].min():.0f} kg: narrowed to 30 mm at equal mass "
                 f"their range changes by {lost.min():.1f} to {lost.max():.1f} km, so on loose soil a heavy "
                 "rover uses its width")
    return 100 * (share * count).sum() / count.sum(), words


def _width_floor(searches):
    exact, near = ([100 * np.mean(front.designs.wheel_width_m <= limit) for front in searches.canonical.values()
                    if len(front)] for limit in (0.03, 0.0305))
    floor = 100 * searches.statistics.width_at_floor
    return (floor.min(), floor.max()), (
        f"within 1 % of the searched range, as the paper names no width of its floor: exactly 30 mm are "
        f"{max(exact):.0f} %, within half a millimetre {min(near):.0f} to {max(near):.0f} %")


def _storage(searches, mission, column):
    def why():
        others = searches.longer(SHORT[mission], column)
        note = f"{others.min():.3g} and {others.max():.3g} in the two searches of 90 generations"
        if column != "battery_median_wh":
            return note
        change = rules.swapped(searches.canonical[SHORT[mission]], battery_capacity_wh=5.0).range_change_km
        return (f"not settled by the objectives: {note}; with 5 Wh and the mass made up in the chassis the "
                f"range of half the designs changes by less than {abs(change).median():.2f} km")

    return searches.statistics.loc[SHORT[mission], column], why


# ---- robustness and architecture ------------------------------------------------------------------------------------

def _highland_scaled(searches, scale):
    front = searches.scaled[SHORT["highland"], scale]
    return front.performance.range_km.max() if len(front) else ("infeasible", front.message)


def _four_wheels_scaled(searches):
    share = searches.scale_statistics.four_wheels.dropna()
    worst = share.idxmin()
    if share[worst] == 1:
        return 100.0, "every front that is not empty"
    front = searches.scaled[worst]
    rival = pareto_front(front.scenario, seed=front.problem.seed, model=front.model, bounds={"wheel_count": (4, 4)},
                         **searches.size)
    return 100 * share[worst], (
        f"{(share == 1).sum()} of {len(share)} fronts are; the search of {worst[0]} at {worst[1]:g} was "
        f"caught among six-wheeled designs, and {rules.dominated(front, [rival]).mean():.0%} of them are dominated "
        "by four-wheeled ones of a search without that choice")


def _crossover(searches):
    found = searches.crossover.crossover_m
    return (found.min(), found.max()), ("set by the search bound of the wheel radius, half of 0.20 m: at "
                                        "0.10 m only a radius of exactly 0.20 m would do")


# ---- cost -----------------------------------------------------------------------------------------------------------

def _seconds(compute):
    """Shortest of three timings."""
    times = []
    for _ in range(3):
        start = time.perf_counter()
        compute()
        times.append(time.perf_counter() - start)
    return min(times)


def _solves(searches):
    designs, scenario = random_designs(400, seed=0), catalog.scenario(SHORT["mare"])
    result = evaluate(designs, scenario)
    load_n = result.total_mass_kg * Model().gravity_m_s2 / designs.wheel_count
    one = _seconds(lambda: wheel_forces(designs.wheel, scenario.soil, load_n, 0.3))
    whole = _seconds(lambda: evaluate(designs, scenario))
    return f"the time of {whole / one:.1f} solves", (
        "the whole evaluation of 400 designs, over one wheel-soil solve of each at a slip of 0.3; the original "
        "searches a root within each of its 19")


def _front_seconds(searches):
    return (f"{_seconds(lambda: pareto_front(catalog.scenario(SHORT['mare']))):.2g} s",
            "on this machine; pymoo's own share included")


def _fixed_and_hourly(searches):
    scenario, designs, words = catalog.scenario(SHORT["mare"]), random_designs(400, seed=0), []
    for population in (designs[0], designs):
        day, year = (_seconds(partial(evaluate, population, dataclasses.replace(scenario, duration_earth_days=days)))
                     / np.size(population.wheel_radius_m) for days in (1, 365))
        hourly = (year - day) / (364 * 24)
        words.append(f"{1e3 * (day - 24 * hourly):.2g} ms + {1e6 * hourly:.2g} us")
    return f"{words[0]}; in 400: {words[1]}", ("fixed cost and cost per simulated hour, of a single design "
                                               "and of one in a population of 400")


# ---- the table ------------------------------------------------------------------------------------------------------

COMPUTED = (  # id, function of `Searches`, its other arguments
    ("z_kls1_mm", _kls1_sinkage),
    ("shear_shift_15", _shear_shift, 0.15), ("shear_shift_30", _shear_shift, 0.30),
    ("load_transfer_pct", _load_transfer),
    *((f"hv60_{mission}", _hypervolume, mission) for mission in SHORT),
    ("hv_ratio", _hypervolume_ratio),
    *((f"front_{mission}_{what}_{unit}", _span, mission, what, unit)
      for mission in ("mare", "crater", "polar") for what, unit in (("range", "km"), ("mass", "kg"))),
    ("front_highland_km_at_8kg", _highland_light),
    ("front_highland_plateau_km", _highland_plateau),
    ("front_highland_slope_deg", _highland_slope),
    ("highland_slope_ceiling_deg", _slope_ceiling),
    ("slope_saturation_deg", _steepest),
    ("four_wheels_pct", lambda searches: 100 * searches.statistics.four_wheels.min()),
    ("width_lowest_5pct", _width_low),
    ("width_floor_pct", _width_floor),
    ("polar_battery_wh", _storage, "polar", "battery_median_wh"),
    ("mare_battery_wh", _storage, "mare", "battery_median_wh"),
    ("polar_array_m2", _storage, "polar", "array_median_m2"),
    *((f"highland_{scale}", _highland_scaled, int(scale[:3]) / 100) for scale in ("085_km", "115_km", "070")),
    ("slope_band_deg", _steepest, 0.85, 1.0, 1.15), ("slope_070_deg", _steepest, 0.70),
    ("four_wheels_all_scales", _four_wheels_scaled),
    ("obstacle_crossover_m", _crossover),
    ("random_pair", lambda searches: searches.chance.random_pair.mean()),
    *((name, lambda searches, name: (searches.chance[name].min(), searches.chance[name].max()), name)
      for name in ("feasible_pair", "feasible_fraction")),
    ("rediscover_dominated", lambda searches: int(searches.found.dominated.sum())),
    ("solves_per_evaluation", _solves), ("front_seconds", _front_seconds), ("fixed_plus_hourly", _fixed_and_hourly),
)
ROWS = {id: (_look_up, *arguments) for id, *arguments in LOOKUPS} | {
    id: (function, *arguments) for id, function, *arguments in COMPUTED}
"""How each row is computed, by its id: a function of `Searches` and its other arguments; it returns our value, or that
and a sentence, or that and a function that finds the sentence by a further search."""

_BOUND = re.compile(r"(>=|<=|<|>)?\s*(-?[\d.]+?)(?:\.\.(-?[\d.]+))?$")
_COMPARE = {">=": np.greater_equal, "<=": np.less_equal, "<": np.less, ">": np.greater}


def accepts(accept, value):
    """Whether a value is inside a band of `paper_targets.csv`.

    A band is "low..high"; a bound such as "<= 0.20"; a number or a word, to be met exactly; several parts joined by
    ";", each starting with "max" or "min", for the largest and smallest value; or "report ours ...", which nothing can
    fail and gives None. What follows " or " is not a bound. All of a sequence must be inside, unless a part says which.

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


def paper_ledger(kinds=("deterministic", "stochastic", "cost"), searches=None, sections=None, reasons=True):
    """Every number that the paper reports beside ours, computed afresh.

    Parameters
    ----------
    kinds : sequence of str
        Which rows of `paper_targets.csv`: "deterministic", "stochastic" (numbers that a search's seed moves) or
        "cost" (timings: they differ from run to run).
    searches : Searches, optional
        The studies behind the rows: with an executor, other seeds, another model, or computed already.
    sections : sequence of str, optional
        Only rows of these sections of the paper.
    reasons : bool
        Without, searches that serve only a row's `why` are left out, and that `why` is empty.

    Returns
    -------
    pandas.DataFrame
        One row a number: id, section, quantity, paper (as printed), ours (a number, flag, word or (low, high)), agrees
        (NA where the row asks only for our value), why (a sentence where they disagree, or where agreement hides
        something).
    """
    targets = catalog.table("paper_targets.csv")
    for name, column, wanted in ("kinds", "kind", kinds), ("sections", "paper_section", sections):
        known = list(dict.fromkeys(targets[column]))
        if isinstance(wanted, str):
            raise ValueError(f"{name} must be a list such as [{known[0]!r}]; got {wanted!r}")
        for value in wanted or ():
            if value not in known:
                raise ValueError(f"{name} must be among {', '.join(known)}; got {value!r}")
        targets = targets[targets[column].isin(known if wanted is None else list(wanted))]
    if missing := [name for name in targets.id if name not in ROWS]:
        raise NotImplementedError("no computation for the ledger rows " + ", ".join(missing))
    searches, rows = Searches() if searches is None else searches, []
    for target in targets.itertuples():
        function, *arguments = ROWS[target.id]
        found = function(searches, *arguments)
        explained = isinstance(found, tuple) and (callable(found[-1]) or isinstance(found[-1], str))
        ours, why = found if explained else (found, "")
        if callable(why):
            why = why() if reasons else ""
        rows.append(dict(id=target.id, section=target.paper_section, quantity=target.quantity,
                         paper=str(target.paper_value), ours=ours, agrees=accepts(str(target.accept), ours), why=why))
    return pd.DataFrame(rows).astype({"agrees": "boolean", "ours": object})
