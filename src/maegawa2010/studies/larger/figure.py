"""A chain with a length of its own: the coefficient into which it settles, and how its
peaks alternate, beside the law."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from precursors.figures import style
from precursors.figures.style import Options

HEIGHT_MM = 58.0
TIMES_MS = (0.01, 0.03, 0.1, 0.3)  # t_v at which the axis has ticks
# By the sign of theta.
MARKERS = {-1: "v", 0: "o", 1: "^"}


def draw(settled: pd.DataFrame) -> Figure:
    """Draw the settled peaks against those that the law predicts with nothing counted,
    and the slope from peak to peak.

    The table is larger_settled.csv; runs that do not settle are left out.
    """
    runs = settled[settled["period"] > 0]
    on_map = runs[runs["study"].isin(["map", "finer"]) & (runs["precursors"] == 0)]
    with style.page(style.PAGE_MM, HEIGHT_MM) as figure:
        peaks, slopes = figure.subplots(1, 2)
        _draw_peaks(peaks, runs)
        _draw_slopes(slopes, on_map.dropna(subset="slope"))
        entries = [
            style.mark(text, **_look(sign, 1.0))
            for sign, text in style.LOADINGS.items()
        ]
        entries.append(
            style.mark("open: with another $n$ than predicted", **_look(0, 0.0))
        )
        entries.append(style.mark("law", linewidth=0.8))
        style.draw_key(figure, entries, ncols=3)
    return figure


def _look(theta: float, fill: float) -> Options:
    """Marks of a loading, filled or not."""
    color = style.theta_color(theta)
    return {
        "linestyle": "none",
        "marker": MARKERS[int(np.sign(theta))],
        "markersize": 2.6,
        "markeredgewidth": 0.4,
        "color": color,
        "markerfacecolor": style.pale(color, fill),
    }


def _draw_peaks(axes: Axes, runs: pd.DataFrame) -> None:
    is_right = (runs["predicted_precursors"] - runs["precursors"]).abs() < 0.05
    over = runs[["predicted_coefficient", "coefficient"]].sub(runs["mu_k"], axis=0)
    for right in (False, True):
        of_kind = over[is_right == right]
        for sign, rows in of_kind.groupby(np.sign(runs["theta"])):
            look = _look(float(str(sign)), float(right))
            axes.plot(*rows.to_numpy().T, **look)
    axes.axline((0, 0), slope=1, color=style.BLACK)
    title = f"Nothing counted: $n$ is right in {is_right.mean():.0%} of the runs"
    ends = (0.0, 1.05 * over.to_numpy().max())
    axes.set(xlim=ends, ylim=ends, title=title)
    axes.set_xlabel(r"settled peak of $F_X/F_Z$, less $\mu_k$, predicted [-]")
    axes.set_ylabel("the same in the run [-]")


def _draw_slopes(axes: Axes, runs: pd.DataFrame) -> None:
    """Slopes against t_v, a little apart by loading."""
    times_ms = 1e3 * runs["relaxation_time"]
    law = runs["law_slope"].groupby(times_ms).agg(["min", "median", "max"])
    axes.fill_between(law.index, law["min"], law["max"], color=style.PALE)
    axes.plot(law.index, law["median"], color=style.BLACK)
    for sign, rows in runs.groupby(np.sign(runs["theta"])):
        apart = 1.07 ** float(sign)
        axes.plot(times_ms[rows.index] * apart, rows["slope"], **_look(sign, 1.0))
    axes.axhline(0.0, **style.DOTTED)
    axes.set(xscale="log", title="Peaks alternate where $t_v$ is small")
    axes.set(xlabel="$t_v$ [ms]", ylabel="slope from peak to peak [-]")
    style.set_ticks(axes.xaxis, TIMES_MS)
