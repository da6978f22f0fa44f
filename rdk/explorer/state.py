"""The explorer's state: a rover, a mission, a model and what else is chosen; its past, pins, link and files."""
import contextlib
import math
import threading
from urllib.parse import parse_qsl, urlencode

from .. import catalog, explain
from ..design import Model, Problem
from ..mission import evaluate
from ..report import report
from ..sampling import replaced, single
from ..tradespace import Front
from . import answers
from .inputs import COEFFICIENTS, DEMANDS, DESIGN, GOALS, MENUS, MISSION, NONE, NUMBERS, OWN, SKY, SOIL, check, title
from .page import PINS, SAVES

PAST = 200                                               # states that undo remembers
FIRST = "rover", "mission", "preset", "site"             # of a link: the values come after the names
CHOSEN = {"view": "log", "baseline": "MoonRanger", "why_metric": "range_km", "sweep_first": "wheel_radius_m",
          "sweep_second": "", "sweep_metric": "range_km", "front_x": "total_mass_kg", "front_y": "slope_capability_deg",
          "front_colour": "range_km", "live": False, "solve_variable": "wheel_radius_m", "population": 50,
          "generations": 60, "seed": 13, "site_height_m": 2}
ENGINEERING = Model.engineering()


class State:
    """What the inputs of an explorer show, and everything that changes it."""

    def __init__(self, design, mission, model):
        single(rover=design, scenario=mission, model=model)
        self.front = self.result = self._recipe = self._before = None
        self._lock = threading.RLock()
        self._past, self._future, self._drag, self._pins = [], [], ("", 0), []
        self._notice = ("", "")
        self._catalogue = {name: catalog.scenario(name) for name in catalog.scenario_names()}
        self._soils = {name: catalog.soil(name) for name in catalog.soil_names()}
        self._rovers = {name: catalog.rover(name) for name in catalog.rover_names()}
        self._known = {rover: name for name, rover in self._rovers.items()}
        self._chosen = dict(CHOSEN)
        self._now = self._base = design, mission, model  # the rover and mission last chosen are the base
        self._put(design, mission)
        self._start = self.design

    design = property(lambda self: self._now[0], doc="The Design that the inputs show.")
    scenario = property(lambda self: self._now[1], doc="The Scenario that the inputs show, with its demands and goals.")
    model = property(lambda self: self._now[2], doc="The Model that the inputs show.")
    state = property(lambda self: self._chosen | self._values(*self._now), doc="Every input, as `set` takes them.")
    _reference = property(lambda self: self._rovers.get(self._chosen["baseline"], self._start), doc='That of "why".')
    pinned = property(lambda self: {f"{letter} {name}": design for (letter, *_), (name, design) in zip(
        PINS, self._pins)}, doc="The pinned designs by letter and name.")

    def _values(self, design, mission, model):
        """Rover, mission and model as the inputs show them."""
        limits = {(metric, sign): limit for metric, sign, limit in mission.problem.constraints}
        site, height = self._site(mission)
        coefficients = {name: getattr(model, name) for name in COEFFICIENTS}
        records = (design, ("wheel_count", *DESIGN)), (mission, MISSION), (mission.soil, SOIL)
        return {**{name: getattr(record, name) for record, names in records for name in names}, **coefficients,
                **{name: limits.get((metric, sign), 0 if sign == ">=" else math.inf)
                   for name, (metric, sign) in DEMANDS.items()},
                **{goal: mission.problem.objectives.get(metric, "ignore") for goal, metric in GOALS.items()},
                "survive": int(limits.get(("thermal_survival", ">="), 0)),
                "rover": self._known.get(design, OWN),
                "mission": mission.name if self._catalogue.get(mission.name) == mission else OWN,
                "soil": mission.soil.name if self._soils.get(mission.soil.name) == mission.soil else OWN,
                "preset": "engineering" if vars(model) == vars(ENGINEERING) | coefficients else "paper",
                "site": site, "start_utc": mission.start_utc or NONE, **({"site_height_m": height} if height else {})}

    def _site(self, mission):
        """Name and height of the site whose skyline a mission has."""
        if mission.skyline is None:
            return NONE, None
        if mission.longitude_deg != mission.skyline.longitude_deg:
            return OWN, None
        return explain.site_of(mission.skyline) or (OWN, None)

    @property
    def link(self):
        """The state as a short text: the query of the app's address, and what `Explorer(state=...)` takes."""
        now, names = self.state, self._values(*self._base)               # what has no name is told by what differs
        rover, mission = (next(name for name in (now[key], names[key], other) if name != OWN) for key, other in (
            ("rover", "Rashid-1"), ("mission", "equatorial_mare_traverse")))
        design, mission = self._rovers[rover], self._catalogue[mission]
        base = CHOSEN | self._values(design, mission, Model()) | {"seed": mission.problem.seed or CHOSEN["seed"]}
        told = {name: base[name] for name in ("rover", "mission")}
        if now["latitude_deg"] != base["latitude_deg"]:  # on the way back the array follows it
            base["panel_azimuth_deg"] = None
        return urlencode(told | {name: value for name, value in now.items() if value not in (base[name], OWN)})

    @contextlib.contextmanager
    def _step(self, drag=("", 0)):
        """A change: undo goes behind it. A slider's moves that follow within 1.5 s of each other are one change."""
        with self._lock:
            before = self._now
            yield
            if self._now != before:
                if not (drag[0] and drag[0] == self._drag[0] and drag[1] - self._drag[1] < 1500 and self._past):
                    self._past.append(before)
                    self._before = self.result
                    del self._past[:-PAST]
                self._drag = drag
                self._future.clear()
            self._poke()

    def set(self, **values):
        """Set inputs by name, such as `slope_deg=20, soil="fjs-1", view="why"`; a ValueError says what is allowed."""
        checked = {name: check(name, value) for name, value in values.items()}
        with self._step():
            for name, value in checked.items():
                self._assign(name, value)

    def undo(self):
        """Back to the state before the last change of rover, mission or model."""
        self._travel(self._past, self._future)

    def redo(self):
        """Forward again after `undo`."""
        self._travel(self._future, self._past)

    def _travel(self, source, target):
        with self._lock:
            if source:
                target.append(self._now)
                self._now, self._before, self._drag = source.pop(), self.result, ("", 0)
            self._poke()

    def reset(self, name=None):
        """Back to the rover and mission last chosen, or one input of them."""
        with self._step():
            if name is None:
                self._now = self._base
            else:
                self._assign(name, self._values(*self._base)[name])

    def pin(self):
        """Keep the present design for comparison, at most three."""
        with self._step():
            now, base = self.state, self._values(*self._base)
            if len(self._pins) < len(PINS):
                moved = [f"{NUMBERS[n].label} {NUMBERS[n].words(now[n])}" for n in DESIGN if now[n] != base[n]]
                name = now["rover"]
                self._pins.append((name if name != OWN else ", ".join(moved[:2]) or OWN, self.design))

    def unpin(self, index):
        """Forget a pinned design."""
        with self._step():
            del self._pins[index:index + 1]

    def pick(self, index):
        """Put a design of the front on the sliders."""
        if self.front is None or not 0 <= index < len(self.front):
            raise ValueError(f"there is no point {index} of a front to pick")
        self._take(self.front.designs[index])

    def _take(self, design):
        """Take a design as one change; the base stays."""
        with self._step():
            base = self._base
            self._put(design)
            self._base = base

    def _assign(self, name, value):
        """One input's new value, and what follows from it."""
        design, mission, model = self._now
        problem, sites, here = mission.problem, catalog.skyline_sites(), self._site(mission)[0]
        if name in self._chosen:
            self._chosen[name] = value
        if value == OWN or name in CHOSEN and (name != "site_height_m" or here not in sites):
            return
        if name == "rover":
            self._put(self._rovers[value])
        elif name == "mission":
            self._put(mission=self._catalogue[value])
        elif name == "preset":
            self._now = design, mission, Model() if value == "paper" else ENGINEERING
        elif name in DEMANDS:
            kept = {(metric, sign): limit for metric, sign, limit in problem.constraints} | {DEMANDS[name]: value}
            names = dict.fromkeys([*DEMANDS.values(), *kept])                # always in one order
            kept = tuple((*key, kept[key]) for key in names
                         if key in kept and (key != DEMANDS[name] or 0 < value < math.inf))
            self._show_mission(problem=problem.replace(constraints=kept))
        elif name in GOALS:
            kept = problem.objectives | {GOALS[name]: value}
            names = dict.fromkeys([*GOALS.values(), *kept])
            kept = {metric: kept[metric] for metric in names if kept.get(metric, "ignore") != "ignore"}
            self._show_mission(problem=problem.replace(objectives=kept))
        elif name == "soil":
            self._show_mission(soil=self._soils[value])
        elif name == "start_utc":
            self._show_mission(start_utc=None if value == NONE else value)
        elif name in SKY:
            site = value if name == "site" else here
            self._show_mission(skyline=None, longitude_deg=0.0)
            if site != NONE:
                self._assign("latitude_deg", sites[site]["latitude_deg"])
                self._show_mission(skyline=catalog.skyline(site, self._chosen["site_height_m"]),
                                   longitude_deg=sites[site]["longitude_deg"])
        else:
            noon = 0.0 if mission.latitude_deg < 0 else 180.0
            if name == "latitude_deg" and mission.panel_azimuth_deg == noon:
                mission = mission.replace(panel_azimuth_deg=0.0 if value < 0 else 180.0)     # follows the noon sun
            if name == "latitude_deg" and here in sites and value != mission.latitude_deg:
                self._notice = ("status", "site set to none: its skyline holds at its own latitude only")
                mission = mission.replace(skyline=None, longitude_deg=0.0)
            self._now = replaced(design, mission, model, {name: value})
            self._show_mission()

    def _show_mission(self, **changes):
        """Change the mission; it and its soil have the names of those known that they equal."""
        design, mission, model = self._now
        mission = mission.replace(**changes)
        soil = mission.soil.replace(name=OWN)
        mission = mission.replace(name=OWN, soil=self._named.get(soil, soil))
        self._now = design, self._named.get(mission, mission), model

    def _put(self, design=None, mission=None, note=""):
        """Show a design, a mission or both, and make them the base; the notice says what the sliders could not take."""
        said = [note] if note else []
        if mission is not None:
            self._named = {known.replace(name=OWN): known for known in (
                *self._soils.values(), *self._catalogue.values(), mission.soil, mission)}
            self._chosen["seed"] = CHOSEN["seed"] if mission.problem.seed is None else mission.problem.seed
        self._now = design or self.design, mission or self.scenario, self.model
        values = self.state
        for name, field in NUMBERS.items():
            near, word = field.cut(values[name])
            if word and name not in COEFFICIENTS:
                self._assign(name, near)
                said.append(word)
        self._base = self.design if design else self._base[0], *(self._now if mission else self._base)[1:]
        self._notice = ("status", "; ".join(said))

    def _restore_link(self, text):
        """Lay the state of a link over the present one; what is wrong in it is said, the rest taken."""
        found, wrong = dict(parse_qsl(text.strip().lstrip("?"))), []
        with self._step():
            for name in dict.fromkeys([*FIRST, *found]):
                if name in found and (name in NUMBERS or name in MENUS or name in SKY):
                    try:
                        value = float(found[name]) if name in NUMBERS else found[name]
                        self._assign(name, check(name, value))
                    except ValueError as error:
                        wrong.append(f"{name}={found[name]}: {error}")
            self._notice = ("alert" if wrong else "status", "; ".join(wrong))

    def file(self, name):
        """The text of a file: design.json, design.csv, front.json, front.csv, picture.svg or report.html."""
        if name not in SAVES:
            raise ValueError(f"no file {name!r}; choose from {', '.join(SAVES)}")
        (design, scenario, model), front, result = self._now, self.front, self.result
        if name == "picture.svg":
            return self._picture
        if name == "report.html":
            rover = self.state["rover"]
            return report(design, scenario, f"{'A rover' if rover == OWN else rover} for {title(scenario.name)}",
                          model=model, front=front if answers.fits(front, scenario, model) else None,
                          candidates=self.pinned)
        if name.startswith("front"):
            if not front:
                raise ValueError("there is no front yet: run a search first")
            design, scenario, result = front.designs, front.scenario, front.performance
        return catalog.to_json(design, scenario) if name.endswith("json") else catalog.to_csv(design, result)

    def load(self, name, text):
        """Show a design, or a front, from a file's name and text; a notice says what was wrong with it."""
        try:
            table = name.lower().endswith(".csv")
            design, mission = (catalog.from_csv(text), None) if table else catalog.from_json(text)
        except ValueError as error:
            self._notice = ("alert", f"{name} was not loaded: {error}")
            return self._poke()
        note = f"{name} loaded"
        with self._step():
            if design.shape:
                note += f": {len(design)} designs, shown under Optimise; the first is on the sliders"
                where = (mission or self.scenario).replace(problem=Problem())
                result = evaluate(design, where, model=self.model)
                self.front, self._recipe = Front(design, result, where, self.model, Problem()), None
                design = design[0]
            self._put(design, mission, note)

    def python(self):
        """The Python that reproduces the readings and what the view shows of them."""
        (design, scenario, model), view, more = self._now, self._chosen["view"], {}
        calls = ["result = rdk.evaluate(design, mission, model=model)",
                 f"intervals = rdk.intervals(design, mission, draws={answers.DRAWS}, model=model)"]
        if view == "why":
            more = {"baseline": self._reference}
            calls.append("why = rdk.attribution(design, baseline, mission, model=model)")
        elif view == "sweep":
            over = {name: values.tolist() for name, values in answers.swept_over(self._chosen).items()}
            calls.append(f"curve = rdk.sweep(design, mission, {over!r}, model=model)")
        elif view == "optimise" and self._recipe is not None and answers.fits(self.front, scenario, model):
            recipe = ", ".join(f"{name}={value!r}" for name, value in self._recipe.items())
            calls.append(f"front = rdk.pareto_front(mission, {recipe}, model=model)")
        return explain.as_python(design, scenario, model, *calls, **more)
