"""What a scene has become: its ground, and what was grown of its kinds."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from ...engine.declared.quality import Quality
from ...engine.declared.scene import Scene
from ..grow.record import Growth
from .canopy import Top, top_over
from .ground import Ground


@dataclass(frozen=True, slots=True, eq=False)
class Grown:
    """A scene with its ground and its grown kinds."""

    scene: Scene
    quality: Quality
    ground: Ground
    growths: list[Growth]

    canopy: tuple[float, ...]
    """Height of each kind's canopy [m]."""

    tallest: float
    """Height that no blade comes to [m]."""

    coming: Mapping[int, Growth] = field(default_factory=dict, kw_only=True)
    """What some kinds are to become, by their numbers."""

    came: tuple[float, ...] = field(default=(), kw_only=True)
    """How many of its plants each kind has had become that already, from 0 to 1; empty where none is to."""

    @property
    def top_at(self) -> Top:
        """Gives how high the top of the grass is (y) at ground positions (n, 2) [m], shape (n,)."""
        return top_over(self.ground, self.canopy)

    @property
    def own_segments(self) -> tuple[int | None, ...]:
        """Line segments per blade at the finest level that each kind asks for; None of those that do not say."""
        return tuple(kind.segments for kind in self.scene.grass.values())
