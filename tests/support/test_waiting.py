"""Who waits at a terminal is told how much of long work is done, and nobody else."""

import io
import time

import pytest

from precursors.support import waiting


class Stream(io.StringIO):
    """Standard error, at a terminal or not."""

    def __init__(self, is_terminal):
        super().__init__()
        self.isatty = lambda: is_terminal


@pytest.fixture
def told(monkeypatch):
    def told(is_terminal, steps=5, second=0.0):
        monkeypatch.setattr("sys.stderr", Stream(is_terminal))
        monkeypatch.setattr(waiting, "SECOND", second)
        done = iter(range(1, steps + 1))
        assert list(waiting.tell("auditing", range(steps), lambda: next(done) / steps)) == list(range(steps))
        return waiting.sys.stderr.getvalue()

    return told


def test_a_terminal_has_one_line_that_ends_empty(told):
    *lines, last = told(True).split("\r")[1:]
    assert [line.split()[1] for line in lines] == ["20%", "40%", "60%", "80%", "100%"]
    assert last == "\x1b[K"
    assert told(True, steps=0) == ""


def test_short_work_and_other_files_are_told_nothing(told):
    assert told(True, second=3600.0) == told(False) == ""


def test_work_in_a_thread_is_told_as_well_and_its_result_or_error_handed_back(monkeypatch):
    monkeypatch.setattr("sys.stderr", Stream(True))
    monkeypatch.setattr(waiting, "SECOND", 0.01)
    assert waiting.in_thread("running", lambda: time.sleep(0.1) or 7, lambda: 0.5) == 7
    assert waiting.sys.stderr.getvalue().startswith("\rrunning: 50% 0 s left")
    with pytest.raises(ZeroDivisionError):
        waiting.in_thread("running", lambda: 1 // 0, lambda: 0.5)
