"""Fig. 9: the analytical model, a chain of blocks on a rigid plane that is pushed
through a spring."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Rectangle

from precursors.figures import style

# All lengths are mm on paper.
HEIGHT = 43.0
PLANE = 17.0
BLOCK = 9.0
MIDDLE = PLANE + BLOCK / 2
TOP = PLANE + BLOCK
DRIVE = 3.5
TRAILING_EDGE = 24.0
LEADING_EDGE = 75.0
# Left sides of the blocks that are drawn.
BLOCKS = {"1": TRAILING_EDGE, "2": 41.0, "N": LEADING_EDGE - BLOCK}
SECTIONS = 10.5
SMALL = 7.0

FORCE = style.BLACK
MOTION = style.GREY
CENTRED: dict[str, Any] = {"ha": "center", "va": "center"}
BELOW: dict[str, Any] = {"ha": "center", "va": "top", "fontsize": SMALL}
HEAD = {"arrowstyle": "-|>,head_width=0.16,head_length=0.32", "linewidth": 0.9}
TO_THE_POINT = {"shrinkA": 0, "shrinkB": 0}


def draw() -> Figure:
    """Draw the chain of Eqs. 2-8; arrows of forces and positions point to their
    positive sense."""
    with style.page(style.COLUMN_MM, HEIGHT, lay_out=False) as figure:
        axes = figure.add_axes((0, 0, 1, 1))
        axes.set(xlim=(0, style.COLUMN_MM), ylim=(0, HEIGHT))
        axes.set_axis_off()
        _draw_plane(axes)
        _draw_drive(axes)
        for name, left in BLOCKS.items():
            _draw_block(axes, name, left)
        _draw_springs(axes)
        _draw_sections(axes)
    return figure


def _draw_plane(axes: Axes) -> None:
    left = TRAILING_EDGE - 3
    right = LEADING_EDGE + 4
    axes.plot([left, right], [PLANE, PLANE], color=style.BLACK, linewidth=1.0)
    look: dict[str, Any] = {
        "facecolor": "none",
        "edgecolor": style.GREY,
        "hatch": "//////",
        "linewidth": 0,
    }
    axes.add_patch(Rectangle((left, PLANE - 1.8), right - left, 1.8, **look))


def _draw_drive(axes: Axes) -> None:
    axes.add_patch(Circle((DRIVE, MIDDLE), 0.7, color=style.BLACK))
    axes.text(DRIVE, MIDDLE - 1.6, "P", ha="center", va="top")
    _draw_arrow(axes, (DRIVE, MIDDLE + 6), (DRIVE + 6, MIDDLE + 6), MOTION)
    axes.text(DRIVE + 6.6, MIDDLE + 6, "$V$", color=MOTION, va="center")
    _draw_arrow(
        axes, (TRAILING_EDGE - 8, MIDDLE - 3), (TRAILING_EDGE - 0.3, MIDDLE - 3), FORCE
    )
    axes.text(
        TRAILING_EDGE - 8.5, MIDDLE - 3, "$F_X$", color=FORCE, ha="right", va="center"
    )
    _draw_position(axes, DRIVE, "$x_0 = V t$")


def _draw_block(axes: Axes, name: str, left: float) -> None:
    middle = left + BLOCK / 2
    right = left + BLOCK
    look: dict[str, Any] = {
        "facecolor": "#E6E6E6",
        "edgecolor": style.BLACK,
        "linewidth": 0.8,
    }
    axes.add_patch(Rectangle((left, PLANE), BLOCK, BLOCK, **look))
    axes.text(
        middle, PLANE + 0.68 * BLOCK, f"${name}$" if name == "N" else name, **CENTRED
    )
    axes.text(middle, PLANE + 0.30 * BLOCK, "$m$", **CENTRED)
    _draw_arrow(axes, (middle, TOP + 8), (middle, TOP + 0.2), FORCE)
    axes.text(middle + 1, TOP + 6, f"$w_{name}$", color=FORCE, va="center")
    _draw_arrow(axes, (right + 0.4, PLANE + 1.1), (right + 4.8, PLANE + 1.1), FORCE)
    axes.text(
        right + 5.0,
        PLANE + 1.5,
        f"$f_{name}$",
        color=FORCE,
        va="center",
        fontsize=SMALL,
    )
    _draw_position(axes, middle, f"$x_{name}$")


def _draw_position(axes: Axes, origin: float, text: str) -> None:
    height = TOP + 13
    axes.plot([origin, origin], [height - 1.6, height + 1.6], color=MOTION)
    _draw_arrow(axes, (origin, height), (origin + 6, height), MOTION)
    axes.text(origin + 6.6, height, text, color=MOTION, va="center")


def _draw_springs(axes: Axes) -> None:
    """The driving spring, the spring between blocks 1 and 2, and a broken row of
    springs up to block N."""
    _draw_spring(axes, DRIVE, TRAILING_EDGE, "$K$")
    _draw_spring(axes, BLOCKS["1"] + BLOCK, BLOCKS["2"], "$k$")
    left = BLOCKS["2"] + BLOCK
    right = BLOCKS["N"]
    third = (right - left) / 3
    _draw_spring(axes, left, left + third, "$k$")
    axes.text(left + 1.5 * third, MIDDLE, "$\\cdots$", **CENTRED, fontsize=10)
    _draw_spring(axes, right - third, right, "$k$")


def _draw_spring(axes: Axes, left: float, right: float, name: str) -> None:
    n_turns = max(3, round((right - left) / 2.5))
    lead = 0.15 * (right - left)
    x = np.concatenate(
        [[left], np.linspace(left + lead, right - lead, 2 * n_turns + 1), [right]]
    )
    y = np.concatenate([[0], [0], np.tile([1.3, -1.3], n_turns)[:-1], [0], [0]])
    axes.plot(x, MIDDLE + y, color=style.BLACK, solid_joinstyle="round")
    axes.text((left + right) / 2, MIDDLE + 1.9, name, ha="center", va="bottom")


def _draw_sections(axes: Axes) -> None:
    for left, right, text in (
        (DRIVE, TRAILING_EDGE, "loading section"),
        (TRAILING_EDGE, LEADING_EDGE, "material section: $N$ blocks"),
    ):
        both_ways = {"arrowstyle": "<->", "linewidth": 0.6, **TO_THE_POINT}
        axes.annotate("", (left, SECTIONS), (right, SECTIONS), arrowprops=both_ways)
        axes.text((left + right) / 2, SECTIONS - 1, text, **BELOW)
    for edge, text in (
        (TRAILING_EDGE, "trailing edge"),
        (LEADING_EDGE, "leading edge"),
    ):
        axes.plot([edge, edge], [5, PLANE], color=style.GREY, linewidth=0.6)
        axes.text(edge, 4.4, text, **BELOW)
    axes.plot(
        [DRIVE, DRIVE], [SECTIONS - 1, MIDDLE - 5], color=style.GREY, linewidth=0.6
    )


def _draw_arrow(
    axes: Axes, start: tuple[float, float], end: tuple[float, float], color: str
) -> None:
    axes.annotate("", end, start, arrowprops={**HEAD, "color": color, **TO_THE_POINT})
