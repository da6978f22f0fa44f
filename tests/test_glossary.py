"""One set of names and units: the glossary, the code, its docstrings, the data and the notebooks."""

import ast
import csv
import dataclasses
import importlib
import inspect
import re
from functools import cached_property
from pathlib import Path

import nbformat
import pytest

import rdk
import exercises as course
import validation
from rdk import _march, _contact as contact
from rdk import catalog, design, explain, mass, mission, power, report, route, sampling, sky
from rdk import terrain, terramechanics, thermal, tradespace

REPO = Path(__file__).parents[1]
TEXT = (REPO / "notebooks/glossary.md").read_text(encoding="utf-8")
PATHS = sorted((REPO / "notebooks").glob("[0-9][0-9]_*.ipynb"))
CONSTANTS = {row["name"]: row for row in csv.DictReader((REPO / "data/constants.csv").open(encoding="utf-8"))}
RECORDS = {"Design": rdk.Design, "Scenario": rdk.Scenario, "Problem": design.Problem, "Soil": rdk.Soil,
           "Wheel": rdk.Wheel,
           "Model": rdk.Model, "Performance": rdk.Performance, "MassBreakdown": mass.MassBreakdown,
           "TraverseLog": mission.TraverseLog, "Front": tradespace.Front, "Skyline": sky.Skyline,
           "Terrain": terrain.Terrain, "Route": route.Route, "Way": route.Way, "March": route.March}
MODULES = (catalog, contact, course, course.judging, design, explain, mass, mission, power, report,
           route, sampling, sky, terrain, terramechanics, thermal, tradespace, validation)
SUFFIXES = {
    "_m": "m", "_mm": "mm", "_km": "km", "_m2": "m2", "_kg": "kg", "_n": "N", "_nm": "N m", "_pa": "Pa",
    "_kpa": "kPa",
    "_deg": "deg", "_rad": "rad", "_h": "h", "_earth_days": "Earth days", "_w": "W", "_wh": "Wh", "_k": "K",
    "_c": "degC", "_j": "J",
    "_pct": "%", "_m_s": "m/s", "_rad_s": "rad s-1", "_m_s2": "m s-2", "_w_m2": "W m-2", "_kg_m2": "kg m-2",
    "_kg_m3": "kg m-3", "_kg_nm": "kg N-1 m-1", "_kg_w": "kg W-1", "_wh_kg": "Wh kg-1",
    "_kn_m_n1": "kN/m^(n+1)",
    "_kn_m_n2": "kN/m^(n+2)"}
WORDS = {"m": "m", "metres": "m", "mm": "mm", "km": "km", "m2": "m2", "kg": "kg", "newtons": "N", "n": "N",
         "n m": "N m", "pa": "Pa",
         "kpa": "kPa", "degrees": "deg", "radians": "rad", "hours": "h", "w": "W", "wh": "Wh", "kelvin": "K",
         "degrees celsius": "degC", "percent": "%", "w/m2": "W m-2", "kn/m^(n+1)": "kN/m^(n+1)",
         "kn/m^(n+2)": "kN/m^(n+2)", "wh/kg": "Wh kg-1", "m/s": "m/s"}


def tables():
    """{heading: [cells of each row]} of the glossary."""
    found = {}
    for part in TEXT.split("\n## ")[1:]:
        heading, _, body = part.partition("\n")
        rows = [[cell.strip() for cell in line.strip("|\n ").split(" | ")] for line in body.splitlines()
                if line.startswith("| ")]
        found[heading] = [[*row, ""][:5] if len(row) < 4 else row for row in rows[1:]]
    return found


def unit_of(name):
    """The unit that the suffix of a name says, or None."""
    ending = max((suffix for suffix in SUFFIXES if name.endswith(suffix)), key=len, default=None)
    return SUFFIXES.get(ending)


TABLES = tables()
ENTRIES = [(heading, row[0].strip("`"), *row[1:]) for heading, rows in TABLES.items()
           if heading not in ("Words", "Equations", "The kernel") for row in rows]
NAMES = {name for _, name, *_ in ENTRIES}


def plain(symbol):
    """A symbol without its LaTeX: letters and digits only."""
    return re.sub(r"mathrm|[^A-Za-z0-9]", "", symbol).replace("epsilon", "eps")


# ---- the glossary and the code -----------------------------------------------------------------------------

@pytest.mark.parametrize("heading", RECORDS)
def test_a_record_has_every_field_in_the_glossary_and_the_glossary_no_other(heading):
    record = RECORDS[heading]
    public = [f.name for f in dataclasses.fields(record)]
    public += [name for kind in record.__mro__ if kind.__module__ != "rdk._fields"
               for name, value in vars(kind).items() if isinstance(value, (property, cached_property))]
    listed = [row[0].strip("`") for row in TABLES[heading]]
    assert sorted(listed) == sorted(public) and len(set(listed)) == len(listed)


def test_forces_and_stresses_are_in_the_glossary():
    kinds = terramechanics.WheelForces, terramechanics.SlipBalance, terramechanics.ContactStress
    listed = {row[0].strip("`") for row in TABLES["WheelForces, SlipBalance and ContactStress"]}
    assert listed == {name for kind in kinds for name in kind._fields}


@pytest.mark.parametrize("heading, name, symbol, unit, meaning", [(*e, "")[:5] for e in ENTRIES])
def test_the_unit_is_the_one_that_the_suffix_says(heading, name, symbol, unit, meaning):
    said = unit_of(name)
    if said is None:
        assert unit in ("", "1", "true or false")
    else:
        assert unit == said or name == "enclosure_area_coefficient_m2" and unit == "m2 kg-2/3"


def test_flags_and_only_flags_are_true_or_false():
    result = rdk.evaluate(rdk.rover("Rashid-1"), rdk.scenario("equatorial_mare_traverse"))
    records = {"Performance": result, "TraverseLog": result.log, "MassBreakdown": result.mass}
    for heading, record in records.items():
        for row in TABLES[heading]:
            kind = type(getattr(record, row[0].strip("`")))
            if heading != "TraverseLog":
                assert (kind is bool) == (row[2] == "true or false"), row
    assert result.log.throttled.dtype == bool


@pytest.mark.parametrize("name, symbol, unit, meaning",
                         [row for row in TABLES["Model"] if row[0] not in ("`kernel`", "`transition`")])
def test_coefficients_read_as_in_the_data(name, symbol, unit, meaning):
    row = CONSTANTS[name.strip("`")]
    assert (unit, meaning) == (row["unit"], row["quantity"]) and plain(symbol) == plain(row["symbol"])


@pytest.mark.parametrize("name, variable", rdk.DESIGN_SPACE.items())
def test_design_variables_read_as_in_the_design_space(name, variable):
    row, = (row for row in TABLES["Design"] if row[0] == f"`{name}`")
    assert row[2] == variable.unit and plain(row[1]).startswith(plain(variable.symbol))


def test_the_kernels_symbols_and_their_public_names_exist():
    source = "\n".join(inspect.getsource(module) for module in (terramechanics, contact))
    used = {node.id for node in ast.walk(ast.parse(source)) if isinstance(node, ast.Name)}
    used |= {node.name for node in ast.walk(ast.parse(source)) if isinstance(node, ast.FunctionDef)}
    used |= {node.arg for node in ast.walk(ast.parse(source)) if isinstance(node, ast.arg)}
    for name, _, _, meaning in TABLES["The kernel"]:
        assert name.strip("`") in used | {"theta", "omega", "z"}, name
        assert not [public for public in re.findall(r"`(\w+)`", meaning)
                    if public not in NAMES | used], meaning
    assert {"theta", "z"} <= used and "omega" in inspect.getsource(_march)


def test_equations_carry_their_names_in_the_code():
    rows = TABLES["Equations"]
    assert [row[0] for row in rows] == [str(i + 1) for i in range(21)]   # the paper numbers 21
    named = set()
    for _, name, _, modules, notebook in rows:
        for module in re.findall(r"`(\w+)`", modules):
            source = inspect.getsource(importlib.import_module(f"rdk.{module}"))
            assert f"eq. {name.strip('`')}" in source, f"{module} has no comment 'eq. {name}'"
        named.add(name.strip("`"))
    for module in MODULES:
        assert set(re.findall(r"\beq\. ([a-z][a-z-]+)", inspect.getsource(module))) <= named


# ---- docstrings --------------------------------------------------------------------------------------------

def documented(text):
    """(names, description) of every entry `name, name : type` of a numpydoc docstring."""
    lines = inspect.cleandoc(text or "").splitlines()
    for i, line in enumerate(lines):
        entry = re.fullmatch(r"( *)([\w, .]+?) : .+", line)
        if entry:
            body = []
            for following in lines[i + 1:]:
                if following.strip() and not following.startswith(entry[1] + " "):
                    break
                body.append(following.strip())
            yield re.findall(r"\w+", entry[2]), " ".join(body)


def contradictions(text):
    """Units that a docstring states "in ..." but no name of its entry carries."""
    for names, description in documented(text):
        units = {unit_of(name) for name in names} - {None}
        stated = re.findall(r"\b[Ii]n (degrees Celsius|N m\b|[A-Za-z]\S*)", description)
        stated = {WORDS[word.lower().rstrip(".,;:")] for word in stated
                  if word.lower().rstrip(".,;:") in WORDS}
        if units and not stated <= units:
            yield names, stated - units


def test_the_check_of_docstrings_can_fail():
    assert not list(contradictions("Parameters\n---\nradius_m, width_m : float\n    In metres, positive."))
    assert list(contradictions("Parameters\n---\nradius_m : float\n    In mm."))
    assert list(contradictions("x\n\nReturns\n---\nangle_deg : float\n    Angle in\n    radians."))


@pytest.mark.parametrize("module", MODULES, ids=lambda module: module.__name__)
def test_docstrings_state_the_units_of_the_names(module):
    checked = 0
    for name, thing in vars(module).items():
        ours = getattr(thing, "__module__", None) == module.__name__
        if ours and (inspect.isfunction(thing) or inspect.isclass(thing)):
            assert not list(contradictions(thing.__doc__)), name
            checked += 1
            if dataclasses.is_dataclass(thing):          # an entry for a field that is gone would mislead
                fields = {f.name for f in dataclasses.fields(thing)} | set(dir(thing))
                for names, _ in documented(thing.__doc__):
                    assert set(names) <= fields, (name, names)
    assert checked


# ---- the notebooks -----------------------------------------------------------------------------------------

def known_names():
    """Every identifier that rdk, its data and the glossary know."""
    found = set(NAMES)
    for path in [*(REPO / "rdk").rglob("*.py"), *(REPO / "notebooks").glob("*.py")]:
        found |= set(re.findall(r"\w+", path.read_text(encoding="utf-8")))
    for path in (REPO / "data").glob("*.csv"):
        found |= set(re.findall(r"\w+", path.read_text(encoding="utf-8")))
    return found


KNOWN = known_names()


def own_names(tree):
    """Names that the notebook's own code makes: variables, functions, arguments, keys of its dictionaries."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            yield node.id
        elif isinstance(node, (ast.FunctionDef, ast.arg)):
            yield getattr(node, "name", None) or node.arg
        elif isinstance(node, ast.Call):                 # columns: frame.assign(...), dict(...)
            called = getattr(node.func, "attr", getattr(node.func, "id", ""))
            if called in ("assign", "dict", "DataFrame", "agg"):
                yield from (keyword.arg for keyword in node.keywords if keyword.arg)
        elif isinstance(node, ast.Subscript) and isinstance(node.ctx, ast.Store):    # frame["new"] = ...
            yield getattr(node.slice, "value", "")
        elif isinstance(node, ast.Dict):
            yield from (key.value for key in node.keys if isinstance(key, ast.Constant)
                        and isinstance(key.value, str))


@pytest.mark.parametrize("path", PATHS, ids=lambda path: path.name)
def test_notebooks_use_names_that_exist(path):
    notebook = nbformat.read(path, as_version=4)
    tree = ast.parse("\n".join(cell.source for cell in notebook.cells if cell.cell_type == "code"))
    known = KNOWN | set(own_names(tree))
    used = {node.attr for node in ast.walk(tree) if isinstance(node, ast.Attribute)}
    used |= {word.arg for node in ast.walk(tree) if isinstance(node, ast.Call) for word in node.keywords
             if word.arg}
    used |= {node.value for node in ast.walk(tree) if isinstance(node, ast.Constant)
             and isinstance(node.value, str)}
    for cell in notebook.cells:
        if cell.cell_type == "markdown":
            used |= set(re.findall(r"`(?:\w+\.)*(\w+)`", cell.source))
    with_unit = {name for name in used if re.fullmatch(r"[a-z]\w*", name) and "_" in name and unit_of(name)}
    # names that rdk puts together, such as f"{x}_error_pct"
    endings = tuple(name for name in KNOWN if name.startswith("_") and unit_of(name) and len(name) > 6)
    assert not [name for name in with_unit - known if not name.endswith(endings)]


@pytest.mark.parametrize("path", PATHS, ids=lambda path: path.name)
def test_numbered_equations_are_those_of_the_paper(path):
    prose = "\n".join(cell.source for cell in nbformat.read(path, as_version=4).cells
                      if cell.cell_type == "markdown")
    named = {(row[0], row[1].strip("`")): row[4] for row in TABLES["Equations"]}
    here = set(re.findall(r"Eq\. (\d+)(?: \(|, )`([\w-]+)`", prose))
    assert here <= set(named)
    assert {equation for equation, chapter in named.items() if chapter == path.name[:2]} <= here
    assert not re.search(r"\beq\. [a-z]", prose), "equations have numbers"


@pytest.mark.parametrize("word, meaning, notebooks", [row[:3] for row in TABLES["Words"]])
def test_words_are_explained_where_the_glossary_says(word, meaning, notebooks):
    for number in notebooks.split(", "):
        path, = (path for path in PATHS if path.name.startswith(number))
        prose = "\n".join(c.source for c in nbformat.read(path, as_version=4).cells
                          if c.cell_type == "markdown").lower()
        for name in word.lower().split(", "):
            assert name.replace("-", " ") in prose.replace("-", " "), (name, path.name)


def test_links_of_the_glossary_resolve():
    heads = {re.sub(r"[^\w\- ]", "", head).strip().replace(" ", "-").lower()
             for head in re.findall(r"^#+ (.+)$", TEXT, re.M)}
    for target in re.findall(r"\]\(([^)\s]+)\)", TEXT):
        page, _, anchor = target.partition("#")
        assert (REPO / "notebooks" / page).exists() if page else anchor in heads, target
