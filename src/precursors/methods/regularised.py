"""Regularised friction: a steep tanh in place of the jump at zero velocity, and a
Stribeck drop to mu_k.

The friction coefficient at velocity v is

    mu(v) = tanh(v / width) (mu_k + (mu_s - mu_k) exp(-(v / (STRIBECK width))^2)),

smooth, so that an integrator for stiff equations runs through without events. Nothing
ever sticks: a block under a constant load F < mu_s w creeps at `creep_velocity`, and
the equations are as stiff as mu_s w / (m width). A block counts as sliding while its
speed is above that of largest friction, from where friction falls with speed.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.integrate import Radau
from scipy.optimize import brentq

from precursors.methods.columns import SPRING, VELOCITY, at_rest, set_modes, time_unit
from precursors.methods.common import Method, Result
from precursors.methods.events import jacobian_of
from precursors.model.chain import Chain, FloatArray
from precursors.model.checks import checked_span, positive
from precursors.solver.run import Record

# The drop begins where tanh has all but reached 1, so that friction at its largest is
# mu_s to 1e-3.
STRIBECK = 100.0
# At widths up to 1e-7 m/s the times come out the same to 1e-4 s at 1e-5 and at 1e-8:
# the width decides.
TOLERANCE = 1e-6


def friction_coefficient(
    velocity: FloatArray, width: float, mu_s: float, mu_k: float
) -> FloatArray:
    """mu(v) of velocities [m/s] for a width [m/s]."""
    z = velocity / width
    return np.tanh(z) * (mu_k + (mu_s - mu_k) * np.exp(-((z / STRIBECK) ** 2)))


def friction_slope(velocity: Any, width: float, mu_s: float, mu_k: float) -> Any:
    """d mu / dv [s/m]."""
    z = velocity / width
    tanh = np.tanh(z)
    drop = (mu_s - mu_k) * np.exp(-((z / STRIBECK) ** 2))
    return (
        (1.0 - tanh**2) * (mu_k + drop) - tanh * drop * 2.0 * z / STRIBECK**2
    ) / width


def creep_velocity(load: float, weight: float, width: float, mu_s: float) -> float:
    """Velocity [m/s] at which a block held by friction creeps under a load F [N]: width
    atanh(F / mu_s w).

    The Stribeck drop is left out: at the load r mu_s w it changes the velocity by a
    part of about (1 - mu_k / mu_s) (atanh(r) / STRIBECK)^2 r / ((1 - r^2) atanh(r)).
    """
    return width * math.atanh(load / (mu_s * weight))


def peak_velocity(width: float, mu_s: float, mu_k: float) -> float:
    """Velocity [m/s] of largest friction: slower blocks creep, faster ones slide."""
    return width * brentq(friction_slope, 1.0, STRIBECK, (1.0, mu_s, mu_k))


def equations(
    chain: Chain, width: float
) -> tuple[
    Callable[[float, FloatArray], FloatArray], Callable[[float, FloatArray], FloatArray]
]:
    """Right-hand side and Jacobian for the state y of `events`, friction being a
    function of velocity."""
    n = chain.n_blocks
    law = (width * chain.mass / time_unit(chain), chain.mu_s, chain.mu_k)
    system, state = at_rest(chain, scaled=True)
    set_modes(system, state, 1.0)
    linear = jacobian_of(system, state)
    drive = np.zeros(2 * n)
    drive[0] = system[SPRING, 1] * state[VELOCITY, 0]
    i = np.arange(n, 2 * n)

    def right_hand_side(_time: float, state: FloatArray) -> FloatArray:
        result = linear @ state + drive
        result[n:] -= chain.weights * friction_coefficient(state[n:], *law)
        return result

    def matrix(_time: float, state: FloatArray) -> FloatArray:
        result = linear.copy()
        result[i, i] = -chain.weights * friction_slope(state[n:], *law)
        return result

    return right_hand_side, matrix


def solve_regularised(
    chain: Chain, duration: float, width: float, until: str | None = None
) -> Result:
    """Run a chain with friction that turns over within a width [m/s], by SciPy's Radau.

    rtol is `TOLERANCE`, and atol the same number in N and N/tau (see `events`), but at
    most a hundredth of the width.

    Raises
    ------
    RuntimeError
        If SciPy reports a failure.
    """
    duration = checked_span(duration, until)
    positive("width", width, "m/s")
    n = chain.n_blocks
    tau = time_unit(chain)
    velocity_unit = chain.mass / time_unit(chain)
    right_hand_side, matrix = equations(chain, width)
    threshold = peak_velocity(width, chain.mu_s, chain.mu_k) * velocity_unit
    atol: Any = np.repeat([TOLERANCE, min(TOLERANCE, 0.01 * width * velocity_unit)], n)
    stepper = Radau(
        right_hand_side,
        0.0,
        np.zeros(2 * n),
        duration / tau,
        rtol=TOLERANCE,
        atol=atol,
        jac=matrix,
    )
    mode = np.zeros(n, np.int64)
    rows: list[tuple[float, int, int, float]] = []
    was_global = False
    while stepper.status == "running":
        if message := stepper.step():
            raise RuntimeError(f"Radau at t = {stepper.t * tau:.9g} s: {message}")
        velocity = stepper.y[n:]
        new = np.where(np.abs(velocity) > threshold, np.sign(velocity), 0.0).astype(
            np.int64
        )
        if (new == mode).all():
            continue
        dense = stepper.dense_output()
        crossings = sorted(
            (
                _crossing(
                    dense, n + i, mode[i] or new[i], threshold, stepper.t_old, stepper.t
                ),
                i,
            )
            for i in np.flatnonzero(new != mode).tolist()
        )
        for time, i in crossings:
            mode[i] = new[i]
            rows.append((time * tau, i + 1, int(new[i]), float(dense(time)[0])))
            was_global = was_global or bool(mode.all())
        if until and was_global and not mode.any():
            duration = rows[-1][0]
            break
    columns = zip(*rows, strict=True) if rows else ((),) * 4
    return Result(Record.from_columns(chain, duration, *columns), stepper.nfev)


def _crossing(
    dense: Any, column: int, way: int, threshold: float, start: float, end: float
) -> float:
    """When the velocity in a column, in the direction of a mode, crosses the threshold
    in a step."""
    return brentq(lambda time: way * float(dense(time)[column]) - threshold, start, end)


METHODS = (
    Method("regularised_radau", "width [m/s]", solve_regularised, kind="friction law"),
)
