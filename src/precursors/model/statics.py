"""Statics: the load that a chain at rest can carry (Eqs. 11-14)."""

import numpy as np
import scipy

from precursors.model.chain import Chain, FloatArray

# Tolerance of the linear program, in units of F_Z; the default of HiGHS is 1e-7.
LP_FEASIBILITY = 1e-10
# Longest run, in units of the time in which the drive reaches mu_s F_Z while it
# compresses all springs.
LIMIT = 10.0


def load_bound(chain: Chain) -> float:
    """Return the largest tangential load of a chain at rest, mu_s F_Z [N] (Eq. 14)."""
    return chain.mu_s * chain.normal_load


def longest_run(chain: Chain) -> float:
    """Return the time [s] after which a run without a global slip is given up."""
    compliance = 1.0 / chain.drive_stiffness + (chain.n_blocks - 1) / chain.stiffness
    return LIMIT * chain.mu_s * chain.normal_load * compliance / chain.drive_velocity


def maximal_compressions(chain: Chain) -> FloatArray:
    """Return the compressions y_i^max [m], shape (N,), with every block at +mu_s w_i
    (Eq. 12, corrected).

    Each spring carries the strength of all blocks ahead of it.
    """
    return np.cumsum(chain.strength[::-1])[::-1] / chain.springs


def positions_from_compressions(compressions: FloatArray) -> FloatArray:
    """Return positions x_i [m], shape (N,), for compressions y_i = x_{i-1} - x_i and a
    drive at x_0 = 0 (Eq. 11)."""
    return -np.cumsum(compressions)


def maximal_strain_positions(chain: Chain) -> FloatArray:
    """Return the positions [m], shape (N,), of maximal residual strain (Eq. 12,
    corrected), with x_0 = 0."""
    return positions_from_compressions(maximal_compressions(chain))


def balance_matrix(chain: Chain) -> FloatArray:
    """Return the matrix B [N/m], shape (N, N): B y is the net force of the springs on
    each block (Eqs. 2, 11)."""
    return np.diag(chain.springs) - np.diag(chain.springs[1:], 1)


def compressions_as_printed(chain: Chain) -> FloatArray:
    """Return the compressions y_i [m], shape (N,), of Eq. 12 as printed, which has K
    y_N instead of k y_N in its last line."""
    balance = balance_matrix(chain)
    balance[-1, -1] = chain.drive_stiffness
    return np.linalg.solve(balance, chain.strength).astype(np.float64)


def largest_load_at_rest(chain: Chain) -> tuple[float, FloatArray]:
    """Return the largest F_X = K y_1 [N] of all states of rest, and the compressions
    [m] of that state (Eqs. 5, 11-13).

    A linear program finds this state. A block is at rest if |s_i y_i - s_{i+1} y_{i+1}|
    <= mu_s w_i with s = K, k, k, ...
    """
    # With y_i in units of F_Z/s_i and forces in units of F_Z, the program is well
    # scaled for any K/k.
    unit = chain.normal_load / chain.springs
    net = balance_matrix(chain) * unit / chain.normal_load
    limit = chain.strength / chain.normal_load
    load = np.zeros(chain.n_blocks)
    load[0] = 1.0
    optimum = scipy.optimize.linprog(
        -load,
        A_ub=np.concatenate([net, -net]),
        b_ub=np.concatenate([limit, limit]),
        bounds=(None, None),
        method="highs",
        options={"primal_feasibility_tolerance": LP_FEASIBILITY},
    )
    compressions = np.asarray(optimum.x) * unit
    return float(chain.drive_stiffness * compressions[0]), compressions
