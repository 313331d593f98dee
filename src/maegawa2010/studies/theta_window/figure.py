"""mu_sapp and the events counted over a window of theta, one dot a run."""

from __future__ import annotations

import pandas as pd
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from precursors.figures import style
from precursors.figures.style import Options

HEIGHT_MM = 78.0
QUANTITIES = {"mu_sapp": style.MU_SAPP_LABEL, "events_counted": style.EVENTS_LABEL}
RUN: Options = {"marker": ".", "markersize": 2, "linestyle": "none"}
ALONE: Options = {"marker": "*", "markersize": 8, "linestyle": "none"}
ALONE |= {"color": style.BLACK, "markeredgecolor": "white"}


def draw(members: pd.DataFrame) -> Figure:
    """Draw every run as a dot over theta, a column for each scene.

    `members` is theta_window_members.csv; point 0 of a scene is the scene itself.
    """
    scenes = members.groupby("scene", sort=False)
    with style.page(style.PAGE_MM, HEIGHT_MM) as figure:
        grid = style.columns(figure, QUANTITIES.values(), len(scenes))
        for column, (_, of_scene) in zip(grid.T, scenes, strict=True):
            alone = of_scene[of_scene["point"] == 0].iloc[0]
            runs = of_scene[of_scene["point"] > 0]
            color = style.theta_color(alone["theta"])
            change = (runs["theta"] - alone["theta"]) * 1e3
            for axes, quantity in zip(column, QUANTITIES, strict=True):
                axes.plot(change, runs[quantity], **RUN, color=color)
                axes.plot(0.0, alone[quantity], **ALONE)
            column[0].set_title(f"around {style.theta_text(alone['theta'])}")
            column[1].set_xlabel(r"Change of $\theta$ [$10^{-3}$]")
        grid[1, 0].yaxis.set_major_locator(MaxNLocator(integer=True))
        entries = [style.mark("one run", **RUN), style.mark("the scene", **ALONE)]
        style.draw_key(figure, entries)
    return figure
