"""What drives a result: Sobol indices, and scenarios spread over the paper's families (notebook 09)."""
from __future__ import annotations

import numpy as np
import pandas as pd

from rdk import catalog
from rdk._fields import generator, unknown, whole
from rdk.design import DESIGN_SPACE, Design, Model, Scenario
from rdk.mission import evaluate
from rdk.sampling import METRICS, decode, replaced, single
from rdk.uncertainty import inputs_at, uncertain_names


def family(name: str, count: int, seed: int = 0) -> list[Scenario]:
    """Scenarios spread over a canonical scenario's family: latitude, duration and slope vary together.

    A Latin hypercube over the ranges of the paper's Table 1; everything else stays as catalogued, the panel
    is tilted anew for each latitude. Same seed, same scenarios.
    """
    from scipy.stats import qmc
    scenario = catalog.scenario(name)
    row = next(row for row in catalog.rows("scenarios.csv") if row["scenario"] == name)
    ranges = [row[f"family_{field}"] for field in ("latitude_deg", "duration_days", "slope_deg")]
    if not all(ranges):
        known = ", ".join(catalog.scenario_names("canonical"))
        raise ValueError(f"scenario {name!r} has no family; choose from {known}")
    count = whole("count", count, 1)
    low, high = np.array([text.split("..") for text in ranges], float).T
    points = qmc.scale(qmc.LatinHypercube(3, rng=generator(seed)).random(count), low, high)
    return [catalog.at_latitude(scenario, latitude).replace(name=f"{name} {i}", duration_earth_days=duration,
                                                            slope_deg=slope)
            for i, (latitude, duration, slope) in enumerate(points.tolist(), 1)]


def sobol(scenario: Scenario, *, metrics=("range_km", "total_mass_kg", "slope_capability_deg"),
          design: Design | None = None, count: int = 1024, seed: int = 0, bounds: dict | None = None,
          model: Model = Model()) -> pd.DataFrame:
    """Sobol indices of metrics: the share of their variance that each input explains, by scipy.stats.sobol_indices.

    Over the design variables, uniform in the design space or in narrower `bounds`; or, when a single design is given,
    over the uncertain inputs of `data/uncertainties.csv` for that design. All count * (inputs + 2) points, with count a
    power of 2, are evaluated in one call. Saltelli et al. (2010), doi:10.1016/j.cpc.2009.09.018.

    One row a metric and input: metric, input, first_order, total_order, and the 90 % bootstrap interval of the total
    order, total_low and total_high.
    """
    from scipy.stats import qmc, sobol_indices
    single(scenario=scenario, model=model, **{} if design is None else {"design": design})
    count = whole("count", count, 2)
    if count & (count - 1):
        raise ValueError(f"count must be a power of 2; got {count}")
    metrics = [metrics] if isinstance(metrics, str) else list(metrics)
    for name in metrics or [""]:
        if name not in METRICS:
            raise unknown("metrics: no Performance field", name, METRICS)
    names = list(DESIGN_SPACE) if design is None else uncertain_names()
    random = generator(seed)
    # two samples of the unit cube, and the first with one column after the other taken from the second
    A, B = np.hsplit(qmc.Sobol(2 * len(names), rng=random).random(count), 2)
    cube = np.concatenate([A, B, *(np.where(np.arange(len(names)) == i, B, A) for i in range(len(names)))])
    if design is None:
        result = evaluate(decode(cube, bounds), scenario, model=model)
    else:
        *changed, model = replaced(design, scenario, model, inputs_at(cube, scenario, model=model))
        result = evaluate(*changed, model=model)
    values = np.stack([np.asarray(getattr(result, name), float) for name in metrics])
    f_A, f_B, *f_AB = np.split(values, len(names) + 2, axis=1)
    f_AB = np.stack(f_AB)                                # (inputs, metrics, count)

    def indices(lanes):
        found = sobol_indices(n=count, func=dict(f_A=f_A[:, lanes], f_B=f_B[:, lanes], f_AB=f_AB[..., lanes]))
        return np.ravel(found.first_order), np.ravel(found.total_order)

    first, total = indices(np.arange(count))
    low, high = np.quantile([indices(random.integers(count, size=count))[1] for _ in range(100)], [0.05, 0.95], axis=0)
    return pd.DataFrame(dict(metric=np.repeat(metrics, len(names)), input=names * len(metrics), first_order=first,
                             total_order=total, total_low=low, total_high=high))
