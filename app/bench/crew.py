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

POLLING = 0.2
"""Interval at which the progress is read [s]."""

_counters: list[Any] = []
"""In a process of a crew: the shared counter of all processes' steps."""


def cores() -> int:
    """Return the number of cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def by_many(
    work: Callable[..., Result], jobs: Sequence[tuple[Any, ...]], /, *, workers: int, steps: int, doing: str
) -> list[Result]:
    """Call `work` with the arguments of each job in a pool of processes; return the results in the order of the jobs.

    `steps` is the total number of items that the jobs pass through `ticked`. Raises what `work` raises.
    """
    spawn = get_context("spawn")
    counter = spawn.Value("l", 0)
    setup = (counter, str(max(1, cores() // workers)))
    with ProcessPoolExecutor(workers, mp_context=spawn, initializer=_set_up, initargs=setup) as pool:
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
    """Yield the items, and count each as a step of the crew."""
    for item in items:
        yield item
        for counter in _counters:
            with counter.get_lock():
                counter.value += 1


def _set_up(counter: Any, threads: str) -> None:
    """Set up a process: Ctrl C ends it silently, and Mesa uses its share of the cores."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    os.environ.setdefault("LP_NUM_THREADS", threads)
    _counters.append(counter)


def _steps(futures: Sequence[Future[Any]], counter: Any) -> Iterator[int]:
    """Yield the number of each step as it is done, until all jobs are done."""
    seen, left = 0, set(futures)
    while left:
        done, left = wait(left, timeout=POLLING)
        for future in done:
            future.result()
        while seen < counter.value:
            seen += 1
            yield seen
