"""The explorer's and the report's pictures as SVG: text stays text, colours follow the page, nothing is loaded.

Each takes numbers in the units shown and a size in pixels, and returns the text of an SVG element whose label says in
words what it shows. A dot that can be picked is an element of its own, so that what is clicked is what is drawn.
"""
from __future__ import annotations

import html
import math
import re

import numpy as np

from .rover_picture import contact, svg, wheel_picture

SIZE = 600, 380
LABELS = {"range_km": ("range", "km"), "total_mass_kg": ("mass", "kg"),
          "slope_capability_deg": ("slope capability", "°"),
          "energy_balance_pct": ("energy balance", "%"), "cruise_speed_m_s": ("cruise speed", "m/s"),
          "slip": ("slip", ""),
          "sinkage_m": ("sinkage", "m"), "wheel_torque_nm": ("wheel torque", "N m"),
          "final_soc": ("charge at the end", ""),
          "minimum_soc": ("lowest charge", ""), "average_solar_power_w": ("mean sunlight", "W"),
          "hot_temperature_c": ("noon temperature", "°C"), "cold_temperature_c": ("night temperature", "°C"),
          "obstacle_capability_m": ("obstacle capability", "m"), "thermal_survival": ("survival of heat and cold", ""),
          "energy_balance_speed_m_s": ("energy-balance speed", "m/s"), "feasible": ("drives the mission", "")}
"""Words and unit of the metrics."""
SHADES = np.array([(0, 32, 77), (49, 68, 107), (102, 105, 112), (149, 143, 120), (202, 185, 105), (255, 233, 69)],
                  float)


def label(name):
    """Words and unit of a metric, such as ("range", "km")."""
    return LABELS.get(name, (name.replace("_", " "), ""))


def named(name):
    """A metric's words with its unit, such as "range (km)"."""
    words, unit = label(name)
    return f"{words} ({unit})" if unit else words


def alt(picture):
    """The words that go with a picture."""
    return html.unescape(re.search(r'aria-label="([^"]*)"', picture)[1])


def text(x, y, words, cls=""):
    """A text element."""
    return f'<text x="{x:.1f}" y="{y:.1f}" class="{cls}">{html.escape(str(words), quote=False)}</text>'


def shade(share):
    """A colour from dark blue to yellow for a share from 0 to 1; it also reads in grey."""
    place = float(np.clip(np.nan_to_num(share), 0, 1)) * (len(SHADES) - 1)
    i = min(int(place), len(SHADES) - 2)
    return "#" + bytes((SHADES[i] + (place - i) * (SHADES[i + 1] - SHADES[i])).round().astype("u1")).hex()


def span(*values, zero=False, room=0.06):
    """Limits of an axis around all finite values, never narrower than can be told apart."""
    found = np.concatenate([np.ravel(np.asarray(v, float)) for v in values] + [np.zeros(1 if zero else 0)])
    found = found[np.isfinite(found)]
    low, high = (float(found.min()), float(found.max())) if len(found) else (0.0, 1.0)
    if high - low < 1e-6 * max(abs(low), abs(high), 1e-6):
        low, high = low - max(0.1 * abs(low), 0.05), high + max(0.1 * abs(high), 0.05)
    more = room * (high - low)
    return (low if zero and low == 0 else low - more), high + more


def ticks(low, high, count=5, log=False):
    """Round numbers between two limits."""
    if log:
        found = [m * 10.0**k for k in range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
                 for m in (1, 2, 5)]
        return [t for t in found if low <= t <= high]
    raw = (high - low) / count
    unit = 10.0**math.floor(math.log10(raw))
    step = unit * next(m for m in (1, 2, 2.5, 5, 10) if m * unit >= 0.999 * raw)
    return [k * step for k in range(math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9) + 1)]


class Axes:
    """A panel of a picture: data to pixels, and the parts drawn so far."""

    def __init__(self, box, xs, ys, log=False):
        self.box, self.xs, self.ys, self.log, self.parts = box, xs, ys, log, []

    def x(self, value):
        """Pixels from the left."""
        x0, _, x1, _ = self.box
        low, high = np.log(self.xs) if self.log else self.xs
        return x0 + (x1 - x0) * ((np.log(value) if self.log else np.asarray(value, float)) - low) / (high - low)

    def y(self, value):
        """Pixels from the top."""
        _, y0, _, y1 = self.box
        return y1 - (y1 - y0) * (np.asarray(value, float) - self.ys[0]) / (self.ys[1] - self.ys[0])

    def frame(self, title="", unit="", below="", right=True, count=4):
        """Grid, ticks, the name of the upright axis above, that of the other below."""
        x0, y0, x1, y1 = self.box
        for t in ticks(*self.ys, count):
            self.parts.append(f'<path class="g" d="M{x0} {self.y(t):.1f}H{x1}"/>'
                              + text(x0 - 6, self.y(t) + 4, f"{t:.5g}", "q s e"))
        for t in ticks(*self.xs, max(int((x1 - x0) / 90), 2), self.log):
            self.parts.append(f'<path class="g" d="M{self.x(t):.1f} {y0}V{y1}"/>'
                              + (text(self.x(t), y1 + 14, f"{t:.5g}", "q s m") if below else ""))
        self.parts.append(f'<text x="{x0}" y="{y0 - 7}" class="b">{html.escape(title)} <tspan class="q '
                          f's">{unit}</tspan></text>')
        if below:
            self.parts.append(text((x0 + x1) / 2, y1 + 30, below, "q m"))
        return self

    def line(self, xs, ys, cls="c0", style=""):
        """A line through points; it breaks where there is none, and keeps only points that can be seen."""
        px, py = np.broadcast_arrays(self.x(xs), self.y(ys))
        stride = max(len(px) // 200, 1)
        kept = np.arange(len(px)) % stride == 0
        jump = np.abs(np.diff(py, 2, prepend=py[:1], append=py[-1:])) > 0.4
        kept |= jump | np.roll(jump, 1) | np.roll(jump, -1)
        kept[[0, -1]] = True
        words, pen = [], "M"
        for a, b in zip(px[kept].tolist(), py[kept].tolist()):
            words.append(f"{pen}{a:.1f} {b:.1f}" if math.isfinite(b) else "")
            pen = "L" if math.isfinite(b) else "M"
        self.parts.append(f'<path class="l {cls}" style="{style}" d="{"".join(words)}"/>')

    def area(self, xs, low, high, cls="f0", opacity=0.18):
        """A band between two lines."""
        a, b = self.x(xs), self.y(low)
        points = [*zip(a, self.y(high)), *zip(a[::-1], b[::-1])]
        self.parts.append(f'<path class="{cls}" opacity="{opacity}" d="M'
                          + "L".join(f"{u:.1f} {v:.1f}" for u, v in points) + 'Z"/>')

    def dot(self, x, y, cls="f0", size=5, more="", inside=""):
        """A dot."""
        self.parts.append(f'<circle class="{cls}" cx="{float(self.x(x)):.1f}" cy="{float(self.y(y)):.1f}" r="{size}" '
                          f'{more}>'
                          f"{inside}</circle>")

    def names(self, xs, ys, words, cls="s"):
        """Names beside points, moved down until none covers another."""
        taken = []
        for x, y, name in sorted(zip(self.x(xs).tolist(), self.y(ys).tolist(), words)):
            end = x > self.box[0] + 0.7 * (self.box[2] - self.box[0])
            at, wide = y + 4, 6.4 * len(name) + 8
            left = x - wide - 8 if end else x + 8
            while any(left < b and left + wide > a and abs(at - t) < 12 for a, b, t in taken):
                at += 12
            taken.append((left, left + wide, at))
            self.parts.append(text(x - 8 if end else x + 8, at, name, cls + " e" * end))

    def __str__(self):
        return "".join(self.parts)


def log(result, scenario, soc_initial=1.0, size=SIZE, ghosts=()):
    """Sunlight and load, charge, and distance, hour by hour; `ghosts` are (name, class, log) of other designs."""
    width, height = size
    log, start = result.log, lambda values, first: np.insert(values, 0, first)
    days = start(log.time_h / 24, 0.0)
    third, far, limit = (height - 34) / 3, float(log.distance_km[-1]), scenario.traverse_limit_km
    boxes = [(44, 24 + k * third, width - 62, 24 + (k + 1) * third - 26) for k in range(3)]
    ends = [far, *(float(other.distance_km[-1]) for *_, other in ghosts)]
    top = max(*ends, limit if limit <= 4 * max(*ends, 0.01) else 0, 0.05)
    power = Axes(boxes[0], (0, days[-1]), span(log.solar_w, log.load_w, zero=True))
    charge, distance = Axes(boxes[1], (0, days[-1]), (0, 105)), Axes(boxes[2], (0, days[-1]), (0, 1.08 * top))
    dark = np.flatnonzero(np.diff(np.concatenate([[0], log.sun_elevation_deg <= 0, [0]])))
    for axes in (power, charge, distance):
        for a, b in zip(days[dark[::2]], days[dark[1::2]]):
            x0, x1 = float(axes.x(a)), float(axes.x(b))
            axes.parts.append(f'<rect class="f3" opacity=".09" x="{x0:.1f}" y="{axes.box[1]:.1f}" '
                              f'width="{x1 - x0:.1f}" '
                              f'height="{axes.box[3] - axes.box[1]:.1f}"/>')
            if axes is power and x1 - x0 > 40:
                axes.parts.append(text((x0 + x1) / 2, axes.box[1] + 12, "night", "q s m"))
    power.frame("Power", "W", count=3)
    power.area(days, 0 * days, start(log.solar_w, log.solar_w[0]), "f1", 0.14)
    power.line(days, start(log.solar_w, log.solar_w[0]), "c1")
    power.line(days, start(log.load_w, log.load_w[0]), "c3")
    peak = int(log.solar_w.argmax())
    power.parts.append(text(min(max(power.x(days[peak]), 130), width - 110), power.y(log.solar_w[peak]) - 5, "sunlight",
                            "s m f1 b"))
    power.parts.append(text(width - 57, power.y(log.load_w[-1]) + 4, "load", "s b"))
    charge.frame("Charge", "%", count=2)
    for name, cls, other in ghosts:
        charge.line(start(other.time_h / 24, 0), 100 * start(other.soc, soc_initial), cls,
                    "stroke-width:1.2;stroke-dasharray:3 3")
        distance.line(start(other.time_h / 24, 0), start(other.distance_km, 0), cls,
                      "stroke-width:1.2;stroke-dasharray:3 3")
        distance.parts.append(text(width - 57, distance.y(other.distance_km[-1]) + 4, name, "s b f" + cls[1]))
    charge.line(days, 100 * start(log.soc, soc_initial), "c0")
    distance.frame("Distance", "km", f"Earth days after {scenario.start_utc or 'sunrise'}", count=3)
    if limit <= 1.08 * top:
        distance.parts.append(f'<path class="a" stroke-dasharray="6 4" d="M44 {distance.y(limit):.1f}H{width - 62}"/>'
                              + text(48, distance.y(limit) + 12, "end of the route", "q s"))
    distance.line(days, start(log.distance_km, 0), "c2")
    distance.dot(days[-1], far, "f2", 4)
    distance.parts.append(text(width - 55, distance.y(far) - 7, f"{far:.3g} km", "b"))
    return svg(width, height, f"{power}{charge}{distance}",
               f"Three charts over {days[-1]:.0f} Earth days. Sunlight reaches {log.solar_w.max():.0f} W against a "
               "load of up "
               f"to {log.load_w.max():.0f} W. Charge falls to {100 * result.minimum_soc:.0f} % and ends at "
               f"{100 * result.final_soc:.0f} %. Distance reaches {result.range_km:.2f} km.")


def mass(result, size=SIZE, spans=None, ghosts=()):
    """Mass line items as bars, with the 90 % interval of the total; `ghosts` are (name, class, result)."""
    width, height = size
    words = {"growth_kg": "margin"}
    items = {name: float(value) for name, value in result.mass.items.items() if value > 0.0005}
    items = dict(sorted(items.items(), key=lambda item: -item[1]))
    others = [getattr(other.mass, name) for name in items for *_, other in ghosts]
    axes = Axes((100, 24, width - 56, height - 34), span([*items.values(), *others], zero=True),
                (0, 1)).frame(below="mass (kg)")
    axes.parts = [part for part in axes.parts if " e\"" not in part
                  and "H" not in part]         # rows have names instead
    row = (axes.box[3] - axes.box[1]) / len(items)
    for k, (name, value) in enumerate(items.items()):
        y, end = axes.box[1] + (k + 0.5) * row, float(axes.x(value))
        axes.parts.append(f'<rect class="f0" opacity=".8" x="100" y="{y - 0.34 * row:.1f}" '
                          f'width="{max(end - 100, 1):.1f}" '
                          f'height="{0.68 * row:.1f}"/>' + text(end + 6, y + 4, f"{value:.2f}", "s")
                          + text(93, y + 4, words.get(name, name[:-3].replace("_", " ")), "s e"))
        for _, cls, other in ghosts:
            axes.parts.append(f'<path class="l {cls}" d="M{axes.x(getattr(other.mass, name)):.1f} '
                              f'{y - 0.42 * row:.1f}v{0.84 * row:.1f}"/>')
    sure = "" if spans is None else f", 90 % of draws {spans[0]:.1f} to {spans[1]:.1f}"
    axes.parts.append(text(8, 14, f"{result.total_mass_kg:.2f} kg in all{sure}", "b"))
    heaviest = next(iter(items))
    return svg(width, height, str(axes), f"Bars of mass line items: {result.total_mass_kg:.2f} kg in all{sure}; the "
               "largest is "
               f"{heaviest[:-3].replace('_', ' ')} with {items[heaviest]:.2f} kg.")


def wheel(result, design, scenario, model, size=SIZE):
    """The wheel in its soil, and its stresses along the contact at the slip balance."""
    width, height = size
    narrow = width < 460                                 # then one above the other
    part = width if narrow else round(0.45 * width)
    drawn = wheel_picture(design, result, scenario, model=model, width=part, height=round(0.52 * height) if narrow
                          else height - 20)
    if result.buried:
        return svg(width, height, drawn, alt(drawn))
    _, angle, normal, shear = contact(design, result, scenario, model, 61)
    axes = Axes((44, round(0.52 * height) + 26, width - 14, height - 44) if narrow
                else (part + 44, 24, width - 14, height - 44),
                (0, float(np.degrees(angle[-1])) * 1.02), span(normal, shear, zero=True))
    axes.frame("Stress", "kPa", "angle ahead of the lowest point (°)")
    for values, cls, name, dash in ((normal, "c0", "normal", ""), (shear, "c1", "shear", "stroke-dasharray:7 3")):
        axes.line(np.degrees(angle), values, cls, dash)
        top = int(np.abs(values).argmax())
        axes.names(np.degrees(angle[top:top + 1]), values[top:top + 1] + 0.04 * np.abs(normal).max(), [name],
                   f"s b f{cls[1]}")
    return svg(width, height, drawn + str(axes), alt(drawn))


def fleet(result, rovers, size=SIZE, spans=None, ghosts=()):
    """Range against mass: this design, with its intervals, among published rovers on the same mission."""
    width, height = size
    masses, ranges, names = (np.asarray(v) for v in rovers)
    order = {}
    for m, r, n in zip(masses.round(6).tolist(), ranges.round(6).tolist(), names.tolist()):
        order.setdefault((m, r), []).append(n)           # rovers at one place share a name
    around = [] if spans is None else spans[0]
    tops = [ranges, result.range_km, [] if spans is None else spans[1], [g.range_km for *_, g in ghosts]]
    low, high = (f([*masses, *around, result.total_mass_kg, *(g.total_mass_kg for *_, g in ghosts)])
                 for f in (min, max))
    axes = Axes((50, 26, width - 14, height - 44), (0.8 * low, 1.3 * high), span(*tops, zero=True, room=0.1), log=True)
    axes.frame("Range", "km", "mass (kg), logarithmic")
    places = np.array(list(order))
    for m, r in places:
        axes.parts.append(f'<rect class="f1" x="{axes.x(m) - 4:.1f}" y="{axes.y(r) - 4:.1f}" width="8" height="8"/>')
    axes.names(places[:, 0], places[:, 1], [", ".join(found) for found in order.values()])
    if spans is not None:
        (x0, x1), (y0, y1) = spans
        axes.parts.append(f'<path class="l c0" style="stroke-width:1.3" d="M{axes.x(x0):.1f} '
                          f'{axes.y(result.range_km):.1f}H'
                          f'{axes.x(x1):.1f}M{axes.x(result.total_mass_kg):.1f} {axes.y(y0):.1f}V{axes.y(y1):.1f}"/>')
    for name, cls, other in ghosts:
        axes.dot(other.total_mass_kg, other.range_km, f"n l {cls}", 6)
        axes.names(np.array([other.total_mass_kg]), np.array([other.range_km]), [name], "s b f" + cls[1])
    axes.dot(result.total_mass_kg, result.range_km, "f0", 6)
    axes.parts.append(f'<circle class="f0" cx="{width - 208}" cy="10" r="5"/>'
                      + text(width - 198, 14, "this design", "s")
                      + f'<rect class="f1" x="{width - 122}" y="6" width="8" height="8"/>'
                      + text(width - 109, 14, "published rovers", "s"))
    others = ", ".join(f"{n} {r:.1f} km" for n, r in zip(names, ranges))
    return svg(width, height, str(axes), f"Range against mass: this design reaches {result.range_km:.2f} km with "
               f"{result.total_mass_kg:.1f} kg; on the same mission {others}.")


def why(metric, names, values, before, after, baseline, size=SIZE):
    """Contributions of the design variables as steps from a baseline to this design."""
    width, height = size
    values = np.asarray(values, float)
    words, unit = label(metric)
    least = max(1e-3 * np.abs(values).max(initial=0), 1e-9 * max(abs(before), abs(after)),
                1e-12)        # below: rounding
    order = [i for i in np.argsort(-np.abs(values)) if abs(values[i]) > least]
    shown = order[:9]
    rest = values.sum() - values[shown].sum()
    rows = [(names[i], float(values[i])) for i in shown] + ([("the rest", float(rest))] if abs(rest) > least else [])
    if not rows:
        said = f"The same {words} as {baseline}: {after:.4g} {unit}. Move a slider, or choose another baseline."
        return svg(width, height, text(width / 2, height / 2, said[:200], "m"), said)
    edges = before + np.concatenate([[0.0], np.cumsum([step for _, step in rows])])
    axes = Axes((122, 44, width - 50, height - 44), span(edges, room=0.08), (0, 1)).frame(below=named(metric))
    axes.parts = [part for part in axes.parts if " e\"" not in part and "H" not in part]
    tall = (axes.box[3] - axes.box[1]) / max(len(rows), 4)
    for k, (name, step) in enumerate(rows):
        y, (a, b) = axes.box[1] + k * tall, sorted((float(axes.x(edges[k])), float(axes.x(edges[k + 1]))))
        axes.parts.append(f'<rect class="{"f0" if step > 0 else "f1"}" opacity=".85" x="{a:.1f}" '
                          f'y="{y + 0.16 * tall:.1f}" '
                          f'width="{max(b - a, 1):.1f}" height="{0.68 * tall:.1f}"/>'
                          + text(114, y + tall / 2 + 4, name, "s e")
                          + text(b + 5, y + tall / 2 + 4, f"{step:+.3g}", "s"))
    for value, dash in ((before, "2 3"), (after, "7 4")):
        axes.parts.append(f'<path class="a" stroke-dasharray="{dash}" d="M{axes.x(value):.1f} '
                          f'{axes.box[1]}V{axes.box[3]}"/>')
    said = f"{words}: {baseline} (dotted) {before:.4g} to this design (dashed) {after:.4g} {unit}"
    axes.parts.append(text(8, 14, said if 7 * len(said) < width else f"{words}: from {before:.4g} to {after:.4g} "
                           f"{unit}", "b")
                      + text(8, 30, "▮ more", "s f0") + text(66, 30, "▮ less, to the left", "s f1"))
    steps = "; ".join(f"{name} {step:+.3g}" for name, step in rows)
    return svg(width, height, str(axes), f"Steps from {before:.4g} ({baseline}) to {after:.4g} in {named(metric)}: "
               f"{steps}.")


def curve(x_label, metric, values, nominal, stalled, band, here, rovers=None, size=SIZE, log=False):
    """One metric along one variable, with its interval (where, low, high), this design, and the published rovers."""
    width, height = size
    words, unit = label(metric)
    axes = Axes((56, 26, width - 14, height - 44), (float(values[0]), float(values[-1])),
                span(nominal, *band[1:], here[1]), log)
    if not np.isfinite(nominal).any():
        said = f"{words} has no value at any {x_label}: the wheel is buried"
        return svg(width, height, text(width / 2, height / 2, said, "m"), said)
    for cut in np.flatnonzero(np.diff(np.asarray(stalled, int))):
        x, side = float(axes.x((values[cut] + values[cut + 1]) / 2)), "e" if stalled[cut] else ""
        axes.parts.append(f'<path class="a" stroke-dasharray="2 3" d="M{x:.1f} 26V{height - 44}"/>'
                          + text(x + (-5 if side else 5), 38, "cannot drive", f"q s {side}"))
    axes.frame(words.capitalize(), unit, x_label)
    axes.area(band[0], band[1], band[2])
    axes.line(values, nominal, "c0")
    if rovers is not None:
        inside = (rovers[0] >= values[0]) & (rovers[0] <= values[-1]) & np.isfinite(rovers[1])
        xs, ys = rovers[0][inside], np.clip(rovers[1][inside], *axes.ys)
        for x, y in zip(xs, ys):
            axes.parts.append(f'<rect class="f1" x="{axes.x(x) - 3.5:.1f}" y="{axes.y(y) - 3.5:.1f}" width="7" '
                              'height="7"/>')
        axes.names(xs, ys, np.asarray(rovers[2])[inside])
    if np.isfinite(here[1]):
        axes.dot(*here, "f3", 6)
    axes.parts.append(text(width - 14, 14, "● this design" + "   band: 90 % of draws" * (width > 460), "s q e"))
    return svg(width, height, str(axes), f"{named(metric)} against {x_label}: from {nominal[0]:.3g} at {values[0]:.3g} "
               "to "
               f"{nominal[-1]:.3g} at {values[-1]:.3g}; this design has {here[1]:.3g} at {here[0]:.3g}."
               .replace("nan", "no value"))


def contour(x_label, y_label, metric, xs, ys, grid, stalled, here, size=SIZE):
    """One metric over two variables: shades, labelled contours, hatching where the rover cannot drive, this design."""
    from contourpy import contour_generator
    width, height = size
    axes = Axes((56, 26, width - 86, height - 44), (float(xs[0]), float(xs[-1])), (float(ys[0]), float(ys[-1])))
    low, high = span(grid, room=0)
    field, edges = contour_generator(xs, ys, np.where(np.isfinite(grid), grid, np.nan).T), np.linspace(low, high, 11)
    outer = edges + np.r_[-1, np.zeros(9), 1] * 1e-9 * max(abs(low), abs(high), 1)

    def path(points, close=""):
        return "M" + "L".join(f"{a:.1f} {b:.1f}" for a, b in zip(axes.x(points[:, 0]), axes.y(points[:, 1]))) + close

    for k, a in enumerate(edges[:-1]):
        polygons, offsets = field.filled(outer[k], outer[k + 1])
        outlines = "".join(path(points[i:j], "Z") for points, starts in zip(polygons, offsets) for i,
                           j in zip(starts, starts[1:]))
        axes.parts.append(f'<path fill="{shade((k + 0.5) / 10)}" fill-rule="evenodd" d="{outlines}"/>')
        y = height - 44 - (height - 90) * k / 10
        axes.parts.append(f'<rect fill="{shade((k + 0.5) / 10)}" x="{width - 74}" y="{y - (height - 90) / 10:.1f}" '
                          'width="14" '
                          f'height="{(height - 90) / 10 + 0.5:.1f}"/>' + text(width - 56, y + 4, f"{a:.3g}", "q s"))
    axes.parts.append(text(width - 56, 46 + 4, f"{high:.3g}", "q s"))
    for level in edges[2:-1:2] if np.nanmax(grid) > np.nanmin(grid) else ():
        for points in field.lines(level):
            axes.parts.append(f'<path class="n" stroke="#fff" opacity=".8" d="{path(points)}"/>')
            if len(points) > 8:
                x, y = points[len(points) // 2]
                axes.parts.append('<text class="s m" '
                                  'style="fill:#fff;stroke:#0008;stroke-width:2.5;paint-order:stroke" '
                                  f'x="{axes.x(x):.1f}" y="{axes.y(y) + 4:.1f}">{level:.3g}</text>')
    if stalled.any():
        outlines = "".join(path(points[i:j], "Z") for points, starts in
                           zip(*contour_generator(xs, ys, stalled.T.astype(float)).filled(0.5, 2)) for i,
                           j in zip(starts, starts[1:]))
        axes.parts.append('<pattern id="rdk-hatch" width="7" height="7" patternUnits="userSpaceOnUse" '
                          'patternTransform="rotate(45)">'
                          '<path d="M0 0V7" stroke="#fff" stroke-width="1.6"/></pattern><path fill="url(#rdk-hatch)" '
                          f'd="{outlines}"/>')
    axes.frame(y_label, below=x_label)
    axes.dot(*here, "", 6, 'fill="#fff" stroke="#000" stroke-width="2"')
    axes.parts.append(text(width - 4, 14, named(metric) + (", hatched: cannot drive" if stalled.any() else ""),
                           "s b e"))
    return svg(width, height, str(axes), f"Map of {named(metric)} over {x_label} and {y_label}: from "
               f"{np.nanmin(grid):.3g} to "
               f"{np.nanmax(grid):.3g}; the circle marks this design.")


def front(x, y, colour, names, here, size=SIZE, picked=None, faded=None, title="", stale="", ghosts=()):
    """A front: one metric against another, coloured by a third; dots can be picked, this design is a cross.

    `faded` marks dots that miss a demand, `stale` says that the front belongs to another mission.
    """
    width, height = size
    if not len(x):
        return svg(width, height, text(14, 16, title, "b") + text(width / 2, height / 2,
                                                                  "no design meets the constraints", "m"),
                   f"{title}: an empty front, no design meets the constraints.")
    faded = np.zeros(len(x), bool) if faded is None else faded
    axes = Axes((54, 42, width - 92, height - 44), span(x, here[0]), span(y, here[1]))
    words, unit = label(names[1])
    axes.frame(words.capitalize(), unit, named(names[0]), count=5)
    low, high = span(colour, room=0)
    for i in range(len(x)):
        said = ", ".join(f"{label(n)[0]} {v[i]:.4g} {label(n)[1]}".strip() for n, v in zip(names, (x, y, colour)))
        first = i == (0 if picked is None else picked)
        axes.dot(x[i], y[i], "rdk-pick", 6, f'fill="{shade((colour[i] - low) / (high - low))}" stroke="currentColor" '
                 f'stroke-width="{2.6 if i == picked else 0.7}" opacity="{0.25 if faded[i] else 1}" '
                 f'tabindex="{0 if first else -1}" '
                 f'role="button" data-do="point:{i}" aria-label="{said}"', f"<title>{said}</title>")
    for name, cls, other in ghosts:
        axes.dot(getattr(other, names[0]), getattr(other, names[1]), f"n l {cls}", 8,
                 inside=f"<title>{html.escape(name)}</title>")
    a, b = float(axes.x(here[0])), float(axes.y(here[1]))
    axes.parts.append(f'<path class="l c1" style="stroke-width:3" d="M{a - 6:.1f} {b - 6:.1f}l12 12m0 -12l-12 12"/>')
    axes.names(np.array([here[0]]), np.array([here[1]]), ["this design"], "s b")
    for k in range(10):
        axes.parts.append(f'<rect fill="{shade((k + 0.5) / 10)}" x="{width - 78}" '
                          f'y="{height - 44 - (k + 1) * (height - 110) / 10:.1f}" '
                          f'width="12" height="{(height - 110) / 10 + 0.5:.1f}"/>')
    axes.parts.append(text(width - 60, height - 42, f"{low:.3g}", "q s") + text(width - 60, 72, f"{high:.3g}", "q s")
                      + text(width - 4, 52, label(names[2])[0], "s e") + text(8, 14, title, "b")
                      + (text(8, 28, stale, "bad") if stale else ""))
    body = f'<g opacity=".45">{axes}</g>' + text(8, 28, stale, "bad") if stale else str(axes)
    spans = ", ".join(f"{named(n)} from {min(v):.3g} to {max(v):.3g}" for n, v in zip(names, (x, y, colour)))
    return svg(width, height, body, f"{title}. Front of {len(x)} designs: {spans}." + (f" {stale}" if stale else ""),
               "group")
