""".github/CONTRIBUTING.md followed to the letter, on a copy of the engine and its data."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from folders import writable_copy

REPO = Path(__file__).parents[1]
TEXT = (REPO / ".github/CONTRIBUTING.md").read_text(encoding="utf-8")
ROWS = re.findall(r"^```csv (data/\w+\.csv)\n(.*?)^```$", TEXT, re.M | re.S)


@pytest.fixture(scope="module")
def copy(tmp_path_factory):
    """A copy of rdk and data, with every example row appended, as the recipes say."""
    folder = tmp_path_factory.mktemp("copy")
    for name in "rdk", "data":
        writable_copy(REPO / name, folder / name)
    for path, lines in ROWS:
        with (folder / path).open("a", encoding="utf-8", newline="\n") as file:
            file.write(lines)
    page = folder / "data/README.md"                     # "add the name to the allowed words of `experiment`"
    words = page.read_text(encoding="utf-8")
    assert words.count("wang-han-2016 |") == 1
    page.write_text(words.replace("wang-han-2016 |", "wang-han-2016; example-2026 |"), encoding="utf-8",
                    newline="\n")
    tests = (REPO / "tests/test_data.py").read_text(encoding="utf-8")
    for path, lines in ROWS:                             # "raise the number of rows in `ROWS`"
        name, more = path.removeprefix("data/"), lines.count("\n")
        tests, changed = re.subn(rf'("{name}": )(\d+)', lambda m: f"{m[1]}{int(m[2]) + more}", tests)
        assert changed == 1
    (folder / "tests").mkdir()
    (folder / "tests/test_data.py").write_text(tests, encoding="utf-8", newline="\n")
    return folder


def run(folder, *arguments):
    """Python in the copy, on the copy's rdk and the modules beside the notebooks."""
    environment = {**os.environ, "PYTHONPATH": f"{folder}{os.pathsep}{REPO / 'notebooks'}",
                   "PYTHONDONTWRITEBYTECODE": "1"}
    return subprocess.run([sys.executable, *arguments], cwd=folder, env=environment, capture_output=True,
                          text=True)


def test_there_is_a_recipe_for_each():
    heads = re.findall(r"^## Add a (\w+)$", TEXT, re.M)
    assert heads == ["soil", "rover", "measurement", "scenario", "notebook"]
    assert [path for path, _ in ROWS] == ["data/soils.csv", "data/rovers.csv", "data/single_wheel.csv",
                                          "data/scenarios.csv"]


def test_the_rows_of_the_recipes_pass_the_tests_of_the_data(copy):
    done = run(copy, "-m", "pytest", "-q", "-p", "no:cacheprovider", "tests/test_data.py")
    assert done.returncode == 0, done.stdout[-3000:]


def test_new_rows_leave_the_papers_numbers_alone(copy):
    code = """
import rdk, validation
paper = ["ding-2011", "hurrell-2025", "wang-han-2016"]
print(validation.single_wheel_summary().query("experiment in @paper").to_json())
print(validation.published_masses_summary().to_json(), validation.flown_rovers().to_json())
print([rdk.scenario(name) for name in rdk.scenario_names("canonical")])"""
    ours, theirs = (run(folder, "-c", code) for folder in (copy, REPO))
    assert ours.returncode == theirs.returncode == 0, ours.stderr + theirs.stderr
    assert ours.stdout == theirs.stdout and "ding-2011" in ours.stdout


def test_a_row_that_breaks_a_rule_does_not(copy, tmp_path):
    # the test above must be able to fail: a number that no list claims
    broken = tmp_path / "copy"
    shutil.copytree(copy, broken)
    path = broken / "data/soils.csv"
    path.write_text(path.read_text(encoding="utf-8").replace("density_kg_m3,,shear_modulus_mm,he2013",
                                                             ",,shear_modulus_mm,he2013"),
                    encoding="utf-8", newline="\n")
    assert run(broken, "-m", "pytest", "-q", "-p", "no:cacheprovider", "tests/test_data.py").returncode == 1


def test_the_python_of_the_recipes_says_what_stands_there(copy):
    page = copy / "recipes.md"
    page.write_text(TEXT, encoding="utf-8")
    code = "import doctest, rdk; assert rdk.__file__.startswith({!r}); print(doctest.testfile({!r}, False))"
    done = run(copy, "-c", code.format(str(copy), str(page)))
    tried = TEXT.count(">>> ")
    assert done.stdout.strip() == f"TestResults(failed=0, attempted={tried})", done.stdout + done.stderr
    assert tried >= 5


def test_the_committed_data_hold_no_example():
    for path, lines in ROWS:
        committed = (REPO / path).read_text(encoding="utf-8")
        assert not [line for line in lines.splitlines() if line in committed]


def test_named_files_and_links_exist():
    for name in re.findall(r"`((?:rdk|data|tests|notebooks)/[\w./]+)`", TEXT) + [
            name for name in re.findall(r"\]\(([^)#]+)\)", TEXT) if not name.startswith("https:")]:
        assert (REPO / name).exists() or (REPO / ".github" / name).exists(), name
