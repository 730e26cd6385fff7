"""Where winds can be taken hold of: the places and headings that they declare."""

from dataclasses import dataclass
from math import atan2, cos, degrees, radians, sin
from typing import Any

from pydantic import BaseModel

from ...components.wind import WindPrimitive
from .fields import Key, keys_of
from .values import Way

PLACE, PATH = "position", "path"
"""The keys by which winds say where they are; a path comes before a place."""

HEADINGS = ("yaw", "direction")
"""The keys by which they say where they head, in degrees as a camera's yaw."""

WHOLE = 1
"""Decimals of a heading that was turned [degrees]."""


@dataclass(frozen=True, slots=True)
class Anchor:
    """A place that a wind declares, and the key that says so."""

    way: Way
    place: tuple[float, float]
    """Ground position (x, z) [m]."""


def declared_anchors(wind: WindPrimitive, number: int, /) -> list[Anchor]:
    """Return the places that the wind of a number declares: those of its path, or else its own."""
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
    """Return the key that says where the wind of a number heads, and the heading [rad].

    None for one that is everywhere, whose heading has no place on the ground, and for one on a path, which says where
    it leads.
    """
    if not declared_anchors(wind, number) or getattr(wind, PATH, None):
        return None
    named = next((name for name in HEADINGS if _key(wind, name, form="number") is not None), None)
    return None if named is None else (("wind", number, named), radians(float(getattr(wind, named))))


def turned_to(middle: tuple[float, float], place: tuple[float, float], /) -> float:
    """Return the heading from one ground position (x, z) [m] to another [degrees], in [-180, 180]."""
    return round(degrees(atan2(place[0] - middle[0], middle[1] - place[1])), WHOLE)


def ahead(middle: tuple[float, float], yaw: float, away: float, /) -> tuple[float, float]:
    """Return the ground position (x, z) [m] that is so far away [m] where a heading [rad] leads."""
    return middle[0] + away * sin(yaw), middle[1] - away * cos(yaw)


def _key(part: BaseModel, name: str, *, form: str) -> Key | None:
    return next((key for key in keys_of(type(part)) if key.name == name and key.form == form), None)
