"""Proof of a run: every transition of a chain in exact numbers, with an enclosure of its time and load.

`certify` proves (it needs python-flint, the extra "proof"); certificates are read and checked without it.
"""

from precursors.accuracy.proof.agreement import Agreement, compare
from precursors.accuracy.proof.certificate import (
    Certificate,
    CertificateError,
    CertifiedTransition,
    Enclosure,
    Tie,
    certify,
    verify,
)
from precursors.accuracy.proof.exact_chain import ExactChain, scene_exact_chain

__all__ = [
    "Agreement",
    "Certificate",
    "CertificateError",
    "CertifiedTransition",
    "Enclosure",
    "ExactChain",
    "Tie",
    "certify",
    "compare",
    "scene_exact_chain",
    "verify",
]
