"""Fig. 9: the analytical model, a chain of blocks on a rigid plane that is pushed through a spring."""

from __future__ import annotations

from itertools import pairwise

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
DRIVE = 3.5
TRAILING_EDGE = 24.0
SECOND_BLOCK = 41.0
LEADING_EDGE = 75.0
WORDS = 7.0

FORCE = style.VERMILION
MOTION = style.BLUE


def draw_chain_schematic(n_blocks: int = 10) -> Figure:
    """Draw the chain of Eqs. 2-8: drive point, springs, blocks, loads, friction and positions.

    Parameters
    ----------
    n_blocks : int
        Number N of blocks, at least 1; from four on, the first two and the last are drawn.

    Raises
    ------
    ValueError
        If there is no block.

    Notes
    -----
    Fig. 9 of the paper. Arrows of forces and positions point to their positive sense in Eqs. 2-4.
    """
    if n_blocks < 1:
        raise ValueError(f"n_blocks = {n_blocks!r} is out of range: allowed is a whole number >= 1")
    with style.styled():
        figure = style.new_figure(style.COLUMN_MM, HEIGHT)
        axes = figure.add_axes((0, 0, 1, 1))
        axes.set(xlim=(0, style.COLUMN_MM), ylim=(0, HEIGHT))
        axes.set_axis_off()
        blocks = _blocks(n_blocks)
        _draw_plane(axes)
        _draw_drive(axes)
        for name, left, right in blocks:
            _draw_block(axes, name, left, right)
        for (_, _, start), (name, end, _) in pairwise(blocks):
            _draw_coupling(axes, start, end, is_broken=name == "N")
        _draw_sections(axes, n_blocks)
    return figure


def _blocks(n_blocks: int) -> list[tuple[str, float, float]]:
    """Name, left and right side of each block that is drawn; together they always span the same length."""
    if n_blocks == 1:
        return [("1", TRAILING_EDGE, LEADING_EDGE)]
    last = LEADING_EDGE - BLOCK
    if n_blocks <= 3:
        names, lefts = (
            [str(i + 1) for i in range(n_blocks)],
            np.linspace(TRAILING_EDGE, last, n_blocks).tolist(),
        )
    else:
        names, lefts = ["1", "2", "N"], [TRAILING_EDGE, SECOND_BLOCK, last]
    return [(name, left, left + BLOCK) for name, left in zip(names, lefts, strict=True)]


def _draw_plane(axes: Axes) -> None:
    left, right = TRAILING_EDGE - 3, LEADING_EDGE + 4
    axes.plot([left, right], [PLANE, PLANE], color=style.BLACK, linewidth=1.0)
    axes.add_patch(
        Rectangle(
            (left, PLANE - 1.8),
            right - left,
            1.8,
            facecolor="none",
            edgecolor=style.GREY,
            hatch="//////",
            linewidth=0,
        )
    )


def _draw_drive(axes: Axes) -> None:
    axes.add_patch(Circle((DRIVE, MIDDLE), 0.7, color=style.BLACK))
    axes.text(DRIVE, MIDDLE - 1.6, "P", ha="center", va="top")
    _draw_spring(axes, DRIVE, TRAILING_EDGE, "$K$")
    _draw_arrow(axes, (DRIVE, MIDDLE + 6), (DRIVE + 6, MIDDLE + 6), MOTION)
    axes.text(DRIVE + 6.6, MIDDLE + 6, "$V$", color=MOTION, va="center")
    _draw_arrow(axes, (TRAILING_EDGE - 8, MIDDLE - 3), (TRAILING_EDGE - 0.3, MIDDLE - 3), FORCE)
    axes.text(TRAILING_EDGE - 8.5, MIDDLE - 3, "$F_X$", color=FORCE, ha="right", va="center")
    _draw_position(axes, "0", DRIVE)


def _draw_block(axes: Axes, name: str, left: float, right: float) -> None:
    middle, top = (left + right) / 2, PLANE + BLOCK
    axes.add_patch(
        Rectangle(
            (left, PLANE), right - left, BLOCK, facecolor="#E6E6E6", edgecolor=style.BLACK, linewidth=0.8
        )
    )
    axes.text(middle, PLANE + 0.68 * BLOCK, name if name.isdigit() else f"${name}$", ha="center", va="center")
    axes.text(middle, PLANE + 0.30 * BLOCK, "$m$", ha="center", va="center")
    _draw_arrow(axes, (middle, top + 8), (middle, top + 0.2), FORCE)
    axes.text(middle + 1, top + 6, f"$w_{name}$", color=FORCE, va="center")
    _draw_arrow(axes, (right + 0.4, PLANE + 1.1), (right + 4.8, PLANE + 1.1), FORCE)
    axes.text(right + 5.0, PLANE + 1.5, f"$f_{name}$", color=FORCE, va="center", fontsize=WORDS)
    _draw_position(axes, name, middle)


def _draw_position(axes: Axes, name: str, origin: float) -> None:
    height = PLANE + BLOCK + 13
    axes.plot([origin, origin], [height - 1.6, height + 1.6], color=MOTION, linewidth=0.8)
    _draw_arrow(axes, (origin, height), (origin + 6, height), MOTION)
    axes.text(
        origin + 6.6, height, "$x_0 = V t$" if name == "0" else f"$x_{name}$", color=MOTION, va="center"
    )


def _draw_coupling(axes: Axes, left: float, right: float, is_broken: bool) -> None:
    if not is_broken:
        _draw_spring(axes, left, right, "$k$")
        return
    third = (right - left) / 3
    _draw_spring(axes, left, left + third, "$k$")
    axes.text(left + 1.5 * third, MIDDLE, "$\\cdots$", ha="center", va="center", fontsize=10)
    _draw_spring(axes, right - third, right, "$k$")


def _draw_spring(axes: Axes, left: float, right: float, name: str) -> None:
    n_turns = max(3, round((right - left) / 2.5))
    lead = 0.15 * (right - left)
    x = np.concatenate([[left], np.linspace(left + lead, right - lead, 2 * n_turns + 1), [right]])
    y = np.concatenate([[0], [0], np.tile([1.3, -1.3], n_turns)[:-1], [0], [0]])
    axes.plot(x, MIDDLE + y, color=style.BLACK, linewidth=0.8, solid_joinstyle="round")
    axes.text((left + right) / 2, MIDDLE + 1.9, name, ha="center", va="bottom")


def _count(n_blocks: int) -> str:
    if n_blocks > 3:
        return "$N$ blocks"
    return "1 block" if n_blocks == 1 else f"{n_blocks} blocks"


def _draw_sections(axes: Axes, n_blocks: int) -> None:
    height = 10.5
    for left, right, text in (
        (DRIVE, TRAILING_EDGE, "loading section"),
        (TRAILING_EDGE, LEADING_EDGE, f"material section: {_count(n_blocks)}"),
    ):
        axes.annotate(
            "",
            (left, height),
            (right, height),
            arrowprops={"arrowstyle": "<->", "linewidth": 0.6, "shrinkA": 0, "shrinkB": 0},
        )
        axes.text((left + right) / 2, height - 1, text, ha="center", va="top", fontsize=WORDS)
    for edge, text in ((TRAILING_EDGE, "trailing edge"), (LEADING_EDGE, "leading edge")):
        axes.plot([edge, edge], [5, PLANE], color=style.GREY, linewidth=0.6)
        axes.text(edge, 4.4, text, ha="center", va="top", fontsize=WORDS)
    axes.plot([DRIVE, DRIVE], [height - 1, MIDDLE - 5], color=style.GREY, linewidth=0.6)


def _draw_arrow(axes: Axes, start: tuple[float, float], end: tuple[float, float], color: str) -> None:
    axes.annotate(
        "",
        end,
        start,
        arrowprops={
            "arrowstyle": "-|>,head_width=0.16,head_length=0.32",
            "color": color,
            "linewidth": 0.9,
            "shrinkA": 0,
            "shrinkB": 0,
        },
    )
