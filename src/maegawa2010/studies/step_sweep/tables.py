"""The paper's printed numbers against the step of Runge and Kutta's method."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping

import numpy as np
import pandas as pd

from maegawa2010.methods import METHODS, attempt
from precursors.analysis.slips import apparent_friction, find_precursors, find_slips
from precursors.benchmark.compare import Truth, transitions_right
from precursors.model.chain import FloatArray
from precursors.solver.run import Record, Run

# Steps [s] from the coarsest to the finest. RK4 that also makes every step while
# nothing slides ends earlier.
COARSEST = 1e-5
FINEST = 1e-9


def charted_steps(full: bool = False) -> dict[str, FloatArray]:
    """Steps of the default chart or the full one [s], by name of the method, evenly
    spaced by logarithm."""
    per_decade, finest_every_step = (24, 1e-7) if full else (6, 1e-6)
    finest = {"rk4_skip": FINEST, "rk4": finest_every_step}
    return {
        name: np.geomspace(
            COARSEST, last, round(per_decade * math.log10(COARSEST / last)) + 1
        )
        for name, last in finest.items()
    }


def step_sweep_table(runs: Mapping[str, Run], full: bool) -> pd.DataFrame:
    """One row per scene, method and step; see `row`."""
    return pd.DataFrame(
        {"scene": scene, "theta": run.chain.theta, **row}
        for scene, run in runs.items()
        for row in sweep(run, charted_steps(full))
    )


def sweep(
    exact: Run, steps: Mapping[str, Iterable[float]]
) -> Iterator[dict[str, object]]:
    """The exact solver's numbers up to the end of the first global slip, then each
    method's at each step [s].

    The duration of the exact run, to the first global slip or longer, limits the other
    runs. Rows: see `row`.
    """
    truth = Truth.of_run(exact).until_global_slip().run
    yield row("exact", math.nan, truth, truth)
    for method, values in steps.items():
        for step in values:
            result = attempt(
                METHODS[method].solve, exact.chain, exact.duration, step, "global slip"
            )
            yield row(method, step, result.run, truth)


def row(method: str, step: float, run: Record, truth: Record) -> dict[str, object]:
    """Results of a run that stopped after its first global slip.

    Returns
    -------
    dict
        method; step_s [s], NaN for the exact solver; events_counted, the number of
        events in Fig. 13; mu_sapp (Eq. 1), NaN without a global slip; transitions_right
        before the first wrong one, and transitions_true, all there are.
    """
    return {
        "method": method,
        "step_s": step,
        "events_counted": len(find_precursors(find_slips(run))),
        "mu_sapp": apparent_friction(run),
        "transitions_right": transitions_right(run, truth),
        "transitions_true": len(truth.transitions),
    }
