"""A copy of the workflow to try things on, and Snakemake run in it."""

from __future__ import annotations

import importlib
import multiprocessing
import os
import re
import shutil
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest
import snakemake.cli

# Imported once here instead of in every run of Snakemake, which is a fork of this process.
for module in (
    "jsonschema",
    "nbformat",
    "smart_open",
    "precursors.config",
    "snakemake.report",
    "snakemake.storage",
):
    importlib.import_module(module)

ROOT = Path(__file__).parents[2]

# In place of every script: makes the outputs and computes nothing, for tests of which jobs are run.
STAND_IN = """
from pathlib import Path

for output in snakemake.output:
    Path(output).write_text(snakemake.rule)
Path(snakemake.log[0]).touch()
"""


@dataclass(frozen=True)
class Outcome:
    """What Snakemake returned and printed."""

    code: int
    text: str

    @property
    def jobs(self) -> set[str]:
        """Rules with their wildcards, such as "draw_scene fig10", of the jobs that were run or would be."""
        found = set()
        for block in re.split(r"\n(?=(?:local)?(?:rule|checkpoint) \w+:)", self.text):
            rule = re.match(r"(?:local)?rule (\w+):", block)
            scene = re.search(r"wildcards: scene=(\S+)", block)
            if rule:
                found.add(f"{rule[1]} {scene[1]}" if scene else rule[1])
        return found - {"all", "write_provenance"}  # these two come after whatever is run


@dataclass(frozen=True)
class Workspace:
    """A directory with a copy of the workflow."""

    path: Path

    def run(self, *arguments: str) -> Outcome:
        """Run Snakemake in the directory."""
        output = self.path.with_name(f"{self.path.name}.txt")
        process = multiprocessing.get_context("fork").Process(
            target=_run_snakemake, args=(self.path, output, list(arguments))
        )
        process.start()
        process.join()
        assert process.exitcode is not None
        return Outcome(process.exitcode, output.read_text(encoding="utf-8"))

    def would_run(self) -> set[str]:
        """Jobs that `snakemake -n` lists."""
        outcome = self.run("-n", "all")
        assert outcome.code == 0, outcome.text
        return outcome.jobs

    def edit(self, name: str, old: str, new: str) -> None:
        """Replace a text that stands in a file exactly once."""
        file = self.path / name
        text = file.read_text(encoding="utf-8")
        assert text.count(old) == 1, f"{old!r} stands {text.count(old)} times in {name}"
        file.write_text(text.replace(old, new), encoding="utf-8")

    def append(self, name: str, text: str) -> None:
        """Add a text to the end of a file."""
        with (self.path / name).open("a", encoding="utf-8") as file:
            file.write(text)

    def results(self) -> dict[str, tuple[int, bytes]]:
        """Time of change and content of every file in results."""
        files = sorted(path for path in (self.path / "results").rglob("*") if path.is_file())
        return {
            str(path.relative_to(self.path)): (path.stat().st_mtime_ns, path.read_bytes()) for path in files
        }


def _run_snakemake(directory: Path, output: Path, arguments: list[str]) -> None:
    os.chdir(directory)
    os.environ["PYTHONPATH"] = str(directory / "src")
    with output.open("w", encoding="utf-8") as file:
        os.dup2(file.fileno(), 1)
        os.dup2(file.fileno(), 2)
        sys.stdout = sys.stderr = os.fdopen(1, "w", buffering=1, encoding="utf-8")
        snakemake.cli.main(arguments)


def _copy_workflow(path: Path) -> Workspace:
    path.mkdir()
    for name in ("Snakefile", "config.yaml"):
        shutil.copy2(ROOT / name, path)
    for name in ("workflow", "src", "paper"):
        shutil.copytree(ROOT / name, path / name)
    return Workspace(path)


@pytest.fixture
def workspace(tmp_path: Path) -> Workspace:
    """A copy of the workflow that has not been run."""
    return _copy_workflow(tmp_path / "copy")


@pytest.fixture(scope="session")
def _finished(tmp_path_factory: pytest.TempPathFactory) -> Workspace:
    workspace = _copy_workflow(tmp_path_factory.mktemp("finished") / "copy")
    for script in (workspace.path / "workflow/scripts").glob("*.py"):
        script.write_text(STAND_IN, encoding="utf-8")
    outcome = workspace.run("-c2", "all")
    assert outcome.code == 0, outcome.text
    return workspace


@pytest.fixture
def finished(_finished: Workspace, tmp_path: Path) -> Workspace:
    """A copy of the workflow that has been run to the end, with stand-ins for the scripts."""
    shutil.copytree(_finished.path, tmp_path / "copy")
    return Workspace(tmp_path / "copy")
