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

    dT_i/dt = c_i (v_{i-1} - v_i),    dv_i/dt = r_i (G_i - f_i),    G_i = T_i - T_{i+1} + dashpots

where f_i is mode_i mu_k w_i on a block that slides. The share r_i of a block's mass in what moves with it is
1, but for block 1 with a loading head. Without additions there are no dashpots, and a block that sticks does
not move: `additions` is None then, and what they need is not even compiled. Else it holds four arrays:

- `dashpot`, gamma_i: G_i has gamma_i (v_{i-1} - v_i) - gamma_{i+1} (v_i - v_{i+1}) besides;
- `anchor`, chi_i: a block that sticks hangs on a spring between it and the plane; zero where the interface is
  rigid. On springs, all blocks move all the time;
- `grip`, p_i: the force f_i of that spring, dp_i/dt = chi_i v_i; a block that stops begins with p_i = G_i;
- `hold`: r_i chi_i of the blocks that stick, zero of the others.

Column 0 of every array is the drive, columns 1..N are the blocks; beyond them is room for groups of four.

A transition changes the motion of blocks at distance d only in order 2 d + 1 of the time since, with dashpots
in order d + 1. In a long chain each group of blocks therefore keeps Taylor series about a time of its own
within a common window, and a transition renews those of its neighbourhood only.

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
# On interface springs there is no rest: a state is stored after so many windows for each one of the stride.
WINDOWS_PER_STATE = 512
# While all blocks stick there, 2^k windows are gone through at once, k = LEAST_LEAP..LEAPS, where it is sure
# that none lets go; a state that allows none is looked at again after so many windows.
LEAST_LEAP, LEAPS, BETWEEN_LOOKS = 3, 9, 12
# The energy that bounds the ringing is known to better than this.
SAFETY = 1.0 + 1e-9
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
# Products may be fused with sums. Only `outer` code allocates, and counts references (`_nrt`), as that takes
# longer than the arithmetic; so does passing arrays to a function: hence what is inlined.
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


class Additions(NamedTuple):
    """What joins blocks to each other and to the plane besides springs; see the module's docstring."""

    dashpot: FloatArray
    anchor: FloatArray
    grip: FloatArray
    hold: FloatArray


class System(NamedTuple):
    """A chain in the kernel's units; columns as in the module's docstring."""

    tau: float
    drive_velocity: float
    coupling: FloatArray
    strength: FloatArray
    friction: FloatArray
    lightness: FloatArray
    additions: Additions | None


def width(n_blocks: int) -> int:
    """Number of columns of a chain's arrays."""
    return n_blocks + 1 + BEYOND


def is_linked(chain: Chain) -> bool:
    """Whether the compiled code has to know of `additions`: dashpots or interface springs."""
    return chain.viscosity > 0.0 or chain.interface_stiffness > 0.0


def new_additions(n_blocks: int) -> Additions:
    """Room for the additions of a chain."""
    return Additions(*np.zeros((4, width(n_blocks))))


def parameters(chain: Chain) -> tuple[float, ...]:
    """What `set_up` takes of a chain beside its weights."""
    return (
        chain.mass,
        chain.stiffness,
        chain.drive_stiffness,
        chain.drive_velocity,
        chain.mu_s,
        chain.mu_k,
        chain.head_mass,
        chain.viscosity,
        chain.interface_stiffness,
    )


def scale(chain: Chain) -> System:
    """Express a chain in the kernel's units."""
    coupling, strength, friction, lightness = np.zeros((4, width(chain.n_blocks)))
    additions = new_additions(chain.n_blocks) if is_linked(chain) else None
    # A copy, as the compiled code is for arrays that may be written to.
    weights = chain.weights.copy()
    columns = coupling, strength, friction, lightness
    tau, drive_velocity = set_up(np.array(parameters(chain)), weights, columns, additions)
    return System(tau, drive_velocity, coupling, strength, friction, lightness, additions)


@outer
def set_up(parameters, weights, chain, additions):
    """Fill a chain's columns in the kernel's units; return tau [s] and the drive's velocity [N/tau].

    tau follows from Gershgorin's bounds: a row of a Taylor series is at most a times the row two before it,
    and b times the row before it, and a + b REACH <= REACH^2.
    """
    coupling, strength, friction, lightness = chain
    mass, stiffness, drive_stiffness, drive_velocity, mu_s, mu_k, head_mass, viscosity, anchorage = parameters
    n_blocks = weights.shape[0]
    stiffest = 0.0
    for i in range(n_blocks):
        behind = stiffness if i > 0 else drive_stiffness
        ahead = stiffness if i < n_blocks - 1 else 0.0
        stiffest = max(stiffest, behind + ahead + (behind if i > 0 else 0.0) + ahead)
    if additions is None:
        tau = REACH * math.sqrt(mass / stiffest)
    else:
        a, b = (stiffest + anchorage) / mass, 4.0 * viscosity / mass
        tau = 2.0 * REACH / (b + math.sqrt(b * b + 4.0 * a))
        for i in range(n_blocks):
            additions.dashpot[i + 1] = viscosity * (tau / mass) if i > 0 else 0.0
            additions.anchor[i + 1] = anchorage * (tau * tau / mass)
    for i in range(n_blocks):
        spring = stiffness if i > 0 else drive_stiffness
        coupling[i + 1] = spring * (tau * tau / mass)
        strength[i + 1] = mu_s * weights[i]
        friction[i + 1] = mu_k * weights[i]
        lightness[i + 1] = mass / (mass + head_mass) if i == 0 else 1.0
    return tau, drive_velocity * mass / tau


@inner
def expand(coupling, mobile, push, first, final, order, tension, rate):
    """Taylor series of the velocities of blocks first..final from their row 0 (derivatives, rows 1..order).

    This is the chain's linear operator, that with additions is `expand_linked`. `mobile` is r_i where a block
    slides, else 0, and `push` its kinetic friction with the sign of its mode times r_i; `tension` holds the
    spring forces. Columns first - 1 and final + 1 hold the motion of the neighbours outside.
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
def expand_linked(coupling, mobile, push, additions, first, final, order, tension, rate):
    """Do what `expand` does, with dashpots and interface springs; `push` of a stuck block is r_i p_i."""
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
def stretch(first, final, coupling, slip, tension_before, tension):
    """Forces of the springs from behind block first to ahead of `final`, after the slips in the window."""
    for i in range(index(first), index(final) + ONE, FOUR):
        longer = lanes.load(slip, i - ONE) - lanes.load(slip, i)
        lanes.store(tension, i, lanes.load(tension_before, i) + lanes.load(coupling, i) * longer)
    i = index(final) + ONE
    tension[i] = tension_before[i] + coupling[i] * (slip[i - ONE] - slip[i])


@inner
def stretch_linked(
    first,
    final,
    coupling,
    slip,
    tension_before,
    tension,
    lost,
    springy,
    n_blocks,
    mode,
    push,
    lightness,
    lost_grip,
    additions,
):
    """Do what `stretch` does; on interface springs, which move in millions of windows, without drift."""
    if springy:
        for i in range(1, n_blocks + 1):
            add_to(tension, lost, i, coupling[i] * (slip[i - 1] - slip[i]))
        renew_grip(n_blocks, mode, push, lightness, slip, lost_grip, additions)
    else:
        stretch(first, final, coupling, slip, tension_before, tension)


@inner
def safe_step(g, slope, curvature):
    """Positive root of g + slope s - curvature s^2/2 for g >= 0: no root of g lies before it."""
    root = math.sqrt(slope * slope + 2.0 * curvature * g)
    if slope < 0.0:
        return 2.0 * g / (root - slope)
    return (slope + root) / curvature if curvature > 0.0 else np.inf


@inner
def tail_bound(first, final, end, order, span, rate, additions):
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
    if additions is not None:
        # Dashpots mix even and odd rows: what grows by REACH at most is the larger of two rows on end.
        even = max(even, odd / REACH)
        odd = even * REACH
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
def grain(i, doubt, coupling, strength, tension, fastest, additions):
    """Size below which a force on block i, or what it does to its velocity in the window, counts as zero.

    From the forces, and from what the motion of the neighbours adds to them within the window.
    """
    still = abs(tension[i]) + abs(tension[i + ONE]) + strength[i]
    moving = coupling[i] * fastest[i - ONE] + fastest[i] + coupling[i + ONE] * fastest[i + ONE]
    if additions is not None:
        still += abs(additions.grip[i])
        moving += (
            additions.dashpot[i] * fastest[i - ONE]
            + additions.anchor[i] * fastest[i]
            + additions.dashpot[i + ONE] * fastest[i + ONE]
        )
    return doubt * (2.0 * still + moving)


@inner
def margin_series(slot, i, order, coupling, strength, tension, rate, weight, series, additions):
    """Series of the margin of stuck block i against letting go forward (even slot) or backward (odd slot)."""
    row, i = index(slot), index(i)
    side = 1.0 - 2.0 * (row % TWO)
    if additions is not None:
        linked_margin_series(
            row, i, side, order, coupling, strength, tension, rate, weight, series, additions
        )
        return
    b, a = coupling[i], coupling[i + ONE]
    series[row, ZERO] = strength[i] - side * (tension[i] - tension[i + ONE])
    for n in range(ONE, index(order) + ONE):
        growth = b * rate[n - ONE, i - ONE] + a * rate[n - ONE, i + ONE]
        series[row, n] = -side * growth * weight[n]


@inner
def linked_margin_series(row, i, side, order, coupling, strength, tension, rate, weight, series, additions):
    """Do what `margin_series` does, with dashpots or interface springs."""
    b, a, near, far = coupling[i], coupling[i + ONE], i - ONE, i + ONE
    d, c = additions.dashpot[i], additions.dashpot[i + ONE]
    if additions.anchor[i] > 0.0:
        series[row, ZERO] = strength[i] - side * additions.grip[i]
        for n in range(ONE, index(order) + ONE):
            series[row, n] = -side * additions.anchor[i] * rate[n - ONE, i] * weight[n]
    else:
        net = tension[i] - tension[far] + d * rate[ZERO, near] + c * rate[ZERO, far]
        series[row, ZERO] = strength[i] - side * net
        for n in range(ONE, index(order) + ONE):
            growth = b * rate[n - ONE, near] + a * rate[n - ONE, far] + d * rate[n, near] + c * rate[n, far]
            series[row, n] = -side * growth * weight[n]


@inner
def may_stop(i, tail, sense, rate, weight, fastest):
    """Bits of those of blocks i..i + 3 that slide and may stop in the window; `fastest` is set for all four.

    The test is that of `surely_positive`, with the size of each term from the fourth on and the tail as rest.
    """
    sign = lanes.load(sense, i)
    slides = sign * sign
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
def may_let_go(i, span, coupling, strength, sense, tension, fastest, additions):
    """Bits of those of blocks i..i + 3 that stick and may let go in the window."""
    slides = lanes.load(sense, i) * lanes.load(sense, i)
    still = 1.0 - slides
    if additions is not None:
        return linked_may_let_go(i, span, slides, coupling, strength, tension, fastest, additions)
    net = lanes.magnitude(lanes.load(tension, i) - lanes.load(tension, i + ONE))
    change = lanes.load(coupling, i) * lanes.load(fastest, i - ONE)
    change = (change + lanes.load(coupling, i + ONE) * lanes.load(fastest, i + ONE)) * span
    return lanes.where_not_above(still * (lanes.load(strength, i) - net), still * change - slides)


@inner
def linked_may_let_go(i, span, slides, coupling, strength, tension, fastest, additions):
    """Do what `may_let_go` does, with dashpots or interface springs."""
    still = 1.0 - slides
    if additions.anchor[ONE] > 0.0:
        change = lanes.load(additions.anchor, i) * lanes.load(fastest, i) * span
        force = lanes.magnitude(lanes.load(additions.grip, i))
    else:
        near, far = lanes.load(fastest, i - ONE), lanes.load(fastest, i + ONE)
        change = (lanes.load(coupling, i) * near + lanes.load(coupling, i + ONE) * far) * span
        # Both what the dashpots hold now and what they come to hold.
        change = change + (
            lanes.load(additions.dashpot, i) * near + lanes.load(additions.dashpot, i + ONE) * far
        )
        force = lanes.magnitude(lanes.load(tension, i) - lanes.load(tension, i + ONE))
    return lanes.where_not_above(still * (lanes.load(strength, i) - force), still * change - slides)


@inner
def speed_bound(i, tail, rate, weight, fastest):
    """Set `fastest` of blocks i..i + 3 whether they slide or not."""
    total = lanes.spread(tail)
    for n in range(ZERO, EIGHT):
        total = total + size(n, i, rate, weight)
    lanes.store(fastest, i, total)


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
    additions,
    mode,
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
    tail, tail_bend = tail_bound(first, final, end, order, span, rate, additions)
    start, stop = index(first), index(final) + ONE
    for group in range(start, stop, FOUR):
        suspects[group] = may_stop(group, tail, sense, rate, weight, fastest)
        if additions is not None and on_springs(additions):
            speed_bound(group, tail, rate, weight, fastest)
    for group in range(start, stop, FOUR):
        bits = suspects[group] | may_let_go(
            group, span, coupling, strength, sense, tension, fastest, additions
        )
        i = group
        while bits != ZERO and i <= index(last):
            if bits & ONE:
                zero = grain(i, doubt, coupling, strength, tension, fastest, additions)
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
                        additions,
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
    additions,
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
    if additions is None:
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
    else:
        net, g1, g2, g3, r4, r5, r6, r7, r8, rest, bend_beyond = linked_growth(
            i, span, coupling, additions, tension, rate, weight, tail, tail_bend
        )
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
            if additions is None:
                bend += (a + b) * tail_bend * span / 7.0
            else:
                bend += bend_beyond
            level[slot, BEND], level[slot, TURN] = downward(c2, c3) + bend, turning(c2, c3) + bend
            level[slot, C0], level[slot, C1], level[slot, C2], level[slot, C3] = c0, c1, c2, c3
            level[slot, REST] = rest
            stage[slot] = ROUGH
            bound[slot] = origin + safe_step(c0, c1, downward(c2, c3) + 12.0 * rest) * span
        else:
            # The series of the neighbours may get other origins before this one is looked at again.
            margin_series(slot, i, order, coupling, strength, tension, rate, weight, series, additions)
            stage[slot], bound[slot] = BUILT, origin
        if bound[slot] < origin + span:
            keep(slot, active)


@inner
def linked_growth(i, span, coupling, additions, tension, rate, weight, tail, tail_bend):
    """Force on stuck block i, terms 1 to 3 of its series, sizes of 4 to 8, bounds of the rest and its bend.

    It is the force of the interface: that of its spring, or the net force of springs and dashpots.
    """
    near, far = i - ONE, i + ONE
    if additions.anchor[i] > 0.0:
        b = additions.anchor[i]
        g1, g2, g3 = b * rate[ZERO, i] * weight[1], b * rate[ONE, i] * weight[2], b * rate[TWO, i] * weight[3]
        r4, r5 = b * abs(rate[THREE, i]) * weight[4], b * abs(rate[FOUR, i]) * weight[5]
        r6, r7 = b * abs(rate[FIVE, i]) * weight[6], b * abs(rate[SIX, i]) * weight[7]
        r8 = b * abs(rate[SEVEN, i]) * weight[8]
        rest = (r4 + r5) + (r6 + r7) + (r8 + b * tail * span / 9.0)
        return additions.grip[i], g1, g2, g3, r4, r5, r6, r7, r8, rest, b * tail_bend * span / 7.0
    b, a = coupling[i], coupling[far]
    d, c = additions.dashpot[i], additions.dashpot[far]
    net = tension[i] - tension[far] + d * rate[ZERO, near] + c * rate[ZERO, far]
    g1 = (b * rate[ZERO, near] + a * rate[ZERO, far] + d * rate[ONE, near] + c * rate[ONE, far]) * weight[1]
    g2 = (b * rate[ONE, near] + a * rate[ONE, far] + d * rate[TWO, near] + c * rate[TWO, far]) * weight[2]
    g3 = (b * rate[TWO, near] + a * rate[TWO, far] + d * rate[THREE, near] + c * rate[THREE, far]) * weight[3]
    r4 = abs(b * rate[THREE, near] + a * rate[THREE, far] + d * rate[FOUR, near] + c * rate[FOUR, far])
    r5 = abs(b * rate[FOUR, near] + a * rate[FOUR, far] + d * rate[FIVE, near] + c * rate[FIVE, far])
    r6 = abs(b * rate[FIVE, near] + a * rate[FIVE, far] + d * rate[SIX, near] + c * rate[SIX, far])
    r7 = abs(b * rate[SIX, near] + a * rate[SIX, far] + d * rate[SEVEN, near] + c * rate[SEVEN, far])
    r8 = abs(b * rate[SEVEN, near] + a * rate[SEVEN, far]) * weight[8]
    r4, r5, r6, r7 = r4 * weight[4], r5 * weight[5], r6 * weight[6], r7 * weight[7]
    beyond = (a + b) * span / 9.0 + c + d
    rest = (r4 + r5) + (r6 + r7) + (r8 + beyond * tail)
    return net, g1, g2, g3, r4, r5, r6, r7, r8, rest, ((a + b) * span / 7.0 + c + d) * tail_bend


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
    additions,
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
                margin_series(slot, i, order, coupling, strength, tension, rate, weight, series, additions)
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


@inner
def set_mode(i, new, mode, mobile, sense, push, friction, lightness, tension, rate, additions):
    """Apply a transition to the state in row 0: a block that stops or turns has velocity zero."""
    if mode[i] != 0:
        rate[0, i] = 0.0
    mode[i] = new
    if additions is not None and additions.anchor[i] > 0.0:
        # A block that begins to stick is attached where no net force acts on it.
        additions.grip[i] = net_force(i, tension, rate, additions) if new == 0 else 0.0
    take_mode(i, mode, mobile, sense, push, friction, lightness, additions)


@inner
def take_mode(i, mode, mobile, sense, push, friction, lightness, additions):
    """Set what follows from the mode of block i, and from the force of its interface spring if it sticks."""
    mobile[i] = lightness[i] if mode[i] != 0 else 0.0
    sense[i] = mode[i]
    push[i] = mode[i] * friction[i] * lightness[i]
    if additions is not None and additions.anchor[i] > 0.0:
        mobile[i] = lightness[i]
        additions.hold[i] = lightness[i] * additions.anchor[i] if mode[i] == 0 else 0.0
        if mode[i] == 0:
            push[i] = lightness[i] * additions.grip[i]


@inner
def on_springs(additions):
    """Whether blocks that stick hang on interface springs, and move."""
    return additions.anchor[ONE] > 0.0


@inner
def net_force(i, tension, rate, additions):
    """Force of springs and dashpots on block i, G_i."""
    damped = additions.dashpot[i] * (rate[0, i - 1] - rate[0, i]) - additions.dashpot[i + 1] * (
        rate[0, i] - rate[0, i + 1]
    )
    return tension[i] - tension[i + 1] + damped


@inner
def add_to(values, lost, i, change):
    """Add to values[i]; what rounding takes away is kept in lost[i] for the next time."""
    change += lost[i]
    total = values[i] + change
    lost[i] = change - (total - values[i])
    values[i] = total


@inner
def renew_grip(n_blocks, mode, push, lightness, slip, lost, additions):
    """Force of the interface springs after the slips in a window, and the push that follows from it."""
    for i in range(1, n_blocks + 1):
        if mode[i] == 0:
            add_to(additions.grip, lost, i, additions.anchor[i] * slip[i])
            push[i] = lightness[i] * additions.grip[i]


@seldom
def prepare_leaps(drive_velocity, coupling, lightness, additions, pivot, softness, creep, leaps):
    """Fill what `leap` needs: pivots and diagonal of A^-1, quasi-static velocities, the leaps themselves.

    On springs, a chain that sticks rings about the quasi-static motion, in which blocks move at the constant
    velocities A^-1 (c_1 V, 0, ...), A the stiffness of springs and interface (tridiagonal). leaps[k] carries
    displacements and velocities of the ringing over 2^k windows.
    """
    n_blocks = softness.shape[0] - 1 - BEYOND
    for i in range(1, n_blocks + 1):
        pivot[i] = coupling[i] + coupling[i + 1] + additions.anchor[i]
        if i > 1:
            pivot[i] -= coupling[i] * coupling[i] / pivot[i - 1]
    ahead = 0.0
    for j in range(n_blocks):
        i = n_blocks - j
        softness[i] = 1.0 / (pivot[i] - ahead)
        back = coupling[i] + coupling[i + 1] + additions.anchor[i] - ahead
        ahead = coupling[i] * coupling[i] / back
        creep[i] = 0.0
    creep[1] = coupling[1] * drive_velocity
    relax(n_blocks, coupling, pivot, creep)
    order = order_for(SHORT_WINDOW)
    for column in range(2 * n_blocks):
        # leaps[1] and leaps[2] have room for a term of the series of this column, and for the next one.
        for j in range(2 * n_blocks):
            leaps[0, j, column] = leaps[1, 0, j] = 1.0 if j == column else 0.0
        for n in range(1, order + 1):
            length = SHORT_WINDOW / n
            for j in range(n_blocks):
                i = j + 1
                x, v = leaps[1, 0, j], leaps[1, 0, n_blocks + j]
                x_behind = v_behind = x_ahead = v_ahead = 0.0
                if j > 0:
                    x_behind, v_behind = leaps[1, 0, j - 1], leaps[1, 0, n_blocks + j - 1]
                if i < n_blocks:
                    x_ahead, v_ahead = leaps[1, 0, j + 1], leaps[1, 0, n_blocks + j + 1]
                force = (
                    coupling[i] * (x_behind - x) - coupling[i + 1] * (x - x_ahead) - additions.anchor[i] * x
                )
                force += additions.dashpot[i] * (v_behind - v) - additions.dashpot[i + 1] * (v - v_ahead)
                leaps[2, 0, j] = length * v
                leaps[2, 0, n_blocks + j] = length * lightness[i] * force
            for j in range(2 * n_blocks):
                leaps[1, 0, j] = leaps[2, 0, j]
                leaps[0, j, column] += leaps[2, 0, j]
    for k in range(1, LEAPS + 1):
        for i in range(2 * n_blocks):
            for j in range(2 * n_blocks):
                leaps[k, i, j] = 0.0
            for m in range(2 * n_blocks):
                factor = leaps[k - 1, i, m]
                for j in range(2 * n_blocks):
                    leaps[k, i, j] += factor * leaps[k - 1, m, j]


@seldom
def relax(n_blocks, coupling, pivot, force):
    """Solve A x = force in place, by the pivots of A."""
    for i in range(2, n_blocks + 1):
        force[i] += coupling[i] / pivot[i - 1] * force[i - 1]
    force[n_blocks] /= pivot[n_blocks]
    for j in range(1, n_blocks):
        i = n_blocks - j
        force[i] = (force[i] + coupling[i + 1] * force[i + 1]) / pivot[i]


@seldom
def leap(
    remaining, coupling, strength, lightness, tension, additions, pivot, softness, creep, leaps, rate, slip
):
    """Let a chain that sticks move on by 2^k windows: velocities in row 0, slips; returns k, or -1 for none.

    The energy E of the ringing does not grow: p_i stays within chi_i sqrt(2 E (A^-1)_ii) of what it is in
    quasi-static motion, which grows linearly; the leap ends before one of them can reach its strength.
    """
    n_blocks = softness.shape[0] - 1 - BEYOND
    for i in range(1, n_blocks + 1):
        damped = additions.dashpot[i] * (creep[i - 1] - creep[i])
        damped -= additions.dashpot[i + 1] * (creep[i] - creep[i + 1])
        slip[i] = tension[i] - tension[i + 1] - additions.grip[i] + damped
    energy = 0.0
    for i in range(1, n_blocks + 1):
        pivot[n_blocks + i] = slip[i]
    relax(n_blocks, coupling, pivot, slip)
    for i in range(1, n_blocks + 1):
        ringing = rate[0, i] - creep[i]
        energy += abs(pivot[n_blocks + i] * slip[i]) + ringing * ringing / lightness[i]
    longest = remaining
    for i in range(1, n_blocks + 1):
        chi = additions.anchor[i]
        held = additions.grip[i] + chi * slip[i]
        swing = SAFETY * chi * math.sqrt(energy * softness[i])
        if strength[i] - swing <= abs(held):
            return -1
        longest = min(longest, (strength[i] - swing - held) / (chi * creep[i]))
    k, span = -1, SHORT_WINDOW
    while k < LEAPS and span <= longest:
        k += 1
        span *= 2.0
    if k < LEAST_LEAP:
        return -1
    span = SHORT_WINDOW * 2.0**k
    for i in range(1, n_blocks + 1):
        leaps[LEAPS + 1, 0, i - 1] = -slip[i]
        leaps[LEAPS + 1, 0, n_blocks + i - 1] = rate[0, i] - creep[i]
    for i in range(1, n_blocks + 1):
        x = v = 0.0
        for j in range(2 * n_blocks):
            x += leaps[k, i - 1, j] * leaps[LEAPS + 1, 0, j]
            v += leaps[k, n_blocks + i - 1, j] * leaps[LEAPS + 1, 0, j]
        slip[i] += creep[i] * span + x
        rate[0, i] = creep[i] + v
    return k


@inner
def resting_mode(i, doubt, coupling, strength, tension, rate, fastest, additions):
    """Mode of a block whose velocity is zero: it sticks within its strength, or follows the force.

    A block that sticks at the limit lets go at once where its force grows: its margin decides, not rounding.
    """
    net = tension[i] - tension[i + 1]
    if additions is not None:
        net += additions.dashpot[i] * rate[0, i - 1] + additions.dashpot[i + 1] * rate[0, i + 1]
    if abs(net) <= strength[i] + grain(index(i), doubt, coupling, strength, tension, fastest, additions):
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
    additions,
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
    in `chain`, `additions` and `state`, and what it recorded follows that of the others.
    """
    coupling, strength, friction, lightness = chain
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
        for values in (coupling, strength, friction, lightness, velocity, tension, clock):
            for i in range(values.shape[0]):
                values[i] = 0.0
        if additions is not None:
            for values in additions:
                for i in range(values.shape[0]):
                    values[i] = 0.0
        for i in range(mode.shape[0]):
            mode[i] = 0
        for i in range(count.shape[0]):
            count[i] = 0
        tau, drive_velocity = set_up(parameters[j], weights[j], chain, additions)
        mass, stiffness, drive_stiffness = parameters[j, 0], parameters[j, 1], parameters[j, 2]
        start_from(
            positions[j],
            velocities[j],
            mass,
            stiffness,
            drive_stiffness,
            tau,
            strength,
            additions,
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
            states[5][stored:],
        )
        note_start(velocity, tension, mode, count, mine, my_states, additions)
        taus[j] = tau
        status = run_events(
            tau,
            drive_velocity,
            chain,
            additions,
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
def note_start(velocity, tension, mode, count, record, states, additions):
    """Record the blocks that move at time 0 as transitions, and the start, at rest, as the first state."""
    time, block, new_mode, tangential_load, intervals = record
    state_tension, state_velocity, state_mode, state_after, state_offset, state_grip = states
    if additions is not None:
        for i in range(mode.shape[0]):
            state_grip[0, i] = additions.grip[i]
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
    additions,
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

    `chain` holds its coupling, strength, friction, lightness. `state` (velocity, tension, mode), the grip in
    `additions`, `clock` and `count` are left at the state reached. `record`, which has times [s], blocks, new
    modes, tangential loads [N] and intervals [s], is filled from count[TRANSITIONS] on; after every `stride`
    transitions or so a state goes to `states`.
    """
    coupling, strength, friction, lightness = chain
    velocity, tension, mode = state
    time, block, new_mode, tangential_load, intervals = record
    state_tension, state_velocity, state_mode, state_after, state_offset, state_grip = states
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
        take_mode(i, mode, mobile, sense, push, friction, lightness, additions)
    rate[0, 0] = drive_velocity
    farthest = farthest_sliding(n_blocks, mode)
    loading_rate = coupling[1] * drive_velocity
    short_order, long_order = order_for(SHORT_WINDOW), order_for(LONG_WINDOW)
    k = count[TRANSITIONS]
    sliding = count[SLIDING]
    status = PAUSED
    idle = 0
    doubt = ROUNDINGS
    springy = False
    if additions is not None:
        springy = on_springs(additions)
        lost, lost_grip = np.zeros(wide), np.zeros(wide)
        since_state = until_look = 0
        n_leaps, size_of_leap = (LEAPS + 2, 2 * n_blocks) if springy else (0, 0)
        leaps = np.zeros((n_leaps, size_of_leap, size_of_leap))
        pivot, softness, creep = np.zeros(2 * wide), np.zeros(wide), np.zeros(wide)
    while k < room and budget > 0 and count[STORED] < state_room:
        budget -= 1
        count[WINDOWS] += 1
        store = k >= stride * count[STORED]
        if additions is not None and springy:
            since_state += 1
            store = since_state > WINDOWS_PER_STATE * stride
        if store:
            c = count[STORED]
            if additions is not None:
                for i in range(wide):
                    state_grip[c, i] = additions.grip[i]
                since_state = 0
            for i in range(wide):
                state_tension[c, i], state_velocity[c, i], state_mode[c, i] = tension[i], rate[0, i], mode[i]
            state_after[c], state_offset[c] = k, clock[SINCE] * tau
            count[STORED] += 1
        remaining = ((duration - clock[ONSET]) - clock[ONSET_ERROR]) / tau - clock[ELAPSED]
        rests = sliding == 0
        if additions is not None and springy and rests:
            if count[GLOBAL] != 0 and until_global:
                status = GLOBAL_SLIP
                break
            rests = False
        if rests:
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
            set_mode(first, first, mode, mobile, sense, push, friction, lightness, tension, rate, additions)
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
        if additions is not None and springy and sliding == 0:
            until_look -= 1
            if until_look < 0:
                until_look = BETWEEN_LOOKS
                if pivot[1] == 0.0:
                    prepare_leaps(
                        drive_velocity, coupling, lightness, additions, pivot, softness, creep, leaps
                    )
                power = leap(
                    remaining,
                    coupling,
                    strength,
                    lightness,
                    tension,
                    additions,
                    pivot,
                    softness,
                    creep,
                    leaps,
                    rate,
                    slip,
                )
                if power >= 0:
                    until_look = 0
                    t = SHORT_WINDOW * 2.0**power
                    slip[0] = drive_velocity * t
                    first = 1
                    stretch_linked(
                        first,
                        n_blocks,
                        coupling,
                        slip,
                        tension,
                        tension,
                        lost,
                        springy,
                        n_blocks,
                        mode,
                        push,
                        lightness,
                        lost_grip,
                        additions,
                    )
                    clock[ELAPSED] += t
                    clock[SINCE] += t
                    since_state += 2**power
                    count[DERIVATIVES] += 4 * n_blocks * n_blocks
                    continue
        # A window: the state is that of its start, and every series has its origin there.
        farthest = farthest_sliding(farthest, mode)
        last = min(farthest + 1, n_blocks)
        end = WIDTH * ((last + WIDTH - 1) // WIDTH)
        if additions is not None and springy:
            last = n_blocks
            end = WIDTH * ((last + WIDTH - 1) // WIDTH)
        is_long = last > LONG
        if additions is not None and springy:
            is_long = False
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
            if additions is None:
                expand(coupling, mobile, push, first, final, order, tension, rate)
            else:
                expand_linked(coupling, mobile, push, additions, first, final, order, tension, rate)
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
                additions,
                mode,
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
                additions,
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
                distance = distance_reached(limit - t, additions)
                first = WIDTH * ((max(i - distance, 1) - 1) // WIDTH) + 1
                final = min(WIDTH * ((i + distance + WIDTH - 1) // WIDTH), end)
                if first > 1:
                    lend(first - 1, t, order, rate, origins, slip, weight, behind)
                if final < end:
                    lend(final + 1, t, order, rate, origins, slip, weight, ahead)
            settle(t, first, final, order, weight, rate, origins, slip)
            if additions is None:
                stretch(first, final, coupling, slip, tension_before, tension)
            else:
                stretch_linked(
                    first,
                    final,
                    coupling,
                    slip,
                    tension_before,
                    tension,
                    lost,
                    springy,
                    n_blocks,
                    mode,
                    push,
                    lightness,
                    lost_grip,
                    additions,
                )
            old = mode[i]
            new = (
                resting_mode(i, doubt, coupling, strength, tension, rate, fastest, additions)
                if old != 0
                else 1 - 2 * (slot % 2)
            )
            set_mode(i, new, mode, mobile, sense, push, friction, lightness, tension, rate, additions)
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
            if additions is None:
                stretch(first, end, coupling, slip, tension_before, tension)
            else:
                stretch_linked(
                    first,
                    end,
                    coupling,
                    slip,
                    tension_before,
                    tension,
                    lost,
                    springy,
                    n_blocks,
                    mode,
                    push,
                    lightness,
                    lost_grip,
                    additions,
                )
        clock[ELAPSED] += t
        clock[SINCE] += t - noted
    count[TRANSITIONS] = k
    count[SLIDING] = sliding
    for i in range(1, n_blocks + 1):
        velocity[i] = rate[0, i]
    return status


@outer
def propagate(
    drive_velocity,
    chain,
    additions,
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
):
    """Carry a state forward by `span` without a transition."""
    coupling, _, _, lightness = chain
    if not mobile.any():
        tension[1] += coupling[1] * drive_velocity * span
        return
    n_blocks = mode.shape[0] - 1 - BEYOND
    last = min(farthest_sliding(n_blocks, mode) + 1, n_blocks)
    if additions is not None and on_springs(additions):
        last = n_blocks
    first, end = 1, WIDTH * ((last + WIDTH - 1) // WIDTH)
    order = order_for(SHORT_WINDOW)
    while span > 0.0:
        s = min(span, SHORT_WINDOW)
        for i in range(end + 2):
            before[i] = tension[i]
            slip[i] = origins[i] = 0.0
        slip[0] = drive_velocity * s
        for n in range(order + 1):
            rate[n, end + 1] = 0.0
        if additions is None:
            expand(coupling, mobile, push, first, end, order, tension, rate)
        else:
            expand_linked(coupling, mobile, push, additions, first, end, order, tension, rate)
        settle(s, first, end, order, weight, rate, origins, slip)
        stretch(first, end, coupling, slip, before, tension)
        if additions is not None and on_springs(additions):
            for i in range(n_blocks + 1):
                before[i] = 0.0
            renew_grip(n_blocks, mode, push, lightness, slip, before, additions)
        span -= s


@outer
def evaluate(
    tau,
    drive_velocity,
    chain,
    additions,
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
    _, strength, friction, lightness = chain
    state_tension, state_velocity, state_mode, state_after, state_offset, state_grip = states
    wide = strength.shape[0]
    n_blocks = wide - 1 - BEYOND
    rate = np.zeros((ROWS + 1, wide))
    velocity, tension = np.zeros(wide), np.zeros(wide)
    here, before = np.zeros(wide), np.zeros(wide)
    slip, origins, weight = np.zeros(wide), np.zeros(wide), np.empty(ROWS + WIDTH)
    mode = np.zeros(wide, np.int64)
    mobile, sense, push = np.zeros(wide), np.zeros(wide), np.zeros(wide)
    held = np.zeros(wide)
    springy = False
    if additions is not None:
        springy = on_springs(additions)
    row = -1
    done = 0
    offset = advanced = 0.0
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
        is_ahead = best > row and (row < 0 or state_after[best] > done)
        if springy and best > row and state_after[best] == done:
            is_ahead = True
        if is_ahead:
            advanced = 0.0
            done, offset = state_after[best], state_offset[best]
            for i in range(1, n_blocks + 1):
                velocity[i], tension[i] = state_velocity[best, i], state_tension[best, i]
                rate[0, i] = velocity[i]
                mode[i] = state_mode[best, i]
                if additions is not None and springy:
                    additions.grip[i] = state_grip[best, i]
                take_mode(i, mode, mobile, sense, push, friction, lightness, additions)
            rate[0, 0] = drive_velocity
        row = best
        while done < target:
            span = (intervals[done] - offset) / tau - advanced
            propagate(
                drive_velocity,
                chain,
                additions,
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
            set_mode(
                block[done],
                new_mode[done],
                mode,
                mobile,
                sense,
                push,
                friction,
                lightness,
                tension,
                rate,
                additions,
            )
            for i in range(1, n_blocks + 1):
                velocity[i] = rate[0, i]
            done += 1
            offset = advanced = 0.0
        span = max(since - offset, 0.0) / tau
        if springy:
            # Nothing rests: what lies behind in whole windows is not gone through again for the next time.
            whole = SHORT_WINDOW * math.floor(span / SHORT_WINDOW)
            propagate(
                drive_velocity,
                chain,
                additions,
                mode,
                mobile,
                push,
                whole - advanced,
                tension,
                before,
                rate,
                slip,
                origins,
                weight,
            )
            for i in range(1, n_blocks + 1):
                velocity[i] = rate[0, i]
            advanced = whole
            span -= whole
        for i in range(1, n_blocks + 1):
            here[i] = tension[i]
        if additions is not None:
            for i in range(1, n_blocks + 1):
                held[i] = additions.grip[i]
        propagate(
            drive_velocity,
            chain,
            additions,
            mode,
            mobile,
            push,
            span,
            here,
            before,
            rate,
            slip,
            origins,
            weight,
        )
        for i in range(1, n_blocks + 1):
            tension_out[q, i - 1], velocity_out[q, i - 1] = here[i], rate[0, i]
            rate[0, i] = velocity[i]
        if additions is not None:
            for i in range(1, n_blocks + 1):
                additions.grip[i] = held[i]
                take_mode(i, mode, mobile, sense, push, friction, lightness, additions)


@outer
def start_from(
    positions,
    velocities,
    mass,
    stiffness,
    drive_stiffness,
    tau,
    strength,
    additions,
    velocity,
    tension,
    mode,
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
        net = tension[i] - tension[i + 1]
        if additions is not None:
            behind, ahead = additions.dashpot[i] * velocity[i - 1], additions.dashpot[i + 1] * velocity[i + 1]
            net += behind + ahead
            doubt += ROUNDINGS * (abs(behind) + abs(ahead))
        moves = velocity[i] if velocity[i] != 0.0 else net
        if velocity[i] == 0.0 and abs(moves) <= strength[i] + doubt:
            mode[i] = 0
            if additions is not None and additions.anchor[i] > 0.0:
                additions.grip[i] = net
        else:
            mode[i] = 1 if moves > 0.0 else -1


def to_positions(chain: Chain, times: FloatArray, force: FloatArray) -> FloatArray:
    """Positions [m], shape (T, N), from the spring forces at `times` [s]: x_1 = V t - T_1/K (Eq. 3), ..."""
    return chain.drive_velocity * times[:, None] - np.cumsum(force / chain.springs, axis=1)


def to_velocities(system: System, chain: Chain, velocity: FloatArray) -> FloatArray:
    """Velocities [m/s] from those of the kernel."""
    return velocity * (system.tau / chain.mass)
