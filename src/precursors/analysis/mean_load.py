"""The time mean of F_X, which a balance of energy sets.

In a time T the drive does the work V T <F_X>. It goes into friction, mu_k w_i for every
metre that block i slides, and into the energy E of springs and motion. A block that
lags c_i behind the drive has moved by V T less the change of c_i, and has slid twice as
far again as it slid backward, b_i. So in every run with Coulomb friction

    <F_X> = mu_k F_Z + [change of (E - mu_k sum w_i c_i) + 2 mu_k sum w_i b_i]/(V T)

The first change stays bounded while strains do, and b_i >= 0: over a long time the mean
is mu_k F_Z for every loading, number of blocks and drive, or more if blocks slide
backward.
"""

from typing import NamedTuple

import numpy as np

from precursors.analysis.load_curve import load_curve
from precursors.model.chain import FloatArray
from precursors.solver.run import Run


class MeanLoad(NamedTuple):
    """Mean of F_X, and the two terms that it has beside mu_k F_Z, all over F_Z [1]."""

    mean: float
    stored: float  # by what is stored at the end and not at the start
    backward: float  # by backward sliding


def mean_load(run: Run, start: float, end: float) -> MeanLoad:
    """Mean of F_X from `start` to `end` [s], and what makes it differ from mu_k F_Z."""
    chain = run.chain
    work = chain.normal_load * chain.drive_velocity * (end - start)
    forces, velocities = run.forces_and_velocities([start, end])
    lags = np.cumsum(forces / chain.springs, axis=1)
    energies = forces**2 / chain.springs + chain.mass * velocities**2
    stored = np.diff(energies.sum(axis=1) / 2.0 - lags @ chain.kinetic_friction)
    backward = 2.0 * backward_slip(run, start, end) @ chain.kinetic_friction
    return MeanLoad(
        mean_coefficient(run, start, end),
        float(stored[0]) / work,
        float(backward) / work,
    )


def mean_coefficient(run: Run, start: float, end: float) -> float:
    """Mean of F_X/F_Z from `start` to `end` [s]; F_X is right to `TOLERANCE_N`."""
    times, loads = load_curve(run)
    inside = times[(times > start) & (times < end)]
    window = np.concatenate([[start], inside, [end]])
    area = np.trapezoid(np.interp(window, times, loads), window)
    return float(area) / (end - start) / run.chain.normal_load


def backward_slip(run: Run, start: float, end: float) -> FloatArray:
    """Distance b_i that each block slides backward from `start` to `end` [m], shape
    (N,)."""
    by_block = run.transitions[np.argsort(run.transitions["block"], kind="stable")]
    until = np.append(by_block["time"][1:], 0.0)
    until[np.diff(by_block["block"], append=0) != 0] = run.duration
    slides = by_block["mode"] == -1
    block = by_block["block"][slides] - 1
    edges = np.append(by_block["time"][slides], until[slides]).clip(start, end)
    places = run.at(edges)[0][np.arange(len(edges)), np.tile(block, 2)]
    first, last = places.reshape(2, -1)
    slip = np.zeros(run.chain.n_blocks)
    np.add.at(slip, block, first - last)
    return slip
