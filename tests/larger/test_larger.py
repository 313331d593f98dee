"""The larger chain against solvers and closed forms that share no code with it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from chains import SLIDER
from golden.kept import assert_table
from golden.small_tables import small_larger_tables
from scipy.integrate import solve_ivp

from precursors import (
    Record,
    Run,
    RunFileError,
    TransitionLimitError,
    audit,
    simulate,
)
from precursors.analysis.load_curve import load_curve
from precursors.larger.chain import (
    LargerChain,
    critical_length,
    model_of,
    simulate_larger,
    tilt,
    weakening_velocity,
)
from precursors.larger.steps import SLOW, State, try_step

# Tolerances beside the cases are two to three times what is measured at the default
# step.
ENERGY = 1e-6  # of the work of the drive; 3.6e-7 is measured
PAIR = {"weakening_velocity": 0.01, "relaxation_time": 5e-6}  # l_c = 0.089 L
SLIP = "global slip"


def order(run: Record) -> list[tuple[int, int]]:
    return list(
        zip(
            run.transitions["block"].tolist(),
            run.transitions["mode"].tolist(),
            strict=True,
        )
    )


def by_dop853(larger: LargerChain, duration: float) -> np.ndarray:
    """Rows of time, block, mode, F_X where a block becomes faster or slower than SLOW
    v_c."""
    c, v_c, n = larger.chain, larger.weakening_velocity, larger.chain.n_blocks
    eta, limit = larger.relaxation_time * c.stiffness, SLOW * v_c
    tilts = tilt(c, larger.push_height)
    mode, t, state, rows = np.zeros(n, int), 0.0, np.zeros(2 * n), []

    def forces(t, y):
        x, v = y[:n], y[n:]
        link = -c.stiffness * np.diff(x) - eta * np.diff(v)
        load = c.drive_stiffness * (c.drive_velocity * t - x[0])
        return (
            load,
            np.append(load, link) - np.append(link, 0.0),
            c.weights + tilts * load,
        )

    def motion(t, y):
        net, w = forces(t, y)[1:]
        mu = c.mu_s - (c.mu_s - c.mu_k) * np.minimum(abs(y[n:]) / v_c, 1.0)
        return np.append(
            y[n:], np.where(mode != 0, (net - mode * mu * w) / c.mass, 0.0)
        )

    def event(function, direction, terminal):
        function.direction, function.terminal = direction, terminal
        return function

    while t < duration:
        if not mode.any():  # only F_X grows
            net, w = forces(t, state)[1:]
            rate = c.loading_rate * (np.eye(n)[0] - c.mu_s * tilts)
            t += max((c.mu_s * w - net)[0] / rate[0], 0.0)
            mode[0] = 1
            continue
        events = []
        for i in range(n):
            if mode[i]:
                events.append(
                    event(lambda t, y, i=i, s=mode[i]: s * y[n + i], -1, True)
                )
            else:

                def margin(t, y, i=i):
                    _, force, weight = forces(t, y)
                    return c.mu_s * weight[i] - abs(force[i])

                events.append(event(margin, -1, True))
        for i in range(n):
            events.append(event(lambda t, y, i=i: abs(y[n + i]) - limit, 0, False))
        found = solve_ivp(
            motion,
            (t, duration),
            state,
            "DOP853",
            events=events,
            rtol=1e-10,
            atol=1e-13,
        )
        for i in range(n):
            for when, y in zip(
                found.t_events[n + i], found.y_events[n + i], strict=True
            ):
                faster = abs(y[n + i] + 1e-9 * motion(when, y)[n + i]) > abs(y[n + i])
                rows.append((when, i + 1, mode[i] if faster else 0, forces(when, y)[0]))
        t, state = found.t[-1], found.y[:, -1].copy()
        for i in range(n):
            if len(found.t_events[i]):
                state[n + i] = 0.0
                _, net, w = forces(t, state)
                mode[i] = (
                    0 if mode[i] and abs(net[i]) <= c.mu_s * w[i] else np.sign(net[i])
                )
    return np.array(sorted(rows))


@pytest.mark.parametrize(
    ("n", "added", "duration", "tolerance"),
    [
        (1, {"weakening_velocity": 0.05}, 0.6, 5e-6),
        (2, {"weakening_velocity": 0.02, "relaxation_time": 1e-5}, 0.25, 2e-5),
        (
            3,
            {"weakening_velocity": 0.05, "relaxation_time": 2e-6, "push_height": 0.002},
            0.2,
            2e-4,
        ),
        (4, {"weakening_velocity": 0.02, "push_height": 0.003}, 0.2, 1e-4),
    ],
)
def test_loads_are_those_of_dop853_with_located_transitions(
    n, added, duration, tolerance
):
    larger = LargerChain(SLIDER(n, theta="1/4", drive_velocity=1e-3), **added)
    run, expected = simulate_larger(larger, duration), by_dop853(larger, duration)
    assert len(expected) > 1
    assert order(run) == [(int(b), int(m)) for _, b, m, _ in expected]
    np.testing.assert_allclose(
        run.transitions["tangential_load"], expected[:, 3], rtol=tolerance
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


# Chains with viscosity [N s/m], which no certificate covers: until when they run, and how
# closely loads agree with those of a method in 70 digits that shared no code.
VISCOUS = {
    "papers_chain": ({}, 54.77, 5.0, "global slip", 6e-8),
    "backward": ({"n_blocks": 3, "theta": "1/2", "mu_k": 0.05}, 3.0, 3.0, None, 2e-4),
    "stiff_viscosity": ({"n_blocks": 3, "theta": "1/3"}, 300.0, 8.0, None, 1e-8),
}
GOLDEN_VISCOUS = Path(__file__).parents[1] / "golden/reference_viscous.csv"


@pytest.mark.parametrize("name", VISCOUS)
def test_viscosity_alone_has_the_transitions_of_a_method_in_70_digits(name):
    slider, viscosity, duration, until, tolerance = VISCOUS[name]
    larger = LargerChain(SLIDER(**slider), viscosity=viscosity)
    run = simulate_larger(larger, duration, until)
    golden = pd.read_csv(GOLDEN_VISCOUS).query("chain == @name")
    assert order(run) == list(zip(golden["block"], golden["mode"], strict=True))
    np.testing.assert_allclose(
        run.transitions["tangential_load"], golden["tangential_load_N"], rtol=tolerance
    )


@pytest.mark.parametrize("n", [2, 7, 50])
def test_a_tilt_keeps_the_sum_of_loads_and_balances_the_torque(n):
    chain, height = SLIDER(n), 3e-3
    change = tilt(chain, height)
    arms = chain.length * ((np.arange(n) + 0.5) / n - 0.5)
    assert change.sum() == pytest.approx(0.0, abs=1e-15)
    assert change @ arms == pytest.approx(height, rel=1e-13)


@pytest.mark.parametrize("theta", ["-5/6", 0, "5/6"])
@pytest.mark.parametrize(
    ("v_c", "t_v"), [(0.02, 0.0), (0.03, 1e-6), (0.01, 5e-6), (0.02, 2e-5)]
)
def test_creep_longer_than_l_c_has_a_real_growing_mode(v_c, t_v, theta):
    n = 400
    chain = SLIDER(
        n, theta=theta, drive_stiffness=1.0
    )  # a soft drive is the free end of the theory
    blocks = n * critical_length(LargerChain(chain, v_c, t_v)) / chain.length

    def fastest_is_real(p):
        links = (
            np.diag(np.full(p, 2.0))
            - np.diag(np.ones(p - 1), 1)
            - np.diag(np.ones(p - 1), -1)
        )
        links[0, 0] = 1.0
        fall = (chain.mu_s - chain.mu_k) * chain.weights[:p] / v_c
        damping = (np.diag(fall) - t_v * chain.stiffness * links) / chain.mass
        rates = np.linalg.eigvals(
            np.block(
                [
                    [np.zeros((p, p)), np.eye(p)],
                    [-chain.stiffness / chain.mass * links, damping],
                ]
            )
        )
        return bool(
            (
                abs(rates[rates.real > 1e-6 * abs(rates).max()].imag)
                < 1e-6 * abs(rates).max()
            ).any()
        )

    assert not fastest_is_real(int(0.95 * blocks))
    assert fastest_is_real(int(1.05 * blocks) + 1)


@pytest.mark.parametrize("t_v", [0.0, 1e-5, 2e-4])
@pytest.mark.parametrize("part", [0.05, 0.1, 0.3])
def test_an_even_load_has_the_closed_form_of_l_c(part, t_v):
    chain = SLIDER(100)
    v_c = weakening_velocity(chain, part, t_v)
    length = critical_length(LargerChain(chain, v_c, t_v))
    # A step along the chain is 5e-4 L; growth rates are tried at steps of 4 %.
    assert length / chain.length == pytest.approx(part, abs=6e-4)


def test_creep_of_a_chain_that_hardly_weakens_does_not_run_away():
    assert critical_length(LargerChain(SLIDER(), 10.0, 1e-4)) == np.inf
    assert critical_length(LargerChain(SLIDER())) == 0.0


WEAKENING = {"weakening_velocity": 0.01, "relaxation_time": 5e-6}


@pytest.mark.parametrize(
    ("n", "theta", "added", "duration"),
    [
        (8, "-5/6", WEAKENING | {"push_height": 0.003}, 3.0),
        (12, "-1/2", {"weakening_velocity": 0.07, "viscosity": 100.0}, 0.8),
        (6, "5/6", {"viscosity": 50.0}, 2.2),
        (5, "1/3", {"push_height": 0.003}, 2.5),
    ],
)
def test_a_run_balances_energy(n, theta, added, duration):
    run = simulate_larger(LargerChain(SLIDER(n, theta=theta), **added), duration)
    assert abs(run.numbers["energy_error"]) < ENERGY


def test_the_tables_of_the_study_are_those_that_are_kept():
    for name, table in small_larger_tables().items():
        assert_table(name, table)


def test_a_run_survives_its_file_and_knows_its_transitions_only(tmp_path):
    run = simulate_larger(LargerChain(SLIDER(3), **PAIR), 0.5)
    run.save(tmp_path / "run.h5")
    again = Record.load(tmp_path / "run.h5")
    assert again.numbers == run.numbers
    np.testing.assert_array_equal(np.transpose(load_curve(again)), run.load_points)
    with pytest.raises(RunFileError, match="holds a SteppedRun and not a Run: Record"):
        Run.load(tmp_path / "run.h5")
    with pytest.raises(TypeError, match="must be a Run, but is SteppedRun"):
        audit(run)


@pytest.mark.parametrize(
    ("added", "message"),
    [
        ({"weakening_velocity": -1.0}, "^weakening_velocity must be between 0 and"),
        ({"relaxation_time": float("nan")}, "^relaxation_time must be a finite number"),
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
    with pytest.raises(TypeError, match=r"^chain must be a Chain, but is 'x'$"):
        LargerChain("x")


def test_a_block_that_moves_against_its_mode_stops_at_once():
    """Its velocity is of the size of an error; the clock must not run backwards."""
    larger = LargerChain(SLIDER(), **PAIR)
    state = State(*np.zeros((7, 11)), *np.zeros((2, 11), np.int64), np.zeros(2))
    state.mode[0], state.velocity[0] = 1, -1e-9
    assert try_step(model_of(larger), state, 0, 2, 1e-7, False) == (0.0, 0)


def test_a_limit_that_is_met_keeps_the_run_so_far():
    with pytest.raises(TransitionLimitError, match="met its limit of work") as met:
        simulate_larger(LargerChain(SLIDER(), **PAIR), 10.0, max_transitions=50)
    assert len(met.value.run.transitions) > 50


WEIGHTLESS = {"theta": 1, "n_blocks": 5}
# Out of reach: steps are below the rounding of the time, or there are too many.
HARD = [
    ({"drive_stiffness": 1e18}, {"weakening_velocity": 0.02}, 0.01),
    ({"mu_s": 0.0, "mu_k": 0.0}, {"relaxation_time": 1e-5}, 1e9),
    ({}, {"weakening_velocity": 0.02}, 1e9),
]


@pytest.mark.parametrize(
    ("slider", "added"),
    [
        (WEIGHTLESS, {"relaxation_time": 1e-5}),
        ({"mu_s": 0.0, "mu_k": 0.0}, {"relaxation_time": 1e-5}),
        ({"mu_s": 0.0, "mu_k": 0.0}, {"push_height": 1e-3}),
        ({"mu_s": 0.0, "mu_k": 0.0}, {"weakening_velocity": 0.02}),
    ],
)
def test_blocks_without_friction_move_with_the_drive(slider, added):
    run = simulate_larger(LargerChain(SLIDER(**slider), **added), 1e-3)
    # A block without load has no transitions.
    released = [] if slider is WEIGHTLESS else [(0.0, 1, 1, 0.0)]
    assert run.transitions[:1].tolist() == released
    assert abs(run.numbers["energy_error"]) < ENERGY


@pytest.mark.parametrize(("slider", "added", "duration"), HARD)
def test_what_is_out_of_reach_ends_with_a_line(monkeypatch, slider, added, duration):
    monkeypatch.setattr("precursors.larger.chain.PATIENCE", 1_000_000)
    with pytest.raises(TransitionLimitError, match=r"^the larger chain [^\n]+ at t = "):
        simulate(LargerChain(SLIDER(**slider), **added), duration)
