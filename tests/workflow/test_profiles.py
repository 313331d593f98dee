"""On a cluster, what computes goes to the queue and what draws does not."""

import re
from pathlib import Path

import yaml

ROOT = Path(__file__).parents[2]
# Rules whose jobs may take minutes, by default or when a number of the configuration asks for more.
QUEUED = {
    "certify_scene",
    "check_eq15",
    "compare_models",
    "measure_growth",
    "measure_methods",
    "prove_again",
    "run_chunk",
    "run_larger_models",
    "simulate_scene",
    "tabulate_failures",
    "tabulate_long_runs",
    "tabulate_lyapunov",
    "tabulate_step_sweep",
}


def test_every_rule_either_goes_to_the_queue_or_says_that_it_does_not():
    for file in (ROOT / "workflow/rules").glob("*.smk"):
        for rule in re.split(r"^ *rule ", file.read_text(encoding="utf-8"), flags=re.MULTILINE)[1:]:
            assert ("localrule: True" in rule) != (rule.partition(":")[0] in QUEUED), rule.partition(":")[0]


def test_nothing_but_the_queue_is_different_on_a_cluster():
    profile = yaml.safe_load((ROOT / "workflow/profiles/slurm/profile.yaml").read_text(encoding="utf-8"))
    assert profile["executor"] == "slurm"
    assert not {"config", "configfile", "set-threads", "snakefile", "directory"} & profile.keys()


def test_after_a_kill_the_same_command_goes_on():
    profile = yaml.safe_load((ROOT / "profiles/default/profile.yaml").read_text(encoding="utf-8"))
    assert profile == {"rerun-incomplete": True}
