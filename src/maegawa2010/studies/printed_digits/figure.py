"""The finding in one picture: the paper's six numbers come out, and they are one draw of
many."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MultipleLocator

from maegawa2010 import printed
from precursors.figures import style
from precursors.figures.precursor_lengths import draw_lengths
from precursors.figures.style import Options

HEIGHT_MM = 82.0
# Dots closer than this stand in rows on each other.
BIN = 0.005
ACROSS = 4
ROW = 0.032  # of the distance of two strips
DOT: Options = {
    "marker": ".",
    "markersize": 3,
    "markeredgewidth": 0,
    "linestyle": "none",
}
TITLE: Options = {"fontsize": 8.6, "fontweight": "bold", "loc": "left", "pad": 7}
LEVEL: Options = TITLE | {"pad": 28}  # with the other title, above a second axis
STAR: Options = {
    "marker": "*",
    "markersize": 11,
    "color": style.BLACK,
    "markeredgecolor": "white",
    "markeredgewidth": 0.6,
    "zorder": 4,
    "linestyle": "none",
}


def draw(
    slips: Sequence[pd.DataFrame], members: pd.DataFrame, shares: pd.DataFrame
) -> Figure:
    """Draw Fig. 13, and beside it mu_sapp of all sliders with the same printed inputs.

    `members` is digits_members.csv, whose draw 0 of a scene is the slider with the
    printed digits, and `shares` is digits.csv.
    """
    is_mu_sapp = shares["quantity"].eq("mu_sapp") & shares["question"].eq("as_printed")
    within = shares[is_mu_sapp].set_index("scene")
    scenes = members.groupby("scene", sort=False)
    with style.page(style.PAGE_MM, HEIGHT_MM) as figure:
        left, right = figure.subplots(1, 2)
        draw_lengths(left, [table[table["counted"]] for table in slips])
        left.set_title("The paper's six numbers come out", **TITLE)
        right.axvspan(
            printed.MU_SAPP - printed.LAST_DIGIT,
            printed.MU_SAPP + printed.LAST_DIGIT,
            color=style.PALE,
            zorder=0,
            linewidth=0,
        )
        for place, (scene, own) in enumerate(scenes):
            _draw_strip(right, place, own, within.loc[scene])
        right.set_title("Few sliders with the same printed inputs agree", **LEVEL)
        right.set(
            xlabel=style.MU_SAPP_LABEL, yticks=[], ylim=(-0.3, len(scenes) - 0.31)
        )
        right.xaxis.set_major_locator(MultipleLocator(0.05))
        _draw_key(figure)
    return figure


def _draw_strip(axes: Axes, place: int, own: pd.DataFrame, summary: Any) -> None:
    """Draw the sliders of a loading as stacked dots, above their median and nine
    tenths."""
    alone = own[own["draw"] == 0].iloc[0]
    values = own.loc[own["draw"] > 0, "mu_sapp"].dropna().sort_values()
    color = style.theta_color(alone["theta"])
    column = values // BIN
    before = values.groupby(column).cumcount()
    x = (column + (before % ACROSS + 0.5) / ACROSS) * BIN
    axes.plot(x, place + ROW * (before // ACROSS), **DOT, color=color)
    nine_tenths = [summary["q05"], summary["q95"]]
    axes.plot(nine_tenths, [place - 0.1] * 2, color=color, linewidth=2)
    share = f"{100 * summary['share']:.0f} %"
    axes.text(printed.MU_SAPP, place + 0.3, share, ha="center", fontweight="bold")
    axes.plot(
        summary["q50"], place - 0.1, "|", color=color, markersize=9, markeredgewidth=2.5
    )
    axes.plot(alone["mu_sapp"], place - 0.1, **STAR)
    axes.text(
        0.98,
        place + 0.5,
        style.LOADINGS[int(np.sign(alone["theta"]))],
        transform=axes.get_yaxis_transform(),
        ha="right",
        color=color,
        fontweight="bold",
    )


def _draw_key(figure: Figure) -> None:
    band = f"{printed.MU_SAPP:g} $\\pm$ {printed.LAST_DIGIT:g}, and the share inside"
    entries = [
        style.mark("a slider with the same printed inputs", **DOT),
        style.mark("median and nine tenths", marker="|", linewidth=2),
        style.mark("the slider with the printed digits", **STAR),
        style.mark(band, color=style.PALE, linewidth=6),
    ]
    style.draw_key(figure, entries, ncols=2)
