"""The explorer's controls: number boxes with sliders, menus, their arrangement, and a worker for the newest state."""
from __future__ import annotations

import html
import threading

import ipywidgets as W

from .. import catalog
from . import pictures
from ..design import DESIGN_SPACE, Variable

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
METRICS = ("range_km", "total_mass_kg", "slope_capability_deg", "energy_balance_pct", "cruise_speed_m_s", "slip",
           "sinkage_m", "wheel_torque_nm", "final_soc", "average_solar_power_w", "obstacle_capability_m")
VIEWS = ("log", "mass", "stress", "rovers", "why", "sweep", "optimise", "live front", "keep")
PAGES = ("rover", "mission", "search")
SCRIPTS = ("the read-outs", "why", "the sweep", "the front")
OWN, START = "your own", "the design at the start"
GOALS = {"range_km": "range_goal", "total_mass_kg": "mass_goal", "slope_capability_deg": "slope_goal"}
LABEL, BOX, SLIDER = 156, 230, 98                        # pixels: a label, the box with it, the slider beside it
FULL = BOX + SLIDER + 8
STYLE = """<style>
.rdk-explorer .widget-toggle-button {width: auto; padding: 0 6px; margin: 1px}
.rdk-explorer .widget-toggle-button.mod-active {font-weight: bold; box-shadow: inset 0 -3px #0072B2}
.rdk-explorer button:focus-visible, .rdk-explorer input:focus-visible, .rdk-explorer select:focus-visible,
.rdk-explorer textarea:focus-visible, .rdk-explorer .noUi-handle:focus-visible {outline: 2px solid #D55E00}
.rdk-explorer .widget-html-content {line-height: 1.3; min-width: 0}
.rdk-readout {border-collapse: collapse; font-size: 12.5px; line-height: 17px}
.rdk-readout th {text-align: left; font-weight: normal; padding: 0 9px 0 0; white-space: nowrap}
.rdk-readout td {padding: 0 9px 0 0; white-space: nowrap; font-variant-numeric: tabular-nums}
.rdk-readout td:last-child {padding: 0; white-space: normal}
.rdk-picture {max-width: 100%; height: auto}
.rdk-waiting {opacity: 0.4}
.rdk-readout thead th {border-bottom: 1px solid #767676}
.rdk-explorer a {color: #0055AA; text-decoration: underline}
.rdk-explorer [role=alert] {border-left: 4px solid #D55E00; padding-left: 6px}
</style>"""
# JupyterLab takes keys that are pressed in a menu for its own: arrows move from cell to cell, "y" changes a cell's kind.
# It leaves elements alone that carry this attribute, so that each gets it with the focus.
KEYS = ("<img hidden alt='' src='data:,' onerror=\"this.closest('.rdk-explorer').addEventListener('focusin', "
        "event => event.target.dataset.lmSuppressShortcuts = 'true'); this.remove()\">")


class Refresher:
    """Runs `work` in a thread whenever it is poked; pokes during a run lead to one more run.

    Callbacks may come from any thread: only this one computes and writes to the screen.

    Attributes
    ----------
    error : Exception or None
        What the last run raised.
    """

    def __init__(self, work):
        self._work, self._state = work, threading.Condition()
        self._wanted = self._done = 0
        self._running, self.error = False, None

    def poke(self):
        """Ask for a run with the state as it is now."""
        with self._state:
            self._wanted += 1
            if not self._running:
                self._running = True
                threading.Thread(target=self._loop).start()      # no daemon: one in compiled code at exit aborts

    def _loop(self):
        while True:
            with self._state:
                target = self._wanted
                if target == self._done:
                    self._running = False
                    self._state.notify_all()
                    return
            try:
                self._work()
                self.error = None
            except Exception as error:                   # whatever it is, the next poke must find a worker
                self.error = error
            with self._state:
                self._done = target

    def settle(self, timeout_s=60):
        """Wait until nothing is left to do.

        Raises
        ------
        TimeoutError
            If that takes longer than `timeout_s`.
        Exception
            What the last run raised.
        """
        with self._state:
            if not self._state.wait_for(lambda: not self._running, timeout_s):
                raise TimeoutError(f"the explorer did not settle within {timeout_s} s")
        if self.error is not None:
            raise self.error


class Number:
    """A number box with its label and unit, and a slider that follows it.

    The box holds the value. A browser snaps a slider to its steps and reports that back, so a slider's value counts
    only where it differs from the box by more than half a step: then a person has moved it.
    """

    def __init__(self, variable, step, lock):
        whole = variable.kind == "whole"
        text = variable.label + (f" ({variable.unit})" if variable.unit != "1" else "")
        self.box = number(text, int(variable.low) if whole else float(variable.low), variable.low, variable.high, step)
        self.slider = (W.IntSlider if whole else W.FloatSlider)(
            value=self.box.value, min=variable.low, max=variable.high, step=step, readout=False, tooltip=text,
            layout=W.Layout(width=f"{SLIDER}px"))
        self.row, self._lock = W.HBox([self.box, self.slider]), lock
        self.box.observe(self._to_slider, "value")
        self.slider.observe(self._to_box, "value")

    def _apart(self, steps):
        return abs(self.slider.value - self.box.value) > steps * self.slider.step

    def _to_slider(self, change):
        with self._lock:
            if self._apart(1e-6):
                self.slider.value = self.box.value

    def _to_box(self, change):
        with self._lock:
            if self._apart(0.5 + 1e-6):
                self.box.value = round(self.slider.value, 9)


class Controls:
    """All widgets of an explorer and how they are arranged; what they do is the explorer's business.

    Attributes
    ----------
    inputs : dict of str to widget
        Every number box and menu by name.
    widget : VBox
        The whole.
    """

    def __init__(self, soils, lock):
        self._numbers = {name: Number(variable, STEPS[name], lock)
                         for name, variable in (DESIGN_SPACE | MISSION_SPACE).items() if name != "wheel_count"}
        fields = [(variable.label, name) for name, variable in (DESIGN_SPACE | MISSION_SPACE).items()
                  if name not in ("wheel_count", "duration_earth_days")]
        metrics = [(pictures.label(name).split(" (")[0], name) for name in METRICS]
        small = dict(width=186, label=58)
        goals = ["max", "min", "ignore"]
        self.points = W.Select(description="points", rows=7, style={"description_width": "50px"},
                               layout=W.Layout(width=f"{FULL}px"))
        self.points.add_class("rdk-points")
        self.inputs = {name: one.box for name, one in self._numbers.items()} | {
            "wheel_count": menu("wheels", [("4, rigid", 4), ("6, rocker-bogie", 6)]),
            "rover": menu("start from", [*catalog.rover_names(), OWN]),
            "mission": menu("mission", [*catalog.scenario_names(), OWN]),
            "soil": menu("soil", list(soils)),
            "page": W.ToggleButtons(options=PAGES, style={"button_width": "auto"}),
            "view": W.ToggleButtons(options=VIEWS, style={"button_width": "auto"}),
            "baseline": menu("baseline", [START, *catalog.rover_names()], width=252, label=58),
            "why_metric": menu("metric", metrics, **small),
            "sweep_first": menu("along", fields, **small),
            "sweep_second": menu("and", [("nothing else", ""), *fields], **small),
            "sweep_metric": menu("metric", metrics, **small),
            "range_goal": menu("range", goals, width=BOX),
            "minimum_range_km": number("range at least (km)", 0.1, 0, 1000, 0.1),
            "mass_goal": menu("total mass", goals, width=BOX),
            "maximum_mass_kg": number("mass at most (kg)", 1000.0, 1, 1000, 1),
            "slope_goal": menu("slope capability", goals, width=BOX),
            "minimum_slope_deg": number("slope at least (deg)", 0.0, 0, 35, 1),
            "population": number("population", 50, 4, 400),
            "generations": number("generations", 60, 1, 1000),
            "seed": number("seed", 13, 0, 10**6),
            "script": menu("Python for", SCRIPTS, width=236, label=74),
            "point": self.points}
        self.run, self.cancel = W.Button(description="Run"), W.Button(description="Cancel", disabled=True)
        self.progress, self.status = W.IntProgress(layout=W.Layout(width=f"{FULL - 8}px")), W.HTML()
        self.readout, self.notice, self.picture, self.links = W.HTML(), W.HTML(), W.HTML(), W.HTML()
        self.code = W.Textarea(description="as Python", style={"description_width": "74px"},
                               layout=W.Layout(width="auto", height="230px"))
        self.upload = W.FileUpload(accept=".json,.csv", description="Load a file", layout=W.Layout(width="auto"))
        self.widget = self._arrange()
        self.widget.add_class("rdk-explorer")

    def _arrange(self):
        """The inputs in pages on the left, the answers on the right."""
        rows = {name: one.row for name, one in self._numbers.items()}
        rows = {name: rows.get(name, widget) for name, widget in self.inputs.items()}
        named = "range_goal minimum_range_km mass_goal maximum_mass_kg slope_goal minimum_slope_deg population generations seed"
        self.pages = {
            "rover": W.VBox([rows["rover"], *(rows[n] for n in DESIGN_SPACE)]),
            "mission": W.VBox([rows["mission"], rows["soil"], *(rows[n] for n in MISSION_SPACE)]),
            "search": W.VBox([*(rows[n] for n in named.split()), W.HBox([self.run, self.cancel]), self.progress,
                              self.status, self.points])}
        self.panels = {
            "why": W.HBox([rows["baseline"], rows["why_metric"]], layout=_wrap()),
            "sweep": W.HBox([rows["sweep_first"], rows["sweep_second"], rows["sweep_metric"]], layout=_wrap()),
            "keep": W.VBox([self.links, self.upload, rows["script"], self.code])}
        left = W.VBox([rows["page"], *self.pages.values()], layout=W.Layout(flex=f"0 0 {FULL + 8}px"))
        right = W.VBox([self.readout, self.notice, rows["view"], *self.panels.values(), self.picture],
                       layout=W.Layout(flex="1 1 480px", min_width="0"))
        show(self.pages, "rover")
        return W.VBox([W.HTML(STYLE + KEYS), W.HBox([left, right], layout=_wrap())])


def _wrap():
    return W.Layout(flex_flow="row wrap")                # one each: shared, hiding one box would hide them all


def menu(text, options, width=FULL, label=LABEL):
    """A dropdown with its label."""
    return W.Dropdown(description=text, options=options, style={"description_width": f"{label}px"},
                      layout=W.Layout(width=f"{width}px"))


def number(text, value, low, high, step=1):
    """A number box with its label; for whole numbers where the value is one."""
    box = W.BoundedIntText if isinstance(value, int) else W.BoundedFloatText
    return box(description=text, value=value, min=low, max=high, step=step,
               style={"description_width": f"{LABEL}px"}, layout=W.Layout(width=f"{BOX}px"))


def message(text, role="alert"):
    """A text that a screen reader announces."""
    return f'<div role="{role}">{html.escape(text)}</div>' if text else ""


def show(boxes, name):
    """Show one of several boxes."""
    for key, box in boxes.items():
        box.layout.display = None if key == name else "none"
