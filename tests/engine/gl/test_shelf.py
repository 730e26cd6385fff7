"""Uploads for a viewer stay on its shelf while other viewers look."""

import pytest

from tallgrass.engine.gl.remembered import MOST_VIEWERS, Shelves


class Viewer:
    """Anything that lives as long as a viewer."""


class Shelf:
    """A shelf that records its release."""

    def __init__(self, left: list["Shelf"]) -> None:
        self._left = left
        left.append(self)

    def release(self) -> None:
        self._left.remove(self)


@pytest.fixture
def left() -> list[Shelf]:
    """The shelves there are."""
    return []


@pytest.fixture
def shelves(left: list[Shelf]) -> Shelves[Shelf]:
    return Shelves(lambda: Shelf(left))


def test_the_first_viewer_has_what_was_there_before_and_others_their_own(
    shelves: Shelves[Shelf], left: list[Shelf]
) -> None:
    one, other = Viewer(), Viewer()
    found = [shelves.of(name, viewer) for name, viewer in (("one", one), ("other", other)) * 2]
    assert found == [left[0], left[1]] * 2
    assert shelves.now is left[1]


def test_a_shelf_goes_with_its_viewer_or_serves_the_next_new_one(shelves: Shelves[Shelf], left: list[Shelf]) -> None:
    here, gone = Viewer(), Viewer()
    shelves.of("here", here)
    shelves.of("gone", gone)
    kept = left[1]
    del gone
    new = Viewer()
    assert shelves.of("new", new) is kept
    del new
    shelves.of("here", here)
    assert left == [shelves.now]


def test_who_comes_again_by_the_same_name_has_the_same_shelf(shelves: Shelves[Shelf], left: list[Shelf]) -> None:
    first = Viewer()
    shelf = shelves.of("main", first)
    del first
    again = Viewer()
    assert shelves.of("main", again) is shelf
    assert left == [shelf]


def test_there_are_no_more_shelves_than_viewers_that_are_remembered(shelves: Shelves[Shelf], left: list[Shelf]) -> None:
    viewers = [Viewer() for _ in range(MOST_VIEWERS + 1)]
    found = [shelves.of(str(number), viewer) for number, viewer in enumerate(viewers)]
    assert len(left) == MOST_VIEWERS
    assert found[-1] is found[0]
    shelves.release()
    assert left == []
