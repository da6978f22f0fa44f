"""The explorer's page: its styles, its small script, and the HTML of its parts.

The page keeps no state. Everything that is moved, typed or pressed goes to Python through one hidden text box, as a
list of numbered events; Python answers with new HTML, and with the values of all inputs as JSON, which the script
copies into the inputs unless newer events are still under way.
"""
from __future__ import annotations

import html
from pathlib import Path

from .inputs import COEFFICIENTS, DEMANDS, DESIGN, MISSION, NUMBERS, SEARCH, SOIL, VIEWS

_FOLDER = Path(__file__).parent
STYLE, APP, SCRIPT = ((_FOLDER / name).read_text(encoding="utf-8") for name in ("page.css", "app.css", "page.js"))


def _attribute(words):
    return html.escape(str(words), quote=True)


def styles(app):
    """The style, the script and, under Voila, what makes the explorer the page."""
    dark = 'body[data-jp-theme-light="false"] .rdk-explorer'
    rules = STYLE.replace("DARK", dark)
    if app:
        start = STYLE.index("DARK")
        own = STYLE[start + 4:STYLE.index("}", start) + 1]
        rules += f"@media (prefers-color-scheme:dark) {{.rdk-explorer {own}}}"
    return f"<style>{rules}{APP * app}</style><img hidden alt='' src='data:,' onerror=\"{_attribute(SCRIPT)}\">"


def top(app):
    """The bar with the name and what acts on the whole."""
    saves = {"design.json": "Design (json)", "design.csv": "Design (csv)", "front.json": "Front (json)",
             "front.csv": "Front (csv)",
             "picture.svg": "Picture (svg)", "report.html": "Report (one page)"}
    menu = "".join(f'<button type="button" data-do="save:{name}">{words}</button>' for name, words in saves.items())
    return (f'{styles(app)}<header class="rdk-bar"{" data-app" * app}><h2>Rover explorer</h2>'
            '<button type="button" class="rdk-skip" data-js="skip">Skip to the answer</button>'
            '<span class="q">Will this rover do this mission?</span>'
            '<button type="button" data-do="undo">↶ Undo</button><button type="button" data-do="redo">↷ Redo</button>'
            '<button type="button" data-do="reset">Reset</button><button type="button" data-js="open">Open</button>'
            '<input type="file" accept=".json,.csv" hidden aria-label="open a file">'
            f'<details><summary>Save</summary><div>{menu}</div></details>'
            f'<button type="button" data-js="copy">Copy {"link" if app else "state"}</button>'
            '<button type="button" data-do="python">Python</button></header>'
            '<div class="rdk-gone" role="alert">No answer: the connection is lost. '
            + ("Reload the page; the address holds your rover and mission." if app else
               "Run the cell again. Your state, for <code>Explorer(state=\"...\")</code>: <code "
               "data-text=\"share\"></code>") + "</div>")


def row(name):
    """A slider with its label, help, number box, unit and the button back to the baseline."""
    f = NUMBERS[name]
    words = _attribute(f.label + (f" ({f.unit})" if f.unit else ""))
    return (f'<div class="rdk-row"><details class="rdk-help"><summary aria-label="about {f.label}">{f.label} '
            '<i>?</i></summary>'
            f'<p>{html.escape(f.help)}</p></details><span class="rdk-slide"><i></i><input type="range" '
            f'data-in="{name}" min="0" '
            f'max="{f.positions}" data-unit="{f.unit}" aria-label="{f.label} slider"></span><input class="rdk-box" '
            'type="text" '
            f'inputmode="decimal" autocomplete="off" data-in="{name}" aria-label="{words}"><span '
            f'class="u">{f.unit}</span>'
            f'<button type="button" class="rdk-back" data-do="reset:{name}" aria-label="reset {f.label}" '
            'title="reset">↺</button></div>')


def group(title, names):
    """Rows under a heading."""
    return f"<h3>{title}</h3>" + "".join(map(row, names))


def menu(name, words, options, cls="rdk-menu"):
    """A choice with its label."""
    items = "".join(f'<option value="{_attribute(value)}">{html.escape(str(text))}</option>' for value,
                    text in options.items())
    label = "" if words else f' aria-label="{name}"'
    return f'<label class="{cls}"><span>{words}</span><select data-in="{name}"{label}>{items}</select></label>'


def segments(name, options, words):
    """A choice among two, as buttons."""
    items = "".join(f'<button type="button" data-name="{name}" data-value="{value}">{text}</button>' for value,
                    text in options.items())
    return f'<div class="rdk-seg" role="group" aria-label="{words}">{items}</div>'


def left(menus):
    """The inputs: one page for the rover, one for the mission."""
    names = list(DESIGN)
    site = [n for n in ("latitude_deg", "duration_earth_days", "slope_deg", "traverse_limit_km") if n in MISSION]
    work = ["duty_cycle", "payload_mass_kg", "payload_power_w", "required_obstacle_height_m"]
    rest = [n for n in MISSION if n not in site + work]
    more = '<details class="rdk-more"><summary>more: {}</summary>{}</details>'
    rover = (menu("rover", "", menus["rover"], "rdk-menu rdk-sole") + group("Wheels", names[:4])
             + segments("wheel_count", menus["wheel_count"], "wheels")
             + group("Body", names[4:6]) + group("Power", names[6:])
             + more.format("coefficients of the model", menu("preset", "Model", menus["preset"])
                           + "".join(map(row, COEFFICIENTS))))
    mission = (menu("mission", "", menus["mission"], "rdk-menu rdk-sole") + '<p class="rdk-say" '
               'data-text="summary"></p>' + group("Site", site)
               + menu("soil", "soil", menus["soil"]) + group("Work", work) + group("Demands", list(DEMANDS)[:-1])
               + segments("survive", menus["survive"], "survival of heat and cold")
               + more.format("array" + ", speed limit" * ("maximum_speed_m_s" in rest), "".join(map(row, rest)))
               + more.format("site and date", menu("site", "site", menus["site"])
                             + menu("site_height_m", "array", menus["site_height_m"])
                             + '<label class="rdk-menu"><span>start (UTC)</span><input class="rdk-box" type="text" '
                             'autocomplete="off" data-in="start_utc"></label><p class="rdk-say">A site sets latitude '
                             'and skyline. A start such as 2026-11-26T12:00 brings the real sun; “none” the paper\'s, '
                             'which rises at the start.</p>')
               + more.format("numbers of the soil", "".join(map(row, SOIL))))
    return ('<nav role="tablist" aria-label="inputs"><button type="button" role="tab" data-tab="rover">Rover</button>'
            '<button type="button" role="tab" data-tab="mission"><span data-text="mission"></span></button></nav>'
            f'<section data-page="rover" aria-label="rover">{rover}</section>'
            f'<section data-page="mission" aria-label="mission" hidden>{mission}</section>')


def views(menus):
    """The tabs of the pictures, and what some of them can be asked."""
    tabs = "".join(f'<button type="button" role="tab" data-view="{name}">{words}</button>' for name,
                   words in VIEWS.items())
    small = "rdk-small"
    search = ('<button type="button" class="rdk-btn rdk-main" data-do="run">Run search</button>'
              '<button type="button" class="rdk-btn" data-do="cancel">Cancel</button>'
              + segments("live", {"False": "once", "True": "live"}, "search")
              + '<button type="button" class="rdk-btn" data-do="lightest" title="with the demands of the mission '
              'page">Lightest rover for the demands</button>'
              + menu("solve_variable", "or solve", menus["solve_variable"], small)
              + '<button type="button" class="rdk-btn" data-do="solve">for the demands</button>')
    axes = "".join(menu(f"front_{key}", words, menus[f"front_{key}"], small) for key,
                   words in (("x", "across"), ("y", "up"), ("colour", "colour")))
    goals = "".join(menu(name, words, menus[name], small) for name, words in (("range_goal", "range"),
                                                                              ("mass_goal", "mass"),
                                                                              ("slope_goal", "slope")))
    panels = {"why": menu("why_metric", "metric", menus["why_metric"], small)
              + menu("baseline", "against", menus["baseline"], small),
              "sweep": menu("sweep_metric", "metric", menus["sweep_metric"], small)
              + menu("sweep_first", "along", menus["sweep_first"], small)
              + menu("sweep_second", "and", menus["sweep_second"], small),
              "optimise": search + axes + '<details class="rdk-more rdk-wide"><summary>advanced: goals and size of the '
              'search</summary>'
              f'<div class="rdk-controls">{goals}</div>' + "".join(map(row, SEARCH)) + "</details>"
              '<progress max="1" value="0" hidden aria-label="search"></progress><span class="rdk-say" role="status" '
              'data-text="status"></span>'}
    return (f'<nav role="tablist" aria-label="pictures">{tabs}</nav>'
            + "".join(f'<div class="rdk-controls" data-for="{name}" hidden>{panel}</div>' for name,
                      panel in panels.items()))


STATUS = {"met": "✓ met", "missed": "✗ missed", "risk": "! at risk", "none": ""}


def verdict(status, sentence, why, levers, odds):
    """The answer in words; levers are (action, words)."""
    icon = {"met": "✓", "missed": "✗", "risk": "!"}[status]
    buttons = "".join(f'<button type="button" data-do="{action}">{html.escape(words)}</button>' for action,
                      words in levers)
    return (f'<section class="rdk-say1 rdk-{status}" aria-label="answer"><div role="status"><b>{icon} '
            f'{html.escape(sentence)}</b> '
            f'<span class="rdk-say">{html.escape(odds)}</span></div><div class="l">{html.escape(why)} '
            f'{buttons}</div></section>')


def card(title, value, unit, status, note, change="", at=None, interval=None, need=None, old=False):
    """A reading: value, 90 % interval, requirement, status and change since the last move."""
    gauge = ""
    known = [v for v in (at, need, *(interval or ())) if v is not None and v == v and abs(v) != float("inf")]
    if at is not None and known:
        low, high = min(known), max(known)
        low, wide = low - 0.06 * (high - low or abs(high) or 1), 1.12 * (high - low or abs(high) or 1)

        def share(v):
            return f"{min(max(100 * (v - low) / wide, 0), 100):.1f}%"

        if interval is not None:
            gauge = f'<i class="s" style="left:{share(interval[0])};right:calc(100% - {share(interval[1])})"></i>'
        gauge += f'<i class="p" style="left:{share(at)}"></i>' + (f'<i class="r" style="left:{share(need)}"></i>'
                                                                  if need is not None else "")
    return (f'<div class="rdk-card rdk-{status}"><span '
            f'class="h"><span>{title}</span><b>{STATUS[status]}</b></span><span class="v">{value} '
            f'<small>{unit}</small><span class="d">{change}</span></span><span class="rdk-gauge{" rdk-old" * old}" '
            f'aria-hidden="true">{gauge}</span>'
            f'<span class="n{" rdk-old" * old}">{html.escape(note)}</span></div>')


def table(header, rows):
    """A table; the first cell of a row names it."""
    head = "".join(f'<th scope="col">{html.escape(cell)}</th>' for cell in header)
    body = "".join(f'<tr><th scope="row">{html.escape(first)}</th>' + "".join(f"<td>{html.escape(cell)}</td>"
                                                                              for cell in rest) + "</tr>"
                   for first, *rest in rows)
    return (f'<div class="rdk-scroll" tabindex="0"><table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>'
            "</div>")


def details(header, rows):
    """All readings, folded away."""
    return f'<details class="rdk-more"><summary>all readings</summary>{table(header, rows)}</details>'


def tray(pins, colours):
    """The pinned designs; each is (letter, title, words)."""
    cards = "".join(
        f'<div class="rdk-pin" style="border-left-color:{colour}"><button type="button" data-do="use:{i}" title="back '
        'to this design">'
        f'<b>{letter} {html.escape(title)}</b><br>{html.escape(words)}</button><button type="button" '
        f'data-do="unpin:{i}" aria-label="remove {letter}">✕</button></div>'
        for i, ((letter, title, words), colour) in enumerate(zip(pins, colours)))
    empty = '<button type="button" class="rdk-empty" data-do="pin">+ pin the present design</button>' * (len(pins) < 3)
    differ = ('<button type="button" class="rdk-btn" data-do="differences">Table of differences</button>' if pins else
              '<span class="rdk-say">pinned designs</span>')
    return (f'<section class="rdk-pins" aria-label="compare"><div><b>Compare</b><br>{differ}</div>{cards}{empty}'
            "</section>")


def drawer(title, body):
    """Something to read, with a button that puts it away; empty for nothing."""
    if not body:
        return ""
    return (f'<section aria-label="{_attribute(title)}"><div class="rdk-controls"><b>{html.escape(title)}</b>'
            f'<button type="button" class="rdk-btn" data-do="close">Close</button></div>{body}</section>')
