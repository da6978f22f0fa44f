"""The explorer: sliders that answer at once, in a notebook or as an app.

`Explorer` joins a column of linked sliders and number boxes to views: the traverse log, masses, stresses, published
rovers, attribution, sweeps, the optimiser, a live front, and files. A change only marks the state as changed; one
worker thread computes the newest state and shows read-outs and picture together, so a burst of moves costs one or two
answers and nothing stale stays on the screen. Everything also runs without a browser: set a control's value, call
`settle()`, read the texts.
"""
from __future__ import annotations

import base64
import dataclasses
import html as html_module
import threading
import time

import ipywidgets as W
import numpy as np

from . import catalog, explain, keep, pictures
from .design import DESIGN_SPACE, Design, Model, Scenario, Study, Variable
from .mission import evaluate
from .sampling import attribution, intervals, sweep
from .tradespace import pareto_front

MISSION_SPACE = {
    "latitude_deg": Variable(-90, 90, "deg", "", "latitude"),
    "duration_earth_days": Variable(1, 60, "days", "", "duration"),
    "slope_deg": Variable(0, 35, "deg", "", "slope"),
    "duty_cycle": Variable(0, 1, "1", "", "duty cycle"),
    "payload_mass_kg": Variable(0, 30, "kg", "", "payload mass"),
    "payload_power_w": Variable(0, 40, "W", "", "payload power"),
    "required_obstacle_height_m": Variable(0, 0.3, "m", "", "obstacle height"),
    "panel_tilt_deg": Variable(0, 90, "deg", "", "panel tilt"),
    "traverse_limit_km": Variable(0, 200, "km", "", "range limit")}
"""Mission inputs of the explorer, with the span of their sliders."""
STEPS = {"wheel_radius_m": 0.005, "wheel_width_m": 0.005, "grouser_height_m": 0.001, "grouser_count": 1,
         "chassis_mass_kg": 0.5, "wheelbase_m": 0.05, "solar_area_m2": 0.01, "battery_capacity_wh": 5,
         "avionics_power_w": 1, "peak_wheel_torque_nm": 0.05, "latitude_deg": 1, "duration_earth_days": 1,
         "slope_deg": 1, "duty_cycle": 0.01, "payload_mass_kg": 0.5, "payload_power_w": 1,
         "required_obstacle_height_m": 0.01, "panel_tilt_deg": 1, "traverse_limit_km": 1}
READOUTS = (("range_km", "km", 2), ("total_mass_kg", "kg", 2), ("slope_capability_deg", "deg", 1),
            ("energy_balance_pct", "%", 0), ("obstacle_capability_m", "m", 3), ("slip", "1", 2),
            ("cruise_speed_m_s", "m/s", 3))
DRAWS = 200                                              # Monte-Carlo draws behind the read-outs
VIEWS = ("log", "mass", "stress", "rovers", "why", "sweep", "optimise", "live front", "keep")
NUMERIC = ("range_km", "total_mass_kg", "slope_capability_deg", "energy_balance_pct", "cruise_speed_m_s", "slip",
           "sinkage_m", "wheel_torque_nm", "final_soc", "average_solar_power_w", "obstacle_capability_m")
_WIDE = W.Layout(width="auto")


class Refresher:
    """Runs `work` in a thread whenever it is poked; pokes during a run lead to one more run.

    Callbacks may come from any thread: only this thread computes and writes to the screen.
    """

    def __init__(self, work):
        self._work, self._changed = work, threading.Condition()
        self._wanted = self._done = 0
        self._thread = None

    def poke(self):
        """Ask for a run with the state as it is now."""
        with self._changed:
            self._wanted += 1
            if self._thread is None:
                self._thread = threading.Thread(target=self._loop, daemon=True)
                self._thread.start()

    def _loop(self):
        while True:
            with self._changed:
                target = self._wanted
                if target == self._done:
                    self._thread = None
                    self._changed.notify_all()
                    return
            self._work()
            with self._changed:
                self._done = target

    def settle(self, timeout_s=60):
        """Wait until nothing is left to do; raises TimeoutError otherwise."""
        with self._changed:
            if not self._changed.wait_for(lambda: self._thread is None and self._wanted == self._done, timeout_s):
                raise TimeoutError(f"the explorer did not settle within {timeout_s} s")


class Control:
    """A number box with its label and unit, linked to a slider."""

    def __init__(self, name, variable, value):
        text = variable.label + (f" ({variable.unit})" if variable.unit != "1" else "")
        whole = variable.kind == "whole"
        span = dict(min=variable.low, max=variable.high, step=STEPS[name], value=value)
        box, slider = (W.BoundedIntText, W.IntSlider) if whole else (W.BoundedFloatText, W.FloatSlider)
        self.box = box(description=text, style={"description_width": "128px"}, layout=W.Layout(width="218px"), **span)
        self.slider = slider(readout=False, tooltip=text, layout=W.Layout(width="122px", min_width="90px"), **span)
        self.name = name
        W.link((self.box, "value"), (self.slider, "value"))
        self.row = W.HBox([self.box, self.slider])


class Explorer:
    """Point design, attribution, sweeps, optimiser and files for one rover on one mission.

    Parameters
    ----------
    rover : str or Design
        Where to start: a name of `rdk.rover_names()`, or a design.
    scenario : str or Scenario
        A name of `rdk.scenario_names()`, or a mission.
    view : str
        The view shown first, one of VIEWS.
    model : Model
        Coefficients.

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
        design = catalog.rover(rover) if isinstance(rover, str) else rover
        mission = catalog.scenario(scenario) if isinstance(scenario, str) else scenario
        self.model, self._baseline = model, design
        self.error, self.result, self.intervals, self.binding = "", None, None, None
        self.front, self._fronts, self._stop, self._thread = None, {}, threading.Event(), None
        self._published = pictures.published()
        self._figures = {name: pictures.blank() for name in VIEWS}
        self._quiet, self._call = 0, "rdk.evaluate(design, mission)"
        self._refresher = Refresher(self._refresh)
        self._build(design, mission, rover if isinstance(rover, str) else "a design", view)
        self._put(design, mission)
        self.settle()

    # ---- state ------------------------------------------------------------------------------------------------

    @property
    def design(self):
        """The Design that the sliders show."""
        values = {name: control.box.value for name, control in self.controls.items() if name in DESIGN_SPACE}
        return Design(**values, wheel_count=self.wheels.value)

    @property
    def scenario(self):
        """The Scenario that the sliders show; the panel faces the noon sun."""
        values = {name: control.box.value for name, control in self.controls.items() if name in MISSION_SPACE}
        return Scenario(name=self.mission.value, soil=catalog.soil(self.soil.value), study=catalog.study(
            self.mission.value), panel_azimuth_deg=0.0 if values["latitude_deg"] < 0 else 180.0, **values)

    def set(self, **values):
        """Set controls by name: design variables, mission inputs, `wheel_count`, `soil`, `mission`, `rover`, `view`."""
        menus = {"wheel_count": self.wheels, "soil": self.soil, "mission": self.mission, "rover": self.rover,
                 "view": self.view}
        for name, value in values.items():
            if name not in menus and name not in self.controls:
                raise ValueError(f"no control {name!r}; choose from {', '.join([*self.controls, *menus])}")
            widget = menus.get(name) or self.controls[name].box
            widget.value = value

    def settle(self, timeout_s=60):
        """Wait until read-outs and picture show the present state."""
        self._refresher.settle(timeout_s)

    def _put(self, design, mission=None):
        """Show a design, and a mission if given, as one change."""
        self._quiet += 1
        try:
            for name, control in self.controls.items():
                source = design if name in DESIGN_SPACE else mission
                if source is not None:
                    control.box.value = min(max(getattr(source, name), control.box.min), control.box.max)
            self.wheels.value = design.wheel_count
            if mission is not None:
                known = mission.soil.name in self.soil.options
                self.soil.value = mission.soil.name if known else self.soil.value
                if mission.name in self.mission.options:
                    self.mission.value = mission.name
        finally:
            self._quiet -= 1
        self._changed()

    def _changed(self, change=None):
        if not self._quiet:
            self._refresher.poke()

    # ---- widgets ----------------------------------------------------------------------------------------------

    def _build(self, design, mission, start, view):
        self.controls = {n: Control(n, v, getattr(design, n)) for n, v in DESIGN_SPACE.items() if n != "wheel_count"}
        self.controls |= {n: Control(n, v, min(max(getattr(mission, n), v.low), v.high)) for n, v in
                          MISSION_SPACE.items()}
        menu = dict(style={"description_width": "128px"}, layout=W.Layout(width="340px"))
        self.wheels = W.Dropdown(options=[("4, rigid", 4), ("6, rocker-bogie", 6)], description="wheels", **menu)
        self.soil = W.Dropdown(options=catalog.soil_names(), value=catalog.soil_names()[0], description="soil", **menu)
        self.mission = W.Dropdown(options=catalog.scenario_names(), description="mission", **menu)
        self.rover = W.Dropdown(options=[*catalog.rover_names(), "a design"], value=start, description="start from",
                                **menu)
        self.view = W.ToggleButtons(options=VIEWS, value=view, description="view",
                                    style={"button_width": "auto", "description_width": "40px"})
        self.readout, self.picture, self.panel = W.HTML(), W.HTML(), W.VBox()
        names = [n for n in DESIGN_SPACE if n != "wheel_count"]
        rover_box = W.VBox([self.rover, *(self.controls[n].row for n in names[:4]), self.wheels,
                            *(self.controls[n].row for n in names[4:])])
        mission_box = W.VBox([self.mission, self.soil, *(self.controls[n].row for n in MISSION_SPACE)])
        self._sides = {"rover": rover_box, "mission": mission_box}
        self.side = W.ToggleButtons(options=list(self._sides), description="inputs",
                                    style={"button_width": "110px", "description_width": "60px"})
        mission_box.layout.display = "none"
        self.side.observe(self._show_side, "value")
        self._panels = {"why": self._build_why(), "sweep": self._build_sweep(), "optimise": self._build_optimise(),
                        "live front": self._build_live(), "keep": self._build_keep()}
        for panel in self._panels.values():
            panel.layout.display = "none"
        left = W.VBox([self.side, rover_box, mission_box], layout=W.Layout(flex="0 0 352px", overflow="hidden"))
        right = W.VBox([self.readout, self.view, *self._panels.values(), self.picture],
                       layout=W.Layout(flex="1 1 480px", min_width="0"))
        self.widget = W.HBox([left, right], layout=W.Layout(width="100%", flex_flow="row wrap"))
        self.widget.add_class("rdk-explorer")
        for control in self.controls.values():
            control.box.observe(self._changed, "value")
        for widget in (self.wheels, self.soil, self.view):
            widget.observe(self._changed, "value")
        self.mission.observe(self._on_mission, "value")
        self.rover.observe(self._on_rover, "value")

    def _show_side(self, change):
        for name, box in self._sides.items():
            box.layout.display = None if name == change.new else "none"

    def _on_mission(self, change):
        if not self._quiet:
            self._put(self.design, catalog.scenario(change.new))

    def _on_rover(self, change):
        if not self._quiet and change.new in catalog.rover_names():
            self._put(catalog.rover(change.new))

    def _repr_mimebundle_(self, **kwargs):
        return self.widget._repr_mimebundle_(**kwargs)

    def _build_why(self):
        narrow = dict(style={"description_width": "60px"}, layout=W.Layout(width="230px"))
        self.baseline = W.Dropdown(options=[*catalog.rover_names(), "the design at the start"], description="baseline",
                                   value="the design at the start", **narrow)
        self.why_metric = W.Dropdown(options=[(pictures.label(n), n) for n in NUMERIC], description="metric", **narrow)
        for widget in (self.baseline, self.why_metric):
            widget.observe(self._changed, "value")
        return W.HBox([self.baseline, self.why_metric])

    def _build_sweep(self):
        narrow = dict(style={"description_width": "60px"}, layout=W.Layout(width="190px"))
        fields = [(self.controls[n].box.description, n) for n in self.controls if n != "duration_earth_days"]
        self.sweep_first = W.Dropdown(options=fields, description="along", **narrow)
        self.sweep_second = W.Dropdown(options=[("nothing else", ""), *fields], description="and", **narrow)
        self.sweep_metric = W.Dropdown(options=[(pictures.label(n), n) for n in NUMERIC], description="metric", **narrow)
        for widget in (self.sweep_first, self.sweep_second, self.sweep_metric):
            widget.observe(self._changed, "value")
        return W.HBox([self.sweep_first, self.sweep_second, self.sweep_metric], layout=W.Layout(flex_flow="row wrap"))

    def _build_optimise(self):
        short = dict(style={"description_width": "84px"}, layout=W.Layout(width="165px"))
        self.objectives = {name: W.Dropdown(
            options=["max", "min", "ignore"], value=direction, description=text, style={"description_width": "100px"},
            layout=W.Layout(width="185px")) for name, text, direction in (
                ("range_km", "range", "max"), ("total_mass_kg", "mass", "min"), ("slope_capability_deg", "slope", "max"))}
        self.minimum_range = W.BoundedFloatText(value=0.1, min=0, max=1000, step=0.1, description="range >= km", **short)
        self.minimum_slope = W.BoundedFloatText(value=0, min=0, max=35, step=1, description="slope >= deg", **short)
        self.maximum_mass = W.BoundedFloatText(value=100, min=1, max=1000, step=1, description="mass <= kg", **short)
        self.population = W.BoundedIntText(value=50, min=8, max=400, step=2, description="population", **short)
        self.generations = W.BoundedIntText(value=60, min=1, max=1000, step=10, description="generations", **short)
        self.seed = W.BoundedIntText(value=13, min=0, max=10**6, description="seed", **short)
        self.run = W.Button(description="Run", button_style="", layout=W.Layout(width="90px"))
        self.cancel = W.Button(description="Cancel", disabled=True, layout=W.Layout(width="90px"))
        self.progress = W.IntProgress(description="progress", layout=W.Layout(width="220px"))
        self.status = W.HTML('<div role="status">ready</div>')
        self.points = W.Select(options=[], description="points", rows=5, style={"description_width": "60px"},
                               layout=W.Layout(width="100%", max_width="520px"))
        self.run.on_click(lambda _: self.optimise())
        self.cancel.on_click(lambda _: self._stop.set())
        self.points.observe(self._on_point, "value")
        wrap = W.Layout(flex_flow="row wrap")
        return W.VBox([W.HBox(list(self.objectives.values()), layout=wrap),
                       W.HBox([self.minimum_range, self.minimum_slope, self.maximum_mass], layout=wrap),
                       W.HBox([self.population, self.generations, self.seed], layout=wrap),
                       W.HBox([self.run, self.cancel, self.progress]), self.status, self.points])

    def _build_live(self):
        self.live_status = W.HTML('<div role="status">Change the mission: the front follows.</div>')
        return W.VBox([self.live_status])

    def _build_keep(self):
        self.upload = W.FileUpload(accept=".json,.csv", multiple=False, description="Load a file")
        self.upload.observe(self._on_upload, "value")
        self.links, self.message, self.code = W.HTML(), W.HTML(), W.Textarea(
            description="as Python", disabled=False, style={"description_width": "70px"},
            layout=W.Layout(width="100%", height="300px"))
        return W.VBox([self.links, W.HBox([self.upload, self.message]), self.code])

    # ---- answers ----------------------------------------------------------------------------------------------

    def _refresh(self):
        """Compute the present state and show it; an error becomes a message, never a traceback in a thread."""
        try:
            view, design, scenario = self.view.value, self.design, self.scenario
            result = evaluate(design, scenario, self.model)
            spans = intervals(design, scenario, draws=DRAWS, model=self.model)
            self.result, self.intervals = result, spans
            self.binding = explain.binding(design, scenario, result, self.model)
            text = self._readout_html(design, scenario, result, spans)
            picture = self._draw(view, design, scenario, result, spans)
            self.error = ""
        except Exception as error:                       # anything at all: the app must go on and say what happened
            self.error = f"{type(error).__name__}: {error}"
            text, picture, view = _message(self.error), "", self.view.value
        self.readout.value = text
        for name, panel in self._panels.items():
            panel.layout.display = None if name == view else "none"
        self.picture.value = picture

    def _readout_html(self, design, scenario, result, spans):
        rows = []
        for name, unit, digits in READOUTS:
            value, low, high = (float(x) for x in (getattr(result, name), spans.low[name], spans.high[name]))
            unit = "" if unit == "1" else unit
            rows.append(f"<tr><th scope='row'>{pictures.label(name).split(' (')[0]}</th>"
                        f"<td><b>{value:.{digits}f}</b> {unit}</td><td>{low:.{digits}f} to {high:.{digits}f} {unit}</td></tr>")
        for name, title in ("thermal_survival", "survives heat and night"), ("stalled", "stalled"):
            rows.append(f"<tr><th scope='row'>{title}</th><td><b>{'yes' if getattr(result, name) else 'no'}</b></td>"
                        f"<td>yes in {100 * float(spans.low[name]):.0f} % of draws</td></tr>")
        met = "".join(f"<li>{'✓ met' if limit.met else '✗ missed'}: {limit.name} - {limit.words}</li>"
                      for limit in explain.limits(design, scenario, result))
        return ("<style>.rdk-readout{line-height:1.25;font-size:13px}.rdk-readout table{border-collapse:collapse}"
                ".rdk-readout th{text-align:left;font-weight:normal;padding-right:10px}.rdk-readout td{padding-right:12px;"
                "font-variant-numeric:tabular-nums}.rdk-readout ul{margin:0;padding-left:4px;list-style:none}"
                ".rdk-readout .two{display:flex;flex-wrap:wrap;gap:0 22px}.rdk-readout p{margin:4px 0}</style>"
                f"<div class='rdk-readout' role='status'><p><b>{html_module.escape(self.binding.sentence)}</b></p>"
                f"<div class='two'><table><tr><th scope='col'>read-out</th><th scope='col'>value</th><th scope='col'>"
                f"90 % interval</th></tr>{''.join(rows)}</table><ul>{met}</ul></div></div>")

    def _draw(self, view, design, scenario, result, spans):
        figure = self._figures[view]
        if view == "log":
            alt = pictures.log(figure, result, scenario)
        elif view == "mass":
            alt = pictures.mass(figure, result)
        elif view == "stress":
            alt = pictures.stress(figure, result, design, scenario, self.model)
        elif view == "rovers":
            names, designs = self._published
            others = evaluate(designs, scenario, self.model)
            alt = pictures.among_rovers(figure, result, (others.total_mass_kg, others.range_km, names), [
                (spans.low[n], spans.high[n]) for n in ("total_mass_kg", "range_km")])
        elif view == "why":
            name = self.baseline.value
            baseline = self._baseline if name not in catalog.rover_names() else catalog.rover(name)
            why, metric = attribution(design, baseline, scenario, self.model), self.why_metric.value
            if metric not in why.contributions:
                return _message(f"{pictures.label(metric)} has no value in some mixture of the two designs (a buried "
                                "wheel), so that its difference cannot be shared out. Choose another metric.")
            alt = pictures.why(figure, metric, why.contributions[metric],
                               float(getattr(why.baseline_performance, metric)), float(getattr(result, metric)), name)
        elif view == "sweep":
            alt = self._draw_sweep(figure, design, scenario, result)
        elif view == "optimise":
            return self._draw_front(figure, self.front, result)
        elif view == "live front":
            return self._draw_live(figure, scenario, result)
        else:
            self._show_files(design, scenario, result)
            return ""
        return pictures.html(figure, alt)

    def _span(self, name):
        """Values of a control's field across its slider, whole numbers where it must be."""
        box = self.controls[name].box
        values = np.linspace(box.min, box.max, 25)
        return np.unique(np.rint(values)) if name == "grouser_count" else values

    def _draw_sweep(self, figure, design, scenario, result):
        first, second, metric = self.sweep_first.value, self.sweep_second.value, self.sweep_metric.value
        names, rovers = self._published
        places = []
        for name in filter(None, (first, second)):
            places.append(np.asarray(getattr(rovers, name)) if name in DESIGN_SPACE else None)
        if not second or second == first:
            values = self._span(first)
            found = sweep(design, scenario, {first: values}, self.model).performance
            if first in DESIGN_SPACE:
                many = dataclasses.replace(design, **{first: values})
                span = intervals(many, scenario, draws=60, model=self.model)
                low, high = span.low[metric], span.high[metric]
            else:                                        # a mission's field: an interval at each of its values
                spans = [intervals(design, dataclasses.replace(scenario, **{first: v}), draws=60, model=self.model)
                         for v in values]
                low, high = ([getattr(s, end)[metric] for s in spans] for end in ("low", "high"))
            others = None
            if places[0] is not None:
                others = (places[0], np.asarray(getattr(evaluate(rovers, scenario, self.model), metric), float), names)
            return pictures.curve(figure, first, metric, values, np.asarray(getattr(found, metric), float), low, high,
                                  (self.controls[first].box.value, float(getattr(result, metric))), others)
        values = self._span(first), self._span(second)
        found = sweep(design, scenario, dict(zip((first, second), values)), self.model).performance
        grid = np.nan_to_num(np.asarray(getattr(found, metric), float))
        here = self.controls[first].box.value, self.controls[second].box.value
        others = (*places, names) if all(p is not None for p in places) else None
        return pictures.contour(figure, (first, second), metric, values, grid, here, others)

    # ---- optimiser --------------------------------------------------------------------------------------------

    def _problem(self):
        """Objectives and constraints that the controls ask for."""
        objectives = {name: menu.value for name, menu in self.objectives.items() if menu.value != "ignore"}
        constraints = [("range_km", ">=", self.minimum_range.value), ("total_mass_kg", "<=", self.maximum_mass.value)]
        if self.minimum_slope.value > 0:
            constraints.append(("slope_capability_deg", ">=", self.minimum_slope.value))
        return objectives, constraints

    def optimise(self, wait=False):
        """Search in the background; with `wait`, return when the search has ended."""
        if self._thread is not None and self._thread.is_alive():
            return
        self._stop.clear()
        self.run.disabled, self.cancel.disabled = True, False
        self._thread = threading.Thread(target=self._search, daemon=True)
        self._thread.start()
        if wait:
            self._thread.join()
            self.settle()

    def _search(self):
        """The search's thread: progress, a growing front, cancel."""
        drawn = time.monotonic()
        self.progress.max, self.progress.value = self.generations.value, 0

        def follow(progress):
            nonlocal drawn
            self.progress.value = progress.generation
            self.status.value = f'<div role="status">generation {progress.generation} of {progress.generations}</div>'
            if time.monotonic() - drawn > 0.4:
                self.front = progress.front()
                drawn = time.monotonic()
                self._changed()
            return self._stop.is_set()

        try:
            objectives, constraints = self._problem()
            scenario = dataclasses.replace(self.scenario, study=Study())     # the range limit that the slider shows
            size = self.population.value, self.generations.value, self.seed.value
            front = pareto_front(scenario, *size, objectives, constraints, self.model, on_generation=follow)
            self._call = (f"rdk.pareto_front(\n    mission, {size[0]}, {size[1]}, seed={size[2]}, objectives={objectives!r},"
                          f"\n    constraints={constraints!r})")
            done = front.message or f"done: {len(front)} designs after {self.generations.value} generations"
        except Exception as error:
            front, done = None, f"{type(error).__name__}: {error}"
        self.front = front
        rows = [] if front is None else [
            (f"{i + 1}: {m:.1f} kg, {r:.2f} km, {s:.1f} deg", i) for i, (m, r, s) in enumerate(zip(
                front.performance.total_mass_kg, front.performance.range_km, front.performance.slope_capability_deg))]
        self._quiet += 1
        self.points.value = None
        self.points.options, self.points.value = rows, None
        self._quiet -= 1
        self.status.value = _message(done, "status")
        self.run.disabled, self.cancel.disabled = False, True
        self._changed()

    def _on_point(self, change):
        """A point of the front becomes the point design."""
        if not self._quiet and change.new is not None and self.front is not None:
            self._quiet += 1
            self.rover.value = "a design"
            self._quiet -= 1
            self._put(self.front.designs[change.new])

    def _draw_front(self, figure, front, result, title=""):
        if front is None:
            return _message("No front yet: press Run.", "status")
        p = front.performance
        return pictures.html(figure, pictures.front(
            figure, p.total_mass_kg, p.range_km, ("total_mass_kg", "range_km"),
            picked=self.points.value if front is self.front else None, here=(result.total_mass_kg, result.range_km),
            size=p.slope_capability_deg, title=title or "larger points climb steeper slopes"))

    def _draw_live(self, figure, scenario, result):
        """A small front for the mission as it stands, warm-started from the last one."""
        begun = time.monotonic()
        key = repr(scenario)
        if self._fronts.get("key") != key:
            self._fronts["front"] = live_front(scenario, self._fronts.get("front"), self.model)
            self._fronts["key"] = key
        front = self._fronts["front"]
        self.live_status.value = _message(
            front.message or f"{len(front)} designs for this mission; change latitude, slope, soil or payload under "
                             "'mission' and the front follows.", "status")
        self._fronts["seconds"] = time.monotonic() - begun
        return self._draw_front(figure, front, result, "live front; larger points climb steeper slopes")

    # ---- files ------------------------------------------------------------------------------------------------

    def _show_files(self, design, scenario, result):
        files = {"design.json": keep.to_json(design, scenario), "design.csv": keep.to_csv(design, result)}
        if self.front is not None and len(self.front):
            files |= {"front.json": keep.to_json(self.front.designs, scenario),
                      "front.csv": keep.to_csv(self.front.designs, self.front.performance)}
        self.links.value = "Download: " + ", ".join(
            f'<a download="{name}" href="data:text/plain;base64,{base64.b64encode(text.encode()).decode()}">{name}</a>'
            for name, text in files.items())
        self.code.value = explain.as_python(design, scenario, self._call)

    def _on_upload(self, change):
        if change.new:
            file = change.new[0]
            self.load(file["name"], bytes(file["content"]))

    def load(self, name, content):
        """Show a design, or a front, from a file's name and bytes; the message says what was wrong with it."""
        try:
            text = bytes(content).decode("utf-8-sig")
            design, mission = (keep.from_csv(text), None) if name.lower().endswith(".csv") else keep.from_json(text)
        except (ValueError, UnicodeDecodeError) as error:
            self.message.value = _message(f"{name} was not loaded: {error}")
            return
        words = "design"
        if design.shape:
            performance = evaluate(design, mission or self.scenario, self.model)
            from .tradespace import Front
            self.front = Front(design, performance, mission or self.scenario, self.model, Study())
            self._quiet += 1
            self.points.value = None
            self.points.options = [(f"{i + 1}: {m:.1f} kg, {r:.2f} km", i) for i, (m, r) in enumerate(zip(
                performance.total_mass_kg, performance.range_km))]
            self.points.value = None
            self._quiet -= 1
            words, design = f"front of {len(design)} designs; the first is shown", design[0]
        self.message.value = _message(f"{name} loaded: {words}", "status")
        self._quiet += 1
        self.rover.value = "a design"
        self._quiet -= 1
        self._put(design, mission)


def live_front(scenario, start=None, model=Model(), population=40, generations=24):
    """A front quick enough to follow a slider: a small population, warm-started from the last front.

    Parameters
    ----------
    scenario : Scenario
    start : Front, optional
    model : Model
    population, generations : int

    Returns
    -------
    Front
    """
    import warnings
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)     # an empty front carries its message
        return pareto_front(dataclasses.replace(scenario, study=Study()), population,
                            generations if start is None else generations // 2, seed=1, start=start, model=model)


def _message(text, role="alert"):
    return f'<div role="{role}">{html_module.escape(text)}</div>'
