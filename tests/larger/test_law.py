"""The law of the settled coefficient against runs on which nobody tuned it."""

from dataclasses import replace

import numpy as np
import pytest
from chains import SLIDER

from precursors.larger.chain import LargerChain, critical_length, weakening_velocity
from precursors.larger.law import Law
from precursors.larger.settled import beside_law, settled
from precursors.larger.simulate import simulate_larger

LAW = 0.003  # of the peaks of runs with the number of precursors counted in them
PREDICTED = 0.005  # of peaks with nothing counted
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
        chain_of(0.3 + PLACES * (1.0 - PLACES), 0.2, 1.5e-4),
        chain_of(EVEN, 0.2, 1.5e-4, drive_stiffness=1.2e6),
        chain_of(EVEN, 0.2, 1.5e-4, mu_k=0.55),
    ],
    ids=["-0.7", "+0.6", "middle", "K", "mu_k"],
)
def test_a_run_settles_at_the_law_with_its_precursors_and_with_nothing_counted(larger):
    law = Law(larger)
    found = settled(simulate_larger(larger, 12.0, "settled", STEP), law.nucleus)
    counted = law.fixed_point(found["precursors"])
    predicted = law.cycle(law.rest)
    assert found["period"] > 0
    assert found["coefficient"] == pytest.approx(counted.coefficient, abs=LAW)
    assert found["coefficient"] == pytest.approx(predicted.coefficient, abs=PREDICTED)
    assert found["precursors"] == predicted.precursors
    assert predicted.precursors in law.possible


@pytest.mark.parametrize("t_v", [5e-5, 1.5e-4, 3e-4])
def test_the_slope_is_that_of_the_events_about_the_fixed_point(t_v):
    law = Law(chain_of(1.0 - 1.2 * (PLACES - 0.5), 0.25, t_v))
    fixed = law.fixed_point()
    peak = (fixed.coefficient - law.mu_k) / law.drop
    left = (law.nucleus_load - peak) / (1.0 - law.nucleus)
    stress = 0.8 * left * (law.places - 1.0)
    peaks = np.empty(20)
    for i in range(20):
        peaks[i], front, stress = law.event(stress)
        assert front == 1.0
    changes = np.diff(peaks)
    assert peaks[-1] == pytest.approx(peak, abs=0.01)
    assert changes[1] / changes[0] == pytest.approx(fixed.slope, abs=0.05)


def test_the_need_of_an_even_load_is_its_nucleation_length():
    law = Law(chain_of(EVEN, 0.2, 1e-4))
    np.testing.assert_allclose(law.need, 2.0 / np.pi * 0.2, rtol=1e-9)
    assert law.nucleus == pytest.approx(0.2, abs=1e-3)


def test_more_load_at_the_far_end_needs_more_precursors_which_come_farther_each_time():
    laws = [
        Law(chain_of(1.0 + s * (PLACES - 0.5), 0.15, 1e-4)) for s in (-1.6, 0.0, 1.6)
    ]
    cycles = [law.cycle(law.rest) for law in laws]
    assert [cycle.precursors for cycle in cycles] == [0.0, 0.0, 2.0]
    fronts = cycles[-1].fronts
    assert laws[-1].nucleus < fronts[0] < fronts[1] < 1.0


EVENLY = chain_of(EVEN, 0.2, 1e-4)


@pytest.mark.parametrize(
    ("larger", "reason"),
    [
        (replace(EVENLY, weakening_velocity=0.0), "v_c/V must be between 3.3 and inf"),
        (chain_of(EVEN, 0.3, 1e-6), "omega t_v .* between 0.05 and 4, but is 0.0078"),
        (chain_of(EVEN, 0.2, 1e-3), "omega t_v .* but is 7.8"),
        (chain_of(EVEN, 0.05, 1e-4, drive_velocity=1e-5), "l_c/L .* 0.06 and 0.7"),
        (
            replace(EVENLY, weakening_velocity=1.0),
            "too weakly weakening, it has no l_c",
        ),
        (chain_of(EVEN, 0.2, 1e-4, drive_velocity=0.01), "v_c/V .* but is 0.55"),
        (chain_of(EVEN, 0.2, 1e-4, drive_stiffness=5e6), r"K L/\(E S\) .* but is 2"),
    ],
)
def test_outside_its_limits_the_law_is_refused_with_the_reason(larger, reason):
    with pytest.raises(ValueError, match=f"^the law of .* does not apply: .*{reason}"):
        Law(larger)


def test_a_run_tells_the_law_beside_its_own_coefficient():
    larger = chain_of(np.ones(25), 0.25, 1e-4, drive_velocity=5e-4)
    law = Law(larger)
    told = beside_law(simulate_larger(larger, 3.0, step=STEP))
    assert told["critical_length_m"] == critical_length(larger)
    fixed = law.fixed_point(told["precursors"])
    assert told["law_coefficient"] == fixed.coefficient
    assert told["settled_coefficient"] == pytest.approx(fixed.coefficient, abs=0.01)
    early = beside_law(simulate_larger(larger, 0.1, step=STEP))
    assert np.isnan(early["settled_coefficient"])
    assert early["predicted_coefficient"] == told["predicted_coefficient"]
