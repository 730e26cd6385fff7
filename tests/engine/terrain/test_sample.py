"""Heights, slopes and densities at any place."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tallgrass.components.arrays import Doubles, Floats
from tallgrass.engine.terrain.record import Density, Terrain
from tallgrass.engine.terrain.sample import density_at, height_at, own_density_at, slope_at

coefficients = st.floats(-3.0, 3.0)
sides = st.integers(2, 12)
cells = st.sampled_from([0.5, 1.0, 2.5, 7.0])


def rough(rows: int = 9, columns: int = 14, cell: float = 2.0) -> Terrain:
    return Terrain(np.random.default_rng(5).uniform(-4, 4, (rows, columns)).astype(np.float32), cell)


def corners(terrain: Terrain) -> tuple[Doubles, Doubles]:
    """Return x (columns,) and z (rows,) of the samples."""
    rows, columns = terrain.heights.shape
    x, z = terrain.origin
    columns_x = np.arange(columns, dtype=np.float64) * terrain.cell + x
    return columns_x, np.arange(rows, dtype=np.float64) * terrain.cell + z


def inside(terrain: Terrain, count: int = 3000, seed: int = 0) -> Floats:
    half = np.array(terrain.size) / 2
    return np.random.default_rng(seed).uniform(-half, half, (count, 2)).astype(np.float32)


@given(level=coefficients, a=coefficients, b=coefficients, rows=sides, columns=sides, cell=cells)
def test_t1_heights_and_slopes_on_a_plane_are_exact(
    level: float, a: float, b: float, rows: int, columns: int, cell: float
) -> None:
    empty = Terrain(np.zeros((rows, columns), np.float32), cell)
    x, z = corners(empty)
    terrain = Terrain((level + a * x[None, :] + b * z[:, None]).astype(np.float32), cell)
    place = inside(terrain, 50)
    np.testing.assert_allclose(height_at(terrain, place), level + a * place[:, 0] + b * place[:, 1], atol=2e-4)
    np.testing.assert_allclose(slope_at(terrain, place), np.tile([a, b], (50, 1)), atol=1e-3)


def test_row_0_lies_at_minus_z_and_column_0_at_minus_x() -> None:
    heights = np.zeros((5, 9), np.float32)
    heights[0, 0], heights[0, -1], heights[-1, 0], heights[2, 4] = 1.0, 2.0, 3.0, 4.0
    place = np.array([[-8, -4], [8, -4], [-8, 4], [0, 0], [8, 4]], np.float32)
    np.testing.assert_array_equal(height_at(Terrain(heights, 2.0), place), [1, 2, 3, 4, 0])


def test_every_sample_has_its_own_height() -> None:
    terrain = rough()
    x, z = corners(terrain)
    place = np.stack(np.meshgrid(x, z), -1).reshape(-1, 2).astype(np.float32)
    np.testing.assert_allclose(height_at(terrain, place), terrain.heights.ravel(), atol=1e-5)


def test_between_samples_heights_are_bilinear() -> None:
    terrain = Terrain(np.array([[0, 1], [2, 7]], np.float32), 4.0)
    place = np.array([[0, 0], [1, 0], [0, -1]], np.float32)
    np.testing.assert_allclose(height_at(terrain, place), [2.5, 3.25, 1.5])


def test_heights_are_continuous_across_the_borders_of_cells() -> None:
    terrain = rough()
    x, z = corners(terrain)
    for axis, borders in enumerate((x[1:-1], z[1:-1])):
        place = inside(terrain, 400, seed=axis)
        place[:, axis] = np.resize(borders, 400)
        step = np.zeros(2, np.float32)
        step[axis] = 1e-3
        np.testing.assert_allclose(height_at(terrain, place - step), height_at(terrain, place + step), atol=0.02)


@given(x=st.floats(-1e5, 1e5), z=st.floats(-1e5, 1e5))
def test_beyond_the_terrain_its_nearest_edge_holds(x: float, z: float) -> None:
    terrain = rough()
    half = np.array(terrain.size) / 2
    place = np.array([[x, z]], np.float32)
    nearest = np.clip(place, -half, half).astype(np.float32)
    np.testing.assert_allclose(height_at(terrain, place), height_at(terrain, nearest), atol=1e-4)
    assert np.isfinite(slope_at(terrain, place)).all()


MIRRORED = replace(rough(), mirrored=True)
SEEN = Terrain(np.pad(rough().heights, ((24, 24), (39, 39)), mode="reflect"), 2.0)
"""The terrain with its mirror images: three to each side, and a part of the fourth."""


def test_mirrored_ground_goes_on_as_what_is_seen_in_a_mirror_along_its_edges() -> None:
    place = inside(SEEN, 4000)
    assert (np.abs(place) > np.array(MIRRORED.size) / 2).any(axis=1).mean() > 0.9
    np.testing.assert_allclose(height_at(MIRRORED, place), height_at(SEEN, place), atol=1e-3)
    part = (place - np.array(SEEN.origin)) / SEEN.cell % 1.0
    between = ((part > 0.01) & (part < 0.99)).all(axis=1)
    np.testing.assert_allclose(slope_at(MIRRORED, place)[between], slope_at(SEEN, place)[between], atol=1e-3)


def test_on_the_terrain_itself_nothing_is_other_where_it_is_mirrored_beyond() -> None:
    place, level = inside(MIRRORED), rough()
    np.testing.assert_array_equal(height_at(MIRRORED, place), height_at(level, place))
    np.testing.assert_array_equal(slope_at(MIRRORED, place), slope_at(level, place))


@pytest.mark.parametrize("axis", [0, 1])
@pytest.mark.parametrize("times", [-3, -1, 1, 3])
def test_mirrored_heights_are_continuous_over_the_edges(axis: int, times: int) -> None:
    place = inside(MIRRORED, 400)
    place[:, axis] = times * MIRRORED.size[axis] / 2
    step = np.zeros(2, np.float32)
    step[axis] = 1e-3
    ends = height_at(MIRRORED, place - step), height_at(MIRRORED, place + step)
    np.testing.assert_allclose(*ends, atol=2e-3)
    slopes = slope_at(MIRRORED, place - step), slope_at(MIRRORED, place + step)
    np.testing.assert_allclose(slopes[0][:, axis], -slopes[1][:, axis], atol=1e-3)
    np.testing.assert_allclose(slopes[0][:, 1 - axis], slopes[1][:, 1 - axis], atol=2e-2)


def test_the_slope_is_that_of_the_heights() -> None:
    terrain = rough()
    place = inside(terrain)
    cell = (place + np.array(terrain.size) / 2) / terrain.cell % 1.0
    place = place[((cell > 0.05) & (cell < 0.95)).all(axis=1)]
    for axis in (0, 1):
        step = np.zeros(2, np.float32)
        step[axis] = 0.05
        rise = height_at(terrain, place + step) - height_at(terrain, place - step)
        np.testing.assert_allclose(slope_at(terrain, place)[:, axis], rise / 0.1, atol=2e-3)


@pytest.mark.parametrize("count", [0, 1, 12287, 12288, 12289, 30000])
def test_any_number_of_places_gives_what_each_gives_alone(count: int) -> None:
    terrain = rough()
    density = Density(np.random.default_rng(1).random((3, 8, 5)).astype(np.float32), terrain.size)
    place = inside(terrain, max(count, 1))[:count]
    height, slope, dense = height_at(terrain, place), slope_at(terrain, place), density_at(density, place)
    assert (height.shape, slope.shape, dense.shape) == ((count,), (count, 2), (3, count))
    assert {height.dtype, slope.dtype, dense.dtype} == {np.dtype(np.float32)}
    for k in range(0, count, 5000):
        alone = place[k : k + 1]
        assert height_at(terrain, alone)[0] == height[k]
        assert (slope_at(terrain, alone)[0] == slope[k]).all()
        assert (density_at(density, alone)[:, 0] == dense[:, k]).all()


@pytest.mark.parametrize("count", [0, 1, 12289])
def test_the_density_of_ones_own_kind_is_that_of_all_kinds_at_it(count: int) -> None:
    terrain, chosen = rough(), np.random.default_rng(4)
    density = Density(chosen.random((9, 8, 5)).astype(np.float32), terrain.size)
    place, kind = inside(terrain, max(count, 1))[:count], chosen.integers(0, 9, count)
    own = own_density_at(density, kind, place)
    assert own.dtype == np.float32
    np.testing.assert_array_equal(own, density_at(density, place)[kind, np.arange(count)])


def test_a_density_is_that_of_a_pixel_in_its_middle_and_at_the_outer_edge() -> None:
    maps = np.arange(12, dtype=np.float32).reshape(1, 3, 4) / np.float32(12)
    density = Density(maps, (8.0, 9.0))
    middle = np.array([[-3, -3], [3, -3], [1, 0], [3, 3]], np.float32)
    np.testing.assert_allclose(density_at(density, middle)[0] * 12, [0, 3, 6, 11], atol=1e-5)
    edge = np.array([[-4, -4.5], [4, 4.5], [100, 100], [2, 0]], np.float32)
    np.testing.assert_allclose(density_at(density, edge)[0] * 12, [0, 11, 11, 6.5], atol=1e-5)
