"""Figures of trees in `bench picture` (F3, N3)."""

import numpy as np
import pytest

from tallgrass.app.bench.trees import Behind, tree_figures
from tallgrass.systems.reference import Truth

pytest.importorskip("flip_evaluator")

SKY, LEAF = np.array([120, 160, 220], np.uint8), np.array([60, 90, 30], np.uint8)


def scene(*, teeth: int, leaf: np.ndarray = LEAF, grain: int = 20) -> np.ndarray:
    """Return a picture of a crown before the sky, with teeth of some pixels on its left edge and varied leaves."""
    picture = np.tile(SKY, (72, 128, 1))
    ragged = (np.arange(72) // 2 % 2 * teeth)[:, None]
    crown = np.arange(128)[None] >= 50 + ragged
    picture[crown] = leaf
    picture[crown & ((np.indices((72, 128)).sum(axis=0) % 2) == 0)] += np.uint8(grain)
    return picture


def told(picture: np.ndarray, true: np.ndarray) -> dict[str, object] | None:
    bare = np.tile(SKY, (72, 128, 1))
    behind = Behind(bare, np.ones((72, 128), bool), (true != bare).any(axis=-1))
    return tree_figures(picture, Truth(true, np.zeros((72, 128, 3), np.float32)), behind)


def test_n3_a_picture_that_is_its_reference_is_told_to_be_true() -> None:
    true = scene(teeth=8)
    assert told(true, true) == {
        "tiles": 18 * 19, "flip": 0.0, "luminance_ratio": 1.0, "hue_degrees": 0.0,
        "contrast": 1.0, "roughness_ratio": 1.0,
    }  # fmt: skip


def test_n3_darker_flatter_and_smoother_trees_are_told_of_each() -> None:
    found = told(scene(teeth=0, leaf=LEAF - 10, grain=10), scene(teeth=8))
    assert found is not None
    assert float(str(found["luminance_ratio"])) < 0.8
    assert float(str(found["contrast"])) < 0.7
    assert float(str(found["roughness_ratio"])) < 0.6
    assert float(str(found["flip"])) > 0.02


def test_n3_where_trees_cover_no_tile_nothing_is_told() -> None:
    bare = np.tile(SKY, (72, 128, 1))
    assert told(bare, bare) is None
