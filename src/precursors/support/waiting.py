"""Run tasks in threads, and show progress at a terminal."""

from collections.abc import Callable, Iterable, Sequence
from multiprocessing.pool import ThreadPool
from threading import current_thread, main_thread
from typing import Any, TypeVar

from tqdm import tqdm

Result = TypeVar("Result")
SECOND = 1.0
FORMAT = "{desc}: {percentage:.0f}%, {remaining} left"


def bar(work: str, total: float, steps: Iterable[Any] | None = None) -> Any:
    """Return a `tqdm` bar of `steps`, shown if stderr is a terminal.

    Outside the main thread it shows nothing.
    """
    return tqdm(
        steps,
        desc=work,
        total=total,
        bar_format=FORMAT,
        leave=False,
        mininterval=SECOND,
        delay=SECOND,
        disable=None if current_thread() is main_thread() else True,
    )


def in_threads(tasks: Sequence[Callable[[], Result]], threads: int = 1) -> list[Result]:
    """Run tasks that release the GIL in threads, and show how many are done.

    After Ctrl-C or an error no further task is started, and running tasks are
    abandoned.
    """
    # ThreadPool has daemon threads, which do not delay the exit of the interpreter;
    # those of concurrent.futures do.
    with ThreadPool(max(1, min(threads, len(tasks)))) as pool:
        return list(bar("running", len(tasks), pool.imap(lambda task: task(), tasks)))
