"""From pixels to places on the ground and back."""

from math import radians

import numpy as np
import pytest

from tallgrass.app.edit.pick import Sight, nearest
from tallgrass.engine.camera import Camera, View, projection_matrix, view_matrix
from tallgrass.engine.terrain.record import Terrain

SIZE = (320, 200)


def sight(terrain: Terrain, pitch: float = -20.0) -> Sight:
    camera = Camera((3.0, 6.0, 20.0), radians(15.0), radians(pitch), radians(45.0))
    return Sight(SIZE, View(view_matrix(camera), projection_matrix(camera.view, SIZE[0] / SIZE[1])), terrain)


FLAT = Terrain(np.zeros((41, 41), np.float32), 2.0)
HILLS = Terrain(np.random.default_rng(3).uniform(0.0, 1.5, (41, 41)).astype(np.float32), 2.0)


@pytest.mark.parametrize("terrain", [FLAT, HILLS], ids=["flat", "hills"])
@pytest.mark.parametrize("pixel", [(160.0, 100.0), (10.0, 20.0), (310.0, 90.0)])
def test_the_place_under_a_pixel_is_seen_at_that_pixel(terrain: Terrain, pixel: tuple[float, float]) -> None:
    seen = sight(terrain)
    place = seen.ground(pixel)
    assert place is not None
    np.testing.assert_allclose(seen.pixels_on_ground([place]), [pixel], atol=0.05)


def test_in_the_sky_there_is_no_place_and_behind_the_eye_no_pixel() -> None:
    assert sight(FLAT, pitch=30.0).ground((160.0, 100.0)) is None
    assert np.isnan(sight(FLAT).pixels([(3.0, 0.0, 60.0)])).all()


def test_a_hill_in_front_is_what_is_pointed_at() -> None:
    heights = np.zeros((41, 41), np.float32)
    heights[15:22] = 5.0
    near, far = sight(Terrain(heights, 2.0)).ground((160.0, 140.0)), sight(FLAT).ground((160.0, 140.0))
    assert near is not None
    assert far is not None
    assert near[1] > far[1]


def test_of_several_places_the_nearest_within_reach_is_taken() -> None:
    pixels = np.array([[10.0, 10.0], [np.nan, np.nan], [14.0, 10.0]])
    assert nearest((13.0, 10.0), pixels, 5.0) == 2
    assert nearest((30.0, 10.0), pixels, 5.0) is None
    assert nearest((30.0, 10.0), np.zeros((0, 2)), 5.0) is None
