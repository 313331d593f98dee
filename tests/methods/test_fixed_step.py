"""Whole runs of fixed-step methods: transitions, orders with switching, dead zones, Eq. 4 taken literally."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from precursors import Chain, Run, TransitionLimitError, find_slips, simulate
from precursors.accuracy.compare import transitions_right
from precursors.accuracy.failures.common import FIVE_SLIPS
from precursors.accuracy.failures.literal_friction import load_after_limit
from precursors.methods import METHODS, DivergedError, moreau_jean, rk4_located
from precursors.methods.columns import FORCE, VELOCITY, at_rest, set_modes, sliding_forward
from precursors.methods.fixed_step import FIRST_ROOM, march
from precursors.methods.rk4 import run_rk4
from precursors.methods.stability import bisect, highest_frequency

# They wait in closed form while all blocks stick.
WAITING = (
    "rk4_skip",
    "rk4_located",
    "leapfrog",
    "semi_implicit_euler",
    "forward_euler",
    "newmark",
    "hht",
    "moreau_jean_half",
    "moreau_jean_one",
    "karnopp",
)
SMOOTH = {name: method.smooth for name, method in METHODS.items() if method.smooth}
# Orders with transitions, and the two steps between which they are measured [s].
ORDERS = {
    **dict.fromkeys(WAITING, (1.0, 5e-8, 5e-9)),  # a transition within a step is an error of its length
    "rk4_located": (4.0, 8e-7, 2e-7),
    "forward_euler": (1.0, 5e-9, 1e-9),  # energy that is made loses transitions at larger steps
    "karnopp": (0.5, 3e-8, 3e-9),  # creep in the dead zone
}
# Where a transition falls within a step is chance: an average over this many steps leaves a few per cent.
STEPS_IN_SAMPLE = 60
ORDER_TOLERANCE = 0.15
# Relative, of a slip of 4e-4 s by a clock that does not start anew at its onset, at 3.5 s.
CLOCK_ROUNDING = 1e-9
# Relative error of sums of some hundred terms in double precision.
ROUNDING = 1e-12
# What the load changes by in the step in which a block stops [N]; other methods differ by 1e-6 to 1 N.
LAST_STEP = 2e-3
# Trembling and creep repeat at another step to within what the step adds to a release.
CREEP_TOLERANCE = 0.02
# Of F_Z, after some tens of transitions in chains of up to three blocks with a step of 1e-8 s.
SHORT_CHAIN_TOLERANCE = 1e-3


@pytest.fixture(scope="module")
def chain() -> Chain:
    return Chain.from_slider()


@pytest.fixture(scope="module")
def five_slips(chain: Chain) -> Run:
    run = simulate(chain, FIVE_SLIPS)
    assert len(find_slips(run)) == 5
    return run


def load_error(run: Run, exact: Run) -> float:
    """Root mean square error of F_X at the transitions [N], of a run whose transitions are the right ones."""
    assert transitions_right(run, exact) == len(run.transitions) == len(exact.transitions)
    difference = run.transitions["tangential_load"] - exact.transitions["tangential_load"]
    return float(np.sqrt(np.mean(difference**2)))


@pytest.mark.parametrize("n_blocks", [1, 2, 3])
@pytest.mark.parametrize("name", WAITING)
def test_at_a_fine_step_every_method_gives_the_transitions_of_short_chains(name, n_blocks):
    chain = Chain.from_slider(n_blocks=n_blocks)
    duration = 3.6  # past the first global slip
    exact = simulate(chain, duration)
    run = METHODS[name].solve(chain, duration, 1e-8, None).run
    assert find_slips(run)["is_global"].any()
    assert load_error(run, exact) < SHORT_CHAIN_TOLERANCE * chain.normal_load


@pytest.mark.parametrize("name", SMOOTH)
def test_a_slip_of_the_method_in_the_table_is_made_of_its_smooth_steps(name):
    chain, step = Chain.from_slider(n_blocks=1), 1e-6
    run = METHODS[name].solve(chain, 3.6, step, None).run
    release, stop = run.transitions[:2]
    n_steps = round(run.intervals[1] / step)
    for n, stops in ((n_steps - 1, False), (n_steps, True)):
        system, state = sliding_forward(chain, np.zeros(1))
        state[FORCE, 1] = release["tangential_load"]
        SMOOTH[name].slide(system, state, step, n)
        assert bool(state[VELOCITY, 1] < 0.0) is stops
    assert run.intervals[1] == pytest.approx(n_steps * step, rel=CLOCK_ROUNDING)
    # Moreau-Jean time stepping stops the block within the last step, the others after it.
    last_step = LAST_STEP if name.startswith("moreau_jean") else 0.0
    assert stop["tangential_load"] == pytest.approx(state[FORCE, 1], rel=ROUNDING, abs=last_step)


def test_methods_that_wait_make_no_steps_while_all_blocks_stick(chain):
    assert {METHODS[name].solve(chain, 0.1, 1e-5, None).evaluations for name in WAITING} == {0}


def test_beyond_the_limit_a_run_ends_with_the_last_finite_transitions(chain):
    step = 1.5 * 2.0 / highest_frequency(chain)
    with pytest.raises(DivergedError, match="the numbers overflow at") as diverged:
        METHODS["leapfrog"].solve(chain, 10.0, step, None)
    run = diverged.value.run
    assert np.isfinite(run.transitions["tangential_load"]).all()
    assert run.duration < 10.0
    ends = np.append(run.transitions["time"], run.duration)
    np.testing.assert_allclose(np.cumsum(run.intervals), ends, rtol=CLOCK_ROUNDING)


def test_a_record_gets_more_room_and_ends_at_the_limit_of_transitions():
    chain = Chain.from_slider(n_blocks=3, drive_velocity=1e-2)
    run = METHODS["rk4_skip"].solve(chain, 10.0, 1e-6, None).run
    assert len(run.transitions) > 2 * FIRST_ROOM
    with pytest.raises(TransitionLimitError, match="max_transitions = 10 reached") as limit:
        march(run_rk4, (), chain, 10.0, 1e-6, max_transitions=10)
    first = limit.value.run
    np.testing.assert_array_equal(first.transitions, run.transitions[: len(first.transitions)])
    assert first.intervals.sum() == pytest.approx(first.duration)


@pytest.mark.parametrize("name", ORDERS)
def test_the_order_with_transitions_depends_on_how_they_are_located(five_slips, name):
    order, coarse, fine = ORDERS[name]

    def error(step: float) -> float:
        steps = step * np.linspace(0.8, 1.2, STEPS_IN_SAMPLE)
        runs = (METHODS[name].solve(five_slips.chain, FIVE_SLIPS, h, None).run for h in steps)
        return float(np.sqrt(np.mean([load_error(run, five_slips) ** 2 for run in runs])))

    found = np.log(error(coarse) / error(fine)) / np.log(coarse / fine)
    assert found == pytest.approx(order, abs=ORDER_TOLERANCE)


@pytest.mark.parametrize("theta", ["-5/6", 0.0, "5/6"])
def test_eq_4_taken_literally_never_sticks_again(theta):
    run = METHODS["literal"].solve(Chain.from_slider(theta=theta), 1.0, 1e-6, None).run
    assert not (run.transitions["mode"] == 0).any()
    assert len(find_slips(run)) == 1
    ends = np.append(run.transitions["time"], run.duration)
    np.testing.assert_allclose(np.cumsum(run.intervals), ends, rtol=CLOCK_ROUNDING)


def test_eq_4_taken_literally_creeps_by_the_step_not_by_the_model(chain):
    """Blocks tremble about v = 0 by what a step changes v, and creep in proportion to it.

    F_X falls at coarse steps and rises without a slip at fine ones; the limit is proportional to V.
    """

    def limit(speed: float) -> float:
        fast = replace(Chain.from_slider(theta="-5/6"), drive_velocity=speed)
        seconds = 1e-6 / speed

        def falls(step: float) -> bool:
            early, late = load_after_limit(fast, step, np.array([2 * seconds, 4 * seconds]))
            return late < early

        return bisect(falls, 2e-5 * speed, 2e-3 * speed)

    slow, fast = limit(1e-3), limit(4e-3)
    assert fast / slow == pytest.approx(4.0, rel=CREEP_TOLERANCE)
    # The paper's V: RK4 with a step of 1e-7 s never exceeds the first limit, with 1e-8 s it does.
    assert 1e-8 < slow / 10 < 1e-7
    assert max(load_after_limit(chain, 1e-7, np.array([0.02, 0.04]))) < chain.strength[0]
    assert max(load_after_limit(chain, 1e-8, np.array([0.02, 0.04]))) > chain.strength[0]


@pytest.mark.parametrize("theta", [moreau_jean.TRAPEZOIDAL, moreau_jean.IMPLICIT])
@pytest.mark.parametrize("modes", [[1, 1, 1, 1], [1, 0, -1, 1], [0, 0, 1, 0], [-1, 1, 0, 0]])
def test_moreau_jean_balances_every_block_in_a_step_with_the_friction_that_it_finds(theta, modes):
    """m (v' - v) = h (T*_i - T*_{i+1} - R_i): friction of a block that slides is kinetic, else v' = 0."""
    chain, h = Chain.from_slider(n_blocks=4, theta="5/6", drive_stiffness=3e6), 3e-7
    random = np.random.default_rng(7)
    system, state = at_rest(chain)
    state[FORCE, 1:-1], state[VELOCITY, 1:-1] = 30 * random.normal(size=4), random.normal(size=4)
    before = state.copy()
    set_modes(system, state, np.array(modes, float))
    work = np.zeros((4, 6))
    work[3, 0] = chain.drive_velocity
    moreau_jean.explicit_forces.py_func(system, state, 4, h, theta, work[0])
    moreau_jean.solve_velocities.py_func(system, state, 4, h, theta, work)
    found = [moreau_jean.static_friction.py_func(system, state, i, h, theta, work) for i in range(1, 5)]
    friction = np.where(modes, modes * chain.kinetic_friction, found)
    after = np.append(chain.drive_velocity, work[3, 1:5])
    assert not after[1:][np.array(modes) == 0].any()
    mean = theta * after + (1 - theta) * before[VELOCITY, :-1]
    forces = np.append(before[FORCE, 1:-1] - theta * h * chain.springs * np.diff(mean), 0.0)
    impulses = h * (-np.diff(forces) - friction)
    change = chain.mass * (after[1:] - before[VELOCITY, 1:-1])
    np.testing.assert_allclose(impulses, change, rtol=0, atol=ROUNDING * abs(change).max())


@pytest.mark.parametrize("g0", [1.0, 0.0])
def test_located_steps_see_every_dip_of_a_cubic(g0):
    """Also between positive ends; the zero is where the cubic first falls, from above or after a rise."""
    s, dips = np.linspace(0.0, 1.0, 2001), 0
    random = np.random.default_rng(1)
    for p1, p2, g1 in random.uniform(-1.5, 1.0, (1000, 3)) * [1.0, 0.1, 0.1]:
        p1 = p1 if g0 else abs(p1)
        b0, b1 = 3.0 * (p1 - g0), 3.0 * (g1 - p2)
        r = 1.0 - s
        cubic = g0 * r**3 + 3.0 * s * r * (p1 * r + p2 * s) + g1 * s**3
        found = rk4_located.first_zero(g0, b0, g1, b1, 1e-12)
        if cubic.min() < 0.0:
            dips += g1 > 0.0
            zero = s[np.argmax(cubic < 0.0)]
            assert found == pytest.approx(zero, abs=1e-3)
            assert abs(rk4_located.cubic_at(found, g0, b0, g1, b1)) < ROUNDING
        elif cubic[20:].min() > 1e-3:
            assert found == rk4_located.NEVER
    assert dips > 10
