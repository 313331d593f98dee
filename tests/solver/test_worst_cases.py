"""The twenty worst of 100,000 random chains, solved by the kernel and in plain Python.

The closest transitions of two blocks in golden/worst_cases.jsonl are 2e-11/omega apart,
where omega is the bound of the largest frequency. Pairs called grazing differ by 1e-9
in their drive, and a block stops in only one of them. Times were proved, or, in case of
a tie, computed to 70 digits by a method that shared no code with the solver.
Blocks without load have no transitions.
"""

import json

import numpy as np
import pytest
from chains import by_plain
from places import GOLDEN

from precursors import Chain, simulate

LINES = (GOLDEN / "worst_cases.jsonl").read_text(encoding="utf-8").splitlines()
CASES = list(map(json.loads, LINES))
# Errors of times in units of 1/omega. 6e-13 or less was measured, and 4e-10 near a
# velocity that grazes zero. With mu_k = mu_s, such a velocity has a double root, with an
# error of the square root of a rounding: 8e-7.
TIME = 1e-11
OF_KIND = {"grazing": 1e-8, "mu_k = mu_s": 1e-5}
# Transitions at one instant may come in any order.
TIE = 1e-15


def in_groups(transitions, apart: float) -> list[tuple[int, int]]:
    """Return (block, mode) in order of time; transitions within `apart` [s] of each other
    are sorted by block."""
    time, block, mode = np.transpose(transitions)
    group = np.cumsum(np.diff(time, prepend=0.0) > apart)
    return [row[1:] for row in sorted(zip(group, block, mode, strict=True))]


def by_kernel(chain, case):
    run = simulate(chain, case["duration"], **case["start"])
    return run.transitions[["time", "block", "mode"]].tolist()


def in_plain_python(chain, case):
    rows, _ = by_plain(chain, case["duration"], **case["start"])
    return [(time, int(block), int(mode)) for time, _, block, mode, _ in rows]


@pytest.mark.parametrize("solve", [by_kernel, in_plain_python])
def test_worst_cases_have_the_true_order_and_times(solve):
    assert len(CASES) == 20
    for case in CASES:
        chain = Chain(**case["chain"])
        unit = 1 / chain.fastest_frequency_bound
        transitions = solve(chain, case)
        true = case["transitions"]
        assert in_groups(transitions, TIE * unit) == in_groups(true, TIE * unit), case[
            "gap"
        ]
        np.testing.assert_allclose(
            [time for time, *_ in transitions],
            [time for time, *_ in true],
            rtol=0,
            atol=OF_KIND.get(case["kind"], TIME) * unit,
        )
