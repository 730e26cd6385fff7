"""What cards show of twigs: as many leaves as they stand for, each as large as it has grown, and as light (F3, F4)."""

from collections.abc import Iterator

import moderngl
import numpy as np
import pytest

from tallgrass import Prairie
from tallgrass.app.bench.trees import Behind, tree_figures
from tallgrass.components.arrays import Bytes
from tallgrass.systems.reference import draw_truth, without_trees
from tallgrass.systems.trees import standing
from tallgrass.systems.trees.bake import CARD
from tallgrass.systems.trees.draw import TreePart
from tallgrass.systems.trees.normals import TREE_NORMALS, Normals, card_normals
from tallgrass.systems.trees.outline import ROUNDED_UP, solid_above
from tallgrass.systems.trees.stream import CARDS, FAR
from tallgrass.systems.trees.twig import PICTURES
from tallgrass.systems.trees.wood import SOLID
from tallgrass.testing import Stage, little_prairie, looking, private_world
from tallgrass.testing.little import SPARSE

SCENE = (
    SPARSE
    + """\
seed: 5
terrain: { noise: flat, size: [180, 180] }
grass: { turf: { height: [0.05, 0.08], width: 0.02, blades: 30, place: none } }
trees:
  oak: { habit: oak, positions: [[30, 0]] }
  willow: { habit: willow }
  thorn: { habit: hawthorn, positions: [[0, 0]] }
light: { azimuth: 130, elevation: 40, haze: 1e6, clouds: 0 }
"""
)
SIZE = 96
ABOVE = looking(0.0, 24.0, 24.0, pitch=-43.0, view=11.0)


@pytest.fixture(scope="module")
def stage(ctx: moderngl.Context) -> Stage:
    return Stage(ctx, (SIZE, SIZE))


@pytest.fixture(scope="module")
def prairie(ctx: moderngl.Context, stage: Stage) -> Iterator[Prairie]:
    with private_world(), little_prairie(scene=SCENE, ctx=ctx) as made:
        stage.shot(made, ABOVE)
        yield made


def cards(prairie: Prairie) -> dict[str, Bytes]:
    """Return the pictures of each kind's twigs, (PICTURES, rows, columns, 4)."""
    assert prairie.painter is not None
    kinds = vars(prairie.painter.part(TreePart))["_kinds"]
    each = {kind.declared.habit: kind.card for kind in kinds}
    return {
        name: np.frombuffer(card.read(), np.uint8).reshape(PICTURES, CARD, CARD, 4)
        for name, card in each.items() if card is not None
    }  # fmt: skip


@pytest.mark.slow
def test_a_card_that_stands_for_several_twigs_shows_more_leaves_and_not_larger_ones(prairie: Prairie) -> None:
    for pictures in cards(prairie).values():
        covered = pictures[..., 3] > 127
        covers = covered.mean(axis=(1, 2))
        edges = (covered[:, 1:] != covered[:, :-1]).sum(axis=(1, 2)) / covered.sum(axis=(1, 2))
        assert covers[1:] == pytest.approx(covers[0], rel=0.25)
        assert (edges[1:] / edges[:-1]).min() > 1.2  # leaves lie over one another, which hides edges


@pytest.mark.slow
def test_all_pictures_of_a_kinds_twigs_are_as_bright(prairie: Prairie) -> None:
    for name, pictures in cards(prairie).items():
        tone, _, _, cover = pictures.sum(axis=(1, 2), dtype=np.float64).T
        assert tone / cover == pytest.approx(tone.sum() / cover.sum(), rel=0.02), name


def test_how_leaves_lie_is_told_in_few_directions() -> None:
    draw = np.random.default_rng(4)
    normal = draw.normal(0.0, (0.3, 0.2, 0.2), (64 * 64, 3)) + np.array([0.1, 0.0, 1.0])
    normal[:, 2] = np.abs(normal[:, 2])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    picture = np.full((2, 64, 64, 4), 255, np.uint8)
    picture[1, ..., :3] = np.round(127.5 + 127.5 * normal).reshape(64, 64, 3)
    picture[:, :32, :5] = 0  # where nothing is
    told = np.array(card_normals(picture))
    area = 1.0 / normal[:, 2]
    assert told[:, 3].sum() == pytest.approx(1.0)
    for to in ((0.0, 0.0, 1.0), (0.6, 0.0, 0.8), (1.0, 0.0, 0.0), (0.0, -0.6, 0.8)):
        faces = (area * np.abs(normal @ to)).sum() / area.sum()
        assert (told[:, 3] * np.abs(told[:, :3] @ to)).sum() == pytest.approx(faces, abs=0.02)


def test_needles_are_drawn_as_solid_only_where_they_cover_nearly_all_and_leaves_from_their_edges_on() -> None:
    edged = np.zeros((16, 16), np.uint8)
    edged[4:12, 3:13], edged[4:12, [2, 13]] = 255, 180
    assert solid_above(edged) == SOLID
    strewn = np.random.default_rng(2).integers(60, 230, (16, 16)).astype(np.uint8)  # a mean anywhere
    above = solid_above(strewn)
    assert above > SOLID
    cover = strewn / 255.0
    assert (1.0 - cover[cover > above]).sum() <= ROUNDED_UP * cover.sum()
    assert solid_above(np.full((4, 4), 255, np.uint8)) == solid_above(np.zeros((4, 4), np.uint8)) == SOLID


def test_leaves_that_face_nowhere_are_told_to_face_out_of_the_card() -> None:
    nowhere = np.zeros((2, 8, 8, 4), np.uint8)
    nowhere[0] = 255  # leaves, of which the other layer says nothing
    told = np.array(card_normals(nowhere))
    assert np.isfinite(told).all()
    np.testing.assert_array_equal(told[:, :3], np.tile([0.0, 0.0, 1.0], (len(told), 1)))


@pytest.mark.slow
def test_from_above_the_ground_hides_nothing_of_a_tree_and_it_is_as_bright_as_with_every_leaf(
    stage: Stage, prairie: Prairie, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As a picture, whose square reaches under the ground."""
    monkeypatch.setattr(standing, "PICTURE_BELOW", 1e5)
    monkeypatch.setattr(standing, "FADES_BELOW", 2e5)
    stage.shot(prairie, looking(9.0, 24.0, 24.0))
    drawn = stage.shot(prairie, ABOVE)
    truth = draw_truth(prairie, *stage.matrices(ABOVE), (SIZE, SIZE)).picture.astype(np.float64)
    with without_trees(prairie):
        bare = stage.shot(prairie, ABOVE)
    covers, true = (np.abs(each - bare).max(axis=-1) > 12.0 for each in (drawn, truth))
    lowest = np.flatnonzero(true.any(axis=1)).max()
    front = slice(lowest - SIZE // 6, lowest)
    assert covers[front].sum() == pytest.approx(true[front].sum(), rel=0.35)
    both = covers & true
    assert drawn[both].mean() == pytest.approx(truth[both].mean(), rel=0.12)


@pytest.mark.slow
def test_a_reference_is_as_bright_with_few_samples_as_with_many(stage: Stage, prairie: Prairie) -> None:
    """Leaves are smaller than a sample there, and none may show through others that are before it."""
    stage.shot(prairie, ABOVE)
    seen = [draw_truth(prairie, *stage.matrices(ABOVE), (SIZE, SIZE), samples=each).picture for each in (2, 8)]
    with without_trees(prairie):
        bare = stage.shot(prairie, ABOVE)
    crown = np.abs(seen[1] - bare).max(axis=-1) > 12.0
    assert seen[0][crown].mean() == pytest.approx(seen[1][crown].mean(), rel=0.02)


@pytest.mark.slow
def test_a_pictures_outline_is_as_rough_as_with_every_leaf(stage: Stage, prairie: Prairie) -> None:
    """Of an oak so high in the picture as no tree is that is all drawn so."""
    aim = looking(30.0, 1.7, 80.0, pitch=4.5, view=7.6)
    with without_trees(prairie):
        bare = stage.shot(prairie, aim).astype(np.uint8)
    drawn = stage.shot(prairie, aim).astype(np.uint8)
    assert prairie.painter is not None
    oak, *_ = vars(prairie.painter.part(TreePart))["_kinds"]
    assert sum(each.streams[FAR].count for each in oak.models) == 1
    assert not any(each.streams[name].count for each in oak.models for name in CARDS)
    truth = draw_truth(prairie, *stage.matrices(aim), (SIZE, SIZE))
    hidden = np.abs(truth.picture.astype(np.int32) - bare).max(axis=-1) > 12
    told = tree_figures(drawn, truth, Behind(bare, np.ones_like(hidden), hidden))
    assert told is not None
    assert float(str(told["roughness_ratio"])) > 0.75


@pytest.mark.slow
def test_far_off_level_leaves_let_the_sun_through_to_who_looks_up_at_them(stage: Stage, prairie: Prairie) -> None:
    aim, blue = looking(30.0, 1.7, 80.0, pitch=4.5, view=7.6), []
    stage.shot(prairie, aim)
    assert prairie.painter is not None
    part = vars(prairie.painter.part(TreePart))
    oak, programs = part["_kinds"][0], vars(part["_programs"])["_programs"].values()
    kept = [each.normals for each in oak.models]

    def let_lie(all_lies: list[Normals]) -> None:
        for model, lies in zip(oak.models, all_lies, strict=True):
            model.normals = lies
            for program in programs:
                program.extra.pop(id(model), None)
        part["_calls"].clear()

    for lies in ([(0.0, 1.0, 0.0, 1.0)], [(1.0, 0.0, 0.0, 0.5), (0.0, 0.0, 1.0, 0.5)]):
        let_lie([lies + [(0.0, 1.0, 0.0, 0.0)] * (TREE_NORMALS - len(lies))] * len(kept))
        seen = stage.shot(prairie, aim)[30:60, 30:60].mean(axis=(0, 1))
        blue.append(seen[2] / seen[1])
    let_lie(kept)
    assert blue[0] < 0.9 * blue[1]  # what comes through is yellow
