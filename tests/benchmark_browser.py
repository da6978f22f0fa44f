"""How fast the explorer answers in a real browser: `python tests/benchmark_browser.py [other checkout]` prints a table.

Voila serves the app, Chromium presses keys on a slider. Times are from the key press to the first painted frame that
shows new readings and picture, and then new intervals, measured in the page. With another checkout of the project that
one is measured in the same run, by its own picture. Nothing here is a test.
"""

import os
import subprocess
import sys
import tempfile
from pathlib import Path

import browser
import numpy as np

PRESSES, MOVES = 20, 100
# Press a key on the slider, wait until the elements have changed and the change is painted; milliseconds for each.
WATCH = """([presses, slider, parts]) => new Promise(async done => {
    const root = document.querySelector('.rdk-explorer'), times = parts.map(() => []);
    const wait = ms => new Promise(f => setTimeout(f, ms)), handle = root.querySelector(slider);
    const state = part => root.querySelector('.rdk-old') && part === '.rdk-cards' ? null
        : root.querySelector(part)?.outerHTML;
    const frame = () => new Promise(f => requestAnimationFrame(() => setTimeout(f)));
    for (let i = 0; i < presses; i++) {
        const before = parts.map(state), begun = performance.now(), up = i % 20 < 10;
        if (handle.type === 'range') {
            handle.value = +handle.value + (up ? 1 : -1); handle.dispatchEvent(new Event('input', {bubbles: true}));
        } else handle.dispatchEvent(new KeyboardEvent('keydown',
            {key: up ? 'ArrowRight' : 'ArrowLeft', bubbles: true, cancelable: true}));
        const left = new Set(parts.keys());
        while (left.size && performance.now() - begun < 5000) {
            await frame();
            for (const k of left) {
                const now = state(parts[k]);
                if (now && now !== before[k]) {
                    times[k].push(performance.now() - begun); left.delete(k); } }
        }
        await wait(80);
    }
    done(times);
})"""
NEW = {"log": "Mission log", "mass": "Mass", "wheel": "Wheel", "fleet": "Fleet", "why": "Why", "sweep": "Sweep"}
OLD = {"log": "log", "mass": "mass", "wheel": "stress", "fleet": "rovers", "why": "why", "sweep": "sweep"}


def kernel_memory_mb():
    """Resident memory of the kernels that run below this process."""
    listed = subprocess.run(["ps", "-eo", "pid,ppid,rss,args"], capture_output=True, text=True).stdout.splitlines()[1:]
    rows = [line.split(None, 3) for line in listed]
    family = {str(os.getpid())}
    for _ in range(4):                                   # server, launcher, kernel
        family |= {pid for pid, parent, *_ in rows if parent in family}
    return sum(int(rss) for pid, _, rss, args in rows if pid in family and "ipykernel" in args) / 1024


def row(what, *numbers):
    print(f"| {what:42} | " + " | ".join(f"{n:>10}" for n in numbers) + " |", flush=True)


def median(times):
    return f"{np.median(times):.0f}" if times else "-"


def measure(chromium, address, new):
    """Medians and 95 % points by view, the memory over many moves, in a page of the app."""
    page, found = browser.new_page(chromium), {}
    page.goto(address)
    root = page.locator(".rdk-explorer").first
    root.locator(".rdk-picture").first.wait_for()
    page.wait_for_timeout(2500)
    slider = "[type=range]" if new else ".noUi-handle"
    parts = [".rdk-picture svg", ".rdk-cards"] if new else [".rdk-picture"]
    for view, name in (NEW if new else OLD).items():
        if new:
            root.get_by_role("tab", name=name, exact=True).click()
        else:
            root.get_by_role("button", name=name, exact=True).click()
        if view == "why":                                # Yutu-2 differs in every variable: the most work
            menu = root.locator('select[data-in="baseline"]') if new else root.get_by_label("baseline")
            menu.select_option("Yutu-2")
        page.wait_for_timeout(1500)
        found[view] = page.evaluate(WATCH, [PRESSES, slider, parts])
    if new:
        root.locator('select[data-in="sweep_second"]').select_option("slope_deg")
        page.wait_for_timeout(1500)
        found["map"] = page.evaluate(WATCH, [PRESSES, slider, parts])
        root.get_by_role("tab", name="Mission log", exact=True).click()
        page.wait_for_timeout(800)
        before = kernel_memory_mb()
        page.evaluate(WATCH, [MOVES, slider, [".rdk-picture svg"]])
        row(f"kernel memory over {MOVES} moves", f"{before:.0f}", f"{kernel_memory_mb() - before:+.1f} MB")
    page.context.close()
    return found


def main(other=None):
    with browser.chromium() as chromium:
        with tempfile.TemporaryDirectory() as folder, browser.voila(Path(folder), "app.ipynb") as address:
            mine = measure(chromium, address, True)
        theirs = {}
        if other is not None:
            browser.REPO, os.environ["PYTHONPATH"] = Path(other), f"{other}{os.pathsep}{other}/notebooks"
            with tempfile.TemporaryDirectory() as folder, browser.voila(Path(folder), "app.ipynb") as address:
                theirs = measure(chromium, address, False)
    row("key press to painted frame, ms", "median", "95 %", "intervals", "the other")
    row("-" * 42, *["-" * 10] * 4)
    for view, (shown, sure) in mine.items():
        row(view, median(shown), f"{np.quantile(shown, 0.95):.0f}", median(sure), median(theirs.get(view, [[]])[0]))


if __name__ == "__main__":
    main(*sys.argv[1:2])
