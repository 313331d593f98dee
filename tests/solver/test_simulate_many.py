"""Ensembles: `simulate_many` gives the runs of `simulate`."""

import numpy as np
import pytest
from chains import SLIDER

from precursors import Chain, Run, simulate, simulate_many
from precursors.solver import batch as solver

ROUNDING = 1e-12  # relative to the largest position or velocity
# Limit of the stored states that long runs exceed [bytes].
ROOM = 2**18


def same(one: Run, other: Run) -> bool:
    """Whether two runs agree in every bit."""
    columns = [(run.transitions, run.intervals, *run.states) for run in (one, other)]
    return (
        one.chain == other.chain
        and one.duration == other.duration
        and one.evaluations == other.evaluations
        and all(
            a.shape == b.shape and (a == b).all() for a, b in zip(*columns, strict=True)
        )
    )


def mixed() -> list[Chain]:
    """Make 64 chains of several lengths and loads; four have more transitions than the
    record of a thread holds."""
    fast = {(10, j): 2e-2 for j in range(2, 16, 4)}
    return [
        SLIDER(n, theta=j / 16, drive_velocity=fast.get((n, j), 1e-4))
        for j in range(16)
        for n in (1, 10, 30, 3)
    ]


@pytest.mark.parametrize("until", [None, "global slip"])
def test_ensemble_equals_its_chains_run_one_by_one(until):
    chains = mixed()
    runs = simulate_many(chains, duration=1.0, until=until, threads=2)
    assert until or max(len(run.transitions) for run in runs) > solver.SHARED_ROOM
    assert all(
        same(run, simulate(chain, 1.0, until))
        for run, chain in zip(runs, chains, strict=True)
    )


def test_stored_states_are_thinned_without_changing_the_motion(monkeypatch):
    chains = [chain for chain in mixed() if chain.drive_velocity > 1e-4]
    runs = simulate_many(chains, 1.0, threads=2)
    times = np.linspace(0.0, 1.0, 200)
    monkeypatch.setattr(solver, "STATES_BYTES", ROOM)
    for run, thin in zip(runs, simulate_many(chains, 1.0, threads=2), strict=True):
        stored, whole = (sum(c.nbytes for c in of.states) for of in (thin, run))
        assert stored <= ROOM < whole
        assert np.median(np.diff(run.states.after)) == 10
        apart = np.diff(thin.states.after)
        assert 1 < apart.max() <= 2 * apart.min()
        np.testing.assert_array_equal(thin.transitions, run.transitions)
        for interpolated, known in zip(thin.at(times), run.at(times), strict=True):
            np.testing.assert_allclose(
                interpolated, known, rtol=0, atol=ROUNDING * abs(known).max()
            )


def test_runs_do_not_depend_on_pauses_of_the_kernel(monkeypatch):
    chains = mixed()[:16]
    runs = simulate_many(chains, 1.0, threads=1)
    monkeypatch.setattr(solver, "SHARED_ROOM", 16)
    monkeypatch.setattr(solver, "WINDOWS_PER_CALL", 100)
    again = simulate_many(chains, 1.0, threads=1)
    assert all(same(one, other) for one, other in zip(again, runs, strict=True))


def test_each_chain_starts_from_its_own_start():
    chains = [SLIDER(3), SLIDER(2)]
    positions = [np.array([1e-6, 0.0, -1e-6]), np.array([0.0, 2e-6])]
    velocities = [[1e-3, 0.0, 0.0], [0.0, 0.0]]
    runs = simulate_many(
        chains, 0.5, start_positions=positions, start_velocities=velocities
    )
    for run, chain, x, v in zip(runs, chains, positions, velocities, strict=True):
        assert same(run, simulate(chain, 0.5, start_positions=x, start_velocities=v))
        np.testing.assert_array_equal(run.start_positions, x)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"threads": 0}, "threads must be a whole number from 1 to 1024, but is 0"),
        ({"threads": 1025}, "must be a whole number from 1 to 1024, but is 1025"),
        (
            {"start_positions": []},
            "start_positions must be one for each of the 2 chains, but are 0",
        ),
        (
            {"start_velocities": [[0.0] * 10, [0.0]]},
            "start_velocities[1] must have shape (10,)",
        ),
    ],
)
def test_a_bad_argument_is_named_in_one_line(options, words):
    with pytest.raises(ValueError, match=r"^[^\n]+$") as error:
        simulate_many([SLIDER(), SLIDER()], **options)
    assert words in str(error.value)


def test_chains_may_be_a_generator_and_others_are_refused():
    chain = SLIDER()
    assert simulate_many([]) == []
    assert len(simulate_many(chain for _ in range(3))) == 3
    with pytest.raises(TypeError, match="needs a list of chains, but got a Chain"):
        simulate_many(chain, 0.5)
    with pytest.raises(TypeError, match=r"^simulate needs a Chain, but got i"):
        simulate_many([chain, 5])
