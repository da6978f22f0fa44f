"""A built wheel is complete: installed elsewhere, it evaluates a rover without the clone."""

import os
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
from folders import writable_copy

REPO = Path(__file__).parents[1]


def run(*command, **options):
    done = subprocess.run([sys.executable, *map(str, command)], capture_output=True, text=True, **options)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    """A wheel built from a copy of the sources, so that the clone may be read-only."""
    folder = tmp_path_factory.mktemp("sources")
    for name in ("rdk", "data"):
        writable_copy(REPO / name, folder / name)
    for name in ("pyproject.toml", "README.md", "LICENSE"):
        shutil.copy(REPO / name, folder)
    run("-m", "pip", "wheel", "--quiet", "--no-deps", "--no-build-isolation", "--wheel-dir", folder / "out", folder)
    (found,) = (folder / "out").glob("rdk-*.whl")
    return found


def test_the_wheel_holds_all_modules_all_tables_and_nothing_else(wheel):
    held = {name for name in zipfile.ZipFile(wheel).namelist() if ".dist-info/" not in name}
    modules = {path.relative_to(REPO).as_posix() for kind in ("py", "css", "js")
               for path in (REPO / "rdk").rglob(f"*.{kind}")}
    tables = {f"rdk/data/{path.name}" for path in (REPO / "data").iterdir()}
    assert held == modules | tables | {"rdk/py.typed"}


def test_the_installed_wheel_evaluates_a_rover_outside_the_clone(wheel, tmp_path):
    run("-m", "pip", "install", "--quiet", "--no-deps", "--target", tmp_path / "site", wheel)
    code = """
import rdk
result = rdk.evaluate(rdk.rover("Rashid-1"), rdk.scenario("equatorial_mare_traverse"))
print(rdk.__file__, f"{result.total_mass_kg:.3f}", rdk.__version__)"""
    said = run("-c", code, cwd=tmp_path, env={**os.environ, "PYTHONPATH": str(tmp_path / "site")}).split()
    assert Path(said[0]) == tmp_path / "site/rdk/__init__.py"
    # 16.380 kg is the mass that the README's example rounds to 16.4; the version is pyproject's
    assert abs(float(said[1]) - 16.4) < 0.05
    assert f'version = "{said[2]}"' in (REPO / "pyproject.toml").read_text(encoding="utf-8")
