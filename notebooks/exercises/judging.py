"""What an exercise is, and how an answer to it is judged."""
from __future__ import annotations

import dataclasses
from functools import cached_property
from typing import Callable

import numpy as np

from rdk.design import Design

EXERCISES = {}
"""Every exercise by its number, filled by the modules of the exercises."""
UNITS = (1e3, 1e-3, 1e2, 1e-2, 1e6, 1e-6, 24.0, 1 / 24, 60.0, 1 / 60, 3.6, 1 / 3.6, np.pi / 180, 180 / np.pi,
         -1.0)
"""Factors by which an answer in another unit is off."""


@dataclasses.dataclass(frozen=True)
class Exercise:
    """How an exercise is answered and judged, and what to say to a wrong answer.

    Attributes
    ----------
    number : str
        Notebook and exercise, such as "01.2".
    answer : callable
        Returns a right answer: a number, a list of numbers, a word, a set of words, True or False, a Design.
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
    number: str
    answer: Callable
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


def exercise(number, answer, hint, mistakes=None, **options):
    """Register an exercise; the arguments are the attributes of `Exercise`."""
    if number in EXERCISES:
        raise ValueError(f"exercise {number} is registered twice")
    EXERCISES[number] = Exercise(number, answer, hint, mistakes or {}, **options)


def judge(number, answer):
    """The verdict on the answer to a registered exercise; see `check`."""
    number = str(number)
    if number not in EXERCISES:
        near = [n for n in EXERCISES if n[:2] == number[:2]] or list(EXERCISES)
        raise ValueError(f"no exercise {number!r}; choose from {', '.join(sorted(near))}")
    task = EXERCISES[number]
    if answer is ...:
        return Verdict(False, "No answer yet: put yours in place of the three dots and run the cell again.")
    answer = _of_kind(task, answer)
    if task.judge is not None:
        missing = task.judge(answer)
        return Verdict(not missing, f"Not yet. {missing}" if missing else "Right: it does what was asked.")
    if _agree(answer, task.expected, task.within):
        return Verdict(True, "Right.")
    for hint, wrong in task.mistakes.items():
        if _agree(answer, wrong(), task.within):
            return Verdict(False, "Not yet. " + hint)
    if isinstance(answer, np.ndarray) and any(_agree(answer * unit, task.expected, task.within)
                                              for unit in UNITS):
        return Verdict(False, "Not yet. The digits are right: look at the unit asked for, or at the sign.")
    return Verdict(False, "Not yet. " + task.hint)


def _of_kind(task, answer):
    """The answer as the kind of thing that the exercise asks for, or a ValueError that says what that is."""
    expected, asks = task.expected, f"exercise {task.number} asks for"
    got = f"; got {answer!r}" if len(repr(answer)) < 80 else f"; got a {type(answer).__name__}"
    if isinstance(expected, Design):
        if not isinstance(answer, Design) or answer.shape:
            raise ValueError(f"{asks} one Design{got}")
        return answer
    if isinstance(expected, (str, set)):
        words = [answer] if isinstance(expected, str) else answer
        some = f"one of the words {', '.join(task.choices)}" if isinstance(expected, str) else (
            f"a set of words from {', '.join(task.choices)}")
        if not isinstance(words, (set, list, tuple)) or not all(isinstance(word, str) for word in words) or (
                not {word.strip().lower() for word in words} <= {word.lower() for word in task.choices}):
            raise ValueError(f"{asks} {some}{got}")
        words = {word.strip().lower() for word in words}
        return words if isinstance(expected, set) else words.pop()
    if isinstance(expected, (bool, np.bool_)):
        if not isinstance(answer, (bool, np.bool_)):
            raise ValueError(f"{asks} True or False{got}")
        return bool(answer)
    shape = np.shape(expected)
    asks += {0: " one number", 1: f" {np.size(expected)} numbers"}.get(len(shape),
                                                                       f" numbers of shape {shape}")
    try:
        given = np.asarray(answer)
    except ValueError:                                   # ragged
        raise ValueError(asks + got) from None
    if given.shape == (1,) and not shape:
        given = given[0]
    if given.dtype.kind not in "iuf" or np.shape(given) != shape:
        raise ValueError(asks + got)
    if not np.isfinite(given).all():
        raise ValueError(f"{asks}, finite{got}")
    return np.asarray(given, float)


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
