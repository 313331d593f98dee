"""Histograms of the peak loads of hundreds of global slips."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from precursors.figures import style

HEIGHT_MM = 66.0
WIDTH = 0.01  # of a bin, in mu
COLORS = {-1: style.VERMILION, 0: style.BLACK, 1: style.BLUE}
COLUMNS = {"scene": str, "theta": float, "mu": float}


def draw_long_runs(slips: pd.DataFrame) -> Figure:
    """Draw the distribution of F_X/F_Z at the onset of the global slips after the first, scene by scene.

    Parameters
    ----------
    slips : DataFrame
        tables/long_runs.csv, see `COLUMNS`. Open triangles on the axis are the first global slips, full ones
        the means of the others.
    """
    bins = np.arange(slips["mu"].min() // WIDTH, slips["mu"].max() // WIDTH + 2) * WIDTH
    with style.styled():
        figure = style.new_figure(style.COLUMN_MM, HEIGHT_MM)
        axes = figure.subplots()
        for _, of_scene in slips.groupby("scene", sort=False):
            theta, mu = of_scene["theta"].iloc[0], of_scene["mu"].to_numpy()
            color = COLORS[int(np.sign(theta))]
            spread = rf"{mu[1:].mean():.3f} $\pm$ {mu[1:].std(ddof=1):.3f}"
            label = f"{style.theta_text(theta)}: {len(mu) - 1} slips, {spread}"
            share = np.full(len(mu) - 1, 100.0 / max(1, len(mu) - 1))
            axes.hist(mu[1:], bins=bins.tolist(), weights=share, histtype="step", color=color, label=label)
            axes.plot(mu[1:].mean(), 0, "^", color=color, markersize=5, clip_on=False, zorder=3)
            axes.plot(
                mu[0], 0, "^", color=color, markerfacecolor="white", markersize=5, clip_on=False, zorder=3
            )
        axes.set_ylim(0, 1.45 * axes.get_ylim()[1])
        axes.set_xlabel("$F_X/F_Z$ at the onset of a global slip [-]")
        axes.set_ylabel(f"Share of the slips, per {WIDTH:g} [%]")
        axes.legend(loc="upper left", handlelength=1.2)
        style.lay_out(figure)
    return figure
