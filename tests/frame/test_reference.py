"""The reference: every blade in 3D (N3)."""

from collections.abc import Callable
from typing import Any

import moderngl
import numpy as np
import pytest

from tallgrass.engine.camera import Camera, View, view_of
from tallgrass.systems import reference as module
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.reference import (
    EveryBlade,
    box_filtered,
    cells_in_picture,
    cells_within,
    draw_truth,
    near_picture,
    patch_distances,
    stand_all,
    terrain_cells,
)
from tallgrass.systems.show.blades.pool import BladesKept

Stage = Any
Load = Callable[..., Prairie]
Aim = Callable[..., Camera]
Pictures = dict[str, Any]


@pytest.fixture(scope="module")
def aim(camera: Aim) -> Camera:
    return camera(0.3, 4.1, 12.0, pitch=-30)


@pytest.fixture(scope="module")
def prairie(stage: Stage, load: Load, aim: Camera) -> Prairie:
    """Prairie that has been drawn."""
    made = load()
    stage.shot(made, aim)
    return made


def reference(stage: Stage, prairie: Prairie, aim: Camera, samples: int = 3) -> Any:
    stage.target.use()
    view, projection = stage.matrices(aim)
    return draw_truth(prairie, view, projection, stage.size, samples=samples).picture.astype(float)


def distances(stage: Stage, prairie: Prairie, aim: Camera) -> Any:
    view, projection = stage.matrices(aim)
    return patch_distances(prairie, view, projection, stage.size)


def test_n3_the_reference_of_an_instant_is_always_the_same(stage: Stage, prairie: Prairie, aim: Camera) -> None:
    first = reference(stage, prairie, aim)
    assert first.shape == (90, 160, 3)
    np.testing.assert_array_equal(reference(stage, prairie, aim), first)
    stage.shot(prairie, aim)
    np.testing.assert_array_equal(reference(stage, prairie, aim), first)


def test_n3_what_is_drawn_is_nearer_to_the_truth_than_other_grass_of_the_same_look(
    stage: Stage, load: Load, camera: Aim
) -> None:
    prairie = load()
    for x, z, pitch, yaw in ((0.3, 12.0, -14, 0), (-3.0, -2.0, -25, 110), (6.0, 1.0, -8, 250)):
        aim = camera(x, float(prairie.height_at([[x, z]])[0]) + 1.9, z, pitch=pitch, yaw=yaw)
        drawn = stage.shot(prairie, aim)
        truth = reference(stage, prairie, aim)
        other = prairie.reseeded(1234)
        stage.shot(other, aim)
        unrelated = reference(stage, other, aim)
        other.release()
        assert np.abs(drawn - truth).mean() < 0.8 * np.abs(unrelated - truth).mean()
        np.testing.assert_allclose(drawn.mean(axis=(0, 1)), truth.mean(axis=(0, 1)), rtol=0.05)


def test_n3_every_blade_on_the_terrain_is_drawn_once(prairie: Prairie) -> None:
    assert prairie.painter is not None
    every = EveryBlade(prairie)
    cells = terrain_cells(prairie.site.ground)
    assert len(cells) == 24 * 24
    count = stand_all(prairie, cells, every.blades)
    assert count == pytest.approx(prairie.statistics.blades_field, rel=0.02)
    assert stand_all(prairie, cells[:5], every.blades) < 5 * 121
    every.release()


def test_n3_the_blades_of_the_reference_stand_and_bend_as_the_near_ones_are_drawn(
    prairie: Prairie, on_card: Callable[[Prairie], Any]
) -> None:
    (near, told), every = on_card(prairie)[0], EveryBlade(prairie)
    pool = prairie.viewers["main"].keeps(BladesKept).pool
    assert near.pool is pool
    assert len(near.slots) > 6
    for slot, texels in zip(near.slots[:6], told, strict=False):
        count = stand_all(prairie, pool.stamp[slot, None], every.blades)
        grows = pool.present[slot]
        assert count == grows.sum() > 0
        reference = every.blades.blades, every.blades.messages
        blades, messages = (np.frombuffer(each.buffer.read(), each.record)[:count] for each in reference)
        np.testing.assert_array_equal(blades["root_at"][:, ::2], pool.places(np.array([slot]))[0][grows])
        np.testing.assert_allclose(blades["root_at"][:, 1], texels[grows, 2], atol=1e-4)
        np.testing.assert_allclose(messages["message"], texels[grows, :2], atol=1e-3)
    every.release()


def test_t2_the_reference_leaves_out_only_what_is_not_seen(
    stage: Stage, prairie: Prairie, aim: Camera, monkeypatch: pytest.MonkeyPatch
) -> None:
    kept = []

    def counting(blades: Any, seen: View) -> Any:
        kept.append(near_picture(blades, seen))
        return kept[-1]

    monkeypatch.setattr(module, "near_picture", counting)
    every, seen = EveryBlade(prairie), view_of(*stage.matrices(aim))
    pictures, site = [], prairie.site
    viewer = prairie.viewers["main"].viewer
    cone = cells_within(site.ground, viewer.eye, viewer.cone, sway=site.sway)
    held = cells_in_picture(prairie, cone, seen)
    for cells in (held, terrain_cells(site.ground)):
        stage.target.use()
        stage.target.clear(depth=1.0)
        every.draw(seen, cells)
        pictures.append(stage.read())
        monkeypatch.setattr(module, "near_picture", lambda blades, _: np.ones(len(blades), np.bool_))
    every.release()
    assert 0.1 < np.concatenate(kept).mean() < 0.9
    np.testing.assert_array_equal(pictures[0], pictures[1])
    assert len(held) < len(cone) < 0.6 * 24 * 24


def test_a_reference_of_what_was_never_drawn_is_refused(load: Load) -> None:
    fresh = load()
    with pytest.raises(RuntimeError, match="draw the prairie once"):
        EveryBlade(fresh)
    with pytest.raises(RuntimeError, match="draw the prairie once"):
        patch_distances(fresh, np.eye(4), np.eye(4), (8, 8))


def test_t3_each_pixel_knows_the_discrete_distance_of_what_it_shows(stage: Stage, load: Load, camera: Aim) -> None:
    flat = load("plain", preset="low")
    aim = camera(0.9, 3.0, 0.4, pitch=-35, yaw=20)
    stage.shot(flat, aim)
    told = distances(stage, flat, aim)
    at = stage.ground(aim, level=0.25)
    inside = (np.abs(at) < 49.0).all(axis=-1)
    expected = np.abs(np.floor(at / 2.5)).max(axis=-1)
    assert inside.mean() > 0.9
    off = np.abs(told - expected)[inside]
    assert (off <= 1).mean() > 0.99
    assert (off == 0).mean() > 0.8
    level = camera(0.9, 3.0, 0.4, pitch=10)
    stage.shot(flat, level)
    sky = distances(stage, flat, level)
    assert (sky[:40] == -1).all()
    assert stage.ctx.detect_framebuffer().glo == stage.target.glo


def test_supersampling_is_the_mean_of_each_pixels_samples(ctx: moderngl.Context) -> None:
    fine = np.random.default_rng(0).integers(0, 256, (12, 20, 3), dtype=np.uint8)
    texture = ctx.texture((20, 12), 3, fine.tobytes(), alignment=1)
    target = ctx.framebuffer([texture])
    told = box_filtered(target, (5, 3), 4)
    expected = fine.reshape(3, 4, 5, 4, 3).mean(axis=(1, 3))[::-1]
    np.testing.assert_allclose(told.picture, expected, atol=0.51)
    white = np.indices((4, 4)).sum(axis=0)[None, :, None, :, None] % 2 == 0
    halves = [np.where(half, fine.reshape(3, 4, 5, 4, 3), 0).sum(axis=(1, 3))[::-1] / 8.0 for half in (white, ~white)]
    np.testing.assert_allclose(told.doubt, 0.5 * (halves[0] - halves[1]), atol=1e-4)
    target.release()
    texture.release()


@pytest.mark.parametrize("yaw", [20, 110, 200, 290])
def test_t5_blades_around_the_viewer_hide_one_another_as_in_the_reference(
    stage: Stage, load: Load, camera: Aim, yaw: float
) -> None:
    dense = load("""\
tallgrass: 2
terrain: { noise: flat, size: [20, 20] }
grass:
  broad: { height: [0.5, 0.9], width: 0.05, taper: 1.0, clumping: 0.0, root: "#102040", tip: "#ffe080", variety: 0.6 }
quality:
  blades: 300
  models: 1
  blade_rings: [{ to: 2, segments: 4 }]
  strip_rings: [{ to: 3, strips: 2, texel: 0.03 }]
  carpet_to: 4
  carpet: 16
""")
    aim = camera(1.2, 1.3, 1.1, yaw=yaw, pitch=-35)
    error = np.abs(stage.shot(dense, aim) - reference(stage, dense, aim)).mean()
    assert error < 7.0


def test_n3_within_a_reach_that_holds_everything_the_reference_is_whole(
    stage: Stage, prairie: Prairie, aim: Camera
) -> None:
    stage.shot(prairie, aim)
    view, projection = stage.matrices(aim)

    def within(reach: int) -> Any:
        return draw_truth(prairie, view, projection, stage.size, samples=2, reach=reach).picture.astype(float)

    whole = reference(stage, prairie, aim, samples=2)
    # Ground that a carpet may lie on is lit at the corners of its mesh.
    np.testing.assert_allclose(within(99), whole, atol=2.0)
    near = within(3)
    far = distances(stage, prairie, aim)
    apart = np.abs(near - whole).max(axis=2)
    assert apart[far > 4].max() > 20.0
    assert (apart[(far >= 0) & (far <= 2)] > 20.0).mean() < 0.02
