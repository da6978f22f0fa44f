"""Figures of rules, sensitivity, rediscovery and the ledger (notebooks 08 to 11)."""
from __future__ import annotations

import re

import numpy as np

from rdk.figures import BLACK, BLUE, COLOURS, DASHES, GREY, MARKERS, ORANGE, panels, curves


def variables_on_fronts(places):
    """Where each variable of each front lies in its searched range: median, and the span of most designs.

    Parameters
    ----------
    places : dict of str to dict of str to ndarray
        By front and by label of the variable: places from 0, the lower bound, to 1, the upper one.

    Returns
    -------
    matplotlib.figure.Figure
        A row a variable. Markers are medians, bars hold the middle 80 % of the front.
    """
    labels = list(next(iter(places.values())))
    figure, ax = panels(figsize=(7.4, 0.5 * len(labels) + 1))
    rows = np.arange(len(labels))
    ax.hlines(rows[:-1] + 0.5, 0, 1, color=GREY, lw=0.4)
    for i, (front, variables) in enumerate(places.items()):
        low, middle, high = np.array([np.quantile(variables[label], [0.1, 0.5, 0.9]) for label in labels]).T
        y = rows + 0.18 * (i - (len(places) - 1) / 2)
        ax.hlines(y, low, high, color=COLOURS[i % 4], lw=2, linestyle=DASHES[i % 4])
        ax.plot(middle, y, MARKERS[i], color=COLOURS[i % 4], markersize=6, label=front, clip_on=False)
    ax.set_yticks(rows, labels)
    ax.set(xlim=(-0.01, 1.01), ylim=(len(labels) - 0.5, -0.5),
           xlabel="place in the searched range: 0 floor, 1 ceiling")
    ax.grid(False, axis="y")
    figure.legend(loc="outside upper center", ncols=len(places), fontsize=9, frameon=False)
    return figure


def capability_against_width(width_mm, content):
    """Slope capability against wheel width at equal mass, one panel a load, one line a shear modulus.

    Parameters
    ----------
    width_mm : ndarray
    content : dict of str to dict of str to ndarray
        By panel title and by line label: slope capability in degrees.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, axes = panels(1, len(content), figsize=(4.2 * len(content), 3.6), sharey=True, squeeze=False)
    for ax, (title, series) in zip(axes[0], content.items()):
        curves(width_mm, series, "wheel width (mm)", "slope capability (deg)", legend=False, axes=ax)
        ax.set_title(title, fontsize=10)
    figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside upper center", ncols=4, fontsize=9,
                  frameon=False)
    return figure


def front_points(content, x_label, y_label, lines=None):
    """Designs of fronts as points, one panel a mission, one marker a case.

    Parameters
    ----------
    content : dict of str to dict of str to (ndarray, ndarray)
        By panel title and by case: x and y of each design.
    x_label, y_label : str
    lines : dict of str to float, optional
        Horizontal lines with their labels.

    Returns
    -------
    matplotlib.figure.Figure
    """
    columns = min(len(content), 2)
    rows = -(-len(content) // columns)
    figure, axes = panels(rows, columns, figsize=(4.2 * columns, 2.9 * rows), squeeze=False, sharex=True)
    for ax, (title, cases) in zip(axes.flat, content.items()):
        for i, (label, (x, y)) in enumerate(cases.items()):
            ax.plot(x, y, MARKERS[i], color=COLOURS[i % 4], markersize=4.5,
                    markerfacecolor="none" if i else None, label=label)
        for name, value in (lines or {}).items():
            ax.axhline(value, color=GREY, linestyle=":", lw=1.2)
            ax.annotate(name, (0.99, value), xycoords=("axes fraction", "data"), xytext=(0, -3), va="top",
                        textcoords="offset points", ha="right", fontsize=8, color=GREY)
        ax.margins(y=0.12)
        ax.set_title(title, fontsize=10)
    for ax in axes[-1]:
        ax.set_xlabel(x_label)
    for ax in axes[:, 0]:
        ax.set_ylabel(y_label)
    axes[0, 0].legend(fontsize=8.5)
    return figure


def battery_by_patience(statistics, published_wh):
    """Median battery of fronts against the generations of the search, one line a seed, one panel a mission.

    Parameters
    ----------
    statistics : pandas.DataFrame
        Columns scenario, seed, generations, battery_median_wh.
    published_wh : dict of str to float
        The paper's median, by scenario.

    Returns
    -------
    matplotlib.figure.Figure
        The dotted line is the search floor of 5 Wh.
    """
    names = list(dict.fromkeys(statistics.scenario))
    figure, axes = panels(1, len(names), figsize=(4.4 * len(names), 3.4), sharey=True, squeeze=False)
    for ax, name in zip(axes[0], names):
        for i, (seed, rows) in enumerate(statistics[statistics.scenario == name].groupby("seed")):
            ax.plot(rows.generations, rows.battery_median_wh, color=BLUE, marker=MARKERS[i % 7], lw=1, ms=5)
        first, ticks = rows.generations.min(), sorted(set(rows.generations))
        ax.plot(first, published_wh[name], "X", color=ORANGE, markersize=11, label="paper, one seed")
        ax.axhline(5, color=GREY, linestyle=":")
        ax.set(title=name.replace("_", " "), xlabel="generations", xscale="log", yscale="log", ylim=(4, 600))
        ax.set_xticks(ticks, [str(g) for g in ticks])
        ax.minorticks_off()
        ax.set_yticks([5, 15, 50, 150, 500], ["5", "15", "50", "150", "500"])
        ax.title.set_size(10)
    axes[0, 0].set_ylabel("median battery of the front (Wh)")
    axes[0, -1].legend(fontsize=9)
    return figure


def battery_worth(capacity_wh, ranges_km, mass_kg):
    """Range and total mass of one rover against its battery, one line an array.

    Parameters
    ----------
    capacity_wh : ndarray
    ranges_km : dict of str to ndarray
        By label of the array.
    mass_kg : ndarray

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, (left, right) = panels(1, 2, figsize=(8.4, 3.4))
    curves(capacity_wh, ranges_km, "battery capacity (Wh)", "range (km)", axes=left)
    right.plot(capacity_wh, mass_kg, color=BLACK)
    right.set(xlabel="battery capacity (Wh)", ylabel="total mass (kg)")
    left.set(ylim=(0, None))
    return figure


def rocker_bogie_share(statistics, rigid_limit_m):
    """Share of six-wheeled designs on each front against the required obstacle height.

    Parameters
    ----------
    statistics : pandas.DataFrame
        Columns scenario, obstacle_height_m, four_wheels.
    rigid_limit_m : float
        What the largest wheel of the search climbs on a rigid chassis; drawn as a line.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, ax = panels(figsize=(6.4, 3.4))
    for i, (name, rows) in enumerate(statistics.groupby("scenario", sort=False)):
        rows = rows.sort_values("obstacle_height_m")
        ax.plot(100 * rows.obstacle_height_m, 100 * (1 - rows.four_wheels), color=COLOURS[i % 4],
                linestyle=DASHES[i % 4], marker=MARKERS[i], markersize=9 - 1.5 * i,
                label=name.replace("_", " "))
    ax.axvline(100 * rigid_limit_m, color=GREY, lw=1)
    ax.annotate("half of the largest radius searched", (100 * rigid_limit_m, 50), xytext=(5, 0),
                textcoords="offset points", fontsize=8.5, color=GREY)
    ax.set(xlabel="required obstacle height (cm)", ylabel="rocker-bogie designs (%)", ylim=(-4, 104))
    ax.legend(fontsize=8.5, loc="center left")
    return figure


def frontiers_by_scale(frontiers):
    """Longest range up to each mass at several shear scales, one panel a mission.

    Parameters
    ----------
    frontiers : dict of str to dict of float to (ndarray, ndarray)
        By mission and by shear scale: mass in kg and range in km, empty where nothing was feasible.

    Returns
    -------
    matplotlib.figure.Figure
        Steps: the longest range of all designs up to that mass.
    """
    figure, axes = panels(2, 2, figsize=(8.6, 5.8), sharex=True)
    scales = sorted(next(iter(frontiers.values())))
    inks = dict(zip(scales, (BLUE, BLUE, BLACK, ORANGE, ORANGE)))
    dashes = dict(zip(scales, (":", "--", "-", "--", ":")))
    for ax, (title, cases) in zip(axes.flat, frontiers.items()):
        for scale in scales:
            mass, distance = cases[scale]
            if len(mass):
                order = np.argsort(mass)
                best = np.maximum.accumulate(distance[order])
                ax.step([*mass[order], 80], [*best, best[-1]], where="post", color=inks[scale],
                        linestyle=dashes[scale], label=f"{scale:g}", lw=1.8)
            else:
                ax.annotate(f"scale {scale:g}: no feasible design", (0.5, 0.06), xycoords="axes fraction",
                            ha="center", fontsize=8.5, color=inks[scale])
        ax.set(title=title, ylim=(0, None), xlim=(5, 80))
        ax.title.set_size(10)
    for ax in axes[-1]:
        ax.set_xlabel("total mass (kg)")
    for ax in axes[:, 0]:
        ax.set_ylabel("range (km)")
    handles, labels = axes[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, title="factor on the shear stress", loc="outside upper center",
                  ncols=len(scales), fontsize=9, frameon=False)
    return figure


def _without_unit(name):
    """A field's name in words, without the unit at its end."""
    return re.sub(r"(_(kg|kn|kpa|deg|rad|mm|nm|m2|m|n1|n2|wh|w|s))+$", "", name).replace("_", " ")


def sobol_bars(indices, labels=None, most=9):
    """Sobol indices as bars, one panel a metric: filled the first order, hollow the total with its interval.

    Parameters
    ----------
    indices : pandas.DataFrame
        Columns metric, input, first_order, total_order, total_low, total_high.
    labels : dict of str to str, optional
        Panel titles by metric.
    most : int
        Inputs shown in each panel, those of the largest total order.

    Returns
    -------
    matplotlib.figure.Figure
    """
    metrics = list(dict.fromkeys(indices.metric))
    figure, axes = panels(1, len(metrics), figsize=(3.5 * len(metrics), 0.32 * most + 1.1), squeeze=False)
    for ax, metric in zip(axes[0], metrics):
        rows = indices[indices.metric == metric].nlargest(most, "total_order").iloc[::-1]
        y = np.arange(len(rows))
        spread = np.maximum([rows.total_order - rows.total_low, rows.total_high - rows.total_order], 0)
        ax.barh(y, rows.total_order, 0.7, color="none", edgecolor=BLACK, label="total", xerr=spread,
                error_kw=dict(lw=1, ecolor=GREY))
        ax.barh(y, rows.first_order.clip(0), 0.36, color=BLUE, label="first order")
        ax.set_yticks(y, [_without_unit(name) for name in rows.input], fontsize=8)
        ax.set(xlim=(0, 1.08), title=(labels or {}).get(metric, metric), xlabel="share of the variance")
        ax.title.set_size(10)
        ax.grid(False, axis="y")
    axes[0, 0].legend(fontsize=8.5, loc="lower right")
    return figure


def pull_intervals(points):
    """Measured pulls and the intervals predicted for them, one panel an experiment.

    Parameters
    ----------
    points : pandas.DataFrame
        From `rdk.uncertainty.interval_coverage`.

    Returns
    -------
    matplotlib.figure.Figure
        Bars are the intervals, ticks on them the nominal pull, markers the measurements.
    """
    names = list(dict.fromkeys(points.experiment))
    down = -(-len(names) // 3)
    figure, axes = panels(down, min(len(names), 3), figsize=(4.2 * min(len(names), 3), 3.4 * down), squeeze=False)
    for ax in axes.flat[len(names):]:
        ax.set_axis_off()
    for ax, name in zip(axes.flat, names):
        for i, (wheel, rows) in enumerate(points[points.experiment == name].groupby("wheel")):
            x = rows.slip + 0.008 * (i - 0.5)
            ax.vlines(x, rows.low_n, rows.high_n, color=COLOURS[i], lw=2.5, alpha=0.45)
            ax.plot(x, rows.nominal_n, "_", color=COLOURS[i], markersize=11)
            ax.plot(x, rows.measured_n, MARKERS[i], color=COLOURS[i], markersize=5.5, markerfacecolor="white",
                    label=f"{wheel}, measured")
        ax.axhline(0, color=GREY, lw=0.8)
        ax.set(title=name, xlabel="slip", ylabel="drawbar pull (N)")
        ax.title.set_size(10)
        ax.legend(fontsize=8.5, loc="upper left")
    return figure


def family_rules(statistics, columns):
    """Statistics of fronts over scenario families: one panel a statistic, one dot a scenario of the family.

    Parameters
    ----------
    statistics : pandas.DataFrame
        With a column `family`, and the statistics.
    columns : dict of str to str
        Statistic and its axis label; "(Wh)" makes the axis logarithmic.

    Returns
    -------
    matplotlib.figure.Figure
        Crosses on the left edge count the scenarios without any feasible design.
    """
    names = list(dict.fromkeys(statistics.family))
    figure, axes = panels(1, len(columns), figsize=(2.6 * len(columns) + 1.2, 2.8), sharey=True, squeeze=False)
    for ax, (column, label) in zip(axes[0], columns.items()):
        for y, name in enumerate(names):
            values = statistics[column][statistics.family == name]
            spread = np.linspace(-0.22, 0.22, len(values))
            ax.plot(values, y + spread, MARKERS[y], color=COLOURS[y % 4], ms=6, markerfacecolor="none")
        ax.set(xlabel=label, ylim=(len(names) - 0.5, -0.5), xscale="log" if "(Wh)" in label else "linear")
        if "(Wh)" not in label and statistics[column].max() <= 100 and "%" in label:
            ax.set_xlim(-6, 106)
    axes[0, 0].set_yticks(range(len(names)), [
        f"{name}\n({n} of {len(statistics[statistics.family == name])} empty)" if (n := int(
            statistics[statistics.family == name].designs.eq(0).sum())) else name for name in names])
    return figure


def rediscovery_distances(found, baselines):
    """Distance of each rover to its front beside what chance gives.

    Parameters
    ----------
    found : pandas.DataFrame
        Columns rover, distance, in_class.
    baselines : pandas.DataFrame
        Columns rover, random_pair, feasible_pair, centroid, nearest_capped, nearest_capped_low.

    Returns
    -------
    matplotlib.figure.Figure
        Bars are the fronts. Open markers: the centroid of feasible designs, and the nearest of as many random
        feasible designs under the same mass ceiling, its bar down to the 5 % quantile.
    """
    table = found.merge(baselines, on="rover")
    figure, ax = panels(figsize=(7.6, 4))
    x = np.arange(len(table))
    for i, row in enumerate(table.itertuples()):
        ax.bar(i, row.distance, 0.5, color=BLUE if row.in_class else "none", edgecolor=BLUE,
               hatch=None if row.in_class else "//")
    ax.plot(x + 0.05, table.centroid, "D", color=ORANGE, markerfacecolor="none", markersize=8,
            label="centroid of the feasible designs")
    down = [table.nearest_capped - table.nearest_capped_low, 0 * x]
    ax.errorbar(x + 0.33, table.nearest_capped, down, fmt="s", color=BLACK, markerfacecolor="white", capsize=3,
                label="nearest of as many random light designs")
    ax.axhline(table.random_pair.mean(), color=GREY, linestyle="--", lw=1, label="random pair")
    ax.axhline(table.feasible_pair.mean(), color=GREY, linestyle=":", lw=1.4, label="feasible pair")
    ax.set_xticks(x, table.rover)
    ax.set(ylabel="distance in the unit cube", ylim=(0, 1.6))
    ax.bar(0, 0, color=BLUE, label="front (hatched: out of class)")
    ax.legend(fontsize=8.5, ncols=2, loc="upper left")
    ax.grid(False, axis="x")
    return figure


def distance_by_patience(found, baselines):
    """Distance of the rovers to their fronts as the searches go on, beside the nearest random light design.

    Parameters
    ----------
    found : pandas.DataFrame
        Columns rover, generations, distance.
    baselines : pandas.DataFrame
        Columns rover, nearest_capped.

    Returns
    -------
    matplotlib.figure.Figure
        One panel a rover; the dashed line is chance.
    """
    names = list(dict.fromkeys(found.rover))
    figure, axes = panels(2, -(-len(names) // 2), figsize=(8.6, 4.6), sharex=True, sharey=True)
    for ax, name in zip(axes.flat, names):
        rows = found[found.rover == name]
        ax.plot(rows.generations, rows.distance, color=BLUE, marker="o")
        ax.axhline(baselines.set_index("rover").nearest_capped[name], color=BLACK, linestyle="--", lw=1)
        ax.set(title=name, xscale="log")
        ax.set_xticks(rows.generations, [str(g) for g in rows.generations])
        ax.minorticks_off()
        ax.title.set_size(10)
    for ax in axes[-1]:
        ax.set_xlabel("generations")
    for ax in axes[:, 0]:
        ax.set(ylabel="distance", ylim=(0, 1.05 * found.distance.max()))
    return figure


VERDICTS = {True: ("✓", "agrees"), False: ("✗", "differs"), None: ("–", "reported")}
"""Symbol and word of a row of the ledger."""


def verdict(agrees):
    """Symbol and word for a ledger's `agrees`: yes, no, or nothing asked."""
    from pandas import isna
    return VERDICTS[None if isna(agrees) else bool(agrees)]


def ledger_verdicts(ledger):
    """How many numbers of each section of the paper come out again.

    Parameters
    ----------
    ledger : pandas.DataFrame
        From `rdk.validation.paper_ledger`.

    Returns
    -------
    matplotlib.figure.Figure
        Bars with the counts: filled agrees, hatched differs, open reported only.
    """
    words = ledger.agrees.map(lambda x: verdict(x)[1], na_action=None)
    sections = list(dict.fromkeys(ledger.section))
    figure, ax = panels(figsize=(7.4, 0.36 * len(sections) + 1))
    left = np.zeros(len(sections))
    styles = {"agrees": dict(color=BLUE), "differs": dict(color="white", edgecolor=ORANGE, hatch="///"),
              "reported": dict(color="white", edgecolor=GREY)}
    for word, style in styles.items():
        count = np.array([(words[ledger.section == section] == word).sum() for section in sections])
        if not count.any():
            continue
        ax.barh(sections, count, 0.7, left=left, label=word, **style)
        for y, (start, n) in enumerate(zip(left, count)):
            if n:
                ax.text(start + n / 2, y, str(n), ha="center", va="center", fontsize=9,
                        color="white" if word == "agrees" else BLACK,
                        bbox=None if word == "agrees" else dict(facecolor="white", edgecolor="none", pad=1))
        left += count
    ax.invert_yaxis()
    ax.set(xlabel="numbers of the paper", xlim=(0, left.max() + 0.5))
    ax.grid(False)
    figure.legend(loc="outside upper center", ncols=3, fontsize=9, frameon=False)
    return figure


def ledger_text(value):
    """A ledger's value in words: numbers with four digits, pairs as low..high."""
    if isinstance(value, (tuple, list)):
        return "..".join(ledger_text(v) for v in value)
    if isinstance(value, (bool, np.bool_, str)):
        return str(value)
    return f"{float(value):.4g}"


def ledger_html(ledger):
    """A ledger as an HTML table; a symbol and a word, not only the colour, tell the verdict.

    Parameters
    ----------
    ledger : pandas.DataFrame

    Returns
    -------
    str
    """
    import html
    tints = {"agrees": "#e3f0f8", "differs": "#fbe5d8", "reported": "#ffffff"}
    head = "".join(f'<th scope="col" style="text-align:left">{name}</th>' for name in
                   ("", "section", "what", "paper", "ours", "why"))
    body = []
    for row in ledger.itertuples():
        symbol, word = verdict(row.agrees)
        cells = (f"{symbol} {word}", row.section, row.quantity, row.paper, ledger_text(row.ours), row.why)
        tags = "".join(f'<td style="text-align:left;vertical-align:top">{html.escape(str(cell))}</td>'
                       for cell in cells)
        body.append(f'<tr style="background:{tints[word]};color:#000">{tags}</tr>')
    return (f'<table style="border-collapse:collapse;font-size:90%"><caption>{len(ledger)} numbers</caption>'
            f"<thead><tr>{head}</tr></thead><tbody>{''.join(body)}</tbody></table>")


def ledger_filter(ledger):
    """A ledger with menus for section and verdict; without widgets the whole table stands alone.

    Parameters
    ----------
    ledger : pandas.DataFrame

    Returns
    -------
    ipywidgets.VBox
        Its `section` and `verdict` are the menus, `shown` the rows that they leave, `table` the HTML.
    """
    import ipywidgets as widgets

    class LedgerFilter(widgets.VBox):
        def _repr_mimebundle_(self, **options):
            bundle = super()._repr_mimebundle_(**options)
            return {**bundle, "text/plain": f"{len(self.shown)} numbers of the paper", "text/html": self.table.value}

    section = widgets.Dropdown(options=["all", *dict.fromkeys(ledger.section)], description="section")
    known = [word for _, word in VERDICTS.values()]
    choice = widgets.Dropdown(options=["all", *known], description="verdict")
    box = LedgerFilter([widgets.HBox([section, choice]), widgets.HTML()])
    box.section, box.verdict, box.table = section, choice, box.children[1]
    words = ledger.agrees.map(lambda x: verdict(x)[1], na_action=None)

    def show(change=None):
        keep = (section.value == "all") | (ledger.section == section.value)
        box.shown = ledger[keep & ((choice.value == "all") | (words == choice.value))]
        box.table.value = ledger_html(box.shown)

    for menu in (section, choice):
        menu.observe(show, "value")
    show()
    return box
