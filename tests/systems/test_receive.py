"""Receiving: patches shown and planted, and receivers that hear (T4, T5, W1, F1)."""

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass.engine.terrain.record import Terrain
from tallgrass.systems.around.outlook import Outlook
from tallgrass.systems.around.receivers import Receiving
from tallgrass.systems.blow import Blown, Hear
from tallgrass.systems.show.blades.pool import BladePool, BladesKept
from tallgrass.systems.show.blades.shown import BladesShown, Standing
from tallgrass.systems.show.strips.pool import StripPool, StripsKept
from tallgrass.systems.show.strips.shown import StripsOfRing, StripsShown
from tallgrass.systems.site import Site
from tallgrass.systems.space.cone import nearness
from tallgrass.systems.wind.blow import ReceiverArrays, lone_receivers
from tallgrass.systems.wind.breeze import Breeze
from tallgrass.systems.wind.grass import grass_of

Laid = Callable[..., Site]
Look = Callable[..., Outlook]
Wind = Callable[..., Hear]
Shown = Standing | StripsOfRing

FLAT = Terrain(np.zeros((81, 81), np.float32), 1.0)
WIND = Breeze(strength=0.6)


@pytest.fixture
def site(laid: Laid) -> Site:
    return laid(terrain=FLAT)


def blades(outlook: Outlook) -> list[Standing]:
    """Return the patches shown with blades, by ring."""
    rings: list[Standing] = outlook.shows(BladesShown).rings
    return rings


def strips(outlook: Outlook) -> list[StripsOfRing]:
    """Return the patches shown with strips, by ring."""
    rings: list[StripsOfRing] = outlook.shows(StripsShown).rings
    return rings


def rows(shown: list[Standing] | list[StripsOfRing]) -> NDArray[np.int64]:
    return np.concatenate([ring.rows for ring in shown])


def pooled(outlook: Outlook) -> list[tuple[BladePool | StripPool, Shown]]:
    """Return all patches shown, each with its pool."""
    return [
        (outlook.keeps(BladesKept).pool, outlook.shows(BladesShown).standing),
        *zip(outlook.keeps(StripsKept).pools, strips(outlook), strict=True),
    ]


def receiving(outlook: Outlook) -> list[Receiving]:
    """Return the receiving slots of each pool, blades first."""
    found: list[Receiving] = [*outlook.kept["blades"].receiving, *outlook.kept["strips"].receiving]
    return found


def test_t4_what_is_shown_lies_in_its_representations_range(site: Site, look: Look) -> None:
    outlook = look(site, 1.0, 1.0)
    near, far = rows(blades(outlook)), rows(strips(outlook))
    distance = outlook.patches.distance
    assert sorted(distance[near]) == [0] + [1] * 8 + [2] * 16
    assert set(distance[far].tolist()) == {3, 4, 5, 6}
    assert len(set(near.tolist()) | set(far.tolist())) == 13**2


def test_f1_blades_nearer_than_a_rings_limit_are_in_that_ring(site: Site, look: Look) -> None:
    outlook = look(site, 1.0, 1.0)
    for ring, low, high in ((0, 0, 1), (1, 2, 2)):
        distance = outlook.patches.distance[blades(outlook)[ring].rows]
        assert (distance.min(), distance.max()) == (low, high)


def test_t5_every_list_of_patches_goes_from_far_to_near(laid: Laid, look: Look) -> None:
    outlook = look(laid(), 3.0, -4.0)
    cell, centre = outlook.patches.cell, outlook.viewer.centre
    queue = np.argsort(np.concatenate([ring.queue for ring in strips(outlook)]))
    together = rows(strips(outlook))[queue]
    lists = [shown.rows for _, shown in pooled(outlook)] + [ring.rows for ring in blades(outlook)] + [together]
    for each in lists:
        assert len(each) > 0
        order = np.argsort(nearness(cell[each], centre), kind="stable")
        np.testing.assert_array_equal(order, np.arange(len(each)))


def test_t2_only_patches_in_the_view_cone_are_shown(site: Site, look: Look) -> None:
    every = sum(len(shown.rows) for _, shown in pooled(look(site, 1.0, 1.0)))
    ahead = look(site, 1.0, 1.0, yaw=0.0)
    shown = np.concatenate([shown.rows for _, shown in pooled(ahead)])
    assert (ahead.patches.cell[shown, 1] <= 1).all()
    assert 0.1 < len(shown) / every < 0.5


def test_only_what_is_new_is_planted(site: Site, look: Look) -> None:
    outlook = look(site, 1.0, 1.0)
    marks = [pool.present for pool, _ in pooled(outlook)]
    stamps = [pool.stamp.copy() for pool, _ in pooled(outlook)]
    for mark in marks:
        mark[:] = False
    look(site, 1.0, 1.0)
    assert not any(mark.any() for mark in marks)
    look(site, 1.0 + 2.5, 1.0, jumped=True)
    for (pool, shown), mark, before in zip(pooled(outlook), marks, stamps, strict=True):
        fresh = (pool.stamp[shown.slots] != before[shown.slots]).any(axis=1)
        np.testing.assert_array_equal(mark[shown.slots].any(axis=1), fresh)
        assert 0 < fresh.sum() < len(fresh)
    (_, shown), *_ = pooled(outlook)
    near = outlook.patches.cell[shown.rows, 0] == 3
    np.testing.assert_array_equal(marks[0][shown.slots].any(axis=1), near)


def test_every_shown_slot_holds_its_own_patch_wherever_the_viewer_walks(site: Site, look: Look) -> None:
    for step in range(12):
        x, z = 2.3 * step - 9.0, 4.0 - 1.7 * step
        outlook = look(site, x, z, dt=0.2, yaw=0.5 * step)
        for pool, shown in pooled(outlook):
            cell = outlook.patches.cell[shown.rows]
            np.testing.assert_array_equal(pool.stamp[shown.slots, :2], cell)
            low = cell * 2.5
            place = pool.places(shown.slots).reshape(len(low), -1, 2)
            reach = 0.0 if isinstance(pool, BladePool) else 1.0
            assert (place >= low[:, None] - reach - 1e-4).all()
            assert (place <= low[:, None] + 2.5 + reach + 1e-4).all()


@pytest.mark.parametrize("speed", [1.4, 6.0, 25.0, 200.0])
def test_no_two_patches_ever_share_a_slot_however_fast_the_viewer_is(site: Site, look: Look, speed: float) -> None:
    dt = 0.1
    for step in range(80):
        x = 35.0 * np.sin(speed * dt * step / 35.0)
        for _, shown in pooled(look(site, x, 0.4 * x, dt=dt)):
            assert len(np.unique(shown.slots)) == len(shown.slots)


def test_g3_strips_are_planted_anew_when_their_orientation_changes(site: Site, look: Look) -> None:
    before = strips(look(site, 1.0, 1.0))
    outlook = look(site, 1.0, 9.0)
    turned = 0
    for pool, shown in zip(outlook.keeps(StripsKept).pools, strips(outlook), strict=True):
        feet = pool.places(shown.slots)[:, 0]
        across = np.take_along_axis(feet, (1 - shown.along)[:, None, None, None], axis=-1)
        np.testing.assert_allclose(np.ptp(across, axis=2), 0.0, atol=1e-5)
        for rows_before, along in zip(before[0].rows, before[0].along, strict=True):
            turned += int((shown.along[shown.rows == rows_before] != along).sum())
    assert turned > 0


def test_w1_every_receiver_that_is_seen_hears_the_wind(site: Site, look: Look, wind: Wind) -> None:
    hear = wind(WIND, time=2.0)
    outlook = look(site, 1.0, 1.0, hear=hear)
    count = 0
    for (pool, shown), hears in zip(pooled(outlook), receiving(outlook), strict=True):
        np.testing.assert_array_equal(hears.slots, shown.slots)
        place, message = pool.places(shown.slots).reshape(-1, 2), hears.messages.heard(shown.slots)
        alone = lone_receivers(place, grass_of(site.growths, pool.kind(shown.slots)))
        np.testing.assert_array_equal(message, hear(alone, time=0.0))
        assert np.linalg.norm(message, axis=1).mean() > 0.3
        count += len(message)
    assert outlook.noted(Blown, Blown()).heard == count
    near, far = (len(ring.rows) for ring in strips(outlook))
    assert count == 25 * (30 + 12) + near * 2 * 3 * 3 + far * 2 * 2 * 2


def test_w1_receivers_hear_the_instant_that_the_viewer_sees(site: Site, look: Look) -> None:
    asked: list[float] = []

    def hear(heard: ReceiverArrays, /, *, time: float) -> NDArray[np.float32]:
        asked.append(time)
        return np.full_like(heard.place, 0.25)

    outlook = look(site, 1.0, 1.0, hear=hear)
    outlook.viewer.time = 7.5
    look(site, 1.0, 1.0, hear=hear)
    assert outlook.noted(Blown, Blown()).time == 7.5
    assert asked == [], "numpy is asked by those alone who want to know"
    for hears in receiving(outlook):
        assert (hears.messages.heard(hears.slots) == 0.25).all()
    assert asked == [7.5] * 3


def test_w1_the_same_place_gets_the_same_message_in_blades_and_strips(site: Site, look: Look, wind: Wind) -> None:
    hear = wind(WIND, time=5.0)
    outlook = look(site, 1.0, 1.0, hear=hear)
    (_, near), (edge, far), *_ = pooled(outlook)
    to_blades, to_edges, _ = receiving(outlook)
    blade: BladePool = outlook.keeps(BladesKept).pool
    at_blade, at_edge = near.slots[:1], far.slots[:1]
    blade.x[at_blade, :6], blade.z[at_blade, :6] = edge.places(at_edge)[0, 0].reshape(-1, 2)[:6].T
    edges = to_edges.messages.heard(at_edge)[:6]
    assert np.linalg.norm(edges, axis=1).min() > 0.1
    np.testing.assert_array_equal(to_blades.messages.heard(at_blade)[:6], edges)


def test_t2_patches_out_of_sight_do_not_hear(site: Site, look: Look, wind: Wind) -> None:
    hear = wind(WIND, time=2.0)
    outlook = look(site, 1.0, 1.0, hear=hear)
    every = outlook.noted(Blown, Blown()).heard
    look(site, 1.0, 1.0, yaw=0.0, hear=hear)
    count = 0
    for hears in receiving(outlook):
        assert outlook.patches.visible[hears.rows].all()
        count += len(hears.slots) * int(np.prod(hears.pool.shape))
    assert outlook.noted(Blown, Blown()).heard == count < 0.5 * every
