"""Runs with noise as jobs of a real SLURM: one is cancelled and rerun, and all results
equal local ones.

Only `make test-cluster` runs this file.
"""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path
from time import sleep

from cluster.single_node import SlurmNode, slurm_node

ROOT = Path(__file__).parents[2]
CORES = int(os.environ.get("CORES", "2"))
TABLE = "results/tables/noise.csv"
CHUNKS = 4
SMALL = {"chunks": CHUNKS, "noise": {"runs": 4000}}
# Short waits, which suffice on one node; and a failed job is not retried in the same call.
IMPATIENT = [
    "--slurm-init-seconds-before-status-checks=3",
    "--latency-wait=5",
    "--retries=0",
]
SECONDS_BETWEEN_LOOKS = 0.1
JOB = "rule_run_noise_wildcards_"
PLANNED = {f"{JOB}{i}of{CHUNKS}" for i in range(1, CHUNKS + 1)}


def snakemake(
    directory: Path, *arguments: str, environment: dict[str, str]
) -> subprocess.Popen[bytes]:
    """Start Snakemake for the table of the noise study, in a directory beside the copy of
    the workflow."""
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


def call(
    node: SlurmNode, directory: Path, cancels: bool
) -> tuple[int, dict[str, set[str]]]:
    """Make the table on SLURM, and cancel the first running job if asked.

    Returns the exit code, and the states in which squeue showed each job, by comment.
    """
    before = {job for job, *_ in jobs(node)}
    states: dict[str, set[str]] = {}
    profile = "--profile=workflow/profiles/slurm"
    with snakemake(
        directory, profile, *IMPATIENT, environment=node.environment
    ) as process:
        while process.poll() is None:
            for job, state, name in jobs(node):
                if job in before:
                    continue
                states.setdefault(name, set()).add(state)
                if cancels and state == "RUNNING":
                    node.query("scancel", job)
                    cancels = False
            sleep(SECONDS_BETWEEN_LOOKS)
    return process.returncode, states


def jobs(node: SlurmNode) -> list[list[str]]:
    """Number, state and comment of every job, including finished ones."""
    listed = node.query("squeue", "--states=all", "--noheader", "--format=%i|%T|%k")
    return [line.split("|") for line in listed.splitlines()]


def test_a_cancelled_job_is_rerun_and_chunks_equal_local_ones(
    tmp_path,
):
    left_out = shutil.ignore_patterns("results", ".*", "tests")
    shutil.copytree(ROOT, tmp_path / "source", ignore=left_out)
    (tmp_path / "small.yaml").write_text(json.dumps(SMALL), encoding="utf-8")
    here = tmp_path / "here"
    there = tmp_path / "there"
    local = snakemake(here, f"--cores={CORES}", environment={**os.environ})
    assert local.wait() == 0, here.with_suffix(".txt").read_text(encoding="utf-8")
    with slurm_node(tmp_path / "slurm", CORES) as node:
        failed, states = call(node, there, cancels=True)
        made = {JOB + file.stem for file in there.glob("results/ensembles/*/*.csv")}
        again, missing = call(node, there, cancels=False)
    output = there.with_suffix(".txt").read_text(encoding="utf-8")

    # Every chunk was a job in the queue, and there were no other jobs.
    assert states.keys() == PLANNED
    assert all("RUNNING" in of_job for of_job in states.values()), states
    # The call fails but finishes all other jobs; the next call runs the cancelled one.
    cancelled = {name for name, of_job in states.items() if "CANCELLED" in of_job}
    assert failed
    assert len(cancelled) == 1
    assert made == PLANNED - cancelled
    assert again == 0, output
    assert missing.keys() == cancelled
    files = [*here.glob("results/ensembles/*/*.csv"), here / TABLE]
    assert len(files) == CHUNKS + 1
    for file in files:
        assert (there / file.relative_to(here)).read_bytes() == file.read_bytes(), file
