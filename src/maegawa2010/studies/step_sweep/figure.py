"""The numbers that the paper prints against the step of RK4: events counted, mu_sapp,
transitions right."""

from __future__ import annotations

import pandas as pd
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from precursors.figures import style
from precursors.figures.style import Options

HEIGHT_MM = 88.0
# By whether all transitions of a run are right.
POINT: Options = {"linestyle": "none", "markersize": 3, "zorder": 2.1}
LOOKS = {
    True: POINT
    | {"marker": "o", "color": style.OTHERS[4], "label": "RK4, right sequence"},
    False: POINT | {"marker": "x", "color": style.GREY, "label": "RK4, wrong sequence"},
}
QUANTITIES = {
    "events_counted": style.EVENTS_LABEL.replace(" ", "\n", 1),
    "mu_sapp": style.MU_SAPP_LABEL,
    "percentage": "Transitions\nright [%]",
}


def draw(table: pd.DataFrame) -> Figure:
    """Draw a column of panels for each scene of step_sweep.csv, in the order of the
    table."""
    share = table["transitions_right"] / table["transitions_true"]
    table = table.assign(percentage=100 * share, is_right=share == 1)
    scenes = table.groupby("scene", sort=False)
    with style.page(style.PAGE_MM, HEIGHT_MM) as figure:
        grid = style.columns(figure, QUANTITIES.values(), len(scenes))
        for column, (_, rows) in zip(grid.T, scenes, strict=True):
            exact = rows[rows["method"] == "exact"].iloc[0]
            steps = rows[rows["method"] == "rk4"]
            for axes, quantity in zip(column, QUANTITIES, strict=True):
                axes.axhline(exact[quantity], color=style.BLACK, label="exact")
                for is_right, points in steps.groupby("is_right"):
                    look = LOOKS[bool(is_right)]
                    axes.plot(points["step_s"], points[quantity], **look)
            right = (steps["events_counted"] == exact["events_counted"]).sum()
            found = f"{right} of {len(steps)} counts right, "
            found += f"{steps['is_right'].sum()} sequences"
            column[0].set_title(f"{style.theta_text(exact['theta'])}\n{found}", pad=3)
            column[-1].set_xlabel(r"Step $\Delta t$ [s]")
        grid[0, 0].set_xscale("log")
        grid[0, 0].minorticks_off()
        grid[0, 0].yaxis.set_major_locator(MaxNLocator(integer=True))
        grid[2, 0].set_ylim(0, 108)
        style.draw_key(figure)
    return figure
