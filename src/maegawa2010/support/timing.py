"""One way to measure time: side by side, in turn, warmed up, medians.

A machine's load changes from second to second, so what is compared is measured in the
same round, one right after the other, and the ratio is the median of the rounds'
ratios. Whoever measures sets OMP_NUM_THREADS and its like to 1 before NumPy is
imported; Snakemake does so for a rule with one thread.
"""

from __future__ import annotations

import gc
import time
from collections.abc import Callable, Hashable, Mapping
from dataclasses import dataclass
from typing import NamedTuple, TypeVar

import numpy as np

Key = TypeVar("Key", bound=Hashable)
T = TypeVar("T")

ROUNDS = 11
# A task is repeated within a round until it takes so long: what the task before it left
# in the processor's caches, and the clock's steps, are then a small part of it.
SHORTEST = 0.01  # s


class Seconds(NamedTuple):
    """Of one call: on the clock, and of processor time of all threads."""

    wall: float
    cpu: float


@dataclass(frozen=True)
class Timing:
    """Seconds per call in each round."""

    rounds: list[Seconds]

    @property
    def seconds(self) -> float:
        """Median on the clock [s]."""
        return float(np.median([of.wall for of in self.rounds]))

    def times_faster_than(self, other: Timing) -> tuple[float, float]:
        """Time of the other over this one, on the clock and in processor time:
        medians of rounds."""
        wall, cpu = np.median(np.divide(other.rounds, self.rounds), axis=0)
        return float(wall), float(cpu)


def measure(
    tasks: Mapping[Key, Callable[[], object]],
    rounds: int = ROUNDS,
    shortest: float = SHORTEST,
) -> dict[Key, Timing]:
    """Time tasks in turn, round after round, after warming each up.

    Within a round a task is repeated for at least `shortest` [s], and the round counts
    the mean.
    """
    repeats = {}
    for name, task in tasks.items():
        task()
        warm = timed(task)[1].wall
        repeats[name] = max(1, round(shortest / max(warm, 1e-9)))
    found: dict[Key, list[Seconds]] = {name: [] for name in tasks}
    # what the libraries hold for good need not be looked through before every task
    gc.freeze()
    gc.disable()
    try:
        for _ in range(rounds):
            for name, task in tasks.items():
                gc.collect()
                found[name].append(timed(task, repeats[name])[1])
    finally:
        gc.unfreeze()
        gc.enable()
    return {name: Timing(rounds) for name, rounds in found.items()}


def timed(task: Callable[[], T], calls: int = 1) -> tuple[T, Seconds]:
    """Result of the last of some calls in a row, and the mean time of a call."""
    clock = time.perf_counter()
    processor = time.process_time()
    for _ in range(calls):
        result = task()
    return result, Seconds(
        (time.perf_counter() - clock) / calls, (time.process_time() - processor) / calls
    )
