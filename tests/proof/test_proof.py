"""Proofs agree with closed forms, with the solver in double precision, and with runs
that start slightly apart."""

import math
from collections.abc import Iterator, Sequence
from fractions import Fraction
from types import SimpleNamespace
from typing import Any

import mpmath
import numpy as np
import pytest
from benchmark.made_up import (
    SYMMETRIC_START,
    go_on,
    has_all_transitions,
    proof_of,
    tied_certificate,
)
from chains import SLIDER
from flint import arb, ctx

from precursors import simulate
from precursors.benchmark.compare import Truth, compare
from precursors.proof import (
    Certificate,
    CertificateError,
    Enclosure,
    ExactChain,
    certify,
    verify,
)
from precursors.proof.motion import EnclosedState, tail, time_unit
from precursors.proof.tube import Proof

# Largest radii of enclosures [s, N].
TIME_RADIUS = Fraction(1, 10**40)
LOAD_RADIUS = Fraction(1, 10**35)
# Errors of the solver up to the first global slip [s].
SOLVER = 1e-12
# Few bits, so that enclosures are wide, and a start near the edge of the one at time 0.
COARSE_BITS = 128
CLOSE_TO_REACH = Fraction(99, 100)
# Rounding of clocks of 300 bits [s].
CLOCK_ROUNDING = Fraction(1, 2**280)


def exactly(x: Fraction) -> Enclosure:
    return Enclosure(x, Fraction(0))


def assert_holds(enclosure: Enclosure, value: mpmath.mpf) -> None:
    assert abs(digits(enclosure.midpoint) - value) <= digits(enclosure.radius)


def digits(x: Fraction) -> mpmath.mpf:
    return mpmath.mpf(x.numerator) / x.denominator


@pytest.mark.parametrize("slider", [{"theta": "-5/6"}, {"n_blocks": 1}])
def test_first_slip_is_that_of_a_loaded_oscillator(slider):
    """m x'' = drop + K V t - stiffness x from rest at x = 0, as in `chains.lone_slip`."""
    chain = ExactChain.from_slider(**slider)
    rate = chain.drive_stiffness * chain.drive_velocity
    onset = chain.mu_s * chain.weights[0] / rate
    release, stop = certify(chain, onset + Fraction(1, 1000)).transitions[:2]
    stiffness = chain.drive_stiffness + (
        chain.stiffness if len(chain.weights) > 1 else 0
    )
    with mpmath.workdps(60):
        drop = digits((chain.mu_s - chain.mu_k) * chain.weights[0])
        omega = mpmath.sqrt(digits(stiffness / chain.mass))
        swing = 2 * mpmath.atan(digits(rate) / (drop * omega))
        seconds = (mpmath.pi + swing) / omega
        slip = (2 * drop + digits(rate) * seconds) / digits(stiffness)
        assert_holds(release.time, digits(onset))
        assert_holds(release.tangential_load, digits(rate * onset))
        assert_holds(stop.time, digits(onset) + seconds)
        load = digits(rate) * (digits(onset) + seconds)
        assert_holds(stop.tangential_load, load - digits(chain.drive_stiffness) * slip)
    assert (release.block, release.mode, stop.block, stop.mode) == (1, 1, 1, 0)
    assert stop.time.radius <= TIME_RADIUS
    assert stop.tangential_load.radius <= LOAD_RADIUS


@pytest.mark.parametrize("theta", ["-5/6", "5/6", "-1"])
def test_proof_agrees_with_the_solver_up_to_the_global_slip(theta):
    """At theta = -1, the last block bears no load."""
    chain = ExactChain.from_slider(theta=theta)
    truth = Truth.proved(certify(chain, 10, until="global slip"))
    comparison = compare(simulate(chain.to_chain(), until="global slip"), truth)
    assert has_all_transitions(comparison)
    assert comparison.time_error < SOLVER


def test_proof_ends_when_all_blocks_with_load_have_slipped():
    """A block with a millionth of the mean load still slides then."""
    weights = np.full(5, 80.0)
    weights[4] = 1e-6 * 80.0
    chain = SLIDER(weights=weights)
    run = simulate(chain, until="global slip")
    truth = Truth.proved(certify(chain, 10, until="global slip"))
    assert truth.run.duration == pytest.approx(run.duration, abs=SOLVER)
    assert has_all_transitions(compare(run, truth))


def test_doubles_of_a_chain_are_taken_exactly():
    certificate = certify(ExactChain.from_slider(n_blocks=3).to_chain(), 2)
    assert certificate.chain.mu_s == Fraction(0.7) != Fraction(7, 10)
    assert certificate.transitions[0].tangential_load.contains(
        exactly(Fraction(0.7) * Fraction(400 / 3))
    )


def test_mirror_symmetric_start_is_a_tie():
    certificate = tied_certificate()
    assert [(t.time, t.block, t.mode) for t in certificate.transitions] == [
        (exactly(Fraction(0)), i, mode) for i, mode in ((3, 1), (4, -1), (5, 1))
    ]
    tie = certificate.tie
    assert tie
    assert tie.blocks == (2, 6)
    assert tie.closeness < Fraction(1, 10**45)
    assert certificate.proved_until < certificate.duration
    verify(certificate)


def test_stop_exactly_at_the_limit_is_a_tie():
    # Without loss its net force is mu_s w again, where it stops.
    chain = ExactChain.from_slider(2, theta="0.5", mu_k=0)
    tie = certify(chain, 1).tie
    assert tie
    assert tie.question == "whether block 1 sticks or turns round"
    assert tie.closeness < Fraction(1, 10**45)


def test_near_tie_is_decided_with_more_bits():
    # Block 2 carries less than block 6, by one part in 1e100, and lets go first.
    chain = ExactChain.from_slider(n_blocks=7, theta="1e-100")
    certificate = certify(chain, "1e-5", start_positions=SYMMETRIC_START)
    assert certificate.tie is None
    assert certificate.bits == 512
    assert [(t.block, t.mode) for t in certificate.transitions[3:5]] == [(2, 1), (6, 1)]


@pytest.mark.parametrize("displaced", [1, 2])
def test_run_started_within_the_distance_stays_enclosed(displaced):
    chain = ExactChain.from_slider()
    reach = fraction(proof_of(chain, COARSE_BITS).state.distance)
    # The displacement of one block puts the spring forces almost at this distance [N].
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
        one = coarse.transitions[-1]
        other = fine.transitions[-1]
        assert (one.block, one.mode) == (other.block, other.mode)
        with ctx.workprec(300):
            shift = (coarse.clock - onset - fine.clock + fine_onset).mid()
        assert (
            abs(fraction(shift))
            <= fraction((coarse.unit * coarse.gap).upper()) + CLOCK_ROUNDING
        )
        for name in ("time", "tangential_load"):
            ball = getattr(one, name)
            distance = abs(fraction(ball.mid()) - fraction(getattr(other, name).mid()))
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


def test_absorbed_radii_are_measured_in_the_energy_norm():
    """The norm is sum T_i^2 / c_i + u_i^2, here for two blocks."""
    constants: Any = SimpleNamespace(coupling=[arb(c) for c in (0, 0.25, 4, 0)])
    state = EnclosedState([], [], [0] * 4, arb(1))
    forces = [arb(0), arb(5, 3), arb(6, 4), arb(0)]
    rates = [arb(0), arb(7, 5), arb(8, 6), arb(0)]
    state.absorb(constants, forces, rates)
    expected = 1 + math.sqrt(9 / 0.25 + 16 / 4 + 25 + 36)
    assert float(state.distance) == pytest.approx(expected)


@pytest.mark.parametrize(("last", "derivative"), [(9, 1), (6, 2)])
def test_bound_of_the_remainder_is_close_to_its_first_terms(last, derivative):
    """With u'' = -omega^2 u, every other coefficient is 0, and |a_{n+2}| = omega^2 |a_n|
    / ((n + 1)(n + 2))."""
    omega2 = Fraction(4)
    span = Fraction(1, 1000)
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


def test_certificate_encloses_the_proof_and_is_hardly_wider():
    certificate = certify(
        ExactChain.from_slider(n_blocks=3, theta="1/2"), 20, width="1e-20"
    )
    radii = []
    for published, proved in zip(
        certificate.transitions, Proof(certificate).run(), strict=True
    ):
        for name in ("time", "tangential_load"):
            enclosure = getattr(published, name)
            ball = getattr(proved, name)
            radius = fraction(ball.rad())
            # Radii are enlarged by 1 %; rounding to three digits adds less than 1 %.
            spare = Fraction(101, 100)
            least = spare * (radius + abs(enclosure.midpoint - fraction(ball.mid())))
            assert least <= enclosure.radius <= spare * least + Fraction(1, 10**47)
            digits = min(45, 2 - math.floor(math.log10(radius)))
            assert (enclosure.midpoint * 10**digits).denominator == 1
            radii.append(float(radius))
    assert min(radii) < 1e-46
    assert max(radii) > 1e-36


def test_transition_exactly_at_the_end_of_the_run_is_a_tie():
    certificate = certify(ExactChain.from_slider(), "0.35", max_bits=512)
    assert certificate.transitions == ()
    assert certificate.tie
    assert certificate.tie.time.contains(exactly(Fraction("0.35")))


def lone_block(excess: str) -> Certificate:
    """Prove part of a cycle of one block without friction that starts at 2 V (1 +
    excess).

    Its speed is V + (1 + 2 excess) V cos(omega t): at excess = 0 it only touches zero.
    """
    chain = ExactChain.from_slider(n_blocks=1, mu_s=0, mu_k=0)
    start = 2 * chain.drive_velocity * (1 + Fraction(excess))
    return certify(chain, 6 * time_unit(chain), start_velocities=[start], max_bits=512)


def test_motion_that_grazes_its_limit_is_a_tie():
    grazing = lone_block("0")
    assert [t.mode for t in grazing.transitions] == [1]
    assert grazing.tie
    assert grazing.tie.question == "whether block 1 stops"


@pytest.mark.parametrize("excess", ["1", "1e-12"])
def test_least_slope_of_a_turn_is_close_to_the_true_one(excess):
    turned = lone_block(excess)
    chain = turned.chain
    assert [t.mode for t in turned.transitions[:2]] == [1, -1]
    # sqrt((1 + 2 excess)^2 - 1) without a difference of nearly equal numbers
    sine = 2 * math.sqrt(float(excess) * (1 + float(excess)))
    omega = math.sqrt(chain.drive_stiffness / chain.mass)
    expected = float(chain.drive_velocity) * omega * sine
    slope = float(turned.transitions[1].slope)
    assert 0.9989 * expected < slope < expected


def test_block_1_is_released_at_the_rate_of_the_drive():
    (release,) = certify(ExactChain.from_slider(), "0.36").transitions[:1]
    assert 0.999 * 80 < release.slope < 80  # K V [N/s], from rest


def test_too_few_bits_are_an_error_and_not_a_tie():
    with pytest.raises(
        CertificateError, match="max_bits = 128 are too few beyond t = "
    ):
        certify(ExactChain.from_slider(), 3, max_bits=128)
