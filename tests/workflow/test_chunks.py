"""Chunks of a study are made once, and again where they are missing or what they depend on changes."""

import re
from collections import Counter

import pytest

MAP, OTHER_MAP, SPREAD = "map_theta_friction_ratio", "map_theta_n_blocks", "spread_members"
TABLES = [f"results/tables/{study}.csv" for study in (MAP, OTHER_MAP, SPREAD)]


@pytest.fixture
def gathered(workspace):
    """A copy of the workflow in which three studies were run and gathered, with stand-ins for the scripts."""
    outcome = workspace.pretend("-c2", *TABLES)
    assert outcome.code == 0, outcome.text
    return workspace


def chunks_to_run(workspace) -> Counter:
    """How many chunks of each study `snakemake -n` lists."""
    outcome = workspace.run("-n", *TABLES)
    assert outcome.code == 0, outcome.text
    return Counter(re.findall(r"output: results/ensembles/(\w+)/[0-9]+of[0-9]+\.csv", outcome.text))


def test_every_study_is_as_many_chunks_as_the_configuration_says(workspace):
    workspace.edit("config.yaml", "chunks: 4", "chunks: 7")
    assert chunks_to_run(workspace) == {MAP: 7, OTHER_MAP: 7, SPREAD: 7}


def test_an_interrupted_study_goes_on_where_it_was_and_an_edit_renews_what_it_touches(gathered):
    assert chunks_to_run(gathered) == {}

    chunk, *others = sorted((gathered.path / "results/ensembles" / MAP).iterdir())
    assert others
    chunk.unlink()
    (gathered.path / TABLES[0]).unlink()
    assert chunks_to_run(gathered) == {MAP: 1}
    assert gathered.pretend("-c2", *TABLES).code == 0

    gathered.edit("config.yaml", "seed: 2010", "seed: 2011")
    assert chunks_to_run(gathered) == {SPREAD: 4}
    gathered.edit("config.yaml", "points: 2000", "points: 2001")
    assert chunks_to_run(gathered) == {MAP: 4, OTHER_MAP: 4, SPREAD: 4}
    assert gathered.pretend("-c2", *TABLES).code == 0
    gathered.append("src/precursors/solver/kernel/events.py", "\nEDITED = True\n")
    assert chunks_to_run(gathered) == {MAP: 4, OTHER_MAP: 4, SPREAD: 4}
