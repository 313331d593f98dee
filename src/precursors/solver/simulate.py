"""Simulate a chain exactly: every transition between stick and slip, to rounding."""

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
# Chains of more blocks have long fronts, so a transition takes ten times as long.
MANY_BLOCKS = 500
# Blocks that slide without end would keep the kernel busy forever; this limit is some
# 10 minutes for N = 10.
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
        Positions [m] relative to springs at natural length, and velocities [m/s], at
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
        If the run meets this limit, or the limit of work of a chain that hardly ever
        rests. Its attribute `run` is the motion up to there.
    """
    end = checked_end([chain], duration, until, max_transitions)
    positions = checked_start("start_positions", start_positions, "m", chain)
    velocities = checked_start("start_velocities", start_velocities, "m/s", chain)
    return next(run_batch([chain], positions[None], velocities[None], end))


def checked_end(
    chains: Sequence[Chain],
    duration: float,
    until: Until,
    most: int | None,
) -> End:
    """Check the chains, and return where their runs end."""
    for chain in chains:
        if not isinstance(chain, Chain):
            raise TypeError(f"simulate needs a Chain, but got {type(chain).__name__}")
    if most is None:
        is_long = any(chain.n_blocks > MANY_BLOCKS for chain in chains)
        most = MAX_TRANSITIONS // 10 if is_long else MAX_TRANSITIONS
    else:
        most = whole("max_transitions", most)
    span = checked_span(duration, until)
    return End(span, until is not None, most, MAX_WINDOWS)


def checked_start(
    name: str, values: ArrayLike | None, unit: str, chain: Chain
) -> FloatArray:
    """Return checked positions or velocities at the start, which are zero by
    default."""
    if values is None:
        return np.zeros(chain.n_blocks)
    start = block_array(name, values, unit)
    if start.shape != (chain.n_blocks,):
        raise ValueError(
            f"{name} must have shape ({chain.n_blocks},), one [{unit}] per block, but have {start.shape}"
        )
    if not (abs(start) <= LARGEST).all():
        raise ValueError(
            f"{name} must be finite, and not beyond {LARGEST:g} {unit}, but are {start}"
        )
    return start
