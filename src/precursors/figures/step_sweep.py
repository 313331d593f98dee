"""What the step of RK4 does to the numbers that the paper prints: events kept, mu_sapp, transitions right."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from precursors.figures import style

HEIGHT_MM = 110.0
COLUMNS = {
    "scene": str,
    "theta": float,
    "method": str,
    "step_s": float,
    "events_kept": int,
    "mu_sapp": float,
    "global_slip_time_s": float,
    "transitions_right": int,
    "transitions_true": int,
}
EXACT, WAITING, EVERY_STEP = "exact", "rk4_skip", "rk4"


def draw_step_sweep(table: pd.DataFrame) -> Figure:
    """Draw events kept, mu_sapp and the part of the transitions that is right against the step.

    Parameters
    ----------
    table : DataFrame
        As `read_step_sweep` gives it: a column of panels for each scene, in the order of the table.

    Raises
    ------
    ValueError
        If a scene has no exact value.
    """
    scenes = list(dict.fromkeys(table["scene"]))
    with style.styled():
        figure = style.new_figure(style.PAGE_MM, HEIGHT_MM)
        grid = figure.subplots(3, len(scenes), sharex=True, sharey="row", squeeze=False)
        for column, scene in zip(grid.T, scenes, strict=True):
            rows = table[table["scene"] == scene]
            if EXACT not in set(rows["method"]):
                raise ValueError(f"scene {scene} has no exact value: needed is a row with method {EXACT}")
            column[0].set_title(style.theta_text(rows["theta"].iloc[0]), fontsize=8, pad=3)
            _draw(column[0], rows, rows["events_kept"])
            _draw(column[1], rows, rows["mu_sapp"])
            _draw(column[2], rows, 100 * rows["transitions_right"] / rows["transitions_true"])
            column[2].set_xlabel(r"Step $\Delta t$ [s]")
        grid[0, 0].set_ylabel("Events kept [-]")
        grid[0, 0].yaxis.set_major_locator(MaxNLocator(integer=True))
        grid[1, 0].set_ylabel(r"$\mu_\mathrm{sapp}$ [-]")
        grid[2, 0].set_ylabel("Transitions right [%]")
        grid[2, 0].set_ylim(0, 108)
        grid[0, 0].set_xscale("log")
        figure.align_ylabels(grid[:, 0])
        figure.legend(*grid[0, 0].get_legend_handles_labels(), loc="outside upper center", ncols=4)
        style.lay_out(figure)
    return figure


def read_step_sweep(path: str | Path) -> pd.DataFrame:
    """Read a table of step sweeps (tables/step_sweep.csv).

    Raises
    ------
    ValueError
        If a column is missing or holds something else than it should.
    """
    return style.read_columns(path, COLUMNS)


def _draw(axes: Axes, rows: pd.DataFrame, values: pd.Series) -> None:
    exact = float(values[rows["method"] == EXACT].iloc[0])
    axes.axhline(exact, color=style.BLACK, label="exact", zorder=1)
    every_step, waiting = rows["method"] == EVERY_STEP, rows["method"] == WAITING
    right = rows["transitions_right"] == rows["transitions_true"]
    for label, chosen, look in (
        ("RK4, every step", every_step, _EVERY_STEP),
        ("RK4, waits in closed form: some transition wrong", waiting & ~right, _WRONG),
        ("all transitions right", waiting & right, _RIGHT),
    ):
        axes.plot(rows["step_s"][chosen], values[chosen], label=label, linestyle="none", **look)


_EVERY_STEP: dict[str, Any] = {"marker": "+", "markersize": 6, "markeredgewidth": 0.8, "color": style.BLUE}
_RIGHT: dict[str, Any] = {"marker": "o", "markersize": 3, "color": style.GREEN}
_WRONG: dict[str, Any] = {
    "marker": "o",
    "markersize": 3,
    "markeredgewidth": 0.8,
    "color": style.VERMILION,
    "markerfacecolor": "white",
}
