"""The rasteriser."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from tallgrass.systems.grow import raster
from tallgrass.systems.grow.raster import interpolate, rasterise, ribbon_triangles

STAGGER = np.array([0.125, 0.625, 0.375, 0.875])


def samples(rows: int, columns: int) -> NDArray[Any]:
    row, column = np.mgrid[:rows, :columns]
    return np.asarray(np.stack([column + STAGGER[row % 4], row + 0.5], axis=-1).reshape(-1, 2))


def inside(corners: NDArray[Any], points: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return barycentric weights and whether they are all positive, for every triangle and point."""
    a, b, c = (corners[:, None, k] for k in range(3))

    def twice(p: NDArray[Any], q: NDArray[Any], r: NDArray[Any]) -> NDArray[Any]:
        one, two = q - p, r - p
        return np.asarray(one[..., 0] * two[..., 1] - one[..., 1] * two[..., 0])

    whole = twice(a, b, c)
    weights = np.stack([twice(points, b, c), twice(a, points, c), twice(a, b, points)], axis=-1) / whole[..., None]
    return weights, (weights > 0.0).all(axis=-1)


def brute(
    corners: NDArray[Any], nearness: NDArray[Any], rows: int, columns: int, offsets: NDArray[Any]
) -> NDArray[Any]:
    points = samples(rows, columns)
    near = np.full(points.shape[0], -np.inf)
    which = np.full(points.shape[0], -1)
    for offset in offsets:
        weights, hit = inside(corners + offset, points)
        depth = np.where(hit, (weights * nearness[:, None]).sum(axis=-1), -np.inf)
        best = depth.argmax(axis=0)
        value = depth.max(axis=0)
        closer = value > near
        near, which = np.where(closer, value, near), np.where(closer, best, which)
    return which


@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), wrap=st.booleans(), shift=st.sampled_from([0, 4, 8]), count=st.integers(1, 40))
def test_every_sample_shows_the_nearest_triangle_over_it(*, seed: int, wrap: bool, shift: int, count: int) -> None:
    random = np.random.default_rng(seed)
    rows, columns = 12, 17
    corners = random.uniform(-0.4, 1.4, (count, 3, 2)) * [columns, rows]
    nearness = random.uniform(0.0, 1.0, (count, 3))
    turns = [(x * columns, y * rows + x * shift) for x in range(-2, 3) for y in range(-4, 5)] if wrap else [(0, 0)]
    seen = rasterise(corners, nearness, shape=(rows, columns), wrap=wrap, shift=shift)
    shown = np.full(rows * columns, -1)
    shown[seen.sample] = seen.triangle
    np.testing.assert_array_equal(shown, brute(corners, nearness, rows, columns, np.array(turns, np.float64)))


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_chunks_make_no_difference(seed: int) -> None:
    random = np.random.default_rng(seed)
    corners, nearness = random.uniform(0.0, 20.0, (30, 3, 2)), random.uniform(0.0, 1.0, (30, 3))
    whole = rasterise(corners, nearness, shape=(20, 20))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(raster, "CHUNK", 7)
        parts = rasterise(corners, nearness, shape=(20, 20))
    np.testing.assert_array_equal(whole.sample, parts.sample)
    np.testing.assert_array_equal(whole.triangle, parts.triangle)


def test_what_is_linear_over_a_triangle_comes_back_at_its_samples() -> None:
    corners = np.array([[[0.0, 0.0], [30.0, 2.0], [4.0, 20.0]]])
    seen = rasterise(corners, np.zeros((1, 3)), shape=(20, 30))
    values = interpolate(corners, 3.0 + corners @ np.array([0.5, -0.25]), seen)
    np.testing.assert_allclose(values, 3.0 + 0.5 * seen.x - 0.25 * seen.y, atol=1e-12)


def test_a_triangle_over_the_edge_comes_in_on_the_other_side_with_its_own_values() -> None:
    corners = np.array([[[8.0, 2.0], [14.0, 2.0], [8.0, 8.0]]])
    seen = rasterise(corners, np.zeros((1, 3)), shape=(10, 10), wrap=True)
    column = seen.sample % 10
    assert {0, 1, 8, 9} <= set(column.tolist())
    assert (seen.x[column < 5] > 10.0).all()


def test_neighbouring_triangles_leave_no_gap_and_share_no_sample() -> None:
    left = np.array([[[2.0, 1.0], [3.3, 6.0], [2.1, 11.0]]])
    ribbon = ribbon_triangles(left, left + np.array([3.7, 0.4]))
    alone = sum(rasterise(part[None], np.zeros((1, 3)), shape=(12, 12)).sample.size for part in ribbon)
    together = rasterise(ribbon, np.zeros((4, 3)), shape=(12, 12)).sample.size
    assert alone == together
    assert together == pytest.approx(37, abs=4)


@pytest.mark.parametrize("corners", [np.zeros((0, 3, 2)), np.full((3, 3, 2), 4.0), np.full((1, 3, 2), 1e6)])
def test_nothing_to_see_is_nothing_seen(corners: NDArray[Any]) -> None:
    seen = rasterise(corners, np.zeros(corners.shape[:2]), shape=(8, 8))
    assert seen.sample.size == 0
