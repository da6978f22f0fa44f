"""rdk: conceptual design of lunar micro-rovers under 50 kg, the engine behind the notebooks.

>>> import rdk
>>> result = rdk.evaluate(rdk.rover("Rashid-1"), rdk.scenario("equatorial_mare_traverse"))
>>> result.feasible
True
"""
from . import catalog, mass, power, sky, terramechanics, thermal
from ._fields import unknown as _unknown
from .catalog import rover, rover_names, scenario, scenario_names, skyline, skyline_sites, soil, soil_names
from .design import DESIGN_SPACE, Design, Model, Problem, Scenario
from .mission import Performance, evaluate
from .terramechanics import Soil, Wheel

__version__ = "0.1.0"

_LAZY = {name: module for module, names in {
    "sampling": ("random_designs", "sweep", "Sweep", "intervals", "Intervals", "attribution", "Attribution"),
    "tradespace": ("pareto_front", "Front"), "explorer": ("Explorer",),
    "report": ("write_report",), "sizing": ("size", "Sizing", "prudent_demands"),
    None: ("explain", "explorer", "figures", "report", "route", "sampling",
           "sizing", "stability", "terrain", "tradespace")}.items() for name in names}

__all__ = [
    "DESIGN_SPACE", "Design", "Model", "Performance", "Problem", "Scenario", "Soil", "Wheel", "catalog", "evaluate",
    "mass", "power", "rover", "rover_names", "scenario", "scenario_names", "sky", "skyline", "skyline_sites", "soil",
    "soil_names", "terramechanics", "thermal", *_LAZY]


def __dir__():
    """What tab completion offers: the lazy names too."""
    return sorted([*__all__, *(name for name in globals() if name.startswith("__"))])


def __getattr__(name):
    """Load what needs pymoo, matplotlib or ipywidgets when it is first asked for."""
    if name not in _LAZY:
        raise AttributeError(str(_unknown("module 'rdk' has no attribute", name, sorted(__all__))))
    from importlib import import_module
    module = import_module("." + (_LAZY[name] or name), __name__)
    return getattr(module, name) if _LAZY[name] else module
