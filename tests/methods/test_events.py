"""Methods that locate transitions as events are compared with proofs."""

from importlib.util import find_spec

import pytest

from maegawa2010.methods import METHODS
from maegawa2010.methods.cvode_events import solve_cvode
from maegawa2010.methods.events import EventMotion
from maegawa2010.methods.heyoka_events import solve_heyoka
from precursors import Chain
from precursors.benchmark.compare import compare
from precursors.benchmark.score import solution

FIRST_SLIP = 216  # transitions of theta = 0 to the end of the first global slip
# Errors of steps accumulate and grow during 2.7 s.
TIGHT_ERROR = 2e-7  # s, a hundredth of the shortest slip
# Rounding errors of heyoka at its default tolerance grow to at most 1e-8 s at 10 s.
ROUNDING_GROWN = 1e-7  # s


@pytest.fixture(scope="module")
def uniform() -> Chain:
    return Chain.from_slider()


def needs(package: str) -> pytest.MarkDecorator:
    return pytest.mark.skipif(
        find_spec(package) is None, reason=f"{package} is an extra"
    )


@pytest.mark.parametrize(
    ("solve", "setting"),
    [
        pytest.param(METHODS["rk4_located"].solve, 1e-7, id="RK4 located"),
        pytest.param(solve_cvode, 1e-10, id="CVODE", marks=needs("sksundae")),
    ],
)
def test_a_method_is_right_up_to_the_first_global_slip(uniform, solve, setting):
    result = solve(uniform, 10.0, setting, "global slip")
    comparison = compare(result.run, solution("uniform").until_global_slip())
    assert comparison.transitions_right == FIRST_SLIP
    assert comparison.transitions_found == FIRST_SLIP
    assert comparison.time_error < TIGHT_ERROR
    assert result.evaluations > 10 * FIRST_SLIP


@needs("heyoka")
def test_heyoka_is_right_for_ten_seconds_by_default(uniform):
    comparison = compare(solve_heyoka(uniform, 10.0, 0.0).run, solution("uniform"))
    assert comparison.transitions_right == comparison.transitions_true
    assert comparison.transitions_found == comparison.transitions_true
    assert comparison.time_error < ROUNDING_GROWN


def test_blocks_that_stop_at_the_same_instant_both_stop():
    motion = EventMotion(Chain.from_slider(n_blocks=3), 1.0, None)
    motion.put([1, 1, 0], [1.0, 0.5, 0.0], [1e-18, -1e-18, 0.0])
    assert not motion.switch(0, 2.0)
    transitions = motion.run().run.transitions
    assert transitions[["block", "mode"]].tolist() == [(1, 0), (2, 0)]
    assert len(set(transitions["time"])) == 1
