"""Events counted and mu_sapp for every reading of what the paper leaves open."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from precursors.figures import style

ROW_MM, MARGIN_MM = 6.0, 36.0
READING = ["global_slip", "short", "front"]
RESULTS = ["events_counted", "mu_sapp"]
# Shades by how many of the two numbers of a cell, or of the six of a reading and |theta|, are the paper's.
OF_TWO = ListedColormap(["white", "#D6EAF7", style.SKY])
OF_SIX = ListedColormap(["white", "#EDF5FA", "#D6EAF7", "#B5D9F0", "#8AC6EA", style.SKY, style.BLUE])
SIX = 6
SMALL = 7
# The columns of names left of the rows: the place in widths of the left panel, and the heading.
NAMES = {
    "front": (0.0, "length of\nan event"),
    "short": (-0.22, "short\nevent"),
    "global_slip": (-0.41, "global\nslip"),
}
SHORT_NAMES = {
    "in which all blocks slide at the same instant": "all blocks\nat once",
    "in which every block slides at some time": "each at\nsome time",
    "shorter than one before it": "shorter than\none before",
    "not longer than all before it": "not the\nlongest so far",
    "shorter than the one just before it": "shorter than\nthe last",
    "farthest block that slid": "farthest block",
    "number of blocks that slid": "all that slid",
    "most blocks that slid at the same instant": "most at once",
}


def draw(table: pd.DataFrame) -> Figure:
    """Draw events counted and mu_sapp of every reading (rows) at every theta (columns).

    Lengths of an event that give the same numbers at every theta share a row (definitions.csv). The rule of
    switching is the first of the table, ours.
    """
    table = table[table["switching"] == table["switching"].iloc[0]]
    table = _merge_lengths(table).assign(size=table["theta"].abs())
    counts_agree = table["events_counted_is_papers"].astype(int)
    table["of_two"] = counts_agree + table["mu_sapp_is_papers_within_a_digit"]
    rows = pd.MultiIndex.from_frame(table[READING].drop_duplicates())
    of_two, counts, mu_sapp = (
        table.pivot_table(value, READING, "theta", "first", dropna=False).loc[rows]
        for value in ("of_two", *RESULTS)
    )
    of_six = (
        table[table["size"] > 0].pivot_table("numbers_within_a_digit", READING, "size", "first").loc[rows]
    )
    with style.page(style.PAGE_MM, MARGIN_MM + ROW_MM * len(rows)) as figure:
        widths = [of_two.shape[1], 0.5 * of_six.shape[1]]
        left, right = figure.subplots(1, 2, sharey=True, width_ratios=widths)
        texts = [
            f"{_number(n, '.0f')}\n{_number(mu, '.3f')}"
            for n, mu in zip(counts.to_numpy().flat, mu_sapp.to_numpy().flat, strict=True)
        ]
        _draw_cells(left, of_two, OF_TWO, texts, fontsize=SMALL)
        left.set_xlabel(r"$\theta$")
        left.set_title(r"Events counted, and below them $\mu_{\mathrm{sapp}}$", fontsize=7)
        _draw_cells(right, of_six, OF_SIX, [f"{n:.0f}" for n in of_six.to_numpy().flat], fontsize=SMALL)
        right.set_xlabel(r"$|\theta|$")
        right.set_title("Of the paper's six\nnumbers, so many", fontsize=7)
        for axes in (left, right):
            axes.tick_params(axis="x", rotation=90)
        for text in right.texts:
            if text.get_text() == f"{SIX}":
                text.set(color="white", fontweight="bold")
        _name_rows(left, rows.to_frame(index=False))
        edge: dict[str, Any] = {"edgecolor": style.GREY, "linewidth": 0.4}
        labels = {2: "both are the paper's", 1: "one is", 0: "none is"}
        style.draw_key(figure, [Patch(facecolor=OF_TWO(n), label=text, **edge) for n, text in labels.items()])
    return figure


def _merge_lengths(table: pd.DataFrame) -> pd.DataFrame:
    """Put readings that differ in the length of an event only, and in no number, into one."""
    alike: dict[tuple[str, ...], list[str]] = {}
    for reading, rows in table.groupby(READING, sort=False):
        global_slip, short, front = map(str, reading)
        # NaN is unequal to itself; as text it is not.
        alike.setdefault((global_slip, short, repr(rows[RESULTS].to_numpy().tolist())), []).append(front)
    parts = []
    for (global_slip, short, _), fronts in alike.items():
        of_first = (table[READING] == [global_slip, short, fronts[0]]).all(axis=1)
        parts.append(table[of_first].assign(front=" =\n".join(SHORT_NAMES.get(f, f) for f in fronts)))
    return pd.concat(parts)


def _number(value: float, form: str) -> str:
    return "-" if pd.isna(value) else f"{value:{form}}"


def _draw_cells(
    axes: Axes, values: pd.DataFrame, colors: ListedColormap, texts: Sequence[str], fontsize: float
) -> None:
    n_rows, n_columns = values.shape
    grid: dict[str, Any] = {"edgecolors": style.GREY, "linewidth": 0.2}
    edges = np.arange(n_columns + 1) - 0.5, np.arange(n_rows + 1) - 0.5
    axes.pcolormesh(*edges, values, cmap=colors, vmin=-0.5, vmax=colors.N - 0.5, **grid)
    for (row, column), text in zip(np.ndindex(values.shape), texts, strict=True):
        axes.text(column, row, text, ha="center", va="center", fontsize=fontsize, linespacing=1.0)
    axes.set_xticks(range(n_columns), [f"${style.fraction_text(float(theta))}$" for theta in values.columns])
    axes.xaxis.tick_top()
    axes.xaxis.set_label_position("top")
    axes.tick_params(length=0)


def _name_rows(axes: Axes, readings: pd.DataFrame) -> None:
    """Name the length of an event beside its row, and short events and global slips once for their rows."""
    axes.set_ylim(len(readings) - 0.5, -0.5)
    for column, (place, heading) in NAMES.items():
        at = {"transform": axes.transAxes, "ha": "right"}
        axes.text(place - 0.01, 1.01, heading, **at, fontsize=SMALL, style="italic")  # type: ignore[arg-type]
        keys = READING[: READING.index(column) + 1]
        begins = (readings[keys] != readings[keys].shift()).any(axis=1)
        groups = [rows.index for _, rows in readings.groupby(begins.cumsum())]
        names = [_short_name(readings.loc[rows[0], column]) for rows in groups]
        names_axis = axes.yaxis
        if place:
            outer = axes.secondary_yaxis(place)
            outer.tick_params(length=0)
            outer.spines["left"].set_visible(False)
            names_axis = outer.yaxis
        names_axis.set_ticks([np.mean(rows) for rows in groups], names, fontsize=SMALL)
    for rows in groups[:-1]:
        for panel in axes.figure.axes:
            panel.axhline(rows[-1] + 0.5, color=style.BLACK)


def _short_name(text: str) -> str:
    drop = re.fullmatch(r"in which F_X drops by more than (\S+) N", text)
    return f"$F_X$ drop\nabove {drop[1]} N" if drop else SHORT_NAMES.get(text, text)
