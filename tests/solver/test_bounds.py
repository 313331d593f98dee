"""The root search never steps over a root: each of its bounds against the whole series, on random windows."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from chains import first_transitions
from numba import njit
from random_chains import trial
from scipy.linalg import expm

from precursors import Chain
from precursors.methods.stability import stiffness_matrix
from precursors.solver.kernel import bounds, events, roots, units, watch
from precursors.solver.kernel import series as kernel_series
from precursors.solver.kernel.arrays import Search, System, Window, divide, memory_for
from precursors.solver.kernel.layout import (
    BEND,
    C0,
    C1,
    C2,
    C3,
    FINAL,
    LEVELS,
    NEGLIGIBLE,
    POWER,
    REACH,
    REST,
    ROUGH,
    ROUNDINGS,
    ROWS,
    TURN,
    WHOLE,
    WIDTH,
    WINDOW,
    order_for,
)
from precursors.solver.kernel.units import scale

WINDOWS, HARD_WINDOWS = 400, 200
ROUNDING = 1e-12  # of a window; numpy.roots knows a simple root to some roundings
# A bound that is far too small costs time. In a typical window one step reaches this part of the way to
# the root, and the four steps of the cubic this part.
ONE_STEP, FOUR_STEPS = 0.3, 0.8
# What a series has beyond its eighth term is, in a typical window of this length, this part of its bound.
SPAN, TAIL_SHARE = 0.5, 0.6
# The same of all beyond the fourth term, of which the kernel has four one by one.
REST_SHARE = 0.9
# Gershgorin's bound over the largest frequency: the ends of a short chain make it loose.
LOOSEST = 1.35


def series(seed: int, n: int = 12) -> np.ndarray:
    """c_0 > 0 and terms of either sign that fall off like those of a Taylor series."""
    random = np.random.default_rng(seed)
    terms = random.standard_normal(n) * 2.0 ** np.arange(n) / [math.factorial(k) for k in range(n)]
    return np.append(abs(terms[:1]), terms[1:])


def first_root(c: np.ndarray) -> float:
    """First root in [0, 1], or infinity."""
    found = np.roots(c[::-1])
    real = found.real[(abs(found.imag) < 1e-9) & (found.real >= 0.0) & (found.real <= 1.0)]
    return float(real.min(initial=np.inf))


def search_of(c: np.ndarray, zero: float = 1e-15) -> Search:
    """One slot of the search that watches a series in the window [0, 1]."""
    level = np.zeros((1, LEVELS))
    level[0, :3] = 0.0, 1.0, zero
    whole = np.zeros((1, ROWS + 1))
    whole[0, : len(c)] = c
    numbers = np.zeros((3, 8), np.int64)
    return Search(whole, level, np.zeros(8), *numbers)


@pytest.fixture(scope="module")
def windows() -> list[tuple[np.ndarray, float]]:
    drawn = [series(seed) for seed in range(WINDOWS)]
    found = [(c, first_root(c)) for c in drawn]
    assert 100 < sum(root <= 1.0 for _, root in found) < WINDOWS - 100
    return found


def curvature(c: np.ndarray) -> float:
    """Bound of |g''| on [0, 1]."""
    n = np.arange(len(c))
    return float((n * (n - 1) * abs(c)).sum())


def test_one_step_passes_no_root_and_is_not_far_too_short(windows):
    steps = [(bounds.safe_step.py_func(c[0], c[1], curvature(c)), root) for c, root in windows]
    assert all(step <= root + ROUNDING for step, root in steps)
    assert np.median([step / root for step, root in steps if root <= 1.0]) > ONE_STEP


def test_the_cubic_passes_no_root_whatever_the_sign_of_the_rest(windows):
    shares = []
    for c, root in windows:
        rest = abs(c[4:]).sum()
        found = bounds.cubic_bound.py_func(*c[:4], rest)
        worst = first_root(np.array([*c[:4], -rest]))
        assert found <= min(root, worst) + ROUNDING
        if worst <= 1.0:
            shares.append(found / worst)
    assert np.median(shares) > FOUR_STEPS


def test_what_is_surely_positive_has_no_root(windows):
    sure = [root for c, root in windows if bounds.surely_positive.py_func(*c[:4], abs(c[4:]).sum())]
    assert len(sure) > WINDOWS / 20
    assert min(sure) == np.inf


@pytest.mark.parametrize("shift", [0, 1, 2])
def test_the_search_ends_at_the_first_root_or_proves_that_there_is_none(windows, shift):
    """Also where the series begins with roots at the start, which were dealt with already."""
    for c, root in windows:
        search = search_of(np.append(np.zeros(shift), c))
        bound = roots.examine.py_func(0, len(c) + shift, search)
        for _ in range(200):
            assert bound <= root + ROUNDING or bound > 1.0 <= root
            if search.stage[0] == FINAL or not bound <= 1.0:
                break
            assert search.stage[0] == WHOLE
            bound = roots.refine.py_func(0, bound, search)
        assert bound == pytest.approx(root, abs=1e-9) if root <= 1.0 else bound > 1.0


def rate_of(chain: Chain, modes: np.ndarray) -> np.ndarray:
    """Matrix of d/dt (T, v, 1): spring forces and velocities, with the blocks in their modes (Eqs. 2-6)."""
    n = chain.n_blocks
    bonds, rate = np.eye(n) - np.eye(n, k=-1), np.zeros((2 * n + 1, 2 * n + 1))
    rate[:n, n:-1] = -chain.springs[:, None] * bonds
    rate[0, -1] = chain.loading_rate
    rate[n:-1, :n] = abs(modes)[:, None] * bonds.T / chain.mass
    rate[n:-1, -1] = -modes * chain.kinetic_friction / chain.mass
    return rate


def event_functions(chain: Chain, modes: np.ndarray, states: np.ndarray) -> np.ndarray:
    """Speed of each block that slides [m/s], and how far the others are from mu_s w, over mu_s w."""
    force, velocity = states[: chain.n_blocks], states[chain.n_blocks : -1]
    distance = 1.0 - abs(force - np.append(force[1:], 0.0 * force[:1], axis=0)) / chain.strength[:, None]
    return np.where(modes[:, None], modes[:, None] * velocity, distance)


def hard_window(seed: int) -> tuple[Chain, np.ndarray, np.ndarray, np.ndarray]:
    """A chain, modes, times and states in which functions dip below zero, by as little as 1e-5."""
    random = np.random.default_rng(seed)
    n, dip = int(random.choice([1, 2, 3, 7, 12, 30])), 10 ** random.uniform(-5, -1)
    modes, drive_stiffness = random.integers(-1, 2, n), 25e6 * 10 ** random.uniform(-2, 1)
    modes[i := random.integers(n)] = 1
    chain = Chain(random.uniform(1, 100, n), 1e-3, 25e6, drive_stiffness, 1e-4, 0.7, 0.7 * random.uniform())
    speeds = 10 ** random.uniform(-4, 0, n)
    state = np.concatenate([10 ** random.uniform(-2, 2) * random.normal(size=n), modes * speeds, [1.0]])
    times = np.linspace(0.0, 1.3 * math.sqrt(chain.mass / (50e6 + 2 * max(25e6, drive_stiffness))), 513)
    step = expm(rate_of(chain, modes) * times[1])
    states = np.array([state, state + np.eye(2 * n + 1)[n + i]]).T[:, None]
    while states.shape[1] < len(times):
        states, step = np.hstack([states, np.tensordot(step, states, 1)]), step @ step
    states, per_speed = states[:, : len(times), 0], np.diff(states[:, : len(times)])[:, :, 0]
    # Block i starts with such a speed that it stops nearly, or for a moment; it may start at rest nearly.
    slower = (states[n + i] / per_speed[n + i])[per_speed[n + i] > 0.2].min()
    states += (max((1 - dip) * (state[n + i] - slower), 1e-4) - state[n + i]) * per_speed
    # Blocks that stick have limits that they reach for a moment, or not at all.
    net = 1.0 - event_functions(replace(chain, mu_s=1.0, mu_k=0.0, weights=np.ones(n)), 0 * modes, states)
    limits = np.maximum(
        np.where(random.random(n) < 0.3, 1 - dip, 1.5) * net.max(axis=1), 1.000001 * net[:, 0]
    )
    return replace(chain, weights=np.where(modes, chain.weights, limits / chain.mu_s)), modes, times, states


def test_no_transition_of_a_chain_is_passed_over():
    """The first one is a root of the function of its block, and no function has been below zero before."""
    for chain, modes, times, states in map(hard_window, range(HARD_WINDOWS)):
        n, n_sliding = chain.n_blocks, np.count_nonzero(modes)
        start = {
            "start_positions": -np.cumsum(states[:n, 0] / chain.springs),
            "start_velocities": states[n:-1, 0],
        }
        run = first_transitions(chain, n_sliding + 1, duration=times[-1], **start)
        below = times[(event_functions(chain, modes, states) < -ROUNDING).any(axis=0)]
        assert (run.transitions["time"][:n_sliding] == 0.0).all()
        if len(run.transitions) > n_sliding:
            time, block, *_ = run.transitions[n_sliding]
            then = expm(rate_of(chain, modes) * time) @ states[:, :1]
            assert abs(event_functions(chain, modes, then)[block - 1]) < 1e-9
            below = below[below < time]
        assert not below.size


@njit(error_model="numpy")
def bounds_of_terms(rows, weight, modes, window, memory):
    """What the kernel takes for the largest sum of terms 8, 9, ..., for its curvature, and for all speeds."""
    n_blocks = len(modes)
    motion, fastest = divide(memory, n_blocks)[1], np.zeros(n_blocks)
    for n in range(len(rows)):
        motion.weight[n] = weight[n]
        for i in range(n_blocks + 1):
            motion.rate[n, i] = rows[n, i]
    for i in range(n_blocks):
        motion.sense[i + 1] = modes[i]
    tails = watch.tail_bounds(window, motion.rate)
    for i in range(window.first, window.final + 1, WIDTH):
        watch.may_stop(i, tails[0], motion)
    for i in range(n_blocks):
        fastest[i] = motion.fastest[i + 1]
    return tails, fastest


def test_the_bounds_of_a_series_hold_for_all_its_terms_and_are_not_far_too_large():
    """Also for a part of a chain, whose neighbours move; the terms come from the equations of motion."""
    order, share = order_for(SPAN), []
    orders = np.arange(order + 1)[:, None]
    weight = np.array([SPAN**n / math.factorial(n) for n in range(order + 1)])
    for seed in range(200):
        random = np.random.default_rng(seed)
        n, first, final, end = random.choice([(5, 1, 8, 8), (12, 1, 12, 12), (12, 5, 8, 12)])
        modes = random.choice([-1, 0, 1], n, p=[0.4, 0.2, 0.4])
        chain = Chain(np.ones(n), 1e-3, 25e6, 25e6 * 10 ** random.uniform(-1, 0.5), 1e-4, 0.7, 0.45)
        rows, rate = np.zeros((order + 1, n + 1)), rate_of(chain, modes) * scale(chain).tau
        force, speed = 10 ** random.uniform(-2, 2, n) * random.normal(size=n), 10 ** random.uniform(-4, 0, n)
        state = np.concatenate([force, modes * speed, [1.0]])
        rows[0, 0] = chain.drive_velocity
        for k in range(order + 1):
            rows[k, 1:], state = state[n:-1], rate @ state
        window = Window(0.0, SPAN, SPAN, first, final, n, end, False, 0.0)
        tails, fastest = bounds_of_terms(rows, weight, modes, window, memory_for(n))
        terms = abs(rows * weight[:, None])[:, first : final + 1]
        assert (fastest[first - 1 : final] >= (1 - ROUNDING) * terms.sum(axis=0)).all()
        bend = orders * (orders - 1) * terms
        share.append([terms[8:].sum(axis=0).max() / tails[0], bend[8:].sum(axis=0).max() / tails[1]])
    assert np.max(share) <= 1.0
    assert np.median(share) > TAIL_SHARE


@njit(error_model="numpy")
def watched_functions(numbers, weights, modes, force, velocity, memory):
    """What the root search is told of the functions that may vanish in a window, and their whole series."""
    n = len(modes)
    columns, motion, search = divide(memory, n)
    tau, speed, drive_velocity = units.set_up(numbers, weights, n, columns)
    chain = System(n, tau, speed, drive_velocity, columns[0], columns[1], columns[2])
    for i in range(n):
        motion.spring_force[i + 1], motion.velocity[i + 1] = force[i], velocity[i]
        motion.mode[i + 1] = modes[i]
    events.lay_out(chain, motion)
    end = WIDTH * ((n + WIDTH - 1) // WIDTH)
    window = Window(0.0, WINDOW, WINDOW, 1, end, n, end, False, ROUNDINGS)
    kernel_series.expand(1, end, chain, motion)
    kernel_series.powers(WINDOW, motion.weight)
    search.active[0] = 0
    watch.watch(window, chain, motion, search)
    told = np.zeros((search.active[0], LEVELS + ROWS + 1))
    for k in range(search.active[0]):
        slot = search.active[k + 1]
        if search.stage[slot] == ROUGH:
            for j in range(LEVELS):
                told[k, j] = search.level[slot, j]
            watch.build(slot, window, chain, motion, search)
            for j in range(ROWS + 1):
                told[k, LEVELS + j] = search.series[slot, j]
    return told


def test_what_the_search_is_told_of_a_function_holds_for_its_whole_series():
    """Its first four terms, and bounds of the sum and of the curvature of all the others."""
    told = []
    for seed in range(300):
        random = np.random.default_rng(seed)
        n = int(random.choice([2, 5, 12]))
        modes, force = random.choice([-1, 0, 1], n, p=[0.3, 0.4, 0.3]), random.normal(size=n)
        weights = abs(force - np.append(force[1:], 0.0)) * random.uniform(1.0, 1.6, n) / 0.7 + 1e-3
        chain = Chain(weights, 1e-3, 25e6, 25e6 * 10 ** random.uniform(-1, 0.5), 1e-4, 0.7, 0.45)
        # Some have just begun to move: their root at the start is divided out.
        velocity = modes * random.uniform(0.0, 0.5, n) * (random.random(n) < 0.6)
        numbers = np.array(units.parameters(chain))
        told.append(watched_functions(numbers, weights, modes, force, velocity, memory_for(n)))
    known = np.concatenate(told)
    level, series = np.split(known[known.any(axis=1)], [LEVELS], axis=1)
    just_begun = (level[:, POWER] == 1.0).sum()
    assert len(level) - just_begun > 500
    assert just_begun > 20
    orders = np.arange(4, series.shape[1])
    assert series[:, :4] == pytest.approx(level[:, [C0, C1, C2, C3]], rel=1e-13, abs=1e-15)
    rest, c2, c3 = abs(series[:, 4:]), level[:, C2], level[:, C3]
    rests = rest.sum(axis=1) / level[:, REST]
    bend = (orders * (orders - 1) * rest).sum(axis=1)
    downward = 2.0 * np.maximum(-c2, 0.0) + 6.0 * np.maximum(-c3, 0.0)
    bends = bend / (level[:, BEND] - downward), bend / (level[:, TURN] - 2.0 * abs(c2) - 6.0 * abs(c3))
    for share in (rests, *bends):
        assert share.max() <= 1.0 + ROUNDING
        assert np.median(share) > REST_SHARE


@pytest.mark.parametrize("n_blocks", [1, 2, 3, 10, 60])
@pytest.mark.parametrize("ratio", [1e-3, 0.032, 1.0, 1e3])
def test_the_unit_of_time_is_within_the_reach_of_the_series(n_blocks, ratio):
    """omega tau <= 2 for every frequency, from the eigenvalues; else the cut series would lose digits."""
    chain = Chain(np.ones(n_blocks), 2e-3, 1e6, ratio * 1e6, 1e-4, 0.7, 0.45)
    omega = math.sqrt(np.linalg.eigvalsh(stiffness_matrix(chain))[-1] / chain.mass)
    assert omega * scale(chain).tau <= REACH * (1 + 1e-14)
    if n_blocks > 2:
        assert omega * scale(chain).tau > REACH / LOOSEST


@pytest.mark.parametrize("number", range(0, 60, 4))
def test_any_chain_is_within_the_reach_too(number):
    chain = trial(number)[1].chain
    omega = math.sqrt(max(np.linalg.eigvalsh(stiffness_matrix(chain))[-1], 0.0) / chain.mass)
    assert omega * scale(chain).tau <= REACH * (1 + 1e-14)


@pytest.mark.parametrize("span", [0.01, 0.1, 0.3, WINDOW, 1.0])
def test_a_transition_is_felt_at_the_distance_that_is_renewed_and_no_farther(span):
    """It is felt d blocks away in order 2 d + 1 of the time since."""
    felt = [span ** (2 * d + 1) / math.factorial(2 * d + 1) > NEGLIGIBLE for d in range(40)]
    assert kernel_series.distance_reached.py_func(span) == max(felt.index(False), 1)


@pytest.mark.parametrize("length", [0.25, 0.5, WINDOW, 1.0])
def test_the_order_leaves_out_less_than_a_rounding(length):
    n = order_for(length)
    assert (REACH * length) ** (n + 1) / math.factorial(n + 1) <= NEGLIGIBLE
    assert n == 8 or (REACH * length) ** n / math.factorial(n) > NEGLIGIBLE
