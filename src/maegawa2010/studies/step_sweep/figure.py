"""The numbers that the paper prints against the step of RK4: events counted, mu_sapp,
transitions right."""

from __future__ import annotations

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from precursors.figures import style
from precursors.figures.style import Options

HEIGHT_MM = 88.0
RIGHT: Options = {"marker": "o", "markersize": 3, "color": style.GREY}
WRONG = RIGHT | {"markeredgewidth": 0.8, "markerfacecolor": "white"}
QUANTITIES = {
    "events_counted": style.EVENTS_LABEL.replace(" ", "\n", 1),
    "mu_sapp": style.MU_SAPP_LABEL,
    "percentage": "Transitions\nright [%]",
}


def draw(table: pd.DataFrame) -> Figure:
    """Draw a column of panels for each scene of step_sweep.csv, in the order of the
    table."""
    share = table["transitions_right"] / table["transitions_true"]
    scenes = table.assign(percentage=100 * share).groupby("scene", sort=False)
    with style.page(style.PAGE_MM, HEIGHT_MM) as figure:
        grid = figure.subplots(
            len(QUANTITIES), len(scenes), sharex=True, sharey="row", squeeze=False
        )
        for column, (_, rows) in zip(grid.T, scenes, strict=True):
            for axes, quantity in zip(column, QUANTITIES, strict=True):
                _draw_numbers(axes, rows, quantity)
            column[0].set_title(style.theta_text(rows["theta"].iloc[0]), pad=3)
            column[-1].set_xlabel(r"Step $\Delta t$ [s]")
        for axes, label in zip(grid[:, 0], QUANTITIES.values(), strict=True):
            axes.set_ylabel(label)
        grid[0, 0].set_xscale("log")
        grid[0, 0].minorticks_off()
        grid[0, 0].yaxis.set_major_locator(MaxNLocator(integer=True))
        grid[2, 0].set_ylim(0, 108)
        figure.align_ylabels(grid[:, 0])
        style.draw_key(figure, grid[0, 0].get_legend_handles_labels()[0])
    return figure


def _draw_numbers(axes: Axes, rows: pd.DataFrame, quantity: str) -> None:
    method = rows["method"]
    is_right = rows["percentage"] == 100
    exact = rows.loc[method == "exact", quantity].iloc[0]
    axes.axhline(exact, color=style.BLACK, label="exact", zorder=1)
    steps = method == "rk4"
    for label, chosen, look in (
        ("RK4, some transition wrong", steps & ~is_right, WRONG),
        ("RK4, all transitions right", steps & is_right, RIGHT),
    ):
        points = rows[chosen]
        axes.plot(
            points["step_s"], points[quantity], linestyle="none", label=label, **look
        )
