"""The failure gallery: a panel for each failure mode."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogFormatterSciNotation

from precursors.figures import style
from precursors.figures.style import Options

HEIGHT_MM = 148.0
MICRO = 1e6
THEORY: Options = {"color": style.GREY, "linewidth": 0.6}
PREDICTED: Options = {"color": style.GREY, "linewidth": 0.6, "linestyle": "--"}
LOOKS: dict[str, Options] = {
    "exact": {"color": style.BLACK},
    "reference": {"color": style.BLACK, "linewidth": 0.6},
}


@dataclass(frozen=True)
class Panel:
    """A panel: its title, its axes, and the thresholds marked on its x axis.

    A threshold is marked by the keys of what fails and of the method.

    `scale` is from the table's x to the axis, `log` names the logarithmic axes,
    and `points` is Matplotlib's format of a failing curve.
    """

    title: str
    x: str
    y: str
    limits: tuple[tuple[str, str], ...] = ()
    scale: float = 1.0
    log: str = ""
    points: str = "o"
    key: Any = "best"
    ylim: tuple[float | None, float | None] = (None, None)


STEP = r"Step $\Delta t$ [$\mu$s]"

PANELS = {
    "unstable": Panel(
        "Steps above the stability limit", STEP, "Energy factor per step [-]",
        limits=(("energy_unbounded", "rk4_skip"), ("energy_unbounded", "leapfrog")), scale=MICRO,
    ),
    "silent_instability": Panel(
        "The same with friction: no warning", STEP, style.MU_SAPP_LABEL,
        limits=(("no_global_slip", "rk4_skip"),), scale=MICRO,
    ),
    "numerical_damping": Panel(
        "Implicit Moreau-Jean damps motion", r"Time [$\mu$s]", "Energy left [-]", scale=MICRO,
        log="y", key="lower left",
    ),
    "literal_friction": Panel(
        "Eq. 4 taken literally never sticks again", "Time [s]", "$F_X$ [N]", points="-",
    ),
    "dead_zone_too_small": Panel(
        "Dead zone too small: jumped over",
        r"Zone / safe width $(\mu_s+\mu_k)\,w\,\Delta t/2m$ [-]", "Transitions right [-]",
        points="o-", key="lower right", ylim=(0.0, None),
    ),
    "dead_zone_too_large": Panel(
        "Dead zone too large: creep inside", "Width of the zone [m/s]", r"$F_X - \mu_s w_1$ at release [N]",
        log="xy",
    ),
    "creep": Panel(
        "Regularised friction creeps in stick", r"Load / $\mu_s w$ [-]", "Velocity [m/s]",
        log="y", key="lower right", ylim=(1e-13, 3e-4),
    ),
    "stiffness": Panel("Regularised friction is stiff", "Width [m/s]", "Fastest rate [1/s]", log="xy"),
    "missed_roots": Panel(
        "DOP853 misses two roots in a step",
        r"Time since the last transition [$\mu$s]", "Block's velocity [m/s]", scale=MICRO, points="o-",
    ),
}  # fmt: skip
CHARTED_BLOCKS = 10


def draw(thresholds: pd.DataFrame, curves: pd.DataFrame) -> Figure:
    """Draw the failure modes, from thresholds.csv and failure_curves.csv."""
    limits = thresholds[thresholds["n_blocks"] == CHARTED_BLOCKS].set_index(
        ["fails", "method"]
    )
    with style.page(style.PAGE_MM, HEIGHT_MM) as figure:
        grid = figure.subplots(3, 3).flat
        for letter, axes, mode in zip("abcdefghi", grid, PANELS, strict=True):
            panel = PANELS[mode]
            _draw_curves(axes, panel, curves[curves["failure_mode"] == mode])
            for limit in panel.limits:
                axes.axvline(panel.scale * limits["predicted"][limit], **PREDICTED)
                axes.axvline(panel.scale * limits["measured"][limit], **style.DOTTED)
            axes.set_title(f"$\\bf{{{letter}}}$  {panel.title}", fontsize="small")
        entries = [
            style.mark("theory, in the colour of the dots", **THEORY),
            style.mark("threshold, predicted", **PREDICTED),
            style.mark("threshold, measured", **style.DOTTED),
        ]
        style.draw_key(figure, entries)
    return figure


def _draw_curves(axes: Axes, panel: Panel, curves: pd.DataFrame) -> None:
    failing = curves.loc[curves["role"] == "failing", "curve"].unique()
    color = dict(zip(failing, 2 * style.OTHERS[:3], strict=False))
    for key, points in curves.groupby(["curve", "role"], sort=False):
        name, role = map(str, key)
        line = {"failing": panel.points, "reference": "--"}.get(role, "-")
        look = LOOKS.get(role, THEORY | {"color": color.get(name, style.GREY)})
        axes.plot(
            points["x"] * panel.scale,
            points["y"],
            line,
            markersize=2.4,
            label="_" if role == "theory" else pretty(name),
            **look,
        )
    axes.set_xscale("log" if "x" in panel.log else "linear")
    axes.set_yscale("log" if "y" in panel.log else "linear")
    # On an axis of less than two decades, some numbers between them have a label.
    axes.yaxis.set_minor_formatter(LogFormatterSciNotation(minor_thresholds=(2, 1)))
    axes.set(ylim=panel.ylim)
    axes.set_xlabel(panel.x, fontsize="small")
    axes.set_ylabel(panel.y, fontsize="small")
    axes.legend(loc=panel.key, fontsize="small", handlelength=1.4, labelspacing=0.2)


def pretty(text: str) -> str:
    """Write dt and 1e-07 as mathematics."""
    text = text.replace("dt =", r"$\Delta t$ =")
    return re.sub(r"([\d.]+)e-0?(\d+)", r"$\1\\times10^{-\2}$", text)
