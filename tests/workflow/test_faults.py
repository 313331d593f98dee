"""Kills, a full disk and odd places: what is finished stays, nothing is half written, a run goes on.

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
import pytest
import yaml
from conftest import ROOT

KILLS = int(os.environ.get("FAULT_KILLS", "2"))
SEED = 1964
# A run and its table, the chunks of a study, a figure.
TARGETS = [
    f"results/{name}"
    for name in ("tables/fig10_slips.csv", "tables/map_theta_friction_ratio.csv", "figures/fig09.svg")
]


class Project:
    """A copy of the project with short runs, and Snakemake in it as a user runs it."""

    def __init__(self, directory: Path) -> None:
        self.directory = directory
        directory.mkdir()
        shutil.copy2(ROOT / "Snakefile", directory)
        for name in ("workflow", "profiles", "paper"):
            shutil.copytree(ROOT / name, directory / name)
        (directory / "src").symlink_to(ROOT / "src")
        config = yaml.safe_load((ROOT / "config.yaml").read_text(encoding="utf-8"))
        config["duration"] = 4.0
        config["ensembles"]["chunks"] = 2
        config["ensembles"]["map"]["points"] = 40
        (directory / "config.yaml").write_text(yaml.safe_dump(config, sort_keys=False), encoding="utf-8")

    def start(self, *arguments: str) -> subprocess.Popen[str]:
        """Start Snakemake in a process group of its own."""
        return subprocess.Popen(
            [sys.executable, "-m", "snakemake", "-c2", *arguments, "--", *TARGETS],
            cwd=self.directory,
            env=os.environ | {"PYTHONPATH": str(ROOT / "src"), "OMP_NUM_THREADS": "1"},
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            start_new_session=True,
        )

    def run(self, *arguments: str) -> tuple[int, str]:
        """Run Snakemake to its end; its exit code and what it printed."""
        process = self.start(*arguments)
        text = process.communicate()[0]
        return process.returncode, text

    def contents(self) -> dict[str, bytes]:
        """What lies under final names, apart from logs, times and the clock in HDF5 files."""
        found = [path for path in (self.directory / "results").rglob("*") if path.is_file()]
        return {
            str(path.relative_to(self.directory)): path.read_bytes()
            for path in found
            if not path.name.startswith(".")
            and path.parts[-2] != "logs"
            and "logs" not in path.parts
            and "benchmarks" not in path.parts
        }

    def clean(self) -> None:
        """Remove what the workflow made."""
        for name in ("results", ".snakemake"):
            shutil.rmtree(self.directory / name, ignore_errors=True)


@pytest.fixture(scope="module")
def project(tmp_path_factory):
    # Spaces and letters of any script are odd, but allowed.
    return Project(tmp_path_factory.mktemp("faults") / "Vorläufer des Gleitens")


@pytest.fixture(scope="module")
def right(project):
    """What an undisturbed run leaves."""
    code, text = project.run()
    assert code == 0, text
    return project.contents()


def test_after_kills_the_same_command_ends_with_the_same_bytes(project, right):
    rng = np.random.default_rng(SEED)
    project.clean()
    for _ in range(KILLS):
        process = project.start()
        # Two jobs run side by side: where one begins or ends, the other is on its way.
        left = rng.integers(1, 9)
        while left and (line := process.stdout.readline()):
            left -= line.startswith(("rule ", "localrule ", "Finished jobid"))
        os.killpg(process.pid, signal.SIGKILL)
        process.communicate()
        found = project.contents()
        assert {name for name in found if found[name] != right.get(name)} == set()
        code, text = project.run("--unlock")
        assert code == 0, text
        if left:  # it ended before the kill: begin again
            project.clean()
    code, text = project.run()
    assert code == 0, text
    assert project.contents() == right
    assert list(project.directory.rglob("results/**/.partial.*")) == []


# Writes a file of each kind, then again with less and less room.
WRITE = """
import resource
from pathlib import Path
import pandas as pd
from matplotlib.figure import Figure
from precursors import Chain, simulate
from precursors.figures import style
from precursors.support.files import write_table

run = simulate(Chain.from_slider(), 1.0)
figure = Figure()
figure.subplots().plot(range(99))
table = pd.DataFrame({"a": [i / 7 for i in range(3000)]})
for name, write in {
    "run.h5": run.save,
    "table.csv": lambda path: write_table(table, path),
    "figure.png": lambda path: style.save(figure, path),
    "figure.svg": lambda path: style.save(figure, path),
}.items():
    path = Path(name.replace(".", "_"), name).absolute()
    path.parent.mkdir()
    write(path)
    old, there = path.read_bytes(), list(path.parent.iterdir())
    for limit in (0, 100, 4096, len(old) // 2, len(old) - 1):
        resource.setrlimit(resource.RLIMIT_FSIZE, (limit, resource.RLIM_INFINITY))
        message = "nothing was said"
        try:
            write(path)
        except OSError as error:
            message = str(error)
        resource.setrlimit(resource.RLIMIT_FSIZE, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
        if not message.startswith(f"cannot write {path}") or len(message.splitlines()) != 1:
            print(f"{name}, limit of {limit} bytes: {message}")
        if path.read_bytes() != old or list(path.parent.iterdir()) != there:
            print(f"{name}, limit of {limit} bytes: the old file was harmed")
"""


def test_where_there_is_no_room_the_old_file_stays_and_one_line_says_so(tmp_path):
    command = [sys.executable, "-c", WRITE]
    environment = os.environ | {"PYTHONPATH": str(ROOT / "src")}
    done = subprocess.run(command, capture_output=True, text=True, cwd=tmp_path, env=environment)
    assert (done.returncode, done.stdout) == (0, ""), done.stderr
