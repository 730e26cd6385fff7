"""Strokes on density maps."""

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from tallgrass.app.edit.brush import Brush, new_picture, read_picture, stroked
from tallgrass.engine.terrain.record import Density

SIZE = (40.0, 20.0)
EMPTY = np.zeros((40, 80, 3), np.uint8)


def line(*places: tuple[float, float]) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    return np.array(places, np.float64).reshape(-1, 2)


def test_a_dab_is_full_in_its_middle_and_ends_at_its_radius_in_its_channel_alone() -> None:
    painted = stroked(EMPTY, "green", Brush("a", radius=4.0, pressure=1.0), line((10.0, -5.0)), SIZE)
    rows, columns = np.nonzero(painted[..., 1])
    x, z = (columns + 0.5) / 2 - 20.0, (rows + 0.5) / 2 - 10.0
    assert np.hypot(x - 10.0, z + 5.0).max() < 4.0
    assert painted[9:11, 59:61, 1].min() > 240
    assert not painted[..., ::2].any()
    assert not EMPTY.any()


def test_a_stroke_has_no_gaps_however_far_apart_its_places_are() -> None:
    painted = stroked(EMPTY, "red", Brush("a", radius=2.0, pressure=1.0), line((-15.0, 0.0), (15.0, 0.0)), SIZE)
    assert painted[19:21, 12:68, 0].min() > 200


def test_a_stroke_in_pieces_comes_to_the_same_as_in_one() -> None:
    brush = Brush("a", radius=3.0, pressure=1.0)
    whole = stroked(EMPTY, "red", brush, line((-10.0, 0.0), (-4.0, 0.0), (2.0, 3.0)), SIZE)
    half = stroked(EMPTY, "red", brush, line((-10.0, 0.0), (-4.0, 0.0)), SIZE)
    pieces = stroked(half, "red", brush, line((-4.0, 0.0), (2.0, 3.0)), SIZE)
    assert np.abs(whole.astype(int) - pieces).max() <= 2


def test_erasing_leads_to_nothing_and_half_the_density_to_half() -> None:
    full = np.full_like(EMPTY, 255)
    erased = stroked(full, "red", Brush("a", pressure=1.0).erasing(), line((0.0, 0.0), (1.0, 0.0)), SIZE)
    assert erased[..., 0].min() < 10
    half = stroked(full, "red", Brush("a", density=0.5, pressure=1.0), line(*[(0.0, 0.0)] * 9), SIZE)
    assert half[..., 0].min() == pytest.approx(128, abs=1)


def test_a_channel_that_a_map_does_not_have_is_not_painted_in() -> None:
    with pytest.raises(ValueError, match="no alpha channel"):
        stroked(EMPTY, "alpha", Brush("a"), line((0.0, 0.0)), SIZE)


def test_a_new_map_says_what_was_true() -> None:
    maps = np.random.default_rng(1).uniform(0.0, 1.0, (2, 20, 40)).astype(np.float32)
    made = new_picture(Density(maps, SIZE), 1)
    assert made.shape == (40, 80, 3)
    np.testing.assert_allclose(made[::2, ::2, 0].mean() / 255.0, maps[1].mean(), atol=0.05)
    assert new_picture(Density(maps, (4000.0, 1000.0)), 0).shape == (256, 1024, 3)
    assert min(new_picture(Density(maps, (8.0, 8.0)), 0).shape[:2]) == 64


@pytest.mark.parametrize("mode", ["L", "P", "RGB", "RGBA", "LA", "I;16"])
def test_maps_of_all_modes_can_be_painted_on(mode: str, tmp_path: Path) -> None:
    values = np.arange(0, 240, 10).astype(np.uint8).reshape(4, 6)
    image = Image.fromarray(values.astype(np.uint16) * 257) if mode == "I;16" else Image.fromarray(values).convert(mode)
    image.save(tmp_path / "map.png")
    picture = read_picture(tmp_path / "map.png")
    assert picture.dtype == np.uint8
    assert picture.shape == (4, 6, 4 if mode.endswith("A") else 3)
    np.testing.assert_array_equal(picture[..., 0], values)
