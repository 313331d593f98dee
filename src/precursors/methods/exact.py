"""The exact solver in the table of methods."""

from __future__ import annotations

from typing import Literal, cast

from precursors.methods.common import Method, Result
from precursors.model.chain import Chain
from precursors.solver.simulate import simulate


def solve(chain: Chain, duration: float, knob: float = 0.0, until: str | None = None) -> Result:
    """Simulate exactly; there is no knob. Each derivative of a Taylor series counts as an evaluation.

    Raises
    ------
    ValueError, TransitionLimitError
        As `precursors.simulate`.
    """
    run = simulate(chain, duration, cast(Literal["global slip"] | None, until))
    return Result(run, round(run.evaluations))


METHODS = (Method("exact", "exact", "none", (0.0,), solve),)
