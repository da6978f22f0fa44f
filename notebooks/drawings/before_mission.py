"""Figures of the evaluator, of rovers on missions and of the march (notebooks 00, 05 and 12)."""
from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np

from rdk.figures import BLACK, BLUE, COLOURS, DASHES, GREEN, GREY, MARKERS, ORANGE, panels


EVALUATION_FLOW = (
    ("mass", "terramechanics", "weight on\na wheel"),
    ("terramechanics", "cruise speed", "slip, torque,\nstalled"),
    ("power", "cruise speed", "mean\nsunlight"), ("power", "march", "sunlight,\nstep by step"),
    ("cruise speed", "march", "speed, hub power"))
"""What flows between the parts of `evaluate`: from, to, what."""

EVALUATION_RESULTS = {
    "mass": ("total_mass_kg",),
    "terramechanics": ("slope_capability_deg", "slip", "sinkage_m", "wheel_torque_nm"),
    "power": ("average_solar_power_w",), "cruise speed": ("cruise_speed_m_s",),
    "march": ("range_km", "energy_balance_pct", "final_soc"),
    "thermal": ("hot_temperature_c", "cold_temperature_c")}
"""The results that each part of `evaluate` brings forth."""

_PARTS = {                                               # left, bottom, and what stands in the box
    "mass": (2.75, 5.05, "line items,\ntotal mass"),
    "thermal": (5.4, 5.05, "hot noon, cold night;\nno part reads it"),
    "terramechanics": (2.75, 3.1, "slip balance and slope\ncapability, solved once;\ncontact integrates"),
    "power": (5.4, 3.1, "sun, panel,\nbattery"),
    "cruise speed": (2.75, 1.15, "mission.cruise_speed:\nthe sun pays for it,\nthe hub caps it"),
    "march": (5.4, 1.15, "mission: charge and\ndistance, hour by hour,\nto the end")}


def system_diagram():
    """The parts of `rdk`, and what flows between them in one evaluation; no arrow runs back inside.

    Returns
    -------
    matplotlib.figure.Figure
        Inputs on the left, the parts of `evaluate` in the frame, results on the right, what uses them below.
    """
    figure, ax = panels(figsize=(9.4, 5.6))
    ax.set(xlim=(-0.4, 10.4), ylim=(-0.75, 6.65))
    ax.axis("off")

    def box(x, y, width, height, title, text="", colour=BLACK, face="white", dash="-"):
        ax.add_patch(plt.Rectangle((x, y), width, height, fc=face, ec=colour, linestyle=dash, lw=1.3))
        ax.text(x + width / 2, y + height - 0.14, title, ha="center", va="top", fontsize=9.5, weight="bold")
        ax.text(x + width / 2, y + height - 0.5, text, ha="center", va="top", fontsize=8, linespacing=1.35)

    def arrow(*points, text="", at=(0, 0), dash="-"):
        ax.plot(*zip(*points), color=BLACK, lw=1.4, linestyle=dash)
        ax.annotate("", points[-1], points[-2],
                    arrowprops=dict(arrowstyle="-|>", lw=0, color=BLACK, shrinkB=0, mutation_scale=15))
        ax.text(*at, text, fontsize=7.5, ha="center", va="center", style="italic", linespacing=1.2)

    box(-0.05, 2.85, 2.05, 3.75, "catalog reads data/", colour=GREEN, dash="--")
    for y, title, text in ((4.75, "Design", "11 numbers:\nwheels, chassis, array,\nbattery, hubs ..."),
                           (3.0, "Scenario", "site, slope, Soil,\ndays, duty, payload"),
                           (1.25, "Model", "coefficients; the\npaper's are the defaults")):
        box(0.05, y, 1.85, 1.35, title, text, BLUE)
        arrow((1.9, y + 0.67), (2.45, y + 0.67))
    box(2.45, 0.75, 5.2, 5.85, "mission.evaluate", colour=ORANGE)
    for name, (x, y, text) in _PARTS.items():
        box(x, y, 1.95, 1.15, name, text, face="#f2f2f2")
    routes = {                                           # start, end and the place of the words
        ("mass", "terramechanics"): ((3.72, 5.05), (3.72, 4.25), (4.15, 4.66)),
        ("terramechanics", "cruise speed"): ((3.4, 3.1), (3.4, 2.3), (2.95, 2.7)),
        ("power", "cruise speed"): ((5.4, 3.4), (4.4, 2.3), (4.42, 2.82)),
        ("power", "march"): ((6.37, 3.1), (6.37, 2.3), (6.95, 2.7)),
        ("cruise speed", "march"): ((4.7, 1.6), (5.4, 1.6), (5.05, 0.95))}
    for start, end, text in EVALUATION_FLOW:
        *points, at = routes[start, end]
        arrow(*points, text=text, at=at)
    results = [name for names in EVALUATION_RESULTS.values() for name in names]
    box(8.2, 2.35, 2.15, 3.7, "Performance", "\n".join(results) + "\nstalled, feasible ...", BLUE)
    arrow((7.65, 4.2), (8.2, 4.2))
    box(2.45, -0.7, 5.2, 0.95, "tradespace, validation, explorer",
        "many designs at once, comparisons, pictures, sliders", GREEN)
    arrow((9.27, 2.35), (9.27, -0.22), (7.65, -0.22))
    arrow((2.45, -0.22), (-0.25, -0.22), (-0.25, 5.42), (0.05, 5.42),
          text="the next design:\nthe loop closes out here", at=(1.05, 0.15), dash="--")
    return figure


def growth(mass_kg, content):
    """What grows when a rover gains mass: one small panel a quantity.

    Parameters
    ----------
    mass_kg : ndarray
        Total mass.
    content : dict
        Axis label with unit -> values at each mass. NaN leaves a gap.

    Returns
    -------
    matplotlib.figure.Figure
        A panel for each quantity, and in grey what plain proportion to the mass would give.
    """
    figure, axes = panels(1, len(content), figsize=(2.5 * len(content), 2.7), squeeze=False)
    for ax, (label, values), colour, marker in zip(axes.flat, content.items(), COLOURS, MARKERS):
        ax.plot(mass_kg, values, color=colour, marker=marker, markersize=4)
        ax.plot(mass_kg, values[0] * mass_kg / mass_kg[0], color=GREY, linestyle=":", lw=1.2)
        ax.set(xlabel="total mass (kg)", title=label, ylim=(0, None))
        ax.title.set_fontsize(9.5)
    return figure


def rovers_on_missions(range_km, limit_km, verdicts, rovers, missions):
    """Bars of range, rover by rover and mission by mission, with a word on what stops each.

    Parameters
    ----------
    range_km : ndarray, shape (rovers, missions)
    limit_km : sequence
        Traverse limit of each mission.
    verdicts : ndarray of str, shape (rovers, missions)
        What stops the rover.
    rovers, missions : sequence of str
        Labels.

    Returns
    -------
    matplotlib.figure.Figure
        One panel a mission; the dashed line is the mission's traverse limit.
    """
    figure, axes = panels(1, len(missions), figsize=(2.5 * len(missions), 3.4), sharey=True, squeeze=False)
    for column, (ax, mission, limit) in enumerate(zip(axes.flat, missions, limit_km)):
        bars = ax.barh(range(len(rovers)), range_km[:, column], height=0.62, color=BLUE)
        ax.axvline(limit, color=BLACK, linestyle="--", lw=1.2)
        for row, (bar, word) in enumerate(zip(bars, verdicts[:, column])):
            length = bar.get_width()
            inside = length > 0.5 * limit
            ax.text(length + (-0.03 if inside else 0.05) * limit, row,
                    f"{length:.3g} km, {word}" if length else word, va="center", fontsize=8,
                    ha="right" if inside else "left", color="white" if inside else BLACK)
            if not length:
                ax.plot(0, row, marker="X", color=ORANGE, clip_on=False, zorder=3)
        ax.set(title=mission, xlabel="range (km)", xlim=(0, 1.1 * limit))
        ax.title.set_fontsize(10)
        ax.grid(axis="y", visible=False)
    axes[0, 0].set_yticks(range(len(rovers)), rovers)
    axes[0, 0].invert_yaxis()
    return figure


def sunk_wheel(design, performance, slope_deg=0.0, figure=None):
    """One wheel from the side, to scale, sunk into the slope as far as the evaluator says.

    Parameters
    ----------
    design : Design
    performance : Performance
        Of one design that is not buried.
    slope_deg : float
        The scenario's slope: tilts the picture.
    figure : matplotlib.figure.Figure, optional
        Draw into this one; by default into a new pyplot figure.

    Returns
    -------
    matplotlib.figure.Figure
        The soil stands undisturbed in front and flat at the rut's depth behind: the model has no rebound.
    """
    figure = figure or plt.figure(figsize=(5.2, 3.6))
    ax = figure.add_axes((0.02, 0.02, 0.96, 0.86))
    r, sinkage, height = design.wheel_radius_m, performance.sinkage_m, design.grouser_height_m
    slope = np.radians(slope_deg)

    def turned(x, y):
        return np.cos(slope) * x - np.sin(slope) * y, np.sin(slope) * x + np.cos(slope) * y

    entry = np.arccos(1 - sinkage / r)                   # sinkage = r (1 - cos(entry angle))
    arc = np.linspace(0, entry, 30)
    x = np.concatenate([[-9 * r], r * np.sin(arc), [9 * r, 9 * r, -9 * r]])
    y = np.concatenate([[-sinkage], r * (1 - np.cos(arc)) - sinkage, [0, -9 * r, -9 * r]])
    ax.fill(*turned(x, y), facecolor="#d9d9d9", edgecolor=BLACK, lw=1.2)
    ax.plot(*turned(np.array([-9 * r, 9 * r]), np.zeros(2)), color=ORANGE, linestyle="--", lw=1)
    angle = np.linspace(0, 2 * np.pi, 200)
    centre = r - sinkage
    ax.fill(*turned(r * np.sin(angle), centre + r * np.cos(angle)), facecolor="white", edgecolor=BLUE, lw=2)
    spokes = np.arange(design.grouser_count) * 2 * np.pi / max(design.grouser_count, 1)
    ends = np.array([r, r + height])[:, None]
    ax.plot(*turned(ends * np.sin(spokes), centre + ends * np.cos(spokes)), color=BLUE, lw=2)
    ax.plot(*turned(0, centre), marker="+", color=BLACK)
    ax.set(xlim=(-2.2 * r, 2.2 * r), ylim=(-1.1 * r, 2.2 * r), aspect="equal", xticks=[], yticks=[])
    fate = "stalls" if performance.stalled else f"drives {performance.range_km:.0f} km"
    figure.suptitle(f"{performance.total_mass_kg:.1f} kg on {slope_deg:g} deg: "
                    f"sinks {1000 * sinkage:.1f} mm, slip {performance.slip:.2f}, {fate}", fontsize=10)
    return figure


def pull_and_demand(slip, pulls, demands, roots):
    """Drawbar pull against slip, the pull that each slope demands, and where the two meet.

    Parameters
    ----------
    slip : ndarray
    pulls, demands, roots : dict
        Label -> pull at each slip (N); the pull demanded (N); the slip where both are equal.

    Returns
    -------
    matplotlib.figure.Figure
        A curve and a level line a label, with a marker where they cross.
    """
    figure, ax = panels()
    for (label, pull), colour, dash, marker in zip(pulls.items(), COLOURS, DASHES, MARKERS):
        ax.plot(slip, pull, color=colour, linestyle=dash, label=label)
        ax.axhline(demands[label], color=colour, linestyle=dash, lw=1)
        ax.plot(roots[label], demands[label], color=colour, marker=marker, markersize=8, linestyle="none")
    ax.axhline(0, color=GREY, lw=0.8)
    ax.set(xlabel="slip", ylabel="drawbar pull of one wheel (N)")
    ax.legend(loc="lower right", frameon=False)
    return figure


def stall(slope_deg, slip, torque_nm, peak_torque_nm, stalled, labels):
    """Slip and torque against slope, up to where each rover stalls.

    Parameters
    ----------
    slope_deg : ndarray, shape (slopes,)
    slip, torque_nm, stalled : ndarray, shape (rovers, slopes)
    peak_torque_nm : sequence
        Peak hub torque of each rover.
    labels : sequence of str

    Returns
    -------
    matplotlib.figure.Figure
        Above slip, below the share of the hub's peak torque that the slope takes; a cross at the first stall.
    """
    figure, axes = panels(2, 1, figsize=(6.4, 5), sharex=True)
    share = torque_nm / np.asarray(peak_torque_nm)[:, None]
    for row, (label, colour, dash) in enumerate(zip(labels, COLOURS, DASHES)):
        last = int(np.argmax(stalled[row])) if stalled[row].any() else len(slope_deg) - 1
        for ax, values in zip(axes, (slip, share)):
            ax.plot(slope_deg[:last + 1], values[row, :last + 1], color=colour, linestyle=dash, label=label)
            if stalled[row].any():
                ax.plot(slope_deg[last], values[row, last], color=colour, marker="X", markersize=9)
    axes[0].axhline(0.95, color=GREY, lw=1)
    axes[1].axhline(1, color=GREY, lw=1)
    axes[0].set(ylabel="slip", ylim=(0, 1))
    axes[1].set(xlabel="slope (deg)", ylabel="torque / peak hub torque", ylim=(0, None))
    axes[0].legend(loc="lower right", frameon=False)
    return figure


def speed_limits(slope_deg, energy_speed_m_s, hub_speed_m_s, cruise_speed_m_s):
    """The speed that the sun pays for, the speed of the hub, and the lower of the two, against slope.

    Parameters
    ----------
    slope_deg, energy_speed_m_s, hub_speed_m_s, cruise_speed_m_s : ndarray
        Only slopes on which the rover does not stall.

    Returns
    -------
    matplotlib.figure.Figure
        Speeds on a logarithmic axis, from a stroll to a car.
    """
    figure, ax = panels()
    ax.semilogy(slope_deg, energy_speed_m_s, color=ORANGE, linestyle="--",
                label="energy balance (the paper's text)")
    ax.semilogy(slope_deg, hub_speed_m_s, color=GREEN, linestyle="-.", label="hub at 5 rad/s")
    ax.semilogy(slope_deg, cruise_speed_m_s, color=BLUE, marker="o", markersize=7, linestyle="none",
                fillstyle="none", markevery=6, label="cruise")
    ax.axhline(1.4, color=GREY, linestyle=":", lw=1.2)
    ax.text(slope_deg[0], 1.5, "a person walking", fontsize=8, color=GREY)
    ax.set(xlabel="slope (deg)", ylabel="speed (m/s)")
    ax.legend(loc="lower left", frameon=False)
    return figure


def mission_logs(logs, soc_floor=0.15):
    """Power, charge and distance through each mission, a column a mission.

    Parameters
    ----------
    logs : dict
        Title -> TraverseLog.
    soc_floor : float
        Drawn as a line.

    Returns
    -------
    matplotlib.figure.Figure
        Grey bands are the hours in which driving is throttled to what the sun carries.
    """
    figure, axes = panels(3, len(logs), figsize=(4.6 * len(logs), 6.2), sharex="col", squeeze=False)
    for column, (title, log) in zip(axes.T, logs.items()):
        days = log.time_h / 24
        for ax in column:
            ax.fill_between(days, 0, 1, where=log.throttled, color=GREY, alpha=0.3, lw=0,
                            transform=ax.get_xaxis_transform())
        column[0].plot(days, log.solar_w, color=ORANGE, label="solar")
        column[0].plot(days, log.load_w, color=BLACK, linestyle="--", label="load")
        column[1].plot(days, log.soc, color=BLUE)
        column[1].axhline(soc_floor, color=GREY, lw=1)
        column[2].plot(days, log.distance_km, color=GREEN)
        column[0].set(title=title, ylabel="power (W)")
        column[1].set(ylabel="state of charge", ylim=(0, 1.05))
        column[2].set(xlabel="days since sunrise", ylabel="distance (km)", ylim=(0, None))
    axes[0, 0].legend(loc="upper right", frameon=False, fontsize=8)
    return figure


def step_convergence(step_h, errors):
    """Error against the time step, on logarithmic axes, with the slope of a first-order method.

    Parameters
    ----------
    step_h : ndarray
        Time steps in hours.
    errors : dict
        Label -> relative error at each step.

    Returns
    -------
    matplotlib.figure.Figure
        The dashed grey line halves when the step halves.
    """
    figure, ax = panels()
    for (label, error), colour, marker in zip(errors.items(), COLOURS, MARKERS):
        ax.loglog(step_h, error, color=colour, marker=marker, label=label)
    first = max(error[0] for error in errors.values())
    ax.loglog(step_h, first * step_h / step_h[0], color=GREY, linestyle=":", label="proportional to the step")
    ax.axvline(1, color=GREY, lw=0.8)
    ax.set(xlabel="time step (h)", ylabel="relative error")
    ax.legend(frameon=False)
    return figure


def load_transfer(ratio, changes, band_pct=2.0):
    """Change of the total pull when weight shifts to the downhill wheels, against height over wheelbase.

    Parameters
    ----------
    ratio : ndarray
        Height of the centre of mass over the wheelbase.
    changes : dict
        Label -> change in percent at each ratio.
    band_pct : float
        The paper's bound, drawn as a band.

    Returns
    -------
    matplotlib.figure.Figure
        Curves inside the band agree with the paper.
    """
    figure, ax = panels()
    ax.axhspan(-band_pct, band_pct, color=GREY, alpha=0.2, lw=0)
    for (label, change), colour, dash, marker in zip(changes.items(), COLOURS, DASHES, MARKERS):
        ax.plot(ratio, change, color=colour, linestyle=dash, marker=marker, markevery=4, markersize=5,
                label=label)
    ax.set(xlabel="height of the centre of mass / wheelbase", ylabel="change of total pull (%)")
    ax.legend(loc="lower left", frameon=False, fontsize=8.5)
    return figure


def demand_chances(mass_kg, shares, wanted=0.9):
    """How often each demand of a mission holds in the uncertain inputs, for designs from light to heavy.

    Parameters
    ----------
    mass_kg : ndarray
        Nominal mass of each design, rising.
    shares : dict of str to ndarray
        Demand in words -> share of the draws in which it holds, one a design.
    wanted : float
        The share asked for, drawn as a line.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, ax = panels(figsize=(6.8, 4.0))
    for i, (label, share) in enumerate(shares.items()):
        ax.plot(mass_kg, 100 * share, color=COLOURS[i % 4], linestyle=DASHES[i % 4], marker=MARKERS[i], markersize=5,
                label=label)
    ax.axhline(100 * wanted, color=GREY, linewidth=1)
    ax.set(xlabel="nominal mass (kg)", ylabel="holds in (% of the draws)", ylim=(-3, 103))
    figure.legend(loc="outside upper center", ncols=2, fontsize=9, frameon=False)
    return figure
