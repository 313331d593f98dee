"""Figs. 10-12, and any other scene: the tangential load over time, the staircase that it
loses, and when and where blocks slipped."""

from __future__ import annotations

from collections.abc import Mapping
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
from precursors.figures.style import Options

HEIGHT_MM = 74.0
KEY_MM = 8.0
NARROW_MM = 150.0  # below this width the magnified view stands below, not beside
ZOOM_END = 1.04  # of the magnified view, in times of the first global slip
KEY_WIDTH = 7.25  # of a column of the key, in mm per pt of the letters

# What an event is to the reader: its look, from those behind to those in front.
KINDS: dict[str, Options] = {
    "partial slip": {"color": style.GREY, "linewidth": 0.6},
    "partial slip, counted in Fig. 13": {"color": style.PARTIAL, "linewidth": 1.8},
    "global slip": {"color": style.GLOBAL, "linewidth": 1.2},
}
FIRST_GLOBAL: Options = {
    "color": style.BLACK,
    "linewidth": 0.7,
    "linestyle": "--",
    "zorder": 1.5,
}
TO_THE_EDGE: Options = {
    "color": style.BLACK,
    "linestyle": "none",
    "marker": "o",
    "markersize": 3.2,
    "markerfacecolor": "white",
    "markeredgewidth": 0.7,
    "clip_on": False,
}
STAIRCASE = "$K x_1 = K V t - F_X$: a step for each slip"
MEASURED: Options = {"color": style.GREY, "zorder": 1.8, "label": "measured"}


def draw(
    slips: pd.DataFrame,
    trace: pd.DataFrame,
    title: str = "",
    data: NDArray[np.float64] = style.NO_DATA,
    inset: bool = True,
    slider: Mapping[str, Any] | None = None,
    key: bool = True,
    look: style.Look = style.LOOK,
) -> Figure:
    """Draw F_X(t), K x_1 = K V t - F_X and all slip events; with `inset`, all of it
    magnified up to the first global slip.

    An event that goes on when the run ends is a band. The slip table may be empty; the
    trace is straight between its rows. `data`, shape (n, 2), are measured times [s] and
    loads [N]. The parameters of `slider` stand below the title.
    """
    width_mm = look.width_mm or style.PAGE_MM
    slips = _with_kinds(slips)
    first_s = slips.loc[slips["is_global"], "onset_s"].min()
    end_s = trace["time_s"].iloc[-1]
    ends = [np.fmax(end_s, ZOOM_END * first_s)]
    if inset and first_s > 0:
        ends.append(ZOOM_END * first_s)
    n = len(ends)
    is_stacked = n > 1 and width_mm < NARROW_MM
    height_mm = HEIGHT_MM * (1 + is_stacked) + KEY_MM * key * (1 + 2 * is_stacked)
    with style.page(width_mm, height_mm, look) as figure:
        rows = n if is_stacked else 1
        panels = figure.subplots(
            3 * rows, n // rows, squeeze=False, height_ratios=[1.3, 1.3, 1] * rows
        )
        columns = panels.T.reshape(n, 3)
        for axes, end in zip(columns, ends, strict=True):
            _draw_loads(axes, slips, trace, end)
            _draw_events(axes[2], slips[slips["onset_s"] <= end], end_s)
            axes[0].plot(*data.T, **MEASURED)
            axes[2].set_xlabel("Time $t$ [s]")
            for panel in axes:
                panel.set_xlim(0, end)
                panel.tick_params(labelbottom=panel is axes[2])
                if first_s >= 0:
                    panel.axvline(first_s, **FIRST_GLOBAL)
        for forces, stairs, lengths in columns if is_stacked else columns[:1]:
            forces.set_ylabel("$F_X$ [N]")
            stairs.set_ylabel("$K x_1$ [N]")
            lengths.set_ylabel("$L_p$ [mm]")
        figure.align_ylabels()
        if n > 1:
            _magnify(columns, first_s, trace)
        columns[-1][1].annotate(STAIRCASE, (0.02, 0.82), xycoords="axes fraction")
        loads = np.append(trace["tangential_load_N"], data[:, 1])
        _set_load_axis(columns[0][0], loads)
        _number_blocks(columns[-1][2], slips)
        _write_title(columns[0][0], slips, title, slider)
        if key:
            ncols = int(width_mm / (KEY_WIDTH * look.font_size))
            _draw_key(figure, slips, len(data) > 0, max(1, ncols))
    return figure


def _with_kinds(slips: pd.DataFrame) -> pd.DataFrame:
    """Add what is drawn: the kind of each event, and the length that it reached."""
    slips = slips.astype({"is_global": bool, "counted": bool})
    partial, counted, whole = KINDS
    kinds = np.where(slips["counted"], counted, partial)
    share = slips["front"] / slips["n_blocks"]
    return slips.assign(
        kind=np.where(slips["is_global"], whole, kinds),
        reached_mm=style.MM_PER_M * slips["length_m"] * share,
        is_at_the_edge=~slips["is_global"] & (share == 1),
    )


def _draw_loads(
    axes: NDArray[Any], slips: pd.DataFrame, trace: pd.DataFrame, end: float
) -> None:
    """Draw F_X, and the staircase K x_1 with its risers in the colours of the events."""
    seen = trace[trace["time_s"] <= end]
    for panel, column in zip(axes, ("tangential_load_N", "K_x1_N"), strict=False):
        panel.plot(seen["time_s"], seen[column], color=style.BLACK, linewidth=0.6)
    for kind, look in KINDS.items():
        events = slips[(slips["kind"] == kind) & (slips["onset_s"] <= end)]
        low, high = (
            np.interp(times, trace["time_s"], trace["K_x1_N"])
            for times in (events["onset_s"], events["end_s"].fillna(end))
        )
        axes[1].vlines(events["onset_s"], low, high, **look)


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
            axes.fill_between(band, 0, event["reached_mm"], **_unfinished(kind))
    edge = slips[slips["is_at_the_edge"]]
    if len(edge):  # an empty line that is not clipped upsets the layout
        axes.plot(edge["onset_s"], edge["reached_mm"], **TO_THE_EDGE)
    axes.set_ylim(0, 1.08 * style.MM_PER_M * slips["length_m"].iloc[0])


def _unfinished(kind: str) -> Options:
    color = style.pale(KINDS[kind]["color"], 0.2)
    return {"color": color, "linewidth": 0, "zorder": 0.5}


def _magnify(columns: Any, first_s: float, trace: pd.DataFrame) -> None:
    """Mark what is magnified, and cut the riser of the global slip, which goes far
    beyond the others."""
    for panel in columns[0]:
        panel.axvspan(0, ZOOM_END * first_s, color=style.PALE, linewidth=0, zorder=0)
    top = np.interp(first_s, trace["time_s"], trace["K_x1_N"])
    columns[1][1].set_ylim(-0.08 * top, 1.3 * top)


def _set_load_axis(axes: Axes, loads: NDArray[np.float64]) -> None:
    """Let the axis begin and end at a tick, at 0 if no load is below it."""
    locator = MaxNLocator(6, steps=[1, 2, 5, 10])
    ticks = locator.tick_values(min(0.0, loads.min()), loads.max())
    axes.set(yticks=ticks, ylim=(ticks[0], ticks[-1]))


def _number_blocks(axes: Axes, slips: pd.DataFrame) -> None:
    """Number the blocks on an axis beside that of L_p."""
    if slips.empty:
        return
    n = int(slips["n_blocks"].iloc[0])
    block_mm = style.MM_PER_M * slips["length_m"].iloc[0] / n
    blocks = axes.secondary_yaxis(
        "right", functions=(lambda mm: mm / block_mm, lambda i: i * block_mm)
    )
    style.set_ticks(blocks.yaxis, sorted({1, (n + 1) // 2, n}))
    blocks.set_ylabel("Block")


def _write_title(
    axes: Axes, slips: pd.DataFrame, title: str, slider: Mapping[str, Any] | None
) -> None:
    """Write the title, with theta, and the parameters."""
    parts = [style.plain(title)] if title else []
    if slips["theta"].notna().any():
        parts.append(style.theta_text(slips["theta"].iloc[0]))
    elif len(slips):
        parts.append("loads as measured")
    note = " (no global slip)" if len(slips) and not slips["is_global"].any() else ""
    lines = [", ".join(parts) + note, *([parameters(slider)] if slider else [])]
    axes.set_title("\n".join(lines), loc="left", pad=4, wrap=True)


def parameters(slider: Mapping[str, Any]) -> str:
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
    # A line of the title ends between two of them.
    return ", ".join(text.replace(" ", "\N{NO-BREAK SPACE}") for text in texts)


def _draw_key(figure: Figure, slips: pd.DataFrame, has_data: bool, ncols: int) -> None:
    entries: list[Line2D | Patch] = [Line2D([], [], **MEASURED)] if has_data else []
    entries += [style.mark(kind, **look) for kind, look in KINDS.items()]
    text = "reaches the far end, but not all at once"
    entries.append(style.mark(text, **TO_THE_EDGE))
    entries.append(style.mark("first global slip", **FIRST_GLOBAL))
    for kind in slips.loc[slips["end_s"].isna(), "kind"][:1]:
        entries.append(Patch(**_unfinished(kind), label="not over when the run ends"))
    style.draw_key(figure, entries, ncols)
