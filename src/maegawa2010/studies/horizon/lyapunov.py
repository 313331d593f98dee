"""The largest Lyapunov exponent of a chain: how fast two nearly equal runs diverge.

The difference is measured between slip events, when all blocks rest and the runs differ
in spring forces only. It leaves out a shift in time and a shift of all blocks with the
drive, because such shifts neither grow nor decay.
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
# Uncertainties are estimated from means over this many stretches of the run.
N_STRETCHES = 20
CONFIDENCE = 0.95
# Share of the run left out at its start, before stick-slip is steady.
TRANSIENT = 0.1
SEED = 2010
# Initial distance of the two runs in units of mu_s F_Z: far above rounding, and so small
# that its growth does not depend on it.
DISTANCE = 1e-9
# A distance that shrinks by more than this factor in one event is lost in rounding.
LEAST = 1e-4


def lyapunov_exponent(run: Run) -> dict[str, float]:
    """Largest Lyapunov exponent of a run, from its distance to a second run (Benettin et
    al. 1980).

    A run in double precision follows the exact one only for a while. After that it is
    another typical run, which is enough for a mean.

    Returns
    -------
    dict
        exponent_per_s; uncertainty_per_s, half the width of its 95 % confidence interval
        by Student's t, from the means over stretches of equally many events; and events,
        the number of events in all stretches.

    Raises
    ------
    ValueError
        If the run has fewer events than stretches, or all differences die out. With one
        block they do, because all its slips end in the same state.
    """
    onset_s, growth = _growth(run)
    steady = np.arange(int(TRANSIENT * len(onset_s)), len(onset_s))
    n_each = (len(steady) - 1) // N_STRETCHES
    if n_each < 1:
        raise ValueError(
            f"the run must have more than {N_STRETCHES} slip events after its transient,"
            f" but has {len(steady)}"
        )
    ends = steady[-1] - n_each * np.arange(N_STRETCHES, -1, -1)
    log = np.diff(growth[ends])
    seconds = np.diff(onset_s[ends])
    rate = log.sum() / seconds.sum()
    left = (log - rate * seconds) / seconds.mean()
    interval = scipy.stats.ttest_1samp(left, 0.0).confidence_interval(CONFIDENCE)
    values = (float(rate), float(interval.high), N_STRETCHES * n_each)
    return dict(zip(COLUMNS, values, strict=True))


def _growth(run: Run) -> tuple[FloatArray, FloatArray]:
    """Onset of each event [s], and the logarithm of the growth of a difference so far.

    Between two events the chain rests, and the drive changes only the force in its own
    spring, so the forces in the other springs determine the future. In each of these
    rests a second run starts at `DISTANCE` from the run. Its distance in the next rest
    gives the growth, and its direction there is the direction of the next start.
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
    """One row per scene, from a run of `duration` [s]; NaN if it has no exponent (one
    block, or few events)."""
    rows = []
    for scene, slider in sliders.items():
        row = {"scene": scene, "theta": slider["theta"]}
        with suppress(ValueError):
            run = simulate(Chain.from_slider(**slider), duration)
            row |= lyapunov_exponent(run)
        rows.append(row)
    return pd.DataFrame(rows, columns=["scene", "theta", *COLUMNS])
