"""A model without backward sliding: a block that would slide backward stays where it is."""

from __future__ import annotations

from functools import partial

from precursors.accuracy.failures.common import Failure, Number, curves, transitions_right
from precursors.analysis.slips import apparent_friction, find_slips
from precursors.methods.events import MODE, Motion, march_restarting
from precursors.methods.scipy_events import next_transition
from precursors.model.chain import Chain, FloatArray
from precursors.solver.run import Run
from precursors.solver.simulate import simulate

THETAS = ("-5/6", "5/6")


class ForwardMotion(Motion):
    """A motion in which friction balances any force that points backward."""

    def event_functions(self, state: FloatArray) -> FloatArray:
        """As in `Motion`, but no block is released backward."""
        result = super().event_functions(state)
        result[1::2] = 1.0
        return result

    def settle(self, event: int) -> tuple[int, int, int, int]:
        """Release a block, or stop it: it was braked, so that its force is below mu_k w, and it stays."""
        block = event // 2
        old = int(self.settings[MODE, block])
        new = 1 - old
        self.settings[:, block] = new, new * self.friction[block], new, 1 - new
        self.state[self.chain.n_blocks + block] = new * self.nudge
        return block, old, new, self.overdue()


def solve_forward_only(chain: Chain, duration: float, until: str | None = None) -> Run:
    """Run a chain whose blocks slide forward only: transitions located with DOP853."""
    motion = ForwardMotion(chain, duration, until)
    return march_restarting(motion, partial(next_transition, motion)).run


def forward_only() -> Failure:
    """Backward sliding forbidden: another model, with other numbers."""
    numbers, lines = [], {}
    for theta in THETAS:
        chain = Chain.from_slider(theta=theta)
        exact = simulate(chain, 10.0, "global slip")
        run = solve_forward_only(chain, 10.0, "global slip")
        number = partial(Number, "v < 0 forbidden", f"theta = {theta}")
        numbers.append(
            number("transitions right", "1", transitions_right(run, exact), len(exact.transitions))
        )
        true, found = (apparent_friction(r, find_slips(r)) for r in (exact, run))
        assert true
        assert found
        numbers.append(number("events kept", "1", found.events_kept, true.events_kept))
        numbers.append(number("mu_sapp", "1", found.mu_sapp, true.mu_sapp))
        # The curves of the last theta are the ones that stay.
        for name, r in (("exact", exact), ("v < 0 forbidden", run)):
            lines[name] = (r.transitions["time"], r.transitions["tangential_load"])
    return Failure(tuple(numbers), curves("time_s", "tangential_load_N", **lines))
