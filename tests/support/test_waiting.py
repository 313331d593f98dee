"""Who waits at a terminal is told how much of long work is done, and nobody else."""

import io
import re
import time
from functools import partial

import pytest

from precursors.support import waiting


class Stream(io.StringIO):
    """Standard error, at a terminal or not."""

    def __init__(self, is_terminal):
        super().__init__()
        self.isatty = lambda: is_terminal


CLEARED = "\r\x1b[K"
EACH_SECOND = ("0% ", "20% 16 s left", "40% 9 s left", "60% 5 s left", "80% 2 s left")


def test_a_terminal_has_one_line_each_second_that_ends_empty(monkeypatch, clock):
    def told(is_terminal, seconds):
        """What work of five steps is told, each of which takes so long."""
        monkeypatch.setattr("sys.stderr", Stream(is_terminal))
        monkeypatch.setattr(waiting.time, "monotonic", clock.perf_counter)
        passed = []
        for step in waiting.tell("auditing", range(5), lambda: (len(passed) - 1) / 5):
            passed.append(step)
            clock.now += seconds
        assert passed == list(range(5))
        return waiting.sys.stderr.getvalue()

    lines = "".join(f"\rauditing: {text}\x1b[K" for text in EACH_SECOND)
    assert told(True, 2.0) == lines + CLEARED
    assert told(True, 0.1) == told(False, 2.0) == ""


def test_work_in_threads_is_told_as_well_and_its_results_or_error_handed_back(
    monkeypatch,
):
    monkeypatch.setattr("sys.stderr", Stream(True))
    monkeypatch.setattr(waiting, "SECOND", 0.01)
    begun = []

    def task(number):
        begun.append(number)
        time.sleep(0.05)
        return 1 // number

    def tasks(*numbers):
        return [partial(task, number) for number in numbers]

    assert waiting.in_threads("running", tasks(1), done=lambda: 0.5) == [1]
    assert waiting.sys.stderr.getvalue().startswith("\rrunning: 50% 0 s left")
    assert waiting.in_threads("running", tasks(*range(1, 9)), 3) == [1] + 7 * [0]
    shares = set(re.findall(r"(\d+)%", waiting.sys.stderr.getvalue()))
    assert max(map(int, shares)) <= 100
    assert len(shares) > 2
    assert waiting.in_threads("running", []) == []
    begun.clear()
    with pytest.raises(ZeroDivisionError):
        waiting.in_threads("running", tasks(1, 0, *range(2, 99)), 2)
    assert len(begun) < 9
