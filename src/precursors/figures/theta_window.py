"""mu_sapp and the events counted over a window of theta, one dot a run."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from precursors.figures import style

HEIGHT_MM = 78.0
BINS = {"mu_sapp": 0.005, "events_counted": 1.0}  # their widths
RUN: dict[str, Any] = {
    "marker": ".",
    "markersize": 1.5,
    "linestyle": "none",
}
ALONE: dict[str, Any] = {
    "color": style.BLACK,
    "marker": "o",
    "markersize": 3.5,
    "linestyle": "none",
}


def draw(members: pd.DataFrame) -> Figure:
    """Draw every run as a dot over theta, a column for each scene, with histograms
    beside the dots.

    `members` is theta_window_members.csv; point 0 of a scene is the scene itself.
    """
    scenes = members.groupby("scene", sort=False)
    grid: dict[str, Any] = {
        "sharey": "row",
        "height_ratios": [1.3, 1],
        "width_ratios": [4, 1] * len(scenes),
    }
    with style.page(style.PAGE_MM, HEIGHT_MM) as figure:
        axes = figure.subplots(2, 2 * len(scenes), squeeze=False, **grid)
        for i, (_, of_scene) in enumerate(scenes):
            alone = of_scene[of_scene["point"] == 0].iloc[0]
            runs = of_scene[of_scene["point"] > 0]
            change = (runs["theta"] - alone["theta"]) * 1e3
            for row, (quantity, width) in enumerate(BINS.items()):
                dots = axes[row, 2 * i]
                bars = axes[row, 2 * i + 1]
                values = runs[quantity].dropna()
                bins = np.arange(values.min() - width / 2, values.max() + width, width)
                dots.plot(
                    change,
                    runs[quantity],
                    **RUN,
                    color=style.theta_color(alone["theta"]),
                )
                dots.plot(0.0, alone[quantity], **ALONE)
                bars.hist(values, bins=bins, orientation="horizontal", color=style.GREY)
                bars.set_xticks([])
                bars.tick_params(axis="y", length=0)
                dots.set_xlim(change.min(), change.max())
                dots.tick_params(axis="x", labelbottom=row == 1)
            axes[0, 2 * i].set_title(f"around {style.theta_text(alone['theta'])}")
            axes[1, 2 * i + 1].set_xlabel("runs", fontsize=7)
        axes[0, 0].set_ylabel(style.MU_SAPP_LABEL)
        axes[1, 0].set_ylabel(style.EVENTS_LABEL)
        figure.align_ylabels(axes[:, 0])
        axes[1, 0].yaxis.set_major_locator(MaxNLocator(integer=True))
        figure.supxlabel(r"Change of $\theta$ [$10^{-3}$]", fontsize=8)
        entries = [
            style.mark("one run", **RUN | {"markersize": 4}),
            style.mark("the scene", **ALONE),
        ]
        style.draw_key(figure, entries, loc="outside upper right")
    return figure
