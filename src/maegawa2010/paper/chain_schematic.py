"""Fig. 9: the model, a chain of blocks on a rigid plane that is pushed through a spring."""

import numpy as np
from matplotlib.figure import Figure

from precursors.figures import style

# Lengths are in mm on paper.
HEIGHT = 38.0
PLANE = 12.0
BLOCK = 9.0
MIDDLE = PLANE + BLOCK / 2
TOP = PLANE + BLOCK
PUSH = TOP - 2.5  # height of the springs
DRIVE = 3.5
EDGES = [24.0, 75.0]  # trailing and leading edge of the slider
BLOCKS = {"1": EDGES[0], "2": 41.0, "N": EDGES[1] - BLOCK}  # their left sides
SPRINGS = {"K": (DRIVE, 24.0), "k": (33.0, 41.0), r"k \;\cdots\; k": (50.0, 66.0)}


def draw() -> Figure:
    """Draw the chain of Eqs. 2-8; arrows of forces and positions point in the positive
    direction."""
    with style.page(style.COLUMN_MM, HEIGHT) as figure:
        axes = figure.subplots()
        axes.set(xlim=(1, style.COLUMN_MM - 1), ylim=(1, HEIGHT - 1), aspect="equal")
        axes.set_axis_off()
        axes.plot([EDGES[0] - 3, EDGES[1] + 4], [PLANE, PLANE], color=style.BLACK)
        axes.plot(DRIVE, PUSH, "o", color=style.BLACK)
        axes.text(DRIVE, PUSH + 3, r"$\longrightarrow V$")
        axes.text(DRIVE, TOP + 11, r"$\mapsto x_0 = V t$")
        axes.text(EDGES[0], PLANE + 1, r"$F_X \longrightarrow$", ha="right")
        for name, left in BLOCKS.items():
            middle = left + BLOCK / 2
            axes.bar(middle, BLOCK, BLOCK, PLANE, color=style.PALE, ec=style.BLACK)
            axes.text(middle, MIDDLE, f"${name}$\n$m$", ha="center", va="center")
            axes.text(middle, TOP + 2, f"$w_{name}$\n$\\downarrow$", ha="center")
            axes.text(middle, TOP + 11, f"$\\mapsto x_{name}$")
            axes.text(left + BLOCK, PLANE + 1, f"$\\rightarrow f_{name}$")
        for name, ends in SPRINGS.items():
            turns = np.linspace(*ends, 17)
            height = PUSH + 1.3 * np.sin(np.pi / 2 * np.arange(17))
            axes.plot(turns, height, color=style.BLACK)
            axes.text(sum(ends) / 2, PUSH + 1.9, f"${name}$", ha="center")
        axes.plot([DRIVE, *EDGES], [7, 7, 7], "|-", color=style.GREY)
        axes.text(DRIVE, 3, "loading section", fontsize="small")
        axes.text(EDGES[0], 3, "material section: $N$ blocks", fontsize="small")
    return figure
