"""SciPy's solve_ivp with terminal events, restarted at each transition: RK45, DOP853, LSODA and Radau.

Events are the velocities of the blocks that slide and the margins of the stuck blocks beside them;
elsewhere no force changes. SciPy looks for an event where its function has changed sign over a step, so a
velocity that falls below zero and rises again within one step is missed without a warning. A shorter
`max_step` is one cure; to look at more points of each step, as `dop853` does, is another."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any, Literal

import numpy as np
from scipy.integrate import solve_ivp

from precursors.methods.columns import MODE, STRENGTH
from precursors.methods.common import Method, Result
from precursors.methods.events import NUDGE, EventMotion, jacobian, march_restarting
from precursors.model.chain import Chain, FloatArray

Solver = Literal["RK45", "DOP853", "LSODA", "Radau"]
IMPLICIT = ("LSODA", "Radau")
FALLING = -1.0

EventFunction = Callable[[float, FloatArray], float]


def solve_scipy(
    chain: Chain,
    duration: float,
    tolerance: float,
    until: str | None = None,
    solver: Solver = "DOP853",
    max_step: float = math.inf,
    nudge: float = NUDGE,
    direction: float = FALLING,
) -> Result:
    """Run a chain by `scipy.integrate.solve_ivp`; rtol is the tolerance, atol the same in N and N/tau.

    `max_step` is the longest step [s]; `nudge` is explained in `events.NUDGE`. SciPy's `direction` of an
    event takes any root where it is 0, its default, also one that a restart lies on.

    Raises
    ------
    TransitionLimitError
        If the solver makes transition after transition without time going on.
    RuntimeError
        If SciPy reports a failure.
    """
    motion = EventMotion(chain, duration, until, nudge=nudge)
    n = chain.n_blocks

    def next_transition(time: float) -> tuple[float, int]:
        events = dict(watched(motion, direction))
        options: dict[str, Any] = {}
        if solver in IMPLICIT:
            matrix = jacobian(motion.system, motion.state, np.zeros((2 * n, 2 * n)))
            options["jac"] = matrix if solver == "Radau" else lambda _t, _y: matrix
        solution = solve_ivp(
            motion.rates,
            (time, motion.remaining),
            motion.y,
            method=solver,
            events=list(events.values()),
            rtol=tolerance,
            atol=tolerance,
            max_step=max_step / motion.tau,
            **options,
        )
        motion.evaluations += solution.nfev
        if not solution.success:
            raise RuntimeError(f"{solver} at t = {motion.onset:.9g} s: {solution.message}")
        motion.y[:] = solution.y[:, -1]
        fired = [number for number, times in zip(events, solution.t_events or (), strict=True) if len(times)]
        return float(solution.t[-1]), fired[0] if fired else -1

    return march_restarting(motion, next_transition)


def watched(motion: EventMotion, direction: float = FALLING) -> Iterator[tuple[int, EventFunction]]:
    """Numbers and functions of the events that can come next."""
    n = motion.chain.n_blocks
    mode = motion.state[MODE, 1:-1]
    for i in range(n):
        if mode[i] != 0.0:
            yield 2 * i, _terminal(_velocity(n + i, float(mode[i])), direction)
        elif mode[max(i - 1, 0) : i + 2].any():
            for side in (0, 1):
                margin = _margin(i, n, float(motion.system[STRENGTH, i + 1]), 1.0 - 2.0 * side)
                yield 2 * i + side, _terminal(margin, direction)


def _velocity(column: int, direction: float) -> EventFunction:
    return lambda _time, state: direction * state[column]


def _margin(block: int, n_blocks: int, strength: float, direction: float) -> EventFunction:
    if block + 1 == n_blocks:
        return lambda _time, state: strength - direction * state[block]
    return lambda _time, state: strength - direction * (state[block] - state[block + 1])


def _terminal(function: EventFunction, direction: float) -> EventFunction:
    function.terminal = True  # type: ignore[attr-defined]
    function.direction = direction  # type: ignore[attr-defined]
    return function


_VALUES: dict[Solver, dict[str, Any]] = {
    "RK45": {"values": (1e-4, 1e-6, 1e-8), "look": ("#00436A", "v")},
    "DOP853": {
        "values": (1e-3, 1e-5, 1e-7, 1e-9, 1e-11, 1e-13),
        "whole": (1e-13,),
        "quick": (1e-11,),
        "look": ("#0072B2", "^"),
    },
    "LSODA": {"values": (1e-4, 1e-6, 1e-8, 1e-10), "whole": (1e-10,), "look": ("#4F9FD0", "<")},
    "Radau": {"values": (1e-4, 1e-5), "look": ("#8FBFE0", ">")},
}
METHODS = tuple(
    Method(
        f"scipy_{solver.lower()}",
        f"SciPy {solver} with events",
        "relative tolerance",
        partial(solve_scipy, solver=solver),
        **values,
    )
    for solver, values in _VALUES.items()
)
