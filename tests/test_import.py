"""`import rdk` is light: what draws, optimises or reads tables loads when it is first used."""

import subprocess
import sys
import tomllib
from pathlib import Path

import rdk

HEAVY = ("pymoo", "matplotlib", "ipywidgets", "IPython", "pandas", "scipy.optimize", "scipy.stats", "pvlib")


def fresh(code):
    """Standard output of a fresh interpreter."""
    run = subprocess.run([sys.executable, "-W", "error", "-c", code], capture_output=True, text=True,
                         timeout=120)
    assert run.returncode == 0, run.stderr
    assert run.stderr == ""
    return run.stdout


def loaded_after(code):
    return fresh(f"import sys\n{code}\nprint([name for name in {HEAVY!r} if name in sys.modules])").strip()


def test_import_is_light():
    assert loaded_after("import rdk") == "[]"


def test_evaluation_is_light_too():
    assert loaded_after("""
import rdk
result = rdk.evaluate(rdk.rover("Rashid-1"), rdk.scenario("polar_prospecting"))
assert result.total_mass_kg > 0""") == "[]"


def test_random_designs_need_no_optimiser():
    assert "pymoo" not in loaded_after("""
import rdk
rdk.evaluate(rdk.random_designs(50, seed=1), rdk.scenario("highland_slope_capability"))""")


def test_every_public_name_loads_and_an_unknown_one_is_refused():
    assert fresh("""
import rdk
missing = [name for name in rdk.__all__ if not hasattr(rdk, name)]
try:
    rdk.no_such_thing
except AttributeError as error:
    print(missing, error)""").strip().startswith("[] module 'rdk' has no attribute 'no_such_thing'; ")


def test_completion_and_the_nearest_name():
    assert fresh("""
import rdk, types
assert set(rdk.__all__) < set(dir(rdk)) and "_LAZY" not in dir(rdk) and len(set(rdk.__all__)) == len(rdk.__all__)
import rdk.explorer, rdk.report
assert isinstance(rdk.explorer, types.ModuleType) and isinstance(rdk.report, types.ModuleType)
assert callable(rdk.Explorer) and callable(rdk.write_report) and rdk.Front.__name__ == "Front"
try:
    rdk.pareto_frnt
except AttributeError as error:
    print(error)""").strip().startswith("module 'rdk' has no attribute 'pareto_frnt'; nearest are pareto_front")


def test_the_version_is_that_of_the_project():
    project = tomllib.loads((Path(__file__).parents[1] / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert rdk.__version__ == project["version"]


def test_physics_modules_know_nothing_of_designs_missions_or_files():
    for module in "terramechanics", "mass", "power", "thermal", "sky":
        found = fresh(f"""
import importlib.util, sys, types
spec = importlib.util.find_spec("rdk")
package = types.ModuleType("rdk")
package.__path__ = spec.submodule_search_locations
sys.modules["rdk"] = package                             # the package without its __init__
import rdk.{module}
print(sorted(name for name in sys.modules if name.startswith("rdk.")))""")
        private = {f"rdk.{name}" for name in ("_fields", "_contact", "_arc", "_roots")}
        above = private | ({"rdk.power"} if module == "sky" else set())
        assert set(eval(found)) <= {f"rdk.{module}"} | above, module
