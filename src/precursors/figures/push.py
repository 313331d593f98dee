"""The push (spring force) along the row: what a slip adds and releases, and how far
it can reach."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from precursors.figures import style
from precursors.figures.style import Options
from precursors.figures.wave import middle_last_and_global
from precursors.model.chain import FloatArray

HEIGHT_MM = 70.0  # of a row of panels
NARROW_MM = 120.0  # below this width the panels stand below each other
FINDING = "The farthest slips stop where friction has used up the push"
RELEASED: Options = {"facecolor": style.pale(style.GREY, 0.45), "label": "released"}
LEFT: Options = {
    "color": style.BLACK,
    "linestyle": "--",
    "linewidth": 1.0,
    "label": "what kinetic friction leaves of $F_X$",
}
# Position of the row of blocks below a panel, in units of the panel; then places of the
# drive and of both ends, in units of the row.
ROW = (0.0, -0.16, 1.0, 0.13)
DRIVE = -0.1
ENDS = (-0.14, 1.1)
SIDE = 0.84  # of a block, as a share of the distance between blocks
NUMBERED = 12  # with more blocks, their numbers are omitted
APART = 40  # with more blocks, they are drawn without gaps


def draw(
    run: Any,
    slips: pd.DataFrame,
    events: Sequence[int] = (),
    title: str | None = None,
    look: style.Look = style.LOOK,
) -> Figure:
    """Draw the push in each spring before and after some events, one panel per event.

    A dashed line shows what kinetic friction leaves of the load at the onset, F_X -
    mu_k W(x). `run` is a `Run`. `events` are numbers of rows of the slip table, from 1;
    by default a precursor, the longest one and the first global slip.

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
        beyond = [
            _draw_event(axes, run, event)
            for axes, event in zip(panels, shown.itertuples(), strict=False)
        ]
        if shown.empty:
            panels[0].text(0.4, 0.5, "no slip event")
        else:
            panels[0].set_ylim(0, 1.12 * shown["load_before_N"].max())
            marks, _ = panels[0].get_legend_handles_labels()
            style.draw_key(figure, marks, ncols=int(is_narrow))
        is_farthest = slips["front"] > slips["front"].cummax().shift(fill_value=0)
        of_farthest = np.abs(beyond)[is_farthest[shown.index] & ~shown["is_global"]]
        if title is None and of_farthest.size and (of_farthest <= 1).all():
            title = FINDING
        if title:
            figure.suptitle(style.plain(title), fontweight="bold", fontsize="medium")
    return figure


def _chosen(slips: pd.DataFrame, events: Sequence[int]) -> pd.DataFrame:
    over = slips[slips["end_s"].notna()]
    rows = np.subtract(events, 1)
    if not set(rows) <= set(over.index):
        raise ValueError(
            f"events must be 1 to {len(over)}, those that end within the run, but are {events}"
        )
    return over.loc[rows]


def _draw_event(axes: Axes, run: Any, event: Any) -> float:
    """Draw an event; return by how many blocks it passes the point at which its push is
    used up."""
    n, load = event.n_blocks, event.load_before_N
    color = style.GLOBAL if event.is_global else style.PARTIAL
    added: Options = {
        "facecolor": style.pale(color, 0.6),
        "label": "added by the slip",
    }
    edges = np.linspace(0, 1, n + 1)
    middles = (edges[1:] + edges[:-1]) / 2
    # Each spring reaches from the middle of one block to the middle of the next.
    springs = np.append(0.0, middles)
    before, after = run.spring_forces([event.onset_s, event.end_s])
    for top, fill in ((after, added), (before, RELEASED)):
        low = np.minimum(before, after)
        axes.stairs(np.maximum(top, low), springs, baseline=low, fill=True, **fill)
    thin = min(1.0, APART / n)
    for push, label, width in (before, "push before", 0.6), (after, "after", 1.5):
        axes.stairs(
            push, springs, color=style.BLACK, linewidth=thin * width, label=label
        )
    carried = run.chain.mu_k * np.append(0.0, np.cumsum(run.chain.weights))
    end = np.interp(load, carried, edges)
    x = np.append(edges[carried < load], end)
    axes.plot(x, load - np.interp(x, edges, carried), **LEFT)
    words = f"$F_X$ = {load:.3g} N"
    axes.annotate(words, (0, load), (3, 3), textcoords="offset points")
    beyond = float(event.front - n * end)
    axes.set_title(_reason(run, event, beyond, load - carried[-1], after))
    _draw_row(axes, middles, event.front, color)
    return beyond


def _reason(run: Any, event: Any, beyond: float, left: float, after: FloatArray) -> str:
    """Describe where and why the slip stops, in two lines; `left` [N] is the load left
    after the last block, and `after` [N] the push in each spring."""
    if event.is_global:
        push = f"{left:.2g} N of the push are not" if left > 0 else "the push is"
        return f"Global slip: the row goes,\n{push} used up"
    front = event.front
    goes = f"stops after block {front}" if front < event.n_blocks else "goes to the end"
    where = f"Precursor: {goes}"
    if beyond > 1:
        return f"{where},\nbeyond where the push is used up"
    if beyond >= -1:
        return f"{where},\nwhere the push is used up"
    onto_next = after[front] - np.append(after, 0.0)[front + 1]
    most = run.chain.mu_s * run.chain.weights[front]
    return (
        f"Precursor: stops early, after block {front};\n"
        f"block {front + 1} bears {onto_next:.3g} N and holds {most:.3g} N"
    )


def _draw_row(axes: Axes, middles: FloatArray, front: int, color: str) -> None:
    """Draw the drive and the blocks; those that slid are coloured."""
    n = len(middles)
    row = axes.inset_axes(ROW, sharex=axes)
    row.set_axis_off()
    row.set(xlim=ENDS, ylim=(0, 1))
    row.hlines(0.5, DRIVE, middles[-1], color=style.GREY, linewidth=1.6, zorder=0)
    row.plot(DRIVE, 0.5, "o", color=style.BLACK)
    colors = np.where(np.arange(n) < front, color, style.PALE)
    if n > APART:
        row.bar(middles, 1, 1 / n, color=colors, edgecolor=colors, linewidth=0.3)
    else:
        outline: Options = {"edgecolor": style.BLACK, "linewidth": min(0.6, 6 / n)}
        row.bar(middles, 1, SIDE / n, color=colors, **outline)
    for i, x in enumerate(middles if n <= NUMBERED else ()):
        ink = "white" if colors[i] == style.GLOBAL else style.BLACK
        row.text(x, 0.47, str(i + 1), ha="center", va="center", size="small", color=ink)
