"""Whether measured pulls lie in the intervals that the shear scale alone gives driven single wheels.

The soil of a laboratory is given, so the shear scale carries the error of the wheel model; what is not known of the
soil of a lunar site comes on top of it. Its spread was set on these five experiments, each with the same weight: to
judge it, set it without one of them and ask for that one.
"""
from __future__ import annotations

import numpy as np
import pandas as pd

from rdk import catalog
from rdk._fields import check, unknown
from rdk.terramechanics import wheel_forces
from rdk.uncertainty import DRAWS, uncertain_inputs
from rdk.validation import single_wheel_conditions


def interval_coverage(*, draws: int = DRAWS, seed: int = 0, level: float = 0.9, spread: float | None = None,
                      experiments: tuple = ()) -> pd.DataFrame:
    """Measured pulls beside their intervals, one row a point of positive slip.

    `spread` is the standard deviation of the logarithm of the shear scale, by default that of `data/uncertainties.csv`;
    `experiments` are tests of `single_wheel.csv` and `single_wheel_more.csv`, by default all.

    Columns: experiment, wheel, slip, load_n, measured_n, nominal_n, low_n, high_n, inside, and shear_scale, the factor
    with which the kernel meets the point.
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
    pulls, measured = wheel_forces(*conditions, shear_scale=tried[:, None]).drawbar_pull_n, points.drawbar_pull_n
    return pd.DataFrame({
        "experiment": points.experiment, "wheel": points.wheel, "slip": points.slip, "load_n": points.vertical_load_n,
        "measured_n": measured, "nominal_n": wheel_forces(*conditions).drawbar_pull_n, "low_n": low, "high_n": high,
        "inside": (measured >= low) & (measured <= high),
        "shear_scale": [np.exp(np.interp(m, pull, np.log(tried))) for m, pull in zip(measured, pulls.T)]})
