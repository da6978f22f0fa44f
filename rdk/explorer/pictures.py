"""The explorer's pictures: each draws into a bare matplotlib Figure and returns the words for its alt text.

No pyplot here: callbacks may run in other threads. Margins are set once, since a layout engine doubles the time.
"""
from __future__ import annotations

import base64
import io
import json

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from .. import catalog, terramechanics
from ..design import DESIGN_SPACE
from ..figures import BLACK, BLUE, GREEN, GREY, ORANGE

SIZE = (6.0, 3.3)                                        # inches, at DPI
DPI = 96
LABELS = {
    "range_km": "range (km)", "total_mass_kg": "total mass (kg)", "slope_capability_deg": "slope capability (deg)",
    "energy_balance_pct": "energy balance (%)", "cruise_speed_m_s": "cruise speed (m/s)", "slip": "slip",
    "sinkage_m": "sinkage (m)", "wheel_torque_nm": "wheel torque (N m)", "final_soc": "final state of charge",
    "minimum_soc": "lowest state of charge", "average_solar_power_w": "average solar power (W)",
    "hot_temperature_c": "noon temperature (degC)", "cold_temperature_c": "night temperature (degC)",
    "obstacle_capability_m": "obstacle capability (m)", "energy_balance_speed_m_s": "energy-balance speed (m/s)"}
"""Axis labels of the metrics that the explorer offers."""


ABOVE = dict(loc="lower left", bbox_to_anchor=(0, 0.99), ncols=4, fontsize=8, frameon=False, borderpad=0)
"""A legend above the axes: quicker than one that looks for an empty corner, and in nobody's way."""


def label(name):
    """Axis label with unit of a metric, a design variable or another field."""
    if name in DESIGN_SPACE:
        variable = DESIGN_SPACE[name]
        return variable.label + (f" ({variable.unit})" if variable.unit != "1" else "")
    return LABELS.get(name, name.replace("_", " "))


def blank(size=SIZE, dpi=DPI):
    """A bare figure, of the explorer's size unless told otherwise."""
    figure = Figure(figsize=size, dpi=dpi)
    FigureCanvasAgg(figure)
    return figure


PICK = ("const b=this.getBoundingClientRect(),w=b.width/b.height,x=(event.clientX-b.left)/b.width,"
        "y=(event.clientY-b.top)/b.height,p=JSON.parse(this.dataset.points);let n=-1,d=0.06;"
        "p.forEach(([i,u,v])=>{const e=Math.hypot((u-x)*w,v-y);if(e<d){d=e;n=i}});"
        "const s=this.closest('.rdk-explorer')?.querySelector('.rdk-points select');"
        "if(s&&n>=0){s.selectedIndex=n;s.dispatchEvent(new Event('change',{bubbles:true}))}")
"""A click on the picture selects the nearest point, if one is near, in the list of points."""


def html(figure, alt, points=()):
    """The figure as an `img` element with alternative text; `points`, from `places`, can be picked by pointer."""
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", pil_kwargs={"compress_level": 1})
    width, height = int(SIZE[0] * DPI), int(SIZE[1] * DPI)
    words = alt.replace("&", "&amp;").replace('"', "&quot;").replace("<", "&lt;")
    pick = f'style="cursor:pointer" data-points="{json.dumps(points)}" onclick="{PICK}" ' if len(points) else ""
    return (f'<img class="rdk-picture" width="{width}" height="{height}" {pick}alt="{words}" '
            f'src="data:image/png;base64,{base64.b64encode(buffer.getvalue()).decode()}">')


def places(figure, x, ys):
    """Points of a picture as (index, right, down), in shares of its width and height, for each of its panels."""
    spots = []
    for axes, y in zip(figure.axes, ys):
        right, up = figure.transFigure.inverted().transform(axes.transData.transform(np.column_stack([x, y]))).T
        spots += zip(range(len(x)), right.round(4).tolist(), (1 - up).round(4).tolist())
    return spots


def _axes(figure, build=None, margins=None):
    """The figure's axes, emptied of data. Axes and ticks are kept from picture to picture: making them costs most."""
    if not figure.axes:
        for axes in build(figure) if build else [figure.subplots()]:
            axes.grid(alpha=0.3)
            axes.set_axisbelow(True)
            axes.locator_params(nbins=4)                 # each tick costs half a millisecond
            axes.spines["top"].set_visible(False)
            axes.tick_params(labelsize=9)
        figure.subplots_adjust(**margins)
    for axes in figure.axes:
        for artist in (*axes.lines, *axes.patches, *axes.texts, *axes.collections, axes.get_legend()):
            if artist is not None:
                artist.remove()
        axes.containers.clear()                          # they would keep every bar ever drawn
        axes.relim()
        axes.autoscale(True)
    return figure.axes if build else figure.axes[0]


def _rovers(axes, x, y, names, colour=BLACK):
    """Squares with names; rovers at one place share a label."""
    axes.plot(x, y, "s", color=ORANGE, mec="white", ms=6, label="published rovers")
    shared = {}
    for spot, name in sorted(zip(zip(np.round(x, 6), np.round(y, 6)), names)):
        shared.setdefault(spot, []).append(name)
    for i, (spot, found) in enumerate(shared.items()):   # above and below in turn: neighbours seldom collide
        axes.annotate(", ".join(found), spot, xytext=(5, (-12, 5)[i % 2]), textcoords="offset points", fontsize=8,
                      color=colour, annotation_clip=True)


def _rows(axes, names):
    """Names of bars at the left edge: as texts they take half the time of tick labels."""
    axes.set_yticks([])
    for i, name in enumerate(names):
        axes.text(-0.015, i, name, ha="right", va="center", fontsize=8, transform=axes.get_yaxis_transform())


def log(figure, result, scenario, soc_initial=1.0):
    """Sunlight and load, charge, and distance, hour by hour."""
    log = result.log
    days, at_start = log.time_h / 24, np.insert(log.time_h / 24, 0, 0.0)

    def build(figure):
        upper, lower = figure.subplots(2, 1, sharex=True)
        return upper, lower, lower.twinx()

    upper, lower, distance = _axes(figure, build, dict(left=0.1, right=0.9, top=0.93, bottom=0.13, hspace=0.14))
    upper.plot(days, log.solar_w, color=ORANGE, label="sun")
    upper.plot(days, log.load_w, color=BLACK, ls="--", label="load")
    upper.set_ylabel("power (W)", fontsize=9)
    upper.legend(loc="lower right", bbox_to_anchor=(1, 0.98), ncols=2, fontsize=8, frameon=False, borderpad=0)
    lower.plot(at_start, 100 * np.insert(log.soc, 0, soc_initial), color=BLUE)
    lower.set(ylim=(0, 105), xlabel="Earth days after sunrise")
    lower.set_ylabel("charge (%), solid", fontsize=9)
    distance.plot(at_start, np.insert(log.distance_km, 0, 0.0), color=GREEN, ls="-.")
    distance.set_ylim(0, max(float(log.distance_km[-1]) * 1.1, 0.1))
    distance.set_ylabel("distance (km), dash-dot", fontsize=9)
    distance.grid(False)
    return (f"Two charts over {days[-1]:.0f} Earth days. Above, sunlight up to {log.solar_w.max():.0f} W against a load of "
            f"up to {log.load_w.max():.0f} W. Below, charge falls to {100 * result.minimum_soc:.0f} % and ends at "
            f"{100 * result.final_soc:.0f} %; distance reaches {result.range_km:.2f} km.")


def mass(figure, result):
    """Mass line items as horizontal bars."""
    items = {name.removesuffix("_kg").replace("_", " "): value for name, value in result.mass.items.items()}
    items = dict(sorted(items.items(), key=lambda item: item[1]))
    axes = _axes(figure, margins=dict(left=0.2, right=0.92, top=0.9, bottom=0.13))
    axes.barh(range(len(items)), list(items.values()), color=BLUE)
    _rows(axes, items)
    for i, value in enumerate(items.values()):
        axes.text(value, i, f" {value:.2f}", va="center", fontsize=8)
    axes.set(xlabel="mass (kg)", xlim=(0, max(items.values()) * 1.15))
    axes.set_title(f"{result.total_mass_kg:.2f} kg in all", fontsize=10, loc="left")
    heaviest = list(items)[-1]
    return (f"Bar chart of mass line items: {result.total_mass_kg:.2f} kg in all, the largest is {heaviest} with "
            f"{items[heaviest]:.2f} kg.")


def stress(figure, result, design, scenario, model):
    """Normal and shear stress under one wheel at the slip balance."""
    axes = _axes(figure, margins=dict(left=0.11, right=0.97, top=0.9, bottom=0.14))
    axes.set(xlabel="angle ahead of the lowest point (deg)", ylabel="stress (kPa)")
    if np.isnan(result.sinkage_m):
        axes.text(0.5, 0.5, "buried: no contact that carries the load", ha="center", transform=axes.transAxes)
        return "No stresses to draw: the wheel is buried."
    entry = np.arccos(1 - result.sinkage_m / design.wheel_radius_m)
    angle = np.linspace(0, entry, 81)
    stresses = terramechanics.contact_stress(
        design.wheel, scenario.soil, entry, result.slip, angle, transition_c1=model.transition[0],
        transition_c2=model.transition[1], grouser_lift_cap=model.grouser_lift_cap, shear_scale=model.shear_scale)
    sigma, tau = stresses.normal_stress_pa / 1000, stresses.shear_stress_pa / 1000
    axes.plot(np.degrees(angle), sigma, color=BLUE, label="normal")
    axes.plot(np.degrees(angle), tau, color=ORANGE, ls="--", label="shear")
    axes.axvline(np.degrees(stresses.transition_angle_rad[0]), color=GREY, ls=":", lw=1)
    axes.legend(fontsize=8, frameon=False)
    axes.set_title(f"sinkage {1000 * result.sinkage_m:.1f} mm, slip {result.slip:.2f}", fontsize=10, loc="left")
    return (f"Line chart of stress under the wheel from 0 to {np.degrees(entry):.0f} degrees: normal stress peaks at "
            f"{sigma.max():.1f} kPa, shear at {tau.max():.1f} kPa.")


def among_rovers(figure, result, rovers, spans=None):
    """Range against mass: this design, with its intervals, among published rovers on the same mission."""
    axes = _axes(figure, margins=dict(left=0.11, right=0.97, top=0.92, bottom=0.14))
    mass_kg, range_km, names = rovers
    _rovers(axes, mass_kg, range_km, names)
    if spans is not None:
        (x0, x1), (y0, y1) = spans
        axes.plot([x0, x1], [result.range_km] * 2, color=BLUE, lw=1.2)
        axes.plot([result.total_mass_kg] * 2, [y0, y1], color=BLUE, lw=1.2)
    axes.plot(result.total_mass_kg, result.range_km, "o", color=BLUE, ms=10, label="this design, with its intervals")
    axes.legend(**ABOVE)
    axes.set(xlabel="total mass (kg), logarithmic", ylabel="range (km)", xscale="log")
    axes.set_ylim(*(np.array([-0.1, 1.1]) * max(*range_km, result.range_km, 1)))
    ticks = [5, 10, 20, 50, 100, 200]
    axes.set_xticks(ticks, [f"{t}" for t in ticks])
    axes.minorticks_off()
    axes.set_xlim(min(*mass_kg, result.total_mass_kg) * 0.8, max(*mass_kg, result.total_mass_kg) * 1.3)
    others = ", ".join(f"{n} {y:.1f} km" for n, y in zip(names, range_km))
    return (f"Range against total mass: this design reaches {result.range_km:.2f} km with {result.total_mass_kg:.1f} kg; "
            f"on the same mission {others}.")


def why(figure, metric, contributions, before, after, baseline_name):
    """Contributions of the design variables as a waterfall from the baseline to this design."""
    values = np.asarray(contributions)
    least = max(1e-3 * np.abs(values).max(), 1e-9 * max(abs(before), abs(after)), 1e-12)      # below: rounding
    shown = [i for i in np.argsort(-np.abs(values)) if abs(values[i]) > least][:9]
    rest = values.sum() - values[shown].sum()
    names = [label(list(DESIGN_SPACE)[i]) for i in shown] + (["the rest"] if abs(rest) > least else [])
    steps = [values[i] for i in shown] + ([rest] if abs(rest) > least else [])
    edges = before + np.concatenate([[0.0], np.cumsum(steps)])
    axes = _axes(figure, margins=dict(left=0.27, right=0.95, top=0.92, bottom=0.14))
    for i, step in enumerate(steps):
        axes.barh(i, step, left=edges[i], color=BLUE if step >= 0 else ORANGE, hatch="" if step >= 0 else "//",
                  edgecolor="white", height=0.7)
        axes.text(max(edges[i], edges[i + 1]), i, f" {step:+.3g}", va="center", fontsize=8,
                  bbox=dict(facecolor="white", edgecolor="none", pad=0.5))
    axes.axvline(before, color=GREY, ls=":")
    axes.axvline(after, color=BLACK, ls="--")
    _rows(axes, names)
    axes.set_ylim(len(names) - 0.4, -0.6)
    axes.use_sticky_edges = False                        # bars would pin the limits to their ends
    axes.margins(x=0.14)
    axes.set_xlabel(label(metric))
    axes.set_title(f"{baseline_name} (dotted) {before:.3g} to this design (dashed) {after:.3g}", fontsize=9, loc="left")
    if not steps:
        axes.text(0.5, 0.5, f"the same {label(metric)} as {baseline_name}", ha="center", transform=axes.transAxes,
                  backgroundcolor="white")
        return f"No difference in {label(metric)} between this design and {baseline_name}: both {after:.3g}."
    words = "; ".join(f"{n} {s:+.3g}" for n, s in zip(names, steps))
    return f"Bars that add up from {before:.3g} ({baseline_name}) to {after:.3g} in {label(metric)}: {words}."


def curve(figure, name, metric, values, nominal, band, here, rovers):
    """One metric along one variable, with its interval (where, low, high), this design and the published rovers."""
    axes = _axes(figure, margins=dict(left=0.12, right=0.97, top=0.92, bottom=0.14))
    axes.fill_between(*band, color=BLUE, alpha=0.18, lw=0, label="90 % interval")
    axes.plot(values, nominal, color=BLUE, label="nominal")
    axes.plot(*here, "o", color=BLACK, ms=9, label="this design")
    if rovers is not None:
        _rovers(axes, *rovers)
    axes.margins(y=0.1)                                  # room for a rover's name above its mark
    axes.set(xlabel=label(name), ylabel=label(metric))
    axes.margins(y=0.1)                                  # room for the names of rovers
    axes.legend(**ABOVE)
    return (f"{label(metric)} against {label(name)}: from {nominal[0]:.3g} at {values[0]:.3g} to {nominal[-1]:.3g} at "
            f"{values[-1]:.3g}; this design has {here[1]:.3g} at {here[0]:.3g}.")


def contour(figure, names, metric, values, grid, here, rovers):
    """One metric over two variables, with labelled contours, this design and the published rovers."""
    figure.clear()                                       # the colour bar shares the space of the axes
    axes = _axes(figure, margins=dict(left=0.12, right=0.99, top=0.95, bottom=0.14))
    axes.grid(False)
    filled = axes.contourf(values[0], values[1], grid.T, levels=12, cmap="cividis")
    if np.ptp(grid) > 0:
        lines = axes.contour(values[0], values[1], grid.T, levels=filled.levels[1:-1:2], colors="white", linewidths=0.8)
        axes.clabel(lines, fontsize=8, fmt="%.3g")
    axes.plot(*here, "o", color="white", mec=BLACK, ms=10)
    if rovers is not None:
        _rovers(axes, *rovers, colour="white")
    axes.set(xlabel=label(names[0]), ylabel=label(names[1]), xlim=(values[0][0], values[0][-1]),
             ylim=(values[1][0], values[1][-1]))
    figure.colorbar(filled, ax=axes, pad=0.02).set_label(label(metric), fontsize=9)
    return (f"Map of {label(metric)} over {label(names[0])} and {label(names[1])}: from {np.nanmin(grid):.3g} to "
            f"{np.nanmax(grid):.3g}; the circle marks this design.")


def front(figure, x, ys, names, picked=None, here=None, size=None, title=""):
    """A front: one objective, or several in panels, against another; the picked point ringed, this design a cross."""
    ys = [ys] if np.ndim(ys) < 2 else ys
    area = 30.0 if size is None else 14 + 60 * (size - size.min()) / max(np.ptp(size), 1e-12)
    panels = _axes(figure, lambda figure: np.atleast_1d(figure.subplots(1, len(ys))),
                   dict(left=0.1, right=0.98, top=0.92, bottom=0.15, wspace=0.28))
    for axes, y, name, at in zip(panels, ys, names[1:], here[1:] if here is not None else [None] * len(ys)):
        axes.scatter(x, y, s=area, color=BLUE, edgecolor="white", lw=0.5)
        if picked is not None:
            axes.scatter(x[picked], y[picked], s=170, facecolor="none", edgecolor=BLACK, lw=1.8)
        if at is not None:
            axes.plot(here[0], at, "X", color=ORANGE, mec=BLACK, ms=10)
            axes.annotate("this design", (here[0], at), xytext=(8, -11), textcoords="offset points", fontsize=8)
        axes.margins(0.07, 0.12)
        axes.set(xlabel=label(names[0]), ylabel=label(name))
    panels[0].set_title(title, fontsize=9, loc="left")
    if not len(x):
        panels[0].text(0.5, 0.5, "no design meets the constraints", ha="center", transform=panels[0].transAxes)
        return "An empty front: no design meets the constraints."
    spans = ", ".join(f"{label(name)} from {min(v):.3g} to {max(v):.3g}" for name, v in zip(names, [x, *ys]))
    return f"Front of {len(x)} designs: {spans}."


def published():
    """Names of the published rovers and their designs as one population."""
    from ..design import Design
    names = catalog.rover_names()
    designs = [catalog.rover(n) for n in names]
    return names, Design(**{v: np.array([getattr(d, v) for d in designs]) for v in DESIGN_SPACE})
