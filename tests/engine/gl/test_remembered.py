"""Things made for a viewer are made once, whichever viewers look in between."""

import numpy as np
import pytest

from tallgrass.engine.gl.remembered import MOST_VIEWERS, Remembered


@pytest.fixture
def made() -> list[str]:
    """List of all that has been made."""
    return []


def of(remembered: Remembered[str], made: list[str], viewer: str, *made_of: object) -> str:
    """Return what is made for a viewer from some inputs, making it where it is not remembered."""

    def make() -> str:
        made.append(viewer)
        return f"{viewer} {len(made)}"

    found = remembered.of(viewer, made_of, make)
    assert found.startswith(viewer)
    return found


def test_what_is_made_of_the_same_is_made_once(made: list[str]) -> None:
    remembered = Remembered[str]()
    found = [of(remembered, made, "main", np.array([1, 2]), "left") for _ in range(3)]
    assert found[0] is found[1] is found[2]
    assert made == ["main"]
    of(remembered, made, "main", np.array([1, 3]), "left")
    of(remembered, made, "main", np.array([1, 3]), "right")
    assert made == ["main"] * 3


def test_of_two_viewers_in_turn_each_ones_own_is_not_made_again(made: list[str]) -> None:
    remembered = Remembered[str]()
    found = [of(remembered, made, viewer, viewer) for viewer in ("one", "other") * 3]
    assert len({id(each) for each in found}) == len(made) == 2


def test_made_of_nothing_to_be_told_apart_it_is_made_each_time() -> None:
    remembered = Remembered[list[int]]()
    one, other = (remembered.of("main", None, list) for _ in range(2))
    assert one is not other


def test_only_those_who_looked_last_are_remembered(made: list[str]) -> None:
    remembered = Remembered[str]()
    for number in range(MOST_VIEWERS + 1):
        of(remembered, made, str(number))
    of(remembered, made, str(MOST_VIEWERS))
    of(remembered, made, "1")
    assert made == [str(number) for number in range(MOST_VIEWERS + 1)]
    of(remembered, made, "0")
    assert made[-1] == "0"
