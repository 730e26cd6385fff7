"""How a tree's leaves lie, from how those of its twigs' cards do (F3)."""

import numpy as np
import pytest

from tallgrass.components.arrays import Doubles
from tallgrass.systems.trees.normals import TREE_NORMALS, pictured, tree_normals
from tallgrass.systems.trees.twig import TWIG


def told(along: Doubles, face: Doubles, card: list[tuple[float, float, float, float]], *, turn: bool) -> Doubles:
    twigs = np.zeros(len(along), TWIG)
    twigs["along"], twigs["face"], twigs["span"] = along, face, 0.7
    found = np.array(tree_normals(twigs, card, turn=turn)[0])
    assert found.shape == (TREE_NORMALS, 4)
    assert found[:, 3].sum() == pytest.approx(1.0)
    return found


def test_level_leaves_of_level_twigs_face_up() -> None:
    around = np.linspace(0.0, 2.0 * np.pi, 60, endpoint=False)
    along = np.stack([np.cos(around), 0.0 * around, np.sin(around)], axis=1)
    found = told(along, np.tile([0.0, 1.0, 0.0], (60, 1)), [(0.0, 0.0, 1.0, 0.5), (0.0, 0.0, 1.0, 0.5)], turn=False)
    seen = found[found[:, 3] > 0.0]
    np.testing.assert_allclose(seen[:, 1], 1.0, atol=1e-6)


@pytest.mark.parametrize("to", [(0.0, 1.0, 0.0), (1.0, 0.0, 0.0), (0.6, 0.0, 0.8)])
def test_from_any_side_as_much_is_seen_of_them_as_of_all_leaves(to: tuple[float, float, float]) -> None:
    draw = np.random.default_rng(6)
    face = draw.normal((0.0, 1.0, 0.0), (0.3, 0.1, 0.3), (400, 3))
    along = np.cross(face, draw.normal(size=(400, 3)))
    face, along = (each / np.linalg.norm(each, axis=1, keepdims=True) for each in (face, along))
    card = [(0.4, 0.0, 0.9165, 0.7), (-0.3, 0.2, 0.9327, 0.3)]
    found, aside = told(along, face, card, turn=False), np.cross(along, face)
    every = sum(share * np.abs((x * aside + y * along + z * face) @ to).mean() for x, y, z, share in card)
    assert (found[:, 3] * np.abs(found[:, :3] @ to)).sum() == pytest.approx(every, abs=0.03)


def test_however_leaves_lie_as_much_light_is_seen_on_them_as_on_all() -> None:
    draw = np.random.default_rng(7)
    face = draw.normal(size=(2000, 3))
    along = np.cross(face, draw.normal(size=(2000, 3)))
    face, along = (each / np.linalg.norm(each, axis=1, keepdims=True) for each in (face, along))
    found = told(along, face, [(0.0, 0.0, 1.0, 1.0)], turn=False)
    normal, share = found[:, :3], found[:, 3]
    ways = draw.normal(size=(2, 60, 3))
    to_eye, to_sun = ways / np.linalg.norm(ways, axis=2, keepdims=True)
    facing, seen = np.abs(to_eye @ normal.T) * share, np.abs(to_eye @ face.T)
    light, true = facing * np.abs(to_sun @ normal.T), seen * np.abs(to_sun @ face.T)
    ratio = light.sum(axis=1) / facing.sum(axis=1) / (true.sum(axis=1) / seen.sum(axis=1))
    assert ratio.mean() == pytest.approx(1.0, abs=0.01)
    assert ratio.std() < 0.04


def test_leaves_that_lie_alike_on_both_sides_of_a_tree_are_told_apart_by_the_depth_before_each() -> None:
    twigs = np.zeros(2, TWIG)
    twigs["along"], twigs["face"], twigs["span"] = (0.0, 1.0, 0.0), (0.0, 0.0, 1.0), 0.7
    twigs["shading"] = (0.0, 0.0, -1.0, 1.0), (0.0, 0.0, 1.0, 1.0)  # each side's depth is none outwards
    normals, depths = (np.array(each) for each in tree_normals(twigs, [(0.0, 0.0, 1.0, 1.0)], turn=False))
    seen = normals[:, 3] > 0.0
    assert sorted(normals[seen, 2]) == pytest.approx([-1.0, 1.0])
    outwards = np.column_stack([normals[:, :3], np.ones(len(normals))])
    assert (depths * outwards).sum(axis=1)[seen] == pytest.approx(0.0, abs=1e-6)


def test_needles_face_all_ways_around_their_twig() -> None:
    up, level = np.tile([0.0, 1.0, 0.0], (8, 1)), np.tile([1.0, 0.0, 0.0], (8, 1))
    found = told(up, level, [(0.0, 0.0, 1.0, 1.0)], turn=True)
    seen = found[found[:, 3] > 0.0]
    assert np.abs(seen[:, 1]).max() < 1e-6
    assert (seen[:, 3] * np.abs(seen[:, 0])).sum() == pytest.approx((seen[:, 3] * np.abs(seen[:, 2])).sum(), abs=0.05)


def test_in_a_picture_a_leaf_counts_by_the_area_that_it_shows() -> None:
    *mean, area = pictured([(0.6, 0.0, 0.8, 0.5), (-0.8, 0.0, 0.6, 0.25), (1.0, 0.0, 0.0, 0.25)])
    assert area == pytest.approx(0.4 + 0.15, abs=0.002)
    assert mean == pytest.approx(((0.4 * 0.6 - 0.15 * 0.8) / 0.55, 0.0, (0.4 * 0.8 + 0.15 * 0.6) / 0.55), abs=0.002)
