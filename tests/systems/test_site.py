"""A site's contents before anything is drawn (R1, G1)."""

from collections.abc import Callable

import numpy as np
import pytest

from tallgrass.components.viewer import Viewer
from tallgrass.engine.declared.grass import MOST_KINDS, GrassKind
from tallgrass.engine.declared.quality import PRESETS, Quality
from tallgrass.engine.declared.scene import Scene
from tallgrass.engine.terrain.record import Terrain
from tallgrass.systems.around.transitions import SLACK
from tallgrass.systems.grow.record import Growth
from tallgrass.systems.lod import ROOM, reach_of, wanted_representation
from tallgrass.systems.show.blades.plant import stock_blades
from tallgrass.systems.show.blades.pool import BladesKept
from tallgrass.systems.show.carpet.grow import carpet_of
from tallgrass.systems.show.carpet.pool import CarpetKept
from tallgrass.systems.show.registry import NAMES, REPRESENTATIONS
from tallgrass.systems.show.strips.grow import strips_of
from tallgrass.systems.show.strips.pool import StripsKept
from tallgrass.systems.show.strips.stock import stock_strips
from tallgrass.systems.site import LAYERS, Site, farthest_reach, numbers_of, outlook_on

Laid = Callable[..., Site]


def limits(quality: Quality) -> tuple[int, ...]:
    """Return the reach of each representation, from the quality's rings."""
    return tuple(each.reach(quality) for each in REPRESENTATIONS)


@pytest.mark.parametrize("preset", PRESETS)
def test_t4_left_alone_each_representation_reaches_as_far_as_the_quality_says(preset: str) -> None:
    quality = PRESETS[preset]
    expected = (quality.blade_rings[-1].to, quality.strip_rings[-1].to, quality.carpet_to)
    assert reach_of(limits(quality), None) == expected


def kinds(count: int) -> Scene:
    return Scene(tallgrass=2, grass={f"kind-{number}": GrassKind() for number in range(count)})


@pytest.mark.parametrize("preset", PRESETS)
def test_as_many_kinds_as_there_can_be_have_room_for_their_pictures(preset: str) -> None:
    for count in range(1, MOST_KINDS + 1):
        quality = numbers_of(kinds(count), preset)
        assert count * quality.models * max(each.layers(quality) for each in REPRESENTATIONS) <= LAYERS
        assert quality == PRESETS[preset].model_copy(update={"models": quality.models})
        assert quality.models == PRESETS[preset].models or count > 4


def test_what_layers_are_told_is_what_pictures_take(growths: list[Growth], laid: Laid) -> None:
    quality, model = laid().quality, growths[0].models[0]
    told = {each.name: each.layers(quality) for each in REPRESENTATIONS}
    strips = sum(int(np.prod(each.texels.shape[:2])) for each in strips_of(model))
    assert told == {"blades": 0, "strips": strips, "carpet": int(np.prod(carpet_of(model).texels.shape[:2]))}


@pytest.mark.parametrize(("lod", "shown"), [("blades", {0, 2}), ("strips", {1, 2}), ("carpet", {2})])
def test_a_forced_representation_takes_the_finer_ones_place(lod: str, shown: set[int]) -> None:
    quality = PRESETS["low"]
    reach = reach_of(limits(quality), NAMES.index(lod))
    distance = np.arange(quality.carpet_to + 1, dtype=np.int32)
    for current in (-1, 0, 1, 2):
        has = np.full(len(distance), current, np.int8)
        wanted = wanted_representation(distance, has, reach=reach)
        if current == -1:
            assert set(wanted.tolist()) == shown
        finest = wanted[: quality.strip_rings[-1].to + 1]
        assert (finest == min(shown)).all() or current > -1


@pytest.mark.parametrize("lod", ["auto", *NAMES])
def test_a_site_reaches_as_far_as_what_was_forced_on_it(laid: Laid, lod: str) -> None:
    site = laid(lod=lod)
    assert site.reach == reach_of(limits(site.quality), None if lod == "auto" else NAMES.index(lod))


def test_a_site_has_every_representation_from_the_finest_to_the_coarsest(laid: Laid) -> None:
    site = laid()
    assert tuple(each.name for each in site.representations) == NAMES == ("blades", "strips", "carpet")
    assert [each.rings() for each in site.representations] == [2, 2, 1]
    assert site.reach == (2, 6, 9)


def test_pools_have_room_for_all_that_can_be_shown_at_once(laid: Laid) -> None:
    site = laid()
    outlook = outlook_on(site, Viewer(), 0)
    blades, strips, carpet = site.reach
    assert outlook.patches.side == 2 * carpet + 1
    pool, pools = outlook.keeps(BladesKept).pool, outlook.keeps(StripsKept).pools
    assert pool.side == 2 * (blades + SLACK + ROOM) + 1
    assert [each.side for each in pools] == [2 * (strips + SLACK + ROOM) + 1] * 2
    assert (pool.slots, pool.shape) == (pool.side**2, (30 + 12,))
    assert [(each.slots, each.shape) for each in pools] == [
        (2 * each.side**2, (2, strips, edges)) for each, strips, edges in zip(pools, (3, 2), (3, 2), strict=True)
    ]
    over = outlook.keeps(CarpetKept).pool
    assert (over.slots, over.shape) == (outlook.patches.side**2, (1,))


def test_each_viewer_has_patches_and_pools_of_its_own(laid: Laid) -> None:
    site = laid()
    one, other = outlook_on(site, Viewer("left"), 1), outlook_on(site, Viewer("right"), 2)
    assert (one.patches.viewer, other.patches.viewer) == ("left", "right")
    assert list(one.kept) == list(other.kept) == list(NAMES)
    assert not np.shares_memory(one.patches.cell, other.patches.cell)
    assert not np.shares_memory(one.keeps(BladesKept).pool.present, other.keeps(BladesKept).pool.present)
    for name in NAMES:
        for mine, theirs in zip(one.kept[name].receiving, other.kept[name].receiving, strict=True):
            assert mine.pool is not theirs.pool
            mine.messages.ask(0)[:] = (0.0, 0.5)
            assert mine.messages.busy
            assert not theirs.messages.busy


def test_the_finest_level_is_the_most_segments_of_any_ring(laid: Laid) -> None:
    assert laid().finest == 3


def test_g1_the_blades_of_a_model_are_in_stock_in_all_four_turns(growths: list[Growth]) -> None:
    stock = stock_blades(growths, 2.5)
    assert stock.records.shape == (2 * 4, 42)
    for model in range(2):
        for turn in range(4):
            records = stock.records[model * 4 + turn]
            expected = np.concatenate([growth.models[model].blades.height for growth in growths])
            np.testing.assert_array_equal(records["height"], expected)
            assert ((records["root"] >= -1e-6) & (records["root"] <= 2.5 + 1e-6)).all()


def test_g1_the_layers_of_a_ring_hold_each_kinds_models_orientations_and_strips(growths: list[Growth]) -> None:
    near, far = 2 * 2 * 3, 2 * 2 * 2
    assert stock_strips(growths).pictures == [0, near, 0, 0, 2 * near, 2 * near + far, 0, 0]


def test_r1_the_blades_of_the_field_are_counted_by_density(laid: Laid, hills: Terrain) -> None:
    width, depth = hills.size
    patches = width * depth / 2.5**2
    assert laid().blades == pytest.approx(42 * patches, rel=1e-6)
    thin = np.stack([np.full((2, 2), 0.5), np.zeros((2, 2))]).astype(np.float32)
    assert laid(dense=thin).blades == pytest.approx(15 * patches, rel=1e-6)


def test_t2_no_blade_reaches_farther_than_culling_reckons_with(laid: Laid) -> None:
    site = laid()
    for kind, growth in zip(site.scene.grass.values(), site.growths, strict=True):
        assert farthest_reach(kind, growth) <= kind.height[1]
        tips = np.abs(growth.postures.shape[..., 0]).max()
        for model in growth.models:
            assert float(model.blades.height.max() * tips) <= site.sway + 1e-6
            for strips in strips_of(model):
                assert strips.margin <= site.sway + growth.models[0].blades.width.max()
    assert site.sway > 0.5
