"""Tallgrass grows, animates and draws whole prairies in real time."""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from . import scenes
    from .components.wind import WindPrimitive
    from .engine.plugins import wind
    from .engine.scene import SceneError
    from .systems.prairie import Prairie

__version__ = "0.1.0"

__all__ = ["Prairie", "SceneError", "WindPrimitive", "scenes", "wind"]

_HOMES = {
    "Prairie": ".systems.prairie",
    "SceneError": ".engine.scene",
    "WindPrimitive": ".components.wind",
    "wind": ".engine.plugins",
}


def __getattr__(name: str) -> object:
    """Load a public name when it is first asked for, so that a command line's help needs no graphics."""
    if name == "scenes":
        return import_module(".scenes", __name__)
    if name not in _HOMES:
        raise AttributeError(f"module 'tallgrass' has no attribute '{name}'")
    return getattr(import_module(_HOMES[name], __name__), name)
