"""Methods count their evaluations as their definitions say; `kept_runs` holds the counts of all."""

from collections.abc import Callable

import pytest

from precursors import Chain
from precursors.methods import METHODS, cvode_events, events, rk4_located

STEP = 1e-6  # s
# One block slides once, from the instant at which it reaches its limit: that is all that the run has.
CHAIN = Chain.from_slider(n_blocks=1)
LIMIT = float(CHAIN.strength[0]) / CHAIN.loading_rate
DURATION = LIMIT + 0.01
# Evaluations in each step and besides: the force at the end of a step is that at the start of the next, the
# first has to be evaluated; a step in which a block stops is solved again with the block stuck.
STEPS = {
    "rk4_skip": (4, 0),
    "leapfrog": (1, 1),
    "semi_implicit_euler": (1, 0),
    "forward_euler": (1, 0),
    "newmark": (1, 1),
    "hht": (1, 1),
    "moreau_jean_half": (1, 1),
    "moreau_jean_one": (1, 1),
    "karnopp": (4, 0),
}


def counted(name: str, setting: float = STEP) -> tuple[int, float]:
    """Evaluations of the run, and the time from the limit to the stop [s]."""
    result = METHODS[name].solve(CHAIN, DURATION, setting, None)
    return result.evaluations, float(result.run.transitions["time"][-1]) - LIMIT


@pytest.mark.parametrize("name", STEPS)
def test_of_equal_steps(name):
    each, besides = STEPS[name]
    evaluations, slip = counted(name)
    assert evaluations == each * round(slip / STEP) + besides


def test_of_runge_and_kutta_through_the_wait():
    result = METHODS["rk4"].solve(CHAIN, 1000.5 * STEP, STEP, None)
    assert result.evaluations == 4 * 1001


def test_of_a_step_that_is_cut_at_its_transition():
    """One at the start, four in each step whose end is evaluated for the next, three in each shorter one."""
    evaluations, slip = counted("rk4_located")
    corrections, rest = divmod(evaluations - 1 - 4 * (int(slip / STEP) + 1), 3)
    assert rest == 0
    assert 1 <= corrections <= rk4_located.CORRECTIONS


def test_of_dop853():
    """One at the start; in each step twelve and three for the dense output."""
    evaluations, _ = counted("dop853", 1e-9)
    assert evaluations > 15
    assert evaluations % 15 == 1


@pytest.mark.parametrize(
    ("name", "setting", "where", "function"),
    [
        ("scipy_rk45", 1e-6, events.EventMotion, "rates"),
        ("scipy_dop853", 1e-6, events.EventMotion, "rates"),
        ("scipy_radau", 1e-4, events.EventMotion, "rates"),
        ("scipy_lsoda", 1e-6, events.EventMotion, "rates"),
        ("cvode_adams", 1e-6, cvode_events, "rates_of"),
        ("cvode_bdf", 1e-6, cvode_events, "rates_of"),
    ],
)
def test_of_solvers_that_call_for_them(name, setting, where, function, monkeypatch):
    if name not in METHODS:
        pytest.skip("scikit-sundae is an extra")
    evaluate: Callable = getattr(where, function)
    calls = 0

    def counts(*arguments):
        nonlocal calls
        calls += 1
        return evaluate(*arguments)

    monkeypatch.setattr(where, function, counts)
    assert METHODS[name].solve(CHAIN, DURATION, setting, None).evaluations == calls > 0
