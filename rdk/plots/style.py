"""Palette, dashes, markers and axes that all figures share."""
from __future__ import annotations

import matplotlib.pyplot as plt

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


def _lines(axes, x, series, x_label, y_label, legend=True):
    """One line for each entry of `series`, told apart by colour and dashes; x may be a dict, too."""
    for i, (label, y) in enumerate(series.items()):
        axes.plot(x[label] if isinstance(x, dict) else x, y, color=COLOURS[i % 4], linestyle=DASHES[i % 4],
                  linewidth=1.8, label=label)
    axes.set(xlabel=x_label, ylabel=y_label)
    if legend and len(series) > 1:
        axes.legend(frameon=False, fontsize=9)
