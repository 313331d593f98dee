"""Kills and odd places: what is finished stays, nothing is half written, a run goes on.

FAULT_KILLS=20 kills twenty times.
"""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
from conftest import ROOT, Workspace, copy_workflow

KILLS = int(os.environ.get("FAULT_KILLS", "1"))
SEED = 1964
# A run with its table beside the members of a study, and then the table of the study.
TARGETS = [
    "results/tables/fig10_slips.csv",
    "results/tables/grid.csv",
]
COMMAND = ("-c2", "--", *TARGETS)


def kill_after(project: Workspace, lines: int) -> bool:
    """Start Snakemake as a user does, and kill it and its jobs once so many jobs have
    begun or ended; whether it came so far."""
    process = subprocess.Popen(
        [sys.executable, "-m", "snakemake", *COMMAND],
        cwd=project.path,
        env=os.environ | {"PYTHONPATH": str(ROOT / "src"), "OMP_NUM_THREADS": "1"},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        start_new_session=True,
    )
    while lines and (line := process.stdout.readline()):
        lines -= line.startswith(("rule ", "localrule ", "Finished jobid"))
    os.killpg(process.pid, signal.SIGKILL)
    process.communicate()
    return not lines


def contents(project: Workspace) -> dict[str, bytes]:
    """What lies under final names, apart from logs."""
    return {
        name: content
        for name, (_, content) in project.results().items()
        if "/logs/" not in name and "/." not in name
    }


def clean(project: Workspace) -> None:
    """Remove what the workflow made."""
    for name in ("results", ".snakemake"):
        shutil.rmtree(project.path / name, ignore_errors=True)


def finish(project: Workspace) -> dict[str, bytes]:
    """Run the workflow to its end; what it made."""
    outcome = project.run(*COMMAND)
    assert outcome.code == 0, outcome.text
    return contents(project)


def test_after_kills_the_same_command_ends_with_the_same_bytes(tmp_path: Path) -> None:
    # Spaces and letters of any script are odd, but allowed.
    project = copy_workflow(tmp_path / "Vorläufer des Gleitens")
    project.edit("config.yaml", "duration: 10.0", "duration: 2.0")
    project.edit("workflow/studies.yaml", "points: 44", "points: 1")
    right = finish(project)
    clean(project)
    rng = np.random.default_rng(SEED)
    for _ in range(KILLS):
        is_killed = kill_after(project, rng.integers(1, 6))
        found = contents(project)
        assert {name for name in found if found[name] != right.get(name)} == set()
        assert project.run("--unlock").code == 0
        if not is_killed:  # it ended before the kill: begin again
            clean(project)
    assert finish(project) == right
    assert list(project.path.rglob("results/**/.partial.*")) == []
