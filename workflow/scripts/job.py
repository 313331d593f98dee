"""Shared by the scripts of the workflow: one line on an error, the threads they were
given, their inputs."""

import os
import signal
import sys
import traceback
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from pkgutil import resolve_name
from time import perf_counter
from typing import Any

# Numba reads its variable when it is imported; Snakemake sets the other from the
# `threads` of the rule.
os.environ.setdefault("NUMBA_NUM_THREADS", os.environ.get("OMP_NUM_THREADS", "1"))

LONG = 5  # [s]: a job that takes longer says so


@contextmanager
def job() -> Iterator[Any]:
    """Yield the object `snakemake` of a script, and write the log of its job.

    A wrong value or file is one line in the log and on the terminal; other errors add a
    traceback to the log.
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


def read(files: Any, readers: Mapping[str, str]) -> Any:
    """Content of a file, or of each in a list or mapping, from the reader of its
    ending, "package.module:name". A file that is damaged can be deleted."""
    if isinstance(files, Mapping):
        return {name: read(file, readers) for name, file in files.items()}
    if isinstance(files, str):
        try:
            return resolve_name(readers[Path(files).suffix])(files)
        except ValueError as error:
            raise ValueError(f"{error}: delete it, and it is made again") from error
    return [read(file, readers) for file in files]
