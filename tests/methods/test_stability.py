"""Fixed-step methods fail where theory says and converge as fast as it says: each test finds the limit."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from scipy.linalg import expm

from precursors import Chain, Run, find_slips, simulate
from precursors.accuracy.failures.common import transitions_right
from precursors.accuracy.failures.friction_laws import (
    FIVE_SLIPS,
    first_excess,
    largest_dead_zone,
    literal_load,
    smallest_dead_zone,
)
from precursors.methods import METHODS, DivergedError, karnopp, literal, moreau_jean
from precursors.methods.forces import sliding_forward, system_of
from precursors.methods.stability import (
    LEAPFROG_LIMIT,
    RK4_LIMIT,
    SLIDES,
    Slide,
    bisect,
    energy_grows,
    energy_left,
    highest_frequency,
    highest_mode,
    largest_stable_step,
    leapfrog_growth,
    moreau_jean_growth,
    rk4_growth,
    without_friction,
)

# So much beyond RK4's limit energy grows a millionfold within 4000 steps; a wrong drive spring would move it
# by 1e-3.
LIMIT_TOLERANCE = 5e-4

# Of a factor a step: rounding of some tens of steps, and of the frequency.
GROWTH_TOLERANCE = 1e-9

# An order is measured over halvings or over a decade of steps.
ORDER_TOLERANCE = 0.1
# Where a switch falls within a step is chance: an average over this many steps leaves a few per cent.
STEPS_IN_SAMPLE = 60
SAMPLED_ORDER_TOLERANCE = 0.15
# Relative error of sums of some hundred terms in double precision, through several windows.
ROUNDING = 1e-12
# Relative, of a slip of 4e-4 s by a clock that does not start anew at its onset, at 3.5 s.
CLOCK_ROUNDING = 1e-9
# What the load changes by in the step in which a block stops [N]; other methods differ by 1e-6 to 1 N.
LAST_STEP = 2e-3
# Relative rounding of a step with omega dt = 100, by whose square the springs' forces outweigh inertia.
STIFF_ROUNDING = 100**2 * float(np.finfo(float).eps)

# Whether a block jumps over the zone is chance: so much between two steps.
JUMP_TOLERANCE = 0.3
# Chatter and creep repeat at another step to within what the step adds to a release.
CREEP_TOLERANCE = 0.02

# Of F_Z, after some tens of transitions in chains of up to three blocks with a step of 1e-8 s.
SHORT_CHAIN_TOLERANCE = 1e-3

# A stretch in which all blocks slide forward: four radians of the fastest oscillation.
STRETCH = 1.5e-5
VELOCITIES = 0.5 + 0.1 * np.sin(1.0 + 2.0 * np.arange(10.0))
FIXED_STEP = (
    "rk4_skip",
    "rk4_located",
    "leapfrog",
    "semi_implicit_euler",
    "moreau_jean_half",
    "moreau_jean_one",
    "karnopp",
)

ORDERS = {
    "rk4": 4,
    "leapfrog": 2,
    "semi_implicit_euler": 1,
    "moreau_jean_half": 2,
    "moreau_jean_one": 1,
}


@pytest.fixture(scope="module")
def chain() -> Chain:
    return Chain.from_slider()


@pytest.fixture(scope="module")
def free(chain: Chain) -> Chain:
    """The chain without friction and with (almost) resting drive: its energy stays as it is."""
    return without_friction(chain)


@pytest.fixture(scope="module")
def five_slips(chain: Chain) -> Run:
    run = simulate(chain, FIVE_SLIPS)
    assert len(find_slips(run)) == 5
    return run


@pytest.mark.parametrize(
    ("name", "limit"),
    [("rk4", RK4_LIMIT), ("leapfrog", LEAPFROG_LIMIT), ("semi_implicit_euler", LEAPFROG_LIMIT)],
)
def test_energy_grows_beyond_the_step_that_theory_allows(free: Chain, name: str, limit: float) -> None:
    found = largest_stable_step(free, SLIDES[name])
    assert found * highest_frequency(free) == pytest.approx(limit, rel=LIMIT_TOLERANCE)


def test_beyond_the_limit_a_run_ends_with_the_last_finite_transitions(chain: Chain) -> None:
    step = 1.5 * 2.0 / highest_frequency(chain)
    with pytest.raises(DivergedError, match="grows beyond all numbers") as diverged:
        METHODS["leapfrog"].solve(chain, 10.0, step, None)
    assert np.isfinite(diverged.value.run.transitions["tangential_load"]).all()
    assert diverged.value.run.duration < 10.0


def test_the_drive_spring_lowers_the_limit_where_it_is_the_stiffest(free: Chain) -> None:
    stiff = replace(free, drive_stiffness=100 * free.stiffness)
    assert highest_frequency(stiff) > 4 * highest_frequency(free)
    found = largest_stable_step(stiff, SLIDES["rk4"])
    assert found * highest_frequency(stiff) == pytest.approx(RK4_LIMIT, rel=LIMIT_TOLERANCE)


def test_moreau_jean_is_stable_at_any_step_from_theta_one_half_on(free: Chain) -> None:
    step = 100 / highest_frequency(free)

    def grows_below(theta: float) -> bool:
        # Below one half, growth at this step is 4 (1/2 - theta) a step: 1e6 within 4000 steps from 0.499 on.
        return energy_grows(free, lambda *start: moreau_jean.slide(*start, theta), step)

    assert bisect(grows_below, 0.6, 0.4) == pytest.approx(0.5, rel=2e-3)


def test_moreau_jean_keeps_the_energy_at_one_half_and_loses_it_at_one(free: Chain) -> None:
    step, n_steps = 100 / highest_frequency(free), 4000
    half, one = (
        energy_left(free, SLIDES[name], step, n_steps, VELOCITIES)
        for name in ("moreau_jean_half", "moreau_jean_one")
    )
    assert half == pytest.approx(1.0, rel=n_steps * STIFF_ROUNDING)
    assert one < 1e-12


@pytest.mark.parametrize(
    ("name", "growth", "z", "n_steps"),
    [
        ("rk4", rk4_growth, 2.6, 8),
        ("rk4", rk4_growth, 3.0, 20),
        ("leapfrog", leapfrog_growth, 2.2, 20),
        ("moreau_jean_half", partial(moreau_jean_growth, theta=0.5), 3.0, 200),
        ("moreau_jean_one", partial(moreau_jean_growth, theta=1.0), 0.1, 200),
    ],
)
def test_the_fastest_mode_grows_or_fades_a_step_by_the_closed_form(
    free: Chain, name: str, growth: Callable[[float], float], z: float, n_steps: int
) -> None:
    step, mode = z / highest_frequency(free), highest_mode(free)
    # Once the energy swings no more: leapfrog's second root fades meanwhile.
    once, twice = (energy_left(free, SLIDES[name], step, n, mode) for n in (n_steps, 2 * n_steps))
    assert (twice / once) ** (1 / n_steps) == pytest.approx(growth(z), rel=GROWTH_TOLERANCE)


def exact_motion(chain: Chain, time: float) -> np.ndarray:
    """Spring forces and velocities of sliding blocks, by the exponential of the whole system's matrix."""
    n = chain.n_blocks
    bonds = np.eye(n) - np.eye(n, k=-1)
    matrix = np.zeros((2 * n + 1, 2 * n + 1))
    matrix[:n, n : 2 * n] = -chain.springs[:, None] * bonds
    matrix[n : 2 * n, :n] = bonds.T / chain.mass
    matrix[0, -1] = chain.loading_rate
    matrix[n : 2 * n, -1] = -chain.kinetic_friction / chain.mass
    return (expm(matrix * time) @ np.concatenate([np.zeros(n), VELOCITIES, [1.0]]))[:-1]


def scaled(chain: Chain, tension: np.ndarray, velocity: np.ndarray) -> np.ndarray:
    """Forces in the unit of velocities [m/s]."""
    return np.concatenate([tension / np.sqrt(chain.stiffness * chain.mass), velocity])


def smooth_error(chain: Chain, slide: Slide, n_steps: int) -> float:
    system = system_of(chain)
    state = sliding_forward(system, VELOCITIES)
    slide(system, state, STRETCH / n_steps, n_steps)
    exact = exact_motion(chain, STRETCH)
    n = chain.n_blocks
    assert (exact[n:] > 0).all()
    difference = scaled(chain, state.tension[1:-1] - exact[:n], state.velocity[1:-1] - exact[n:])
    return float(np.linalg.norm(difference))


@pytest.mark.parametrize("name", ORDERS)
def test_on_a_smooth_stretch_the_order_is_that_of_the_method(chain: Chain, name: str) -> None:
    coarse, fine = (smooth_error(chain, SLIDES[name], n) for n in (128, 256))
    assert np.log2(coarse / fine) == pytest.approx(ORDERS[name], abs=ORDER_TOLERANCE)


@pytest.mark.parametrize("name", SLIDES)
def test_a_slip_of_the_method_in_the_table_is_made_of_its_smooth_steps(name: str) -> None:
    chain, step = Chain.from_slider(n_blocks=1), 1e-6
    run = METHODS[name].solve(chain, 3.6, step, None).run
    system = system_of(chain)
    state = sliding_forward(system, np.zeros(1))
    release, stop = run.transitions[:2]
    state.tension[1] = release["tangential_load"]
    n_steps = 0
    while state.velocity[1] >= 0.0:
        SLIDES[name](system, state, step, 1)
        n_steps += 1
    assert run.intervals[1] == pytest.approx(n_steps * step, rel=CLOCK_ROUNDING)
    # Moreau-Jean time stepping stops the block within the last step, the others after it.
    last_step = LAST_STEP if name.startswith("moreau_jean") else 0.0
    assert stop["tangential_load"] == pytest.approx(state.tension[1], rel=ROUNDING, abs=last_step)


def test_only_rk4_as_it_stands_makes_steps_while_all_blocks_stick(chain: Chain) -> None:
    assert METHODS["rk4"].solve(chain, 0.1, 1e-5, None).evaluations == pytest.approx(40_000, abs=8)
    assert {METHODS[name].solve(chain, 0.1, 1e-5, None).evaluations for name in FIXED_STEP} == {0}


@pytest.mark.parametrize("n_blocks", [1, 2, 3])
@pytest.mark.parametrize("name", FIXED_STEP)
def test_at_a_fine_step_every_method_gives_the_transitions_of_short_chains(name: str, n_blocks: int) -> None:
    chain = Chain.from_slider(n_blocks=n_blocks)
    duration = 3.6  # past the first global slip
    exact = simulate(chain, duration)
    run = METHODS[name].solve(chain, duration, 1e-8, None).run
    assert find_slips(run)["is_global"].any()
    assert load_error(run, exact) < SHORT_CHAIN_TOLERANCE * chain.normal_load


@pytest.mark.parametrize("pieces", [1, 7, 64])
def test_the_exact_solver_has_no_order_in_whatever_pieces_it_goes(chain: Chain, pieces: int) -> None:
    time = STRETCH / pieces
    position, velocity = np.zeros(10), VELOCITIES
    for _ in range(pieces):
        run = simulate(chain, time, start_positions=position, start_velocities=velocity)
        positions, velocities = run.at([time])
        position, velocity = positions[0] - chain.drive_velocity * time, velocities[0]
    tension = chain.springs * (np.append(0.0, position[:-1]) - position)
    exact = scaled(chain, *np.split(exact_motion(chain, STRETCH), 2))
    assert scaled(chain, tension, velocity) == pytest.approx(exact, abs=ROUNDING * np.abs(exact).max())


def load_error(run: Run, exact: Run) -> float:
    """Root mean square error of F_X at the transitions [N], of a run whose transitions are the right ones."""
    assert transitions_right(run, exact) == len(run.transitions) == len(exact.transitions)
    return float(
        np.sqrt(np.mean((run.transitions["tangential_load"] - exact.transitions["tangential_load"]) ** 2))
    )


def sampled_order(exact: Run, name: str, coarse: float, fine: float) -> float:
    """Order from the errors around two steps, each over steps that spread by half as much again."""

    def error(step: float) -> float:
        steps = step * np.linspace(0.8, 1.2, STEPS_IN_SAMPLE)
        runs = (METHODS[name].solve(exact.chain, FIVE_SLIPS, h, None).run for h in steps)
        return float(np.sqrt(np.mean([load_error(run, exact) ** 2 for run in runs])))

    return float(np.log(error(coarse) / error(fine)) / np.log(coarse / fine))


@pytest.mark.parametrize(
    "name", ["rk4_skip", "leapfrog", "semi_implicit_euler", "moreau_jean_half", "moreau_jean_one"]
)
def test_without_location_transitions_bring_every_method_down_to_order_1(five_slips: Run, name: str) -> None:
    order = sampled_order(five_slips, name, 5e-8, 5e-9)
    assert order == pytest.approx(1.0, abs=SAMPLED_ORDER_TOLERANCE)


def test_with_located_transitions_rk4_keeps_order_4(five_slips: Run) -> None:
    order = sampled_order(five_slips, "rk4_located", 8e-7, 2e-7)
    assert order == pytest.approx(4.0, abs=SAMPLED_ORDER_TOLERANCE)


def test_creep_in_the_dead_zone_brings_karnopp_down_to_order_one_half(five_slips: Run) -> None:
    order = sampled_order(five_slips, "karnopp", 3e-8, 3e-9)
    assert order == pytest.approx(0.5, abs=SAMPLED_ORDER_TOLERANCE)


@pytest.mark.parametrize("theta", ["-5/6", 0.0, "5/6"])
def test_eq_4_taken_literally_never_sticks_again(theta: float | str) -> None:
    run = literal.solve(Chain.from_slider(theta=theta), 1.0, 1e-6).run
    assert not (run.transitions["mode"] == 0).any()
    assert len(find_slips(run)) == 1


def test_eq_4_taken_literally_creeps_by_the_step_not_by_the_model(chain: Chain) -> None:
    """Blocks tremble about v = 0 by what a step changes v, and creep in proportion to it.

    F_X falls at coarse steps and rises without a slip at fine ones: the limit between them grows as V.
    """

    def limit(speed: float) -> float:
        fast = replace(Chain.from_slider(theta="-5/6"), drive_velocity=speed)
        seconds = 1e-6 / speed

        def falls(step: float) -> bool:
            early, late = literal_load(fast, step, np.array([2 * seconds, 4 * seconds]))
            return late < early

        return bisect(falls, 2e-5 * speed, 2e-3 * speed)

    slow, fast = limit(1e-3), limit(4e-3)
    assert fast / slow == pytest.approx(4.0, rel=CREEP_TOLERANCE)
    # The paper's V: RK4 with a step of 1e-7 s never exceeds the first limit, with 1e-8 s it does.
    assert 1e-8 < slow / 10 < 1e-7
    assert max(literal_load(chain, 1e-7, np.array([0.02, 0.04]))) < chain.strength[0]
    assert max(literal_load(chain, 1e-8, np.array([0.02, 0.04]))) > chain.strength[0]


def test_a_dead_zone_is_too_small_where_blocks_jump_over_it_which_depends_on_the_step(
    five_slips: Run,
) -> None:
    limits = [smallest_dead_zone(five_slips, step) for step in (2e-8, 5e-9)]
    assert max(limits) < karnopp.PART_OF_SAFE_WIDTH
    assert limits[0] == pytest.approx(limits[1], rel=JUMP_TOLERANCE)


def test_a_dead_zone_is_too_large_from_a_width_on_that_no_step_changes(five_slips: Run) -> None:
    limits = [largest_dead_zone(five_slips, step) for step in (1e-8, 5e-9)]
    assert limits[0] == pytest.approx(limits[1], rel=CREEP_TOLERANCE)
    # A part of the speed that block 1 reaches when it slips alone, (mu_s - mu_k) w_1 / sqrt(m (k + K)).
    chain = five_slips.chain
    drop = chain.strength[0] - chain.kinetic_friction[0]
    speed = drop / np.sqrt(chain.mass * (chain.stiffness + chain.drive_stiffness))
    assert 0.01 * speed < limits[0] < 0.1 * speed


@pytest.mark.parametrize("dead_zone", [1e-4, 1e-3, 1e-2])
def test_a_dead_zone_lets_the_load_creep_beyond_the_first_limit(chain: Chain, dead_zone: float) -> None:
    delay = karnopp.release_delay(chain, dead_zone)
    assert first_excess(chain, dead_zone) == pytest.approx(chain.loading_rate * delay, rel=CREEP_TOLERANCE)
