"""heyoka.py: Taylor series of adaptive order and step, with polynomial root isolation
for events.

F. Biscani and D. Izzo, MNRAS 504 (2021) 2614 and 513 (2022) 4833. One integrator is
compiled for each chain and tolerance. The modes of the blocks are its runtime parameters,
so that a transition compiles nothing. Transitions are made in the events' callbacks, so
that a slip event is one call.
"""

from collections.abc import Callable
from functools import lru_cache
from typing import Any

import numpy as np

from maegawa2010.methods.columns import SPRING, STRENGTH, VELOCITY, at_rest
from maegawa2010.methods.common import Method, Result
from maegawa2010.methods.events import EventMotion
from precursors.model.chain import Chain

# Number of blocks above which code is compiled in compact mode, as heyoka's documentation
# recommends for large systems.
LARGE = 20


def integrator_of(
    chain: Chain, tolerance: float, callback: Callable[[int], Any]
) -> Any:
    """heyoka's integrator for a chain; `callback(event)` makes the callback for the root
    of an event function."""
    import heyoka as hy

    n = chain.n_blocks
    system, state = at_rest(chain, scaled=True)
    strength = system[STRENGTH, 1:-1]
    coupling = system[SPRING, 1:-1]
    force = [hy.expression(f"T{i}") for i in range(n)]
    velocity = [hy.expression(f"v{i}") for i in range(n)]
    mode, slides, friction, sticks = (
        [hy.par[row * n + i] for i in range(n)] for row in range(4)
    )
    net = [force[i] - force[i + 1] for i in range(n - 1)] + [force[-1]]
    behind = [state[VELOCITY, 0], *velocity[:-1]]
    functions = []
    for i in range(n):
        functions += [
            mode[i] * velocity[i] + sticks[i] * (strength[i] - net[i]),
            slides[i] + sticks[i] * (strength[i] + net[i]),
        ]
    falling = hy.event_direction.negative
    return hy.taylor_adaptive(
        [(force[i], coupling[i] * (behind[i] - velocity[i])) for i in range(n)]
        + [(velocity[i], slides[i] * net[i] - friction[i]) for i in range(n)],
        np.zeros(2 * n),
        t_events=[
            hy.t_event(function, callback=callback(event), direction=falling)
            for event, function in enumerate(functions)
        ],
        pars=np.zeros(4 * n),
        tol=tolerance,
        compact_mode=n > LARGE,
    )


@lru_cache(maxsize=32)
def _integrator(chain: Chain, tolerance: float) -> tuple[Any, list[EventMotion]]:
    """heyoka's integrator for a chain, and a list with the motion that it currently
    integrates."""
    present: list[EventMotion] = []

    def callback(event: int) -> Any:
        def switch(solver: Any, _direction: int) -> bool:
            # The event function has another meaning after the transition: its cooldown
            # must not hide a root.
            solver.reset_cooldowns()
            return present[0].switch(event, solver.time)

        return switch

    return integrator_of(chain, tolerance, callback), present


def solve_heyoka(
    chain: Chain,
    duration: float,
    tolerance: float,
    until: str | None = None,
) -> Result:
    """Run a chain with heyoka.py. The tolerance also sets the order of the series; 0
    stands for heyoka's default, machine precision.

    A step of order p counts as p evaluations, because each derivative applies the
    equations once.
    """
    solver, present = _integrator(chain, float(tolerance))
    motion = EventMotion(chain, duration, until)
    motion.y = solver.state
    motion.settings = solver.pars.reshape(4, -1)
    present[:] = [motion]
    while motion.begin():
        solver.time = 0.0
        solver.reset_cooldowns()
        outcome, _, _, steps, *_ = solver.propagate_until(motion.remaining)
        motion.evaluations += steps * solver.order
        if motion.slides and outcome.name != "time_limit":
            raise RuntimeError(f"heyoka stopped at t = {motion.onset:.9g} s: {outcome}")
    return motion.run()


METHODS = (Method("heyoka", "relative tolerance", solve_heyoka),)
