"""Flicker: it finds a changed tile, and ignores shimmer (N3)."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from tallgrass.app.bench.flicker import LEAST, MARGIN, TILE, change_of_tile, low_passed, prominence, step, tiles

Picture = NDArray[np.uint8]
SHAPE = (2 * TILE + 2 * MARGIN + 2, 3 * TILE + 2 * MARGIN + 2, 3)


def grass(seed: int) -> Picture:
    """Return a picture with noise in every pixel."""
    return np.random.default_rng(seed).integers(60, 140, SHAPE).astype(np.uint8)


def popped(picture: Picture, by: int) -> Picture:
    """Return a picture with another middle tile in the second row."""
    changed = picture.copy()
    rows, columns = (slice(MARGIN + 1 + TILE * i, MARGIN + 1 + TILE * (i + 1)) for i in (1, 1))
    changed[rows, columns] += np.uint8(by)
    return changed


def test_the_low_pass_keeps_what_is_even_and_averages_what_shimmers() -> None:
    np.testing.assert_allclose(low_passed(np.full(SHAPE, 77, np.uint8)), 77.0, atol=1e-4)
    assert low_passed(grass(1)).shape == (SHAPE[0] - 2, SHAPE[1] - 2, 3)
    assert float(low_passed(grass(1)).std()) == pytest.approx(float(grass(1).std()) / 3.0, rel=0.1)


def test_n3_a_tile_that_changes_as_the_truth_does_has_no_flicker() -> None:
    first, then = (grass(seed)[: TILE + 2, : TILE + 2] for seed in (1, 2))
    brighter = [(picture.astype(int) + 40).astype(np.uint8) for picture in (then, first)]
    assert change_of_tile(brighter[0], brighter[1], then, first) == pytest.approx(0.0, abs=1e-3)
    assert change_of_tile(brighter[0], first, then, first) == pytest.approx(40.0, rel=1e-3)


@given(st.integers(0, 200), st.integers(0, 200))
def test_n3_a_frame_without_changes_has_no_step(now: int, before: int) -> None:
    held = low_passed(grass(now))
    np.testing.assert_array_equal(step(held, held), 0.0)
    np.testing.assert_array_equal(prominence(step(held, held), held, low_passed(grass(before))), 0.0)


def test_n3_a_pop_shows_in_its_tile_and_in_no_other() -> None:
    held, before, now = (low_passed(each) for each in (grass(1), grass(2), popped(grass(1), 30)))
    changed = step(now, held)
    found = prominence(changed, held, before)
    for tiles_of in (changed, found):
        assert tiles_of.shape == (2, 3)
        assert tiles_of.argmax() == 4
        assert np.abs(np.delete(tiles_of, 4)).max() < 0.1 * tiles_of[1, 1]
    assert changed[1, 1] == pytest.approx(30.0, rel=0.1)
    assert found[1, 1] > 1.0


def test_n3_what_moves_anyway_makes_a_step_less_prominent() -> None:
    held, before, now = (low_passed(each) for each in (grass(1), grass(2), popped(grass(1), 30)))
    changed = step(now, held)
    np.testing.assert_allclose(prominence(changed, held, held), changed / LEAST, rtol=1e-5)
    assert prominence(changed, held, before).max() < 0.5 * prominence(changed, held, held).max()


def test_a_tile_tells_the_mean_size_of_a_difference() -> None:
    signs = np.random.default_rng(1).choice([-3.0, 3.0], (2 * TILE + 2 * MARGIN, TILE + 2 * MARGIN, 3))
    np.testing.assert_allclose(tiles(signs.astype(np.float32)), 3.0)
