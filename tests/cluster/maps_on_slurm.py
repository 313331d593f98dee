"""The maps as jobs of a real SLURM: seen in its queue, ended in the middle, made up,
equal to local ones.

`make test-cluster` runs this file, which the ordinary run of the tests does not
collect.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from time import sleep

import psutil
from cluster.single_node import SlurmNode, slurm_node

ROOT = Path(__file__).parents[2]
CORES = int(os.environ.get("CORES", "2"))
MAP = "grid"
TABLE = f"results/tables/{MAP}.csv"
CHUNKS = 12
AXES = [
    {"key": "theta", "from": -0.95, "to": 0.95, "points": 64},
    {"key": "mu_k/mu_s", "from": 0.1, "to": 0.95, "points": 63},
]
SMALL = {"chunks": CHUNKS, "grid": AXES}
# What a machine of one node need not wait for; and a failed job shall stay failed until
# the next call.
IMPATIENT = [
    "--slurm-init-seconds-before-status-checks=3",
    "--latency-wait=5",
    "--retries=0",
]
SECONDS_BETWEEN_LOOKS = 0.1
PLANNED = {
    f"rule_run_chunk_wildcards_{MAP}_{i}of{CHUNKS}" for i in range(1, CHUNKS + 1)
}
# How a job is ended, by an administrator and by a lack of memory, and in which state
# the queue shows it then.
ENDS = {"cancelled": "CANCELLED", "killed": "FAILED"}


@dataclass(frozen=True)
class Call:
    """What became of one call of Snakemake."""

    code: int
    text: str
    states: dict[
        str, set[str]
    ]  # states in which squeue showed each job, by its comment
    chunks: set[str]  # the jobs whose chunks were there afterwards
    ended: dict[str, str]  # how jobs were ended, by their comment


def snakemake(
    directory: Path, *arguments: str, environment: dict[str, str]
) -> subprocess.Popen[bytes]:
    """Start Snakemake for the table of the map, in a directory beside the copy of the
    workflow."""
    source = directory.with_name("source")
    command = [
        sys.executable,
        "-m",
        "snakemake",
        "--snakefile=Snakefile",
        f"--directory={directory}",
    ]
    command += [*arguments, "--configfile", "config.yaml", "../small.yaml", "--", TABLE]
    with directory.with_suffix(".txt").open("wb") as output:
        environment = {**environment, "PYTHONPATH": str(source / "src")}
        return subprocess.Popen(
            command,
            cwd=source,
            env=environment,
            stdout=output,
            stderr=subprocess.STDOUT,
        )


def call(node: SlurmNode, directory: Path, *ends: str) -> Call:
    """Make the map on SLURM, and end some jobs in the middle."""
    left, before = list(ends), {job for job, *_ in jobs(node)}
    states: dict[str, set[str]] = {}
    ended: dict[str, str] = {}
    profile = "--profile=workflow/profiles/slurm"
    with snakemake(
        directory, profile, *IMPATIENT, environment=node.environment
    ) as process:
        while process.poll() is None:
            names = {job: name for job, _, name in jobs(node)}
            for job, state, name in jobs(node):
                if job not in before:
                    states.setdefault(name, set()).add(state)
            for job, chunk in chunks_at_work(directory).items():
                if left and names.get(job, "") not in {"", *ended}:
                    ended[names[job]] = left.pop(0)
                    if ended[names[job]] == "killed":
                        chunk.kill()
                    else:
                        node.query("scancel", job)
            sleep(SECONDS_BETWEEN_LOOKS)
    files = (directory / "results/ensembles").glob("*/*.csv")
    chunks = {
        f"rule_run_chunk_wildcards_{file.parent.name}_{file.stem}" for file in files
    }
    text = directory.with_suffix(".txt").read_text(encoding="utf-8")
    return Call(process.returncode, text, states, chunks, ended)


def jobs(node: SlurmNode) -> list[list[str]]:
    """Number, state and comment of every job that squeue shows, finished ones
    included."""
    listed = node.query("squeue", "--states=all", "--noheader", "--format=%i|%T|%k")
    return [line.split("|") for line in listed.splitlines()]


def chunks_at_work(directory: Path) -> dict[str, psutil.Process]:
    """The script of every chunk of this directory that runs, by the number of its
    job."""
    found = {}
    for process in psutil.process_iter():
        try:
            if "run_chunk.py" in " ".join(process.cmdline()) and process.cwd() == str(
                directory
            ):
                found[process.environ()["SLURM_JOB_ID"]] = process
        except (psutil.Error, KeyError):
            continue  # it ended while it was looked at, or is the shell around it
    return found


def test_jobs_ended_in_the_middle_are_made_up_by_the_next_call_and_all_chunks_are_local_ones(
    tmp_path,
):
    left_out = shutil.ignore_patterns("results", ".*", "tests", "wheelhouse")
    shutil.copytree(ROOT, tmp_path / "source", ignore=left_out)
    (tmp_path / "small.yaml").write_text(json.dumps(SMALL), encoding="utf-8")
    here, there = tmp_path / "here", tmp_path / "there"
    local = snakemake(here, f"--cores={CORES}", environment={**os.environ})
    assert local.wait() == 0, here.with_suffix(".txt").read_text(encoding="utf-8")
    with slurm_node(tmp_path / "slurm", CORES) as node:
        first = call(node, there, *ENDS)
        second = call(node, there)

    # Every chunk and nothing else was a job in the queue.
    assert set(first.states) == PLANNED
    assert all("RUNNING" in states for states in first.states.values()), first.states
    assert sorted(first.ended.values()) == sorted(ENDS)
    for name, how in first.ended.items():
        assert ENDS[how] in first.states[name]
        assert "COMPLETED" not in first.states[name]
    # The call says that jobs failed and finishes all others; the next one makes up
    # these and no other.
    assert first.code != 0
    assert first.text.count("Error in rule run_chunk") == len(ENDS), first.text
    assert first.chunks == PLANNED - first.ended.keys()
    assert second.code == 0, second.text
    assert second.states.keys() == first.ended.keys()
    made = [*sorted(here.glob("results/ensembles/*/*.csv")), here / TABLE]
    assert len(made) == len(PLANNED) + 1
    for file in made:
        assert (there / file.relative_to(here)).read_bytes() == file.read_bytes(), file
