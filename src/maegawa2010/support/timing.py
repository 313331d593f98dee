"""Measure computing times: tasks are warmed up, timed in turn, and compared by medians.

A machine's load changes from second to second, so tasks that are compared are timed in
the same round, one right after the other, and their ratio is the median of the rounds'
ratios. The caller sets OMP_NUM_THREADS and similar variables to 1 before NumPy is
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
# A shorter task is repeated within a round until it takes this long, so that caches left
# by the task before and the resolution of the clock matter little.
SHORTEST = 0.01  # s


class Seconds(NamedTuple):
    """Time of one call: wall-clock time, and processor time of all threads."""

    wall: float
    cpu: float


@dataclass(frozen=True)
class Timing:
    """Time per call in each round."""

    rounds: list[Seconds]

    @property
    def seconds(self) -> float:
        """Median wall-clock time [s]."""
        return float(np.median([of.wall for of in self.rounds]))

    def times_faster_than(self, other: Timing) -> tuple[float, float]:
        """Ratio of the other's time to this one, in wall-clock and in processor time:
        medians over the rounds."""
        wall, cpu = np.median(np.divide(other.rounds, self.rounds), axis=0)
        return float(wall), float(cpu)


def measure(
    tasks: Mapping[Key, Callable[[], object]],
    rounds: int = ROUNDS,
    shortest: float = SHORTEST,
) -> dict[Key, Timing]:
    """Warm up each task, then time all tasks in turn, round after round.

    Within a round a task is repeated for about `shortest` [s], and the round counts the
    mean.
    """
    repeats = {}
    for name, task in tasks.items():
        task()
        warm = timed(task)[1].wall
        repeats[name] = max(1, round(shortest / max(warm, 1e-9)))
    seconds: dict[Key, list[Seconds]] = {name: [] for name in tasks}
    # Permanent objects of the libraries need not be scanned before every task.
    gc.freeze()
    gc.disable()
    try:
        for _ in range(rounds):
            for name, task in tasks.items():
                gc.collect()
                seconds[name].append(timed(task, repeats[name])[1])
    finally:
        gc.unfreeze()
        gc.enable()
    return {name: Timing(rounds) for name, rounds in seconds.items()}


def timed(task: Callable[[], T], calls: int = 1) -> tuple[T, Seconds]:
    """Result of the last of several calls in a row, and the mean time of a call."""
    clock = time.perf_counter()
    processor = time.process_time()
    for _ in range(calls):
        result = task()
    return result, Seconds(
        (time.perf_counter() - clock) / calls, (time.process_time() - processor) / calls
    )
