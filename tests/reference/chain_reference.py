"""The paper's chain to more than 40 digits, by a method and in numbers of its own: the judge of the solver.

Time is counted in T = 2^-s sqrt(m/k) and displacement in newtons (u = k x), both as integers with `bits`
binary places (see `polynomials`). Motion is a Taylor series of the displacements over windows of length T,
with s chosen so that the largest angular frequency of the chain is at most 2/T. A transition is the first
zero, isolated by Bernstein coefficients, of a sliding block's velocity or of a stuck block's margin
mu_s w_i -+ g_i, where g_i is the net force of its springs. While all blocks stick, the next release is one
division.

Two zeros so close that only rounding tells them from one (1e-30 T) count as one, at which the function
touches zero: a block whose velocity touches zero sticks and, where nothing holds it (mu_s = mu_k, or no
weight), is released at that instant.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, fields
from fractions import Fraction
from itertools import pairwise
from math import factorial, isqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .polynomials import GUARD_BITS, derivative, first_zero, value

BITS = 256  # 77 decimal places: 14 guard places, and growth takes 9 more in 10 s of the paper's scenes
NOISE = 1 << GUARD_BITS  # no sum of rounding errors comes near it
Number = Fraction | int | str | float


class Transition(NamedTuple):
    """A change of one block's state: time [s], block 1..N, mode +1 | 0 | -1, tangential load F_X [N]."""

    time: Fraction
    block: int
    mode: int
    tangential_load: Fraction


@dataclass(frozen=True)
class ReferenceChain:
    """The numbers of the equations of motion (Eqs. 2-6), exact: w_i [N], m [kg], k and K [N/m], V [m/s]."""

    weights: tuple[Fraction, ...]
    mass: Fraction
    stiffness: Fraction
    drive_stiffness: Fraction
    drive_velocity: Fraction
    mu_s: Fraction
    mu_k: Fraction

    @classmethod
    def from_slider(
        cls,
        n_blocks: int = 10,
        theta: Number = 0,
        normal_load: Number = 400,
        mu_s: Number = "0.70",
        mu_k: Number = "0.45",
        drive_stiffness: Number = "0.8e6",
        drive_velocity: Number = "1e-4",
        slider_mass: Number = "0.012",
        youngs_modulus: Number = "2.5e9",
        cross_section: Number = "1e-4",
        length: Number = "0.1",
        weights: Sequence[Number] | None = None,
    ) -> ReferenceChain:
        """Cut a slider into N blocks (Eqs. 7, 9, 10); `weights` [N], if given, replace those of Eq. 7."""
        n, load, slope = n_blocks, Fraction(normal_load), Fraction(theta)
        if weights is None:
            # At N = 1 Eq. 7 is 0/0; the one block carries the whole load.
            offsets = [Fraction(2 * i - n - 1, n - 1) if n > 1 else Fraction(0) for i in range(1, n + 1)]
            weights = [load / n * (1 + offset * slope) for offset in offsets]
        if len(weights) != n:
            raise ValueError(f"{len(weights)} weights for n_blocks = {n}")
        return cls(
            weights=tuple(Fraction(w) for w in weights),
            mass=Fraction(slider_mass) / n,
            stiffness=n * Fraction(youngs_modulus) * Fraction(cross_section) / Fraction(length),
            drive_stiffness=Fraction(drive_stiffness),
            drive_velocity=Fraction(drive_velocity),
            mu_s=Fraction(mu_s),
            mu_k=Fraction(mu_k),
        )

    def rounded_to_doubles(self) -> ReferenceChain:
        """Return the chain that a solver in double precision is given: each number rounded once."""
        numbers = {f.name: getattr(self, f.name) for f in fields(self)}
        weights = tuple(Fraction(float(w)) for w in numbers.pop("weights"))
        return ReferenceChain(weights, **{name: Fraction(float(x)) for name, x in numbers.items()})


def reference(
    chain: ReferenceChain,
    duration: Number,
    until: str | None = None,
    start_positions: Sequence[Number] | None = None,
    max_transitions: int | None = None,
    bits: int = BITS,
    start_velocities: Sequence[Number] | None = None,
) -> list[Transition]:
    """Return all transitions up to `duration` [s], in time order.

    Parameters
    ----------
    chain : ReferenceChain
        The chain.
    duration : number
        Latest time [s].
    until : {None, "global slip"}
        Stop at the end of the first event in which all blocks slide at the same instant.
    start_positions : sequence of N numbers, optional
        Positions at t = 0 [m]; without them the springs have their natural length.
    max_transitions : int, optional
        Stop after at least this many transitions.
    bits : int
        Binary places of the fixed-point numbers.
    start_velocities : sequence of N numbers, optional
        Velocities at t = 0 [m/s]; without them all blocks are at rest.

    Raises
    ------
    ValueError
        If `until` is neither None nor "global slip", or there is not one start position, or velocity, for
        each block.
    """
    if until not in (None, "global slip"):
        raise ValueError(f'until must be None or "global slip", but is {until!r}')
    scaled = _scale(chain, bits)
    state = _rest(chain, scaled, start_positions)
    end = _fixed(Fraction(duration) / scaled.time_unit, bits)
    moving = _start_moving(chain, scaled, state, start_velocities)
    starting = sorted(dict(_overloaded(scaled, state) + moving).items())
    transitions = [_release(scaled, state, i, way) for i, way in starting]
    all_slid = False
    while max_transitions is None or len(transitions) < max_transitions:
        all_slid = all_slid or all(state.modes[1:])
        if any(state.modes):
            changes = _slide(scaled, state)
        elif until == "global slip" and all_slid:
            break
        else:
            changes, all_slid = _load(scaled, state), False
        if state.time > end:
            break
        transitions += [
            _stop_or_turn(scaled, state, i) if state.modes[i] else _release(scaled, state, i, way)
            for i, way in changes
        ]
    return transitions


def interval_lengths(transitions: Iterable[Transition]) -> list[Fraction]:
    """Return the seconds from the start to the first transition and from each one to the next, exact."""
    times = [Fraction(0), *(transition.time for transition in transitions)]
    return [later - earlier for earlier, later in pairwise(times)]


def as_array(transitions: Sequence[Transition]) -> NDArray[np.void]:
    """Return the transitions as a structured array of doubles, with the fields of Run.transitions."""
    dtype = [("time", "f8"), ("block", "i8"), ("mode", "i8"), ("tangential_load", "f8")]
    rows = [(float(t.time), t.block, t.mode, float(t.tangential_load)) for t in transitions]
    return np.array(rows, dtype=dtype)


Change = tuple[int, int]  # block, and the direction of its release if it is stuck
Series = list[list[int]]  # Taylor coefficients of the displacements of the drive point and of each block


@dataclass(frozen=True)
class _Scaled:
    """The chain in fixed-point numbers: forces in newtons, time in T. Index 0 is the drive point."""

    bits: int
    order: int  # of the Taylor series
    halvings: int  # s
    time_unit: Fraction  # T [s]
    stiffness_ratio: int  # K/k
    drive_velocity: int  # k V T
    strength: tuple[int, ...]  # mu_s w_i
    kinetic: tuple[int, ...]  # mu_k w_i


@dataclass
class _State:
    """Motion of the drive point (index 0, mode 0) and of the blocks 1..N at one time."""

    time: int
    positions: list[int]
    velocities: list[int]
    modes: list[int]


def _fixed(x: Fraction, bits: int) -> int:
    return round(x * (1 << bits))


def _scale(chain: ReferenceChain, bits: int) -> _Scaled:
    ratio = chain.drive_stiffness / chain.stiffness
    # Gershgorin: the square of the largest angular frequency, in units of k/m.
    largest = max(Fraction(4), 2 + ratio)
    halvings = 0
    while largest > 4 * 4**halvings:
        halvings += 1
    root = isqrt(int(chain.mass / chain.stiffness * (1 << 4 * bits)))
    time_unit = Fraction(root, 1 << (2 * bits + halvings))
    # With displacements up to 2^GUARD_BITS, the series has reached rounding when 2^n/n! is that far below it.
    order = 1
    while factorial(order) < 1 << (order + bits + GUARD_BITS):
        order += 1
    return _Scaled(
        bits=bits,
        order=order,
        halvings=halvings,
        time_unit=time_unit,
        stiffness_ratio=_fixed(ratio, bits),
        drive_velocity=_fixed(chain.stiffness * chain.drive_velocity * time_unit, bits),
        strength=(0, *(_fixed(chain.mu_s * w, bits) for w in chain.weights)),
        kinetic=(0, *(_fixed(chain.mu_k * w, bits) for w in chain.weights)),
    )


def _rest(chain: ReferenceChain, scaled: _Scaled, start_positions: Sequence[Number] | None) -> _State:
    n = len(chain.weights)
    metres = [0] * n if start_positions is None else start_positions
    if len(metres) != n:
        raise ValueError(f"{len(metres)} start positions for {n} blocks")
    positions = [0, *(_fixed(chain.stiffness * Fraction(x), scaled.bits) for x in metres)]
    return _State(0, positions, [scaled.drive_velocity] + [0] * n, [0] * (n + 1))


def _start_moving(
    chain: ReferenceChain, scaled: _Scaled, state: _State, start_velocities: Sequence[Number] | None
) -> list[Change]:
    """Give the blocks their velocities at the start; those that move slide, whatever their force."""
    n = len(chain.weights)
    speeds = [0] * n if start_velocities is None else start_velocities
    if len(speeds) != n:
        raise ValueError(f"{len(speeds)} start velocities for {n} blocks")
    for i, speed in enumerate(speeds, 1):
        state.velocities[i] = _fixed(chain.stiffness * Fraction(speed) * scaled.time_unit, scaled.bits)
    return [(i, 1 if v > 0 else -1) for i, v in enumerate(state.velocities) if i and v]


def _overloaded(scaled: _Scaled, state: _State) -> list[Change]:
    """Blocks whose net force exceeds static friction at the start."""
    forces = {i: _net_force(scaled, state.positions, i) for i in range(1, len(state.modes))}
    return [(i, 1 if g > 0 else -1) for i, g in forces.items() if abs(g) > scaled.strength[i] + NOISE]


def _release(scaled: _Scaled, state: _State, i: int, way: int) -> Transition:
    """Let the stuck block i slide."""
    state.modes[i] = way
    return _transition(scaled, state, i)


def _stop_or_turn(scaled: _Scaled, state: _State, i: int) -> Transition:
    """Let block i, whose velocity has reached zero, stick if friction holds it, or else follow the force."""
    state.velocities[i] = 0
    force = _net_force(scaled, state.positions, i)
    holds = abs(force) <= scaled.strength[i] + NOISE
    state.modes[i] = 0 if holds else (1 if force > 0 else -1)
    return _transition(scaled, state, i)


def _transition(scaled: _Scaled, state: _State, i: int) -> Transition:
    one = 1 << scaled.bits
    load = _force_behind(scaled, 1, state.positions[0] - state.positions[1])
    return Transition(Fraction(state.time, one) * scaled.time_unit, i, state.modes[i], Fraction(load, one))


def _load(scaled: _Scaled, state: _State) -> list[Change]:
    """Load the resting chain until block 1 is released: no other block feels the drive."""
    margin = scaled.strength[1] - _net_force(scaled, state.positions, 1)
    if margin > NOISE:
        loading_rate = scaled.stiffness_ratio * scaled.drive_velocity  # K V T, with twice the binary places
        _set_time(scaled, state, state.time + (margin << 2 * scaled.bits) // loading_rate)
    return [(1, 1)]


def _slide(scaled: _Scaled, state: _State) -> list[Change]:
    """Advance to the first transition, but by one window at most; return the blocks that change then."""
    series = _taylor(scaled, state)
    zeros: dict[Change, int | None] = {}
    for i in range(1, len(state.modes)):
        if state.modes[i]:
            zeros[i, 0] = first_zero(_speed(series[i], state.modes[i]), scaled.bits)
        elif i == 1 or state.modes[i - 1] or any(state.modes[i + 1 : i + 2]):
            for way in (1, -1):
                zeros[i, way] = first_zero(_margin(scaled, series, i, way), scaled.bits)
    found = {change: zero for change, zero in zeros.items() if zero is not None}
    # Zeros that coincide come out apart by rounding; no others come as close as half of the places.
    tie = 1 << scaled.bits // 2
    step = min(found.values(), default=1 << scaled.bits)
    if step >= tie:
        _advance(scaled, state, series, step)
    return [change for change, zero in found.items() if zero - step < tie]


def _speed(displacement: list[int], mode: int) -> list[int]:
    """Velocity of a sliding block in its direction; zero at this instant only where the slip begins."""
    speed = [mode * coefficient for coefficient in derivative(displacement)]
    return speed if speed[0] else _without_zero_now(speed)


def _margin(scaled: _Scaled, series: Series, i: int, way: int) -> list[int]:
    """What a stuck block's net force still lacks to its strength, mu_s w_i -+ g_i."""
    margin = [-way * _net_force(scaled, order, i) for order in zip(*series, strict=True)]
    margin[0] += scaled.strength[i]
    return _without_zero_now(margin)


def _without_zero_now(p: list[int]) -> list[int]:
    """Divide p by the power of time with which it begins, up to rounding: only zeros to come are left."""
    begin = next((k for k, coefficient in enumerate(p) if abs(coefficient) > NOISE), None)
    return [2 * NOISE] if begin is None else p[begin:]


def _taylor(scaled: _Scaled, state: _State) -> Series:
    """Taylor coefficients from Eq. 2: (n + 1)(n + 2) u_{n+2} = 4^-s (g_n + friction)."""
    unknown = [0] * (scaled.order - 1)
    series = [[u, v, *unknown] for u, v in zip(state.positions, state.velocities, strict=True)]
    sliding = [i for i, mode in enumerate(state.modes) if mode]
    for n in range(scaled.order - 1):
        now = [coefficients[n] for coefficients in series]
        for i in sliding:
            force = _net_force(scaled, now, i)
            if n == 0:
                force -= state.modes[i] * scaled.kinetic[i]
            series[i][n + 2] = (force >> 2 * scaled.halvings) // ((n + 1) * (n + 2))
    return series


def _net_force(scaled: _Scaled, u: Sequence[int], i: int) -> int:
    """Net force g_i of the springs on block i at displacements u, or one order of its series (Eq. 2)."""
    ahead = u[i] - u[i + 1] if i + 1 < len(u) else 0
    return _force_behind(scaled, i, u[i - 1] - u[i]) - ahead


def _force_behind(scaled: _Scaled, i: int, compression: int) -> int:
    """Force of the spring behind block i; F_X for block 1 (Eq. 3)."""
    return scaled.stiffness_ratio * compression >> scaled.bits if i == 1 else compression


def _advance(scaled: _Scaled, state: _State, series: Series, step: int) -> None:
    _set_time(scaled, state, state.time + step)
    for i, mode in enumerate(state.modes):
        if mode:
            state.positions[i] = value(series[i], step, scaled.bits)
            state.velocities[i] = value(derivative(series[i]), step, scaled.bits)


def _set_time(scaled: _Scaled, state: _State, time: int) -> None:
    state.time = time
    state.positions[0] = scaled.drive_velocity * time >> scaled.bits
