"""Methods that locate transitions as events: what they get right, and where and why they fail."""

import math
from functools import partial
from importlib.util import find_spec

import numpy as np
import pytest
from reference.goldens import SCENES, read_golden
from scipy.integrate import DOP853

from precursors import Chain, Run, TransitionLimitError
from precursors.methods import dop853
from precursors.methods.cvode_events import solve_cvode
from precursors.methods.dop853 import solve_dop853
from precursors.methods.events import MAX_AT_ONCE, EventMotion, event_functions
from precursors.methods.heyoka_events import solve_heyoka
from precursors.methods.scipy_events import solve_scipy, watched

FIRST_SLIP = 216  # transitions of theta = 0 to the end of the first global slip
# Errors of a step add up and grow in 2.7 s: measured were 7e-10 (DOP853) to 7e-8 s (Radau).
TIGHT = {"DOP853": 1e-10, "RK45": 1e-10, "LSODA": 1e-10, "Radau": 1e-7}
TIGHT_ERROR = 2e-7  # s, a hundredth of the shortest slip
# heyoka at its default tolerance is right to rounding; 5e-11 s and 1e-8 s were measured at 10 s.
ROUNDING_GROWN = 1e-7  # s
STEP_ROUNDING = 1e-13  # N and N/tau, of numbers of order 1


@pytest.fixture(scope="module")
def uniform() -> Chain:
    return Chain.from_slider()


def right_and_error(run: Run, golden: list) -> tuple[int, float]:
    """Transitions before the first wrong one, and the largest error of their times [s]."""
    right, error = 0, 0.0
    for found, true in zip(run.transitions, golden, strict=False):
        if (found["block"], found["mode"]) != (true.block, true.mode):
            break
        right, error = right + 1, max(error, abs(float(found["time"] - float(true.time))))
    return right, error


def needs(package: str) -> pytest.MarkDecorator:
    return pytest.mark.skipif(find_spec(package) is None, reason=f"{package} is an extra")


@pytest.mark.parametrize(
    ("solve", "tolerance", "allowed"),
    [
        *(pytest.param(partial(solve_scipy, solver=s), x, TIGHT_ERROR, id=s) for s, x in TIGHT.items()),
        *(pytest.param(solve_dop853, x, 100 * x, id=f"compiled {x:g}") for x in (1e-7, 1e-10, 1e-13)),
        *(
            pytest.param(partial(solve_cvode, formula=f), 1e-10, TIGHT_ERROR, id=f, marks=needs("sksundae"))
            for f in ("Adams", "BDF")
        ),
    ],
)
def test_a_method_makes_every_transition_of_the_first_global_slip(uniform, solve, tolerance, allowed):
    """At a tight tolerance; compiled DOP853 also at that where SciPy's misses two roots."""
    result = solve(uniform, 10.0, tolerance, "global slip")
    right, error = right_and_error(result.run, read_golden("fig10"))
    assert right == len(result.run.transitions) == FIRST_SLIP
    assert error < allowed
    assert result.evaluations > 10 * FIRST_SLIP


def test_a_step_of_compiled_dop853_is_scipys_with_its_error_and_its_dense_output(uniform):
    motion = in_motion(uniform, [1, 1, 0, -1, 0] * 2, [5.0, -3.0] * 5, [0.5, 0.2, 0.0, -0.3, 0.0] * 2)
    stepper = DOP853(motion.rates, 0.0, motion.y, 9.0, rtol=1e-7, atol=1e-7, first_step=0.4)
    stepper.step()
    h = stepper.t
    k, f = np.zeros((16, 2, 12)), np.empty((7, 2, 12))
    k[0, :, 1:-1] = motion.rates(0.0, motion.y).reshape(2, 10)
    system, state = motion.system, motion.state.copy()
    end, trial, values = np.zeros((2, 12)), state[:2].copy(), np.empty(12)

    def y(columns: np.ndarray) -> np.ndarray:
        return columns[:2, 1:-1].ravel()

    dop853.stages.py_func(system, state, 10, h, k, end, trial)
    assert y(end) == pytest.approx(stepper.y, abs=STEP_ROUNDING)
    error = dop853.error_of.py_func(state, 10, end, h, k, 1e-7)
    assert error < 1.0
    longer = min(dop853.SAFETY * error**dop853.EXPONENT, dop853.LONGER)
    assert longer == pytest.approx(stepper.h_abs / h, rel=1e-6)
    dop853.polynomial.py_func(state, 10, end, h, k, f)
    for x in (0.2, 0.7):
        least = dop853.functions_at(x, system, state, 10, f, trial, values)
        assert y(trial) == pytest.approx(stepper.dense_output()(x * h), abs=STEP_ROUNDING)
        assert least == pytest.approx(min(event_functions_of(motion, y(trial))))


@needs("heyoka")
@pytest.mark.parametrize("scene", SCENES)
def test_heyoka_makes_every_transition_of_ten_seconds_at_its_default_tolerance(scene):
    golden = read_golden(scene)
    result = solve_heyoka(Chain.from_slider(theta=SCENES[scene]), 10.0, 0.0)
    right, error = right_and_error(result.run, golden)
    assert right == len(result.run.transitions) == len(golden)
    assert error < ROUNDING_GROWN


@needs("heyoka")
def test_heyoka_misses_a_stop_where_a_block_starts_exactly_on_the_root_of_its_velocity():
    golden = read_golden("fig11")
    result = solve_heyoka(Chain.from_slider(theta=SCENES["fig11"]), 5.0, 0.0, nudge=0.0)
    right, _ = right_and_error(result.run, golden)
    # Block 10 slides backward for 2 us, within one step; the stop after it is not seen.
    assert (golden[right - 1].block, golden[right - 1].mode) == (10, -1)
    assert (golden[right].block, golden[right].mode) == (10, 0)


def in_motion(chain: Chain, modes: list[int], forces: list[float], velocities: list[float]) -> EventMotion:
    """A motion at t = 0 in the given state [N, N/tau]."""
    motion = EventMotion(chain, 1.0, None)
    motion.put(modes, forces, velocities)
    return motion


def event_functions_of(motion: EventMotion, y: np.ndarray) -> np.ndarray:
    result = np.empty_like(y)
    event_functions(y, motion.system, motion.state, result)
    return result


def test_scipy_watches_sliding_blocks_and_both_margins_of_stuck_blocks_beside_them():
    chain = Chain.from_slider(n_blocks=5)
    motion = in_motion(chain, [1, -1, 0, 0, 0], [30.0, 20.0, -25.0, 2.0, 1.0], [3.0, -2.0, 0.0, 0.0, 0.0])
    everything = event_functions_of(motion, motion.y)
    found = {number: function(0.0, motion.y) for number, function in watched(motion)}
    assert found == {number: everything[number] for number in (0, 2, 4, 5)}
    # Velocities along the modes, then 80 * 0.7 N -+ the net force on block 3.
    assert found == pytest.approx({0: 3.0, 2: 2.0, 4: 56.0 + 27.0, 5: 56.0 - 27.0})


def test_a_stuck_block_is_released_backward_where_its_force_points_backward():
    motion = in_motion(Chain.from_slider(n_blocks=2), [-1, 0], [0.0, -140.0], [-1.0, 0.0])
    motion.switch(3, 0.0)
    assert motion.run().run.transitions[["block", "mode"]].tolist() == [(2, -1)]


def test_blocks_that_stop_at_the_same_instant_to_rounding_both_stop():
    motion = in_motion(Chain.from_slider(n_blocks=3), [1, 1, 0], [1.0, 0.5, 0.0], [1e-18, -1e-18, 0.0])
    assert not motion.switch(0, 2.0)
    transitions = motion.run().run.transitions
    assert transitions[["block", "mode"]].tolist() == [(1, 0), (2, 0)]
    assert len(set(transitions["time"])) == 1


def test_a_block_that_stops_under_too_large_a_force_turns_round():
    motion = in_motion(Chain.from_slider(n_blocks=1), [1], [-300.0], [0.0])
    assert motion.switch(0, 0.0)
    assert motion.run().run.transitions["mode"].tolist() == [-1]
    assert motion.y[1] == -motion.nudge


def test_a_run_that_ends_within_a_slip_ends_at_its_duration(uniform):
    golden = read_golden("fig10")
    end = float(golden[0].time + golden[1].time) / 2
    run = solve_scipy(uniform, end, 1e-9).run
    assert len(run.transitions) == 1
    assert run.duration == end
    assert math.fsum(run.intervals) == pytest.approx(end, abs=1e-15)


def test_a_restart_exactly_on_a_root_never_gets_away_from_it(uniform):
    with pytest.raises(TransitionLimitError, match=r"transition after transition at t = 0\.35 s") as stuck:
        solve_scipy(uniform, 10.0, 1e-9, nudge=0.0, direction=0.0)
    assert set(stuck.value.run.transitions["time"]) == {0.35}
    # It is given up soon, and not when its record is full.
    assert len(stuck.value.run.transitions) <= MAX_AT_ONCE * uniform.n_blocks + 3
