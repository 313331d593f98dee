"""The audit accepts motions of the model and detects each kind of mistake."""

import copy
import math
import re
import sys
from collections.abc import Iterator
from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from chains import SLIDER, first_transitions, positions_under

from precursors import Run, simulate
from precursors.audit import audit, carried, conditions, motion
from precursors.audit.checks import MAX_PROBLEMS, Auditor
from precursors.model.chain import remember_theta

# Largest deviation of an exact run of the paper's scenes, in roundings; the audit
# allows 16.
FEW_ROUNDINGS = 4.0
# A mistake in a time that the audit must report: a ten-thousandth of the shortest slip [s].
SHIFT = 1e-9
# Positions that overload some blocks either way [m]
STRAINED = 1e-5 * np.sin(np.arange(10.0))


@pytest.fixture(scope="module")
def uniform() -> Run:
    """Theta = 0 to the end of the first global slip: 216 transitions."""
    return simulate(SLIDER(), until="global slip")


@pytest.mark.parametrize(
    "chain", [SLIDER(theta="-5/6"), SLIDER(theta="5/6"), SLIDER(200)], ids=str
)
def test_exact_run_passes_the_audit_within_a_few_roundings(chain):
    run = first_transitions(chain, 300)
    report = audit(run)
    report.raise_if_failed()
    assert report.n_intervals == len(run.transitions) + 1
    assert 0.0 < report.roundings < FEW_ROUNDINGS


@pytest.mark.parametrize(("dip", "is_motion"), [(1e-6, False), (-1e-6, True)])
def test_audit_detects_a_dip_between_its_first_probes(dip, is_motion):
    """One block without friction: v = V + (u - V) cos(omega t) touches zero at start
    velocity u = 2 V.

    The dip is sqrt(8 dip) = 0.003 rad wide, a hundredth of the distance of the first
    probes.
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
        depth = float(problem.removesuffix(" m/s").split()[-1])
        assert depth == pytest.approx(chain.drive_velocity * dip, rel=0.5)


def test_bound_on_fourth_derivatives_holds(monkeypatch):
    """From random states, slopes are also the derivatives of the values."""
    for module in (carried, conditions, motion):  # compiling them takes longer
        for name, function in vars(module).copy().items():
            if hasattr(function, "py_func"):
                monkeypatch.setattr(module, name, function.py_func)
    chain = SLIDER(n_blocks=7)
    generator = np.random.default_rng(2010)
    run = simulate(chain, duration=1e-3)
    step = 0.02 / math.sqrt(4 * chain.stiffness / chain.mass)
    seconds = step * np.arange(500)
    modal = np.empty((3, 7))
    for _ in range(3):
        state = carried.start_of(run)
        state.mode[:] = generator.integers(-1, 2, 7)
        state.velocity[:] = np.where(state.mode, generator.normal(size=7), 0.0)
        state.spring_force[:-1] = 100 * generator.normal(size=7)
        modes_of_row = partial(motion.normal_modes, chain)
        rows, modes = motion.rows_and_modes(state.moves(), modes_of_row)
        of_modes = carried.motion_of(state, rows, modes)
        of_blocks = conditions.concerned(state, rows)
        of = conditions.conditions_of(of_modes, state, rows, modes, *of_blocks)
        pairs = []
        for s in seconds:
            conditions.take_modes(of_modes, s, modal)
            columns = range(len(of.fourth))
            pairs.append([conditions.value_and_slope(of, c, s, modal) for c in columns])
        values, slopes = np.moveaxis(pairs, 2, 0)
        rounding = 1e-14 * abs(values).max(axis=0)
        fourth = abs(np.diff(values, 4, axis=0) / step**4).max(axis=0)
        assert np.all(fourth <= of.fourth + rounding / step**4)
        assert np.any(fourth > 0.3 * of.fourth)
        central = (values[2:] - values[:-2]) / (2 * step)
        # the central difference is off by (omega step)^2/6 < 1e-4
        assert np.all(
            abs(central - slopes[1:-1])
            <= 1e-4 * abs(slopes).max(axis=0) + rounding / step
        )


def test_lower_bound_of_a_cell_holds_and_is_sharp():
    """The bound is sharp for a cubic with given values and slopes at both ends, less M
    s^2 (d - s)^2 / 24."""
    cells = np.random.default_rng(4).normal(size=(4, 2000))
    cells[:, 0] = 0.0
    width = 0.3
    fourth = 1e4
    s = np.linspace(0.0, 1.0, 101)[:, None]
    rise, _, fall = 3.0 * np.diff(cells, axis=0) / width
    of_cells = np.vectorize(conditions.lower_bound.py_func)
    bound = of_cells(width, cells[0], cells[3], rise, fall, fourth)
    cubics = sum(
        math.comb(3, k) * s**k * (1 - s) ** (3 - k) * cells[k] for k in range(4)
    )
    least = (cubics - fourth * width**4 / 24 * (s * (1 - s)) ** 2).min(axis=0)
    assert (bound <= least + 1e-12).all()
    assert bound[0] == pytest.approx(least[0], rel=1e-12)
    of_cubics = of_cells(width, cells[0], cells[3], rise, fall, 0.0)
    assert of_cubics == pytest.approx(cells.min(axis=0), abs=1e-12)


def test_audit_that_takes_too_much_work_reports_where_it_ends(uniform, monkeypatch):
    """With a soft drive, a slide is long compared with the fastest mode and takes many
    cells."""
    monkeypatch.setattr(sys.modules[Auditor.__module__], "MAX_VALUES", 20_000)
    audit(simulate(uniform.chain, 0.35 + 1e-3)).raise_if_failed()
    report = audit(simulate(replace(uniform.chain, drive_stiffness=1.0), 5e6))
    (problem,) = report.problems
    assert "the audit ends here: it cannot check " in problem
    assert report.is_undecided
    assert str(report).startswith("It is undecided whether the run is a motion")
    assert report.n_intervals < 100


def without(run: Run, *removed: int) -> Run:
    """Remove transitions from a run and add their intervals to the next one."""
    instant = np.concatenate([[0.0], np.cumsum(run.intervals)])
    intervals = np.delete(run.intervals, removed)
    remaining = np.delete(np.arange(len(run.transitions)), removed)
    for k, number in enumerate([*remaining, len(run.transitions)]):
        before = remaining[k - 1] if k else -1
        if number != before + 1:
            intervals[k] = instant[number + 1] - instant[before + 1]
    return replace(run, transitions=run.transitions[remaining], intervals=intervals)


def changed(run: Run, k: int, **values) -> Run:
    transitions = run.transitions.copy()
    for name, value in values.items():
        transitions[name][k] = value
    return replace(run, transitions=transitions)


def shifted(run: Run, k: int, seconds: float) -> Run:
    """Move one transition of a run and its recorded time."""
    run = changed(run, k, time=run.transitions["time"][k] + seconds)
    intervals = run.intervals.copy()
    intervals[k : k + 2] += seconds, -seconds
    return replace(run, intervals=intervals)


def next_of_block(run: Run, k: int) -> int:
    """Return the number of the next transition of the same block."""
    block = run.transitions["block"]
    return k + 1 + int(np.argmax(block[k + 1 :] == block[k]))


def falsified(uniform: Run) -> Iterator[tuple[Run, str]]:
    """Yield runs with one mistake each, and the first problem that the audit reports."""
    stop, stick = np.flatnonzero(uniform.transitions["mode"] == 0)[[0, 4]]
    yield shifted(uniform, 0, SHIFT), "block 1 is stuck, pushed forward beyond mu_s w"
    yield shifted(uniform, stop, SHIFT), r"block 1 slides against its mode \+1"
    yield without(uniform, stick), r"block 1 slides against its mode \+1"
    yield changed(uniform, 0, mode=-1), "block 1 is released to -1 below the limit"
    yield changed(uniform, stick, mode=-1), "block 2 turns round without a force beyond"
    yield changed(uniform, stick, mode=1), r"block 2 changes to mode \+1, which it alr"
    yield changed(uniform, 9, tangential_load=np.nan), "block . has nan N recorded"
    yield changed(uniform, 0, time=0.35 + SHIFT), "of block 1 is recorded 1e-09 s from"
    yield replace(uniform, duration=4.0), "the duration is recorded 1.26 s from"
    for name, factor, words in (
        ("mass", 1 + 1e-8, "block 1 changes its mode while it moves at"),
        ("mu_s", 1 + 1e-8, "block 1 is released to .1 below the limit"),
        ("mu_k", 1 - 1e-9, "block 1 has .* recorded as tangential load"),
    ):
        other = {name: factor * getattr(uniform.chain, name)}
        yield replace(uniform, chain=replace(uniform.chain, **other)), words
    falling = simulate(SLIDER(theta="-5/6"), until="global slip")
    turn = int(np.argmax(falling.transitions["mode"] == -1))
    yield (
        without(changed(falling, turn, mode=0), next_of_block(falling, turn)),
        "block 10 sticks with a force beyond mu_s w",
    )
    strained = simulate(SLIDER(), 1.0, start_positions=STRAINED)
    release = 21  # of block 9, backward
    yield shifted(strained, release, SHIFT), "block 9 is stuck, pushed backward beyond"
    backward_slip = release, next_of_block(strained, release)
    yield without(strained, *backward_slip), "block 10 slides against its mode -1"
    moving = simulate(SLIDER(), 0.1, start_velocities=np.r_[np.zeros(9), 0.1])
    yield without(moving, 0), "block 10 starts with 0.1 m/s but is stuck"
    yield changed(moving, 0, mode=-1), "block 10 starts with 0.1 m/s in mode -1"
    overloaded = simulate(SLIDER(), 0.1, start_positions=np.r_[np.zeros(9), -2e-6])
    yield without(overloaded, 0), "block 9 starts stuck beyond mu_s w"
    yield changed(overloaded, 0, block=3), "block 3 is released to -1 below the limit"
    weightless = simulate(SLIDER(theta=-1), 1.0)
    yield changed(weightless, 0, block=10), "block 10 bears no load"
    yield from falsified_states(uniform)
    yield (
        replace(uniform, chain=remember_theta(copy.copy(uniform.chain), 0.5)),
        "theta = 0.5 is not that of the weights",
    )


def falsified_states(run: Run) -> Iterator[tuple[Run, str]]:
    """Yield runs with one mistake each in the stored states, from which `at` starts."""
    states = run.states
    for name, words in [
        ("force", "state 1 has a force of block . that is wrong by .* N"),
        ("velocity", "state . has a velocity of block . that is wrong by .* m/s"),
        ("mode", "state 0 has modes that differ from those of the blocks"),
        ("after", "the first stored state is not that of the start"),
        ("offset", "the first stored state is not that of the start"),
    ]:
        values = getattr(states, name)
        others = 1.01 * values if name in ("force", "velocity") else values + 1
        yield replace(run, states=states._replace(**{name: others})), words
    swapped = states.after.copy()
    swapped[3:5] = swapped[[4, 3]]
    yield replace(run, states=states._replace(after=swapped)), "stored state 4, 0 s aft"
    late = states.offset.copy()
    late[3] = 1.0
    yield replace(run, states=states._replace(offset=late)), "stored state 3, 1 s after"
    single = states._replace(force=states.force.astype("f4"))
    yield replace(run, states=single), "force is of type float32 and not float64"


def test_audit_names_each_kind_of_mistake(uniform):
    for run, words in falsified(uniform):
        assert re.search(words, audit(run).problems[0])


def test_audit_allows_16_roundings_of_load_and_1e_12_of_time():
    run = simulate(SLIDER(), 1.0)
    time, load = run.transitions[["time", "tangential_load"]][5]
    wrong = audit(changed(run, 5, tangential_load=load + 1e-3), roundings=1e20)
    one = 1e-3 / wrong.roundings
    for roundings in (15, 17):
        for mistake in (
            {"tangential_load": load + roundings * one},
            {"time": time + roundings / 16 * 1e-12 * run.duration},
        ):
            assert audit(changed(run, 5, **mistake)).ok == (roundings < 16)


def test_tolerance_can_be_set_for_an_approximate_run(uniform):
    run = shifted(uniform, 0, SHIFT)
    with pytest.raises(ArithmeticError, match="no motion"):
        audit(run).raise_if_failed()
    audit(run, roundings=1e12).raise_if_failed()
    with pytest.raises(ValueError, match="roundings"):
        audit(run, roundings=0.0)


def test_positions_far_from_zero_are_judged_by_their_rounding():
    """Blocks 1 and 4 start at their limits. The soft drive is so far away that rounding
    pushes them beyond."""
    chain = SLIDER(n_blocks=5, drive_stiffness=25.0)
    pushes = 0.1 + 0.01 * np.arange(5)
    pushes[[0, 3]] = chain.strength[[0, 3]] * [1, -1]
    run = simulate(chain, duration=0.01, start_positions=positions_under(chain, pushes))
    audit(run).raise_if_failed()
    moved = run.start_positions * np.r_[1.0, 1.0, 1.0 + 1e-11, 1.0, 1.0]
    assert not audit(replace(run, start_positions=moved)).ok


def test_arrays_that_do_not_fit_are_one_problem_and_no_crash(uniform):
    short = replace(uniform, intervals=uniform.intervals[:-1])
    (problem,) = audit(short).problems
    assert "216 transitions need 217 intervals" in problem
    (problem,) = audit(changed(uniform, 7, block=11)).problems
    assert "transition 7 has block 11, mode 1: there is no such" in problem


def test_report_is_a_few_lines_and_refuses_a_chain(uniform):
    assert "is a motion of the model: 217 intervals" in str(audit(uniform))
    spoiled = audit(replace(uniform, chain=replace(uniform.chain, mu_s=0.6)))
    assert len(spoiled.problems) <= MAX_PROBLEMS
    assert str(spoiled).splitlines()[-1] == spoiled.problems[-1]
    with pytest.raises(TypeError, match="audit needs a Run, but got Chain"):
        audit(uniform.chain)
