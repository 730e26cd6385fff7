"""Matrices of the viewer, and camera paths."""

import math
from collections.abc import Sequence

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from tallgrass.components.arrays import Doubles, Floats
from tallgrass.engine.camera import (
    FAR,
    NEAR,
    Camera,
    View,
    camera_at,
    forward,
    glide,
    is_mirrored,
    is_reversed,
    parse_camera,
    projection_matrix,
    view_matrix,
    view_of,
)
from tallgrass.engine.declared.camera import CameraSource, Stop

angles = st.floats(-3.0, 3.0)
pitches = st.floats(-1.5, 1.5)
places = st.tuples(*[st.floats(-500.0, 500.0)] * 3)


def slope(xz: Floats) -> Floats:
    """Ground that rises by half a metre per metre in x."""
    return np.asarray(0.5 * xz[:, 0], np.float32)


def flat(xz: Floats) -> Floats:
    return np.zeros(len(xz), np.float32)


def project(point: Sequence[float] | Doubles, camera: Camera, aspect: float = 2.0) -> Floats:
    clip = projection_matrix(camera.view, aspect) @ view_matrix(camera) @ np.array([*point, 1.0], np.float32)
    return np.asarray(clip[:3] / clip[3])


@given(places, angles, pitches)
def test_view_matrix_is_a_rotation_that_brings_the_eye_to_the_origin(
    place: tuple[float, float, float], yaw: float, pitch: float
) -> None:
    matrix = view_matrix(Camera(place, yaw, pitch, 1.0))
    assert matrix.shape == (4, 4)
    assert matrix.dtype == np.float32
    np.testing.assert_allclose(matrix[:3, :3] @ matrix[:3, :3].T, np.eye(3), atol=1e-6)
    assert np.linalg.det(matrix[:3, :3]) == pytest.approx(1.0, abs=1e-6)
    np.testing.assert_allclose(matrix @ [*place, 1.0], [0, 0, 0, 1], atol=1e-3)


def test_a_game_in_centimetres_sees_what_one_in_metres_does() -> None:
    camera = Camera((3.0, 2.0, -7.0), 0.4, -0.2, 0.9)
    metres = view_of(view_matrix(camera), projection_matrix(camera.view, 1.5))
    centi = np.diag([100.0, 100.0, 100.0, 1.0])
    found = view_of(centi @ metres.view, metres.projection @ np.linalg.inv(centi))
    for name in ("view", "projection", "eye"):
        np.testing.assert_allclose(getattr(found, name), getattr(metres, name), rtol=1e-5, atol=1e-5)


def test_two_matrices_that_have_no_inverse_together_are_refused_in_a_sentence() -> None:
    view, projection = np.eye(4), np.eye(4)
    view[1, 0], projection[0, 1] = 1.0, 1e20
    with pytest.raises(ValueError, match=r"^the product of the view and projection matrices overflows"):
        view_of(view, projection)


@given(places, angles, pitches, st.tuples(*[st.booleans()] * 3))
def test_a_picture_in_a_mirror_is_known(
    place: tuple[float, float, float], yaw: float, pitch: float, flips: tuple[bool, bool, bool]
) -> None:
    water, turned, reversed_depth = flips
    view = view_matrix(Camera(place, yaw, pitch, 1.0)) @ np.diag([1.0, -1.0 if water else 1.0, 1.0, 1.0])
    projection = projection_matrix(1.0, 1.5)
    seen = np.diag([1.0, -1.0 if turned else 1.0, -1.0 if reversed_depth else 1.0, 1.0]) @ projection
    found = View(view.astype(np.float32), seen.astype(np.float32))
    assert is_mirrored(found) is (water != turned)
    assert is_reversed(found) is reversed_depth


@pytest.mark.parametrize(
    ("rows", "due"),
    [
        (((-1.0, -0.2), (-1.0, 0.0)), False),  # infinitely far
        (((0.0, 0.1), (-1.0, 0.0)), True),  # the same, from 1 to 0
        (((-0.01, -1.0), (0.0, 1.0)), False),  # orthographic
        (((0.01, 0.5), (0.0, 1.0)), True),
    ],
)  # fmt: skip
def test_depth_that_is_less_farther_off_is_known(rows: tuple[tuple[float, float], ...], *, due: bool) -> None:
    projection = np.eye(4, dtype=np.float32)
    projection[2:, 2:] = rows
    assert is_reversed(View(np.eye(4, dtype=np.float32), projection)) is due


def test_without_perspective_nobody_can_tell_whether_it_is_one() -> None:
    assert is_mirrored(View(np.eye(4, dtype=np.float32), np.diag([0.1, 0.1, -0.01, 1.0]).astype(np.float32))) is None


@given(angles, pitches)
def test_what_lies_ahead_is_in_the_middle_of_the_picture(yaw: float, pitch: float) -> None:
    camera = Camera((0.0, 0.0, 0.0), yaw, pitch, 1.0)
    ahead = 10.0 * np.array(forward(yaw, pitch))
    np.testing.assert_allclose(project(ahead, camera)[:2], [0.0, 0.0], atol=1e-5)


def test_yaw_0_looks_down_minus_z_and_turns_right_and_pitch_looks_up() -> None:
    assert forward(0.0, 0.0) == pytest.approx((0.0, 0.0, -1.0))
    assert forward(math.pi / 2, 0.0) == pytest.approx((1.0, 0.0, 0.0))
    assert forward(0.0, math.pi / 2) == pytest.approx((0.0, 1.0, 0.0))
    x, y, _ = project((1.0, 2.0, -10.0), Camera((0.0, 0.0, 0.0), 0.0, 0.0, 1.0))
    assert x > 0
    assert y > 0


def test_the_angle_of_view_is_vertical_and_the_aspect_widens_it() -> None:
    camera = Camera((0.0, 0.0, 0.0), 0.0, 0.0, math.radians(60.0))
    edge = 10.0 * math.tan(math.radians(30.0))
    assert project((0.0, edge, -10.0), camera)[1] == pytest.approx(1.0, abs=1e-5)
    assert project((2.0 * edge, 0.0, -10.0), camera)[0] == pytest.approx(1.0, abs=1e-5)


def test_depth_runs_from_minus_1_to_1_between_near_and_far() -> None:
    camera = Camera((0.0, 0.0, 0.0), 0.0, 0.0, 1.0)
    assert project((0.0, 0.0, -NEAR), camera)[2] == pytest.approx(-1.0, abs=1e-5)
    assert project((0.0, 0.0, -FAR), camera)[2] == pytest.approx(1.0, abs=1e-5)


def test_24_bits_of_depth_part_a_centimetre_at_100_metres() -> None:
    matrix = projection_matrix(1.0, 1.0).astype(np.float64)

    def depth(z: float) -> float:
        return float((matrix[2, 2] * z + matrix[2, 3]) / -z)

    assert (depth(-100.01) - depth(-100.0)) / 2 * 2**24 > 1.0


def test_a_fixed_camera_stands_its_eye_above_the_ground() -> None:
    camera = camera_at(CameraSource(position=[4.0, 7.0], eye=1.5, yaw=90.0, pitch=-30.0, view=50.0), None, slope)
    assert camera.position == pytest.approx((4.0, 3.5, 7.0))
    assert (camera.yaw, camera.pitch, camera.view) == pytest.approx(tuple(map(math.radians, (90.0, -30.0, 50.0))))


def test_a_targets_height_counts_from_the_ground_under_it() -> None:
    camera = camera_at(CameraSource(position=[0.0, 0.0], eye=2.0, target=[10.0, 1.0, 0.0]), None, slope)
    assert camera.yaw == pytest.approx(math.pi / 2)
    assert camera.pitch == pytest.approx(math.atan2(6.0 - 2.0, 10.0))


def test_a_target_straight_below_gives_finite_angles() -> None:
    camera = camera_at(CameraSource(position=[0.0, 0.0], eye=5.0, target=[0.0, 0.0, 0.0]), None, flat)
    assert (camera.yaw, camera.pitch) == pytest.approx((0.0, -math.pi / 2))


@pytest.fixture
def walk() -> CameraSource:
    return CameraSource(
        position=[9.0, 9.0],
        eye=1.7,
        path=[
            Stop(at=1.0, position=[0.0, 0.0], target=[0.0, 0.0, -20.0]),
            Stop(at=3.0, position=[4.0, 0.0], target=[5.0, 1.0, -20.0]),
            Stop(at=4.0, position=[4.0, -6.0], target=[9.0, 0.0, -9.0]),
            Stop(at=9.0, position=[-8.0, -6.0], target=[0.0, 0.0, -20.0]),
        ],
    )


def test_n5_a_path_passes_its_stops_on_time_and_holds_outside(walk: CameraSource) -> None:
    for stop in walk.path:
        camera = camera_at(walk, stop.at, slope)
        x, z = stop.position
        assert camera.position == pytest.approx((x, 0.5 * x + 1.7, z), abs=1e-5)
    assert camera_at(walk, 0.0, slope) == camera_at(walk, 1.0, slope)
    assert camera_at(walk, 99.0, slope) == camera_at(walk, 9.0, slope)


def test_a_path_does_not_move_the_fixed_place(walk: CameraSource) -> None:
    assert camera_at(walk, None, flat).position == pytest.approx((9.0, 1.7, 9.0))


def test_a_path_has_no_corners_in_time(walk: CameraSource) -> None:
    step = 1e-4
    for stop in walk.path[1:-1]:
        before, at, after = (
            np.array([*camera.position, camera.yaw, camera.pitch])
            for camera in (camera_at(walk, stop.at + k * step, flat) for k in (-1, 0, 1))
        )
        np.testing.assert_allclose((at - before) / step, (after - at) / step, atol=0.02)


def test_a_path_looks_at_its_targets_all_the_way() -> None:
    source = CameraSource(
        path=[
            Stop(at=0.0, position=[-10.0, 0.0], target=[0.0, 0.0, -5.0]),
            Stop(at=8.0, position=[10.0, 0.0], target=[0.0, 0.0, -5.0]),
        ]
    )
    for time in np.linspace(0.0, 8.0, 9):
        camera = camera_at(source, float(time), flat)
        np.testing.assert_allclose(project((0.0, 0.0, -5.0), camera)[:2], [0.0, 0.0], atol=1e-5)


def test_angles_on_a_path_turn_as_written_and_join_targets_the_short_way() -> None:
    turn = CameraSource(path=[Stop(at=0.0, position=[0.0, 0.0]), Stop(at=2.0, position=[0.0, 0.0], yaw=360.0)])
    assert camera_at(turn, 1.0, flat).yaw == pytest.approx(math.pi)
    mixed = CameraSource(
        path=[
            Stop(at=0.0, position=[0.0, 0.0], yaw=170.0),
            Stop(at=2.0, position=[0.0, 0.0], target=[-1.0, 1.7, 5.0]),
        ]
    )
    assert 170.0 < math.degrees(camera_at(mixed, 1.0, flat).yaw) < 195.0


def test_a_path_of_one_stop_stands_still() -> None:
    source = CameraSource(path=[Stop(at=2.0, position=[3.0, 4.0], yaw=10.0)])
    assert camera_at(source, 0.0, flat) == camera_at(source, 7.0, flat)
    assert camera_at(source, 2.0, flat).position == pytest.approx((3.0, 1.7, 4.0))


@given(
    hnp.arrays(np.float64, st.tuples(st.integers(2, 8), st.just(2)), elements=st.floats(-100.0, 100.0)),
    st.floats(0.0, 1.0),
)
def test_a_glide_along_a_straight_line_at_constant_speed_stays_on_it(values: Doubles, part: float) -> None:
    times = np.arange(len(values), dtype=np.float64) ** 1.5
    line = times[:, None] * values[:1] + values[1:2]
    time = part * times[-1]
    there: Doubles = time * values[0] + values[1]
    np.testing.assert_allclose(glide(times, line, time), there, atol=1e-9)


def test_parse_camera_reads_metres_and_degrees() -> None:
    camera = parse_camera("-3, 2.5,4e1,-90,-10", view=0.7)
    assert camera == Camera((-3.0, 2.5, 40.0), math.radians(-90.0), math.radians(-10.0), 0.7)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("1,2,3", "five numbers"),
        ("1,2,3,4,5,6", "five numbers"),
        ("", "five numbers"),
        ("1,2,x,4,5", "'x' is not a number"),
        ("1,2,,4,5", "'' is not a number"),
        ("nan,2,3,4,5", "not a finite number"),
        ("1,inf,3,4,5", "not a finite number"),
        ("1,2,3,4,91", "pitch 91"),
        ("1,2,3,4000,0", "yaw 4000"),
        ("1e7,2,3,4,0", "beyond"),
    ],
)
def test_parse_camera_says_what_is_wrong(text: str, says: str) -> None:
    with pytest.raises(ValueError, match=says):
        parse_camera(text, view=0.7)
