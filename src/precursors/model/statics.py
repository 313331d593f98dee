"""The bound on the load of a chain at rest in numbers (Eqs. 11-14); `derivation` has it in symbols."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import linprog

from precursors.model.chain import Chain, FloatArray, require_plain

# HiGHS allows 1e-7 by default. Loads are posed in units of F_Z, so this is 1e-10 F_Z.
LP_FEASIBILITY = 1e-10


@dataclass(frozen=True)
class LoadRange:
    """Extremes of F_X [N] over all states of rest, and where they lie.

    `compressions_at_largest` and `compressions_at_smallest` [m], shape (N,), are the springs' compressions
    there; `sensitivity` [N/N], shape (N,), is the derivative of the largest load with respect to mu_s w_i.
    """

    largest: float
    smallest: float
    compressions_at_largest: FloatArray
    compressions_at_smallest: FloatArray
    sensitivity: FloatArray


def load_bound(chain: Chain) -> float:
    """Largest tangential load of a chain at rest, mu_s F_Z [N] (Eq. 14)."""
    return chain.mu_s * chain.normal_load


def maximal_compressions(chain: Chain) -> FloatArray:
    """Compressions y_i^max [m], shape (N,), with every block at +mu_s w_i (Eq. 12, corrected).

    Each spring carries the strength of all blocks ahead of it.

    Raises
    ------
    ValueError
        If the chain has viscosity, interface springs or a head.
    """
    require_plain(chain)
    carried = np.cumsum(chain.strength[::-1])[::-1]
    return carried / chain.springs


def maximal_strain_positions(chain: Chain) -> FloatArray:
    """Positions of the blocks [m], shape (N,), in the state of maximal residual strain (Eq. 12, corrected).

    The drive is at 0, as at t = 0, so F_X = K (0 - x_1) = mu_s F_Z.
    """
    return positions_from_compressions(maximal_compressions(chain))


def positions_from_compressions(compressions: FloatArray) -> FloatArray:
    """Positions x_i [m], shape (N,), for compressions y_i = x_{i-1} - x_i and a drive at x_0 = 0 (Eq. 11)."""
    return -np.cumsum(compressions)


def net_spring_forces(chain: Chain, positions: FloatArray) -> FloatArray:
    """Net force of the springs on each block [N], shape (N,), with the drive at 0 (Eqs. 2 and 3)."""
    behind = chain.springs * -np.diff(positions, prepend=0.0)
    ahead = np.append(behind[1:], 0.0)
    return behind - ahead


def balance_matrix(chain: Chain) -> FloatArray:
    """Matrix B [N/m], shape (N, N), whose B y is the net force of the springs on each block (Eqs. 2, 11)."""
    return np.diag(chain.springs) - np.diag(chain.springs[1:], 1)


def compressions_as_printed(chain: Chain) -> FloatArray:
    """Compressions y_i [m], shape (N,), that Eq. 12 gives as printed: K y_N, not k y_N, in its last line.

    Their F_X = K y_1 is mu_s F_Z + (k/K - 1) mu_s w_N for N > 1. At N = 1 the last spring is the drive's and
    nothing is misprinted.
    """
    balance = balance_matrix(chain)
    balance[-1, -1] = chain.drive_stiffness
    return np.linalg.solve(balance, chain.strength).astype(np.float64)


def loads_at_rest(chain: Chain) -> LoadRange:
    """Find the largest and the smallest F_X = K y_1 over all states of rest (Eqs. 5 and 11-13).

    A linear program over the compressions y_i, which are free: each block is at rest if the net force of
    its springs is within +-mu_s w_i, that is |s_i y_i - s_{i+1} y_{i+1}| <= mu_s w_i with s = K, k, k, ...

    Raises
    ------
    ValueError
        If the chain has viscosity, interface springs or a head.
    RuntimeError
        If the solver finds no optimum.
    """
    require_plain(chain)
    # y_i in units of F_Z/s_i and forces in units of F_Z: the program is as well scaled for any K/k.
    unit = chain.normal_load / chain.springs
    net = balance_matrix(chain) * unit / chain.normal_load
    limit = chain.strength / chain.normal_load
    load = np.zeros(chain.n_blocks)
    load[0] = chain.drive_stiffness * unit[0] / chain.normal_load

    def extreme(sign: int) -> tuple[FloatArray, FloatArray]:
        result = linprog(
            -sign * load,
            A_ub=np.concatenate([net, -net]),
            b_ub=np.concatenate([limit, limit]),
            bounds=(None, None),
            method="highs",
            options={"primal_feasibility_tolerance": LP_FEASIBILITY},
        )
        if result.status != 0 or result.x is None:
            raise RuntimeError(f"linear program of N = {chain.n_blocks} blocks: {result.message}")
        return result.x * unit, -np.add.reduce(np.split(result.ineqlin.marginals, 2))

    at_largest, sensitivity = extreme(+1)
    at_smallest, _ = extreme(-1)
    return LoadRange(
        largest=float(chain.drive_stiffness * at_largest[0]),
        smallest=float(chain.drive_stiffness * at_smallest[0]),
        compressions_at_largest=at_largest,
        compressions_at_smallest=at_smallest,
        sensitivity=sensitivity,
    )
