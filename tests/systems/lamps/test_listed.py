"""Lists of the lamps and shades that reach each cell (F5)."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tallgrass import Lamp, Shade
from tallgrass.systems.lamps.card import SHADOW_DISTANCE, visible_shades
from tallgrass.systems.lamps.listed import MOST_ENTRIES, SIDE, grid_of
from tallgrass.systems.shadows.shades import shade_texels


@given(st.integers(1, 256), st.floats(0.1, 900.0), st.floats(0.0, 3000.0), st.integers(0, 2**32 - 1))
def test_everything_that_reaches_a_place_is_in_its_cells_list(count: int, far: float, apart: float, seed: int) -> None:
    random = np.random.default_rng(seed)
    place = (random.random((count, 2)) * apart).astype(np.float32)
    reach = (far * (0.2 + 0.8 * random.random(count))).astype(np.float32)
    long = (apart * 0.3 * random.random((count, 2)) ** 4).astype(np.float32)
    grid = grid_of(place, place + long, reach)
    assert len(grid.first) == grid.side**2 <= SIDE**2
    assert grid.count.sum() == len(grid.things) <= MOST_ENTRIES
    asked = place[random.integers(count, size=40)] + (random.random((40, 2)) - 0.5) * 2.2 * far
    for x, z in asked:
        nearest = np.clip((x, z), place.astype(np.float64), (place + long).astype(np.float64))
        near = np.hypot(*(nearest - (x, z)).T) < reach * (1.0 - 1e-6)
        cell = np.floor((np.array((x, z)) - grid.corner) / grid.cell).astype(int)
        if (cell < 0).any() or (cell >= grid.side).any():
            assert not near.any()
            continue
        number = cell[1] * grid.side + cell[0]
        those = grid.things[grid.first[number] : grid.first[number] + grid.count[number]]
        assert set(np.flatnonzero(near)) <= set(those.tolist())


EVERYWHERE = np.array([(0.0, 0.0, 0.0, 1e6)])
"""Planes of a frustum that holds everything."""


@pytest.mark.parametrize("way", [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)])
def test_shadows_beyond_a_distance_are_left_out_whichever_way_they_lie(way: tuple[float, float]) -> None:
    sun, eye = np.array([0.6, 0.64, 0.48], np.float32), (300.0, 2.0, -40.0)
    away = SHADOW_DISTANCE * np.array([0.5, 0.97, 1.03, 2.0])
    shades = [Shade((eye[0] + off * way[0], 3.0, eye[2] + off * way[1]), 1.0) for off in away.tolist()]
    found = visible_shades(shade_texels(shades), sun, 0.0, EVERYWHERE, eye)
    assert found is not None
    texels, grid = found
    assert texels[:, 0, :3].tolist() == shade_texels(shades[:2])[:, 0, :3].tolist()
    assert set(grid.things.tolist()) == {0, 1}
    assert visible_shades(shade_texels(shades[2:]), sun, 0.0, EVERYWHERE, eye) is None


@pytest.mark.parametrize(
    ("keys", "why"),
    [
        ({"colour": "reddish"}, "a lamp's colour is one such as '#ffd9a6' or 'orange', not 'reddish'"),
        ({"candela": -1.0}, "a lamp's candela is from 0 to 1e+07, not -1.0"),
        ({"candela": float("nan")}, "a lamp's candela is from 0 to 1e+07, not nan"),
        ({"range": 0.0}, "a lamp's range is above 0 m, at most 1000 m, not 0.0"),
        ({"cone": 3.2}, "a lamp's cone is half its angle, above 0 and below pi rad, not 3.2"),
        ({"pitch": "up"}, "a lamp's pitch is from -pi to pi rad, not 'up'"),
    ],
)
def test_what_cannot_shine_is_refused_in_a_sentence(keys: dict[str, object], why: str) -> None:
    with pytest.raises(ValueError, match="a lamp's") as caught:
        Lamp(**keys)  # type: ignore[arg-type]
    assert str(caught.value) == why


@pytest.mark.parametrize("colour", ["orange", "Orange", "#fa0", "#FFA500"])
def test_a_lamp_takes_a_colour_by_name_and_in_short(colour: str) -> None:
    lamp = Lamp(colour)
    assert lamp.colour.lower() in {"#ffa500", "#ffaa00"}
    assert lamp.colour.startswith("#")
