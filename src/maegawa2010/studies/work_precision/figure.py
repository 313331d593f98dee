"""Speed against accuracy: how wrong the times of transitions are, and what they cost."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from precursors.figures import style

HEIGHT_MM = 74.0
# Short names, and where they stand beside the most accurate point of their curve:
# offset [pt], side. Another method has its label.
NAMES: dict[str, tuple[str, tuple[float, float], str]] = {
    "exact": ("exact solver", (7, -10), "left"),
    "heyoka": ("heyoka", (6, -4), "left"),
    "scipy_dop853": ("DOP853,\nSciPy", (0, -19), "center"),
    "cvode_adams": ("CVODE", (-5, -5), "right"),
    "rk4_located": ("RK4,\nlocated", (5, -6), "left"),
    "rk4": ("RK4", (8, -8), "left"),
}
COMPARED = "heyoka"
SHOWN_TIME_S = 2.7  # doubles near the first global slip are np.spacing of this apart


def draw(table: pd.DataFrame) -> Figure:
    """Draw the largest error of a transition's time against computing time, up to the
    first global slip.

    `table` is work_precision.csv. A method without a colour of its own is left out. A
    tick at the top is a setting that gives a wrong sequence of transitions. An arrow
    shows how many times as long as the exact solver heyoka takes, at its last setting.
    """
    true = table["transitions_true"]
    is_right = table["transitions_right"].eq(true) & table["transitions_found"].eq(true)
    is_shown = table["color"].ne(style.GREY)
    milliseconds = 1e3 * table["seconds"]
    rows = table.assign(is_right=is_right, work=milliseconds)[is_shown]
    with style.page(style.COLUMN_MM, HEIGHT_MM) as figure:
        axes = figure.subplots()
        _draw_points(axes, rows)
        axes.set_xlabel("Time to the first global slip [ms]")
        axes.set_ylabel("Largest error of a transition's time [s]")
        axes.set_title("ticks: wrong sequence of transitions", fontsize="small")
        if COMPARED in set(rows["method"]):
            _draw_factor(axes, rows)
    return figure


def _draw_points(axes: Axes, rows: pd.DataFrame) -> None:
    wrong = rows[~rows["is_right"]]
    top = axes.get_xaxis_transform()
    axes.vlines(
        wrong["work"], 0.96, 1.0, wrong["color"].tolist(), linewidth=0.8, transform=top
    )
    right = rows[rows["is_right"] & (rows["time_error_s"] > 0)]
    right = right.sort_values("time_error_s")
    for method, own in right.groupby("method", sort=False):
        first = own.iloc[0]
        axes.plot(
            own["work"],
            own["time_error_s"],
            color=first["color"],
            marker=first["marker"],
            markersize=9 if method == "exact" else 4,
            markeredgewidth=0,
            zorder=3,
        )
        _name(axes, first)
    axes.set(xscale="log", yscale="log")
    axes.margins(x=0.2, y=0.1)
    floor = np.spacing(SHOWN_TIME_S)
    axes.axhline(floor, **style.DOTTED)
    axes.text(
        0.98,
        floor,
        "spacing of doubles",
        ha="right",
        va="top",
        fontsize="small",
        transform=axes.get_yaxis_transform(),
    )
    axes.tick_params(which="minor", left=False, labelbottom=False)


def _name(axes: Axes, first: pd.Series) -> None:
    default = (style.plain(first["label"]), (5, 0), "left")
    name, offset, side = NAMES.get(first["method"], default)
    axes.annotate(
        name,
        (first["work"], first["time_error_s"]),
        offset,
        textcoords="offset points",
        ha=side,
        color=first["color"],
        fontsize="small",
    )


def _draw_factor(axes: Axes, rows: pd.DataFrame) -> None:
    """Draw an arrow from the exact solver's point to the last one of a method."""
    of_method = rows.groupby("method")[["work", "time_error_s"]].last()
    (x, y), (x_end, y_end) = of_method.loc[["exact", COMPARED]].to_numpy()
    arrow = {"arrowstyle": "->", "linewidth": 0.7, "shrinkA": 8, "shrinkB": 3}
    axes.annotate("", (x_end, y_end), (x, y), arrowprops=arrow)
    words = f"{x_end / x:.0f} times  "
    middle = (np.sqrt(x * x_end), np.sqrt(y * y_end))
    axes.text(*middle, words, ha="right", va="bottom", fontsize="small")
