"""A model without backward sliding: a block that would slide back stays where it is."""

from __future__ import annotations

from functools import partial

from precursors.accuracy.failures.common import Failure, Number, curves, transitions_right
from precursors.accuracy.failures.locating import next_root, overdue
from precursors.analysis.slips import apparent_friction, find_slips
from precursors.methods.events import MODE, PUSH, SLIDES, STICKS, Motion, march_restarting
from precursors.model.chain import Chain
from precursors.solver.run import Run
from precursors.solver.simulate import simulate

THETAS = ("-5/6", "5/6")


class ForwardMotion(Motion):
    """A motion in which friction holds a block against any force that points backward."""

    def switch(self, event: int, elapsed: float) -> bool:
        """Make the transition of an event function that has reached zero, and any that is overdue with it."""
        while event >= 0:
            block, n = event // 2, self.chain.n_blocks
            # A block that comes to rest was braked, so that its force is below mu_k w: it stays.
            old = int(self.settings[MODE, block])
            new = 1 - old
            self.settings[[SLIDES, PUSH, MODE, STICKS], block] = new, new * self.friction[block], new, 1 - new
            self.state[n + block] = new * self.nudge
            self._note(block + 1, new, elapsed)
            self.n_sliding += new - old
            self.was_global = self.was_global or self.n_sliding == n
            event = overdue(self, forward_only=True)
        if self.n_sliding == 0:
            self.onset += elapsed * self.tau
        return self.n_sliding > 0


def solve_forward_only(chain: Chain, duration: float, until: str | None = None) -> Run:
    """Run a chain whose blocks slide forward only: transitions located by DOP853."""
    motion = ForwardMotion(chain, duration, until)
    return march_restarting(motion, partial(next_root, motion, forward_only=True)).run


def forward_only() -> Failure:
    """Backward sliding forbidden: another model, with other numbers."""
    numbers, lines = [], {}
    for theta in THETAS:
        chain = Chain.from_slider(theta=theta)
        exact = simulate(chain, 10.0, "global slip")
        run = solve_forward_only(chain, 10.0, "global slip")
        right = transitions_right(run, exact)
        pairs: list[tuple[str, float, float]] = [("transitions right", right, len(exact.transitions))]
        true, found = (apparent_friction(r, find_slips(r)) for r in (exact, run))
        if true is not None and found is not None:
            pairs.append(("events kept", found.events_kept, true.events_kept))
            pairs.append(("mu_sapp", found.mu_sapp, true.mu_sapp))
        numbers += [Number("v < 0 forbidden", f"theta = {theta}", name, "1", *pair) for name, *pair in pairs]
        # The last theta's curves stay.
        for name, r in (("exact", exact), ("v < 0 forbidden", run)):
            lines[name] = (r.transitions["time"], r.transitions["tangential_load"])
    return Failure(tuple(numbers), curves("time_s", "tangential_load_N", **lines))
