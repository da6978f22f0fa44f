"""binder/ checked without Docker: repo2docker picks a build pack and writes a Dockerfile, no more."""

import os
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import nbformat
import pytest
from nbformat.sign import NotebookNotary
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

REPO = Path(__file__).parents[1]
BINDER = REPO / "binder"
PINS = [line for line in (BINDER / "requirements.txt").read_text().splitlines() if line != "-e ."]

on_unix = pytest.mark.skipif(sys.platform == "win32", reason="repo2docker runs on Unix only")


@pytest.fixture
def build_pack(monkeypatch):
    from repo2docker.app import Repo2Docker

    monkeypatch.chdir(REPO)  # build packs look at the current directory
    app = Repo2Docker()
    found = next(pack for pack in (kind(app.base_image) for kind in app.buildpacks) if pack.detect())
    found.platform = "linux/amd64"
    return found


@on_unix
def test_python_build_pack_is_picked_with_our_python(build_pack):
    assert type(build_pack).__name__ == "PythonBuildPack"
    assert build_pack.binder_dir == "binder"
    assert build_pack.python_version == "3.11"
    assert (BINDER / "runtime.txt").read_text() == "python-3.11\n"


@on_unix
def test_dockerfile_installs_our_pins_after_the_sources(build_pack):
    text = build_pack.render(build_args={})
    sources = re.search(r"COPY --chown=\S+ src/ ", text).start()
    pins = text.index('pip install --no-cache-dir -r "binder/requirements.txt"')
    # "-e ." needs the sources, and postBuild needs the installed package
    assert sources < pins < text.index("RUN ./binder/postBuild")


@on_unix
def test_post_build_runs(tmp_path):
    script = BINDER / "postBuild"
    assert os.access(script, os.X_OK) and b"\r" not in script.read_bytes()
    path = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
    subprocess.run([script], cwd=REPO, env={**os.environ, "PATH": path, "JUPYTER_DATA_DIR": str(tmp_path)}, check=True)
    notary = NotebookNotary(data_dir=str(tmp_path))
    for notebook in (REPO / "notebooks").glob("*.ipynb"):
        assert notary.check_signature(nbformat.read(notebook, as_version=4)), notebook.name


def test_every_run_time_dependency_is_pinned_within_its_bounds():
    pinned = {canonicalize_name(r.name): r for r in map(Requirement, PINS)}
    for dependency in tomllib.loads((REPO / "pyproject.toml").read_text())["project"]["dependencies"]:
        wanted = Requirement(dependency)
        (pin,) = pinned[canonicalize_name(wanted.name)].specifier
        assert pin.operator == "==" and wanted.specifier.contains(pin.version), dependency


def test_what_the_image_brings_is_left_out():
    names = {canonicalize_name(Requirement(pin).name) for pin in PINS}
    assert not names & {"jupyterlab", "notebook", "jupyter-server", "nbval", "pytest", "playwright"}
    assert "voila" in names  # the app's badge opens it
    assert (BINDER / "requirements.txt").read_text().splitlines()[-1] == "-e ."


def test_pins_exist_and_agree_for_python_3_11(tmp_path):
    listed = tmp_path / "pins.txt"  # without "-e .", which pip refuses for another Python
    listed.write_text("\n".join(PINS))
    command = "install --dry-run --ignore-installed --quiet --only-binary=:all: --python-version=3.11".split()
    done = subprocess.run([sys.executable, "-m", "pip", *command, "--target", tmp_path / "t", "-r", listed],
                          capture_output=True, text=True)
    if "CI" not in os.environ and re.search("ConnectionError|Connection broken|timed out", done.stderr):
        pytest.skip("no package index can be reached")
    assert done.returncode == 0, done.stderr[-2000:]
