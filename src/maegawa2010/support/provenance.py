"""Provenance of the results: versions, machine, configuration, and checksums of all
inputs and outputs."""

import hashlib
import os
import platform
import re
from collections.abc import Iterable, Mapping
from datetime import UTC, datetime
from importlib.metadata import distributions
from pathlib import Path
from typing import Any

from precursors.support.checkout import git_state

# Files on which the results depend, relative to the directory of the Snakefile.
SOURCES = (
    "Snakefile",
    "config.yaml",
    "requirements.lock",
    "paper/**/*",
    "src/**/*",
    "workflow/**/*",
)
# Files in the directory of the results that are not results.
NOT_RESULTS = (
    "README.md",
    "logs",
    "provenance.json",
    "report.html",
)


def provenance(config: Mapping[str, Any], root: Path, results: Path) -> dict[str, Any]:
    """Collect the provenance of the results, ready for JSON.

    Paths of inputs are relative to `root`, the directory of the Snakefile; paths of
    outputs are relative to `results`.
    """
    return {
        "written": datetime.now(UTC).isoformat(timespec="seconds"),
        "software": {
            "python": f"{platform.python_implementation()} {platform.python_version()}",
            "git": git_state(root),
        },
        "machine": {
            "system": platform.platform(),
            "processor": processor_name(),
            "cores": os.cpu_count(),
        },
        "packages": dict(
            sorted((p.metadata["Name"].lower(), p.version) for p in distributions())
        ),
        "config": config,
        "inputs": checksums(
            (path for pattern in SOURCES for path in root.glob(pattern)), root
        ),
        "outputs": checksums(results.rglob("*"), results, leave_out=NOT_RESULTS),
    }


def checksums(
    paths: Iterable[Path], root: Path, leave_out: tuple[str, ...] = ()
) -> dict[str, str]:
    """SHA-256 of files by path relative to `root`, without hidden and compiled files."""
    table = {}
    for path in sorted(paths):
        name = path.relative_to(root).as_posix()
        is_hidden = re.search(r"(^|/)(\.|__pycache__/)", name)
        if path.is_file() and not is_hidden and name.split("/")[0] not in leave_out:
            table[name] = hashlib.sha256(path.read_bytes()).hexdigest()
    return table


def processor_name() -> str:
    """Processor name from /proc/cpuinfo, or else its architecture."""
    cpuinfo = Path("/proc/cpuinfo")
    names = re.findall(
        r"model name\s*:\s*(.+)", cpuinfo.read_text() if cpuinfo.is_file() else ""
    )
    return next(iter(names), platform.processor() or platform.machine())
