"""A whole scene, as a file declares it."""

from typing import Literal

from pydantic import Field

from .camera import CameraSource
from .declaration import Declaration
from .grass import GrassKind
from .light import Light
from .quality import PRESETS, Quality
from .terrain import TerrainSource
from .wind import WindPrimitive

FORMAT = 1
"""Version of the scene format that this release writes."""

PresetName = Literal["low", "medium", "high", "ultra", "paper-low", "paper-medium", "paper-high"]


class Scene(Declaration):
    """A prairie: grass kinds, terrain, winds, camera, light and quality."""

    tallgrass: Literal[1]
    """Version of the scene format; always the first key."""

    seed: int = Field(1, ge=0, le=2**31 - 1)
    """Everything random in the scene comes from it."""

    terrain: TerrainSource = TerrainSource(noise="flat")
    """The ground that the grass stands on."""

    grass: dict[str, GrassKind] = Field(min_length=1, max_length=4)
    """Grass kinds by name."""

    wind: list[WindPrimitive] = Field(default=[], max_length=200)
    """Wind primitives."""

    camera: CameraSource = CameraSource()
    """Where the scene is looked at from."""

    light: Light = Light()
    """Sun, sky and haze."""

    quality: PresetName | Quality = "high"
    """A preset, or its numbers."""

    def numbers(self, preset: str | None = None) -> Quality:
        """Return the numbers of `preset`, or else of the scene's own quality."""
        chosen = preset or self.quality
        return PRESETS[chosen] if isinstance(chosen, str) else chosen
