"""Rows of the paper's ledger that the evidence answers: wheels, masses, flown rovers. `searches` has the others."""
from __future__ import annotations

import functools

from .. import catalog
from .flown import flown_rovers
from .masses import published_masses, published_masses_summary
from .wheels import EXPERIMENTS, load_transfer, pull_shift, single_wheel, single_wheel_summary

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
    fronts = evidence.searches.canonical.values()
    largest = max(abs(load_transfer(front.designs, front.scenario)).max() for front in fronts)
    tenacious = load_transfer(catalog.rover("Tenacious"), catalog.scenario("highland_slope_capability"))
    return largest, (f"largest change over the four fronts; where the pull is nearly used up it is far more: "
                     f"{tenacious:.0f} % for Tenacious on apollo-loose")
