"""Bounds of parts of trees: what lies outside a picture is left out, and nothing else (F3, N6)."""

import numpy as np
import pytest

from tallgrass.components.arrays import Doubles, Indices
from tallgrass.engine.camera import View, projection_matrix, view_matrix
from tallgrass.systems.space.frustum import picture_sides
from tallgrass.systems.trees import bark
from tallgrass.systems.trees.bark import PIXEL_RADII
from tallgrass.systems.trees.bounds import blocks_inside, matrices_of
from tallgrass.systems.trees.leafy import GROUPED_FROM, blocks_in_sight, blocks_of_models, blocks_shown
from tallgrass.systems.trees.look import Look, Slack
from tallgrass.systems.trees.model import Model, models_of
from tallgrass.systems.trees.standing import INSTANCE
from tallgrass.systems.trees.twig import BLOCK
from tallgrass.testing import looking

EYE = np.array([0.0, 1.7, 0.0])
CAMERA = looking(0.0, 1.7, 0.0, pitch=4.0, view=50.0)
SIDES = picture_sides(View(view_matrix(CAMERA), projection_matrix(CAMERA.view, 16.0 / 9.0)))
LOOK = Look(EYE, SIDES, np.eye(4), 900.0, 100.0, 2.0, np.zeros(2, np.int32))


@pytest.fixture(scope="module", params=["birch", "oak"])
def model(request: pytest.FixtureRequest) -> Model:
    return models_of(request.param, 3)[0]


def around() -> np.ndarray:
    """Return near trees all around the eye, of all sizes and shares of leaves, records of `INSTANCE`."""
    draw, rows = np.random.default_rng(5), np.zeros(60, INSTANCE)
    off, to = draw.uniform(3.0, 40.0, len(rows)), draw.uniform(-np.pi, np.pi, len(rows))
    rows["root"][:, 0], rows["root"][:, 2] = off * np.sin(to), off * np.cos(to)
    rows["turn"] = np.stack([np.cos(to), np.sin(to)], axis=1)
    rows["scale"], rows["foliage"] = draw.uniform(0.5, 1.3, len(rows)), draw.uniform(0.5, 1.0, len(rows))
    rows["twig_share"] = draw.uniform(0.2, 1.0, len(rows))
    return rows


def blocks_of(model: Model, trees: np.ndarray) -> tuple[Indices, Doubles]:
    """Return the blocks of twigs that are drawn of trees: each one's tree, and `first` of its instance."""
    blocks, of_model = blocks_of_models([model]), np.zeros(len(trees), int)
    sight = blocks_in_sight(blocks, of_model, matrices_of(trees), LOOK, Slack(0.0, 0.0, 0.0, 0.0))
    return blocks_shown(blocks, of_model, trees["twig_share"] * trees["foliage"], sight)


def inside(places: Doubles, tree: np.void) -> np.ndarray:
    """Return whether places of a tree's model (n, 3) are in the picture, (n,)."""
    (cosine, sine), (x, y, z) = tree["turn"], places.T
    at = tree["root"] + tree["scale"] * np.stack([cosine * x - sine * z, y, sine * x + cosine * z], axis=1)
    return np.asarray((at @ SIDES[:, :3].T + SIDES[:, 3] >= 0.0).all(axis=1))


def test_next_to_the_eye_all_wood_in_the_picture_is_drawn_and_little_of_a_tree_beside_it(model: Model) -> None:
    assert len(model.wood) == len(PIXEL_RADII) + 1
    trees, places = around(), model.vertices["stem"][:, :3]
    for near, blocks in zip(model.wood[0], model.near_blocks, strict=True):
        drawn = []
        for tree in trees:
            first, end = (BLOCK * each for each in blocks_inside(blocks, tree[None], SIDES))
            left_out = np.concatenate([near.triangles[:first], near.triangles[end:]])
            assert not inside(places[left_out.reshape(-1)], tree).any()
            drawn.append(1.0 - len(left_out) / len(near.triangles))
        assert min(drawn) == 0.0  # behind the eye
        assert sum(0.0 < each < 0.5 for each in drawn) > 2  # at the picture's edge
        both = blocks_inside(blocks, trees[np.argsort(drawn)[-2:]], SIDES)
        assert both[1] - both[0] >= max(drawn) * len(blocks.radius) - 1.0


def test_triangles_that_share_vertices_are_drawn_one_soon_after_another(model: Model) -> None:
    for faces in (each for wood in model.wood[1:] for each in wood):
        vertices, order = faces.triangles.reshape(-1), np.arange(faces.triangles.size) // 3
        first, last = np.full((2, len(model.vertices)), order[:1])
        first[vertices[::-1]], last[vertices] = order[::-1], order
        assert (last - first).max() < 4 * max(bark.SIDES)  # two rings of a tube


def test_blocks_of_twigs_are_neighbours_and_each_twig_is_in_one(model: Model) -> None:
    order = model.twigs["grouped"].astype(int)
    assert np.array_equal(np.sort(order), np.arange(len(order)))
    for number, (middle, radius) in enumerate(zip(*model.blocks, strict=True)):
        twigs = order[BLOCK * number : BLOCK * (number + 1)]
        off = np.linalg.norm(model.balls.middle[twigs] - middle, axis=1) + model.balls.radius[twigs]
        assert off.max() <= radius + 1e-9
    assert np.median(model.blocks.radius) < 0.6 * np.hypot(model.radius, model.half)


def test_all_twigs_in_the_picture_are_drawn_and_near_to_the_eye_few_others(model: Model) -> None:
    trees, order = around(), model.twigs["grouped"].astype(int)
    whose, first = blocks_of(model, trees)
    drawn_of_all, grouped = 0, 0
    for number, tree in enumerate(trees):
        places, share = first[whose == number].astype(int), float(tree["twig_share"] * tree["foliage"])
        runs = [np.arange(each, each + BLOCK) if each >= 0 else order[-1 - each :][:BLOCK] for each in places]
        drawn = np.concatenate([np.zeros(0, int), *runs])
        assert len({*drawn.tolist()}) == len(drawn)
        kept = np.arange(len(order)) < share * len(order)
        assert {*np.flatnonzero(kept & inside(model.balls.middle, tree)).tolist()} <= {*drawn.tolist()}
        if share >= GROUPED_FROM:
            grouped += 1
            drawn_of_all += len(drawn)
    assert 0 < drawn_of_all < 0.5 * grouped * len(order)


def test_a_tree_without_leaves_has_no_blocks(model: Model) -> None:
    trees = around()
    trees["foliage"] = 0.0
    whose, first = blocks_of(model, trees)
    assert len(whose) == len(first) == 0


@pytest.mark.parametrize("wood_class", [0, 3, len(PIXEL_RADII)])
def test_soft_edges_lie_along_all_that_is_drawn_of_stems_with_fewer_triangles(model: Model, wood_class: int) -> None:
    whole, edges = model.wood[wood_class]
    places = [np.unique(model.vertices["stem"][each.triangles.ravel(), :3], axis=0) for each in (whole, edges)]
    assert np.array_equal(places[0], places[1])
    assert len(edges.triangles) < (0.4 if wood_class == 0 else 1.0) * len(whole.triangles)
