"""Fig. 13: propagation length of the precursors against the tangential load, for several loadings."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.legend_handler import HandlerTuple
from matplotlib.lines import Line2D

from precursors.analysis.slip_rows import up_to_first_global
from precursors.figures import style

HEIGHT_MM = 76.0
# The fill tells the sign of theta, as in the paper; a second scene of the same sign has another outline.
OUTLINES = ("o", "s", "D", "^", "v", "h")
# All scenes meet at the global slip: circles of different size stay visible around each other.
SIZES = {-1: 4.2, 0: 5.2, 1: 6.6}


@dataclass(frozen=True)
class PrecursorLengths:
    """A scene as Fig. 13 needs it.

    Parameters
    ----------
    slips : DataFrame
        Slip table, see `style.read_slips`.
    theta : float
        Degree of non-uniformity of its normal loading.
    n_blocks : int
        Number N of blocks.
    normal_load_N : float
        Total normal load F_Z [N].
    """

    slips: pd.DataFrame
    theta: float
    n_blocks: int
    normal_load_N: float


def draw_precursor_lengths(scenes: Sequence[PrecursorLengths], with_short_events: bool = True) -> Figure:
    """Draw L_p/L against F_X at the onset, up to and including the first global slip.

    Parameters
    ----------
    scenes : sequence of PrecursorLengths
        At least one.
    with_short_events : bool
        Whether the short events that Fig. 13 leaves out are shown too, faint and small.

    Raises
    ------
    ValueError
        If there is no scene.

    Notes
    -----
    Fig. 13 of the paper: solid circles for theta < 0, dotted for theta = 0, open for theta > 0. The upper
    axis, and the line at the mean apparent static friction coefficient (Eq. 1), are there when all scenes
    have the same normal load.
    """
    if not scenes:
        raise ValueError("Fig. 13 has no scene: allowed is at least one")
    with style.styled():
        figure = style.new_figure(style.COLUMN_MM, HEIGHT_MM)
        axes = figure.subplots()
        entries = [
            _draw_scene(axes, scene, outline, with_short_events)
            for scene, outline in zip(scenes, _outlines(scenes), strict=True)
        ]
        labels = [_label(scene, scenes) for scene in scenes]
        if with_short_events and any(len(_short_events(scene.slips)) for scene in scenes):
            entries.append((Line2D([], [], **_SHORT, color=style.GREY),))
            labels.append("short events, not counted")
        axes.set_xlim(0, None)
        axes.set_ylim(0, 1.06)
        axes.set_xlabel("Tangential load $F_X$ [N]")
        axes.set_ylabel("Propagation length $L_p/L$ [-]")
        _draw_friction_coefficient(axes, scenes)
        axes.legend(entries, labels, loc="best", handler_map={tuple: HandlerTuple(ndivide=1)}, handlelength=1)
        style.lay_out(figure)
    return figure


_SHORT: dict[str, Any] = {
    "linestyle": "none",
    "marker": "x",
    "markersize": 2.5,
    "markeredgewidth": 0.6,
    "alpha": 0.5,
}


def _outlines(scenes: Sequence[PrecursorLengths]) -> list[str]:
    signs = [np.sign(scene.theta) for scene in scenes]
    return [OUTLINES[signs[:i].count(sign) % len(OUTLINES)] for i, sign in enumerate(signs)]


def _draw_scene(
    axes: Axes, scene: PrecursorLengths, outline: str, with_short_events: bool
) -> tuple[Line2D, ...]:
    sign = int(np.sign(scene.theta))
    color = style.theta_color(scene.theta)
    if with_short_events:
        short = _short_events(scene.slips)
        axes.plot(short["load_before_N"], short["front"] / scene.n_blocks, **_SHORT, color=color, zorder=1.5)
    kept = scene.slips[scene.slips["kept"]]
    load, reached = kept["load_before_N"], kept["front"] / scene.n_blocks
    marker: dict[str, Any] = {"linestyle": "none", "color": color, "markeredgewidth": 0.8}
    fill = color if sign < 0 else "none"
    drawn = axes.plot(load, reached, marker=outline, markersize=SIZES[sign], markerfacecolor=fill, **marker)
    if sign == 0:
        drawn += axes.plot(load, reached, marker=".", markersize=0.5 * SIZES[sign], **marker)
    return tuple(drawn)


def _short_events(slips: pd.DataFrame) -> pd.DataFrame:
    return up_to_first_global(slips).query("not kept")


def _label(scene: PrecursorLengths, scenes: Sequence[PrecursorLengths]) -> str:
    name = style.theta_text(scene.theta)
    if len({other.n_blocks for other in scenes}) > 1:
        name += f", $N = {scene.n_blocks}$"
    if len({other.normal_load_N for other in scenes}) > 1:
        name += f", $F_Z = {scene.normal_load_N:g}$ N"
    n_kept = int(scene.slips["kept"].sum())
    note = "" if scene.slips["is_global"].any() else ", no global slip"
    return f"{name}: {n_kept} event{'' if n_kept == 1 else 's'}{note}"


def _draw_friction_coefficient(axes: Axes, scenes: Sequence[PrecursorLengths]) -> None:
    normal_load = scenes[0].normal_load_N
    if any(scene.normal_load_N != normal_load for scene in scenes):
        return
    upper = axes.secondary_xaxis(
        "top", functions=(lambda load: np.divide(load, normal_load), lambda mu: np.multiply(mu, normal_load))
    )
    upper.set_xlabel("Friction coefficient $F_X/F_Z$ [-]")
    up_to = [up_to_first_global(scene.slips) for scene in scenes if scene.slips["is_global"].any()]
    if not up_to:
        return
    mu_sapp = float(np.mean([slips["load_before_N"].max() for slips in up_to])) / normal_load
    axes.axvline(mu_sapp * normal_load, color=style.GREY, linewidth=0.6, linestyle=(0, (1, 2)), zorder=1)
    axes.annotate(
        ("mean " if len(up_to) > 1 else "") + rf"$\mu_\mathrm{{sapp}} = {mu_sapp:.3f}$",
        xy=(mu_sapp * normal_load, 0.6),
        xytext=(2, 0),
        textcoords="offset points",
        rotation=90,
        va="center",
        fontsize=7,
        color=style.GREY,
    )
