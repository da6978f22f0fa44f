"""The explorer's page: its styles, its small script, and the HTML of its parts.

The page keeps no state. Everything that is moved, typed or pressed goes to Python through one hidden text box, as a
list of numbered events; Python answers with new HTML, and with the values of all inputs as JSON, which the script
copies into the inputs unless newer events are still under way.
"""
import math
from html import escape
from pathlib import Path

from .inputs import MENUS, NUMBERS, VIEWS

STYLE, SCRIPT = ((Path(__file__).parent / name).read_text(encoding="utf-8") for name in ("page.css", "page.js"))
SAVES = {"design.json": "Design (json)", "design.csv": "Design (csv)", "front.json": "Front (json)",
         "front.csv": "Front (csv)", "picture.svg": "Picture (svg)", "report.html": "Report (one page)"}
PINS = ("A", "c1", "#c04a00"), ("B", "c2", "#007a59"), ("C", "c3", "#6a7488")             # letter, class, colour
STATUS = {"met": "✓ met", "missed": "✗ missed", "risk": "! at risk", "none": ""}


def button(action, words, more=""):
    return f'<button data-do="{escape(action)}" {more}>{words}</button>'


def top(app):
    """The styles, the script, and the bar with the name and what acts on the whole."""
    lost = ("Reload the page; the address holds your rover and mission." if app else
            'Run the cell again. Your state, for <code>Explorer(state="...")</code>: <code data-text="share"></code>')
    saves = "".join(button(f"save:{name}", words) for name, words in SAVES.items())
    return f"""<style>{STYLE}</style><img hidden alt="" src="data:," onerror="{escape(SCRIPT)}">
        <header class="rdk-bar"{" data-app" * app}><h2>Rover explorer</h2>
        <button class="rdk-skip" data-js="skip">Skip to the answer</button>
        <span class="q">Will this rover do this mission?</span>
        {button("undo", "↶ Undo")}{button("redo", "↷ Redo")}{button("reset", "Reset")}
        <button data-js="open">Open</button><input type="file" accept=".json,.csv" hidden aria-label="open a file">
        <details><summary>Save</summary><div>{saves}</div></details>
        <button data-js="copy">Copy {"link" if app else "state"}</button>{button("python", "Python")}</header>
        <div class="rdk-gone" role="alert">No answer: the connection is lost. {lost}</div>"""


def row(name):
    """A slider with its label, help, number box, unit and the button back to the baseline."""
    f = NUMBERS[name]
    back = button(f"reset:{name}", "↺", f'class="rdk-back" title="reset" aria-label="reset {f.label}"')
    return f"""<div class="rdk-row">
        <details class="rdk-help" name="rdk-help"><summary aria-label="about {f.label}">{f.label} <i>?</i></summary>
        <p class="rdk-over">{escape(f.help)}</p></details>
        <div class="rdk-slide"><i></i><input type="range" data-in="{name}" min="0" max="{f.positions}"
        data-unit="{f.unit}" aria-label="{f.label} slider"></div>
        <input class="rdk-box" inputmode="decimal" autocomplete="off" data-in="{name}"
        aria-label="{f"{f.label} ({f.unit})" if f.unit else f.label}">
        <span class="rdk-say">{f.unit}</span>{back}</div>"""


def group(heading):
    """The rows under a heading of the table of inputs; the heading of a group that is folded away is not shown."""
    return f"<h3>{heading}</h3>" + "".join(row(name) for name, f in NUMBERS.items() if f.heading == heading)


def more(heading, before=""):
    return f'<details class="rdk-more"><summary>more: {heading}</summary>{before}{group(heading)}</details>'


def menus(**names):
    """Choices with their labels."""
    found = ""
    for name, words in names.items():
        items = "".join(f'<option value="{escape(str(value))}">{escape(text)}</option>'
                        for value, text in MENUS[name].items())
        said, unseen = (f"<span>{words}</span>", "") if words else ("", f'aria-label="{name}"')
        found += f'<label class="rdk-menu">{said}<select data-in="{name}" {unseen}>{items}</select></label>'
    return found


def segments(name, words):
    items = "".join(f'<button data-name="{name}" data-value="{value}">{text}</button>'
                    for value, text in MENUS[name].items())
    return f'<div class="rdk-seg" role="group" aria-label="{words}">{items}</div>'


def left():
    when = """<label class="rdk-menu"><span>start (UTC)</span><input class="rdk-box" autocomplete="off"
        data-in="start_utc"></label><p class="rdk-say">A site sets latitude and skyline. A start such as
        2026-11-26T12:00 brings the real sun; “none” the paper's, which rises at the start.</p>"""
    return f"""<nav role="tablist" aria-label="inputs"><button role="tab" data-tab="rover">Rover</button>
        <button role="tab" data-tab="mission"><span data-text="mission"></span></button></nav>
        <section data-page="rover" aria-label="rover">{menus(rover="")}{group("Wheels")}
        {segments("wheel_count", "wheels")}{group("Body")}{group("Power")}
        {more("coefficients of the model", menus(preset="Model"))}</section>
        <section data-page="mission" aria-label="mission" hidden>{menus(mission="")}
        <p class="rdk-say" data-text="summary"></p>{group("Site")}{menus(soil="soil")}
        {group("Work")}{group("Demands")}{segments("survive", "survival of heat and cold")}
        {more("array, speed limit")}
        {more("site and date", menus(site="site", site_height_m="array") + when)}
        {more("numbers of the soil")}</section>"""


def views():
    run = button("run", "Run search", 'class="rdk-main"') + button("cancel", "Cancel")
    rest = (f'<div class="rdk-controls">{menus(solve_variable="solve")}{button("solve", "for the demands")}</div>'
            f'<div class="rdk-controls">{menus(range_goal="range", mass_goal="mass", slope_goal="slope")}</div>')
    panels = {"why": menus(why_metric="metric", baseline="against"),
              "sweep": menus(sweep_metric="metric", sweep_first="along", sweep_second="and"),
              "optimise": f"""{run}{segments("live", "search")}
        {button("lightest", "Lightest rover for the demands", 'title="with the demands of the mission page"')}
        {menus(front_x="across", front_y="up", front_colour="colour")}
        <details class="rdk-more"><summary>more: solve for the demands, goals, size of the search</summary>
        <div class="rdk-over">{rest}{group("size of the search")}</div></details>
        <progress max="1" value="0" hidden aria-label="search"></progress>
        <span class="rdk-say" role="status" data-text="status"></span>"""}
    tabs = "".join(f'<button role="tab" data-view="{name}">{words}</button>' for name, words in VIEWS.items())
    return f'<nav role="tablist" aria-label="pictures">{tabs}</nav>' + "".join(
        f'<div class="rdk-controls" data-for="{name}" hidden>{panel}</div>' for name, panel in panels.items())


def verdict(status, sentence, why, levers, odds, cards, readings, old=False):
    """The answer in words, its cards, and all readings folded away; levers are (action, words)."""
    tries = "".join(button(action, escape(words)) for action, words in levers)
    return f"""<section class="rdk-say1 rdk-{status}" aria-label="answer"><div role="status">
        <b>{STATUS[status][0]} {escape(sentence)}</b>
        <span class="rdk-say{" rdk-old" * old}">{escape(odds)}</span></div>
        <div class="l">{escape(why)} {tries}</div></section>{cards}
        <details class="rdk-more"><summary>all readings</summary><div class="rdk-over" tabindex="0">
        {table(("reading", "value", "90 % interval", "needed"), readings)}
        <p class="rdk-say">On a card, | marks an end that many draws share: a limit, or 0 where they stall.</p></div>
        </details>"""


def card(title, value, unit, status, note, change, at, interval, need, old):
    """A reading: value and change since the last move; a gauge with 90 % interval and requirement; a note."""
    known = [v for v in (at, *interval, need) if math.isfinite(v)]
    low, high = min(known, default=0), max(known, default=0)

    def share(v):
        return f"{100 * ((v - low) / (high - low or 1) + 0.06) / 1.12:.1f}%"

    gauge = ""
    if not math.isnan(sum(interval)):
        gauge = f'<i class="s" style="left:{share(interval[0])};right:calc(100% - {share(interval[1])})"></i>'
    for mark, v in ("p", at), ("r", need):
        if math.isfinite(v):
            gauge += f'<i class="{mark}" style="left:{share(v)}"></i>'
    stale = "rdk-old" if old else ""
    return f"""<div class="rdk-card rdk-{status}"><div class="h"><span>{title}</span><b>{STATUS[status]}</b></div>
        <div class="v">{value} <small>{unit}</small> <span class="d rdk-say">{change}</span></div>
        <div class="rdk-gauge {stale}" aria-hidden="true">{gauge}</div>
        <div class="n rdk-say {stale}">{escape(note)}</div></div>"""


def table(header, rows):
    """A table; the first cell of a row names it."""
    head = "".join(f'<th scope="col">{escape(cell)}</th>' for cell in header)
    body = "".join(f'<tr><th scope="row">{escape(first)}</th>' + "".join(f"<td>{escape(cell)}</td>" for cell in rest)
                   + "</tr>" for first, *rest in rows)
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


def tray(names, differences):
    """The pinned designs, and how each differs from the present one."""
    cards = "".join(f"""<div class="rdk-pin" style="border-left-color:{colour}">
        {button(f"use:{i}", f"<b>{escape(name)}</b><br>{escape(words)}", 'title="back to this design"')}
        {button(f"unpin:{i}", "✕", f'aria-label="remove {letter}"')}</div>"""
                    for i, ((letter, _, colour), name, words) in enumerate(zip(PINS, names, differences)))
    empty = button("pin", "+ pin the present design", 'class="rdk-empty"') if len(names) < len(PINS) else ""
    differ = "<b>Compare</b> with now<br>" + button("differences", "Table of differences") if names else (
        '<b>Compare</b><br><span class="rdk-say">pinned designs</span>')
    return f"""<section class="rdk-pins" aria-label="compare"><div>{differ}</div>{cards}{empty}</section>"""


def drawer(title, body):
    """Something to read, with a button that puts it away; empty for nothing."""
    if not body:
        return ""
    return f"""<section aria-label="{escape(title)}"><div class="rdk-controls"><b>{escape(title)}</b>
        {button("close", "Close")}</div>{body}</section>"""
