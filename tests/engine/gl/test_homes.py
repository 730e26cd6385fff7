"""Things of GL that are released while their context is not current wait until it is."""

from collections.abc import Iterator
from typing import Any

import pytest

from tallgrass.engine.gl import homes


class Away:
    """A thing in a context that is not current; it counts the attempts to release it."""

    def __init__(self, handle: int) -> None:
        self.handle, self.asked = handle, 0

    def release(self) -> bool:
        self.asked += 1
        return False


@pytest.fixture
def left() -> Iterator[list[Any]]:
    before, homes._pending[:] = homes._pending[:], []  # noqa: SLF001
    yield homes._pending  # noqa: SLF001
    homes._pending[:] = before  # noqa: SLF001


def release(*away: Any) -> None:
    some: homes.Homes[Any] = homes.Homes()
    some._homes = [*away]  # noqa: SLF001
    some.release()


def test_all_things_of_a_context_wait_for_it_however_many_they_are(left: list[Any]) -> None:
    waiting = [Away(7) for _ in range(9)]
    release(*waiting)
    assert left == waiting


def test_of_many_contexts_that_never_come_again_only_the_last_are_waited_for(left: list[Any]) -> None:
    for handle in (1, 2, 3, 1, 4, 5):
        release(Away(handle), Away(handle))
    assert {each.handle for each in left} == {3, 1, 4, 5}
    assert all(each.asked == 1 for each in left)
