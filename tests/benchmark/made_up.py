"""Invented transitions of a run, and proofs that are advanced step by step."""

from collections.abc import Sequence
from fractions import Fraction
from functools import cache

from precursors import Chain, Record
from precursors.benchmark.compare import Comparison
from precursors.proof import Certificate, ExactChain, certify
from precursors.proof.tube import Proof

CHAIN = Chain.from_slider(n_blocks=3)
DURATION = 4.0
# Times are multiples of 1/8 s and loads of 1/2 N, so that sums and differences are
# exact.
TRUE = [
    (1.0, 1, 1, 50.0),
    (1.125, 1, 0, 49.0),
    (2.0, 1, 1, 90.0),
    (2.125, 2, 1, 88.0),
    (2.25, 1, 0, 85.0),
    (2.375, 2, 0, 85.5),
    (3.0, 1, 1, 120.0),
    (3.125, 2, 1, 118.0),
    (3.25, 3, 1, 110.0),
    (3.375, 1, 0, 100.0),
    (3.5, 2, 0, 101.0),
    (3.625, 3, 0, 101.5),
]
# Seven blocks with the middle one displaced: by symmetry, blocks 2 and 6 are released at
# the same instant.
SYMMETRIC_START = ["0", "0", "0", "1e-5", "0", "0", "0"]


def made_up(rows) -> Record:
    time, block, mode, load = zip(*rows, strict=True) if rows else ((), (), (), ())
    return Record.from_columns(CHAIN, DURATION, time, block, mode, load)


def has_all_transitions(comparison: Comparison) -> bool:
    """Whether a run has exactly the transitions of the truth, in the same order."""
    return (
        comparison.transitions_right
        == comparison.transitions_found
        == comparison.transitions_true
    )


@cache
def tied_certificate() -> Certificate:
    """Return a certificate that ends with a tie."""
    chain = ExactChain.from_slider(n_blocks=7)
    return certify(chain, 1, start_positions=SYMMETRIC_START, max_bits=1024)


def proof_of(chain: ExactChain, bits: int, positions: Sequence[Fraction] = ()) -> Proof:
    """Return a proof at its start, from rest; by default with unstrained springs."""
    rest = (Fraction(0),) * chain.n_blocks
    start = tuple(positions) or rest, rest
    return Proof(
        Certificate(chain, Fraction(100), None, *start, Fraction(1), (), None, bits)
    )


def go_on(proof: Proof) -> None:
    """Advance a proof by one step."""
    assert proof.slide() if any(proof.state.mode) else proof.load()
