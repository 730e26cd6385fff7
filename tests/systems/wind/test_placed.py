"""Moving winds: on paths, with headings, and moved by a game (W5, W9)."""

from collections.abc import Callable
from math import degrees, pi

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tallgrass.components.arrays import Floats
from tallgrass.components.pose import Pose
from tallgrass.engine.declared.way import Waypoint
from tallgrass.systems.wind.blast import Blast, Shape
from tallgrass.systems.wind.whirlwind import Whirlwind

Feel = Callable[..., Floats]

FIELD = np.random.default_rng(2).uniform(-12.0, 12.0, (600, 2)).astype(np.float32)


def stop(at: float, x: float, z: float, yaw: float | None = None) -> Waypoint:
    return Waypoint(at=at, position=[x, z], yaw=yaw)


def heading(blast: Blast, time: float) -> float:
    """Return the heading at a time [degrees], from -180 to 180."""
    return (degrees(blast.pose(time=time).yaw) + 180.0) % 360.0 - 180.0


def test_w9_without_a_path_it_is_where_it_is_put() -> None:
    pose = Blast(position=[3.0, -4.0], yaw=30.0).pose(time=77.0)
    assert (pose.x, pose.z) == (3.0, -4.0)
    assert degrees(pose.yaw) == pytest.approx(30.0)


def test_w9_on_a_path_it_is_at_each_point_at_its_time_and_waits_before_and_after() -> None:
    blast = Blast(path=[stop(2, 0, 0), stop(5, 10, -3), stop(9, 4, 8)])
    for time, x, z in ((0, 0, 0), (2, 0, 0), (5, 10, -3), (9, 4, 8), (20, 4, 8)):
        pose = blast.pose(time=float(time))
        assert (pose.x, pose.z) == pytest.approx((x, z), abs=1e-9)


@pytest.mark.parametrize(("x", "z", "expected"), [(0, -9, 0.0), (9, 0, 90.0), (0, 9, 180.0), (-9, 0, -90.0)])
def test_w9_it_heads_where_its_path_leads(x: float, z: float, expected: float) -> None:
    blast = Blast(path=[stop(0, 0, 0), stop(6, x, z)], yaw=45.0)
    for time in (0.0, 3.0, 6.0, 60.0):
        assert (heading(blast, time) - expected + 180.0) % 360.0 - 180.0 == pytest.approx(0.0, abs=1e-3)


@given(
    st.lists(st.tuples(st.floats(1, 4), st.floats(-9, 9), st.floats(-9, 9)), min_size=2, max_size=6),
    st.floats(0.2, 0.8),
)
def test_w9_its_heading_is_the_direction_it_moves_in(steps: list[tuple[float, float, float]], part: float) -> None:
    times = np.cumsum([step for step, _, _ in steps])
    blast = Blast(path=[stop(float(at), x, z) for at, (_, x, z) in zip(times, steps, strict=True)])
    time = float(times[0] + part * (times[-1] - times[0]))
    before, now, after = (blast.pose(time=time + off) for off in (-0.01, 0.0, 0.01))
    moved = np.array([after.x - before.x, after.z - before.z])
    leg = int(np.searchsorted(times, time)) - 1
    rests = steps[leg][1:] == steps[leg + 1][1:]
    if np.linalg.norm(moved) > 0.02 and not rests and np.abs(times - time).min() > 0.06:
        ahead = np.array([np.sin(now.yaw), -np.cos(now.yaw)])
        assert ahead @ moved / np.linalg.norm(moved) > 0.9


def test_w9_at_rest_it_keeps_the_heading_that_it_last_had() -> None:
    blast = Blast(path=[stop(0, 0, 0), stop(4, 10, 0), *(stop(at, 10, 0) for at in (6, 8, 10)), stop(14, 10, 20)])
    for time in (7.0, 8.0):
        assert heading(blast, time) == pytest.approx(90.0, abs=20.0)
    assert heading(blast, 13.0) == pytest.approx(180.0, abs=1.0) or heading(blast, 13.0) == pytest.approx(-180.0, abs=1)


def test_w9_before_it_has_moved_at_all_it_looks_where_it_will_go() -> None:
    blast = Blast(path=[stop(0, 5, 5), stop(2, 5, 5), stop(4, 5, 5), stop(6, -5, 5)], yaw=10.0)
    assert heading(blast, 0.5) == pytest.approx(-90.0, abs=1.0)


def test_w9_a_path_that_stays_put_has_the_winds_own_yaw() -> None:
    assert heading(Blast(path=[stop(0, 5, 5), stop(2, 5, 5)], yaw=25.0), 1.0) == pytest.approx(25.0)
    assert heading(Blast(path=[stop(3, 5, 5)], yaw=25.0), 1.0) == pytest.approx(25.0)


def test_w9_a_declared_yaw_goes_before_where_the_path_leads() -> None:
    blast = Blast(path=[stop(0, 0, 0, 0.0), stop(4, 9, 0), stop(8, 9, 9, 90.0)])
    assert heading(blast, 0.0) == pytest.approx(0.0)
    assert heading(blast, 4.0) == pytest.approx(45.0)
    assert heading(blast, 9.0) == pytest.approx(90.0)


@given(st.floats(-8, 8), st.floats(-8, 8), st.floats(-2 * pi, 2 * pi))
def test_w9_a_pose_moves_and_turns_all_it_does(feel: Feel, x: float, z: float, yaw: float) -> None:
    blast = Blast(outline=Shape(ellipse=[2.0, 5.0]), swing=0.0)
    pose = Pose(x, z, yaw)
    own = FIELD[:200]
    place = pose.outside(own) + np.array([x, z], np.float32)
    carried = feel(blast, place=place, time=1.5, poses=[pose])
    np.testing.assert_allclose(carried, pose.outside(feel(blast, place=own, time=1.5)), atol=2e-4)


@given(st.floats(-8, 8), st.floats(-8, 8), st.floats(-360.0, 360.0))
def test_w9_a_pose_from_outside_is_as_good_as_its_own(feel: Feel, x: float, z: float, yaw: float) -> None:
    outline = Shape(polygon=[[-3.0, -3.0], [3.0, -3.0], [0.0, 4.0]])
    own = feel(Blast(outline=outline, position=[x, z], yaw=yaw), place=FIELD, time=2.0)
    given_one = feel(Blast(outline=outline), place=FIELD, time=2.0, poses=[Pose(x, z, np.radians(yaw))])
    np.testing.assert_allclose(given_one, own, atol=1e-6)


def test_w5_a_mask_that_moves_leaves_the_grass_behind_as_it_was(feel: Feel) -> None:
    wind = Whirlwind(radius=2.0, path=[stop(0, -8, 0), stop(8, 8, 0)])
    left = np.array([[-8.0, 1.0]], np.float32)
    story = [bool((feel(wind, place=left, time=time) != 0.0).any()) for time in (0.0, 4.0, 8.0)]
    assert story == [True, False, False]


@given(st.floats(-1e3, 1e3), st.floats(-1e3, 1e3), st.floats(-10, 10))
def test_w9_a_frame_keeps_lengths_and_leads_back(x: float, z: float, yaw: float) -> None:
    pose = Pose(x, z, yaw)
    away = FIELD + np.array([x, z], np.float32)
    own = pose.inside(away)
    np.testing.assert_allclose(np.linalg.norm(own, axis=1), np.linalg.norm(FIELD, axis=1), rtol=1e-3, atol=1e-3)
    np.testing.assert_allclose(pose.outside(own), FIELD, atol=1e-3)


def test_w9_ahead_is_minus_z_of_its_own_frame() -> None:
    ahead = np.array([[0.0, -1.0]], np.float32)
    np.testing.assert_allclose(Pose(0, 0, pi / 2).outside(ahead), [[1.0, 0.0]], atol=1e-6)
    np.testing.assert_allclose(Pose(5, 0, pi / 2).inside(np.array([[8.0, 0.0]], np.float32)), [[0.0, -3.0]], atol=1e-6)


def test_places_may_be_handed_in_as_tuples_and_arrays() -> None:
    for place in ((3, 4), np.array([3, 4]), np.array([3.0, 4.0], np.float32)):
        assert Whirlwind(position=place) == Whirlwind(position=[3.0, 4.0])  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="position must be a list of 2 numbers, found 3"):
        Whirlwind(position=(3, 4, 5))  # type: ignore[arg-type]
