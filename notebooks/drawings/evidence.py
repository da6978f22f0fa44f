"""Figures of masses, power and heat (notebooks 03 and 04)."""
from __future__ import annotations

import numpy as np

from rdk.figures import BLACK, BLUE, COLOURS, DASHES, GREEN, GREY, MARKERS, ORANGE, panels, curves


HATCHES = ("", "//", "", "..", "xx", "")


def mass_shares(shares):
    """What rovers are made of: one bar a rover, one segment a group of line items.

    Parameters
    ----------
    shares : pandas.DataFrame
        Percent of the total, a row a rover, a column a group (six at most).

    Returns
    -------
    matplotlib.figure.Figure
        Segments wide enough carry their percentage.
    """
    figure, ax = panels(figsize=(7.2, 3.9))
    fills = (BLUE, "white", GREY, "white", "white", BLACK)
    edges = (BLUE, ORANGE, GREY, GREEN, BLACK, BLACK)
    left = np.zeros(len(shares))
    for k, group in enumerate(shares.columns):
        width = shares[group].to_numpy()
        ax.barh(shares.index, width, left=left, height=0.7, color=fills[k], edgecolor=edges[k],
                hatch=HATCHES[k],
                label=group, lw=1)
        for y, (x, w) in enumerate(zip(left, width)):
            if w >= 5:
                ax.text(x + w / 2, y, f"{w:.0f}", ha="center", va="center", fontsize=8.5,
                        color="white" if fills[k] in (BLUE, BLACK) else BLACK,
                        bbox=dict(facecolor="white", lw=0, pad=1) if HATCHES[k] else None)
        left = left + width
    ax.set(xlabel="share of the predicted mass (%)", xlim=(0, 100.5))
    ax.invert_yaxis()
    ax.grid(axis="y", visible=False)
    figure.legend(loc="outside upper center", ncols=3, fontsize=8.5)
    return figure


def mass_errors(masses, median_pct):
    """Error of the predicted mass against the published mass, one point a rover.

    Parameters
    ----------
    masses : pandas.DataFrame
        As returned by `rdk.validation.published_masses`.
    median_pct : float
        Median of |error| over the class, drawn as a band.

    Returns
    -------
    matplotlib.figure.Figure
        Circles have four wheels, squares six; open marks are outside the class.
    """
    figure, ax = panels(figsize=(6.4, 4.0))
    ax.axhspan(-median_pct, median_pct, color=GREY, alpha=0.2, lw=0)
    ax.axhline(0, color=BLACK, lw=0.8)
    for row in masses.itertuples():
        four = row.wheel_count == 4
        colour = BLUE if four else ORANGE
        ax.plot(row.published_mass_kg, row.error_pct, MARKERS[0 if four else 1], color=colour, markersize=8,
                markerfacecolor=colour if row.in_class else "white")
        ax.annotate(row.rover, (row.published_mass_kg, row.error_pct), (7, 5), textcoords="offset points",
                    fontsize=9)
    for four in (True, False):
        ax.plot([], [], MARKERS[0 if four else 1], color=BLUE if four else ORANGE,
                label=f"{4 if four else 6} wheels")
    ax.plot([], [], "o", color=BLACK, markerfacecolor="white", label="outside the class")
    ax.set(xscale="log", xlim=(4, 220), xlabel="published mass (kg)",
           ylabel="error of the predicted mass (%)")
    ax.set_xticks([5, 10, 20, 50, 100, 200], ["5", "10", "20", "50", "100", "200"])
    ax.minorticks_off()
    ax.legend(fontsize=9)
    return figure


def fixed_overheads(masses, mass_kg, shares):
    """What does not shrink with a rover, in percent of its mass.

    Parameters
    ----------
    masses : pandas.DataFrame
        As returned by `rdk.validation.published_masses`.
    mass_kg : ndarray
        Abscissa of the curves.
    shares : dict
        Label -> percent at each mass, drawn as a curve.

    Returns
    -------
    matplotlib.figure.Figure
        Points lie on the curves, since the overhead is the same for all rovers with as many wheels.
    """
    figure, ax = panels()
    for (label, share), colour, dash in zip(shares.items(), COLOURS, DASHES):
        ax.plot(mass_kg, share, color=colour, linestyle=dash, label=label)
    for k, row in enumerate(masses.itertuples()):
        four = row.wheel_count == 4
        below = four and k % 2                           # neighbours' names must not meet
        ax.plot(row.published_mass_kg, row.fixed_overhead_pct, MARKERS[0 if four else 1],
                color=BLUE if four else ORANGE, markersize=7)
        ax.annotate(row.rover, (row.published_mass_kg, row.fixed_overhead_pct),
                    (-6, -11) if below else (6, 4),
                    textcoords="offset points", fontsize=9, ha="right" if below else "left")
    ax.set(xscale="log", xlabel="published mass (kg)", ylabel="fixed overhead (% of published mass)",
           ylim=(0, None))
    ax.set_xticks([5, 10, 20, 50, 100, 200], ["5", "10", "20", "50", "100", "200"])
    ax.minorticks_off()
    ax.legend(fontsize=9)
    return figure


def mass_sensitivity(changes, change_label):
    """How far one coefficient at a time moves the mass of each rover.

    Parameters
    ----------
    changes : pandas.DataFrame
        Change of the total in percent, a row a coefficient, a column a rover (four at most).
    change_label : str
        What was done to each coefficient.

    Returns
    -------
    matplotlib.figure.Figure
        Dots far to the right are coefficients worth knowing well.
    """
    figure, ax = panels(figsize=(7.2, 4.4))
    rows = np.arange(len(changes))
    for k, rover in enumerate(changes.columns):
        ax.plot(changes[rover], rows, MARKERS[k], color=COLOURS[k], label=rover, markersize=6.5,
                markerfacecolor="white" if k % 2 else COLOURS[k])
    ax.axvline(0, color=BLACK, lw=0.8)
    ax.set_yticks(rows, changes.index)
    ax.invert_yaxis()
    ax.set(xlabel=f"change of the total mass (%) for {change_label}")
    ax.legend(fontsize=9)
    return figure


def sun_paths(time_days, elevation_deg):
    """Elevation of the sun through one lunar day.

    Parameters
    ----------
    time_days : ndarray
        Earth days since local sunrise.
    elevation_deg : dict
        Label -> elevation in degrees at each time.

    Returns
    -------
    matplotlib.figure.Figure
        Below the line at 0 it is night.
    """
    figure, ax = panels()
    ax.axhspan(-90, 0, color=GREY, alpha=0.15, lw=0)
    ax.axhline(0, color=BLACK, lw=0.8)
    curves(time_days, elevation_deg, "Earth days since sunrise", "elevation of the sun (deg)", axes=ax)
    ax.set(ylim=(-90, 95), yticks=range(-90, 91, 30), xlim=(time_days[0], time_days[-1]))
    return figure


def panel_incidence(hour_angle_deg, incidence, no_horizon):
    """The factor cos(i) of tilted panels through a lunar day.

    Parameters
    ----------
    hour_angle_deg : ndarray
    incidence : dict
        Label -> cos(i) as the model has it.
    no_horizon : dict
        The same labels -> cos(i) that would be counted without a horizon, drawn thin.

    Returns
    -------
    matplotlib.figure.Figure
        A thin line that leaves a thick one is sunlight through the ground.
    """
    figure, ax = panels()
    for k, (label, values) in enumerate(incidence.items()):
        ax.plot(hour_angle_deg, no_horizon[label], color=COLOURS[k], linestyle=":", linewidth=1.2)
        ax.plot(hour_angle_deg, values, color=COLOURS[k], linestyle=DASHES[k % 3], label=label)
    for edge in (-90, 90):
        ax.axvline(edge, color=GREY, lw=0.8)
    ax.set(xlabel="hour angle (deg)", ylabel="incidence factor cos i", xticks=range(-180, 181, 45),
           ylim=(0, 1.05))
    ax.legend(fontsize=9)
    return figure


def day_of_power(time_days, power_w):
    """Power of a square metre of array through one lunar day, a panel a site.

    Parameters
    ----------
    time_days : ndarray
        Earth days since sunrise.
    power_w : dict
        Site -> dict of label -> power in W at each time.

    Returns
    -------
    matplotlib.figure.Figure
        Grey is night.
    """
    figure, axes = panels(2, 2, figsize=(7.4, 4.8), sharex=True, sharey=True)
    for ax, (site, series) in zip(axes.flat, power_w.items()):
        curves(time_days, series, "", "", legend=False, axes=ax)
        ax.axvspan(time_days[-1] / 2, time_days[-1], color=GREY, alpha=0.15, lw=0)
        ax.set_title(site, fontsize=10)
    axes[0, 0].set(xlim=(time_days[0], time_days[-1]), ylim=(0, None))
    axes[0, 0].legend(fontsize=9)
    figure.supxlabel("Earth days since sunrise", fontsize=10)
    figure.supylabel("power of 1 m2 of array (W)", fontsize=10)
    return figure


def power_flows(log):
    """Where the array's power goes and where the load's comes from, through a mission.

    Parameters
    ----------
    log : rdk.mission.TraverseLog

    Returns
    -------
    matplotlib.figure.Figure
        Above, what the array gives: used at once, into the battery, thrown away; below, what the load
        takes: from the array, from the battery, not served.
    """
    days, net = log.time_h / 24, log.solar_w - log.load_w
    direct = np.minimum(log.solar_w, log.load_w)
    given = {"used at once": direct, "into the battery": np.maximum(net, 0) - log.discarded_w,
             "thrown away": log.discarded_w}
    taken = {"from the array": direct, "from the battery": np.maximum(-net, 0) - log.unserved_w,
             "not served": log.unserved_w}
    figure, axes = panels(2, 1, figsize=(7.0, 5.2), sharex=True)
    for ax, flows, title in zip(axes, (given, taken), ("array (W)", "load (W)")):
        parts = ax.stackplot(days, *flows.values(), labels=flows.keys(),
                             colors=("#9ccbe6", "white", "#dddddd"),
                             step="pre", edgecolor=BLACK, linewidth=0.4)
        parts[1].set_hatch("//")
        parts[2].set_hatch("..")
        ax.set(ylabel=title, xlim=(0, days[-1]), ylim=(0, None))
        ax.legend(loc="upper right", fontsize=8.5, framealpha=1, frameon=True)
    axes[1].set_xlabel("Earth days since sunrise")
    return figure


def efficiency_stack(factors, others):
    """From sunlight to the bus: what is left of the sunlight after each factor.

    Parameters
    ----------
    factors : dict
        Label -> factor, in order.
    others : dict
        Label -> overall efficiency to compare with, drawn as lines.

    Returns
    -------
    matplotlib.figure.Figure
        Each bar is the product of the factors so far.
    """
    figure, ax = panels()
    left = np.cumprod(list(factors.values()))
    ax.bar(range(len(left)), left, color="#9ccbe6", edgecolor=BLUE, width=0.6)
    for k, (value, factor) in enumerate(zip(left, factors.values())):
        ax.text(k, 0.1, f"x {factor:.2f}\n= {value:.3f}", ha="center", va="center", fontsize=9)
    for (label, value), colour, dash in zip(others.items(), (ORANGE, GREEN), DASHES[1:]):
        ax.axhline(value, color=colour, linestyle=dash, label=f"{label}: {value:.3f}")
    ax.set_xticks(range(len(left)), factors)
    ax.set(ylabel="share of the sunlight left (1)", ylim=(0, 0.37))
    ax.grid(axis="x", visible=False)
    ax.legend(fontsize=9)
    return figure


def peak_solar(flown):
    """Peak solar power of flown rovers: published with its band, predicted with its sweep of cell efficiency.

    Parameters
    ----------
    flown : pandas.DataFrame
        As returned by `rdk.validation.flown_rovers`.

    Returns
    -------
    matplotlib.figure.Figure
        Grey is what was published, the circle is a clean new array.
    """
    figure, axes = panels(1, len(flown), figsize=(6.4, 3.6))
    for ax, row in zip(np.atleast_1d(axes), flown.itertuples()):
        ax.fill_between([-0.5, 0.5], row.published_low_w, row.published_high_w, color=GREY, alpha=0.3, lw=0,
                        label="published band")
        ax.hlines(row.published_peak_w, -0.5, 0.5, color=BLACK, linestyle="--", label="published")
        spread = [[row.clean_peak_w - row.clean_peak_low_w], [row.clean_peak_high_w - row.clean_peak_w]]
        ax.errorbar([0], [row.clean_peak_w], spread, fmt="o", color=BLUE, capsize=5,
                    label="clean, cell 0.28 to 0.32")
        ax.set(title=row.rover, xticks=[], xlim=(-0.6, 0.6),
               ylim=(0, 1.1 * max(row.clean_peak_high_w, row.published_high_w)),
               ylabel="peak solar power (W)")
        ax.grid(axis="x", visible=False)
    figure.legend(*ax.get_legend_handles_labels(), loc="outside lower center", ncols=3, fontsize=9)
    return figure


def node_temperatures(heat_w, temperature_c, limits_c, marks):
    """Temperature of an enclosure against the heat that it must radiate.

    Parameters
    ----------
    heat_w : ndarray
    temperature_c : dict
        Label -> temperature at each heat.
    limits_c : tuple of float
        Operating limits, drawn as a band.
    marks : dict
        Label -> (heat in W, temperature in degC), drawn as points.

    Returns
    -------
    matplotlib.figure.Figure
        Curves are steep where there is little heat: in the cold each watt counts.
    """
    figure, ax = panels(figsize=(6.8, 4.0))
    ax.axhspan(*limits_c, color=GREY, alpha=0.2, lw=0)
    curves(heat_w, temperature_c, "heat to radiate (W)", "temperature of the enclosure (degC)",
           legend=False, axes=ax)
    for k, (label, (heat, temperature)) in enumerate(marks.items()):
        ax.plot(heat, temperature, MARKERS[k % len(MARKERS)], color=BLACK, markersize=7,
                markerfacecolor="white",
                label=label)
    ax.set(xlim=(heat_w[0], heat_w[-1]))
    ax.legend(fontsize=8.5)
    return figure
