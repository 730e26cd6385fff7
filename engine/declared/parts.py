"""The parts of a picture: what a game may have by itself, and leave out to draw its own."""

from collections.abc import Iterable
from reprlib import repr as shortened
from typing import Literal, cast

from ...components.words import suggestion

PartName = Literal["sky", "ground", "grass", "beyond"]

PARTS: tuple[PartName, ...] = ("sky", "ground", "grass", "beyond")
"""All of them: together they are a whole picture.

Bodies come with the grass; `beyond` is whatever is drawn of ground and grass that lies beyond the terrain's edge."""

DEPTHS = "near", "all", "none"
"""Which grass writes depth: the nearest, or all that covers at least half a pixel. With none, nothing but the prairie
has any in the picture, neither before it nor after it."""


def as_parts(names: object, /) -> frozenset[PartName]:
    """Return parts by their names. Raises TypeError for what is no list of names, ValueError for one that is none."""
    if isinstance(names, str) or not isinstance(names, Iterable):
        raise TypeError(f"parts are given as a list of names such as ('ground', 'grass'), unlike {shortened(names)}")
    found = list(names)
    for name in found:
        if name not in PARTS:
            raise ValueError(f"no part of a prairie is called {shortened(name)}{suggestion(str(name), PARTS)}")
    return frozenset(cast("list[PartName]", found))
