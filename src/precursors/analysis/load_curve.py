"""F_X(t) as points between which straight lines draw it."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pandas as pd

from precursors.analysis.peak_load import find_rests, longest_step, sample_times
from precursors.analysis.slips import find_slips
from precursors.model.chain import FloatArray
from precursors.solver.run import Run

# A fiftieth of a pixel where a slip of 1 N fills 200 pixels.
TOLERANCE_N = 1e-4
# Intervals that are halved on, in steps of `longest_step`: the cubic is right to a thousandth there.
SHARE_OF_STEP = 0.5
MOST_HALVINGS = 30
# A swing between slips is drawn as a band; a run has so many pieces of it, more than a figure has pixels.
BAND_PIECES = 5000
# Forces of so many blocks are held in memory at a time.
BLOCKS_AT_A_TIME = 4_000_000


def load_curve(run: Run, tolerance: float = TOLERANCE_N) -> tuple[FloatArray, FloatArray]:
    """Times [s] and loads [N] between which F_X(t) is a straight line to within a tolerance.

    Intervals are halved until they are straight. On a rigid interface F_X grows linearly while block 1
    sticks, so that there are points only at the transitions; while it slides there are as many as the curve
    needs. On an elastic interface F_X swings between slips too, a hundred thousand times a second: there the
    points are its lowest and highest value in each piece of time, and draw the band that it fills.

    Parameters
    ----------
    run : Run
        The run, with stored states.
    tolerance : float
        Largest deviation of the curve from the straight lines [N], apart from the bands.
    """
    stretches = _curved_stretches(run)
    step = SHARE_OF_STEP * longest_step(run.chain)
    coarse = [sample_times(start, end, step) for start, end in stretches]
    corners = np.concatenate([[0.0, run.duration], run.transitions["time"], *coarse, *_band(run)])
    return _refine(run, np.unique(corners), tolerance, stretches)


def load_trace(run: Run) -> pd.DataFrame:
    """Points of the exact F_X: straight lines between them draw it, see `load_curve`."""
    times, loads = load_curve(run)
    return pd.DataFrame({"time_s": times, "tangential_load_N": loads})


def _curved_stretches(run: Run) -> FloatArray:
    """Start and end [s] of the slides of block 1, of all events on an elastic interface; shape (n, 2)."""
    if run.chain.interface_stiffness:
        slips = find_slips(run)
        return np.column_stack([slips["onset"], slips["end"].fillna(run.duration)])
    first = run.transitions[run.transitions["block"] == 1]
    ends = np.append(first["time"][1:], run.duration)[: len(first)]
    return np.column_stack([first["time"], ends])[first["mode"] != 0]


def _refine(
    run: Run, times: FloatArray, tolerance: float, stretches: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Times [s] with those added that straight lines need inside the stretches, and the loads [N] there.

    Between two points the cubic through both loads and slopes stands for the curve: it leaves the chord by
    no more than a quarter of the interval times the larger difference between the chord's slope and another.
    """
    loads, slopes = _loads_and_slopes(run, times)
    stretch = np.searchsorted(stretches[:, 0], times, side="right") - 1
    # Where a point begins an interval on which the curve bends.
    curved = (stretch >= 0) & (times < np.append(stretches[:, 1], -np.inf)[stretch])
    curved[-1] = False
    begin = np.flatnonzero(curved)
    for _ in range(MOST_HALVINGS):
        interval = times[begin + 1] - times[begin]
        chord = (loads[begin + 1] - loads[begin]) / interval
        turn = np.maximum(np.abs(slopes[begin] - chord), np.abs(slopes[begin + 1] - chord))
        begin = begin[interval * turn / 4 > tolerance]
        if not len(begin):
            break
        middle = (times[begin] + times[begin + 1]) / 2
        halves = _loads_and_slopes(run, middle)
        times = np.insert(times, begin + 1, middle)
        loads, slopes = (
            np.insert(old, begin + 1, new) for old, new in zip((loads, slopes), halves, strict=True)
        )
        begin = np.repeat(begin + np.arange(len(begin)), 2) + np.tile([0, 1], len(begin))
    return times, loads


def _loads_and_slopes(run: Run, times: FloatArray) -> tuple[FloatArray, FloatArray]:
    """F_X [N] and dF_X/dt = K (V - v_1) [N/s] at some times, a part of them at a time."""
    chain = run.chain
    loads, slopes = np.empty(len(times)), np.empty(len(times))
    for part in np.array_split(np.arange(len(times)), len(times) * chain.n_blocks // BLOCKS_AT_A_TIME + 1):
        forces, velocities = run.forces_and_velocities(times[part])
        loads[part] = forces[:, 0]
        slopes[part] = chain.drive_stiffness * (chain.drive_velocity - velocities[:, 0])
    return loads, slopes


def _band(run: Run) -> Iterator[FloatArray]:
    """Times [s] of the lowest and the highest F_X of each piece of the rests on an elastic interface."""
    if not run.chain.interface_stiffness:
        return
    step, longest = longest_step(run.chain), run.duration / BAND_PIECES
    for start, end in find_rests(find_slips(run), run.duration):
        borders = np.linspace(start, end, int(np.ceil((end - start) / longest)) + 1)
        inside = sample_times(0.0, borders[1] - borders[0], step)
        at_a_time = max(BLOCKS_AT_A_TIME // (len(inside) * run.chain.n_blocks), 1)
        for first in range(0, len(borders) - 1, at_a_time):
            pieces = borders[:-1][first : first + at_a_time]
            sampled = np.minimum(np.add.outer(pieces, inside), end)
            load = run.tangential_load(sampled.ravel()).reshape(sampled.shape)
            for extreme in (load.argmin(axis=1), load.argmax(axis=1)):
                yield sampled[np.arange(len(pieces)), extreme]
