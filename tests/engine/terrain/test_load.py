"""Elevation map files of every format, as terrains."""

import logging
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from tallgrass.engine.camera import camera_at
from tallgrass.engine.declared.camera import CameraSource
from tallgrass.engine.declared.terrain import TerrainSource
from tallgrass.engine.terrain.load import RANGE, load_terrain
from tallgrass.engine.terrain.record import Terrain
from tallgrass.engine.terrain.sample import height_at, slope_at

Map = NDArray[Any]


def steps(rows: int = 6, columns: int = 9) -> NDArray[np.uint16]:
    """Return a map of whole numbers no two of which are alike."""
    return (np.arange(rows * columns, dtype=np.uint32) * 1111 % 65521).astype(np.uint16).reshape(rows, columns)


def save(path: Path, values: Map) -> Path:
    if path.suffix in (".png", ".tif", ".tiff"):
        Image.fromarray(values).save(path)
    elif path.suffix == ".npy":
        np.save(path, values)
    else:
        values.tofile(path)
    return path


def load(path: Path, **more: Any) -> Terrain:
    return load_terrain(TerrainSource(heights=path.name, **more), path.parent)


@pytest.mark.parametrize("name", ["map.png", "map.npy", "map.tif", "map.tiff"])
def test_t1_16_bit_heights_come_back_exactly(name: str, tmp_path: Path) -> None:
    terrain = load(save(tmp_path / name, steps()), scale=6553.5)
    np.testing.assert_allclose(terrain.heights, steps() / 10.0, rtol=1e-6)
    assert (terrain.cell, terrain.size) == (1.0, (8.0, 5.0))
    assert terrain.heights.dtype == np.float32
    assert terrain.heights.flags.c_contiguous


@pytest.mark.parametrize("name", ["map.r16", "map.raw"])
@pytest.mark.parametrize(("order", "dtype"), [("little", "<u2"), ("big", ">u2")])
def test_headless_heights_come_back_exactly_in_either_byte_order(
    name: str, order: str, dtype: str, tmp_path: Path
) -> None:
    square = save(tmp_path / name, steps(7, 7).astype(dtype))
    np.testing.assert_allclose(load(square, scale=6553.5, byte_order=order).heights, steps(7, 7) / 10.0, rtol=1e-6)
    oblong = save(tmp_path / name, steps(6, 9).astype(dtype))
    terrain = load(oblong, scale=6553.5, byte_order=order, columns=9)
    np.testing.assert_allclose(terrain.heights, steps(6, 9) / 10.0, rtol=1e-6)


@pytest.mark.parametrize("dtype", [np.float16, np.float32, np.float64, ">f4", np.int16, np.int32, np.int64])
def test_floats_and_signed_integers_are_metres(dtype: Any, tmp_path: Path) -> None:
    metres = np.linspace(-30, 200, 60).reshape(6, 10).astype(dtype)
    path = save(tmp_path / "map.npy", metres)
    np.testing.assert_allclose(load(path).heights, metres.astype(np.float64), rtol=1e-6)
    halved = metres.astype(np.float64) / 2.0 + 7.0
    np.testing.assert_allclose(load(path, scale=0.5, offset=7.0).heights, halved, rtol=1e-6)


@pytest.mark.parametrize("dtype", [np.uint16, np.uint32])
def test_unsigned_integers_span_a_hundred_metres_unless_the_scene_says_otherwise(dtype: Any, tmp_path: Path) -> None:
    top = np.iinfo(dtype).max
    path = save(tmp_path / "map.npy", np.array([[0, top]] * 6 + [[top // 2, top]] * 6, dtype).repeat(6, axis=1))
    for scale, whole in ((None, RANGE), (30.0, 30.0), (-30.0, -30.0)):
        heights = load(path, scale=scale, offset=5.0).heights
        np.testing.assert_allclose(heights[[0, 0, -1], [0, -1, 0]], [5.0, 5.0 + whole, 5.0 + whole / 2], rtol=1e-3)


@pytest.mark.parametrize("name", ["map.npy", "map.r16", "map.png"])
def test_the_first_row_lies_at_minus_z_and_flip_turns_that_round(name: str, tmp_path: Path) -> None:
    path = save(tmp_path / name, steps(8, 8))
    far_left = np.array([[-3.5, -3.5]], np.float32)
    near_left = np.array([[-3.5, 3.5]], np.float32)
    as_it_is, flipped = (load(path, scale=6553.5, flip=flip) for flip in (False, True))
    assert height_at(as_it_is, far_left)[0] == pytest.approx(steps(8, 8)[0, 0] / 10.0, abs=0.01)
    assert height_at(flipped, near_left)[0] == pytest.approx(steps(8, 8)[0, 0] / 10.0, abs=0.01)
    np.testing.assert_array_equal(flipped.heights, as_it_is.heights[::-1])


def test_cells_that_are_fine_enough_are_left_as_they_are(tmp_path: Path) -> None:
    terrain = load(save(tmp_path / "map.npy", np.ones((40, 30), np.float32)), cell=2.5)
    assert (terrain.heights.shape, terrain.cell) == ((40, 30), 2.5)


@pytest.mark.parametrize("cell", [3.0, 5.0, 10.0, 30.0, 7.3])
def test_coarse_cells_are_divided_into_fine_ones_through_the_same_corners(cell: float, tmp_path: Path) -> None:
    metres = np.random.default_rng(0).uniform(0, 20, (12, 9)).astype(np.float32)
    terrain = load(save(tmp_path / "map.npy", metres), cell=cell)
    parts = round(cell / terrain.cell)
    assert terrain.cell <= 2.5
    assert terrain.size == pytest.approx((8 * cell, 11 * cell))
    np.testing.assert_allclose(terrain.heights[::parts, ::parts], metres, atol=1e-4)


def hills(rows: int, columns: int, cell: float) -> NDArray[np.float32]:
    """Return a height model of hills 900 m apart between 1000 and 1400 m."""
    z, x = (np.arange(count) * cell for count in (rows, columns))
    return (1200 + 200 * np.sin(z / 143)[:, None] * np.cos(x / 143)[None, :]).astype(np.float32)


def test_a_real_world_height_model_of_30_metre_cells_looks_smooth_and_carries_the_camera(tmp_path: Path) -> None:
    terrain = load(save(tmp_path / "dem.tif", hills(300, 400, 30.0)[:, :340]), cell=30.0)
    assert terrain.cell == 2.5
    assert terrain.size == pytest.approx((339 * 30.0, 299 * 30.0))
    walk = np.zeros((4000, 2), np.float32)
    walk[:, 0] = np.arange(4000) * 0.5 - 1000
    turns = np.abs(np.diff(slope_at(terrain, walk)[:, 0]))
    assert turns.max() < 0.03
    camera = camera_at(CameraSource(), None, lambda place: height_at(terrain, place))
    ground = float(height_at(terrain, np.zeros((1, 2), np.float32))[0])
    assert camera.position == pytest.approx((0.0, ground + 1.7, 0.0))
    assert 1000 <= ground <= 1400


def test_a_map_wider_than_ten_kilometres_is_cut_to_its_middle_and_says_so(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    metres = hills(200, 600, 30.0)
    with caplog.at_level(logging.WARNING):
        terrain = load(save(tmp_path / "wide.npy", metres), cell=30.0)
    assert caplog.messages == ["wide.npy is 17970 by 5970 m; only its middle 10240 m are used"]
    assert terrain.size == pytest.approx((10240.0, 5970.0), abs=2.5)
    middle = np.array([[15.0, 15.0], [-15.0, -15.0]], np.float32)
    np.testing.assert_allclose(height_at(terrain, middle), [metres[100, 300], metres[99, 299]], atol=0.05)


@pytest.mark.parametrize("size", [[240.0, 180.0], [90.0, 5000.0]])
def test_a_size_keeps_the_middle_of_a_map_and_no_more_than_there_is(
    size: list[float], tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    metres = hills(200, 600, 30.0)
    path = save(tmp_path / "wide.npy", metres)
    with caplog.at_level(logging.WARNING):
        terrain = load(path, cell=30.0, size=size)
    assert caplog.messages == []
    assert terrain.size == pytest.approx((min(size[0], 17970.0), min(size[1], 5970.0)), abs=2.5)
    middle = np.array([[15.0, 15.0], [-15.0, -45.0]], np.float32)
    np.testing.assert_allclose(height_at(terrain, middle), [metres[100, 300], metres[98, 299]], atol=0.05)


def test_what_only_noise_needs_may_stay_beside_a_file(tmp_path: Path) -> None:
    path = save(tmp_path / "map.npy", hills(20, 20, 30.0))
    np.testing.assert_array_equal(load(path, seed=3, feature=2.5).heights, load(path).heights)


def test_more_samples_than_are_kept_are_shrunk_without_moving_the_ground(tmp_path: Path) -> None:
    slope = np.linspace(0, 100, 6001, dtype=np.float32)[None, :].repeat(40, axis=0)
    terrain = load(save(tmp_path / "long.npy", slope), cell=0.5)
    assert terrain.heights.shape[1] == 4097
    assert terrain.size[0] == pytest.approx(3000.0)
    place = np.array([[-1500, 0], [-700, 3], [0, 0], [1500, -3]], np.float32)
    np.testing.assert_allclose(height_at(terrain, place), [0, 80 / 3, 50, 100], atol=0.01)
