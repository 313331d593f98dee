"""Progress of long work, told at a terminal."""

from collections.abc import Callable, Iterable, Sequence
from multiprocessing.pool import ThreadPool
from threading import current_thread, main_thread
from typing import Any, TypeVar

from tqdm import tqdm

Result = TypeVar("Result")
SECOND = 1.0
FORMAT = "{desc}: {percentage:.0f}%, {remaining} left"


def bar(work: str, total: float, steps: Iterable[Any] | None = None) -> Any:
    """A `tqdm` of the steps that says on stderr, if it is a terminal, how much is done;
    silent outside the main thread."""
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
    """Run tasks that release the GIL in threads, no more than there are tasks, and say
    how many are done.

    After Ctrl-C or an error no task is started, and running ones are not waited for.
    """
    # Its threads are daemons, for which nobody waits at the end, unlike those of
    # concurrent.futures.
    with ThreadPool(max(1, min(threads, len(tasks)))) as pool:
        return list(bar("running", len(tasks), pool.imap(lambda task: task(), tasks)))
