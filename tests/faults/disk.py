"""No room, permission, directory or memory: a clear error, nothing is harmed, the next run goes on."""

from __future__ import annotations

import os
import resource
import shutil
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from faults.outcome import Outcome
from faults.workspace import Workspace, workspace

# Room [bytes] that is left on the small disk: for nothing, for a part of the runs, for most of them.
ROOM = (4096, 40_000, 100_000, 200_000, 300_000)
# Of address space: the interpreter starts, the numerical libraries do not, or a job does not.
MEMORY = (400e6, 700e6, 1000e6)
WRITE = """
import sys
from precursors import Chain, simulate
try:
    simulate(Chain.from_slider(), 3.0).save(sys.argv[1])
except OSError as error:
    sys.exit(f"refused: {error}")
"""


def try_all(share: float = 1.0, processes: int = 2) -> list[Outcome]:
    """A full disk, a directory that is read-only or goes away, and too little memory."""
    with tempfile.TemporaryDirectory() as directory, workspace(Path(directory)) as work:
        code, text = work.run()
        if code != 0:
            return [Outcome("disk", 1, lost=[f"the undisturbed run failed: {text[-500:]}"])]
        right = work.contents()
        rooms = ROOM[: max(2, round(len(ROOM) * share))]
        return [
            full_disk(work, right, rooms),
            full_disk_anywhere(work),
            read_only(work, right),
            gone(work, right, max(1, round(3 * share))),
            little_memory(work, right, MEMORY[: max(1, round(3 * share))]),
        ]


def _ended_well(work: Workspace, right: dict[str, bytes], harm: str, code: int, text: str) -> str:
    """Judge a run that had to fail, then go on without the fault: "refused", or what is wrong."""
    if code == 0:
        return f"{harm}: nothing was said"
    half = work.half_files()
    if half:
        return f"{harm}: half files {half}"
    lines = [line for line in text.splitlines() if "rror" in line or "annot" in line or "No space" in line]
    if not lines:
        return f"{harm}: no clear error in {text[-300:]!r}"
    return _goes_on(work, right, harm) or "refused"


def _goes_on(work: Workspace, right: dict[str, bytes], harm: str) -> str:
    code, text = work.run("--rerun-incomplete")
    if code != 0 and "--unlock" in text:
        work.run("--unlock")
        code, text = work.run("--rerun-incomplete")
    if code != 0:
        return f"{harm}: does not go on: {text[-300:]!r}"
    return "" if work.contents() == right else f"{harm}: outputs differ afterwards"


@contextmanager
def small_disk(place: Path, size: int) -> Iterator[None]:
    """A file system of so many bytes at a place."""
    place.mkdir(parents=True, exist_ok=True)
    subprocess.run(
        ["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", place], check=True, capture_output=True
    )
    try:
        yield
    finally:
        subprocess.run(["umount", "-l", place], check=True)


def full_disk(work: Workspace, right: dict[str, bytes], rooms: tuple[int, ...]) -> Outcome:
    """The whole of results/ on a disk that fills up."""
    outcome = Outcome("disk full")
    for room in rooms:
        work.clean()
        harm = f"disk of {room} bytes"
        try:
            with small_disk(work.directory / "results", room):
                code, text = work.run()
                half = work.half_files()
        except (subprocess.CalledProcessError, FileNotFoundError):
            return Outcome("disk full", note="not tried: mounting takes a privilege")
        if half:
            outcome.count(f"{harm}: half files {half}")
        else:
            outcome.count(_ended_well(work, right, harm, code, text))
    return outcome


def full_disk_anywhere(work: Workspace) -> Outcome:
    """A limit on the size of a file stops the writing of a run at any byte: the old file stays."""
    outcome = Outcome("no room for a file")
    with tempfile.TemporaryDirectory() as directory:
        path = Path(directory) / "run.h5"
        subprocess.run([sys.executable, "-c", WRITE, path], env=work.environment, check=True)
        old, size = path.read_bytes(), path.stat().st_size
        for limit in [0, 100, 512, 4096, size // 2, size - 1]:
            done = subprocess.run(
                [sys.executable, "-c", WRITE, path],
                env=work.environment,
                capture_output=True,
                text=True,
                preexec_fn=_limited(resource.RLIMIT_FSIZE, limit),
            )
            left = [p.name for p in Path(directory).iterdir()]
            if path.read_bytes() != old or left != ["run.h5"]:
                outcome.count(f"limit of {limit} bytes: left {left}")
            elif (
                done.returncode != 1 or not done.stderr.startswith("refused: ") or done.stderr.count("\n") > 1
            ):
                outcome.count(f"limit of {limit} bytes: {done.returncode}, {done.stderr[-200:]!r}")
            else:
                outcome.count("refused")
    return outcome


def _limited(what: int, limit: int) -> Callable[[], None]:
    def limited() -> None:
        resource.setrlimit(what, (limit, limit))

    return limited


def read_only(work: Workspace, right: dict[str, bytes]) -> Outcome:
    """results/ is a directory that cannot be written to, or a file."""
    outcome = Outcome("results/ not writable")
    results = work.directory / "results"
    if os.geteuid() != 0:
        work.clean()
        results.mkdir()
        results.chmod(0o555)
        code, text = work.run()
        results.chmod(0o755)
        outcome.count(_ended_well(work, right, "read-only results/", code, text))
    else:
        work.clean()
        results.mkdir()
        try:
            subprocess.run(
                ["mount", "-t", "tmpfs", "-o", "ro", "tmpfs", results], check=True, capture_output=True
            )
            code, text = work.run()
            subprocess.run(["umount", "-l", results], check=True)
            outcome.count(_ended_well(work, right, "read-only results/", code, text))
        except (subprocess.CalledProcessError, FileNotFoundError):
            outcome.note = (
                "read-only directory not tried: the superuser writes anywhere, and may not mount here"
            )
    work.clean()
    results.write_text("not a directory")
    code, text = work.run()
    results.unlink()
    outcome.count(_ended_well(work, right, "results a file", code, text))
    return outcome


def gone(work: Workspace, right: dict[str, bytes], times: int) -> Outcome:
    """results/ is deleted while jobs run."""
    outcome = Outcome("results/ deleted")
    for number in range(times):
        work.clean()
        process = work.start()
        timer = threading.Timer(3.0 + 1.3 * number, shutil.rmtree, [work.directory / "results", True])
        timer.start()
        process.communicate()
        timer.join()
        time.sleep(0.1)
        harm = f"deleted after {3.0 + 1.3 * number:.1f} s"
        half = work.half_files()
        answer = f"{harm}: half files {half}" if half else _goes_on(work, right, harm)
        outcome.count(answer or "survived")
    return outcome


def little_memory(work: Workspace, right: dict[str, bytes], limits: tuple[float, ...]) -> Outcome:
    """Snakemake and its jobs with a limit on their address space."""
    outcome = Outcome("little memory")
    for limit in limits:
        work.clean()
        code, text = work.run(preexec_fn=_limited(resource.RLIMIT_AS, int(limit)))
        harm = f"{limit / 1e6:g} MB of address space"
        if code == 0:
            outcome.count("survived" if work.contents() == right else f"{harm}: outputs differ")
        else:
            outcome.count(_ended_well(work, right, harm, code, text))
    return outcome
