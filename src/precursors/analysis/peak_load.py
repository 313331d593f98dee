"""The largest tangential load of a run, also where stuck blocks swing on the springs of the interface."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pandas as pd

from precursors.model.chain import Chain, FloatArray
from precursors.solver.run import Run

# A quarter of the shortest period of the chain: no wiggle fits between two samples.
PHASE_PER_SAMPLE = np.pi / 2
# Samples from which the swing of a rest is known, and by how much it may be larger later on.
FIRST_SAMPLES, SAFETY = 128, 2.0
SAMPLES_PER_WINDOW = 1024
# So many of the highest samples are followed to the maximum beside them, by a grid within a grid.
CANDIDATES, GRID, ZOOMS = 32, 17, 6


def largest_load(run: Run, slips: pd.DataFrame, until: float) -> tuple[float, float]:
    """Time [s] and value [N] of the largest F_X up to the onset `until` of a slip [s].

    dF_X/dt = K (V - v_1). On a rigid interface F_X is largest where block 1 begins to slide, or sticks after
    it slid backward: at a transition, to within V. On an elastic one stuck blocks swing too: there F_X is
    sampled, and followed to where v_1 = V.

    Parameters
    ----------
    run : Run
        The run; with stored states if its interface is elastic.
    slips : DataFrame
        Its slip events, see `find_slips`.
    until : float
        The last time that counts [s].
    """
    up_to = run.transitions[run.transitions["time"] <= until]
    peak = up_to[np.argmax(up_to["tangential_load"])]
    time, load = float(peak["time"]), float(peak["tangential_load"])
    if not run.chain.interface_stiffness:
        return time, load
    climbed_time, climbed_load = _climb(run, _high_samples(run, slips, until, load), until)
    return (climbed_time, climbed_load) if climbed_load > load else (time, load)


def longest_step(chain: Chain) -> float:
    """Longest time [s] between two samples of F_X that misses no wiggle."""
    return PHASE_PER_SAMPLE / chain.fastest_frequency_bound


def sample_times(start: float, end: float, step: float) -> FloatArray:
    """Times [s] from start to end, at most a step apart."""
    return np.linspace(start, end, int(np.ceil((end - start) / step)) + 1)


def find_rests(slips: pd.DataFrame, until: float) -> FloatArray:
    """Start and end [s] of the times up to `until` in which nothing slides, shape (n, 2)."""
    start = np.append(0.0, slips["end"].to_numpy())
    end = np.append(slips["onset"].to_numpy(), until)
    rests = np.column_stack([start, np.minimum(end, until)])
    return rests[rests[:, 0] < rests[:, 1]]


def _high_samples(run: Run, slips: pd.DataFrame, until: float, best: float) -> FloatArray:
    """Times [s] of the highest samples of F_X, CANDIDATES at most; `best` [N] is reached already."""
    step = longest_step(run.chain)
    times, loads = [np.empty(0)], [np.empty(0)]
    # The last rests bear the largest loads: what they reach rules the others out.
    for start, end in find_rests(slips, until)[::-1]:
        first = run.tangential_load(sample_times(start, min(start + FIRST_SAMPLES * step, end), step))
        swing = SAFETY * np.ptp(first)
        for sampled in _windows_from_the_end(start, end, step):
            load = run.tangential_load(sampled)
            highest = np.argsort(load)[-CANDIDATES:]
            times.append(sampled[highest])
            loads.append(load[highest])
            best = max(best, float(load.max()))
            # What comes earlier swings about a lower line.
            if load.max() + swing < best:
                break
    finished = slips[slips["end"] <= until]
    for onset, end in zip(finished["onset"], finished["end"], strict=True):
        times.append(sample_times(onset, end, step))
        loads.append(run.tangential_load(times[-1]))
    highest = np.argsort(np.concatenate(loads))[-CANDIDATES:]
    return np.concatenate(times)[highest]


def _windows_from_the_end(start: float, end: float, step: float) -> Iterator[FloatArray]:
    """Sampled times [s] of a rest, piece by piece, the last piece first."""
    span = step * SAMPLES_PER_WINDOW
    while end > start:
        yield sample_times(max(start, end - span), end, step)
        end -= span


def _climb(run: Run, times: FloatArray, until: float) -> tuple[float, float]:
    """Time [s] and value [N] of the largest F_X within a step of some times."""
    left, right = times - longest_step(run.chain), times + longest_step(run.chain)
    for _ in range(ZOOMS):
        grid = np.clip(np.linspace(left, right, GRID), 0.0, until)
        load = run.tangential_load(grid.ravel()).reshape(grid.shape)
        top = load.argmax(axis=0)
        column = np.arange(len(times))
        left = grid[np.maximum(top - 1, 0), column]
        right = grid[np.minimum(top + 1, GRID - 1), column]
    place = np.unravel_index(load.argmax(), load.shape)
    return float(grid[place]), float(load[place])
