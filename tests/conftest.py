"""What all tests share: threads as in the workflow's jobs, and a clock that only a test
moves."""

import os

import pytest

from maegawa2010.support import timing

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # as in the workflow's jobs


class Clock:
    """A clock that only a test moves; the processor works half of the time."""

    now = 1000.0

    def perf_counter(self) -> float:
        return self.now

    def process_time(self) -> float:
        return self.now / 2


@pytest.fixture
def clock(monkeypatch) -> Clock:
    """What `timing` takes for the time."""
    clock = Clock()
    monkeypatch.setattr(timing, "time", clock)
    return clock
