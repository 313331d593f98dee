"""A chain with a length of its own: where creep runs away, and the coefficient into
which it settles."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from precursors.figures import style
from precursors.figures.style import Options

HEIGHT_MM = 74.0
RARE = 0.05  # share of runs, below which their n is not in the title
# Loadings, and share of their colour in a mark, by precursors before a global slip.
MARKERS = {-1: "v", 0: "o", 1: "^"}  # by the sign of theta
FILLS = {0: 0.0, 1: 0.45, 2: 1.0}
# Places of the four pasts about a point of the map: factors of l_c, and of t_v.
PASTS = [(x, y) for y in (0.94, 1.06) for x in (0.98, 1.02)]


def draw(nucleation: pd.DataFrame, settled: pd.DataFrame) -> Figure:
    """Draw l_c and the settled peaks against their theories, and the precursors.

    The tables are larger_nucleation.csv and larger_settled.csv; runs that do not settle
    are left out. Precursors are drawn for the study "map", with the border beyond which
    the law says that none is needed.
    """
    marks = settled.assign(fill=settled["precursors"].round().clip(upper=2))
    on_map = marks[marks["study"] == "map"]
    marks = marks[marks["period"] > 0]
    thetas = sorted(on_map["theta"].unique())
    x = on_map["critical_length"]
    with style.page(style.PAGE_MM, HEIGHT_MM) as figure:
        lengths, peaks, *maps = figure.subplots(
            1, 2 + len(thetas), width_ratios=[1.3, 1.3, *[1] * len(thetas)]
        )
        finest = nucleation["n_blocks"].max()
        _draw_lengths(lengths, nucleation[nucleation["n_blocks"] == finest])
        _draw_peaks(peaks, marks)
        for axes, theta in zip(maps, thetas, strict=True):
            _draw_precursors(axes, on_map[on_map["theta"] == theta])
            axes.set(xlim=(0.8 * x.min(), 1.25 * x.max()), ylim=(7, 600))
            axes.tick_params(labelleft=axes is maps[0])
        maps[0].set_ylabel("$t_v$ [µs]")
        none: Options = {"linestyle": "none"}
        entries = [
            style.mark(
                text, marker=MARKERS[sign], color=style.theta_color(sign), **none
            )
            for sign, text in style.LOADINGS.items()
        ]
        entries += [
            style.mark(
                text,
                marker="o",
                color=style.GREY,
                markerfacecolor=style.pale(style.GREY, FILLS[n]),
                **none,
            )
            for n, text in enumerate(("$n = 0$", "1", "2 or more"))
        ]
        entries.append(style.mark("least $n$ by theory changes", linewidth=0.8))
        style.draw_key(figure, entries, ncols=4)
    return figure


def _look(rows: pd.DataFrame, size: float) -> Options:
    """Marks of rows with one loading and one number of precursors."""
    first = rows.iloc[0]
    color = style.theta_color(first["theta"])
    return {
        "linestyle": "none",
        "marker": MARKERS[int(np.sign(first["theta"]))],
        "markersize": size,
        "markeredgewidth": 0.3,
        "color": color,
        "markerfacecolor": style.pale(color, FILLS[int(first["fill"])]),
    }


def _draw_lengths(axes: Axes, nucleation: pd.DataFrame) -> None:
    for _, rows in nucleation.assign(fill=max(FILLS)).groupby("theta"):
        axes.plot(rows["critical_length"], rows["measured"], **_look(rows, 4.0))
    axes.axline((0, 0), slope=1, color=style.GREY, zorder=1)
    ends = (0.0, 1.1 * nucleation["measured"].max())
    axes.set(xlim=ends, ylim=ends, title="Creep runs away at $l_c$")
    axes.set(xlabel="$l_c/L$, theory", ylabel="length that crept, over $L$")


def _draw_peaks(axes: Axes, marks: pd.DataFrame) -> None:
    for _, rows in marks.groupby([np.sign(marks["theta"]), "fill"]):
        axes.plot(rows["law_coefficient"], rows["coefficient"], **_look(rows, 2.2))
    axes.axline((0.5, 0.5), slope=1, color=style.BLACK, linewidth=0.6)
    axes.set(title="The formula gives the peak")
    axes.set(xlabel="$F_X/F_Z$ by the formula", ylabel="settled peak of $F_X/F_Z$")


def _draw_precursors(axes: Axes, of_loading: pd.DataFrame) -> None:
    drawn = of_loading[of_loading["period"] > 0]
    for _, rows in drawn.groupby(["past", "fill"]):
        right, up = PASTS[rows["past"].iloc[0]]
        x, y = rows["critical_length"], 1e6 * rows["relaxation_time"]
        axes.plot(right * x, up * y, **_look(rows, 1.8))
    lattice = "relaxation_time", "even_length"
    least = of_loading.pivot_table("least", *lattice)
    lengths = of_loading.pivot_table("critical_length", *lattice)
    lengths = lengths.interpolate(axis=1, limit_direction="both")
    times = np.broadcast_to(1e6 * lengths.index.to_numpy()[:, None], lengths.shape)
    axes.contour(lengths, times, least, [0.5, 1.5], colors=style.BLACK)
    shares = drawn["precursors"].round().value_counts(normalize=True)
    common = shares.index[shares > RARE]
    ends = dict.fromkeys([f"{common.min():g}", f"{common.max():g}"])
    theta = style.theta_text(of_loading["theta"].iloc[0])
    axes.set_title(f"{theta}: $n = ${' to '.join(ends)}")
    axes.set(xscale="log", yscale="log", xlabel="$l_c/L$")
    style.set_ticks(axes.xaxis, (0.1, 0.2, 0.4))
    style.set_ticks(axes.yaxis, (10, 20, 50, 100, 200, 400))
