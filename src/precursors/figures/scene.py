"""Figs. 10-12, and any other scene: the tangential load over time, and when and where blocks slipped."""

from __future__ import annotations

from collections.abc import Sequence
from textwrap import fill
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator

from precursors.figures import style

HEIGHT_MM = 94.0
PARTIAL, GLOBAL = style.BLUE, style.VERMILION
# Black on the colour of the slip that it marks, and above it.
FIRST_GLOBAL: dict[str, Any] = {"color": style.BLACK, "linewidth": 0.9, "linestyle": (0, (5, 4)), "zorder": 3}
# A partial slip that ends at the leading edge: its blocks did not all slide at the same instant.
TO_THE_EDGE: dict[str, Any] = {"color": PARTIAL, "linestyle": "none", "marker": "o", "markersize": 3.6}
TO_THE_EDGE |= {"markerfacecolor": "white", "markeredgewidth": 0.9, "clip_on": False}
MEASURED: dict[str, Any] = {"color": style.ORANGE, "linewidth": 0.8, "zorder": 1.8, "label": "measured"}
UNFINISHED: dict[str, Any] = {"alpha": 0.2, "linewidth": 0}

# The inset shows the last stretch before the first global slip, as fractions of the time of that slip.
INSET_START, INSET_END = 0.68, 1.05
INSET_BOX = (0.58, 0.41)  # its width and height, as fractions of the upper panel
# Fraction of the upper panel that stays free above the load, with and without the inset.
HEADROOM = {True: 0.54, False: 0.12}
# The paper marks some of the drops with arrows; more than this many run into each other.
MOST_ARROWS = 24
ARROW = {"arrowstyle": "-|>,head_width=0.14,head_length=0.28", "color": PARTIAL, "linewidth": 0.8}
# Lines of the lower panel are thinner if there are more events than this.
THIN_OUT_FROM = 200
CHARACTERS_OF_TITLE = 100


def draw(
    slips: pd.DataFrame,
    trace: pd.DataFrame,
    title: str = "",
    others: Sequence[pd.DataFrame] = (),
    data: pd.DataFrame | None = None,
) -> Figure:
    """Draw F_X(t) with a magnified view before the first global slip, and below it all slip events.

    Parameters
    ----------
    slips : DataFrame
        Slip table of the scene, {scene}_slips.csv. It may be empty.
    trace : DataFrame
        {scene}_trace.csv: straight lines between its rows are the tangential load.
    title : str
        Name of the scene.
    others : sequence of DataFrame
        Traces of scenes to compare with: the load axis holds them, too.
    data : DataFrame, optional
        An experiment: time [s] and tangential load [N] in the first two columns.

    Notes
    -----
    An event extends from the trailing edge (0) to L_p = front L / N. An event that goes on when the run ends
    is a band from its onset to the end of the run.
    """
    slips = slips.astype({"is_global": bool})
    if data is not None:
        data = data.iloc[:, :2].set_axis(["time_s", "tangential_load_N"], axis=1).astype(float)
        others = [*others, data]
    first_s = slips.loc[slips["is_global"], "onset_s"].min()
    has_global = bool(slips["is_global"].any())
    end = trace["time_s"].iloc[-1]
    with style.page(style.PAGE_MM, HEIGHT_MM) as figure:
        upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=[2.2, 1])
        _draw_load(upper, trace, others, HEADROOM[has_global or len(others) > 0])
        upper.set_title(fill(_title(slips, title), CHARACTERS_OF_TITLE), loc="left", pad=3)
        _draw_events(lower, slips, end)
        lower.set_xlabel("Time $t$ [s]")
        lower.set_xlim(0, max(end, INSET_END * first_s) if has_global else end)
        if has_global:
            for axes in (upper, lower):
                axes.axvline(first_s, **FIRST_GLOBAL)
        if has_global and first_s > 0:
            _draw_inset(upper, slips, trace, first_s)
        if data is not None:
            for axes in (upper, *upper.child_axes):
                axes.plot(data["time_s"], data["tangential_load_N"], **MEASURED, scaley=False)
            upper.legend(handles=[Line2D([], [], **MEASURED)], loc="lower right")
        _draw_key(lower, slips)
        figure.align_ylabels([upper, lower])
    return figure


def _title(slips: pd.DataFrame, title: str) -> str:
    parts = [style.theta_text(slips["theta"].iloc[0])] if slips["theta"].notna().any() else []
    note = " (no global slip)" if len(slips) and not slips["is_global"].any() else ""
    return ": ".join([*parts, style.plain(title)]).removesuffix(": ") + note


def _draw_load(axes: Axes, trace: pd.DataFrame, others: Sequence[pd.DataFrame], headroom: float) -> None:
    axes.plot(trace["time_s"], trace["tangential_load_N"], color=style.BLACK, linewidth=0.6)
    loads = pd.concat([trace, *others])["tangential_load_N"]
    lowest = min(0.0, loads.min())
    highest = max(loads.max(), lowest + 1e-9)
    axes.set_ylim(lowest, lowest + (highest - lowest) / (1 - headroom))
    axes.yaxis.set_major_locator(MaxNLocator(6, steps=[1, 2, 5, 10]))
    axes.set_ylabel("Tangential load $F_X$ [N]")


def _draw_events(axes: Axes, slips: pd.DataFrame, end_s: float) -> None:
    axes.set_ylabel("Propagation\nlength $L_p$ [mm]")
    if slips.empty:
        axes.text(0.5, 0.5, "no slip event", transform=axes.transAxes, ha="center", color=style.GREY)
        axes.set_yticks([])
        return
    length_mm = slips["length_m"].iloc[0] * style.MM_PER_M
    events = slips.assign(reached_mm=slips["front"] * length_mm / slips["n_blocks"])
    width = 0.9 * np.clip(THIN_OUT_FROM / len(slips), 0.4, 1.0)
    for is_global, color in ((False, PARTIAL), (True, GLOBAL)):
        chosen = events[events["is_global"] == is_global]
        axes.vlines(chosen["onset_s"], 0, chosen["reached_mm"], color=color, linewidth=width)
        for _, event in chosen[chosen["end_s"].isna()].iterrows():
            axes.fill_between([event["onset_s"], end_s], 0, event["reached_mm"], color=color, **UNFINISHED)
    to_the_edge = events[~events["is_global"] & (events["front"] == events["n_blocks"])]
    axes.plot(to_the_edge["onset_s"], to_the_edge["reached_mm"], **TO_THE_EDGE)
    axes.set_ylim(0, 1.08 * length_mm)
    edges = axes.secondary_yaxis("right")
    edges.set_yticks([0, length_mm], ["trailing\nedge", "leading\nedge"])
    edges.tick_params(length=0)
    trailing, leading = edges.get_yticklabels()
    trailing.set_verticalalignment("bottom")
    leading.set_verticalalignment("top")


def _draw_inset(axes: Axes, slips: pd.DataFrame, trace: pd.DataFrame, first_s: float) -> None:
    start, end = INSET_START * first_s, INSET_END * first_s
    on_the_right = first_s < 0.6 * axes.get_xlim()[1]
    inset = axes.inset_axes((0.36 if on_the_right else 0.06, 0.56, *INSET_BOX))
    if on_the_right:
        inset.yaxis.tick_right()
    inset.plot(trace["time_s"], trace["tangential_load_N"], color=style.BLACK)
    inset.axvline(first_s, **FIRST_GLOBAL)
    inset.yaxis.set_major_locator(MaxNLocator(5, steps=[1, 2, 5, 10]))
    load_at_start = np.interp(start, trace["time_s"], trace["tangential_load_N"])
    seen = trace["time_s"].between(start, first_s)
    load = np.append(trace.loc[seen, "tangential_load_N"], load_at_start)
    span = np.ptp(load) or 1.0
    inset.set(xlim=(start, end), ylim=(load.min() - 0.08 * span, load.max() + 0.22 * span))
    for _, event in _largest_drops(slips, start, first_s).iterrows():
        inset.annotate(
            "",
            xy=(event["onset_s"], event["load_before_N"]),
            xytext=(0, 13),
            textcoords="offset points",
            arrowprops={**ARROW, "shrinkA": 0, "shrinkB": 2},
        )
    frame = axes.indicate_inset_zoom(inset, edgecolor=style.GREY, alpha=1.0, linewidth=0.6)
    for connector, is_shown in zip(frame.connectors or (), (False, True, False, True), strict=False):
        connector.set_visible(is_shown)


def _largest_drops(slips: pd.DataFrame, start: float, first_s: float) -> pd.DataFrame:
    inside = slips[(slips["onset_s"] > start) & (slips["onset_s"] < first_s)]
    drop = (inside["load_before_N"] - inside["load_after_N"]).fillna(np.inf)
    return inside.loc[drop.sort_values(ascending=False, kind="stable").index[:MOST_ARROWS]].sort_index()


def _draw_key(axes: Axes, slips: pd.DataFrame) -> None:
    is_global = slips["is_global"]
    entries: list[Line2D | Patch] = []
    if (~is_global).any():
        entries.append(Line2D([], [], color=PARTIAL, linewidth=1.2, label="partial slip"))
    if (~is_global & (slips["front"] == slips["n_blocks"])).any():
        entries.append(Line2D([], [], **TO_THE_EDGE, label="partial, to the leading edge"))
    if is_global.any():
        entries.append(Line2D([], [], color=GLOBAL, linewidth=1.2, label="global slip"))
        entries.append(Line2D([], [], **FIRST_GLOBAL, label="first global slip"))
    for one in is_global[slips["end_s"].isna()][:1]:
        color = GLOBAL if one else PARTIAL
        entries.append(Patch(color=color, **UNFINISHED, label="not over when the run ends"))
    axes.legend(
        handles=entries, loc="lower right", bbox_to_anchor=(1, 1), ncols=len(entries), borderaxespad=0.1
    )
