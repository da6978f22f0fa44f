"""Speed, memory and import time of the evaluator on one core: `python tests/benchmark.py` prints the tables.

The yardstick is the scalar transcription of the paper beside this file: it does the work of the original
release (100 points on the contact arc, Brent's method, an hourly loop) and costs about as much. Ratios are
taken within one run, so that they compare the engines and not two machines; times are processor times, which
other programs on the machine disturb less. Nothing here is a test.
"""
import os

for variable in "OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS":
    os.environ[variable] = "1"                           # before numpy is imported

import dataclasses
import platform
import statistics
import subprocess
import sys
import time
import tracemalloc

import numpy as np
import scalar_transcription as scalar

import rdk
from rdk import _contact as contact
from rdk import tradespace

SIZES = {1: 40, 50: 30, 2_000: 6, 100_000: 1}            # designs in a population: repetitions
SCENARIOS = rdk.scenario_names("canonical")


def milliseconds(function, *arguments, **options):
    """Processor time of one call."""
    start = time.process_time()
    function(*arguments, **options)
    return 1e3 * (time.process_time() - start)


def transcribed(scenario):
    return {**vars(scenario), "soil": vars(scenario.soil)}


def speed(kernel="paper", sizes=SIZES):
    """Median milliseconds a design by population and scenario, and the ratio to the scalar transcription."""
    print(f"{kernel} kernel\n{'designs':>10} {'scenario':28}{'ms/design':>12}{'scalar ms':>12}{'ratio':>9}")
    model = rdk.Model(kernel=kernel)
    for size, repetitions in sizes.items():
        ratios = []
        for name in SCENARIOS:
            scenario = rdk.scenario(name)
            mission, times = transcribed(scenario), []
            rdk.evaluate(rdk.random_designs(1, seed=0), scenario, model=model)          # warm up
            for i in range(repetitions):                 # turn about, so that both see the same machine
                population = rdk.random_designs(size, seed=i)
                others = rdk.random_designs(max(1, 12 // repetitions), seed=1000 + i)
                scalar_ms = [milliseconds(scalar.evaluate, other.numbers(), mission) for other in others]
                if size == 1:
                    population = population[0]
                times.append((milliseconds(rdk.evaluate, population, scenario, model=model) / size,
                              statistics.median(scalar_ms)))
            ours, theirs = (statistics.median(column) for column in zip(*times))
            ratios.append(theirs / ours)
            print(f"{size:>10,} {name:28}{ours:>12.4f}{theirs:>12.2f}{ratios[-1]:>9.0f}")
        print(f"{size:>10,} {'median ratio':28}{'':>24}{statistics.median(ratios):>9.0f}")


def memory():
    """Peak of the memory that evaluate takes beyond inputs and results: flat where it works in blocks."""
    print(f"\n{'designs':>10}{'working memory, MB':>22}{'results, MB':>14}")
    scenario = rdk.scenario("polar_prospecting")
    for size in 2_000, 20_000, 100_000:
        population = rdk.random_designs(size, seed=1)
        tracemalloc.start()
        result = rdk.evaluate(population, scenario)
        kept, peak = tracemalloc.get_traced_memory()
        tracemalloc.stop()
        print(f"{size:>10,}{(peak - kept) / 1e6:>22.1f}{kept / 1e6:>14.1f}")
        del result


def counted(function, counts, key, lanes):
    """`function`, adding the number of lanes of each call to `counts[key]`."""
    def wrapper(*arguments, **options):
        counts[key] += lanes(arguments)
        return function(*arguments, **options)
    return wrapper


def kernel_evaluations():
    """Wheel-soil solves and contact integrals a design, here and in the transcription."""
    print("\nwheel-soil solves and contact integrals a design (paper: 19 solves)\n"
          f"{'scenario':28}{'solves':>9}{'integrals':>11}{'scalar solves':>15}{'scalar integrals':>18}")
    for name in SCENARIOS:
        scenario, population, few = rdk.scenario(name), rdk.random_designs(2_000, seed=2), 20
        counts = dict.fromkeys(("solves", "integrals", "scalar solves", "scalar integrals"), 0)
        kept = {(module, function): getattr(module, function) for module, function in (
            (contact, "Arcs"), (contact, "entry_angle"), (contact, "newton_balance"),
            (scalar, "wheel_forces"),
            (scalar, "contact_integrals"))}
        wrappers = {"Arcs": ("integrals", lambda a: a[0].size),
                    "entry_angle": ("solves", lambda a: a[1].size),
                    "newton_balance": ("solves", lambda a: a[1].size),
                    "wheel_forces": ("scalar solves", lambda a: 1),
                    "contact_integrals": ("scalar integrals", lambda a: 1)}
        try:
            for (module, function), original in kept.items():
                setattr(module, function, counted(original, counts, *wrappers[function]))
            rdk.evaluate(population, scenario)
            for design in population[:few]:
                scalar.evaluate(design.numbers(), transcribed(scenario))
        finally:
            for (module, function), original in kept.items():
                setattr(module, function, original)
        print(f"{name:28}{counts['solves'] / 2000:>9.1f}{counts['integrals'] / 2000:>11.1f}"
              f"{counts['scalar solves'] / few:>15.1f}{counts['scalar integrals'] / few:>18.1f}")


def fixed_and_hourly():
    """A line through the cost of one evaluation against the length of the mission."""
    scenario, design = rdk.scenario("equatorial_mare_traverse"), rdk.rover("Rashid-1")
    population = rdk.random_designs(2_000, seed=3)
    print("\ncost of an evaluation against mission length, 1 to 365 days (paper: 9.1 ms + 3.6 us an hour)")
    for label, days, repetitions, run, size in (
            ("one design", (1, 14, 60, 180, 365), 25, lambda s: rdk.evaluate(design, s), 1),
            ("each of 2,000 designs", (1, 14, 60, 180, 365), 1, lambda s: rdk.evaluate(population, s), 2_000),
            ("scalar transcription", (1, 60, 365), 3,
             lambda s: scalar.evaluate(design.numbers(), transcribed(s)), 1)):
        costs = []
        for length in days:
            mission = dataclasses.replace(scenario, duration_earth_days=length)
            costs.append(statistics.median(milliseconds(run, mission) for _ in range(repetitions)) / size)
        hourly, fixed = np.polyfit(24 * np.array(days), costs, 1)
        print(f"  {label:24}{fixed:>9.4f} ms + {1e3 * hourly:.4f} us an hour")


def searched(scenario, seed):
    """Seconds of processor time of a front, and all the designs that it evaluated, as dictionaries."""
    kept, seen = tradespace.evaluate, []
    tradespace.evaluate = lambda designs, *rest, **more: seen.append(designs) or kept(designs, *rest, **more)
    try:
        seconds = milliseconds(lambda: rdk.pareto_front(scenario, seed=seed)) / 1e3
    finally:
        tradespace.evaluate = kept
    return seconds, [one.numbers() for population in seen for one in population]


def trade_space():
    """Processor time of fronts, intervals and an attribution, and of pymoo where evaluation costs nothing."""
    mare, rashid = rdk.scenario("equatorial_mare_traverse"), rdk.rover("Rashid-1")
    rdk.pareto_front(mare, population=4, generations=1)                     # warm up: imports
    print(f"\n{'a front of 50 x 60':28}{'s':>8}{'scalar, 3,000':>16}{'ratio':>8}")
    ratios = []
    for name in SCENARIOS:
        scenario, times = rdk.scenario(name), []
        mission = transcribed(scenario)
        for seed in range(3):                            # turn about, so that both see the same machine
            seconds, designs = searched(scenario, seed)
            every = designs[::150]                       # 20 of the 3,000, early and late
            scalar_ms = statistics.fmean(milliseconds(scalar.evaluate, one, mission) for one in every)
            times.append((seconds, 3 * scalar_ms))
        ours, theirs = (statistics.median(column) for column in zip(*times))
        ratios.append(theirs / ours)
        print(f"{name:28}{ours:>8.2f}{theirs:>16.1f}{ratios[-1]:>8.0f}")
    print(f"{'median ratio':28}{statistics.median(ratios):>32.0f}")

    known, kept = rdk.evaluate(rdk.random_designs(50, seed=0), mare), tradespace.evaluate
    tradespace.evaluate = lambda designs, *rest, **more: known if len(designs) == 50 else kept(designs, *rest, **more)
    try:
        free = milliseconds(lambda: rdk.pareto_front(mare, seed=0))
    finally:
        tradespace.evaluate = kept
    print(f"pymoo, with answers ready: {free / 1e3:.2f} s")
    scenarios = [rdk.scenario(name) for name in SCENARIOS]
    for label, run in (("fronts of the four scenarios", lambda: [*map(rdk.pareto_front, scenarios)]),
                       ("intervals, 1,024 draws", lambda: rdk.intervals(rashid, mare)),
                       ("attribution, 2,048 mixtures",
                        lambda: rdk.attribution(rashid, rdk.rover("Tenacious").replace(wheel_count=6), mare))):
        run()
        print(f"{label}: {statistics.median(milliseconds(run) for _ in range(3)):.0f} ms")


def import_time():
    """Median processor time to import rdk in a fresh interpreter, and of numpy alone."""
    for module in "numpy", "rdk":
        code = f"import time; t = time.process_time(); import {module}; print(time.process_time() - t)"
        runs = [float(subprocess.check_output([sys.executable, "-c", code])) for _ in range(5)]
        print(f"import {module}: {statistics.median(runs):.2f} s")


if __name__ == "__main__":
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})     # one core
    print(f"Python {platform.python_version()}, numpy {np.__version__}, {platform.machine()}, one core\n")
    speed()
    speed("imposed-arc", {50: 30, 2_000: 6})
    memory()
    kernel_evaluations()
    fixed_and_hourly()
    trade_space()
    print()
    import_time()
