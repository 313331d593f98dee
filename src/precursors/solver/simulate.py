"""Simulate a chain: find every transition between stick and slip, exact to rounding."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from precursors.model.chain import Chain, FloatArray
from precursors.model.checks import (
    LARGEST,
    Until,
    block_array,
    checked_span,
    whole,
)
from precursors.solver.batch import TransitionLimitError, run_batch
from precursors.solver.kernel import End
from precursors.solver.run import Run

__all__ = ["MAX_TRANSITIONS", "TransitionLimitError", "simulate"]

MAX_TRANSITIONS = 10_000_000
# Chains of more blocks than this are allowed a tenth of `MAX_TRANSITIONS`, because each
# of their transitions takes about ten times as long.
MANY_BLOCKS = 500
# The kernel runs in short windows of time while any block slides. If the blocks hardly
# ever rest, this limit ends the run, for N = 10 after some 10 minutes of computing.
MAX_WINDOWS = 1_000_000_000


def simulate(
    chain: Chain,
    duration: float = 10.0,
    until: Until = None,
    start_positions: ArrayLike | None = None,
    start_velocities: ArrayLike | None = None,
    max_transitions: int | None = None,
) -> Run:
    """Run a chain from rest, or from a given start, through all its transitions (Eqs.
    2-6).

    Parameters
    ----------
    chain : Chain
        The chain.
    duration : float
        Time to run [s]; with `until`, the longest time.
    until : "global slip", optional
        Stop at the end of the first event in which all blocks slide at the same
        instant. Blocks with almost no load do not count (`Chain.bears_load`).
    start_positions, start_velocities : array_like, shape (N,), optional
        Displacements [m] from springs at natural length, and velocities [m/s], at
        time 0; zero by default.
    max_transitions : int, optional
        Largest number of transitions; by default ten million, or one million for more
        than 500 blocks.

    Returns
    -------
    Run
        The transitions and the states between them.

    Raises
    ------
    TransitionLimitError
        If the run reaches `max_transitions`, or takes too long because its blocks
        hardly ever rest. The attribute `run` is the motion up to there.
    """
    end = checked_end([chain], duration, until, max_transitions)
    positions = checked_start("start_positions", start_positions, "m", chain)
    velocities = checked_start("start_velocities", start_velocities, "m/s", chain)
    return next(run_batch([chain], positions[None], velocities[None], end))


def checked_end(
    chains: Sequence[Chain],
    duration: float,
    until: Until,
    max_transitions: int | None,
) -> End:
    """Check the chains and limits of their runs, and return the limits."""
    for chain in chains:
        if not isinstance(chain, Chain):
            raise TypeError(f"simulate needs a Chain, but got {type(chain).__name__}")
    if max_transitions is None:
        has_many = any(chain.n_blocks > MANY_BLOCKS for chain in chains)
        most = MAX_TRANSITIONS // 10 if has_many else MAX_TRANSITIONS
    else:
        most = whole("max_transitions", max_transitions)
    span = checked_span(duration, until)
    return End(span, until is not None, most, MAX_WINDOWS)


def checked_start(
    name: str, values: ArrayLike | None, unit: str, chain: Chain
) -> FloatArray:
    """Check positions or velocities at the start, and return them, by default zero."""
    if values is None:
        return np.zeros(chain.n_blocks)
    start = block_array(name, values, unit)
    if start.shape != (chain.n_blocks,):
        raise ValueError(
            f"{name} must have shape ({chain.n_blocks},), one number [{unit}] per block, "
            f"but have {start.shape}"
        )
    if not (abs(start) <= LARGEST).all():
        raise ValueError(
            f"{name} must be finite, and not beyond {LARGEST:g} {unit}, but are {start}"
        )
    return start
