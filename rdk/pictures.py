"""The explorer's and the report's pictures as SVG: text stays text, colours follow the page, nothing is loaded.

Each takes numbers in the units shown and a size in pixels, and returns the text of an SVG element whose label says in
words what it shows. A dot that can be picked is an element of its own, so that what is clicked is what is drawn.
"""
import html
import math
import re
import textwrap

import numpy as np

from .design import DESIGN_SPACE
from .explain import label, named
from .rover_picture import contact, element, svg, text, wheel_picture

SIZE = 600, 380
LETTER = 6.3                                             # pixels of a letter of small words
SHADES = (0, 32, 77), (49, 68, 107), (102, 105, 112), (149, 143, 120), (202, 185, 105), (255, 233, 69)
HATCH = ('<pattern id="rdk-hatch" width="7" height="7" patternUnits="userSpaceOnUse" patternTransform="rotate(45)">'
         '<path d="M0 0V7" stroke="#999" stroke-width="1.8"/></pattern>')
HATCHED = {"style": "fill:url(#rdk-hatch)"}


def alt(picture):
    """The words that go with a picture."""
    return html.unescape(re.search(r'aria-label="([^"]*)"', picture)[1])


def shade(share):
    """A colour from dark blue to yellow for a share from 0 to 1; it also reads in grey."""
    return "#" + bytes(round(np.interp(5 * share, range(6), part)) for part in zip(*SHADES)).hex()


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
        return [m * 10.0**k for k in range(-9, 10) for m in (1, 2, 5) if low <= m * 10.0**k <= high]
    raw = (high - low) / count
    unit = 10.0**math.floor(math.log10(raw))
    step = unit * next(m for m in (1, 2, 2.5, 5, 10) if m * unit >= 0.999 * raw)
    return [k * step for k in range(math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9) + 1)]


def path(xs, ys, close=""):
    """The data of a path through pixels."""
    return "M" + ("%.1f %.1fL" * len(xs))[:-1] % tuple(np.stack([xs, ys], 1).ravel().tolist()) + close


def sign(kind, cls, x, y, size=5, **more):
    """A "dot", "square" or "cross" around a pixel."""
    if kind == "dot":
        return element("circle", cls, cx=x, cy=y, r=size, **more)
    if kind == "square":
        return element("rect", cls, x=x - size, y=y - size, width=2 * size, height=2 * size, **more)
    return element("path", cls, d=f"M{x - size:.1f} {y - size:.1f}l{2 * size} {2 * size}m0 {-2 * size}l{-2 * size} "
                                  f"{2 * size}", **more)


class Axes:
    """A panel of a picture: data to pixels, the parts drawn so far, and the places taken by marks and names."""

    def __init__(self, size, xs, ys, left=56, top=None, right=14, bottom=44, log=False):
        if top is None:                                  # room for the legend beside the title or above it
            top = 26 if size[0] > 500 else 44
        self.size, self.box, self.xs, self.ys = size, (left, top, size[0] - right, size[1] - bottom), xs, ys
        self.log, self.parts, self.taken = log, [], []
        low, high = map(math.log, xs) if log else xs
        self.per_x, self.per_y = (self.box[2] - left) / (high - low), (self.box[3] - top) / (ys[1] - ys[0])
        self.left = left - self.per_x * low

    def x(self, value):
        """Pixels from the left."""
        return self.left + self.per_x * (np.log(value) if self.log else value)

    def y(self, value):
        """Pixels from the top."""
        return self.box[3] - self.per_y * (value - self.ys[0])

    def add(self, *arguments, **attributes):
        self.parts.append(element(*arguments, **attributes))

    def say(self, x, y, words, cls=""):
        self.parts.append(text(x, y, words, cls))

    def frame(self, title="", unit="", below="", count=4):
        """Grid, ticks, the name of the upright axis above, that of the other below."""
        x0, y0, x1, y1 = self.box
        for t in ticks(*self.ys, count) if count else ():
            self.add("path", "g", d=f"M{x0:.1f} {self.y(t):.1f}H{x1:.1f}")
            self.say(x0 - 6, self.y(t) + 4, f"{t:.5g}", "q s e")
        for t in ticks(*self.xs, max(int((x1 - x0) / 90), 4), self.log):
            self.add("path", "g", d=f"M{self.x(t):.1f} {y0:.1f}V{y1:.1f}")
            self.say(self.x(t), y1 + 14, f"{t:.5g}" if below else "", "q s m")
        self.add("text", "b", f'{html.escape(title.capitalize())} <tspan class="q s">{unit}</tspan>', x=x0, y=y0 - 7)
        self.say((x0 + x1) / 2, y1 + 30, below, "q m")

    def seen(self, xs, *lines):
        """Pixels of lines over the same xs, as far as they can be seen: every so many points, and where one bends."""
        px, *lines = np.broadcast_arrays(self.x(xs), *map(self.y, lines))
        kept = np.arange(len(px)) % max(len(px) // 200, 1) == 0
        for ys in lines if not kept.all() else ():
            bend = np.abs(np.diff(ys, 2, prepend=ys[:1], append=ys[-1:])) > 0.4
            kept |= bend | np.roll(bend, 1) | np.roll(bend, -1)
        kept[-1] = True
        return [values[kept] for values in (px, *lines)]

    def line(self, xs, ys, cls="c0", **more):
        """A line through points that breaks where there is none."""
        px, py = self.seen(xs, ys)
        turns = np.flatnonzero(np.diff(np.isfinite(py))) + 1
        runs = [path(*run) for run in zip(np.split(px, turns), np.split(py, turns)) if np.isfinite(run[1][0])]
        self.add("path", "l " + cls, d="".join(runs), **more)

    def area(self, xs, low, high, cls="f0", opacity=0.18):
        """A band between two lines."""
        px, low, high = self.seen(xs, low, high)
        self.add("path", cls, d=path(np.append(px, px[::-1]), np.append(high, low[::-1]), "Z"), opacity=opacity)

    def stretches(self, edges, flags, **look):
        """Shade the stretches where flags hold, flags[i] from edges[i] to edges[i + 1]."""
        turns = np.flatnonzero(np.diff(np.concatenate([[0], flags, [0]])))
        for a, b in self.x(edges)[turns].reshape(-1, 2).tolist():
            self.add("rect", "f3", x=a, y=self.box[1], width=b - a, height=self.box[3] - self.box[1], **look)

    def mark(self, x, y, kind="dot", cls="f0", size=5, **more):
        """A mark at a point; no name is set upon it."""
        x, y = float(self.x(x)), float(self.y(y))
        self.taken.append((x - size, y - size, x + size, y + size))
        self.parts.append(sign(kind, cls, x, y, size, **more))

    def name(self, x, y, words, cls="s", sides=(1, -1)):
        """Words beside a point, on one of the sides, where they cover no mark and no other words."""
        x, y, wide = float(self.x(x)), float(self.y(y)), LETTER * len(words) + 2
        spots = [(x + 9 if side > 0 else x - 9 - wide, y + 4 + 6 * step) for step in (0, 2, -2, 3, -3, 4, -4, 6, -6, 8)
                 for side in sides]
        boxes = [(left, low - 10, left + wide, low + 2) for left, low in spots]
        free = next((box for box in boxes if box[0] >= self.box[0] and box[2] <= self.box[2] + 62 and not any(
            box[0] < c and box[2] > a and box[1] < d and box[3] > b for a, b, c, d in self.taken)), boxes[0])
        self.taken.append(free)
        self.say(free[0], free[3] - 2, words, cls + " h")

    def spots(self, *points):
        """Marks, then names that cover none of them: (x, y, name, its class, look), where x and y are known."""
        points = [point for point in points if np.isfinite(point[:2]).all()]
        for x, y, _, _, *look in points:
            self.mark(x, y, *look)
        for x, y, name, cls, *_ in points:
            if name:
                self.name(x, y, name, cls)

    def legend(self, *entries):
        """What the marks mean, above on the right: (words, kind, class, and more of `sign`)."""
        x = self.box[2]
        for words, kind, cls, *more in reversed(entries):
            x -= LETTER * len(words)
            self.parts += text(x, 14, words, "s"), sign(kind, cls, x - 10, 10, **dict(*more))
            x -= 28

    def scale(self, low, high, words):
        """What the shades mean, on the right."""
        x, y1, tall = self.box[2] + 12, self.box[3], (self.box[3] - self.box[1] - 8) / 10
        for k in range(10):
            self.add("rect", "", fill=shade((k + 0.5) / 10), x=x, y=y1 - (k + 1) * tall, width=14, height=tall + 0.5)
        for k in range(0, 11, 2):
            self.say(x + 18, y1 - k * tall + 4, f"{low + k * (high - low) / 10:.3g}", "q s")
        self.say(x + 70, self.box[1] - 4, words, "s e")

    def picture(self, words, role="img"):
        """The SVG element with all parts, and the words that go with it."""
        return svg(*self.size, "".join(self.parts), words, role)


def bars(size, top, rows, below, joined=False):
    """Axes with bars from 0, or `joined` ones that continue each other, filled where they rise, open where they fall.

    A row is (name, start, end, words, marks); marks are (letter, class, value), one below the other.
    """
    left, tall = 72 + LETTER * max(len(row[0]) for row in rows), (size[1] - 44 - top) / max(len(rows), 4)
    reach = [value for _, *ends, _, marks in rows for value in (*ends, *(value for *_, value in marks))]
    axes = Axes(size, span(reach, zero=not joined), (0, 1), left, top, 20)
    axes.frame(below=below, count=0)
    for k, (name, *ends, words, marks) in enumerate(rows):
        y, (a, b) = top + k * tall, map(axes.x, ends)
        axes.add("rect", "bar f0" if b >= a else "bar l c1", x=min(a, b), y=y + 0.16 * tall, width=max(abs(b - a), 1.0),
                 height=0.68 * tall)
        for i, (letter, cls, value) in enumerate(marks):
            x, high = float(axes.x(value)), tall / len(marks)
            axes.add("path", "l " + cls, d=f"M{x:.1f} {y + i * high:.1f}v{high:.1f}")
            axes.say(x + 3, y + (i + 0.5) * high + 4, letter, "s h f" + cls[1])
        if joined and k + 1 < len(rows):
            axes.add("path", "a", d=f"M{b:.1f} {y + 0.84 * tall:.1f}v{0.32 * tall:.1f}")
        axes.say(left - 60, y + tall / 2 + 4, name, "s e")
        axes.say(left - 6, y + tall / 2 + 4, words, "s e")
    return axes


def message(size, words):
    """A picture of words alone."""
    lines = textwrap.wrap(words, max(int(size[0] / 7.5), 20))
    return svg(*size, "".join(text(size[0] / 2, size[1] / 2 + 16 * k - 8 * len(lines), line, "m")
                              for k, line in enumerate(lines)), words)


def log(result, scenario, soc_initial=1.0, size=SIZE, ghosts=()):
    """Sunlight and load, charge, and distance, hour by hour; `ghosts` are (name, class, log) of other designs."""
    width, height = size
    log, limit, third = result.log, scenario.traverse_limit_km, (height - 34) / 3
    days, far = np.insert(log.time_h / 24, 0, 0.0), float(log.distance_km[-1])
    ends = max(far, 0.01, *(float(other.distance_km[-1]) for *_, other in ghosts))
    top = 1.08 * max(ends, limit if limit <= 4 * ends else 0, 0.05)
    power, charge, distance = panels = [
        Axes(size, (0, days[-1]), ys, 44, 24 + k * third, 62, height + 2 - third * (k + 1))
        for k, ys in enumerate((span(log.solar_w, log.load_w, zero=True), (0, 105), (0, top)))]
    dark, word = log.lit_fraction < 0.5, "night" if scenario.skyline is None else "sun hidden"
    shaded = f"shaded: {word}" * bool(dark.any())
    power.say(width - 62, 17, shaded, "q s e")
    for axes in panels:
        axes.stretches(days, dark, opacity=0.1)
    power.frame("Power", "W", count=3)
    charge.frame("Charge", "%", count=2)
    distance.frame("Distance", "km", f"Earth days after {scenario.start_utc or 'sunrise'}", count=3)
    solar, load = (np.insert(values, 0, values[0]) for values in (log.solar_w, log.load_w))
    power.area(days, 0, solar, "f1", 0.14)
    power.line(days, solar, "c1")
    power.line(days, load, "c3")
    x, peak = power.x(days[solar.argmax()]), solar.max()
    power.say(min(max(x, 130), width - 92 - LETTER * len(shaded)), power.y(peak) - 5, "sunlight", "s m f1 b h")
    power.name(days[-1], load[-1], "load", "s b", (1,))
    if limit <= top:
        distance.add("path", "a", d=f"M44 {distance.y(limit):.1f}H{width - 62}", stroke_dasharray="6 4")
        distance.say(48, distance.y(limit) + 12, "end of the route", "q s h")
    distance.mark(days[-1], far, cls="f2", size=4)
    distance.name(days[-1], far, f"{far:.3g} km", "b f2", (1,))
    for name, cls, other in (*ghosts, ("", "", log)):    # the design itself last, upon the others
        hours, look = np.insert(other.time_h / 24, 0, 0.0), {"stroke_dasharray": "3 3"} if cls else {}
        charge.line(hours, 100 * np.insert(other.soc, 0, soc_initial), f"t {cls}" if cls else "c0", **look)
        distance.line(hours, np.insert(other.distance_km, 0, 0), f"t {cls}" if cls else "c2", **look)
        distance.name(days[-1], other.distance_km[-1], name, f"s b f{cls[1:]}", (1,))
    hidden = f" {word.capitalize()} in {100 * dark.mean():.0f} % of the time, shaded." if shaded else ""
    power.parts += charge.parts + distance.parts
    return power.picture(f"Three charts over {days[-1]:.0f} Earth days. Sunlight reaches {peak:.0f} W against a load "
                         f"of up to {load.max():.0f} W.{hidden} Charge falls to {100 * result.minimum_soc:.0f} % and "
                         f"ends at {100 * result.final_soc:.0f} %. Distance reaches {result.range_km:.2f} km.")


def mass(result, size=SIZE, spans=None, ghosts=()):
    """Mass line items as bars, with the 90 % interval of the total; `ghosts` are (name, class, result)."""
    items = sorted(((value, name) for name, value in result.mass.items.items() if value > 0.0005), reverse=True)
    rows = [(label(name)[0], 0.0, value, f"{value:.2f}", [(letter, cls, getattr(other.mass, name))
                                                          for letter, cls, other in ghosts]) for value, name in items]
    axes = bars(size, 24, rows, "mass (kg)")
    said = f"{result.total_mass_kg:.2f} kg in all"
    said += "" if spans is None else f", 90 % of draws {spans[0]:.1f} to {spans[1]:.1f}"
    axes.say(8, 14, said, "b")
    return axes.picture(f"Bars of mass line items: {said}; the largest is {rows[0][0]} with {rows[0][3]} kg.")


def wheel(result, design, scenario, model, size=SIZE):
    """The wheel in its soil, and its stresses along the contact at the slip balance."""
    width, height = size
    narrow, half = width < 460, round(0.52 * height)     # then one above the other
    part, tall = (width, half) if narrow else (round(0.45 * width), height - 20)
    drawn = wheel_picture(design, result, scenario, model=model, width=part, height=tall)
    if result.buried:
        return svg(width, height, drawn, alt(drawn))
    angle, normal, shear = contact(design, result, scenario, model)
    angle = np.degrees(angle)
    axes = Axes(size, (0, 1.02 * angle[-1]), span(normal, shear, zero=True, room=0.12),
                *((44, half + 26) if narrow else (part + 44, 24)))
    axes.parts.append(drawn)
    axes.frame("Stress", "kPa", "angle ahead of the lowest point (°)")
    for values, cls, name, dashes in ((normal, "0", "normal", "none"), (shear, "1", "shear", "7 3")):
        axes.line(angle, values, "c" + cls, stroke_dasharray=dashes)
        top = int(np.abs(values).argmax())
        axes.say(axes.x(angle[top]), axes.y(values[top]) - 6, name, "s b m h f" + cls)
    return axes.picture(alt(drawn))


def fleet(result, rovers, size=SIZE, spans=None, ghosts=()):
    """Range against mass: this design, with its intervals, among published rovers on the same mission."""
    masses, ranges, names = rovers
    here = result.total_mass_kg, result.range_km
    (x0, x1), (y0, y1) = spans or ((value, value) for value in here)
    spots = [*((other.total_mass_kg, other.range_km, name, "s b f" + cls[1], "dot", "l " + cls, 6)
               for name, cls, other in ghosts), (*here, "", "", "dot", "f0", 6)]
    across = [*masses, x0, x1, *(at[0] for at in spots)]
    up = span(ranges, [y0, y1, *(at[1] for at in spots)], zero=True, room=0.1)
    axes = Axes(size, (0.8 * min(across), 1.3 * max(across)), up, 50, log=True)
    axes.frame("Range", "km", "mass (kg), logarithmic")
    x, y, left, right, low, high = axes.x(here[0]), axes.y(here[1]), *map(axes.x, (x0, x1)), *map(axes.y, (y0, y1))
    axes.add("path", "l c0 t", d=f"M{left:.1f} {y:.1f}H{right:.1f}M{x:.1f} {low:.1f}V{high:.1f}")
    axes.taken += [(left, y - 1, right, y + 1), (x - 1, high, x + 1, low)]
    axes.spots(*((*at, "s", "square", "f1", 4) for at in zip(masses.round(6), ranges.round(6), names)), *spots)
    axes.legend(("this design", "dot", "f0"), ("published rovers", "square", "f1", {"size": 4}))
    rest = ", ".join(f"{n} {r:.1f} km" for n, r in zip(names, ranges))
    return axes.picture(f"Range against mass: this design reaches {result.range_km:.2f} km with "
                        f"{result.total_mass_kg:.1f} kg; on the same mission {rest}.")


def why(metric, names, shares, baseline, size=SIZE):
    """Contributions of the design variables, an Attribution, as steps from a baseline to this design."""
    values, (words, unit) = shares.contributions[metric], label(metric)
    before, after = (getattr(found, metric) for found in (shares.baseline_performance, shares.performance))
    least = max(1e-3 * np.abs(values).max(initial=0), 1e-9 * max(abs(before), abs(after)), 1e-12)    # below: rounding
    order = [i for i in np.argsort(-np.abs(values)) if abs(values[i]) > least]
    shown = order[:min(max(int((size[1] - 88) / 15) - 3, 1), 9)]
    rest = values.sum() - values[shown].sum()
    steps = [(names[i], float(values[i])) for i in shown] + ([("the rest", float(rest))] if abs(rest) > least else [])
    if not steps:
        return message(size, f"The same {words} as {baseline}: {after:.4g} {unit}. Move a slider, or choose another "
                             "baseline.")
    edges = before + np.cumsum([0.0, *(step for _, step in steps)])
    first, last = ((name, value, value, f"{value:.4g}", [("", "c3", value)])
                   for name, value in ((baseline, before), ("this design", after)))
    rows = [(name, a, b, f"{step:+.3g}".replace("-", "−"), []) for (name, step), a, b in zip(steps, edges, edges[1:])]
    axes = bars(size, 40, [first, *rows, last], named(metric), joined=True)
    said = f"{words}: {baseline} {before:.4g} to this design {after:.4g} {unit}"
    axes.say(8, 14, said if 7 * len(said) < size[0] else f"{words}: from {before:.4g} to {after:.4g} {unit}", "b")
    axes.parts += (sign("square", "f0", 14, 26, 4), text(22, 30, "more", "s"), sign("square", "l c1", 66, 26, 4),
                   text(74, 30, "less, open, to the left", "s"))
    return axes.picture(f"Steps from {before:.4g} ({baseline}) to {after:.4g} in {named(metric)}: "
                        + "; ".join(f"{name} {step:+.3g}" for name, step in steps) + ".")


def curve(x_label, metric, values, nominal, stalled, band, here, rovers=(), size=SIZE, log=False, old=False):
    """One metric along one variable, with its interval (where, low, high), this design, and the published rovers.

    The interval may be None; it is paler where it is `old`, that of a state before.
    """
    if not np.isfinite(nominal).any():
        return message(size, f"{label(metric)[0]} has no value at any {x_label}: the wheel is buried")
    axes = Axes(size, (float(values[0]), float(values[-1])), span(nominal, *(band or ())[1:], here[1]), log=log)
    axes.parts.append(HATCH)
    axes.stretches(np.concatenate([values[:1], (values[1:] + values[:-1]) / 2, values[-1:]]), stalled, **HATCHED)
    axes.frame(*label(metric), x_label)
    if band is not None:
        axes.area(*band, opacity=0.07 if old else 0.18)
    axes.line(values, nominal)
    axes.taken += zip(axes.x(values) - 1, axes.y(nominal) - 1, axes.x(values) + 1, axes.y(nominal) + 1)
    points = [(x, float(np.clip(y, *axes.ys)), name, "s", "square", "f1", 3.5) for x, y, name in zip(*rovers)
              if values[0] <= x <= values[-1] and np.isfinite(y)]
    axes.spots(*points, (*here, "", "", "dot", "f3", 6))
    stalls = [("cannot drive", "square", "", HATCHED)] if np.any(stalled) else []
    axes.legend(("this design", "dot", "f3"), ("90 % of draws", "square", "f0", {"opacity": 0.3}), *stalls)
    return axes.picture(f"{named(metric)} against {x_label}: from {nominal[0]:.3g} at {values[0]:.3g} to "
                        f"{nominal[-1]:.3g} at {values[-1]:.3g}; this design has {here[1]:.3g} at {here[0]:.3g}."
                        .replace("nan", "no value"))


def contour(x_label, y_label, metric, xs, ys, grid, stalled, here, size=SIZE):
    """One metric over two variables: shades, labelled contours, hatching where the rover cannot drive, this design."""
    if not np.isfinite(grid).any():
        return message(size, f"{label(metric)[0]} has no value at any {x_label} and {y_label}: the wheel is buried")
    from contourpy import contour_generator
    axes = Axes(size, (float(xs[0]), float(xs[-1])), (float(ys[0]), float(ys[-1])), top=42, right=86)
    low, high = span(grid, room=0)
    x, y, edges = axes.x(xs), axes.y(ys), np.linspace(low, high, 11)
    field = contour_generator(x, y, np.where(np.isfinite(grid), grid, np.nan).T)
    outer = edges + np.r_[-1, np.zeros(9), 1] * 1e-9 * max(abs(low), abs(high), 1)

    def fill(field, a, b, **look):
        outlines = [path(*points[i:j].T, "Z") for points, starts in zip(*field.filled(a, b))
                    for i, j in zip(starts, starts[1:])]
        axes.add("path", "", d="".join(outlines), fill_rule="evenodd", **look)

    for k in range(10):
        fill(field, outer[k], outer[k + 1], fill=shade((k + 0.5) / 10))
    if stalled.any():
        axes.parts.append(HATCH)
        fill(contour_generator(x, y, stalled.T.astype(float)), 0.5, 2, **HATCHED)
    axes.frame(y_label, below=x_label)
    for level in edges[2:-1:2] if np.nanmax(grid) > np.nanmin(grid) else ():
        for points in field.lines(level):
            axes.add("path", "n", d=path(*points.T), stroke="#fff", opacity=0.8)
            x, y = points[len(points) // 2]
            if len(points) > 8 and all(abs(x - a) > 24 or abs(y - b) > 12 for a, b in axes.taken):
                axes.taken.append((x, y))
                axes.add("text", "s m", f"{level:.3g}", x=x, y=y + 4,
                         style="fill:#fff;stroke:#0008;stroke-width:2.5;paint-order:stroke")
    axes.mark(*here, cls="", size=6, fill="#fff", stroke="#000", stroke_width=2)
    axes.scale(low, high, "")
    axes.say(size[0] - 4, 14, named(metric) + ", hatched: cannot drive" * bool(stalled.any()), "s b e")
    return axes.picture(f"Map of {named(metric)} over {x_label} and {y_label}: from {np.nanmin(grid):.3g} to "
                        f"{np.nanmax(grid):.3g}; the circle marks this design.")


def front(found, designs, names, result, size=SIZE, odds=None, picked=None, faded=None, title="", stale="", ghosts=()):
    """A front: one metric against another, coloured by a third; dots can be picked, this design is a cross.

    `faded` marks dots that miss a demand, `stale` says that the front belongs to another mission. The scale of the
    metric "odds" is 0 to 1; a dot whose colour is not yet known is hollow.
    """
    if not len(found):
        return message(size, f"{title}: an empty front, no design meets the constraints.")
    x, y, colour = columns = [odds if name == "odds" else getattr(found, name) for name in names]
    spots = [(*(getattr(other, field) for field in names[:2]), *look) for *look, other in (
        *((name, "s b f" + cls[1], "dot", "l " + cls, 8, other) for name, cls, other in ghosts),
        ("this design", "s b", "cross", "l c1", 6, result))]
    axes = Axes(size, *(span(values, [at[i] for at in spots]) for i, values in enumerate((x, y))),
                top=62 if stale else 44, right=86)
    axes.frame(*label(names[1]), named(names[0]), count=5)
    low, high = (0.0, 1.0) if names[2] == "odds" else span(colour, room=0)
    told = [*((*label(name), values) for name, values in zip(names, columns)),
            *((v.label, v.unit if v.unit != "1" else "", getattr(designs, name)) for name, v in DESIGN_SPACE.items())]
    for i in np.flatnonzero(np.isfinite(x) & np.isfinite(y)).tolist():
        said = [f"{words} {values[i]:.4g} {unit}".strip() for words, unit, values in told if values[i] == values[i]]
        axes.mark(x[i], y[i], cls="rdk-pick", size=6, inside=f"<title>{', '.join(said)}</title>",
                  fill=shade((colour[i] - low) / (high - low)) if colour[i] == colour[i] else "transparent",
                  stroke="currentColor", stroke_width=2.6 if i == picked else 0.7,
                  opacity=0.25 if faded is not None and faded[i] else 1, tabindex=0 if i == (picked or 0) else -1,
                  role="button", data_do=f"point:{i}", aria_label=", ".join(said[:3]))
    axes.spots(*spots)
    axes.scale(low, high, label(names[2])[0])
    axes.parts = [element("g", "", "".join(axes.parts), opacity=0.45 if stale else 1), text(8, 30, stale, "bad s"),
                  text(8, 14, title, "b" if 7.5 * len(title) < size[0] else "s b")]
    spans = ", ".join(f"{named(n)} from {min(v):.3g} to {max(v):.3g}" for n, v in zip(names, columns)
                      if np.isfinite(v).all())
    return axes.picture(f"{title}. Front of {len(x)} designs: {spans}. {stale}".rstrip(), "group")
