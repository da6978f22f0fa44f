"""Picture of notebook 12: from demands to sizes, the way a pencil goes."""
import matplotlib.pyplot as plt

from rdk.figures import BLACK, BLUE, GREEN, ORANGE, panels

ROWS = (                                                 # demand, balance, size: from left to right
    (3.9, "it climbs 20 deg", "grip", "pull of the wheel\nat slip 0.6", "wheel radius"),
    (2.2, "the mission climbs 15 deg", "slip and torque", "pull = weight along\nthe slope", "hub torque"),
    (0.5, "30 km in 14 days", "energy", "sunlight = avionics,\npayload and driving", "array area"))


def sizing_flow():
    """What is demanded, the balance that it enters, the size that comes out, and mass, which leads back."""
    figure, ax = panels(figsize=(8.6, 4.6))
    ax.set(xlim=(-0.1, 10.1), ylim=(-1.75, 5.2))
    ax.axis("off")

    def box(x, y, width, title, text="", colour=BLACK, face="white"):
        ax.add_patch(plt.Rectangle((x, y), width, 1.1, fc=face, ec=colour, lw=1.4))
        middle = dict(x=x + width / 2, ha="center", va="center")
        ax.text(y=y + (0.78 if text else 0.55), s=title, fontsize=10, weight="bold", **middle)
        ax.text(y=y + 0.34, s=text, fontsize=8.5, linespacing=1.25, **middle)

    def arrow(*points, dash="-"):
        ax.plot(*zip(*points), color=BLACK, lw=1.4, linestyle=dash)
        ax.annotate("", points[-1], points[-2],
                    arrowprops=dict(arrowstyle="-|>", lw=0, color=BLACK, shrinkB=0, mutation_scale=15))

    for y, demand, balance, text, size in ROWS:
        box(0, y, 2.9, demand, colour=BLUE)
        box(3.8, y, 2.6, balance, text, BLACK, "#f2f2f2")
        box(7.3, y, 2.2, size, colour=GREEN)
        arrow((2.9, y + 0.55), (3.8, y + 0.55))
        arrow((6.4, y + 0.55), (7.3, y + 0.55))
    arrow((4.6, 3.9), (4.6, 3.3))
    arrow((5.6, 2.2), (5.6, 1.6))
    ax.text(4.45, 3.6, "radius", ha="right", va="center", fontsize=8.5, style="italic")
    ax.text(5.45, 1.9, "slip, torque", ha="right", va="center", fontsize=8.5, style="italic")
    box(3.8, -1.6, 2.6, "mass", "all parts, overheads", ORANGE)
    ax.plot([9.5, 9.95, 9.95], [4.45, 4.45, -1.05], color=BLACK, lw=1.4)
    for y in (2.75, 1.05):
        ax.plot([9.5, 9.95], [y, y], color=BLACK, lw=1.4)
    arrow((9.95, -1.05), (6.4, -1.05))
    arrow((3.8, -1.05), (3.35, -1.05), (3.35, 4.2), (3.8, 4.2), dash="--")
    ax.text(3.25, -1.3, "the next round", ha="right", va="center", fontsize=8.5, style="italic")
    return figure
