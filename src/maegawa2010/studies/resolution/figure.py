"""The number of events and mu_sapp against the number of blocks."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from maegawa2010 import printed
from precursors.figures import style
from precursors.figures.style import Options

HEIGHT_MM = 66.0
FEWEST = 10  # blocks that are drawn; with fewer, numbers jump from one N to the next
AGREES = 0.005  # the title says "near mu_k" below this distance
MEDIAN: Options = {"linewidth": 1.2}
ALL_EVENTS: Options = {"linestyle": "--"}
RANGE: Options = {"linestyle": "none", "marker": "|", "markersize": 8}
EXPERIMENT: Options = {
    "linestyle": "none",
    "marker": "<",
    "markersize": 5,
    "clip_on": False,
}
NAMES = {-1: "trailing edge", 0: "uniform load", 1: "leading edge"}
BESIDE = 1.04  # factor on N by which bars of different loadings stand apart
# Names stand at the ends of lines: the axis goes on to this multiple of the largest N. The
# names are at least `APART` of the height of the panel apart.
END_ROOM = 4.5
APART = 0.075


def draw(table: pd.DataFrame, papers_n: int, mu_k: float) -> Figure:
    """Draw events and mu_sapp against N; dotted lines mark the paper's N and mu_k.

    `table` is resolution.csv. Lines are medians, and bars contain 5 to 95 % of the runs.
    """
    largest = table["n_blocks"].max()
    table = table[table["n_blocks"] >= min(FEWEST, largest)]
    medians = table.pivot_table("q50", "n_blocks", ["quantity", "theta"])
    with style.page(style.PAGE_MM, HEIGHT_MM) as figure:
        counts, frictions = figure.subplots(1, 2)
        for _, rows in table.groupby(["theta", "quantity"]):
            quantity = rows["quantity"].iloc[0]
            if quantity == "events_to_global_slip":
                color = style.theta_color(rows["theta"].iloc[0])
                counts.plot(rows["n_blocks"], rows["q50"], color=color, **ALL_EVENTS)
            elif quantity in ("events_counted", "mu_sapp"):
                _draw_numbers(frictions if quantity == "mu_sapp" else counts, rows)
        for sign, count in printed.EVENTS_OF_EXPERIMENT.items():
            where = counts.get_yaxis_transform()
            color = style.theta_color(sign)
            counts.plot(1.0, count, transform=where, color=color, **EXPERIMENT)
        counts.set(ylabel="Events up to the first global slip [-]", yscale="log")
        style.set_ticks(counts.yaxis, [5, 10, 20, 50, 100, 200, 500, 1000, 2000])
        frictions.set_ylabel(style.MU_SAPP_LABEL)
        levels = {r"$\mu_k$": mu_k, "paper": printed.MU_SAPP}
        for level in levels.values():
            frictions.axhline(level, **style.DOTTED)
        right = frictions.secondary_yaxis("right")
        right.set_yticks(list(levels.values()), levels)
        for axes in (counts, frictions):
            axes.set(xscale="log", xlabel="Number of blocks $N$ [-]")
            axes.axvline(papers_n, **style.DOTTED)
            style.set_ticks(axes.xaxis, [10, 20, 50, 100, 200])
            axes.set_xlim(right=END_ROOM * largest)
        _name_ends(counts, medians[["events_counted", "events_to_global_slip"]])
        _name_ends(frictions, medians[["mu_sapp"]])
        events = medians["events_counted"]
        if (events.iloc[-1] > events.iloc[0]).all():
            counts.set_title("More blocks, more events")
        off = medians["mu_sapp"].iloc[-1] - mu_k
        if (off.abs() < AGREES).all():
            frictions.set_title(r"With many blocks, every median is near $\mu_k$")
        _draw_key(figure)
    return figure


def _draw_numbers(axes: Axes, rows: pd.DataFrame) -> None:
    """Draw the median and nine tenths of the runs."""
    theta = rows["theta"].iloc[0]
    color = style.theta_color(theta)
    n = rows["n_blocks"]
    beside = n * BESIDE ** np.sign(theta)
    axes.vlines(beside, rows["q05"], rows["q95"], color=color, linewidth=1.0)
    axes.plot(n, rows["q50"], color=color, **MEDIAN)


def _name_ends(axes: Axes, medians: pd.DataFrame) -> None:
    """Write the loading at the end of each line; names that would overlap move apart."""
    ends = medians.iloc[-1].sort_values()
    points = [(medians.index[-1], value) for value in ends]
    axes.autoscale_view()
    to_panel = axes.transData + axes.transAxes.inverted()
    x, y = to_panel.transform(points).T
    # Move each name up from the one below it, and then all names down by the mean shift.
    step = APART * np.arange(len(y))
    up = np.maximum.accumulate(y - step) + step
    heights = up - np.mean(up - y)
    for (_, theta), height in zip(ends.index, heights, strict=True):
        axes.text(
            x[0] + 0.02,
            height,
            NAMES[int(np.sign(theta))],
            transform=axes.transAxes,
            va="center",
            color=style.theta_color(theta),
            # A white background hides dotted lines behind a name.
            bbox={"facecolor": "white", "linewidth": 0, "pad": 0},
        )


def _draw_key(figure: Figure) -> None:
    entries = [
        style.mark("median, counted in Fig. 13", **MEDIAN),
        style.mark("median, all events", **ALL_EVENTS),
        style.mark("5 to 95 % of the runs", **RANGE),
        style.mark("experiment", **EXPERIMENT),
    ]
    style.draw_key(figure, entries)
