"""Contrast: it measures grain, and falls with blur (G4)."""

import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass.app.bench.contrast import contrast, luma, relative_contrast, tile_side, tiled
from tallgrass.systems.reference import Truth

Picture = NDArray[np.uint8]
ALL = np.ones((180, 320), np.bool_)


def grass(seed: int = 1, grain: float = 20.0) -> Picture:
    """Return a picture of 180 lines of noise with this standard deviation."""
    noise = np.random.default_rng(seed).normal(100.0, grain, (180, 320, 1))
    return np.clip(noise, 0.0, 255.0).repeat(3, axis=2).astype(np.uint8)


def sure(picture: Picture) -> Truth:
    """Return a truth without sampling noise."""
    return Truth(picture, np.zeros(picture.shape, np.float32))


def test_a_tile_is_as_much_of_a_picture_whatever_its_size() -> None:
    assert [tile_side(lines) for lines in (1440, 720, 360, 180, 10)] == [80, 40, 20, 10, 4]


def test_tiles_hold_the_pixels_of_their_square() -> None:
    numbers = np.arange(7 * 9).reshape(7, 9)
    tiles = tiled(numbers, 3)
    assert tiles.shape == (2, 3, 9)
    np.testing.assert_array_equal(tiles[1, 2].reshape(3, 3), numbers[3:6, 6:9])


def test_luma_is_grey_for_grey() -> None:
    np.testing.assert_allclose(luma(np.full((2, 3, 3), 77, np.uint8)), 77.0)


def test_g4_the_reference_has_all_its_contrast_and_a_blur_little_of_it() -> None:
    true = grass()
    assert contrast(true, sure(true), ALL) == 1.0
    wide = true.astype(np.float64)
    blurred = np.mean([np.roll(wide, (y, x), (0, 1)) for y in range(3) for x in range(3)], axis=0)
    kept = contrast(blurred.astype(np.uint8), sure(true), ALL)
    assert kept is not None
    assert kept < 0.4


def test_one_flat_part_of_the_picture_is_not_lost_in_its_mean() -> None:
    true, seen = grass(), grass()
    seen[:, :32] = 100
    assert relative_contrast(seen, sure(true), ALL).mean() > 0.85
    assert contrast(seen, sure(true), ALL) == 0.0


def test_tiles_that_show_sky_or_are_flat_in_the_reference_are_left_out() -> None:
    true, seen, shows = grass(), grass(2), ALL.copy()
    seen[:90], shows[:89] = 100, False
    assert contrast(seen, sure(true), shows) == pytest.approx(0.9, abs=0.15)
    true[90:] = 100
    assert contrast(seen, sure(true), shows) is None


@pytest.mark.parametrize("finer", [4, 16])
def test_what_a_truth_deviates_by_for_having_few_samples_is_taken_off_in_part_and_never_in_whole(finer: int) -> None:
    """Blades are squares, smaller than the spacing of samples by this factor."""
    random = np.random.default_rng(3)
    rows, columns = np.indices((180 * 4, 320 * 4))
    blades = 255.0 * (random.random((180 * 4, 320 * 4, finer)) < 0.3 + 0.2 * np.sin(rows / 9 + columns / 7)[..., None])
    exact = blades.mean(axis=2).reshape(180, 4, 320, 4).mean(axis=(1, 3))
    samples = blades[..., 0].reshape(180, 4, 320, 4)
    white = np.indices((4, 4)).sum(axis=0)[None, :, None, :] % 2 == 0
    apart = np.where(white, samples, -samples).sum(axis=(1, 3)) / 16.0
    seen, few = (np.repeat(each[..., None], 3, axis=2) for each in (exact, samples.mean(axis=(1, 3))))
    raw = relative_contrast(seen.astype(np.uint8), sure(few.astype(np.uint8)), ALL).mean()
    truth = Truth(few.astype(np.uint8), np.repeat(apart[..., None], 3, axis=2).astype(np.float32))
    told = relative_contrast(seen.astype(np.uint8), truth, ALL).mean()
    assert raw < 0.9
    assert raw + 0.05 < told <= 1.0
