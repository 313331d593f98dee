"""Compute the motion between transitions in ball arithmetic, and bound the distance
between runs of the model.

Units: force in N, time in T, and u = m v / T in N. T is a power of two in seconds, such
that no frequency of the chain is above 2 / T. With c_i = k_i T^2 / m and k_1 = K, Eqs.
2-4 are

    dT_i/dt = c_i (u_{i-1} - u_i),
    du_i/dt = T_i - T_{i+1} - mode_i mu_k w_i   where block i slides, else u_i = 0,

with T_i the force of the spring behind block i, T_{N+1} = 0 and u_0 the drive. The
distance between two runs,

    |e|^2 = sum e_{T_i}^2 / c_i + sum e_{u_i}^2,

is the energy of their difference. It does not change while both runs have the same
modes; `tube` explains how a transition changes it.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import reduce
from itertools import groupby, pairwise

from flint import arb, arb_poly, ctx, fmpq

from precursors.proof.exact_chain import ExactChain

# Bits of radii and of other bounds.
BOUND_BITS = 64
# Upper bound of (largest frequency * T)^2, by Gershgorin.
LARGEST_FREQUENCY_SQUARED = 4


def ball(x: Fraction) -> arb:
    """Enclose a rational number."""
    return arb(fmpq(x.numerator, x.denominator))


def bordered(of_blocks: Iterable[Fraction]) -> list[Fraction]:
    """Add zeros for the drive and the free end to numbers of the blocks."""
    return [Fraction(0), *of_blocks, Fraction(0)]


def log2(x: arb) -> int:
    """Return an integer at or just above log2 of |x|, for x != 0 of any size."""
    mantissa, exponent = x.abs_upper().man_exp()
    return int(exponent) + int(mantissa).bit_length()


def time_unit(chain: ExactChain) -> Fraction:
    """Return T [s], the largest power of two for which no frequency of the chain
    exceeds 2 / T."""
    pairs = pairwise((*chain.springs, Fraction(0)))
    fastest = max(2 * (k + ahead) for k, ahead in pairs) / chain.mass
    ratio = LARGEST_FREQUENCY_SQUARED / fastest
    # floor(log2(ratio)) or one more
    power = ratio.numerator.bit_length() - ratio.denominator.bit_length()
    return Fraction(2) ** ((power - (Fraction(2) ** power > ratio)) // 2)


@dataclass(frozen=True)
class Constants:
    """A chain in the units above, in balls; index 0 is the drive, N + 1 the free end.

    The fields are coupling c_i [1], strength mu_s w_i [N], friction mu_k w_i [N], drive
    u_0 [N], and frequency_squared, an upper bound [1/T^2]. force_reach and
    force_rate_reach are the largest changes of the net force on a block, and of its
    rate, at unit distance.
    """

    coupling: list[arb]
    strength: list[arb]
    friction: list[arb]
    drive: arb
    frequency_squared: arb
    force_reach: list[arb]
    force_rate_reach: list[arb]

    @classmethod
    def of(cls, chain: ExactChain, unit: Fraction) -> Constants:
        """Enclose the numbers of a chain at the working precision."""
        c = bordered(k * unit**2 / chain.mass for k in chain.springs)
        pairs = list(pairwise((*c, Fraction(0))))
        return cls(
            coupling=[ball(x) for x in c],
            strength=[ball(chain.mu_s * w) for w in bordered(chain.weights)],
            friction=[ball(chain.mu_k * w) for w in bordered(chain.weights)],
            drive=ball(chain.drive_velocity * chain.mass / unit),
            frequency_squared=ball(max(2 * (a + b) for a, b in pairs)).abs_upper(),
            force_reach=[ball(a + b).sqrt().abs_upper() for a, b in pairs],
            force_rate_reach=[
                ball(a * a + (a + b) ** 2 + b * b).sqrt().abs_upper() for a, b in pairs
            ],
        )


@dataclass
class EnclosedState:
    """An exact centre, and a bound of the distance [N] of every run of the model from
    it.

    The lists are T_i [N], u_i [N] and the mode of each block, which is FREE for a moving
    block without load. Index 0 is the drive and N + 1 the free end; both stay zero.
    """

    force: list[arb]
    rate: list[arb]
    mode: list[int]
    distance: arb

    def net_force(self, i: int) -> arb:
        """Net force of the springs on block i [N]."""
        return self.force[i] - self.force[i + 1]

    def sliding_rows(self) -> Iterator[list[int]]:
        """Yield each row of neighbouring blocks that slide."""
        blocks = range(1, len(self.mode) - 1)
        for slides, row in groupby(blocks, key=lambda i: self.mode[i] != 0):
            if slides:
                yield list(row)

    def absorb(self, constants: Constants, force: list[arb], rate: list[arb]) -> None:
        """Take the midpoints of balls as the new centre and count the radii as
        distance."""
        with ctx.workprec(BOUND_BITS):
            radii = size(constants, [x.rad() for x in force], [x.rad() for x in rate])
            self.distance = (self.distance + radii).abs_upper()
        self.force = [x.mid() for x in force]
        self.rate = [x.mid() for x in rate]

    def largest_force_change(self, constants: Constants, gap: arb) -> arb:
        """Bound the change of any net force [N] in any run during twice the gap [T].

        |(T, u)| grows at most at the rate sqrt(c_1) u_0 + |mu_k w|, forward or backward
        in time.
        """
        friction = sum((f**2 for f in constants.friction), arb(0)).sqrt()
        gain = (constants.coupling[1].sqrt() * constants.drive + friction) * 2 * gap
        fastest = (
            size(constants, self.force, self.rate)
            + self.distance
            + gain
            + constants.drive
        )
        return (constants.frequency_squared * fastest * 2 * gap).abs_upper()


def size(constants: Constants, force: list[arb], rate: list[arb]) -> arb:
    """Return the distance [N] of a state from rest without forces, as defined above."""
    squares = (
        f**2 / c + u**2
        for c, f, u in zip(constants.coupling, force, rate, strict=True)
        if c != 0
    )
    return sum(squares, arb(0)).sqrt()


def expand(
    constants: Constants, state: EnclosedState, span: float | arb, bits: int
) -> tuple[dict[int, arb_poly], list[arb]]:
    """Return Taylor polynomials of u_i of the sliding blocks, accurate to about `bits`
    bits for times up to +-`span` [T].

    The list has bounds of their remainders, for all u_i and their first two
    derivatives.
    """
    series = coefficients(constants, state, order_for(float(span), bits))
    rests = [tail(constants, series, arb(span), derivative) for derivative in range(3)]
    return {i: arb_poly(row) for i, row in series.items()}, rests


def coefficients(
    constants: Constants, state: EnclosedState, order: int
) -> dict[int, list[arb]]:
    """Return Taylor coefficients 0..order of u_i of the sliding blocks, from the
    second-order form of Eq. 2,

    (n+1) (n+2) u_{i,n+2} = c_i (u_{i-1,n} - u_{i,n}) - c_{i+1} (u_{i,n} - u_{i+1,n}).
    """
    series: dict[int, list[arb]] = {}
    zeros = [arb(0)] * order
    for blocks in state.sliding_rows():
        first = blocks[0]
        last = blocks[-1]
        rows = [
            [state.rate[i], state.net_force(i) - state.mode[i] * constants.friction[i]]
            for i in blocks
        ]
        behind = [constants.drive, *zeros] if first == 1 else zeros
        coupling = constants.coupling[first + 1 : last + 2]
        for n in range(order - 1):
            scale = (n + 1) * (n + 2)
            here = rows[0][n]
            pull = constants.coupling[first] * (behind[n] - here)
            for j, c in enumerate(coupling):
                ahead = rows[j + 1][n] if first + j < last else zeros[n]
                next_pull = c * (here - ahead)
                rows[j].append((pull - next_pull) / scale)
                pull = next_pull
                here = ahead
        series.update(zip(blocks, rows, strict=True))
    return series


def tail(
    constants: Constants, series: dict[int, list[arb]], span: arb, derivative: int
) -> arb:
    """Bound the remainders of all u_i, or of a derivative, for times up to +-`span`
    [T].

    With a_n the largest coefficient, a_{n+2} <= omega^2 a_n / ((n+1)(n+2)); derivatives
    obey the same.
    """
    last = len(next(iter(series.values()))) - 1
    bounds = []
    for n in (last - 1, last):
        largest = reduce(arb.max, (row[n].abs_upper() for row in series.values()))
        bounds.append(largest * math.perm(n, derivative) * span ** (n - derivative))
    n = last - derivative
    ratio = constants.frequency_squared * span**2 / (n * (n + 1))
    if not ratio < 1:
        raise ValueError(f"order {last} is too low for a span of {span}")
    return ((bounds[0] + bounds[1]) * ratio / (1 - ratio)).abs_upper()


def order_for(span: float, bits: int) -> int:
    """Return the order whose remainder over `span` [T] is about 2^-bits of the largest
    term; `tail` gives the proved bound."""
    reach = max(math.sqrt(LARGEST_FREQUENCY_SQUARED) * span, 1e-9)
    order = 6
    while math.lgamma(order + 1) - order * math.log(reach) < bits * math.log(2):
        order += 2
    return order


def force_rate(
    constants: Constants, polynomials: dict[int, arb_poly], i: int
) -> arb_poly:
    """Return the Taylor polynomial of the rate of the net force on a stuck block i."""
    rate = arb_poly([constants.coupling[1] * constants.drive] if i == 1 else [])
    for neighbour, spring in ((i - 1, i), (i + 1, i + 1)):
        if neighbour in polynomials:
            rate += constants.coupling[spring] * polynomials[neighbour]
    return rate


def advance(
    constants: Constants,
    state: EnclosedState,
    polynomials: dict[int, arb_poly],
    rest: arb,
    step: arb,
) -> None:
    """Advance the state by an exact `step` [T]; `rest` bounds the remainder of each
    u_i."""
    around = arb(0, rest)
    slip = [arb(0)] * len(state.mode)
    rate = list(state.rate)
    slip[0] = constants.drive * step
    for i, u in polynomials.items():
        rate[i] = u(step) + around
        slip[i] = u.integral()(step) + around * step
    force = list(state.force)
    for i in range(1, len(force)):
        if i == 1 or i in polynomials or i - 1 in polynomials:
            force[i] = force[i] + constants.coupling[i] * (slip[i - 1] - slip[i])
    state.absorb(constants, force, rate)
