"""The chain's linear operator (Eqs. 2 and 3): Taylor series of all blocks, and moving
along them."""

from precursors.solver.kernel import lanes
from precursors.solver.kernel.arrays import row
from precursors.solver.kernel.decorators import inner
from precursors.solver.kernel.layout import INVERSE_FACTORIAL, ORDERS, PARTS, WIDTH
from precursors.solver.kernel.pointers import numbers


@inner
def expand(start, order, end, chain, motion):
    """Derivatives of blocks 1..end at the start of a window, rows start..order + 1;
    both are even.

    Where a block slides, row n is the n-th derivative of its velocity v_i: row 1 is the
    net force F_i less friction, and row n + 2 is c_i (v_{i-1} - v_i) - c_{i+1} (v_i -
    v_{i+1}) of row n (Eqs. 2 and 4). Where it sticks, its velocity is zero and the same
    rows are those of its net force: row n + 1 is the n-th derivative of F_i. Up to
    three groups of blocks stay in registers from row to row, even and odd rows side by
    side.
    """
    still = lanes.spread(0.0)
    n_groups = end // WIDTH
    if n_groups == 1:
        group1, here1, next1 = ready(start, 1, chain, motion)
        for n in range(start, order + 2):
            left = lanes.spread(row(n - 2, motion)[0])
            found1 = row_from(left, here1, still, group1, n, motion)
            here1, next1 = next1, found1
    elif n_groups == 2:
        group1, here1, next1 = ready(start, 1, chain, motion)
        group2, here2, next2 = ready(start, 1 + WIDTH, chain, motion)
        for n in range(start, order + 2):
            left = lanes.spread(row(n - 2, motion)[0])
            found1 = row_from(left, here1, here2, group1, n, motion)
            found2 = row_from(here1, here2, still, group2, n, motion)
            here1, next1 = next1, found1
            here2, next2 = next2, found2
    elif n_groups == 3:
        group1, here1, next1 = ready(start, 1, chain, motion)
        group2, here2, next2 = ready(start, 1 + WIDTH, chain, motion)
        group3, here3, next3 = ready(start, 1 + 2 * WIDTH, chain, motion)
        for n in range(start, order + 2):
            left = lanes.spread(row(n - 2, motion)[0])
            found1 = row_from(left, here1, here2, group1, n, motion)
            found2 = row_from(here1, here2, here3, group2, n, motion)
            found3 = row_from(here2, here3, still, group3, n, motion)
            here1, next1 = next1, found1
            here2, next2 = next2, found2
            here3, next3 = next3, found3
    else:
        for n in range(start, order + 2):
            left = lanes.spread(row(n - 2, motion)[0])
            _, here, _ = ready(n, 1, chain, motion)
            for i in range(1, end + 1, WIDTH):
                group, _, _ = ready(n, i, chain, motion)
                _, right, _ = ready(n, i + WIDTH, chain, motion)
                row_from(left, here, right, group, n, motion)
                left = here
                here = right


@inner
def begin(end, motion):
    """Begin a window: rows 0 and 1 of blocks 1..end, and the spring forces that `move`
    starts from."""
    force = motion.spring_force
    rest = motion.force_rest
    for i in range(1, end + 1, WIDTH):
        lanes.store(row(0, motion), i, lanes.load(motion.velocity, i))
        lanes.store(
            row(1, motion),
            i,
            lanes.load(motion.net_force, i) - lanes.load(motion.push, i),
        )
        lanes.store(motion.force_before, i, lanes.load(force, i))
        lanes.store(motion.rest_before, i, lanes.load(rest, i))
    motion.force_before[end + 1] = force[end + 1]
    motion.rest_before[end + 1] = rest[end + 1]


@inner
def ready(start, i, chain, motion):
    """A group from block i on, and the two rows before `start`, zero where blocks stick.

    A group is i, the stiffness behind and ahead of its blocks and their sum, and which
    of them move.
    """
    behind = lanes.load(chain.coupling, i)
    ahead = lanes.load(chain.coupling, i + 1)
    moves = lanes.load(motion.slides, i)
    even = lanes.load(row(start - 2, motion), i)
    odd = lanes.load(row(start - 1, motion), i)
    group = i, behind, ahead, behind + ahead, moves
    return group, lanes.only(moves, even), lanes.only(moves, odd)


@inner
def row_from(left, here, right, group, n, motion):
    """Store row n of a group from the row two before, `here`; return it with zero where
    blocks stick."""
    i, behind, ahead, both, moves = group
    found = (behind * lanes.behind(left, here) - both * here) + ahead * lanes.ahead(
        here, right
    )
    lanes.store(row(n, motion), i, found)
    return lanes.only(moves, found)


@inner
def order_at(s):
    """Even order that is enough for time s of a window."""
    return ORDERS[int(PARTS * s)]


@inner
def powers(s, order, weight):
    """Fill weight[n] = s^n / n! for n = 0..order + 1."""
    factors = numbers(INVERSE_FACTORIAL.ctypes.data)
    square = s * s
    power = lanes.pack(1.0, s, square, s * square)
    for n in range(0, order + 2, WIDTH):
        lanes.store(weight, n, power * lanes.load(factors, n))
        power = power * (square * square)


@inner
def sum_series(i, order, weight, motion):
    """Velocities and slips of a group at the time of `weight`; the smallest terms come
    first."""
    ahead = weight[order + 1]
    v = v_odd = x = x_odd = lanes.spread(0.0)
    for n in range(order, 0, -2):
        even = lanes.load(row(n, motion), i)
        odd = lanes.load(row(n - 1, motion), i)
        w = weight[n]
        below = weight[n - 1]
        v = v + w * even
        v_odd = v_odd + below * odd
        x = x + ahead * even
        x_odd = x_odd + w * odd
        ahead = below
    start = lanes.load(row(0, motion), i)
    moves = lanes.load(motion.slides, i)
    return lanes.only(moves, (v + start) + v_odd), lanes.only(
        moves, (x + ahead * start) + x_odd
    )


@inner
def move(s, end, chain, motion):
    """The state of blocks 1..end at time s of the window, from the rows of its start.

    Forces are carried in two doubles: the rounding of one would be the largest error of
    a run.
    """
    coupling = chain.coupling
    net_force = motion.net_force
    weight = motion.weight
    order = order_at(s)
    powers(s, order, weight)
    left = lanes.spread(chain.drive_velocity * s)
    here = here_rest = lanes.spread(0.0)
    for i in range(1, end + 1, WIDTH):
        velocity, slip = sum_series(i, order, weight, motion)
        lanes.store(motion.velocity, i, velocity)
        lanes.store(motion.slip, i, slip)
        change = lanes.load(coupling, i) * (
            lanes.behind(left, slip) - slip
        ) + lanes.load(motion.rest_before, i)
        force, rest = two_sum(lanes.load(motion.force_before, i), change)
        lanes.store(motion.spring_force, i, force)
        lanes.store(motion.force_rest, i, rest)
        # From values in registers: what was just stored is not loaded across two
        # groups, which would wait.
        if i > 1:
            lanes.store(net_force, i - WIDTH, difference(here, here_rest, force, rest))
        left = slip
        here = force
        here_rest = rest
    i = end + 1
    force, rest = two_sum(
        motion.force_before[i], coupling[i] * motion.slip[end] + motion.rest_before[i]
    )
    motion.spring_force[i] = force
    motion.force_rest[i] = rest
    lanes.store(
        net_force,
        i - WIDTH,
        difference(here, here_rest, lanes.spread(force), lanes.spread(rest)),
    )


@inner
def difference(here, here_rest, after, after_rest):
    """Net forces on a group, from the spring forces behind its blocks and those of the
    group after it."""
    return (here - lanes.ahead(here, after)) + (
        here_rest - lanes.ahead(here_rest, after_rest)
    )


@inner
def two_sum(a, b):
    """a + b rounded, and what the rounding took from it."""
    total = a + b
    back = total - a
    return total, (a - (total - back)) + (b - back)


@inner
def take_net_force(i, motion):
    """Net force on block i from those of its springs."""
    force = motion.spring_force
    rest = motion.force_rest
    motion.net_force[i] = (force[i] - force[i + 1]) + (rest[i] - rest[i + 1])
