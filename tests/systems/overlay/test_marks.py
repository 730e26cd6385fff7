"""Marks behind hills."""

import numpy as np

from tallgrass.engine.terrain.record import Terrain
from tallgrass.systems.overlay.marks import HIDDEN, behind_hills, filled, stroked, together, veiled

RIDGE = Terrain(np.where(np.abs(np.arange(101) - 50) <= 1, 6.0, 0.0).astype(np.float32)[:, None].repeat(101, 1), 1.0)
EYE = (0.0, 2.0, 20.0)


def test_n8_a_ridge_hides_what_is_behind_it_and_low() -> None:
    places = np.array([[0, 0, 10], [0, 0, -10], [0, 20, -10], [0, 6, 0]], np.float32)
    np.testing.assert_array_equal(behind_hills(RIDGE, EYE, places), [False, True, False, False])


def test_n8_flat_ground_hides_nothing() -> None:
    flat = Terrain(np.zeros((11, 11), np.float32), 10.0)
    places = np.random.default_rng(1).uniform(-50, 50, (200, 3)).astype(np.float32)
    assert not behind_hills(flat, EYE, places).any()


def test_n8_marks_behind_a_hill_are_faint() -> None:
    corners = np.array([[[0, 0, z], [1, 0, z], [0, 0, z - 1]] for z in (10, -10)], np.float32)
    lines = corners[:, 0], corners[:, 1]
    marks = veiled(together(filled(corners, (1, 0, 0, 0.5)), stroked(*lines, (0, 1, 0, 0.8), width=2.0)), RIDGE, EYE)
    np.testing.assert_allclose(marks.shapes["color"][:, 3], [0.5] * 3 + [0.5 * HIDDEN] * 3)
    np.testing.assert_allclose(marks.lines["color"][:, 3], [0.8, 0.8 * HIDDEN])
