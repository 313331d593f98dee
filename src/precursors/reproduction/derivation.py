"""Eq. 15 in symbols: from the equations of motion to F_X = mu_s F_Z (Eqs. 2, 3 and
11-14)."""

from __future__ import annotations

import sympy
from sympy import Expr, Symbol

K, k, mu_s = sympy.symbols("K k mu_s", positive=True)


def weights(n: int) -> tuple[Symbol, ...]:
    """Normal loads w_1..w_N."""
    # w_01 and not w_1 where N has two digits, because SymPy sorts terms by name.
    return tuple(
        Symbol(f"w_{i:0{len(str(n))}d}", positive=True) for i in range(1, n + 1)
    )


def compressions(n: int) -> tuple[Symbol, ...]:
    """Compressions y_1..y_N of the springs (Eq. 11)."""
    return sympy.symbols(f"y_1:{n + 1}", real=True)


def bound(n: int) -> Expr:
    """The bound mu_s F_Z with F_Z = w_1 + ... + w_N (Eqs. 8 and 14)."""
    return mu_s * sympy.Add(*weights(n))


def net_spring_forces(n: int) -> list[Expr]:
    """Net force of the springs on each block: Eqs. 2 and 3, written with the
    compressions of Eq. 11."""
    x = sympy.symbols(f"x_0:{n + 1}", real=True)
    behind = [K * (x[0] - x[1])] + [k * (x[i - 1] - x[i]) for i in range(2, n + 1)]
    ahead = [k * (x[i] - x[i + 1]) for i in range(1, n)] + [sympy.S.Zero]
    y = compressions(n)
    positions = {x[i]: x[0] - sympy.Add(*y[:i]) for i in range(1, n + 1)}
    return [
        sympy.expand((b - a).xreplace(positions))
        for b, a in zip(behind, ahead, strict=True)
    ]


def balances(n: int) -> list[Expr]:
    """Left-hand sides of Eq. 12 as they follow from Eq. 2: every block rests at its
    limit +mu_s w_i."""
    return [
        force - mu_s * w
        for force, w in zip(net_spring_forces(n), weights(n), strict=True)
    ]


def balances_as_printed(n: int) -> list[Expr]:
    """Left-hand sides of Eq. 12 as the paper prints them, with K y_N in the last
    line."""
    y = compressions(n)
    w = weights(n)
    lines = [
        (K if i == 0 else k) * y[i] - k * y[i + 1] - mu_s * w[i] for i in range(n - 1)
    ]
    return [*lines, K * y[-1] - mu_s * w[-1]]


def load(equations: list[Expr]) -> Expr:
    """The load F_X = K y_1 of the state in which all these left-hand sides are 0."""
    (solution,) = sympy.linsolve(equations, compressions(len(equations)))
    return sympy.expand(K * solution[0])
