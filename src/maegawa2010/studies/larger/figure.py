"""A chain with a length of its own: where creep runs away, and how it settles."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from precursors.figures import style
from precursors.figures.style import Options

HEIGHT_MM = 70.0
WIDTHS = (1.0, 0.85, 2.3)
MARKERS = {-1: "v", 0: "o", 1: "^"}  # by the sign of theta
SIDE = 0.22  # from one loading to the next, in units of one pair
RARE = 0.05


def draw(nucleation: pd.DataFrame, peaks: pd.DataFrame, cycles: pd.DataFrame) -> Figure:
    """Draw l_c against its theory, each peak against the one before, and all cycles.

    The tables are larger_nucleation.csv, larger_peaks.csv and larger_cycles.csv, of
    which the study "grid" is drawn. Cycles into which no more than `RARE` of the pasts
    lead have small marks.
    """
    with style.page(style.PAGE_MM, HEIGHT_MM) as figure:
        lengths, steps, settled = figure.subplots(1, 3, width_ratios=WIDTHS)
        two_finest = sorted(nucleation["n_blocks"].unique())[-2:]
        _draw_lengths(lengths, nucleation[nucleation["n_blocks"].isin(two_finest)])
        _draw_map(steps, peaks)
        _draw_cycles(settled, cycles[cycles["study"] == "grid"])
        look = {"linestyle": "none"}
        entries = [
            style.mark(text, marker=MARKERS[s], color=style.theta_color(s), **look)
            for s, text in style.LOADINGS.items()
        ]
        open_marks = {"marker": "o", "color": style.GREY, "markerfacecolor": "none"}
        entries.append(style.mark("open: fewer blocks", **look, **open_marks))
        style.draw_key(figure, entries)
    return figure


def _look(rows: pd.DataFrame, finest: int) -> Options:
    """Mark of rows with one theta and one number of blocks."""
    first = rows.iloc[0]
    color = style.theta_color(first["theta"])
    return {
        "linestyle": "none",
        "marker": MARKERS[int(np.sign(first["theta"]))],
        "color": color,
        "markerfacecolor": color if first["n_blocks"] == finest else "none",
    }


def _draw_lengths(axes: Axes, nucleation: pd.DataFrame) -> None:
    finest = nucleation["n_blocks"].max()
    for _, rows in nucleation.groupby(["theta", "n_blocks"]):
        look = _look(rows, finest)
        axes.plot(rows["critical_length"], rows["measured"], **look)
    ends = [0.0, 1.1 * nucleation["critical_length"].max()]
    axes.axline((0, 0), slope=1, color=style.GREY)
    low, high = np.outer([0.9, 1.1], ends)
    axes.fill_between(ends, low, high, color=style.PALE)
    axes.set(xlim=ends, ylim=ends)
    axes.set(xlabel=r"$l_c/L$, theory", ylabel="length that crept, over $L$")


def _draw_map(axes: Axes, peaks: pd.DataFrame) -> None:
    for _, run in peaks.groupby("past"):
        before = run["peak"].to_numpy()
        axes.plot(before[:-1], before[1:], ".", color=style.BLACK, markersize=3)
    middle = peaks["peak"].median()
    axes.axline((middle, middle), slope=1, color=style.GREY)
    axes.set(xlabel=r"peak of $F_X/F_Z$", ylabel="next peak")


def _draw_cycles(axes: Axes, cycles: pd.DataFrame) -> None:
    pairs = cycles.groupby(["length", "relaxation_time"])
    places = pd.Series(range(pairs.ngroups), pairs.size().index)
    finest = cycles["n_blocks"].max()
    for i, (_, of_pair) in enumerate(pairs):
        theory = of_pair.loc[of_pair["theta"] == 0, "theory"].iloc[0]
        axes.hlines(theory, i - 0.4, i + 0.4, color=style.GREY)
        is_rare = of_pair["share"] <= RARE
        for _, rows in of_pair.groupby(["theta", "n_blocks", is_rare]):
            x = i + SIDE * np.sign(rows["theta"])
            size = 2.0 if rows["share"].max() <= RARE else 4.5
            look = _look(rows, finest) | {"markersize": size}
            axes.plot(x, rows["coefficient"], **look)
    axes.set_xticks(places, [f"{1e6 * time:g}" for _, time in places.index])
    axes.set(xlabel="$t_v$ [µs]", ylabel=r"settled peak of $F_X/F_Z$")
    middles = places.groupby("length").mean()
    lengths = axes.secondary_xaxis("top")
    lengths.set_xticks(middles, [f"$l_c = {length:g}\\,L$" for length in middles.index])
    lengths.tick_params(length=0)
