"""Published masses against intervals: what is known of a rover is fixed, the rest drawn from what others have.

Hardly any rover has more than a few published numbers, so a single predicted mass rests on assumptions. Here each
unknown size is drawn from a power law of mass through the other rovers of `data/`, with the scatter that they have
about it: the prediction interval of a linear regression of logarithms. The rover's own mass enters there, and in the
rule for its torque: the check asks whether the parts of such a rover add up to its mass, not whether the mass could
have been foretold.

Limits: most sizes of the rovers in `rovers.csv` are assumptions of the paper's authors, so that the scatter is partly
theirs; sizes are drawn independently; rovers that have flown carry no growth allowance, the mass model adds one.
"""
from __future__ import annotations

import math

import numpy as np
import pandas as pd

from rdk import catalog
from rdk._fields import check, generator, whole
from rdk.design import Model
from rdk.mass import mass_breakdown
from rdk.mission import MASS_COEFFICIENTS
from rdk.uncertainty import DRAWS, inputs_at, uncertain_names
from validation import anchor_torque_nm

GROWING = ("wheel_radius_m", "wheel_width_m", "chassis_mass_kg", "solar_area_m2", "battery_capacity_wh",
           "avionics_power_w", "payload_mass_kg")
"""Sizes that grow with a rover: drawn from a power law of its mass."""
PLAIN = ("wheel_count", "grouser_height_m", "grouser_count")
"""Drawn as they are from the other rovers, the two of the grousers together."""
WHEELS = {"rigid_4wheel": 4.0, "rocker_bogie_6wheel": 6.0, "six_wheel": 6.0, "unknown": np.nan}
"""Wheel count of each architecture that the mass model covers."""


def published_facts() -> pd.DataFrame:
    """What `rovers.csv` and `rovers_more.csv` say of each rover, one row a fact.

    Of a rover with two rows in `rovers.csv` that of the mass check counts.

    Returns
    -------
    pandas.DataFrame
        rover, in_class, field, value, unit (NaN from `rovers.csv`, where the field's name has it), status ("published",
        "derived" or "imputed"), table, and mass_kg, the published mass of the rover as that table knows it.
    """
    rovers = catalog.table("rovers.csv").drop_duplicates("rover").rename(columns={"published_mass_kg": "total_mass_kg"})
    fields = ["total_mass_kg", *GROWING, *PLAIN, "wheelbase_m"]
    paper = rovers.melt(["rover", "in_class"], fields, "field").dropna()
    said = {(row.rover, name.replace("published_mass", "total_mass")): status for row in rovers.itertuples()
            for status in ("published", "derived", "imputed")
            for name in str(getattr(row, status + "_fields")).split(";")}
    paper["status"] = [said[key] for key in zip(paper.rover, paper.field)]
    more = catalog.table("rovers_more.csv")
    count = more.drop_duplicates("rover").assign(field="wheel_count", status="published", unit="1",
                                                 value=lambda t: t.architecture.map(WHEELS)).dropna(subset="value")
    more = pd.concat([count, more[more.field != "wheel_count"]])[[*paper.columns[:4], "unit", "status"]]
    facts = pd.concat([paper.assign(table="rovers.csv"), more.assign(table="rovers_more.csv")], ignore_index=True)
    mass = facts[facts.field == "total_mass_kg"].set_index(["rover", "table"]).value
    either = mass.groupby("rover").last()
    return facts.assign(mass_kg=[mass.get((rover, table), either.get(rover)) for rover, table in
                                 zip(facts.rover, facts.table)])


def mass_intervals(*, draws: int = DRAWS, seed: int = 0, level: float = 0.9, fixed=("published", "derived"),
                   model: Model = Model()) -> pd.DataFrame:
    """Intervals of the mass of every rover with a published one, from what is known of it.

    Coefficients of the mass model are drawn from `uncertainties.csv`. A rover's own values of another status than
    `fixed` count neither for it nor, as donor of scatter, for itself.

    Parameters
    ----------
    draws, seed : int
    level : float
        Probability that an interval should hold, 0 to 1.
    fixed : sequence of str
        Status of what counts as known: with "imputed" too, the rovers of the paper are as the paper has them.
    model : Model

    Returns
    -------
    pandas.DataFrame
        One row a rover: rover, in_class, table, published_mass_kg, known (how many sizes), low_kg, median_kg, high_kg,
        inside, share_below (of the draws below the published mass).
    """
    from scipy.stats import qmc, t
    draws = whole("draws", draws, 1)
    level = check("level", level, above=0, below=1, scalar=True)
    facts = published_facts()
    latest = facts.drop_duplicates(["rover", "field"], keep="last")                      # the later table knows better
    more = catalog.table("rovers_more.csv")
    tracked = more.rover[~more.architecture.isin(WHEELS)]
    listed = latest[(latest.field == "total_mass_kg") & ~latest.rover.isin(tracked)].sort_values("value", kind="stable")
    rovers, mass = listed.rover.to_numpy(), listed.value.to_numpy()
    table = [row for row in catalog.rows("uncertainties.csv") if row["name"] in MASS_COEFFICIENTS]
    points = qmc.Sobol(len(GROWING) + 2 + len(uncertain_names(table)), rng=generator(seed)).random_base2(
        math.ceil(math.log2(draws)))[:draws]
    points = np.clip(points, 2.0**-32, 1 - 2.0**-32)     # a scrambled sequence can hold 0
    sizes, known = {}, np.zeros(len(rovers), int)
    for name, u in zip((*GROWING, *PLAIN), points.T[[*range(len(GROWING) + 2), len(GROWING) + 1]]):
        donors = latest[(latest.field == name) & latest.mass_kg.notna()]
        kept = rovers[:, None] != donors.rover.to_numpy()                                # no rover is its own donor
        if name in GROWING:
            centre, spread, freedom = _power_law(donors.mass_kg.to_numpy(), donors.value.to_numpy(), kept, mass)
            drawn = np.exp(centre + spread * t.ppf(u[:, None], freedom))
        else:
            order = np.argsort(~kept, axis=1, kind="stable")                             # the kept ones first
            drawn = donors.value.to_numpy()[order[np.arange(len(rovers)), (u[:, None] * kept.sum(1)).astype(int)]]
        stated = donors[donors.status.isin(fixed)].set_index("rover").reindex(rovers)
        own = stated.value.where(stated.mass_kg == mass).to_numpy()                      # not of an earlier design
        sizes[name] = np.where(np.isnan(own), drawn, own)
        known += ~np.isnan(own)
    coefficients = inputs_at(points[:, len(GROWING) + 2:], catalog.scenario("mare_micro"), model=model, table=table)
    torque = anchor_torque_nm(mass, sizes["wheel_count"], sizes["wheel_radius_m"])       # the paper's rule
    changed = model.replace(**{name: value[:, None] for name, value in coefficients.items()})
    total = mass_breakdown(**sizes, peak_wheel_torque_nm=torque, coefficients=changed).total_kg
    low, median, high = np.quantile(total, [(1 - level) / 2, 0.5, (1 + level) / 2], axis=0)
    return pd.DataFrame(dict(
        rover=rovers, in_class=(mass >= 5) & (mass <= 50),
        table=facts.groupby("rover").table.first()[rovers].to_numpy(),
        published_mass_kg=mass, known=known, low_kg=low, median_kg=median, high_kg=high,
        inside=(mass >= low) & (mass <= high), share_below=(total < mass).mean(0)))


def _power_law(mass, size, kept, at):
    """Regression of log size on log mass over the kept donors, (rovers, donors): centre, spread, degrees of freedom."""
    x, y, n = np.log(mass), np.log(size), kept.sum(1)
    mean_x, mean_y = kept @ x / n, kept @ y / n
    xx, xy, yy = (kept @ (a * b) - n * ma * mb for a, b, ma, mb in (
        (x, x, mean_x, mean_x), (x, y, mean_x, mean_y), (y, y, mean_y, mean_y)))
    slope, away = xy / xx, np.log(at) - mean_x
    variance = (yy - slope * xy) / (n - 2)
    return mean_y + slope * away, np.sqrt(variance * (1 + 1 / n + away**2 / xx)), n - 2
