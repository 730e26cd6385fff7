"""A game's queries on ground and grass: normals, picking, `grass_at`."""

from collections.abc import Callable, Iterator
from typing import Any

import esper
import numpy as np
import pytest
from yaml import safe_load

from tallgrass.components.footprint import Footprint
from tallgrass.components.patch import Patch
from tallgrass.components.pose import Pose
from tallgrass.components.presser import Presser
from tallgrass.engine.world import World
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.wind.breeze import Breeze
from tallgrass.testing import LITTLE, watch

QUALITY = safe_load(LITTLE)["quality"]
Load = Callable[..., Prairie]

FIELD = np.zeros((4, 4, 2), np.float32)
FIELD[:, 2:, 0], FIELD[:2, :2, 1] = 0.4, 1.0
"""Tall grass in the right half, thinly; rushes at the far left; nothing at the near left."""

TALL, RUSHES, NOTHING = (10.0, 0.0), (-10.0, -10.0), (-10.0, 10.0)

FROM_ABOVE = np.array([[1, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, -9], [0, 0, 0, 1.0]]), np.diag([0.1, 0.1, -0.01, 1.0])
"""Matrices of a viewer 9 m up who looks down."""


@pytest.fixture
def prairie(world: World) -> Iterator[Prairie]:
    del world
    scene: dict[str, Any] = {
        "tallgrass": 2,
        "terrain": {"heights": np.add.outer(np.arange(41.0), 0.0 * np.arange(41)), "cell": 1.0},
        "grass": {
            "tall": {"height": [0.8, 1.0], "lean": 0.0, "place": {"map": FIELD}},
            "rushes": {"height": [0.4, 0.5], "lean": 0.0, "place": {"map": FIELD, "channel": "green"}},
        },
        "quality": QUALITY,
    }
    made = Prairie.load(scene)
    yield made
    made.release()


def test_a_slope_of_45_degrees_has_a_normal_that_leans_as_much(prairie: Prairie) -> None:
    np.testing.assert_allclose(
        prairie.normal_at([(0.0, 0.0), (5.2, 3.1)]), [[0.0, 0.5**0.5, -(0.5**0.5)]] * 2, rtol=1e-6
    )


def test_a_ray_is_picked_as_a_row_and_many_from_one_eye(prairie: Prairie) -> None:
    down = prairie.pick((1.0, 90.0, 2.0), (0.0, -1.0, 0.0))
    np.testing.assert_allclose(down, [[1.0, 22.0, 2.0]])
    assert down.dtype == np.float32
    many = prairie.pick((1.0, 90.0, 2.0), [(0.0, -1.0, 0.0), (0.0, 1.0, 0.0)])
    np.testing.assert_allclose(many, [[1.0, 22.0, 2.0], [np.nan] * 3])
    assert prairie.pick(np.zeros((0, 3)), np.zeros((0, 3))).shape == (0, 3)


@pytest.mark.parametrize(
    ("origin", "direction", "why"),
    [
        ((1, 2), (0, 1, 0), r"not an array of shape \(2,\)$"),
        ((1, 2, 3), (0, 0, 0), "and a direction has a length above 0$"),
        ((1, 2, np.nan), (0, 1, 0), "not NaN or infinity$"),
        ([(1, 2, 3)] * 2, [(0, 1, 0)] * 3, "not 2 and 3 of them$"),
        ("eye", (0, 1, 0), "not 'eye'$"),
    ],
)
def test_what_is_no_ray_is_refused_in_a_sentence(prairie: Prairie, origin: Any, direction: Any, why: str) -> None:
    with pytest.raises(ValueError, match=r"^rays have an origin and a direction \(x, y, z\), one of each .*" + why):
        prairie.pick(origin, direction)


def test_grass_is_told_by_kind_density_and_height(prairie: Prairie) -> None:
    found = prairie.grass_at([TALL, RUSHES, NOTHING])
    assert found.kind.tolist() == [0, 1, -1]
    assert found.name == ("tall", "rushes", "")
    np.testing.assert_allclose(found.density, [[0.4, 0.0], [0.0, 1.0], [0.0, 0.0]])
    assert 0.8 < found.height[0] < 1.05
    assert 0.4 < found.height[1] < 0.55
    assert found.height[2] == 0.0
    assert found.cleared.tolist() == [False] * 3
    assert found.density.dtype == found.height.dtype == np.float32


def test_what_is_cut_stands_as_high_as_it_was_left_until_it_is_grown_again(prairie: Prairie) -> None:
    before = prairie.grass_at([TALL]).height
    prairie.cut(Footprint(radius=1.0), 0.12, pose=Pose(*TALL))
    assert prairie.grass_at([TALL, (12.0, 0.0)]).height == pytest.approx([0.12, before[0]])
    prairie.grow(Footprint(radius=1.0), pose=Pose(*TALL))
    np.testing.assert_array_equal(prairie.grass_at([TALL]).height, before)


def test_wind_and_feet_lay_grass_low_and_leave_none_of_its_density(prairie: Prairie) -> None:
    calm = prairie.grass_at([TALL, RUSHES])
    handle = prairie.add(Breeze(strength=0.7, swing=0.0))
    blown = prairie.grass_at([TALL, RUSHES])
    assert (blown.height < 0.9 * calm.height).all()
    np.testing.assert_array_equal(blown.density, calm.density)
    prairie.remove(handle)
    esper.create_entity(Presser(radius=0.5), Pose(TALL[0] + 0.1, TALL[1]))
    trodden = prairie.grass_at([TALL, RUSHES])
    assert trodden.height[0] < 0.5 * calm.height[0]
    assert trodden.height[1] == calm.height[1]


def test_a_patch_that_a_game_has_cleared_has_no_grass_that_stands(prairie: Prairie) -> None:
    watch(prairie)
    (entity,) = prairie.patch_at([TALL]).tolist()
    esper.component_for_entity(entity, Patch).grows = False
    found = prairie.grass_at([TALL, RUSHES])
    assert found.cleared.tolist() == [True, False]
    assert found.height[0] == 0.0 < found.height[1]


def test_grass_below_a_tree_is_as_thin_before_the_first_frame_as_after_it(world: World) -> None:
    del world
    birch = {"birch": {"habit": "birch", "positions": [[5, 5]]}}
    prairie = Prairie.load({"tallgrass": 2, "grass": {"green": {}}, "trees": birch, "quality": "minimal"})
    below = prairie.grass_at([(5.5, 5.5)]).density[0, 0]
    assert below < 0.95 * prairie.grass_at([(-20.0, -20.0)]).density[0, 0]
    watch(prairie)
    assert prairie.grass_at([(5.5, 5.5)]).density[0, 0] == below
    prairie.release()


def test_who_asks_for_patches_of_a_viewer_that_was_never_drawn_is_told_once(
    prairie: Prairie, caplog: pytest.LogCaptureFixture
) -> None:
    assert not prairie.patch_at([TALL]).any()
    assert not caplog.messages  # nobody has looked yet
    prairie.follow(*FROM_ABOVE, viewer="map")
    for _ in range(2):
        assert not prairie.patch_at([TALL]).any()
        assert prairie.patch_at([TALL], viewer="map").all()
    assert caplog.messages == ["patch_at finds nothing: viewer 'main' was never drawn, but 'map' was"]
