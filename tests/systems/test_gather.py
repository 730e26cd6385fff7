"""Gathering: records for the graphics card, in the order of drawing (T5, W1)."""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from tallgrass.components.arrays import Rows
from tallgrass.engine.terrain.record import Terrain
from tallgrass.systems.around.outlook import Outlook
from tallgrass.systems.show.blades.gather import gather_blades
from tallgrass.systems.show.blades.pool import BladePool, BladesKept
from tallgrass.systems.show.blades.shown import BladesShown, Standing
from tallgrass.systems.show.strips.gather import (
    ALL_BLADES,
    BY_RANK,
    EDGED,
    MOST_DRAWS,
    PLACEMENT,
    batches,
    gather_strips,
    modes_of,
    polygon_strips,
)
from tallgrass.systems.show.strips.pool import StripPool, StripsKept
from tallgrass.systems.show.strips.shown import StripsOfRing, StripsShown
from tallgrass.systems.site import Site

Laid = Callable[..., Site]
Look = Callable[..., Outlook]

FLAT = Terrain(np.zeros((81, 81), np.float32), 1.0)
EYE = (1.1, 0.4)
SIDE = 2.5
KINDS, FINENESS = 2, [(3, 2), (2, 1)]
"""Kinds of grass; strips and columns of each ring."""

ROOM = 100
"""Number of polygon strips set aside for a patch."""


@pytest.fixture
def outlook(laid: Laid, look: Look) -> Outlook:
    """Outlook of a viewer on flat ground, all round."""
    return look(laid(terrain=FLAT), *EYE)


def blades(outlook: Outlook) -> tuple[BladePool, list[Standing]]:
    """Return the pool of blades, and the patches shown by ring."""
    return outlook.keeps(BladesKept).pool, outlook.shows(BladesShown).rings


def strips(outlook: Outlook) -> list[tuple[StripPool, StripsOfRing]]:
    """Return for each ring the pool of strips and the patches shown."""
    return list(zip(outlook.keeps(StripsKept).pools, outlook.shows(StripsShown).rings, strict=True))


def gathered(outlook: Outlook, *, first: int = 0) -> tuple[NDArray[np.void], NDArray[np.float32]]:
    """Return the patches of all rings, ring after ring, and the feet of all edges, numbered from `first` on."""
    receivers, feet, start = [], [], first
    for pool, ring in strips(outlook):
        feet.append(pool.places(ring.slots).reshape(-1, 2))
        receivers.append((start, len(feet[-1]) // len(ring.rows)))
        start += len(feet[-1])
    shown = [ring for _, ring in strips(outlook)]
    placements = gather_strips(shown, receivers, outlook.appearance, outlook.patches, outlook.viewer.centre, fade=True)
    return placements, np.concatenate(feet)


@dataclass
class Polygons:
    """Fields of polygon strips, decoded from their numbers as by `strips.vert`; each array has shape (n,)."""

    patch: Rows
    kind: Rows
    stack: Rows
    """Place of its strip in the stack."""

    column: Rows
    edge: Rows
    """Number of the receiver of its first edge; that of the second follows."""


def polygons(numbers: NDArray[np.uint32], placements: NDArray[np.void], *, stride: int = ROOM) -> Polygons:
    """Return the fields of polygon strips from their numbers."""
    patch, own = np.divmod(numbers.astype(np.int64), stride)
    code = placements["code"][patch].astype(np.int64)
    strips, columns = np.array(FINENESS)[code // 16].T
    walked, column = np.divmod(own, columns)
    walked //= KINDS
    stack = np.where(code // 8 % 2 == 1, strips - 1 - walked, walked)
    kind = (own // columns + stack) % KINDS
    first = placements["receiver"][patch].astype(np.int64)
    return Polygons(patch, kind, stack, column, first + (kind * strips + stack) * (columns + 1) + column)


def drawn(outlook: Outlook) -> tuple[Polygons, NDArray[np.void], NDArray[np.float32]]:
    """Return all polygon strips in the order of drawing, their patches, and all edges' feet."""
    rings, (placements, feet) = strips(outlook), gathered(outlook)
    patch = np.argsort(np.concatenate([ring.queue for _, ring in rings]))
    present = np.concatenate([pool.present[ring.slots] for pool, ring in rings])[patch]
    numbers, amount = polygon_strips(placements, patch, present, FINENESS, stride=ROOM)
    found = polygons(numbers, placements)
    np.testing.assert_array_equal(found.patch, np.repeat(patch, amount))
    return found, placements, feet


def test_t5_along_any_ray_from_the_eye_strips_are_drawn_from_far_to_near(outlook: Outlook) -> None:
    found, placements, feet = drawn(outlook)
    a, b = feet[found.edge].astype(float) - EYE, feet[found.edge + 1].astype(float) - EYE
    cell = placements["cell"][found.patch]
    for azimuth in np.linspace(0.0, 2 * np.pi, 97)[:-1] + 0.013:
        ray, beside = np.array([np.cos(azimuth), np.sin(azimuth)]), np.array([-np.sin(azimuth), np.cos(azimuth)])
        side_a, side_b = a @ beside, b @ beside
        part = np.divide(side_a, side_a - side_b, out=np.full(len(a), -1.0), where=side_a * side_b < 0.0)
        hit = a + part[:, None] * (b - a)
        met = (part >= 0.0) & (hit @ ray > 0.0) & (np.floor((hit + EYE) / SIDE) == cell).all(axis=1)
        away = (hit @ ray)[met]
        assert len(away) > 8
        assert (np.diff(away) <= 1e-4).all()


@given(st.lists(st.integers(0, 2), max_size=30), st.data())
def test_t5_patches_that_follow_one_another_are_one_draw_and_all_are_where_that_would_be_many(
    needed: list[int], data: st.DataObject
) -> None:
    amount = np.array(data.draw(st.lists(st.integers(0, 5), min_size=len(needed), max_size=len(needed))), np.int64)
    draws = batches(np.array(needed, np.int8), amount)
    assert len(draws) <= MOST_DRAWS
    drawn = [strip for first, count, _ in draws for strip in range(first, first + count)]
    assert drawn == list(range(int(amount.sum())))
    if len(draws) > 1:
        assert all(one[2] != two[2] for one, two in pairwise(draws))
    modes = np.concatenate([np.zeros(0, np.int64), *(np.full(count, mode) for _, count, mode in draws)])
    assert (modes >= np.repeat(np.array(needed, np.int64), amount)).all()


def test_where_draws_are_too_many_the_longest_stretches_are_drawn_in_their_own_way() -> None:
    needed = np.array([1] * 30 + [2, 0] * 10 + [0] * 20 + [2, 0] * 10 + [0] * 5, np.int8)
    draws = batches(needed, np.full(len(needed), 3, np.int64))
    assert draws == [(0, 90, 1), (90, 57, 2), (147, 63, 0), (210, 57, 2), (267, 18, 0)]


def test_a_ring_with_thin_grass_anywhere_is_drawn_by_rank_and_so_are_all_where_a_kind_changes() -> None:
    def ring(least: list[float], edged: list[bool], most: float = 1.0) -> tuple[Any, Any]:
        count = len(least)
        shown = SimpleNamespace(slots=np.arange(count), most=np.full(count, most), least=np.zeros(count))
        return SimpleNamespace(least=np.array(least), edged=np.array(edged)), shown

    dense, thin = ring([1.0, 1.0], [False, True]), ring([1.0, 0.4, 1.0], [False, False, True])
    by_ranks = ring([1.0], [False], most=0.7)
    found = modes_of([dense, thin, by_ranks], changes=False)
    assert found.tolist() == [ALL_BLADES, EDGED, BY_RANK, BY_RANK, EDGED, BY_RANK]
    assert modes_of([dense], changes=True).tolist() == [BY_RANK, EDGED]


patches = st.tuples(st.integers(0, 1), st.booleans(), st.booleans(), st.booleans())


@given(st.lists(patches, max_size=12), st.data())
def test_t5_all_strips_of_the_kinds_that_grow_stand_once_in_the_order_of_their_patches(
    on: list[tuple[int, bool, bool, bool]], data: st.DataObject
) -> None:
    """For patches of any ring, place and kinds: strips from the far side to the near one."""
    placements = np.zeros(len(on), PLACEMENT)
    placements["code"] = [8 * ahead + 16 * ring for ring, ahead, *_ in on]
    order = data.draw(st.permutations(range(len(on))))
    present = np.array([on[patch][2:] for patch in order], np.bool_).reshape(len(on), KINDS)
    numbers, amount = polygon_strips(placements, np.array(order, np.int64), present, FINENESS, stride=ROOM)
    found = polygons(numbers, placements)
    assert found.patch.tolist() == [patch for patch, count in zip(order, amount, strict=True) for _ in range(count)]
    for patch, grows in zip(order, present, strict=True):
        ring, ahead, *_ = on[patch]
        (strips, columns), here = FINENESS[ring], found.patch == patch
        kind, stack, column = found.kind[here], found.stack[here], found.column[here]
        assert sorted(zip(kind, stack, column, strict=True)) == [
            (k, s, c) for k in np.flatnonzero(grows) for s in range(strips) for c in range(columns)
        ]
        assert (np.diff(stack) * (-1 if ahead else 1) >= 0).all()


def test_g3_neighbouring_polygons_of_a_strip_follow_one_another_and_share_their_edge(outlook: Outlook) -> None:
    found, _, feet = drawn(outlook)
    two = np.flatnonzero(found.column == 1)
    assert len(two) > 100
    for one in (found.patch, found.kind, found.stack):
        np.testing.assert_array_equal(one[two - 1], one[two])
    np.testing.assert_array_equal(found.edge[two - 1] + 1, found.edge[two])
    width = np.linalg.norm(feet[found.edge + 1] - feet[found.edge], axis=1)
    np.testing.assert_allclose(width[two - 1], width[two], rtol=1e-4)


def test_g1_strips_are_told_the_model_and_the_turn_of_their_patch_and_how_they_run(outlook: Outlook) -> None:
    patches, centre = outlook.patches, outlook.viewer.centre
    placements, _ = gathered(outlook)
    rings = [ring for _, ring in strips(outlook)]
    rows, along = (np.concatenate([getattr(ring, name) for ring in rings]) for name in ("rows", "along"))
    code = placements["code"].astype(int)
    np.testing.assert_array_equal(placements["cell"], patches.cell[rows])
    np.testing.assert_array_equal(placements["model"], patches.model[rows])
    np.testing.assert_array_equal(code % 4, patches.turn[rows])
    np.testing.assert_array_equal(code // 4 % 2, along)
    away = np.where(along == 0, *(patches.cell[rows] - centre).T[::-1])
    np.testing.assert_array_equal(code // 8 % 2, away > 0)
    np.testing.assert_array_equal(code // 16, np.repeat([0, 1], [len(ring.rows) for ring in rings]))
    assert set((code % 16).tolist()) == set(range(16)), "all combinations"


def test_w1_the_receivers_of_patches_follow_one_another_from_the_first_of_their_ring(outlook: Outlook) -> None:
    numbers = gathered(outlook, first=7168)[0]["receiver"].astype(int)
    every = [np.full(len(ring.rows), np.prod(pool.shape)) for pool, ring in strips(outlook)]
    np.testing.assert_array_equal(numbers, 7168 + np.cumsum([0, *np.concatenate(every)])[:-1])


def test_a_kind_that_does_not_grow_on_a_patch_is_not_gathered_there(laid: Laid, look: Look) -> None:
    dense = np.ones((2, 81, 81), np.float32)
    dense[1, :, 40:] = 0.0
    outlook = look(laid(terrain=FLAT, dense=dense), *EYE)
    found, _, feet = drawn(outlook)
    x = feet[found.edge, 0]
    assert x[found.kind == 1].max() < 4.0
    assert x[found.kind == 0].max() > 8.0
    pool, rings = blades(outlook)
    for ring in rings:
        numbers = gather_blades(pool, ring, eye=EYE)
        kind, root = pool.kinds[numbers % 42], placed(outlook, numbers)
        assert root[kind == 1][:, 0].max() < 0.1
        assert root[kind == 0][:, 0].max() > 2.0
        assert len(numbers) == pool.present[ring.slots].sum()


def placed(outlook: Outlook, numbers: NDArray[np.uint32]) -> NDArray[np.float32]:
    """Return the places of blades by their numbers among all patches with blades, shape (n, 2)."""
    standing: Standing = outlook.shows(BladesShown).standing
    patch, blade = np.divmod(numbers.astype(np.int64), 42)
    return np.asarray(blades(outlook)[0].places(standing.slots)[patch, blade])


def test_g1_every_blade_that_grows_on_the_patches_of_a_ring_is_gathered_once(laid: Laid, look: Look) -> None:
    dense = np.random.default_rng(1).uniform(0.0, 1.0, (2, 20, 20)).astype(np.float32)
    outlook = look(laid(terrain=FLAT, dense=dense), *EYE)
    pool, rings = blades(outlook)
    for ring in rings:
        numbers = gather_blades(pool, ring, eye=EYE)
        patch, blade = np.divmod(np.sort(numbers.astype(np.int64)), 42)
        grown = [(place, number) for place, slot in zip(ring.places, ring.slots, strict=True)
                 for number in np.flatnonzero(pool.present[slot])]  # fmt: skip
        assert list(zip(patch, blade, strict=True)) == sorted(grown)
        assert 0 < len(numbers) < 42 * len(ring.rows)


def test_t5_seen_from_the_eye_blades_of_all_patches_go_from_far_to_near(outlook: Outlook) -> None:
    pool, rings = blades(outlook)
    for ring in rings:
        away = np.hypot(*(placed(outlook, gather_blades(pool, ring, eye=EYE)) - EYE).T)
        assert len(away) == 42 * len(ring.rows)
        assert (np.diff(away) < away.max() / 65000.0).all()


def test_t5_of_each_blade_a_distance_may_be_given_from_which_on_it_is_left_out(outlook: Outlook) -> None:
    pool, rings = blades(outlook)
    for ring in rings:
        to = np.random.default_rng(3).uniform(0.0, 12.0, (len(ring.rows), 42)).astype(np.float32)
        numbers = gather_blades(pool, ring, eye=EYE, to=to)
        offset = pool.places(ring.slots) - np.array(EYE, np.float32)
        nearer = np.hypot(offset[..., 0], offset[..., 1]) < to
        patch, blade = np.nonzero(nearer)
        assert 0 < len(numbers) < nearer.size
        np.testing.assert_array_equal(np.sort(numbers), np.sort(ring.places[patch] * 42 + blade))
