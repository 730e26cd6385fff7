"""The viewer's motion by held keys, without a window."""

import math
from dataclasses import replace
from typing import get_args

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tallgrass.app.studio.walker import (
    EYE,
    FLY,
    LOWEST,
    MARGIN,
    RUN,
    WALK,
    Ground,
    Move,
    Walker,
    asked_velocity,
    moved,
    settled,
    start,
    toggled,
    turned,
)
from tallgrass.components.arrays import Floats
from tallgrass.engine.camera import Camera

Set = frozenset[Move]
moves: tuple[Move, ...] = get_args(Move)
held_keys = st.frozensets(st.sampled_from(moves))
looks = st.tuples(st.floats(-3.0, 3.0), st.floats(-1.5, 1.5))
steps = st.floats(0.0, 0.5)


def hills(xz: Floats) -> Floats:
    return np.asarray(3.0 * np.sin(0.1 * xz[:, 0]) + 2.0 * np.cos(0.13 * xz[:, 1]), np.float32)


HILLS = Ground(hills, (200.0, 100.0), hills)
WIDE = Ground(hills, (1e6, 1e6), hills)


def on_foot(x: float = 0.0, z: float = 0.0) -> Walker:
    return Walker((x, HILLS.height(x, z) + EYE, z))


@given(script=st.lists(st.tuples(held_keys, steps, st.floats(-1.0, 1.0)), max_size=12), flying=st.booleans())
def test_wherever_keys_lead_the_eye_stays_over_the_terrain(
    script: list[tuple[Set, float, float]], *, flying: bool
) -> None:
    walker = replace(on_foot(95.0, -45.0), flying=flying)
    for held, dt, turn in script:
        walker = moved(turned(walker, right=turn, up=0.3 * turn), held, dt, HILLS)
        x, y, z = walker.position
        assert abs(x) <= 100.0 - MARGIN
        assert abs(z) <= 50.0 - MARGIN
        height = y - HILLS.height(x, z)
        assert height >= LOWEST - 1e-5 if flying else height == pytest.approx(EYE, abs=1e-5)


@given(held=held_keys, look=looks, first=steps, second=steps, flying=st.booleans())
def test_the_way_does_not_depend_on_how_time_is_cut_into_frames(
    held: Set, look: tuple[float, float], first: float, second: float, *, flying: bool
) -> None:
    walker = Walker((0.0, 50.0, 0.0), *look, velocity=(1.0, -0.5, 2.0), flying=flying)
    whole = moved(walker, held, first + second, WIDE)
    cut = moved(moved(walker, held, first, WIDE), held, second, WIDE)
    np.testing.assert_allclose(whole.position, cut.position, atol=1e-4)
    np.testing.assert_allclose(whole.velocity[::2], cut.velocity[::2], atol=1e-9)


@given(held_keys, looks)
def test_diagonals_are_no_faster_and_opposite_keys_cancel(held: Set, look: tuple[float, float]) -> None:
    speed = math.hypot(*asked_velocity(Walker((0.0, 0.0, 0.0), *look), held))
    still = ("ahead" in held) == ("back" in held) and ("left" in held) == ("right" in held)
    assert speed == pytest.approx(0.0 if still else RUN if "run" in held else WALK)


def test_ahead_follows_the_look_and_right_is_to_its_right() -> None:
    east = Walker((0.0, 0.0, 0.0), yaw=math.pi / 2, pitch=-1.0)
    assert asked_velocity(east, {"ahead"}) == pytest.approx((WALK, 0.0, 0.0))
    assert asked_velocity(east, {"right"}) == pytest.approx((0.0, 0.0, WALK))
    diving = Walker((0.0, 0.0, 0.0), pitch=-math.pi / 6, flying=True)
    assert asked_velocity(diving, {"ahead"}) == pytest.approx((0.0, -FLY / 2, -FLY * math.cos(math.pi / 6)))
    assert asked_velocity(diving, {"up"}) == pytest.approx((0.0, FLY, 0.0))


def test_speed_comes_and_goes_smoothly() -> None:
    walker = on_foot()
    speeds = []
    for frame in range(120):
        walker = moved(walker, {"ahead"} if frame < 60 else set(), 1 / 60, WIDE)
        speeds.append(math.hypot(*walker.velocity))
    assert np.all(np.diff(speeds[:60]) >= 0)
    assert np.all(np.diff(speeds[60:]) <= 0)
    assert 0.0 < speeds[0] < 0.3 * WALK
    assert speeds[59] == pytest.approx(WALK, rel=0.01)
    assert speeds[-1] < 0.01 * WALK


def test_who_stops_flying_comes_down_to_the_eyes_height_without_a_jump() -> None:
    walker = Walker((0.0, HILLS.height(0.0, 0.0) + 10.0, 0.0), flying=True)
    walker = toggled(walker)
    heights = [10.0]
    for _ in range(180):
        walker = moved(walker, set(), 1 / 60, HILLS)
        heights.append(walker.position[1] - HILLS.height(0.0, 0.0))
    assert np.all(np.diff(heights) <= 0)
    assert np.diff(heights).min() > -1.0
    assert heights[-1] == pytest.approx(EYE, abs=0.01)


def test_a_look_goes_round_but_not_over() -> None:
    walker = turned(Walker((0.0, 0.0, 0.0), yaw=3.0), right=1.0, up=5.0)
    assert walker.yaw == pytest.approx(4.0 - math.tau)
    assert walker.pitch < math.pi / 2


def test_a_low_camera_starts_on_foot_and_a_high_one_in_flight() -> None:
    ground = HILLS.height(1.0, 2.0)
    low = start(Camera((1.0, ground + 2.0, 2.0), 0.5, -0.2, 1.0), HILLS)
    assert (low.flying, low.yaw, low.pitch) == (False, 0.5, -0.2)
    assert low.position == pytest.approx((1.0, ground + EYE, 2.0))
    high = start(Camera((1.0, 40.0, 2.0), 0.5, -0.2, 1.0), HILLS)
    assert (high.flying, high.position) == (True, (1.0, 40.0, 2.0))


def test_another_ground_lifts_the_walker_onto_it() -> None:
    higher = Ground(lambda xz: hills(xz) + np.float32(20.0), (100.0, 100.0), hills)
    walker = settled(on_foot(95.0, 0.0), higher)
    assert walker.position == pytest.approx((50.0 - MARGIN, higher.height(50.0 - MARGIN, 0.0) + EYE, 0.0))


def test_the_camera_of_a_walker_is_where_it_looks_from() -> None:
    assert replace(on_foot(), yaw=1.0, pitch=0.5).camera(0.7) == Camera((0.0, 2.0 + EYE, 0.0), 1.0, 0.5, 0.7)
