"""Straight lines between the points of the load curve represent the load."""

import numpy as np

from precursors import Chain, find_slips, simulate
from precursors.analysis import load_curve as module
from precursors.analysis.load_curve import TOLERANCE_N, load_curve, load_trace

# Some thirty points per shortest oscillation in a slip.
POINTS_PER_SLIP = 1000
MOST_BYTES = 3e6
SEEN_N = 0.01  # a hundredth of a pixel, or less


def worst_in_slips(run, times, loads):
    """Largest deviation of the straight lines from F_X in any slip [N]."""
    slips = find_slips(run)
    inside = np.linspace(
        slips["onset"], slips["end"].fillna(run.duration), POINTS_PER_SLIP
    ).T.ravel()
    return np.abs(np.interp(inside, times, loads) - run.tangential_load(inside)).max()


def test_load_trace_resolves_every_slip_of_ten_seconds():
    run = simulate(Chain.from_slider(theta=5 / 6), 10.0)
    trace = load_trace(run)
    assert worst_in_slips(run, trace.time_s, trace.tangential_load_N) <= TOLERANCE_N
    assert len(trace.to_csv(index=False)) < MOST_BYTES


def test_load_curve_of_one_block_needs_no_more_points():
    run = simulate(Chain.from_slider(n_blocks=1), 4.0)
    times, loads = load_curve(run)
    assert TOLERANCE_N / 100 < worst_in_slips(run, times, loads) <= TOLERANCE_N
    assert len(times) == 1343


def test_weightless_block_1_is_drawn_with_bounded_points(monkeypatch):
    run = simulate(Chain.from_slider(theta=1), 0.01)
    times, loads = load_curve(run)
    between = np.linspace(0.0, run.duration, 10_000)
    apart = abs(np.interp(between, times, loads) - run.tangential_load(between))
    assert apart.max() <= TOLERANCE_N
    monkeypatch.setattr(module, "MOST_POINTS", 100)
    assert len(load_curve(run)[0]) < 110 + len(run.transitions)


def test_thinned_load_curve_looks_like_the_full_one(monkeypatch):
    run = simulate(Chain.from_slider(n_blocks=30), 4.0)
    times, loads = load_curve(run)
    monkeypatch.setattr(module, "MOST_POINTS", 4000)
    fewer, drawn = load_curve(run)
    assert len(fewer) < len(times) / 4
    assert abs(np.interp(times, fewer, drawn) - loads).max() < SEEN_N


def test_run_that_ends_within_a_slip_is_drawn_to_its_end():
    event = find_slips(simulate(Chain.from_slider(), 3.0)).iloc[0]
    run = simulate(Chain.from_slider(), float((event.onset + event.end) / 2))
    times, loads = load_curve(run)
    assert times[-1] == run.duration
    assert worst_in_slips(run, times, loads) <= TOLERANCE_N


def test_points_are_at_transitions_and_otherwise_within_slips():
    run = simulate(Chain.from_slider(), 3.0)
    times, _ = load_curve(run)
    slips = find_slips(run)
    event = np.searchsorted(slips["onset"], times, side="right") - 1
    in_slip = (event >= 0) & (times <= slips["end"].to_numpy()[event])
    assert (~in_slip).sum() == 2  # the start and the end
    assert np.isin(run.transitions["time"], times).all()
    assert (np.diff(times) > 0).all()
