"""Cache compiled code until its sources change."""

import hashlib
import os
import pickle
import shutil
import sys
import tempfile
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numba
from numba.core import event
from numba.core.caching import UserWideCacheLocator

from precursors.support.files import LEAST_ROOM

Function = Callable[..., Any]
# `forceinline` and `config` are missing in Numba's type hints.
untyped: Any = numba
if untyped.config.DISABLE_JIT:
    raise ImportError("the solver must be compiled: unset NUMBA_DISABLE_JIT")

CACHED_VERSIONS = 20  # versions of the sources whose machine code stays cached


class UserCache(UserWideCacheLocator):
    """Let Numba cache machine code in `place`, which all clones with the same sources
    share.

    Numba's own locators use the directory of the sources, so each clone would compile.
    """

    place = Path()

    def __init__(self, function: Function, file: str) -> None:
        super().__init__(function, file)
        self._place = self.place

    def get_cache_path(self) -> str:
        """Return the name of the directory."""
        return os.fspath(self._place)

    def get_source_stamp(self) -> str:
        """Return a stamp that changes with the sources."""
        return self._place.name


def entry(*sources: Path, **options: Any) -> Any:
    """Decorate a function that Python calls: its code is cached until a source changes.

    The sources are modules or directories of modules. Numba checks only the file of the
    function itself, not those of the functions that it calls. The cache directory is
    therefore named after the first source and the checksum of all of them.
    """
    place = _cache_place(sources[0].stem, checksum(*sources))

    def compile(function: Function) -> Any:
        if place is None:
            return untyped.njit(**options)(function)
        before = untyped.config.CACHE_LOCATOR_CLASSES
        untyped.config.CACHE_LOCATOR_CLASSES = f"{__name__}.{UserCache.__name__}"
        UserCache.place = place
        try:
            return untyped.njit(**options, cache=True)(function)
        finally:
            untyped.config.CACHE_LOCATOR_CLASSES = before

    return compile


class Announcement(event.Listener):
    """Print a message on stderr when the first function is compiled.

    Install it with `event.install_listener("numba:compile", ...)`.
    """

    is_made = False

    def on_start(self, _: event.Event) -> None:
        """Print the message once."""
        if not self.is_made:
            self.is_made = True
            print(
                "compiling the solver for this machine, once: some 10 s",
                file=sys.stderr,
                flush=True,
            )

    def on_end(self, _: event.Event) -> None:
        """Ignore the end of a compilation."""


def checksum(*sources: Path) -> str:
    """Return a checksum of modules or directories of modules, and of Numba's
    version."""
    digest = hashlib.sha256(numba.__version__.encode())
    for source in sources:
        for file in sorted(source.glob("*.py")) or [source]:
            digest.update(file.name.encode() + file.read_bytes())
    return digest.hexdigest()[:16]


def _cache_place(name: str, digest: str) -> Path | None:
    """Return a writable directory named after the sources, or None with a warning.

    Code compiled from old versions of the sources is removed, and so are incomplete
    files.
    """
    cache = os.environ.get("XDG_CACHE_HOME") or "~/.cache"
    base = Path(untyped.config.CACHE_DIR or Path(cache, "precursors"))
    try:
        place = base.expanduser() / f"{name}-{digest}"
        place.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=place):  # updates its time of last use
            places = sorted(
                place.parent.glob(f"{name}-*"),
                key=lambda one: one.stat().st_mtime,
            )
        for old in places[:-CACHED_VERSIONS]:
            shutil.rmtree(old, ignore_errors=True)
        for file in place.glob("*.nb[ci]"):
            if not file.read_bytes().endswith(pickle.STOP):
                file.unlink(missing_ok=True)
        if shutil.disk_usage(place).free > LEAST_ROOM:
            return place
    except (OSError, RuntimeError):  # no permission, or no home directory
        pass
    warnings.warn(
        f"compiled code cannot be kept in {base}, so every process compiles "
        "for some 10 s: set NUMBA_CACHE_DIR to a directory that can be written",
        stacklevel=3,
    )
    return None
