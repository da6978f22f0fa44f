"""Figures of the wheel on soil (notebook 01)."""
from __future__ import annotations

import numpy as np

from rdk.figures import BLACK, BLUE, COLOURS, DASHES, GREY, MARKERS, ORANGE, panels, curves


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
    figure, axes = panels()
    curves(depth_mm, pressure_kpa, "sinkage z (mm)", "pressure p (kPa)", axes=axes)
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
    figure, axes = panels()
    curves(displacement_mm, shear_kpa, "shear displacement j (mm)", "shear stress τ (kPa)", axes=axes)
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
    figure, axes = panels()
    curves(angle_deg, {"normal stress σ": normal_kpa, "shear stress τ": shear_kpa},
           "angle θ from the downward vertical (deg)", "stress (kPa)", axes=axes)
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
    figure, all_axes = panels(1, len(cases), figsize=(3.2 * len(cases), 3.3), squeeze=False, sharey=True)

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
    figure, axes = panels()
    curves(points, {label: np.maximum(error, 1e-16) for label, error in errors.items()},
           "evaluations of the stress", "relative error", legend=False, axes=axes)
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
    figure, axes = panels(1, 3, figsize=(9.6, 3.4))
    for panel, field, factor, y_label in zip(axes, ("drawbar_pull_n", "torque_nm", "sinkage_m"), (1, 1, 1000),
                                             ("drawbar pull (N)", "torque (N m)", "sinkage (mm)")):
        curves(slip, {label: factor * getattr(f, field) for label, f in cases.items()}, "slip s",
               y_label, legend=panel is axes[0], axes=panel)
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
    figure, axes = panels(1, 2, figsize=(8.4, 3.4))
    for panel, i, y_label in zip(axes, (0, 1), ("drawbar pull over load", "sinkage (mm)")):
        curves(size_mm, {label: case[i] for label, case in cases.items()}, "size (mm)", y_label, axes=panel)
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
    figure, axes = panels()
    curves(slip, {**parts_w, "torque × speed − pull × speed": total_w}, "slip s",
           "power into the soil (W)", axes=axes)
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
    figure, axes = panels()
    curves(load_n, sinkage_mm, "load on the wheel (N)", "sinkage (mm)", axes=axes)
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
    figure, axes = panels(figsize=(5.6, 4.2))
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
