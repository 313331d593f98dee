"""Speed against accuracy: errors, and how far the sequence of transitions is right,
against work."""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from typing import Any

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullLocator, PercentFormatter

from precursors.figures import style

HEIGHT_MM = 190.0
FIRST_SLIP = "global slip"
WHOLE_RUN = "end"
EXTENTS = {
    FIRST_SLIP: "to the end of the first global slip",
    WHOLE_RUN: "for the whole run",
}
# Columns that measure the work of a method: the factor to what is drawn, and the words.
WORK = {
    "seconds": (1e3, "Wall time {} [ms]"),
    "evaluations": (1.0, "Evaluations of the forces {}"),
}
# Columns of errors, what must be right for an error to count, and the words.
ERRORS = (
    ("error_load_N", "slips", "(a) Error of $F_X$\nat slip onsets [N]"),
    ("error_time_s", "transitions", "(b) Error of\ntransition times [s]"),
)
PART_LABEL = "(c) Transitions right\nbefore the first wrong one"
# Of the rows: wrong sequences and errors twice, and the part that is right.
HEIGHTS = (1.0, 2.4, 1.0, 2.4, 2.8)
Look = dict[str, Any]
OPEN: Look = {
    "markerfacecolor": "none",
    "markeredgewidth": 0.7,
    "alpha": 0.75,
    "linestyle": "none",
}


def draw(table: pd.DataFrame, work: str = "seconds") -> Figure:
    """Draw errors of F_X at the onsets of slips, errors of transition times, and the
    part that is right.

    `table` is work_precision.csv, and `work` its column on the horizontal axis. A
    column of panels is a value of theta. The errors are those up to the end of the
    first global slip, because the motion is chaotic after it; a method has one only if
    its sequence is right: of slip events in (a), of transitions in (b). A wrong
    sequence is open, in a band above the errors, as high as the part of it that is
    wrong. The part that is right is that of the whole run, if the table has it.
    """
    factor, words = WORK[work]
    rows = table.dropna(subset=work).assign(work=table[work] * factor)
    extent = WHOLE_RUN if (rows["until"] == WHOLE_RUN).any() else FIRST_SLIP
    first = rows[rows["until"] == FIRST_SLIP]
    whole = rows[rows["until"] == extent]
    thetas = sorted(rows["theta"].unique())
    looks = {row["method"]: _look(row) for row in table.to_dict("records")}
    with style.page(style.PAGE_MM, HEIGHT_MM) as figure:
        panels = figure.subplots(
            5,
            len(thetas),
            sharex="col",
            sharey="row",
            squeeze=False,
            height_ratios=HEIGHTS,
        )
        for column, theta in zip(panels.T, thetas, strict=True):
            column[0].set_title(style.theta_text(theta), pad=4)
            of_theta = first[first["theta"] == theta]
            for i, (error, sequence, _) in enumerate(ERRORS):
                _draw_errors(
                    column[2 * i], column[2 * i + 1], of_theta, error, sequence, looks
                )
            of_theta = whole[whole["theta"] == theta]
            _draw_right(column[-1], of_theta, looks)
            for n in of_theta["transitions_true"][:1]:
                column[-1].set_title(f"{n} transitions", fontsize=7, pad=3)
        for i, (*_, label) in enumerate(ERRORS):
            panels[2 * i, 0].set_ylabel("Wrong part of\na sequence")
            panels[2 * i + 1, 0].set_ylabel(label)
        panels[-1, 0].set_ylabel(PART_LABEL)
        for axes in panels.flat:
            axes.set_xscale("log")
            axes.xaxis.set_minor_locator(NullLocator())
            axes.grid()
        for row, until in ((3, FIRST_SLIP), (4, extent)):
            for axes in panels[row]:
                axes.tick_params(labelbottom=True)
            panels[row, len(thetas) // 2].set_xlabel(words.format(EXTENTS[until]))
        figure.align_ylabels(panels[:, 0])
        names = table.drop_duplicates("method").set_index("method")["label"]
        entries = [
            style.mark(style.plain(label), **looks[method])
            for method, label in names.items()
        ]
        entries.append(
            style.mark("open: wrong sequence", marker="o", markersize=4.2, **OPEN)
        )
        style.draw_key(figure, entries, ncols=4, handletextpad=0.5, columnspacing=1.2)
    return figure


def _draw_errors(
    band: Axes,
    axes: Axes,
    rows: pd.DataFrame,
    error: str,
    sequence: str,
    looks: Mapping[str, Look],
) -> None:
    """Draw the errors of right sequences, joined, and above them the wrong
    sequences."""
    is_right, part = _right(rows, sequence)
    for method in reversed(rows["method"].unique()):
        of_method = rows["method"] == method
        right = rows[of_method & is_right & (rows[error] > 0)]
        axes.plot(right["work"], right[error], **looks[method])
        wrong = of_method & ~is_right
        band.plot(rows["work"][wrong], 1 - part[wrong], **looks[method] | OPEN)
    axes.set_yscale("log")
    axes.yaxis.set_major_locator(LogLocator(numticks=12))
    band.set_ylim(-0.12, 1.12)
    band.yaxis.set_major_formatter(PercentFormatter(1.0))


def _draw_right(axes: Axes, rows: pd.DataFrame, looks: Mapping[str, Look]) -> None:
    """Draw the part of the transitions that comes before the first wrong one."""
    is_right, part = _right(rows, "transitions")
    for method in reversed(rows["method"].unique()):
        for chosen, look in ((is_right, {}), (~is_right, OPEN)):
            of_method = chosen & (rows["method"] == method)
            axes.plot(rows["work"][of_method], part[of_method], **looks[method] | look)
    axes.set_ylim(-0.03, 1.06)
    axes.yaxis.set_major_formatter(PercentFormatter(1.0))


def _right(rows: pd.DataFrame, sequence: str) -> tuple[pd.Series, pd.Series]:
    """Whether the whole sequence is right, and the part of it before the first
    difference."""
    right, found, true = (
        rows[f"{sequence}_{what}"] for what in ("right", "found", "true")
    )
    return (right == true) & (found == true), right / true


def _look(row: Mapping[Hashable, Any]) -> Look:
    """How a method is drawn, from its row's colour and marker ("3,1,180" is a
    tuple)."""
    marker = (
        tuple(map(int, row["marker"].split(",")))
        if "," in row["marker"]
        else row["marker"]
    )
    size, zorder = (8.0, 4.0) if row["method"] == "exact" else (4.2, 2.5)
    look = {
        "color": row["color"],
        "marker": marker,
        "markersize": size,
        "zorder": zorder,
    }
    return look | {"markeredgewidth": 0.0, "linewidth": 0.9}
