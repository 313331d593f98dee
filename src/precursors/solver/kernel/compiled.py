"""How functions are compiled, and where the machine code is kept."""

from __future__ import annotations

import hashlib
import os
import tempfile
import warnings
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import numba
from numba import int64

Function = Callable[..., Any]
# `forceinline` and `config` are missing in Numba's type hints.
untyped: Any = numba

# Numba compiles a function anew for an argument that is a literal number, unless its variable has a type.
INDEX = {"block_1": int64}
_options: dict[str, Any] = {"error_model": "numpy", "locals": INDEX}
# Products may be fused with sums, but not in the event loop, in starts and in units.
inner: Any = untyped.njit(**_options, fastmath={"contract"}, forceinline=True)
seldom: Any = untyped.njit(**_options, fastmath={"contract"})
inner_unfused: Any = untyped.njit(**_options, forceinline=True)
unfused: Any = untyped.njit(**_options)


def entry(directory: Path, modules: Iterable[str] = (), **options: Any) -> Any:
    """Decorator for functions that Python calls; their code is kept until a module in `directory` is edited.

    Numba looks at the file in which a function stands, and not at those of the functions that it calls. So
    the code is kept in a directory that is named after the checksum of all modules, or of those named.
    """
    place = _cache_place(directory, checksum(directory, modules))

    def compile(function: Function) -> Any:
        if place is None:
            return untyped.njit(**options)(function)
        before = untyped.config.CACHE_DIR
        untyped.config.CACHE_DIR = str(place)
        try:
            return untyped.njit(**options, cache=True)(function)
        finally:
            untyped.config.CACHE_DIR = before

    return compile


def checksum(directory: Path, modules: Iterable[str] = ()) -> str:
    """Checksum of all modules in a directory, or of those named."""
    digest = hashlib.sha256()
    for file in [directory / name for name in modules] or sorted(directory.glob("*.py")):
        digest.update(f"{file.name} {file.stat().st_size} ".encode())
        digest.update(file.read_bytes())
    return digest.hexdigest()[:16]


def _cache_place(directory: Path, digest: str) -> Path | None:
    """A directory that can be written, named after the checksum of the modules; None, with a warning."""
    places = [directory / "__pycache__", Path("~/.cache/precursors").expanduser()]
    if untyped.config.CACHE_DIR:
        places = [Path(untyped.config.CACHE_DIR)]
    for base in places:
        place = base / f"numba-{directory.name}-{digest}"
        try:
            place.mkdir(parents=True, exist_ok=True)
            with tempfile.TemporaryFile(dir=place):
                return place
        except OSError:
            continue
    warnings.warn(
        f"compiled code cannot be kept in {' or '.join(map(os.fspath, places))}, so every process compiles "
        "for some 20 s: set NUMBA_CACHE_DIR to a directory that can be written",
        stacklevel=3,
    )
    return None


outer = entry(Path(__file__).parent, **_options, nogil=True)
