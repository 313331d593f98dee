"""The numbers of a run follow from its slip table."""

import math

import pytest

from precursors import (
    Chain,
    Record,
    apparent_friction,
    simulate,
    slip_table,
    summarise,
)
from precursors.analysis.summary import summary_of

# One quotient of doubles.
ROUNDING = 1e-15


def test_summary_of_runs_with_and_without_events():
    chain = Chain.from_slider(theta="-5/6")
    summary = summarise(simulate(chain, duration) for duration in (0.1, 1.0, 10.0))
    assert summary["reached"].tolist() == [False, False, True]
    assert summary["events_to_global_slip"].tolist() == [0, 1, 7]
    assert summary["events_counted"].tolist() == [0, 1, 6]
    assert summary["events_in_all"].tolist() == [0, 1, 41]
    assert summary.loc[:1, "mu_sapp":"global_slip_load_N"].isna().all(axis=None)
    assert summary["mu_sapp"].round(4)[2] == 0.4845
    assert apparent_friction(simulate(chain, 10.0)) == summary["mu_sapp"][2]
    assert summarise([]).columns.equals(summary.columns)
    assert summarise(simulate(chain, 10.0)).equals(summary[2:].reset_index(drop=True))


def test_mu_sapp_is_the_largest_load_up_to_the_global_slip():
    """Block 1 slides backward in the first event, so that F_X is largest at its end."""
    back = [(1, 1, -1, 90.0), (2, 1, 0, 120.0)]
    both = [(3, 1, 1, 100.0), (4, 2, 1, 130.0), (5, 1, 0, 80.0), (6, 2, 0, 70.0)]
    columns = zip(*back, *both, strict=True)
    run = Record.from_columns(Chain.from_slider(2), 9.0, *columns)
    summary = summary_of(slip_table(run))
    assert slip_table(run)["largest_load_N"].tolist() == [90.0, 120.0]
    assert (summary.largest_load_N, summary.global_slip_load_N) == (120.0, 100.0)
    assert (summary.global_slip_s, summary.global_slip_end_s) == (3.0, 6.0)
    assert summary.mu_sapp == pytest.approx(120.0 / 400.0, rel=ROUNDING)


def test_global_slip_cut_off_by_the_run_has_no_end():
    run = simulate(Chain.from_slider(), 10.0)
    begin = summarise([run])["global_slip_s"].item()
    cut = summarise([simulate(run.chain, begin + 2e-4)])
    assert cut["reached"].item()
    assert math.isnan(cut["global_slip_end_s"].item())
    assert cut["mu_sapp"].item() == apparent_friction(run)
