"""Straight lines between the points of the load curve draw it, and its largest load is the largest."""

import numpy as np
import pytest

from precursors import Chain, find_slips, simulate
from precursors.analysis.load_curve import TOLERANCE_N, load_curve, load_trace
from precursors.analysis.peak_load import largest_load, longest_step
from precursors.analysis.slips import DEFINITIONS, apparent_friction
from precursors.analysis.summary import summarise

# Points stand closer than the bound on the deviation asks for, which is of second order in their distance.
ALLOWED_N = TOLERANCE_N
# Some thirty points on the shortest wiggle of a slip.
POINTS_PER_SLIP = 1000
# Samples a tenth of the curve's own step apart miss a maximum by (pi/20)^2/8 of a swing of 1 N.
MISSED_BY_DENSE_SAMPLES_N = 5e-3
ROUNDING_N = 1e-9
MOST_BYTES = 3e6

INTERFACES = [{"interface_stiffness": 25e6}, {"interface_stiffness": 25e6, "viscosity": 54.77}]


def worst_in_slips(run, times, loads):
    """Largest deviation of the straight lines from F_X in any slip [N]."""
    slips = find_slips(run)
    inside = np.linspace(slips["onset"], slips["end"].fillna(run.duration), POINTS_PER_SLIP).T.ravel()
    return np.abs(np.interp(inside, times, loads) - run.tangential_load(inside)).max()


@pytest.fixture(scope="module", params=INTERFACES, ids=["undamped", "damped"])
def elastic(request):
    """A run to its first global slip on an elastic interface, and its slips."""
    run = simulate(Chain.from_slider(**request.param), 10.0, until="global slip")
    return run, find_slips(run)


@pytest.mark.parametrize("theta", [-5 / 6, 0.0, 5 / 6])
def test_straight_lines_between_the_rows_of_a_trace_draw_every_slip_of_ten_seconds(theta):
    run = simulate(Chain.from_slider(theta=theta), 10.0)
    trace = load_trace(run)
    assert worst_in_slips(run, *trace.to_numpy().T) <= ALLOWED_N
    assert len(trace.to_csv(index=False)) < MOST_BYTES


@pytest.mark.parametrize("addition", [{"viscosity": 54.77}, {"head_mass": 0.3122}, {"n_blocks": 1}])
def test_they_do_so_for_other_chains(addition):
    run = simulate(Chain.from_slider(**addition), 4.0)
    assert worst_in_slips(run, *load_curve(run)) <= ALLOWED_N


def test_a_run_that_ends_within_a_slip_is_drawn_to_its_end():
    event = find_slips(simulate(Chain.from_slider(), 3.0)).iloc[0]
    run = simulate(Chain.from_slider(), float((event.onset + event.end) / 2))
    times, loads = load_curve(run)
    assert times[-1] == run.duration
    assert worst_in_slips(run, times, loads) <= ALLOWED_N


def test_points_stand_where_something_happens():
    run = simulate(Chain.from_slider(), 3.0)
    times, _ = load_curve(run)
    slips = find_slips(run)
    event = np.searchsorted(slips["onset"], times, side="right") - 1
    in_slip = (event >= 0) & (times <= slips["end"].to_numpy()[event])
    assert (~in_slip).sum() == 2  # the start and the end
    assert np.isin(run.transitions["time"], times).all()
    assert (np.diff(times) > 0).all()


def test_a_looser_tolerance_has_fewer_points_and_holds():
    run = simulate(Chain.from_slider(), 3.0)
    few, many = load_curve(run, 1e-2), load_curve(run)
    assert len(few[0]) < len(many[0])
    assert worst_in_slips(run, *few) <= 1e-2


def test_on_an_elastic_interface_the_band_between_slips_holds_the_curve(elastic):
    run, slips = elastic
    times, loads = load_curve(run)
    assert worst_in_slips(run, times, loads) <= ALLOWED_N
    start, end = slips["end"].iloc[-3], slips["onset"].iloc[-2]
    piece = np.linspace(end - (end - start) / 20, end, 20_000)
    inside = (times >= piece[0]) & (times <= end)
    exact = run.tangential_load(piece)
    assert inside.sum() > 4
    assert abs(loads[inside].max() - exact.max()) < 0.1 * np.ptp(exact)
    assert np.ptp(exact) > 100 * ALLOWED_N


def test_the_largest_load_on_an_elastic_interface_is_that_of_dense_samples(elastic):
    run, slips = elastic
    onset = float(slips["onset"][slips["is_global"]].iloc[0])
    time, load = largest_load(run, slips, onset)
    step = longest_step(run.chain) / 10
    # The load is largest in the last rest but a few: samples of all would take a minute.
    sampled = np.arange(onset - 0.1, onset, step)
    highest = max(run.tangential_load(part).max() for part in np.array_split(sampled, 10))
    assert highest - ROUNDING_N <= load <= highest + MISSED_BY_DENSE_SAMPLES_N
    assert time <= onset
    _, velocities = run.at([time])
    # dF_X/dt = K (V - v_1) = 0: the drive and block 1 are equally fast.
    assert velocities[0, 0] == pytest.approx(run.chain.drive_velocity, abs=1e-6)


def test_mu_sapp_on_an_elastic_interface_is_above_the_largest_load_of_a_transition(elastic):
    run, slips = elastic
    found = apparent_friction(run, slips)
    assert found.load > run.transitions["tangential_load"].max() + 0.1
    assert found.mu_sapp == found.load / 400
    assert found.load == pytest.approx(run.tangential_load([found.time])[0], abs=ROUNDING_N)
    [summary] = summarise([run])
    assert (summary["mu_sapp"], summary["load"]) == (found.mu_sapp, found.load)
    assert summary["events_kept"] == found.events_kept
    at_onset = apparent_friction(run, slips, DEFINITIONS[1])
    assert at_onset.load == slips["load_before"][slips["is_global"]].iloc[0]


def test_on_a_rigid_interface_the_largest_load_is_a_transitions():
    run = simulate(Chain.from_slider(theta="5/6"), 3.0)
    slips = find_slips(run)
    time, load = largest_load(run, slips, 3.0)
    assert load == run.transitions["tangential_load"].max()
    assert time in run.transitions["time"]
