"""The chain's linear operator (Eq. 2): Taylor series of the velocities, and moving along them."""

from __future__ import annotations

from precursors.solver.kernel import lanes
from precursors.solver.kernel.compiled import inner, seldom
from precursors.solver.kernel.layout import INVERSE_FACTORIAL, NEGLIGIBLE, ORDER, REACH_POWER, ROWS, WIDTH
from precursors.solver.kernel.pointers import pointer


@inner
def expand(first, final, chain, motion):
    """Taylor series of the velocities of blocks first..final from their row 0 (derivatives, rows 1..ORDER).

    Where a block slides, row 1 is T_i - T_{i+1} - mode_i mu_k w_i, and row n + 2 is
    c_i (v_{i-1} - v_i) - c_{i+1} (v_i - v_{i+1}) of row n (Eqs. 2 and 4). Columns first - 1 and final + 1
    hold the motion of the neighbours outside. Up to three groups of four blocks stay in registers from row
    to row, even and odd rows side by side.
    """
    rate, coupling, slides = motion.rate, chain.coupling, motion.slides
    force, rest = motion.spring_force, motion.force_rest
    start, stop = first, final + 1
    # A value that was just stored is not loaded across two groups, which would wait for the store.
    here, here_rest = lanes.load(force, start), lanes.load(rest, start)
    for i in range(start, stop, 4):
        if i + 4 < stop:
            after, after_rest = lanes.load(force, i + 4), lanes.load(rest, i + 4)
        else:
            after, after_rest = lanes.spread(force[stop]), lanes.spread(rest[stop])
        net = (here - lanes.ahead(here, after)) + (here_rest - lanes.ahead(here_rest, after_rest))
        lanes.store_row(rate, 1, i, lanes.load(slides, i) * net - lanes.load(motion.push, i))
        here, here_rest = after, after_rest
    groups = (stop - start) // 4
    if groups == 1:
        b1, a1, c1 = pulls(start, coupling, slides)
        even1, odd1 = lanes.load_row(rate, 0, start), lanes.load_row(rate, 1, start)
        for n in range(2, ORDER + 1, 2):
            left, right = lanes.spread(rate[n - 2, start - 1]), lanes.spread(rate[n - 2, stop])
            even1 = derive(left, even1, right, b1, a1, c1)
            lanes.store_row(rate, n, start, even1)
            left, right = lanes.spread(rate[n - 1, start - 1]), lanes.spread(rate[n - 1, stop])
            odd1 = derive(left, odd1, right, b1, a1, c1)
            lanes.store_row(rate, n + 1, start, odd1)
    elif groups == 2:
        i1, i2 = start, start + 4
        b1, a1, c1 = pulls(i1, coupling, slides)
        b2, a2, c2 = pulls(i2, coupling, slides)
        even1, odd1 = lanes.load_row(rate, 0, i1), lanes.load_row(rate, 1, i1)
        even2, odd2 = lanes.load_row(rate, 0, i2), lanes.load_row(rate, 1, i2)
        for n in range(2, ORDER + 1, 2):
            left, right = lanes.spread(rate[n - 2, start - 1]), lanes.spread(rate[n - 2, stop])
            v1, v2 = even1, even2
            even1 = derive(left, v1, v2, b1, a1, c1)
            even2 = derive(v1, v2, right, b2, a2, c2)
            lanes.store_row(rate, n, i1, even1)
            lanes.store_row(rate, n, i2, even2)
            left, right = lanes.spread(rate[n - 1, start - 1]), lanes.spread(rate[n - 1, stop])
            v1, v2 = odd1, odd2
            odd1 = derive(left, v1, v2, b1, a1, c1)
            odd2 = derive(v1, v2, right, b2, a2, c2)
            lanes.store_row(rate, n + 1, i1, odd1)
            lanes.store_row(rate, n + 1, i2, odd2)
    elif groups == 3:
        i1, i2, i3 = start, start + 4, start + 8
        b1, a1, c1 = pulls(i1, coupling, slides)
        b2, a2, c2 = pulls(i2, coupling, slides)
        b3, a3, c3 = pulls(i3, coupling, slides)
        even1, odd1 = lanes.load_row(rate, 0, i1), lanes.load_row(rate, 1, i1)
        even2, odd2 = lanes.load_row(rate, 0, i2), lanes.load_row(rate, 1, i2)
        even3, odd3 = lanes.load_row(rate, 0, i3), lanes.load_row(rate, 1, i3)
        for n in range(2, ORDER + 1, 2):
            left, right = lanes.spread(rate[n - 2, start - 1]), lanes.spread(rate[n - 2, stop])
            v1, v2, v3 = even1, even2, even3
            even1 = derive(left, v1, v2, b1, a1, c1)
            even2 = derive(v1, v2, v3, b2, a2, c2)
            even3 = derive(v2, v3, right, b3, a3, c3)
            lanes.store_row(rate, n, i1, even1)
            lanes.store_row(rate, n, i2, even2)
            lanes.store_row(rate, n, i3, even3)
            left, right = lanes.spread(rate[n - 1, start - 1]), lanes.spread(rate[n - 1, stop])
            v1, v2, v3 = odd1, odd2, odd3
            odd1 = derive(left, v1, v2, b1, a1, c1)
            odd2 = derive(v1, v2, v3, b2, a2, c2)
            odd3 = derive(v2, v3, right, b3, a3, c3)
            lanes.store_row(rate, n + 1, i1, odd1)
            lanes.store_row(rate, n + 1, i2, odd2)
            lanes.store_row(rate, n + 1, i3, odd3)
    else:
        for n in range(2, ORDER + 1):
            m = n - 2
            here = lanes.load_row(rate, m, start)
            left = lanes.spread(rate[m, start - 1])
            for i in range(start, stop, 4):
                right = lanes.load_row(rate, m, i + 4) if i + 4 < stop else lanes.spread(rate[m, stop])
                b, a, c = pulls(i, coupling, slides)
                lanes.store_row(rate, n, i, derive(left, here, right, b, a, c))
                left, here = here, right


@inner
def pulls(i, coupling, slides):
    """Stiffness behind and ahead of blocks i..i + 3 and its sum, zero where they do not move."""
    moves = lanes.load(slides, i)
    behind, ahead = moves * lanes.load(coupling, i), moves * lanes.load(coupling, i + 1)
    return behind, ahead, behind + ahead


@inner
def derive(left, here, right, back, front, both):
    """Row n + 2 of four blocks from row n of them (`here`) and of the four on either side."""
    return (back * lanes.behind(left, here) - both * here) + front * lanes.ahead(here, right)


@inner
def powers(s, weight):
    """Fill weight[n] = s^n / n! for n = 0..ORDER + 1; return the order that is enough for s."""
    ss = s * s
    power = lanes.four_of(1.0, s, ss, s * ss)
    fourth = ss * ss
    enough = ORDER
    for n in range(0, ORDER + 2, 4):
        lanes.store(weight, n, power * lanes.load(pointer(INVERSE_FACTORIAL), n))
        power = power * fourth
    while enough > 8 and weight[enough] * REACH_POWER[enough] < NEGLIGIBLE:
        enough -= 1
    return enough


@inner
def move(i, order, weight, rate, slip):
    """Carry blocks i..i + 3 along their series to the time of `weight`: velocity in row 0, slip added up."""
    n = order
    ahead = weight[n + 1]
    v = v_odd = x = x_odd = lanes.spread(0.0)
    if n % 2 == 1:
        c = lanes.load_row(rate, n, i)
        w = weight[n]
        v, x = w * c, ahead * c
        ahead = w
        n -= 1
    # The highest order first, as it is the smallest.
    for _ in range(n // 2):
        even, odd = lanes.load_row(rate, n, i), lanes.load_row(rate, n - 1, i)
        w, below = weight[n], weight[n - 1]
        v = v + w * even
        v_odd = v_odd + below * odd
        x = x + ahead * even
        x_odd = x_odd + w * odd
        ahead = below
        n -= 2
    c = lanes.load_row(rate, 0, i)
    lanes.store_row(rate, 0, i, (v + c) + v_odd)
    lanes.store(slip, i, lanes.load(slip, i) + ((x + ahead * c) + x_odd))


@inner
def settle(t, first, final, motion):
    """Bring blocks first..final, by fours from their own origin, to time t of the window: state in row 0."""
    rate, origins, slip, weight = motion.rate, motion.origins, motion.slip, motion.weight
    at, enough = weight[1], ORDER
    for i in range(first, final, WIDTH):
        s = t - origins[i]
        if s != 0.0:
            if s != at:
                at, weight = s, motion.spare
                enough = powers(s, weight)
            move(i, enough, weight, rate, slip)
            origins[i] = origins[i + 1] = origins[i + 2] = origins[i + 3] = t


@seldom
def lend(i, t, motion, column):
    """Move the origin of block i's series to time t of the window; `column` keeps what was there."""
    rate, origins, slip, weight = motion.rate, motion.origins, motion.slip, motion.spare
    for n in range(ORDER + 1):
        column[n] = rate[n, i]
    column[ROWS + 1] = slip[i]
    s = t - origins[i]
    if s == 0.0:
        return
    powers(s, weight)
    for n in range(ORDER + 1):
        slip[i] += weight[n + 1] * column[n]
        total = column[n]
        for m in range(1, ORDER + 1 - n):
            total += weight[m] * column[n + m]
        rate[n, i] = total


@seldom
def give_back(i, motion, column):
    """Undo `lend`."""
    rate, slip = motion.rate, motion.slip
    for n in range(ORDER + 1):
        rate[n, i] = column[n]
    slip[i] = column[ROWS + 1]


@seldom
def distance_reached(span):
    """Distance beyond which a transition is not felt within `span`, in blocks."""
    d, term = 1, span * span * span / 6.0
    while term > NEGLIGIBLE:
        d += 1
        term *= span * span / (2 * d * (2 * d + 1))
    return d
