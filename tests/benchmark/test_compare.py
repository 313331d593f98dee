"""Comparison of a run with the truth, transition by transition."""

import math
from fractions import Fraction

import numpy as np
import pytest
from benchmark.made_up import (
    CHAIN,
    DURATION,
    TRUE,
    made_up,
    tied_certificate,
)

from precursors import Chain, simulate
from precursors.benchmark.compare import Truth, compare, until_global_slip


def altered(*changes, shift: float = 0.0, after: int = len(TRUE)) -> list[tuple]:
    """Replace some of the true rows, and shift the times from row `after` on."""
    rows = [(t + shift * (k >= after), *rest) for k, (t, *rest) in enumerate(TRUE)]
    for k, row in changes:
        rows[k] = row
    return rows


# Rows of a run, number of right transitions, largest errors [s, N], and time of the
# first difference [s].
COMPARED = {
    "the truth": (TRUE, 12, 0.0, 0.0, math.inf),
    "late, and once early": (
        altered((4, (2.21875, *TRUE[4][1:])), shift=0.015625, after=0),
        *(12, 0.03125, 0.0, math.inf),
    ),
    "another load at an onset": (
        altered((6, (3.0, 1, 1, 119.5))),
        *(12, 0.0, 0.5, math.inf),
    ),
    "another load elsewhere": (
        altered((7, (3.125, 2, 1, 119.5))),
        *(12, 0.0, 0.0, math.inf),
    ),
    "another block": (
        altered((5, (2.375, 3, 0, 85.5)), shift=0.25, after=6),
        *(5, 0.0, 0.0, 2.375),
    ),
    "another mode": (
        altered((5, (2.375, 2, -1, 85.5)), shift=0.25, after=6),
        *(5, 0.0, 0.0, 2.375),
    ),
    "another order": (
        altered((4, (2.25, 2, 0, 85.0)), (5, (2.375, 1, 0, 85.5))),
        *(4, 0.0, 0.0, 2.25),
    ),
    "another front": (
        [*TRUE[:2], (2.0, 1, 1, 80.0), (2.125, 1, 0, 70.0), *TRUE[6:]],
        *(3, 0.0, 0.0, 2.125),
    ),
    "it breaks off": (TRUE[:6], 6, 0.0, 0.0, 3.0),
    "two more": (
        [*TRUE, (3.75, 1, 1, 101.0), (3.875, 1, 0, 100.0)],
        *(12, 0.0, 0.0, 3.75),
    ),
    "nothing": ([], 0, math.nan, math.nan, 1.0),
}


@pytest.mark.parametrize(
    ("rows", "n", "time", "load", "differs"), COMPARED.values(), ids=COMPARED
)
def test_right_transitions_end_with_the_first_difference(rows, n, time, load, differs):
    of = compare(made_up(rows), Truth.exact(CHAIN, DURATION, TRUE))
    assert of.transitions_right == n
    assert (of.transitions_found, of.transitions_true) == (len(rows), 12)
    assert (of.time_error, of.load_error, of.first_difference) == pytest.approx(
        (time, load, differs), abs=0.0, rel=0.0, nan_ok=True
    )


def test_digits_beyond_double_precision_count():
    beyond = Fraction(1, 2**60)
    exact = [(Fraction(t) + beyond, b, m, Fraction(f) - beyond) for t, b, m, f in TRUE]
    comparison = compare(made_up(TRUE), Truth.exact(CHAIN, DURATION, exact))
    assert (comparison.time_error, comparison.load_error) == (2.0**-60, 2.0**-60)


def test_run_with_another_number_of_blocks_is_refused():
    with pytest.raises(ValueError, match="as many blocks as the truth, 3, but has 4"):
        compare(
            simulate(Chain.from_slider(n_blocks=4), 0.1),
            Truth.exact(CHAIN, DURATION, TRUE),
        )


def test_run_cut_at_the_global_slip_equals_a_run_until_it():
    cut = until_global_slip(simulate(Chain.from_slider(), 10.0))
    run = simulate(Chain.from_slider(), 10.0, "global slip")
    np.testing.assert_array_equal(cut.transitions, run.transitions)
    assert cut.duration == run.duration
    for rows in (TRUE[:6], TRUE[:10]):
        unfinished = made_up(rows)
        assert until_global_slip(unfinished) is unfinished


def test_proof_that_ends_with_a_tie_is_the_truth_up_to_the_tie():
    certificate = tied_certificate()
    assert certificate.tie
    truth = Truth.proved(certificate)
    assert truth.run.duration == float(certificate.proved_until) < certificate.duration
    assert len(truth.run.transitions) == len(certificate.transitions) == 3
