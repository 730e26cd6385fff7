"""Terrain from a program's function (N5, T2)."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from tallgrass.components.arrays import Doubles
from tallgrass.engine.scene import SceneError, load_maps, read_scene
from tallgrass.engine.terrain.load import SQUARE
from tallgrass.engine.terrain.record import Terrain

Heights = Callable[[Doubles, Doubles], object]


def of(heights: Heights, **keys: object) -> dict[str, Any]:
    """A scene on the ground that a function describes."""
    terrain = {"heights": heights, "size": [1200.0, 400.0], "cell": 2.0, **keys}
    return {"tallgrass": 2, "terrain": terrain, "grass": {"a": {}}}


def terrain_of(heights: Heights, **keys: object) -> Terrain:
    return load_maps(read_scene(of(heights, **keys)))[0]


def waves(x: Doubles, z: Doubles) -> Doubles:
    return 3.0 * np.sin(0.02 * x) + 0.01 * z


def test_t2_the_ground_is_as_high_as_the_function_says_at_each_sample() -> None:
    terrain = terrain_of(waves, scale=2.0, offset=5.0)
    assert terrain.heights.shape == (201, 601)
    assert terrain.cell == 2.0
    x, z = np.meshgrid(np.linspace(-600.0, 600.0, 601), np.linspace(-200.0, 200.0, 201))
    np.testing.assert_allclose(terrain.heights, 2.0 * waves(x, z) + 5.0, atol=1e-5)


def test_t2_the_function_is_asked_for_each_sample_once_and_for_few_at_a_time() -> None:
    asked = list[tuple[float, float]]()

    def noted(x: Doubles, z: Doubles) -> Doubles:
        assert max(x.shape) <= SQUARE
        asked.extend(zip(x.ravel().tolist(), z.ravel().tolist(), strict=True))
        return 0.0 * x

    terrain = terrain_of(noted)
    assert len(asked) == len(set(asked)) == terrain.heights.size


def test_t2_one_number_is_a_plain_and_nan_a_hole() -> None:
    assert (terrain_of(lambda *_: 7).heights == 7.0).all()
    terrain = terrain_of(lambda x, z: np.where(np.hypot(x, z) < 10.0, np.nan, 1.0))
    assert terrain.holes is not None
    x, z = np.meshgrid(np.arange(-600.0, 601.0, 2.0), np.arange(-200.0, 201.0, 2.0))
    np.testing.assert_array_equal(terrain.holes, np.hypot(x, z) < 10.0)
    np.testing.assert_allclose(terrain.heights, 1.0)


def test_t2_cells_are_no_longer_than_a_smooth_ground_has_them() -> None:
    assert terrain_of(waves, cell=40.0).cell == 2.5
    wide = terrain_of(lambda x, _: 0.0 * x, size=[10240.0, 20.0], cell=0.5)
    assert wide.cell == pytest.approx(2.5)


def test_t2_a_scene_that_is_read_again_with_the_same_function_keeps_its_ground() -> None:
    before = read_scene(of(waves))
    maps = load_maps(before)
    assert load_maps(read_scene(of(waves)), before=(before, maps))[0] is maps[0]
    assert load_maps(read_scene(of(lambda x, z: waves(x, z) + 0.0)), before=(before, maps))[0] is not maps[0]


def breaks(*_: Doubles) -> Doubles:
    raise ZeroDivisionError("no ground")


REFUSED: list[tuple[Heights, str]] = [
    (breaks, "breaks, asked for x from -600 to -90 and z from -200 to 200 m, raised ZeroDivisionError: no ground"),
    (lambda x, _: x[0], "must return 201 by 256 numbers, and returned an array of float64 of shape (256,)"),
    (lambda *_: "high", "must return 201 by 256 numbers, and returned an array of <U4 of shape ()"),
    (lambda x, _: x / 0.0, "returned a height that is infinite"),
    (lambda x, _: 1e5 + x, "its heights go from 99400 to 100600 m; scale them, or mark its voids"),
    (lambda x, _: np.full_like(x, np.nan), "none of it has a height"),
]


@pytest.mark.parametrize(("heights", "sentence"), REFUSED, ids=["raises", "shape", "text", "infinite", "high", "nan"])
def test_n5_a_function_that_gives_no_ground_is_named_in_one_sentence(heights: Heights, sentence: str) -> None:
    with pytest.raises(SceneError) as caught:
        terrain_of(heights)
    (problem,) = caught.value.problems
    assert str(problem).startswith("terrain.heights: ")
    assert sentence in str(problem)


def test_n5_a_function_is_not_turned_over_by_a_key() -> None:
    with pytest.raises(SceneError, match=r"^terrain.flip: a function says itself where the far edge is$"):
        terrain_of(waves, flip=True)
