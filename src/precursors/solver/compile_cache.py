"""A cache of compiled code that sees every edit of a package.

Numba stamps what it keeps on disk with the one file that a function stands in, and does not see an edit of
what that function calls in others. Names and stamps are set through what Numba keeps to itself: it was run
with Numba 0.61.2 and 0.68.1.
"""

from __future__ import annotations

import hashlib
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

from numba.core.caching import FunctionCache, IndexDataCacheFile


def stamp(directory: Path) -> str:
    """Checksum of all modules in a directory."""
    digest = hashlib.sha256()
    for file in sorted(directory.glob("*.py")):
        digest.update(f"{file.name} {file.stat().st_size} ".encode())
        digest.update(file.read_bytes())
    return digest.hexdigest()


class _Cache(FunctionCache):
    """Numba's cache, in its usual places, of functions that all files of a package are part of."""

    def __init__(self, function: Callable[..., Any], stamp: str) -> None:
        super().__init__(function)
        # In the names too: Numba writes the index first; where it gets no further (a full disk, a kill), the
        # new index would lead to code of the version before.
        name = f"{self._impl.filename_base}.{stamp[:12]}"
        self._cache_file = IndexDataCacheFile(self._cache_path, name, stamp)

    def load_overload(self, signature: Any, target: Any) -> Any:
        """What is kept for a signature, or None; what cannot be read is thrown away."""
        try:
            found = super().load_overload(signature, target)
        except Exception:
            self._flush()
            return None
        # Two processes may have written different signatures under one name at the same time.
        return found if found is None or tuple(found.signature.args) == tuple(signature) else None

    def save_overload(self, signature: Any, data: Any) -> None:
        """Keep what was compiled, if there is room."""
        try:
            super().save_overload(signature, data)
        except OSError as error:
            warnings.warn(f"compiled code is not kept: {error}", stacklevel=2)

    def _flush(self) -> None:
        try:
            self.flush()
        except OSError:
            self.disable()


def kept(function: Any, stamp: str) -> Any:
    """Keep a compiled function under the stamp of its package, or say that there is nowhere to keep it."""
    try:
        function._cache = _Cache(function.py_func, stamp)
    except RuntimeError:
        warnings.warn(
            "compiled code can be kept nowhere, and is made anew in each process: set NUMBA_CACHE_DIR to a "
            "directory that can be written",
            stacklevel=3,
        )
    return function
