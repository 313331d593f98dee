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


def test_every_rule_that_writes_has_a_log_and_a_benchmark():
    for file in (ROOT / "workflow/rules").glob("*.smk"):
        rules = re.split(r"^rule ", file.read_text(encoding="utf-8"), flags=re.MULTILINE)[1:]
        for rule in rules:
            name = rule.partition(":")[0]
            if "\n    output:" not in rule:
                continue
            assert "_" in name, f"{name} in {file.name}: a verb and a noun"
            for directive in ("log:", "benchmark:", "threads:", "script:"):
                assert f"\n    {directive}" in rule, f"{directive} in {name} in {file.name}"


def test_a_dry_run_ends_well(untouched):
    """As it would not if an input were missing, the modules that a rule uses among them."""
    _, outcome = untouched
    assert outcome.code == 0, outcome.text


def test_every_rule_with_a_script_has_the_modules_of_that_script():
    for file in (ROOT / "workflow/rules").glob("*.smk"):
        for rule in re.split(r"^rule ", file.read_text(encoding="utf-8"), flags=re.MULTILINE)[1:]:
            script = re.search(r'"\.\./scripts/(\w+)\.py"', rule)
            assert script is None or f'code=code_of("{script[1]}"),' in rule, rule.partition(":")[0]
