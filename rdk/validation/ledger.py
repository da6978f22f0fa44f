"""The paper's ledger: every number that it reports beside ours, computed afresh."""
from __future__ import annotations

import re

import numpy as np
import pandas as pd

from .. import catalog
from .rows import ROWS, Evidence

_BOUND = re.compile(r"(>=|<=|<|>)?\s*(-?[\d.]+?)(?:\.\.(-?[\d.]+))?$")
_COMPARE = {">=": np.greater_equal, "<=": np.less_equal, "<": np.less, ">": np.greater}


def accepts(accept, value):
    """Whether a value is inside a band of `paper_targets.csv`.

    Parameters
    ----------
    accept : str
        "low..high"; a bound such as "<= 0.20"; a number or a word, to be met exactly; several parts joined by ";",
        each starting with "max" or "min", for the largest and smallest value; "report ours ...", which nothing can
        fail. What follows " or " is not a bound.
    value : float, bool, str or sequence of float
        All of a sequence must be inside, unless a part says max or min.

    Returns
    -------
    bool or None
        None where nothing is asked but to report.

    Raises
    ------
    ValueError
        If `accept` cannot be read.

    Examples
    --------
    >>> accepts("26.5..27.7", 27.1), accepts("max 80; min < 8", (0.9, 80.0)), accepts("False", True)
    (True, True, False)
    """
    text = accept.partition(" or ")[0].strip()
    if text.startswith("report ours"):
        return None
    if ";" in text:
        return all(accepts(part, value) for part in text.split(";"))
    if text in ("True", "False") or isinstance(value, (bool, np.bool_)):
        return isinstance(value, (bool, np.bool_)) and str(bool(value)) == text
    if text.isalpha() or isinstance(value, str):
        return value == text
    values = np.asarray(value, float)
    which, _, rest = text.partition(" ")
    if which in ("max", "min"):
        text, values = rest, getattr(values, which)()
    bound = _BOUND.match(text)
    if not bound or (bound[1] and bound[3]):
        raise ValueError(f"accept must be a range, a bound or a word; got {accept!r}")
    low = float(bound[2])
    if bound[3]:
        inside = (values >= low) & (values <= float(bound[3]))
    elif bound[1]:
        inside = _COMPARE[bound[1]](values, low)
    else:
        inside = np.isclose(values, low, rtol=1e-6, atol=0)
    return bool(np.all(inside))


def paper_ledger(kinds=("deterministic", "stochastic", "cost"), searches=None, sections=None):
    """Every number that the paper reports beside ours, computed afresh.

    Parameters
    ----------
    kinds : sequence of str
        Which rows of `paper_targets.csv`: "deterministic", "stochastic" (numbers that a search's seed moves) or
        "cost" (timings: they differ from run to run).
    searches : rdk.validation.searches.Searches, optional
        The studies behind the stochastic rows: with an executor, with other seeds, or computed already.
    sections : sequence of str, optional
        Only rows of these sections of the paper.

    Returns
    -------
    pandas.DataFrame
        One row a number: id, section, quantity, paper (as printed), ours (a number, flag, word or (low, high)), agrees
        (NA where the row asks only for our value), why (a sentence where they disagree, or where agreement hides
        something).

    Raises
    ------
    ValueError
        If a kind or a section is unknown.
    NotImplementedError
        If a row has no computation.
    """
    from .searches import Searches                       # loads pymoo, and registers its rows
    targets = catalog.table("paper_targets.csv")
    known = list(dict.fromkeys(targets.kind))
    for kind in kinds:
        if kind not in known:
            raise ValueError(f"kinds must be among {', '.join(known)}; got {kind!r}")
    known = list(dict.fromkeys(targets.paper_section))
    for section in sections or ():
        if section not in known:
            raise ValueError(f"sections must be among {', '.join(known)}; got {section!r}")
    targets = targets[targets.kind.isin(list(kinds)) & targets.paper_section.isin(list(sections or known))]
    missing = [name for name in targets.id if name not in ROWS]
    if missing:
        raise NotImplementedError("no computation for the ledger rows " + ", ".join(missing))
    evidence, rows = Evidence(Searches() if searches is None else searches), []
    for target in targets.itertuples():
        found = ROWS[target.id](evidence)
        ours, why = found if isinstance(found, tuple) and isinstance(found[-1], str) else (found, "")
        rows.append(dict(id=target.id, section=target.paper_section, quantity=target.quantity,
                         paper=str(target.paper_value), ours=ours, agrees=accepts(str(target.accept), ours), why=why))
    return pd.DataFrame(rows).astype({"agrees": "boolean", "ours": object})
