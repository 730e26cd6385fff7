"""A game's own ground as a texture: between plants, under the carpet, and where nothing grows (T1)."""

from collections.abc import Callable, Iterator
from ctypes import c_uint
from typing import Any

import moderngl
import numpy as np
import pytest

from tallgrass.engine.camera import Camera
from tallgrass.systems.prairie import Prairie
from tallgrass.testing import LITTLE

Stage = Any
Load = Callable[..., Prairie]
Aim = Callable[..., Camera]

STILL = LITTLE.replace("rolling", "flat") + "light: { elevation: 60 }\n"


@pytest.fixture
def texture(ctx: moderngl.Context) -> Iterator[Callable[..., moderngl.Texture]]:
    made: list[moderngl.Texture] = []

    def of(*texels: tuple[int, int, int], size: tuple[int, int] = (1, 1)) -> moderngl.Texture:
        made.append(ctx.texture(size, 3, bytes(np.array(texels, np.uint8)), alignment=1))
        made[-1].filter = (moderngl.NEAREST, moderngl.NEAREST)
        return made[-1]

    yield of
    for each in made:
        if not isinstance(each.mglo, moderngl.InvalidObject):
            each.release()


def hue(picture: Any) -> Any:
    """Return the difference of red and blue of pixels."""
    return picture[..., 0] - picture[..., 2]


def test_a_texture_lies_over_the_terrain_with_its_first_row_at_the_far_edge(
    stage: Stage, load: Load, camera: Aim, texture: Callable[..., moderngl.Texture]
) -> None:
    prairie, aim = load(STILL), camera(0.0, 45.0, 0.0, pitch=-90, view=60)
    before = stage.shot(prairie, aim)
    red, green, blue, white = (200, 10, 10), (10, 200, 10), (10, 10, 200), (200, 200, 200)
    prairie.ground_texture(texture(red, green, blue, white, size=(2, 2)))
    bare = stage.shot(prairie, aim)
    assert hue(bare)[25, 60] > 60.0 > hue(before)[25, 60]
    assert hue(bare)[65, 60] < -60.0
    assert (bare[25, 100, 1] - bare[25, 100, 0]) > 60.0
    prairie.ground_texture(None)
    np.testing.assert_array_equal(stage.shot(prairie, aim), before)


@pytest.mark.parametrize("lod", ["carpet", "strips", "blades"])
def test_a_texture_is_seen_between_plants_of_every_representation(
    stage: Stage, load: Load, camera: Aim, texture: Callable[..., moderngl.Texture], lod: str
) -> None:
    prairie, aim = load(STILL, lod=lod), camera(0.0, 3.0, 20.0, pitch=-25)
    pictures = []
    for color in ((160, 10, 10), (10, 10, 160)):
        prairie.ground_texture(texture(color), side=2.0)
        pictures.append(stage.shot(prairie, aim)[30:])
    parted = hue(pictures[0]) - hue(pictures[1])
    assert parted.mean() > 25.0
    assert (parted > -3.0).all()


def test_a_texture_comes_again_every_so_many_metres(
    stage: Stage, load: Load, camera: Aim, texture: Callable[..., moderngl.Texture]
) -> None:
    prairie = load(STILL)
    aim = camera(0.0, 12.0, 0.0, pitch=-90, view=40)
    striped = texture((160, 10, 10), (10, 10, 160), size=(2, 1))
    changes = {}
    for side in (2.0, 8.0):
        prairie.ground_texture(striped, side=side)
        along = hue(stage.shot(prairie, aim))[30:60].mean(axis=0) > 0.0
        changes[side] = np.count_nonzero(np.diff(along))
    assert changes[2.0] > 3 * changes[8.0] >= 3


def test_a_released_texture_is_named_once_and_the_scenes_own_ground_is_drawn(
    stage: Stage, load: Load, camera: Aim, texture: Callable[..., moderngl.Texture], caplog: pytest.LogCaptureFixture
) -> None:
    prairie, aim = load(STILL), camera(0.0, 3.0, 20.0, pitch=-25)
    before, given = stage.shot(prairie, aim), texture((200, 10, 10))
    prairie.ground_texture(given)
    assert (stage.shot(prairie, aim) != before).any()
    given.release()
    for _ in range(2):
        np.testing.assert_array_equal(stage.shot(prairie, aim), before)
    assert [line.split(" of ")[1] for line in caplog.messages] == [
        "a game's ground has been released: the scene's own ground is drawn"
    ]


@pytest.mark.parametrize(
    ("texture", "side", "error"),
    [
        ("grass.png", None, TypeError),
        (0, None, TypeError),
        (True, None, TypeError),
        (3, 0.0, ValueError),
        (3, "2", ValueError),
    ],
)
def test_what_is_no_texture_is_refused_in_a_sentence(load: Load, texture: Any, side: Any, error: Any) -> None:
    with pytest.raises(error, match=r"^(the side of )?a ground's texture "):
        load(STILL).ground_texture(texture, side=side)


def test_a_number_may_be_as_pyglets_functions_give_it(load: Load) -> None:
    prairie = load(STILL)
    prairie.ground_texture(c_uint(3))
    prairie.ground_texture(None)
