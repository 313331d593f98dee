"""Figs. 10-12, and any other scene: the tangential load over time, the staircase that it
loses, and when and where blocks slipped."""

from collections.abc import Sequence
from itertools import cycle
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from precursors.figures import style
from precursors.figures.style import Measured, Options

HEIGHT_MM = 58.0
CURVE_MM = 62.0  # of the load alone
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
    "color": style.GREY,
    "linewidth": 0.7,
    "linestyle": "--",
    "zorder": 1.5,
    "label": "first global slip",
}
MEAN: Options = {"color": style.BLACK, "linewidth": 0.7, "linestyle": ":"}
TO_THE_EDGE: Options = {
    "color": style.BLACK,
    "linestyle": "none",
    "marker": "o",
    "markersize": 3.2,
    "markerfacecolor": "white",
    "markeredgewidth": 0.7,
    "clip_on": False,
    "label": "reaches the leading edge, but not all at once",
}
LOADS = {"tangential_load_N": "$F_X$ [N]", "K_x1_N": "$K x_1$ [N]"}
STAIRCASE = "$K x_1 = K V t - F_X$: a step for each slip"
MEASURED: Options = {"color": style.MEASURED, "zorder": 1.8}
LINES = ("-", "--", "-.", ":")  # of measured loads
MARKERS = "+x^s"  # of measured front lengths


def draw(
    slips: pd.DataFrame,
    trace: pd.DataFrame,
    title: str = "",
    data: Sequence[Measured] = (),
    look: style.Look = style.LOOK,
) -> Figure:
    """Draw F_X(t) and all slip events, and K x_1 = K V t - F_X, magnified up to the
    first global slip.

    An event that goes on when the run ends is a band. The slip table may be empty; the
    trace is straight between its rows. `data` are measured loads [N], or front lengths
    [m], over time [s].
    """
    width_mm = look.width_mm or style.PAGE_MM
    slips = _with_kinds(slips)
    first_s = slips.loc[slips["is_global"], "onset_s"].min()
    start, end = _span(trace, data)
    ends = [np.fmax(end, ZOOM_END * first_s)]
    views = [list(LOADS)]
    if first_s > 0:
        ends.append(ZOOM_END * first_s)
        views = [[column] for column in LOADS]
    n = len(views)
    heights = [1.3] * len(views[0]) + [1.0]
    rows = n if width_mm < NARROW_MM else 1
    height_mm = HEIGHT_MM * rows + KEY_MM * max(2 * rows - 1, 1 + len(data))
    with style.page(width_mm, height_mm, look) as figure:
        panels = figure.subplots(
            len(heights) * rows, n // rows, squeeze=False, height_ratios=heights * rows
        )
        columns = panels.T.reshape(n, len(heights))
        for axes, view, end in zip(columns, views, ends, strict=True):
            for panel, column in zip(axes, view, strict=False):
                _draw_load(panel, column, slips, trace, end)
            _draw_events(axes[-1], slips[slips["onset_s"] <= end], trace)
            axes[-1].set_xlabel("Time $t$ [s]")
            for panel in axes:
                panel.set_xlim(start, end)
                panel.tick_params(labelbottom=panel is axes[-1])
                if slips["is_global"].any():
                    panel.axvline(first_s, **FIRST_GLOBAL)
        _draw_measured_loads(columns[0][0], data, trace, first_s)
        for axes in columns:
            _draw_measured_lengths(axes[-1], data)
        if n > 1:
            _magnify(columns, first_s, trace)
        figure.align_ylabels()
        columns[0][0].set_title(_title(slips, title), loc="left", pad=4, wrap=True)
        style.draw_key(figure, ncols=int(width_mm / look.font_size / KEY_WIDTH))
    return figure


def draw_curve(
    slips: pd.DataFrame,
    trace: pd.DataFrame,
    title: str = "",
    data: Sequence[Measured] = (),
    look: style.Look = style.LOOK,
) -> Figure:
    """Draw F_X(t) alone, with measured loads [N] over time [s]."""
    first_s = slips.loc[slips["is_global"].astype(bool), "onset_s"].min()
    start, end = _span(trace, data)
    with style.page(style.COLUMN_MM, CURVE_MM, look) as figure:
        axes = figure.subplots()
        _draw_load(axes, "tangential_load_N", slips, trace, end)
        axes.set(xlim=(start, end), xlabel="Time $t$ [s]")
        if first_s > 0:
            axes.axvline(first_s, **FIRST_GLOBAL)
        _draw_measured_loads(axes, data, trace, first_s)
        axes.set_title(_title(slips, title), loc="left", pad=4, wrap=True)
        style.draw_key(figure, ncols=1)
    return figure


def _span(trace: pd.DataFrame, data: Sequence[Measured]) -> tuple[float, float]:
    """The first and last time of a run and of what was measured, [s]."""
    times = np.concatenate(
        [[0.0], trace["time_s"], *(each.points[:, 0] for each in data)]
    )
    return times.min(), times.max()


def _draw_measured_loads(
    axes: Axes, data: Sequence[Measured], trace: pd.DataFrame, first_s: float
) -> None:
    """Draw measured loads; the figure gets lines of text that say how far they are."""
    curve = trace[["time_s", "tangential_load_N"]].to_numpy()
    loads = [each for each in data if not each.are_lengths]
    told = [each.beside(curve, first_s, "N") for each in loads]
    for each, label, line in zip(loads, told, cycle(LINES), strict=False):
        axes.plot(*each.points.T, **MEASURED, linestyle=line, label=label)
    axes.figure.set_label("\n".join(" ".join(label.split()) for label in told))


def _draw_measured_lengths(axes: Axes, data: Sequence[Measured]) -> None:
    lengths = [each for each in data if each.are_lengths]
    for each, marker in zip(lengths, cycle(MARKERS), strict=False):
        times, reached = each.points.T
        mark: Options = {"linestyle": "none", "marker": marker, "zorder": 2.5}
        axes.plot(
            times, style.MM_PER_M * reached, **(MEASURED | mark), label=each.label
        )


def _with_kinds(slips: pd.DataFrame) -> pd.DataFrame:
    """Add what is drawn: the kind of each event, and the length that it reached."""
    slips = slips.astype({"is_global": bool, "counted": bool})
    partial, counted, whole = KINDS
    share = slips["front"] / slips["n_blocks"]
    kind = np.select([slips["is_global"], slips["counted"]], [whole, counted], partial)
    return slips.assign(
        kind=pd.Categorical(kind, list(KINDS)),
        reached_mm=style.MM_PER_M * slips["slider_length_m"] * share,
        is_at_the_edge=~slips["is_global"] & (share == 1),
    )


def _draw_load(
    axes: Axes, column: str, slips: pd.DataFrame, trace: pd.DataFrame, end: float
) -> None:
    """Draw F_X about mu_k F_Z, or the staircase K x_1 with its risers in the colours of
    the events."""
    # One row more: the load goes on to the end of the panel.
    seen = trace[trace["time_s"].shift(fill_value=0.0) <= end]
    axes.plot(seen["time_s"], seen[column], color=style.BLACK, linewidth=0.6)
    axes.set_ylabel(LOADS[column])
    if column == "tangential_load_N":
        for carried in (slips["mu_k"] * slips["normal_load_N"])[:1]:
            axes.axhline(carried, **MEAN)
            place: Any = ("axes fraction", "data")
            axes.annotate(r"$\mu_k F_Z$", (0.02, carried), xycoords=place, va="top")
        return
    axes.annotate(STAIRCASE, (0.02, 0.86), xycoords="axes fraction")
    slips = slips[slips["onset_s"] <= end]
    for kind, events in slips.groupby("kind", observed=True):
        low, high = (
            np.interp(times, trace["time_s"], trace[column])
            for times in (events["onset_s"], events["end_s"].fillna(end))
        )
        axes.vlines(events["onset_s"], low, high, **KINDS[str(kind)])


def _draw_events(axes: Axes, slips: pd.DataFrame, trace: pd.DataFrame) -> None:
    axes.set_ylabel("$L_p$ [mm]")
    if slips.empty:
        axes.annotate("no slip event", (0.4, 0.5), xycoords="axes fraction")
        axes.set_yticks([])
        return
    for kind, events in slips.groupby("kind", observed=True):
        look = KINDS[str(kind)]
        axes.vlines(events["onset_s"], 0, events["reached_mm"], **look, label=str(kind))
        unfinished: Any = events[events["end_s"].isna()].itertuples()
        for event in unfinished:
            axes.fill_between(
                [event.onset_s, trace["time_s"].iloc[-1]],
                event.reached_mm,
                color=style.pale(look["color"], 0.2),
                linewidth=0,
                zorder=0.5,
                label="not over when the run ends",
            )
    edge = slips[slips["is_at_the_edge"]]
    if len(edge):  # an empty line that is not clipped upsets the layout
        axes.plot(edge["onset_s"], edge["reached_mm"], **TO_THE_EDGE)
    axes.set_ylim(0, 1.08 * style.MM_PER_M * slips["slider_length_m"].iloc[0])


def _magnify(columns: Any, first_s: float, trace: pd.DataFrame) -> None:
    """Mark what is magnified, and cut the riser of the global slip, which goes far
    beyond the others."""
    for panel in columns[0]:
        panel.axvspan(0, ZOOM_END * first_s, color=style.PALE, linewidth=0, zorder=0)
    top = np.interp(first_s, trace["time_s"], trace["K_x1_N"])
    columns[1][0].set_ylim(-0.08 * top, 1.3 * top)


def _title(slips: pd.DataFrame, title: str) -> str:
    """The title, with theta and a word where there is no global slip."""
    parts = [style.plain(title)] if title else []
    parts += [style.theta_text(theta) for theta in slips["theta"][:1]]
    note = " (no global slip)" if len(slips) and not slips["is_global"].any() else ""
    return ", ".join(parts) + note
