"""What the tests of the systems share: a small field on uneven ground, grown once."""

from collections.abc import Callable
from math import pi

import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass.components.wind import WindPrimitive, WindSource
from tallgrass.engine.declared.grass import GrassKind
from tallgrass.engine.declared.quality import BladeRing, Quality, StripRing
from tallgrass.engine.declared.scene import Scene
from tallgrass.engine.terrain.record import Density, Terrain
from tallgrass.engine.terrain.sample import height_at
from tallgrass.engine.world import World
from tallgrass.systems.around.cone import discrete_distance, inside_cone
from tallgrass.systems.field import Field, lay_out
from tallgrass.systems.grow.record import Growth
from tallgrass.systems.lod import FADE, schedule, wanted_representation, weights
from tallgrass.systems.receive import plant_shown_blades, plant_shown_strips
from tallgrass.systems.refine import refine
from tallgrass.systems.show.seen import Seen, see
from tallgrass.systems.show.seen import look as looks_of
from tallgrass.systems.stock.models import grow
from tallgrass.systems.around.window import cell_of
from tallgrass.systems.tile import tile
from tallgrass.systems.wind.blow import Listeners, blowing, hear
from tallgrass.systems.wind.quarantine import Quarantine

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
Look = Callable[..., Seen]
Hear = Callable[[Listeners], NDArray[np.float32]]


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


@pytest.fixture
def look(world: World) -> Look:
    """Let a field be looked at for one frame, as a prairie does: tile, cull, representations, planting."""

    def at(
        field: Field, x: float, z: float, *, yaw: float | None = None, dt: float = 1e9, jumped: bool = False
    ) -> Seen:
        patch, table = field.quality.patch, field.table
        place = np.array([x, z], np.float32)
        ground = float(height_at(field.terrain, place[None])[0])
        field.sight.eye, field.sight.centre = (x, ground + 1.7, z), cell_of(place, patch=patch)
        field.sight.cone = (0.0, pi) if yaw is None else (yaw, 0.6)
        tile(table, field.sight.centre, field.terrain, world, patch=patch, seed=3, models=2)
        table.distance[:] = discrete_distance(table.cell, field.sight.centre)
        was_visible, middle = table.visible & (not jumped), (table.cell + np.float32(0.5)) * np.float32(patch)
        radius = patch * 0.7072 + field.sway
        table.visible[:] = inside_cone(middle, apex=(x, z), cone=field.sight.cone, radius=radius)
        held = np.where(was_visible & table.visible, table.representation, np.int8(-1))
        wanted = wanted_representation(table.distance, held, reach=field.reach)
        schedule(table, wanted, was_visible, reach=field.reach, part=dt / FADE)
        refine(field, was_visible, weights(table), part=dt / FADE)
        seen = see(field, looks_of(field, weights(table)))
        plant_shown_blades(field, seen.standing)
        for ring, shown in enumerate(seen.strips):
            plant_shown_strips(field, ring, shown)
        return seen

    return at


@pytest.fixture
def wind() -> Callable[..., Hear]:
    """Let listeners hear some winds at a time, in a scene whose seed is 3: `wind(Breeze(), time=2.0)`."""

    def at(*primitives: WindPrimitive, time: float) -> Hear:
        sources = [WindSource(primitive, f"wind[{number}]") for number, primitive in enumerate(primitives)]
        quarantine = Quarantine()
        return lambda heard: hear(blowing(sources, quarantine, time=time, seed=3), heard, quarantine, time=time, seed=3)

    return at
