"""SciPy's DOP853 with events, restarted at each transition."""

import numpy as np
from chain import solve
from scipy.integrate import solve_ivp

# SciPy sees an event if its function changes sign over a step: [microseconds].
LONGEST_STEP = 0.05
# Three blocks slide the longest, and no two of their transitions are close.
LONGEST_STEP_OF_THREE = 0.2


def dop853(chain):
    def event(block):
        def function(_, state):
            return chain.events(state)[block]

        function.terminal = True
        function.direction = -1
        return function

    events = [event(block) for block in range(chain.n)]
    accuracy = {"rtol": 1e-13, "atol": np.repeat([1e-13, 1e-16], chain.n)}

    def advance(state, elapsed, end):
        found = solve_ivp(
            lambda _, state: chain.rates(state),
            (elapsed, end),
            state,
            "DOP853",
            events=events,
            max_step=LONGEST_STEP_OF_THREE if chain.n == 3 else LONGEST_STEP,
            **accuracy,
        )
        fired = [block for block, times in enumerate(found.t_events) if len(times)]
        block = fired[0] if fired else None
        return found.y[:, -1], found.t[-1], block, found.nfev

    return advance


solve(dop853)
