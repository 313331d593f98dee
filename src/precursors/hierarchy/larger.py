"""Larger models: the paper's chain with dashpots, with springs to the plane, or with a mass at the drive.

Between two transitions (changes of a mode) all of these models are linear, as the paper's chain is. A step is
a Taylor series of fixed order and fixed length. The first zero of each event function in a step is found from
a bound of its curvature, so that none is missed. `swing` leaps over rests on springs to the plane.

The result is exact to rounding: up to the first global slip, transitions of the 40-digit reference are met
within 1e-13 s and 1e-11 N, with a heavy head within 1e-11 s and 1e-8 N (tests/hierarchy/test_larger.py). Only
the largest load is less accurate where blocks swing on springs. It is the largest of samples, and up to 1e-4
of itself too small. docs/models.md has the equations and the rules of switching.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

from precursors.hierarchy.swing import Swing, System
from precursors.model.chain import Chain, FloatArray
from precursors.model.checks import Until, checked_span, not_negative
from precursors.solver.run import Run

ORDER = 16  # of the Taylor series, with which a step of 1/omega is exact to rounding
SEARCHES = 100  # for one zero; a simple zero takes some five
ROUNDING = 1e-15  # of a place in a step
MAX_TRANSITIONS, MAX_STEPS = 1_000_000, 1 << 60
UNITS = {"viscosity": "N s/m", "interface_stiffness": "N/m", "head_mass": "kg"}

compiled = njit(cache=True, error_model="numpy")


@dataclass(frozen=True)
class LargerChain:
    """The paper's chain with up to three additions.

    Parameters
    ----------
    chain : Chain
        The paper's chain; every block has weight, and mu_k < mu_s.
    viscosity : float
        Viscosity eta of the dashpot beside each spring between neighbours [N s/m].
    interface_stiffness : float
        Stiffness K_t of the whole interface [N/m]: each block that sticks has a spring K_t/N to the plane. 0
        stands for a rigid interface.
    head_mass : float
        Mass M_h of the loading head, which moves with block 1 [kg].

    Raises
    ------
    ValueError
        If an addition is negative, a block has no weight, or mu_k = mu_s.
    """

    chain: Chain
    viscosity: float = 0.0
    interface_stiffness: float = 0.0
    head_mass: float = 0.0

    def __post_init__(self) -> None:
        for name, unit in UNITS.items():
            object.__setattr__(self, name, not_negative(name, getattr(self, name), unit))
        if not self.chain.weights.all():
            raise ValueError("every block of a larger model must have weight, but one has 0 N")
        if self.chain.mu_k == self.chain.mu_s:
            raise ValueError(f"mu_k of a larger model must be below mu_s = {self.chain.mu_s:g}, but is equal")

    @property
    def masses(self) -> FloatArray:
        """Mass that moves with each block [kg], shape (N,)."""
        return self.chain.mass + np.append(self.head_mass, np.zeros(self.chain.n_blocks - 1))


@dataclass(frozen=True)
class LargerRun:
    """A run of a larger model.

    Attributes
    ----------
    run : Run
        Its transitions, without states between them; `run.chain` is the chain without the additions.
    largest_load : array, shape (n_transitions,)
        Largest F_X from the start up to each transition [N].
    """

    run: Run
    largest_load: FloatArray

    def largest_load_until(self, time: float) -> float:
        """Largest F_X from the start to the last transition up to a time [s]."""
        return float(self.largest_load[np.searchsorted(self.run.transitions["time"], time, "right") - 1])


def simulate_larger(model: LargerChain, duration: float, until: Until = None) -> LargerRun:
    """Run a larger model from rest with springs at natural length.

    Parameters
    ----------
    model : LargerChain
        The chain and its additions.
    duration : float
        Time to run [s], the limit where `until` is given.
    until : {None, "global slip"}
        Stop at the end of the first event in which all blocks slide at the same instant.

    Raises
    ------
    ValueError
        If an argument is out of range.
    RuntimeError
        If there are more than MAX_TRANSITIONS.
    """
    duration = checked_span(duration, until)
    system = system_of(model)
    # Force of the spring behind each block [N], velocity [m/s], force of the plane on it [N].
    state, mode = np.zeros((3, model.chain.n_blocks)), np.zeros(model.chain.n_blocks, np.int64)
    swing = Swing(system) if system.holding_stiffness else None
    rows: list[tuple[float, int, int, float, float, float]] = []
    time, since_last, largest, was_global, ended = 0.0, 0.0, 0.0, False, False
    while time < duration and not ended:
        waited, high = 0.0, 0.0
        if not mode.any():
            left = duration - time
            waited, high = swing.wait(state, left) if swing else (wait(system, state, left), 0.0)
        # On springs to the plane a rest is searched step by step, between one leap and the next.
        steps = 1 if swing and not mode.any() else MAX_STEPS
        moved, block, highest = next_transition(system, state, mode, duration - time - waited, steps)
        time += waited + moved
        since_last += waited + moved
        largest = max(largest, high, highest)
        if block >= 0 and switch(system, state, mode, block):
            rows.append((time, block + 1, int(mode[block]), state[0, 0], since_last, largest))
            since_last = 0.0
            was_global = was_global or bool(mode.all())
            ended = was_global and until is not None and not mode.any()
        if len(rows) == MAX_TRANSITIONS:
            raise RuntimeError(f"there are more than {MAX_TRANSITIONS} transitions up to t = {time:.9g} s")
    times, blocks, modes, loads, intervals, peaks = np.array(rows).reshape(-1, 6).T
    intervals = np.append(intervals, since_last)
    run = Run.from_transitions(
        model.chain, time if ended else duration, times, blocks, modes, loads, intervals
    )
    return LargerRun(run, peaks)


def system_of(model: LargerChain) -> System:
    """The numbers of a chain, and a step of 1/omega; omega is above all its frequencies (Gershgorin)."""
    chain, held = model.chain, model.interface_stiffness / model.chain.n_blocks
    stiffness = max(4.0 * chain.stiffness, 2.0 * (chain.stiffness + chain.drive_stiffness)) + held
    elastic, damping = stiffness / chain.mass, 4.0 * model.viscosity / chain.mass
    omega = (damping + math.sqrt(damping**2 + 4.0 * elastic)) / 2.0
    return System(
        chain.springs,
        model.masses,
        chain.strength,
        chain.kinetic_friction,
        np.append(0.0, np.full(chain.n_blocks - 1, model.viscosity)),
        held,
        chain.drive_velocity,
        1.0 / omega,
    )


def wait(system: System, state: FloatArray, longest: float) -> float:
    """Load a chain that rests on a rigid interface until block 1 is released; return the time [s]."""
    rate = system.springs[0] * system.drive_velocity
    waited = min(max((system.strength[0] - net_force(system, state, 0)) / rate, 0.0), longest)
    state[0, 0] += rate * waited
    return float(waited)


def switch(system: System, state: FloatArray, mode: NDArray[np.int64], i: int) -> bool:
    """Release block i if it sticks, or let it stick or turn if it stops (Eq. 5).

    Returns whether its mode changed. A block that begins to stick on a spring to the plane is attached anew,
    without a net force on it.
    """
    old = mode[i]
    if old:
        state[1, i] = 0.0
        state[2, i] = net_force(system, state, i)
    sticks = old and abs(state[2, i]) <= system.strength[i]
    mode[i] = 0 if sticks else np.sign(state[2, i])
    return bool(mode[i] != old)


def net_force(system: System, state: FloatArray, i: int) -> float:
    """Net force of springs and dashpots on block i [N]."""
    force, velocity, _ = state
    net = force[i] - (system.dashpots[i] * (velocity[i] - velocity[i - 1]) if i > 0 else 0.0)
    if i + 1 < len(force):
        net -= force[i + 1] + system.dashpots[i + 1] * (velocity[i] - velocity[i + 1])
    return float(net)


@compiled
def next_transition(system, state, mode, longest, max_steps):
    """Move until an event function falls to zero, for `longest` [s] and `max_steps` steps at most.

    Returns the time [s], the block whose event function is zero or -1, and the largest F_X [N] after a step.
    """
    # On a rigid interface nothing moves beyond the block ahead of the farthest that slides.
    slides = np.flatnonzero(mode)
    n = mode.shape[0]
    if system.holding_stiffness == 0.0:
        n = min(n, slides[-1] + 2) if len(slides) > 0 else 1
    series = np.zeros((ORDER + 1, 3, mode.shape[0]))
    size = np.empty(n)
    elapsed, highest = 0.0, state[0, 0]
    for _ in range(max_steps):
        expand(system, state, mode, n, series)
        # Bounds of the force on each block that sticks, and of the change of velocity of each that slides.
        size[:] = 0.0
        for k in range(ORDER + 1):
            for i in range(n):
                size[i] += abs(series[k, 2, i]) if mode[i] == 0 else abs(series[k, 1, i])
        end, block = min((longest - elapsed) / system.step, 1.0), -1
        for i in range(n):
            if size[i] >= (system.strength[i] if mode[i] == 0 else 2.0 * abs(series[0, 1, i])):
                zero = first_event(series, mode[i], system.strength[i], i)
                if zero <= end:
                    end, block = zero, i
        evaluate(series, end, n, state)
        elapsed += end * system.step
        highest = max(highest, state[0, 0])
        if block >= 0 or end < 1.0:
            return elapsed, block, highest
    return elapsed, -1, highest


@compiled
def expand(system, state, mode, n, series):
    """Taylor series over one step of the state of the first n blocks, shape (ORDER + 1, 3, N).

    Its rows are those of the state. The force of the plane is friction while a block slides, the force of its
    spring while it sticks on one, and whatever keeps it at rest on a rigid interface.
    """
    series[0] = state
    for k in range(ORDER + 1):
        part = system.step / (k + 1)
        force, velocity, plane = series[k]
        ahead = force[n] if n < mode.shape[0] else 0.0
        for i in range(n - 1, -1, -1):
            behind = velocity[i - 1] if i > 0 else (system.drive_velocity if k == 0 else 0.0)
            push = force[i] + system.dashpots[i] * (behind - velocity[i])
            net = push - ahead
            ahead = push
            if mode[i] != 0:
                plane[i] = mode[i] * system.friction[i] if k == 0 else 0.0
            elif system.holding_stiffness == 0.0:
                plane[i] = net
            if k < ORDER:
                series[k + 1, 0, i] = part * system.springs[i] * (behind - velocity[i])
                series[k + 1, 1, i] = part * (net - plane[i]) / system.masses[i]
                series[k + 1, 2, i] = part * system.holding_stiffness * velocity[i]


@compiled
def first_event(series, mode, strength, i):
    """First place in a step at which block i stops, or is released in either direction; 2 if none."""
    if mode != 0:
        return first_zero(mode * series[:, 1, i])
    margin = -series[:, 2, i]
    margin[0] += strength
    forward = first_zero(margin)
    margin = series[:, 2, i].copy()
    margin[0] += strength
    return min(forward, first_zero(margin))


@compiled
def first_zero(event):
    """First place in [0, 1] at which a polynomial falls to zero; 2 if it does not.

    Its second derivative is at most `bend`, so it stays above a parabola that bends down by as much. The
    search goes from zero to zero of these parabolas, which near a simple zero is as fast as Newton's method.
    """
    bend = 0.0
    for k in range(2, ORDER + 1):
        bend += k * (k - 1) * abs(event[k])
    place = 0.0
    for _ in range(SEARCHES):
        value, slope = 0.0, 0.0
        for k in range(ORDER, -1, -1):
            slope = slope * place + value
            value = value * place + event[k]
        value = max(value, 0.0)  # below zero by rounding only
        root = math.sqrt(slope**2 + 2.0 * bend * value)
        if slope > 0.0:
            ahead = (slope + root) / bend if bend > 0.0 else 2.0
        else:
            ahead = 2.0 * value / (root - slope) if root > slope else 0.0
        place += ahead
        if place > 1.0:
            return 2.0
        if slope <= 0.0 and ahead <= ROUNDING:
            return place
    return place


@compiled
def evaluate(series, place, n, state):
    """State of the first n blocks at a place in a step, from 0 to 1 (Horner's rule)."""
    for row in range(3):
        for i in range(n):
            value = 0.0
            for k in range(ORDER, -1, -1):
                value = value * place + series[k, row, i]
            state[row, i] = value
