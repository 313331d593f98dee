"""The chain's linear operator (Eq. 2): Taylor series of the velocities, and moving along them."""

from __future__ import annotations

from precursors.solver.kernel import lanes
from precursors.solver.kernel.compiled import EIGHT, FOUR, ONE, THREE, TWO, ZERO, index, inner, seldom
from precursors.solver.kernel.layout import INVERSE_FACTORIAL, NEGLIGIBLE, REACH, REACH_POWER, ROWS, WIDTH


@inner
def expand(first, final, order, coupling, additions, tension, motion):
    """Taylor series of the velocities of blocks first..final from their row 0: the chain's linear operator.

    `mobile` is r_i where a block moves, else 0, and `push` the force against it, times r_i.
    """
    rate, mobile, push = motion.rate, motion.mobile, motion.push
    if additions is None:
        expand_plain(first, final, order, coupling, mobile, push, tension, rate)
    else:
        expand_linked(first, final, order, coupling, mobile, push, additions, tension, rate)


@inner
def expand_plain(first, final, order, coupling, mobile, push, tension, rate):
    """Taylor series of the velocities of blocks first..final from their row 0 (derivatives, rows 1..order).

    Row n + 2 is r_i c_i (v_{i-1} - v_i) - r_i c_{i+1} (v_i - v_{i+1}) of row n, `pulls` being r_i c_i and
    r_i c_{i+1}. Columns first - 1 and final + 1 hold the motion of the neighbours outside. One or
    three groups of four stay in registers from row to row, even and odd rows side by side.
    """
    start, stop = index(first), index(final) + ONE
    for i in range(start, stop, FOUR):
        net = lanes.load(tension, i) - lanes.load(tension, i + ONE)
        lanes.store_row(rate, ONE, i, lanes.load(mobile, i) * net - lanes.load(push, i))
    rows = range(TWO, index(order) + ONE, TWO)
    groups = (stop - start) // FOUR
    if groups == ONE:
        b1, a1 = pulls(start, coupling, mobile)
        even1, odd1 = lanes.load_row(rate, ZERO, start), lanes.load_row(rate, ONE, start)
        for n in rows:
            left, right = lanes.spread(rate[n - TWO, start - ONE]), lanes.spread(rate[n - TWO, stop])
            even1 = derive(left, even1, right, b1, a1)
            lanes.store_row(rate, n, start, even1)
            left, right = lanes.spread(rate[n - ONE, start - ONE]), lanes.spread(rate[n - ONE, stop])
            odd1 = derive(left, odd1, right, b1, a1)
            lanes.store_row(rate, n + ONE, start, odd1)
    elif groups == THREE:
        i1, i2, i3 = start, start + FOUR, start + EIGHT
        b1, a1 = pulls(i1, coupling, mobile)
        b2, a2 = pulls(i2, coupling, mobile)
        b3, a3 = pulls(i3, coupling, mobile)
        even1, odd1 = lanes.load_row(rate, ZERO, i1), lanes.load_row(rate, ONE, i1)
        even2, odd2 = lanes.load_row(rate, ZERO, i2), lanes.load_row(rate, ONE, i2)
        even3, odd3 = lanes.load_row(rate, ZERO, i3), lanes.load_row(rate, ONE, i3)
        for n in rows:
            left, right = lanes.spread(rate[n - TWO, start - ONE]), lanes.spread(rate[n - TWO, stop])
            v1, v2, v3 = even1, even2, even3
            even1 = derive(left, v1, v2, b1, a1)
            even2 = derive(v1, v2, v3, b2, a2)
            even3 = derive(v2, v3, right, b3, a3)
            lanes.store_row(rate, n, i1, even1)
            lanes.store_row(rate, n, i2, even2)
            lanes.store_row(rate, n, i3, even3)
            left, right = lanes.spread(rate[n - ONE, start - ONE]), lanes.spread(rate[n - ONE, stop])
            v1, v2, v3 = odd1, odd2, odd3
            odd1 = derive(left, v1, v2, b1, a1)
            odd2 = derive(v1, v2, v3, b2, a2)
            odd3 = derive(v2, v3, right, b3, a3)
            lanes.store_row(rate, n + ONE, i1, odd1)
            lanes.store_row(rate, n + ONE, i2, odd2)
            lanes.store_row(rate, n + ONE, i3, odd3)
    else:
        for n in range(TWO, index(order) + ONE):
            m = n - TWO
            here = lanes.load_row(rate, m, start)
            left = lanes.spread(rate[m, start - ONE])
            for i in range(start, stop, FOUR):
                right = lanes.load_row(rate, m, i + FOUR) if i + FOUR < stop else lanes.spread(rate[m, stop])
                b, a = pulls(i, coupling, mobile)
                lanes.store_row(rate, n, i, derive(left, here, right, b, a))
                left, here = here, right


@inner
def expand_linked(first, final, order, coupling, mobile, push, additions, tension, rate):
    """Do what `expand_plain` does, with dashpots and interface springs; r_i p_i pushes a stuck block."""
    start, stop = index(first), index(final) + ONE
    for i in range(start, stop, FOUR):
        net = lanes.load(tension, i) - lanes.load(tension, i + ONE)
        here = lanes.load_row(rate, ZERO, i)
        net = net + lanes.load(additions.dashpot, i) * (lanes.load_row(rate, ZERO, i - ONE) - here)
        net = net - lanes.load(additions.dashpot, i + ONE) * (here - lanes.load_row(rate, ZERO, i + ONE))
        lanes.store_row(rate, ONE, i, lanes.load(mobile, i) * net - lanes.load(push, i))
    for n in range(TWO, index(order) + ONE):
        m, k = n - TWO, n - ONE
        here, above = lanes.load_row(rate, m, start), lanes.load_row(rate, k, start)
        left, left_above = lanes.spread(rate[m, start - ONE]), lanes.spread(rate[k, start - ONE])
        for i in range(start, stop, FOUR):
            right, right_above = lanes.spread(rate[m, stop]), lanes.spread(rate[k, stop])
            if i + FOUR < stop:
                right, right_above = lanes.load_row(rate, m, i + FOUR), lanes.load_row(rate, k, i + FOUR)
            b, a = pulls(i, coupling, mobile)
            row = derive(left, here, right, b, a) - lanes.load(additions.hold, i) * here
            b, a = pulls(i, additions.dashpot, mobile)
            lanes.store_row(rate, n, i, row + derive(left_above, above, right_above, b, a))
            left, here = here, right
            left_above, above = above, right_above


@inner
def pulls(i, coupling, mobile):
    """Stiffness behind and ahead of blocks i..i + 3 where they move, zero where they do not."""
    moves = lanes.load(mobile, i)
    return moves * lanes.load(coupling, i), moves * lanes.load(coupling, i + ONE)


@inner
def derive(left, here, right, back, front):
    """Row n + 2 of four blocks from row n of them (`here`) and of the four on either side."""
    return back * (lanes.behind(left, here) - here) - front * (here - lanes.ahead(here, right))


@inner
def powers(s, order, weight):
    """Fill weight[n] = s^n / n! for n = 0..order + 1; return the order that is enough for s."""
    ss = s * s
    power = lanes.four_of(1.0, s, ss, s * ss)
    fourth = ss * ss
    enough = order
    for n in range(ZERO, index(order) + TWO, FOUR):
        lanes.store(weight, n, power * lanes.load(INVERSE_FACTORIAL, n))
        power = power * fourth
    while enough > 8 and weight[enough] * REACH_POWER[enough] < NEGLIGIBLE:
        enough -= 1
    return enough


@inner
def move(i, order, weight, rate, slip):
    """Carry blocks i..i + 3 along their series to the time of `weight`: velocity in row 0, slip added up."""
    n = index(order)
    ahead = weight[n + ONE]
    v = v_odd = x = x_odd = lanes.spread(0.0)
    if n % TWO == ONE:
        c = lanes.load_row(rate, n, i)
        w = weight[n]
        v, x = w * c, ahead * c
        ahead = w
        n -= ONE
    # The highest order first, as it is the smallest.
    for _ in range(n // TWO):
        even, odd = lanes.load_row(rate, n, i), lanes.load_row(rate, n - ONE, i)
        w, below = weight[n], weight[n - ONE]
        v = v + w * even
        v_odd = v_odd + below * odd
        x = x + ahead * even
        x_odd = x_odd + w * odd
        ahead = below
        n -= TWO
    c = lanes.load_row(rate, ZERO, i)
    lanes.store_row(rate, ZERO, i, (v + c) + v_odd)
    lanes.store(slip, i, lanes.load(slip, i) + ((x + ahead * c) + x_odd))


@inner
def settle(t, first, final, order, motion):
    """Bring blocks first..final, by fours from their own origin, to time t of the window: state in row 0."""
    rate, origins, slip, weight = motion.rate, motion.origins, motion.slip, motion.weight
    at = 0.0
    enough = order
    for i in range(first, final, WIDTH):
        s = t - origins[i]
        if s != 0.0:
            if s != at:
                enough = powers(s, order, weight)
                at = s
            move(i, enough, weight, rate, slip)
            origins[i] = origins[i + 1] = origins[i + 2] = origins[i + 3] = t


@seldom
def lend(i, t, order, motion, column):
    """Move the origin of block i's series to time t of the window; `column` keeps what was there."""
    rate, origins, slip, weight = motion.rate, motion.origins, motion.slip, motion.weight
    for n in range(order + 1):
        column[n] = rate[n, i]
    column[ROWS + 1] = slip[i]
    s = t - origins[i]
    if s == 0.0:
        return
    powers(s, order, weight)
    for n in range(order + 1):
        slip[i] += weight[n + 1] * column[n]
        total = column[n]
        for m in range(1, order + 1 - n):
            total += weight[m] * column[n + m]
        rate[n, i] = total


@seldom
def give_back(i, order, motion, column):
    """Undo `lend`."""
    rate, slip = motion.rate, motion.slip
    for n in range(order + 1):
        rate[n, i] = column[n]
    slip[i] = column[ROWS + 1]


@seldom
def order_for(length):
    """Order at which the series of a window may be cut."""
    n, term = 8, 1.0
    for m in range(1, n + 1):
        term *= REACH * length / m
    while term > NEGLIGIBLE and n < ROWS - 1:
        n += 1
        term *= REACH * length / n
    return n


@seldom
def distance_reached(span, additions):
    """Distance beyond which a transition is not felt within `span`, in blocks."""
    if additions is not None:
        d, term = 1, span * span / 2.0
        while term > NEGLIGIBLE:
            d += 1
            term *= span / (d + 1)
        return d
    d, term = 1, span * span * span / 6.0
    while term > NEGLIGIBLE:
        d += 1
        term *= span * span / (2 * d * (2 * d + 1))
    return d
