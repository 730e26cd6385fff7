"""Anchors of winds: the places and headings that they declare, by which they can be moved and turned."""

from dataclasses import dataclass
from math import atan2, degrees, radians
from typing import Any

from pydantic import BaseModel

from ...components.arrays import Place
from ...components.wind import WindPrimitive
from .fields import Key, keys_of
from .values import Way

PLACE, PATH = "position", "path"
"""Keys of a wind's place; a path takes precedence."""

HEADINGS = ("yaw", "direction")
"""Keys of a wind's heading, in degrees as a camera's yaw."""

WHOLE = 1
"""Decimals of a turned heading [degrees]."""


@dataclass(frozen=True, slots=True)
class Anchor:
    """A place that a wind declares, and the way to its key."""

    way: Way
    place: Place


def declared_anchors(wind: WindPrimitive, number: int, /) -> list[Anchor]:
    """Return the anchors of the wind with this index: those of its path, else its own place."""
    path = getattr(wind, PATH, None)
    if isinstance(path, list) and path:
        found = ((("wind", number, PATH, k), stop) for k, stop in enumerate(path) if isinstance(stop, BaseModel))
        return [anchor for way, stop in found for anchor in _anchor(stop, way)]
    return _anchor(wind, ("wind", number))


def _anchor(part: BaseModel, way: Way) -> list[Anchor]:
    place: Any = getattr(part, PLACE, None)
    if _key(part, PLACE, form="numbers") is None or not isinstance(place, list) or len(place) != 2:
        return []
    return [Anchor((*way, PLACE), (float(place[0]), float(place[1])))]


def heading(wind: WindPrimitive, number: int, /) -> tuple[Way, float] | None:
    """Return the way to the heading of the wind with this index, and the heading [rad].

    None for a wind that is everywhere, whose heading has no place on the ground, and for a wind on a path, which has
    its own headings.
    """
    if not declared_anchors(wind, number) or getattr(wind, PATH, None):
        return None
    named = next((name for name in HEADINGS if _key(wind, name, form="number") is not None), None)
    return None if named is None else (("wind", number, named), radians(float(getattr(wind, named))))


def turned_to(middle: Place, place: Place, /) -> float:
    """Return the heading from one ground position (x, z) [m] to another [degrees], in [-180, 180]."""
    return round(degrees(atan2(place[0] - middle[0], middle[1] - place[1])), WHOLE)


def _key(part: BaseModel, name: str, *, form: str) -> Key | None:
    return next((key for key in keys_of(type(part)) if key.name == name and key.form == form), None)
