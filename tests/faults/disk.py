"""No room, permission, directory or memory: a clear error, nothing is harmed, the next run goes on."""

from __future__ import annotations

import os
import resource
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from faults.outcome import Outcome
from faults.workspace import Witness, Workspace, jobs, wait_until, workspace

# Runs, tables made of them, a figure and the explorer.
FEW = ("results/tables/reproduction.csv", "results/figures/fig13.svg", "results/explorer.html")
DISK = 256 * 2**20
# Bytes left on the disk: for nothing, for marks of Snakemake, for a part of the files, for most of them.
ROOM = (0, 30_000, 150_000, 400_000, 1_500_000)
# Of address space: the interpreter starts, the numerical libraries do not, or a job does not.
MEMORY = (400e6, 550e6, 700e6)
# From the beginning of the first job to the deletion of results/ [s].
DELETED_AFTER = (0.5, 2.0, 4.0)
# Writes a file of each kind, then again with less and less room; says what is wrong, or "refused".
WRITE = """
import resource, sys
from pathlib import Path
import pandas as pd
from matplotlib.figure import Figure
from precursors.support.tables import write_table
from precursors import Chain, simulate
from precursors.figures.explorer import Scene, write_explorer
from precursors.figures import style

path = Path(sys.argv[1])
run = simulate(Chain.from_slider(), 3.0)
figure = Figure()
figure.subplots().plot(range(99))
table = pd.DataFrame({"a": [i / 7 for i in range(3000)]})
write = {
    "run.h5": run.save,
    "table.csv": lambda path: write_table(table, path),
    "figure.png": lambda path: style.save(figure, path),
    "figure.svg": lambda path: style.save(figure, path),
    "explorer.html": lambda path: write_explorer([Scene("fig10", "a", 0.0, run)], path),
}[path.name]
write(path)
old, names = path.read_bytes(), sorted(path.parent.rglob("*"))
for limit in (0, 100, 512, 4096, len(old) // 2, len(old) - 1):
    resource.setrlimit(resource.RLIMIT_FSIZE, (limit, resource.RLIM_INFINITY))
    try:
        write(path)
        said = "nothing was said"
    except OSError as error:
        said = str(error)
    resource.setrlimit(resource.RLIMIT_FSIZE, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
    if path.read_bytes() != old or sorted(path.parent.rglob("*")) != names:
        said = "the old file was harmed"
    fine = said.startswith("cannot write ") and str(path.parent) in said and len(said.splitlines()) == 1
    print("refused" if fine else f"{path.name}, limit of {limit} bytes: {said}", flush=True)
"""


def try_all(share: float = 1.0, processes: int = 2) -> list[Outcome]:
    """A full disk, a directory that is read-only or goes away, and too little memory."""
    with (
        tempfile.TemporaryDirectory() as directory,
        small_disk(Path(directory) / "disk") as mounted,
        workspace(Path(directory) / "disk", FEW) as work,
    ):
        # What is printed must not need the room that is missing.
        work.output = Path(directory) / "snakemake.out"
        code, text = work.run()
        if code != 0:
            return [Outcome("disk", 1, lost=[f"the undisturbed run failed: {text[-500:]}"])]
        right = work.contents()
        rooms = ROOM[: max(2, round(len(ROOM) * share))] if mounted else ()
        return [
            full_disk(work, right, rooms),
            no_room_for_a_file(work),
            read_only(work, right, mounted),
            gone(work, right, DELETED_AFTER[: max(1, round(3 * share))]),
            little_memory(work, right, MEMORY[: max(1, round(3 * share))]),
        ]


@contextmanager
def small_disk(place: Path, size: int = DISK) -> Iterator[bool]:
    """A file system of so many bytes at a place, and whether it could be mounted."""
    place.mkdir()
    mounted = _mount("-o", f"size={size}", place)
    try:
        yield mounted
    finally:
        if mounted:
            subprocess.run(["umount", "-l", place], check=True)


def _mount(*arguments: str | Path) -> bool:
    try:
        done = subprocess.run(
            ["mount", "-t", "tmpfs", *arguments[:-1], "tmpfs", arguments[-1]], capture_output=True
        )
    except FileNotFoundError:
        return False
    return done.returncode == 0


def _refused(work: Workspace, right: dict[str, bytes], code: int, text: str) -> str:
    """Judge a run that had to fail: nothing, or what is wrong."""
    witness = Witness(work, right)
    witness.look()
    if code == 0:
        return "nothing was said"
    if witness.wrong:
        return f"not right under a final name: {sorted(witness.wrong)}"
    said = [line for line in text.splitlines() if "rror" in line or "annot" in line or "No space" in line]
    return "" if said else f"no clear error in {text[-300:]!r}"


def _goes_on(work: Workspace, right: dict[str, bytes], finished: set[str]) -> str:
    """Go on without the fault: nothing, or what is wrong."""
    code, text = work.run()
    if code != 0 and "--unlock" in text:
        work.run("--unlock")
        code, text = work.run()
    if code != 0:
        return f"does not go on: {text[-300:]!r}"
    again = sorted(jobs(text)[0] & finished)
    if again:
        return f"made again without need: {again}"
    return _harmed(work, right)


def _harmed(work: Workspace, right: dict[str, bytes]) -> str:
    """What is not as in an undisturbed run; a file that nothing else needs may be gone with results/."""
    found = work.contents()
    missing = [target for target in work.targets if target not in found]
    wrong = sorted(name for name in found if found[name] != right.get(name))
    return f"outputs differ afterwards: {missing + wrong}" if missing or wrong else ""


def full_disk(work: Workspace, right: dict[str, bytes], rooms: tuple[int, ...]) -> Outcome:
    """The disk of the whole project fills up, with a little more room each time, then with enough."""
    outcome, finished = Outcome("disk full"), set[str]()
    if not rooms:
        outcome.note = "not tried: mounting takes a privilege"
        return outcome
    ballast = work.directory.parent / "ballast"
    work.clean()
    for room in rooms:
        ballast.unlink(missing_ok=True)
        disk = os.statvfs(work.directory)
        with ballast.open("wb") as file:
            # Whole pages: tmpfs counts in these.
            size = (disk.f_bavail * disk.f_frsize - room) // disk.f_frsize * disk.f_frsize
            os.posix_fallocate(file.fileno(), 0, size)
        code, text = work.run()
        if code != 0 and "LockException" in text:
            work.run("--unlock")
            code, text = work.run()
        again = sorted(jobs(text)[0] & finished)
        finished |= jobs(text)[1]
        answer = _refused(work, right, code, text) or (again and f"made again without need: {again}")
        outcome.count(f"{room} bytes left: {answer}" if answer else "refused")
    ballast.unlink()
    answer = _goes_on(work, right, finished)
    outcome.count(f"with room again: {answer}" if answer else "survived")
    return outcome


def no_room_for_a_file(work: Workspace) -> Outcome:
    """A limit on the size of a file stops the writing of each kind at any byte: the old file stays."""
    outcome = Outcome("no room for a file")
    path = f"{work.directory / 'src'}{os.pathsep}{work.directory / 'workflow/scripts'}"
    for name in ("run.h5", "table.csv", "figure.png", "figure.svg", "explorer.html"):
        with tempfile.TemporaryDirectory() as directory:
            done = subprocess.run(
                [sys.executable, "-c", WRITE, Path(directory) / name],
                env=work.environment | {"PYTHONPATH": path},
                capture_output=True,
                text=True,
            )
        for verdict in done.stdout.splitlines():
            outcome.count(verdict)
        if done.returncode != 0:
            outcome.count(f"{name}: {done.returncode}, {done.stderr[-300:]!r}")
    return outcome


def _limited(what: int, limit: int) -> Callable[[], None]:
    def limited() -> None:
        resource.setrlimit(what, (limit, limit))

    return limited


def read_only(work: Workspace, right: dict[str, bytes], mounted: bool) -> Outcome:
    """results/ is a directory that cannot be written to, or a file."""
    outcome = Outcome("results/ not writable")
    results = work.directory / "results"
    work.clean()
    results.mkdir()
    if os.geteuid() != 0:
        results.chmod(0o555)
        outcome.count(_judged(work, right, lambda: results.chmod(0o755)))
    elif mounted and _mount("-o", "ro", results):
        outcome.count(_judged(work, right, lambda: subprocess.run(["umount", "-l", results], check=True)))
    else:
        outcome.note = "read-only directory not tried: the superuser writes anywhere, and may not mount here"
    work.clean()
    results.write_text("not a directory")
    outcome.count(_judged(work, right, results.unlink))
    return outcome


def _judged(work: Workspace, right: dict[str, bytes], mend: Callable[[], object]) -> str:
    """A run that has to be refused, and one after it is mended."""
    code, text = work.run()
    answer = _refused(work, right, code, text)
    mend()
    return answer or _goes_on(work, right, jobs(text)[1]) or "refused"


def gone(work: Workspace, right: dict[str, bytes], moments: tuple[float, ...]) -> Outcome:
    """results/ is deleted while jobs run."""
    outcome = Outcome("results/ deleted")
    for moment in moments:
        work.clean()
        witness, process = Witness(work, right), work.start()
        wait_until(lambda process=process: process.poll() is not None or bool(jobs(work.text())[0]))  # type: ignore[misc]
        witness.watch(process, moment)
        shutil.rmtree(work.directory / "results", ignore_errors=True)
        code = process.wait()
        answer = _refused(work, right, code, work.text()) if code else _harmed(work, right)
        answer = answer or _goes_on(work, right, set())
        outcome.count(f"deleted after {moment} s: {answer}" if answer else "survived")
    return outcome


def little_memory(work: Workspace, right: dict[str, bytes], limits: tuple[float, ...]) -> Outcome:
    """Snakemake and its jobs with a limit on their address space."""
    outcome = Outcome("little memory")
    for limit in limits:
        work.clean()
        code, text = work.run(preexec_fn=_limited(resource.RLIMIT_AS, int(limit)))
        if code == 0:
            answer = _harmed(work, right) or "survived"
        else:
            answer = _refused(work, right, code, text) or _goes_on(work, right, jobs(text)[1]) or "refused"
        outcome.count(answer if answer in ("survived", "refused") else f"{limit / 1e6:g} MB: {answer}")
    return outcome
