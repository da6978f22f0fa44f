"""Drawings of things before their formulas, by one hand: the rover, the wheel, the rig, sky and box, the slope."""
import numpy as np
from matplotlib.patches import Arc, FancyBboxPatch

from rdk.figures import BLACK, BLUE, GREY, ORANGE, panels

SOIL = "#e8e2d8"


def _sheet(width, height, *views):
    """Axes without ticks, one for each view (x from, x to, y from, y to), at one scale."""
    figure, axes = panels(1, len(views), figsize=(width, height), squeeze=False,
                          gridspec_kw={"width_ratios": [view[1] - view[0] for view in views]})
    for ax, view in zip(axes[0], views, strict=True):
        ax.set(xlim=view[:2], ylim=view[2:], aspect="equal")
        ax.axis("off")
    return figure, axes[0]


def _arrow(ax, start, end, text="", at=None, color=BLACK, width=2.0, style="-|>"):
    """A force or a direction, with its letter beside the tip or at `at`."""
    ax.annotate("", end, start, zorder=5, arrowprops=dict(arrowstyle=style, color=color, lw=width, shrinkA=0, shrinkB=0,
                                                          mutation_scale=14))
    ax.text(*(end if at is None else at), text, fontsize=11, ha="center", va="center", color=color, zorder=6)


def _name(ax, thing, text, at):
    """The name of a part, with a thin line to it."""
    ax.annotate(text, thing, at, fontsize=9.5, ha="center", va="center", zorder=6,
                arrowprops=dict(arrowstyle="-", color=GREY, lw=0.9, shrinkB=0), bbox=dict(fc="white", lw=0, pad=1))


def _angle(ax, centre, radius, start_deg, end_deg, text, out=1.25):
    """An angle from one direction to another, counted from the right, with its letter outside the arc."""
    ax.add_patch(Arc(centre, 2 * radius, 2 * radius, theta1=start_deg, theta2=end_deg, color=BLACK, lw=1.2, zorder=5))
    middle = np.radians((start_deg + end_deg) / 2)
    ax.text(centre[0] + out * radius * np.cos(middle), centre[1] + out * radius * np.sin(middle), text, fontsize=11,
            ha="center", va="center", zorder=6)


def _wheel(ax, centre, radius, ribs=14, height=0.15, fill="white"):
    ax.add_patch(_disc(centre, radius, fc=fill, ec=BLACK, lw=1.8, zorder=3))
    angle = np.arange(ribs) * 2 * np.pi / max(ribs, 1)
    ends = radius * np.array([[1], [1 + height]])
    ax.plot(centre[0] + ends * np.sin(angle), centre[1] + ends * np.cos(angle), color=BLACK, lw=1.8, zorder=3)
    ax.add_patch(_disc(centre, 0.16 * radius, fc=BLACK, zorder=4))


def _disc(centre, radius, **style):
    from matplotlib.patches import Circle
    return Circle(centre, radius, **style)


def _body(ax, corner, width, height, text="", **style):
    ax.add_patch(FancyBboxPatch(corner, width, height, boxstyle="round,pad=0,rounding_size=0.08",
                                **{"fc": "white", "ec": BLACK, "lw": 1.8, "zorder": 2, **style}))
    ax.text(corner[0] + width / 2, corner[1] + height / 2, text, fontsize=9.5, ha="center", va="center", zorder=6)


def rover_parts():
    """A four-wheeled rover from the side, with the parts that a design sizes."""
    figure, (ax,) = _sheet(8.6, 4.0, (-3.1, 11.3, -1.0, 5.7))
    ax.fill_between([-3.1, 11.3], -1, 0, color=SOIL, lw=0)
    ax.plot([-3.1, 11.3], [0, 0], color=BLACK, lw=1)
    for x in (1.3, 6.7):
        _wheel(ax, (x, 0.9), 1.0)
    _body(ax, (0.9, 1.9), 6.2, 1.5)
    _body(ax, (1.2, 2.1), 1.9, 1.1, "battery")
    _body(ax, (3.3, 2.1), 1.9, 1.1, "avionics")
    _body(ax, (5.4, 2.1), 1.5, 1.1, "payload", fc=SOIL)
    ax.plot([1.3, 1.3], [0.9, 1.9], [6.7, 6.7], [0.9, 1.9], color=BLACK, lw=3, zorder=2)
    ax.plot([0.4, 6.0], [3.85, 4.35], color=BLUE, lw=5, solid_capstyle="butt", zorder=3)
    ax.plot([3.2, 3.2], [3.4, 4.1], color=BLACK, lw=2)
    for thing, text, at in (((1.5, 3.97), "solar array", (0.2, 5.2)), ((6.7, 0.9), "hub: motor and gear", (9.6, 1.7)),
                            ((7.05, 3.2), "chassis", (9.0, 3.6)), ((0.45, 1.4), "wheel", (-1.6, 2.2)),
                            ((0.2, 0.65), "grousers: ribs on the rim", (-1.1, -0.65)),
                            ((6.15, 3.2), "chosen by the mission,\nnot by the designer", (8.7, 5.2))):
        _name(ax, thing, text, at)
    _arrow(ax, (1.3, -0.45), (6.7, -0.45), "wheelbase", (4.0, -0.75), style="<|-|>", width=1.2)
    _arrow(ax, (3.2, 1.15), (5.0, 1.15), "drives this way", (4.1, 1.5), width=1.2)
    return figure


def wheel_in_soil():
    """The wheel's angles and lengths (left), and the forces on it when it drives (right)."""
    figure, (left, right) = _sheet(9.6, 4.6, (-1.6, 1.75, -1.45, 1.3), (-1.6, 1.75, -1.45, 1.3))
    entry, peak = np.radians(48), np.radians(22)
    bottom = np.cos(entry)
    for ax in (left, right):
        arc = np.linspace(0, entry, 40)
        ax.fill([-1.6, *np.sin(arc), 1.75, 1.75, -1.6], [-1, *-np.cos(arc), -bottom, -1.45, -1.45], color=SOIL, lw=0)
        ax.plot([-1.6, *np.sin(arc), 1.75], [-1, *-np.cos(arc), -bottom], color=BLACK, lw=1)
        ax.add_patch(_disc((0, 0), 1, fc="white", ec=BLACK, lw=1.8, zorder=1))
    left.plot([0, 0], [0, -1], color=BLACK, lw=1)
    for angle in (peak, entry):
        left.plot([0, np.sin(angle)], [0, -np.cos(angle)], color=BLACK, lw=1)
    left.plot([0, 1.75], [-bottom, -bottom], color=GREY, lw=1, linestyle="--")
    _angle(left, (0, 0), 0.42, 270, 292, r"$θ_m$", 1.3)
    _angle(left, (0, 0), 0.74, 270, 318, "")
    left.text(0.49, -0.7, r"$θ_1$", fontsize=11, ha="center", va="center", zorder=6)
    _arrow(left, (-0.45, -1), (-0.45, -bottom), r"$z_0$", (-0.74, -0.88), style="<|-|>", width=1.2)
    left.plot([-0.55, 0], [-bottom, -bottom], color=GREY, lw=1, linestyle="--")
    left.plot([0, -0.78], [0, 0.62], color=GREY, lw=1)
    left.text(-0.32, 0.42, "$r$", fontsize=11)
    _arrow(left, (0, 0), (0.75, 0), "$v$", (0.88, 0))
    left.add_patch(Arc((0, 0), 2.3, 2.3, theta1=50, theta2=120, color=BLACK, lw=1.5))
    _arrow(left, (0.66, 0.942), (0.74, 0.88), r"$ω$", (0.95, 0.95), width=1.5)
    for angle, text, at in ((entry, "entry", (1.4, -0.5)), (peak, "largest pressure", (0.95, -1.3)),
                            (0, "exit: $θ = 0$", (-0.75, -1.3))):
        _name(left, (np.sin(angle), -np.cos(angle)), text, at)
    for angle in np.radians([6, 14, 22, 30, 38, 44]):
        out = np.array([np.sin(angle), -np.cos(angle)])
        along = np.array([-np.cos(angle), -np.sin(angle)])           # the way the rim moves: backwards
        size = 0.42 * np.sin(np.pi * (angle / entry) ** 0.8)
        _arrow(right, out * (1.02 + size), out * 1.02, color=BLUE, width=1.6)
        _arrow(right, out * 0.93 + along * 0.09, out * 0.93 - along * 0.13, color=ORANGE, width=1.6)
    right.text(0.95, -1.22, "$σ$ pushes\non the rim", fontsize=10, color=BLUE, ha="left", va="center")
    right.text(0.16, -0.66, "$τ$ drags it\nforward", fontsize=10, color=ORANGE, ha="center", va="center")
    _arrow(right, (0, 0), (0, -0.5), "$W$", (-0.17, -0.4), width=2.4)
    _arrow(right, (0, 0), (-0.85, 0), "DP: the rover\nholds back", (-0.52, -0.2), width=2.4)
    right.add_patch(Arc((0, 0), 0.62, 0.62, theta1=20, theta2=160, color=BLACK, lw=2))
    _arrow(right, (0.27, 0.155), (0.31, 0.05), "$T$", (0.46, 0.2), width=2)
    left.set_title("angles are counted from the downward vertical", fontsize=10)
    right.set_title("forces on a driving wheel", fontsize=10)
    return figure


def single_wheel_rig():
    """A test bed for one wheel, with what is set and what is measured."""
    figure, (ax,) = _sheet(8.6, 3.7, (-3.2, 11.2, -1.6, 4.6))
    ax.fill_between([-1, 3.1, 3.6, 9], -1.3, [-0.25, -0.25, 0, 0], color=SOIL, lw=0)
    ax.plot([-1, 3.6], [0, 0], color=GREY, lw=1, linestyle="--")     # the surface before the wheel came
    ax.plot([-1, -1, 9, 9], [0.5, -1.3, -1.3, 0.5], color=BLACK, lw=1.8)
    ax.plot([-1, 3.1], [-0.25, -0.25], [3.6, 9], [0, 0], color=BLACK, lw=1)
    _wheel(ax, (3.2, 0.85), 1.1, height=0.1)
    ax.plot([-1, 9], [3.6, 3.6], color=GREY, lw=4)
    _body(ax, (2.2, 3.25), 2.0, 0.7, "carriage")
    ax.plot([3.2, 3.2], [0.85, 3.25], color=BLACK, lw=4)
    _body(ax, (2.75, 2.1), 0.9, 0.6, "load", fc=SOIL)
    _arrow(ax, (4.3, 3.6), (6.0, 3.6), "$v$: set", (6.6, 4.05))
    _arrow(ax, (3.2, 2.05), (3.2, 1.3), "$W$: set", (4.4, 2.35), width=2.4)
    for thing, text, at in (((3.2, 0.85), "motor in the hub: $ω$ is set, torque $T$ measured", (7.4, 1.6)),
                            ((2.2, 3.6), "force sensor:\npull DP", (-1.6, 2.6)),
                            ((1.2, -0.12), "rut: sinkage", (-1.9, -0.6)), ((8.2, -0.7), "soil bin", (10.2, -0.7)),
                            ((8.5, 3.6), "rail", (10.0, 3.0))):
        _name(ax, thing, text, at)
    ax.text(5.6, 2.55, r"slip $s = 1 - v/(ω r)$ is set by the two speeds", fontsize=10, ha="left")
    return figure


def sky_and_panel():
    """Where the noon sun stands for a rover at a latitude (left), and how a tilted panel meets it (right)."""
    figure, (ball, panel) = _sheet(9.6, 3.9, (-1.5, 2.9, -1.4, 1.4), (-1.6, 2.2, -1.0, 1.7))
    lat, dec = np.radians([38, 14])
    ball.add_patch(_disc((0, 0), 1, fc=SOIL, ec=BLACK, lw=1.8))
    ball.plot([-1.15, 1.15], [0, 0], [0, 0], [-1.3, 1.3], color=GREY, lw=1, linestyle="--")
    ball.text(-0.5, 0.09, "equator", fontsize=9, color=GREY, ha="center")
    ball.text(0.12, 1.26, "north", fontsize=9, color=GREY)
    up, north = np.array([np.cos(lat), np.sin(lat)]), np.array([-np.sin(lat), np.cos(lat)])
    sun = np.array([np.cos(dec), np.sin(dec)])
    ball.plot(*np.c_[(0, 0), up], color=BLACK, lw=1)
    ball.plot(*np.c_[up - 0.75 * north, up + 0.6 * north], color=BLACK, lw=1.5)
    _arrow(ball, up, up + 0.65 * up, "up", up + 0.78 * up, width=1.4)
    for foot in (up, 0.99 * sun, np.array([0.86, -0.51])):
        _arrow(ball, foot + 1.35 * sun, foot + 0.02 * sun, color=ORANGE, width=1.4)
    ball.text(2.35, 1.15, "sun", fontsize=10, color=ORANGE)
    ball.plot(*np.c_[(0, 0), 0.99 * sun], color=BLACK, lw=1, linestyle=":")
    _angle(ball, (0, 0), 0.72, 0, 38, "$λ$", 1.16)
    _angle(ball, (0, 0), 0.42, 0, 14, "$δ$", 1.3)
    _angle(ball, up, 0.42, 308, 374, "$e$", 1.3)
    _name(ball, up - 0.7 * north, "horizon", (1.95, 0.1))
    ball.set_title("noon: the sun stands $e = 90° − λ + δ$ high", fontsize=10)
    tilt, height = np.radians([35, 30])
    face = np.array([np.cos(tilt), -np.sin(tilt)])
    normal, ray = np.array([np.sin(tilt), np.cos(tilt)]), np.array([np.cos(height), np.sin(height)])
    panel.fill_between([-1.6, 2.2], -1.0, -0.7, color=SOIL, lw=0)
    panel.plot([-1.6, 2.2], [-0.7, -0.7], color=BLACK, lw=1)
    panel.plot(*np.c_[-0.75 * face, 0.75 * face], color=BLUE, lw=5, solid_capstyle="butt")
    panel.plot([0, 0], [-0.7, 0], color=BLACK, lw=3)
    panel.plot([0, 2.1], [0, 0], color=GREY, lw=1, linestyle="--")
    _arrow(panel, (0, 0), 1.25 * normal, "normal", 1.4 * normal, width=1.4)
    _arrow(panel, 1.9 * ray, 0.05 * ray, color=ORANGE)
    panel.text(1.75, 1.12, "sun", fontsize=10, color=ORANGE)
    _angle(panel, (0, 0), 0.95, 0, 30, "$e$", 1.1)
    _angle(panel, (0, 0), 0.6, 30, 55, "$i$", 1.2)
    _angle(panel, (0, 0), 0.5, 325, 360, "$β$", 1.25)
    panel.set_title("a panel tilted by $β$ meets it at the angle $i$", fontsize=10)
    return figure


def heat_box():
    """The enclosure as one lump, at noon and at night: what comes in and what leaves."""
    figure, (noon, night) = _sheet(8.6, 2.7, (-3.6, 4.2, -1.6, 2.0), (-3.6, 4.2, -1.6, 2.0))
    for ax, title, inside, around in ((noon, "hot: noon", "avionics,\npayload,\nheaters", "250 K"),
                                      (night, "cold: night", "hibernation,\nheaters", "100 K")):
        ax.fill_between([-3.6, 4.2], -1.6, -1.15, color=SOIL, lw=0)
        ax.plot([-3.6, 4.2], [-1.15, -1.15], color=BLACK, lw=1)
        _body(ax, (-1.1, -0.9), 2.2, 1.7, f"$T$\n{inside}")
        for y in (-0.45, 0.35):
            _arrow(ax, (1.15, y), (2.3, y), color=BLACK, width=1.6)
        ax.text(3.1, -0.05, r"$ε\,σ_\mathrm{SB} A_r T^4$" + "\nradiated", fontsize=9.5, ha="center", va="center")
        _arrow(ax, (0, 1.75), (0, 0.85), width=1.2)
        ax.text(0.15, 1.45, f"surroundings at $T_\\mathrm{{sink}}$ = {around}", fontsize=9.5, ha="left")
        ax.set_title(title, fontsize=10)
    for y in (0.55, 0.05):
        _arrow(noon, (-2.7, y + 0.75), (-1.15, y), color=ORANGE, width=1.6)
    noon.text(-2.5, 0.1, "sunlight:\n$α$ of it\nstays", fontsize=9.5, ha="center", va="top", color=ORANGE)
    return figure


def rover_on_slope(slope_deg=20):
    """The forces on a rover that climbs: its weight, split along the ground, and what each wheel carries and pulls."""
    figure, (ax,) = _sheet(7.6, 4.2, (-4.4, 5.0, -2.5, 2.6))
    turn = np.radians(slope_deg)
    along, up = np.array([np.cos(turn), np.sin(turn)]), np.array([-np.sin(turn), np.cos(turn)])
    far, near = -4.6 * along - 0.9 * up, 5.6 * along - 0.9 * up
    ax.fill([far[0], near[0], near[0], far[0]], [far[1], near[1], -4, -4], color=SOIL, lw=0)
    ax.plot(*np.c_[far, near], color=BLACK, lw=1)
    centre = 0.55 * up
    for side in (-1.9, 1.9):
        hub = side * along - 0.3 * up
        _wheel(ax, hub, 0.6, height=0.12)
        foot = hub - 0.6 * up
        _arrow(ax, foot - 1.0 * up, foot, "$F_z$", foot - 1.2 * up + 0.25 * along, BLUE)
        _arrow(ax, foot, foot + 0.9 * along, "DP", foot + 0.55 * along - 0.27 * up, ORANGE)
    corners = [centre + x * along + y * up for x, y in ((-2.2, -0.35), (2.2, -0.35), (2.2, 0.55), (-2.2, 0.55))]
    ax.fill(*np.transpose(corners), facecolor="white", edgecolor=BLACK, lw=1.8, zorder=2)
    ax.plot(*centre, "o", color=BLACK, ms=7, zorder=6)
    weight = np.array([0, -2.1])
    _arrow(ax, centre, centre + weight, "$m g$", centre + weight + (0.35, 0.1), width=2.6)
    pressing, pulling = weight @ up * up, weight @ along * along
    _arrow(ax, centre, centre + pressing, r"$m g \cos θ$", centre + pressing + 0.25 * up + 0.85 * along, width=1.3)
    _arrow(ax, centre, centre + pulling, r"$m g \sin θ$", centre + pulling - 0.75 * along + 0.35 * up, width=1.3)
    ax.plot(*np.c_[far + 0.9 * along, far + 0.9 * along + (2.6, 0)], color=GREY, lw=1, linestyle="--")
    _angle(ax, tuple(far + 0.9 * along), 1.0, 0, slope_deg, "$θ$", 1.25)
    ax.plot(*np.c_[centre, centre - 1.45 * up], color=GREY, lw=1, linestyle=":")
    _name(ax, centre + 0.02 * up, "centre of mass", (-1.9, 2.2))
    return figure
