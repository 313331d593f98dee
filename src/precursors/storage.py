"""Files that are either complete or absent: written to a temporary name, then renamed; and their seals."""

from __future__ import annotations

import hashlib
import os
import secrets
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

SEAL_SIZE = 512


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


def seal(path: str | os.PathLike[str], form: str) -> None:
    """Write the name of the format and a checksum into the first 512 bytes of a file, which it left free."""
    file = Path(path)
    digest = _digest(file.read_bytes())
    with file.open("r+b") as opened:
        opened.write(f"{form}\n{digest}".encode())


def read_sealed(path: str | os.PathLike[str], form: str) -> bytes:
    """Content of a file that `seal` sealed; no damaged file gets past it to the library that reads it.

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    ValueError
        If the file is not of this format, or its content is not what was sealed.
    """
    try:
        content = Path(path).read_bytes()
    except FileNotFoundError:
        raise FileNotFoundError(f"{path}: no such file") from None
    found = content[:SEAL_SIZE].rstrip(b"\0").decode("ascii", "replace").split("\n")
    if found[0] != form:
        raise ValueError(f'{path}: not such a file: allowed is one that begins with "{form}"')
    if found[1:] != [_digest(content)]:
        raise ValueError(f"{path}: damaged: its contents do not match the checksum it begins with")
    return content


def _digest(content: bytes) -> str:
    """SHA-256 of a file without its seal."""
    return hashlib.sha256(content[SEAL_SIZE:]).hexdigest()


def _cannot_write(path: Path, error: OSError) -> OSError:
    return OSError(f"cannot write {path}: {error.strerror}")
