"""Pictures of the evaluator, of masses, power and the march that are too long for a cell (notebooks 00, 03 to 05)."""
import matplotlib.pyplot as plt
import numpy as np

from rdk.figures import BLACK, BLUE, COLOURS, DASHES, GREEN, GREY, MARKERS, ORANGE, panels

EVALUATION_FLOW = (
    ("mass", "terramechanics", "weight on\na wheel"),
    ("terramechanics", "cruise speed", "slip, torque,\nstalled"),
    ("power", "cruise speed", "mean\nsunlight"), ("power", "march", "sunlight,\nstep by step"),
    ("cruise speed", "march", "speed,\nhub power"))
"""What flows between the parts of `evaluate`: from, to, what."""

EVALUATION_RESULTS = {
    "mass": ("total_mass_kg",),
    "terramechanics": ("slope_capability_deg", "slip", "sinkage_m", "wheel_torque_nm"),
    "power": ("average_solar_power_w",), "cruise speed": ("cruise_speed_m_s",),
    "march": ("range_km", "energy_balance_pct", "final_soc"),
    "thermal": ("hot_temperature_c", "cold_temperature_c")}
"""The results that each part of `evaluate` brings forth."""

PARTS = {                                                # left, bottom, and what stands in the box
    "mass": (2.75, 5.05, "parts, overheads,\ntotal mass"),
    "thermal": (5.4, 5.05, "hot noon, cold night;\nno part reads it"),
    "terramechanics": (2.75, 3.1, "how deep the wheel sinks,\nhow much it slips,\nhow steep it climbs"),
    "power": (5.4, 3.1, "sun, panel,\nbattery"),
    "cruise speed": (2.75, 1.15, "the sun pays for it,\nthe hub caps it"),
    "march": (5.4, 1.15, "charge and distance,\nhour by hour,\nto the end")}


def system_diagram():
    """The parts of an evaluation and what flows between them; no arrow runs back inside."""
    figure, ax = panels(figsize=(9.4, 5.6))
    ax.set(xlim=(-0.4, 10.4), ylim=(-0.75, 6.65))
    ax.axis("off")

    def box(x, y, width, height, title, text="", colour=BLACK, face="white", dash="-"):
        ax.add_patch(plt.Rectangle((x, y), width, height, fc=face, ec=colour, linestyle=dash, lw=1.3))
        ax.text(x + width / 2, y + height - 0.14, title, ha="center", va="top", fontsize=9.5, weight="bold")
        ax.text(x + width / 2, y + height - 0.5, text, ha="center", va="top", fontsize=8, linespacing=1.35)

    def arrow(*points, text="", at=(0, 0), dash="-"):
        ax.plot(*zip(*points), color=BLACK, lw=1.4, linestyle=dash)
        ax.annotate("", points[-1], points[-2],
                    arrowprops=dict(arrowstyle="-|>", lw=0, color=BLACK, shrinkB=0, mutation_scale=15))
        ax.text(*at, text, fontsize=7.5, ha="center", va="center", style="italic", linespacing=1.2)

    box(-0.05, 2.85, 2.05, 3.75, "catalogue or you", colour=GREEN, dash="--")
    for y, title, text in ((4.75, "Design", "11 numbers:\nwheels, chassis, array,\nbattery, hubs ..."),
                           (3.0, "Scenario", "site, slope, Soil,\ndays, duty, payload"),
                           (1.25, "Model", "coefficients; the\npaper's are the defaults")):
        box(0.05, y, 1.85, 1.35, title, text, BLUE)
        arrow((1.9, y + 0.67), (2.45, y + 0.67))
    box(2.45, 0.75, 5.2, 5.85, "evaluate", colour=ORANGE)
    for name, (x, y, text) in PARTS.items():
        box(x, y, 1.95, 1.15, name, text, face="#f2f2f2")
    routes = {                                           # start, end and the place of the words
        ("mass", "terramechanics"): ((3.72, 5.05), (3.72, 4.25), (4.15, 4.66)),
        ("terramechanics", "cruise speed"): ((3.4, 3.1), (3.4, 2.3), (2.95, 2.7)),
        ("power", "cruise speed"): ((5.4, 3.4), (4.4, 2.3), (4.42, 2.82)),
        ("power", "march"): ((6.37, 3.1), (6.37, 2.3), (6.95, 2.7)),
        ("cruise speed", "march"): ((4.7, 1.6), (5.4, 1.6), (5.05, 1.88))}
    for start, end, text in EVALUATION_FLOW:
        *points, at = routes[start, end]
        arrow(*points, text=text, at=at)
    results = [name for names in EVALUATION_RESULTS.values() for name in names]
    box(8.2, 2.35, 2.15, 3.7, "Performance", "\n".join(results) + "\nstalled, feasible ...", BLUE)
    arrow((7.65, 4.2), (8.2, 4.2))
    box(2.45, -0.7, 5.2, 0.95, "tradespace, sizing, explorer",
        "many designs at once, demands, pictures, sliders", GREEN)
    arrow((9.27, 2.35), (9.27, -0.22), (7.65, -0.22))
    arrow((2.45, -0.22), (-0.25, -0.22), (-0.25, 5.42), (0.05, 5.42),
          text="the next design:\nthe loop closes out here", at=(1.05, 0.15), dash="--")
    return figure


def rovers_on_missions(range_km, limit_km, verdicts, rovers, missions):
    """Bars of range, a panel a mission, with a word on what stops each rover; dashed is the traverse limit."""
    figure, axes = panels(1, len(missions), figsize=(2.5 * len(missions), 3.4), sharey=True, squeeze=False)
    for column, (ax, mission, limit) in enumerate(zip(axes.flat, missions, limit_km)):
        bars = ax.barh(range(len(rovers)), range_km[:, column], height=0.62, color=BLUE)
        ax.axvline(limit, color=BLACK, linestyle="--", lw=1.2)
        for row, (bar, word) in enumerate(zip(bars, verdicts[:, column])):
            length = bar.get_width()
            inside = length > 0.65 * limit
            ax.text(length + (-0.03 if inside else 0.05) * limit, row,
                    f"{length:.3g} km, {word}" if length else word, va="center", fontsize=8,
                    ha="right" if inside else "left", color="white" if inside else BLACK,
                    bbox=None if inside else dict(fc="white", lw=0, pad=0.5))
            if not length:
                ax.plot(0, row, marker="X", color=ORANGE, clip_on=False, zorder=3)
        ax.set(title=mission, xlabel="range (km)", xlim=(0, 1.22 * limit))
        ax.title.set_fontsize(10)
        ax.grid(axis="y", visible=False)
    axes[0, 0].set_yticks(range(len(rovers)), rovers)
    axes[0, 0].invert_yaxis()
    return figure


def mission_logs(logs, soc_floor=0.15, figure=None):
    """Power, charge and distance through each mission (title -> log), a column a mission; grey: throttled hours."""
    figure, axes = panels(3, len(logs), figure=figure, figsize=(4.6 * len(logs), 6.2), sharex="col", squeeze=False)
    for column, (title, log) in zip(axes.T, logs.items()):
        days = log.time_h / 24
        for ax in column:
            ax.fill_between(days, 0, 1, where=log.throttled, color=GREY, alpha=0.3, lw=0,
                            transform=ax.get_xaxis_transform())
        column[0].plot(days, log.solar_w, color=ORANGE, label="solar")
        column[0].plot(days, log.load_w, color=BLACK, linestyle="--", label="load")
        column[1].plot(days, log.soc, color=BLUE)
        column[1].axhline(soc_floor, color=GREY, lw=1)
        column[2].plot(days, log.distance_km, color=GREEN)
        column[0].set(title=title, ylabel="power (W)")
        column[1].set(ylabel="state of charge", ylim=(0, 1.05))
        column[2].set(xlabel="days since sunrise", ylabel="distance (km)", ylim=(0, None))
    axes[0, 0].legend(loc="upper right", frameon=False, fontsize=8)
    return figure


def power_flows(log):
    """Where the array's power goes (above) and where the load's comes from (below), through a mission."""
    days, net = log.time_h / 24, log.solar_w - log.load_w
    direct = np.minimum(log.solar_w, log.load_w)
    given = {"used at once": direct, "into the battery": np.maximum(net, 0) - log.discarded_w,
             "thrown away": log.discarded_w}
    taken = {"from the array": direct, "from the battery": np.maximum(-net, 0) - log.unserved_w,
             "not served": log.unserved_w}
    figure, axes = panels(2, 1, figsize=(7.0, 5.2), sharex=True)
    for ax, flows, title in zip(axes, (given, taken), ("array (W)", "load (W)")):
        parts = ax.stackplot(days, *flows.values(), labels=flows.keys(),
                             colors=("#9ccbe6", "white", "#dddddd"),
                             step="pre", edgecolor=BLACK, linewidth=0.4)
        parts[1].set_hatch("//")
        parts[2].set_hatch("..")
        ax.set(ylabel=title, xlim=(0, days[-1]), ylim=(0, None))
        ax.legend(loc="upper right", fontsize=8.5, framealpha=1, frameon=True)
    axes[1].set_xlabel("Earth days since sunrise")
    return figure


def mass_shares(shares):
    """Shares of the mass in percent, a bar a rover, a segment a group of items (a column of the table)."""
    figure, ax = panels(figsize=(7.2, 3.9))
    hatches = ("", "//", "", "..", "xx", "")
    fills = (BLUE, "white", GREY, "white", "white", BLACK)
    edges = (BLUE, ORANGE, GREY, GREEN, BLACK, BLACK)
    left = np.zeros(len(shares))
    for k, group in enumerate(shares.columns):
        width = shares[group].to_numpy()
        ax.barh(shares.index, width, left=left, height=0.7, color=fills[k], edgecolor=edges[k],
                hatch=hatches[k],
                label=group, lw=1)
        for y, (x, w) in enumerate(zip(left, width)):
            if w >= 5:
                ax.text(x + w / 2, y, f"{w:.0f}", ha="center", va="center", fontsize=8.5,
                        color="white" if fills[k] in (BLUE, BLACK) else BLACK,
                        bbox=dict(facecolor="white", lw=0, pad=1) if hatches[k] else None)
        left = left + width
    ax.set(xlabel="share of the predicted mass (%)", xlim=(0, 100.5))
    ax.invert_yaxis()
    ax.grid(axis="y", visible=False)
    figure.legend(loc="outside upper center", ncols=3, fontsize=8.5, frameon=False)
    return figure


def mass_errors(masses, median_pct):
    """Error of the predicted mass; circles have four wheels, squares six; open marks are outside the class."""
    figure, ax = panels(figsize=(6.4, 4.0))
    ax.axhspan(-median_pct, median_pct, color=GREY, alpha=0.2, lw=0)
    ax.axhline(0, color=BLACK, lw=0.8)
    for row in masses.itertuples():
        four = row.wheel_count == 4
        colour = BLUE if four else ORANGE
        ax.plot(row.published_mass_kg, row.error_pct, MARKERS[0 if four else 1], color=colour, markersize=8,
                markerfacecolor=colour if row.in_class else "white")
        ax.annotate(row.rover, (row.published_mass_kg, row.error_pct), (7, 5), textcoords="offset points",
                    fontsize=9)
    for four in (True, False):
        ax.plot([], [], MARKERS[0 if four else 1], color=BLUE if four else ORANGE,
                label=f"{4 if four else 6} wheels")
    ax.plot([], [], "o", color=BLACK, markerfacecolor="white", label="outside the class")
    ax.set(xscale="log", xlim=(4, 220), xlabel="published mass (kg)",
           ylabel="error of the predicted mass (%)")
    ax.set_xticks([5, 10, 20, 50, 100, 200], ["5", "10", "20", "50", "100", "200"])
    ax.minorticks_off()
    ax.legend(fontsize=9, frameon=False)
    return figure


def peak_solar(flown):
    """Peak power of flown rovers: published with its band, and predicted for cells of 28 to 32 %."""
    figure, axes = panels(1, len(flown), figsize=(6.4, 3.6))
    for ax, row in zip(np.atleast_1d(axes), flown.itertuples()):
        ax.fill_between([-0.5, 0.5], row.published_low_w, row.published_high_w, color=GREY, alpha=0.3, lw=0,
                        label="published band")
        ax.hlines(row.published_peak_w, -0.5, 0.5, color=BLACK, linestyle="--", label="published")
        spread = [[row.clean_peak_w - row.clean_peak_low_w], [row.clean_peak_high_w - row.clean_peak_w]]
        ax.errorbar([0], [row.clean_peak_w], spread, fmt="o", color=BLUE, capsize=5,
                    label="clean, cell 0.28 to 0.32")
        ax.set(title=row.rover, xticks=[], xlim=(-0.6, 0.6),
               ylim=(0, 1.1 * max(row.clean_peak_high_w, row.published_high_w)),
               ylabel="peak solar power (W)")
        ax.grid(axis="x", visible=False)
    figure.legend(*ax.get_legend_handles_labels(), loc="outside lower center", ncols=3, fontsize=9, frameon=False)
    return figure


def demand_chances(mass_kg, shares, wanted=0.9):
    """Share of the draws in which each demand (words -> shares) holds, for designs from light to heavy."""
    figure, ax = panels(figsize=(6.8, 4.0))
    for i, (label, share) in enumerate(shares.items()):
        ax.plot(mass_kg, 100 * share, color=COLOURS[i % 4], linestyle=DASHES[i % 4], marker=MARKERS[i], markersize=5,
                label=label)
    ax.axhline(100 * wanted, color=GREY, linewidth=1)
    ax.set(xlabel="nominal mass (kg)", ylabel="holds in (% of the draws)", ylim=(-3, 103))
    figure.legend(loc="outside upper center", ncols=2, fontsize=9, frameon=False)
    return figure
