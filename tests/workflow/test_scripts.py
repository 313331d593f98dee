"""The scripts report errors in one line, and print their results."""

import re
import runpy
import sys

import pandas as pd
import print_reproduction
import pytest
from places import ROOT

from precursors import Run

SOLVER = "src/precursors/solver/simulate.py"
JOB = ("-c1", "--", "results/runs/fig10.h5")


# A job


def test_a_job_logs_how_long_it_took(workspace):
    outcome = workspace.run(*JOB)
    assert outcome.code == 0, outcome.text
    log = (workspace.path / "results/logs/simulate_scene/fig10.log").read_text()
    assert re.fullmatch(r"simulate_scene, fig10: \d+\.\d{3} s\n", log)


def test_an_error_in_our_code_is_one_line_and_a_logged_traceback(workspace):
    workspace.edit(
        SOLVER, "", "\ndef simulate(*_, **__):\n    raise KeyError('mine')\n"
    )
    outcome = workspace.run(*JOB)
    assert outcome.code != 0
    assert re.search("^simulate_scene, fig10: 'mine'$", outcome.text, re.MULTILINE)
    log = (workspace.path / "results/logs/simulate_scene/fig10.log").read_text()
    assert "\nTraceback" in log
    assert "Traceback" not in outcome.text


def test_an_unfinished_run_has_a_file_name_of_its_own(workspace):
    workspace.edit(SOLVER, "MAX_TRANSITIONS = 10_000_000", "MAX_TRANSITIONS = 100")
    outcome = workspace.run(*JOB)
    assert "max_transitions = 100 reached" in outcome.text
    runs = workspace.path / "results/runs"
    assert [file.name for file in runs.iterdir()] == ["fig10.unfinished.h5"]
    assert len(Run.load(runs / "fig10.unfinished.h5").transitions) == 100


# Scripts that make calls


def test_the_reproduction_is_printed_beside_the_papers_numbers(tmp_path, capsys):
    (tmp_path / "tables").mkdir()
    golden = pd.read_csv(ROOT / "tests/golden/reproduction.csv")
    golden.to_csv(tmp_path / "tables/reproduction.csv", index=False)
    (tmp_path / "explorer.html").touch()
    print_reproduction.main(tmp_path)
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == len(golden) + 2
    assert any(line.split()[-2:] == ["0.49", "0.4858"] for line in lines)
    assert lines[-1].startswith(f"Open {tmp_path / 'explorer.html'};")


@pytest.mark.parametrize(
    ("script", "arguments", "message"),
    [
        (
            "print_reproduction",
            ["none"],
            "reproduction: .*none/tables/reproduction.csv",
        ),
        ("codecheck", [], "codecheck: "),
    ],
)
def test_a_script_of_make_names_a_missing_file_in_one_line(
    tmp_path, monkeypatch, script, arguments, message
):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "argv", [script, *arguments])
    with pytest.raises(SystemExit, match=rf"\A{message}[^\n]*\Z"):
        runpy.run_path(str(ROOT / f"workflow/scripts/{script}.py"), run_name="__main__")
