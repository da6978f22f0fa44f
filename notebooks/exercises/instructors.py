"""The instructors' tools: notebooks without solutions, an examination with a variant for each student, its marks.

Answers are read from the source of a notebook, not computed by running it, unless that is asked for.
"""
from __future__ import annotations

import ast
import csv
import hashlib
import json
import re
import shutil
import stat
from collections import Counter
from pathlib import Path

import nbformat
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook

from rdk._fields import unknown

from .exam import QUESTIONS
from .judging import judge

NOTEBOOKS = Path(__file__).parents[1]
OURS = ("__main__.py", "exam.py", "instructors.py")      # what a student's copy leaves out
RULES = """Write each answer in place of its three dots: `answer_01_a = 3.21`, or a list, `answer_02_a = [12.3, -4.5]`.
**The numbers are read, your code is not run**: a formula or the name of a variable on that line counts as no answer.
An answer is right within 2 %. Compute in as many further cells as you like. Keep the name of this file."""


def _empty(folder):
    folder = Path(folder)
    if folder.exists() and not (folder.is_dir() and not any(folder.iterdir())):
        raise ValueError(f"{folder} must be a new or an empty folder; nothing was written")
    folder.mkdir(parents=True, exist_ok=True)
    return folder


def handout(folder):
    """Copy the notebooks without solutions and outputs, and what they need to run, into an empty folder; how many."""
    folder, paths = _empty(folder), sorted(NOTEBOOKS.glob("[0-9][0-9]_*.ipynb"))
    for path in paths:
        notebook = nbformat.read(path, as_version=4)
        notebook.cells = [cell for cell in notebook.cells if "solution" not in cell.metadata.get("tags", [])]
        for cell in notebook.cells:
            if cell.cell_type == "code":
                cell.outputs, cell.execution_count = [], None
        nbformat.write(notebook, folder / path.name)
    for part in "drawings", "exercises":
        shutil.copytree(NOTEBOOKS / part, folder / part, ignore=shutil.ignore_patterns("__pycache__", *OURS))
    for pattern in ("*.py", "*.md", "app.ipynb", "*.png"):
        for path in NOTEBOOKS.glob(pattern):
            shutil.copy(path, folder)
    for path in folder.rglob("*"):                       # the clone may be read-only
        path.chmod(path.stat().st_mode | stat.S_IWUSR)
    guide = (NOTEBOOKS / "README.md").read_text(encoding="utf-8").partition("## For instructors")[0]
    (folder / "README.md").write_text(guide.rstrip() + "\n", encoding="utf-8")
    return len(paths)


def students_of(path):
    """Names of students, one a line; they become names of files."""
    names = [line.strip() for line in Path(path).read_text(encoding="utf-8-sig").splitlines() if line.strip()]
    wrong = [name for name in names if not re.fullmatch(r"\w[\w .-]*", name)]
    twice = [name for name, count in Counter(name.lower() for name in names).items() if count > 1]
    if wrong or twice or not names:
        raise ValueError(f"{path} must hold names of letters, digits, spaces, '.', '_' and '-', one a line, each once; "
                         f"got {', '.join(map(repr, wrong or twice)) or 'none'}")
    return names


def _mark(seed, student, questions):
    """Tells whether a notebook belongs to a seed."""
    return hashlib.sha256("/".join([seed, student, *questions]).encode()).hexdigest()[:16]


def _name(number):
    return "answer_" + number.replace(".", "_")


def exam(numbers, students, seed, folder):
    """Write an examination, one notebook a student, into an empty folder; numbers: of questions or of notebooks."""
    for number in numbers:
        if number not in {*QUESTIONS, *(q[:2] for q in QUESTIONS)}:
            raise unknown("no question", number, list(QUESTIONS))
    questions = [q for q in QUESTIONS if not numbers or q in numbers or q[:2] in numbers]
    names, folder = students_of(students), _empty(folder)
    for student in names:
        cells = [new_markdown_cell(f"# Examination: {student}\n\n{RULES}", id="rules"),
                 new_code_cell("import numpy as np\nimport rdk", id="imports")]
        for number in questions:
            text = QUESTIONS[number].text.format(**QUESTIONS[number].variant(seed, student, number))
            cells += [new_markdown_cell(f"## Question {number}\n\n{text}", id=_name(number) + "-text"),
                      new_code_cell(f"{_name(number)} = ...", id=_name(number))]
        stamp = {"student": student, "questions": questions, "mark": _mark(seed, student, questions)}
        kernel = {"name": "python3", "display_name": "Python 3 (ipykernel)", "language": "python"}
        nbformat.write(new_notebook(cells=cells, metadata={"exam": stamp, "kernelspec": kernel}),
                       folder / f"{student}.ipynb")
    return names


# ---- marks -----------------------------------------------------------------------------------------------------

def _sources(notebook):
    sources = [cell.get("source") for cell in notebook["cells"]
               if isinstance(cell, dict) and cell.get("cell_type") == "code"]
    return ["".join(map(str, source)) if isinstance(source, list) else str(source or "") for source in sources]


def _parsed(parse, source):
    """What Python makes of a text or a node; None where nothing."""
    try:
        return parse(source)
    except (ValueError, TypeError, SyntaxError, MemoryError, RecursionError):
        return None


def read_answers(notebook, names):
    """The last value assigned to each name, read and not computed; None where no literal stands there."""
    found = {}
    for source in _sources(notebook):
        whole = _parsed(ast.parse, source)               # a cell that is no Python may still hold good lines
        for tree in [whole] if whole else filter(None, (_parsed(ast.parse, line) for line in source.splitlines())):
            for node in tree.body:
                for target in getattr(node, "targets", None) or [getattr(node, "target", None)]:
                    if isinstance(target, ast.Name) and target.id in names:
                        plain = isinstance(node, (ast.Assign, ast.AnnAssign)) and node.value
                        found[target.id] = _parsed(ast.literal_eval, node.value) if plain else None
    return found


def run_answers(notebook, names, folder, timeout_s=60):
    """What each name holds after all cells were run in a kernel of their own. This runs the student's code."""
    from nbclient import NotebookClient
    tell = (f"for _n in {sorted(names)!r}:\n    if _n in globals():\n        _v = globals()[_n]\n"
            "        print(_n, '...' if _v is ... else repr(_v.tolist() if hasattr(_v, 'tolist') else _v))")
    run = new_notebook(cells=[new_code_cell(source) for source in [*_sources(notebook), tell]])
    NotebookClient(run, kernel_name="python3", timeout=timeout_s, allow_errors=True,
                   resources={"metadata": {"path": str(folder)}}).execute()
    lines = "".join(output.get("text", "") for output in run.cells[-1].outputs).splitlines()
    return {name: _parsed(ast.literal_eval, value) for name, _, value in (line.partition(" ") for line in lines)}


def _read(path):
    """A submission: its notebook, the stamp of the examination ({} if lost), "" or what is wrong with it."""
    try:
        notebook = json.loads(path.read_text(encoding="utf-8"))
        if not isinstance(notebook["cells"], list):
            raise TypeError
    except (OSError, ValueError, KeyError, TypeError, RecursionError) as error:
        return {"cells": []}, {}, f"the file cannot be read as a notebook ({type(error).__name__})"
    metadata = notebook.get("metadata")
    stamp = metadata.get("exam") if isinstance(metadata, dict) else None
    good = isinstance(stamp, dict) and isinstance(stamp.get("student"), str) and isinstance(
        stamp.get("questions"), list) and all(q in list(QUESTIONS) for q in stamp["questions"])
    return notebook, stamp if good else {}, ""


def grade(folder, seed, students=None, run=False):
    """Marks of a folder of submitted notebooks: rows (student, question, points, message).

    A student is who the notebook was made for or, where its metadata are lost, who its file is named after.
    """
    found = {path: _read(path) for path in sorted(Path(folder).glob("*.ipynb"))}
    lists = Counter(tuple(stamp["questions"]) for _, stamp, _ in found.values()
                    if stamp and stamp.get("mark") == _mark(seed, stamp["student"], stamp["questions"]))
    if not lists:
        raise ValueError(f"{folder} holds no notebook (.ipynb) of an examination with this seed")
    questions, rows = lists.most_common(1)[0][0], []
    owners = Counter(stamp.get("student", path.stem) for path, (_, stamp, _) in found.items())
    names = {_name(number): number for number in questions}
    for path, (notebook, stamp, trouble) in found.items():
        student = stamp.get("student", path.stem)
        notes = [f"the file is named {path.name}"] * (path.stem != student)
        notes += ["more than one notebook of this student"] * (owners[student] > 1)
        if stamp and stamp.get("mark") != _mark(seed, student, questions):
            trouble = "made for another seed or examination, or changed by hand"
        elif not stamp and not trouble:
            notes.append("who it is was lost in the notebook and taken from the file's name")
        answers = read_answers(notebook, names)
        if run and not trouble:
            try:
                answers = run_answers(notebook, names, Path(folder))
            except Exception as error:                   # a kernel can be ended in many ways
                notes.append(f"did not run to its end ({type(error).__name__}): read instead")
        for name, number in names.items():
            points, words = (0, trouble) if trouble else _judged(number, seed, student, answers.get(name, ...))
            rows.append((student, number, points, "; ".join([words, *notes])))
    absent = [name for name in (students_of(students) if students else []) if name not in owners]
    return rows + [(name, number, 0, "no notebook") for name in absent for number in questions]


def _judged(number, seed, student, answer):
    """Points and words for one answer."""
    if answer is ... or answer is None:
        return 0, "no answer" if answer else "no number can be read: a formula, a variable or a call stands there"
    exercise = QUESTIONS[number].exercise(QUESTIONS[number].variant(seed, student, number))
    verdict = judge(exercise, answer)
    wanted = " and ".join(f"{value:.4g}" for value in ([exercise.expected] if exercise.kind == "number"
                                                       else exercise.expected))
    return (1, "right") if verdict else (
        0, f"{verdict.message.removeprefix('Not yet. ')} Given {str(answer)[:60]}, expected {wanted}")


def write_marks(rows, path):
    """Write rows of `grade` as CSV; a cell that a spreadsheet would take for a formula gets an apostrophe."""
    with open(path, "w", newline="", encoding="utf-8") as file:
        csv.writer(file).writerows([f"'{cell}" if str(cell)[:1] in "=+-@" else cell for cell in row]
                                   for row in [("student", "question", "points", "message"), *rows])
