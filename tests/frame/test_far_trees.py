"""Pictures of whole trees: as fine as pixels where they begin, and mixed by clumps that lie in no lattice (F3, F4)."""

import math
from collections.abc import Callable, Iterator

import esper
import moderngl
import numpy as np
import pytest

from tallgrass import Pose, Prairie, Tree
from tallgrass.app.bench.trees import Behind, tree_figures
from tallgrass.engine.camera import Camera
from tallgrass.systems.reference import draw_truth, without_trees
from tallgrass.systems.trees import standing
from tallgrass.systems.trees.draw import TreePart
from tallgrass.systems.trees.far import COLUMNS, LEVEL_BIAS, LINES, ROWS
from tallgrass.systems.trees.habit import HABITS
from tallgrass.systems.trees.model import models_of
from tallgrass.testing import Stage, little_prairie, looking, private_world
from tallgrass.testing.little import SPARSE

SCENE = (
    SPARSE
    + """\
seed: 5
terrain: { noise: flat, size: [120, 120] }
grass: { turf: { height: [0.05, 0.08], width: 0.02, blades: 30, place: none } }
trees: { thorn: { habit: hawthorn, height: [3.8, 3.8], positions: [[0, 0]] } }
light: { azimuth: 130, elevation: 40, haze: 1e6, clouds: 0 }
"""
)
SIZE, HIGH = 96, 3.8
CLUMP = 16  # pixels over which a clump may be like itself
WHOLE = 180  # pixels of a picture of a whole bush, which is 135 high on it
AWAY = looking(0.0, 1.7, 25.0, pitch=0.4, view=11.57)
ABOVE = looking(0.0, 14.0, 21.8, pitch=-29.0, view=11.57)


@pytest.fixture(scope="module")
def stage(ctx: moderngl.Context) -> Stage:
    return Stage(ctx, (SIZE, SIZE))


@pytest.fixture(scope="module")
def prairie(ctx: moderngl.Context, stage: Stage) -> Iterator[Prairie]:
    with private_world(), little_prairie(scene=SCENE, ctx=ctx) as made:
        stage.shot(made, AWAY)
        yield made


@pytest.mark.parametrize("habit", HABITS)
def test_where_a_tree_begins_to_be_a_picture_no_texel_is_larger_than_a_pixel(habit: str) -> None:
    for model in models_of(habit, 4):
        assert model.lines >= standing.FADES_BELOW > standing.PICTURE_BELOW


def test_a_picture_is_as_blurred_as_the_mean_over_a_pixel() -> None:
    """A texel is a mean over itself, and is read between its neighbours."""
    texel, lies = 2.0**LEVEL_BIAS, np.random.default_rng(3).uniform(-0.5, 0.5, (4, 100_000))
    assert (texel * lies[:3].sum(axis=0)).std() == pytest.approx(lies[3].std(), rel=0.02)


def test_clumps_of_one_picture_give_way_to_those_of_another_in_no_lattice(
    stage: Stage, prairie: Prairie, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Half-way between a picture that is bright all over and one that is dark."""
    monkeypatch.setattr(standing, "PICTURE_BELOW", 1e5)
    monkeypatch.setattr(standing, "FADES_BELOW", 2e5)
    between = math.pi / COLUMNS
    tree = esper.create_entity(Tree("thorn", height=HIGH), Pose(30.0, 0.0, between))
    stage.shot(prairie, looking(30.0, 2.0, 50.0, view=10.0))
    assert prairie.painter is not None
    (thorn,) = vars(prairie.painter.part(TreePart))["_kinds"]
    model = thorn.models[0].model
    pictured = 2.0 * model.half / model.height * HIGH
    aim = looking(30.0, 2.0, 0.5 * SIZE / math.tan(math.radians(5.0)) * pictured / LINES, view=10.0)
    stage.shot(prairie, aim)
    kept = [model.far.read() for model in thorn.models]
    seen = []
    for bright in ((), range(0, COLUMNS, 2), range(COLUMNS)):
        for model in thorn.models:
            tiles = np.zeros((ROWS, model.model.lines, COLUMNS, model.model.wide, 4), np.uint8)
            tiles[..., 3] = 255
            tiles[:, :, [*bright], :, 0] = 255
            model.far.write(tiles.tobytes())
        seen.append(stage.shot(prairie, aim).mean(axis=2))
    for model, texels in zip(thorn.models, kept, strict=True):
        model.far.write(texels)
    esper.delete_entity(tree, immediate=True)
    dark, mixed, light = seen
    share = (mixed - dark) / np.maximum(light - dark, 1.0)
    assert (light - dark).min() > 10.0
    assert 0.4 < share.mean() < 0.6
    assert share.std() > 0.3  # one of the two in most places
    share -= share.mean()
    alike = np.fft.fftshift(np.fft.irfft2(np.abs(np.fft.rfft2(np.pad(share, SIZE // 2))) ** 2))
    alike /= alike[SIZE, SIZE]
    down, across = np.indices(alike.shape) - SIZE
    assert alike[(np.hypot(down, across) > CLUMP) & (np.maximum(abs(down), abs(across)) < SIZE // 2)].max() < 0.3


@pytest.mark.parametrize("pixels", [6.0, 9.0, 13.0])
def test_over_the_top_of_a_tree_that_is_few_pixels_high_there_is_sky(
    stage: Stage, prairie: Prairie, pixels: float
) -> None:
    """On their texture, pictures of it from higher up lie there, whose feet are wide."""
    aim = looking(0.0, 1.7, 60.0, pitch=4.0, view=math.degrees(2.0 * math.atan(HIGH * SIZE / (120.0 * pixels))))
    with without_trees(prairie):
        bare = stage.shot(prairie, aim)
    rows = np.abs(stage.shot(prairie, aim) - bare).max(axis=(1, 2))
    high = SIZE / 2.0 - (HIGH - 1.7 - 60.0 * math.tan(math.radians(4.0))) * pixels / HIGH
    assert rows.max() > 30.0
    assert rows[: int(high) - 2].max() <= 1.0  # a texel of them is read between its neighbours


@pytest.mark.parametrize("aim", [AWAY, ABOVE])
def test_a_bush_is_as_bright_and_has_an_outline_and_grain_as_with_every_leaf(
    ctx: moderngl.Context, prairie: Prairie, aim: Camera
) -> None:
    """Of a hedge twenty-five metres off."""
    stage = Stage(ctx, (WHOLE, WHOLE))
    with without_trees(prairie):
        bare = stage.shot(prairie, aim).astype(np.uint8)
    drawn = stage.shot(prairie, aim).astype(np.uint8)
    truth = draw_truth(prairie, *stage.matrices(aim), stage.size)
    hidden = np.abs(truth.picture.astype(np.int32) - bare).max(axis=-1) > 12
    told = tree_figures(drawn, truth, Behind(bare, np.ones_like(hidden), hidden))
    assert told is not None
    assert float(str(told["luminance_ratio"])) == pytest.approx(1.0, abs=0.05)
    assert float(str(told["contrast"])) > 0.85
    assert float(str(told["roughness_ratio"])) > 0.87


BIRCHES = SCENE.replace(
    "thorn: { habit: hawthorn, height: [3.8, 3.8], positions: [[0, 0]] }",
    "ash: { habit: birch, height: [9, 9], positions: [[0, -28], [9, -40]] }",
)


def test_f3_a_tree_whose_pictures_are_nowhere_opaque_is_drawn_as_they_are(
    stage: Stage, ctx: moderngl.Context, pictured: Callable[[int], None]
) -> None:
    pictured(60)
    aim = looking(0.0, 1.7, 30.0, pitch=4.0, view=14.0)
    with private_world(), little_prairie(scene=BIRCHES, ctx=ctx) as made:
        shown = stage.shot(made, aim).astype(int)
        for entity, _ in esper.get_component(Tree):
            esper.delete_entity(entity, immediate=True)
        assert np.abs(stage.shot(made, aim) - shown).max() > 5


def test_f3_the_foot_of_a_tree_far_off_is_no_nearer_than_its_trunk(stage: Stage, ctx: moderngl.Context) -> None:
    aim = looking(0.0, 1.7, 12.0, pitch=2.0, view=14.0)
    with private_world(), little_prairie(scene=BIRCHES, ctx=ctx) as made:
        stage.shot(made, aim)
    _, projection = stage.matrices(aim)
    away = projection[2, 3] / (2.0 * stage.depth() - 1.0 + projection[2, 2])
    tree, beside = away[:, 40:56].min(axis=1), away[:, :6].min(axis=1)
    trunk = tree[tree < beside - 0.3]  # where it is before what is beside it
    assert len(trunk) > 30
    assert trunk.min() > 38.5


def test_f3_a_birch_far_off_has_its_bands(stage: Stage, ctx: moderngl.Context) -> None:
    """Of a trunk two pixels wide."""
    with private_world(), little_prairie(scene=BIRCHES, ctx=ctx) as made:
        trunk = stage.shot(made, looking(0.0, 1.7, 12.0, pitch=2.0, view=14.0))[63:76, 47:49].mean(axis=(1, 2))
    assert 125.0 < trunk.mean() < 155.0
    assert 12.0 < trunk.std() < 35.0


def test_a_trunk_has_a_dark_foot_far_off_as_it_has_near_by(
    ctx: moderngl.Context, stage: Stage, monkeypatch: pytest.MonkeyPatch
) -> None:
    grass = SCENE.replace("[0.05, 0.08]", "[0.5, 0.5]").replace(", place: none", "")
    scene = grass.replace("habit: hawthorn, height: [3.8, 3.8]", "habit: pine, height: [15, 15], foliage: 0.01")
    aim, dark = looking(0.0, 1.2, 50.0, view=3.5), list[float]()
    for gone in (1.0, 1e5):  # as wood, and as a picture
        monkeypatch.setattr(standing, "PICTURE_BELOW", gone)
        monkeypatch.setattr(standing, "FADES_BELOW", 2.0 * gone)
        with private_world(), little_prairie(scene=scene, ctx=ctx) as made:
            trunk = stage.shot(made, aim)[:, 46:50].mean(axis=(1, 2))
        dark.append(float(trunk[48:76].mean() / trunk[10:20].mean()))  # up to 1.2 m over the ground, and at 2.3 m
    assert max(dark) < 0.92
    assert dark[1] == pytest.approx(dark[0], abs=0.08)
