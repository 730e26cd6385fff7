"""What a prairie holds without any GL (R1, G1)."""

from collections.abc import Callable

import numpy as np
import pytest

from tallgrass.engine.declared.quality import PRESETS
from tallgrass.engine.terrain.record import Terrain
from tallgrass.systems.field import Field, blades_in_field, farthest_reach, reach_of
from tallgrass.systems.grow.record import Growth
from tallgrass.systems.lod import ROOM, SLACK, wanted_representation
from tallgrass.systems.stock.stock import stock_up

Laid = Callable[..., Field]


@pytest.mark.parametrize("preset", PRESETS)
def test_t4_left_alone_each_representation_reaches_as_far_as_the_quality_says(preset: str) -> None:
    assert reach_of(PRESETS[preset], "auto") == PRESETS[preset].reach


@pytest.mark.parametrize(("lod", "shown"), [("blades", {0, 2}), ("strips", {1, 2}), ("carpet", {2})])
def test_a_forced_representation_takes_the_finer_ones_place(lod: str, shown: set[int]) -> None:
    quality = PRESETS["low"]
    distance = np.arange(quality.carpet_to + 1, dtype=np.int32)
    for current in (-1, 0, 1, 2):
        has = np.full(len(distance), current, np.int8)
        wanted = wanted_representation(distance, has, reach=reach_of(quality, lod))
        if current == -1:
            assert set(wanted.tolist()) == shown
        finest = wanted[: quality.reach[1] + 1]
        assert (finest == min(shown)).all() or current > -1


def test_pools_have_room_for_all_that_can_be_shown_at_once(laid: Laid) -> None:
    field = laid()
    blades, strips, carpet = field.reach
    assert field.table.side == 2 * carpet + 1
    assert field.blades.side == 2 * (blades + SLACK + ROOM) + 1
    assert [pool.side for pool in field.strips] == [2 * (strips + SLACK + ROOM) + 1] * 2
    assert field.blades.blade.shape == (field.blades.side**2, 30 + 12)
    assert [pool.layer.shape[1:] for pool in field.strips] == [(2, 3), (2, 2)]
    assert [pool.place.shape[3] for pool in field.strips] == [3, 2]


def test_the_finest_level_is_the_most_segments_of_any_ring(laid: Laid) -> None:
    assert laid().finest == 3


def test_g1_the_blades_of_a_model_are_in_stock_in_all_four_turns(growths: list[Growth]) -> None:
    stock = stock_up(growths, 2.5)
    assert stock.blades.records.shape == (2 * 4, 42)
    for model in range(2):
        for turn in range(4):
            records = stock.blades.records[model * 4 + turn]
            expected = np.concatenate([growth.models[model].blades.height for growth in growths])
            np.testing.assert_array_equal(records["height"], expected)
            assert ((records["root"] >= -1e-6) & (records["root"] <= 2.5 + 1e-6)).all()


def test_g1_the_layers_of_a_ring_hold_each_kinds_models_orientations_and_strips(growths: list[Growth]) -> None:
    stock = stock_up(growths, 2.5)
    assert stock.first_layer == [[0, 2 * 2 * 3], [0, 2 * 2 * 2]]


def test_r1_the_blades_of_the_field_are_counted_by_density(laid: Laid, hills: Terrain) -> None:
    width, depth = hills.size
    patches = width * depth / 2.5**2
    assert blades_in_field(laid()) == pytest.approx(42 * patches, rel=1e-6)
    thin = np.stack([np.full((2, 2), 0.5), np.zeros((2, 2))]).astype(np.float32)
    assert blades_in_field(laid(dense=thin)) == pytest.approx(15 * patches, rel=1e-6)


def test_t2_no_blade_reaches_farther_than_culling_reckons_with(laid: Laid) -> None:
    field = laid()
    for kind, growth in zip(field.scene.grass.values(), field.growths, strict=True):
        assert farthest_reach(kind, growth) <= kind.height[1]
        tips = np.abs(growth.postures.shape[..., 0]).max()
        for model in growth.models:
            assert float(model.blades.height.max() * tips) <= field.sway + 1e-6
            for strips in model.strips:
                assert strips.margin <= field.sway + growth.models[0].blades.width.max()
    assert field.sway > 0.5
