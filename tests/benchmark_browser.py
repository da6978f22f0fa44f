"""How fast the explorer answers in a real browser: `python tests/benchmark_browser.py` prints a table.

JupyterLab runs on a copy of the notebooks, Chromium presses keys on a slider. Times are from the key press to the
first painted frame that shows the new picture, measured in the page. Nothing here is a test.
"""

import os
import re
import statistics
import subprocess
import tempfile
from pathlib import Path

import browser
import numpy as np

PRESSES, BURST, MOVES = 100, 20, 300                     # multiples of 20: ten steps up, ten down
# Press a key on the slider, wait until the element has changed and the change is painted; milliseconds.
WATCH = """([selector, presses, pause]) => new Promise(async done => {
    const root = document.querySelector('.rdk-explorer'), image = () => root.querySelector('.rdk-picture')?.src;
    const slider = root.querySelector('.noUi-handle'), times = [], wait = ms => new Promise(f => setTimeout(f, ms));
    const frame = () => new Promise(f => requestAnimationFrame(() => setTimeout(f)));
    for (let i = 0; i < presses; i++) {
        const before = image(), begun = performance.now(), key = i % 20 < 10 ? 'ArrowRight' : 'ArrowLeft';
        slider.dispatchEvent(new KeyboardEvent('keydown', {key, bubbles: true, cancelable: true}));
        while (image() === before && performance.now() - begun < 5000) await frame();
        await frame();                                   // painted
        times.push(performance.now() - begun);
        await wait(pause);
    }
    done(times);
})"""
# Press the key many times at once; milliseconds until the number box, the read-outs and the picture stay the same.
SETTLE = """([presses]) => new Promise(async done => {
    const root = document.querySelector('.rdk-explorer'), slider = root.querySelector('.noUi-handle');
    const state = () => root.querySelector('.rdk-picture')?.src + root.querySelector('.rdk-readout').innerText;
    const begun = performance.now();
    for (let i = 0; i < presses; i++)
        slider.dispatchEvent(new KeyboardEvent('keydown', {key: 'ArrowRight', bubbles: true, cancelable: true}));
    let last = state(), changed = begun;
    while (performance.now() - changed < 1000) {
        await new Promise(f => requestAnimationFrame(() => setTimeout(f)));
        if (state() !== last) { last = state(); changed = performance.now(); }
    }
    done(changed - begun);
})"""
COMPUTE = """
import statistics, time, rdk
from rdk.explorer import Explorer
from rdk import explain
explorer, times = Explorer(), []
for i in range(40):
    design = rdk.Design(**{**explorer.design.numbers(), "wheel_radius_m": 0.06 + 0.003 * i})
    start = time.perf_counter()
    result = rdk.evaluate(design, explorer.scenario)
    rdk.intervals(design, explorer.scenario, draws=200)
    explain.binding(design, explorer.scenario, result)
    explain.limits(design, explorer.scenario, result)
    times.append(1e3 * (time.perf_counter() - start))
print(statistics.median(times), sorted(times)[int(0.95 * len(times))])
"""


def kernel_memory_mb():
    """Resident memory of the kernel that runs below this process."""
    listed = subprocess.run(["ps", "-eo", "pid,ppid,rss,args"], capture_output=True, text=True).stdout.splitlines()[1:]
    rows = [line.split(None, 3) for line in listed]
    family = {str(os.getpid())}
    for _ in range(4):                                   # server, launcher, kernel
        family |= {pid for pid, parent, *_ in rows if parent in family}
    return sum(int(rss) for pid, _, rss, args in rows if pid in family and "ipykernel" in args) / 1024


def row(what, *numbers):
    print(f"| {what:46} | " + " | ".join(f"{n:>10}" for n in numbers) + " |")


def main():
    with tempfile.TemporaryDirectory() as folder, browser.lab(Path(folder)) as lab, browser.chromium() as chromium:
        page = browser.new_page(chromium)
        browser.run_all(page, lab, "06_point_design.ipynb")
        root = page.locator(".rdk-explorer").first
        root.locator(".rdk-picture").wait_for()
        root.scroll_into_view_if_needed()
        page.wait_for_timeout(1500)
        row("", "median", "95 %", "unit")
        row("-" * 46, *["-" * 10] * 3)
        compute = subprocess.run([browser.sys.executable, "-c", COMPUTE], capture_output=True, text=True).stdout.split()
        row("compute: evaluate, intervals, words", *(f"{float(t):.0f}" for t in compute), "ms")
        for view in ("log", "mass", "stress", "rovers", "why", "sweep"):
            root.get_by_role("button", name=view, exact=True).click()
            if view == "why":                            # the range stands at its limit
                root.get_by_label("metric").first.select_option("total mass")
                root.get_by_label("baseline").select_option("Yutu-2")        # differs in every variable: the most work
            page.wait_for_timeout(1000)
            times = np.array(page.evaluate(WATCH, [".rdk-picture", PRESSES if view == "log" else 40, 60]))
            row(f"key press to new picture, {view}", f"{np.median(times):.0f}", f"{np.quantile(times, 0.95):.0f}", "ms")
        root.get_by_role("button", name="log", exact=True).click()
        page.wait_for_timeout(1000)
        bursts = []

        def restart():
            root.get_by_label("start from").select_option("Pragyan")
            page.wait_for_timeout(500)
            root.get_by_label("start from").select_option("Rashid-1")
            page.wait_for_timeout(1000)

        for _ in range(7):
            restart()
            bursts.append(page.evaluate(SETTLE, [BURST]))
        row(f"burst of {BURST} key presses settles", f"{statistics.median(bursts):.0f}", f"{max(bursts):.0f}", "ms")
        restart()
        page.evaluate(WATCH, [".rdk-picture", 40, 10])
        heap = "() => { if (window.gc) gc(); return performance.memory ? performance.memory.usedJSHeapSize / 2**20 : NaN }"
        before = kernel_memory_mb(), page.evaluate(heap)
        page.evaluate(WATCH, [".rdk-picture", MOVES, 10])
        after = kernel_memory_mb(), page.evaluate(heap)
        row(f"kernel memory over {MOVES} moves", f"{before[0]:.0f}", f"{after[0] - before[0]:+.1f}", "MB")
        row(f"page memory over {MOVES} moves", f"{before[1]:.0f}", f"{after[1] - before[1]:+.1f}", "MB")
        assert not page.problems and re.match(r"\d", compute[0]), page.problems


if __name__ == "__main__":
    main()
