"""Tallgrass grows, animates and draws whole prairies in real time."""

from importlib import import_module
from sys import modules
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from . import scenes
    from .components.body import Hover
    from .components.footprint import Footprint, Road
    from .components.grass_at import GrassAt
    from .components.lamp import Lamp
    from .components.patch import Lod, Patch
    from .components.pose import Pose
    from .components.presser import Presser
    from .components.receivers import Receivers
    from .components.shade import Shade
    from .components.shadow_map import ShadowMap
    from .components.sun import Sun
    from .components.tree import Tree
    from .components.viewer import Viewer
    from .components.wind import Extent, Grass, TwinValues, WindPrimitive, WindSource
    from .engine.declared.scene import Scene
    from .engine.plugins import wind
    from .engine.scene import SceneError
    from .engine.schedule import Phase
    from .engine.world import install
    from .systems.prairie import Prairie
    from .systems.wind.blast import Blast, Shape
    from .systems.wind.breeze import Breeze
    from .systems.wind.gust import Gust
    from .systems.wind.mean import MeanWind
    from .systems.wind.placed import PlacedWind
    from .systems.wind.turbulence import Turbulence
    from .systems.wind.whirlwind import Whirlwind

__version__ = "1.0.0"

__all__ = [
    "Blast",
    "Breeze",
    "Extent",
    "Footprint",
    "Grass",
    "GrassAt",
    "Gust",
    "Hover",
    "Lamp",
    "Lod",
    "MeanWind",
    "Patch",
    "Phase",
    "PlacedWind",
    "Pose",
    "Prairie",
    "Presser",
    "Receivers",
    "Road",
    "Scene",
    "SceneError",
    "Shade",
    "ShadowMap",
    "Shape",
    "Sun",
    "Tree",
    "Turbulence",
    "TwinValues",
    "Viewer",
    "Whirlwind",
    "WindPrimitive",
    "WindSource",
    "install",
    "scenes",
    "wind",
]

_HOMES = {
    "Blast": ".systems.wind.blast",
    "Breeze": ".systems.wind.breeze",
    "Extent": ".components.wind",
    "Footprint": ".components.footprint",
    "Grass": ".components.wind",
    "GrassAt": ".components.grass_at",
    "Gust": ".systems.wind.gust",
    "Hover": ".components.body",
    "Lamp": ".components.lamp",
    "Lod": ".components.patch",
    "MeanWind": ".systems.wind.mean",
    "Patch": ".components.patch",
    "Phase": ".engine.schedule",
    "PlacedWind": ".systems.wind.placed",
    "Pose": ".components.pose",
    "Prairie": ".systems.prairie",
    "Presser": ".components.presser",
    "Receivers": ".components.receivers",
    "Road": ".components.footprint",
    "Scene": ".engine.declared.scene",
    "SceneError": ".engine.scene",
    "Shade": ".components.shade",
    "ShadowMap": ".components.shadow_map",
    "Shape": ".systems.wind.blast",
    "Sun": ".components.sun",
    "Tree": ".components.tree",
    "Turbulence": ".systems.wind.turbulence",
    "TwinValues": ".components.wind",
    "Viewer": ".components.viewer",
    "Whirlwind": ".systems.wind.whirlwind",
    "WindPrimitive": ".components.wind",
    "WindSource": ".components.wind",
    "install": ".engine.world",
    "wind": ".engine.plugins",
}


def __getattr__(name: str) -> object:
    """Load a public name when it is first asked for, so that a command line's help needs no graphics."""
    if name == "scenes":
        return import_module(".scenes", __name__)
    if name not in _HOMES:
        raise AttributeError(f"module 'tallgrass' has no attribute '{name}'", name=name, obj=modules[__name__])
    return getattr(import_module(_HOMES[name], __name__), name)


def __dir__() -> list[str]:
    """Return the public names too that nobody has asked for yet, for completion and suggestions."""
    return sorted({*globals(), *__all__})
