"""Proofs are right: beside the 40-digit reference, the double solver, and runs that
start a little apart."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import pairwise
from types import SimpleNamespace
from typing import Any

import mpmath
import pytest
from benchmark.made_up import SYMMETRIC_START, go_on, proof_of
from flint import arb, ctx
from golden import small_tables
from reference import HeldOut, Transition, read_golden, read_held_out
from reference.goldens import SCENES

from precursors.proof import (
    Certificate,
    CertificateError,
    Enclosure,
    ExactChain,
    certify,
    verify,
)
from precursors.proof.motion import EnclosedState, order_for, size, tail, time_unit
from precursors.proof.tube import Proof

# Half a unit of the last of the golden digits, relative.
SCENE_ROUNDING = Fraction(5, 10**40)
HELD_OUT_ROUNDING = Fraction(5, 10**25)
# An enclosure is at least so good [s], [N].
TIME_RADIUS, LOAD_RADIUS = Fraction(1, 10**40), Fraction(1, 10**35)
# Bits that a proof up to the first global slip takes.
NEEDED_BITS = {"fig10": 256, "fig11": 256, "fig12": 512}
# So few that the enclosures are wide, and a start so close to the edge of what they
# hold at time 0.
COARSE_BITS, CLOSE_TO_REACH = 128, Fraction(99, 100)
# Rounding of clocks of 300 bits [s].
CLOCK_ROUNDING = Fraction(1, 2**280)


def exactly(x: Fraction) -> Enclosure:
    return Enclosure(x, Fraction(0))


def assert_holds(
    certificate: Certificate, golden: list[Transition], rounding: Fraction
) -> None:
    assert certificate.tie is None
    for proved, expected in zip(certificate.transitions, golden, strict=True):
        assert (proved.block, proved.mode) == (expected.block, expected.mode)
        for enclosure, value in (
            (proved.time, expected.time),
            (proved.tangential_load, expected.tangential_load),
        ):
            assert abs(enclosure.midpoint - value) <= enclosure.radius + rounding * abs(
                value
            )


@pytest.mark.parametrize("name", SCENES)
def test_enclosures_up_to_the_first_global_slip_hold_the_40_digit_reference(
    name: str,
) -> None:
    certificate = certify(
        ExactChain.from_slider(theta=SCENES[name]), 10, until="global slip"
    )
    golden = read_golden(name)[: len(certificate.transitions)]
    assert len(golden) > 100
    assert_holds(certificate, golden, SCENE_ROUNDING)
    assert certificate.bits == NEEDED_BITS[name]
    assert max(t.time.radius for t in certificate.transitions) <= TIME_RADIUS
    assert max(t.tangential_load.radius for t in certificate.transitions) <= LOAD_RADIUS


@pytest.mark.parametrize(
    "name", ["one_block", "two_blocks", "frictionless_slip", "uneven_prestressed"]
)
def test_held_out_chains_are_proved(name: str) -> None:
    case, golden = read_held_out()[name]
    certificate = certify(
        exact_chain(case), case.duration, start_positions=case.start_positions
    )
    assert_holds(certificate, golden, HELD_OUT_ROUNDING)


def exact_chain(case: HeldOut) -> ExactChain:
    names = {f.name for f in dataclasses.fields(ExactChain)} - {"length"}
    return ExactChain(
        **{name: getattr(case.chain, name) for name in names}, length="1/10"
    )


def test_a_release_is_known_exactly() -> None:
    (release,) = certify(ExactChain.from_slider(theta="5/6"), "0.0584").transitions[:1]
    # mu_s w_1 = 14/3 N at K V = 80 N/s
    assert release.time.contains(exactly(Fraction(14, 3) / 80))
    assert release.tangential_load.contains(exactly(Fraction(14, 3)))


def test_the_doubles_of_a_chain_are_taken_for_what_they_are() -> None:
    certificate = certify(ExactChain.from_slider(n_blocks=3).to_chain(), 2)
    assert certificate.chain.mu_s == Fraction(0.7) != Fraction(7, 10)
    assert certificate.transitions[0].tangential_load.contains(
        exactly(Fraction(0.7) * Fraction(400 / 3))
    )


def test_a_mirror_symmetric_start_is_a_tie() -> None:
    chain = ExactChain.from_slider(n_blocks=7)
    certificate = certify(chain, "0.3", start_positions=SYMMETRIC_START, max_bits=1024)
    assert [(t.time, t.block, t.mode) for t in certificate.transitions] == [
        (exactly(Fraction(0)), i, mode) for i, mode in ((3, 1), (4, -1), (5, 1))
    ]
    tie = certificate.tie
    assert tie is not None
    assert tie.blocks == (2, 6)
    assert tie.closeness < Fraction(1, 10**45)
    assert certificate.proved_until < certificate.duration
    verify(certificate)


def test_a_tie_all_but_true_is_decided_with_more_bits() -> None:
    # Block 2 carries less than block 6, by one part in 1e100, and lets go first.
    chain = ExactChain.from_slider(n_blocks=7, theta="1e-100")
    certificate = certify(chain, "1e-5", start_positions=SYMMETRIC_START)
    assert certificate.tie is None
    assert certificate.bits == 512
    assert [(t.block, t.mode) for t in certificate.transitions[3:5]] == [(2, 1), (6, 1)]


@pytest.mark.parametrize("displaced", [1, 2])
def test_a_run_that_starts_within_the_distance_stays_in_the_enclosures(
    displaced: int,
) -> None:
    chain = ExactChain.from_slider()
    reach = fraction(proof_of(chain, COARSE_BITS).state.distance)
    # One block is displaced, so that the spring forces are at this distance [N] from
    # zero.
    behind, ahead = chain.springs[displaced - 1 : displaced + 1]
    stiffness = Fraction(
        math.sqrt((behind + ahead) * chain.mass / time_unit(chain) ** 2)
    )
    positions = [
        CLOSE_TO_REACH * reach / stiffness * (i == displaced) for i in range(1, 11)
    ]
    closest = Fraction(0)
    pairs = zip(
        proofs(chain, (), 60, COARSE_BITS),
        proofs(chain, positions, 60, 300),
        strict=True,
    )
    for (coarse, onset), (fine, fine_onset) in pairs:
        one, other = coarse.transitions[-1], fine.transitions[-1]
        assert (one.block, one.mode) == (other.block, other.mode)
        with ctx.workprec(300):
            shift = (coarse.clock - onset - fine.clock + fine_onset).mid()
        assert (
            abs(fraction(shift))
            <= fraction((coarse.unit * coarse.gap).upper()) + CLOCK_ROUNDING
        )
        for ball, exact in (
            (one.time, other.time),
            (one.tangential_load, other.tangential_load),
        ):
            distance = abs(fraction(ball.mid()) - fraction(exact.mid()))
            assert distance <= fraction(ball.rad())
            closest = max(closest, distance / fraction(ball.rad()))
    # The enclosures are no wider than they must be, so the test would see narrower
    # ones.
    assert closest > Fraction(2, 3)


def proofs(
    chain: ExactChain, positions: Sequence[Fraction], n: int, bits: int
) -> Iterator[tuple[Proof, arb]]:
    """Yield a proof after each of n transitions, and the onset of the event [s]."""
    proof = proof_of(chain, bits, positions)
    onset = proof.clock
    for i in range(n):
        while len(proof.transitions) <= i:
            rested = not any(proof.state.mode)
            go_on(proof)
            onset = proof.clock if rested else onset
        yield proof, onset


def fraction(x: arb) -> Fraction:
    mantissa, exponent = x.man_exp()
    return Fraction(int(mantissa)) * Fraction(2) ** int(exponent)


def test_radii_that_are_absorbed_count_in_the_norm_of_the_energy() -> None:
    """sum T_i^2 / c_i + u_i^2, for two blocks."""
    constants: Any = SimpleNamespace(coupling=[arb(c) for c in (0, 0.25, 4, 0)])
    state = EnclosedState([], [], [0] * 4, arb(1))
    state.absorb(
        constants,
        [arb(0), arb(5, 3), arb(6, 4), arb(0)],
        [arb(0), arb(7, 5), arb(8, 6), arb(0)],
    )
    assert float(state.distance) == pytest.approx(
        1 + math.sqrt(9 / 0.25 + 16 / 4 + 25 + 36)
    )
    assert float(size(constants, state.force, state.rate)) == pytest.approx(
        math.sqrt(25 / 0.25 + 36 / 4 + 49 + 64)
    )


@pytest.mark.parametrize("derivative", [0, 1, 2])
@pytest.mark.parametrize("last", [6, 9])
def test_the_bound_of_the_remainder_is_its_first_terms_where_blocks_oscillate(
    last, derivative
) -> None:
    """u'' = -omega^2 u: of every other coefficient 0, a_{n+2} = omega^2 a_n / ((n +
    1)(n + 2)) in size."""
    omega2, span = Fraction(4), Fraction(1, 1000)
    constants: Any = SimpleNamespace(frequency_squared=arb(4))
    for in_another, slack in ((0, Fraction(1, 10**4)), (1000, Fraction(3, 10))):
        series = {
            1: [arb(0)] * (last - 1) + [arb(-1), arb(0)],
            2: [arb(0)] * last + [arb(in_another)],
        }
        bound = fraction(tail(constants, series, arb(1) / 1000, derivative))
        first = sum(
            omega2
            * a
            / (n * (n - 1))
            * math.perm(n, derivative)
            * span ** (n - derivative)
            for n, a in ((last + 1, 1), (last + 2, in_another))
        )
        assert first <= bound < (1 + slack) * first


@pytest.mark.parametrize(
    ("span", "bits"), [(0.0, 64), (0.1, 64), (1.0, 20), (1.0, 64), (1.125, 500)]
)
def test_the_order_is_the_first_even_one_whose_term_is_small_enough(
    span: float, bits: int
) -> None:
    """No frequency is above 2 / T, so that a term of order n is at most (2 span)^n /
    n!, of the largest."""
    enough = [
        n
        for n in range(6, 200, 2)
        if Fraction(2 * span) ** n * 2**bits <= math.factorial(n)
    ]
    assert order_for(span, bits) == enough[0]


@pytest.mark.parametrize(
    "slider",
    [
        {},
        {"drive_stiffness": "4e9"},
        {"n_blocks": 1, "drive_stiffness": 2, "slider_mass": 1},
    ],
)
def test_the_unit_of_time_is_the_largest_power_of_two_for_which_all_frequencies_are_known_to_be_small(
    slider: dict[str, Any],
) -> None:
    chain = ExactChain.from_slider(**slider)
    springs = [*chain.springs, Fraction(0)]
    bound = 2 * max(a + b for a, b in pairwise(springs)) / chain.mass
    unit = time_unit(chain)
    assert bound * unit**2 <= 4 < bound * (2 * unit) ** 2
    assert 2 ** round(math.log2(unit)) == unit


def test_the_enclosures_grow_as_those_that_are_kept() -> None:
    small_tables.assert_kept("enclosures", small_tables.enclosures())


def test_what_is_published_holds_what_is_proved_and_is_hardly_wider() -> None:
    certificate = certify(
        ExactChain.from_slider(n_blocks=3, theta="1/2"), 20, width="1e-20"
    )
    radii = []
    for published, proved in zip(
        certificate.transitions, Proof(certificate).run(), strict=True
    ):
        for enclosure, ball in (
            (published.time, proved.time),
            (published.tangential_load, proved.tangential_load),
        ):
            radius = fraction(ball.rad())
            # One per cent is to spare, and less than one is lost by writing three
            # digits.
            least = Fraction(101, 100) * (
                radius + abs(enclosure.midpoint - fraction(ball.mid()))
            )
            assert (
                least
                <= enclosure.radius
                <= Fraction(101, 100) * least + Fraction(1, 10**47)
            )
            digits = min(45, 2 - math.floor(math.log10(radius)))
            assert (enclosure.midpoint * 10**digits).denominator == 1
            radii.append(float(radius))
    assert min(radii) < 1e-46
    assert max(radii) > 1e-36


def test_a_transition_at_the_very_end_of_the_run_is_not_decided_by_luck() -> None:
    certificate = certify(ExactChain.from_slider(), "0.35", max_bits=512)
    assert certificate.transitions == ()
    assert certificate.tie is not None
    assert certificate.tie.time.contains(exactly(Fraction("0.35")))


def test_a_block_that_only_touches_standstill_is_a_tie() -> None:
    case = read_held_out()["grazing"][0]
    certificate = certify(exact_chain(case), case.duration, max_bits=512)
    assert [(t.block, t.mode) for t in certificate.transitions] == [(1, 1)]
    assert certificate.tie is not None
    assert certificate.tie.question == "whether block 1 stops"


def lone_block(excess: str) -> Certificate:
    """One block without friction that starts at 2 V (1 + excess), until before it is
    back.

    Its speed is V + (1 + 2 excess) V cos(omega t): at excess = 0 it only touches zero.
    """
    chain = ExactChain.from_slider(n_blocks=1, mu_s=0, mu_k=0)
    start = 2 * chain.drive_velocity * (1 + Fraction(excess))
    return certify(chain, 6 * time_unit(chain), start_velocities=[start], max_bits=512)


def test_a_motion_that_only_grazes_its_limit_is_not_proved() -> None:
    grazing = lone_block("0")
    assert [t.mode for t in grazing.transitions] == [1]
    assert grazing.tie is not None
    assert grazing.tie.question == "whether block 1 stops"


@pytest.mark.parametrize("excess", ["1", "1e-6", "1e-12"])
def test_the_least_slope_of_a_turn_is_that_of_the_motion(excess: str) -> None:
    turned = lone_block(excess)
    chain = turned.chain
    assert [t.mode for t in turned.transitions[:2]] == [1, -1]
    # sqrt((1 + 2 excess)^2 - 1) without a difference of nearly equal numbers
    sine = 2 * math.sqrt(float(excess) * (1 + float(excess)))
    omega = math.sqrt(chain.drive_stiffness / chain.mass)
    expected = float(chain.drive_velocity) * omega * sine
    slope = float(turned.transitions[1].slope)
    assert 0.9989 * expected < slope < expected


def test_a_slope_that_is_steeper_than_the_proved_one_is_refused() -> None:
    turned = lone_block("1")
    first, second, *others = turned.transitions
    steeper = second._replace(slope=second.slope * Fraction(102, 100))
    with pytest.raises(CertificateError, match=r"a slope of .* is not proved"):
        verify(dataclasses.replace(turned, transitions=(first, steeper, *others)))


def test_block_1_is_released_at_the_rate_of_the_drive() -> None:
    (release,) = certify(ExactChain.from_slider(), "0.36").transitions[:1]
    assert 0.999 * 80 < release.slope < 80  # K V [N/s], from rest


def test_a_turn_at_the_very_end_of_a_window_is_proved() -> None:
    """v = V + (v_0 - V) cos(omega t) of one block without friction is zero after one
    T."""
    chain = ExactChain.from_slider(n_blocks=1, mu_s=0, mu_k=0)
    end = time_unit(chain)
    square = chain.drive_stiffness / chain.mass * end**2
    with mpmath.workdps(70):
        phase = mpmath.sqrt(square.numerator / mpmath.mpf(square.denominator))
        start = mpmath.mpf("1e-4") * (1 - 1 / mpmath.cos(phase))
        certificate = certify(chain, 4 * end, start_velocities=[mpmath.nstr(start, 60)])
    moves, turns = certificate.transitions
    assert (moves.time.upper, turns.mode) == (0, 1)
    assert turns.time.contains(exactly(end))


def test_too_few_bits_are_an_error_and_no_tie() -> None:
    with pytest.raises(
        CertificateError, match="max_bits = 256 do not suffice beyond t = "
    ):
        certify(ExactChain.from_slider(), 10, max_bits=256)
