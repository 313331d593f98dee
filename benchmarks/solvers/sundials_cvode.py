"""SUNDIALS CVODE (scikit-sundae), Adams, restarted at each transition."""

import numpy as np
from chain import solve
from sksundae.cvode import CVODE

# CVODE sees a root if the function changes sign over a step: [microseconds].
LONGEST_STEP = 0.05
ROOT_FOUND = 2


def cvode(chain):
    def rates(_, state, result):
        result[:] = chain.rates(state)

    def events(_, state, result):
        result[:] = chain.events(state)

    events.direction = [-1] * chain.n
    solver = CVODE(
        rates,
        eventsfn=events,
        num_events=chain.n,
        rtol=1e-13,
        atol=np.repeat([1e-13, 1e-16], chain.n),
        method="Adams",
        max_step=LONGEST_STEP,
        max_num_steps=10**8,
    )

    def advance(state, elapsed, end):
        solver.init_step(elapsed, state)
        found = solver.step(end, tstop=end)
        block = None
        if found.status == ROOT_FOUND:
            block = int(np.argmax(found.i_events[-1] != 0))
        return np.array(found.y), float(found.t), block, found.nfev

    return advance


solve(cvode)
