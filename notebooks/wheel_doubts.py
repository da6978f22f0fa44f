"""Doubts about measured wheels: how well their points were read, and whether intervals hold them."""
from __future__ import annotations

import numpy as np
import pandas as pd

from rdk import catalog
from rdk._fields import check, generator, unknown, whole
from rdk.terramechanics import wheel_forces
from rdk.uncertainty import DRAWS, uncertain_inputs
from validation import QUANTITIES, error_pct, measured, single_wheel, single_wheel_conditions


def bootstrap_medians(reading_error_n: float = 0.5, reading_error_m: float = 1e-3, reading_error_nm: float = 0.1, *,
                      resample_points: bool = False, samples: int = 2000, seed: int | None = 0,
                      **options) -> pd.DataFrame:
    """What an error in reading the points off printed figures does to the medians of |error|.

    Every measured value is read again `samples` times with a normal error of the standard deviations given, zero or
    more; the model stays as it is. That is a parametric bootstrap. With `resample_points`, each sample also draws what
    was measured: curves (a wheel each) of an experiment with replacement, and points of a drawn curve with replacement,
    since points of one curve share its wheel and its soil. An experiment of one or two curves shows little of what
    others would have given.

    One row an experiment and quantity: points, median_abs_error_pct as printed, and low_pct, median_pct, high_pct: the
    5, 50 and 95 % points of that median over the samples.
    """
    sigma = dict(zip(QUANTITIES, (check("reading_error_n", reading_error_n, 0, scalar=True),
                                  1000 * check("reading_error_m", reading_error_m, 0, scalar=True),
                                  check("reading_error_nm", reading_error_nm, 0, scalar=True))))
    samples = whole("samples", samples, 1)
    rng, rows = generator(seed), []
    for experiment, quantity, known in measured(single_wheel(**options)):
        read, model = (known[name].to_numpy() for name in (quantity, "model_" + quantity))
        error = abs(error_pct(model, read + sigma[quantity] * rng.standard_normal((samples, len(read)))))
        if resample_points:
            error = np.take_along_axis(error, drawn(known.wheel.to_numpy(), samples, rng), 1)
        low, median, high = np.nanpercentile(np.nanmedian(error, 1), [5, 50, 95])
        rows.append(dict(experiment=experiment, quantity=quantity.rpartition("_")[0], points=len(read),
                         median_abs_error_pct=np.median(abs(error_pct(model, read))), low_pct=low,
                         median_pct=median, high_pct=high))
    return pd.DataFrame(rows)


def drawn(curve, samples, rng):
    """Numbers of points, (samples, points): curves drawn with replacement, then points of the curve drawn."""
    curves = [np.flatnonzero(curve == name) for name in dict.fromkeys(curve)]
    size = max(map(len, curves))
    picked = rng.integers(len(curves), size=(samples, len(curves)))
    members, length = np.array([np.resize(one, size) for one in curves]), np.array([len(one) for one in curves])
    within = (rng.random((samples, len(curves), size)) * length[picked][..., None]).astype(int)
    return members[picked[..., None], within].reshape(samples, -1)


def interval_coverage(*, draws: int = DRAWS, seed: int = 0, level: float = 0.9, spread: float | None = None,
                      experiments: tuple = ()) -> pd.DataFrame:
    """Whether measured pulls lie in the intervals that the shear scale alone gives driven single wheels.

    The soil of a laboratory is given, so the shear scale carries the error of the wheel model; what is not known of the
    soil of a lunar site comes on top of it. Its spread was set on these five experiments, each with the same weight: to
    judge it, set it without one of them and ask for that one.

    `spread` is the standard deviation of the logarithm of the shear scale, by default that of `data/uncertainties.csv`;
    `experiments` are tests of `single_wheel.csv` and `single_wheel_more.csv`, by default all.

    One row a point of positive slip: experiment, wheel, slip, load_n, measured_n, nominal_n, low_n, high_n, inside, and
    shear_scale, the factor with which the kernel meets the point.
    """
    level = check("level", level, above=0, below=1, scalar=True)
    points = pd.concat([catalog.table("single_wheel.csv").merge(catalog.table("soils.csv"), on="soil"),
                        catalog.table("single_wheel_more.csv").dropna(subset="drawbar_pull_n")]).query("slip > 0")
    points = points.reset_index(drop=True)
    for name in experiments:
        if name not in set(points.experiment):
            raise unknown("experiments: no single-wheel test", name, list(points.experiment.unique()))
    if experiments:
        points = points[points.experiment.isin(list(experiments))].reset_index(drop=True)
    conditions = single_wheel_conditions(points)
    table = [row for row in catalog.rows("uncertainties.csv") if row["name"] == "shear_scale"]
    if spread is not None:
        end = 1.6448536 * check("spread", spread, above=0, scalar=True)
        table = [table[0] | {"distribution": "lognormal", "low": np.exp(-end), "high": np.exp(end)}]
    (scale,) = uncertain_inputs(catalog.scenario("mare_micro"), draws=draws, seed=seed, table=table).values()
    low, high = np.quantile(wheel_forces(*conditions, shear_scale=scale[:, None]).drawbar_pull_n,
                            [(1 - level) / 2, (1 + level) / 2], axis=0)
    tried = np.geomspace(0.2, 5, 200)                    # pull rises with the scale
    pulls, pull_n = wheel_forces(*conditions, shear_scale=tried[:, None]).drawbar_pull_n, points.drawbar_pull_n
    return pd.DataFrame({
        "experiment": points.experiment, "wheel": points.wheel, "slip": points.slip, "load_n": points.vertical_load_n,
        "measured_n": pull_n, "nominal_n": wheel_forces(*conditions).drawbar_pull_n, "low_n": low, "high_n": high,
        "inside": (pull_n >= low) & (pull_n <= high),
        "shear_scale": [np.exp(np.interp(m, pull, np.log(tried))) for m, pull in zip(pull_n, pulls.T)]})
