"""One larger chain: friction that falls with velocity, viscosity, and the height of the
push.

    m dv_i/dt = G_i - sign(v_i) mu(|v_i|) w_i,
    G_i = T_i + D_i - T_{i+1} - D_{i+1},    D_i = eta (v_{i-1} - v_i),
    mu(v) = mu_s - (mu_s - mu_k) min(v/v_c, 1),    w_i = w_i0 + c_i F_X

while block i slides. It sticks while |G_i| <= mu_s w_i. docs/models.md has the
equations, and what is found.

Steps are those of the implicit midpoint rule, with springs, dashpots and falling
friction all implicit: one tridiagonal solution over the blocks up to the last that
slides, stable however stiff the dashpots are, and energy is balanced to rounding. A
step ends at the first release or stop in it. A complete rest is one step; nothing is
left out while a block moves.
"""

import math
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from precursors.analysis.slips import find_precursors, find_slips
from precursors.larger.additions import ADDITIONS
from precursors.larger.run import LargerRun
from precursors.larger.steps import (
    CompiledChain,
    End,
    Motion,
    march,
)
from precursors.model.chain import Chain, FloatArray
from precursors.model.checks import Until, checked_span, not_negative, number_array
from precursors.solver.simulate import MAX_TRANSITIONS, TransitionLimitError
from precursors.support.waiting import in_threads

# Of the shorter of sqrt(m/k) and the time in which falling friction, less viscosity,
# multiplies a velocity by e. With friction that jumps, the second gives all transitions
# of the paper's scenes up to the first global slip, in order.
STEP = 0.1
STEP_OF_COULOMB = 5e-4
# Of `critical_length`: steps along the chain, and growth rates from 1e-5 to 1 times the
# largest. With both doubled, l_c changes by less than 1e-3.
LENGTH_STEPS = 2000
GROWTH_RATES = 300
MAX_STEPS = 1_000_000_000  # of a run of a study, minutes; ten seconds need some 1e8
PATIENCE = 100_000_000  # of `simulate`: ten seconds of work with some ten blocks moving


@dataclass(frozen=True)
class LargerChain:
    """The paper's chain with up to three more numbers; all 0 is the paper's chain."""

    chain: Chain
    weakening_velocity: float = 0.0
    relaxation_time: float = 0.0
    viscosity: float = 0.0
    push_height: float = 0.0

    def __post_init__(self) -> None:
        for name, unit in ADDITIONS.items():
            object.__setattr__(
                self, name, not_negative(name, getattr(self, name), unit)
            )
        if self.relaxation_time and self.viscosity:
            raise ValueError(
                "viscosity must not be given beside relaxation_time, which is viscosity / k"
            )

    @property
    def fall(self) -> float:
        """Fall (mu_s - mu_k)/v_c of the friction coefficient with velocity [s/m]; 0 for
        Coulomb friction, which jumps."""
        drop = self.chain.mu_s - self.chain.mu_k
        return drop / self.weakening_velocity if self.weakening_velocity else 0.0

    def simulate(
        self, duration: float, until: Until = None, **limits: int
    ) -> LargerRun:
        """Run it for `precursors.simulate`, with what half the step changes in
        `larger`: halved_load_N and halved_events.

        These are the largest change of a load at which an event of Fig. 13 begins [N],
        of as many events as both runs have, and the change of their number. `limits`
        are those of `simulate_larger`; max_steps is by default `PATIENCE`, and
        half the step may take twice as many.
        """
        limits = {"max_steps": PATIENCE, **limits}
        run = simulate_larger(self, duration, until, **limits)
        half = run.numbers["step"] / 2.0
        limits["max_steps"] *= 2
        finer = simulate_larger(self, duration, until, half, **limits)
        a, b = (
            find_precursors(find_slips(r))["load_before"].to_numpy()
            for r in (run, finer)
        )
        n = min(len(a), len(b))
        found = {
            "halved_load_N": float(abs(a[:n] - b[:n]).max(initial=0.0)),
            "halved_events": len(b) - len(a),
        }
        return replace(run, numbers=run.numbers | found)


def critical_length(larger: LargerChain) -> float:
    """Length l_c [m] at which creep runs away; inf if it does not within the chain.

    The least l for which u'' + s (a - rho s)/(E S (1 + t_v s)) u = 0, u'(0) = u(l) = 0,
    has a solution for some s > 0, with rho = M/L and a(x) = (mu_s - mu_k) w(x)/v_c per
    length. All s are stepped through x at once. docs/models.md derives it.
    """
    chain = larger.chain
    if larger.weakening_velocity == 0.0:
        return 0.0
    block = chain.length / chain.n_blocks
    rigidity = chain.stiffness * block  # E S
    inertia = chain.mass / block
    fall = larger.fall * chain.weights / block
    viscous = larger.relaxation_time + larger.viscosity / chain.stiffness
    dx = chain.length / LENGTH_STEPS
    x = dx * (np.arange(LENGTH_STEPS) + 1.0)
    middles = block * (np.arange(chain.n_blocks) + 0.5)
    rates = fall.max() / inertia * np.geomspace(1e-5, 1.0, GROWTH_RATES)
    stiffening = rigidity * (1.0 + viscous * rates)
    u = np.ones(GROWTH_RATES)
    slope = np.zeros(GROWTH_RATES)
    for place, a in zip(x, np.interp(x - dx, middles, fall), strict=True):
        slope -= dx * rates * (a - inertia * rates) / stiffening * u
        u += dx * slope
        if u.min() <= 0.0:
            return float(place)
    return math.inf


def weakening_velocity(chain: Chain, part: float, relaxation_time: float) -> float:
    """v_c [m/s] for which an even normal load has l_c = `part` L; 0 for 0.

    The closed form of `critical_length`: t_v E S q^2 + 2 sqrt(rho E S) q = a with
    q = pi/(2 l_c).
    """
    if part == 0.0:
        return 0.0
    q = 0.5 * math.pi / (part * chain.length)
    rigidity = chain.stiffness * chain.length / chain.n_blocks
    inertia = math.sqrt(chain.n_blocks * chain.mass / chain.length * rigidity)
    a = relaxation_time * rigidity * q**2 + 2.0 * inertia * q
    return (chain.mu_s - chain.mu_k) * chain.normal_load / (chain.length * a)


def tilt(chain: Chain, push_height: float) -> FloatArray:
    """Change c_i of each normal load with F_X [1]: a straight line that balances the
    torque of F_X."""
    n = chain.n_blocks
    if n == 1:
        return np.zeros(1)
    # From the middle of the contact, over its length.
    place = (np.arange(1, n + 1) - (n + 1) / 2) / n
    return 12.0 * push_height / chain.length * place / (n * (1.0 - 1.0 / n**2))


def simulate_larger(
    larger: LargerChain,
    duration: float,
    until: Until | Literal["settled"] = None,
    step: float | None = None,
    max_transitions: int = MAX_TRANSITIONS,
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
    duration = checked_span(duration, None if until == "settled" else until)
    chain = larger.chain
    m = model_of(larger)
    step = step or (STEP if m.weakening_velocity else STEP_OF_COULOMB)
    lifting = np.divide(
        -m.weights, m.tilt, np.full(chain.n_blocks, np.inf), where=m.tilt < 0.0
    )
    modes = np.zeros((2, chain.n_blocks + 1), np.int64)
    arrays: list[Any] = [*np.zeros((7, chain.n_blocks + 1)), *modes, np.zeros(2)]
    state = Motion(*arrays)
    if start_forces is not None:
        state.force[:-1] = number_array("start_forces", start_forces, "N")
    before = stored_energy(chain, state)
    ends_at = (until == "global slip", until == "settled")
    end = End(duration, *ends_at, lifting.min(), max_transitions, max_steps)
    now = np.zeros(1)
    rows, points, time, steps = in_threads(
        "running",
        [partial(march, m, state, end, longest_steps(m, chain, step), now)],
        done=lambda: now[0] / duration,
    )[0]
    if state.force[0] > lifting.min():
        raise ValueError(
            f"push_height = {larger.push_height:g} m lifts block {lifting.argmin() + 1} "
            f"at F_X = {lifting.min():.4g} N"
        )
    rows = rows[np.argsort(rows[:, 0], kind="stable")]
    work, heat = state.energy
    lacking = work - heat - (stored_energy(chain, state) - before)
    numbers = {name: getattr(larger, name) for name in ADDITIONS}
    numbers |= {"step": step, "energy_error": lacking / work if work else 0.0}
    run = LargerRun.from_columns(
        chain, time, *rows.T, numbers=numbers, load_points=points
    )
    if len(rows) > max_transitions or steps > max_steps:
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
        mu_k=chain.mu_k,
        weakening_velocity=larger.weakening_velocity * (chain.mu_k < chain.mu_s),
        fall=larger.fall,
        drive_velocity=chain.drive_velocity,
    )


def longest_steps(m: CompiledChain, chain: Chain, step: float) -> FloatArray:
    """Steps [s] while nothing slides ahead of block 1..N; `step` is that of
    `simulate_larger`.

    The growth rate is that of falling friction, less the viscosity of the gravest mode
    of the stretch: a quarter of a wave, or even if the whole chain slides.
    """
    n = chain.n_blocks
    largest = m.weights + abs(m.tilt) * m.mu_s * chain.normal_load
    fall = m.fall * np.maximum.accumulate(largest)
    shape = (2.0 * np.sin(0.5 * math.pi / (2.0 * np.arange(1, n + 1) + 1.0))) ** 2
    shape[-1] = 0.0
    growth = np.maximum(fall - m.dashpots.max() * shape, 0.0) / m.mass
    return step / np.maximum(chain.fastest_frequency_bound / 2.0, growth)


def stored_energy(chain: Chain, state: Motion) -> float:
    """Energy of springs and of motion [J]."""
    elastic = (state.force[:-1] ** 2 / chain.springs).sum() / 2.0
    return float(elastic + chain.mass * (state.velocity[:-1] ** 2).sum() / 2.0)
