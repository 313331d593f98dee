"""The rules are written as Snakemake's own tools ask for, and know the code that they run."""

import re
import subprocess
import sys

import pytest
from conftest import ROOT

# One environment, built from requirements.lock by the Makefile, serves all rules.
ACCEPTED_FINDING = "Specify a conda environment or container for each rule"
# Rules whose jobs may take minutes, by default or with larger numbers in the configuration.
QUEUED = {
    "certify_scene",
    "check_eq15",
    "compare_models",
    "measure_methods",
    "prove_again",
    "run_chunk",
    "simulate_scene",
    "tabulate_failures",
    "tabulate_larger",
    "tabulate_lyapunov",
    "tabulate_predictability",
    "tabulate_step_sweep",
}


def rules() -> dict[str, str]:
    """Text of every rule by its name; the rule of the figures has the name `draw_{section}`."""
    text = "\n".join(file.read_text(encoding="utf-8") for file in (ROOT / "workflow/rules").glob("*.smk"))
    found = re.split(r"^ *rule\b ?", text, flags=re.MULTILINE)[1:]
    return {re.search(r'^(\w+):|f"(\w+_\{section\})"', rule)[0].strip(':f"'): rule for rule in found}


def test_lint_asks_for_nothing_but_one_software_environment_per_rule(workspace):
    outcome = workspace.run("--lint")
    findings = set(re.findall(r"^\s+\* (.+?)[.:]+$", outcome.text, flags=re.MULTILINE))
    assert findings == {ACCEPTED_FINDING}, outcome.text


def test_a_rule_that_writes_has_a_log_and_a_name_of_a_verb_and_a_noun():
    writing = {name: rule for name, rule in rules().items() if "output:" in rule}
    assert len(writing) > 15
    assert [name for name in writing if "_" not in name] == []
    assert [name for name, rule in writing.items() if "log:" not in rule] == []


def test_a_rule_with_a_script_has_the_digest_of_its_code_as_a_parameter():
    scripts = {
        name: found[1] for name, rule in rules().items() if (found := re.search(r'scripts/(\w+)\.py"', rule))
    }
    assert len(scripts) > 15
    assert [name for name, script in scripts.items() if f'code=digest("{script}"' not in rules()[name]] == []


def test_a_rule_goes_to_the_queue_or_says_that_it_does_not():
    assert {name for name, rule in rules().items() if "localrule: True" not in rule} == QUEUED


def test_the_mission_has_targets_and_tools_that_look_below_workflow_find_them(untouched):
    workspace, _ = untouched
    targets = {"fig13", "eq15", "mu_sapp", "paper_figures", "accuracy", "paper"}
    outcome = workspace.run("-n", "-s", "workflow/Snakefile", *targets)
    assert outcome.code == 0, outcome.text
    assert targets | {"simulate_scene fig10"} <= outcome.jobs


@pytest.mark.parametrize(
    ("code", "unwanted"),
    [
        (
            "from precursors import Chain, simulate; simulate(Chain.from_slider(), 0.1)",
            "h5py pandas matplotlib",
        ),
        (
            "from precursors.ensembles import studies\nfrom precursors.reproduction import inputs, shown",
            "h5py matplotlib numba pandas scipy sympy",
        ),
    ],
    ids=["a run", "reading the rules"],
)
def test_slow_packages_are_imported_where_they_are_used_only(code, unwanted):
    shown = f"{code}; import sys; print(*sorted(set('{unwanted}'.split()) & sys.modules.keys()))"
    assert subprocess.run([sys.executable, "-c", shown], capture_output=True, text=True).stdout == "\n"
