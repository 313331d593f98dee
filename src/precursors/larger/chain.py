"""One larger chain: friction that falls with velocity, viscosity, and the height of the
push.

    m dv_i/dt = G_i - sign(v_i) mu(|v_i|) w_i,
    G_i = T_i + D_i - T_{i+1} - D_{i+1},    D_i = eta (v_{i-1} - v_i),
    mu(v) = mu_s - (mu_s - mu_k) min(v/v_c, 1),    w_i = w_i0 + c_i F_X

while block i slides, unless `friction` has another law. It sticks while |G_i| <= mu_s
w_i. docs/models.md has the
equations, and what is found.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from precursors.larger.friction import FrictionLaw, LinearWeakening, chords
from precursors.model.chain import Chain, FloatArray
from precursors.model.checks import Until, not_negative, positive
from precursors.solver.run import LargerRun

# Where a run ends before its duration: "settled" is of `simulate_larger`.
LargerUntil = Until | Literal["settled"]
# What it adds to the paper's chain, with units.
ADDITIONS = {
    "weakening_velocity": "m/s",
    "relaxation_time": "s",
    "viscosity": "N s/m",
    "push_height": "m",
}
PATIENCE = 100_000_000  # steps: ten seconds of work with some ten blocks moving
# Of `critical_length`: steps along the chain, and growth rates from 1e-5 to 1 times the
# largest. With both doubled, l_c changes by less than 1e-3.
LENGTH_STEPS = 2000
GROWTH_RATES = 300


@dataclass(frozen=True)
class LargerChain:
    """The paper's chain with up to three more numbers; all 0 is the paper's chain.

    `friction` is a law of friction in place of `weakening_velocity`.
    """

    chain: Chain
    weakening_velocity: float = 0.0
    relaxation_time: float = 0.0
    viscosity: float = 0.0
    push_height: float = 0.0
    friction: FrictionLaw | None = None

    def __post_init__(self) -> None:
        for name, unit in ADDITIONS.items():
            value = not_negative(name, getattr(self, name), unit)
            object.__setattr__(self, name, value)
        if self.relaxation_time and self.viscosity:
            raise ValueError(
                "viscosity must not be given beside relaxation_time, which is viscosity / k"
            )
        if self.friction is None:
            return
        if self.weakening_velocity:
            raise ValueError("weakening_velocity must not be given beside friction")
        positive("weakening_velocity", self.friction.weakening_velocity, "m/s")

    @classmethod
    def of_run(cls, run: LargerRun) -> LargerChain:
        """The chain of a run.

        Raises
        ------
        ValueError
            If it has another law of friction than `LinearWeakening`: a file tells the
            name and the numbers of it only.
        """
        law = run.numbers.get("friction", LinearWeakening.__name__)
        if law != LinearWeakening.__name__:
            raise ValueError(
                f"the law of friction of this run is not known here: {law}"
            )
        return cls(run.chain, **{name: run.numbers[name] for name in ADDITIONS})

    @property
    def law(self) -> FrictionLaw:
        """The law of friction."""
        return self.friction or LinearWeakening(self.weakening_velocity)

    @property
    def numbers(self) -> dict[str, Any]:
        """What it adds to the chain, by name, with its law of friction."""
        added = {name: getattr(self, name) for name in ADDITIONS}
        return {"friction": type(self.law).__name__, **added, **self.law._asdict()}

    @property
    def fall(self) -> float:
        """Fall of the friction coefficient with velocity, from rest on [s/m]; 0 for
        Coulomb friction, which jumps."""
        return float(chords(self.law, self.chain.mu_s, self.chain.mu_k).fall[0])

    def simulate(
        self,
        duration: float = 10.0,
        until: LargerUntil = None,
        step: float | None = None,
        max_transitions: int | None = None,
        start_forces: ArrayLike | None = None,
        max_steps: int = PATIENCE,
    ) -> LargerRun:
        """Run it as `simulate_larger` does, and again with half the step.

        `numbers` of the run tell what that changes: halved_load_N, the largest change
        of a load at which an event of Fig. 13 begins [N], of as many events as both
        runs have, and halved_events, the change of their number. Half the step may take
        twice as many.
        """
        # Imported here: a configuration is checked without the compiler.
        from precursors.analysis.slips import find_precursors, find_slips
        from precursors.larger.simulate import simulate_larger

        limits = (max_transitions, start_forces)
        run = simulate_larger(self, duration, until, step, *limits, max_steps)
        half = run.numbers["step"] / 2.0
        finer = simulate_larger(self, duration, until, half, *limits, 2 * max_steps)
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
    if larger.law.weakening_velocity == 0.0:
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
