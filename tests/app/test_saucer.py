"""The saucer's motion by held keys, without a window."""

import math
from dataclasses import replace
from typing import get_args

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tallgrass.app.saucer import (
    CLEAR,
    CRUISE,
    DISTANCE,
    FAST,
    HIGHEST_LOOK,
    LOWEST_LOOK,
    OVER,
    TURN,
    Saucer,
    body,
    chase,
    flown,
    jet,
    launched,
    looked,
    put,
)
from tallgrass.app.studio.walker import MARGIN, Ground, Move
from tallgrass.components.arrays import Floats
from tallgrass.engine.camera import forward
from tallgrass.systems.bodies.fly import HOVER, LOWEST, STEEPEST

Set = frozenset[Move]
moves: tuple[Move, ...] = get_args(Move)
held_keys = st.frozensets(st.sampled_from(moves))
steps = st.floats(0.0, 0.5)


def hills(xz: Floats) -> Floats:
    return np.asarray(3.0 * np.sin(0.1 * xz[:, 0]) + 2.0 * np.cos(0.13 * xz[:, 1]), np.float32)


def grassy(xz: Floats) -> Floats:
    return hills(xz) + np.float32(GRASS)


GRASS = 0.75
"""Height of the grass on all these grounds [m]."""

HILLS = Ground(hills, (200.0, 100.0), grassy)
WIDE = Ground(hills, (1e6, 1e6), grassy)
FLAT = Ground(lambda xz: np.zeros(len(xz), np.float32), (1e6, 1e6), lambda xz: np.full(len(xz), GRASS, np.float32))


def after(saucer: Saucer, held: set[Move], seconds: float, ground: Ground = FLAT) -> Saucer:
    for _ in range(round(60 * seconds)):
        saucer = flown(saucer, held, 1 / 60, ground)
    return saucer


@given(script=st.lists(st.tuples(held_keys, steps), max_size=12))
def test_r4_wherever_keys_lead_the_saucer_stays_over_the_terrain(script: list[tuple[Set, float]]) -> None:
    saucer = launched(95.0, -45.0, 1.0, HILLS)
    for held, dt in script:
        saucer = flown(saucer, held, dt, HILLS)
        x, y, z = saucer.place
        assert abs(x) <= 100.0 - MARGIN
        assert abs(z) <= 50.0 - MARGIN
        assert y >= HILLS.height(x, z) + GRASS + LOWEST - 1e-5
        eye = chase(saucer, 0.7, HILLS).position
        assert eye[1] >= HILLS.height(eye[0], eye[2]) + CLEAR - 1e-5


@given(held=held_keys, first=steps, second=steps, yaw=st.floats(-3.0, 3.0))
def test_r4_the_flight_does_not_depend_on_how_time_is_cut_into_frames(
    held: Set, first: float, second: float, yaw: float
) -> None:
    saucer = Saucer((0.0, 50.0, 0.0), yaw, velocity=(3.0, -1.0), turning=0.5, power=6.0, trail=yaw - 0.4)
    whole = flown(saucer, held, first + second, WIDE)
    cut = flown(flown(saucer, held, first, WIDE), held, second, WIDE)
    for name in ("place", "velocity", "yaw", "turning", "power", "trail"):
        np.testing.assert_allclose(getattr(whole, name), getattr(cut, name), atol=1e-6, err_msg=name)


def test_r4_it_cruises_two_metres_above_the_grass() -> None:
    cruising = after(launched(0.0, 0.0, math.pi / 2, FLAT), {"ahead"}, 8.0)
    assert HOVER == 2.0
    assert cruising.place[1] == pytest.approx(GRASS + HOVER)
    assert cruising.velocity == pytest.approx((CRUISE, 0.0), abs=0.01)
    assert after(cruising, {"ahead", "run"}, 8.0).velocity == pytest.approx((FAST, 0.0), abs=0.01)
    assert after(cruising, {"back"}, 8.0).velocity == pytest.approx((-CRUISE / 2, 0.0), abs=0.01)
    assert after(cruising, {"ahead", "back"}, 8.0).velocity == pytest.approx((0.0, 0.0), abs=0.01)


def test_r4_it_turns_to_the_right_and_flies_where_it_heads() -> None:
    turning = after(launched(0.0, 0.0, 0.0, FLAT), {"ahead", "right"}, 6.0)
    assert turning.turning == pytest.approx(TURN, rel=1e-3)
    away = after(replace(turning, turning=0.0, yaw=2.0), {"ahead"}, 8.0)
    assert away.velocity == pytest.approx((CRUISE * math.sin(2.0), -CRUISE * math.cos(2.0)), abs=0.01)


def test_r4_it_banks_into_turns_and_lowers_its_nose_to_go_faster() -> None:
    start = launched(0.0, 0.0, 0.0, FLAT)
    assert (body(start).nose, body(start).bank) == (0.0, 0.0)
    gaining = after(start, {"ahead"}, 0.5)
    assert body(gaining).nose < -0.2
    assert body(gaining).bank == pytest.approx(0.0, abs=1e-9)
    cruising = after(gaining, {"ahead"}, 8.0)
    assert -0.15 < body(cruising).nose < -0.05
    assert body(after(cruising, {"ahead", "right"}, 1.0)).bank > 0.15
    assert body(after(cruising, {"ahead", "left"}, 1.0)).bank < -0.15
    assert body(after(cruising, set(), 0.5)).nose > 0.1, "it brakes with its nose up"


def test_r4_it_never_leans_with_a_jump() -> None:
    script: list[set[Move]] = [{"ahead", "run"}, {"back", "left"}, {"right"}, set(), {"ahead", "left", "run"}]
    saucer, tilts = launched(0.0, 0.0, 0.0, FLAT), [(0.0, 0.0)]
    for held in script:
        for _ in range(240):
            saucer = flown(saucer, held, 1 / 240, FLAT)
            tilts.append((body(saucer).nose, body(saucer).bank))
    assert np.abs(np.diff(tilts, axis=0)).max() < 0.04
    assert np.abs(tilts).max() < STEEPEST


def test_r4_its_jet_meets_the_ground_behind_it_when_it_goes_faster() -> None:
    start = launched(3.0, 4.0, 0.0, FLAT)
    foot = jet(start, FLAT)
    assert (foot.x, foot.z, foot.yaw) == pytest.approx((3.0, 4.0, 0.0))
    gaining = after(start, {"ahead"}, 0.5)
    behind = jet(gaining, FLAT).z - gaining.place[2]
    assert behind == pytest.approx((GRASS + HOVER) * math.tan(-body(gaining).nose))


def test_the_camera_is_behind_it_and_comes_round_after_it() -> None:
    start = launched(0.0, 0.0, 0.0, FLAT)
    camera = chase(start, 0.7, FLAT)
    assert camera.view == 0.7
    assert camera.position[2] > 0.9 * DISTANCE * math.cos(start.pitch)
    assert camera.position[1] > start.place[1]
    turning = after(start, {"right"}, 1.0)
    assert 0.1 < turning.yaw - turning.trail < 0.6
    settled = after(turning, set(), 4.0)
    assert settled.trail == pytest.approx(settled.yaw, abs=1e-3)


@given(yaw=st.floats(-6.0, 6.0), right=st.floats(-3.0, 3.0), up=st.floats(-2.0, 2.0))
def test_the_mouse_looks_at_it_from_all_around(yaw: float, right: float, up: float) -> None:
    saucer = looked(launched(0.0, 0.0, yaw, HILLS), right=right, up=up)
    assert LOWEST_LOOK <= saucer.pitch <= HIGHEST_LOOK
    camera = chase(saucer, 0.7, HILLS)
    ahead = forward(camera.yaw, camera.pitch)
    aim = np.array(saucer.place) + np.array([0.0, OVER, 0.0]) - np.array(camera.position)
    np.testing.assert_allclose(np.cross(ahead, aim), 0.0, atol=1e-6)
    assert np.dot(ahead, aim) > 1.0


def test_another_ground_lifts_it_onto_it() -> None:
    higher = Ground(
        lambda xz: np.full(len(xz), 20.0, np.float32), (50.0, 50.0), lambda xz: np.full(len(xz), 20.5, np.float32)
    )
    moved = put(launched(95.0, 0.0, 1.0, HILLS), higher)
    assert moved.place == pytest.approx((25.0 - MARGIN, 20.5 + HOVER, 0.0))
    assert moved.yaw == 1.0
