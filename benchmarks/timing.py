"""One way to measure time for all benchmarks: side by side, in turn, warmed up, medians.

A machine's load changes from second to second, so what is compared is measured in the same round, one
right after the other, and the ratio is the median of the rounds' ratios. Import this before NumPy: it holds
NumPy's and Numba's own threads to one.
"""

from __future__ import annotations

import gc
import os
import statistics
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass

for _name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"):
    os.environ[_name] = "1"

ROUNDS = 11
# A task is repeated within a round until it takes so long, well above the clock's resolution.
SHORTEST = 0.02  # s


@dataclass(frozen=True)
class Timing:
    """Seconds per call in each round: on the clock, and of processor time of the calling thread."""

    wall: tuple[float, ...]
    cpu: tuple[float, ...]

    @property
    def seconds(self) -> float:
        """Median on the clock [s]."""
        return statistics.median(self.wall)

    def times_faster_than(self, other: Timing) -> tuple[float, float]:
        """How many times longer the other takes, on the clock and in processor time: medians of rounds."""
        return (
            statistics.median(b / a for a, b in zip(self.wall, other.wall, strict=True)),
            statistics.median(b / a for a, b in zip(self.cpu, other.cpu, strict=True)),
        )


def measure(
    tasks: Mapping[str, Callable[[], object]], rounds: int = ROUNDS, shortest: float = SHORTEST
) -> dict[str, Timing]:
    """Time tasks in turn, round after round, after warming each up."""
    repeats = {name: _repeats(task, shortest) for name, task in tasks.items()}
    wall: dict[str, list[float]] = {name: [] for name in tasks}
    cpu: dict[str, list[float]] = {name: [] for name in tasks}
    collecting = gc.isenabled()
    try:
        for _ in range(rounds):
            for name, task in tasks.items():
                gc.collect()
                gc.disable()
                clock, processor = time.perf_counter(), time.thread_time()
                for _ in range(repeats[name]):
                    task()
                wall[name].append((time.perf_counter() - clock) / repeats[name])
                cpu[name].append((time.thread_time() - processor) / repeats[name])
                if collecting:
                    gc.enable()
    finally:
        if collecting:
            gc.enable()
    return {name: Timing(tuple(wall[name]), tuple(cpu[name])) for name in tasks}


def _repeats(task: Callable[[], object], shortest: float) -> int:
    task()
    start = time.perf_counter()
    task()
    once = time.perf_counter() - start
    return max(1, round(shortest / max(once, 1e-9)))
