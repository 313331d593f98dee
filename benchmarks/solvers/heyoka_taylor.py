"""heyoka.py: Taylor series to rounding, one integrator, restarted at each transition."""

import heyoka as hy
import numpy as np
from chain import MICROSECOND, solve


def taylor(chain):
    n = chain.n
    force = [hy.expression(f"T{i}") for i in range(n)]
    velocity = [hy.expression(f"v{i}") for i in range(n)]
    mode = [hy.par[i] for i in range(n)]
    slides = [hy.par[i] * hy.par[i] for i in range(n)]
    net = [force[i] - force[i + 1] for i in range(n - 1)] + [force[-1]]
    behind = [hy.expression(chain.speed), *velocity[:-1]]
    equations = []
    for i in range(n):
        slope = chain.springs[i] * (behind[i] - velocity[i])
        equations.append((force[i], MICROSECOND * slope))
    for i in range(n):
        pull = slides[i] * net[i] - mode[i] * chain.friction[i]
        equations.append((velocity[i], MICROSECOND / chain.mass * pull))
    events = []
    falling = hy.event_direction.negative
    for i in range(n):
        sticks = 1.0 - slides[i]
        forward = mode[i] * velocity[i] + sticks * (chain.strength[i] - net[i])
        backward = slides[i] + sticks * (chain.strength[i] + net[i])
        for function in (forward, backward):
            events.append(hy.t_event(function, direction=falling))
    solver = hy.taylor_adaptive(
        equations, np.zeros(2 * n), t_events=events, pars=np.zeros(n)
    )

    def advance(state, elapsed, end):
        solver.state[:] = state
        solver.pars[:] = chain.mode
        solver.time = elapsed
        solver.reset_cooldowns()  # a function means something else from now on
        outcome, _, _, steps, *_ = solver.propagate_until(end)
        block = None
        if outcome != hy.taylor_outcome.time_limit:
            block = (-int(outcome) - 1) // 2
        return solver.state.copy(), solver.time, block, steps * solver.order

    return advance


solve(taylor)
