"""The state of a prairie without any GL: what was loaded and grown, and where each patch stands."""

from dataclasses import dataclass, field
from itertools import starmap

import numpy as np
from numpy.typing import NDArray

from ..engine.declared.grass import GrassKind
from ..engine.declared.quality import Quality
from ..engine.declared.scene import Scene
from ..engine.terrain.record import Density, Terrain
from ..engine.terrain.sample import density_at
from .around.ground import Ground
from .around.patches import PatchTable
from .grow.record import Growth
from .lod import SLACK, farthest
from .show.blades.pool import BladePool
from .show.strips.pool import StripPool
from .around.transitions import SEAMLESS, Transitions
from .stock.stock import Stock, stock_up

Floats = NDArray[np.float32]


@dataclass(slots=True, eq=False)
class Sight:
    """Where the prairie is looked at from in this frame."""

    eye: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """(x, y, z) [m]."""

    cone: tuple[float, float] = (0.0, np.pi)
    """Azimuths of the view cone: middle and half width [rad]."""

    centre: NDArray[np.int32] = field(default_factory=lambda: np.zeros(2, np.int32))
    """The viewer's cell (i, j), shape (2,)."""

    dt: float = 0.0
    """Time since the frame before [s]."""

    way: float = 0.0
    """How far the viewer has come since, along the ground [m]."""

    jumped: bool = True
    """Whether the viewer is somewhere else altogether than in the frame before: then nothing changes by and by."""


@dataclass(frozen=True, slots=True, eq=False)
class Field:
    """A prairie's data: what systems read and write."""

    scene: Scene
    quality: Quality
    reach: tuple[int, int, int]
    """Largest discrete distance of each representation."""

    terrain: Terrain
    density: Density
    growths: list[Growth]
    stock: Stock
    ground: Ground
    table: PatchTable
    blades: BladePool
    strips: list[StripPool]
    """By ring."""

    sway: float
    """How far grass may reach beyond its patch, leaning and blown [m]."""

    sight: Sight
    transitions: Transitions = SEAMLESS

    @property
    def finest(self) -> int:
        """Line segments per blade at the finest level."""
        return max(ring.segments for ring in self.quality.blade_rings)


def reach_of(quality: Quality, lod: str) -> tuple[int, int, int]:
    """Return the reach of each representation; `lod` forces one of them, or is `auto`."""
    blades, strips, carpet = quality.reach
    forced = {
        "auto": (blades, strips),
        "blades": (strips, strips),
        "strips": (-SLACK - 1, strips),
        "carpet": (-SLACK - 1,) * 2,
    }
    return (*forced[lod], carpet)


def lay_out(
    scene: Scene,
    quality: Quality,
    terrain: Terrain,
    density: Density,
    growths: list[Growth],
    *,
    lod: str,
    transitions: Transitions = SEAMLESS,
    stock: Stock | None = None,
) -> Field:
    """Return the field of a scene: its patch models in stock, its pools empty.

    With `stock`, what was stocked of these growths before is used again.
    """
    reach = reach_of(quality, lod)
    stock = stock or stock_up(growths, quality.patch)
    near, middle = (max(2 * limit + 1, 1) for limit in farthest(reach))
    together = stock.blades.records.shape[1]
    return Field(
        scene=scene,
        quality=quality,
        reach=reach,
        terrain=terrain,
        density=density,
        growths=growths,
        stock=stock,
        ground=Ground(terrain, density, quality.patch),
        table=PatchTable.allocate(2 * reach[2] + 1),
        blades=BladePool.allocate(near, together),
        strips=[
            StripPool.allocate(middle, len(growths), len(strips[0].plane), ring.columns)
            for strips, ring in zip(stock.strips, quality.strip_rings, strict=True)
        ],
        sway=max(starmap(farthest_reach, zip(scene.grass.values(), growths, strict=True))),
        sight=Sight(),
        transitions=transitions,
    )


def densest_kind(field: Field, place: Floats, /) -> NDArray[np.intp]:
    """Return the kind that grows most densely at ground positions (n, 2) [m], shape (n,)."""
    if len(field.growths) == 1:
        return np.zeros(len(place), np.intp)
    densest: NDArray[np.intp] = np.argmax(density_at(field.density, place), axis=0)
    return densest


def farthest_reach(kind: GrassKind, growth: Growth) -> float:
    """Return how far the tip of a kind's tallest blade can come to be from its root, along the ground [m]."""
    return kind.height[1] * float(np.abs(growth.postures.shape[..., 0]).max())


def blades_in_field(field: Field) -> int:
    """Return how many blades grow on the whole terrain, from the kinds' mean densities."""
    width, depth = field.terrain.size
    patches = width * depth / field.quality.patch**2
    counts = [len(growth.models[0].blades.height) for growth in field.growths]
    return round(patches * float(np.dot(counts, field.density.maps.mean(axis=(1, 2)))))
