"""Write files completely or not at all, and read and write tables."""

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
LONGEST_NAME = 240  # bytes; file systems allow 255
LEAST_ROOM = 10_000_000  # free bytes; a run of 10 s and its figure need less
MOST_READ = 100_000_000  # bytes of a text; an hour of F_X at 1 kHz has fewer


def read_bytes(path: AnyPath) -> bytes:
    """Read a regular file; devices and pipes, which may never end, are refused.

    Raises
    ------
    OSError
        If it cannot be read; the message is one line that names `path`.
    """
    status = os.stat(path)
    if not stat.S_ISREG(status.st_mode):
        raise OSError(f"cannot read {path}: it is not a regular file")
    if status.st_size > MOST_READ:
        raise OSError(f"cannot read {path}: it has more than {MOST_READ:,} bytes")
    return Path(path).read_bytes()


def write_whole(path: AnyPath, content: bytes) -> None:
    """Write a file under a temporary name beside `path`, then rename it.

    The file is either complete or unchanged. Missing parent directories are made.

    Raises
    ------
    OSError
        If it cannot be written; the message is one line that names `path`.
    """
    target = Path(os.path.realpath(path))  # write to the target of a link
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
    """Refuse a file that cannot be written, before its content is computed.

    Raises
    ------
    ValueError
        If its name has none of the `endings`.
    OSError
        If it is a directory, or its directory cannot be made, is not writable or is
        full.
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
    """Write a text file, completely or not at all."""
    write_whole(path, text.encode())


def write_table(
    table: pd.DataFrame, path: AnyPath, decimal: Literal[".", ","] = "."
) -> None:
    """Write a table with all digits of its numbers.

    The format is TSV if the name ends in .tsv, and CSV otherwise. With decimal commas,
    CSV separates columns by semicolons.
    """
    is_tsv = Path(path).suffix.lower() == ".tsv"
    separator = "\t" if is_tsv else ";" if decimal == "," else ","
    text = table.to_csv(
        index=False, lineterminator="\n", sep=separator, decimal=decimal
    )
    write_text(path, text)


def read_table(path: AnyPath, **how: Any) -> pd.DataFrame:
    """Read a CSV table; `how` takes options of `pandas.read_csv`.

    Raises
    ------
    OSError
        If the file cannot be read.
    ValueError
        If it is not a table.
    """
    import pandas as pd  # imported lazily: a run needs no tables

    try:
        return pd.read_csv(path, **how)
    except ValueError as error:
        raise ValueError(f"{path}: {' '.join(str(error).split())}") from None
