"""Statics: answers that follow from the balance of forces alone, in closed form."""

from typing import Any

import numpy as np

from precursors.model.chain import Chain
from precursors.model.statics import load_bound


def answers(chain: Chain) -> dict[str, Any]:
    """The bound of the load (Eq. 14), and the load mu_s w_1 at which block 1 first slips
    if all springs have their natural length (Eq. 5)."""
    return {"load_bound": load_bound(chain), "first_load": chain.strength[0]}


def front_law_answers(chain: Chain) -> dict[str, Any]:
    """Load mu_k W(L_p) at which the front reaches each block; W is the cumulative normal
    load.

    After a slip up to block n the net force on every block behind the front is about
    mu_k w_i, and there is none beyond the front, so F_X = mu_k (w_1 + ... + w_n). This
    is the leading order of the quasi-static chain as N grows; Amundsen et al., Tribol.
    Lett. 45 (2012) 357, derive the length of precursors in this way. When the front
    reaches the leading edge, F_X/F_Z is mu_k for any normal loading.
    """
    return {
        "front_loads": chain.mu_k * np.cumsum(chain.weights),
        "mu_sapp": chain.mu_k,
    }
