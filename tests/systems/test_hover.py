"""Bodies that hover over plugins' winds: where they fly, where the wind then acts, and failures."""

from collections.abc import Callable
from functools import partial
from math import nan, pi, sin
from typing import Any

import numpy as np
import pytest

from tallgrass.components.arrays import Floats
from tallgrass.components.body import Body, Hover
from tallgrass.components.pose import Pose
from tallgrass.components.wind import Extent, Grass, WindPrimitive
from tallgrass.engine.terrain.sample import height_at
from tallgrass.engine.world import World
from tallgrass.systems.bodies.fly import carried, flying, foot
from tallgrass.systems.frame.feature import Start
from tallgrass.systems.site import Site
from tallgrass.systems.wind.quarantine import Quarantine
from tallgrass.systems.winds import Winds


class Rotor(WindPrimitive):
    """A plugin's wind: the air under a rotor that swings to and fro along x."""

    kind: str = "rotor"
    swing: float = 0.0

    def hover(self) -> Any:
        return Hover(height=5.0)

    def pose(self, *, time: float) -> Any:
        return Pose(8.0 * sin(time), 3.0, 0.5)

    def extent(self, *, time: float) -> Extent:
        return Extent(-2.0, 2.0, -2.0, 2.0)

    def mask(self, place: Floats, /, *, time: float) -> Floats:
        return np.asarray((place * place).sum(axis=1) < 4.0, np.float32)

    def action(self, place: Floats, /, *, time: float, seed: int, grass: Grass) -> Floats:
        return np.full_like(place, [0.0, -0.5])


class Silent(Rotor):
    """Its `hover` raises."""

    def hover(self) -> Any:
        raise LookupError("nothing there")


class Worded(Rotor):
    """Its `hover` returns a text."""

    def hover(self) -> Any:
        return "saucer"


class Unknown(Rotor):
    """Its body has an unknown model."""

    def hover(self) -> Any:
        return Hover("dragon")  # type: ignore[arg-type]


class Tall(Rotor):
    """Its body's height is a text."""

    def hover(self) -> Any:
        return Hover(height="high")  # type: ignore[arg-type]


class Lost(Rotor):
    """Its `pose` returns None."""

    def pose(self, *, time: float) -> Any:
        return None


class Vague(Rotor):
    """Its pose is NaN."""

    def pose(self, *, time: float) -> Any:
        return Pose(nan, 0.0)


class Gone(Rotor):
    """Its pose is infinite in single precision."""

    def pose(self, *, time: float) -> Any:
        return Pose(1e300, 0.0)


@pytest.fixture
def site(laid: Callable[..., Site]) -> Site:
    return laid()


@pytest.fixture
def winds(world: World, site: Site) -> Winds:
    """Winds of a site on uneven ground, none at first."""
    return Winds(Start(world, site, Quarantine(), live=False))


Bodies = Callable[[float], list[Body]]


@pytest.fixture
def bodies(world: World, site: Site, winds: Winds) -> Bodies:
    """Return the bodies in the air at a time."""
    return lambda time: flying(world, site.top_at, winds.quarantine, time=time)


@pytest.mark.parametrize("time", [0.0, 0.4, pi])
def test_r4_the_body_of_a_strangers_wind_flies_along_its_pose(
    winds: Winds, site: Site, bodies: Bodies, time: float
) -> None:
    winds.add(Rotor(), "rotor")
    (body,) = bodies(time)
    assert (body.place[0], body.place[2], body.yaw, body.model) == (8.0 * sin(time), 3.0, 0.5, "saucer")
    assert body == carried(lambda moment: Rotor().pose(time=moment), time, site.top_at, height=5.0)


def test_r3_where_a_body_flies_is_worked_out_once_though_it_is_asked_for_where_it_blows_and_where_it_is_drawn(
    winds: Winds, bodies: Bodies
) -> None:
    asked = list[float]()

    class Counted(Rotor):
        def pose(self, *, time: float) -> Pose:
            asked.append(time)
            return Pose(8.0 * sin(time), 3.0, 0.5)

    winds.add(Counted(), "rotor")
    winds.acting(0.4)
    once = len(asked)
    assert len(bodies(0.4)) == 1
    assert len(asked) == once > 0
    bodies(0.5)
    assert len(asked) > once


def test_r4_a_strangers_wind_acts_where_its_tilted_jet_meets_the_ground(
    winds: Winds, site: Site, bodies: Bodies
) -> None:
    winds.add(Rotor(), "rotor")
    time = 1.2
    (body,) = bodies(time)
    there = foot(body, partial(height_at, site.ground.terrain))
    (blowing,) = winds.acting(time)
    assert blowing.pose == there
    assert abs(there.x - body.place[0]) > 0.5, "it slows down and leans"
    away = np.array([[1.9, 0.0], [-1.9, 0.0], [2.1, 0.0], [-2.1, 0.0]], np.float32)
    felt = winds.messages_at(np.array([there.x, there.z], np.float32) + away, time=time)
    assert np.linalg.norm(felt, axis=1) == pytest.approx([0.5, 0.5, 0.0, 0.0])


def test_r4_at_a_pose_that_a_game_gives_a_strangers_wind_acts_and_its_body_flies_over_it(
    winds: Winds, bodies: Bodies
) -> None:
    winds.add(Rotor(), "rotor", Pose(-7.0, 2.0, 1.0))
    assert [blowing.pose for blowing in winds.acting(1.0)] == [Pose(-7.0, 2.0, 1.0)]
    (body,) = bodies(1.0)
    assert (body.place[0], body.place[2], body.yaw, body.nose, body.bank) == (-7.0, 2.0, 1.0, 0.0, 0.0)


def test_r4_before_a_wind_begins_and_after_it_ends_nothing_hovers_and_its_path_is_not_asked_for(
    winds: Winds, bodies: Bodies
) -> None:
    winds.add(Lost(start=2.0, stop=5.0), "lost")
    for time in (0.0, 1.9, 5.0):
        assert bodies(time) == []
        assert winds.acting(time) == []
    assert winds.quarantine.reasons == {}


def test_r4_an_entity_with_a_body_of_its_own_has_no_other(world: World, winds: Winds, bodies: Bodies) -> None:
    entity = winds.add(Rotor(), "rotor")
    world.add(entity, Body((1.0, 9.0, 2.0)))
    assert bodies(1.0) == [Body((1.0, 9.0, 2.0))]


@pytest.mark.parametrize(
    ("wind", "why"),
    [
        (Silent(), "hover raised LookupError: nothing there"),
        (Worded(), "hover returned str, not Hover"),
        (Unknown(), "hover raised ValueError: a body's model is one of saucer, not 'dragon'"),
        (Tall(), "hover raised ValueError: a body flies above 0 and up to 1000 m high, not 'high'"),
        (Lost(), "pose returned NoneType, not Pose"),
        (Vague(), "pose returned numbers that are not finite"),
        (Gone(), "pose returned numbers far beyond any prairie"),
    ],
    ids=lambda value: type(value).__name__ if isinstance(value, WindPrimitive) else "",
)
def test_d5_a_wind_that_fails_to_say_what_hovers_over_it_is_left_out_and_named_once(
    winds: Winds, bodies: Bodies, caplog: pytest.LogCaptureFixture, wind: Rotor, why: str
) -> None:
    winds.add(wind, "broken")
    winds.add(Rotor(kind="sound"), "sound")
    for _ in range(3):
        assert [blowing.source.name for blowing in winds.acting(1.0)] == ["sound"]
        assert len(bodies(1.0)) == 1
    assert list(winds.quarantine.reasons.values()) == [f"broken: {why}"]
    assert caplog.messages == [f"broken of {__name__}.{type(wind).__name__}: {why}; this wind is left out from now on"]


@pytest.mark.parametrize("first", ["heard", "seen"])
def test_d5_one_that_fails_at_a_games_pose_is_left_out_at_once_too(winds: Winds, bodies: Bodies, first: str) -> None:
    winds.add(Silent(), "broken", Pose())
    assert (winds.acting(1.0) if first == "heard" else bodies(1.0)) == []
    assert list(winds.quarantine.reasons.values()) == ["broken: hover raised LookupError: nothing there"]
    assert (winds.acting(1.0), bodies(1.0)) == ([], [])
