"""Figs. 10-12, and any other scene: the tangential load over time, the staircase that it
loses, and when and where blocks slipped."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
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

HEIGHT_MM = 74.0
KEY_MM = 8.0
NARROW_MM = 120.0  # below this width the magnified view stands below, not beside
ZOOM_END = 1.04  # of the magnified view, in times of the first global slip
ZOOMED = 1.1  # nothing that ends later is magnified
CHARACTERS_PER_MM = 0.56  # of a title of 8 pt

# What an event is to the reader: its look, from those behind to those in front.
KINDS: dict[str, dict[str, Any]] = {
    "partial slip": {"color": style.GREY, "linewidth": 0.6},
    "partial slip, counted in Fig. 13": {"color": style.PARTIAL, "linewidth": 1.8},
    "global slip": {"color": style.GLOBAL, "linewidth": 1.2},
}
FIRST_GLOBAL: dict[str, Any] = {
    "color": style.BLACK,
    "linewidth": 0.7,
    "linestyle": (0, (5, 4)),
    "zorder": 1.5,
}
TO_THE_EDGE: dict[str, Any] = {
    "color": style.BLACK,
    "linestyle": "none",
    "marker": "o",
    "markersize": 3.2,
    "markerfacecolor": "white",
    "markeredgewidth": 0.7,
    "clip_on": False,
}
STAIRCASE = "$K x_1 = K V t - F_X$: a step for each slip"
MEASURED: dict[str, Any] = {"color": style.GREY, "zorder": 1.8, "label": "measured"}
UNFINISHED: dict[str, Any] = {"alpha": 0.2, "linewidth": 0}


def draw(
    slips: pd.DataFrame,
    trace: pd.DataFrame,
    title: str = "",
    others: Sequence[pd.DataFrame] = (),
    data: NDArray[np.float64] | None = None,
    inset: bool = True,
    slider: Mapping[str, Any] | None = None,
    key: bool = True,
    look: style.Look | None = None,
) -> Figure:
    """Draw F_X(t), K x_1 = K V t - F_X and all slip events; with `inset`, all of it
    magnified up to the first global slip.

    An event that goes on when the run ends is a band. The slip table may be empty; the
    trace is straight between its rows. The load axis holds the traces of `others` as
    well. `data`, shape (n, 2), are measured times [s] and loads [N]. The parameters of
    `slider` stand below the title.
    """
    look = look or style.Look()
    width_mm = look.width_mm or style.PAGE_MM
    slips = _with_kinds(slips)
    first_s = slips.loc[slips["is_global"], "onset_s"].min()
    end = float(trace["time_s"].iloc[-1])
    spans = [(0.0, max(end, ZOOM_END * first_s))]
    if inset and first_s > 0:
        spans.append((0.0, ZOOM_END * first_s))
    stacked = len(spans) > 1 and width_mm < NARROW_MM
    height_mm = HEIGHT_MM * (1 + stacked) + KEY_MM * key * (1 + 2 * stacked)
    with style.page(width_mm, height_mm, look=look) as figure:
        columns = _panels(figure, len(spans), stacked)
        for axes, span in zip(columns, spans, strict=True):
            _draw_loads(axes, slips, trace, span)
            _draw_events(axes[2], slips[slips["onset_s"].between(*span)], end)
            axes[2].set(xlim=span, xlabel="Time $t$ [s]")
            if data is not None:
                axes[0].plot(*data.T, **MEASURED)
            for panel in axes if first_s >= 0 else ():
                panel.axvline(first_s, **FIRST_GLOBAL)
        for axes in columns if stacked else columns[:1]:
            _label(figure, axes)
        for panel in columns[0] if len(spans) > 1 else ():
            panel.axvspan(*spans[1], color=style.PALE, linewidth=0, zorder=0)
        columns[-1][1].annotate(STAIRCASE, (0.02, 0.82), xycoords="axes fraction")
        _set_load_axis(columns[0][0], (trace, *others), data)
        _number_blocks(columns[-1][2], slips)
        _write_title(columns[0][0], slips, title, slider, width_mm / look.font_size)
        if key:
            _draw_key(figure, slips, data is not None, width_mm / look.font_size)
    return figure


def _label(figure: Figure, axes: Sequence[Axes]) -> None:
    for panel, words in zip(
        axes, ("$F_X$ [N]", "$K x_1$ [N]", "$L_p$ [mm]"), strict=True
    ):
        panel.set_ylabel(words)
    figure.align_ylabels(axes)


def _with_kinds(slips: pd.DataFrame) -> pd.DataFrame:
    """Add what is drawn: the kind of each event, and the length that it reached."""
    slips = slips.astype({"is_global": bool, "counted": bool})
    partial, counted, whole = KINDS
    kinds = np.where(slips["counted"], counted, partial)
    return slips.assign(
        kind=np.where(slips["is_global"], whole, kinds),
        reached_mm=style.MM_PER_M
        * slips["length_m"]
        * slips["front"]
        / slips["n_blocks"],
        is_at_the_edge=~slips["is_global"] & (slips["front"] == slips["n_blocks"]),
    )


def _panels(figure: Figure, n: int, stacked: bool) -> list[tuple[Axes, ...]]:
    """Three panels over the same time, n times beside or below each other."""
    rows, columns = (3 * n, 1) if stacked else (3, n)
    grid = figure.add_gridspec(rows, columns, height_ratios=[1.3, 1.3, 1] * (rows // 3))
    found = []
    for i in range(n):
        cells = [grid[3 * i + k, 0] if stacked else grid[k, i] for k in range(3)]
        lower = figure.add_subplot(cells[2])
        upper = [figure.add_subplot(cell, sharex=lower) for cell in cells[:2]]
        for axes in upper:
            axes.tick_params(labelbottom=False)
        found.append((*upper, lower))
    return found


def _draw_loads(
    axes: Sequence[Axes],
    slips: pd.DataFrame,
    trace: pd.DataFrame,
    span: tuple[float, float],
) -> None:
    """Draw F_X, and the staircase K x_1 with its risers in the colours of the events."""
    seen = trace[trace["time_s"] <= span[1]]
    for panel, column in zip(axes, ("tangential_load_N", "K_x1_N"), strict=False):
        panel.plot(seen["time_s"], seen[column], color=style.BLACK, linewidth=0.6)
    for kind, look in KINDS.items():
        events = slips[(slips["kind"] == kind) & slips["onset_s"].between(*span)]
        ends = events["end_s"].fillna(span[1])
        low, high = (
            np.interp(times, trace["time_s"], trace["K_x1_N"])
            for times in (events["onset_s"], ends)
        )
        axes[1].vlines(events["onset_s"], low, high, **look)
    before = slips.loc[slips["is_global"], "onset_s"].min()
    if span[0] < before < span[1] < ZOOMED * before:
        top = np.interp(before, trace["time_s"], trace["K_x1_N"])
        axes[1].set_ylim(-0.08 * top, 1.3 * top)  # the global slip goes far beyond


def _draw_events(axes: Axes, slips: pd.DataFrame, end_s: float) -> None:
    if slips.empty:
        axes.annotate("no slip event", (0.4, 0.5), xycoords="axes fraction")
        axes.set_yticks([])
        return
    for kind, look in KINDS.items():
        events = slips[slips["kind"] == kind]
        axes.vlines(events["onset_s"], 0, events["reached_mm"], **look)
        for _, event in events[events["end_s"].isna()].iterrows():
            band = [event["onset_s"], end_s]
            color = look["color"]
            axes.fill_between(band, 0, event["reached_mm"], color=color, **UNFINISHED)
    edge = slips[slips["is_at_the_edge"]]
    if len(edge):  # an empty line that is not clipped upsets the layout
        axes.plot(edge["onset_s"], edge["reached_mm"], **TO_THE_EDGE)
    axes.set_ylim(0, 1.08 * style.MM_PER_M * slips["length_m"].iloc[0])


def _set_load_axis(
    axes: Axes, traces: Sequence[pd.DataFrame], data: NDArray[np.float64] | None
) -> None:
    """From zero, or below it if need be, to the next tick."""
    loads = np.concatenate([table["tangential_load_N"] for table in traces])
    if data is not None:
        loads = np.append(loads, data[:, 1])
    locator = MaxNLocator(6, steps=[1, 2, 5, 10])
    lowest = min(0.0, loads.min())
    axes.yaxis.set_major_locator(locator)
    highest = locator.tick_values(lowest, max(loads.max(), lowest + 1e-9))[-1]
    axes.set_ylim(lowest, highest)


def _number_blocks(axes: Axes, slips: pd.DataFrame) -> None:
    """Number the blocks on an axis beside that of L_p."""
    if slips.empty:
        return
    block_mm = style.MM_PER_M * slips["length_m"].iloc[0] / slips["n_blocks"].iloc[0]
    # An EPS is drawn from a copy, and lambdas cannot be copied.
    scale = partial(np.multiply, 1 / block_mm), partial(np.multiply, block_mm)
    blocks = axes.secondary_yaxis("right", functions=scale)
    n = int(slips["n_blocks"].iloc[0])
    style.set_ticks(blocks.yaxis, sorted({1, (n + 1) // 2, n}))
    blocks.set_ylabel("Block")


def _write_title(
    axes: Axes,
    slips: pd.DataFrame,
    title: str,
    slider: Mapping[str, Any] | None,
    width: float,
) -> None:
    """Write the title, with theta, and the parameters; `width` is in mm per pt."""
    parts = [style.plain(title)] if title else []
    if slips["theta"].notna().any():
        parts.append(style.theta_text(slips["theta"].iloc[0]))
    elif len(slips):
        parts.append("loads as measured")
    note = " (no global slip)" if len(slips) and not slips["is_global"].any() else ""
    text = fill(", ".join(parts) + note, max(20, int(8 * CHARACTERS_PER_MM * width)))
    lines = [text, *parameters(slider, 8 if width > 15 else 3)] if slider else [text]
    axes.set_title("\n".join(lines), loc="left", pad=4)


def parameters(slider: Mapping[str, Any], in_a_line: int) -> list[str]:
    """The parameters in the caption of Fig. 10 of the paper, from those of a slider."""
    n = slider["n_blocks"]
    spring = n * slider["youngs_modulus"] * slider["cross_section"] / slider["length"]
    values = {
        "N": f"{n}",
        r"\mu_s": f"{slider['mu_s']:g}",
        r"\mu_k": f"{slider['mu_k']:g}",
        "F_Z": f"{slider['normal_load']:g} N",
        "K": f"{slider['drive_stiffness'] / 1e6:g} MN/m",
        "V": f"{slider['drive_velocity'] * style.MM_PER_M:g} mm/s",
        "m": f"{slider['slider_mass'] / n * 1e3:g} g",
        "k": f"{spring / 1e6:g} MN/m",
    }
    texts = [f"${name}$ = {value}" for name, value in values.items()]
    return [
        ", ".join(texts[i : i + in_a_line]) for i in range(0, len(texts), in_a_line)
    ]


def _draw_key(
    figure: Figure, slips: pd.DataFrame, has_data: bool, width: float
) -> None:
    entries: list[Line2D | Patch] = [Line2D([], [], **MEASURED)] if has_data else []
    entries += [style.mark(kind, **look) for kind, look in KINDS.items()]
    text = "reaches the far end, but not all at once"
    entries.append(style.mark(text, **TO_THE_EDGE))
    entries.append(style.mark("first global slip", **FIRST_GLOBAL))
    for kind in slips.loc[slips["end_s"].isna(), "kind"][:1]:
        look = {**UNFINISHED, "color": KINDS[kind]["color"]}
        entries.append(Patch(**look, label="not over when the run ends"))
    columns = max(1, min(len(entries), int(8 * width / 58)))
    style.draw_key(figure, entries, ncols=columns)
