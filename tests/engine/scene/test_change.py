"""Changing a part of a scene while it runs."""

import pytest

from tallgrass.engine.declared.light import Light
from tallgrass.engine.scene.validate import changed


def test_what_is_not_named_stays() -> None:
    before = Light(elevation=20.0, clouds=0.3)
    assert changed(before, {"elevation": 30.0}, name="light") == Light(elevation=30.0, clouds=0.3)
    assert before.elevation == 20.0


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({"hours": 3}, "unknown key 'hours', did you mean 'hour'?"),
        (
            {"hour": 25, "clouds": True},
            "hour must be between 0 and 24 h, found 25; clouds must be a number, found true",
        ),
    ],
)
def test_what_cannot_be_is_told_in_the_words_of_a_scene(values: dict[str, object], said: str) -> None:
    with pytest.raises(ValueError, match=r"must|unknown") as caught:
        changed(Light(), values, name="light")
    assert str(caught.value) == said
