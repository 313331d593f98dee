"""A copy of the project to do harm to, and Snakemake run in it as a user runs it."""

from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import yaml

ROOT = Path(__file__).parents[2]
PARTS = ("Snakefile", "config.yaml", "profiles", "src", "workflow")
# Some of every kind of file: run, chunk, certificate, table, JSON, figure, page, explorer, paper.
TARGETS = (
    "results/tables/reproduction.csv",
    "results/tables/eq15.json",
    "results/tables/resolution_models.csv",
    "results/certificates/chains/uniform.json.gz",
    "results/figures/fig10.svg",
    "results/figures/fig13.svg",
    "results/pages/reproduction.html",
    "results/explorer.html",
    "results/paper.pdf",
)
# A paper of one page, as the real one waits for every table.
PAPER = """\
#let numbers = json("/results/numbers.json")
#let drawn(name) = image("/results/figures/" + name + ".svg", alt: name)
#set document(title: [A page])
theta is #numbers.theta.value
#drawn("fig13")
"""
NUMBERS = {
    "lists": {},
    "numbers": {
        "theta": {"table": "reproduction", "column": "theta", "where": {"scene": "fig12"}, "take": "first"}
    },
}
JOB = re.compile(r"^    output: ([^\s,]+).*\n(?:    (?!jobid).*\n)*    jobid: (\d+)$", re.MULTILINE)
FINISHED = re.compile(r"^Finished jobid: (\d+)", re.MULTILINE)
TEMPORARY = re.compile(r"\.[0-9a-f]{16}\..+")
# Seconds until something is taken never to happen.
PATIENCE = 120.0


def small(config: dict[str, Any]) -> dict[str, Any]:
    """The paper's configuration with short runs and small studies."""
    models = config["resolution_models"]["models"]
    config["duration"] = 4.0
    config["accuracy"]["chains"] = ["uniform"]
    config["horizon"]["chains"] = {"uniform": config["horizon"]["chains"]["uniform"]}
    config["resolution_models"] |= {
        "n_blocks": [2, 5],
        "seconds_per_point": 0.01,
        "least_runs": 2,
        "most_runs": 3,
        "models": {name: models[name] for name in ("plain", "viscous")},
    }
    config["ensembles"]["seconds_per_chunk"] = 0.001
    return config


@dataclass
class Workspace:
    """A directory that holds the project; `output` is what Snakemake prints."""

    directory: Path
    output: Path
    targets: tuple[str, ...] = TARGETS
    groups: list[int] = field(default_factory=list)

    @property
    def environment(self) -> dict[str, str]:
        return os.environ | {"PYTHONPATH": str(self.directory / "src"), "OMP_NUM_THREADS": "1"}

    def start(self, *arguments: str, output: Path | None = None, **options: Any) -> subprocess.Popen[bytes]:
        """Start Snakemake in a process group of its own."""
        command = [sys.executable, "-m", "snakemake", "-c2", *arguments, "--", *self.targets]
        with (output or self.output).open("wb") as printed:
            process = subprocess.Popen(
                command,
                cwd=self.directory,
                env=self.environment,
                stdin=subprocess.DEVNULL,
                stdout=printed,
                stderr=printed,
                start_new_session=True,
                **options,
            )
        self.groups.append(process.pid)
        return process

    def run(self, *arguments: str, **options: Any) -> tuple[int, str]:
        """Run Snakemake to its end: its exit code and what it printed."""
        return self.start(*arguments, **options).wait(), self.text()

    def text(self) -> str:
        """What Snakemake has printed."""
        return self.output.read_text(encoding="utf-8", errors="replace")

    def clean(self) -> None:
        """Remove what the workflow made, and end what still runs."""
        for group in self.groups:
            with suppress(ProcessLookupError):
                os.killpg(group, signal.SIGKILL)
        self.wait_for_orphans()
        for name in ("results", ".snakemake"):
            shutil.rmtree(self.directory / name, ignore_errors=True)

    def wait_for_orphans(self) -> None:
        """Wait for jobs that outlive their Snakemake."""
        wait_until(lambda: not any(group in self.groups for _, _, group in processes()))
        self.groups.clear()

    def outputs(self) -> dict[str, Path]:
        """Files with their final names, apart from logs and timings."""
        results = self.directory / "results"
        found = {str(path.relative_to(self.directory)): path for path in results.rglob("*") if path.is_file()}
        return {
            name: path
            for name, path in found.items()
            if not path.name.startswith(".") and name.split("/")[1] not in ("logs", "benchmarks")
        }

    def contents(self) -> dict[str, bytes]:
        """What the files hold that have their final names."""
        return {name: path.read_bytes() for name, path in self.outputs().items()}

    def leftovers(self) -> list[str]:
        """Temporary files."""
        return [path.name for path in self.directory.rglob("results/**/.*") if TEMPORARY.fullmatch(path.name)]

    def is_locked(self) -> bool:
        """Whether a Snakemake works here, or was killed here."""
        return any(self.directory.glob(".snakemake/locks/*"))


@dataclass
class Witness:
    """Reads every file with a final name when it is new or has changed; `wrong` are those not right."""

    work: Workspace
    right: dict[str, bytes]
    wrong: set[str] = field(default_factory=set)
    seen: dict[str, tuple[int, int, int]] = field(default_factory=dict)

    def look(self, again: bool = False) -> None:
        """Compare what is there with an undisturbed run; `again` also what has not changed."""
        for name, path in self.work.outputs().items():
            with suppress(FileNotFoundError):  # Snakemake removes what a failed job wrote
                found = path.stat()
                state = (found.st_ino, found.st_size, found.st_mtime_ns)
                if (again or self.seen.get(name) != state) and path.read_bytes() != self.right.get(name):
                    self.wrong.add(name)
                self.seen[name] = state

    def watch(self, process: subprocess.Popen[bytes], seconds: float = PATIENCE) -> None:
        """Look all the time until a process ends, or so long."""
        end = time.monotonic() + seconds
        while process.poll() is None and time.monotonic() < end:
            self.look()
            time.sleep(0.01)


def jobs(text: str) -> tuple[set[str], set[str]]:
    """First outputs of the jobs that Snakemake says it began, and of those that it says are finished."""
    outputs = {jobid: output for output, jobid in JOB.findall(text)}
    return set(outputs.values()), {outputs[jobid] for jobid in FINISHED.findall(text)}


def processes() -> list[tuple[int, int, int]]:
    """Numbers of all processes that run, of their parents and of their groups."""
    listed = subprocess.run(
        ["ps", "-eo", "pid=,ppid=,pgid=,stat="], capture_output=True, text=True, check=True
    )
    rows = [line.split() for line in listed.stdout.splitlines()]
    return [(int(pid), int(parent), int(group)) for pid, parent, group, state in rows if state[0] != "Z"]


def descendants(pid: int) -> list[int]:
    """Processes that a process started, and those that they started."""
    listed = processes()
    found = [child for child, parent, _ in listed if parent == pid]
    for child in found:
        found.extend(grandchild for grandchild, parent, _ in listed if parent == child)
    return found


def wait_until(condition: Callable[[], bool], seconds: float = PATIENCE) -> bool:
    """Wait for something, and say whether it came."""
    end = time.monotonic() + seconds
    while not (met := condition()) and time.monotonic() < end:
        time.sleep(0.02)
    return met


@contextmanager
def workspace(directory: Path, targets: tuple[str, ...] = TARGETS) -> Iterator[Workspace]:
    """A copy of the project with short runs and a short paper; its compiled code comes along."""
    project = directory / "project"
    project.mkdir(exist_ok=True)
    for part in PARTS:
        source = ROOT / part
        (shutil.copytree if source.is_dir() else shutil.copy2)(source, project / part)
    config = small(yaml.safe_load((ROOT / "config.yaml").read_text(encoding="utf-8")))
    (project / "config.yaml").write_text(yaml.safe_dump(config, sort_keys=False), encoding="utf-8")
    (project / "paper").mkdir()
    shutil.copy2(ROOT / "paper/claims.yaml", project / "paper")
    (project / "paper/main.typ").write_text(PAPER, encoding="utf-8")
    (project / "paper/numbers.yaml").write_text(yaml.safe_dump(NUMBERS), encoding="utf-8")
    work = Workspace(project, directory / "snakemake.out", targets)
    try:
        yield work
    finally:
        work.clean()
