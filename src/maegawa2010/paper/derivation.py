"""Eq. 15 in symbols: from the equations of motion to F_X = mu_s F_Z (Eqs. 2, 3 and
11-14)."""

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


def balances(n: int) -> list[Expr]:
    """Left-hand sides of Eq. 12 as they follow from Eqs. 2, 3 and 11: every block rests
    at its limit +mu_s w_i.

    The spring behind block i pushes it by K y_1 or k y_i, and the next spring, which
    block N does not have, pushes it back.
    """
    drive, *others = compressions(n)
    behind = [K * drive, *(k * y for y in others)]
    ahead = [*behind[1:], sympy.S.Zero]
    loads = weights(n)
    return [b - a - mu_s * w for b, a, w in zip(behind, ahead, loads, strict=True)]


def balances_as_printed(n: int) -> list[Expr]:
    """Left-hand sides of Eq. 12 as the paper prints them, with K y_N in the last
    line."""
    last = K * compressions(n)[-1] - mu_s * weights(n)[-1]
    return [*balances(n)[:-1], last]


def load(equations: list[Expr]) -> Expr:
    """The load F_X = K y_1 of the state in which all these left-hand sides are 0."""
    (solution,) = sympy.linsolve(equations, compressions(len(equations)))
    return sympy.expand(K * solution[0])
