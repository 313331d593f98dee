"""The distance R of a run from kinetic balance; forward slips leave R unchanged.

In kinetic balance the spring behind block j carries A_j = mu_k (w_j + ... + w_N). The
actual force in this spring is T_j, and its stiffness is k_j = K, k, k, ... The
distance is

    R = sum_j (T_j - A_j)^2/(2 k_j) + sum_i m v_i^2/2

The first sum changes at a rate that follows from T_j' = k_j (v_{j-1} - v_j), v_0 = V:

    sum_j (T_j - A_j)(v_{j-1} - v_j) = (F_X - mu_k F_Z) V - sum_i n_i v_i

with n_i = T_i - T_{i+1} - mu_k w_i. While block i slides forward, m v_i' = n_i. While
it slides backward, m v_i' = n_i + 2 mu_k w_i. The second sum therefore changes at the
rate sum_i n_i v_i, less 2 mu_k w_i |v_i| for each block that slides backward. Over the
path X = V t of the drive, R changes by

    dR/dX = F_X - mu_k F_Z - 2 mu_k sum_{v_i < 0} w_i |v_i|/V

In a lasting motion R stays bounded. The mean of F_X over the path is then mu_k F_Z if
no block slides backward, and larger otherwise.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from precursors.analysis.load_curve import load_curve
from precursors.model.chain import Chain, FloatArray
from precursors.solver.run import Run


class Balance(NamedTuple):
    """Terms of the change of R in some time [J]: change = work - backward +
    remainder."""

    work: float  # of the drive, minus the work against kinetic friction
    backward: float  # loss by blocks that slide backward
    change: float  # of R
    remainder: float  # error of the run and of the integral


def balance(run: Run, start: float, end: float) -> Balance:
    """Return the terms of the change of R from `start` to `end` [s]."""
    work = float(np.diff(drive_work(run, [start, end]))[0])
    backward = 2.0 * float(backward_slip(run, start, end) @ run.chain.kinetic_friction)
    change = float(np.diff(distance(run, [start, end]))[0])
    return Balance(work, backward, change, change - work + backward)


def distance(run: Run, times: ArrayLike, n_blocks: int | None = None) -> FloatArray:
    """Return the distance R [J] from kinetic balance at `times` [s], shape
    (len(times),).

    The sums are over the first `n_blocks` blocks and the springs behind and ahead of
    them, by default over all. Until a block ahead of them slides, dR/dX has their
    normal load instead of F_Z.
    """
    chain = run.chain
    n = n_blocks or chain.n_blocks
    springs = chain.springs[: n + 1]
    forces, velocities = run.forces_and_velocities(times, len(springs))
    strained = (forces - balanced_forces(chain, n)) ** 2 / springs
    moving = chain.mass * velocities[:, :n] ** 2
    return (strained.sum(axis=1) + moving.sum(axis=1)) / 2.0


def balanced_forces(chain: Chain, n_blocks: int) -> FloatArray:
    """Return the force A_j [N] in each spring of the first blocks in kinetic balance;
    in the spring ahead of them it is zero."""
    friction = chain.kinetic_friction[: n_blocks + 1].copy()
    friction[n_blocks:] = 0.0
    return np.cumsum(friction[::-1])[::-1]


def drive_work(run: Run, times: ArrayLike) -> FloatArray:
    """Return the work of the drive, minus the work against kinetic friction, up to
    `times`.

    It is V times the integral of F_X - mu_k F_Z from 0 to each time [s], in J, shape
    (len(times),). Between points of the load curve, F_X is the cubic with the loads and
    slopes at both points.
    """
    chain = run.chain
    knots = np.union1d(load_curve(run)[0], times)
    loads, velocities = run.forces_and_velocities(knots, 1)[..., 0]
    slopes = chain.drive_stiffness * (chain.drive_velocity - velocities)
    beside = loads - chain.mu_k * chain.normal_load
    steps = np.diff(knots)
    areas = steps * (beside[:-1] + beside[1:]) / 2.0 - steps**2 * np.diff(slopes) / 12.0
    work = chain.drive_velocity * np.append(0.0, np.cumsum(areas))
    return work[np.searchsorted(knots, times)]


def backward_slip(run: Run, start: float, end: float) -> FloatArray:
    """Return the distance [m] that each block slides backward from `start` to `end`
    [s], shape (N,)."""
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
