"""The summary of many runs says what the slip table of each says."""

import numpy as np
import pytest
from analysis.random_runs import random_chain, random_transitions

from precursors import Chain, Run, find_precursors, find_slips, simulate
from precursors.analysis.slips import Definition, apparent_friction, first_global, slip_table
from precursors.analysis.summary import summarise

PAPERS = {"-5/6": (6, 0.4845, 2.632), 0: (9, 0.4858, 2.739), "5/6": (14, 0.4883, 2.890)}


def table_path(run: Run) -> dict[str, float]:
    """The summary by way of the slip table."""
    slips, table = find_slips(run), slip_table(run)
    friction = apparent_friction(table)
    reached = friction is not None
    up_to = slips.iloc[: first_global(slips) + 1] if reached else slips
    start, end = (up_to.onset.iloc[-1], up_to.end.iloc[-1]) if reached else (np.nan, np.nan)
    later = slips.onset.iloc[len(up_to)] if len(up_to) < len(slips) else np.inf
    each = Definition("each").read(table)
    friction_each = apparent_friction(table, Definition("each"))
    of_each = first_global(each) if friction_each else len(slips) - 1
    return {
        "n_events": len(up_to),
        "events_counted": len(find_precursors(slips)),
        "mu_sapp": friction.mu_sapp if friction else np.nan,
        "load": friction.load if friction else np.nan,
        "time": start,
        "end": end,
        "crossing_time": crossing_time(run, start),
        "transitions": int((run.transitions["time"] < later).sum()),
        "reached": reached,
        "n_global": int(slips.is_global.sum()),
        "n_all_events": len(slips),
        "n_alone": int((up_to.n_slid == 1).sum()),
        "n_events_each": of_each + 1,
        "mu_sapp_each": friction_each.mu_sapp if friction_each else np.nan,
        "sliding_each": slips.n_simultaneous.iloc[of_each] if friction_each else 0,
    }


def crossing_time(run: Run, start: float) -> float:
    """From the onset of an event to the first slide of block N in it."""
    if np.isnan(start):
        return np.nan
    t = run.transitions
    first, *_ = np.flatnonzero(t["time"] >= start)
    slides = (t["block"] == run.chain.n_blocks) & (t["mode"] != 0)
    arrival, *_ = first + np.flatnonzero(slides[first:])
    return float(run.intervals[first + 1 : arrival + 1].sum())


def assert_same(runs: list[Run]) -> None:
    """Summarise all runs together, and compare each row with the tables of its run."""
    for found, run in zip(summarise(runs), runs, strict=True):
        expected = table_path(run)
        assert set(found.dtype.names) == {*expected, "pulse_blocks", "pulse_speed", "pulse_mu", "pulse_time"}
        for name, value in expected.items():
            if name == "crossing_time":  # the only sum, added up in another order here
                assert found[name] == pytest.approx(value, rel=1e-12, nan_ok=True)
            else:
                np.testing.assert_equal(found[name], value, err_msg=name)


@pytest.mark.parametrize("theta", PAPERS)
def test_the_papers_three_runs_have_the_known_summary(theta):
    chain = Chain.from_slider(theta=theta)
    row = summarise([simulate(chain, until="global slip")])[0]
    assert (row["events_counted"], round(row["mu_sapp"], 4), round(row["time"], 3)) == PAPERS[theta]


def test_random_chains_have_the_summary_of_their_slip_table():
    rng = np.random.default_rng(4)
    runs = [simulate(random_chain(rng), duration=rng.uniform(0.5, 4.0)) for _ in range(150)]
    reached = summarise(runs)["reached"]
    assert 20 < reached.sum() < 130  # both kinds are tried
    assert_same(runs)


def test_any_list_of_transitions_has_the_summary_of_its_slip_table():
    rng = np.random.default_rng(5)
    runs = [random_transitions(rng) for _ in range(300)]
    summaries = summarise(runs)
    assert 30 < summaries["reached"].sum() < 270
    assert np.isnan(summaries["end"][summaries["reached"]]).any()  # cut off by the end of the run
    assert_same(runs)


def test_blocks_that_move_at_the_start_belong_to_the_first_event():
    assert_same([simulate(Chain.from_slider(), duration=0.5, start_velocities=np.full(10, 0.01))])


def test_a_run_without_transitions_has_no_event_and_no_run_no_row():
    calm = simulate(Chain.from_slider(), duration=0.1)
    row = summarise([calm])[0]
    assert (row["n_events"], row["transitions"], row["reached"]) == (0, 0, False)
    assert np.isnan(row["mu_sapp"])
    assert len(summarise([])) == 0
    assert_same([calm, simulate(Chain.from_slider(), duration=3.0), calm])


def test_a_pulse_that_crosses_a_chain_has_its_length_and_speed():
    """Three blocks slide at a time; one is released and one stops every 0.1 s, on blocks 1 m apart."""
    chain = Chain(np.ones(10), 1.0, 1.0, 1.0, 1e-4, mu_s=0.7, mu_k=0.4, length=10.0)
    steps = [(1, 1), (2, 1), (3, 1)] + [(j, m) for i in range(4, 11) for j, m in ((i, 1), (i - 3, 0))]
    block, mode = zip(*steps, strict=True)
    pauses = [0.0, 0.0] + [0.1, 0.0] * 7  # before transitions 2, 3 and so on
    time = 1.0 + np.cumsum([0.0, *pauses])
    run = Run.from_transitions(chain, time[-1] + 0.1, time, block, mode, np.ones(17), [1.0, *pauses, 0.1])
    row = summarise([run])[0]
    assert not row["reached"]
    assert row["pulse_blocks"] == pytest.approx(3.0)
    assert row["pulse_speed"] == pytest.approx(10.0 / 0.8)
