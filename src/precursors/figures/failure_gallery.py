"""The failure gallery: a panel for each way to fail, with the measured number that shows it."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter

from precursors.figures import style

HEIGHT_MM = 212.0
ROWS, COLUMNS = 4, 3
TITLE_SIZE, TEXT_SIZE, LEGEND_SIZE = 6.8, 6.0, 5.8
LINE_PT = 8.2
# A layout made for the longest title would leave no room for the panels.
LAYOUT = {"left": 0.07, "right": 0.99, "bottom": 0.04, "top": 0.95, "wspace": 0.38, "hspace": 0.7}
TEXT_LEFT_PT = -24.0
MICRO, MILLI = 1e6, 1e3

NUMBER_COLUMNS = {
    "way": str,
    "method": str,
    "knob": str,
    "quantity": str,
    "unit": str,
    "value": float,
    "exact": float,
}
# What is right is black and theory grey; what fails has these colours in turn.
COLORS = (style.VERMILION, style.BLUE, style.GREEN)
RIGHT: dict[str, dict[str, Any]] = {
    "exact": {"color": style.BLACK},
    "theory": {"color": style.GREY},
    "the drive": {"color": style.BLACK, "linewidth": 0.6, "linestyle": (0, (4, 2))},
    "the chain itself": {"color": style.BLACK, "linewidth": 0.6, "linestyle": (0, (4, 2))},
}
THEORY_OF = "theory, "


@dataclass(frozen=True)
class Panel:
    """A panel: what it is about, its axes, and the sentences in which the numbers stand.

    Attributes
    ----------
    title : str
        The way to fail.
    x, y : str
        Labels of the axes.
    sentences : tuple of (row, text)
        Row of the way's numbers, and a text with {value} and {exact} as format fields.
    scale : tuple of float
        What the table's x and y are multiplied by for the axes.
    logarithmic : str
        Which axes are: "", "x", "y" or "xy".
    vertical : int, optional
        Row of a number that stands at a place on the x axis.
    joined : bool
        Whether lines join the points of what fails.
    markers : bool
        Whether those points have markers.
    drawstyle : str
        Matplotlib's: "steps-post" for a number that jumps.
    legend : str or (x, y)
        Where Matplotlib puts the legend.
    limits : mapping
        Limits of the axes where the data's will not do.
    """

    title: str
    x: str
    y: str
    sentences: tuple[tuple[int, str], ...]
    scale: tuple[float, float] = (1.0, 1.0)
    logarithmic: str = ""
    vertical: int | None = None
    joined: bool = True
    markers: bool = True
    drawstyle: str = "default"
    legend: Any = "best"
    limits: Mapping[str, tuple[float | None, float | None]] = field(default_factory=dict)


PANELS: dict[str, Panel] = {
    "rk4_unstable": Panel(
        "RK4 above its stability limit",
        r"$\omega_\mathrm{max}\,\Delta t$ [-]",
        "Energy factor per step [-]",
        (
            (0, r"stable up to $\omega\Delta t$ = {value:.3f}; theory $2\sqrt{{2}}$ = {exact:.3f}"),
            (1, r"that is $\Delta t$ = {value:.3g} s on the paper's chain"),
        ),
        vertical=0,
        joined=False,
    ),
    "leapfrog_unstable": Panel(
        "Leapfrog above its stability limit",
        r"$\omega_\mathrm{max}\,\Delta t$ [-]",
        "Energy factor per step [-]",
        (
            (0, r"stable up to $\omega\Delta t$ = {value:.3f}; theory {exact:.3f}"),
            (1, r"that is $\Delta t$ = {value:.3g} s on the paper's chain"),
        ),
        vertical=0,
        joined=False,
    ),
    "numerical_damping": Panel(
        r"Moreau-Jean, $\theta$ = 1, damps motion",
        r"Time [$\mu$s]",
        "Energy left [-]",
        (
            (1, r"{knob}: {value:.3f} left after 100 $\mu$s; exact {exact:g}"),
            (3, r"$\theta$ = 1/2, {knob}: {value:.3f} left"),
        ),
        scale=(MICRO, 1.0),
        legend=(0.5, 0.12),
        joined=False,
    ),
    "literal_friction": Panel(
        "Eq. 4 taken literally never sticks again",
        "Time [s]",
        "$F_X$ [N]",
        ((1, "largest $F_X$ in 1 s: {value:.2f} N; exact {exact:.2f} N"),),
        markers=False,
    ),
    "dead_zone_too_small": Panel(
        "Dead zone too small: jumped over",
        "Width of the zone / safe width [-]",
        "Transitions right [-]",
        (
            (0, "{knob}: {value:.0f} of {exact:.0f} right"),
            (2, "all are right from {value:.2g} safe width on"),
        ),
        logarithmic="x",
        vertical=2,
        limits={"y": (0.0, None)},
    ),
    "dead_zone_too_large": Panel(
        "Dead zone too large: creep inside",
        "Width of the zone [m/s]",
        r"$F_X - \mu_s w_1$ at release [N]",
        (
            (1, "{knob}: {value:.0f} of {exact:.0f} transitions right"),
            (2, "all are right up to {value:.2g} m/s"),
        ),
        logarithmic="xy",
        vertical=2,
        joined=False,
    ),
    "creep": Panel(
        "Regularised friction creeps in stick",
        r"Load / $\mu_s w$ [-]",
        "Velocity [m/s]",
        (
            (0, "{knob}:"),
            (1, "creeps at {value:.2%} of the drive's velocity; exact 0"),
        ),
        logarithmic="y",
        joined=False,
        legend="lower right",
        limits={"y": (1e-11, 3e-4)},
    ),
    "stiffness": Panel(
        "Regularised friction is stiff",
        "Width [m/s]",
        "Fastest rate [1/s]",
        (
            (0, "{knob}: {value:.1e} /s; chain {exact:.1e} /s"),
            (1, "RK4 stable up to {value:.1e} s; chain {exact:.1e} s"),
        ),
        logarithmic="xy",
        joined=False,
    ),
    "missed_roots": Panel(
        "DOP853 misses two roots in a step",
        r"Time since the last transition [$\mu$s]",
        "Velocity of the block [mm/s]",
        (
            (1, "{knob}: {value:.0f} of {exact:.0f} transitions right"),
            (3, "and max_step = 1e-06 s: {value:.0f} of {exact:.0f}"),
        ),
        scale=(MICRO, MILLI),
    ),
    "restart_on_root": Panel(
        "Restart on a root: time stands still",
        "Time [s]",
        "Transitions [-]",
        (
            (0, "{quantity}: {value:.0f}, no end; exact {exact:.0f}"),
            (1, "with the sign of the acceleration: {value:.0f} in 1 s"),
        ),
        markers=False,
        drawstyle="steps-post",
    ),
    "merged_transitions": Panel(
        "Transitions closer than a step merged",
        "Merged within [s]",
        "Transitions right [-]",
        (
            (1, "{knob}: {value:.0f} of {exact:.0f} transitions right,"),
            (0, "though only {value:.0f} of them lie so close"),
        ),
        logarithmic="x",
        limits={"y": (0.0, None)},
    ),
    "forward_only": Panel(
        r"Backward sliding forbidden ($\theta$ = 5/6)",
        "Time [s]",
        "$F_X$ [N]",
        (
            (5, r"{knob}: $\mu_\mathrm{{sapp}}$ = {value:.4f}; exact {exact:.4f}"),
            (0, r"{knob}: {value:.0f} of {exact:.0f} transitions right"),
        ),
        markers=False,
        limits={"x": (2.0, None), "y": (125.0, None)},
    ),
}


def draw_failure_gallery(numbers: pd.DataFrame, curves: Mapping[str, pd.DataFrame]) -> Figure:
    """Draw the ways to fail.

    Parameters
    ----------
    numbers : DataFrame
        Columns way, method, knob, quantity, unit, value, exact; see `read_numbers`.
    curves : mapping of str to DataFrame
        By way: the curve's name, x and y in the first three columns.

    Raises
    ------
    ValueError
        If a way has too few numbers or no curves.
    """
    with style.styled():
        figure = style.new_figure(style.PAGE_MM, HEIGHT_MM)
        grid = figure.subplots(ROWS, COLUMNS).ravel()
        for letter, axes, (way, panel) in zip("abcdefghijkl", grid, PANELS.items(), strict=True):
            own = numbers[numbers["way"] == way].reset_index(drop=True)
            if way not in curves or len(own) <= max(row for row, _ in panel.sentences):
                raise ValueError(f"{way}: {len(own)} numbers are too few or curves are missing")
            _draw_panel(axes, panel, letter, own, curves[way])
        figure.subplots_adjust(**LAYOUT)
    return figure


def read_numbers(path: str | Path) -> pd.DataFrame:
    """Read the table of numbers (tables/failures.csv).

    Raises
    ------
    ValueError
        If a column is missing or holds something else than it should.
    """
    return style.read_columns(path, NUMBER_COLUMNS)


def sentence(text: str, number: pd.Series) -> str:
    """A sentence of a panel, with powers of ten and the names of variables as mathematics."""
    fields = {str(key): value for key, value in number.items()}
    return pretty(text.format(**fields)).replace("mu_s w", r"$\mu_s w$")


def pretty(text: str) -> str:
    """Write 1e-07 as a power of ten and the names of variables as mathematics."""
    text = text.replace("dt =", r"$\Delta t$ =").replace("theta =", r"$\theta$ =")
    text = re.sub(r"\b1(?:\.0+)?e([-+]\d+)", lambda m: f"$10^{{{int(m[1])}}}$", text)
    return re.sub(r"(\d+(?:\.\d+)?)e([-+]\d+)", lambda m: rf"${m[1]}\times10^{{{int(m[2])}}}$", text)


def _draw_panel(axes: Axes, panel: Panel, letter: str, numbers: pd.DataFrame, curves: pd.DataFrame) -> None:
    name, x, y = curves.columns[:3]
    color = dict(zip((n for n in curves[name].unique() if _fails(n)), 2 * COLORS, strict=False))
    for curve, points in curves.groupby(name, sort=False):
        own = {"color": color.get(str(curve).removeprefix(THEORY_OF), style.GREY)}
        look = dict(RIGHT.get(str(curve), own))
        if curve in color and panel.markers:
            look |= {"marker": "o", "markersize": 2.4}
            look |= {"linewidth": 0.6} if panel.joined else {"linestyle": "none"}
        if str(curve).startswith(THEORY_OF):
            look |= {"linewidth": 0.6, "label": "_"}
        axes.plot(
            points[x] * panel.scale[0],
            points[y] * panel.scale[1],
            drawstyle=panel.drawstyle,
            **{"label": pretty(str(curve)), **look},
        )
    if panel.vertical is not None:
        place = numbers["value"].iloc[panel.vertical] * panel.scale[0]
        axes.axvline(place, color=style.GREY, linewidth=0.6, linestyle=(0, (1, 2)), zorder=1)
    if "x" in panel.logarithmic:
        axes.set_xscale("log")
        axes.xaxis.set_minor_formatter(NullFormatter())
    if "y" in panel.logarithmic:
        axes.set_yscale("log")
        axes.yaxis.set_minor_formatter(NullFormatter())
    for axis, limits in panel.limits.items():
        (axes.set_xlim if axis == "x" else axes.set_ylim)(*limits)
    axes.set_xlabel(panel.x, fontsize=TITLE_SIZE)
    axes.set_ylabel(panel.y, fontsize=TITLE_SIZE)
    axes.tick_params(labelsize=TEXT_SIZE)
    axes.legend(loc=panel.legend, fontsize=LEGEND_SIZE, handlelength=1.4, borderaxespad=0.3)
    lines = [sentence(text, numbers.iloc[row]) for row, text in panel.sentences]
    axes.annotate(
        "\n".join(lines),
        (0, 1),
        xytext=(TEXT_LEFT_PT, 3),
        **_ABOVE,
        fontsize=TEXT_SIZE,
        color=style.VERMILION,
    )
    height = 4 + LINE_PT * len(lines)
    axes.annotate(
        f"{letter}  {panel.title}", (0, 1), xytext=(TEXT_LEFT_PT, height), **_ABOVE, fontsize=TITLE_SIZE,
        fontweight="bold",
    )  # fmt: skip


_ABOVE: dict[str, Any] = {
    "xycoords": "axes fraction",
    "textcoords": "offset points",
    "va": "bottom",
    "annotation_clip": False,
}


def _fails(curve: str) -> bool:
    return curve not in RIGHT and not curve.startswith(THEORY_OF)
