"""Predictability time: how the errors of a run grow."""

from collections.abc import Mapping

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from precursors.figures import style

HEIGHT_MM = 56.0
ERROR_RANGE = (1e-19, 1e-7)
# Column of the errors, its words, and where they stand in the panel.
ERRORS = {
    "predicted_error_s": (style.GREY, "predicted by the run", (0.04, 0.58)),
    "actual_error_s": (style.BLACK, "actual, against the proof", (0.3, 0.16)),
}
DASHED = "dashed: mean growth\nof the first error"


def draw(
    errors: pd.DataFrame,
    exponents: pd.DataFrame,
    thetas: Mapping[str, float],
    tolerance: float,
) -> Figure:
    """Draw the largest error so far of the times of transitions, a panel for each chain
    of `thetas`.

    The tables are horizon.csv and lyapunov.csv. A dashed line starts with the first
    actual error and has the slope of the largest Lyapunov exponent. A dotted one is the
    `tolerance` [s].
    """
    with style.page(style.PAGE_MM, HEIGHT_MM) as figure:
        panels = style.columns(figure, "Error of time [s]", len(thetas))
        for axes, (chain, theta) in zip(panels, thetas.items(), strict=True):
            own = errors[errors["chain"] == chain]
            for column, (color, _, _) in ERRORS.items():
                axes.plot(own["time_s"], own[column], color=color)
            axes.axhline(tolerance, **style.DOTTED)
            axes.set_title(style.theta_text(theta))
            is_chains = np.isclose(exponents["theta"], theta)
            for exponent in exponents.loc[is_chains, "exponent_per_s"]:
                growth = np.exp(exponent * (own["time_s"] - own["time_s"].iloc[0]))
                mean = own["actual_error_s"].iloc[0] * growth
                axes.plot(own["time_s"], mean, color=style.BLACK, linestyle="--")
                words = f"on average, tenfold in {np.log(10) / exponent:.1f} s"
                axes.set_title(f"{style.theta_text(theta)}: {words}")
            axes.set(yscale="log", ylim=ERROR_RANGE, xlabel="Time [s]")
        panels[0].text(0.0, tolerance, "tolerance", va="bottom")
        panels[-1].annotate(DASHED, (0.36, 0.1), xycoords="axes fraction")
        for color, words, place in ERRORS.values():
            panels[0].annotate(words, place, xycoords="axes fraction", color=color)
    return figure
