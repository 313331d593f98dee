"""Taylor series of the motion of all blocks (Eqs. 2 and 3), and their sums."""

from precursors.solver.kernel import lanes
from precursors.solver.kernel.arrays import (
    COUPLING,
    FORCE_BEFORE,
    FORCE_REST,
    NET_FORCE,
    PUSH,
    RATE,
    REST_BEFORE,
    SLIDES,
    SLIP,
    SPRING_FORCE,
    VELOCITY,
    WEIGHT,
)
from precursors.solver.kernel.decorators import inner
from precursors.solver.kernel.layout import INVERSE_FACTORIAL, ORDERS, PARTS, WIDTH


@inner
def expand(start, order, end, motion):
    """Fill rows start..order + 1 with derivatives of blocks 1..end at the start of a
    window; `start` and `order` are even.

    If a block slides, row n is the n-th derivative of its velocity v_i. Row 1 is the
    net force F_i less friction, and row n + 2 is c_i (v_{i-1} - v_i) - c_{i+1} (v_i -
    v_{i+1}) of row n (Eqs. 2 and 4). If a block sticks, its velocity is zero and the
    same rows are those of its net force: row n + 1 is the n-th derivative of F_i. Even
    and odd rows are independent, so the processor computes them in parallel.
    """
    for n in range(start, order + 2, 2):
        left = lanes.spread(motion[RATE + n - 2, 0])
        left_odd = lanes.spread(0.0)
        here, here_odd = two_rows(n - 2, 1, motion)
        for i in range(1, end + 1, WIDTH):
            right, right_odd = two_rows(n - 2, i + WIDTH, motion)
            even = net_pull(left, here, right, i, motion)
            odd = net_pull(left_odd, here_odd, right_odd, i, motion)
            lanes.store(motion, RATE + n, i, even)
            lanes.store(motion, RATE + n + 1, i, odd)
            left = here
            here = right
            left_odd = here_odd
            here_odd = right_odd


@inner
def two_rows(n, i, motion):
    """Return rows n and n + 1 of a group, with zero for blocks that stick."""
    moves = lanes.load(motion, SLIDES, i)
    even = lanes.load(motion, RATE + n, i)
    odd = lanes.load(motion, RATE + n + 1, i)
    return lanes.only(moves, even), lanes.only(moves, odd)


@inner
def net_pull(left, here, right, i, motion):
    """Return the net force of the springs for displacements of a group and its
    neighbours: c_i (left - here) - c_{i+1} (here - right)."""
    behind = lanes.load(motion, COUPLING, i)
    ahead = lanes.load(motion, COUPLING, i + 1)
    pull = behind * lanes.behind(left, here) - (behind + ahead) * here
    return pull + ahead * lanes.ahead(here, right)


@inner
def begin(end, motion):
    """Begin a window: set rows 0 and 1 of blocks 1..end, and the spring forces from
    which `move` starts."""
    for i in range(1, end + 1, WIDTH):
        lanes.store(motion, RATE, i, lanes.load(motion, VELOCITY, i))
        lanes.store(
            motion,
            RATE + 1,
            i,
            lanes.load(motion, NET_FORCE, i) - lanes.load(motion, PUSH, i),
        )
        lanes.store(motion, FORCE_BEFORE, i, lanes.load(motion, SPRING_FORCE, i))
        lanes.store(motion, REST_BEFORE, i, lanes.load(motion, FORCE_REST, i))
    motion[FORCE_BEFORE, end + 1] = motion[SPRING_FORCE, end + 1]
    motion[REST_BEFORE, end + 1] = motion[FORCE_REST, end + 1]


@inner
def order_at(s):
    """Return the even order that is sufficient for time s of a window."""
    return ORDERS[int(PARTS * s)]


@inner
def powers(s, order, row, motion):
    """Fill a row with s^n / n! for n = 0..order + 1."""
    square = s * s
    power = lanes.pack(1.0, s, square, s * square)
    for n in range(0, order + 2, WIDTH):
        lanes.store(motion, row, n, power * lanes.load(INVERSE_FACTORIAL, 0, n))
        power = power * (square * square)


@inner
def sum_series(i, order, motion):
    """Return velocities and slips of a group at the time of WEIGHT.

    The smallest terms are summed first.
    """
    ahead = motion[WEIGHT, order + 1]
    v = v_odd = x = x_odd = lanes.spread(0.0)
    for n in range(order, 0, -2):
        even = lanes.load(motion, RATE + n, i)
        odd = lanes.load(motion, RATE + n - 1, i)
        w = motion[WEIGHT, n]
        below = motion[WEIGHT, n - 1]
        v = v + w * even
        v_odd = v_odd + below * odd
        x = x + ahead * even
        x_odd = x_odd + w * odd
        ahead = below
    start = lanes.load(motion, RATE, i)
    moves = lanes.load(motion, SLIDES, i)
    return lanes.only(moves, (v + start) + v_odd), lanes.only(
        moves, (x + ahead * start) + x_odd
    )


@inner
def move(s, end, chain, motion):
    """Move blocks 1..end to time s of the window, from the rows of its start."""
    order = order_at(s)
    powers(s, order, WEIGHT, motion)
    left = lanes.spread(chain.drive_velocity * s)
    here = here_rest = lanes.spread(0.0)
    for i in range(1, end + 1, WIDTH):
        velocity, slip = sum_series(i, order, motion)
        lanes.store(motion, VELOCITY, i, velocity)
        lanes.store(motion, SLIP, i, slip)
        change = lanes.load(motion, COUPLING, i) * (
            lanes.behind(left, slip) - slip
        ) + lanes.load(motion, REST_BEFORE, i)
        force, rest = two_sum(lanes.load(motion, FORCE_BEFORE, i), change)
        lanes.store(motion, SPRING_FORCE, i, force)
        lanes.store(motion, FORCE_REST, i, rest)
        # These values are still in registers. A load across two groups that were just
        # stored would stall.
        if i > 1:
            lanes.store(
                motion, NET_FORCE, i - WIDTH, difference(here, here_rest, force, rest)
            )
        left = slip
        here = force
        here_rest = rest
    i = end + 1
    force, rest = two_sum(
        motion[FORCE_BEFORE, i],
        motion[COUPLING, i] * motion[SLIP, end] + motion[REST_BEFORE, i],
    )
    motion[SPRING_FORCE, i] = force
    motion[FORCE_REST, i] = rest
    lanes.store(
        motion,
        NET_FORCE,
        i - WIDTH,
        difference(here, here_rest, lanes.spread(force), lanes.spread(rest)),
    )


@inner
def difference(here, here_rest, after, after_rest):
    """Return net forces on a group from the spring forces of this group and the
    next."""
    return (here - lanes.ahead(here, after)) + (
        here_rest - lanes.ahead(here_rest, after_rest)
    )


@inner
def two_sum(a, b):
    """Return the rounded sum a + b, and its rounding error."""
    total = a + b
    back = total - a
    return total, (a - (total - back)) + (b - back)


@inner
def take_net_force(i, motion):
    """Set the net force on block i from the forces of its springs."""
    motion[NET_FORCE, i] = (motion[SPRING_FORCE, i] - motion[SPRING_FORCE, i + 1]) + (
        motion[FORCE_REST, i] - motion[FORCE_REST, i + 1]
    )
