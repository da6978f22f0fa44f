"""The explorer's state: a rover, a mission and a model in plain numbers and words; its past, pins, link and files."""
from __future__ import annotations

import base64
import dataclasses
import functools
import math
import threading
from urllib.parse import urlencode

import numpy as np

from .. import catalog, explain
from ..design import DESIGN_SPACE, Design, Model, Problem, Scenario
from ..mission import evaluate
from ..report import report
from ..terramechanics import Soil
from ..tradespace import Front
from . import answers
from .inputs import (COEFFICIENTS, DEMANDS, DESIGN, GOALS, MISSION, NONE, NUMBERS, OWN, RESTORED, SKY, SOIL, START,
                     check, choices, from_text, title)

PINS = ("A", "c1", "#c04a00"), ("B", "c2", "#007a59"), ("C", "c3", "#6a7488")
PAST = 200                                               # states that undo remembers
FIRST = "rover", "mission", "preset", "site"             # of a link: the values come after the names
skyline = functools.cache(catalog.skyline)


class State:
    """What the inputs of an explorer show, and everything that changes it; `_poke` asks for a new answer."""

    def __init__(self, design, mission, model):
        for name, record, kind in ("rover", design, Design), ("scenario", mission, Scenario), ("model", model, Model):
            if not isinstance(record, kind):
                raise TypeError(f"{name} must be a {kind.__name__} or, for rover and scenario, a name; got "
                                f"{type(record).__name__}")
            if record.shape:
                raise ValueError(f"{name} must be a single one; got arrays of shape {record.shape}")
        self.menus, self.front, self.result = choices(), None, None
        self._model, self._recipe, self._before = model, None, None
        self._lock = threading.RLock()
        self._past, self._future, self._drag, self._pins = [], [], ("", 0), []
        self._notice = ("", "")
        self._catalogue = {name: catalog.scenario(name) for name in catalog.scenario_names()}
        self._soils = {name: catalog.soil(name) for name in catalog.soil_names()}
        self._rovers = {name: catalog.rover(name) for name in catalog.rover_names()}
        self.state = {
            "rover": OWN, "mission": OWN, "soil": OWN, "preset": "paper", "view": "log", "baseline": "MoonRanger",
            "why_metric": "range_km", "sweep_first": "wheel_radius_m", "sweep_second": "", "sweep_metric": "range_km",
            "front_x": "total_mass_kg", "front_y": "slope_capability_deg", "front_colour": "range_km", "live": False,
            "solve_variable": "wheel_radius_m", "script": "the readings", "population": 50, "generations": 60,
            "seed": 13, **{name: getattr(model, name) for name in COEFFICIENTS}}
        self._put(design, mission)
        self._start, self._base = self.design, self._snapshot()
        self._past.clear()

    def _poke(self):
        """Ask for an answer to the state as it is now."""

    @property
    def design(self):
        """The Design that the inputs show."""
        return Design(**{name: self.state[name] for name in DESIGN_SPACE})

    @property
    def soil(self):
        """The Soil that the inputs show."""
        values = {name: self.state[name] for name in SOIL}
        known = (soil for soil in (self._guest.soil, *self._soils.values()) if all(getattr(soil, n) == v for n,
                                                                                   v in values.items()))
        return next(known, Soil(name=OWN, **values))

    @property
    def scenario(self):
        """The Scenario that the inputs show; its problem holds the demands and goals."""
        site, start = catalog.skyline_sites().get(self.state["site"]), self.state["start_utc"]
        sky = {} if self.state["site"] == OWN else {"skyline": None} if site is None else {
            "skyline": skyline(self.state["site"], self.state["site_height_m"]), "longitude_deg": site["longitude_deg"]}
        mission = dataclasses.replace(self._guest, name=OWN, soil=self.soil, problem=self._posed(), **sky,
                                      start_utc=None if start == NONE else start,
                                      **{name: self.state[name] for name in MISSION})
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
        base = self._values(self._rovers.get(rover, self._start),
                            self._catalogue.get(mission, self._catalogue["equatorial_mare_traverse"]))
        base |= {"rover": "", "mission": "", "view": "log", "preset": "paper", **{name: getattr(Model(), name)
                                                                                  for name in COEFFICIENTS}}
        if rover == OWN:
            base |= dict.fromkeys(DESIGN, None) | {"wheel_count": None}
        return urlencode({name: self.state[name] for name in base if self.state[name] != base[name]})

    def set(self, **values):
        """Set inputs by name, such as `slope_deg=20`, `soil="fjs-1"`, `view="why"` or `population=30`.

        Raises
        ------
        ValueError
            If there is no such input, or it does not take the value; the message says what is allowed.
        """
        self._move(values)

    def _move(self, values, drag=("", 0)):
        checked = {name: check(name, value, self.menus) for name, value in values.items()}
        with self._lock:
            moved = [name for name, value in checked.items() if self.state[name] != value]
            if any(name in RESTORED or name in ("rover", "mission", "soil") for name in moved):
                self._remember(drag)
            for name, value in checked.items():
                self._assign(name, value)
            self._name()
        self._poke()

    def undo(self):
        """Back to the state before the last change of rover, mission or model."""
        self._travel(self._past, self._future)

    def redo(self):
        """Forward again after `undo`."""
        self._travel(self._future, self._past)

    def reset(self, name=None):
        """Back to the rover and mission last chosen, or one input of them."""
        with self._lock:
            self._remember()
            self._restore(self._base if name is None else {**self._snapshot(), name: self._base[name]})
        self._poke()

    def pin(self):
        """Keep the present design for comparison, at most three."""
        with self._lock:
            if len(self._pins) < len(PINS):
                moved = [f"{NUMBERS[n].label} {NUMBERS[n].words(self.state[n])}" for n in DESIGN
                         if self.state[n] != self._base[n]]
                name = self.state["rover"]
                self._pins.append((name if name != OWN else ", ".join(moved[:2]) or OWN, self.design))
        self._poke()

    def unpin(self, index):
        """Forget a pinned design."""
        with self._lock:
            if 0 <= index < len(self._pins):
                del self._pins[index]
        self._poke()

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
            found |= {name: getattr(mission, name) for name in MISSION} | {name: getattr(mission.soil, name)
                                                                           for name in SOIL}
            found |= dict(zip(SKY, (*self._site(mission), mission.start_utc or NONE)))
            found |= {name: limits.get((metric, sign), 0 if sign == ">=" else math.inf) for name,
                      (metric, sign, _) in DEMANDS.items()}
            found |= {goal: mission.problem.objectives.get(metric, "ignore") for goal, metric in GOALS.items()}
        return found

    def _site(self, mission):
        """Name and height of the site whose skyline a mission has."""
        if mission.skyline is None:
            return NONE, 2
        site, height = explain.site_of(mission.skyline) or (OWN, 2)
        return (site if site == OWN or mission.longitude_deg == mission.skyline.longitude_deg else OWN), height

    def _posed(self):
        """The problem that demands and goals pose; demands on what has no slider stay."""
        base, mine = self._guest.problem, {(metric, sign): self.state[name] for name,
                                           (metric, sign, _) in DEMANDS.items()}
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
        elif name == "site" and value in (sites := catalog.skyline_sites()):
            self._assign("latitude_deg", sites[value]["latitude_deg"])
            self.state["site"] = value
        elif name == "preset":
            self._model = Model() if value == "paper" else Model.engineering()
            self.state |= {n: getattr(self._model, n) for n in COEFFICIENTS} | {"preset": value}
        else:
            noon = 0.0 if self.state["latitude_deg"] < 0 else 180.0
            if name == "latitude_deg" and self.state["panel_azimuth_deg"] == noon:
                self.state["panel_azimuth_deg"] = 0.0 if value < 0 else 180.0        # the array follows the noon sun
            site = catalog.skyline_sites().get(self.state["site"])
            if name == "latitude_deg" and site is not None and value != site["latitude_deg"]:
                self._notice = ("status", "site set to none: its skyline holds at its own latitude only")
                self.state["site"] = NONE
            self.state[name] = value

    def _name(self):
        """The menus name what the values are."""
        design, mission = self.design, self.scenario
        self.state["rover"] = next((name for name, known in self._rovers.items() if known == design), OWN)
        self.state["mission"] = mission.name if mission.name in self._catalogue else OWN
        if self.state["site"] == OWN and self._guest.skyline is None:
            self.state["site"] = NONE
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
            self._base = {**getattr(self, "_base", {}), **self._snapshot(DESIGN_SPACE if mission is None else None
                                                                         if design is not None
                                                                        else set(RESTORED) - set(DESIGN_SPACE))}
            self._notice = ("status", "; ".join(said))
        self._poke()

    def _snapshot(self, names=None):
        """What undo brings back."""
        return {name: self.state[name] for name in RESTORED if names is None
                or name in names} | {"": (self._guest, self._model)}

    def _restore(self, kept):
        self._guest, self._model = kept[""]
        self.state |= {name: value for name, value in kept.items() if name}
        self._name()

    def _remember(self, drag=("", 0)):
        """Keep the state before a change; a slider's moves that follow within 1.5 s of each other count as one."""
        if not (drag[0] and drag[0] == self._drag[0] and drag[1] - self._drag[1] < 1500 and self._past):
            self._past.append(self._snapshot())
            self._before = self.result
            del self._past[:-PAST]
        self._drag = drag
        self._future.clear()

    def _travel(self, source, target):
        with self._lock:
            if source:
                target.append(self._snapshot())
                self._before, self._drag = self.result, ("", 0)
                self._restore(source.pop())
        self._poke()

    def _restore_link(self, text):
        """Lay the state of a link over the present one; what is wrong in it is said, the rest taken."""
        wrong = []
        with self._lock:
            self._remember()
            found = from_text(text)
            for name in sorted(found, key=lambda n: FIRST.index(n) if n in FIRST else len(FIRST)):
                if name in NUMBERS or name in self.menus or name in SKY:
                    try:
                        self._assign(name, check(name, found[name], self.menus))
                    except ValueError as error:
                        wrong.append(str(error))
            self._name()
            self._notice = ("alert" if wrong else "status", "; ".join(wrong))
        self._poke()

    def _change_design(self, design):
        """Take a design, as one step of undo; the baseline stays."""
        self._remember()
        said = []
        for name, value in self._values(design).items():
            self.state[name], word = NUMBERS[name].cut(value) if name in NUMBERS else (value, "")
            said += [word] * bool(word)
        self._name()
        self._notice = ("status", "; ".join(said))
        self._poke()

    # ---- files ------------------------------------------------------------------------------------------------

    def file(self, name):
        """The text of a file: design.json, design.csv, front.json, front.csv, picture.svg or report.html."""
        design, scenario = self.design, self.scenario
        if name.startswith("front") and (self.front is None or not len(self.front)):
            raise ValueError("there is no front yet: run a search first")
        if name == "report.html":
            others = {f"{letter} {title}": d for (letter, *_), (title, d) in zip(PINS, self._pins)}
            front = self.front if self.front is not None and self._fits(self.front, scenario, self.model) else None
            return report(design, scenario, f"{self.state['rover'] if self.state['rover'] != OWN else 'A rover'} for "
                          f"{title(scenario.name)}",
                          model=self.model, front=front, candidates=others)
        made = {"design.json": lambda: catalog.to_json(design, scenario),
                "design.csv": lambda: catalog.to_csv(design, self.result),
                "front.json": lambda: catalog.to_json(self.front.designs, self.front.scenario),
                "front.csv": lambda: catalog.to_csv(self.front.designs, self.front.performance),
                "picture.svg": lambda: self._picture}
        if name not in made:
            raise ValueError(f"no file {name!r}; choose from {', '.join(made)}, report.html")
        return made[name]()

    def _deliver(self, name):
        data = base64.b64encode(self.file(name).encode()).decode()
        return (f'<p><a data-deliver download="{name}" href="data:application/octet-stream;base64,{data}">{name}</a>: '
                "in the folder of your downloads.</p>")

    def load(self, name, content):
        """Show a design, or a front, from a file's name and its text or bytes; a notice says what was wrong with it."""
        try:
            text = content if isinstance(content, str) else bytes(content).decode("utf-8-sig")
            text = text.removeprefix("\ufeff")
            design, mission = (catalog.from_csv(text),
                               None) if name.lower().endswith(".csv") else catalog.from_json(text)
        except ValueError as error:                      # also where the bytes are no text
            self._notice = ("alert", f"{name} was not loaded: {error}")
            self._poke()
            return
        note = f"{name} loaded"
        self._remember()
        if design.shape:
            note += f": {len(design)} designs, shown under Optimise; the first is on the sliders"
            where = plain(self.scenario if mission is None else mission)
            design = Design(**{n: np.clip(getattr(design, n), v.low, v.high) for n, v in DESIGN_SPACE.items()})
            self.front, self._recipe = Front(design, evaluate(design, where, model=self.model), where, self.model,
                                             Problem()), None
            design = design[0]
        self._put(design, mission, note)

    def python(self):
        """The Python that reproduces what the menu `script` names, as it stands on the screen."""
        design, scenario, model, wanted = self.design, self.scenario, self.model, self.state["script"]
        if wanted == "the front":
            if self.front is None or self._recipe is None:
                return "# No front of a finished search: choose the view Optimise and press Run search.\n"
            recipe = ", ".join(f"{name}={value!r}" for name, value in self._recipe.items())
            return explain.as_python(design, self.front.scenario, self.front.model,
                                     f"front = rdk.pareto_front(mission, {recipe}, model=model)")
        if wanted == "why":
            reference = self._start if self.state["baseline"] == START else self._rovers[self.state["baseline"]]
            return explain.as_python(design, scenario, model, "why = rdk.attribution(design, baseline, mission, "
                                     "model=model)", baseline=reference)
        if wanted == "the sweep":
            fields = dict.fromkeys(filter(None, (self.state["sweep_first"], self.state["sweep_second"])))
            over = {name: answers.span_of(name, answers.MAP if len(fields) == 2 else answers.CURVE).tolist()
                    for name in fields}
            return explain.as_python(design, scenario, model, f"curve = rdk.sweep(design, mission, {over!r}, "
                                     "model=model)")
        return explain.as_python(design, scenario, model, "result = rdk.evaluate(design, mission, model=model)",
                                 f"intervals = rdk.intervals(design, mission, draws={answers.DRAWS}, model=model)")


def check_variable(name):
    """The name of a design variable with a slider, or a ValueError."""
    if name not in DESIGN:
        raise ValueError(f"no design variable {name!r} to solve for; choose from {', '.join(DESIGN)}")
    return name


def plain(scenario):
    """The mission without its problem: a search keeps the range limit that the slider shows."""
    return dataclasses.replace(scenario, problem=Problem())
