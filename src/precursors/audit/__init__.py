"""Check independently that a run obeys the equation of motion and Coulomb's law.

No code of the solver is used. The motion between two transitions follows from the
normal modes of the sliding blocks, and the conditions inside the interval are proved
with a bound of the fourth derivative.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from precursors.audit.report import Audit
    from precursors.solver.run import Run

ROUNDINGS = 16.0
"""Tolerance in roundings of a step (see `carried.CarriedState`); it equals the 8 eps
that the solver counts as zero. The largest deviation is 2 in the paper's runs, and 12
in 20,000 random chains."""


def audit(run: Run, roundings: float = ROUNDINGS) -> Audit:
    """Check that a run is a motion of the chain, without the solver's code.

    Inside each interval, sliding blocks must keep the direction of their mode, and
    stuck blocks must stay within +-mu_s w. Excesses above the tolerance are reported,
    and a bound proves that none is above twice the tolerance. At each transition the
    switching rule, the recorded load and the recorded time are checked.

    Parameters
    ----------
    run : Run
        Its chain, start, transitions, intervals, duration and stored states are
        checked. The motion does not depend on the chain's `length` and on
        `evaluations`, so only the checksum of a run file protects them.
    roundings : float
        Tolerance of forces and velocities, in roundings; the default is for exact
        runs.

    Raises
    ------
    TypeError, ValueError
        If `run` is not a run, or `roundings` is not a number above zero.
    """
    from precursors.audit.checks import audit_run  # imported lazily: SciPy is slow

    return audit_run(run, roundings)
