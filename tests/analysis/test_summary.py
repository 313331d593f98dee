"""The summary of many runs says what the slip table of each says."""

import numpy as np
import pandas as pd
import pytest
from analysis.random_runs import random_chain, random_transitions

from precursors import Chain, Run, find_precursors, find_slips, simulate
from precursors.analysis.slips import first_global, first_global_slip, slip_table
from precursors.analysis.summary import KINK, summarise


def table_path(run: Run) -> dict[str, float]:
    """The summary by way of the slip table."""
    slips, table = find_slips(run), slip_table(run)
    friction = first_global_slip(table)
    reached = friction is not None
    up_to = slips.iloc[: first_global(slips) + 1] if reached else slips
    start, end = (
        (up_to.onset.iloc[-1], up_to.end.iloc[-1]) if reached else (np.nan, np.nan)
    )
    later = slips.onset.iloc[len(up_to)] if len(up_to) < len(slips) else np.inf
    return {
        "events_to_global_slip": len(up_to),
        "events_counted": len(find_precursors(slips)),
        "speedup": speedup(find_precursors(slips), run.chain.n_blocks)
        if reached
        else np.nan,
        "mu_sapp": friction.mu_sapp if friction else np.nan,
        "load": slips.load_before[friction.event - 1] if friction else np.nan,
        "time": start,
        "end": end,
        "transitions": int((run.transitions["time"] < later).sum()),
        "reached": reached,
        "n_global": int(slips.is_global.sum()),
        "n_all_events": len(slips),
    }


def speedup(counted: pd.DataFrame, n_blocks: int) -> float:
    """Growth of the length beyond the kink over that before it, event by event."""
    length = (counted["front"] / n_blocks).tolist()
    load = counted["load_before"].tolist()
    end = length.index(1.0)
    kink = max((i for i in range(end) if length[i] <= KINK), default=0)
    rises = length[kink] - length[0], 1.0 - length[kink]
    spans = load[kink] - load[0], load[end] - load[kink]
    if rises[0] * spans[1] <= 0:
        return np.nan
    return (rises[1] / rises[0]) * (spans[0] / spans[1])


def test_runs_at_random_have_the_summary_of_their_slip_table():
    """Of chains, of any transitions, of blocks that move at the start, and without any
    transition."""
    rng = np.random.default_rng(4)
    runs = [
        simulate(random_chain(rng), duration=rng.uniform(0.5, 4.0)) for _ in range(50)
    ]
    runs += [random_transitions(rng) for _ in range(120)]
    runs.append(
        simulate(Chain.from_slider(), duration=0.5, start_velocities=np.full(10, 0.01))
    )
    runs.append(simulate(Chain.from_slider(), duration=0.1))
    runs.append(simulate(Chain.from_slider(), duration=3.0))
    summaries = summarise(runs)
    assert 20 < summaries["reached"].sum() < 150  # both kinds are tried
    assert np.isnan(
        summaries["end"][summaries["reached"]]
    ).any()  # cut off by the end of the run
    for (_, found), run in zip(summaries.iterrows(), runs, strict=True):
        expected = table_path(run)
        assert set(summaries) == set(expected)
        for name, value in expected.items():
            if name == "speedup":  # computed in another order here
                assert found[name] == pytest.approx(value, rel=1e-12, nan_ok=True)
            else:
                np.testing.assert_equal(found[name], value, err_msg=name)


def test_no_run_has_no_row():
    assert len(summarise([])) == 0
