"""What an exercise is, and how an answer to it is judged."""
from __future__ import annotations

import dataclasses
from collections.abc import Callable
from functools import cached_property

import numpy as np

from rdk.design import Design

UNITS = (1e3, 1e-3, 1e2, 1e-2, 1e6, 1e-6, 24.0, 1 / 24, 60.0, 1 / 60, 3.6, 1 / 3.6, np.pi / 180, 180 / np.pi,
         -1.0)
"""Factors by which an answer in another unit is off."""


@dataclasses.dataclass(frozen=True)
class Exercise:
    """How an exercise is answered and judged, and what to say to a wrong answer.

    Attributes
    ----------
    kind : str
        "number", "3 numbers", "word", "set of words", "True or False" or "Design". It is stored, so that an answer
        of another kind is refused without computing the right one.
    answer : callable or None
        Returns a right answer; None where many are right and none is stored.
    hint : str
        What to look at, for a wrong answer that no mistake explains.
    mistakes : dict of str to callable
        The hint for each typical mistake, and a function that makes it.
    within : float
        Relative tolerance of numbers.
    judge : callable or None
        For tasks with many right answers: takes the answer, returns "" or what is still missing.
    choices : tuple of str
        Words to choose from.
    """
    kind: str
    answer: Callable | None
    hint: str
    mistakes: dict = dataclasses.field(default_factory=dict)
    within: float = 0.02
    judge: Callable | None = None
    choices: tuple = ()

    @cached_property
    def expected(self):
        """A right answer, computed once."""
        return self.answer()


@dataclasses.dataclass(frozen=True)
class Verdict:
    """Whether an answer is right, and what to look at when it is not; shows itself as a sentence."""
    right: bool
    message: str

    def __bool__(self):
        return self.right

    def __repr__(self):
        return self.message


def judge(task, answer):
    """The verdict on an answer to an exercise; see `check`."""
    if answer is ...:
        return Verdict(False, "No answer yet: put yours in place of the three dots and run the cell again.")
    answer, asked = _of_kind(task, answer)
    if asked:
        return Verdict(False, asked)
    if task.judge is not None:
        missing = task.judge(answer)
        return Verdict(not missing, f"Not yet. {missing}" if missing else "Right: it does what was asked.")
    if _agree(answer, task.expected, task.within):
        return Verdict(True, "Right.")
    for hint, wrong in task.mistakes.items():
        if _agree(answer, wrong(), task.within):
            return Verdict(False, "Not yet. " + hint)
    if isinstance(answer, (float, np.ndarray)) and any(_agree(answer * unit, task.expected, task.within)
                                              for unit in UNITS):
        return Verdict(False, "Not yet. The digits are right: look at the unit asked for, or at the sign.")
    return Verdict(False, "Not yet. " + task.hint)


def _of_kind(task, answer):
    """The answer as the kind of thing that the exercise asks for, and "" or a sentence that says what that is."""
    choices = {word.lower() for word in task.choices}
    asks = {"number": "one number", "Design": "one Design, such as rdk.rover('Rashid-1')",
            "word": f"one of the words {', '.join(task.choices)}",
            "set of words": f"a set of words from {', '.join(task.choices)}"}.get(task.kind, task.kind)
    got = repr(answer) if len(repr(answer)) < 80 else f"a {type(answer).__name__}"
    wrong = None, f"This exercise asks for {asks}; you gave {got}."
    if task.kind == "Design":
        return (answer, "") if isinstance(answer, Design) and not answer.shape else wrong
    if task.kind == "True or False":
        return (bool(answer), "") if isinstance(answer, (bool, np.bool_)) else wrong
    if task.choices:
        words = [answer] if task.kind == "word" else answer
        if not isinstance(words, (set, list, tuple)) or not all(isinstance(word, str) for word in words):
            return wrong
        words = {word.strip().lower() for word in words}
        return (words.pop() if task.kind == "word" else words, "") if words <= choices else wrong
    try:
        given = np.asarray(answer)
    except ValueError:                                   # ragged
        return wrong
    count = 1 if task.kind == "number" else int(task.kind.split()[0])
    flat = given.reshape(-1)
    if given.dtype.kind not in "iuf" or flat.size != count or given.ndim > 1 or not np.isfinite(flat).all():
        return wrong
    return (flat[0] if task.kind == "number" else flat).astype(float), ""


def _agree(answer, expected, within):
    """Whether an answer of the right kind equals the expected one, numbers within a relative tolerance."""
    if isinstance(expected, str):
        return answer == expected.lower()
    if isinstance(expected, set):
        return answer == {word.lower() for word in expected}
    if isinstance(expected, (bool, np.bool_)):
        return answer == expected
    wanted = np.asarray(expected, float)
    scale = np.where(wanted == 0, np.max(np.abs(wanted)) or 1.0, np.abs(wanted))
    return bool(np.all(np.abs(answer - wanted) <= (within + 1e-9) * scale))
