"""How much work the kernel does, to the last window: a bound that is looser than it was
costs more of it.

The counts do not depend on roundings: chains with all forces times 3 or 1.1 have the
same. They depend on all that decides what is computed: the windows (`layout`,
`events`), the derivatives (`series`), the guessed roots and the steps to them
(`guess`), and what the bounds (`proof`) leave to a search (`roots`).
"""

import numpy as np
import pytest
from chains import SLIDER, audited, first_transitions
from random_chains import mild_chain
from reference.worst_cases import read

from precursors import Chain, simulate
from precursors.solver import kernel

COUNTED = ["transitions", "windows", "derivatives", "searches", "root_steps"]
# Of each scene up to its first global slip. Less is better: write it down here.
SCENES = {
    "-5/6": [142, 253, 43312, 1, 429],
    "0": [216, 416, 59608, 9, 665],
    "5/6": [338, 828, 93344, 14, 927],
}
# Of so many blocks at theta = 1/2: up to three groups of four are expanded at once,
# more one after another.
LENGTHS = {
    1: [6, 13, 672, 0, 9],
    4: [150, 503, 39280, 2, 376],
    5: [236, 721, 81480, 4, 614],
    12: [300, 571, 67448, 13, 896],
    13: [300, 597, 72080, 10, 905],
    60: [300, 527, 74584, 11, 917],
}
# Of so many chains drawn at random, half of which start strained and moving.
N_RANDOM, RANDOM = 100, [3245, 9816, 1223520, 157, 7773]
# Of the worst cases of a kind: velocities that graze zero, blocks exactly at their
# limit or without a load.
WORST = {
    "grazing": [611, 3231, 491240, 57, 1732],
    "at the limit": [496, 1747, 267800, 147, 1447],
    "zero loads": [328, 322, 36232, 8, 506],
}


@pytest.fixture
def counted(monkeypatch):
    """Run a chain, and return what the kernel counted."""
    calls, run_batch = [], kernel.run_batch

    def watched(batch, limits, progress, *others):
        calls.append(progress.view(kernel.PROGRESS)[0, 0])
        return run_batch(batch, limits, progress, *others)

    def count(chain, most, **options):
        run = first_transitions(chain, most, **options)
        counts = {name: int(calls[-1][name]) for name in COUNTED}
        assert counts["derivatives"] == round(run.evaluations * chain.n_blocks)
        return list(counts.values())

    monkeypatch.setattr(kernel, "run_batch", watched)
    return count


@pytest.mark.parametrize(("theta", "expected"), SCENES.items())
def test_a_scene_takes_as_much_work_as_it_did(counted, theta, expected):
    assert counted(SLIDER(theta=theta), 1000, until="global slip") == expected


@pytest.mark.parametrize(("n_blocks", "expected"), LENGTHS.items())
def test_a_chain_of_any_length_takes_as_much_work_as_it_did(
    counted, n_blocks, expected
):
    assert counted(SLIDER(n_blocks, theta="1/2"), 300) == expected


def test_random_chains_take_as_much_work_as_they_did(counted):
    cases = [mild_chain(np.random.default_rng(number)) for number in range(N_RANDOM)]
    counts = [
        counted(case.chain, case.most, duration=case.duration, **case.start)
        for case in cases
    ]
    assert np.sum(counts, axis=0).tolist() == RANDOM


@pytest.mark.parametrize(("kind", "expected"), WORST.items())
def test_the_worst_cases_take_as_much_work_as_they_did(counted, kind, expected):
    cases = [case for case in read() if case["kind"] == kind]
    counts = [
        counted(
            Chain(**case["chain"]), 1000, duration=case["duration"], **case["start"]
        )
        for case in cases
    ]
    assert np.sum(counts, axis=0).tolist() == expected


def test_blocks_that_feel_the_drive_late_cost_no_search(counted):
    """Without friction all let go at once; the drive moves block 5 as t^9, which is
    flat for long."""
    chain = Chain([10.0] * 5, 2.84e-5, 25e6, 2.7e11, 8.4e-5, 0.0, 0.0)
    audited(simulate(chain, 4.6e-7))
    transitions, windows, _, _, root_steps = counted(chain, 1000, duration=4.6e-7)
    assert transitions == 5
    assert windows < 100
    assert root_steps < 5000  # without starting anew: millions
