"""mu_sapp over two values of the chain."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from maegawa2010 import printed
from precursors.figures import style
from precursors.figures.style import Options

WIDTH_MM = 120.0
HEIGHT_MM = 96.0
KINETIC: Options = {"colors": style.BLACK, "linewidths": 1.0, "linestyles": "--"}
LABELS = {
    "theta": r"$\theta$",
    "mu_s": r"$\mu_s$",
    "mu_k": r"$\mu_k$",
    "mu_k/mu_s": r"$\mu_k/\mu_s$",
    "n_blocks": "number of blocks",
    "normal_load": r"$F_Z$ [N]",
    "drive_stiffness": r"$K$ [N/m]",
    "drive_velocity": r"$V$ [m/s]",
    "slider_mass": r"$M$ [kg]",
    "youngs_modulus": r"$E$ [Pa]",
    "cross_section": r"$S$ [m²]",
    "length": r"$L$ [m]",
}


def draw(
    table: pd.DataFrame,
    axes: Sequence[Mapping[str, Any]],
    scenes: Sequence[tuple[float, float]],
) -> Figure:
    """Draw mu_sapp of grid.csv, with contours at the paper's 0.49, and dashed where
    mu_k has this value, if an axis changes it.

    It is white where a run has no global slip. Crosses mark `scenes` by their values on
    both axes. The colours end at the 1st and 99th percentile.
    """
    x, y = (axis["key"] for axis in axes)
    values = table.pivot_table("mu_sapp", y, x, dropna=False)
    low, high = np.nanquantile(values, [0.01, 0.99])
    with style.page(WIDTH_MM, HEIGHT_MM) as figure:
        plot = figure.subplots()
        image = plot.pcolormesh(
            values.columns,
            values.index,
            values,
            vmin=low,
            vmax=high,
            rasterized=True,
        )
        figure.colorbar(image, ax=plot, label=style.MU_SAPP_LABEL, use_gridspec=False)
        paper = printed.MU_SAPP
        at = values.columns, values.index
        plot.contour(*at, values, [paper], colors="white", linewidths=0.6)
        text = rf"white line: $\mu_\mathrm{{sapp}} = {paper:g}$"
        entries = [style.mark(text, linestyle="none")]
        if "mu_k" in table:
            kinetic = table.assign(kinetic=table["mu_k"]).pivot_table("kinetic", y, x)
            plot.contour(*at, kinetic, [paper], **KINETIC)
            line = {"linestyle": "--", "linewidth": 1.0}
            entries.append(style.mark(rf"$\mu_k = {paper:g}$: many blocks", **line))
        plot.set(
            xlabel=LABELS[x],
            ylabel=LABELS[y],
            xscale=axes[0].get("scale", "linear"),
            yscale=axes[1].get("scale", "linear"),
        )
        plot.autoscale(False)
        places = np.transpose(scenes)
        plot.plot(*places, "+", color="white", markersize=8, markeredgewidth=2.6)
        plot.plot(*places, "+", color=style.BLACK, markersize=7)
        cross = {"marker": "+", "markersize": 6, "linestyle": "none"}
        entries.append(style.mark("scenes of Fig. 13", **cross))
        if not table["reached"].all():
            look = {"marker": "s", "markerfacecolor": "white", "linestyle": "none"}
            entries.append(style.mark("no global slip", **look, color=style.GREY))
        style.draw_key(figure, entries)
    return figure
