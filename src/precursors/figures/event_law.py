"""The number of slip events up to the first global slip beside the law, and where the
law fails."""

from __future__ import annotations

from typing import Any

import pandas as pd
from matplotlib.figure import Figure
from matplotlib.ticker import StrMethodFormatter

from precursors.figures import style

HEIGHT_MM = 66.0
# Colour and marker of each theta, from light to heavy leading block.
THETA_COLORS = {
    -0.9: (style.PUSHED_END, "v"),
    -5 / 6: (style.PUSHED_END, "D"),
    0.0: (style.EVEN, "o"),
    5 / 6: (style.FAR_END, "s"),
    0.95: (style.FAR_END, "^"),
}
# What else is varied.
OTHERS = {
    "friction": (style.GREY, "x", r"other $\mu_s$, $\mu_k$"),
    "drive": (style.GREY, "+", "other $K$"),
    "loading": (style.GREY, "*", "not linear"),
}


def draw(table: pd.DataFrame) -> Figure:
    """Draw counts against the law, their ratio against N, and the load between two
    events (event_law.csv)."""
    with style.page(style.PAGE_MM, HEIGHT_MM) as figure:
        counts, ratios, rises = figure.subplots(1, 3)
        linear = table[table["varied"] == "n_and_theta"]
        for theta, rows in linear.groupby("theta"):
            color, marker = min(
                THETA_COLORS.items(), key=lambda item: abs(item[0] - float(str(theta)))
            )[1]
            look: dict[str, Any] = {"color": color, "marker": marker, "markersize": 3.5}
            counts.plot(rows["law"], rows["events"], **look, linestyle="none")
            errors = [
                rows["ratio"] - rows["ratio_low"],
                rows["ratio_high"] - rows["ratio"],
            ]
            label = style.theta_text(float(str(theta)))
            ratios.errorbar(
                rows["n_blocks"],
                rows["ratio"],
                errors,
                **look,
                elinewidth=0.8,
                label=label,
            )
            rises.plot(rows["n_blocks"], rows["rise"], **look)
        for varied, (color, marker, label) in OTHERS.items():
            rows = table[table["varied"] == varied]
            counts.plot(
                rows["law"],
                rows["events"],
                marker,
                color=color,
                markersize=4,
                label=label,
            )
        ends = [table["law"].min(), table["law"].max()]
        counts.plot(ends, ends, **style.DOTTED)
        counts.set(
            xscale="log",
            yscale="log",
            xlabel="Events by the law [-]",
            ylabel="Events in the runs [-]",
        )
        counts.legend(loc="upper left", handlelength=1.2)
        ratios.set(ylabel="Events in the runs / by the law [-]")
        rises.set(ylabel=r"Load between events [$(\mu_s-\mu_k)\,w_1$]")
        for axes in (ratios, rises):
            axes.axhline(1.0, **style.DOTTED)
            axes.set(xscale="log", xlabel=style.BLOCKS_LABEL)
            style.set_ticks(axes.xaxis, sorted(linear["n_blocks"].unique()))
        for axis in (counts.xaxis, counts.yaxis):
            axis.set_major_formatter(StrMethodFormatter("{x:g}"))
        rises.axhline(2.0, **style.DOTTED)
        style.draw_key(figure, ratios.get_legend_handles_labels()[0])
    return figure
