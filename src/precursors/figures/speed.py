"""The chart of README: how accurate a method is in how much time."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from precursors.figures import style

HEIGHT_MM = 70.0
SHOWN_TIME_S = 2.7  # doubles near the first global slip are np.spacing of this apart
# Name, colour, and where the name stands beside the most accurate point: offset [pt]
# and alignment.
CURVES = {
    "exact": ("exact solver", style.BLACK, (6, -10), "left"),
    "heyoka": ("heyoka", style.OTHERS[0], (5, -3), "left"),
    "dop853": ("DOP853, compiled", style.OTHERS[1], (5, -3), "left"),
    "scipy_dop853": ("DOP853, SciPy", style.OTHERS[1], (-6, -17), "center"),
    "cvode_adams": ("CVODE", style.OTHERS[2], (-6, -3), "right"),
    "rk4_located": ("Runge-Kutta 4,\nlocated", style.OTHERS[3], (5, 0), "left"),
    "rk4_skip": ("Runge-Kutta 4,\nfixed steps", style.OTHERS[4], (-33, -5), "right"),
}


def draw(table: pd.DataFrame, sessions: pd.DataFrame, theta: float = 0.0) -> Figure:
    """Draw the largest error of a transition's time against the computing time, up to
    the first global slip.

    `table` is work_precision.csv. Settings that give a wrong sequence of transitions
    are ticks in a grey strip. beside_heyoka.csv has the factor in time to heyoka, a
    median of `sessions`.
    """
    rows = table[(table["theta"] == theta) & (table["until"] == "global slip")].dropna(
        subset="seconds"
    )
    is_right = rows["transitions_right"].eq(rows["transitions_true"])
    is_right &= rows["transitions_found"].eq(rows["transitions_true"])
    rows = rows.assign(milliseconds=1e3 * rows["seconds"])
    with style.page(style.COLUMN_MM, HEIGHT_MM) as figure:
        strip, axes = figure.subplots(2, 1, sharex=True, height_ratios=(0.09, 1))
        strip.set(yticks=[], facecolor=style.PALE, xscale="log")
        strip.vlines(
            rows.loc[~is_right, "milliseconds"], 0, 1, color=style.GREY, linewidth=0.6
        )
        strip.set_title(
            "settings with a wrong sequence of transitions",
            fontsize=7,
            color=style.GREY,
            pad=2,
        )
        for method, (name, color, offset, side) in CURVES.items():
            own = rows[is_right & (rows["method"] == method)].sort_values(
                "error_time_s"
            )
            marker = "*" if method == "exact" else "."
            points = own["milliseconds"], own["error_time_s"]
            axes.plot(
                *points,
                color=color,
                marker=marker,
                markersize=8 if method == "exact" else 5,
            )
            look = {
                "color": color,
                "fontsize": 7,
                "ha": side,
                "textcoords": "offset points",
            }
            for best in own.head(1).itertuples():
                axes.annotate(
                    name, (best.milliseconds, best.error_time_s), offset, **look
                )
        axes.set(
            yscale="log",
            ylim=(6e-18, 9e-4),
            xlim=(0.07, 700),
            xlabel="Time to the first global slip [ms]",
        )
        axes.set_ylabel("Largest error of a transition's time [s]")
        axes.axhline(np.spacing(SHOWN_TIME_S), **style.DOTTED)
        axes.annotate(
            "spacing of doubles", (0.99, np.spacing(SHOWN_TIME_S)), xycoords=("axes fraction", "data"),
            xytext=(0, -2), textcoords="offset points", ha="right", va="top", fontsize=7, color=style.GREY,
        )  # fmt: skip
        case = sessions["case"].eq("theta = 0, to the first global slip")
        case &= sessions["quantity"].eq("processor time of heyoka / exact")
        _draw_factor(
            axes, rows[is_right].set_index("method"), sessions.loc[case, "value"].item()
        )
    return figure


def _draw_factor(axes: Axes, right: pd.DataFrame, factor: float) -> None:
    """Draw an arrow from the exact solver to heyoka's most accurate setting, with the
    factor in time."""
    exact, other = (
        right.loc[[name]].sort_values("error_time_s").iloc[0]
        for name in ("exact", "heyoka")
    )
    height = 4.0 * max(exact["error_time_s"], other["error_time_s"])
    ends = [(row["milliseconds"], height) for row in (exact, other)]
    axes.annotate(
        "", ends[1], ends[0], arrowprops={"arrowstyle": "->", "linewidth": 0.7}
    )
    middle = float(np.sqrt(ends[0][0] * ends[1][0]))
    text = f"{factor:.2g} times"
    axes.annotate(
        text,
        (middle, height),
        (0, 3),
        textcoords="offset points",
        ha="center",
        fontsize=7,
    )
