"""rdk: conceptual design of lunar micro-rovers under 50 kg, the engine behind the notebooks.

>>> import rdk
>>> result = rdk.evaluate(rdk.rover("Rashid-1"), rdk.scenario("equatorial_mare_traverse"))
>>> result.feasible
True
"""
from . import mass, power, sky, terramechanics, thermal
from .catalog import rover, rover_names, scenario, scenario_names, skyline, skyline_sites, soil, soil_names
from .design import DESIGN_SPACE, Design, Model, Scenario
from .mission import Performance, evaluate
from .terramechanics import Soil, Wheel

_LAZY = {"random_designs": "sampling", "sweep": "sampling", "pareto_front": "tradespace",
         "intervals": "sampling", "attribution": "sampling", "fronts": "studies",
         "Explorer": "explorer", "write_report": "report",
         "report": None, "tradespace": None, "validation": None, "figures": None, "explorer": None,
         "route": None, "terrain": None}

__all__ = ["DESIGN_SPACE", "Design", "Model", "Performance", "Scenario", "Soil", "Wheel", "evaluate", "mass", "power",
           "rover", "rover_names", "scenario", "scenario_names", "sky", "skyline", "skyline_sites", "soil",
           "soil_names", "terramechanics", "thermal",
           *_LAZY]


def __getattr__(name):
    """Load what needs pymoo, matplotlib or ipywidgets when it is first asked for."""
    if name not in _LAZY:
        raise AttributeError(f"module 'rdk' has no attribute {name!r}")
    from importlib import import_module
    module = import_module("." + (_LAZY[name] or name), __name__)
    return getattr(module, name) if _LAZY[name] else module
