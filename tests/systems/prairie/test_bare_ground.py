"""Ground without grass: too steep for a kind, or a hole (T1, F4)."""

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest
from yaml import safe_load

from tallgrass.components.arrays import Floats
from tallgrass.components.footprint import Footprint
from tallgrass.engine.scene import SceneError
from tallgrass.engine.world import World
from tallgrass.systems.prairie import Prairie
from tallgrass.testing import LITTLE, watch

QUALITY = safe_load(LITTLE)["quality"]
Load = Callable[..., Prairie]


def ridge() -> Floats:
    """Return heights with a slope of 20 degrees up to x = 0, and of 45 beyond."""
    x = np.arange(-20.0, 21.0)
    return np.tile(np.where(x < 0.0, x * np.tan(np.radians(20.0)), x), (41, 1)).astype(np.float32)


def scene(heights: Floats, **terrain: object) -> dict[str, Any]:
    return {
        "tallgrass": 2,
        "terrain": {"heights": heights, "cell": 1.0, **terrain},
        "grass": {"low": {"height": [0.2, 0.3], "slope": 30.0}, "high": {"height": [0.4, 0.6]}},
        "quality": QUALITY,
    }


@pytest.fixture
def load(world: World) -> Iterator[Load]:
    del world
    made: list[Prairie] = []

    def build(values: dict[str, Any]) -> Prairie:
        made.append(Prairie.load(values))
        return made[-1]

    yield build
    for each in made:
        each.release()


def test_f4_a_kind_grows_up_to_its_slope_and_others_go_on(load: Load) -> None:
    prairie = load(scene(ridge()))
    found = prairie.grass_at([(-10.0, 3.0), (10.0, 3.0)])
    np.testing.assert_allclose(found.density, [[0.5, 0.5], [0.0, 0.5]], atol=1e-6)
    assert found.name == ("low", "high")
    assert not found.cleared.any(), "nobody has cleared it"


@pytest.mark.parametrize(("degrees", "due"), [(21.0, 0.5), (26.0, 0.26), (29.9, 0.0)])
def test_f4_it_thins_out_over_the_last_degrees(load: Load, degrees: float, due: float) -> None:
    heights = np.tile(np.arange(41.0) * np.tan(np.radians(degrees)), (41, 1)).astype(np.float32)
    assert load(scene(heights)).grass_at([(3.0, 3.0)]).density[0, 0] == pytest.approx(due, abs=0.01)


def test_f4_it_grows_where_a_game_levels_the_ground(load: Load) -> None:
    prairie = load(scene(ridge()))
    watch(prairie)
    prairie.set_heights((4.0, -10.0), np.zeros((16, 12), np.float32))
    assert prairie.grass_at([(9.0, 0.0)]).density[0, 0] == pytest.approx(0.5)


@pytest.mark.parametrize("how", ["nan", "key"])
def test_f4_nothing_grows_in_a_hole_and_what_is_asked_there_stays_defined(load: Load, how: str) -> None:
    heights, holes = ridge(), np.zeros((41, 41), np.bool_)
    holes[18:23, 10:15] = True
    if how == "nan":
        heights[holes] = np.nan
        prairie = load(scene(heights))
    else:
        prairie = load(scene(heights, holes=holes))
    within, beside = (-8.0, 0.0), (-8.0, 6.0)
    found = prairie.grass_at([within, beside])
    assert (found.name, found.cleared.tolist()) == (("", "low"), [False, False])
    assert prairie.site.ground.terrain.holes is not None
    assert prairie.site.ground.terrain.holes.sum() == 25
    due = prairie.height_at([beside])
    np.testing.assert_allclose(prairie.height_at([within]), due, atol=0.2)
    assert np.isfinite(prairie.wind_at([within])).all()
    assert np.isfinite(prairie.normal_at([within])).all()
    prairie.sow("high", Footprint(radius=9.0), 1.0)
    assert prairie.grass_at([within]).density.sum() == 0.0


def test_f4_a_hole_that_is_dug_is_asked_for_saved_and_filled(load: Load) -> None:
    heights = ridge()
    heights[20, 20] = np.nan
    prairie, other, place = load(scene(heights)), load(scene(heights)), [(-8.0, 0.0)]
    before, clean = prairie.grass_at(place).density, prairie.state()
    prairie.set_heights((-10.0, -2.0), np.full((5, 5), np.nan))
    assert before.sum() > 0.5
    assert prairie.grass_at(place).density.sum() == 0.0
    np.testing.assert_array_equal(prairie.height_at(place), other.height_at(place))
    other.restore(prairie.state())
    np.testing.assert_array_equal(other.site.ground.terrain.holes, prairie.site.ground.terrain.holes)
    assert other.grass_at(place).density.sum() == 0.0
    other.restore(clean)
    np.testing.assert_array_equal(other.grass_at(place).density, before)
    prairie.set_heights((-10.0, -2.0), np.zeros((5, 5)))
    np.testing.assert_array_equal(prairie.grass_at(place).density, before)
    assert prairie.site.ground.terrain.holes is not None
    assert prairie.site.ground.terrain.holes.sum() == 1


def test_f4_a_state_of_ground_with_other_holes_is_refused(load: Load) -> None:
    heights = ridge()
    heights[:3, :3] = np.nan
    one, other = load(scene(heights)), load(scene(np.nan_to_num(heights, nan=0.0)))
    with pytest.raises(ValueError, match=r"^this state does not fit this scene: its ground"):
        other.restore(one.state())
    other.restore(other.state())


def test_ground_that_is_all_holes_and_infinite_heights_are_told(load: Load) -> None:
    with pytest.raises(SceneError, match="none of it has a height"):
        load(scene(np.full((5, 5), np.nan, np.float32)))
    heights = ridge()
    heights[3, 4], heights[5, 6] = np.inf, np.nan
    with pytest.raises(SceneError, match="1 height is no number, the first at row 3, column 4"):
        load(scene(heights))
