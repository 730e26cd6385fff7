"""Culling, discrete distance and the order of drawing (T2, T3, T5)."""

from math import pi, radians

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from tallgrass.components.viewer import Viewer
from tallgrass.engine.camera import Camera, View, projection_matrix, view_matrix
from tallgrass.systems.around.outlook import Outlook
from tallgrass.systems.around.patches import PatchTable
from tallgrass.systems.cull import Cull
from tallgrass.systems.show.blades.gather import may_be_seen
from tallgrass.systems.show.blades.pool import BladePool
from tallgrass.systems.show.registry import NAMES
from tallgrass.systems.space.cone import discrete_distance, inside_cone, nearness, view_cone
from tallgrass.systems.space.frustum import picture_sides

PATCH = 2.5
AROUND = np.stack(np.meshgrid(np.arange(-12, 13), np.arange(-12, 13)), -1).reshape(-1, 2).astype(np.int32)

cameras = st.builds(
    Camera,
    position=st.tuples(st.floats(-9.0, 9.0), st.floats(-3.0, 12.0), st.floats(-9.0, 9.0)),
    yaw=st.floats(-7.0, 7.0),
    pitch=st.floats(-1.57, 1.57),
    view=st.floats(radians(15), radians(100)),
)
cells = st.tuples(st.integers(-40, 40), st.integers(-40, 40))


def seen_by(camera: Camera, aspect: float = 16 / 9, bank: float = 0.0, shift: tuple[float, float] = (0.0, 0.0)) -> View:
    """Return the matrices of a camera with roll [rad] and an asymmetric frustum, as for one eye."""
    c, s = np.cos(bank), np.sin(bank)
    roll = np.array([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
    projection = projection_matrix(camera.view, aspect)
    projection[:2, 2] = shift
    return View((roll @ view_matrix(camera)).astype(np.float32), projection)


def in_picture(seen: View, points: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Return the mask of points (..., 3) inside the frustum, at any distance."""
    clip = np.concatenate([points, np.ones((*points.shape[:-1], 1))], -1) @ (seen.projection @ seen.view).T.astype(
        float
    )
    x, y, _, w = np.moveaxis(clip, -1, 0)
    return np.asarray((w > 0.1) & (np.abs(x) < w) & (np.abs(y) < w))


def points_of(cell: NDArray[np.int32]) -> NDArray[np.float64]:
    """Return points on and above each cell (n, 2), including its corners, shape (n, points, 3)."""
    line, up = np.linspace(0.0, 1.0, 4), np.array([-2.0, 0.0, 0.5, 1.0, 6.0])
    unit = np.stack(np.meshgrid(line, up / PATCH, line, indexing="ij"), -1).reshape(-1, 3)
    corner = np.stack([cell[:, 0], np.zeros(len(cell)), cell[:, 1]], -1)
    return np.asarray((corner[:, None] + unit) * PATCH)


def kept(seen: View, cell: NDArray[np.int32] = AROUND) -> NDArray[np.bool_]:
    x, _, z = seen.eye
    middle = ((cell + 0.5) * PATCH).astype(np.float32)
    return inside_cone(middle, apex=(x, z), cone=view_cone(seen), radius=PATCH * 0.7072)


@given(cameras, st.floats(0.4, 3.0), st.floats(-pi, pi), st.tuples(st.floats(-0.4, 0.4), st.floats(-0.4, 0.4)))
def test_t2_nothing_that_shows_in_the_picture_is_culled(
    camera: Camera, aspect: float, bank: float, shift: tuple[float, float]
) -> None:
    seen = seen_by(camera, aspect, bank, shift)
    shows = in_picture(seen, points_of(AROUND)).any(axis=1)
    assert kept(seen)[shows].all()


@given(cameras, st.floats(-pi, pi), st.integers(0, 2**32 - 1))
def test_t2_no_blade_is_left_out_any_part_of_which_shows(camera: Camera, bank: float, seed: int) -> None:
    rng, reach = np.random.default_rng(seed), 0.8
    pool, seen = BladePool(2, np.zeros(30, np.intp)), seen_by(camera, bank=bank)
    pool.stamp[:] = rng.integers(-4, 4, (4, 2))
    pool.x[:], pool.z[:] = (pool.stamp.T[..., None] + rng.random((2, 4, 30))) * PATCH
    ground = rng.uniform(-2.0, 2.0, (4, 30))
    pool.ground[:] = np.stack([ground.min(axis=1), ground.max(axis=1)], 1)
    off = rng.normal(size=(20, 4, 30, 3))
    off *= reach * rng.uniform(0.9, 1.0, (20, 4, 30, 1)) / np.linalg.norm(off, axis=-1, keepdims=True)
    shows = in_picture(seen, np.stack([pool.x, ground, pool.z], -1) + off).any(axis=0)
    assert may_be_seen(pool, np.arange(4), picture_sides(seen), reach=reach, patch=PATCH)[shows].all()


def test_t2_blades_beside_the_picture_and_behind_the_eye_are_left_out() -> None:
    pool, patch = BladePool(3, np.zeros(4, np.intp)), 20.0
    pool.stamp[:3] = (-1, -1), (9, -9), (-1, 5)
    pool.x[0], pool.z[0] = [-0.1, -9.0, -19.0, -0.1], [-10.0, -10.0, -10.0, -0.1]
    pool.x[1], pool.z[1], pool.x[2], pool.z[2] = 190.0, -170.0, -10.0, 110.0
    seen = seen_by(Camera((0.0, 1.7, 0.0), 0.0, 0.0, radians(40)))
    left = may_be_seen(pool, np.arange(3), picture_sides(seen), reach=0.8, patch=patch)
    assert left.tolist() == [[True, False, False, False], [False] * 4, [False] * 4]


@given(cameras, st.floats(0.5, 2.0))
def test_t2_what_is_kept_is_inside_the_view_cone_or_touches_it(camera: Camera, aspect: float) -> None:
    seen = seen_by(camera, aspect)
    middle, half = view_cone(seen)
    if half == pi:
        assert kept(seen).all()
        return
    away = (AROUND + 0.5) * PATCH - np.array(seen.eye)[[0, 2]]
    off = np.abs(np.mod(np.arctan2(away[:, 0], -away[:, 1]) - middle + pi, 2 * pi) - pi)
    beyond = np.hypot(*away.T) * np.sin(np.clip(off - half, 0.0, pi / 2))
    assert (beyond[kept(seen)] <= PATCH + 1e-3).all()


@given(cameras)
def test_t2_all_that_is_well_behind_a_level_camera_is_culled(camera: Camera) -> None:
    level = Camera(camera.position, camera.yaw, 0.2 * camera.pitch, min(camera.view, radians(60)))
    ahead = np.array([np.sin(level.yaw), -np.cos(level.yaw)])
    along = ((AROUND + 0.5) * PATCH - np.array(level.position)[[0, 2]]) @ ahead
    behind = along < -0.75 * PATCH
    assert behind.sum() > 100
    assert not kept(seen_by(level))[behind].any()


def test_t2_a_common_view_leaves_a_quarter_of_the_field() -> None:
    walker = Camera((0.6, 1.7, 0.9), 0.7, radians(-5), radians(40))
    assert 0.1 < kept(seen_by(walker, 16 / 9)).mean() < 0.27


@pytest.mark.parametrize("pitch", [-90, -75, 75, 90])
def test_t2_a_camera_that_looks_straight_down_or_up_sees_all_round(pitch: float) -> None:
    assert kept(seen_by(Camera((0.0, 30.0, 0.0), 1.0, radians(pitch), radians(50)))).all()


@given(cameras, st.floats(-pi, pi))
def test_t2_nothing_is_culled_that_shows_on_a_screen_that_is_turned(camera: Camera, turn: float) -> None:
    seen = seen_by(camera)
    c, s = np.cos(turn), np.sin(turn)
    turned = np.array([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) @ seen.projection
    seen = View(seen.view, turned.astype(np.float32))
    assert kept(seen)[in_picture(seen, points_of(AROUND)).any(axis=1)].all()


def test_t2_a_picture_that_is_laid_on_its_side_has_the_same_view_cone() -> None:
    seen = seen_by(Camera((0.0, 1.7, 0.0), 0.3, 0.0, radians(40)))
    on_its_side = View(seen.view, seen.projection[[1, 0, 2, 3]])
    assert view_cone(on_its_side) == pytest.approx(view_cone(seen), abs=1e-6)


def test_t2_without_perspective_nothing_is_culled() -> None:
    camera = Camera((0.0, 30.0, 0.0), 1.0, -0.3, radians(50))
    flat = np.diag([0.1, 0.1, -0.01, 1.0]).astype(np.float32)
    assert kept(View(view_matrix(camera), flat)).all()


@given(cameras)
def test_the_eye_is_found_in_the_matrix_of_a_view(camera: Camera) -> None:
    np.testing.assert_allclose(seen_by(camera, bank=0.4).eye, camera.position, atol=1e-5)


@given(cells, cells)
def test_t3_distance_is_0_here_1_around_and_grows_by_squares(cell: tuple[int, int], centre: tuple[int, int]) -> None:
    here, there = np.array([cell], np.int32), np.array(centre, np.int32)
    assert discrete_distance(here, there)[0] == max(abs(cell[0] - centre[0]), abs(cell[1] - centre[1]))


def test_t3_every_ring_has_the_patches_that_share_an_edge_or_vertex_with_the_one_before() -> None:
    distance = discrete_distance(AROUND, np.zeros(2, np.int32))
    assert [int((distance == ring).sum()) for ring in range(4)] == [1, 8, 16, 24]


@given(
    st.tuples(st.floats(0.01, 0.99), st.floats(0.01, 0.99)),
    st.floats(-pi, pi),
    st.tuples(st.integers(-1000, 1000), st.integers(-1000, 1000)),
)
def test_t5_a_ray_meets_patches_in_the_reverse_of_their_drawing_order(
    start: tuple[float, float], azimuth: float, centre: tuple[int, int]
) -> None:
    home = np.array(centre, np.int32)
    cell = AROUND + home
    rank = np.empty(len(cell), np.int64)
    rank[np.argsort(nearness(cell, home), kind="stable")] = np.arange(len(cell))
    place = np.array(start) + np.linspace(0.0, 17.0, 2000)[:, None] * (np.cos(azimuth), np.sin(azimuth))
    met = np.floor(place).astype(int)
    met = met[(np.abs(met) <= 12).all(axis=1)]
    row = (met[:, 1] + 12) * 25 + met[:, 0] + 12
    drawn = rank[row]
    assert (np.diff(drawn) <= 0).all()
    assert drawn[-1] < drawn[0]


def test_t5_the_viewers_own_patch_is_drawn_last() -> None:
    home = np.array([3, -4], np.int32)
    cell = AROUND + home
    order = np.argsort(nearness(cell, home), kind="stable")
    assert sorted(order.tolist()) == list(range(len(cell)))
    assert (cell[order[-1]] == home).all()


def around(half: float) -> Outlook:
    """Return the outlook of a viewer amid 25 by 25 patches, whose view cone along -z has a half width [rad]."""
    outlook = Outlook(Viewer(eye=(1.25, 1.7, 1.25), cone=(0.0, half)), 0, PatchTable.allocate(25, NAMES))
    outlook.patches.cell[:] = AROUND
    outlook.patches.middle[:] = (AROUND + 0.5) * PATCH
    return outlook


@pytest.mark.parametrize("sway", [0.0, 1.0])
@given(half=st.floats(0.1, 1.4), yaw=st.floats(-7.0, 7.0))
def test_t2_the_system_keeps_what_grass_that_sways_may_reach_the_view_cone_from(
    half: float, yaw: float, sway: float
) -> None:
    outlook = around(half)
    outlook.viewer.cone = (yaw, half)
    Cull([outlook], PATCH, sway).run()
    middle = ((AROUND + 0.5) * PATCH).astype(np.float32)
    expected = inside_cone(middle, apex=(1.25, 1.25), cone=(yaw, half), radius=PATCH * 0.7072 + sway)
    np.testing.assert_array_equal(outlook.patches.visible, expected)


@given(st.floats(0.1, 1.4), st.floats(-7.0, 7.0))
def test_t2_near_are_the_four_patches_whose_middles_are_around_any_place_in_the_view_cone(
    half: float, yaw: float
) -> None:
    outlook = around(half)
    outlook.viewer.cone = (yaw, half)
    Cull([outlook], PATCH, 0.0).run()
    visible, near = outlook.patches.visible, outlook.patches.near.reshape(25, 25)
    place = np.stack(np.meshgrid(np.linspace(-28.0, 30.0, 117), np.linspace(-28.0, 30.0, 117)), -1).reshape(-1, 2)
    seen = place[inside_cone(place, apex=(1.25, 1.25), cone=(yaw, half), radius=0.0)]
    low = np.floor(seen / PATCH - 0.5).astype(int) + 12
    for i, j in ((0, 0), (1, 0), (0, 1), (1, 1)):
        assert near[low[:, 1] + j, low[:, 0] + i].all()
    assert near.ravel()[visible].all()
    assert not near.all()


high = st.builds(
    Camera,
    position=st.tuples(st.floats(-9.0, 9.0), st.floats(14.0, 60.0), st.floats(-9.0, 9.0)),
    yaw=st.floats(-7.0, 7.0),
    pitch=st.floats(-1.57, -0.2),
    view=st.floats(radians(15), radians(100)),
)


@given(camera=high, bank=st.floats(-2.0, 2.0))
def test_f9_from_high_above_patches_are_kept_that_are_in_the_picture_and_no_others(camera: Camera, bank: float) -> None:
    seen, outlook = seen_by(camera, bank=bank), around(pi)
    viewer, points = outlook.viewer, points_of(AROUND)
    viewer.eye, viewer.cone, viewer.sides = seen.eye, view_cone(seen), picture_sides(seen)
    Cull([outlook], PATCH, 1.0).run()
    points = points[:, points[0, :, 1] <= 1.0]
    shown = in_picture(seen, points).any(axis=1)
    visible = outlook.patches.visible
    assert visible[shown].all()
    inside = np.concatenate([points, np.ones((*points.shape[:2], 1))], -1) @ viewer.sides.T
    assert not visible[(inside.max(axis=1) < -PATCH - 1.0).any(axis=1)].any()


def test_x1_what_was_visible_in_the_frame_before_is_known_in_the_next() -> None:
    outlook = around(0.5)
    system = Cull([outlook], PATCH, 0.4)
    system.run()
    before = outlook.patches.visible.copy()
    assert not outlook.patches.was_visible.any()
    outlook.viewer.cone = (pi, 0.5)
    system.run()
    np.testing.assert_array_equal(outlook.patches.was_visible, before)
    assert (outlook.patches.visible != before).any()
    system.run()
    np.testing.assert_array_equal(outlook.patches.was_visible, outlook.patches.visible)
