"""Other machines: another processor, other threads and Pythons, odd paths, no display, no home."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from faults.outcome import Outcome

ROOT = Path(__file__).parents[2]
SCENES = ("-5/6", "0", "5/6")
# Time of a transition [s] up to the first global slip, as README.md states it.
TIME = 1e-9
PYTHONS = ("3.11", "3.12", "3.13")
PACKAGES = ("numpy", "scipy", "numba", "pandas", "h5py", "matplotlib", "pillow", "sympy")

# Prints the transitions of the scenes to their first global slip, from one thread or from many.
RUNS = f"""
import json, sys
from precursors import Chain, simulate_many
chains = [Chain.from_slider(theta=theta) for theta in {SCENES}]
runs = simulate_many(chains * 4, 10.0, "global slip", threads=int(sys.argv[1]))[:3]
print(json.dumps([run.transitions[["time", "block", "mode"]].tolist() for run in runs]))
"""
FIGURE = """
from matplotlib.figure import Figure
from precursors.figures import style
with style.styled():
    figure = Figure()
    figure.subplots().plot([0, 1])
    figure.savefig("figure.png")
"""


def transitions(
    directory: Path, threads: int = 1, python: str | Path = sys.executable, **environment: str
) -> list[list[list[float]]]:
    """Transitions of the scenes from another interpreter or environment, with the source in a directory."""
    done = subprocess.run(
        [python, "-c", RUNS, str(threads)],
        env=os.environ | {"PYTHONPATH": str(directory)} | environment,
        capture_output=True,
        text=True,
        cwd=directory,
    )
    if done.returncode != 0:
        raise RuntimeError(done.stderr.strip().splitlines()[-1] if done.stderr.strip() else "no word")
    return json.loads(done.stdout)


def agreement(found: list[list[list[float]]], right: list[list[list[float]]]) -> str:
    """ "survived" where blocks and modes are the same and times agree, or what does not."""
    for theta, ours, theirs in zip(SCENES, found, right, strict=True):
        if [t[1:] for t in ours] != [t[1:] for t in theirs]:
            return f"theta = {theta}: other transitions"
        worst = max(abs(a[0] - b[0]) for a, b in zip(ours, theirs, strict=True))
        if worst > TIME:
            return f"theta = {theta}: a transition is {worst:.1e} s off"
    return "survived"


def trial(
    outcome: Outcome, right: list[list[list[float]]], what: str, directory: Path, **options: object
) -> None:
    """Count one environment."""
    try:
        answer = agreement(transitions(directory, **options), right)  # type: ignore[arg-type]
    except RuntimeError as error:
        answer = str(error)
    outcome.count(answer if answer == "survived" else f"{what}: {answer}")


def try_all(share: float = 1.0, processes: int = 2) -> list[Outcome]:
    """Every environment once; a small share leaves out those that compile anew."""
    threads, places, pythons = Outcome("threads"), Outcome("places"), Outcome("processors and Pythons")
    right = transitions(ROOT / "src")
    for n in (1, 2, 4):
        trial(threads, right, f"{n} threads", ROOT / "src", threads=n, NUMBA_NUM_THREADS=str(n))
    with tempfile.TemporaryDirectory() as directory:
        odd = Path(directory) / "with spaces, Ümläute and 摩擦" / "src"
        shutil.copytree(ROOT / "src", odd)
        trial(places, right, "path with spaces and unicode", odd)
        trial(places, right, "no display", ROOT / "src", DISPLAY="", WAYLAND_DISPLAY="", MPLBACKEND="")
        nowhere = {"HOME": "/nowhere", "XDG_CACHE_HOME": "/nowhere", "MPLCONFIGDIR": "/nowhere"}
        trial(places, right, "no home", ROOT / "src", **nowhere)
        places.count(_figure(Path(directory), nowhere))
        if share >= 0.5:
            _compile_anew(Path(directory), right, places, pythons, nowhere)
        else:
            pythons.note = "only in the whole of the trials: they compile for half a minute each"
    return [threads, places, pythons]


def _figure(directory: Path, environment: dict[str, str]) -> str:
    """Draw without a display and without a home."""
    bare = {key: value for key, value in os.environ.items() if key not in ("DISPLAY", "WAYLAND_DISPLAY")}
    done = subprocess.run(
        [sys.executable, "-c", FIGURE],
        cwd=directory,
        env=bare | {"PYTHONPATH": str(ROOT / "src")} | environment,
        capture_output=True,
        text=True,
    )
    good = done.returncode == 0 and (directory / "figure.png").stat().st_size > 1000
    return "survived" if good else f"figure without display and home: {done.stderr[-300:]!r}"


def _compile_anew(
    directory: Path,
    right: list[list[list[float]]],
    places: Outcome,
    pythons: Outcome,
    nowhere: dict[str, str],
) -> None:
    plain = directory / "generic" / "src"
    shutil.copytree(ROOT / "src", plain, ignore=shutil.ignore_patterns("__pycache__"))
    trial(pythons, right, "a plain processor, without FMA", plain, NUMBA_CPU_NAME="generic")
    cache = {"NUMBA_CACHE_DIR": str(directory / "cache")}
    trial(places, right, "compile cache elsewhere", plain, **cache, **nowhere)
    if not any((directory / "cache").rglob("*.nbc")):
        places.lost.append("compile cache elsewhere: it is empty")
    for version in PYTHONS:
        python = _environment(directory, version)
        if python is None:
            pythons.note = f"{pythons.note} Python {version} is not here.".strip()
        else:
            trial(pythons, right, f"Python {version}", plain, python=python)


def _environment(directory: Path, version: str) -> Path | None:
    """A virtual environment of another Python with the locked packages, or None where there is none."""
    if sys.version.startswith(version):
        return Path(sys.executable)
    found = sorted(Path.home().glob(f".pyenv/versions/{version}.*/bin/python"))
    python = str(found[-1]) if found else shutil.which(f"python{version}")
    if python is None:
        return None
    uv, place = Path(sys.executable).with_name("uv"), directory / f"python{version}"
    constraints = directory / "constraints.txt"
    lines = (ROOT / "requirements.lock").read_text(encoding="utf-8").splitlines()
    constraints.write_text("\n".join(line.split(" \\")[0] for line in lines if line[:1].isalpha()))
    for command in (
        [uv, "venv", "-q", "-p", python, place],
        [uv, "pip", "install", "-q", "-p", place, "--only-binary=:all:", "-c", constraints, *PACKAGES],
    ):
        if subprocess.run(command, capture_output=True).returncode != 0:
            return None
    _name_version(place)
    return place / "bin/python"


def _name_version(place: Path) -> None:
    """Give an environment the metadata of the project, which is not installed in it."""
    [packages] = place.glob("lib/python*/site-packages")
    described = packages / "precursors-0.dist-info"
    described.mkdir()
    described.joinpath("METADATA").write_text("Metadata-Version: 2.1\nName: precursors\nVersion: 0\n")
