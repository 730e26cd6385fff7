"""The parts of a picture, any of which a game may leave out to draw its own."""

from collections.abc import Iterable
from reprlib import repr as shortened
from typing import Literal, cast

from ...components.words import suggestion

PartName = Literal["sky", "ground", "grass", "beyond"]

PARTS: tuple[PartName, ...] = ("sky", "ground", "grass", "beyond")
"""All parts: together they are a whole picture.

Bodies come with the grass; `beyond` is all ground and grass beyond the terrain's edge."""

DEPTHS = "near", "all", "none"
"""Grass that writes depth: the nearest, or all that covers at least half a pixel. `none` is for pictures in which
nothing but the prairie has depth, neither before nor after it is drawn."""


def as_parts(names: object, /) -> frozenset[PartName]:
    """Return parts by their names. Raises TypeError for anything but a list, ValueError for an unknown name."""
    if isinstance(names, str) or not isinstance(names, Iterable):
        raise TypeError(f"parts are given as a list of names such as ('ground', 'grass'), unlike {shortened(names)}")
    found = list(names)
    for name in found:
        if name not in PARTS:
            raise ValueError(f"no part of a prairie is called {shortened(name)}{suggestion(str(name), PARTS)}")
    return frozenset(cast("list[PartName]", found))
