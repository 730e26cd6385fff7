"""Blades that morph to their painted places, as computed by the graphics card (X3, X4)."""

from copy import copy
from dataclasses import replace
from typing import Any

import numpy as np

from tallgrass.components.arrays import Doubles
from tallgrass.engine.gl.stream import Stream, release_all
from tallgrass.systems.around.outlook import Outlook
from tallgrass.systems.features import UNITS
from tallgrass.systems.frame.block import room_for
from tallgrass.systems.land.part import LandPart
from tallgrass.systems.show.blades.draw import PAINTED, USUAL, Ribbons
from tallgrass.systems.show.blades.gather import distances, gather_blades
from tallgrass.systems.show.blades.morph import HOME, at_home, gather_morph
from tallgrass.systems.show.blades.pool import BladesKept
from tallgrass.systems.transition import weights

Defines = dict[str, str | int]

SIZE = (1280, 720)
"""Size of the picture in which blades morph [pixels]."""
RIBBON = "systems/show/blades/ribbon.vert"


def on_screen(clip: Doubles) -> Doubles:
    return np.asarray(clip[..., :2] / clip[..., 3:4] * np.array(SIZE) / 2)


def middles(data: Doubles) -> Doubles:
    """Return middle lines of ribbons, from root to tip [pixels], shape (n, points, 2)."""
    return on_screen(data[:, ::2, :4]) / 2 + on_screen(data[:, 1::2, :4]) / 2


def drawn(scene: Any, weight: float) -> Doubles:
    """Return middle lines of the morphing blades at a morph value."""
    ribbons = scene.blades.morph
    moving = np.frombuffer(ribbons.stream.buffer.read(), PAINTED)[: ribbons.stream.count].copy()
    moving["painted"][:, 3] = weight
    stream = Stream(scene.painter.ctx, PAINTED)
    stream.write(moving)
    scene.blades.store.targets.use(UNITS["targets"])
    size = 2 * ribbons.segments + 2, len(moving)
    data = scene.caught(ribbons.array(USUAL).program, RIBBON, stream, size)
    stream.release()
    return middles(data)


def as_drawn(scene: Any) -> tuple[Doubles, Doubles]:
    """Return middle lines of the morphing blades in the frame itself, and the morph of each, shape (n,)."""
    ribbons = scene.blades.morph
    moving = np.frombuffer(ribbons.stream.buffer.read(), PAINTED)[: ribbons.stream.count]
    scene.blades.store.targets.use(UNITS["targets"])
    data = scene.caught(ribbons.array(USUAL).program, RIBBON, ribbons.stream, (2 * ribbons.segments + 2, len(moving)))
    return middles(data), moving["painted"][:, 3].astype(np.float64)


def in_their_own_places(scene: Any) -> Doubles:
    """Return middle lines of the same blades as 3D blades, sent one by one."""
    painter, segments, count = scene.painter, scene.blades.morph.segments, len(scene.records)
    blades = painter.blade_painter(segments)
    ribbons = Ribbons(painter.ctx, painter.block, [segments], UNITS, soft=True)
    blades.write(scene.records, scene.message)
    painter.block.write(painter.record)
    for name, texture in painter.part(LandPart).textures.items():
        texture.use(UNITS[name])
    ribbons.fill(blades.array, count)
    defines: Defines = {"SUBLEVELS": room_for(1), "SOFT": 1}
    data = scene.caught(
        ribbons.array(USUAL).program, RIBBON, ribbons.stream, (2 * segments + 2, count), defines=defines
    )
    release_all(ribbons, blades)
    return middles(data)


def painted_places(scene: Any) -> Doubles:
    """Return the points of each blade on the strips as drawn, from root to tip [pixels]."""
    patches, drawn = scene.outlook.patches, scene.strips_drawn()
    stock, rings = scene.representation.stock, scene.representation.quality.strip_rings
    first, kinds = scene.first_pictures, len(stock.strips[0])
    segments, points = scene.blades.morph.segments, stock.targets.shape[3]
    expected = np.zeros((len(scene.records), segments + 1, 2))
    for index, (blade, row, which) in enumerate(zip(scene.records, scene.row, scene.own, strict=True)):
        model, own = int(patches.model[row]), (scene.along + int(patches.turn[row])) % 2
        number = int(patches.sublevel[1, row]) >> 1
        plane = int(stock.slices[number][model, own, which])
        picture = first[kinds * number + int(blade["kind"])] + (model * 2 + own) * rings[number].strips + plane
        here = np.flatnonzero((drawn.picture == picture) & (drawn.row == row))
        assert len(here) == rings[number].columns
        clip, target = drawn.clip[here, : 2 * rings[number].sections + 2], stock.targets[model, own, which]
        for step in range(segments + 1):
            at = step / segments * (points - 1)
            low = min(int(at), points - 2)
            u, v = target[low] + (target[low + 1] - target[low]) * (at - low)
            expected[index, step] = _on_strip(clip, float(u) * len(clip), float(v) * rings[number].sections)
    return expected


def _on_strip(clip: Doubles, across: float, up: float) -> Doubles:
    """Return the pixel of a texture coordinate of a strip, from its triangle strips (columns, vertices, 4)."""
    column = min(int(across), len(clip) - 1)
    section = min(int(up), clip.shape[1] // 2 - 2)
    u, v = across - column, up - section
    corners = clip[column, 2 * section : 2 * section + 4]
    if u + v <= 1.0:
        place = corners[0] + u * (corners[1] - corners[0]) + v * (corners[2] - corners[0])
    else:
        place = corners[3] + (1 - u) * (corners[2] - corners[3]) + (1 - v) * (corners[1] - corners[3])
    return on_screen(place)


def test_x3_the_blades_on_their_way_are_of_all_kinds_turns_and_slices(scene: Any) -> None:
    rows, patches = scene.morphing.rows, scene.outlook.patches
    assert len(rows) >= 4
    assert len(set(patches.turn[rows].tolist())) >= 3
    assert set(scene.records["kind"].tolist()) == {0.0, 1.0}
    assert (patches.sublevel[1, rows] & 1 == scene.along).all()
    assert np.abs(patches.slope[rows]).max() > 0.15
    assert np.linalg.norm(scene.message, axis=1).mean() > 0.15


def test_x3_in_the_frame_a_blade_has_moved_as_far_as_its_patch_has_come(scene: Any) -> None:
    live, told = as_drawn(scene)
    strips = weights(scene.outlook.patches)[1, scene.row]
    assert (np.abs(told - strips) < 0.2).all(), "neither at home still nor there already"
    assert 0.05 < told.min() <= told.max() < 0.95
    start, end = drawn(scene, 0.0), drawn(scene, 1.0)
    way = end - start
    far = (way**2).sum(axis=(1, 2)) > 4.0
    moved = ((live - start) * way).sum(axis=(1, 2))[far] / (way**2).sum(axis=(1, 2))[far]
    assert far.sum() > 50
    np.testing.assert_allclose(moved, told[far], atol=0.05)


def test_x3_before_it_sets_off_a_blade_is_in_its_own_place(scene: Any) -> None:
    apart = np.linalg.norm(drawn(scene, 0.0) - in_their_own_places(scene), axis=2)
    assert apart.max() < 0.05


def test_x3_when_it_has_arrived_a_blade_lies_on_its_painted_place(scene: Any) -> None:
    arrived, painted = drawn(scene, 1.0), painted_places(scene)
    assert np.linalg.norm(arrived - painted, axis=2).max() < 0.5
    assert np.linalg.norm(arrived - in_their_own_places(scene), axis=2).mean() > 1.0


def test_x3_in_between_it_is_on_the_straight_way(scene: Any) -> None:
    start, middle, end = (drawn(scene, weight) for weight in (0.0, 0.5, 1.0))
    apart = np.linalg.norm(middle - (start + end) / 2, axis=2)
    assert np.quantile(apart, 0.95) < 1.0


def moved(outlook: Outlook, part: float) -> Outlook:
    """Return the outlook whose blades have all come this part of the way to their painted places."""
    made = copy(outlook)
    made.appearance = replace(outlook.appearance, morph=np.full_like(outlook.appearance.morph, part))
    return made


def test_x3_blades_that_arrive_in_their_own_places_are_in_the_order_of_those_that_stand(scene: Any) -> None:
    outlook, shown = scene.outlook, scene.morphing
    pool, left = outlook.keeps(BladesKept).pool, np.ones(len(shown.rows), np.float32)
    eye = outlook.viewer.eye[0], outlook.viewer.eye[2]
    away, nowhere = distances(pool, shown.slots, eye), np.zeros((len(left), pool.present.shape[1]), np.bool_)
    numbers = gather_morph(moved(outlook, 0.0), pool, scene.representation, shown, away=away, left=left, home=nowhere)
    np.testing.assert_array_equal(numbers, gather_blades(pool, shown, eye=eye))
    assert len(numbers) >= 120


def test_x3_blades_that_come_home_take_their_turn_one_by_one_from_the_nearest_on(scene: Any) -> None:
    outlook, shown = scene.outlook, scene.morphing
    pool, left = outlook.keeps(BladesKept).pool, np.ones(len(shown.rows), np.float32)
    eye, each = (outlook.viewer.eye[0], outlook.viewer.eye[2]), pool.present.shape[1]
    away = distances(pool, shown.slots, eye)
    stood = []
    for part in np.linspace(1.2 * HOME, 0.0, 7, dtype=np.float32):
        coming = moved(outlook, part)
        home = at_home(coming, shown, away)
        going = gather_morph(coming, pool, scene.representation, shown, away=away, left=left, home=home)
        standing = gather_blades(pool, shown, eye=eye, stand=home)
        numbers = (shown.places[:, None] * each + np.arange(each))[pool.present[shown.slots]]
        np.testing.assert_array_equal(np.sort(np.concatenate([going, standing])), np.sort(numbers))
        assert away[home].max(initial=0.0) <= away[~home].min(initial=np.inf)
        stood.append(home.mean())
    assert (stood[0], stood[-1]) == (0.0, 1.0)
    assert np.diff(stood).max() < 0.5


def test_x3_blades_come_to_their_places_before_their_strips_show(scene: Any) -> None:
    appears, rows = scene.appears, scene.morphing.rows
    assert (appears.handed[rows] <= appears.morph[rows]).all()
