"""Certificates: what is proved of a run, as data that anyone can read, check and prove again.

The checksum tells that a file is the one that was written, not who wrote it: one may alter a certificate and
give it the checksum of what it then holds. What is consistent is then accepted by `verify`, unless it makes
the proof again (`recompute`); what it accepts in that way is true, whoever wrote it.
"""

from __future__ import annotations

import gzip
import hashlib
import json
import math
import os
import zlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from decimal import Context, Decimal, Inexact
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from precursors.accuracy.proof.exact_chain import ExactChain, Number, exact, exact_positions
from precursors.model.chain import Chain, Until, checked_until, whole, written_fraction
from precursors.support.files import write_whole

if TYPE_CHECKING:
    from flint import arb

    from precursors.accuracy.proof.tube import Proof, Unproved

FORMAT = "precursors certificate 1"
CLAIM = (
    "Every run of the model with these exact parameters has exactly the transitions listed, in this order, "
    "up to duration_s or, if there is a tie, up to the tie. Each time and each tangential load lies within "
    "its radius of its midpoint. A row is time_s, radius, block, mode (+1, 0, -1), tangential_load_N, radius."
)
FIRST_BITS = 256
MAX_BITS = 4096
WIDTH = "1e-40"
# More bits are lost in later seconds, where more blocks slide at once.
MARGIN = 1.4
# Midpoints are written with at most so many decimals, and no more than their radius deserves.
DECIMALS = 45
EXACT = Context(prec=1000, traps=[Inexact])
# A radius is written with this to spare, for a version of the ball arithmetic that rounds otherwise.
SPARE = Fraction(101, 100)


class CertificateError(ValueError):
    """A certificate that is altered, cannot be read, does not hold, or cannot be had."""


class Enclosure(NamedTuple):
    """A number known to lie within `radius` of `midpoint`."""

    midpoint: Fraction
    radius: Fraction

    @property
    def lower(self) -> Fraction:
        """Least value."""
        return self.midpoint - self.radius

    @property
    def upper(self) -> Fraction:
        """Largest value."""
        return self.midpoint + self.radius

    def contains(self, other: Enclosure | Number) -> bool:
        """Whether a number, or every number of another enclosure, lies inside."""
        if not isinstance(other, Enclosure):
            other = Enclosure(Fraction(other), Fraction(0))
        return self.lower <= other.lower and other.upper <= self.upper


class CertifiedTransition(NamedTuple):
    """A change of one block's state: time [s], block 1..N, mode +1 | 0 | -1, tangential load F_X [N]."""

    time: Enclosure
    block: int
    mode: int
    tangential_load: Enclosure


class Tie(NamedTuple):
    """Where a proof ends because instants cannot be told apart.

    Attributes
    ----------
    time : Enclosure
        When [s].
    blocks : tuple of int
        The blocks concerned.
    question : str
        What the proof could not decide.
    closeness : Fraction
        Length of the time within which it is undecided [s].
    """

    time: Enclosure
    blocks: tuple[int, ...]
    question: str
    closeness: Fraction


@dataclass(frozen=True)
class Certificate:
    """The transitions of a chain, proved.

    Attributes
    ----------
    chain : ExactChain
        The parameters.
    duration : Fraction
        Time [s] the certificate is about.
    until : "global slip" or None
        Whether it ends with the first event in which all blocks slide at the same instant.
    start_positions : tuple of Fraction, shape (N,)
        Positions at time 0 [m], all blocks at rest.
    transitions : tuple of CertifiedTransition
        All transitions in order.
    tie : Tie or None
        Where the proof ends before `duration`, because of a tie.
    bits : int
        Working precision at the start of the proof.
    width : Fraction
        No time has a radius above this [s].
    restarts : int
        How often the proof was begun again with more bits.
    sha256 : str
        Checksum of all of the above.
    """

    chain: ExactChain
    duration: Fraction
    until: Until
    start_positions: tuple[Fraction, ...]
    transitions: tuple[CertifiedTransition, ...]
    tie: Tie | None
    bits: int
    width: Fraction
    restarts: int = 0
    sha256: str = ""

    @property
    def proved_until(self) -> Fraction:
        """Time [s] up to which the transitions listed are proved to be all."""
        return self.tie.time.lower if self.tie else self.duration

    @property
    def widest(self) -> tuple[Fraction, Fraction]:
        """Largest radius of a time [s] and of a tangential load [N]."""
        times = [t.time.radius for t in self.transitions]
        loads = [t.tangential_load.radius for t in self.transitions]
        return max(times, default=Fraction(0)), max(loads, default=Fraction(0))

    def sealed(self) -> Certificate:
        """Return the certificate with the checksum of its content."""
        return replace(self, sha256=_checksum(self._content()))

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the certificate as JSON compressed with gzip, the same bytes for the same certificate.

        Raises
        ------
        OSError
            If the file cannot be written.
        """
        text = json.dumps({**self._content(), "sha256": self.sha256}, indent=0)
        with write_whole(path) as temporary:
            temporary.write_bytes(gzip.compress(text.encode(), mtime=0))

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Certificate:
        """Read a certificate and check its checksum.

        Raises
        ------
        OSError
            If the file cannot be read.
        CertificateError
            If it is no certificate, or not the one that was written.
        """
        raw = Path(path).read_bytes()
        try:
            text = json.loads(gzip.decompress(raw))
            if text["format"] != FORMAT:
                raise ValueError(f"format {text['format']!r}: known is {FORMAT!r}")
            certificate = cls._from_content(text)
        except (
            ValueError,
            KeyError,
            TypeError,
            AttributeError,
            EOFError,
            OSError,
            ZeroDivisionError,
            RecursionError,
            zlib.error,
        ) as error:
            raise CertificateError(
                f"{path} is not a whole certificate: {error or type(error).__name__}"
            ) from error
        if text.pop("sha256") != _checksum(text):
            raise CertificateError(f"{path} was altered: its content does not have the SHA-256 it states")
        return certificate

    def _content(self) -> dict[str, Any]:
        tie = self.tie
        return {
            "format": FORMAT,
            "claim": CLAIM,
            "chain": self.chain.as_text(),
            "start_positions_m": [str(x) for x in self.start_positions],
            "duration_s": str(self.duration),
            "until": self.until,
            "bits": self.bits,
            "width_s": str(self.width),
            "restarts": self.restarts,
            "tie": tie
            and {
                "time_s": _enclosure_text(tie.time),
                "blocks": list(tie.blocks),
                "question": tie.question,
                "closeness_s": _text(tie.closeness),
            },
            "transitions": [
                [*_enclosure_text(t.time), t.block, t.mode, *_enclosure_text(t.tangential_load)]
                for t in self.transitions
            ],
        }

    @classmethod
    def _from_content(cls, text: Mapping[str, Any]) -> Certificate:
        tie = text["tie"]
        chain = ExactChain.from_text(text["chain"])
        return cls(
            chain=chain,
            duration=written_fraction(text["duration_s"]),
            until=checked_until(text["until"]),
            start_positions=exact_positions(chain, text["start_positions_m"]),
            transitions=tuple(
                CertifiedTransition(_enclosure(*row[:2]), int(row[2]), int(row[3]), _enclosure(*row[4:]))
                for row in text["transitions"]
            ),
            tie=tie
            and Tie(
                _enclosure(*tie["time_s"]),
                tuple(tie["blocks"]),
                tie["question"],
                written_fraction(tie["closeness_s"]),
            ),
            bits=int(text["bits"]),
            width=written_fraction(text["width_s"]),
            restarts=int(text["restarts"]),
            sha256=str(text["sha256"]),
        )


def certify(
    chain: ExactChain | Chain,
    duration: Number = 10,
    until: Until = None,
    start_positions: Sequence[Number] | None = None,
    width: Number = WIDTH,
    max_bits: int = MAX_BITS,
) -> Certificate:
    """Prove the transitions of a chain from rest (Eqs. 2-6), in ball arithmetic on exact parameters.

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

    Raises
    ------
    ValueError
        If an argument is out of range.
    CertificateError
        If `max_bits` do not suffice for enclosures of `width`.
    ModuleNotFoundError
        If python-flint is not installed.
    """
    exact_chain = ExactChain.from_chain(chain) if isinstance(chain, Chain) else chain
    limit, widest = exact("duration", duration, "s"), exact("width", width, "s")
    for name, value in (("duration", limit), ("width", widest)):
        if value <= 0:
            raise ValueError(f"{name} = {value} [s] is out of range: allowed is {name} > 0")
    positions = exact_positions(exact_chain, start_positions)
    certificate = Certificate(exact_chain, limit, checked_until(until), positions, (), None, 0, widest)
    bits = min(FIRST_BITS, whole("max_bits", max_bits, at_least=FIRST_BITS))
    restarts = 0
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
    return replace(certificate, transitions=_published(proof), tie=tie, bits=bits, restarts=restarts).sealed()


def verify(certificate: Certificate | str | os.PathLike[str], recompute: bool = False) -> Certificate:
    """Check a certificate, or the file of one, and return it.

    Without `recompute`: the checksum, and what can be told from the enclosures alone: their widths and order,
    that every transition changes its block's state, that every event starts with block 1, and that the load
    grows at the rate K V between events. With it, the proof is made again at the certificate's precision,
    and each recorded enclosure must hold the one that is proved.

    Raises
    ------
    CertificateError
        If the certificate is refused; the message says why.
    OSError
        If the file cannot be read.
    ModuleNotFoundError
        If python-flint, which `recompute` needs, is not installed.
    """
    if not isinstance(certificate, Certificate):
        certificate = Certificate.load(certificate)
    if certificate.sha256 != certificate.sealed().sha256:
        raise CertificateError("altered: the content does not have the SHA-256 that is stated")
    for complaint in _inconsistencies(certificate):
        raise CertificateError(f"does not hold: {complaint}")
    if recompute:
        for complaint in _differences(certificate):
            raise CertificateError(f"not what is proved with {certificate.bits} bits: {complaint}")
    return certificate


def _prove(certificate: Certificate, bits: int) -> tuple[Proof, Unproved | None]:
    """Run the proof of a certificate's chain with so many bits; return it and why it stopped short, if so."""
    from precursors.accuracy.proof.tube import Proof, Unproved

    proof = Proof(
        certificate.chain,
        certificate.duration,
        certificate.until is not None,
        certificate.start_positions,
        bits,
        certificate.width,
    )
    try:
        proof.run()
    except Unproved as failure:
        return proof, failure
    return proof, None


def _more_bits(proof: Proof, failure: Unproved, duration: Fraction) -> int:
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


def _tie(failure: Unproved) -> Tie:
    time = _enclosure_of(failure.time)
    return Tie(_rounded(time), failure.blocks, failure.question, _round_up(2 * time.radius))


def _inconsistencies(certificate: Certificate) -> Iterator[str]:
    """What is wrong with the enclosures by themselves."""
    chain = certificate.chain
    loading_rate = chain.drive_stiffness * chain.drive_velocity
    end = certificate.tie.time.upper if certificate.tie else certificate.duration
    modes = [0] * chain.n_blocks
    before: CertifiedTransition | None = None
    for number, t in enumerate(certificate.transitions, 1):
        where = f"transition {number}, t = {float(t.time.midpoint):.9g} s"
        if not 1 <= t.block <= chain.n_blocks or t.mode not in (-1, 0, 1):
            yield f"{where}: block {t.block} has no mode {t.mode:+d}"
            return
        if modes[t.block - 1] == t.mode:
            yield f"{where}: block {t.block} is in mode {t.mode:+d} already"
        if not (0 <= t.time.radius <= certificate.width and t.tangential_load.radius >= 0):
            yield f"{where}: the radius of the time is not within 0 and {float(certificate.width):g} s"
        if not ((before.time.midpoint if before else 0) <= t.time.midpoint and t.time.lower <= end):
            yield f"{where}: not in order of time"
        if not any(modes) and t.time.midpoint > 0:
            if (t.block, t.mode) != (1, 1):
                yield f"{where}: an event starts with block {t.block}, which the load does not reach"
            if before and not _grows_at(loading_rate, before, t):
                yield f"{where}: the load has not grown at the rate K V since the last event"
        modes[t.block - 1] = t.mode
        before = t


def _grows_at(loading_rate: Fraction, before: CertifiedTransition, after: CertifiedTransition) -> bool:
    """Whether the load can have grown at a rate [N/s] from one transition to the next."""
    wrong = (after.tangential_load.midpoint - before.tangential_load.midpoint) - loading_rate * (
        after.time.midpoint - before.time.midpoint
    )
    loads = before.tangential_load.radius + after.tangential_load.radius
    return abs(wrong) <= loads + loading_rate * (before.time.radius + after.time.radius)


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
    """An integer within one of log10 of x > 0, however large or small."""
    return math.floor((x.numerator.bit_length() - x.denominator.bit_length()) * math.log10(2))


def _round_up(x: Fraction) -> Fraction:
    """Round a number that is not negative up to about three digits."""
    if x == 0:
        return x
    unit = Fraction(10) ** (_magnitude(x) - 2)
    return math.ceil(x / unit) * unit


def _text(x: Fraction) -> str:
    """Write a fraction exactly: as a decimal number, or else as it is."""
    try:
        return str(EXACT.divide(Decimal(x.numerator), Decimal(x.denominator)).normalize(EXACT)).lower()
    except Inexact:
        return str(x)


def _enclosure_text(enclosure: Enclosure) -> tuple[str, str]:
    return _text(enclosure.midpoint), _text(enclosure.radius)


def _enclosure(midpoint: str, radius: str) -> Enclosure:
    return Enclosure(written_fraction(midpoint), written_fraction(radius))


def _checksum(content: Mapping[str, Any]) -> str:
    """SHA-256 of the content as JSON in one defined spelling."""
    return hashlib.sha256(json.dumps(content, sort_keys=True, separators=(",", ":")).encode()).hexdigest()
