"""An executor on daemon threads: a program that ends does not wait for its tasks."""

from collections import deque
from collections.abc import Callable
from concurrent.futures import Future
from threading import Lock, Thread
from typing import ParamSpec, TypeVar

P = ParamSpec("P")
Result = TypeVar("Result")


class DaemonExecutor:
    """Carries out tasks on a few threads, in the order in which they come.

    With a `ThreadPoolExecutor`, a player who quits while grass grows would wait until all of it has grown. A thread
    begins with a task, and ends when none is left.
    """

    def __init__(self, threads: int = 1) -> None:
        self._most, self._running = threads, 0
        self._tasks: deque[tuple[Callable[[], bool], Callable[[], None]]] = deque()
        """How each task that waits is cancelled, and carried out."""
        self._lock = Lock()

    def submit(self, function: Callable[P, Result], /, *args: P.args, **options: P.kwargs) -> "Future[Result]":
        """Return the future of a call."""
        future = Future[Result]()

        def carry_out() -> None:
            if not future.set_running_or_notify_cancel():
                return
            try:
                future.set_result(function(*args, **options))
            except BaseException as error:  # noqa: BLE001 - it is raised where the result is asked for
                future.set_exception(error)

        with self._lock:
            self._tasks.append((future.cancel, carry_out))
            begins = self._running < self._most
            self._running += begins
        if begins:
            Thread(target=self._work, name="tallgrass", daemon=True).start()
        return future

    def release(self) -> None:
        """Cancel the tasks that wait."""
        with self._lock:
            waiting, self._tasks = self._tasks, deque()
        for cancel, _ in waiting:
            cancel()

    def _work(self) -> None:
        while True:
            with self._lock:
                if not self._tasks:
                    self._running -= 1
                    return
                _, carry_out = self._tasks.popleft()
            carry_out()
