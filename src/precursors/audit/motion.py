"""The motion between two transitions, by the normal modes of the blocks that slide
(Eqs. 2-6)."""

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

# Compiled, as a run has as many intervals as transitions; a division by zero is inf.
inner: Any = untyped.njit(error_model="numpy")
outer: Any = entry(Path(__file__).parent, error_model="numpy")


class Modes(NamedTuple):
    """Normal modes of rows of blocks that slide, between neighbours that do not move.

    Of all rows, mode by mode: frequencies [rad/s]; shapes, the n displacements of the
    row's blocks; spring_shapes, the n + 1 forces by which its springs fall.
    """

    frequencies: FloatArray
    shapes: FloatArray
    spring_shapes: FloatArray


def normal_modes(chain: Chain, first: int, end: int) -> Modes:
    """Normal modes of the blocks from `first` to before `end`, counted from 0, and of
    the springs behind and ahead of them.

    With springs s, the stiffness matrix is B B^T, B the bidiagonal matrix of
    +sqrt(s_i), -sqrt(s_i+1). Its singular values, not the eigenvalues of the product,
    keep the digits of a mode that is slower than the fastest by orders of magnitude
    (soft drive). Its right vectors give the spring forces without differences of nearly
    equal displacements. LAPACK's gesvd leaves a bidiagonal matrix as it is and finds
    its singular values to high relative accuracy (Demmel & Kahan, 1990).
    """
    roots = np.sqrt(chain.springs[first : end + 1])
    n = end - first
    # A last row of zeros makes B square where a spring follows the last block; it adds
    # a frequency of zero.
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
    """Rows of neighbours that move, the first block of each, from 0, and the one beyond
    its last; and their modes one after the other."""
    padded = np.zeros(len(moves) + 2, dtype=bool)
    padded[1:-1] = moves
    rows = (padded[1:] != padded[:-1]).nonzero()[0].reshape(-1, 2)
    of_rows = [NO_MODES, *(modes_of_row(*row) for row in rows.tolist())]
    return rows, Modes(*map(np.concatenate, zip(*of_rows, strict=True)))


class ModalMotion(NamedTuple):
    """Motion mode by mode: q'' + omega^2 q = push + ramp s, q = 0 and q' = speed at s =
    0."""

    omega: FloatArray
    speed: FloatArray
    push: FloatArray
    ramp: FloatArray


@inner
def at(motion, j, s):
    """Displacement, velocity and acceleration of mode j at the time s."""
    omega = motion.omega[j]
    speed = motion.speed[j]
    push = motion.push[j]
    ramp = motion.ramp[j]
    half = 0.5 * s * omega
    versine = 2 * math.sin(half) ** 2  # 1 - cos without cancellation
    sine = 2 * math.sin(half) * math.cos(half)
    cosine = 1 - versine
    # The difference cancels for omega s << 1, but relative to the drive's V s it keeps
    # all digits.
    lag = s - sine / omega
    displacement = speed / omega * sine + (push * versine + ramp * lag) / omega**2
    velocity = speed * cosine + push / omega * sine + ramp / omega**2 * versine
    return displacement, velocity, push * cosine + (ramp / omega - speed * omega) * sine


@inner
def largest_acceleration(motion, j):
    """Largest acceleration of mode j; omega^2 and omega^3 times it are the largest
    fourth derivatives of displacement and velocity."""
    omega = motion.omega[j]
    return math.hypot(motion.push[j], motion.ramp[j] / omega - motion.speed[j] * omega)


@inner
def largest_speed(motion):
    """Largest speed that all modes together can have: the root of the sum of the
    squares."""
    total = 0.0
    for j in range(len(motion.omega)):
        omega = motion.omega[j]
        of_forces = abs(motion.push[j] / omega) + 2 * abs(motion.ramp[j] / omega**2)
        total += (abs(motion.speed[j]) + of_forces) ** 2
    return math.sqrt(total)
