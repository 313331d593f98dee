"""The compiled kernel: the chain's linear operator, its Taylor series, the earliest root and the event loop.

Between two transitions the blocks that slide obey a linear system with constant friction and a load that
grows linearly in time; its solution is summed as a Taylor series to rounding. The next transition is the
earliest root of a velocity (a sliding block stops) or of a stick margin mu_s w_i -+ F_i (a stuck block
lets go). With |g''| <= M on the window, the positive root of g + g' s - M s^2/2 is a step that cannot pass
a root of g; repeated on the function whose bound is smallest, it converges to the earliest root of all or
proves that the window holds none. A cubic with the rest of the series as its error bound is tried first.

Inside, forces are in N, displacements are multiplied by m/tau^2 into N, time is in tau and velocity in N/tau,
with tau such that the highest frequency of the chain times tau is at most `REACH`. The state is the force
T_i in the spring behind each block and its velocity v_i, not its position: slips of a micrometre after a
millimetre of drive keep all their digits. In these units the motion is

    dT_i/dt = c_i (v_{i-1} - v_i),    dv_i/dt = T_i - T_{i+1} - mode_i mu_k w_i   where block i slides.

Column 0 of every array is the drive, columns 1..N are the blocks; beyond them is room for groups of four.

A transition changes the motion of blocks at distance d only in order 2 d + 1 of the time since. In a long
chain each group of blocks therefore keeps Taylor series about a time of its own within a common window, and a
transition renews those of its neighbourhood only.

All compiled code is in this one file, because a compile cache does not see an edit in an imported file.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numba import int64, njit

from precursors import lanes
from precursors.chain import Chain, FloatArray

REACH = 2.0
# Rows of the Taylor arrays; the series of a window of length r is cut where (REACH r)^n / n! < NEGLIGIBLE.
ROWS = 30
# Blocks are worked on four at a time, so that loops are short and foreseeable.
WIDTH = 4
# Columns beyond block N: the free end, and room for up to three blocks that are not there.
BEYOND = WIDTH
NEGLIGIBLE = 1e-19
# Chains whose moving part is longer than LONG blocks renew neighbourhoods only, in windows of LONG_WINDOW.
LONG = 24
SHORT_WINDOW, LONG_WINDOW = 0.6875, 0.5
# A value below so many roundings of the forces it was computed from counts as zero. Where transitions follow
# one another without time going on, rounding decides in a circle: the doubt grows until it does not.
ROUNDINGS = 8 * float(np.finfo(float).eps)

FINISHED, GLOBAL_SLIP, PAUSED = 0, 1, 2

# `clock`: time of the event's onset and its rounding error [s], time since then [tau], time since the last
# transition [tau]. `count`: transitions, sliding blocks, whether all slid at once, stored states, windows,
# derivatives of single blocks that were computed, steps of the root search, and how the run ended.
ONSET, ONSET_ERROR, ELAPSED, SINCE = range(4)
TRANSITIONS, SLIDING, GLOBAL, STORED, WINDOWS, DERIVATIVES, ROOT_STEPS, STATUS = range(8)
CLOCK_SIZE, COUNT_SIZE = 4, 8

# What a bound is from: nothing yet, though the series is there; one step; the cubic; the whole series; or it
# is the root itself. Columns of `level`.
BUILT, ROUGH, CUBIC, WHOLE, FINAL = range(5)
ORIGIN, SPAN, DOUBT, BEND, TURN, POWER, C0, C1, C2, C3, REST, STEPS = range(12)
LEVELS = 12
CUBIC_STEPS = 4
# A search that takes so many steps starts anew from where it is: near a flat start its steps are tiny.
RESTART = 12

REACH_SQUARED = REACH * REACH
# Sum of the geometric bound of the tail of a series relative to its first term, for spans up to 1.
TAIL = 1.1
INVERSE_FACTORIAL = np.array([1.0 / math.factorial(n) for n in range(ROWS + WIDTH)])
SECOND_DERIVATIVE = np.array([n * (n - 1.0) for n in range(ROWS + 1)])
REACH_POWER = REACH ** np.arange(ROWS + 1.0)

# Numba guards every index that may be negative; unsigned ones, and constants of their kind, save that time.
index = np.uint64
ZERO, ONE, TWO, THREE, FOUR, FIVE, SIX, SEVEN, EIGHT = (np.uint64(n) for n in range(9))
# An index that starts from a literal is typed: what it goes to would be compiled for the literal anew.
INDEX = {"first": int64, "slot": int64}
# Products may be fused with sums. Only `outer` code allocates, and only there references are counted (`_nrt`),
# as that takes longer than the arithmetic; so does passing arrays to a function: hence what is inlined.
options: Any = {
    "cache": True,
    "error_model": "numpy",
    "fastmath": {"contract"},
    "locals": INDEX,
    "_nrt": False,
}
inner = njit(**options, forceinline=True)
seldom = njit(**options)
outer = njit(cache=True, error_model="numpy", nogil=True, locals=INDEX)


class System(NamedTuple):
    """A chain in the kernel's units; columns as in the module's docstring."""

    tau: float
    drive_velocity: float
    coupling: FloatArray
    strength: FloatArray
    friction: FloatArray


def width(n_blocks: int) -> int:
    """Number of columns of a chain's arrays."""
    return n_blocks + 1 + BEYOND


def parameters(chain: Chain) -> tuple[float, float, float, float, float, float]:
    """What `set_up` takes of a chain beside its weights."""
    return (
        chain.mass,
        chain.stiffness,
        chain.drive_stiffness,
        chain.drive_velocity,
        chain.mu_s,
        chain.mu_k,
    )


def scale(chain: Chain) -> System:
    """Express a chain in the kernel's units."""
    coupling, strength, friction = np.zeros((3, width(chain.n_blocks)))
    # A copy, as the compiled code is for arrays that may be written to.
    weights = chain.weights.copy()
    tau, drive_velocity = set_up(np.array(parameters(chain)), weights, coupling, strength, friction)
    return System(tau, drive_velocity, coupling, strength, friction)


@outer
def set_up(parameters, weights, coupling, strength, friction):
    """Fill a chain's columns in the kernel's units; return tau [s] and the drive's velocity [N/tau].

    tau follows from Gershgorin's bound of the largest frequency.
    """
    mass, stiffness, drive_stiffness, drive_velocity, mu_s, mu_k = parameters
    n_blocks = weights.shape[0]
    stiffest = 0.0
    for i in range(n_blocks):
        behind = stiffness if i > 0 else drive_stiffness
        ahead = stiffness if i < n_blocks - 1 else 0.0
        stiffest = max(stiffest, behind + ahead + (behind if i > 0 else 0.0) + ahead)
    tau = REACH * math.sqrt(mass / stiffest)
    for i in range(n_blocks):
        spring = stiffness if i > 0 else drive_stiffness
        coupling[i + 1] = spring * (tau * tau / mass)
        strength[i + 1] = mu_s * weights[i]
        friction[i + 1] = mu_k * weights[i]
    return tau, drive_velocity * mass / tau


@inner
def expand(coupling, mobile, push, first, final, order, tension, rate):
    """Taylor series of the velocities of blocks first..final from their row 0 (derivatives, rows 1..order).

    This is the chain's linear operator: whatever else acts linearly between transitions belongs here.
    `mobile` is 1 where a block slides and `push` its kinetic friction with the sign of its mode; `tension`
    holds the spring forces. Columns first - 1 and final + 1 hold the motion of the neighbours outside.
    Few groups of four stay in registers from row to row, even and odd rows side by side.
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
def pulls(i, coupling, mobile):
    """Stiffness behind and ahead of blocks i..i + 3 where they slide, zero where they do not."""
    slides = lanes.load(mobile, i)
    return slides * lanes.load(coupling, i), slides * lanes.load(coupling, i + ONE)


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
def stretch(first, final, coupling, slip, tension_before, tension):
    """Forces of the springs from behind block first to ahead of `final`, after the slips in the window."""
    for i in range(index(first), index(final) + ONE, FOUR):
        longer = lanes.load(slip, i - ONE) - lanes.load(slip, i)
        lanes.store(tension, i, lanes.load(tension_before, i) + lanes.load(coupling, i) * longer)
    i = index(final) + ONE
    tension[i] = tension_before[i] + coupling[i] * (slip[i - ONE] - slip[i])


@inner
def safe_step(g, slope, curvature):
    """Positive root of g + slope s - curvature s^2/2 for g >= 0: no root of g lies before it."""
    root = math.sqrt(slope * slope + 2.0 * curvature * g)
    if slope < 0.0:
        return 2.0 * g / (root - slope)
    return (slope + root) / curvature if curvature > 0.0 else np.inf


@inner
def tail_bound(first, final, end, order, span, rate):
    """Bounds of the terms from the eighth on of the velocity series of blocks first..final: sum, curvature.

    Row n + 2 of a block is at most REACH^2 times the largest of row n (Gershgorin); moving neighbours
    outside, in columns first - 1 and final + 1, enter with all their rows, which follow from others.
    """
    sixth_row = seventh_row = lanes.spread(0.0)
    for i in range(index(first), index(final) + ONE, FOUR):
        sixth_row = lanes.larger(sixth_row, lanes.magnitude(lanes.load_row(rate, SIX, i)))
        seventh_row = lanes.larger(seventh_row, lanes.magnitude(lanes.load_row(rate, SEVEN, i)))
    even = max(lanes.largest(sixth_row), abs(rate[SIX, first - 1]), abs(rate[SIX, final + 1]))
    odd = max(lanes.largest(seventh_row), abs(rate[SEVEN, first - 1]), abs(rate[SEVEN, final + 1]))
    if first > 1 or final < end:
        shrink = 1.0
        for n in range(8, order + 1):
            if n % 2 == 0:
                shrink /= REACH_SQUARED
                even = max(even, shrink * abs(rate[n, first - 1]), shrink * abs(rate[n, final + 1]))
            else:
                odd = max(odd, shrink * abs(rate[n, first - 1]), shrink * abs(rate[n, final + 1]))
    # Each of the two sums is geometric at worst.
    square = span * span
    sixth = REACH_SQUARED * TAIL * square * square * square
    value = sixth * square * (even * INVERSE_FACTORIAL[8] + odd * span * INVERSE_FACTORIAL[9])
    return value, sixth * square * (even * INVERSE_FACTORIAL[6] + odd * span * INVERSE_FACTORIAL[7])


@inner
def cubic_bound(c0, c1, c2, c3, rest):
    """Bound the first root of c0 + c1 s + c2 s^2 + c3 s^3 + e, |e| <= rest s^4, from below; inf beyond 1."""
    curvature = downward(c2, c3) + 12.0 * rest
    s = safe_step(c0, c1, curvature)
    for _ in range(CUBIC_STEPS):
        if s >= 1.0:
            return np.inf
        ss = s * s
        g = c0 + s * (c1 + s * (c2 + s * c3)) - rest * ss * ss
        if g <= 0.01 * c0:
            return s
        s += safe_step(g, c1 + s * (2.0 * c2 + s * 3.0 * c3) - 4.0 * rest * ss * s, curvature)
    return s


@inner
def downward(c2, c3):
    """Bound of -g'' of a cubic on [0, 1]."""
    return 2.0 * max(-c2, 0.0) + 6.0 * max(-c3, 0.0)


@inner
def turning(c2, c3):
    """Bound of |g''| of a cubic on [0, 1]."""
    return 2.0 * abs(c2) + 6.0 * abs(c3)


@inner
def surely_positive(c0, c1, c2, c3, rest):
    """Whether c0 + c1 s + c2 s^2 + c3 s^3 + e, |e| <= rest, has no root in [0, 1]."""
    return c0 + min(c1, 0.0) + min(c2, 0.0) + min(c3, 0.0) > rest


@inner
def examine(slot, count, series, level, terms, stage):
    """Bound the first root of series[slot] (time in spans) from below.

    A root at the start was dealt with already: it is divided out. Where the function then falls, the
    transition is at once.
    """
    row = index(slot)
    count = index(count)
    p = ZERO
    while p < count and abs(series[row, p]) <= level[slot, DOUBT]:
        p += ONE
    if p == count:
        return np.inf
    if series[row, p] < 0.0:
        stage[slot] = FINAL
        return level[slot, ORIGIN]
    divide_out(row, p, count, series)
    count = max(count - p, FOUR)
    c0, c1, c2, c3 = series[row, ZERO], series[row, ONE], series[row, TWO], series[row, THREE]
    rest = 0.0
    bend = 0.0
    for n in range(FOUR, count):
        c = abs(series[row, n])
        rest += c
        bend += SECOND_DERIVATIVE[n] * c
    if surely_positive(c0, c1, c2, c3, rest):
        return np.inf
    terms[slot] = count
    level[slot, BEND] = downward(c2, c3) + bend
    level[slot, TURN] = turning(c2, c3) + bend
    level[slot, STEPS] = 0.0
    stage[slot] = WHOLE
    return level[slot, ORIGIN] + cubic_bound(c0, c1, c2, c3, rest) * level[slot, SPAN]


@inner
def divide_out(row, p, count, series):
    """Divide series[row] by s^p; it keeps at least four terms."""
    if p > ZERO:
        for n in range(count - p):
            series[row, n] = series[row, n + p]
        for n in range(count - p, FOUR):
            series[row, n] = 0.0


@inner
def refine(slot, t, series, level, terms, stage):
    """Step from the bound t towards the root of a watched function; it is FINAL once it is the root."""
    row = index(slot)
    span = level[slot, SPAN]
    x = (t - level[slot, ORIGIN]) / span
    # Even and odd terms apart, for two short chains of operations instead of a long one.
    y = x * x
    top = index(terms[slot] - 1) // TWO
    even = series[row, TWO * top]
    odd = series[row, TWO * top + ONE] if terms[slot] % 2 == 0 else 0.0
    even_slope = 0.0
    odd_slope = 0.0
    for k in range(ONE, top + ONE):
        n = TWO * (top - k)
        even_slope = even_slope * y + even
        odd_slope = odd_slope * y + odd
        even = even * y + series[row, n]
        odd = odd * y + series[row, n + ONE]
    g = even + x * odd
    slope = odd + 2.0 * x * (even_slope + x * odd_slope)
    if slope < 0.0:
        # Newton's step, where it ends so near to the root that the value there counts as zero.
        step = max(-g / slope, -1e-9)
        if g <= level[slot, DOUBT] or 0.5 * level[slot, TURN] * step * step <= level[slot, DOUBT]:
            stage[slot] = FINAL
            return level[slot, ORIGIN] + max(x + step, 0.0) * span
    step = safe_step(max(g, 0.0), slope, level[slot, BEND])
    if g <= level[slot, DOUBT] or x + step <= x:
        stage[slot] = FINAL
        step = 0.0
    return level[slot, ORIGIN] + max(x + step, 0.0) * span


@seldom
def examine_from(slot, t, series, level, terms, stage):
    """Examine the rest of the window beyond t, which no root lies before, with the series moved there."""
    row = index(slot)
    count = index(terms[slot])
    x = (t - level[slot, ORIGIN]) / level[slot, SPAN]
    for first in range(count - ONE):
        for k in range(count - ONE - first):
            n = count - TWO - k
            series[row, n] += x * series[row, n + ONE]
    rest = 1.0 - x
    power = 1.0
    for n in range(count):
        series[row, n] *= power
        power *= rest
    level[slot, ORIGIN] = t
    level[slot, SPAN] *= rest
    if series[row, ZERO] <= level[slot, DOUBT]:
        stage[slot] = FINAL
        return t
    return examine(slot, terms[slot], series, level, terms, stage)


@inner
def grain(i, doubt, coupling, strength, tension, fastest):
    """Size below which a force on block i, or what it does to its velocity in the window, counts as zero.

    From the forces, and from what the motion of the neighbours adds to them within the window.
    """
    still = abs(tension[i]) + abs(tension[i + ONE]) + strength[i]
    moving = coupling[i] * fastest[i - ONE] + fastest[i] + coupling[i + ONE] * fastest[i + ONE]
    return doubt * (2.0 * still + moving)


@inner
def margin_series(slot, i, order, coupling, strength, tension, rate, weight, series):
    """Series of the margin of stuck block i against letting go forward (even slot) or backward (odd slot)."""
    row, i = index(slot), index(i)
    side = 1.0 - 2.0 * (row % TWO)
    b, a = coupling[i], coupling[i + ONE]
    series[row, ZERO] = strength[i] - side * (tension[i] - tension[i + ONE])
    for n in range(ONE, index(order) + ONE):
        growth = b * rate[n - ONE, i - ONE] + a * rate[n - ONE, i + ONE]
        series[row, n] = -side * growth * weight[n]


@inner
def may_stop(i, tail, mobile, sense, rate, weight, fastest):
    """Bits of those of blocks i..i + 3 that slide and may stop in the window; `fastest` is set for all four.

    The test is that of `surely_positive`, with the size of each term from the fourth on and the tail as rest.
    """
    slides, sign = lanes.load(mobile, i), lanes.load(sense, i)
    c0 = sign * lanes.load_row(rate, ZERO, i)
    c1 = sign * (lanes.load_row(rate, ONE, i) * weight[ONE])
    c2 = sign * (lanes.load_row(rate, TWO, i) * weight[TWO])
    c3 = sign * (lanes.load_row(rate, THREE, i) * weight[THREE])
    rest = (size(FOUR, i, rate, weight) + size(FIVE, i, rate, weight)) + (
        size(SIX, i, rate, weight) + size(SEVEN, i, rate, weight)
    )
    rest = rest + tail
    total = (lanes.magnitude(c0) + lanes.magnitude(c1)) + (lanes.magnitude(c2) + lanes.magnitude(c3)) + rest
    lanes.store(fastest, i, total * slides)
    zero = lanes.spread(0.0)
    least = (c0 + lanes.smaller(c1, zero)) + (lanes.smaller(c2, zero) + lanes.smaller(c3, zero))
    return lanes.where_not_above(least, slides * rest - (1.0 - slides))


@inner
def size(n, i, rate, weight):
    """Largest value of term n of the series of blocks i..i + 3 in the window."""
    return lanes.magnitude(lanes.load_row(rate, n, i)) * weight[n]


@inner
def may_let_go(i, span, coupling, strength, mobile, tension, fastest):
    """Bits of those of blocks i..i + 3 that stick and may let go in the window."""
    slides = lanes.load(mobile, i)
    still = 1.0 - slides
    net = lanes.magnitude(lanes.load(tension, i) - lanes.load(tension, i + ONE))
    change = lanes.load(coupling, i) * lanes.load(fastest, i - ONE)
    change = (change + lanes.load(coupling, i + ONE) * lanes.load(fastest, i + ONE)) * span
    return lanes.where_not_above(still * (lanes.load(strength, i) - net), still * change - slides)


@inner
def watch(
    first,
    final,
    last,
    end,
    is_long,
    origin,
    span,
    order,
    coupling,
    strength,
    mode,
    mobile,
    sense,
    tension,
    rate,
    weight,
    fastest,
    suspects,
    series,
    level,
    terms,
    stage,
    bound,
    active,
    doubt,
):
    """Bound the next transition of blocks first..last from below, as times in the window.

    Slot 2 i watches the velocity of block i while it slides, or its margin against letting go forward while
    it sticks; slot 2 i + 1 its margin against letting go backward. active[1:active[0] + 1] are the slots that
    may have a root, `fastest` bounds the speeds in the window, and a value counts as zero below the relative
    size `doubt`.
    """
    kept = 0
    for k in range(1, active[0] + 1):
        if active[k] < 2 * first or active[k] > 2 * final + 1:
            kept += 1
            active[kept] = active[k]
    active[0] = kept
    tail, tail_bend = tail_bound(first, final, end, order, span, rate)
    start, stop = index(first), index(final) + ONE
    for group in range(start, stop, FOUR):
        suspects[group] = may_stop(group, tail, mobile, sense, rate, weight, fastest)
    for group in range(start, stop, FOUR):
        bits = suspects[group] | may_let_go(group, span, coupling, strength, mobile, tension, fastest)
        i = group
        while bits != ZERO and i <= index(last):
            if bits & ONE:
                zero = grain(i, doubt, coupling, strength, tension, fastest)
                if mode[i] != 0:
                    watch_velocity(
                        i,
                        origin,
                        span,
                        order,
                        mode[i],
                        rate,
                        weight,
                        zero,
                        tail,
                        tail_bend,
                        series,
                        level,
                        stage,
                        bound,
                        active,
                    )
                else:
                    watch_margins(
                        i,
                        is_long,
                        origin,
                        span,
                        order,
                        coupling,
                        strength,
                        tension,
                        rate,
                        weight,
                        fastest,
                        zero,
                        tail,
                        tail_bend,
                        series,
                        level,
                        stage,
                        bound,
                        active,
                    )
            bits >>= ONE
            i += ONE


@inner
def watch_velocity(
    i,
    origin,
    span,
    order,
    sign,
    rate,
    weight,
    zero,
    tail,
    tail_bend,
    series,
    level,
    stage,
    bound,
    active,
):
    """Bound the time at which sliding block i stops from below."""
    slot = TWO * i
    w1, w2, w3, w4 = weight[1], weight[2], weight[3], weight[4]
    c0, c1 = sign * rate[ZERO, i], sign * rate[ONE, i] * w1
    c2, c3 = sign * rate[TWO, i] * w2, sign * rate[THREE, i] * w3
    r4, r5 = abs(rate[FOUR, i]) * w4, abs(rate[FIVE, i]) * weight[5]
    r6, r7 = abs(rate[SIX, i]) * weight[6], abs(rate[SEVEN, i]) * weight[7]
    rest = (r4 + r5) + (r6 + r7) + tail
    level[slot, ORIGIN], level[slot, SPAN], level[slot, DOUBT] = origin, span, zero
    if c0 > zero:
        level[slot, POWER] = 0.0
        bend = 12.0 * r4 + 20.0 * r5 + 30.0 * r6 + 42.0 * r7 + tail_bend
    elif c0 >= -zero and c1 > zero:
        # It has just begun to move: the root at the start is divided out.
        c0, c1, c2, c3 = c1, c2, c3, sign * rate[FOUR, i] * w4
        rest = r5 + r6 + r7 + tail
        if surely_positive(c0, c1, c2, c3, rest):
            return
        level[slot, POWER] = 1.0
        bend = 12.0 * r5 + 20.0 * r6 + 30.0 * r7 + tail_bend
    else:
        for n in range(index(order) + ONE):
            series[slot, n] = sign * rate[n, i] * weight[n]
        stage[slot], bound[slot] = BUILT, origin
        keep(slot, active)
        return
    level[slot, BEND], level[slot, TURN] = downward(c2, c3) + bend, turning(c2, c3) + bend
    level[slot, C0], level[slot, C1], level[slot, C2], level[slot, C3] = c0, c1, c2, c3
    level[slot, REST] = rest
    stage[slot] = ROUGH
    bound[slot] = origin + safe_step(c0, c1, downward(c2, c3) + 12.0 * rest) * span
    if bound[slot] < origin + span:
        keep(slot, active)


@inner
def watch_margins(
    i,
    is_long,
    origin,
    span,
    order,
    coupling,
    strength,
    tension,
    rate,
    weight,
    fastest,
    zero,
    tail,
    tail_bend,
    series,
    level,
    stage,
    bound,
    active,
):
    """Bound the times at which stuck block i lets go forward or backward from below."""
    near, far = i - ONE, i + ONE
    b, a = coupling[i], coupling[far]
    if b * fastest[near] + a * fastest[far] == 0.0:
        return
    net = tension[i] - tension[far]
    # The net force grows with the velocities of the neighbours.
    g1 = (b * rate[ZERO, near] + a * rate[ZERO, far]) * weight[1]
    g2 = (b * rate[ONE, near] + a * rate[ONE, far]) * weight[2]
    g3 = (b * rate[TWO, near] + a * rate[TWO, far]) * weight[3]
    r4 = abs(b * rate[THREE, near] + a * rate[THREE, far]) * weight[4]
    r5 = abs(b * rate[FOUR, near] + a * rate[FOUR, far]) * weight[5]
    r6 = abs(b * rate[FIVE, near] + a * rate[FIVE, far]) * weight[6]
    r7 = abs(b * rate[SIX, near] + a * rate[SIX, far]) * weight[7]
    r8 = abs(b * rate[SEVEN, near] + a * rate[SEVEN, far]) * weight[8]
    rest = (r4 + r5) + (r6 + r7) + (r8 + (a + b) * tail * span / 9.0)
    for k in range(TWO):
        side = 1.0 - 2.0 * k
        c0, c1, c2, c3 = strength[i] - side * net, -side * g1, -side * g2, -side * g3
        if surely_positive(c0, c1, c2, c3, rest):
            continue
        slot = TWO * i + k
        level[slot, ORIGIN], level[slot, SPAN], level[slot, DOUBT] = origin, span, zero
        if c0 > zero and not is_long:
            level[slot, POWER] = 0.0
            bend = 12.0 * r4 + 20.0 * r5 + 30.0 * r6 + 42.0 * r7 + 56.0 * r8
            bend += (a + b) * tail_bend * span / 7.0
            level[slot, BEND], level[slot, TURN] = downward(c2, c3) + bend, turning(c2, c3) + bend
            level[slot, C0], level[slot, C1], level[slot, C2], level[slot, C3] = c0, c1, c2, c3
            level[slot, REST] = rest
            stage[slot] = ROUGH
            bound[slot] = origin + safe_step(c0, c1, downward(c2, c3) + 12.0 * rest) * span
        else:
            # The series of the neighbours may get other origins before this one is looked at again.
            margin_series(slot, i, order, coupling, strength, tension, rate, weight, series)
            stage[slot], bound[slot] = BUILT, origin
        if bound[slot] < origin + span:
            keep(slot, active)


@inner
def keep(slot, active):
    """Add a slot to those that may have a root."""
    active[0] += 1
    active[active[0]] = slot


@inner
def next_transition(
    limit,
    order,
    coupling,
    strength,
    mode,
    tension,
    rate,
    origin,
    weight,
    room,
    series,
    level,
    terms,
    stage,
    bound,
    active,
    count,
):
    """Earliest root of all watched functions: (time in the window, slot); (limit, -1) where there is none.

    `weight` holds the powers of limit - origin; `room` is for those of other origins.
    """
    while True:
        slot, t = -1, limit
        for k in range(1, active[0] + 1):
            if bound[active[k]] < t:
                slot, t = active[k], bound[active[k]]
        if slot < 0 or stage[slot] == FINAL:
            return t, slot
        if stage[slot] == BUILT:
            bound[slot] = examine(slot, order + 1, series, level, terms, stage)
            continue
        if stage[slot] == ROUGH:
            s = cubic_bound(
                level[slot, C0], level[slot, C1], level[slot, C2], level[slot, C3], level[slot, REST]
            )
            bound[slot] = level[slot, ORIGIN] + s * level[slot, SPAN]
            stage[slot] = CUBIC
            continue
        if stage[slot] == CUBIC:
            i = index(slot // 2)
            if mode[i] == 0:
                margin_series(slot, i, order, coupling, strength, tension, rate, weight, series)
            elif level[slot, ORIGIN] == origin:
                for n in range(index(order) + ONE):
                    series[slot, n] = mode[i] * rate[n, i] * weight[n]
            else:
                powers(level[slot, SPAN], order, room)
                for n in range(index(order) + ONE):
                    series[slot, n] = mode[i] * rate[n, i] * room[n]
            p = index(level[slot, POWER])
            divide_out(index(slot), p, index(order) + ONE, series)
            terms[slot] = order + 1 - int64(p)
            level[slot, STEPS] = 0.0
            stage[slot] = WHOLE
        count[ROOT_STEPS] += 1
        level[slot, STEPS] += 1.0
        if level[slot, STEPS] > RESTART:
            bound[slot] = examine_from(slot, t, series, level, terms, stage)
        else:
            bound[slot] = refine(slot, t, series, level, terms, stage)


@seldom
def lend(i, t, order, rate, origins, slip, weight, column):
    """Move the origin of block i's series to time t of the window; `column` keeps what was there."""
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
def give_back(i, order, rate, slip, column):
    """Undo `lend`."""
    for n in range(order + 1):
        rate[n, i] = column[n]
    slip[i] = column[ROWS + 1]


@inner
def settle(t, first, final, order, weight, rate, origins, slip):
    """Bring blocks first..final, by fours from their own origin, to time t of the window: state in row 0."""
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
def load_at(t, order, coupling, tension_before, rate, origins, slip, weight):
    """Tangential load at time t of the window, block 1 keeping its series and origin."""
    powers(t - origins[1], order, weight)
    way = slip[1]
    for n in range(order, -1, -1):
        way += weight[n + 1] * rate[n, 1]
    return tension_before[1] + coupling[1] * (slip[0] - way)


@seldom
def farthest_sliding(start, mode):
    """Farthest block that slides, none of those beyond `start` doing so; 1 where none does."""
    i = start
    while i > 1 and mode[i] == 0:
        i -= 1
    return i


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
def distance_reached(span):
    """Distance beyond which a transition is not felt within `span`, in blocks."""
    d, term = 1, span * span * span / 6.0
    while term > NEGLIGIBLE:
        d += 1
        term *= span * span / (2 * d * (2 * d + 1))
    return d


@inner
def set_mode(i, new, mode, mobile, sense, push, friction, rate):
    """Apply a transition to the state in row 0: a block that stops or turns has velocity zero."""
    if mode[i] != 0:
        rate[0, i] = 0.0
    mode[i] = new
    mobile[i] = 1.0 if new != 0 else 0.0
    sense[i] = new
    push[i] = new * friction[i]


@inner
def resting_mode(i, doubt, coupling, strength, tension, fastest):
    """Mode of a block whose velocity is zero: it sticks within its strength, or follows the force.

    A block that sticks at the limit lets go at once where its force grows: its margin decides, not rounding.
    """
    net = tension[i] - tension[i + 1]
    if abs(net) <= strength[i] + grain(index(i), doubt, coupling, strength, tension, fastest):
        return 0
    return 1 if net > 0.0 else -1


@seldom
def start_clock(clock, wait, tau):
    """Start a new event `wait` after the end of the last; the onset is carried in two doubles."""
    add = (clock[ELAPSED] + wait) * tau + clock[ONSET_ERROR]
    total = clock[ONSET] + add
    clock[ONSET_ERROR] = add - (total - clock[ONSET])
    clock[ONSET] = total
    clock[ELAPSED] = 0.0
    clock[SINCE] += wait


@outer
def run_batch(
    parameters,
    weights,
    positions,
    velocities,
    duration,
    until_global,
    chain,
    state,
    record,
    room,
    states,
    state_room,
    stride,
    budget,
    taus,
    clocks,
    counts,
):
    """Run chain after chain from its start, as many as there is room for, into one record.

    Row j of `parameters`, `weights`, `positions` and `velocities` is a chain with its start, row j of `taus`,
    `clocks` and `counts` where it ended. Each chain may take `room` transitions, `state_room` states and
    `budget` windows. Returns how many chains are finished and whether the one after them is not: its state is
    in `chain` and `state`, and what it recorded follows that of the others.
    """
    coupling, strength, friction = chain
    velocity, tension, mode = state
    time, block, new_mode, tangential_load, intervals = record
    used = 0
    stored = 0
    windows = 0
    n_blocks = weights.shape[1]
    for j in range(weights.shape[0]):
        if used + max(room, n_blocks) > time.shape[0] or stored + state_room > states[3].shape[0]:
            return j, False
        if windows > budget:
            return j, False
        clock, count = clocks[j], counts[j]
        for values in (coupling, strength, friction, velocity, tension, clock):
            for i in range(values.shape[0]):
                values[i] = 0.0
        for i in range(mode.shape[0]):
            mode[i] = 0
        for i in range(count.shape[0]):
            count[i] = 0
        tau, drive_velocity = set_up(parameters[j], weights[j], coupling, strength, friction)
        mass, stiffness, drive_stiffness = parameters[j, 0], parameters[j, 1], parameters[j, 2]
        start_from(
            positions[j],
            velocities[j],
            mass,
            stiffness,
            drive_stiffness,
            tau,
            strength,
            velocity,
            tension,
            mode,
        )
        mine = (
            time[used:],
            block[used:],
            new_mode[used:],
            tangential_load[used:],
            intervals[used + j :],
        )
        my_states = (
            states[0][stored:],
            states[1][stored:],
            states[2][stored:],
            states[3][stored:],
            states[4][stored:],
        )
        note_start(velocity, tension, mode, count, mine, my_states)
        taus[j] = tau
        status = run_events(
            tau,
            drive_velocity,
            chain,
            state,
            clock,
            count,
            duration,
            until_global,
            mine,
            max(room, count[TRANSITIONS]),
            my_states,
            state_room,
            stride,
            budget,
        )
        count[STATUS] = status
        if status == PAUSED:
            return j, True
        used += count[TRANSITIONS]
        stored += count[STORED]
        windows += count[WINDOWS]
        intervals[used + j] = clock[SINCE] * tau
    return weights.shape[0], False


@seldom
def note_start(velocity, tension, mode, count, record, states):
    """Record the blocks that move at time 0 as transitions, and the start, at rest, as the first state."""
    time, block, new_mode, tangential_load, intervals = record
    state_tension, state_velocity, state_mode, state_after, state_offset = states
    k = 0
    n_blocks = mode.shape[0] - 1 - BEYOND
    for i in range(mode.shape[0]):
        state_tension[0, i], state_velocity[0, i], state_mode[0, i] = tension[i], velocity[i], 0
        if mode[i] != 0:
            time[k], block[k], new_mode[k], tangential_load[k] = 0.0, i, mode[i], tension[1]
            intervals[k] = 0.0
            k += 1
    state_after[0], state_offset[0] = 0, 0.0
    count[TRANSITIONS] = count[SLIDING] = k
    count[GLOBAL] = 1 if k == n_blocks else 0
    count[STORED] = 1


@outer
def run_events(
    tau,
    drive_velocity,
    chain,
    state,
    clock,
    count,
    duration,
    until_global,
    record,
    room,
    states,
    state_room,
    stride,
    budget,
):
    """Run a chain until `duration` [s], the end of the first global slip, full buffers or a spent budget.

    `chain` holds its coupling, strength and friction; `state` (velocity, tension, mode), `clock` and `count`
    are left at the state reached. `record`, which has times [s], blocks, new modes, tangential loads [N] and
    intervals [s], is filled from count[TRANSITIONS] on; after every `stride` transitions or so a state goes
    to `states`.
    """
    coupling, strength, friction = chain
    velocity, tension, mode = state
    time, block, new_mode, tangential_load, intervals = record
    state_tension, state_velocity, state_mode, state_after, state_offset = states
    wide = mode.shape[0]
    n_blocks = wide - 1 - BEYOND
    rate = np.zeros((ROWS + 1, wide))
    mobile = np.zeros(wide)
    sense = np.zeros(wide)
    push = np.zeros(wide)
    slip = np.zeros(wide)
    origins = np.zeros(wide)
    tension_before = np.empty(wide)
    weight = np.empty(ROWS + WIDTH)
    series = np.empty((2 * wide, ROWS + 1))
    level = np.empty((2 * wide, LEVELS))
    terms = np.zeros(2 * wide, np.int64)
    stage = np.zeros(2 * wide, np.int64)
    bound = np.empty(2 * wide)
    active = np.zeros(2 * wide + 1, np.int64)
    fastest = np.zeros(wide)
    suspects = np.zeros(wide, np.uint64)
    behind, ahead, spare = np.empty(ROWS + WIDTH), np.empty(ROWS + WIDTH), np.empty(ROWS + WIDTH)
    fastest[0] = drive_velocity
    for i in range(1, n_blocks + 1):
        rate[0, i] = velocity[i]
        mobile[i] = 1.0 if mode[i] != 0 else 0.0
        sense[i] = mode[i]
        push[i] = mode[i] * friction[i]
    rate[0, 0] = drive_velocity
    farthest = farthest_sliding(n_blocks, mode)
    loading_rate = coupling[1] * drive_velocity
    short_order, long_order = order_for(SHORT_WINDOW), order_for(LONG_WINDOW)
    k = count[TRANSITIONS]
    sliding = count[SLIDING]
    status = PAUSED
    idle = 0
    doubt = ROUNDINGS
    while k < room and budget > 0 and count[STORED] < state_room:
        budget -= 1
        count[WINDOWS] += 1
        if k >= stride * count[STORED]:
            c = count[STORED]
            for i in range(wide):
                state_tension[c, i], state_velocity[c, i], state_mode[c, i] = tension[i], rate[0, i], mode[i]
            state_after[c], state_offset[c] = k, clock[SINCE] * tau
            count[STORED] += 1
        remaining = ((duration - clock[ONSET]) - clock[ONSET_ERROR]) / tau - clock[ELAPSED]
        if sliding == 0:
            if count[GLOBAL] != 0 and until_global:
                status = GLOBAL_SLIP
                break
            wait = max((strength[1] - (tension[1] - tension[2])) / loading_rate, 0.0)
            if wait >= remaining:
                remaining = max(remaining, 0.0)
                tension[1] += loading_rate * remaining
                start_clock(clock, remaining, tau)
                status = FINISHED
                break
            tension[1] = tension[2] + strength[1]
            start_clock(clock, wait, tau)
            first = 1
            set_mode(first, first, mode, mobile, sense, push, friction, rate)
            sliding = farthest = 1
            if n_blocks == 1:
                count[GLOBAL] = 1
            time[k] = clock[ONSET] + clock[ONSET_ERROR]
            block[k], new_mode[k], tangential_load[k] = 1, 1, tension[1]
            intervals[k] = clock[SINCE] * tau
            clock[SINCE] = 0.0
            k += 1
            continue
        if remaining <= 0.0:
            status = FINISHED
            break
        # A window: the state is that of its start, and every series has its origin there.
        farthest = farthest_sliding(farthest, mode)
        last = min(farthest + 1, n_blocks)
        end = WIDTH * ((last + WIDTH - 1) // WIDTH)
        is_long = last > LONG
        order = long_order if is_long else short_order
        limit = min(LONG_WINDOW if is_long else SHORT_WINDOW, remaining)
        for i in range(end + 2):
            tension_before[i] = tension[i]
            slip[i] = origins[i] = 0.0
        for n in range(order + 1):
            rate[n, end + 1] = 0.0
        fastest[end + 1] = 0.0
        active[0] = 0
        first, final = 1, end
        noted = 0.0
        t = 0.0
        while True:
            expand(coupling, mobile, push, first, final, order, tension, rate)
            count[DERIVATIVES] += order * (final - first + 1)
            powers(limit - t, order, weight)
            watch(
                first,
                final,
                min(final, last),
                end,
                is_long,
                t,
                limit - t,
                order,
                coupling,
                strength,
                mode,
                mobile,
                sense,
                tension,
                rate,
                weight,
                fastest,
                suspects,
                series,
                level,
                terms,
                stage,
                bound,
                active,
                doubt,
            )
            if first > 1:
                give_back(first - 1, order, rate, slip, behind)
            if final < end:
                give_back(final + 1, order, rate, slip, ahead)
            t, slot = next_transition(
                limit,
                order,
                coupling,
                strength,
                mode,
                tension,
                rate,
                t,
                weight,
                spare,
                series,
                level,
                terms,
                stage,
                bound,
                active,
                count,
            )
            slip[0] = drive_velocity * t
            idle = idle + 1 if t == noted else 0
            doubt = ROUNDINGS * 2.0 ** (idle // (4 * n_blocks))
            if slot < 0:
                break
            i = slot // 2
            if is_long:
                if i == last and last < n_blocks:
                    last += 1
                    if last > end:
                        for n in range(order + 1):
                            for j in range(end + 1, end + WIDTH + 2):
                                rate[n, j] = 0.0
                        for j in range(end + 1, end + WIDTH + 2):
                            slip[j], origins[j], tension_before[j], fastest[j] = 0.0, t, tension[j], 0.0
                        end += WIDTH
                distance = distance_reached(limit - t)
                first = WIDTH * ((max(i - distance, 1) - 1) // WIDTH) + 1
                final = min(WIDTH * ((i + distance + WIDTH - 1) // WIDTH), end)
                if first > 1:
                    lend(first - 1, t, order, rate, origins, slip, weight, behind)
                if final < end:
                    lend(final + 1, t, order, rate, origins, slip, weight, ahead)
            settle(t, first, final, order, weight, rate, origins, slip)
            stretch(first, final, coupling, slip, tension_before, tension)
            old = mode[i]
            new = (
                resting_mode(i, doubt, coupling, strength, tension, fastest)
                if old != 0
                else 1 - 2 * (slot % 2)
            )
            set_mode(i, new, mode, mobile, sense, push, friction, rate)
            farthest = max(farthest, i)
            if new != old:
                sliding += abs(new) - abs(old)
                if sliding == n_blocks:
                    count[GLOBAL] = 1
                load = tension[1]
                if first > 1:
                    load = load_at(t, order, coupling, tension_before, rate, origins, slip, weight)
                time[k] = clock[ONSET] + (clock[ONSET_ERROR] + (clock[ELAPSED] + t) * tau)
                block[k], new_mode[k], tangential_load[k] = i, new, load
                intervals[k] = (clock[SINCE] + (t - noted)) * tau
                clock[SINCE] = 0.0
                noted = t
                k += 1
            if not is_long:
                break
            if sliding == 0 or k == room:
                if first > 1:
                    give_back(first - 1, order, rate, slip, behind)
                if final < end:
                    give_back(final + 1, order, rate, slip, ahead)
                break
        if is_long or slot < 0:
            first = 1
            settle(t, first, end, order, weight, rate, origins, slip)
            stretch(first, end, coupling, slip, tension_before, tension)
        clock[ELAPSED] += t
        clock[SINCE] += t - noted
    count[TRANSITIONS] = k
    count[SLIDING] = sliding
    for i in range(1, n_blocks + 1):
        velocity[i] = rate[0, i]
    return status


@outer
def propagate(
    drive_velocity, coupling, mode, mobile, push, span, tension, before, rate, slip, origins, weight
):
    """Carry a state forward by `span` without a transition."""
    if not mobile.any():
        tension[1] += coupling[1] * drive_velocity * span
        return
    n_blocks = mode.shape[0] - 1 - BEYOND
    last = min(farthest_sliding(n_blocks, mode) + 1, n_blocks)
    first, end = 1, WIDTH * ((last + WIDTH - 1) // WIDTH)
    order = order_for(SHORT_WINDOW)
    while span > 0.0:
        s = min(span, SHORT_WINDOW)
        slip.fill(0.0)
        origins.fill(0.0)
        slip[0] = drive_velocity * s
        for n in range(order + 1):
            rate[n, end + 1] = 0.0
        expand(coupling, mobile, push, first, end, order, tension, rate)
        settle(s, first, end, order, weight, rate, origins, slip)
        before[:] = tension
        stretch(first, end, coupling, slip, before, tension)
        span -= s


@outer
def evaluate(
    tau,
    drive_velocity,
    coupling,
    strength,
    friction,
    sorted_times,
    time,
    block,
    new_mode,
    intervals,
    states,
    tension_out,
    velocity_out,
):
    """State at each of `sorted_times` [s], from the stored states and the transitions between them."""
    state_tension, state_velocity, state_mode, state_after, state_offset = states
    wide = strength.shape[0]
    n_blocks = wide - 1 - BEYOND
    rate = np.zeros((ROWS + 1, wide))
    velocity, tension = np.zeros(wide), np.zeros(wide)
    here, before = np.zeros(wide), np.zeros(wide)
    slip, origins, weight = np.zeros(wide), np.zeros(wide), np.empty(ROWS + WIDTH)
    mode = np.zeros(wide, np.int64)
    mobile, sense, push = np.zeros(wide), np.zeros(wide), np.zeros(wide)
    row = -1
    done = 0
    offset = 0.0
    for q in range(sorted_times.shape[0]):
        now = sorted_times[q]
        target = np.searchsorted(time, now, side="right")
        since = now - time[target - 1] if target > 0 else now
        best = max(row, 0)
        while best + 1 < state_after.shape[0] and (
            state_after[best + 1] < target
            or (state_after[best + 1] == target and state_offset[best + 1] <= since)
        ):
            best += 1
        if best > row and (row < 0 or state_after[best] > done):
            done, offset = state_after[best], state_offset[best]
            for i in range(1, n_blocks + 1):
                velocity[i], tension[i] = state_velocity[best, i], state_tension[best, i]
                rate[0, i] = velocity[i]
                mode[i] = state_mode[best, i]
                mobile[i] = 1.0 if mode[i] != 0 else 0.0
                push[i] = mode[i] * friction[i]
            rate[0, 0] = drive_velocity
        row = best
        while done < target:
            span = (intervals[done] - offset) / tau
            propagate(
                drive_velocity,
                coupling,
                mode,
                mobile,
                push,
                span,
                tension,
                before,
                rate,
                slip,
                origins,
                weight,
            )
            set_mode(block[done], new_mode[done], mode, mobile, sense, push, friction, rate)
            for i in range(1, n_blocks + 1):
                velocity[i] = rate[0, i]
            done += 1
            offset = 0.0
        for i in range(1, n_blocks + 1):
            here[i] = tension[i]
        span = max(since - offset, 0.0) / tau
        propagate(
            drive_velocity, coupling, mode, mobile, push, span, here, before, rate, slip, origins, weight
        )
        for i in range(1, n_blocks + 1):
            tension_out[q, i - 1], velocity_out[q, i - 1] = here[i], rate[0, i]
            rate[0, i] = velocity[i]


@outer
def start_from(
    positions, velocities, mass, stiffness, drive_stiffness, tau, strength, velocity, tension, mode
):
    """Fill velocities, spring forces and modes at time 0, in the kernel's units and columns.

    A block that moves slides; one at rest slides where its springs overcome the static friction (Eq. 5).
    """
    n_blocks = positions.shape[0]
    stiffest, farthest, before = drive_stiffness, 0.0, 0.0
    for i in range(n_blocks):
        spring = stiffness if i > 0 else drive_stiffness
        stiffest = max(stiffest, spring)
        farthest = max(farthest, abs(positions[i]))
        tension[i + 1] = -spring * (positions[i] - before)
        before = positions[i]
        velocity[i + 1] = velocities[i] * (mass / tau)
    for i in range(1, n_blocks + 1):
        # A position of size x is known to its rounding: a block at its limit to within that still sticks.
        doubt = ROUNDINGS * (strength[i] + 4.0 * stiffest * farthest)
        moves = velocity[i] if velocity[i] != 0.0 else tension[i] - tension[i + 1]
        if velocity[i] == 0.0 and abs(moves) <= strength[i] + doubt:
            mode[i] = 0
        else:
            mode[i] = 1 if moves > 0.0 else -1


def to_positions(chain: Chain, times: FloatArray, force: FloatArray) -> FloatArray:
    """Positions [m], shape (T, N), from the spring forces at `times` [s]: x_1 = V t - T_1/K (Eq. 3), ..."""
    return chain.drive_velocity * times[:, None] - np.cumsum(force / chain.springs, axis=1)


def to_velocities(system: System, chain: Chain, velocity: FloatArray) -> FloatArray:
    """Velocities [m/s] from those of the kernel."""
    return velocity * (system.tau / chain.mass)
