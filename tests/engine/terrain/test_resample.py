"""Smooth resampling of maps, and the filling of voids."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tallgrass.components.arrays import Floats
from tallgrass.engine.terrain.resample import Kernel, b_spline, catmull_rom, fill_voids, resample

numbers = st.floats(-50.0, 50.0)


def plane(rows: int, columns: int, level: float, down: float, right: float) -> Floats:
    return (level + down * np.arange(rows)[:, None] + right * np.arange(columns)[None, :]).astype(np.float32)


@given(level=numbers, down=numbers, right=numbers, step=st.floats(0.05, 3.0))
@pytest.mark.parametrize("kernel", [catmull_rom, b_spline])
def test_a_plane_stays_the_same_plane_up_to_its_edges(
    kernel: Kernel, level: float, down: float, right: float, step: float
) -> None:
    rows, columns = np.arange(0.0, 8.0, step), np.arange(0.0, 6.0, step)
    got = resample(plane(9, 7, level, down, right), rows, columns, kernel=kernel)
    wanted = level + down * rows[:, None] + right * columns[None, :]
    np.testing.assert_allclose(got, wanted, atol=2e-3)


def test_the_samples_themselves_are_kept() -> None:
    values = np.random.default_rng(1).normal(size=(20, 30)).astype(np.float32)
    got = resample(values, np.arange(0, 19.5, 0.25), np.arange(0, 29.5, 0.25))
    np.testing.assert_allclose(got[::4, ::4], values, atol=1e-6)


def test_refining_leaves_no_crease_at_the_samples() -> None:
    wave = np.sin(np.arange(30) * 0.9).astype(np.float32)[None, :].repeat(4, axis=0)
    fine = resample(wave, np.array([1.5]), np.arange(2, 27, 0.01))[0].astype(np.float64)
    slope = np.diff(fine) / 0.01
    assert np.abs(np.diff(slope)).max() < 0.05 * np.abs(slope).max()
    linear = np.interp(np.arange(2, 27, 0.01), np.arange(30), wave[0])
    assert np.abs(np.diff(np.diff(linear) / 0.01)).max() > 0.5 * np.abs(slope).max()


def test_shrinking_averages_what_is_too_fine_to_show() -> None:
    stripes = np.tile([0.0, 1.0], (40, 40)).astype(np.float32)
    got = resample(stripes, np.arange(8, 32, 2.0), np.arange(8, 72, 2.0))
    np.testing.assert_allclose(got, 0.5, atol=0.05)


@given(level=numbers, down=st.floats(-2, 2), right=st.floats(-2, 2), seed=st.integers(0, 99))
def test_voids_in_a_plane_are_filled_close_to_it(level: float, down: float, right: float, seed: int) -> None:
    ground = plane(33, 21, level, down, right)
    void = np.random.default_rng(seed).random(ground.shape) < 0.3
    filled = fill_voids(np.where(void, np.float32(-9999.0), ground), void)
    assert (filled[~void] == ground[~void]).all()
    assert np.abs(filled - ground).max() < 6 * (abs(down) + abs(right)) + 1e-3


def test_a_large_void_is_filled_between_the_heights_around_it() -> None:
    ground = np.full((64, 64), 10.0, np.float32)
    ground[:, 32:] = 20.0
    void = np.zeros(ground.shape, np.bool_)
    void[10:50, 8:56] = True
    filled = fill_voids(np.where(void, np.float32(-32768.0), ground), void)
    assert filled.min() > 8.0
    assert filled.max() < 22.0
    assert filled[30, 12] < 13.0
    assert filled[30, 52] > 17.0


def test_a_map_without_any_height_cannot_be_filled() -> None:
    with pytest.raises(ValueError, match="no height"):
        fill_voids(np.zeros((4, 4), np.float32), np.ones((4, 4), np.bool_))
