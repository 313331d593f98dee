"""Chunks of a study are made once, made up where they are missing, and renewed when the study changes."""

import re
from collections import Counter

import pytest

TABLES = [f"results/tables/{study}.csv" for study in ("map_blocks", "map_friction", "spread_members")]


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
    return Counter(re.findall(r"output: results/ensembles/(\w+)/[0-9]+-[0-9]+\.h5", outcome.text))


def test_smaller_chunks_are_more_chunks(workspace):
    before = chunks_to_run(workspace)
    workspace.edit("config.yaml", "seconds_per_chunk: 15.0", "seconds_per_chunk: 3.0")
    after = chunks_to_run(workspace)
    assert set(after) == {"map_blocks", "map_friction", "spread_members"}
    assert all(after[study] > before[study] for study in after)


def test_an_interrupted_study_goes_on_where_it_was_and_an_edit_renews_what_it_touches(gathered):
    assert chunks_to_run(gathered) == {}

    chunk, *others = sorted((gathered.path / "results/ensembles/map_blocks").iterdir())
    assert others
    chunk.unlink()
    (gathered.path / "results/tables/map_blocks.csv").unlink()
    assert chunks_to_run(gathered) == {"map_blocks": 1}
    assert gathered.pretend("-c2", *TABLES).code == 0

    gathered.edit("config.yaml", "friction_ratio: [0.1, 0.95]", "friction_ratio: [0.2, 0.95]")
    assert set(chunks_to_run(gathered)) == {"map_friction"}
    gathered.edit("config.yaml", "seed: 2010", "seed: 2011")
    assert set(chunks_to_run(gathered)) == {"map_friction", "spread_members"}
    gathered.append("src/precursors/kernel/events.py", "\nEDITED = True\n")
    assert set(chunks_to_run(gathered)) == {"map_blocks", "map_friction", "spread_members"}
