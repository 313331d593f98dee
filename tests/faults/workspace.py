"""A copy of the project to do harm to, and Snakemake run in it as a user runs it."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import yaml

from precursors import Run
from precursors.storage import open_checked

ROOT = Path(__file__).parents[2]
PARTS = ("Snakefile", "config.yaml", "src", "workflow", "paper")
# Runs, tables and what is computed from all of them: eight jobs that take about a second each.
TARGETS = ("results/tables/reproduction.csv",)
DURATION = 4.0


@dataclass(frozen=True)
class Workspace:
    """A directory that holds the project."""

    directory: Path

    @property
    def environment(self) -> dict[str, str]:
        return os.environ | {"PYTHONPATH": str(self.directory / "src"), "OMP_NUM_THREADS": "1"}

    def command(self, *arguments: str) -> list[str]:
        return [
            sys.executable,
            "-m",
            "snakemake",
            "-c2",
            "--quiet",
            "rules",
            "host",
            *arguments,
            "--",
            *TARGETS,
        ]

    def start(self, *arguments: str, **options: object) -> subprocess.Popen[str]:
        """Start Snakemake in a process group of its own."""
        return subprocess.Popen(
            self.command(*arguments),
            cwd=self.directory,
            env=self.environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            start_new_session=True,
            **options,  # type: ignore[call-overload]
        )

    def run(self, *arguments: str, **options: object) -> tuple[int, str]:
        """Run Snakemake to its end: its exit code and what it printed."""
        process = self.start(*arguments, **options)
        text, _ = process.communicate()
        return process.returncode, text

    def clean(self) -> None:
        """Remove what the workflow made."""
        for name in ("results", ".snakemake"):
            shutil.rmtree(self.directory / name, ignore_errors=True)

    def outputs(self) -> dict[str, Path]:
        """Files with their final names, apart from logs and timings."""
        found = [*self.directory.glob("results/runs/*.h5"), *self.directory.glob("results/tables/*.csv")]
        return {str(p.relative_to(self.directory)): p for p in found if not p.name.startswith(".")}

    def contents(self) -> dict[str, bytes]:
        return {name: path.read_bytes() for name, path in self.outputs().items()}

    def half_files(self) -> list[str]:
        """Files with a final name that are not whole."""
        return [name for name, path in self.outputs().items() if not is_whole(path)]


def is_whole(path: Path) -> bool:
    """Whether a run or a table is what was written."""
    try:
        if path.suffix == ".h5":
            Run.load(path)
        else:
            open_checked(path)
    except (ValueError, OSError):
        return False
    return True


@contextmanager
def workspace(directory: Path) -> Iterator[Workspace]:
    """A copy of the project with short runs; its compiled code comes along."""
    for part in PARTS:
        source = ROOT / part
        (shutil.copytree if source.is_dir() else shutil.copy2)(source, directory / part)
    path = directory / "config.yaml"
    config = yaml.safe_load(path.read_text(encoding="utf-8"))
    config["duration"] = DURATION
    path.write_text(yaml.safe_dump(config, sort_keys=False), encoding="utf-8")
    yield Workspace(directory)


def first_line(text: str, words: Sequence[str]) -> str | None:
    """The first line that holds all of some words."""
    return next((line for line in text.splitlines() if all(word in line for word in words)), None)
