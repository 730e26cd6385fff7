"""The versions of the scene format, and the steps from one to the next."""

from collections.abc import Callable, Mapping
from typing import Any

from ..declared.scene import FORMAT

Values = dict[str, Any]
Steps = Mapping[int, Callable[[Values], Values]]

FIRST_LIGHT = {"sun": "#fff1d6", "zenith": "#4f86c6", "horizon": "#cfdfe8", "haze": 900.0}
"""What a scene of format 1 did not say of its light: a sky of two colours, where later ones have that of clear air."""

FIRST_GRASS = {"width": 0.012, "taper": 1.0, "clumping": 0.0}
"""What it did not say of its grass: later grass is broader."""


def _with(said: object, unsaid: Values, /) -> object:
    """Return what was said and, where that is a mapping or nothing, what was not."""
    return {**unsaid, **(said or {})} if said is None or isinstance(said, dict) else said


def _second(values: Values) -> Values:
    """Return a scene of format 1 as one of format 2: what it left unsaid looks as it did."""
    grass = values.get("grass")
    kinds = {name: _with(kind, FIRST_GRASS) for name, kind in grass.items()} if isinstance(grass, dict) else grass
    told = {"grass": kinds} if "grass" in values else {}
    return {"mixing": "priority"} | values | told | {"light": _with(values.get("light"), FIRST_LIGHT)}


STEPS: Steps = {1: _second}
"""Turns the values of a scene of one version into those of the next, by the version it starts from."""

FIRST = f"a scene begins with 'tallgrass: {FORMAT}', the version of the scene format"


def upgrade(values: Values, version: int, /, *, steps: Steps = STEPS, to: int = FORMAT) -> Values:
    """Return the values as version `to` writes them. Raises ValueError for a version that nobody knows."""
    if version > to:
        raise ValueError(f"this scene is of format {version}, this release reads up to {to}; update tallgrass")
    for step in range(version, to):
        if step not in steps:
            raise ValueError(f"there is no scene format {version}; write 'tallgrass: {to}'")
        values = steps[step](values) | {"tallgrass": step + 1}
    return values
