"""Explicit Runge-Kutta methods: one engine, which runs every tableau.

By steps, stick and slip are switched at the end of each step. Located, a step ends
where the first event function becomes zero: on the interpolation of the step it is a
polynomial, whose first root `polynomial_root` finds, also of two that are close
together.

The stages of a short tableau are written out, so that the compiler puts the
coefficients of each into it.
"""

import math
from functools import partial
from typing import Any

import numpy as np

from maegawa2010.methods.columns import FORCE, MODE, SPRING, STRENGTH, VELOCITY
from maegawa2010.methods.common import Method
from maegawa2010.methods.compiled import apart, inner, outer, template
from maegawa2010.methods.equations import by_mode, copy, net_force, rates
from maegawa2010.methods.fixed_step import (
    STEPS_IN_LEG,
    begin_leg,
    feels,
    run_in_steps,
    switch,
)
from maegawa2010.methods.march import fixed_step, march
from maegawa2010.methods.tableaus import DOP853, RK4, Tableau

# A loop over more stages than these keeps compiling short.
WRITTEN_OUT = 5
# Of a step that adapts: caution, exponent of the error and largest growth, as in SciPy;
# the first over tolerance^(1/8).
SAFETY = 0.9
EXPONENT = -1.0 / 8.0
LONGER = 10.0
FIRST_STEP = 3.0
TINY = float(np.finfo(float).tiny)  # so that an error is not 0/0
# Of a root: a step of the search that ends it, and the most there are.
CLOSE = 1e-15
SEARCHES = 200
NEVER = 2.0  # a part of the step beyond its end


def sums_of(tableau: Tableau) -> Any:
    """Sum of shares of the rates k[stage, row, i] in the state of a stage, without
    zeros."""
    shares = tableau.shares
    n_shares = np.count_nonzero(shares, axis=1)
    stages = np.argsort(shares == 0.0, axis=1, kind="stable")
    values = np.take_along_axis(shares, stages, axis=1)

    @inner
    def combine(number, k, row, i):
        total = 0.0
        for j in range(n_shares[number]):
            total += values[number, j] * k[stages[number, j], row, i]
        return total

    return combine


def stage_of(tableau: Tableau, friction: Any = by_mode) -> Any:
    """Rates k[number] of the state of a stage, under a friction law (see
    `equations.rates`)."""
    combine = sums_of(tableau)

    @inner
    def stage(number, system, state, last, h, k):
        behind = state[VELOCITY, 0]
        force = state[FORCE, 1] + h * combine(number, k, FORCE, 1)
        for i in range(1, last + 1):
            force_ahead = state[FORCE, i + 1] + h * combine(number, k, FORCE, i + 1)
            velocity = state[VELOCITY, i] + h * combine(number, k, VELOCITY, i)
            here, k[number, VELOCITY, i] = friction(
                system, state, i, force - force_ahead, velocity
            )
            k[number, FORCE, i] = system[SPRING, i] * (behind - here)
            behind = here
            force = force_ahead
        k[number, FORCE, last + 1] = system[SPRING, last + 1] * behind

    return stage


def in_a_loop(stage: Any, end: int) -> Any:
    """Stages 1..end - 1."""

    @inner
    def stages(system, state, last, h, k):
        for number in range(1, end):
            stage(number, system, state, last, h, k)

    return stages


def written_out(stage: Any, end: int) -> Any:
    """Stages 1..end - 1, with the number of each as a constant."""
    if end == 1:
        return template(lambda _system, _state, _last, _h, _k: None)
    before = written_out(stage, end - 1)

    @template
    def stages(system, state, last, h, k):
        before(system, state, last, h, k)
        stage(end - 1, system, state, last, h, k)

    return stages


def stages_of(tableau: Tableau, end: int, friction: Any = by_mode) -> Any:
    """Rates of the states of stages 1..end - 1."""
    put = in_a_loop if end > WRITTEN_OUT else written_out
    return put(stage_of(tableau, friction), end)


def end_of(tableau: Tableau) -> Any:
    """State at the end of a step."""
    combine = sums_of(tableau)
    s = len(tableau.weights)

    @inner
    def finish(state, last, h, k, end):
        for i in range(1, last + 1):
            end[FORCE, i] = state[FORCE, i] + h * combine(s, k, FORCE, i)
            end[VELOCITY, i] = state[VELOCITY, i] + h * combine(s, k, VELOCITY, i)
        end[FORCE, last + 1] = state[FORCE, last + 1] + h * combine(
            s, k, FORCE, last + 1
        )
        end[VELOCITY, last + 1] = 0.0

    return finish


def step_of(tableau: Tableau, friction: Any = by_mode) -> Any:
    """A whole step of blocks 1..last, whose evaluations it returns."""
    s = len(tableau.weights)
    stages = stages_of(tableau, s, friction)
    finish = end_of(tableau)

    @inner
    def step(system, state, last, h, k):
        rates(friction, system, state, last, state, k[0])
        stages(system, state, last, h, k)
        finish(state, last, h, k, state)
        return s

    return step


# Located transitions


@apart
def polynomial_root(c, limit):
    """First root of c[0] + c[1] x + c[2] x^2 + ... in 0 <= x < limit <= 1, or NEVER;
    c[0] >= 0.

    With |g''| <= M the positive root of g + g' s - M s^2 / 2 is a step that passes no
    root of g.
    """
    lowest = c[0]
    curvature = 0.0
    for n in range(1, c.shape[0]):
        lowest += min(c[n], 0.0)
        curvature += n * (n - 1) * abs(c[n])
    if lowest > 0.0:
        return NEVER
    x = 0.0
    for _ in range(SEARCHES):
        g = 0.0
        slope = 0.0
        for n in range(c.shape[0] - 1, -1, -1):
            slope = slope * x + g
            g = g * x + c[n]
        g = max(g, 0.0)
        root = math.sqrt(slope * slope + 2.0 * curvature * g)
        step = 2.0 * g / (root - slope) if slope < 0.0 else (slope + root) / curvature
        if step <= CLOSE:
            return x
        x += step
        if not x < limit:
            return NEVER
    return x


def error_of(tableau: Tableau) -> Any:
    """Error of a step, where 1 is allowed: the norm of II.10 in Hairer et al.; 0 of a
    fixed step."""
    if not tableau.errors:
        return template(lambda _state, _last, _end, _h, _k, _tolerance: 0.0)
    fifth_order, third_order = tableau.errors
    s = len(fifth_order)

    @inner
    def error(state, last, end, h, k, tolerance):
        fifth = third = TINY
        for row in range(2):
            for i in range(1, last + 2):
                size = max(abs(state[row, i]), abs(end[row, i]))
                scale = tolerance * (1.0 + size)
                a = b = 0.0
                for stage in range(s):
                    a += fifth_order[stage] * k[stage, row, i]
                    b += third_order[stage] * k[stage, row, i]
                fifth += (a / scale) * (a / scale)
                third += (b / scale) * (b / scale)
        n = 2 * (state.shape[1] - 2)
        return h * fifth / math.sqrt((fifth + 0.01 * third) * n)

    return error


def events_of(tableau: Tableau) -> tuple[Any, Any]:
    """The first event within a step, and the state at a part of it, by its
    interpolation."""
    powers = tableau.powers
    degree, n_rates = powers.shape

    @inner
    def event(system, state, i, side, h, k, c):
        """Event function of block i as a polynomial `c` in the part of the step: the
        velocity along the mode, or the margin mu_s w - F on a side."""
        mode = state[MODE, i]
        c[0] = mode * state[VELOCITY, i]
        if mode == 0.0:
            c[0] = system[STRENGTH, i] - side * net_force(state, i)
        for n in range(degree):
            c[n + 1] = 0.0
        for stage in range(n_rates):
            rate = mode * k[stage, VELOCITY, i]
            if mode == 0.0:
                rate = -side * (k[stage, FORCE, i] - k[stage, FORCE, i + 1])
            for n in range(degree):
                c[n + 1] += h * powers[n, stage] * rate

    @inner
    def first_event(system, state, last, h, k, c):
        """Part of a step at which the first block changes its state, and the block."""
        first = 1.0
        block = 0
        for i in range(1, feels(state, last) + 1):
            for side in (1.0, -1.0):
                if side > 0.0 or state[MODE, i] == 0.0:
                    event(system, state, i, side, h, k, c)
                    x = polynomial_root(c, first)
                    if x < first:
                        first = x
                        block = i
        return first, block

    @apart
    def go_to(x, state, last, h, k):
        """Go to the part x of a step."""
        for stage in range(n_rates):
            share = 0.0
            for n in range(degree - 1, -1, -1):
                share = (share + powers[n, stage]) * x
            for row in range(2):
                for i in range(1, last + 2):
                    state[row, i] += h * share * k[stage, row, i]

    return first_event, go_to


def located(tableau: Tableau) -> Any:
    """Run in steps that end where a block changes its state: (motion, setting)."""
    s = len(tableau.weights)
    n_rates = s + 1 + len(tableau.extra)
    evaluations = n_rates - 1
    stages = stages_of(tableau, n_rates)
    finish = end_of(tableau)
    adapts = len(tableau.errors) > 0
    error_of_step = error_of(tableau)
    first_event, go_to = events_of(tableau)
    degree = len(tableau.powers)

    @inner
    def run(motion, setting):
        system = motion.system
        state = motion.state
        progress = motion.progress[0]
        end = state[:2].copy()
        c = np.zeros(degree + 1)
        while begin_leg(motion):
            last = progress.last
            k = np.zeros((n_rates, 2, state.shape[1]))
            rates(by_mode, system, state, last, state, k[0])
            progress.evaluations += 1
            longest = FIRST_STEP * setting**-EXPONENT if adapts else setting
            block = 0
            for _ in range(STEPS_IN_LEG):
                remaining = progress.remaining - progress.elapsed
                h = min(longest, remaining)
                stages(system, state, last, h, k)
                finish(state, last, h, k, end)
                progress.evaluations += evaluations
                if adapts:
                    error = error_of_step(state, last, end, h, k, setting)
                    change = SAFETY * error**EXPONENT
                    if not error < 1.0:
                        longest = h * change
                        continue
                    if h == longest:
                        longest = h * min(change, LONGER)
                x = 1.0
                # Where blocks change without time going on, rounding can decide in a
                # circle: make a whole step.
                if progress.at_once <= state.size:
                    x, block = first_event(system, state, last, h, k, c)
                if block > 0:
                    progress.elapsed += x * h
                    go_to(x, state, last, h, k)
                    break
                progress.elapsed = (
                    progress.remaining if h == remaining else progress.elapsed + h
                )
                copy(end, last, state)
                copy(k[s], last, k[0])
                if h == remaining:
                    break
            switch(motion, block)

    return run


rk4_step = step_of(RK4)
rk4_to_events = located(RK4)
dop853_to_events = located(DOP853)


@outer
def run_rk4(motion, step):
    """Run with a step [s], see `run_in_steps`."""
    work = np.zeros((4, 2, motion.state.shape[1]))
    run_in_steps(motion, step, rk4_step, 0, work)


@outer
def run_rk4_located(motion, step):
    """Run with a step [s] to each event."""
    rk4_to_events(motion, step)


@outer
def run_dop853(motion, tolerance):
    """Run with a tolerance, relative and in N and N/tau (see `columns`), to each
    event."""
    dop853_to_events(motion, tolerance)


SMOOTH = (2.0 * math.sqrt(2.0), RK4.energy_factor)
solve_dop853 = partial(march, run_dop853, scaled=True)
METHODS = (
    fixed_step("rk4", run_rk4, smooth=SMOOTH),
    fixed_step("rk4_located", run_rk4_located),
    Method("dop853", "relative tolerance", solve_dop853),
)
