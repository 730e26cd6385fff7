"""Attributes that are set on immutable components and winds are refused in a sentence (D5)."""

from typing import Any

import numpy as np
import pytest

from tallgrass import Extent, Footprint, Gust, Hover, Lamp, Pose, Presser, Road, Shade, Tree, TwinValues, WindSource

THINGS = (
    Extent(0.0, 1.0, 0.0, 1.0), Footprint(), Gust(), Hover(), Lamp(), Pose(), Presser(), Road([(0, 0), (1, 1)]),
    Shade((0, 0, 0), 1.0), Tree("oak"), TwinValues(), WindSource(Gust(), "gust"),
)  # fmt: skip


@pytest.mark.parametrize("thing", THINGS, ids=lambda thing: type(thing).__name__)
def test_a_misspelt_attribute_is_refused_with_a_similar_one(thing: Any) -> None:
    own = getattr(type(thing), "model_fields", None) or type(thing).__dataclass_fields__
    name = max((each for each in own if not each.startswith("_")), key=len)
    with pytest.raises(AttributeError, match=f"^'{name}y' of a .* it has none, did you mean '{name}'\\?$"):
        setattr(thing, f"{name}y", 1.0)
    with pytest.raises(AttributeError, match=f"^'{name}' of a .* as it is immutable: make another one$"):
        setattr(thing, name, 1.0)


def test_a_wind_that_is_given_values_without_their_names_says_so() -> None:
    with pytest.raises(TypeError, match=r"^a Gust takes its values by name, such as \w+=\.\.\.$"):
        Gust([3, 4])  # type: ignore[arg-type, call-arg]


def test_a_class_of_a_game_that_derives_from_a_component_may_have_attributes_of_its_own() -> None:
    class Rider(Presser):
        """Has no dict of its own but by this class, and is no data class."""

    rider: Any = Rider(radius=0.5)
    rider.horse = "grey"
    assert rider.horse == "grey"
    with pytest.raises(AttributeError, match="immutable"):
        rider.radius = np.float32(0.3)
