"""What every script of the workflow needs: its job, one line on an error, and the threads it was given."""

from __future__ import annotations

import os
import signal
import sys
import traceback
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from time import perf_counter
from typing import Any

# Snakemake sets OMP_NUM_THREADS from the rule's `threads`; Numba reads its own variable when it is imported.
os.environ.setdefault("NUMBA_NUM_THREADS", os.environ.get("OMP_NUM_THREADS", "1"))


@contextmanager
def job() -> Iterator[Any]:
    """Yield the object `snakemake` that Snakemake gives a script, and keep the log of the job.

    An error becomes one line in the log and on the terminal; one that is neither a bad value nor a file that
    cannot be used has its traceback in the log besides.
    """
    snakemake = vars(sys.modules["__main__"])["snakemake"]
    # Python's own handler waits until compiled code returns, and prints a traceback.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    log = Path(snakemake.log[0])
    name = ", ".join([snakemake.rule, *snakemake.wildcards])
    start = perf_counter()
    try:
        yield snakemake
    except Exception as error:
        line = f"{name}: {' '.join(str(error).split()) or type(error).__name__}"
        expected = isinstance(error, ValueError | OSError)
        log.write_text(f"{line}\n" if expected else f"{line}\n\n{traceback.format_exc()}", encoding="utf-8")
        print(line, file=sys.stderr)
        sys.exit(1)
    log.write_text(
        f"{name}: {perf_counter() - start:.3f} s, wrote {', '.join(snakemake.output)}\n", encoding="utf-8"
    )
