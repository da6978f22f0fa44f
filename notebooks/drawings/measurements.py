"""Figures of wheels against measurement (notebook 02)."""
from __future__ import annotations

import numpy as np

from rdk.figures import BLACK, BLUE, COLOURS, DASHES, GREY, MARKERS, ORANGE, panels, curves


_TESTS = {"ding-2011": "Ding 2011", "hurrell-2025": "Hurrell 2025", "wang-han-2016": "Wang & Han 2016"}
_WHEELS = {"smooth": (BLUE, "-", "o"), "grousered": (ORANGE, "--", "s")}


def _test_titles(table):
    """Experiment -> title for those in a table, in its order."""
    return {test: _TESTS.get(test, test) for test in table.experiment.unique()}


def single_wheel_comparison(points, curves):
    """The paper's validation figure, and torque: measured points over the kernel's curves, one column a test.

    Parameters
    ----------
    points : pandas.DataFrame
        As returned by `rdk.validation.single_wheel`.
    curves : pandas.DataFrame
        As returned by `rdk.validation.single_wheel_curves`.

    Returns
    -------
    matplotlib.figure.Figure
    """
    titles = _test_titles(points)
    figure, grid = panels(3, len(titles), figsize=(3.2 * len(titles), 8.2), sharex=True, squeeze=False)
    quantities = {"drawbar_pull_n": "drawbar pull (N)", "sinkage_mm": "sinkage (mm)",
                  "torque_nm": "torque (N m)"}
    for column, (test, title) in enumerate(titles.items()):
        grid[0, column].set_title(title, fontsize=11)
        grid[2, column].set_xlabel("slip s")
        for axes, (quantity, y_label) in zip(grid[:, column], quantities.items()):
            for wheel, (colour, dash, marker) in _WHEELS.items():
                lane = curves[(curves.experiment == test) & (curves.wheel == wheel)]
                seen = points[(points.experiment == test) & (points.wheel == wheel)].dropna(subset=quantity)
                if len(lane):
                    axes.plot(lane.slip, lane["model_" + quantity], color=colour, linestyle=dash,
                              linewidth=1.8, label=f"{wheel}, kernel")
                if len(seen):
                    axes.plot(seen.slip, seen[quantity], marker, color=colour, label=f"{wheel}, measured")
            axes.set_ylabel(y_label)
            axes.axhline(0, color=GREY, linewidth=0.8)
        if points.torque_nm[points.experiment == test].isna().all():
            grid[2, column].text(0.95, 0.1, "no torque in the data", transform=grid[2, column].transAxes,
                                 ha="right", fontsize=9)
    figure.legend(*grid[0, 0].get_legend_handles_labels(), loc="outside upper center", ncols=4, frameon=False,
                  fontsize=9)
    return figure


def single_wheel_errors(points):
    """Signed errors of the kernel against slip: pull in % of the load, sinkage in mm; one marker a test.

    Filled markers are grousered wheels, open ones smooth.

    Parameters
    ----------
    points : pandas.DataFrame
        As returned by `rdk.validation.single_wheel`.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, axes = panels(1, 2, figsize=(9, 3.6))
    for i, (test, title) in enumerate(_test_titles(points).items()):
        colour, marker = COLOURS[i % len(COLOURS)], MARKERS[i % len(MARKERS)]
        for wheel in _WHEELS:
            lane = points[(points.experiment == test) & (points.wheel == wheel)]
            pull = 100 * (lane.model_drawbar_pull_n - lane.drawbar_pull_n) / lane.vertical_load_n
            style = dict(color=colour, marker=marker, linewidth=0.8, linestyle=":",
                         markerfacecolor="none" if wheel == "smooth" else colour)
            label = f"{title}, {wheel}" if len(lane) else None
            axes[0].plot(lane.slip, pull, label=label, **style)
            axes[1].plot(lane.slip, lane.model_sinkage_mm - lane.sinkage_mm, **style)
    for panel, y_label in zip(axes, ("error in pull (% of the load)", "error in sinkage (mm)")):
        panel.set(xlabel="slip s", ylabel=y_label)
        panel.axhline(0, color=GREY, linewidth=1)
    figure.legend(loc="outside upper center", ncols=3, frameon=False, fontsize=9)
    return figure


def sinkage_bias(exit_share, sinkage_mm, slip, sinkage_by_slip_mm, measured):
    """Sinkage at slip 0 against where contact ends (left), and against slip, with measurement (right).

    Parameters
    ----------
    exit_share : ndarray
        -theta_2 / theta_1, from 0 (contact ends at the bottom) to 1 (symmetric).
    sinkage_mm : dict of str to ndarray
        At slip 0.
    slip : ndarray
    sinkage_by_slip_mm : dict of str to ndarray
    measured : pandas.DataFrame
        Columns slip and sinkage_mm.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, axes = panels(1, 2, figsize=(9, 3.6), sharey=True)
    curves(exit_share, sinkage_mm, r"exit angle behind the bottom, $-θ_2/θ_1$ (1)", "sinkage (mm)", axes=axes[0])
    at_rest = measured.sinkage_mm[measured.slip == 0]
    axes[0].axhline(at_rest.mean(), color=BLACK, linestyle=":", label="measured, slip 0")
    curves(slip, sinkage_by_slip_mm, "slip s", "sinkage (mm)", axes=axes[1])
    axes[1].plot(measured.slip, measured.sinkage_mm, "s", color=BLACK, label="measured")
    for panel in axes:
        panel.legend(frameon=False, fontsize=9)
    axes[0].set_ylim(bottom=0)
    return figure


def resistance_against_slip(slip, resistance_n, measured):
    """Motion resistance, torque over radius less pull, against slip: kernel as lines, measurement as points.

    Parameters
    ----------
    slip : ndarray
    resistance_n : dict of str to ndarray
        "smooth" and "grousered".
    measured : pandas.DataFrame
        Columns wheel, slip and resistance_n.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, axes = panels()
    for wheel, y in resistance_n.items():
        colour, dash, marker = _WHEELS[wheel]
        seen = measured[measured.wheel == wheel]
        axes.plot(slip, y, color=colour, linestyle=dash, linewidth=1.8, label=f"{wheel}, kernel")
        axes.plot(seen.slip, seen.resistance_n, marker, color=colour, label=f"{wheel}, measured")
    axes.set(xlabel="slip s", ylabel="torque / radius − pull (N)", ylim=(0, None))
    axes.legend(frameon=False, fontsize=9)
    return figure


def sinkage_against_factor(factor, sinkage_mm, measured_mm):
    """Sinkage when parameters of the soil are multiplied by a factor; the range of the measurement as a band.

    Parameters
    ----------
    factor : ndarray
    sinkage_mm : dict of str to ndarray
        By the parameter that is multiplied.
    measured_mm : tuple of float
        Lowest and highest measured sinkage.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, axes = panels()
    curves(factor, sinkage_mm, "factor on the parameter (1)", "sinkage (mm)", axes=axes)
    axes.axhspan(*measured_mm, color=GREY, alpha=0.3, linewidth=0, label="measured, all slips")
    axes.set(xscale="log", yscale="log")
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter("{x:g}")
    axes.legend(frameon=False, fontsize=9)
    return figure


def median_spread(spreads):
    """Medians of |error| with what the bootstrap makes of them: points as printed, bars from 5 to 95 %.

    Parameters
    ----------
    spreads : dict of str to pandas.DataFrame
        As returned by `rdk.validation.bootstrap_medians`, by label; all with the same rows.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, axes = panels(figsize=(7.4, 4.2))
    for i, (label, table) in enumerate(spreads.items()):
        row = np.arange(len(table))[::-1] - 0.3 * i
        axes.hlines(row, table.low_pct, table.high_pct, color=COLOURS[i], linestyle=DASHES[i], linewidth=2.2,
                    label=label)
        axes.plot(table.median_abs_error_pct, row, MARKERS[i], color=COLOURS[i])
    names = [f"{_TESTS.get(test, test)}, {quantity.replace('_', ' ')}" for test, quantity in
             zip(table.experiment, table.quantity)]
    axes.set_yticks(np.arange(len(table))[::-1] - 0.15 * (len(spreads) - 1), names)
    axes.set(xscale="log", xlabel="median of |error| (%)")
    axes.set_xticks([3, 10, 30, 100, 300], ["3", "10", "30", "100", "300"])
    axes.minorticks_off()
    figure.legend(loc="outside upper center", ncols=2, frameon=False, fontsize=9)
    return figure
