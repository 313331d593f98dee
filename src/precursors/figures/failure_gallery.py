"""The failure gallery: a panel for each failure mode, with the measured number that shows it."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullFormatter, StrMethodFormatter

from precursors.figures import style

HEIGHT_MM = 207.0
ROWS, COLUMNS = 4, 3
TEXT_SIZE = 7.0
# A layout made for the longest title would leave no room for the panels.
LAYOUT = {"left": 0.07, "right": 0.99, "bottom": 0.04, "top": 0.94, "wspace": 0.38, "hspace": 0.78}
TEXT_LEFT_PT, TEXT_BOTTOM_PT, LINE_PT = -24.0, 3.0, 9.8
ABOVE: dict[str, Any] = {"xycoords": "axes fraction", "textcoords": "offset points", "va": "bottom"}
ABOVE |= {"annotation_clip": False}
# A logarithmic axis that spans less than this factor, above this number, has decimal labels.
FEW_DECADES, SHORT = 110.0, 1e-4
MICRO, MILLI = 1e6, 1e3
DASHED: dict[str, Any] = {"color": style.BLACK, "linewidth": 0.6, "linestyle": (0, (4, 2))}

# What is right is black and theory grey; what fails has these colours in turn.
COLORS = 2 * (style.VERMILION, style.BLUE, style.GREEN)
RIGHT: dict[str, dict[str, Any]] = {
    "exact": {"color": style.BLACK},
    "theory": {"color": style.GREY},
    "the drive": DASHED,
    "the chain itself": DASHED,
}
THEORY_OF = "theory, "


class Sentence(NamedTuple):
    """A line above a panel, and the number in it: its quantity begins so, with this setting and method.

    A threshold is written by `at` and `theory`, in the unit of the x axis.
    """

    text: str
    quantity: str
    setting: str = ""
    method: str = ""


@dataclass(frozen=True)
class Panel:
    """A panel: its title, its axes, and the sentences with its numbers.

    `scale` is from the table's x and y to the axes, and `log` names the logarithmic axes. Thresholds in its
    sentences are marked on the x axis if `vertical`: measured ones dotted, predicted ones dashed. What fails
    is drawn by a line if `joined`, and by markers if `marked`.
    """

    title: str
    x: str
    y: str
    sentences: Sequence[Sentence]
    scale: tuple[float, float] = (1.0, 1.0)
    log: str = ""
    vertical: bool = True
    joined: bool = True
    marked: bool = True
    drawstyle: str = "default"
    key: Any = "best"
    xmin: float | None = None
    ylim: tuple[float | None, float | None] = (None, None)


STEP = r"Step $\Delta t$ [$\mu$s]"
LIMIT, LOST = "energy grows without bound, no friction", "no global slip, or numbers overflow"
STABLE = r"{method}: up to {at:.3f} $\mu$s; theory {theory:.3f}"
RIGHT_OF_ALL = "{setting}: {measured:.0f} of {exact:.0f} transitions right"
F_X, TIME = "$F_X$ [N]", "Time [s]"
MU_SAPP = r"$\mu_\mathrm{sapp}$ [-]"
CREEP = "velocity in stick, of the drive's"

PANELS = {
    "unstable": Panel("Steps above the stability limit", STEP, "Energy factor per step [-]", (
        Sentence(STABLE, LIMIT, method="RK4"),
        Sentence(STABLE, LIMIT, method="leapfrog"),
    ), scale=(MICRO, 1.0), joined=False),
    "silent_instability": Panel("The same with friction: no warning", STEP, MU_SAPP, (
        Sentence(r"{method} finishes up to {at:.1f} $\mu$s; theory {theory:.1f}", LOST, method="RK4"),
        Sentence(r"largest $\mu_\mathrm{{sapp}}$ = {measured:.3f}; exact {exact:.3f}", "largest mu_sapp"),
    ), scale=(MICRO, 1.0), joined=False),
    "numerical_damping": Panel("Implicit Moreau-Jean damps motion", r"Time [$\mu$s]", "Energy left [-]", (
        Sentence("{setting}: energy {measured:.3f}; theory {predicted:.3f}", "energy left", "dt = 1e-07 s",
                 "Moreau-Jean, implicit"),
        Sentence("trapezoidal, {setting}: {measured:.3f}", "energy left", method="Moreau-Jean, trapezoidal"),
    ), scale=(MICRO, 1.0), key=(0.5, 0.06), joined=False),
    "literal_friction": Panel("Eq. 4 taken literally never sticks again", TIME, F_X, (
        Sentence("{quantity}: {measured:.2f} N; exact {exact:.2f} N", "largest F_X", "dt = 1e-06 s"),
        Sentence("with {setting}: {measured:.2f} N; theory {predicted:.2f} N", "largest F_X",
                 "dt = 3e-06 s"),
    ), marked=False),
    "dead_zone_too_small": Panel(
        "Dead zone too small: jumped over",
        r"Zone / safe width $(\mu_s+\mu_k)\,w\,\Delta t/2m$ [-]", "Transitions right [-]", (
        Sentence("{setting}: {measured:.0f} of {exact:.0f}", "transitions right",
                 "dt = 4e-08 s, zone = 0.05 safe"),
        Sentence("right from {at:.2g} {unit} on; theory {theory:.2g}", "a narrower zone"),
    ), log="x", key="lower right", ylim=(0.0, None)),
    "dead_zone_too_large": Panel(
        "Dead zone too large: creep inside", "Width of the zone [m/s]", r"$F_X - \mu_s w_1$ at release [N]", (
        Sentence(RIGHT_OF_ALL, "transitions right"),
        Sentence("right up to {at:.1e} {unit}; theory {theory:.1e}", "creep in a wider zone"),
    ), log="xy", joined=False),
    "creep": Panel("Regularised friction creeps in stick", r"Load / $\mu_s w$ [-]", "Velocity [m/s]", (
        Sentence("creep at {setting}:", CREEP),
        Sentence("{measured:.2%} of the drive's $V$; theory {predicted:.2%}", CREEP),
    ), log="y", joined=False, key="lower right", ylim=(1e-13, 3e-4)),
    "stiffness": Panel("Regularised friction is stiff", "Width [m/s]", "Fastest rate [1/s]", (
        Sentence("{setting}: {measured:.0e} /s, chain {exact:.0e}", "fastest rate"),
        Sentence("RK4 up to {at:.2e} s; theory {theory:.2e} s", "creep becomes"),
    ), log="xy", vertical=False, joined=False),
    "missed_roots": Panel(
        "DOP853 misses two roots in a step",
        r"Time since the last transition [$\mu$s]", "Block's velocity [mm/s]", (
        Sentence(RIGHT_OF_ALL, "transitions right"),
        Sentence(r"safe steps: {at:.1f} $\mu$s; theory {theory:.1f} $\mu$s", "two roots of a velocity"),
    ), scale=(MICRO, MILLI), vertical=False),
    "restart_on_root": Panel("Restart on a root: time stands still", TIME, "Transitions [-]", (
        Sentence("{quantity}: {measured:.0f}, no end; exact {exact:.0f}", "transitions at t"),
        Sentence("not from v = {measured:.0e}; theory {predicted:.0e}", "smallest start"),
    ), marked=False, drawstyle="steps-post"),
    "merged_transitions": Panel(
        "Transitions closer than a step merged", "Merged within [s]", "Transitions right [-]", (
        Sentence(RIGHT_OF_ALL, "transitions right"),
        Sentence("right up to {at:.1e} s; theory {theory:.1e} s", "two of three"),
    ), log="x", ylim=(0.0, None)),
    "forward_only": Panel(r"No backward sliding ($\theta$ = 5/6)", TIME, F_X, (
        Sentence(r"{setting}: $\mu_\mathrm{{sapp}}$ = {measured:.4f}; exact {exact:.4f}", "mu_sapp",
                 "theta = 5/6"),
        Sentence("right: {measured:.0f} of {exact:.0f} transitions; theory {predicted:.0f}",
                 "transitions right", "theta = 5/6"),
    ), marked=False, xmin=2.0, ylim=(125.0, None)),
}  # fmt: skip
CHARTED_BLOCKS = 10
N_LINES = max(len(panel.sentences) for panel in PANELS.values())


def draw(numbers: pd.DataFrame, thresholds: pd.DataFrame, curves: Sequence[pd.DataFrame]) -> Figure:
    """Draw the failure modes.

    Parameters
    ----------
    numbers : DataFrame
        failures.csv: columns failure_mode, method, setting, quantity, unit, measured, exact, predicted.
    thresholds : DataFrame
        thresholds.csv: columns method, n_blocks, fails, unit, measured, predicted.
    curves : sequence of DataFrame
        failures/{mode}.csv in the order of `PANELS`: the curve's name, x and y in the first three columns.

    Raises
    ------
    ValueError
        If a number of a sentence is missing, or not the only one.
    """
    limits = thresholds[thresholds["n_blocks"] == CHARTED_BLOCKS].rename(columns={"fails": "quantity"})
    numbers = pd.concat([numbers, limits.assign(setting="")], ignore_index=True)
    with style.page(style.PAGE_MM, HEIGHT_MM, lay_out=False) as figure:
        grid = figure.subplots(ROWS, COLUMNS).flat
        for letter, axes, mode, table in zip("abcdefghijkl", grid, PANELS, curves, strict=True):
            _draw_panel(axes, letter, mode, numbers, table)
        figure.subplots_adjust(**LAYOUT)
    return figure


def _draw_panel(axes: Axes, letter: str, mode: str, numbers: pd.DataFrame, curves: pd.DataFrame) -> None:
    panel = PANELS[mode]
    _draw_curves(axes, panel, curves)
    found = [find_number(numbers, mode, *which) for _, *which in panel.sentences]
    for limit in found if panel.vertical else ():
        if pd.notna(limit.get("n_blocks")):
            axes.axvline(limit["predicted"] * panel.scale[0], **DASHED | {"color": style.GREY})
            axes.axvline(limit["measured"] * panel.scale[0], **style.DOTTED)
    axes.set_xscale("log" if "x" in panel.log else "linear")
    axes.set_yscale("log" if "y" in panel.log else "linear")
    axes.set(xlim=(panel.xmin, None), ylim=panel.ylim)
    for name in panel.log:
        _label_decades(axes.xaxis if name == "x" else axes.yaxis)
    axes.set_xlabel(panel.x, fontsize=TEXT_SIZE)
    axes.set_ylabel(panel.y, fontsize=TEXT_SIZE)
    axes.legend(loc=panel.key, fontsize=TEXT_SIZE, handlelength=1.4, labelspacing=0.2, borderaxespad=0.3)
    lines = [
        sentence(x.text, number, panel.scale[0]) for x, number in zip(panel.sentences, found, strict=True)
    ]
    title = f"{letter}  {panel.title}"
    low, high = (TEXT_LEFT_PT, TEXT_BOTTOM_PT), (TEXT_LEFT_PT, TEXT_BOTTOM_PT + 1 + N_LINES * LINE_PT)
    axes.annotate("\n".join(lines), (0, 1), low, **ABOVE, fontsize=TEXT_SIZE, color=style.VERMILION)
    axes.annotate(title, (0, 1), high, **ABOVE, fontsize=TEXT_SIZE, fontweight="bold")


def _draw_curves(axes: Axes, panel: Panel, curves: pd.DataFrame) -> None:
    name, x, y = curves.columns[:3]
    failing = [curve for curve in curves[name].unique() if curve not in RIGHT and THEORY_OF not in curve]
    color = dict(zip(failing, COLORS, strict=False))
    for curve in curves[name].unique():
        points = curves[curves[name] == curve]
        look = RIGHT.get(curve, {"color": color.get(curve.removeprefix(THEORY_OF), style.GREY)})
        look = {"label": pretty(curve), **look}
        if curve in color and panel.marked:
            look |= {"marker": "o", "markersize": 2.4}
            look |= {"linewidth": 0.6} if panel.joined else {"linestyle": "none"}
        if curve.startswith(THEORY_OF):
            look |= {"linewidth": 0.6, "label": "_"}
        axes.plot(points[x] * panel.scale[0], points[y] * panel.scale[1], drawstyle=panel.drawstyle, **look)


def _label_decades(axis: Axis) -> None:
    """Label the decades of a logarithmic axis; on an axis of few decades label 1, 2 and 5 times them."""
    low, high = sorted(axis.get_view_interval())
    if high < low * FEW_DECADES and low > SHORT:
        axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axis.set_major_formatter(StrMethodFormatter("{x:g}"))
    axis.set_minor_formatter(NullFormatter())


def find_number(
    numbers: pd.DataFrame, mode: str, quantity: str, setting: str = "", method: str = ""
) -> pd.Series:
    """The only number of a mode whose quantity begins so, with a setting and a method if these are given.

    A threshold is of no mode.
    """
    of_mode = numbers["failure_mode"].isna() | (numbers["failure_mode"] == mode)
    found = numbers[of_mode & numbers["quantity"].str.startswith(quantity)]
    for column, wanted in (("setting", setting), ("method", method)):
        found = found[found[column] == wanted] if wanted else found
    if len(found) != 1:
        raise ValueError(f"failures.csv must have one {quantity!r} for {mode}, but has {len(found)}")
    return found.iloc[0]


def sentence(text: str, number: pd.Series, scale: float) -> str:
    """Put a number into its sentence, with powers of ten and the names of variables as mathematics."""
    values = {str(key): value for key, value in number.items()}
    values |= {"at": scale * number["measured"], "theory": scale * number["predicted"]}
    written = pretty(text.format(**values))
    return written.replace("mu_s w", r"$\mu_s w$").replace(" F_X ", " $F_X$ ")


def pretty(text: str) -> str:
    """Write 1e-07 as a power of ten and the names of variables as mathematics."""
    text = text.replace("dt =", r"$\Delta t$ =").replace("theta =", r"$\theta$ =")
    text = text.replace("= -", "= \N{MINUS SIGN}")
    text = re.sub(r"\b1(?:\.0+)?e([-+]\d+)", lambda m: f"$10^{{{int(m[1])}}}$", text)
    return re.sub(r"(\d+(?:\.\d+)?)e([-+]\d+)", lambda m: rf"${m[1]}\times10^{{{int(m[2])}}}$", text)
