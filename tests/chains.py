"""Chains and starts that several numerical tests use."""

import numpy as np

from precursors import Chain, Run, TransitionLimitError, simulate
from precursors.accuracy.audit import Audit, audit
from precursors.model.statics import balance_matrix, positions_from_compressions

SLIDER = Chain.from_slider


def first_transitions(chain: Chain, most: int, **options) -> Run:
    """The run, or its first `most` transitions."""
    try:
        return simulate(chain, max_transitions=most, **options)
    except TransitionLimitError as limit:
        return limit.run


def audited(run: Run) -> Audit:
    """Demand that the run is a motion of the model."""
    report = audit(run)
    report.raise_if_failed()
    return report


def positions_under(chain: Chain, forces) -> np.ndarray:
    """Positions [m] in which the springs push each block with a given net force [N]."""
    return positions_from_compressions(np.linalg.solve(balance_matrix(chain), np.asarray(forces, float)))


def releases(run: Run) -> np.ndarray:
    """Time of the first release of each block [s], NaN for a block that never slid."""
    first = np.full(run.chain.n_blocks, np.nan)
    for time, block, mode, _ in run.transitions[::-1].tolist():
        if mode:
            first[block - 1] = time
    return first
