"""The number of events and mu_sapp against the number of blocks."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from maegawa2010 import printed
from precursors.figures import style
from precursors.figures.style import Options

HEIGHT_MM = 84.0
BEYOND = 1.35  # where marks stand beyond the last N, in units of it
EXPERIMENT: Options = {"linestyle": "none", "marker": "<", "markersize": 5}
MEDIAN: Options = {"linewidth": 1.2}
ALL_EVENTS: Options = {"linestyle": "--"}
LIMIT: Options = {"linestyle": "none", "marker": "_", "markersize": 5}


def draw(table: pd.DataFrame, papers_n: int, mu_k: float) -> Figure:
    """Draw events and mu_sapp against N; dotted lines mark the paper's N and mu_k.

    Of resolution.csv, medians are lines, and 5 and 95 % of the runs are ticks.
    """
    with style.page(style.PAGE_MM, HEIGHT_MM) as figure:
        counts, frictions = figure.subplots(1, 2)
        for _, of_scene in table.groupby("scene", sort=False):
            rows = dict(list(of_scene.groupby("quantity")))
            _draw_numbers(counts, rows["events_counted"])
            _draw_numbers(frictions, rows["mu_sapp"])
            color = style.theta_color(of_scene["theta"].iloc[0])
            every = rows["events_to_global_slip"]
            counts.plot(every["n_blocks"], every["q50"], color=color, **ALL_EVENTS)
        beyond = BEYOND * table["n_blocks"].max()
        for sign, count in printed.EVENTS_OF_EXPERIMENT.items():
            counts.plot(beyond, count, **EXPERIMENT, color=style.theta_color(sign))
        counts.set(ylabel="Events up to the first global slip [-]", yscale="log")
        style.set_ticks(counts.yaxis, [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000])
        frictions.set_ylabel(style.MU_SAPP_LABEL)
        levels = {r"$\mu_k$": mu_k, "paper": printed.MU_SAPP}
        for level in levels.values():
            frictions.axhline(level, **style.DOTTED)
        right = frictions.secondary_yaxis("right")
        right.set_yticks(list(levels.values()), levels)
        for axes in (counts, frictions):
            axes.set(xscale="log", xlabel=style.BLOCKS_LABEL)
            axes.axvline(papers_n, **style.DOTTED)
            style.set_ticks(axes.xaxis, [2, 5, 10, 20, 50, 100, 200])
        n, least, most = _ends(table, "events_counted")
        counts.set_title(f"{least:.0f} to {most:.0f} events count at $N = {n}$")
        n, least, most = _ends(table, "mu_sapp")
        frictions.set_title(f"Medians from {least:.3f} to {most:.3f} at $N = {n}$")
        frictions.legend(labelcolor="linecolor", loc="upper right")
        _draw_key(figure)
    return figure


def _ends(table: pd.DataFrame, quantity: str) -> tuple[int, float, float]:
    """Largest number of blocks, and least and greatest median of the loadings there."""
    of_quantity = table[table["quantity"] == quantity]
    n = of_quantity["n_blocks"].max()
    medians = of_quantity.loc[of_quantity["n_blocks"] == n, "q50"]
    return n, medians.min(), medians.max()


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
        style.mark("experiment", **EXPERIMENT),
    ]
    style.draw_key(figure, entries, ncols=4)
