"""Where results come from: versions, machine, configuration, checksums of what went in and what came out."""

from __future__ import annotations

import hashlib
import os
import platform
import re
import subprocess
from collections.abc import Iterable, Mapping
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, distributions, version
from pathlib import Path
from typing import Any

# What the results depend on, as seen from the directory of the Snakefile.
SOURCES = (
    "Snakefile",
    "config.yaml",
    "requirements.lock",
    "paper/**/*",
    "src/precursors/**/*",
    "workflow/**/*",
)
# Written by Python beside its sources, and no source.
COMPILED = "__pycache__"
# In the directory of the results, and none of them.
NO_RESULTS = (
    "README.md",
    "benchmarks",
    "logs",
    "provenance.json",
    "report.html",
)

Files = dict[str, dict[str, str | int]]


def provenance(
    config: Mapping[str, Any], root: str | os.PathLike[str], results: str | os.PathLike[str]
) -> dict[str, Any]:
    """Collect what says how results came about, and tells later whether they are still the same.

    Parameters
    ----------
    config : mapping
        The configuration that the workflow ran with.
    root : path
        Directory of the Snakefile; inputs are named as seen from there.
    results : path
        Directory of the results.

    Returns
    -------
    dict
        Ready for JSON: written, software, machine, packages (installed), not_as_locked, config, and the size
        and SHA-256 of every file: inputs as seen from `root`, outputs as seen from `results`.
    """
    directory = Path(root)
    packages = installed_packages()
    return {
        "written": datetime.now(UTC).isoformat(timespec="seconds"),
        "software": {"precursors": _version("precursors"), "git": git_state(directory), **compilers()},
        "machine": {
            "system": platform.platform(),
            "processor": processor_name(),
            "cores": os.cpu_count(),
        },
        "packages": packages,
        "not_as_locked": departures(directory / "requirements.lock", packages),
        "config": config,
        "inputs": checksums(sources(directory), directory),
        "outputs": checksums(written_files(Path(results)), Path(results)),
    }


def sources(root: Path) -> list[Path]:
    """Files that the results depend on, in order."""
    found = {path for pattern in SOURCES for path in root.glob(pattern) if path.is_file()}
    return sorted(path for path in found if COMPILED not in path.parts)


def written_files(results: Path) -> list[Path]:
    """Return the results in order, without logs, times of jobs, and what is made from all of them."""
    found = [path for path in results.rglob("*") if path.is_file()]
    inside = {path: path.relative_to(results).parts for path in found}
    return sorted(
        path
        for path, parts in inside.items()
        if parts[0] not in NO_RESULTS and not any(part.startswith(".") for part in parts)
    )


def checksums(paths: Iterable[Path], root: Path) -> Files:
    """Size [bytes] and SHA-256 of files, by their names as seen from `root`."""
    table: Files = {}
    for path in paths:
        with path.open("rb") as file:
            digest = hashlib.file_digest(file, "sha256").hexdigest()
        table[path.relative_to(root).as_posix()] = {"bytes": path.stat().st_size, "sha256": digest}
    return table


def compilers() -> dict[str, str]:
    """Versions of Python and of what turns the kernel into machine code."""
    from llvmlite.binding import get_host_cpu_name, llvm_version_info

    return {
        "python": f"{platform.python_implementation()} {platform.python_version()}",
        "numba": _version("numba"),
        "llvm": ".".join(map(str, llvm_version_info)),
        "compiled_for": get_host_cpu_name(),
    }


def processor_name() -> str:
    """Name of the processor as its maker has it, or its kind where the system does not say."""
    try:
        text = Path("/proc/cpuinfo").read_text(encoding="utf-8")
    except OSError:
        text = ""
    named = re.search(r"^model name\s*:\s*(.+)$", text, flags=re.MULTILINE)
    return named[1] if named else _output("sysctl", "-n", "machdep.cpu.brand_string") or platform.machine()


def installed_packages() -> dict[str, str]:
    """Versions of all installed packages by their normalised names."""
    found = {_normalised(package.metadata["Name"]): package.version for package in distributions()}
    return dict(sorted(found.items()))


def departures(lock: Path, packages: Mapping[str, str]) -> dict[str, str]:
    """Packages of another version than the lock file's, as "installed, not locked"; empty without a lock."""
    if not lock.is_file():
        return {}
    locked = re.findall(r"^([\w.-]+)==([^\s;\\]+)", lock.read_text(encoding="utf-8"), flags=re.MULTILINE)
    wanted: dict[str, set[str]] = {}
    for name, number in locked:
        wanted.setdefault(_normalised(name), set()).add(number)
    return {
        name: f"{packages[name]}, not {' or '.join(sorted(numbers))}"
        for name, numbers in wanted.items()
        if name in packages and packages[name] not in numbers
    }


def git_state(root: Path) -> dict[str, str | bool] | None:
    """Commit of the sources and whether anything was changed since, or None where git does not know them."""
    commit = _output("git", "-C", str(root), "rev-parse", "HEAD")
    if not commit or not _output("git", "-C", str(root), "ls-files", "Snakefile"):
        return None
    return {"commit": commit, "changed": bool(_output("git", "-C", str(root), "status", "--porcelain"))}


def _output(*command: str) -> str:
    """What a command prints, or nothing if it fails or does not exist."""
    try:
        return subprocess.run(command, capture_output=True, text=True, check=True, timeout=20).stdout.strip()
    except (OSError, subprocess.SubprocessError):
        return ""


def _version(package: str) -> str:
    try:
        return version(package)
    except PackageNotFoundError:
        return "not installed"


def _normalised(name: str) -> str:
    return re.sub(r"[-_.]+", "-", name).lower()
