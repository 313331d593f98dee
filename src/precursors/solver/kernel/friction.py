"""Coulomb's law (Eqs. 4-6): modes of blocks, what follows from them, and which one a block at rest takes."""

from __future__ import annotations

from precursors.solver.kernel.compiled import inner, seldom, unfused
from precursors.solver.kernel.layout import ROUNDINGS
from precursors.solver.kernel.roots import zero_below


@inner
def set_mode(i, new, chain, motion):
    """Apply a transition: a block that stops or turns has velocity zero."""
    if motion.mode[i] != 0:
        motion.velocity[i] = 0.0
    motion.mode[i] = new
    take_mode(i, chain, motion)
    for j in range(max(i - 1, 1), min(i + 1, chain.n_blocks) + 1):
        take_neighbours(j, chain, motion)


@inner
def take_mode(i, chain, motion):
    """Set what follows from the mode of block i."""
    mode = motion.mode[i]
    motion.slides[i] = 1.0 if mode != 0 else 0.0
    motion.sign[i] = mode
    motion.push[i] = mode * chain.friction[i]
    motion.hold[i] = 0.0 if mode != 0 else chain.strength[i]


@inner
def take_neighbours(i, chain, motion):
    """Set whether the function watched of block i changes: it or a neighbour of it moves."""
    slides, coupling = motion.slides, chain.coupling
    moved = slides[i] + coupling[i] * slides[i - 1] + coupling[i + 1] * slides[i + 1]
    motion.felt[i] = 1.0 if moved > 0.0 else 0.0


@inner
def resting_mode(i, roundings, chain, motion):
    """Mode of a block whose velocity is zero: it sticks within its strength, or follows the force (Eq. 5).

    A block that sticks at the limit lets go at once where its force grows: its margin decides, not rounding.
    """
    net = motion.net_force[i]
    if abs(net) <= chain.strength[i] + zero_below(i, roundings, chain, motion):
        return 0
    return 1 if net > 0.0 else -1


@seldom
def farthest_sliding(start, mode):
    """Farthest block that slides, if none of those beyond `start` does; 1 where none slides."""
    i = start
    while i > 1 and mode[i] == 0:
        i -= 1
    return i


@unfused
def at_start(positions, velocities, parameters, chain, motion):
    """Fill velocities, spring forces and modes at time 0, in the kernel's units and columns.

    A block that moves slides; one at rest slides where its springs overcome the static friction (Eq. 5).
    """
    mass, stiffness, drive_stiffness, _, _, _ = parameters
    strength, velocity, force, mode = chain.strength, motion.velocity, motion.spring_force, motion.mode
    stiffest, farthest, before = drive_stiffness, 0.0, 0.0
    for i in range(chain.n_blocks):
        spring = stiffness if i > 0 else drive_stiffness
        stiffest = max(stiffest, spring)
        farthest = max(farthest, abs(positions[i]))
        force[i + 1] = -spring * (positions[i] - before)
        before = positions[i]
        velocity[i + 1] = velocities[i] * (mass / chain.tau)
    for i in range(1, chain.n_blocks + 1):
        # A position of size x is known to its rounding: a block at its limit to within that still sticks.
        rounding = ROUNDINGS * (strength[i] + 4.0 * stiffest * farthest)
        net = force[i] - force[i + 1]
        moves = velocity[i] if velocity[i] != 0.0 else net
        if velocity[i] == 0.0 and abs(moves) <= strength[i] + rounding:
            mode[i] = 0
        else:
            mode[i] = 1 if moves > 0.0 else -1
