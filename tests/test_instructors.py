"""The instructors' tools: handouts without solutions, examinations with variants, marks of damaged submissions."""

import csv
import json
import random
import re
import stat
import subprocess
import sys
from pathlib import Path

import nbformat
import numpy as np
import pytest

from exercises import instructors
from exercises.__main__ import main
from exercises.exam import QUESTIONS

REPO = Path(__file__).parents[1]
SEED = "a seed for the tests"
NAMES = ("student-1", "student-2", "student-3")


@pytest.fixture
def names(tmp_path):
    path = tmp_path / "students.txt"
    path.write_text("\n".join(NAMES) + "\n", encoding="utf-8")
    return path


@pytest.fixture
def folder(tmp_path, names):
    main(["exam", "--students", str(names), "--seed", SEED, "--to", str(tmp_path / "exam")])
    return tmp_path / "exam"


def right(student, number):
    question = QUESTIONS[number]
    return np.asarray(question.answer(**question.variant(SEED, student, number))).tolist()


def hand_in(path, answers, cell="{name} = {value}"):
    """Put answers into a student's notebook, by question."""
    notebook = nbformat.read(path, as_version=4)
    for number, value in answers.items():
        name = "answer_" + number.replace(".", "_")
        (found,) = [c for c in notebook.cells if c.source == f"{name} = ..."]
        found.source = cell.format(name=name, value=value)
    nbformat.write(notebook, path)


def marks(folder, **options):
    return {(student, number): (points, message)
            for student, number, points, message in instructors.grade(folder, SEED, **options)}


# ---- questions -------------------------------------------------------------------------------------------------

def test_there_are_questions_on_each_of_the_notebooks_01_to_09():
    assert {number[:2] for number in QUESTIONS} == {f"0{i}" for i in range(1, 10)}


@pytest.mark.parametrize("number", QUESTIONS)
def test_every_variant_has_a_finite_answer_and_tells_its_mistakes_apart(number):
    question = QUESTIONS[number]
    for student in map(str, range(40)):
        given = question.variant(SEED, student, number)
        text = question.text.format(**given)
        assert all(str(value) in text for value in given.values()) and "{" not in text
        exercise = question.exercise(given)
        assert np.isfinite(exercise.expected).all() and np.ptp(np.ravel([0, *np.ravel(exercise.expected)])) > 0
        assert instructors.judge(exercise, np.asarray(exercise.expected).tolist())


@pytest.mark.parametrize("number", QUESTIONS)
def test_a_mistake_is_wrong_for_nearly_every_student_and_named(number):
    question, named = QUESTIONS[number], []
    for student in map(str, range(40)):
        exercise = question.exercise(question.variant(SEED, student, number))
        for words, mistake in exercise.mistakes.items():
            named.append(words in instructors.judge(exercise, np.asarray(mistake()).tolist()).message)
    assert np.mean(named) > 0.85                         # a mistake may cost less than 2 % once in a while


@pytest.mark.parametrize("number, given, answer", [
    ("01.b", dict(low_kpa=8.0, high_kpa=32.0, shallow_mm=10.0, deep_mm=40.0), 1.0),
    ("02.a", dict(load_n=50.0, measured_n=8.0, model_n=10.0), [25.0, 4.0]),
    ("03.a", dict(chassis_g=0.0, payload_g=500.0), 0.5),
    ("04.a", dict(load_w=3.23, hours=10.0), 40.0),       # 32.3 / 0.95 / 0.85
    ("05.b", dict(radius_mm=100.0, slip_pct=0.0, duty_pct=100.0, days=1.0), 43.2),
    ("06.a", dict(neither=10.0, first=20.0, second=16.0, both=30.0), [12.0, 8.0]),
    ("07.a", dict(a=9.0, b=5.0, c=2.0), 49.0),           # unit squares counted on paper
    ("08.a", dict(battery_wh=120.0), 0.4),
    ("09.a", dict(draws=900.0, p=90.0), 1.0)])
def test_answers_agree_with_a_pencil(number, given, answer):
    np.testing.assert_allclose(QUESTIONS[number].answer(**given), answer, rtol=1e-12)    # rounding


def test_the_hypervolume_agrees_with_darts():
    points = np.array([[1, 8.2], [3, 5.1], [6, 2.4]])
    darts = np.random.default_rng(0).uniform(0, 10, (200_000, 1, 2))
    share = (darts >= points).all(2).any(1).mean()
    np.testing.assert_allclose(QUESTIONS["07.a"].answer(8.2, 5.1, 2.4), 100 * share, rtol=0.01)  # four standard errors


def test_variants_differ_by_student_by_question_and_by_seed():
    for number, question in QUESTIONS.items():
        variants = [str(question.variant(SEED, student, number)) for student in NAMES]
        assert len(set(variants)) == 3, number
        assert question.variant("another", NAMES[0], number) != question.variant(SEED, NAMES[0], number)
        assert question.variant(SEED, NAMES[0], number) == question.variant(SEED, NAMES[0], number)


# ---- examination -----------------------------------------------------------------------------------------------

def test_the_same_seed_writes_the_same_files_and_they_are_notebooks(folder, names, tmp_path):
    random.seed(1)                                       # no other dice matter
    main(["exam", "--students", str(names), "--seed", SEED, "--to", str(tmp_path / "again")])
    for student in NAMES:
        text = (folder / f"{student}.ipynb").read_text(encoding="utf-8")
        assert text == (tmp_path / "again" / f"{student}.ipynb").read_text(encoding="utf-8") and SEED not in text
        nbformat.validate(nbformat.reads(text, as_version=4))
        assert text.count("= ...\"") == len(QUESTIONS)


def test_questions_are_chosen_by_number_or_by_notebook(names, tmp_path):
    instructors.exam(["01", "05.a"], names, SEED, tmp_path / "few")
    stamp = nbformat.read(tmp_path / "few/student-1.ipynb", as_version=4).metadata.exam
    assert stamp.questions == ["01.a", "01.b", "05.a"]
    with pytest.raises(ValueError, match="no question '01.c'"):
        instructors.exam(["01.c"], names, SEED, tmp_path / "none")
    assert not (tmp_path / "none").exists()


@pytest.mark.parametrize("text", ["", "../student-1", "student-1\nStudent-1", "a/b"])
def test_names_that_are_no_files_are_refused(text, tmp_path):
    (tmp_path / "students.txt").write_text(text, encoding="utf-8")
    with pytest.raises(ValueError, match="must hold names"):
        instructors.exam([], tmp_path / "students.txt", SEED, tmp_path / "exam")


def test_nothing_is_written_over(folder, names):
    before = (folder / "student-1.ipynb").read_text(encoding="utf-8")
    with pytest.raises(ValueError, match="nothing was written"):
        instructors.exam([], names, "another", folder)
    with pytest.raises(ValueError, match="nothing was written"):
        instructors.handout(folder)
    assert (folder / "student-1.ipynb").read_text(encoding="utf-8") == before


def test_the_notebook_of_an_examination_runs_as_handed_out(names, tmp_path):
    instructors.exam(["01.b"], names, SEED, tmp_path / "one")
    for (_, _), (points, message) in marks(tmp_path / "one", run=True).items():
        assert (points, message) == (0, "no answer")


# ---- marks -----------------------------------------------------------------------------------------------------

def test_right_wrong_and_missing_answers(folder):
    hand_in(folder / "student-1.ipynb", {number: right("student-1", number) for number in QUESTIONS})
    hand_in(folder / "student-2.ipynb", {number: right("student-1", number) for number in QUESTIONS})   # copied
    found = marks(folder)
    assert all(found["student-1", number] == (1, "right") for number in QUESTIONS)
    assert all(found["student-3", number] == (0, "no answer") for number in QUESTIONS)
    copied = [found["student-2", number] for number in QUESTIONS]
    assert sum(points for points, _ in copied) <= 1      # a variant may come within 2 % of another by chance
    assert all(points or "expected" in message for points, message in copied)


def test_a_mistake_and_a_unit_are_named(folder):
    hand_in(folder / "student-1.ipynb", {"01.a": 1000 * right("student-1", "01.a"), "06.a": right(
        "student-1", "06.a")[::-1], "02.a": 3.0})
    found = marks(folder)
    assert found["student-1", "01.a"][0] == 0 and "look at the unit" in found["student-1", "01.a"][1]
    assert "First the wheel" in found["student-1", "06.a"][1] and "2 numbers" in found["student-1", "02.a"][1]


@pytest.mark.parametrize("cell, points, words", [
    ("{name} = 1\n{name} = {value}", 1, "right"), ("{name}: float = {value}", 1, "right"),
    ("%matplotlib inline\n{name} = {value}\nwhat?", 1, "right"), ("# first try\n{name} = +{value}  # mine", 1, "right"),
    ("{name} = float('{value}')", 0, "no number can be read"), ("x = {value}\n{name} = x", 0, "no number"),
    ("{name} = {value}\n{name} += 1", 0, "no number"), ("{name} = None", 0, "no number"),
    ("if True:\n    {name} = {value}", 0, "no answer"), ("", 0, "no answer"), ("{name} = (", 0, "no answer"),
    ("{name} = '{value}'", 0, "asks for one number"), ("{name} = 1e999", 0, "one number"),
    ("{name} = " + "(" * 500 + "1" + ")" * 500, 0, ""), ("{name} = " + "9" * 5000, 0, "")])
def test_answers_are_read_and_not_run(folder, cell, points, words):
    hand_in(folder / "student-1.ipynb", {"01.a": right("student-1", "01.a")}, cell)
    found = marks(folder)["student-1", "01.a"]
    assert found[0] == points and words in found[1]


def test_no_code_is_run_unless_asked_for(folder, tmp_path):
    touched = tmp_path / "touched"
    cell = f"open({str(touched)!r}, 'w').close()\nvalue = np.float64({{value}})\n1 / 0\n{{name}} = 0\n"
    hand_in(folder / "student-1.ipynb", {"01.a": right("student-1", "01.a")}, cell)
    notebook = nbformat.read(folder / "student-1.ipynb", as_version=4)
    notebook.cells.append(nbformat.v4.new_code_cell("answer_01_a = value"))
    nbformat.write(notebook, folder / "student-1.ipynb")
    assert "no number can be read" in marks(folder)["student-1", "01.a"][1] and not touched.exists()
    assert marks(folder, run=True)["student-1", "01.a"] == (1, "right") and touched.exists()


@pytest.mark.parametrize("damage", [
    lambda text: text[:200], lambda text: "", lambda text: "[]", lambda text: '{"cells": 3}', lambda text: "null",
    lambda text: '{"cells": [3, null, {"cell_type": "code"}, {"cell_type": "code", "source": 5.5}]}',
    lambda text: "\x00\x01", lambda text: "[" * 100_000])
def test_a_damaged_notebook_costs_its_own_points_only(folder, damage):
    hand_in(folder / "student-1.ipynb", {"01.a": right("student-1", "01.a")})
    path = folder / "student-2.ipynb"
    path.write_text(damage(path.read_text(encoding="utf-8")), encoding="utf-8")
    found = marks(folder)
    assert found["student-1", "01.a"] == (1, "right")
    assert len(found) == 3 * len(QUESTIONS) and all(found["student-2", number][0] == 0 for number in QUESTIONS)
    assert re.search("cannot be read|no answer|no number", found["student-2", "01.a"][1])


def test_extra_and_missing_cells_and_lost_metadata_do_no_harm(folder):
    path = folder / "student-1.ipynb"
    hand_in(path, {"01.a": right("student-1", "01.a")})
    notebook = json.loads(path.read_text(encoding="utf-8"))
    notebook["cells"] = [{"cell_type": "code", "source": ["print(1)\n", "x = 1"]}] + [
        cell for cell in notebook["cells"] if "answer_01_b" not in str(cell)]
    notebook["metadata"] = {}
    path.write_text(json.dumps(notebook), encoding="utf-8")
    found = marks(folder)
    assert found["student-1", "01.a"][0] == 1 and "taken from the file's name" in found["student-1", "01.a"][1]
    assert found["student-1", "01.b"][1].startswith("no answer")


def test_a_notebook_of_somebody_else_is_noticed(folder):
    hand_in(folder / "student-1.ipynb", {"01.a": right("student-1", "01.a")})
    (folder / "student-2.ipynb").write_bytes((folder / "student-1.ipynb").read_bytes())
    rows = instructors.grade(folder, SEED)
    assert sum(student == "student-1" for student, *_ in rows) == 2 * len(QUESTIONS)
    assert not [row for row in rows if row[0] == "student-2"]
    assert any("named student-2.ipynb" in row[3] and "more than one" in row[3] for row in rows)


@pytest.mark.parametrize("old, new, words", [
    ('"01.a",', "", "no answer"), ('"student-3"', '"student-9"', "changed by hand"),
    ('"mark": "', '"mark": "f', "another seed")])
def test_who_changes_the_metadata_gains_nothing(folder, old, new, words):
    path = folder / "student-3.ipynb"
    path.write_text(path.read_text(encoding="utf-8").replace(old, new, 1), encoding="utf-8")
    found = [row for row in instructors.grade(folder, SEED) if row[0] in ("student-3", "student-9")]
    assert len(found) == len(QUESTIONS) and all(points == 0 for _, _, points, _ in found)
    assert all(words in message for *_, message in found)


def test_another_seed_is_refused_rather_than_marked_wrong(folder, tmp_path):
    with pytest.raises(ValueError, match="with this seed"):
        instructors.grade(folder, "another")
    with pytest.raises(ValueError, match="holds no notebook"):
        instructors.grade(tmp_path / "nowhere", SEED)


def test_one_command_writes_a_table(folder, names, tmp_path):
    hand_in(folder / "student-1.ipynb", {"01.a": right("student-1", "01.a")})
    (folder / "student-3.ipynb").unlink()
    done = subprocess.run([sys.executable, "-m", "exercises", "grade", str(folder), "--seed", SEED, "--students",
                           str(names), "--to", str(tmp_path / "marks.csv")], cwd=REPO / "notebooks",
                          capture_output=True, text=True, check=True)
    with open(tmp_path / "marks.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert list(rows[0]) == ["student", "question", "points", "message"] and len(rows) == 3 * len(QUESTIONS)
    assert [row["message"] for row in rows if row["student"] == "student-3"] == ["no notebook"] * len(QUESTIONS)
    assert "student-1: 1\nstudent-2: 0\nstudent-3: 0" in done.stdout
    wrong = subprocess.run([sys.executable, "-m", "exercises", "grade", str(folder), "--seed", "another"],
                           cwd=REPO / "notebooks", capture_output=True, text=True)
    assert wrong.returncode == 2 and "with this seed" in wrong.stderr and "Traceback" not in wrong.stderr


def test_a_table_holds_no_formula(tmp_path):
    instructors.write_marks([("=1+1", "01.a", 0, "no answer")], tmp_path / "marks.csv")
    assert "'=1+1" in (tmp_path / "marks.csv").read_text(encoding="utf-8")


# ---- handout ---------------------------------------------------------------------------------------------------

@pytest.fixture(scope="module")
def given_out(tmp_path_factory):
    folder = tmp_path_factory.mktemp("students") / "handout"
    main(["handout", str(folder)])
    return folder


def test_a_handout_holds_every_notebook_and_no_solution(given_out):
    ours = sorted((REPO / "notebooks").glob("[0-9][0-9]_*.ipynb"))
    theirs = sorted(given_out.glob("[0-9][0-9]_*.ipynb"))
    assert [path.name for path in theirs] == [path.name for path in ours] and len(theirs) >= 13
    asked = 0
    for path in theirs:
        notebook = nbformat.read(path, as_version=4)
        nbformat.validate(notebook)
        for cell in notebook.cells:
            assert "solution" not in cell.metadata.get("tags", []) and not cell.source.startswith("#### Solution")
            if cell.cell_type == "code":
                assert not cell.outputs and cell.execution_count is None
                for answer in re.findall(r'check\("\d\d\.\d", (.+)\)', cell.source):
                    assert answer in ("answer", "mine")
                asked += cell.source.startswith("answer = ...")
    solved = [cell for path in ours for cell in nbformat.read(path, as_version=4).cells
              if "solution" in cell.metadata.get("tags", [])]
    assert asked >= 40 and len(solved) >= 2 * 40         # there was something to leave out


def test_a_handout_has_what_it_needs_and_nothing_of_the_instructors(given_out):
    assert not [path for path in given_out.rglob("*") if path.name in (*instructors.OURS, "exemplars")]
    assert "For instructors" not in (given_out / "README.md").read_text(encoding="utf-8")
    done = subprocess.run([sys.executable, "-c",
                           "import drawings, ledger, registry, rediscovery, rules, searches, sensitivity\n"
                           "import validation, wheel_doubts\n"
                           "from exercises import check\n"
                           "assert check('01.1', 2 ** (2 / 3)) and not check('01.1', ...)"], cwd=given_out,
                          env={"PYTHONPATH": str(REPO), "PATH": ""}, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    for path in given_out.glob("[0-9][0-9]_*.ipynb"):
        prose = "\n".join(c.source for c in nbformat.read(path, as_version=4).cells if c.cell_type == "markdown")
        local = re.findall(r"\]\((?![a-z]+:|#|\.\.)([^)\s#]+)", prose)
        assert local and not [target for target in local if not (given_out / target).exists()], path.name


def test_a_handout_from_a_read_only_clone_can_be_written_in(tmp_path, monkeypatch):
    clone = tmp_path / "clone"
    for part in "drawings", "exercises":
        (clone / part).mkdir(parents=True)
        (clone / part / "part.py").touch()
    (clone / "README.md").touch()
    for path in clone.rglob("*"):
        path.chmod(path.stat().st_mode & ~0o222)
    monkeypatch.setattr(instructors, "NOTEBOOKS", clone)
    instructors.handout(tmp_path / "handout")
    copied = list((tmp_path / "handout").rglob("*"))
    assert len(copied) == 5 and all(path.stat().st_mode & stat.S_IWUSR for path in copied)
    for path in clone.rglob("*"):                        # that the folder can be removed
        path.chmod(path.stat().st_mode | stat.S_IWUSR)
