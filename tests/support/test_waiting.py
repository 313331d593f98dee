"""Long work shows its progress at a terminal, and only there."""

import io
import re
import threading
import time
from functools import partial

import pytest

from precursors.support import waiting


@pytest.mark.parametrize("is_terminal", [True, False])
def test_results_are_in_order_and_progress_is_shown(is_terminal, monkeypatch):
    stream = io.StringIO()
    stream.isatty = lambda: is_terminal
    monkeypatch.setattr("sys.stderr", stream)
    monkeypatch.setattr(waiting, "SECOND", 0.01)

    def task(number):
        time.sleep(0.02)
        return 2 * number

    tasks = [partial(task, number) for number in range(8)]
    assert waiting.in_threads(tasks, 2) == list(range(0, 16, 2))
    is_shown = re.search(r"running: [1-9]\d%", stream.getvalue()) is not None
    assert is_shown == is_terminal


def test_there_are_no_more_threads_than_tasks():
    tasks = [lambda: threading.active_count()] * 2
    before = threading.active_count()
    # A pool has three threads besides its workers.
    assert max(waiting.in_threads(tasks, 1000)) <= before + len(tasks) + 3
    assert waiting.in_threads([], 1000) == []


def test_error_starts_no_task_and_waits_for_none():
    begun = []

    def task(seconds):
        begun.append(seconds)
        time.sleep(seconds)
        return 1 // seconds

    tasks = [partial(task, seconds) for seconds in (0, *[1] * 9)]
    start = time.monotonic()
    with pytest.raises(ZeroDivisionError):
        waiting.in_threads(tasks, 2)
    assert time.monotonic() - start < 0.5
    assert len(begun) < 4
