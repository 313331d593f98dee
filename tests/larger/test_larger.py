"""The larger chain against solvers and closed forms that share no code with it."""

from pathlib import Path
from typing import NamedTuple

import numpy as np
import pandas as pd
import pytest
from chains import SLIDER
from places import GOLDEN
from scipy.integrate import solve_ivp

from precursors import (
    Record,
    Run,
    RunFileError,
    TransitionLimitError,
    audit,
    find_slips,
    simulate,
)
from precursors.analysis.load_curve import load_curve
from precursors.larger.chain import (
    LargerChain,
    critical_length,
    tilt,
    weakening_velocity,
)
from precursors.larger.settled import beside_law
from precursors.larger.simulate import model_of, simulate_larger
from precursors.larger.steps import Motion, try_step

# Tolerances beside the cases are two to three times what is measured at the default
# step.
ENERGY = 1e-6  # of the work of the drive; 3.6e-7 is measured
PAIR = {"weakening_velocity": 0.01, "relaxation_time": 5e-6}  # l_c = 0.089 L
DRAWN = 0.1  # N, of F_X at a transition; 0.04 N from one point to the next
SLIP = "global slip"


def order(run: Record) -> list[tuple[int, int]]:
    return list(
        zip(
            run.transitions["block"].tolist(),
            run.transitions["mode"].tolist(),
            strict=True,
        )
    )


@pytest.mark.parametrize(
    ("theta", "seconds", "newtons"),
    [("-5/6", 1e-7, 1e-5), (0, 4e-7, 4e-5), ("5/6", 2e-4, 2e-2)],
)
def test_with_nothing_added_it_has_the_transitions_of_the_exact_chain_in_order(
    theta, seconds, newtons
):
    exact = simulate(SLIDER(theta=theta), until=SLIP)
    run = simulate_larger(LargerChain(exact.chain), 10.0, SLIP)
    assert order(run) == order(exact)
    np.testing.assert_allclose(
        run.transitions["time"], exact.transitions["time"], rtol=0, atol=seconds
    )
    loads = exact.transitions["tangential_load"]
    np.testing.assert_allclose(
        run.transitions["tangential_load"], loads, rtol=0, atol=newtons
    )


def fast(n: int, **added: float) -> LargerChain:
    return LargerChain(SLIDER(n, theta="1/4", drive_velocity=1e-3), **added)


# Until when they run, and how closely loads agree with those of methods that shared no
# code: in 70 digits with viscosity, which no certificate covers, and SciPy's DOP853 with
# located transitions and a relative tolerance of 1e-10.
REFERENCES = {
    "papers_chain": (LargerChain(SLIDER(), viscosity=54.77), 5.0, SLIP, 6e-8),
    "backward": (
        LargerChain(SLIDER(3, theta="1/2", mu_k=0.05), viscosity=3.0),
        3.0,
        None,
        2e-4,
    ),
    "stiff_viscosity": (
        LargerChain(SLIDER(3, theta="1/3"), viscosity=300.0),
        8.0,
        None,
        1e-8,
    ),
    "weakening": (fast(1, weakening_velocity=0.05), 0.6, None, 5e-6),
    "relaxation": (
        fast(2, weakening_velocity=0.02, relaxation_time=1e-5),
        0.25,
        None,
        2e-5,
    ),
    "all_three": (
        fast(3, weakening_velocity=0.05, relaxation_time=2e-6, push_height=0.002),
        0.2,
        None,
        2e-4,
    ),
    "height": (fast(4, weakening_velocity=0.02, push_height=0.003), 0.2, None, 1e-4),
}
GOLDEN_LARGER = pd.read_csv(GOLDEN / "reference_larger.csv").groupby("chain")


@pytest.mark.parametrize("name", REFERENCES)
def test_transitions_are_those_of_methods_that_share_no_code(name):
    larger, duration, until, tolerance = REFERENCES[name]
    run = simulate_larger(larger, duration, until)
    golden = GOLDEN_LARGER.get_group(name)
    assert order(run) == list(zip(golden["block"], golden["mode"], strict=True))
    np.testing.assert_allclose(
        run.transitions["tangential_load"], golden["tangential_load_N"], rtol=tolerance
    )
    assert abs(run.numbers["energy_error"]) < ENERGY


OF_LOADS = 0.5  # N
# Until the first global slip, or 0.95 s. By RK4 with located transitions and steps of
# 2e-8 s, and where creep hardly trembles, by a staggered scheme of the first order.
SMALL_STEPS = pd.read_csv(Path(__file__).with_name("small_steps.csv"))


def pair(part, t_v, theta):
    slider = SLIDER(25, theta=theta, drive_velocity=3e-4)
    return LargerChain(slider, weakening_velocity(SLIDER(), part, t_v), t_v)


CHAINS = {
    "told": LargerChain(SLIDER(20, theta="-5/6", drive_velocity=3e-4), 0.037, 9.5e-5),
    "200us -5/6": pair(0.2, 2e-4, "-5/6"),
    "100us 0": pair(0.3, 1e-4, 0),
    "short -5/6": pair(0.1, 1e-4, "-5/6"),
}


@pytest.mark.parametrize("case", CHAINS)
def test_events_are_those_of_small_steps(case):
    expected = SMALL_STEPS[SMALL_STEPS["case"] == case]
    slips = find_slips(simulate_larger(CHAINS[case], 0.95))[: len(expected)]
    assert slips["front"].tolist() == expected["front"].tolist()
    loads = expected["load_before"].to_numpy()
    assert slips["load_before"].to_numpy() == pytest.approx(loads, abs=OF_LOADS)


@pytest.mark.parametrize("n", [2, 7, 50])
def test_a_tilt_keeps_the_sum_of_loads_and_balances_the_torque(n):
    chain = SLIDER(n)
    height = 3e-3
    change = tilt(chain, height)
    arms = chain.length * ((np.arange(n) + 0.5) / n - 0.5)
    assert change.sum() == pytest.approx(0.0, abs=1e-15)
    assert change @ arms == pytest.approx(height, rel=1e-13)


@pytest.mark.parametrize(
    ("v_c", "t_v", "theta"),
    [(0.02, 0.0, "-5/6"), (0.01, 5e-6, 0), (0.02, 2e-5, "5/6")],
)
def test_creep_longer_than_l_c_has_a_real_growing_mode(v_c, t_v, theta):
    n = 200
    # A soft drive is the free end of the theory.
    chain = SLIDER(n, theta=theta, drive_stiffness=1.0)
    blocks = n * critical_length(LargerChain(chain, v_c, t_v)) / chain.length

    def fastest_is_real(p):
        links = 2.0 * np.eye(p) - np.eye(p, k=1) - np.eye(p, k=-1)
        links[0, 0] = 1.0
        fall = (chain.mu_s - chain.mu_k) * chain.weights[:p] / v_c
        damping = (np.diag(fall) - t_v * chain.stiffness * links) / chain.mass
        springs = -chain.stiffness / chain.mass * links
        motion = np.block([[np.zeros((p, p)), np.eye(p)], [springs, damping]])
        rates = np.linalg.eigvals(motion)
        small = 1e-6 * abs(rates).max()
        return (abs(rates[rates.real > small].imag) < small).any()

    assert not fastest_is_real(int(0.95 * blocks))
    assert fastest_is_real(int(1.05 * blocks) + 1)


@pytest.mark.parametrize(("part", "t_v"), [(0.05, 1e-5), (0.1, 0.0), (0.3, 2e-4)])
def test_an_even_load_has_the_closed_form_of_l_c(part, t_v):
    chain = SLIDER(100)
    v_c = weakening_velocity(chain, part, t_v)
    length = critical_length(LargerChain(chain, v_c, t_v))
    # A step along the chain is 5e-4 L; growth rates are tried at steps of 4 %.
    assert length / chain.length == pytest.approx(part, abs=6e-4)


def test_creep_of_a_chain_that_hardly_weakens_does_not_run_away():
    assert critical_length(LargerChain(SLIDER(), 10.0, 1e-4)) == np.inf
    assert critical_length(LargerChain(SLIDER())) == 0.0


def test_a_run_survives_its_file_and_knows_its_transitions_only(tmp_path):
    run = simulate_larger(LargerChain(SLIDER(3), **PAIR), 1.5)
    run.save(tmp_path / "run.h5")
    again = Record.load(tmp_path / "run.h5")
    assert again.numbers == run.numbers
    times, loads = load_curve(again)
    drawn = np.interp(run.transitions["time"], times, loads)
    np.testing.assert_allclose(
        drawn, run.transitions["tangential_load"], rtol=0, atol=DRAWN
    )
    with pytest.raises(RunFileError, match="holds a LargerRun and not a Run: Record"):
        Run.load(tmp_path / "run.h5")
    with pytest.raises(TypeError, match="must be a Run, but is LargerRun"):
        audit(run)


@pytest.mark.parametrize(
    ("added", "message"),
    [
        ({"weakening_velocity": -1.0}, "^weakening_velocity must be between 0 and"),
        ({"push_height": "much"}, "^push_height must be a finite number"),
        (
            {"relaxation_time": 1e-6, "viscosity": 1.0},
            "viscosity must not be given beside relaxation_time",
        ),
        (
            {"push_height": 0.02},
            r"push_height = 0.02 m lifts block 1 at F_X = 61\.1\d N",
        ),
    ],
)
def test_bad_input_gets_one_line(added, message):
    with pytest.raises(ValueError, match=message):
        simulate_larger(LargerChain(SLIDER(theta="5/6"), **added), 10.0)


@pytest.mark.parametrize(
    "argument",
    [
        {"duration": 0.0},
        {"until": "stop"},
        {"step": -1.0},
        {"step": 0},
        {"step": np.nan},
        {"max_transitions": "a"},
        {"max_steps": 0.5},
        {"start_forces": [np.nan, 0.0, 0.0]},
        {"start_forces": [0.0, 0.0]},
        {"start_forces": "none"},
    ],
)
def test_a_bad_argument_is_named_in_one_line(argument):
    [name] = argument
    with pytest.raises(ValueError, match=rf"^{name} must [^\n]+$"):
        LargerChain(SLIDER(3)).simulate(**argument)


def test_a_block_that_moves_against_its_mode_stops_at_once():
    """Its velocity is of the size of an error; the clock must not run backwards."""
    larger = LargerChain(SLIDER(), **PAIR)
    state = Motion(*np.zeros((7, 11)), *np.zeros((2, 11), np.int64), np.zeros(2))
    state.mode[0] = 1
    state.velocity[0] = -1e-9
    assert try_step(model_of(larger), state, 0, 2, 1e-7, False) == (0.0, 0)


def test_a_limit_that_is_met_keeps_the_run_so_far():
    with pytest.raises(TransitionLimitError, match="met its limit of work") as met:
        simulate_larger(LargerChain(SLIDER(), **PAIR), 10.0, max_transitions=50)
    assert len(met.value.run.transitions) > 50


class ExponentialWeakening(NamedTuple):
    """mu = mu_k + (mu_s - mu_k) exp(-v/v_c)."""

    weakening_velocity: float

    def speeds(self):
        return self.weakening_velocity * np.linspace(0.0, 20.0, 401)

    def fallen(self, speeds):
        return -np.expm1(-speeds / self.weakening_velocity)


LAW = ExponentialWeakening(0.05)
CHORDS = 1e-3  # of the fall of F_X in a slip; 1.7e-4 is measured


def test_a_block_slides_by_any_law_of_friction_and_the_file_names_it(tmp_path):
    block = SLIDER(1, drive_velocity=1e-3)
    run = simulate_larger(LargerChain(block, friction=LAW), 0.4)
    mu_s = block.mu_s
    mu_k = block.mu_k
    f_z = block.normal_load

    def motion(_, state):
        load, v = state
        mu = mu_k + (mu_s - mu_k) * np.exp(-max(v, 0.0) / 0.05)
        pull = block.drive_stiffness * (block.drive_velocity - v)
        return [pull, (load - mu * f_z) / block.mass]

    def stops(_, state):
        return state[1] + 1e-12

    stops.terminal = True
    start = [mu_s * f_z, 0.0]
    slip = solve_ivp(motion, (0.0, 1.0), start, events=stops, rtol=1e-9, max_step=1e-6)
    _, loads = load_curve(run)
    slid = loads.max() - loads[loads.argmax() :].min()
    assert slid == pytest.approx(np.ptp(slip.y[0]), rel=CHORDS)

    run.save(tmp_path / "run.h5")
    again = Record.load(tmp_path / "run.h5")
    assert again.numbers["friction"] == "ExponentialWeakening"
    with pytest.raises(ValueError, match="not known here: ExponentialWeakening"):
        beside_law(again)


@pytest.mark.parametrize(
    ("slider", "added"),
    [
        ({"theta": 1}, {"relaxation_time": 1e-5}),
        ({"theta": 1 - 1e-6}, {"relaxation_time": 1e-5}),
        ({"mu_s": 0.0, "mu_k": 0.0}, {"relaxation_time": 1e-5}),
        ({"mu_s": 0.0, "mu_k": 0.0}, {"push_height": 1e-3}),
        ({"mu_s": 0.0, "mu_k": 0.0}, {"weakening_velocity": 0.02}),
    ],
)
def test_blocks_without_friction_move_with_the_drive(slider, added):
    run = simulate_larger(LargerChain(SLIDER(**slider), **added), 1e-3)
    # A block with no load, or next to none, has no transitions.
    released = [] if "theta" in slider else [(0.0, 1, 1, 0.0)]
    assert run.transitions[:1].tolist() == released
    assert abs(run.numbers["energy_error"]) < ENERGY


# Steps are below the rounding of the time, or there are too many.
@pytest.mark.parametrize(
    ("slider", "added", "duration"),
    [
        ({"drive_stiffness": 1e18}, {"weakening_velocity": 0.02}, 0.01),
        ({}, {"weakening_velocity": 0.02}, 1e9),
    ],
)
def test_what_is_out_of_reach_ends_with_a_line(slider, added, duration):
    with pytest.raises(TransitionLimitError, match=r"^the larger chain [^\n]+ at t = "):
        LargerChain(SLIDER(**slider), **added).simulate(duration, max_steps=1_000_000)
