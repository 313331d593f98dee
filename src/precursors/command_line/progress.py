"""A progress bar on the terminal for what takes more than two seconds, and nothing for what does not."""

from __future__ import annotations

import sys
import threading
import time
from types import TracebackType
from typing import TextIO

DELAY = 2.0  # s
PERIOD = 0.1  # s
WIDTH = 30


class Progress:
    """Context manager that draws on a terminal what is done of a total, or the time taken.

    It draws from a thread of its own, so that one long call shows progress too. What is not a terminal (a
    file, a pipe) is left clean.

    Parameters
    ----------
    label : str
        What is being done.
    total : int, optional
        How much there is to do; without it the time taken is shown.
    stream : text stream, optional
        Where to draw, standard error by default.
    delay : float
        Time before anything is drawn [s].
    """

    def __init__(
        self, label: str, total: int | None = None, stream: TextIO | None = None, delay: float = DELAY
    ) -> None:
        self.label, self.total, self.done = label, total, 0
        self._stream = sys.stderr if stream is None else stream
        self._delay = delay
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._draw_until_over, daemon=True)

    def __enter__(self) -> Progress:
        self._start = time.monotonic()
        if self._stream.isatty():
            self._thread.start()
        return self

    def __call__(self, done: int) -> None:
        """Note how much is done."""
        self.done = done

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._over.set()
        if self._thread.ident is not None:
            self._thread.join()

    def line(self, elapsed: float) -> str:
        """What to show after some seconds."""
        if not self.total:
            return f"{self.label} {elapsed:.0f} s"
        share = min(self.done / self.total, 1.0)
        bar = "#" * round(share * WIDTH)
        left = f", {elapsed * (1 / share - 1):.0f} s left" if share else ""
        return f"{self.label} [{bar:.<{WIDTH}}] {self.done}/{self.total}{left}"

    def _draw_until_over(self) -> None:
        if self._over.wait(self._delay):
            return
        while True:
            # Back to the start of the line, and erase what is right of the text.
            self._stream.write(f"\r{self.line(time.monotonic() - self._start)}\x1b[K")
            self._stream.flush()
            if self._over.wait(PERIOD):
                break
        self._stream.write("\r\x1b[K")
        self._stream.flush()
