"""The method of the solver in plain Python; the compiled kernel computes the same.

The solver goes from transition to transition, each of which is the earliest root of all
event functions.

Between two transitions the chain is linear: friction is constant, and the load grows
linearly in time. With the force T_i in the spring behind each block, its stiffness c_i
= K, k, k, ... and v_0 = V (Eqs. 2-6),

    dT_i/dt = c_i (v_{i-1} - v_i),
    m dv_i/dt = T_i - T_{i+1} - mode_i mu_k w_i    where block i slides.

1. Time is cut into short windows, in which Taylor series of `ORDER` terms are exact to
  rounding.
2. The event function of a sliding block is its velocity. A sticking block has two: its
  margins mu_s w_i -+ (T_i - T_{i+1}). The earliest root of all of them is the next
  transition.
3. Let g be an event function with |g''| <= M. The positive root of g + g' s - M s^2/2
  is a safe step: no root of g lies before it. Such steps converge to the first root, or
  prove that the window has none.
4. A block that stops sticks if |T_i - T_{i+1}| <= mu_s w_i, and otherwise slides in the
  direction of that force. A block that is released slides in the direction of the
  force.
5. While all blocks stick, only T_1 grows, at the rate K V, until block 1 is released.
6. A block without load has no friction and no transitions: once pushed, it moves
  forever. An event is over when all other blocks stick.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from precursors.model.chain import FREE, Chain

Floats = NDArray[np.floating]
REAL = np.longdouble  # has more digits than a double on some machines
ORDER = 24
# Longest window times largest frequency: WINDOW^ORDER / ORDER! is 3e-21.
WINDOW = 1.375
# A value below this share of the sum of its terms counts as zero.
ROUNDINGS = 8 * float(np.finfo(float).eps)
N = np.arange(ORDER + 1, dtype=REAL)
BINOMIAL = np.array(
    [[math.comb(n, k) for n in range(ORDER + 1)] for k in range(ORDER + 1)], dtype=REAL
)
EXPONENT = np.maximum(N[None, :] - N[:, None], 0)


class Switching(NamedTuple):
    """Rules of the transitions.

    A block that stops sticks if its net force is at most `sticks_within` [N], shape
    (N,), which is mu_s w in the model (Eq. 5). `backward` is whether blocks can slide
    backward.
    """

    sticks_within: Floats
    backward: bool = True


class State(NamedTuple):
    """Velocities [m/s], spring forces [N] and modes, each of shape (N + 2,).

    Column 0 is the drive, and column N + 1 the free end.
    """

    velocity: Floats
    force: Floats
    mode: NDArray[np.int64]


def at_start(chain: Chain, positions: Floats, velocities: Floats) -> State:
    """Return the state at time 0.

    A block slides if it moves, or if its springs overcome the static friction (Eq. 5).
    """
    force = np.pad(-chain.springs * np.diff(positions, prepend=0.0), 1).astype(REAL)
    net = force[1:-1] - force[2:]
    rounding = ROUNDINGS * (
        chain.strength + 4.0 * chain.springs.max() * abs(positions).max()
    )
    pushed = np.where(abs(net) > chain.strength + rounding, np.sign(net), 0.0)
    mode = np.where(velocities != 0.0, np.sign(velocities), pushed)
    mode[chain.weights == 0.0] = FREE
    return State(
        np.r_[chain.drive_velocity, velocities, REAL(0)],
        force,
        np.pad(mode.astype(np.int64), 1),
    )


def is_at_rest(state: State) -> bool:
    """Whether nothing moves but the drive.

    Then all blocks stick, apart from those without load that were never pushed.
    """
    moved = (state.velocity[1:-1] != 0.0) | (np.diff(state.force[1:]) != 0.0)
    moved[0] = True
    mode = state.mode[1:-1]
    return not ((abs(mode) == 1) | ((mode == FREE) & moved)).any()


def expand(chain: Chain, state: State, window: float) -> tuple[Floats, Floats]:
    """Return the Taylor series of velocities and spring forces.

    Row n is the coefficient of s^n, where s = 1 at the end of the window.
    """
    v, force = np.zeros((2, ORDER + 1, chain.n_blocks + 2), dtype=REAL)
    v[0] = state.velocity
    force[0] = state.force
    last = min(int(np.flatnonzero(state.mode).max(initial=0)) + 1, chain.n_blocks)
    springs = chain.springs[:last]
    mode = state.mode[1 : last + 1]
    friction = mode * chain.kinetic_friction[:last]
    for n in range(ORDER):
        pull = (
            force[n, 1 : last + 1]
            - force[n, 2 : last + 2]
            - (friction if n == 0 else 0.0)
        )
        v[n + 1, 1 : last + 1] = window / (n + 1) * (mode != 0) * pull / chain.mass
        force[n + 1, 1 : last + 1] = (
            window / (n + 1) * springs * (v[n, :last] - v[n, 1 : last + 1])
        )
    return v, force


def move(state: State, v: Floats, force: Floats, s: float) -> State:
    """Return the state at s; the smallest terms are summed first."""
    terms = s ** N[:, None]
    return State(
        (v * terms)[::-1].sum(axis=0), (force * terms)[::-1].sum(axis=0), state.mode
    )


def safe_step(g: float, slope: float, curvature: float) -> float:
    """Return the positive root of g + slope s - curvature s^2/2 for g >= 0.

    No root of a function with this value and slope, and |g''| <= curvature, lies before
    it.
    """
    root = math.sqrt(slope * slope + 2.0 * curvature * g)
    rising = (slope + root) / curvature if curvature else math.inf
    return 2.0 * g / (root - slope) if slope < 0.0 else rising


def first_root(series: Floats, zero: float, limit: float) -> float:
    """Return the first root of a polynomial in 0 <= s < limit <= 1, or infinity.

    A value up to `zero` counts as zero.
    """
    resolved = np.flatnonzero(abs(series) > zero)
    if resolved.size == 0:
        return math.inf
    # A root at the start belongs to the last transition: divide it out. If g still
    # falls, there is another one at the start.
    c = np.append(series[resolved[0] :], np.zeros(resolved[0]))
    s = 0.0
    left = 1.0
    while c[0] + np.minimum(c[1:], 0.0).sum() <= 0.0:
        step = safe_step(max(c[0], 0.0), c[1], float((N * (N - 1.0)) @ abs(c)))
        if c[0] <= zero or left * step <= 1e-17:
            # The root is reached, apart from a last step of Newton's method.
            return s + left * max(-c[0] / c[1], 0.0) if c[1] < 0.0 else s
        if s + left * step >= limit:
            return math.inf
        # Expand about the new place, and scale to the rest of the window.
        c = (BINOMIAL * step**EXPONENT) @ c * (1.0 - step) ** N
        s = s + left * step
        left = left * (1.0 - step)
    return math.inf


def next_transition(
    chain: Chain, switching: Switching, state: State, window: float, eps: float
) -> tuple[float, int, int, State]:
    """Return (s, block, new mode) of the first transition in the window, and the state
    at s.

    Without a transition they are (1, 0, 0).
    """
    v, force = expand(chain, state, window)
    net = force[:, 1:-1] - force[:, 2:]
    sliding = state.mode[1:-1]
    sizes = abs(force).sum(axis=0)
    zero = 2.0 * eps * (sizes[1:-1] + sizes[2:] + chain.strength)
    first = 1.0
    block = 0
    new = 0
    for side in (1, -1) if switching.backward else (1,):
        margin = (
            np.concatenate([[chain.strength], np.zeros((ORDER, chain.n_blocks))])
            - side * net
        )
        g = np.where(sliding, sliding * v[:, 1:-1], margin)
        below = np.where(sliding, zero * window / chain.mass, zero)
        may = g[0] + np.minimum(g[1:], 0.0).sum(axis=0) <= below
        watched = (sliding == 0) | ((sliding != FREE) & (side == 1))
        for i in np.flatnonzero(may & watched):
            s = first_root(g[:, i], float(below[i]), first)
            if s < first:
                first = s
                block = int(i) + 1
                new = side
    state = move(state, v, force, first)
    if state.mode[block]:
        state.velocity[block] = 0.0
        net_force = state.force[block] - state.force[block + 1]
        new = (
            0
            if abs(net_force) <= (switching.sticks_within + zero)[block - 1]
            else int(np.sign(net_force))
        )
    return first, block, new, state


def find_transitions(
    chain: Chain,
    state: State,
    duration: float,
    until_global: bool,
    most: int,
    switching: Switching | None = None,
) -> tuple[list[tuple[float, float, int, int, float]], float]:
    """Return transitions (time, time since the last, block, mode, load), and the time
    of the end.

    The default of `switching` is the model's.
    """
    switching = switching or Switching(chain.strength)
    rows = [
        (0.0, 0.0, int(i), int(state.mode[i]), state.force[1])
        for i in np.flatnonzero(abs(state.mode) == 1)
    ]
    window = WINDOW / chain.fastest_frequency_bound
    bears_load = chain.bears_load
    is_global = False
    at_once = 0
    onset = elapsed = since = 0.0
    while len(rows) < most and (left := duration - onset - elapsed) > 0.0:
        slides = state.mode[1:-1][bears_load] != 0
        is_global = is_global or bool(slides.all())
        if until_global and is_global and not slides.any():
            break
        if not (abs(state.mode) == 1).any():
            onset = onset + elapsed
            elapsed = 0.0
        if is_at_rest(state):
            margin = chain.strength[0] - state.force[1] + state.force[2]
            wait = max(margin / chain.loading_rate, 0.0)
            onset = onset + min(wait, left)
            since = since + min(wait, left)
            if wait >= left:
                break
            state.force[1] = max(state.force[1], state.force[2] + chain.strength[0])
            block = 1
            new = 1
        else:
            roundings = ROUNDINGS * 2.0 ** (at_once // (4 * chain.n_blocks))
            span = min(window, left)
            s, block, new, state = next_transition(
                chain, switching, state, span, roundings
            )
            elapsed = elapsed + s * span
            since = since + s * span
            at_once = at_once + 1 if s == 0.0 else 0
        if block and new != state.mode[block]:
            state.mode[block] = new
            rows.append((onset + elapsed, since, block, new, state.force[1]))
            since = 0.0
    return rows, onset + elapsed
