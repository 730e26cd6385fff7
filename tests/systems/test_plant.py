"""Planting: a patch has the same grass in every representation (T1, G1, G3)."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from tallgrass.engine.terrain.record import Density, Terrain
from tallgrass.engine.terrain.sample import height_at
from tallgrass.systems.grow.record import Growth
from tallgrass.systems.show.blades.plant import (
    BladeStock,
    blade_records,
    plant_blades,
    standing_blades,
    stock_blades,
)
from tallgrass.systems.show.blades.pool import BLADE, BladePool
from tallgrass.systems.show.strips.grow import strips_of, targets_on
from tallgrass.systems.show.strips.plant import growing_on, plant_strips
from tallgrass.systems.show.strips.pool import StripPool, is_reversed, strip_edges
from tallgrass.systems.show.strips.stock import stock_strips
from tallgrass.systems.space.ground import Ground, turned

PATCH = 2.5
CELLS = np.array([(-3, 2), (0, 0), (4, -5), (1, 7), (-8, -2), (2, 2), (5, 1), (-1, -1)], np.int32)
MODELS = np.array([0, 1, 0, 1, 0, 1, 0, 1], np.int32)
TURNS = np.array([0, 1, 2, 3, 0, 1, 2, 3], np.int32)
SLOTS = np.array([5, 1, 2, 7, 3, 9, 8, 0])
EVERYWHERE = np.ones((2, 2, 2), np.float32)

places = st.tuples(st.floats(0.0, PATCH), st.floats(0.0, PATCH)).map(lambda pair: np.array([pair], np.float32))
quarters = st.integers(0, 3).map(lambda turn: np.array([turn], np.int32))


def bilinear(terrain: Terrain, place: NDArray[Any]) -> NDArray[np.float64]:
    """Return heights by bilinear interpolation in double precision, at places (..., 2) on the terrain."""
    u = (place.astype(np.float64) - terrain.origin) / terrain.cell
    low = np.minimum(np.floor(u).astype(int), np.array(terrain.heights.shape[::-1]) - 2)
    i, j = np.moveaxis(low, -1, 0)
    s, t = np.moveaxis(u - low, -1, 0)
    h = terrain.heights.astype(np.float64)
    far, near = h[j, i] * (1 - s) + h[j, i + 1] * s, h[j + 1, i] * (1 - s) + h[j + 1, i + 1] * s
    return np.asarray(far * (1 - t) + near * t)


def planted(growths: list[Growth], terrain: Terrain, maps: NDArray[np.float32] = EVERYWHERE) -> BladePool:
    stock = stock_blades(growths, PATCH)
    pool = BladePool(4, stock.kinds)
    ground = Ground(terrain, Density(maps, terrain.size), PATCH)
    plant_blades(pool, SLOTS, CELLS, MODELS, TURNS, stock, ground)
    return pool


def standing(growths: list[Growth], terrain: Terrain) -> tuple[BladeStock, NDArray[np.void]]:
    """Return the stock, and the standing blades of all cells."""
    stock = stock_blades(growths, PATCH)
    ground = Ground(terrain, Density(EVERYWHERE, terrain.size), PATCH)
    return stock, standing_blades(stock, CELLS, MODELS, TURNS, ground)[0]


def stripped(
    growths: list[Growth], terrain: Terrain, along: int, ring: int = 0, maps: NDArray[np.float32] = EVERYWHERE
) -> StripPool:
    pool = StripPool(4, stock_strips(growths).strips[ring], 2, PATCH)
    ground = Ground(terrain, Density(maps, terrain.size), PATCH)
    growing = growing_on(CELLS, ground, pool.strips[0].margin)
    plant_strips(pool, SLOTS, CELLS, MODELS, TURNS, np.full(8, along, np.int32), growing)
    return pool


@given(places, quarters)
def test_g1_four_quarter_turns_are_none(place: NDArray[np.float32], turn: NDArray[np.int32]) -> None:
    once = turned(place, turn, patch=PATCH)
    assert ((once >= -1e-6) & (once <= PATCH + 1e-6)).all()
    back = turned(once, (4 - turn) % 4, patch=PATCH)
    np.testing.assert_allclose(back, place, atol=1e-6)


@given(places, quarters, quarters)
def test_g1_turns_add_up(place: NDArray[np.float32], one: NDArray[np.int32], two: NDArray[np.int32]) -> None:
    both = turned(turned(place, one, patch=PATCH), two, patch=PATCH)
    np.testing.assert_allclose(both, turned(place, (one + two) % 4, patch=PATCH), atol=1e-6)


def test_g1_a_quarter_turn_takes_the_x_axis_to_the_z_axis() -> None:
    corner = np.array([[PATCH, PATCH / 2]], np.float32)
    np.testing.assert_allclose(turned(corner, np.array([1]), patch=PATCH), [[PATCH / 2, PATCH]], atol=1e-6)


@pytest.mark.parametrize("turn", range(4))
def test_g1_a_blade_turns_as_a_whole_with_its_patch(growths: list[Growth], turn: int) -> None:
    blades = growths[0].models[0].blades
    records = blade_records(blades, turn, patch=PATCH, kind=1, variants=4, form=1, record=BLADE)
    spin = np.round(
        [[np.cos(turn * np.pi / 2), np.sin(turn * np.pi / 2)], [-np.sin(turn * np.pi / 2), np.cos(turn * np.pi / 2)]]
    )
    np.testing.assert_allclose(records["root"][:, ::2], (blades.root - PATCH / 2) @ spin + PATCH / 2, atol=1e-6)
    np.testing.assert_allclose(records["rest"], blades.rest @ spin, atol=1e-6)
    facing = np.stack([np.cos(blades.facing), np.sin(blades.facing)], 1)
    np.testing.assert_allclose(records["facing"], facing @ spin, atol=1e-6)
    np.testing.assert_array_equal(records["height"], blades.height)
    np.testing.assert_array_equal(records["variant"], 4 + blades.variant)
    assert (records["kind"] == 1).all()


def test_t1_roots_stand_exactly_on_the_bilinear_terrain_on_slopes_too(growths: list[Growth], hills: Terrain) -> None:
    root = standing(growths, hills)[1]["root"].reshape(-1, 3)
    np.testing.assert_array_equal(root[:, 1], height_at(hills, np.ascontiguousarray(root[:, ::2])))
    np.testing.assert_allclose(root[:, 1], bilinear(hills, root[:, ::2]), atol=2e-5)
    np.testing.assert_array_equal(root[:, ::2], planted(growths, hills).places(SLOTS).reshape(-1, 2))
    assert np.ptp(root[:, 1]) > 3.0


def test_t2_a_patch_knows_between_which_heights_its_blades_are_rooted(growths: list[Growth], hills: Terrain) -> None:
    pool = planted(growths, hills)
    heights = height_at(hills, pool.places(SLOTS).reshape(-1, 2)).reshape(len(SLOTS), -1)
    np.testing.assert_array_equal(pool.ground[SLOTS], np.column_stack([heights.min(axis=1), heights.max(axis=1)]))


def test_t1_every_root_lies_in_its_own_patch(growths: list[Growth], hills: Terrain) -> None:
    place = planted(growths, hills).places(SLOTS)
    low = CELLS[:, None] * PATCH
    assert ((place >= low - 1e-5) & (place <= low + PATCH + 1e-5)).all()


@pytest.mark.parametrize("ring", [0, 1])
@pytest.mark.parametrize("along", [0, 1])
def test_g1_every_blade_stands_within_half_a_slice_of_the_strip_it_is_painted_on(
    growths: list[Growth], hills: Terrain, along: int, ring: int
) -> None:
    pool = stripped(growths, hills, along, ring)
    for kind, growth in enumerate(growths):
        for slot, cell, model, turn in zip(SLOTS, CELLS, MODELS, TURNS, strict=True):
            strips, blades = strips_of(growth.models[model])[ring], growth.models[model].blades
            own = (along + int(turn)) % 2
            count = len(strips.plane)
            _, order = strip_edges(strips, 2, np.array([along]), np.array([turn]), patch=PATCH)
            stands = np.argsort(order[0])[strips.slice[own]]
            feet = pool.places(np.array([slot]))[0, kind, stands].astype(float)
            root = turned(blades.root, turn, patch=PATCH) + cell * PATCH
            run = feet[:, -1] - feet[:, 0]
            length = np.linalg.norm(run, axis=1)
            away = root - feet[:, 0]
            beside = np.abs(run[:, 0] * away[:, 1] - run[:, 1] * away[:, 0]) / length
            assert (beside <= PATCH / count / 2 + 1e-4).all()
            u = targets_on(strips, blades, growth.postures)[own, :, 0, 0]
            painted = feet[:, 0] + u[:, None] * run
            forward = np.einsum("ij,ij->i", painted - root, run) / length
            assert np.abs(forward).max() < 1e-3
            np.testing.assert_allclose(length, PATCH + 2 * strips.margin, atol=1e-4)


@pytest.mark.parametrize("turn", range(4))
@pytest.mark.parametrize("along", [0, 1])
def test_g3_strips_are_parallel_planes_stored_by_rising_place(growths: list[Growth], along: int, turn: int) -> None:
    strips = strips_of(growths[0].models[0])[0]
    feet, order = strip_edges(strips, 2, np.array([along], np.int32), np.array([turn], np.int32), patch=PATCH)
    assert feet.shape == (1, len(strips.plane), 3, 2)
    np.testing.assert_allclose(np.ptp(feet[0, :, :, 1 - along], axis=1), 0.0, atol=1e-6)
    assert (np.diff(feet[0, :, 0, 1 - along]) > 0.0).all()
    np.testing.assert_allclose(np.diff(feet[0, :, 0, 1 - along]), PATCH / len(strips.plane), atol=1e-5)
    rising = list(range(len(strips.plane)))
    (backwards,) = is_reversed(np.array([(along + turn) % 2]), np.array([along]), np.array([turn]))
    assert order[0].tolist() == (rising[::-1] if backwards else rising)


def test_g1_the_blades_of_a_patch_stand_in_the_order_of_their_models_one_kind_after_another(
    growths: list[Growth], hills: Terrain
) -> None:
    """Data of each blade of a model, such as its place on the strips, are looked up by its number."""
    stock, found = standing(growths, hills)
    for blades, cell, model, turn in zip(found, CELLS, MODELS, TURNS, strict=True):
        parts = [
            blade_records(
                growth.models[model].blades, int(turn), patch=PATCH, kind=kind, variants=6, form=kind, record=BLADE
            )
            for kind, growth in enumerate(growths)
        ]
        expected = np.concatenate(parts)
        for name in BLADE.names or ():
            if name != "root":
                np.testing.assert_array_equal(blades[name], expected[name])
        away = blades["root"] - expected["root"]
        np.testing.assert_allclose(away[:, ::2], np.tile(cell * PATCH, (42, 1)), atol=1e-5)
        np.testing.assert_array_equal(blades["kind"], stock.kinds)
    assert stock.kinds.tolist() == 30 * [0] + 12 * [1]


def test_a_kind_grows_as_densely_as_the_map_says(growths: list[Growth]) -> None:
    flat = Terrain(np.zeros((41, 41), np.float32), 1.0)
    maps = np.zeros((2, 2, 2), np.float32)
    maps[0], maps[1] = 0.4, 0.0
    pool = planted(growths, flat, maps)
    assert not pool.present[SLOTS][:, pool.kinds == 1].any()
    assert pool.present[SLOTS][:, pool.kinds == 0].mean() == pytest.approx(0.4, abs=0.02)


def test_thinning_takes_the_same_blades_first_wherever_a_patch_stands(growths: list[Growth]) -> None:
    flat = Terrain(np.zeros((41, 41), np.float32), 1.0)
    before = np.zeros((16, 42), np.bool_)
    for density in (0.2, 0.5, 0.8, 1.0):
        present = planted(growths, flat, np.full((2, 2, 2), density, np.float32)).present
        assert (present | ~before).all()
        before = present
    assert before[SLOTS].all()


def test_strips_know_where_their_kind_does_not_grow_and_where_it_is_thin(growths: list[Growth]) -> None:
    flat = Terrain(np.zeros((41, 41), np.float32), 1.0)
    maps = np.ones((2, 41, 41), np.float32)
    maps[0, :, 20:], maps[1, :21] = 0.0, 0.25
    pool = stripped(growths, flat, 0, maps=maps)
    grows = pool.present[SLOTS]
    np.testing.assert_array_equal(grows[:, 0], CELLS[:, 0] < 1)
    assert grows[:, 1].all()
    far = CELLS[:, 1] < -1
    np.testing.assert_allclose(pool.least[SLOTS][far], 0.25, atol=1e-6)
    near = (CELLS[:, 1] > 0) & (CELLS[:, 0] > 1)
    assert (pool.least[SLOTS][near] == 1.0).all()


def test_only_the_slots_that_are_named_are_planted(growths: list[Growth], hills: Terrain) -> None:
    pool = planted(growths, hills)
    rest = np.setdiff1d(np.arange(16), SLOTS)
    assert (pool.places(rest) == 0.0).all()
    assert not pool.present[rest].any()
    np.testing.assert_array_equal(pool.stamp[SLOTS], CELLS)
