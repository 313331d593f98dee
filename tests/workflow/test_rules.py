"""The rules are written the way Snakemake's own tools ask for."""

import re
import subprocess
import sys
from pathlib import Path

from conftest import ROOT

# One environment, built from requirements.lock by the Makefile, serves all rules.
ACCEPTED_FINDING = "Specify a conda environment or container for each rule"


def test_lint_asks_for_nothing_but_one_software_environment_per_rule(workspace):
    outcome = workspace.run("--lint")
    findings = set(re.findall(r"^\s+\* (.+?)[.:]+$", outcome.text, flags=re.MULTILINE))
    assert findings == {ACCEPTED_FINDING}, outcome.text


def test_snakefmt_would_change_nothing():
    snakefmt = Path(sys.executable).with_name("snakefmt")
    done = subprocess.run(
        [snakefmt, "--check", "Snakefile", "workflow"], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr


def test_every_rule_that_writes_has_a_log_and_a_name_of_a_verb_and_a_noun():
    for file in (ROOT / "workflow/rules").glob("*.smk"):
        for rule in re.split(r"^ *rule ", file.read_text(encoding="utf-8"), flags=re.MULTILINE)[1:]:
            name = rule.partition(":")[0]
            if "\n    output:" in rule:
                assert "_" in name, f"{name} in {file.name}"
                assert "\n    log:" in rule, f"log: in {name} in {file.name}"
                assert "code=package(" in rule, f"code in {name} in {file.name}"
