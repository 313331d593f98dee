"""How far the digits of a run hold: actual and predicted error, and the Lyapunov exponents."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullFormatter

from precursors.figures import style

ERROR_COLUMNS = {"chain": str, "time_s": float, "actual_error_s": float, "predicted_error_s": float}
OVERVIEW_COLUMNS = {
    "chain": str,
    "duration_s": float,
    "order_lost_s": float,
    "horizon_s": float,
    "right_until_s": float,
}
EXPONENT_COLUMNS = {"scene": str, "exponent_per_s": float, "uncertainty_per_s": float}
COLUMNS = 3
ROW_MM = 42.0
PLAIN = {"theta", "duration"}
ERROR_RANGE = (1e-18, 1e-2)
# Least and largest number that is written as a decimal.
SHORT, LONG = 1e-2, 1e4
NAMES = {
    "n_blocks": "$N$ = {}",
    "theta": r"$\theta = {}$",
    "mu_k": r"$\mu_k$ = {}",
    "drive_velocity": "$V$ = {} mm/s",
    "drive_stiffness": "$K$ = {} MN/m",
}
UNITS = {"drive_velocity": 1e3, "drive_stiffness": 1e-6}


def draw_horizon(
    errors: pd.DataFrame,
    overview: pd.DataFrame,
    exponents: pd.DataFrame,
    chains: Mapping[str, Mapping[str, Any]],
    thetas: Mapping[str, float],
    tolerance: float,
) -> Figure:
    """Draw the errors of each chain over time, and the largest Lyapunov exponent of each scene.

    Parameters
    ----------
    errors : DataFrame
        tables/horizon.csv.
    overview : DataFrame
        tables/solver_vs_proof.csv.
    exponents : DataFrame
        tables/lyapunov.csv.
    chains : mapping
        What each chain has of its own; those that have only a theta come first, in its order.
    thetas : mapping
        theta of each scene of tables/lyapunov.csv.
    tolerance : float
        Error of a time [s] above which it counts as wrong.
    """
    plain = sorted(
        (name for name in chains if set(chains[name]) <= PLAIN), key=lambda name: _theta(chains[name])
    )
    chains = {name: chains[name] for name in [*plain, *(name for name in chains if name not in plain)]}
    rows = math.ceil((len(chains) + 1) / COLUMNS)
    with style.styled():
        figure = style.new_figure(style.PAGE_MM, ROW_MM * rows)
        axes = figure.subplots(rows, COLUMNS).ravel()
        facts = overview.set_index("chain").to_dict("index")
        for i, (name, values) in enumerate(chains.items()):
            _draw_errors(axes[i], errors[errors["chain"] == name], facts[name], tolerance)
            axes[i].set_title(_title(values), fontsize=7)
            if i % COLUMNS == 0:
                axes[i].set_ylabel("Error of time [s]")
            else:
                axes[i].yaxis.set_major_formatter(NullFormatter())
        handles, labels = axes[0].get_legend_handles_labels()
        axes[0].legend(handles, labels, loc="upper left", handlelength=1.4)
        _draw_exponents(axes[len(chains)], exponents, thetas)
        for empty in axes[len(chains) + 1 :]:
            empty.set_axis_off()
        style.lay_out(figure)
    return figure


def _theta(values: Mapping[str, Any]) -> Fraction:
    return Fraction(values.get("theta", 0))


def _draw_errors(axes: Axes, errors: pd.DataFrame, facts: Mapping[Any, float], tolerance: float) -> None:
    axes.set_yscale("log")
    axes.set_ylim(*ERROR_RANGE)
    axes.set_xlim(0.0, facts["duration_s"])
    axes.yaxis.set_major_locator(LogLocator(base=1e4, numticks=20))
    axes.yaxis.set_minor_formatter(NullFormatter())
    axes.axhline(tolerance, color=style.GREY, linewidth=0.6, linestyle=(0, (1, 2)))
    axes.plot(errors["time_s"], errors["predicted_error_s"], color=style.VERMILION, label="Predicted")
    axes.plot(errors["time_s"], errors["actual_error_s"], color=style.BLACK, label="Actual")
    if facts["order_lost_s"] < facts["duration_s"]:
        last = errors.dropna(subset="actual_error_s").iloc[-1]
        axes.plot(last["time_s"], last["actual_error_s"], "x", color=style.BLACK, markersize=4)
    for time, color in ((facts["horizon_s"], style.VERMILION), (facts["right_until_s"], style.BLACK)):
        if time < facts["duration_s"]:
            axes.axvline(time, color=color, linewidth=0.6, linestyle=(0, (4, 2)))
    axes.set_xlabel("Time [s]", labelpad=1)


def _draw_exponents(axes: Axes, exponents: pd.DataFrame, thetas: Mapping[str, float]) -> None:
    place = np.arange(len(exponents))
    axes.errorbar(
        exponents["exponent_per_s"],
        place,
        xerr=exponents["uncertainty_per_s"],
        fmt="o",
        markersize=3,
        capsize=2,
        linewidth=0.8,
        color=style.BLUE,
    )
    axes.axvline(0.0, color=style.GREY, linewidth=0.6, linestyle=(0, (1, 2)))
    axes.set_xlim(min(0.0, float((exponents["exponent_per_s"] - exponents["uncertainty_per_s"]).min())), None)
    axes.set_yticks(place, [style.theta_text(thetas[scene]) for scene in exponents["scene"]])
    axes.set_ylim(len(exponents) - 0.5, -0.5)
    axes.set_xlabel("Lyapunov exponent [1/s]", labelpad=1)
    axes.set_title("Largest exponent, 95 % interval", fontsize=7)


def _title(values: Mapping[str, Any]) -> str:
    """What a chain has of its own, for people."""
    parts: Sequence[str] = [
        NAMES[name].format(value if isinstance(value, str) else f"{value * UNITS.get(name, 1.0):.4g}")
        if name in NAMES
        else f"{name} = {value}"
        for name, value in values.items()
        if name != "duration"
    ]
    return ", ".join(parts)
