"""The compiled kernel: the chain's linear operator, its Taylor series, the earliest root and the event loop.

Between two transitions the blocks that slide obey a linear system with constant friction and a load that
grows linearly in time; its solution is summed as a Taylor series to rounding. The next transition is the
earliest root of a velocity (a sliding block stops) or of a stick margin mu_s w_i -+ F_i (a stuck block
lets go). With |g''| <= M on the window, the positive root of g + g' s - M s^2/2 is a step that cannot pass
a root of g; repeated on the function whose bound is smallest, it converges to the earliest root of all or
proves that the window holds none.

Units inside: force and m/tau^2 times displacement in N, time in tau, velocity in N/tau, with tau chosen such
that the highest frequency of the chain times tau is at most `REACH`. The state is the force T_i in the spring
behind each block and its velocity u_i, not its position: slips of a micrometre after a millimetre of drive
keep all their digits. Column 0 of every array is the drive, columns 1..N the blocks, column N + 1 the free end.

All compiled code is in this one file, because a compile cache does not see an edit in an imported file.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from precursors.chain import Chain, FloatArray

# The series is cut at this order: the next term is at most REACH^28/28! = 1e-21 of the first.
ORDER = 27
REACH = 2.0
# A value below so many roundings of the forces it was computed from counts as zero.
ROUNDINGS = 8 * float(np.finfo(float).eps)

FINISHED, GLOBAL_SLIP, PAUSED = 0, 1, 2

# Columns of `clock`: time of the event's onset and its rounding error [s], time since then [tau], time since
# the last transition [tau]. Columns of `count`: transitions, sliding blocks, whether all slid at once.
ONSET, ONSET_ERROR, ELAPSED, SINCE = range(4)
TRANSITIONS, SLIDING, GLOBAL = range(3)


class System(NamedTuple):
    """A chain in the kernel's units."""

    tau: float
    coupling: FloatArray
    strength: FloatArray
    friction: FloatArray
    drive_velocity: float


def scale(chain: Chain) -> System:
    """Express a chain in the kernel's units; tau = REACH / (a bound of the largest frequency) (Gershgorin)."""
    springs = np.append(chain.springs, 0.0)
    stiffest = float(np.max(springs[:-1] + springs[1:] + np.append(0.0, springs[1:-1]) + springs[1:]))
    tau = REACH * math.sqrt(chain.mass / stiffest)
    pad = (1, 1)
    return System(
        tau=tau,
        coupling=np.concatenate([[0.0], springs * (tau * tau / chain.mass)]),
        strength=np.pad(chain.strength, pad),
        friction=np.pad(chain.kinetic_friction, pad),
        drive_velocity=chain.drive_velocity * chain.mass / tau,
    )


@njit(cache=True)
def expand(system, force, velocity, mode, last, rate, load):
    """Taylor coefficients of the velocities (`rate`) and net spring forces (`load`) of blocks 1..last (Eq. 2).

    This is the chain's linear operator: whatever else acts linearly between transitions belongs here.
    """
    coupling = system.coupling
    rate[0, 0] = system.drive_velocity
    for i in range(1, last + 1):
        rate[0, i] = velocity[i]
        load[0, i] = force[i] - force[i + 1]
        rate[1, i] = load[0, i] - mode[i] * system.friction[i] if mode[i] != 0 else 0.0
    for n in range(ORDER + 1):
        rate[n, last + 1] = 0.0
    for n in range(1, ORDER):
        per_n = 1.0 / n
        per_next = 1.0 / (n + 1)
        for i in range(1, last + 1):
            behind = coupling[i] * (rate[n - 1, i - 1] - rate[n - 1, i])
            ahead = coupling[i + 1] * (rate[n - 1, i] - rate[n - 1, i + 1])
            load[n, i] = (behind - ahead) * per_n
            rate[n + 1, i] = load[n, i] * per_next if mode[i] != 0 else 0.0


@njit(cache=True)
def move(system, force, velocity, mode, last, rate, s):
    """Carry spring forces and velocities of blocks 1..last forward by s, from the Taylor coefficients."""
    behind = system.drive_velocity * s
    for i in range(1, last + 1):
        slip = 0.0
        if mode[i] != 0:
            speed = 0.0
            for n in range(ORDER, -1, -1):
                speed = speed * s + rate[n, i]
                slip = slip * s + rate[n, i] / (n + 1)
            slip *= s
            velocity[i] = speed
        force[i] += system.coupling[i] * (behind - slip)
        behind = slip
    force[last + 1] += system.coupling[last + 1] * behind


@njit(cache=True)
def last_moved(mode):
    """Farthest block whose force can change: the one ahead of the farthest that slides, or N."""
    n_blocks = mode.shape[0] - 2
    i = n_blocks
    while i > 1 and mode[i] == 0:
        i -= 1
    return min(i + 1, n_blocks)


@njit(cache=True)
def coefficient(system, mode, rate, load, i, side, n):
    """n-th Taylor coefficient of what must stay positive: mode * velocity, or strength - side * force."""
    if side == 0:
        return mode[i] * rate[n, i]
    if n == 0:
        return system.strength[i] - side * load[0, i]
    return -side * load[n, i]


@njit(cache=True)
def safe_step(g, slope, curvature):
    """Positive root of g + slope s - curvature s^2/2 for g >= 0: no root of g lies before it."""
    if curvature <= 0.0:
        return -g / slope if slope < 0.0 else np.inf
    root = math.sqrt(slope * slope + 2.0 * curvature * g)
    return (slope + root) / curvature if slope > 0.0 else 2.0 * g / (root - slope) if root > slope else 0.0


@njit(cache=True)
def earliest_root(system, force, mode, last, rate, load, limit, work):
    """Time and place of the first transition before `limit`: (time, block, side); block 0 where there is none.

    side is 0 where a velocity vanishes and the sign of the force where a stuck block lets go.
    """
    block, sides, order = work.block, work.side, work.order
    curvature, zero, bound = work.curvature, work.zero, work.bound
    count = 0
    for i in range(1, last + 1):
        if mode[i] == 0 and i > 1 and mode[i - 1] == 0 and mode[i + 1] == 0:
            continue
        for k in range(1 if mode[i] != 0 else 2):
            side = 0 if mode[i] != 0 else 1 - 2 * k
            size = abs(force[i]) + abs(force[i + 1])
            for n in range(ORDER):
                size += (n + 1) * abs(coefficient(system, mode, rate, load, i, side, n))
            tolerance = ROUNDINGS * size
            # A root at the start was dealt with already: divide it out, look where the function goes next.
            p = 0
            while p < ORDER and abs(coefficient(system, mode, rate, load, i, side, p)) <= tolerance:
                p += 1
            if p == ORDER:
                continue
            first = coefficient(system, mode, rate, load, i, side, p)
            if first < 0.0:
                return 0.0, i, side
            second = 0.0
            power = 1.0
            for n in range(p + 2, ORDER):
                second += (
                    (n - p) * (n - p - 1) * abs(coefficient(system, mode, rate, load, i, side, n)) * power
                )
                power *= limit
            block[count], sides[count], order[count] = i, side, p
            curvature[count], zero[count] = second, tolerance
            bound[count] = safe_step(first, coefficient(system, mode, rate, load, i, side, p + 1), second)
            count += 1
    while True:
        c = -1
        s = limit
        for k in range(count):
            if bound[k] < s:
                c, s = k, bound[k]
        if c < 0:
            return limit, 0, 0
        g = 0.0
        slope = 0.0
        for n in range(ORDER - 1, order[c] - 1, -1):
            slope = slope * s + g
            g = g * s + coefficient(system, mode, rate, load, block[c], sides[c], n)
        step = safe_step(max(g, 0.0), slope, curvature[c])
        if g <= zero[c] or s + step <= s:
            if slope < 0.0:
                s = min(max(s - max(g / slope, -1e-9), 0.0), limit)
            return s, block[c], sides[c]
        bound[c] = s + step


class Work(NamedTuple):
    """Room for the functions that are watched at once."""

    block: np.ndarray
    side: np.ndarray
    order: np.ndarray
    curvature: np.ndarray
    zero: np.ndarray
    bound: np.ndarray


@njit(cache=True)
def make_work(n_blocks):
    """Allocate `Work` for two functions per block."""
    n = 2 * n_blocks
    return Work(
        np.empty(n, np.int64),
        np.empty(n, np.int64),
        np.empty(n, np.int64),
        np.empty(n),
        np.empty(n),
        np.empty(n),
    )


@njit(cache=True)
def set_mode(velocity, mode, i, new):
    """Apply a transition to a state: a block that stops or turns has velocity zero."""
    if mode[i] != 0:
        velocity[i] = 0.0
    mode[i] = new


@njit(cache=True)
def advance_clock(clock, wait, tau):
    """Start a new event `wait` after the end of the last; the onset is carried in two doubles."""
    add = (clock[ELAPSED] + wait) * tau + clock[ONSET_ERROR]
    total = clock[ONSET] + add
    clock[ONSET_ERROR] = add - (total - clock[ONSET])
    clock[ONSET] = total
    clock[ELAPSED] = 0.0
    clock[SINCE] += wait


@njit(cache=True, nogil=True)
def run_events(
    system,
    force,
    velocity,
    mode,
    clock,
    count,
    duration,
    until_global,
    transitions,
    intervals,
    states,
    stride,
    budget,
):
    """Run the chain until `duration` [s], the end of the first global slip, full buffers or a spent budget.

    `transitions` = (time [s], block, mode, tangential load [N]) and `intervals` [s] are filled from
    count[TRANSITIONS] on; after every `stride` transitions the state goes to `states` = (force, velocity, mode).
    """
    time, block, new_mode, tangential_load = transitions
    n_blocks = mode.shape[0] - 2
    rate = np.zeros((ORDER + 1, n_blocks + 2))
    load = np.zeros((ORDER + 1, n_blocks + 2))
    work = make_work(n_blocks)
    tau = system.tau
    loading_rate = system.coupling[1] * system.drive_velocity
    while True:
        k = count[TRANSITIONS]
        if k >= time.shape[0] or budget <= 0:
            return PAUSED
        budget -= 1
        remaining = ((duration - clock[ONSET]) - clock[ONSET_ERROR]) / tau - clock[ELAPSED]
        if count[SLIDING] == 0:
            if count[GLOBAL] and until_global:
                return GLOBAL_SLIP
            wait = max((system.strength[1] - (force[1] - force[2])) / loading_rate, 0.0)
            if wait >= remaining:
                force[1] += loading_rate * max(remaining, 0.0)
                advance_clock(clock, max(remaining, 0.0), tau)
                return FINISHED
            force[1] = force[2] + system.strength[1]
            advance_clock(clock, wait, tau)
            i, new = 1, 1
        else:
            if remaining <= 0.0:
                return FINISHED
            last = last_moved(mode)
            expand(system, force, velocity, mode, last, rate, load)
            s, i, side = earliest_root(system, force, mode, last, rate, load, min(1.0, remaining), work)
            if s > 0.0:
                move(system, force, velocity, mode, last, rate, s)
                clock[ELAPSED] += s
                clock[SINCE] += s
            if i == 0:
                continue
            new = side
            if side == 0:
                net = force[i] - force[i + 1]
                new = 0 if abs(net) <= system.strength[i] else (1 if net > 0.0 else -1)
        old = mode[i]
        set_mode(velocity, mode, i, new)
        if new == old:
            continue
        count[SLIDING] += (new != 0) - (old != 0)
        if count[SLIDING] == n_blocks:
            count[GLOBAL] = 1
        time[k] = clock[ONSET] + (clock[ONSET_ERROR] + clock[ELAPSED] * tau)
        block[k], new_mode[k], tangential_load[k] = i, new, force[1]
        intervals[k] = clock[SINCE] * tau
        clock[SINCE] = 0.0
        k += 1
        count[TRANSITIONS] = k
        if k % stride == 0:
            c = k // stride
            for b in range(n_blocks + 2):
                states[0][c, b] = force[b]
                states[1][c, b] = velocity[b]
                states[2][c, b] = mode[b]


@njit(cache=True, nogil=True)
def propagate(system, force, velocity, mode, span, rate, load):
    """Carry a state forward by `span` without a transition."""
    if not mode[1:-1].any():
        force[1] += system.coupling[1] * system.drive_velocity * span
        return
    last = last_moved(mode)
    while span > 0.0:
        s = min(span, 1.0)
        expand(system, force, velocity, mode, last, rate, load)
        move(system, force, velocity, mode, last, rate, s)
        span -= s


@njit(cache=True, nogil=True)
def evaluate(system, sorted_times, time, block, new_mode, intervals, states, stride, force_out, velocity_out):
    """State at each of `sorted_times` [s], from the stored states and the transitions between them."""
    n_blocks = system.strength.shape[0] - 2
    rate = np.zeros((ORDER + 1, n_blocks + 2))
    load = np.zeros((ORDER + 1, n_blocks + 2))
    force, velocity, mode = states[0][0].copy(), states[1][0].copy(), states[2][0].copy()
    done = 0
    for t in range(sorted_times.shape[0]):
        target = np.searchsorted(time, sorted_times[t], side="right")
        if target // stride > done // stride:
            c = target // stride
            force[:], velocity[:], mode[:] = states[0][c], states[1][c], states[2][c]
            done = c * stride
        while done < target:
            propagate(system, force, velocity, mode, intervals[done] / system.tau, rate, load)
            set_mode(velocity, mode, block[done], new_mode[done])
            done += 1
        here, speed = force.copy(), velocity.copy()
        since = sorted_times[t] - time[done - 1] if done > 0 else sorted_times[t]
        propagate(system, here, speed, mode, max(since, 0.0) / system.tau, rate, load)
        force_out[t] = here[1:-1]
        velocity_out[t] = speed[1:-1]


def start_state(system, chain, positions, velocities):
    """Spring forces, velocities and modes (float, float, int; columns as above) of a chain at time 0.

    A block that moves slides; one at rest slides where its springs overcome the static friction (Eq. 5).
    """
    force = np.zeros(chain.n_blocks + 3)
    force[1:-2] = chain.springs * -np.diff(positions, prepend=0.0)
    velocity = np.pad(velocities * (chain.mass / system.tau), 1)
    net = np.pad(force[1:-2] - force[2:-1], 1)
    overloaded = np.abs(net) > system.strength
    mode = np.where(velocity != 0.0, np.sign(velocity), np.where(overloaded, np.sign(net), 0.0)).astype(
        np.int64
    )
    return force, velocity, mode


def to_positions(chain, times, force):
    """Positions [m], shape (T, N), from the spring forces at `times` [s]: x_1 = V t - T_1/K (Eq. 3), ..."""
    lengths = force / chain.springs
    return chain.drive_velocity * np.asarray(times)[:, None] - np.cumsum(lengths, axis=1)


def to_velocities(system, chain, velocity):
    """Velocities in m/s."""
    return velocity * (system.tau / chain.mass)
