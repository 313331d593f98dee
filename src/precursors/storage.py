"""Files that are either complete or absent: written to a temporary name, then renamed."""

from __future__ import annotations

import os
import secrets
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


@contextmanager
def write_atomically(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Yield a temporary name beside `path`, and rename it to `path` when the block ends without an error.

    An error in the block removes the temporary file and leaves an existing `path` as it was. Every call
    has a temporary name of its own, so several processes may write the same `path`: the last one stays.
    The name ends like `path`, for writers that choose a format by the suffix. Parent directories are made.

    Raises
    ------
    OSError
        In one line that names `path`, if its directory cannot be made or written, or `path` is a directory.
    """
    target = Path(path)
    temporary = target.with_name(f".{secrets.token_hex(8)}.{target.name}")
    try:
        if target.is_dir():
            raise IsADirectoryError(0, "it is a directory")
        target.parent.mkdir(parents=True, exist_ok=True)
        # "x" gives the file the permissions that the user's umask asks for; tempfile would make it private.
        temporary.open("x").close()
    except OSError as error:
        raise _cannot_write(target, error) from error
    try:
        yield temporary
        try:
            os.replace(temporary, target)
        except OSError as error:
            raise _cannot_write(target, error) from error
    finally:
        temporary.unlink(missing_ok=True)


def _cannot_write(path: Path, error: OSError) -> OSError:
    return OSError(f"cannot write {path}: {error.strerror}")
