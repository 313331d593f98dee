"""Motion of a larger chain, step by step: the compiled part of `larger`."""

from __future__ import annotations

import math
from pathlib import Path
from typing import NamedTuple

import numpy as np

from precursors.model.chain import FloatArray
from precursors.solver.record import IntArray
from precursors.support.compiled import entry

BALANCED = 1e-3  # of mu_s w_i: a smaller net force does not end creep
SLOW = 0.1  # of v_c: a block that is slower counts as one that sticks
# Of F_Z: an event in which F_X falls by less is left out where friction falls.
SMALLEST_DROP = 1e-4
POINTS = 1e-4  # of F_Z: change of F_X from one point of the curve to the next
# Peaks of F_X at global slips have settled when the last ones, at least so many, come
# again within a part of F_Z, after the same number of peaks, which is limited.
SETTLED = 1e-4
REPEATS = 4
LONGEST_PERIOD = 4
MOST_STALLED = 4  # times the number of blocks: steps that end where they begin
BEGIN, IS_GLOBAL = range(2)  # of an event: first row, whether it is a global slip

compiled = entry(Path(__file__).parent, ["steps.py"], error_model="numpy", nogil=True)


class CompiledChain(NamedTuple):
    """A chain as the compiled functions take it; `leap` is `larger.LEAP`.

    Springs and dashpots, like all arrays of the state, end with a 0: nothing is ahead
    of block N.
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


class State(NamedTuple):
    """State of a chain and room for a step: forces [N] and velocities [m/s], now, after
    and before the step and their mean in it; work of the drive and heat [J]."""

    force: FloatArray
    velocity: FloatArray
    new_force: FloatArray
    new_velocity: FloatArray
    velocity_before: FloatArray
    mean: FloatArray
    ratio: FloatArray
    mode: IntArray
    seen: IntArray
    energy: FloatArray


class Record(NamedTuple):
    """Results of a run so far; `event` has the numbers of the event that goes on."""

    rows: list[tuple[float, float, float, float]]
    points: list[tuple[float, float]]
    peaks: list[float]
    event: IntArray


class End(NamedTuple):
    """Where a run ends: at a time [s], after a global slip, when it has settled, where
    a block is lifted [N], at so many transitions, at so many steps."""

    duration: float
    at_global_slip: bool
    when_settled: bool
    lifting_load: float
    most: int
    most_steps: int


@compiled
def weight(m, load, i):
    """Normal load w_i [N] while F_X is `load`."""
    return m.weights[i] + m.tilt[i] * load


@compiled
def strength(m, load, i):
    """Largest static friction mu_s w_i [N]."""
    return m.mu_s * weight(m, load, i)


@compiled
def slope(m, w):
    """Fall of the friction of a normal load w with the velocity [N s/m]."""
    return (m.mu_s - m.mu_k) * w / m.weakening_velocity


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
def find_mean_velocities(m, s, last, h, leaps):
    """Mean velocities over a step h of the blocks up to `last` (Thomas' algorithm).

    They balance the forces in the middle of the step. In a leap there is no inertia,
    and the forces at its end are balanced at the friction of the velocities before.
    """
    reach = h if leaps else 0.5 * h
    inertia = 0.0 if leaps else 2.0 * m.mass / h
    behind = reach * m.springs[0]
    load = s.force[0] + behind * (m.drive_velocity - s.velocity[0])
    s.mean[last + 1] = 0.0
    u_behind = m.drive_velocity
    r_behind = 0.0
    for i in range(last + 1):
        ahead = reach * m.springs[i + 1] + m.dashpots[i + 1]
        if s.mode[i] == 0:
            s.mean[i] = s.ratio[i] = 0.0
        else:
            w = weight(m, load, i)
            pivot = inertia + behind + ahead - behind * r_behind
            push = inertia * s.velocity[i] + s.force[i] - s.force[i + 1]
            if abs(s.velocity[i]) < m.weakening_velocity:
                fall = slope(m, w)
                fallen = fall * s.velocity[i] if leaps else 0.0
                push -= s.mode[i] * m.mu_s * w - fallen
                pivot -= 0.0 if leaps else fall
            else:
                push -= s.mode[i] * m.mu_k * w
            s.mean[i] = (push + behind * u_behind) / pivot
            s.ratio[i] = ahead / pivot
        behind = ahead
        u_behind = s.mean[i]
        r_behind = s.ratio[i]
    for i in range(last - 1, -1, -1):
        s.mean[i] += s.ratio[i] * s.mean[i + 1]


@compiled
def try_step(m, s, last, watched, h, leaps, holds):
    """Find the state at the end of a step h; return the part of it at which a block
    first stops or, unless the step `holds` those at rest, is released, and which."""
    find_mean_velocities(m, s, last, h, leaps)
    copy(s.new_force, s.force)
    copy(s.new_velocity, s.velocity)
    for i in range(last + 2):
        moved = s.mean[i]
        behind = s.mean[i - 1] if i > 0 else m.drive_velocity
        s.new_force[i] += h * m.springs[i] * (behind - moved)
        if s.mode[i] != 0:
            s.new_velocity[i] = moved if leaps else 2.0 * moved - s.velocity[i]
    part = 2.0
    block = -1
    for i in range(watched):
        if holds and s.mode[i] == 0:
            continue
        at = part_until_change(m, s, i)
        if at < part:
            part = at
            block = i
    return part, block


@compiled
def part_until_change(m, s, i):
    """Part of the step at which block i stops or is released, so that its velocity or
    what it could bear beyond its net force becomes zero; 2 if neither does."""
    way = s.mode[i]
    if way != 0:
        before = way * s.velocity[i]
        after = way * s.new_velocity[i]
    else:
        net = net_force(m, s.new_force, s.new_velocity, i)
        side = 1.0 if net > 0.0 else -1.0
        after = strength(m, s.new_force[0], i) - side * net
        net = net_force(m, s.force, s.velocity, i)
        before = strength(m, s.force[0], i) - side * net
    if after >= 0.0:
        return 2.0
    before = max(before, 0.0)
    return before / (before - after)


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
    mean_weight = 0.0
    for i in range(p):
        wave = math.cos((i + 0.5) * angle) ** 2 * 4.0 / (2 * p + 1)
        share = 1.0 / p if whole else wave
        mean_weight += share * weight(m, load, i)
    shape = (2.0 * math.sin(0.5 * angle)) ** 2
    stiffness = m.springs[0] / p if whole else m.springs[p] * shape
    excess = slope(m, mean_weight) - m.dashpots[p] * shape
    return excess < m.leap * 2.0 * math.sqrt(m.mass * stiffness)


@compiled
def is_calm(m, s, last):
    """Whether blocks 1..last + 1 are as slow as in creep, and their forces balanced."""
    for i in range(last + 1):
        velocity = s.velocity[i]
        share = 1.0 - (1.0 - m.mu_k / m.mu_s) * velocity / m.weakening_velocity
        net = net_force(m, s.force, s.velocity, i)
        excess = net / strength(m, s.force[0], i) - share
        if abs(velocity) > m.drive_velocity or abs(excess) > BALANCED:
            return False
    return True


@compiled
def heat_of_step(m, s, load, last, h):
    """Heat of friction and of dashpots in a step [J]."""
    heat = 0.0
    for i in range(last + 1):
        mu = m.mu_k
        if abs(s.velocity[i]) < m.weakening_velocity:
            mu = m.mu_s - (m.mu_s - m.mu_k) * abs(s.mean[i]) / m.weakening_velocity
        heat += h * mu * weight(m, load, i) * s.mode[i] * s.mean[i]
        heat += h * m.dashpots[i + 1] * (s.mean[i] - s.mean[i + 1]) ** 2
    return heat


@compiled
def switch(m, s, i, pull):
    """Release block i, in the direction of `pull`, if it sticks; let it stick or turn
    if it stops, and stick if it does not start."""
    was_still = s.velocity[i] == 0.0
    s.velocity[i] = 0.0
    net = net_force(m, s.force, s.velocity, i)
    holds = was_still or abs(net) <= strength(m, s.force[0], i)
    if s.mode[i] == 0:
        s.mode[i] = 1 if pull > 0.0 else -1
    else:
        s.mode[i] = 0 if holds else (1 if net > 0.0 else -1)


@compiled
def take_step(m, s, last, watched, h, leaps, holds):
    """Move on by h [s], or to the first stop or release before; return the time
    moved."""
    copy(s.velocity_before, s.velocity)
    part, block = try_step(m, s, last, watched, h, leaps, holds)
    pull = 0.0
    if block >= 0:
        # At its end: a block without weight is released by no force at all.
        pull = net_force(m, s.new_force, s.new_velocity, block)
        h *= part
        if leaps:
            copy(s.velocity, s.new_velocity)
        if h > 0.0:
            try_step(m, s, last, watched, h, leaps, holds)
    if h > 0.0:
        load = 0.5 * (s.force[0] + s.new_force[0])
        s.energy[0] += h * load * m.drive_velocity
        s.energy[1] += heat_of_step(m, s, load, last, h)
        copy(s.force, s.new_force)
        copy(s.velocity, s.new_velocity)
    if block >= 0:
        switch(m, s, block, pull)
    return h


@compiled
def period_of(peaks, tolerance):
    """After how many peaks the last `REPEATS` ones, or two periods, come again within
    `tolerance`; 0: they do not."""
    n = len(peaks)
    for period in range(1, LONGEST_PERIOD + 1):
        compared = max(REPEATS, 2 * period)
        if compared + period > n:
            return 0
        repeats = True
        for i in range(n - compared, n):
            repeats &= abs(peaks[i] - peaks[i - period]) <= tolerance
        if repeats:
            return period
    return 0


@compiled
def note(m, s, record, watched, load_before, time, h):
    """Note which blocks became faster or slower than `SLOW` v_c in a step that ends at
    `time`; return whether a global slip ended in it."""
    slow = SLOW * m.weakening_velocity
    total = m.weights.sum()
    smallest_drop = SMALLEST_DROP * total if slow > 0.0 else -math.inf
    rows = record.rows
    event = record.event
    ended = False
    for i in range(watched):
        if m.weights[i] == 0.0:
            continue
        speed = abs(s.velocity[i])
        way = s.mode[i] if speed > slow or slow == 0.0 else 0
        if way == s.seen[i]:
            continue
        if not s.seen.any():
            event[BEGIN] = len(rows)
            event[IS_GLOBAL] = 0
        s.seen[i] = way
        at = 1.0  # part of the step
        speed_before = abs(s.velocity_before[i])
        if speed != speed_before:
            at = (slow - speed_before) / (speed - speed_before)
        load = load_before + at * (s.force[0] - load_before)
        rows.append((time - (1.0 - at) * h, i + 1.0, float(way), load))
        n_fast = np.count_nonzero(s.seen)
        event[IS_GLOBAL] |= n_fast == np.count_nonzero(m.weights)
        if n_fast == 0:
            onset = rows[event[BEGIN]][3]
            if onset - s.force[0] < smallest_drop:
                del rows[event[BEGIN] :]
            elif event[IS_GLOBAL] == 1:
                record.peaks.append(onset)
                ended = True
    if abs(s.force[0] - record.points[-1][1]) > POINTS * total:
        record.points.append((time, s.force[0]))
    return ended


@compiled
def march(m, s, end, step, now):
    """Run from rest: rows (time, block, mode, F_X), points (time, F_X), the time at the
    end and the number of steps.

    `step` [s] is that while nothing slides ahead of each block. The time reached is in
    `now` for those who wait.
    """
    n = m.weights.shape[0]
    tolerance = SETTLED * m.weights.sum()
    event = np.zeros(2, np.int64)
    record = Record([(0.0, 0.0, 0.0, 0.0)], [(0.0, s.force[0])], [0.0], event)
    del record.peaks[:]
    time = 0.0
    leaps = True
    steps = 0
    stalled = 0  # steps since the clock went on
    creeping = -1
    stable = False
    ended = False
    while not ended:
        last = n - 1
        steps += 1
        while last >= 0 and s.mode[last] == 0:
            last -= 1
        watched = n if m.tilt[0] != 0.0 else min(n, last + 2)
        if last != creeping:
            creeping = last
            stable = last >= 0 and is_stable(m, s.force[0], last + 1)
        # A block exactly at its limit may be released and stop at once, in turn, where
        # the next step would leap if it stuck. It is held for a step that does not.
        holds = stalled > MOST_STALLED * n
        creeps = stable and not holds and (s.mode[: last + 1] == 1).all()
        leaps = last < 0 or (creeps and (leaps or is_calm(m, s, last)))
        load_before = s.force[0]
        h = end.duration - time
        h = h if leaps else min(step[last], h)
        h = take_step(m, s, last, watched, h, leaps, holds)
        stalled = 0 if time + h > time else stalled + 1
        time += h
        now[0] = time
        ended = time >= end.duration or s.force[0] > end.lifting_load
        if note(m, s, record, watched, load_before, time, h):
            settled = period_of(record.peaks, tolerance) > 0
            ended |= end.at_global_slip or (end.when_settled and settled)
        ended |= len(record.rows) - 1 > end.most or steps > end.most_steps
    record.points.append((time, s.force[0]))
    return np.array(record.rows)[1:], np.array(record.points), time, steps
