"""What a game's entities have of ours, as a state holds it."""

from collections.abc import Mapping
from dataclasses import asdict
from numbers import Real
from types import NoneType
from typing import Any, Literal

from ..components.lamp import Lamp
from ..components.presser import Presser
from ..components.shade import Shade
from ..components.tree import Tree

Kind = Literal["presser", "lamp", "shade", "tree"]
Thing = Presser | Lamp | Shade | Tree

THINGS: Mapping[Kind, type[Thing]] = {"presser": Presser, "lamp": Lamp, "shade": Shade, "tree": Tree}
"""Components that are saved, by what a state calls them."""


def fields_of(thing: Thing, /) -> dict[str, Any]:
    """Return the fields of a component, as JSON has them."""
    return {name: _plain(value) for name, value in asdict(thing).items()}


def _plain(value: object) -> object:
    if isinstance(value, bool | str | NoneType):
        return value
    return float(value) if isinstance(value, Real) else [_plain(each) for each in value]  # type: ignore[attr-defined]


def component_of(kind: Kind, fields: Mapping[str, Any], /) -> Thing:
    """Return the component of these fields; raises ValueError for what is none."""
    make: Any = THINGS[kind]
    try:
        made: Thing = make(**{name: tuple(each) if isinstance(each, list) else each for name, each in fields.items()})
    except TypeError as error:
        raise ValueError(f"what was a {kind} is none: {error}") from error
    return made
