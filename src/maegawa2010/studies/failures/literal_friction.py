"""Eq. 4 taken literally: friction is static only where the velocity is exactly zero."""

from __future__ import annotations

import numpy as np

from maegawa2010.methods import karnopp
from maegawa2010.methods.columns import FORCE, at_rest
from maegawa2010.studies.failures.common import Curve, Failure
from precursors.model.chain import Chain, FloatArray
from precursors.solver.simulate import simulate

END = 1.0  # s
STEPS = (3e-6, 1e-6)  # s
POINTS = 66


def load_after_limit(chain: Chain, step: float, times: FloatArray) -> FloatArray:
    """F_X [N] with Eq. 4 as printed, at some times [s] after block 1 has first reached
    its limit."""
    system, state = at_rest(chain)
    state[FORCE, 1] = chain.strength[0]
    load = []
    for time in np.diff(times, prepend=0.0):
        karnopp.slide(system, state, step, round(time / step))
        load.append(float(state[FORCE, 1]))
    return np.array(load)


def literal_friction() -> Failure:
    """With Eq. 4 as printed a block that has once slid never sticks again."""
    chain = Chain.from_slider()
    run = simulate(chain, END)
    exact_times = np.concatenate([[0.0], run.transitions["time"], [END]])
    exact = run.tangential_load(exact_times)
    limit = float(chain.strength.max())  # of every block
    onset = limit / chain.loading_rate
    times = np.linspace(0.0, END - onset, POINTS)
    curves = [Curve("exact", exact_times, exact, "exact")]
    for step in STEPS:
        load = load_after_limit(chain, step, times)
        points = np.append(0.0, onset + times), np.append(0.0, load)
        curves.append(Curve(f"dt = {step:.0e} s", *points))
    return Failure("time_s", "tangential_load_N", curves)
