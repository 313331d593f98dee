"""Figs. 10-12, and any other scene: the tangential load over time, and when and where blocks slipped."""

from __future__ import annotations

from textwrap import fill
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator

from precursors.analysis.slip_rows import first_global
from precursors.figures import style

HEIGHT_MM = 112.0
PARTIAL = style.BLUE
GLOBAL = style.VERMILION
BROKEN: dict[str, Any] = {"linewidth": 0.8, "linestyle": (0, (5, 3))}
UNFINISHED_ALPHA = 0.2

# The inset shows the last stretch before the first global slip, as fractions of the time of that slip.
INSET_START = 0.68
INSET_END = 1.05
INSET_ON_THE_RIGHT = (0.36, 0.56, 0.58, 0.41)
INSET_ON_THE_LEFT = (0.06, 0.56, 0.58, 0.41)
# Share of the upper panel left free above the load, for the inset.
HEADROOM_WITH_INSET = 0.54
HEADROOM = 0.12
# "Some of them are magnified and indicated by arrows": the largest drops, as many as can be told apart.
MOST_ARROWS = 24
# Lines of the lower panel grow thinner where there are more events than this.
THIN_OUT_FROM = 200
LINE_OF_LABEL = 100


def draw_scene(
    slips: pd.DataFrame, trace: pd.DataFrame, n_blocks: int, length_m: float, label: str = ""
) -> Figure:
    """Draw F_X(t) with a magnified view before the first global slip, and below it the fronts of all slips.

    Parameters
    ----------
    slips : DataFrame
        Slip table, see `style.read_slips`; it may be empty.
    trace : DataFrame
        Points of the tangential load, see `style.read_trace`.
    n_blocks : int
        Number N of blocks.
    length_m : float
        Length L of the contact [m].
    label : str
        What tells this scene from others, such as theta.

    Notes
    -----
    Figs. 10-12 of the paper. A front runs from the trailing edge (0) over L_p = front L / N. An event that
    is not over when the run ends is a band from its onset to the end of the run.
    """
    if trace.empty:
        raise ValueError("the trace has no rows: allowed is at least one point of the tangential load")
    first = first_global(slips)
    first_s = None if first is None else float(slips["onset_s"].iloc[first])
    with style.styled():
        figure = style.new_figure(style.PAGE_MM, HEIGHT_MM)
        upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=[2.2, 1])
        end = float(trace["time_s"].iloc[-1])
        _draw_load(upper, trace, HEADROOM if first_s is None else HEADROOM_WITH_INSET)
        if first_s is None and len(slips):
            label = f"{label} (no global slip)".strip()
        upper.set_title(fill(label, LINE_OF_LABEL), loc="left", fontsize=8, pad=3)
        _draw_fronts(lower, slips, n_blocks, length_m, end)
        lower.set_xlabel("Time $t$ [s]")
        if first_s is None:
            lower.set_xlim(0, end)
        else:
            lower.set_xlim(0, max(end, INSET_END * first_s))
            for axes in (upper, lower):
                _draw_first_global_slip(axes, first_s)
            _draw_inset(upper, slips, trace, first_s)
        _draw_legend(lower, slips)
        figure.align_ylabels([upper, lower])
        style.lay_out(figure)
    return figure


def _color(is_global: bool) -> str:
    return GLOBAL if is_global else PARTIAL


def _draw_load(axes: Axes, trace: pd.DataFrame, headroom: float) -> None:
    axes.plot(trace["time_s"], trace["tangential_load_N"], color=style.BLACK, linewidth=0.6)
    lowest = min(0.0, trace["tangential_load_N"].min())
    highest = max(trace["tangential_load_N"].max(), lowest + 1e-9)
    axes.set_ylim(lowest, lowest + (highest - lowest) / (1 - headroom))
    axes.yaxis.set_major_locator(MaxNLocator(6, steps=[1, 2, 5, 10]))
    axes.set_ylabel("Tangential load $F_X$ [N]")


def _draw_fronts(axes: Axes, slips: pd.DataFrame, n_blocks: int, length_m: float, end_s: float) -> None:
    length_mm = length_m * style.MM_PER_M
    reached_mm = slips["front"] * length_mm / n_blocks
    width = np.clip(THIN_OUT_FROM / max(len(slips), 1), 0.4, 1.0) * 0.9
    for is_global in (False, True):
        chosen = slips["is_global"] == is_global
        axes.vlines(
            slips.loc[chosen, "onset_s"], 0, reached_mm[chosen], color=_color(is_global), linewidth=width
        )
    for event in np.flatnonzero(slips["end_s"].isna()):
        axes.fill_between(
            [slips["onset_s"].iloc[event], end_s],
            0,
            reached_mm.iloc[event],
            color=_color(slips["is_global"].iloc[event]),
            alpha=UNFINISHED_ALPHA,
            linewidth=0,
        )
    if slips.empty:
        axes.text(
            0.5, 0.5, "no slip event", transform=axes.transAxes, ha="center", va="center", color=style.GREY
        )
    axes.set_ylim(0, 1.04 * length_mm)
    axes.set_ylabel("Propagation\nlength $L_p$ [mm]")
    edges = axes.secondary_yaxis("right")
    edges.set_yticks([0, length_mm], ["trailing\nedge", "leading\nedge"])
    edges.tick_params(length=0)
    trailing, leading = edges.get_yticklabels()
    trailing.set_verticalalignment("bottom")
    leading.set_verticalalignment("top")


def _draw_first_global_slip(axes: Axes, time_s: float) -> None:
    axes.axvline(time_s, color=GLOBAL, **BROKEN, zorder=1.5)


def _draw_inset(axes: Axes, slips: pd.DataFrame, trace: pd.DataFrame, first_s: float) -> None:
    start = INSET_START * first_s
    if first_s == 0:
        return
    if first_s < 0.6 * axes.get_xlim()[1]:
        inset = axes.inset_axes(INSET_ON_THE_RIGHT)
        inset.yaxis.tick_right()
    else:
        inset = axes.inset_axes(INSET_ON_THE_LEFT)
    inset.plot(trace["time_s"], trace["tangential_load_N"], color=style.BLACK, linewidth=0.8)
    _draw_first_global_slip(inset, first_s)
    inset.set_xlim(start, INSET_END * first_s)
    inset.tick_params(labelsize=6.5)
    inset.yaxis.set_major_locator(MaxNLocator(5, steps=[1, 2, 5, 10]))
    seen = trace["time_s"].between(start, first_s)
    load = np.append(
        trace.loc[seen, "tangential_load_N"], np.interp(start, trace["time_s"], trace["tangential_load_N"])
    )
    span = np.ptp(load) or 1.0
    inset.set_ylim(load.min() - 0.08 * span, load.max() + 0.22 * span)
    for _, event in _largest_drops(slips, start, first_s).iterrows():
        inset.annotate(
            "",
            xy=(event["onset_s"], event["load_before_N"]),
            xytext=(0, 13),
            textcoords="offset points",
            arrowprops={
                "arrowstyle": "-|>,head_width=0.14,head_length=0.28",
                "color": PARTIAL,
                "linewidth": 0.8,
                "shrinkA": 0,
                "shrinkB": 2,
            },
        )
    frame = axes.indicate_inset_zoom(inset, edgecolor=style.GREY, alpha=0.8, linewidth=0.6)
    for connector, is_shown in zip(frame.connectors or (), (False, True, False, True), strict=False):
        connector.set_visible(is_shown)


def _largest_drops(slips: pd.DataFrame, start: float, first_s: float) -> pd.DataFrame:
    inside = slips[(slips["onset_s"] > start) & (slips["onset_s"] < first_s)]
    drop = (inside["load_before_N"] - inside["load_after_N"]).fillna(np.inf)
    return inside.loc[drop.sort_values(ascending=False, kind="stable").index[:MOST_ARROWS]].sort_index()


def _draw_legend(axes: Axes, slips: pd.DataFrame) -> None:
    entries: list[Line2D | Patch] = []
    if (~slips["is_global"]).any():
        entries.append(Line2D([], [], color=PARTIAL, linewidth=1.2, label="partial slip"))
    if slips["is_global"].any():
        entries.append(Line2D([], [], color=GLOBAL, linewidth=1.2, label="global slip"))
        entries.append(Line2D([], [], color=GLOBAL, **BROKEN, label="first global slip"))
    unfinished = slips[slips["end_s"].isna()]
    if len(unfinished):
        color = _color(unfinished["is_global"].iloc[0])
        entries.append(
            Patch(color=color, alpha=UNFINISHED_ALPHA, linewidth=0, label="not over when the run ends")
        )
    if entries:
        axes.legend(handles=entries, loc="lower right", bbox_to_anchor=(1, 1), ncols=4, borderaxespad=0.1)
