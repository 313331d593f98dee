"""Predictability time: until when a run is accurate to a given tolerance.

Runs whose parameters and start differ from those of the run by a few roundings show how
far it may be off: their spread in time is the error of a transition's time, and the
order of transitions is known as long as all of them agree. Rounding on the way, which
counts where a slip is long or ends with hardly any slope, is seen in runs with all
forces times a factor: the same motion, rounded otherwise at every step. It is an
estimate; `certify` gives a proof.
"""

from dataclasses import dataclass, replace

import numpy as np

from precursors.analysis.agreement import transitions_right
from precursors.model.chain import FloatArray
from precursors.model.checks import positive
from precursors.solver.many import simulate_many
from precursors.solver.run import Run

EPS = float(np.finfo(float).eps)
# The spread of so many neighbours is within 40 % of that of very many, nineteen times
# in twenty.
N_NEIGHBOURS = 16
# Standard deviation of a value of a neighbour, in units of its largest rounding error
# EPS / 2: more than the solver takes for zero, so that neighbours disagree on a
# transition that rounding decides.
ROUNDINGS = 64.0
# The error is estimated as so many times the spread by one rounding.
SIGMAS = 6.0
# Runs with other roundings at every step, and how many times their spread the error is.
N_ROUNDED = 8
SIGMAS_ROUNDED = 4.0
# With a smaller drop of friction, relative to mu_s and the mean load, stops are so nearly
# missed that what the solver takes for zero shifts them.
NO_DROP = 1e-7
# Neighbours run a little longer than the run, so that none lacks a transition that
# comes just before the end.
LONGER = 1.0 + 1e-6
SEED = 2010
# Parameters in N or kg: with all of them times a factor, the motion is the same.
FORCES = ("weights", "mass", "stiffness", "drive_stiffness")
# Parameters that neighbours change, beside their weights and starts.
NUMBERS = ("mass", "stiffness", "drive_stiffness", "drive_velocity", "mu_s", "mu_k")


@dataclass(frozen=True, eq=False)
class PredictedErrors:
    """The errors that a run predicts of itself: times of its transitions and their
    errors [s].

    Errors are infinite from `order_known_until` on, which is infinite itself where all
    of the order is known.
    """

    time: FloatArray
    time_error: FloatArray
    duration: float
    order_known_until: float

    def horizon(self, tolerance: float) -> float:
        """Predictability time [s]; see the function `horizon`."""
        is_wrong = (self.time_error > tolerance) & np.isfinite(self.time_error)
        # A transition may come earlier by its error, but not before the one ahead of it.
        earliest = np.maximum(
            self.time - self.time_error, np.append(0.0, self.time[:-1])
        )
        first = earliest[is_wrong].min(initial=np.inf)
        return float(min(first, self.order_known_until, self.duration))


def horizon(run: Run, tolerance: float) -> float:
    """Time [s] until which transitions are in order, and their times right to a
    tolerance [s]."""
    positive("tolerance", tolerance, "s")
    return predicted_errors(run).horizon(tolerance)


def predicted_errors(run: Run) -> PredictedErrors:
    """Estimate the error of every transition's time, and from when the order of
    transitions is unknown.

    The neighbours are drawn from a fixed seed. A run and its continuation have the same
    errors as far as both go. The work is that of `N_NEIGHBOURS` + `N_ROUNDED` runs.
    """
    time = run.transitions["time"].astype(np.float64)
    others = neighbours(run)
    n = min(transitions_right(other, run) for other in others)
    following = [
        one.transitions["time"][n] for one in (run, *others) if len(one.transitions) > n
    ]
    unknown = min(following, default=np.inf)
    # A block released from rest with hardly a drop comes back to standstill and only
    # touches it: it may stop or not.
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
    """Runs of chains and starts that differ by `ROUNDINGS` roundings, and of the same
    motion with other roundings at every step; all a little longer than the run."""
    random = np.random.default_rng(SEED)

    def draw(*shape: int) -> FloatArray:
        return ROUNDINGS * EPS / 2 * random.standard_normal((N_NEIGHBOURS, *shape))

    chain = run.chain
    n = chain.n_blocks
    # Eq. 7 adds two numbers: a small weight is rounded like its difference from the
    # mean.
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
    """Root of the mean of the squares over the first axis."""
    return np.sqrt(np.mean(values**2, axis=0))
