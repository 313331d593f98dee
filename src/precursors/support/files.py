"""Files that are either complete or absent: written to a temporary name, then renamed; and their seals."""

from __future__ import annotations

import errno
import hashlib
import json
import os
import re
import secrets
from collections.abc import Iterator
from contextlib import closing, contextmanager, suppress
from io import BytesIO
from pathlib import Path
from typing import IO, Any

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None  # type: ignore[assignment]

SEAL_SIZE = 512
NO_ROOM = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
# Directory beside a table for the checksums of what lies there, as `sha256sum` writes them.
CHECKSUMS = ".sha256"


@contextmanager
def write_atomically(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Yield a temporary name beside `path`, and rename it to `path` when the block ends without an error.

    An error in the block removes the temporary file and leaves an existing `path` as it was. Every call
    has a temporary name of its own, so several processes may write the same `path`: the last one stays.
    The name ends like `path`, for writers that choose a format by the suffix. Parent directories are made.
    What a killed process left beside `path` is removed; what another one still writes is locked, and stays.

    Raises
    ------
    OSError
        In one line that names `path`, if its directory cannot be made or written, `path` is a directory, or
        there is no room.
    """
    target = Path(path)
    temporary = target.with_name(f".{secrets.token_hex(8)}.{target.name}")
    try:
        if target.is_dir():
            raise IsADirectoryError(0, "it is a directory")
        target.parent.mkdir(parents=True, exist_ok=True)
        _remove_leftovers(target)
        being_written = _create(temporary)
    except OSError as error:
        raise _cannot_write(target, error) from error
    with closing(being_written):
        try:
            yield temporary
            try:
                os.replace(temporary, target)
            except OSError as error:
                raise _cannot_write(target, error) from error
        except OSError as error:
            if error.errno in NO_ROOM:
                raise _cannot_write(target, error) from error
            raise
        finally:
            temporary.unlink(missing_ok=True)


@contextmanager
def write_sealed(path: str | os.PathLike[str], form: str) -> Iterator[BytesIO]:
    """Yield memory for a file that leaves its first 512 bytes free; write it sealed, or not at all.

    A library that writes to a disk which is full may take the interpreter with it; HDF5's does.

    Raises
    ------
    OSError
        In one line that names `path`, if it cannot be written.
    """
    memory = BytesIO()
    yield memory
    content = memory.getvalue()
    head = f"{form}\n{_digest(content)}".encode().ljust(SEAL_SIZE, b"\0")
    with write_atomically(path) as temporary:
        temporary.write_bytes(head + content[SEAL_SIZE:])


def read_sealed(path: str | os.PathLike[str], form: str) -> bytes:
    """Content of a file that `write_sealed` wrote; no damaged file gets past it to the library that reads it.

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
        raise ValueError(f'{path}: not a {form.split()[1]} file: allowed is a file that begins with "{form}"')
    if found[1:] != [_digest(content)]:
        raise ValueError(f"{path}: damaged: its contents do not match the checksum it begins with")
    return content


@contextmanager
def write_checked(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Write a file as `write_atomically` does, and its checksum beside it: other programs read it as well.

    Raises
    ------
    OSError
        As in `write_atomically`.
    """
    with write_atomically(path) as temporary:
        yield temporary
        # The checksum first: where only it gets written, the old file is refused, not taken for the new.
        with write_atomically(_checksum_file(Path(path))) as beside:
            digest = hashlib.sha256(temporary.read_bytes()).hexdigest()
            beside.write_text(f"{digest}  {Path(path).name}\n", encoding="utf-8")


def open_checked(path: str | os.PathLike[str]) -> BytesIO:
    """Content of a file that `write_checked` wrote, or of any other file that no checksum lies beside.

    Raises
    ------
    OSError
        If the file cannot be read.
    ValueError
        If the content is not what was written.
    """
    content = Path(path).read_bytes()
    beside = _checksum_file(Path(path))
    if beside.is_file():
        expected = beside.read_bytes().split(b"  ")[0]
        if expected != hashlib.sha256(content).hexdigest().encode():
            raise ValueError(
                f"{path} is not what was written there (its SHA-256 is in {beside}): "
                "remove it, and the workflow makes it anew"
            )
    return BytesIO(content)


def read_json(path: str | os.PathLike[str]) -> Any:
    """Content of a JSON file that `write_checked` wrote, or of any other that no checksum lies beside.

    Raises
    ------
    OSError
        If the file cannot be read.
    ValueError
        If the content is not what was written, or no JSON.
    """
    content = open_checked(path).read()
    try:
        return json.loads(content)
    except (ValueError, RecursionError) as error:
        raise ValueError(f"{path} is no JSON: {error}") from None


def _create(temporary: Path) -> IO[str]:
    """Create a file that is locked, as being written, until it is closed; Windows has no such locks."""
    while True:
        # "x" gives the file the permissions that the user's umask asks for; tempfile would make it private.
        file = temporary.open("x")
        if fcntl is None:
            file.close()
            return file
        with suppress(OSError):  # not every file system has locks
            fcntl.flock(file, fcntl.LOCK_EX)
        if temporary.exists():
            return file
        # Another writer took it for a leftover in the instant before it was locked.
        file.close()


def _remove_leftovers(target: Path) -> None:
    """Remove the temporary files of a target that nobody is writing."""
    leftover = re.compile(rf"\.[0-9a-f]{{16}}\.{re.escape(target.name)}")
    for path in target.parent.iterdir():
        if fcntl is not None and leftover.fullmatch(path.name):
            with suppress(OSError), path.open("r+b") as file:
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
                path.unlink(missing_ok=True)


def _checksum_file(path: Path) -> Path:
    return path.parent / CHECKSUMS / f"{path.name}.sha256"


def _digest(content: bytes) -> str:
    """SHA-256 of a file without its seal."""
    return hashlib.sha256(content[SEAL_SIZE:]).hexdigest()


def _cannot_write(path: Path, error: OSError) -> OSError:
    return OSError(f"cannot write {path}: {error.strerror}")
