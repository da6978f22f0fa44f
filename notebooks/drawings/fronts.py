"""Figures of Pareto fronts (notebook 07)."""
from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np

from rdk.figures import BLACK, BLUE, COLOURS, DASHES, GREEN, GREY, MARKERS, ORANGE, panels, curves


SLOPE_BANDS = ((-np.inf, 20, "o", 18), (20, 30, "s", 30), (30, 34, "^", 46), (34, np.inf, "D", 62))
"""How slope capability reads without colour: from, to (deg), marker, size."""


def dominated_designs(mass_kg, slope_deg, dominated, chosen):
    """Designs in two objectives: light is good, steep is good; those that no other beats lie on the front.

    Parameters
    ----------
    mass_kg, slope_deg : ndarray
    dominated : ndarray of bool
    chosen : int
        The design whose corner is shaded: what lies there dominates it.

    Returns
    -------
    matplotlib.figure.Figure
    """
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
    """A front of mass and obstacle capability, and the points that the best weighted sum picks from it.

    Parameters
    ----------
    mass_kg, height_m, wheel_count : ndarray, shape (n,)
        The front.
    weight : ndarray, shape (m,)
        Weight of the obstacle capability in the sum, 0 to 1, rising.
    pick : ndarray of int, shape (m,)
        Which point each weight picks.

    Returns
    -------
    matplotlib.figure.Figure
        Left, the front and the picked points, the larger the more weights pick them; right, the picked obstacle
        capability against the weight.
    """
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
    """Non-dominated ranks of a small population, and the crowding distances of its first rank.

    Parameters
    ----------
    mass_kg, slope_deg : ndarray
    rank : ndarray of int
        1 is the best.
    crowding : ndarray
        Of the points of rank 1, in the order of the population; infinite at the ends.
    chosen : int
        The point of rank 1, counted within it, whose box is drawn.

    Returns
    -------
    matplotlib.figure.Figure
    """
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


def variation_operators(content):
    """Where the children of a crossover or a mutation fall, against the operator's formula.

    Parameters
    ----------
    content : dict of str to (ndarray, sequence of float, ndarray, ndarray)
        By title: genes of the children; genes of the parents; where the density is given, and the density.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, axes = panels(1, len(content), figsize=(4.7 * len(content), 3.2), squeeze=False)
    for ax, (title, (children, parents, x, density)) in zip(axes[0], content.items()):
        ax.hist(children, bins=80, density=True, color="#9ccbe6", label="children")
        ax.plot(x, density, color=BLACK, lw=1.2, label="formula")
        for i, parent in enumerate(parents):
            ax.axvline(parent, color=ORANGE, linestyle="--", lw=1.2, label=None if i else "parent")
        ax.set(xlabel="gene (1 = whole range of the variable)", ylabel="density (per unit of gene)")
        ax.set_title(title, fontsize=10)
        ax.legend(fontsize=9)
    return figure


def front_history(snapshots):
    """The front after some generations: slope capability against mass, one panel a generation.

    Parameters
    ----------
    snapshots : dict of str to (ndarray, ndarray)
        Mass in kg and slope capability in degrees, by title.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, axes = panels(1, len(snapshots), figsize=(9.6, 2.9), sharex=True, sharey=True)
    for k, (ax, (title, (mass_kg, slope_deg))) in enumerate(zip(axes, snapshots.items())):
        ax.plot(mass_kg, slope_deg, MARKERS[k], color=COLOURS[k], markersize=4)
        ax.set(xlabel="total mass (kg)")
        ax.set_title(f"{title}: {len(mass_kg)} on the front", fontsize=10)
    axes[0].set_ylabel("slope capability (deg)")
    return figure


def pareto_fronts(fronts, published=None):
    """Range against mass of each front; colour, marker and size tell the slope capability.

    Parameters
    ----------
    fronts : dict of str to rdk.tradespace.Front
        By title.
    published : dict of str to (float, float, float, float), optional
        By title: the paper's lowest and highest mass in kg and range in km, drawn as a dotted box.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, axes = panels(2, 2, figsize=(9.4, 6.6))
    drawn = None
    for ax, (title, front) in zip(axes.flat, fronts.items()):
        p = front.performance
        for low, high, marker, size in SLOPE_BANDS:
            band = (p.slope_capability_deg >= low) & (p.slope_capability_deg < high)
            drawn = ax.scatter(p.total_mass_kg[band], p.range_km[band], size, p.slope_capability_deg[band],
                               marker=marker, cmap="cividis", vmin=12, vmax=35, edgecolors=BLACK,
                               linewidths=0.5)
        if published and title in published:
            m0, m1, r0, r1 = published[title]
            ax.add_patch(plt.Rectangle((m0, r0), m1 - m0, r1 - r0, fill=False, ls=":", edgecolor=BLACK))
        ax.set(xlabel="total mass (kg)", ylabel="range (km)", xlim=(0, None), ylim=(0, 1.08 * p.range_km.max()))
        ax.set_title(title, fontsize=10)
    words = ("below 20°", "20° to 30°", "30° to 34°", "above 34°")
    style = dict(color=BLACK, markerfacecolor="white", ls="")
    handles = [plt.Line2D([], [], marker=marker, markersize=size ** 0.5, label=label, **style)
               for (_, _, marker, size), label in zip(SLOPE_BANDS, words)]
    if published:
        handles.append(plt.Line2D([], [], color=BLACK, linestyle=":", label="span in the paper"))
    figure.legend(handles=handles, loc="outside lower center", ncols=5, fontsize=9, frameon=False)
    figure.colorbar(drawn, ax=axes, label="slope capability (deg)", shrink=0.7)
    return figure


def along_a_front(front):
    """What changes along a front from light to heavy: slope capability, range, and the chassis in the mass.

    Parameters
    ----------
    front : rdk.tradespace.Front

    Returns
    -------
    matplotlib.figure.Figure
    """
    p, m = front.performance, front.performance.total_mass_kg
    figure, axes = panels(1, 3, figsize=(9.6, 3.1))
    columns = {"slope capability (deg)": p.slope_capability_deg, "range (km)": p.range_km,
               "chassis mass (kg)": front.designs.chassis_mass_kg}
    for k, (ax, (label, y)) in enumerate(zip(axes, columns.items())):
        ax.plot(m, y, MARKERS[k], color=COLOURS[k], markersize=4)
        ax.set(xlabel="total mass (kg)", ylabel=label)
    return figure


def generation_budget(histories, published):
    """Normalised hypervolume against generations, one panel a scenario, one line a seed.

    Parameters
    ----------
    histories : dict of str to dict of str to ndarray
        By title and by label of the seed.
    published : dict of str to dict of int to float
        The paper's means by title and generation.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, axes = panels(2, 2, figsize=(9.0, 5.6), sharex=True)
    for ax, (title, lines) in zip(axes.flat, histories.items()):
        curves({label: np.arange(1, len(y) + 1) for label, y in lines.items()}, lines, "generation",
               "normalised hypervolume", legend=False, axes=ax)
        ax.plot(*zip(*published[title].items()), "D", color=BLACK, markerfacecolor="white",
                label="paper, mean of two")
        top = max(max(y) for y in (*lines.values(), list(published[title].values())))
        ax.set(ylim=(0.9 * top, 1.01 * top))
        ax.set_title(title, fontsize=10)
    for ax in axes[0]:
        ax.set_xlabel("")
    axes[0, 0].legend(fontsize=9, loc="lower right")
    return figure


def decoded_genes(gene, slope_deg, mass_kg):
    """What two genes do once decoded: slope capability by the grouser gene, mass by the wheel gene.

    Parameters
    ----------
    gene : ndarray
        0 to 1.
    slope_deg, mass_kg : ndarray
        With the grouser gene and with the wheel gene at `gene`.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, axes = panels(1, 2, figsize=(9.0, 3.2))
    for ax, y, x_label, y_label in zip(axes, (slope_deg, mass_kg), ("grouser gene", "wheel gene"),
                                       ("slope capability (deg)", "total mass (kg)")):
        ax.plot(gene, y, ".", color=BLUE, markersize=2)
        ax.set(xlabel=f"{x_label} (1 = whole range)", ylabel=y_label)
    for words, at, below in ("4 wheels", (0.25, mass_kg[0]), 6), ("6 wheels", (0.75, mass_kg[-1]), -14):
        axes[1].annotate(words, at, (0, below), textcoords="offset points", ha="center", fontsize=9)
    return figure


def searches(evaluations, histories):
    """Normalised hypervolume against evaluations, one line a method: mean over the seeds, and their span.

    Parameters
    ----------
    evaluations : ndarray, shape (n,)
    histories : dict of str to ndarray, shape (seeds, n)

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, ax = panels()
    for k, (label, y) in enumerate(histories.items()):
        ax.fill_between(evaluations, y.min(0), y.max(0), color=COLOURS[k], alpha=0.15, lw=0)
        ax.plot(evaluations, y.mean(0), color=COLOURS[k], linestyle=DASHES[k], marker=MARKERS[k],
                markevery=max(len(evaluations) // 6, 1), markersize=5, label=label)
    ax.set(xlabel="evaluations (designs)", ylabel="normalised hypervolume", xscale="log")
    ax.legend(fontsize=9)
    return figure


def seed_scatter(content, published):
    """One number of each front, seed by seed, beside the paper's.

    Parameters
    ----------
    content : dict of str to dict of str to ndarray
        By axis label and by title of the front: one value a seed. "(Wh)" makes the axis logarithmic.
    published : dict of str to dict of str to float
        The paper's value, where it gives one.

    Returns
    -------
    matplotlib.figure.Figure
    """
    titles = list(next(iter(content.values())))
    figure, axes = panels(1, len(content), figsize=(9.6, 2.8), sharey=True, squeeze=False)
    for k, (ax, (label, rows)) in enumerate(zip(axes[0], content.items())):
        for y, title in enumerate(titles):
            ax.plot(rows[title], np.full(len(rows[title]), y), "o", color=BLUE, markerfacecolor="none",
                    markersize=7)
            if title in published.get(label, {}):
                ax.plot(published[label][title], y, "X", color=ORANGE, markersize=10)
        ax.set(xlabel=label, xscale="log" if "(Wh)" in label else "linear", ylim=(len(titles) - 0.5, -0.5))
    axes[0, 0].set_yticks(range(len(titles)), titles)
    handles = [plt.Line2D([], [], marker="o", color=BLUE, markerfacecolor="none", ls="", label="one seed"),
               plt.Line2D([], [], marker="X", color=ORANGE, ls="", label="paper")]
    figure.legend(handles=handles, loc="outside upper right", ncols=2, fontsize=9, frameon=False)
    return figure


def hub_speed_plateau(speed_rad_s, range_km, front_range_km, limit_km):
    """Range of one design against the hub's no-load speed, and the best range of fronts searched anew.

    Parameters
    ----------
    speed_rad_s, range_km : ndarray
    front_range_km : dict of float to float
        Longest range of a front by hub speed.
    limit_km : float
        Traverse limit of the study.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, ax = panels()
    ax.plot(speed_rad_s, range_km, color=BLUE, label="the longest-range design, hub replaced")
    ax.plot(list(front_range_km), list(front_range_km.values()), "s", color=ORANGE, markersize=8,
            label="longest range of a new front")
    ax.axhline(limit_km, color=GREY, linestyle=":", label="traverse limit of the study")
    ax.axvline(5, color=BLACK, linestyle="--", lw=1, label="default hub, 5 rad/s")
    ax.set(xlabel="no-load speed of the hub (rad/s)", ylabel="range (km)", xlim=(0, None),
           ylim=(0, 1.08 * limit_km))
    ax.legend(fontsize=9, loc="lower right")
    return figure
