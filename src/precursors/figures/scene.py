"""Figs. 10-12 and similar scenes: the tangential load over time, magnified around the
first global slip, and the slip events with their lengths."""

from collections.abc import Sequence
from itertools import cycle
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from precursors.figures import style
from precursors.figures.style import Measured, Options

HEIGHT_MM = 48.0
CURVE_MM = 62.0  # of the load alone
KEY_MM = 11.4
MEASURED_MM = 9.0  # height of an entry of the key for measured data
NARROW_MM = 150.0  # in narrower figures the magnified view is below, not beside
# The magnified view, as multiples of the time of the first global slip.
ZOOM = (0.66, 1.03)
KEY_WIDTH = 7.25  # of a column of the key, in mm per pt of font size

# Kinds of events and their looks; later ones are drawn in front.
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
    "label": "reaches the leading edge, but not all at once",
}
MAGNIFIED = "Grey part, magnified; arrows: precursors counted"
ARROW: Options = {
    "arrowstyle": "-|>,head_length=0.25,head_width=0.12",
    "color": style.PARTIAL,
    "linewidth": 0.8,
    "shrinkA": 0,
    "shrinkB": 2,
}
MEASURED: Options = {"color": style.MEASURED, "zorder": 1.8}
LOAD = ["time_s", "tangential_load_N"]
LINES = ("-", "--", "-.", ":")  # of measured loads
MARKERS = "+x^s"  # of measured front lengths


def draw(
    slips: pd.DataFrame,
    trace: pd.DataFrame,
    title: str = "",
    data: Sequence[Measured] = (),
    look: style.Look = style.LOOK,
    has_key: bool = True,
) -> Figure:
    """Draw F_X(t) and all slip events, and F_X magnified around the first global slip,
    with arrows at the events counted before it.

    An event that is not over when the run ends is drawn as a band. The slip table may
    be empty. The trace is linear between its rows. `data` are measured loads [N] or
    front lengths [m] over time [s]. Of several figures on a page, one needs a key.
    """
    width_mm = look.width_mm or style.PAGE_MM
    slips = _with_kinds(slips)
    first_s = slips.loc[slips["is_global"], "onset_s"].min()
    start, end = _span(trace, data)
    end = np.fmax(end, ZOOM[1] * first_s)
    is_narrow = width_mm < NARROW_MM
    height_mm = HEIGHT_MM * (1 + 1.2 * is_narrow) + MEASURED_MM * len(data)
    height_mm += KEY_MM * (1 + is_narrow) * has_key
    with style.page(width_mm, height_mm, look) as figure:
        # L is the load, F the fronts, I the magnified view.
        layout = "LI;FI"
        if not first_s > 0:
            layout = "L;F"
        elif is_narrow:
            layout = "L;F;I"
        ratios = [1.6, 1.0, 1.6][: 1 + layout.count(";")]
        panels = figure.subplot_mosaic(layout, height_ratios=ratios)
        load, fronts = panels["L"], panels["F"]
        _draw_load(load, slips, trace, end)
        _draw_events(fronts, slips, trace)
        for panel in (load, fronts):
            panel.set_xlim(start, end)
            if slips["is_global"].any():
                panel.axvline(first_s, **FIRST_GLOBAL)
        load.tick_params(labelbottom=False)
        fronts.set_xlabel("Time $t$ [s]")
        _draw_measured_loads(load, data, trace, first_s)
        _draw_measured_lengths(fronts, data)
        if "I" in panels:
            view = (ZOOM[0] * first_s, ZOOM[1] * first_s)
            for panel in (load, fronts):
                panel.axvspan(*view, color=style.PALE, lw=0, zorder=0)
            _draw_inset(panels["I"], slips, trace, view)
            for each, line in zip(_loads(data), cycle(LINES), strict=False):
                # Points outside the view would stretch its axis of F_X.
                seen = each.points[_within(each.points[:, 0], view)]
                panels["I"].plot(*seen.T, **MEASURED, linestyle=line)
        figure.align_ylabels()
        load.set_title(_title(slips, title), loc="left", pad=4, wrap=True)
        if has_key:
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
        _draw_load(axes, slips, trace, end)
        axes.set(xlim=(start, end), xlabel="Time $t$ [s]")
        if first_s > 0:
            axes.axvline(first_s, **FIRST_GLOBAL)
        _draw_measured_loads(axes, data, trace, first_s)
        axes.set_title(_title(slips, title), loc="left", pad=4, wrap=True)
        style.draw_key(figure, ncols=1)
    return figure


def _span(trace: pd.DataFrame, data: Sequence[Measured]) -> tuple[float, float]:
    """Return the first and last time of the run and the measured data [s]."""
    times = np.concatenate(
        [[0.0], trace["time_s"], *(each.points[:, 0] for each in data)]
    )
    return times.min(), times.max()


def _draw_measured_loads(
    axes: Axes, data: Sequence[Measured], trace: pd.DataFrame, first_s: float
) -> None:
    """Draw measured loads; the label of the figure states their distances from the
    run."""
    curve = trace[LOAD].to_numpy()
    loads = _loads(data)
    labels = [each.beside(curve, first_s, "N") for each in loads]
    for each, label, line in zip(loads, labels, cycle(LINES), strict=False):
        axes.plot(*each.points.T, **MEASURED, linestyle=line, label=label)
    axes.figure.set_label("\n".join(" ".join(label.split()) for label in labels))


def _loads(data: Sequence[Measured]) -> list[Measured]:
    return [each for each in data if not each.are_lengths]


def _draw_measured_lengths(axes: Axes, data: Sequence[Measured]) -> None:
    lengths = [each for each in data if each.are_lengths]
    for each, marker in zip(lengths, cycle(MARKERS), strict=False):
        times, reached = each.points.T
        mark: Options = {"linestyle": "none", "marker": marker, "zorder": 2.5}
        axes.plot(
            times, style.MM_PER_M * reached, **(MEASURED | mark), label=each.label
        )


def _with_kinds(slips: pd.DataFrame) -> pd.DataFrame:
    """Add the kind of each event and the length that it reached."""
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
    axes: Axes, slips: pd.DataFrame, trace: pd.DataFrame, end: float
) -> None:
    """Draw F_X and the line mu_k F_Z."""
    # One row beyond the panel, so that the curve reaches its edge.
    seen = trace[trace["time_s"].shift(fill_value=0.0) <= end]
    axes.plot(*seen[LOAD].to_numpy().T, color=style.BLACK, linewidth=0.6)
    axes.set_ylabel("$F_X$ [N]")
    for carried in (slips["mu_k"] * slips["normal_load_N"])[:1]:
        axes.axhline(carried, **MEAN)
        place: Any = ("axes fraction", "data")
        axes.annotate(r"$\mu_k F_Z$", (0.02, carried), xycoords=place, va="top")


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
    # Drawn even if empty, to be in every key; then it must be clipped for the layout.
    points = edge[["onset_s", "reached_mm"]].to_numpy().T
    axes.plot(*points, **TO_THE_EDGE, clip_on=edge.empty)
    axes.set_ylim(0, 1.08 * style.MM_PER_M * slips["slider_length_m"].iloc[0])


def _draw_inset(
    axes: Axes, slips: pd.DataFrame, trace: pd.DataFrame, view: tuple[float, float]
) -> None:
    """Draw F_X around the first global slip, with the load drop of each event and arrows
    at the counted ones."""
    start, end = view
    at_ends = np.interp(view, *trace[LOAD].to_numpy().T)
    inside = trace[_within(trace["time_s"], view)]
    ends = pd.DataFrame(dict(zip(LOAD, (view, at_ends), strict=True)))
    _draw_load(axes, slips, pd.concat([ends[:1], inside, ends[1:]]), end)
    axes.margins(y=0.1)
    axes.set_xlim(start, end)
    # A tick at the edge would make this panel narrower than those of other scenes.
    ticks = axes.get_xticks()
    axes.set_xticks(ticks[(ticks >= start) & (ticks < end - 0.02 * (end - start))])
    axes.set_title(MAGNIFIED, loc="left", pad=4, wrap=True)
    axes.set_xlabel("Time $t$ [s]")
    seen = slips[_within(slips["onset_s"], view)]
    for kind, events in seen.groupby("kind", observed=True):
        drops = events[["onset_s", "load_after_N", "load_before_N"]].to_numpy().T
        axes.vlines(*drops, **KINDS[str(kind)])
    counted: Any = seen[seen["counted"] & ~seen["is_global"]].itertuples()
    for event in counted:
        point = (event.onset_s, event.load_before_N)
        axes.annotate("", point, (0, 12), textcoords="offset points", arrowprops=ARROW)


def _within(times: Any, view: tuple[float, float]) -> Any:
    """Whether each time is in the magnified view."""
    return (times >= view[0]) & (times <= view[1])


def _title(slips: pd.DataFrame, title: str) -> str:
    """Return the title with theta, and a note if there is no global slip."""
    parts = [style.plain(title)] if title else []
    parts += [style.theta_text(theta) for theta in slips["theta"][:1]]
    note = " (no global slip)" if len(slips) and not slips["is_global"].any() else ""
    return ", ".join(parts) + note
