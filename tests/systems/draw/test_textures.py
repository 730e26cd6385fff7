"""Textures of growths and of the terrain (G1)."""

from dataclasses import replace

import moderngl
import numpy as np
import pytest

from tallgrass.engine.gl.mipmaps import at_once, levels
from tallgrass.engine.gl.stream import release_all
from tallgrass.engine.terrain.record import Density, Terrain
from tallgrass.systems.grow.record import Growth
from tallgrass.systems.land.heights import Heights
from tallgrass.systems.land.part import density_texture, posture_texture
from tallgrass.systems.light.lie import slow_map
from tallgrass.systems.light.repeating import LITTER_ONE, SIDE, ground_maps, repeating_levels
from tallgrass.systems.show.carpet.grow import carpet_of
from tallgrass.systems.show.carpet.levels import FINEST, seen_levels
from tallgrass.systems.show.carpet.textures import sending_carpet
from tallgrass.systems.show.strips.pages import ALIGNMENT, packed
from tallgrass.systems.show.strips.stock import stock_strips
from tallgrass.systems.show.strips.textures import (
    extent_texture,
    painted_extents,
    sending_strips,
    strip_atlas,
    strip_stocks,
)


@pytest.mark.parametrize("ring", [0, 1])
def test_g1_each_picture_of_the_atlas_is_the_strip_that_planting_reckons_with(
    ctx: moderngl.Context, growths: list[Growth], ring: int
) -> None:
    every = strip_stocks(growths)
    made = strip_atlas(every, [2, 1])
    atlas, ranks = (at_once(sending_strips(ctx, levels)) for levels in (made.texels, made.ranks))
    width, height, pages = atlas.size
    texels = np.frombuffer(atlas.read(), np.uint8).reshape(pages, height, width, 4)
    ranked = np.frombuffer(ranks.read(alignment=1), np.uint8).reshape(pages, height, width)
    first = stock_strips(growths).pictures[2 * len(growths) * ring :]
    for kind, models in enumerate(every[ring]):
        for model, strips in enumerate(models):
            _, count, h, w, _ = strips.texels.shape
            for orientation in (0, 1):
                start = first[kind] + (model * 2 + orientation) * count
                for number, extents in enumerate(made.extents[start : start + count]):
                    page, (column, row) = int(extents[0, 3]), np.rint(extents[-1, :2] * (width, height)).astype(int)
                    np.testing.assert_allclose(extents[-1, 2:] * (width, height), (w, h), rtol=1e-6)
                    rows, columns = np.nonzero(strips.texels[orientation, number, ..., 3])
                    if not len(rows):  # no tuft stands there
                        continue
                    mine = page, row + rows, column + columns
                    np.testing.assert_array_equal(texels[mine], strips.texels[orientation, number, rows, columns])
                    np.testing.assert_array_equal(ranked[mine], strips.ranks[orientation, number, rows, columns])
                    beside = max(column + columns.min() - min(2, columns.min()), 0)
                    end = column + columns.max() + 1 + min(2, w - 1 - columns.max())
                    around = texels[page, row : row + min(rows.max() + 3, h), beside:end, 3]
                    assert np.count_nonzero(around) == len(rows), "no other's is seen"
    assert (start + count == len(made.extents)) == (ring == 1)
    release_all(atlas, ranks)


def test_pages_hold_every_picture_apart_and_little_else() -> None:
    """The sizes of the meadow's pictures at `high`, and of single ones."""
    rings = [((58, 190), 54), ((50, 274), 54), ((96, 316), 60), ((84, 457), 60), ((48, 158), 18), ((32, 172), 12)]
    meadow = np.array([size for size, count in rings for _ in range(count)])
    for sizes, fullest in ((meadow, 0.8), (np.array([(7, 1500)]), 0.4), (np.array([(900, 20), (8, 8)]), 0.0)):
        kinds = np.arange(len(sizes)) % 2
        pages = packed(sizes, kinds)
        taken = np.zeros(pages.shape, np.int32)
        stands = np.zeros((*pages.shape[:2], 2), np.bool_)
        for number, ((page, row, column), (high, wide)) in enumerate(zip(pages.places, sizes, strict=True)):
            assert (row % ALIGNMENT, column % ALIGNMENT) == (0, 0)
            mine = taken[page, row : row + high, column : column + wide]
            assert mine.shape == (high, wide)
            mine += 1
            stands[page, row, kinds[number]] = True
        assert taken.max() == 1
        assert not stands.all(axis=2).any(), "side by side are those of one kind"
        assert taken.mean() > fullest


@pytest.mark.parametrize("columns", [1, 2, 3])
def test_nothing_is_painted_beyond_a_columns_extents(growths: list[Growth], columns: int) -> None:
    for strips in strip_stocks(growths)[0][1]:
        painted = strips.texels[..., 3].reshape(-1, *strips.texels.shape[2:4]) > 0
        layers, rows, width = painted.shape
        extents = painted_extents(strips, columns)
        assert extents.shape == (layers, columns, 3)
        up, across = (np.arange(rows) + 0.5) / rows, (np.arange(width) + 0.5) / width * columns
        column = across.astype(int)
        start, end, top = np.moveaxis(extents[:, column], 2, 0)[:, :, None]
        inside = (across - column >= start) & (across - column <= end) & (up[:, None] <= top)
        assert not (painted & ~inside).any()
        # They are tight: so much of what they leave out would be drawn for nothing.
        assert inside.mean() < 0.85
        assert (extents[..., 2].max(axis=1) * rows <= painted.any(axis=2).cumsum(axis=1).argmax(axis=1) + 2.01).all()


def test_an_empty_column_has_no_extents(growths: list[Growth]) -> None:
    strips = strip_stocks(growths)[0][0][0]
    half = strips.texels.shape[3] // 2
    texels = strips.texels.copy()
    texels[:, :, :, :half] = 0
    extents = painted_extents(replace(strips, texels=texels), 2)
    assert (extents[:, 0] == 0.0).all()
    assert (extents[:, 1, 2] > 0.5).all()


def test_extents_stand_by_picture_of_the_atlas(ctx: moderngl.Context, growths: list[Growth]) -> None:
    every = strip_stocks(growths)
    texture = extent_texture(ctx, strip_atlas(every, [2, 1]).extents)
    read = np.frombuffer(texture.read(), np.float32).reshape(texture.height, 3, 4)
    fine = [painted_extents(strips, 2) for models in every[0] for strips in models]
    np.testing.assert_array_equal(read[: sum(map(len, fine)), :2, :3], np.concatenate(fine))
    coarse = [painted_extents(strips, 1) for models in every[1] for strips in models]
    np.testing.assert_array_equal(read[sum(map(len, fine)) :, :1, :3], np.concatenate(coarse))
    texture.release()


def test_w3_posture_layers_hold_places_and_directions(ctx: moderngl.Context, growths: list[Growth]) -> None:
    texture = posture_texture(ctx, growths)
    points, rows, layers = texture.size
    table = np.frombuffer(texture.read(), np.float32).reshape(layers, rows, points, 4)
    assert layers == sum(growth.postures.shape.shape[0] for growth in growths)
    np.testing.assert_array_equal(table[len(growths[0].postures.shape) :, :, :, :2], growths[1].postures.shape)
    step = np.diff(table[..., :2], axis=2)
    np.testing.assert_allclose(table[:, :, 1:-1, 2:], (step[:, :, 1:] + step[:, :, :-1]) / 2, atol=1e-6)
    texture.release()


def test_g4_carpet_layers_are_kinds_models_slopes_and_directions(ctx: moderngl.Context, growths: list[Growth]) -> None:
    texture = at_once(sending_carpet(ctx, growths))
    width, height, layers = texture.size
    texels = np.frombuffer(texture.read(), np.uint8).reshape(layers, height, width, 4)
    each = len(carpet_of(growths[0].models[0]).slope) * 4
    assert layers == 2 * 2 * each
    for number, growth in enumerate(growths):
        for model in range(2):
            start = (number * 2 + model) * each
            carpet = carpet_of(growth.models[model])
            finest = [seen_levels(*row)[0] for row in zip(carpet.texels, carpet.slope.tolist(), strict=True)]
            np.testing.assert_array_equal(texels[start : start + each], np.concatenate(finest))
    texture.release()


def test_g4_mip_levels_of_the_carpet_are_means_over_what_a_pixel_covers() -> None:
    images = np.random.default_rng(0).integers(0, 256, (4, 8, 8, 4), np.uint8)
    given = levels(images)
    for number, covered in ((0, 3.0 / FINEST), (1, 3.0)):
        level, seen = given[number], seen_levels(images, 1.0 / np.sqrt(covered * covered - 1.0))[number]
        for direction, axis in enumerate((0, 1, 0, 1)):  # along z, along x, and back
            whole = level[direction].astype(float)
            three = [np.roll(whole, by, axis) for by in (-1, 0, 1)]
            np.testing.assert_allclose(seen[direction], np.mean(three, axis=0), atol=0.5001)


def test_g4_flat_lines_of_sight_see_whole_rows_of_the_carpet_at_once() -> None:
    images = np.random.default_rng(0).integers(0, 256, (4, 8, 8, 4), np.uint8)
    finest = seen_levels(images, 0.02)[0]
    assert np.ptp(finest[::2], axis=1).max() == np.ptp(finest[1::2], axis=2).max() == 0
    assert np.ptp(finest[::2], axis=2).mean() > 50.0
    np.testing.assert_allclose(finest.mean(axis=(1, 2)), images.mean(axis=(1, 2)), atol=0.5)


def test_t1_heights_are_kept_to_the_last_bit_which_tells_of_holes(ctx: moderngl.Context, hills: Terrain) -> None:
    holes = np.random.default_rng(0).random(hills.heights.shape) < 0.3
    for each in (None, holes):
        texture = Heights(ctx, Terrain(hills.heights, hills.cell, each)).texture
        bits = np.frombuffer(texture.read(), np.uint32).reshape(hills.heights.shape)
        np.testing.assert_array_equal(bits & 1, 0 if each is None else each)
        np.testing.assert_array_equal(bits >> 1, hills.heights.view(np.uint32) >> 1)
        texture.release()


@pytest.mark.parametrize(("kinds", "layers"), [(3, 1), (4, 1), (9, 3)])
def test_each_kinds_density_is_a_channel_of_a_layer(ctx: moderngl.Context, kinds: int, layers: int) -> None:
    maps = np.random.default_rng(0).random((kinds, 5, 7)).astype(np.float32)
    texture = density_texture(ctx, Density(maps, (70.0, 50.0)))
    packed = np.frombuffer(texture.read(), np.uint8).reshape(-1, 5, 7, 4)
    channels = np.moveaxis(packed, -1, 1).reshape(-1, 5, 7)
    np.testing.assert_allclose(channels[:kinds] / 255.0, maps, atol=0.5 / 255 + 1e-6)
    assert (channels[kinds:] == 0).all()
    assert len(packed) == layers
    texture.release()


def test_what_is_slow_over_the_terrain_are_two_noises_of_the_seed(hills: Terrain) -> None:
    packed = slow_map(hills.size, hills.origin, seed=4)
    assert packed.shape == (70, 90, 2)
    np.testing.assert_array_equal(slow_map(hills.size, hills.origin, seed=4), packed)
    assert (slow_map(hills.size, hills.origin, seed=5) != packed).mean() > 0.9
    for noise in np.moveaxis(packed / 127.5 - 1.0, -1, 0):
        assert np.abs(np.diff(noise, axis=0)).max() < 0.35
        assert noise.std() > 0.1


def test_litter_is_as_bright_from_afar_as_from_near_by() -> None:
    """Every mip level has the same mean: a driver that rounds up at each would make far ground brighter."""
    levels = repeating_levels(seed=4)
    assert [len(texels) for texels in levels] == [512 >> level for level in range(10)]
    means = [texels.mean(axis=(0, 1)) for texels in levels]
    np.testing.assert_allclose(means, means[:1] * 10, atol=0.6)
    bright, _ = ground_maps(seed=4)
    assert np.mean((bright / LITTER_ONE) ** 2) == pytest.approx(1.0, abs=0.02)


def test_squares_of_ground_do_not_show_from_afar_where_they_repeat() -> None:
    """They have hardly any large spots, neither in brightness nor in hue."""
    bright, leaves = ground_maps(seed=4)
    assert leaves.mean() / 255.0 == pytest.approx(2.0 / 3.0, abs=0.03)
    assert ((leaves > 0) & (leaves < 255)).mean() > 0.15  # edges are even
    for seen, most in ((bright / LITTER_ONE, 0.02), (leaves / 255.0, 0.08)):
        large = seen.reshape(4, SIDE // 4, 4, SIDE // 4).mean(axis=(1, 3))
        assert large.std() < most * seen.mean()


def test_ground_is_made_where_a_host_lets_numpy_raise_whatever_happens() -> None:
    with np.errstate(all="raise"):
        ground_maps(seed=4)
