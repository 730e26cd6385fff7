"""Tasks on daemon threads: in their order, cancelled, and left behind by a program that ends."""

import subprocess
import sys
from threading import Event

import pytest

from tallgrass.engine.executor import DaemonExecutor


def test_tasks_of_one_thread_are_done_in_their_order_and_their_errors_raised_where_asked() -> None:
    done, executor = list[int](), DaemonExecutor()
    futures = [executor.submit(done.append, number) for number in range(50)]
    failed = executor.submit(int, "none")
    assert [future.result(10.0) for future in futures] == [None] * 50
    with pytest.raises(ValueError, match="none"):
        failed.result(10.0)
    assert done == [*range(50)]
    assert executor.submit(int, "7").result(10.0) == 7


def test_release_cancels_what_waits_and_not_what_has_begun() -> None:
    begun, end, executor = Event(), Event(), DaemonExecutor()

    def begin() -> bool:
        begun.set()
        return end.wait(10.0)

    first = executor.submit(begin)
    waiting = executor.submit(int, "7")
    assert begun.wait(10.0)
    executor.release()
    end.set()
    assert first.result(10.0) is True
    assert waiting.cancelled()


QUIT = """\
import time, threading
from tallgrass.engine.executor import DaemonExecutor
begun = threading.Event()
DaemonExecutor().submit(lambda: begun.set() or time.sleep(600))
begun.wait()
"""


def test_a_program_that_ends_does_not_wait_for_its_tasks() -> None:
    """As when a player quits while grass grows."""
    ended = subprocess.run([sys.executable, "-c", QUIT], check=True, timeout=60, capture_output=True, text=True)
    assert ended.stderr == ""
