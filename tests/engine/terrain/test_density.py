"""Density maps of grass kinds."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from PIL import Image

from tallgrass.engine.declared.grass import GrassKind, Place
from tallgrass.engine.terrain.density import load_density
from tallgrass.engine.terrain.errors import MapError
from tallgrass.engine.terrain.record import Density, Terrain
from tallgrass.engine.terrain.sample import density_at, own_density_at

TERRAIN = Terrain(np.zeros((11, 21), np.float32), 2.0)
everywhere = GrassKind()


def painted(picture: str = "map.png", channel: Any = "red") -> GrassKind:
    return GrassKind(place=Place(map=picture, channel=channel))


def save(path: Path, values: NDArray[Any], mode: str | None = None) -> None:
    image = Image.fromarray(values)
    (image if mode is None else image.convert(mode)).save(path)


def load(folder: Path, **kinds: GrassKind) -> Density:
    return load_density(kinds, TERRAIN, folder, {})


def channels(seed: int = 0, count: int = 4) -> NDArray[np.uint8]:
    shape = (6, 9) if count == 1 else (6, 9, count)
    return np.random.default_rng(seed).integers(0, 64, shape, np.uint8)


def test_without_places_kinds_share_the_ground_equally(tmp_path: Path) -> None:
    for count in (1, 2, 3):
        density = load(tmp_path, **{f"kind{number}": everywhere for number in range(count)})
        assert density.maps.shape[0] == count
        assert min(density.maps.shape[1:]) >= 2
        np.testing.assert_allclose(density.maps, 1.0 / count)
        assert density.size == TERRAIN.size


def test_each_kind_takes_its_own_channel_in_the_order_of_the_kinds(tmp_path: Path) -> None:
    save(tmp_path / "map.png", channels())
    names = ("alpha", "green", "red", "blue")
    density = load(tmp_path, **{name: painted(channel=name) for name in names})
    np.testing.assert_allclose(density.maps, channels()[..., [3, 1, 0, 2]].transpose(2, 0, 1) / 255.0, atol=1e-6)
    assert density.maps.dtype == np.float32
    assert density.maps.flags.c_contiguous


def test_nine_kinds_take_the_channels_of_three_maps(tmp_path: Path) -> None:
    maps = [channels(seed=number, count=3) for number in range(3)]
    for number, values in enumerate(maps):
        save(tmp_path / f"map-{number}.png", values)
    places = [(number, channel) for number in range(3) for channel in ("red", "green", "blue")]
    density = load(tmp_path, **{f"{on}-{channel}": painted(f"map-{on}.png", channel) for on, channel in places})
    drawn = np.concatenate([values.transpose(2, 0, 1) / np.float32(255.0) for values in maps])
    np.testing.assert_allclose(density.maps, drawn / np.maximum(drawn.sum(axis=0), 1.0), atol=1e-6)


@pytest.mark.parametrize("channel", ["red", "green", "blue"])
def test_a_grey_picture_has_the_same_density_in_every_colour(channel: str, tmp_path: Path) -> None:
    save(tmp_path / "map.png", channels(count=1))
    np.testing.assert_allclose(load(tmp_path, a=painted(channel=channel)).maps[0], channels(count=1) / 255.0, atol=1e-6)


def test_a_16_bit_grey_picture_keeps_its_fine_steps(tmp_path: Path) -> None:
    values = np.arange(54, dtype=np.uint16).reshape(6, 9) * 1200
    save(tmp_path / "map.png", values)
    np.testing.assert_allclose(load(tmp_path, a=painted()).maps[0], values / 65535.0, atol=1e-6)


def test_alpha_is_taken_as_it_is_and_multiplies_nothing(tmp_path: Path) -> None:
    values = np.zeros((4, 4, 4), np.uint8)
    values[..., 0], values[..., 3] = 200, 10
    save(tmp_path / "map.png", values)
    density = load(tmp_path, a=painted(), b=painted(channel="alpha"))
    np.testing.assert_allclose(density.maps[:, 0, 0], [200 / 255, 10 / 255], rtol=1e-5)


def test_g1_row_0_of_a_map_lies_at_minus_z(tmp_path: Path) -> None:
    values = np.zeros((8, 8), np.uint8)
    values[0, :] = 255
    values[4:, 0] = 102
    save(tmp_path / "map.png", values)
    corners = np.array([[0, -10], [0, 10], [-20, 10]], np.float32)
    np.testing.assert_allclose(density_at(load(tmp_path, a=painted()), corners)[0], [1.0, 0.0, 0.4], atol=1e-6)


@given(seed=st.integers(0, 50), bright=st.integers(1, 255), placed=st.integers(1, 3), free=st.integers(0, 1))
def test_densities_never_sum_above_1_and_are_full_where_a_kind_grows_everywhere(
    seed: int, bright: int, placed: int, free: int, tmp_path_factory: pytest.TempPathFactory
) -> None:
    folder = tmp_path_factory.mktemp("density")
    values = np.random.default_rng(seed).integers(0, bright + 1, (5, 5, 3), np.uint8)
    save(folder / "map.png", values)
    kinds = {name: painted(channel=name) for name in ("red", "green", "blue")[:placed]}
    kinds |= {f"free{number}": everywhere for number in range(free)}
    density = load(folder, **kinds)
    total, asked = density.maps.sum(axis=0), values[..., :placed].sum(axis=-1) / 255.0
    assert density.maps.min() >= 0.0
    np.testing.assert_allclose(total, 1.0 if free else np.minimum(asked, 1.0), atol=1e-5)
    np.testing.assert_allclose(density.maps[0] * np.maximum(asked, 1.0), values[..., 0] / 255.0, atol=1e-5)


def test_kinds_without_a_place_share_what_the_others_leave(tmp_path: Path) -> None:
    save(tmp_path / "map.png", np.full((4, 4), 51, np.uint8))
    density = load(tmp_path, a=everywhere, b=painted(), c=everywhere)
    np.testing.assert_allclose(density.maps[:, 1, 1], [0.4, 0.2, 0.4], atol=1e-6)


def test_f3_flowers_stand_among_the_others_and_take_no_ground_from_them(tmp_path: Path) -> None:
    save(tmp_path / "map.png", channels(count=1))
    flower = GrassKind(plant="flower", place=Place(map="map.png"))
    density = load(
        tmp_path, grass=everywhere, forb=GrassKind(plant="forb"), poppy=flower, daisy=GrassKind(plant="flower")
    )
    np.testing.assert_allclose(density.maps[:2], 0.5)
    np.testing.assert_allclose(density.maps[2], channels(count=1) / 255.0, atol=1e-6)
    np.testing.assert_allclose(density.maps[3], 1.0)


def test_maps_of_different_sizes_lie_over_the_same_ground(tmp_path: Path) -> None:
    save(tmp_path / "coarse.png", np.array([[0, 100], [50, 150]], np.uint8))
    save(tmp_path / "fine.png", channels(count=1).repeat(4, axis=0))
    save(tmp_path / "dot.png", np.array([[25]], np.uint8))
    kinds: Mapping[str, GrassKind] = {name: painted(f"{name}.png") for name in ("coarse", "fine", "dot")}
    density = load(tmp_path, **kinds)
    assert density.maps.shape == (3, 24, 9)
    place = np.array([[-10, -5], [0, 0], [10, 5], [20, -10]], np.float32)
    alone = load(tmp_path, coarse=painted("coarse.png"))
    np.testing.assert_allclose(density_at(density, place)[0], density_at(alone, place)[0], atol=0.03)
    np.testing.assert_allclose(density_at(density, place)[0], np.array([0, 75, 150, 100]) / 255, atol=0.03)
    np.testing.assert_allclose(density.maps[2], 25 / 255, atol=1e-6)


@pytest.mark.parametrize(
    ("mode", "channel", "words"),
    [
        ("RGB", "alpha", "it has no alpha channel, only red, green, blue"),
        ("L", "alpha", "it has no alpha channel, only red, green, blue"),
        ("CMYK", "red", "its mode is CMYK; a density map is a grey, RGB or RGBA picture"),
        ("F", "red", "its mode is F; a density map is a grey, RGB or RGBA picture"),
    ],
)
def test_a_channel_that_is_not_there_is_refused(mode: str, channel: str, words: str, tmp_path: Path) -> None:
    save(tmp_path / "map.tif", channels(count=1), mode)
    with pytest.raises(MapError) as refusal:
        load(tmp_path, a=painted("map.tif", channel))
    assert str(refusal.value) == f"map.tif: {words}"


def test_a_picture_that_is_missing_broken_or_too_large_is_refused(tmp_path: Path) -> None:
    with pytest.raises(MapError, match=r"^map\.png: there is no such file$"):
        load(tmp_path, a=painted())
    (tmp_path / "map.png").write_bytes(b"no picture")
    with pytest.raises(MapError, match=r"^map\.png: it cannot be read as a picture$"):
        load(tmp_path, a=painted())
    save(tmp_path / "map.png", np.zeros((2, 4098), np.uint8))
    with pytest.raises(MapError, match=r"^map\.png: it is 4098 by 2 pixels; a density map has at most 4097 a side$"):
        load(tmp_path, a=painted())


def test_maps_of_one_value_each_are_read_as_if_they_were_looked_at() -> None:
    maps = np.stack([np.full((40, 30), value, np.float32) for value in (0.3, 0.7, 1.0 / 3.0)])
    other = maps.copy()
    other[:, 0, 0] = 0.0  # far from where they are asked
    even, uneven = (Density(each, (60.0, 80.0)) for each in (maps, other))
    place = np.random.default_rng(4).uniform(-20.0, 60.0, (50, 2)).astype(np.float32)
    kind = np.arange(50) % 3
    assert even.even is not None
    assert uneven.even is None
    assert density_at(even, place).tobytes() == density_at(uneven, place).tobytes()
    assert own_density_at(even, kind, place).tobytes() == own_density_at(uneven, kind, place).tobytes()
