"""The paper's counts against the step of the classical Runge-Kutta method (RK4)."""

import math
from collections.abc import Iterable, Iterator, Mapping

import numpy as np
import pandas as pd

from maegawa2010.methods import METHODS, attempt
from precursors.analysis.agreement import transitions_right
from precursors.analysis.slips import slip_table
from precursors.analysis.summary import summary_of
from precursors.benchmark.compare import until_global_slip
from precursors.solver.run import Record, Run

COARSEST = 1e-5  # s
FINEST = 1e-9
# Number of steps, evenly spaced in the logarithm, in the default and in the full study.
STEPS = 25
STEPS_FULL = 97


def step_sweep_table(runs: Mapping[str, Run], full: bool) -> pd.DataFrame:
    """One row per scene and step; see `row`."""
    steps = np.geomspace(COARSEST, FINEST, STEPS_FULL if full else STEPS)
    return pd.DataFrame(
        {"scene": scene, "theta": run.chain.theta, **row}
        for scene, run in runs.items()
        for row in sweep(run, steps)
    )


def sweep(exact: Run, steps: Iterable[float]) -> Iterator[dict[str, object]]:
    """Yield the exact solver's row up to the end of the first global slip, then one of
    RK4 for each step [s]; see `row`.

    RK4 runs for at most the duration of the exact run, which includes the first global
    slip.
    """
    truth = until_global_slip(exact)
    yield row("exact", math.nan, truth, truth)
    for step in steps:
        result = attempt(
            METHODS["rk4"].solve, exact.chain, exact.duration, step, "global slip"
        )
        yield row("rk4", step, result.run, truth)


def row(method: str, step: float, run: Record, truth: Record) -> dict[str, object]:
    """Results of a run that stopped after its first global slip.

    Returns
    -------
    dict
        method; step_s [s], NaN for the exact solver; events_counted, the number of
        events in Fig. 13; transitions_right, the number of transitions before the first
        wrong one; and transitions_true, the number of transitions of `truth`.
    """
    return {
        "method": method,
        "step_s": step,
        "events_counted": summary_of(slip_table(run)).events_counted,
        "transitions_right": transitions_right(run, truth),
        "transitions_true": len(truth.transitions),
    }
