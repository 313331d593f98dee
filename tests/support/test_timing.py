"""Compared tasks are timed in turns, short ones repeatedly, and without garbage
collection."""

import contextlib
import gc

import pytest

from maegawa2010.support import timing
from maegawa2010.support.timing import Seconds


@pytest.fixture
def task(clock):
    """A task whose first call takes 1 s, and each next call 1 s more."""
    calls = []

    def task():
        calls.append(1)
        clock.now += len(calls)
        return len(calls)

    return task


def test_tasks_take_turns_after_each_is_called_twice():
    calls = []
    timings = timing.measure(
        {"a": lambda: calls.append("a"), "b": lambda: calls.append("b")}, 3, 0.0
    )
    assert "".join(calls) == "aabb" + "ababab"
    assert [len(of.rounds) for of in timings.values()] == [3, 3]


def test_short_tasks_are_repeated_within_a_round_and_averaged(task):
    """The second call takes 2 s, so a round has five calls, at first of 3 to 7 s."""
    measured = timing.measure({"task": task}, 3, 10.0)["task"]
    assert measured.rounds == [(5.0, 2.5), (10.0, 5.0), (15.0, 7.5)]
    assert measured.seconds == 10.0


def test_ratio_is_the_median_of_the_ratios_of_rounds():
    one = timing.Timing([Seconds(1.0, 2.0), Seconds(10.0, 2.0), Seconds(1.0, 2.0)])
    other = timing.Timing([Seconds(3.0, 5.0), Seconds(20.0, 5.0), Seconds(4.0, 5.0)])
    assert one.times_faster_than(other) == (3.0, 2.5)


def test_garbage_is_collected_only_between_tasks(clock):
    seen = []

    def fail_when_warm():
        seen.append((gc.isenabled(), gc.get_freeze_count() > 0))
        if len(seen) == 3:
            seen.append(gc.collect())
            raise KeyError

    with contextlib.suppress(KeyError):
        timing.measure({"task": fail_when_warm}, 1, 0.0)
    assert seen[2:] == [(False, True), 0]
    assert gc.isenabled()
    assert gc.get_freeze_count() == 0
