"""Statics: what follows from the balance of forces alone, in closed form."""

from __future__ import annotations

import numpy as np

from precursors.model.chain import Chain, FloatArray


def first_precursor_load(chain: Chain) -> float:
    """Load at which block 1 is released from rest with springs at natural length, mu_s
    w_1 [N] (Eq. 5)."""
    return float(chain.strength[0])


def front_load_law(chain: Chain) -> FloatArray:
    """Load mu_k W(L_p) at which the front reaches each block [N], shape (N,), W the
    cumulative normal load.

    After a slip up to block n every block behind the front is pushed with about mu_k
    w_i and nothing is beyond it, so that F_X = mu_k (w_1 + ... + w_n). This is the
    leading order of the quasi-static chain as N grows (Amundsen et al., Tribol. Lett.
    45 (2012) 357, derive the length of precursors in this way).
    """
    return chain.mu_k * np.cumsum(chain.weights)


def apparent_friction_law(chain: Chain) -> float:
    """mu_sapp when the front of the law reaches the leading edge [1]: mu_k for any
    normal loading."""
    return chain.mu_k
