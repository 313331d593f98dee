"""The auditor: it passes what is a motion of the model and finds each kind of falsification."""

import math
from dataclasses import replace
from types import SimpleNamespace

import mpmath
import numpy as np
import pytest
from chains import first_transitions, lone_slip, positions_under

from precursors import Chain, Run, simulate
from precursors.accuracy.audit import audit
from precursors.accuracy.audit.checks import MAX_PROBLEMS, ROUNDINGS, Auditor
from precursors.accuracy.audit.conditions import Conditions
from precursors.accuracy.audit.motion import normal_modes

# The mistake that has to be found: 1e-9 s is a ten-thousandth of the shortest slip.
SHIFT = 1e-9
# Positions that overload some blocks either way [m]
STRAINED = 1e-5 * np.sin(np.arange(10.0))
# What an exact run of the paper's scenes and edges is off by at most, in roundings; `ROUNDINGS` may pass.
FEW_ROUNDINGS = 4.0
# Relative to the energy that is turned over: rounding adds up to 1e-14.
ENERGY_ROUNDING = 1e-13


@pytest.fixture(scope="module")
def uniform() -> Run:
    """Theta = 0 to the end of the first global slip: 216 transitions."""
    return simulate(Chain.from_slider(), until="global slip")


@pytest.fixture(scope="module")
def falling() -> Run:
    """Theta = -5/6 to the end of the first global slip: blocks turn round and slide backward."""
    return simulate(Chain.from_slider(theta="-5/6"), until="global slip")


@pytest.fixture(scope="module")
def strained() -> Run:
    """A start with strained springs: stuck blocks are pulled off backward."""
    return simulate(Chain.from_slider(), duration=1.0, start_positions=STRAINED)


def without(run: Run, *removed: int) -> Run:
    """The run with some of its transitions left out: their intervals join the next one."""
    instant = np.concatenate([[0.0], np.cumsum(run.intervals)])
    intervals = np.delete(run.intervals, removed)
    kept = np.delete(np.arange(len(run.transitions)), removed)
    for k, number in enumerate([*kept, len(run.transitions)]):
        before = kept[k - 1] if k else -1
        if number != before + 1:
            intervals[k] = instant[number + 1] - instant[before + 1]
    return replace(run, transitions=run.transitions[kept], intervals=intervals)


def changed(run: Run, k: int, **values) -> Run:
    transitions = run.transitions.copy()
    for name, value in values.items():
        transitions[name][k] = value
    return replace(run, transitions=transitions)


def shifted(run: Run, k: int, seconds: float) -> Run:
    """The run with one transition, and its recorded time, moved."""
    run = changed(run, k, time=run.transitions["time"][k] + seconds)
    intervals = run.intervals.copy()
    intervals[k : k + 2] += seconds, -seconds
    return replace(run, intervals=intervals)


def next_of_block(run: Run, k: int) -> int:
    """Number of the next transition of the block of transition k."""
    later = np.flatnonzero(run.transitions["block"][k + 1 :] == run.transitions["block"][k])
    return k + 1 + int(later[0])


def old_modes(run: Run) -> np.ndarray:
    """Mode of each transition's block before it."""
    mode, old = np.zeros(run.chain.n_blocks + 1, int), []
    for entry in run.transitions:
        old.append(mode[entry["block"]])
        mode[entry["block"]] = entry["mode"]
    return np.array(old)


def assert_found(run: Run, sentence: str) -> None:
    report = audit(run)
    assert not report.ok
    assert any(sentence in problem for problem in report.problems), str(report)
    with pytest.raises(ArithmeticError, match="no motion"):
        report.raise_if_failed()


@pytest.mark.parametrize("theta", ["-5/6", 0.0, "5/6"])
def test_ten_seconds_of_a_scene_are_a_motion_of_the_model_to_rounding(theta):
    run = simulate(Chain.from_slider(theta=theta), duration=10.0)
    report = audit(run)
    report.raise_if_failed()
    assert report.n_intervals == len(run.transitions) + 1
    assert 0.0 < report.roundings < FEW_ROUNDINGS
    assert report.energy_residual < ENERGY_ROUNDING


SLIDER = Chain.from_slider
EDGES = {
    "one block": (SLIDER(n_blocks=1), {}),
    "two blocks": (SLIDER(n_blocks=2), {}),
    "two hundred blocks": (SLIDER(n_blocks=200), {}),
    "one block with mu_s = mu_k": (SLIDER(n_blocks=1, mu_k=0.7), {}),
    "ten blocks with mu_s = mu_k": (SLIDER(mu_k=0.7), {}),
    "no kinetic friction": (SLIDER(mu_k=0.0), {}),
    "no friction": (SLIDER(mu_s=0.0, mu_k=0.0), {"duration": 1e-3}),
    "weightless first block": (SLIDER(theta=1.0), {}),
    "weightless last block": (SLIDER(theta=-1.0), {}),
    "drive softer by 1e6": (SLIDER(drive_stiffness=25.0), {"duration": 1e5}),
    "drive stiffer by 1e6": (SLIDER(drive_stiffness=25e12), {}),
    "fast drive": (SLIDER(drive_velocity=1.0), {"duration": 0.01}),
    "start velocities": (SLIDER(), {"start_velocities": np.linspace(-0.2, 0.3, 10), "duration": 1.0}),
    "overloaded start": (SLIDER(), {"start_positions": STRAINED, "duration": 1.0}),
}


@pytest.mark.parametrize(("chain", "options"), EDGES.values(), ids=EDGES.keys())
def test_runs_at_the_edges_of_the_model_pass(chain, options):
    run = first_transitions(chain, 300, **options)
    assert len(run.transitions) >= 6
    report = audit(run)
    report.raise_if_failed()
    assert report.roundings < FEW_ROUNDINGS


def test_the_closed_form_of_a_rigid_block_passes():
    chain = SLIDER(n_blocks=1)
    slip, moved = lone_slip(chain)
    limit, at_rest = float(chain.strength[0]), simulate(chain, duration=1e-3)
    onset, rest = limit / chain.loading_rate, 0.1
    end = limit + chain.loading_rate * slip - chain.drive_stiffness * moved
    run = replace(
        at_rest,
        transitions=np.array([(onset, 1, 1, limit), (onset + slip, 1, 0, end)], at_rest.transitions.dtype),
        intervals=np.array([onset, slip, rest]),
        duration=onset + slip + rest,
    )
    report = audit(run)
    report.raise_if_failed()
    assert report.roundings < FEW_ROUNDINGS
    assert report.energy_residual < ENERGY_ROUNDING
    assert_found(shifted(run, 1, SHIFT), "changes its mode while it moves")


def test_modes_keep_their_digits_when_the_drive_is_softer_or_stiffer_by_1e6():
    for drive_stiffness in (25.0, 25e12):
        chain = SLIDER(n_blocks=6, drive_stiffness=drive_stiffness)
        springs = [mpmath.mpf(s) for s in [*chain.springs, 0.0]]
        with mpmath.workdps(50):
            matrix = mpmath.zeros(6)
            for i in range(6):
                matrix[i, i] = springs[i] + springs[i + 1]
                if i < 5:
                    matrix[i, i + 1] = matrix[i + 1, i] = -springs[i + 1]
            squares = mpmath.eigsy(matrix, eigvals_only=True)
            expected = [float(mpmath.sqrt(square / chain.mass)) for square in squares]
        frequencies = np.sort(normal_modes(chain, 0, 5).frequencies)
        np.testing.assert_allclose(frequencies, np.sort(expected), rtol=1e-14)


def test_any_removed_transition_is_found(uniform):
    for k in range(0, len(uniform.transitions), 15):
        assert not audit(without(uniform, k)).ok, k


def test_any_transition_shifted_by_a_nanosecond_is_found(uniform):
    for k in range(0, len(uniform.transitions), 15):
        for seconds in (SHIFT, -SHIFT):
            if uniform.intervals[k + (seconds > 0)] > SHIFT:
                assert not audit(shifted(uniform, k, seconds)).ok, k


def test_a_shifted_release_or_stop_breaks_the_switching_rule(uniform):
    modes = uniform.transitions["mode"]
    release, stop = 0, int(np.flatnonzero(modes == 0)[0])
    assert_found(shifted(uniform, release, SHIFT), "releases to +1 beyond the limit")
    assert_found(shifted(uniform, release, -SHIFT), "releases to +1 below the limit")
    assert_found(shifted(uniform, stop, SHIFT), "slides against its mode")
    assert_found(shifted(uniform, stop, -SHIFT), "changes its mode while it moves")


def test_a_missed_stick_is_found(uniform):
    stick = int(np.flatnonzero(uniform.transitions["mode"] == 0)[4])
    assert_found(without(uniform, stick), "slides against its mode")
    assert_found(without(uniform, stick, next_of_block(uniform, stick)), "slides against its mode")


def test_a_missed_slip_of_one_block_is_found(uniform):
    """A release and the stick that follows, both left out: the motion goes on with the block stuck."""
    old = old_modes(uniform)
    releases = [
        k
        for k in np.flatnonzero(old == 0)[:-12]
        if uniform.transitions["mode"][next_of_block(uniform, k)] == 0 and uniform.transitions["block"][k] > 1
    ]
    for release in releases[::8]:
        block = uniform.transitions["block"][release]
        spoiled = without(uniform, release, next_of_block(uniform, release))
        assert_found(spoiled, f"block {block} is stuck, pushed forward")


def test_a_wrong_mode_is_found(uniform):
    assert_found(changed(uniform, 0, mode=-1), "releases to -1 below the limit")
    stick = int(np.flatnonzero(uniform.transitions["mode"] == 0)[4])
    assert_found(changed(uniform, stick, mode=-1), "turns round without a force beyond mu_s w")
    assert_found(changed(uniform, stick, mode=1), "which it already has")


def test_a_wrong_recorded_load_or_time_is_found(uniform):
    k = 100
    load, time = uniform.transitions["tangential_load"][k], uniform.transitions["time"][k]
    assert_found(changed(uniform, k, tangential_load=load * (1 + 1e-9)), "recorded as tangential load")
    assert_found(changed(uniform, k, tangential_load=np.nan), "has nan N recorded")
    assert_found(changed(uniform, k, time=time + SHIFT), "from the sum of the intervals")


def test_backward_sliding_that_is_forbidden_is_found(falling):
    """A block that turns round is made to stick instead, until it rests in the true run."""
    turn = int(np.flatnonzero((falling.transitions["mode"] == -1) & (old_modes(falling) == 1))[0])
    rest = next_of_block(falling, turn)
    assert falling.transitions["mode"][rest] == 0
    assert_found(without(changed(falling, turn, mode=0), rest), "sticks with a force beyond mu_s w")


def test_a_backward_release_that_is_left_out_is_found(strained):
    backward = (strained.transitions["mode"] == -1) & (old_modes(strained) == 0)
    release = int(np.flatnonzero(backward & (strained.transitions["time"] > 0))[0])
    block = strained.transitions["block"][release]
    spoiled = without(strained, release, next_of_block(strained, release))
    assert_found(spoiled, f"block {block} is stuck, pushed backward")


@pytest.mark.parametrize("factor", [1 + 1e-9, 1 - 1e-9])
def test_kinetic_friction_wrong_by_1e_9_is_found(uniform, factor):
    chain = replace(uniform.chain, mu_k=uniform.chain.mu_k * factor)
    assert_found(replace(uniform, chain=chain), "block 1 ")


def test_a_parameter_wrong_by_1e_8_is_found(uniform):
    for name in ("mass", "stiffness", "drive_stiffness", "drive_velocity", "mu_s"):
        chain = replace(uniform.chain, **{name: getattr(uniform.chain, name) * (1 + 1e-8)})
        assert not audit(replace(uniform, chain=chain)).ok, name


def test_an_extra_release_is_found(uniform):
    """Block 10 is let go in the first stick phase and caught again at once."""
    half = uniform.intervals[0] / 2
    load = uniform.chain.loading_rate * half
    extra = np.array([(half, 10, 1, load), (half, 10, 0, load)], dtype=uniform.transitions.dtype)
    run = replace(
        uniform,
        transitions=np.concatenate([extra, uniform.transitions]),
        intervals=np.concatenate([[half, 0.0, uniform.intervals[0] - half], uniform.intervals[1:]]),
    )
    assert_found(run, "block 10 releases to +1 below the limit")


def test_a_truncated_run_is_found(uniform):
    n = len(uniform.transitions)
    assert_found(without(uniform, *range(n - 6, n)), "slides against its mode")
    resting = int(np.flatnonzero(uniform.intervals > 1e-3)[-1])
    assert_found(without(uniform, *range(resting, n)), "is stuck, pushed forward")
    cut = replace(uniform, transitions=uniform.transitions[:50], intervals=uniform.intervals[:51])
    assert_found(cut, "the duration is recorded")


def test_what_a_block_does_after_the_last_transition_is_checked(uniform):
    extended = uniform.intervals.copy()
    extended[-1] += 5.0
    assert_found(replace(uniform, intervals=extended, duration=uniform.duration + 5.0), "block 1 is stuck")


def test_blocks_that_start_in_motion_or_overloaded_have_to_be_let_go():
    moving = simulate(SLIDER(), duration=0.1, start_velocities=np.r_[np.zeros(9), 0.1])
    assert_found(without(moving, 0), "block 10 starts with 0.1 m/s but is stuck")
    assert_found(changed(moving, 0, mode=-1), "block 10 starts with 0.1 m/s in mode -1")
    overloaded = simulate(SLIDER(), duration=0.1, start_positions=np.r_[np.zeros(9), -2e-6])
    assert_found(without(overloaded, 0), "starts stuck, with a force")


@pytest.mark.parametrize(("dip", "is_motion"), [(1e-6, False), (-1e-6, True)])
def test_a_dip_that_lies_between_all_first_probes_is_found(dip, is_motion):
    """One block without friction: v = V + (u - V) cos(omega t) touches zero at start velocity u = 2 V.

    The dip is sqrt(8 dip) = 0.003 rad wide, a hundredth of the distance of the first probes.
    """
    chain = SLIDER(n_blocks=1, mu_s=0.0, mu_k=0.0)
    omega = math.sqrt(chain.drive_stiffness / chain.mass)
    duration = 7.7 / omega
    start = chain.drive_velocity * (2 + dip)
    run = simulate(chain, duration=1e-9, start_velocities=[start])
    assert run.transitions["mode"].tolist() == [1]
    run = replace(run, intervals=np.array([0.0, duration]), duration=duration)
    report = audit(run)
    assert report.ok == is_motion
    if not is_motion:
        (problem,) = report.problems
        found = float(problem.removesuffix(" m/s").split()[-1])
        assert found == pytest.approx(chain.drive_velocity * dip, rel=0.5)


def test_the_bound_on_fourth_derivatives_holds():
    """From random states: slopes are the derivatives of the values, and none bends more than the bound."""
    chain, generator = SLIDER(n_blocks=7), np.random.default_rng(2010)
    run = simulate(chain, duration=1e-3)
    step = 0.02 / math.sqrt(4 * chain.stiffness / chain.mass)
    seconds = step * np.arange(20_000)
    for _ in range(20):
        state = Auditor(run, ROUNDINGS)
        state.mode[:] = generator.integers(-1, 2, 7)
        state.velocity[:] = np.where(state.mode, generator.normal(size=7), 0.0)
        state.spring_force[:-1] = 100 * generator.normal(size=7)
        force, loading_rate = state.net_force(), chain.loading_rate
        conditions = Conditions(state.motion(), state.mode, force, chain.strength, loading_rate)
        values, slopes = conditions(seconds)
        rounding = 1e-14 * abs(values).max(axis=0)
        fourth = abs(np.diff(values, 4, axis=0) / step**4).max(axis=0)
        assert np.all(fourth <= conditions.fourth + rounding / step**4)
        assert np.any(fourth > 0.3 * conditions.fourth)
        central = (values[2:] - values[:-2]) / (2 * step)
        # the central difference is off by (omega step)^2/6 < 1e-4
        assert np.all(abs(central - slopes[1:-1]) <= 1e-4 * abs(slopes).max(axis=0) + rounding / step)


@pytest.mark.parametrize("radians", [1.0, 2.0, 2 * math.pi])
def test_no_function_is_below_its_bound_in_a_cell(radians):
    """One block swings without friction; over a period its values and slopes at both ends are the same."""
    chain, generator = SLIDER(n_blocks=1, mu_s=0.0, mu_k=0.0), np.random.default_rng(2010)
    omega = math.sqrt(chain.drive_stiffness / chain.mass)
    run = simulate(chain, duration=1e-9, start_velocities=[1.0])
    for phase in [0.0, *generator.uniform(0, 2 * math.pi, 20)]:
        state = Auditor(run, ROUNDINGS)
        state.mode[:], state.velocity[:] = 1, math.cos(phase)
        state.spring_force[0] = -math.sin(phase) * omega * chain.mass
        conditions = Conditions(state.motion(), state.mode, state.net_force(), chain.strength, 0.0)
        edges = np.array([[0.0], [radians / omega]])
        bound = conditions._bound(edges, *(x[:, None] for x in conditions(edges.ravel())))
        lowest = conditions(np.linspace(0.0, radians / omega, 1000))[0].min()
        assert bound <= lowest
        # In a cell of a radian it is close: the remainder is d^4/384, and the cubic is bounded to d^2/12.
        if radians == 1.0:
            assert bound > lowest - (1 / 384 + 1 / 12)


def test_no_cubic_is_below_its_bound_in_a_cell():
    """A cubic is known by its values and slopes at both ends, and has no remainder."""
    cells, width = np.random.default_rng(4).normal(size=(4, 2000)), 0.3
    (low, *_, high), s = cells, np.linspace(0.0, 1.0, 101)[:, None]
    slopes = 3.0 * np.diff(cells, axis=0)[[0, 2]] / width
    edges = np.tile([[0.0], [width]], 2000)
    bound = Conditions._bound(
        SimpleNamespace(fourth=0.0), edges, np.array([low, high])[:, :, None], slopes[:, :, None]
    )
    values = sum(math.comb(3, k) * s**k * (1 - s) ** (3 - k) * cells[k] for k in range(4))
    assert (bound[0, :, 0] <= values.min(axis=0) + 1e-12).all()


def test_energy_that_a_late_stop_destroys_is_found(uniform):
    stop = int(np.flatnonzero(uniform.transitions["mode"] == 0)[0])
    report = audit(shifted(uniform, stop, 100 * SHIFT), roundings=1e12)
    assert report.energy_residual > 1e6 * audit(uniform).energy_residual
    stopped = Auditor(uniform, ROUNDINGS)
    stopped.walk()
    stopped.heat += 1e-9 * stopped.turnover
    stopped.check_energy(0.0)
    assert "out of balance" in stopped.problems[0]


def test_a_caller_sets_the_tolerance_for_an_approximate_run(uniform):
    stop = int(np.flatnonzero(uniform.transitions["mode"] == 0)[0])
    run = shifted(uniform, stop, SHIFT)
    assert not audit(run).ok
    audit(run, roundings=1e12).raise_if_failed()
    with pytest.raises(ValueError, match="roundings"):
        audit(run, roundings=0.0)


def test_a_mistake_of_a_light_block_beside_a_heavy_one_is_found():
    """Block 10 stops a millionth of its slip too late, and block 1 has nearly all the weight of the chain."""
    chain = Chain(np.r_[4e6, np.full(9, 0.04)], 0.0012, 25e6, 0.8e6, 1e-4, 0.7, 0.45)
    run = simulate(chain, duration=1e-3, start_velocities=np.r_[np.zeros(9), 1e-6])
    stop = next_of_block(run, 0)
    assert run.transitions["block"][stop] == 10
    assert audit(run).ok
    assert_found(shifted(run, stop, 1e-6 * run.intervals[stop]), "block 10")


@pytest.mark.parametrize("more", range(10))
def test_positions_far_from_zero_are_known_to_their_rounding(more):
    """Blocks 1 and 4 start at their limits; the soft drive is so far away that rounding moves them beyond."""
    chain = SLIDER(n_blocks=5, drive_stiffness=25.0)
    pushes = 0.1 + 0.01 * more * np.arange(5)
    pushes[[0, 3]] = chain.strength[0], -chain.strength[3]
    run = simulate(chain, duration=0.01, start_positions=positions_under(chain, pushes))
    audit(run).raise_if_failed()
    moved = run.start_positions * np.r_[1.0, 1.0, 1.0 + 1e-11, 1.0, 1.0]
    assert not audit(replace(run, start_positions=moved)).ok


def test_the_work_of_a_stiff_drive_keeps_its_digits():
    """Three blocks swing without friction about a drive that moves on for 1e4 radians of its own spring."""
    chain = SLIDER(n_blocks=3, mu_s=0.0, mu_k=0.0, drive_stiffness=7.5e12, drive_velocity=1e-2)
    duration = 1e4 / math.sqrt(chain.drive_stiffness / chain.mass)
    run = simulate(chain, duration=duration, start_velocities=[1.3e-2, 1e-2, 8e-3])
    report = audit(run)
    report.raise_if_failed()
    assert report.energy_residual < ENERGY_ROUNDING


def test_arrays_that_do_not_fit_are_one_problem_and_no_crash(uniform):
    assert_found(replace(uniform, intervals=uniform.intervals[:-1]), "need 217 intervals")
    assert_found(changed(uniform, 7, block=11), "there is no such block or mode")
    assert_found(changed(uniform, 7, mode=-128), "there is no such block or mode")
    assert_found(replace(uniform, intervals=-uniform.intervals), "an interval is negative")
    assert_found(replace(uniform, start_positions=np.zeros(9)), "start_positions must have one finite value")


def test_the_report_says_what_was_found_in_a_few_lines(uniform):
    assert "is a motion of the model: 217 intervals" in str(audit(uniform))
    spoiled = audit(replace(uniform, chain=replace(uniform.chain, mu_s=0.6)))
    assert len(spoiled.problems) <= MAX_PROBLEMS
    assert str(spoiled).splitlines()[-1] == spoiled.problems[-1]


def test_something_else_than_a_run_is_named():
    with pytest.raises(TypeError, match="what is audited must be a Run, but is Chain"):
        audit(Chain.from_slider())
