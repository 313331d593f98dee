"""The failure gallery: a panel for each failure mode."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullFormatter, StrMethodFormatter

from precursors.figures import style

HEIGHT_MM = 148.0
ROWS = 3
COLUMNS = 3
TEXT_SIZE = 7.0
# A layout made for the longest title would leave no room for the panels.
LAYOUT = {
    "left": 0.07,
    "right": 0.99,
    "bottom": 0.06,
    "top": 0.96,
    "wspace": 0.38,
    "hspace": 0.48,
}
TITLE: dict[str, Any] = {
    "loc": "left",
    "x": -0.18,
    "pad": 5.0,
    "fontsize": TEXT_SIZE,
    "fontweight": "bold",
}
# A logarithmic axis that spans less than this factor, above this number, has decimal
# labels.
FEW_DECADES = 110.0
SHORT = 1e-4
MICRO = 1e6
MILLI = 1e3
DASHED: dict[str, Any] = {
    "color": style.BLACK,
    "linewidth": 0.6,
    "linestyle": (0, (4, 2)),
}

# Curves that fail have these colours in turn, and their theory has the same.
COLORS = 2 * style.OTHERS[:3]
LOOKS: dict[str, dict[str, Any]] = {
    "exact": {"color": style.BLACK},
    "theory": {"color": style.GREY},
    "reference": DASHED,
}


@dataclass(frozen=True)
class Panel:
    """A panel: its title, its axes, and the thresholds marked on its x axis.

    A threshold is marked by the keys of what fails and of the method.

    `scale` is from the table's x and y to the axes, and `log` names the logarithmic
    axes. A failing curve is a line if `joined`, and has markers if `marked`.
    """

    title: str
    x: str
    y: str
    limits: tuple[tuple[str, str], ...] = ()
    scale: tuple[float, float] = (1.0, 1.0)
    log: str = ""
    joined: bool = True
    marked: bool = True
    drawstyle: str = "default"
    key: Any = "best"
    xmin: float | None = None
    ylim: tuple[float | None, float | None] = (None, None)


STEP = r"Step $\Delta t$ [$\mu$s]"
F_X = "$F_X$ [N]"
TIME = "Time [s]"
RIGHT_ONES = "Transitions right [-]"

PANELS = {
    "unstable": Panel(
        "Steps above the stability limit", STEP, "Energy factor per step [-]",
        limits=(("energy_unbounded", "rk4_skip"), ("energy_unbounded", "leapfrog")),
        scale=(MICRO, 1.0), joined=False,
    ),
    "silent_instability": Panel(
        "The same with friction: no warning", STEP, style.MU_SAPP_LABEL,
        limits=(("no_global_slip", "rk4_skip"),), scale=(MICRO, 1.0), joined=False,
    ),
    "numerical_damping": Panel(
        "Implicit Moreau-Jean damps motion", r"Time [$\mu$s]", "Energy left [-]",
        scale=(MICRO, 1.0), key=(0.5, 0.06), joined=False,
    ),
    "literal_friction": Panel("Eq. 4 taken literally never sticks again", TIME, F_X, marked=False),
    "dead_zone_too_small": Panel(
        "Dead zone too small: jumped over",
        r"Zone / safe width $(\mu_s+\mu_k)\,w\,\Delta t/2m$ [-]", RIGHT_ONES,
        log="x", key="lower right", ylim=(0.0, None),
    ),
    "dead_zone_too_large": Panel(
        "Dead zone too large: creep inside", "Width of the zone [m/s]", r"$F_X - \mu_s w_1$ at release [N]",
        log="xy", joined=False,
    ),
    "creep": Panel(
        "Regularised friction creeps in stick", r"Load / $\mu_s w$ [-]", "Velocity [m/s]",
        log="y", joined=False, key="lower right", ylim=(1e-13, 3e-4),
    ),
    "stiffness": Panel(
        "Regularised friction is stiff", "Width [m/s]", "Fastest rate [1/s]", log="xy", joined=False,
    ),
    "missed_roots": Panel(
        "DOP853 misses two roots in a step",
        r"Time since the last transition [$\mu$s]", "Block's velocity [mm/s]", scale=(MICRO, MILLI),
    ),
}  # fmt: skip
CHARTED_BLOCKS = 10


def draw(thresholds: pd.DataFrame, curves: pd.DataFrame) -> Figure:
    """Draw the failure modes, from thresholds.csv and failure_curves.csv."""
    limits = thresholds[thresholds["n_blocks"] == CHARTED_BLOCKS].set_index(
        ["fails", "method"]
    )
    with style.page(style.PAGE_MM, HEIGHT_MM, lay_out=False) as figure:
        grid = figure.subplots(ROWS, COLUMNS).flat
        for letter, axes, mode in zip("abcdefghi", grid, PANELS, strict=True):
            own = curves[curves["failure_mode"] == mode]
            _draw_panel(axes, letter, PANELS[mode], limits, own)
        figure.subplots_adjust(**LAYOUT)
    return figure


def _draw_panel(
    axes: Axes, letter: str, panel: Panel, limits: pd.DataFrame, curves: pd.DataFrame
) -> None:
    _draw_curves(axes, panel, curves)
    for limit in panel.limits:
        axes.axvline(
            panel.scale[0] * limits["predicted"][limit],
            **DASHED | {"color": style.GREY},
        )
        axes.axvline(panel.scale[0] * limits["measured"][limit], **style.DOTTED)
    axes.set_xscale("log" if "x" in panel.log else "linear")
    axes.set_yscale("log" if "y" in panel.log else "linear")
    axes.set(xlim=(panel.xmin, None), ylim=panel.ylim)
    for name in panel.log:
        _label_decades(axes.xaxis if name == "x" else axes.yaxis)
    axes.set_xlabel(panel.x, fontsize=TEXT_SIZE)
    axes.set_ylabel(panel.y, fontsize=TEXT_SIZE)
    axes.legend(
        loc=panel.key,
        fontsize=TEXT_SIZE,
        handlelength=1.4,
        labelspacing=0.2,
        borderaxespad=0.3,
    )
    axes.set_title(f"{letter}  {panel.title}", **TITLE)


def _draw_curves(axes: Axes, panel: Panel, curves: pd.DataFrame) -> None:
    failing = curves.loc[curves["role"] == "failing", "curve"].unique()
    color = dict(zip(failing, COLORS, strict=False))
    for key, points in curves.groupby(["curve", "role"], sort=False):
        name, role = map(str, key)
        look = {"label": pretty(name), **LOOKS.get(role, {})}
        if role == "theory" and name in color:
            look |= {"color": color[name], "linewidth": 0.6, "label": "_"}
        elif role == "failing":
            look |= {"color": color[name]} | _marks(panel)
        axes.plot(
            points["x"] * panel.scale[0],
            points["y"] * panel.scale[1],
            drawstyle=panel.drawstyle,
            **look,
        )


def _marks(panel: Panel) -> dict[str, Any]:
    """Line and markers of a failing curve."""
    if not panel.marked:
        return {}
    line = {"linewidth": 0.6} if panel.joined else {"linestyle": "none"}
    return {"marker": "o", "markersize": 2.4, **line}


def _label_decades(axis: Axis) -> None:
    """Label the decades of a logarithmic axis; on an axis of few decades label 1, 2 and
    5 times them."""
    low, high = sorted(axis.get_view_interval())
    if high < low * FEW_DECADES and low > SHORT:
        axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axis.set_major_formatter(StrMethodFormatter("{x:g}"))
    axis.set_minor_formatter(NullFormatter())


def pretty(text: str) -> str:
    """Write 1e-07 as a power of ten and the names of variables as mathematics."""
    text = text.replace("dt =", r"$\Delta t$ =").replace("theta =", r"$\theta$ =")
    text = text.replace("= -", "= \N{MINUS SIGN}")
    text = re.sub(r"\b1(?:\.0+)?e([-+]\d+)", lambda m: f"$10^{{{int(m[1])}}}$", text)
    return re.sub(
        r"(\d+(?:\.\d+)?)e([-+]\d+)",
        lambda m: rf"${m[1]}\times10^{{{int(m[2])}}}$",
        text,
    )
