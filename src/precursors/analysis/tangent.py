"""How small differences between two runs grow: the linearised motion, from transition to transition.

A state is z = (y, w), with y_i = f_i / sqrt(k_i) of the force in the spring behind block i and
w_i = sqrt(m) v_i of its velocity, both in sqrt(J): z.z / 2 is the energy. Eqs. 2-6 become

    dy/dt = d e_1 - S w,    dw_i/dt = (S^T y)_i - mode_i F_i   where block i slides, else w_i = 0,

with S_ii = sqrt(k_i / m), S_{i+1,i} = -sqrt(k_{i+1} / m), F_i = mu_k w_i / sqrt(m) and d = sqrt(K) V.

Two neighbouring runs are compared at the same transition, which they reach at different times. The states
then differ by the jump (saltation) matrix of non-smooth dynamics (Aizerman and Gantmakher 1958), the times by
a shift. Forces are compared and not positions: moving all blocks with the drive is no difference.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from precursors.model.chain import Chain, FloatArray
from precursors.solver.run import Run

IntArray = NDArray[np.int64]


class Modes(NamedTuple):
    """Normal modes of a row of sliding neighbours: S of the row is springs @ diag(frequency) @ blocks.T."""

    first: int
    last: int
    springs: FloatArray
    frequency: FloatArray
    blocks: FloatArray


class Motion:
    """The linear motion of a chain between transitions.

    Attributes
    ----------
    coupling : array, shape (N, N)
        S [rad/s].
    strength, friction : array, shape (N,)
        mu_s w / sqrt(m) and mu_k w / sqrt(m) [sqrt(J)/s].
    drive : float
        d, the rate at which the drive loads spring 1 [sqrt(J)/s].
    time_unit : float
        2 / (a bound of all frequencies) [s].
    """

    def __init__(self, chain: Chain) -> None:
        self.n_blocks = chain.n_blocks
        roots = np.sqrt(chain.springs / chain.mass)
        self.coupling = np.diag(roots) - np.diag(roots[1:], -1)
        self.strength = chain.strength / np.sqrt(chain.mass)
        self.friction = chain.kinetic_friction / np.sqrt(chain.mass)
        self.drive = float(np.sqrt(chain.drive_stiffness) * chain.drive_velocity)
        row_sums = abs(self.coupling.T @ self.coupling).sum(axis=1)
        self.time_unit = float(2.0 / np.sqrt(row_sums.max()))
        self._rows: dict[tuple[int, int], Modes] = {}
        self._modes: dict[bytes, list[Modes]] = {}

    def net_force(self, z: FloatArray) -> FloatArray:
        """Net force of the springs on each block over sqrt(m), of states (..., 2 N)."""
        return z[..., : self.n_blocks] @ self.coupling

    def rate(self, mode: IntArray, z: FloatArray) -> FloatArray:
        """dz/dt of states (..., 2 N) with modes (..., N)."""
        rate = self.derivative(mode, z)
        rate[..., 0] += self.drive
        rate[..., self.n_blocks :] -= mode * self.friction
        return rate

    def derivative(self, mode: IntArray, z: FloatArray) -> FloatArray:
        """The linear part of `rate`: what it is for a difference of states, or for a rate."""
        velocity = z[..., self.n_blocks :]
        return np.concatenate([-velocity @ self.coupling.T, (mode != 0) * self.net_force(z)], axis=-1)

    def after(
        self,
        mode: IntArray,
        z: FloatArray,
        span: FloatArray | float,
        friction: FloatArray,
        drive: float = 0.0,
    ) -> FloatArray:
        """States (2 N, columns) after `span` [s]: one state at many spans, or many states after one.

        In modes a = U^T y, b = W^T w the motion is da/dt = c - omega b, db/dt = omega a - p, a rotation about
        a = p / omega, b = c / omega. `friction` (N, columns) is F, or its difference.
        """
        n, span = self.n_blocks, np.atleast_1d(span)
        z = np.repeat(z, len(span), axis=1) if len(span) > 1 else z.copy()
        for first, last, springs, frequency, blocks in self.modes(mode):
            force, velocity = z[first : first + len(springs)], z[n + first : n + last + 1]
            loading = drive * springs[0][:, None] if first == 0 else np.zeros((len(frequency), 1))
            omega = frequency[:, None]
            push = blocks.T @ (mode[first : last + 1, None] * friction[first : last + 1])
            a = springs.T @ force - push / omega
            b = blocks.T @ velocity - loading / omega
            cosine, sine = np.cos(omega * span), np.sin(omega * span)
            force += springs @ ((cosine - 1.0) * a - sine * b - loading * span)
            velocity[:] = blocks @ (cosine * b + sine * a + loading / omega)
        z[0] += drive * span
        return z

    def modes(self, mode: IntArray) -> list[Modes]:
        """Normal modes of each row of neighbours that slide."""
        key = mode.tobytes()
        if key not in self._modes:
            ends = np.flatnonzero(np.diff(mode != 0, prepend=False, append=False)).tolist()
            self._modes[key] = [self._row(i, j - 1) for i, j in zip(ends[::2], ends[1::2], strict=True)]
        return self._modes[key]

    def _row(self, first: int, last: int) -> Modes:
        if (first, last) not in self._rows:
            part = self.coupling[first : last + 2, first : last + 1]
            springs, frequency, blocks = np.linalg.svd(part, full_matrices=False)
            self._rows[first, last] = Modes(first, last, springs, frequency, blocks.T)
        return self._rows[first, last]


@dataclass(frozen=True, eq=False)
class Trajectory:
    """What a run passed through.

    Attributes
    ----------
    n_started : int
        Transitions at time 0, of blocks that move from the start.
    span : array, shape (n + 1,)
        Interval before each transition, and to the end of the run [s].
    block, old : array, shape (n,)
        Block of each transition, counted from 0, and its mode before.
    mode : array, shape (n + 1, N)
        Modes before the first transition and after each.
    state : array, shape (n + 1, 2 N)
        State at time 0 and at each transition.
    rate : array, shape (n, 2 N)
        Rate of the state just before each transition.
    gradient : array, shape (n, 2 N)
        Gradient of each transition's event function: the speed of the block that stops, or the distance from
        its strength of the one that is released; positive before.
    slope, bend : array, shape (n,)
        First and second time derivative of that function.
    """

    n_started: int
    span: FloatArray
    block: IntArray
    old: IntArray
    mode: IntArray
    state: FloatArray
    rate: FloatArray
    gradient: FloatArray
    slope: FloatArray
    bend: FloatArray

    @classmethod
    def of(cls, run: Run, motion: Motion) -> Trajectory:
        """Collect modes, states and rates at the transitions of a run.

        Raises
        ------
        ValueError
            If the run has no stored states.
        """
        chain, time, n = run.chain, run.transitions["time"], len(run.transitions)
        block, new = run.transitions["block"].astype(np.int64) - 1, run.transitions["mode"].astype(np.int64)
        mode = np.zeros((n + 1, chain.n_blocks), np.int64)
        for k in range(n):
            mode[k + 1] = mode[k]
            mode[k + 1, block[k]] = new[k]
        forces, velocities = run.forces_and_velocities(np.append(0.0, time))
        state = np.hstack([forces / np.sqrt(chain.springs), velocities * np.sqrt(chain.mass)])
        old = mode[np.arange(n), block]
        speed = np.eye(chain.n_blocks)[block] * old[:, None]
        distance = -new[:, None] * motion.coupling.T[block] * (old == 0)[:, None]
        gradient = np.hstack([distance, speed])
        rate = motion.rate(mode[:-1], state[1:])
        slope = np.sum(gradient * rate, axis=1)
        bend = np.sum(gradient * motion.derivative(mode[:-1], rate), axis=1)
        n_started = int(np.count_nonzero((time == 0.0) & (run.intervals[:-1] == 0.0)))
        return cls(n_started, run.intervals, block, old, mode, state, rate, gradient, slope, bend)


class Tangent:
    """Differences of neighbouring runs from a run: states `z` (2 N, columns), carried along in place."""

    def __init__(self, run: Run) -> None:
        self.motion = Motion(run.chain)
        self.path = Trajectory.of(run, self.motion)

    def advance(self, k: int, z: FloatArray, strength: FloatArray, friction: FloatArray) -> FloatArray:
        """Carry differences to transition k; return the differences of the time it takes [s].

        `strength` and `friction` (N, columns) are the differences of static and kinetic friction.
        """
        z[:] = self.motion.after(self.path.mode[k], z, float(self.path.span[k]), friction)
        return self.meet(k, z, strength)

    def meet(self, k: int, z: FloatArray, strength: FloatArray) -> FloatArray:
        """Shift differences at the same time to those at each run's own transition k; return the shifts."""
        path, block = self.path, self.path.block[k]
        value = path.gradient[k] @ z
        if path.old[k] == 0:
            value = value + strength[block]
        with np.errstate(divide="ignore", invalid="ignore"):
            shift = -value / path.slope[k]
            z += path.rate[k][:, None] * shift
        if path.old[k]:
            z[self.motion.n_blocks + block] = 0.0
        return shift

    def size(self, row: int, z: FloatArray) -> float:
        """Norm of differences [sqrt(J)] without their part along the motion; root mean square."""
        flow = self.motion.rate(self.path.mode[row], self.path.state[row])
        along = flow @ z
        rest = np.sum(z**2) - along @ along / max(float(flow @ flow), float(np.finfo(float).tiny))
        return float(np.sqrt(max(rest, 0.0) / z.shape[1]))
