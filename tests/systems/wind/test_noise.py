"""Smooth noise on the ground."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from tallgrass.engine.noise import PERIOD, noise_grid, noise_table, smooth_noise

TABLE = noise_table(3, 0)
spots = st.tuples(st.floats(-400.0, 400.0), st.floats(-400.0, 400.0))


def noise(*places: tuple[float, float], shift: tuple[float, float] = (0.0, 0.0)) -> NDArray[np.float32]:
    return smooth_noise(TABLE, np.array(places, np.float32), shift=shift)


def test_a_table_comes_from_its_seed_and_stream_and_cannot_be_changed() -> None:
    again, other = noise_table(3, 0), noise_table(3, 1)
    np.testing.assert_array_equal(again, TABLE)
    assert (other != TABLE).mean() > 0.99
    assert (noise_table(4, 0) != TABLE).mean() > 0.99
    with pytest.raises(ValueError, match="read-only"):
        TABLE[0, 0, 0] = 0.0


def test_channels_are_independent_and_centred() -> None:
    flat = TABLE.reshape(-1, 4)
    assert np.abs(np.corrcoef(flat.T) - np.eye(4)).max() < 0.04
    assert np.abs(flat.mean(axis=0)).max() < 0.02


@given(spots)
def test_it_stays_within_its_bounds(place: tuple[float, float]) -> None:
    assert np.abs(noise(place)).max() <= 1.0


@given(st.integers(-300, 300), st.integers(-300, 300))
def test_on_the_lattice_it_is_the_table_itself(x: int, z: int) -> None:
    np.testing.assert_array_equal(noise((x, z))[0], TABLE[z % PERIOD, x % PERIOD])


@given(spots)
def test_it_repeats_after_its_period(place: tuple[float, float]) -> None:
    x, z = place
    np.testing.assert_allclose(noise(place), noise((x + PERIOD, z - PERIOD)), atol=3e-4)


@given(spots, st.floats(-0.01, 0.01), st.floats(-0.01, 0.01))
def test_near_places_have_near_values(place: tuple[float, float], dx: float, dz: float) -> None:
    x, z = place
    change = np.abs(noise((x + dx, z + dz)) - noise(place)).max()
    assert change <= 3.0 * (abs(dx) + abs(dz)) + 3e-4


@given(spots, st.tuples(st.floats(-40, 40), st.floats(-40, 40)))
def test_a_shift_moves_the_places(place: tuple[float, float], shift: tuple[float, float]) -> None:
    (x, z), (dx, dz) = place, shift
    np.testing.assert_allclose(noise(place, shift=shift), noise((x + dx, z + dz)), atol=5e-4)


def test_hours_of_travel_cost_no_precision() -> None:
    far = 1e6 * PERIOD
    np.testing.assert_array_equal(noise((3.25, 4.5), shift=(far + 0.5, -far)), noise((3.25, 4.5), shift=(0.5, 0.0)))


def test_a_grid_has_the_noise_of_its_places_to_the_bit() -> None:
    x, z = np.linspace(-300.0, 250.0, 83, dtype=np.float32), np.linspace(-7.0, 9.0, 41, dtype=np.float32)
    places = np.stack(np.meshgrid(x, z), axis=-1).reshape(-1, 2)
    np.testing.assert_array_equal(noise_grid(TABLE, x, z).reshape(-1, 4), smooth_noise(TABLE, places))
    np.testing.assert_array_equal(noise_grid(TABLE[..., :2], x, z), noise_grid(TABLE, x, z)[..., :2])
