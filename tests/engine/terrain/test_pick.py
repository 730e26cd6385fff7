"""Intersections of rays with the ground: exact, on slopes, through hills and beyond the edge."""

from dataclasses import replace
from time import process_time

import numpy as np
import pytest

from tallgrass.components.arrays import Doubles
from tallgrass.engine.terrain.pick import pick
from tallgrass.engine.terrain.record import Terrain
from tallgrass.engine.terrain.sample import height_at, normal_at

HILLS = Terrain(np.random.default_rng(2).uniform(0.0, 9.0, (40, 50)).astype(np.float32), 2.0)


def rays(count: int) -> tuple[Doubles, Doubles]:
    """Rays from above the hills in all directions."""
    random = np.random.default_rng(3)
    start = random.uniform((-60.0, 9.5, -50.0), (60.0, 30.0, 50.0), (count, 3))
    return start, random.normal(size=(count, 3)) * (1.0, 0.3, 1.0)


def test_a_ray_meets_the_ground_where_the_ground_is_and_on_its_way() -> None:
    start, way = rays(300)
    met = pick(HILLS, start, way)
    there = ~np.isnan(met[:, 0])
    assert 100 < there.sum() < 250
    np.testing.assert_allclose(met[there, 1], height_at(HILLS, met[there][:, ::2]), atol=1e-4)
    along = way / np.linalg.norm(way, axis=1, keepdims=True)
    gone = ((met - start) * along).sum(axis=1, keepdims=True)
    np.testing.assert_allclose(met[there], (start + gone * along)[there], atol=1e-4)
    assert (gone[there] >= 0.0).all()


def test_nothing_stands_above_a_ray_before_it_meets_the_ground() -> None:
    start, way = rays(200)
    met = pick(HILLS, start, way)
    along = way / np.linalg.norm(way, axis=1, keepdims=True)
    away = np.linalg.norm(met - start, axis=1)
    for number in range(200):
        reach = 200.0 if np.isnan(away[number]) else away[number] - 1e-3
        on = start[number] + np.linspace(0.0, reach, 2000)[:, None] * along[number]
        assert (on[:, 1] > height_at(HILLS, on[:, ::2].astype(np.float32)) - 1e-4).all()


def test_a_needle_of_one_sample_is_not_missed_however_far_off() -> None:
    heights = np.zeros((401, 401), np.float32)
    heights[200, 200] = 8.0
    needle = Terrain(heights, 1.0)
    met = pick(needle, np.array([[-180.0, 7.9, 0.0], [-180.0, 8.1, 0.0]]), np.array([[1.0, 0.0, 0.0]] * 2))
    np.testing.assert_allclose(met[0], (-0.0125, 7.9, 0.0), atol=1e-4)
    assert np.isnan(met[1]).all()


@pytest.mark.parametrize("way", [(0.0, -1.0, 0.0), (1.0, -1.0, 0.0), (0.0, -1e-3, -5.0), (-3.0, -0.01, 2.0)])
def test_level_ground_is_met_where_it_is_beyond_its_edge_too(way: tuple[float, float, float]) -> None:
    level = Terrain(np.full((3, 3), 4.0, np.float32), 10.0)
    met = pick(level, np.array([[1.0, 6.0, 2.0]]), np.array([way]))
    np.testing.assert_allclose(met[0], np.array([1.0, 6.0, 2.0]) + 2.0 / -way[1] * np.array(way), rtol=1e-6)


@pytest.mark.parametrize("far", [1e12, 1e30])
def test_level_ground_is_met_however_far_off_a_ray_begins(far: float) -> None:
    level = Terrain(np.full((3, 3), 4.0, np.float32), 10.0)
    met = pick(level, np.array([[far, 6.0, -far]]), np.array([[0.0, -1.0, 0.0]]))
    np.testing.assert_allclose(met[0], (far, 4.0, -far), rtol=1e-6)


def test_the_length_of_a_direction_does_not_count_however_small() -> None:
    level = Terrain(np.full((3, 3), 4.0, np.float32), 10.0)
    met = pick(level, np.array([[1.0, 6.0, 2.0]]), np.array([[1e-300, -1e-300, 0.0]]))
    np.testing.assert_allclose(met[0], (3.0, 4.0, 2.0), rtol=1e-6)


def test_rays_meet_mirrored_ground_where_it_is_seen() -> None:
    seen = Terrain(np.pad(HILLS.heights, ((117, 117), (147, 147)), mode="reflect"), HILLS.cell)
    start, way = rays(300)
    met, there = pick(replace(HILLS, mirrored=True), start, way), pick(seen, start, way)
    np.testing.assert_array_equal(np.isnan(met[:, 0]), np.isnan(there[:, 0]))
    meets = (np.abs(met[:, ::2]) < np.array(seen.size) / 2).all(axis=1)
    beyond = np.abs(met[:, ::2]) > np.array(HILLS.size) / 2
    assert beyond[meets].any(axis=1).sum() > 30
    np.testing.assert_allclose(met[meets], there[meets], atol=1e-3)


@pytest.mark.parametrize("way", [(1.0, 0.0), (0.0, -1.0), (-1.0, 1.0)])
def test_rays_meet_no_mirrored_ground_beyond_what_is_drawn(way: tuple[float, float]) -> None:
    level = Terrain(np.full((5, 5), 4.0, np.float32), 10.0, mirrored=True)
    falls = 4020.0 + np.array([-1.0, 1.0])
    met = pick(level, np.array([[0.0, 6.0, 0.0]] * 2), np.array([[way[0], -2.0 / fall, way[1]] for fall in falls]))
    assert np.isnan(met[:, 0]).tolist() == [False, True]


def test_a_level_ray_over_mirrored_ground_meets_none() -> None:
    over = np.array([[1.0, HILLS.span[1] + 0.5, 2.0]])
    assert np.isnan(pick(replace(HILLS, mirrored=True), over, np.array([[1.0, 0.0, 0.3]]))).all()


def test_a_ray_that_begins_below_meets_the_ground_there_and_one_into_the_sky_nowhere() -> None:
    start = np.array([[1.0, -3.0, 2.0], [1.0, 20.0, 2.0], [1.0, 20.0, 2.0]])
    met = pick(HILLS, start, np.array([[0.0, 1.0, 0.0], [1.0, 0.5, 0.0], [0.0, 0.0, 1.0]]))
    np.testing.assert_allclose(met[0], start[0])
    assert np.isnan(met[1:]).all()


def test_what_is_farther_than_asked_for_is_not_met() -> None:
    start, way = np.array([[0.0, 30.0, 0.0]]), np.array([[0.0, -7.0, 0.0]])
    height = float(height_at(HILLS, np.zeros((1, 2), np.float32))[0])
    assert np.isnan(pick(HILLS, start, way, farthest=30.0 - height - 0.01)).all()
    assert pick(HILLS, start, way, farthest=30.0 - height + 0.01)[0, 1] == pytest.approx(height)


def test_many_rays_meet_what_each_meets_alone_and_cost_far_less(monkeypatch: pytest.MonkeyPatch) -> None:
    """As for a lidar, or for who sees whom among hundreds of animals."""
    (start, way), times = rays(500), list[float]()
    began = process_time()
    met = pick(HILLS, start, way)
    times.append(process_time() - began)
    began = process_time()
    alone = np.concatenate([pick(HILLS, start[number, None], way[number, None]) for number in range(500)])
    times.append(process_time() - began)
    np.testing.assert_array_equal(met, alone)
    assert times[0] < 0.3 * times[1]
    monkeypatch.setattr("tallgrass.engine.terrain.pick._STRETCHES", 100)  # several parts
    np.testing.assert_array_equal(pick(HILLS, start, way), alone)


def test_a_normal_stands_upright_on_the_ground_around_it() -> None:
    place = np.random.default_rng(4).uniform(-35.0, 35.0, (200, 2)).astype(np.float32)
    normal = normal_at(HILLS, place)
    assert normal.dtype == np.float32
    assert normal.shape == (200, 3)
    np.testing.assert_allclose(np.linalg.norm(normal, axis=1), 1.0, atol=1e-6)
    cell = np.floor((place - HILLS.origin) / 2.0)
    for way in np.eye(2, dtype=np.float32):
        ends = place - np.float32(0.01) * way, place + np.float32(0.01) * way
        rise = (height_at(HILLS, ends[1]) - height_at(HILLS, ends[0])) / np.float32(0.02)
        inside = np.all([np.floor((end - HILLS.origin) / 2.0) == cell for end in ends], axis=(0, 2))
        along = np.stack([way[0] * np.ones(200), rise, way[1] * np.ones(200)], axis=1)
        across = (normal * along).sum(axis=1) / np.linalg.norm(along, axis=1)
        np.testing.assert_allclose(across[inside], 0.0, atol=2e-3)
