"""Copies of the workflow for tests, and runs of Snakemake in them."""

import importlib
import multiprocessing
import os
import re
import shutil
import sys
import time
import warnings
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import snakemake.cli
from places import ROOT

from maegawa2010.support.digest import digest_code

# Each run of Snakemake is a fork of this process: imports and the search for plugins are
# made once.
for module in (
    "jsonschema",
    "nbformat",
    "maegawa2010.config",
    "precursors.proof",
    "smart_open",
    "snakemake.report",
    "snakemake.storage",
):
    importlib.import_module(module)
snakemake.cli.get_argument_parser()


@dataclass(frozen=True)
class Outcome:
    """Exit code and output of Snakemake."""

    code: int
    text: str

    @property
    def plan(self) -> list[tuple[str, set[str]]]:
        """Jobs that ran or would run, such as "simulate_scene fig10", with their outputs."""
        jobs = []
        for block in re.split(r"\n(?=(?:local)?rule \w+:)", self.text):
            if rule := re.match(r"(?:local)?rule (\w+):", block):
                scene = re.search(r"wildcards: scene=(\S+)", block)
                outputs = re.search(r"\n    output: (.+)", block)
                job = f"{rule[1]} {scene[1]}" if scene else rule[1]
                jobs.append((job, set(outputs[1].split(", ")) if outputs else set()))
        return jobs

    @property
    def jobs(self) -> set[str]:
        """The jobs, without the two that follow any other job."""
        return {job for job, _ in self.plan} - {"all", "write_provenance"}

    @property
    def made(self) -> set[str]:
        """The outputs of all jobs."""
        return set().union(*(outputs for _, outputs in self.plan))


@dataclass(frozen=True)
class Workspace:
    """A directory with a copy of the workflow, and the path of its library."""

    path: Path
    library: str = "src"

    def run(self, *arguments: str) -> Outcome:
        """Run Snakemake in the directory."""
        parse_the_code()
        output = self.path.with_name(f"{self.path.name}.txt")
        process = multiprocessing.get_context("fork").Process(
            target=_run_snakemake, args=(self.path, self.library, output, arguments)
        )
        process.start()
        process.join()
        assert process.exitcode is not None
        return Outcome(process.exitcode, output.read_text(encoding="utf-8"))

    def pretend(self, *targets: str) -> Outcome:
        """Write missing outputs with the name of their rule as content."""
        for job, outputs in self.run("-n", *targets).plan:
            for name in outputs:
                (self.path / name).parent.mkdir(parents=True, exist_ok=True)
                (self.path / name).write_text(job, encoding="utf-8")
        return self.run("-c1", "--touch", "--forceall", *targets)

    def would_run(self) -> set[str]:
        """Jobs that `snakemake -n` lists."""
        outcome = self.run("-n", "all")
        assert outcome.code == 0, outcome.text
        return outcome.jobs

    def edit(self, name: str, old: str, new: str) -> None:
        """Replace a text that occurs in a file exactly once; an empty one appends."""
        file = self.path / name
        text = file.read_text(encoding="utf-8")
        assert not old or text.count(old) == 1, (
            f"{old!r} occurs {text.count(old)} times in {name}"
        )
        file.write_text(text.replace(old, new) if old else text + new, encoding="utf-8")

    def add_scenes(self, scenes: str) -> None:
        """Add scenes to the configuration, given in YAML."""
        self.edit("config.yaml", "\nfig13: [", f"{scenes}\nfig13: [")

    def results(self) -> dict[str, tuple[int, bytes]]:
        """Modification time and content of every file in results."""
        files = filter(Path.is_file, (self.path / "results").rglob("*"))
        return {
            str(file.relative_to(self.path)): (
                file.stat().st_mtime_ns,
                file.read_bytes(),
            )
            for file in files
        }


@cache
def parse_the_code() -> None:
    """Parse all modules once: runs of Snakemake then have the syntax trees of unchanged
    ones in their caches."""
    for script in (ROOT / "workflow").rglob("*.py"):
        digest_code(ROOT, script.stem)


def _run_snakemake(
    directory: Path, library: str, output: Path, arguments: tuple[str, ...]
) -> None:
    os.chdir(directory)
    os.environ["PYTHONPATH"] = str((directory / library).resolve())
    sys.path.insert(0, os.environ["PYTHONPATH"])
    with output.open("w", encoding="utf-8") as file:
        os.dup2(file.fileno(), 1)
        os.dup2(file.fileno(), 2)
        sys.stdout = sys.stderr = os.fdopen(1, "w", buffering=1, encoding="utf-8")
        # Snakemake leaves a temporary directory for Python to remove, which warns.
        warnings.simplefilter("ignore", ResourceWarning)
        if "--touch" in arguments:  # Snakemake would wait 0.1 s per job
            time.sleep = lambda seconds: None
        snakemake.cli.main(list(arguments))


def copy_workflow(path: Path) -> Workspace:
    path.mkdir()
    for name in ("Snakefile", "config.yaml", "LICENSE-text", "CITATION.cff"):
        shutil.copy2(ROOT / name, path)
    unneeded = shutil.ignore_patterns("__pycache__", "*.png", "results")
    for name in ("workflow", "src", "paper", "profiles", "benchmarks"):
        shutil.copytree(ROOT / name, path / name, ignore=unneeded)
    return Workspace(path)
