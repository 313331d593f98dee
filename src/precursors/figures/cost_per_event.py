"""Processor time of the exact solver per transition against the number of blocks."""

from __future__ import annotations

import pandas as pd
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullFormatter, StrMethodFormatter

from precursors.figures import style

HEIGHT_MM = 70.0
US_PER_S = 1e6
# Colour, marker and name of each way to set the chain in motion.
KINDS = {
    "natural": (style.BLACK, "o", "natural start"),
    "driven": (style.BLUE, "s", "strained, fast drive"),
    "front": (style.VERMILION, "^", "first front through all blocks"),
}


def draw(table: pd.DataFrame) -> Figure:
    """Draw the time per transition, a line for each way to set the chain in motion (cost_per_event.csv)."""
    with style.page(style.COLUMN_MM, HEIGHT_MM) as figure:
        axes = figure.subplots()
        for kind, (color, marker, label) in KINDS.items():
            rows = table[table["kind"] == kind].sort_values("n_blocks")
            time_us = US_PER_S * rows["seconds_per_transition"]
            axes.plot(rows["n_blocks"], time_us, color=color, marker=marker, markersize=4, label=label)
        axes.set(xscale="log", yscale="log", xlabel="Number of blocks $N$", ylabel="Time per transition [µs]")
        style.set_ticks(axes.xaxis, sorted(table["n_blocks"].unique()))
        axes.yaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axes.yaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
        axes.yaxis.set_minor_formatter(NullFormatter())
        axes.grid()
        axes.legend(loc="upper left")
    return figure
