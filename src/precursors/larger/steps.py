"""Motion of a larger chain, step by step: the compiled part of `larger`."""

from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from precursors.model.chain import FloatArray
from precursors.solver.record import IntArray
from precursors.support.compiled import entry, untyped

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
# Of an event: first row, whether it is a global slip, blocks that are fast now.
BEGIN, IS_GLOBAL, FAST = range(3)

inner = untyped.njit(forceinline=True, error_model="numpy")
compiled = entry(Path(__file__), error_model="numpy", nogil=True)


class CompiledChain(NamedTuple):
    """A chain as the compiled functions take it; its friction as `Chords`.

    Springs and dashpots, like all arrays of the state, end with a 0: nothing is ahead
    of block N.
    """

    springs: FloatArray
    dashpots: FloatArray
    weights: FloatArray
    tilt: FloatArray
    mass: float
    mu_s: float
    ends: FloatArray
    at_rest: FloatArray
    fall: FloatArray
    weakening_velocity: float
    drive_velocity: float
    bears_load: NDArray[np.bool_]


class Motion(NamedTuple):
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


class Results(NamedTuple):
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


@inner
def friction(m, speed):
    """Friction coefficient mu(v) = rest - fall v about a speed: rest, fall [s/m]."""
    piece = 0
    while speed >= m.ends[piece]:
        piece += 1
    return m.at_rest[piece], m.fall[piece]


@inner
def weight(m, load, i):
    """Normal load w_i [N] while F_X is `load`."""
    return m.weights[i] + m.tilt[i] * load


@inner
def net_force(m, force, velocity, i):
    """Net force of springs and dashpots on block i [N]."""
    behind = force[i] + m.dashpots[i] * (velocity[i - 1] - velocity[i])
    return behind - (force[i + 1] + m.dashpots[i + 1] * (velocity[i] - velocity[i + 1]))


@inner
def margin(m, force, velocity, i, side):
    """What static friction on block i could bear beyond a net force to one side [N]."""
    return m.mu_s * weight(m, force[0], i) - side * net_force(m, force, velocity, i)


@inner
def find_mean_velocities(m, s, last, h):
    """Mean velocities in a step h of the blocks up to `last` (Thomas' algorithm).

    They balance the forces in the middle of the step.
    """
    inertia = 2.0 * m.mass / h
    behind = 0.5 * h * m.springs[0]
    load = s.force[0] + behind * (m.drive_velocity - s.velocity[0])
    mean_behind = m.drive_velocity
    ratio_behind = 0.0
    for i in range(last + 1):
        ahead = 0.5 * h * m.springs[i + 1] + m.dashpots[i + 1]
        mean = ratio = 0.0
        if s.mode[i] != 0:
            w = weight(m, load, i)
            rest, fall = friction(m, abs(s.velocity[i]))
            push = inertia * s.velocity[i] + s.force[i] - s.force[i + 1]
            push -= s.mode[i] * rest * w
            pivot = inertia - fall * w + ahead + behind * (1.0 - ratio_behind)
            mean = (push + behind * mean_behind) / pivot
            ratio = ahead / pivot
        s.mean[i] = mean_behind = mean
        s.ratio[i] = ratio_behind = ratio
        behind = ahead
    s.mean[last + 1] = 0.0
    for i in range(last - 1, -1, -1):
        s.mean[i] += s.ratio[i] * s.mean[i + 1]


@inner
def try_step(m, s, last, watched, h, holds):
    """Find the state at the end of a step h; return the part of it at which a block
    first stops or, unless the step `holds` those at rest, is released, and which."""
    find_mean_velocities(m, s, last, h)
    moved_behind = m.drive_velocity
    for i in range(last + 2):
        moved = s.mean[i]
        s.new_force[i] = s.force[i] + h * m.springs[i] * (moved_behind - moved)
        s.new_velocity[i] = 2.0 * moved - s.velocity[i]
        moved_behind = moved
    for i in range(last + 2, watched + 1):
        s.new_force[i] = s.force[i]
        s.new_velocity[i] = 0.0
    part = 2.0
    block = -1
    for i in range(watched):
        if s.mode[i] != 0:
            before = max(s.mode[i] * s.velocity[i], 0.0)
            after = s.mode[i] * s.new_velocity[i]
        elif holds:
            continue
        else:
            net = net_force(m, s.new_force, s.new_velocity, i)
            side = 1.0 if net > 0.0 else -1.0
            after = margin(m, s.new_force, s.new_velocity, i, side)
            before = 0.0
            if after < 0.0:
                before = max(margin(m, s.force, s.velocity, i, side), 0.0)
        if after < 0.0 and before < part * (before - after):
            part = before / (before - after)
            block = i
    return part, block


@compiled
def switch(m, s, i, pull):
    """Release block i, in the direction of `pull`, if it sticks; let it stick or turn
    if it stops, and stick if it does not start."""
    was_still = s.velocity[i] == 0.0
    s.velocity[i] = 0.0
    if s.mode[i] == 0:
        s.mode[i] = 1 if pull > 0.0 else -1
        return
    net = net_force(m, s.force, s.velocity, i)
    side = 1 if net > 0.0 else -1
    holds = was_still or margin(m, s.force, s.velocity, i, side) >= 0.0
    s.mode[i] = 0 if holds else side


@inner
def accept(m, s, last, h):
    """Move on to the end of a step h, with its work and heat; return whether a block
    became faster or slower than `SLOW` v_c."""
    load = 0.5 * (s.force[0] + s.new_force[0])
    slow = SLOW * m.weakening_velocity
    heat = 0.0
    changes = False
    for i in range(last + 1):
        rest, fall = friction(m, abs(s.velocity[i]))
        speed = s.mode[i] * s.mean[i]
        heat += (rest - fall * speed) * weight(m, load, i) * speed
        heat += m.dashpots[i + 1] * (s.mean[i] - s.mean[i + 1]) ** 2
        changes |= (abs(s.new_velocity[i]) > slow) != (s.seen[i] != 0)
        s.velocity_before[i] = s.velocity[i]
        s.velocity[i] = s.new_velocity[i]
        s.force[i] = s.new_force[i]
    s.force[last + 1] = s.new_force[last + 1]
    s.energy[0] += h * load * m.drive_velocity
    s.energy[1] += h * heat
    return changes


@compiled
def farthest(mode):
    """Last block that slides; -1: all stick."""
    last = len(mode) - 1
    while last >= 0 and mode[last] == 0:
        last -= 1
    return last


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
def passing(m, s, i):
    """Part of the last step at which block i passed `SLOW` v_c; its end if friction
    jumps."""
    slow = SLOW * m.weakening_velocity
    after = abs(s.velocity[i])
    before = abs(s.velocity_before[i])
    if slow == 0.0 or after == before:
        return 1.0
    return (slow - before) / (after - before)


@compiled
def note(m, s, results, watched, load_before, time, h):
    """Note which blocks became faster or slower than `SLOW` v_c in a step that ends at
    `time`; return whether a global slip ended in it."""
    slow = SLOW * m.weakening_velocity
    bearing = m.bears_load.sum()
    event = results.event
    ended = False
    for i in range(watched):
        is_fast = slow == 0.0 or abs(s.velocity[i]) > slow
        way = s.mode[i] if is_fast else 0
        if way == s.seen[i] or not m.bears_load[i]:
            continue
        if event[FAST] == 0:
            event[BEGIN] = len(results.rows)
            event[IS_GLOBAL] = 0
        event[FAST] += abs(way) - abs(s.seen[i])
        event[IS_GLOBAL] |= event[FAST] == bearing
        s.seen[i] = way
        part = passing(m, s, i)
        load = load_before + part * (s.force[0] - load_before)
        results.rows.append((time - (1.0 - part) * h, i + 1.0, float(way), load))
        if event[FAST] == 0:
            ended |= close_event(m, s, results)
    return ended


@compiled
def close_event(m, s, results):
    """Keep an event that is over unless F_X fell too little in it; return whether it
    was a global slip."""
    rows = results.rows
    begin = results.event[BEGIN]
    onset = rows[begin][3]
    falls = m.weakening_velocity > 0.0
    if falls and onset - s.force[0] < SMALLEST_DROP * m.weights.sum():
        del rows[begin:]
        return False
    if results.event[IS_GLOBAL] == 1:
        results.peaks.append(onset)
        return True
    return False


@compiled
def march(m, s, end, step):
    """Run from rest: rows (time, block, mode, F_X), points (time, F_X), the time at the
    end and the number of steps.

    `step` [s] is that while nothing slides ahead of each block.
    """
    n = len(m.weights)
    total = m.weights.sum()
    event = np.zeros(3, np.int64)
    results = Results([(0.0, 0.0, 0.0, 0.0)], [(0.0, s.force[0])], [0.0], event)
    del results.peaks[:]
    time = 0.0
    steps = 0
    stalled = 0  # steps since the clock went on
    last = -1
    ended = False
    while not ended:
        steps += 1
        watched = n if m.tilt[0] != 0.0 else min(n, last + 2)
        # A block exactly at its limit may be released and stop at once, in turn. It is
        # held for a step.
        holds = stalled > MOST_STALLED * n
        h = end.duration - time
        if last >= 0:
            h = min(step[last], h)
        load_before = s.force[0]
        # The step stays in this loop: a function of its own makes a run four times as
        # long.
        pull = 0.0
        part, block = try_step(m, s, last, watched, h, holds)
        if block >= 0:
            # At its end: a block without weight is released by no force at all.
            pull = net_force(m, s.new_force, s.new_velocity, block)
            h *= part
            if h > 0.0:
                try_step(m, s, last, watched, h, holds)
        notable = block >= 0
        if h > 0.0:
            notable |= accept(m, s, last, h)
        if block >= 0:
            switch(m, s, block, pull)
            last = farthest(s.mode)
        stalled = 0 if time + h > time else stalled + 1
        time += h
        ended = time >= end.duration or s.force[0] > end.lifting_load
        if notable and note(m, s, results, watched, load_before, time, h):
            settled = period_of(results.peaks, SETTLED * total) > 0
            ended |= end.at_global_slip or (end.when_settled and settled)
        if abs(s.force[0] - results.points[-1][1]) > POINTS * total:
            results.points.append((time, s.force[0]))
        ended |= len(results.rows) - 1 > end.most or steps > end.most_steps
    results.points.append((time, s.force[0]))
    return np.array(results.rows)[1:], np.array(results.points), time, steps
