"""Figures of rules, sensitivity, rediscovery and the ledger (notebooks 08 to 11)."""
from __future__ import annotations

import html
import re

import numpy as np
import pandas as pd

from rdk.figures import BLACK, BLUE, COLOURS, DASHES, GREY, MARKERS, ORANGE, panels


def variables_on_fronts(places):
    """Where each variable of each front lies in its searched range, 0 to 1: marker the median, bar the middle 80 %.

    `places` maps a front to {label of a variable: places of its designs}.
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


def _without_unit(name):
    """A field's name in words, without the unit at its end."""
    return re.sub(r"(_(kg|kn|kpa|deg|mm|nm|m2|m|n1|n2|wh|w|rad_s))+$", "", name).replace("_", " ")


def sobol_bars(indices, labels=None, most=9):
    """Sobol indices, the `most` largest of each metric: filled the first order, hollow the total and its interval."""
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
    """Measured pulls (markers) and their intervals (bars) with the nominal pull (ticks), one panel an experiment."""
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


def rediscovery_distances(found, baselines):
    """Distance of each rover to its front (bars, hatched out of class) beside what chance gives.

    Diamonds: centroid of feasible designs. Squares: nearest of as many random feasible designs under the same mass
    ceiling, the bar down to its 5 % quantile.
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


VERDICTS = {True: ("✓", "agrees"), False: ("✗", "differs"), None: ("–", "reported")}
"""Symbol and word of a row of the ledger."""


def verdict(agrees):
    """Symbol and word for a ledger's `agrees`: yes, no, or nothing asked."""
    return VERDICTS[None if pd.isna(agrees) else bool(agrees)]


def ledger_verdicts(ledger):
    """How many numbers of each section agree (filled), differ (hatched) or are only reported (open)."""
    words = ledger.agrees.map(lambda x: verdict(x)[1], na_action=None)
    table = pd.crosstab(ledger.section, words).reindex(ledger.section.unique())
    figure, ax = panels(figsize=(7.4, 0.36 * len(table) + 1))
    left = np.zeros(len(table))
    styles = {"agrees": dict(color=BLUE), "differs": dict(color="white", edgecolor=ORANGE, hatch="///"),
              "reported": dict(color="white", edgecolor=GREY)}
    for word in table.columns.intersection(list(styles)):
        count = table[word].to_numpy()
        bars = ax.barh(table.index[count > 0], count[count > 0], 0.7, left=left[count > 0], label=word, **styles[word])
        for text in ax.bar_label(bars, label_type="center", fontsize=9, color="white" if word == "agrees" else BLACK):
            text.set_bbox(None if word == "agrees" else dict(facecolor="white", edgecolor="none", pad=1))
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
    return str(value) if isinstance(value, (bool, np.bool_, str)) else f"{float(value):.4g}"


def ledger_html(ledger):
    """A ledger as an HTML table; a symbol and a word, not only the colour, tell the verdict."""
    tints = {"agrees": "#e3f0f8", "differs": "#fbe5d8", "reported": "#ffffff"}
    rows = [("", "section", "what", "paper", "ours", "why")] + [
        (" ".join(verdict(row.agrees)), row.section, row.quantity, row.paper, ledger_text(row.ours), row.why)
        for row in ledger.itertuples()]
    tags = []
    for k, row in enumerate(rows):
        tint, tag = ("", 'th scope="col"') if k == 0 else (f"background:{tints[row[0][2:]]};color:#000", "td")
        cells = "".join(f'<{tag} style="text-align:left;vertical-align:top">{html.escape(str(cell))}</{tag[:2]}>'
                        for cell in row)
        tags.append(f'<tr style="{tint}">{cells}</tr>')
    return (f'<table style="border-collapse:collapse;font-size:90%"><caption>{len(ledger)} numbers</caption>'
            f"<thead>{tags[0]}</thead><tbody>{''.join(tags[1:])}</tbody></table>")


def ledger_filter(ledger):
    """A ledger with menus for section and verdict; without widgets the whole table stands alone.

    The menus are `section` and `verdict` of the returned VBox, the rows that they leave `shown`.
    """
    import ipywidgets as widgets

    class LedgerFilter(widgets.VBox):
        def _repr_mimebundle_(self, **options):
            bundle = super()._repr_mimebundle_(**options)
            return {**bundle, "text/plain": f"{len(self.shown)} numbers of the paper", "text/html": self.table.value}

    section = widgets.Dropdown(options=["all", *dict.fromkeys(ledger.section)], description="section")
    choice = widgets.Dropdown(options=["all", *(word for _, word in VERDICTS.values())], description="verdict")
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
