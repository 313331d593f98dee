"""The rules are written as Snakemake's own tools ask for, and name the rooms that their scripts use."""

import ast
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
    "tabulate_long_runs",
    "tabulate_lyapunov",
    "tabulate_predictability",
    "tabulate_step_sweep",
}
# These make the parameters of rules, which Snakemake compares itself; `support` has no physics.
ASIDE = ("model/scenes.py", "support/")
LIBRARY = ROOT / "src/precursors"


def rules() -> dict[str, str]:
    """Text of every rule by its name; the rule of all figures has the name `draw_{name}`."""
    text = "\n".join(file.read_text(encoding="utf-8") for file in (ROOT / "workflow/rules").glob("*.smk"))
    found = re.split(r"^ *rule\b ?", text, flags=re.MULTILINE)[1:]
    return {re.search(r'^(\w+):|f"(\w+_\{name\})"', rule)[0].strip(':f"'): rule for rule in found}


def used_by(script: str, named: set[str]) -> set[str]:
    """Files of the library that a script uses: what it imports, what that imports, and so on.

    The script of all figures imports the module that its rule names.
    """
    found: set[str] = set()
    waiting = [ROOT / f"workflow/scripts/{script}.py"]
    if script == "draw":
        waiting += [LIBRARY / name for name in named if name.startswith("figures/")]
    while waiting:
        for node in ast.walk(ast.parse(waiting.pop().read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("precursors."):
                files = {file_of(node.module, alias.name) for alias in node.names}
                new = {name for name in files if not name.startswith(ASIDE)} - found
                found |= new
                waiting += [LIBRARY / name for name in new]
    return found


def file_of(module: str, name: str) -> str:
    """The file that `from module import name` reads, relative to the library."""
    package = LIBRARY.joinpath(*module.split(".")[1:])
    candidates = [package / f"{name}.py", package / name / "__init__.py", package.with_suffix(".py")]
    file = next((file for file in candidates if file.is_file()), package / "__init__.py")
    return file.relative_to(LIBRARY).as_posix()


def test_lint_asks_for_nothing_but_one_software_environment_per_rule(workspace):
    outcome = workspace.run("--lint")
    findings = set(re.findall(r"^\s+\* (.+?)[.:]+$", outcome.text, flags=re.MULTILINE))
    assert findings == {ACCEPTED_FINDING}, outcome.text


def test_a_rule_that_writes_has_a_log_and_a_name_of_a_verb_and_a_noun():
    writing = {name: rule for name, rule in rules().items() if "output:" in rule}
    assert len(writing) > 25
    assert [name for name in writing if "_" not in name] == []
    assert [name for name, rule in writing.items() if "log:" not in rule] == []


def test_a_job_lists_what_it_reads_before_the_code_that_it_runs():
    inputs = {name: rule.partition("input:")[2].partition("output:")[0] for name, rule in rules().items()}
    named = {
        name: re.findall(r"^ {8,12}(?:\*\*)?(\w+)[=.]", text, re.MULTILINE) for name, text in inputs.items()
    }
    with_code = [names for names in named.values() if "code" in names]
    assert len(with_code) > 25
    assert {names[-1] for names in with_code} == {"code"}


def test_a_rule_goes_to_the_queue_or_says_that_it_does_not():
    assert {name for name, rule in rules().items() if "localrule: True" not in rule} == QUEUED


def test_an_edit_of_any_module_that_a_script_uses_runs_its_rule_again(untouched):
    """The rooms that a rule names hold what its script imports, directly and through the rooms below."""
    workspace, outcome = untouched
    asked = workspace.run(
        *("-n", "-F", "mission", "accuracy_full", "prove_scenes", "results/certificates/fig10.json.gz"),
        "results/tables/endless.csv",
    )
    named: dict[str, set[str]] = {}
    for rule, inputs in re.findall(r"rule (\w+):\n    input: (.+)", outcome.text + asked.text):
        named[rule] = {name.partition("src/precursors/")[2] for name in inputs.split(", ")}
    scripts = {
        name: found[1] for name, rule in rules().items() if (found := re.search(r'scripts/(\w+)\.py"', rule))
    }
    drawing = scripts.pop("draw_{name}")
    scripts = {name: drawing for name in named if name.startswith("draw_")} | scripts
    assert len(scripts) > 35
    missing = {
        rule: used_by(script, named[rule]) - named[rule] for rule, script in scripts.items() if rule in named
    }
    lines = [f"{rule} does not name {', '.join(sorted(files))}" for rule, files in missing.items() if files]
    assert lines == [], "\n".join(lines)


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
            "from precursors.ensembles import catalogue; from precursors.reproduction import claims, numbers",
            "h5py matplotlib numba scipy.optimize scipy.stats sympy",
        ),
    ],
    ids=["a run", "reading the rules"],
)
def test_slow_packages_are_imported_where_they_are_used_only(code, unwanted):
    shown = f"{code}; import sys; print(*sorted(set('{unwanted}'.split()) & sys.modules.keys()))"
    assert subprocess.run([sys.executable, "-c", shown], capture_output=True, text=True).stdout == "\n"
