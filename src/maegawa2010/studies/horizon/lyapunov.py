"""The largest Lyapunov exponent of a chain: how fast two nearly equal runs come
apart.

A difference is measured at the onset of each slip event, when all blocks rest: there it
is one of spring forces alone. A shift in time, or of all blocks with the drive, neither
grows nor decays and is not in it.
"""

from collections.abc import Mapping
from contextlib import suppress
from typing import Any

import numpy as np
import pandas as pd
import scipy

from precursors.analysis.slips import slip_table
from precursors.model.chain import Chain, FloatArray
from precursors.model.statics import positions_from_compressions
from precursors.solver.run import Run
from precursors.solver.simulate import simulate

COLUMNS = ("exponent_per_s", "uncertainty_per_s", "events")
# Uncertainties come from means over so many stretches of the run.
N_STRETCHES = 20
CONFIDENCE = 0.95
# Part of the run left out at its start, before stick-slip has become steady.
TRANSIENT = 0.1
SEED = 2010
# Distance of two runs in units of mu_s F_Z: far above rounding, and so small that it
# grows linearly.
DISTANCE = 1e-9
# A distance that shrinks to less than this in one event is lost in rounding.
LEAST = 1e-4


def lyapunov_exponent(run: Run) -> dict[str, float]:
    """Largest Lyapunov exponent of a run, from the distance of a second one (Benettin
    et al. 1980).

    A run in double precision follows the exact one only for a while. After that it is
    another typical run, which is enough for a mean.

    Returns
    -------
    dict
        exponent_per_s; uncertainty_per_s, half the width of its 95 % confidence
        interval, from the means over stretches of equally many events by Student's t;
        and the number of these events.

    Raises
    ------
    ValueError
        If the run has fewer events than stretches, or all differences die out (one
        block: every event ends in the same state).
    """
    onset_s, growth = _growth(run)
    kept = np.arange(int(TRANSIENT * len(onset_s)), len(onset_s))
    n_each = (len(kept) - 1) // N_STRETCHES
    if n_each < 1:
        raise ValueError(
            f"the run must have more than {N_STRETCHES} slip events after its transient, but has {len(kept)}"
        )
    ends = kept[-1] - n_each * np.arange(N_STRETCHES, -1, -1)
    log = np.diff(growth[ends])
    seconds = np.diff(onset_s[ends])
    rate = log.sum() / seconds.sum()
    left = (log - rate * seconds) / seconds.mean()
    interval = scipy.stats.ttest_1samp(left, 0.0).confidence_interval(CONFIDENCE)
    values = (float(rate), float(interval.high), N_STRETCHES * n_each)
    return dict(zip(COLUMNS, values, strict=True))


def _growth(run: Run) -> tuple[FloatArray, FloatArray]:
    """Onset of each event [s], and the logarithm of how far a difference has grown.

    Between two events the chain rests, and the drive changes nothing but the force in
    its own spring. So the forces in the others say what will happen. From one rest to
    the next a second run starts `DISTANCE` beside the run; how far it is off then is
    the growth, and the direction in which it is off is the next start.
    """
    chain = run.chain
    onset, end = (
        slip_table(run).dropna(subset="end_s")[["onset_s", "end_s"]].to_numpy().T
    )
    rests = (end[:-1] + onset[1:]) / 2.0
    forces = run.spring_forces(rests)
    distance = DISTANCE * chain.strength.sum()
    direction = np.random.default_rng(SEED).standard_normal(chain.n_blocks - 1)
    growth = []
    for before, after, span in zip(forces, forces[1:], np.diff(rests), strict=False):
        start = before.copy()
        start[1:] += distance * direction / np.linalg.norm(direction)
        beside = simulate(
            chain,
            span,
            start_positions=positions_from_compressions(start / chain.springs),
        )
        direction = beside.spring_forces([span])[0, 1:] - after[1:]
        factor = float(np.linalg.norm(direction)) / distance
        if factor < LEAST:
            raise ValueError(
                f"all differences die out within {span:g} s: N = {chain.n_blocks}"
            )
        growth.append(np.log(factor))
    return onset[2:], np.cumsum(growth)


def lyapunov_table(
    sliders: Mapping[str, Mapping[str, Any]], duration: float
) -> pd.DataFrame:
    """One row a scene, from a run of `duration` [s]; NaN where it has no exponent (one
    block, few events)."""
    rows = []
    for scene, slider in sliders.items():
        row = {"scene": scene, "theta": slider["theta"]}
        with suppress(ValueError):
            run = simulate(Chain.from_slider(**slider), duration)
            row |= lyapunov_exponent(run)
        rows.append(row)
    return pd.DataFrame(rows, columns=["scene", "theta", *COLUMNS])
