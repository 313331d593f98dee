"""The high-precision reference is right: closed forms, its own precision, and the
golden data from it."""

from __future__ import annotations

import csv
import random
from fractions import Fraction

import pytest
from mpmath import mp
from reference import ReferenceChain, interval_lengths, reference
from reference.goldens import (
    GOLDEN,
    HELD_OUT,
    HELD_OUT_DIGITS,
    VISCOUS,
    csv_rows,
)
from reference.polynomials import first_zero

FORTY_DIGITS = Fraction(1, 10**40)  # relative, what the reference promises
GOLDEN_ROUNDING = Fraction(
    1, 10**39
)  # relative, half a unit of the 40th digit at most 5e-40
# Of a zero on [0, 1]: the polynomials below have condition 2^60 at most.
ZERO_AT_256_BITS = Fraction(1, 2**180)
BITS = 256
THIRD = Fraction(1, 3)


def close(a: Fraction, b: Fraction, relative: Fraction = FORTY_DIGITS) -> bool:
    return abs(a - b) <= relative * abs(b)


def ratio(x: Fraction) -> mp.mpf:
    return mp.mpf(x.numerator) / x.denominator


def exact(x: mp.mpf) -> Fraction:
    sign, mantissa, exponent, _ = x._mpf_
    return (-1) ** sign * Fraction(mantissa) * Fraction(2) ** exponent


def fixed(coefficients: list[Fraction]) -> list[int]:
    return [round(c * 2**BITS) for c in coefficients]


def with_zeros(zeros: list[Fraction]) -> list[Fraction]:
    """The product of all 1 - x/zero."""
    p = [Fraction(1)]
    for zero in zeros:
        p = [
            low - high / zero
            for low, high in zip([*p, Fraction(0)], [Fraction(0), *p], strict=True)
        ]
    return p


@pytest.mark.parametrize(
    "gap", [Fraction(1, 10**6), Fraction(1, 10**15), Fraction(1, 10**30)]
)
def test_a_pair_of_zeros_is_not_stepped_over_however_close(gap):
    found = first_zero(fixed(with_zeros([THIRD, THIRD + gap])), BITS)
    # Rounding of the coefficients moves the zeros of a pair by 2^-256 / gap.
    assert abs(Fraction(found, 2**BITS) - THIRD) < Fraction(16, 2**BITS) / gap


@pytest.mark.parametrize("rounding", [-(2**30), -2, 0, 2, 2**30, 2**73])
def test_a_double_zero_is_found_however_it_is_rounded_and_a_minimum_above_zero_is_none(
    rounding,
):
    p = fixed([THIRD**2, -2 * THIRD, Fraction(1)])
    found = first_zero([p[0] + rounding, *p[1:]], BITS)
    if rounding == 2**73:  # 1e-55 of the polynomial
        assert found is None
    else:
        assert abs(Fraction(found, 2**BITS) - THIRD) < Fraction(4, 2**BITS)


@pytest.mark.parametrize("seed", range(30))
def test_of_many_zeros_the_first_is_found(seed):
    rng = random.Random(seed)
    zeros = [
        Fraction(rng.randint(1, 2000), 1000) + Fraction(1, 7)
        for _ in range(rng.randint(1, 12))
    ]
    found, first = first_zero(fixed(with_zeros(sorted(set(zeros)))), BITS), min(zeros)
    assert (found is None) == (first > 1)
    assert found is None or abs(Fraction(found, 2**BITS) - first) < ZERO_AT_256_BITS


@pytest.mark.parametrize("case", ["-5/6", "0", "5/6", "one block", "viscous"])
def test_the_first_slip_is_that_of_one_oscillator_under_a_growing_load(case):
    """m x'' = drop + K V t - eta x' - stiffness x, from rest at x = 0.

    Its velocity is that of a swing about K V / stiffness, damped at the rate eta / (2
    m).
    """
    options = {
        "one block": {"n_blocks": 1},
        "viscous": VISCOUS["stiff_viscosity"].slider,
    }
    c = ReferenceChain.from_slider(**options.get(case, {"theta": case}))
    release, stop = reference(c, 10, max_transitions=2)
    stiffness = c.drive_stiffness + (c.stiffness if len(c.weights) > 1 else 0)
    onset, loading_rate = c.mu_s * c.weights[0], c.drive_stiffness * c.drive_velocity
    with mp.workdps(60):
        damping = ratio(c.viscosity / (2 * c.mass))
        omega = mp.sqrt(ratio(stiffness / c.mass) - damping**2)
        creep, push = (
            ratio(loading_rate / stiffness),
            ratio((c.mu_s - c.mu_k) * c.weights[0] / c.mass),
        )

        def speed(t: mp.mpf) -> mp.mpf:
            swing = creep * mp.cos(omega * t) + (
                creep * damping - push
            ) / omega * mp.sin(omega * t)
            return creep - mp.exp(-damping * t) * swing

        duration = exact(mp.findroot(speed, (0.9 * mp.pi / omega, 1.1 * mp.pi / omega)))
    assert (release.block, release.mode, stop.block, stop.mode) == (1, 1, 1, 0)
    assert close(release.time, onset / loading_rate)
    assert close(release.tangential_load, onset)
    assert close(stop.time - release.time, duration)
    if not c.viscosity:
        # From a steady slide the block swings to the mirror image: the force on it is
        # mirrored at mu_k w_1.
        slip = (
            loading_rate * stop.time - (2 * c.mu_k - c.mu_s) * c.weights[0]
        ) / stiffness
        assert close(
            stop.tangential_load, loading_rate * stop.time - c.drive_stiffness * slip
        )


def test_without_a_drop_of_friction_one_block_touches_standstill_once_a_period():
    c = ReferenceChain.from_slider(n_blocks=1, mu_k="0.70", drive_velocity="0.1")
    transitions = reference(c, 100, max_transitions=11)
    with mp.workdps(60):
        period = exact(2 * mp.pi * mp.sqrt(ratio(c.mass / c.drive_stiffness)))
    assert [t.mode for t in transitions] == [1] + [0, 1] * 5
    assert all(close(length, period) for length in interval_lengths(transitions)[1::2])
    assert all(length == 0 for length in interval_lengths(transitions)[2::2])


@pytest.mark.parametrize(
    ("file", "case", "name"),
    [
        *(
            ("heldout", HELD_OUT[name], name)
            for name in ("two_blocks", "fast_drive", "uneven_prestressed")
        ),
        ("viscous", VISCOUS["stiff_viscosity"], "stiff_viscosity"),
    ],
)
def test_golden_digits_are_reproduced_with_64_places_less(file, case, name):
    with (GOLDEN / f"reference_{file}.csv").open(newline="") as text:
        rows = [row for chain, *row in csv.reader(text) if chain == name]
    assert csv_rows(case.run(bits=192), HELD_OUT_DIGITS) == rows
