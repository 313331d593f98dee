"""Compare a run of any method with the truth: the order, times and loads of its
transitions and slips."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

from precursors.analysis.agreement import agreeing, transitions_right
from precursors.analysis.slips import slip_rows
from precursors.model.chain import Chain, FloatArray
from precursors.solver.record import COLUMNS
from precursors.solver.run import Record

if TYPE_CHECKING:
    from precursors.proof import Certificate

# What Figs. 10-13 show of a slip event besides its time and load.
OUTCOME = ["front", "is_global"]


# Time [s], block 1..N, mode and tangential load [N] of a transition.
Transition = tuple[Fraction, int, int, Fraction]


@dataclass(frozen=True, eq=False)
class Truth:
    """The true transitions: a run with their times and loads rounded to doubles, and
    the rounding remainders.

    `time_rest` [s] and `load_rest` [N], shape (n_transitions,), are the true numbers
    minus the rounded ones.
    """

    run: Record
    time_rest: FloatArray
    load_rest: FloatArray

    @classmethod
    def exact(
        cls, chain: Chain, duration: float, transitions: Sequence[Transition]
    ) -> Truth:
        """Make the truth from all exact transitions up to `duration` [s]."""
        times, blocks, modes, loads = (
            zip(*transitions, strict=True) if transitions else ((),) * 4
        )
        (time, time_rest), (load, load_rest) = _rounded(times), _rounded(loads)
        return cls(
            Record.from_columns(chain, duration, time, blocks, modes, load),
            time_rest,
            load_rest,
        )

    @classmethod
    def proved(cls, certificate: Certificate) -> Truth:
        """Make the truth from a certificate, with the midpoints of its enclosures, up to
        the time to which it is proved."""
        transitions = [
            (t.time.midpoint, t.block, t.mode, t.tangential_load.midpoint)
            for t in certificate.transitions
        ]
        ends_with_slip = certificate.until and transitions and not certificate.tie
        duration = float(
            transitions[-1][0] if ends_with_slip else certificate.proved_until
        )
        return cls.exact(certificate.chain.to_chain(), duration, transitions)

    def until_global_slip(self) -> Truth:
        """Cut the truth as the function `until_global_slip` cuts a run."""
        run = until_global_slip(self.run)
        n = len(run.transitions)
        return Truth(run, self.time_rest[:n], self.load_rest[:n])


@dataclass(frozen=True, eq=False)
class Comparison:
    """Agreement of a run with the truth: how long it lasts, and the errors until then.

    A transition is right if its block and mode are right. A slip event is right if its
    `front` and `is_global` are right. Counting stops at the first
    transition, or slip event, that is wrong or missing. `time_errors` [s] belong to the
    right transitions. `load_error` [N] is the largest error of F_X at the onsets of
    right slips, NaN if there are none. `first_difference` [s] is the time of the first
    transition that is only in the run or only in the truth, infinite if there is none.
    """

    transitions_right: int
    transitions_found: int
    transitions_true: int
    time_errors: FloatArray
    load_error: float
    first_difference: float

    @property
    def time_error(self) -> float:
        """Largest time error of the right transitions [s]; NaN if there are none."""
        return _largest(self.time_errors)


def until_global_slip(run: Record) -> Record:
    """Cut a run at the end of its first global slip, as `simulate(..., until="global
    slip")` does.

    The run is returned unchanged if it has no global slip or ends during it.
    """
    slips = slip_rows(run)
    ends = slips["end_s"][slips["is_global"]]
    end = float(ends[0]) if len(ends) else np.nan
    if np.isnan(end):
        return run
    transitions = run.transitions[run.transitions["time"] <= end]
    columns = (transitions[name] for name in COLUMNS)
    return Record.from_columns(run.chain, end, *columns)


def compare(run: Record, truth: Truth) -> Comparison:
    """Compare a run with the truth over the same time: both must go to the end, or both
    to the first global slip.

    The motion is chaotic. After the first difference, run and truth soon differ as much
    as the motions of two chains. Errors are therefore computed only before it.

    Raises
    ------
    ValueError
        If the chains have different numbers of blocks.
    """
    true_run = truth.run
    if run.chain.n_blocks != true_run.chain.n_blocks:
        raise ValueError(
            f"the run must have as many blocks as the truth, {true_run.chain.n_blocks}, "
            f"but has {run.chain.n_blocks}"
        )
    transitions = run.transitions
    true = true_run.transitions
    n = transitions_right(run, true_run)
    slips = slip_rows(run)
    true_slips = slip_rows(true_run)
    n_slips = agreeing(slips[OUTCOME], true_slips[OUTCOME])
    onsets = np.searchsorted(true["time"], true_slips["onset_s"][:n_slips])
    loads, true_loads = (of["load_before_N"][:n_slips] for of in (slips, true_slips))
    return Comparison(
        transitions_right=n,
        transitions_found=len(transitions),
        transitions_true=len(true),
        time_errors=abs(
            transitions["time"][:n] - true["time"][:n] - truth.time_rest[:n]
        ),
        load_error=_largest(abs(loads - true_loads - truth.load_rest[onsets])),
        first_difference=float(
            min(
                [*transitions["time"][n : n + 1], *true["time"][n : n + 1]],
                default=np.inf,
            )
        ),
    )


def _rounded(numbers: Sequence[Fraction]) -> tuple[FloatArray, FloatArray]:
    """Return the nearest doubles and the remainders, also as doubles."""
    nearest = [float(x) for x in numbers]
    rest = [float(x - Fraction(y)) for x, y in zip(numbers, nearest, strict=True)]
    return np.array(nearest, float), np.array(rest, float)


def _largest(errors: FloatArray) -> float:
    return float(errors.max()) if len(errors) else float("nan")
