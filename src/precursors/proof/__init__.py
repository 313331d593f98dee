"""Proof of a run: every transition of a chain in exact numbers, with an enclosure of
its time and load.

`certify` proves (it needs python-flint, the extra "proof"); certificates are read and
checked without it.
"""

from precursors.proof.certificate import (
    Certificate,
    CertificateError,
    CertifiedTransition,
    Enclosure,
    Tie,
)
from precursors.proof.exact_chain import ExactChain
from precursors.proof.prove import certify, verify
