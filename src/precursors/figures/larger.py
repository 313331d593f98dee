"""A chain with a length of its own: where creep runs away, and what does not depend on
N any longer."""

from __future__ import annotations

from itertools import cycle
from typing import Any

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from precursors.figures import style

HEIGHT_MM = 72.0
COLORS = (*style.OTHERS, style.BLACK)
MARKERS = "os^vPX"
TIMES = {
    0.0: "o",
    1e-6: "s",
    5e-6: "^",
    2e-5: "D",
    2e-4: "v",
}  # relaxation time to marker


def draw(nucleation: pd.DataFrame, table: pd.DataFrame) -> Figure:
    """Draw l_c against its theory, and events and mu_sapp against N.

    The tables are larger_nucleation.csv and larger.csv, whose study "resolution" is
    drawn.
    """
    with style.page(style.PAGE_MM, HEIGHT_MM) as figure:
        lengths, counts, frictions = figure.subplots(1, 3)
        _draw_lengths(lengths, nucleation)
        runs = table[(table["study"] == "resolution") & (table["theta"] == 0)]
        _draw_medians(counts, runs, "events_counted")
        _draw_medians(frictions, runs, "mu_sapp")
        counts.set(xscale="log", yscale="log", ylabel=style.EVENTS_LABEL)
        frictions.set(xscale="log", ylabel=style.MU_SAPP_LABEL)
        blocks = sorted(int(n) for n in runs["n_blocks"].unique())
        for axes in (counts, frictions):
            axes.set_xlabel(style.BLOCKS_LABEL)
            axes.xaxis.minorticks_off()
            axes.set_xticks(blocks, [str(n) for n in blocks])
        counts.yaxis.minorticks_off()
        counts.set_yticks([5, 10, 20, 50], ["5", "10", "20", "50"])
        style.draw_key(figure, counts.get_legend_handles_labels()[0])
    return figure


def _draw_lengths(axes: Axes, nucleation: pd.DataFrame) -> None:
    finest = nucleation["n_blocks"].max()
    for time, marker in TIMES.items():
        for n, rows in nucleation[nucleation["relaxation_time"] == time].groupby(
            "n_blocks"
        ):
            filled = n == finest
            look: dict[str, Any] = {
                "linestyle": "none",
                "marker": marker,
                "markersize": 4,
            }
            look |= {
                "color": style.BLACK,
                "markerfacecolor": style.BLACK if filled else "none",
            }
            label = rf"$t_v = {time * 1e6:g}$ µs" if filled else None
            axes.plot(rows["theory"], rows["measured"], **look, label=label)
    ends = [0.0, 1.1 * nucleation["theory"].max()]
    axes.plot(ends, ends, color=style.GREY, linewidth=0.8)
    axes.fill_between(
        ends,
        [0.0, 0.9 * ends[1]],
        [0.0, 1.1 * ends[1]],
        color=style.GREY,
        alpha=0.2,
        lw=0,
    )
    axes.set(
        xlim=ends,
        ylim=ends,
        xlabel=r"$l_c/L$, theory",
        ylabel="length that crept, over $L$",
    )
    axes.legend(loc="upper left", handlelength=1.0, borderaxespad=0.2)


def _draw_medians(axes: Axes, runs: pd.DataFrame, quantity: str) -> None:
    looks = cycle(zip(COLORS, MARKERS, strict=True))
    for (v_c, _), rows in runs.groupby(
        ["weakening_velocity", "relaxation_time"], sort=False
    ):
        color, marker = (style.GREY, "D") if v_c == 0 else next(looks)
        low, high = (
            abs(rows[quantity] - rows[f"{quantity}_{end}"]) for end in ("low", "high")
        )
        look: dict[str, Any] = {
            "color": color,
            "marker": marker,
            "markersize": 3.5,
            "linewidth": 1.0,
        }
        label = (
            "paper's chain"
            if v_c == 0
            else rf"$l_c = {rows['critical_length'].iloc[0]:.2f} L$"
        )
        axes.errorbar(
            rows["n_blocks"],
            rows[quantity],
            [low, high],
            **look,
            elinewidth=0.8,
            label=label,
        )
