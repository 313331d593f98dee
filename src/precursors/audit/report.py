"""The outcome of an audit: a motion of the model, or what exceeds its tolerance."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from precursors.audit.checks import Auditor
from precursors.model.checks import positive
from precursors.solver.run import Run


@dataclass(frozen=True)
class Audit:
    """Outcome of an audit: what exceeds its tolerance, in at most `checks.MAX_PROBLEMS`
    short sentences.

    `roundings` is the largest deviation of a force, a velocity or the energy, in
    roundings; `energy_residual` is the work of the drive minus change of energy minus
    friction heat, relative to what was turned over. `is_undecided` says that no more was
    found than that the audit would take too much work: that is the one problem.
    """

    roundings: float = math.nan
    energy_residual: float = math.nan
    n_intervals: int = 0
    problems: tuple[str, ...] = ()
    is_undecided: bool = False

    @property
    def ok(self) -> bool:
        """Whether the run is a motion of the model within the tolerances."""
        return not self.problems

    def raise_if_failed(self) -> None:
        """Raise an ArithmeticError that lists the problems, if there are any."""
        if self.problems:
            raise ArithmeticError(str(self))

    def __str__(self) -> str:
        verdict = (
            "a motion" if self.ok else f"no motion ({len(self.problems)} problems)"
        )
        answer = f"The run is {verdict} of the model"
        if self.is_undecided:
            answer = "It is undecided whether the run is a motion of the model"
        summary = (
            f"{answer}: {self.n_intervals} intervals audited, "
            f"{self.roundings:.1f} roundings off at most, energy balanced to {self.energy_residual:.1e}."
        )
        return "\n".join([summary, *self.problems])


def audit_run(run: Run, roundings: float) -> Audit:
    """Audit a run: see `precursors.audit`."""
    if not isinstance(run, Run):
        raise TypeError(f"what is audited must be a Run, but is {type(run).__name__}")
    positive("roundings", roundings, "1")
    malformed = _malformed(run)
    if malformed:
        return Audit(problems=(malformed,))
    auditor = Auditor(run, roundings)
    auditor.walk()
    return Audit(
        auditor.most,
        auditor.energy_residual,
        auditor.n_audited,
        tuple(auditor.problems),
        auditor.is_undecided,
    )


def _malformed(run: Run) -> str:
    """Say why the arrays of a run cannot be audited at all, or nothing."""
    n = run.chain.n_blocks
    n_transitions = len(run.transitions)
    if len(run.intervals) != n_transitions + 1:
        return (
            f"{n_transitions} transitions need {n_transitions + 1} intervals, "
            f"the run has {len(run.intervals)}"
        )
    block = run.transitions["block"]
    mode = run.transitions["mode"]
    wrong = np.flatnonzero((block < 1) | (block > n) | (mode < -1) | (mode > 1))
    if wrong.size:
        k = wrong[0]
        return f"transition {k} has block {block[k]}, mode {mode[k]}: there is no such block or mode"
    return ""
