"""Speed against accuracy: errors, and how far the sequence of transitions is right, against work."""

from __future__ import annotations

from collections.abc import Iterable
from enum import Enum
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator, NullLocator, PercentFormatter

from precursors.figures import style

HEIGHT_MM = 200.0
LEGEND_COLUMNS = 4
COLUMNS = {
    "theta": float,
    "until": str,
    "method": str,
    "label": str,
    "value": float,
    "evaluations": float,
    "seconds": float,
    "error_load_N": float,
    "error_time_s": float,
    "transitions_right": int,
    "transitions_found": int,
    "transitions_true": int,
    "slips_right": int,
    "slips_found": int,
    "slips_true": int,
}
FIRST_SLIP, WHOLE_RUN = "global slip", "end"
EXTENTS = {FIRST_SLIP: "to the end of the first global slip", WHOLE_RUN: "for the whole run"}

LABELS = (
    "(a) Error of $F_X$ at slip onsets [N]",
    "(b) Error of transition times [s]",
    "(c) Transitions right\nbefore the first wrong one",
)

# A colour is a family, its markers tell the members.
MARKS = {
    "exact": (style.BLACK, "*"),
    "heyoka": (style.VERMILION, "o"),
    "cvode_adams": (style.ORANGE, "s"),
    "cvode_bdf": (style.ORANGE, "D"),
    "scipy_rk45": (style.BLUE, "v"),
    "scipy_dop853": (style.BLUE, "^"),
    "scipy_lsoda": (style.BLUE, "<"),
    "scipy_radau": (style.BLUE, ">"),
    "rk4": (style.GREEN, "s"),
    "rk4_skip": (style.GREEN, "o"),
    "rk4_located": (style.GREEN, "D"),
    "leapfrog": (style.SKY, "v"),
    "semi_implicit_euler": (style.SKY, "^"),
    "moreau_jean_half": (style.PURPLE, "s"),
    "moreau_jean_one": (style.PURPLE, "o"),
    "karnopp": (style.GREY, "o"),
    "literal": (style.GREY, "^"),
    "regularised_radau": (style.GREY, "s"),
    "regularised_bdf": (style.GREY, "D"),
}
OTHERS = (style.GREY, "h")
SIZE, STAR_SIZE = 3.6, 8.0
OPEN: dict[str, Any] = {"markerfacecolor": "none", "markeredgewidth": 0.7, "alpha": 0.75}


class Work(Enum):
    """What a method's work is measured by: column, factor to what is drawn, words."""

    TIME = ("seconds", 1e3, "Wall time {extent} [ms]")
    EVALUATIONS = ("evaluations", 1.0, "Evaluations of the forces {extent}")

    @property
    def column(self) -> str:
        """Column of the table."""
        return self.value[0]

    @property
    def factor(self) -> float:
        """What the column is multiplied by."""
        return self.value[1]

    def label(self, extent: str) -> str:
        """Words for an axis."""
        return self.value[2].format(extent=EXTENTS[extent])


def read_work_precision(path: str | Path) -> pd.DataFrame:
    """Read a table of methods (tables/work_precision.csv).

    Raises
    ------
    ValueError
        If a column is missing or holds something else than it should, or there is no row.
    """
    table = style.read_columns(path, COLUMNS)
    if table.empty:
        raise ValueError(f"{path} has no rows: allowed is at least one method on one scene")
    return table


def draw_work_precision(table: pd.DataFrame, work: Work = Work.TIME) -> Figure:
    """Draw errors of F_X at the onsets of slips, errors of transition times, and the part that is right.

    Parameters
    ----------
    table : DataFrame
        See `read_work_precision`: a row per theta, extent, method and value of its knob.
    work : Work
        The quantity of the horizontal axis.

    Notes
    -----
    A column per theta. The errors are those up to the end of the first global slip, beyond which the motion
    is chaotic; the part that is right is that of the whole run where the table has it. A method's points are
    joined in the order of the table where the sequence is right: of slip events in the first row, of
    transitions in the others. A point where it is wrong is open and stands alone; its error is that of what
    comes before the first difference, and is out of the panel if it is far below those of right sequences.
    """
    rows = table.dropna(subset=work.column).assign(work=table[work.column] * work.factor)
    extent = WHOLE_RUN if (rows["until"] == WHOLE_RUN).any() else FIRST_SLIP
    first, whole = rows[rows["until"] == FIRST_SLIP], rows[rows["until"] == extent]
    thetas = sorted(rows["theta"].unique())
    with style.styled():
        figure = style.new_figure(style.PAGE_MM, HEIGHT_MM)
        panels = figure.subplots(3, len(thetas), sharey="row", squeeze=False)
        for column, theta in zip(panels.T, thetas, strict=True):
            column[0].set_title(style.theta_text(theta), fontsize=8, pad=4)
            load, time, right = column
            at_first = first[first["theta"] == theta]
            _draw_methods(load, at_first, "error_load_N", _is_right(at_first, "slips"))
            _draw_methods(time, at_first, "error_time_s", _is_right(at_first, "transitions"))
            for axes in (load, time):
                axes.set_yscale("log")
                axes.yaxis.set_major_locator(LogLocator(numticks=12))
            at_last = whole[whole["theta"] == theta]
            part = at_last["transitions_right"] / at_last["transitions_true"]
            _draw_methods(right, at_last.assign(part=part), "part", _is_right(at_last, "transitions"))
            right.set_ylim(-0.03, 1.06)
            right.yaxis.set_major_formatter(PercentFormatter(1.0))
            if len(at_last):
                n = int(at_last["transitions_true"].iloc[0])
                right.set_title(f"{n} transitions", fontsize=7, pad=3)
        for row in panels[:2]:
            row[0].set_ylim(bottom=_lowest(row))
        for row, label in zip(panels, LABELS, strict=True):
            row[0].set_ylabel(label)
        for axes in panels.ravel():
            axes.set_xscale("log")
            axes.xaxis.set_minor_locator(NullLocator())
            axes.grid(linewidth=0.3, color="0.9")
        for row, of in ((1, FIRST_SLIP), (2, extent)):
            panels[row, len(thetas) // 2].set_xlabel(work.label(of))
        _draw_legend(figure, table)
        style.lay_out(figure)
    return figure


def _is_right(rows: pd.DataFrame, what: str) -> pd.Series:
    """Whether a run has the sequence of the truth: every one right, and no other."""
    right, found, true = (rows[f"{what}_{of}"] for of in ("right", "found", "true"))
    return (right == true) & (found == true)


def _draw_methods(axes: Axes, rows: pd.DataFrame, column: str, is_right: pd.Series) -> None:
    shown = rows[column].notna() & ((rows[column] > 0) | (column == "part"))
    for method in reversed(list(dict.fromkeys(rows["method"]))):
        of_method = shown & (rows["method"] == method)
        look = _look(method)
        right, wrong = rows[of_method & is_right], rows[of_method & ~is_right]
        axes.plot(right["work"], right[column], **look, gid=f"{method} right")
        axes.plot(wrong["work"], wrong[column], **look | OPEN | {"linestyle": "none"}, gid=f"{method} wrong")


def _lowest(row: Iterable[Axes]) -> float | None:
    """A tenth of the least error of a right sequence: a run that fails at once may have less."""
    errors = [
        np.asarray(line.get_ydata(), dtype=float)
        for axes in row
        for line in axes.lines
        if str(line.get_gid()).endswith(" right")
    ]
    return float(np.concatenate(errors).min()) / 10 if any(map(len, errors)) else None


def _look(method: str) -> dict[str, Any]:
    color, marker = MARKS.get(method, OTHERS)
    is_exact = method == "exact"
    return {
        "color": color,
        "marker": marker,
        "markersize": STAR_SIZE if is_exact else SIZE,
        "markeredgewidth": 0.0,
        "linewidth": 0.9,
        "zorder": 4 if is_exact else 2.5,
    }


def _draw_legend(figure: Figure, table: pd.DataFrame) -> None:
    labels = dict(zip(table["method"], table["label"], strict=True))
    ordered = [*filter(labels.__contains__, MARKS), *(name for name in labels if name not in MARKS)]
    entries = [Line2D([], [], **_look(method), label=style.plain(labels[method])) for method in ordered]
    wrong = {**_look("karnopp"), **OPEN, "linestyle": "none", "color": style.BLACK}
    entries.append(Line2D([], [], **wrong, label="open: wrong sequence"))
    figure.legend(
        handles=entries,
        loc="outside lower center",
        ncols=LEGEND_COLUMNS,
        fontsize=6.5,
        handlelength=2.0,
        handletextpad=0.5,
        columnspacing=1.2,
    )
