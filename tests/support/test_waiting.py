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


@pytest.mark.parametrize(
    ("second_per_step", "first", "text"),
    [
        # 1.5 s of 2.5 s; the next second is not over.
        (0.5, 1, f"\rauditing: 60% 1 s left\x1b[K{CLEARED}"),
        (
            2.0,
            0,
            "".join(f"\rauditing: {told}\x1b[K" for told in EACH_SECOND) + CLEARED,
        ),
        (0.1, 1, ""),
    ],
)
def test_a_terminal_has_one_line_each_second_that_ends_empty(
    monkeypatch, clock, second_per_step, first, text
):
    def told(is_terminal, steps=5):
        """What work of some steps is told, of which `first` is done after the first
        one."""
        monkeypatch.setattr("sys.stderr", Stream(is_terminal))
        monkeypatch.setattr(waiting.time, "monotonic", clock.perf_counter)
        passed = []
        for step in waiting.tell(
            "auditing", range(steps), lambda: (len(passed) - 1 + first) / steps
        ):
            passed.append(step)
            clock.now += second_per_step
        assert passed == list(range(steps))
        return waiting.sys.stderr.getvalue()

    assert told(True) == text
    assert told(True, steps=0) == told(False) == ""


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
