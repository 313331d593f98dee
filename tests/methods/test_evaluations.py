"""Methods count their evaluations as their definitions say; `kept_runs` holds the counts of all."""

from collections.abc import Callable

import pytest

from precursors import Chain
from precursors.methods import METHODS, cvode_events, events

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


@pytest.mark.parametrize("name", STEPS)
def test_of_equal_steps(name):
    each, besides = STEPS[name]
    result = METHODS[name].solve(CHAIN, DURATION, STEP, None)
    slip = float(result.run.transitions["time"][-1]) - LIMIT
    assert result.evaluations == each * round(slip / STEP) + besides


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
