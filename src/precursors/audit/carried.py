"""The state that the audit carries through a run, and how far rounding has moved it."""

import math
from functools import lru_cache, partial

import numpy as np
from numpy.typing import NDArray

from precursors.audit.motion import ModalMotion, modes_of_all, normal_modes
from precursors.model.chain import FREE, FloatArray
from precursors.solver.run import Run

_UNIT = 2.0**-53  # a rounding, relative
_START_ROUNDINGS = 8
_MEMORY = 2e8  # bytes for normal modes


class CarriedState:
    """Modes, velocities and spring forces (not positions) of a chain.

    Solver and audit carry spring forces f and velocities v in doubles. Each step rounds
    them by some units of 2^-53 of the largest they can be, in the norm sum f_i^2/k_i +
    m v_i^2, twice the energy. A step is a transition or a radian of the fastest motion,
    and the drive counts as a mass that moves. In this norm the difference of two
    motions with the same transitions does not grow: free motion conserves it, and a
    stop reduces it. So roundings add up: those of an interval one by one, as they may
    all go the same way, those of different intervals as squares. One rounding a step
    comes to `rounding` [sqrt(J)], which is `velocity_rounding` [m/s] of a velocity and
    `force_rounding` [N] of the net force on each block.
    """

    def __init__(self, run: Run) -> None:
        chain = run.chain
        positions = run.start_positions
        self.chain = chain
        self.springs = chain.springs
        self.strength = chain.strength
        self.friction = chain.kinetic_friction
        self.mode = np.where(chain.weights > 0.0, 0, FREE)
        self.velocity = run.start_velocities.copy()
        # the force of the spring behind each block, and a zero ahead of block N
        stretch = -np.diff(positions, prepend=0.0)
        self.spring_force = np.append(self.springs * stretch, 0.0)
        # Forces at the start are differences of positions, which are known to their
        # rounding.
        ends = positions**2 + np.append(0.0, positions[:-1]) ** 2
        at_start = _START_ROUNDINGS * math.sqrt(self.springs @ ends)
        self.drive_momentum = math.sqrt(chain.mass) * chain.drive_velocity
        self.rounding = _UNIT * math.hypot(at_start, self.drive_momentum)
        self.per_force = np.sqrt(self.springs)
        self.per_load = self.per_force[0]
        self.per_force[:-1] += np.sqrt(self.springs[1:])
        self.fastest = 2 * math.sqrt(self.springs.max() / chain.mass)
        room = max(32, int(_MEMORY // (16 * chain.n_blocks**2)))
        self.modes_of_row = lru_cache(room)(partial(normal_modes, chain))

    @property
    def force_rounding(self) -> FloatArray:
        """One rounding of the net force on each block [N], shape (N,)."""
        return self.rounding * self.per_force

    @property
    def velocity_rounding(self) -> float:
        """One rounding of a velocity [m/s]."""
        return self.rounding / math.sqrt(self.chain.mass)

    def net_force(self) -> FloatArray:
        """Force of the springs and the drive on each block [N], shape (N,) (Eqs.
        2-4)."""
        return self.spring_force[:-1] - self.spring_force[1:]

    def moves(self) -> NDArray[np.bool_]:
        """Which blocks move, shape (N,): those without load too, unless all is at rest."""
        moves = self.mode != 0
        pushed = (self.velocity != 0.0) | (self.net_force() != 0.0)
        pushed[0] = True
        return moves & ((abs(self.mode) == 1) | (moves & pushed)).any()

    def energy(self) -> float:
        """Kinetic energy of the blocks and elastic energy of the springs [J]."""
        kinetic = 0.5 * self.chain.mass * (self.velocity @ self.velocity)
        elastic = 0.5 * (self.spring_force[:-1] ** 2 @ (1 / self.springs))
        return float(kinetic + elastic)

    def motion(self) -> ModalMotion:
        """Motion of the blocks that slide."""
        slides = self.moves()
        modes = modes_of_all(slides, self.modes_of_row)
        force = (self.net_force() - self.mode * self.friction)[slides]
        # The drive loads block 1 only.
        loads_first = modes.shapes[0] if slides[0] else np.zeros(len(force))
        return ModalMotion(
            modes=modes,
            speed=self.velocity[slides] @ modes.shapes,
            push=force @ modes.shapes / self.chain.mass,
            ramp=self.chain.loading_rate / self.chain.mass * loads_first,
        )

    def advance(self, motion: ModalMotion, duration: float) -> None:
        """Move to the end of an interval; add up roundings."""
        before = self.energy()
        slides = self.moves()
        (displacement,), (velocity,), _ = motion.at(np.array([duration]))
        self.velocity[slides] = motion.modes.shapes @ velocity
        self.spring_force[0] += self.chain.loading_rate * duration
        self.spring_force -= motion.modes.spring_shapes @ displacement
        steps = 1 + self.fastest * duration if motion.speed.size else 1
        momentum = math.sqrt(self.chain.mass) * motion.largest_speed()
        size = math.sqrt(2 * max(before, self.energy())) + momentum
        self.rounding = math.hypot(
            self.rounding, _UNIT * steps * (size + self.drive_momentum)
        )
