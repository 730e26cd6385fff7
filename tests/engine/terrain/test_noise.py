"""Landscapes made from noise."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pydantic import ValidationError

from tallgrass.engine.declared.terrain import TerrainSource
from tallgrass.engine.terrain.load import load_terrain
from tallgrass.engine.terrain.noise import DEVIATION, LANDSCAPES, SPACING, landscape, spline_noise
from tallgrass.engine.terrain.sample import height_at

names = pytest.mark.parametrize("name", ["rolling", "hills", "ridges"])


def noise(name: Any, **more: Any) -> TerrainSource:
    return TerrainSource(noise=name, **more)


@names
def test_t1_the_same_seed_gives_the_same_land_and_another_seed_another(name: str, tmp_path: Path) -> None:
    first, again, other = (load_terrain(noise(name, seed=seed), tmp_path).heights for seed in (4, 4, 5))
    np.testing.assert_array_equal(first, again)
    assert abs(np.corrcoef(first.ravel(), other.ravel())[0, 1]) < 0.5


@names
def test_a_landscape_spans_most_of_its_height_and_stays_inside(name: str, tmp_path: Path) -> None:
    for seed in range(5):
        heights = load_terrain(noise(name, seed=seed, size=[600.0, 600.0], offset=100.0), tmp_path).heights
        scale = LANDSCAPES[name].scale
        assert 100.0 <= heights.min() < 100.0 + 0.2 * scale
        assert 100.0 + 0.7 * scale < heights.max() <= 100.0 + scale
        assert 0.3 * scale < heights.mean() - 100.0 < 0.7 * scale


@names
def test_scale_stretches_a_landscape_and_a_negative_one_turns_it_over(name: str, tmp_path: Path) -> None:
    usual, twice, upside_down = (
        load_terrain(noise(name, scale=scale), tmp_path).heights for scale in (10.0, 20.0, -10.0)
    )
    np.testing.assert_allclose(twice, 2 * usual, rtol=1e-6)
    np.testing.assert_allclose(upside_down, -usual, rtol=1e-6)


@names
def test_a_wider_terrain_shows_more_of_the_same_land(name: str, tmp_path: Path) -> None:
    small = load_terrain(noise(name, seed=2), tmp_path)
    large = load_terrain(noise(name, seed=2, size=[500.0, 320.0]), tmp_path)
    place = np.random.default_rng(0).uniform(-99, 99, (500, 2)).astype(np.float32)
    np.testing.assert_allclose(height_at(small, place), height_at(large, place), atol=0.02 * LANDSCAPES[name].scale)


@names
def test_a_landscape_has_no_crease_and_no_step(name: str) -> None:
    line = np.arange(-150.0, 150.0, 0.25)
    rise = landscape(name, line, np.array([3.3]), seed=1, feature=60.0)[0].astype(np.float64)
    slope = np.diff(rise) / 0.25
    assert np.abs(np.diff(slope)).max() < 0.15 * np.abs(slope).max()


@pytest.mark.parametrize("feature", [40.0, 80.0])
def test_hilltops_stand_about_a_feature_apart(feature: float) -> None:
    line = np.arange(0.0, 40 * feature, feature / 20)
    heights = landscape("rolling", line, line, seed=6, feature=feature)
    middle = heights[1:-1, 1:-1]
    neighbours = [
        heights[i : i + len(middle), j : j + len(middle)] for i in range(3) for j in range(3) if (i, j) != (1, 1)
    ]
    tops = int(np.all([middle > other for other in neighbours], axis=0).sum())
    assert 0.7 < 40 / np.sqrt(tops) < 1.2


def test_noise_has_the_deviation_and_the_range_it_is_scaled_by() -> None:
    line = np.arange(0.0, 200.0, 0.23)
    values = spline_noise(line, line, seed=12)
    assert values.std() == pytest.approx(DEVIATION, rel=0.03)
    assert abs(values.mean()) < 0.02
    assert np.abs(values).max() <= 1.5
    assert SPACING > 2.0


def test_noise_looks_the_same_along_and_across_its_lattice() -> None:
    line = np.arange(0.0, 150.0, 0.25)
    down, right = np.gradient(spline_noise(line, line, seed=3))
    assert right.std() / down.std() == pytest.approx(1.0, abs=0.05)
    assert ((right + down) / np.sqrt(2)).std() / down.std() == pytest.approx(1.0, abs=0.05)


def test_flat_ground_is_flat_and_lies_at_its_offset(tmp_path: Path) -> None:
    for source in (TerrainSource(), TerrainSource(noise="flat", offset=3.0, size=[500.0, 60.0])):
        terrain = load_terrain(source, tmp_path)
        assert (terrain.heights == source.offset).all()
        assert terrain.size == tuple(source.size or (200.0, 200.0))


@pytest.mark.parametrize("size", [[5.0, 5.0], [333.0, 77.7], [41.3, 900.0]])
def test_a_landscape_has_the_size_it_is_given_to_half_a_cell(size: list[float], tmp_path: Path) -> None:
    terrain = load_terrain(noise("hills", size=size), tmp_path)
    np.testing.assert_allclose(terrain.size, size, atol=terrain.cell / 2 + 1e-6)
    assert max(terrain.size) == pytest.approx(max(size))
    assert terrain.heights.dtype == np.float32
    assert terrain.heights.flags.c_contiguous


def test_ten_kilometres_of_hills_have_cells_of_two_and_a_half_metres(tmp_path: Path) -> None:
    terrain = load_terrain(noise("hills", size=[10240.0, 1000.0]), tmp_path)
    assert terrain.heights.shape == (401, 4097)
    assert terrain.cell == 2.5


def test_small_hills_have_cells_fine_enough_to_show_them(tmp_path: Path) -> None:
    terrain = load_terrain(noise("rolling", feature=2.0, size=[40.0, 40.0]), tmp_path)
    assert terrain.cell <= 0.25
    assert np.ptp(terrain.heights) > 2.0


def test_octaves_too_fine_for_the_cells_are_left_out_instead_of_turning_into_spikes() -> None:
    coarse, fine = np.arange(0.0, 600.0, 20.0), np.arange(0.0, 600.0, 5.0)
    seen = landscape("hills", coarse, coarse, seed=1, feature=60.0)
    whole = landscape("hills", fine, fine, seed=1, feature=60.0)[::4, ::4]
    assert 0.02 < np.abs(seen - whole).max() < 0.25
    assert np.corrcoef(seen.ravel(), whole.ravel())[0, 1] > 0.95


def test_hills_too_small_for_ground_this_wide_are_refused_with_the_smallest() -> None:
    with pytest.raises(ValidationError, match=r"feature must be at least 10 m on ground this wide"):
        noise("hills", feature=3.0, size=[10240.0, 10240.0])
    noise("hills", feature=10.0, size=[10240.0, 10240.0])
