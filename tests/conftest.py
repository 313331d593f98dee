"""Property tests: the same examples on every run; others, and more, with --hypothesis-profile=explore."""

import os

import pytest
from hypothesis import settings

from precursors.support import timing

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # as in the workflow's jobs
settings.register_profile("repeatable", derandomize=True, database=None, deadline=None, max_examples=200)
settings.register_profile("explore", deadline=None, max_examples=20_000)
settings.load_profile("repeatable")


class Clock:
    """A clock that only a test moves."""

    now = 0.0

    def perf_counter(self) -> float:
        return self.now

    process_time = perf_counter


@pytest.fixture
def clock(monkeypatch) -> Clock:
    """What `timing` takes for the time."""
    clock = Clock()
    monkeypatch.setattr(timing, "time", clock)
    return clock
