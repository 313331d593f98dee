"""The derivation of Eq. 15 in symbols: from the equations of motion to F_X = mu_s F_Z (Eqs. 2, 3, 11-14)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import sympy
from sympy import Expr, Symbol

from precursors.model.chain import Chain, whole

K, k, mu_s, F_Z = sympy.symbols("K k mu_s F_Z", positive=True)


@dataclass(frozen=True)
class Derivation:
    """What Eq. 12 gives for N blocks with symbolic weights, mu_s, K and k.

    `compressions` are y_i^max, `load` is F_X = K y_1^max; `compressions_as_printed` and `load_as_printed`
    are the same with the last line of Eq. 12 as the paper prints it.
    """

    n_blocks: int
    compressions: tuple[Expr, ...]
    load: Expr
    compressions_as_printed: tuple[Expr, ...]
    load_as_printed: Expr


@cache
def derive(n_blocks: int) -> Derivation:
    """Solve Eq. 12 for N blocks, corrected and as printed.

    Raises
    ------
    ValueError
        If `n_blocks` is not a whole number of at least 1.
    """
    n = whole("n_blocks", n_blocks, at_least=1)
    compressions = _solve(balances(n))
    as_printed = _solve(balances_as_printed(n))
    return Derivation(
        n_blocks=n,
        compressions=compressions,
        load=sympy.factor_terms(K * compressions[0]),
        compressions_as_printed=as_printed,
        load_as_printed=sympy.expand(K * as_printed[0]),
    )


def weights(n: int) -> tuple[Symbol, ...]:
    """Normal loads w_1..w_N."""
    # w_01 and not w_1 where N has two digits, because SymPy sorts terms by name.
    return tuple(Symbol(f"w_{i:0{len(str(n))}d}", positive=True) for i in range(1, n + 1))


def springs(n: int) -> tuple[Symbol, ...]:
    """Compressions y_1..y_N."""
    return sympy.symbols(f"y_1:{n + 1}", real=True)


def bound(n: int) -> Expr:
    """The bound mu_s F_Z, F_Z = w_1 + ... + w_N (Eqs. 8 and 14)."""
    return mu_s * sympy.Add(*weights(n))


def net_spring_forces(n: int) -> list[Expr]:
    """Net force of the springs on each block: Eqs. 2 and 3 in the compressions of Eq. 11."""
    x = sympy.symbols(f"x_0:{n + 1}", real=True)
    behind = [K * (x[0] - x[1])] + [k * (x[i - 1] - x[i]) for i in range(2, n + 1)]
    ahead = [k * (x[i] - x[i + 1]) for i in range(1, n)] + [sympy.S.Zero]
    y = springs(n)
    in_compressions = {x[i]: x[0] - sympy.Add(*y[:i]) for i in range(1, n + 1)}
    return [sympy.expand((b - a).xreplace(in_compressions)) for b, a in zip(behind, ahead, strict=True)]


def balances(n: int) -> list[Expr]:
    """Left-hand sides of Eq. 12 as they follow from Eq. 2: every block at rest and at its limit +mu_s w_i."""
    return [force - mu_s * w for force, w in zip(net_spring_forces(n), weights(n), strict=True)]


def balances_as_printed(n: int) -> list[Expr]:
    """Left-hand sides of Eq. 12 as the paper prints them, with K y_N in the last line."""
    y, f = springs(n), [mu_s * w for w in weights(n)]
    stiffness = [K] + [k] * (n - 1)
    lines = [stiffness[i] * y[i] - k * y[i + 1] - f[i] for i in range(n - 1)]
    return [*lines, K * y[-1] - f[-1]]


def sum_of_forces_is_load(n: int) -> bool:
    """Whether the net forces on all blocks add up to F_X = K y_1 in any state: the step from Eq. 5 to Eq. 14.

    The forces between blocks cancel, so a chain at rest has F_X = -sum f_i <= mu_s F_Z.
    """
    return sympy.expand(sympy.Add(*net_spring_forces(n)) - K * springs(n)[0]) == 0


def difference(a: Expr, b: Expr) -> Expr:
    """Difference a - b of two sums of products, which is 0 exactly if they are equal."""
    return sympy.factor_terms(sympy.expand(a - b))


def depends_on_sum_only(load: Expr, n: int) -> bool:
    """Whether a load has the derivative mu_s with respect to every weight, and so knows only their sum."""
    terms = sympy.expand(load)
    return all(sympy.diff(terms, w) == mu_s for w in weights(n))


def is_symmetric(load: Expr, n: int) -> bool:
    """Whether a load stays the same under every permutation of the weights."""
    w = weights(n)
    # Exchanges of neighbours generate all permutations.
    exchanges = ({w[i]: w[i + 1], w[i + 1]: w[i]} for i in range(n - 1))
    terms = sympy.expand(load)
    return all(terms.xreplace(exchange) == terms for exchange in exchanges)


def in_normal_load(load: Expr, n: int) -> Expr:
    """Write a load with F_Z - w_2 - ... - w_N for w_1 (Eq. 8): one that knows only F_Z keeps no w_i."""
    first, *others = weights(n)
    return sympy.expand(load.xreplace({first: F_Z - sympy.Add(*others)}))


def excess_formula(n: int) -> Expr:
    """Load that Eq. 12 as printed adds to mu_s F_Z: (k/K - 1) mu_s w_N for N > 1, nothing for N = 1."""
    return (k / K - 1) * mu_s * weights(n)[-1] if n > 1 else sympy.S.Zero


def overload_as_printed(n: int) -> Expr:
    """Force on block N in the state of Eq. 12 as printed, over its strength mu_s w_N.

    The printed last line asks for y_N = mu_s w_N / K, but the spring with this compression is k (K at N = 1
    only): the ratio is k/K, and the block would not be at rest.
    """
    state = dict(zip(springs(n), derive(n).compressions_as_printed, strict=True))
    return sympy.simplify(net_spring_forces(n)[-1].xreplace(state) / (mu_s * weights(n)[-1]))


def value(expression: Expr, chain: Chain) -> float:
    """Value of an expression in w_i, mu_s, K and k for a chain, in SI units."""
    numbers = dict(zip(weights(chain.n_blocks), chain.weights.tolist(), strict=True))
    numbers |= {mu_s: chain.mu_s, K: chain.drive_stiffness, k: chain.stiffness}
    exact = {symbol: sympy.Rational(number) for symbol, number in numbers.items()}
    return float(expression.xreplace(exact))


def _solve(equations: list[Expr]) -> tuple[Expr, ...]:
    y = springs(len(equations))
    (solution,) = sympy.linsolve(equations, y)
    return tuple(sympy.factor_terms(compression) for compression in solution)
