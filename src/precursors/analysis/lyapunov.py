"""The largest Lyapunov exponent of a chain: how fast two runs that all but agree come apart.

A chain at rest at the onset of a slip comes to rest again, and is loaded to the onset of the next. There, a
difference of two runs is one of spring forces. Neither a shift in time nor one of all blocks with the drive,
which neither grow nor decay, is a difference of forces at the onset: no neutral direction is left to mislead.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.stats import t as student_t

from precursors.analysis.tangent import Tangent, trajectory_of
from precursors.model.chain import whole
from precursors.solver import kernel
from precursors.solver.run import Run

# Uncertainties come from means over so many stretches of the run.
N_STRETCHES = 20
CONFIDENCE = 0.95
# Part of the run left out at its start, in which the chain comes to its state of sliding on and on.
TRANSIENT = 0.1
SEED = 2010


@dataclass(frozen=True)
class LyapunovExponent:
    """Mean rate of growth of the logarithm of a small difference.

    Attributes
    ----------
    per_second, per_second_uncertainty : float
        Largest exponent [1/s] and half the width of its 95 % confidence interval.
    per_transition, per_transition_uncertainty : float
        The same for one transition [1].
    n_events, n_transitions : int
        Slip events and transitions averaged over.
    start, end : float
        Onsets [s] between which was averaged.
    """

    per_second: float
    per_second_uncertainty: float
    per_transition: float
    per_transition_uncertainty: float
    n_events: int
    n_transitions: int
    start: float
    end: float


def lyapunov_exponent(
    run: Run, n_stretches: int = N_STRETCHES, transient: float = TRANSIENT
) -> LyapunovExponent:
    """Largest Lyapunov exponent of a run, from the growth of one tangent vector (Benettin et al. 1980).

    A run in double precision follows the exact one only so far; beyond, it is a typical run, as good for a
    mean. The uncertainty comes from the means over stretches of equally many events, by Student's t.

    Parameters
    ----------
    run : Run
        A long run.
    n_stretches : int
        Number of stretches, at least 2.
    transient : float
        Part of the run's events left out at its start, 0 <= transient < 1.

    Raises
    ------
    ValueError
        If an argument is out of range, the run has fewer events than stretches, or no difference lives on
        (one block: every event ends in the same state).
    """
    n_stretches = whole("n_stretches", n_stretches, at_least=2)
    if not 0.0 <= transient < 1.0:
        raise ValueError(f"transient = {transient!r} is out of range: allowed is 0 <= transient < 1")
    onset, growth = _growth(run)
    kept = np.arange(int(transient * len(onset)), len(onset))
    n_each = (len(kept) - 1) // n_stretches
    if n_each < 1:
        raise ValueError(
            f"the run has {len(kept)} slip events after its transient: needed are more than {n_stretches}"
        )
    ends = kept[-1] - n_each * np.arange(n_stretches, -1, -1)
    log, time, number = (np.diff(x[ends]) for x in (growth, run.transitions["time"][onset], onset))
    per_second, per_second_uncertainty = _mean_rate(log, time)
    per_transition, per_transition_uncertainty = _mean_rate(log, number)
    return LyapunovExponent(
        per_second,
        per_second_uncertainty,
        per_transition,
        per_transition_uncertainty,
        n_events=int(ends[-1] - ends[0]),
        n_transitions=int(number.sum()),
        start=float(run.transitions["time"][onset[ends[0]]]),
        end=float(run.transitions["time"][onset[ends[-1]]]),
    )


def _growth(run: Run) -> tuple[np.ndarray, np.ndarray]:
    """Indices of the transitions that begin an event, and the logarithm of a difference there."""
    system = kernel.scale(run.chain)
    path = trajectory_of(run, system)
    tangent, n = Tangent(system, path), run.chain.n_blocks
    state = np.zeros((2 * n + 4, 1))
    state[1 : n + 1, 0] = np.random.default_rng(SEED).standard_normal(n)
    unchanged = np.zeros((n + 1, 1))
    onset, growth, total = [], [], 0.0
    for k in range(path.n_started, len(path.span)):
        tangent.advance(k, state, unchanged, unchanged)
        if path.mode[k].any():
            continue
        size = tangent.size(k + 1, state)
        if not 0.0 < size < np.inf:
            raise ValueError(f"no difference lives on beyond t = {run.transitions['time'][k]:g} s: N = {n}")
        total += np.log(size)
        state /= size
        onset.append(k)
        growth.append(total)
    return np.array(onset), np.array(growth)


def _mean_rate(log: np.ndarray, length: np.ndarray) -> tuple[float, float]:
    """Total growth over total length, and half the width of its confidence interval, from the stretches."""
    n, rate = len(log), log.sum() / length.sum()
    left = (log - rate * length) / length.mean()
    return float(rate), float(student_t.ppf((1 + CONFIDENCE) / 2, n - 1) * left.std(ddof=1) / np.sqrt(n))
