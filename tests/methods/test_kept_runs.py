"""Short runs of all methods are those that are kept.

They depend on all that methods share (columns, common, events, fixed_step) and on each of them: cvode_events,
dop853, exact, heyoka_events, karnopp, leapfrog, moreau_jean, newmark, regularised, rk4, rk4_located and
scipy_events.
"""

import pandas as pd
import pytest
from golden.small_tables import SMALL
from methods.kept_runs import kept_runs

from precursors.methods import METHODS

# Relative, after some tens of transitions: with and without fused products it was 1e-9.
ROUNDING = 1e-8


@pytest.mark.parametrize("name", METHODS)
def test_costs_transitions_times_and_loads_of_short_runs_are_those_that_are_kept(name):
    kept = pd.read_csv(SMALL / "methods.csv", keep_default_na=False).query("method == @name")
    found = kept_runs(name)
    pd.testing.assert_frame_equal(found, kept.reset_index(drop=True), rtol=ROUNDING)
