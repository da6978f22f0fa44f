"""The exercises: answers pass their own check, mistakes get their own hint, notebooks and registry agree."""

import re
from pathlib import Path

import nbformat
import numpy as np
import pytest

import rdk
import exercises as course

REPO = Path(__file__).parents[1]
PATHS = {path.name[:2]: path for path in sorted((REPO / "notebooks").glob("[0-9][0-9]_*.ipynb"))}
TASKS = course.EXERCISES
CLOSED = sorted(number for number, task in TASKS.items() if task.answer)  # an open task stores no answer
MISTAKES = [(number, hint) for number, task in sorted(TASKS.items()) for hint in task.mistakes]
HEADING = re.compile(r"^### Exercise (\d\d\.\d)\b(.*)$", re.M)
pytestmark = pytest.mark.filterwarnings("ignore:design outside the class")


def given(value):
    """An answer in another form that means the same."""
    if isinstance(value, str):
        return f" {value.upper()} "
    if isinstance(value, set):
        return [word.upper() for word in value]
    if isinstance(value, (bool, np.bool_, rdk.Design)):
        return value
    return np.asarray(value).tolist()


@pytest.mark.parametrize("number", CLOSED)
def test_the_answer_of_an_exercise_passes_its_own_check(number):
    verdict = course.check(number, TASKS[number].answer())
    assert verdict and repr(verdict).startswith("Right"), verdict
    assert course.check(number, given(TASKS[number].answer()))


@pytest.mark.parametrize("number, hint", MISTAKES)
def test_a_typical_mistake_gets_the_hint_meant_for_it(number, hint):
    verdict = course.check(number, TASKS[number].mistakes[hint]())
    assert not verdict
    if TASKS[number].judge is None:
        assert verdict.message == "Not yet. " + hint
    else:
        assert hint in verdict.message


@pytest.mark.parametrize("number", CLOSED)
def test_hints_give_no_answer_away(number):
    task = TASKS[number]
    assert task.judge or task.hint
    words = "" if task.judge else f"{task.hint} {' '.join(task.mistakes)}"
    if isinstance(task.expected, str):
        assert not re.search(rf"\b{re.escape(task.expected.lower())}\b", words.lower())
    elif task.judge is None and not isinstance(task.expected, (bool, set)):
        numbers = [float(found) for found in re.findall(r"(?<![\w.])-?\d+\.?\d*(?![\w.])", words)]
        close = [n for n in numbers for value in np.ravel(task.expected)
                 if abs(n - value) <= 0.005 * abs(value)]
        assert not close, (close, words)


@pytest.mark.parametrize("number", sorted(n for n, task in TASKS.items() if task.judge is None))
def test_any_other_answer_gets_the_general_hint(number):
    task = TASKS[number]
    if isinstance(task.expected, (bool, np.bool_)):
        other = not task.expected
    elif isinstance(task.expected, (str, set)):
        known = [wrong() for wrong in task.mistakes.values()] + [task.expected]
        words = [word for word in task.choices if word not in known]
        if isinstance(task.expected, str) and not words:
            pytest.skip("every wrong word has a hint of its own")
        other = words[0] if isinstance(task.expected, str) else set()
    else:
        other = np.asarray(task.expected, float) * 0 + 7.77e13
    verdict = course.check(number, other)
    assert not verdict and verdict.message in ["Not yet. " + hint for hint in (task.hint, *task.mistakes)]


def test_numbers_agree_within_their_tolerance_only():
    right = TASKS["16.1"].expected
    assert course.check("16.1", right * 1.004) and not course.check("16.1", right * 1.006)
    assert course.check("16.1", np.float64(right)) and course.check("16.1", [right])


def test_three_dots_are_no_answer_yet():
    for number in TASKS:
        assert not course.check(number, ...) and "No answer yet" in course.check(number, ...).message


def test_unknown_exercises_are_refused_and_the_known_ones_named():
    with pytest.raises(ValueError, match=r"no exercise '16\.9'; choose from 16\.1, 16\.2"):
        course.check("16.9", 1.0)
    with pytest.raises(ValueError, match=r"no exercise 'Rashid'; choose from 00\.1|16\.1"):
        course.check("Rashid", 1.0)


@pytest.mark.parametrize("number", CLOSED)
def test_the_stored_kind_is_that_of_the_answer(number):
    expected, kind = TASKS[number].expected, TASKS[number].kind
    if isinstance(expected, (rdk.Design, str, set, bool, np.bool_)):
        kinds = {rdk.Design: "Design", str: "word", set: "set of words"}
        assert kind == kinds.get(type(expected), "True or False")
    else:
        assert kind == ("number" if np.ndim(expected) == 0 else f"{len(expected)} numbers")


WORDS = ("sun", "rain", "snow")
WORD = course.Exercise("word", lambda: "sun", "look up", {"too wet": lambda: "rain"}, choices=WORDS)
SET = course.Exercise("set of words", lambda: {"sun", "rain"}, "look up", choices=WORDS)
TRUTH = course.Exercise("True or False", lambda: True, "look up")
NUMBER = course.Exercise("number", lambda: 2.0, "look up")
PAIR = course.Exercise("2 numbers", lambda: [1.0, 0.0], "look up", {"swapped": lambda: [0.0, 1.0]})
DESIGN = course.Exercise("Design", lambda: rdk.rover("Rashid-1"), "", judge=lambda design: "")


@pytest.mark.parametrize("task, wrong, words", [
    (WORD, "hail", "one of the words sun, rain, snow"), (WORD, 1, "one of the words"), (WORD, ["rain"], "one of"),
    (SET, "sun", "a set of words from sun, rain, snow"), (SET, {1}, "a set of words"),
    (TRUTH, 1, "True or False"), (TRUTH, "True", "True or False"),
    *[(NUMBER, wrong, "one number") for wrong in ("0.12", None, True, [1.0, 2.0], [[1.0], [1.0, 2.0]], np.nan, 1j,
                                                  {}, (16, "hub"), [[1.0]])],
    (PAIR, 1.0, "2 numbers"), (PAIR, [True, False], "2 numbers"), (PAIR, [1.0, np.inf], "2 numbers"),
    *[(DESIGN, wrong, "one Design") for wrong in (1.0, "a rover", {"wheel_radius_m": 0.1},
                                                  rdk.random_designs(3, seed=1))]])
def test_an_answer_of_another_kind_is_told_what_is_asked_for(task, wrong, words):
    verdict = course.judge(task, wrong)
    assert not verdict and verdict.message.startswith(f"This exercise asks for {words}")
    assert "you gave" in verdict.message


def test_no_answer_is_computed_to_refuse_another_kind():
    def never():
        raise AssertionError("computed")
    assert not course.judge(course.Exercise("number", never, ""), "1") and not course.judge(
        course.Exercise("3 numbers", never, ""), [1.0])


def test_answers_of_the_right_kind_are_judged():
    assert course.judge(WORD, " Sun ") and course.judge(SET, ["RAIN", "sun"]) and course.judge(TRUTH, np.True_)
    assert course.judge(WORD, "rain").message == "Not yet. too wet" and not course.judge(SET, {"sun"})
    assert course.judge(PAIR, [1.0, 0.0]) and course.judge(PAIR, np.array([1, 0])) and course.judge(NUMBER, [2])
    assert course.judge(PAIR, [0, 1]).message == "Not yet. swapped" and not course.judge(PAIR, [1.0, 0.1])
    assert "the unit" in course.judge(NUMBER, 2000.0).message and course.judge(DESIGN, rdk.rover("Pragyan"))


# ---- the notebooks -----------------------------------------------------------------------------------------

def exercises_of(path):
    """The cells that follow each exercise heading, up to the next heading: {number: (heading, cells)}."""
    found, number = {}, None
    for cell in nbformat.read(path, as_version=4).cells:
        heading = HEADING.search(cell.source) if cell.cell_type == "markdown" else None
        if heading:
            number = heading[1]
            assert number not in found, f"two exercises {number}"
            assert len(HEADING.findall(cell.source)) == 1, f"one exercise a cell: {number}"
            found[number] = (heading[2], [cell])
        elif cell.cell_type == "markdown" and re.search(r"^##? ", cell.source, re.M):
            number = None
        elif number:
            found[number][1].append(cell)
    return found


@pytest.mark.parametrize("chapter", sorted({number[:2] for number in TASKS}))
def test_notebook_and_registry_hold_the_same_exercises(chapter):
    found = exercises_of(PATHS[chapter])
    assert list(found) == sorted(n for n in TASKS if n[:2] == chapter)
    assert 3 <= len(found) <= 6
    headings = [heading for heading, _ in found.values()]
    assert "(one minute)" in headings[0] and all(re.fullmatch(r" \(.+\)", heading) for heading in headings)


def test_no_notebook_has_exercises_that_the_registry_lacks():
    for chapter, path in PATHS.items():
        assert not set(exercises_of(path)) - set(TASKS), path.name


@pytest.mark.parametrize("number", sorted(TASKS))
def test_each_exercise_has_a_hint_a_place_for_the_answer_and_a_checked_solution(number):
    _, (text, *cells) = exercises_of(PATHS[number[:2]])[number]
    hint = re.search(r"<details><summary>Hint</summary>(.+)</details>", text.source, re.S)
    assert hint, "a collapsed hint"
    assert not re.search(r"`|\$|\*\w|\]\(", hint[1]), "no Markdown inside HTML: it would show as it stands"
    open_cells = [cell for cell in cells if cell.cell_type == "code"
                  and "solution" not in cell.metadata.get("tags", [])]
    folded = [cell for cell in cells if "solution" in cell.metadata.get("tags", [])]
    assert [cell.source for cell in open_cells] == [f'answer = ...\ncheck("{number}", answer)']
    assert "No answer yet" in open_cells[0].outputs[0]["data"]["text/plain"]
    if number not in CLOSED:
        assert not folded and "there is no solution" in text.source
        return
    solutions = [cell for cell in folded if cell.cell_type == "code"]
    assert any(f'assert check("{number}", ' in cell.source
               for cell in solutions), "the solution passes its check"
    # a folded cell still shows its output when it runs: the heading above hides all of it in JupyterLab
    assert folded[0].source == "#### Solution" and folded[0].metadata["jp-MarkdownHeadingCollapsed"] is True
    assert folded == cells[cells.index(folded[0]):], "nothing that belongs to the solution stands outside"
    assert all(cell.metadata["jupyter"]["source_hidden"] for cell in solutions)


@pytest.mark.parametrize("number", sorted(number for number in TASKS if number < "06"))
def test_an_exercise_that_asks_more_than_one_thing_says_what_to_answer_with(number):
    _, (text, *cells) = exercises_of(PATHS[number[:2]])[number]
    asked = text.source.partition("<details>")[0]
    assert asked.count("?") < 2 or "Answer with" in asked
    told = [cell for cell in cells if cell.cell_type == "markdown" and not cell.source.startswith("#### ")]
    assert told or "print" in cells[-1].source, "the solution says something"
