"""Trade-space studies on `evaluate`: sampling and sweeps."""
from __future__ import annotations

import numpy as np

from ._fields import check
from .design import DESIGN_SPACE, Design


def random_designs(count, seed=None):
    """Designs drawn uniformly from DESIGN_SPACE; grouser counts whole, 4 or 6 wheels with equal chance.

    Parameters
    ----------
    count : int
        How many, 1 or more.
    seed : int, optional
        Same seed, same designs.

    Returns
    -------
    Design
        Arrays of length `count`.

    Raises
    ------
    ValueError
        If `count` is not a whole number of 1 or more.
    """
    count = int(check("count", count, 1, whole=True, scalar=True))
    genes = np.random.default_rng(seed).random((count, len(DESIGN_SPACE)))
    return decode(genes)


def decode(genes):
    """Designs from genes in the unit cube, shape (n, 11): scaled, grouser count rounded, wheel count thresholded."""
    values = {}
    for gene, (name, variable) in zip(np.asarray(genes, float).T, DESIGN_SPACE.items()):
        if variable.kind == "choice":
            values[name] = np.where(gene < 0.5, variable.low, variable.high)
        else:
            values[name] = variable.low + gene * (variable.high - variable.low)
            if variable.kind == "whole":
                values[name] = np.clip(np.rint(values[name]), variable.low, variable.high)
    return Design(**values)
