"""The paper's numbers against the number of blocks, and their limits for large N."""

from __future__ import annotations

from typing import Any

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from precursors.figures import style
from precursors.model import printed

HEIGHT_MM = 96.0
LABELS = {
    "events_counted": style.EVENTS_LABEL,
    "mu_sapp": style.MU_SAPP_LABEL,
    "time_s": "Time of the first global slip [s]",
    "front_speed_m_per_s": "Front speed [km/s]",
}
SCALES = {"front_speed_m_per_s": 1e-3}
BEYOND = 1.35  # where marks stand beyond the last N, in units of it
WITHOUT_NOISE: dict[str, Any] = {"linestyle": "none", "marker": ".", "markersize": 3}
HORIZON: dict[str, Any] = {"linestyle": ":", "linewidth": 1.2}
ALL_EVENTS: dict[str, Any] = {"linestyle": "--", "linewidth": 0.8}
LIMIT: dict[str, Any] = {"linestyle": "none", "marker": "D", "markersize": 3}
EXPERIMENT: dict[str, Any] = {"linestyle": "none", "marker": "<", "markersize": 5}
BAND = Patch(color=style.GREY, alpha=0.3, linewidth=0, label="5 to 95 %")


def draw(
    table: pd.DataFrame,
    limits: pd.DataFrame,
    predictability: pd.DataFrame,
    papers_n: int,
) -> Figure:
    """Draw four numbers against N; a dotted line marks the paper's.

    Of resolution.csv, medians are lines and 5 to 95 % of the runs are bands. Of
    resolution_limits.csv, limits for large N are diamonds beyond the last N. A run
    without noise is a dot where it is predictable up to its global slip
    (predictability.csv).
    """
    with style.page(style.PAGE_MM, HEIGHT_MM) as figure:
        axes = figure.subplots(2, 2, sharex=True)
        beyond = BEYOND * table["n_blocks"].max()
        for panel, quantity in zip(axes.flat, LABELS, strict=True):
            rows = table[table["quantity"] == quantity]
            for scene, of_scene in rows.groupby("scene", sort=False):
                limit = limits[
                    (limits["scene"] == scene) & (limits["quantity"] == quantity)
                ]
                foreseen = predictability[predictability["scene"] == scene]
                _draw_scene(
                    panel, of_scene, limit.assign(n_blocks=beyond), foreseen, quantity
                )
            panel.set(ylabel=LABELS[quantity], xscale="log")
            panel.axvline(papers_n, **style.DOTTED)
        axes[0, 0].set_yscale("log")
        style.set_ticks(axes[0, 0].yaxis, [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000])
        for _, events in table[table["quantity"] == "events_to_global_slip"].groupby(
            "scene", sort=False
        ):
            color = style.theta_color(events["theta"].iloc[0])
            axes[0, 0].plot(
                events["n_blocks"], events["q50"], color=color, **ALL_EVENTS
            )
        speed = limits["wave_speed_m_per_s"].iloc[0] * SCALES["front_speed_m_per_s"]
        axes[1, 1].axhline(
            speed, color=style.GREY, linestyle="--", label=r"$c=\sqrt{ESL/M}$"
        )
        for sign, count in printed.EVENTS_OF_EXPERIMENT.items():
            axes[0, 0].plot(beyond, count, **EXPERIMENT, color=style.theta_color(sign))
        label = f"experiment, {printed.MU_SAPP:g}"
        axes[0, 1].axhline(
            printed.MU_SAPP,
            color=style.GREY,
            linestyle=":",
            linewidth=1.2,
            label=label,
        )
        for panel in axes[1]:
            panel.set_xlabel(style.BLOCKS_LABEL)
            style.set_ticks(panel.xaxis, [2, 5, 10, 20, 50, 100, 200])
        axes[0, 0].legend(loc="best", handlelength=1.5)
        for panel in (axes[0, 1], axes[1, 1]):
            panel.legend(loc="upper right", handlelength=1.5)
        entries = [
            style.mark("median of the runs"),
            BAND,
            style.mark("all events (median)", **ALL_EVENTS),
            style.mark("without noise", **WITHOUT_NOISE),
            style.mark("predictability time", **HORIZON),
            style.mark(r"limit $N \to \infty$", **LIMIT),
            style.mark("experiment", **EXPERIMENT),
            style.mark(f"$N = {papers_n}$", **style.DOTTED),
        ]
        style.draw_key(figure, entries, ncols=4)
    return figure


def _draw_scene(
    axes: Axes,
    table: pd.DataFrame,
    limit: pd.DataFrame,
    foreseen: pd.DataFrame,
    quantity: str,
) -> None:
    theta = table["theta"].iloc[0]
    scale = SCALES.get(quantity, 1.0)
    color = style.theta_color(theta)
    label = style.theta_text(theta) if quantity == "events_counted" else None
    low = table["q05"] * scale
    high = table["q95"] * scale
    axes.fill_between(
        table["n_blocks"], low, high, color=color, alpha=0.15, linewidth=0
    )
    axes.plot(table["n_blocks"], table["q50"] * scale, color=color, label=label)
    right = table[
        table["n_blocks"].isin(foreseen.loc[foreseen["predictable"], "n_blocks"])
    ]
    axes.plot(
        right["n_blocks"], right["without_noise"] * scale, **WITHOUT_NOISE, color=color
    )
    if quantity == "time_s":
        axes.plot(foreseen["n_blocks"], foreseen["horizon_s"], **HORIZON, color=color)
    errors = [
        (limit["a"] - limit["a_low"]) * scale,
        (limit["a_high"] - limit["a"]) * scale,
    ]
    axes.errorbar(
        limit["n_blocks"],
        limit["a"] * scale,
        errors,
        color=color,
        elinewidth=0.8,
        **LIMIT,
    )
