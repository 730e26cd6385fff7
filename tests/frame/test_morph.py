"""Blades on their way to their painted places, as the graphics card puts them (X3, X4)."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass.engine.camera import Camera
from tallgrass.engine.gl.shaders import program
from tallgrass.engine.gl.stream import release_all
from tallgrass.systems.around.appearance import Appearance
from tallgrass.systems.around.outlook import Outlook
from tallgrass.systems.frame.block import by_kind
from tallgrass.systems.painter import UNITS, Painter
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.show.blades.draw import MOVED, ROUND, BladePainter
from tallgrass.systems.show.blades.morph import Morph, gather_morph
from tallgrass.systems.show.blades.morph_draw import PER_ROW as EDGES_PER_ROW
from tallgrass.systems.show.blades.morph_draw import MorphPainter
from tallgrass.systems.show.blades.painter import BladesPainter
from tallgrass.systems.show.blades.shown import Standing
from tallgrass.systems.show.strips.draw import KINDS, PER_ROW, StripPainter
from tallgrass.systems.show.strips.gather import gather_strips
from tallgrass.systems.show.strips.painter import StripsPainter
from tallgrass.systems.show.strips.representation import StripRepresentation
from tallgrass.systems.transition import FADE
from tallgrass.testing import Stage as Room

Doubles = NDArray[np.float64]
Load = Callable[..., Prairie]
Aim = Callable[..., Camera]

WINDY = """\
tallgrass: 1
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


@pytest.fixture(scope="module")
def room(ctx: moderngl.Context) -> Any:
    """A stage of the size at which half a pixel is meant."""
    made = Room(ctx, SIZE)
    yield made
    made.release()


@dataclass(slots=True)
class Scene:
    """A moment in which some patches are on their way."""

    outlook: Outlook
    appears: Appearance
    painter: Painter
    blades: MorphPainter
    strips: StripsPainter
    representation: StripRepresentation
    morphing: Standing
    morph: Morph
    along: int


@pytest.fixture(scope="module", params=[0, 90], ids=["strips along x", "strips along z"])
def scene(request: pytest.FixtureRequest, room: Room, load: Load, camera: Aim) -> Scene:
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
    representation = prairie.site.representations[1]
    assert isinstance(blades, BladesPainter)
    assert isinstance(strips, StripsPainter)
    assert isinstance(representation, StripRepresentation)
    morphing = outlook.shown["blades"].morphing
    morph = gather_morph(outlook, outlook.kept["blades"].pool, representation, morphing, fade=True)
    return Scene(
        outlook, outlook.appearance, painter, blades.morph, strips, representation, morphing, morph, int(yaw == 90.0)
    )


def caught(painter: Painter, made: moderngl.Program, contents: list[Any], vertices: int, count: int) -> Doubles:
    """What the vertex shader makes of each vertex of each instance: clip coordinates and more."""
    for name, unit in UNITS.items():
        if name in made:
            made[name] = unit
    painter.block.join(made)
    painter.block.write(painter.record)
    for name, texture in painter.textures.items():
        texture.use(UNITS[name])
    array = painter.ctx.vertex_array(made, contents)
    buffer = painter.ctx.buffer(reserve=5 * 4 * vertices * count)
    array.transform(buffer, moderngl.POINTS, vertices=vertices, instances=count)
    data = np.frombuffer(buffer.read(), np.float32).reshape(count, vertices, 5).astype(np.float64)
    release_all(array, buffer)
    return data


def on_screen(clip: Doubles) -> Doubles:
    return np.asarray(clip[..., :2] / clip[..., 3:4] * np.array(SIZE) / 2)


def middles(data: Doubles) -> Doubles:
    """Middle lines of ribbons, from root to tip [pixels], shape (n, points, 2)."""
    edges = on_screen(data[..., :4])
    return np.asarray((edges[:, ::2] + edges[:, 1::2]) / 2)


def drawn(scene: Scene, weight: float) -> Doubles:
    """Middle lines of the blades on their way, when they have come so far."""
    painter, morph = scene.blades, scene.morph
    moving = morph.moving.copy()
    moving["morph"] = weight
    painter.moving.write(moving)
    painter.edges.write(morph.edges)
    painter.edges.texture.use(UNITS["edges"])
    painter.targets.use(UNITS["targets"])
    points = scene.representation.stock.targets.shape[3]
    defines: dict[str, str | int] = {"SEGMENTS": painter.segments, "ROUND": ROUND, "SOFT": 1, "MORPH": 1}
    defines |= {"PER_ROW": EDGES_PER_ROW, "POINTS": points}
    made = program(
        scene.painter.ctx,
        "systems/show/blades/blades.vert",
        None,
        defines=defines,
        varyings=("gl_Position", "half_width"),
    )
    contents = [painter.blades.binding(made), painter.moving.binding(made)]
    data = caught(scene.painter, made, contents, 2 * painter.segments + 2, len(moving))
    made.release()
    return middles(data)


def in_their_own_places(scene: Scene) -> Doubles:
    """Middle lines of the same blades as 3D blades."""
    painter = BladePainter(scene.painter.ctx, scene.painter.block, scene.blades.segments, UNITS, soft=True)
    moved = np.zeros(len(scene.morph.moving), MOVED)
    moved["message"], moved["fade"] = scene.morph.moving["message"], 1.0
    painter.write(scene.morph.blades, moved)
    defines: dict[str, str | int] = {
        "SEGMENTS": painter.segments,
        "COARSER": painter.segments,
        "ROUND": ROUND,
        "SOFT": 1,
    }
    made = program(
        scene.painter.ctx,
        "systems/show/blades/blades.vert",
        None,
        defines=defines,
        varyings=("gl_Position", "half_width"),
    )
    contents = [painter.blades.binding(made), painter.moved.binding(made)]
    data = caught(scene.painter, made, contents, 2 * painter.segments + 2, len(moved))
    release_all(made, painter)
    return middles(data)


@dataclass(frozen=True, slots=True)
class Drawn:
    """The polygon strips of one ring, as they are drawn."""

    row: NDArray[np.int64]
    """The patch that each is on, shape (n,)."""

    layer: NDArray[np.float32]
    clip: Doubles
    """Clip coordinates of their vertices, shape (n, 2 * sections + 2, 4)."""


def strips_drawn(scene: Scene, number: int, *, whole: bool = True) -> Drawn:
    """One ring's strips, also those that do not show yet: whole, or up to where they are painted."""
    outlook, strips = scene.outlook, scene.strips.strips
    pool, shown = outlook.kept["strips"].pools[number], outlook.shown["strips"].rings[number]
    appears = replace(scene.appears, handed=np.ones_like(scene.appears.handed))
    records, counts = gather_strips(pool, shown, appears, outlook.patches, outlook.viewer.centre, ring=number)
    strips.strips.write(records)
    strips.strips.texture.use(UNITS["strips"])
    everywhere = np.tile(np.array([0, 1, 1, 0], np.float32), (*strips.extents.size[::-1], 1))
    extents = scene.painter.ctx.texture(strips.extents.size, 4, everywhere.tobytes(), dtype="f4")
    (extents if whole else strips.extents).use(UNITS["extents"])
    data = caught(scene.painter, strip_program(scene, strips), [], 2 * strips.sections + 2, len(records))
    extents.release()
    sections = scene.representation.quality.strip_rings[number].sections
    return Drawn(np.repeat(shown.rows, counts), records["layer"], data[:, : 2 * sections + 2, :4])


def strip_program(scene: Scene, strips: StripPainter) -> moderngl.Program:
    rings = scene.representation.quality.strip_rings
    defines = {"SECTIONS": strips.sections, "RINGS": len(rings), "KINDS": KINDS, "PER_ROW": PER_ROW}
    made = program(
        scene.painter.ctx, "systems/show/strips/strips.vert", None, defines=defines, varyings=("gl_Position", "h")
    )
    made["tall"] = by_kind([kind.height for kind in scene.representation.stock.strips[0]])
    made["fineness"] = [(ring.columns, ring.sections) for ring in rings]
    made["first"] = 0
    return made


def painted_places(scene: Scene) -> Doubles:
    """Where the strips as they are drawn show each blade's points, from the root to the tip [pixels]."""
    patches, quality = scene.outlook.patches, scene.representation.quality
    stock, rings = scene.representation.stock, quality.strip_rings
    drawn = [strips_drawn(scene, number) for number in range(len(rings))]
    segments, every, points = scene.blades.segments, stock.targets.shape[2], stock.targets.shape[3]
    expected = np.zeros((len(scene.morph.blades), segments + 1, 2))
    for index, blade in enumerate(scene.morph.blades):
        cell = np.floor(blade["root"][::2] / quality.patch).astype(int)
        row = int(np.flatnonzero((patches.cell == cell).all(axis=1))[0])
        model, own = int(patches.model[row]), (scene.along + int(patches.turn[row])) % 2
        number, which = int(patches.sublevel[1, row]) >> 1, int(scene.morph.moving["painted"][index]) % every
        plane = int(stock.slices[number][model, own, which])
        first = stock.first_layer[number][int(blade["kind"])]
        layer = first + (model * 2 + own) * rings[number].strips + plane
        here = np.flatnonzero((drawn[number].layer == layer) & (drawn[number].row == row))
        assert len(here) == rings[number].columns
        clip, target = drawn[number].clip[here], stock.targets[model, own, which]
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
    assert set(scene.morph.blades["kind"].tolist()) == {0.0, 1.0}
    assert (patches.sublevel[1, rows] & 1 == scene.along).all()
    assert np.abs(patches.slope[rows]).max() > 0.15
    assert np.linalg.norm(scene.morph.moving["message"], axis=1).mean() > 0.15


def test_x3_before_it_sets_off_a_blade_is_in_its_own_place(scene: Scene) -> None:
    apart = np.linalg.norm(drawn(scene, 0.0) - in_their_own_places(scene), axis=2)
    assert apart.max() < 0.05


def test_x3_when_it_has_arrived_a_blade_lies_on_its_painted_place(scene: Scene) -> None:
    arrived, painted = drawn(scene, 1.0), painted_places(scene)
    assert np.linalg.norm(arrived - painted, axis=2).max() < 0.5
    assert np.linalg.norm(arrived - in_their_own_places(scene), axis=2).mean() > 1.0


def test_g3_a_strip_that_ends_where_its_paint_ends_is_a_part_of_the_whole_one(scene: Scene) -> None:
    texture = scene.strips.strips.extents
    extents = np.frombuffer(texture.read(), np.float32).reshape(texture.height, texture.width, 4)
    for number, ring in enumerate(scene.representation.quality.strip_rings):
        drawn = strips_drawn(scene, number)
        whole, part = drawn.clip, strips_drawn(scene, number, whole=False).clip
        layer = drawn.layer.astype(int)
        top = extents[layer, np.arange(len(layer)) % ring.columns, 2]
        below = np.arange(ring.sections) <= ring.sections * top[:, None]
        foot, run = whole[:, :-2:2, None], (whole[:, 1:-2:2] - whole[:, :-2:2])[:, :, None]
        edges = np.stack([part[:, :-2:2], part[:, 1:-2:2]], axis=2)
        across = ((edges - foot) * run).sum(axis=3) / (run * run).sum(axis=3)
        np.testing.assert_allclose(edges[below], (foot + across[..., None] * run)[below], atol=1e-3)
        assert below.mean() > 0.5
        assert (across[below] > -1e-4).all()
        assert (across[below] < 1.0 + 1e-4).all()
        assert (across[..., 1] - across[..., 0])[below].min() < 0.95


def test_x3_in_between_it_is_on_the_straight_way(scene: Scene) -> None:
    start, middle, end = (drawn(scene, weight) for weight in (0.0, 0.5, 1.0))
    apart = np.linalg.norm(middle - (start + end) / 2, axis=2)
    assert np.quantile(apart, 0.95) < 1.0


def test_x3_blades_come_to_their_places_before_their_strips_show(scene: Scene) -> None:
    appears, rows = scene.appears, scene.morphing.rows
    assert (appears.handed[rows] <= appears.morph[rows]).all()
