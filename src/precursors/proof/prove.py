"""Make certificates and verify them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from decimal import ROUND_CEILING, ROUND_FLOOR, Context
from fractions import Fraction
from typing import TYPE_CHECKING

from precursors.model.chain import Chain
from precursors.model.checks import Until, checked_until, whole
from precursors.proof.certificate import (
    MOST_BITS,
    Certificate,
    CertificateError,
    CertifiedTransition,
    Enclosure,
    Tie,
)
from precursors.proof.exact_chain import (
    ExactChain,
    Number,
    as_decimal,
    exact,
    exact_start,
)
from precursors.support.files import AnyPath

if TYPE_CHECKING:
    from flint import arb

    from precursors.proof.event_roots import Undecided
    from precursors.proof.tube import Proof

FIRST_BITS = 256
MAX_BITS = 4096
WIDTH = "1e-40"
# Largest number of decimals of a midpoint; it has fewer if its radius is wide.
DECIMALS = 45
# Radii are enlarged by this factor, so that a version of the ball arithmetic that rounds
# differently still verifies a certificate.
SPARE = Fraction(101, 100)
# Radii are rounded up to three digits, with a few more decimals than midpoints.
ROUND_UP = Context(prec=3, Emin=-DECIMALS, rounding=ROUND_CEILING)
# Slopes are reduced by this factor for the same reason, and rounded down to four
# digits.
SPARE_OF_SLOPE = 1 - Fraction(1, 10**6)
ROUND_DOWN = Context(prec=4, rounding=ROUND_FLOOR)


def certify(
    chain: ExactChain | Chain,
    duration: Number = 10,
    until: Until = None,
    start_positions: Sequence[Number] | None = None,
    width: Number = WIDTH,
    max_bits: int = MAX_BITS,
    start_velocities: Sequence[Number] | None = None,
) -> Certificate:
    """Prove the transitions of a chain (Eqs. 2-6), in ball arithmetic on exact
    parameters.

    The proof is repeated with twice the bits until it is complete.

    Parameters
    ----------
    chain : ExactChain or Chain
        Exact parameters; the doubles of a `Chain` are used exactly.
    duration : number
        Length of the proved motion [s]; numbers are read as written, such as "1/3".
    until : "global slip", optional
        Stop at the end of the first event in which all blocks slide at the same
        instant.
    start_positions, start_velocities : sequences of N numbers, optional
        State at time 0 [m, m/s]; zero by default.
    width : number
        Largest radius of a time [s].
    max_bits : int
        Largest working precision. The proof ends with a tie at a question that stays
        undecided, if its time is known within `width`.

    Returns
    -------
    Certificate
        The proved transitions, and the tie if there is one.

    Raises
    ------
    TypeError, ValueError
        If `chain` is not a chain, or another argument is out of range.
    CertificateError
        If `max_bits` is too small for enclosures of `width`.
    ModuleNotFoundError
        If python-flint is not installed.
    """
    exact_chain = ExactChain.from_chain(chain) if isinstance(chain, Chain) else chain
    if not isinstance(exact_chain, ExactChain):
        raise TypeError(f"certify needs a chain, but got {type(chain).__name__}")
    limit = exact("duration", duration)
    widest = exact("width", width)
    for name, value in (("duration", limit), ("width", widest)):
        if value <= 0:
            raise ValueError(f"{name} must be above 0 s, but is {value} s")
    start = (
        exact_start("start_positions", exact_chain, start_positions, "m"),
        exact_start("start_velocities", exact_chain, start_velocities, "m/s"),
    )
    until = checked_until(until)
    max_bits = whole("max_bits", max_bits, MOST_BITS)
    bits = min(FIRST_BITS, max_bits)
    while True:
        certificate = Certificate(
            exact_chain, limit, until, *start, widest, (), None, bits
        )
        proof, failure = _prove(certificate)
        if failure is None or bits == max_bits:
            break
        bits = min(2 * bits, max_bits)
    if failure and 2 * _fraction(failure.time.rad()) > widest:
        raise CertificateError(
            f"max_bits = {max_bits} are too few beyond t = {float(failure.time):.9g} s of "
            f"{float(limit):g} s ({failure.question}): allow more, or prove a shorter duration"
        )
    tie = _tie(failure) if failure else None
    transitions = tuple(
        CertifiedTransition(
            _rounded(_enclosure_of(t.time)),
            t.block,
            t.mode,
            _rounded(_enclosure_of(t.tangential_load)),
            _rounded_down(t.slope),
        )
        for t in proof.transitions
    )
    return replace(certificate, transitions=transitions, tie=tie)


def verify(certificate: Certificate | AnyPath) -> Certificate:
    """Repeat the proof of a certificate, or of its file, and return the certificate.

    The proof uses the recorded bits. Each recorded enclosure must contain the proved
    one.

    Raises
    ------
    CertificateError
        If the certificate differs from its proof; the message says where.
    OSError
        If the file cannot be read.
    ModuleNotFoundError
        If python-flint is not installed.
    """
    if not isinstance(certificate, Certificate):
        certificate = Certificate.load(certificate)
    for difference in _differences(certificate):
        raise CertificateError(
            f"it differs from the proof with {certificate.bits} bits: {difference}"
        )
    return certificate


def _prove(certificate: Certificate) -> tuple[Proof, Undecided | None]:
    """Prove the transitions of a certificate's chain with its bits; return the proof and
    the question at which it stopped early, if any."""
    try:
        from precursors.proof.event_roots import Undecided
        from precursors.proof.tube import Proof
    except ModuleNotFoundError as error:
        if error.name != "flint":
            raise
        raise ModuleNotFoundError(
            'a proof needs python-flint: pip install "precursors[proof]"'
        ) from error
    proof = Proof(certificate)
    try:
        proof.run()
    except Undecided as failure:
        return proof, failure
    return proof, None


def _tie(failure: Undecided) -> Tie:
    time = _enclosure_of(failure.time)
    return Tie(
        _rounded(time),
        failure.blocks,
        failure.question,
        Fraction(as_decimal(2 * time.radius, ROUND_UP)),
    )


def _differences(certificate: Certificate) -> Iterator[str]:
    """Describe each difference between a certificate and its proof."""
    proof, failure = _prove(certificate)
    for number, (stated, proved) in enumerate(
        zip(certificate.transitions, proof.transitions, strict=False), 1
    ):
        where = f"transition {number}, t = {float(proved.time):.9g} s"
        if (stated.block, stated.mode) != (proved.block, proved.mode):
            change = f"block {proved.block} goes to mode {proved.mode:+d}"
            yield f"{where}: {change}, which differs from the certificate"
        if not stated.time.contains(_enclosure_of(proved.time)):
            yield f"{where}: its time is not proved within {float(stated.time.radius):.3g} s"
        if not stated.tangential_load.contains(_enclosure_of(proved.tangential_load)):
            yield f"{where}: its load is not proved within {float(stated.tangential_load.radius):.3g} N"
        if stated.slope > _enclosure_of(proved.slope).lower:
            yield f"{where}: a slope of {float(stated.slope):.3g} is not proved"
    if len(certificate.transitions) != len(proof.transitions):
        yield f"{len(certificate.transitions)} transitions instead of {len(proof.transitions)}"
    blocks = certificate.tie.blocks if certificate.tie else "none"
    if blocks != (tied := failure.blocks if failure else "none"):
        yield f"a tie of blocks {blocks} instead of {tied}"
    if (
        certificate.tie
        and failure
        and not certificate.tie.time.contains(_enclosure_of(failure.time))
    ):
        yield f"the tie is at t = {float(failure.time):.9g} s"


def _rounded_down(slope: arb) -> Fraction:
    """Round a slope down to four decimal digits."""
    least = _enclosure_of(slope).lower * SPARE_OF_SLOPE
    return Fraction(as_decimal(least, ROUND_DOWN))


def _enclosure_of(ball: arb) -> Enclosure:
    return Enclosure(_fraction(ball.mid()), _fraction(ball.rad()))


def _fraction(x: arb) -> Fraction:
    mantissa, exponent = x.man_exp()
    return Fraction(int(mantissa)) * Fraction(2) ** int(exponent)


def _rounded(enclosure: Enclosure) -> Enclosure:
    """Round an enclosure outward to decimal numbers."""
    # 10^-decimals is at most a hundredth of the radius, unless DECIMALS limits it.
    digit = as_decimal(enclosure.radius, ROUND_UP).adjusted()
    decimals = min(DECIMALS, max(0, 2 - digit)) if enclosure.radius else DECIMALS
    midpoint = round(enclosure.midpoint, decimals)
    radius = (abs(midpoint - enclosure.midpoint) + enclosure.radius) * SPARE
    return Enclosure(midpoint, Fraction(as_decimal(radius, ROUND_UP)))
