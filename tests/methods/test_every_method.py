"""What every method must do: slide backward as the exact solver, keep its clock, know its own Jacobian."""

from __future__ import annotations

import re
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from precursors import Chain, simulate
from precursors.methods import METHODS, columns
from precursors.methods.columns import MOBILITY, time_unit
from precursors.methods.events import EventMotion, jacobian
from precursors.methods.regularised import equations

# theta, mu_k, and a time [s] after a block has slid backward: block 3 of 3 and block 1, which turn round, and
# block 2, which is released backward from rest.
BACKWARD = [("-5/6", 0.45, 2.2), ("5/6", 0.45, 1.5), ("-5/6", 0.1, 2.13945)]
# Settings at which a method makes the transitions of a short chain: by its name, or by what the setting is.
FINE = {
    "exact": 0.0,
    "heyoka": 0.0,
    "rk4": 3e-7,
    "relative tolerance": 1e-6,
    "step [s]": 1e-8,
    "width [m/s]": 1e-7,
}
# Error of F_X at a transition [N]: steps are worth 0.02 N, a dead zone 0.14 N, a width of friction 0.7 N.
LOAD_ERROR = {"karnopp": 0.3, "regularised_radau": 2.0, "regularised_bdf": 2.0}
STEPS_ERROR = 0.05
# Methods that stop a block before it turns do so for less than this [s].
TURN = 1e-7
CLOCK = 1e-13  # s; roundings of a sum of some ten intervals
# Eq. 4 taken literally never sticks, so that it makes other transitions.
NAMES = [name for name in METHODS if name != "literal"]
# In methods with a larger error blocks creep at rest, and slide only after the last of these ends.
CASES = [(name, *case) for name in NAMES for case in BACKWARD[: 2 if name in LOAD_ERROR else 3]]


def without_short_stops(transitions) -> list[tuple[int, int, float]]:
    """(block, mode, load) without stops of blocks that turn at once."""
    rows = transitions.tolist()
    turns = {
        k
        for k, (row, following) in enumerate(pairwise(rows))
        if row[2] == 0 and following[1] == row[1] and following[0] - row[0] < TURN
    }
    return [(block, mode, load) for k, (_, block, mode, load) in enumerate(rows) if k not in turns]


@pytest.mark.parametrize(("name", "theta", "mu_k", "end"), CASES)
def test_a_method_slides_backward_where_the_exact_solver_does_and_its_intervals_are_its_times(
    name, theta, mu_k, end
):
    chain = Chain.from_slider(n_blocks=3, theta=theta, mu_k=mu_k)
    method = METHODS[name]
    run = method.solve(chain, end, FINE.get(name, FINE.get(method.setting)), None).run
    exact = without_short_stops(simulate(chain, end).transitions)
    found = without_short_stops(run.transitions)
    assert [row[:2] for row in found] == [row[:2] for row in exact]
    assert exact[-2][1] == -1
    errors = [abs(a[2] - b[2]) for a, b in zip(found, exact, strict=True)]
    assert max(errors) < LOAD_ERROR.get(name, STEPS_ERROR)
    assert len(run.intervals) == len(run.transitions) + 1
    ends = np.append(run.transitions["time"], run.duration)
    np.testing.assert_allclose(np.cumsum(run.intervals), ends, rtol=0, atol=CLOCK)


def differences(function, state: np.ndarray, step: float) -> np.ndarray:
    """Matrix of central differences of a vector function."""
    changes = step * np.eye(len(state))
    return np.column_stack([(function(state + h) - function(state - h)) / (2 * step) for h in changes])


@pytest.mark.parametrize("modes", [[1, 1, 1, 1], [-1, 0, 1, 0], [0, 0, 0, 1], [1, -1, 0, 0]])
def test_the_jacobian_of_located_events_is_that_of_differences(modes):
    chain = Chain.from_slider(n_blocks=4, theta="5/6", drive_stiffness=3e6)
    motion = EventMotion(chain, 1.0, None)
    state = np.random.default_rng(5).standard_normal(8)
    state[4:] *= np.array(modes) != 0
    motion.put(modes, state[:4], state[4:])
    found = jacobian(motion.system, motion.state, np.zeros((8, 8)))
    of_differences = differences(lambda y: motion.rates(0.0, y), state, 1e-3)
    # Velocities of blocks that stick are 0, so that a change of them is nothing that happens.
    slides = np.append(np.ones(4, bool), motion.state[MOBILITY, 1:-1] != 0)
    np.testing.assert_allclose(found[:, slides], of_differences[:, slides], rtol=0, atol=1e-10)


def test_the_jacobian_of_regularised_friction_is_that_of_differences():
    chain = Chain.from_slider(n_blocks=4, theta="-5/6")
    width = 1e-2
    rates, matrix = equations(chain, width)
    unit = width * chain.mass / time_unit(chain)  # of velocities, in which friction turns over
    state = unit * np.random.default_rng(6).uniform(-3, 3, 8)
    of_differences = differences(lambda y: rates(0.0, y), state, 1e-5 * unit)
    np.testing.assert_allclose(matrix(0.0, state), of_differences, rtol=1e-6, atol=1e-6)


def test_code_is_compiled_again_after_an_edit_of_any_module_that_has_some():
    modules = Path(columns.__file__).parent.glob("*.py")
    compiled = re.compile(r"^@(inner|apart|outer|template)\b", re.MULTILINE)
    assert {file.name for file in modules if compiled.search(file.read_text())} == set(columns.COMPILED)
