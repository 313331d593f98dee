"""Progress of long work, told at a terminal."""

from __future__ import annotations

import sys
import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import FIRST_EXCEPTION, Future, wait
from contextlib import suppress
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
    found: list[Future[Result]] = [Future() for _ in tasks]
    left = deque(zip(tasks, found, strict=True))

    def run() -> None:
        with suppress(IndexError):  # nothing is left
            while True:
                task, future = left.popleft()
                try:
                    future.set_result(task())
                except BaseException as error:
                    future.set_exception(error)

    def seconds() -> Iterator[None]:
        while True:
            finished, pending = wait(found, SECOND, FIRST_EXCEPTION)
            for future in finished:
                future.result()  # raises its error
            if not pending:
                return
            yield

    def part() -> float:
        return sum(future.done() for future in found) / len(found)

    for _ in range(min(threads, len(tasks))):
        Thread(target=run, daemon=True).start()
    try:
        for _ in tell(work, seconds(), done or part):
            pass
    finally:
        left.clear()
    return [future.result() for future in found]
