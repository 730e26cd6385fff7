"""Room of pools for a long lens: representations reach to the same size in the picture (F1, G3)."""

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tallgrass.engine.world import World
from tallgrass.systems.around.lens import LONG, reach_under
from tallgrass.systems.around.outlook import Outlook
from tallgrass.systems.lod import farthest, reach_of
from tallgrass.systems.show.blades.pool import BladesKept
from tallgrass.systems.site import Site
from tallgrass.systems.transition import FADE

Laid = Callable[..., Site]
Look = Callable[..., Outlook]

LIMITS = st.lists(st.integers(0, 100), min_size=3, max_size=4, unique=True).map(lambda limits: tuple(sorted(limits)))
LENSES = st.floats(1.0, 30.0)


@given(LIMITS, LENSES)
def test_a_lens_brings_each_representation_near_as_far_as_the_next_one_reaches_without_it(
    reach: tuple[int, ...], lens: float
) -> None:
    near = reach_under(reach, lens)
    assert near[-1] == reach[-1]
    for limit, farther, after in zip(reach[:-1], near[:-1], reach[1:], strict=True):
        assert farther == min(limit * lens, after)
    assert reach_under(reach, 1.0) == reach


@given(LENSES, st.sampled_from([0, 1, 2]))
def test_a_lens_brings_nothing_near_that_another_representation_stands_for(lens: float, forced: int) -> None:
    reach = reach_of((4, 20, 40), forced)
    near = reach_under(reach, lens)
    assert list(near) == sorted(near)
    assert all(farther == limit for farther, limit in zip(near, reach, strict=True) if limit < 0)
    assert (near[1] == near[0]) == (reach[1] == reach[0])


def far_look(look: Look, site: Site, zoom: float, dt: float = 1e9) -> Outlook:
    """Look through a lens of a zoom until all transitions are over, or for `dt` seconds."""
    look(site, 0.6, 0.6, dt=0.0).lens.zoom = zoom
    look(site, 0.6, 0.6, dt=0.0)
    return look(site, 0.6, 0.6, dt=dt)


def farthest_of(outlook: Outlook, level: int) -> int:
    """Return the largest discrete distance of patches in a representation, without those in transition; -1 for none."""
    patches = outlook.patches
    has = patches.shown & (patches.representation == level) & (patches.progress >= 1.0)
    return int(patches.distance.max(where=has, initial=-1))


@pytest.mark.parametrize("zoom", [1.0, LONG, 2.5, 9.0])
def test_g3_blades_and_strips_reach_as_far_as_a_long_lens_brings_them(laid: Laid, look: Look, zoom: float) -> None:
    site = laid()
    outlook = far_look(look, site, zoom)
    near = reach_under(site.reach, 1.0 if zoom <= LONG else zoom)
    assert outlook.lens.reach_in(site.reach) == pytest.approx(near)
    for level in (0, 1):
        unfit = outlook.patches.away > near[level]
        finer = outlook.patches.shown & (outlook.patches.wanted <= level)
        assert not (finer & unfit).any()
    assert farthest_of(outlook, 0) <= near[0]
    assert (farthest_of(outlook, 0) > site.reach[0]) == (zoom >= 2.5)


def test_a_lens_that_is_not_long_asks_for_no_room(laid: Laid, look: Look) -> None:
    site = laid()
    kept = dict(look(site, 0.6, 0.6).kept)
    outlook = far_look(look, site, LONG)
    assert outlook.lens.room == site.reach
    assert outlook.kept == kept


def test_room_that_a_long_lens_made_stays_and_is_made_for_twice_as_much_each_time(laid: Laid, look: Look) -> None:
    site = laid()
    rooms, pools = [], []
    for zoom in (1.0, 1.8, 1.9, 1.0, 2.0):
        outlook = far_look(look, site, zoom)
        rooms.append(outlook.lens.room[0])
        pools.append(outlook.kept["blades"])
    assert rooms == [2, 4, 4, 4, 4]
    assert pools[1] is pools[2] is pools[3] is pools[4]
    assert pools[0] is not pools[1]


def test_receivers_of_a_store_that_was_too_small_are_gone_and_others_stand_in_the_larger_one(
    laid: Laid, look: Look, world: World
) -> None:
    site = laid()
    look(site, 0.6, 0.6)
    outlook = far_look(look, site, 2.5)
    kept = outlook.keeps(BladesKept)
    (receiving,) = kept.receiving
    assert len(receiving.slots) == len(set(receiving.slots.tolist()))
    slots = [(2 * farthest(reach)[0] + 1) ** 2 for reach in (outlook.lens.room, site.reach)]
    assert kept.pool.slots == slots[0] > slots[1]
    planted = kept.pool.stamp[receiving.slots]
    assert np.array_equal(planted, outlook.patches.cell[receiving.rows])
    assert world.lost() == []


def test_x1_who_lays_a_long_lens_aside_sees_patches_change_little_by_little(laid: Laid, look: Look) -> None:
    site = laid()
    outlook = far_look(look, site, 9.0)
    patches = outlook.patches
    far = patches.shown & (patches.representation == 0) & (patches.distance > site.reach[0] + 1)
    assert far.any()
    far_look(look, site, 1.0, dt=0.4 * FADE)
    assert (patches.representation[far] > 0).all()
    assert ((patches.progress[far] > 0.0) & (patches.progress[far] < 1.0)).all()
    far_look(look, site, 1.0)
    assert farthest_of(outlook, 0) <= site.reach[0] + 1
