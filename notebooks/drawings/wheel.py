"""Pictures of wheels and their measurements that are too long for a cell (notebooks 00 to 02)."""
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patches import Arc

from rdk.figures import BLACK, BLUE, COLOURS, DASHES, GREY, MARKERS, ORANGE, panels

TESTS = {"ding-2011": "Ding 2011", "hurrell-2025": "Hurrell 2025", "wang-han-2016": "Wang & Han 2016"}
WHEELS = {"smooth": (BLUE, "-", "o"), "grousered": (ORANGE, "--", "s")}


def sunk_wheel(design, performance, slope_deg=0.0, figure=None):
    """One wheel from the side, to scale, sunk into the slope as far as the evaluator says; the rut stays behind."""
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
    ax.add_patch(Arc(turned(0, centre), r, r, theta1=30 + slope_deg, theta2=150 + slope_deg, color=BLACK, lw=1.2))
    tip, tail = (turned(0.5 * r * np.sin(a), centre + 0.5 * r * np.cos(a)) for a in np.radians([62, 50]))
    ax.annotate("", tip, tail, arrowprops=dict(arrowstyle="-|>", color=BLACK, lw=1.2))   # it drives to the right
    ax.text(*turned(-2.0 * r, 0.12 * r), "undisturbed surface", fontsize=8, color=ORANGE, rotation=slope_deg,
            rotation_mode="anchor", ha="left", va="bottom")
    ax.set(xlim=(-2.2 * r, 2.2 * r), ylim=(-1.1 * r, 2.2 * r), aspect="equal", xticks=[], yticks=[])
    ax.spines[:].set_visible(True)
    fate = "stalls" if performance.stalled else f"drives {performance.range_km:.0f} km"
    figure.suptitle(f"{performance.total_mass_kg:.1f} kg on {slope_deg:g}°: "
                    f"sinks {1000 * sinkage:.1f} mm, slip {performance.slip:.2f}, {fate}", fontsize=10)
    return figure


def stress_on_rim(radius_m, cases, figure=None, highest=None):
    """The stresses (label -> angles in rad, ContactStress) to scale on the rim of a wheel that drives to the right.

    Blue, outside: normal stress. Orange, hatched, inside: shear stress, with arrows the way it pulls the rim. Ticks
    mark entry (1), transition (m) and exit (2). `highest` fixes the scale, for live pictures.
    """
    r = 1000 * radius_m
    highest = highest or max(np.max(abs(np.array(stress[:2]))) for _, stress in cases.values()) / 1000
    widest = max(angle[-1] for angle, _ in cases.values()) if highest is None else 0.5
    scale = 0.8 * r * np.sin(widest) / highest                           # mm of drawing a kPa
    figure, all_axes = panels(1, len(cases), figure=figure, figsize=(3.2 * len(cases), 3.3), squeeze=False, sharey=True)

    def at(radius, angle):                                               # the hub is the origin
        return radius * np.sin(angle), -radius * np.cos(angle)

    for axes, (label, (angle, stress)) in zip(all_axes[0], cases.items(), strict=True):
        sigma, tau = stress.normal_stress_pa / 1000 * scale, stress.shear_stress_pa / 1000 * scale
        x, y = at(r, angle)
        axes.fill([-r, *x, 2 * r, 2 * r, -r], [-r, *y, y[-1], -2 * r, -2 * r], color="#e8e2d8", zorder=0)
        for offset, colour, style in ((sigma, BLUE, dict(facecolor=BLUE, alpha=0.25)),
                                      (-abs(tau), ORANGE, dict(facecolor="none", hatch="////"))):
            edge = at(r + offset, angle)
            axes.fill([*x, *edge[0][::-1]], [*y, *edge[1][::-1]], linewidth=0, edgecolor=colour, **style)
            axes.plot(*edge, color=colour, linewidth=1.5)
        axes.plot(*at(r, np.linspace(-np.pi / 2, np.pi / 2, 181)), color=BLACK, linewidth=1.5)
        spots = np.linspace(0, angle[-1], 13)[1:-1]
        options = dict(angles="xy", scale_units="xy", scale=1, width=0.006)
        push = np.interp(spots, angle, sigma)
        axes.quiver(*at(r + push, spots), *at(-push, spots), color=BLUE, **options)
        spots = spots[1::3]
        drag, length = np.interp(spots, angle, tau), 0.08 * r
        start = at(r - abs(drag) / 2, spots - np.sign(drag) * length / 2 / r)
        axes.quiver(*start, np.sign(drag) * length * np.cos(spots), np.sign(drag) * length * np.sin(spots),
                    color=BLACK, **options, zorder=3)
        axes.plot([0, 0], [-0.6 * r, -r], color=GREY, linewidth=1, zorder=0)     # the downward vertical
        for mark, name in ((angle[-1], "1"), (np.ravel(stress.transition_angle_rad)[0], "m"), (0, "2")):
            axes.plot(*at(np.array([0.73, 1.0]) * r, mark), color=BLACK, linewidth=1)
            axes.text(*at(0.68 * r, mark), f"θ$_{name}$", ha="center", va="center", fontsize=9)
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


def load_and_pull(cases, weight_n, slope_deg):
    """Pull against load as a wheel sinks (label -> loads, pulls), and the circle of what its weight asks.

    Where both meet, the wheel carries w cos(slope) and pulls w sin(slope): the slope is the angle of that point.
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


def single_wheel_comparison(points, lines):
    """Measured points of pull, sinkage and torque over the kernel's curves, one column a test.

    Both are tables of `validation`: of `single_wheel` and of `single_wheel_curves`.
    """
    tests = points.experiment.unique()
    figure, grid = panels(3, len(tests), figsize=(3.2 * len(tests), 8.2), sharex=True, squeeze=False)
    quantities = {"drawbar_pull_n": "drawbar pull (N)", "sinkage_mm": "sinkage (mm)", "torque_nm": "torque (N m)"}
    for column, test in enumerate(tests):
        grid[0, column].set_title(TESTS.get(test, test), fontsize=11)
        grid[2, column].set_xlabel("slip s")
        for axes, (quantity, y_label) in zip(grid[:, column], quantities.items(), strict=True):
            for wheel, (colour, dash, marker) in WHEELS.items():
                lane = lines[(lines.experiment == test) & (lines.wheel == wheel)]
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
    """Signed errors of the kernel against slip: pull in % of the load, sinkage in mm; open markers: smooth wheels."""
    figure, axes = panels(1, 2, figsize=(9, 3.6))
    for i, test in enumerate(points.experiment.unique()):
        for wheel in WHEELS:
            lane = points[(points.experiment == test) & (points.wheel == wheel)]
            pull = 100 * (lane.model_drawbar_pull_n - lane.drawbar_pull_n) / lane.vertical_load_n
            style = dict(color=COLOURS[i], marker=MARKERS[i], linewidth=0.8, linestyle=":",
                         markerfacecolor="none" if wheel == "smooth" else COLOURS[i])
            axes[0].plot(lane.slip, pull, label=f"{TESTS.get(test, test)}, {wheel}" if len(lane) else None, **style)
            axes[1].plot(lane.slip, lane.model_sinkage_mm - lane.sinkage_mm, **style)
    for panel, y_label in zip(axes, ("error in pull (% of the load)", "error in sinkage (mm)"), strict=True):
        panel.set(xlabel="slip s", ylabel=y_label)
        panel.axhline(0, color=GREY, linewidth=1)
    figure.legend(loc="outside upper center", ncols=3, frameon=False, fontsize=9)
    return figure


def median_spread(spreads):
    """Medians of |error| as printed, with bars from 5 to 95 % of the bootstrap (label -> `bootstrap_medians`)."""
    figure, axes = panels(figsize=(7.4, 4.2))
    for i, (label, table) in enumerate(spreads.items()):
        row = np.arange(len(table))[::-1] - 0.3 * i
        axes.hlines(row, table.low_pct, table.high_pct, color=COLOURS[i], linestyle=DASHES[i], linewidth=2.2,
                    label=label)
        axes.plot(table.median_abs_error_pct, row, MARKERS[i], color=COLOURS[i])
    names = [f"{TESTS.get(test, test)}, {quantity.replace('_', ' ')}" for test, quantity in
             zip(table.experiment, table.quantity, strict=True)]
    axes.set_yticks(np.arange(len(table))[::-1] - 0.15 * (len(spreads) - 1), names)
    axes.set(xscale="log", xlabel="median of |error| (%)")
    axes.set_xticks([3, 10, 30, 100, 300], ["3", "10", "30", "100", "300"])
    axes.minorticks_off()
    figure.legend(loc="outside upper center", ncols=2, frameon=False, fontsize=9)
    return figure
