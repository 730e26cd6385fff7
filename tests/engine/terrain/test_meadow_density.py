"""The bundled meadow's density map: how it was made, and what it promises."""

from importlib.resources import as_file, files

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from tallgrass.engine.terrain.noise import SPACING, spline_noise

SIDE = 240.0
"""Side of the meadow's terrain [m]."""

PIXELS = 256
PATCH, CRINKLE, BORDER = 30.0, 9.0, 8.0
"""Width of a patch of one kind, of the crinkles along its border, and of the border [m]."""


def paint_patches(seed: int) -> NDArray[np.uint8]:
    """Return a picture of two kinds in red and green that share the ground in soft-edged patches."""
    cell = SIDE / PIXELS
    place = np.arange(0.5, PIXELS, dtype=np.float64) * cell
    noise = spline_noise(place * SPACING / (2 * PATCH), place * SPACING / (2 * PATCH), seed=seed).astype(np.float64)
    noise += 0.14 * spline_noise(place / CRINKLE, place / CRINKLE, seed=seed + 1)
    steep = np.hypot(*np.gradient(noise, cell))
    distance = noise / np.maximum(steep, 0.7 * np.median(steep))
    share = np.clip(0.5 + distance / BORDER, 0.0, 1.0)
    red = np.rint(255.0 * share * share * (3.0 - 2.0 * share))
    return np.stack([red, 255.0 - red, np.zeros_like(red)], axis=-1).astype(np.uint8)


@pytest.fixture(scope="module")
def meadow() -> NDArray[np.uint8]:
    with as_file(files("tallgrass.scenes") / "meadow-density.png") as path, Image.open(path) as image:
        assert image.mode == "RGB"
        return np.asarray(image)


def test_the_picture_is_what_noise_makes_of_its_seed(meadow: NDArray[np.uint8]) -> None:
    assert np.abs(meadow.astype(int) - paint_patches(11)).max() <= 1


def test_no_ground_is_bare(meadow: NDArray[np.uint8]) -> None:
    assert (meadow.astype(int).sum(axis=-1) == 255).all()


def test_each_kind_has_its_patches(meadow: NDArray[np.uint8]) -> None:
    share = meadow[..., 0] / 255.0
    assert 0.35 < share.mean() < 0.65
    assert (share > 0.98).mean() > 0.3
    assert (share < 0.02).mean() > 0.3


def test_patches_are_tens_of_metres_wide_with_borders_of_some_metres(meadow: NDArray[np.uint8]) -> None:
    red = meadow[..., 0] > 127
    crossings = (red[:, 1:] != red[:, :-1]).sum() + (red[1:] != red[:-1]).sum()
    assert 15.0 < 2 * PIXELS * SIDE / crossings < 90.0
    down, right = np.gradient(meadow[..., 0] / 255.0, SIDE / PIXELS)
    middle = np.abs(meadow[..., 0].astype(int) - 127) < 40
    width = 1.0 / np.hypot(down, right)[middle]
    assert 4.0 < np.median(width) < 8.0
