"""Events of the larger chain against schemes of small steps that share no code with it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from chains import SLIDER

from precursors import find_slips
from precursors.larger.chain import LargerChain, weakening_velocity
from precursors.larger.simulate import simulate_larger

LOAD = 0.5  # N
# Until the first global slip, or 0.95 s. By RK4 with located transitions and steps of
# 2e-8 s, and where creep hardly trembles, by a staggered scheme of the first order.
SMALL_STEPS = pd.read_csv(Path(__file__).with_name("small_steps.csv"))


def pair(part, t_v, theta):
    slider = SLIDER(25, theta=theta, drive_velocity=3e-4)
    return LargerChain(slider, weakening_velocity(SLIDER(), part, t_v), t_v)


CHAINS = {
    "told": LargerChain(SLIDER(20, theta="-5/6", drive_velocity=3e-4), 0.037, 9.5e-5),
    "200us -5/6": pair(0.2, 2e-4, "-5/6"),
    "100us 0": pair(0.3, 1e-4, 0),
    "short -5/6": pair(0.1, 1e-4, "-5/6"),
}


@pytest.mark.parametrize("case", CHAINS)
def test_events_are_those_of_small_steps(case):
    expected = SMALL_STEPS[SMALL_STEPS["case"] == case]
    slips = find_slips(simulate_larger(CHAINS[case], 0.95))[: len(expected)]
    assert slips["front"].tolist() == expected["front"].tolist()
    np.testing.assert_allclose(
        slips["load_before"], expected["load_before"], rtol=0, atol=LOAD
    )
