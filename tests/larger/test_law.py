"""The law of the settled coefficient against runs on which nobody tuned it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from chains import SLIDER
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from precursors.larger.chain import LargerChain, critical_length, weakening_velocity
from precursors.larger.law import law_of
from precursors.larger.settled import beside_law, settled
from precursors.larger.simulate import simulate_larger

LAW = 0.005  # of the peaks of runs with the number of precursors counted in them
STEP = 0.5  # changes settled peaks by 3e-4, compared with 0.25
PLACES = (np.arange(50) + 0.5) / 50
EVEN = np.ones(50)


def chain_of(shape, part, t_v, normal_load=400.0, **slider):
    """A chain with the shape of its normal loads and l_c/L for an even load."""
    even = SLIDER(len(shape), normal_load=normal_load, **slider)
    loads = normal_load * shape / shape.sum()
    v_c = weakening_velocity(even, part, t_v)
    return LargerChain(replace(even, weights=loads), v_c, t_v)


@pytest.mark.parametrize(
    "larger",
    [
        chain_of(1.0 - 1.4 * (PLACES - 0.5), 0.17, 1.3e-4),
        chain_of(1.0 + 1.2 * (PLACES - 0.5), 0.23, 1.7e-4),
        chain_of(EVEN, 0.2, 1.5e-4, drive_stiffness=1.2e6),
        chain_of(EVEN, 0.2, 1.5e-4, mu_k=0.55),
    ],
    ids=["-0.7", "+0.6", "K", "mu_k"],
)
def test_a_run_settles_at_the_law_with_the_precursors_that_it_has(larger):
    law = law_of(larger)
    found = settled(simulate_larger(larger, 12.0, "settled", STEP), law.nucleus)
    assert found["period"] > 0
    assert found["coefficient"] == pytest.approx(
        law.coefficient(found["precursors"]), abs=LAW
    )
    assert found["precursors"] in law.possible
    assert found["coefficient"] > law.bound


@pytest.mark.parametrize("t_v", [2e-5, 2e-4])
def test_the_rebound_is_the_stress_left_by_a_periodic_swing(t_v):
    """Elastic stress lags the total one by t_v during half a swing, from -r to r."""
    larger = chain_of(EVEN, 0.2, t_v)
    omega = 7754.0  # of the paper's slider on its drive [1/s]

    def gain(left):
        half = (0.0, np.pi / omega)
        lag = solve_ivp(
            lambda t, s: (np.cos(omega * t) - s) / t_v, half, [-left], rtol=1e-9
        )
        return lag.y[0, -1] + left

    assert law_of(larger).rebound == pytest.approx(brentq(gain, 0.0, 2.0), rel=1e-4)


def test_the_need_of_an_even_load_is_its_nucleation_length():
    law = law_of(chain_of(EVEN, 0.2, 1e-4))
    np.testing.assert_allclose(law.need, 2.0 / np.pi * 0.2, rtol=1e-12)
    assert law.nucleus == pytest.approx(0.2, abs=1e-3)


def test_more_load_at_the_far_end_needs_more_precursors():
    chains = [chain_of(1.0 + s * (PLACES - 0.5), 0.15, 1e-4) for s in (-1.6, 0.0, 1.6)]
    assert [min(law_of(chain).possible) for chain in chains] == [0, 0, 2]


def test_a_front_stops_before_the_end_unless_the_cycle_has_enough_precursors():
    law = law_of(chain_of(1.0 + 1.6 * (PLACES - 0.5), 0.15, 1e-4))
    n = min(law.possible)
    fronts = [law.front(k, n) for k in range(n + 1)]
    assert fronts == sorted(fronts)
    assert law.nucleus < fronts[0] < 1.0
    assert fronts[-1] == 1.0


EVENLY = chain_of(EVEN, 0.2, 1e-4)


@pytest.mark.parametrize(
    ("larger", "reason"),
    [
        (replace(EVENLY, weakening_velocity=0.0), "friction does not weaken"),
        (replace(EVENLY, relaxation_time=0.0), "omega t_v = 0 is below 0.05"),
        (chain_of(EVEN, 0.2, 1e-3), "omega t_v = 7.8 is above 4"),
        (
            chain_of(EVEN, 0.05, 1e-4, drive_velocity=1e-5),
            "l_c is shorter than 3 blocks",
        ),
        (replace(EVENLY, weakening_velocity=1.0), "l_c = inf L is above 0.7 L"),
        (
            chain_of(EVEN, 0.2, 1e-4, drive_velocity=0.01),
            "V = 0.01 m/s is above 0.3 v_c",
        ),
        (
            chain_of(EVEN, 0.2, 1e-4, drive_stiffness=5e6),
            "K = 2 E S/L is above 1.3 E S/L",
        ),
    ],
)
def test_outside_its_limits_the_law_is_refused_with_the_reason(larger, reason):
    with pytest.raises(ValueError, match=f"^the law of .* fails: {reason}$"):
        law_of(larger)


def test_a_run_tells_the_law_beside_its_own_coefficient():
    larger = chain_of(np.ones(25), 0.25, 1e-4, drive_velocity=5e-4)
    law = law_of(larger)
    told = beside_law(simulate_larger(larger, 3.0, step=STEP))
    assert told["critical_length_m"] == critical_length(larger)
    assert told["law_coefficient"] == law.coefficient(told["precursors"])
    assert told["settled_coefficient"] == pytest.approx(
        told["law_coefficient"], abs=0.01
    )
    early = beside_law(simulate_larger(larger, 0.1, step=STEP))
    assert np.isnan(early["settled_coefficient"])
    assert early["law_coefficient"] == law.coefficient(min(law.possible))
