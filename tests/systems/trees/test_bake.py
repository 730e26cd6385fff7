"""Pictures of trees: as broad as the tree, and how light has come to what they show (F3)."""

import moderngl
import numpy as np
import pytest

from tallgrass.engine.gl.guest import guest
from tallgrass.systems.trees.bake import COARSEST, card_texels, dilated, equalised, picture_size, pictures, tree_levels
from tallgrass.systems.trees.far import COARSER, LINES
from tallgrass.systems.trees.noise import FINER, NOISE_CELLS, bark_noise
from tallgrass.systems.trees.twig import MEAN_TONE


@pytest.mark.parametrize("breadth", [0.07, 0.31, 0.8, 1.0])
def test_a_picture_is_hardly_broader_than_what_it_shows(breadth: float) -> None:
    lines, wide = picture_size(breadth)
    assert wide % COARSEST == lines % COARSEST == 0
    assert 0 <= lines - LINES < COARSEST
    assert 0 <= wide - lines * breadth < COARSEST


def test_how_light_has_come_is_the_mean_of_what_is_covered_and_goes_on_where_nothing_is() -> None:
    draw = np.random.default_rng(2)
    cover = np.where(draw.uniform(size=(32, 48)) < 0.3, 255.0, 0.0).astype(np.float32)
    cover[:, 16:] = 0.0
    light = np.full((32, 48, 4), 90.0, np.float32)
    light[:16] = 200.0
    levels = dilated(light * (cover / 255.0)[..., None], cover, 3)
    assert [each.shape for each in levels] == [(1, 32 >> level, 48 >> level, 4) for level in range(3)]
    for level, each in enumerate(levels):
        edge = 16 >> level
        assert (each[0, :edge, :edge] == 200).all()
        assert (each[0, edge:, :edge] == 90).all()
    assert ((levels[0] >= 90) & (levels[0] <= 200)).all()
    nothing = np.zeros((32, 48), np.float32)
    assert not dilated(light, nothing, 3)[0].any()  # as where a driver draws nothing


@pytest.mark.gl
def test_pictures_are_empty_where_the_driver_draws_nothing_into_what_lay_in_memory(
    ctx: moderngl.Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = ctx.fbo

    def shown() -> float:
        with guest(ctx):
            return float(pictures(ctx, 2, 1, 8, 16, lambda _: ctx.fbo.clear(0.5, 0.5, 0.5, 0.5)).mean())

    assert shown() == pytest.approx(127.5, abs=1.0)
    monkeypatch.setattr("tallgrass.systems.trees.bake.clear", lambda *_, **__: None)
    assert shown() == 0.0
    before.use()


def test_of_a_tree_texels_are_larger_that_tell_how_light_has_come() -> None:
    values = np.full((2, 64, 96, 4), 255.0, np.float32)
    values[1] = 80.0
    shows, met = tree_levels(values)
    assert met[0].shape == (1, 64 // COARSER, 96 // COARSER, 4)
    assert met[-1].shape == shows[-1].shape
    assert all((each == 255).all() for each in shows)
    assert all((each == 80).all() for each in met)


def test_leaves_on_cards_have_the_mean_tone_of_all_twigs_whichever_those_of_the_twig_drawn() -> None:
    draw = np.random.default_rng(6)
    layers = draw.integers(0, 256, (4, 16, 16, 4)).astype(np.uint8)
    layers[::2, ..., 3] = 255
    ribbed = np.where(draw.uniform(size=(2, 16, 16)) < 0.2, 0.8, 1.0)
    leaf_tone = np.array([0.5, 0.75])[:, None, None]
    layers[::2, ..., 0], layers[::2, ..., 1] = 255.0 * leaf_tone * ribbed, 255.0 * ribbed
    made = card_texels(layers)
    assert made[..., 0].mean(axis=(1, 2)) == pytest.approx(MEAN_TONE * 255.0 * ribbed.mean(axis=(1, 2)), rel=0.01)
    assert np.array_equal(made[..., 1:3], layers[1::2, ..., :2])
    assert np.array_equal(made[..., 3], layers[::2, ..., 3])


def test_what_is_solid_of_a_card_is_as_bright_as_all_of_it() -> None:
    draw = np.random.default_rng(4)
    cover = draw.integers(0, 256, (2, 32, 32))
    tone = np.stack([0.5 + 0.2 * (cover[0] > 150), 0.3 + 0.2 * (cover[1] > 150)]) * cover
    pictures = np.stack([tone, cover, cover, cover], axis=-1).round().astype(np.uint8)
    made = equalised(pictures, 150.0).astype(np.float64)
    for own, before, covered in zip(made, pictures, cover, strict=True):
        for some in (covered >= 150, covered < 150):
            mean = before[..., 0].sum() / covered.sum()
            assert own[some, 0].sum() / covered[some].sum() == pytest.approx(mean, rel=0.01)
    assert np.array_equal(made[..., 1:], pictures[..., 1:])


def test_bark_is_as_smooth_across_the_borders_of_its_cells_as_it_is_in_their_middles_and_repeats() -> None:
    texels = bark_noise()[0][0].astype(np.float64)
    for axis in (0, 1):
        steps = np.abs(np.diff(texels, axis=axis, append=texels.take([0], axis=axis)))
        by_place = np.moveaxis(steps, axis, 0).reshape(NOISE_CELLS, FINER, -1).mean(axis=(0, 2))
        middle, border = by_place[FINER // 2 - 1], by_place[FINER - 1]
        assert border < 0.5 * middle
        assert steps.take(-1, axis=axis).mean() < 0.5 * middle, "from the last texel to the first"
