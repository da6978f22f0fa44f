"""The explorer: will this rover do this mission? Sliders that answer at once, in a notebook or as an app.

`Explorer` holds a state of plain numbers and words. A change marks the state as changed; one worker thread computes the
newest one and shows readings, picture and drawing, then the intervals, so a burst of moves costs one or two answers and
nothing stale reads as new. Everything also runs without a browser: `set` an input, `settle()`, read `result`.
"""
from __future__ import annotations

import html
import json
import math
import os
import threading
import time

import ipywidgets as W
import numpy as np

from .. import catalog, explain, pictures
from .._fields import require
from ..design import DESIGN_SPACE, Design, Model, Scenario
from ..mission import evaluate
from ..report import published
from ..rover_picture import rover_picture
from ..sampling import intervals
from ..sizing import size
from ..tradespace import pareto_front
from . import answers, page
from .inputs import DESIGN, NUMBERS, START, label, place
from .state import PINS, State, check_variable, plain
from .worker import Refresher

LIVE = 40, 24                                            # population and generations of a live front from nothing
SLOW = "why", "sweep", "optimise"                        # views whose picture may come after the readings
WIDE = 1000                                              # pixels from which a second picture stands beside the first


class Explorer(State):
    """A rover, a mission, and at once what comes of them.

    Parameters
    ----------
    rover : str or Design
        Where to start: a name of `rdk.rover_names()`, or a single design. Values beyond a slider are cut to its end,
        and a notice says so.
    scenario : str or Scenario
        A name of `rdk.scenario_names()`, or a single mission.
    view : str
        The picture shown first: "log", "mass", "wheel", "fleet", "why", "sweep" or "optimise".
    model : Model
        Coefficients, single numbers.
    state : str
        A state as `link` gives it, laid over the rest.

    Attributes
    ----------
    design, scenario, model : Design, Scenario, Model
        What the inputs show.
    result, intervals, binding : Performance, Intervals, Binding
        What the readings show, once settled.
    front : Front or None
        The last front: of a search, of the live search, or loaded.
    state : dict
        Every input by its name, as `set` takes them.
    error : str
        What went wrong in the last answer; empty where nothing did.

    Examples
    --------
    >>> explorer = Explorer("Rashid-1", "polar_prospecting")
    >>> explorer.set(slope_deg=30)
    >>> explorer.settle()
    >>> explorer.binding.key
    'traction'
    """

    def __init__(self, rover="Rashid-1", scenario="equatorial_mare_traverse", *, view="log", model=Model(), state=""):
        self.error, self.intervals, self.binding = "", None, None
        self._thread, self._stop, self._heard, self._table = None, threading.Event(), 0, []
        self._drawer = self._progress = ("", "")
        self._picture = self._status = self._shown = ""
        self._app, self._size = os.environ.get("SERVER_SOFTWARE", "").startswith("voila"), (600, 380)
        self._refresher = None
        rover = catalog.rover(rover) if isinstance(rover, str) else rover
        scenario = catalog.scenario(scenario) if isinstance(scenario, str) else scenario
        require(rover=(rover, Design), scenario=(scenario, Scenario), model=(model, Model))
        super().__init__(rover, scenario, model)
        self._build()
        self._refresher = Refresher(self._refresh)
        self.set(view=view)
        if text := state or (os.environ.get("QUERY_STRING", "") if self._app else ""):
            self._restore_link(text)
        self.settle()

    def _poke(self):
        if self._refresher is not None:
            self._refresher.poke()

    def settle(self, timeout_s=60):
        """Wait until readings and picture show the present state."""
        self._refresher.settle(timeout_s)

    # ---- the page ---------------------------------------------------------------------------------------------

    def _build(self):
        """The widgets: seven of HTML, and the box through which the page speaks."""
        fixed = {"top": page.top(self._app), "left": page.left(self.menus), "views": page.views(self.menus)}
        self.parts = {name: W.HTML(fixed.get(name, "")) for name in
                      ("top", "drawer", "left", "verdict", "views", "picture", "side", "tray", "data")}
        self.bridge = W.Text(layout=W.Layout(display="none"))
        for name, part in (*self.parts.items(), ("bridge", self.bridge)):
            part.add_class(f"rdk-{name}")
        grid = W.Box([*self.parts.values(), self.bridge])
        grid.add_class("rdk-grid")
        self.widget = W.VBox([grid])
        self.widget.add_class("rdk-explorer")
        self.bridge.observe(self._hear, "value")

    def _hear(self, change):
        """Act on the page's events: slide, type, choose, do, size."""
        try:
            events = json.loads(change.new)
        except ValueError:
            return
        with self._lock:
            for number, kind, *arguments in events:
                if number > self._heard:
                    self._heard = number
                    if kind != "size":                   # a page that takes its place is no answer to words
                        self._notice = ("", "")
                    try:
                        getattr(self, "_on_" + kind)(*arguments)
                    except ValueError as error:
                        self._notice = ("alert", str(error))
            self._refresher.poke()

    def _on_slide(self, name, position):
        if position != NUMBERS[name].position(self.state[name]):
            self._move({name: NUMBERS[name].at(position)}, (name, self._heard))      # events count milliseconds

    def _on_type(self, name, text):
        value, said = NUMBERS[name].read(text) if name in NUMBERS else (text, "")
        self.set(**{name: value})
        if said:
            self._notice = ("status", said)

    def _on_choose(self, name, text):
        self.set(**{name: next((value for value in self.menus[name] if str(value) == text), text)})

    def _on_size(self, width, height):
        self._size = min(max(int(width), 300), 2400), min(max(int(height), 260), 800)

    def _on_do(self, action, *more):
        """A button: its name, and after a colon what it is about."""
        verb, _, about = action.partition(":")
        if verb in ("undo", "redo", "pin"):
            getattr(self, verb)()
        elif verb == "reset":
            self.reset(about or None)
        elif verb == "unpin":
            self.unpin(int(about))
        elif verb == "use" and int(about) < len(self._pins):
            self._change_design(self._pins[int(about)][1])
        elif verb == "lever":
            field = NUMBERS[about]
            value, said = field.cut(float(f"{1.1 * self.state[about]:.6g}"))
            self.set(**{about: value})
            self._notice = ("status", said or f"{field.label} raised to {field.words(value)} {field.unit}")
        elif verb == "point":
            self.pick(int(about))
        elif verb == "run":
            self.optimise()
        elif verb == "lightest":
            self.lightest()
        elif verb == "cancel":
            self._stop.set()
        elif verb == "load":
            self.load(*more)
        elif verb == "solve":
            self.solve(self.state["solve_variable"])
        elif verb == "save":
            self._drawer = ("Saved", self._deliver(about))
        elif verb == "python":
            self._drawer = ("Python for " + self.state["script"], "<pre "
                            f"tabindex='0'>{html.escape(self.python())}</pre>"
                            + page.menu("script", "instead for", self.menus["script"]))
        elif verb == "copied":
            self._drawer = ("Copied: " + ("the address of this state" if self._app
                                          else "the state, for Explorer(state=...)"),
                            f"<pre tabindex='0'>{html.escape(self.link or '(as it starts)')}</pre>")
        elif verb == "differences":
            self._drawer = ("Differences", self._differences())
        elif verb == "close":
            self._drawer = ("", "")

    def _repr_mimebundle_(self, **kwargs):
        """The widgets; for readers without a kernel, the readings as text and the picture."""
        still = {"text/plain": self.text()}
        if self.image() is not None and not self.state["live"]:
            still["image/svg+xml"] = self.image().data
        return {**self.widget._repr_mimebundle_(**kwargs), **still}

    def image(self):
        """The picture as it stands, an IPython SVG with its words; None where there is none."""
        from IPython.display import SVG
        return SVG(self._picture) if self._picture.startswith("<svg") else None

    def text(self):
        """The readings as plain text."""
        if self.error:
            return self.error
        rows = [f"{name:24}{value:>12}   {span:22}{limit}".rstrip() for name, value, span, limit in self._table]
        return "\n".join([explain.verdict(self.design, self.scenario, self.result, model=self.model)[1],
                          self.binding.sentence, self.binding.detail, *rows])

    # ---- answers ----------------------------------------------------------------------------------------------

    def _refresh(self):
        """Compute the present state and show it; an error becomes a message, never a traceback in a thread."""
        with self._lock:
            now, heard = dict(self.state), self._heard
            design, scenario, model, before = self.design, self.scenario, self.model, self._before
        see, view = self.parts, now["view"]
        if view in SLOW or view != self._shown:
            self._tell(heard, busy=True)
        try:
            result = evaluate(design, scenario, model=model)
            binding = explain.binding(design, scenario, result, model=model)
            self.result, self.binding, self.error = result, binding, ""
            see["verdict"].value, self._table = answers.answer(design, scenario, result, binding, self.intervals,
                                                               before, model, old=True)
            see["side"].value = rover_picture(design, result, scenario, width=290)
            self._show(now, design, scenario, model, result, None)
            self._show_tray(scenario, model, result)
            self._tell(heard, busy=self._refresher.overtaken)
            if not self._refresher.overtaken:            # intervals for the newest state alone
                self.intervals = intervals(design, scenario, draws=answers.DRAWS, model=model)
                if view in ("fleet", "mass") or view == "log" and self._size[0] >= WIDE:     # they show intervals
                    self._show(now, design, scenario, model, result, self.intervals)
                see["verdict"].value, self._table = answers.answer(design, scenario, result, binding, self.intervals,
                                                                   before, model)
        except Exception as error:                       # anything at all: the app must go on and say what happened
            self.error, self._picture = f"{type(error).__name__}: {error}", ""
            see["picture"].value = f'<div role="alert">{html.escape(self.error)}</div>'
            self._tell(heard)

    def _show(self, now, design, scenario, model, result, sure):
        """Draw the view, and beside it another where the page is wide."""
        width, height = self._size
        names = [now["view"]] + (["mass" if now["view"] == "log" else "log"] if width >= WIDE else [])
        size = (width - 14 * (len(names) - 1)) // len(names), height
        drawn = [self._draw(name, now, design, scenario, model, result, size, sure) for name in names]
        self._picture, self._shown = drawn[0], now["view"]
        self.parts["picture"].value = f'<div class="rdk-pictures">{"".join(drawn)}</div>'

    def _ghosts(self, scenario, model):
        return [(letter, cls, evaluate(design, scenario, model=model)) for (letter, cls, _),
                (_, design) in zip(PINS, self._pins)]

    def _draw(self, view, now, design, scenario, model, result, size, sure):
        if view == "log":
            ghosts = [(letter, cls, found.log) for letter, cls, found in self._ghosts(scenario, model)]
            return pictures.log(result, scenario, model.soc_initial, size, ghosts)
        if view == "mass":
            return pictures.mass(result, size, sure and (sure.low["total_mass_kg"], sure.high["total_mass_kg"]),
                                 self._ghosts(scenario, model))
        if view == "wheel":
            return pictures.wheel(result, design, scenario, model, size)
        if view == "fleet":
            names, designs = published()
            others = evaluate(designs, scenario, model=model)
            spans = sure and [(sure.low[n], sure.high[n]) for n in ("total_mass_kg", "range_km")]
            return pictures.fleet(result, (others.total_mass_kg, others.range_km, names), size, spans,
                                  self._ghosts(scenario, model))
        if view == "why":
            reference = self._start if now["baseline"] == START else self._rovers[now["baseline"]]
            return answers.explained(design, reference, now["baseline"], scenario, model, now["why_metric"], size)
        if view == "sweep":
            fields = dict.fromkeys(filter(None, (now["sweep_first"], now["sweep_second"])))
            return answers.swept(design, scenario, model, list(fields), now["sweep_metric"], size)
        if now["live"] and (self.front is None or not self._fits(self.front, scenario, model)
                            or self._recipe is not None):
            self.front, self._recipe = live_front(scenario, self.front, model), None
        if self.front is None:
            return (f'<div style="padding:60px 20px;text-align:center;width:{size[0] - 60}px"><p>No front yet: designs '
                    'that no other beats in every '
                    'goal.</p><p style="margin:14px"><button type="button" class="rdk-btn rdk-main" data-do="run">Run '
                    'search</button></p></div>')
        return self._draw_front(now, scenario, model, result, size)

    def _fits(self, front, scenario, model):
        """Whether a front belongs to the mission and the model as they stand."""
        return front.scenario.replace(name="") == plain(scenario).replace(name="") and front.model == model

    def _draw_front(self, now, scenario, model, result, size):
        front, names = self.front, [now["front_" + key] for key in ("x", "y", "colour")]
        columns = [np.asarray(getattr(front.performance, name), float) for name in names]
        where = front.scenario.name.replace("_", " ")
        stale = "" if self._fits(front, scenario, model) else f"searched for {where} as it was: run again"
        same = np.ones(len(front), bool)
        for name in DESIGN_SPACE:
            same &= np.asarray(getattr(front.designs, name)) == now[name]
        picked = int(same.argmax()) if same.any() else None
        faded = ~answers.meets(front.performance, scenario.problem.constraints)
        words = f"{'Live front' if now['live'] else 'Front'} of {where}: {len(front)} designs"
        return pictures.front(*columns, names, [float(getattr(result, name)) for name in names], size, picked, faded,
                              words, stale or front.message, self._ghosts(scenario, model), front.designs)

    def _show_tray(self, scenario, model, result):
        pins = []
        for (letter, _, other), (name, _) in zip(self._ghosts(scenario, model), self._pins):
            parts = [(other.total_mass_kg - result.total_mass_kg, "kg"), (other.range_km - result.range_km, "km"),
                     (other.slope_capability_deg - result.slope_capability_deg, "°")]
            pins.append((letter, name, " · ".join(f"{round(v, 1) + 0.0:+.1f} {unit}".replace("-", "−")
                                                  for v, unit in parts)))
        self.parts["tray"].value = page.tray(pins, [colour for *_, colour in PINS])

    def _differences(self):
        """Table of the pinned designs beside the present one, on the present mission."""
        designs = [self.design, *(design for _, design in self._pins)]
        found = [evaluate(design, self.scenario, model=self.model) for design in designs]
        rows = [(pictures.label(name)[0], *(answers.words(float(getattr(p, name)), digits, pictures.label(name)[1])
                                            for p in found))
                for name, digits in answers.ROWS]
        rows += [(f.label, *(f"{f.words(getattr(d, name))} {f.unit}" for d in designs)) for name, f in DESIGN.items()
                 if len({getattr(d, name) for d in designs}) > 1]
        return page.table(("", "now", *(f"{letter} {name}" for (letter, *_), (name, _) in zip(PINS, self._pins))), rows)

    def _tell(self, heard, busy=False):
        """Send the values of all inputs and the small texts to the page; `heard` is the last event that is answered."""
        with self._lock:
            now, link = self.state, self.link
            numbers = {name: (f.position(now[name]), f.words(now[name]),
                              100 * f.position(self._base.get(name, now[name])) / f.positions,
                              int(name in self._base and now[name] != self._base[name])) for name, f in NUMBERS.items()}
            m, (done, of) = self.scenario, self._progress if self._thread else (0, 1)
            route = "no limit" if math.isinf(m.traverse_limit_km) else f"{m.traverse_limit_km:g} km"
            mission = f"Mission: {place(m.latitude_deg)}, {m.slope_deg:g}°"
            texts = {"mission": mission, "status": self._status, "share": link,
                     "summary": f"{place(m.latitude_deg)}, {m.duration_earth_days:g} "
                     f"days from {m.start_utc or 'sunrise'}, {m.slope_deg:g}° in {m.soil.name}; drives "
                     f"{100 * m.duty_cycle:g} % of the time, route {route}."}
            chosen = {name: str(now[name]) for name in (*self.menus, "start_utc")}
            off = {"undo": not self._past, "redo": not self._future, "run": bool(self._thread),
                   "lightest": bool(self._thread), "cancel": not self._thread}
            told = {"ack": heard, "v": numbers, "c": chosen, "t": texts, "off": off,
                    "p": (done, of, bool(self._thread)), "link": link, "share": link, "busy": busy}
            (role, notice), (head, body) = self._notice, self._drawer
        said = f'<div role="{role}">{html.escape(notice)}</div>' if notice else ""
        self.parts["drawer"].value = (f"<div>{said}</div>" if said else "") + page.drawer(head, body)
        self.parts["data"].value = f'<div data-state="{html.escape(json.dumps(told), quote=True)}"></div>'

    # ---- fronts and solutions ---------------------------------------------------------------------------------

    def _problem(self):
        """What `pareto_front` needs for the search that the inputs pose."""
        posed = self._posed()
        return {"population": self.state["population"], "generations": self.state["generations"],
                "seed": self.state["seed"], "objectives": dict(posed.objectives),
                "constraints": list(posed.constraints)}

    def optimise(self, wait=False):
        """Search in the background for the mission as it stands; with `wait`, return when the search has ended."""
        self._begin(self._search, (plain(self.scenario), self.model, self._problem()), wait)

    def lightest(self, wait=False):
        """Put the lightest rover that meets the demands on the sliders; found in the background by `rdk.size`."""
        wanted = [("feasible", ">=", 1), *self._posed().constraints]
        self._begin(self._size_up, (plain(self.scenario), self.model, wanted), wait)

    def _begin(self, work, arguments, wait):
        """Start a search, unless one is under way."""
        with self._lock:
            if self._thread is None:
                self.state["live"] = False
                self._stop.clear()
                self._progress, self._status = (0, 1), "starting"
                self._thread = threading.Thread(target=work, args=arguments)
                self._thread.start()
            thread = self._thread
        self._poke()
        if wait:
            thread.join()
            self.settle()

    def _ended(self):
        """Whether a search must stop: it was cancelled, or the program is ending."""
        return self._stop.is_set() or not threading.main_thread().is_alive()

    def _size_up(self, scenario, model, wanted):
        """The thread of `lightest`."""
        def follow(progress):
            self._progress, self._status = (progress.generation, progress.generations), "looking for the lightest rover"
            if progress.generation % 20 == 1:
                self._poke()
            return self._ended()

        try:
            found = size(scenario, wanted, model=model, on_generation=follow)
            held = ", ".join(label(name.split(" ")[0])[0] for name in found.binding) or "nothing"
            said = found.message or (f"lightest: {found.performance.total_mass_kg:.2f} kg, held by {held}; all demands "
                                     f"hold in {100 * found.odds:.0f} % of draws")
        except Exception as error:
            found, said = None, f"the search failed: {error}"
        with self._lock:
            if found is not None:
                self._change_design(found.design)
            self._thread, self._status = None, said
            self._notice = ("alert" if found is None or found.message else "status", said)
            self._poke()

    def _search(self, scenario, model, problem):
        """The search's thread: progress, a growing front, cancel."""
        drawn = time.monotonic()

        def follow(progress):
            nonlocal drawn
            self._progress = progress.generation, problem["generations"]
            self._status = "generation {} of {}".format(*self._progress)
            if time.monotonic() - drawn > 0.4:
                self.front, self._recipe = progress.front(), None
                self._refresher.poke()
                drawn = time.monotonic()
            return self._ended()

        try:
            front = pareto_front(scenario, model=model, on_generation=follow, warn=False, **problem)
            done = front.message or f"done: {len(front)} designs after {problem['generations']} generations"
            recipe = {**problem, "generations": len(front.objective_history)}    # fewer where it was cancelled
        except Exception as error:
            front, recipe, done = None, None, f"the search failed: {error}"
        with self._lock:
            self.front, self._recipe, self._thread, self._status = front, recipe, None, done
            self._refresher.poke()

    def solve(self, name):
        """Move one design variable to the nearest value that meets the demands; a notice says what came of it."""
        value, said = answers.solved(self.design, self.scenario, self.model, check_variable(name))
        if value is not None:
            self.set(**{name: value})
        self._notice = ("alert" if value is None else "status", said)
        self._refresher.poke()


def live_front(scenario, start=None, model=Model()):
    """A Front quick enough to follow a slider: a small population, warm-started from the last, so less complete."""
    population, generations = LIVE
    return pareto_front(plain(scenario), population=population, seed=1, start=start, model=model, warn=False,
                        generations=generations if start is None else generations // 2)
