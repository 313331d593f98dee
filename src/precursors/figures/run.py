"""The figure of a run in one line: its tables are made here, and drawn as those of the
workflow."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from os import PathLike
from typing import Any, Literal, overload

import pandas as pd
from matplotlib.figure import Figure
from numpy.typing import ArrayLike

from precursors.analysis.load_curve import load_trace
from precursors.analysis.slips import slip_table
from precursors.figures import precursor_lengths, push, scene, wave
from precursors.figures.style import LOOK, NO_DATA, Look
from precursors.figures.wave import Movie
from precursors.model.checks import number_array
from precursors.solver.run import Record, Run
from precursors.support.files import AnyPath
from precursors.support.spreadsheet import LENGTH, LOAD, TIME, read_columns

# The axes of each figure, which are the columns of measured data.
AXES = {"load": (TIME, LOAD), "lengths": (LOAD, LENGTH), "push": (), "wave": ()}


@overload
def plot(run: Record, figure: Literal["wave"]) -> Movie: ...
@overload
def plot(
    run: Record,
    figure: Literal["load", "lengths", "push"] = "load",
    data: ArrayLike | pd.DataFrame | AnyPath = NO_DATA,
    title: str | None = None,
    look: Look | Mapping[str, Any] = LOOK,
    events: Sequence[int] = (),
) -> Figure: ...
def plot(
    run: Record,
    figure: str = "load",
    data: ArrayLike | pd.DataFrame | AnyPath = NO_DATA,
    title: str | None = None,
    look: Look | Mapping[str, Any] = LOOK,
    events: Sequence[int] = (),
) -> Figure | Movie:
    """Draw a run: its load and slips over time, its front lengths against the load, or
    two precursors and the first global slip: the push in the springs, or a movie.

    Parameters
    ----------
    run : Run
        The run; of a `Record`, only the lengths are drawn.
    figure : "load", "lengths", "push" or "wave"
        As Figs. 10-12, as Fig. 13, what springs carry, or an animated SVG, which takes
        no other parameter.
    data : array, shape (n, 2), DataFrame or path of a table, optional
        Measured t [s] and F_X [N], or F_X [N] and L_p/L, which are drawn over it, with
        their distance.
    title : str, optional
        By default the number of blocks, or nothing above lengths.
    look : Look or dict, optional
        `width_mm`, `font_size` [pt] and `font`.
    events : sequence of int, optional
        Numbers of the slip events that a push shows instead, from 1.

    Returns
    -------
    matplotlib.figure.Figure, or Movie for a wave
        `savefig` writes it; no state of pyplot is used.

    Raises
    ------
    ValueError
        If there is no such figure or event, if it needs a `Run`, or if a push or a wave
        is asked with data, or a wave with anything.
    """
    if figure not in AXES:
        raise ValueError(f"figure must be one of {', '.join(AXES)}, but is {figure!r}")
    look = Look(**look) if isinstance(look, Mapping) else look
    if events and figure != "push":
        raise ValueError("only a push takes events")
    if figure != "lengths" and not isinstance(run, Run):
        raise ValueError(f"a {figure} needs a Run, but this is a Record")
    if not AXES[figure]:
        if data is not NO_DATA:
            raise ValueError(f"a {figure} takes no data")
        if figure == "push":
            return push.draw(run, slip_table(run), events, title, look)
        if title is not None or look != LOOK:
            raise ValueError("a wave takes no title or look")
        return wave.draw(run, slip_table(run))
    if isinstance(data, (str, PathLike, pd.DataFrame)):
        data = read_columns(data, AXES[figure], length=run.chain.length)
    points = number_array("data", data, "SI units")
    if points.ndim != 2 or points.shape[1] != 2:
        raise ValueError(f"data must have two columns, but have shape {points.shape}")
    slips = slip_table(run)
    if figure == "lengths":
        weights = run.chain.weights
        return precursor_lengths.draw([slips], points, title or "", look, weights)
    title = f"N = {run.chain.n_blocks}" if title is None else title
    return scene.draw(slips, load_trace(run), title, points, look=look)
