"""The exact solver in the table of methods."""

from __future__ import annotations

from typing import Literal, cast

from precursors.chain import Chain
from precursors.exact import simulate
from precursors.integrators.common import Method, Result


def solve(chain: Chain, duration: float, knob: float = 0.0, until: str | None = None) -> Result:
    """Simulate exactly; there is no knob, and `evaluations` is 0: the kernel counts no Taylor series.

    Raises
    ------
    ValueError, TransitionLimitError
        As `precursors.simulate`.
    """
    return Result(simulate(chain, duration, cast(Literal["global slip"] | None, until)), 0)


METHODS = (Method("exact", "exact", "none", (0.0,), solve),)
