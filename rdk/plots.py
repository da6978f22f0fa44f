"""One function per figure of the notebooks: numbers in, a matplotlib Figure out.

Every figure reads without colour (dashes and markers differ too) and names its units. Each function takes what the
evaluator returned and computes nothing that a reader would want to check.
"""
from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np

BLUE, ORANGE, GREEN, BLACK, GREY = "#0072B2", "#D55E00", "#009E73", "#000000", "#767676"
COLOURS = (BLUE, ORANGE, GREEN, BLACK)
DASHES = ("-", "--", "-.", ":")
MARKERS = ("o", "s", "^", "D", "v", "P", "X")

STYLE = {"figure.figsize": (6.4, 3.8), "figure.dpi": 100, "font.size": 10, "axes.grid": True, "grid.alpha": 0.3,
         "axes.spines.top": False, "axes.spines.right": False, "legend.frameon": False, "lines.linewidth": 1.8}


def _axes(rows=1, columns=1, **options):
    """A new pyplot figure in the collection's style, and its axes."""
    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(rows, columns, layout="constrained", **options)
    return figure, axes
