"""Slip that does not end is counted with its interval; its pulse is measured."""

import numpy as np
import pandas as pd
import pytest
from ensembles.studies import study_of

from precursors.ensembles.endless import endless_table
from precursors.ensembles.study import run_members


def test_runs_of_the_study_are_long_enough_for_a_global_slip():
    members = run_members(
        study_of("endless_members", {"seed": 1, "n_blocks": [30, 40], "runs": [4, 3], "longest_slip": 0.1})
    )
    assert members.groupby("n_blocks").size().to_dict() == {30: 4, 40: 3}
    assert members["reached"].all()
    table = endless_table(members, 0.1)
    assert table["endless"].tolist() == [0, 0]
    assert table["pulse_speed_m_per_s"].isna().all()


def test_endless_runs_are_counted_and_their_pulse_averaged():
    runs = {"n_blocks": 100, "reached": [True] * 3 + [False] * 2, "sliding_each": [100, 90, 80, 100, 0]}
    runs |= {
        "pulse_blocks": [np.nan] * 3 + [4.0, 6.0],
        "pulse_speed_m_per_s": [np.nan] * 3 + [1300.0, 1200.0],
    }
    runs |= {"pulse_time_s": [np.nan] * 3 + [0.3, 0.2]}
    row = endless_table(pd.DataFrame(runs).assign(pulse_mu=0.45), 0.1).iloc[0]
    assert (row["runs"], row["endless"], row["share"], row["earlier"]) == (5, 2, 0.4, 0.4)
    assert row["pulse_length_m"] == pytest.approx(0.005)
    assert row["pulse_speed_m_per_s"] == 1250.0
    assert row["pulse_time_s"] == 0.2
    # Two of five: Clopper and Pearson's tables.
    assert [row["share_low"], row["share_high"]] == pytest.approx([0.0527, 0.8534], abs=1e-4)
