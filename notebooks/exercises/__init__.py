"""Self-checks of the notebooks' exercises: `check("01.2", answer)`.

An exercise computes its answer with `rdk`, independently of the notebooks; no answer is stored. Typical
mistakes are computed too, each with the hint meant for it. A hint names what went wrong and does not give the
answer away.

The exercises are grouped by notebook, one block an exercise: `wheel` (00 to 02), `vehicle` (03 to 05),
`designs` (06 to 08), `trust` (09 to 11), `capstone` (12). How an answer is judged is in `judging`.
"""
from .judging import EXERCISES, UNITS, Exercise, Verdict, exercise, judge  # noqa: F401


def exercises():
    """Every exercise by its number; loads the modules that register them."""
    from . import wheel, vehicle, designs, trust, capstone  # noqa: F401  fill EXERCISES
    return EXERCISES


def check(number, answer):
    """Tell whether the answer to an exercise is right and, when it is not, what to look at.

    Parameters
    ----------
    number : str
        Notebook and exercise, such as "01.2".
    answer : float, sequence of float, str, set of str, bool or Design
        What the exercise asks for, in the unit that it names. An ellipsis, `...`, stands for no answer yet.

    Returns
    -------
    Verdict
        True where right; shows itself as a sentence.

    Raises
    ------
    ValueError
        If there is no such exercise, or the answer is not of the kind asked for.

    Examples
    --------
    >>> check("12.1", 0.06)
    Not yet. A rigid chassis does not climb an obstacle as high as its wheel's radius.
    >>> bool(check("12.1", 0.12))
    True
    """
    exercises()
    return judge(number, answer)
