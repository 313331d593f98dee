"""Draw any figure of a run with one call: compute its tables and pass them to the
module of the figure."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from os import PathLike
from pathlib import Path
from typing import Any, Literal, overload

import pandas as pd
from matplotlib.figure import Figure
from numpy.typing import ArrayLike

from precursors.analysis.load_curve import load_trace
from precursors.analysis.slips import slip_table
from precursors.figures import precursor_lengths, push, scene, wave
from precursors.figures.style import LOOK, Look, Measured
from precursors.figures.wave import Movie
from precursors.model.checks import number_array, positive
from precursors.solver.run import Record, Run
from precursors.support.files import AnyPath
from precursors.support.measured import LENGTH, LOAD, TIME, Quantity, read_series

Table = AnyPath | pd.DataFrame
# Quantities that may be measured for each figure: on the horizontal axis, then on the
# vertical one.
AXES: dict[str, tuple[Quantity, ...]] = {
    "load": (TIME, LOAD, LENGTH),
    "curve": (TIME, LOAD),
    "lengths": (LOAD, LENGTH),
    "push": (),
    "wave": (),
}


@overload
def plot(run: Record, figure: Literal["wave"]) -> Movie: ...
@overload
def plot(
    run: Record,
    figure: Literal["load", "curve", "lengths", "push"] = "load",
    data: ArrayLike | Table | Sequence[Table | Measured] | None = None,
    title: str | None = None,
    look: Look | Mapping[str, Any] = LOOK,
    events: Sequence[int] = (),
) -> Figure: ...
def plot(
    run: Record,
    figure: str = "load",
    data: ArrayLike | Table | Sequence[Table | Measured] | None = None,
    title: str | None = None,
    look: Look | Mapping[str, Any] = LOOK,
    events: Sequence[int] = (),
) -> Figure | Movie:
    """Draw one of five figures of a run.

    Parameters
    ----------
    run : Run
        The run; a `Record` is enough for "lengths".
    figure : "load", "curve", "lengths", "push" or "wave"
        - "load": tangential load and slip events over time, as in Figs. 10-12.
        - "curve": the tangential load alone.
        - "lengths": front lengths against the tangential load, as in Fig. 13.
        - "push": spring forces before and after two precursors and the global slip.
        - "wave": an animated SVG of these events, which takes no other parameter.
    data : array of shape (n, 2), table (DataFrame or path) or list of tables, optional
        Measured t [s] and F_X [N] to draw as well; for "lengths" F_X [N] and L_p/L. For
        "load", a table may also have L_p over t. The key states the distance from the
        run.
    title : str, optional
        Replaces the default title.
    look : Look or dict, optional
        `width_mm`, `font_size` [pt] and `font`.
    events : sequence of int, optional
        Numbers, from 1, of the slip events to show with "push".

    Returns
    -------
    matplotlib.figure.Figure, or Movie for a wave
        Its method `savefig` writes a file.

    Raises
    ------
    ValueError
        If there is no such figure or event, if the figure needs a `Run`, or if it does
        not take one of the other arguments.
    """
    if figure not in AXES:
        raise ValueError(f"figure must be one of {', '.join(AXES)}, but is {figure!r}")
    look = Look(**look) if isinstance(look, Mapping) else look
    if events and figure != "push":
        raise ValueError("only a push takes events")
    if figure != "lengths" and not isinstance(run, Run):
        raise ValueError(f"a {figure} needs a Run, but this is a Record")
    measured = [] if data is None else _measured(data, figure, run)
    slips = slip_table(run)
    if figure == "push":
        return push.draw(run, slips, events, title, look)
    if figure == "wave":
        if title is not None or look != LOOK:
            raise ValueError("a wave takes no title or look")
        return wave.draw(run, slips)
    if figure == "lengths":
        weights = run.chain.weights
        return precursor_lengths.draw([slips], measured, title or "", look, weights)
    title = f"N = {run.chain.n_blocks}" if title is None else title
    if figure == "curve":
        return scene.draw_curve(slips, load_trace(run), title, measured, look)
    in_metres = [
        replace(each, points=each.points * [1.0, run.chain.length])
        if each.are_lengths
        else each
        for each in measured
    ]
    return scene.draw(slips, load_trace(run), title, in_metres, look)


def axes_of(figure: str) -> tuple[Quantity, ...]:
    """Return the quantities that may be measured for a figure, see `AXES`."""
    if not AXES[figure]:
        raise ValueError(f"a {figure} takes no data")
    return AXES[figure]


def read_measured(
    source: Table,
    figure: str,
    run: Record,
    sample_rate: float | None = None,
    data_start: float | None = None,
    data_offset: float | None = None,
    **how: Any,
) -> list[Measured]:
    """Read the measured series of a table for a figure of a run.

    Times are shifted to the start of the run, and the offset of F_X is subtracted.

    Parameters
    ----------
    sample_rate : float, optional
        Rate [Hz] of a table without times.
    data_start, data_offset : float, optional
        Time in the table at which the run starts [s], and F_X there at no load [N].
    how
        As for `read_series`.
    """
    x, *ys = axes_of(figure)
    if sample_rate is not None:
        positive("sample_rate", sample_rate, "Hz")
    name = Path(source).name if isinstance(source, (str, PathLike)) else "measured"
    measured = []
    for y, points in read_series(
        source, x, ys, run.chain.length, sample_rate=sample_rate, **how
    ):
        if data_offset is not None and LOAD in (x, y):
            points[:, (x, y).index(LOAD)] -= data_offset
        if data_start is not None:
            points[:, 0] -= data_start
        after = points if data_start is None else points[points[:, 0] >= 0]
        if not len(after):
            raise ValueError(f"{name} ends before the start of the run")
        measured.append(Measured(name, after, y is LENGTH))
    return measured


def _measured(data: Any, figure: str, run: Record) -> list[Measured]:
    """Read measured points from a table, a list of tables, or an array."""
    axes_of(figure)
    kinds = (str, PathLike, pd.DataFrame, Measured)
    tables = [data] if isinstance(data, kinds) else data
    if isinstance(tables, list) and all(isinstance(each, kinds) for each in tables):
        read = [
            [each] if isinstance(each, Measured) else read_measured(each, figure, run)
            for each in tables
        ]
        return [each for of_table in read for each in of_table]
    points = number_array("data", data, "SI units")
    if points.ndim != 2 or points.shape[1] != 2:
        raise ValueError(f"data must have two columns, but have shape {points.shape}")
    return [Measured("measured", points, figure == "lengths")]
