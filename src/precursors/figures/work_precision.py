"""Speed against accuracy: errors, and how far the sequence of transitions is right, against work."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullLocator, PercentFormatter

from precursors.figures import style

HEIGHT_MM = 200.0
FIRST_SLIP, WHOLE_RUN = "global slip", "end"
EXTENTS = {FIRST_SLIP: "to the end of the first global slip", WHOLE_RUN: "for the whole run"}
# Columns that measure the work of a method: the factor to what is drawn, and the words.
WORK = {
    "seconds": (1e3, "Wall time {} [ms]"),
    "evaluations": (1.0, "Evaluations of the forces {}"),
}
LABELS = (
    "(a) Error of $F_X$ at slip onsets [N]",
    "(b) Error of transition times [s]",
    "(c) Transitions right\nbefore the first wrong one",
)
# A color is a family of methods, and its markers tell the members.
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
OPEN: dict[str, Any] = {"markerfacecolor": "none", "markeredgewidth": 0.7, "alpha": 0.75, "linestyle": "none"}


def draw(table: pd.DataFrame, work: str = "seconds") -> Figure:
    """Draw errors of F_X at the onsets of slips, errors of transition times, and the part that is right.

    Parameters
    ----------
    table : DataFrame
        work_precision.csv: a row per theta, extent, method and value of its setting.
    work : {"seconds", "evaluations"}
        Column on the horizontal axis.

    Notes
    -----
    The columns of panels are the values of theta. The errors are those up to the end of the first global
    slip, because the motion is chaotic after it. The part that is right is that of the whole run, if the
    table has it. A point is full, and joined to the others of its method, if the sequence is right: of slip
    events in the first row, of transitions in the others. Else it is open, and its error is that of what
    comes before the first difference; errors far below those of right sequences are outside the panel.
    """
    factor, words = WORK[work]
    rows = table.dropna(subset=work).assign(work=table[work] * factor)
    rows["part"] = rows["transitions_right"] / rows["transitions_true"]
    extent = WHOLE_RUN if (rows["until"] == WHOLE_RUN).any() else FIRST_SLIP
    first, whole = rows[rows["until"] == FIRST_SLIP], rows[rows["until"] == extent]
    thetas = sorted(rows["theta"].unique())
    with style.page(style.PAGE_MM, HEIGHT_MM) as figure:
        panels = figure.subplots(3, len(thetas), sharey="row", squeeze=False)
        for (load, time, right), theta in zip(panels.T, thetas, strict=True):
            load.set_title(style.theta_text(theta), pad=4)
            _draw_methods(load, first[first["theta"] == theta], "error_load_N", "slips")
            _draw_methods(time, first[first["theta"] == theta], "error_time_s", "transitions")
            for axes in (load, time):
                axes.set_yscale("log")
                axes.yaxis.set_major_locator(LogLocator(numticks=12))
            at_last = whole[whole["theta"] == theta]
            _draw_methods(right, at_last, "part", "transitions")
            right.set_ylim(-0.03, 1.06)
            right.yaxis.set_major_formatter(PercentFormatter(1.0))
            for n in at_last["transitions_true"][:1]:
                right.set_title(f"{n} transitions", fontsize=7, pad=3)
        for row in panels[:2]:
            row[0].set_ylim(bottom=_lowest(row))
        for row, label in zip(panels, LABELS, strict=True):
            row[0].set_ylabel(label)
        for axes in panels.flat:
            axes.set_xscale("log")
            axes.xaxis.set_minor_locator(NullLocator())
            axes.grid()
        for row, until in zip(panels[1:], (FIRST_SLIP, extent), strict=True):
            row[len(thetas) // 2].set_xlabel(words.format(EXTENTS[until]))
        _draw_key(figure, dict(zip(table["method"], table["label"], strict=True)))
    return figure


def _draw_methods(axes: Axes, rows: pd.DataFrame, column: str, sequence: str) -> None:
    """Draw a column for all methods; `sequence` is what must be right for a full marker."""
    right, found, true = (rows[f"{sequence}_{what}"] for what in ("right", "found", "true"))
    is_right = (right == true) & (found == true)
    shown = rows[column].notna() & ((rows[column] > 0) | (column == "part"))
    for method in reversed(rows["method"].unique()):
        of_method = shown & (rows["method"] == method)
        full, empty = rows[of_method & is_right], rows[of_method & ~is_right]
        axes.plot(full["work"], full[column], **_look(method), gid=f"{method} right")
        axes.plot(empty["work"], empty[column], **_look(method) | OPEN, gid=f"{method} wrong")


def _lowest(row: Iterable[Axes]) -> float | None:
    """A tenth of the least error of a right sequence: a run that fails at once may have less."""
    lines = [line for axes in row for line in axes.lines if str(line.get_gid()).endswith(" right")]
    errors = [error for line in lines for error in np.asarray(line.get_ydata(), float)]
    return min(errors) / 10 if errors else None


def _look(method: str) -> dict[str, Any]:
    color, marker = MARKS.get(method, OTHERS)
    size, zorder = (8.0, 4.0) if method == "exact" else (3.6, 2.5)
    look: dict[str, Any] = {"color": color, "marker": marker, "markersize": size, "zorder": zorder}
    return look | {"markeredgewidth": 0.0, "linewidth": 0.9}


def _draw_key(figure: Figure, labels: dict[str, str]) -> None:
    ordered = [*filter(labels.__contains__, MARKS), *(name for name in labels if name not in MARKS)]
    entries = [style.mark(style.plain(labels[method]), **_look(method)) for method in ordered]
    wrong = _look("karnopp") | OPEN | {"color": style.BLACK}
    entries.append(style.mark("open: wrong sequence", **wrong))
    spaces = {"handlelength": 2.0, "handletextpad": 0.5, "columnspacing": 1.2}
    style.draw_key(figure, entries, ncols=4, fontsize=6.5, **spaces)
