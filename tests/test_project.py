"""What surrounds the code: the README's commands, the pins, the citation; no file knows one machine."""

import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
import yaml
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

REPO = Path(__file__).parents[1]
README = (REPO / "README.md").read_text(encoding="utf-8")
PROJECT = tomllib.loads((REPO / "pyproject.toml").read_text(encoding="utf-8"))["project"]


def blocks(language):
    return re.findall(rf"```{language}\n(.*?)\n```", README, re.DOTALL)


def test_readme_gives_each_command_for_both_kinds_of_machine():
    unix, windows = blocks("bash"), blocks("powershell")
    translated = [command.replace("py -3", "python3").replace("; ", " && ").replace("\\", "/")
                  .replace(".venv/Scripts/", ".venv/bin/") for command in windows]
    assert translated == unix[:2] and len(unix) == 3
    # root may run it, and where no browser opens, the address is the last thing printed
    assert "-m jupyterlab --allow-root --log-level=ERROR --ServerApp.root_dir=." in unix[0]
    assert unix[0].endswith("default_url=/lab/tree/notebooks/00_start_here.ipynb")
    assert unix[1].endswith("-m pytest") and "--resolution lowest-direct" in unix[2]


def test_the_workflow_runs_the_readmes_test_command():
    steps = yaml.safe_load((REPO / ".github/workflows/test.yml").read_text(encoding="utf-8"))["jobs"]["test"]["steps"]
    assert [step["run"] for step in steps if "run" in step] == [blocks("bash")[1], blocks("powershell")[1]]


@pytest.mark.skipif(shutil.which("awk") is None, reason=".ci/run is for Debian")
def test_ci_runs_the_readmes_test_command():
    # what .ci/run cuts out of the README, cut out by the same awk program
    program = re.search(r"awk '(.*?)' README\.md", (REPO / ".ci/run").read_text(encoding="utf-8"), re.DOTALL)[1]
    cut = subprocess.check_output(["awk", program, REPO / "README.md"], text=True)
    assert cut == blocks("bash")[1] + "\n"


def test_the_linter_is_content():
    done = subprocess.run([sys.executable, "-m", "ruff", "check", "--no-cache", "--output-format=concise",
                           REPO], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout


def test_links_in_the_pages_resolve():
    for name in ("README.md", "data/README.md", "notebooks/README.md", "notebooks/glossary.md",
                 ".github/CONTRIBUTING.md"):
        page = REPO / name
        targets = re.findall(r"\]\(([^)\s#]+)\)", page.read_text(encoding="utf-8"))
        assert not [t for t in targets if not t.startswith("https:") and not (page.parent / t).exists()]


def test_requirements_pin_exact_versions_and_nothing_else():
    *pins, last = (REPO / "requirements.txt").read_text(encoding="utf-8").splitlines()
    assert last == "-e ."
    for line in pins:
        assert re.fullmatch(r"[a-z0-9-]+==[a-z0-9.]+( ; .+)?", line), line


def test_requirements_hold_every_dependency_within_its_bounds():
    *lines, _ = (REPO / "requirements.txt").read_text(encoding="utf-8").splitlines()
    pins = list(map(Requirement, lines))
    loose = sum(PROJECT["optional-dependencies"].values(), PROJECT["dependencies"])
    for wanted in map(Requirement, loose):
        name = canonicalize_name(wanted.name)
        versions = [next(iter(pin.specifier)).version for pin in pins if canonicalize_name(pin.name) == name]
        assert name == "rdk" or versions and all(map(wanted.specifier.contains, versions)), str(wanted)


def test_citation_names_the_paper_and_the_original_release():
    citation = yaml.safe_load((REPO / "CITATION.cff").read_text(encoding="utf-8"))
    assert {"cff-version", "message", "title", "authors"} <= set(citation)
    assert citation["version"] == PROJECT["version"] and citation["license"] == "MIT"
    paper, release = citation["preferred-citation"], citation["references"][0]
    assert [author["family-names"] for author in paper["authors"]] == ["Reifschneider"]
    bibliography = (REPO / "data/references.bib").read_text(encoding="utf-8")
    assert f"{{{paper['url']}}}" in bibliography and f"{{{release['doi']}}}" in bibliography


def test_no_committed_file_names_a_machine_or_a_registry():
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=REPO, capture_output=True, text=True)
    if listed.returncode:
        pytest.skip("not a git clone")
    home = r"(?<![\w.])/(work|root|tmp|home|Users)/"  # an absolute path: not a part of an address
    registry = r"index.url\s*[=:]|find.links\s*[=:]|://\S*/simple[/]"
    for name in filter(None, listed.stdout.split("\0")):
        path = REPO / name
        if path.is_file():
            text = path.read_bytes().decode("utf-8", errors="ignore")
            found = re.search(f"{home}|{registry}", text)
            assert not found, (name, text[max(found.start() - 40, 0):found.end() + 40])
