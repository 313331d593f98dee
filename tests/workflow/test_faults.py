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
# A run and its table, the chunks of a study, a figure.
TARGETS = [
    f"results/{name}"
    for name in (
        "tables/fig10_slips.csv",
        "tables/map_theta_friction_ratio.csv",
        "figures/fig09.svg",
    )
]


def start(project: Workspace, *arguments: str) -> subprocess.Popen[str]:
    """Start Snakemake as a user does, in a process group of its own."""
    return subprocess.Popen(
        [sys.executable, "-m", "snakemake", "-c2", *arguments, "--", *TARGETS],
        cwd=project.path,
        env=os.environ | {"PYTHONPATH": str(ROOT / "src"), "OMP_NUM_THREADS": "1"},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        start_new_session=True,
    )


def run(project: Workspace, *arguments: str) -> None:
    """Run Snakemake to its end."""
    process = start(project, *arguments)
    text = process.communicate()[0]
    assert process.returncode == 0, text


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


def test_after_kills_the_same_command_ends_with_the_same_bytes(tmp_path: Path) -> None:
    # Spaces and letters of any script are odd, but allowed.
    project = copy_workflow(tmp_path / "Vorläufer des Gleitens")
    project.edit("config.yaml", "duration: 10.0", "duration: 4.0")
    project.edit("config.yaml", "chunks: 1", "chunks: 2")
    project.edit("config.yaml", "points: 2000", "points: 40")
    run(project)
    right = contents(project)
    clean(project)
    rng = np.random.default_rng(SEED)
    for _ in range(KILLS):
        process = start(project)
        # Two jobs run side by side: where one begins or ends, the other is on its way.
        left = rng.integers(1, 9)
        while left and (line := process.stdout.readline()):
            left -= line.startswith(("rule ", "localrule ", "Finished jobid"))
        os.killpg(process.pid, signal.SIGKILL)
        process.communicate()
        found = contents(project)
        assert {name for name in found if found[name] != right.get(name)} == set()
        run(project, "--unlock")
        if left:  # it ended before the kill: begin again
            clean(project)
    run(project)
    assert contents(project) == right
    assert list(project.path.rglob("results/**/.partial.*")) == []
