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
    axes.annotate("θ_m", (transition_deg, 0.94), xycoords=("data", "axes fraction"), xytext=(4, 0),
                  textcoords="offset points", color=GREY)
    return figure


def stress_on_rim(radius_m, cases, arrows=11):
    """The stresses drawn to scale on the lower rim of a wheel that drives to the right, one panel a case.

    The blue area outside the rim is the normal stress, its arrows push on the wheel. The orange arrows inside
    the rim are the shear stress on the wheel, along the rim. One stress scale holds for all panels. Short
    lines mark the entry angle (1), the transition angle (m) and the exit (2).

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
    highest = max(np.max(np.hypot(s.normal_stress_pa, s.shear_stress_pa)) for _, s in cases.values()) / 1000
    scale = 0.3 * r / highest                                            # mm of drawing a kPa
    figure, all_axes = _axes(1, len(cases), figsize=(3.1 * len(cases) + 0.4, 3.4), squeeze=False, sharey=True)
    deep = max(r * (1 - np.cos(angle[-1])) for angle, _ in cases.values())
    for axes, (label, (angle, stress)) in zip(all_axes[0], cases.items()):
        sigma, tau = stress.normal_stress_pa / 1000 * scale, stress.shear_stress_pa / 1000 * scale
        entry = angle[-1]
        ground, rut = -r * np.cos(entry), -r
        axes.fill([-2 * r, 0, *(r * np.sin(angle)), 2 * r, 2 * r, -2 * r],
                  [rut, rut, *(-r * np.cos(angle)), ground, -2 * r, -2 * r], color="#e8e2d8", zorder=0)
        rim = np.linspace(-np.pi / 2, np.pi / 2, 181)
        axes.plot(r * np.sin(rim), -r * np.cos(rim), color=BLACK, linewidth=1.5)
        outside = r + sigma
        axes.fill([*(r * np.sin(angle)), *(outside * np.sin(angle))[::-1]],
                  [*(-r * np.cos(angle)), *(-outside * np.cos(angle))[::-1]], color=BLUE, alpha=0.25,
                  linewidth=0)
        axes.plot(outside * np.sin(angle), -outside * np.cos(angle), color=BLUE, linewidth=1.5)
        at = np.linspace(0, entry, arrows + 2)[1:-1]
        push, drag = np.interp(at, angle, sigma), np.interp(at, angle, tau)
        sin, cos, options = np.sin(at), np.cos(at), dict(angles="xy", scale_units="xy", scale=1, width=0.006)
        axes.quiver((r + push) * sin, -(r + push) * cos, -push * sin, push * cos, color=BLUE, **options)
        axes.quiver(0.95 * r * sin, -0.95 * r * cos, drag * cos, drag * sin, color=ORANGE, **options)
        for angle_mark, name in ((entry, "1"), (float(stress.transition_angle_rad.flat[0]), "m"), (0, "2")):
            tick = np.array([0.74, 0.88]) * r
            axes.plot(tick * np.sin(angle_mark), -tick * np.cos(angle_mark), color=BLACK, linewidth=1)
            axes.text(0.68 * r * np.sin(angle_mark), -0.68 * r * np.cos(angle_mark), f"θ$_{name}$",
                      ha="center", va="center", fontsize=9)
        axes.set(xlim=(-0.45 * r, 0.85 * r), ylim=(-1.4 * r, min(-0.55 * r, -r + deep + 0.45 * r)),
                 aspect="equal", title=label, xlabel="forward (mm)")
        axes.title.set_size(10)
        axes.grid(False)
    all_axes[0, 0].set_ylabel("height (mm), hub at 0")
    bar = 10.0 ** np.floor(np.log10(highest))
    axes = all_axes[0, 0]
    axes.plot([-0.38 * r, -0.38 * r + bar * scale], [-1.33 * r] * 2, color=BLACK, linewidth=3)
    axes.text(-0.38 * r + bar * scale + 0.03 * r, -1.33 * r, f"{bar:g} kPa", va="center", fontsize=9)
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
           "evaluations of the stress", "relative error")
    for line, marker in zip(axes.get_lines(), MARKERS):
        line.set(marker=marker, markersize=5)
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
