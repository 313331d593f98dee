"""Prove every transition of a chain with exact parameters, and enclose its time and
load.

`certify` and `verify` need python-flint (the extra "proof"). Certificates can be read
without it.
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
