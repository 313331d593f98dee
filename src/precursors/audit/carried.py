"""The state of a chain during an audit, and a bound of its rounding error."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from precursors.audit.motion import ModalMotion, at, inner, largest_speed
from precursors.model.chain import FREE, FloatArray
from precursors.solver.record import IntArray
from precursors.solver.run import Run

_UNIT = 2.0**-53  # largest relative error of a rounding
_START_ROUNDINGS = 8


class CarriedState(NamedTuple):
    """Modes, velocities and spring forces (not positions) of a chain.

    Solver and audit carry spring forces f and velocities v in doubles. Each step rounds
    them by some units of 2^-53 of their largest possible size, in the norm whose square
    is sum f_i^2/k_i + m v_i^2, twice the energy. A step is a transition or a radian of
    the fastest motion, and the drive counts as a moving mass. In this norm the
    difference of two motions with the same transitions does not grow: free motion
    conserves it, and a stop reduces it. Rounding errors therefore add up. Those of one
    interval are summed, since they may have the same sign; those of different intervals
    are summed as squares. The sum for one rounding per step is `rounding` [sqrt(J)].
    `rounding` over sqrt(m) is the error of a velocity [m/s], and `rounding` times
    `per_force` is the error of the net force on each block [N].
    """

    mode: IntArray
    velocity: FloatArray
    spring_force: FloatArray  # of the spring behind each block, and 0 ahead of block N
    rounding: FloatArray  # one number
    springs: FloatArray
    strength: FloatArray
    friction: FloatArray
    per_force: FloatArray
    mass: float
    loading_rate: float
    drive_momentum: float

    def net_force(self) -> FloatArray:
        """Return the force of the springs and the drive on each block [N], shape (N,)
        (Eqs. 2-4)."""
        return self.spring_force[:-1] - self.spring_force[1:]

    def moves(self) -> NDArray[np.bool_]:
        """Which blocks move, shape (N,), including those without load unless all blocks
        are at rest."""
        moves = self.mode != 0
        if (abs(self.mode) == 1).any():
            return moves
        pushed = (self.velocity != 0.0) | (self.net_force() != 0.0)
        pushed[0] = True
        return moves & (moves & pushed).any()


def start_of(run: Run) -> CarriedState:
    """Return the state at the start of a run."""
    chain = run.chain
    positions = run.start_positions
    stretch = -np.diff(positions, prepend=0.0)
    # Forces at the start are differences of rounded positions; velocities are rounded,
    # too.
    ends = positions**2 + np.append(0.0, positions[:-1]) ** 2
    at_start = _START_ROUNDINGS * math.sqrt(chain.springs @ ends)
    momentum = math.sqrt(chain.mass) * np.linalg.norm(run.start_velocities)
    drive_momentum = math.sqrt(chain.mass) * chain.drive_velocity
    per_force = np.sqrt(chain.springs)
    per_force[:-1] += np.sqrt(chain.springs[1:])
    return CarriedState(
        mode=np.where(chain.weights > 0.0, 0, FREE),
        velocity=np.array(run.start_velocities),
        spring_force=np.append(chain.springs * stretch, 0.0),
        rounding=np.array([_UNIT * math.hypot(at_start, momentum, drive_momentum)]),
        springs=chain.springs,
        strength=chain.strength,
        friction=chain.kinetic_friction,
        per_force=per_force,
        mass=chain.mass,
        loading_rate=chain.loading_rate,
        drive_momentum=drive_momentum,
    )


@inner
def energy(state):
    """Return the kinetic energy of the blocks plus the elastic energy of the springs
    [J]."""
    twice = 0.0
    for i in range(len(state.velocity)):
        elastic = state.spring_force[i] ** 2 / state.springs[i]
        twice += state.mass * state.velocity[i] ** 2 + elastic
    return 0.5 * twice


@inner
def motion_of(state, rows, modes):
    """Return the modal motion of the blocks that move."""
    n = len(modes.frequencies)
    motion = ModalMotion(modes.frequencies, np.zeros(n), np.zeros(n), np.zeros(n))
    j = 0
    k = 0
    for first, end in rows:
        for _ in range(first, end):
            for i in range(first, end):
                force = state.spring_force[i] - state.spring_force[i + 1]
                force -= state.mode[i] * state.friction[i]
                motion.speed[j] += state.velocity[i] * modes.shapes[k]
                motion.push[j] += force / state.mass * modes.shapes[k]
                if i == 0:  # the drive loads block 1 only
                    motion.ramp[j] = state.loading_rate / state.mass * modes.shapes[k]
                k += 1
            j += 1
    return motion


@inner
def advance(state, rows, modes, motion, duration):
    """Move the state to the end of an interval, and add its rounding errors."""
    before = energy(state)
    fallen = np.zeros(len(state.spring_force))
    fallen[0] = -state.loading_rate * duration
    j = 0
    k = 0
    for first, end in rows:
        state.velocity[first:end] = 0.0
        for _ in range(first, end):
            displacement, velocity, _ = at(motion, j, duration)
            for i in range(first, end):
                state.velocity[i] += modes.shapes[k] * velocity
                fallen[i] += modes.spring_shapes[k + j] * displacement
                k += 1
            fallen[end] += modes.spring_shapes[k + j] * displacement
            j += 1
    state.spring_force[:] -= fallen
    steps = 1.0
    if j:
        steps += 2 * math.sqrt(state.springs.max() / state.mass) * duration
    momentum = math.sqrt(state.mass) * largest_speed(motion)
    size = math.sqrt(2 * max(before, energy(state))) + momentum
    state.rounding[0] = math.hypot(
        state.rounding[0], _UNIT * steps * (size + state.drive_momentum)
    )
