"""A scene's ground and the growths of its kinds."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from ...engine.declared.quality import Quality
from ...engine.declared.scene import Scene
from ..grow.record import Growth
from .canopy import Top, top_over
from .ground import Ground


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Grown:
    """A scene with its ground and the growths of its kinds."""

    scene: Scene
    quality: Quality
    ground: Ground
    growths: list[Growth]

    canopy: tuple[float, ...]
    """Height of each kind's canopy [m]."""

    tallest: float
    """Upper bound of the height of all blades [m]."""

    coming: Mapping[int, Growth] = field(default_factory=dict, kw_only=True)
    """Growths that are replacing those of some kinds, by the kinds' numbers."""

    came: tuple[float, ...] = field(default=(), kw_only=True)
    """Fraction of each kind's plants that have been replaced by `coming`, 0 to 1; empty where no kind is replaced."""

    @property
    def top_at(self) -> Top:
        """Function from ground positions (n, 2) [m] to the elevation y of the top of the canopy [m], shape (n,)."""
        return top_over(self.ground, self.canopy)

    @property
    def own_segments(self) -> tuple[int | None, ...]:
        """Line segments per blade at the finest level, as each kind declares them; None where it does not."""
        return tuple(kind.segments for kind in self.scene.grass.values())
