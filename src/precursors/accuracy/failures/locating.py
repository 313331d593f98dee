"""Transitions that are located wrongly: two roots in one step, a restart on a root, merged transitions."""

from __future__ import annotations

import math
from functools import partial
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from precursors.accuracy.failures.common import Failure, Number, curves, transitions_right
from precursors.analysis.slips import apparent_friction, find_slips
from precursors.methods.events import NUDGE, Motion, march_events
from precursors.methods.scipy_events import TIGHT, next_transition, solve_scipy
from precursors.model.chain import Chain
from precursors.solver.run import Run
from precursors.solver.simulate import TransitionLimitError, simulate

METHOD = "DOP853 with events"
# At these tolerances DOP853 steps over two roots of a velocity; with steps up to SHORT_STEP [s] it does not.
LOOSE = (1e-6, 1e-7, 1e-8)
CHARTED = 1e-7
SHORT_STEP = 1e-6
# Times [s] within which transitions are made at once.
WINDOWS = (1e-7, 3e-7, 1e-6)
CHARTED_WINDOW = 3e-7
RESTART_END = 1.0  # s


def integrate(motion: Motion, start: float, end: float, tolerance: float = TIGHT, dense: bool = False) -> Any:
    """Integrate a motion without transitions between two times since its slip's onset [tau]."""
    return solve_ivp(
        motion.rates,
        (start, end),
        motion.state,
        "DOP853",
        rtol=tolerance,
        atol=tolerance,
        dense_output=dense,
    )


def merging_slip(motion: Motion, window: float) -> None:
    """Go through a slip; what is due within a window [s] after a transition is made at its end."""
    time, sliding = 0.0, True
    while sliding and time < motion.remaining:
        after = min(time + window / motion.tau, motion.remaining)
        motion.state[:] = integrate(motion, time, after).y[:, -1]
        time, event = after, motion.overdue()
        if event < 0:
            time, event = next_transition(motion, time)
        sliding = motion.switch(event, time)


def solve_merging(chain: Chain, duration: float, window: float, until: str | None = None) -> Run:
    """Run a chain whose transitions are made at once where they lie closer than a window [s]."""
    return march_events(Motion(chain, duration, until), partial(merging_slip, window=window)).run


def motion_after(run: Run, number: int) -> Motion:
    """The motion of an exact run from its transition of this number (from 1) on."""
    chain = run.chain
    motion = Motion(chain, run.duration, None)
    modes = np.zeros(chain.n_blocks)
    for _, block, mode, _ in run.transitions[:number].tolist():
        modes[block - 1] = mode
    motion.settings[:] = abs(modes), modes * motion.friction, modes, 1.0 - abs(modes)
    time, block, mode, _ = run.transitions[number - 1].tolist()
    velocities = run.at([time])[1][0] * chain.mass / motion.tau
    velocities[block - 1] = mode * NUDGE
    motion.state[:] = np.concatenate([run.spring_forces([time])[0], velocities])
    motion.n_sliding = int(abs(modes).sum())
    return motion


def missed_roots() -> Failure:
    """DOP853 steps over two roots of a velocity: a block's stop is not seen."""
    chain = Chain.from_slider()
    exact = simulate(chain, 10.0, "global slip")
    solve = partial(solve_scipy, chain, 10.0, until="global slip")
    right = {tolerance: transitions_right(solve(tolerance).run, exact) for tolerance in LOOSE}
    cured = transitions_right(solve(CHARTED, max_step=SHORT_STEP).run, exact)

    # The motion up to three times as long as the true one, from the last right transition on.
    wrong = right[CHARTED]
    column = chain.n_blocks + int(exact.transitions["block"][wrong]) - 1
    motion = motion_after(exact, wrong)
    end = 3.0 * float(exact.intervals[wrong]) / motion.tau
    path = integrate(motion, 0.0, end, dense=True).sol
    steps = integrate(motion, 0.0, end, tolerance=CHARTED)
    times, to_velocity = np.linspace(0.0, end, 301), motion.tau / chain.mass
    velocity = path(times)[column] * to_velocity
    negative = np.flatnonzero(velocity[1:] < 0.0) + 1
    below_zero = float(np.ptp(times[negative]) * motion.tau)

    settings = {f"rtol = {tolerance:.0e}": n for tolerance, n in right.items()}
    settings[f"rtol = {CHARTED:.0e}, max_step = {SHORT_STEP:.0e} s"] = cured
    n = len(exact.transitions)
    return Failure(
        (
            *(Number(METHOD, text, "transitions right", "1", found, n) for text, found in settings.items()),
            Number(METHOD, f"rtol = {CHARTED:.0e}", "time below zero within one step", "s", below_zero),
        ),
        curves(
            "time_s",
            "velocity_m_per_s",
            exact=(times * motion.tau, velocity),
            steps_of_DOP853=(steps.t * motion.tau, steps.y[column] * to_velocity),
        ),
    )


def restart_on_root() -> Failure:
    """A restart exactly on a root: brentq returns it again, and time stands still."""
    chain = Chain.from_slider()
    exact = simulate(chain, RESTART_END).transitions["time"]
    solve = partial(solve_scipy, chain, RESTART_END, 1e-9, direction=0.0)
    try:
        found = solve(nudge=0.0).run.transitions["time"]
    except TransitionLimitError as stuck:
        found = stuck.run.transitions["time"]
    same, cured = int((found == found[0]).sum()), len(solve().run.transitions)
    cure = "start with the sign of the acceleration"
    return Failure(
        (
            Number(METHOD, "start from v = 0", f"transitions at t = {found[0]:g} s", "1", same, 1),
            Number(METHOD, cure, "transitions in 1 s", "1", cured, len(exact)),
        ),
        curves(
            "time_s",
            "transitions",
            exact=(np.concatenate([[0.0], exact, [RESTART_END]]), [*range(len(exact) + 1), len(exact)]),
            restart=(np.append(0.0, found), np.arange(len(found) + 1)),
        ),
    )


def merged_transitions() -> Failure:
    """Transitions that lie closer than a step are made at once."""
    chain = Chain.from_slider()
    exact = simulate(chain, 10.0, "global slip")
    n = len(exact.transitions)
    true = apparent_friction(exact, find_slips(exact))
    assert true
    right, mu_sapp = {}, {}
    for window in WINDOWS:
        run = solve_merging(chain, 10.0, window, "global slip")
        found = apparent_friction(run, find_slips(run))
        right[window] = transitions_right(run, exact)
        mu_sapp[window] = found.mu_sapp if found else math.nan
    close = int((exact.intervals[1:-1] < CHARTED_WINDOW).sum())
    number = partial(Number, "DOP853, transitions merged", f"within {CHARTED_WINDOW:.0e} s")
    return Failure(
        (
            number("transitions merged", "1", close, 0),
            number("transitions right", "1", right[CHARTED_WINDOW], n),
            number("mu_sapp", "1", mu_sapp[CHARTED_WINDOW], true.mu_sapp),
        ),
        curves(
            "window_s",
            "transitions_right",
            exact=(WINDOWS[::2], (n, n)),
            merged=(WINDOWS, list(right.values())),
        ),
    )
