"""What the explorer shows of a run, computed where something happens: points of F_X(t), slides of blocks."""

from __future__ import annotations

import numpy as np
import pandas as pd

from precursors.chain import FloatArray
from precursors.run import Run

# A fiftieth of a pixel where a slip of 1 N fills 200 pixels.
TOLERANCE_N = 1e-4
# A quarter of the shortest period of the paper's chain: no wiggle fits between the first points.
PHASE_PER_SEGMENT = np.pi / 2
PROBES = (0.25, 0.5, 0.75)
MOST_HALVINGS = 30


def load_curve(run: Run, tolerance: float = TOLERANCE_N) -> tuple[FloatArray, FloatArray]:
    """Points [s], [N] between which F_X(t) is a straight line to within a tolerance.

    Intervals are halved until they are straight. While block 1 sticks F_X grows linearly, so that there are
    points only at the transitions; while it slides there are as many as the curve needs.

    Parameters
    ----------
    run : Run
        The run.
    tolerance : float
        Largest deviation of the curve from the straight lines [N].
    """
    times = np.unique(np.concatenate([[0.0, run.duration], run.transitions["time"], *_coarse_points(run)]))
    loads = run.tangential_load(times)
    start, end = times[:-1], times[1:]
    for _ in range(MOST_HALVINGS):
        inside = start + np.multiply.outer(PROBES, end - start)
        exact = run.tangential_load(inside.ravel()).reshape(inside.shape)
        bent = (np.abs(exact - np.interp(inside, times, loads)) > tolerance).any(axis=0)
        if not bent.any():
            break
        middle = inside[1][bent]
        times, loads = np.append(times, middle), np.append(loads, exact[1][bent])
        order = np.argsort(times, kind="stable")
        times, loads = times[order], loads[order]
        start, end = np.concatenate([start[bent], middle]), np.concatenate([middle, end[bent]])
    return times, loads


def find_slides(run: Run, onsets: FloatArray) -> pd.DataFrame:
    """Every slide of a block: from the transition that starts it to the block's next one.

    Parameters
    ----------
    run : Run
        The run.
    onsets : array
        Onset of each slip event [s], in order.

    Returns
    -------
    DataFrame
        event (from 1), block (1..N), mode (+1, -1), start, end [s], load (F_X at the start) [N].
    """
    transitions = run.transitions
    order = np.lexsort((np.arange(len(transitions)), transitions["block"]))
    same = np.append(np.diff(transitions["block"][order]) == 0, False)
    end = np.empty(len(transitions))
    end[order] = np.where(same, np.append(transitions["time"][order][1:], np.nan), run.duration)
    slides = transitions["mode"] != 0
    start = transitions["time"][slides]
    return pd.DataFrame(
        {
            "event": np.searchsorted(onsets, start, side="right").astype(np.int32),
            "block": transitions["block"][slides],
            "mode": transitions["mode"][slides].astype(np.int32),
            "start": start,
            "end": end[slides],
            "load": transitions["tangential_load"][slides],
        }
    )


def _coarse_points(run: Run) -> list[FloatArray]:
    """Times [s] inside the slides of block 1, so close that the fastest motion of the chain shows."""
    chain = run.chain
    fastest = np.sqrt((4 * chain.stiffness + chain.drive_stiffness) / chain.mass)
    step = PHASE_PER_SEGMENT / fastest
    first = run.transitions[run.transitions["block"] == 1]
    ends = np.append(first["time"][1:], run.duration)
    return [
        np.linspace(start, end, int(np.ceil((end - start) / step)) + 1)
        for start, end, mode in zip(first["time"], ends, first["mode"], strict=False)
        if mode != 0
    ]
