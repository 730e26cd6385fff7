"""Winds set off by keys at the place that the camera looks at, without a window."""

import math
from typing import get_args

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tallgrass.app.studio.walker import MARGIN, Ground
from tallgrass.app.weather import AHEAD, FARTHEST, Raised, looked_at, raised
from tallgrass.components.arrays import Floats
from tallgrass.engine.camera import Camera, forward
from tallgrass.engine.terrain.record import Terrain
from tallgrass.systems.wind.gust import Gust
from tallgrass.systems.wind.whirlwind import Whirlwind


def hills(xz: Floats) -> Floats:
    return np.asarray(3.0 * np.sin(0.1 * xz[:, 0]) + 2.0 * np.cos(0.13 * xz[:, 1]), np.float32)


def level(xz: Floats) -> Floats:
    return np.zeros(len(xz), np.float32)


HILLS = Ground(hills, (200.0, 100.0), hills)
FLAT = Ground(level, (1000.0, 1000.0), level)


def mapped(ground: Ground) -> Terrain:
    """Return a terrain that samples the ground every half metre, twice as wide and deep."""
    x, z = (np.linspace(-side, side, round(4 * side) + 1) for side in ground.size)
    place = np.stack(np.meshgrid(x, z), axis=-1).reshape(-1, 2).astype(np.float32)
    return Terrain(ground.height_at(place).reshape(len(z), len(x)), 0.5)


HILLY, LEVEL = mapped(HILLS), Terrain(np.zeros((2, 2), np.float32), 1000.0)


def test_n8_a_look_leads_to_where_it_meets_the_ground() -> None:
    down = Camera((3.0, 2.0, 4.0), 0.0, -math.atan(0.2), 0.7)
    assert looked_at(down, FLAT, LEVEL) == pytest.approx((3.0, -6.0), abs=1e-3)
    up = Camera((0.0, 2.0, 0.0), math.pi / 2, 0.5, 0.7)
    assert looked_at(up, FLAT, LEVEL) == pytest.approx((AHEAD, 0.0), abs=1e-6)


@given(x=st.floats(-99.0, 99.0), z=st.floats(-49.0, 49.0), yaw=st.floats(-4.0, 4.0), pitch=st.floats(-1.5, 1.5))
def test_n8_a_look_leads_to_the_terrain_and_to_the_first_hill(x: float, z: float, yaw: float, pitch: float) -> None:
    eye = HILLS.height(x, z) + 1.7
    there = looked_at(Camera((x, eye, z), yaw, pitch, 0.7), HILLS, HILLY)
    assert abs(there[0]) <= 100.0 - MARGIN
    assert abs(there[1]) <= 50.0 - MARGIN
    away = math.hypot(there[0] - x, there[1] - z)
    assert away <= FARTHEST + 1e-3
    ahead = forward(yaw, pitch)
    flat = math.hypot(ahead[0], ahead[2])
    met = eye + away / flat * ahead[1] < HILLS.height(*there) + 0.3 if flat > 1e-3 else True
    assert met or away <= AHEAD + 1e-3
    for part in np.arange(0.05, away / flat - 0.25 if met else 0.0, 0.5):
        place = [x + part * ahead[0], z + part * ahead[2]]
        assert eye + part * ahead[1] > HILLS.height(*place) - 0.3, "nothing stands in between"


@pytest.mark.parametrize("kind", get_args(Raised))
def test_n8_what_is_set_off_begins_now_and_ends(kind: Raised) -> None:
    wind = raised(kind, (1.0, 2.0), 0.5, 10.0)
    assert (wind.kind, wind.start) == (kind, 10.0)
    assert wind.stop is not None
    assert 10.0 < wind.stop < 40.0
    pose = wind.pose(time=10.0)
    assert (pose.x, pose.z) == pytest.approx((1.0, 2.0))


def test_n8_a_gust_and_a_whirlwind_go_where_one_looks() -> None:
    for wind in (raised("gust", (0.0, 0.0), 0.5, 10.0), raised("whirlwind", (0.0, 0.0), 0.5, 10.0)):
        assert isinstance(wind, (Gust, Whirlwind))
        there = wind.pose(time=12.0)
        assert math.atan2(there.x, -there.z) == pytest.approx(0.5, abs=1e-6)


def test_n8_a_wind_can_be_set_off_at_the_very_beginning() -> None:
    for kind in get_args(Raised):
        assert raised(kind, (0.0, 0.0), 400.0 * math.pi, 0.0).start == 0.0
