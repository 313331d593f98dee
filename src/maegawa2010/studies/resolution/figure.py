"""The number of events and mu_sapp against the number of blocks."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from maegawa2010 import printed
from precursors.figures import style
from precursors.figures.style import Options

HEIGHT_MM = 84.0
AGREES = 0.005  # less than so far from mu_k
EXPERIMENT: Options = {"linewidth": 1.6, "clip_on": False, "zorder": 3}
MEDIAN: Options = {"linewidth": 1.2}
ALL_EVENTS: Options = {"linestyle": "--"}
LIMIT: Options = {"linestyle": "none", "marker": "_", "markersize": 5}


def draw(
    table: pd.DataFrame,
    papers_n: int,
    mu_k: float,
    finer: pd.DataFrame | None = None,
) -> Figure:
    """Draw events and mu_sapp against N; dotted lines mark the paper's N and mu_k.

    Of resolution.csv, medians are lines, and 5 and 95 % of the runs are ticks. `finer`
    is that of a larger study, which is drawn from its smallest N on.
    """
    if finer is not None:
        fewer = table[table["n_blocks"] < finer["n_blocks"].min()]
        table = pd.concat([fewer, finer])
    with style.page(style.PAGE_MM, HEIGHT_MM) as figure:
        counts, frictions = figure.subplots(1, 2)
        for _, of_scene in table.groupby("scene", sort=False):
            rows = dict(list(of_scene.groupby("quantity")))
            _draw_numbers(counts, rows["events_counted"])
            _draw_numbers(frictions, rows["mu_sapp"])
            color = style.theta_color(of_scene["theta"].iloc[0])
            every = rows["events_to_global_slip"]
            counts.plot(every["n_blocks"], every["q50"], color=color, **ALL_EVENTS)
        for sign, count in printed.EVENTS_OF_EXPERIMENT.items():
            color = style.theta_color(sign)
            counts.axhline(count, 0.975, 1.0, color=color, **EXPERIMENT)
        place = (0.965, max(printed.EVENTS_OF_EXPERIMENT.values()))
        where = counts.get_yaxis_transform()
        counts.text(*place, "experiment", transform=where, ha="right", va="center")
        counts.set(ylabel="Events up to the first global slip [-]", yscale="log")
        style.set_ticks(counts.yaxis, [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000])
        frictions.set_ylabel(style.MU_SAPP_LABEL)
        levels = {r"$\mu_k$": mu_k, "paper": printed.MU_SAPP}
        for level in levels.values():
            frictions.axhline(level, **style.DOTTED)
        right = frictions.secondary_yaxis("right")
        right.set_yticks(list(levels.values()), levels)
        for axes in (counts, frictions):
            axes.set(xscale="log", xlabel="Number of blocks $N$ [-]")
            axes.axvline(papers_n, **style.DOTTED)
            style.set_ticks(axes.xaxis, [2, 5, 10, 20, 50, 100, 200])
        medians = table.pivot_table("q50", "n_blocks", ["quantity", "scene"])
        events = medians["events_counted"]
        if (events.iloc[-1] > events.iloc[0]).all():
            counts.set_title("More blocks, more events")
        off = medians["mu_sapp"].iloc[-1] - mu_k
        if (off.abs() < AGREES).all():
            frictions.set_title(r"With many blocks, every loading gives $\mu_k$")
        frictions.legend(labelcolor="linecolor", loc="upper right")
        _draw_key(figure)
    return figure


def _draw_numbers(axes: Axes, rows: pd.DataFrame) -> None:
    """Draw the median and nine tenths of the runs."""
    theta = rows["theta"].iloc[0]
    color = style.theta_color(theta)
    n = rows["n_blocks"]
    axes.plot(n, rows[["q05", "q95"]], color=color, **LIMIT)
    loading = style.LOADINGS[int(np.sign(theta))]
    axes.plot(n, rows["q50"], color=color, **MEDIAN, label=loading)


def _draw_key(figure: Figure) -> None:
    entries = [
        style.mark("median, counted in Fig. 13", **MEDIAN),
        style.mark("median, all events", **ALL_EVENTS),
        style.mark("5 and 95 % of the runs", **LIMIT),
    ]
    style.draw_key(figure, entries)
