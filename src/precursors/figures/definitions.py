"""Readings of what the paper leaves open: events kept and mu_sapp of each, and how many are the paper's."""

from __future__ import annotations

import re

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from precursors.figures import style

ROW_MM = 5.4
MARGIN_MM = 34.0
READING = ["global_slip", "short", "front"]
RESULTS = ["events_kept", "mu_sapp"]
# None, one and both of the two numbers of a cell are the paper's.
AGREEMENT = ListedColormap(["white", "#D6EAF7", style.SKY])
# No to six numbers of a reading and size of theta.
NUMBERS = ListedColormap(["white", "#EDF5FA", "#D6EAF7", "#B5D9F0", "#8AC6EA", style.SKY, style.BLUE])
SIX = 6
# Where the outer names of the rows stand, in widths of the left panel, and what they tell apart.
OUTER_NAMES = {-0.17: ["global_slip", "short"], -0.34: ["global_slip"]}

SHORT_NAMES = {
    "in which all blocks slide at the same instant": "all blocks\nslide at once",
    "in which every block slides at some time": "each slides\nat some time",
    "shorter than one before it": "shorter than\none before",
    "not longer than all before it": "not longer than\nall before",
    "shorter than the one just before it": "shorter than\nthe last",
    "farthest block that slid": "farthest block",
    "number of blocks that slid": "all that slid",
    "most blocks that slid at the same instant": "most at once",
}


def draw_definitions(table: pd.DataFrame) -> Figure:
    """Draw events kept and mu_sapp of every reading (rows) at every theta (columns).

    Parameters
    ----------
    table : DataFrame
        tables/definitions.csv. Lengths of an event that give the same numbers throughout share a row.

    Raises
    ------
    ValueError
        If the table has no rows.
    """
    if table.empty:
        raise ValueError("the table of definitions has no rows: allowed is at least one reading")
    merged = _merge_fronts(table)
    readings = merged[READING].drop_duplicates().reset_index(drop=True)
    thetas = sorted(merged["theta"].unique())
    sizes = sorted({abs(theta) for theta in thetas if theta})
    with style.styled():
        figure = style.new_figure(style.PAGE_MM, MARGIN_MM + ROW_MM * len(readings))
        left, right = figure.subplots(1, 2, sharey=True, width_ratios=[len(thetas), 0.5 * len(sizes)])
        _draw_numbers(left, merged, readings, thetas)
        _draw_agreement(right, merged, readings, sizes)
        _label_rows(left, readings)
        figure.legend(
            handles=[
                Patch(facecolor=AGREEMENT(count), edgecolor=style.GREY, linewidth=0.4, label=label)
                for count, label in ((2, "both are the paper's"), (1, "one is"), (0, "none is"))
            ],
            loc="outside lower center",
            ncols=3,
        )
        style.lay_out(figure)
    return figure


def _merge_fronts(table: pd.DataFrame) -> pd.DataFrame:
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


def _draw_numbers(axes: Axes, table: pd.DataFrame, readings: pd.DataFrame, thetas: list[float]) -> None:
    cells = table.drop_duplicates([*READING, "theta"]).set_index([*READING, "theta"])
    agree = np.zeros((len(readings), len(thetas)))
    for row, reading in enumerate(readings.itertuples(index=False, name=None)):
        for column, theta in enumerate(thetas):
            cell = cells.loc[(*reading, theta)]
            agree[row, column] = cell["events_kept_is_papers"] + int(cell["mu_sapp_is_papers_within_a_digit"])
            kept = "-" if pd.isna(cell["events_kept"]) else f"{cell['events_kept']:.0f}"
            friction = "-" if pd.isna(cell["mu_sapp"]) else f"{cell['mu_sapp']:.3f}"
            axes.text(column, row, f"{kept}\n{friction}", ha="center", va="center", fontsize=5)
    axes.pcolormesh(
        np.arange(len(thetas) + 1) - 0.5,
        np.arange(len(readings) + 1) - 0.5,
        agree,
        cmap=AGREEMENT,
        vmin=-0.5,
        vmax=2.5,
        edgecolors=style.GREY,
        linewidth=0.2,
    )
    axes.set_xticks(range(len(thetas)), [f"${style.fraction_text(theta)}$" for theta in thetas])
    axes.set_xlabel(r"$\theta$")
    axes.set_title(r"Events kept, and below them $\mu_{\mathrm{sapp}}$", fontsize=7)
    axes.xaxis.tick_top()
    axes.xaxis.set_label_position("top")
    axes.tick_params(length=0)


def _draw_agreement(axes: Axes, table: pd.DataFrame, readings: pd.DataFrame, sizes: list[float]) -> None:
    cells = table.assign(size=table["theta"].abs()).drop_duplicates([*READING, "size"])
    numbers = cells.set_index([*READING, "size"])["numbers_within_a_digit"]
    six = np.array(
        [
            [numbers[(*reading, size)] for size in sizes]
            for reading in readings.itertuples(index=False, name=None)
        ]
    )
    axes.pcolormesh(
        np.arange(len(sizes) + 1) - 0.5,
        np.arange(len(readings) + 1) - 0.5,
        six,
        cmap=NUMBERS,
        vmin=-0.5,
        vmax=SIX + 0.5,
        edgecolors=style.GREY,
        linewidth=0.2,
    )
    for (row, column), value in np.ndenumerate(six):
        color, weight = ("white", "bold") if value == SIX else (style.BLACK, "normal")
        axes.text(
            column, row, f"{value}", ha="center", va="center", fontsize=5.5, color=color, fontweight=weight
        )
    axes.set_xticks(range(len(sizes)), [f"${style.fraction_text(size)}$" for size in sizes])
    axes.set_xlabel(r"$|\theta|$")
    axes.set_title("Of the paper's six\nnumbers, so many", fontsize=7)
    axes.xaxis.tick_top()
    axes.tick_params(axis="x", rotation=90, labelsize=6)
    axes.xaxis.set_label_position("top")
    axes.tick_params(length=0)


def _label_rows(axes: Axes, readings: pd.DataFrame) -> None:
    """Name the length of an event beside its row, short events and global slips beside theirs."""
    axes.set_ylim(len(readings) - 0.5, -0.5)
    axes.set_yticks(range(len(readings)), readings["front"].tolist(), fontsize=5.5)
    for at, title in zip(
        (0.0, *OUTER_NAMES), ("length of\nan event", "short\nevent", "global\nslip"), strict=True
    ):
        axes.text(at - 0.01, 1.01, title, transform=axes.transAxes, ha="right", fontsize=5.5, style="italic")
    for at, names in OUTER_NAMES.items():
        rows: dict[tuple[str, ...], list[int]] = {}
        for row, reading in enumerate(readings[names].itertuples(index=False, name=None)):
            rows.setdefault(reading, []).append(row)
        outer = axes.secondary_yaxis(at)
        middles = [float(np.mean(numbers)) for numbers in rows.values()]
        outer.set_yticks(middles, [_short_name(reading[-1]) for reading in rows], fontsize=5.5)
        outer.tick_params(length=0)
        outer.spines["left"].set_visible(False)
    for numbers in list(rows.values())[:-1]:
        for panel in axes.figure.axes:
            panel.axhline(numbers[-1] + 0.5, color=style.BLACK, linewidth=0.8)


def _short_name(text: str) -> str:
    drop = re.fullmatch(r"in which F_X drops by more than (\S+) N", text)
    return f"$F_X$ drops by\nmore than {drop[1]} N" if drop else SHORT_NAMES.get(text, text)
