"""Estimate the predictability time, up to which a run is accurate to a given tolerance.

Neighbours are runs whose parameters and start differ by a few roundings. The spread of
their transition times gives the error of a transition's time. The order of transitions
is known as long as all neighbours agree. Rounding errors during the run also matter, if
a slip is long or a block stops with a small deceleration. Further runs show these
errors: all their forces are multiplied by a factor, so that the motion is the same but
every step is rounded differently. The result is an estimate; `certify` gives a proof.
"""

from dataclasses import dataclass, replace

import numpy as np

from precursors.analysis.agreement import transitions_right
from precursors.model.chain import FloatArray
from precursors.model.checks import positive
from precursors.solver.many import simulate_many
from precursors.solver.run import Run

EPS = float(np.finfo(float).eps)
# In 95 % of cases the spread of this many neighbours is within 40 % of that of very
# many.
N_NEIGHBOURS = 16
# Standard deviation of a perturbed value, in units of its largest rounding error EPS /
# 2. It is larger than what the solver counts as zero, so neighbours disagree on a
# transition that depends on rounding.
ROUNDINGS = 64.0
# The error is estimated as SIGMAS times the spread that one rounding causes.
SIGMAS = 6.0
# Number of runs with multiplied forces, and ratio of the error to their spread.
N_ROUNDED = 8
SIGMAS_ROUNDED = 4.0
# Smallest drop of friction, (mu_s - mu_k) w_i over the mean of mu_s w_i. After a
# smaller one, stops depend on which values the solver counts as zero.
NO_DROP = 1e-7
# Neighbours run longer by this factor, so that none misses a transition just before the
# end.
LONGER = 1.0 + 1e-6
SEED = 2010
# Parameters with N or kg in their unit: a common factor does not change the motion.
FORCES = ("weights", "mass", "stiffness", "drive_stiffness")
# Parameters that differ in neighbours, apart from weights and starts.
NUMBERS = ("mass", "stiffness", "drive_stiffness", "drive_velocity", "mu_s", "mu_k")


@dataclass(frozen=True, eq=False)
class PredictedErrors:
    """Estimated errors of the transition times of a run [s].

    The order of transitions is known up to `order_known_until` [s], which is infinite
    if all of it is known. Errors of later transitions are infinite.
    """

    time: FloatArray
    time_error: FloatArray
    duration: float
    order_known_until: float

    def horizon(self, tolerance: float) -> float:
        """Return the predictability time [s] (see the function `horizon`)."""
        is_wrong = (self.time_error > tolerance) & np.isfinite(self.time_error)
        # A transition may come earlier by its error, but not before the previous one.
        earliest = np.maximum(
            self.time - self.time_error, np.append(0.0, self.time[:-1])
        )
        first = earliest[is_wrong].min(initial=np.inf)
        return float(min(first, self.order_known_until, self.duration))


def horizon(run: Run, tolerance: float) -> float:
    """Estimate the time [s] up to which the transitions of a run are in the right order
    and their times are accurate to `tolerance` [s]."""
    positive("tolerance", tolerance, "s")
    return predicted_errors(run).horizon(tolerance)


def predicted_errors(run: Run) -> PredictedErrors:
    """Estimate the error of each transition's time, and the time up to which their
    order is known.

    The neighbours are drawn with a fixed seed, so a run and a longer run of the same
    chain have the same errors while both last. The work is that of `N_NEIGHBOURS` +
    `N_ROUNDED` runs.
    """
    time = run.transitions["time"].astype(np.float64)
    others = neighbours(run)
    n = min(transitions_right(other, run) for other in others)
    following = [
        one.transitions["time"][n] for one in (run, *others) if len(one.transitions) > n
    ]
    unknown = min(following, default=np.inf)
    # After a release with almost no drop of friction, the velocity of the block returns
    # to zero and only touches it. It is then uncertain whether the block stops.
    drop = run.chain.strength - run.chain.kinetic_friction
    hardly = drop < NO_DROP * run.chain.strength.mean()
    released = (run.transitions["mode"] != 0) & hardly[run.transitions["block"] - 1]
    unknown = min(unknown, time[released & (time > 0.0)].min(initial=np.inf))
    shifts = np.array([other.transitions["time"][:n] for other in others]) - time[:n]
    by_change = SIGMAS / ROUNDINGS * rms(shifts[:N_NEIGHBOURS])
    by_rounding = SIGMAS_ROUNDED * rms(shifts[N_NEIGHBOURS:])
    error = np.full(len(time), np.inf)
    error[:n] = np.maximum(by_change, by_rounding) + EPS * time[:n]
    error[time >= unknown] = np.inf
    return PredictedErrors(
        time, error, run.duration, unknown if unknown < run.duration else np.inf
    )


def neighbours(run: Run) -> list[Run]:
    """Return perturbed runs, all slightly longer than the run.

    The first `N_NEIGHBOURS` differ in chain and start; the others have multiplied
    forces.
    """
    random = np.random.default_rng(SEED)

    def draw(*shape: int) -> FloatArray:
        return ROUNDINGS * EPS / 2 * random.standard_normal((N_NEIGHBOURS, *shape))

    chain = run.chain
    n = chain.n_blocks
    # Eq. 7 adds two numbers, so the rounding error of a small weight is that of its
    # difference from the mean.
    size = (chain.weights > 0) * (
        chain.weights + abs(chain.weights - chain.normal_load / n)
    )
    weights = np.maximum(chain.weights + draw(n) * size, 0.0)
    same_start = [(0, N_ROUNDED), (0, 0)]
    positions = 1 + np.pad(draw(n), same_start)
    velocities = 1 + np.pad(draw(n), same_start)
    chains = []
    for of_one, factors in zip(weights, 1 + draw(len(NUMBERS)), strict=True):
        changed = {
            name: f * getattr(chain, name)
            for name, f in zip(NUMBERS, factors, strict=True)
        }
        changed["mu_k"] = min(changed["mu_k"], changed["mu_s"])
        chains.append(replace(chain, weights=of_one, **changed))
    factors = np.random.default_rng(SEED).uniform(1.0, 2.0, N_ROUNDED)
    for f in factors:
        same = {name: f * getattr(chain, name) for name in FORCES}
        chains.append(replace(chain, **same))
    return simulate_many(
        chains,
        run.duration * LONGER,
        start_positions=list(run.start_positions * positions),
        start_velocities=list(run.start_velocities * velocities),
    )


def rms(values: FloatArray) -> FloatArray:
    """Return the root mean square over the first axis."""
    return np.sqrt(np.mean(values**2, axis=0))
