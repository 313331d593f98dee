"""One larger chain: friction that falls with velocity, viscosity, and the height of the
push.

    m dv_i/dt = G_i - sign(v_i) mu(|v_i|) w_i,
    G_i = T_i + D_i - T_{i+1} - D_{i+1},    D_i = eta (v_{i-1} - v_i),
    mu(v) = mu_s - (mu_s - mu_k) min(v/v_c, 1),    w_i = w_i0 + c_i F_X

while block i slides. It sticks while |G_i| <= mu_s w_i. docs/models.md has the
equations, and what is found.

Steps are those of the implicit midpoint rule, with springs, dashpots and falling
friction all implicit: one tridiagonal solution, stable however stiff the dashpots are,
and energy is balanced to rounding. A step ends at the first release or stop in it.
Rests are left out in closed form, and so is creep that is stable.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import NamedTuple

import numpy as np

from precursors.analysis.slips import find_precursors, find_slips
from precursors.model.chain import Chain, FloatArray
from precursors.model.checks import Until, checked_span, not_negative
from precursors.model.scenes import ADDITIONS
from precursors.solver.kernel.compiled import entry
from precursors.solver.run import LargerRun
from precursors.solver.simulate import MAX_TRANSITIONS, TransitionLimitError
from precursors.support.waiting import in_threads

# Of the shorter of sqrt(m/k) and the time in which falling friction multiplies a
# velocity by e. With friction that jumps, this gives all transitions of the paper's
# scenes up to the first global slip, in order.
STEP = 0.1
STEP_OF_COULOMB = 5e-4
LEAP = 0.5  # of the excess of falling friction over viscosity at which creep runs away
BALANCED = 1e-3  # of mu_s w_i: a smaller net force does not end creep
SLOW = 0.1  # of v_c: a block that is slower counts as one that sticks
SMALLEST_DROP = (
    1e-4  # of F_Z: an event in which F_X falls by less is left out where friction falls
)
POINTS = 1e-4  # of F_Z: change of F_X from one point of the curve to the next
MAX_STEPS = 1_000_000_000
DONE, LIFTED, LIMIT = range(3)

compiled = entry(Path(__file__).parent, ["larger.py"], error_model="numpy", nogil=True)


@dataclass(frozen=True)
class LargerChain:
    """The paper's chain with up to three more numbers; all 0 is the paper's chain."""

    chain: Chain
    weakening_velocity: float = 0.0
    relaxation_time: float = 0.0
    viscosity: float = 0.0
    push_height: float = 0.0

    def __post_init__(self) -> None:
        if not isinstance(self.chain, Chain):
            raise TypeError(f"chain must be a Chain, but is {self.chain!r}")
        for name, unit in ADDITIONS.items():
            object.__setattr__(
                self, name, not_negative(name, getattr(self, name), unit)
            )
        if self.relaxation_time and self.viscosity:
            raise ValueError(
                "viscosity must not be given beside relaxation_time, which is viscosity / k"
            )

    def simulate(
        self, duration: float, until: Until = None, **limits: int
    ) -> LargerRun:
        """Run it with its accuracy, for `precursors.simulate`."""
        return simulate_with_accuracy(self, duration, until, **limits)


class CompiledChain(NamedTuple):
    """What the compiled functions need of a chain; `leap` is that of `simulate_larger`.

    Springs and dashpots, like forces and velocities, end with a 0: nothing is ahead of
    block N.
    """

    springs: FloatArray
    dashpots: FloatArray
    weights: FloatArray
    tilt: FloatArray
    mass: float
    mu_s: float
    mu_k: float
    weakening_velocity: float
    drive_velocity: float
    leap: float


def critical_length(larger: LargerChain) -> float:
    """Length l_c [m] at which creep runs away, for an even normal load; docs/models.md
    derives it.

    It is pi/(2 q) with t_v E S q^2 + 2 sqrt(rho E S) q = a, rho = M/L, a = (mu_s -
    mu_k) F_Z/(L v_c).
    """
    chain = larger.chain
    v_c = larger.weakening_velocity
    rigidity = chain.stiffness * chain.length / chain.n_blocks  # E S
    inertia = v_c * math.sqrt(chain.n_blocks * chain.mass / chain.length * rigidity)
    fall = (chain.mu_s - chain.mu_k) * chain.normal_load / chain.length  # a v_c
    viscous = (
        (larger.relaxation_time + larger.viscosity / chain.stiffness) * rigidity * v_c
    )
    # The root without a difference of nearly equal numbers, which is right without
    # viscosity as well.
    return (
        0.5 * math.pi * (inertia + math.sqrt(inertia**2 + viscous * fall)) / fall
        if fall
        else math.inf
    )


def tilt(chain: Chain, push_height: float) -> FloatArray:
    """Change c_i of each normal load with F_X [1]: a straight line that balances the
    torque of F_X."""
    n = chain.n_blocks
    if n == 1:
        return np.zeros(1)
    place = (
        np.arange(1, n + 1) - (n + 1) / 2
    ) / n  # from the middle of the contact, over its length
    return 12.0 * push_height / chain.length * place / (n * (1.0 - 1.0 / n**2))


@compiled
def strength(m, load, i):
    """Largest static friction mu_s w_i [N] while F_X is `load`."""
    return m.mu_s * (m.weights[i] + m.tilt[i] * load)


@compiled
def copy(target, source):
    """Copy an array; a slice would compile two seconds longer."""
    for i in range(source.shape[0]):
        target[i] = source[i]


@compiled
def net_force(m, force, velocity, i):
    """Net force of springs and dashpots on block i [N]."""
    behind = force[i] + m.dashpots[i] * (velocity[i - 1] - velocity[i])
    return behind - (force[i + 1] + m.dashpots[i + 1] * (velocity[i] - velocity[i + 1]))


@compiled
def mean_velocities(m, force, velocity, mode, last, h, leaps, u, r):
    """Velocities `u` over a step h of the blocks up to `last` (Thomas' algorithm).

    They balance the forces in the middle of the step. In a leap there is no inertia,
    and the forces at its end are balanced at the friction of the velocities before.
    """
    reach = 0.5 * h
    inertia = 2.0 * m.mass / h
    if leaps:
        reach = h
        inertia = 0.0
    load = force[0] + reach * m.springs[0] * (m.drive_velocity - velocity[0])
    behind = reach * m.springs[0]
    u_behind = m.drive_velocity
    r_behind = 0.0
    for i in range(last + 1):
        ahead = reach * m.springs[i + 1] + m.dashpots[i + 1]
        if mode[i] == 0:
            u[i] = r[i] = 0.0
        else:
            w = m.weights[i] + m.tilt[i] * load
            pivot = inertia + behind + ahead - behind * r_behind
            push = inertia * velocity[i] + force[i] - force[i + 1]
            if abs(velocity[i]) < m.weakening_velocity:
                fall = (m.mu_s - m.mu_k) * w / m.weakening_velocity
                push -= mode[i] * m.mu_s * w - (fall * velocity[i] if leaps else 0.0)
                pivot -= 0.0 if leaps else fall
            else:
                push -= mode[i] * m.mu_k * w
            u[i] = (push + behind * u_behind) / pivot
            r[i] = ahead / pivot
        behind = ahead
        u_behind = u[i]
        r_behind = r[i]
    for i in range(last - 1, -1, -1):
        u[i] += r[i] * u[i + 1]


@compiled
def advance(m, force, velocity, mode, last, watched, h, leaps, work, ends):
    """State at the end of a step h; the part of it at which a block first stops or is
    released, and which."""
    u = work[0]
    (new_force, new_velocity) = ends
    mean_velocities(m, force, velocity, mode, last, h, leaps, u, work[1])
    copy(new_force, force)
    copy(new_velocity, velocity)
    for i in range(min(len(mode), last + 2)):
        moved = u[i] if i <= last else 0.0
        behind = u[i - 1] if i > 0 else m.drive_velocity
        new_force[i] += h * m.springs[i] * (behind - moved)
        if mode[i] != 0:
            new_velocity[i] = moved if leaps else 2.0 * moved - velocity[i]
    part = 1.0
    block = -1
    for i in range(watched):
        at = 2.0
        if mode[i] != 0:
            if mode[i] * new_velocity[i] < 0.0:
                at = max(mode[i] * velocity[i], 0.0) / abs(
                    velocity[i] - new_velocity[i]
                )
        else:
            net = net_force(m, new_force, new_velocity, i)
            way = 1.0 if net > 0.0 else -1.0
            after = strength(m, new_force[0], i) - way * net
            if after < 0.0:
                before = max(
                    strength(m, force[0], i) - way * net_force(m, force, velocity, i),
                    0.0,
                )
                at = before / (before - after)
        if at < part or (at == 1.0 and block < 0):
            part = at
            block = i
    return part, block


@compiled
def is_stable(m, load, p):
    """Whether blocks 1..p may creep: well below the length at which creep runs away
    (see docs/models.md).

    The gravest mode of the stretch is a quarter of a wave; each normal load counts by
    its square.
    """
    if m.weakening_velocity == 0.0:
        return False
    whole = p == m.weights.shape[0]
    angle = math.pi / (2 * p + 1)
    weight = 0.0
    for i in range(p):
        share = (
            1.0 / p if whole else math.cos((i + 0.5) * angle) ** 2 * 4.0 / (2 * p + 1)
        )
        weight += share * (m.weights[i] + m.tilt[i] * load)
    fall = (m.mu_s - m.mu_k) * weight / m.weakening_velocity
    if whole:
        return fall < m.leap * 2.0 * math.sqrt(m.mass * m.springs[0] / p)
    shape = (2.0 * math.sin(0.5 * angle)) ** 2
    return fall - m.dashpots[p] * shape < m.leap * 2.0 * math.sqrt(
        m.mass * m.springs[p] * shape
    )


@compiled
def is_calm(m, force, velocity, last):
    """Whether blocks 1..last + 1 are as slow as in creep, and their forces balanced."""
    for i in range(last + 1):
        share = 1.0 - (1.0 - m.mu_k / m.mu_s) * velocity[i] / m.weakening_velocity
        excess = net_force(m, force, velocity, i) / strength(m, force[0], i) - share
        if abs(velocity[i]) > m.drive_velocity or abs(excess) > BALANCED:
            return False
    return True


@compiled
def heat_of_step(m, load, u, velocity, mode, last, h):
    """Heat of friction and of dashpots in a step [J]."""
    heat = 0.0
    for i in range(last + 1):
        mu = m.mu_k
        if abs(velocity[i]) < m.weakening_velocity:
            mu = m.mu_s - (m.mu_s - m.mu_k) * abs(u[i]) / m.weakening_velocity
        ahead = u[i + 1] if i < last else 0.0
        heat += h * mu * (m.weights[i] + m.tilt[i] * load) * mode[i] * u[i]
        heat += h * m.dashpots[i + 1] * (u[i] - ahead) ** 2
    return heat


@compiled
def switch(m, force, velocity, mode, i):
    """Release block i if it sticks; let it stick or turn if it stops, and stick if it
    does not start."""
    was_still = velocity[i] == 0.0
    velocity[i] = 0.0
    net = net_force(m, force, velocity, i)
    holds = was_still or abs(net) <= strength(m, force[0], i)
    mode[i] = 0 if mode[i] != 0 and holds else (1 if net > 0.0 else -1)


@compiled
def march(
    m, force, velocity, duration, until_global, step, lifting_load, max_rows, now
):
    """Run from rest: rows (time, block, mode, F_X), points (time, F_X), why and when it
    ended, energies [J].

    `step` [s] is that while nothing slides ahead of each block. At `lifting_load` [N] a
    block is lifted. The time reached is in `now` for those who wait.
    """
    n = m.weights.shape[0]
    total = m.weights.sum()
    smallest_drop = SMALLEST_DROP * total if m.weakening_velocity > 0.0 else -math.inf
    work = np.empty((3, n + 1))
    ends = np.empty((2, n + 1))
    mode = np.zeros(n, np.int64)
    seen = np.zeros(n, np.int64)
    rows = [(0.0, 0.0, 0.0, 0.0)]
    points = [(0.0, 0.0)]
    begin = 1
    time = 0.0
    drive = 0.0
    heat = 0.0
    n_seen = 0
    was_global = False
    leaps = True
    steps = 0
    why = DONE
    slow = SLOW * m.weakening_velocity
    creeping = -1
    stable = False
    while time < duration and why == DONE:
        last = n - 1
        steps = steps + 1
        while last >= 0 and mode[last] == 0:
            last -= 1
        watched = n if m.tilt[0] != 0.0 else min(n, last + 2)
        if last != creeping:
            creeping = last
            stable = last >= 0 and is_stable(m, force[0], last + 1)
        leaps = last < 0 or (
            stable
            and (mode[: last + 1] == 1).all()
            and (leaps or is_calm(m, force, velocity, last))
        )
        before = force[0]
        copy(work[2], velocity)
        h = duration - time if leaps else min(step[last], duration - time)
        part, block = advance(
            m, force, velocity, mode, last, watched, h, leaps, work, ends
        )
        if block >= 0:
            h *= part
            if leaps:
                copy(velocity, ends[1])
            if h > 0.0:
                advance(m, force, velocity, mode, last, watched, h, leaps, work, ends)
        if h > 0.0:
            load = 0.5 * (force[0] + ends[0, 0])
            drive += h * load * m.drive_velocity
            heat += heat_of_step(m, load, work[0], velocity, mode, last, h)
            copy(force, ends[0])
            copy(velocity, ends[1])
            time += h
            now[0] = time
        if block >= 0:
            switch(m, force, velocity, mode, block)
        for i in range(watched):
            way = mode[i] if abs(velocity[i]) > slow or slow == 0.0 else 0
            if way == seen[i]:
                continue
            begin = len(rows) if n_seen == 0 else begin
            n_seen += (way != 0) - (seen[i] != 0)
            seen[i] = way
            at = 1.0  # part of the step
            if abs(velocity[i]) != abs(work[2, i]):
                at = (slow - abs(work[2, i])) / (abs(velocity[i]) - abs(work[2, i]))
            load = before + at * (force[0] - before)
            rows.append((time - (1.0 - at) * h, i + 1.0, float(way), load))
            was_global = was_global or n_seen == n
            if n_seen == 0 and rows[begin][3] - force[0] < smallest_drop:
                del rows[begin:]
            elif n_seen == 0 and was_global and until_global:
                duration = time
        if abs(force[0] - points[-1][1]) > POINTS * total:
            points.append((time, force[0]))
        if force[0] > lifting_load:
            why = LIFTED
        elif len(rows) - 1 > max_rows or steps > MAX_STEPS:
            why = LIMIT
    points.append((time, force[0]))
    return np.array(rows)[1:], np.array(points), why, time, drive, heat


def simulate_larger(
    larger: LargerChain,
    duration: float,
    until: Until = None,
    step: float | None = None,
    max_transitions: int = MAX_TRANSITIONS,
    leap: float = LEAP,
) -> LargerRun:
    """Run a larger chain from rest with springs at natural length; other arguments are
    those of `simulate`.

    Transitions are those of blocks that slide faster than `SLOW` v_c, without events in
    which F_X falls by less than `SMALLEST_DROP` F_Z. The run has `load_points`, and in
    `larger` the numbers of the chain, the step, and `energy_error`: the energy that the
    balance lacks, over the work of the drive.

    `step` is in the shorter of sqrt(m/k) and the time in which falling friction
    multiplies a velocity by e, by default `STEP` or `STEP_OF_COULOMB`. Creep is leapt
    over where falling friction exceeds viscosity by less than the part `leap` of the
    excess at which creep runs away; -inf: nowhere.

    Raises
    ------
    ValueError
        If an argument is out of range, or a normal load becomes negative.
    TransitionLimitError
        If there are more transitions or steps than the limits; `run` is what was
        computed.
    """
    duration = checked_span(duration, until)
    chain = larger.chain
    v_c = larger.weakening_velocity
    n = larger.chain.n_blocks
    step = step or (STEP if v_c else STEP_OF_COULOMB)
    springs = np.append(chain.springs, 0.0)
    dashpots = np.zeros(n + 1)
    dashpots[1:-1] = larger.viscosity + larger.relaxation_time * chain.stiffness
    tilts = tilt(chain, larger.push_height)
    loads = chain.weights.copy()
    friction = chain.mass, chain.mu_s, chain.mu_k, v_c
    m = CompiledChain(
        springs, dashpots, loads, tilts, *friction, chain.drive_velocity, leap
    )
    seconds = np.full(n, 2.0 / chain.fastest_frequency_bound * step)
    if v_c and chain.mu_k < chain.mu_s:
        fall = (chain.mu_s - chain.mu_k) * (
            chain.weights + abs(tilts) * chain.mu_s * chain.normal_load
        )
        seconds = np.minimum(
            seconds, chain.mass * v_c / np.maximum.accumulate(fall) * step
        )
    lifting = np.divide(
        chain.weights, -tilts, out=np.full(n, np.inf), where=tilts < 0.0
    )
    force, velocity = np.zeros((2, n + 1))
    limits = duration, until is not None, seconds, lifting.min(), max_transitions
    now = np.zeros(1)
    rows, points, why, time, work, heat = in_threads(
        "running",
        [partial(march, m, force, velocity, *limits, now)],
        done=lambda: now[0] / duration,
    )[0]
    if why == LIFTED:
        raise ValueError(
            f"push_height = {larger.push_height:g} m lifts block {lifting.argmin() + 1} "
            f"at F_X = {lifting.min():.4g} N"
        )
    force = force[:-1]
    velocity = velocity[:-1]
    stored = (force**2 / chain.springs).sum() / 2.0 + chain.mass * (
        velocity**2
    ).sum() / 2.0
    numbers = {name: getattr(larger, name) for name in ADDITIONS}
    numbers |= {"step": step, "energy_error": (work - heat - stored) / work}
    columns = rows[np.argsort(rows[:, 0], kind="stable")].T
    run = LargerRun.from_columns(
        chain, time, *columns, larger=numbers, load_points=points
    )
    if why == LIMIT:
        raise TransitionLimitError(
            f"the larger chain met its limit of work at t = {time:.9g} s", run
        )
    return run


def simulate_with_accuracy(
    larger: LargerChain, duration: float, until: Until = None, **limits: int
) -> LargerRun:
    """The same, with what half the step changes in `larger`: halved_load_N and
    halved_events.

    These are the largest change of a load at which an event of Fig. 13 begins [N], of
    as many events as both runs have, and the change of their number.
    """
    run = simulate_larger(larger, duration, until, **limits)
    half = run.larger["step"] / 2.0
    finer = simulate_larger(larger, duration, until, half, **limits)
    a, b = (
        find_precursors(find_slips(r))["load_before"].to_numpy() for r in (run, finer)
    )
    n = min(len(a), len(b))
    found = {
        "halved_load_N": float(abs(a[:n] - b[:n]).max(initial=0.0)),
        "halved_events": len(b) - len(a),
    }
    return replace(run, larger=run.larger | found)
