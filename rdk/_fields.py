"""Frozen records of numbers or arrays: checked when built, broadcast together, shown as short tables."""
import dataclasses
import difflib
import functools
import html
import math

import numpy as np

Real = float | np.ndarray                                # numbers that broadcast


def number(minimum=-math.inf, maximum=math.inf, *, default=dataclasses.MISSING, **more):
    """A dataclass field for numbers within the limits that `check` knows; `more` may hold a `doc` and other remarks."""
    return dataclasses.field(default=default, metadata=dict(minimum=minimum, maximum=maximum) | more)


def described(doc, **more):
    """A dataclass field that is not checked, with its line in the docstring of the class."""
    return dataclasses.field(metadata=dict(doc=doc), **more)


def _allowed(minimum, maximum, above=None, below=None, whole=False, choices=None, infinite=False, optional=False, **_):
    """Words for what a field accepts."""
    if choices:
        return "one of " + ", ".join(f"{c:g}" for c in choices)
    kind = "a whole number" if whole else ""
    low = f"above {above:g}" if above is not None else f"at least {minimum:g}" if minimum > -math.inf else ""
    high = f"below {below:g}" if below is not None else f"at most {maximum:g}" if maximum < math.inf else ""
    span = " and ".join(filter(None, [low, high]))
    span = {"above 0": "positive", "at least 0": "zero or more"}.get(span, span)
    words = ", ".join(filter(None, [kind, span])) or "a number" * infinite
    return (words if kind or infinite else " and ".join(filter(None, [words, "finite"]))) + optional * " or None"


def check(name, value, minimum=-math.inf, maximum=math.inf, *, above=None, below=None, whole=False, choices=None,
          infinite=False, scalar=False, optional=False, **_):
    """`value` as a float or a read-only float array, or a ValueError that names it and says what is allowed.

    `minimum` and `maximum` are allowed themselves; `above` and `below`, in their place, are not. More limits: `whole`
    numbers only (they come back as integers), these `choices` only, `infinite` (positive infinity too), `scalar` (no
    arrays), `optional` (None too).
    """
    if optional and value is None:
        return None

    def refusal(value):
        allowed = _allowed(minimum, maximum, above, below, whole, choices, infinite, optional)
        return ValueError(f"{name} must be {allowed}; got {value:.200}")

    listed = isinstance(value, (list, tuple))
    if any(isinstance(part, np.ma.MaskedArray) for part in (value if listed else [value])):
        raise refusal("a masked array: fill or drop what is masked")
    try:
        array = np.asarray(value)
    except ValueError:                                   # nested lists of unequal length
        raise refusal(repr(value)) from None
    if array.dtype.kind not in "iuf" or listed and any(
            isinstance(part, (bool, np.bool_)) for part in np.asarray(value, object).flat):
        raise refusal(repr(value))                       # a word, None, yes or no
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
            raise refusal(repr(value))
        first = tuple(int(i) for i in np.argwhere(~good)[0])
        raise refusal(f"{array[first].item()!r} at index {first[0] if len(first) == 1 else first}")
    if whole or choices:
        array = array.astype(int)
    if not array.ndim:
        return array.item()
    array.flags.writeable = False
    return array


def floats(name, values):
    """Values as floats, NaN among them allowed: for large arrays, which `check` would copy."""
    try:
        return np.asarray(values, float)
    except (TypeError, ValueError):
        raise ValueError(f"{name} must be numbers; got {values!r:.80}") from None


def together(**shapes):
    """Broadcast shapes, or a ValueError that names the arrays whose lengths disagree."""
    distinct = set(shapes.values()) - {()}
    if len(distinct) < 2:                                # as nearly always
        return distinct.pop() if distinct else ()
    try:
        return np.broadcast_shapes(*shapes.values())
    except ValueError:
        arrays = ", ".join(f"{name} {shape}" for name, shape in shapes.items() if shape)
        raise ValueError(f"array lengths must agree or broadcast; got shapes {arrays}") from None


def in_rows(values, shape):
    """Numbers and arrays as the rows of one array, each broadcast to a shape and then flat."""
    rows = np.empty((len(values), *shape))
    for i, value in enumerate(values):
        rows[i] = value
    return rows.reshape(len(values), math.prod(shape))


def unknown(what, name, known):
    """A ValueError for a name that nothing has: it offers the nearest, or all where none is near."""
    near = difflib.get_close_matches(str(name), known, 3, cutoff=0.45)
    return ValueError(f"{what} {name!r}; {'nearest are' if near else 'choose from'} {', '.join(near or known)}")


def whole(name, value, minimum=0, optional=False):
    """A whole number, such as a count or a seed; None too where it is `optional`."""
    return check(name, value, minimum, whole=True, scalar=True, optional=optional)


def generator(seed):
    """NumPy's random generator of a seed, a whole number; None for one that differs each time."""
    return np.random.default_rng(whole("seed", seed, optional=True))


def frozen(values):
    """Make arrays read-only."""
    for value in values:
        if isinstance(value, np.ndarray):
            value.flags.writeable = False


def require(**kinds):
    """Refuse arguments, each given as name=(value, class), that are not of their class; say how to get one."""
    for name, (value, kind) in kinds.items():
        if not isinstance(value, kind):
            got = repr(value) if isinstance(value, str) else type(value).__name__
            such = f", such as {kind.example}" if getattr(kind, "example", "") else ""
            raise TypeError(f"{name} must be a {kind.__name__}{such}; got {got:.200}")


def listed(name, values, kind):
    """Values as a list, each of its kind; a single one as a list of one."""
    found = list(values) if np.iterable(values) and not isinstance(values, kind) else [values]
    require(**{f"{name}[{i}]": (value, kind) for i, value in enumerate(found)})
    return found


def brief(result):
    """Repr of a named tuple or dataclass of numbers: long arrays and tuples by their ends."""
    names = getattr(result, "_fields", None) or _names(type(result))
    with np.printoptions(threshold=6, edgeitems=2):
        return f"{type(result).__name__}({', '.join(f'{name}={getattr(result, name)!r:.120}' for name in names)})"


class Shown:
    """Base of results: as a cell's last line they are a heading and a short table, the pair that `_summary` returns."""

    def __repr__(self):
        heading, frame = self._summary()
        return f"{heading}\n{frame.to_string(max_rows=12, float_format='{:.4g}'.format)}"

    def _repr_html_(self):
        heading, frame = self._summary()
        return f"<p>{html.escape(heading)}</p>{frame.to_html(max_rows=12, border=0, float_format='{:.4g}'.format)}"


class Later:
    """A field of a Record that may be given as a function without arguments: called when the field is first read."""

    def __init__(self, doc):
        self.metadata = dict(doc=doc)

    def __set_name__(self, owner, name):
        self.name = name

    def __get__(self, record, owner=None):
        if record is None:
            raise AttributeError(self.name)              # to a dataclass: a field without a default
        value = vars(record)[self.name]
        if callable(value):
            value = vars(record)[self.name] = value()
            frozen([value])
        return value

    def __set__(self, record, value):
        vars(record)[self.name] = value


@functools.cache
def limits_of(cls):
    """The limits of every field of a Record that is a `number`, by name."""
    return {f.name: dict(f.metadata) for f in dataclasses.fields(cls) if "minimum" in f.metadata}


def _picked(value, shape, index):
    """Lanes of a number, an array or a record of such; what is computed when it is first read stays for later."""
    if isinstance(value, Record):
        picked = {}
        for name in _names(type(value)):
            if callable(vars(value).get(name)):
                picked[name] = functools.partial(_picked_field, value, name, shape, index)
            elif name not in value.apart:
                picked[name] = _picked_field(value, name, shape, index)
        return dataclasses.replace(value, **picked)
    if isinstance(value, np.ndarray) and value.ndim:
        value = np.broadcast_to(value, shape)[index]
        return value if np.ndim(value) else value.item()
    return value


def _picked_field(record, name, shape, index):
    return _picked(getattr(record, name), shape, index)


@functools.cache
def _names(cls):
    return tuple(f.name for f in dataclasses.fields(cls))


def _documented(cls):
    """The docstring of a class with one entry for each field that has a `doc`: its limits stand on the field alone."""
    entries = ""
    for name, kind in cls.__annotations__.items():
        about = getattr(vars(cls).get(name), "metadata", {})
        words = [about["doc"]] if about.get("doc") else []
        words += [f"Allowed: {_allowed(**about)}."] if "minimum" in about else []
        if words:
            many = " or ndarray" * (kind in (int, float, bool) and not about.get("scalar"))
            entries += f"\n    {name} : {getattr(kind, '__name__', kind)}{many}\n        {' '.join(words)}"
    return f"{(cls.__doc__ or '').rstrip()}\n\n    Attributes\n    ----------{entries}\n" if entries else cls.__doc__


class Record(Shown):
    """Base of the frozen dataclasses: numbers are checked, arrays broadcast, lanes can be picked."""

    apart = ()                                           # fields whose arrays do not run over lanes
    example = ""                                         # how to get one

    def __init_subclass__(cls):
        for name in ("__eq__", "__hash__", "__repr__"):  # in place of those that a dataclass writes
            setattr(cls, name, getattr(Record, name))
        cls.__doc__ = _documented(cls)

    def __post_init__(self):
        require(name=(getattr(self, "name", ""), str))
        for name, limits in limits_of(type(self)).items():
            object.__setattr__(self, name, check(name, getattr(self, name), **limits))
        shapes = {}
        for name, value in vars(self).items():
            if isinstance(value, Record):
                if name not in self.apart:
                    shapes |= {f"{name}.{n}": np.shape(v) for n, v in value.numbers().items()}
            elif isinstance(value, np.ndarray):
                shapes[name] = value.shape
                if value.flags.writeable:                # frozen here, and not in the caller's hands
                    value = value.view()
                    value.flags.writeable = False
                    object.__setattr__(self, name, value)
        object.__setattr__(self, "_shape", together(**shapes))       # raises where array lengths disagree

    @classmethod
    def trusted(cls, shape, fields):
        """A record of values that are known to be sound, have this shape or none, and belong to nobody else."""
        record = object.__new__(cls)
        record.__setstate__(fields | {"_shape": shape})
        return record

    def __setstate__(self, state):
        """A record copied or read by pickle: its arrays are read-only again."""
        frozen(state.values())
        vars(self).update(state)

    def numbers(self, prefix=""):
        """Names and values of every numeric field, those of nested records with a prefix."""
        found = {}
        for name in _names(type(self)):
            value = getattr(self, name)
            if isinstance(value, Record) and name not in self.apart:
                found |= value.numbers(prefix + name + ".")
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

    def __bool__(self):
        return True

    def _key(self):
        """What equality and hash compare."""
        def plain(value):
            if isinstance(value, np.ndarray):            # + 0: minus zero equals zero
                return value.shape, (value + 0).tobytes()
            if isinstance(value, dict):
                return tuple(value.items())
            return "nan" if isinstance(value, float) and value != value else value

        return tuple(plain(getattr(self, f.name)) for f in dataclasses.fields(self) if f.compare)

    def __eq__(self, other):
        return self._key() == other._key() if type(self) is type(other) else NotImplemented

    def __hash__(self):
        return hash((type(self), self._key()))

    def __getitem__(self, index):
        """The lanes that `index` picks, as a record of the same kind."""
        if not self.shape:
            raise TypeError(f"this {type(self).__name__} is a single one and cannot be indexed")
        return _picked(self, self.shape, index)

    def __iter__(self):
        return (self[i] for i in range(len(self)))

    def replace(self, **changes):
        """A copy with fields changed."""
        for name in changes:
            if name not in _names(type(self)):
                raise unknown(f"{type(self).__name__} has no field", name, _names(type(self)))
        return dataclasses.replace(self, **changes)

    @classmethod
    def stack(cls, records):
        """Many records as one: their numbers along a new first axis. What is no number must be the same in all."""
        records = list(records)
        if not records:
            raise ValueError(f"records must hold at least one {cls.__name__}; got none")
        require(**{f"records[{i}]": (record, cls) for i, record in enumerate(records)})
        shape = together(**{f"records[{i}]": record.shape for i, record in enumerate(records)})
        fields = {}
        for f in dataclasses.fields(cls):
            values = [getattr(record, f.name) for record in records]
            if isinstance(values[0], Record) and f.name not in cls.apart:
                fields[f.name] = type(values[0]).stack(values)
            elif all(isinstance(v, (float, int, np.ndarray)) for v in values) and not f.metadata.get("scalar"):
                fields[f.name] = np.stack([np.broadcast_to(v, shape) for v in values])
            elif f.compare and all(v == values[0] for v in values):
                fields[f.name] = values[0]
            elif f.name == "name":
                fields[f.name] = ", ".join(dict.fromkeys(values))
            elif f.compare:
                raise ValueError(f"{f.name} must be the same in all records; got {values[0]!r} and others")
        return cls(**fields)

    def to_frame(self):
        """A pandas DataFrame: one row a lane (C order), one column a numeric field."""
        import pandas as pd
        return pd.DataFrame({name.replace(".", "_"): np.broadcast_to(value, self.shape).ravel()
                             for name, value in self.numbers().items()})

    def _summary(self):
        """Values of a single record, those of its parts left out; lowest, median and highest of a population."""
        import pandas as pd
        defaults = {f.name: f.default for f in dataclasses.fields(self)}
        every = {name: value for name, value in self.numbers().items() if "." not in name}
        values = {n: v for n, v in every.items() if np.ndim(v) or v != defaults[n]} or every
        heading = " ".join(filter(None, [type(self).__name__, getattr(self, "name", "")]))
        if len(values) < len(every):
            heading += " (fields at their defaults left out)"
        if not self.shape:
            return heading, pd.DataFrame({"value": pd.Series(values, dtype=object)})
        middle = {name: np.nanquantile(np.asarray(value, float), [0, 0.5, 1], method="closest_observation")
                  if np.size(value) else [np.nan] * 3 for name, value in values.items()}
        return (f"{heading}: {math.prod(self.shape)} lanes",
                pd.DataFrame.from_dict(middle, orient="index", columns=["lowest", "median", "highest"]))
