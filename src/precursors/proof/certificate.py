"""Certificates: the proved transitions of a run, in a file that anyone can read and
verify."""

from __future__ import annotations

import gzip
import json
from collections.abc import Mapping
from dataclasses import dataclass
from decimal import Context, Inexact
from fractions import Fraction
from pathlib import Path
from typing import Any, NamedTuple

from precursors.model.checks import Until, checked_until, whole
from precursors.proof.exact_chain import (
    ExactChain,
    as_decimal,
    exact_start,
    written_fraction,
)
from precursors.support.files import AnyPath, write_whole

FORMAT = "precursors certificate 2"
CLAIM = (
    "Every run of the model with these exact parameters has exactly the transitions "
    "listed, in this order, up to duration_s or, if there is a tie, up to the tie. "
    "Each time and each tangential load lies within its radius of its midpoint. A row"
    " is time_s, radius, block, mode (+1, 0, -1), tangential_load_N, radius, slope: "
    "there the margin of a block that is released falls at least at this rate [N/s], "
    "and the speed of one that stops or turns [m/s^2]; 0 for a block that moves from "
    "the start."
)
# Twice as many bits take four times as long; no proof has needed this many yet.
MOST_BITS = 16_384
EXACT = Context(prec=1000, traps=[Inexact])


class CertificateError(ValueError):
    """A certificate is damaged, differs from its proof, or cannot be made."""


class Enclosure(NamedTuple):
    """A number known to lie within `radius` of `midpoint`."""

    midpoint: Fraction
    radius: Fraction

    @property
    def lower(self) -> Fraction:
        """Smallest number of the enclosure."""
        return self.midpoint - self.radius

    @property
    def upper(self) -> Fraction:
        """Largest number of the enclosure."""
        return self.midpoint + self.radius

    def contains(self, other: Enclosure) -> bool:
        """Whether another enclosure lies within this one."""
        return self.lower <= other.lower and other.upper <= self.upper


class CertifiedTransition(NamedTuple):
    """A change of one block's state: time [s], block 1..N, mode +1 | 0 | -1, tangential
    load F_X [N].

    `slope` is the least rate at which the event function falls through zero. That
    function is the margin of a block that is released [N/s], or the speed of one that
    stops or turns [m/s^2]. The slope is 0 for a block that moves from the start, and
    otherwise positive: no event function only grazes zero. A block without load has no
    friction and no transitions.
    """

    time: Enclosure
    block: int
    mode: int
    tangential_load: Enclosure
    slope: Fraction


class Tie(NamedTuple):
    """The end of a proof at which the order of events cannot be decided.

    It has the time [s], the blocks concerned, the undecided question, and the width of
    the time interval within which it is undecided [s].
    """

    time: Enclosure
    blocks: tuple[int, ...]
    question: str
    closeness: Fraction


@dataclass(frozen=True)
class Certificate:
    """All proved transitions of a chain, in order, from a given start [m, m/s].

    The proof covers the `duration` [s]. It ends earlier at a `tie`, or, with `until`,
    at the end of the first event in which all blocks slide at the same instant. No time
    has a radius above `width` [s]. `bits` is the working precision at the start of the
    proof.
    """

    chain: ExactChain
    duration: Fraction
    until: Until
    start_positions: tuple[Fraction, ...]
    start_velocities: tuple[Fraction, ...]
    width: Fraction
    transitions: tuple[CertifiedTransition, ...]
    tie: Tie | None
    bits: int

    def __repr__(self) -> str:
        return (
            f"Certificate of {len(self.transitions)} transitions in "
            f"{float(self.proved_until):g} s, each within {float(self.width):g} s"
        )

    @property
    def proved_until(self) -> Fraction:
        """Time [s] up to which the list of transitions is proved complete."""
        return self.tie.time.lower if self.tie else self.duration

    def save(self, path: AnyPath) -> None:
        """Write the certificate as gzipped JSON; equal certificates give equal bytes."""
        write_whole(
            path, gzip.compress(json.dumps(_content(self), indent=0).encode(), mtime=0)
        )

    @classmethod
    def load(cls, path: AnyPath) -> Certificate:
        """Read a certificate.

        Raises
        ------
        OSError
            If the file cannot be read.
        CertificateError
            If it is damaged or not a certificate.
        """
        raw = Path(path).read_bytes()
        try:
            content = json.loads(gzip.decompress(raw))
            if content["format"] != FORMAT:
                raise ValueError(
                    f"its format must be {FORMAT!r}, but is {content['format']!r}"
                )
            certificate = _certificate(content)
            again = json.loads(json.dumps(_content(certificate)))
            for name in sorted(content.keys() | again.keys()):
                if content.get(name) != again.get(name):
                    raise ValueError(f"its {name} differs from that of a certificate")
            return certificate
        except Exception as error:  # the file may contain anything
            why = str(error) or type(error).__name__
            raise CertificateError(
                f"{path} is not a complete certificate: {why}"
            ) from error


def _content(certificate: Certificate) -> dict[str, Any]:
    """Return a certificate as the content of its file."""
    tie = certificate.tie
    return {
        "format": FORMAT,
        "claim": CLAIM,
        "chain": certificate.chain.as_text(),
        "start_positions_m": [str(x) for x in certificate.start_positions],
        "start_velocities_m_per_s": [str(v) for v in certificate.start_velocities],
        "duration_s": str(certificate.duration),
        "until": certificate.until,
        "bits": certificate.bits,
        "width_s": str(certificate.width),
        "tie": tie
        and {
            "time_s": _enclosure_text(tie.time),
            "blocks": list(tie.blocks),
            "question": tie.question,
            "closeness_s": _text(tie.closeness),
        },
        "transitions": [
            [
                *_enclosure_text(t.time),
                t.block,
                t.mode,
                *_enclosure_text(t.tangential_load),
                _text(t.slope),
            ]
            for t in certificate.transitions
        ],
    }


def _certificate(content: Mapping[str, Any]) -> Certificate:
    """Return the certificate from the content of its file."""
    tie = content["tie"]
    chain = ExactChain(**content["chain"])
    return Certificate(
        chain=chain,
        duration=written_fraction(content["duration_s"]),
        until=checked_until(content["until"]),
        start_positions=exact_start(
            "start_positions", chain, content["start_positions_m"], "m"
        ),
        start_velocities=exact_start(
            "start_velocities", chain, content["start_velocities_m_per_s"], "m/s"
        ),
        width=written_fraction(content["width_s"]),
        transitions=tuple(
            CertifiedTransition(
                _enclosure(*row[:2]),
                int(row[2]),
                int(row[3]),
                _enclosure(*row[4:6]),
                written_fraction(row[6]),
            )
            for row in content["transitions"]
        ),
        tie=tie
        and Tie(
            _enclosure(*tie["time_s"]),
            tuple(tie["blocks"]),
            tie["question"],
            written_fraction(tie["closeness_s"]),
        ),
        bits=whole("bits", content["bits"], MOST_BITS),
    )


def _text(x: Fraction) -> str:
    """Write a decimal number exactly."""
    return str(as_decimal(x, EXACT).normalize(EXACT)).lower()


def _enclosure_text(enclosure: Enclosure) -> tuple[str, str]:
    return _text(enclosure.midpoint), _text(enclosure.radius)


def _enclosure(midpoint: str, radius: str) -> Enclosure:
    return Enclosure(written_fraction(midpoint), written_fraction(radius))
