"""The rover and its wheel, drawn to scale as SVG: text stays text, colours follow the page, nothing else is needed."""
from __future__ import annotations

import html

import numpy as np

from . import terramechanics
from .design import Model

STYLE = (".rdk-svg{font:11.5px system-ui,'Segoe UI','DejaVu "
         "Sans',sans-serif;color:var(--rdk-ink,#1a2230);max-width:100%}"
         ".rdk-svg text{fill:currentColor}.rdk-svg .q{opacity:.78}.rdk-svg .s{font-size:10.5px}.rdk-svg "
         ".b{font-weight:600}"
         ".rdk-svg .e{text-anchor:end}.rdk-svg .m{text-anchor:middle}.rdk-svg .g{stroke:currentColor;opacity:.16}"
         ".rdk-svg .a{stroke:currentColor;opacity:.55}.rdk-svg .n{fill:none}.rdk-svg .l{fill:none;stroke-width:2}"
         ".rdk-svg .c0{stroke:var(--rdk-c0,#0072b2)}.rdk-svg .c1{stroke:var(--rdk-c1,#c04a00)}"
         ".rdk-svg .c2{stroke:var(--rdk-c2,#007a59)}.rdk-svg .c3{stroke:currentColor}.rdk-svg "
         ".f0{fill:var(--rdk-c0,#0072b2)}"
         ".rdk-svg .f1{fill:var(--rdk-c1,#c04a00)}.rdk-svg .f2{fill:var(--rdk-c2,#007a59)}.rdk-svg "
         ".f3{fill:currentColor}"
         ".rdk-svg .o{stroke:currentColor;stroke-width:1.6;fill:var(--rdk-part,#e6ebf2)}"
         ".rdk-svg .soil{fill:var(--rdk-soil,#e4e0da)}.rdk-svg .bad{stroke:var(--rdk-red,#b42318);stroke-width:2.6}"
         ".rdk-svg text.bad{fill:var(--rdk-red,#b42318);stroke:none;font-weight:600}:root.rdk-svg{background:#fff}")
"""Styles of every SVG of the collection; a page may set the variables, as the explorer does for dark themes.

A picture that stands alone, such as a notebook's output, knows nothing of its page and brings a white ground."""
DENSITY_KG_M3 = 145.0                                    # of a rover's envelope: sizes the sketched body
TRACK_RATIO = 0.9                                        # of track to wheelbase
A4_M = 0.21, 0.297


def svg(width, height, body, words, role="img"):
    """An SVG element of a size in pixels, with a sentence for those who do not see it."""
    return (f'<svg class="rdk-svg" xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:g} {height:g}" '
            f'width="{width:g}" '
            f'height="{height:g}" role="{role}" aria-label="{html.escape(words)}"><style>{STYLE}</style>{body}</svg>')


def rover_picture(design, performance=None, scenario=None, *, width=300, scale=None):
    """A single rover from the side and from above, as the text of an SVG element; show it by `IPython.display.SVG`.

    Wheels, grousers, wheelbase, array, sinkage, slope and tilt are to scale; the body is sketched from the mass. With
    `performance` the wheels sink and what fails is marked; with `scenario` the rover stands on its slope, array tilted.
    `scale` is in pixels for a metre, for rovers side by side; else the rover fills the width.
    """
    slope = 0.0 if scenario is None else float(scenario.slope_deg)
    tilt = 0.0 if scenario is None else float(scenario.panel_tilt_deg)
    obstacle = 0.0 if scenario is None else float(scenario.required_obstacle_height_m)
    r, b, rib, base = design.wheel_radius_m, design.wheel_width_m, design.grouser_height_m, design.wheelbase_m
    p = performance
    mass = 3 * design.chassis_mass_kg if p is None else p.total_mass_kg
    sunk = r / 2 if p is not None and p.buried else 0.0 if p is None else max(p.sinkage_m, 0.0)
    bad = failing(design, p, scenario)
    side, depth = np.sqrt(design.solar_area_m2), TRACK_RATIO * base
    length, tall = max(base * 0.96, 0.2), float(np.clip(0.4 * np.cbrt(mass / DENSITY_KG_M3), 0.07, 0.45))
    floor = r - sunk + 0.25 * r
    roof = floor + tall
    middle = roof + 0.03 + side / 2 * abs(np.sin(np.radians(tilt - slope)))  # of the array, clear of the roof

    def turned(x, z, angle=slope):
        cos, sin = np.cos(np.radians(angle)), np.sin(np.radians(angle))
        return x * cos - z * sin, x * sin + z * cos

    reach = base / 2 + r + rib
    corners = [turned(x, z) for x in (-reach - 0.03, reach + 0.03) for z in (-sunk - rib - 0.02, 2 * r, roof)]
    lean = np.radians(tilt)                              # from the horizontal of the world, not of the slope
    cx, cz = turned(0.0, middle)
    tips = [(cx + way * side / 2 * np.cos(lean), cz + way * side / 2 * np.sin(lean)) for way in (-1, 1)]
    xs, zs = np.array(corners + tips).T
    above = max(depth + b, side * np.cos(lean), 0.3)
    scale = scale or min((width - 66) / np.ptp(xs), 210 / np.ptp(zs), 130 / above)
    left = (width - 46 - scale * np.ptp(xs)) / 2 - scale * xs.min()
    level = 24 + scale * zs.max()
    height = level - scale * zs.min() + 8
    tone = {part: " bad" if part in bad else "" for part in ("wheels", "hubs", "array", "body", "obstacle")}

    def flat(x, z):                                      # before the slope turns the group
        return f"{scale * x:.1f} {-scale * z:.1f}"

    wheels = np.linspace(-base / 2, base / 2, 2 if design.wheel_count == 4 else 3)
    angles = 2 * np.pi * np.arange(int(design.grouser_count)) / max(int(design.grouser_count), 1)
    parts = [f'<path class="soil" d="M{flat(-3, 0)}L{flat(3, 0)}L{flat(3, -2)}L{flat(-3, -2)}Z"/>']
    if obstacle:
        parts.append(f'<rect class="soil a{tone["obstacle"]}" x="{scale * (reach + 0.01):.1f}" '
                     f'y="{-scale * obstacle:.1f}" '
                     f'width="{scale * 0.12:.1f}" height="{scale * obstacle:.1f}"/>')
    if design.wheel_count == 6:
        parts.append('<path class="n c3" stroke-width="2" '
                     f'd="M{flat(wheels[0], r - sunk)}L{flat(base / 8, floor + tall / 3)}'
                     f'L{flat(wheels[2], r - sunk)}M{flat(base / 8, floor + tall / 3)}L{flat(wheels[1], r - sunk)}"/>')
    for x in wheels:
        ribs = "".join(f"M{flat(x + r * np.sin(a), r - sunk - r * np.cos(a))}"
                       f"L{flat(x + (r + rib) * np.sin(a), r - sunk - (r + rib) * np.cos(a))}"
                       for a in angles) if rib else ""
        parts.append(f'<circle class="o{tone["wheels"]}" cx="{scale * x:.1f}" cy="{-scale * (r - sunk):.1f}" '
                     f'r="{scale * r:.1f}"/><path class="c3" stroke-width="1.6" d="{ribs}"/>'
                     f'<circle class="f3{tone["hubs"]}" cx="{scale * x:.1f}" cy="{-scale * (r - sunk):.1f}" '
                     f'r="{4.5 if tone["hubs"] else 3}"/>')
    parts.append(f'<rect class="o{tone["body"]}" x="{-scale * length / 2:.1f}" y="{-scale * roof:.1f}" rx="4" '
                 f'width="{scale * length:.1f}" height="{scale * tall:.1f}"/>')
    if p is not None:                                    # boxes as large as their share of the mass
        for k, (name, kg, at) in enumerate((("battery", p.mass.battery_kg, -0.46),
                                            ("payload", p.mass.payload_kg, 0.06))):
            share = float(np.clip(np.sqrt(kg / mass), 0.12, 0.7))
            parts.append(f'<rect class="f{2 * k}" opacity=".75" x="{scale * length * at:.1f}" '
                         f'y="{-scale * (floor + 0.08 * tall + 0.8 * tall * share):.1f}" '
                         f'width="{scale * length * 0.4:.1f}" '
                         f'height="{scale * 0.8 * tall * share * (kg > 0):.1f}"><title>{name} {kg:.2f} kg</title>'
                         "</rect>")
    parts.append(f'<path class="n c3" stroke-width="1.5" d="M{flat(0, roof)}L{flat(0, middle)}"/>')
    scene = f'<g transform="translate({left:.1f} {level:.1f}) rotate({-slope:.2f})">{"".join(parts)}</g>'
    (x0, z0), (x1, z1) = tips
    scene += (f'<line class="c0{tone["array"]}" stroke-width="5" x1="{left + scale * x0:.1f}" '
              f'y1="{level - scale * z0:.1f}" '
              f'x2="{left + scale * x1:.1f}" y2="{level - scale * z1:.1f}"/>')
    sheet = (f'<rect class="n a" x="{width - 14 - scale * A4_M[0]:.1f}" y="26" width="{scale * A4_M[0]:.1f}" '
             f'height="{scale * A4_M[1]:.1f}"/><text class="q s e" x="{width - 14:.0f}" '
             f'y="{40 + scale * A4_M[1]:.0f}">A4</text>')
    top = height + 16
    centre, across = top + 14 + scale * above / 2, width / 2
    plan = "".join(f'<rect class="o{tone["wheels"]}" x="{across + scale * (x - r):.1f}" width="{scale * 2 * r:.1f}" '
                   f'y="{centre + way * scale * depth / 2 - scale * b / 2:.1f}" height="{scale * b:.1f}" rx="2"/>'
                   for x in wheels for way in (-1, 1))
    plan += (f'<rect class="o{tone["body"]}" x="{across - scale * length / 2:.1f}" '
             f'y="{centre - scale * 0.3 * depth:.1f}" '
             f'width="{scale * length:.1f}" height="{scale * 0.6 * depth:.1f}" rx="4"/>'
             f'<rect class="f0" opacity=".22" x="{across - scale * side / 2 * np.cos(lean):.1f}" '
             f'width="{scale * side * np.cos(lean):.1f}" y="{centre - scale * side / 2:.1f}" '
             f'height="{scale * side:.1f}"/>'
             f'<text class="m s" x="{across:.0f}" y="{centre + 4:.0f}">array {design.solar_area_m2:.3g} m²</text>')
    end = max(centre + scale * max(above, side) / 2, top + 20) + 18
    said = "; ".join(bad.values())
    words = (f"Rover to scale: {design.wheel_count} wheels of {1000 * r:.0f} mm radius and {1000 * b:.0f} mm width, "
             "wheelbase "
             f"{base:.3g} m, on a slope of {slope:g} degrees, array of {design.solar_area_m2:.3g} m2 tilted {tilt:g} "
             "degrees"
             + ("" if p is None or p.buried else f", wheels {1000 * sunk:.0f} mm deep")
             + (f". Marked: {said}" if said else "")
             + ".")
    notes = (f'<text class="q s b" x="4" y="14">side, on {slope:g}°</text><text class="q s b" x="4" '
             f'y="{top + 4:.0f}">top, wheelbase {base:.3g} m</text>'
             + (f'<text class="bad s e" x="{width - 4}" y="{end:.0f}">{html.escape(said)}</text>' if said else ""))
    scene = f'<svg width="{width}" height="{height:.0f}">{scene}</svg>'       # cuts off the soil beyond
    return svg(width, round(end + 6), scene + sheet + plan + notes, words)


def failing(design, performance, scenario):
    """Parts that fail, each with a few words: "wheels", "hubs", "array", "body", "obstacle"."""
    p, bad = performance, {}
    if p is None:
        return bad
    if p.buried:
        bad["wheels"] = "wheels buried"
    elif p.stalled and p.wheel_torque_nm > design.peak_wheel_torque_nm:
        bad["hubs"] = "hubs too weak"
    elif p.stalled:
        bad["wheels"] = "wheels slip"
    if scenario is not None and p.average_solar_power_w <= design.avionics_power_w + scenario.payload_power_w:
        bad["array"] = "array too small"
    if not p.thermal_survival:
        bad["body"] = "too hot at noon" if p.cold_survival else "too cold at night"
    if scenario is not None and p.obstacle_capability_m < scenario.required_obstacle_height_m:
        bad["obstacle"] = "obstacle too high"
    return bad


def wheel_picture(design, performance, scenario, *, model=None, width=300, height=260):
    """The wheel of a single rover in its soil at the slip balance, stresses as arrows, as an SVG element's text."""
    model = Model() if model is None else model
    r, rib, p = design.wheel_radius_m, design.grouser_height_m, performance
    scale = min(width * 0.84, height * 1.1) / (2 * (r + rib))
    x, ground = width / 2, height * 0.62
    sunk = r if p.buried else p.sinkage_m
    y = ground - scale * (r - sunk)
    angles = 2 * np.pi * np.arange(int(design.grouser_count)) / max(int(design.grouser_count), 1)
    ribs = "".join(f"M{x + scale * r * np.sin(a):.1f} {y + scale * r * np.cos(a):.1f}"
                   f"L{x + scale * (r + rib) * np.sin(a):.1f} {y + scale * (r + rib) * np.cos(a):.1f}" for a in angles)
    body = (f'<rect class="soil" y="{ground:.1f}" width="{width}" height="{height - ground:.1f}"/>'
            f'<circle class="o" cx="{x}" cy="{y:.1f}" r="{scale * r:.1f}"/><path class="c3" stroke-width="1.6" '
            f'd="{ribs}"/>'
            f'<circle class="f3" cx="{x}" cy="{y:.1f}" r="3"/>')
    if p.buried:
        return svg(width, height, body + f'<text class="m bad" x="{x}" y="18">buried: no contact carries the '
                   'load</text>',
                   "The wheel is buried: no contact carries the load.")
    entry, angle, normal, shear = contact(design, performance, scenario, model, 9)
    longest = 0.3 * height / max(np.abs(normal).max(), np.abs(shear).max(), 1e-9)
    for a, n, t in zip(angle, normal, shear):            # pressed into the soil; shear drags it backwards
        px, py = x + scale * r * np.sin(a), y + scale * r * np.cos(a)
        for cls, dx, dy in (("c0", np.sin(a) * n, np.cos(a) * n), ("c1", -np.cos(a) * t, np.sin(a) * t)):
            body += f'<path class="l {cls}" d="M{px:.1f} {py:.1f}l{longest * dx:.1f} {longest * dy:.1f}"/>'
    body += (f'<text class="s" x="6" y="{height - 20}"><tspan class="f0 b">normal</tspan> and <tspan class="f1 '
             'b">shear</tspan> '
             f'stress</text><text class="s q" x="6" y="{height - 6}">sinkage {1000 * p.sinkage_m:.1f} mm, slip '
             f'{p.slip:.2f}'
             '</text>')
    return svg(width, height, body, f"Wheel of {1000 * r:.0f} mm radius, {1000 * p.sinkage_m:.1f} mm deep, in contact "
               "over "
               f"{np.degrees(entry):.0f} degrees; normal stress up to {normal.max():.1f} kPa, shear to "
               f"{shear.max():.1f} kPa.")


def contact(design, performance, scenario, model, points):
    """Entry angle (rad); angles (rad), normal and shear stress (kPa) along the contact, of shape (points,)."""
    options = {name: getattr(model, name) for name in terramechanics.OPTIONS}
    load = (performance.total_mass_kg * model.gravity_m_s2 * np.cos(np.radians(scenario.slope_deg))
            / design.wheel_count)
    forces = terramechanics.wheel_forces(design.wheel, scenario.soil, load, performance.slip, **options)
    angle = np.linspace(0, forces.entry_angle_rad, points)
    found = terramechanics.contact_stress(design.wheel, scenario.soil, forces.entry_angle_rad, performance.slip, angle,
                                          stress_level=forces.stress_level, **options)
    return forces.entry_angle_rad, angle, found.normal_stress_pa / 1000, found.shear_stress_pa / 1000
