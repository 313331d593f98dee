"""Normal loads that do not change linearly along the slider."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from precursors.model.chain import Chain, FloatArray

# Normal load at a place x from 0 (leading edge) to 1 (trailing edge), but for a factor.
LOADINGS: dict[str, Callable[[FloatArray], FloatArray]] = {
    "middle": lambda x: 0.2 + x * (1 - x),
    "edges": lambda x: 0.2 + (2 * x - 1) ** 2,
    "falling": lambda x: np.exp(-2 * x),
    "rising": lambda x: np.exp(2 * x),
}


def loaded(chain: Chain, loading: str) -> Chain:
    """The chain with the same total load in another shape, a key of LOADINGS; "linear" is Eq. 7 as it is."""
    if loading == "linear":
        return chain
    weights = LOADINGS[loading](np.linspace(0.0, 1.0, chain.n_blocks))
    return replace(chain, weights=weights / weights.sum() * chain.normal_load)
