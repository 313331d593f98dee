"""The push along the row: why a slip stops where it does."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from precursors.figures import style
from precursors.figures.style import Options
from precursors.figures.wave import middle_last_and_global

HEIGHT_MM = 66.0  # of a row of panels
NARROW_MM = 120.0  # below this width the panels stand below each other
FINDING = "A slip stops where friction has used up the push"
FILL: Options = {"fill": True, "linewidth": 0}
LEFT: Options = {
    "color": style.BLACK,
    "linestyle": "--",
    "linewidth": 1.2,
    "label": "what kinetic friction\nleaves of $F_X$",
}
# The row below a panel, in units of the panel; and in it, in lengths of the row, the
# place of the drive and both ends.
ROW = (0.0, -0.16, 1.0, 0.13)
DRIVE = -0.1
ENDS = (-0.14, 1.22)
SIDE = 0.76  # of a block, in units of its part of the row
NUMBERED = 12  # blocks at most that have their numbers in them


def draw(
    run: Any,
    slips: pd.DataFrame,
    events: Sequence[int] = (),
    title: str | None = None,
    look: style.Look = style.LOOK,
) -> Figure:
    """Draw the push in each spring before and after some events, a panel for each, and
    over it what kinetic friction leaves of the load, F_X - mu_k W(x). `run` is a `Run`.

    `events` are numbers of rows of the slip table, from 1; by default a precursor, the
    longest one and the first global slip.

    Raises
    ------
    ValueError
        If there is no such event, or it is not over when the run ends.
    """
    shown = _chosen(slips, events) if events else middle_last_and_global(slips)
    n = max(len(shown), 1)
    is_narrow = (look.width_mm or style.PAGE_MM) < NARROW_MM
    size = (n, 1) if is_narrow else (1, n)
    with style.page(style.PAGE_MM, HEIGHT_MM * size[0], look) as figure:
        panels = figure.subplots(*size, sharex=True, sharey=True, squeeze=False).flat
        panels[0].set(xticks=[], ylabel="Push in each spring [N]")
        ends = [
            _draw_event(axes, run, event)
            for axes, event in zip(panels, shown.itertuples(), strict=False)
        ]
        if shown.empty:
            panels[0].text(0.4, 0.5, "no slip event")
        else:
            panels[0].set_ylim(0, 1.14 * shown["load_before_N"].max())
            panels[0].legend(loc="upper right", handlelength=1.5, borderaxespad=0.2)
        # Each slip stops within a block of where its push is used up.
        if title is None and (np.abs(shown["front"] - ends) <= 1).all():
            title = FINDING
        if title:
            figure.suptitle(style.plain(title), fontweight="bold", fontsize="medium")
    return figure


def _chosen(slips: pd.DataFrame, events: Sequence[int]) -> pd.DataFrame:
    over = slips[slips["end_s"].notna()]
    rows = np.subtract(events, 1)
    if not set(rows) <= set(over.index):
        raise ValueError(
            f"events must be 1 to {len(over)}, the slips that are over, but are {events}"
        )
    return over.loc[rows]


def _draw_event(axes: Axes, run: Any, event: Any) -> float:
    """Draw an event; return how many blocks have F_X as their kinetic friction."""
    n, load = event.n_blocks, event.load_before_N
    color = style.GLOBAL if event.is_global else style.PARTIAL
    edges = np.linspace(0, 1, n + 1)
    middles = (edges[1:] + edges[:-1]) / 2
    # Each spring reaches from the middle of a block to that of the next.
    springs = np.append(0.0, middles)
    before, after = run.spring_forces([event.onset_s, event.end_s])
    kept = np.minimum(before, after)
    added: Options = {"color": style.pale(color, 0.6), "label": "added by the slip"}
    axes.stairs(kept, springs, **FILL, color=style.PALE, label="push before the slip")
    axes.stairs(after, springs, baseline=kept, **FILL, **added)
    axes.stairs(after, springs, color=style.BLACK, linewidth=0.9)
    carried = run.chain.mu_k * np.append(0.0, np.cumsum(run.chain.weights))
    end = np.interp(load, carried, edges)
    x = np.append(edges[carried < load], end)
    axes.plot(x, load - np.interp(x, edges, carried), **LEFT)
    near: Options = {"textcoords": "offset points"}
    axes.annotate(f"$F_X$ = {load:.3g} N", (0, load), (5, 3), **near)
    left = max(load - carried[-1], 0.0)
    words = f"{left:.2g} N left" if left else "used up"
    arrow = {"arrowstyle": "->", "shrinkB": 2}
    axes.annotate(words, (end, left), (-11, 32), **near, arrowprops=arrow)
    kind = "Global slip" if event.is_global else "Precursor"
    reach = f"stops after block {event.front}" if event.front < n else f"all {n} blocks"
    axes.set_title(f"{kind}: {reach}")
    _draw_row(axes, middles, event.front, color)
    return float(n * end)


def _draw_row(axes: Axes, middles: NDArray[Any], front: int, color: str) -> None:
    """Draw the blocks that slid in colour, and the drive."""
    n = len(middles)
    row = axes.inset_axes(ROW, sharex=axes)
    row.set_axis_off()
    row.set(xlim=ENDS, ylim=(0, 1))
    row.hlines(0.5, DRIVE, middles[-1], color=style.GREY, linewidth=1.6, zorder=0)
    row.plot(DRIVE, 0.5, "o", color=style.BLACK)
    colors = np.where(np.arange(n) < front, color, style.PALE)
    outline: Options = {"edgecolor": style.BLACK, "linewidth": min(0.6, 6 / n)}
    row.bar(middles, 1, SIDE / n, color=colors, **outline)
    for i, x in enumerate(middles if n <= NUMBERED else ()):
        ink = "white" if colors[i] == style.GLOBAL else style.BLACK
        row.text(x, 0.47, str(i + 1), ha="center", va="center", size="small", color=ink)
