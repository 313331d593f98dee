"""Coulomb's law (Eqs. 4-6): modes of blocks, what follows from them, and which one a block at rest takes."""

from __future__ import annotations

from precursors.solver.kernel.bounds import grain
from precursors.solver.kernel.compiled import index, inner, seldom, unfused
from precursors.solver.kernel.layout import ROUNDINGS
from precursors.solver.kernel.springs import net_force


@inner
def set_mode(i, new, chain, additions, state, motion):
    """Apply a transition to the state in row 0: a block that stops or turns has velocity zero."""
    mode, rate = state.mode, motion.rate
    if mode[i] != 0:
        rate[0, i] = 0.0
    mode[i] = new
    if additions is not None and additions.anchor[i] > 0.0:
        # A block that begins to stick is attached where no net force acts on it.
        additions.grip[i] = net_force(i, state.tension, rate, additions) if new == 0 else 0.0
    take_mode(i, mode, chain, additions, motion)


@inner
def take_mode(i, mode, chain, additions, motion):
    """Set what follows from the mode of block i, and from the force of its interface spring if it sticks."""
    friction, lightness = chain.friction, chain.lightness
    mobile, sense, push = motion.mobile, motion.sense, motion.push
    mobile[i] = lightness[i] if mode[i] != 0 else 0.0
    sense[i] = mode[i]
    push[i] = mode[i] * friction[i] * lightness[i]
    if additions is not None and additions.anchor[i] > 0.0:
        mobile[i] = lightness[i]
        additions.hold[i] = lightness[i] * additions.anchor[i] if mode[i] == 0 else 0.0
        if mode[i] == 0:
            push[i] = lightness[i] * additions.grip[i]


@inner
def resting_mode(i, doubt, chain, additions, tension, motion):
    """Mode of a block whose velocity is zero: it sticks within its strength, or follows the force.

    A block that sticks at the limit lets go at once where its force grows: its margin decides, not rounding.
    """
    rate = motion.rate
    net = tension[i] - tension[i + 1]
    if additions is not None:
        net += additions.dashpot[i] * rate[0, i - 1] + additions.dashpot[i + 1] * rate[0, i + 1]
    if abs(net) <= chain.strength[i] + grain(index(i), doubt, chain, additions, tension, motion.fastest):
        return 0
    return 1 if net > 0.0 else -1


@seldom
def farthest_sliding(start, mode):
    """Farthest block that slides, none of those beyond `start` doing so; 1 where none does."""
    i = start
    while i > 1 and mode[i] == 0:
        i -= 1
    return i


@unfused
def start_from(positions, velocities, parameters, tau, chain, additions, state):
    """Fill velocities, spring forces and modes at time 0, in the kernel's units and columns.

    A block that moves slides; one at rest slides where its springs overcome the static friction (Eq. 5).
    """
    mass, stiffness, drive_stiffness = parameters[0], parameters[1], parameters[2]
    strength, (velocity, tension, mode) = chain.strength, state
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
