"""Coulomb's law (Eqs. 4-6): the modes of blocks, and the rows that follow from them."""

from precursors.model.chain import FREE
from precursors.solver.kernel.arrays import (
    COUPLING,
    FELT,
    FORCE_REST,
    FRICTION,
    HOLD,
    MODE,
    PUSH,
    SIGN,
    SLIDES,
    SPRING_FORCE,
    STRENGTH,
    VELOCITY,
)
from precursors.solver.kernel.decorators import inner, seldom


@inner
def set_mode(i, new, chain, motion):
    """Apply a transition: a block that stops or turns has velocity zero."""
    if motion[MODE, i] != 0:
        motion[VELOCITY, i] = 0.0
    motion[MODE, i] = new
    take_mode(i, motion)
    for j in range(max(i - 1, 1), min(i + 1, chain.n_blocks) + 1):
        take_neighbours(j, motion)


@inner
def take_mode(i, motion):
    """Set the rows that follow from the mode of block i."""
    mode = motion[MODE, i]
    motion[SLIDES, i] = 1.0 if mode != 0 else 0.0
    motion[SIGN, i] = mode
    motion[PUSH, i] = mode * motion[FRICTION, i]
    motion[HOLD, i] = 0.0 if mode != 0 else motion[STRENGTH, i]


@inner
def take_neighbours(i, motion):
    """Set whether block i or a neighbour moves, so that its event function changes.

    A block without load has no event function.
    """
    behind = motion[COUPLING, i] * motion[SLIDES, i - 1]
    ahead = motion[COUPLING, i + 1] * motion[SLIDES, i + 1]
    moved = motion[SLIDES, i] + behind + ahead
    motion[FELT, i] = 1.0 if moved > 0.0 and motion[MODE, i] != FREE else 0.0


@inner
def mode_at_rest(force, limit):
    """Return the mode of a block with zero velocity.

    It sticks within its limit, and slides in the direction of the force otherwise (Eq.
    5).
    """
    if abs(force) <= limit:
        return 0
    return 1 if force > 0.0 else -1


@seldom
def is_at_rest(chain, motion):
    """Whether nothing moves but the drive (see `plain.is_at_rest`)."""
    for i in range(1, chain.n_blocks + 1):
        is_pushed = (
            motion[SPRING_FORCE, i] != motion[SPRING_FORCE, i + 1]
            or motion[FORCE_REST, i] != motion[FORCE_REST, i + 1]
        )
        is_moved = motion[VELOCITY, i] != 0.0 or is_pushed or i == 1
        if abs(motion[MODE, i]) == 1 or (motion[MODE, i] == FREE and is_moved):
            return False
    return True


@inner
def farthest_sliding(start, motion):
    """Return the farthest block that slides, or 1; none beyond `start` may slide."""
    i = start
    while i > 1 and motion[MODE, i] == 0:
        i -= 1
    return i
