"""The larger models: every transition is that of the 40-digit reference, and rests on springs are exact."""

from __future__ import annotations

import numpy as np
import pytest
from chains import SLIDER
from reference import EXTENDED, read_extended
from scipy.linalg import expm

from precursors import Chain, Run, find_slips, simulate
from precursors.hierarchy.larger import LargerChain, simulate_larger, system_of
from precursors.hierarchy.swing import Swing

SCENES = [(addition, name) for addition, scenes in EXTENDED.items() for name in scenes]
# Of transitions and their loads, [s] and [N]: measured are 5e-14 s and 3e-12 N at most.
TIME, LOAD = 3e-13, 3e-11
# 586 transitions with a heavy head multiply the rounding of the parameters: measured are 3e-12 s and 3e-9 N.
GROWN = 1000.0
# Of the paper's chain, against the exact solver: theta = +5/6 has 56 events, 4e-13 s and 3e-11 N off.
PLAIN_TIME, PLAIN_LOAD = 3e-12, 3e-10
# Of a state after a rest, relative to the largest there is: measured are 1e-11 at most, after 1e4 periods.
REST = 1e-9
# Of the largest load, taken from samples: measured are 1e-5 at most.
LARGEST = 1e-4
SAMPLES = 50_000  # of a rest, at which no block may be due
ADDITIONS = {"viscosity": 30.0, "interface_stiffness": 1.2e9, "head_mass": 0.02}


def order(run: Run) -> list[tuple[int, int]]:
    return list(zip(run.transitions["block"].tolist(), run.transitions["mode"].tolist(), strict=True))


def reference_chain(scene) -> LargerChain:
    """The chain of a scene of the reference, each number rounded once."""
    numbers = {name: float(x) for name, x in scene.slider.items() if name not in ("theta", "n_blocks")}
    exact = {name: scene.slider[name] for name in ("theta", "n_blocks") if name in scene.slider}
    added = {name: numbers.pop(name) for name in ADDITIONS if name in numbers}
    return LargerChain(SLIDER(**numbers, **exact), **added)


@pytest.mark.parametrize(("addition", "name"), SCENES)
def test_every_transition_is_that_of_the_reference(addition, name):
    scene, golden = read_extended(addition)[name]
    run = simulate_larger(reference_chain(scene), float(scene.duration), scene.until).run
    assert order(run) == [(t.block, t.mode) for t in golden]
    grown = GROWN if (addition, name) == ("head", "papers_chain") else 1.0
    times, loads = np.array([[float(t.time), float(t.tangential_load)] for t in golden]).T
    np.testing.assert_allclose(run.transitions["time"], times, rtol=0, atol=TIME * grown)
    np.testing.assert_allclose(run.transitions["tangential_load"], loads, rtol=0, atol=LOAD * grown)


@pytest.mark.parametrize("theta", ["-5/6", 0.0, "5/6"])
def test_without_additions_it_is_the_papers_chain(theta):
    exact = simulate(SLIDER(theta=theta), until="global slip")
    run = simulate_larger(LargerChain(exact.chain), 10.0, "global slip").run
    assert order(run) == order(exact)
    assert run.duration == pytest.approx(exact.duration, abs=PLAIN_TIME)
    np.testing.assert_allclose(run.transitions["time"], exact.transitions["time"], rtol=0, atol=PLAIN_TIME)
    np.testing.assert_allclose(run.intervals, exact.intervals, rtol=0, atol=PLAIN_TIME)
    loads = exact.transitions["tangential_load"]
    np.testing.assert_allclose(run.transitions["tangential_load"], loads, rtol=0, atol=PLAIN_LOAD)


def test_a_stiffer_interface_is_nearer_to_a_rigid_one():
    chain = SLIDER(3, theta="1/3", drive_velocity=0.1)
    rigid = simulate_larger(LargerChain(chain, 54.77), 0.003).run
    distance = []
    for stiffness in (3e9, 3e10, 3e11):
        run = simulate_larger(LargerChain(chain, 54.77, stiffness), 0.003).run
        assert order(run) == order(rigid)
        distance.append(np.abs(run.transitions["time"] - rigid.transitions["time"]).max())
    assert len(rigid.transitions) > 10
    assert distance[2] < distance[1] / 5 < distance[0] / 25


def propagator(model: LargerChain, time: float) -> np.ndarray:
    """What a time [s] makes of (T, v, p, V) while all blocks stick on springs; no code of the solver."""
    n, chain = model.chain.n_blocks, model.chain
    rate = np.zeros((3 * n + 1, 3 * n + 1))
    for i in range(n):
        rate[i, n + i - 1 if i else -1] += chain.springs[i]
        rate[i, n + i] -= chain.springs[i]
        rate[n + i, [i, 2 * n + i]] = [1.0, -1.0]
        rate[2 * n + i, n + i] = model.interface_stiffness / n
    for i in range(n - 1):
        rate[n + i, i + 1] = -1.0
        rate[n + i : n + i + 2, n + i : n + i + 2] += model.viscosity * np.array([[-1, 1], [1, -1]])
    rate[n : 2 * n] /= model.masses[:, None]
    # Forces and velocities of one size: the exponential of a matrix loses digits otherwise.
    unit = np.ones(3 * n + 1)
    unit[n : 2 * n] = unit[-1] = 1.0 / np.sqrt(chain.stiffness * chain.mass)
    return expm(rate * unit / unit[:, None] * time) * unit[:, None] / unit


@pytest.mark.parametrize("viscosity", [0.0, 30.0])
def test_a_rest_on_springs_ends_where_a_matrix_exponential_takes_it_and_before_any_release(viscosity):
    model = LargerChain(SLIDER(6, theta="1/3"), viscosity, 25e6, 0.002)
    system, n = system_of(model), model.chain.n_blocks
    state = np.zeros((3, n))
    state[1] = 0.03 * np.random.default_rng(3).standard_normal(n)
    before = np.append(state.ravel(), model.chain.drive_velocity)
    waited, _ = Swing(system).wait(state, 10.0)
    after = propagator(model, waited) @ before
    assert waited > 1000 * system.step
    for row, expected in zip(state, after[:-1].reshape(3, n), strict=True):
        np.testing.assert_allclose(row, expected, rtol=0, atol=REST * abs(expected).max())
    step = propagator(model, system.step / 4)
    for _ in range(min(SAMPLES, int(4 * waited / system.step))):
        before = step @ before
        assert (abs(before[2 * n : 3 * n]) < system.strength).all()


def test_leaps_change_no_transition(monkeypatch):
    # Without leaps each rest is made of steps of the Taylor series.
    model = LargerChain(SLIDER(4, drive_velocity=0.02), 0.0, 1e8)
    run = simulate_larger(model, 0.05, "global slip")
    monkeypatch.setattr(Swing, "wait", lambda self, state, longest: (0.0, 0.0))
    stepped = simulate_larger(model, 0.05, "global slip")
    assert order(run.run) == order(stepped.run)
    assert len(run.run.transitions) > 10
    times = stepped.run.transitions["time"]
    np.testing.assert_allclose(run.run.transitions["time"], times, rtol=0, atol=1e-11)
    np.testing.assert_allclose(run.largest_load, stepped.largest_load, rtol=LARGEST)


def test_a_block_on_a_spring_swings_about_the_drive():
    model = LargerChain(SLIDER(1), 0.0, 4e8)
    state, c = np.zeros((3, 1)), model.chain
    waited, _ = Swing(system_of(model)).wait(state, 0.5)
    omega = np.sqrt((c.drive_stiffness + 4e8) / c.mass)
    follows = c.drive_stiffness * c.drive_velocity / (c.drive_stiffness + 4e8)
    assert waited == 0.5
    assert omega * waited > 1e4
    assert state[2, 0] == pytest.approx(4e8 * follows * (0.5 - np.sin(omega * 0.5) / omega), rel=1e-9)


def test_the_first_release_on_springs_is_where_the_static_load_breaks_the_first_one():
    # docs/models.md has the force on block 1 of a long chain at rest. Ringing adds a part that falls with the
    # drive's velocity: measured are 9.4e-6 at 1e-3 m/s and 9.4e-7 at 1e-4 m/s.
    for velocity, rest in ((1e-3, 2e-5), (1e-4, 2e-6)):
        chain = SLIDER(30, drive_velocity=velocity)
        run = simulate_larger(LargerChain(chain, 54.77, 7.5e9), 40e-3 / (velocity / 1e-3)).run
        k, kappa = chain.stiffness, 2.5e8
        decay = 1 + kappa / (2 * k) - np.sqrt((1 + kappa / (2 * k)) ** 2 - 1)
        load = chain.strength[0] * (kappa + k * (1 - decay)) / kappa
        assert order(run)[0] == (1, 1)
        assert run.transitions["tangential_load"][0] == pytest.approx(load, rel=rest)


def test_a_run_to_the_global_slip_ends_with_it_on_an_interface_that_never_rests():
    model = LargerChain(SLIDER(4, drive_velocity=0.05), **ADDITIONS)
    run, longer = simulate_larger(model, 1.0, "global slip"), simulate_larger(model, 0.02)
    n = len(run.run.transitions)
    assert run.run.duration == run.run.transitions["time"][-1] < 0.02 == longer.run.duration
    assert (run.run.transitions == longer.run.transitions[:n]).all()
    assert find_slips(run.run)["is_global"].tolist()[-1]
    assert (run.largest_load >= run.run.transitions["tangential_load"]).all()


def test_a_run_without_a_transition_has_none():
    run = simulate_larger(LargerChain(SLIDER(), 0.0, 25e6), 1e-3)
    assert len(run.run.transitions) == len(run.largest_load) == 0
    assert run.run.duration == 1e-3


@pytest.mark.parametrize("name", ADDITIONS)
def test_an_addition_is_a_number_that_is_not_negative(name):
    for value in (-1.0, float("nan"), "much"):
        with pytest.raises(ValueError, match=f"^{name} "):
            LargerChain(SLIDER(), **{name: value})


@pytest.mark.parametrize(
    ("slider", "message"), [({"theta": 1.0}, "must have weight"), ({"mu_k": 0.7}, "mu_k")]
)
def test_a_chain_that_could_slide_without_a_force_is_refused(slider, message):
    with pytest.raises(ValueError, match=message):
        LargerChain(Chain.from_slider(**slider), 1.0)
