"""What was made for a viewer is made once, whoever looks in between."""

import numpy as np
import pytest

from tallgrass.engine.gl.remembered import MOST_VIEWERS, Remembered


@pytest.fixture
def made() -> list[str]:
    """What has been made so far."""
    return []


def of(remembered: Remembered[str], made: list[str], viewer: str, *made_of: object) -> bool:
    """Ask for what is made for a viewer of some things; return whether it is to be sent."""

    def make() -> str:
        made.append(viewer)
        return f"{viewer} {len(made)}"

    found, is_new = remembered.of(viewer, made_of, make)
    assert found.startswith(viewer)
    return is_new


def test_what_is_made_of_the_same_is_made_and_sent_once(made: list[str]) -> None:
    remembered = Remembered[str]()
    sent = [of(remembered, made, "main", np.array([1, 2]), "left") for _ in range(3)]
    assert (sent, made) == ([True, False, False], ["main"])
    assert of(remembered, made, "main", np.array([1, 3]), "left")
    assert of(remembered, made, "main", np.array([1, 3]), "right")
    assert made == ["main"] * 3


def test_of_two_viewers_in_turn_each_ones_own_is_sent_again_and_not_made_again(made: list[str]) -> None:
    remembered = Remembered[str]()
    sent = [of(remembered, made, viewer, viewer) for viewer in ("one", "other") * 3]
    assert all(sent)
    assert made == ["one", "other"]


def test_what_was_sent_is_sent_again_after_something_else_was(made: list[str]) -> None:
    remembered = Remembered[str]()
    of(remembered, made, "main", 1)
    remembered.lose()
    assert of(remembered, made, "main", 1)
    assert made == ["main"]


def test_made_of_nothing_to_be_told_apart_it_is_made_each_time() -> None:
    remembered = Remembered[list[int]]()
    one, other = (remembered.of("main", None, list)[0] for _ in range(2))
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
