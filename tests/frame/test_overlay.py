"""The overlay in the picture (N8)."""

from collections.abc import Callable, Iterator
from typing import Any

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass.engine.camera import Camera
from tallgrass.systems.overlay.layers import LAYERS, Layer
from tallgrass.systems.overlay.overlay import Overlay
from tallgrass.systems.prairie import Prairie

Stage = Any
Load = Callable[..., Prairie]
Aim = Callable[..., Camera]
Picture = NDArray[np.float64]
Show = Callable[..., Picture]

STORMY = """\
tallgrass: 2
seed: 5
terrain: { noise: flat, size: [100, 100] }
grass:
  tall: { height: [0.3, 0.5], width: 0.02 }
wind:
  - { kind: breeze, strength: 0.4 }
  - { kind: whirlwind, position: [0, 0], radius: 4 }
quality:
  blades: 60
  models: 1
  blade_rings: [{ to: 2, segments: 2 }]
  strip_rings: [{ to: 7, strips: 6, columns: 1, sections: 1, texel: 0.03 }]
  carpet_to: 12
  carpet: 16
"""


@pytest.fixture(scope="module")
def prairie(load: Load) -> Prairie:
    """Prairie on flat ground with a breeze and a whirlwind."""
    made = load(STORMY)
    made.advance(1.0)
    return made


@pytest.fixture
def show(prairie: Prairie, stage: Stage) -> Iterator[Show]:
    """Return the function that draws the prairie and layers of the overlay: `show(camera, *parts)`."""
    overlay = Overlay()

    def drawn(aim: Camera, *parts: Layer) -> Picture:
        stage.shot(prairie, aim)
        overlay.layers = frozenset(parts)
        overlay.draw(prairie, *stage.matrices(aim))
        return np.asarray(stage.read())

    yield drawn
    overlay.release()


def apart(one: Picture, other: Picture) -> NDArray[np.bool_]:
    return np.asarray(np.abs(one - other).max(axis=-1) > 12.0)


@pytest.fixture
def above(camera: Aim) -> Camera:
    """A look straight down from 12 m, 10 m of ground from top to bottom."""
    return camera(0.0, 12.0, 0.0, pitch=-90)


def test_n8_without_an_overlay_the_picture_is_the_same_bit_for_bit(
    show: Show, stage: Stage, prairie: Prairie, camera: Aim
) -> None:
    aim = camera(0.0, 2.0, 14.0, pitch=-15)
    plain = stage.shot(prairie, aim)
    np.testing.assert_array_equal(show(aim), plain)
    assert apart(show(aim, *LAYERS), plain).mean() > 0.3
    np.testing.assert_array_equal(stage.shot(prairie, aim), plain, "and nothing stays of it")


def test_n8_the_whirlwinds_outline_is_seen_where_it_ends(show: Show, stage: Stage, above: Camera) -> None:
    ring = apart(show(above, "masks"), show(above))
    away = np.hypot(*np.moveaxis(stage.ground(above), -1, 0))
    assert ring[np.abs(away - 4.0) < 0.12].mean() > 0.9
    assert not ring[away > 4.6].any(), "where it does not act nothing is shown"


def test_n8_arrows_turn_with_the_whirlwind(show: Show, prairie: Prairie, above: Camera) -> None:
    assert apart(show(above, "arrows"), show(above)).mean() > 0.05
    places = np.array([[2.0, 0.0], [0.0, 2.0], [-2.0, 0.0], [0.0, -2.0]])
    felt = prairie.wind_at(places)
    turns = places[:, 0] * felt[:, 1] - places[:, 1] * felt[:, 0]
    assert (np.sign(turns) == np.sign(turns[0])).all()


def test_n8_levels_are_seen_on_their_patches(show: Show, stage: Stage, camera: Aim) -> None:
    aim = camera(0.0, 3.0, 14.0, pitch=-12)
    plain, shown = show(aim), show(aim, "levels")
    spots = stage.project(aim, np.array([[-1.2, 0.0, 8.6], [-3.7, 0.0, -2.0]])).astype(int)
    near, far = (shown[y - 1 : y + 2, x - 1 : x + 2].mean((0, 1)) for x, y in spots)
    before = [plain[y - 1 : y + 2, x - 1 : x + 2].mean((0, 1)) for x, y in spots]
    assert (near - before[0])[0] > 30.0 > (near - before[0])[2]
    assert (far - before[1])[2] > 30.0 > (far - before[1])[0]
    sky = np.s_[:10, :70]
    np.testing.assert_array_equal(shown[sky], plain[sky])


def test_n8_weights_are_seen_where_strips_give_way_to_the_carpet(show: Show, stage: Stage, camera: Aim) -> None:
    aim = camera(0.0, 3.0, 14.0, pitch=-12)
    seen = apart(show(aim, "weights"), show(aim))
    z = stage.ground(aim)[..., 1]
    assert seen[(z > -3.0) & (z < 0.0)].mean() > 0.5
    assert not seen[z > 6.0].any()


def test_n8_the_map_lies_in_its_corner(show: Show, stage: Stage, camera: Aim) -> None:
    aim = camera(0.0, 3.0, 14.0, pitch=-12)
    seen = apart(show(aim, "map"), show(aim))
    width, height = stage.size
    side = round(0.42 * height)
    assert seen[8 : side + 4, width - side - 4 : width - 8].mean() > 0.95
    assert not seen[:, : width - side - 10].any()
    assert not seen[side + 10 :].any()


def test_n8_marks_are_seen_through_the_grass(show: Show, camera: Aim) -> None:
    aim = camera(0.0, 0.25, 6.0)
    assert apart(show(aim, "masks"), show(aim)).sum() > 60


def test_n8_an_overlay_needs_a_frame(load: Load, stage: Stage, camera: Aim) -> None:
    fresh, aim = load(STORMY), camera(0.0, 3.0, 14.0)
    with pytest.raises(RuntimeError, match="draw the prairie first"):
        Overlay(("map",)).draw(fresh, *stage.matrices(aim))


def test_d6_an_overlay_leaves_gl_as_it_was(show: Show, ctx: moderngl.Context, stage: Stage, camera: Aim) -> None:
    aim = camera(0.0, 3.0, 14.0, pitch=-12)
    plain = show(aim)
    depth = stage.depth().copy()
    show(aim, *LAYERS)
    np.testing.assert_array_equal(stage.depth(), depth)
    assert ctx.detect_framebuffer().glo == stage.target.glo
    assert stage.target.depth_mask
    assert ctx.error == "GL_NO_ERROR"
    np.testing.assert_array_equal(show(aim), plain)


def test_n8_two_parts_together_show_both(show: Show, camera: Aim) -> None:
    aim = camera(0.0, 3.0, 14.0, pitch=-12)
    plain, arrows = show(aim), apart(show(aim, "arrows"), show(aim))
    both = show(aim, "levels", "arrows")
    assert apart(both, plain).sum() > 2 * arrows.sum()
    assert apart(both, show(aim, "levels")).sum() > 30


def test_n8_the_legend_lies_in_its_corner_where_there_is_room(
    prairie: Prairie, ctx: moderngl.Context, stage: Stage, camera: Aim
) -> None:
    aim, overlay = camera(0.0, 3.0, 14.0, pitch=60), Overlay(("arrows",))
    large = type(stage)(ctx, (320, 180))
    for one, legible in ((large, True), (stage, False)):
        plain = one.shot(prairie, aim)
        overlay.draw(prairie, *one.matrices(aim))
        seen = apart(one.read(), plain)
        assert seen[-40:, -170:].any() == legible
        assert not seen[:-40].any()
        assert not seen[:, :-170].any()
    overlay.release()
    large.release()
