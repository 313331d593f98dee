"""mu_sapp and the events counted of the three loadings when their inputs are not known
exactly."""

from __future__ import annotations

import pandas as pd
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from precursors.figures import style
from precursors.model import printed

HEIGHT_MM = 80.0
ROWS = {
    "0.1 % noise in the normal loads": "noise",
    "inputs that are printed alike": "digits",
}
DIGIT = 0.01  # a unit of the last digit that the paper prints of mu_sapp


def draw(noise: pd.DataFrame, digits: pd.DataFrame) -> Figure:
    """Draw the share of the runs up to each mu_sapp, and the share that has each number
    of events.

    `noise` and `digits` are noise_members.csv and digits_members.csv; draw 0 of a scene
    is the scene itself.
    """
    tables = {"noise": noise, "digits": digits}
    with style.page(style.PAGE_MM, HEIGHT_MM) as figure:
        grid = figure.subplots(2, 2, sharex="col", squeeze=False)
        for (left, right), (title, name) in zip(grid, ROWS.items(), strict=True):
            for _, own in tables[name].groupby("scene", sort=False):
                alone = own[own["draw"] == 0].iloc[0]
                runs = own[own["draw"] > 0]
                color = style.theta_color(alone["theta"])
                label = style.theta_text(alone["theta"])
                left.ecdf(runs["mu_sapp"].dropna(), color=color, label=label)
                left.plot(
                    alone["mu_sapp"], 0.0, "^", color=color, markersize=5, clip_on=False
                )
                shares = (
                    runs["events_counted"].value_counts(normalize=True).sort_index()
                )
                right.plot(
                    shares.index, shares, color=color, marker="o", markersize=2.5
                )
                right.plot(
                    alone["events_counted"],
                    0.0,
                    "^",
                    color=color,
                    markersize=5,
                    clip_on=False,
                )
            left.axvspan(
                printed.MU_SAPP - DIGIT,
                printed.MU_SAPP + DIGIT,
                color=style.PALE,
                zorder=0,
            )
            left.set(ylabel="Share of the runs [-]", title=title)
            right.set(ylabel="Share of the runs [-]", ylim=(0, None))
        grid[0, 0].legend(loc="lower right")
        grid[1, 0].set_xlabel(style.MU_SAPP_LABEL)
        grid[1, 1].set_xlabel(style.EVENTS_LABEL)
        grid[1, 1].xaxis.set_major_locator(MaxNLocator(integer=True))
        entries = [
            style.mark("the scene itself", marker="^", linestyle="none", markersize=5),
            style.mark(
                f"the paper's {printed.MU_SAPP:g}, $\\pm${DIGIT:g}",
                color=style.PALE,
                linewidth=5,
            ),
        ]
        style.draw_key(figure, entries)
    return figure
