"""Kills and odd places: what is finished stays, nothing is half written, a run goes on.

FAULT_KILLS=20 kills twenty times.
"""

import os
import shutil
import signal
import subprocess
import sys

import numpy as np
from places import ROOT
from workflow_copy import Workspace, copy_workflow

KILLS = int(os.environ.get("FAULT_KILLS", "1"))
SEED = 1964
# A scene with its run, slips and trace.
COMMAND = ("-c1", "--", "results/tables/fig10_slips.csv")


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


def made(project: Workspace) -> set[str]:
    """What lies under final names, apart from logs, with the bytes that `make all`
    gave."""
    found = {
        name: content
        for name, (_, content) in project.results().items()
        if "/logs/" not in name and "/." not in name
    }
    for name, content in found.items():
        assert content == (ROOT / name).read_bytes(), name
    return set(found)


def test_after_kills_the_same_command_ends_with_the_same_bytes(tmp_path):
    # Spaces and letters of any script are odd, but allowed.
    project = copy_workflow(tmp_path / "Vorläufer des Gleitens")
    rng = np.random.default_rng(SEED)
    for _ in range(KILLS):
        is_killed = kill_after(project, rng.integers(1, 4))
        made(project)
        assert project.run("--unlock").code == 0
        if not is_killed:  # it ended before the kill: begin again
            shutil.rmtree(project.path / "results")
    outcome = project.run(*COMMAND)
    assert outcome.code == 0, outcome.text
    assert len(made(project)) == 3
    assert list(project.path.rglob("results/**/.partial.*")) == []
