"""Explicit Runge-Kutta methods by their coefficients."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.integrate import DOP853 as OF_SCIPY

from precursors.model.chain import FloatArray

ROUNDING = 1e-13


@dataclass(frozen=True, eq=False)
class Tableau:
    """The coefficients of an explicit Runge-Kutta method, checked when they are made.

    A step h from y has stages 0..s-1. Each evaluates the rates of a state y + h times
    some shares of the rates before it. Stage s, the end of the step, and extra stages
    after it serve for interpolation.

    Attributes
    ----------
    order : int
        The error of a step is of the order h^(order + 1).
    stages : array, shape (s, s)
        Row by row the shares of the rates in the state of a stage.
    weights : array, shape (s,)
        The shares in the state at the end.
    extra : sequence of e arrays, shape (s + 1 + e,)
        The shares in the states of the extra stages.
    dense : sequence of d arrays, shape (s + 1 + e,)
        What the interpolation adds to the cubic through values and rates at both ends,
        see `powers`.
    errors : sequence of 2 arrays, shape (s,), or of none
        Estimates of the error, see `runge_kutta.error_of`; without them the step is
        fixed.

    Raises
    ------
    ValueError
        If a stage needs rates that come later, or a linear system with constant forces,
        as the chain is between two transitions, is not solved to the order.
    """

    order: int
    stages: FloatArray
    weights: FloatArray
    extra: Sequence[FloatArray] = ()
    dense: Sequence[FloatArray] = ()
    errors: Sequence[FloatArray] = ()

    def __post_init__(self) -> None:
        if np.triu(self.stages).any():
            raise ValueError("a stage of an explicit method needs a rate after it")
        for power in range(1, self.order + 1):
            found = self.series[power]
            if abs(found * math.factorial(power) - 1.0) > ROUNDING:
                raise ValueError(
                    f"the share of h^{power} in a step must be 1/{power}!, "
                    f"but is {found:.17g}"
                )

    @property
    def series(self) -> FloatArray:
        """Coefficients of the powers of h in a step of y' = y."""
        rates = np.ones(len(self.weights))
        found = [1.0]
        for _ in range(max(self.order, len(rates))):
            found.append(float(self.weights @ rates))
            rates = self.stages @ rates
        return np.array(found)

    @property
    def shares(self) -> FloatArray:
        """The shares in the states of all stages, row s being the end of the step."""
        s = len(self.weights)
        n = s + 1 + len(self.extra)
        found = np.zeros((n, n))
        found[:s, :s] = self.stages
        found[s, :s] = self.weights
        for number, row in enumerate(self.extra, start=s + 1):
            found[number] = row
        return found

    @property
    def powers(self) -> FloatArray:
        """Interpolation within a step, shape (3 + d, s + 1 + e).

        At the part x of a step the state is y + h sum_n x^(n + 1) powers[n] @ rates. It
        is a sum of rows times x, x (1 - x), x^2 (1 - x), x^2 (1 - x)^2, ... (E. Hairer,
        S. P. Norsett and G. Wanner, Solving Ordinary Differential Equations I, 1993,
        II.6); the first three are the cubic.
        """
        s = len(self.weights)
        change, start, end = np.zeros((3, s + 1 + len(self.extra)))
        change[:s] = self.weights
        start[0] = 1.0
        end[s] = 1.0
        rows = [change, start - change, 2.0 * change - start - end, *self.dense]
        basis = np.polynomial.Polynomial([0.0, 1.0])
        found = np.zeros((len(rows), len(change)))
        for number, row in enumerate(rows):
            found[: number + 1] += np.outer(np.array(basis.coef[1:], dtype=float), row)
            basis *= np.polynomial.Polynomial([[1.0, -1.0], [0.0, 1.0]][number % 2])
        return found

    def energy_factor(self, z: float) -> float:
        """Factor on the energy of a mode in a step, z = omega dt."""
        of_step = np.polynomial.Polynomial(self.series)(1j * z)
        return float(abs(of_step) ** 2)


# W. Kutta, Z. Math. Phys. 46 (1901) 435-453: the classical method.
RK4 = Tableau(
    order=4,
    stages=np.diag([0.5, 0.5, 1.0], -1),
    weights=np.array([1.0, 2.0, 2.0, 1.0]) / 6.0,
)
# J. R. Dormand and P. J. Prince: order 8 with errors of order 5 and 3 and dense output
# of order 7 (Hairer et al., II.5-II.10). The coefficients are SciPy's.
DOP853 = Tableau(
    order=8,
    stages=OF_SCIPY.A,
    weights=OF_SCIPY.B,
    extra=tuple(OF_SCIPY.A_EXTRA),
    dense=tuple(OF_SCIPY.D),
    errors=(OF_SCIPY.E5[:-1], OF_SCIPY.E3[:-1]),
)
