"""Keys of the panel, derived from the models of scenes."""

from typing import Any, Literal

import pytest
from pydantic import BaseModel, Field

from tallgrass.app.edit.fields import Key, first_part, first_value, item_key, keys_of, tidied, tooltip
from tallgrass.app.edit.values import NOTHING
from tallgrass.components.declaration import Color, Declaration, Pair
from tallgrass.engine.declared.light import Light
from tallgrass.engine.declared.scene import Reading, Scene
from tallgrass.engine.plugins import wind_kinds
from tallgrass.systems.wind.blast import Blast, Shape
from tallgrass.systems.wind.breeze import Breeze


class Rocks(Declaration):
    """A model with all forms of keys, as a plugin may declare them."""

    kind: Literal["rocks"] = "rocks"
    """Rocks."""

    size: float = Field(default=2.0, gt=0.5, le=8.0)
    """How large they are [m]."""

    sides: int | None = Field(default=None, ge=3, le=12)
    """How many sides they have."""

    moss: Color = "#207020"
    """Colour of what grows on them."""

    wet: bool = False
    """Whether it has rained."""

    form: Literal["round", "sharp"] | None = None
    """What they look like."""

    at: Pair
    """Where they lie [m]."""

    corners: list[Pair] = Field(default=[])
    """Their outline."""


def key(model: type[BaseModel], name: str) -> Key:
    return next(each for each in keys_of(model) if each.name == name)


def test_a_strangers_keys_have_fields_by_themselves() -> None:
    assert [(each.name, each.form) for each in keys_of(Rocks)] == [
        ("kind", "fixed"), ("size", "number"), ("sides", "whole"), ("moss", "color"), ("wet", "switch"),
        ("form", "choice"), ("at", "numbers"), ("corners", "yaml"),
    ]  # fmt: skip
    size, sides, at = key(Rocks, "size"), key(Rocks, "sides"), key(Rocks, "at")
    assert (size.low, size.high, size.above, size.unit, size.default) == (0.5, 8.0, True, "m", 2.0)
    assert (sides.low, sides.high, sides.optional, sides.default) == (3, 12, True, None)
    assert (at.count, at.default) == (2, NOTHING)
    assert key(Rocks, "form").choices == ("round", "sharp")
    assert tooltip(size) == "How large they are.\n0.5 to 8 m\ndefault: 2"


def models() -> list[type[BaseModel]]:
    kinds = [wind_kinds().find(kind) for kind in wind_kinds().names()]
    found: list[type[BaseModel]] = [Scene, *kinds]
    for model in found:
        found += [each.model for each in keys_of(model) if each.model is not None and each.model not in found]
    return found


@pytest.mark.parametrize("model", models(), ids=lambda model: model.__name__)
def test_every_key_of_every_model_has_a_field_and_a_sentence(model: type[BaseModel]) -> None:
    keys = keys_of(model)
    assert [each.name for each in keys] == list(model.model_fields)
    for each in keys:
        assert each.sentence.endswith((".", "]")), each.name
        if each.form in ("part", "parts", "named"):
            assert each.model is not None, each.name


def test_a_preset_may_give_way_to_its_numbers() -> None:
    quality = key(Scene, "quality")
    assert quality.form == "choice"
    assert "ultra" in quality.choices
    assert quality.model is not None
    assert "blade_rings" in quality.model.model_fields


def test_a_key_that_gets_its_first_value_is_accepted_wherever_it_can_be() -> None:
    for each in keys_of(Light):
        Light.model_validate({each.name: first_value(each)})
    assert first_part(Shape) == {"disc": 1.0}
    assert first_part(Breeze, kind="breeze") == {"kind": "breeze"}
    values: dict[str, Any] = first_part(Blast, kind="blast")
    scene = {"tallgrass": 2, "grass": {"a": {}}, "wind": [values]}
    Scene.model_validate(scene, context=Reading(wind=wind_kinds().find))
    rings = key(Scene, "quality").model
    assert rings is not None
    assert first_value(key(rings, "blade_rings")) == [{"to": 1, "segments": 2}]
    assert item_key(key(Scene, "grass"), "green").model is key(Scene, "grass").model


@pytest.mark.parametrize(
    ("number", "pulled", "written"),
    [(1.23456, True, 1.23), (1.23456, False, 1.23456), (1234.56, True, 1235.0), (0.5, True, 0.525), (0.5, False, 0.5)],
)
def test_what_is_pulled_is_short_and_what_is_typed_is_kept(number: float, pulled: bool, written: float) -> None:  # noqa: FBT001
    assert tidied(key(Rocks, "size"), number, pulled=pulled) == written


@pytest.mark.parametrize("pulled", [True, False])
def test_what_is_no_number_stays_to_be_refused(*, pulled: bool) -> None:
    for number in (float("nan"), float("inf")):
        assert str(tidied(key(Rocks, "size"), number, pulled=pulled)) == str(number)
