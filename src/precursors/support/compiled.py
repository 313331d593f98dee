"""Machine code that is kept until its sources change."""

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

KEPT = 20  # states of the sources whose machine code is kept


class UserCache(UserWideCacheLocator):
    """Tells Numba to keep machine code in `place`, which all clones with these sources
    share.

    Numba's own locators put the directory of the sources into the path.
    """

    place = Path()

    def __init__(self, function: Function, file: str) -> None:
        super().__init__(function, file)
        self._place = self.place

    def get_cache_path(self) -> str:
        """Name of the directory."""
        return os.fspath(self._place)

    def get_source_stamp(self) -> str:
        """Stamp that changes with the sources."""
        return self._place.name


def entry(*sources: Path, **options: Any) -> Any:
    """Decorator for functions that Python calls; their code is kept until one of the
    sources is edited: modules, or directories of modules.

    Numba looks at the file of a function only, and not at those of the functions that
    it calls. So the code is kept in a directory that is named after the first source
    and the checksum of all.
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
    """Says on stderr, once, that code is compiled: for
    `event.install_listener("numba:compile", ...)`."""

    is_made = False

    def on_start(self, _: event.Event) -> None:
        """Say it."""
        if not self.is_made:
            self.is_made = True
            print(
                "compiling the solver for this machine, once: some 10 s",
                file=sys.stderr,
                flush=True,
            )

    def on_end(self, _: event.Event) -> None:
        """Say nothing."""


def checksum(*sources: Path) -> str:
    """Checksum of modules, of all in a directory, and of Numba's version."""
    digest = hashlib.sha256(numba.__version__.encode())
    for source in sources:
        for file in sorted(source.glob("*.py")) or [source]:
            digest.update(file.name.encode() + file.read_bytes())
    return digest.hexdigest()[:16]


def _cache_place(name: str, digest: str) -> Path | None:
    """A directory that can be written, named after sources and their checksum; None,
    with a warning.

    What was compiled from sources of long ago is removed, and what was not written to
    its end.
    """
    cache = os.environ.get("XDG_CACHE_HOME") or "~/.cache"
    base = Path(untyped.config.CACHE_DIR or Path(cache, "precursors"))
    try:
        place = base.expanduser() / f"{name}-{digest}"
        place.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=place):  # marks when it was used last
            places = sorted(
                place.parent.glob(f"{name}-*"),
                key=lambda one: one.stat().st_mtime,
            )
        for old in places[:-KEPT]:
            shutil.rmtree(old, ignore_errors=True)
        for file in place.glob("*.nb[ci]"):
            if not file.read_bytes().endswith(pickle.STOP):
                file.unlink(missing_ok=True)
        if shutil.disk_usage(place).free > LEAST_ROOM:
            return place
    except (OSError, RuntimeError):  # it cannot be written, or there is no home
        pass
    warnings.warn(
        f"compiled code cannot be kept in {base}, so every process compiles "
        "for some 10 s: set NUMBA_CACHE_DIR to a directory that can be written",
        stacklevel=3,
    )
    return None
