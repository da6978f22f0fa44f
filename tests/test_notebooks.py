"""The form of the committed notebooks: executed, clean, short, linked. nbval compares their outputs."""

import importlib
import re
import statistics
import unicodedata
from pathlib import Path

import nbformat
import pytest

import rdk

REPO = Path(__file__).parents[1]
PATHS = sorted((REPO / "notebooks").glob("[0-9][0-9]_*.ipynb"))
SECTIONS = ["You will be able to", "You need first", "minutes"]
ENDING = ["## Exercises", "## What you learned", "## References"]
MOST_MINUTES = 25  # of reading


def tags(cell):
    return cell.metadata.get("tags", [])


def lines(cell):
    return [line for line in cell.source.splitlines() if line.strip()]


def reading_minutes(notebook):
    """A reader's time without what is folded: 200 words, 60 lines a minute, 15 s an equation, 20 s a picture."""
    cells = [cell for cell in notebook.cells if not {"solution", "check", "appendix"} & set(tags(cell))]
    text = "\n".join(cell.source for cell in cells if cell.cell_type == "markdown")
    equations = re.findall(r"\$\$.+?\$\$", text, re.S)
    words = len(re.sub(r"\$\$.+?\$\$|<[^>]+>|\]\([^)]*\)", " ", text, flags=re.S).split())
    code = sum(len(lines(cell)) for cell in cells if cell.cell_type == "code")
    pictures = sum("image/png" in out.get("data", {}) for cell in cells for out in cell.get("outputs", []))
    return words / 200 + code / 60 + len(equations) / 4 + pictures / 3


def bibliography():
    """(family name of the first author or the name of the organisation, year, DOI) of every entry."""
    for entry in re.split(r"\n(?=@)", (REPO / "data/references.bib").read_text(encoding="utf-8")):
        fields = dict(re.findall(r"^\s*(\w+)\s*=\s*\{(.*)\},?\s*$", entry, re.M))
        if fields:
            who = (fields.get("author") or fields.get("editor")).split(" and ")[0]
            name = re.sub(r"\\[\"'`^~]\{?(\w)\}?", r"\1", who).replace("{", "").replace("}", "").split(",")[0]
            yield name.strip(), fields["year"], fields.get("doi", "").lower()


def stated_minutes(path):
    source = "\n".join(cell.source for cell in nbformat.read(path, as_version=4).cells[:3])
    found = re.search(r"Time:\W*(\d+) minutes", source)
    assert found, f"{path.name} states no 'Time: N minutes' in its first cells"
    return found[1]


@pytest.fixture(params=PATHS, ids=lambda path: path.name)
def path(request):
    return request.param


@pytest.fixture
def notebook(path):
    found = nbformat.read(path, as_version=4)
    nbformat.validate(found)
    return found


@pytest.fixture
def code(notebook):
    return [cell for cell in notebook.cells if cell.cell_type == "code" and cell.source.strip()]


@pytest.fixture
def prose(notebook):
    return "\n\n".join(cell.source for cell in notebook.cells if cell.cell_type == "markdown")


def test_the_collection_is_numbered_in_order():
    assert [path.name[:2] for path in PATHS] == [f"{number:02d}" for number in range(17)]


def test_executed_in_order_and_clean(path, notebook, code):
    assert notebook.metadata.kernelspec.name == "python3" and "widgets" not in notebook.metadata
    assert notebook.metadata.language_info.get("file_extension") == ".py"    # else nbconvert --to script writes .txt
    counts = [cell.execution_count for cell in code]
    assert counts == list(range(1, len(code) + 1)), f"run: python notebooks/execute.py {path.name}"
    for cell in code:
        kinds = [output.output_type for output in cell.outputs]
        assert "error" not in kinds or "raises-exception" in tags(cell), cell.source
        assert "stderr" not in [output.get("name") for output in cell.outputs], cell.source


def test_sources_are_plain_python(code):
    for cell in code:
        assert not re.search(r"^(%%|!)", cell.source, re.M), "a magic: " + cell.source
        assert not cell.source.rstrip().endswith(";"), "nbval ignores ';', use plt.show(): " + cell.source


def test_cells_are_short(code):
    counts = [len(lines(cell)) for cell in code if "solution" not in tags(cell)]
    assert statistics.median(counts) <= 5
    assert sum(count > 15 for count in counts) <= 0.1 * len(counts)
    assert max(counts) <= 25


def test_small_enough_to_open_anywhere(path):
    assert path.stat().st_size < 1_500_000


def test_asserts_something(code):
    assert any(re.search(r"^\s*assert\b", cell.source, re.M) for cell in code if "solution" not in tags(cell))


def test_solutions_are_collapsed_and_check_themselves(code):
    for cell in code:
        if "solution" in tags(cell):
            assert cell.metadata.get("jupyter", {}).get("source_hidden") is True, cell.source
            assert re.search(r"\bassert", cell.source), "a solution shows that it is one: " + cell.source


def test_checks_and_appendices_are_folded(notebook, code):
    for cell in code:
        if "check" in tags(cell):
            assert cell.metadata.jupyter.source_hidden and re.search(r"\bassert|assert_allclose", cell.source)
    appendix = [i for i, cell in enumerate(notebook.cells) if "appendix" in tags(cell)]
    if appendix:                                         # one folded heading hides what follows it, to the next
        first = notebook.cells[appendix[0]]
        assert first.source.startswith("## ") and first.metadata["jp-MarkdownHeadingCollapsed"] is True
        assert appendix == list(range(appendix[0], appendix[-1] + 1))
        assert notebook.cells[appendix[-1] + 1].source.startswith("## ")


def test_every_picture_is_followed_by_words(notebook):
    cells = notebook.cells
    for cell, following in zip(cells, cells[1:] + [None]):
        if any({"image/png", "image/svg+xml"} & set(output.get("data", {})) for output in cell.get("outputs", [])):
            assert following is not None and following.cell_type == "markdown", cell.source


def test_anatomy(path, notebook, prose):
    assert notebook.cells[0].cell_type == "markdown"
    assert re.match(rf"# {path.name[:2]}\b", notebook.cells[0].source), "the title starts with the number"
    assert not [section for section in SECTIONS if section.lower() not in prose.lower()]
    assert [head for head in re.findall(r"^## .+$", prose, re.M) if head in ENDING] == ENDING
    steps = re.findall(r"^## (\d+)\b", prose, re.M)
    assert steps == [str(i + 1) for i in range(len(steps))] and len(steps) >= 3, "numbered steps"


def test_length(path, notebook):
    minutes, stated = reading_minutes(notebook), int(stated_minutes(path))
    assert minutes <= MOST_MINUTES >= stated
    assert 0.75 <= stated / minutes <= 1.5, f"states {stated} minutes, a reader takes about {minutes:.0f}"


def test_no_dead_reference(path, prose):
    steps = set(re.findall(r"^## (\d+)\b", prose, re.M))
    mentioned = re.findall(r"\b[Ss]ections? (\d+)(?:(?:,| and| to) (\d+))?\b(?! of)",
                           prose)  # of this notebook
    assert {number for pair in mentioned for number in pair if number} <= steps
    numbers = {other.name[:2] for other in PATHS}
    assert set(re.findall(r"[Nn]otebooks? (\d\d)\b", prose)) <= numbers
    for name in set(re.findall(r"`rdk((?:\.\w+)+)", prose)):
        thing = rdk
        for part in name.split(".")[1:]:
            assert hasattr(thing, part), f"`rdk{name}`"
            thing = getattr(thing, part)
    for module, name in re.findall(r"`(\w+)\.(\w+)", prose):
        beside, inside = ((REPO / f"{folder}/{module}.py").exists() for folder in ("notebooks", "rdk"))
        if beside or inside and module != "design":      # a design's own fields
            assert hasattr(importlib.import_module(module if beside else f"rdk.{module}"), name), f"`{module}.{name}`"
    assert not [name for name in re.findall(r"`(data/[\w./]+)`", prose) if not (REPO / name).exists()]
    heads = {re.sub(r"[^\w\- ]", "", head).strip().replace(" ", "-")
             for head in re.findall(r"^#+ (.+)$", prose, re.M)}
    assert set(re.findall(r"\]\(#([^)]+)\)", prose)) <= heads


def test_references_are_in_the_bibliography_and_carry_their_doi(prose):
    listed = re.findall(r"^[-*] (.+(?:\n  .+)*)", prose.partition("## References")[2], re.M)
    assert listed
    for reference in listed:
        plain = "".join(c for c in unicodedata.normalize("NFD", reference) if not unicodedata.combining(c))
        dois = [doi for name, year, doi in bibliography() if name in plain and year in plain]
        assert dois, f"not in data/references.bib by first author and year: {reference}"
        assert not all(dois) or any(doi in plain.lower()
                                    for doi in dois), f"its DOI is known, but missing: {reference}"


def test_links_resolve(path, prose):
    targets = re.findall(r"\]\(([^)\s]+)\)", prose)
    local = [target.partition("#")[0] for target in targets if not re.match(r"[a-z]+:|#", target)]
    assert not [target for target in local if not (path.parent / target).exists()]
    at = PATHS.index(path)
    neighbours = {other.name for other in PATHS[max(at - 1, 0):at + 2]} - {path.name}
    assert neighbours <= set(local), "link the previous and the next notebook"


def test_cited_dois_are_in_the_bibliography(prose):
    bibliography = (REPO / "data/references.bib").read_text(encoding="utf-8")
    known = {doi.lower() for doi in re.findall(r"doi\s*=\s*\{([^}]+)\}", bibliography)}
    found = re.findall(r"\b10\.\d{4,9}/(?:\([^\s()]*\)|[^\s)\]>\"`])+", prose)          # some hold (brackets)
    cited = {doi.rstrip(".,;:").lower() for doi in found}
    assert cited <= known, sorted(cited - known)


def test_readme_lists_the_collection_with_its_minutes():
    readme = (REPO / "README.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| \[(\d\d_\w+)\]\(notebooks/\1\.ipynb\) \|.*\| (\d+) \|$", readme, re.M)
    assert rows == [(path.stem, stated_minutes(path)) for path in PATHS]


def test_the_rover_of_the_readme_is_as_the_engine_draws_it():
    rover, mission = rdk.rover("Rashid-1"), rdk.scenario("equatorial_mare_traverse")
    drawn = rdk.figures.rover_picture(rover, rdk.evaluate(rover, mission), mission)
    kept = (REPO / "notebooks/rover.svg").read_text(encoding="utf-8")
    plain = [re.sub("<style>[^<]*</style>", "", picture).strip() for picture in (drawn, kept)]
    assert plain[0] == plain[1], "write the drawing to notebooks/rover.svg again"


def test_the_map_of_the_first_notebook_agrees_with_the_readme():
    cells = nbformat.read(PATHS[0], as_version=4).cells
    chart, = (cell.source for cell in cells if cell.source.startswith("## 5 The map"))
    rows = re.findall(r"^\| \[?(\d\d_\w+)\S* \| (.+) \| (\d+) \|$", chart, re.M)
    readme = (REPO / "README.md").read_text(encoding="utf-8")
    assert rows == re.findall(r"^\| \[(\d\d_\w+)\]\S+ \| (.+) \| (\d+) \|$", readme, re.M) != []


def test_the_guide_lists_every_notebook_and_puts_each_on_the_course():
    guide = (REPO / "notebooks/README.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| \[(\d\d_\w+)\]\(\1\.ipynb\) \| (.+) \|([\d, ]*)\| (\d+) \|$", guide, re.M)
    assert [(name, minutes) for name, _, _, minutes in rows] == [(path.stem, stated_minutes(path))
                                                                 for path in PATHS]
    for name, _, needs, _ in rows:                       # nothing is needed before it has been read
        assert all(needed < name[:2] for needed in needs.strip().split(", ") if needed)
    weeks = guide.partition("| Week |")[2].partition("\n\n")[0]
    assert {target[:2] for target in re.findall(r"\((\d\d_\w+)\.ipynb\)", weeks)} == {path.name[:2]
                                                                                      for path in PATHS}
    for heading in ("Three paths", "What each notebook teaches", "For instructors"):
        assert f"\n## {heading}\n" in guide
    for word in ("An afternoon", "Six weeks", "reviewer's path", "How long", "How to grade", "Binder", "hub",
                 "laptop"):
        assert word in guide


def exercise_minutes(path):
    """The minutes in the headings of a notebook's exercises; half an hour for a small task, none for the capstone."""
    words = {"one": 1, "five": 5, "ten": 10, "fifteen": 15, "twenty": 20, "thirty": 30}
    headings = re.findall(r"^### Exercise \d\d\.\d \((.+)\)$", "\n".join(
        cell.source for cell in nbformat.read(path, as_version=4).cells), re.M)
    return sum(0 if heading == "the design" else words[heading.split()[0]] if "minute" in heading else 30
               for heading in headings)


def test_the_load_of_each_week_is_what_its_notebooks_state():
    guide = (REPO / "notebooks/README.md").read_text(encoding="utf-8")
    weeks = re.findall(r"^\| (\d) \| (.+?) \| (\d+) \| ([\d.]+) \|", guide, re.M)
    assert [week for week, *_ in weeks] == list("123456")
    for week, read, minutes, hours in weeks:
        fixed, chosen = ([REPO / "notebooks" / name for name in re.findall(r"\((\d\d_\w+\.ipynb)\)", part)]
                         for part in read.partition("to choose")[::2])
        reading = {path: int(stated_minutes(path)) for path in fixed + chosen}
        load = {path: 2 * reading[path] + exercise_minutes(path) for path in fixed + chosen}
        total = sum(map(load.get, fixed)) + max(map(load.get, chosen), default=0)
        assert int(minutes) == sum(map(reading.get, fixed)), f"week {week}: minutes of reading"
        assert float(hours) == round(total / 30) / 2, f"week {week}: {total} minutes in all, in half hours"
        assert float(hours) <= 5


def test_the_title_asks_a_question(notebook):
    assert notebook.cells[0].source.splitlines()[0].rstrip().endswith("?")


def test_a_live_picture_is_also_a_still_one_with_its_sentence(code):
    for i, cell in enumerate(code):
        made = re.search(r"^(\w+) = (?:rdk\.)?figures\.live\(", cell.source, re.M)
        if made:
            shown = cell if cell.source.rstrip().endswith(f"\n{made[1]}") else code[i + 1]
            data = [output.data for output in shown.outputs if "image/png" in output.get("data", {})]
            assert data and data[0]["text/plain"].endswith("."), cell.source


def test_departures_point_to_sections_that_exist_and_that_link_to_the_page():
    page = (REPO / "notebooks/departures.md").read_text(encoding="utf-8")
    places = re.findall(r"\]\((\d\d_\w+)\.ipynb\), sections? (\d+)(?: and (\d+))?", page)
    assert len(places) > 25
    for name, *sections in places:
        cells = nbformat.read(REPO / f"notebooks/{name}.ipynb", as_version=4).cells
        prose = "\n\n".join(cell.source for cell in cells if cell.cell_type == "markdown")
        parts = dict(re.findall(r"^## (\d+) (.+?)(?=^## |\Z)", prose, re.M | re.S))
        for section in filter(None, sections):
            assert "(departures.md)" in parts[section], (name, section)
