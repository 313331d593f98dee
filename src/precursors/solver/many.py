"""Simulate ensembles of chains on all cores."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from functools import partial

import numpy as np
from numpy.typing import ArrayLike

from precursors.model.chain import Chain, FloatArray
from precursors.model.checks import Until, whole
from precursors.solver.run import Run
from precursors.solver.simulate import (
    checked_end,
    checked_start,
    run_batch,
)
from precursors.support.compiled import untyped
from precursors.support.waiting import in_threads

# Large batches reduce the work between batches; small ones let all threads end at about
# the same time.
LARGEST_BATCH = 64
BATCHES_PER_THREAD = 8
MOST_THREADS = 1024


def simulate_many(
    chains: Iterable[Chain],
    duration: float = 10.0,
    until: Until = None,
    threads: int | None = None,
    start_positions: Sequence[ArrayLike] | None = None,
    start_velocities: Sequence[ArrayLike] | None = None,
) -> list[Run]:
    """Run many chains on all cores; each run equals that of `simulate` bit for bit.

    Parameters
    ----------
    chains : iterable of Chain
        The chains, which may have different numbers of blocks.
    duration, until
        As in `simulate`, the same for all chains.
    threads : int, optional
        Number of threads, at most 1024; by default one per core of this process, or
        NUMBA_NUM_THREADS.
    start_positions, start_velocities : sequence of array_like, optional
        One start for each chain, as in `simulate`.

    Returns
    -------
    list of Run
        The runs in the order of `chains`. A terminal shows the progress; Ctrl-C stops
        all runs.

    Raises
    ------
    TransitionLimitError
        If a run meets a limit of `simulate`.
    """
    if isinstance(chains, Chain):
        raise TypeError("simulate_many needs a list of chains, but got a Chain")
    chains = list(chains)
    end = checked_end(chains, duration, until, None)
    threads = (
        untyped.config.NUMBA_NUM_THREADS
        if threads is None
        else whole("threads", threads, MOST_THREADS)
    )
    positions = _starts("start_positions", start_positions, "m", chains)
    velocities = _starts("start_velocities", start_velocities, "m/s", chains)

    runs: dict[int, Run] = {}

    def run(batch: list[int]) -> None:
        batch_runs = run_batch(
            [chains[j] for j in batch],
            np.array([positions[j] for j in batch]),
            np.array([velocities[j] for j in batch]),
            end,
        )
        runs.update(zip(batch, batch_runs, strict=True))

    tasks = [partial(run, batch) for batch in _batches(chains, threads)]
    in_threads(tasks, threads)
    return [runs[j] for j in range(len(chains))]


def _starts(
    name: str,
    values: Sequence[ArrayLike] | None,
    unit: str,
    chains: Sequence[Chain],
) -> list[FloatArray]:
    starts = [None] * len(chains) if values is None else values
    if len(starts) != len(chains):
        raise ValueError(
            f"{name} must be one for each of the {len(chains)} chains, but are {len(starts)}"
        )
    return [
        checked_start(f"{name}[{j}]", start, unit, chain)
        for j, (start, chain) in enumerate(zip(starts, chains, strict=True))
    ]


def _batches(chains: Sequence[Chain], threads: int) -> Iterator[list[int]]:
    """Yield batches of indices of chains with the same number of blocks."""
    most = min(LARGEST_BATCH, max(1, len(chains) // (threads * BATCHES_PER_THREAD)))
    by_length: dict[int, list[int]] = {}
    for j, chain in enumerate(chains):
        by_length.setdefault(chain.n_blocks, []).append(j)
    for _, members in sorted(by_length.items(), reverse=True):
        for first in range(0, len(members), most):
            yield members[first : first + most]
