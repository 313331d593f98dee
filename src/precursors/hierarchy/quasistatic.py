r"""The quasi-static chain: slips are cascades from one state of rest to the next, without inertia or time.

The load grows until block 1 reaches its strength; then a set of blocks moves at once. With B the stiffness
matrix of the chain, g_i the net force of the springs on block i and s_i the direction of its slip, the blocks
S of the set would be in balance with kinetic friction after the displacements

    u* = B_SS^-1 (g - s mu_k w)_S,

and they move by (1 + overshoot) u*. A block at rest that this pushes beyond mu_s w joins the set, which then
moves anew from where it began. One that would move against its direction once it has joined is put out again,
and so are the last to join where they turn a block round that began the slip. When nobody joins, the blocks
stop. Those whose net force then exceeds mu_s w begin a further stage of the same event. Without time, "all
blocks at the same instant" has no meaning: a global slip is an event in which every block slides.

Two values of the overshoot have a meaning:

* overshoot = 1 ("quasistatic"). On the straight line through u*, the elastic energy set free equals the
  friction heat again at 2 u*: the set has lost nothing but that heat and has no kinetic energy left, so it
  stops there. Its net forces are mirrored about mu_k w. For one block this is the exact slip,
  2 (mu_s - mu_k) w / (k + K).
* overshoot = 0 ("overdamped"). All kinetic energy is lost on the way: the limit of a slip that is damped at
  every instant. Which set moves does not depend on the order in which blocks join it.

All compiled code is in this file, because a compile cache does not see an edit in an imported file.
"""

from __future__ import annotations

import numpy as np
import pandas as pd
from numba import njit

from precursors.analysis.slips import COLUMNS
from precursors.model.chain import Chain, not_negative, whole

ENERGY_CONSERVED, OVERDAMPED = 1.0, 0.0
MAX_EVENTS = 1_000_000
# Stages of one event, each with less elastic energy than the one before.
MAX_STAGES = 100_000
# Forces are known to rounding of the load: a block that far beyond its strength still rests.
ROUNDING = 1e-12
FIRST_ROOM = 256
PUT_OUT = -1
ONSET, MOVED_BEFORE, LOAD_AFTER, FRONT, SLID, AT_ONCE = range(6)

compiled = njit(cache=True, error_model="numpy")


def quasistatic_slips(
    chain: Chain, overshoot: float = ENERGY_CONSERVED, max_events: int = MAX_EVENTS
) -> pd.DataFrame:
    """Slip events of the quasi-static chain from rest to its first global slip, as a table of `find_slips`.

    An event ends when it begins; `n_simultaneous` is the largest set that moves.

    Parameters
    ----------
    chain : Chain
        The chain; every block has weight, and mu_k < mu_s.
    overshoot : float
        How far the blocks move beyond the balance with kinetic friction, from 0 (all kinetic energy is lost)
        to 1 (none is).
    max_events : int
        Cap on the number of events.

    Raises
    ------
    ValueError
        If the overshoot is not within 0..1, a block has no weight, or mu_s = mu_k.
    RuntimeError
        If the first global slip is not reached within the cap, or an event does not come to rest within
        MAX_STAGES stages.
    """
    overshoot = not_negative("overshoot", overshoot, "1")
    max_events = whole("max_events", max_events, at_least=1)
    if overshoot > 1.0:
        raise ValueError(f"overshoot must be between 0 and 1, but is {overshoot:g}")
    if chain.mu_s == chain.mu_k:
        raise ValueError(f"mu_k of a quasi-static chain must be below mu_s = {chain.mu_s:g}, but is equal")
    if not chain.weights.all():
        block = int(np.argmin(chain.weights)) + 1
        raise ValueError(f"every block of a quasi-static chain must have weight, but block {block} has 0 N")
    events, rests = run_cascades(
        np.append(chain.springs, 0.0),
        chain.strength,
        chain.kinetic_friction,
        overshoot,
        ROUNDING * chain.normal_load,
        max_events,
        MAX_STAGES,
    )
    if not rests:
        raise RuntimeError(
            f"event {len(events) + 1} does not come to rest within {MAX_STAGES} stages; "
            "a larger mu_s - mu_k helps"
        )
    if events[-1, SLID] < chain.n_blocks:
        raise RuntimeError(f"no global slip within {len(events)} events: raise max_events = {max_events}")
    time = (events[:, ONSET] / chain.drive_stiffness + events[:, MOVED_BEFORE]) / chain.drive_velocity
    whole_numbers = dict.fromkeys(["front", "n_slid", "n_simultaneous"], int)
    columns = [
        time,
        time,
        events[:, ONSET],
        events[:, LOAD_AFTER],
        events[:, FRONT],
        events[:, SLID],
        events[:, AT_ONCE],
        events[:, SLID] == chain.n_blocks,
    ]
    table = pd.DataFrame(np.column_stack(columns), columns=COLUMNS)
    return table.astype({**whole_numbers, "is_global": bool})


@compiled
def run_cascades(springs, strength, friction, overshoot, rounding, max_events, max_stages):
    """Events to the first global slip, a row each of ONSET .. AT_ONCE, and whether the last came to rest.

    The spring beyond block N is 0 N/m.
    """
    n = strength.shape[0]
    events = np.empty((FIRST_ROOM, 6))
    net, step, slip = np.zeros(n), np.zeros(n), np.zeros(n)
    direction, batch = np.zeros(n), np.zeros(n, np.int64)
    ratio, solved = np.empty(n), np.empty(n)
    load, moved = 0.0, 0.0
    for k in range(max_events):
        if k == events.shape[0]:
            events = np.concatenate((events, np.empty_like(events)))
        load += strength[0] - net[0]
        net[0] = strength[0]
        events[k, ONSET], events[k, MOVED_BEFORE] = load, moved
        slip[:] = 0.0
        direction[:] = 0.0
        direction[0] = 1.0
        at_once = 0
        for _ in range(max_stages):
            find_stage(
                springs, strength, friction, overshoot, rounding, net, direction, batch, step, ratio, solved
            )
            members = 0
            rests = True
            for i in range(n):
                slip[i] += step[i]
                net[i] -= lost_force(springs, step, i)
                members += direction[i] != 0.0
            for i in range(n):
                direction[i] = np.sign(net[i]) if abs(net[i]) > strength[i] + rounding else 0.0
                rests = rests and direction[i] == 0.0
            at_once = max(at_once, members)
            if rests:
                break
        else:
            return events[:k], False
        load -= springs[0] * slip[0]
        moved += slip[0]
        slid = np.flatnonzero(slip)
        events[k, LOAD_AFTER], events[k, FRONT] = load, slid[-1] + 1
        events[k, SLID], events[k, AT_ONCE] = len(slid), at_once
        if len(slid) == n:
            return events[: k + 1], True
    return events[:max_events], True


@compiled
def find_stage(springs, strength, friction, overshoot, rounding, net, direction, batch, step, ratio, solved):
    """Displacements `step` [m] of the set that `direction` begins, once no block joins or leaves it.

    `batch` is 0 for the blocks that begin, 1, 2, ... for those that join, and PUT_OUT for those that left.
    """
    n = net.shape[0]
    batch[:] = 0
    last = 0
    while True:
        balance(springs, friction, net, direction, step, ratio, solved)
        turned, joiner_turned = False, False
        for i in range(n):
            step[i] *= 1.0 + overshoot
            if step[i] * direction[i] < 0.0:
                turned = True
                joiner_turned = joiner_turned or batch[i] > 0
        if turned:
            undo = not joiner_turned and last > 0
            for i in range(n):
                against = step[i] * direction[i] < 0.0 and (batch[i] > 0 or not joiner_turned)
                if direction[i] != 0.0 and (batch[i] == last if undo else against):
                    direction[i], batch[i] = 0.0, PUT_OUT
            last -= undo
            continue
        last += 1
        joined = False
        for i in range(n):
            after = net[i] - lost_force(springs, step, i)
            if direction[i] == 0.0 and batch[i] != PUT_OUT and abs(after) > strength[i] + rounding:
                direction[i], batch[i] = np.sign(after), last
                joined = True
        if not joined:
            return


@compiled
def balance(springs, friction, net, direction, step, ratio, solved):
    """Displacements u* [m] that put the moving blocks in balance with friction (Thomas' algorithm)."""
    n = net.shape[0]
    for i in range(n):
        coupled = i > 0 and direction[i] != 0.0 and direction[i - 1] != 0.0
        behind = springs[i] if coupled else 0.0
        before = solved[i - 1] if coupled else 0.0
        ahead = ratio[i - 1] if coupled else 0.0
        pivot = springs[i] + springs[i + 1] - behind * ahead
        ratio[i] = springs[i + 1] / pivot
        force = net[i] - direction[i] * friction[i] if direction[i] != 0.0 else 0.0
        solved[i] = (force + behind * before) / pivot
    for i in range(n - 1, -1, -1):
        coupled = i + 1 < n and direction[i] != 0.0 and direction[i + 1] != 0.0
        step[i] = solved[i] + (ratio[i] * step[i + 1] if coupled else 0.0)


@compiled
def lost_force(springs, step, i):
    """Force [N] by which displacements [m] lower the net force of the springs on block i."""
    behind = step[i] - (step[i - 1] if i > 0 else 0.0)
    ahead = (step[i + 1] if i + 1 < step.shape[0] else 0.0) - step[i]
    return springs[i] * behind - springs[i + 1] * ahead
