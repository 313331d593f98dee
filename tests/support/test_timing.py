"""Tasks that are compared are timed in turns, short ones repeatedly, without collecting garbage."""

import contextlib
import gc

from precursors.support import timing
from precursors.support.timing import Seconds


def test_tasks_take_turns():
    calls = []
    timings = timing.measure({"a": lambda: calls.append("a"), "b": lambda: calls.append("b")}, 3, 0.0)
    assert "".join(calls) == "aabb" + "ababab"
    assert [len(of.wall) for of in timings.values()] == [3, 3]


def test_short_tasks_are_repeated_and_the_mean_of_a_round_counts(clock):
    calls = []

    def take_longer_and_longer():
        calls.append(1)
        clock.now += len(calls)

    measured = timing.measure({"task": take_longer_and_longer}, 3, 40.0, {"task": Seconds(10.0, 10.0)})[
        "task"
    ]
    assert measured.wall == measured.cpu == (2.5, 6.5, 10.5)
    assert measured.seconds == 6.5


def test_a_warm_call_that_was_long_enough_is_the_first_round(clock):
    calls = []

    def task():
        calls.append(1)
        clock.now += 50.0

    measured = timing.measure({"task": task}, 3, 40.0, {"task": Seconds(60.0, 61.0)})["task"]
    assert (measured.wall, measured.cpu) == ((60.0, 50.0, 50.0), (61.0, 50.0, 50.0))
    assert len(calls) == 2


def test_a_ratio_is_the_median_of_the_rounds_ratios():
    one, other = (
        timing.Timing((1.0, 10.0, 1.0), (1.0, 1.0, 1.0)),
        timing.Timing((3.0, 20.0, 4.0), (5.0,) * 3),
    )
    assert one.times_faster_than(other) == (3.0, 5.0)


def test_garbage_is_collected_again_afterwards():
    def fail():
        raise KeyError

    for task in (list, fail):
        with contextlib.suppress(KeyError):
            timing.measure({"task": task}, 1, 1.0, {"task": Seconds(0.5, 0.5)})
        assert gc.isenabled()
        assert gc.get_freeze_count() == 0
