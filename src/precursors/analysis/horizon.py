"""Predictability time: until when a run is accurate to a given tolerance.

Rounding errors are carried along by the linearised motion. A few neighbouring runs start from parameters that
are rounded another way, and suffer other roundings of the same size at each transition. Their spread in time
is the error of a transition's time. The order of transitions is known as long as no two of them, and no
transition and one that was only just missed, are closer than their errors.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from precursors.analysis.neighbours import EPS, SIGMAS, Neighbours, Unknown, spread
from precursors.model.chain import FloatArray
from precursors.model.checks import positive
from precursors.solver.run import Run

NEVER = Unknown(np.inf, "")


@dataclass(frozen=True, eq=False)
class PredictedErrors:
    """The errors that a run predicts of itself.

    Attributes
    ----------
    time : array, shape (n_transitions,)
        Times of the transitions [s].
    time_error : array, shape (n_transitions,)
        Error of each time [s]; infinite where the order of transitions is unknown.
    duration : float
        Time that the run reached [s].
    unknown : Unknown
        From when the order of transitions is unknown; `NEVER` if all of it is known.
    """

    time: FloatArray
    time_error: FloatArray
    duration: float
    unknown: Unknown

    def horizon(self, tolerance: float) -> float:
        """Predictability time [s]; see the function `horizon`."""
        positive("tolerance", tolerance, "s")
        wrong = np.flatnonzero((self.time_error > tolerance) & np.isfinite(self.time_error))
        first = np.inf
        if wrong.size:
            # This transition may come earlier by its error, but not before the one ahead of it.
            k = int(wrong[0])
            first = max(self.time[k] - self.time_error[k], self.time[k - 1] if k else 0.0)
        return float(min(first, self.unknown.time, self.duration))


def horizon(run: Run, tolerance: float) -> float:
    """Predictability time [s]: until then transitions are in order, and their times right to a tolerance [s].

    Raises
    ------
    ValueError
        If the tolerance is not positive, or the run has no stored states.
    """
    positive("tolerance", tolerance, "s")
    return predicted_errors(run).horizon(tolerance)


def predicted_errors(run: Run) -> PredictedErrors:
    """Estimate the error of every transition's time, and from when the order of transitions is unknown.

    Counted is the rounding of `simulate`, and that of the parameters. It is an estimate (`certify` gives a
    proof): linear, with roundings drawn at random from a fixed seed. A run and its continuation have the same
    errors as far as both go. The work is proportional to the time that blocks slide, and ends where the order
    is lost.

    Raises
    ------
    ValueError
        If the run has no stored states.
    """
    neighbours = Neighbours(run)
    first, time = neighbours.path.n_started, run.transitions["time"].astype(np.float64)
    error = np.full(len(time), np.inf)
    error[:first] = 0.0
    unknown = neighbours.unknown_at_start() or neighbours.unknown_after(first)
    for k in range(first, len(time)):
        unknown = unknown or neighbours.advance(k)
        if unknown:
            break
        error[k] = SIGMAS * spread(neighbours.clock) + EPS * time[k]
        unknown = neighbours.unknown_after(k + 1)
    unknown = unknown or NEVER
    error[time >= unknown.time] = np.inf
    return PredictedErrors(time, error, run.duration, unknown)
