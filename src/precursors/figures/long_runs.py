"""Histograms of the peak loads of hundreds of global slips."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from precursors.figures import style

HEIGHT_MM = 80.0
WIDTH = 0.01  # of a bin, in mu
TRIANGLE: dict[str, Any] = {"marker": "^", "markersize": 5, "linestyle": "none"}


def draw(slips: pd.DataFrame, statistics: pd.DataFrame) -> Figure:
    """Draw the distribution of F_X/F_Z at the onset of the global slips after the first, scene by scene.

    Parameters
    ----------
    slips : DataFrame
        long_runs.csv: columns scene, theta, mu.
    statistics : DataFrame
        long_runs_statistics.csv: columns scene, mu_first, n, mean, deviation; drawn above the histograms.
    """
    bins = np.arange(slips["mu"].min() // WIDTH, slips["mu"].max() // WIDTH + 2) * WIDTH
    facts = statistics.set_index("scene")
    with style.page(style.COLUMN_MM, HEIGHT_MM) as figure:
        above, axes = figure.subplots(2, sharex=True, height_ratios=[1, 2.4])
        thetas = []
        for row, (scene, of_scene) in enumerate(slips.groupby("scene", sort=False)):
            later, fact, theta = of_scene["mu"].iloc[1:], facts.loc[scene], of_scene["theta"].iloc[0]
            color = style.theta_color(theta)
            thetas.append(style.theta_text(theta))
            share = np.full(len(later), 100.0 / max(1, len(later)))
            label = f"{thetas[-1]}: {fact['n']:.0f} slips"
            axes.hist(later, bins=bins.tolist(), weights=share, histtype="step", color=color, label=label)
            mean, deviation = fact["mean"], fact["deviation"]
            above.errorbar(mean, row, xerr=deviation, color=color, capsize=2, **TRIANGLE, zorder=3)
            above.plot(fact["mu_first"], row, color=color, markerfacecolor="white", **TRIANGLE, zorder=3)
            text = rf"{mean:.3f} $\pm$ {deviation:.3f}"
            place: dict[str, Any] = {"transform": above.get_yaxis_transform(), "ha": "right", "va": "center"}
            above.text(0.99, row, text, color=color, fontsize=7, **place)
        above.set_ylim(len(thetas) - 0.4, -0.6)
        above.set_yticks(range(len(thetas)), thetas)
        above.tick_params(axis="y", length=0)
        axes.set_xlabel("$F_X/F_Z$ at the onset of a global slip [-]")
        axes.set_ylabel(f"Share of the slips, per {WIDTH:g} [%]")
        axes.legend(loc="upper right", handlelength=1.2)
        first = style.mark("first global slip", **TRIANGLE, markerfacecolor="white")
        others = style.mark("mean of the others ± standard deviation", **TRIANGLE)
        style.draw_key(
            figure, [first, others], loc="outside upper center", handletextpad=0.0, columnspacing=0.8
        )
    return figure
