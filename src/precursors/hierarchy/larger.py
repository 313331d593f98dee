"""One larger chain: friction that falls with velocity, viscosity, and the height of the push.

    m dv_i/dt = G_i - sign(v_i) mu(|v_i|) w_i,     mu(v) = mu_s - (mu_s - mu_k) min(v/v_c, 1),
    G_i = T_i + D_i - T_{i+1} - D_{i+1},           D_i = eta (v_{i-1} - v_i),     w_i = w_i0 + c_i F_X

while block i slides. It sticks while |G_i| <= mu_s w_i. docs/models.md has the equations, and what is found.

Steps are those of the implicit midpoint rule, with springs, dashpots and falling friction all implicit: one
tridiagonal solution, stable however stiff the dashpots are, and energy is balanced to rounding. A step ends
at the first release or stop in it. Rests are left out in closed form, and so is creep that is stable.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from precursors.analysis.slips import find_precursors, find_slips
from precursors.model.chain import Chain, FloatArray
from precursors.model.checks import Until, checked_span, not_negative
from precursors.model.scenes import ADDITIONS
from precursors.solver.kernel.compiled import entry
from precursors.solver.run import Run
from precursors.solver.simulate import MAX_TRANSITIONS, TransitionLimitError

# Of the shorter of sqrt(m/k) and the time in which falling friction multiplies a velocity by e.
STEP, STEP_OF_COULOMB = 0.1, 0.01
LEAP = 0.5  # of the length l_c at which creep runs away
SLOW = 0.1  # of v_c: a block that is slower counts as one that sticks
SMALLEST_DROP = 1e-4  # of F_Z: an event in which F_X falls by less is left out where friction falls
POINTS = 1e-4  # of F_Z: change of F_X from one point of the curve to the next
MAX_STEPS = 1_000_000_000
DONE, GLOBAL, LIFTED, LIMIT = range(4)

compiled = entry(Path(__file__).parent, ["larger.py"], error_model="numpy")


@dataclass(frozen=True)
class LargerChain:
    """The paper's chain with up to three more numbers; all 0 is the paper's chain."""

    chain: Chain
    weakening_velocity: float = 0.0
    relaxation_time: float = 0.0
    viscosity: float = 0.0
    push_height: float = 0.0

    def __post_init__(self) -> None:
        for name, unit in ADDITIONS.items():
            object.__setattr__(self, name, not_negative(name, getattr(self, name), unit))
        if self.relaxation_time and self.viscosity:
            raise ValueError("viscosity must not be given beside relaxation_time, which is viscosity / k")


class Model(NamedTuple):
    """What the compiled functions need of a chain."""

    springs: FloatArray
    dashpots: FloatArray
    weights: FloatArray
    tilt: FloatArray
    mass: float
    mu_s: float
    mu_k: float
    weakening_velocity: float
    drive_velocity: float
    leap: float  # shorter stretches are leapt over, in lengths at which creep runs away


def critical_length(larger: LargerChain) -> float:
    """Length l_c [m] at which creep runs away, for an even normal load; docs/models.md derives it.

    It is pi/(2 q) with t_v E S q^2 + 2 sqrt(rho E S) q = a, rho = M/L, a = (mu_s - mu_k) F_Z/(L v_c).
    """
    chain = larger.chain
    n, length = chain.n_blocks, chain.length
    rigidity = chain.stiffness * length / n  # E S
    inertia = math.sqrt(n * chain.mass / length * rigidity)
    fall = (chain.mu_s - chain.mu_k) * chain.normal_load / (length * larger.weakening_velocity)
    viscous = (larger.relaxation_time + larger.viscosity / chain.stiffness) * rigidity
    # The root without a difference of nearly equal numbers, which is right without viscosity as well.
    return 0.5 * math.pi * (inertia + math.sqrt(inertia**2 + viscous * fall)) / fall


def tilt(chain: Chain, push_height: float) -> FloatArray:
    """Change c_i of each normal load with F_X [1]: a straight line that balances the torque of F_X."""
    n = chain.n_blocks
    if n == 1:
        return np.zeros(1)
    place = (np.arange(1, n + 1) - (n + 1) / 2) / n  # from the middle of the contact, over its length
    return 12.0 * push_height / chain.length * place / (n * (1.0 - 1.0 / n**2))


@compiled
def net_force(m, force, velocity, i):
    """Net force of springs and dashpots on block i [N]."""
    net = force[i]
    if i > 0:
        net += m.dashpots[i] * (velocity[i - 1] - velocity[i])
    if i + 1 < force.shape[0]:
        net -= force[i + 1] + m.dashpots[i + 1] * (velocity[i] - velocity[i + 1])
    return net


@compiled
def middle(m, force, velocity, mode, last, h, u, r):
    """Velocities `u` in the middle of a step h, of the blocks up to `last` (Thomas' algorithm)."""
    n = force.shape[0]
    load = force[0] + 0.5 * h * m.springs[0] * (m.drive_velocity - velocity[0])
    behind, u_behind, r_behind = 0.5 * h * m.springs[0], m.drive_velocity, 0.0
    for i in range(last + 1):
        ahead = 0.5 * h * m.springs[i + 1] + m.dashpots[i + 1] if i + 1 < n else 0.0
        if mode[i] == 0:
            u[i] = r[i] = 0.0
        else:
            w = m.weights[i] + m.tilt[i] * load
            pivot = 2.0 * m.mass / h + behind + ahead - behind * r_behind
            push = 2.0 * m.mass / h * velocity[i] + force[i] - (force[i + 1] if i + 1 < n else 0.0)
            if abs(velocity[i]) < m.weakening_velocity:
                pivot -= (m.mu_s - m.mu_k) * w / m.weakening_velocity
                push -= mode[i] * m.mu_s * w
            else:
                push -= mode[i] * m.mu_k * w
            u[i] = (push + behind * u_behind) / pivot
            r[i] = ahead / pivot
        behind, u_behind, r_behind = ahead, u[i], r[i]
    for i in range(last - 1, -1, -1):
        u[i] += r[i] * u[i + 1]


@compiled
def advance(m, force, velocity, mode, last, h, work, ends):
    """State at the end of a step h; the part of it at which a block first stops or is released, and which."""
    n, u = force.shape[0], work[0]
    new_force, new_velocity = ends
    middle(m, force, velocity, mode, last, h, u, work[1])
    new_force[:], new_velocity[:] = force, velocity
    for i in range(min(n, last + 2)):
        moved = u[i] if i <= last else 0.0
        behind = u[i - 1] if i > 0 else m.drive_velocity
        new_force[i] += h * m.springs[i] * (behind - moved)
        if mode[i] != 0:
            new_velocity[i] = 2.0 * moved - velocity[i]
    part, block = 1.0, -1
    for i in range(n if m.tilt[0] != 0.0 else min(n, last + 2)):
        at = 2.0
        if mode[i] != 0:
            if mode[i] * new_velocity[i] < 0.0:
                at = max(mode[i] * velocity[i], 0.0) / abs(velocity[i] - new_velocity[i])
        else:
            after = m.mu_s * (m.weights[i] + m.tilt[i] * new_force[0])
            after -= abs(net_force(m, new_force, new_velocity, i))
            if after < 0.0:
                before = m.mu_s * (m.weights[i] + m.tilt[i] * force[0])
                before -= abs(net_force(m, force, velocity, i))
                at = max(before, 0.0) / (max(before, 0.0) - after)
        if at < part or (at == 1.0 and block < 0):
            part, block = at, i
    return part, block


@compiled
def rest(m, force, velocity, mode, left, heat):
    """Load a chain at rest until a block is released, for `left` [s] at most: the time [s]."""
    rate, block, wait = m.springs[0] * m.drive_velocity, -1, left
    for i in range(force.shape[0]):
        net = net_force(m, force, velocity, i)
        way = 1.0 if net > 0.0 or i == 0 else -1.0
        margin = m.mu_s * (m.weights[i] + m.tilt[i] * force[0]) - way * net
        closing = rate * ((way if i == 0 else 0.0) - m.mu_s * m.tilt[i])
        if closing > 0.0 and margin < closing * wait:
            wait, block = max(margin, 0.0) / closing, i
    heat[0] += wait * (force[0] + 0.5 * rate * wait) * m.drive_velocity
    force[0] += rate * wait
    if block >= 0:
        mode[block] = 1 if block == 0 or net_force(m, force, velocity, block) > 0.0 else -1
    return wait


@compiled
def is_stable(m, load, p):
    """Whether blocks 1..p may creep: well below the length at which creep runs away (see docs/models.md)."""
    if m.weakening_velocity == 0.0:
        return False
    weight = 0.0
    for i in range(p):
        weight += (m.weights[i] + m.tilt[i] * load) / p
    fall = (m.mu_s - m.mu_k) * weight / m.weakening_velocity
    if p < m.springs.shape[0]:
        shape = (2.0 * math.sin(0.5 * math.pi / (2 * p + 1))) ** 2
        stiffness, damping = m.springs[p] * shape, m.dashpots[p] * shape
    else:
        stiffness, damping = m.springs[0] / p, 0.0
    return fall - damping < m.leap * 2.0 * math.sqrt(m.mass * stiffness)


@compiled
def creep(m, force, velocity, mode, p, left, curve, heat):
    """Let blocks 1..p creep until block p + 1 is released, for `left` [s] at most: the time [s].

    It is the motion without inertia at friction mu(v), to first order in V: T_i = g_i F_X + b_i.
    """
    n, (g, b) = force.shape[0], curve
    g[0], b[0], compliance, shortened = 1.0, 0.0, 0.0, 0.0
    for i in range(min(p + 1, n)):
        compliance += g[i] / m.springs[i]
        shortened += force[i] / m.springs[i]
        g[i + 1] = g[i] - m.mu_s * m.tilt[i]
    rate = m.drive_velocity / compliance if p < n else 0.0  # of F_X [N/s]
    speed = m.drive_velocity
    for i in range(p):
        speed -= rate * g[i] / m.springs[i]
        velocity[i] = speed
    for i in range(p):
        fall = (m.mu_s - m.mu_k) * (m.weights[i] + m.tilt[i] * force[0]) / m.weakening_velocity
        b[i + 1] = b[i] - m.mu_s * m.weights[i] + fall * velocity[i]
        if i > 0:
            b[i + 1] += m.dashpots[i] * (velocity[i - 1] - velocity[i])
        if i + 1 < n:
            b[i + 1] -= m.dashpots[i + 1] * (velocity[i] - velocity[i + 1])
    if p == n:
        load, wait = -b[n] / g[n], left
    else:
        for i in range(p + 1):
            shortened -= b[i] / m.springs[i]
        load = shortened / compliance
        edge = m.mu_s * m.weights[p] - b[p] - m.dashpots[p] * velocity[p - 1]
        edge += force[p + 1] if p + 1 < n else 0.0
        wait = max((edge / (g[p] - m.mu_s * m.tilt[p]) - load) / rate, 0.0)
        if wait < left:
            mode[p] = 1
        wait = min(wait, left)
    add_heat(m, load + 0.5 * rate * wait, velocity, velocity, mode, p - 1, wait, heat)
    for i in range(min(p + 1, n)):
        force[i] = g[i] * (load + rate * wait) + b[i]
    return wait


@compiled
def add_heat(m, load, u, velocity, mode, last, h, heat):
    """Add the work of the drive [J] and the heat of friction and of dashpots in a step."""
    n = u.shape[0]
    heat[0] += h * load * m.drive_velocity
    for i in range(last + 1):
        w = m.weights[i] + m.tilt[i] * load
        mu = m.mu_k
        if abs(velocity[i]) < m.weakening_velocity:
            mu = m.mu_s - (m.mu_s - m.mu_k) * abs(u[i]) / m.weakening_velocity
        heat[1] += h * mu * w * mode[i] * u[i]
        if i > 0:
            heat[2] += h * m.dashpots[i] * (u[i - 1] - u[i]) ** 2
    if last + 1 < n:
        heat[2] += h * m.dashpots[last + 1] * u[last] ** 2


@compiled
def switch(m, force, velocity, mode, i):
    """Release block i if it sticks; let it stick or turn if it stops, and stick if it does not start."""
    was_still, velocity[i] = velocity[i] == 0.0, 0.0
    net = net_force(m, force, velocity, i)
    holds = was_still or abs(net) <= m.mu_s * (m.weights[i] + m.tilt[i] * force[0])
    mode[i] = 0 if mode[i] != 0 and holds else (1 if net > 0.0 else -1)


@compiled
def with_row(table, n, row):
    """The table with a row n; it is made longer when it is full."""
    if n == table.shape[0]:
        longer = np.empty((2 * n, table.shape[1]))
        longer[:n] = table
        table = longer
    for i in range(row.shape[0]):
        table[n, i] = row[i]
    return table


@compiled
def march(m, force, velocity, heat, limits):
    """Run from rest: rows (time, block, mode, F_X), points (time, F_X), why and when it ended, which block.

    `limits` are duration [s], whether the first global slip ends the run, step [s], drop of F_X [N] below
    which an event is left out, change of F_X [N] from point to point, numbers of rows and of steps.
    """
    duration, until_global, step, smallest_drop, resolution, max_rows, max_steps = limits
    n = force.shape[0]
    work, ends, curve = np.empty((4, n)), np.empty((2, n)), np.empty((2, n + 1))
    mode, seen = np.zeros(n, np.int64), np.zeros(n, np.int64)
    rows, points, n_rows, n_points, begin = np.empty((1024, 4)), np.zeros((1024, 2)), 0, 1, 0
    time, n_seen, was_global, is_slow, steps = 0.0, 0, False, True, 0
    why, where = DONE, -1
    slow = SLOW * m.weakening_velocity
    while time < duration:
        last = n - 1
        while last >= 0 and mode[last] == 0:
            last -= 1
        is_slow = is_slow and last >= 0 and mode[: last + 1].all() and is_stable(m, force[0], last + 1)
        if last < 0 or is_slow:
            before = force[0]
            if is_slow:
                h = creep(m, force, velocity, mode, last + 1, duration - time, curve, heat)
            else:
                h = rest(m, force, velocity, mode, duration - time, heat)
                is_slow = mode[0] == 1
            time += h
            if abs(force[0] - points[n_points - 1, 1]) > resolution:
                points = with_row(points, n_points, np.array([time - h, before]))
                points = with_row(points, n_points + 1, np.array([time, force[0]]))
                n_points += 2
            continue
        steps += 1
        before, work[2] = force[0], velocity
        h = min(step, duration - time)
        part, block = advance(m, force, velocity, mode, last, h, work, ends)
        if block >= 0:
            h *= part
            if h > 0.0:
                advance(m, force, velocity, mode, last, h, work, ends)
        if h > 0.0:
            add_heat(m, 0.5 * (force[0] + ends[0, 0]), work[0], velocity, mode, last, h, heat)
            force[:], velocity[:] = ends[0], ends[1]
            time += h
        if block >= 0:
            switch(m, force, velocity, mode, block)
        for i in range(n):
            if m.weights[i] + m.tilt[i] * force[0] < 0.0:
                why, where = LIFTED, i
        for i in range(min(last + 2, n)):
            way = mode[i] if abs(velocity[i]) > slow or slow == 0.0 else 0
            if way == seen[i]:
                continue
            begin = n_rows if n_seen == 0 else begin
            n_seen += (way != 0) - (seen[i] != 0)
            seen[i] = way
            at = 1.0  # part of the step
            if slow > 0.0 and abs(velocity[i]) != abs(work[2, i]):
                at = (slow - abs(work[2, i])) / (abs(velocity[i]) - abs(work[2, i]))
            load = before + at * (force[0] - before)
            rows = with_row(rows, n_rows, np.array([time - (1.0 - at) * h, i + 1, way, load]))
            n_rows += 1
            was_global = was_global or n_seen == n
            if n_seen == 0 and rows[begin, 3] - force[0] < smallest_drop:
                n_rows = begin
            elif n_seen == 0 and was_global and until_global:
                why = GLOBAL
        if abs(force[0] - points[n_points - 1, 1]) > resolution:
            points = with_row(points, n_points, np.array([time, force[0]]))
            n_points += 1
        if n_rows > max_rows or steps > max_steps:
            why = LIMIT
        if why != DONE:
            break
    return rows[:n_rows], points[:n_points], why, time, where


def simulate_larger(
    larger: LargerChain,
    duration: float,
    until: Until = None,
    step: float | None = None,
    max_transitions: int = MAX_TRANSITIONS,
    leap: float = LEAP,
) -> Run:
    """Run a larger chain from rest with springs at natural length.

    Parameters
    ----------
    larger : LargerChain
        The chain.
    duration : float
        Time to run [s], the limit where `until` is given.
    until : {None, "global slip"}
        Stop at the end of the first event in which all blocks slide at the same instant.
    step : float
        Step, in the shorter of sqrt(m/k) and the time in which falling friction multiplies a velocity by
        e; by default `default_step`.
    max_transitions : int
        Largest number of transitions.
    leap : float
        Stretches of creep shorter than so much of l_c are leapt over; 0 leaps over none.

    Returns
    -------
    Run
        With the transitions of blocks that slide faster than `SLOW` v_c, without events in which F_X falls by
        less than `SMALLEST_DROP` F_Z; `load_points`; and in `larger` the numbers of the chain, the step [s]
        and `energy_error`, the energy that the balance lacks, relative to the work of the drive.

    Raises
    ------
    ValueError
        If an argument is out of range, or a normal load becomes negative.
    TransitionLimitError
        If there are more transitions or steps than the limits; `run` is what was computed.
    """
    duration, step = checked_span(duration, until), step or default_step(larger)
    chain, v_c = larger.chain, larger.weakening_velocity
    viscosity = larger.viscosity + larger.relaxation_time * chain.stiffness
    tilts = tilt(chain, larger.push_height)
    m = Model(
        springs=chain.springs,
        dashpots=np.append(0.0, np.full(chain.n_blocks - 1, viscosity)),
        weights=chain.weights.copy(),
        tilt=tilts,
        mass=chain.mass,
        mu_s=chain.mu_s,
        mu_k=chain.mu_k,
        weakening_velocity=v_c,
        drive_velocity=chain.drive_velocity,
        leap=leap,
    )
    seconds = 2.0 / chain.fastest_frequency_bound * step
    if v_c and chain.mu_k < chain.mu_s:
        fall = (chain.mu_s - chain.mu_k) * (chain.weights + abs(tilts) * chain.mu_s * chain.normal_load)
        seconds = min(seconds, chain.mass * v_c / fall.max() * step)
    (force, velocity), heat, load = np.zeros((2, chain.n_blocks)), np.zeros(3), chain.normal_load
    drop = SMALLEST_DROP * load if v_c else -math.inf
    limits = duration, until is not None, seconds, drop, POINTS * load, max_transitions, MAX_STEPS
    rows, points, why, time, where = march(m, force, velocity, heat, limits)
    if why == LIFTED:
        raise ValueError(
            f"push_height = {larger.push_height:g} m lifts block {where + 1} at F_X = {force[0]:.4g} N"
        )
    when, block, mode, loads = rows[np.argsort(rows[:, 0], kind="stable")].T
    run = Run.from_transitions(chain, time, when, block, mode, loads)
    stored = (force**2 / chain.springs).sum() / 2.0 + chain.mass * (velocity**2).sum() / 2.0
    numbers = {name: getattr(larger, name) for name in ADDITIONS}
    numbers |= {"step_s": seconds, "energy_error": (heat[0] - heat[1:].sum() - stored) / heat[0]}
    run = replace(run, larger=numbers, load_points=np.vstack([points, [time, force[0]]]))
    if why == LIMIT:
        raise TransitionLimitError(f"the larger chain met its limit of work at t = {time:.9g} s", run)
    return run


def simulate_with_accuracy(larger: LargerChain, duration: float, until: Until = None, **limits: int) -> Run:
    """The same, with what half the step changes in `larger`: halved_load_N and halved_events.

    These are the largest change of a load at which an event of Fig. 13 begins [N], of as many events as both
    runs have, and the change of their number.
    """
    run = simulate_larger(larger, duration, until, **limits)
    finer = simulate_larger(larger, duration, until, default_step(larger) / 2.0, **limits)
    a, b = (find_precursors(find_slips(r))["load_before"].to_numpy() for r in (run, finer))
    n = min(len(a), len(b))
    found = {"halved_load_N": float(abs(a[:n] - b[:n]).max(initial=0.0)), "halved_events": len(b) - len(a)}
    return replace(run, larger={**(run.larger or {}), **found})


def default_step(larger: LargerChain) -> float:
    """Step in the shortest time of the chain: where friction jumps, far smaller."""
    return STEP if larger.weakening_velocity else STEP_OF_COULOMB
