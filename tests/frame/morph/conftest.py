"""A moment in which blades morph to their painted places, as computed by the graphics card."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Any

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass.components.arrays import Doubles
from tallgrass.engine.camera import Camera
from tallgrass.engine.gl.shaders import program
from tallgrass.engine.gl.stream import Stream, release_all
from tallgrass.systems.around.appearance import Appearance
from tallgrass.systems.around.outlook import Outlook
from tallgrass.systems.features import UNITS
from tallgrass.systems.land.part import LandPart
from tallgrass.systems.painter import Painter
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.show.blades import draw as blades_draw
from tallgrass.systems.show.blades.painter import BladesPainter
from tallgrass.systems.show.blades.plant import standing_blades
from tallgrass.systems.show.blades.representation import BladeRepresentation
from tallgrass.systems.show.blades.shown import BladesShown, Standing
from tallgrass.systems.show.strips import painter as strips_painter
from tallgrass.systems.show.strips.gather import gather_strips, polygon_strips
from tallgrass.systems.show.strips.painter import StripsPainter
from tallgrass.systems.show.strips.pool import StripsKept
from tallgrass.systems.show.strips.representation import StripRepresentation
from tallgrass.systems.show.strips.shown import StripsShown
from tallgrass.systems.transition import FADE
from tallgrass.testing import Stage as Room

Load = Callable[..., Prairie]
Aim = Callable[..., Camera]
OnCard = Callable[[Prairie], list[tuple[Any, NDArray[np.float32]]]]
Defines = dict[str, str | int]

WINDY = """\
tallgrass: 2
seed: 5
terrain: { noise: ridges, seed: 2, size: [120, 120], feature: 30, scale: 12 }
grass:
  tall: { height: [0.5, 0.9], width: 0.02, lean: 0.4, root: "#5a5a2c", tip: "#dcc98f" }
  short: { height: [0.2, 0.4], width: 0.02, root: "#27401a", tip: "#8fae4a", stiffness: 2 }
wind:
  - { kind: breeze, strength: 0.8, gustiness: 0.9 }
quality:
  blades: 28
  models: 2
  blade_rings: [{ to: 2, segments: 4 }]
  strip_rings:
    - { to: 4, strips: 4, columns: 2, sections: 3, texel: 0.02 }
    - { to: 7, strips: 3, columns: 3, sections: 2, texel: 0.03 }
  carpet_to: 12
  carpet: 32
"""
SIZE = (1280, 720)
RIBBON, STRIP = "systems/show/blades/ribbon.vert", "systems/show/strips/strips.vert"


@pytest.fixture(scope="module")
def room(ctx: moderngl.Context) -> Any:
    """Stage of the size for which a tolerance of half a pixel is meant."""
    made = Room(ctx, SIZE)
    yield made
    made.release()


@pytest.fixture(scope="module")
def told() -> Iterator[list[tuple[str, Defines]]]:
    """Name and macros of each program of blades and strips, in the order in which they were compiled."""
    found: list[tuple[str, Defines]] = []

    def noting(joined: Callable[..., moderngl.Program]) -> Callable[..., moderngl.Program]:
        def join(*args: Any, **options: Any) -> moderngl.Program:
            found.append((args[3], dict(args[5])))
            return joined(*args, **options)

        return join

    with pytest.MonkeyPatch.context() as patch:
        for module in (blades_draw, strips_painter):
            patch.setattr(module, "joined", noting(module.joined))
        yield found


@dataclass(frozen=True, slots=True)
class Drawn:
    """Polygon strips of all rings, as they are drawn."""

    row: NDArray[np.int64]
    """Row of each strip's patch, shape (n,)."""

    ring: NDArray[np.int64]
    column: NDArray[np.int64]
    picture: NDArray[np.int64]
    """Number of the picture on each strip, if strips are drawn whole, shape (n,)."""

    clip: Doubles
    """Clip coordinates of their vertices, shape (n, 2 * sections + 2, 4)."""


@dataclass(slots=True)
class Scene:
    """A moment in which some patches are in transition."""

    prairie: Prairie
    outlook: Outlook
    appears: Appearance
    painter: Painter
    blades: BladesPainter
    strips: StripsPainter
    representation: StripRepresentation
    morphing: Standing
    records: NDArray[np.void]
    """Records `BLADE` of the morphing blades, in their own places, shape (n,)."""
    message: NDArray[np.float32]
    """Message of each blade, shape (n, 2)."""
    row: NDArray[np.int64]
    """Row of each blade's patch, shape (n,)."""
    own: NDArray[np.int64]
    """Number of each blade on its patch, shape (n,)."""
    along: int
    defines: dict[str, Defines]
    """Macros of the shaders of morphing ribbons, and of strips, by file name."""

    def caught(
        self,
        like: moderngl.Program,
        name: str,
        stream: Stream | None,
        size: tuple[int, int],
        *,
        defines: Defines | None = None,
    ) -> Doubles:
        """Run a vertex shader, and return its outputs: clip coordinates, and a varying.

        `size` is the number of vertices and of instances. `like` is the program that draws in frames: its uniforms are
        copied. Without `defines` the macros are that program's, too. The result has the shape (instances, vertices,
        numbers).
        """
        (vertices, count), painter = size, self.painter
        told = self.defines[name] if defines is None else defines
        made = program(
            painter.ctx, name, None, defines={**painter.block.defines, **told},
            varyings=("gl_Position", "lit" if stream is None else "half_width"),
        )  # fmt: skip
        for uniform in made:
            if isinstance(made[uniform], moderngl.Uniform) and uniform in like:
                made[uniform].write(like[uniform].read())  # type: ignore[union-attr]
        painter.block.join(made)
        painter.block.write(painter.record)
        painter.part(LandPart).use()
        painter.received.texture.use(UNITS["received"])
        array = painter.ctx.vertex_array(made, [] if stream is None else [stream.binding(made)])
        numbers = 4 + (16 if stream is None else 1)
        buffer = painter.ctx.buffer(reserve=numbers * 4 * vertices * count)
        array.transform(buffer, moderngl.POINTS, vertices=vertices, instances=count)
        data = np.frombuffer(buffer.read(), np.float32).reshape(count, vertices, numbers).astype(np.float64)
        release_all(array, buffer, made)
        return data

    def strips_drawn(self, *, whole: bool = True) -> Drawn:
        """Return all strips, also those not shown yet: as whole rectangles, or cut to their painted extents."""
        outlook, strips = self.outlook, self.strips
        pools, rings = outlook.keeps(StripsKept).pools, outlook.shows(StripsShown).rings
        appears = replace(self.appears, handed=np.ones_like(self.appears.handed))
        counts = {name: each.receivers(outlook) for name, each in self.painter.painters.items()}
        first = self.painter.received.allocate([count for each in counts.values() for count in each])[1:]
        numbered = [(start, int(np.prod(pool.shape))) for start, pool in zip(first, pools, strict=False)]
        placements = gather_strips(rings, numbered, appears, outlook.patches, outlook.viewer.centre, fade=True)
        fineness, present = (
            [(ring.strips, ring.columns) for ring in strips.rings],
            np.ones((len(placements), 2), np.bool_),
        )
        numbers, amount = polygon_strips(
            placements, np.arange(len(placements)), present, fineness, stride=strips.uploaded.stride
        )
        shelf, painted = strips.shelves.now, strips.uploaded.extents
        shelf.placements.write(placements)
        shelf.strips.write(numbers.view(shelf.strips.record))
        shelf.placements.texture.use(UNITS["placements"])
        shelf.strips.texture.use(UNITS["strips"])
        everywhere = np.frombuffer(painted.read(), np.float32).reshape(*painted.size[::-1], 4).copy()
        everywhere[:, :-1, :3] = 0, 1, 1  # whole rectangles, whatever is painted
        everywhere[:, :-1, 3] = np.arange(len(everywhere))[:, None]  # for the page: the shader returns it
        extents = self.painter.ctx.texture(painted.size, 4, everywhere.tobytes(), dtype="f4")
        (extents if whole else painted).use(UNITS["extents"])
        strips.array(0).program["first"] = 0
        size = 2 * strips.sections + 2, len(numbers)
        data = self.caught(strips.array(0).program, STRIP, None, size)
        extents.release()
        ring = np.repeat(np.arange(len(rings)), [len(each.rows) for each in rings])
        return Drawn(
            row=np.repeat(np.concatenate([each.rows for each in rings]), amount),
            ring=np.repeat(ring, amount),
            column=numbers % strips.uploaded.stride % np.repeat(np.array(fineness)[ring, 1], amount),
            picture=data[:, 0, 16].astype(np.int64),
            clip=data[..., :4],
        )

    @property
    def first_pictures(self) -> NDArray[np.int64]:
        """Number of each kind's first picture in the atlas, by ring and kind."""
        pictures = np.array(self.strips.array(0).program["pictures"].value)  # type: ignore[union-attr]
        kinds = len(self.representation.stock.present[0])
        rings = len(self.representation.quality.strip_rings)
        return np.asarray(pictures[: rings * 2 * kinds].reshape(rings, 2 * kinds)[:, :kinds].reshape(-1), np.int64)


@pytest.fixture(scope="module", params=[0, 90], ids=["strips along x", "strips along z"])
def scene(
    request: pytest.FixtureRequest, room: Room, load: Load, camera: Aim, on_card: OnCard, told: list[Any]
) -> Scene:
    """Patches in transition, on a hillside and in the wind, for either orientation of the strips."""
    prairie, yaw = load(WINDY), float(request.param)

    def look(step: float) -> None:
        x, z = (0.9, 7.5 + step) if yaw == 0.0 else (7.5 - step, 0.9)
        ground = float(prairie.height_at([[x, z]])[0])
        room.shot(prairie, camera(x, ground + 1.7, z, yaw=yaw, pitch=-8))

    look(0.05)
    prairie.advance(4.0)
    look(0.05)
    look(-0.05)
    prairie.advance(0.7 * FADE)
    look(-0.05)
    outlook, painter = prairie.viewers["main"], prairie.painter
    assert painter is not None
    blades, strips = painter.painters["blades"], painter.painters["strips"]
    near, representation = prairie.site.representations[:2]
    assert isinstance(blades, BladesPainter)
    assert isinstance(strips, StripsPainter)
    strips.array(0)
    assert isinstance(near, BladeRepresentation)
    assert isinstance(representation, StripRepresentation)
    sent = np.frombuffer(blades.shelves.now.numbers.buffer.read(), np.uint32)
    numbers = sent[: blades.morph.stream.count].astype(np.int64)
    (_, texels), patches, rows = on_card(prairie)[0], outlook.patches, outlook.shows(BladesShown).standing.rows
    patch, own = np.divmod(numbers, texels.shape[1])
    standing, _ = standing_blades(
        near.stock, patches.cell[rows], patches.model[rows], patches.turn[rows], prairie.site.ground
    )
    return Scene(
        prairie=prairie, outlook=outlook, appears=outlook.appearance, painter=painter, blades=blades, strips=strips,
        representation=representation, morphing=outlook.shows(BladesShown).morphing, records=standing[patch, own],
        message=texels[patch, own, :2], row=rows[patch], own=own, along=int(yaw == 90.0),
        defines={
            RIBBON: next(defines for name, defines in told if name == RIBBON and "MORPH" in defines),
            STRIP: next(defines for name, defines in told if name == STRIP and "THIN" not in defines),
        },
    )  # fmt: skip
