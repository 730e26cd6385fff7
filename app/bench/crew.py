"""A crew: processes that share a benchmark's work on this machine, each with a GL context of its own."""

import os
import signal
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor, wait
from multiprocessing import active_children, get_context
from typing import Any, TypeVar

from ..studio.progress import counted

Item = TypeVar("Item")
Result = TypeVar("Result")

OFTEN = 0.2
"""How often it is looked how far they are [s]."""

_done: list[Any] = []
"""In a process of a crew, what counts the steps of all of them."""


def cores() -> int:
    """Return how many cores this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def by_many(
    work: Callable[..., Result], jobs: Sequence[tuple[Any, ...]], /, *, workers: int, steps: int, doing: str
) -> list[Result]:
    """Return what `work` makes of the arguments of each job, in the order of the jobs.

    `steps` is how many items all jobs together pass through `ticked`. Raises what `work` raises.
    """
    spawn = get_context("spawn")
    counter = spawn.Value("l", 0)
    begin = (counter, str(max(1, cores() // workers)))
    with ProcessPoolExecutor(workers, mp_context=spawn, initializer=_begin, initargs=begin) as pool:
        futures = [pool.submit(work, *job) for job in jobs]
        try:
            for _ in counted(_steps(futures, counter), total=steps, doing=doing):
                pass
            return [future.result() for future in futures]
        except BaseException:
            for child in active_children():
                child.terminate()
            raise


def ticked(items: Iterable[Item], /) -> Iterator[Item]:
    """Yield the items, and have each of them counted as a step of the crew."""
    for item in items:
        yield item
        for counter in _done:
            with counter.get_lock():
                counter.value += 1


def _begin(counter: Any, threads: str) -> None:
    """Get a process ready: a key that stops the command ends it without a word, and Mesa has its share of cores."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    os.environ.setdefault("LP_NUM_THREADS", threads)
    _done.append(counter)


def _steps(futures: Sequence[Future[Any]], counter: Any) -> Iterator[int]:
    """Yield each step, as it is done, until all is."""
    seen, left = 0, set(futures)
    while left:
        done, left = wait(left, timeout=OFTEN)
        for future in done:
            future.result()
        while seen < counter.value:
            seen += 1
            yield seen
