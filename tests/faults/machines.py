"""Other machines: other processors, threads, Pythons, packages and paths; no display, home or compiler."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
import tomllib
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path

from faults.outcome import Outcome

ROOT = Path(__file__).parents[2]
SCENES = ("-5/6", "0", "5/6")
# Time of a transition [s] up to the first global slip, as README.md states it.
TIME = 1e-9
# The oldest is what pyproject.toml asks for.
PYTHONS = ("3.11", "3.12", "3.13", "3.14")
ODD_NAME = "with spaces, Ümläute and 摩擦"
# A directory that nobody can make, root included: it would lie below a file.
NOWHERE = dict.fromkeys(("HOME", "XDG_CACHE_HOME", "MPLCONFIGDIR"), "/dev/null/nowhere")
NO_DISPLAY = {"DISPLAY": "", "WAYLAND_DISPLAY": "", "MPLBACKEND": ""}
# All that the set-up calls apart from Python and sh: no compiler, assembler or linker.
TOOLS = ("make", "awk", "rm", "touch")
SET_UP = ("Makefile", "README.md", "LICENSE", "pyproject.toml", "requirements.lock", "src")
WORKFLOW = ("Snakefile", "config.yaml", "workflow", "paper", "src")

# Prints the transitions of the scenes to their first global slip, from one thread or from many.
RUNS = f"""
import json, sys
from precursors import Chain, simulate_many
chains = [Chain.from_slider(theta=theta) for theta in {SCENES}]
runs = simulate_many(chains * 4, 10.0, "global slip", threads=int(sys.argv[1]))[:3]
print(json.dumps([run.transitions[["time", "block", "mode"]].tolist() for run in runs]))
"""
FIGURE = """
import sys
from matplotlib.figure import Figure
from precursors.figures import style
with style.styled():
    figure = Figure()
    figure.subplots().plot([0, 1])
    figure.savefig(sys.argv[1])
"""

Transitions = list[list[list[float]]]
Trial = Callable[[Path], Transitions | None]


class NotHereError(Exception):
    """What a trial needs and this machine lacks, in a few words."""


def transitions(
    source: Path,
    environment: Mapping[str, str] | None = None,
    threads: int = 1,
    python: str | Path = sys.executable,
) -> Transitions:
    """Transitions of the scenes from another interpreter or environment, with the source in a directory."""
    variables = {"PYTHONPATH": str(source), **(environment or {})}
    return json.loads(_output([python, "-c", RUNS, str(threads)], source, variables))


def agreement(found: Transitions, right: Transitions) -> str:
    """ "survived" where blocks and modes are the same and times agree, or what does not."""
    for theta, ours, theirs in zip(SCENES, found, right, strict=True):
        if [t[1:] for t in ours] != [t[1:] for t in theirs]:
            return f"theta = {theta}: other transitions"
        worst = max(abs(a[0] - b[0]) for a, b in zip(ours, theirs, strict=True))
        if worst > TIME:
            return f"theta = {theta}: a transition is {worst:.1e} s off"
    return "survived"


def try_all(share: float = 1.0, processes: int = 2) -> list[Outcome]:
    """Every environment once; a small share leaves out those that install packages or compile anew."""
    right = transitions(ROOT / "src")
    threads, places, others = Outcome("threads"), Outcome("places"), Outcome("processors, Pythons, packages")
    with tempfile.TemporaryDirectory() as directory, ThreadPoolExecutor(processes) as pool:
        place = Path(directory)
        trials = [(threads, what, trial) for what, trial in THREADS.items()]
        trials += [(places, what, trial) for what, trial in PLACES.items()]
        if share >= 0.5:
            slow = [(places, what, trial) for what, trial in SLOW_PLACES.items()]
            slow += [(others, what, trial) for what, trial in OTHERS.items()]
            trials = slow + trials
        else:
            others.note = (
                "only in the whole of the trials: they install packages and compile for half a minute each"
            )
        begun = [
            (outcome, what, pool.submit(verdict, trial, place / str(number), right))
            for number, (outcome, what, trial) in enumerate(trials)
        ]
        for outcome, what, future in begun:
            try:
                answer = future.result()
            except NotHereError as lack:
                outcome.note = f"{outcome.note} Not tried: {what} ({lack}).".strip()
            else:
                outcome.count(answer if answer == "survived" else f"{what}: {answer}")
    return [threads, places, others]


def verdict(trial: Trial, place: Path, right: Transitions) -> str:
    """Outcome of one trial in a directory that goes afterwards; one that draws has no transitions."""
    place.mkdir()
    try:
        found = trial(place)
    except RuntimeError as error:
        return str(error)
    finally:
        shutil.rmtree(place, ignore_errors=True)
    return "survived" if found is None else agreement(found, right)


def _threads(number: int, place: Path) -> Transitions:
    return transitions(ROOT / "src", {"NUMBA_NUM_THREADS": str(number)}, number)


def _odd_path(place: Path) -> Transitions:
    source = place / ODD_NAME / "src"
    shutil.copytree(ROOT / "src", source)
    return transitions(source)


def _workflow_in_an_odd_path(place: Path) -> None:
    """Snakemake, with its interpreter in that path too."""
    odd = place / ODD_NAME
    odd.mkdir()
    _draw_with_snakemake(odd, {})


def _workflow_without_home(place: Path) -> None:
    """Snakemake asks for a directory for its cache, as docs/reliability.md says."""
    _draw_with_snakemake(place, NOWHERE | {"XDG_CACHE_HOME": str(place / "cache")})


def _draw_with_snakemake(place: Path, environment: Mapping[str, str]) -> None:
    _copy(WORKFLOW, place)
    _output([sys.executable, "-m", "venv", "--without-pip", ".venv"], place)
    [packages] = place.glob(".venv/lib/python*/site-packages")
    [ours] = [path for path in sys.path if path.endswith("site-packages")]
    (packages / "ours.pth").write_text(f"{ours}\n", encoding="utf-8")
    command = [".venv/bin/python", "-m", "snakemake", "-c1", "--quiet", "rules", "host", "--"]
    variables = {"PYTHONPATH": str(place / "src"), **environment}
    _output([*command, "results/figures/fig09.png"], place, variables)
    _is_drawn(place / "results/figures/fig09.png")


def _figure(place: Path) -> None:
    environment = NO_DISPLAY | NOWHERE | {"PYTHONPATH": str(ROOT / "src")}
    _output([sys.executable, "-c", FIGURE, "figure.png"], place, environment)
    _is_drawn(place / "figure.png")


def _is_drawn(path: Path) -> None:
    if not path.is_file() or path.stat().st_size < 1000:
        raise RuntimeError(f"{path.name} was not drawn")


def _uncompiled(place: Path) -> Path:
    source = place / "src"
    shutil.copytree(ROOT / "src", source, ignore=shutil.ignore_patterns("__pycache__"))
    return source


def _plain_processor(place: Path) -> Transitions:
    return transitions(_uncompiled(place), {"NUMBA_CPU_NAME": "generic"})


def _cache_elsewhere(place: Path) -> Transitions:
    found = transitions(_uncompiled(place), NOWHERE | {"NUMBA_CACHE_DIR": str(place / "cache")})
    if not any((place / "cache").rglob("*.nbc")):
        raise RuntimeError("the cache is empty")
    return found


def _set_up(place: Path) -> Transitions:
    """The Makefile's set-up from nothing, in an odd path, with an empty home and without a compiler."""
    uv = Path(sys.executable).with_name("uv")
    _reach_packages(uv)
    odd, tools, home = place / ODD_NAME, place / "tools", place / "home"
    for directory in (odd, tools, home):
        directory.mkdir()
    for tool in TOOLS:
        path = shutil.which(tool)
        if path is None:
            raise NotHereError(f"no {tool}")
        (tools / tool).symlink_to(path)
    _copy(SET_UP, odd)
    python = f"PYTHON={_python(f'{sys.version_info.major}.{sys.version_info.minor}')}"
    bare = {
        "PATH": str(tools),
        "HOME": str(home),
        "XDG_CACHE_HOME": "",
        "UV_CACHE_DIR": "",
        "CC": "",
        "CXX": "",
    }
    bare |= {"PYTHONPATH": "", "PYTHONDONTWRITEBYTECODE": ""}
    _output(["make", python, ".venv/ready"], odd, bare)
    return transitions(odd / "src", bare, python=odd / ".venv/bin/python")


def _locked(version: str, place: Path) -> Transitions:
    """Another Python, with the locked packages."""
    constraints = place / "constraints.txt"
    lines = (ROOT / "requirements.lock").read_text(encoding="utf-8").splitlines()
    constraints.write_text("\n".join(line.split(" \\")[0] for line in lines if line[:1].isalpha()))
    return _with_packages(version, place, "-c", constraints)


def _oldest(place: Path) -> Transitions:
    """The lower bounds of pyproject.toml."""
    return _with_packages(PYTHONS[0], place, "--resolution", "lowest-direct")


def _newest(place: Path) -> Transitions:
    """Whatever is newest on the newest Python that is here."""
    for version in reversed(PYTHONS):
        try:
            _python(version)
        except NotHereError:
            continue
        return _with_packages(version, place, "--resolution", "highest")
    raise NotHereError("no Python")


THREADS: dict[str, Trial] = {f"{number} threads": partial(_threads, number) for number in (1, 2, 4)}
PLACES: dict[str, Trial] = {
    "path with spaces and unicode": _odd_path,
    "workflow in a path with spaces and unicode": _workflow_in_an_odd_path,
    "no display": lambda place: transitions(ROOT / "src", NO_DISPLAY),
    "no home": lambda place: transitions(ROOT / "src", NOWHERE),
    "a figure without display and home": _figure,
    "workflow without home": _workflow_without_home,
}
SLOW_PLACES: dict[str, Trial] = {
    "set-up without a compiler": _set_up,
    "compile cache elsewhere": _cache_elsewhere,
}
OTHERS: dict[str, Trial] = {
    "oldest packages": _oldest,
    "newest packages": _newest,
    "a plain processor, without FMA": _plain_processor,
    **{f"Python {version}": partial(_locked, version) for version in PYTHONS},
}


def _with_packages(version: str, place: Path, *options: str | Path) -> Transitions:
    """Transitions in an environment that holds the library's dependencies alone."""
    uv, python = Path(sys.executable).with_name("uv"), _python(version)
    _reach_packages(uv)
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    environment = place / "environment"
    _output([uv, "venv", "-q", "-p", python, environment], place)
    install: list[str | Path] = [uv, "pip", "install", "-q", "-p", environment, "--only-binary=:all:"]
    _output([*install, *options, *project["dependencies"]], place)
    [packages] = environment.glob("lib/python*/site-packages")
    # The metadata of the project, which is not installed there.
    described = packages / "precursors-0.dist-info"
    described.mkdir()
    described.joinpath("METADATA").write_text("Metadata-Version: 2.1\nName: precursors\nVersion: 0\n")
    return transitions(_uncompiled(place), python=environment / "bin/python")


def _python(version: str) -> str:
    """Interpreter of a version."""
    found = sorted(Path.home().glob(f".pyenv/versions/{version}.*/bin/python"))
    for python in (*map(str, found), f"python{version}"):
        try:
            asked = [python, "-c", "import sys; print(sys.version)"]
            if _output(asked, ROOT).startswith(f"{version}."):
                return shutil.which(python) or python
        except (RuntimeError, OSError):
            continue
    raise NotHereError("it is not here")


def _reach_packages(uv: Path) -> None:
    with tempfile.TemporaryDirectory() as directory:
        asked: list[str | Path] = [
            uv,
            "pip",
            "install",
            "--dry-run",
            "-q",
            "--no-cache",
            "--no-deps",
            "--target",
            directory,
            "sympy",
        ]
        try:
            _output(asked, Path(directory))
        except (RuntimeError, OSError):
            raise NotHereError("no packages can be had") from None


def _copy(parts: Sequence[str], place: Path) -> None:
    for part in parts:
        source = ROOT / part
        (shutil.copytree if source.is_dir() else shutil.copy2)(source, place / part)


def _output(
    command: Sequence[str | Path], directory: Path, environment: Mapping[str, str] | None = None
) -> str:
    """What a command prints, or its last lines as a RuntimeError; an empty variable is unset."""
    variables = {key: value for key, value in {**os.environ, **(environment or {})}.items() if value}
    done = subprocess.run(
        command,
        env=variables,
        cwd=directory,
        capture_output=True,
        text=True,
        encoding="utf-8",
    )
    if done.returncode != 0:
        words = (done.stderr.strip() or done.stdout.strip() or "no word").splitlines()
        raise RuntimeError(" | ".join(words[-4:])[-500:])
    return done.stdout
