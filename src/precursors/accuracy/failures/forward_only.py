"""A model without backward sliding: a block that would slide backward stays where it
is."""

from __future__ import annotations

from functools import partial
from typing import Literal

import numpy as np

from precursors.accuracy.compare import transitions_right
from precursors.accuracy.failures.common import Curve, Failure, Number
from precursors.analysis.slips import first_global_slip, slip_table
from precursors.methods.march import march
from precursors.methods.rk4_located import run_located
from precursors.methods.switching import FORWARD_ONLY
from precursors.model.chain import Chain
from precursors.solver.run import Record
from precursors.solver.simulate import simulate

THETAS = ("-5/6", "5/6")
STEP = 1e-8  # [s]: mu_sapp is right to 1e-9


def solve_forward_only(
    chain: Chain, duration: float, until: str | None = None
) -> Record:
    """Run a chain whose blocks slide forward only: RK4, transitions located."""
    return march(run_located, (), chain, duration, STEP, until, rule=FORWARD_ONLY).run


def forward_only() -> Failure:
    """Backward sliding forbidden: another model, with other numbers."""
    numbers = []
    for theta in THETAS:
        chain = Chain.from_slider(theta=theta)
        exact = simulate(chain, 10.0, "global slip")
        run = solve_forward_only(chain, 10.0, "global slip")
        true, found = (first_global_slip(slip_table(r)) for r in (exact, run))
        assert true
        assert found
        number = partial(Number, "v < 0 forbidden", f"theta = {theta}")
        right = number(
            "transitions_right",
            "1",
            measured=transitions_right(run, exact),
            exact=len(exact.transitions),
            predicted=int(np.argmax(exact.transitions["mode"] < 0)),
            theory="transitions before the first backward slip, read off the exact run",
        )
        numbers += [
            right,
            number("events_counted", "1", found.events_counted, true.events_counted),
            number("mu_sapp", "1", found.mu_sapp, true.mu_sapp),
        ]
    # The curves are those of the last theta.
    return Failure(
        tuple(numbers),
        x="time_s",
        y="tangential_load_N",
        curves=(
            _loads("exact", exact, "exact"),
            _loads("v < 0 forbidden", run, "failing"),
        ),
    )


def _loads(name: str, run: Record, role: Literal["exact", "failing"]) -> Curve:
    return Curve(
        name, run.transitions["time"], run.transitions["tangential_load"], role
    )
