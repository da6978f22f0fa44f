"""Single-wheel tests: the kernel against measured pull, sinkage and torque, point by point."""
from __future__ import annotations

import warnings

import numpy as np
import pandas as pd

from .. import catalog
from .._fields import check
from ..design import Model
from ..mission import evaluate
from ..terramechanics import Soil, Wheel, wheel_forces
from .tables import error_pct

QUANTITIES = {"drawbar_pull_n": "N", "sinkage_mm": "mm", "torque_nm": "N m"}
"""What a single-wheel test measures, with its unit."""
EXPERIMENTS = {"ding": "ding-2011", "hurrell": "hurrell-2025", "wang": "wang-han-2016"}
"""The experiments behind the paper's medians, by their short names."""


def single_wheel_conditions(points=None):
    """Wheel, soil, load and slip of single-wheel tests, ready for `wheel_forces(*conditions)`.

    Parameters
    ----------
    points : pandas.DataFrame, optional
        Rows of `single_wheel.csv`; all of them by default.

    Returns
    -------
    Wheel, Soil, ndarray, ndarray
        One lane a row; load in N, slip as a ratio.
    """
    points = catalog.table("single_wheel.csv") if points is None else points
    wheel = Wheel(points.wheel_radius_mm / 1000, points.wheel_width_mm / 1000, points.grouser_height_mm / 1000,
                  points.grouser_count)
    soils = {name: catalog.soil(name).numbers() for name in points.soil.unique()}
    soil = Soil(**{field: [soils[name][field] for name in points.soil] for field in next(iter(soils.values()))})
    return wheel, soil, points.vertical_load_n.to_numpy(float), points.slip.to_numpy(float)


def _forces(conditions, kernel):
    """The kernel's answer in the units of the measurements."""
    forces = wheel_forces(*conditions, **kernel)
    return {"drawbar_pull_n": forces.drawbar_pull_n, "sinkage_mm": 1000 * forces.sinkage_m,
            "torque_nm": forces.torque_nm}


def single_wheel(**kernel):
    """Model against measurement at every point of the single-wheel tests.

    Parameters
    ----------
    **kernel : float
        Options of `wheel_forces`, such as `shear_scale`.

    Returns
    -------
    pandas.DataFrame
        One row a point: experiment, wheel, soil, vertical_load_n, slip, and for each of drawbar_pull_n, sinkage_mm and
        torque_nm the measured value, the model's (`model_...`) and the signed error in percent (`..._error_pct`; NaN
        where nothing, or zero, was measured). One call of `wheel_forces` computes them all.
    """
    points = catalog.table("single_wheel.csv")
    model = _forces(single_wheel_conditions(points), kernel)
    table = points[["experiment", "wheel", "soil", "vertical_load_n", "slip"]].copy()
    for quantity in QUANTITIES:
        table[quantity], table["model_" + quantity] = points[quantity], model[quantity]
        table[_stem(quantity) + "_error_pct"] = error_pct(model[quantity], points[quantity])
    return table


def _stem(quantity):
    """drawbar_pull, sinkage, torque."""
    return quantity.rpartition("_")[0]


def single_wheel_summary(points=None):
    """What the errors of the single-wheel tests come to, per experiment and quantity.

    The paper's medians are those of |error| in percent over all points of an experiment, both wheels together, the
    points at zero slip and of negative pull included: that choice reproduces its six figures.

    Parameters
    ----------
    points : pandas.DataFrame, optional
        As returned by `single_wheel`, or some of its rows.

    Returns
    -------
    pandas.DataFrame
        One row an experiment and quantity: points with an error, median_abs_error_pct, median_error_pct (signed),
        over_predicted (how many points), largest_abs_error_pct, median_abs_error and its unit, and
        median_abs_error_of_load_pct (pull only: error in percent of the load).
    """
    points = single_wheel() if points is None else points
    rows = []
    for experiment, group in points.groupby("experiment", sort=False):
        for quantity, unit in QUANTITIES.items():
            group_error = group[_stem(quantity) + "_error_pct"]
            known = group_error.notna()
            error, residual = group_error[known], (group["model_" + quantity] - group[quantity])[known]
            load = group.vertical_load_n[known]
            rows.append(dict(
                experiment=experiment, quantity=_stem(quantity), points=int(known.sum()),
                median_abs_error_pct=error.abs().median(), median_error_pct=error.median(),
                over_predicted=int((error > 0).sum()), largest_abs_error_pct=error.abs().max(),
                median_abs_error=residual.abs().median(), unit=unit,
                median_abs_error_of_load_pct=(100 * residual / load).abs().median() if unit == "N" else np.nan))
    table = pd.DataFrame(rows)
    return table[table.points > 0].reset_index(drop=True)


def single_wheel_curves(slip, **kernel):
    """The kernel's curves through the single-wheel tests.

    Parameters
    ----------
    slip : array_like, shape (n,)
        Slip ratios.
    **kernel : float
        Options of `wheel_forces`.

    Returns
    -------
    pandas.DataFrame
        One row a test (experiment and wheel) and slip: experiment, wheel, soil, slip, model_drawbar_pull_n,
        model_sinkage_mm, model_torque_nm.
    """
    tests = catalog.table("single_wheel.csv").drop_duplicates(["experiment", "wheel"])
    slip = np.atleast_1d(check("slip", slip, -1, 1))
    lanes = tests.loc[tests.index.repeat(len(slip))].assign(slip=np.tile(slip, len(tests))).reset_index(drop=True)
    model = _forces(single_wheel_conditions(lanes), kernel)
    return lanes[["experiment", "wheel", "soil", "slip"]].assign(**{"model_" + q: model[q] for q in QUANTITIES})


def bootstrap_medians(reading_error_n=0.5, reading_error_m=1e-3, reading_error_nm=0.1, *, resample_points=False,
                      samples=2000, seed=0):
    """What an error in reading the points off printed figures does to the medians of |error|.

    Every measured value is read again `samples` times with a normal error; the model stays as it is. That is a
    parametric bootstrap. With `resample_points`, each sample also draws its points with replacement: what another
    choice of points could have given.

    Parameters
    ----------
    reading_error_n, reading_error_m, reading_error_nm : float
        Standard deviation of the reading of drawbar pull (N), sinkage (m) and torque (N m), zero or more.
    resample_points : bool
        Draw the points of an experiment with replacement as well.
    samples : int
        How many, 1 or more.
    seed : int, optional
        Same seed, same table.

    Returns
    -------
    pandas.DataFrame
        One row an experiment and quantity: points, median_abs_error_pct as printed, and low_pct, median_pct, high_pct:
        the 5, 50 and 95 % points of that median over the samples.

    Raises
    ------
    ValueError
        If an argument is out of range.
    """
    sigma = dict(zip(QUANTITIES, (check("reading_error_n", reading_error_n, 0, scalar=True),
                                  1000 * check("reading_error_m", reading_error_m, 0, scalar=True),
                                  check("reading_error_nm", reading_error_nm, 0, scalar=True))))
    samples = int(check("samples", samples, 1, whole=True, scalar=True))
    rng, points, rows = np.random.default_rng(seed), single_wheel(), []
    for experiment, group in points.groupby("experiment", sort=False):
        for quantity, spread in sigma.items():
            group_known = group[group[_stem(quantity) + "_error_pct"].notna()]
            if group_known.empty:
                continue
            measured, model = (group_known[name].to_numpy() for name in (quantity, "model_" + quantity))
            read = measured + spread * rng.standard_normal((samples, len(measured)))
            error = abs(error_pct(model, read))
            if resample_points:
                error = np.take_along_axis(error, rng.integers(0, len(measured), error.shape), 1)
            low, median, high = np.percentile(np.median(error, 1), [5, 50, 95])
            rows.append(dict(experiment=experiment, quantity=_stem(quantity), points=len(measured),
                             median_abs_error_pct=np.median(abs(error_pct(model, measured))), low_pct=low,
                             median_pct=median, high_pct=high))
    return pd.DataFrame(rows)


def pull_shift(shear_scale=(0.70, 0.85, 1.15, 1.30)):
    """How far the pull of the tested wheels moves when the kernel's shear stress is scaled.

    Taken over the points of the paper's three experiments with positive slip and positive nominal pull, as its
    robustness study does.

    Parameters
    ----------
    shear_scale : array_like, shape (n,)
        Factors on the shear stress, positive.

    Returns
    -------
    pandas.DataFrame
        One row a factor: shear_scale, median_shift_pct (of |DP(scale) / DP - 1|), points.
    """
    scale = np.atleast_1d(check("shear_scale", shear_scale, above=0))
    points = catalog.table("single_wheel.csv")
    conditions = single_wheel_conditions(points[points.experiment.isin(EXPERIMENTS.values())])
    pull = wheel_forces(*conditions, shear_scale=np.append(1.0, scale)[:, None]).drawbar_pull_n
    used = (conditions[3] > 0) & (pull[0] > 0)
    shift = 100 * abs(pull[1:, used] / pull[0, used] - 1)
    return pd.DataFrame(dict(shear_scale=scale, median_shift_pct=np.median(shift, 1), points=int(used.sum())))


def load_transfer(design, scenario, height_to_wheelbase=0.4, slope_deg=25.0, slip=0.6, model=Model()):
    """Change of a rover's total pull when a slope shifts weight to the lower axle at fixed total mass.

    Axles are evenly spaced. On two axles the loads are w (1 +- 2 (h/L) tan(slope)) with w the mean wheel load, on
    three w (1 +- 3 (h/L) tan(slope)) at the ends and w in the middle; all wheels turn at the same slip.

    Parameters
    ----------
    design : Design
    scenario : Scenario
        Gives the soil and the payload.
    height_to_wheelbase : float or ndarray
        h / L, zero or more.
    slope_deg : float or ndarray
        0 to below 90 degrees.
    slip : float or ndarray
        Slip at which the pull is taken.
    model : Model

    Returns
    -------
    float or ndarray
        In percent of the pull with equal loads; NaN where that is not positive or an axle lifts off.
    """
    ratio = check("height_to_wheelbase", height_to_wheelbase, 0)
    slope = np.radians(check("slope_deg", slope_deg, 0, below=90))
    six = np.equal(design.wheel_count, 6)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)     # designs outside the class are the caller's choice
        mass = evaluate(design, scenario, model).total_mass_kg
    load = mass * model.gravity_m_s2 * np.cos(slope) / design.wheel_count
    shift = np.where(six, 3.0, 2.0) * ratio * np.tan(slope)
    factors = [np.ones_like(shift), 1 + shift, np.where(shift < 1, 1 - shift, 1.0)]
    even, lower, upper = (wheel_forces(
        design.wheel, scenario.soil, load * f, slip, transition_c1=model.transition_c1,
        transition_c2=model.transition_c2, grouser_lift_cap=model.grouser_lift_cap,
        shear_scale=model.shear_scale).drawbar_pull_n for f in factors)
    ends = np.where(six, 1 / 3, 1 / 2)                   # share of the wheels on each end axle
    change = 100 * (ends * (lower + upper - 2 * even)) / even
    return np.where((even > 0) & (shift < 1), change, np.nan)[()]
