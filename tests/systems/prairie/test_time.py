"""Setting the time: a scene's winds, pressers and light are as after running to that time."""

from collections.abc import Iterator
from typing import Any

import esper
import numpy as np
import pytest
from yaml import safe_load

from tallgrass.components.footprint import Footprint
from tallgrass.components.pose import Pose
from tallgrass.components.presser import Presser
from tallgrass.engine.world import World
from tallgrass.systems.prairie import Prairie
from tallgrass.testing import LITTLE, watch

QUALITY = safe_load(LITTLE)["quality"]
SCENE = {
    "tallgrass": 2,
    "terrain": {"size": [60, 60], "cell": 5.0},
    "grass": {"green": {"height": [0.3, 0.5], "recovery": 5.0}},
    "wind": [
        {"kind": "turbulence", "strength": 0.3},
        {"kind": "gust", "position": [-30, 0], "direction": 90, "start": 2},
        {"kind": "breeze", "strength": 0.6, "start": 6.0, "ease": 1.0, "priority": 5},
    ],
    "pressers": [{"path": [{"at": 0, "position": [-20, 3]}, {"at": 20, "position": [20, 3]}]}],
    "light": {"hour": 8.0, "hours_per_minute": 60.0},
    "quality": QUALITY,
}
PLACES = np.random.default_rng(0).uniform((-25.0, 0.0), (25.0, 6.0), (400, 2)).astype(np.float32)


@pytest.fixture
def prairie(world: World) -> Iterator[Prairie]:
    del world
    made = Prairie.load(SCENE)
    yield made
    made.release()


def come_to(time: float) -> Prairie:
    """Return a prairie that has run to a time by steps, watched on its way."""
    made = Prairie.load(SCENE)
    for _ in range(round(time / 0.25)):
        made.advance(0.25)
        made.bent_at(PLACES[:1])
    return made


@pytest.mark.parametrize("by", [3.0, 17.0])
def test_n5_what_a_scene_declares_is_as_if_time_had_come_there_from_before_and_from_after(
    prairie: Prairie, by: float
) -> None:
    due = come_to(10.0)
    for _ in range(round(by / 0.5)):
        prairie.advance(0.5)
        prairie.bent_at(PLACES[:1])
    prairie.time = 10.0
    assert prairie.time == 10.0
    np.testing.assert_array_equal(prairie.wind_at(PLACES), due.wind_at(PLACES))
    np.testing.assert_array_equal(prairie.bent_at(PLACES), due.bent_at(PLACES))
    assert (due.bent_at(PLACES) != due.wind_at(PLACES)).any(), "somebody has walked there"
    assert prairie.light == due.light
    assert prairie.light.hour == pytest.approx(18.0)
    due.release()


def test_what_is_cut_stays_cut_and_what_a_game_trod_later_is_forgotten(prairie: Prairie) -> None:
    prairie.advance(2.0)
    walker = esper.create_entity(Presser(radius=0.6), Pose(0.0, -20.0))
    spot = [(0.0, -20.0), (3.0, -20.0)]
    prairie.cut(Footprint(radius=1.0), 0.1, pose=Pose(20.0, -20.0))
    prairie.bent_at(spot)
    esper.add_component(walker, Pose(3.0, -20.0))
    prairie.advance(2.0)
    assert (prairie.bent_at(spot) != prairie.wind_at(spot)).any(axis=1).tolist() == [True, True]
    prairie.time = 1.0
    assert (prairie.bent_at(spot) != prairie.wind_at(spot)).any(axis=1).tolist() == [False, True], "it stands there"
    assert prairie.grass_at([(20.0, -20.0)]).height <= 0.1


def test_every_viewer_sees_another_time_at_once(prairie: Prairie) -> None:
    for _ in range(4):
        prairie.advance(0.1)
        watch(prairie)
    prairie.time = 0.1
    watch(prairie)
    outlook = prairie.viewers["main"]
    assert outlook.viewer.time == 0.1
    assert outlook.changing == 0
    prairie.advance(0.1)
    watch(prairie)
    assert outlook.viewer.dt == pytest.approx(0.1)
    assert not outlook.viewer.jumped


@pytest.mark.parametrize("time", [-1.0, float("nan"), 2e9])
def test_what_is_no_instant_is_refused_and_time_stays(prairie: Prairie, time: float) -> None:
    prairie.advance(3.0)
    with pytest.raises(ValueError, match=r"^a prairie's time is set to 0 s to 1e\+09 s, not to"):
        prairie.time = time
    with pytest.raises(TypeError, match=r"^a prairie's time is set to a number of seconds, not to 'noon'$"):
        prairie.time = "noon"  # type: ignore[assignment]
    assert prairie.time == 3.0


def test_ground_is_trodden_and_worn_alike_at_any_frame_rate_where_it_is_asked_in_each_tick(prairie: Prairie) -> None:
    """As in a game that is played over a network; without asking, frames between ticks, or none, tread other ways."""
    seldom, walker = Prairie.load(SCENE), esper.create_entity(Presser(wear=0.3), Pose(-5.0, 3.0))
    for tick in range(20):
        esper.add_component(walker, Pose(-5.0 + 0.5 * tick, 3.0 + np.sin(tick)))
        for each in (prairie, seldom):
            each.advance(0.05)
            each.bent_at([(0.0, 0.0)])
        if tick % 7:
            watch(prairie)
    watch(seldom)
    np.testing.assert_array_equal(prairie.grass_at(PLACES).density, seldom.grass_at(PLACES).density)
    np.testing.assert_array_equal(prairie.bent_at(PLACES), seldom.bent_at(PLACES))
    assert prairie.grass_at([(0.0, 3.0)]).density < 1.0
    esper.delete_entity(walker, immediate=True)
    seldom.release()


def test_f4_time_that_goes_on_after_a_state_is_the_same_to_the_microsecond(world: World) -> None:
    del world
    steps = 0.1234564, 3e-7  # their sum is rounded up, and the first alone is rounded down
    made, again = Prairie.load(SCENE), Prairie.load(SCENE)
    made.advance(steps[0])
    again.restore(made.state())
    assert again.time == made.time == 0.123456
    for each in (made, again):
        each.advance(steps[1])
    assert again.time == made.time == 0.123457
    for each in (made, again):
        each.release()


def test_time_comes_no_farther_than_what_can_be_asked_and_saved(prairie: Prairie) -> None:
    prairie.advance(9e8)
    with pytest.raises(ValueError, match=r"^a prairie advances to 0 s to 1e\+09 s, not to 1800000000.0$"):
        prairie.advance(9e8)
    assert prairie.time == 9e8
    prairie.advance(1e8)
    assert np.isfinite(prairie.wind_at(PLACES)).all()
    prairie.restore(prairie.state())
    assert prairie.time == 1e9


@pytest.mark.parametrize("dt", [-0.01, float("nan"), float("inf"), 1e308])
def test_time_does_not_go_back_or_leap(prairie: Prairie, dt: float) -> None:
    with pytest.raises(ValueError, match=r"^a prairie advances by 0 s to 1e\+09 s, not by "):
        prairie.advance(dt)
    assert prairie.time == 0.0


@pytest.mark.parametrize("dt", ["0.1", None, [0.1]])
def test_time_goes_on_by_numbers_alone(prairie: Prairie, dt: Any) -> None:
    with pytest.raises(TypeError, match=r"^a prairie advances by a number of seconds, not by "):
        prairie.advance(dt)
    assert prairie.time == 0.0
