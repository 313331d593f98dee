"""Check independently that a run obeys the equation of motion and Coulomb's law.

No code of the solver is used. The motion between two transitions is computed from the
normal modes of the sliding blocks.
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
    """Check that a run is a motion of its chain, without the solver's code.

    Between transitions, sliding blocks must slide in the direction of their mode, and
    the net force on a stuck block must be within +-mu_s w. An excess above the
    tolerance is reported; a bound proves that no excess above twice the tolerance is
    missed. At each transition, the new mode, the load and the time are checked.

    Parameters
    ----------
    run : Run
        The run. Everything in it is checked but the chain's `length` and
        `evaluations`, on which the motion does not depend.
    roundings : float
        Tolerance of forces and velocities, in roundings of a step; the default is for
        exact runs.

    Returns
    -------
    Audit
        Whether the run is `ok`, and a list of `problems`.

    Raises
    ------
    TypeError, ValueError
        If `run` is not a run, or `roundings` is not a number above zero.
    """
    from precursors.audit.checks import audit_run  # imported lazily: SciPy is slow

    return audit_run(run, roundings)
