"""The map: events counted, mu_sapp and the share of global slips over theta and
mu_k/mu_s."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm, Normalize
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from precursors.figures import style

HEIGHT_MM = 47.0
EVENTS = "events_counted"
PANELS = {
    EVENTS: style.EVENTS_LABEL,
    "mu_sapp": style.MU_SAPP_LABEL,
    "share_global": "Share of global slips [%]",
}
TICKS_OF_EVENTS = (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000)


def draw(table: pd.DataFrame, scenes: Sequence[tuple[float, float]] = ()) -> Figure:
    """Draw the three panels of map_theta_friction_ratio.csv, white where a run has no
    global slip.

    Crosses mark `scenes`, pairs of theta and mu_k/mu_s.
    """
    share = 100.0 * table["n_global"] / table["n_all_events"]
    table = table.assign(
        share_global=share, **{EVENTS: table[EVENTS].where(table["reached"])}
    )
    with style.page(style.PAGE_MM, HEIGHT_MM) as figure:
        panels = figure.subplots(1, len(PANELS), sharey=True)
        for panel, quantity in zip(panels, PANELS, strict=True):
            _draw_cells(panel, table, quantity)
            for place in scenes:
                panel.plot(
                    *place, "+", color="white", markersize=7, markeredgewidth=2.2
                )
                panel.plot(*place, "+", color=style.BLACK, markersize=6)
        panels[0].set_ylabel(r"$\mu_k/\mu_s$ [-]")
        cross = style.mark(
            "scenes of Fig. 13", marker="+", markersize=6, linestyle="none"
        )
        white = Patch(
            facecolor="white",
            edgecolor=style.GREY,
            linewidth=0.6,
            label="no global slip",
        )
        style.draw_key(
            figure, [cross] * bool(scenes) + [white] * (not table["reached"].all())
        )
    return figure


def _draw_cells(axes: Axes, table: pd.DataFrame, quantity: str) -> None:
    values = table.pivot_table(quantity, "friction_ratio", "theta", dropna=False)
    known = values.to_numpy()[np.isfinite(values)]
    norm: Normalize = Normalize(*np.quantile(known, [0.01, 0.99]))
    if quantity == EVENTS:
        norm = LogNorm(max(1.0, known.min()), known.max())
    look: dict[str, Any] = {
        "norm": norm,
        "cmap": "viridis",
        "shading": "nearest",
        "rasterized": True,
    }
    image = axes.pcolormesh(values.columns, values.index, values, **look)
    axes.set_xlabel(r"$\theta$ [-]")
    bar = axes.figure.colorbar(
        image, ax=axes, location="top", aspect=25, use_gridspec=False
    )
    bar.set_label(PANELS[quantity], fontsize=8)
    if quantity == EVENTS:
        style.set_ticks(
            bar.ax.xaxis,
            [n for n in TICKS_OF_EVENTS if known.min() <= n <= known.max()],
        )
