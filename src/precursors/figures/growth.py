"""Time of the exact solver per transition against the number of blocks."""

from __future__ import annotations

from pathlib import Path

import pandas as pd
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, LogLocator, NullFormatter, ScalarFormatter, StrMethodFormatter

from precursors.figures import style

HEIGHT_MM = 70.0
COLUMNS = {"kind": str, "n_blocks": int, "seconds_per_transition": float}
US_PER_S = 1e6
MARKS = {"natural": (style.BLACK, "o"), "driven": (style.BLUE, "s"), "front": (style.VERMILION, "^")}
LABELS = {
    "natural": "natural start",
    "driven": "strained, fast drive",
    "front": "first front through all blocks",
}


def read_growth(path: str | Path) -> pd.DataFrame:
    """Read a table of times per transition (tables/growth.csv).

    Raises
    ------
    ValueError
        If a column is missing or holds something else than it should.
    """
    return style.read_columns(path, COLUMNS)


def draw_growth(table: pd.DataFrame) -> Figure:
    """Draw the time per transition over the number of blocks, a line for each way to set the chain in motion.

    Parameters
    ----------
    table : DataFrame
        See `read_growth`: a row per kind of motion and number of blocks.

    Raises
    ------
    ValueError
        If a kind is unknown.
    """
    unknown = set(table["kind"]) - set(MARKS)
    if unknown:
        raise ValueError(f"growth of kind {min(unknown)!r}: allowed are {', '.join(MARKS)}")
    with style.styled():
        figure = style.new_figure(style.COLUMN_MM, HEIGHT_MM)
        axes = figure.subplots()
        for kind, (color, marker) in MARKS.items():
            rows = table[table["kind"] == kind].sort_values("n_blocks")
            if len(rows):
                axes.plot(
                    rows["n_blocks"],
                    US_PER_S * rows["seconds_per_transition"],
                    color=color,
                    marker=marker,
                    markersize=4,
                    label=LABELS[kind],
                )
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.xaxis.set_major_locator(FixedLocator(sorted(table["n_blocks"].unique())))
        axes.xaxis.set_minor_formatter(NullFormatter())
        axes.xaxis.set_major_formatter(ScalarFormatter())
        axes.yaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axes.yaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
        axes.yaxis.set_minor_formatter(NullFormatter())
        axes.grid(linewidth=0.3, color="0.9")
        axes.set_xlabel("Number of blocks $N$")
        axes.set_ylabel("Time per transition [µs]")
        axes.legend(loc="upper left")
        style.lay_out(figure)
    return figure
