"""Kills at random moments, Ctrl-C, two Snakemakes at once: what is finished stays, nothing is half."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import tempfile
import time
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

from numpy.random import Generator, default_rng

from faults.disk import FEW
from faults.outcome import Outcome
from faults.workspace import TARGETS, Witness, Workspace, descendants, jobs, wait_until, workspace

SEED = 1964
KILLS, INTERRUPTS = 30, 12
ALL_TARGETS_FROM = 0.1
VICTIMS = ("Snakemake", "a job", "both")
# From the start of the first job on [s]; before it there is nothing to lose.
LATEST = 4.5
# After so many kills of each kind only what the messages say is done; later at once, as messages cost time.
BY_WORDS = 2
# Ctrl-C ends all within so many seconds of a free core; the rest is for a machine that is busy.
PROMPT = 2.0
GO_ON = "the same command goes on"
# A simulated time [s] that compiled code takes many seconds for, without a return to Python.
LONG = 60_000


def try_all(share: float = 1.0, processes: int = 2) -> list[Outcome]:
    """Kill, interrupt, and start twice; for a small share while few files are made."""
    targets = TARGETS if share >= ALL_TARGETS_FROM else FEW
    with tempfile.TemporaryDirectory() as directory, workspace(Path(directory), targets) as work:
        code, text = work.run()
        if code != 0:
            return [Outcome("kill", 1, lost=[f"the undisturbed run failed: {text[-500:]}"])]
        right = work.contents()
        return [
            kills(work, right, max(3, round(KILLS * share))),
            interrupts(work, right, max(4, round(INTERRUPTS * share))),
            two_at_once(work, right),
        ]


def kills(work: Workspace, right: dict[str, bytes], times: int) -> Outcome:
    """Kill Snakemake, a job, or both, and start again, until all is done; then from the beginning."""
    outcome, rng = Outcome("kill -9"), default_rng(SEED)
    finished: set[str] = set()
    work.clean()
    while outcome.tried < times:
        victim, by_words = VICTIMS[outcome.tried % 3], outcome.tried < BY_WORDS * len(VICTIMS)
        moment, witness = rng.uniform(0, LATEST), Witness(work, right)
        unsaid = _unlock(work, by_words)
        process = work.start()
        struck = _kill(process, witness, rng, victim, moment)
        again = jobs(work.text())[0] & finished
        finished |= jobs(work.text())[1]
        if struck:
            answer = (
                unsaid or _wrong(witness) or (f"made again without need: {sorted(again)}" if again else "")
            )
            if victim == "a job" and not answer and work.is_locked():
                answer = "Snakemake ended by itself and left its lock"
            outcome.count(f"{victim} at {moment:.2f} s: {answer}" if answer else "survived")
            continue
        _end(outcome, work, right, process.returncode, work.text())
        work.clean()
        finished.clear()
    _unlock(work, by_words=False)
    _end(outcome, work, right, *work.run())
    return outcome


def _kill(
    process: subprocess.Popen[bytes], witness: Witness, rng: Generator, victim: str, moment: float
) -> bool:
    """Kill at a moment after the first job began, and look; say whether there was anything to kill."""
    work = witness.work
    _wait_for_words(work, process, "    jobid: ")
    witness.watch(process, moment)
    struck = descendants(process.pid) if victim != "Snakemake" else []
    if victim == "a job" and struck:
        struck = [struck[rng.integers(len(struck))]]
    for job in struck:
        with suppress(ProcessLookupError):
            os.kill(job, signal.SIGKILL)
    if victim != "a job" and process.poll() is None:
        process.kill()
        struck.append(process.pid)
    witness.look(again=True)
    witness.watch(process)
    process.wait()
    witness.look(again=True)
    return bool(struck)


def _wait_for_words(work: Workspace, process: subprocess.Popen[bytes], words: str) -> None:
    """Wait until Snakemake has said something, or has ended."""
    wait_until(lambda: process.poll() is not None or words in work.text())


def _unlock(work: Workspace, by_words: bool) -> str:
    """Do what Snakemake asks for before it goes on where one was killed; say whether it did not ask."""
    if not work.is_locked():
        return ""
    text = work.run()[1] if by_words else "--unlock"
    if by_words:
        work.run("--unlock")
    else:
        shutil.rmtree(work.directory / ".snakemake/locks", ignore_errors=True)
    return "" if "--unlock" in text else f"did not ask to be unlocked: {text[-300:]!r}"


def _wrong(witness: Witness) -> str:
    return f"not right under a final name: {sorted(witness.wrong)}" if witness.wrong else ""


def _end(outcome: Outcome, work: Workspace, right: dict[str, bytes], code: int, text: str) -> None:
    """Judge a run that nobody stopped, and what is there when all is done."""
    if code != 0:
        outcome.count(f"the same command does not go on: {text[-400:]!r}")
    work.wait_for_orphans()
    found, left = work.contents(), work.leftovers()
    wrong = sorted(name for name in right.keys() | found.keys() if found.get(name) != right.get(name))
    if wrong:
        outcome.count(f"outputs differ from those of an undisturbed run: {wrong}")
    elif left:
        outcome.count(f"temporary files stay: {left}")


def interrupts(work: Workspace, right: dict[str, bytes], times: int) -> Outcome:
    """Ctrl-C, as a terminal sends it to Snakemake and its jobs; then the same command again, to the end."""
    outcome, rng = Outcome("Ctrl-C"), default_rng(SEED + 1)
    work.clean()
    while outcome.tried < times:
        # While it reads its rules, while it plans its jobs, and while it runs them.
        kind, witness = outcome.tried % 4, Witness(work, right)
        process = work.start()
        if kind == 0:
            witness.watch(process, rng.uniform(0.1, 2.5))
        elif kind == 1:
            _wait_for_words(work, process, "Building DAG")
            witness.watch(process, rng.uniform(0, 0.3))
        else:
            _wait_for_words(work, process, "    jobid: ")
            witness.watch(process, rng.uniform(0, LATEST))
        if process.poll() is None:
            answer = _interrupt(process, work) or _wrong(witness)
            outcome.count(f"after {len(jobs(work.text())[0])} jobs: {answer}" if answer else "survived")
            continue
        _end(outcome, work, right, process.returncode, work.text())
        work.clean()
    _end(outcome, work, right, *work.run())
    outcome.count(_interrupt_compiled_code(work) or "survived")
    return outcome


def _interrupt(process: subprocess.Popen[bytes], work: Workspace) -> str:
    """Press Ctrl-C once, and say what is wrong with what comes of it."""
    busy = max(1.0, os.getloadavg()[0] / (os.cpu_count() or 1))
    begin = time.monotonic()
    os.killpg(process.pid, signal.SIGINT)
    if not wait_until(lambda: process.poll() is not None, 20):
        process.kill()
        return "did not end within 20 s"
    seconds, text = time.monotonic() - begin, work.text()
    work.wait_for_orphans()
    if process.returncode != 0 and seconds > PROMPT * busy:
        return f"took {seconds:.1f} s to end"
    # Before Snakemake reads the rules, Python itself ends it.
    if process.returncode != 0 and GO_ON not in text and not text.endswith("KeyboardInterrupt\n"):
        return f"did not say how to go on: {text[-300:]!r}"
    return "left its lock" if work.is_locked() else ""


def _interrupt_compiled_code(work: Workspace) -> str:
    """Ctrl-C while a job is in compiled code, which has no ear for it."""
    work.clean()
    work = replace(work, targets=("results/runs/fig10.h5",))
    process = work.start("--config", f"duration={LONG}")
    _wait_for_words(work, process, "    jobid: ")
    # It imports for a second or two.
    time.sleep(5)
    if process.poll() is not None:
        return f"no long job to interrupt: {work.text()[-300:]!r}"
    return _interrupt(process, work)


def two_at_once(work: Workspace, right: dict[str, bytes]) -> Outcome:
    """A second Snakemake in the same directory is refused in words, and the first one does not notice."""
    outcome = Outcome("two Snakemakes")
    work.clean()
    second = work.output.with_name("second.out")
    first = work.start()
    wait_until(lambda: first.poll() is not None or work.is_locked())
    code = work.start(output=second).wait()
    text = second.read_text(encoding="utf-8")
    refused = code != 0 and ("cannot be locked" in text or "incomplete" in text)
    outcome.count("refused" if refused else f"the second was not refused: {text[-300:]!r}")
    _survive(outcome, work, right, first.wait())
    # In the same instant one of them, or the other, or neither is refused.
    work.clean()
    pair = [work.start(), work.start(output=second)]
    codes = [process.wait() for process in pair]
    _survive(outcome, work, right, min(codes))
    return outcome


def _survive(outcome: Outcome, work: Workspace, right: dict[str, bytes], code: int) -> None:
    """Count the Snakemake that was not refused."""
    fine = code == 0 and work.contents() == right
    outcome.count("survived" if fine else f"the first was disturbed: {work.text()[-300:]!r}")
