"""Rushes and folded blades in whole frames: the effect of profiles, in all representations."""

from collections.abc import Callable

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass.engine.camera import Camera, view_of
from tallgrass.engine.gl.stream import release_all
from tallgrass.systems.frame.block import FrameBlock
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.reference import draw_truth
from tallgrass.systems.show.blades.draw import USUAL, Ribbons, own_segment_defines
from tallgrass.systems.show.blades.painter import BladesPainter
from tallgrass.systems.show.blades.pool import BLADE
from tallgrass.testing import Stage

Load = Callable[..., Prairie]

SCENE = """\
tallgrass: 2
terrain: {{ size: [60, 60], noise: flat }}
grass: {{ sward: {{ profile: {profile}, height: [0.4, 0.6], width: 0.03, blades: 260, variety: 0 }} }}
light: {{ azimuth: 90, elevation: 25 }}
quality:
  models: 1
  blade_rings: [{{ to: 1, segments: 4 }}]
  strip_rings: [{{ to: 5, strips: 4, texel: 0.01 }}]
  carpet_to: 16
  carpet: 64
"""
NEAR = """\
tallgrass: 2
seed: 3
terrain: {{ noise: flat, size: [20, 20] }}
grass: {{ reed: {{ profile: {profile}, height: [0.5, 0.6], width: 0.05, blades: 700, lean: 0.1 }} }}
light: {{ elevation: 50 }}
quality:
  models: 2
  blade_rings: [{{ to: 2, segments: 3 }}]
  strip_rings: [{{ to: 4, strips: 4, texel: 0.012 }}]
  carpet_to: 6
  carpet: 64
"""
CAMERA = Camera((0.0, 0.12, 8.0), 0.0, 0.0, np.radians(11.0))
FACES = np.radians([0.0, 30.0, 60.0, 80.0])


@pytest.fixture(scope="module")
def room(ctx: moderngl.Context) -> Stage:
    return Stage(ctx, (400, 120))


def standing(room: Stage, prairie: Prairie) -> NDArray[np.float64]:
    """Return a picture of four wide blades of 0.5 m side by side, which face `FACES`, on bare ground."""
    room.shot(prairie, CAMERA)
    assert prairie.painter is not None
    painter = prairie.painter.blade_painter(8)
    blades = np.zeros(len(FACES), BLADE)
    blades["root"][:, 0] = np.linspace(-1.2, 1.2, len(FACES))
    blades["height"], blades["width"] = 0.5, 0.2
    blades["facing"] = np.stack([np.cos(FACES), np.sin(FACES)], axis=1)
    pictures = []
    for some in (blades[:0], blades):
        painter.write(some, np.zeros((len(some), 2), np.float32))
        room.begin()
        prairie.painter.draw(view_of(*room.matrices(CAMERA)), blades=[painter])
        pictures.append(room.read())
    painter.release()
    bare, grown = pictures
    return np.where((np.abs(grown - bare).max(axis=2) > 2.0)[..., None], grown, np.nan)


def columns(picture: NDArray[np.float64]) -> list[NDArray[np.float64]]:
    """Return the brightness of each blade across a row of pixels half-way up, before the sky."""
    row = picture[48].mean(axis=1)
    edges = np.flatnonzero(np.diff(np.concatenate([[0], ~np.isnan(row), [0]]).astype(int)))
    return [row[low:high] for low, high in edges.reshape(-1, 2)]


def test_a_rush_is_as_wide_whichever_way_it_faces_and_brighter_to_the_sun(room: Stage, load: Load) -> None:
    stems = columns(standing(room, load(SCENE.format(profile="rush"))))
    widths = [len(stem) for stem in stems]
    assert len(stems) == len(FACES)
    assert max(widths) - min(widths) <= 2
    for stem in stems:
        assert stem[-3] > 1.1 * stem[2]  # the sun stands to the right


def test_a_blade_is_narrow_seen_edge_on(room: Stage, load: Load) -> None:
    widths = [len(blade) for blade in columns(standing(room, load(SCENE.format(profile="blade"))))]
    assert widths[0] < 0.5 * widths[-1]


@pytest.mark.parametrize("profile", ["rush", "fold"])
def test_n12_all_representations_show_as_much_of_it(room: Stage, load: Load, profile: str) -> None:
    seen = Camera((0.0, 1.7, 10.0), 0.0, -0.12, np.radians(40.0))
    lods = ("blades", "strips", "carpet")
    means = [room.shot(load(SCENE.format(profile=profile), lod=lod), seen)[60:].mean() for lod in lods]
    np.testing.assert_allclose(means[1:], means[0], rtol=0.05)


def test_the_two_faces_of_a_fold_are_lit_apart_with_an_edge_between_them(room: Stage, load: Load) -> None:
    seen = Camera((0.0, 0.45, 8.0), 0.0, -0.2, np.radians(12.0))
    steps = []
    for profile in ("blade", "fold"):
        picture = room.shot(load(SCENE.format(profile=profile)), seen).mean(axis=2)[60:]
        steps.append(np.abs(np.diff(picture, axis=1)).mean())
    assert steps[1] > 1.1 * steps[0]


@pytest.mark.parametrize("profile", ["rush", pytest.param("fold", marks=pytest.mark.slow)])
def test_blades_just_before_the_eye_hide_and_shine_as_those_of_the_reference(
    ctx: moderngl.Context, load: Load, profile: str
) -> None:
    """Some reach behind the eye: they are as opaque and as soft as others, and lit on the side towards the sun."""
    size, apart, unlike = (96, 54), [], 0
    prairie, room = load(NEAR.format(profile=profile)), Stage(ctx, size)
    for x, z, yaw in ((-0.9, 0.1, 0.0), (-0.76, 0.13, 1.0), (-0.21, 0.25, 5.0)):
        camera = Camera((x, 0.3, z), yaw, np.radians(20.0), np.radians(60.0))
        seen = room.shot(prairie, camera).astype(np.float64)
        truth = draw_truth(prairie, *room.matrices(camera), size, samples=2).picture.astype(np.float64)
        unlike += int((np.abs((seen - truth) @ (0.0, -1.0, 1.0)) > 70.0).sum())  # sky in place of leaf, or leaf of sky
        apart.append(np.abs(seen - truth).mean())
    room.release()
    assert unlike < 100
    assert np.mean(apart) < 8.0


def test_g5_blades_of_a_farther_ring_have_as_many_segments_as_it_says(stage: Stage, load: Load) -> None:
    def shown(segments: int) -> NDArray[np.float64]:
        rings = f"to: 1, segments: 4 }}, {{ to: 4, segments: {segments}"
        text = SCENE.format(profile="blade, lean: 0.4").replace("to: 1, segments: 4", rings)
        return stage.shot(load(text + "wind: [{ kind: breeze, strength: 0.9 }]\n", lod="blades"), camera)

    camera = Camera((0.0, 1.0, 8.0), 0.0, -0.2, np.radians(40.0))
    apart = np.abs(shown(1) - shown(4)).mean(axis=(1, 2))
    assert apart.max() > 2.0
    assert not apart[-len(apart) // 4 :].any()  # nearer ones have as many as before


@pytest.mark.parametrize(
    ("rings", "own", "slide"), [((3,), 5, False), ((3, 3), 0, False), ((6, 4), 0, True), ((3, 3), 5, True)]
)
def test_g5_joints_slide_only_between_rings_whose_blades_have_other_segments(
    ctx: moderngl.Context, rings: tuple[int, ...], own: int, *, slide: bool
) -> None:
    block = FrameBlock(ctx)
    block.defines.update(own_segment_defines([own or None]))
    ribbons = Ribbons(ctx, block, rings, {}, soft=True, parted=True)
    assert [("#define SLIDES" in each.vertex) for each in ribbons.texts()] == [slide, slide]
    release_all(ribbons, block)


def test_sources_of_programs_are_told_until_they_are_made(ctx: moderngl.Context) -> None:
    block = FrameBlock(ctx)
    ribbons = Ribbons(ctx, block, [3], {}, soft=True)
    assert len([*ribbons.texts()]) == 2
    ribbons.array(USUAL)
    assert len([*ribbons.texts()]) == len([*ribbons.making()]) == 1
    assert [*ribbons.texts()] == [*ribbons.making()] == []
    release_all(ribbons, block)


@pytest.mark.slow
def test_g1_a_kind_may_have_segments_of_its_own_and_then_all_its_blades_are_drawn_with_them(
    stage: Stage, load: Load
) -> None:
    def shown(how: str) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        text = SCENE.format(profile=f"blade, {how}lean: 0.4").replace("to: 1, segments: 4", "to: 4, segments: 4")
        prairie = load(text + "wind: [{ kind: breeze, strength: 0.9 }]\n")
        camera = Camera((0.0, 1.0, 8.0), 0.0, -0.2, np.radians(40.0))
        picture = stage.shot(prairie, camera)
        return picture, draw_truth(prairie, *stage.matrices(camera), stage.size).picture.astype(np.float64)

    usual, same, straight = (shown(how) for how in ("", "segments: 4, ", "segments: 1, "))
    for before, again, other in zip(usual, same, straight, strict=True):
        np.testing.assert_array_equal(again, before)
        assert np.abs(other - before).mean() > 2.0


def test_g1_segments_of_a_kind_are_told_to_shaders_only_where_one_has_any() -> None:
    assert own_segment_defines([None, None]) == {}
    assert own_segment_defines([None, 12]) == {"OWN_SEGMENTS": "int[](0, 12)", "MOST_OWN_SEGMENTS": 12}


@pytest.mark.parametrize(("own", "most"), [(12, 12), (2, 4)])
def test_g1_a_scene_that_is_read_again_with_other_segments_has_ribbons_of_as_many(
    stage: Stage, load: Load, own: int, most: int
) -> None:
    prairie = load(SCENE.format(profile="blade"))
    stage.shot(prairie, CAMERA)
    prairie.loaded.file.write_text(SCENE.format(profile=f"blade, segments: {own}"), encoding="utf-8")
    prairie.reload()
    stage.shot(prairie, CAMERA)
    assert prairie.painter is not None
    blades = prairie.painter.painters["blades"]
    assert isinstance(blades, BladesPainter)
    assert blades.groups[0].segments == most
