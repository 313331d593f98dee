"""How the time that the exact solver takes for a transition depends on the number of blocks."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from functools import partial

import numpy as np
import pandas as pd

from precursors.model.chain import Chain
from precursors.model.checks import Until
from precursors.model.statics import maximal_strain_positions
from precursors.solver.run import Run
from precursors.solver.simulate import TransitionLimitError, simulate
from precursors.support import timing

SIZES = (5, 10, 20, 50, 100, 200, 500)
BASE_SIZE = 10
ROUNDS = 5
SLOW_DRIVE, FAST_DRIVE = 1e-4, 0.02  # m/s
STRAIN = 0.9  # of the maximal one
LEAST_TRANSITIONS, TRANSITIONS_PER_BLOCK = 4000, 30
LONG = 1e6  # s, never reached: the number of transitions ends a run


@dataclass(frozen=True)
class Kind:
    """A way to set a chain in motion."""

    is_strained: bool
    drive_velocity: float
    until: Until = None
    least_size: int = 1

    def run(self, n_blocks: int, most_transitions: int) -> Run:
        """The first transitions of the paper's slider, cut into so many blocks."""
        chain = Chain.from_slider(n_blocks=n_blocks, drive_velocity=self.drive_velocity)
        start = STRAIN * maximal_strain_positions(chain) if self.is_strained else None
        try:
            return simulate(chain, LONG, self.until, start_positions=start, max_transitions=most_transitions)
        except TransitionLimitError as limit:
            return limit.run


KINDS = {
    "natural": Kind(False, SLOW_DRIVE),
    "driven": Kind(True, FAST_DRIVE),
    # In a short chain it has too few transitions: the call itself would take longer than they do.
    "front": Kind(True, SLOW_DRIVE, "global slip", least_size=50),
}


def measure_cost(
    sizes: Iterable[int] = SIZES,
    rounds: int = ROUNDS,
    least_transitions: int = LEAST_TRANSITIONS,
    transitions_per_block: int = TRANSITIONS_PER_BLOCK,
    shortest: float = timing.SHORTEST,
) -> pd.DataFrame:
    """Time the first transitions of chains of the paper's slider, cut into more and more blocks.

    "natural": from rest with springs at natural length, under the paper's drive; few blocks near the drive
    move. "driven": from a state near the largest strain (Eq. 12), with a drive so fast that the slider goes
    on slipping over its whole length. "front": the first slip from that state under the paper's drive, in
    which hundreds of blocks come to slide at once.

    Parameters
    ----------
    sizes : iterable of int
        Numbers N of blocks.
    rounds : int
        Number of rounds of which the median is taken.
    least_transitions, transitions_per_block : int
        A run has the larger of `least_transitions` and `transitions_per_block` N transitions; a front about
        2.5 N.
    shortest : float
        See `timing.measure`.

    Returns
    -------
    DataFrame
        A row per kind and size: n_blocks, transitions, mean_front (farthest sliding block
        over N, mean over the transitions), seconds_per_transition [s] of processor time,
        seconds_per_evaluation [s] of the force on one block, and the time per transition relative to the
        same kind's with `BASE_SIZE` blocks, for fronts to the driven one's (NaN without that size).
    """
    tasks = {
        (name, n): partial(kind.run, n, max(least_transitions, transitions_per_block * n))
        for name, kind in KINDS.items()
        for n in sizes
        if n >= kind.least_size
    }
    runs = {key: task() for key, task in tasks.items()}
    timings = timing.measure(tasks, rounds, shortest)
    rows = []
    for (name, n), run in runs.items():
        seconds = float(np.median(timings[name, n].cpu))
        rows.append(
            {
                "kind": name,
                "n_blocks": n,
                "transitions": len(run.transitions),
                "mean_front": mean_front(run) / n,
                "seconds_per_transition": seconds / len(run.transitions),
                "seconds_per_evaluation": seconds / (n * run.evaluations),
            }
        )
    table = pd.DataFrame(rows)
    base = table[table["n_blocks"] == BASE_SIZE].set_index("kind")["seconds_per_transition"]
    bases = table["kind"].map(lambda kind: base.get(kind, base.get("driven", math.nan)))
    return table.assign(relative=table["seconds_per_transition"] / bases)


def mean_front(run: Run) -> float:
    """Farthest sliding block, 0 for none, averaged over the transitions of a run."""
    slides = np.zeros(run.chain.n_blocks, bool)
    fronts = []
    for block, mode in zip(run.transitions["block"], run.transitions["mode"], strict=True):
        slides[block - 1] = mode != 0
        fronts.append(int(np.flatnonzero(slides)[-1]) + 1 if slides.any() else 0)
    return float(np.mean(fronts))
