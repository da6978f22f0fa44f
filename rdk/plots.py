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


# ---- wheel on soil (notebook 01) --------------------------------------------------------------------------

def _lines(axes, x, series, x_label, y_label, legend=True):
    """One line for each entry of `series`, told apart by colour and dashes; x may be a dict, too."""
    for i, (label, y) in enumerate(series.items()):
        axes.plot(x[label] if isinstance(x, dict) else x, y, color=COLOURS[i % 4], linestyle=DASHES[i % 4],
                  linewidth=1.8, label=label)
    axes.set(xlabel=x_label, ylabel=y_label)
    if legend and len(series) > 1:
        axes.legend(frameon=False, fontsize=9)


def pressure_sinkage(depth_mm, pressure_kpa):
    """Bekker's law: pressure under a flat plate against its depth, one line a soil.

    Parameters
    ----------
    depth_mm : ndarray
    pressure_kpa : dict of str to ndarray

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, axes = _axes()
    _lines(axes, depth_mm, pressure_kpa, "sinkage z (mm)", "pressure p (kPa)")
    return figure


def shear_mobilisation(displacement_mm, shear_kpa, shear_modulus_mm):
    """Janosi and Hanamoto's law: shear stress against displacement, one line a normal stress; K marked.

    Parameters
    ----------
    displacement_mm : ndarray
    shear_kpa : dict of str to ndarray
    shear_modulus_mm : float

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, axes = _axes()
    _lines(axes, displacement_mm, shear_kpa, "shear displacement j (mm)", "shear stress τ (kPa)")
    axes.axvline(shear_modulus_mm, color=GREY, linewidth=1)
    axes.annotate("K", (shear_modulus_mm, 0.02), xycoords=("data", "axes fraction"), xytext=(4, 0),
                  textcoords="offset points", color=GREY)
    return figure


def stress_against_angle(angle_deg, normal_kpa, shear_kpa, transition_deg):
    """Normal and shear stress along the contact arc, exit on the left, entry on the right.

    Parameters
    ----------
    angle_deg, normal_kpa, shear_kpa : ndarray
    transition_deg : float

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, axes = _axes()
    _lines(axes, angle_deg, {"normal stress σ": normal_kpa, "shear stress τ": shear_kpa},
           "angle θ from the downward vertical (deg)", "stress (kPa)")
    axes.axvline(transition_deg, color=GREY, linewidth=1)
    axes.annotate("$θ_m$", (transition_deg, 0.02), xycoords=("data", "axes fraction"), xytext=(4, 0),
                  textcoords="offset points", color=GREY)
    return figure


def stress_on_rim(radius_m, cases, arrows=11):
    """The stresses drawn to scale on the lower rim of a wheel that drives to the right, one panel a case.

    The blue area outside the rim is the normal stress; its arrows push on the wheel. The hatched orange area
    inside the rim is the shear stress; its arrows show which way the soil pulls the rim. One stress scale holds
    for all. Short lines mark the entry angle (1), the transition angle (m) and the exit (2).

    Parameters
    ----------
    radius_m : float
    cases : dict of str to (ndarray, rdk.terramechanics.ContactStress)
        Angles in radians from the exit at 0 to the entry angle, and the stresses there.
    arrows : int
        Number of arrows along the arc.

    Returns
    -------
    matplotlib.figure.Figure
    """
    r = 1000 * radius_m
    highest = max(np.max(abs(np.array(stress[:2]))) for _, stress in cases.values()) / 1000
    widest = max(angle[-1] for angle, _ in cases.values())
    scale = 0.8 * r * np.sin(widest) / highest                           # mm of drawing a kPa
    figure, all_axes = _axes(1, len(cases), figsize=(3.2 * len(cases), 3.3), squeeze=False, sharey=True)

    def at(radius, angle):                                               # the hub is the origin
        return radius * np.sin(angle), -radius * np.cos(angle)

    for axes, (label, (angle, stress)) in zip(all_axes[0], cases.items()):
        sigma, tau = stress.normal_stress_pa / 1000 * scale, stress.shear_stress_pa / 1000 * scale
        x, y = at(r, angle)
        axes.fill([-r, *x, 2 * r, 2 * r, -r], [-r, *y, y[-1], -2 * r, -2 * r], color="#e8e2d8", zorder=0)
        for offset, colour, style in ((sigma, BLUE, dict(facecolor=BLUE, alpha=0.25)),
                                      (-abs(tau), ORANGE, dict(facecolor="none", hatch="////"))):
            edge = at(r + offset, angle)
            axes.fill([*x, *edge[0][::-1]], [*y, *edge[1][::-1]], linewidth=0, edgecolor=colour, **style)
            axes.plot(*edge, color=colour, linewidth=1.5)
        axes.plot(*at(r, np.linspace(-np.pi / 2, np.pi / 2, 181)), color=BLACK, linewidth=1.5)
        spots = np.linspace(0, angle[-1], arrows + 2)[1:-1]
        options = dict(angles="xy", scale_units="xy", scale=1, width=0.006)
        push = np.interp(spots, angle, sigma)
        axes.quiver(*at(r + push, spots), *at(-push, spots), color=BLUE, **options)
        spots = spots[1::3]
        drag, length = np.interp(spots, angle, tau), 0.08 * r
        start = at(r - abs(drag) / 2, spots - np.sign(drag) * length / 2 / r)
        axes.quiver(*start, np.sign(drag) * length * np.cos(spots), np.sign(drag) * length * np.sin(spots),
                    color=BLACK, **options, zorder=3)
        for mark, name in ((angle[-1], "1"), (np.ravel(stress.transition_angle_rad)[0], "m"), (0, "2")):
            axes.plot(*at(np.array([0.73, 0.79]) * r, mark), color=BLACK, linewidth=1)
            axes.text(*at(0.7 * r, mark), f"θ$_{name}$", ha="center", va="center", fontsize=9)
        axes.set(xlim=(-0.2 * r, r * (np.sin(widest) + 0.25)), ylim=(-r - 1.15 * highest * scale, -0.62 * r),
                 aspect="equal", title=label, xlabel="forward of the hub (mm)")
        axes.title.set_size(10)
        axes.grid(False)
    axes = all_axes[0, 0]
    axes.set_ylabel("above the hub (mm)")
    bar, low = 10.0 ** np.floor(np.log10(highest)), -r - 1.05 * highest * scale
    axes.plot([-0.16 * r, -0.16 * r + bar * scale], [low, low], color=BLACK, linewidth=3)
    axes.text(-0.13 * r + bar * scale, low, f"{bar:g} kPa", va="center", fontsize=9)
    return figure


def quadrature_error(points, errors, marked_points):
    """Error of an integration rule against its number of points, on logarithmic scales; one line a rule.

    Parameters
    ----------
    points : dict of str to ndarray
    errors : dict of str to ndarray
        Relative errors; zeros are drawn at 1e-16.
    marked_points : int
        A number of points to mark: that of the paper.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, axes = _axes()
    _lines(axes, points, {label: np.maximum(error, 1e-16) for label, error in errors.items()},
           "evaluations of the stress", "relative error", legend=False)
    for line, marker in zip(axes.get_lines(), MARKERS):
        line.set(marker=marker, markersize=5)
    axes.legend(frameon=False, fontsize=9)
    axes.axvline(marked_points, color=GREY, linewidth=1)
    axes.set(xscale="log", yscale="log")
    return figure


def wheel_against_slip(slip, cases):
    """Drawbar pull, torque and sinkage against slip, one line a case.

    Parameters
    ----------
    slip : ndarray
    cases : dict of str to rdk.terramechanics.WheelForces

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, axes = _axes(1, 3, figsize=(9.6, 3.4))
    for panel, field, factor, y_label in zip(axes, ("drawbar_pull_n", "torque_nm", "sinkage_m"), (1, 1, 1000),
                                             ("drawbar pull (N)", "torque (N m)", "sinkage (mm)")):
        _lines(panel, slip, {label: factor * getattr(f, field) for label, f in cases.items()}, "slip s",
               y_label, legend=panel is axes[0])
        panel.axhline(0, color=GREY, linewidth=0.8)
    axes[2].set_ylim(bottom=0)
    return figure


def wheel_against_size(size_mm, cases, fixed_label):
    """Pull over load, and sinkage, against a dimension of the wheel; one line a dimension, the other held.

    Parameters
    ----------
    size_mm : ndarray
    cases : dict of str to (ndarray, ndarray)
        Pull over load, and sinkage in mm.
    fixed_label : str
        What is held, for the title.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, axes = _axes(1, 2, figsize=(8.4, 3.4))
    for panel, i, y_label in zip(axes, (0, 1), ("drawbar pull over load", "sinkage (mm)")):
        _lines(panel, size_mm, {label: case[i] for label, case in cases.items()}, "size (mm)", y_label)
    figure.suptitle(fixed_label, fontsize=10)
    return figure


def power_split(slip, parts_w, total_w):
    """Where the power that enters wheel and vehicle goes in the soil, against slip.

    Parameters
    ----------
    slip : ndarray
    parts_w : dict of str to ndarray
        Parts of the loss, in watts.
    total_w : ndarray
        Torque times angular speed less pull times speed.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, axes = _axes()
    _lines(axes, slip, {**parts_w, "torque × speed − pull × speed": total_w}, "slip s",
           "power into the soil (W)")
    axes.axhline(0, color=GREY, linewidth=0.8)
    return figure


def sinkage_against_load(load_n, sinkage_mm):
    """Sinkage against load on logarithmic scales: a power law is a straight line.

    Parameters
    ----------
    load_n : ndarray
    sinkage_mm : dict of str to ndarray

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, axes = _axes()
    _lines(axes, load_n, sinkage_mm, "load on the wheel (N)", "sinkage (mm)")
    axes.set(xscale="log", yscale="log")
    return figure


def load_and_pull(cases, weight_n, slope_deg):
    """Pull against vertical load as a wheel sinks, at one slip, and the circle of what its weight can ask.

    Where curve and circle meet, the wheel carries w cos(slope) and pulls w sin(slope): the slope is the angle
    of that point.

    Parameters
    ----------
    cases : dict of str to (ndarray, ndarray)
        Vertical load and drawbar pull in newtons, one curve a soil.
    weight_n : float
        Weight on the wheel.
    slope_deg : dict of str to float
        Slope capability of each case.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, axes = _axes(figsize=(5.6, 4.2))
    for i, (label, (load, pull)) in enumerate(cases.items()):
        angle = np.radians(slope_deg[label])
        axes.plot(load, pull, color=COLOURS[i], linestyle=DASHES[i], linewidth=1.8, label=label)
        axes.plot(weight_n * np.cos(angle), weight_n * np.sin(angle), MARKERS[i], color=COLOURS[i],
                  label=f"slope {slope_deg[label]:.1f}°")
        axes.plot([0, weight_n * np.cos(angle)], [0, weight_n * np.sin(angle)], color=GREY, linewidth=0.8)
    arc = np.radians(np.linspace(0, 40, 100))
    axes.plot(weight_n * np.cos(arc), weight_n * np.sin(arc), color=BLACK, linestyle=":",
              label="weight on the wheel")
    axes.set(xlim=(0, 1.15 * weight_n), ylim=(0, 0.7 * weight_n), aspect="equal",
             xlabel="vertical load $F_z$ (N)", ylabel="drawbar pull (N)")
    axes.legend(frameon=False, fontsize=9)
    return figure


# ---- notebooks 00 and 05: the evaluator, rovers on missions, the march ---------------------------------------

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
    figure, ax = _axes(figsize=(9.4, 5.6))
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
    box(2.45, -0.7, 5.2, 0.95, "tradespace, validation, plots, explorer",
        "many designs at once, comparisons, pictures, sliders", GREEN)
    arrow((9.27, 2.35), (9.27, -0.22), (7.65, -0.22))
    arrow((2.45, -0.22), (-0.25, -0.22), (-0.25, 5.42), (0.05, 5.42),
          text="the next design:\nthe loop closes out here", at=(1.05, 0.15), dash="--")
    return figure


def growth(mass_kg, panels):
    """What grows when a rover gains mass: one small panel a quantity.

    Parameters
    ----------
    mass_kg : ndarray
        Total mass.
    panels : dict
        Axis label with unit -> values at each mass. NaN leaves a gap.

    Returns
    -------
    matplotlib.figure.Figure
        A panel for each quantity, and in grey what plain proportion to the mass would give.
    """
    figure, axes = _axes(1, len(panels), figsize=(2.5 * len(panels), 2.7), squeeze=False)
    for ax, (label, values), colour, marker in zip(axes.flat, panels.items(), COLOURS, MARKERS):
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
    figure, axes = _axes(1, len(missions), figsize=(2.5 * len(missions), 3.4), sharey=True, squeeze=False)
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


def live(draw, **sliders):
    """A picture with sliders that is drawn anew when one moves; it runs without a browser too.

    Parameters
    ----------
    draw : callable
        Takes an empty matplotlib Figure and one number a slider, by name; draws, and returns a sentence
        that says what the picture shows. It may run in several threads, one at a time: no pyplot in it.
    **sliders : tuple
        Name -> (low, high, step, start, label with unit).

    Returns
    -------
    ipywidgets.HBox
        Its `sliders` is a dictionary of the sliders by name; `picture` the HTML image with the sentence as
        its alternative text. Where there are no widgets the picture stands alone.
    """
    import base64
    import html
    import io
    import threading

    import ipywidgets as widgets
    from matplotlib.figure import Figure

    class LivePicture(widgets.HBox):
        def _repr_mimebundle_(self, **options):          # a viewer without widgets shows the picture instead
            bundle = super()._repr_mimebundle_(**options)
            return {**bundle, "text/plain": self.sentence, "image/png": self.png}

    picture, said = widgets.HTML(), widgets.HTML()
    rows, controls, lock = [], {}, threading.Lock()
    for name, (low, high, step, start, label) in sliders.items():
        limits = dict(min=low, max=high, step=step, value=start, description=label,
                      style={"description_width": "110px"}, layout=widgets.Layout(width="310px"))
        controls[name] = widgets.FloatSlider(readout=False, **limits)
        number = widgets.BoundedFloatText(**limits)      # for keyboards and screen readers
        widgets.link((controls[name], "value"), (number, "value"))
        rows += [controls[name], number]
    panel = widgets.VBox([*rows, said], layout=widgets.Layout(flex="0 0 330px"))
    box = LivePicture([panel, picture])
    box.sliders, box.picture = controls, picture

    def redraw(change=None):
        with lock:                                       # JupyterLab may call from several threads
            figure, file = Figure(figsize=(5.2, 3.6)), io.BytesIO()
            box.sentence = draw(figure, **{name: control.value for name, control in controls.items()})
            figure.savefig(file, format="png", dpi=100)
            box.png, text = base64.b64encode(file.getvalue()).decode(), html.escape(box.sentence)
            picture.value = (f'<img width="520" height="360" alt="{text}" '
                             f'src="data:image/png;base64,{box.png}">')
            said.value = f'<div role="status">{text}</div>'

    for control in controls.values():
        control.observe(redraw, "value")
    redraw()
    return box


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
    figure, ax = _axes()
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
    figure, axes = _axes(2, 1, figsize=(6.4, 5), sharex=True)
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
    figure, ax = _axes()
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
    figure, axes = _axes(3, len(logs), figsize=(4.6 * len(logs), 6.2), sharex="col", squeeze=False)
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
    figure, ax = _axes()
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
    figure, ax = _axes()
    ax.axhspan(-band_pct, band_pct, color=GREY, alpha=0.2, lw=0)
    for (label, change), colour, dash, marker in zip(changes.items(), COLOURS, DASHES, MARKERS):
        ax.plot(ratio, change, color=colour, linestyle=dash, marker=marker, markevery=4, markersize=5,
                label=label)
    ax.set(xlabel="height of the centre of mass / wheelbase", ylabel="change of total pull (%)")
    ax.legend(loc="lower left", frameon=False, fontsize=8.5)
    return figure


# ---- wheels against measurement (notebook 02) -------------------------------------------------------------

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
    figure, grid = _axes(3, len(titles), figsize=(3.2 * len(titles), 8.2), sharex=True, squeeze=False)
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
    figure, axes = _axes(1, 2, figsize=(9, 3.6))
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
    figure, axes = _axes(1, 2, figsize=(9, 3.6), sharey=True)
    _lines(axes[0], exit_share, sinkage_mm, r"exit angle behind the bottom, $-θ_2/θ_1$ (1)", "sinkage (mm)")
    at_rest = measured.sinkage_mm[measured.slip == 0]
    axes[0].axhline(at_rest.mean(), color=BLACK, linestyle=":", label="measured, slip 0")
    _lines(axes[1], slip, sinkage_by_slip_mm, "slip s", "sinkage (mm)")
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
    figure, axes = _axes()
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
    figure, axes = _axes()
    _lines(axes, factor, sinkage_mm, "factor on the parameter (1)", "sinkage (mm)")
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
    figure, axes = _axes(figsize=(7.4, 4.2))
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


# ---- masses, power and heat (notebooks 03 and 04) ----------------------------------------------------------

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
    figure, ax = _axes(figsize=(7.2, 3.9))
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
    figure, ax = _axes(figsize=(6.4, 4.0))
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
    figure, ax = _axes()
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
    figure, ax = _axes(figsize=(7.2, 4.4))
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
    figure, ax = _axes()
    ax.axhspan(-90, 0, color=GREY, alpha=0.15, lw=0)
    ax.axhline(0, color=BLACK, lw=0.8)
    _lines(ax, time_days, elevation_deg, "Earth days since sunrise", "elevation of the sun (deg)")
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
    figure, ax = _axes()
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
    figure, axes = _axes(2, 2, figsize=(7.4, 4.8), sharex=True, sharey=True)
    for ax, (site, series) in zip(axes.flat, power_w.items()):
        _lines(ax, time_days, series, "", "", legend=False)
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
    figure, axes = _axes(2, 1, figsize=(7.0, 5.2), sharex=True)
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
    figure, ax = _axes()
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
    figure, axes = _axes(1, len(flown), figsize=(6.4, 3.6))
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
    figure, ax = _axes(figsize=(6.8, 4.0))
    ax.axhspan(*limits_c, color=GREY, alpha=0.2, lw=0)
    _lines(ax, heat_w, temperature_c, "heat to radiate (W)", "temperature of the enclosure (degC)",
           legend=False)
    for k, (label, (heat, temperature)) in enumerate(marks.items()):
        ax.plot(heat, temperature, MARKERS[k % len(MARKERS)], color=BLACK, markersize=7,
                markerfacecolor="white",
                label=label)
    ax.set(xlim=(heat_w[0], heat_w[-1]))
    ax.legend(fontsize=8.5)
    return figure


# ---- design your rover (notebook 12) --------------------------------------------------------------------------

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
    figure, ax = _axes(figsize=(6.8, 4.0))
    for i, (label, share) in enumerate(shares.items()):
        ax.plot(mass_kg, 100 * share, color=COLOURS[i % 4], linestyle=DASHES[i % 4], marker=MARKERS[i], markersize=5,
                label=label)
    ax.axhline(100 * wanted, color=GREY, linewidth=1)
    ax.set(xlabel="nominal mass (kg)", ylabel="holds in (% of the draws)", ylim=(-3, 103))
    figure.legend(loc="outside upper center", ncols=2, fontsize=9, frameon=False)
    return figure


# ---- Pareto fronts (notebook 07) ---------------------------------------------------------------------------

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
    figure, ax = _axes()
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
    figure, (ax, right) = _axes(1, 2, figsize=(9.4, 3.8), sharey=True)
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
    figure, (ax, right) = _axes(1, 2, figsize=(9.4, 3.8))
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


def variation_operators(panels):
    """Where the children of a crossover or a mutation fall, against the operator's formula.

    Parameters
    ----------
    panels : dict of str to (ndarray, sequence of float, ndarray, ndarray)
        By title: genes of the children; genes of the parents; where the density is given, and the density.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, axes = _axes(1, len(panels), figsize=(4.7 * len(panels), 3.2), squeeze=False)
    for ax, (title, (children, parents, x, density)) in zip(axes[0], panels.items()):
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
    figure, axes = _axes(1, len(snapshots), figsize=(9.6, 2.9), sharex=True, sharey=True)
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
    figure, axes = _axes(2, 2, figsize=(9.4, 6.6))
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
    figure, axes = _axes(1, 3, figsize=(9.6, 3.1))
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
    figure, axes = _axes(2, 2, figsize=(9.0, 5.6), sharex=True)
    for ax, (title, lines) in zip(axes.flat, histories.items()):
        _lines(ax, {label: np.arange(1, len(y) + 1) for label, y in lines.items()}, lines, "generation",
               "normalised hypervolume", legend=False)
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
    figure, axes = _axes(1, 2, figsize=(9.0, 3.2))
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
    figure, ax = _axes()
    for k, (label, y) in enumerate(histories.items()):
        ax.fill_between(evaluations, y.min(0), y.max(0), color=COLOURS[k], alpha=0.15, lw=0)
        ax.plot(evaluations, y.mean(0), color=COLOURS[k], linestyle=DASHES[k], marker=MARKERS[k],
                markevery=max(len(evaluations) // 6, 1), markersize=5, label=label)
    ax.set(xlabel="evaluations (designs)", ylabel="normalised hypervolume", xscale="log")
    ax.legend(fontsize=9)
    return figure


def seed_scatter(panels, published):
    """One number of each front, seed by seed, beside the paper's.

    Parameters
    ----------
    panels : dict of str to dict of str to ndarray
        By axis label and by title of the front: one value a seed. "(Wh)" makes the axis logarithmic.
    published : dict of str to dict of str to float
        The paper's value, where it gives one.

    Returns
    -------
    matplotlib.figure.Figure
    """
    titles = list(next(iter(panels.values())))
    figure, axes = _axes(1, len(panels), figsize=(9.6, 2.8), sharey=True, squeeze=False)
    for k, (ax, (label, rows)) in enumerate(zip(axes[0], panels.items())):
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
    figure, ax = _axes()
    ax.plot(speed_rad_s, range_km, color=BLUE, label="the longest-range design, hub replaced")
    ax.plot(list(front_range_km), list(front_range_km.values()), "s", color=ORANGE, markersize=8,
            label="longest range of a new front")
    ax.axhline(limit_km, color=GREY, linestyle=":", label="traverse limit of the study")
    ax.axvline(5, color=BLACK, linestyle="--", lw=1, label="default hub, 5 rad/s")
    ax.set(xlabel="no-load speed of the hub (rad/s)", ylabel="range (km)", xlim=(0, None),
           ylim=(0, 1.08 * limit_km))
    ax.legend(fontsize=9, loc="lower right")
    return figure


# ---- rules, sensitivity, rediscovery, ledger (notebooks 08 to 11) ------------------------------------------

def variables_on_fronts(places):
    """Where each variable of each front lies in its searched range: median, and the span of most designs.

    Parameters
    ----------
    places : dict of str to dict of str to ndarray
        By front and by label of the variable: places from 0, the lower bound, to 1, the upper one.

    Returns
    -------
    matplotlib.figure.Figure
        A row a variable. Markers are medians, bars hold the middle 80 % of the front.
    """
    labels = list(next(iter(places.values())))
    figure, ax = _axes(figsize=(7.4, 0.5 * len(labels) + 1))
    rows = np.arange(len(labels))
    ax.hlines(rows[:-1] + 0.5, 0, 1, color=GREY, lw=0.4)
    for i, (front, variables) in enumerate(places.items()):
        low, middle, high = np.array([np.quantile(variables[label], [0.1, 0.5, 0.9]) for label in labels]).T
        y = rows + 0.18 * (i - (len(places) - 1) / 2)
        ax.hlines(y, low, high, color=COLOURS[i % 4], lw=2, linestyle=DASHES[i % 4])
        ax.plot(middle, y, MARKERS[i], color=COLOURS[i % 4], markersize=6, label=front, clip_on=False)
    ax.set_yticks(rows, labels)
    ax.set(xlim=(-0.01, 1.01), ylim=(len(labels) - 0.5, -0.5),
           xlabel="place in the searched range: 0 floor, 1 ceiling")
    ax.grid(False, axis="y")
    figure.legend(loc="outside upper center", ncols=len(places), fontsize=9, frameon=False)
    return figure


def capability_against_width(width_mm, panels):
    """Slope capability against wheel width at equal mass, one panel a load, one line a shear modulus.

    Parameters
    ----------
    width_mm : ndarray
    panels : dict of str to dict of str to ndarray
        By panel title and by line label: slope capability in degrees.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, axes = _axes(1, len(panels), figsize=(4.2 * len(panels), 3.6), sharey=True, squeeze=False)
    for ax, (title, series) in zip(axes[0], panels.items()):
        _lines(ax, width_mm, series, "wheel width (mm)", "slope capability (deg)", legend=False)
        ax.set_title(title, fontsize=10)
    figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside upper center", ncols=4, fontsize=9,
                  frameon=False)
    return figure


def front_points(panels, x_label, y_label, lines=None):
    """Designs of fronts as points, one panel a mission, one marker a case.

    Parameters
    ----------
    panels : dict of str to dict of str to (ndarray, ndarray)
        By panel title and by case: x and y of each design.
    x_label, y_label : str
    lines : dict of str to float, optional
        Horizontal lines with their labels.

    Returns
    -------
    matplotlib.figure.Figure
    """
    columns = min(len(panels), 2)
    rows = -(-len(panels) // columns)
    figure, axes = _axes(rows, columns, figsize=(4.2 * columns, 2.9 * rows), squeeze=False, sharex=True)
    for ax, (title, cases) in zip(axes.flat, panels.items()):
        for i, (label, (x, y)) in enumerate(cases.items()):
            ax.plot(x, y, MARKERS[i], color=COLOURS[i % 4], markersize=4.5,
                    markerfacecolor="none" if i else None, label=label)
        for name, value in (lines or {}).items():
            ax.axhline(value, color=GREY, linestyle=":", lw=1.2)
            ax.annotate(name, (0.99, value), xycoords=("axes fraction", "data"), xytext=(0, -3), va="top",
                        textcoords="offset points", ha="right", fontsize=8, color=GREY)
        ax.margins(y=0.12)
        ax.set_title(title, fontsize=10)
    for ax in axes[-1]:
        ax.set_xlabel(x_label)
    for ax in axes[:, 0]:
        ax.set_ylabel(y_label)
    axes[0, 0].legend(fontsize=8.5)
    return figure


def battery_by_patience(statistics, published_wh):
    """Median battery of fronts against the generations of the search, one line a seed, one panel a mission.

    Parameters
    ----------
    statistics : pandas.DataFrame
        Columns scenario, seed, generations, battery_median_wh.
    published_wh : dict of str to float
        The paper's median, by scenario.

    Returns
    -------
    matplotlib.figure.Figure
        The dotted line is the search floor of 5 Wh.
    """
    names = list(dict.fromkeys(statistics.scenario))
    figure, axes = _axes(1, len(names), figsize=(4.4 * len(names), 3.4), sharey=True, squeeze=False)
    for ax, name in zip(axes[0], names):
        for i, (seed, rows) in enumerate(statistics[statistics.scenario == name].groupby("seed")):
            ax.plot(rows.generations, rows.battery_median_wh, color=BLUE, marker=MARKERS[i % 7], lw=1, ms=5)
        first, ticks = rows.generations.min(), sorted(set(rows.generations))
        ax.plot(first, published_wh[name], "X", color=ORANGE, markersize=11, label="paper, one seed")
        ax.axhline(5, color=GREY, linestyle=":")
        ax.set(title=name.replace("_", " "), xlabel="generations", xscale="log", yscale="log", ylim=(4, 600))
        ax.set_xticks(ticks, [str(g) for g in ticks])
        ax.minorticks_off()
        ax.set_yticks([5, 15, 50, 150, 500], ["5", "15", "50", "150", "500"])
        ax.title.set_size(10)
    axes[0, 0].set_ylabel("median battery of the front (Wh)")
    axes[0, -1].legend(fontsize=9)
    return figure


def battery_worth(capacity_wh, ranges_km, mass_kg):
    """Range and total mass of one rover against its battery, one line an array.

    Parameters
    ----------
    capacity_wh : ndarray
    ranges_km : dict of str to ndarray
        By label of the array.
    mass_kg : ndarray

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, (left, right) = _axes(1, 2, figsize=(8.4, 3.4))
    _lines(left, capacity_wh, ranges_km, "battery capacity (Wh)", "range (km)")
    right.plot(capacity_wh, mass_kg, color=BLACK)
    right.set(xlabel="battery capacity (Wh)", ylabel="total mass (kg)")
    left.set(ylim=(0, None))
    return figure


def rocker_bogie_share(statistics, rigid_limit_m):
    """Share of six-wheeled designs on each front against the required obstacle height.

    Parameters
    ----------
    statistics : pandas.DataFrame
        Columns scenario, obstacle_height_m, four_wheels.
    rigid_limit_m : float
        What the largest wheel of the search climbs on a rigid chassis; drawn as a line.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, ax = _axes(figsize=(6.4, 3.4))
    for i, (name, rows) in enumerate(statistics.groupby("scenario", sort=False)):
        rows = rows.sort_values("obstacle_height_m")
        ax.plot(100 * rows.obstacle_height_m, 100 * (1 - rows.four_wheels), color=COLOURS[i % 4],
                linestyle=DASHES[i % 4], marker=MARKERS[i], markersize=9 - 1.5 * i,
                label=name.replace("_", " "))
    ax.axvline(100 * rigid_limit_m, color=GREY, lw=1)
    ax.annotate("half of the largest radius searched", (100 * rigid_limit_m, 50), xytext=(5, 0),
                textcoords="offset points", fontsize=8.5, color=GREY)
    ax.set(xlabel="required obstacle height (cm)", ylabel="rocker-bogie designs (%)", ylim=(-4, 104))
    ax.legend(fontsize=8.5, loc="center left")
    return figure


def frontiers_by_scale(frontiers):
    """Longest range up to each mass at several shear scales, one panel a mission.

    Parameters
    ----------
    frontiers : dict of str to dict of float to (ndarray, ndarray)
        By mission and by shear scale: mass in kg and range in km, empty where nothing was feasible.

    Returns
    -------
    matplotlib.figure.Figure
        Steps: the longest range of all designs up to that mass.
    """
    figure, axes = _axes(2, 2, figsize=(8.6, 5.8), sharex=True)
    scales = sorted(next(iter(frontiers.values())))
    inks = dict(zip(scales, (BLUE, BLUE, BLACK, ORANGE, ORANGE)))
    dashes = dict(zip(scales, (":", "--", "-", "--", ":")))
    for ax, (title, cases) in zip(axes.flat, frontiers.items()):
        for scale in scales:
            mass, distance = cases[scale]
            if len(mass):
                order = np.argsort(mass)
                best = np.maximum.accumulate(distance[order])
                ax.step([*mass[order], 80], [*best, best[-1]], where="post", color=inks[scale],
                        linestyle=dashes[scale], label=f"{scale:g}", lw=1.8)
            else:
                ax.annotate(f"scale {scale:g}: no feasible design", (0.5, 0.06), xycoords="axes fraction",
                            ha="center", fontsize=8.5, color=inks[scale])
        ax.set(title=title, ylim=(0, None), xlim=(5, 80))
        ax.title.set_size(10)
    for ax in axes[-1]:
        ax.set_xlabel("total mass (kg)")
    for ax in axes[:, 0]:
        ax.set_ylabel("range (km)")
    handles, labels = axes[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, title="factor on the shear stress", loc="outside upper center",
                  ncols=len(scales), fontsize=9, frameon=False)
    return figure


def sobol_bars(indices, labels=None, most=9):
    """Sobol indices as bars, one panel a metric: filled the first order, hollow the total with its interval.

    Parameters
    ----------
    indices : pandas.DataFrame
        Columns metric, input, first_order, total_order, total_low, total_high.
    labels : dict of str to str, optional
        Panel titles by metric.
    most : int
        Inputs shown in each panel, those of the largest total order.

    Returns
    -------
    matplotlib.figure.Figure
    """
    metrics = list(dict.fromkeys(indices.metric))
    figure, axes = _axes(1, len(metrics), figsize=(3.5 * len(metrics), 0.32 * most + 1.1), squeeze=False)
    for ax, metric in zip(axes[0], metrics):
        rows = indices[indices.metric == metric].nlargest(most, "total_order").iloc[::-1]
        y = np.arange(len(rows))
        spread = np.maximum([rows.total_order - rows.total_low, rows.total_high - rows.total_order], 0)
        ax.barh(y, rows.total_order, 0.7, color="none", edgecolor=BLACK, label="total", xerr=spread,
                error_kw=dict(lw=1, ecolor=GREY))
        ax.barh(y, rows.first_order.clip(0), 0.36, color=BLUE, label="first order")
        ax.set_yticks(y, [name.replace("_", " ") for name in rows.input], fontsize=8)
        ax.set(xlim=(0, 1.08), title=(labels or {}).get(metric, metric), xlabel="share of the variance")
        ax.title.set_size(10)
        ax.grid(False, axis="y")
    axes[0, 0].legend(fontsize=8.5, loc="lower right")
    return figure


def pull_intervals(points):
    """Measured pulls and the intervals predicted for them, one panel an experiment.

    Parameters
    ----------
    points : pandas.DataFrame
        From `rdk.rules.interval_coverage`.

    Returns
    -------
    matplotlib.figure.Figure
        Bars are the intervals, ticks on them the nominal pull, markers the measurements.
    """
    names = list(dict.fromkeys(points.experiment))
    figure, axes = _axes(1, len(names), figsize=(4.2 * len(names), 3.6), squeeze=False)
    for ax, name in zip(axes[0], names):
        for i, (wheel, rows) in enumerate(points[points.experiment == name].groupby("wheel")):
            x = rows.slip + 0.008 * (i - 0.5)
            ax.vlines(x, rows.low_n, rows.high_n, color=COLOURS[i], lw=2.5, alpha=0.45)
            ax.plot(x, rows.nominal_n, "_", color=COLOURS[i], markersize=11)
            ax.plot(x, rows.measured_n, MARKERS[i], color=COLOURS[i], markersize=5.5, markerfacecolor="white",
                    label=f"{wheel}, measured")
        ax.axhline(0, color=GREY, lw=0.8)
        ax.set(title=name, xlabel="slip", ylabel="drawbar pull (N)")
        ax.title.set_size(10)
        ax.legend(fontsize=8.5, loc="upper left")
    return figure


def family_rules(statistics, columns):
    """Statistics of fronts over scenario families: one panel a statistic, one dot a scenario of the family.

    Parameters
    ----------
    statistics : pandas.DataFrame
        With a column `family`, and the statistics.
    columns : dict of str to str
        Statistic and its axis label; "(Wh)" makes the axis logarithmic.

    Returns
    -------
    matplotlib.figure.Figure
        Crosses on the left edge count the scenarios without any feasible design.
    """
    names = list(dict.fromkeys(statistics.family))
    figure, axes = _axes(1, len(columns), figsize=(2.6 * len(columns) + 1.2, 2.8), sharey=True, squeeze=False)
    for ax, (column, label) in zip(axes[0], columns.items()):
        for y, name in enumerate(names):
            values = statistics[column][statistics.family == name]
            spread = np.linspace(-0.22, 0.22, len(values))
            ax.plot(values, y + spread, MARKERS[y], color=COLOURS[y % 4], ms=6, markerfacecolor="none")
        ax.set(xlabel=label, ylim=(len(names) - 0.5, -0.5), xscale="log" if "(Wh)" in label else "linear")
        if "(Wh)" not in label and statistics[column].max() <= 100 and "%" in label:
            ax.set_xlim(-6, 106)
    axes[0, 0].set_yticks(range(len(names)), [
        f"{name}\n({n} of {len(statistics[statistics.family == name])} empty)" if (n := int(
            statistics[statistics.family == name].designs.eq(0).sum())) else name for name in names])
    return figure


def rediscovery_distances(found, baselines):
    """Distance of each rover to its front beside what chance gives.

    Parameters
    ----------
    found : pandas.DataFrame
        Columns rover, distance, in_class.
    baselines : pandas.DataFrame
        Columns rover, random_pair, feasible_pair, centroid, nearest_capped, nearest_capped_low.

    Returns
    -------
    matplotlib.figure.Figure
        Bars are the fronts. Open markers: the centroid of feasible designs, and the nearest of as many random
        feasible designs under the same mass ceiling, its bar down to the 5 % quantile.
    """
    table = found.merge(baselines, on="rover")
    figure, ax = _axes(figsize=(7.6, 4))
    x = np.arange(len(table))
    for i, row in enumerate(table.itertuples()):
        ax.bar(i, row.distance, 0.5, color=BLUE if row.in_class else "none", edgecolor=BLUE,
               hatch=None if row.in_class else "//")
    ax.plot(x + 0.05, table.centroid, "D", color=ORANGE, markerfacecolor="none", markersize=8,
            label="centroid of the feasible designs")
    down = [table.nearest_capped - table.nearest_capped_low, 0 * x]
    ax.errorbar(x + 0.33, table.nearest_capped, down, fmt="s", color=BLACK, markerfacecolor="white", capsize=3,
                label="nearest of as many random light designs")
    ax.axhline(table.random_pair.mean(), color=GREY, linestyle="--", lw=1, label="random pair")
    ax.axhline(table.feasible_pair.mean(), color=GREY, linestyle=":", lw=1.4, label="feasible pair")
    ax.set_xticks(x, table.rover)
    ax.set(ylabel="distance in the unit cube", ylim=(0, 1.6))
    ax.bar(0, 0, color=BLUE, label="front (hatched: out of class)")
    ax.legend(fontsize=8.5, ncols=2, loc="upper left")
    ax.grid(False, axis="x")
    return figure


def distance_by_patience(found, baselines):
    """Distance of the rovers to their fronts as the searches go on, beside the nearest random light design.

    Parameters
    ----------
    found : pandas.DataFrame
        Columns rover, generations, distance.
    baselines : pandas.DataFrame
        Columns rover, nearest_capped.

    Returns
    -------
    matplotlib.figure.Figure
        One panel a rover; the dashed line is chance.
    """
    names = list(dict.fromkeys(found.rover))
    figure, axes = _axes(2, -(-len(names) // 2), figsize=(8.6, 4.6), sharex=True, sharey=True)
    for ax, name in zip(axes.flat, names):
        rows = found[found.rover == name]
        ax.plot(rows.generations, rows.distance, color=BLUE, marker="o")
        ax.axhline(baselines.set_index("rover").nearest_capped[name], color=BLACK, linestyle="--", lw=1)
        ax.set(title=name, xscale="log")
        ax.set_xticks(rows.generations, [str(g) for g in rows.generations])
        ax.minorticks_off()
        ax.title.set_size(10)
    for ax in axes[-1]:
        ax.set_xlabel("generations")
    for ax in axes[:, 0]:
        ax.set(ylabel="distance", ylim=(0, 1.05 * found.distance.max()))
    return figure


VERDICTS = {True: ("✓", "agrees"), False: ("✗", "differs"), None: ("–", "reported")}
"""Symbol and word of a row of the ledger."""


def verdict(agrees):
    """Symbol and word for a ledger's `agrees`: yes, no, or nothing asked."""
    return VERDICTS[None if agrees is None or agrees != agrees or str(agrees) == "<NA>" else bool(agrees)]


def ledger_verdicts(ledger):
    """How many numbers of each section of the paper come out again.

    Parameters
    ----------
    ledger : pandas.DataFrame
        From `rdk.validation.paper_ledger`.

    Returns
    -------
    matplotlib.figure.Figure
        Bars with the counts: filled agrees, hatched differs, open reported only.
    """
    words = ledger.agrees.map(lambda x: verdict(x)[1], na_action=None)
    sections = list(dict.fromkeys(ledger.section))
    figure, ax = _axes(figsize=(7.4, 0.36 * len(sections) + 1))
    left = np.zeros(len(sections))
    styles = {"agrees": dict(color=BLUE), "differs": dict(color="white", edgecolor=ORANGE, hatch="///"),
              "reported": dict(color="white", edgecolor=GREY)}
    for word, style in styles.items():
        count = np.array([(words[ledger.section == section] == word).sum() for section in sections])
        ax.barh(sections, count, 0.7, left=left, label=word, **style)
        for y, (start, n) in enumerate(zip(left, count)):
            if n:
                ax.text(start + n / 2, y, str(n), ha="center", va="center", fontsize=9,
                        color="white" if word == "agrees" else BLACK,
                        bbox=None if word == "agrees" else dict(facecolor="white", edgecolor="none", pad=1))
        left += count
    ax.invert_yaxis()
    ax.set(xlabel="numbers of the paper")
    ax.grid(False)
    ax.legend(fontsize=9, loc="lower right")
    return figure


def ledger_text(value):
    """A ledger's value in words: numbers with four digits, pairs as low..high."""
    if isinstance(value, (tuple, list)):
        return "..".join(ledger_text(v) for v in value)
    if isinstance(value, (bool, np.bool_, str)):
        return str(value)
    return f"{float(value):.4g}"


def ledger_html(ledger):
    """A ledger as an HTML table; a symbol and a word, not only the colour, tell the verdict.

    Parameters
    ----------
    ledger : pandas.DataFrame

    Returns
    -------
    str
    """
    import html
    tints = {"agrees": "#e3f0f8", "differs": "#fbe5d8", "reported": "#ffffff"}
    head = "".join(f'<th scope="col" style="text-align:left">{name}</th>' for name in
                   ("", "section", "what", "paper", "ours", "why"))
    body = []
    for row in ledger.itertuples():
        symbol, word = verdict(row.agrees)
        cells = (f"{symbol} {word}", row.section, row.quantity, row.paper, ledger_text(row.ours), row.why)
        tags = "".join(f'<td style="text-align:left;vertical-align:top">{html.escape(str(cell))}</td>'
                       for cell in cells)
        body.append(f'<tr style="background:{tints[word]};color:#000">{tags}</tr>')
    return (f'<table style="border-collapse:collapse;font-size:90%"><caption>{len(ledger)} numbers</caption>'
            f"<thead><tr>{head}</tr></thead><tbody>{''.join(body)}</tbody></table>")


def ledger_filter(ledger):
    """A ledger with menus for section and verdict; without widgets the whole table stands alone.

    Parameters
    ----------
    ledger : pandas.DataFrame

    Returns
    -------
    ipywidgets.VBox
        Its `section` and `verdict` are the menus, `shown` the rows that they leave, `table` the HTML.
    """
    import ipywidgets as widgets

    class LedgerFilter(widgets.VBox):
        def _repr_mimebundle_(self, **options):
            bundle = super()._repr_mimebundle_(**options)
            return {**bundle, "text/plain": f"{len(self.shown)} numbers of the paper", "text/html": self.table.value}

    section = widgets.Dropdown(options=["all", *dict.fromkeys(ledger.section)], description="section")
    known = [word for _, word in VERDICTS.values()]
    choice = widgets.Dropdown(options=["all", *known], description="verdict")
    box = LedgerFilter([widgets.HBox([section, choice]), widgets.HTML()])
    box.section, box.verdict, box.table = section, choice, box.children[1]
    words = ledger.agrees.map(lambda x: verdict(x)[1], na_action=None)

    def show(change=None):
        keep = (section.value == "all") | (ledger.section == section.value)
        box.shown = ledger[keep & ((choice.value == "all") | (words == choice.value))]
        box.table.value = ledger_html(box.shown)

    for menu in (section, choice):
        menu.observe(show, "value")
    show()
    return box
