"""The rows of a study equal those of single runs and do not depend on the chunks."""

import math

import numpy as np
import pandas as pd
import pytest
from settings import SLIDERS

from maegawa2010.studies.members import (
    LEFT_OUT,
    Study,
    chain_of,
    gather,
)
from maegawa2010.studies.noise.tables import noise_study
from maegawa2010.studies.runs import run_members, speedup
from precursors import simulate
from precursors.analysis.summary import summarise
from precursors.support.files import read_table, write_table


def noise_of(runs: int) -> Study:
    return noise_study(SLIDERS, 10.0, {"seed": 1, "runs": runs})


@pytest.fixture(scope="module")
def noise() -> Study:
    return noise_of(runs=12)


@pytest.fixture(scope="module")
def rows(noise) -> pd.DataFrame:
    return run_members(noise)


def chunks_of(study: Study, n: int, directory) -> list:
    paths = [directory / f"{i}of{n}.csv" for i in range(1, n + 1)]
    for i, path in enumerate(paths, 1):
        write_table(
            run_members(study.chunk(i, n)).rename_axis("member").reset_index(), path
        )
    return [read_table(path) for path in paths]


def one_by_one(study: Study) -> pd.DataFrame:
    """Summaries of the members of a study, each simulated alone."""
    runs = []
    for member in study.members.to_dict("records"):
        runs.append(
            simulate(chain_of(member, study.seed), member["duration"], "global slip")
        )
    return summarise(runs)


def assert_rows(rows: pd.DataFrame, expected: np.ndarray) -> None:
    for name in expected:
        np.testing.assert_array_equal(rows[name], expected[name], err_msg=name)


def test_every_row_equals_that_of_a_single_run(noise, rows):
    some = noise.chunk(1, 7)
    assert_rows(rows.loc[some.members.index], one_by_one(some))


@pytest.mark.parametrize("n", [2, 5])
def test_the_joined_table_does_not_depend_on_the_chunks(noise, rows, n, tmp_path):
    chunks = chunks_of(noise, n, tmp_path)
    table = gather(chunks[::-1])
    pd.testing.assert_frame_equal(table, rows[list(table)], check_exact=True)
    assert set(rows) - set(table) <= LEFT_OUT


def test_more_chunks_than_members_leave_some_empty(noise, tmp_path):
    few = Study(noise.members.iloc[:2], noise.seed)
    assert len(gather(chunks_of(few, 3, tmp_path))) == 2


def test_a_missing_or_doubled_chunk_is_refused(noise, tmp_path):
    few = Study(noise.members.iloc[:4], noise.seed)
    a, b = chunks_of(few, 2, tmp_path)
    for chunks in ([a], [b], [a, a], [a, b, b]):
        with pytest.raises(ValueError, match="must have every member"):
            gather(chunks)


def test_members_have_their_own_blocks_noise_and_duration():
    table = {
        "n_blocks": [4, 4, 6],
        "theta": 0.0,
        "load_noise": [0.0, 0.5, 0.5],
        "duration": [1.0, 2.0, 1.0],
        "group": 0,
        "draw": [0, 1, 2],
    }
    study = Study(pd.DataFrame(table))
    assert_rows(run_members(study), one_by_one(study))


def test_a_member_at_the_limit_of_transitions_has_its_part(noise, rows, monkeypatch):
    def capped(chains, duration, until, threads):
        return [
            simulate(chain, duration, until, max_transitions=100) for chain in chains
        ]

    monkeypatch.setattr("maegawa2010.studies.runs.simulate_many", capped)
    cut = run_members(Study(noise.members.query("scene == 'fig12'"), noise.seed))
    longer = rows.loc[cut.index, "transitions"] > 100
    assert (
        cut["transitions"] == rows.loc[cut.index, "transitions"].clip(upper=100)
    ).all()
    assert (cut["global_slip_end_s"].isna() == longer).all()
    assert longer.sum() > 0


def test_a_larger_ensemble_contains_the_smaller(noise):
    for few, many in zip(
        noise.members.groupby("scene"),
        noise_of(runs=20).members.groupby("scene"),
        strict=True,
    ):
        small, large = (table.head(13).to_dict("records") for _, table in (few, many))
        assert [chain_of(member, 1) for member in small] == [
            chain_of(member, 1) for member in large
        ]


@pytest.mark.parametrize(
    ("fronts", "expected"),
    [
        ([1, 4, 7, 9, 10], (3 / 20) / (6 / 20)),
        ([1, 4, 9, 7, 10], (3 / 10) / (6 / 30)),  # with a shorter event
        ([1, 4, 7, 9, 9], math.nan),  # the whole length is not reached
        ([7, 7, 7, 10, 10], math.nan),  # no rise up to the kink
    ],
)
def test_growth_beyond_the_kink_uses_counted_events(fronts, expected):
    loads = np.arange(10.0, 60.0, 10.0)
    slips = pd.DataFrame({"front": fronts, "load_before_N": loads, "n_blocks": 10})
    slips = slips.assign(counted=True, is_global=True)
    assert speedup(slips.to_records(index=False)) == pytest.approx(
        expected, nan_ok=True
    )
