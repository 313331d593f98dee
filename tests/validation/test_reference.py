"""The high-precision reference is right: closed forms, its own precision, and the golden data from it."""

from __future__ import annotations

import csv
import random
from fractions import Fraction
from itertools import pairwise

import pytest
from mpmath import mp
from reference import ReferenceChain, interval_lengths, read_golden, read_held_out, reference
from reference.goldens import GOLDEN, HELD_OUT, HELD_OUT_DIGITS, SCENE_DIGITS, SCENES, csv_rows
from reference.polynomials import first_zero

FORTY_DIGITS = Fraction(1, 10**40)  # relative, what the reference promises
GOLDEN_ROUNDING = Fraction(1, 10**39)  # relative, half a unit of the 40th digit at most 5e-40
ZERO_AT_256_BITS = Fraction(
    1, 2**180
)  # of a zero on [0, 1]; the polynomials below have condition 2^60 at most
BITS = 256
TRANSITIONS = {"fig10": 1428, "fig11": 1871, "fig12": 1255}


def close(a: Fraction, b: Fraction, relative: Fraction = FORTY_DIGITS) -> bool:
    return abs(a - b) <= relative * abs(b)


def exact(x: mp.mpf) -> Fraction:
    sign, mantissa, exponent, _ = x._mpf_
    return (-1) ** sign * Fraction(mantissa) * Fraction(2) ** exponent


def lone_slip(stiffness: Fraction, mass: Fraction, force: Fraction, loading_rate: Fraction) -> Fraction:
    """Duration (pi + 2 atan(K V / (force omega))) / omega of the slip of one block among resting ones.

    m x'' = -stiffness x + force + K V t from rest at x = 0: x' = 2 sin(phi) (A omega cos(phi) + B sin(phi)),
    phi = omega t / 2, A = force / stiffness, B = K V / stiffness: zero where tan(phi) = -A omega / B.
    """
    with mp.workdps(60):
        omega = mp.sqrt(ratio(stiffness / mass))
        return exact((mp.pi + 2 * mp.atan(ratio(loading_rate / force) / omega)) / omega)


def ratio(x: Fraction) -> mp.mpf:
    return mp.mpf(x.numerator) / x.denominator


def fixed(coefficients: list[Fraction]) -> list[int]:
    return [round(c * 2**BITS) for c in coefficients]


def times_factor(p: list[Fraction], zero: Fraction) -> list[Fraction]:
    """Multiply p by 1 - x/zero."""
    return [low - high / zero for low, high in zip([*p, Fraction(0)], [Fraction(0), *p], strict=True)]


@pytest.mark.parametrize("gap", [Fraction(1, 10**6), Fraction(1, 10**15), Fraction(1, 10**30)])
def test_a_pair_of_zeros_is_not_stepped_over_however_close(gap: Fraction) -> None:
    low, high = Fraction(1, 3), Fraction(1, 3) + gap
    p = times_factor(times_factor([Fraction(1)], low), high)
    found = first_zero(fixed(p), BITS)
    assert found is not None
    # Rounding of the coefficients moves the zeros of a pair by 2^-256 / gap.
    assert abs(Fraction(found, 2**BITS) - low) < Fraction(16, 2**BITS) / gap


@pytest.mark.parametrize("height", [Fraction(1, 10**6), Fraction(1, 10**30), Fraction(1, 10**55)])
def test_a_minimum_above_zero_is_no_zero_however_low(height: Fraction) -> None:
    third = Fraction(1, 3)
    assert first_zero(fixed([third**2 + height, -2 * third, Fraction(1)]), BITS) is None


@pytest.mark.parametrize("rounding", [-(2**30), -2, 0, 2, 2**30])
def test_a_double_zero_is_found_to_full_precision_whichever_way_it_is_rounded(rounding: int) -> None:
    third = Fraction(1, 3)
    p = fixed([third**2, -2 * third, Fraction(1)])
    found = first_zero([p[0] + rounding, *p[1:]], BITS)
    assert found is not None
    assert abs(Fraction(found, 2**BITS) - third) < Fraction(4, 2**BITS)


@pytest.mark.parametrize("seed", range(30))
def test_of_many_zeros_the_first_is_found(seed: int) -> None:
    rng = random.Random(seed)
    zeros = [Fraction(rng.randint(1, 2000), 1000) + Fraction(1, 7) for _ in range(rng.randint(1, 12))]
    p = [Fraction(1)]
    for zero in set(zeros):
        p = times_factor(p, zero)
    found, first = first_zero(fixed(p), BITS), min(zeros)
    if first > 1:
        assert found is None
    else:
        assert found is not None
        assert abs(Fraction(found, 2**BITS) - first) < ZERO_AT_256_BITS


@pytest.mark.parametrize("theta", SCENES.values())
def test_first_slip_is_that_of_one_oscillator_under_a_growing_load(theta: str) -> None:
    c = ReferenceChain.from_slider(theta=theta)
    release, stop = reference(c, 10, max_transitions=2)
    loading_rate = c.drive_stiffness * c.drive_velocity
    onset = c.mu_s * c.weights[0]
    drop = (c.mu_s - c.mu_k) * c.weights[0]
    duration = lone_slip(c.stiffness + c.drive_stiffness, c.mass, drop, loading_rate)
    time = onset / loading_rate + duration
    # Seen from a steady slide the block swings from -V' to -V': the net force on it is mirrored at mu_k w_1.
    position = (loading_rate * time - (c.mu_k * c.weights[0] - drop)) / (c.stiffness + c.drive_stiffness)
    assert (release.block, release.mode, stop.block, stop.mode) == (1, 1, 1, 0)
    assert close(release.time, onset / loading_rate)
    assert close(release.tangential_load, onset)
    assert close(stop.time - release.time, duration)
    assert close(stop.tangential_load, loading_rate * time - c.drive_stiffness * position)


@pytest.mark.parametrize("drive_velocity", ["1e-4", "0.3"])
def test_one_block_repeats_the_same_slip_for_ever(drive_velocity: str) -> None:
    c = ReferenceChain.from_slider(n_blocks=1, drive_velocity=drive_velocity)
    transitions = reference(c, 100, max_transitions=20)
    loading_rate = c.drive_stiffness * c.drive_velocity
    slip = lone_slip(c.drive_stiffness, c.mass, (c.mu_s - c.mu_k) * 400, loading_rate)
    stick = 2 * (c.mu_s - c.mu_k) * 400 / loading_rate
    assert [t.mode for t in transitions] == [1, 0] * 10
    assert close(transitions[0].time, c.mu_s * 400 / loading_rate)
    assert all(close(length, slip) for length in interval_lengths(transitions)[1::2])
    assert all(close(length, stick) for length in interval_lengths(transitions)[2::2])
    assert all(close(t.tangential_load, Fraction(280 if t.mode else 80)) for t in transitions)


def test_a_weightless_block_swings_with_its_own_period_once_its_neighbour_rests() -> None:
    c = ReferenceChain.from_slider(n_blocks=2, theta=-1)
    transitions = reference(c, "3.502", max_transitions=30)
    assert [(t.block, t.mode) for t in transitions[:3]] == [(1, 1), (2, 1), (1, 0)]
    assert transitions[0].time == transitions[1].time
    swings = transitions[3:]
    assert len(swings) > 10
    assert all((t.block, t.mode) == (2, (-1) ** (i + 1)) for i, t in enumerate(swings))
    with mp.workdps(60):
        half_period = exact(mp.pi * mp.sqrt(ratio(c.mass / c.stiffness)))
    assert all(close(length, half_period) for length in interval_lengths(swings)[1:])


def test_without_a_drop_of_friction_one_block_touches_standstill_once_a_period() -> None:
    c = ReferenceChain.from_slider(n_blocks=1, mu_k="0.70", drive_velocity="0.1")
    transitions = reference(c, 100, max_transitions=11)
    with mp.workdps(60):
        period = exact(2 * mp.pi * mp.sqrt(ratio(c.mass / c.drive_stiffness)))
    assert [t.mode for t in transitions] == [1] + [0, 1] * 5
    assert all(close(length, period) for length in interval_lengths(transitions)[1::2])
    assert all(length == 0 for length in interval_lengths(transitions)[2::2])


def test_at_maximal_residual_strain_all_blocks_start_at_once_under_the_full_load() -> None:
    c = ReferenceChain.from_slider(theta="-5/6")
    ahead = [sum(c.mu_s * w for w in c.weights[i:]) for i in range(10)]
    positions = [-ahead[0] / c.drive_stiffness]
    for force in ahead[1:]:
        positions.append(positions[-1] - force / c.stiffness)
    start = reference(c, 1, start_positions=positions, max_transitions=10)
    assert [(t.time, t.block, t.mode) for t in start] == [(0, i, 1) for i in range(1, 11)]
    assert all(close(t.tangential_load, c.mu_s * 400) for t in start)


def test_a_block_pulled_beyond_its_strength_slides_back_from_time_zero() -> None:
    c = ReferenceChain.from_slider(n_blocks=1)
    release, stop = reference(c, 1, start_positions=["5e-4"])
    # From -400 N against 180 N of kinetic friction it swings to the mirror image, -180 + (400 - 180) N.
    drop, loading_rate = 400 - c.mu_k * 400, -c.drive_stiffness * c.drive_velocity
    assert (release.time, release.mode) == (0, -1)
    assert close(release.tangential_load, Fraction(-400))
    assert close(stop.time, lone_slip(c.drive_stiffness, c.mass, drop, loading_rate))
    assert stop.mode == 0
    assert close(stop.tangential_load, Fraction(40))


def test_with_64_places_less_the_most_sensitive_scene_agrees_to_the_golden_digits_at_10_s() -> None:
    coarse = reference(ReferenceChain.from_slider(theta=SCENES["fig12"]), 10, bits=192)
    golden = read_golden("fig12")
    assert [(t.block, t.mode) for t in coarse] == [(t.block, t.mode) for t in golden]
    for a, b in zip(coarse, golden, strict=True):
        assert close(a.time, b.time, GOLDEN_ROUNDING)
        assert close(a.tangential_load, b.tangential_load, GOLDEN_ROUNDING)


@pytest.mark.parametrize("theta", SCENES.values())
def test_durations_within_slips_agree_to_40_digits_in_two_precisions(theta: str) -> None:
    c = ReferenceChain.from_slider(theta=theta)
    coarse = interval_lengths(reference(c, 10, until="global slip", bits=192))
    fine = interval_lengths(reference(c, 10, until="global slip"))
    assert all(close(a, b) for a, b in zip(coarse, fine, strict=True))


def test_golden_head_is_reproduced_digit_for_digit() -> None:
    transitions = reference(ReferenceChain.from_slider(), 10, until="global slip")
    with (GOLDEN / "reference_fig10.csv").open(newline="") as file:
        head = list(csv.reader(file))[1 : len(transitions) + 1]
    assert len(transitions) == 216
    assert csv_rows(transitions, SCENE_DIGITS) == head


@pytest.mark.parametrize("name", ["two_blocks", "fast_drive", "uneven_prestressed"])
def test_held_out_goldens_are_reproduced_digit_for_digit(name: str) -> None:
    with (GOLDEN / "reference_heldout.csv").open(newline="") as file:
        rows = [row for chain, *row in csv.reader(file) if chain == name]
    assert csv_rows(HELD_OUT[name].run(), HELD_OUT_DIGITS) == rows


def test_every_held_out_chain_has_golden_transitions() -> None:
    assert all(transitions for _, transitions in read_held_out().values())


@pytest.mark.parametrize(("scene", "count"), TRANSITIONS.items())
def test_golden_scenes_are_complete_and_in_order(scene: str, count: int) -> None:
    golden = read_golden(scene)
    assert len(golden) == count
    assert all(earlier.time < later.time for earlier, later in pairwise(golden))
