"""The map: mu_sapp over theta and mu_k/mu_s."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from maegawa2010 import printed
from precursors.figures import style

WIDTH_MM = 120.0
HEIGHT_MM = 96.0


def draw(table: pd.DataFrame, scenes: Sequence[tuple[float, float]]) -> Figure:
    """Draw mu_sapp of map_theta_friction_ratio.csv, with contours at the paper's 0.49.

    It is white where a run has no global slip. Crosses mark `scenes`, pairs of theta
    and mu_k/mu_s. The colours end at the 1st and 99th percentile.
    """
    values = table.pivot_table("mu_sapp", "friction_ratio", "theta", dropna=False)
    low, high = np.nanquantile(values, [0.01, 0.99])
    with style.page(WIDTH_MM, HEIGHT_MM) as figure:
        axes = figure.subplots()
        image = axes.pcolormesh(
            values.columns,
            values.index,
            values,
            vmin=low,
            vmax=high,
            rasterized=True,
        )
        figure.colorbar(image, ax=axes, label=style.MU_SAPP_LABEL, use_gridspec=False)
        levels = [printed.MU_SAPP]
        axes.contour(
            values.columns, values.index, values, levels, colors="white", linewidths=0.6
        )
        places = np.transpose(scenes)
        axes.plot(*places, "+", color="white", markersize=8, markeredgewidth=2.6)
        axes.plot(*places, "+", color=style.BLACK, markersize=7)
        axes.set(xlabel=r"$\theta$ [-]", ylabel=r"$\mu_k/\mu_s$ [-]")
        text = rf"white line: $\mu_\mathrm{{sapp}} = {printed.MU_SAPP:g}$"
        cross = {"marker": "+", "markersize": 6, "linestyle": "none"}
        entries = [
            style.mark(text, linestyle="none"),
            style.mark("scenes of Fig. 13", **cross),
        ]
        if not table["reached"].all():
            look = {"marker": "s", "markerfacecolor": "white", "linestyle": "none"}
            entries.append(style.mark("no global slip", **look, color=style.GREY))
        style.draw_key(figure, entries)
    return figure
