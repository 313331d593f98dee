"""Figure: the share of right transitions, and whether the paper's count is right, against
the step of RK4."""

import pandas as pd
from matplotlib.figure import Figure

from precursors.figures import style
from precursors.figures.style import Options

HEIGHT_MM = 56.0
POINT: Options = {"linestyle": "none", "markersize": 3}
# Marks, by whether the count of events is right.
LOOKS = {
    True: POINT | {"marker": "o", "color": style.OTHERS[4], "label": "count right"},
    False: POINT | {"marker": "x", "color": style.GREY, "label": "count wrong"},
}


def draw(table: pd.DataFrame) -> Figure:
    """Draw a panel for each scene of step_sweep.csv, in the order of the table."""
    share = table["transitions_right"] / table["transitions_true"]
    scenes = table.assign(percentage=100 * share).groupby("scene", sort=False)
    with style.page(style.PAGE_MM, HEIGHT_MM) as figure:
        panels = style.columns(figure, "Transitions right [%]", len(scenes))
        for axes, (_, rows) in zip(panels, scenes, strict=True):
            exact = rows[rows["method"] == "exact"].iloc[0]
            steps = rows[rows["method"] == "rk4"]
            is_right = steps["events_counted"] == exact["events_counted"]
            for kind, look in LOOKS.items():
                points = steps[is_right == kind]
                axes.plot(points["step_s"], points["percentage"], **look)
            theta = style.theta_text(exact["theta"])
            counts = f"{is_right.sum()} of {len(steps)} counts right"
            sequences = (steps["percentage"] == 100).sum()
            axes.set_title(f"{theta}\n{counts}, {sequences} sequences", pad=3)
            axes.set(xscale="log", ylim=(-4, 104), xlabel=r"Step $\Delta t$ of RK4 [s]")
            axes.minorticks_off()
        style.draw_key(figure)
    return figure
