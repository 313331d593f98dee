"""Whole runs of fixed-step methods: orders with switching, limits, Eq. 4 taken
literally, located zeros."""

from __future__ import annotations

import numpy as np
import pytest

from maegawa2010.methods import METHODS, DivergedError, rk4_located
from maegawa2010.methods.fixed_step import FIRST_ROOM
from maegawa2010.methods.march import march
from maegawa2010.methods.rk4 import run_rk4
from maegawa2010.methods.stability import highest_frequency
from maegawa2010.studies.failures.common import FIVE_SLIPS
from maegawa2010.studies.failures.literal_friction import load_after_limit
from precursors import Chain, Run, TransitionLimitError, simulate
from precursors.benchmark.compare import transitions_right

# Orders with transitions, and the two steps between which they are measured [s].
ORDERS = {
    # A transition within a step is an error of its length.
    **dict.fromkeys(
        ("rk4_skip", "leapfrog", "moreau_jean_half", "moreau_jean_one"),
        (1.0, 5e-8, 5e-9),
    ),
    "rk4_located": (4.0, 8e-7, 2e-7),
    "karnopp": (0.5, 3e-8, 3e-9),  # creep in the dead zone
}
# Where a transition falls within a step is chance: an average over this many steps
# leaves a few per cent.
STEPS_IN_SAMPLE = 60
ORDER_TOLERANCE = 0.15
CLOCK_ROUNDING = 1e-9  # relative, of a clock of some 1e6 steps
ROUNDING = 1e-12  # of a cubic of order one


@pytest.fixture(scope="module")
def chain() -> Chain:
    return Chain.from_slider()


@pytest.fixture(scope="module")
def five_slips(chain: Chain) -> Run:
    return simulate(chain, FIVE_SLIPS)


def load_error(run: Run, exact: Run) -> float:
    """Root mean square error of F_X at the transitions [N], of a run whose transitions
    are the right ones."""
    assert (
        transitions_right(run, exact) == len(run.transitions) == len(exact.transitions)
    )
    difference = (
        run.transitions["tangential_load"] - exact.transitions["tangential_load"]
    )
    return float(np.sqrt(np.mean(difference**2)))


def test_beyond_the_limit_a_run_ends_with_the_last_finite_transitions(chain):
    step = 1.5 * 2.0 / highest_frequency(chain)
    with pytest.raises(DivergedError, match="the numbers overflow at") as diverged:
        METHODS["leapfrog"].solve(chain, 10.0, step, None)
    run = diverged.value.run
    assert np.isfinite(run.transitions["tangential_load"]).all()
    assert run.duration < 10.0
    ends = np.append(run.transitions["time"], run.duration)
    np.testing.assert_allclose(np.cumsum(run.intervals), ends, rtol=CLOCK_ROUNDING)


def test_a_record_gets_more_room_and_a_run_ends_at_the_limit_of_transitions():
    chain = Chain.from_slider(n_blocks=3, drive_velocity=1e-2)
    with pytest.raises(
        TransitionLimitError, match=f"max_transitions = {2 * FIRST_ROOM} reached"
    ) as limit:
        march(run_rk4, chain, 10.0, 1e-6, max_transitions=2 * FIRST_ROOM)
    run = limit.value.run
    assert transitions_right(run, simulate(chain, 0.05)) > 40
    assert (np.diff(run.transitions["time"]) >= 0.0).all()
    assert run.intervals.sum() == pytest.approx(run.duration)


@pytest.mark.parametrize("name", ORDERS)
def test_the_order_with_transitions_depends_on_how_they_are_located(five_slips, name):
    order, coarse, fine = ORDERS[name]

    def error(step: float) -> float:
        steps = step * np.linspace(0.8, 1.2, STEPS_IN_SAMPLE)
        runs = (
            METHODS[name].solve(five_slips.chain, FIVE_SLIPS, h, None).run
            for h in steps
        )
        return float(
            np.sqrt(np.mean([load_error(run, five_slips) ** 2 for run in runs]))
        )

    found = np.log(error(coarse) / error(fine)) / np.log(coarse / fine)
    assert found == pytest.approx(order, abs=ORDER_TOLERANCE)


def test_eq_4_taken_literally_creeps_by_the_step_not_by_the_model(chain):
    """RK4 with a step of 1e-7 s never exceeds the first limit, with 1e-8 s it does,
    without a slip."""
    coarse, fine = (
        load_after_limit(chain, step, np.array([0.02, 0.04])) for step in (1e-7, 1e-8)
    )
    assert max(coarse) < chain.strength[0] < max(fine)


@pytest.mark.parametrize("g0", [1.0, 0.0])
def test_located_steps_see_every_dip_of_a_cubic(g0):
    """Also between positive ends; the zero is where the cubic first falls, from above
    or after a rise."""
    s, dips = np.linspace(0.0, 1.0, 2001), 0
    random = np.random.default_rng(1)
    for p1, p2, g1 in random.uniform(-1.5, 1.0, (1000, 3)) * [1.0, 0.1, 0.1]:
        p1 = p1 if g0 else abs(p1)
        b0, b1 = 3.0 * (p1 - g0), 3.0 * (g1 - p2)
        r = 1.0 - s
        cubic = g0 * r**3 + 3.0 * s * r * (p1 * r + p2 * s) + g1 * s**3
        found = rk4_located.first_zero(g0, b0, g1, b1, 1e-12)
        if cubic.min() < 0.0:
            dips += g1 > 0.0
            zero = s[np.argmax(cubic < 0.0)]
            assert found == pytest.approx(zero, abs=1e-3)
            assert abs(rk4_located.cubic_at(found, g0, b0, g1, b1)) < ROUNDING
        elif cubic[20:].min() > 1e-3:
            assert found == rk4_located.NEVER
    assert dips > 10
