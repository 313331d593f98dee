"""The chain to more than 40 digits, by a method and in numbers of its own: the judge of
the solver.

It may have viscosity between neighbours. Time is counted in T = 2^-s sqrt(m/k) and
displacement in newtons (u = k x), both as integers with `bits` binary places (see
`polynomials`). In these units

    u_i'' = 4^-s (g_i + h_i - f_i),
    h_i = c (u'_{i-1} - u'_i) - c (u'_i - u'_{i+1}),    c = eta / (k T),

with the net force g_i of the springs, no viscosity between the drive point and block 1,
and the friction f_i = mode_i mu_k w_i of a block that slides. A block that sticks does
not move.

Motion is a Taylor series of the displacements over windows of length T, with s chosen
so that the largest angular frequency of the chain is at most 2/T. A transition is the
first zero, isolated by Bernstein coefficients, of a sliding block's velocity, or of
what the net force on a stuck block lacks to mu_s w_i. While nothing moves, the next
release is one division.

Two zeros so close that only rounding tells them from one (1e-30 T) count as one, at
which the function touches zero: a block whose velocity touches zero sticks and, where
nothing holds it (mu_s = mu_k, or no weight), is released at that instant.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from math import factorial, isqrt, sqrt
from typing import NamedTuple

from .polynomials import GUARD_BITS, derivative, first_zero, value

# 77 decimal places: 14 guard places, and growth takes 9 more in 10 s of the paper's
# scenes
BITS = 256
NOISE = 1 << GUARD_BITS  # no sum of rounding errors comes near it
Number = Fraction | int | str | float


class Transition(NamedTuple):
    """A change of one block's state: time [s], block 1..N, mode +1 | 0 | -1, tangential
    load F_X [N]."""

    time: Fraction
    block: int
    mode: int
    tangential_load: Fraction


@dataclass(frozen=True)
class ReferenceChain:
    """The numbers of the equations of motion (Eqs. 2-6), exact: w_i [N], m [kg], k and
    K [N/m], V [m/s].

    Beside them eta of the dashpot between neighbours [N s/m].
    """

    weights: tuple[Fraction, ...]
    mass: Fraction
    stiffness: Fraction
    drive_stiffness: Fraction
    drive_velocity: Fraction
    mu_s: Fraction
    mu_k: Fraction
    viscosity: Fraction = Fraction(0)

    @classmethod
    def from_slider(
        cls,
        n_blocks: int = 10,
        theta: Number = 0,
        normal_load: Number = 400,
        youngs_modulus: Number = "2.5e9",
        weights: Sequence[Number] | None = None,
        **numbers: Number,
    ) -> ReferenceChain:
        """Cut the paper's slider into N blocks (Eqs. 7, 9, 10); `weights` [N] replace
        those of Eq. 7."""
        n, load, slope = n_blocks, Fraction(normal_load), Fraction(theta)
        if weights is None:
            # At N = 1 Eq. 7 is 0/0; the one block carries the whole load.
            offsets = [
                Fraction(2 * i - n - 1, n - 1) if n > 1 else Fraction(0)
                for i in range(1, n + 1)
            ]
            weights = [load / n * (1 + offset * slope) for offset in offsets]
        papers = {
            "drive_stiffness": "0.8e6",
            "drive_velocity": "1e-4",
            "mu_s": "0.70",
            "mu_k": "0.45",
        }
        return cls(
            weights=tuple(Fraction(w) for w in weights),
            mass=Fraction("0.012") / n,
            stiffness=n * Fraction(youngs_modulus) * Fraction("1e-4") / Fraction("0.1"),
            **{name: Fraction(value) for name, value in (papers | numbers).items()},
        )


def reference(
    chain: ReferenceChain,
    duration: Number,
    until: str | None = None,
    start_positions: Sequence[Number] | None = None,
    max_transitions: int | None = None,
    bits: int = BITS,
    start_velocities: Sequence[Number] | None = None,
) -> list[Transition]:
    """Return all transitions up to `duration` [s], or at least the first
    `max_transitions`, in time order.

    `until` is None or "global slip": the end of the first event in which all blocks
    slide at one instant. Starts are in m and m/s, 0 by default. Fixed-point numbers
    have so many binary places as `bits`.
    """
    motion = _Motion(_scale(chain, bits), chain, start_positions, start_velocities)
    end = _fixed(Fraction(duration) / motion.scaled.time_unit, bits)
    transitions = motion.start()
    all_slid = False
    while max_transitions is None or len(transitions) < max_transitions:
        all_slid = all_slid or all(motion.modes[1:])
        if until == "global slip" and all_slid and not any(motion.modes):
            break
        all_slid = all_slid and any(motion.modes)
        changes = motion.slide() if any(motion.modes) else motion.load()
        if motion.time > end:
            break
        transitions += [motion.change(i, way) for i, way in changes]
    return transitions


def interval_lengths(transitions: Iterable[Transition]) -> list[Fraction]:
    """Return the seconds from the start to the first transition and from each one to
    the next, exact."""
    times = [Fraction(0), *(transition.time for transition in transitions)]
    return [later - earlier for earlier, later in pairwise(times)]


Change = tuple[int, int]  # block, and the direction of its release if it is stuck


@dataclass(frozen=True)
class _Scaled:
    """The chain in fixed-point numbers: forces in newtons, time in T. Index 0 is the
    drive point."""

    bits: int
    order: int  # of the Taylor series
    halvings: int  # s
    time_unit: Fraction  # T [s]
    stiffness_ratio: int  # K/k
    drive_velocity: int  # k V T
    strength: tuple[int, ...]  # mu_s w_i
    kinetic: tuple[int, ...]  # mu_k w_i
    damping: int  # c


def _fixed(x: Fraction, bits: int) -> int:
    return round(x * (1 << bits))


def _scale(chain: ReferenceChain, bits: int) -> _Scaled:
    ratio = chain.drive_stiffness / chain.stiffness
    # Gershgorin for |lambda|^2 <= a + b |lambda|, in units of k/m; a power of two above
    # the exact bound.
    a = max(4.0, 2.0 + float(ratio))
    b = 4.0 * float(chain.viscosity) / sqrt(float(chain.mass * chain.stiffness))
    halvings = 0
    while (b + sqrt(b * b + 4.0 * a)) / 2.0 > 2.0 * 2**halvings * (1.0 + 1e-9):
        halvings += 1
    root = isqrt(int(chain.mass / chain.stiffness * (1 << 4 * bits)))
    time_unit = Fraction(root, 1 << (2 * bits + halvings))
    # With displacements up to 2^GUARD_BITS, the series has reached rounding when 2^n/n!
    # is that far below it.
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
        damping=_fixed(chain.viscosity / (chain.stiffness * time_unit), bits),
    )


class _Motion:
    """Positions, velocities and modes of the drive point (index 0) and of the
    blocks."""

    def __init__(
        self,
        scaled: _Scaled,
        chain: ReferenceChain,
        start_positions: Sequence[Number] | None,
        start_velocities: Sequence[Number] | None,
    ) -> None:
        n, bits = len(chain.weights), scaled.bits
        metres, speeds = start_positions or [0] * n, start_velocities or [0] * n
        self.scaled = scaled
        self.time = 0
        self.positions = [
            0,
            *(_fixed(chain.stiffness * Fraction(x), bits) for x in metres),
        ]
        unit = chain.stiffness * scaled.time_unit
        self.velocities = [
            scaled.drive_velocity,
            *(_fixed(unit * Fraction(v), bits) for v in speeds),
        ]
        self.modes = [0] * (n + 1)

    def start(self) -> list[Transition]:
        """Let the blocks slide that move, or whose net force exceeds static
        friction."""
        found = []
        for i in range(1, len(self.modes)):
            speed, force = (
                self.velocities[i],
                self._net(self.positions, self.velocities, i),
            )
            if speed or abs(force) > self.scaled.strength[i] + NOISE:
                self.modes[i] = 1 if (speed or force) > 0 else -1
                found.append(self._transition(i))
        return found

    def load(self) -> list[Change]:
        """Load the resting chain until block 1 is released: no other block feels the
        drive."""
        scaled = self.scaled
        margin = scaled.strength[1] - self._net(self.positions, self.velocities, 1)
        if margin > NOISE:
            loading_rate = scaled.stiffness_ratio * scaled.drive_velocity
            self._set_time(self.time + (margin << 2 * scaled.bits) // loading_rate)
        return [(1, 1)]

    def slide(self) -> list[Change]:
        """Advance to the first transition, but by one window at most; return the blocks
        that change then."""
        bits = self.scaled.bits
        u = self._taylor()
        du = [derivative(coefficients) for coefficients in u]
        zeros: dict[Change, int | None] = {}
        for i in range(1, len(self.modes)):
            if self.modes[i]:
                zeros[i, 0] = first_zero(
                    _without_zero_now([self.modes[i] * c for c in du[i]]), bits
                )
            elif self._may_let_go(i):
                for way in (1, -1):
                    zeros[i, way] = first_zero(self._margin(u, du, i, way), bits)
        found = {change: zero for change, zero in zeros.items() if zero is not None}
        # Zeros that coincide come out apart by rounding; no others come as close as
        # half of the places.
        tie = 1 << bits // 2
        step = min(found.values(), default=1 << bits)
        if step >= tie:
            for i in range(1, len(self.modes)):
                self.positions[i] = value(u[i], step, bits)
                self.velocities[i] = value(du[i], step, bits)
            self._set_time(self.time + step)
        return [change for change, zero in found.items() if zero - step < tie]

    def _may_let_go(self, i: int) -> bool:
        """Whether the force on a stuck block changes."""
        nearby = self.modes[max(i - 1, 0) : i + 2]
        return i == 1 or any(nearby)

    def change(self, i: int, way: int) -> Transition:
        """Release a block that sticks; stop or turn one that slides."""
        if self.modes[i]:
            self.velocities[i] = 0
            force = self._net(self.positions, self.velocities, i)
            holds = abs(force) <= self.scaled.strength[i] + NOISE
            self.modes[i] = 0 if holds else (1 if force > 0 else -1)
        else:
            self.modes[i] = way
        return self._transition(i)

    def _taylor(self) -> list[list[int]]:
        scaled = self.scaled
        u = [
            [x, v] + [0] * (scaled.order - 1)
            for x, v in zip(self.positions, self.velocities, strict=True)
        ]
        mobile = [i for i in range(1, len(self.modes)) if self.modes[i]]
        for n in range(scaled.order - 1):
            now = [c[n] for c in u]
            rate = [(n + 1) * c[n + 1] for c in u]
            for i in mobile:
                force = self._net(now, rate, i)
                if n == 0:
                    force -= self.modes[i] * scaled.kinetic[i]
                u[i][n + 2] = (force >> 2 * scaled.halvings) // ((n + 1) * (n + 2))
        return u

    def _margin(
        self, u: list[list[int]], du: list[list[int]], i: int, way: int
    ) -> list[int]:
        """What the net force on a stuck block still lacks to its strength."""
        padded = [[*c, 0] for c in du]
        margin = [
            -way * self._net([c[n] for c in u], [c[n] for c in padded], i)
            for n in range(len(u[i]))
        ]
        margin[0] += self.scaled.strength[i]
        return _without_zero_now(margin)

    def _net(self, u: Sequence[int], du: Sequence[int], i: int) -> int:
        """g_i + h_i: net force of springs and dashpots on block i, or one order of its
        series."""
        scaled = self.scaled
        behind = u[i - 1] - u[i]
        if i == 1:
            force = scaled.stiffness_ratio * behind >> scaled.bits
        else:
            force = behind + (scaled.damping * (du[i - 1] - du[i]) >> scaled.bits)
        if i + 1 < len(u):
            force -= (
                u[i] - u[i + 1] + (scaled.damping * (du[i] - du[i + 1]) >> scaled.bits)
            )
        return force

    def _transition(self, i: int) -> Transition:
        scaled = self.scaled
        one = 1 << scaled.bits
        load = (
            scaled.stiffness_ratio * (self.positions[0] - self.positions[1])
            >> scaled.bits
        )
        return Transition(
            Fraction(self.time, one) * scaled.time_unit,
            i,
            self.modes[i],
            Fraction(load, one),
        )

    def _set_time(self, time: int) -> None:
        self.time = time
        self.positions[0] = time * self.scaled.drive_velocity >> self.scaled.bits


def _without_zero_now(p: list[int]) -> list[int]:
    """Divide p by the power of time with which it begins, up to rounding: only zeros to
    come are left."""
    begin = next(
        (k for k, coefficient in enumerate(p) if abs(coefficient) > NOISE), None
    )
    return [2 * NOISE] if begin is None else p[begin:]
