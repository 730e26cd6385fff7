"""Whether the fields of a wind say what they are: they become a scene's schema and what an editor shows."""

import re
from collections.abc import Iterator
from types import UnionType
from typing import Any, Union, get_args, get_origin

from pydantic import ValidationError
from pydantic.fields import FieldInfo

from ..components.wind import WindPrimitive

_UNIT = re.compile(r"\[[^\[\]]+\]")
_UNIT_WORD = re.compile(r"\b(metres|meters|centimetres|seconds|minutes|degrees|radians|hertz)\b", re.IGNORECASE)
_BOUNDS = {"lower": ("ge", "gt"), "upper": ("le", "lt")}


def declaration_problems(primitive: type[WindPrimitive], /) -> list[str]:
    """Return what is wrong with the fields of a class of winds, one sentence each."""
    return [
        f"the field '{name}' {problem}"
        for name, declared in primitive.model_fields.items()
        for problem in _of_field(primitive, name, declared)
    ]


def _of_field(primitive: type[WindPrimitive], name: str, declared: FieldInfo) -> Iterator[str]:
    sentence = (declared.description or "").strip()
    if not sentence:
        yield "has no sentence: write a docstring below it"
    elif _UNIT_WORD.search(sentence) and not _UNIT.search(sentence):
        yield f"names its unit in words: put it in brackets, like [m], unlike in '{sentence}'"
    if _is_number(declared.annotation):
        limits = [*declared.metadata, *_inner_limits(declared.annotation)]
        missing = [end for end, names in _BOUNDS.items() if not any(_sets(limit, names) for limit in limits)]
        if missing:
            yield f"has no {' and no '.join(missing)} bound: write Field(..., ge=..., le=...)"
    if declared.is_required():
        yield "has no default"
    else:
        yield from _of_default(primitive, name, declared)


def _is_number(annotation: Any) -> bool:
    """Return whether values may be numbers by themselves, as in `float | None`, and not only in lists."""
    if annotation in {int, float}:
        return True
    return not _is_list(annotation) and any(_is_number(one) for one in get_args(annotation))


def _is_list(annotation: Any) -> bool:
    origin = get_origin(annotation)
    return isinstance(origin, type) and origin not in {Union, UnionType}  # from Python 3.14 on these are classes


def _inner_limits(annotation: Any) -> Iterator[Any]:
    for declared in getattr(annotation, "__metadata__", ()):
        yield from declared.metadata if isinstance(declared, FieldInfo) else (declared,)
    for one in get_args(annotation):
        yield from _inner_limits(one)


def _sets(limit: Any, names: tuple[str, str]) -> bool:
    return any(getattr(limit, name, None) is not None for name in names)


def _of_default(primitive: type[WindPrimitive], name: str, declared: FieldInfo) -> Iterator[str]:
    default = declared.get_default(call_default_factory=True, validated_data={})
    try:
        primitive.model_validate({name: default})
    except ValidationError as error:
        for one in error.errors():
            if one["loc"][:1] == (name,):
                yield f"refuses its own default {default!r}: {one['msg']}"
    except Exception:  # noqa: BLE001 - what its validators raise else is told of the class, not of each field
        return
