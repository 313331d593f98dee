"""Kills at random moments, interrupts, two Snakemakes at once: what is finished stays, nothing is half."""

from __future__ import annotations

import os
import signal
import subprocess
import tempfile
import time
from contextlib import suppress
from pathlib import Path

from numpy.random import Generator, default_rng

from faults.outcome import Outcome
from faults.workspace import Workspace, workspace

SEED = 1964
KILLS, INTERRUPTS = 30, 8
# From the start of the first job on; before it there is nothing to lose.
EARLIEST, LATEST = 1.0, 7.0
# An interrupt ends all within so many seconds of a free core; the rest is for a machine that is busy.
PROMPT = 2.0
GO_ON = "the same command goes on"


def try_all(share: float = 1.0, processes: int = 2) -> list[Outcome]:
    """Kill, interrupt, and start twice."""
    with tempfile.TemporaryDirectory() as directory, workspace(Path(directory)) as work:
        code, text = work.run()
        if code != 0:
            return [Outcome("kill", 1, lost=[f"the undisturbed run failed: {text[-500:]}"])]
        right = work.contents()
        return [
            kills(work, right, max(3, round(KILLS * share))),
            interrupts(work, right, max(2, round(INTERRUPTS * share))),
            two_at_once(work, right),
        ]


def kills(work: Workspace, right: dict[str, bytes], times: int) -> Outcome:
    """Kill Snakemake, a job, or both, and start again."""
    outcome, rng = Outcome("kill -9"), default_rng(SEED)
    work.clean()
    for number in range(times):
        victim = ("Snakemake", "a job", "both")[number % 3]
        moment = rng.uniform(EARLIEST, LATEST)
        if work.contents() == right:
            work.clean()
        answer = _kill(work, rng, victim, moment) or _go_on(work, right)
        outcome.count(f"{victim} at {moment:.2f} s: {answer}" if answer else "survived")
    return outcome


def _kill(work: Workspace, rng: Generator, victim: str, moment: float) -> str:
    """Kill at a moment; say what is wrong right then, or nothing."""
    process = work.start()
    with suppress(Exception):
        process.wait(moment)
    if victim != "Snakemake":
        _kill_jobs(process.pid, rng, all_of_them=victim == "both")
    if victim != "a job" and process.poll() is None:
        process.kill()
    half = work.half_files()
    process.communicate()
    half += work.half_files()
    return f"half files: {half}" if half else ""


def _kill_jobs(pid: int, rng: Generator, all_of_them: bool) -> None:
    jobs = _descendants(pid)
    for job in jobs if all_of_them or not jobs else [jobs[rng.integers(len(jobs))]]:
        with suppress(ProcessLookupError):
            os.kill(job, signal.SIGKILL)


def _descendants(pid: int) -> list[int]:
    """Processes that a process started, and those that they started."""
    listed = subprocess.run(["ps", "-eo", "pid=,ppid="], capture_output=True, text=True, check=True).stdout
    parents = [tuple(map(int, line.split())) for line in listed.splitlines()]
    found = [child for child, parent in parents if parent == pid]
    for child in found:
        found.extend(grandchild for grandchild, parent in parents if parent == child)
    return found


def _go_on(work: Workspace, right: dict[str, bytes]) -> str:
    """Do as the messages say, and compare: say what is wrong, or nothing."""
    before = {name: path.stat().st_mtime_ns for name, path in work.outputs().items()}
    marked = list((work.directory / ".snakemake").glob("incomplete/**/*"))
    code, text = work.run()
    options: list[str] = []
    for _ in range(3):
        if code == 0:
            break
        if "--unlock" in text:
            work.run("--unlock")
        elif "--rerun-incomplete" in text:
            options = ["--rerun-incomplete"]
        code, text = work.run(*options)
    if code != 0:
        return f"does not go on: {text[-400:]!r}"
    found = work.contents()
    if found != right:
        wrong = sorted(name for name in right if found.get(name) != right[name])
        return f"outputs differ from those of an undisturbed run: {wrong}"
    again = [name for name, at in before.items() if work.outputs()[name].stat().st_mtime_ns != at]
    # What Snakemake marked as begun has to be made again, and what depends on it with it.
    return f"made again without need: {again}" if again and not marked else ""


def interrupts(work: Workspace, right: dict[str, bytes], times: int) -> Outcome:
    """Ctrl-C, as a terminal sends it to Snakemake and its jobs."""
    outcome, rng = Outcome("Ctrl-C"), default_rng(SEED + 1)
    for _ in range(times):
        work.clean()
        moment = rng.uniform(EARLIEST + 2, LATEST - 2)
        process = work.start()
        with suppress(Exception):
            process.wait(moment)
        if process.poll() is not None:
            process.communicate()
            continue
        begin = time.monotonic()
        os.killpg(process.pid, signal.SIGINT)
        text, _ = process.communicate()
        seconds = time.monotonic() - begin
        answer = ""
        if work.contents() != right:
            if seconds > PROMPT * max(1.0, os.getloadavg()[0] / (os.cpu_count() or 1)):
                answer = f"took {seconds:.1f} s to end"
            elif GO_ON not in text and "Traceback" not in text:
                answer = f"did not say how to go on: {text[-300:]!r}"
        answer = answer or _go_on(work, right)
        outcome.count(f"at {moment:.2f} s: {answer}" if answer else "survived")
    return outcome


def two_at_once(work: Workspace, right: dict[str, bytes]) -> Outcome:
    """A second Snakemake in the same directory is refused in words, and the first one does not notice."""
    outcome = Outcome("two Snakemakes")
    work.clean()
    first = work.start()
    lock = work.directory / ".snakemake/locks"
    while first.poll() is None and not (lock.is_dir() and any(lock.iterdir())):
        time.sleep(0.05)
    code, text = work.run()
    first.communicate()
    refused = code != 0 and ("cannot be locked" in text or "incomplete" in text)
    outcome.count("refused" if refused else f"the second was not refused: {text[-300:]!r}")
    outcome.count(
        "survived" if first.returncode == 0 and work.contents() == right else "the first was disturbed"
    )
    return outcome
