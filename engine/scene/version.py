"""Versions of the scene format, and upgrades from one to the next."""

from typing import Any

from ..declared.scene import FORMAT

Values = dict[str, Any]

FIRST_LIGHT = {"sun": "#fff1d6", "zenith": "#4f86c6", "horizon": "#cfdfe8", "haze": 900.0}
"""Defaults of light in format 1: a sky of two colours, where later formats have that of clear air."""

FIRST_GRASS = {"width": 0.012, "taper": 1.0, "clumping": 0.0}
"""Defaults of grass in format 1: later grass is broader."""


def _with_defaults(values: object, defaults: Values, /) -> object:
    """Return a mapping, or None, with defaults filled in; anything else is returned unchanged."""
    return {**defaults, **(values or {})} if values is None or isinstance(values, dict) else values


def _second(values: Values) -> Values:
    """Upgrade a scene from format 1 to 2, with the defaults of format 1 written out, so that it looks the same."""
    grass = values.get("grass")
    if isinstance(grass, dict):
        grass = {name: _with_defaults(kind, FIRST_GRASS) for name, kind in grass.items()}
    kinds = {"grass": grass} if "grass" in values else {}
    return {"mixing": "priority"} | values | kinds | {"light": _with_defaults(values.get("light"), FIRST_LIGHT)}


STEPS = (_second,)
"""Functions that upgrade a scene's values, each to the next format, from format 1 on."""

FIRST = f"a scene begins with 'tallgrass: {FORMAT}', the version of the scene format"


def upgrade(values: Values, version: int, /) -> Values:
    """Return the values upgraded to the present format. Raises ValueError for an unknown version."""
    if version > FORMAT:
        raise ValueError(f"this scene is of format {version}, this release reads up to {FORMAT}; update tallgrass")
    if version < 1:
        raise ValueError(f"there is no scene format {version}; write 'tallgrass: {FORMAT}'")
    for step in STEPS[version - 1 :]:
        values = step(values) | {"tallgrass": FORMAT}
    return values
