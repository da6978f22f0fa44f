"""Self-checks of the notebooks' exercises: `check("01.2", answer)`.

An exercise computes its answer with `rdk`, independently of the notebooks; no answer is stored. Typical
mistakes are computed too, each with the hint meant for it. A hint names what went wrong and does not give the
answer away. The exercises are grouped by notebook: `wheel` (00 to 02), `vehicle` (03 to 05), `designs` (06 to 08),
`trust` (09 to 11), `sizing` (12), `stand` (13), `site` (14, 15), `capstone`. How an answer is judged is in `judging`.
"""
from . import capstone, designs, site, sizing, stand, trust, vehicle, wheel
from .judging import UNITS, Exercise, Verdict, judge  # noqa: F401

EXERCISES = dict(**wheel.EXERCISES, **vehicle.EXERCISES, **designs.EXERCISES, **trust.EXERCISES, **sizing.EXERCISES,
                 **stand.EXERCISES, **site.EXERCISES, **capstone.EXERCISES)
"""Every exercise by its number; a number given twice is an error here."""


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
        True where right; shows itself as a sentence. An answer of another kind or length is told what is asked for.

    Raises
    ------
    ValueError
        If there is no such exercise.

    Examples
    --------
    >>> check("16.1", 0.06)
    Not yet. A rigid chassis does not climb an obstacle as high as its wheel's radius.
    >>> bool(check("16.1", 0.12))
    True
    >>> check("16.1", "0.12 m")
    This exercise asks for one number; you gave '0.12 m'.
    """
    if str(number) not in EXERCISES:
        near = [n for n in EXERCISES if n[:2] == str(number)[:2]] or list(EXERCISES)
        raise ValueError(f"no exercise {number!r}; choose from {', '.join(sorted(near))}")
    return judge(EXERCISES[str(number)], answer)
