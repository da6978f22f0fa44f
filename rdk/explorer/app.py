"""The explorer: sliders that answer at once, in a notebook or as an app.

`Explorer` joins inputs (rover, mission, search) to views: the traverse log, masses, stresses, published rovers,
attribution, sweeps, the optimiser, a live front, and files. A change only marks the state as changed; one worker thread
computes the newest state and shows read-outs and picture together, so a burst of moves costs one or two answers and
nothing stale stays on the screen. Everything also runs without a browser: `set` an input, `settle()`, read `result`.
"""
from __future__ import annotations

import base64
import contextlib
import dataclasses
import html
import re
import threading
import time
from functools import partial

import numpy as np
from IPython.display import Image
from traitlets import TraitError

from .. import catalog, explain
from . import pictures
from .controls import GOALS, MISSION_SPACE, OWN, START, VIEWS, Controls, Refresher, message, show
from ..design import DESIGN_SPACE, Design, Model, Scenario, Problem
from ..mission import evaluate
from ..sampling import attribution, intervals, replaced, sweep, uncertain_inputs
from ..tradespace import Front, pareto_front

READOUTS = (("range_km", "km", 2), ("total_mass_kg", "kg", 2), ("slope_capability_deg", "deg", 1),
            ("wheel_torque_nm", "N m", 2), ("energy_balance_pct", "%", 0), ("obstacle_capability_m", "m", 3),
            ("slip", "", 2), ("cruise_speed_m_s", "m/s", 3))
FLAGS = (("stalled", "stalled"), ("thermal_survival", "thermal survival"))
DRAWS = 200                                              # Monte-Carlo draws behind the read-outs
PLANE = "total_mass_kg", "range_km", "slope_capability_deg"                # axes of a front's picture
LIVE = 40, 24                                            # population and generations of a live front from nothing


class Explorer:
    """Point design, attribution, sweeps, optimiser and files for one rover on one mission.

    Parameters
    ----------
    rover : str or Design
        Where to start: a name of `rdk.rover_names()`, or a design. Values beyond a slider are cut to its end, and the
        notice says so.
    scenario : str or Scenario
        A name of `rdk.scenario_names()`, or a mission.
    view : str
        The view shown first: "log", "mass", "stress", "rovers", "why", "sweep", "optimise", "live front" or "keep".
    model : Model
        Coefficients, single numbers.

    Attributes
    ----------
    design, scenario : Design, Scenario
        What the inputs show.
    result, intervals, binding : Performance, Intervals, Binding
        What the read-outs show, once settled.
    front : Front or None
        The front whose points are listed: of the last search, live front or file shown.
    inputs : dict of str to widget
        Every number box and menu by its name, as `set` takes them.
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

    def __init__(self, rover="Rashid-1", scenario="equatorial_mare_traverse", view="log", model=Model()):
        if view not in VIEWS:
            raise ValueError(f"no view {view!r}; choose from {', '.join(VIEWS)}")
        if model.shape:
            raise ValueError(f"model must hold single numbers; got arrays of shape {model.shape}")
        design = catalog.rover(rover) if isinstance(rover, str) else rover
        mission = catalog.scenario(scenario) if isinstance(scenario, str) else scenario
        self.model, self.error, self.result, self.intervals, self.binding = model, "", None, None, None
        self.front = self._searched = self._live = self._recipe = self._thread = None
        self._stop, self._lock, self._quiet = threading.Event(), threading.RLock(), 0
        self._soils = {name: catalog.soil(name) for name in catalog.soil_names()}
        self._published = pictures.published()
        self._figures = {name: pictures.blank() for name in VIEWS}
        self._refresher = Refresher(self._refresh)
        self.controls = Controls(self._soils, self._lock)
        self.inputs = self.controls.inputs
        self._connect()
        self._put(design, mission)
        self._baseline = self.design
        self.set(view=view)
        self.settle()

    # ---- state ------------------------------------------------------------------------------------------------

    @property
    def design(self):
        """The Design that the inputs show."""
        return Design(**{name: self.inputs[name].value for name in DESIGN_SPACE})

    @property
    def scenario(self):
        """The Scenario that the inputs show; the panel faces the noon sun."""
        values = {name: self.inputs[name].value for name in MISSION_SPACE}
        name = self.inputs["mission"].value
        return Scenario(name=name, soil=self._soils[self.inputs["soil"].value], problem=catalog.problem(name),
                        panel_azimuth_deg=0.0 if values["latitude_deg"] < 0 else 180.0, **values)

    def set(self, **values):
        """Set inputs by name, such as `slope_deg=20`, `soil="fjs-1"`, `view="why"` or `population=30`.

        Raises
        ------
        ValueError
            If there is no such input, or it does not take the value; the message says what is allowed.
        """
        for name, value in values.items():
            if name not in self.inputs:
                raise ValueError(f"no input {name!r}; choose from {', '.join(self.inputs)}")
            widget = self.inputs[name]
            if hasattr(widget, "min"):
                whole = isinstance(widget.value, int)
                if not isinstance(value, (int, float, np.number)) or not widget.min <= value <= widget.max or (
                        whole and value != int(value)):
                    kind = "a whole number" if whole else "a number"
                    raise ValueError(f"{name} must be {kind} from {widget.min:g} to {widget.max:g}; got {value!r}")
            try:
                widget.value = value
            except TraitError:
                choices = ", ".join(str(choice) for choice in widget._options_values)
                raise ValueError(f"{name} must be one of {choices}; got {value!r}") from None

    def settle(self, timeout_s=60):
        """Wait until read-outs and picture show the present state."""
        self._refresher.settle(timeout_s)

    @contextlib.contextmanager
    def _still(self):
        """Several changes as one: no other thread sees the middle, no callback acts on it."""
        with self._lock:
            self._quiet += 1
            try:
                yield
            finally:
                self._quiet -= 1

    def _put(self, design=None, mission=None, note=""):
        """Show a design, a mission or both as one change; the notice says what the sliders could not take."""
        words = [note] if note else []
        with self._still():
            for name, variable in (DESIGN_SPACE | MISSION_SPACE).items():
                source = design if name in DESIGN_SPACE else mission
                if source is not None:
                    wanted = getattr(source, name)
                    self.inputs[name].value = value = min(max(wanted, variable.low), variable.high)
                    if value != wanted:
                        words.append(f"{variable.label} {wanted:g} cut to {value:g}, the end of its slider")
            if mission is not None:
                self.inputs["soil"].value = self._soil_key(mission.soil)
                menu = self.inputs["mission"]
                menu.value = mission.name if mission.name in menu.options else OWN
                if menu.value != OWN and self.scenario != catalog.scenario(menu.value):
                    menu.value = OWN                     # the name of a catalogued mission, but other values
                if self.scenario.panel_azimuth_deg != mission.panel_azimuth_deg:
                    words.append(f"panel turned from {mission.panel_azimuth_deg:g} deg to the noon sun")
                self._pose(catalog.problem(menu.value))
            if design is not None:
                same = (name for name in catalog.rover_names() if catalog.rover(name) == self.design)
                self.inputs["rover"].value = next(same, OWN)
            self.controls.notice.value = message("; ".join(words), "status")
        self._changed()

    def _soil_key(self, soil):
        """The soil's entry in the menu; a soil that is not there yet joins it."""
        for key, known in self._soils.items():
            if known == soil:
                return key
        key = f"{soil.name or 'unnamed'} (loaded)"
        self._soils[key] = soil
        self.inputs["soil"].options = list(self._soils)
        return key

    def _changed(self, change=None):
        self._refresher.poke()

    # ---- what the controls do ---------------------------------------------------------------------------------

    def _connect(self):
        special = {"rover": self._on_rover, "mission": self._on_mission, "view": self._on_view, "page": self._on_page,
                   "point": self._on_point}
        special |= {name: partial(self._on_value, "rover") for name in DESIGN_SPACE}
        special |= {name: partial(self._on_value, "mission") for name in (*MISSION_SPACE, "soil")}
        for name, widget in self.inputs.items():
            self._watch(widget, special.get(name, self._changed))
        self._watch(self.controls.upload, self._on_upload)
        self.controls.run.on_click(lambda _: self.optimise())
        self.controls.cancel.on_click(lambda _: self._stop.set())

    def _watch(self, widget, action):
        """Act on a widget's new value, one callback at a time, but for changes made by the explorer itself."""
        def act(change):
            with self._lock:
                if not self._quiet:
                    action(change)
        widget.observe(act, "value")

    def _on_value(self, owner, change):
        with self._still():
            self.inputs[owner].value = OWN               # no longer the rover or the mission of that name
        self._changed()

    def _on_rover(self, change):
        if change.new != OWN:
            self._put(design=catalog.rover(change.new))

    def _on_mission(self, change):
        if change.new != OWN:
            self._put(mission=catalog.scenario(change.new))
        else:
            self._changed()

    def _on_page(self, change):
        show(self.controls.pages, change.new)

    def _on_view(self, change):
        page = {"optimise": "search", "live front": "mission"}.get(change.new)
        if page:
            self.inputs["page"].value = page
        self.controls.picture.add_class("rdk-waiting")   # of the view before
        self._changed()

    def _on_point(self, change):
        if change.new is not None:
            self._put(self.front.designs[change.new])

    def _on_upload(self, change):
        for file in change.new:
            self.load(file["name"], file["content"])
        with self._still():
            self.controls.upload.value = ()              # so that the same file can be loaded again

    def _repr_mimebundle_(self, **kwargs):
        """The widgets; for readers without a kernel, the read-outs as text and the picture."""
        still = {"text/plain": self.text()}
        if self.image() is not None and self.inputs["view"].value != "live front":       # no still of what is to move
            still["image/png"] = base64.b64encode(self.image().data).decode()
        return {**self.controls.widget._repr_mimebundle_(**kwargs), **still}

    def image(self):
        """The picture as it stands, an IPython Image with its alternative text; None where the view has none."""
        found = re.search(r'alt="([^"]*)" src="data:image/png;base64,([^"]*)"', self.controls.picture.value)
        return found and Image(base64.b64decode(found[2]), alt=html.unescape(found[1]))

    # ---- answers ----------------------------------------------------------------------------------------------

    def _refresh(self):
        """Compute the present state and show it; an error becomes a message, never a traceback in a thread."""
        with self._lock:
            view, design, scenario = self.inputs["view"].value, self.design, self.scenario
        see, text = self.controls, ""
        try:
            result = evaluate(design, scenario, model=self.model)
            self.intervals = intervals(design, scenario, draws=DRAWS, model=self.model)
            self.result, self.binding = result, explain.binding(design, scenario, result, self.model)
            self._rows = self._tabulate(design, scenario)
            see.readout.value = text = self._readout_html()
            picture, self.error = self._draw(view, design, scenario, result), ""
        except Exception as error:                       # anything at all: the app must go on and say what happened
            self.error = f"{type(error).__name__}: {error}"
            see.readout.value, picture = text, message(self.error)
        show(see.panels, view)
        see.picture.value = picture
        see.picture.remove_class("rdk-waiting")

    def _tabulate(self, design, scenario):
        """Rows of the read-outs: what, value, 90 % interval, and the limit in words."""
        rows = []
        for name, unit, digits in READOUTS:
            value, low, high = (float(x) for x in (getattr(self.result, name), self.intervals.low[name],
                                                   self.intervals.high[name]))
            rows.append((name, pictures.label(name).split(" (")[0], _words(value, digits, unit),
                         _words(low, digits) + " to " + _words(high, digits)))
        for name, title in FLAGS:
            share = 100 * float(self.intervals.low[name])
            rows.append((name, title, "yes" if getattr(self.result, name) else "no", f"yes in {share:.0f} %"))
        needed = {limit.metric: ("✓ met: " if limit.met else "✗ missed: ") + limit.words
                  for limit in explain.limits(design, scenario, self.result, self.model)}
        return [(*row, needed.get(name, "")) for name, *row in rows]

    def _readout_html(self):
        rows = "".join(f"<tr><th scope='row'>{title}</th><td><b>{value}</b></td><td>{span}</td><td>{limit}</td></tr>"
                       for title, value, span, limit in self._rows)
        head = "".join(f"<th scope='col'>{title}</th>" for title in ("read-out", "value", "90 % interval", "needed"))
        sentence, detail = html.escape(self.binding.sentence), html.escape(self.binding.detail)
        return (f"<div role='status'><b>{sentence}</b> {detail}</div>"
                f"<table class='rdk-readout'><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table>")

    def text(self):
        """The read-outs as plain text."""
        if self.error:
            return self.error
        rows = [f"{title:24}{value:>11}   {span:22}{limit}".rstrip() for title, value, span, limit in self._rows]
        return "\n".join([self.binding.sentence, self.binding.detail, *rows])

    def _draw(self, view, design, scenario, result):
        figure = self._figures[view]
        if view == "log":
            alt = pictures.log(figure, result, scenario, self.model.soc_initial)
        elif view == "mass":
            alt = pictures.mass(figure, result)
        elif view == "stress":
            alt = pictures.stress(figure, result, design, scenario, self.model)
        elif view == "rovers":
            names, designs = self._published
            others = evaluate(designs, scenario, model=self.model)
            alt = pictures.among_rovers(figure, result, (others.total_mass_kg, others.range_km, names), [
                (self.intervals.low[n], self.intervals.high[n]) for n in ("total_mass_kg", "range_km")])
        elif view == "why":
            name, metric = self.inputs["baseline"].value, self.inputs["why_metric"].value
            why = attribution(design, self._reference(name), scenario, model=self.model)
            if metric not in why.contributions:
                return message(f"{pictures.label(metric)} has no value in some mixture of the two designs (a buried "
                               "wheel), so that its difference cannot be shared out. Choose another metric.")
            alt = pictures.why(figure, metric, why.contributions[metric],
                               float(getattr(why.baseline_performance, metric)), float(getattr(result, metric)), name)
        elif view == "sweep":
            alt = self._draw_sweep(figure, design, scenario, result)
        elif view == "optimise":
            if self._searched is None:
                return message("No front yet: press Run under the inputs 'search'.", "status")
            return self._draw_front(figure, self._searched, result, "front of the search")
        elif view == "live front":
            if self._live is None or self._live.scenario != _plain(scenario):
                self.controls.picture.add_class("rdk-waiting")
                self._live = live_front(scenario, self._live, self.model)
            return self._draw_front(figure, self._live, result, "live front of this mission")
        else:
            self._show_files(design, scenario, result)
            return ""
        return pictures.html(figure, alt)

    def _reference(self, name):
        return self._baseline if name == START else catalog.rover(name)

    def _sweep_values(self):
        """The fields to sweep, each with values across its slider, whole numbers where it must be."""
        fields = filter(None, (self.inputs["sweep_first"].value, self.inputs["sweep_second"].value))
        return {n: np.linspace(self.inputs[n].min, self.inputs[n].max, 25).round(0 if n == "grouser_count" else 9)
                for n in fields}

    def _draw_sweep(self, figure, design, scenario, result):
        over, metric, (names, fleet) = self._sweep_values(), self.inputs["sweep_metric"].value, self._published
        fields, values, here = list(over), list(over.values()), [self.inputs[n].value for n in over]
        # a mission's field is not the rovers' own: no place for them on its axis
        places = [getattr(fleet, n) for n in fields] if all(n in DESIGN_SPACE for n in fields) else None
        grid = np.asarray(getattr(sweep(design, scenario, over, model=self.model).performance, metric), float)
        if len(fields) == 2:
            return pictures.contour(figure, fields, metric, values, grid, here, places and (*places, names))
        draws = {n: v[:, None] for n, v in uncertain_inputs(scenario, draws=60, model=self.model).items()}
        knots = values[0][::2]                           # half the work, and the eye sees no difference
        *changed, model = replaced(design, scenario, self.model, {**draws, fields[0]: knots})
        cloud = evaluate(*changed, model=model)
        band = np.quantile(np.nan_to_num(getattr(cloud, metric)), [0.05, 0.95], axis=0)
        others = places and (*places, getattr(evaluate(fleet, scenario, model=self.model), metric), names)
        return pictures.curve(figure, fields[0], metric, values[0], grid, (knots, *band),
                              (*here, float(getattr(result, metric))), others)

    # ---- fronts -----------------------------------------------------------------------------------------------

    def _pose(self, study):
        """Set the search as the study poses it."""
        for name, goal in GOALS.items():
            self.inputs[goal].value = study.objectives.get(name, "ignore")
        limits = {name: limit for name, _, limit in study.constraints}
        self.inputs["minimum_range_km"].value = limits.get("range_km", 0)
        self.inputs["maximum_mass_kg"].value = limits.get("total_mass_kg", self.inputs["maximum_mass_kg"].max)
        self.inputs["minimum_slope_deg"].value = limits.get("slope_capability_deg", 0)
        if study.seed is not None:
            self.inputs["seed"].value = study.seed

    def _problem(self):
        """What `pareto_front` needs for the search that the inputs pose; a limit at its loose end is none."""
        value = {name: widget.value for name, widget in self.inputs.items()}
        limits = [("range_km", ">=", value["minimum_range_km"]), ("total_mass_kg", "<=", value["maximum_mass_kg"]),
                  ("slope_capability_deg", ">=", value["minimum_slope_deg"])]
        loose = {">=": 0, "<=": self.inputs["maximum_mass_kg"].max}
        return dict(population=value["population"], generations=value["generations"], seed=value["seed"],
                    objectives={name: value[goal] for name, goal in GOALS.items() if value[goal] != "ignore"},
                    constraints=[limit for limit in limits if limit[2] != loose[limit[1]]])

    def optimise(self, wait=False):
        """Search in the background for the mission as it stands; with `wait`, return when the search has ended."""
        with self._still():
            if self._thread is None:
                problem, see = self._problem(), self.controls
                self._stop.clear()
                see.run.disabled, see.cancel.disabled = True, False
                see.progress.max, see.progress.value = problem["generations"], 0
                see.status.value = message("starting", "status")
                self._thread = threading.Thread(target=self._search, args=(_plain(self.scenario), problem))
                self._thread.start()
            thread = self._thread
        if wait:
            thread.join()
            self.settle()

    def _search(self, scenario, problem):
        """The search's thread: progress, a growing front, cancel."""
        drawn, see = time.monotonic(), self.controls

        def follow(progress):
            nonlocal drawn
            see.progress.value = progress.generation
            see.status.value = message(f"generation {progress.generation} of {progress.generations}", "status")
            if time.monotonic() - drawn > 0.4:
                self._searched, self._recipe = progress.front(), None
                self._changed()
                drawn = time.monotonic()
            return self._stop.is_set() or not threading.main_thread().is_alive()     # the program is ending

        try:
            front = pareto_front(scenario, model=self.model, on_generation=follow, warn=False, **problem)
            done = front.message or f"done: {len(front)} designs after {problem['generations']} generations"
            recipe = {**problem, "generations": len(front.objective_history)}    # fewer where it was cancelled
        except Exception as error:
            front, recipe, done = None, None, f"{type(error).__name__}: {error}"
        with self._still():
            self._searched, self._recipe, self._thread = front, recipe, None
            self._offer(front)
            see.status.value = message(done, "status")
            see.run.disabled, see.cancel.disabled = False, True
        self._changed()

    def _offer(self, front):
        """List the points of a front for picking."""
        with self._still():
            if front is not self.front:
                self.front, p = front, None if front is None else front.performance
                self.controls.points.options = [] if p is None else [
                    (f"{i + 1}: {m:.1f} kg, {r:.2f} km, {s:.1f} deg", i)
                    for i, (m, r, s) in enumerate(zip(p.total_mass_kg, p.range_km, p.slope_capability_deg))]
                self.controls.points.value = None

    def _draw_front(self, figure, front, result, title):
        self._offer(front)
        mass, *others = (getattr(front.performance, name) for name in PLANE)
        here = [getattr(result, name) for name in PLANE]
        alt = pictures.front(figure, mass, others, PLANE, self.controls.points.value, here,
                             title=f"{title}: {len(front)} designs")
        return message(front.message, "status") + pictures.html(figure, alt, pictures.places(figure, mass, others))

    # ---- files ------------------------------------------------------------------------------------------------

    def _show_files(self, design, scenario, result):
        files = {"design.json": catalog.to_json(design, scenario), "design.csv": catalog.to_csv(design, result)}
        if self.front is not None and len(self.front):
            files |= {"front.json": catalog.to_json(self.front.designs, self.front.scenario),
                      "front.csv": catalog.to_csv(self.front.designs, self.front.performance)}
        self.controls.links.value = "Download: " + ", ".join(
            f'<a download="{name}" href="data:text/plain;base64,{base64.b64encode(text.encode()).decode()}">{name}</a>'
            for name, text in files.items())
        self.controls.code.value = self.python(design, scenario)

    def python(self, design=None, scenario=None):
        """The Python that reproduces what the menu `script` names, as it stands on the screen."""
        design = self.design if design is None else design
        scenario = self.scenario if scenario is None else scenario
        wanted = self.inputs["script"].value
        if wanted == "the front":
            if self.front is None or self.front is not self._searched or self._recipe is None:
                return "# No front of a finished search is listed: choose the view 'optimise' and press Run.\n"
            recipe = ", ".join(f"{name}={value!r}" for name, value in self._recipe.items())
            return explain.as_python(design, self.front.scenario, self.model,
                                     f"front = rdk.pareto_front(mission, {recipe}, model=model)")
        if wanted == "why":
            return explain.as_python(design, scenario, self.model, "why = rdk.attribution(design, baseline, mission, model=model)",
                                     baseline=self._reference(self.inputs["baseline"].value))
        if wanted == "the sweep":
            over = {name: values.tolist() for name, values in self._sweep_values().items()}
            return explain.as_python(design, scenario, self.model, f"curve = rdk.sweep(design, mission, {over!r}, model=model)")
        return explain.as_python(design, scenario, self.model, "result = rdk.evaluate(design, mission, model=model)",
                                 f"intervals = rdk.intervals(design, mission, draws={DRAWS}, model=model)")

    def load(self, name, content):
        """Show a design, or a front, from a file's name and bytes; the notice says what was wrong with it."""
        try:
            text = bytes(content).decode("utf-8-sig")
            design, mission = (catalog.from_csv(text), None) if name.lower().endswith(".csv") else catalog.from_json(text)
        except ValueError as error:                      # also where the bytes are no text
            self.controls.notice.value = message(f"{name} was not loaded: {error}")
            return
        note = f"{name} loaded"
        if design.shape:
            note += f": {len(design)} designs, listed under the inputs 'search'; the first is shown"
            where = _plain(self.scenario if mission is None else mission)
            design = Design(**{n: np.clip(getattr(design, n), v.low, v.high) for n, v in DESIGN_SPACE.items()})
            found = evaluate(design, where, model=self.model)
            self._searched, self._recipe = Front(design, found, where, self.model, Problem()), None
            self._offer(self._searched)
            design = design[0]
        self._put(design, mission, note)


def live_front(scenario, start=None, model=Model()):
    """A front quick enough to follow a slider: a small population, warm-started from the last front.

    Parameters
    ----------
    scenario : Scenario
    start : Front, optional
        With one, half as many generations are enough.
    model : Model

    Returns
    -------
    Front
        Less complete than that of a full search.
    """
    population, generations = LIVE
    return pareto_front(_plain(scenario), population=population, seed=1, start=start, model=model, warn=False,
                        generations=generations if start is None else generations // 2)


def _plain(scenario):
    """The mission without its study: a search keeps the range limit that the slider shows."""
    return dataclasses.replace(scenario, problem=Problem())


def _words(value, digits, unit=""):
    return "none" if np.isnan(value) else f"{value:.{digits}f} {unit}".rstrip()
