"""What a reading of the paper's words makes of a slip table."""

import math

import numpy as np
import pandas as pd
import pytest

from maegawa2010.paper.readings import Definition, speedup
from precursors.analysis.summary import summary_of

# One quotient of doubles.
ROUNDING = 1e-15
# Front, blocks that slid, most at once, load before and after, of five events of a
# chain of three blocks.
EVENTS = pd.DataFrame(
    [
        (2, 2, 1, 9.0, 8.0),
        (1, 1, 1, 10.0, 9.5),
        (2, 2, 2, 11.0, 8.0),
        (3, 3, 2, 12.0, 10.0),
        (3, 3, 3, 11.0, 5.0),
    ],
    columns=["front", "n_slid", "n_simultaneous", "load_before_N", "load_after_N"],
)
EVENTS = EVENTS.assign(
    onset_s=EVENTS.index,
    end_s=EVENTS.index,
    largest_load_N=EVENTS["load_before_N"].cummax(),
    is_global=EVENTS["n_simultaneous"] == 3,
    n_blocks=3,
    normal_load_N=20.0,
)


@pytest.mark.parametrize(
    ("definition", "events", "counted", "mu_sapp"),
    [
        (Definition(), 5, 4, 0.6),
        (Definition("each"), 4, 3, 0.6),
        (Definition(2.5), 3, 2, 0.55),
        (Definition(short="not longer"), 5, 2, 0.6),
        (Definition(short="shorter than the last"), 5, 4, 0.6),
        (Definition("each", "n_simultaneous", "not longer"), 4, 2, 0.6),
    ],
)
def test_a_reading_decides_which_event_is_global_and_which_are_short(
    definition, events, counted, mu_sapp
):
    found = summary_of(definition.read(EVENTS))
    assert (found.events_to_global_slip, found.events_counted) == (events, counted)
    assert found.mu_sapp == pytest.approx(mu_sapp, rel=ROUNDING)


@pytest.mark.parametrize(
    ("fronts", "expected"),
    [
        ([1, 4, 7, 9, 10], (3 / 20) / (6 / 20)),
        ([1, 4, 9, 7, 10], (3 / 10) / (6 / 30)),  # a rule that counts shorter ones
        ([1, 4, 7, 9, 9], math.nan),  # the whole length is not reached
        ([7, 7, 7, 10, 10], math.nan),  # no rise up to the kink
    ],
)
def test_growth_beyond_the_kink_is_that_of_the_events_counted(fronts, expected):
    slips = {
        "front": np.array(fronts),
        "load_before_N": np.arange(10.0, 60.0, 10.0),
        "n_blocks": np.full(5, 10),
        "counted": np.full(5, True),
        "is_global": np.full(5, True),
    }
    assert speedup(slips) == pytest.approx(expected, nan_ok=True)
