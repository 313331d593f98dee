"""No root is passed over: the proof of a window, the safe steps and the search, against
exact series."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest
from numba import njit

from precursors import Chain
from precursors.solver.kernel import roots
from precursors.solver.kernel.arrays import PROGRESS, memory_for, row
from precursors.solver.kernel.events import last_column
from precursors.solver.kernel.layout import ORDER, WIDTH, WINDOW
from precursors.solver.kernel.proof import TAIL, prove, search
from precursors.solver.kernel.series import powers
from precursors.solver.kernel.units import lay_out, parameters, set_up

WINDOWS, SERIES = 400, 100
ROUNDING = 1e-12  # of a window; numpy.roots knows a simple root to some roundings
# A bound that is far too small costs time. In a typical window one step reaches this
# part of the way to the root, and this part of the functions without a root is proved
# to have none.
ONE_STEP, PROVED = 0.3, 0.5
# Safe steps to the first roots of all windows. Less is better: write it down here.
ROOT_STEPS = 1667
# How far below zero a dip is that has to be seen, beside terms of up to some 1000 that
# are rounded.
DIP = 1e-11


def series(seed: int, n: int = 12) -> np.ndarray:
    """c_0 > 0 and terms of either sign that fall off like those of a Taylor series."""
    random = np.random.default_rng(seed)
    terms = (
        random.standard_normal(n)
        * 2.0 ** np.arange(n)
        / [math.factorial(k) for k in range(n)]
    )
    return np.append(abs(terms[:1]), terms[1:])


def first_root(c: np.ndarray) -> float:
    """First root in [0, 1], or infinity."""
    found = np.roots(c[::-1])
    real = found.real[
        (abs(found.imag) < 1e-9) & (found.real >= 0.0) & (found.real <= 1.0)
    ]
    return float(real.min(initial=np.inf))


@pytest.fixture(scope="module")
def windows() -> list[tuple[np.ndarray, float]]:
    found = [(c, first_root(c)) for c in map(series, range(WINDOWS))]
    assert 100 < sum(root <= 1.0 for _, root in found) < WINDOWS - 100
    return found


def test_one_step_passes_no_root_and_is_not_far_too_short(windows):
    n = np.arange(12)
    steps = [
        (roots.safe_step.py_func(c[0], c[1], (n * (n - 1) * abs(c)).sum()), root)
        for c, root in windows
    ]
    assert all(step <= root + ROUNDING for step, root in steps)
    assert np.median([step / root for step, root in steps if root <= 1.0]) > ONE_STEP


@pytest.mark.parametrize("shift", [0, 1, 2])
def test_the_search_ends_at_the_first_root_or_proves_that_there_is_none(windows, shift):
    """Also where the series begins with roots at the start, which were dealt with
    already."""
    progress = SimpleNamespace(root_steps=0)
    for c, root in windows:
        before = progress.root_steps
        found = roots.first_root.py_func(
            len(c) + shift, 1e-15, np.append(np.zeros(shift), c), progress
        )
        assert found == pytest.approx(root, abs=1e-9) if root <= 1.0 else found > 1.0
        # Where the first term outweighs all that are negative, no step is needed to
        # know it.
        assert (progress.root_steps == before) == (
            c[0] + np.minimum(c[1:], 0.0).sum() > 0.0
        )
    assert progress.root_steps == pytest.approx(
        ROOT_STEPS, rel=0.002
    )  # fused products may round one


def test_the_bound_of_the_rest_is_met_where_no_later_row_is_smaller():
    """sum_n (n - 6) s^n/n! over n >= 9, as a closed form: (s - 6) e^s less its first
    terms."""
    terms = [WINDOW**n / math.factorial(n) for n in range(9)]
    rest = WINDOW * (math.exp(WINDOW) - sum(terms[:8])) - 6 * (
        math.exp(WINDOW) - sum(terms)
    )
    assert TAIL * WINDOW**9 / math.factorial(9) == pytest.approx(rest, rel=1e-9)


@pytest.mark.parametrize("length", [0.25, 1.0, WINDOW])
def test_the_rest_of_a_series_is_within_its_bound(length):
    """Of terms from the ninth on, of all that is watched; they come from the equations
    of motion."""
    shares, factor = (
        [],
        [max(n - 6, 0) * length**n / math.factorial(n) for n in range(ORDER + 1)],
    )
    for seed in range(200):
        random = np.random.default_rng(seed)
        n = int(random.choice([1, 2, 5, 12]))
        modes = random.choice([-1, 0, 1], n, p=[0.4, 0.2, 0.4])
        chain = Chain(
            np.ones(n),
            1e-3,
            25e6,
            25e6 * 10 ** random.uniform(-1, 0.5),
            1e-4,
            0.7,
            0.45,
        )
        units = set_up.py_func(parameters(chain), chain.weights, np.zeros((3, n + 2)))
        state = np.concatenate(
            [10 ** random.uniform(-2, 2) * random.normal(size=n), modes * 0.1, [1.0]]
        )
        velocities, forces = [], []
        for _ in range(ORDER + 2):
            velocities.append(state[n:-1] / units.speed)
            forces.append(state[:n] - np.append(state[1:n], 0.0))
            state = units.tau * rate_of(chain, modes) @ state
        largest = abs(np.array(velocities[7:9])).max()
        watched = np.where(modes, velocities[: ORDER + 1], forces[: ORDER + 1])
        rest = (np.array(factor)[9:, None] * abs(watched[9:])).sum(axis=0).max()
        bound = TAIL * length**9 / math.factorial(9) * largest
        assert rest <= bound * (1 + ROUNDING)
        shares.append(rest / bound if bound else 1.0)
    assert np.median(shares) > 0.2


def rate_of(chain: Chain, modes: np.ndarray) -> np.ndarray:
    """Matrix of d/dt (T, v, 1): spring forces and velocities, with the blocks in their
    modes (Eqs. 2-6)."""
    n = chain.n_blocks
    bonds, rate = np.eye(n) - np.eye(n, k=-1), np.zeros((2 * n + 1, 2 * n + 1))
    rate[:n, n:-1] = -chain.springs[:, None] * bonds
    rate[0, -1] = chain.loading_rate
    rate[n:-1, :n] = abs(modes)[:, None] * bonds.T / chain.mass
    rate[n:-1, -1] = -modes * chain.kinetic_friction / chain.mass
    return rate


@njit(error_model="numpy")
def look_at(
    parameters,
    weights,
    memory,
    rows,
    block,
    slides,
    sign,
    hold,
    at_end,
    s,
    order,
    progress,
):
    """Whether a block is open and what its search finds (share, block, side), from rows
    of derivatives."""
    chain, motion = lay_out(parameters, weights, memory)
    n_blocks = weights.shape[0]
    for n in range(rows.shape[0]):
        for i in range(1, n_blocks + 1):
            row(n, motion)[i] = rows[n, i - 1]
    motion.slides[block], motion.sign[block], motion.hold[block] = slides, sign, hold
    motion.mode[block], motion.felt[block] = int(slides * sign), 1.0
    motion.velocity[block] = motion.net_force[block] = at_end
    powers(s, order, motion.weight)
    end = last_column(chain, n_blocks)
    prove(end, 0, motion)
    group = 1 + (block - 1) // WIDTH * WIDTH
    is_open = (motion.open[group] >> (block - group)) & 1
    return is_open, search(order, end, 0.0, chain, motion, progress[0])


# Whether the block watched slides, the sign of what is watched, and whether that is the
# farther limit.
SENSES = [
    (1, 1, False),
    (1, -1, False),
    (0, 1, False),
    (0, -1, False),
    (0, 1, True),
    (0, -1, True),
]
BLOCKS, WATCHED, FAR, LENGTH = 12, 6, 1000.0, 1.2


def looked_at(terms, sense, others=()) -> tuple[bool, tuple[float, int, int]]:
    """The same for a block whose function has these terms; `others` are (row, block,
    number) besides."""
    slides, sign, is_far = sense
    hold = 0.0 if slides else FAR
    shape = Chain(np.ones(BLOCKS), 1e-3, 25e6, 25e6, 1e-4, 0.7, 0.45)
    first = np.array([hold if n == 0 else 0.0 for n in range(len(terms))])
    # At the farther limit the function is 2 hold less that of the nearer one.
    of_force = sign * (np.array(terms, float) - first) * (-1.0 if is_far else 1.0)
    rows = np.zeros((ORDER + 2, BLOCKS))
    for n, term in enumerate(of_force):
        rows[n + (not slides), WATCHED - 1] = term * math.factorial(n) / LENGTH**n
    for n, block, size in others:
        rows[n, block - 1] = size
    progress, memory = np.zeros(1, PROGRESS), memory_for(BLOCKS)
    numbers = (
        WATCHED,
        slides,
        float(sign),
        hold,
        float(of_force.sum()),
        LENGTH,
        ORDER,
        progress,
    )
    is_open, found = look_at(parameters(shape), shape.weights, memory, rows, *numbers)
    return bool(is_open), found


@pytest.mark.parametrize("sense", SENSES)
class TestOfTheFunctionOfABlock:
    """It may slide either way, or stick and reach either limit."""

    def test_one_that_dips_below_zero_is_never_proved_and_most_that_do_not_are(
        self, sense
    ):
        """(u - r)^2 times a positive series, less a little or with as much to spare as
        a tenth of it."""
        n_proved = 0
        for seed in range(SERIES):
            r = np.random.default_rng(seed).uniform(0.02, 0.98)
            positive = series(seed, 7)
            positive[0] += abs(positive[1:]).sum()
            touching = np.convolve([r * r, -2.0 * r, 1.0], positive)
            lift = np.zeros(len(touching))
            lift[0] = 1.0
            assert looked_at(touching - DIP * lift, sense)[0]
            n_proved += not looked_at(
                touching + 0.1 * abs(touching).sum() * lift, sense
            )[0]
        assert n_proved > PROVED * SERIES

    @pytest.mark.parametrize("k", range(7))
    def test_a_coefficient_below_zero_leaves_the_block_open(self, sense, k):
        """The Bernstein coefficients of degree 6 are 1, but for one; none of them below
        zero is a proof."""
        for height, is_proved in ((-10.0, False), (0.5, True)):
            b = [1.0 + (height - 1.0) * (i == k) for i in range(7)]
            if k == 5 and not is_proved:
                b[6] += (
                    # or the last coefficient of degree 7, (6 b_5 + b_6) / 7, would tell
                    60.0
                )
            differences = [
                sum((-1) ** (j - i) * math.comb(j, i) * b[i] for i in range(j + 1))
                for j in range(7)
            ]
            is_open, _ = looked_at(
                [math.comb(6, j) * d for j, d in enumerate(differences)], sense
            )
            assert is_open == (not is_proved)

    @pytest.mark.parametrize("share", [0.99, 1.01])
    @pytest.mark.parametrize(
        ("terms", "others"),
        [
            *(
                (terms, ())
                for terms in ((1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0))
            ),
            *(
                ((0.0, 0.0), ((n, block, 1.0),))
                for n in (7, 8)
                for block in (1, BLOCKS)
            ),
        ],
    )
    def test_the_rest_counts_whole(self, sense, terms, others, share):
        """The function is 1 but for a_7, a_8 and, so that it ends at 1, a_6; `others`
        give later terms.

        All coefficients are 1 but the last, 1 - R / 7: R = |a_7| + 2 |a_8| + the bound
        of later terms.
        """
        a = {6: -sum(terms), 7: terms[0], 8: terms[1]}
        # Row 7 of a velocity is its seventh derivative, and that of a net force is its
        # sixth.
        own = [
            math.factorial(n) / LENGTH**n * abs(a[n])
            for n in ((7, 8) if sense[0] else (6, 7))
        ]
        largest = max(*own, *(size for _, _, size in others))
        later = TAIL * LENGTH**9 / math.factorial(9) * largest
        factor = share * 7.0 / (abs(a[7]) + 2 * abs(a[8]) + later)
        all_terms = [1.0, *[0.0] * 5, *(factor * term for term in a.values())]
        scaled = [(n, block, factor * size) for n, block, size in others]
        assert looked_at(all_terms, sense, scaled)[0] == (share > 1.0)

    @pytest.mark.parametrize("n", [1, 2, 3, 8, ORDER])
    def test_a_search_has_every_term(self, sense, n):
        """1 - 2 u^n vanishes at 2^(-1/n)."""
        slides, sign, is_far = sense
        is_open, found = looked_at([1.0, *[0.0] * (n - 1), -2.0], sense)
        side = 1 if slides else (sign if is_far else -sign)
        assert is_open
        assert found == (pytest.approx(0.5 ** (1 / n)), WATCHED, side)
