"""Simulate ensembles of chains on all cores."""

from collections.abc import Iterable, Iterator, Sequence
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from precursors.model.chain import Chain, FloatArray
from precursors.model.checks import Until, whole
from precursors.solver.simulate import (
    OwnSolver,
    checked_end,
    checked_start,
    refuse_for_own,
    run_batch,
)
from precursors.support.compiled import untyped
from precursors.support.waiting import in_threads

# Chains of a batch: many for little work between batches, few for all threads to end
# together.
LARGEST_BATCH = 64
BATCHES_PER_THREAD = 8


def simulate_many(
    chains: Iterable[Any],
    duration: float = 10.0,
    until: Until = None,
    threads: int | None = None,
    start_positions: Sequence[ArrayLike] | None = None,
    start_velocities: Sequence[ArrayLike] | None = None,
    longest_slip: float | None = None,
) -> list[Any]:
    """Run an ensemble on all cores; every run equals that of `simulate`, bit for bit.

    Parameters
    ----------
    chains : iterable of Chain or LargerChain
        The chains, of any lengths.
    duration, until, longest_slip
        As in `simulate`, for all of them.
    threads : int, optional
        Threads to use; by default as many as Numba takes, one for each core of this
        process.
    start_positions, start_velocities : sequence of array_like, optional
        One start for each chain, as in `simulate`.

    Returns
    -------
    list of Run
        In the order of `chains`. How much is done is told at a terminal; after Ctrl-C
        nothing goes on. `TransitionLimitError` if one of them meets the cap of
        `simulate`.
    """
    if isinstance(chains, Chain):
        raise TypeError(
            "what simulate_many runs must be a list of chains, but is a Chain"
        )
    chains = list(chains)
    exact = [c for c in chains if isinstance(c, Chain) or not isinstance(c, OwnSolver)]
    end = checked_end(exact, duration, until, None, longest_slip)
    if len(exact) < len(chains):
        refuse_for_own(start_positions, start_velocities, longest_slip)
    threads = (
        untyped.config.NUMBA_NUM_THREADS
        if threads is None
        else whole("threads", threads)
    )
    positions = _starts("start_positions", start_positions, "m", chains)
    velocities = _starts("start_velocities", start_velocities, "m/s", chains)

    runs: dict[int, Any] = {}

    def run(batch: list[int]) -> None:
        if not _length(chains[batch[0]]):
            runs.update((j, chains[j].simulate(duration, until)) for j in batch)
            return
        made = run_batch(
            [chains[j] for j in batch],
            np.array([positions[j] for j in batch]),
            np.array([velocities[j] for j in batch]),
            end,
        )
        runs.update(zip(batch, made, strict=True))

    tasks = [partial(run, batch) for batch in _batches(chains, threads)]
    in_threads("running", tasks, threads, lambda: len(runs) / len(chains))
    return [runs[j] for j in range(len(chains))]


def _starts(
    name: str,
    values: Sequence[ArrayLike] | None,
    unit: str,
    chains: Sequence[Any],
) -> list[FloatArray]:
    if values is None:
        return [np.zeros(_length(chain)) for chain in chains]
    if len(values) != len(chains):
        raise ValueError(
            f"{name} must be one for each of the {len(chains)} chains, but are {len(values)}"
        )
    return [
        checked_start(f"{name}[{j}]", value, unit, chain)
        for j, (value, chain) in enumerate(zip(values, chains, strict=True))
    ]


def _batches(chains: Sequence[Any], threads: int) -> Iterator[list[int]]:
    """Numbers of chains of equal length, so many at a time as one call of the kernel
    takes."""
    most = min(LARGEST_BATCH, max(1, len(chains) // (threads * BATCHES_PER_THREAD)))
    alike: dict[int, list[int]] = {}
    for j, chain in enumerate(chains):
        alike.setdefault(_length(chain), []).append(j)
    for _, members in sorted(alike.items(), reverse=True):
        for first in range(0, len(members), most):
            yield members[first : first + most]


def _length(chain: object) -> int:
    """Number of blocks; 0 of chains with a solver of their own, which run one by one."""
    return chain.n_blocks if isinstance(chain, Chain) else 0
