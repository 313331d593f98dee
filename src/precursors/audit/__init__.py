"""An independent check that a run is a motion of the model: equation of motion and
Coulomb's law.

Nothing of the solver is used. Every interval between two transitions is propagated by
the normal modes of the sliding blocks. What must hold inside it is proved with a bound
on the fourth derivative.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from precursors.audit.report import Audit
    from precursors.solver.run import Run

ROUNDINGS = 16.0
"""Tolerance in roundings of a step (see `carried.CarriedState`), which are the 8 eps
that the solver counts as zero. Deviations come to 2 in the paper's runs, and to 12 in
20,000 random chains."""


def audit(run: Run, roundings: float = ROUNDINGS) -> Audit:
    """Check that a run is a motion of the chain, without the solver's code.

    Inside each interval sliding blocks must keep the direction of their mode and stuck
    blocks must stay within +-mu_s w: excesses beyond the tolerance are reported where
    they are found, and a bound proves that there is none of more than twice the
    tolerance. At each transition the switching rule, the recorded load and the recorded
    time are checked.

    Parameters
    ----------
    run : Run
        Its chain, start, transitions, intervals, duration and stored states are
        checked. No motion contradicts the chain's `length`, nor `evaluations`: the
        checksum of a run file does.
    roundings : float
        Tolerance of forces and velocities, in roundings; the default is for an exact
        run.

    Raises
    ------
    TypeError, ValueError
        If `run` is no run, or `roundings` not a number above zero.
    """
    from precursors.audit.checks import audit_run  # slow: SciPy

    return audit_run(run, roundings)
