"""Proofs are right: beside the 40-digit reference, the double solver, and runs that start a little apart."""

from __future__ import annotations

import copy
import dataclasses
import math
from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import pairwise
from types import SimpleNamespace
from typing import Any

import mpmath
import pytest
from flint import arb, arb_poly, ctx
from golden import small_tables
from reference import HeldOut, Transition, read_golden, read_held_out
from reference.goldens import SCENES

from precursors.accuracy.proof import (
    Certificate,
    CertificateError,
    Enclosure,
    ExactChain,
    certify,
    verify,
)
from precursors.accuracy.proof.motion import expand, order_for, tail, time_unit
from precursors.accuracy.proof.tube import Proof

# Half a unit of the last of the golden digits, relative.
SCENE_ROUNDING = Fraction(5, 10**40)
HELD_OUT_ROUNDING = Fraction(5, 10**25)
# An enclosure is at least so good [s], [N].
TIME_RADIUS, LOAD_RADIUS = Fraction(1, 10**40), Fraction(1, 10**35)
# Bits that a proof up to the first global slip takes, and how often it is begun again.
NEEDED_BITS = {"fig10": (256, 0), "fig11": (256, 0), "fig12": (1024, 1)}
# So few that the enclosures are wide, and a start so close to the edge of what they hold at time 0.
COARSE_BITS, CLOSE_TO_REACH = 128, Fraction(99, 100)
# Rounding of clocks of 300 bits [s].
CLOCK_ROUNDING = Fraction(1, 2**280)
AT_ZERO = (Fraction(0),) * 10
AT_REST = (AT_ZERO, AT_ZERO)
# Seven blocks, the middle one pushed aside: blocks 2 and 6 are released at the same instant, by symmetry.
SYMMETRIC_START = ["0", "0", "0", "1e-5", "0", "0", "0"]


@pytest.fixture(scope="module", params=SCENES)
def scene(request: pytest.FixtureRequest) -> tuple[str, Certificate]:
    chain = ExactChain.from_slider(theta=SCENES[request.param])
    return request.param, certify(chain, 10, until="global slip")


@pytest.fixture(scope="module")
def small() -> Certificate:
    return certify(ExactChain.from_slider(n_blocks=3, theta="1/2"), 4)


def assert_holds(certificate: Certificate, golden: list[Transition], rounding: Fraction) -> None:
    assert len(certificate.transitions) == len(golden)
    for proved, expected in zip(certificate.transitions, golden, strict=True):
        assert (proved.block, proved.mode) == (expected.block, expected.mode)
        for enclosure, value in (
            (proved.time, expected.time),
            (proved.tangential_load, expected.tangential_load),
        ):
            assert abs(enclosure.midpoint - value) <= enclosure.radius + rounding * abs(value)


def test_enclosures_up_to_the_first_global_slip_hold_the_40_digit_reference(
    scene: tuple[str, Certificate],
) -> None:
    name, certificate = scene
    golden = read_golden(name)[: len(certificate.transitions)]
    assert len(golden) > 100
    assert_holds(certificate, golden, SCENE_ROUNDING)
    assert certificate.tie is None
    assert (certificate.bits, certificate.restarts) == NEEDED_BITS[name]
    widest_time, widest_load = certificate.widest
    assert widest_time <= TIME_RADIUS
    assert widest_load <= LOAD_RADIUS


@pytest.mark.parametrize(
    "name",
    ["one_block", "two_blocks", "three_blocks", "many_blocks", "frictionless_slip", "uneven_prestressed"],
)
def test_held_out_chains_are_proved(name: str) -> None:
    case, golden = read_held_out()[name]
    certificate = certify(exact_chain(case), case.duration, start_positions=case.start_positions)
    assert certificate.tie is None
    assert_holds(certificate, golden, HELD_OUT_ROUNDING)


def exact_chain(case: HeldOut) -> ExactChain:
    reference = case.chain
    names = {f.name for f in dataclasses.fields(ExactChain)} - {"length"}
    numbers = {name: getattr(reference, name) for name in names}
    return ExactChain(**numbers, length="1/10")


def test_a_release_is_known_exactly() -> None:
    (release,) = certify(ExactChain.from_slider(theta="5/6"), "0.0584").transitions[:1]
    # mu_s w_1 = 14/3 N at K V = 80 N/s
    assert release.time.contains(Fraction(14, 3) / 80)
    assert release.tangential_load.contains(Fraction(14, 3))


def test_the_doubles_of_a_chain_are_taken_for_what_they_are(small: Certificate) -> None:
    chain = small.chain.to_chain()
    certificate = certify(chain, 4)
    assert certificate.chain.mu_s == Fraction(0.7) != Fraction(7, 10)
    pairs = list(zip(certificate.transitions, small.transitions, strict=True))
    assert all((a.block, a.mode) == (b.block, b.mode) for a, b in pairs)
    # Rounded parameters are another chain, whose transitions are elsewhere.
    assert not any(a.time.contains(b.time) for a, b in pairs)


def test_a_mirror_symmetric_start_is_a_tie() -> None:
    chain = ExactChain.from_slider(n_blocks=7)
    certificate = certify(chain, "0.3", start_positions=SYMMETRIC_START, max_bits=1024)
    assert [(t.time, t.block, t.mode) for t in certificate.transitions] == [
        (Enclosure(Fraction(0), Fraction(0)), i, mode) for i, mode in ((3, 1), (4, -1), (5, 1))
    ]
    tie = certificate.tie
    assert tie is not None
    assert tie.blocks == (2, 6)
    assert tie.closeness < Fraction(1, 2**512)
    assert certificate.proved_until < certificate.duration
    verify(certificate)


def test_a_tie_all_but_true_is_decided_with_more_bits() -> None:
    # Block 2 carries less than block 6, by one part in 1e100, and lets go first.
    chain = ExactChain.from_slider(n_blocks=7, theta="1e-100")
    certificate = certify(chain, "1e-5", start_positions=SYMMETRIC_START)
    assert certificate.tie is None
    assert (certificate.bits, certificate.restarts) == (512, 1)
    assert [(t.block, t.mode) for t in certificate.transitions[3:5]] == [(2, 1), (6, 1)]
    verify(certificate)


@pytest.mark.parametrize("displaced", [1, 2])
def test_a_run_that_starts_within_the_distance_stays_in_the_enclosures(displaced: int) -> None:
    chain = ExactChain.from_slider()
    reach = fraction(Proof(chain, Fraction(1), False, AT_REST, COARSE_BITS, Fraction(1)).least_distance)
    positions = start_at_distance(chain, displaced, CLOSE_TO_REACH * reach)
    closest = Fraction(0)
    pairs = zip(proofs(chain, AT_ZERO, 60, COARSE_BITS), proofs(chain, positions, 60, 300), strict=True)
    for (coarse, onset), (fine, fine_onset) in pairs:
        one, other = coarse.transitions[-1], fine.transitions[-1]
        assert (one.block, one.mode) == (other.block, other.mode)
        with ctx.workprec(300):
            shift = (coarse.clock - onset - fine.clock + fine_onset).mid()
        assert abs(fraction(shift)) <= fraction((coarse.unit * coarse.gap).upper()) + CLOCK_ROUNDING
        for ball, exact in ((one.time, other.time), (one.tangential_load, other.tangential_load)):
            distance = abs(fraction(ball.mid()) - fraction(exact.mid()))
            assert distance <= fraction(ball.rad())
            closest = max(closest, distance / fraction(ball.rad()))
    # The enclosures are no wider than they must be, so the test would see narrower ones.
    assert closest > Fraction(2, 3)


def test_radii_that_are_absorbed_count_in_the_norm_of_the_energy() -> None:
    """sum T_i^2 / c_i + u_i^2, here of one force in each spring and one rate; the drive's spring is soft."""
    *_, (proof, _) = proofs(ExactChain.from_slider(), AT_ZERO, 5, 256)
    with ctx.workprec(256):
        constants, state = proof.constants(256), copy.copy(proof.state)
        assert constants.coupling[1] < constants.coupling[2] / 10
        for i in range(1, 11):
            force, rate = [list(state.force) for _ in range(2)]
            force[i], rate[i] = force[i] + arb(0, 3e-9), rate[i] + arb(0, 1e-10)
            before = state.distance
            state.absorb(constants, force, rate)
            added = float((state.distance - before).mid())
            assert added == pytest.approx(math.hypot(3e-9 / float(constants.coupling[i]) ** 0.5, 1e-10))


@pytest.mark.parametrize("span", [0.25, 1.0, 1.125])
@pytest.mark.parametrize("derivative", [0, 1, 2])
def test_the_taylor_remainder_is_within_its_bound(derivative: int, span: float) -> None:
    *_, (proof, _) = proofs(ExactChain.from_slider(theta="-5/6"), AT_ZERO, 45, 256)
    assert sum(map(bool, proof.state.mode)) > 2
    with ctx.workprec(256):
        constants = proof.constants(256)
        short, long = (expand(constants, proof.state, order) for order in (14, 80))
        bound = tail(constants, short, arb(span), derivative)
        largest = Fraction(0)
        for i, row in short.items():
            rest = arb_poly([0] * len(row) + long[i][len(row) :])
            for _ in range(derivative):
                rest = rest.derivative()
            largest = max(largest, *(abs(fraction(rest(arb(t)).mid())) for t in (-span, span)))
    assert largest <= fraction(bound) < 20 * largest


@pytest.mark.parametrize("derivative", [0, 1, 2])
@pytest.mark.parametrize("last", [6, 9])
def test_the_bound_of_the_remainder_is_its_first_term_where_one_block_oscillates(last, derivative) -> None:
    """u'' = -omega^2 u: of every other coefficient 0, a_{n+2} = omega^2 a_n / ((n + 1)(n + 2)) in size."""
    omega2, span = Fraction(4), Fraction(1, 1000)
    constants, series = SimpleNamespace(frequency_squared=arb(4)), {1: [arb(0)] * (last + 1)}
    series[1][last - 1] = arb(1)
    bound = fraction(tail(constants, series, arb(1) / 1000, derivative))  # type: ignore[arg-type]
    first = omega2 / (last * (last + 1)) * math.perm(last + 1, derivative) * span ** (last + 1 - derivative)
    assert first <= bound < (1 + 4 * omega2 * span**2) * first


@pytest.mark.parametrize(("span", "bits"), [(0.0, 64), (0.1, 64), (1.0, 20), (1.0, 64), (1.125, 500)])
def test_the_order_is_the_first_even_one_whose_term_is_small_enough(span: float, bits: int) -> None:
    """No frequency is above 2 / T, so that a term of order n is at most (2 span)^n / n!, of the largest."""
    enough = [n for n in range(6, 200, 2) if Fraction(2 * span) ** n * 2**bits <= math.factorial(n)]
    assert order_for(span, bits) == enough[0]


@pytest.mark.parametrize("slider", [{}, {"drive_stiffness": "4e9"}, {"n_blocks": 1}, {"slider_mass": "1e-9"}])
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
    chain = ExactChain.from_slider(n_blocks=3, theta="1/2")
    certificate = certify(chain, 20, width="1e-20")
    at_rest = ((Fraction(0),) * 3,) * 2
    proof = Proof(chain, Fraction(20), False, at_rest, certificate.bits, Fraction("1e-20"))
    radii = []
    for published, proved in zip(certificate.transitions, proof.run(), strict=True):
        for enclosure, ball in (
            (published.time, proved.time),
            (published.tangential_load, proved.tangential_load),
        ):
            radius = fraction(ball.rad())
            wrong = abs(enclosure.midpoint - fraction(ball.mid()))
            assert wrong + radius <= enclosure.radius <= Fraction(103, 100) * (radius + Fraction(1, 10**45))
            radii.append(float(radius))
    assert min(radii) < 1e-46
    assert max(radii) > 1e-36


def proofs(
    chain: ExactChain, positions: Sequence[Fraction], n: int, bits: int
) -> Iterator[tuple[Proof, arb]]:
    """Yield a proof after each of n transitions, and the onset of the event [s]."""
    proof = Proof(chain, Fraction(10), False, (tuple(positions), AT_ZERO), bits, Fraction(1))
    onset = proof.clock
    for i in range(n):
        while len(proof.transitions) <= i:
            if any(proof.state.mode):
                proof.slide()
            else:
                proof.load()
                onset = proof.clock
        yield snapshot(proof), onset


def snapshot(proof: Proof) -> Proof:
    """A proof that goes on by itself."""
    other = copy.copy(proof)
    other.state = dataclasses.replace(proof.state, mode=list(proof.state.mode))
    other.transitions = list(proof.transitions)
    return other


def start_at_distance(chain: ExactChain, displaced: int, distance: Fraction) -> list[Fraction]:
    """Positions with one block displaced, so that the spring forces are at a distance [N] from zero."""
    behind, ahead = (*chain.springs, Fraction(0))[displaced - 1 : displaced + 1]
    stiffness = Fraction(math.sqrt((behind + ahead) * chain.mass / time_unit(chain) ** 2))
    return [distance / stiffness * (i == displaced) for i in range(1, chain.n_blocks + 1)]


def fraction(x: arb) -> Fraction:
    mantissa, exponent = x.man_exp()
    return Fraction(int(mantissa)) * Fraction(2) ** int(exponent)


def test_a_transition_at_the_very_end_of_the_run_is_not_decided_by_luck() -> None:
    certificate = certify(ExactChain.from_slider(), "0.35", max_bits=512)
    assert certificate.transitions == ()
    assert certificate.tie is not None
    assert certificate.tie.time.contains("0.35")


def test_a_block_that_only_touches_standstill_is_a_tie() -> None:
    case = read_held_out()["grazing"][0]
    certificate = certify(exact_chain(case), case.duration, max_bits=512)
    assert [(t.block, t.mode) for t in certificate.transitions] == [(1, 1)]
    assert certificate.tie is not None
    assert certificate.tie.question == "whether block 1 stops"


def test_a_stop_at_the_very_end_of_a_window_is_proved() -> None:
    """v = V + (v_0 - V) cos(omega t) - mu_k w / (m omega) sin(omega t) of one block is zero after one T."""
    chain = ExactChain.from_slider(n_blocks=1)
    end = time_unit(chain)
    with mpmath.workdps(70):
        drive, mass, stiffness, friction = (
            mpmath.mpf(x.numerator) / x.denominator
            for x in (chain.drive_velocity, chain.mass, chain.drive_stiffness, chain.mu_k * chain.weights[0])
        )
        omega = mpmath.sqrt(stiffness / mass)
        phase = omega * end.numerator / end.denominator
        start = drive + (friction / (mass * omega) * mpmath.sin(phase) - drive) / mpmath.cos(phase)
        certificate = certify(chain, 1, start_velocities=[mpmath.nstr(start, 60)])
    moves, stops, *_ = certificate.transitions
    assert (moves.time.upper, stops.mode) == (0, 0)
    assert stops.time.contains(end)


def test_too_few_bits_are_an_error_and_no_tie() -> None:
    with pytest.raises(CertificateError, match="max_bits = 256 do not suffice beyond t = "):
        certify(ExactChain.from_slider(), 10, max_bits=256)
