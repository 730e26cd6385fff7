"""Hands: the workers of a Dask scheduler, on this machine or on others, and what is asked of them."""

from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import CancelledError
from contextlib import contextmanager, suppress
from typing import Any, TypeVar

from ..studio.errors import MachineError
from .dask import need_distributed

Result = TypeVar("Result")

LISTEN = 2.0
"""How often it is looked whether there are workers, while none has anything to hand over [s]."""

PATIENCE = 60.0
"""How long one waits where all workers are gone, for another to come [s]."""

AHEAD = 2
"""Pieces of work that each worker has at hand: one to do, one to go on with."""


class LostError(MachineError):
    """Those who did the work are gone."""


class Hands:
    """Workers that do what they are asked, in any order; what they make comes back in the order of asking."""

    def __init__(self, client: Any, place: str) -> None:
        self._client, self._place = client, place

    @property
    def count(self) -> int:
        """How many things they do at a time."""
        with self._reached():
            return sum(self._client.nthreads().values())

    def keep(self, thing: object, /) -> object:
        """Return what stands for a thing among the arguments of work; it is sent once, and again where it was lost."""
        with self._reached():
            return self._client.submit(_itself, thing, pure=False)

    def in_order(self, work: Callable[..., Result], pieces: Iterable[tuple[object, ...]], /) -> Iterator[Result]:
        """Yield what `work` makes of the arguments of each piece, in their order.

        What a lost worker had is done by another one. Raises what `work` raises, MachineError where workers cannot
        import it, LostError where the scheduler is gone, or all workers for long.
        """
        waiting: deque[Any] = deque()
        for piece in pieces:
            if len(waiting) >= AHEAD * max(1, self.count):
                yield self._result(waiting.popleft())
            with self._reached():
                waiting.append(self._client.submit(work, *piece, pure=False))
        while waiting:
            yield self._result(waiting.popleft())

    def everywhere(self, work: Callable[[], object], /) -> None:
        """Let every worker do something; those that are gone need not."""
        with suppress(LostError), self._reached():
            self._client.run(work, on_error="ignore")

    def _result(self, future: Any) -> Any:
        with self._reached():
            self._wait(future)
            failure = future.exception()
            if failure is None:
                return future.result()
        raise self._told(failure)

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
    def _reached(self) -> Iterator[None]:
        try:
            yield
        except (CancelledError, OSError) as error:
            raise LostError(f"{self._place}: the scheduler is gone") from error

    def _told(self, error: Exception) -> Exception:
        if isinstance(error, ImportError | AttributeError):
            return MachineError(f"{self._place}: a worker lacks what this takes: {error}")
        if isinstance(error, need_distributed().KilledWorker):
            return LostError(f"{self._place}: worker after worker died of the same work; their logs may tell why")
        return error


def _itself(thing: object) -> object:
    return thing
