"""The mean of F_X over the path of the drive: mu_k F_Z, whatever the loading."""

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from precursors.figures import style
from precursors.figures.style import Options

HEIGHT_MM = 80.0
FINDING = "the mean load is the kinetic friction, whatever the loading"
AGREES = 0.001  # the title states the finding if every mean is this near to mu_k
LOADS = (0.28, 0.74)  # range of the axis, with room for words above the curves
TICKS = 0.15  # distance from mu_k
CURVE: Options = {"linewidth": 0.6}
BEYOND: Options = CURVE | {"color": style.GREY}
MEAN: Options = {"color": style.BLACK, "linewidth": 1.0, "solid_capstyle": "butt"}
WORDS: Options = {"y": 0.95, "va": "top", "fontsize": "small", "fontweight": "bold"}


def draw(table: pd.DataFrame, curves: pd.DataFrame) -> Figure:
    """Draw F_X/F_Z over time and its mean, a row for each scene and a column for each
    number of blocks.

    `table` is balance.csv. A curve is grey where single slips cannot be predicted.
    """
    scenes, sizes = list(table["scene"].unique()), list(table["n_blocks"].unique())
    with style.page(style.PAGE_MM, HEIGHT_MM) as figure:
        panels = figure.subplots(
            len(scenes), len(sizes), sharex=True, sharey=True, squeeze=False
        )
        for row in table.itertuples():
            axes = panels[scenes.index(row.scene), sizes.index(row.n_blocks)]
            _draw_run(axes, row, curves)
        for axes, n in zip(panels[0], sizes, strict=True):
            axes.set_title(f"{n} blocks")
        for axes, scene in zip(panels[:, 0], scenes, strict=True):
            theta = table["theta"][table["scene"] == scene].iloc[0]
            name = style.LOADINGS[int(np.sign(theta))]
            color = style.theta_color(theta)
            axes.text(0.012, s=name, **WORDS, color=color, transform=axes.transAxes)
        for axes in panels[-1]:
            axes.set_xlabel("Time [s]")
        panels[len(scenes) // 2, 0].set_ylabel("$F_X/F_Z$ [-]")
        _draw_key(figure)
        (mu_k, *others) = table["mu_k"].unique()
        if not others and (abs(table["mean"] - mu_k) < AGREES).all():
            title = rf"With $\mu_k$ = {mu_k:g} {FINDING}"
            figure.suptitle(title, fontweight="bold", fontsize="large")
    return figure


def _draw_run(axes: Axes, row: Any, curves: pd.DataFrame) -> None:
    """Draw the load of a run, mu_k, and the mean with its number."""
    is_own = curves["scene"].eq(row.scene) & curves["n_blocks"].eq(row.n_blocks)
    curve = curves[is_own]
    is_known = curve["time_s"] <= row.predictable_s
    color = style.theta_color(row.theta)
    beyond = curve[~is_known.shift(-1, fill_value=False)]
    axes.plot(beyond["time_s"], beyond["load"], **BEYOND)
    axes.plot(curve["time_s"][is_known], curve["load"][is_known], **CURVE, color=color)
    axes.axhline(row.mu_k, **style.DOTTED)
    axes.plot([row.first_s, row.last_s], [row.mean] * 2, **MEAN)
    number = "no mean"
    if not np.isnan(row.mean):
        number = f"mean {row.mean:.4f}\nlargest {row.largest:.3f}"
    axes.text(0.988, s=number, **WORDS, ha="right", transform=axes.transAxes)
    ticks = [row.mu_k - TICKS, row.mu_k, row.mu_k + TICKS]
    axes.set_yticks(
        ticks, [f"{ticks[0]:g}", rf"$\mu_k$ = {row.mu_k:g}", f"{ticks[2]:g}"]
    )
    axes.set(xlim=(0, curve["time_s"].iloc[-1]), ylim=LOADS)


def _draw_key(figure: Figure) -> None:
    entries = [
        style.mark("mean from the first global slip to the last", **MEAN),
        style.mark("load where single slips are beyond prediction", **BEYOND),
    ]
    style.draw_key(figure, entries)
