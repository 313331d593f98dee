"""How well a run agrees with the proof, transition by transition."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from precursors.accuracy.proof.certificate import Certificate, Enclosure
from precursors.model.chain import FloatArray
from precursors.solver.run import Run


@dataclass(frozen=True, eq=False)
class Agreement:
    """A run beside the proof, up to the first transition of another block or to another mode.

    Attributes
    ----------
    n_agreeing : int
        Transitions whose block and mode are those proved, one after the other.
    lost : float
        Time [s] of the first transition that is proved or found but not both; infinite if there is none.
    time_error, load_error : array, shape (n_agreeing,)
        How far each time [s] and tangential load [N] is, at most, from what is proved.
    """

    n_agreeing: int
    lost: float
    time_error: FloatArray
    load_error: FloatArray


def compare(run: Run, certificate: Certificate) -> Agreement:
    """Compare the transitions of a run with those that are proved, up to the earlier of their ends."""
    end = min(run.duration, float(certificate.proved_until))
    found = run.transitions[run.transitions["time"] <= end]
    proved = [t for t in certificate.transitions if t.time.midpoint <= end]
    pairs = list(zip(found.tolist(), proved, strict=False))
    same = [(block, mode) == (t.block, t.mode) for (_, block, mode, _), t in pairs]
    n = same.index(False) if False in same else len(same)
    rest = [*found["time"][n : n + 1].tolist(), *(float(t.time.midpoint) for t in proved[n : n + 1])]
    return Agreement(
        n_agreeing=n,
        lost=min(rest, default=np.inf),
        time_error=np.array([_distance(time, t.time) for (time, *_), t in pairs[:n]]),
        load_error=np.array([_distance(load, t.tangential_load) for (*_, load), t in pairs[:n]]),
    )


def _distance(number: float, enclosure: Enclosure) -> float:
    return float(abs(Fraction(number) - enclosure.midpoint) + enclosure.radius)
