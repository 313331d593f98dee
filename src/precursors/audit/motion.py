"""The motion between two transitions, by the normal modes of the blocks that slide
(Eqs. 2-6)."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.linalg import svd

from precursors.model.chain import Chain, FloatArray


@dataclass(frozen=True, eq=False)
class Modes:
    """Normal modes of blocks that slide, between neighbours that do not move.

    frequencies (n,) [rad/s]; shapes (n blocks, n): displacement = shapes @ q;
    spring_shapes (n springs, n): the forces of the springs grow by -spring_shapes @ q.
    """

    frequencies: FloatArray
    shapes: FloatArray
    spring_shapes: FloatArray


def normal_modes(chain: Chain, first: int, last: int) -> Modes:
    """Normal modes of the blocks first..last, counted from 0, and of the springs behind
    and ahead of them.

    With springs s, the stiffness matrix is B B^T, B the bidiagonal matrix of
    +sqrt(s_i), -sqrt(s_i+1). Its singular values, not the eigenvalues of the product,
    keep the digits of a mode that is slower than the fastest by orders of magnitude
    (soft drive). Its right vectors give the spring forces without differences of nearly
    equal displacements. LAPACK's gesvd leaves a bidiagonal matrix as it is and finds
    its singular values to high relative accuracy (Demmel & Kahan, 1990).
    """
    roots = np.sqrt(chain.springs[first : last + 2])
    n = last - first + 1
    # A last row of zeros makes B square where a spring follows the last block; it adds
    # a frequency of zero.
    balance = np.diag(roots) - np.diag(roots[1:], 1)
    balance[n:] = 0.0
    left, singular, right = svd(balance, lapack_driver="gesvd", check_finite=False)
    singular = singular[:n]
    return Modes(
        frequencies=singular / math.sqrt(chain.mass),
        shapes=np.ascontiguousarray(left[:n, :n]),
        spring_shapes=roots[:, None] * right[:n].T * singular,
    )


def modes_of_all(
    slides: np.ndarray, modes_of_row: Callable[[int, int], Modes]
) -> Modes:
    """Normal modes of all blocks that slide, and of all springs; each row of neighbours
    has its own."""
    edges = np.flatnonzero(np.diff(slides, prepend=False, append=False))
    n = np.count_nonzero(slides)
    done = 0
    modes = Modes(np.zeros(n), np.zeros((n, n)), np.zeros((len(slides) + 1, n)))
    for first, end in edges.reshape(-1, 2).tolist():
        row = modes_of_row(first, end - 1)
        columns = slice(done, done + len(row.frequencies))
        modes.frequencies[columns] = row.frequencies
        modes.shapes[columns, columns] = row.shapes
        modes.spring_shapes[first : first + len(row.spring_shapes), columns] = (
            row.spring_shapes
        )
        done = columns.stop
    return modes


@dataclass(frozen=True, eq=False)
class ModalMotion:
    """Motion mode by mode: q'' + omega^2 q = push + ramp s, q = 0 and q' = speed at s =
    0."""

    modes: Modes
    speed: FloatArray
    push: FloatArray
    ramp: FloatArray

    def at(self, s: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Modal displacements, velocities and accelerations at the times s, each of
        shape (len(s), n)."""
        omega = self.modes.frequencies
        half = (0.5 * s)[:, None] * omega
        versine = 2 * np.sin(half) ** 2  # 1 - cos without cancellation
        sine = 2 * np.sin(half) * np.cos(half)
        cosine = 1 - versine
        # The difference cancels for omega s << 1, but relative to the drive's V s it
        # keeps all digits.
        lag = s[:, None] - sine / omega
        displacement = (self.speed / omega) * sine + (
            self.push * versine + self.ramp * lag
        ) / omega**2
        velocity = (
            self.speed * cosine
            + (self.push / omega) * sine
            + (self.ramp / omega**2) * versine
        )
        acceleration = (
            self.push * cosine + (self.ramp / omega - self.speed * omega) * sine
        )
        return displacement, velocity, acceleration

    def fourth_derivatives(self) -> tuple[FloatArray, FloatArray]:
        """Largest fourth derivatives of modal displacements and velocities, each of
        shape (n,)."""
        omega = self.modes.frequencies
        acceleration = np.hypot(self.push, self.ramp / omega - self.speed * omega)
        return acceleration * omega**2, acceleration * omega**3

    def largest_speed(self) -> float:
        """Largest speed that all modes together can have: the root of the sum of the
        squares."""
        omega = self.modes.frequencies
        largest = (
            np.abs(self.speed)
            + np.abs(self.push / omega)
            + 2 * np.abs(self.ramp / omega**2)
        )
        return float(np.linalg.norm(largest))
