"""Blades on their way to their painted places, as the graphics card puts them (X3, X4)."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Any

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass.engine.camera import Camera
from tallgrass.engine.gl.shaders import program
from tallgrass.engine.gl.stream import Stream, release_all
from tallgrass.systems.around.appearance import Appearance
from tallgrass.systems.around.outlook import Outlook
from tallgrass.systems.grow.bend import bending
from tallgrass.systems.painter import UNITS, Painter
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.show.blades import draw as blades_draw
from tallgrass.systems.show.blades.draw import PAINTED, Ribbons
from tallgrass.systems.show.blades.painter import BladesPainter
from tallgrass.systems.show.blades.plant import standing_blades
from tallgrass.systems.show.blades.representation import BladeRepresentation
from tallgrass.systems.show.blades.shown import Standing
from tallgrass.systems.show.strips import draw as strips_draw
from tallgrass.systems.show.strips.gather import gather_strips, polygon_strips
from tallgrass.systems.show.strips.painter import StripsPainter
from tallgrass.systems.show.strips.representation import StripRepresentation
from tallgrass.systems.show.strips.stand import falls
from tallgrass.systems.transition import FADE
from tallgrass.testing import Stage as Room

Doubles = NDArray[np.float64]
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
  blades: 40
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
    """A stage of the size at which half a pixel is meant."""
    made = Room(ctx, SIZE)
    yield made
    made.release()


@pytest.fixture(scope="module")
def told() -> Iterator[list[tuple[str, Defines]]]:
    """What each vertex shader of blades and strips was told at the top, in the order in which they were made."""
    found: list[tuple[str, Defines]] = []

    def noting(joined: Callable[..., moderngl.Program]) -> Callable[..., moderngl.Program]:
        def join(*args: Any, **options: Any) -> moderngl.Program:
            found.append((args[3], dict(args[5])))
            return joined(*args, **options)

        return join

    with pytest.MonkeyPatch.context() as patch:
        for module in (blades_draw, strips_draw):
            patch.setattr(module, "joined", noting(module.joined))
        yield found


@dataclass(slots=True)
class Scene:
    """A moment in which some patches are on their way."""

    prairie: Prairie
    outlook: Outlook
    appears: Appearance
    painter: Painter
    blades: BladesPainter
    strips: StripsPainter
    representation: StripRepresentation
    morphing: Standing
    records: NDArray[np.void]
    """The blades on their way, where they stand, as `BLADE` has it, shape (n,)."""
    message: NDArray[np.float32]
    """What each is told, shape (n, 2)."""
    row: NDArray[np.int64]
    """Row of each one's patch, shape (n,)."""
    own: NDArray[np.int64]
    """Its number on the patch, shape (n,)."""
    along: int
    defines: dict[str, Defines]
    """What the shaders of ribbons on their way, and of strips, are told at the top."""


@pytest.fixture(scope="module", params=[0, 90], ids=["strips along x", "strips along z"])
def scene(
    request: pytest.FixtureRequest, room: Room, load: Load, camera: Aim, on_card: OnCard, told: list[Any]
) -> Scene:
    """Patches on their way, on a hillside and in the wind, for either orientation of the strips."""
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
    assert outlook.appearance is not None
    blades, strips = painter.painters["blades"], painter.painters["strips"]
    near, representation = prairie.site.representations[:2]
    assert isinstance(blades, BladesPainter)
    assert isinstance(strips, StripsPainter)
    assert isinstance(near, BladeRepresentation)
    assert isinstance(representation, StripRepresentation)
    numbers = np.frombuffer(blades.numbers.buffer.read(), np.uint32)[: blades.morph.stream.count].astype(np.int64)
    (_, texels), patches, rows = on_card(prairie)[0], outlook.patches, outlook.shown["blades"].standing.rows
    patch, own = np.divmod(numbers, texels.shape[1])
    standing, _ = standing_blades(
        near.stock, patches.cell[rows], patches.model[rows], patches.turn[rows], prairie.site.ground
    )
    return Scene(
        prairie=prairie, outlook=outlook, appears=outlook.appearance, painter=painter, blades=blades, strips=strips,
        representation=representation, morphing=outlook.shown["blades"].morphing, records=standing[patch, own],
        message=texels[patch, own, :2], row=rows[patch], own=own, along=int(yaw == 90.0),
        defines={
            RIBBON: next(defines for name, defines in told if name == RIBBON and "MORPH" in defines),
            STRIP: next(defines for name, defines in told if name == STRIP and "THIN" not in defines),
        },
    )  # fmt: skip


def caught(
    painter: Painter, like: moderngl.Program, name: str, defines: Defines, stream: Stream | None, size: tuple[int, int]
) -> Doubles:
    """What a vertex shader makes of each of some vertices of each of some instances: clip coordinates and one more.

    `like` is the program that it is drawn with otherwise, which has been told everything.
    """
    vertices, count = size
    made = program(
        painter.ctx, name, None, defines={**painter.block.defines, **defines},
        varyings=("gl_Position", "sheet" if stream is None else "half_width"),
    )  # fmt: skip
    for uniform in made:
        if isinstance(made[uniform], moderngl.Uniform) and uniform in like:
            made[uniform].write(like[uniform].read())  # type: ignore[union-attr]
    painter.block.join(made)
    painter.block.write(painter.record)
    for texture in painter.textures:
        painter.textures[texture].use(UNITS[texture])
    painter.received.texture.use(UNITS["received"])
    array = painter.ctx.vertex_array(made, [] if stream is None else [stream.binding(made)])
    buffer = painter.ctx.buffer(reserve=5 * 4 * vertices * count)
    array.transform(buffer, moderngl.POINTS, vertices=vertices, instances=count)
    data = np.frombuffer(buffer.read(), np.float32).reshape(count, vertices, 5).astype(np.float64)
    release_all(array, buffer, made)
    return data


def on_screen(clip: Doubles) -> Doubles:
    return np.asarray(clip[..., :2] / clip[..., 3:4] * np.array(SIZE) / 2)


def middles(data: Doubles) -> Doubles:
    """Middle lines of ribbons, from root to tip [pixels], shape (n, points, 2)."""
    return on_screen(data[:, ::2, :4]) / 2 + on_screen(data[:, 1::2, :4]) / 2


def drawn(scene: Scene, weight: float) -> Doubles:
    """Middle lines of the blades on their way, when they have come so far."""
    ribbons = scene.blades.morph
    moving = np.frombuffer(ribbons.stream.buffer.read(), PAINTED)[: ribbons.stream.count].copy()
    moving["painted"][:, 3] = weight
    stream = Stream(scene.painter.ctx, PAINTED)
    stream.write(moving)
    scene.blades.store.targets.use(UNITS["targets"])
    size = 2 * ribbons.segments + 2, len(moving)
    data = caught(scene.painter, ribbons.program, RIBBON, scene.defines[RIBBON], stream, size)
    stream.release()
    return middles(data)


def in_their_own_places(scene: Scene) -> Doubles:
    """Middle lines of the same blades as 3D blades, sent one by one."""
    painter, segments, count = scene.painter, scene.blades.morph.segments, len(scene.records)
    blades = painter.blade_painter(segments)
    ribbons = Ribbons(painter.ctx, painter.block, segments, UNITS, soft=True)
    blades.write(scene.records, scene.message)
    painter.block.write(painter.record)
    for name, texture in painter.textures.items():
        texture.use(UNITS[name])
    ribbons.fill(blades.array, count)
    defines: Defines = {"SEGMENTS": segments, "COARSER": segments, "SOFT": 1}
    data = caught(painter, ribbons.program, RIBBON, defines, ribbons.stream, (2 * segments + 2, count))
    release_all(ribbons, blades)
    return middles(data)


@dataclass(frozen=True, slots=True)
class Drawn:
    """The polygon strips of all rings, as they are drawn."""

    row: NDArray[np.int64]
    """The patch that each is on, shape (n,)."""

    ring: NDArray[np.int64]
    column: NDArray[np.int64]
    layer: NDArray[np.int64]
    """Which picture is on it, shape (n,)."""

    clip: Doubles
    """Clip coordinates of their vertices, shape (n, 2 * sections + 2, 4)."""


def strips_drawn(scene: Scene, *, whole: bool = True) -> Drawn:
    """All strips, also those that do not show yet: whole, or up to where they are painted."""
    outlook, strips = scene.outlook, scene.strips.strips
    pools, rings = outlook.kept["strips"].pools, outlook.shown["strips"].rings
    appears = replace(scene.appears, handed=np.ones_like(scene.appears.handed))
    counts = {name: each.receivers(outlook) for name, each in scene.painter.painters.items()}
    first = scene.painter.received.lay([count for each in counts.values() for count in each])[1:]
    numbered = [(start, int(np.prod(pool.shape))) for start, pool in zip(first, pools, strict=False)]
    stood = gather_strips(rings, numbered, appears, outlook.patches, outlook.viewer.centre)
    fineness, present = [(ring.strips, ring.columns) for ring in strips.rings], np.ones((len(stood), 2), np.bool_)
    numbers, amount = polygon_strips(stood, np.arange(len(stood)), present, fineness, most=strips.most)
    strips.write(stood)
    strips.write_strips(numbers)
    strips.stood.texture.use(UNITS["stood"])
    strips.strips.texture.use(UNITS["strips"])
    everywhere = np.tile(np.array([0, 1, 1, 0], np.float32), (*strips.extents.size[::-1], 1))
    extents = scene.painter.ctx.texture(strips.extents.size, 4, everywhere.tobytes(), dtype="f4")
    (extents if whole else strips.extents).use(UNITS["extents"])
    strips.programs[0]["first"] = 0
    size = 2 * strips.sections + 2, len(numbers)
    data = caught(scene.painter, strips.programs[0], STRIP, scene.defines[STRIP], None, size)
    extents.release()
    ring = np.repeat(np.arange(len(rings)), [len(each.rows) for each in rings])
    return Drawn(
        row=np.repeat(np.concatenate([each.rows for each in rings]), amount),
        ring=np.repeat(ring, amount),
        column=numbers % strips.most % np.repeat(np.array(fineness)[ring, 1], amount),
        layer=data[:, 0, 4].astype(np.int64),
        clip=data[..., :4],
    )


def first_layers(scene: Scene) -> NDArray[np.int64]:
    """Where each kind's pictures begin in the atlas, by ring and kind."""
    pictures = np.array(scene.strips.strips.programs[0]["pictures"].value)  # type: ignore[union-attr]
    return np.asarray(pictures[:, 2], np.int64)


def painted_places(scene: Scene) -> Doubles:
    """Where the strips as they are drawn show each blade's points, from the root to the tip [pixels]."""
    patches, drawn = scene.outlook.patches, strips_drawn(scene)
    stock, rings = scene.representation.stock, scene.representation.quality.strip_rings
    first, kinds = first_layers(scene), len(stock.strips[0])
    segments, points = scene.blades.morph.segments, stock.targets.shape[3]
    expected = np.zeros((len(scene.records), segments + 1, 2))
    for index, (blade, row, which) in enumerate(zip(scene.records, scene.row, scene.own, strict=True)):
        model, own = int(patches.model[row]), (scene.along + int(patches.turn[row])) % 2
        number = int(patches.sublevel[1, row]) >> 1
        plane = int(stock.slices[number][model, own, which])
        layer = first[kinds * number + int(blade["kind"])] + (model * 2 + own) * rings[number].strips + plane
        here = np.flatnonzero((drawn.layer == layer) & (drawn.row == row))
        assert len(here) == rings[number].columns
        clip, target = drawn.clip[here, : 2 * rings[number].sections + 2], stock.targets[model, own, which]
        for step in range(segments + 1):
            at = step / segments * (points - 1)
            low = min(int(at), points - 2)
            u, v = target[low] + (target[low + 1] - target[low]) * (at - low)
            expected[index, step] = _on_strip(clip, float(u) * len(clip), float(v) * rings[number].sections)
    return expected


def _on_strip(clip: Doubles, across: float, up: float) -> Doubles:
    """The pixel of a point of a strip's texture, in the triangles of its triangle strips (columns, vertices, 4)."""
    column = min(int(across), len(clip) - 1)
    section = min(int(up), clip.shape[1] // 2 - 2)
    u, v = across - column, up - section
    corners = clip[column, 2 * section : 2 * section + 4]
    if u + v <= 1.0:
        place = corners[0] + u * (corners[1] - corners[0]) + v * (corners[2] - corners[0])
    else:
        place = corners[3] + (1 - u) * (corners[2] - corners[3]) + (1 - v) * (corners[1] - corners[3])
    return on_screen(place)


def test_x3_the_blades_on_their_way_are_of_all_kinds_turns_and_slices(scene: Scene) -> None:
    rows, patches = scene.morphing.rows, scene.outlook.patches
    assert len(rows) >= 4
    assert len(set(patches.turn[rows].tolist())) >= 3
    assert set(scene.records["kind"].tolist()) == {0.0, 1.0}
    assert (patches.sublevel[1, rows] & 1 == scene.along).all()
    assert np.abs(patches.slope[rows]).max() > 0.15
    assert np.linalg.norm(scene.message, axis=1).mean() > 0.15


def test_x3_before_it_sets_off_a_blade_is_in_its_own_place(scene: Scene) -> None:
    apart = np.linalg.norm(drawn(scene, 0.0) - in_their_own_places(scene), axis=2)
    assert apart.max() < 0.05


def test_x3_when_it_has_arrived_a_blade_lies_on_its_painted_place(scene: Scene) -> None:
    arrived, painted = drawn(scene, 1.0), painted_places(scene)
    assert np.linalg.norm(arrived - painted, axis=2).max() < 0.5
    assert np.linalg.norm(arrived - in_their_own_places(scene), axis=2).mean() > 1.0


def bent(scene: Scene, kind: NDArray[np.int64], message: NDArray[np.float32]) -> Doubles:
    """Where the tip of an edge of length 1 is that is bent by a message, for kinds (n,) and messages (n, 2)."""
    postures = [growth.postures for growth in scene.prairie.site.growths]
    table = np.stack([each.shape[0, :, -1] for each in postures]).astype(float)
    bend = np.where(kind[:, None] == 0, *(bending(each, message) for each in postures))
    index = np.linalg.norm(bend, axis=1)
    row = (0.5 + 0.5 * np.minimum(index, 1.0)) * (table.shape[1] - 1)
    low = np.minimum(row.astype(int), table.shape[1] - 2)
    part = (row - low)[:, None]
    ahead, up = (table[kind, low] * (1.0 - part) + table[kind, low + 1] * part).T
    heading = bend / np.maximum(index, 1e-6)[:, None]
    return np.stack([heading[:, 0] * ahead, up, heading[:, 1] * ahead], axis=1)


def laid_back(run: Doubles, foot: Doubles, top: Doubles, height: Doubles, spacing: float) -> Doubles:
    """How far the tops of strips lie back, so that none is seen on edge: `foot` (n, 3) is told from the eye."""
    off = np.column_stack([-run[:, 1], np.zeros(len(run)), run[:, 0]]) / np.linalg.norm(run, axis=1)[:, None]
    off *= np.sign((off * foot).sum(axis=1, keepdims=True))
    behind = (off * foot).sum(axis=1) / np.maximum(-foot[:, 1], 0.01)
    least = np.minimum(2.0 * spacing, height * behind)
    back = np.clip(least - (off * top).sum(axis=1) - top[:, 1] * behind, 0.0, 2.0 * least)
    return np.asarray(off * back[:, None])


def test_w1_a_strip_stands_between_two_edges_on_the_ground_each_bent_as_numpy_says(scene: Scene) -> None:
    everything, stock, quality = strips_drawn(scene), scene.representation.stock, scene.representation.quality
    clip = scene.painter.record[0]["clip"].reshape(4, 4).astype(float)
    layers, kinds = first_layers(scene), len(stock.strips[0])
    patches, kept = scene.outlook.patches, scene.outlook.kept["strips"].receiving
    for number, (receiving, ring) in enumerate(zip(kept, scene.outlook.shown["strips"].rings, strict=True)):
        here, count = everything.ring == number, quality.strip_rings[number].strips
        first = layers[kinds * number :][:2]
        layer, column = everything.layer[here], everything.column[here].astype(int)
        kind = (layer >= first[1]).astype(int)
        patch = np.repeat(np.arange(len(ring.rows)), len(layer) // len(ring.rows))
        picture, plane = np.divmod(layer - first[kind], count)
        turn, along = patches.turn[ring.rows], ring.along
        own = (along + turn) % 2
        np.testing.assert_array_equal(picture, (patches.model[ring.rows] * 2 + own)[patch])
        stack = np.where(falls(own, along, turn)[patch], count - 1 - plane, plane)
        places = receiving.pool.places(ring.slots)
        heard = receiving.letters.heard(ring.slots).reshape(places.shape)
        height = np.array([strips.height for strips in stock.strips[0]])[kind] * scene.appears.growth[ring.rows][patch]
        for side in (0, 1):
            at, message = (each[patch, kind, stack, column + side] for each in (places, heard))
            foot = np.column_stack([at[:, 0], scene.prairie.height_at(at), at[:, 1]])
            top = height[:, None] * bent(scene, kind, message)
            run = np.diff([places[patch, kind, stack, column + end] for end in (0, 1)], axis=0)[0]
            tip = foot + top + laid_back(run, foot - scene.outlook.viewer.eye, top, height, quality.patch / count)
            for place, vertex in ((foot, side), (tip, 2 * quality.strip_rings[number].sections + side)):
                expected = np.column_stack([place, np.ones(len(place))]) @ clip
                np.testing.assert_allclose(everything.clip[here, vertex], expected, atol=5e-3)
        assert np.linalg.norm(heard, axis=-1).mean() > 0.15
        assert len(set(turn.tolist())) == 4


def test_g3_a_strip_that_ends_where_its_paint_ends_is_a_part_of_the_whole_one(scene: Scene) -> None:
    texture = scene.strips.strips.extents
    extents = np.frombuffer(texture.read(), np.float32).reshape(*texture.size[::-1], 4)
    everything, ends = strips_drawn(scene), strips_drawn(scene, whole=False)
    for number, ring in enumerate(scene.representation.quality.strip_rings):
        here, vertices = everything.ring == number, slice(2 * ring.sections + 2)
        whole, part = everything.clip[here, vertices], ends.clip[here, vertices]
        top = extents[everything.layer[here], everything.column[here], 2]
        below = np.arange(ring.sections) <= ring.sections * top[:, None]
        foot, run = whole[:, :-2:2, None], (whole[:, 1:-2:2] - whole[:, :-2:2])[:, :, None]
        edges = np.stack([part[:, :-2:2], part[:, 1:-2:2]], axis=2)
        across = ((edges - foot) * run).sum(axis=3) / (run * run).sum(axis=3)
        np.testing.assert_allclose(edges[below], (foot + across[..., None] * run)[below], atol=1e-3)
        assert below.mean() > 0.5
        assert (np.abs(across[below] - 0.5) < 0.5 + 1e-4).all()
        assert (across[..., 1] - across[..., 0])[below].min() < 0.95


def test_x3_in_between_it_is_on_the_straight_way(scene: Scene) -> None:
    start, middle, end = (drawn(scene, weight) for weight in (0.0, 0.5, 1.0))
    apart = np.linalg.norm(middle - (start + end) / 2, axis=2)
    assert np.quantile(apart, 0.95) < 1.0


def test_x3_blades_come_to_their_places_before_their_strips_show(scene: Scene) -> None:
    appears, rows = scene.appears, scene.morphing.rows
    assert (appears.handed[rows] <= appears.morph[rows]).all()
