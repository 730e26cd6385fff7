"""Changing a part of a scene while it runs."""

from collections.abc import Mapping
from typing import TypeVar

from pydantic import BaseModel, ValidationError

from ...components.words import told
from ..declared.grass import GrassKind
from ..declared.scene import Scene
from .validate import validate
from .values import values_document

Part = TypeVar("Part", bound=BaseModel)


def changed(part: Part, values: Mapping[str, object], /, *, name: str) -> Part:
    """Return a part of a scene, called `name`, with other values.

    Raises ValueError with a sentence for each that cannot be.
    """
    try:
        return type(part).model_validate(part.model_dump() | dict(values))
    except ValidationError as error:
        raise ValueError(told(error, type(part), name)) from error


def changed_kind(scene: Scene, name: str, values: Mapping[str, object], /) -> GrassKind:
    """Return a kind of a scene's grass with other values; those of its `head` join those that it has.

    Raises SceneError with a sentence for each that cannot be, by the path of its key.
    """
    kind = scene.grass[name]
    said = {key: getattr(kind, key) for key in GrassKind.model_fields if key in kind.model_fields_set}
    head = values.get("head")
    if isinstance(head, Mapping) and kind.head is not None:
        said["head"] = {key: getattr(kind.head, key) for key in kind.head.model_fields_set} | dict(head)
        values = {key: value for key, value in values.items() if key != "head"}
    whole = {"tallgrass": scene.tallgrass, "grass": {name: said | dict(values)}, "quality": scene.quality}
    return validate(values_document(whole)).grass[name]
