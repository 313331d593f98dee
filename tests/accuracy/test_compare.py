"""A run is compared with the truth transition by transition."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest
from accuracy.made_up import CHAIN, DURATION, TRUE, has_all_transitions, made_up, tied_certificate
from reference import read_golden

from precursors import Chain, simulate
from precursors.accuracy.compare import Comparison, TrueTransition, Truth, compare

ONSETS = [0, 2, 6]
# What doubles reach up to the first global slip [s], ten times what the exact solver's error is.
ROUNDING = 1e-14


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


def test_a_proof_that_ends_with_a_tie_is_the_truth_up_to_there():
    certificate = tied_certificate()
    assert certificate.tie
    truth = Truth.proved(certificate)
    assert truth.run.duration == float(certificate.proved_until) < certificate.duration
    assert len(truth.run.transitions) == len(certificate.transitions) == 3
