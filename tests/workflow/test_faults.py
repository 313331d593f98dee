"""After Snakemake is killed, finished files stay, no file is half written, and the same
command continues. The directory has spaces and letters beyond ASCII in its name.

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
# Makes the run, slips and trace of a scene.
COMMAND = ("-c1", "--", "results/tables/fig10_slips.csv")


def kill_after(project: Workspace, lines: int) -> bool:
    """Start Snakemake, and kill it with its jobs after `lines` starts and ends of jobs;
    return whether it was killed before it ended."""
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
    """Names of the finished files without logs, which must equal those of `make all`."""
    files = {
        name: content
        for name, (_, content) in project.results().items()
        if "/logs/" not in name and "/." not in name
    }
    for name, content in files.items():
        assert content == (ROOT / name).read_bytes(), name
    return set(files)


def test_after_kills_the_same_command_ends_with_the_same_bytes(tmp_path):
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
