"""Trees in the picture: near and far, in the wind, in the light, and gone when they are felled (F3, F5, F10)."""

import gc
from collections.abc import Callable, Iterator
from typing import Any

import esper
import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass import Lamp, Pose, Prairie, Shade, Tree
from tallgrass.app.bench.steps import held
from tallgrass.systems.reference import draw_truth
from tallgrass.systems.trees import fading, standing, stream
from tallgrass.systems.trees.draw import TreePart
from tallgrass.systems.trees.outline import CORNERS, Outline
from tallgrass.systems.trees.shade import ShadeMap
from tallgrass.systems.trees.wood import Parts
from tallgrass.testing import Stage, little_prairie, looking, private_world
from tallgrass.testing.little import SPARSE

SCENE = (
    SPARSE
    + """\
seed: 5
terrain: { noise: flat, size: [80, 80] }
grass: { turf: { height: [0.2, 0.3], width: 0.02, blades: 60 } }
trees: { ash: { habit: birch, height: [9, 9] } }
wind: [{ kind: breeze, strength: 0.5, speed: 4 }]
light: { azimuth: 90, elevation: 40, haze: 1e6 }
"""
)
AHEAD = looking(0.0, 1.7, 12.0, pitch=14.0, view=57.0)
UP = looking(0.0, 1.7, 6.0, pitch=36.0, view=57.0)
DOWN = looking(0.0, 14.0, 14.0, pitch=-43.0, view=52.0)
Picture = NDArray[np.float64]
Plant = Callable[..., int]


@pytest.fixture(scope="module")
def stage(ctx: moderngl.Context) -> Stage:
    return Stage(ctx, (160, 120))


@pytest.fixture(scope="module")
def prairie(ctx: moderngl.Context) -> Iterator[Prairie]:
    with private_world(), little_prairie(scene=SCENE, ctx=ctx) as made:
        yield made


@pytest.fixture(autouse=True)
def _shade_of_what_is_felled_goes_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(fading, "DURATION", 0.0)


@pytest.fixture
def plant(prairie: Prairie) -> Iterator[Plant]:
    """Plant a tree until the test is over."""
    planted: list[int] = []

    def one(x: float, z: float, **keys: float) -> int:
        planted.append(esper.create_entity(Tree("ash", **{"height": 9.0, **keys}), Pose(x, z)))
        return planted[-1]

    del prairie
    yield one
    for entity in planted:
        if esper.entity_exists(entity):
            esper.delete_entity(entity, immediate=True)


def seen_far(monkeypatch: pytest.MonkeyPatch, gone: float) -> None:
    """Let trees be pictures where they are lower than this [pixels]."""
    monkeypatch.setattr(standing, "PICTURE_BELOW", gone)
    monkeypatch.setattr(standing, "FADES_BELOW", 2.0 * gone)


def changed(one: Picture, other: Picture) -> float:
    return float((np.abs(one - other).max(axis=-1) > 12.0).mean())


def test_a_tree_stands_before_the_sky_and_is_gone_to_the_bit_once_it_is_felled(
    stage: Stage, prairie: Prairie, plant: Plant
) -> None:
    bare = stage.shot(prairie, AHEAD)
    tree = plant(0.0, 0.0)
    with_tree = stage.shot(prairie, AHEAD)
    assert 0.05 < changed(bare, with_tree) < 0.6
    sky, crown = bare[20:60, 60:100].mean(axis=(0, 1)), with_tree[20:60, 60:100].mean(axis=(0, 1))
    assert crown[1] - crown[2] > sky[1] - sky[2] + 35.0  # green, where it was blue
    esper.delete_entity(tree, immediate=True)
    assert np.array_equal(stage.shot(prairie, AHEAD), bare)


def test_it_writes_depth_where_it_hides_what_is_behind(stage: Stage, prairie: Prairie, plant: Plant) -> None:
    plant(0.0, 0.0)
    stage.shot(prairie, AHEAD)
    near = stage.depth()[20:60, 60:100] < 1.0
    assert near.mean() > 0.08  # of a birch, which is sparse


def test_it_is_in_a_games_own_shadow_map(stage: Stage, prairie: Prairie, plant: Plant) -> None:
    plant(0.0, 0.0)
    stage.shot(prairie, AHEAD)
    stage.begin()
    prairie.draw_depth(*stage.matrices(looking(0.0, 30.0, 0.1, pitch=-89.0, view=40.0)))
    over, beside = stage.depth()[40:80, 60:100], stage.depth()[:, :20]
    assert (over < beside.min()).mean() > 0.1  # its crown, whose leaves hardly cover a texel wholly


def test_a_tree_that_is_planted_leaves_nothing_behind_in_gl(
    ctx: moderngl.Context, stage: Stage, prairie: Prairie, plant: Plant
) -> None:
    stage.shot(prairie, AHEAD)
    gc.collect()  # what other tests have left
    before, ctx.gc_mode = ctx.gc_mode, "context_gc"
    ctx.objects.clear()
    try:
        plant(0.0, 0.0)
        stage.shot(prairie, AHEAD)
        plant(2.0, 0.0)
        stage.shot(prairie, AHEAD)
        gc.collect()
        assert [thing for thing in ctx.objects if not isinstance(thing, moderngl.InvalidObject)] == []
    finally:
        ctx.gc_mode = before
        ctx.objects.clear()


def test_its_shadow_falls_away_from_the_sun_and_the_grass_below_is_darker(
    stage: Stage, prairie: Prairie, plant: Plant
) -> None:
    bare = stage.shot(prairie, DOWN)
    plant(14.0, 0.0, height=12.0)  # to the right of the picture, where the sun stands
    below = stage.shot(prairie, DOWN)
    left, right = below[60:, :80].mean() / bare[60:, :80].mean(), below[60:, 80:].mean() / bare[60:, 80:].mean()
    dark = (below / np.maximum(bare, 1.0)).mean(axis=-1)
    assert (dark < 0.75).mean() > 0.02
    assert min(left, right) < 0.99
    assert (dark > 1.15).mean() < 0.01


def test_its_shadow_is_seen_from_afar_too(stage: Stage, prairie: Prairie, plant: Plant) -> None:
    aim = looking(-30.0, 30.0, 65.0, pitch=-18.0, view=14.0)  # so far off that the map of what is near ends before
    bare = stage.shot(prairie, aim)
    plant(-20.0, -30.0, height=12.0)
    ground = stage.ground(aim)
    under = (np.abs(ground[..., 0] + 30.0) < 2.5) & (np.abs(ground[..., 1] + 30.0) < 2.0)
    assert under.sum() > 50
    assert stage.shot(prairie, aim)[under].mean() < 0.85 * bare[under].mean()


@pytest.mark.parametrize("leaves_from", [None, 0.0], ids=["cards", "leaves"])
def test_f5_light_falls_on_the_side_of_a_crown_that_it_comes_from(
    ctx: moderngl.Context, prairie: Prairie, plant: Plant, monkeypatch: pytest.MonkeyPatch, leaves_from: float | None
) -> None:
    stage = Stage(ctx, (320, 240))
    bare = stage.shot(prairie, UP)
    assert prairie.painter is not None
    monkeypatch.setattr(prairie.painter.part(TreePart), "leaves_from", leaves_from)
    plant(0.0, 0.0)
    in_sun = stage.shot(prairie, UP)
    lamp = esper.create_entity(Lamp("#ffffff", 4e6, 30.0), Pose(-4.0, 1.0, y=6.0))
    with_lamp = stage.shot(prairie, UP)
    esper.delete_entity(lamp, immediate=True)
    crown = np.abs(in_sun - bare).max(axis=-1) > 12.0
    left, right = np.arange(320) < 156, np.arange(320) >= 164
    by_sun, by_lamp = ([each[crown & side].mean() for side in (left, right)] for each in (in_sun, with_lamp - in_sun))
    assert by_sun[1] > 1.12 * by_sun[0]
    assert by_lamp[0] > 1.4 * by_lamp[1]


@pytest.mark.parametrize("far", [6.0, 40.0])
def test_f10_a_tree_is_darker_in_the_shade_of_a_games_own_thing(
    stage: Stage, prairie: Prairie, plant: Plant, far: float
) -> None:
    aim = looking(0.0, 4.0, far, pitch=2.0, view=np.degrees(2.0 * np.arctan(4.0 / far)))
    bare = stage.shot(prairie, aim)
    plant(0.0, 0.0)
    lit = stage.shot(prairie, aim)
    x, y, z = (40.0 * along for along in prairie.sun.direction)
    shade = esper.create_entity(Shade((x, y + 5.0, z), 15.0))
    dark = stage.shot(prairie, aim)
    esper.delete_entity(shade, immediate=True)
    crown = np.abs(lit - bare).max(axis=-1) > 12.0
    crown[60:] = False
    assert crown.sum() > 500
    assert dark[crown].mean() < 0.85 * lit[crown].mean()


def test_far_off_it_looks_as_it_does_near_by(
    stage: Stage, prairie: Prairie, plant: Plant, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(standing, "FEWEST_TWIGS", 0.25)  # of a tree that is high enough for twigs
    bare, seen = stage.shot(prairie, AHEAD), []
    for gone in (1.0, 1e5):
        seen_far(monkeypatch, gone)
        tree = plant(0.0, 0.0)
        seen.append(stage.shot(prairie, AHEAD))
        esper.delete_entity(tree, immediate=True)
    near, far = seen
    assert changed(near, far) > 0.01  # it is another representation
    covers = [np.abs(each - bare).max(axis=-1) > 12.0 for each in (near, far)]
    assert covers[1].mean() == pytest.approx(covers[0].mean(), rel=0.3)
    both = covers[0] & covers[1]
    light = [each[both].mean() for each in (near, far)]
    assert light[1] == pytest.approx(light[0], rel=0.2)


@pytest.mark.parametrize(("off", "foliage"), [(12.0, 1.0), (30.0, 1.0), (90.0, 1.0), (60.0, 0.25), (90.0, 0.25)])
def test_however_far_off_it_covers_as_much_of_the_sky_as_with_every_leaf(
    ctx: moderngl.Context, prairie: Prairie, plant: Plant, off: float, foliage: float
) -> None:
    """Leaf by leaf and on cards, on cards alone, and as a picture: each beside the reference."""
    size = 96
    stage = Stage(ctx, (size, size))
    camera = looking(0.0, 1.7, off, pitch=float(np.degrees(np.arctan2(4.0, off))), view=9.5)

    def seen() -> tuple[Picture, Picture]:
        drawn = stage.shot(prairie, camera)
        truth = draw_truth(prairie, *stage.matrices(camera), (size, size), samples=4).picture
        return drawn[..., 2], truth[..., 2].astype(np.float64)

    bare = seen()
    plant(0.0, 0.0, foliage=foliage)
    sky = bare[0] > 120.0  # blue, before which leaves are dark
    drawn, truth = ((before - now)[sky].mean() for before, now in zip(bare, seen(), strict=True))
    assert truth > 5.0
    assert drawn == pytest.approx(truth, rel=0.08 if foliage == 1.0 else 0.2)  # cards cover a little less


def test_n3_held_a_tree_is_shown_as_in_the_frame_before_from_wherever_it_is_seen(
    stage: Stage, prairie: Prairie, plant: Plant, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(standing, "FADES_BELOW", 400.0)  # so that its twigs are fewer
    monkeypatch.setattr(standing, "PICTURE_BELOW", 1.0)

    def told() -> Any:
        assert prairie.painter is not None
        (ash,) = vars(prairie.painter.part(TreePart))["_kinds"]
        streams = [each.streams[name] for each in ash.models for name in stream.CARDS if each.streams[name].count]
        (one,), size, segments = streams, standing.INSTANCE.itemsize, vars(prairie.painter.part(TreePart))["_segments"]
        told = segments.instances.buffer.read(size, offset=one.first * size)
        return np.frombuffer(told, standing.INSTANCE)["twig_share"]

    plant(0.0, 0.0)
    stage.shot(prairie, looking(0.0, 1.7, 4.6, pitch=14.0, view=57.0))
    before, nearer = told(), looking(0.0, 1.7, 4.4, pitch=14.0, view=57.0)
    with held(prairie):
        stage.shot(prairie, nearer)
        assert np.array_equal(told(), before)
    stage.shot(prairie, nearer)
    assert (told() > before).all()


@pytest.mark.parametrize("off", [25.0, 70.0, 200.0])
def test_far_off_nothing_of_it_lies_beyond_its_outline(
    stage: Stage, prairie: Prairie, plant: Plant, off: float
) -> None:
    camera, seen = looking(0.0, 1.7, off, pitch=2.0, view=20.0), list[Picture]()
    bare = stage.shot(prairie, camera)
    plant(0.0, 0.0)
    assert prairie.painter is not None
    part = vars(prairie.painter.part(TreePart))
    (ash,) = part["_kinds"]
    stage.shot(prairie, camera)  # its pictures are there
    kept = [each.outline for each in ash.models]
    assert all(np.mean(each.reaches) < 0.6 for each in kept)  # a birch is narrower than it is high
    for outlines in (kept, [Outline((-1.0, -0.3, 0.3, 1.0), [(1.0,) * CORNERS] * len(kept[0].reaches))] * len(kept)):
        for model, outline in zip(ash.models, outlines, strict=True):
            model.outline = outline
        part["_calls"].clear()
        seen.append(stage.shot(prairie, camera))
    for model, outline in zip(ash.models, kept, strict=True):
        model.outline = outline
    part["_calls"].clear()
    assert changed(seen[0], bare) > 0.0
    assert np.abs(seen[0] - seen[1]).max() <= 2.0  # of 255: a dark twig that hardly covers anything


@pytest.mark.parametrize("away", [0.0, -12.0])
def test_wood_that_is_left_out_of_a_pass_would_cover_no_pixel_in_it(
    stage: Stage, prairie: Prairie, plant: Plant, monkeypatch: pytest.MonkeyPatch, away: float
) -> None:
    seen_far(monkeypatch, 1.0)
    seen = []
    for whole in (False, True):
        if whole:
            monkeypatch.setattr(stream, "parts", lambda whole, edges, *_: Parts(len(whole), len(edges)))
            monkeypatch.setattr(stream, "blocks_inside", lambda blocks, *_: (0, len(blocks.radius)))
        tree = plant(0.0, away)
        seen.append(stage.shot(prairie, AHEAD))
        esper.delete_entity(tree, immediate=True)
    assert np.abs(seen[0] - seen[1]).max() <= 1.0  # of 255: a stem may cover just more than what is left out


def test_it_sways_in_the_wind_and_stands_still_where_time_does(stage: Stage, prairie: Prairie, plant: Plant) -> None:
    plant(0.0, 0.0)
    before = stage.shot(prairie, AHEAD)
    assert np.array_equal(stage.shot(prairie, AHEAD), before)
    prairie.advance(0.4)
    assert changed(before[:60], stage.shot(prairie, AHEAD)[:60]) > 0.01


def test_thin_stems_have_young_bark_and_thick_ones_old_near_and_far(
    stage: Stage, prairie: Prairie, plant: Plant, monkeypatch: pytest.MonkeyPatch
) -> None:
    for gone in (1.0, 1e5):  # as wood, and as a picture
        seen_far(monkeypatch, gone)
        bright = []
        for size in (0.25, 1.0):  # a birch is brown, until its trunk is thick and white
            camera = looking(0.0, 2.5 * size, 12.0 * size, pitch=14.0, view=57.0)
            bare = stage.shot(prairie, camera)
            tree = plant(0.0, 0.0, height=9.0 * size, foliage=0.0)
            seen = stage.shot(prairie, camera)[94:106, 78:82]
            esper.delete_entity(tree, immediate=True)
            trunk = np.abs(seen - bare[94:106, 78:82]).max(axis=-1) > 25.0
            assert trunk.sum() > 16
            bright.append(seen[trunk].mean())
        assert bright[1] > 1.5 * bright[0]


@pytest.mark.parametrize("off", [12.0, 120.0])
def test_bare_trees_have_bark_alone_near_and_far(stage: Stage, prairie: Prairie, plant: Plant, off: float) -> None:
    camera = looking(0.0, 1.7, off, pitch=float(np.degrees(np.arctan2(4.0, off))), view=684.0 / off)

    def green() -> int:
        sky = stage.shot(prairie, camera)[:60]
        return int((sky[..., 1] > sky[..., [0, 2]].max(axis=-1) + 8.0).sum())

    none = stage.shot(prairie, camera)
    tree = plant(0.0, 0.0)
    assert green() > 100
    esper.add_component(tree, Tree("ash", 9.0, foliage=0.0))
    assert green() == 0
    assert changed(none, stage.shot(prairie, camera)) > 0.0


def test_its_shadow_sways_with_the_mean_wind_and_its_map_is_not_drawn_for_that(
    stage: Stage, prairie: Prairie, plant: Plant, monkeypatch: pytest.MonkeyPatch
) -> None:
    plant(14.0, 0.0, height=12.0)  # beside the picture: its shadow alone is seen
    stage.shot(prairie, DOWN)
    assert prairie.painter is not None
    shade = vars(prairie.painter.part(TreePart))["_shade"]
    drawn, told = list(vars(shade)["_drawn"]), []
    for _ in range(3):
        prairie.advance(0.7)
        swayed = stage.shot(prairie, DOWN)
        told.append(prairie.painter.block.record["trees_tones"].tobytes())
    assert len(set(told)) == 3
    assert all(now is before for now, before in zip(vars(shade)["_drawn"], drawn, strict=True))

    def calm(*told: object, time: float) -> None:
        del time
        told[-1]["trees_aside"] = 0.0  # type: ignore[index]

    monkeypatch.setattr(ShadeMap, "sway", calm)
    still = stage.shot(prairie, DOWN)
    assert 0.0005 < changed(swayed, still) < 0.2
    monkeypatch.undo()
    assert np.array_equal(stage.shot(prairie, DOWN), swayed)
