"""Histograms of the peak loads of hundreds of global slips."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from precursors.figures import style

HEIGHT_MM = 76.0
WIDTH = 0.01  # of a bin, in mu
COLUMNS = {"scene": str, "theta": float, "mu": float}
STATISTICS_COLUMNS = {"scene": str, "mu_first": float, "n": int, "mean": float, "deviation": float}


def draw_long_runs(slips: pd.DataFrame, statistics: pd.DataFrame) -> Figure:
    """Draw the distribution of F_X/F_Z at the onset of the global slips after the first, scene by scene.

    Parameters
    ----------
    slips : DataFrame
        tables/long_runs.csv, see `COLUMNS`.
    statistics : DataFrame
        tables/long_runs_statistics.csv, see `STATISTICS_COLUMNS`.

    Notes
    -----
    Above the histograms a row per scene: an open triangle at the first global slip, a full one at the mean
    of the others, with a bar of one standard deviation to either side.
    """
    bins = np.arange(slips["mu"].min() // WIDTH, slips["mu"].max() // WIDTH + 2) * WIDTH
    known = statistics.set_index("scene")
    scenes = list(slips.groupby("scene", sort=False))
    with style.styled():
        figure = style.new_figure(style.COLUMN_MM, HEIGHT_MM)
        above, axes = figure.subplots(2, sharex=True, height_ratios=[1, 2.4])
        for row, (scene, of_scene) in enumerate(scenes):
            theta, later = of_scene["theta"].iloc[0], of_scene["mu"].iloc[1:]
            first, n, mean, deviation = map(float, known.loc[scene, ["mu_first", "n", "mean", "deviation"]])
            color = style.theta_color(theta)
            share = np.full(len(later), 100.0 / max(1, len(later)))
            look: dict[str, Any] = {
                "histtype": "step",
                "color": color,
                "label": f"{style.theta_text(theta)}: {n:.0f} slips",
            }
            axes.hist(later, bins=bins.tolist(), weights=share, **look)
            triangle: dict[str, Any] = {"color": color, "markersize": 5, "zorder": 3}
            above.errorbar(mean, row, xerr=deviation, fmt="^", capsize=2, elinewidth=0.8, **triangle)
            above.plot(first, row, "^", **triangle, markerfacecolor="white")
            words = rf"{mean:.3f} $\pm$ {deviation:.3f}"
            above.text(0.99, row, words, transform=above.get_yaxis_transform(), color=color, **_WORDS)
        above.set_ylim(len(scenes) - 0.4, -0.6)
        above.set_yticks(range(len(scenes)), [style.theta_text(s["theta"].iloc[0]) for _, s in scenes])
        above.tick_params(axis="y", length=0)
        axes.set_xlabel("$F_X/F_Z$ at the onset of a global slip [-]")
        axes.set_ylabel(f"Share of the slips, per {WIDTH:g} [%]")
        axes.legend(loc="upper right", handlelength=1.2)
        style.lay_out(figure)
    return figure


_WORDS: dict[str, Any] = {"ha": "right", "va": "center", "fontsize": 7}
