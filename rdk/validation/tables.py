"""What the tables of the evidence share: signed errors, and constants with their source."""
from __future__ import annotations

import numpy as np

from .. import catalog


def error_pct(model, reference):
    """Signed error in percent of the size of the reference; NaN where the reference is zero or missing."""
    reference = np.asarray(reference, float)
    return 100 * (np.asarray(model) - reference) / np.where(reference == 0, np.nan, abs(reference))


def constant(name):
    """The value of a row of `constants.csv`, those of studies included."""
    values = {row["name"]: row["value"] for row in catalog.rows("constants.csv")}
    if name not in values:
        raise ValueError(f"no constant {name!r} in constants.csv")
    return float(values[name])
