"""Which declared field a value of a scene file belongs to."""

from collections.abc import Callable
from dataclasses import replace
from typing import get_origin

from ...components.field import Field, declared, inside
from ...components.wind import WindPrimitive
from ..declared.scene import Scene
from .document import Node, Where

FindKind = Callable[[str], type[WindPrimitive]]
"""Gives the class of a wind's kind, or raises ValueError with a sentence."""


def field_at(root: Node, where: Where, /, *, find: FindKind) -> Field:
    """Return the field at `where`, a way as pydantic gives it: marks of a union and unknown keys are skipped."""
    field, entry, node = Field("the scene", Scene, model=Scene), False, root
    for step in where:
        if isinstance(step, int):
            field = inside(field, f"item {step + 1} of {field.name}")
        elif entry:
            field, entry = inside(field, step), False
        elif field.model is not None and step in field.model.model_fields:
            field = declared(step, field.model.model_fields[step])
            entry = get_origin(field.annotation) is dict
        node = node.below.get(step, node)
        if isinstance(step, int) and field.model is WindPrimitive:
            field = replace(field, model=_kind(node, find))
    return field


def _kind(node: Node, find: FindKind) -> type[WindPrimitive]:
    kind = node.data.get("kind") if isinstance(node.data, dict) else None
    try:
        return find(kind) if isinstance(kind, str) else WindPrimitive
    except ValueError:
        return WindPrimitive
