"""What the number of blocks makes of the paper's numbers, and where they go as it grows."""

from __future__ import annotations

from typing import Any

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from precursors.figures import style
from precursors.model import printed

HEIGHT_MM = 112.0
COLUMNS = {
    "scene": str,
    "theta": float,
    "n_blocks": int,
    "quantity": str,
    "without_noise": float,
    "q05": float,
    "q50": float,
    "q95": float,
    "estimate": float,
}
LIMIT_COLUMNS = {"scene": str, "quantity": str, "law": str, "a": float, "a_error": float}
LABELS = {
    "events_kept": "Events kept [-]",
    "mu_sapp": r"$\mu_\mathrm{sapp}$ [-]",
    "time_s": "Time of the first global slip [s]",
    "front_speed_m_per_s": "Front speed [km/s]",
}
SCALES = {"front_speed_m_per_s": 1e-3}
ESTIMATES = {"mu_sapp": r"$\mu_k + 2(\mu_s-\mu_k)/N$", "front_speed_m_per_s": r"$c=\sqrt{ESL/M}$"}
BEYOND = 1.35  # where marks stand beyond the last N, in units of it
LIMIT: dict[str, Any] = {"linestyle": "none", "marker": "D", "markersize": 3}


def draw_resolution(table: pd.DataFrame, limits: pd.DataFrame, papers_n: int) -> Figure:
    """Draw the four numbers against N: the medians as lines, 5 to 95 % of the runs as bands.

    Parameters
    ----------
    table : DataFrame
        tables/resolution.csv, see `COLUMNS`; estimates are drawn dashed.
    limits : DataFrame
        tables/resolution_limits.csv, see `LIMIT_COLUMNS`; drawn as diamonds beyond the last N.
    papers_n : int
        Number of blocks that a dotted line marks.
    """
    with style.styled():
        figure = style.new_figure(style.PAGE_MM, HEIGHT_MM)
        axes = figure.subplots(2, 2, sharex=True)
        for panel, quantity in zip(axes.flat, LABELS, strict=True):
            scale = SCALES.get(quantity, 1.0)
            for scene, of_scene in table[table["quantity"] == quantity].groupby("scene", sort=False):
                _draw_scene(panel, of_scene.sort_values("n_blocks"), scale, panel is axes[0, 0])
                limit = limits[(limits["scene"] == scene) & (limits["quantity"] == quantity)]
                _draw_limit(panel, limit, of_scene, scale)
            panel.set_ylabel(LABELS[quantity])
            panel.set_xscale("log")
            mark_papers_n(panel, papers_n)
        ticks = [2, 5, 10, 20, 50, 100, 200]
        for panel in axes[1]:
            panel.set_xlabel("Number of blocks $N$ [-]")
            panel.set_xticks(ticks, [str(tick) for tick in ticks])
            panel.minorticks_off()
        _draw_experiment(axes[0, 0], axes[0, 1], table["n_blocks"].max())
        for panel, quantity in zip(axes.flat, LABELS, strict=True):
            _draw_estimate(panel, table[table["quantity"] == quantity], quantity)
        axes[1, 0].plot([], [], color=style.BLACK, **LIMIT, label=r"$N \to \infty$")
        for panel in axes.flat:
            panel.legend(loc="best", handlelength=1.5)
        style.lay_out(figure)
    return figure


def _draw_scene(axes: Axes, table: pd.DataFrame, scale: float, named: bool) -> None:
    theta = table["theta"].iloc[0]
    color = style.theta_color(theta)
    n = table["n_blocks"]
    axes.fill_between(n, table["q05"] * scale, table["q95"] * scale, color=color, alpha=0.15, linewidth=0)
    axes.plot(n, table["q50"] * scale, color=color, label=style.theta_text(theta) if named else None)
    axes.plot(n, table["without_noise"] * scale, color=color, linestyle="none", marker=".", markersize=3)


def _draw_limit(axes: Axes, limit: pd.DataFrame, table: pd.DataFrame, scale: float) -> None:
    color = style.theta_color(table["theta"].iloc[0])
    place = [BEYOND * table["n_blocks"].max()] * len(limit)
    axes.errorbar(place, limit["a"] * scale, limit["a_error"] * scale, color=color, elinewidth=0.8, **LIMIT)


def _draw_experiment(events: Axes, friction: Axes, most_blocks: int) -> None:
    """The experiment has no N: a mark for each count beside the last N, and a line for mu_sapp."""
    for sign, count in printed.EVENTS_KEPT.items():
        mark: dict[str, Any] = {
            "color": style.theta_color(sign),
            "linestyle": "none",
            "marker": "<",
            "markersize": 5,
        }
        events.plot(BEYOND * most_blocks, count, **mark, label="experiment" if sign == 0 else None)
    events.set_yscale("log")
    ticks = [1, 2, 5, 10, 20, 50, 100]
    events.set_yticks(ticks, [str(tick) for tick in ticks])
    draw_experiments_mu_sapp(friction)


def draw_experiments_mu_sapp(axes: Axes) -> None:
    """The experiment's mu_sapp as a line."""
    label = f"experiment, {printed.MU_SAPP:g}"
    axes.axhline(printed.MU_SAPP, color=style.ORANGE, linestyle=":", linewidth=1.2, label=label)


def mark_papers_n(axes: Axes, papers_n: int) -> None:
    """The paper's number of blocks as a dotted line."""
    axes.axvline(papers_n, color=style.GREY, linewidth=0.6, linestyle=(0, (1, 2)), zorder=1)


def _draw_estimate(axes: Axes, table: pd.DataFrame, quantity: str) -> None:
    """What theory expects, the same for every scene."""
    expected = table.dropna(subset="estimate").drop_duplicates("n_blocks").sort_values("n_blocks")
    if len(expected):
        value = expected["estimate"] * SCALES.get(quantity, 1.0)
        look: dict[str, Any] = {"color": style.GREEN, "linestyle": "--"}
        axes.plot(expected["n_blocks"], value, **look, label=ESTIMATES[quantity])
