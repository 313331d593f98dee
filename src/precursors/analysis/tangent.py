"""How small differences between two runs grow: the linearised motion, carried from transition to transition.

Two neighbouring runs are compared each at its own transitions: state with state, and clock with clock. So a
difference is continuous where the right-hand side jumps; the jump matrix of non-smooth dynamics (Aizerman and
Gantmakher 1958, "saltation") is contained in it, and a mere shift in time, which neither grows nor decays, is
in the clock alone. Forces, not positions, are compared: moving all blocks with the drive is no difference.

Units are those of `kernel`: forces in N, time in tau, velocities in N/tau. A state is one vector, of spring
forces (columns 0..N+1 of the kernel) and then of velocities; differences have a column per neighbouring run.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from precursors.model.chain import FloatArray, require_plain
from precursors.solver.kernel import System
from precursors.solver.run import Run

IntArray = NDArray[np.int64]


class Trajectory(NamedTuple):
    """What a run passed through.

    Attributes
    ----------
    n_started : int
        Transitions at time 0, of blocks that move from the start.
    span : array, shape (n,)
        Interval before each transition [tau].
    block, old, new : array, shape (n,)
        Block 1..N of each transition, its mode before and after.
    mode : array, shape (n + 1, N)
        Modes before the first transition and after each.
    state : array, shape (n + 1, 2 N + 4)
        State at time 0 and at each transition.
    rate : array, shape (n, 2 N + 4)
        Rate of the state just before each transition.
    slope, bend : array, shape (n,)
        First and second derivative of the gauge of each transition: the speed of the block that stops, or the
        margin of the one that lets go, positive before.
    """

    n_started: int
    span: FloatArray
    block: IntArray
    old: IntArray
    new: IntArray
    mode: IntArray
    state: FloatArray
    rate: FloatArray
    slope: FloatArray
    bend: FloatArray


def trajectory_of(run: Run, system: System) -> Trajectory:
    """Collect modes, states and rates at the transitions of a run.

    Raises
    ------
    ValueError
        If the run has no stored states, or its chain has viscosity, interface springs or a head.
    """
    require_plain(run.chain)
    transitions, n, n_blocks = run.transitions, len(run.transitions), run.chain.n_blocks
    block, new = transitions["block"].astype(np.int64), transitions["mode"].astype(np.int64)
    mode = np.zeros((n + 1, n_blocks), np.int64)
    for k in range(n):
        mode[k + 1] = mode[k]
        mode[k + 1, block[k] - 1] = new[k]
    row = np.arange(n)
    old = mode[row, block - 1]
    state = states_at(run, system, np.append(0.0, transitions["time"]))
    rate = rates(system, mode[:-1], state[1:])
    bend = rates(system, mode[:-1], rate, 0.0)
    stops = n_blocks + 2 + block

    def derivative(x: FloatArray) -> FloatArray:
        return np.where(old != 0, old * x[row, stops], -new * (x[row, block] - x[row, block + 1]))

    moving = np.count_nonzero((transitions["time"] == 0.0) & (run.intervals[:-1] == 0.0))
    span = run.intervals[:-1] / system.tau
    return Trajectory(
        int(moving), span, block, old, new, mode, state, rate, derivative(rate), derivative(bend)
    )


def states_at(run: Run, system: System, times: FloatArray) -> FloatArray:
    """States at some times [s], (len(times), 2 N + 4)."""
    n_blocks = run.chain.n_blocks
    state = np.zeros((len(times), 2 * n_blocks + 4))
    state[:, 1 : n_blocks + 1], velocities = run.forces_and_velocities(times)
    state[:, n_blocks + 3 : -1] = velocities * (run.chain.mass / system.tau)
    state[:, n_blocks + 2] = system.drive_velocity
    return state


def rates(
    system: System, mode: IntArray, state: FloatArray, friction: FloatArray | float | None = None
) -> FloatArray:
    """Rates of states (..., 2 N + 4) with modes (..., N) (Eqs. 2-4); `friction` is the kinetic by default."""
    n_blocks = mode.shape[-1]
    force, velocity = np.split(state, 2, axis=-1)
    if friction is None:
        friction = system.friction[1 : n_blocks + 1]
    rate = np.zeros_like(state)
    rate[..., 1 : n_blocks + 1] = system.coupling[1 : n_blocks + 1] * (
        velocity[..., :-2] - velocity[..., 1:-1]
    )
    rate[..., n_blocks + 3 : -1] = (mode != 0) * (force[..., 1:-1] - force[..., 2:] - mode * friction)
    return rate


class Modes(NamedTuple):
    """Normal modes of a row of neighbours that slide: of its springs, its blocks, and their frequencies."""

    springs: FloatArray
    blocks: FloatArray
    frequency: FloatArray
    root: FloatArray


class Tangent:
    """The linearised motion about a path."""

    def __init__(self, system: System, path: Trajectory) -> None:
        self.system, self.path = system, path
        self.n_blocks = path.mode.shape[1]
        self._modes: dict[tuple[int, int], Modes] = {}
        self._rows_of: dict[bytes, list[tuple[int, int, Modes]]] = {}

    def advance(self, k: int, state: FloatArray, strength: FloatArray, friction: FloatArray) -> FloatArray:
        """Carry differences of states to transition k; return the differences of the time it takes [tau].

        `strength` and `friction` (N + 1, columns) are the differences of static and kinetic friction.
        """
        self.slide(k, state, friction)
        return self.meet(k, state, strength)

    def slide(self, k: int, state: FloatArray, friction: FloatArray) -> None:
        """Carry differences over the interval before transition k.

        In y_i = T_i / sqrt(c_i) and v_i the motion is dy/dt = -S v, dv/dt = S^T y: with S = U D W^T a
        rotation of each pair of modes, which keeps the energy y^2 + v^2 of a difference.
        """
        mode, span, n = self.path.mode[k], self.path.span[k], self.n_blocks
        for first, last, modes in self._rows(mode):
            forces = state[first : first + len(modes.springs)]
            velocities = state[n + 2 + first : n + 3 + last]
            angle = (modes.frequency * span)[:, None]
            cosine, sine = np.cos(angle), np.sin(angle)
            # Friction moves the position about which a mode swings.
            push = modes.blocks.T @ (mode[first - 1 : last, None] * friction[first : last + 1])
            stretched = modes.springs.T @ (forces / modes.root) - push / modes.frequency[:, None]
            moving = modes.blocks.T @ velocities
            velocities[:] = modes.blocks @ (cosine * moving + sine * stretched)
            forces += modes.root * (modes.springs @ ((cosine - 1.0) * stretched - sine * moving))

    def meet(self, k: int, state: FloatArray, strength: FloatArray) -> FloatArray:
        """Shift differences at the same time to those at each run's own transition k; return the shifts."""
        path, block = self.path, self.path.block[k]
        stops = self.n_blocks + 2 + block
        if path.old[k]:
            gauge = path.old[k] * state[stops]
        else:
            gauge = strength[block] - path.new[k] * (state[block] - state[block + 1])
        with np.errstate(divide="ignore", invalid="ignore"):
            shift = -gauge / path.slope[k]
            state += path.rate[k][:, None] * shift
        if path.old[k]:
            state[stops] = 0.0
        return shift

    def size(self, row: int, state: FloatArray) -> float:
        """Energy norm of differences [N], a shift in time left out; root mean square over the neighbours."""
        n, path = self.n_blocks, self.path
        scale = np.ones(2 * n + 4)
        scale[1 : n + 1] = np.sqrt(self.system.coupling[1 : n + 1])
        flow = rates(self.system, path.mode[row], path.state[row]) / scale
        scaled = state / scale[:, None]
        along = flow @ scaled
        rest = np.sum(scaled**2) - along @ along / max(float(flow @ flow), float(np.finfo(float).tiny))
        return float(np.sqrt(max(rest, 0.0) / state.shape[1]))

    def _rows(self, mode: IntArray) -> list[tuple[int, int, Modes]]:
        """First and last block, 1..N, and the normal modes of each row of neighbours that slide."""
        key = mode.tobytes()
        if key not in self._rows_of:
            ends = np.flatnonzero(np.diff(mode != 0, prepend=False, append=False)).tolist()
            pairs = [(first + 1, last) for first, last in zip(ends[::2], ends[1::2], strict=True)]
            self._rows_of[key] = [(*pair, self._modes_of(*pair)) for pair in pairs]
        return self._rows_of[key]

    def _modes_of(self, first: int, last: int) -> Modes:
        if (first, last) not in self._modes:
            n = last - first + 1
            root = np.sqrt(self.system.coupling[first : min(last + 1, self.n_blocks) + 1])
            coupling = np.zeros((len(root), n))
            np.fill_diagonal(coupling, root[:n])
            np.fill_diagonal(coupling[1:], -root[1:])
            springs, frequency, blocks = np.linalg.svd(coupling, full_matrices=False)
            self._modes[first, last] = Modes(springs, blocks.T, frequency, root[:, None])
        return self._modes[first, last]
