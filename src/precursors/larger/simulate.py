"""Run a larger chain, step by step.

Steps are those of the implicit midpoint rule, with springs, dashpots and falling
friction all implicit: one tridiagonal solution over the blocks up to the last that
slides, stable however stiff the dashpots are, and energy is balanced to rounding. A
step ends at the first release or stop in it. A complete rest is one step; nothing is
left out while a block moves.
"""

import math
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from precursors.larger.chain import LargerChain, LargerUntil, tilt
from precursors.larger.friction import chords
from precursors.larger.steps import CompiledChain, End, Motion, march
from precursors.model.chain import Chain, FloatArray
from precursors.model.checks import checked_span, positive, whole
from precursors.solver.run import LargerRun
from precursors.solver.simulate import (
    MAX_TRANSITIONS,
    TransitionLimitError,
    checked_start,
)
from precursors.support.waiting import in_threads

# Of the shorter of sqrt(m/k) and the time in which falling friction, less viscosity,
# multiplies a velocity by e. With friction that jumps, the second gives all transitions
# of the paper's scenes up to the first global slip, in order.
STEP = 0.1
STEP_OF_COULOMB = 5e-4
MAX_STEPS = 1_000_000_000  # of a run of a study, minutes; ten seconds need some 1e8


def simulate_larger(
    larger: LargerChain,
    duration: float,
    until: LargerUntil = None,
    step: float | None = None,
    max_transitions: int | None = None,
    start_forces: ArrayLike | None = None,
    max_steps: int = MAX_STEPS,
) -> LargerRun:
    """Run a larger chain from rest; other arguments are those of `simulate`.

    Transitions are those of blocks that slide faster than `SLOW` v_c, without events in
    which F_X falls by less than `SMALLEST_DROP` F_Z. The run has `load_points`, and in
    `larger` the numbers of the chain, the step, and `energy_error`: the energy that the
    balance lacks, over the work of the drive.

    `until` may be "settled", too: the run ends when the loads at which global slips
    begin come again (see `period_of`). `step` is in the shorter of sqrt(m/k) and the
    time in which creep that runs away grows by e, by default `STEP` or
    `STEP_OF_COULOMB`. `start_forces` are those of the springs [N], F_X first, by
    default 0.

    Raises
    ------
    ValueError
        If an argument is out of range, or a normal load becomes negative.
    TransitionLimitError
        If there are more transitions or steps than the limits; `run` is what was
        computed.
    """
    duration = checked_span(duration, until, "settled")
    most = MAX_TRANSITIONS if max_transitions is None else max_transitions
    limits = (whole("max_transitions", most), whole("max_steps", max_steps))
    chain = larger.chain
    m = model_of(larger)
    if step is None:
        step = STEP if m.weakening_velocity else STEP_OF_COULOMB
    step = positive("step", step, "sqrt(m/k)")
    lifting = np.divide(
        -m.weights, m.tilt, np.full(chain.n_blocks, np.inf), where=m.tilt < 0.0
    )
    modes = np.zeros((2, chain.n_blocks + 1), np.int64)
    arrays: list[Any] = [*np.zeros((7, chain.n_blocks + 1)), *modes, np.zeros(2)]
    state = Motion(*arrays)
    state.force[:-1] = checked_start("start_forces", start_forces, "N", chain)
    before = stored_energy(chain, state)
    ends_at = (until == "global slip", until == "settled")
    end = End(duration, *ends_at, lifting.min(), *limits)
    steps_of = longest_steps(m, chain, step)
    ((rows, points, time, steps),) = in_threads(
        [partial(march, m, state, end, steps_of)]
    )
    if state.force[0] > lifting.min():
        raise ValueError(
            f"push_height = {larger.push_height:g} m lifts block {lifting.argmin() + 1} "
            f"at F_X = {lifting.min():.4g} N"
        )
    rows = rows[np.argsort(rows[:, 0], kind="stable")]
    work, heat = state.energy
    lacking = work - heat - (stored_energy(chain, state) - before)
    found = {"step": step, "energy_error": lacking / work if work else 0.0}
    run = LargerRun.from_columns(
        chain, time, *rows.T, numbers=larger.numbers | found, load_points=points
    )
    if len(rows) > most or steps > max_steps:
        raise TransitionLimitError(
            "the larger chain met its limit of work at "
            f"t = {time:.9g} s of {duration:g} s: shorten duration",
            run,
        )
    return run


def model_of(larger: LargerChain) -> CompiledChain:
    """Arrays and numbers of a chain for the compiled functions."""
    chain = larger.chain
    dashpots = np.zeros(chain.n_blocks + 1)
    dashpots[1:-1] = larger.viscosity + larger.relaxation_time * chain.stiffness
    return CompiledChain(
        springs=np.append(chain.springs, 0.0),
        dashpots=dashpots,
        weights=chain.weights.copy(),
        tilt=tilt(chain, larger.push_height),
        mass=chain.mass,
        mu_s=chain.mu_s,
        weakening_velocity=larger.law.weakening_velocity * (chain.mu_k < chain.mu_s),
        **chords(larger.law, chain.mu_s, chain.mu_k)._asdict(),
        drive_velocity=chain.drive_velocity,
        bears_load=chain.bears_load,
    )


def longest_steps(m: CompiledChain, chain: Chain, step: float) -> FloatArray:
    """Steps [s] while nothing slides ahead of block 1..N; `step` is that of
    `simulate_larger`.

    The growth rate is that of falling friction, less the viscosity of the gravest mode
    of the stretch: a quarter of a wave, or even if the whole chain slides.
    """
    n = chain.n_blocks
    largest = m.weights + abs(m.tilt) * m.mu_s * chain.normal_load
    fall = m.fall.max() * np.maximum.accumulate(largest)
    shape = (2.0 * np.sin(0.5 * math.pi / (2.0 * np.arange(1, n + 1) + 1.0))) ** 2
    shape[-1] = 0.0
    growth = np.maximum(fall - m.dashpots.max() * shape, 0.0) / m.mass
    return step / np.maximum(chain.fastest_frequency_bound / 2.0, growth)


def stored_energy(chain: Chain, state: Motion) -> float:
    """Energy of springs and of motion [J]."""
    elastic = (state.force[:-1] ** 2 / chain.springs).sum() / 2.0
    return float(elastic + chain.mass * (state.velocity[:-1] ** 2).sum() / 2.0)
