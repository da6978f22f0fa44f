"""The explorer in a real Chromium: in JupyterLab and as an app served by Voila, by keyboard and by pointer."""

import os
import re

import pytest

pytest.importorskip("playwright")
import browser  # noqa: E402
from axe_playwright_python.base import AXE_SCRIPT  # noqa: E402
from playwright.sync_api import expect  # noqa: E402

import rdk  # noqa: E402
from rdk import catalog  # noqa: E402
from rdk.explorer.controls import MISSION_SPACE, VIEWS  # noqa: E402

if browser.CHROMIUM is None and os.environ.get("CI"):
    pytest.fail("no Chromium on CI", pytrace=False)
pytestmark = pytest.mark.skipif(browser.CHROMIUM is None, reason="no Chromium or Chrome on this machine")

OPEN = """async path => { const app = window.jupyterapp; await app.restored;
    const panel = await app.commands.execute('docmanager:open', {path});
    await panel.context.ready; await panel.sessionContext.ready; await panel.sessionContext.shutdown() }"""
# Moves in the page itself, where what is visible cannot change between the choice and the move; returns how many of a kind.
WALK = """async ([moves, names]) => {
    let seed = 5;
    const random = count => { seed = seed * 48271 % 2147483647; return seed % count };
    const root = document.querySelector('.rdk-explorer'), done = {buttons: 0, menus: 0, keys: 0};
    const visible = what => [...root.querySelectorAll(what)].filter(e => e.offsetParent);
    const keys = ['ArrowRight', 'ArrowLeft', 'PageUp', 'PageDown', 'Home', 'End'];
    for (let i = 0; i < moves; i++) {
        const handles = visible('.noUi-handle'), menus = visible('.widget-dropdown select'), kind = random(100);
        if (kind < 20 || !handles.length) {
            const buttons = visible('button').filter(b => names.includes(b.innerText.trim()));
            buttons[random(buttons.length)].click();
            done.buttons++;
        } else if (kind < 35 && menus.length) {
            const menu = menus[random(menus.length)];
            menu.selectedIndex = random(menu.options.length);
            menu.dispatchEvent(new Event('change', {bubbles: true}));
            done.menus++;
        } else {
            handles[random(handles.length)].dispatchEvent(new KeyboardEvent('keydown',
                {key: keys[random(keys.length)], bubbles: true, cancelable: true}));
            done.keys++;
        }
        await new Promise(f => setTimeout(f, 30));
    }
    return done }"""
ERROR = '[data-mime-type="application/vnd.jupyter.error"]'
RULES = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa"]
KNOWN = {"aria-input-field-name"}  # slider handles have no name: each has a labelled number box beside it
LABELS = {name: variable.label + (f" ({variable.unit})" if variable.unit != "1" else "")
          for name, variable in (rdk.DESIGN_SPACE | MISSION_SPACE).items() if name != "wheel_count"}
SELECTS = {"rover": ["start from", "wheels"], "mission": ["mission", "soil"],
           "search": ["range", "total mass", "slope capability"]}


@pytest.fixture(scope="module")
def chromium():
    with browser.chromium() as found:
        yield found


@pytest.fixture(scope="module")
def lab(tmp_path_factory):
    with browser.lab(tmp_path_factory.mktemp("lab")) as found:
        yield found


@pytest.fixture
def page(chromium):
    page = browser.new_page(chromium)
    yield page
    page.context.close()
    assert not page.problems


@pytest.fixture(scope="module")
def point_design(chromium, lab):
    """The explorer of notebook 06 in JupyterLab, all cells run; one for all tests, since that takes a while."""
    page = browser.new_page(chromium)
    browser.run_all(page, lab, "06_point_design.ipynb")
    assert page.locator(ERROR).count() == 0
    yield shown(page)
    page.context.close()


@pytest.fixture
def in_lab(point_design):
    """The explorer in JupyterLab, at its start."""
    start(point_design)
    yield point_design
    assert point_design.page.locator(ERROR).count() == 0 and not point_design.page.problems


@pytest.fixture
def in_voila(page, tmp_path):
    """The explorer as an app."""
    with browser.voila(tmp_path, "app.ipynb") as address:
        page.goto(address)
        yield shown(page)


def shown(page):
    explorer = page.locator(".rdk-explorer").first
    expect(explorer.locator(".rdk-picture")).to_be_visible()
    explorer.evaluate("e => e.scrollIntoView()")
    return explorer


def button(explorer, name):
    return explorer.get_by_role("button", name=name, exact=True)


def box(explorer, label):
    return explorer.get_by_label(label, exact=True)


def assert_sound(explorer):
    """No error, no blank picture, nothing wider than the screen."""
    expect(explorer.locator('[role="alert"]')).to_have_count(0)
    assert "Error" not in explorer.inner_text()
    pictures = explorer.evaluate("""e => [...e.querySelectorAll('.rdk-picture')].map(i => {
        const canvas = document.createElement('canvas'), [w, h] = [canvas.width, canvas.height] = [60, 40];
        const context = canvas.getContext('2d');
        context.drawImage(i, 0, 0, w, h);
        return [i.complete, i.naturalWidth, new Set(context.getImageData(0, 0, w, h).data).size, i.alt.length]})""")
    assert all(done and width > 400 and shades > 20 and alt > 40 for done, width, shades, alt in pictures), pictures
    wide = explorer.evaluate("""e => { const wide = []; for (let p = e; p; p = p.parentElement)
        if (p.scrollWidth > p.clientWidth + 1 && ['auto', 'scroll'].includes(getComputedStyle(p).overflowX)) wide.push(
            p.className + ' ' + p.scrollWidth + ' ' + p.clientWidth); return wide }""")
    right = explorer.evaluate("e => e.getBoundingClientRect().right")
    assert not wide and right <= browser.WIDTH


def assert_accessible(explorer):
    page = explorer.page
    if not page.evaluate("() => typeof axe !== 'undefined'"):
        page.evaluate(AXE_SCRIPT)
    found = page.evaluate("([scope, rules]) => axe.run(scope, {runOnly: rules})", [".rdk-explorer", RULES])
    assert found["passes"], "axe looked at nothing"
    bad = [(v["id"], v["impact"], [n["html"][:200] for n in v["nodes"]]) for v in found["violations"]
           if v["id"] not in KNOWN]
    assert not bad


def settled(explorer, words):
    """Wait for a sentence or a number among the answers."""
    expect(explorer).to_contain_text(words)


def press_to_both_ends(explorer, labels):
    """Every slider of a page, by keyboard; ends in the middle of nowhere, as a tired student would."""
    for name, variable in (rdk.DESIGN_SPACE | MISSION_SPACE).items():
        if name in labels:
            number = box(explorer, LABELS[name])
            handle = number.locator("xpath=ancestor::div[contains(@class, 'widget-hbox')][1]").locator(".noUi-handle")
            for key, end in ("Home", variable.low), ("End", variable.high):
                handle.press(key)
                expect(number).to_have_value(re.compile(rf"^{end:g}$"))
    expect(explorer.locator(".rdk-waiting")).to_have_count(0)
    assert_sound(explorer)


def choose(explorer, label, index):
    """Choose an option of a menu by its place; returns its text."""
    menu = box(explorer, label)
    texts = menu.locator("option").all_inner_texts()
    menu.select_option(index=index)
    return texts[index]


def choose_first_and_last(explorer, labels):
    for label in labels:
        count = box(explorer, label).locator("option").count()
        for index in (count - 1, 0):
            choose(explorer, label, index)
    assert_sound(explorer)


def start(explorer):
    """Rashid-1 on the mare, by way of another mission: choosing one sets the search, too."""
    button(explorer, "log").click()
    button(explorer, "mission").click()
    for mission in "crater_rim_survey", "equatorial_mare_traverse":
        box(explorer, "mission").select_option(mission)
    button(explorer, "rover").click()
    box(explorer, "start from").select_option("Rashid-1")
    settled(explorer, "16.38 kg")


def search(explorer, population, generations):
    button(explorer, "optimise").click()
    box(explorer, "population").fill(str(population))
    box(explorer, "generations").fill(str(generations))
    box(explorer, "generations").press("Tab")
    button(explorer, "Run").press("Enter")


def weighs(explorer, point):
    """Wait until the read-outs show the mass of a point of the list, which has one digit less."""
    mass = float(re.match(r"\d+:\s([\d.]+)\skg", point)[1])
    explorer.page.wait_for_function("""mass => { const root = document.querySelector('.rdk-explorer');
        return Math.abs(parseFloat(root.innerText.match(/total mass\\s*([\\d.]+)/)[1]) - mass) < 0.051 }""", arg=mass)


def pick_by_keyboard_and_by_pointer(explorer):
    points = explorer.locator(".rdk-points select")
    points.focus()
    points.press("ArrowDown")
    points.press("ArrowDown")
    weighs(explorer, points.locator("option").nth(1).text_content())
    picture = explorer.locator(".rdk-picture")
    expect(picture).to_have_attribute("data-points", re.compile(r"\["))
    explorer.page.wait_for_timeout(500)                  # the picture with the ring, in its place
    spots, width, height = picture.evaluate("i => [JSON.parse(i.dataset.points), i.clientWidth, i.clientHeight]")
    index, right, down = spots[len(spots) // 2 - 1]      # the heaviest, in the left panel
    assert width > 300
    picture.click(position={"x": right * width, "y": down * height})
    expect(points).to_have_js_property("selectedIndex", index)
    weighs(explorer, points.locator("option").nth(index).text_content())
    button(explorer, "rover").click()
    expect(box(explorer, "start from").locator("option:checked")).to_have_text("your own")


def download(explorer, name):
    with explorer.page.expect_download() as found:
        explorer.get_by_role("link", name=name, exact=True).click()
    return found.value.path().read_bytes()


def load(explorer, path):
    with explorer.page.expect_file_chooser() as found:
        explorer.get_by_role("button", name=re.compile("Load a file")).press("Enter")
    found.value.set_files(path)


def keep_and_load(explorer, tmp_path):
    """Download the design, wander off, load it again."""
    button(explorer, "keep").click()
    kept = download(explorer, "design.json")
    design, mission = catalog.from_json(kept.decode())
    front = catalog.from_csv(download(explorer, "front.csv").decode())
    assert len(front) > 3 and mission.name == "equatorial_mare_traverse"
    (tmp_path / "kept.json").write_bytes(kept)
    (tmp_path / "bad.json").write_bytes(kept[:200])
    start(explorer)
    button(explorer, "keep").click()
    load(explorer, tmp_path / "bad.json")
    expect(explorer.locator('[role="alert"]')).to_contain_text("bad.json was not loaded: not a JSON file")
    for _ in range(2):                                   # the same file can be loaded again
        button(explorer, "keep").click()
        load(explorer, tmp_path / "kept.json")
        settled(explorer, "kept.json loaded")
        settled(explorer, f"{rdk.evaluate(design, mission).total_mass_kg:.2f} kg")
        start(explorer)
    assert_sound(explorer)
    return design


def test_every_slider_and_every_menu_by_keyboard(in_lab):
    explorer = in_lab
    expect(box(explorer, "wheel radius (m)")).to_have_value("0.1")
    expect(box(explorer, "peak hub torque (N m)")).to_have_value("0.5")      # not snapped to the slider's grid
    press_to_both_ends(explorer, set(rdk.DESIGN_SPACE) & set(LABELS))
    expect(box(explorer, "start from").locator("option:checked")).to_have_text("your own")
    choose_first_and_last(explorer, SELECTS["rover"])
    assert_accessible(explorer)
    button(explorer, "mission").press("Enter")
    press_to_both_ends(explorer, MISSION_SPACE)
    choose_first_and_last(explorer, SELECTS["mission"])
    assert_accessible(explorer)


def test_every_view(in_lab):
    explorer = in_lab
    box(explorer, "start from").select_option("Pragyan")
    for view in VIEWS:
        button(explorer, view).press("Enter")
        expect(button(explorer, view)).to_have_class(re.compile("mod-active"))
        labels = {"why": ["baseline", "metric"], "sweep": ["along", "and", "metric"], "keep": ["Python for"],
                  "optimise": SELECTS["search"]}.get(view, [])
        if view in ("optimise", "keep"):
            expect(explorer.locator(".rdk-picture")).to_have_count(0)
        else:
            expect(explorer.locator(".rdk-picture")).to_be_visible()
        for label in labels:
            menu = box(explorer, label).locator("visible=true")
            expect(menu).to_be_visible()
            count = menu.locator("option").count()
            for index in (count - 1, 1 if count > 2 else 0):
                menu.select_option(index=index)
        expect(explorer.locator(".rdk-waiting")).to_have_count(0)
        assert_sound(explorer)
        assert_accessible(explorer)
    expect(explorer.locator("textarea")).to_have_value(re.compile("import rdk"))


def test_search_pick_keep_in_jupyterlab(in_lab, tmp_path):
    explorer = in_lab
    search(explorer, 20, 1000)
    expect(button(explorer, "Run")).to_be_disabled()
    settled(explorer, re.compile(r"generation \d+ of 1000"))
    button(explorer, "Cancel").press("Enter")
    settled(explorer, re.compile(r"stopped after generation \d+ of 1000"))
    search(explorer, 20, 5)
    settled(explorer, re.compile(r"done: \d+ designs after 5 generations"))
    assert_sound(explorer)
    pick_by_keyboard_and_by_pointer(explorer)
    assert_accessible(explorer)
    keep_and_load(explorer, tmp_path)


def shown_values(explorer):
    """Design and mission as the number boxes and menus show them."""
    values = {}
    for page, names in (("rover", rdk.DESIGN_SPACE), ("mission", MISSION_SPACE)):
        button(explorer, page).click()
        values |= {name: float(box(explorer, LABELS[name]).input_value()) for name in names if name in LABELS}
        if page == "rover":
            values["wheel_count"] = int(box(explorer, "wheels").locator("option:checked").text_content()[0])
    soil = rdk.soil(box(explorer, "soil").locator("option:checked").text_content())
    design = rdk.Design(**{name: values[name] for name in rdk.DESIGN_SPACE})
    return design, rdk.Scenario(name="shown", soil=soil, **{name: values[name] for name in MISSION_SPACE})


def test_a_random_walk_of_300_moves(in_lab):
    explorer = in_lab
    done = explorer.page.evaluate(WALK, [300, [*VIEWS, "rover", "mission"]])
    assert min(done.values()) > 20, done
    explorer.page.wait_for_timeout(1500)                 # the last moves reach the number boxes
    design, mission = shown_values(explorer)
    button(explorer, "log").click()
    expect(explorer.locator(".rdk-waiting")).to_have_count(0)
    result = rdk.evaluate(design, mission)               # nothing stale is left on the screen
    settled(explorer, f"{result.total_mass_kg:.2f} kg")
    settled(explorer, f"{result.slope_capability_deg:.1f} deg")
    assert_sound(explorer)


def test_the_app_in_voila(in_voila, tmp_path):
    explorer, page = in_voila, in_voila.page
    assert page.locator("text=Traceback").count() == 0 and page.locator(".rdk-explorer").count() == 1
    assert page.locator("code, .jp-InputArea-editor").locator("visible=true").filter(has_text="import rdk").count() == 0
    box(explorer, "wheel radius (m)").locator("xpath=ancestor::div[contains(@class, 'widget-hbox')][1]").locator(
        ".noUi-handle").press("ArrowRight")
    expect(box(explorer, "wheel radius (m)")).to_have_value("0.105")
    for view in VIEWS:
        button(explorer, view).click()
        expect(button(explorer, view)).to_have_class(re.compile("mod-active"))
        expect(explorer.locator(".rdk-waiting")).to_have_count(0)
        assert_sound(explorer)
    start(explorer)
    search(explorer, 20, 4)
    settled(explorer, re.compile(r"done: \d+ designs after 4 generations"))
    pick_by_keyboard_and_by_pointer(explorer)
    keep_and_load(explorer, tmp_path)
    assert_accessible(explorer)


def test_the_live_front_follows_a_key(in_lab):
    explorer = in_lab
    button(explorer, "live front").click()
    title = explorer.locator(".rdk-picture")
    expect(title).to_have_attribute("alt", re.compile("^Front of"))
    for _ in range(3):
        before = title.get_attribute("src")
        box(explorer, "latitude (deg)").press("ArrowUp")
        box(explorer, "latitude (deg)").press("ArrowUp")
        expect(title).not_to_have_attribute("src", before)
    assert_sound(explorer)


def test_every_other_notebook_opens(page, lab):
    """Their cells run in nbval; here they must show: one page, each kernel stopped at once."""
    url, token = lab
    page.goto(f"{url}lab?token={token}&reset")
    page.wait_for_function("() => window.jupyterapp?.shell")
    for path in sorted((browser.REPO / "notebooks").glob("[0-9][0-9]_*.ipynb")):
        page.evaluate(OPEN, f"notebooks/{path.name}")
        expect(page.locator(".jp-NotebookPanel:not(.lm-mod-hidden) h1").first).to_contain_text(path.name[:2])
        assert page.locator(ERROR).count() == 0
