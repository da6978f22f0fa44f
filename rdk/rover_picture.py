"""The rover and its wheel, drawn to scale as SVG: text stays text, colours follow the page, nothing else is needed."""
import html

import numpy as np

from . import terramechanics
from .design import Model
from .explain import failing

STYLE = ".rdk-svg{font:11.5px system-ui,'Segoe UI','DejaVu Sans',sans-serif;color:var(--rdk-ink,#1a2230);max-width:100%"
STYLE += "}:root.rdk-svg{background:#fff}" + "".join(f".rdk-svg {rule}" for rule in """
    *{vector-effect:non-scaling-stroke} text{fill:currentColor} .q{opacity:.78} .s{font-size:10.5px} .b{font-weight:600}
    .e{text-anchor:end} .m{text-anchor:middle} .g{stroke:currentColor;opacity:.16} .a{stroke:currentColor;opacity:.55}
    .n{fill:none} .l{fill:none;stroke-width:2} .t{stroke-width:1.2} .w{stroke-width:5} .c0{stroke:var(--rdk-c0,#0072b2)}
    .c1{stroke:var(--rdk-c1,#c04a00)} .c2{stroke:var(--rdk-c2,#007a59)} .c3{stroke:currentColor} .f3{fill:currentColor}
    .f0{fill:var(--rdk-c0,#0072b2)} .f1{fill:var(--rdk-c1,#c04a00)} .f2{fill:var(--rdk-c2,#007a59)}
    .h{paint-order:stroke;stroke:var(--rdk-card,#fff);stroke-width:3px;stroke-linejoin:round}
    .o{stroke:currentColor;stroke-width:1.6;fill:var(--rdk-part,#e6ebf2)} .soil{fill:var(--rdk-soil,#e4e0da)}
    .bad{stroke:var(--rdk-red,#b42318);stroke-width:2.6}
    text.bad{fill:var(--rdk-red,#b42318);stroke:none;font-weight:600}
    """.split())
"""Styles of every SVG of the collection; a page may set the variables, as the explorer does for dark themes.

A picture that stands alone, such as a notebook's output, knows nothing of its page and brings a white ground."""
A4_M = 0.21, 0.297


def element(tag, cls, inside="", **attributes):
    """An SVG element of a class; `inside` stands as it is, _ in the name of an attribute is -."""
    words = "".join([f' {name.replace("_", "-")}="{value:.5g}"' if isinstance(value, float)
                     else f' {name.replace("_", "-")}="{value}"' for name, value in attributes.items()])
    return f'<{tag} class="{cls}"{words}>{inside}</{tag}>' if cls else f"<{tag}{words}>{inside}</{tag}>"


def text(x, y, words, cls=""):
    return element("text", cls, html.escape(str(words), quote=False), x=float(x), y=float(y))


def svg(width, height, body, words, role="img"):
    """An SVG element of a size in pixels, with a sentence for those who do not see it."""
    return element("svg", "rdk-svg", f"<style>{STYLE}</style>{body}", xmlns="http://www.w3.org/2000/svg",
                   viewBox=f"0 0 {width:g} {height:g}", width=f"{width:g}", height=f"{height:g}", role=role,
                   aria_label=html.escape(words))


def placed(x, y, scale, up, *parts):
    """Parts drawn in metres, their origin at a pixel; `up` is -1 where heights count upwards."""
    return element("g", "", "".join(parts), transform=f"translate({x:.1f} {y:.1f}) scale({scale:.2f} {up * scale:.2f})")


def rover_picture(design, performance=None, scenario=None, *, width=300, scale=None):
    """A single rover from the side and from above, as the text of an SVG element; show it by `IPython.display.SVG`.

    Wheels, grousers, wheelbase, array, sinkage, slope and tilt are to scale; the body is sketched from the mass. With
    `performance` the wheels sink, with `scenario` the rover stands on its slope, with both what fails is marked.
    `scale` is in pixels for a metre, for rovers side by side; else the rover fills the width.
    """
    p, known = performance, performance is not None and scenario is not None
    slope, tilt, obstacle = (0.0,) * 3 if scenario is None else map(float, (
        scenario.slope_deg, scenario.panel_tilt_deg, scenario.required_obstacle_height_m))
    r, b, rib, base = design.wheel_radius_m, design.wheel_width_m, design.grouser_height_m, design.wheelbase_m
    mass = 3 * design.chassis_mass_kg if p is None else p.total_mass_kg
    sunk = 0.0 if p is None else r / 2 if p.buried else max(p.sinkage_m, 0.0)
    bad = failing(design, p, scenario) if known else {}
    tone = {part: " bad" * (part in bad) for part in ("wheels", "hubs", "array", "body", "obstacle")}
    side, depth = np.sqrt(design.solar_area_m2), Model.track_ratio * base
    length, tall = max(base * 0.96, 0.2), float(np.clip(0.4 * np.cbrt(mass / Model.envelope_density_kg_m3), 0.07, 0.45))
    floor = 1.25 * r - sunk
    roof = floor + tall
    sin, cos, lean = np.sin(np.radians(slope)), np.cos(np.radians(slope)), np.radians(tilt)
    reach, middle = base / 2 + r + rib, roof + 0.03 + side / 2 * abs(np.sin(np.radians(tilt - slope)))    # of the array
    # sizes in the world, whose level the array's tilt refers to; the rest is drawn on the slope
    corners = [(x * cos - z * sin, x * sin + z * cos) for x in (-reach - 0.03, reach + 0.03)
               for z in (-sunk - rib - 0.02, 2 * r, roof)]
    tips = [(-middle * sin + way * side / 2 * np.cos(lean), middle * cos + way * side / 2 * np.sin(lean))
            for way in (-1, 1)]
    xs, zs = np.array(corners + tips).T
    above = max(depth + b, side * np.cos(lean), 0.3)
    scale = scale or float(min((width - 66) / np.ptp(xs), 210 / np.ptp(zs), 130 / above))
    left, level = (width - 46 - scale * np.ptp(xs)) / 2 - scale * xs.min(), 24 + scale * zs.max()
    height = level - scale * zs.min() + 8

    def box(cls, x, z, wide, high, inside="", **more):
        """A rectangle in metres, from its lower left corner."""
        return element("rect", cls, inside, x=float(x), y=float(z), width=float(wide), height=float(high), **more)

    wheels = np.linspace(-base / 2, base / 2, 2 if design.wheel_count == 4 else 3)
    parts = [box("soil", -3, -2, 6, 2)]
    if obstacle:
        parts.append(box("soil a" + tone["obstacle"], reach + 0.01, 0, 0.12, obstacle))
    if design.wheel_count == 6:
        hub, pivot = r - sunk, floor + tall / 3
        parts.append(element("path", "l c3", d=f"M{-base / 2:.4f} {hub:.4f}L{base / 8:.4f} {pivot:.4f}"
                                               f"L{base / 2:.4f} {hub:.4f}M{base / 8:.4f} {pivot:.4f}L0 {hub:.4f}"))
    parts += [_wheel(design, x, r - sunk, (4.5 if tone["hubs"] else 3.0) / scale, tone) for x in wheels.tolist()]
    parts.append(box("o" + tone["body"], -length / 2, floor, length, tall, rx=4 / scale))
    if p is not None:                                    # boxes as large as their share of the mass
        for cls, name, at in ("f0", "battery", -0.46), ("f2", "payload", 0.06):
            kg = getattr(p.mass, name + "_kg")
            high = 0.8 * tall * float(np.clip(np.sqrt(kg / mass), 0.12, 0.7)) * (kg > 0)
            parts.append(box(cls, length * at, floor + 0.08 * tall, length * 0.4, high,
                             f"<title>{name} {kg:.2f} kg</title>", opacity=0.75))
    parts.append(element("path", "c3", d=f"M0 {roof:.4f}V{middle:.4f}"))
    array = element("path", "l w c0" + tone["array"], d="M{:.4f} {:.4f}L{:.4f} {:.4f}".format(*tips[0], *tips[1]))
    scene = placed(left, level, scale, -1, element("g", "", "".join(parts), transform=f"rotate({slope:g})"), array)
    scene = element("svg", "", scene, width=width, height=float(height))     # cuts off the soil beyond
    sheet = placed(width - 14, 26, scale, 1, box("n a", -A4_M[0], 0, *A4_M))
    top, wide = height + 16, side * np.cos(lean)
    centre = top + 14 + scale * max(above, side) / 2
    plan = placed(width / 2, centre, scale, 1, *(
        box("o" + tone["wheels"], x - r, way * depth / 2 - b / 2, 2 * r, b) for x in wheels for way in (-1, 1)),
        box("o" + tone["body"], -length / 2, -0.3 * depth, length, 0.6 * depth, rx=4 / scale),
        box("f0", -wide / 2, -side / 2, wide, side, opacity=0.22))
    end = max(centre + scale * max(above, side) / 2, top + 20) + 18
    notes = [text(4, 14, f"side, on {slope:g}°", "q s b"), text(width - 14, 40 + scale * A4_M[1], "A4", "q s e"),
             text(4, top + 4, f"top, wheelbase {base:.3g} m", "q s b"),
             text(width / 2, centre + 4, f"array {design.solar_area_m2:.3g} m²", "m s"),
             *(text(width / 2, end + 13 * k, said, "bad s m") for k, said in enumerate(bad.values()))]
    words = (f"Rover to scale: {design.wheel_count} wheels of {1000 * r:.0f} mm radius and {1000 * b:.0f} mm width, "
             f"wheelbase {base:.3g} m, on a slope of {slope:g} degrees, array of {design.solar_area_m2:.3g} m2 tilted "
             f"{tilt:g} degrees" + ("" if p is None or p.buried else f", wheels {1000 * sunk:.0f} mm deep")
             + (f". Marked: {'; '.join(bad.values())}" if bad else "") + ".")
    return svg(width, round(end + 13 * max(len(bad) - 1, 0) + 6), scene + sheet + plan + "".join(notes), words)


def _wheel(design, x, z, hub, tone):
    """A wheel with its grousers and its hub, in metres, height upwards."""
    r, rib, count = design.wheel_radius_m, design.grouser_height_m, int(design.grouser_count)
    angles = 2 * np.pi * np.arange(count) / max(count, 1)
    ribs = "".join(f"M{x + r * sin:.4f} {z - r * cos:.4f}l{rib * sin:.4f} {-rib * cos:.4f}"
                   for sin, cos in zip(np.sin(angles).tolist(), np.cos(angles).tolist()))
    return (element("circle", "o" + tone["wheels"], cx=x, cy=z, r=r) + element("path", "c3", d=ribs)
            + element("circle", "f3" + tone["hubs"], cx=x, cy=z, r=hub))


def wheel_picture(design, performance, scenario, *, model=Model(), width=300, height=260):
    """The wheel of a single rover in its soil at the slip balance, stresses as arrows, as an SVG element's text."""
    r, p, ground = design.wheel_radius_m, performance, height * 0.66
    scale = min(width * 0.84, height * 0.66) / (2 * (r + design.grouser_height_m))
    z = r - (r if p.buried else p.sinkage_m)
    body = _wheel(design, 0.0, z, 3 / scale, {"wheels": "", "hubs": ""})
    if p.buried:
        notes = text(width / 2, 18, "buried: no contact carries the load", "m bad")
        words = "The wheel is buried: no contact carries the load."
    else:
        along = contact(design, p, scenario, model)
        angle, normal, shear = (values[::8] for values in along)
        longest = (0.34 * height - 34) / scale / max(np.abs(normal).max(), np.abs(shear).max(), 1e-9)
        sin, cos = np.sin(angle), np.cos(angle)          # pressed into the soil; shear drags it backwards
        for cls, dx, dz in (("l c0", sin * normal, -cos * normal), ("l c1", -cos * shear, -sin * shear)):
            arrows = np.array([r * sin, z - r * cos, longest * dx, longest * dz]).T.tolist()
            body += element("path", cls, d="".join("M{:.4f} {:.4f}l{:.4f} {:.4f}".format(*arrow) for arrow in arrows))
        notes = (element("text", "s", '<tspan class="f0 b">normal</tspan> stress into the soil, <tspan '
                         'class="f1 b">shear</tspan> along it', x=6, y=height - 20)
                 + text(6, height - 6, f"sinkage {1000 * p.sinkage_m:.1f} mm, slip {p.slip:.2f}", "s q"))
        words = (f"Wheel of {1000 * r:.0f} mm radius, {1000 * p.sinkage_m:.1f} mm deep, in contact over "
                 f"{np.degrees(angle[-1]):.0f} degrees; normal stress up to {along[1].max():.1f} kPa, shear to "
                 f"{along[2].max():.1f} kPa.")
    soil = element("rect", "soil", x=0, y=ground, width=width, height=height - ground)
    return svg(width, height, soil + placed(width / 2, ground, scale, -1, body) + notes, words)


def contact(design, performance, scenario, model, points=65):
    """Angles (rad) from the lowest point to the entry, normal and shear stress (kPa) there, each of shape (points,)."""
    options = {name: getattr(model, name) for name in terramechanics.OPTIONS}
    load = (performance.total_mass_kg * model.gravity_m_s2 * np.cos(np.radians(scenario.slope_deg))
            / design.wheel_count)
    forces = terramechanics.wheel_forces(design.wheel, scenario.soil, load, performance.slip, **options)
    angle = np.linspace(0, forces.entry_angle_rad, points)
    found = terramechanics.contact_stress(design.wheel, scenario.soil, forces.entry_angle_rad, performance.slip, angle,
                                          stress_level=forces.stress_level, **options)
    return angle, found.normal_stress_pa / 1000, found.shear_stress_pa / 1000
