"""Pictures of notebooks 14 and 15: the sun at the pole, skylines, maps and ways, and a march."""
import numpy as np

from rdk.figures import BLACK, BLUE, COLOURS, DASHES, GREEN, GREY, MARKERS, ORANGE, panels


def polar_sun():
    """Why the sun circles along the horizon of the pole: the tilt of the axis, larger than it is.

    Returns
    -------
    matplotlib.figure.Figure
        Left the Moon from the side in southern summer, right what a person at the pole sees.
    """
    figure, (left, right) = panels(1, 2, figsize=(7.6, 3.2), gridspec_kw=dict(width_ratios=(1.25, 1)))
    angle, tilt = np.linspace(0, 2 * np.pi, 200), np.radians(12)
    left.fill(np.cos(angle), np.sin(angle), facecolor="#ececec", edgecolor=BLACK, lw=1.2)
    axis = np.array([-np.sin(tilt), -np.cos(tilt)])      # towards the south pole, which leans to the sun
    axis = axis * [-1, 1]
    left.plot(*np.outer(axis, [-1.35, 1.35]), color=BLACK, lw=1, linestyle="-.")
    left.plot(*axis, marker="o", color=ORANGE)
    left.annotate("south pole", axis, (0.15, -1.42), fontsize=9)
    for y in (-0.75, 0, 0.75):
        left.annotate("", (1.15, y), (2.2, y), arrowprops=dict(arrowstyle="->", color=ORANGE, lw=1.6))
    left.text(1.65, 0.12, "sunlight", ha="center", fontsize=9)
    east = np.array([-axis[1], axis[0]])                 # along the ground at the pole
    left.plot(*(axis[:, None] + np.outer(east, [-0.7, 0.9])), color=BLUE, lw=1.4)
    left.text(-1.45, -1.12, "horizon", fontsize=9, color=BLUE)
    left.set(xlim=(-1.5, 2.4), ylim=(-1.6, 1.5), aspect="equal", title="from the side (tilt drawn 8 times too large)")
    left.axis("off")
    azimuth = np.linspace(0, 360, 200)
    for level, label, dash in ((1.5, "summer", "-"), (0.0, "equinox", "--"), (-1.5, "winter", ":")):
        right.plot(azimuth, level + 0 * azimuth, color=ORANGE, linestyle=dash)
        right.text(8, level + 0.12, label, fontsize=9)
    right.axhspan(-3, 0, color=GREY, alpha=0.2, lw=0)
    right.annotate("once round in 29.5 days", (250, 1.5), (60, 2.35), fontsize=9,
                   arrowprops=dict(arrowstyle="->", color=BLACK))
    right.set(ylim=(-3, 3), xlim=(0, 360), xticks=np.arange(0, 361, 90), xlabel="azimuth (deg)",
              ylabel="elevation of the sun (deg)", title="from the pole")
    for ax in (left, right):
        ax.title.set_fontsize(10)
    return figure


def line_of_sight():
    """The angle under which an eye sees a far mountain over the curve of the Moon.

    Returns
    -------
    matplotlib.figure.Figure
        The symbols of the formula: r and r_eye from the Moon's centre, the arc g between them.
    """
    figure, ax = panels(figsize=(6.8, 3.4))
    g = np.radians(np.linspace(-6, 34, 200))
    radius = 10 + 0.25 * np.exp(-((np.degrees(g) - 2) / 3)**2) + 1.2 * np.exp(-((np.degrees(g) - 24) / 2.2)**2)
    ax.fill(np.r_[radius * np.sin(g), 0], np.r_[radius * np.cos(g), 0], facecolor="#ececec", edgecolor="none")
    ax.plot(radius * np.sin(g), radius * np.cos(g), color=BLACK, lw=1.4)
    eye, top = np.array([0.35, 10.6]), 11.2 * np.array([np.sin(np.radians(24)), np.cos(np.radians(24))])
    ax.plot(*np.c_[[0, 0], eye], color=GREY, lw=1)
    ax.plot(*np.c_[[0, 0], top], color=GREY, lw=1)
    ax.plot(*np.c_[eye, eye + 1.12 * (top - eye)], color=ORANGE)
    ax.plot(*np.c_[eye, eye + [4.6, -0.15]], color=BLUE, linestyle="--")
    ax.plot(*eye, marker="o", color=BLACK)
    ax.text(*(eye + [-0.4, 0.12]), "eye", fontsize=9)
    ax.text(3.9, 10.62, "level", fontsize=9, color=BLUE)
    ax.text(*(top + [0.12, 0.08]), "far mountain", fontsize=9)
    ax.text(2.0, 10.12, "elevation (here below 0)", fontsize=9, color=ORANGE)
    ax.text(0.25, 8.3, r"$r_\mathrm{eye}$", fontsize=11)
    ax.text(3.35, 8.3, "$r$", fontsize=11)
    ax.text(1.5, 7.65, "$g$", fontsize=11)
    arc = np.radians(np.linspace(2, 24, 40))
    ax.plot(7.9 * np.sin(arc), 7.9 * np.cos(arc), color=GREY, lw=1)
    ax.set(xlim=(-1.0, 6.2), ylim=(7.4, 11.3), aspect="equal")
    ax.axis("off")
    return figure


def skyline_and_sun(figure, skyline, elevation_deg, azimuth_deg, now=0):
    """A skyline, and the sun's track above and below it.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
        Empty; drawn into.
    skyline : Skyline
    elevation_deg, azimuth_deg : ndarray
        The track, of one turn.
    now : int
        Index of the hour at which the sun's disc is drawn.
    """
    ax = figure.add_axes((0.11, 0.14, 0.86, 0.8))
    ax.fill_between(skyline.azimuth_deg, skyline.elevation_deg, -6, color="#bdbdbd", lw=0)
    ax.plot(skyline.azimuth_deg, skyline.elevation_deg, color=BLACK, lw=1.2)
    order = np.argsort(azimuth_deg)
    ax.plot(azimuth_deg[order], elevation_deg[order], color=ORANGE, linestyle="--")
    ax.plot(azimuth_deg[now], elevation_deg[now], marker="o", markersize=9, color=ORANGE, markeredgecolor=BLACK)
    ax.axhline(0, color=BLUE, lw=0.8)
    ax.set(xlim=(0, 360), ylim=(-5, 5), xticks=np.arange(0, 361, 90), xlabel="azimuth, clockwise from north (deg)",
           ylabel="elevation (deg)")
    return ax


def shares_of_light(labels, shares, heights_m):
    """Share of time lit at each site, a marker a height above ground.

    Parameters
    ----------
    labels : sequence of str
    shares : ndarray, shape (sites, heights)
        In percent.
    heights_m : sequence of float
    """
    figure, ax = panels(figsize=(7.0, 0.32 * len(labels) + 1.2))
    rows = np.arange(len(labels))
    ax.hlines(rows, shares.min(1), shares.max(1), color=GREY, lw=1)
    for k, height in enumerate(heights_m):
        ax.plot(shares[:, k], rows, linestyle="none", marker=MARKERS[k], color=COLOURS[k], label=f"{height:g} m up",
                fillstyle="none" if k == 1 else "full")
    ax.set(yticks=rows, yticklabels=labels, xlim=(-2, 100), xlabel="lit, 19 years (%)")
    ax.invert_yaxis()
    ax.legend(loc="upper left", fontsize=9)
    return figure


def slope_and_tilt():
    """Tilt of the ground, and the slope of a way across it.

    Returns
    -------
    matplotlib.figure.Figure
        A way straight up has the slope of the tilt; one along the contour has none, but the rover leans all the same.
    """
    figure, ax = panels(figsize=(6.0, 3.0))
    corners = np.array([[0, 0], [4, 0.4], [5.4, 2.4], [1.4, 2.0]])
    ax.fill(*corners.T, facecolor="#ececec", edgecolor=BLACK)
    for part in (0.25, 0.5, 0.75):
        left, right = corners[0] + part * (corners[3] - corners[0]), corners[1] + part * (corners[2] - corners[1])
        ax.plot(*np.c_[left, right], color=GREY, lw=0.8)
    ways = (((1.7, 0.3), (2.95, 2.05), ORANGE, "-", "straight up: slope = tilt"),
            ((1.4, 0.55), (4.3, 1.75), BLUE, "--", "aslant: slope < tilt"),
            ((0.9, 1.08), (4.2, 1.42), GREEN, ":", "along the contour: slope 0"))
    for start, end, colour, dash, _ in ways:
        ax.annotate("", end, start, arrowprops=dict(arrowstyle="-|>", color=colour, lw=2, linestyle=dash))
    for row, (*_, colour, dash, words) in enumerate(ways):
        ax.plot([5.9, 6.5], [2.2 - 0.5 * row] * 2, color=colour, linestyle=dash, lw=2)
        ax.text(6.6, 2.2 - 0.5 * row, words, va="center", fontsize=9)
    ax.text(0.25, -0.25, "contours", fontsize=9, color=GREY)
    ax.set(xlim=(-0.2, 9.8), ylim=(-0.4, 2.7), aspect="equal")
    ax.axis("off")
    return figure


def ways_on_a_map(figure, terrain, ways, start, goal, shut=None):
    """A shaded map with ways on it; hatched where the ground is shut.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
        Empty; drawn into.
    terrain : Terrain
    ways : dict of str to ndarray
        Label -> cells (row, column).
    start, goal : (row, column)
    shut : ndarray of bool, optional
    """
    ax = figure.add_axes((0.02, 0.05, 0.96, 0.85))
    ax.imshow(terrain.hillshade(), cmap="gray", vmin=0, vmax=1, interpolation="nearest")
    if shut is not None and shut.any():
        ax.contourf(shut, levels=[0.5, 1.5], colors="none", hatches=["////"])
        ax.contour(shut, levels=[0.5], colors=[BLACK], linewidths=0.6)
    for i, (label, cells) in enumerate(ways.items()):
        if len(cells):                                   # one below the other: ways that coincide both show
            ax.plot(cells[:, 1], cells[:, 0], color="white", lw=4, zorder=1.9)
            ax.plot(cells[:, 1], cells[:, 0], color=COLOURS[i], linestyle=DASHES[i], lw=2.2, label=label)
    for (row, column), marker, label in ((start, "o", "start"), (goal, "*", "goal")):
        ax.plot(column, row, marker=marker, markersize=11, color=ORANGE, markeredgecolor=BLACK, linestyle="none",
                label=label)
    ax.set(xticks=[], yticks=[])
    figure.legend(loc="upper center", ncols=4, fontsize=8.5, frameon=False)
    return ax


def marches(runs, way, rest_soc=0.5):
    """Distance and charge of marches against time, and the profile of the way beside them.

    Parameters
    ----------
    runs : dict of str to (March, float)
        Label -> a march of one rover, and its battery in Wh.
    way : Way
    rest_soc : float
        Drawn as a line.
    """
    figure, axes = panels(2, 1, figsize=(6.8, 4.6), sharex=True)
    for i, (label, (run, capacity_wh)) in enumerate(runs.items()):
        style = dict(color=COLOURS[i], linestyle=DASHES[i])
        axes[0].plot(run.time_h, run.distance_m, label=label, **style)
        axes[1].plot(run.time_h, run.stored_wh / capacity_wh, **style)
        end = np.argmax(run.distance_m >= run.distance_m[-1])
        fate = "*" if np.isfinite(run.arrival_h) else "X"
        axes[0].plot(run.time_h[end if fate == "*" else -1], run.distance_m[-1], marker=fate, markersize=10,
                     color=COLOURS[i], markeredgecolor=BLACK, clip_on=False, zorder=3)
    axes[0].axhline(way.distance_m[-1], color=GREY, lw=0.8)
    axes[1].axhline(rest_soc, color=GREY, lw=0.8)
    axes[0].set(ylabel="distance (m)", ylim=(0, None))
    axes[1].set(xlabel="time since the start (h)", ylabel="state of charge", ylim=(0, 1.05), xlim=(0, None))
    axes[0].legend(fontsize=9, loc="lower right")
    return figure
