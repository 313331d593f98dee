"""Figure: growth of the errors of a run, actual and predicted."""

from collections.abc import Mapping

import pandas as pd
from matplotlib.figure import Figure

from precursors.figures import style

HEIGHT_MM = 60.0
ERROR_RANGE = (1e-19, 1e-7)
FINDING = "Every error is smaller than the run itself predicts"
# By column: colour, label, and position of the label in the panel.
ERRORS = {
    "predicted_error_s": (style.GREY, "predicted by the run", (0.04, 0.58)),
    "actual_error_s": (style.BLACK, "actual, against the proof", (0.3, 0.16)),
}


def draw(errors: pd.DataFrame, thetas: Mapping[str, float], tolerance: float) -> Figure:
    """Draw the largest error of a transition's time so far, a panel for each chain of
    `thetas`.

    `errors` is horizon.csv. A dotted line marks the `tolerance` [s].
    """
    shown = errors[errors["chain"].isin(thetas)]
    with style.page(style.PAGE_MM, HEIGHT_MM) as figure:
        panels = style.columns(figure, "Error of time [s]", len(thetas))
        for axes, (chain, theta) in zip(panels, thetas.items(), strict=True):
            own = shown[shown["chain"] == chain]
            for column, (color, _, _) in ERRORS.items():
                axes.plot(own["time_s"], own[column], color=color)
            axes.axhline(tolerance, **style.DOTTED)
            axes.set_title(style.theta_text(theta))
            axes.set(yscale="log", ylim=ERROR_RANGE, xlabel="Time [s]")
        panels[0].text(0.0, tolerance, "tolerance", va="bottom")
        for color, words, place in ERRORS.values():
            panels[0].annotate(words, place, xycoords="axes fraction", color=color)
        if (shown["actual_error_s"] < shown["predicted_error_s"]).all():
            figure.suptitle(FINDING, fontweight="bold", fontsize="medium")
    return figure
