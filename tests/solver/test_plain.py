"""The method in plain Python finds the transitions that the compiled kernel finds."""

import numpy as np
import pytest
from chains import SLIDER, first_transitions
from random_chains import mild_chain

from precursors import simulate
from precursors.solver import plain

THETAS = ["-5/6", "0", "5/6"]
# Both are right to about so much up to the first global slip [s]. After it, roundings grow: what changing the
# weights by a rounding does to the exact times is 3e-8 s at 10 s.
TO_GLOBAL_SLIP, TO_THE_END = 1e-12, 3e-8
# Of the run's duration: roundings of some tens of transitions in chains drawn at random.
RANDOM = 1e-9
N_RANDOM = 200


def plain_and_compiled(chain, duration, most, **start):
    """(block, mode) and times of the transitions in plain Python and compiled."""
    at = [start.get(name, np.zeros(chain.n_blocks)) for name in ("start_positions", "start_velocities")]
    state = plain.at_start(chain, at[0], at[1])
    rows, _, _ = plain.find_transitions(chain, state, duration, False, np.inf, most)
    compiled = first_transitions(chain, most, duration=duration, **start).transitions
    times = np.array([time for time, *_ in rows])
    return (
        [(i, mode) for _, _, i, mode, _ in rows],
        compiled[["block", "mode"]].tolist(),
        times,
        compiled["time"],
    )


@pytest.mark.parametrize("theta", THETAS)
def test_every_transition_of_a_scene_is_the_same_for_ten_seconds(theta):
    chain = SLIDER(theta=theta)
    expected, found, times, compiled_times = plain_and_compiled(chain, 10.0, 10_000)
    assert found == expected
    difference = abs(times - compiled_times)
    n_global = len(simulate(chain, until="global slip").transitions)
    assert difference[:n_global].max() < TO_GLOBAL_SLIP
    assert difference.max() < TO_THE_END


def test_random_chains_have_the_same_transitions():
    compared = 0
    for number in range(N_RANDOM):
        case = mild_chain(np.random.default_rng(number))
        expected, found, times, compiled_times = plain_and_compiled(
            case.chain, case.duration, case.most, **case.start
        )
        assert found == expected, number
        assert abs(times - compiled_times).max(initial=0.0) < RANDOM * case.duration, number
        compared += len(found)
    assert compared > 20 * N_RANDOM
