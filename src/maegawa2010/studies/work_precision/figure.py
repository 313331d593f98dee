"""Speed against accuracy: how wrong the times of transitions are, and what they cost."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure

from precursors.figures import style

HEIGHT_MM = 74.0
# Short name of a method, and its place beside the most accurate point of the curve:
# offset [pt] and alignment. Other methods have their labels.
NAMES: dict[str, tuple[str, tuple[float, float], str]] = {
    "exact": ("exact solver", (7, -10), "left"),
    "heyoka": ("heyoka", (6, 0), "left"),
    "scipy_dop853": ("DOP853,\nSciPy", (0, -19), "center"),
    "cvode_adams": ("CVODE", (-5, -5), "right"),
    "rk4_located": ("RK4,\nlocated", (5, -6), "left"),
    "rk4": ("RK4", (8, -8), "left"),
}
INK = 0.67  # names have this share of the colour: a contrast of at least 4.5 with white
SHOWN_TIME_S = 2.7  # near the first global slip; the spacing of doubles is that of this


def draw(table: pd.DataFrame, compared: str | None = None) -> Figure:
    """Draw the largest error of a transition's time against computing time, up to the
    first global slip.

    `table` is work_precision.csv. A method without a colour of its own is left out. A
    tick at the top is a setting that gives a wrong sequence of transitions. An arrow
    shows how many times as long as the exact solver the method `compared` takes, with
    its setting of `fastest_as_accurate`.
    """
    is_shown = table["color"].ne(style.GREY)
    milliseconds = 1e3 * table["seconds"]
    rows = table.assign(is_right=_is_right(table), work=milliseconds)[is_shown]
    with style.page(style.COLUMN_MM, HEIGHT_MM) as figure:
        axes = figure.subplots()
        _draw_points(axes, rows)
        axes.set_xlabel("Computing time up to the first global slip [ms]")
        axes.set_ylabel("Largest error of a transition's time [s]")
        axes.set_title(
            "Ticks: runs with a wrong sequence of transitions", fontsize="small"
        )
        if compared is not None:
            _draw_factor(axes, rows, compared)
    return figure


def fastest_as_accurate(table: pd.DataFrame, method: str) -> pd.Series:
    """The row of a method that is compared with the exact solver.

    It is the fastest setting whose error is no larger than the exact solver's. If there
    is none, it is the most accurate setting that finds every transition.
    """
    (limit,) = table["time_error_s"][table["method"] == "exact"]
    settings = table[table["method"].eq(method) & _is_right(table)]
    errors = settings["time_error_s"]
    close = settings[errors <= max(limit, errors.min())]
    return close.loc[close["seconds"].idxmin()]


def _is_right(table: pd.DataFrame) -> pd.Series:
    """Whether a run has all true transitions, and no other."""
    true = table["transitions_true"]
    return table["transitions_right"].eq(true) & table["transitions_found"].eq(true)


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
        color=tuple(INK * np.array(to_rgb(first["color"]))),
        fontsize="small",
    )


def _draw_factor(axes: Axes, rows: pd.DataFrame, method: str) -> None:
    """Draw an arrow from the exact solver's point to that of a method."""
    ends = (fastest_as_accurate(rows, name) for name in ("exact", method))
    (x, y), (x_end, y_end) = (row[["work", "time_error_s"]] for row in ends)
    arrow = {"arrowstyle": "->", "linewidth": 0.7, "shrinkA": 8, "shrinkB": 3}
    axes.annotate("", (x_end, y_end), (x, y), arrowprops=arrow)
    axes.annotate(
        f"{x_end / x:.0f} times",
        (np.sqrt(x * x_end), np.sqrt(y * y_end)),
        (-6, 4),
        textcoords="offset points",
        ha="center",
        fontsize="small",
    )
