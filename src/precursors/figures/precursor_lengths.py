"""Fig. 13: propagation length of the precursors against the tangential load, for
several loadings."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from itertools import repeat
from textwrap import fill
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.legend_handler import HandlerTuple
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from precursors.figures import style

HEIGHT_MM = 76.0
# A key with larger letters than these has no room among the marks and stands below
# them, which takes so much.
LETTERS_PT_PER_MM = 0.1
KEY_MM = 16.0
# The filling tells the sign of theta, as in the paper; a second scene of the same sign
# has another outline.
OUTLINES = "osD^vh"
# All scenes meet at the global slip: circles of different size stay visible around each
# other.
SIZES = {-1: 4.2, 0: 5.2, 1: 6.6}
SHORT: dict[str, Any] = {
    "linestyle": "none",
    "marker": "x",
    "markersize": 2.5,
    "alpha": 0.5,
}
SHORT |= {"markeredgewidth": 0.6}
MEASURED: dict[str, Any] = {
    "linestyle": "none",
    "marker": "+",
    "markersize": 5.0,
    "color": style.ORANGE,
}


def draw(
    slips: Sequence[pd.DataFrame],
    mu_sapp: pd.DataFrame | None = None,
    scenes: Sequence[str] = (),
    data: NDArray[np.float64] | None = None,
    title: str | None = None,
    printed: Sequence[int | None] = (),
    look: style.Look | None = None,
) -> Figure:
    """Draw L_p/L against F_X at the onset, up to and including the first global slip.

    Solid circles are theta < 0, circles with a dot theta = 0, and open circles theta >
    0. Small crosses are the short events, which Fig. 13 does not count. A scene without
    a slip event is left out.

    A line marks the mean of these `scenes` of mu_sapp.csv, if all have the same normal
    load. `data`, shape (n, 2), are measured loads at the onset [N] and lengths L_p/L.
    `printed` has the paper's number of events for each table of `slips`.

    Raises
    ------
    ValueError
        If a measured length is not between 0 and 1.
    """
    pairs = zip(slips, printed or [None] * len(slips), strict=True)
    counts = [count for table, count in pairs if len(table)]
    slips = [table for table in slips if len(table)]
    look = look or style.Look()
    if data is not None and not ((data[:, 1] >= 0) & (data[:, 1] <= 1)).all():
        raise ValueError("measured lengths must be L_p/L, between 0 and 1")
    is_crowded = look.font_size > LETTERS_PT_PER_MM * (look.width_mm or style.COLUMN_MM)
    with style.page(
        style.COLUMN_MM, HEIGHT_MM + KEY_MM * is_crowded, look=look
    ) as figure:
        axes = figure.subplots()
        axes.set_title(fill(style.plain(title or ""), 48), loc="left")
        signs = [int(np.sign(table["theta"].fillna(0).iloc[0])) for table in slips]
        outlines = [
            OUTLINES[signs[:i].count(sign) % len(OUTLINES)]
            for i, sign in enumerate(signs)
        ]
        entries: list[Any] = list(
            map(_draw_events, repeat(axes), slips, signs, outlines)
        )
        labels = [
            _label(table, slips, count)
            for table, count in zip(slips, counts, strict=True)
        ]
        if any(len(_short_events(table)) for table in slips):
            entries.append((Line2D([], [], **SHORT, color=style.GREY),))
            labels.append("short events, not counted")
        if data is not None:
            entries.append(tuple(axes.plot(*data.T, **MEASURED)))
            labels.append("measured")
        axes.set(xlim=(0, None), ylim=(0, 1.06))
        axes.set_xlabel("Tangential load $F_X$ [N]")
        axes.set_ylabel("Propagation length $L_p/L$ [-]")
        normal_loads = [table["normal_load_N"].iloc[0] for table in slips]
        if len(set(normal_loads)) == 1:
            _draw_friction_coefficient(
                axes, normal_loads[0], mu_sapp, scenes, look.small
            )
        how: dict[str, Any] = {
            "loc": "outside lower center" if is_crowded else "best",
            "handlelength": 1,
        }
        how["handler_map"] = {tuple: HandlerTuple(ndivide=1)}
        (figure if is_crowded else axes).legend(entries, labels, **how)
    return figure


def _draw_events(
    axes: Axes, slips: pd.DataFrame, sign: int, outline: str
) -> tuple[Line2D, ...]:
    """Draw the events of a scene, whose theta has a sign; return the marks for the
    key."""
    color = style.theta_color(sign)
    short = _short_events(slips)
    axes.plot(
        short["load_before_N"],
        short["front"] / short["n_blocks"],
        **SHORT,
        color=color,
        zorder=1.5,
    )
    counted = slips[slips["counted"]]
    points = counted["load_before_N"], counted["front"] / counted["n_blocks"]
    look: dict[str, Any] = {"linestyle": "none", "color": color, "markeredgewidth": 0.8}
    fill = color if sign < 0 else "none"
    drawn = axes.plot(
        *points, marker=outline, markersize=SIZES[sign], markerfacecolor=fill, **look
    )
    if sign == 0:
        drawn += axes.plot(*points, marker=".", markersize=0.5 * SIZES[sign], **look)
    return tuple(drawn)


def _short_events(slips: pd.DataFrame) -> pd.DataFrame:
    """Events before the first global slip that Fig. 13 does not count."""
    return slips[~slips["is_global"].cummax() & ~slips["counted"]]


def _label(
    slips: pd.DataFrame, others: Sequence[pd.DataFrame], printed: int | None
) -> str:
    first = slips.iloc[0]
    name = (
        style.theta_text(first["theta"])
        if pd.notna(first["theta"])
        else "loads as measured"
    )
    for column, text in (
        ("n_blocks", ", $N = {:g}$"),
        ("normal_load_N", ", $F_Z = {:g}$ N"),
    ):
        if len({table[column].iloc[0] for table in others}) > 1:
            name += text.format(first[column])
    n = int(slips["counted"].sum())
    note = "" if slips["is_global"].any() else ", no global slip"
    paper = "" if printed is None else f" (paper: {printed})"
    return f"{name}: {n} event{'' if n == 1 else 's'}{paper}{note}"


def _draw_friction_coefficient(
    axes: Axes,
    normal_load: float,
    mu_sapp: pd.DataFrame | None,
    scenes: Sequence[str],
    font_size: float,
) -> None:
    """Draw F_X/F_Z as upper axis, and the mean apparent static friction coefficient
    (Eq. 1) as a line."""
    scale = partial(np.multiply, 1 / normal_load), partial(np.multiply, normal_load)
    axes.secondary_xaxis("top", functions=scale).set_xlabel(
        "Friction coefficient $F_X/F_Z$ [-]"
    )
    if mu_sapp is None:
        return
    values = mu_sapp.loc[
        mu_sapp["is_papers"] & mu_sapp["scene"].isin(scenes), "mu_sapp"
    ]
    if values.empty:
        return
    load = values.mean() * normal_load
    axes.axvline(load, **style.DOTTED)
    axes.annotate(
        ("mean " if len(values) > 1 else "")
        + rf"$\mu_\mathrm{{sapp}} = {values.mean():.3f}$",
        xy=(load, 0.6),
        xytext=(2, 0),
        textcoords="offset points",
        rotation=90,
        va="center",
        fontsize=font_size,
        color=style.GREY,
    )
