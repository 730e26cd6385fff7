"""Anchors of winds: their places, paths and headings."""

from math import hypot, radians

import numpy as np
import pytest
from pydantic import Field

from tallgrass.app.edit.anchors import declared_anchors, heading, turned_to
from tallgrass.components.arrays import Floats
from tallgrass.components.declaration import Pair
from tallgrass.components.wind import Grass, WindPrimitive
from tallgrass.engine.camera import ahead
from tallgrass.engine.declared.way import Waypoint
from tallgrass.systems.wind.breeze import Breeze
from tallgrass.systems.wind.gust import Gust
from tallgrass.systems.wind.whirlwind import Whirlwind


class Draught(WindPrimitive):
    """A plugin's wind with the keys `position` and `direction`."""

    kind: str = "draught"
    """A draught."""

    position: Pair = Field(default=[1.0, 2.0])
    """Where it is [m]."""

    direction: float = 30.0
    """Where it blows to [degrees]."""

    def mask(self, place: Floats, /, *, time: float) -> Floats:
        return np.ones(len(place), np.float32)

    def action(self, place: Floats, /, *, time: float, seed: int, grass: Grass) -> Floats:
        return np.zeros((len(place), 2), np.float32)


def test_a_wind_is_held_where_it_says_that_it_is_and_turned_by_its_heading() -> None:
    (anchor,) = declared_anchors(Whirlwind(position=[3.0, -4.0], yaw=90.0), 2)
    assert (anchor.way, anchor.place) == (("wind", 2, "position"), (3.0, -4.0))
    assert heading(Whirlwind(yaw=90.0), 2) == (("wind", 2, "yaw"), radians(90.0))
    assert heading(Gust(direction=45.0), 0) == (("wind", 0, "direction"), radians(45.0))


def test_a_strangers_wind_is_held_by_the_same_keys() -> None:
    assert [anchor.place for anchor in declared_anchors(Draught(), 0)] == [(1.0, 2.0)]
    assert heading(Draught(), 0) == (("wind", 0, "direction"), radians(30.0))


def test_a_wind_on_a_path_is_held_at_each_of_its_points_and_turned_by_none() -> None:
    path = [Waypoint(at=0.0, position=[1.0, 2.0]), Waypoint(at=1.0, position=[3.0, 4.0])]
    anchors = declared_anchors(Whirlwind(path=path), 1)
    assert [anchor.way for anchor in anchors] == [("wind", 1, "path", k, "position") for k in (0, 1)]
    assert [anchor.place for anchor in anchors] == [(1.0, 2.0), (3.0, 4.0)]
    assert heading(Whirlwind(path=path), 1) is None


def test_a_wind_that_is_everywhere_is_held_nowhere() -> None:
    assert declared_anchors(Breeze(), 0) == []
    assert heading(Breeze(), 0) is None


@pytest.mark.parametrize("yaw", [0.0, 37.5, 90.0, -120.0, 180.0])
def test_what_is_turned_to_a_place_heads_there(yaw: float) -> None:
    place = ahead((5.0, -3.0), radians(yaw), 7.0)
    assert hypot(place[0] - 5.0, place[1] + 3.0) == pytest.approx(7.0)
    assert turned_to((5.0, -3.0), place) % 360.0 == pytest.approx(yaw % 360.0, abs=0.06)
