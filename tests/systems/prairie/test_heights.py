"""`set_heights`: everything follows the new ground; refusals (F1, N5)."""

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest
from yaml import safe_load

from tallgrass.components.arrays import Floats
from tallgrass.components.pose import Pose
from tallgrass.engine.terrain import rectangle
from tallgrass.engine.world import World
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.wind.whirlwind import Whirlwind
from tallgrass.testing import LITTLE, watch

QUALITY = safe_load(LITTLE)["quality"]
CORNER, PIT = (-6.0, 4.0), np.array([[1.0, -2.0, 0.5], [0.0, -3.0, 7.0]], np.float32)


def scene(heights: Floats) -> dict[str, Any]:
    return {
        "tallgrass": 2,
        "terrain": {"heights": heights, "cell": 2.0},
        "grass": {"green": {"height": [0.3, 0.5]}},
        "quality": QUALITY,
    }


def hills() -> Floats:
    return np.random.default_rng(3).uniform(0.0, 5.0, (41, 51)).astype(np.float32)


def dug() -> Floats:
    heights = hills()
    heights[22:24, 22:25] = PIT
    return heights


Load = Callable[[Floats], Prairie]


@pytest.fixture
def load(world: World) -> Iterator[Load]:
    del world
    made: list[Prairie] = []

    def load(heights: Floats) -> Prairie:
        made.append(Prairie.load(scene(heights)))
        return made[-1]

    yield load
    for prairie in made:
        prairie.release()


PLACES = np.random.default_rng(4).uniform(-12.0, 12.0, (400, 2)).astype(np.float32)
EYES = np.random.default_rng(5).uniform(-20.0, 20.0, (60, 3)) + np.array([0.0, 30.0, 0.0])
DOWN = np.random.default_rng(6).normal(0.0, 1.0, (60, 3)) - np.array([0.0, 2.0, 0.0])


def told(prairie: Prairie) -> list[Floats]:
    wind = prairie.add(Whirlwind(), pose=Pose(-3.0, 5.0))
    watch(prairie)
    patches = prairie.viewers["main"].patches
    found = [
        prairie.height_at(PLACES),
        prairie.normal_at(PLACES),
        prairie.pick(EYES, DOWN),
        prairie.site.top_at(PLACES),
        prairie.grass_at(PLACES).height,
        patches.height.copy(),
        patches.slope.copy(),
        np.array(prairie.site.ground.terrain.span),
    ]
    prairie.remove(wind)
    return found


def test_all_that_is_asked_is_told_of_the_new_ground_and_forgets_it_with_another_state(load: Load) -> None:
    changed, loaded, untouched = load(hills()), load(dug()), load(hills())
    watch(changed)
    before = changed.state()
    changed.set_heights(CORNER, PIT)
    assert changed.height_at([CORNER]) == PIT[0, 0]
    for one, other in zip(told(changed), told(loaded), strict=True):
        np.testing.assert_array_equal(one, other)
    changed.restore(before)
    for one, other in zip(told(changed), told(untouched), strict=True):
        np.testing.assert_array_equal(one, other)
    assert changed.state() == before


def test_another_prairie_of_the_same_scene_and_the_given_array_stay_as_they_were(load: Load) -> None:
    given = hills()
    prairie = load(given)
    prairie.set_heights(CORNER, PIT)
    np.testing.assert_array_equal(given, hills())
    other = prairie.reseeded(9)
    np.testing.assert_array_equal(other.site.ground.terrain.heights, hills())
    other.release()


def test_changed_ground_outlives_a_reload_that_leaves_the_terrain_alone(load: Load) -> None:
    prairie = load(hills())
    prairie.set_heights(CORNER, PIT)
    prairie.reload(scene(hills()) | {"light": {"elevation": 20}})
    assert prairie.height_at([CORNER]) == PIT[0, 0]
    prairie.reload(scene(hills() + 1.0))
    assert prairie.height_at([CORNER]) == hills()[22, 22] + 1.0


def test_a_state_brings_changed_ground_back_to_the_bit(load: Load) -> None:
    played, fresh = load(hills()), load(hills())
    played.set_heights(CORNER, PIT)
    played.set_heights((-50.0, -40.0), np.full((1, 51), 3.25))
    played.set_heights((50.0, 40.0), [[9.0]])
    fresh.set_heights((10.0, 10.0), [[40.0]])
    fresh.restore(played.state())
    np.testing.assert_array_equal(fresh.site.ground.terrain.heights, played.site.ground.terrain.heights)
    assert fresh.state() == played.state()
    mended = load(dug())
    mended.restore(played.state())  # what was dug stays so where a map has been mended since
    np.testing.assert_array_equal(mended.site.ground.terrain.heights, played.site.ground.terrain.heights)
    with pytest.raises(
        ValueError, match=r"^this state does not fit this scene: its ground has other heights or holes$"
    ):
        load(hills() + 0.1).restore(played.state())


def test_who_has_missed_too_many_changes_takes_over_all(load: Load) -> None:
    changed, loaded = load(hills()), load(dug())
    watch(changed)
    for _ in range(rectangle.MOST + 1):
        changed.set_heights((30.0, 30.0), [[hills()[35, 40]]])
    changed.set_heights(CORNER, PIT)
    assert changed.site.ground.terrain.changes.since(0) is None
    for one, other in zip(told(changed), told(loaded), strict=True):
        np.testing.assert_array_equal(one, other)


DUE = "heights are numbers [m] in rows and columns, or NaN where there is no ground"


@pytest.mark.parametrize(
    ("corner", "heights", "why"),
    [
        (CORNER, [[np.nan, np.inf]], f"{DUE}, not infinity"),
        (CORNER, [1.0, 2.0], f"{DUE}, not an array of shape (2,)"),
        (CORNER, np.zeros((0, 3)), f"{DUE}, not an array of shape (0, 3)"),
        (CORNER, "deep", f"{DUE}, not 'deep'"),
        (CORNER, None, f"{DUE}, not None"),
        (CORNER, [[6e4]], "heights lie within 50000 m, and these go from 60000 to 60000 m"),
        ((1.0, 2.0, 3.0), [[1.0]], "the corner of heights is a place (x, z), not (1.0, 2.0, 3.0)"),
        ((np.nan, 2.0), [[1.0]], "the corner of heights is a place (x, z), not NaN or infinity"),
        (
            (-5.5, 4.0),
            [[1.0]],
            (
                "heights begin at a sample of the terrain, and (-5.5, 4) is none: samples stand every 2 m, the nearest "
                "at (-6, 4)"
            ),
        ),
        (
            (48.0, 0.0),
            [[1.0, 2.0, 3.0]],
            (
                "1 by 3 heights from (48, 0) on do not all lie on the terrain, which goes from (-50, -40) to (50, 40), "
                "a sample every 2 m"
            ),
        ),
    ],
)
def test_heights_that_are_refused_change_nothing(load: Load, corner: Any, heights: Any, why: str) -> None:
    prairie = load(hills())
    with pytest.raises(ValueError) as error:  # noqa: PT011 - the whole sentence is compared
        prairie.set_heights(corner, heights)
    assert str(error.value) == why
    np.testing.assert_array_equal(prairie.site.ground.terrain.heights, hills())
    assert prairie.site.ground.terrain.changes.count == 0
