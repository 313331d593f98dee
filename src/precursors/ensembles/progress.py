"""How far a chunk has come, shown while it runs."""

from __future__ import annotations

import sys
from collections.abc import Callable
from time import perf_counter
from typing import TextIO

import numpy as np

from precursors.chain import FloatArray

WIDTH = 30
# A bar that comes and goes within so many seconds only unsettles.
FIRST_SHOWN_AFTER = 3.0
SECONDS_BETWEEN = {True: 0.5, False: 30.0}  # on a terminal, in a file


def progress_bar(label: str, work: FloatArray, stream: TextIO | None = None) -> Callable[[int], None]:
    """Return a function that is told how many members are done and shows the share of the work.

    Parameters
    ----------
    label : str
        What runs.
    work : array, shape (n_members,)
        Work that each member is expected to be, in any unit.
    stream : text file, optional
        Where to write; standard error by default. On a terminal one line is written over and over, in a file
        a line now and then.
    """
    out = stream or sys.stderr
    live = out.isatty()
    done_work = np.cumsum(work) / np.sum(work)
    due = perf_counter() + FIRST_SHOWN_AFTER
    shown = False
    begun: tuple[float, float] | None = None

    def show(n_done: int) -> None:
        nonlocal due, shown, begun
        now, finished, share = perf_counter(), n_done == len(work), float(done_work[n_done - 1])
        if begun is None:  # before the first call, much of the time was spent on loading compiled code
            begun = now, share
        if now < due and not (finished and shown):
            return
        due, shown = now + SECONDS_BETWEEN[live], True
        line = f"{label} [{'#' * round(WIDTH * share):<{WIDTH}}] {share:4.0%}, {n_done} of {len(work)} runs"
        if begun[1] < share < 1.0:
            left = (now - begun[0]) * (1.0 - share) / (share - begun[1])
            line += f", {left:.0f} s left"
        out.write(f"\r{line:<100}" if live else line)
        out.write("" if live and not finished else "\n")
        out.flush()

    return show
