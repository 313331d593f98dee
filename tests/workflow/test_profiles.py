"""The profiles change where jobs run, and nothing else."""

from pathlib import Path

import yaml

ROOT = Path(__file__).parents[2]


def test_nothing_but_the_queue_is_different_on_a_cluster():
    profile = yaml.safe_load((ROOT / "workflow/profiles/slurm/profile.yaml").read_text(encoding="utf-8"))
    assert profile["executor"] == "slurm"
    assert not {"config", "configfile", "set-threads", "snakefile", "directory"} & profile.keys()


def test_after_a_kill_the_same_command_goes_on_and_reruns_look_at_what_is_computed():
    profile = yaml.safe_load((ROOT / "profiles/default/profile.yaml").read_text(encoding="utf-8"))
    assert profile == {"rerun-incomplete": True, "rerun-triggers": ["mtime", "params", "input"]}
