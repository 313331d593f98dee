"""Coulomb's law (Eqs. 4-6): modes of blocks, what follows from them, and which one a
block at rest takes."""

from precursors.model.chain import FREE
from precursors.solver.kernel.decorators import inner, seldom


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
    """Set whether the function watched of block i changes: it or a neighbour of it
    moves. A block without load has none."""
    slides = motion.slides
    coupling = chain.coupling
    moved = slides[i] + coupling[i] * slides[i - 1] + coupling[i + 1] * slides[i + 1]
    motion.felt[i] = 1.0 if moved > 0.0 and motion.mode[i] != FREE else 0.0


@inner
def mode_at_rest(force, limit):
    """Mode of a block whose velocity is zero: it sticks within its limit, or follows
    the force (Eq. 5)."""
    if abs(force) <= limit:
        return 0
    return 1 if force > 0.0 else -1


@seldom
def is_at_rest(chain, motion):
    """Whether nothing moves but the drive: all blocks stick, or bear no load and were
    never pushed."""
    force = motion.spring_force
    rest = motion.force_rest
    for i in range(1, chain.n_blocks + 1):
        is_pushed = force[i] != force[i + 1] or rest[i] != rest[i + 1]
        is_moved = motion.velocity[i] != 0.0 or is_pushed or i == 1
        if abs(motion.mode[i]) == 1 or (motion.mode[i] == FREE and is_moved):
            return False
    return True


@seldom
def farthest_sliding(start, mode):
    """Farthest block that slides, if none of those beyond `start` does; 1 where none
    slides."""
    i = start
    while i > 1 and mode[i] == 0:
        i -= 1
    return i
