"""What is measured in a long run, and its beginning, which every build makes again.

The beginning ends at known_s, until when single events can be predicted. The columns
`first_...` of a table describe it. In a row of several runs, it is that of the first run
with noise.
"""

import math

import numpy as np
import pandas as pd

from maegawa2010.studies.balance.tables import mean_of
from maegawa2010.studies.runs import so_far
from precursors.analysis.balance import distance
from precursors.analysis.slips import find_precursors, slip_table
from precursors.analysis.summary import summary_of
from precursors.model.chain import Chain, FloatArray
from precursors.model.statics import maximal_compressions, positions_from_compressions
from precursors.solver.run import Run
from precursors.solver.simulate import simulate

LEFT_OUT = 0.2  # share of a run at its start that does not count
MOST_TRANSITIONS = 30_000_000
# Points between two transitions, at which forces are read for their mean.
POINTS = 8


def lasting(chain: Chain, seconds: float) -> tuple[Run, float]:
    """A run from rest in kinetic balance (R = 0), and the time from which it counts [s]."""
    sliding = chain.mu_k / chain.mu_s * maximal_compressions(chain)
    start = positions_from_compressions(sliding)
    run = simulate(
        chain, seconds, start_positions=start, max_transitions=MOST_TRANSITIONS
    )
    return run, LEFT_OUT * seconds


def mean_friction(run: Run, start: float, end: float) -> FloatArray:
    """Mean friction [N] of each block from `start` to `end` [s], shape (N,): the mean
    force of its springs less its mean gain of momentum per time."""
    inside = run.transitions["time"]
    edges = np.unique([start, *inside[(inside > start) & (inside < end)], end])
    last = len(edges) - 1
    parts = np.linspace(0, last, last * POINTS + 1)
    times = np.interp(parts, np.arange(last + 1), edges)
    forces, velocities = run.forces_and_velocities(times)
    push = np.trapezoid(forces, times, axis=0) / (end - start)
    gained = run.chain.mass * (velocities[-1] - velocities[0]) / (end - start)
    return push - np.append(push[1:], 0.0) - gained


def at_first_slip(run: Run) -> dict[str, float]:
    """Distance from kinetic balance at the first global slip and at the events of Fig. 13.

    Returns
    -------
    dict
        R_J, R at the onset of the first global slip [J], or NaN; bound = sqrt(2 K R)/F_Z,
        the largest distance of F_X/F_Z from mu_k that this R allows; and excess =
        mu_sapp - mu_k. Of the events of Fig. 13: line_bound, the median bound on the
        distance of F_X/F_Z from the line F_X = mu_k W(L_p); and line_rms, the root mean
        square of this distance.
    """
    chain = run.chain
    slips = slip_table(run)
    counted = find_precursors(slips)
    onset, front = counted["onset_s"].to_numpy(), counted["front"].to_numpy()
    left = np.array([distance(run, t, n)[0] for t, n in zip(onset, front, strict=True)])
    carried = chain.mu_k * np.cumsum(chain.weights)[front - 1]
    bounds = np.sqrt(2.0 * chain.drive_stiffness * left) / chain.normal_load
    reached = counted["is_global"].iloc[-1]
    miss = (counted["load_before_N"] - carried) / chain.normal_load
    return {
        "R_J": left[-1] if reached else math.nan,
        "bound": bounds[-1] if reached else math.nan,
        "excess": summary_of(slips).mu_sapp - chain.mu_k,
        "line_bound": float(np.median(bounds)),
        "line_rms": float(np.sqrt(np.mean(miss**2))),
    }


def of_lasting(chain: Chain, known_s: float) -> dict[str, float]:
    """Transitions and mean of F_X/F_Z of a run from kinetic balance."""
    run, _ = lasting(chain, known_s)
    mean = mean_of(run, 0.0, known_s).mean
    return {
        "known_s": known_s,
        "first_transitions": len(run.transitions),
        "first_mean": mean,
    }


def of_blocks(chain: Chain, known_s: float) -> pd.DataFrame:
    """Mean friction of each block over its normal load, of a run from kinetic balance."""
    run, _ = lasting(chain, known_s)
    friction = mean_friction(run, 0.0, known_s) / chain.weights
    block = np.arange(1, chain.n_blocks + 1)
    row = {"block": block, "known_s": known_s, "first_friction": friction}
    return pd.DataFrame(row)


def of_load(chain: Chain, known_s: float) -> dict[str, float]:
    """Events and largest F_X/F_Z of a run to the first global slip."""
    numbers = so_far(simulate(chain, known_s, "global slip"))
    return {
        "known_s": known_s,
        "first_events": numbers["events_to_global_slip"],
        "first_largest": numbers["mu_sapp"],
    }


def of_slip(chain: Chain, known_s: float) -> dict[str, float]:
    """R at the end of a run to the first global slip [J], and the distance of its events
    from the line of Fig. 13 (see `at_first_slip`)."""
    run = simulate(chain, known_s, "global slip")
    return {
        "known_s": known_s,
        "first_R_J": distance(run, [run.duration])[0],
        "first_line_rms": at_first_slip(run)["line_rms"],
    }
