"""The method in plain Python gives the transitions of the compiled kernel."""

from itertools import product

import numpy as np
import pytest
from chains import SCENES, SLIDER, by_plain, positions_under
from random_chains import mild_chain

from precursors import simulate
from precursors.solver import plain

# Errors of both methods up to the first global slip [s, N].
TO_GLOBAL_SLIP = 1e-12
LOAD_TO_GLOBAL_SLIP = 1e-10
# Errors after some tens of transitions, relative to the duration and the largest load.
RANDOM = 1e-9
RANDOM_LOAD = 1e-8


@pytest.mark.parametrize("theta", SCENES.values())
def test_plain_method_agrees_up_to_the_first_global_slip(theta):
    run = simulate(SLIDER(theta=theta), until="global slip")
    rows, end = by_plain(run.chain, 10.0, until_global=True)
    compiled = run.transitions
    assert rows[:, 2].tolist() == compiled["block"].tolist()
    assert rows[:, 3].tolist() == compiled["mode"].tolist()
    np.testing.assert_allclose(
        rows[:, 0], compiled["time"], rtol=0, atol=TO_GLOBAL_SLIP
    )
    np.testing.assert_allclose(
        rows[:, 1], run.intervals[:-1], rtol=0, atol=TO_GLOBAL_SLIP
    )
    np.testing.assert_allclose(
        rows[:, 4], compiled["tangential_load"], rtol=0, atol=LOAD_TO_GLOBAL_SLIP
    )
    assert end == pytest.approx(run.duration, abs=TO_GLOBAL_SLIP)


@pytest.mark.parametrize(("over", "mode"), [(1e-9, 1), (0.0, 0), (-1e-9, 0)])
def test_block_slides_at_the_start_only_beyond_its_limit(over, mode):
    """The limit is 28 N; rounding of positions changes forces by 1e-10 N."""
    for block, side in product((1, 4, 9), (1, -1)):
        push = np.full(10, 14.0)
        push[block] = side * 28.0 * (1.0 + over)
        start = positions_under(SLIDER(), push)
        modes = plain.at_start(SLIDER(), start, np.zeros(10)).mode
        assert modes.tolist() == [side * mode * (i == block + 1) for i in range(12)]
        compiled = simulate(SLIDER(), duration=1e-12, start_positions=start).transitions
        assert compiled[["block", "mode"]].tolist() == [(block + 1, side)] * mode


def test_plain_method_agrees_on_random_chains():
    for number in range(15):
        case = mild_chain(np.random.default_rng(number))
        rows, _ = by_plain(case.chain, case.duration, most=case.most, **case.start)
        compiled = case.run().transitions
        assert rows[:, 2].tolist() == compiled["block"].tolist(), number
        assert rows[:, 3].tolist() == compiled["mode"].tolist(), number
        np.testing.assert_allclose(
            rows[:, 0], compiled["time"], rtol=0, atol=RANDOM * case.duration
        )
        loads = compiled["tangential_load"]
        largest = RANDOM_LOAD * abs(loads).max(initial=1.0)
        np.testing.assert_allclose(rows[:, 4], loads, rtol=0, atol=largest)
