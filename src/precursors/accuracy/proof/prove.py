"""Making proofs and certificates, and verifying them."""

from __future__ import annotations

import math
import os
from collections.abc import Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING

from precursors.accuracy.proof.certificate import (
    Certificate,
    CertificateError,
    CertifiedTransition,
    Enclosure,
    Tie,
)
from precursors.accuracy.proof.exact_chain import ExactChain, Number, exact, exact_start
from precursors.model.chain import Chain
from precursors.model.checks import Until, checked_until

if TYPE_CHECKING:
    from flint import arb

    from precursors.accuracy.proof.event_roots import Undecided
    from precursors.accuracy.proof.tube import Proof

FIRST_BITS = 256
MAX_BITS = 4096
WIDTH = "1e-40"
# More bits are lost in later seconds, where more blocks slide at once.
MARGIN = 1.4
# Midpoints are written with at most so many decimals, and no more than their radius deserves.
DECIMALS = 45
# A radius is written with this to spare, for a version of the ball arithmetic that rounds otherwise.
SPARE = Fraction(101, 100)


def certify(
    chain: ExactChain | Chain,
    duration: Number = 10,
    until: Until = None,
    start_positions: Sequence[Number] | None = None,
    width: Number = WIDTH,
    max_bits: int = MAX_BITS,
    start_velocities: Sequence[Number] | None = None,
) -> Certificate:
    """Prove the transitions of a chain (Eqs. 2-6), in ball arithmetic on exact parameters.

    The proof is begun again with more bits until it is complete.

    Parameters
    ----------
    chain : ExactChain or Chain
        Exact parameters; the doubles of a `Chain` are taken for exactly what they are.
    duration : number
        Time to prove [s]; numbers are taken as they are written, "1/3" is a third.
    until : "global slip", optional
        Stop at the end of the first event in which all blocks slide at the same instant.
    start_positions : sequence of N numbers, optional
        Positions at time 0 [m]; zero, springs at natural length, by default.
    width : number
        Largest radius of a time [s].
    max_bits : int
        Largest working precision; a proof that is undecided there within `width` is a tie.
    start_velocities : sequence of N numbers, optional
        Velocities at time 0 [m/s]; zero by default.

    Raises
    ------
    TypeError, ValueError
        If `chain` is no chain, or another argument is out of range.
    CertificateError
        If `max_bits` do not suffice for enclosures of `width`.
    ModuleNotFoundError
        If python-flint is not installed.
    """
    exact_chain = ExactChain.from_chain(chain) if isinstance(chain, Chain) else chain
    if not isinstance(exact_chain, ExactChain):
        raise TypeError(f"what is proved must be a chain, but is {type(chain).__name__}")
    limit, widest = exact("duration", duration), exact("width", width)
    for name, value in (("duration", limit), ("width", widest)):
        if value <= 0:
            raise ValueError(f"{name} must be above 0 s, but is {value} s")
    start = (
        exact_start("start_positions", exact_chain, start_positions, "m"),
        exact_start("start_velocities", exact_chain, start_velocities, "m/s"),
    )
    certificate = Certificate(exact_chain, limit, checked_until(until), *start, widest)
    bits, restarts = FIRST_BITS, 0
    while True:
        proof, failure = _prove(certificate, bits)
        if failure is None or bits >= max_bits:
            break
        restarts += 1
        bits = min(_more_bits(proof, failure, limit), max_bits)
    tie = _tie(failure) if failure else None
    if tie and tie.closeness > widest:
        raise CertificateError(
            f"max_bits = {max_bits} do not suffice beyond t = {float(tie.time.midpoint):.9g} s of "
            f"{float(limit):g} s ({tie.question}): allow more, or prove a shorter duration"
        )
    return replace(certificate, transitions=_published(proof), tie=tie, bits=bits, restarts=restarts)


def verify(certificate: Certificate | str | os.PathLike[str]) -> Certificate:
    """Make the proof of a certificate, or of the file of one, again; return the certificate.

    The proof is made at the certificate's precision. Each recorded enclosure must contain the proved one.

    Raises
    ------
    CertificateError
        If the certificate is not what is proved; the message says where.
    OSError
        If the file cannot be read.
    ModuleNotFoundError
        If python-flint is not installed.
    """
    if not isinstance(certificate, Certificate):
        certificate = Certificate.load(certificate)
    for difference in _differences(certificate):
        raise CertificateError(f"not what is proved with {certificate.bits} bits: {difference}")
    return certificate


def _prove(certificate: Certificate, bits: int) -> tuple[Proof, Undecided | None]:
    """Run the proof of a certificate's chain with so many bits; return it and why it stopped short, if so."""
    try:
        from precursors.accuracy.proof.event_roots import Undecided
        from precursors.accuracy.proof.tube import Proof
    except ModuleNotFoundError as error:
        if error.name != "flint":
            raise
        raise ModuleNotFoundError('a proof needs python-flint: pip install "precursors[proof]"') from error
    proof = Proof(
        certificate.chain,
        certificate.duration,
        certificate.until is not None,
        (certificate.start_positions, certificate.start_velocities),
        bits,
        certificate.width,
    )
    try:
        proof.run()
    except Undecided as failure:
        return proof, failure
    return proof, None


def _more_bits(proof: Proof, failure: Undecided, duration: Fraction) -> int:
    """Bits to try next, if bits go on being lost per second as they were up to the failure."""
    lost, bits = proof.lost_bits(), proof.bits
    left_to_do = float(duration) / max(float(failure.time), 0.05 * float(duration)) - 1
    if lost < bits // 4:
        return 2 * bits
    return min(4 * bits, max(bits + bits // 4, bits + math.ceil(MARGIN * lost * left_to_do)))


def _published(proof: Proof) -> tuple[CertifiedTransition, ...]:
    """Round the balls of a proof outward to decimal numbers."""
    return tuple(
        CertifiedTransition(
            _rounded(_enclosure_of(t.time)), t.block, t.mode, _rounded(_enclosure_of(t.tangential_load))
        )
        for t in proof.transitions
    )


def _tie(failure: Undecided) -> Tie:
    time = _enclosure_of(failure.time)
    return Tie(_rounded(time), failure.blocks, failure.question, _round_up(2 * time.radius))


def _differences(certificate: Certificate) -> Iterator[str]:
    """Where a certificate is not what its proof gives."""
    proof, failure = _prove(certificate, certificate.bits)
    for number, (said, proved) in enumerate(zip(certificate.transitions, proof.transitions, strict=False), 1):
        where = f"transition {number}, t = {float(proved.time):.9g} s"
        if (said.block, said.mode) != (proved.block, proved.mode):
            yield f"{where}: block {proved.block} goes to mode {proved.mode:+d}, which is not what is stated"
        if not said.time.contains(_enclosure_of(proved.time)):
            yield f"{where}: its time is not proved within {float(said.time.radius):.3g} s"
        if not said.tangential_load.contains(_enclosure_of(proved.tangential_load)):
            yield f"{where}: its load is not proved within {float(said.tangential_load.radius):.3g} N"
    if len(certificate.transitions) != len(proof.transitions):
        yield f"{len(certificate.transitions)} transitions instead of {len(proof.transitions)}"
    if (certificate.tie is None) != (failure is None):
        yield "a tie is stated but not found, or found but not stated"
    tie = certificate.tie
    if (
        tie
        and failure
        and not (tie.blocks == failure.blocks and tie.time.contains(_enclosure_of(failure.time)))
    ):
        yield f"the tie is at t = {float(failure.time):.9g} s, blocks {failure.blocks}"


def _enclosure_of(ball: arb) -> Enclosure:
    return Enclosure(_fraction(ball.mid()), _fraction(ball.rad()))


def _fraction(x: arb) -> Fraction:
    mantissa, exponent = x.man_exp()
    return Fraction(int(mantissa)) * Fraction(2) ** int(exponent)


def _rounded(enclosure: Enclosure) -> Enclosure:
    """Round an enclosure outward to one of decimal numbers."""
    decimals = DECIMALS
    if enclosure.radius:
        # 10^-decimals is at most a hundredth of the radius, or at the least decimals that are written
        decimals = min(DECIMALS, max(0, 3 - _magnitude(enclosure.radius)))
    midpoint = round(enclosure.midpoint, decimals)
    return Enclosure(midpoint, _round_up((abs(midpoint - enclosure.midpoint) + enclosure.radius) * SPARE))


def _magnitude(x: Fraction) -> int:
    """An integer within one of log10 of x > 0, however large or small; -1 for 0."""
    return math.floor((x.numerator.bit_length() - x.denominator.bit_length()) * math.log10(2))


def _round_up(x: Fraction) -> Fraction:
    """Round a number that is not negative up to about three digits."""
    unit = Fraction(10) ** (_magnitude(x) - 2)
    return math.ceil(x / unit) * unit
