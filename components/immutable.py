"""Refusing attributes that are set on immutable objects, in a sentence."""

from collections.abc import Iterable
from dataclasses import FrozenInstanceError, fields
from typing import Any, TypeVar

from .words import guess

Kind = TypeVar("Kind", bound=type)


def unset(thing: object, name: str, own: Iterable[str], /) -> str:
    """Return the sentence on an attribute that cannot be set on an immutable thing, whose own are `own`."""
    known, what = [*own], f"'{name}' of a {type(thing).__name__} cannot be set, as"
    if name in known:
        return f"{what} it is immutable: make another one"
    return f"{what} it has none{guess(name, known)}"


def immutable(kind: Kind, /) -> Kind:
    """Return a frozen data class that says in a sentence what cannot be set; it costs nothing when one is made.

    Objects of subclasses that are no data classes may take new names, as those of dataclasses may.
    """
    own = [each.name for each in fields(kind)]

    def refuse(self: Any, name: str, value: object) -> None:
        if type(self) is kind or name in own:
            raise FrozenInstanceError(unset(self, name, own))
        super(kind, self).__setattr__(name, value)  # type: ignore[arg-type]

    kind.__setattr__ = refuse  # type: ignore[method-assign, assignment]
    return kind
