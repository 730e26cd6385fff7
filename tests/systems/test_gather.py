"""Gathering: what is sent to the graphics card, in the order of drawing (T5, W1)."""

from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from tallgrass.engine.terrain.record import Terrain
from tallgrass.systems.around.outlook import Outlook
from tallgrass.systems.blow import Hear
from tallgrass.systems.show.blades.gather import gather_blades
from tallgrass.systems.show.blades.pool import BladePool
from tallgrass.systems.show.blades.shown import Standing
from tallgrass.systems.show.strips.draw import KINDS, STRIP
from tallgrass.systems.show.strips.gather import MOST, gather_strips, in_one_queue, runs
from tallgrass.systems.show.strips.pool import StripPool
from tallgrass.systems.show.strips.shown import StripsOfRing
from tallgrass.systems.site import Site
from tallgrass.systems.wind.breeze import Breeze

Laid = Callable[..., Site]
Look = Callable[..., Outlook]

FLAT = Terrain(np.zeros((81, 81), np.float32), 1.0)
EYE = (1.1, 0.4)


@pytest.fixture
def outlook(laid: Laid, look: Look, wind: Callable[..., Hear]) -> Outlook:
    """What somebody sees all round on flat ground, in a breeze."""
    return look(laid(terrain=FLAT), *EYE, hear=wind(Breeze(), time=1.0))


def blades(outlook: Outlook) -> tuple[BladePool, list[Standing]]:
    """The pool of blades, and the patches shown by ring."""
    return outlook.kept["blades"].pool, outlook.shown["blades"].rings


def strips(outlook: Outlook) -> list[tuple[StripPool, StripsOfRing]]:
    """By ring, the pool of strips and the patches shown."""
    return list(zip(outlook.kept["strips"].pools, outlook.shown["strips"].rings, strict=True))


def of_ring(outlook: Outlook, ring: int) -> tuple[NDArray[np.void], NDArray[np.int64]]:
    """The polygon strips of one ring, and how many there are on each patch."""
    pool, shown = strips(outlook)[ring]
    assert outlook.appearance is not None
    return gather_strips(pool, shown, outlook.appearance, outlook.patches, outlook.viewer.centre)


def as_drawn(outlook: Outlook) -> tuple[NDArray[np.void], NDArray[np.int32]]:
    """All polygon strips in the order in which they are drawn, and the cell of the patch that each is of."""
    shown = [ring for _, ring in strips(outlook)]
    drawn, amount = in_one_queue(shown, [of_ring(outlook, ring) for ring in range(len(shown))])
    rows = np.concatenate([ring.rows for ring in shown])[np.argsort(np.concatenate([ring.queue for ring in shown]))]
    return drawn, np.repeat(outlook.patches.cell[rows], amount, axis=0)


def test_t5_along_any_ray_from_the_eye_strips_are_drawn_from_far_to_near(outlook: Outlook) -> None:
    drawn, cell = as_drawn(outlook)
    a, b = drawn["a"][:, ::2].astype(float) - EYE, drawn["b"][:, ::2].astype(float) - EYE
    for azimuth in np.linspace(0.0, 2 * np.pi, 97)[:-1] + 0.013:
        ray, beside = np.array([np.cos(azimuth), np.sin(azimuth)]), np.array([-np.sin(azimuth), np.cos(azimuth)])
        side_a, side_b = a @ beside, b @ beside
        part = np.divide(side_a, side_a - side_b, out=np.full(len(a), -1.0), where=side_a * side_b < 0.0)
        hit = a + part[:, None] * (b - a)
        met = (part >= 0.0) & (hit @ ray > 0.0) & (np.floor((hit + EYE) / 2.5) == cell).all(axis=1)
        away = (hit @ ray)[met]
        assert len(away) > 8
        assert (np.diff(away) <= 1e-4).all()


@given(st.lists(st.booleans(), max_size=30), st.data())
def test_t5_patches_that_follow_one_another_are_one_draw_and_all_are_where_that_would_be_many(
    ranked: list[bool], data: st.DataObject
) -> None:
    amount = np.array(data.draw(st.lists(st.integers(0, 5), min_size=len(ranked), max_size=len(ranked))), np.int64)
    draws = runs(np.array(ranked, np.bool_), amount)
    assert len(draws) <= MOST
    drawn = [strip for first, count, _ in draws for strip in range(first, first + count)]
    assert drawn == list(range(int(amount.sum())))
    if len(draws) > 1:
        assert all(one[2] != two[2] for one, two in pairwise(draws))
    by_rank = np.concatenate([np.zeros(0, np.bool_), *(np.full(count, thin) for _, count, thin in draws)])
    assert by_rank[np.repeat(np.array(ranked, np.bool_), amount)].all()


@given(st.lists(st.integers(0, 2), max_size=30), st.data())
def test_t5_the_strips_of_all_rings_stand_in_one_order(ring_of: list[int], data: st.DataObject) -> None:
    amount = data.draw(st.lists(st.integers(0, 5), min_size=len(ring_of), max_size=len(ring_of)))
    shown, gathered = [], []
    for ring in range(3):
        queue = np.flatnonzero(np.array(ring_of, np.int64) == ring)
        none, whole = np.zeros(len(queue), np.float32), np.ones(len(queue), np.float32)
        shown.append(StripsOfRing(queue, queue, whole, none.astype(np.int32), queue, none, whole))
        counts = np.array(amount, np.int64)[queue]
        records = np.zeros(int(counts.sum()), STRIP)
        records["layer"] = np.repeat(queue, counts)
        gathered.append((records, counts))
    drawn, told = in_one_queue(shown, gathered)
    assert drawn["layer"].tolist() == [patch for patch, count in enumerate(amount) for _ in range(count)]
    assert told.tolist() == amount


def test_w1_a_strip_has_the_messages_of_its_two_edges(outlook: Outlook) -> None:
    for number, (pool, ring) in enumerate(strips(outlook)):
        records, _ = of_ring(outlook, number)
        place, message = pool.place[ring.slots].reshape(-1, 2), pool.message[ring.slots].reshape(-1, 2)
        heard = {tuple(p): tuple(m) for p, m in zip(place.tolist(), message.tolist(), strict=True)}
        for side, wind in (("a", slice(0, 2)), ("b", slice(2, 4))):
            feet = [tuple(foot) for foot in records[side][:, ::2].tolist()]
            assert [heard[foot] for foot in feet] == [tuple(row) for row in records["wind"][:, wind].tolist()]


def test_g3_neighbouring_polygons_of_a_strip_follow_one_another_and_share_their_edge(outlook: Outlook) -> None:
    records, _ = of_ring(outlook, 0)
    pairs = records.reshape(-1, 2)
    np.testing.assert_array_equal(pairs["b"][:, 0], pairs["a"][:, 1])
    np.testing.assert_array_equal(pairs["wind"][:, 0, 2:], pairs["wind"][:, 1, :2])
    np.testing.assert_array_equal(pairs["layer"][:, 0], pairs["layer"][:, 1])


def test_g1_every_kind_is_gathered_on_its_own_layers_with_the_patchs_turn(outlook: Outlook) -> None:
    pool, ring = strips(outlook)[0]
    records, counts = of_ring(outlook, 0)
    assert (counts == 2 * 3 * 2).all()
    own = records.reshape(len(ring.rows), -1)
    np.testing.assert_array_equal(own["stand"] % 4, np.tile(outlook.patches.turn[ring.rows][:, None], own.shape[1]))
    layer = records["layer"].astype(int)
    np.testing.assert_array_equal(records["stand"] // 4, np.arange(len(records)) % 2)
    np.testing.assert_array_equal(records["picture"] % KINDS, layer >= 12)
    expected = np.sort(pool.layer[ring.slots].reshape(len(ring.rows), -1), axis=1)
    np.testing.assert_array_equal(np.sort(own["layer"][:, ::2], axis=1), expected)


def test_a_kind_that_does_not_grow_on_a_patch_is_not_gathered_there(laid: Laid, look: Look) -> None:
    dense = np.ones((2, 81, 81), np.float32)
    dense[1, :, 40:] = 0.0
    outlook = look(laid(terrain=FLAT, dense=dense), *EYE)
    records, counts = of_ring(outlook, 0)
    assert set(counts.tolist()) == {6, 12}
    assert records["a"][records["picture"] == 1][:, 0].max() < 4.0
    assert records["a"][records["picture"] == 0][:, 0].max() > 8.0
    plants, rings = blades(outlook)
    grown = np.concatenate([gather_blades(plants, ring)[0] for ring in rings])
    assert grown["root"][grown["kind"] == 1][:, 0].max() < 0.1
    assert len(grown) == int(sum(plants.present[ring.slots].sum() for ring in rings))


def test_w1_each_blade_is_gathered_with_its_own_message_and_fade(outlook: Outlook) -> None:
    pool, rings = blades(outlook)
    for ring in rings:
        blade, moved = gather_blades(pool, ring)
        assert len(blade) == len(moved) == 42 * len(ring.rows)
        heard = {
            tuple(place): tuple(told)
            for place, told in zip(
                pool.place[ring.slots].reshape(-1, 2).tolist(),
                pool.message[ring.slots].reshape(-1, 2).tolist(),
                strict=True,
            )
        }
        assert [heard[tuple(root)] for root in blade["root"][:, ::2].tolist()] == [
            tuple(m) for m in moved["message"].tolist()
        ]
        assert (moved["fade"] == 1.0).all()


def test_t5_seen_from_the_eye_blades_of_all_patches_go_from_far_to_near(outlook: Outlook) -> None:
    pool, rings = blades(outlook)
    for ring in rings:
        plain, told = gather_blades(pool, ring)
        blade, moved = gather_blades(pool, ring, eye=EYE)
        away = np.hypot(blade["root"][:, 0] - EYE[0], blade["root"][:, 2] - EYE[1])
        assert (np.diff(away) < away.max() / 65000.0).all()
        message = {
            tuple(root): tuple(each)
            for root, each in zip(plain["root"].tolist(), told["message"].tolist(), strict=True)
        }
        assert [message[tuple(root)] for root in blade["root"].tolist()] == [
            tuple(m) for m in moved["message"].tolist()
        ]
