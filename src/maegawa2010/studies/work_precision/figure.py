"""Speed against accuracy: how wrong the times of transitions are, and what they cost."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from precursors.figures import style

HEIGHT_MM = 74.0
# Columns of work: the factor to what is drawn, and the words.
WORKS = {
    "seconds": (1e3, "Time to the first global slip [ms]"),
    "evaluations": (1.0, "Evaluations of the forces [-]"),
}
# Short names, and where they stand beside the most accurate point of their curve:
# offset [pt], side. Another method has its label.
NAMES: dict[str, tuple[str, tuple[float, float], str]] = {
    "exact": ("exact solver", (7, -10), "left"),
    "heyoka": ("heyoka", (6, -4), "left"),
    "dop853": ("DOP853,\ncompiled", (5, -12), "left"),
    "scipy_dop853": ("DOP853,\nSciPy", (0, -19), "center"),
    "cvode_adams": ("CVODE", (-5, -5), "right"),
    "rk4_located": ("RK4,\nlocated", (5, -6), "left"),
    "rk4": ("RK4", (8, -8), "left"),
}
SHOWN_TIME_S = 2.7  # doubles near the first global slip are np.spacing of this apart


def draw(
    table: pd.DataFrame,
    sessions: pd.DataFrame | None = None,
    works: Sequence[str] = ("seconds",),
) -> Figure:
    """Draw the largest error of a transition's time against work, up to the first
    global slip.

    `table` is work_precision.csv, and `works` its columns of work. Methods of one
    colour of their own have their names beside them, the others are grey points. A tick
    in the strip is a setting that gives a wrong sequence of transitions. An arrow shows
    how many times as long as the exact solver heyoka takes in `sessions`
    (beside_heyoka.csv).
    """
    true = table["transitions_true"]
    is_right = table["transitions_right"].eq(true) & table["transitions_found"].eq(true)
    rows = table.assign(is_right=is_right)
    width_mm = style.COLUMN_MM if len(works) == 1 else style.PAGE_MM
    with style.page(width_mm, HEIGHT_MM) as figure:
        panels = figure.subplots(
            2,
            len(works),
            sharex="col",
            sharey="row",
            squeeze=False,
            height_ratios=(1, 14),
        )
        for (strip, axes), work in zip(panels.T, works, strict=True):
            factor, words = WORKS[work]
            of_work = rows.assign(work=factor * rows[work])
            _draw_panel(strip, axes, of_work, axes is panels[1, 0])
            axes.set_xlabel(words)
        panels[1, 0].set_ylabel("Largest error of a transition's time [s]")
        panels[0, 0].set_title("wrong sequence of transitions", fontsize="small", pad=2)
        if sessions is not None:
            _draw_factor(panels[1, 0], rows, sessions)
    return figure


def _draw_panel(strip: Axes, axes: Axes, rows: pd.DataFrame, with_names: bool) -> None:
    strip.set(yticks=[], facecolor=style.PALE, xscale="log")
    wrong = rows.loc[~rows["is_right"], "work"]
    strip.vlines(wrong, 0, 1, color=style.GREY, linewidth=0.6)
    right = rows[rows["is_right"] & (rows["error_time_s"] > 0)]
    right = right.sort_values("error_time_s")
    is_grey = right["color"] == style.GREY
    others = right[is_grey]
    axes.scatter(others["work"], others["error_time_s"], 4, color=style.GREY)
    for method, own in right[~is_grey].groupby("method", sort=False):
        first = own.iloc[0]
        axes.plot(
            own["work"],
            own["error_time_s"],
            color=first["color"],
            marker=first["marker"],
            markersize=9 if method == "exact" else 4,
            markeredgewidth=0,
            zorder=3,
        )
        if with_names:
            _name(axes, first)
    axes.set(yscale="log")
    axes.margins(x=0.14, y=0.1)
    style.draw_level(axes, np.spacing(SHOWN_TIME_S), "spacing of doubles", "top")
    for panel in (strip, axes):
        panel.minorticks_off()


def _name(axes: Axes, first: pd.Series) -> None:
    default = (style.plain(first["label"]), (5, 0), "left")
    name, offset, side = NAMES.get(first["method"], default)
    axes.annotate(
        name,
        (first["work"], first["error_time_s"]),
        offset,
        textcoords="offset points",
        ha=side,
        color=first["color"],
        fontsize="small",
    )


def _draw_factor(axes: Axes, rows: pd.DataFrame, sessions: pd.DataFrame) -> None:
    """Draw an arrow as long as the factor in processor time between heyoka and the
    exact solver, both in one process."""
    case = sessions["case"].eq("theta = 0, to the first global slip")
    case &= sessions["quantity"].eq("processor time of heyoka / exact")
    factor = sessions[case].iloc[0]
    exact = rows[rows["method"] == "exact"].iloc[0]
    start = 1e3 * exact["seconds"]
    height = 6.0 * exact["error_time_s"]
    ends = (start, height), (start * factor["value"], height)
    arrow = {"arrowstyle": "->", "linewidth": 0.7, "shrinkA": 0, "shrinkB": 0}
    axes.annotate("", ends[1], ends[0], arrowprops=arrow)
    axes.text(start, 1.5 * height, f"  {factor['value']:.0f} times", fontsize="small")
