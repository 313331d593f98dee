"""Transitions that are located wrongly: two roots in one step, a restart on a root, merged transitions."""

from __future__ import annotations

import math
from functools import partial
from typing import Any

import numpy as np
from scipy.integrate import DOP853, solve_ivp
from scipy.optimize import brentq

from precursors.accuracy.failures.common import Failure, Number, curves, transitions_right
from precursors.analysis.slips import apparent_friction, find_slips
from precursors.methods.events import MODE, NUDGE, Motion, march_events, rates
from precursors.methods.scipy_events import solve_scipy
from precursors.model.chain import Chain, FloatArray
from precursors.solver.run import Run
from precursors.solver.simulate import TransitionLimitError, simulate

TIGHT = 1e-10
PROBES = 9
# In tau: below the rounding of a slip's time.
XTOL = 1e-14
# At these tolerances DOP853 steps over two roots of a velocity; with steps up to SHORT_STEP [s] it does not.
LOOSE = (1e-6, 1e-7, 1e-8)
CHARTED = 1e-7
SHORT_STEP = 1e-6
# Times [s] within which transitions are made at once.
WINDOWS = (1e-7, 3e-7, 1e-6)
CHARTED_WINDOW = 3e-7
RESTART_END = 1.0


def right_hand_side(motion: Motion, _time: float, state: FloatArray) -> FloatArray:
    """Equations of motion (Eqs. 2-6) as `events.rates`."""
    result = np.empty_like(state)
    rates(state, motion.settings, motion.coupling, motion.drive_velocity, result)
    return result


def integrate(motion: Motion, start: float, end: float, tolerance: float = TIGHT, dense: bool = False) -> Any:
    """Integrate a motion without transitions between two times since its slip's onset [tau]."""
    return solve_ivp(
        partial(right_hand_side, motion),
        (start, end),
        motion.state,
        "DOP853",
        rtol=tolerance,
        atol=tolerance,
        dense_output=dense,
    )


def gauges(motion: Motion, states: FloatArray, forward_only: bool = False) -> FloatArray:
    """Event functions of `events` in states of shape (2 N, n); what cannot happen is 1.

    Without backward sliding no block lets go backward.
    """
    n = motion.chain.n_blocks
    tension, velocity = states[:n], states[n:]
    net = tension - np.vstack([tension[1:], np.zeros(tension.shape[1])])
    mode, strength = motion.settings[MODE][:, None], motion.strength[:, None]
    result = np.ones_like(states)
    result[::2] = np.where(mode != 0.0, mode * velocity, strength - net)
    result[1::2] = np.where((mode != 0.0) | forward_only, 1.0, strength + net)
    return result


def overdue(motion: Motion, forward_only: bool = False) -> int:
    """An event whose function is below zero, or -1."""
    late = np.flatnonzero(gauges(motion, motion.state[:, None], forward_only) < 0.0)
    return int(late[0]) if late.size else -1


def next_root(motion: Motion, time: float, forward_only: bool = False) -> tuple[float, int]:
    """Go on to the next transition: when it is [tau] and its event, or -1 at the end of the run.

    Looked for at `PROBES` points of each step of DOP853, so that two roots in one step are not missed.
    """
    stepper = DOP853(
        partial(right_hand_side, motion), time, motion.state, motion.remaining, rtol=TIGHT, atol=TIGHT
    )
    while stepper.status == "running":
        stepper.step()
        path = stepper.dense_output()
        times = np.linspace(stepper.t_old, stepper.t, PROBES)
        below = gauges(motion, path(times), forward_only)[:, 1:] < 0.0
        if not below.any():
            continue
        probe = int(np.argmax(below.any(axis=0)))

        def gauge(when: float, event: int, path=path) -> float:
            return float(gauges(motion, path(when)[:, None], forward_only)[event, 0])

        bracket = float(times[probe]), float(times[probe + 1])
        roots = [
            (brentq(gauge, *bracket, args=(i,), xtol=XTOL), int(i)) for i in np.flatnonzero(below[:, probe])
        ]
        root, event = min(roots)
        motion.state[:] = path(root)
        return root, event
    motion.state[:] = stepper.y
    return float(stepper.t), -1


def merging_slip(motion: Motion, window: float) -> None:
    """Go through a slip; what is due within a window [s] after a transition is made at its end."""
    time, sliding = 0.0, True
    while sliding and time < motion.remaining:
        after = min(time + window / motion.tau, motion.remaining)
        motion.state[:] = integrate(motion, time, after).y[:, -1]
        time, event = after, overdue(motion)
        if event < 0:
            time, event = next_root(motion, time)
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
    n = len(exact.transitions)
    solve = partial(solve_scipy, chain, 10.0, until="global slip")
    right = {tolerance: transitions_right(solve(tolerance).run, exact) for tolerance in LOOSE}
    cured = transitions_right(solve(CHARTED, max_step=SHORT_STEP).run, exact)
    wrong = right[CHARTED]
    block = int(exact.transitions["block"][wrong])
    motion = motion_after(exact, wrong)
    end = 3.0 * float(exact.intervals[wrong]) / motion.tau
    path = integrate(motion, 0.0, end, dense=True).sol
    to_velocity = motion.tau / chain.mass
    times = np.linspace(0.0, end, 301)
    velocity = path(times)[chain.n_blocks + block - 1] * to_velocity
    steps = integrate(motion, 0.0, end, tolerance=CHARTED)
    negative = np.flatnonzero(velocity[1:] < 0.0) + 1
    method, unit = "DOP853 with events", "1"
    return Failure(
        (
            *(
                Number(method, f"rtol = {tolerance:.0e}", "transitions right", unit, right[tolerance], n)
                for tolerance in LOOSE
            ),
            Number(
                method, f"rtol = {CHARTED:.0e}, max_step = {SHORT_STEP:.0e} s", "transitions right", unit,
                cured, n,
            ),
            Number(
                method, f"rtol = {CHARTED:.0e}", "time below zero within one step", "s",
                float(np.ptp(times[negative]) * motion.tau),
            ),
        ),
        curves(
            "time_s",
            "velocity_m_per_s",
            exact=(times * motion.tau, velocity),
            steps_of_DOP853=(steps.t * motion.tau, steps.y[chain.n_blocks + block - 1] * to_velocity),
        ),
    )  # fmt: skip


def restart_on_root() -> Failure:
    """A restart exactly on a root: brentq returns it again, and time stands still."""
    chain = Chain.from_slider()
    exact = simulate(chain, RESTART_END).transitions["time"]
    try:
        found = solve_scipy(chain, RESTART_END, 1e-9, nudge=0.0, direction=0.0).run.transitions["time"]
    except TransitionLimitError as stuck:
        found = stuck.run.transitions["time"]
    cured = solve_scipy(chain, RESTART_END, 1e-9, direction=0.0).run.transitions["time"]
    same = int((found == found[0]).sum())
    method = "DOP853 with events"
    return Failure(
        (
            Number(method, "start from v = 0", f"transitions at t = {found[0]:g} s", "1", same, 1),
            Number(
                method, "start with the sign of the acceleration", "transitions in 1 s", "1",
                len(cured), len(exact),
            ),
        ),
        curves(
            "time_s",
            "transitions",
            exact=(np.concatenate([[0.0], exact, [RESTART_END]]), [*range(len(exact) + 1), len(exact)]),
            restart=(np.append(0.0, found), np.arange(len(found) + 1)),
        ),
    )  # fmt: skip


def merged_transitions() -> Failure:
    """Transitions that lie closer than a step are made at once."""
    chain = Chain.from_slider()
    exact = simulate(chain, 10.0, "global slip")
    true = apparent_friction(exact, find_slips(exact))
    assert true is not None
    right, mu_sapp = [], []
    for window in WINDOWS:
        run = solve_merging(chain, 10.0, window, "global slip")
        found = apparent_friction(run, find_slips(run))
        right.append(transitions_right(run, exact))
        mu_sapp.append(found.mu_sapp if found else math.nan)
    charted = WINDOWS.index(CHARTED_WINDOW)
    close = int((exact.intervals[1:-1] < CHARTED_WINDOW).sum())
    method, knob = "DOP853, transitions merged", f"within {CHARTED_WINDOW:.0e} s"
    return Failure(
        (
            Number(method, knob, "transitions merged", "1", close, 0),
            Number(method, knob, "transitions right", "1", right[charted], len(exact.transitions)),
            Number(method, knob, "mu_sapp", "1", mu_sapp[charted], true.mu_sapp),
        ),
        curves(
            "window_s",
            "transitions_right",
            exact=((WINDOWS[0], WINDOWS[-1]), 2 * (len(exact.transitions),)),
            merged=(WINDOWS, right),
        ),
    )
