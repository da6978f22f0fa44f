"""Figures of Pareto fronts (notebook 07)."""
from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np

from rdk.figures import BLUE, COLOURS, DASHES, GREEN, GREY, MARKERS, ORANGE, panels


def dominated_designs(mass_kg, slope_deg, dominated, chosen):
    """Light is good, steep is good: which designs no other beats, and the corner of what beats the `chosen` one."""
    figure, ax = panels()
    front = np.flatnonzero(~dominated)[np.argsort(mass_kg[~dominated])]
    ax.plot(mass_kg[dominated], slope_deg[dominated], "o", color=GREY, markerfacecolor="white", markersize=5,
            label="dominated")
    ax.plot(mass_kg[front], slope_deg[front], "s", color=BLUE, markersize=7, label="not dominated: the front")
    ax.step(mass_kg[front], slope_deg[front], where="post", color=BLUE, lw=1)
    left, top = min(mass_kg) - 2, max(slope_deg) + 1.5
    ax.fill_between([left, mass_kg[chosen]], slope_deg[chosen], top, color=ORANGE, alpha=0.15, hatch="//",
                    edgecolor=ORANGE, lw=0)
    ax.plot(mass_kg[chosen], slope_deg[chosen], "D", color=ORANGE, markersize=9,
            label="one design, and what beats it")
    ax.set(xlim=(left, None), ylim=(None, top), xlabel="total mass (kg)", ylabel="slope capability (deg)")
    ax.legend(fontsize=9, loc="lower right")
    return figure


def weighted_sums(mass_kg, height_m, wheel_count, weight, pick):
    """A front of mass and obstacle capability, and the points that weights `pick`: the more, the larger the square."""
    figure, (ax, right) = panels(1, 2, figsize=(9.4, 3.8), sharey=True)
    picked, counts = np.unique(pick, return_counts=True)
    for wheels, marker, colour in (4, "o", BLUE), (6, "^", GREEN):
        here = wheel_count == wheels
        ax.plot(mass_kg[here], height_m[here], marker, color=colour, markersize=4, label=f"{wheels} wheels")
    ax.scatter(mass_kg[picked], height_m[picked], 60 + 400 * counts / counts.sum(), marker="s", linewidths=1.5,
               facecolors="none", edgecolors=ORANGE, label="picked by a weighted sum")
    ax.plot(mass_kg[picked], height_m[picked], "--", color=ORANGE, lw=1)
    ax.set(xlabel="total mass (kg)", ylabel="obstacle capability (m)")
    ax.legend(fontsize=9, loc="lower right")
    right.plot(weight, height_m[pick], color=ORANGE, drawstyle="steps-mid")
    right.set(xlabel="weight of the obstacle capability (1)")
    return figure


def ranks_and_crowding(mass_kg, slope_deg, rank, crowding, chosen):
    """Ranks of a small population (1 is best), and the crowding distances of rank 1; `chosen` of it gets its box."""
    figure, (ax, right) = panels(1, 2, figsize=(9.4, 3.8))
    for r in np.unique(rank):
        here = np.flatnonzero(rank == r)[np.argsort(mass_kg[rank == r])]
        k = (r - 1) % len(COLOURS)
        ax.plot(mass_kg[here], slope_deg[here], color=COLOURS[k], marker=MARKERS[(r - 1) % len(MARKERS)],
                linestyle=DASHES[k], lw=1, label=f"rank {r}")
    first = np.flatnonzero(rank == 1)
    order = np.argsort(mass_kg[first])
    x, y = mass_kg[first][order], slope_deg[first][order]
    right.plot(x, y, "o", color=BLUE)
    at = int(np.flatnonzero(order == chosen)[0])
    (x0, x1), (y0, y1) = x[[at - 1, at + 1]], y[[at - 1, at + 1]]
    right.add_patch(plt.Rectangle((x0, y0), x1 - x0, y1 - y0, fill=False, edgecolor=ORANGE, ls="--", lw=1.5))
    for i, value in enumerate(crowding[order]):
        offset, side = ((-6, 5), "right") if i % 2 == 0 else ((6, -13), "left")      # neighbours must not meet
        right.annotate("∞" if np.isinf(value) else f"{value:.2f}", (x[i], y[i]), offset, ha=side,
                       textcoords="offset points", fontsize=9)
    right.margins(0.22)
    for panel, title in (ax, "ranks"), (right, "crowding distances of rank 1"):
        panel.set(xlabel="total mass (kg)", ylabel="slope capability (deg)")
        panel.set_title(title, fontsize=10)
    ax.legend(fontsize=9)
    return figure
