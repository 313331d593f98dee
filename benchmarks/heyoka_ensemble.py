"""Runs of one chain in heyoka.py's ensemble mode, which copies the integrator for each
run.

Each run is one call that includes the waits; transitions are made in Python callbacks.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

from maegawa2010.methods.columns import time_unit
from maegawa2010.methods.events import STICKS, EventMotion
from maegawa2010.methods.heyoka_events import integrator_of
from precursors.model.chain import Chain


class Ensemble:
    """An integrator of a chain whose callbacks use the motion of their thread's run."""

    def __init__(self, chain: Chain, duration: float) -> None:
        self.chain = chain
        self.tau = time_unit(chain)
        self.end = duration / self.tau
        self.run = threading.local()
        self.solver = integrator_of(chain, 0.0, self.callback)

    def callback(self, event: int) -> Callable[[Any, int], bool]:
        """A callback that makes the transitions of an event, and returns whether the run
        continues (up to its first global slip)."""

        def make_transitions(solver: Any, _direction: int) -> bool:
            solver.reset_cooldowns()
            motion = self.run.motion
            motion.y, motion.settings = solver.state, solver.pars.reshape(4, -1)
            if motion.switch(event, solver.time):
                return True
            return not motion.motion.progress["was_global"][0]

        return make_transitions

    def start(self, solver: Any, _number: int) -> Any:
        """Set a copy of the integrator to rest."""
        solver.time = 0.0
        solver.state[:] = solver.pars[:] = 0.0
        solver.pars.reshape(4, -1)[STICKS] = 1.0
        solver.reset_cooldowns()
        self.run.motion = EventMotion(self.chain, self.end * self.tau, "global slip")
        return solver

    def ends(self, n_runs: int, threads: int) -> list[float]:
        """End of the first global slip of each of n runs [s]."""
        import heyoka as hy

        done = hy.ensemble_propagate_until(
            self.solver, self.end, n_runs, self.start, max_workers=threads
        )
        return [self.tau * solver.time for solver, *_ in done]
