"""Progress of long work, told at a terminal."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from multiprocessing import TimeoutError
from multiprocessing.pool import IMapIterator, ThreadPool
from threading import current_thread, main_thread
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


def in_threads(
    work: str,
    tasks: Sequence[Callable[[], Result]],
    threads: int = 1,
    done: Callable[[], float] | None = None,
) -> list[Result]:
    """Run tasks that release the GIL in threads, and report progress with `tell`: `done`,
    by default the share of finished tasks.

    After Ctrl-C or an error no task is started, and running ones are not waited for.
    """
    found: list[Result] = []

    def seconds(finished: IMapIterator[Result]) -> Iterator[None]:
        while len(found) < len(tasks):
            with suppress(TimeoutError):
                found.append(finished.next(SECOND))
            yield

    # Its threads are daemons, for which nobody waits at the end, unlike those of
    # concurrent.futures.
    with ThreadPool(threads) as pool:
        waits = seconds(pool.imap(lambda task: task(), tasks))
        for _ in tell(work, waits, done or (lambda: len(found) / len(tasks))):
            pass
    return found
