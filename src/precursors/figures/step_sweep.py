"""The numbers that the paper prints against the step of RK4: events counted, mu_sapp,
transitions right."""

from __future__ import annotations

import pandas as pd
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator, NullLocator

from precursors.figures import style
from precursors.figures.style import Options

HEIGHT_MM = 88.0
EXACT = "exact"
EVERY_STEP: Options = {
    "marker": "+",
    "markersize": 6,
    "markeredgewidth": 0.8,
    "color": style.GREY,
}
RIGHT: Options = {"marker": "o", "markersize": 3, "color": style.GREY}
WRONG = RIGHT | {
    "markeredgewidth": 0.8,
    "color": style.GREY,
    "markerfacecolor": "white",
}


def draw(table: pd.DataFrame) -> Figure:
    """Draw a column of panels for each scene of step_sweep.csv, in the order of the
    table."""
    right = table["transitions_right"] == table["transitions_true"]
    every_step = table["method"] == "rk4"
    waiting = table["method"] == "rk4_skip"
    groups = (
        ("RK4, every step", every_step, EVERY_STEP),
        ("RK4, waits in closed form: some transition wrong", waiting & ~right, WRONG),
        ("all transitions right", waiting & right, RIGHT),
    )
    percentage = 100 * table["transitions_right"] / table["transitions_true"]
    values = (table["events_counted"], table["mu_sapp"], percentage)
    scenes = table.groupby("scene", sort=False)
    with style.page(style.PAGE_MM, HEIGHT_MM) as figure:
        grid = figure.subplots(
            len(values), len(scenes), sharex=True, sharey="row", squeeze=False
        )
        for column, (_, rows) in zip(grid.T, scenes, strict=True):
            for axes, value in zip(column, values, strict=True):
                of_scene = value[rows.index]
                exact = of_scene[rows["method"] == EXACT].iloc[0]
                axes.axhline(exact, color=style.BLACK, label=EXACT, zorder=1)
                for label, chosen, look in groups:
                    points = rows.index[chosen[rows.index]]
                    axes.plot(
                        rows["step_s"][points],
                        value[points],
                        linestyle="none",
                        **look,
                        label=label,
                    )
            column[0].set_title(style.theta_text(rows["theta"].iloc[0]), pad=3)
            column[-1].set_xlabel(r"Step $\Delta t$ [s]")
        grid[0, 0].set(ylabel=style.EVENTS_LABEL, xscale="log")
        grid[0, 0].xaxis.set_minor_locator(NullLocator())
        grid[0, 0].yaxis.set_major_locator(MaxNLocator(integer=True))
        grid[1, 0].set_ylabel(style.MU_SAPP_LABEL)
        grid[2, 0].set(ylabel="Transitions right [%]", ylim=(0, 108))
        figure.align_ylabels(grid[:, 0])
        figure.legend(
            *grid[0, 0].get_legend_handles_labels(), loc="outside upper center", ncols=4
        )
    return figure
