"""Pictures of notebook 13: a rover on a slope with the force on each pair of wheels, and masses with intervals."""
import numpy as np
from matplotlib.patches import Circle

from rdk import stability
from rdk.figures import BLACK, BLUE, GREEN, GREY, ORANGE, panels

SOIL = "#e8e2d8"


def loads_on_slope(slope_deg, centre_height_m, wheelbase_m, *, radius_m=0.1, figure=None):
    """Four and six wheels on one slope: the plumb line of the centre of mass, and what each pair carries and pulls.

    Returns the figure, and the loads of four and of six wheels over the weight, uphill first.
    """
    figure, axes = panels(1, 2, figure=figure, figsize=(9.4, 4.4))
    turn, reach = np.radians(slope_deg), 0.9
    along, up = np.array([np.cos(turn), np.sin(turn)]), np.array([-np.sin(turn), np.cos(turn)])
    shares = []
    for ax, count in zip(axes, (4, 6)):
        loads = stability.axle_loads(1.0, wheelbase_m, centre_height_m, slope_deg, wheel_count=count,
                                     pivot_height_m=radius_m, gravity_m_s2=1.0)
        share = [load for load in (float(load) for load in loads) if not np.isnan(load)]
        shares.append(share)
        centre = centre_height_m * up
        ends = np.array([-reach * along, reach * along])
        ax.fill_between(ends[:, 0], ends[:, 1], -1.0, color=SOIL, lw=0)
        ax.plot(*ends.T, color=BLACK, lw=1)
        places = np.linspace(wheelbase_m / 2, -wheelbase_m / 2, len(share))
        for place, load in zip(places, share):
            foot = place * along
            ax.add_patch(Circle(foot + radius_m * up, radius_m, fc="white", ec=BLACK, lw=1.8, zorder=2))
            if load > 1e-9:
                _force(ax, foot - 0.4 * load * up, foot, BLUE)
                _force(ax, foot, foot + 0.4 * load * np.tan(turn) * along, ORANGE)
            ax.text(*(foot - (0.4 * max(load, 0) + 0.05) * up), f"{load:.2f}" if load > 1e-9 else "lifts", fontsize=9,
                    color=BLUE, ha="center", va="center", zorder=6)
        belly = (1.2 if count == 4 else 2.0) * radius_m
        top = max(2 * centre_height_m - belly, belly + 0.05)
        box = [x * wheelbase_m / 2 * along + y * up for x, y in ((-1, belly), (1, belly), (1, top), (-1, top))]
        ax.fill(*np.transpose(box), facecolor="white", edgecolor=BLACK, lw=1.8, zorder=1)
        if count == 6:                                   # rocker from the rear wheel to the bogie's pivot
            pivot = wheelbase_m / 4 * along + radius_m * up
            hubs = [place * along + radius_m * up for place in places]
            ax.plot(*np.transpose([hubs[2], belly * up, pivot]), color=GREY, lw=3, zorder=1.5)
            ax.plot(*np.transpose([hubs[0], hubs[1]]), color=BLACK, lw=3, zorder=2.5)
            ax.plot(*pivot, "o", color=BLACK, ms=6, zorder=4)
        ax.plot(*centre, "o", color=BLACK, ms=8, zorder=6)
        _force(ax, centre, centre - np.array([0, 0.4]), BLACK)
        ax.text(centre[0] + 0.03, centre[1] - 0.5, "$m g$", fontsize=11, zorder=6)
        ax.plot([centre[0]] * 2, [centre[1] - 0.4, -1.0], color=GREY, lw=1, linestyle=":", zorder=3)
        ax.set(xlim=(-0.62, 0.62), ylim=(-0.6, 0.75), aspect="equal")
        ax.set_title("four wheels, rigid" if count == 4 else "six wheels, rocker-bogie", fontsize=10)
        ax.axis("off")
    return figure, shares


def _force(ax, start, end, color):
    ax.annotate("", end, start, zorder=5, arrowprops=dict(arrowstyle="-|>", color=color, lw=2, shrinkA=0, shrinkB=0,
                                                          mutation_scale=13))


def mass_intervals(masses):
    """The interval of each rover's mass beside the published value; hollow where it falls outside."""
    figure, ax = panels(figsize=(7.6, 5.6))
    at = np.arange(len(masses))[::-1]
    for y, row in zip(at, masses.itertuples()):
        ax.plot([row.low_kg, row.high_kg], [y, y], color=BLUE if row.table == "rovers.csv" else GREEN,
                lw=9 if row.table == "rovers.csv" else 4, alpha=0.5, solid_capstyle="butt")
        ax.plot([row.median_kg] * 2, [y - 0.25, y + 0.25], color=BLACK, lw=1.2)
        ax.plot(row.published_mass_kg, y, "D", color=ORANGE, mfc=ORANGE if row.inside else "white", mew=1.6, ms=7)
    ax.axhline(at[masses.in_class.to_numpy()].min() - 0.5, color=GREY, lw=1, linestyle="--")
    ax.set(xscale="log", xlabel="mass (kg)", yticks=at, xlim=(4, 450))
    ax.set_yticklabels([f"{row.rover} ({row.known})" for row in masses.itertuples()], fontsize=9)
    ax.set_xticks([5, 10, 20, 50, 100, 200, 400], ["5", "10", "20", "50", "100", "200", "400"])
    ax.minorticks_off()
    return figure
