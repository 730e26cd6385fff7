"""Elevation models from TIFF and GeoTIFF files."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image, TiffImagePlugin

from tallgrass.engine.declared.terrain import TerrainSource
from tallgrass.engine.terrain.errors import MapError
from tallgrass.engine.terrain.load import load_terrain
from tallgrass.engine.terrain.record import Terrain

PIXEL_SCALE, TIE_POINT, GEO_KEYS, NO_DATA = 33550, 33922, 34735, 42113
SHORT, ASCII, DOUBLE = 3, 2, 12
METRES, DEGREES = (1024, 0, 1, 1), (1024, 0, 1, 2)


def save(path: Path, values: NDArray[Any], tags: dict[int, Any] | None = None, **more: Any) -> Path:
    directory = TiffImagePlugin.ImageFileDirectory_v2()
    for tag, value in (tags or {}).items():
        directory.tagtype[tag] = {GEO_KEYS: SHORT, NO_DATA: ASCII}.get(tag, DOUBLE)
        directory[tag] = value
    Image.fromarray(values).save(path, tiffinfo=directory, **more)
    return path


def survey(
    scale: tuple[float, float], key: tuple[int, ...] = METRES, north: float = 4e6, *keys: tuple[int, ...]
) -> dict[int, Any]:
    """Return the tags of a map whose cells are `scale` units long and whose first row lies at `north`."""
    listed = [key, *keys]
    numbers = (1, 1, 0, len(listed), *(number for entry in listed for number in entry))
    return {PIXEL_SCALE: (*scale, 0.0), TIE_POINT: (0.0, 0.0, 0.0, 500.0, north, 0.0), GEO_KEYS: numbers}


def load(path: Path, **more: Any) -> Terrain:
    return load_terrain(TerrainSource(heights=path.name, **more), path.parent)


def ground(rows: int = 12, columns: int = 10) -> NDArray[np.float32]:
    return (200 + np.arange(rows)[:, None] + 3 * np.arange(columns)[None, :]).astype(np.float32)


@pytest.mark.parametrize("compression", [None, "tiff_lzw", "tiff_adobe_deflate"])
def test_float_metres_come_back_exactly_from_any_compression(compression: str | None, tmp_path: Path) -> None:
    path = save(tmp_path / "dem.tif", ground(), survey((2.0, 2.0)), compression=compression)
    terrain = load(path)
    np.testing.assert_array_equal(terrain.heights, ground())
    assert terrain.cell == 2.0


def test_signed_integers_are_metres_and_unsigned_ones_only_where_the_ground_was_surveyed(tmp_path: Path) -> None:
    values = ground().astype(np.uint16)
    np.testing.assert_array_equal(load(save(tmp_path / "a.tif", values.astype(np.int32))).heights, values)
    np.testing.assert_array_equal(load(save(tmp_path / "b.tif", values, survey((2.0, 2.0)))).heights, values)
    np.testing.assert_allclose(load(save(tmp_path / "c.tif", values)).heights, values * (100 / 65535), rtol=1e-6)


def test_the_file_says_how_wide_its_cells_are_unless_the_scene_does(tmp_path: Path) -> None:
    path = save(tmp_path / "dem.tif", ground(), survey((10.0, 10.0)))
    assert load(path).size == pytest.approx((90.0, 110.0))
    assert load(path, cell=1.0).size == pytest.approx((9.0, 11.0))
    assert load(path, cell=20.0).size == pytest.approx((180.0, 220.0))


def test_cells_that_are_longer_one_way_than_the_other_become_square(tmp_path: Path) -> None:
    terrain = load(save(tmp_path / "dem.tif", ground(), survey((10.0, 20.0))))
    assert terrain.size == pytest.approx((90.0, 220.0))
    np.testing.assert_allclose(terrain.heights[::8, ::4], ground(), atol=1e-3)


@pytest.mark.parametrize(("code", "unit"), [(9001, 1.0), (9002, 0.3048), (9003, 1200 / 3937)])
def test_feet_are_brought_to_metres(code: int, unit: float, tmp_path: Path) -> None:
    path = save(tmp_path / "dem.tif", ground(), survey((30.0, 30.0), METRES, 4e6, (3076, 0, 1, code)))
    assert load(path).size == pytest.approx((270.0 * unit, 330.0 * unit))


def test_an_unknown_unit_of_length_asks_for_the_cell_and_takes_it(tmp_path: Path) -> None:
    path = save(tmp_path / "dem.tif", ground(), survey((30.0, 30.0), METRES, 4e6, (3076, 0, 1, 9036)))
    with pytest.raises(MapError, match=r"^dem\.tif: its unit of length is not known; give cell in metres$"):
        load(path)
    assert load(path, cell=2.0).cell == 2.0


def test_degrees_are_brought_to_metres_at_the_maps_latitude(tmp_path: Path) -> None:
    second = 1.0 / 3600.0
    path = save(tmp_path / "dem.tif", ground(12, 10), survey((second, second), DEGREES, 60.0))
    assert load(path).size == pytest.approx((9 * 30.887 * 0.5, 11 * 30.887), rel=0.01)


@pytest.mark.parametrize(
    ("mark", "tag"),
    [(-3.4028234663852886e38, "-3.4028234663852886e+38"), (float("nan"), "nan"), (0.0, "0"), (-9999.0, None)],
)
def test_marked_voids_are_filled_from_around(mark: float, tag: str | None, tmp_path: Path) -> None:
    holed = ground(40, 30)
    holed[5:9, 7:14] = mark
    tags = survey((2.0, 2.0)) | ({} if tag is None else {NO_DATA: tag})
    terrain = load(save(tmp_path / "dem.tif", holed, tags), offset=10.0)
    np.testing.assert_allclose(terrain.heights, ground(40, 30) + 10.0, atol=8.0)
    np.testing.assert_array_equal(terrain.heights[10:], ground(40, 30)[10:] + 10.0)


def test_the_voids_of_shuttle_radar_integers_are_filled(tmp_path: Path) -> None:
    holed = ground(40, 30).astype(np.int32)
    holed[20:24, 3:5] = -32768
    assert load(save(tmp_path / "dem.tif", holed)).heights.min() >= 190.0


def test_a_map_that_is_mostly_void_is_refused(tmp_path: Path) -> None:
    holed = ground(40, 30)
    holed[:, 10:] = -9999.0
    with pytest.raises(MapError, match=r"^dem\.tif: 67% of it has no height; at most half may be filled"):
        load(save(tmp_path / "dem.tif", holed))


def test_values_that_are_no_number_and_not_marked_as_voids_are_refused(tmp_path: Path) -> None:
    holed = ground()
    holed[3, 4] = np.nan
    holed[5, 5] = np.inf
    with pytest.raises(MapError, match=r"^dem\.tif: 2 heights are no numbers, the first at row 3, column 4,"):
        load(save(tmp_path / "dem.tif", holed, {NO_DATA: "-1"}))


def test_an_unmarked_void_of_a_huge_number_is_refused(tmp_path: Path) -> None:
    holed = ground()
    holed[3, 4] = -3.4e38
    with pytest.raises(MapError, match=r"^dem\.tif: its heights go from -3\.4e\+38 to 238 m; .* mark its voids$"):
        load(save(tmp_path / "dem.tif", holed))


@pytest.mark.parametrize(
    ("values", "words"),
    [
        (np.zeros((9, 9, 3), np.uint8), "it has several bands or colours; export one band of heights"),
        (np.zeros((9, 9, 4), np.uint8), "it has several bands or colours; export one band of heights"),
        (np.zeros((9, 9), np.uint8), "8 bits hold only 256 heights, which would make terraces; export 16-bit grey"),
        (np.zeros((9, 9), np.bool_), "8 bits hold only 256 heights, which would make terraces; export 16-bit grey"),
        (np.zeros((1, 9), np.float32), "it is 9 by 1 cells, and a map has 2 to 8193 a side"),
    ],
)
def test_tiffs_without_a_band_of_heights_are_refused(values: NDArray[Any], words: str, tmp_path: Path) -> None:
    with pytest.raises(MapError) as refusal:
        load(save(tmp_path / "dem.tif", values))
    assert str(refusal.value) == f"dem.tif: {words}"


def test_a_tiff_broken_off_anywhere_is_refused_with_one_sentence(tmp_path: Path) -> None:
    whole = save(tmp_path / "dem.tif", ground(), survey((2.0, 2.0)), compression="tiff_lzw").read_bytes()
    broken = tmp_path / "broken.tif"
    for length in range(0, len(whole) - 8, 7):
        broken.write_bytes(whole[:length])
        with pytest.raises(MapError, match=r"^broken\.tif: .*\Z"):
            load(broken)
