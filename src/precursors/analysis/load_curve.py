"""Approximate F_X(t) by points that are joined by straight lines."""

from __future__ import annotations

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from precursors.model.chain import FloatArray
from precursors.solver.run import Record, Run

# Largest error: 1/50 of a pixel if a slip of 1 N fills 200 pixels.
TOLERANCE_N = 1e-4
# Largest phase of the fastest vibration between two points: no oscillation is missed.
PHASE_PER_STEP = np.pi / 4
MOST_HALVINGS = 30
# Largest number of points at transitions, and of points while block 1 slides.
MOST_POINTS = 200_000


def load_curve(run: Record) -> tuple[FloatArray, FloatArray]:
    """Return times [s] and loads [N] of points of F_X(t), between which straight lines
    are accurate to `TOLERANCE_N`.

    While block 1 sticks, F_X grows linearly, and only transitions need points. While
    block 1 slides, intervals are halved until the chord between their ends is accurate.
    For a cubic, the error of a chord is at most a quarter of the interval times the
    larger difference between its slope and those of the curve at its ends. If more than
    `MOST_POINTS` are needed, they are thinned, and the curve is only right to the eye.
    """
    if not isinstance(run, Run):
        raise TypeError(f"load_curve needs a Run, but got {type(run).__name__}")
    of_first = run.transitions[run.transitions["block"] == 1]
    slides = np.append(run.chain.weights[0] == 0.0, of_first["mode"] != 0)
    edges = np.concatenate([[0.0], of_first["time"], [run.duration]])
    step = max(
        PHASE_PER_STEP / run.chain.fastest_frequency_bound,
        np.diff(edges)[slides].sum() / MOST_POINTS,
    )
    coarse = [
        np.linspace(start, end, int(np.ceil((end - start) / step)) + 1)
        for start, end in zip(edges[:-1][slides], edges[1:][slides], strict=True)
    ]
    times = np.unique(
        np.concatenate(
            [[0.0, run.duration], _visible(run.transitions)["time"], *coarse]
        )
    )
    loads, slopes = _loads_and_slopes(run, times)
    before = np.searchsorted(of_first["time"], times[:-1], side="right")
    begin = np.flatnonzero(slides[before])
    for _ in range(MOST_HALVINGS):
        interval = times[begin + 1] - times[begin]
        chord = (loads[begin + 1] - loads[begin]) / interval
        turn = np.maximum(
            np.abs(slopes[begin] - chord), np.abs(slopes[begin + 1] - chord)
        )
        begin = begin[interval * turn / 4 > TOLERANCE_N]
        if not len(begin) or len(times) > MOST_POINTS:
            break
        middle = (times[begin] + times[begin + 1]) / 2
        load, slope = _loads_and_slopes(run, middle)
        times = np.insert(times, begin + 1, middle)
        loads = np.insert(loads, begin + 1, load)
        slopes = np.insert(slopes, begin + 1, slope)
        begin = np.add.outer(begin + np.arange(len(begin)), [0, 1]).ravel()
    return times, loads


def load_trace(run: Record) -> pd.DataFrame:
    """Return the points of `load_curve` as a table."""
    times, loads = load_curve(run)
    return pd.DataFrame({"time_s": times, "tangential_load_N": loads})


def _visible(transitions: NDArray[np.void]) -> NDArray[np.void]:
    """Return all transitions, or enough of them for the same picture.

    If there are too many, each pixel of time keeps the first, the last, and those with
    the least and the largest load (Jugel et al., 2014).
    """
    if len(transitions) <= MOST_POINTS:
        return transitions
    pixels = np.floor(MOST_POINTS / 4 * transitions["time"] / transitions["time"][-1])
    loads = pd.Series(transitions["tangential_load"]).groupby(pixels)
    ends = [loads.head(1).index, loads.tail(1).index]
    return transitions[
        np.unique(np.concatenate([*ends, loads.idxmin(), loads.idxmax()]))
    ]


def _loads_and_slopes(run: Run, times: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return F_X [N] and dF_X/dt = K (V - v_1) [N/s] at some times [s]."""
    loads, velocities = run.forces_and_velocities(times, 1)[..., 0]
    slopes = run.chain.drive_stiffness * (run.chain.drive_velocity - velocities)
    return loads, slopes
