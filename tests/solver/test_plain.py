"""The method in plain Python finds the transitions that the compiled kernel finds."""

import json
import os
import subprocess
import sys

import numpy as np
import pytest
from chains import SLIDER, first_transitions, positions_under

from precursors import Chain, Run, simulate
from precursors.solver import fallback

THETAS = ["-5/6", "0", "5/6"]
# Both are right to about so much up to the first global slip [s]. After it, roundings grow: what changing the
# weights by a rounding does to the exact times is 3e-8 s at 10 s.
TO_GLOBAL_SLIP, TO_THE_END = 1e-12, 3e-8
# Of the run's duration: roundings of some tens of transitions in chains drawn at random.
RANDOM = 1e-9
N_RANDOM = 200
LOAD = 1e-12  # of the total strength, for states in plain Python and compiled


def plain_and_compiled(chain, duration, most, **start):
    """(block, mode) and times of the transitions in plain Python and compiled."""
    at = [start.get(name, np.zeros(chain.n_blocks)) for name in ("start_positions", "start_velocities")]
    plain, _, _ = fallback.find(chain, (at[0], at[1]), duration, False, np.inf, most)
    compiled = first_transitions(chain, most, duration=duration, **start).transitions
    order = [run[["block", "mode"]].tolist() for run in (plain, compiled)]
    return *order, plain["time"], compiled["time"]


@pytest.mark.parametrize("theta", THETAS)
def test_every_transition_of_a_scene_is_the_same_for_ten_seconds(theta):
    chain = SLIDER(theta=theta)
    plain, compiled, times, compiled_times = plain_and_compiled(chain, 10.0, 10_000)
    assert plain == compiled
    difference = abs(times - compiled_times)
    n_global = len(simulate(chain, until="global slip").transitions)
    assert difference[:n_global].max() < TO_GLOBAL_SLIP
    assert difference.max() < TO_THE_END


def random_case(number):
    """A chain of 1..12 blocks under random loads, a duration, and a start for every other one."""
    rng = np.random.default_rng(number)
    n = int(rng.integers(1, 13))
    mu_s = rng.uniform(0.3, 1.0)
    weights, drive_stiffness = rng.uniform(1.0, 100.0, n), 25e6 * 10 ** rng.uniform(-3.0, 1.0)
    mass = 1e-3
    duration = 10 ** rng.uniform(2.0, 3.5) * np.sqrt(mass / max(25e6, drive_stiffness))
    velocity = rng.uniform(0.1, 3.0) * weights.sum() / (duration * drive_stiffness)
    chain = Chain(weights, mass, 25e6, drive_stiffness, velocity, mu_s, mu_s * rng.uniform(0.1, 0.9))
    start = {}
    if number % 2:
        start["start_positions"] = positions_under(chain, rng.uniform(-1.0, 1.0, n) * chain.strength)
        start["start_velocities"] = rng.normal(size=n) * 0.01
    return chain, duration, start


def test_random_chains_have_the_same_transitions():
    compared = 0
    for number in range(N_RANDOM):
        chain, duration, start = random_case(number)
        plain, compiled, times, compiled_times = plain_and_compiled(chain, duration, 40, **start)
        assert plain == compiled, number
        assert abs(times - compiled_times).max(initial=0.0) < RANDOM * duration, number
        compared += len(plain)
    assert compared > 20 * N_RANDOM


SCRIPT = """
import json
from precursors import Chain, find_slips, simulate
run = simulate(Chain.from_slider(), until="global slip")
print(json.dumps([run.transitions["time"].tolist(), run.tangential_load([0.1, 0.4, run.duration]).tolist()]))
"""


def test_without_the_compiler_a_chain_is_run_in_plain_python_with_one_warning():
    run = simulate(SLIDER(), until="global slip")
    environment = os.environ | {"NUMBA_DISABLE_JIT": "1"}
    process = subprocess.run(
        [sys.executable, "-c", SCRIPT], env=environment, capture_output=True, text=True, check=True
    )
    times, loads = json.loads(process.stdout)
    assert process.stderr.count("UserWarning: Numba is switched off") == 1
    np.testing.assert_allclose(times, run.transitions["time"], rtol=0, atol=TO_GLOBAL_SLIP)
    strength = run.chain.mu_s * run.chain.normal_load
    np.testing.assert_allclose(
        loads, run.tangential_load([0.1, 0.4, run.duration]), rtol=0, atol=LOAD * strength
    )


def test_a_run_in_plain_python_is_a_run_like_any_other():
    chain, at_rest = SLIDER(3), np.zeros(3)
    transitions, intervals, end = fallback.find(chain, (at_rest, at_rest), 1.0, False, np.inf, 10)
    states = fallback.first_state(chain, at_rest, at_rest)
    assert intervals.dtype == states.force.dtype == states.velocity.dtype == np.float64
    # From the start through all its transitions: compiled code takes what plain Python found.
    run = Run(chain, end, transitions, intervals, at_rest, at_rest, states)
    times = np.linspace(0.0, end, 20)
    force, velocity = fallback.evaluate(chain, times, transitions, intervals, states)
    np.testing.assert_allclose(force, run.spring_forces(times), rtol=0, atol=LOAD * chain.strength.sum())
    np.testing.assert_allclose(velocity, run.at(times)[1], rtol=0, atol=1e-12)
