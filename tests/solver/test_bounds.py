"""The solver passes over no root: its bounds of a window, safe steps and root search are
checked on exact series.

Steps that are too short only cost time, which `test_work` counts.
"""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from chains import SLIDER, matrix_of_motion

from precursors.solver.kernel import proof, roots
from precursors.solver.kernel.arrays import memory_for
from precursors.solver.kernel.layout import ORDER, WINDOW
from precursors.solver.kernel.proof import TAIL
from precursors.solver.kernel.units import parameters, set_up

WINDOWS = 400
ROUNDING = 1e-12  # error of numpy.roots for a simple root, as a share of a window


@pytest.fixture(scope="module")
def windows() -> list[tuple[np.ndarray, float]]:
    """Return series with c_0 > 0, each with its first root in [0, 1] or infinity.

    Terms have random signs and decrease as in a Taylor series. The first three are
    parabolas, for which the safe step is the longest possible.
    """
    random = np.random.default_rng(3)
    size = [2.0**k / math.factorial(k) for k in range(12)]
    all_series = random.standard_normal((WINDOWS, 12)) * size
    all_series[:, 0] = abs(all_series[:, 0])
    all_series[:3] = np.pad(
        [[1.0, -0.5, -2.0], [1, 0, -2], [1, 0.5, -2]], [(0, 0), (0, 9)]
    )
    series_and_roots = []
    for series in all_series:
        all_roots = np.roots(series[::-1])
        real = all_roots.real[abs(all_roots.imag) < 1e-9]
        within = real[(real >= 0.0) & (real <= 1.0)]
        series_and_roots.append((series, float(within.min(initial=np.inf))))
    return series_and_roots


def test_safe_step_passes_no_root(windows):
    n = np.arange(12)
    for c, root in windows:
        curvature = (n * (n - 1) * abs(c)).sum()
        assert roots.safe_step.py_func(c[0], c[1], curvature) <= root + ROUNDING


@pytest.mark.parametrize("shift", [0, 2])
def test_search_returns_the_first_root_or_none(windows, shift, monkeypatch):
    """With `shift`, the series also has roots at the start, which are ignored."""
    for function in (roots.safe_step, roots.move_series):
        monkeypatch.setattr(roots, function.__name__, function.py_func)
    progress = SimpleNamespace(root_steps=0)
    for c, root in windows:
        first = roots.first_root.py_func(
            len(c) + shift, 1e-15, np.append(np.zeros(shift), c), progress
        )
        assert first == pytest.approx(root, abs=1e-9) if root <= 1.0 else first > 1.0


def test_function_stays_within_the_bounds_of_its_window(monkeypatch):
    """A function has terms up to u^5, a value at the end, and the worst remainder."""
    lanes = SimpleNamespace(smaller=np.minimum, larger=np.maximum)
    monkeypatch.setattr(proof, "lanes", lanes)
    random = np.random.default_rng(6)
    terms = random.normal(size=(6, 2000))
    at_end = random.normal(size=2000)
    rest = 10 ** random.uniform(-2.0, 3.0, 2000)
    binomials = np.array([math.comb(6, k) for k in range(6)])[:, None]
    low, high = proof.enclose.py_func(*terms / binomials, at_end, rest)
    u = np.linspace(0.0, 1.0, 200)[:, None]
    middle = sum(terms[k] * u**k for k in range(6))
    middle = middle + (at_end - terms.sum(axis=0)) * u**6
    reach = u**6 * (1.0 - u) * rest
    least = (middle - reach).min(axis=0)
    largest = (middle + reach).max(axis=0)
    assert (np.minimum(low, at_end) <= least + ROUNDING).all()
    assert (largest <= high + ROUNDING).all()
    # The current width of the bounds: less is better.
    assert np.median((high - low) / (largest - least)) < 1.57


def test_bound_of_the_remainder_has_its_closed_form():
    """sum_n (n - 6) s^n/n! over n >= 9 is (s - 6) e^s less its first terms."""
    terms = [WINDOW**n / math.factorial(n) for n in range(9)]
    rest = WINDOW * (math.exp(WINDOW) - sum(terms[:8])) - 6 * (
        math.exp(WINDOW) - sum(terms)
    )
    assert TAIL * WINDOW**9 / math.factorial(9) == pytest.approx(rest, rel=1e-9)


def test_remainder_of_a_series_is_within_its_bound():
    """Terms from the ninth on follow from the equations of motion, for all velocities and
    forces in the longest window."""
    later = range(9, ORDER + 1)
    factor = np.array([(n - 6) * WINDOW**n / math.factorial(n) for n in later])
    for seed in range(200):
        random = np.random.default_rng(seed)
        n = int(random.choice([1, 2, 5, 12]))
        modes = random.choice([-1, 0, 1], n, p=[0.4, 0.2, 0.4])
        chain = SLIDER(n, drive_stiffness=25e6 * 10 ** random.uniform(-1, 0.5))
        units = set_up.py_func(parameters(chain), chain.weights, memory_for(n))
        state = np.concatenate(
            [10 ** random.uniform(-2, 2) * random.normal(size=n), modes * 0.1, [1.0]]
        )
        rate = matrix_of_motion(
            chain.springs,
            chain.mass,
            chain.kinetic_friction,
            chain.loading_rate,
            modes,
        )
        velocities = []
        forces = []
        for _ in range(ORDER + 2):
            velocities.append(state[n:-1] / units.speed)
            forces.append(state[:n] - np.append(state[1:n], 0.0))
            state = units.tau * rate @ state
        largest = abs(np.array(velocities[7:9])).max()
        watched = np.where(modes, velocities, forces)[9 : ORDER + 1]
        rest = (factor @ abs(watched)).max()
        bound = TAIL * WINDOW**9 / math.factorial(9) * largest
        assert rest <= bound * (1 + ROUNDING)
