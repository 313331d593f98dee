"""Kills, a full disk and odd places: what is finished stays, nothing is half written, a run goes on.

FAULT_KILLS=20 kills twenty times.
"""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
import yaml
from conftest import ROOT

from precursors import Chain, simulate

KILLS = int(os.environ.get("FAULT_KILLS", "3"))
SEED = 1964
# A run, the chunks of a study, tables, figures.
TARGETS = ("results/figures/fig13.svg", "results/tables/reproduction.csv", "results/tables/spread.csv")
LATEST = 8.0  # s after the start of Snakemake; its jobs begin after about two


class Project:
    """A copy of the project with short runs, and Snakemake in it as a user runs it."""

    def __init__(self, directory: Path) -> None:
        self.directory = directory
        directory.mkdir()
        shutil.copy2(ROOT / "Snakefile", directory)
        for name in ("src", "workflow", "profiles", "paper"):
            shutil.copytree(ROOT / name, directory / name)
        config = yaml.safe_load((ROOT / "config.yaml").read_text(encoding="utf-8"))
        config["duration"] = 4.0
        config["ensembles"]["spread"]["members"] = 8
        (directory / "config.yaml").write_text(yaml.safe_dump(config, sort_keys=False), encoding="utf-8")

    def start(self, *arguments: str) -> subprocess.Popen[str]:
        """Start Snakemake in a process group of its own."""
        return subprocess.Popen(
            [sys.executable, "-m", "snakemake", "-c2", *arguments, "--", *TARGETS],
            cwd=self.directory,
            env=os.environ | {"PYTHONPATH": str(self.directory / "src"), "OMP_NUM_THREADS": "1"},
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
    killed = 0
    while killed < KILLS:
        process = project.start()
        time.sleep(rng.uniform(1.0, LATEST))
        if process.poll() is not None:  # it ended before the kill: begin again
            assert process.returncode == 0, process.communicate()[0]
            project.clean()
            continue
        killed += 1
        os.killpg(process.pid, signal.SIGKILL)
        process.communicate()
        found = project.contents()
        assert {name for name in found if found[name] != right.get(name)} == set()
        code, text = project.run("--unlock")
        assert code == 0, text
    code, text = project.run()
    assert code == 0, text
    assert project.contents() == right
    assert list(project.directory.rglob("results/**/.partial.*")) == []


def test_a_results_that_is_a_file_is_refused_and_a_mended_one_goes_on(project, right):
    project.clean()
    (project.directory / "results").write_text("not a directory")
    code, text = project.run()
    assert code != 0
    assert "results" in text
    (project.directory / "results").unlink()
    assert project.run()[0] == 0
    assert project.contents() == right


# Writes a file of each kind, then again with less and less room.
WRITE = """
import resource, sys
from pathlib import Path
import pandas as pd
from matplotlib.figure import Figure
from precursors import Chain, simulate
from precursors.figures import style
from precursors.support.files import write_table

path = Path(sys.argv[1])
run = simulate(Chain.from_slider(), 1.0)
figure = Figure()
figure.subplots().plot(range(99))
table = pd.DataFrame({"a": [i / 7 for i in range(3000)]})
write = {
    ".h5": run.save,
    ".csv": lambda path: write_table(table, path),
    ".png": lambda path: style.save(figure, path),
    ".svg": lambda path: style.save(figure, path),
}[path.suffix]
write(path)
old = path.read_bytes()
for limit in (0, 100, 4096, len(old) // 2, len(old) - 1):
    resource.setrlimit(resource.RLIMIT_FSIZE, (limit, resource.RLIM_INFINITY))
    try:
        write(path)
        print(f"limit of {limit} bytes: nothing was said")
    except OSError as error:
        message = str(error)
    resource.setrlimit(resource.RLIMIT_FSIZE, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
    if not message.startswith(f"cannot write {path}") or len(message.splitlines()) != 1:
        print(f"limit of {limit} bytes: {message}")
    if path.read_bytes() != old or len(list(path.parent.iterdir())) != 1:
        print(f"limit of {limit} bytes: the old file was harmed")
"""


@pytest.mark.parametrize("name", ["run.h5", "table.csv", "figure.png", "figure.svg"])
def test_where_there_is_no_room_the_old_file_stays_and_one_line_says_so(tmp_path, name):
    done = subprocess.run(
        [sys.executable, "-c", WRITE, tmp_path / name], capture_output=True, text=True, cwd=ROOT
    )
    assert (done.returncode, done.stdout) == (0, ""), done.stderr


@pytest.mark.parametrize("cut", [0, 100, 5_000, -1])
def test_a_cut_run_file_is_refused_in_one_line(tmp_path, cut):
    from precursors import Run, RunFileError

    path = tmp_path / "run.h5"
    simulate(Chain.from_slider(), 1.0).save(path)
    path.write_bytes(path.read_bytes()[:cut])
    with pytest.raises(RunFileError) as error:
        Run.load(path)
    assert str(path) in str(error.value)
    assert "\n" not in str(error.value)
