"""Predictability time: actual and predicted error of the times, and the Lyapunov
exponents."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullFormatter

from precursors.figures import style

COLUMNS = 3
ROW_MM = 36.0
KEY_MM = 5.0
ERROR_RANGE = (1e-18, 1e-2)
PREDICTED = style.GREY
ACTUAL = style.BLACK
DASHED: dict[str, Any] = {"linewidth": 0.6, "linestyle": (0, (4, 2))}
CROSS: dict[str, Any] = {
    "color": ACTUAL,
    "marker": "x",
    "linestyle": "none",
    "markersize": 4,
}
# What a chain has of its own: the factor to the unit that is shown, and the words.
WORDS = {
    "n_blocks": (1, "$N$ = {}"),
    "theta": (1, r"$\theta = {}$"),
    "mu_k": (1, r"$\mu_k$ = {}"),
    "drive_velocity": (1e3, "$V$ = {} mm/s"),
    "drive_stiffness": (1e-6, "$K$ = {} MN/m"),
}


def draw(
    errors: pd.DataFrame,
    overview: pd.DataFrame,
    exponents: pd.DataFrame,
    chains: Mapping[str, Mapping[str, Any]],
    tolerance: float,
) -> Figure:
    """Draw the errors of each chain over time, and the largest Lyapunov exponent of
    each scene.

    The tables are horizon.csv, solver_vs_proof.csv and lyapunov.csv. `chains` says in
    which parameters each chain differs from the paper's, and `tolerance` above which
    error a time counts as wrong [s].
    """
    rows = math.ceil((len(chains) + 1) / COLUMNS)
    facts = overview.set_index("chain").to_dict("index")
    with style.page(style.PAGE_MM, ROW_MM * rows + KEY_MM) as figure:
        axes = figure.subplots(rows, COLUMNS, squeeze=False)
        for panel, (name, values) in zip(axes.flat, chains.items(), strict=False):
            _draw_errors(panel, errors[errors["chain"] == name], facts[name], tolerance)
            panel.set_title(_title(values), fontsize=7)
            if panel in axes[:, 0]:
                panel.set_ylabel("Error of time [s]")
            else:
                panel.yaxis.set_major_formatter(NullFormatter())
        _draw_exponents(axes.flat[len(chains)], exponents)
        for empty in axes.flat[len(chains) + 1 :]:
            empty.set_axis_off()
        entries = [
            style.mark("predicted", color=PREDICTED),
            style.mark("actual, against the proof", color=ACTUAL),
            style.mark("tolerance", **style.DOTTED),
            style.mark("tolerance met until", **DASHED),
            style.mark("order of transitions lost", **CROSS),
        ]
        style.draw_key(figure, entries)
    return figure


def _title(values: Mapping[str, Any]) -> str:
    """What a chain has of its own, in the order of `WORDS`."""
    own = [(values[name], *WORDS[name]) for name in WORDS if name in values]
    return ", ".join(
        words.format(x if isinstance(x, str) else f"{x * factor:.4g}")
        for x, factor, words in own
    )


def _draw_errors(
    axes: Axes, errors: pd.DataFrame, facts: Mapping[Any, float], tolerance: float
) -> None:
    duration = facts["duration_s"]
    axes.set(yscale="log", xlim=(0.0, duration), ylim=ERROR_RANGE)
    axes.yaxis.set_major_locator(LogLocator(base=1e4, numticks=20))
    axes.yaxis.set_minor_formatter(NullFormatter())
    axes.axhline(tolerance, **style.DOTTED)
    axes.plot(errors["time_s"], errors["predicted_error_s"], color=PREDICTED)
    axes.plot(errors["time_s"], errors["actual_error_s"], color=ACTUAL)
    if facts["order_lost_s"] < duration:
        axes.plot(*errors[["time_s", "actual_error_s"]].dropna().iloc[-1], **CROSS)
    for column, color in (("horizon_s", PREDICTED), ("right_until_s", ACTUAL)):
        if facts[column] < duration:
            axes.axvline(facts[column], color=color, **DASHED)
    axes.set_xlabel("Time [s]", labelpad=1)


def _draw_exponents(axes: Axes, table: pd.DataFrame) -> None:
    exponent = table["exponent_per_s"]
    half_width = table["uncertainty_per_s"]
    place = np.arange(len(table))
    axes.errorbar(
        exponent,
        place,
        xerr=half_width,
        fmt="o",
        markersize=3,
        capsize=2,
        color=style.BLACK,
    )
    axes.axvline(0.0, **style.DOTTED)
    axes.set_xlim(min(0.0, (exponent - half_width).min()), None)
    axes.set_yticks(place, [style.theta_text(theta) for theta in table["theta"]])
    axes.set_ylim(len(table) - 0.5, -0.5)
    axes.set_xlabel("Lyapunov exponent [1/s]", labelpad=1)
    axes.set_title("Largest exponent, 95 % interval", fontsize=7)
