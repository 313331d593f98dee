"""SciPy's solve_ivp with terminal events, restarted at each transition.

Event functions are the velocities of sliding blocks and the margins of the stuck blocks
beside them; no other forces change. SciPy looks for an event if its function has changed
sign over a step, so a velocity that falls below zero and rises again within one step is
missed without a warning. Shorter steps avoid this, and so does a search for roots of the
interpolant, as in `rk4_located`.
"""

from collections.abc import Callable, Iterator
from typing import Literal

from scipy.integrate import solve_ivp

from maegawa2010.methods.columns import MODE, STRENGTH
from maegawa2010.methods.common import Method, Result
from maegawa2010.methods.events import EventMotion, march_restarting
from precursors.model.chain import Chain, FloatArray

FALLING = -1.0

EventFunction = Callable[[float, FloatArray], float]


def solve_scipy(
    chain: Chain,
    duration: float,
    tolerance: float,
    until: str | None = None,
    solver: Literal["DOP853", "RK23"] = "DOP853",
) -> Result:
    """Run a chain with a solver of SciPy; the tolerance is rtol, and atol in N and N/tau.

    Raises
    ------
    TransitionLimitError, RuntimeError
        If transitions repeat without time advancing, or SciPy reports a failure.
    """
    motion = EventMotion(chain, duration, until)

    def next_transition(time: float) -> tuple[float, int]:
        numbers, events = zip(*watched(motion), strict=True)
        solution = solve_ivp(
            motion.rates,
            (time, motion.remaining),
            motion.y,
            method=solver,
            events=events,
            rtol=tolerance,
            atol=tolerance,
        )
        motion.evaluations += solution.nfev
        if not solution.success:
            raise RuntimeError(f"at t = {motion.onset:.9g} s: {solution.message}")
        motion.y[:] = solution.y[:, -1]
        fired = (
            number
            for number, times in zip(numbers, solution.t_events or (), strict=True)
            if len(times)
        )
        return float(solution.t[-1]), next(fired, -1)

    return march_restarting(motion, next_transition)


def watched(motion: EventMotion) -> Iterator[tuple[int, EventFunction]]:
    """Yield number and function of each event that can occur next."""
    n = motion.chain.n_blocks
    mode = motion.state[MODE].tolist()
    strength = motion.system[STRENGTH].tolist()
    for block in range(1, n + 1):
        functions: list[EventFunction] = []
        if mode[block]:
            functions = [_velocity(n + block - 1, mode[block])]
        elif mode[block - 1] or mode[block + 1]:
            functions = [_margin(n, block, strength[block], way) for way in (1.0, -1.0)]
        for side, function in enumerate(functions):
            vars(function).update(terminal=True, direction=FALLING)
            yield 2 * (block - 1) + side, function


def _velocity(column: int, way: float) -> EventFunction:
    return lambda _time, y: way * y[column]


def _margin(n_blocks: int, block: int, strength: float, way: float) -> EventFunction:
    if block == n_blocks:
        return lambda _time, y: strength - way * y[block - 1]
    return lambda _time, y: strength - way * (y[block - 1] - y[block])


METHODS = (Method("scipy_dop853", "relative tolerance", solve_scipy),)
