"""The explorer: will this rover do this mission? Sliders that answer at once, in a notebook or as an app.

`Explorer` holds a state of plain numbers and words. A change marks the state as changed; one worker thread computes the
newest one and shows readings, picture and drawing, then the intervals, so a burst of moves costs one or two answers and
nothing stale reads as new. Everything also runs without a browser: `set` an input, `settle()`, read `result`.
"""
from __future__ import annotations

import base64
import dataclasses
import html
import json
import math
import os
import threading
import time

import ipywidgets as W
import numpy as np

from .. import catalog, explain, pictures
from ..design import DESIGN_SPACE, Design, Model, Problem, Scenario
from ..mission import evaluate
from ..report import published, report
from ..rover_picture import rover_picture
from ..sampling import intervals
from ..terramechanics import Soil
from ..tradespace import Front, pareto_front
from . import answers, page
from .inputs import (COEFFICIENTS, DEMANDS, DESIGN, GOALS, MISSION, NUMBERS, OWN, RESTORED, SOIL, START,
                     check, choices, from_text, place, title, to_text)
from .worker import Refresher

PINS = ("A", "c1", "#c04a00"), ("B", "c2", "#007a59"), ("C", "c3", "#6a7488")
LIVE = 40, 24                                            # population and generations of a live front from nothing
SLOW = "why", "sweep", "optimise"                        # views whose picture may come after the readings
WIDE = 1150                                              # pixels from which a second picture stands beside the first
PAST = 200                                               # states that undo remembers


class Explorer:
    """A rover, a mission, and at once what comes of them.

    Parameters
    ----------
    rover : str or Design
        Where to start: a name of `rdk.rover_names()`, or a single design. Values beyond a slider are cut to its end, and a
        notice says so.
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

    def __init__(self, rover="Rashid-1", scenario="equatorial_mare_traverse", view="log", model=Model(), *, state=""):
        design = catalog.rover(rover) if isinstance(rover, str) else rover
        mission = catalog.scenario(scenario) if isinstance(scenario, str) else scenario
        for name, record, kind in ("rover", design, Design), ("scenario", mission, Scenario), ("model", model, Model):
            if not isinstance(record, kind):
                raise TypeError(f"{name} must be a {kind.__name__} or, for rover and scenario, a name; got {type(record).__name__}")
            if record.shape:
                raise ValueError(f"{name} must be a single one; got arrays of shape {record.shape}")
        self.menus = choices()
        self.error, self.result, self.intervals, self.binding, self.front = "", None, None, None, None
        self._model, self._recipe, self._thread, self._before, self._table = model, None, None, None, []
        self._stop, self._lock, self._heard = threading.Event(), threading.RLock(), 0
        self._past, self._future, self._last, self._pins, self._odds = [], [], ("", 0.0), [], None
        self._notice = self._drawer = self._progress = ("", "")
        self._picture = self._status = self._shown = ""
        self._catalogue = {name: catalog.scenario(name) for name in catalog.scenario_names()}
        self._soils = {name: catalog.soil(name) for name in catalog.soil_names()}
        self._rovers = {name: catalog.rover(name) for name in catalog.rover_names()}
        self._app, self._size = os.environ.get("SERVER_SOFTWARE", "").startswith("voila"), (600, 380)
        self.state = {"rover": OWN, "mission": OWN, "soil": OWN, "preset": "paper", "view": "log", "baseline": "MoonRanger",
                      "why_metric": "range_km", "sweep_first": "wheel_radius_m", "sweep_second": "", "sweep_metric": "range_km",
                      "front_x": "total_mass_kg", "front_y": "slope_capability_deg", "front_colour": "range_km", "live": False,
                      "solve_variable": "wheel_radius_m", "script": "the readings", "population": 50, "generations": 60, "seed": 13,
                      **{name: getattr(model, name) for name in COEFFICIENTS}}
        self._build()
        self._refresher = Refresher(self._refresh)
        self._put(design, mission)
        self._start, self._base = self.design, self._snapshot()
        self._past.clear()
        self.set(view=view)
        if text := state or (os.environ.get("QUERY_STRING", "") if self._app else ""):
            self._restore_link(text)
        self.settle()

    # ---- state ------------------------------------------------------------------------------------------------

    @property
    def design(self):
        """The Design that the inputs show."""
        return Design(**{name: self.state[name] for name in DESIGN_SPACE})

    @property
    def soil(self):
        """The Soil that the inputs show."""
        values = {name: self.state[name] for name in SOIL}
        known = (soil for soil in (self._guest.soil, *self._soils.values()) if all(getattr(soil, n) == v for n, v in values.items()))
        return next(known, Soil(name=OWN, **values))

    @property
    def scenario(self):
        """The Scenario that the inputs show; its problem holds the demands and goals."""
        mission = dataclasses.replace(self._guest, name=OWN, soil=self.soil, problem=self._posed(), **{name: self.state[name] for name in MISSION})
        names = dict.fromkeys((self._guest.name, *self._catalogue))
        known = (dataclasses.replace(mission, name=name) for name in names)
        return next((m for m in known if m == self._catalogue.get(m.name, self._guest)), mission)

    @property
    def model(self):
        """The Model that the inputs show."""
        return dataclasses.replace(self._model, **{name: self.state[name] for name in COEFFICIENTS})

    @property
    def link(self):
        """The state as a short text: the query of the app's address, and what `Explorer(state=...)` takes."""
        rover, mission = self.state["rover"], self.state["mission"]
        base = self._values(self._rovers.get(rover, self._start), self._catalogue.get(mission, self._catalogue["equatorial_mare_traverse"]))
        base |= {"rover": "", "mission": "", "view": "log", "preset": "paper", **{name: getattr(Model(), name) for name in COEFFICIENTS}}
        if rover == OWN:
            base |= dict.fromkeys(DESIGN, None) | {"wheel_count": None}
        return to_text(self.state, base)

    def set(self, **values):
        """Set inputs by name, such as `slope_deg=20`, `soil="fjs-1"`, `view="why"` or `population=30`.

        Raises
        ------
        ValueError
            If there is no such input, or it does not take the value; the message says what is allowed.
        """
        checked = {name: check(name, value, self.menus) for name, value in values.items()}
        with self._lock:
            if any(name in RESTORED or name in ("rover", "mission", "soil") for name in checked):
                self._remember(tuple(checked))
            for name, value in checked.items():
                self._assign(name, value)
            self._name()
        self._refresher.poke()

    def settle(self, timeout_s=60):
        """Wait until readings and picture show the present state."""
        self._refresher.settle(timeout_s)

    def undo(self):
        """Back to the state before the last change of rover, mission or model."""
        self._travel(self._past, self._future)

    def redo(self):
        """Forward again after `undo`."""
        self._travel(self._future, self._past)

    def reset(self, name=None):
        """Back to the rover and mission last chosen, or one input of them."""
        with self._lock:
            self._remember(("reset", name))
            self._restore(self._base if name is None else {**self._snapshot(), name: self._base[name]})
        self._refresher.poke()

    def pin(self):
        """Keep the present design for comparison, at most three."""
        with self._lock:
            if len(self._pins) < len(PINS):
                moved = [f"{NUMBERS[n].label} {NUMBERS[n].words(self.state[n])}" for n in DESIGN if self.state[n] != self._base[n]]
                name = self.state["rover"] if self.state["rover"] != OWN else ", ".join(moved[:2]) or "six wheels" * (self.design.wheel_count == 6)
                self._pins.append((name or OWN, self.design))
        self._refresher.poke()

    def unpin(self, index):
        """Forget a pinned design."""
        with self._lock:
            if 0 <= index < len(self._pins):
                del self._pins[index]
        self._refresher.poke()

    def pick(self, index):
        """Put a design of the front on the sliders."""
        if self.front is None or not 0 <= index < len(self.front):
            raise ValueError(f"there is no point {index} of a front to pick")
        with self._lock:
            self._change_design(self.front.designs[index])

    def _values(self, design=None, mission=None):
        """A design's and a mission's values as the state holds them."""
        found = {} if design is None else {name: getattr(design, name) for name in DESIGN_SPACE}
        if mission is not None:
            limits = {(metric, sign): limit for metric, sign, limit in mission.problem.constraints}
            found |= {name: getattr(mission, name) for name in MISSION} | {name: getattr(mission.soil, name) for name in SOIL}
            found |= {name: limits.get((metric, sign), 0 if sign == ">=" else math.inf) for name, (metric, sign, _) in DEMANDS.items()}
            found |= {goal: mission.problem.objectives.get(metric, "ignore") for goal, metric in GOALS.items()}
        return found

    def _posed(self):
        """The problem that demands and goals pose; demands on what has no slider stay."""
        base, mine = self._guest.problem, {(metric, sign): self.state[name] for name, (metric, sign, _) in DEMANDS.items()}
        if all(self.state[n] == v for n, v in self._values(None, self._guest).items() if n in DEMANDS or n in GOALS):
            return base
        others = tuple(c for c in base.constraints if c[:2] not in mine)
        return dataclasses.replace(
            base, objectives={m: self.state[g] for g, m in GOALS.items() if self.state[g] != "ignore"},
            constraints=tuple((*key, limit) for key, limit in mine.items() if limit not in (0, math.inf)) + others)

    def _assign(self, name, value):
        """One input's new value, and what follows from it."""
        if name == "rover" and value != OWN:
            self._put(self._rovers[value])
        elif name == "mission" and value != OWN:
            self._put(mission=self._catalogue[value])
        elif name == "soil" and value != OWN:
            self.state |= {n: getattr(self._soils[value], n) for n in SOIL}
        elif name == "preset":
            self._model = Model() if value == "paper" else Model.engineering()
            self.state |= {n: getattr(self._model, n) for n in COEFFICIENTS} | {"preset": value}
        else:
            noon = 0.0 if self.state["latitude_deg"] < 0 else 180.0
            if name == "latitude_deg" and self.state["panel_azimuth_deg"] == noon:
                self.state["panel_azimuth_deg"] = 0.0 if value < 0 else 180.0        # the array follows the noon sun
            self.state[name] = value

    def _name(self):
        """The menus name what the values are."""
        design, mission = self.design, self.scenario
        self.state["rover"] = next((name for name, known in self._rovers.items() if known == design), OWN)
        self.state["mission"] = mission.name if mission.name in self._catalogue else OWN
        self.state["soil"] = next((name for name, known in self._soils.items() if known == mission.soil), OWN)

    def _put(self, design=None, mission=None, note=""):
        """Show a design, a mission or both; the notice says what the sliders could not take."""
        said = [note] if note else []
        with self._lock:
            if mission is not None:
                self._guest = mission
                self.state["seed"] = self.state["seed"] if mission.problem.seed is None else mission.problem.seed
            for name, value in self._values(design, mission).items():
                near, word = NUMBERS[name].cut(value) if name in NUMBERS else (value, "")
                self.state[name] = near
                said += [word] * bool(word)
            self._name()
            self._base = {**getattr(self, "_base", {}), **self._snapshot(DESIGN_SPACE if mission is None else None if design is not None
                                                                        else set(RESTORED) - set(DESIGN_SPACE))}
            self._notice = ("status", "; ".join(said))
        self._refresher.poke()

    def _snapshot(self, names=None):
        """What undo brings back."""
        return {name: self.state[name] for name in RESTORED if names is None or name in names} | {"": (self._guest, self._model)}

    def _restore(self, kept):
        self._guest, self._model = kept[""]
        self.state |= {name: value for name, value in kept.items() if name}
        self._name()

    def _remember(self, key):
        """Keep the state before a change; a slider's drag counts as one."""
        now = time.monotonic()
        if not (key == self._last[0] and now - self._last[1] < 1.5 and self._past):
            self._past.append(self._snapshot())
            self._before = self.result
            del self._past[:-PAST]
        self._last = key, now
        self._future.clear()

    def _travel(self, source, target):
        with self._lock:
            if source:
                target.append(self._snapshot())
                self._before, self._last = self.result, ("", 0.0)
                self._restore(source.pop())
        self._refresher.poke()

    def _restore_link(self, text):
        """Lay the state of a link over the present one; what is wrong in it is said, the rest taken."""
        wrong = []
        with self._lock:
            self._remember(("link",))
            found = from_text(text)
            for name in sorted(found, key=lambda n: n not in ("rover", "mission", "preset")):        # the values after the names
                if name in NUMBERS or name in self.menus:
                    try:
                        self._assign(name, check(name, found[name], self.menus))
                    except ValueError as error:
                        wrong.append(str(error))
            self._name()
            self._notice = ("alert" if wrong else "status", "; ".join(wrong))
        self._refresher.poke()

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
                    self._heard, self._notice = number, ("", "")
                    try:
                        getattr(self, "_on_" + kind)(*arguments)
                    except ValueError as error:
                        self._notice = ("alert", str(error))
        self._refresher.poke()

    def _on_slide(self, name, position):
        if position != NUMBERS[name].position(self.state[name]):
            self.set(**{name: NUMBERS[name].at(position)})

    def _on_type(self, name, text):
        value, said = NUMBERS[name].read(text)
        self.set(**{name: value})
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
        elif verb == "cancel":
            self._stop.set()
        elif verb == "load":
            self.load(*more)
        elif verb == "solve":
            self.solve(self.state["solve_variable"])
        elif verb == "save":
            self._drawer = ("Saved", self._deliver(about))
        elif verb == "python":
            self._drawer = ("Python for " + self.state["script"], f"<pre tabindex='0'>{html.escape(self.python())}</pre>"
                            + page.menu("script", "instead for", self.menus["script"]))
        elif verb == "copied":
            self._drawer = ("Copied: " + ("the address of this state" if self._app else "the state, for Explorer(state=...)"),
                            f"<pre tabindex='0'>{html.escape(self.link or '(as it starts)')}</pre>")
        elif verb == "differences":
            self._drawer = ("Differences", self._differences())
        elif verb == "close":
            self._drawer = ("", "")

    def _change_design(self, design):
        """Take a design, as one step of undo; the baseline stays."""
        self._remember(("design", time.monotonic()))
        said = []
        for name, value in self._values(design).items():
            self.state[name], word = NUMBERS[name].cut(value) if name in NUMBERS else (value, "")
            said += [word] * bool(word)
        self._name()
        self._notice = ("status", "; ".join(said))
        self._refresher.poke()

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
        return "\n".join([explain.verdict(self.design, self.scenario, self.result, self.model)[1], self.binding.sentence, self.binding.detail, *rows])

    # ---- answers ----------------------------------------------------------------------------------------------

    def _refresh(self):
        """Compute the present state and show it; an error becomes a message, never a traceback in a thread."""
        with self._lock:
            now = dict(self.state)
            design, scenario, model, before = self.design, self.scenario, self.model, self._before
        see, view = self.parts, now["view"]
        self._tell(busy=view in SLOW or view != self._shown)
        try:
            result = evaluate(design, scenario, model=model)
            binding = explain.binding(design, scenario, result, model)
            self.result, self.binding, self.error = result, binding, ""
            see["verdict"].value, self._table = answers.answer(design, scenario, result, binding, self.intervals, before, model, old=True)
            see["side"].value = rover_picture(design, result, scenario, width=290)
            if view != "fleet":                          # it shows the intervals
                self._show(now, design, scenario, model, result)
            if not self._refresher.overtaken:            # intervals for the newest state alone
                self.intervals = intervals(design, scenario, draws=answers.DRAWS, model=model)
                see["verdict"].value, self._table = answers.answer(design, scenario, result, binding, self.intervals, before, model)
                if view in ("fleet", "mass") or self._size[0] >= WIDE:
                    self._show(now, design, scenario, model, result)
                self._show_tray(scenario, model, result)
        except Exception as error:                       # anything at all: the app must go on and say what happened
            self.error, self._picture = f"{type(error).__name__}: {error}", ""
            see["picture"].value = f'<div role="alert">{html.escape(self.error)}</div>'
        self._tell(busy=False)

    def _show(self, now, design, scenario, model, result):
        """Draw the view, and beside it another where the page is wide."""
        width, height = self._size
        names = [now["view"]] + (["mass" if now["view"] == "log" else "log"] if width >= WIDE else [])
        size = (width - 14 * (len(names) - 1)) // len(names), height
        drawn = [self._draw(name, now, design, scenario, model, result, size) for name in names]
        self._picture, self._shown = drawn[0], now["view"]
        self.parts["picture"].value = f'<div class="rdk-pictures">{"".join(drawn)}</div>'

    def _ghosts(self, scenario, model):
        return [(letter, cls, evaluate(design, scenario, model=model)) for (letter, cls, _), (_, design) in zip(PINS, self._pins)]

    def _draw(self, view, now, design, scenario, model, result, size):
        sure = self.intervals
        if view == "log":
            ghosts = [(letter, cls, found.log) for letter, cls, found in self._ghosts(scenario, model)]
            return pictures.log(result, scenario, model.soc_initial, size, ghosts)
        if view == "mass":
            return pictures.mass(result, size, sure and (sure.low["total_mass_kg"], sure.high["total_mass_kg"]), self._ghosts(scenario, model))
        if view == "wheel":
            return pictures.wheel(result, design, scenario, model, size)
        if view == "fleet":
            names, designs = published()
            others = evaluate(designs, scenario, model=model)
            spans = [(sure.low[n], sure.high[n]) for n in ("total_mass_kg", "range_km")]
            return pictures.fleet(result, (others.total_mass_kg, others.range_km, names), size, spans, self._ghosts(scenario, model))
        if view == "why":
            reference = self._start if now["baseline"] == START else self._rovers[now["baseline"]]
            return answers.explained(design, reference, now["baseline"], scenario, model, now["why_metric"], size)
        if view == "sweep":
            fields = dict.fromkeys(filter(None, (now["sweep_first"], now["sweep_second"])))
            return answers.swept(design, scenario, model, list(fields), now["sweep_metric"], size)
        if now["live"] and (self.front is None or not self._fits(self.front, scenario, model) or self._recipe is not None):
            self.front, self._recipe = live_front(scenario, self.front, model), None
        if self.front is None:
            return (f'<div style="padding:60px 20px;text-align:center;width:{size[0] - 60}px"><p>No front yet: designs that no other beats in every '
                    'goal.</p><p style="margin:14px"><button type="button" class="rdk-btn rdk-main" data-do="run">Run search</button></p></div>')
        return self._draw_front(now, scenario, model, result, size)

    def _fits(self, front, scenario, model):
        return dataclasses.replace(front.scenario, name="") == dataclasses.replace(_plain(scenario), name="") and front.model == model

    def _draw_front(self, now, scenario, model, result, size):
        front, names = self.front, [now["front_" + key] for key in ("x", "y", "colour")]
        columns = [np.asarray(getattr(front.performance, name), float) for name in names]
        stale = "" if self._fits(front, scenario, model) else f"searched for {front.scenario.name.replace('_', ' ')} as it was: run again"
        same = np.ones(len(front), bool)
        for name in DESIGN_SPACE:
            same &= np.asarray(getattr(front.designs, name)) == now[name]
        picked = int(same.argmax()) if same.any() else None
        faded = ~answers.meets(front.performance, scenario.problem.constraints)
        words = f"{'Live front' if now['live'] else 'Front'} of {front.scenario.name.replace('_', ' ')}: {len(front)} designs"
        return pictures.front(*columns, names, [float(getattr(result, name)) for name in names], size, picked, faded, words,
                              stale or front.message, self._ghosts(scenario, model))

    def _show_tray(self, scenario, model, result):
        pins = []
        for (letter, _, other), (name, _) in zip(self._ghosts(scenario, model), self._pins):
            parts = [(other.total_mass_kg - result.total_mass_kg, "kg"), (other.range_km - result.range_km, "km"),
                     (other.slope_capability_deg - result.slope_capability_deg, "°")]
            pins.append((letter, name, " · ".join(f"{v:+.1f} {unit}".replace("-", "−") for v, unit in parts) + " against now"))
        self.parts["tray"].value = page.tray(pins, [colour for *_, colour in PINS])

    def _differences(self):
        """Table of the pinned designs beside the present one, on the present mission."""
        designs = [self.design, *(design for _, design in self._pins)]
        found = [evaluate(design, self.scenario, model=self.model) for design in designs]
        rows = [(pictures.label(name)[0], *(answers.words(float(getattr(p, name)), digits, pictures.label(name)[1]) for p in found))
                for name, digits in answers.ROWS]
        rows += [(f.label, *(f"{f.words(getattr(d, name))} {f.unit}" for d in designs)) for name, f in DESIGN.items()
                 if len({getattr(d, name) for d in designs}) > 1]
        return page.table(("", "now", *(f"{letter} {name}" for (letter, *_), (name, _) in zip(PINS, self._pins))), rows)

    def _tell(self, busy):
        """Send the values of all inputs and the small texts to the page."""
        with self._lock:
            now, link = self.state, self.link
            numbers = {name: (f.position(now[name]), f.words(now[name]), 100 * f.position(self._base.get(name, now[name])) / f.positions,
                              int(name in self._base and now[name] != self._base[name])) for name, f in NUMBERS.items()}
            m, (done, of) = self.scenario, self._progress if self._thread else (0, 1)
            route = "no limit" if math.isinf(m.traverse_limit_km) else f"{m.traverse_limit_km:g} km"
            mission = f"Mission: {place(m.latitude_deg)}, {m.slope_deg:g}°"
            texts = {"mission": mission, "status": self._status, "share": link, "summary": f"{place(m.latitude_deg)}, {m.duration_earth_days:g} "
                     f"days from sunrise, {m.slope_deg:g}° in {m.soil.name}; drives {100 * m.duty_cycle:g} % of the time, route {route}."}
            off = {"undo": not self._past, "redo": not self._future, "run": bool(self._thread), "cancel": not self._thread}
            told = {"ack": self._heard, "v": numbers, "c": {name: str(now[name]) for name in self.menus}, "t": texts, "off": off,
                    "p": (done, of, bool(self._thread)), "link": link, "share": link, "busy": busy}
            (role, notice), (head, body) = self._notice, self._drawer
        said = f'<div role="{role}">{html.escape(notice)}</div>' if notice else ""
        self.parts["drawer"].value = (f"<div>{said}</div>" if said else "") + page.drawer(head, body)
        self.parts["data"].value = f'<div data-state="{html.escape(json.dumps(told), quote=True)}"></div>'

    # ---- fronts and solutions ---------------------------------------------------------------------------------

    def _problem(self):
        """What `pareto_front` needs for the search that the inputs pose."""
        posed = self._posed()
        return {"population": self.state["population"], "generations": self.state["generations"], "seed": self.state["seed"],
                "objectives": dict(posed.objectives), "constraints": list(posed.constraints)}

    def optimise(self, wait=False):
        """Search in the background for the mission as it stands; with `wait`, return when the search has ended."""
        with self._lock:
            if self._thread is None:
                self.state["live"] = False
                self._stop.clear()
                problem = self._problem()
                self._progress, self._status = (0, problem["generations"]), "starting"
                self._thread = threading.Thread(target=self._search, args=(_plain(self.scenario), self.model, problem))
                self._thread.start()
            thread = self._thread
        if wait:
            thread.join()
            self.settle()

    def _search(self, scenario, model, problem):
        """The search's thread: progress, a growing front, cancel."""
        drawn = time.monotonic()

        def follow(progress):
            nonlocal drawn
            self._progress, self._status = (progress.generation, problem["generations"]), f"generation {progress.generation} of {problem['generations']}"
            if time.monotonic() - drawn > 0.4:
                self.front, self._recipe = progress.front(), None
                self._refresher.poke()
                drawn = time.monotonic()
            return self._stop.is_set() or not threading.main_thread().is_alive()     # the program is ending

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

    # ---- files ------------------------------------------------------------------------------------------------

    def file(self, name):
        """The text of a file: design.json, design.csv, front.json, front.csv, picture.svg or report.html."""
        design, scenario = self.design, self.scenario
        if name.startswith("front") and (self.front is None or not len(self.front)):
            raise ValueError("there is no front yet: run a search first")
        if name == "report.html":
            others = {f"{letter} {title}": d for (letter, *_), (title, d) in zip(PINS, self._pins)}
            front = self.front if self.front is not None and self._fits(self.front, scenario, self.model) else None
            return report(design, scenario, f"{self.state['rover'] if self.state['rover'] != OWN else 'A rover'} for {title_of(scenario)}",
                          model=self.model, front=front, candidates=others)
        made = {"design.json": lambda: catalog.to_json(design, scenario), "design.csv": lambda: catalog.to_csv(design, self.result),
                "front.json": lambda: catalog.to_json(self.front.designs, self.front.scenario),
                "front.csv": lambda: catalog.to_csv(self.front.designs, self.front.performance), "picture.svg": lambda: self._picture}
        if name not in made:
            raise ValueError(f"no file {name!r}; choose from {', '.join(made)}, report.html")
        return made[name]()

    def _deliver(self, name):
        data = base64.b64encode(self.file(name).encode()).decode()
        return f'<p><a data-deliver download="{name}" href="data:application/octet-stream;base64,{data}">{name}</a>: in the folder of your downloads.</p>'

    def load(self, name, content):
        """Show a design, or a front, from a file's name and its text or bytes; the notice says what was wrong with it."""
        try:
            text = content if isinstance(content, str) else bytes(content).decode("utf-8-sig")
            text = text.removeprefix("\ufeff")
            design, mission = (catalog.from_csv(text), None) if name.lower().endswith(".csv") else catalog.from_json(text)
        except ValueError as error:                      # also where the bytes are no text
            self._notice = ("alert", f"{name} was not loaded: {error}")
            self._refresher.poke()
            return
        note = f"{name} loaded"
        self._remember(("load", time.monotonic()))
        if design.shape:
            note += f": {len(design)} designs, shown under Optimise; the first is on the sliders"
            where = _plain(self.scenario if mission is None else mission)
            design = Design(**{n: np.clip(getattr(design, n), v.low, v.high) for n, v in DESIGN_SPACE.items()})
            self.front, self._recipe = Front(design, evaluate(design, where, model=self.model), where, self.model, Problem()), None
            design = design[0]
        self._put(design, mission, note)

    def python(self):
        """The Python that reproduces what the menu `script` names, as it stands on the screen."""
        design, scenario, model, wanted = self.design, self.scenario, self.model, self.state["script"]
        if wanted == "the front":
            if self.front is None or self._recipe is None:
                return "# No front of a finished search: choose the view Optimise and press Run search.\n"
            recipe = ", ".join(f"{name}={value!r}" for name, value in self._recipe.items())
            return explain.as_python(design, self.front.scenario, self.front.model, f"front = rdk.pareto_front(mission, {recipe}, model=model)")
        if wanted == "why":
            reference = self._start if self.state["baseline"] == START else self._rovers[self.state["baseline"]]
            return explain.as_python(design, scenario, model, "why = rdk.attribution(design, baseline, mission, model=model)", baseline=reference)
        if wanted == "the sweep":
            fields = dict.fromkeys(filter(None, (self.state["sweep_first"], self.state["sweep_second"])))
            over = {name: answers.span_of(name, answers.MAP if len(fields) == 2 else answers.CURVE).tolist() for name in fields}
            return explain.as_python(design, scenario, model, f"curve = rdk.sweep(design, mission, {over!r}, model=model)")
        return explain.as_python(design, scenario, model, "result = rdk.evaluate(design, mission, model=model)",
                                 f"intervals = rdk.intervals(design, mission, draws={answers.DRAWS}, model=model)")


def check_variable(name):
    """The name of a design variable with a slider, or a ValueError."""
    if name not in DESIGN:
        raise ValueError(f"no design variable {name!r} to solve for; choose from {', '.join(DESIGN)}")
    return name


def title_of(scenario):
    """A mission's name in human words, wherever it comes from."""
    return title(scenario.name) if scenario.name in catalog.scenario_names() else scenario.name


def live_front(scenario, start=None, model=Model()):
    """A Front quick enough to follow a slider: a small population, warm-started from the last front, so less complete."""
    population, generations = LIVE
    return pareto_front(_plain(scenario), population=population, seed=1, start=start, model=model, warn=False,
                        generations=generations if start is None else generations // 2)


def _plain(scenario):
    """The mission without its problem: a search keeps the range limit that the slider shows."""
    return dataclasses.replace(scenario, problem=Problem())


