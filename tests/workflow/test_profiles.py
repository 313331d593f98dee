"""On a cluster, what computes goes to the queue and what draws does not."""

import re
from pathlib import Path

import yaml

ROOT = Path(__file__).parents[2]
# Rules whose jobs may take minutes, by default or when a number of the configuration asks for more.
QUEUED = {
    "certify_scene",
    "check_eq15",
    "climb_ladder",
    "measure_growth",
    "measure_methods",
    "measure_methods_fully",
    "measure_scaling",
    "prove_again",
    "run_chunk",
    "simulate_scene",
    "tabulate_failures",
    "tabulate_long_runs",
    "tabulate_lyapunov",
    "tabulate_step_sweep",
}


def rules() -> set[str]:
    files = [ROOT / "Snakefile", *(ROOT / "workflow/rules").glob("*.smk")]
    return {
        name
        for file in files
        for name in re.findall(r"^(?:rule|checkpoint) (\w+):", file.read_text(encoding="utf-8"), re.MULTILINE)
    }


def local_rules() -> set[str]:
    text = (ROOT / "workflow/rules/cluster.smk").read_text(encoding="utf-8")
    return set(re.findall(r"^    (\w+),$", text, re.MULTILINE))


def test_every_rule_either_goes_to_the_queue_or_is_named_as_one_that_does_not():
    local = local_rules()
    assert not local & QUEUED
    new, gone = rules() - local - QUEUED, (local | QUEUED) - rules()
    assert not new, f"name these in workflow/rules/cluster.smk if they take seconds, or else above: {new}"
    assert not gone, f"there is no such rule: {gone}"


def test_nothing_but_the_queue_is_different_on_a_cluster():
    profile = yaml.safe_load((ROOT / "workflow/profiles/slurm/profile.yaml").read_text(encoding="utf-8"))
    assert profile["executor"] == "slurm"
    assert not {"config", "configfile", "set-threads", "snakefile", "directory"} & profile.keys()


def test_after_a_kill_the_same_command_goes_on():
    profile = yaml.safe_load((ROOT / "profiles/default/profile.yaml").read_text(encoding="utf-8"))
    assert profile == {"rerun-incomplete": True}
