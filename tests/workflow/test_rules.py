"""The rules are written as Snakemake's own tools ask for, and know the code that they
run."""

import re

# One environment, built from requirements.lock by the Makefile, serves all rules.
ACCEPTED_FINDING = "Specify a conda environment or container for each rule"


def test_lint_asks_for_nothing_but_one_software_environment_per_rule(workspace):
    outcome = workspace.run("--lint")
    findings = set(re.findall(r"^\s+\* (.+?)[.:]+$", outcome.text, flags=re.MULTILINE))
    assert findings == {ACCEPTED_FINDING}, outcome.text


def test_the_mission_has_targets_and_tools_that_look_below_workflow_find_them(
    untouched,
):
    workspace, _ = untouched
    targets = {"fig13", "eq15", "mu_sapp", "paper_figures", "accuracy", "paper"}
    outcome = workspace.run("-n", "-s", "workflow/Snakefile", *targets)
    assert outcome.code == 0, outcome.text
    assert targets | {"simulate_scene fig10"} <= outcome.jobs
