"""The number of slip events up to the first global slip, compared with the law."""

from __future__ import annotations

import pandas as pd
from matplotlib.figure import Figure

from precursors.figures import style

HEIGHT_MM = 66.0
MARKERS = "vDos^"  # of each theta, from light to heavy leading block


def draw(table: pd.DataFrame) -> Figure:
    """Draw how many times as many events as the law gives a run has, against N.

    The table is event_law.csv; only its chains with linear loads are drawn.
    """
    linear = table[table["varied"] == "n_and_theta"]
    with style.page(style.COLUMN_MM, HEIGHT_MM) as figure:
        axes = figure.subplots()
        for (_, rows), marker in zip(linear.groupby("theta"), MARKERS, strict=True):
            theta = rows["theta"].iloc[0]
            low, high = (
                abs(rows[f"ratio_{end}"] - rows["ratio"]) for end in ("low", "high")
            )
            axes.errorbar(
                rows["n_blocks"],
                rows["ratio"],
                [low, high],
                color=style.theta_color(theta),
                marker=marker,
                label=style.theta_text(theta),
            )
        style.draw_level(axes, 1.0, "the law")
        axes.margins(y=0.12)
        axes.set(xscale="log", ylim=(0, None), xlabel=style.BLOCKS_LABEL)
        axes.set_ylabel("Events in runs / by the law [-]")
        style.set_ticks(axes.xaxis, sorted(linear["n_blocks"].unique()))
        style.draw_key(figure, axes.get_legend_handles_labels()[0], ncols=3)
    return figure
