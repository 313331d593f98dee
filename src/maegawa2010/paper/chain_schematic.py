"""Fig. 9: the analytical model, a chain of blocks on a rigid plane that is pushed
through a spring."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from precursors.figures import style
from precursors.figures.style import Options

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

CENTRED: Options = {"ha": "center", "va": "center"}
BELOW: Options = {"ha": "center", "va": "top", "fontsize": "small"}
ARROW: Options = {"shrinkA": 0, "shrinkB": 0, "color": style.BLACK}
PUSH = ARROW | {"arrowstyle": "-|>"}
THIN: Options = {"color": style.GREY, "linewidth": 0.6}


def draw() -> Figure:
    """Draw the chain of Eqs. 2-8; arrows of forces and positions point to their
    positive sense."""
    with style.page(style.COLUMN_MM, HEIGHT) as figure:
        axes = figure.subplots()
        axes.set(xlim=(1, style.COLUMN_MM - 1), ylim=(1, HEIGHT - 1), aspect="equal")
        axes.set_axis_off()
        _draw_plane(axes)
        _draw_drive(axes)
        _draw_blocks(axes)
        _draw_springs(axes)
        _draw_sections(axes)
    return figure


def _draw_plane(axes: Axes) -> None:
    ends = [TRAILING_EDGE - 3, LEADING_EDGE + 4]
    axes.plot(ends, [PLANE, PLANE], color=style.BLACK, linewidth=1.0)
    hatched: Options = {"hatch": "//////", "edgecolor": style.GREY, "linewidth": 0}
    axes.fill_between(ends, PLANE - 1.8, PLANE, facecolor="none", **hatched)


def _draw_drive(axes: Axes) -> None:
    axes.plot(DRIVE, MIDDLE, "o", color=style.BLACK)
    axes.text(DRIVE, MIDDLE - 1.6, "P", ha="center", va="top")
    _draw_arrow(axes, DRIVE, MIDDLE + 6, "$V$")
    _draw_position(axes, DRIVE, "$x_0 = V t$")
    height = MIDDLE - 3
    push: Options = {"arrowprops": PUSH, "ha": "right", "va": "center"}
    block = (TRAILING_EDGE - 0.3, height)
    axes.annotate("$F_X$", block, (TRAILING_EDGE - 8, height), **push)


def _draw_blocks(axes: Axes) -> None:
    look: Options = {"facecolor": style.PALE, "edgecolor": style.BLACK}
    lefts = list(BLOCKS.values())
    axes.bar(lefts, BLOCK, BLOCK, PLANE, align="edge", linewidth=0.8, **look)
    press: Options = {"arrowprops": PUSH, "ha": "center"}
    for name, left in BLOCKS.items():
        middle = left + BLOCK / 2
        axes.text(middle, MIDDLE, f"${name}$\n$m$", **CENTRED)
        axes.annotate(f"$w_{name}$", (middle, TOP + 0.2), (middle, TOP + 6), **press)
        right = left + BLOCK + 0.4
        _draw_arrow(axes, right, PLANE + 1.4, f"$f_{name}$", 3.8, style.BLACK)
        _draw_position(axes, middle, f"$x_{name}$")


def _draw_position(axes: Axes, origin: float, text: str) -> None:
    height = TOP + 13
    axes.plot([origin, origin], [height - 1.6, height + 1.6], color=style.GREY)
    _draw_arrow(axes, origin, height, text)


def _draw_arrow(
    axes: Axes,
    x: float,
    y: float,
    text: str,
    length: float = 7.0,
    color: str = style.GREY,
) -> None:
    """Draw an arrow to the right that points to its name."""
    look = ARROW | {"arrowstyle": "<|-", "color": color}
    axes.annotate(
        text, (x, y), (x + length, y), va="center", color=color, arrowprops=look
    )


def _draw_springs(axes: Axes) -> None:
    """The driving spring, the spring between blocks 1 and 2, and a broken row of
    springs up to block N."""
    left = BLOCKS["2"] + BLOCK
    right = BLOCKS["N"]
    third = (right - left) / 3
    axes.text(left + 1.5 * third, MIDDLE, "$\\cdots$", **CENTRED)
    for start, end, name in (
        (DRIVE, TRAILING_EDGE, "$K$"),
        (TRAILING_EDGE + BLOCK, BLOCKS["2"], "$k$"),
        (left, left + third, "$k$"),
        (right - third, right, "$k$"),
    ):
        n_turns = max(3, round((end - start) / 2.5))
        lead = 0.15 * (end - start)
        turns = np.linspace(start + lead, end - lead, 2 * n_turns + 1)
        y = MIDDLE + np.pad(([1.3, -1.3] * n_turns)[:-1], 2)
        axes.plot([start, *turns, end], y, color=style.BLACK)
        axes.text((start + end) / 2, MIDDLE + 1.9, name, ha="center")


def _draw_sections(axes: Axes) -> None:
    both_ways = ARROW | {"arrowstyle": "<->"}
    for left, right, text in (
        (DRIVE, TRAILING_EDGE, "loading section"),
        (TRAILING_EDGE, LEADING_EDGE, "material section: $N$ blocks"),
    ):
        axes.annotate("", (left, SECTIONS), (right, SECTIONS), arrowprops=both_ways)
        axes.text((left + right) / 2, SECTIONS - 1, text, **BELOW)
    axes.vlines(DRIVE, SECTIONS - 1, MIDDLE - 5, **THIN)
    axes.vlines([TRAILING_EDGE, LEADING_EDGE], 5, PLANE, **THIN)
    axes.text(TRAILING_EDGE, 4.4, "trailing edge", **BELOW)
    axes.text(LEADING_EDGE, 4.4, "leading edge", **BELOW)
