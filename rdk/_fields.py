"""Frozen records of numbers or arrays: checked when built, broadcast together, indexed by lane."""
from __future__ import annotations

import dataclasses
import difflib
import functools
import html
import math

import numpy as np


def number(minimum=-math.inf, maximum=math.inf, *, above=None, below=None, default=dataclasses.MISSING,
           whole=False, choices=None, infinite=False, scalar=False, optional=False):
    """A dataclass field that holds a real number, or an array of them, within limits.

    Parameters
    ----------
    minimum, maximum : float
        Inclusive limits.
    above, below : float, optional
        Exclusive limits, in place of `minimum` or `maximum`.
    default : float, optional
        Value of the field when none is given.
    whole : bool
        Only whole numbers are allowed.
    choices : tuple of float, optional
        Only these values are allowed.
    infinite : bool
        Positive infinity is allowed too.
    scalar : bool
        Arrays are refused.
    optional : bool
        None is allowed too.
    """
    limits = dict(minimum=minimum, maximum=maximum, above=above, below=below, whole=whole, choices=choices,
                  infinite=infinite, scalar=scalar, optional=optional)
    return dataclasses.field(default=default, metadata=limits)


def _allowed(limits):
    """Words for what a field accepts."""
    if limits["choices"]:
        return "one of " + ", ".join(f"{c:g}" for c in limits["choices"])
    kind = "a whole number" if limits["whole"] else ""
    low, high = limits["minimum"], limits["maximum"]
    if limits["above"] == 0 and high == math.inf and limits["below"] is None:
        span = "positive"
    elif low == 0 and high == math.inf and limits["below"] is None:
        span = "zero or more"
    else:
        bounds = [f"above {limits['above']:g}" if limits["above"] is not None else
                  f"at least {low:g}" if low > -math.inf else "",
                  f"below {limits['below']:g}" if limits["below"] is not None else
                  f"at most {high:g}" if high < math.inf else ""]
        span = " and ".join(filter(None, bounds))
    words = ", ".join(filter(None, [kind, span]))
    return words if kind or limits["infinite"] else " and ".join(filter(None, [words, "finite"]))


def check(name, value, minimum=-math.inf, maximum=math.inf, *, above=None, below=None, whole=False, choices=None,
          infinite=False, scalar=False, optional=False):
    """Return `value` as a float or a float array, or raise a ValueError that says what is allowed."""
    if optional and value is None:
        return None
    limits = dict(minimum=minimum, maximum=maximum, above=above, below=below, whole=whole, choices=choices,
                  infinite=infinite)
    refusal = f"{name} must be {_allowed(limits)}{' or None' if optional else ''}; got "
    if isinstance(value, (bool, np.bool_, str, bytes)) or value is None:
        raise ValueError(refusal + repr(value))
    try:
        array = np.asarray(value)
    except ValueError:                                   # nested lists of unequal length
        raise ValueError(refusal + repr(value)) from None
    if array.dtype.kind not in "iuf":
        raise ValueError(refusal + repr(value))
    array = array.astype(float)                          # a copy: the caller's array may change later
    if scalar and array.ndim:
        raise ValueError(f"{name} must be one number, not an array; got {array.size} values")
    good = np.isfinite(array)
    if infinite:
        good |= array == math.inf
    good &= (array >= minimum if above is None else array > above)
    good &= (array <= maximum if below is None else array < below)
    if whole:
        good &= (array == np.floor(array)) & (np.abs(array) < 2**53)         # beyond, floats skip whole numbers
    if choices:
        good &= np.isin(array, choices)
    if not good.all():
        if not array.ndim:
            raise ValueError(refusal + repr(value))
        first = tuple(int(i) for i in np.argwhere(~good)[0])
        raise ValueError(refusal + f"{array[first].item()!r} at index {first[0] if len(first) == 1 else first}")
    if whole or choices:
        array = array.astype(int)
    return array if array.ndim else array.item()


def unknown(what, name, known):
    """A ValueError for a name that nothing has: it offers the nearest, or all where none is near."""
    near = difflib.get_close_matches(str(name), known, 3, cutoff=0.45)
    return ValueError(f"{what} {name!r}; {'nearest are' if near else 'choose from'} {', '.join(near or known)}")


class Shown:
    """Base of results: as a cell's last line they are a heading and a short table, the pair that `_summary` returns."""

    def __repr__(self):
        heading, frame = self._summary()
        return f"{heading}\n{frame.to_string(max_rows=10, float_format='{:.4g}'.format)}"

    def _repr_html_(self):
        heading, frame = self._summary()
        return f"<p>{html.escape(heading)}</p>{frame.to_html(max_rows=10, border=0, float_format='{:.4g}'.format)}"


def together(**shapes):
    """Broadcast shapes, or a ValueError that names the arrays whose lengths disagree."""
    if not any(shapes.values()):
        return ()
    try:
        return np.broadcast_shapes(*shapes.values())
    except ValueError:
        arrays = ", ".join(f"{name} {shape}" for name, shape in shapes.items() if shape)
        raise ValueError(f"array lengths must agree or broadcast; got shapes {arrays}") from None


@functools.cache
def _limits(cls):
    return tuple((f.name, dict(f.metadata)) for f in dataclasses.fields(cls) if f.metadata)


@functools.cache
def _names(cls):
    return tuple(f.name for f in dataclasses.fields(cls))


class Later:
    """A field of a Record that may be given as a function without arguments: called when the field is first read."""

    def __set_name__(self, owner, name):
        self.name = name

    def __get__(self, record, owner=None):
        if record is None:
            raise AttributeError(self.name)              # to a dataclass: a field without a default
        value = vars(record)[self.name]
        if callable(value):
            value = vars(record)[self.name] = value()
        return value

    def __set__(self, record, value):
        vars(record)[self.name] = value


class Record:
    """Base of the frozen dataclasses: numbers are checked, arrays broadcast, lanes can be picked."""

    def __post_init__(self):
        for name, limits in _limits(type(self)):
            object.__setattr__(self, name, check(name, getattr(self, name), **limits))
        shapes = {name: np.shape(value) for name, value in self._numbers().items()}
        object.__setattr__(self, "_shape", together(**shapes))       # raises where array lengths disagree

    def numbers(self, prefix=""):
        """Names and values of every numeric field, those of nested records with a prefix."""
        return self._numbers(prefix, getattr)

    def _numbers(self, prefix="", read=lambda record, name: vars(record)[name]):
        found = {}
        for name in _names(type(self)):
            value = read(self, name)
            if isinstance(value, Record):
                found |= value._numbers(prefix + name + ".", read)
            elif isinstance(value, (float, int, np.ndarray, np.generic)):
                found[prefix + name] = value
        return found

    @property
    def shape(self):
        """Common shape of all fields: () for one, (n,) for a population of n."""
        return self._shape

    def __len__(self):
        if not self.shape:
            raise TypeError(f"this {type(self).__name__} is a single one and has no length")
        return self.shape[0]

    def __getitem__(self, index):
        """The lanes that `index` picks, as a record of the same kind."""
        shape = self.shape
        if not shape:
            raise TypeError(f"this {type(self).__name__} is a single one and cannot be indexed")

        def pick(value):
            if isinstance(value, Record):
                return pick_record(value)
            if isinstance(value, np.ndarray) and value.ndim:
                value = np.broadcast_to(value, shape)[index]
                return value if np.ndim(value) else value.item()
            return value

        def pick_record(record):
            changed = {name: pick(getattr(record, name)) for name in _names(type(record))}
            return dataclasses.replace(record, **changed)

        return pick_record(self)

    def __iter__(self):
        return (self[i] for i in range(len(self)))

    def to_frame(self):
        """A pandas DataFrame: one row a lane (C order), one column a numeric field."""
        import pandas as pd
        shape = self.shape
        columns = {name.replace(".", "_"): np.broadcast_to(value, shape).ravel() for name, value in
                   self.numbers().items()}
        return pd.DataFrame(columns)
