"""What is told to those who wait for long work at a terminal."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, wait
from threading import Thread, current_thread, main_thread
from typing import TypeVar

Step = TypeVar("Step")
Result = TypeVar("Result")
SECOND = 1.0


def tell(work: str, steps: Iterable[Step], done: Callable[[], float]) -> Iterator[Step]:
    """Pass steps on; on stderr, if it is a terminal, say each second how much is done
    and what is left [s].

    `done` is the part of the work that is done, between 0 and 1.
    """
    start = last = time.monotonic()
    is_told = current_thread() is main_thread() and sys.stderr.isatty()
    try:
        for step in steps:
            yield step
            if is_told and (now := time.monotonic()) - last > SECOND:
                part = done()
                last = now
                left = f"{(now - start) * (1 / part - 1):.0f} s left" if part else ""
                print(f"\r{work}: {part:.0%} {left}\x1b[K", end="", file=sys.stderr)
    finally:
        if last > start:
            print("\r\x1b[K", end="", file=sys.stderr)


def in_thread(
    work: str, function: Callable[[], Result], done: Callable[[], float]
) -> Result:
    """Result of a compiled function that holds no lock of Python; how much is done is
    told as by `tell`.

    Ctrl-C does not wait for the function.
    """
    found = Future[Result]()

    def run() -> None:
        try:
            found.set_result(function())
        except BaseException as error:
            found.set_exception(error)

    Thread(target=run, daemon=True).start()
    for _ in tell(
        work, iter(lambda: bool(wait([found], SECOND).not_done), False), done
    ):
        pass
    return found.result()
