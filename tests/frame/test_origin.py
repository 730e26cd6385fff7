"""A prairie that is far off in a game's world, and a world whose origin moves."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from pyglet.math import Mat4, Vec3

from tallgrass.engine.camera import Camera
from tallgrass.systems.prairie import Prairie

Stage = Any
Load = Callable[..., Prairie]
Aim = Callable[..., Camera]

FAR_OFF = 1e5, 30.0, -1e5


def test_pictures_a_hundred_kilometres_off_are_those_at_the_origin(stage: Stage, load: Load, camera: Aim) -> None:
    prairie, aim = load(), camera(0.0, 1.7, 20.0, yaw=0.3, pitch=-8)
    view, projection = stage.matrices(aim)
    here = stage.shot(prairie, aim)
    away = view.astype(np.float64)
    away[:, 3] = away @ (*np.negative(FAR_OFF), 1.0)
    pictures = {}
    for name, origin, matrix in (("far off", FAR_OFF, away), ("no origin", (0, 0, 0), away), ("back", (0, 0, 0), view)):
        prairie.origin = origin
        stage.begin()
        prairie.draw(matrix, projection, viewer=name)
        pictures[name] = stage.read()
    assert np.abs(pictures["far off"] - here).max() <= 1.0
    np.testing.assert_array_equal(pictures["back"], here)
    assert (pictures["no origin"] != here).any(axis=-1).mean() > 0.5


def test_an_origin_that_moves_is_no_leap(stage: Stage, load: Load) -> None:
    prairie = load()
    pictures, leaps = [], []
    for x in (0.0, 4000.0, -7.5):
        prairie.origin = x, 0.0, 2.0 * x
        eye = Vec3(x, 1.7, 20.0 + 2.0 * x)
        projection = Mat4.perspective_projection(16 / 9, 0.1, 2000, 45)
        stage.begin()
        prairie.draw(Mat4.look_at(eye, eye + Vec3(0, -0.1, -1), Vec3(0, 1, 0)), projection)
        pictures.append(stage.read())
        leaps.append(prairie.viewers["main"].viewer.jumped)
        assert prairie.viewers["main"].viewer.eye == pytest.approx((0.0, 1.7, 20.0), abs=1e-3)
        assert prairie.origin == (x, 0.0, 2.0 * x)
    assert leaps == [True, False, False]
    for other in pictures[1:]:
        assert np.abs(other - pictures[0]).mean() < 1.0


@pytest.mark.parametrize("place", [(0.0, 1.0), None, (0.0, np.nan, 0.0), "far", (2e9, 0.0, 0.0), [[0.0, 0.0, 0.0]]])
def test_an_origin_that_is_no_place_is_refused_in_a_sentence(load: Load, place: Any) -> None:
    prairie = load()
    with pytest.raises(ValueError, match=r"^an origin is a place \(x, y, z\) \[m\]"):
        prairie.origin = place
    assert prairie.origin == (0.0, 0.0, 0.0)
