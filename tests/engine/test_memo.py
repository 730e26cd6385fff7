"""Caches by identity, of results that follow from immutable things."""

from tallgrass.engine.memo import by_identity


def test_a_thing_is_asked_about_once_and_its_equal_again() -> None:
    asked: list[list[int]] = []

    @by_identity(most=2)
    def total(numbers: list[int]) -> int:
        asked.append(numbers)
        return sum(numbers)

    one, equal, other = [1, 2], [1, 2], [5]
    assert [total(one), total(one), total(equal), total(equal)] == [3, 3, 3, 3]
    assert len(asked) == 2
    assert (total(other), total(equal), total(one)) == (5, 3, 3)
    assert [id(thing) for thing in asked] == [id(thing) for thing in (one, equal, other, one)]
