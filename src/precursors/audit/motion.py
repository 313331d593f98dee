"""The motion between two transitions, from the normal modes of the sliding blocks (Eqs.
2-6)."""

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.lapack import dgesvd

from precursors.model.chain import Chain, FloatArray
from precursors.solver.record import IntArray
from precursors.support.compiled import entry, untyped

# Compiled, because runs have many intervals. Division by zero gives inf.
inner: Any = untyped.njit(error_model="numpy")
outer: Any = entry(Path(__file__).parent, error_model="numpy")


class Modes(NamedTuple):
    """Normal modes of rows of sliding blocks, whose neighbours do not move.

    The arrays list all modes of all rows. `frequencies` are in rad/s. For each mode of
    a row of n blocks, `shapes` has the n displacements of the blocks, and
    `spring_shapes` the n + 1 forces by which the springs are relieved.
    """

    frequencies: FloatArray
    shapes: FloatArray
    spring_shapes: FloatArray


def normal_modes(chain: Chain, first: int, end: int) -> Modes:
    """Return the normal modes of blocks `first` to `end` - 1, counted from 0, with the
    springs behind and ahead of them.

    With spring constants s_i, the stiffness matrix is B B^T, where B is the bidiagonal
    matrix of +sqrt(s_i), -sqrt(s_i+1). With a soft drive one mode is slower than the
    others by orders of magnitude. The singular values of B keep its digits, which the
    eigenvalues of the product lose. The right singular vectors give the spring forces
    without differences of nearly equal displacements. LAPACK's gesvd computes the
    singular values of a bidiagonal matrix to high relative accuracy (Demmel & Kahan,
    1990).
    """
    roots = np.sqrt(chain.springs[first : end + 1])
    n = end - first
    # If a spring follows the last block, a last row of zeros makes B square; it adds a
    # frequency of zero.
    balance = np.diag(roots) - np.diag(roots[1:], 1)
    balance[n:] = 0.0
    left, singular, right, _ = dgesvd(balance)
    singular = singular[:n]
    spring_shapes = np.zeros((n, n + 1))
    spring_shapes[:, : len(roots)] = singular[:, None] * right[:n] * roots
    return Modes(
        frequencies=singular / math.sqrt(chain.mass),
        shapes=left[:n, :n].T.ravel(),
        spring_shapes=spring_shapes.ravel(),
    )


NO_MODES = Modes(np.zeros(0), np.zeros(0), np.zeros(0))


def rows_and_modes(
    moves: NDArray[np.bool_], modes_of_row: Callable[[int, int], Modes]
) -> tuple[IntArray, Modes]:
    """Return the rows of moving neighbours, and their modes one after the other.

    A row is given by its first block, counted from 0, and the block after its last.
    """
    padded = np.zeros(len(moves) + 2, dtype=bool)
    padded[1:-1] = moves
    rows = (padded[1:] != padded[:-1]).nonzero()[0].reshape(-1, 2)
    of_rows = [NO_MODES, *(modes_of_row(*row) for row in rows.tolist())]
    return rows, Modes(*map(np.concatenate, zip(*of_rows, strict=True)))


class ModalMotion(NamedTuple):
    """Motion of each mode: q'' + omega^2 q = push + ramp s, with q = 0 and q' = speed
    at s = 0."""

    omega: FloatArray
    speed: FloatArray
    push: FloatArray
    ramp: FloatArray


@inner
def at(motion, j, s):
    """Return displacement, velocity and acceleration of mode j at time s."""
    omega = motion.omega[j]
    speed = motion.speed[j]
    push = motion.push[j]
    ramp = motion.ramp[j]
    half = 0.5 * s * omega
    versine = 2 * math.sin(half) ** 2  # 1 - cos without cancellation
    sine = 2 * math.sin(half) * math.cos(half)
    cosine = 1 - versine
    # For omega s << 1 the difference cancels, but it is accurate relative to the path V
    # s of the drive.
    lag = s - sine / omega
    displacement = speed / omega * sine + (push * versine + ramp * lag) / omega**2
    velocity = speed * cosine + push / omega * sine + ramp / omega**2 * versine
    return displacement, velocity, push * cosine + (ramp / omega - speed * omega) * sine


@inner
def largest_acceleration(motion, j):
    """Return the largest acceleration of mode j.

    Times omega^2 and omega^3 it is the largest fourth derivative of displacement and
    velocity.
    """
    omega = motion.omega[j]
    return math.hypot(motion.push[j], motion.ramp[j] / omega - motion.speed[j] * omega)


@inner
def largest_speed(motion):
    """Return a bound of the speed of all modes: the root of the sum of their
    squares."""
    total = 0.0
    for j in range(len(motion.omega)):
        omega = motion.omega[j]
        of_forces = abs(motion.push[j] / omega) + 2 * abs(motion.ramp[j] / omega**2)
        total += (abs(motion.speed[j]) + of_forces) ** 2
    return math.sqrt(total)
