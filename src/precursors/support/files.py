"""Files that are either complete or absent, and the tables of results/tables."""

from __future__ import annotations

import errno
import os
import shutil
import stat
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal
from uuid import uuid4

if TYPE_CHECKING:
    import pandas as pd

AnyPath = str | os.PathLike[str]
LONGEST_NAME = 240  # bytes of 255; a temporary name is longer
LEAST_ROOM = 10_000_000  # bytes; a run of 10 s and its figure take less
MOST_READ = 100_000_000  # bytes of a text; an hour of F_X at 1 kHz takes less


def read_bytes(path: AnyPath) -> bytes:
    """Read a file that somebody wrote, but no device or pipe, which may have no end.

    Raises
    ------
    OSError
        In one line that names `path`.
    """
    status = os.stat(path)
    if not stat.S_ISREG(status.st_mode):
        raise OSError(f"cannot read {path}: it is not a regular file")
    if status.st_size > MOST_READ:
        raise OSError(f"cannot read {path}: it has more than {MOST_READ:,} bytes")
    return Path(path).read_bytes()


def write_whole(path: AnyPath, content: bytes) -> None:
    """Write a file under a temporary name of its own beside `path`, and rename it: it is
    complete or as it was before.

    Missing parent directories are made.

    Raises
    ------
    OSError
        In one line that names `path`, if it cannot be written.
    """
    target = Path(os.path.realpath(path))  # a link is followed, and stays a link
    temporary = target.with_name(f".partial.{uuid4().hex}")
    try:
        if target.exists() and not target.is_file():
            raise OSError(errno.EINVAL, "it exists and is not a file")
        target.parent.mkdir(parents=True, exist_ok=True)
        try:
            temporary.write_bytes(content)
            os.replace(temporary, target)
        finally:
            temporary.unlink(missing_ok=True)
    except OSError as error:
        raise OSError(f"cannot write {path}: {error.strerror}") from error


def check_writable(path: AnyPath, endings: Sequence[str] = ()) -> None:
    """Refuse a file that could not be written, before the work that it is to hold.

    Raises
    ------
    ValueError
        If its name has none of the endings.
    OSError
        If it is a directory, or its directory cannot be made or written to, or has no
        room.
    """
    target = Path(os.path.realpath(path))
    if endings and target.suffix.lower() not in endings:
        raise ValueError(f"{path} must end in {' or '.join(endings)}")
    if len(os.fsencode(target.name)) > LONGEST_NAME:
        raise OSError(
            f"cannot write {path}: its name has more than {LONGEST_NAME} bytes"
        )
    if target.exists() and not target.is_file():
        kind = "a directory" if target.is_dir() else "not a file"
        raise OSError(f"cannot write {path}: it is {kind}")
    parent = next(above for above in target.parents if above.exists())
    if not parent.is_dir() or not os.access(parent, os.W_OK | os.X_OK):
        raise OSError(
            f"cannot write {path}: {parent} is not a directory that can be written to"
        )
    if shutil.disk_usage(parent).free < LEAST_ROOM:
        raise OSError(f"cannot write {path}: no room in {parent}")


def write_text(path: AnyPath, text: str) -> None:
    """Write a text file, whole or not at all."""
    write_whole(path, text.encode())


def write_table(
    table: pd.DataFrame, path: AnyPath, decimal: Literal[".", ","] = "."
) -> None:
    """Write a table with every digit of its numbers: as TSV if the name ends so, else
    as CSV, which has semicolons beside decimal commas."""
    is_tsv = Path(path).suffix.lower() == ".tsv"
    separator = "\t" if is_tsv else ";" if decimal == "," else ","
    text = table.to_csv(
        index=False, lineterminator="\n", sep=separator, decimal=decimal
    )
    write_text(path, text)


def read_table(path: AnyPath, **how: Any) -> pd.DataFrame:
    """Read a CSV table; `how` as for `pandas.read_csv`.

    Raises
    ------
    OSError
        If the file cannot be read.
    ValueError
        If it is not a table.
    """
    import pandas as pd  # here, as a run needs no tables

    try:
        return pd.read_csv(path, **how)
    except ValueError as error:
        raise ValueError(f"{path}: {' '.join(str(error).split())}") from None
