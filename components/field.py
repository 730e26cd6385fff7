"""A declared field of a scene: its name, type, limits, and the keys below it."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from types import NoneType, UnionType
from typing import Annotated, Any, Union, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo

LIMITS = "ge", "gt", "le", "lt", "min_length", "max_length", "pattern"


@dataclass(frozen=True, slots=True)
class Field:
    """Name and declaration of a value."""

    name: str
    """Name in messages: `width`, `item 2 of path`."""

    annotation: Any = None
    """Declared type, without `Annotated`."""

    limits: dict[str, Any] = field(default_factory=dict)
    """Limits of its range and length, of `X` in `X | None` too, by those names of `LIMITS` that are declared."""

    description: str = ""
    """Docstring of the field that holds it."""

    model: type[BaseModel] | None = None
    """Class of its keys and values, if it is a mapping of known keys."""

    @property
    def keys(self) -> tuple[str, ...]:
        """Known keys of the value."""
        return tuple(self.model.model_fields) if self.model else ()


def declared(name: str, info: FieldInfo, /) -> Field:
    """Return the field that a model declares."""
    annotation, more = _bare(info.annotation)
    limits = _named((*info.metadata, *more))
    return Field(name, annotation, limits, info.description or "", model_of(annotation))


def inside(of: Field, name: str, /) -> Field:
    """Return the field of an item of a list, or of an entry of a mapping whose keys are free."""
    inner = get_args(of.annotation)
    annotation, limits = _bare(inner[-1]) if inner else (of.annotation, ())
    return Field(name, annotation, _named(limits), of.description, model_of(annotation))


def _named(limits: tuple[Any, ...]) -> dict[str, Any]:
    return {name: getattr(limit, name) for limit in limits for name in LIMITS if hasattr(limit, name)}


def _bare(annotation: Any) -> tuple[Any, tuple[Any, ...]]:
    """Return a type without `None` and `Annotated`, and the limits in its annotations."""
    others = [one for one in get_args(annotation) if one is not NoneType]
    if get_origin(annotation) in (Union, UnionType) and len(others) == 1:
        return _bare(others[0])
    if get_origin(annotation) is not Annotated:
        return annotation, ()
    inner, *added = get_args(annotation)
    bare, limits = _bare(inner)
    return bare, (*(limit for one in added for limit in getattr(one, "metadata", ())), *limits)


def model_of(annotation: Any, /) -> type[BaseModel] | None:
    """Return the first model among the parts of a type, or None."""
    return next(_models(annotation), None)


def _models(annotation: Any) -> Iterator[type[BaseModel]]:
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield annotation
    for argument in get_args(annotation):
        yield from _models(argument)
