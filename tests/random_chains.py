"""Random chains far from the paper's, by number: `trial(7)` always has the same chain and
start."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from chains import first_transitions, positions_under
from numpy.random import Generator

from precursors import Chain, Run
from precursors.audit import audit

SEED = 1961


@dataclass(frozen=True)
class Trial:
    """A chain, its start, and the limits of its run."""

    chain: Chain
    duration: float
    start: dict[str, np.ndarray]
    most: int

    def run(self) -> Run:
        """The run, or its first `most` transitions."""
        return first_transitions(
            self.chain, self.most, duration=self.duration, **self.start
        )


def decades(rng: Generator, low: float, high: float) -> float:
    return 10.0 ** rng.uniform(low, high)


def any_chain(rng: Generator) -> Trial:
    """Parameters over many decades; some weights zero; prestressed and moving starts."""
    n = int(rng.integers(1, 61))
    force = decades(rng, -9, 9)
    stiffness = decades(rng, -6, 12)
    mass = decades(rng, -12, 6)
    spread = rng.choice([0.0, 1.0, 3.0])
    weights = force * 10.0 ** rng.uniform(-spread, spread, n)
    if rng.random() < 0.4:
        weights[rng.random(n) < rng.choice([0.1, 0.5, 0.9])] = 0.0
    weights[rng.integers(n)] = force
    mu_s = rng.choice(
        [0.7, 0.0, rng.uniform(0.05, 1.5), decades(rng, -6, 2)], p=[0.5, 0.1, 0.3, 0.1]
    )
    mu_k = mu_s * rng.choice([1.0, 0.0, rng.uniform()], p=[0.15, 0.15, 0.7])
    ratio = decades(rng, -6, 6) if rng.random() < 0.7 else 1.0
    stiffest = stiffness * max(1.0, ratio)
    duration = decades(rng, 0.5, 3.0) / (2 * math.sqrt(stiffest / mass))
    loading = decades(rng, -3, 1) * max(mu_s, 0.1) * weights.sum() / duration
    chain = Chain(
        weights,
        mass,
        stiffness,
        stiffness * ratio,
        loading / (stiffness * ratio),
        mu_s,
        mu_k,
    )
    return Trial(chain, duration, any_start(rng, chain, stiffest), 60)


def any_start(rng: Generator, chain: Chain, stiffest: float) -> dict[str, np.ndarray]:
    """Often at rest; sometimes with springs that push with up to 1.5 times the friction,
    or with moving blocks."""
    start: dict[str, np.ndarray] = {}
    friction = max(chain.mu_s, 0.1)
    if rng.random() < 0.4:
        pushes = rng.integers(-24, 25, chain.n_blocks) / 16 * chain.weights * friction
        start["start_positions"] = positions_under(chain, pushes)
    if rng.random() < 0.4:
        impacts = (
            rng.integers(-24, 25, chain.n_blocks) / 16 * chain.weights.max() * friction
        )
        start["start_velocities"] = impacts / math.sqrt(stiffest * chain.mass)
    return start


def mild_chain(rng: Generator) -> Trial:
    """1..12 blocks with parameters of similar size; half of the chains start strained
    and moving."""
    n = int(rng.integers(1, 13))
    mu_s = rng.uniform(0.3, 1.0)
    weights = rng.uniform(1.0, 100.0, n)
    drive_stiffness = 25e6 * decades(rng, -3.0, 1.0)
    mass = 1e-3
    duration = decades(rng, 2.0, 3.5) * math.sqrt(mass / max(25e6, drive_stiffness))
    velocity = rng.uniform(0.1, 3.0) * weights.sum() / (duration * drive_stiffness)
    mu_k = mu_s * rng.uniform(0.1, 0.9)
    chain = Chain(weights, mass, 25e6, drive_stiffness, velocity, mu_s, mu_k)
    start = {}
    if rng.random() < 0.5:
        start["start_positions"] = positions_under(
            chain, rng.uniform(-1.0, 1.0, n) * chain.strength
        )
        start["start_velocities"] = rng.normal(size=n) * 0.01
    return Trial(chain, duration, start, 40)


def even_chain(rng: Generator) -> Trial:
    """Small whole numbers as parameters, so that blocks reach their limits at the same
    instant, or only touch them."""
    n = int(rng.integers(1, 13))
    weights = rng.integers(0, 4, n).astype(float)
    weights[rng.integers(n)] = 2.0
    mu_s = rng.choice([1.0, 0.5, 0.0])
    stiffness, drive_stiffness, mass = rng.choice([1.0, 2.0, 4.0], 3)
    velocity = rng.choice([1.0, 0.125, 1e-3, 1e-9])
    mu_k = mu_s * rng.choice([0.0, 0.5, 1.0])
    chain = Chain(weights, mass, stiffness, drive_stiffness, velocity, mu_s, mu_k)
    start: dict[str, np.ndarray] = {}
    if rng.random() < 0.6:
        start["start_positions"] = positions_under(
            chain, rng.integers(-2, 3, n) * mu_s * weights / 2
        )
    if rng.random() < 0.6:
        start["start_velocities"] = rng.integers(-1, 2, n).astype(float)
    return Trial(chain, rng.choice([1.0, 30.0, 300.0]), start, 80)


def absurd_chain(rng: Generator) -> Trial:
    """Any doubles as parameters: not physical, but the solver must neither hang nor give
    wrong results."""
    n = int(rng.integers(1, 9))
    size = rng.choice([15.0, 50.0, 300.0])
    mass, stiffness, drive_stiffness, velocity = (
        decades(rng, -size, size) for _ in range(4)
    )
    weights = 10.0 ** rng.uniform(-size, size, n)
    chain = Chain(weights, mass, stiffness, drive_stiffness, velocity, 0.7, 0.45)
    longest = 300 * math.sqrt(mass / max(stiffness, drive_stiffness))
    return Trial(chain, min(decades(rng, -size, size), longest), {}, 80)


def trial(number: int) -> Trial:
    """The trial of a number, always the same."""
    rng = np.random.default_rng([SEED, number])
    kind: Callable[[Generator], Trial] = rng.choice(
        [any_chain, even_chain, absurd_chain], p=[0.8, 0.15, 0.05]
    )
    return kind(rng)


def moves_as_the_model_says(number: int) -> bool:
    """Run and audit the chain of a trial; False if the library refuses it in one line."""
    try:
        case = trial(number)
        run = case.run()
    except ValueError as refusal:
        if len(str(refusal).splitlines()) != 1:
            raise
        return False
    assert run.duration == case.duration or len(run.transitions) >= case.most
    assert np.isfinite(run.at([0.0, run.duration])).all()
    audit(run).raise_if_failed()
    return True
