"""Receiving: who is shown, planted and heard (T4, T5, W1, F1)."""

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass.engine.terrain.record import Terrain
from tallgrass.systems.around.cone import far_to_near
from tallgrass.systems.field import Field
from tallgrass.systems.receive import blow, plant_shown_blades, plant_shown_strips
from tallgrass.systems.show.blades.pool import BladePool
from tallgrass.systems.show.seen import Seen, Shown
from tallgrass.systems.show.strips.pool import StripPool
from tallgrass.systems.wind.blow import Listeners, places_alone
from tallgrass.systems.wind.breeze import Breeze
from tallgrass.systems.wind.grass import grass_of

Laid = Callable[..., Field]
Look = Callable[..., Seen]
Hear = Callable[[Listeners], NDArray[np.float32]]

FLAT = Terrain(np.zeros((81, 81), np.float32), 1.0)
WIND = Breeze(strength=0.6)


def rows(shown: list[Shown]) -> NDArray[np.int64]:
    return np.concatenate([ring.rows for ring in shown])


def test_t4_what_is_shown_lies_in_its_representations_range(laid: Laid, look: Look) -> None:
    field = laid(terrain=FLAT)
    seen = look(field, 1.0, 1.0)
    blades, strips = seen.blades, seen.strips
    distance = field.table.distance
    assert sorted(distance[rows(blades)]) == [0] + [1] * 8 + [2] * 16
    assert set(distance[rows(strips)].tolist()) == {3, 4, 5, 6}
    assert len(set(rows(blades).tolist()) | set(rows(strips).tolist())) == 13**2


def test_f1_blades_nearer_than_a_rings_limit_are_in_that_ring(laid: Laid, look: Look) -> None:
    field = laid(terrain=FLAT)
    blades = look(field, 1.0, 1.0).blades
    for ring, low, high in ((0, 0, 1), (1, 2, 2)):
        distance = field.table.distance[blades[ring].rows]
        assert (distance.min(), distance.max()) == (low, high)


def pooled(field: Field, seen: Seen) -> list[tuple[BladePool | StripPool, Shown]]:
    """All that is shown, each with the pool that holds it."""
    return [(field.blades, seen.standing), *zip(field.strips, seen.strips, strict=True)]


def test_t5_every_list_of_patches_goes_from_far_to_near(laid: Laid, look: Look) -> None:
    field = laid()
    seen = look(field, 3.0, -4.0)
    for shown in (seen.blades, seen.strips):
        for ring in shown:
            cells = field.table.cell[ring.rows]
            np.testing.assert_array_equal(far_to_near(cells, field.sight.centre), np.arange(len(cells)))
        together = np.argsort(np.concatenate([ring.queue for ring in shown]))
        cells = field.table.cell[rows(shown)[together]]
        np.testing.assert_array_equal(far_to_near(cells, field.sight.centre), np.arange(len(cells)))


def test_t2_only_patches_in_the_view_cone_are_shown(laid: Laid, look: Look) -> None:
    field = laid(terrain=FLAT)
    everywhere, ahead = look(field, 1.0, 1.0), look(field, 1.0, 1.0, yaw=0.0)
    shown = rows([*ahead.blades, *ahead.strips])
    assert (field.table.cell[shown, 1] <= 1).all()
    assert 0.1 < len(shown) / len(rows([*everywhere.blades, *everywhere.strips])) < 0.5


def test_only_what_is_new_is_planted(laid: Laid, look: Look) -> None:
    field = laid(terrain=FLAT)
    seen = look(field, 1.0, 1.0)
    assert plant_shown_blades(field, seen.standing).size == 0
    assert all(plant_shown_strips(field, ring, shown).size == 0 for ring, shown in enumerate(seen.strips))


def test_every_shown_slot_holds_its_own_patch_wherever_the_viewer_walks(laid: Laid, look: Look) -> None:
    field = laid(terrain=FLAT)
    table = field.table
    for step in range(12):
        x, z = 2.3 * step - 9.0, 4.0 - 1.7 * step
        seen = look(field, x, z, dt=0.2, yaw=0.5 * step)
        for pool, ring in pooled(field, seen):
            np.testing.assert_array_equal(pool.stamp[ring.slots, :2], table.cell[ring.rows])
            low = table.cell[ring.rows] * 2.5
            place = pool.place[ring.slots].reshape(len(low), -1, 2)
            reach = 0.0 if pool is field.blades else 1.0
            assert (place >= low[:, None] - reach - 1e-4).all()
            assert (place <= low[:, None] + 2.5 + reach + 1e-4).all()


@pytest.mark.parametrize("speed", [1.4, 6.0, 25.0, 200.0])
def test_no_two_patches_ever_share_a_slot_however_fast_the_viewer_is(laid: Laid, look: Look, speed: float) -> None:
    field, dt = laid(terrain=FLAT), 0.1
    for step in range(80):
        x = 35.0 * np.sin(speed * dt * step / 35.0)
        seen = look(field, x, 0.4 * x, dt=dt)
        for shown in (seen.standing, *seen.strips):
            assert len(np.unique(shown.slots)) == len(shown.slots)


def test_g3_strips_are_planted_anew_when_their_orientation_changes(laid: Laid, look: Look) -> None:
    field = laid(terrain=FLAT)
    before = look(field, 1.0, 1.0).strips
    after = look(field, 1.0, 9.0).strips
    turned = 0
    for pool, shown in zip(field.strips, after, strict=True):
        feet = pool.place[shown.slots, 0]
        across = np.take_along_axis(feet, (1 - shown.along)[:, None, None, None], axis=-1)
        np.testing.assert_allclose(np.ptp(across, axis=2), 0.0, atol=1e-5)
        for rows_before, along in zip(before[0].rows, before[0].along, strict=True):
            turned += int((shown.along[shown.rows == rows_before] != along).sum())
    assert turned > 0


def test_w1_every_receiver_that_is_seen_hears_the_wind(laid: Laid, look: Look, wind: Callable[..., Hear]) -> None:
    field = laid(terrain=FLAT)
    seen = look(field, 1.0, 1.0)
    hear = wind(WIND, time=2.0)
    heard = blow(field, seen.standing, seen.strips, hear)
    count = 0
    for pool, ring in pooled(field, seen):
        place, message = pool.place[ring.slots].reshape(-1, 2), pool.message[ring.slots].reshape(-1, 2)
        np.testing.assert_array_equal(
            message, hear(places_alone(place, grass_of(field.growths, pool.kind(ring.slots))))
        )
        assert np.linalg.norm(message, axis=1).mean() > 0.3
        count += len(message)
    assert len(heard) == count
    near, far = (len(ring.rows) for ring in seen.strips)
    assert count == 25 * (30 + 12) + near * 2 * 3 * 3 + far * 2 * 2 * 2


def test_w1_the_same_place_gets_the_same_message_in_blades_and_strips(
    laid: Laid, look: Look, wind: Callable[..., Hear]
) -> None:
    field = laid(terrain=FLAT)
    seen = look(field, 1.0, 1.0)
    at_blade, at_edge = seen.standing.slots[0], seen.strips[0].slots[0]
    field.blades.place[at_blade, :6] = field.strips[0].place[at_edge, 0].reshape(-1, 2)[:6]
    blow(field, seen.standing, seen.strips, wind(WIND, time=5.0))
    edges = field.strips[0].message[at_edge, 0].reshape(-1, 2)[:6]
    np.testing.assert_array_equal(field.blades.message[at_blade, :6], edges)


def test_patches_out_of_sight_are_left_alone(laid: Laid, look: Look, wind: Callable[..., Hear]) -> None:
    field = laid(terrain=FLAT)
    look(field, 1.0, 1.0)
    field.blades.message[:] = 9.0
    seen = look(field, 1.0, 1.0, yaw=0.0)
    blow(field, seen.standing, seen.strips, wind(WIND, time=2.0))
    unseen = np.setdiff1d(np.arange(len(field.blades.message)), seen.standing.slots)
    assert (field.blades.message[unseen] == 9.0).all()
    assert (np.abs(field.blades.message[seen.standing.slots]) <= 1.0).all()
