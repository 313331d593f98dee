"""The number of events and mu_sapp against the number of blocks."""

from __future__ import annotations

import pandas as pd
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from maegawa2010 import printed
from precursors.figures import style
from precursors.figures.style import Options

HEIGHT_MM = 84.0
BEYOND = 1.35  # where marks stand beyond the last N, in units of it
EXACT: Options = {"linestyle": "none", "marker": ".", "markersize": 4}
# The other counts beside those of Fig. 13.
COUNTS: dict[str, Options] = {
    "events_to_global_slip": {"linestyle": "--", "label": "median, all events"},
}
EXPERIMENT: Options = {"linestyle": "none", "marker": "<", "markersize": 5}
BAND = 0.18  # share of a colour in a band, the rest is white


def draw(
    table: pd.DataFrame, predictability: pd.DataFrame, papers_n: int, mu_k: float
) -> Figure:
    """Draw events and mu_sapp against N; dotted lines mark the paper's N and mu_k.

    Of resolution.csv, medians are lines and 5 to 95 % of the runs are bands. A run
    without noise is a dot where it is predictable up to its global slip
    (predictability.csv).
    """
    known = predictability[["scene", "n_blocks", "predictable"]]
    table = table.merge(known, how="left")
    with style.page(style.PAGE_MM, HEIGHT_MM) as figure:
        counts, frictions = figure.subplots(1, 2)
        for _, of_scene in table.groupby("scene", sort=False):
            rows = dict(list(of_scene.groupby("quantity")))
            _draw_numbers(counts, rows["events_counted"])
            _draw_numbers(frictions, rows["mu_sapp"])
            color = style.theta_color(of_scene["theta"].iloc[0])
            for quantity, look in COUNTS.items():
                of_runs = rows[quantity]
                counts.plot(of_runs["n_blocks"], of_runs["q50"], color=color, **look)
        beyond = BEYOND * table["n_blocks"].max()
        for sign, count in printed.EVENTS_OF_EXPERIMENT.items():
            counts.plot(beyond, count, **EXPERIMENT, color=style.theta_color(sign))
        counts.set(ylabel="Events up to the first global slip [-]", yscale="log")
        style.set_ticks(counts.yaxis, [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000])
        frictions.set_ylabel(style.MU_SAPP_LABEL)
        words = f"paper, experiment: {printed.MU_SAPP:g}"
        style.draw_level(frictions, printed.MU_SAPP, words)
        style.draw_level(frictions, mu_k, r"$\mu_k$", "top")
        for axes in (counts, frictions):
            axes.set(xscale="log", xlabel=style.BLOCKS_LABEL)
            axes.axvline(papers_n, **style.DOTTED)
            style.set_ticks(axes.xaxis, [2, 5, 10, 20, 50, 100, 200])
        _draw_key(figure, papers_n)
    return figure


def _draw_numbers(axes: Axes, rows: pd.DataFrame) -> None:
    """Draw the median and nine tenths of the runs, and the runs without noise."""
    theta = rows["theta"].iloc[0]
    color = style.theta_color(theta)
    n = rows["n_blocks"]
    band = {
        "color": style.pale(color, BAND),
        "linewidth": 0,
        "zorder": 0.5 - 0.1 * theta,
    }
    axes.fill_between(n, rows["q05"], rows["q95"], **band)
    axes.plot(n, rows[["q05", "q95"]], color=style.pale(color, 0.5), linewidth=0.4)
    axes.plot(n, rows["q50"], color=color, linewidth=1.2)
    exact = rows[rows["predictable"].eq(True)]
    axes.plot(exact["n_blocks"], exact["without_noise"], color=color, **EXACT)


def _draw_key(figure: Figure, papers_n: int) -> None:
    entries: list[Artist] = [
        style.mark(words, color=style.theta_color(sign), linewidth=2)
        for sign, words in style.LOADINGS.items()
    ]
    entries += [
        style.mark("median, counted in Fig. 13", linewidth=1.2),
        *(style.mark(**look) for look in COUNTS.values()),
        Patch(color=style.pale(style.BLACK, BAND), label="5 to 95 %"),
        style.mark("without noise, predictable", **EXACT),
        style.mark("experiment", **EXPERIMENT),
        style.mark(f"$N = {papers_n}$", **style.DOTTED),
    ]
    style.draw_key(figure, entries, ncols=3)
