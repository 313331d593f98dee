"""The quasi-static chain: slips are cascades from one state of rest to the next,
without inertia or time.

The load grows until block 1 reaches its limit mu_s w_1. Then a set of blocks moves at
once. B is the stiffness matrix of the chain, g_i the net force of the springs on block i,
and s_i the direction of its slip. The blocks S of the set would be in balance with
kinetic friction after the displacements

    u* = B_SS^-1 (g - s mu_k w)_S,

and they move by (1 + overshoot) u*. A resting block that this loads beyond mu_s w joins
the set, and the motion of the larger set is computed again from its start. A block that
would move against its direction leaves the set for good: first those that joined it, and
if there are none, those that began the slip. When no block joins, all stop. Blocks whose
net force then exceeds mu_s w begin a further stage of the same event. Instants have no
meaning without time, so a global slip is here an event in which every block slides.

Two values of the overshoot have a physical meaning:

* overshoot = 1 ("quasistatic"). On the straight line through u*, the released elastic
  energy equals the friction heat again at 2 u*. There the set has no kinetic energy
  left, so it stops, and its net forces are mirrored about mu_k w. For one block this is
  the exact slip, 2 (mu_s - mu_k) w / (k + K).
* overshoot = 0 ("overdamped"). All kinetic energy is lost on the way: the limit of
  strong damping. The moving set does not depend on the order in which blocks join it.
"""

import math
from enum import IntEnum
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from precursors.analysis.slips import SLIP, Slip, rows_of
from precursors.model.chain import Chain, FloatArray
from precursors.support.compiled import entry

ENERGY_CONSERVED = 1.0
OVERDAMPED = 0.0
MAX_EVENTS = 1_000_000
MAX_STAGES = 100_000  # of one event; each stage lowers the elastic energy
ROUNDING = 1e-12  # of F_Z; a block this far beyond its limit still rests

compiled = entry(Path(__file__), error_model="numpy")


class Part(IntEnum):
    """A block's part in a stage; of blocks that turn round, those with the highest part
    leave first."""

    BEGAN = 0
    JOINED = 1
    LEFT = 2


class Cascade(NamedTuple):
    """The parameters of a chain, for compiled functions."""

    springs: FloatArray
    limit: FloatArray  # force beyond which a block does not rest [N]
    friction: FloatArray
    reach: float  # 1 + overshoot


def quasistatic_slips(
    chain: Chain, overshoot: float = ENERGY_CONSERVED
) -> NDArray[np.void]:
    """Slip events of the quasi-static chain from rest to its first global slip, in the
    format of `slip_rows`.

    Events have no duration; `n_simultaneous` is the size of the largest set that moves.
    `overshoot` is how far the blocks move beyond the balance with kinetic friction,
    from 0 (all kinetic energy is lost) to 1 (none is lost).

    Raises
    ------
    ValueError
        If a block has no weight, or mu_s = mu_k.
    RuntimeError
        If the first global slip is not reached within MAX_EVENTS, or an event does not
        come to rest within MAX_STAGES stages.
    """
    if chain.mu_s == chain.mu_k:
        raise ValueError(
            f"mu_k of a quasi-static chain must be below mu_s = {chain.mu_s:g}, but is equal"
        )
    if not chain.weights.all():
        block = int(np.argmin(chain.weights)) + 1
        raise ValueError(
            f"every block of a quasi-static chain must have weight, but block {block} has 0 N"
        )
    limit = chain.strength + ROUNDING * chain.normal_load
    numbers = Cascade(chain.springs, limit, chain.kinetic_friction, 1.0 + overshoot)
    strength = float(chain.strength[0])
    stiffness = chain.drive_stiffness
    n = chain.n_blocks
    net = np.zeros(n)
    load = largest = 0.0
    moved = 0.0
    slips: list[Slip] = []
    for event in range(1, MAX_EVENTS + 1):
        load += strength - net[0]
        net[0] = strength
        slip, at_once = slip_of_event(numbers, net, MAX_STAGES)
        if not at_once:
            raise RuntimeError(
                f"event {event} does not come to rest within {MAX_STAGES} stages; a larger mu_s - mu_k helps"
            )
        time = (load / stiffness + moved) / chain.drive_velocity
        before = load
        largest = max(largest, load)
        load -= stiffness * slip[0]
        moved += slip[0]
        slid = np.flatnonzero(slip)
        slips.append(
            Slip(
                onset_s=time,
                end_s=time,
                load_before_N=before,
                load_after_N=load,
                largest_load_N=largest,
                front=slid[-1] + 1,
                n_slid=len(slid),
                n_simultaneous=at_once,
                is_global=len(slid) == n,
            )
        )
        if slips[-1].is_global:
            return rows_of(np.array(slips, SLIP), chain)
    raise RuntimeError(f"no global slip within {MAX_EVENTS} events")


@compiled
def slip_of_event(cascade, net, max_stages):
    """Displacements [m] of one event that block 1 begins, and the size of the largest
    set that moves at once, or 0 if the event does not come to rest.

    `net` [N] is updated to the net forces after the event.
    """
    at_once = 0
    slip = np.zeros_like(net)
    direction = np.zeros_like(net)
    direction[0] = 1.0
    for _ in range(max_stages):
        step = slip_of_stage(cascade, net, direction)
        lost = lost_force(cascade.springs, step)
        at_once = max(at_once, int(np.count_nonzero(direction)))
        for i in range(len(net)):
            slip[i] += step[i]
            net[i] -= lost[i]
            direction[i] = beyond_strength(cascade, net[i], i)
        if not direction.any():
            return slip, at_once
    return slip, 0


@compiled
def beyond_strength(cascade, net, i):
    """Direction in which a net force [N] moves block i, or 0 if static friction holds
    the block."""
    return math.copysign(1.0, net) if abs(net) > cascade.limit[i] else 0.0


@compiled
def slip_of_stage(cascade, net, direction):
    """Displacements [m] of one stage: the set of blocks in `direction` moves, after
    blocks have joined and left it."""
    n = net.shape[0]
    part = np.zeros(n, np.int64)
    while True:
        step = balance(cascade, net, direction)
        leaves = -1  # the highest part of the blocks that turn round
        for i in range(n):
            step[i] *= cascade.reach
            if step[i] * direction[i] < 0.0:
                leaves = max(leaves, part[i])
        if leaves >= 0:
            for i in range(n):
                if step[i] * direction[i] < 0.0 and part[i] == leaves:
                    direction[i] = 0.0
                    part[i] = Part.LEFT
            continue
        lost = lost_force(cascade.springs, step)
        joins = False
        for i in range(n):
            if direction[i] == 0.0 and part[i] != Part.LEFT:
                direction[i] = beyond_strength(cascade, net[i] - lost[i], i)
                if direction[i] != 0.0:
                    part[i] = Part.JOINED
                    joins = True
        if not joins:
            return step


@compiled
def balance(cascade, net, direction):
    """Displacements u* [m] after which the moving blocks are in balance with kinetic
    friction (Thomas algorithm)."""
    n = net.shape[0]
    ratio = np.zeros(n)
    solved = np.zeros(n)
    step = np.zeros(n)
    for i in range(n):
        if direction[i] != 0.0:
            behind = cascade.springs[i]
            ahead = cascade.springs[i + 1] if i + 1 < n else 0.0
            # For a resting block, ratio and solution stay 0.
            pivot = behind + ahead - (behind * ratio[i - 1] if i > 0 else 0.0)
            force = net[i] - direction[i] * cascade.friction[i]
            solved[i] = (force + (behind * solved[i - 1] if i > 0 else 0.0)) / pivot
            ratio[i] = ahead / pivot
    for i in range(n - 1, -1, -1):
        step[i] = solved[i] + (ratio[i] * step[i + 1] if i + 1 < n else 0.0)
    return step


@compiled
def lost_force(springs, step):
    """Decrease of the springs' net forces on the blocks [N] by displacements [m]."""
    lost = np.empty_like(step)
    ahead = 0.0
    for i in range(step.shape[0] - 1, -1, -1):
        behind = springs[i] * step[i] - (springs[i] * step[i - 1] if i > 0 else 0.0)
        lost[i] = behind - ahead
        ahead = behind
    return lost
