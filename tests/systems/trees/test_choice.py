"""Which trees a picture has, and in which streams those of all models are that are chosen in one go (F3, N6)."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass.components.arrays import Doubles
from tallgrass.engine.camera import View, projection_matrix, view_matrix
from tallgrass.systems.space.cone import distance_in_order
from tallgrass.systems.space.frustum import picture_sides
from tallgrass.systems.space.window import cell_of
from tallgrass.systems.trees.batch import Batch
from tallgrass.systems.trees.choice import Choice
from tallgrass.systems.trees.habit import HABITS, NEEDLES
from tallgrass.systems.trees.leafy import InSight, blocks_of_models, blocks_shown
from tallgrass.systems.trees.look import Look
from tallgrass.systems.trees.model import MODELS, Model, models_of
from tallgrass.systems.trees.shells import RINGS, SHELL
from tallgrass.systems.trees.shown import Shown
from tallgrass.systems.trees.standing import PICTURE_BELOW, STANDING, Standing
from tallgrass.systems.trees.stream import BACKS, CARDS, FAR, LEAVES, WOODS
from tallgrass.systems.trees.twig import BLOCK
from tallgrass.testing import looking

PIXELS, REACH, PATCH = 900.0, 120.0, 2.0
EYE = np.array([0.0, 4.0, 0.0])


@pytest.fixture(scope="module")
def models() -> list[Model]:
    return [*models_of("oak", 3), *models_of("birch", 4)]


def a_wood(models: list[Model], *, count: int = 400) -> NDArray[np.void]:
    """Return trees of all models all around, near by and far off, one as probable as the other."""
    draw = np.random.default_rng(7)
    rows, around = np.zeros(count, STANDING), draw.uniform(-np.pi, np.pi, count)
    off = 3.0 * 400.0 ** draw.random(count)
    rows["root"][:, 0], rows["root"][:, 2] = off * np.sin(around), off * np.cos(around)
    rows["kind"], rows["model"] = np.divmod(draw.integers(0, len(models), count), MODELS)
    rows["height"], rows["foliage"] = draw.uniform(5.0, 15.0, count), draw.uniform(0.3, 1.0, count)
    rows["yaw"] = around
    return rows


def looking_from(
    eye: tuple[float, float, float] = (0.0, 4.0, 0.0), *, yaw: float = 0.0, reach: float = REACH,
    leaves_from: float | None = None,
) -> Look:  # fmt: skip
    camera = looking(*eye, yaw=yaw, pitch=5.0, view=45.0)
    view = View(view_matrix(camera), projection_matrix(camera.view, 1.0))
    sides, clip, centre = picture_sides(view), view.clip.astype(np.float64), cell_of(np.array(eye[::2]), patch=PATCH)
    return Look(np.array(eye), sides, clip, PIXELS, reach, PATCH, centre, leaves_from=leaves_from)


def chosen(
    rows: NDArray[np.void], models: list[Model], *, reach: float = REACH, leaves_from: float | None = None
) -> Sequence[Batch]:
    return in_picture(all_of(rows, models).choose(looking_from(reach=reach, leaves_from=leaves_from)))


def in_picture(shown: Shown) -> list[Batch]:
    """Return the batches with what is in the picture of each, but for those that have nothing there."""
    beyond = shown.batches[len(shown.rows) :]
    near = [
        batch._replace(parts=(*batch.parts[:-1], rows) if batch.name in BACKS else (rows, *batch.parts[1:]))
        for batch, rows in zip(shown.batches, shown.rows, strict=False)
    ]
    return [batch for batch in (*near, *beyond) if batch.size]


def all_of(rows: NDArray[np.void], models: list[Model]) -> Choice:
    return Choice(Standing(rows), models, [0.1] * len(models))


def parts(found: Sequence[Batch]) -> list[tuple[Batch, NDArray[np.void]]]:
    """Return each batch and its instances."""
    return [(batch, np.concatenate(batch.parts)) for batch in found]


def by_stream(found: Sequence[Batch]) -> dict[tuple[int, str], bytes]:
    """Return what is instances of each stream, by the number of its model and its name."""
    instances = {(batch.model, batch.name): rows.tobytes() for batch, rows in parts(found)}
    assert len(instances) == len(found)
    return instances


def roots(found: Sequence[Batch], model: int, *names: str) -> Doubles:
    """Return where those stand that are in some streams of a model."""
    some = [rows["root"] for batch, rows in parts(found) if batch.model == model and batch.name in names]
    return np.concatenate([np.zeros((0, 3)), *some])


def test_trees_of_all_models_are_chosen_as_those_of_each_would_be_by_itself(models: list[Model]) -> None:
    rows = a_wood(models)
    together = by_stream(chosen(rows, models))
    assert {model for model, _ in together} == {*range(len(models))}
    alone = dict[tuple[int, str], bytes]()
    for number in range(len(models)):
        alone |= by_stream(chosen(rows[rows["kind"] * MODELS + rows["model"] == number], models))
    assert together == alone


def test_a_tree_is_in_as_many_streams_as_it_is_drawn_in_ways(models: list[Model]) -> None:
    """With its wood and on cards near by, as a picture far off, from near to far and back, and in all in between."""
    found = chosen(a_wood(models), models)
    for model in range(len(models)):
        cards, wood, far, back = (
            sorted(map(tuple, roots(found, model, *each))) for each in (CARDS, WOODS, (FAR,), BACKS)
        )
        assert len(set(wood)) == len(wood) > 0
        assert set(cards) <= set(wood)  # of some, no twig is in the picture
        assert len(cards) > len(wood)  # in blocks of twigs
        assert len(set(far)) == len(far) > 0
        assert far == back
    instances = np.concatenate([rows for batch, rows in parts(found) if batch.name == FAR])
    between = {tuple(each["root"]) for each in instances if each["far_fade"] < 1.0}
    near = {tuple(root) for model in range(len(models)) for root in roots(found, model, *CARDS)}
    assert between == near & {tuple(each["root"]) for each in instances}
    assert between


def test_streams_are_from_near_to_far_and_soft_edges_of_pictures_from_far_to_near(models: list[Model]) -> None:
    found, seen = chosen(a_wood(models), models), set[bool]()
    for batch, rows in parts(found):
        off = np.linalg.norm(rows["root"] - EYE, axis=1)
        if batch.size > 1 and batch.name != LEAVES:
            seen.add(batch.name in BACKS)
            steps = np.diff(off[::-1] if batch.name in BACKS else off)
            assert steps.min() > -2.0  # the middle of a tree counts, which is higher on a high one
    assert seen == {False, True}


def test_what_is_placed_and_how_far_off_it_is_is_of_the_trees_of_each_stream(models: list[Model]) -> None:
    rows_of_all = a_wood(models)
    found = in_picture(all_of(rows_of_all, models).choose(looking_from()._replace(live=False)))
    height = {tuple(each["root"]): each["height"] for each in rows_of_all}
    for batch, rows in parts(found):
        larger = np.array([height[tuple(root)] for root in rows["root"]]) / models[batch.model].height
        assert np.allclose(rows["scale"], larger)
        assert np.allclose(rows["crown_at"], larger * models[batch.model].middle)
        off = np.linalg.norm(rows["root"] + rows["crown_at"][:, None] * (0.0, 1.0, 0.0) - EYE, axis=1)
        _, trees = np.unique(rows["root"], axis=0, return_index=True)
        assert (batch.nearest, batch.mean) == pytest.approx((off.min(), off[trees].mean()))
        assert batch.name not in WOODS or batch.foliage == rows["foliage"].min()


def test_the_fewer_leaves_a_tree_has_the_smaller_it_becomes_a_picture(models: list[Model]) -> None:
    rows, high = a_wood(models, count=2), 0.9 * PICTURE_BELOW / PIXELS * models[0].height / (2.0 * models[0].half)
    rows["kind"] = rows["model"] = 0
    rows["foliage"], rows["root"], rows["height"] = (1.0, 0.5), (0.0, 0.0, -60.0), 60.0 * high
    rows["root"][:, 0] = -3.0, 3.0
    found = chosen(rows, models)
    assert roots(found, 0, FAR)[:, 0].tolist() == [-3.0]
    assert {*roots(found, 0, *CARDS)[:, 0].tolist()} == {3.0}


def test_trees_among_the_grass_are_in_streams_by_shells_of_it_and_all_beyond_it_in_others(models: list[Model]) -> None:
    found, shells = chosen(a_wood(models), models), set[str]()
    for batch, rows in parts(found):
        off = np.hypot(rows["root"][:, 0], rows["root"][:, 2])
        if batch.name in (*CARDS, *WOODS, *BACKS):
            assert off.min() > (SHELL * off.max() if 0.25 * REACH < off.max() < REACH else 0.0)
            assert off.max() < REACH or off.min() >= REACH
            shells |= {batch.name} if off.max() < REACH else set()
    assert all(shells.intersection(names) for names in (CARDS, WOODS, BACKS))


def test_soft_edges_of_needles_beyond_the_grass_are_in_rings_which_overlap_by_less(models: list[Model]) -> None:
    """Most of a picture of needles is soft edges: far ones of one model must not lie over near ones of another."""
    habit, rings = models[0].habit, dict[int, list[float]]()
    needles = replace(models[0], habit=replace(habit, leaf=replace(habit.leaf, form=NEEDLES)))
    found = chosen(a_wood(models, count=3000), [needles, *models[1:]], reach=40.0)
    for batch, rows in parts(found):
        off = np.hypot(rows["root"][:, 0], rows["root"][:, 2])
        if batch.name in BACKS and off.min() >= 40.0:
            assert batch.far == np.inf
            rings.setdefault(batch.model, []).append(float(off.max() / off.min()))
    assert [len(rings[number]) for number in range(len(models))] == [RINGS] + [1] * (len(models) - 1)
    assert sorted(rings[0])[RINGS - 2] <= 2.0


def test_soft_edges_come_after_the_patch_that_the_farthest_tree_of_a_stream_stands_on(models: list[Model]) -> None:
    found, checked = chosen(a_wood(models), models), 0
    for batch, rows in parts(found):
        place = rows["root"][:, ::2]
        if batch.name in (*CARDS, *BACKS):
            among = np.hypot(*place.T) < REACH
            patches = distance_in_order(cell_of(place, patch=PATCH), np.zeros(2, np.int32))
            assert batch.far == (PATCH * patches.max() if among.all() else np.inf)
            checked += among.all()
    assert checked > len(models)


def test_twigs_that_are_drawn_leaf_by_leaf_are_of_trees_that_are_near(models: list[Model]) -> None:
    found = chosen(a_wood(models), models)
    leaves = [batch for batch in found if batch.name == LEAVES]
    assert leaves
    for batch in leaves:
        of, near = roots(found, batch.model, LEAVES), roots(found, batch.model, *CARDS)
        assert batch.size == len(of)
        assert {*map(tuple, of)} < {*map(tuple, near)}
        assert np.linalg.norm(of - EYE, axis=1).max() < np.linalg.norm(near - EYE, axis=1).max()
        assert batch.far == 0.0  # no grass is behind them


def test_as_a_reference_has_them_each_tree_that_is_high_enough_is_drawn_with_every_leaf(models: list[Model]) -> None:
    rows, least = a_wood(models), 100.0
    found = chosen(rows, models, leaves_from=least)
    nearer = {tuple(each["root"]) for each in rows if each["height"] * PIXELS > least * np.linalg.norm(each["root"])}
    for model in range(len(models)):
        leaves, far = ({*map(tuple, roots(found, model, name))} for name in (LEAVES, FAR))
        assert leaves & nearer
        assert far - nearer
        assert not leaves & far


def test_where_no_tree_is_in_the_picture_nothing_is_drawn(models: list[Model]) -> None:
    behind = a_wood(models)
    behind["root"][:, 2] = np.abs(behind["root"][:, 2]) + 50.0
    behind["root"][:, 0] = 0.0
    for rows in (behind, behind[:0]):
        found = chosen(rows, models)
        assert not found


def drawn_of(found: Sequence[Batch], models: list[Model]) -> dict[tuple[object, ...], tuple[float, ...]]:
    """Return the level of detail of all that is drawn: of trees as pictures, of their wood, and of each twig."""
    drawn = dict[tuple[object, ...], tuple[float, ...]]()
    for batch, rows in parts(found):
        model = models[batch.model]
        order = model.twigs["grouped"].astype(int)
        name = "wood" if batch.name in WOODS else "back" if batch.name in BACKS else batch.name
        for row in rows:
            key, first = (batch.model, *row["root"].tolist()), int(row["first"])
            far_fade, opacity, twig_share = (float(row[each]) for each in ("far_fade", "opacity", "twig_share"))
            if batch.name not in (LEAVES, *CARDS):
                drawn[name, *key] = far_fade, opacity
                continue
            block = order[-1 - first :][:BLOCK] if first < 0 else np.arange(first, first + BLOCK)
            for twig in [first] if name == LEAVES else block.tolist():
                drawn["twig", *key, twig] = far_fade, twig_share
    return drawn


def test_blocks_of_leaves_are_drawn_from_near_to_far_and_those_of_needles_as_soft_edges_are_from_far_to_near() -> None:
    """The former hide one another, and most that is seen of the latter is blended."""
    birch = models_of("birch", 4)[0]
    models = [birch, replace(birch, habit=HABITS["pine"])]
    blocks, tree = blocks_of_models(models), np.arange(2)
    away = np.random.default_rng(5).random((2, blocks.radius.shape[1]))
    sight = InSight(blocks.radius > 0.0, away, np.zeros_like(away))
    whose, first = blocks_shown(blocks, tree, np.ones(2), sight)
    for model, sign in enumerate((1.0, -1.0)):
        steps = np.diff(away[model, (-1 - first[whose == model]).astype(int) // BLOCK])
        assert len(steps) > 10
        assert (sign * steps > 0.0).all()


STEPS = [((0.02 * step, 4.0 + 0.01 * step, -0.05 * step), 0.1 * step) for step in range(16)]
STEPS += [((0.3 * step, 4.0, -3.0 * step), 60.0 * step) for step in range(1, 4)]
"""Eyes and yaws of a walk that turns, and of a run."""


def test_on_a_walk_all_that_is_seen_is_drawn_and_most_is_not_chosen_anew_in_each_frame(models: list[Model]) -> None:
    rows, kept, before = a_wood(models, count=60), 0, None
    walked, another = all_of(rows, models), all_of(rows, models)
    for eye, yaw in STEPS:
        look = looking_from(eye, yaw=yaw)
        found, anew = walked.choose(look), another.choose(look._replace(detail_eyes=(look.eye,)))  # without slack
        kept, before = kept + (found is before), found
        drawn, seen = (drawn_of(in_picture(each), models) for each in (found, anew))
        assert {*seen} <= {*drawn}
        assert all(drawn[each] == seen[each] for each in seen)
        assert len(drawn) < 1.1 * len(seen)
    assert kept > 0.5 * len(STEPS)


def test_n3_held_what_was_chosen_last_is_drawn_as_it_was_and_leaves_no_trace(models: list[Model]) -> None:
    rows = a_wood(models, count=60)
    walked, another = all_of(rows, models), all_of(rows, models)
    before, eye, kept = None, np.zeros(3), 0
    for at, yaw in STEPS:
        look = looking_from(at, yaw=yaw)
        if before is not None:
            was = drawn_of(in_picture(before), models)
            held = walked.choose(look._replace(held=True, detail_eyes=(eye,)))
            drawn = drawn_of(in_picture(held), models)
            assert held is before
            assert all(drawn[each] == was[each] for each in {*was} & {*drawn})
        shown = walked.choose(look)
        assert in_order(in_picture(shown)) == in_order(in_picture(another.choose(look)))
        kept, before, eye = kept + (shown is before), shown, look.eye
    assert kept


def test_in_a_film_it_does_not_matter_which_pictures_were_drawn_before(models: list[Model]) -> None:
    rows = a_wood(models, count=60)
    walked = all_of(rows, models)
    for eye, yaw in STEPS[:6]:
        look = looking_from(eye, yaw=yaw)._replace(live=False)
        assert in_order(in_picture(walked.choose(look))) == in_order(in_picture(all_of(rows, models).choose(look)))


def in_order(found: Sequence[Batch]) -> list[tuple[object, ...]]:
    """Return all that batches hold, in their order."""
    return [(*batch._replace(parts=()), rows.tobytes()) for batch, rows in parts(found)]
