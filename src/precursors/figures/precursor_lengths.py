"""Fig. 13: front length of the precursors against the tangential load, for several
runs."""

from collections.abc import Sequence
from itertools import cycle

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import ArrayLike

from precursors.figures import style
from precursors.figures.style import Measured, Options
from precursors.model.chain import FloatArray

HEIGHT_MM = 80.0
LEGEND_MM = 8.0  # height of an entry of a key below the panel
# Marks of scenes (runs) whose curves are named in the key.
OUTLINES = "osD^vh"
# Sizes differ, so that marks stay visible around each other.
SIZES = {-1: 4.2, 0: 5.2, 1: 6.6}
SHORT: Options = {
    "linestyle": "none",
    "marker": "x",
    "markersize": 2.2,
    "markeredgewidth": 0.5,
    "zorder": 1.5,
}
CARRIED: Options = {"linestyle": (0, (4, 3)), "linewidth": 0.8, "zorder": 1.2}
CARRIED_TEXT = r"$F_X = \mu_k W(L_p)$"
SHORT_TEXT = "short events, not counted"
MEASURED: Options = {
    "color": style.MEASURED,
    "linestyle": "none",
    "markersize": 5,
    "zorder": 2.5,
}
MARKERS = "+x^s"  # of measured points
# Name of a curve, share of its events at which the name is placed, alignment, and
# offset [pt].
NAMES: dict[int, tuple[str, float, str, tuple[float, float]]] = {
    -1: ("more load at the\ntrailing edge: {}", 0.0, "left", (28.0, -2.0)),
    0: ("uniform load:\n{} events", 0.0, "left", (-8.0, -4.0)),
    1: ("more load at\nthe leading\nedge: {}", 0.65, "right", (-18.0, 16.0)),
}
# F_X/F_Z is written right of the first global slip, on one line per scene.
LINE_PT = 9.0
END_ROOM = 1.22  # length of the axis of F_X, as a multiple of the largest load
# Shares of the largest load: smallest distance of the first two names, and the room
# that the third needs to its left.
APART = 0.1
ROOM = 0.28
FEW = 12  # with more blocks the first event is too close to the corner


def draw(
    slips: Sequence[pd.DataFrame],
    data: Sequence[Measured] = (),
    title: str = "",
    look: style.Look = style.LOOK,
    weights: ArrayLike | None = None,
) -> Figure:
    """Draw L_p/L of each event against F_X at its onset, up to the first global slip.

    `slips` are slip tables, one per scene; scenes without a slip event are left out.
    `data` are measured lengths L_p/L against the load at the onset [N]. `weights` [N]
    are the normal loads of the blocks; by default they follow from theta.

    Raises
    ------
    ValueError
        If a measured length is not between 0 and 1.
    """
    lengths = np.concatenate([[0.0], *(each.points[:, 1] for each in data)])
    if not ((lengths >= 0) & (lengths <= 1)).all():
        raise ValueError("measured lengths must be L_p/L, between 0 and 1")
    in_place = len(data) == 0 and _are_named_in_place(slips)
    n_lines = 0 if in_place else max(len(data), 1) + len(slips)
    height_mm = HEIGHT_MM + LEGEND_MM * n_lines
    with style.page(style.COLUMN_MM, height_mm, look) as figure:
        axes = figure.subplots()
        axes.set_title(style.plain(title), loc="left", wrap=True)
        labels = [_beside(slips, each) for each in data]
        for each, label, marker in zip(data, labels, cycle(MARKERS), strict=False):
            axes.plot(*each.points.T, **MEASURED, marker=marker, label=label)
        figure.set_label("\n".join(" ".join(label.split()) for label in labels))
        draw_lengths(axes, slips, weights, in_place)
        style.draw_key(figure, ncols=2 if in_place else 1)
    return figure


def draw_lengths(
    axes: Axes,
    slips: Sequence[pd.DataFrame],
    weights: ArrayLike | None = None,
    in_place: bool = True,
) -> None:
    """Draw the events of Fig. 13 in a panel: with names along the curves and F_X/F_Z at
    their ends if `in_place`, otherwise with entries for a key.

    Solid circles mean theta < 0, circles with a dot theta = 0, and open circles theta >
    0. Small crosses are the short events, which Fig. 13 does not count. The dashed line
    is the load that kinetic friction carries up to each length.
    """
    slips = [table for table in slips if len(table)]
    outlines = "o" * len(slips) if in_place else cycle(OUTLINES)
    for table, outline in zip(slips, outlines, strict=False):
        _draw_events(axes, table, outline, in_place)
        length, load = friction_carried(table.iloc[0], weights)
        axes.plot(load, length, **CARRIED, color=style.theta_color(_sign(table)))
        if in_place:
            _name(axes, table[table["counted"]])
    # Measured loads may be negative.
    right = END_ROOM * axes.dataLim.x1 if in_place else None
    axes.set(xlim=(min(0.0, axes.dataLim.x0), right), ylim=(-0.09, 1.08))
    if slips:
        _add_coefficient(axes, pd.concat(slips))
    axes.set_xlabel("Tangential load $F_X$ [N]")
    axes.set_ylabel("Front length $L_p/L$ [-]")
    marks: dict[str, Options] = {}
    if weights is not None or any(table["theta"].notna().any() for table in slips):
        marks[CARRIED_TEXT] = CARRIED
    if any(_is_short(table).any() for table in slips):
        marks[SHORT_TEXT] = SHORT
    for text, look in marks.items():
        axes.plot([], [], **look, color=style.GREY, label=text)


def friction_carried(
    slider: pd.Series, weights: ArrayLike | None = None
) -> tuple[FloatArray, FloatArray]:
    """Return lengths L_p/L and the kinetic friction F_X = mu_k W(L_p) [N] of the blocks
    up to each; without `weights` [N] the loads follow from theta (Eq. 7)."""
    n_blocks = int(slider["n_blocks"])
    n = np.arange(n_blocks + 1)
    if weights is not None:
        load = np.cumsum(np.append(0.0, weights))
    else:
        tilt = slider["theta"] * n * (n - n_blocks) / max(n_blocks - 1, 1)
        load = slider["normal_load_N"] / n_blocks * (n + tilt)
    return n / n_blocks, slider["mu_k"] * load


def _add_coefficient(axes: Axes, slips: pd.DataFrame) -> None:
    """Add an axis of F_X/F_Z and mark mu_k F_Z, if all scenes have the same F_Z and
    mu_k."""
    sliders = slips[["normal_load_N", "mu_k"]].drop_duplicates()
    if len(sliders) == 1:
        ((load, mu_k),) = sliders.to_numpy()
        scale = (lambda force: force / load, lambda coefficient: coefficient * load)
        axes.secondary_xaxis("top", functions=scale).set_xlabel("$F_X/F_Z$ [-]")
        axes.axvline(mu_k * load, **style.DOTTED)
        is_right = 1.1 * mu_k * load < axes.get_xlim()[1]
        axes.annotate(
            r"$\mu_k F_Z$",
            (mu_k * load, 0),
            (3 if is_right else -3, 0),
            textcoords="offset points",
            ha="left" if is_right else "right",
            va="center",
        )


def _beside(slips: Sequence[pd.DataFrame], data: Measured) -> str:
    """Return the name of measured lengths; for a single scene, also their distance from
    the curve through the events of Fig. 13."""
    if len(slips) != 1:
        return data.label
    counted = slips[0][slips[0]["counted"]].sort_values("load_before_N")
    first = counted.loc[counted["is_global"], "load_before_N"].min()
    length = counted["front"] / counted["n_blocks"]
    curve = np.column_stack([counted["load_before_N"], length])
    return data.beside(curve, first, "L")


def _sign(table: pd.DataFrame) -> int:
    return int(np.sign(table["theta"].fillna(0).iloc[0]))


def _are_named_in_place(slips: Sequence[pd.DataFrame]) -> bool:
    """Whether every curve can be named in place: each scene has a theta of its own sign,
    at least four events and a global slip, and the names have room."""
    at = {}
    for table in slips:
        counted = table[table["counted"]]
        has_room = len(counted) >= 4 and (table["n_blocks"] <= FEW).all()
        if not (has_room and counted["is_global"].any()) or table["theta"].hasnans:
            return False
        sign = _sign(table)
        loads = counted["load_before_N"]
        at[sign] = loads.iloc[int(NAMES[sign][1] * len(loads))] / loads.max()
    return (
        len(at) == len(slips)
        and at.get(-1, 1.0) - at.get(0, -1.0) > APART
        and at.get(1, 1.0) > ROOM
    )


def _is_short(slips: pd.DataFrame) -> pd.Series:
    return ~slips["is_global"].cummax() & ~slips["counted"]


def _draw_events(axes: Axes, slips: pd.DataFrame, outline: str, in_place: bool) -> None:
    """Draw the events of a scene."""
    sign = _sign(slips)
    color = style.theta_color(sign)
    points = np.column_stack(
        [slips["load_before_N"], slips["front"] / slips["n_blocks"]]
    )
    axes.plot(*points[_is_short(slips)].T, **SHORT, color=style.pale(color, 0.5))
    counted = points[slips["counted"]]
    axes.plot(
        *counted.T,
        color=color,
        marker=outline,
        markersize=SIZES[sign],
        markerfacecolor=color if sign < 0 else "white",
        markeredgewidth=0.8,
        linewidth=0.5,
        label="_" if in_place else _label(slips),
        # Smaller marks are in front, so that coinciding ones stay visible.
        zorder=2 - 0.1 * sign,
    )
    if sign == 0:
        axes.plot(*counted.T, linestyle="none", marker=".", markersize=2.6, color=color)


def _name(axes: Axes, counted: pd.DataFrame) -> None:
    """Write the name of a curve and its number of events beside it, and F_X/F_Z at its
    end."""
    sign = _sign(counted)
    look: Options = {"textcoords": "offset points", "color": style.theta_color(sign)}
    words, part, side, offset = NAMES[sign]
    loads = counted["load_before_N"].to_numpy()
    i = int(part * len(loads))
    axes.annotate(
        words.format(len(loads)),
        (loads[i], counted["front"].iloc[i] / counted["n_blocks"].iloc[i]),
        offset,
        ha=side,
        va="top",
        fontsize="small",
        fontweight="bold",
        **look,
    )
    ratio = f"{loads[-1] / counted['normal_load_N'].iloc[-1]:.3f}"
    place = (6, LINE_PT * (sign - 1))
    axes.annotate(ratio, (loads[-1], 1), place, va="center", **look)


def _label(slips: pd.DataFrame) -> str:
    """Return the name of a scene with its number of events."""
    first = slips.iloc[0]
    name = style.theta_text(first["theta"])
    slider = f"$N = {first['n_blocks']}$, $F_Z = {first['normal_load_N']:g}$ N"
    n = int(slips["counted"].sum())
    note = "" if slips["is_global"].any() else ", no global slip"
    return f"{name}, {slider}:\n{n} event{'' if n == 1 else 's'}{note}"
