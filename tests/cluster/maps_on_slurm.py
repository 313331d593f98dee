"""The maps as jobs of a real SLURM: seen in its queue, killed in the middle, made up, equal to local ones.

`make test-cluster` runs this file, which the ordinary run of the tests does not collect.
"""

from __future__ import annotations

import json
import os
import shutil
import signal
import socket
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from time import sleep

import pytest
from cluster.single_node import DAEMONS, SlurmNode, daemon_pid, slurm_node

ROOT = Path(__file__).parents[2]
CORES = int(os.environ.get("CORES", "2"))
SOURCE = "source"  # the copy of the workflow
MAPS = ["map_theta_friction_ratio"]
TABLES = [f"results/tables/{name}.csv" for name in MAPS]
CHUNKS = 12
SMALL = {"ensembles": {"chunks": CHUNKS, "map": {"points": 4000}}}
# What a machine of one node need not wait for; and a failed job shall stay failed until the next call.
IMPATIENT = ["--slurm-init-seconds-before-status-checks=3", "--latency-wait=5", "--retries=0"]
# A chunk in the middle of its work has loaded its compiler.
AT_WORK = "libllvmlite"
SECONDS_BETWEEN_LOOKS = 0.1


def comment(study: str, chunk: str) -> str:
    """Comment of the job that makes a chunk."""
    return f"rule_run_chunk_wildcards_{study}_{chunk}"


PLANNED = {comment(study, f"{i}of{CHUNKS}") for study in MAPS for i in range(1, CHUNKS + 1)}


@dataclass(frozen=True)
class Call:
    """What became of one call of Snakemake."""

    code: int
    text: str
    states: dict[str, set[str]]  # states in which squeue showed each job, by its comment
    chunks: set[str]  # that were there afterwards


@dataclass(frozen=True)
class Trial:
    """Maps made locally, and on SLURM in two calls; in the first, one job was cancelled and one killed."""

    here: Path
    there: Path
    interrupted: dict[str, str]  # how each was ended, by its comment
    first: Call
    second: Call
    node: SlurmNode


@pytest.fixture(scope="module")
def trial(tmp_path_factory: pytest.TempPathFactory) -> Trial:
    directory = tmp_path_factory.mktemp("cluster")
    small = directory / "small.yaml"
    small.write_text(json.dumps(SMALL), encoding="utf-8")
    here, there, slurm = (directory / name for name in ("here", "there", "slurm"))
    slurm.mkdir()
    copy_workflow(directory / SOURCE)
    local = snakemake(here, small, f"--cores={CORES}")
    assert local.wait() == 0, output_of(here)
    with slurm_node(slurm, CORES) as node:
        interrupted: dict[str, str] = {}
        first = call(node, there, small, interrupted, ["cancelled", "killed"])
        second = call(node, there, small, interrupted, [])
    return Trial(here, there, interrupted, first, second, node)


def copy_workflow(source: Path) -> None:
    """Copy the workflow with its compiled code: an edit between two calls would have chunks made anew."""
    source.mkdir()
    for name in ("Snakefile", "config.yaml"):
        shutil.copy2(ROOT / name, source)
    for name in ("workflow", "src", "paper"):
        shutil.copytree(ROOT / name, source / name)


def snakemake(
    directory: Path, small: Path, *arguments: str, environment: dict[str, str] | None = None
) -> subprocess.Popen[bytes]:
    """Start Snakemake for the tables of the maps, in a directory beside the copy of the workflow."""
    source = directory.with_name(SOURCE)
    command = [
        sys.executable,
        "-m",
        "snakemake",
        "--snakefile=Snakefile",
        f"--directory={directory}",
        *arguments,
    ]
    command += ["--configfile", "config.yaml", str(small), "--", *TABLES]
    with directory.with_suffix(".txt").open("wb") as output:
        return subprocess.Popen(
            command,
            cwd=source,
            env={**(environment or os.environ), "PYTHONPATH": str(source / "src")},
            stdout=output,
            stderr=subprocess.STDOUT,
        )


def output_of(directory: Path) -> str:
    """What the last call of Snakemake in a directory printed."""
    return directory.with_suffix(".txt").read_text(encoding="utf-8")


def call(node: SlurmNode, directory: Path, small: Path, interrupted: dict[str, str], ends: list[str]) -> Call:
    """Make the maps on SLURM, and end some jobs in the middle as told."""
    before = {job for job, _, _ in jobs(node)}
    states: dict[str, set[str]] = {}
    profile = "--profile=workflow/profiles/slurm"
    with snakemake(directory, small, profile, *IMPATIENT, environment=node.environment) as process:
        while process.poll() is None:
            names = {}
            for job, state, name in jobs(node):
                names[job] = name
                if job not in before:
                    states.setdefault(name, set()).add(state)
            for job, pid in chunks_at_work(directory) if ends else ():
                if ends and names[job] not in interrupted and end_job(node, job, pid, ends[0]):
                    interrupted[names[job]] = ends.pop(0)
            sleep(SECONDS_BETWEEN_LOOKS)
    files = (directory / "results/ensembles").glob("*/*.csv")
    chunks = {comment(file.parent.name, file.stem) for file in files}
    return Call(process.returncode, output_of(directory), states, chunks)


def jobs(node: SlurmNode) -> list[list[str]]:
    """Number, state and comment of every job that squeue shows, finished ones included."""
    return [
        line.split("|")
        for line in node.query("squeue", "--states=all", "--noheader", "--format=%i|%T|%k").splitlines()
    ]


def chunks_at_work(directory: Path) -> Iterator[tuple[str, int]]:
    """Number of the job and process id of every script of a chunk of this directory that runs its members."""
    for process in Path("/proc").glob("[0-9]*"):
        try:
            ours = Path(os.readlink(process / "cwd")) == directory
            if ours and b"run_chunk.py" in (process / "cmdline").read_bytes():
                environment = dict(
                    entry.split("=", 1)
                    for entry in (process / "environ").read_text().split("\0")
                    if "=" in entry
                )
                if AT_WORK in (process / "maps").read_text() and "SLURM_JOB_ID" in environment:
                    yield environment["SLURM_JOB_ID"], int(process.name)
        except OSError:
            continue  # it ended while it was looked at


def end_job(node: SlurmNode, job: str, pid: int, how: str) -> bool:
    """End a job as an administrator does (cancelled) or as a lack of memory does (killed)."""
    if how == "cancelled":
        node.query("scancel", job)
        return True
    try:
        os.kill(pid, signal.SIGKILL)
    except ProcessLookupError:
        return False
    return True


def test_every_chunk_of_every_map_and_nothing_else_was_a_job_in_the_queue(trial):
    assert len(PLANNED) > len(MAPS)
    assert set(trial.first.states) == PLANNED
    assert all("RUNNING" in states for states in trial.first.states.values()), trial.first.states


def test_one_job_was_cancelled_and_one_killed_in_the_middle(trial):
    assert sorted(trial.interrupted.values()) == ["cancelled", "killed"]
    last = {"cancelled": "CANCELLED", "killed": "FAILED"}
    for name, how in trial.interrupted.items():
        assert last[how] in trial.first.states[name]
        assert "COMPLETED" not in trial.first.states[name]


def test_the_call_says_that_jobs_failed_and_finishes_all_others(trial):
    assert trial.first.code != 0
    assert trial.first.text.count("Error in rule run_chunk") == len(trial.interrupted), trial.first.text
    assert trial.first.chunks == PLANNED - trial.interrupted.keys()


def test_the_next_call_makes_up_these_two_and_no_other(trial):
    assert trial.second.code == 0, trial.second.text
    assert trial.second.states.keys() == trial.interrupted.keys()
    assert trial.second.chunks == PLANNED


def test_chunks_are_equal_to_local_ones_to_the_last_bit(trial):
    chunks = sorted((trial.here / "results/ensembles").glob("*/*.csv"))
    assert len(chunks) == len(PLANNED)
    for chunk in chunks:
        assert (trial.there / chunk.relative_to(trial.here)).read_bytes() == chunk.read_bytes(), chunk


@pytest.mark.parametrize("table", TABLES)
def test_the_gathered_table_is_equal_to_the_local_one(trial, table):
    assert (trial.there / table).read_bytes() == (trial.here / table).read_bytes()


def test_no_daemon_is_left(trial):
    assert {daemon: daemon_pid(trial.node, daemon) for daemon in DAEMONS} == dict.fromkeys(DAEMONS)
    for name in ("SlurmctldPort", "SlurmdPort"):
        with socket.socket() as client:
            assert client.connect_ex(("127.0.0.1", trial.node.port(name))) != 0
