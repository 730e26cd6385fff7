"""The page of public names: which there are, in an order to read them in. Their texts are their docstrings."""

import inspect

import tallgrass
from tallgrass import WindPrimitive

BESIDE_WINDS = ("Extent", "Grass", "Hover", "Pose", "Shape", "TwinValues", "wind")
"""What a wind is written with, besides its base."""


def api() -> str:
    """Return an entry for every public name, as Markdown that mkdocstrings completes."""
    names = [name for name in tallgrass.__all__ if not inspect.ismodule(getattr(tallgrass, name))]
    winds = [name for name in names if inspect.isclass(thing := getattr(tallgrass, name)) and _is_wind(thing)]
    winds.sort(key=lambda name: len(getattr(tallgrass, name).__mro__))
    winds += [name for name in names if name in BESIDE_WINDS]
    rest = [name for name in names if name not in winds and name != "Prairie"]
    parts = ["## A prairie", *map(_entry, ["Prairie", *rest]), "## Winds", *map(_entry, winds)]
    return "\n\n".join(parts) + "\n"


def _is_wind(thing: type) -> bool:
    return issubclass(thing, WindPrimitive)


def _entry(name: str) -> str:
    return f"::: tallgrass.{name}"
