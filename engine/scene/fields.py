"""Which declared field a value of a scene file belongs to."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from ...components.scene import Scene
from ...components.wind import WindPrimitive
from .document import Node, Where

FindKind = Callable[[str], type[WindPrimitive]]
"""Gives the class of a wind's kind, or raises ValueError with a sentence."""


@dataclass(frozen=True, slots=True)
class Field:
    """A value's name, its declaration, and what may stand below it."""

    name: str
    """As people call it: `width`, `item 2 of path`."""

    declared: FieldInfo | None
    """The declared field that holds it."""

    keys: tuple[str, ...]
    """The keys known at this value, if it is a mapping of known keys."""


def field_at(root: Node, where: Where, /, *, find: FindKind) -> Field:
    """Return the field at `where`, a way as pydantic gives it: marks of a union and unknown keys are skipped."""
    model: type[BaseModel] | None = Scene
    name, declared, entry, node = "the scene", None, False, root
    for step in where:
        if isinstance(step, int):
            name = f"item {step + 1} of {name}"
        elif entry:
            name, entry = step, False
        elif model is not None and step in model.model_fields:
            name, declared = step, model.model_fields[step]
            model, entry = _model(declared.annotation), get_origin(declared.annotation) is dict
        node = node.below.get(step, node)
        if isinstance(step, int) and model is WindPrimitive:
            model = _kind(node, find)
    return Field(name, declared, tuple(model.model_fields) if model else ())


def _kind(node: Node, find: FindKind) -> type[WindPrimitive]:
    kind = node.data.get("kind") if isinstance(node.data, dict) else None
    try:
        return find(kind) if isinstance(kind, str) else WindPrimitive
    except ValueError:
        return WindPrimitive


def _model(annotation: Any) -> type[BaseModel] | None:
    return next(_models(annotation), None)


def _models(annotation: Any) -> Iterator[type[BaseModel]]:
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield annotation
    for argument in get_args(annotation):
        yield from _models(argument)
