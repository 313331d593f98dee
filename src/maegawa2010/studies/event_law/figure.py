"""The number of slip events up to the first global slip, compared with the law."""

from __future__ import annotations

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from precursors.figures import style

HEIGHT_MM = 56.0
MARKERS = "vDos^"  # of each theta, from light to heavy leading block
ROOM = 0.45  # for the names of the curves, in units of the smallest N
GAP = 0.07  # between two of them
LAW = (
    r"$n = \dfrac{\mu_k}{\mu_s - \mu_k}\;"
    r"\dfrac{F_Z - w_1 + (K/k)\;\Sigma_i\, (i - 1)\, w_i}{w_1}$"
)


def draw(table: pd.DataFrame) -> Figure:
    """Draw how many times as many events as the law gives a run has, against N.

    The table is event_law.csv; only its chains with linear loads are drawn.
    """
    linear = table[table["varied"] == "n_and_theta"]
    with style.page(style.COLUMN_MM, HEIGHT_MM) as figure:
        axes = figure.subplots()
        for (_, rows), marker in zip(linear.groupby("theta"), MARKERS, strict=True):
            theta = rows["theta"].iloc[0]
            limits = rows[["ratio_low", "ratio_high"]].sub(rows["ratio"], axis=0)
            axes.errorbar(
                rows["n_blocks"],
                rows["ratio"],
                abs(limits.T),
                color=style.theta_color(theta),
                marker=marker,
            )
        style.draw_level(axes, 1.0, "the law")
        axes.text(0.5, 0.1, LAW, transform=axes.transAxes, ha="center")
        axes.margins(y=0.12)
        axes.set(xscale="log", ylim=(0, None), xlabel=style.BLOCKS_LABEL)
        axes.set_xlim(ROOM * linear["n_blocks"].min())
        axes.set_ylabel("Events in runs / by the law [-]")
        style.set_ticks(axes.xaxis, sorted(linear["n_blocks"].unique()))
        least, most = 100 * linear["ratio"].agg(["min", "max"])
        axes.set_title(f"Runs have {least:.0f} to {most:.0f} % of the law's events")
        _name_curves(axes, linear)
    return figure


def _name_curves(axes: Axes, linear: pd.DataFrame) -> None:
    """Write theta before the first point of each curve, from the lowest to the
    highest."""
    first = linear[linear["n_blocks"] == linear["n_blocks"].min()]
    height = 0.0
    for row in first.sort_values("ratio").itertuples():
        height = max(row.ratio, height + GAP)
        axes.text(
            0.9 * row.n_blocks,
            height,
            style.theta_text(row.theta),
            ha="right",
            va="center",
            color=style.theta_color(row.theta),
            fontsize="small",
        )
