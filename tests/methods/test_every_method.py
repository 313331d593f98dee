"""Every method gives the exact solver's transitions, consistent times, and its number of
evaluations."""

from itertools import pairwise

import numpy as np
import pytest

from maegawa2010.methods import METHODS, events
from maegawa2010.methods.events import EventMotion
from precursors import Chain, simulate

# Blocks, theta, mu_k and duration [s]: two runs go beyond the first global slip; in the
# others a block slides backward: block 3 and block 1, which turn round, and block 2,
# which is released backward from rest.
CHAINS = [
    (1, 0.0, 0.45, 3.6),
    (3, 0.0, 0.45, 3.6),
    (3, "-5/6", 0.45, 2.2),
    (3, "5/6", 0.45, 1.5),
    (3, "-5/6", 0.1, 2.13945),
]
# Values at which a method is right for a short chain, by its name or by its setting.
FINE = {
    "exact": 0.0,
    "heyoka": 0.0,
    "relative tolerance": 1e-6,
    "step [s]": 1e-8,
}
# Error of F_X at a transition [N]; a step changes it by 0.3 N.
LOAD_ERROR = 0.4
# Some methods stop a block that turns round for less than this [s].
TURN = 1e-7
CLOCK = 1e-13  # s, rounding of a sum of about ten intervals
CASES = [(name, *case) for name in METHODS for case in CHAINS]


STEP = 1e-6  # s
# The only event of this run: one block slides once, from when it reaches its limit.
CHAIN = Chain.from_slider(n_blocks=1)
LIMIT = float(CHAIN.strength[0]) / CHAIN.loading_rate
DURATION = LIMIT + 0.01
# Evaluations in each step, and further ones: leapfrog needs the first force, later ones
# are those at the end of the step before; Moreau-Jean solves the step in which the block
# stops again with a stuck block.
STEPS = {
    "rk4": (4, 0),
    "leapfrog": (1, 1),
    "moreau_jean_half": (1, 1),
    "moreau_jean_one": (1, 1),
}


def without_short_stops(transitions) -> list[tuple[int, int, float]]:
    """(block, mode, load) without stops of blocks that turn round immediately."""
    rows = transitions.tolist()
    turns = {
        k
        for k, (row, following) in enumerate(pairwise(rows))
        if row[2] == 0 and following[1] == row[1] and following[0] - row[0] < TURN
    }
    return [
        (block, mode, load)
        for k, (_, block, mode, load) in enumerate(rows)
        if k not in turns
    ]


@pytest.mark.parametrize(("name", "n_blocks", "theta", "mu_k", "end"), CASES)
def test_a_method_agrees_with_the_exact_solver_in_transitions(
    name, n_blocks, theta, mu_k, end
):
    chain = Chain.from_slider(n_blocks=n_blocks, theta=theta, mu_k=mu_k)
    method = METHODS[name]
    run = method.solve(chain, end, FINE.get(name, FINE.get(method.setting)), None).run
    exact = without_short_stops(simulate(chain, end).transitions)
    own = without_short_stops(run.transitions)
    assert [row[:2] for row in own] == [row[:2] for row in exact]
    errors = [abs(a[2] - b[2]) for a, b in zip(own, exact, strict=True)]
    assert max(errors) < LOAD_ERROR
    ends = np.append(run.transitions["time"], run.duration)
    np.testing.assert_allclose(np.cumsum(run.intervals), ends, rtol=0, atol=CLOCK)


@pytest.mark.parametrize("name", STEPS)
def test_evaluations_of_equal_steps_are_those_of_the_method(name):
    each, besides = STEPS[name]
    result = METHODS[name].solve(CHAIN, DURATION, STEP, None)
    slip = float(result.run.transitions["time"][-1]) - LIMIT
    assert result.evaluations == each * round(slip / STEP) + besides


def test_the_jacobian_of_located_events_is_that_of_their_rates():
    chain = Chain.from_slider(n_blocks=4, theta="5/6", drive_stiffness=3e6)
    motion = EventMotion(chain, 1.0, None)
    motion.put([-1, 0, 1, 0], [1.0, 3.0, -2.0, 5.0], [-1.0, 0.0, 2.0, 0.0])
    change = motion.rates(0.0, motion.y) - motion.rates(0.0, np.zeros(8))
    jacobian = events.jacobian_of(motion.system, motion.state)
    np.testing.assert_allclose(jacobian @ motion.y, change, atol=1e-12)
