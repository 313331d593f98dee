"""Chunks of a study are made once, and again where they are missing or what they depend on changes."""

import re
from collections import Counter

MAP, NOISE = "map_theta_friction_ratio", "noise_members"
TABLES = [f"results/tables/{study}.csv" for study in (MAP, NOISE)]


def chunks_to_run(workspace) -> Counter:
    """How many chunks of each study `snakemake -n` lists."""
    outcome = workspace.run("-n", *TABLES)
    assert outcome.code == 0, outcome.text
    return Counter(re.findall(r"output: results/ensembles/(\w+)/[0-9]+of[0-9]+\.csv", outcome.text))


def test_an_interrupted_study_goes_on_where_it_was_and_an_edit_renews_what_it_touches(workspace):
    workspace.edit("config.yaml", "chunks: 1", "chunks: 2")
    outcome = workspace.pretend(*TABLES)
    assert outcome.code == 0, outcome.text
    chunk, *others = sorted((workspace.path / "results/ensembles" / MAP).iterdir())
    assert others
    chunk.unlink()
    (workspace.path / TABLES[0]).unlink()
    assert chunks_to_run(workspace) == {MAP: 1}
    workspace.edit("config.yaml", "seed: 2010", "seed: 2011")
    assert chunks_to_run(workspace) == {MAP: 1, NOISE: 2}
    workspace.edit("config.yaml", "points: 2000", "points: 2001")
    assert chunks_to_run(workspace) == {MAP: 2, NOISE: 2}
    workspace.edit("config.yaml", "chunks: 2", "chunks: 7")
    assert chunks_to_run(workspace) == {MAP: 7, NOISE: 7}
