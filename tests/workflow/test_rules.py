"""The rules satisfy Snakemake's linter, and depend on the code that they run."""

import re

import pytest
from places import ROOT

# All rules share one environment, which the Makefile builds from requirements.lock.
ACCEPTED_FINDING = "Specify a conda environment or container for each rule"


def test_lint_complains_only_about_environments_of_rules(workspace):
    outcome = workspace.run("--lint")
    findings = set(re.findall(r"^\s+\* (.+?)[.:]+$", outcome.text, flags=re.MULTILINE))
    assert findings == {ACCEPTED_FINDING}, outcome.text


def test_the_main_targets_exist_in_the_snakefile_below_workflow(
    untouched,
):
    workspace, _ = untouched
    targets = {"fig13", "eq15", "mu_sapp", "paper_figures", "accuracy", "paper"}
    outcome = workspace.run("-n", "-s", "workflow/Snakefile", *targets)
    assert outcome.code == 0, outcome.text
    assert targets | {"simulate_scene fig10"} <= outcome.jobs


def rules_of(file):
    """Name and text of every rule of a file."""
    text = file.read_text(encoding="utf-8")
    return re.findall(r"^( *)rule (\w+):\n((?:\1 .+\n|\n)+)", text, re.MULTILINE)


@pytest.mark.parametrize(
    "file",
    sorted((ROOT / "workflow").glob("*/**/*.smk")),
    ids=lambda file: file.parent.name if file.stem == "rules" else file.stem,
)
def test_a_rule_has_a_docstring_and_a_job_a_log_and_a_digest(file):
    text = file.read_text(encoding="utf-8")
    rules = rules_of(file)
    assert len(rules) == len(re.findall("^ *rule ", text, re.MULTILINE))
    for _, name, body in rules:
        assert re.match(r' +"""\w.+\."""\n', body), name
        script = re.search(r'script:\s+"[\w./]*?(\w+)\.py"', body)
        assert ("localrule: True" in body) != ("seconds=" in body), name
        if script:
            assert "log:" in body, name
            assert f'digest("{script[1]}")' in body, name
