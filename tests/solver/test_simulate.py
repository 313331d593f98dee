"""The solver: agreement with proofs, the ends of runs, and limiting cases of the
model."""

import math

import numpy as np
import pytest
from chains import SLIDER, by_plain, first_transitions, lone_slip

from precursors import TransitionLimitError, apparent_friction, find_slips, simulate
from precursors.audit import audit
from precursors.benchmark.score import problems, solution
from precursors.model.statics import maximal_strain_positions

# Errors of times [s]: 4e-14 was measured up to the end of the first global slip and 3e-9
# at 10 s. One rounding of the weights changes exact times by 1e-12 and 3e-8.
TO_GLOBAL_SLIP = 1e-12
TO_THE_END = 3e-8
# Errors of loads [N]: 3e-12 and 2e-5 were measured. In a slip, loads change at up to 1e5
# N/s.
LOAD_TO_GLOBAL_SLIP = 1e-10
LOAD_TO_THE_END = 1e-4
ROUNDING = 4e-15  # relative, some ten roundings
# A rounding error of the spring forces, divided by their rate, is 1e-12 of a slip.
SLIP_ROUNDING = 1e-11


@pytest.mark.parametrize("problem", problems())
def test_run_agrees_with_every_proved_transition(problem):
    truth = solution(problem)
    # Later in this run, rounding decides the order; its horizon predicts this.
    if problem == "fast_drive":
        truth = truth.until_global_slip()
    run = simulate(truth.run.chain, truth.run.duration)
    transitions = run.transitions
    true = truth.run.transitions
    assert transitions[["block", "mode"]].tolist() == true[["block", "mode"]].tolist()
    early = true["time"] <= truth.until_global_slip().run.duration
    error = abs(transitions["time"] - true["time"])
    assert error[early].max() < TO_GLOBAL_SLIP
    assert error.max() < TO_THE_END
    error = abs(transitions["tangential_load"] - true["tangential_load"])
    assert error[early].max() < LOAD_TO_GLOBAL_SLIP
    assert error.max() < LOAD_TO_THE_END


def test_rounding_does_not_accumulate_over_10000_slips():
    """Between two slips the load rises by 2 (mu_s - mu_k) F_Z."""
    chain = SLIDER(n_blocks=1)
    stick = 2 * (chain.mu_s - chain.mu_k) * chain.normal_load / chain.loading_rate
    run = first_transitions(chain, 20_000, duration=1e6)
    expected = 3.5 + np.arange(10_000) * (stick + lone_slip(chain)[0])
    np.testing.assert_allclose(run.transitions["time"][::2], expected, rtol=ROUNDING)
    np.testing.assert_allclose(
        run.intervals[1::2], lone_slip(chain)[0], rtol=SLIP_ROUNDING
    )
    assert math.fsum(run.intervals) == pytest.approx(run.duration, rel=ROUNDING)


def test_transition_limit_returns_the_run_so_far():
    most = 100
    with pytest.raises(TransitionLimitError, match="max_") as error:
        simulate(SLIDER(), duration=10.0, max_transitions=most)
    run = error.value.run
    last = run.transitions[-1]
    np.testing.assert_array_equal(
        run.transitions, simulate(SLIDER()).transitions[:most]
    )
    assert run.duration == pytest.approx(last["time"], rel=ROUNDING)
    assert run.tangential_load([run.duration]) == pytest.approx(
        last["tangential_load"], rel=1e-12
    )


def test_endless_sliding_reaches_the_work_limit(monkeypatch):
    monkeypatch.setattr("precursors.solver.simulate.MAX_WINDOWS", 1000)
    monkeypatch.setattr("precursors.solver.batch.WINDOWS_PER_CALL", 400)
    with pytest.raises(
        TransitionLimitError, match=r"^1000 steps .* at t = \S+ s of 1 s.*shorten"
    ) as error:
        simulate(SLIDER(2, mu_s=0.0, mu_k=0.0), duration=1.0)
    audit(error.value.run).raise_if_failed()


def test_until_global_slip_stops_there_or_at_the_duration():
    whole = simulate(SLIDER(theta="-5/6")).transitions
    run = simulate(SLIDER(theta="-5/6"), until="global slip")
    slips = find_slips(run)
    assert slips["is_global"].to_numpy().nonzero()[0].tolist() == [len(slips) - 1]
    assert run.duration == slips["end"].iloc[-1]
    shorter = simulate(SLIDER(theta="-5/6"), duration=1.0, until="global slip")
    assert shorter.duration == 1.0
    for transitions in (run.transitions, shorter.transitions):
        np.testing.assert_array_equal(transitions, whole[: len(transitions)])


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"duration": 0.0}, "duration must be above 0 s, but is 0.0"),
        ({"until": "slip"}, "until must be None or \"global slip\", but is 'slip'"),
        (
            {"max_transitions": 0},
            "max_transitions must be a whole number of at least 1, but is 0",
        ),
        (
            {"start_positions": [0.0] * 9},
            "start_positions must have shape (10,), one number [m] per block",
        ),
        (
            {"start_velocities": [math.inf] * 10},
            "start_velocities must be finite, and not beyond 1e+60 m/s",
        ),
    ],
)
def test_a_bad_argument_is_named_in_one_line(options, words):
    with pytest.raises(ValueError, match=r"^[^\n]+$") as error:
        simulate(SLIDER(), **options)
    assert words in str(error.value)


@pytest.mark.parametrize("changes", [{}, {"theta": 1.0}, {"mu_k": 0.7}], ids=str)
@pytest.mark.parametrize("n_blocks", [2, 10, 50])
def test_all_blocks_at_their_limit_slip_in_one_event(n_blocks, changes):
    """Eq. 15, also with a weightless block and with mu_s = mu_k."""
    chain = SLIDER(n_blocks, **changes)
    run = simulate(chain, 1e-3, "global slip", maximal_strain_positions(chain))
    assert find_slips(run)["front"].iloc[0] == n_blocks
    # A weightless block 1 moves earlier.
    exact = 1e-8 if changes == {"theta": 1.0} else 1e-12
    assert run.transitions["tangential_load"][0] == pytest.approx(280.0, rel=exact)
    audit(run).raise_if_failed()


@pytest.mark.parametrize(
    "weights",
    [[50] * 4 + [0] * 2 + [50] * 4, SLIDER(theta=1).weights],
    ids=["groove", "theta = 1"],
)
def test_weightless_blocks_do_not_prolong_events(weights):
    """mu_sapp is close to that with 0.01 N on these blocks; the motion is chaotic."""
    run = simulate(SLIDER(weights=weights), until="global slip")
    slips = find_slips(run)
    last = slips.iloc[-1]
    assert slips["is_global"].sum() == last["is_global"] == 1
    assert last[["front", "n_slid", "n_simultaneous"]].tolist() == [10] * 3
    assert last["end"] == run.duration
    assert (slips["end"] - slips["onset"]).max() < 1e-3
    loaded = simulate(SLIDER(weights=np.maximum(weights, 0.01)), until="global slip")
    assert apparent_friction(run) == pytest.approx(apparent_friction(loaded), abs=0.1)


def test_until_global_slip_ignores_nearly_weightless_blocks():
    """A block with a millionth of the mean load still slides after the global slip."""
    weights = np.full(5, 80.0)
    weights[4] = 1e-6 * 80.0
    chain = SLIDER(weights=weights)
    run = simulate(chain, until="global slip")
    assert not chain.bears_load[4]
    assert run.at(run.duration)[1][0, 4] != 0.0
    slips = find_slips(simulate(chain, 1.01 * run.duration))
    assert run.duration == slips.loc[slips["is_global"], "end"].iloc[0]
    rows, end = by_plain(chain, 10.0, until_global=True)
    assert len(rows) == len(run.transitions)
    assert end == pytest.approx(run.duration, abs=TO_GLOBAL_SLIP)


def test_weightless_block_rests_until_it_is_pushed():
    """So a day before the first slip costs no more work with a slow drive."""
    run = simulate(SLIDER(theta=-1, drive_velocity=1e-9), 86400.0)
    assert run.transitions["block"].tolist() == [1, 1]
    assert run.at(86400.0)[1][0, -1] == 0.0
