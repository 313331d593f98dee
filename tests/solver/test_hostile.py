"""Hostile chains whose runs once looked wrong, and random ones."""

import math

import numpy as np
import pytest
import random_chains
from chains import first_transitions, in_groups, positions_under
from reference import hostile

from precursors import Chain
from precursors.audit import ROUNDINGS
from precursors.audit.checks import Auditor

# In radians of the fastest motion: measured are 1e-9 where the drive is 1e7 times as
# stiff as the chain, and 2e-10 elsewhere. A force at its limit is known to a rounding,
# its instant to less where it hardly grows.
RADIANS = 1e-8


def fastest(chain: Chain) -> float:
    """About the largest angular frequency [rad/s]."""
    return 2 * math.sqrt(max(chain.stiffness, chain.drive_stiffness) / chain.mass)


def run_and_exact(number: int):
    """The chain of a trial, its transitions, and as many of the reference, as (time,
    block, mode)."""
    run = random_chains.trial(number)[1].run()
    return (
        run,
        run.transitions[["time", "block", "mode"]].tolist(),
        hostile.read()[number],
    )


@pytest.mark.parametrize("number", hostile.ONCE_SUSPECTED)
def test_a_run_that_once_looked_wrong_is_that_of_the_reference(number):
    run, mine, exact = run_and_exact(number)
    assert run.duration < random_chains.trial(number)[1].duration or len(exact) <= len(
        mine
    )
    exact = exact[: len(mine)]
    apart = RADIANS / fastest(run.chain)
    assert in_groups(mine, apart) == in_groups(exact, apart)
    wrong = max(abs(a[0] - b[0]) for a, b in zip(mine, exact, strict=True))
    assert wrong < apart


@pytest.mark.parametrize(("number", "blocks"), hostile.BELOW_ROUNDING.items())
def test_blocks_that_are_stronger_than_a_rounding_let_go_in_time_beside_others_that_are_not(
    number, blocks
):
    run, mine, exact = run_and_exact(number)
    auditor = Auditor(run, ROUNDINGS)
    auditor.walk()
    assert not auditor.found.problems
    is_resolved = auditor.state.strength > ROUNDINGS * auditor.state.one_force
    resolved = np.flatnonzero(is_resolved) + 1
    assert resolved.tolist() == blocks
    of_these = [
        [t for t in transitions if t[1] in blocks] for transitions in (mine, exact)
    ]
    assert [t[1:] for t in of_these[0]] == [t[1:] for t in of_these[1]]
    for a, b in zip(*of_these, strict=True):
        assert a[0] == pytest.approx(b[0], abs=RADIANS / fastest(run.chain))


def test_a_soft_drive_keeps_its_load_where_block_1_starts_at_its_limit():
    """K/k = 1e-7: a rounding of k x_1 that is put into K (V t - x_1) is 4e-11 of it."""
    chain = Chain.from_slider(n_blocks=5, drive_stiffness=25.0)
    pushes = [chain.strength[0], 0.21, 0.32, -chain.strength[3], 0.54]
    start = positions_under(chain, pushes)
    run = first_transitions(chain, 2, duration=0.01, start_positions=start)
    first = run.transitions[0]
    assert (first["time"], first["block"], first["mode"]) == (0.0, 1, 1)
    assert first["tangential_load"] == pytest.approx(
        -chain.drive_stiffness * start[0], rel=1e-14
    )


@pytest.mark.parametrize("first", range(0, 160, 20))
def test_random_chains_move_as_the_model_says(first):
    """The auditor, which shares no code with the solver, finds nothing wrong."""
    verdicts = {
        number: random_chains.verdict(number) for number in range(first, first + 20)
    }
    assert {n: v for n, v in verdicts.items() if v not in ("survived", "refused")} == {}
    assert list(verdicts.values()).count("survived") >= 15
