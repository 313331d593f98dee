"""Figure: the paper's six numbers are reproduced, but other draws give other numbers."""

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from maegawa2010 import printed
from precursors.figures import precursor_lengths, style
from precursors.figures.style import Options

HEIGHT_MM = 78.0
WIDTH = 0.3  # of a bar, so that the bars of three loadings stand side by side
TITLE: Options = {"fontsize": 8.6, "fontweight": "bold", "loc": "left"}
OTHER = 0.4  # share of the colour of bars with another count than the paper's


def draw(
    slips: Sequence[pd.DataFrame],
    noise: pd.DataFrame,
    digits: pd.DataFrame,
    all_six: pd.Series,
) -> Figure:
    """Draw Fig. 13, and beside it the distribution of the count of events: of runs with
    noise in the loads, and of sliders with the same printed inputs.

    `noise` and `digits` are noise_members.csv and digits_members.csv; draw 0 is the
    slider with the printed digits. `all_six` is the row of digits.csv that says how many
    sliders have all six numbers.
    """
    with style.page(style.PAGE_MM, HEIGHT_MM) as figure:
        panels = figure.subplot_mosaic("LN;LD")
        left = panels["L"]
        precursor_lengths.draw_lengths(
            left, [table[table["counted"]] for table in slips]
        )
        left.set_title("The paper's six numbers come out", **TITLE)
        alike = _draw_counts(panels["N"], noise)
        _draw_counts(panels["D"], digits)
        share = 100 * noise.loc[noise["draw"] > 0, "load_noise"].max()
        panels["N"].set_title(
            f"With {share:g} % of noise in the loads\n{alike} % of runs keep the count",
            **TITLE,
        )
        k, n = all_six[["k", "n"]]
        panels["D"].set_title(
            f"Of {n} sliders with the same printed inputs\n"
            f"{k or 'none'} ha{'s' if k < 2 else 've'} all six numbers",
            **TITLE,
        )
        panels["N"].sharex(panels["D"])
        panels["N"].tick_params(labelbottom=False)
        panels["D"].set_xlabel("Events counted in Fig. 13 [-]")
        carried = style.mark(
            precursor_lengths.CARRIED_TEXT,
            **precursor_lengths.CARRIED | {"color": style.GREY},
        )
        bar = style.mark("the paper's count", color=style.GREY, linewidth=5)
        pale = style.pale(style.GREY, OTHER)
        other = style.mark("another count", color=pale, linewidth=5)
        style.draw_key(figure, [carried, bar, other])
    return figure


def _draw_counts(axes: Axes, members: pd.DataFrame) -> str:
    """Draw the distribution of the count of events, a colour for each loading; return
    the shares with the paper's count in words [%]."""
    shares = []
    for scene, own in members.groupby("scene", sort=False):
        sign = int(np.sign(own.loc[own["draw"] == 0, "theta"].iloc[0]))
        color = style.theta_color(sign)
        counts = own.loc[own["draw"] > 0, "events_counted"]
        share = 100 * counts.value_counts(normalize=True)
        paper = printed.SCENES[str(scene)]["events_counted"]
        colors = np.where(share.index == paper, color, style.pale(color, OTHER))
        axes.bar(share.index + WIDTH * sign, share, WIDTH, color=colors)
        same = share.get(paper, 0.0)
        shares.append(f"{same:.0f}")
        axes.annotate(
            f"{same:.0f} %",
            (paper + WIDTH * sign, same),
            (0, 2),
            textcoords="offset points",
            ha="center",
            color=color,
            fontweight="bold",
        )
    axes.set(ylabel="Share of runs [%]", ylim=(0, 130))
    return f"{', '.join(shares[:-1])} and {shares[-1]}"
