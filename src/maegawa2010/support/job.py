"""Error messages, logs, and reading and writing of files, for all scripts."""

from __future__ import annotations

import signal
import sys
import traceback
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    import pandas as pd

Content = TypeVar("Content")

LONG = 5  # s; a longer job announces its duration


@contextmanager
def job() -> Iterator[Any]:
    """Yield the script's `snakemake` object, and write the log of its job.

    A wrong value or file gives one line in the log and on the terminal; any other error
    also gives a traceback in the log.
    """
    snakemake = vars(sys.modules["__main__"])["snakemake"]
    signal.signal(
        signal.SIGINT, signal.SIG_DFL
    )  # Python's own handler waits until compiled code returns
    log = Path(snakemake.log[0])
    name = ", ".join([snakemake.rule, *snakemake.wildcards])
    start = perf_counter()
    seconds = snakemake.resources.get("seconds", 0)
    if seconds >= LONG:
        print(f"{name}: some {seconds} s", file=sys.stderr)
    try:
        yield snakemake
    except Exception as error:
        line = f"{name}: {' '.join(str(error).split()) or type(error).__name__}\n"
        expected = isinstance(error, ValueError | OSError)
        log.write_text(
            line if expected else f"{line}\n{traceback.format_exc()}", encoding="utf-8"
        )
        sys.exit(line.rstrip())
    log.write_text(f"{name}: {perf_counter() - start:.3f} s\n", encoding="utf-8")


def read(load: Callable[[str], Content], path: str) -> Content:
    """Read a result file; the error for a damaged one says how to replace it."""
    try:
        return load(path)
    except ValueError as error:
        raise ValueError(f"{error}: delete it to have it made again") from error


def read_all(
    load: Callable[[str], Content], paths: Iterable[str]
) -> dict[str, Content]:
    """Read files into a table by file name without its suffix (for runs: by scene)."""
    return {Path(path).name.split(".")[0]: read(load, path) for path in paths}


def write_tables(tables: Mapping[str, pd.DataFrame], output: Any) -> None:
    """Write each table to the output file of the same name."""
    from precursors.support.files import write_table

    for name, path in output.items():
        write_table(tables[name], path)
