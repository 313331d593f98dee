"""Event functions enclose the exact ones, and their first root is enclosed.

Roots are also checked on polynomials whose roots are known.
"""

import re
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from benchmark.made_up import go_on, proof_of
from chains import matrix_of_motion
from flint import arb, arb_poly, ctx
from scipy.linalg import expm

from precursors.proof.event_roots import (
    VALID,
    WINDOW,
    EventFunction,
    Undecided,
    event_functions,
    first_crossing,
)
from precursors.proof.exact_chain import ExactChain
from precursors.proof.motion import (
    Constants,
    EnclosedState,
    advance,
    expand,
    time_unit,
)
from precursors.proof.tube import Proof

BITS = 64
# Width of an enclosure at which Newton's method stops.
ISOLATED = 1e-15
# Error of the roots by NumPy of random polynomials of degree 5.
NUMPY = 1e-12


def function(
    value: list[float],
    block: int = 1,
    way: int = 0,
    width: float = 0.0,
    fresh: bool = False,
):
    """Make an event function from its coefficients, known to within `width`."""
    u = arb_poly(value)
    slope = u.derivative()
    around = arb(0, width)
    return EventFunction(
        block, way, fresh, u + around, slope + around, slope.derivative() + around
    )


def through(*roots: float, **how):
    """Make the polynomial with these roots, positive before the first."""
    coefficients = np.polynomial.polynomial.polyfromroots(roots)
    return function(((-1.0) ** len(roots) * coefficients).tolist(), **how)


def find(*functions: EventFunction, back: float = 0.0):
    with ctx.workprec(BITS):
        crossing = first_crossing(list(functions), arb(back))
        return crossing and (crossing[0].block, crossing[1])


ROOTS = {
    "two close together": (through(0.375, 0.375 + 2.0**-20), 0, 0.375),
    "at the end": (through(1.0), 0, 1.0),
    "a little beyond the end": (through(1.0 + 2.0**-50), 0, None),
    "on a quarter of a half": (through(0.125, 0.625), 0, 0.125),
    "none, but a low dip": (function([0.25 + 1e-6, -1.0, 1.0]), 0, None),
    # A block that has just begun to slide does not stop at once.
    "fresh and rising": (function([0.0, 1.0, 1.0], fresh=True), 0, None),
    "fresh and bending": (function([0.0, 0.0, 1.0], fresh=True), 1e-3, None),
    "fresh with a later root": (function([0.0, 0.5, -1.0], fresh=True), 0, 0.5),
    # A run may have its root before the start.
    "a root before all runs start": (function([1e-3, 1.0]), 0.5e-3, None),
    "a root after all runs have started": (through(0.01), 5e-3, 0.01),
}


@pytest.mark.parametrize(("of", "back", "root"), ROOTS.values(), ids=ROOTS)
def test_first_crossing_encloses_the_first_root(of, back, root):
    crossing = find(of, back=back)
    assert (crossing is None) == (root is None)
    if crossing:
        assert (
            abs(float(crossing[1].mid()) - root) + float(crossing[1].rad()) <= ISOLATED
        )


def test_first_root_of_random_polynomials_agrees_with_numpy():
    generator = np.random.default_rng(7)
    n_roots = 0
    for _ in range(200):
        coefficients = generator.normal(size=6)
        coefficients[0] = abs(coefficients[0])
        roots = np.polynomial.polynomial.polyroots(coefficients)
        real = roots.real[
            (abs(roots.imag) < 1e-12) & (roots.real > 0) & (roots.real < WINDOW)
        ]
        crossing = find(function(coefficients.tolist()))
        assert (crossing is None) == (not real.size)
        if crossing:
            n_roots += 1
            assert abs(float(crossing[1].mid()) - real.min()) < NUMPY
    assert 50 < n_roots < 150


def test_first_of_several_functions_wins_in_any_order():
    three = [through(0.7, block=1), through(0.3, 0.5, block=2), through(0.9, block=3)]
    for functions in (three, three[::-1], three[1:] + three[:1]):
        block, root = find(*functions)
        assert block == 2
        assert abs(float(root.mid()) - 0.3) <= ISOLATED


def test_enclosure_is_about_as_wide_as_the_uncertain_root():
    _, root = find(through(0.3, width=1e-6))
    assert 0.9e-6 < float(root.rad()) < 1.1e-6
    assert root.contains(0.3)


DIP = [0.26, -1.0, 1.0]
UNDECIDED = {
    "a double root": ([through(0.375, 0.375, block=4)], 0, "block 4 stops", 0.375),
    "no root, but wide": (
        [function(DIP, 5, -1, 0.02)],
        *(0, "block 5 is released backward", 0.4),
    ),
    "two at once": (
        [
            through(0.875, block=7),
            through(0.375, block=2),
            through(0.375, 0.75, block=6, way=1),
        ],
        *(0, "first block 2 stops or block 6 is released forward", 0.375),
    ),
    "at the start": ([function([0.0, 0.0, 1.0])], 0, "block 1 stops", 0.0),
    "at the start of some runs": ([function([1e-3, 1.0])], 2e-3, "block 1 stops", 0.0),
    "before the start of some runs": ([through(0.01)], 2e-2, "block 1 stops", 0.0),
}


@pytest.mark.parametrize(
    ("functions", "back", "question", "time"), UNDECIDED.values(), ids=UNDECIDED
)
def test_undecidable_crossing_raises_a_question(functions, back, question, time):
    with pytest.raises(Undecided, match=f"^whether {question}$") as asked:
        find(*functions, back=back)
    assert [str(i) for i in asked.value.blocks] == re.findall(r"\d", question)
    assert float(asked.value.time.mid()) == pytest.approx(time, abs=0.1)


def equations(of: Constants, mode: list[int]) -> np.ndarray:
    """Return the matrix M of Eqs. 2-4, y' = M y with y = (T_1..T_N, u_1..u_N, 1)."""
    springs = np.array([float(c) for c in of.coupling[1:-1]])
    friction = np.array([float(x) for x in of.friction[1:-1]])
    modes = np.array(mode[1:-1])
    return matrix_of_motion(springs, 1.0, friction, springs[0] * float(of.drive), modes)


def vector(state: EnclosedState) -> np.ndarray:
    return np.array([float(x) for x in (*state.force[1:-1], *state.rate[1:-1], 1.0)])


def scale(of: Constants) -> np.ndarray:
    """Return the divisors of y in the energy norm."""
    springs = [float(c) for c in of.coupling[1:-1]]
    return np.append(np.sqrt(springs), np.ones(len(springs)))


def exact_rows(
    proof: Proof, function: EventFunction, matrix: np.ndarray
) -> list[np.ndarray]:
    """Return the event function and its derivatives as rows that multiply y."""
    n = proof.chain.n_blocks
    i = function.block
    way = function.direction
    row = np.zeros(2 * n + 1)
    if way == 0:
        row[n + i - 1] = proof.state.mode[i]
        return [row, row @ matrix, row @ matrix @ matrix]
    row[i - 1] = -way
    row[-1] = float(proof.bounds.strength[i])
    row[i : min(i + 1, n)] = way
    return [row, (row - row[-1] * np.eye(2 * n + 1)[-1]) @ matrix]


def functions_of(proof: Proof, distance: float, bits: int) -> list[EventFunction]:
    with ctx.workprec(BITS):
        state = replace(proof.state, distance=arb(distance))
        return event_functions(proof.bounds, state, proof.fresh, bits)


@pytest.fixture(scope="module")
def sliding() -> Proof:
    """Return a proof for theta = -5/6 in the event in which block 10 first turns round:
    some blocks slide, some are stuck."""
    proof = proof_of(ExactChain.from_slider(theta="-5/6"), 256)
    while len(proof.transitions) < 53:
        go_on(proof)
    return proof


# Smallest share of the bound that the error with 12 bits reaches: value, slope and bend
# of a speed, then value and slope of a margin. The value of a margin is the integral of
# a rate, and so is its bound.
CLOSEST = {(0, 0): 0.7, (1, 0): 0.7, (2, 0): 0.7, (0, 1): 0.01, (1, 1): 0.15}


def test_event_functions_enclose_the_exact_ones_closely(sliding):
    """The reference is the matrix exponential. With 12 bits, the remainder of the
    series is visible."""
    functions = functions_of(sliding, 0.0, 12)
    matrix = equations(sliding.bounds, sliding.state.mode)
    closest = dict.fromkeys(CLOSEST, 0.0)
    for t in VALID * np.array([-1.0, -0.5, 0.5, 1.0]):
        flow = expm(matrix * t) @ vector(sliding.state)
        for of in functions:
            for k, row in enumerate(exact_rows(sliding, of, matrix)):
                ball = (of.value, of.slope, of.bend)[k](arb(t))
                wrong = abs(float(ball.mid()) - row @ flow)
                radius = float(ball.rad())
                assert wrong <= radius
                key = k, abs(of.direction)
                closest[key] = max(closest[key], wrong / radius)
    assert all(closest[key] > least for key, least in CLOSEST.items()), closest


def test_event_functions_cover_runs_within_twice_the_distance(sliding):
    """At the start, functions and derivatives are linear in T_i / sqrt c_i and u_i."""
    n = sliding.chain.n_blocks
    distance = 1e-6
    mode = sliding.state.mode
    matrix = equations(sliding.bounds, [0, *[1] * n, 0])
    functions = functions_of(sliding, distance, BITS)
    for of in functions:
        for k, row in enumerate(exact_rows(sliding, of, matrix)):
            ball = (of.value, of.slope, of.bend)[k](arb(0))
            reach = 2 * distance * np.linalg.norm(row[:-1] * scale(sliding.bounds))
            assert reach * (1 - 1e-9) <= float(ball.rad()) <= 1.001 * reach
    slides = {i for i in range(1, n + 1) if mode[i]}
    near = {1} | {i + way for i in slides for way in (1, -1)} & set(range(1, n + 1))
    expected = {(i, 0) for i in slides} | {
        (i, way) for i in near - slides for way in (1, -1)
    }
    assert {(of.block, of.direction) for of in functions} == expected
    assert len(slides) > 3
    assert len(near - slides) > 1
    assert {of.block for of in functions if of.fresh} == sliding.fresh == {10}


def test_advanced_state_is_within_its_distance_of_the_exact_one(sliding):
    """The reference is the matrix exponential. With 12 bits, the remainder of the
    series is visible."""
    bounds = sliding.bounds
    step = 0.25
    with ctx.workprec(BITS):
        state = replace(sliding.state, distance=arb(0))
        polynomials, rests = expand(bounds, state, step, 12)
        advance(bounds, state, polynomials, rests[0], arb(step))
    flow = expm(equations(bounds, state.mode) * step) @ vector(sliding.state)
    wrong = np.linalg.norm((vector(state) - flow)[:-1] / scale(bounds))
    assert 0.3 * float(state.distance) < wrong <= float(state.distance)


SLOW: dict[str, Any] = {
    "n_blocks": 2,
    "drive_stiffness": "1e3",
    "drive_velocity": "1e-20",
}
# Slider; modes, forces and rates of the state; distance [N]; largest ratio of the bound
# to the change.
CHANGES = {
    "the drive": ({"n_blocks": 1, "mu_k": 0}, [1], [0], [0], 0, 4.8),
    "friction": (SLOW, [1, -1], [0, 0], [0, 0], 0, 3.3),
    "a velocity": (SLOW | {"mu_k": 0}, [1, 1], [0, 0], [3, -3], 0, 1.9),
    "another velocity": (SLOW | {"mu_k": 0}, [1, 1], [0, 0], [3, -3], 18**0.5, 1.9),
    "a force": (SLOW | {"mu_k": 0}, [1, 1], [0, 3], [0, 0], 0, 2.6),
}


@pytest.mark.parametrize(
    ("slider", "mode", "force", "rate", "distance", "slack"),
    CHANGES.values(),
    ids=CHANGES,
)
def test_change_of_net_force_stays_within_its_bound(
    slider, mode, force, rate, distance, slack
):
    """The reference is the matrix exponential. A velocity may be in the state or within
    its distance."""
    chain = ExactChain.from_slider(**slider)
    gap = 0.5
    state = EnclosedState(
        [*map(arb, (0, *force, 0))],
        [*map(arb, (0, *rate, 0))],
        [0, *mode, 0],
        arb(distance),
    )
    constants = Constants.of(chain, time_unit(chain))
    matrix = equations(constants, state.mode)
    y = vector(state)
    changes = [
        (expm(matrix * t) @ y - y)[: len(mode)]
        for t in np.linspace(-2 * gap, 2 * gap, 41)
    ]
    largest = abs(np.diff(changes, append=0.0)).max()
    if distance:
        state.rate = [arb(0)] * len(state.rate)
    assert (
        largest
        <= float(state.largest_force_change(constants, arb(gap)))
        <= slack * largest
    )
