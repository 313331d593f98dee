"""Fixtures for all tests: a clock that only the test moves, and threads as in jobs."""

import os

import pytest

from maegawa2010.support import timing

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # as in the workflow's jobs


class Clock:
    """A clock that only the test moves; processor time is half of wall-clock time."""

    now = 1000.0

    def perf_counter(self) -> float:
        return self.now

    def process_time(self) -> float:
        return self.now / 2


@pytest.fixture
def clock(monkeypatch) -> Clock:
    """The clock that `timing` reads."""
    clock = Clock()
    monkeypatch.setattr(timing, "time", clock)
    return clock
