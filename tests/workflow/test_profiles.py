"""The profiles change where jobs run, and nothing else."""

from pathlib import Path

import yaml

ROOT = Path(__file__).parents[2]


def test_nothing_but_the_queue_is_different_on_a_cluster():
    profile = yaml.safe_load((ROOT / "workflow/profiles/slurm/profile.yaml").read_text(encoding="utf-8"))
    assert profile["executor"] == "slurm"
    assert not {"config", "configfile", "set-threads", "snakefile", "directory"} & profile.keys()
