"""Hands: the workers of a Dask scheduler, on this machine or on others, and the work given to them."""

from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import CancelledError
from contextlib import contextmanager, suppress
from typing import Any, TypeVar

from ..studio.errors import MachineError
from .dask import need_distributed

Result = TypeVar("Result")

LISTEN = 2.0
"""Interval at which the workers are counted while a result is awaited [s]."""

PATIENCE = 60.0
"""Longest wait for a new worker when all are gone [s]."""

AHEAD = 2
"""Number of pieces of work submitted per worker: one in progress, one waiting."""


class LostError(MachineError):
    """The scheduler or all workers are gone."""


class Hands:
    """Workers that do pieces of work in any order; results come back in the order of submission."""

    def __init__(self, client: Any, place: str) -> None:
        self._client, self._place = client, place

    @property
    def count(self) -> int:
        """Number of pieces that all workers do at a time."""
        with self._connected():
            return sum(self._client.nthreads().values())

    def keep(self, thing: object, /) -> object:
        """Return a future that stands for an object in arguments; it is sent once, and again where it was lost."""
        with self._connected():
            return self._client.submit(_identity, thing, pure=False)

    def in_order(self, work: Callable[..., Result], pieces: Iterable[tuple[object, ...]], /) -> Iterator[Result]:
        """Call `work` with the arguments of each piece; yield the results in the order of the pieces.

        Another worker does the pieces of a lost one. Raises what `work` raises, MachineError where workers cannot
        import it, LostError where the scheduler is gone, or all workers for long.
        """
        waiting: deque[Any] = deque()
        for piece in pieces:
            if len(waiting) >= AHEAD * max(1, self.count):
                yield self._result(waiting.popleft())
            with self._connected():
                waiting.append(self._client.submit(work, *piece, pure=False))
        while waiting:
            yield self._result(waiting.popleft())

    def everywhere(self, work: Callable[[], object], /) -> None:
        """Run `work` in every worker that still exists."""
        with suppress(LostError), self._connected():
            self._client.run(work, on_error="ignore")

    def _result(self, future: Any) -> Any:
        with self._connected():
            self._wait(future)
            failure = future.exception()
            if failure is None:
                return future.result()
        raise self._translated(failure)

    def _wait(self, future: Any) -> None:
        distributed, alone = need_distributed(), 0.0
        while not future.done():
            try:
                distributed.wait([future], timeout=LISTEN)
            except TimeoutError:
                alone = 0.0 if self.count else alone + LISTEN
            if alone >= PATIENCE:
                raise LostError(f"{self._place}: all workers are gone")

    @contextmanager
    def _connected(self) -> Iterator[None]:
        try:
            yield
        except (CancelledError, OSError) as error:
            raise LostError(f"{self._place}: the scheduler is gone") from error

    def _translated(self, error: Exception) -> Exception:
        if isinstance(error, ImportError | AttributeError):
            return MachineError(f"{self._place}: a worker lacks what this takes: {error}")
        if isinstance(error, need_distributed().KilledWorker):
            return LostError(f"{self._place}: worker after worker died of the same work; their logs may tell why")
        return error


def _identity(thing: object) -> object:
    return thing
