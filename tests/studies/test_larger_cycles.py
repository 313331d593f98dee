"""Settled stick-slip of the larger chain, and what its committed tables say."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from chains import SLIDER
from settings import CONFIG, FULL

from maegawa2010.studies.larger.cycles import (
    cycles_table,
    run_past,
    with_past,
)
from maegawa2010.studies.larger.first_slips import (
    POINT,
    STEP,
    as_logged,
    medians_table,
    run_draw,
    run_studies,
)
from precursors import TransitionLimitError
from precursors.larger.chain import (
    LargerChain,
    simulate_larger,
    weakening_velocity,
)
from precursors.larger.settled import peaks_of, settled
from precursors.larger.steps import SETTLED, period_of

ROOT = Path(__file__).parents[2]
COARSE, FINE = 50, 100
# A run that ends when it has settled is this near [F_Z] to one that goes on.
GOES_ON = 3 * SETTLED
# Loads of runs of seconds differ by so much with the processor; a run in which a slip
# goes another way differs by a whole event, 0.01.
MACHINE = 1e-3


def chain_of(n, part, t_v, theta=0):
    chain = SLIDER(n, theta=theta)
    return LargerChain(chain, weakening_velocity(SLIDER(), part, t_v), t_v)


def committed(name):
    return pd.read_csv(ROOT / f"paper/tables/{name}_full.csv")


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


@pytest.mark.parametrize("theta", ["-5/6", 0, "5/6"])
def test_a_settled_run_ends_early_with_the_peaks_of_one_that_goes_on(theta):
    larger = chain_of(20, 0.3, 2e-4, theta)
    early = simulate_larger(larger, 20.0, "settled", 0.25)
    late = peaks_of(simulate_larger(larger, 20.0, step=0.25), 0.3)
    found = settled(early, 0.3)
    assert early.duration < 15.0
    assert found["period"] > 0
    later_half = late.loc[late["onset"] > 10.0, "peak"]
    assert later_half.mean() == pytest.approx(found["coefficient"], abs=GOES_ON)
    assert found["state_error"] < 10 * SETTLED


def test_without_enough_global_slips_nothing_settles():
    found = settled(simulate_larger(chain_of(10, 0.2, 2e-4), 1.0), 0.2)
    assert len(found["peaks"]) == found["period"] == 0
    assert np.isnan(found["coefficient"])


def test_a_strained_chain_rests_and_loads_with_noise_keep_their_sum():
    larger = chain_of(30, 0.2, 1e-4, "5/6")
    drawn, forces = with_past(larger, (0.1, 1.0), np.random.default_rng(1))
    net = forces - np.append(forces[1:], 0.0)
    assert forces[0] == 0.0
    assert abs(net).max() > 0.5 * abs(larger.chain.strength).min()
    assert (abs(net) <= larger.chain.strength * (1.0 + 1e-12)).all()
    weights = larger.chain.weights
    assert drawn.chain.weights.sum() == pytest.approx(weights.sum(), rel=1e-12)
    assert abs(drawn.chain.weights / weights - 1.0).max() > 0.05


def test_a_study_may_have_a_step():
    study = {"pairs": [[0.2, 1e-4]], "theta": [0], "n_blocks": [10]}
    for step, expected in (({}, STEP), ({"step": 0.125}, 0.125)):
        rows = run_studies(
            CONFIG["chain"],
            {"some": study | step},
            lambda point, larger, step, draw: {"step": step},
        )
        assert rows["step"].tolist() == [expected]


def test_no_full_study_of_long_chains_has_a_coarse_step():
    for part in ("first_slips", "cycles"):
        here, full = (of["larger"][part]["studies"] for of in (CONFIG, FULL))
        for name, study in full.items():
            step = (here.get(name, {}) | study).get("step", STEP)
            assert step <= (0.1 if max(study["n_blocks"]) >= 200 else 0.25)
            assert step <= 0.01 or min(study["pairs"])[0] > 0


def test_a_block_exactly_at_its_limit_does_not_stop_the_clock():
    """It would be released and stop before it moves: in turn, without end."""
    v_c = weakening_velocity(SLIDER(), 0.3, 2e-5)
    larger = LargerChain(SLIDER(n_blocks=100), v_c, 2e-5)
    drawn, forces = with_past(larger, (0.01, 0.0), np.random.default_rng([2018, 1]))
    with pytest.raises(TransitionLimitError, match="limit of work") as stopped:
        simulate_larger(drawn, 20.0, step=0.25, max_transitions=30, start_forces=forces)
    assert stopped.value.run.duration > 1.0


def test_energy_of_a_strained_start_is_counted():
    larger = chain_of(10, 0.2, 1e-4)
    forces = with_past(larger, (0.0, 1.0), np.random.default_rng(1))[1]
    run = simulate_larger(larger, 2.0, step=0.1, start_forces=forces)
    assert abs(run.numbers["energy_error"]) < 1e-6
    with pytest.raises(ValueError, match="shape"):
        simulate_larger(larger, 2.0, start_forces=[0.0, 0.0])


def test_cycles_are_told_apart_and_counted():
    point = dict.fromkeys(POINT, 0)
    values = [0.48, 0.481, 0.482, 0.51]
    runs = pd.DataFrame([point | {"coefficient": value} for value in values])
    runs = runs.assign(period=[1, 2, 0, 1], state_error=0.0, theory=0.5, precursors=0)
    table = cycles_table(runs)
    assert table["share"].tolist() == [0.75, 0.25]
    assert table["coefficient"].tolist() == [0.481, 0.51]
    assert table["periodic"].tolist() == pytest.approx([2 / 3, 1.0])


def test_a_logger_takes_two_events_within_its_sample_for_one():
    slips = pd.DataFrame(
        {
            "onset": [1.0, 1.0015, 2.0],
            "end": [1.001, 1.002, 2.001],
            "load_before": [5.0, 4.0, 6.0],
            "load_after": [4.0, 3.0, 5.5],
            "front": [3, 4, 2],
            "is_global": [False, True, False],
        }
    )
    logged = as_logged(slips)
    assert logged["front"].tolist() == [4, 2]
    assert logged["load_after"].tolist() == [3.0, 5.5]


@pytest.mark.xfail(reason="the tables were made with leaps over creep", run=False)
def test_the_committed_runs_of_few_blocks_are_those_of_the_library():
    common = CONFIG["larger"]["first_slips"]
    study = (
        common["studies"]["counts"] | FULL["larger"]["first_slips"]["studies"]["counts"]
    )
    study = {**study, "pairs": [[0.2, 2e-4]], "n_blocks": [COARSE]}
    runs = run_studies(CONFIG["chain"], {"counts": study}, partial(run_draw, common))
    again = medians_table(runs)
    keys = ["study", "length", "relaxation_time", "theta", "n_blocks"]
    there = again[keys].merge(committed("larger"), on=keys)
    assert len(there) == 3
    assert there["events_counted"].tolist() == again["events_counted"].tolist()
    np.testing.assert_allclose(there["mu_sapp"], again["mu_sapp"], rtol=MACHINE)


def test_the_committed_cycles_are_those_of_the_library():
    full = FULL["larger"]["cycles"]
    study = CONFIG["larger"]["cycles"]["studies"]["grid"] | full["studies"]["grid"]
    study = {**study, "pairs": [[0.3, 2e-4]], "n_blocks": [COARSE], "theta": [0]}
    common = {**CONFIG["larger"]["cycles"], **full, "pasts": full["pasts"][:2]}
    grid = {"grid": {**study, "runs": 1}}
    runs = run_studies(CONFIG["chain"], grid, partial(run_past, common), 2)
    there = committed("larger_cycles").query(
        "study == 'grid' and length == 0.3 and relaxation_time == 2e-4"
        f" and theta == 0 and n_blocks == {COARSE}"
    )
    again = runs["coefficient"].to_numpy()
    distance = np.subtract.outer(again, there["coefficient"].to_numpy())
    assert abs(distance).min(axis=1).max() < MACHINE


@pytest.mark.parametrize("n", [COARSE, FINE])
def test_creep_runs_away_within_5_percent_of_l_c_for_every_loading(n):
    table = committed("larger_nucleation").query(f"n_blocks == {n} and length >= 0.2")
    assert len(table) == 24
    assert abs(table["ratio"] - 1.0).max() < 0.05
    even = table["measured"] / table["length"]
    assert even.min() < 0.75
    assert even.max() > 1.7


def test_counts_settle_for_every_loading():
    table = committed("larger")
    table = table[table["study"].str.startswith("counts")]
    counts = table.pivot_table(
        index=["length", "relaxation_time", "theta"],
        columns="n_blocks",
        values="events_counted",
    )
    change = abs(counts[200] - counts[100])
    assert len(change) == 15
    assert (change <= 1).sum() == 14
    assert (change <= 0.1 * counts[100] + 1).all()


def cycles_of(study, n):
    """Peaks and shares of all cycles of a study at N, by pair and loading."""
    table = committed("larger_cycles").query(f"study == '{study}' and n_blocks == {n}")
    return table.set_index(["length", "relaxation_time", "theta"]).sort_index()


def moved(cycles, others):
    """Distance of each cycle to the nearest of the same chain in another table."""
    return np.array(
        [
            abs(np.atleast_1d(others.loc[chain, "coefficient"]) - peak).min()
            for chain, peak in cycles["coefficient"].items()
        ]
    )


def test_cycles_of_well_resolved_chains_do_not_depend_on_the_number_of_blocks():
    coarse = cycles_of("grid", COARSE)
    fine = cycles_of("grid", FINE)
    finest = cycles_of("grid_finest", 200)
    for cycles, others in ((coarse, fine), (fine, coarse), (finest, fine)):
        common = cycles.query(
            "share > 0.05 and length >= 0.1 and relaxation_time > 4e-5"
        )
        assert len(common) > 8
        assert moved(common, others).max() < 0.003
    several = coarse.query("length >= 0.2").groupby(level=[0, 1, 2]).size() > 1
    assert several.sum() > 4


def test_half_the_step_leaves_the_cycles_where_they_are():
    assert moved(cycles_of("half_step", COARSE), cycles_of("grid", COARSE)).max() < 1e-3


def test_the_settled_peak_falls_with_the_normal_load():
    table = committed("larger_cycles")
    of_pair = table.query("length == 0.2 and relaxation_time == 2e-4")
    main = of_pair[of_pair["share"] > 0.5]
    for n in (COARSE, FINE):
        for _, rows in main[main["n_blocks"] == n].groupby("theta"):
            peaks = rows.sort_values("normal_load")["coefficient"]
            assert len(peaks) == 4
            assert (peaks.diff().dropna() < 0.0).all()


def test_each_peak_lies_beyond_the_settled_one_and_nearer():
    peaks = committed("larger_peaks")
    changes = peaks.groupby("past")["peak"].diff()
    large = abs(changes.groupby(peaks["past"]).shift()) > 5e-4
    ratio = (changes / changes.groupby(peaks["past"]).shift())[large]
    assert len(ratio) > 30
    assert -0.75 < ratio.median() < -0.5
    assert (abs(ratio) < 1.0).mean() > 0.9
