"""The state after a part of a window: velocities, and forces of the springs (Eqs. 2 and 3)."""

from __future__ import annotations

from precursors.solver.kernel import lanes
from precursors.solver.kernel.compiled import inner
from precursors.solver.kernel.layout import WIDTH
from precursors.solver.kernel.series import order_at, powers, sum_series


@inner
def move(s, end, chain, motion):
    """The state of blocks 1..end at time s of the window, from the rows of its start.

    Forces are carried in two doubles: the rounding of one would be the largest error of a run.
    """
    coupling, net_force, weight, order = chain.coupling, motion.net_force, motion.weight, order_at(s)
    powers(s, order, weight)
    left = lanes.spread(chain.drive_velocity * s)
    here = here_rest = lanes.spread(0.0)
    for i in range(1, end + 1, WIDTH):
        velocity, slip = sum_series(i, order, weight, motion)
        lanes.store(motion.velocity, i, velocity)
        lanes.store(motion.slip, i, slip)
        change = lanes.load(coupling, i) * (lanes.behind(left, slip) - slip) + lanes.load(
            motion.rest_before, i
        )
        force, rest = two_sum(lanes.load(motion.force_before, i), change)
        lanes.store(motion.spring_force, i, force)
        lanes.store(motion.force_rest, i, rest)
        # From values in registers: what was just stored is not loaded across two groups, which would wait.
        if i > 1:
            lanes.store(net_force, i - WIDTH, difference(here, here_rest, force, rest))
        left, here, here_rest = slip, force, rest
    i = end + 1
    force, rest = two_sum(motion.force_before[i], coupling[i] * motion.slip[end] + motion.rest_before[i])
    motion.spring_force[i], motion.force_rest[i] = force, rest
    lanes.store(net_force, i - WIDTH, difference(here, here_rest, lanes.spread(force), lanes.spread(rest)))


@inner
def difference(here, here_rest, after, after_rest):
    """Net forces on a group, from the spring forces behind its blocks and those of the group after it."""
    return (here - lanes.ahead(here, after)) + (here_rest - lanes.ahead(here_rest, after_rest))


@inner
def two_sum(a, b):
    """a + b rounded, and what the rounding took from it."""
    total = a + b
    back = total - a
    return total, (a - (total - back)) + (b - back)


@inner
def take_net_force(i, motion):
    """Net force on block i from those of its springs."""
    force, rest = motion.spring_force, motion.force_rest
    motion.net_force[i] = (force[i] - force[i + 1]) + (rest[i] - rest[i + 1])
