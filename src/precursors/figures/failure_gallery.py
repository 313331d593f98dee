"""The failure gallery: a panel for each way to fail, with the measured number that shows it."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullFormatter, StrMethodFormatter

from precursors.figures import style

HEIGHT_MM = 212.0
ROWS, COLUMNS = 4, 3
TITLE_SIZE, TEXT_SIZE, LEGEND_SIZE = 6.8, 6.0, 5.8
LINE_PT = 8.2
# A layout made for the longest title would leave no room for the panels.
LAYOUT = {"left": 0.07, "right": 0.99, "bottom": 0.04, "top": 0.95, "wspace": 0.38, "hspace": 0.7}
TEXT_LEFT_PT = -24.0
# Where the ends of an axis are closer than by this factor it has one or two decades, and where it is all
# above this number its labels are decimals.
FEW_DECADES, SHORT = 110.0, 1e-4
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
class Sentence:
    """A line above a panel, and which of the way's numbers stands in it.

    Attributes
    ----------
    text : str
        With columns of the table as format fields, such as {value}.
    quantity : str
        What the number's quantity begins with.
    knob, method : str
        The number's knob and method, where the quantity alone does not tell it from others.
    """

    text: str
    quantity: str
    knob: str = ""
    method: str = ""

    def find(self, numbers: pd.DataFrame) -> pd.Series:
        """The number among those of a way.

        Raises
        ------
        LookupError
            If it is not there, or not alone.
        """
        return find_number(numbers, self.quantity, self.knob, self.method)


@dataclass(frozen=True)
class Panel:
    """A panel: what it is about, its axes, and the sentences in which the numbers stand.

    Attributes
    ----------
    title : str
        The way to fail.
    x, y : str
        Labels of the axes.
    sentences : tuple of Sentence
        What stands above it.
    scale : tuple of float
        What the table's x and y are multiplied by for the axes.
    logarithmic : str
        Which axes are: "", "x", "y" or "xy".
    vertical : str
        Quantity of a number that stands at a place on the x axis.
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
    sentences: tuple[Sentence, ...]
    scale: tuple[float, float] = (1.0, 1.0)
    logarithmic: str = ""
    vertical: str = ""
    joined: bool = True
    markers: bool = True
    drawstyle: str = "default"
    legend: Any = "best"
    limits: Mapping[str, tuple[float | None, float | None]] = field(default_factory=dict)


OMEGA_DT = r"$\omega_\mathrm{max}\,\Delta t$ [-]"
RIGHT_OF_ALL = "{knob}: {value:.0f} of {exact:.0f} transitions right"
STABLE_STEP = Sentence(r"that is $\Delta t$ = {value:.3g} s on the paper's chain", "largest stable dt")

PANELS: dict[str, Panel] = {
    "rk4_unstable": Panel(
        "RK4 above its stability limit",
        OMEGA_DT,
        "Energy factor per step [-]",
        (
            Sentence(
                r"stable up to $\omega\Delta t$ = {value:.3f}; theory $2\sqrt{{2}}$ = {exact:.3f}",
                "largest stable omega dt",
            ),
            STABLE_STEP,
        ),
        vertical="largest stable omega dt",
        joined=False,
    ),
    "leapfrog_unstable": Panel(
        "Leapfrog above its stability limit",
        OMEGA_DT,
        "Energy factor per step [-]",
        (
            Sentence(
                r"stable up to $\omega\Delta t$ = {value:.3f}; theory {exact:.3f}", "largest stable omega dt"
            ),
            STABLE_STEP,
        ),
        vertical="largest stable omega dt",
        joined=False,
    ),
    "numerical_damping": Panel(
        "Implicit Moreau-Jean damps motion",
        r"Time [$\mu$s]",
        "Energy left [-]",
        (
            Sentence(
                "{knob}: {value:.3f} of the energy left; exact {exact:g}",
                "energy left",
                "dt = 1e-07 s",
                "Moreau-Jean, implicit",
            ),
            Sentence("{method}, {knob}: {value:.3f}", "energy left", method="Moreau-Jean, trapezoidal"),
        ),
        scale=(MICRO, 1.0),
        legend=(0.5, 0.12),
        joined=False,
    ),
    "literal_friction": Panel(
        "Eq. 4 taken literally never sticks again",
        "Time [s]",
        "$F_X$ [N]",
        (
            Sentence("{quantity}: {value:.2f} N; exact {exact:.2f} N", "largest F_X", "dt = 1e-06 s"),
            Sentence("with {knob}: {value:.2f} N", "largest F_X", "dt = 3e-06 s"),
        ),
        markers=False,
    ),
    "dead_zone_too_small": Panel(
        "Dead zone too small: jumped over",
        r"Zone / safe width $(\mu_s+\mu_k)\,w\,\Delta t/2m$ [-]",
        "Transitions right [-]",
        (
            Sentence(
                "{knob}: {value:.0f} of {exact:.0f} right",
                "transitions right",
                "dt = 4e-08 s, zone = 0.05 safe",
            ),
            Sentence("all are right from {value:.2g} {unit} on", "zone from which all is right"),
        ),
        logarithmic="x",
        vertical="zone from which all is right",
        limits={"y": (0.0, None)},
    ),
    "dead_zone_too_large": Panel(
        "Dead zone too large: creep inside",
        "Width of the zone [m/s]",
        r"$F_X - \mu_s w_1$ at release [N]",
        (
            Sentence(RIGHT_OF_ALL, "transitions right"),
            Sentence("all are right up to {value:.2g} {unit}", "zone up to which all is right"),
        ),
        logarithmic="xy",
        vertical="zone up to which all is right",
        joined=False,
    ),
    "creep": Panel(
        "Regularised friction creeps in stick",
        r"Load / $\mu_s w$ [-]",
        "Velocity [m/s]",
        (
            Sentence("{knob}:", "velocity in stick, of the drive's"),
            Sentence(
                "creeps at {value:.2%} of the drive's $V$; exact {exact:g}",
                "velocity in stick, of the drive's",
            ),
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
            Sentence("{knob}: {value:.1e} /s; chain {exact:.1e} /s", "fastest rate"),
            Sentence("RK4 stable up to {value:.1e} s; chain {exact:.1e} s", "longest stable step of RK4"),
        ),
        logarithmic="xy",
        joined=False,
    ),
    "missed_roots": Panel(
        "DOP853 misses two roots in a step",
        r"Time since the last transition [$\mu$s]",
        "Block's velocity [mm/s]",
        (
            Sentence(RIGHT_OF_ALL, "transitions right", "rtol = 1e-07"),
            Sentence(
                "{knob}: {value:.0f} of {exact:.0f}", "transitions right", "rtol = 1e-07, max_step = 1e-06 s"
            ),
        ),
        scale=(MICRO, MILLI),
    ),
    "restart_on_root": Panel(
        "Restart on a root: time stands still",
        "Time [s]",
        "Transitions [-]",
        (
            Sentence("{quantity}: {value:.0f}, no end; exact {exact:.0f}", "transitions at t"),
            Sentence("{knob}: {value:.0f}; exact {exact:.0f}", "transitions in"),
        ),
        markers=False,
        drawstyle="steps-post",
    ),
    "merged_transitions": Panel(
        "Transitions closer than a step merged",
        "Merged within [s]",
        "Transitions right [-]",
        (
            Sentence(RIGHT_OF_ALL + ",", "transitions right"),
            Sentence("though only {value:.0f} of them lie so close", "transitions merged"),
        ),
        logarithmic="x",
        limits={"y": (0.0, None)},
    ),
    "forward_only": Panel(
        r"Backward sliding forbidden ($\theta$ = 5/6)",
        "Time [s]",
        "$F_X$ [N]",
        (
            Sentence(
                r"{knob}: $\mu_\mathrm{{sapp}}$ = {value:.4f}; exact {exact:.4f}", "mu_sapp", "theta = 5/6"
            ),
            Sentence(RIGHT_OF_ALL, "transitions right", "theta = -5/6"),
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
        If a way has no curves, or a number of a sentence is missing or not the only one.
    """
    with style.styled():
        figure = style.new_figure(style.PAGE_MM, HEIGHT_MM)
        grid = figure.subplots(ROWS, COLUMNS).ravel()
        for letter, axes, (way, panel) in zip("abcdefghijkl", grid, PANELS.items(), strict=True):
            if way not in curves:
                raise ValueError(f"{way}: its curves are missing")
            try:
                _draw_panel(axes, panel, letter, numbers[numbers["way"] == way], curves[way])
            except LookupError as error:
                raise ValueError(f"{way}: {error}") from None
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


def find_number(numbers: pd.DataFrame, quantity: str, knob: str = "", method: str = "") -> pd.Series:
    """The only number of a way whose quantity begins so, with a knob and a method if these are given.

    Raises
    ------
    LookupError
        If there is none, or more than one.
    """
    found = numbers[numbers["quantity"].str.startswith(quantity)]
    for column, wanted in (("knob", knob), ("method", method)):
        found = found[found[column] == wanted] if wanted else found
    if len(found) != 1:
        which = ", ".join(filter(None, (repr(quantity), knob, method)))
        raise LookupError(f"{len(found)} numbers are {which}: needed is one")
    return found.iloc[0]


def sentence(text: str, number: pd.Series) -> str:
    """A sentence of a panel, with powers of ten and the names of variables as mathematics."""
    fields = {str(key): value for key, value in number.items()}
    return pretty(text.format(**fields)).replace("mu_s w", r"$\mu_s w$").replace(" F_X ", " $F_X$ ")


def pretty(text: str) -> str:
    """Write 1e-07 as a power of ten and the names of variables as mathematics."""
    text = (
        text.replace("dt =", r"$\Delta t$ =")
        .replace("theta =", r"$\theta$ =")
        .replace("= -", "= \N{MINUS SIGN}")
    )
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
    if panel.vertical:
        place = find_number(numbers, panel.vertical)["value"] * panel.scale[0]
        axes.axvline(place, color=style.GREY, linewidth=0.6, linestyle=(0, (1, 2)), zorder=1)
    for axis in panel.logarithmic:
        (axes.set_xscale if axis == "x" else axes.set_yscale)("log")
    for axis, limits in panel.limits.items():
        (axes.set_xlim if axis == "x" else axes.set_ylim)(*limits)
    for axis in panel.logarithmic:
        _label(axes.xaxis if axis == "x" else axes.yaxis)
    axes.set_xlabel(panel.x, fontsize=TITLE_SIZE)
    axes.set_ylabel(panel.y, fontsize=TITLE_SIZE)
    axes.tick_params(labelsize=TEXT_SIZE)
    axes.legend(loc=panel.legend, fontsize=LEGEND_SIZE, handlelength=1.4, borderaxespad=0.3)
    lines = [sentence(line.text, line.find(numbers)) for line in panel.sentences]
    axes.annotate(
        "\n".join(lines),
        (0, 1),
        xytext=(TEXT_LEFT_PT, 3),
        **_ABOVE,
        fontsize=TEXT_SIZE,
        color=style.VERMILION,
    )
    height = 4 + LINE_PT * max(len(other.sentences) for other in PANELS.values())
    axes.annotate(
        f"{letter}  {panel.title}", (0, 1), xytext=(TEXT_LEFT_PT, height), **_ABOVE, fontsize=TITLE_SIZE,
        fontweight="bold",
    )  # fmt: skip


def _label(axis: Axis) -> None:
    """Label the decades of a logarithmic axis; where it has few, 2 and 5 times them in place of that."""
    low, high = sorted(axis.get_view_interval())
    if high < low * FEW_DECADES and low > SHORT:
        axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axis.set_major_formatter(StrMethodFormatter("{x:g}"))
    axis.set_minor_formatter(NullFormatter())


_ABOVE: dict[str, Any] = {
    "xycoords": "axes fraction",
    "textcoords": "offset points",
    "va": "bottom",
    "annotation_clip": False,
}


def _fails(curve: str) -> bool:
    return curve not in RIGHT and not curve.startswith(THEORY_OF)
