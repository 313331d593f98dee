"""Settled stick-slip of the larger chain, and what its committed tables say."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from chains import SLIDER
from places import committed
from settings import CONFIG

from maegawa2010.studies.larger.cycles import (
    beside_law,
    run_past,
    settled_study,
    with_past,
)
from maegawa2010.studies.larger.first_slips import larger_tables
from precursors import TransitionLimitError
from precursors.larger.chain import LargerChain, weakening_velocity
from precursors.larger.settled import events_of, settled
from precursors.larger.simulate import simulate_larger
from precursors.larger.steps import SETTLED, period_of

# A run that ends when it has settled is this near [F_Z] to one that goes on.
GOES_ON = 3 * SETTLED
BLOCKS = (
    0.005  # of the peak, from 50 to 100 blocks: 4 to 7 of 50 lie in the shortest l_c
)
# Loads of runs of seconds differ by so much with the processor; a run in which a slip
# goes another way differs by a whole event, 0.01.
MACHINE = 1e-3


def chain_of(n, part, t_v, theta=0):
    chain = SLIDER(n, theta=theta)
    return LargerChain(chain, weakening_velocity(SLIDER(), part, t_v), t_v)


@pytest.mark.parametrize(
    ("peaks", "period"),
    [
        ([1, 5, 5, 5, 5, 5], 1),
        ([5, 5, 5, 5], 0),  # three comparisons are not enough
        ([1, 5, 6, 5, 6, 5, 6], 2),
        ([5, 6, 7, 5, 6, 7, 5, 6, 7], 3),
        ([5, 5, 5, 5, 5.2], 0),
        ([], 0),
    ],
)
def test_the_period_is_that_of_the_last_peaks(peaks, period):
    assert period_of(np.array(peaks, float), 0.1) == period


@pytest.mark.parametrize("theta", ["-5/6", 0])
def test_a_settled_run_ends_early_with_the_peaks_of_one_that_goes_on(theta):
    larger = chain_of(14, 0.3, 2e-4, theta)
    early = simulate_larger(larger, 20.0, "settled", 0.25)
    late = events_of(simulate_larger(larger, 20.0, step=0.25), 0.3).query("is_global")
    found = settled(early, 0.3)
    assert early.duration < 15.0
    assert found["period"] > 0
    later_half = late.loc[late["onset"] > 10.0, "peak"]
    assert later_half.mean() == pytest.approx(found["coefficient"], abs=GOES_ON)


def test_without_enough_global_slips_nothing_settles():
    found = settled(simulate_larger(chain_of(10, 0.2, 2e-4), 1.0), 0.2)
    assert len(found["peaks"]) == found["period"] == 0
    assert np.isnan(found["coefficient"])


def test_a_strained_chain_rests_and_loads_with_noise_keep_their_sum():
    chain = SLIDER(30, theta="5/6")
    drawn, forces = with_past(chain, (0.1, 1.0), np.random.default_rng(1))
    net = forces - np.append(forces[1:], 0.0)
    assert forces[0] == 0.0
    assert abs(net).max() > 0.5 * abs(chain.strength).min()
    assert (abs(net) <= chain.strength * (1.0 + 1e-12)).all()
    assert drawn.weights.sum() == pytest.approx(chain.weights.sum(), rel=1e-12)
    assert abs(drawn.weights / chain.weights - 1.0).max() > 0.05


def test_a_block_exactly_at_its_limit_does_not_stop_the_clock():
    """It would be released and stop before it moves: in turn, without end."""
    larger = chain_of(100, 0.3, 2e-5)
    random = np.random.default_rng([2018, 1])
    chain, forces = with_past(larger.chain, (0.01, 0.0), random)
    drawn = replace(larger, chain=chain)
    with pytest.raises(TransitionLimitError, match="limit of work") as stopped:
        simulate_larger(drawn, 20.0, step=0.25, max_transitions=30, start_forces=forces)
    assert stopped.value.run.duration > 1.0


def test_energy_of_a_strained_start_is_counted():
    larger = chain_of(10, 0.2, 1e-4)
    forces = with_past(larger.chain, (0.0, 1.0), np.random.default_rng(1))[1]
    run = simulate_larger(larger, 2.0, step=0.1, start_forces=forces)
    assert abs(run.numbers["energy_error"]) < 1e-6
    with pytest.raises(ValueError, match="shape"):
        simulate_larger(larger, 2.0, start_forces=[0.0, 0.0])


def test_chains_outside_the_limits_of_the_law_are_left_out():
    study = {"theta": [0], "n_blocks": [50], "pasts": [[0, 0.5]]}
    study |= {"even_length": [0.05, 0.2], "relaxation_time": [4e-4]}
    settings = {"seed": 1, "duration": 20, "studies": {"map": study}, "drawn": []}
    members = settled_study(CONFIG["chain"], settings).members
    assert members["even_length"].tolist() == [0.2]


def test_drawn_chains_with_a_soft_drive_run_longer():
    settings = {"seed": 1, "duration": 20, "studies": {}}
    drawn = [{"chains": 9, "n_blocks": 50, "step": 0.5}]
    members = settled_study(CONFIG["chain"], settings | {"drawn": drawn}).members
    rise = members["duration"] * members["drive_stiffness"]
    np.testing.assert_allclose(rise, 20 * CONFIG["chain"]["drive_stiffness"])
    assert len(set(members["loading"])) > 1


def test_the_committed_first_slips_are_those_of_the_library():
    point = {"even_length": [0.3], "relaxation_time": [1e-4], "theta": ["-5/6"]}
    point["n_blocks"] = [50]
    settings = CONFIG["larger"]["first_slips"]
    settings = settings | {"nucleation": point, "studies": {"counts": point}}
    for name, again in larger_tables(CONFIG["chain"], settings).items():
        keys = ["study", "even_length", "relaxation_time", "theta", "n_blocks"]
        there = again[keys].merge(committed(f"{name}_full"), on=keys)[list(again)]
        pd.testing.assert_frame_equal(there, again, rtol=MACHINE)


def test_the_committed_coefficients_are_those_of_the_library():
    point = {"even_length": [0.27], "relaxation_time": [1.4e-4], "theta": ["-5/6"]}
    settings = CONFIG["larger"]["settled"]
    map_of_one = settings["studies"]["map"] | point
    settings = settings | {"studies": {"map": map_of_one}, "drawn": []}
    study = settled_study(CONFIG["chain"], settings)
    strained = study.members.query("past == 2")
    there = strained[["study", "past", *point]].merge(committed("larger_settled_full"))
    again = run_past(study.seed, strained.iloc[0])["coefficient"]
    assert there["coefficient"].tolist() == pytest.approx([again], abs=MACHINE)


def test_the_committed_law_is_that_of_the_library_and_gives_the_coefficients():
    there = committed("larger_settled_full")
    some = there[there["past"] == 0].iloc[::40]
    of_runs = some.loc[:, :"slope"]
    pd.testing.assert_frame_equal(beside_law(of_runs, CONFIG["chain"]), some, rtol=1e-9)
    runs = there[there["period"] > 0]
    miss = runs["coefficient"] - runs["law_coefficient"]
    assert np.sqrt((miss**2).mean()) < 0.0023
    right = (runs["predicted_precursors"] - runs["precursors"]).abs() < 0.05
    assert right.mean() > 0.85
    assert (there["coefficient"] > there["mu_k"]).all()


def settled_runs(study):
    return committed("larger_settled_full").query(f"study == '{study}' and period > 0")


@pytest.mark.parametrize(
    ("study", "most"), [("finer", BLOCKS), ("half_step", 1e-3)], ids=["N", "step"]
)
def test_coefficients_hardly_depend_on_blocks_or_step_where_n_is_the_same(study, most):
    """Which cycle a run takes may depend on both."""
    chain = ["even_length", "relaxation_time", "theta", "past"]
    both = settled_runs(study).merge(settled_runs("map"), on=chain)
    same = both.query("precursors_x == precursors_y and relaxation_time > 4e-5")
    assert len(same) > 10
    assert abs(same["coefficient_x"] - same["coefficient_y"]).max() < most
