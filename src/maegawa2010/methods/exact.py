"""The exact solver with the interface of the methods."""

from maegawa2010.methods.common import Method, Result
from precursors.model.chain import Chain
from precursors.model.checks import Until
from precursors.solver.simulate import simulate


def solve(
    chain: Chain, duration: float, _value: float = 0.0, until: Until = None
) -> Result:
    """Simulate exactly; there is no setting of accuracy. Each derivative of a Taylor
    series counts as an evaluation."""
    run = simulate(chain, duration, until)
    return Result(run, round(run.evaluations))


METHODS = (Method("exact", "none", solve),)
