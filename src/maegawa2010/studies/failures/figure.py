"""Figure: the failure gallery, with a panel for each failure mode."""

import re
from typing import Any

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from precursors.figures import style
from precursors.figures.style import Options

HEIGHT_MM = 148.0
THEORY: Options = {"linewidth": 0.6}
LOOKS: dict[str, Options] = {
    "exact": {"color": style.BLACK},
    "reference": {"color": style.BLACK, "linewidth": 0.6},
}


def draw(curves: pd.DataFrame, panels: pd.DataFrame) -> Figure:
    """Draw the failure modes of failure_curves.csv.

    `panels` (failure_gallery.csv) has a row for each panel: its title, axes, the factor
    `scale` from the table's x to the axis, the format of a failing curve, and the
    position of the legend.
    """
    with style.page(style.PAGE_MM, HEIGHT_MM) as figure:
        grid = figure.subplots(3, 2).flat
        rows: Any = panels.itertuples()
        for letter, axes, panel in zip("abcdef", grid, rows, strict=True):
            _draw_curves(axes, panel, curves[curves["failure_mode"] == panel.mode])
            axes.set_title(f"$\\bf{{{letter}}}$  {panel.title}", fontsize="small")
        look = THEORY | {"color": style.OTHERS[0]}
        theory = style.mark("thin line in the colour of dots: theory", **look)
        style.draw_key(figure, [theory])
    return figure


def _draw_curves(axes: Axes, panel: Any, curves: pd.DataFrame) -> None:
    failing = curves.loc[curves["role"] == "failing", "curve"].unique()
    color = dict(zip(failing, style.OTHERS, strict=False))
    for key, points in curves.groupby(["curve", "role"], sort=False):
        name, role = map(str, key)
        line = {"failing": panel.points, "reference": "--"}.get(role, "-")
        look = LOOKS.get(role, THEORY | {"color": color.get(name, style.OTHERS[0])})
        axes.plot(
            points["x"] * panel.scale,
            points["y"],
            line,
            markersize=2.4,
            label="_" if role == "theory" else pretty(name),
            **look,
        )
    axes.set_yscale(panel.yscale)
    axes.tick_params(labelsize="small")
    if pd.notna(panel.bottom):
        axes.set_ylim(bottom=panel.bottom)
    axes.set_xlabel(panel.x, fontsize="small")
    axes.set_ylabel(panel.y, fontsize="small")
    axes.legend(loc=panel.key, fontsize="small", handlelength=1.4, labelspacing=0.2)


def pretty(text: str) -> str:
    """Write `dt` and numbers such as 1e-07 in mathematical notation."""
    text = text.replace("dt =", r"$\Delta t$ =")
    return re.sub(r"([\d.]+)e-0?(\d+)", r"$\1\\times10^{-\2}$", text)
