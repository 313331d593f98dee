"""By how much mu_sapp differs from that of uniform load, against the noise."""

from __future__ import annotations

import pandas as pd
from matplotlib.figure import Figure

from maegawa2010.printed import LAST_DIGIT
from precursors.figures import style

HEIGHT_MM = 52.0


def draw(table: pd.DataFrame) -> Figure:
    """Draw differences of the medians of mu_sapp with their intervals.

    The table is noise_amplitudes.csv. A dotted line marks a unit of the last printed
    digit.
    """
    uniform = table["other_theta"].abs().min()
    differences = table[table["other_theta"].eq(uniform)]
    with style.page(style.COLUMN_MM, HEIGHT_MM) as figure:
        axes = figure.subplots()
        for theta, rows in differences.groupby("theta"):
            axes.errorbar(
                100.0 * rows["load_noise"],
                rows["difference"],
                [rows["difference"] - rows["low"], rows["high"] - rows["difference"]],
                color=style.theta_color(float(str(theta))),
                marker="s",
                linestyle="none",
            )
        style.draw_level(axes, LAST_DIGIT, "unit of the last printed digit", "top")
        axes.set(xscale="log", ylim=(0, None), xlabel="Noise in the normal loads [%]")
        axes.set_ylabel(r"Difference of $\mu_\mathrm{sapp}$ [-]")
        least = differences["low"].min()
        axes.set_title(f"The two loadings differ by at least {least:.3f}")
    return figure
