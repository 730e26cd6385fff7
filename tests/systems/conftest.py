"""What the tests of the systems share: a small field on uneven ground, grown once."""

from collections.abc import Callable
from math import pi

import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass.components.grass import GrassKind
from tallgrass.components.growth import Growth
from tallgrass.components.quality import BladeRing, Quality, StripRing
from tallgrass.components.scene import Scene
from tallgrass.components.terrain import Density, Terrain
from tallgrass.systems.field import Field, lay_out
from tallgrass.systems.growth.models import grow

KINDS = {
    "tall": GrassKind(height=[0.6, 1.0], width=0.01, stiffness=0.6, lean=0.4),
    "short": GrassKind(height=[0.2, 0.4], width=0.014, stiffness=2.0, lean=0.2, blades=12),
}
QUALITY = Quality(
    blades=30,
    models=2,
    blade_rings=[BladeRing(to=1, segments=3), BladeRing(to=2, segments=2)],
    strip_rings=[
        StripRing(to=4, strips=3, columns=2, sections=1, texel=0.05),
        StripRing(to=6, strips=2, columns=1, sections=1, texel=0.08),
    ],
    carpet_to=9,
    carpet=8,
)
SCENE = Scene(tallgrass=1, seed=3, grass=KINDS, quality=QUALITY)

Laid = Callable[..., Field]


@pytest.fixture(scope="session")
def growths() -> list[Growth]:
    """What is grown of a tall soft kind and of a short stiff one."""
    return [grow(kind, QUALITY, seed=number) for number, kind in enumerate(KINDS.values())]


@pytest.fixture(scope="session")
def hills() -> Terrain:
    """Ground that is steep nearly everywhere, 90 m wide and 70 m deep."""
    x, z = np.meshgrid(np.arange(91) * 0.4, np.arange(71) * 0.3)
    rough = np.random.default_rng(1).normal(0.0, 0.3, x.shape)
    return Terrain((3.0 * np.sin(x) + 2.0 * np.cos(z + 0.1 * x) + rough).astype(np.float32), 1.0)


@pytest.fixture
def laid(growths: list[Growth], hills: Terrain) -> Laid:
    """Lay out a field; `dense` gives the kinds' densities, (kinds, rows, columns), over the whole terrain."""

    def make(*, lod: str = "auto", dense: NDArray[np.float32] | None = None, terrain: Terrain = hills) -> Field:
        maps = np.ones((2, 2, 2), np.float32) if dense is None else dense
        field = lay_out(SCENE, QUALITY, terrain, Density(maps, terrain.size), growths, lod=lod)
        field.sight.cone = (0.0, pi)
        return field

    return make
