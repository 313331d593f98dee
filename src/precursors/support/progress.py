"""How far a long computation has come: a bar on the terminal, or a line now and then in a file."""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Iterable
from itertools import accumulate
from types import TracebackType
from typing import TextIO

# What comes and goes within so many seconds only unsettles.
DELAY = 2.0
SECONDS_BETWEEN = {True: 0.1, False: 30.0}  # on a terminal, in a file
WIDTH = 30


class Progress:
    """Context manager that shows the share of the work that is done, or the time taken; call it to tell it.

    It draws from a thread of its own, so that one long call shows progress too. On a terminal one line is
    written over and over, and is gone at the end.

    Parameters
    ----------
    label : str
        What is being done.
    work : iterable of float, optional
        Work that each member is expected to be, in any unit; without it the time taken is shown.
    stream : text stream, optional
        Where to draw, standard error by default.
    delay : float
        Time before anything is drawn [s].
    in_file : bool
        Whether to write where the stream is no terminal; otherwise a file or a pipe is left clean.
    """

    def __init__(
        self,
        label: str,
        work: Iterable[float] = (),
        stream: TextIO | None = None,
        delay: float = DELAY,
        in_file: bool = False,
    ) -> None:
        self.label = label
        self._done_work = [0.0, *accumulate(work)]
        self._done = 0
        self._first: tuple[float, int] | None = None
        self._stream = sys.stderr if stream is None else stream
        self._live = self._stream.isatty()
        self._delay = delay
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._draw_until_over, daemon=True)
        self._draws = self._live or in_file

    def __enter__(self) -> Progress:
        self._start = time.monotonic()
        if self._draws:
            self._thread.start()
        return self

    def __call__(self, n_done: int) -> None:
        """Note how many members are done."""
        self._done = n_done
        if self._first is None:  # before it, much of the time was spent on loading compiled code
            self._first = time.monotonic(), n_done

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._over.set()
        if self._thread.ident is not None:
            self._thread.join()

    def line(self, now: float) -> str:
        """What to show at a time of `time.monotonic` [s]."""
        n_members = len(self._done_work) - 1
        if not n_members:
            return f"{self.label} {now - self._start:.0f} s"
        share = self._done_work[self._done] / self._done_work[-1]
        bar = "#" * round(WIDTH * share)
        line = f"{self.label} [{bar:.<{WIDTH}}] {share:4.0%}, {self._done} of {n_members} runs"
        if self._first is not None and self._first[1] < self._done < n_members:
            since, n_done = self._first
            before = self._done_work[n_done] / self._done_work[-1]
            line += f", {(now - since) * (1.0 - share) / (share - before):.0f} s left"
        return line

    def _draw_until_over(self) -> None:
        if self._over.wait(self._delay):
            return
        while not self._over.is_set():
            self._write(self.line(time.monotonic()))
            self._over.wait(SECONDS_BETWEEN[self._live])
        self._write("" if self._live else self.line(time.monotonic()))

    def _write(self, line: str) -> None:
        # Back to the start of the line, and erase what is right of the text.
        self._stream.write(f"\r{line}\x1b[K" if self._live else f"{line}\n")
        self._stream.flush()
