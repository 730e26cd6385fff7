"""Elevation maps that cannot be used: one sentence each, which names the file and says what to do."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from tallgrass.engine.declared.terrain import TerrainSource
from tallgrass.engine.terrain.errors import MapError
from tallgrass.engine.terrain.load import load_terrain

Writer = Callable[[Path], object]
GREY_16 = np.zeros((9, 9), np.uint16)


def refusal(path: Path, **more: Any) -> str:
    with pytest.raises(MapError) as caught:
        load_terrain(TerrainSource(heights=path.name, **more), path.parent)
    message = str(caught.value)
    assert message.startswith(f"{path.name}: ")
    assert "\n" not in message
    return message.removeprefix(f"{path.name}: ")


def picture(values: NDArray[Any], mode: str | None = None) -> Writer:
    image = Image.fromarray(values)
    return (image if mode is None else image.convert(mode)).save


def deep_png(path: Path, colour: int) -> None:
    """Write the header of a 16-bit PNG that Pillow would read as 8 bits; no more of it is read."""
    header = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR" + (9).to_bytes(4) * 2 + bytes([16, colour, 0, 0, 0]) + bytes(99)
    path.write_bytes(header)


COLOURS = "not heights; export one channel of 16-bit grey"
TERRACES = "8 bits hold only 256 heights, which would make terraces; export 16-bit grey"


@pytest.mark.parametrize(
    ("write", "words"),
    [
        (picture(np.zeros((9, 9, 3), np.uint8)), f"it holds RGB colours, {COLOURS}"),
        (picture(np.zeros((9, 9, 4), np.uint8)), f"it holds RGBA colours, {COLOURS}"),
        (picture(np.zeros((9, 9), np.uint8), "LA"), f"it holds grey and alpha, {COLOURS}"),
        (picture(np.zeros((9, 9), np.uint8), "P"), f"it holds a palette of colours, {COLOURS}"),
        (lambda path: deep_png(path, 2), f"it holds RGB colours, {COLOURS}"),
        (lambda path: deep_png(path, 4), f"it holds grey and alpha, {COLOURS}"),
        (picture(np.zeros((9, 9), np.uint8)), TERRACES),
        (picture(np.zeros((9, 9), np.bool_)), TERRACES),
        (picture(GREY_16[:, :1]), "it is 1 by 9 cells, and a map has 2 to 8193 a side"),
        (picture(np.zeros((2, 8194), np.uint16)), "it is 8194 by 2 cells, and a map has 2 to 8193 a side"),
        (lambda path: path.write_bytes(b"GIF89a" + bytes(99)), "it is no PNG file"),
        (lambda path: path.write_bytes(b""), "it is no PNG file"),
    ],
)
def test_pngs_that_hold_no_16_bit_heights_are_refused(write: Writer, words: str, tmp_path: Path) -> None:
    write(tmp_path / "map.png")
    assert refusal(tmp_path / "map.png") == words


@pytest.mark.parametrize(
    ("values", "words"),
    [
        (np.zeros(9), "it must be an array of rows and columns, not of 1 dimensions"),
        (np.zeros((9, 9, 1)), "it must be an array of rows and columns, not of 3 dimensions"),
        (np.zeros((9, 1)), "it is 1 by 9 cells, and a map has 2 to 8193 a side"),
        (np.zeros((0, 9)), "it is 9 by 0 cells, and a map has 2 to 8193 a side"),
        (np.zeros((9, 8194)), "it is 8194 by 9 cells, and a map has 2 to 8193 a side"),
        (np.zeros((9, 9), np.uint8), TERRACES),
        (np.zeros((9, 9), np.int8), TERRACES),
        (np.zeros((9, 9), np.complex64), "it holds complex64 values; heights are floats or integers"),
        (np.zeros((9, 9), np.bool_), "it holds bool values; heights are floats or integers"),
        (np.full((9, 9), "high"), "it holds <U4 values; heights are floats or integers"),
        (np.zeros((4, 4)), "it is only 3 by 3 m; give a larger cell, in metres"),
        (np.full((9, 9), 1e9), "its heights go from 1e+09 to 1e+09 m; scale them, or mark its voids"),
        (np.full((9, 9), 1e300), "its heights go from inf to inf m; scale them, or mark its voids"),
    ],
)
def test_arrays_that_are_no_map_are_refused(values: NDArray[Any], words: str, tmp_path: Path) -> None:
    np.save(tmp_path / "map.npy", values)
    assert refusal(tmp_path / "map.npy") == words


@pytest.mark.parametrize("wrong", [np.inf, -np.inf])
def test_heights_that_are_no_numbers_are_refused_with_their_count_and_first_place(wrong: float, tmp_path: Path) -> None:
    values = np.zeros((9, 12), np.float32)
    values[4, 7] = wrong
    np.save(tmp_path / "map.npy", values)
    where = "the first at row 4, column 7, counted from 0"
    assert refusal(tmp_path / "map.npy") == f"1 height is no number, {where}"
    values[5:, 2] = wrong
    np.save(tmp_path / "map.npy", values)
    assert refusal(tmp_path / "map.npy") == f"5 heights are no numbers, {where}"


def test_an_array_of_objects_is_refused_without_being_unpickled(tmp_path: Path) -> None:
    np.save(tmp_path / "map.npy", np.array([[print, 1], [2, 3]], object))
    assert refusal(tmp_path / "map.npy").startswith("it cannot be read as a NumPy array: ")


def test_an_archive_under_an_arrays_name_is_refused(tmp_path: Path) -> None:
    np.savez(tmp_path / "map.npz", heights=np.zeros((9, 9)))
    (tmp_path / "map.npz").rename(tmp_path / "map.npy")
    assert refusal(tmp_path / "map.npy") == "it is an archive of arrays, not one array"


@pytest.mark.parametrize(
    ("size", "columns", "words"),
    [
        (0, None, "its 0 bytes are no 16-bit heights"),
        (163, None, "its 163 bytes are no 16-bit heights"),
        (160, None, "its 80 heights make no square; give columns"),
        (162, 10, "its 81 heights make no whole rows of 10 columns"),
        (2, None, "it is 1 by 1 cells, and a map has 2 to 8193 a side"),
        (20, 10, "it is 10 by 1 cells, and a map has 2 to 8193 a side"),
    ],
)
@pytest.mark.parametrize("name", ["map.raw", "map.r16"])
def test_headless_files_of_the_wrong_length_are_refused(
    name: str, size: int, columns: int | None, words: str, tmp_path: Path
) -> None:
    (tmp_path / name).write_bytes(bytes(size))
    assert refusal(tmp_path / name, columns=columns) == words


@pytest.mark.parametrize("name", ["map.png", "map.npy", "map.r16", "map.tif"])
def test_a_file_that_is_not_there_or_is_a_folder_is_refused(name: str, tmp_path: Path) -> None:
    assert refusal(tmp_path / name) == "there is no such file"
    (tmp_path / name).mkdir()
    assert refusal(tmp_path / name) == "there is no such file"


@pytest.mark.parametrize("name", ["map.exr", "map.jpg", "map", "png"])
def test_other_endings_are_refused_with_those_that_there_are(name: str, tmp_path: Path) -> None:
    assert refusal(tmp_path / name) == "elevation maps are 16-bit grey .png, .r16 or .raw, .npy, or .tif files"


@pytest.mark.parametrize("name", ["map.png", "map.npy"])
def test_a_file_broken_off_anywhere_is_refused_with_one_sentence(name: str, tmp_path: Path) -> None:
    values = np.random.default_rng(0).integers(0, 65535, (20, 20)).astype(np.uint16)
    whole = tmp_path / f"whole.{name[-3:]}"
    Image.fromarray(values).save(whole) if name.endswith("png") else np.save(whole, values)
    content = whole.read_bytes()
    for length in range(0, len(content) - 30, 17):
        (tmp_path / name).write_bytes(content[:length])
        assert refusal(tmp_path / name)
