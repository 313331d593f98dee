"""A run is compared with the truth transition by transition, and methods are timed as they should be."""

from __future__ import annotations

import contextlib
import gc
import math
import time
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from reference import read_golden

from precursors import Chain, Run, TransitionLimitError, simulate
from precursors.accuracy.compare import Comparison, TrueTransition, Truth, compare
from precursors.accuracy.cost_per_event import KINDS, measure_growth
from precursors.accuracy.proof import ExactChain, certify
from precursors.accuracy.work_precision import Case, measure_methods, proved_cases, sweeps_of
from precursors.methods import METHODS, Method, Result
from precursors.support import timing

CHAIN = Chain.from_slider(n_blocks=3)
DURATION = 4.0
# Times are multiples of 1/8 s and loads of 1/2 N, so that sums and differences are exact.
TRUE = [
    (1.0, 1, 1, 50.0),
    (1.125, 1, 0, 49.0),
    (2.0, 1, 1, 90.0),
    (2.125, 2, 1, 88.0),
    (2.25, 1, 0, 85.0),
    (2.375, 2, 0, 85.5),
    (3.0, 1, 1, 120.0),
    (3.125, 2, 1, 118.0),
    (3.25, 3, 1, 110.0),
    (3.375, 1, 0, 100.0),
    (3.5, 2, 0, 101.0),
    (3.625, 3, 0, 101.5),
]
ONSETS = [0, 2, 6]
# What doubles reach up to the first global slip [s], ten times what the exact solver's error is.
ROUNDING = 1e-14
# A fake method sleeps so long [s]; sleep never ends early.
SLEEP = 0.002
# What a call takes on a clock that the test moves [s].
WARM_CALL = 0.0005


def made_up(rows) -> Run:
    time, block, mode, load = zip(*rows, strict=True) if rows else ((), (), (), ())
    return Run.from_transitions(CHAIN, DURATION, time, block, mode, load)


def has_all_transitions(found: Comparison) -> bool:
    """Whether a run has the transitions of the truth in their order, and no other."""
    return found.transitions_right == found.transitions_found == found.transitions_true


def has_all_slips(found: Comparison) -> bool:
    """Whether a run has the slip events of the truth in their order, and no other."""
    return found.slips_right == found.slips_found == found.slips_true


@pytest.fixture
def truth() -> Truth:
    return Truth.of_run(made_up(TRUE))


def test_the_true_run_is_right_in_everything(truth):
    found = compare(made_up(TRUE), truth)
    assert has_all_transitions(found)
    assert has_all_slips(found)
    assert (found.transitions_right, found.slips_right) == (len(TRUE), len(ONSETS))
    assert (found.time_error, found.load_error) == (0.0, 0.0)
    assert found.first_difference == math.inf


def test_the_largest_error_of_a_time_counts_whatever_its_sign(truth):
    rows = [(t + (-0.03125 if i == 4 else 0.015625), *rest) for i, (t, *rest) in enumerate(TRUE)]
    assert compare(made_up(rows), truth).time_error == 0.03125


@pytest.mark.parametrize("wrong", range(len(TRUE)))
def test_the_error_of_the_load_is_that_at_the_onsets_of_slips(truth, wrong):
    rows = [(*of, load - 0.5 if i == wrong else load) for i, (*of, load) in enumerate(TRUE)]
    assert compare(made_up(rows), truth).load_error == (0.5 if wrong in ONSETS else 0.0)


def test_digits_that_doubles_do_not_hold_count_too():
    beyond = Fraction(1, 2**60)
    exact = [TrueTransition(Fraction(t) + beyond, b, m, Fraction(f) - beyond) for t, b, m, f in TRUE]
    found = compare(made_up(TRUE), Truth.exact(CHAIN, DURATION, exact))
    assert (found.time_error, found.load_error) == (2.0**-60, 2.0**-60)
    assert (found.load_errors == 2.0**-60).all()


@pytest.mark.parametrize("first_wrong", range(len(TRUE) - 1))
def test_nothing_after_a_wrong_transition_counts(truth, first_wrong):
    rows = [(t + 0.25 * (i >= first_wrong), *rest) for i, (t, *rest) in enumerate(TRUE)]
    rows[first_wrong] = (rows[first_wrong][0], 3, -1, 0.0)
    found = compare(made_up(rows), truth)
    assert found.transitions_right == first_wrong
    assert not has_all_transitions(found)
    assert found.time_error == 0.0 or (first_wrong == 0 and math.isnan(found.time_error))
    assert found.first_difference == TRUE[first_wrong][0]


@pytest.mark.parametrize("column", [1, 2])
def test_block_and_mode_must_both_be_right(truth, column):
    rows = [list(row) for row in TRUE]
    rows[5][column] = -1 if column == 2 else 3
    assert compare(made_up(rows), truth).transitions_right == 5


def test_two_transitions_in_the_wrong_order_leave_the_slip_right(truth):
    rows = list(TRUE)
    rows[4], rows[5] = (2.25, 2, 0, 85.0), (2.375, 1, 0, 85.5)
    found = compare(made_up(rows), truth)
    assert found.transitions_right == 4
    assert has_all_slips(found)


@pytest.mark.parametrize("missing", range(len(TRUE)))
def test_a_missing_transition_ends_what_is_right(truth, missing):
    rows = TRUE[:missing] + TRUE[missing + 1 :]
    found = compare(made_up(rows), truth)
    assert found.transitions_right == missing
    assert (found.transitions_found, found.transitions_true) == (len(TRUE) - 1, len(TRUE))
    assert found.first_difference == TRUE[missing][0]
    assert not has_all_transitions(found)


def test_a_run_that_breaks_off_is_right_as_far_as_it_goes(truth):
    found = compare(made_up(TRUE[:6]), truth)
    assert (found.transitions_right, found.slips_right) == (6, 2)
    assert not has_all_transitions(found)
    assert not has_all_slips(found)


def test_transitions_that_are_none_make_the_sequence_wrong(truth):
    found = compare(made_up([*TRUE, (3.75, 1, 1, 101.0), (3.875, 1, 0, 100.0)]), truth)
    assert found.transitions_right == len(TRUE)
    assert not has_all_transitions(found)
    assert not has_all_slips(found)


def test_a_slip_with_another_front_ends_what_is_right(truth):
    rows = [TRUE[0], TRUE[1], (2.0, 1, 1, 80.0), (2.125, 1, 0, 70.0), *TRUE[6:]]
    found = compare(made_up(rows), truth)
    assert found.slips_right == 1
    assert found.load_error == 0.0


def test_a_run_without_transitions_has_no_error(truth):
    found = compare(made_up([]), truth)
    assert (found.transitions_right, found.slips_right) == (0, 0)
    assert math.isnan(found.time_error)
    assert math.isnan(found.load_error)


def test_runs_of_other_lengths_are_refused(truth):
    with pytest.raises(ValueError, match="as many blocks as the truth, 3, but has 4"):
        compare(simulate(Chain.from_slider(n_blocks=4), 0.1), truth)


def test_the_truth_until_the_global_slip_is_what_a_run_until_it_has(truth):
    cut = Truth.of_run(simulate(Chain.from_slider(), 10.0)).until_global_slip()
    run = simulate(Chain.from_slider(), 10.0, "global slip")
    np.testing.assert_array_equal(cut.run.transitions, run.transitions)
    before = Truth.of_run(made_up(TRUE[:6]))
    assert before.until_global_slip() is before
    unfinished = Truth.of_run(made_up(TRUE[:10]))
    assert unfinished.until_global_slip() is unfinished


def test_the_exact_solver_has_every_transition_of_the_reference():
    rows = (TrueTransition(t.time, t.block, t.mode, t.tangential_load) for t in read_golden("fig10"))
    truth = Truth.exact(Chain.from_slider(), 10.0, rows)
    assert has_all_transitions(compare(simulate(Chain.from_slider()), truth))
    found = compare(simulate(Chain.from_slider(), 10.0, "global slip"), truth.until_global_slip())
    assert has_all_transitions(found)
    assert 0.0 < found.time_error < ROUNDING


def test_a_certificate_is_a_truth_to_its_end():
    chain = ExactChain.from_slider(n_blocks=3)
    certificate = certify(chain, 10, until="global slip")
    found = compare(simulate(chain.to_chain(), 10.0, "global slip"), Truth.proved(certificate))
    assert has_all_transitions(found)
    assert 0.0 < found.time_error < ROUNDING


def tied_certificate():
    """A proof that ends with a tie: two blocks of a mirror-symmetric start let go at once."""
    start = ["0", "0", "0", "1e-5", "0", "0", "0"]
    return certify(ExactChain.from_slider(n_blocks=7), 1, start_positions=start)


def test_a_proof_that_ends_with_a_tie_is_the_truth_up_to_there():
    certificate = tied_certificate()
    assert certificate.tie
    truth = Truth.proved(certificate)
    assert truth.run.duration == float(certificate.proved_until) < certificate.duration
    assert len(truth.run.transitions) == len(certificate.transitions) == 3


class TestCases:
    def test_a_proof_is_the_truth_to_its_end_and_to_the_first_global_slip(self):
        certificate = certify(ExactChain.from_slider(n_blocks=2, theta="1/4"), 8)
        first, whole = proved_cases("two", 0.25, certificate)
        assert (first.until, whole.until) == ("global slip", None)
        assert first.is_proved
        assert whole.is_proved
        assert first.duration == whole.duration == 8.0
        n = len(first.truth.run.transitions)
        assert 0 < n < len(whole.truth.run.transitions) == len(certificate.transitions)
        np.testing.assert_array_equal(first.truth.time_rest, whole.truth.time_rest[:n])
        for case in (first, whole):
            run = simulate(case.chain, case.duration, case.until)
            assert has_all_transitions(compare(run, case.truth))

    def test_a_tie_leaves_all_to_the_exact_solver(self):
        certificate = replace(tied_certificate(), start_positions=(Fraction(0),) * 7, duration=Fraction(2))
        for case in proved_cases("seven", 0.0, certificate):
            assert not case.is_proved
            assert compare(simulate(case.chain, 2.0, case.until), case.truth).time_error == 0.0

    def test_a_start_that_the_methods_do_not_have_is_refused(self):
        with pytest.raises(ValueError, match=r"seven starts from .*natural length"):
            proved_cases("seven", 0.0, tied_certificate())


class Fake:
    """A method that sleeps as long as its knob says, and gives a run."""

    def __init__(self, run: Run) -> None:
        self.run, self.calls = run, []

    def solve(self, _chain: Chain, _duration: float, knob: float, _until: str | None) -> Result:
        self.calls.append(knob)
        time.sleep(knob)
        return Result(self.run, 7)


class Clock:
    """A clock that only its owner moves."""

    now = 0.0

    def perf_counter(self) -> float:
        return self.now

    process_time = perf_counter


def case(run: Run) -> Case:
    return Case("made up", 0.0, CHAIN, DURATION, None, Truth.of_run(run), True)


@pytest.fixture
def fake(monkeypatch: pytest.MonkeyPatch) -> Fake:
    fake = Fake(made_up(TRUE))
    method = Method("rk4", "fake", "sleep [s]", (SLEEP, 2 * SLEEP), fake.solve)
    monkeypatch.setitem(METHODS, "rk4", method)
    return fake


class TestMeasuring:
    def test_a_row_holds_time_work_and_errors(self, fake):
        fake.run = made_up([(t, b, m, f - 1.0) for t, b, m, f in TRUE[:6]])
        (row,) = measure_methods(case(made_up(TRUE)), {"rk4": [SLEEP]}, 5, 1.0).to_dict("records")
        assert SLEEP <= row["seconds"] < 10 * SLEEP
        assert (row["method"], row["label"], row["knob"], row["value"]) == (
            "rk4",
            "fake",
            "sleep [s]",
            SLEEP,
        )
        assert (row["evaluations"], row["error_load_N"], row["error_time_s"]) == (7, 1.0, 0.0)
        assert (row["transitions_right"], row["transitions_found"], row["transitions_true"]) == (6, 6, 12)
        assert (row["slips_right"], row["slips_found"], row["slips_true"]) == (2, 2, 3)

    def test_the_sweep_ends_before_the_first_value_that_takes_too_long(self, fake):
        values = [SLEEP, 40 * SLEEP, 0.5 * SLEEP]
        table = measure_methods(case(made_up(TRUE)), {"rk4": values}, 5, 10 * SLEEP)
        assert table["value"].tolist() == [SLEEP]
        assert fake.calls.count(SLEEP) >= 2 + 5
        assert 0.5 * SLEEP not in fake.calls

    def test_a_first_call_that_compiles_does_not_end_the_sweep(self, fake):
        warm = fake.solve

        def slow_at_first(*arguments):
            if not fake.calls:
                time.sleep(40 * SLEEP)
            return warm(*arguments)

        METHODS["rk4"] = replace(METHODS["rk4"], solve=slow_at_first)
        table = measure_methods(case(made_up(TRUE)), {"rk4": [SLEEP]}, 5, 10 * SLEEP)
        assert table["seconds"].item() < 10 * SLEEP

    @pytest.mark.parametrize("first", [WARM_CALL, 0.05, 0.82, 1.9, 10.0])
    def test_a_short_call_is_repeated_however_long_its_first_one_took(self, fake, monkeypatch, first):
        clock = Clock()
        monkeypatch.setattr(timing, "time", clock)

        def solve(_chain, _duration, knob, _until):
            clock.now += WARM_CALL if fake.calls else first
            fake.calls.append(knob)
            return Result(fake.run, 7)

        METHODS["rk4"] = replace(METHODS["rk4"], solve=solve)
        table = measure_methods(case(made_up(TRUE)), {"rk4": [1e-6]}, 5, 2.0)
        assert len(fake.calls) == 2 + 5 * round(timing.SHORTEST / WARM_CALL)
        assert table["seconds"].item() == pytest.approx(WARM_CALL)

    def test_a_run_that_breaks_off_is_a_row_with_what_there_is(self, fake):
        def breaks_off(*_arguments):
            raise TransitionLimitError("enough", made_up(TRUE[:3]))

        METHODS["rk4"] = replace(METHODS["rk4"], solve=breaks_off)
        table = measure_methods(case(made_up(TRUE)), {"rk4": [SLEEP]}, 5, 1.0)
        assert table["transitions_right"].item() == 3
        assert math.isnan(table["evaluations"].item())

    def test_the_exact_solver_has_no_error_where_it_is_the_truth(self):
        chain = Chain.from_slider(n_blocks=2)
        own = replace(case(simulate(chain, DURATION)), chain=chain)
        for is_proved in (True, False):
            (row,) = measure_methods(replace(own, is_proved=is_proved), {"exact": [0.0]}, 5, 1.0).to_dict(
                "records"
            )
            assert math.isnan(row["error_time_s"]) is not is_proved
            assert row["transitions_right"] == row["transitions_true"] > 0

    def test_a_method_whose_package_is_missing_is_left_out(self, fake, monkeypatch):
        monkeypatch.delitem(METHODS, "heyoka", raising=False)
        table = measure_methods(case(made_up(TRUE)), {"heyoka": [1e-6], "rk4": [SLEEP]}, 5, 1.0)
        assert table["method"].tolist() == ["rk4"]
        assert list(sweeps_of({"heyoka": "sweep", "rk4": "sweep"})) == ["rk4"]

    def test_a_name_that_is_no_methods_is_refused(self):
        for refuse in (sweeps_of, lambda names: measure_methods(case(made_up(TRUE)), names, 5, 1.0)):
            with pytest.raises(ValueError, match=r"no method 'rk5': allowed are .*rk4_skip"):
                refuse({"rk5": [1e-6]})

    def test_the_word_sweep_is_all_values_of_the_method(self):
        assert sweeps_of({"leapfrog": "sweep", "karnopp": [1e-7]}) == {
            "leapfrog": METHODS["leapfrog"].sweep,
            "karnopp": [1e-7],
        }


class TestTiming:
    def test_tasks_take_turns(self):
        calls = []
        timings = timing.measure(
            {"a": lambda: calls.append("a"), "b": lambda: calls.append("b")}, 3, 0.0, {"a": 1.0, "b": 1.0}
        )
        assert "".join(calls) == "ababab"
        assert [len(of.wall) for of in timings.values()] == [3, 3]

    def test_short_tasks_are_repeated_and_the_mean_of_a_round_counts(self):
        calls = []

        def sleep():
            calls.append(1)
            time.sleep(SLEEP)

        measured = timing.measure({"sleep": sleep}, 3, 40 * SLEEP, {"sleep": SLEEP})["sleep"]
        assert len(calls) == 3 * 40
        assert SLEEP <= measured.seconds < 10 * SLEEP
        assert measured.seconds == sorted(measured.wall)[1]
        assert max(measured.cpu) < SLEEP

    def test_a_ratio_is_the_median_of_the_rounds_ratios(self):
        one, other = (
            timing.Timing((1.0, 10.0, 1.0), (1.0, 1.0, 1.0)),
            timing.Timing((3.0, 20.0, 4.0), (5.0,) * 3),
        )
        assert one.times_faster_than(other) == (3.0, 5.0)

    def test_garbage_is_collected_again_afterwards(self):
        def fail():
            raise KeyError

        for task in (list, fail):
            with contextlib.suppress(KeyError):
                timing.measure({"task": task}, 1, 0.0, {"task": 1.0})
            assert gc.isenabled()
            assert gc.get_freeze_count() == 0


def test_growth_has_a_row_for_each_kind_and_size_and_is_relative_to_ten_blocks():
    table = measure_growth((5, 10, 50), 2, 60, 3, 0.0)
    assert table.groupby("kind")["n_blocks"].apply(list).to_dict() == {
        "natural": [5, 10, 50],
        "driven": [5, 10, 50],
        "front": [50],
    }
    counted = table[table["kind"] != "front"]
    assert counted["transitions"].tolist() == 2 * [60, 60, 150]
    front = table[table["kind"] == "front"]
    assert front["transitions"].item() > 2 * 50
    assert front["mean_front"].item() > 0.5
    assert (table["seconds_per_transition"] > 0).all()
    assert table[table["n_blocks"] == 10]["relative"].tolist() == [1.0, 1.0]
    base = counted[(counted["kind"] == "driven") & (counted["n_blocks"] == 10)][
        "seconds_per_transition"
    ].item()
    assert front["relative"].item() == front["seconds_per_transition"].item() / base
    assert table["definition"].tolist() == [KINDS[kind].definition for kind in table["kind"]]
