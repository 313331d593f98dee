"""Figs. 10-12, and any other scene: the tangential load over time, and when and where
blocks slipped."""

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
from numpy.typing import NDArray

from precursors.figures import style

HEIGHT_MM = 80.0
NARROW_MM = 120.0  # below this width the magnified view stands below, not beside
PARTIAL = style.PARTIAL
GLOBAL = style.GLOBAL
# Black on the colour of the slip that it marks, and above it.
FIRST_GLOBAL: dict[str, Any] = {
    "color": style.BLACK,
    "linewidth": 0.9,
    "linestyle": (0, (5, 4)),
    "zorder": 3,
}
# A partial slip that ends at the leading edge: its blocks did not all slide at the same
# instant.
TO_THE_EDGE: dict[str, Any] = {
    "color": PARTIAL,
    "linestyle": "none",
    "marker": "o",
    "markersize": 3.6,
}
TO_THE_EDGE |= {"markerfacecolor": "white", "markeredgewidth": 0.9, "clip_on": False}
MEASURED: dict[str, Any] = {
    "color": style.GREY,
    "linewidth": 0.8,
    "zorder": 1.8,
    "label": "measured",
}
UNFINISHED: dict[str, Any] = {"alpha": 0.2, "linewidth": 0}

# The magnified view is the last stretch before the first global slip, as fractions of
# the time of that slip.
ZOOM_START = 0.68
ZOOM_END = 1.05
# The paper marks some of the drops with arrows; more than this many run into each
# other.
MOST_ARROWS = 24
ARROW = {
    "arrowstyle": "-|>,head_width=0.14,head_length=0.28",
    "color": PARTIAL,
    "linewidth": 0.8,
}
# Lines of the lower panel are thinner if there are more events than this.
THIN_OUT_FROM = 200
CHARACTERS_PER_MM = 0.56  # of a title of 8 pt


def draw(
    slips: pd.DataFrame,
    trace: pd.DataFrame,
    title: str = "",
    others: Sequence[pd.DataFrame] = (),
    data: NDArray[np.float64] | None = None,
    inset: bool = True,
    look: style.Look | None = None,
) -> Figure:
    """Draw F_X(t), below it all slip events, and with `inset` both magnified before the
    first global slip.

    An event extends from the trailing edge (0) to L_p = front L / N. An event that goes
    on when the run ends is a band from its onset to the end of the run.

    The slip table may be empty; the trace is straight between its rows. The load axis
    holds the traces of `others` as well. `data`, shape (n, 2), are measured times [s]
    and loads [N].
    """
    look = look or style.Look()
    width_mm = look.width_mm or style.PAGE_MM
    slips = slips.astype({"is_global": bool})
    loads = [table["tangential_load_N"] for table in (trace, *others)]
    if data is not None:
        loads.append(pd.Series(data[:, 1]))
    first_s = slips.loc[slips["is_global"], "onset_s"].min()
    end = trace["time_s"].iloc[-1]
    spans = [(0.0, float(np.nanmax([end, ZOOM_END * first_s])))]
    if inset and first_s > 0:
        spans.append((ZOOM_START * first_s, ZOOM_END * first_s))
    is_narrow = width_mm < NARROW_MM
    stacked = len(spans) > 1 and is_narrow
    height_mm = HEIGHT_MM * (0.4 + 0.75 * len(spans) if is_narrow else 1.0)
    with style.page(width_mm, height_mm, look=look) as figure:
        panels = _panels(figure, len(spans), stacked)
        for column, axes in enumerate(panels):
            upper, lower = axes
            start, stop = spans[column]
            upper.plot(
                trace["time_s"],
                trace["tangential_load_N"],
                color=style.BLACK,
                linewidth=0.6,
            )
            _draw_events(lower, slips[slips["onset_s"].between(start, stop)], end)
            lower.set(xlim=(start, stop), xlabel="Time $t$ [s]")
            if first_s >= 0:
                for panel in axes:
                    panel.axvline(first_s, **FIRST_GLOBAL)
            if data is not None:
                upper.plot(*data.T, **MEASURED)
            if column == 0:
                _set_load_axis(upper, pd.concat(loads))
                upper.set_title(
                    _title(slips, title, width_mm, look.font_size), loc="left", pad=3
                )
            else:
                _magnify(upper, slips, trace, spans[1])
            if column == 0 or stacked:
                upper.set_ylabel(
                    "Load $F_X$ [N]" if is_narrow else "Tangential load $F_X$ [N]"
                )
                lower.set_ylabel("$L_p$ [mm]")
                figure.align_ylabels([upper, lower])
        if len(spans) > 1:
            for panel in panels[0]:
                panel.axvspan(*spans[1], color=style.PALE, linewidth=0, zorder=0)
            panels[1][0].set_title("the grey stretch, magnified", loc="left", pad=3)
        _draw_key(figure, slips, data is not None, width_mm, look)
    return figure


def _panels(figure: Figure, n: int, stacked: bool) -> list[tuple[Axes, Axes]]:
    """Load and events over the same time, n times beside or below each other."""
    rows, columns = (2 * n, 1) if stacked else (2, n)
    ratios = {"height_ratios": [2.2, 1] * (rows // 2), "width_ratios": [5, 3][:columns]}
    grid = figure.add_gridspec(rows, columns, **ratios)
    pairs = []
    for j in range(n):
        upper = figure.add_subplot(grid[2 * j, 0] if stacked else grid[0, j])
        lower = figure.add_subplot(
            grid[2 * j + 1, 0] if stacked else grid[1, j], sharex=upper
        )
        upper.tick_params(labelbottom=False)
        pairs.append((upper, lower))
    return pairs


def _title(slips: pd.DataFrame, title: str, width_mm: float, font_size: float) -> str:
    parts = (
        [style.theta_text(slips["theta"].iloc[0])]
        if slips["theta"].notna().any()
        else ["loads as measured"] * (len(slips) > 0)
    )
    note = " (no global slip)" if len(slips) and not slips["is_global"].any() else ""
    text = ": ".join([*parts, style.plain(title)]).removesuffix(": ") + note
    return fill(text, max(20, int(CHARACTERS_PER_MM * width_mm * 8 / font_size)))


def _set_load_axis(axes: Axes, loads: pd.Series) -> None:
    """From zero, or below it if need be, to the next tick."""
    locator = MaxNLocator(6, steps=[1, 2, 5, 10])
    lowest = min(0.0, loads.min())
    axes.yaxis.set_major_locator(locator)
    axes.set_ylim(
        lowest, locator.tick_values(lowest, max(loads.max(), lowest + 1e-9))[-1]
    )


def _draw_events(axes: Axes, slips: pd.DataFrame, end_s: float) -> None:
    if slips.empty:
        axes.text(
            0.5,
            0.5,
            "no slip event",
            transform=axes.transAxes,
            ha="center",
            color=style.GREY,
        )
        axes.set_yticks([])
        return
    length_mm = slips["length_m"].iloc[0] * style.MM_PER_M
    events = slips.assign(reached_mm=slips["front"] * length_mm / slips["n_blocks"])
    width = 0.9 * np.clip(THIN_OUT_FROM / len(slips), 0.4, 1.0)
    for is_global, color in ((False, PARTIAL), (True, GLOBAL)):
        chosen = events[events["is_global"] == is_global]
        axes.vlines(
            chosen["onset_s"], 0, chosen["reached_mm"], color=color, linewidth=width
        )
        for _, event in chosen[chosen["end_s"].isna()].iterrows():
            axes.fill_between(
                [event["onset_s"], end_s],
                0,
                event["reached_mm"],
                color=color,
                **UNFINISHED,
            )
    to_the_edge = events[~events["is_global"] & (events["front"] == events["n_blocks"])]
    if len(
        to_the_edge
    ):  # an empty line that is not clipped has no place, and upsets the layout
        axes.plot(to_the_edge["onset_s"], to_the_edge["reached_mm"], **TO_THE_EDGE)
    axes.set_ylim(0, 1.08 * length_mm)


def _magnify(
    axes: Axes, slips: pd.DataFrame, trace: pd.DataFrame, span: tuple[float, float]
) -> None:
    """Fit the load axis to a stretch of time, and mark the largest drops in it."""
    start = span[0]
    first_s = span[1] / ZOOM_END
    axes.yaxis.set_major_locator(MaxNLocator(5, steps=[1, 2, 5, 10]))
    seen = trace["time_s"].between(start, first_s)
    at_start = np.interp(start, trace["time_s"], trace["tangential_load_N"])
    load = np.append(trace.loc[seen, "tangential_load_N"], at_start)
    room = np.ptp(load) or 1.0
    axes.set_ylim(load.min() - 0.08 * room, load.max() + 0.22 * room)
    for _, event in _largest_drops(slips, start, first_s).iterrows():
        axes.annotate(
            "",
            xy=(event["onset_s"], event["load_before_N"]),
            xytext=(0, 13),
            textcoords="offset points",
            arrowprops={**ARROW, "shrinkA": 0, "shrinkB": 2},
        )


def _largest_drops(slips: pd.DataFrame, start: float, first_s: float) -> pd.DataFrame:
    inside = slips[(slips["onset_s"] > start) & (slips["onset_s"] < first_s)]
    drop = (inside["load_before_N"] - inside["load_after_N"]).fillna(np.inf)
    return inside.loc[
        drop.sort_values(ascending=False, kind="stable").index[:MOST_ARROWS]
    ].sort_index()


def _draw_key(
    figure: Figure,
    slips: pd.DataFrame,
    has_data: bool,
    width_mm: float,
    look: style.Look,
) -> None:
    is_global = slips["is_global"]
    entries: list[Line2D | Patch] = [Line2D([], [], **MEASURED)] if has_data else []
    if (~is_global).any():
        entries.append(
            Line2D([], [], color=PARTIAL, linewidth=1.2, label="partial slip")
        )
    if (~is_global & (slips["front"] == slips["n_blocks"])).any():
        entries.append(
            Line2D([], [], **TO_THE_EDGE, label="partial, to the leading edge")
        )
    if is_global.any():
        entries.append(Line2D([], [], color=GLOBAL, linewidth=1.2, label="global slip"))
        entries.append(Line2D([], [], **FIRST_GLOBAL, label="first global slip"))
    for one in is_global[slips["end_s"].isna()][:1]:
        color = GLOBAL if one else PARTIAL
        entries.append(
            Patch(color=color, **UNFINISHED, label="not over when the run ends")
        )
    columns = max(1, min(len(entries), int(width_mm / 38 * 8 / look.font_size)))
    style.draw_key(figure, entries, ncols=columns)
