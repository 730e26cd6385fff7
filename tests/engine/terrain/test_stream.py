"""Ground that streams from a function of places (T1, D6)."""

import logging
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tallgrass.engine.declared.terrain import TerrainSource
from tallgrass.engine.terrain.blocks import SPARE
from tallgrass.engine.terrain.change import changed_squares, must_be_squares, restore_squares, set_heights
from tallgrass.engine.terrain.errors import MapError
from tallgrass.engine.terrain.load import load_terrain
from tallgrass.engine.terrain.record import Terrain
from tallgrass.engine.terrain.sample import height_at, hole_at, slope_at
from tallgrass.engine.terrain.stream import window_of

HERE = Path()


def dunes(x: Any, z: Any) -> Any:
    return 9.0 * np.sin(x / 230.0) * np.cos(z / 310.0)


def streamed(function: object = dunes, about: tuple[float, float] = (0.0, 0.0), **more: object) -> Terrain:
    source = TerrainSource.model_validate({"heights": function, "window": 1024.0, "cell": 2.0, **more})
    return load_terrain(source, HERE, about=about)


def go(terrain: Terrain, x: float, z: float) -> None:
    assert terrain.blocks is not None
    terrain.become(window_of(terrain.blocks, terrain.blocks.first_about(x, z)), leaps=False)


def test_heights_and_slopes_are_the_same_near_by_and_far_off_and_when_one_has_come_there() -> None:
    terrain, draw = streamed(), np.random.default_rng(1)
    places = draw.uniform(-9000.0, 9000.0, (300, 2)).astype(np.float32)
    places[:100] = draw.uniform(2600.0, 3400.0, (100, 2))
    heights, slopes = height_at(terrain, places), slope_at(terrain, places)
    np.testing.assert_allclose(heights, dunes(*places.T.astype(np.float64)), atol=0.01)
    go(terrain, 3000.0, 3000.0)
    assert terrain.first == (1216, 1216)
    np.testing.assert_allclose(height_at(terrain, places), heights, atol=1e-4)
    np.testing.assert_allclose(slope_at(terrain, places), slopes, atol=1e-3)
    loaded = streamed(about=(3000.0, 3000.0))
    np.testing.assert_array_equal(loaded.heights, terrain.heights)


def test_what_a_game_digs_is_there_when_one_comes_back_and_where_nobody_has_been() -> None:
    terrain = streamed(scale=2.0, offset=1.0)
    set_heights(terrain, (10.0, -20.0), np.full((7, 5), 50.0, np.float32))
    set_heights(terrain, (6000.0, 6000.0), np.full((3, 3), np.nan, np.float32))
    crater, pit = np.array([[14.0, -14.0]], np.float32), np.array([[6002.0, 6002.0]], np.float32)
    far = np.array([[-5000.0, 8000.0]], np.float32)
    for x, z in ((0.0, 0.0), (3000.0, 0.0), (6000.0, 6000.0), (0.0, 0.0)):
        go(terrain, x, z)
        assert height_at(terrain, crater)[0] == 50.0
        assert hole_at(terrain, pit)[0]
        assert not hole_at(terrain, crater)[0]
        np.testing.assert_allclose(height_at(terrain, far), 1.0 + 2.0 * dunes(-5000.0, 8000.0), atol=0.02)
    squares = changed_squares(terrain)
    assert len(squares[1]) < 16**2 * 8
    other = streamed(about=(6000.0, 6000.0), scale=2.0, offset=1.0)
    set_heights(other, (6100.0, 6100.0), np.full((2, 2), 9.0, np.float32))
    must_be_squares(other, squares)
    restore_squares(other, squares)
    assert hole_at(other, pit)[0]
    again = np.array([[6100.0, 6100.0]], np.float32)
    np.testing.assert_allclose(height_at(other, again), 1.0 + 2.0 * dunes(6100.0, 6100.0), atol=0.02)
    assert height_at(other, crater)[0] == 50.0
    with pytest.raises(ValueError, match="not all lie on the terrain"):
        set_heights(terrain, (16384.0, 0.0), np.zeros((2, 2), np.float32))


def test_however_far_one_goes_no_more_is_remembered() -> None:
    terrain = streamed()
    assert terrain.blocks is not None
    for x in range(0, 16000, 512):
        go(terrain, float(x), 0.0)
        assert len(terrain.blocks.known) <= 64 + SPARE
        assert terrain.heights.shape == (513, 513)
    places = np.stack(np.meshgrid(np.arange(-16e3, 16e3, 640.0), np.arange(-8e3, 8e3, 1280.0)), -1).reshape(-1, 2)
    height_at(terrain, places.astype(np.float32))
    assert len(terrain.blocks.known) <= 64 + 2 * SPARE + 1
    assert len(terrain.blocks.tiles) <= SPARE


def test_a_function_is_asked_for_each_block_once() -> None:
    asked = list[tuple[float, float]]()

    def counted(x: Any, z: Any) -> Any:
        asked.append((float(x[0, 0]), float(z[0, 0])))
        return dunes(x, z)

    terrain = streamed(counted)
    go(terrain, 128.0, 0.0)
    go(terrain, 0.0, 0.0)
    assert len(asked) == len({*asked}) == 64 + 8


def test_where_a_function_fails_loading_tells_it_and_later_the_ground_is_level_until_one_comes_back(
    caplog: pytest.LogCaptureFixture,
) -> None:
    reach = 2000.0

    def near(x: Any, z: Any) -> Any:
        if np.abs(x).max() > reach:
            raise ZeroDivisionError("too far")
        return dunes(x, z)

    with pytest.raises(MapError, match=r"near, asked for x from .* raised ZeroDivisionError: too far"):
        streamed(near, about=(5000.0, 0.0))
    terrain = streamed(near)
    with caplog.at_level(logging.WARNING):
        go(terrain, 5000.0, 0.0)
        go(terrain, 9000.0, 0.0)
    assert (terrain.heights == 0.0).all()
    (record,) = caplog.records
    assert "level where its function fails: " in record.getMessage()
    there = np.array([[9000.0, 0.0]], np.float32)
    go(terrain, 0.0, 0.0)
    assert height_at(terrain, there) == 0.0
    reach = 16384.0
    go(terrain, 5000.0, 0.0)
    go(terrain, 9000.0, 0.0)
    np.testing.assert_allclose(height_at(terrain, there), dunes(9000.0, 0.0), atol=0.01)
