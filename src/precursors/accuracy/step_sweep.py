"""What the step of Runge and Kutta's method does to the numbers that the paper prints."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from precursors.accuracy.compare import Truth, compare
from precursors.analysis.slip_rows import first_global
from precursors.analysis.slips import apparent_friction, find_precursors, find_slips
from precursors.methods import rk4
from precursors.methods.common import DivergedError
from precursors.model.chain import Chain, FloatArray
from precursors.solver.run import Run
from precursors.solver.simulate import simulate

EXACT = "exact"
METHODS = {method.name: method for method in rk4.METHODS}


@dataclass(frozen=True)
class Outcome:
    """What a method gives up to the end of the first global slip.

    Attributes
    ----------
    method : str
        Its name in the table of methods.
    step : float
        Its step [s]; NaN for the exact solver.
    events_kept : int
        Events of Fig. 13, the first global slip included.
    mu_sapp : float
        Apparent static friction coefficient (Eq. 1); NaN without a global slip.
    global_slip_time : float
        Onset of the first global slip [s]; NaN without one.
    transitions_right, transitions_true : int
        Transitions before the first wrong one, and all there are.
    """

    method: str
    step: float
    events_kept: int
    mu_sapp: float
    global_slip_time: float
    transitions_right: int
    transitions_true: int


def steps_between(coarsest: float, finest: float, per_decade: int) -> FloatArray:
    """Steps [s] from the coarsest to the finest, both included, evenly spaced on a logarithmic scale.

    Raises
    ------
    ValueError
        If the coarsest is finer than the finest.
    """
    if coarsest < finest:
        raise ValueError(f"coarsest = {coarsest!r} s is less than finest = {finest!r} s: allowed is at least")
    intervals = round(per_decade * math.log10(coarsest / finest))
    return np.geomspace(coarsest, finest, intervals + 1)


def sweep(chain: Chain, duration: float, steps: Mapping[str, Iterable[float]]) -> Iterator[Outcome]:
    """The exact solver's outcome, then that of each method with each of its steps.

    Parameters
    ----------
    chain : Chain
        The chain.
    duration : float
        Time limit of a run without a global slip [s].
    steps : mapping of str to iterable of float
        Steps [s] by name of the method.
    """
    truth = Truth.of_run(simulate(chain, duration, "global slip"))
    yield outcome(EXACT, math.nan, truth.run, truth)
    for method, values in steps.items():
        for step in map(float, values):
            yield outcome(method, step, _run(chain, duration, method, step), truth)


def outcome(method: str, step: float, run: Run, truth: Truth) -> Outcome:
    """What a run that stopped after its first global slip gives."""
    slips = find_slips(run)
    first = first_global(slips)
    friction = apparent_friction(run, slips)
    compared = compare(run, truth)
    return Outcome(
        method,
        step,
        len(find_precursors(slips)),
        friction.mu_sapp if friction else math.nan,
        math.nan if first is None else float(slips["onset"].iloc[first]),
        compared.transitions_right,
        compared.transitions_true,
    )


def _run(chain: Chain, duration: float, method: str, step: float) -> Run:
    try:
        return METHODS[method].solve(chain, duration, step, "global slip").run
    except DivergedError as diverged:
        return diverged.run
