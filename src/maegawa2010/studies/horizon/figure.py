"""Predictability time: how the errors of a run grow."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from precursors.figures import style
from precursors.figures.style import Options

HEIGHT_MM = 62.0
ERROR_RANGE = (1e-18, 1e-7)
SLOPE_AT = (1.0, 1e-12)  # where the line of the mean growth begins [s]
DECADES = 4.0  # that it rises
# Column of the errors, its look and its words.
ERRORS: dict[str, Options] = {
    "predicted_error_s": {"color": style.GREY, "label": "predicted by the run"},
    "actual_error_s": {"color": style.BLACK, "label": "actual, against the proof"},
}


def draw(
    errors: pd.DataFrame,
    exponents: pd.DataFrame,
    thetas: Mapping[str, float],
    tolerance: float,
) -> Figure:
    """Draw the largest error so far of the times of transitions, a panel for each chain
    of `thetas`.

    The tables are horizon.csv and lyapunov.csv. A dashed line has the slope of the
    largest Lyapunov exponent, and a dotted one is the `tolerance` [s].
    """
    power = f"$10^{{{np.log10(tolerance):.3g}}}$"
    with style.page(style.PAGE_MM, HEIGHT_MM) as figure:
        panels = figure.subplots(
            1, len(thetas), sharex=True, sharey=True, squeeze=False
        )
        for axes, (chain, theta) in zip(panels[0], thetas.items(), strict=True):
            own = errors[errors["chain"] == chain]
            for column, look in ERRORS.items():
                axes.plot(own["time_s"], own[column], **look)
            axes.axhline(tolerance, **style.DOTTED, label=f"tolerance, {power} s")
            is_chains = np.isclose(exponents["theta"], theta)
            for exponent in exponents.loc[is_chains, "exponent_per_s"]:
                _draw_slope(axes, exponent)
            axes.set(yscale="log", ylim=ERROR_RANGE, xlabel="Time [s]")
            axes.set_title(style.theta_text(theta))
        figure.axes[0].set_ylabel("Error of time [s]")
        style.draw_key(figure, figure.axes[0].get_legend_handles_labels()[0])
    return figure


def _draw_slope(axes: Axes, exponent: float) -> None:
    """Draw how fast errors grow on average, with the time that makes them ten times as
    large."""
    tenfold = np.log(10) / exponent
    start, low = SLOPE_AT
    ends = [start, start + DECADES * tenfold]
    axes.plot(ends, [low, low * 10**DECADES], color=style.BLACK, linestyle="--")
    text = f"ten times in {tenfold:.1f} s"
    axes.annotate(text, (start, low * 10**DECADES), fontsize="small", va="bottom")
