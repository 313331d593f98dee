"""The worst of many random chains: their proved transitions are found, compiled and in
plain Python."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest
from chains import by_plain, in_groups
from reference.worst_cases import read

from precursors import Chain, simulate

CASES = read()
KINDS = {
    "any loads": 100,
    "grazing": 20,
    "at the limit": 20,
    "mu_k = mu_s": 20,
    "zero loads": 20,
    "equal loads": 20,
}
# Error of a time in units of 1/omega, the bound of the largest frequency. Measured are
# 6e-13 or less, and 4e-10 near a velocity that grazes zero. With mu_k = mu_s such a
# velocity has a double root, known to the root of a rounding: 8e-7.
TIME, GRAZING, DOUBLE_ROOT = 1e-11, 1e-8, 1e-5
# Transitions at one instant may come in any order; the closest others are 3e-11 apart.
TIE = 1e-15


def by_kernel(chain, case):
    run = simulate(chain, case["duration"], **case["start"])
    return run.transitions[["time", "block", "mode"]].tolist()


def in_plain_python(chain, case):
    rows, _ = by_plain(chain, case["duration"], **case["start"])
    return [(time, int(block), int(mode)) for time, _, block, mode, _ in rows]


def test_the_file_has_the_worst_of_every_kind():
    assert Counter(case["kind"] for case in CASES) == KINDS
    assert {case["source"] for case in CASES} == {"proof", "reference"}


@pytest.mark.parametrize("solve", [by_kernel, in_plain_python])
@pytest.mark.parametrize("kind", KINDS)
def test_the_order_is_the_proved_one_and_the_times_are_right(solve, kind):
    tolerance = {"grazing": GRAZING, "mu_k = mu_s": DOUBLE_ROOT}.get(kind, TIME)
    for case in CASES:
        if case["kind"] == kind:
            chain = Chain(**case["chain"])
            unit = 1 / chain.fastest_frequency_bound
            found, proved = solve(chain, case), case["transitions"]
            assert in_groups(found, TIE * unit) == in_groups(proved, TIE * unit), case[
                "gap"
            ]
            np.testing.assert_allclose(
                [time for time, *_ in found],
                [time for time, *_ in proved],
                rtol=0,
                atol=tolerance * unit,
            )
