"""The explorer in a real Chromium: in JupyterLab and as an app served by Voila, by keyboard and by pointer."""

import os
import re
from urllib.parse import parse_qsl

import pytest

pytest.importorskip("playwright")
import browser  # noqa: E402
from axe_playwright_python.base import AXE_SCRIPT  # noqa: E402
from playwright.sync_api import expect  # noqa: E402

import rdk  # noqa: E402
from rdk import catalog  # noqa: E402
from rdk.explorer.inputs import DESIGN, MISSION, NUMBERS, SOIL, VIEWS  # noqa: E402

if browser.CHROMIUM is None and os.environ.get("CI"):
    pytest.fail("no Chromium on CI", pytrace=False)
expect.set_options(timeout=60_000)                       # states are awaited, however busy the machine is
pytestmark = pytest.mark.skipif(browser.CHROMIUM is None, reason="no Chromium or Chrome on this machine")

OPEN = """async path => { const app = window.jupyterapp; await app.restored;
    const panel = await app.commands.execute('docmanager:open', {path});
    await panel.context.ready; await panel.sessionContext.ready; await panel.sessionContext.shutdown() }"""
RESTART = "async () => { await window.jupyterapp.shell.currentWidget.sessionContext.session.kernel.restart() }"
# Moves in the page itself, where what is visible cannot change between choice and move; returns how many of a kind.
WALK = """async ([moves, texts]) => {
    let seed = 5;
    const random = count => { seed = seed * 48271 % 2147483647; return seed % count };
    const root = document.querySelector('.rdk-explorer'), done = {buttons: 0, menus: 0, sliders: 0, texts: 0};
    const visible = what => [...root.querySelectorAll(what)].filter(e => e.offsetParent && !e.disabled);
    const tell = (e, kind) => e.dispatchEvent(new Event(kind, {bubbles: true}));
    root.querySelectorAll('.rdk-more').forEach(d => d.open = true);
    for (let i = 0; i < moves; i++) {
        const kind = random(100);
        if (kind < 25) {
            const all = visible('[role=tab], [data-do=undo], [data-do=redo], [data-do=pin], [data-do^=unpin],'
                                + '[data-do^=use], [data-do^=lever], [data-name]');
            all[random(all.length)].click(); done.buttons++;
        } else if (kind < 40) {
            const all = visible('select'), menu = all[random(all.length)];
            menu.selectedIndex = random(menu.options.length); tell(menu, 'change'); done.menus++;
        } else if (kind < 50) {
            const all = visible('.rdk-box'), box = all[random(all.length)];
            box.value = texts[random(texts.length)]; tell(box, 'change'); done.texts++;
        } else {
            const all = visible('[type=range]'), slider = all[random(all.length)];
            slider.value = +slider.min + random(slider.max - slider.min + 1); tell(slider, 'input'); done.sliders++;
        }
        await new Promise(f => setTimeout(f, 25));
    }
    return done }"""
ERROR = '[data-mime-type="application/vnd.jupyter.error"]'
RULES = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa"]
LABELS = {name: field.label + (f" ({field.unit})" if field.unit else "") for name, field in NUMBERS.items()}


@pytest.fixture(scope="module")
def chromium():
    with browser.chromium() as found:
        yield found


@pytest.fixture(scope="module")
def lab(tmp_path_factory):
    with browser.lab(tmp_path_factory.mktemp("lab")) as found:
        yield found


@pytest.fixture(scope="module")
def app(tmp_path_factory):
    with browser.voila(tmp_path_factory.mktemp("app"), "app.ipynb") as found:
        yield found


@pytest.fixture
def page(chromium):
    page = browser.new_page(chromium)
    yield page
    page.context.close()
    assert not page.problems


@pytest.fixture(scope="module")
def served(chromium, app):
    """The app, one for most tests, since it takes a while to start."""
    page = browser.new_page(chromium)
    page.goto(app)
    yield shown(page)
    page.context.close()


@pytest.fixture
def explorer(served):
    """The app at its start."""
    served.page.set_viewport_size({"width": browser.WIDTH, "height": browser.HEIGHT})
    served.evaluate("e => e.querySelectorAll('details').forEach(d => d.open = false)")
    view(served, "Mission log")
    tab(served, "mission")
    for mission in MARE, "polar_prospecting":
        served.locator('select[data-in="mission"]').select_option(mission)
    tab(served, "rover")
    served.locator('select[data-in="rover"]').select_option("Rashid-1")
    expect(served).to_contain_text("Drives 13.7 of 30 km")
    settled(served)
    yield served
    assert not served.page.problems


MARE = "equatorial_mare_traverse"


def shown(page):
    explorer = page.locator(".rdk-explorer").first
    expect(explorer.locator(".rdk-pictures").first).to_be_visible()
    expect(explorer.locator('[data-view="log"]')).to_have_attribute("aria-selected", "true")
    fitted(explorer)
    return explorer


def tab(explorer, name):
    explorer.locator(f'[data-tab="{name}"]').click()


def view(explorer, name):
    explorer.get_by_role("tab", name=name, exact=True).click()
    settled(explorer)


def button(explorer, name):
    return explorer.get_by_role("button", name=name, exact=True)


def box(explorer, name):
    return explorer.locator(f'.rdk-box[data-in="{name}"]')


def settled(explorer):
    """No answer is awaited, nothing is dimmed."""
    expect(explorer.locator(".rdk-waiting, .rdk-old")).to_have_count(0)


def fitted(explorer):
    """The picture has the size of its place, and nothing is awaited."""
    explorer.page.wait_for_function("""() => { const place = document.querySelector('.rdk-picture'),
        all = [...place.querySelectorAll('.rdk-pictures > *')], room = Math.max(place.clientWidth - 24, 300);
        const wide = all.map(e => +e.getAttribute('width') || parseFloat(e.style.width) + 60);
        return all.length && Math.abs(wide.reduce((a, b) => a + b + 14) - room) < 2 }""")
    settled(explorer)


def assert_sound(explorer):
    """No error, no blank picture, nothing wider than the page, no text cut off by its picture."""
    assert "Error" not in explorer.inner_text() and "nan" not in explorer.locator(".rdk-verdict").inner_text()
    found = explorer.evaluate("""e => ({
        texts: [...e.querySelectorAll(':is(.rdk-picture, .rdk-side) svg[aria-label]')].map(
            s => s.querySelectorAll('text').length),
        cut: [...e.querySelectorAll('.rdk-picture svg[aria-label] > :is(text, g > text)')].filter(t => {
            const a = t.getBoundingClientRect(), b = t.ownerSVGElement.getBoundingClientRect();
            return a.width && (a.left < b.left - 2 || a.right > b.right + 2 || a.top < b.top - 2
                               || a.bottom > b.bottom + 2) }).map(t => t.textContent),
        wide: document.documentElement.scrollWidth - innerWidth})""")
    assert all(count > 1 for count in found["texts"]) and found["texts"], found
    assert not found["cut"] and found["wide"] <= 0, found


def assert_accessible(explorer):
    page = explorer.page
    if not page.evaluate("() => typeof axe !== 'undefined'"):
        page.evaluate(AXE_SCRIPT)
    found = page.evaluate("([scope, rules]) => axe.run(scope, {runOnly: rules})", [".rdk-explorer", RULES])
    assert found["passes"], "axe looked at nothing"
    assert not [(v["id"], v["impact"], [n["html"][:200] for n in v["nodes"]]) for v in found["violations"]]


def test_every_view_is_whole_and_accessible_at_three_sizes_and_in_dark(explorer):
    for name in VIEWS.values():
        view(explorer, name)
        for width, height in (1920, 1080), (1280, 800), (390, 844):
            explorer.page.set_viewport_size({"width": width, "height": height})
            fitted(explorer)
            assert_sound(explorer)
        assert_accessible(explorer)
        explorer.page.set_viewport_size({"width": browser.WIDTH, "height": browser.HEIGHT})
    for scheme, forced in ("dark", "none"), ("light", "active"), ("light", "none"):
        explorer.page.emulate_media(color_scheme=scheme, forced_colors=forced)
        assert_accessible(explorer)
    tab(explorer, "mission")
    assert_accessible(explorer)


def test_the_answer_is_in_sight(explorer):
    page = explorer.page
    for width, height, parts in ((1280, 800, ".rdk-say1, .rdk-card, .rdk-picture svg[aria-label], .rdk-side "
                                  "svg[aria-label], .rdk-tray, .rdk-left .rdk-row >> nth=0"),
                                 (390, 844, ".rdk-say1, .rdk-card >> nth=0")):
        page.set_viewport_size({"width": width, "height": height})
        fitted(explorer)
        if width > 500:
            page.wait_for_function("document.querySelector('#rendered_cells').scrollHeight <= innerHeight")
        for part in parts.split(", "):
            for found in explorer.locator(part).locator("visible=true").all()[:5]:
                bounds = found.bounding_box()
                assert 0 <= bounds["y"] and bounds["y"] + bounds["height"] <= height, (width, part, bounds)
        crowded = """e => [...e.querySelectorAll('.rdk-help i')].filter(i => i.offsetParent
            && i.getBoundingClientRect().right > i.closest('.rdk-row').children[1].getBoundingClientRect().left)
            .map(i => i.parentNode.textContent)"""
        assert not explorer.evaluate(crowded), width     # the sign for help beside its slider, not on it
    explorer.locator(".rdk-tray").scroll_into_view_if_needed()               # far down on a phone
    assert 0 <= explorer.locator(".rdk-say1").bounding_box()["y"] < 50
    explorer.get_by_role("button", name="pin the present design").click()
    explorer.get_by_role("button", name="Table of differences").click()
    drawer = explorer.locator(".rdk-drawer section")
    drawer.wait_for()
    page.wait_for_function("e => { const {top, bottom} = e.getBoundingClientRect();"
                           " return top > 0 && bottom <= innerHeight; }", arg=drawer.element_handle())
    drawer.get_by_role("button", name="Close").click()
    explorer.get_by_role("button", name="remove A").click()
    expect(explorer.get_by_role("button", name="remove A")).to_have_count(0)


def test_by_keyboard_alone(explorer):
    slider = explorer.get_by_label("radius slider")
    slider.focus()
    for _ in range(5):
        slider.press("ArrowRight")
    expect(box(explorer, "wheel_radius_m")).to_have_value("105")
    expect(slider).to_have_attribute("aria-valuetext", "105 mm")
    expect(explorer.locator('select[data-in="rover"]')).to_have_value("your own")
    number = box(explorer, "wheel_width_m")
    number.fill("95,5")
    number.press("Enter")
    result = rdk.evaluate(rdk.rover("Rashid-1").replace(wheel_radius_m=0.105, wheel_width_m=0.0955),
                          rdk.scenario("polar_prospecting"))
    expect(explorer.locator(".rdk-card").nth(1)).to_contain_text(f"{result.total_mass_kg:.1f}")
    number.fill("900")
    number.press("Enter")
    expect(explorer.locator(".rdk-drawer")).to_contain_text("width 900 cut to 200 mm")
    expect(number).to_have_value("200")
    expect(number).to_be_focused()
    for width in "95.5", "80":
        button(explorer, "↶ Undo").press("Enter")
        expect(number).to_have_value(width)
    button(explorer, "↶ Undo").press("Enter")
    expect(box(explorer, "wheel_radius_m")).not_to_have_value("105")
    explorer.locator('[data-view="log"]').focus()
    explorer.page.keyboard.press("ArrowRight")
    expect(explorer.locator('[data-view="mass"]')).to_have_attribute("aria-selected", "true")
    expect(explorer.locator('[data-view="mass"]')).to_be_focused()
    expect(explorer.locator(".rdk-picture svg").first).to_have_attribute("aria-label", re.compile("^Bars of mass"))
    lever = explorer.locator('[data-do^="lever:"]').first
    lever.press("Enter")
    settled(explorer)
    explorer.page.wait_for_function("document.activeElement !== document.body")
    number.fill("90")                                    # what was pressed before does not take the focus back
    number.press("Enter")
    number.evaluate("e => e.blur()")
    settled(explorer)
    assert explorer.page.evaluate("document.activeElement === document.body")


def test_ends_of_every_slider(explorer):
    explorer.evaluate("e => e.querySelectorAll('.rdk-more').forEach(d => d.open = true)")
    for name in (*DESIGN, *MISSION, *SOIL):
        tab(explorer, "rover" if name in DESIGN else "mission")
        slider = explorer.locator(f'[type=range][data-in="{name}"]')
        for key, end in ("Home", NUMBERS[name].low), ("End", float("inf") if NUMBERS[name].endless
                                                      else NUMBERS[name].high):
            slider.press(key)
            expect(box(explorer, name)).to_have_value(NUMBERS[name].words(end))
    settled(explorer)
    assert_sound(explorer)


def test_search_and_pick_by_pointer_and_by_keyboard(explorer):
    view(explorer, "Optimise")
    explorer.locator(".rdk-views .rdk-more").evaluate("e => e.open = true")
    for name, value in ("population", "400"), ("generations", "1000"):    # long enough to cancel
        box(explorer, name).fill(value)
        box(explorer, name).press("Enter")
    explorer.locator(".rdk-views").get_by_role("button", name="Run search").click()
    expect(explorer.locator('[data-text="status"]')).to_contain_text(re.compile(r"generation \d+ of 1000"))
    button(explorer, "Cancel").click()
    expect(explorer.locator('[data-text="status"]')).to_contain_text("stopped after generation")
    explorer.locator(".rdk-views .rdk-more").evaluate("e => e.open = true")      # a press elsewhere folded it away
    for name, value in ("population", "20"), ("generations", "6"):
        box(explorer, name).fill(value)
        box(explorer, name).press("Enter")
    explorer.locator(".rdk-views").get_by_role("button", name="Run search").press("Enter")
    expect(explorer.locator('[data-text="status"]')).to_contain_text(re.compile(r"done: \d+ designs after 6 "
                                                                                r"generations"))
    settled(explorer)
    dots = explorer.locator(".rdk-pick")
    assert dots.count() > 3
    for dot, act in (dots.last, lambda d: d.click()), (dots.first, lambda d: (d.focus(),
                                                                              explorer.page.keyboard.press("Enter"))):
        mass = re.search(r"mass ([\d.]+)", dot.get_attribute("aria-label"))[1]
        act(dot)
        expect(explorer.locator(".rdk-card").nth(1)).to_contain_text(f"{float(mass):.1f}")
        settled(explorer)
    expect(explorer.locator('select[data-in="rover"]')).to_have_value("your own")
    tab(explorer, "mission")
    explorer.locator('select[data-in="mission"]').select_option(MARE)
    expect(explorer.locator(".rdk-picture")).to_contain_text("run again")
    assert_sound(explorer)


def test_pin_compare_save_and_open(explorer, tmp_path):
    button(explorer, "+ pin the present design").click()
    box(explorer, "wheel_radius_m").fill("130")
    box(explorer, "wheel_radius_m").press("Enter")
    expect(explorer.locator(".rdk-pin")).to_contain_text("A Rashid-1")
    button(explorer, "Table of differences").click()
    expect(explorer.locator(".rdk-drawer")).to_contain_text("100 mm")
    for name, words in ("design.json", "Design (json)"), ("report.html", "Report (one page)"):
        explorer.get_by_text("Save", exact=True).click()
        with explorer.page.expect_download() as found:
            button(explorer, words).click()
        (tmp_path / name).write_bytes(found.value.path().read_bytes())
    design, mission = catalog.from_json((tmp_path / "design.json").read_text(encoding="utf-8"))
    assert design == rdk.rover("Rashid-1").replace(wheel_radius_m=0.13) and mission.name == "polar_prospecting"
    assert "Candidates" in (tmp_path / "report.html").read_text(encoding="utf-8")
    (tmp_path / "bad.json").write_text("{")
    explorer.locator('select[data-in="rover"]').select_option("Pragyan")
    for name, words in ("bad.json", "was not loaded"), ("design.json",
                                                        "design.json loaded"), ("design.json", "design.json loaded"):
        with explorer.page.expect_file_chooser() as chooser:
            button(explorer, "Open").click()
        chooser.value.set_files(tmp_path / name)
        expect(explorer.locator(".rdk-drawer")).to_contain_text(words)
    expect(box(explorer, "wheel_radius_m")).to_have_value("130")
    button(explorer, "Python").click()
    expect(explorer.locator("pre")).to_contain_text("import rdk")
    button(explorer, "Close").click()
    button(explorer, "remove A").click()
    expect(explorer.locator(".rdk-pin")).to_have_count(0)


def test_a_reload_loses_nothing(page, app):
    page.goto(app + "?rover=Pragyan&mission=polar_prospecting&wheel_radius_m=0.12&view=mass")
    explorer = page.locator(".rdk-explorer").first
    expect(box(explorer, "wheel_radius_m")).to_have_value("120")
    box(explorer, "battery_capacity_wh").fill("77")
    box(explorer, "battery_capacity_wh").press("Enter")
    expect(page).to_have_url(re.compile("battery_capacity_wh=77"))
    tab(explorer, "mission")
    explorer.locator("summary", has_text="site and date").click()
    explorer.locator('select[data-in="site"]').select_option("shackleton_rim")
    box(explorer, "start_utc").evaluate("""(box, texts) => texts.forEach(text => {
        box.value = text; box.dispatchEvent(new Event('change', {bubbles: true})); })""",
                                        ["2026-11-26T12:00", "soon"])        # the second before the first is answered
    expect(explorer.locator(".rdk-drawer")).to_contain_text("must be UTC in ISO form")
    expect(box(explorer, "start_utc")).to_have_value("2026-11-26T12:00")
    expect(box(explorer, "latitude_deg")).to_have_value("-89.78")
    expect(page).to_have_url(re.compile("start_utc=2026"))
    page.reload()
    expect(box(explorer, "battery_capacity_wh")).to_have_value("77")
    expect(box(explorer, "start_utc")).to_have_value("2026-11-26T12:00")
    expect(explorer.locator('select[data-in="site"]')).to_have_value("shackleton_rim")
    expect(explorer.locator(".rdk-picture svg").first).to_have_attribute("aria-label", re.compile("^Bars of mass"))


def test_a_random_walk_of_300_moves(explorer):
    done = explorer.page.evaluate(WALK, [300, ["12", "0,5", "1e3", "none", "wide", "-4"]])
    assert min(done.values()) > 15, done
    view(explorer, "Mission log")
    explorer.page.wait_for_function("""() => location.search.slice(1) === JSON.parse(
        document.querySelector('[data-state]').dataset.state).t.share""")
    state = dict(parse_qsl(explorer.page.evaluate("location.search").lstrip("?")))
    values = {name: float(box(explorer,
                              name).evaluate("e => e.value === 'none' ? Infinity : e.value")) / NUMBERS[name].factor
              for name in (*DESIGN, *MISSION, *SOIL)}
    wheels = int(explorer.locator('[data-name="wheel_count"][aria-pressed="true"]').get_attribute("data-value"))
    design = rdk.Design(wheel_count=wheels, **{name: values[name] for name in DESIGN})
    mission = rdk.Scenario(name="shown", soil=rdk.Soil(**{name: values[name] for name in SOIL}),
                           **{name: values[name] for name in MISSION})
    coefficients = {name: float(state[name]) for name in ("hub_no_load_speed_rad_s", "drivetrain_efficiency",
                                                   "panel_efficiency", "growth_fraction")
                    if name in state}
    base = rdk.Model.engineering() if state.get("preset") == "engineering" else rdk.Model()
    result = rdk.evaluate(design, mission, model=base.replace(**coefficients))
    for card, value in ((1, result.total_mass_kg), (2, result.slope_capability_deg)):        # nothing stale is left
        number = explorer.locator(".rdk-card").nth(card).inner_text().split("\n")[-3 if card == 1 else 2]
        assert f"{value:.1f}" in explorer.locator(".rdk-card").nth(card).inner_text(), number
    assert_sound(explorer)


def test_a_lost_connection_says_so(page, app):
    page.goto(app)
    explorer = shown(page)
    settled(explorer)
    page.evaluate("""() => { const plain = WebSocket.prototype.send; WebSocket.prototype.send = () => {};
        const wait = window.setTimeout;
        window.setTimeout = (f, ms, ...more) => wait(f, ms === 8000 ? 300 : ms, ...more); }""")
    explorer.get_by_label("radius slider").press("ArrowRight")
    expect(explorer.locator(".rdk-gone")).to_be_visible()
    expect(explorer.locator(".rdk-gone")).to_contain_text("Reload the page")


def test_jupyterlab_a_kernel_that_restarts_and_other_notebooks(page, lab):
    browser.run_all(page, lab, "app.ipynb")
    assert page.locator(ERROR).count() == 0
    explorer = shown(page)
    explorer.evaluate("e => e.scrollIntoView()")
    slider = explorer.get_by_label("radius slider")
    slider.focus()
    slider.press("ArrowRight")
    expect(box(explorer, "wheel_radius_m")).to_have_value("101")
    number = box(explorer, "wheel_width_m")
    number.fill("85")                                    # JupyterLab's shortcuts must not take the keys
    number.press("Enter")
    expect(explorer.locator('[data-text="share"]').first).to_contain_text("wheel_width_m=0.085")
    settled(explorer)
    assert_sound(explorer)
    assert_accessible(explorer)
    page.evaluate(RESTART)
    expect(explorer.locator(".rdk-gone")).to_contain_text("Run the cell again")
    expect(explorer.locator(".rdk-gone")).to_be_visible()
    assert "wheel_radius_m=0.101" in explorer.locator(".rdk-gone code").last.inner_text()

    # Cells of all notebooks run in nbval; what only a browser shows needs some of each kind: the first page with
    # its links, long ones, live pictures.
    for name in "00", "07", "13":
        path = next((browser.REPO / "notebooks").glob(f"{name}_*.ipynb"))
        page.evaluate(OPEN, f"notebooks/{path.name}")
        expect(page.locator(".jp-NotebookPanel:not(.lm-mod-hidden) h1").first).to_contain_text(name)
        assert page.locator(ERROR).count() == 0
