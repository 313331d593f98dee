"""Chains, starts and reference solutions that several numerical tests use."""

import math

import numpy as np
from numpy.typing import ArrayLike

from precursors import Chain, Run, TransitionLimitError, simulate
from precursors.model.statics import balance_matrix, positions_from_compressions
from precursors.solver import plain

SLIDER = Chain.from_slider
# Theta of the paper's three scenes, by the names of their proved lists.
SCENES = {"uniform": "0", "trailing": "-5/6", "leading": "5/6"}


def first_transitions(chain: Chain, most: int, **options) -> Run:
    """The run, cut after `most` transitions."""
    try:
        return simulate(chain, max_transitions=most, **options)
    except TransitionLimitError as limit:
        return limit.run


def by_plain(
    chain: Chain,
    duration: float,
    until_global: bool = False,
    most: int = 10_000,
    **start: ArrayLike,
) -> tuple[np.ndarray, float]:
    """Rows (time, interval, block, mode, load) of transitions from the solver in plain
    Python, and the end of the run."""
    names = ("start_positions", "start_velocities")
    at = [np.array(start.get(name, np.zeros(chain.n_blocks))) for name in names]
    state = plain.at_start(chain, *at)
    rows, end = plain.find_transitions(chain, state, duration, until_global, most)
    return np.array(rows, float).reshape(-1, 5), end


def lone_slip(chain: Chain) -> tuple[float, float]:
    """Duration [s] and distance [m] of a slip of block 1 while the others rest.

    m x'' = drop + K V t - stiffness x from rest at x = 0, drop = (mu_s - mu_k) w_1. At
    the stop the net force is the mirror image of that at the release about mu_k w_1.
    """
    stiffness = chain.drive_stiffness + (chain.stiffness if chain.n_blocks > 1 else 0.0)
    drop = (chain.mu_s - chain.mu_k) * chain.weights[0]
    omega = math.sqrt(stiffness / chain.mass)
    seconds = (math.pi + 2 * math.atan(chain.loading_rate / (drop * omega))) / omega
    return seconds, (2 * drop + chain.loading_rate * seconds) / stiffness


def matrix_of_motion(springs, mass, friction, loading_rate, modes) -> np.ndarray:
    """Matrix of d/dt (T, v, 1) for spring forces T and velocities v in given modes (Eqs.
    2-6)."""
    n = len(springs)
    bonds = np.eye(n) - np.eye(n, k=-1)
    matrix = np.zeros((2 * n + 1, 2 * n + 1))
    matrix[:n, n:-1] = -springs[:, None] * bonds
    matrix[0, -1] = loading_rate
    matrix[n:-1, :n] = abs(modes)[:, None] * bonds.T / mass
    matrix[n:-1, -1] = -modes * friction / mass
    return matrix


def positions_under(chain: Chain, forces) -> np.ndarray:
    """Positions [m] in which the springs give each block a net force [N]."""
    return positions_from_compressions(
        np.linalg.solve(balance_matrix(chain), np.asarray(forces, float))
    )
