"""SUNDIALS CVODE (in scikit-sundae) with root functions, restarted at each transition.

A. C. Hindmarsh et al., ACM Trans. Math. Softw. 31 (2005) 363. We use the Adams method,
which CVODE's documentation recommends for problems that are not stiff. The chain between
transitions is such a problem.
"""

import numpy as np

from maegawa2010.methods.common import Method, Result
from maegawa2010.methods.events import (
    EventMotion,
    event_functions,
    jacobian_of,
    march_restarting,
    rates_of,
)
from precursors.model.chain import Chain, FloatArray

ROOT_RETURN = 2  # status of CVODE at a root of an event function


def solve_cvode(
    chain: Chain, duration: float, tolerance: float, until: str | None = None
) -> Result:
    """Run a chain with CVODE; the tolerance is rtol, and atol in N and N/tau (see
    `events`).

    Raises
    ------
    RuntimeError
        If CVODE reports a failure.
    """
    from sksundae.cvode import CVODE

    motion = EventMotion(chain, duration, until)
    system = motion.system
    state = motion.state
    n_events = 2 * chain.n_blocks

    def events(_time: float, y: FloatArray, result: FloatArray) -> None:
        event_functions(y, system, state, result)

    events.direction = [-1] * n_events  # type: ignore[attr-defined]  # falling
    solver = CVODE(
        lambda _time, y, result: rates_of(y, system, state, result),
        method="Adams",
        rtol=tolerance,
        atol=tolerance,
        eventsfn=events,
        num_events=n_events,
        jacfn=lambda _time, _y, _rates, result: np.copyto(
            result, jacobian_of(system, state)
        ),
        max_num_steps=1_000_000,
    )

    def next_transition(time: float) -> tuple[float, int]:
        solver.init_step(time, motion.y)
        solution = solver.step(motion.remaining, tstop=motion.remaining)
        motion.evaluations += int(solution.nfev)
        if not solution.success:
            raise RuntimeError(f"CVODE at t = {motion.onset:.9g} s: {solution.message}")
        motion.y[:] = solution.y
        event = -1
        if solution.status == ROOT_RETURN:
            event = int(np.flatnonzero(solution.i_events[-1])[0])
        return float(solution.t), event

    return march_restarting(motion, next_transition)


METHODS = (Method("cvode_adams", "relative tolerance", solve_cvode),)
