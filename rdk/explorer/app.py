"""The explorer: will this rover do this mission? Sliders that answer at once, in a notebook or as an app.

`Explorer` holds a state of plain numbers and words. A change marks the state as changed; one worker thread computes the
newest one and shows readings, picture and drawing, then the intervals, so a burst of moves costs one or two answers and
nothing stale reads as new. Everything also runs without a browser: `set` an input, `settle()`, read `result`.
"""
import base64
import contextlib
import html
import json
import os
import threading
import time
from concurrent.futures import ThreadPoolExecutor

import ipywidgets as W
import numpy as np

from .. import catalog, explain
from ..design import Model, Problem
from ..mission import evaluate
from ..rover_picture import rover_picture
from ..sampling import intervals
from ..sizing import size
from ..tradespace import pareto_front
from . import answers, page
from .inputs import DESIGN, MENUS, METRICS, NUMBERS, ODDS, check, label, place
from .state import State

LIVE = 40, 24                                            # population and generations of a live front from nothing
SLOW = "why", "sweep", "optimise"                        # views whose picture may come after the readings
YIELD_S = 0.01                                           # for an answer to leave before its intervals are computed
WIDE = 1000                                              # pixels from which a second picture stands beside the first
RATED = 8                                                # designs whose odds are computed between two looks for news


class Explorer(State):
    """A rover, a mission, and at once what comes of them.

    Parameters
    ----------
    rover, scenario : str or Design, str or Scenario
        Names of `rdk.rover_names()` and `rdk.scenario_names()`, or single records. Values beyond a slider are cut to
        its end, and a notice says so.
    view : str
        The picture shown first: "log", "mass", "wheel", "fleet", "why", "sweep" or "optimise".
    model : Model
        Coefficients, single numbers.
    state : str
        A state as `link` gives it, laid over the rest.

    Attributes
    ----------
    result, intervals, binding : Performance, Intervals, Binding
        What the readings show, once settled.
    front : Front or None
        The last front: of a search, of the live search, or loaded.
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
        self._worker = ThreadPoolExecutor(1)             # awaited at exit: a daemon in compiled code would abort
        self._wanted = self._answered = self._last = None
        self._thread, self._stop, self._progress, self._status = None, threading.Event(), (0, 1), ""
        self._heard, self._acked, self._size = 0, 0, (600, 380)
        self._picture, self._table, self._drawer, self._reading = "", [], ("", ""), ""
        self._kept = {"why": None, "odds": (None, None), "band": (None, None)}
        self._app = os.environ.get("SERVER_SOFTWARE", "").startswith("voila")
        super().__init__(catalog.rover(rover) if isinstance(rover, str) else rover,
                         catalog.scenario(scenario) if isinstance(scenario, str) else scenario, model)
        fixed = {"top": page.top(self._app), "left": page.left(), "views": page.views()}
        self.parts = {name: W.HTML(fixed.get(name, "")).add_class(f"rdk-{name}") for name in
                      ("top", "drawer", "left", "verdict", "views", "picture", "side", "tray", "data")}
        self.bridge = W.Text(layout=W.Layout(display="none")).add_class("rdk-bridge")
        self.bridge.observe(self._hear, "value")
        grid = W.Box([*self.parts.values(), self.bridge]).add_class("rdk-grid")
        self.widget = W.VBox([grid]).add_class("rdk-explorer")
        self.set(view=view)
        if text := state or (os.environ.get("QUERY_STRING", "") if self._app else ""):
            self._restore_link(text)
        self.settle()

    # ---- the page ---------------------------------------------------------------------------------------------

    def _hear(self, change):
        """Act on the page's events: slide, set, do, size."""
        with self._lock:
            for number, kind, *arguments in json.loads(change.new):
                if number > self._heard:
                    self._heard = number
                    if kind != "size":                   # a page that takes its place is no answer to words
                        self._notice = ("", "")
                    try:
                        getattr(self, "_on_" + kind)(*arguments)
                    except ValueError as error:
                        self._notice = ("alert", str(error))
            self._poke()

    def _on_slide(self, name, position):
        if position != NUMBERS[name].position(self.state[name]):
            with self._step((name, self._heard)):        # events count milliseconds
                self._assign(name, NUMBERS[name].at(position))

    def _on_set(self, name, text):
        value, said = NUMBERS[name].read(text) if name in NUMBERS else (text, "")
        self.set(**{name: value})
        if said:
            self._notice = ("status", said)

    def _on_size(self, width, height):
        self._size = min(max(int(width), 300), 2400), min(max(int(height), 260), 800)

    def _on_do(self, action, *more):
        """A button: its name, and after a colon what it is about."""
        verb, _, about = action.partition(":")
        do = {"undo": self.undo, "redo": self.redo, "pin": self.pin, "run": self.optimise, "lightest": self.lightest,
              "cancel": self._stop.set, "reset": lambda: self.reset(about or None),
              "unpin": lambda: self.unpin(int(about)), "point": lambda: self.pick(int(about)),
              "use": lambda: [self._take(design) for _, design in self._pins[int(about):][:1]],
              "lever": lambda: self._raise(about), "load": lambda: self.load(*more),
              "solve": lambda: self.solve(self.state["solve_variable"])}
        if verb in do:
            do[verb]()
        else:
            self._reading, self._drawer = verb, self._read(verb, about)

    def _raise(self, name):
        field = NUMBERS[name]
        value, said = field.cut(float(f"{1.1 * self.state[name]:.6g}"))
        self.set(**{name: value})
        self._notice = ("status", said or f"{field.label} raised to {field.words(value)} {field.unit}")

    def _read(self, verb, name):
        """Title and HTML of what a button gives to read; "close" gives nothing."""
        if verb == "save":
            data = base64.b64encode(self.file(name).encode()).decode()
            return "Saved", (f'<p><a data-deliver download="{name}" href="data:application/octet-stream;base64,{data}">'
                             f"{name}</a>: in the folder of your downloads.</p>")
        if verb == "python":
            return "Python for what is shown", f"<pre tabindex='0'>{html.escape(self.python())}</pre>"
        if verb == "copied":
            what = "the address of this state" if self._app else "the state, for Explorer(state=...)"
            return f"Copied: {what}", f"<pre tabindex='0'>{html.escape(self.link)}</pre>"
        return ("Differences", self._differences()) if verb == "differences" else ("", "")

    def _repr_mimebundle_(self, **kwargs):
        """The widgets; for readers without a kernel, the readings as text and the picture."""
        still = {"text/plain": self.text()}
        if (picture := self.image()) and not self.state["live"]:
            still["image/svg+xml"] = picture.data
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
        return "\n".join([explain.verdict(self.design, self.scenario, self.result)[1],
                          self.binding.sentence, self.binding.detail, *rows])

    # ---- answers ----------------------------------------------------------------------------------------------

    def _poke(self):
        """Ask for an answer to the state as it is now; what one asks who holds the lock is answered once."""
        with self._lock, contextlib.suppress(RuntimeError):                  # the program may be ending
            self._wanted = object()
            self._last = self._worker.submit(self._refresh)

    @property
    def _overtaken(self):
        """A newer state waits for its answer."""
        return self._wanted is not self._answered

    def settle(self, timeout_s=60):
        """Wait until readings and picture show the present state; a TimeoutError where that takes longer."""
        self._last.result(timeout_s)

    def _refresh(self):
        """Compute the newest state and show it; an error becomes a message, never a traceback in a thread."""
        with self._lock:
            if not self._overtaken:
                return
            self._answered, self._acked = self._wanted, self._heard
            now, pinned, before, reference = self.state, self.pinned, self._before, self._reference
            design, scenario, model = self._now
        view = now["view"]
        if view in SLOW:
            self._tell(busy=True)
        try:
            result = self.result = evaluate(design, scenario, model=model)
            binding = self.binding = explain.binding(design, scenario, result, model=model)
            self.error = ""
            levers = explain.levers(design, scenario, result, binding.key, model=model)
            ghosts = [(letter, cls, evaluate(other, scenario, model=model))
                      for (letter, cls, _), other in zip(page.PINS, pinned.values())]
            spans = self.intervals or intervals(design, scenario, draws=answers.DRAWS, model=model)
            answer = answers.Answer(now, design, scenario, model, result, binding, levers, before, ghosts, reference,
                                    spans, False, self.front, self._kept)
            self.parts["verdict"].value, self._table = answers.answer(answer)
            self.parts["side"].value = rover_picture(design, result, scenario, width=290)
            self.parts["tray"].value = page.tray(pinned, answers.against(answer))
            self._show(answer)
            self._tell()
            time.sleep(YIELD_S)
            if not self._overtaken:                      # intervals for the newest state alone
                self.intervals = intervals(design, scenario, draws=answers.DRAWS, model=model)
                answer = answer._replace(spans=self.intervals, sure=True)
                if view in ("fleet", "mass") or view == "log" and self._size[0] >= WIDE:     # they show intervals
                    self._show(answer)
                self.parts["verdict"].value, self._table = answers.answer(answer)
                if view == "sweep" and not now["sweep_second"]:
                    self._kept["band"] = answers.band_of(answer, lambda: self._overtaken)
                    self._show(answer)
                self._rate(answer)
        except Exception as error:                       # anything at all: the app must go on and say what happened
            self.error, self._picture = f"{type(error).__name__}: {error}", ""
            self.parts["picture"].value = f'<div role="alert">{html.escape(self.error)}</div>'
            self._tell()

    def _show(self, answer):
        """Draw the view, and beside it another where the page is wide."""
        (width, height), view = self._size, answer.now["view"]
        if view == "optimise" and answer.now["live"] and (
                self._recipe is not None or not answers.fits(self.front, answer.scenario, answer.model)):
            self.front, self._recipe = pareto_front(    # small and warm-started, to follow a slider: less complete
                answer.scenario.replace(problem=Problem()), population=LIVE[0], seed=1, start=self.front, warn=False,
                generations=LIVE[1] // (1 if self.front is None else 2), model=answer.model), None
        names = [view] + (["mass" if view == "log" else "log"] if width >= WIDE else [])
        answer = answer._replace(front=self.front)
        size = (width - 14 * (len(names) - 1)) // len(names), height
        drawn = [answers.PICTURES[name](answer, size) for name in names]
        self._picture = drawn[0]
        self.parts["picture"].value = f'<div class="rdk-pictures">{"".join(drawn)}</div>'

    def _rate(self, answer):
        """The odds of the front's designs where they are its colour, some at a time; news come first."""
        front, demands = self.front, answers.asked(answer.scenario)
        if answer.now["view"] != "optimise" or answer.now["front_colour"] != ODDS or not front:
            return
        if self._kept["odds"][0] != (front, demands):
            self._kept["odds"] = (front, demands), np.full(len(front), np.nan)
        odds = self._kept["odds"][1]
        while np.isnan(odds).any() and not self._overtaken:
            some = np.flatnonzero(np.isnan(odds))[:RATED]
            odds[some] = intervals(front.designs[some], front.scenario, draws=answers.DRAWS,
                                   model=front.model).share(demands)
            self._status = f"odds of {np.isfinite(odds).sum()} of {len(front)} designs, by {answers.DRAWS:,} draws each"
            self._show(answer)
            self._tell()

    def _differences(self):
        """Table of the pinned designs beside the present one, on the present mission."""
        designs = {"now": self.design} | self.pinned
        found = [evaluate(design, self.scenario, model=self.model) for design in designs.values()]
        rows = [(label(name)[0], *(answers.words(float(getattr(p, name)), digits, label(name)[1]) for p in found))
                for name, digits in METRICS.items()]
        for name, field in DESIGN.items():
            values = [getattr(design, name) for design in designs.values()]
            if len(set(values)) > 1:
                rows.append((field.label, *(f"{field.words(value)} {field.unit}" for value in values)))
        return page.table(("", *designs), rows)

    def _tell(self, busy=False):
        """Send the values of all inputs, the small texts, and which event is answered to the page."""
        with self._lock:
            now, m, running = self.state, self.scenario, self._thread is not None
            base = now | self._values(*self._base)
            numbers = {name: (f.position(now[name]), f.words(now[name]), 100 * f.position(base[name]) / f.positions,
                              int(now[name] != base[name])) for name, f in NUMBERS.items()}
            route = "no limit" if np.isinf(m.traverse_limit_km) else f"{m.traverse_limit_km:g} km"
            texts = {"mission": f"Mission: {place(m.latitude_deg)}, {m.slope_deg:g}°", "status": self._status,
                     "share": self.link, "summary": f"{place(m.latitude_deg)}, {m.duration_earth_days:g} days from "
                     f"{m.start_utc or 'sunrise'}, {m.slope_deg:g}° in {m.soil.name}; drives {100 * m.duty_cycle:g} % "
                     f"of the time, route {route}."}
            told = {"ack": self._acked, "v": numbers, "c": {name: str(now[name]) for name in (*MENUS, "start_utc")},
                    "t": texts, "p": (*self._progress, running), "busy": busy or self._overtaken,
                    "off": {"undo": not self._past, "redo": not self._future, "run": running, "lightest": running,
                            "cancel": not running}}
            if self._reading in ("python", "differences"):           # they follow the state
                self._drawer = self._read(self._reading, "")
            (role, notice), drawer = self._notice, self._drawer
        said = f'<div><div role="{role}">{html.escape(notice)}</div></div>' if notice else ""
        self.parts["drawer"].value = said + page.drawer(*drawer)
        self.parts["data"].value = f'<div data-state="{html.escape(json.dumps(told), quote=True)}"></div>'

    # ---- fronts and solutions ---------------------------------------------------------------------------------

    def optimise(self, wait=False):
        """Search in the background for the mission as it stands; with `wait`, return when the search has ended."""
        posed = self.scenario.problem
        problem = {name: self.state[name] for name in ("population", "generations", "seed")} | {
            "objectives": dict(posed.objectives), "constraints": list(posed.constraints)}

        def take(front):
            self.front = front
            self._recipe = {**problem, "generations": len(front.objective_history)}      # fewer where it was cancelled
            return front.message or f"done: {len(front)} designs after {problem['generations']} generations"

        self._begin(take, "generation {} of {}", wait, pareto_front, warn=False, **problem)

    def lightest(self, wait=False):
        """Put the lightest rover that meets the demands on the sliders; found in the background by `rdk.size`."""
        def take(found):
            held = ", ".join(label(name.split(" ")[0])[0] for name in found.binding) or "nothing"
            said = found.message or (f"lightest: {found.performance.total_mass_kg:.2f} kg, held by {held}; all demands "
                                     f"hold in {100 * found.odds:.0f} % of draws")
            self._take(found.design)
            self._notice = ("alert" if found.message else "status", said)
            return said

        self._begin(take, "looking for the lightest rover", wait, size, answers.asked(self.scenario))

    def _begin(self, take, words, wait, search, *given, **options):
        """Start a search in a thread of its own, unless one is under way; `take` uses what it found, and says so."""
        drawn, (_, scenario, model) = time.monotonic(), self._now

        def follow(progress):
            nonlocal drawn
            self._progress = progress[:2]
            self._status = words.format(*self._progress)
            if time.monotonic() - drawn > 0.4:
                if search is pareto_front:
                    self.front, self._recipe = progress.front(), None
                self._poke()
                drawn = time.monotonic()
            return self._stop.is_set() or not threading.main_thread().is_alive()     # or the program is ending

        def work():
            posed = scenario.replace(problem=Problem())  # a search keeps the range limit that the slider shows
            try:
                found = search(posed, *given, model=model, on_generation=follow, **options)
                with self._lock:
                    said = take(found)
            except Exception as error:
                said = f"the search failed: {error}"
                self._notice = ("alert", said)
            with self._lock:
                self._thread, self._status = None, said
                self._poke()

        with self._lock:
            if self._thread is None:
                self._chosen["live"] = False
                self._stop.clear()
                self._progress, self._status = (0, 1), "starting"
                self._thread = threading.Thread(target=work)
                self._thread.start()
            thread = self._thread
        self._poke()
        if wait:
            thread.join()
            self.settle()

    def solve(self, name):
        """Move one design variable to the nearest value that meets the demands; a ValueError where none does."""
        with self._lock:
            value, field = answers.solved(*self._now, check("solve_variable", name)), NUMBERS[name]
            self.set(**{name: value})
            said = f"{field.label} of {field.words(float(f'{value:.4g}'))} {field.unit} meets the demands"
            self._notice = ("status", said)
